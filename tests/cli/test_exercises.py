# SPDX-License-Identifier: GPL-3.0-or-later
"""Exercises from the shell: variants, checks of the author, choices, files of one's own, exercises at fault. Speaks TAP."""

import glob
import json
import math
import os
import re
import subprocess
import sys

sys.path.insert(0, os.path.dirname(__file__))
from exercise import PROGRAM, expect, read, run, speak_tap, write  # noqa: E402


def variants(_):
    a, b, c = (run("problem", "p1", *w).stdout for w in (["--seed", "42"], ["--seed", "42"], ["--seed", "43"]))
    expect("the same seed gives the same text", a == b and a != c)
    s, t = (run("problem", "p1", "--student", n).stdout for n in ("s1001", "s1002"))
    expect("every student has a variant", s != t and s == run("problem", "p1", "--student", "s1001").stdout)
    formula = next(line for line in run("problem", "loops", "--wide").stdout.splitlines() if line.startswith('  answer "e"'))
    expect("a formula may use the numbers that are given, by their names",
           re.search("names: th2 th3 w1 w2 w3; with numbers given: b = [0-9]+, j = [0-9]+, l1 = [0-9.]+, l2 = [0-9.]+, l3 = [0-9.]+, d = [0-9.]+, th1 = [0-9.]+$", formula), formula)
    own, other = (run("problem", "p3", "--wide", "--student", n).stdout for n in ("s1001", "s1002"))
    numbers = json.loads(run("problem", "p3", "--student", "s1001", "--json").stdout)["numbers"]
    expect("so has the exercise whose formulas are the same for all", own != other and '{"student": "s1001", "J": ' in own
           and all(f"{name} = {x:.6f}" in own and f"{name} = {x:.6f}" not in other for name, x in numbers.items()), own)  # fmt: skip
    hints = run("problem", "p1", "--hint", "1").stdout
    expect("a hint is printed when asked for", hints.startswith("hint 1 of 3:") and hints.count("hint") == 1, hints)
    written = {name: run("problem", name).stdout for name in ("closure", "p1", "slips-1")}
    expect("an exercise with formulas says how they are written, once",
           {name: (text.count("Formulas: "), text.count("Formulas of matrices: ")) for name, text in written.items()}
           == {"closure": (1, 0), "p1": (0, 1), "slips-1": (0, 0)}, str(written))  # fmt: skip
    near = run("problem", "nul")
    expect("a word of the title finds exercises", near.returncode == 2 and "exercises with 'nul' in their title: basis, gears, p2" in near.stderr, near.stderr)
    forms = [json.loads(run("problem", "p3", *who, "--json").stdout)["submission"] for who in (["--seed", "42"], ["--student", "Ada"], [])]
    expect("the shape of a submission names its variant first", [f[: f.index('"J"')] for f in forms] == ['{"seed": 42, ', '{"student": "Ada", ', "{"], str(forms))
    expect("in the text too", '{"seed": 42, "J": ' in run("problem", "p3", "--seed", "42", "--wide").stdout)
    listed = {p["id"]: p for p in json.loads(run("problems", "--json").stdout)["problems"]}
    expect("an exercise that draws nothing says so", all(p["drawn"] for p in listed.values()) and listed["slips-1"]["drawn"] == "the order of the options", str(listed["slips-1"]))
    expect("ranges are listed", listed["atwood"]["ranges"]["m1"] == {"range": [1, 3], "digits": 1, "unit": "kg"} and set(listed["p3"]["ranges"]) == set(listed["p3"]["varied"].split()), str(listed["p3"]))
    near = run("problem", "p11111")
    expect("an unknown exercise is the input's fault", near.returncode == 2, near.stderr)


def checks(_):
    done = run("problem", "p4", "--seeds", "1..10", "--check", "--json")
    report = json.loads(done.stdout)
    expect("a sound exercise passes its check", done.returncode == 0 and report["variants"] == 10 and report["bad"] == 0, done.stdout)
    expect("its mistakes were tried", report["mistakes"] >= 100 and report["right_answers"] == 40, done.stdout)
    bad = run("problem", "p4", "--seeds", "9..1", "--check")
    expect("a range that is none is refused", bad.returncode == 2 and "9..1" in bad.stderr, bad.stderr)


def proof(folder):
    """The check prints what it proves."""
    said = run("problem", "p3", "--seeds", "1..20", "--check", "--wide").stdout
    apart = re.search(r"both means of J, .* agree to ([0-9.e-]+) of an entry's size at worst", said)
    expect("both means of a matrix are compared", apart and 0 < float(apart[1]) < 1e-7 and "not checked: how near a mechanism comes to a singular" in said, said)
    said = run("problem", "closure", "--seeds", "1..200", "--check", "--wide").stdout
    report = json.loads(run("problem", "closure", "--seeds", "1..200", "--check", "--json").stdout)["parts"]
    expect("draws, answers and both means of each part are told", all(f"both means of part {p} agree" in said for p in "abc") and "part d (choice)" in said
           and "drawn again" in said and "right answers of part c: " in said and report["c"]["least"] < report["c"]["largest"]
           and report["a"]["worst_difference"] < 1e-9, said)  # fmt: skip
    with open("lessons/06-drift/problems/drift.json", encoding="utf-8") as f:
        drift = json.load(f)
    times = {str(json.loads(run("problem", "drift", "--seed", str(k), "--json").stdout)["numbers"]["tb"]) for k in range(1, 9)}
    expect("the time of drift c differs from seed to seed", len(times) > 3 and "{tb}" in drift["parts"][2]["ask"], str(times))

    # as many digits of the second means as differ
    part = {"id": "a", "ask": "?", "kind": "number", "points": 1, "answer": "2*l", "second": "2*l*(1+1e-11)"}
    mine = {"exercise": 2, "id": "mine", "title": "t", "lesson": "l", "section": "s", "statement": ["s"], "draw": {"l": {"range": [1, 2], "digits": 2}}}
    worst = json.loads(run("problem", write(folder, "m.json", dict(mine, parts=[part])), "--check", "--json").stdout)["parts"]["a"]["worst_difference"]
    expect("the worst difference is measured", 0.9e-11 < worst < 1.1e-11, str(worst))

    # one line for a fault whose numbers differ; none is distinct where none is drawn
    same = dict(part, second="l+l", faults=[{"id": "same", "answer": "2*l", "says": "this is right", "share": 0}])
    done = run("problem", write(folder, "m.json", dict(mine, parts=[same])), "--seeds", "1..200", "--check", "--wide")
    lines = [x for x in done.stdout.splitlines() if " seed" in x]
    expect("a fault of every seed is one line", done.returncode == 3 and len(lines) == 1 and lines[0].startswith("  every seed; seed 1, part a: the mistake 'same' (")
           and "more" not in done.stdout, done.stdout)  # fmt: skip
    none = run("problem", write(folder, "m.json", dict(mine, conditions=["l-9"], parts=[part])), "--check").stdout
    expect("variants that cannot be drawn are not distinct", "20 variants, 0 distinct" in none, none)


def named_variant(folder):
    """A file without a seed that is graded with one says as which variant."""
    path = write(folder, "closure.json", {"c": 1})
    notes = [json.loads(run("grade", "closure", write(folder, "c.json", {"c": 1, **who}), "--seed", "5", "--json").stdout)["note"] for who in ({}, {"seed": 5})]
    expect("the variant is named where the file names none", "graded as that of seed 5" in notes[0] and notes[1] == "", str(notes))
    bad = {"J": [["l1*sin(th1)", "-l2*sin(th2)", "l3*sin(th3)", "l4*cos(th4)"], ["l1*cos(th1)", "l2*cos(th2)", "-l3*cos(th3)", "-l4*cos(th4)"]]}
    said = run("grade", "p3", "--seed", "42", write(folder, "bad.json", bad), "--wide").stdout
    states = re.findall(r"at +(l1 = [^J]*?)(?=\n  \S|\ncompared)", said)
    for entry, state in zip(("-l1*sin(th1)", "l4*sin(th4)"), states):
        x = {k: float(v) for k, v in re.findall(r"(\w+) = ([-0-9.e]+)", state)}
        expect(f"the state of {entry} closes the loop", abs(x["l1"] * math.cos(x["th1"]) + x["l2"] * math.cos(x["th2"]) - x["l3"] * math.cos(x["th3"]) - x["l4"] * math.cos(x["th4"])) < 1e-3, state)
    given = [float(v) for v in re.findall(r"given .* = ([-0-9.]+),", said)]
    x = {k: float(v) for k, v in re.findall(r"(\w+) = ([-0-9.e]+)", states[-1])}
    expect("each wrong entry has its own state", len(states) == 2 and states[0] != states[1] and abs(given[1] - x["l4"] * math.cos(x["th4"])) < 1e-3, said)
    expect("in 80 columns", all(len(line) <= 80 for state in states for line in ("at        " + state).splitlines()), said)
    hidden = write(folder, "hidden.json", {"rubric": 1, "exercise": "closure", "visibility": {"d": "hidden"}})
    for rubric, words in (([], "of 5"), (["--rubric", hidden], "of the 3 entries that are shown are right")):
        said = json.loads(run("grade", "closure", path, "--format", "gradescope", *rubric).stdout)["output"]
        expect(f"the summary of Gradescope: {words}", words in said, said)


def bad_variants(folder):
    """Every bad variant is listed with its reason."""
    with open("lessons/09-space-and-drives/problems/count-space.json", encoding="utf-8") as f:
        exercise = json.load(f)
    path = write(folder, "count.json", dict(exercise, conditions=["n-2.5"]))  # two of its mistakes may now give one number: n - k = 6
    done = run("problem", path, "--seeds", "1..60", "--check")
    report = json.loads(run("problem", path, "--seeds", "1..60", "--check", "--json").stdout)
    lines = [line.strip() for line in done.stdout.splitlines() if line.startswith("  seed ")]
    expect("every bad variant is listed", done.returncode == 3 and len(lines) == report["bad"] > 1 and all("'legs' (6) is named free" in line for line in lines), done.stdout)
    expect("and in JSON", report["bad_variants"].splitlines() == lines, str(report))
    many = write(folder, "many.json", dict(exercise, parts=[dict(p, faults=[{"id": "none", "answer": f"({p['answer']})+abs(n-10)-(n-10)", "says": "right", "share": 0}])
                                                                                  for p in exercise["parts"] if p["kind"] == "number"]))  # fmt: skip
    said = run("problem", many, "--seeds", "1..200", "--check").stdout
    listed, bad = said.count("\n  seed "), int(re.search(r"(\d+) variants are bad", said)[1])
    expect("what does not fit is counted", 0 < listed < bad < 200 and "every seed" not in said and f"  and {bad - listed} more\n" in said, said[-300:])


def choices(folder):
    """No choice is a guess: each has a reason, and neither is found by the length of its words."""
    parts = []
    for path in glob.glob(os.path.join(os.path.dirname(__file__), "..", "..", "lessons", "*", "problems", "*.json")):
        with open(path, encoding="utf-8") as f:
            parts += [p for p in json.load(f).get("parts", []) if p["kind"] == "choice"]
    expect("there are choices", len(parts) > 80, str(len(parts)))
    expect("every choice has a reason, among three at least",
           all(len(p.get(key, [])) >= (4 if key == "options" else 3) for p in parts for key in ("options", "reasons")))  # fmt: skip
    longest = {key: [next(o for o in p[key] if o.get("right")) is max(p[key], key=lambda o: len(o["text"])) for p in parts] for key in ("options", "reasons")}
    both = sum(a and b for a, b in zip(longest["options"], longest["reasons"]))
    # by chance it would be a quarter of the options
    expect("the longest option is seldom the right one", sum(longest["options"]) < 0.4 * len(parts), f"{sum(longest['options'])} of {len(parts)}")
    expect("the longest option with the longest reason earns little", both < len(parts) / 4, f"{both} of {len(parts)}")

    # the letters of a seed: what is right is found by trying
    def entries(choice, reason):
        answer = write(folder, "choice.json", {"s1": {"choice": choice, "reason": reason}})
        verdict = json.loads(run("grade", "slips-2", answer, "--seed", "3", "--format", "json").stdout)
        return {e["name"]: e for e in verdict["entries"] if e["name"].startswith("s1.")}

    right = next(c for c in "abcd" if entries(c, "a")["s1.choice"]["right"])
    reason = next(c for c in "abcd" if entries(right, c)["s1.reason"]["right"])
    wrong = entries(next(c for c in "abcd" if c != right), reason)
    expect("a reason counts beside the right choice", entries(right, reason)["s1.reason"]["points"] == 0.5)
    expect("and beside no other", wrong["s1.reason"]["points"] == 0 and wrong["s1.reason"]["mistake"] == "unsupported", str(wrong))


def own_exercise(folder):
    """An exercise in a file of one's own: shown, proved and graded by its path."""
    part = {"id": "a", "ask": "?", "kind": "number", "points": 1, "answer": "2*l", "second": "l+l", "unit": "m"}
    exercise = {"exercise": 2, "id": "mine", "title": "t", "lesson": "l", "section": "s", "statement": ["s"],
                "draw": {"l": {"range": [1, 2], "digits": 2}}, "parts": [part]}  # fmt: skip
    path = write(folder, "mine.json", exercise)
    done = run("problem", path, "--check")
    expect("a file is checked", done.returncode == 0 and "0 variants are bad" in done.stdout, done.stdout + done.stderr)
    done = run("grade", path, write(folder, "answer.json", {"a": 0}))
    expect("and graded", done.returncode == 0 and "score 0 of 1" in done.stdout, done.stdout + done.stderr)
    part["second"] = "l+1.01*l"
    expect("a file that proves wrong is the exercise's fault", run("problem", write(folder, "mine.json", exercise), "--check").returncode == 3)
    expect("a file that is not there is the command line's", run("problem", path + "x.json").returncode == 2)


def broken_exercise(folder):
    """An exercise that is at fault is the program's fault, whatever is handed in."""
    home = os.path.join(folder, "home")
    problems = os.path.join(home, "lessons", "01-x", "problems")
    os.makedirs(problems)
    os.makedirs(os.path.join(home, "web"))
    part = {"id": "a", "ask": "?", "kind": "number", "points": 1, "answer": "1/l", "second": "1/l"}
    exercise = {"exercise": 2, "id": "x1", "title": "t", "lesson": "l", "section": "s", "statement": ["s"],
                "draw": {"l": {"value": 0}}, "parts": [part]}  # fmt: skip
    write(problems, "x1.json", exercise)
    path = write(folder, "a.json", {"a": 1})
    done = run("grade", "x1", path, home=home)
    expect("a reference that is not finite is the exercise's fault", done.returncode == 3, f"{done.returncode} {done.stdout}{done.stderr}")
    done = run("problem", "x1", "--check", home=home)
    expect("the check finds it", done.returncode == 3 and "not finite" in done.stdout, done.stdout)
    part["kind"] = "numbr"
    write(problems, "x1.json", exercise)
    done = run("grade", "x1", path, home=home)
    expect("a kind that does not exist is named with its near miss", done.returncode == 3 and "number" in done.stderr, done.stderr)
    with open(os.path.join(problems, "x1.json"), "w", encoding="utf-8") as f:
        f.write("{ broken")
    done = run("grade", "x1", path, home=home)
    named = "line 1" in done.stderr and "the file of the exercise 'x1' cannot be used" in done.stderr
    expect("an exercise that is not JSON is named", done.returncode == 3 and named, f"{done.returncode} {done.stderr}")


def unproven_exercise(folder):
    """A reference that its second means denies: files and classes end with 3, each result names the cause."""
    part = {"id": "a", "ask": "?", "kind": "number", "points": 1, "answer": "2*l", "second": "3*l"}
    path = write(folder, "unproven.json", {"exercise": 2, "id": "unproven", "title": "t", "lesson": "06-drift", "section": "s",
                                           "statement": ["s {l}"], "draw": {"l": {"range": [2, 9], "digits": 0}}, "parts": [part]})  # fmt: skip
    answer = write(folder, "answer.json", {"a": 1})
    for form in ("json", "gradescope", "prairielearn", "autolab", "coderunner", "lti-score", "junit", "csv", "html"):
        done = run("grade", path, answer, "--format", form)
        expect(f"{form} says that the exercise is at fault", done.returncode == 3 and "by the second means" in done.stdout, done.stdout + done.stderr)
    results = os.path.join(folder, "results")
    done = run("grade", path, answer, "--out", results + "/")
    expect("--out holds a result", done.returncode == 3 and b"by the second means" in read(os.path.join(results, "answer.txt")), done.stderr)
    students = os.path.join(folder, "class")
    os.makedirs(students)
    for name in ("ada", "bob"):
        write(students, name + ".json", {"a": 1})
    scores = os.path.join(folder, "scores.csv")
    done = run("grade", path, students, "--out", scores)
    lines = read(scores).decode().splitlines()[1:]
    expect("a class ends with 3 as well", done.returncode == 3 and done.stderr.count("the exercise is at fault") == 1, done.stdout + done.stderr)
    expect("each line of it names the cause", len(lines) == 2 and all("the exercise is at fault" in x and "by the second means" in x for x in lines), str(lines))


def notes_of_mistakes(_):
    """Each mistake of a shipped exercise has a whole sentence: it follows 'probably this mistake'."""
    n = 0
    for path in sorted(glob.glob("lessons/*/problems/*.json")):
        for part in json.loads(read(path))["parts"] if "parts" in json.loads(read(path)) else []:
            for fault in part.get("faults", []):
                if "says" not in fault:
                    continue
                says, n = fault["says"], n + 1
                verb = re.search(r"\b(?:is|are|was|were|has|have|had|would|must|can|does|do|did|[a-z]+s|[a-z]+ed|differentiate|divide|count|subtract|multiply|take)\b", says)
                expect(f"{os.path.basename(path)} {part['id']} {fault['id']} is a sentence", len(says.split()) > 2 and bool(verb), says)
    expect("there are mistakes to look at", n > 300, str(n))


def indented(text, start, end):
    """The indented block of a Markdown text from the line with `start` to the line with `end`, without its indent."""
    lines = text.splitlines()
    first = next(k for k, line in enumerate(lines) if start in line and line.startswith("    "))
    last = next(k for k in range(first, len(lines)) if lines[k].strip() == end)
    indent = len(lines[first]) - len(lines[first].lstrip())
    return "\n".join(line[indent:] for line in lines[first : last + 1]) + "\n"


def the_guide_for_teachers(folder):
    """What lessons/README.md shows: an exercise to copy, and a script for Gradescope."""
    with open("lessons/README.md", encoding="utf-8") as f:
        text = f.read()
    exercise = text[text.rindex("    {\n", 0, text.index('"id": "ramp"')) :]
    ramp = json.loads(exercise[: exercise.index("\n    }\n") + 6])
    home = os.path.join(folder, "guide")
    problems = os.path.join(home, "lessons", ramp["lesson"], "problems")
    os.makedirs(os.path.join(home, "web"))
    os.makedirs(problems)
    write(problems, "ramp.json", ramp)
    done = run("problem", "ramp", "--seeds", "1..200", "--check", "--json", home=home)
    report = json.loads(done.stdout)
    expect("the guide's exercise passes its check", done.returncode == 0 and report["variants"] == 200 and report["bad"] == 0, done.stdout)

    second = text[text.index("    {\n", text.index("This is a second part of the ramp")) :]
    ramp["parts"].append(json.loads(second[: second.index("\n    }\n") + 6]))
    done = run("problem", write(folder, "two.json", ramp), "--seeds", "1..50", "--check", "--json")
    expect("and so does its part with states", done.returncode == 0 and json.loads(done.stdout)["right_answers"] == 100, done.stdout + done.stderr)

    third = text[text.index("    {\n", text.index("A part of the kind `choice` has")) :]
    choice = json.loads(third[: third.index("\n    }\n") + 6])
    done = run("problem", write(folder, "three.json", dict(ramp, parts=[*ramp["parts"], choice])), "--seeds", "1..50", "--check", "--json")
    expect("and so does its choice", done.returncode == 0 and json.loads(done.stdout)["right_answers"] == 150, done.stdout + done.stderr)
    step = re.search(r"write `(\{\"student\": .*?\})`", text)[1]
    said = run("grade", write(folder, "ramp.json", dict(ramp, parts=ramp["parts"][:1])), write(folder, "answer.json", step)).stdout
    expect("the wrong answer of step 5 is named", "this is the force along the ramp" in said and "score 0.5 of 1" in said, said)

    # a fault of the file is said once, with its line
    for change, said in (({"statement": ["{m} kg", "{len} m"]}, "every seed: {len} is no number that is drawn (line 9 of the file)"),
                         ({"hints": ["{=m*q} N"]}, "every seed: {=m*q} is no formula of the numbers that are drawn (line"),
                         ({"draw": dict(ramp["draw"], m={"range": [2, 0.3]})}, "every seed: the name 'm' has a range whose first number is above its second (line 11 of the file)"),
                         ({"parts": [dict(ramp["parts"][0], ask="{mm} kg?")]}, "every seed, part a: {mm} is no number that is drawn (line"),
                         ({"parts": [dict(ramp["parts"][0], answer="m*q")]}, "every seed, part a: column 3: 'q' is not known here (line")):  # fmt: skip
        path = write(folder, "slip.json", json.dumps(dict(ramp, **change), indent=1))
        done = run("problem", path, "--seeds", "1..20", "--check")
        lines = [line.strip() for line in done.stdout.splitlines() if " seed" in line]
        expect(f"a slip in the file is one line: {said}", done.returncode == 3 and len(lines) == 1 and lines[0].startswith(said), done.stdout)

    # the script, with its folders here and this program
    place = os.path.join(folder, "autograder")
    os.makedirs(os.path.join(place, "submission"))
    write(place, "submission_metadata.json", {"users": [{"email": "ada@example.org"}]})
    gears = json.loads(run("problem", "gears", "--student", "ada@example.org", "--json").stdout)["numbers"]["k"]
    write(os.path.join(place, "submission"), "answer.json", {"student": "ada@example.org", "c": 2 * (gears - 1)})
    script = indented(text, "#!/bin/sh", "exit 0").replace("/autograder", place).replace("holonom grade", f"{os.path.abspath(PROGRAM)} grade")
    subprocess.run(["/bin/sh", write(folder, "run_autograder", script)], capture_output=True, text=True, timeout=120, check=True)
    with open(os.path.join(place, "results", "results.json"), encoding="utf-8") as f:
        result = json.load(f)
    expect("the guide's script grades for Gradescope", result["score"] == 1 and len(result["tests"]) >= 3, str(result)[:300])


if __name__ == "__main__":
    sys.exit(speak_tap([
        variants, checks, proof, named_variant, bad_variants, choices, own_exercise, broken_exercise,
        unproven_exercise, notes_of_mistakes,
        the_guide_for_teachers,
    ]))
