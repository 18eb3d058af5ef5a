# SPDX-License-Identifier: GPL-3.0-or-later
# Scenes that cannot be: each is told in words, at the place at fault, within a moment and little memory,
# however large it is. Speaks TAP.
import copy
import json
import os
import sys
import tempfile

PROGRAM = os.environ.get("HOLONOM", "build/holonom")
SECONDS = 3.0  # of processor time; half a second is the usual most (the last line tells), a slow or crowded machine takes longer
MEGABYTES = 256  # the program alone takes some 30; a list of two million numbers, the most that 4 MB can say, 80 bytes for each
INPUT = 2
results = []

GOOD = {
    "holonom": 1,
    "name": "x",
    "parameters": {"l": {"value": 1, "unit": "m"}},
    "gravity": [0, -9.81, 0],
    "bodies": [{"name": "a", "mass": 1, "com": ["l", 0, 0], "inertia": {"xx": 1, "yy": 1, "zz": 1}}],
    "joints": [{"name": "A", "type": "revolute", "axis": [0, 0, 1], "parent": {"body": "ground"}, "child": {"body": "a"}}],
}


def changed(path, value):
    """GOOD with the value at "bodies/0/mass" (say) replaced."""
    scene = copy.deepcopy(GOOD)
    keys = [int(k) if k.isdigit() else k for k in path.split("/")]
    node = scene
    for key in keys[:-1]:
        node = node[key]
    node[keys[-1]] = value
    return json.dumps(scene)


def chain(n):
    """n pendulums, each on the last."""
    scene = dict(GOOD, bodies=[], joints=[])
    for i in range(n):
        scene["bodies"].append({"name": f"b{i}", "mass": 1})
        scene["joints"].append({"name": f"j{i}", "type": "revolute", "parent": {"body": f"b{i - 1}" if i else "ground", "at": [1, 0]}, "child": {"body": f"b{i}", "at": [0, 0]}})
    return json.dumps(scene)


def repeated(n):
    return changed("bodies", [{"for": {"i": [1, n]}, "name": f"{c}{{i}}", "mass": 1} for c in "ab"])


def ring(n):
    return changed("parameters", {f"p{i}": f"p{(i + 1) % n} + 1" for i in range(n)})


def unconnected():
    scene = copy.deepcopy(GOOD)
    scene["bodies"].append({"name": "b", "mass": 1})
    return json.dumps(scene)


def twice():
    scene = copy.deepcopy(GOOD)
    scene["bodies"].append({"name": "a", "mass": 1})
    return json.dumps(scene)


CASES = [
    # name, what makes the text (or a piece and how often it is repeated), a word of what is told
    ("NaN as a number", lambda: changed("bodies/0/mass", float("nan")), "NaN"),
    ("infinity as a number", lambda: changed("bodies/0/com", [float("inf"), 0]), "Infinity"),
    ("a number beyond all doubles", lambda: changed("bodies/0/mass", "@").replace('"@"', "1e999"), "1e999"),
    ("a title that a terminal would obey", lambda: changed("title", "\x1b[31mred\x07"), "the text holds a control character (at /title)"),
    ("a title with a control character of two bytes", lambda: changed("title", "a\x9b31m"), "the text holds a control character (at /title)"),
    ("a name that a terminal would obey", lambda: changed("bodies/0/name", "a\x7f"), "a name holds a control character"),
    ("an unknown field that a terminal would obey", lambda: json.dumps(dict(GOOD, **{"\x1b[31m": 1})), "(at /?[31m)"),
    ("a formula without a value", lambda: changed("bodies/0/mass", "0/0"), "0/0"),
    ("a number whose products overflow", lambda: changed("bodies/0/mass", 1e308), "too large to be computed with"),
    ("a formula whose products overflow", lambda: changed("bodies/0/mass", "exp(600)"), "1e100 is the most"),
    ("a formula beyond all doubles", lambda: changed("bodies/0/mass", "exp(1e6)"), "not a finite number"),
    ("a mass of zero that a coordinate needs", lambda: json.dumps(dict(GOOD, bodies=[{"name": "a", "mass": 0}])), "moves no mass"),
    ("a mass of zero with inertia", lambda: changed("bodies/0/mass", 0), "inertia but no mass"),
    ("a negative mass", lambda: changed("bodies/0/mass", -1), "negative"),
    ("moments that break the triangle inequality", lambda: changed("bodies/0/inertia", {"xx": 1, "yy": 1, "zz": 3}), "sum of the other two"),
    ("products of inertia too large", lambda: changed("bodies/0/inertia", {"xx": 1, "yy": 1, "zz": 1, "xy": 2}), "tensor of inertia"),
    ("a negative moment of inertia", lambda: changed("bodies/0/inertia", {"xx": -1, "yy": 1, "zz": 1}), "negative"),
    ("an axis of zero length", lambda: changed("joints/0/axis", [0, 0, 0]), "length zero"),
    ("two bodies of one name", lambda: twice(), "used twice"),
    ("a body joined to nothing", lambda: unconnected(), "not connected"),
    ("an unknown unit", lambda: changed("parameters/l/unit", "furlong"), "furlong"),
    ("a foreign unit", lambda: changed("parameters/l/unit", "mm"), "0.001 m"),
    ("two parameters that need each other", lambda: ring(2), "p0 needs p1"),
    ("200 parameters in a ring", lambda: ring(200), "needs"),
    ("10,000 bodies", lambda: chain(10000), "4000 bodies"),
    ("10,000 bodies by repetition", lambda: repeated(5000), "4000 bodies"),
    ("a million repetitions", lambda: repeated(1000000), "5000 repetitions"),
    ("100 MB of white space", (b" " * 1000, 100000), "4194304"),
    ("100 MB of bodies", (b'{"name":"a","mass":1},' * 100, 45455), "4194304"),
    ("a million lists in each other", lambda: "[" * 1000000, "24"),
    ("a million objects in each other", lambda: '{"a":' * 800000, "24"),
    ("100,000 brackets in a formula", lambda: changed("bodies/0/mass", "(" * 100000 + "1" + ")" * 100000), "formula"),
    ("a million minus signs in a formula", lambda: changed("bodies/0/mass", "-" * 1000000 + "1"), "formula"),
    ("a tower of powers", lambda: changed("bodies/0/mass", "9^" * 300000 + "9"), "formula"),
    ("a name of a megabyte", lambda: changed("bodies/0/name", "a" * 1000000), "60"),
    ("a million unknown fields", lambda: '{"holonom":1,' + ",".join(f'"f{i}":1' for i in range(300000)) + "}", "unknown field"),
    ("a million bodies that are numbers", lambda: changed("bodies", [1] * 1000000), "expected an object"),
    ("as many numbers as 4 MB can hold", lambda: "[" + "1," * 2097000 + "1]", "expected an object"),
    ("a table of a million times", lambda: json.dumps(dict(GOOD, loads=[{"table": {"joint": "A", "t": [0] * 1000000, "value": [0]}}])), "10000"),
    ("a polygon of a million corners", lambda: json.dumps(dict(GOOD, draw={"polygons": [[[0, 0]] * 400000]})), "polygon"),
]


def measure(words, stdin):
    """Runs the program on its own (memory counts from this process, which therefore holds no text): status, what it says, seconds of processor time, megabytes at most."""
    with tempfile.TemporaryFile() as out, open(stdin, "rb") as feed:
        child = os.fork()
        if child == 0:
            os.dup2(feed.fileno(), 0)
            os.dup2(out.fileno(), 1)
            os.dup2(out.fileno(), 2)
            os.execv(PROGRAM, [PROGRAM, *words])
        _, status, used = os.wait4(child, 0)
        out.seek(0)
        return os.waitstatus_to_exitcode(status), out.read().decode("utf-8"), used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def write(path, make):
    with open(path, "wb") as f:
        if callable(make):
            f.write(make().encode())
        else:
            for _ in range(make[1]):
                f.write(make[0])


def report(good, name, why=""):
    results.append(good)
    print(f"{'ok' if good else 'not ok'} {len(results)} - {name}")
    if not good:
        print(f"# {why}")
    sys.stdout.flush()


def check(name, path, words, stdin, word):
    status, said, seconds, megabytes = measure(words, stdin)
    told = status == INPUT and word in said and len(said) < 20000
    report(told and seconds < SECONDS and megabytes < MEGABYTES, name,
           f"exit {status}, {seconds:.2f} s, {megabytes:.0f} MB, '{word}' asked for: {said[:600]!r}")
    return seconds, megabytes


with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "scene.json")
    most = [0, 0]
    for name, make, word in CASES:
        write(path, make)
        most = [max(p) for p in zip(most, check(name + " is told", path, ["inspect", path], os.devnull, word))]
        most = [max(p) for p in zip(most, check(name + " is told when it comes by standard input", path, ["inspect", "-"], path, word))]
    with open(path, "w") as f:
        f.write(json.dumps(GOOD))
    status, said, _, _ = measure(["inspect", path], os.devnull)
    report(status == 0, "the scene that all these were made from is sound", said[:600])
print(f"# at most {most[0]:.2f} s, {most[1]:.0f} MB")
print(f"1..{len(results)}")
sys.exit(0 if all(results) else 1)
