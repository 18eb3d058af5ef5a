# SPDX-License-Identifier: GPL-3.0-or-later
"""Rubrics: a teacher's points, tolerances, shares and hints; each fault with its line; grading again by another. Speaks TAP."""

import json
import os
import re
import sys

sys.path.insert(0, os.path.dirname(__file__))
from exercise import expect, run, speak_tap, write  # noqa: E402


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

    stretched = write(folder, "stretched.json", {"c": "-0.5*m2*l1*l2*sin(th1-th2)*u1^2+g*m2*l2*cos(th2)"})
    shares = write(folder, "shares.json", dict(json.loads(own), shares={"double-term": 0.25, "wrong-factor": 0.1}))
    scores = [json.loads(run("grade", "fourbar", stretched, "--json", *more).stdout)["score"] for more in ([], ["--rubric", shares])]
    expect("a slip that no exercise lists has its share in a rubric", scores == [1, 0.5], str(scores))

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
            expect(f"{words[0]} refuses {fields}", done.returncode == (2 if words[0] == "rubric" else 3) and said in " ".join(done.stderr.split()), f"{done.returncode} {done.stderr}")

    # suggestions are written as the file is, and are no looser than what was meant
    for name, text, hint in (("t.toml", "rubric = 1\nexercise = \"closure\"\n[tolerance.a]\nrelative = 1e-12\n", "relative = 1e-09"),
                             ("t.json", '{"rubric": 1, "exercise": "closure", "tolerance": {"a": {"relative": 1e-12}}}', '"relative": 1e-09'),
                             ("t.toml", "rubric = 1\nexercise = \"closure\"\n[tolerance]\na = 1e-6\n", "a = {relative = 1e-06}"),
                             ("t.json", '{"rubric": 1, "exercise": "closure", "tolerance": {"a": 1e-6}}', '"a": {"relative": 1e-06}'),
                             ("t.toml", "rubric = 1\nexercise = \"closure\"\npoints = 3\n", "points = {a = 2}"),
                             ("t.toml", "rubric = 1\nexercise = \"closure\"\nshares = 3\n", "shares = {sign = 0.5}")):  # fmt: skip
        done = run("rubric", "check", write(folder, name, text))
        said = done.stderr.strip().splitlines()[-1].strip()
        expect(f"suggested is {hint}", (done.returncode, said) == (2, hint), done.stderr)
        key, _, value = text.partition("[tolerance.a]\nrelative = 1e-12" if "tolerance.a" in text else "a = 1e-6" if "a = 1e-6" in text else "points = 3")
        if value and name == "t.toml":  # what is suggested is accepted
            mended = run("rubric", "check", write(folder, name, key + ("[tolerance.a]\n" if "tolerance.a" in text else "") + hint + value))
            expect(f"{hint} is accepted", mended.returncode == 0, mended.stderr)

    kept = write(folder, "kept.json", verdict)
    again = run("regrade", kept)
    expect("a verdict names its rubric", "before, none now; name it with --rubric" in again.stdout and "other.json (hash" in again.stdout, again.stdout)
    expect("and says so as text", "points and tolerances of the rubric other.json (hash" in run("grade", "fourbar", slip, "--rubric", path).stdout)
    expect("another score is seen by a script", (again.returncode, "ANOTHER SCORE" in again.stdout) == (4, True), again.stdout)
    expect("the same score is 0", run("regrade", kept, "--rubric", path).returncode == 0)
    expect("a rubric that is missing is no fault of the submission", run("regrade", kept, "--rubric", os.path.join(folder, "none.json")).returncode == 3)
    expect("and is reproduced with it", json.loads(run("regrade", kept, "--rubric", path, "--json").stdout)["same"])
    loose = write(folder, "loose.json", dict(other, tolerance={"d": {"relative": 0.3}}))
    d = json.loads(run("grade", "fourbar", write(folder, "ask.json", {"d": [1e150, 1e150]}), "--show-expected", "--json").stdout)["entries"]
    near = write(folder, "near.json", {"d": [1.2 * float(e["expected"].split()[0]) for e in d if e["name"].startswith("d")]})
    marks = [json.loads(run("grade", "fourbar", near, "--json", "--rubric", r).stdout)["score"] for r in (path, loose)]
    expect("a tolerance is the rubric's", marks == [0, 2], str(marks))

    # every kind of fault, with its line
    for what, change, said in (("part", {"points": {"bb": 1}}, "no part 'bb'"), ("mistake", {"shares": {"sgn": 1}}, "no mistake 'sgn'"),
                               ("field", {"hint": []}, "no field 'hint'"), ("total", {"total": 3}, "sum up to 12, not 3"),
                               ("tolerance", {"tolerance": {"a": {"relative": 1e-12}}}, "tighter than that to which references are proved"),
                               ("share", {"shares": {"sign": 2}}, "from 0 to 1"), 
                               ("number", {"points": {"a": "x"}}, "needs a number")):  # fmt: skip
        text = json.dumps(dict(other, **change), indent=1)
        done = run("rubric", "check", write(folder, "bad.json", text))
        line = re.search(rf"line (\d+): [^\n]*{re.escape(said)}", done.stderr)
        key = list(next(iter(change.values())))[0] if isinstance(next(iter(change.values())), dict) else next(iter(change))
        good = done.returncode == 2 and said in done.stderr and line and f'"{key}"' in text.splitlines()[int(line[1]) - 1]
        expect(f"a wrong {what} is named with its line", bool(good), done.stderr)


def whole_check(folder):
    """A rubric's faults are told all at once, each with its line; a part's own mistakes are listed."""
    bad = write(folder, "worst.json", json.dumps({"rubric": 1, "exercise": "fourbar", "hint": [], "points": {"bb": 1, "a": "x"},
                                                  "tolerance": {"a": {"relative": 1e-12}}, "shares": {"sgn": 1}, "total": 3}, indent=1))  # fmt: skip
    told = run("rubric", "check", bad).stderr
    said = ["no field 'hint'", "no part 'bb'", "needs a number", "tighter than", "no mistake 'sgn'", "sum up to"]
    expect("all faults of a rubric are told at once", all(s in told for s in said), told)
    expect("each with its line", len(re.findall(r"line \d+: ", told)) >= 6, told)
    lines = [int(n) for n in re.findall(r": line (\d+): ", told)]
    expect("in the order of the lines", lines == sorted(lines), told)
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
    for name, said in (("q", "one of: a, b, c"), ("points", "one of: a, b, c")):
        told = run("rubric", "check", write(folder, "part.json", {"rubric": 1, "exercise": "gears", "points": {name: 1}})).stderr
        expect(f"the parts are listed beside the unknown part {name}", said in told, told)
    told = run("rubric", "check", write(folder, "part.json", {"rubric": 1, "exercise": "gears", "shares": {"sgn": 1}})).stderr
    expect("the nearest mistake is asked for", "did you mean 'sign'?" in told, told)
    told = run("problem", "closure", "--seeds", "1..2", "--check").stdout
    expect("the mistakes that an exercise names are listed", "mistakes of part a: along-y coupler-sign" in told, told)


def rubric_of_an_own_exercise(folder):
    """The file of an own exercise is named behind its rubric; the statement shows the rubric's points."""
    part = {"id": "a", "ask": "?", "kind": "number", "points": 1, "answer": "2*l", "second": "l+l"}
    own = write(folder, "own.json", {"exercise": 2, "id": "own-one", "title": "t", "lesson": "06-drift", "section": "s",
                                     "statement": ["s {l}"], "draw": {"l": {"range": [2, 9], "digits": 0}}, "parts": [part]})  # fmt: skip
    path = os.path.join(folder, "own-rubric.json")
    expect("the rubric of an own exercise is written", run("rubric", "write", own, "-o", path).returncode == 0)
    alone, both = run("rubric", "check", path), run("rubric", "check", path, own)
    expect("its check asks for the exercise's file", alone.returncode == 2 and "rubric check FILE EXERCISE.json" in alone.stderr, alone.stderr)
    expect("and takes it", both.returncode == 0, both.stdout + both.stderr)
    with open(path, encoding="utf-8") as f:
        rubric = json.load(f)
    rubric["points"]["a"] = rubric["total"] = 7
    write(folder, "own-rubric.json", rubric)
    shown = run("problem", own, "--rubric", path)
    expect("the statement has the rubric's points", shown.returncode == 0 and "7 points" in shown.stdout, shown.stdout + shown.stderr)


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


def rubrics_in_toml(folder):
    """The same rubric as TOML: what write makes is what check reads; faults have the lines of the file."""
    path, json_path = os.path.join(folder, "r.toml"), os.path.join(folder, "r.json")
    for out in (path, json_path):
        run("rubric", "write", "fourbar", "-o", out)
    told = [run("rubric", "check", p).stdout for p in (path, json_path)]
    expect("a rubric written as TOML means what the one in JSON means", told[0] == told[1] and "8 points" in told[0], str(told))
    text = """# mine
rubric = 1
exercise = 'fourbar'
about = "two\twords"
hints = [
  0.5,  # the first
  1,
]
[tolerance.a]
relative = 0.01
[tolerance.b]
relative = %s
[shares]
"gravity-sign" = 0.25  # half of it
[visibility]
b = "after_due_date"
"""
    said = run("rubric", "check", write(folder, "r.toml", text % "1e-4")).stdout
    expect("lists, comments, tables in tables and both quotes are read",
           all(w in said for w in ("1 %: passes", "0.0001 of the largest", "hint 2 costs 1 point")), said)  # fmt: skip
    answer = write(folder, "a.json", {"a": 1, "hints": 1})
    said = run("grade", "fourbar", answer, "--rubric", path, "--json").stdout
    expect("grade takes it", len(json.loads(said)["entries"]) == 6, said)
    faults = (("1e-12", "line 11: the relative tolerance 1e-12 of part b"), ("x", "line 12: a number, a text in quotes"),
              ("1 2", "line 12: something stands behind the value"), ("{absolute = 1", "line 12: ',' or '}' was expected"),
              ("0.1\n[tolerance.a]\nabsolute = 1", "'a' is there more than once"), ("0.1\nzz = 1", "line 13: a tolerance has no 'zz'"),
              ("0.1\n[[points]]", "line 13: a list of tables, [[name]], is not read here"),
              ("0.1\n[points.]", "line 13: a name was expected"), ("1." + "0" * 40 + "e5", "line 12: a number, a text"), ("0.1\n" + "n" * 90 + " = 1", "line 13: a name is longer than 78 bytes"), ("0.1\na.b = 1", "line 13: a name with a point is not read here"))  # fmt: skip
    for value, expected in faults:
        done = run("rubric", "check", write(folder, "r.toml", text % value))
        expect(f"relative = {value!r} is told: {expected}", done.returncode == 2 and expected in done.stderr, done.stderr)


if __name__ == "__main__":
    sys.exit(speak_tap([rubrics, whole_check, rubric_of_an_own_exercise, other_maximum, rubrics_in_toml]))
