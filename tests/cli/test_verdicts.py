# SPDX-License-Identifier: GPL-3.0-or-later
"""Verdicts: exit statuses, whose variant is graded, the forms of platforms, files written, options refused. Speaks TAP."""

import base64
import csv
import json
import os
import re
import subprocess
import sys
import xml.etree.ElementTree

sys.path.insert(0, os.path.dirname(__file__))
from exercise import PROGRAM, expect, read, run, speak_tap, write  # noqa: E402


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

    # a fault of the teacher is 3, and each platform gets a result
    rubric = write(folder, "gears.json", run("rubric", "write", "gears").stdout)
    wrong = write(folder, "x.json", {"a": 1})
    for words, why in ((("nosuch", wrong), "there is no problem 'nosuch'"), (("p1", wrong, "--rubric", rubric), "the rubric is for exercise 'gears', not p1"),
                       (("p1", wrong, "--rubric", os.path.join(folder, "none.toml")), "none.toml"), ((os.path.join(folder, "none.json"), wrong), "none.json")):  # fmt: skip
        done = run("grade", *words)
        expect(f"a fault of the teacher is 3: {why}", done.returncode == 3 and why in done.stderr + done.stdout, f"{done.returncode}: {done.stderr}")
        for form, ending in (("gradescope", "json"), ("prairielearn", "json"), ("junit", "xml"), ("csv", "csv"), ("html", "html"), ("json", "json"), ("text", "txt")):
            out = os.path.join(folder, f"of-{form}")
            done = run("grade", *words, "--format", form, "--out", out + "/")
            found = read(os.path.join(out, ("results." if form in ("gradescope", "prairielearn") else "x.") + ending)).decode()
            expect(f"{form} says so", done.returncode == 3 and "the exercise or its rubric is at fault, not the submission" in found, f"{done.returncode}: {found[:300]}")
            expect(f"{form} is no verdict on the submission", form not in ("json", "gradescope", "csv", "junit") or "failed" in found, found[:300])

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

    # so is one on an exercise of the teacher's own, until its file is gone
    part = {"id": "a", "ask": "?", "kind": "number", "points": 1, "answer": "3*l", "second": "l+2*l"}
    mine = {"exercise": 2, "id": "mine", "title": "t", "lesson": "l", "section": "s", "statement": ["s"],
            "draw": {"l": {"range": [1, 9], "digits": 2}}, "parts": [part]}  # fmt: skip
    own = write(folder, "mine.json", mine)
    kept = write(folder, "own.json", run("grade", own, write(folder, "three.json", {"a": 3}), "--json").stdout)
    expect("a verdict on an exercise of one's own is reproduced", json.loads(run("regrade", kept, "--json").stdout)["same"], run("regrade", kept).stderr)
    part.update(answer="3*l/l", second="9/3")
    write(folder, "mine.json", mine)
    again = run("regrade", kept)
    expect("and a change of its file is said", "ANOTHER SCORE: 0 of 1 before, 1 of 1 now" in again.stdout and "exercise has changed" in again.stdout, again.stdout)
    os.remove(own)
    again = run("regrade", kept)
    expect("and that its file is gone", again.returncode == 2 and "no such file is here" in again.stderr, again.stderr)
    again = run("regrade", write(folder, "scene.json", {"problem": "four-bar", "seed": "1"}))
    expect("a verdict on a program says how it is graded again", again.returncode == 2 and "'four-bar' is a scene" in again.stderr, again.stderr)


def changed_since(folder):
    """A verdict of another build, of an older exercise, of another rubric: what has changed is said, and which parts it concerns."""
    number = {"kind": "number", "points": 1, "answer": "2*x", "second": "x+x"}
    mine = {"exercise": 2, "id": "mine", "title": "t", "lesson": "l", "section": "s", "statement": ["s"], "draw": {"x": {"range": [1, 9], "digits": 2}},
            "parts": [dict(number, id=i, ask=f"{i}?") for i in "abc"]}  # fmt: skip
    path, answer = write(folder, "mine.json", mine), write(folder, "a.json", {"seed": 3, "a": 1e6, "b": 3e6, "c": 1e6})
    then = json.loads(run("grade", path, answer, "--json").stdout)

    def again(verdict, *more):
        kept = write(folder, "then.json", verdict)
        return run("regrade", kept, *more).stdout, json.loads(run("regrade", kept, *more, "--json").stdout)

    text, told = again(then)
    expect("nothing has changed", told["same"] and told["changes"] == [] and text.splitlines()[1] == "mine: t", text)
    text, told = again(dict(then, build="0.0.9 abc gcc 11"))
    expect("another build is said", told["same"] and told["changes"][0].startswith("graded by 0.0.9 abc gcc 11, now by ") and len(told["changes"]) == 1, text)

    mine["statement"], mine["parts"][1]["answer"], mine["parts"][1]["second"] = ["another"], "3e6+0*x", "3e6"
    mine["parts"][2]["id"] = "d"
    write(folder, "mine.json", mine)
    text, told = again(then)
    expect("what of the exercise has changed", told["changes"][0] == "the exercise has changed since the verdict: its statement, part b, part d (new), part c (gone)", text)
    expect("and what that means for the parts", told["changes"][1:] == ["b: 0 of 1 (other) before, 1 of 1 (right) now", "d was not in the verdict", "c is not judged now"] and not told["same"], text)
    bare = dict(then, entries=[{key: value for key, value in e.items() if key != "max_points"} for e in then["entries"]])
    expect("points that a verdict does not hold are left out", "b: 0 (other) before, 1 of 1 (right) now" in again(bare)[1]["changes"], told)
    mine["parts"] = mine["parts"][:1]
    mine["statement"], mine["draw"]["x"]["range"] = ["s"], [1, 8]
    write(folder, "mine.json", mine)
    text, told = again(then)
    expect("another way to draw the numbers is said", "verdict: how its numbers are drawn, part b (gone), part c (gone)" in told["changes"][0], text)
    older = {key: value for key, value in then.items() if key != "contents"}
    text, told = again(older)
    expect("a verdict that does not say what it was made of", told["changes"][0] == "the exercise has changed since the verdict", text)

    # a matrix of formulas has no parts
    with open(os.path.join(os.path.dirname(__file__), "..", "..", "lessons", "01-closed-loops", "problems", "p3.json")) as of:
        matrix = json.load(of)
    path, answer = write(folder, "matrix.json", matrix), write(folder, "j.json", {"J": [["-l1*sin(th1)"] * 4] * 2})
    then_p3 = json.loads(run("grade", path, answer, "--json", "--no-pictures").stdout)
    for what, change in (("its statement", {"title": "t"}), ("how its numbers are drawn", {"states": dict(matrix["states"], closed=23)}),
                         ("its equations or what is asked", {"answer": dict(matrix["answer"], points=2)}),
                         ("its tolerance or the shares of mistakes", {"partial": dict(matrix["partial"], sign=0.25)})):  # fmt: skip
        write(folder, "matrix.json", dict(matrix, **change))
        text, told = again(then_p3)
        expect(f"of a matrix of formulas: {what}", told["changes"][0] == "the exercise has changed since the verdict: " + what, text)
    page = write(folder, "v.html", {})
    for renderer, name in (("built-in", "the built-in renderer"), ("", "OSMesa")):
        subprocess.run([PROGRAM, "grade", "p3", answer, "-o", page], env=dict(os.environ, HOLONOM_RENDERER=renderer), capture_output=True, check=True)
        with open(page) as of:
            words = of.read().partition("<figcaption>")[2]
        expect(f"a picture says that it was drawn by {name}", f"; drawn by {name}." in words[:200], words[:300])

    # a rubric that gives another share
    write(folder, "a.json", {"seed": 1, "a": 1, "b": 20})
    for share in (0.5, 0.25):
        rubric = write(folder, "r.json", {"rubric": 1, "exercise": "drift", "shares": {"constant": share}})
        right = json.loads(run("problem", "drift", "--seed", "1", "--json").stdout)["numbers"]["g"]
        answer = write(folder, "g.json", {"seed": 1, "a": right})
        if share == 0.5:
            then = json.loads(run("grade", "drift", answer, "--json", "--rubric", rubric).stdout)
    text, told = again(then, "--rubric", rubric)
    expect("another rubric is said with the parts that it changes", len(told["changes"]) == 2 and told["changes"][0].startswith("the rubric is another one than was used: r.json (hash ") and told["changes"][1:] == ["a: 0.5 of 1 (constant) before, 0.25 of 1 (constant) now"]
           and not told["same"], text)  # fmt: skip


def letters_of_then(folder):
    """A verdict that was made when options had other letters is graded by the letters of then."""
    part = {"id": "a", "ask": "which?", "kind": "choice", "points": 2,
            "options": [{"text": t, "right": t == "yes", "says": "no"} for t in ("yes", "no", "both", "none")],
            "reasons": [{"text": t, "right": t == "so", "says": "no"} for t in ("so", "thus", "hence", "ergo")]}  # fmt: skip
    path = write(folder, "mine.json", {"exercise": 2, "id": "mine", "title": "t", "lesson": "l", "section": "s", "statement": ["s"], "parts": [part]})
    # letters 1, as dealt by the program that wrote no "letters" into its verdicts
    for seed, pair in ((1, "dd"), (2, "bd"), (3, "ad"), (4, "da")):
        answer = write(folder, "a.json", {"a": list(pair)})
        now = json.loads(run("grade", path, answer, "--seed", str(seed), "--json").stdout)
        then = {key: value for key, value in now.items() if key != "letters"}
        then.update(score=2, build="before")
        kept = write(folder, "then.json", then)
        done = run("regrade", kept)
        expect(f"seed {seed}: letters 2 are others, letters 1 are right in a verdict without", now["letters"] == 2 and now["score"] < 2
               and "the same score: 2 of 2 before" in done.stdout and "options have other letters since" in done.stdout, done.stdout + done.stderr)  # fmt: skip
        done = run("regrade", kept, answer, "--json")
        expect(f"seed {seed}: of a file too", json.loads(done.stdout)["same"], done.stdout)
    done = run("regrade", write(folder, "now.json", now))
    expect("a verdict of now is graded by the letters of now", "the same score" in done.stdout and "other letters" not in done.stdout, done.stdout)
    done = run("regrade", write(folder, "later.json", dict(now, letters=3)))
    expect("a verdict of letters that are not known is refused", done.returncode == 2 and "options in the order 3" in done.stderr, done.stderr)
    old = json.loads(run("grade", "gears", write(folder, "g.json", {"c": 1}), "--json").stdout)
    del old["letters"]
    done = run("regrade", write(folder, "gears.json", old))
    expect("an exercise without options has no letters", done.returncode == 0 and "letters" not in done.stdout, done.stdout)


def hand_in_line(*words):
    text = run("problem", "p1", *words).stdout
    return json.loads(text.split("Hand in a JSON file:\n")[1].splitlines()[0].replace("...", "null"))


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
    some = write(folder, "some.json", {"a": 1, "e": "l_2 l_3 sin(th2-th3)", "d": ["2,500", 1]})
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
    expect("Autolab: the reason is the feedback", "no part" in json.loads(out["autolab"].stdout.splitlines()[0])["Grade"]["a"]["hint"])
    scores = json.loads(out["autolab"].stdout.splitlines()[1])["scores"]
    expect("Autolab: each part has its 0", len(scores) > 1 and "fourbar" not in scores and set(scores.values()) == {0}, str(scores))
    expect("LTI: no user, no empty id", "userId" not in t, str(t))

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
    nobody = "no student and no seed is named: graded with the numbers of the exercise itself, seed 1"
    for named, more in (({}, []), ({"seed": 1}, []), ({"student": "ada"}, []), ({}, ["--seed", "1"]), ({}, ["--student", "ada"])):
        path = write(folder, "whose.json", {"a": 1, **named})
        found = [nobody in run("grade", "fourbar", path, "--format", form, *more).stdout for form in ("text", "json", "html", "gradescope")]
        expect(f"a submission of nobody is remarked on: {named} {more}", found == [not named and not more] * 4, str(found))
    shaped = run("grade", "fourbar", write(folder, "three.json", {"seed": 3, "d": [1, 2, 3]}), "--show-expected", "--json").stdout
    two = run("grade", "fourbar", write(folder, "two.json", {"seed": 3, "d": [1, 2]}), "--show-expected", "--json").stdout
    d = [[e["expected"] for e in json.loads(text)["entries"] if e["name"].startswith("d.")] for text in (shaped, two)]
    expect("what is expected does not hang on the answer", d[0] == d[1] and all(d[0]), str(d))
    asked = run("problem", "fourbar").stdout
    expect("a number says how exact it must be", "; right to 0.5 %" in asked, asked)
    counted = run("problem", "index").stdout
    expect("a count must be exact", 'answer "a": a number; exact\n' in counted, counted)
    said = run("grade", "fourbar", write(folder, "unit.json", {"a": "3 furlongs", "d": ["1,500", 2]})).stdout
    expect("an unknown unit is named, with what is asked for", "'furlongs' at column 3 is no unit known here; asked for: kg m^2" in said, said)
    expect("a comma in a number is named", "a comma at column 2, which may stand for decimals or for thousands; write decimals with a point" in said, said)
    expect("a list of commands has help", run("help", "problems").returncode == 0)


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
                        (("grade", "closure", right, "--format", "html", "--out", os.path.join(folder, "v.md")), "ends in .md; the form html has files that end in .html"),
                        (("grade", "closure", classes, "--out", os.path.join(folder, "s.html")), "says no form of scores"),
                        (("grade", "closure", classes, "--out", os.path.join(classes, "s.csv")), "lies among the submissions")):
        done = run(*words)
        expect(f"{' '.join(words[:1] + words[2:]).replace(folder, '.')} is refused", done.returncode == 2 and said in " ".join(done.stderr.split()) + done.stdout, done.stderr + done.stdout)
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
    first = os.path.join(folder, "gp-ab.svg")
    with open(first, "w", encoding="utf-8") as f:
        f.write("mine")
    for _ in range(2):
        done = run("problem", "motion-plot", "-o", path)
        expect("the plots that were written are named", done.returncode == 0 and f"the plot of parts a and b: {first}\n" in done.stdout, done.stdout)
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
    said = "The page shows the pictures: 'holonom serve', then Lessons. They are files in lessons/03-null-space."
    expect("where the pictures are is said", "[picture]" in told and said in " ".join(told.split()), told[-300:])


if __name__ == "__main__":
    sys.exit(speak_tap([
        statuses, changed_since, letters_of_then, own_variant, whose_variant, forms, platforms, regrading_the_ungradable,
        named_file, for_teachers, refusals, outputs, files_of_others, in_a_students_words,
    ]))
