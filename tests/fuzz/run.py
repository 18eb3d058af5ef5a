# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the harnesses, each for so many minutes, and prints a table. Seeds are the shipped scenes, exercises and test files, the
examples of the API, and the inputs in seeds/NAME that once broke something. Exit status 1 when a harness found a fault: its input
is then in the folder of work."""

import argparse
import glob
import json
import os
import re
import subprocess
import sys

SCENES = sorted(glob.glob("lessons/*/scenes/*.json") + glob.glob("tests/scenes/*.json"))
BODIES = ["terms", "assemble", "inspect", "equations", "drag", "snapshots", "grade", "export", "runs", "studies"]  # as in fuzz_bodies.c
PROGRAM = "build/holonom"


def read(path):
    with open(path, "rb") as f:
        return f.read()


def formulas():
    """Strings of the scenes that look like formulas."""
    found = set()

    def look(value):
        for item in value.values() if isinstance(value, dict) else value if isinstance(value, list) else ():
            look(item)
            if isinstance(item, str) and re.search(r"[*+/^()-]", item) and " " not in item.strip()[:-1]:
                found.add(item)

    for path in SCENES:
        try:
            look(json.loads(read(path)))
        except ValueError:
            pass
    return sorted(found)


def methods():
    document = json.loads(subprocess.run([PROGRAM, "list", "methods", "--json"], capture_output=True, check=True).stdout)
    integrators = [i["name"] for i in document["integrators"]]
    for k, formulation in enumerate(document["formulations"]):
        options = ",".join(f"{o['key']}={o['default']}" for o in formulation.get("options", []) if "default" in o)
        yield f"{formulation['name']}{':' + options if options else ''}@{integrators[k % len(integrators)]}:h=1e-3"


def examples():
    """(path below /api/v1/, example) of every route that takes a body, from the document that the server gives."""
    server = subprocess.Popen([PROGRAM, "serve", "--port", "0", "--json"], stdout=subprocess.PIPE)
    try:
        import urllib.request

        address = json.loads(server.stdout.readline())["address"]
        with urllib.request.urlopen(address + "/api/v1/openapi.json") as answer:
            paths = json.load(answer)["paths"]
    finally:
        server.terminate()
        server.wait()
    for path, item in paths.items():
        for verb, operation in item.items():
            body = operation.get("requestBody", {}).get("content", {}).get("application/json", {})
            if "example" in body:
                yield verb, path.removeprefix("/api/v1/"), json.dumps(body["example"]).encode()


def short_scene(path):
    """A scene without its texts for people, on one line, which mutates better; None where it is no scene, or a large one."""
    try:
        scene = json.loads(read(path))
    except ValueError:
        return None
    if "n" in scene.get("parameters", {}):
        scene["parameters"]["n"]["value"] = 3  # a ring of a few links
    text = json.dumps({k: v for k, v in scene.items() if k not in ("title", "about", "look_for")}, separators=(",", ":"))
    return text.encode() if len(text) <= HARNESSES["scene"][1] else None


def small(body):
    """An example on the scene that compiles fastest."""
    return body.replace(b"four-bar", b"pendulum")


def seeds(name):
    if name == "scene":
        return [s for s in map(short_scene, SCENES) if s]
    if name == "formula":
        return [f.encode() for f in formulas()]
    if name == "method":
        return [m.encode() for m in methods()]
    if name == "mjcf":
        return [read(p) for p in sorted(glob.glob("tests/import/*.xml"))]
    if name == "urdf":
        loops = b"\0".join(read(p) for p in ("tests/import/four-bar.urdf", "tests/import/four-bar.loops.json"))
        return [loops] + [read(p) for p in sorted(glob.glob("tests/import/*.urdf"))]
    if name == "bodies":
        return [bytes([BODIES.index(path)]) + body for verb, path, body in examples() if path in BODIES]
    if name == "patch":
        changes = [{"step": 3}, {"state": "running", "speed": 2}, {"set": {"key": "alpha", "value": 20}}, {"reset": True},
                   {"methods": ["projection@rk4:h=1e-2"]}, {"parameters": {"l": 0.6}}, {"state": "paused"}]
        made = [b"\1" + small(body) for verb, path, body in examples() if path == "comparisons"]
        return made + [b"\2" + b"\0".join(json.dumps(c).encode() for c in changes[k:]) for k in range(len(changes))]
    if name == "submission":
        files = [read(p) for p in sorted(glob.glob("lessons/*/problems/*.json"))]
        return files + [json.dumps(json.loads(b)["submission"]).encode() for v, p, b in examples() if p == "grade"]
    if name == "reference":
        return [read(p) for p in sorted(glob.glob("lessons/*/references/pendulum.json"))]
    if name == "journal":
        line = {"m": 0, "k": 0, "state": 1, "status": 0, "reason": "", "failure": None, "numbers": [1, 2, 3], "worst": [0] * 4, "end": [0] * 4, "q": [0] * 3,
                "cost": [0] * 11, "first_cpu": 1e-3}
        cell = {"m": 0, "column": 1, "row": 1, "kind": 1, "status": 0, "numbers": [1, 1, 1, 1, 1], "reason": ""}
        column = {"m": 0, "column": 1, "between": [0.1, 0.2], "reason": "x"}
        return [bytes([k]) + b"".join(json.dumps(l).encode() + b"\n" for l in lines)
                for k, lines in enumerate(([line, {"m": 0, "k": 0, "cpu": 1e-3, "busy": 0}], [cell, column], [line]))]
    if name == "heads":
        return list(heads())
    raise KeyError(name)


# what clients and proxies write into heads, beside a Host
FIELDS = ["X-Forwarded-For: 203.0.113.9", "X-Forwarded-For: 198.51.100.1:443, [2001:db8::7]:80 , 10.1.2.3", "X-Forwarded-For: unknown, unix:",
          "X-Forwarded-For: ::ffff:192.0.2.1\r\nX-Forwarded-For: 2001:db8:8000::1", "Accept: text/csv;q=0.5, application/*;q=0, */*",
          "Accept: application/x-ndjson", 'If-None-Match: W/"$R", "$R.0", *', "If-None-Match: *", "Last-Event-ID: 17", "Range: bytes=0-9",
          "Origin: http://localhost:80", "Origin: https://mechanisms.example", "Sec-Fetch-Site: cross-site", "Sec-Fetch-Site: same-origin",
          'Cookie: a=b; holonom_token="SECRET-TOKEN"', "Authorization: bearer  SECRET-TOKEN", "Accept-Encoding: br, gzip;q=0.5", "User-Agent: x",
          "Content-Length: 9\r\nTransfer-Encoding: chunked", "Content-Type: application/json; charset=utf-8", "Expect: 100-continue", "Connection: close"]
ADDRESSES = ["/", "/?token=SECRET-TOKEN", "/api", "/healthz", "/api/v1/", "/api/v1/openapi.json", "/api/v1/scenes", "/api/v1/scenes/four-baar", "/api/v1/runs",
             "/api/v1/runs/$R?wait=1", "/api/v1/runs/$R/samples?fields=t,q,gap&stride=2&from=0.05&to=1e-1&cursor=3&limit=2&method=1",
             "/api/v1/runs/$R/events?mode=live&fields=t&last_event_id=3", "/api/v1/comparisons/$C", "/api/v1/comparisons/$C/events?mode=complete&fields=lambda,sigma_min",
             "/api/v1/problems/p3?hint=1", "/api/v1/lessons/1", "/api/v1/errors/input", "/api/v1/scenes/pendulum/export?language=c&set=l:0.6&set=m:1",
             "http://localhost/api/v1/methods", "/%2e%2e/%00?a=%0d%0a&b+c=", "/page.js"]


def heads():
    """Every address, every field and every way of starting the server at least once, and networks of proxies."""
    for k, (address, field) in enumerate([(a, FIELDS[k % len(FIELDS)]) for k, a in enumerate(ADDRESSES)] + [(ADDRESSES[k % len(ADDRESSES)], f) for k, f in enumerate(FIELDS)]):
        verb, host = ("GET", "GET", "HEAD", "GET", "GET", "OPTIONS", "POST")[k % 7], ("localhost", "127.0.0.1:8080", "[::1]:80", "mechanisms.example")[k % 4]
        yield bytes([k % 32]) + f"{verb} {address} HTTP/1.{int(k % 5 > 0)}\r\nHost: {host}\r\n{field}\r\n\r\n".encode()
    for network in ("10.0.0.0/8", "192.0.2.1", "2001:db8::/33", "::ffff:10.0.0.1/24", "[::1]:80", "127.0.0.1:8080"):
        yield b"\xff" + network.encode()


# name: program, longest input, what the input is made of
HARNESSES = {
    "scene": ("fuzz_scene", 2500, "json"),
    "formula": ("fuzz_formula", 1500, "formula"),
    "method": ("fuzz_method", 300, None),
    "mjcf": ("fuzz_import", 4096, "xml"),
    "urdf": ("fuzz_import", 4096, "xml"),
    "bodies": ("fuzz_bodies", 6000, "json"),
    "patch": ("fuzz_patch", 1500, "json"),
    "submission": ("fuzz_submission", 4096, "json"),
    "reference": ("fuzz_reference", 20000, "json"),
    "journal": ("fuzz_journal", 2048, "json"),
    "heads": ("fuzz_heads", 2048, "head"),
}


def words(kind):
    """A dictionary: the words that inputs are made of."""
    if kind == "json":
        texts = [read(p).decode(errors="ignore") for p in SCENES]
        found = set(re.findall(r'"[A-Za-z_]{2,20}"', " ".join(texts))) | {'"scene"', '"methods"', '"four-bar"', "1e308", "-0", "5e-324", "null"}
    elif kind == "formula":
        found = {"sin(", "cos(", "sqrt(", "hypot(", "atan2(", "exp(", "log(", "abs(", "th1", "l1", "x", "y", "t", "pi", "1e-308", "1e308", "^-"}
    elif kind == "head":
        found = {w for text in FIELDS + ADDRESSES for w in re.findall(r"[A-Za-z0-9.:/*$_-]{2,}", text)} | {"%00", "%0d%0a", "q=0", "=", "&", "1e308", "-0", "nan", ", ", ";"}
    else:
        texts = [read(p).decode(errors="ignore") for p in glob.glob("tests/import/*.xml") + glob.glob("tests/import/*.urdf")]
        found = set(re.findall(r"</?[a-z_]{2,16}|[a-z_]{2,16}=", " ".join(texts)))
    return "".join('"' + w.replace("\\", "\\\\").replace('"', '\\"') + '"\n' for w in sorted(found))


def prepare(name, work):
    corpus = os.path.join(work, "corpus", name)
    os.makedirs(corpus, exist_ok=True)
    kept = [read(p) for p in sorted(glob.glob(f"tests/fuzz/seeds/{name}/*"))]
    for i, seed in enumerate(seeds(name) + kept):
        with open(os.path.join(corpus, f"seed-{i:04d}"), "wb") as f:
            f.write(seed)
    return corpus


def run(name, options):
    program, longest, kind = HARNESSES[name]
    corpus, found = prepare(name, options.work), os.path.join(options.work, "found", name)
    os.makedirs(found, exist_ok=True)
    # leaks of the drawing library's own, and null pointers that nothing is added to
    environment = {**os.environ, "ASAN_OPTIONS": "allocator_may_return_null=1:max_allocation_size_mb=2000",
                   "LSAN_OPTIONS": "suppressions=tests/support/lsan.supp:print_suppressions=0"}
    command = [os.path.join(options.programs, program), f"-max_total_time={round(60 * options.minutes)}", f"-max_len={longest}", "-timeout=300", "-report_slow_units=300",
               "-rss_limit_mb=2500", "-print_final_stats=1", f"-artifact_prefix={found}/", "-close_fd_mask=1"]
    if kind:
        path = os.path.join(options.work, kind + ".dict")
        with open(path, "w") as f:
            f.write(words(kind))
        command.append("-dict=" + path)
    before = set(os.listdir(found))
    done = subprocess.run(command + [corpus], capture_output=True, text=True, errors="replace", env=environment)
    with open(os.path.join(options.work, name + ".log"), "w") as f:
        f.write(done.stderr)
    executed = re.search(r"number_of_executed_units: (\d+)", done.stderr)
    edges = re.findall(r"cov: (\d+)", done.stderr)
    fresh = sorted(set(os.listdir(found)) - before)
    if done.returncode != 0 and not fresh:
        fresh = [f"ended with {done.returncode}, see {name}.log"]
    return int(executed.group(1)) if executed else 0, int(edges[-1]) if edges else 0, fresh


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--programs", default="build/fuzz/tests/fuzz")
    parser.add_argument("--work", default="build/fuzzing")
    parser.add_argument("--table", help="a file that gets the table too, when all harnesses have been run")
    parser.add_argument("names", nargs="*", metavar="HARNESS")
    options = parser.parse_args()
    unknown = set(options.names) - set(HARNESSES)
    if unknown:
        parser.error(f"no harness is called {', '.join(sorted(unknown))}; there are {', '.join(HARNESSES)}")
    bad, table = 0, []

    def tell(line):
        table.append(line + "\n")
        print(line, flush=True)

    tell(f"{'harness':12} {'executions':>11} {'edges':>7}  found in {options.minutes:g} min")
    for name in options.names or HARNESSES:
        executed, edges, fresh = run(name, options)
        bad += bool(fresh) or executed == 0
        tell(f"{name:12} {executed:11,} {edges:7,}  {', '.join(fresh) or 'nothing'}")
    if options.table:
        with open(options.table, "w") as f:
            f.writelines(table)
    sys.exit(1 if bad else 0)


main()
