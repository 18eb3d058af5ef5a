# SPDX-License-Identifier: GPL-3.0-or-later
"""Exercises from the shell: variants, checks, verdicts and their exit statuses, grading again. Speaks TAP."""

import base64
import csv
import glob
import json
import os
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

PROGRAM = os.environ.get("HOLONOM", "build/holonom")
RESULTS = []


def run(*words, home=None):
    env = dict(os.environ, HOLONOM_HOME=home) if home else os.environ
    return subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=120, env=env)


def expect(name, good, said=""):
    RESULTS.append((name, good, said))


def write(folder, name, content):
    path = os.path.join(folder, name)
    with open(path, "w", encoding="utf-8") as f:
        f.write(content if isinstance(content, str) else json.dumps(content))
    return path


def variants():
    a, b, c = (run("problem", "p1", *w).stdout for w in (["--seed", "42"], ["--seed", "42"], ["--seed", "43"]))
    expect("the same seed gives the same text", a == b and a != c)
    s, t = (run("problem", "p1", "--student", n).stdout for n in ("s1001", "s1002"))
    expect("every student has a variant", s != t and s == run("problem", "p1", "--student", "s1001").stdout)
    formula = next(line for line in run("problem", "loops").stdout.splitlines() if line.startswith('  answer "e"'))
    expect("a formula may use the numbers that are given, by their names",
           formula.endswith("names: th2 th3 w1 w2 w3; with numbers given: b j l1 l2 l3 d th1"), formula)
    own, other = (run("problem", "p3", "--student", n).stdout for n in ("s1001", "s1002"))
    numbers = json.loads(run("problem", "p3", "--student", "s1001", "--json").stdout)["numbers"]
    expect("so has the exercise whose formulas are the same for all", own != other and '{"student": "s1001", "J": ' in own
           and all(f"{name} = {x:.6f}" in own and f"{name} = {x:.6f}" not in other for name, x in numbers.items()), own)  # fmt: skip
    hints = run("problem", "p1", "--hint", "1").stdout
    expect("a hint is printed when asked for", hints.startswith("hint 1 of 3:") and hints.count("hint") == 1, hints)
    written = {name: run("problem", name).stdout for name in ("closure", "p1", "slips-1")}
    expect("an exercise with formulas says how they are written, once",
           {name: (text.count("Formulas: "), text.count("Formulas of matrices: ")) for name, text in written.items()}
           == {"closure": (1, 0), "p1": (0, 1), "slips-1": (0, 0)}, str(written))  # fmt: skip
    near = run("problem", "p11111")
    expect("an unknown exercise is the input's fault", near.returncode == 2, near.stderr)


def checks():
    done = run("problem", "p4", "--seeds", "1..10", "--check", "--json")
    report = json.loads(done.stdout)
    expect("a sound exercise passes its check", done.returncode == 0 and report["variants"] == 10 and report["bad"] == 0, done.stdout)
    expect("its mistakes were tried", report["mistakes"] >= 100 and report["right_answers"] == 40, done.stdout)
    bad = run("problem", "p4", "--seeds", "9..1", "--check")
    expect("a range that is none is refused", bad.returncode == 2 and "9..1" in bad.stderr, bad.stderr)


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


def statuses(folder):
    right = {"a": {"matrix": [["M", "J'"], ["J", "0"]], "right": ["S'*tau - h", "-gamma"], "unknowns": ["a", "-lambda"]}}
    path = write(folder, "right.json", right)
    done = run("grade", "p1", path, "--format", "json", "--seed", "5")
    verdict = json.loads(done.stdout)
    expect("a right part earns its points", done.returncode == 0 and verdict["score"] == 4, done.stdout[:300])
    for name, content, status in (
        ("wrong is graded", {"a": {"matrix": [["0", "0"], ["0", "0"]], "right": ["0", "0"]}}, 0),
        ("an answer nobody can read is not graded", {"a": "?", "b": "?"}, 2),
        ("an empty object is not graded", {}, 2),
        ("broken JSON is not graded", "{", 2),
    ):
        done = run("grade", "p1", write(folder, "x.json", content))
        expect(name, done.returncode == status, f"{done.returncode}: {done.stdout}{done.stderr}")

    # a pipe under the names of standard input
    for name in ("-", "/dev/stdin"):
        done = subprocess.run([PROGRAM, "grade", "p1", name, "--seed", "5", "--format", "json"], input=json.dumps(right), capture_output=True, text=True)
        expect(f"{name} is standard input", done.returncode == 0 and json.loads(done.stdout)["score"] == 4, done.stdout[:300])
    done = run("grade", "fourbar", write(folder, "bare.json", {"b": "m2 l1 l2 cos th1-th2"}), "--no-pictures")
    expect("a function before a sum is remarked", "'cos th1' was read without the sum behind it" in done.stdout, done.stdout)

    # what the verdict says is reproduced
    kept = write(folder, "verdict.json", verdict)
    again = run("regrade", kept, "--json")
    expect("a verdict is reproduced", json.loads(again.stdout)["same"] and again.returncode == 0, again.stdout)
    other = dict(verdict, score=1, problem_hash="0" * 16)
    again = run("regrade", write(folder, "other.json", other))
    expect("another score and a changed exercise are said", "ANOTHER SCORE" in again.stdout and "exercise has changed" in again.stdout, again.stdout)
    expect("what is no verdict is refused", run("regrade", path).returncode == 2)


def hand_in_line(*words):
    text = run("problem", "p1", *words).stdout
    return json.loads(text.split("Hand in a JSON file: ")[1].splitlines()[0].replace("...", "null"))


def own_variant(folder):
    """The hand-in line names its variant, and the grader grades that one and no other."""
    plain, seeded, named = hand_in_line(), hand_in_line("--seed", "7"), hand_in_line("--student", 'Ada "x"')
    expect("the exercise's own variant is not named", list(plain)[0] == "a" and not {"seed", "student"} & set(plain), str(plain))
    expect("the hand-in line begins with its seed", list(seeded.items())[:2] == [("seed", 7), ("a", None)], str(seeded))
    expect("the hand-in line begins with its student", list(named.items())[:2] == [("student", 'Ada "x"'), ("a", None)], str(named))

    answer = {"a": {"matrix": [["M", "J'"], ["J", "0"]], "right": ["S'*tau - h", "-gamma"], "unknowns": ["a", "-lambda"]}}
    drawn = json.loads(run("problem", "p1", "--student", "s1001", "--json").stdout)["seed"]
    for name, said, seed in (("number", {"seed": 7}, "7"), ("text", {"seed": "7"}, "7"), ("student", {"student": "s1001"}, drawn)):
        path = write(folder, "own.json", dict(said, **answer))
        done = run("grade", "p1", path, "--json")
        expect(f"the file's variant is graded ({name})", done.returncode == 0 and json.loads(done.stdout)["seed"] == seed, done.stdout[:300])
        same = run("grade", "p1", path, "--seed", seed)
        expect(f"the same variant is no other ({name})", same.returncode == 0, same.stdout)
        other = run("grade", "p1", path, "--seed", "8")
        expect(f"another variant is refused ({name})", other.returncode == 2 and "the submission answers the variant of" in other.stdout, other.stdout)


def forms(folder):
    path = write(folder, "some.json", {"b": {"choice": "a", "reason": "a"}, "d": "b"})
    junit = run("grade", "p1", path, "--format", "junit").stdout
    suite = xml.etree.ElementTree.fromstring(junit)[0]
    failures = [c for c in suite if c.find("failure") is not None]
    expect("JUnit counts its cases and failures", len(suite) == int(suite.get("tests")) and len(failures) == int(suite.get("failures")) > 0, junit)
    other = write(folder, "other.json", {})
    several = run("grade", "p1", path, other, "--format", "junit")
    suites = xml.etree.ElementTree.fromstring(several.stdout)
    expect("several verdicts are one document of JUnit", several.returncode == 2 and suites.tag == "testsuites" and len(suites) == 2, several.stdout)
    expect("whose suites have the names of the files", suites[0].get("name").endswith(path) and suites[1].get("name").endswith(other), several.stdout)
    done = run("grade", "p1", path, "--format", "junit", "--out", os.path.join(folder, "some.xml"))
    expect("a file of JUnit is whole", done.returncode == 0 and len(xml.etree.ElementTree.parse(os.path.join(folder, "some.xml")).getroot()) == 1, done.stderr)
    lines = list(csv.reader(run("grade", "p1", path, path, "--format", "csv", "--student", "=cmd()").stdout.splitlines()))
    expect("CSV has one head and a line for each file", [line[0] for line in lines if line] == ["problem", "p1", "p1"], str(lines))
    expect("CSV hands no formula to a spreadsheet", lines[1][1] == " =cmd()", str(lines))
    html = run("grade", "p1", write(folder, "bad.json", {"b": {"choice": "<script>", "reason": "a"}, "d": "b"}), "--format", "html").stdout
    expect("HTML escapes what was handed in", "<script>" not in html and "&#60;script&#62;" in html, html)
    bad = run("grade", "p1", write(folder, "none.json", {}), "--format", "junit")
    expect("a submission that cannot be graded is an error of JUnit", bad.returncode == 2 and "<error" in bad.stdout, bad.stdout)
    near = run("grade", "p1", path, "--format", "junti")
    expect("a form is suggested", near.returncode == 2 and "junit" in near.stderr, near.stderr)


def platforms(folder):
    """One score in the documents of all platforms, with the fields that each asks for."""
    some = write(folder, "some.json", {"a": 1, "e": "l_2 l_3 sin(th2-th3)", "d": ["2,5", 1]})
    told = {form: run("grade", "fourbar", some, "--format", form, "--student", "s7").stdout
            for form in ("json", "gradescope", "prairielearn", "autolab", "coderunner", "lti-score")}  # fmt: skip
    lines = told["autolab"].splitlines()
    d = {form: json.loads(text) for form, text in told.items() if form != "autolab"}
    score, full = d["json"]["score"], d["json"]["max_score"]
    expect("the score is neither nothing nor all", 0 < score < full, str(score))
    expect("Gradescope: score and a test an entry", d["gradescope"]["score"] == score and len(d["gradescope"]["tests"]) == 6)
    p = d["prairielearn"]
    expect("PrairieLearn: a share, and tests that sum up", p["gradable"] and abs(p["score"] - score / full) < 1e-12
           and sum(t["points"] for t in p["tests"]) == score, told["prairielearn"])  # fmt: skip
    scores, stages = json.loads(lines[-1])["scores"], json.loads(lines[0])
    expect("Autolab: the last line has a score for each part", list(scores) == ["a", "b", "c", "d", "e"] and sum(scores.values()) == score, lines[-1])
    expect("Autolab: feedback for each part", stages["_presentation"] == "semantic" and stages["Grade"]["e"] == {"passed": True}
           and "comma" in stages["Grade"]["d"]["hint"], lines[0])  # fmt: skip
    c = d["coderunner"]
    expect("CodeRunner: a fraction and a table with a format a column", abs(c["fraction"] - score / full) < 1e-12
           and len(c["testresults"]) == 7 and {len(r) for r in c["testresults"]} == {4} and len(c["columnformats"]) == 3, told["coderunner"])  # fmt: skip
    t = d["lti-score"]
    expect("LTI: the score of a user", (t["userId"], t["scoreGiven"], t["scoreMaximum"], t["gradingProgress"]) == ("s7", score, full, "FullyGraded"))
    expect("LTI: a time with parts of a second", bool(re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z", t["timestamp"])), t["timestamp"])

    # what cannot be graded costs nothing where the platform knows that
    none = write(folder, "none.json", {})
    out = {form: run("grade", "fourbar", none, "--format", form) for form in told}
    expect("what cannot be graded ends with 2 in every form", {o.returncode for o in out.values()} == {2})
    p, t = json.loads(out["prairielearn"].stdout), json.loads(out["lti-score"].stdout)
    expect("PrairieLearn: not gradable, with the reason", p["gradable"] is False and "score" not in p and p["format_errors"])
    expect("LTI: no score", t["gradingProgress"] == "Failed" and "scoreGiven" not in t)
    expect("Autolab: the reason is the feedback", "no part" in json.loads(out["autolab"].stdout.splitlines()[0])["Grade"]["fourbar"]["hint"])

    # pictures, as part of the document and beside it
    matrix = [["l1*sin(th1)"] + ["1"] * 3, ["1"] * 4]
    wrong = write(folder, "wrong.json", {"J": matrix})
    done = run("grade", "p3", wrong, "--format", "prairielearn", "--out", os.path.join(folder, "new", "results"))
    path = os.path.join(folder, "new", "results")
    with open(os.path.join(path, "results.json"), encoding="utf-8") as f:
        image = json.load(f)["images"][0]["url"]
    with open(os.path.join(path, "results.png"), "rb") as f:
        png = f.read()
    head, _, data = image.partition(",")
    expect("the folder is made, and the picture is in the document", done.returncode == 0 and head == "data:image/png;base64" and base64.b64decode(data) == png)
    with_it, without = (run("grade", "p3", wrong, "--format", "html", *more).stdout for more in ([], ["--no-pictures"]))
    expect("HTML holds the picture unless told otherwise", "<img" in with_it and "<img" not in without and with_it.count("<tr") == without.count("<tr"))


def rubrics(folder):
    """A teacher's points, tolerances, shares and hints; each fault with its line."""
    own = run("rubric", "write", "fourbar").stdout
    path = write(folder, "own.json", own)
    told = run("rubric", "check", path)
    expect("an exercise's own rubric is sound", told.returncode == 0 and "8 points" in told.stdout and "rounded to 3 digits" in told.stdout, told.stdout)
    slip = write(folder, "slip.json", {"b": "-m2*l1*l2*cos(th1-th2)/2", "e": "l2*l3*sin(th2-th3)", "hints": 2})
    before, same = (json.loads(run("grade", "fourbar", slip, "--json", *more).stdout)["score"] for more in ([], ["--rubric", path]))
    expect("it changes no score", before == same == 2, f"{before}, {same}")

    # nor does that of any exercise, also where two mistakes meet, or a mistake has another share in each kind of answer
    placed = json.loads(run("grade", "assemble", write(folder, "far.json", {"a": {"th2": 100, "th3": 100}}), "--show-expected", "--json").stdout)["entries"]
    turned = {e["name"].split(".")[1]: -float(e["expected"].split()[0]) for e in placed if e["name"].startswith("a.")}
    for name, answers in (("fourbar", {"b": "-m2*l1*l2*cos(th1+th2)/2", "c": "0", "d": [1, 2], "e": "-l2*l3*cos(th2-th3)"}), ("assemble", {"a": turned}),
                          ("p3", {"J": [["l1*sin(th1)", "-l2*sin(th1)", "l3", "l4*cos(th4)"], ["l1*cos(th1*pi/180)", "-2*l2*cos(th2)", "3.14", "0"]]})):
        answer, kept = write(folder, "answer.json", answers), write(folder, f"{name}-own.json", run("rubric", "write", name).stdout)
        scores = [json.loads(run("grade", name, answer, "--json", *more).stdout)["score"] for more in ([], ["--rubric", kept])]
        expect(f"nor does that of {name}", scores[0] == scores[1] and scores[0] > 0, str(scores))

    # b is worth 6, a sign a quarter of it, and two hints cost 0.5
    other = dict(json.loads(own), total=12, shares={"sign": 0.25}, hints=[0.25, 0.25], points={"a": 1, "b": 6, "c": 2, "d": 2, "e": 1})
    path = write(folder, "other.json", other)
    verdict = run("grade", "fourbar", slip, "--json", "--rubric", path).stdout
    v = json.loads(verdict)
    expect("points, shares and hints are the rubric's", (v["score"], v["max_score"]) == (6 * 0.25 + 1 - 0.5, 12) and "hints cost 0.5" in v["note"], verdict)
    two = write(folder, "two.json", {"b": "-m2*l1*l2*cos(th1+th2)/2"})
    shares = write(folder, "shares.json", dict(json.loads(own), shares={"sum-of-angles": 0.5}))
    half, quarter = (json.loads(run("grade", "fourbar", two, "--json", *more).stdout)["score"] for more in (["--rubric", shares], []))
    expect("a second mistake lowers the rubric's share too", half == 2 * quarter > 0, f"{half}, {quarter}")

    # when Gradescope shows a part; a name that is there twice
    late = write(folder, "late.json", dict(json.loads(own), visibility={"b": "after_due_date", "d": "hidden"}))
    tests = json.loads(run("grade", "fourbar", slip, "--format", "gradescope", "--rubric", late).stdout)["tests"]
    expect("a part is shown when the rubric says", {t["name"]: t["visibility"] for t in tests} == {"part a": "visible", "part b": "after_due_date",
           "part c": "visible", "part d.1": "hidden", "part d.2": "hidden", "part e": "visible"}, str(tests)[:300])  # fmt: skip
    expect("and check says it", "b        in Gradescope: after_due_date" in run("rubric", "check", late).stdout)
    for text, said in ((json.dumps(dict(json.loads(own), visibility={"b": "after_due"})), "after_due_date"),
                       (own.replace('"points": {', '"points": {"a": 3, '), "'a' is there more than once")):
        done = run("rubric", "check", write(folder, "bad.json", text))
        expect(f"a faulty rubric is refused: {said}", done.returncode == 2 and said in done.stderr, done.stderr)

    # what is no rubric
    for fields, said in (({"points": [1, 2]}, '"points" is an object'), ({"visibility": ["hidden"]}, '"visibility" is an object'), ({"shares": 3}, '"shares" is an object'),
                         ({"tolerance": [{}]}, '"tolerance" is an object'), ({"tolerance": {"a": 3}}, "the tolerance of part a is an object"),
                         ({"hints": {"a": 1}}, '"hints" is a list'), ({"hints": [1, 1, 1]}, "has 2 hints, not 3"), ([1], "a rubric is an object")):  # fmt: skip
        bad = write(folder, "bad.json", fields if isinstance(fields, list) else {"rubric": 1, "exercise": "fourbar", **fields})
        for words in (("rubric", "check", bad), ("grade", "fourbar", slip, "--rubric", bad)):
            done = run(*words)
            expect(f"{words[0]} refuses {fields}", done.returncode == 2 and said in " ".join(done.stderr.split()), f"{done.returncode} {done.stderr}")

    kept = write(folder, "kept.json", verdict)
    expect("a verdict names its rubric", "name it with --rubric" in run("regrade", kept).stdout)
    expect("and is reproduced with it", json.loads(run("regrade", kept, "--rubric", path, "--json").stdout)["same"])
    loose = write(folder, "loose.json", dict(other, tolerance={"d": {"relative": 0.3}}))
    d = json.loads(run("grade", "fourbar", write(folder, "ask.json", {"d": [1e150, 1e150]}), "--show-expected", "--json").stdout)["entries"]
    near = write(folder, "near.json", {"d": [1.2 * float(e["expected"].split()[0]) for e in d if e["name"].startswith("d")]})
    marks = [json.loads(run("grade", "fourbar", near, "--json", "--rubric", r).stdout)["score"] for r in (path, loose)]
    expect("a tolerance is the rubric's", marks == [0, 2], str(marks))

    # every kind of fault, with its line
    for what, change, said in (("part", {"points": {"bb": 1}}, "no part 'bb'"), ("mistake", {"shares": {"sgn": 1}}, "no mistake 'sgn'"),
                               ("field", {"hint": []}, "no field 'hint'"), ("total", {"total": 3}, "sum up to 12, not 3"),
                               ("tolerance", {"tolerance": {"a": {"relative": 1e-12}}}, "below the error of the reference"),
                               ("share", {"shares": {"sign": 2}}, "from 0 to 1"), 
                               ("number", {"points": {"a": "x"}}, "needs a number")):  # fmt: skip
        text = json.dumps(dict(other, **change), indent=1)
        done = run("rubric", "check", write(folder, "bad.json", text))
        line = re.search(r"line (\d+)", done.stderr)
        key = list(next(iter(change.values())))[0] if isinstance(next(iter(change.values())), dict) else next(iter(change))
        good = done.returncode == 2 and said in done.stderr and line and f'"{key}"' in text.splitlines()[int(line[1]) - 1]
        expect(f"a wrong {what} is named with its line", bool(good), done.stderr)


def whole_check(folder):
    """A rubric's faults are told all at once, each with its line; a part's own mistakes are listed."""
    bad = write(folder, "worst.json", json.dumps({"rubric": 1, "exercise": "fourbar", "hint": [], "points": {"bb": 1, "a": "x"},
                                                  "tolerance": {"a": {"relative": 1e-12}}, "shares": {"sgn": 1}, "total": 3}, indent=1))  # fmt: skip
    told = run("rubric", "check", bad).stderr
    said = ["no field 'hint'", "no part 'bb'", "needs a number", "below the error", "no mistake 'sgn'", "sum up to"]
    expect("all faults of a rubric are told at once", all(s in told for s in said), told)
    expect("each with its line", len(re.findall(r"line \d+: ", told)) >= 6, told)
    shapeless = os.path.join(folder, "shapeless.json")
    with open(shapeless, "w", encoding="utf-8") as f:
        f.write('{"rubric": 1, "exercise": "gears",\n "points": {"a": 1,\n  "foo": 1},\n "hints": ["x"],\n "foo": 5,\n "shares": [1],\n'
                ' "tolerance": {"a": 3,\n  "c": {"relative": 2}}}')
    told = run("rubric", "check", shapeless).stderr
    for line, fault in ((3, "has no part 'foo'"), (4, 'entry 1 of "hints" needs a number from 0'), (5, "no field 'foo'"), (6, '"shares" is an object'),
                        (7, "the tolerance of part a is an object"), (8, "tolerance 2 of part c is too wide")):
        expect(f"beside a fault of shape, line {line} is named", re.search(rf"line {line}: .*{re.escape(fault)}", told) is not None, told)
    with open(shapeless, "w", encoding="utf-8") as f:
        f.write('{"rubric": 1, "exercise": "gears", "shares": [1], "shares": [2], "points": [1], "points": 3, "visibility": 1, "visibility": ["x"]}')
    twice = run("rubric", "check", shapeless)
    expect("a field of another shape that is there twice is refused twice", twice.returncode == 2 and twice.stderr.count('"shares" is an object') == 2, twice.stderr)
    told = run("problem", "closure", "--seeds", "1..2", "--check").stdout
    expect("the mistakes that an exercise names are listed", "mistakes of part a: along-y coupler-sign" in told, told)


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


def whose_variant(folder):
    """The name in a file reaches every verdict; a file that says two variants is refused."""
    path = write(folder, "ada.json", {"student": "ada", "a": 1})
    told = {form: run("grade", "fourbar", path, "--format", form).stdout for form in ("json", "csv", "lti-score", "html", "text")}
    expect("the name in a file reaches every form", all("ada" in text for text in told.values()), str(told))
    both = write(folder, "both.json", {"student": "ada", "seed": 7, "a": 1})
    done = run("grade", "fourbar", both)
    expect("a seed and another student's name contradict", done.returncode == 2 and "seed 7 and student 'ada'" in done.stdout, done.stdout)
    done = run("grade", "fourbar", both, "--seed", "7")
    expect("a seed that was asked for wins, and it is said", done.returncode == 0 and "not as that of 'ada'" in done.stdout, done.stdout)
    shown = run("grade", "closure", write(folder, "f.json", {"a": "l1"}), "--show-expected").stdout
    expect("the formula expected is printed", "expected  -l1*sin(th1)*u1-l2*sin(th2)*u2" in shown, shown)
    rates = write(folder, "rates.json", '{"b": "-l3*\\\\sin(\\\\theta_3)*\\\\dot\\\\theta_3"}')
    expect("a rate of LaTeX is read", "1 / 1  right" in run("grade", "closure", rates).stdout, run("grade", "closure", rates).stdout)


def rates_of_a_part(folder):
    """Every spelling of the crank's rate is the rate that the part asks for, not the given speed."""
    for spelt in ("u1", "w1", "omega_1", "\\omega_1", "\\dot\\theta_1", "\\dot{\\theta}_1", "thdot1"):
        second = "\\dot\\theta_2" if "dot\\" in spelt else "u2"
        path = write(folder, "rate.json", {"student": "s1001", "a": f"-l1*sin(th1)*{spelt}-l2*sin(th2)*{second}"})
        done = run("grade", "closure", path)
        expect(f"closure a with {spelt} is right", "2 / 2  right" in done.stdout, done.stdout + done.stderr)
        path = write(folder, "rate.json", {"c": f"-m2*l1*l2*sin(th1-th2)*{spelt}^2/2+9.81*m2*l2*cos(th2)/2"})
        done = run("grade", "fourbar", path)
        expect(f"fourbar c with {spelt} squared is right", "2 / 2  right" in done.stdout, done.stdout + done.stderr)

    # the given number keeps its name where the part has no such rate; of two rates the name must say which
    part = {"id": "a", "ask": "?", "kind": "formula", "points": 1, "states": {"x": {"range": [1, 2]}}, "answer": "w1*x", "second": "x*w1"}
    exercise = {"exercise": 2, "id": "mine", "title": "t", "lesson": "l", "section": "s", "statement": ["s"],
                "draw": {"w1": {"range": [2, 3], "digits": 1, "unit": "rad/s"}}, "parts": [part]}  # fmt: skip
    for spelt in ("w1", "omega1"):
        done = run("grade", write(folder, "mine.json", exercise), write(folder, "a.json", {"a": f"{spelt}*x"}))
        expect(f"{spelt} is the given number", "1 / 1  right" in done.stdout, done.stdout)
    part.update(states={"u1": {"range": [1, 2]}, "om1": {"range": [3, 4]}}, answer="u1-om1", second="-om1+u1")
    done = run("grade", write(folder, "mine.json", exercise), write(folder, "a.json", {"a": "omega_1-u1"}))
    expect("a name of two rates is unreadable, and both are named", done.returncode == 2 and "'omega1' may be om1 or u1" in done.stdout, done.stdout)


def nothing_for_nothing(folder):
    """A formula that is 0, or one number everywhere, earns nothing and is not told what it lacks."""
    for exercise, part in (("fourbar", "b"), ("fourbar", "c"), ("fourbar", "e"), ("closure", "b"), ("code", "b"), ("code", "d")):
        for zero in ("0", "th3-th3" if part in "be" and exercise != "fourbar" else "th2-th2", "3.5"):
            zero = zero.replace("2", "3") if (exercise, part) == ("closure", "b") else zero
            done = json.loads(run("grade", exercise, write(folder, "0.json", {part: zero}), "--json").stdout)
            entry = [e for e in done["entries"] if e["name"] == part][0]
            expect(f"{exercise} {part} = {zero} earns 0", done["score"] == 0 and entry["mistake"] in ("zero", "constant", "point-masses", "masked"), str(entry))
    for exercise, part in (("driven", "b"), ("code", "f")):
        zero = json.loads(run("grade", exercise, write(folder, "0.json", {part: 0}), "--json").stdout)
        expect(f"{exercise} {part} = 0 earns 0", zero["score"] == 0, str(zero["entries"]))
    half = json.loads(run("grade", "fourbar", write(folder, "half.json", {"b": "m2*l1*l2*cos(th1-th2)"}), "--json").stdout)
    expect("a mistake in a formula keeps its share", half["score"] == 1, str(half["score"]))


def what_is_told_of_choices_hints_and_rods(folder):
    """The right option is printed when asked for; hints are counted; l^2/12 is named."""
    asked = run("problem", "closure").stdout
    right = re.search(r"\(([a-d])\) the velocity with which the loop opens at B", asked)
    wrong = write(folder, "d.json", {"d": "abcd".replace(right[1], "")[0]})
    done = run("grade", "closure", wrong, "--show-expected").stdout
    expect("the right option is printed", f"expected  ({right[1]}) the velocity with which the loop opens at B" in done, done)
    silent = run("grade", "closure", wrong).stdout
    expect("and only when asked for", "the loop opens" not in silent, silent)

    # as many hints as there are
    for hints in ("two", -1, 5, 1.5, True, [1]):
        done = run("grade", "fourbar", write(folder, "h.json", {"a": 1, "hints": hints}))
        expect(f"hints {hints} are refused", done.returncode == 2 and "a whole number from 0 to 2 is allowed" in done.stdout, done.stdout)
    for hints in (0, 2, None):
        done = run("grade", "fourbar", write(folder, "h.json", {"a": 1, "hints": hints}))
        expect(f"hints {hints} are read", done.returncode == 0, done.stdout)

    # the moment of inertia about the wrong point
    x = json.loads(run("problem", "fourbar", "--json").stdout)["numbers"]
    done = run("grade", "fourbar", write(folder, "m.json", {"a": x["m1"] * x["l1"] ** 2 / 12 + x["m2"] * x["l1"] ** 2}))
    expect("m l^2/12 is named", "centre-of-mass" in done.stdout and "not about the pivot" in done.stdout, done.stdout)


def regrading_the_ungradable(folder):
    """What cannot be graded has no score, before or now."""
    verdict = json.loads(run("grade", "fourbar", write(folder, "good.json", {"a": 1}), "--json").stdout)
    kept, bad = write(folder, "kept.json", verdict), write(folder, "bad.json", "{")
    done = run("regrade", kept, bad)
    expect("it cannot be graded now", done.returncode == 2 and "0 of 8 before, cannot be graded now" in done.stdout, done.stdout)
    done = run("regrade", kept, bad, "--json")
    expect("and has no score", json.loads(done.stdout)["score"] is None, done.stdout)
    none = write(folder, "none.json", run("grade", "fourbar", bad, "--json").stdout)
    done = run("regrade", none, bad)
    expect("nor had it before", "could not be graded before, cannot be graded now" in done.stdout, done.stdout)
    done = run("regrade", none, write(folder, "good.json", {"a": 1}))
    expect("what can be graded now is told", "could not be graded before, 0 of 8 now" in done.stdout, done.stdout)


def other_numbers(folder):
    """Numbers of another variant are named with their owner; a number that agrees by chance is not."""
    part = {"ask": "?", "kind": "number", "points": 1, "unit": "m", "tolerance": {"relative": 0.001}}
    exercise = {"exercise": 2, "id": "mine", "title": "t", "lesson": "l", "section": "s", "statement": ["s"],
                "draw": {n: {"range": [1, 9], "digits": 4} for n in "lk"},
                "parts": [dict(part, id=i, answer=a, second=s) for i, a, s in (("a", "3*l", "l+2*l"), ("b", "l^2", "l*l"), ("c", "7*k", "k+6*k"))]}  # fmt: skip
    path = write(folder, "three.json", exercise)

    def numbers(*who):
        n = json.loads(run("problem", path, "--json", *who).stdout)["numbers"]
        return {"a": 3 * n["l"], "b": n["l"] ** 2, "c": 7 * n["k"]}

    plain, bobs = numbers(), numbers("--student", "bob")
    said = run("grade", path, write(folder, "plain.json", dict(plain, student="ada"))).stdout
    expect("numbers of the exercise without a name are named", "numbers of seed 1 (the exercise without a name or seed)" in said, said)
    said = run("grade", path, write(folder, "one.json", {"student": "ada", "a": plain["a"], "b": 1, "c": 1})).stdout
    expect("one number alone is not enough", "agree with the numbers" not in said, said)
    os.mkdir(os.path.join(folder, "class"))
    for who, answers in (("ada", bobs), ("bob", bobs), ("eve", dict(numbers("--student", "eve"), c=0))):
        write(os.path.join(folder, "class"), who + ".json", answers)
    said = run("grade", path, os.path.join(folder, "class")).stdout
    expect("in a class the owner of the numbers is named", "ada: 0 of 3" in said and "the variant of 'bob' (seed " in said, said)
    bobs_seed, adas_seed = (json.loads(run("problem", path, "--json", "--student", who).stdout)["seed"] for who in ("bob", "ada"))
    expect("with both seeds", f"'bob' (seed {bobs_seed}), and this is seed {adas_seed}" in said, said)
    expect("and nobody else is accused", said.count("the variant of") == 1, said)


def what_looks_like_an_answer(folder):
    """An example must have its shape; a count is not explained by two mistakes; small counts accuse nobody."""
    def entries(exercise, given):
        verdict = json.loads(run("grade", exercise, write(folder, "answer.json", given), "--json").stdout)
        return {e["name"]: (e["mistake"], e["explanation"]) for e in verdict.get("entries", [])}

    told = entries("singular", {"a": {"J": [[1, 2, 3], [0, 0, 0]]}})
    expect("a zero row is not the example that is asked for", told["a"][0] == "zero-row", str(told))
    small = {"d": {"choice": "a", "reason": "a"}}
    for exercise, part, given, said in (("singular", "a", {"J": [[1, 2], [2, 4]]}, "J is 2 x 2; asked for is a matrix of 2 x 3"),
                                        ("singular", "b", {"J": [[1, 0, 0]], "M": [[1, 0, 0], [0, 0, 0], [0, 0, 0]], "x": [0, 1, 0]}, "J is 1 x 3"),
                                        ("p4", "b", {"M": [[1]], "Phi": [[0]], "v": [1]}, "M is 1 x 1"),
                                        ("p4", "c", {"M": [[1, 0, 0], [0, 0, 0], [0, 0, 0]], "Phi": [[1], [0], [0]]}, "M is 3 x 3")):  # fmt: skip
        told = entries(exercise, dict(small, **{part: given}))
        expect(f"a matrix of another shape is refused: {said}", told[part][0] == "unreadable" and said in told[part][1], str(told))
    told = entries("p4", {"b": {"M": [[2, 0], [0, 1]], "Phi": [[1, 0], [0, 1]], "v": [1e-7, 0]}})
    expect("a small vector is no counter-example", told["b"][0] == "phi-full-rank", str(told))

    told = entries("loops", {"student": "s1001", "a": -1})
    expect("a wrong count is not called two mistakes", told["a"][0] == "other", str(told))
    k = json.loads(run("problem", "gears", "--seed", "3", "--json").stdout)["numbers"]["k"]
    told = entries("gears", {"seed": 3, "c": k + 1})
    expect("nor a count of gears", "two mistakes" not in told["c"][1], str(told))

    note = json.loads(run("grade", "turning", write(folder, "answer.json", {"a": {"l1": 1, "l3": 2, "d": 0.1}}), "--json").stdout)["note"]
    expect("what an answer holds beside its names is told", note == "in part a the field 'd' was not read", note)
    row = ["-1.1372*sin(th1)", "-l2*th2^3", "l3*sin(th3)", "l4*sin(th4)"]
    said = run("grade", "p3", write(folder, "answer.json", {"J": [row, ["l1*cos(th1)", "l2*cos(th2)", "-l3*cos(th3)", "-l4*cos(th4)"]]})).stdout
    expect("numbers in place of lengths are told from a wrong formula", said.count("not as numbers") == 1 and said.count("differentiate the row once more") == 1
           and "6 of 8 entries" in said, said)  # fmt: skip
    told = entries("baumgarte", {"c": "0.008 1/ms"})
    expect("a number without a unit says so", "asked for: a plain number, without a unit" in told["c"][1], str(told))
    right = ["S'*tau - h", "-gamma"]
    for one in ("I", "E", "eye", "identity", "1"):
        told = entries("p1", {"a": {"matrix": [[one, "-inv(M)*J'"], ["J", 0]], "right": ["inv(M)*(S'*tau - h)", "-gamma"]}})
        expect(f"{one} is the identity in a system of blocks", told["a"][0] == "", str(told))
    told = entries("p1", {"a": {"matrix": [["M", "I"], ["J", 0]], "right": right}})
    expect("and no block that is not square", "multiple of the identity, but its place is 5 x 2" in told["a"][1], str(told))

    write(folder, "answer.json", {"seed": 1, "a": 1, "d": 0.1})
    shown = json.loads(run("grade", "loops", os.path.join(folder, "answer.json"), "--show-expected", "--json").stdout)["entries"]
    theta = float(next(e["expected"] for e in shown if e["name"] == "d").split()[0])
    expect("an angle is right after a whole turn", entries("loops", {"seed": 1, "d": theta + 6.283185})["d"][0] == ""
           and entries("loops", {"seed": 1, "d": theta + 3.1415927})["d"][0] != "", str(theta))  # fmt: skip

    part = {"id": "a", "ask": "?", "kind": "number", "points": 1, "tolerance": {"relative": 0.001}, "answer": "0.4932*l/l", "second": "0.4932"}
    exercise = {"exercise": 2, "id": "mine", "title": "t", "lesson": "l", "section": "s", "statement": ["s"],
                "draw": {"l": {"range": [1, 2], "digits": 2}}, "parts": [part]}  # fmt: skip
    told = entries(write(folder, "round.json", exercise), {"a": 0.49})
    expect("a number with too few digits is named", told["a"] == ("rounded", "right to 2 digits, but it must be right to 0.1 %: write more digits"), str(told))
    part["answer"] = "0.4932*1.1*l/l"
    done = run("grade", write(folder, "wrong.json", exercise), write(folder, "answer.json", {"a": 0.4932}))
    expect("an exercise that its second way contradicts grades nobody", done.returncode == 3 and "the exercise is wrong in its part a" in done.stdout + done.stderr,
           done.stdout + done.stderr)  # fmt: skip
    told = run("rubric", "check", write(folder, "gears.json", run("rubric", "write", "gears").stdout)).stdout
    expect("a tolerance of a count is told as exact", "exact: passes the right number alone" in told and "10 digits" not in told, told)

    part = {"ask": "?", "kind": "number", "points": 1, "tolerance": {"relative": 0.001}}
    exercise = {"exercise": 2, "id": "mine", "title": "t", "lesson": "l", "section": "s", "statement": ["s"],
                "draw": {"k": {"choose": [3, 5, 7]}, "n": {"choose": [11, 13, 17]}},
                "parts": [dict(part, id=i, answer=a, second=s) for i, a, s in (("a", "7*k", "k+6*k"), ("b", "9*n", "n+8*n"))]}  # fmt: skip
    path = write(folder, "few.json", exercise)
    seeds = [json.loads(run("problem", path, "--json", "--seed", str(i)).stdout)["numbers"] for i in range(1, 9)]
    mine, other = next((i, n) for i, m in enumerate(seeds, 1) for n in seeds if n["k"] != m["k"] and n["n"] != m["n"])
    said = run("grade", path, write(folder, "answer.json", {"seed": mine, "a": 7 * other["k"], "b": 9 * other["n"]})).stdout
    expect("numbers that many variants share accuse nobody", "score 0 of 2" in said and "agree with the numbers" not in said, said)


def named_file(folder):
    """-o names a file where its ending is the form's; a folder of this name stays a folder."""
    path = write(folder, "s.json", {"a": 1})
    target = os.path.join(folder, "new", "results.json")
    done = run("grade", "fourbar", path, "--format", "gradescope", "-o", target)
    expect("a verdict goes into the file that -o names", done.returncode == 0 and os.path.isfile(target), done.stderr)
    expect("it is that platform's", "tests" in json.load(open(target, encoding="utf-8")))
    done = run("grade", "fourbar", path, "--json", "-o", path)
    expect("it does not overwrite its submission", done.returncode == 2 and json.load(open(path, encoding="utf-8")) == {"a": 1}, done.stdout)
    done = run("problem", "p3", "--seeds", "1..5", "--check")
    expect("a matrix is proved too", done.returncode == 0 and "5 variants, 5 distinct; 5 right answers" in done.stdout, done.stdout + done.stderr)


def for_teachers(folder):
    """Right numbers are in no verdict of a student, and numbers say how exact they must be."""
    path = write(folder, "half.json", {"a": 1, "d": [1, 2]})
    told = [run("grade", "fourbar", path, "--format", form, *more).stdout for form in ("text", "json", "gradescope", "junit", "html", "csv")
            for more in ([], ["--show-expected"])]  # fmt: skip
    right = run("grade", "fourbar", path, "--show-expected").stdout.split("expected  ")[1].split()[0]
    expect("no verdict of a student has the right number", not any(right in text for text in told[::2]), right)
    expect("a teacher's verdict has it", all(right in text for text in told[1:5:2]), str(told[1:5:2]))
    asked = run("problem", "fourbar").stdout
    expect("a number says how exact it must be", "; right to 0.5 %" in asked, asked)
    counted = run("problem", "index").stdout
    expect("a count must be exact", 'answer "a": a number; exact\n' in counted, counted)
    said = run("grade", "fourbar", write(folder, "unit.json", {"a": "3 furlongs", "d": ["1,5", 2]})).stdout
    expect("an unknown unit is named, with what is asked for", "'furlongs' at column 3 is no unit known here; asked for: kg m^2" in said, said)
    expect("a comma in a number is named", "a comma at column 2; write decimals with a point" in said, said)
    expect("a list of commands has help", run("help", "problems").returncode == 0)


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


def readings(folder):
    """A plot that is read: a coarse reading is no slip, a value of the other axis is."""
    def entry(value, *more):
        done = run("grade", "gap-plot", write(folder, "read.json", {"a": value}), "--json", "--no-pictures", *more)
        return next(e for e in json.loads(done.stdout)["entries"] if e["name"] == "a")

    right = float(entry(1e150, "--show-expected")["expected"].split()[0])
    axis = max(float(x) for x in re.findall(r'text-anchor="end">([\d.]+)<', json.loads(run("problem", "gap-plot", "--json").stdout)["parts"][0]["figure"]["svg"]))
    allowed = 0.05 * 1000 * axis  # the axis is in metres, the answer in millimetres
    told = {name: entry(value)["mistake"] for name, value in
            (("right", right + 0.9 * allowed), ("coarse", right + 1.5 * allowed), ("time", 10.0), ("metres", right / 1000))}  # fmt: skip
    expect("a coarse reading is not taken for a value of the other axis",
           told == {"right": "", "coarse": "inexact", "time": "other-axis", "metres": "power-of-ten"}, str(told))  # fmt: skip


def read(path):
    with open(path, "rb") as f:
        return f.read()


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
    many = write(folder, "many.json", dict(exercise, conditions=["n-2.5"], parts=[dict(p, faults=[{"id": "none", "answer": p["answer"], "says": "right", "share": 0}])
                                                                                  for p in exercise["parts"] if p["kind"] == "number"]))  # fmt: skip
    said = run("problem", many, "--seeds", "1..200", "--check").stdout
    listed = said.count("\n  seed ")
    expect("what does not fit is counted", 0 < listed < 200 and f"  and {200 - listed} more\n" in said, said[-300:])


def refusals(folder):
    """An option that would say nothing, and an output that would replace something, are refused with words."""
    right = write(folder, "right.json", {"c": 1})
    classes = os.path.join(folder, "class")
    os.makedirs(classes)
    write(classes, "ann.json", {"c": 1})
    for words, said in ((("problem", "closure", "--hint", "9"), "closure has 2 hints; --hint is 9"), (("problem", "p3", "--hint", "1"), "p3 has 0 hints"),
                        (("problem", "closure", "--hint", "0"), "--hint is 0"), (("problem", "closure", "--seeds", "1..3"), "--seeds is for --check"),
                        (("problem", "closure", "--check", "--seed", "3"), "a range of variants"), (("problem", "closure", "--check", "--student", "s"), "a range of variants"),
                        (("problem", "closure", "--student", ""), "--student has no name"), (("grade", "closure", right, "--student", " "), "--student has no name"),
                        (("problem", "p3", "-o", "p.svg"), "asks about a plot"), (("problem", "gap-plot", "-o", "p.svg", "--json"), "it has no JSON"),
                        (("grade", "closure", right, "--json", "--format", "html"), "choose different forms"), (("grade", "closure", right, "--plot", "--json"), "--plot draws bars"),
                        (("grade", "closure", right, "--jobs", "2"), "--jobs is for a folder"), (("grade", "closure", classes, "--show-expected"), "not for a class"),
                        (("grade", "closure", right, "--format", "json", "--out", os.path.join(folder, "v.html")), "ends in .html; the form json"),
                        (("grade", "closure", right, right, "--out", os.path.join(folder, "v.html")), "is the name of one file"),
                        (("grade", "closure", classes, "--out", os.path.join(folder, "s.html")), "says no form of scores"),
                        (("grade", "closure", classes, "--out", os.path.join(classes, "s.csv")), "lies among the submissions")):
        done = run(*words)
        expect(f"{' '.join(words[:1] + words[2:])} is refused", done.returncode == 2 and said in " ".join(done.stderr.split()) + done.stdout, done.stderr + done.stdout)
    expect("and nothing is written", sorted(os.listdir(classes)) == ["ann.json"] and not os.path.exists(os.path.join(folder, "v.html")))


def outputs(folder):
    """The ending of --out chooses the form; what was there before is kept, or not replaced."""
    wrong = write(folder, "wrong.json", {"J": [["l1*sin(th1)"] + ["1"] * 3, ["1"] * 4]})
    html, mine = os.path.join(folder, "v.html"), os.path.join(folder, "v.png")
    write(folder, "v.png", "my own picture")
    done = run("grade", "p3", wrong, "--out", html)
    expect("the ending chooses the form", done.returncode == 0 and read(html).startswith(b"<!DOCTYPE html>"), done.stderr)
    expect("a page holds its picture: none is written beside it", read(mine) == b"my own picture")
    done = run("grade", "p3", wrong, "--out", os.path.join(folder, "v.json"))
    expect("a picture of the user's is kept", read(mine + ".1") == b"my own picture" and read(mine).startswith(b"\x89PNG") and "v.png.1" in done.stderr, done.stderr)
    again = run("grade", "p3", wrong, "--out", os.path.join(folder, "v.json"))
    expect("the same verdict replaces nothing", again.stderr == "" and not os.path.exists(mine + ".2"), again.stderr)

    # a teacher's rubric
    rubric = os.path.join(folder, "r.json")
    written = [run("rubric", "write", "closure", "-o", rubric).returncode for _ in (1, 2)]
    with open(rubric, "a", encoding="utf-8") as f:
        f.write("\n")
    refused, kept = run("rubric", "write", "closure", "-o", rubric), read(rubric)
    expect("a rubric that was changed is not replaced", written == [0, 0] and refused.returncode == 2 and "is there already" in refused.stderr and kept.endswith(b"\n\n"), refused.stderr)
    expect("unless --force says so", run("rubric", "write", "closure", "-o", rubric, "--force").returncode == 0 and read(rubric) != kept)

    # as little of the paths as tells them apart
    for name in ("s1", "s2"):
        os.makedirs(os.path.join(folder, "deep", name, "sub"))
        write(os.path.join(folder, "deep", name, "sub"), "p3.json", read(wrong).decode())
    verdicts = os.path.join(folder, "verdicts")
    run("grade", "p3", *(os.path.join(folder, "deep", name, "sub", "p3.json") for name in ("s1", "s2")), "--out", verdicts)
    expect("verdicts keep the folders that tell them apart", all(os.path.exists(os.path.join(verdicts, name, "sub", "p3.txt")) for name in ("s1", "s2")), str(os.listdir(verdicts)))


def files_of_others(folder):
    """A plot of this program is replaced, any other file of its name is kept, and what was written is named."""
    path = os.path.join(folder, "gp.svg")
    first = os.path.join(folder, "gp-a.svg")
    with open(first, "w", encoding="utf-8") as f:
        f.write("mine")
    for _ in range(2):
        done = run("problem", "gap-plot", "-o", path)
        expect("the plots that were written are named", done.returncode == 0 and f"the plot of part a: {first}\n" in done.stdout, done.stdout)
    with open(first + ".1", encoding="utf-8") as f:
        expect("a file of somebody else's is kept", f.read() == "mine")
    expect("and a plot is not", not os.path.exists(first + ".2"))
    full = run("grade", "gears", "-", "--out", "/dev/full")
    expect("a device is no folder of verdicts", full.returncode == 2 and "'/dev/full' is no folder" in full.stderr, full.stderr)
    done = subprocess.run([PROGRAM, "grade", "gears", "-", "--format", "html", "--out", os.path.join(folder, "verdicts")], input='{"a": 1}', capture_output=True, text=True)
    expect("a verdict on standard input has a name", done.returncode == 0 and os.path.exists(os.path.join(folder, "verdicts", "submission.html")), done.stderr)
    done = run("grade", "gears", "x.ndjson", "--shard", "1/2", "--merge")
    expect("a shard is not merged at once", done.returncode == 2 and "--merge puts graded parts together" in done.stderr, done.stderr)


def in_a_students_words(folder):
    """Messages of the program that mean nothing to a student are said in his words, with units."""
    told = run("grade", "method", write(folder, "m.json", {"a": "program:./x.py", "b": "index1@rk4:h=0.01"}), "--no-pictures").stdout
    expect("no option that grade lacks is advised", "list methods" in told and "--allow-programs" not in told, told)
    expect("a loop gap has its unit", re.search(r"the loop gap reaches [0-9.e-]+ m; at most 0.0002 m is allowed", told) is not None, told)
    told = run("grade", "turning", write(folder, "t.json", {"a": {"l1": 0.2, "l3": 0.1}}), "--no-pictures").stdout
    expect("the shipped scene is not named", "the loop cannot be closed" in told and "in the scene" not in told, told)
    told = run("grade", "assemble", write(folder, "o.json", {"a": {"th2": 0.1, "th3": 0.3}}), "--no-pictures").stdout
    expect("an open loop has its unit", re.search(r"the loop is open by [0-9.]+ m\n", told) is not None, told)
    told = run("lesson", "3").stdout
    expect("a picture's file is named", "pictures/missing-term.svg" in told and "in the folder lessons/03-null-space." in told, told[-300:])


def other_maximum(folder):
    """Graded again with other points: both scores stand beside their own maximum."""
    rubric = os.path.join(folder, "double.json")
    with open(rubric, "w", encoding="utf-8") as f:
        json.dump({"rubric": 1, "exercise": "closure", "points": {"a": 4, "b": 2, "c": 4, "d": 2}, "hints": [1, 1]}, f)
    answer = write(folder, "answer.json", {"b": "-l3*sin(th3)*u3", "hints": 1})
    kept = write(folder, "kept.json", run("grade", "closure", answer, "--json").stdout)
    done = run("regrade", kept, "--rubric", rubric)
    expect("each score has its own maximum", "ANOTHER SCORE: 1 of 6 before, 1 of 12 now" in done.stdout, done.stdout)
    expect("one hint costs one point", "1 hint cost 1 point\n" in done.stdout, done.stdout)
    report = json.loads(run("regrade", kept, "--rubric", rubric, "--json").stdout)
    expect("and in JSON", (report["same"], report["max_score_before"], report["max_score"]) == (False, 6, 12), str(report))


def main():
    variants()
    checks()
    with tempfile.TemporaryDirectory() as folder:
        choices(folder)
        statuses(folder)
        own_variant(folder)
        forms(folder)
        platforms(folder)
        rubrics(folder)
        readings(folder)
        whole_check(folder)
        own_exercise(folder)
        whose_variant(folder)
        rates_of_a_part(folder)
        nothing_for_nothing(folder)
        what_is_told_of_choices_hints_and_rods(folder)
        regrading_the_ungradable(folder)
        named_file(folder)
        other_numbers(folder)
        what_looks_like_an_answer(folder)
        for_teachers(folder)
        broken_exercise(folder)
        the_guide_for_teachers(folder)
    for test in (bad_variants, refusals, outputs, files_of_others, in_a_students_words, other_maximum):
        with tempfile.TemporaryDirectory() as folder:
            test(folder)
    for n, (name, good, said) in enumerate(RESULTS, 1):
        if not good:
            print("# " + said.replace("\n", "\n# "))
        print(f"{'ok' if good else 'not ok'} {n} - {name}")
    print(f"1..{len(RESULTS)}")
    return 0 if all(good for _, good, _ in RESULTS) else 1


if __name__ == "__main__":
    sys.exit(main())
