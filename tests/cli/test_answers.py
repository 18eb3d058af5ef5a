# SPDX-License-Identifier: GPL-3.0-or-later
"""Answers: what is right, what a wrong one is called, whose numbers it has, what is no answer at all. Speaks TAP."""

import json
import os
import re
import sys

sys.path.insert(0, os.path.dirname(__file__))
from exercise import expect, run, speak_tap, write  # noqa: E402


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
    said = entry(right + 1.001 * allowed)["explanation"]
    numbers = re.search(r"coarsely: ([\d.e+-]+) mm away, ([\d.e+-]+) mm are allowed", said)
    expect("a reading just outside has digits that show it", numbers and float(numbers[1]) > float(numbers[2]), said)


def rates_of_a_part(folder):
    """Every spelling of a rate or an angle is that of the part, not the given number."""
    for spelt in ("u1", "w1", "omega_1", "\\omega_1", "\\dot\\theta_1", "\\dot{\\theta}_1", "thdot1"):
        second = "\\dot\\theta_2" if "dot\\" in spelt else "u2"
        path = write(folder, "rate.json", {"student": "s1001", "a": f"-l1*sin(th1)*{spelt}-l2*sin(th2)*{second}"})
        done = run("grade", "closure", path)
        expect(f"closure a with {spelt} is right", "2 / 2  right" in done.stdout, done.stdout + done.stderr)
        path = write(folder, "rate.json", {"c": f"-m2*l1*l2*sin(th1-th2)*{spelt}^2/2+9.81*m2*l2*cos(th2)/2"})
        done = run("grade", "fourbar", path)
        expect(f"fourbar c with {spelt} squared is right", "2 / 2  right" in done.stdout, done.stdout + done.stderr)

    # so is every spelling of its angles, and the given numbers of these angles are not offered
    for one, two in (("t1", "t2"), ("t_1", "t_2"), ("q1", "θ2"), ("theta_1", "th2")):
        path = write(folder, "angle.json", {"student": "s1001", "a": f"-l1*sin({one})*u1-l2*sin({two})*u2"})
        done = run("grade", "closure", path)
        expect(f"closure a with {one} and {two} is right", "2 / 2  right" in done.stdout, done.stdout + done.stderr)
    asked = run("problem", "closure").stdout.split("\nb) ")[0]
    expect("closure a offers no number for its angles", "t1 =" not in asked.split("with numbers given")[1], asked)

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
    adas = numbers("--student", "Ada Lovelace")
    for who in ("ada lovelace", "ADA LOVELACE", "Ada LoveLace"):
        said = run("grade", path, write(folder, "small.json", dict(adas, student=who))).stdout
        expect(f"numbers of Ada Lovelace under the name {who} are named", "of the variant of 'Ada Lovelace'" in said and "capital letters in a name count" in said, said)
    said = run("grade", path, write(folder, "small.json", adas), "--student", "ada lovelace").stdout
    expect("they are named under --student too", "of the variant of 'Ada Lovelace'" in said, said)
    done = run("grade", path, write(folder, "seed.json", {"seed": 7, "a": 1}), "--seed", "8")
    expect("the way to grade another variant names its seed", "grade it with --seed 7" in done.stdout, done.stdout)
    done = run("grade", path, write(folder, "seed.json", {"seed": 0.5, "a": 1}))
    expect("a seed that is none is told", done.returncode == 2 and "seed '0.5'" in done.stdout and "a whole number from 1" in done.stdout, done.stdout)
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


def student_numbers(folder):
    """A student number without quotes is the name in digits; what is no name is refused, not passed over."""
    seed = json.loads(run("problem", "gears", "--student", "4711", "--json").stdout)["seed"]
    for who in (4711, "4711"):
        done = json.loads(run("grade", "gears", write(folder, "n.json", {"student": who, "c": 1}), "--json").stdout)
        expect(f"student {who!r} has the variant of '4711'", (done["seed"], done["student"]) == (seed, "4711"), str(done))
        done = run("grade", "gears", write(folder, "n.json", {"student": who, "c": 1}), "--student", "4712")
        expect(f"student {who!r} is not graded as another", done.returncode == 2 and "4711" in done.stdout, done.stdout)
    for who in (["ada"], {"name": "ada"}, True, "", " ", -4711, 47.11, 1e300):
        for exercise in ("gears", "p3"):
            done = run("grade", exercise, write(folder, "n.json", {"student": who, "c": 1}))
            expect(f"{exercise}: student {who!r} is refused", done.returncode == 2 and "the field 'student' is" in done.stdout, done.stdout)
    done = run("grade", "gears", write(folder, "n.json", {"student": "", "c": 1}), "--student", "4711")
    expect("an empty name is filled by --student", done.returncode == 0, done.stdout)


def two_signs(folder):
    """A number with its uncertainty, or with two signs, is not computed as a sum."""
    right = float(json.loads(run("grade", "trammel", write(folder, "n.json", {"b": 1e150}), "--json", "--show-expected").stdout)["entries"][1]["expected"].split()[0])
    for text in (f"+-{right}", f"-+{right}", f"--{right}", f"{right + 0.56} +- 0.56", f"{right} ± 0.01", f"{right} +/- 0", f"{right} \\pm 0", f"+−{right}", f"{right}--0 kg m^2"):
        done = run("grade", "trammel", write(folder, "n.json", {"b": text}))
        expect(f"{text} is no number", done.returncode == 2 and "has two signs in a row" in done.stdout, done.stdout)
    for text in (f"+{right}", f"{right} - 1e-9", f"2*{right}*(-1)*-0.5", f"{right + 1} + (-1)"):
        found = json.loads(run("grade", "trammel", write(folder, "n.json", {"b": text}), "--json").stdout)["entries"][1]
        expect(f"{text} is right", found["right"], str(found))


def units_that_do_not_measure_it(folder):
    """A frequency is turned into an angular rate; a count has no unit, and no angle in it."""
    def told(exercise, part, answer):
        verdict = json.loads(run("grade", exercise, write(folder, "u.json", {part: answer}), "--json", "--show-expected").stdout)
        return next(e for e in verdict["entries"] if e["name"] == part)

    def right(exercise, part):
        return float(told(exercise, part, 1e150)["expected"].split()[0])

    rate = right("gears", "a")
    for text, good in ((f"{rate / 6.283185307:.6f} Hz", True), (f"{rate} Hz", False), (f"{rate} 1/s", True), (f"{rate} rad/sec", True), (f"{rate * 9.549297:.6f} rev/min", True)):
        found = told("gears", "a", text)
        expect(f"gears a {text}: right {good}", found["right"] == good, str(found))
    expect("an angular rate in degrees is named", told("gears", "a", rate * 57.29577951)["mistake"] == "degrees")
    expect("and one that was turned twice", told("gears", "a", rate / 57.29577951)["mistake"] == "radians")
    count = right("ring", "a")
    for text in (f"{count} rad", f"{count * 57.29577951} °", f"{count} turn"):
        found = told("ring", "a", text)
        expect(f"ring a {text} has another unit", found["mistake"] == "unit" and "without a unit" in found["explanation"], str(found))
    for exercise, part, factors in (("ring", "a", (57.29577951, 1 / 57.29577951, 1000, 0.001)), ("gears", "b", (57.29577951, 1 / 57.29577951)), ("motors", "a", (57.29577951,))):
        for factor in factors:
            found = told(exercise, part, right(exercise, part) * factor)
            expect(f"{exercise} {part} times {factor:.4g} is no slip of angles or units", found["mistake"] not in ("degrees", "radians", "milli", "kilo"), str(found))
    for factor in (100, 0.01, 1e4, 1e6, 1e-6, 1e9):
        said = told("slider", "c", right("slider", "c") * factor)
        expect(f"a factor of {factor:g} in a unit is named", said["mistake"] == "power-of-ten" and "check the unit" in said["explanation"], str(said))
    expect("a factor of 1000 in a unit is named", told("gears", "b", right("gears", "b") * 1000)["mistake"] == "milli")


def whole_sentences(folder):
    """A reason ends where its sentence ends; a minus of a word processor goes with a decimal comma."""
    for exercise, part, answer in (("closure", "a", "-l1*diff(th1,t)*sin(th1)"), ("method", "b", "index3@euler:h=10"), ("method", "b", "index9@rk4:h=0.1")):
        verdict = json.loads(run("grade", exercise, write(folder, "cut.json", {part: answer}), "--json").stdout)
        said = verdict["hint"]
        expect(f"the reason why {answer} cannot be read ends whole", said.endswith(("and their like", "list methods'", ", ...", "'index1'?")), said)
    right = run("grade", "trammel", write(folder, "n.json", {"c": 1e150}), "--json", "--show-expected").stdout
    right = next(e for e in json.loads(right)["entries"] if e["name"] == "c")["expected"].split()[0]
    minus = "−" if float(right) < 0 else ""
    for text in (minus + right.lstrip("-"), minus + right.lstrip("-").replace(".", ","), minus + right.lstrip("-").replace(".", ",") + " Nm"):
        found = json.loads(run("grade", "trammel", write(folder, "n.json", {"c": text}), "--json").stdout)["entries"]
        expect(f"trammel c {text} is right", minus and next(e for e in found if e["name"] == "c")["right"], str(found))


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
    expect("a small vector is no counter-example", told["b"][0] == "not-a-counter-example", str(told))

    count = json.loads(run("problem", "loops", "--student", "s1001", "--json").stdout)["numbers"]
    told = entries("loops", {"student": "s1001", "a": 3 * (count["b"] - 1) - 2 * count["j"]})
    expect("a wrong count is not called two mistakes", told["a"][0] == "ground-subtracted" and "two mistakes" not in told["a"][1], str(told))
    k = json.loads(run("problem", "gears", "--seed", "3", "--json").stdout)["numbers"]["k"]
    told = entries("gears", {"seed": 3, "c": k + 1})
    expect("nor a count of gears", "two mistakes" not in told["c"][1], str(told))

    note = json.loads(run("grade", "turning", write(folder, "answer.json", {"seed": 1, "a": {"l1": 1, "l3": 2, "d": 0.1}}), "--json").stdout)["note"]
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
    for several in ({"w2": 1, "w3": 2}, "-1.23, 0.806, 3"):
        said = run("grade", "fourbar", write(folder, "two.json", {"d": several})).stdout
        expect(f"two entries written as {several} are asked for as a list", "entries asked for: 2; handed in: 1: write a list, [..., ...]" in said, said)
    for text in ("-1.23, 0.806", "(-1.23, 0.806)", "-1.23 0.806", "-1.23; 0.806", "[-1.23, 0.806]"):
        d = json.loads(run("grade", "fourbar", write(folder, "two.json", {"d": text}), "--json").stdout)["entries"]
        expect(f"the text {text} is read as two entries", [e["given"] for e in d if e["name"].startswith("d.")] == ["-1.23", "0.806"], str(d))
    options = [{"text": "yes", "right": True}, {"text": "no", "says": "this is wrong here"}]
    ask = {"exercise": 2, "id": "ask", "title": "t", "lesson": "l", "section": "s", "statement": ["s"],
           "parts": [{"id": "a", "ask": "?", "kind": "choice", "points": 1, "options": options}]}  # fmt: skip
    marks = {form: [json.loads(run("grade", write(folder, "ask.json", ask), write(folder, "c.json", {"a": given}), "--json").stdout)["score"]
                    for given in (letters[0], letters[1])]
             for form, letters in {"a": ("a", "b"), "(a)": ("(a)", "(b)"), "[a]": (["a"], ["b"])}.items()}  # fmt: skip
    expect("a choice without reasons is a letter, in brackets, or a list of one", sorted(marks["a"]) == [0, 1] and len({str(m) for m in marks.values()}) == 1, str(marks))
    said = run("grade", "method", write(folder, "method.json", {"a": "projecton@rk4:h=0.01"})).stdout
    expect("an unknown formulation is told with the nearest one, and without a list that is cut",
           "formulation 'projecton' is not known; did you mean 'projection'?" in said and ",;" not in said, said)  # fmt: skip
    ids = [p["id"] for p in json.loads(run("problems", "--json").stdout)["problems"]]
    blanks = [(i, line) for i in ids for line in run("problem", i).stdout.split("\n") if line != line.rstrip()]
    expect("no line of an exercise ends in a blank", len(ids) > 60 and not blanks, str(blanks[:3]))
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


if __name__ == "__main__":
    sys.exit(speak_tap([
        readings, rates_of_a_part, nothing_for_nothing, what_is_told_of_choices_hints_and_rods,
        other_numbers, student_numbers, two_signs, units_that_do_not_measure_it, whole_sentences, what_looks_like_an_answer,
    ]))
