# SPDX-License-Identifier: GPL-3.0-or-later
"""Wrong answers that a lecturer expects to be named: each with its sentence. Speaks TAP."""

import glob
import json
import math
import os
import re
import sys

sys.path.insert(0, os.path.dirname(__file__))
from exercise import expect, run, speak_tap, write  # noqa: E402


def graded(folder, exercise, part, answer, *more):
    """The verdict, and the first entry of the part."""
    done = run("grade", exercise, write(folder, "answer.json", {part: answer}), "--json", "--no-pictures", *more)
    verdict = json.loads(done.stdout)
    entry = next(e for e in verdict["entries"] if e["name"].split(".")[0] == part)
    return done.returncode, verdict, entry


def named(folder, exercise, part, answer, mistake, words="", *more):
    _, _, entry = graded(folder, exercise, part, answer, *more)
    good = entry["mistake"] == mistake and words in entry["explanation"]
    expect(f"{exercise} {part}: {answer} is called {mistake}", good, f"{entry['mistake']}: {entry['explanation']}")


def formulas(folder):
    """Angles in degrees, terms of the other side, names that are left out."""
    named(folder, "trammel", "a", "-L*sin(th*pi/180)", "degrees", "taken of degrees")
    named(folder, "trammel", "a", "-L*sin(th*180/pi)", "degrees")
    named(folder, "passive", "a", "-B*sin(q*pi/180)/2", "degrees")
    for path in sorted(glob.glob(os.path.join(os.path.dirname(__file__), "../../lessons/*/problems/*.json"))):
        with open(path, encoding="utf-8") as f:
            parts = json.load(f).get("parts", [])
        bare = [(p["id"], name) for p in parts for name, how in p.get("states", {}).items()
                if not how.get("unit") and re.search(rf"(sin|cos|tan)\([^)]*\b{name}\b", json.dumps(p["answer"]))]  # fmt: skip
        expect(f"{os.path.basename(path)}: an angle has its unit, so that degrees are named", not bare, str(bare))
    for sign, share in (("-", 2.01), ("+", 0.99)):
        answer = f"N'*M*Ndot*u + N'*h {sign} N'*S'*tau"
        named(folder, "p2", "c", answer, "applied", "right-hand side")
        points = graded(folder, "p2", "c", answer)[2]["points"]
        expect(f"p2 c with {sign} N' S' tau keeps its share", abs(points - share) < 1e-9, str(points))
    named(folder, "p2", "c", "N'*M*N*u + N'*h", "no-rate", "the rate of N is missing")
    named(folder, "p2", "c", "M*Ndot*u", "not-projected", "h is missing")


# exercise, part, a wrong answer as a formula of the variant's numbers, its name, words of the sentence
FIRST_READERS = (
    ("loops", "c", "d - l1*cos(th1)", "along-x", "above the line of the pivots"),
    ("grashof", "a", "l2 + l3 + d - max(l2, d)", "others", "must be subtracted"),
    ("closure", "c", "l1*sin(t2-t1)/(l3*sin(t2-t3))", "ratio", "for 1 rad/s"),
    ("closure", "c", "l1*w1*sin(t1)/(l3*sin(t3))", "one-equation", "the coupler turns as well"),
    ("slider", "c", "r*w", "tip", "the crank's tip"),
    ("driven", "b", "th0 + w*t1 + k*t1**2/2", "whole-angle", "not its rate"),
    ("atwood", "b", "9.81*(m1+m2)", "both-weights", "the force on the wheel"),
    ("atwood", "b", "9.81*(m2-m1)", "difference", "not the force in the rope"),
    ("forces", "a", "m*(9.81*cos(th*pi/180)+L*w**2)", "", "th in radians"),
    ("forces", "b", "-m*(9.81*cos(th)+L*w**2)*L", "multiplied", "divide the tension"),
    ("forces", "e", "0", "zero", "a straight line in time"),
    ("index", "a", "2*n+m", "state", "are known"),
    ("newton", "a", "-2*9.81/L", "point-centre", "at the centre"),
    ("newton", "b", "3*m*9.81/4", "only-inertia", "carries the rest"),
    ("newton", "c", "2*k-2", "without-top", "the first rod"),
    ("basis", "b", "-l1*sin(t1-t3)/(l2*sin(t2-t3))", "ratio", "for 1 rad/s"),
    ("motors", "c", "0", "cancel", "the rates are not equal"),
    ("trammel", "c", "(ma-m)*L**2*sin(th0)*cos(th0)*w**2", "other-mass", "the mass at A"),
    ("trammel", "c", "m*L**2*sin(th0)*cos(th0)*w**2", "sum", "opposite signs"),
    ("flywheel", "a", "w", "same", "the energy is kept"),
    ("flywheel", "c", "(M1+If)*w**2/2", "with-flywheel", "with the flywheel"),
    ("fold", "b", "acos((d**2+(l2+l3)**2-l1**2)/(2*d*(l2+l3)))", "other-angle", "the rocker's pivot"),
    ("passive", "c", "(tq+B*sin(q0)*w**2/2)*w", "inertia", "because M_r does"),
    ("energy", "b", "m1*l1**2*w1**2/8", "shift-alone", "the rod turns as well"),
    ("energy", "c", "9.81*(m1*l1/2*sin(t1)+m2*(l1*sin(t1)+l2/2*sin(t2))+m3*l3/2*sin(t3))+m1*l1**2*w1**2/6", "with-crank", "released from rest"),
    ("newton-step", "c", "-asin(r*sin(th)/l)", "solution", "one step does not reach it"),
    ("newton-step", "b", "cos(p0)", "no-length", "the length of the rod"),
    ("transmission", "a", "acos((l2**2+l3**2-l1**2-d**2+2*l1*d*cos(th))/(2*l2*l3))", "angle", "its cosine is asked for"),
    ("forecast", "b", "gp/4", "quarter", "order was taken as two"),
    ("forecast", "c", "sqrt(1000/gp)", "no-start", "multiply it"),
    ("baumgarte", "a", "p0+v0*t", "free", "without feedback"),
    ("drift", "c", "p*(1+al*tb)", "no-decay", "exp(-alpha t)"),
    ("reduced", "c", "M11+2*M12+M22+M33", "sum", "entries of Phi"),
    ("transmission", "a", "sqrt(1-((l2**2+l3**2-l1**2-d**2+2*l1*d*cos(th))/(2*l2*l3))**2)", "sine", "its cosine"),
    ("projection", "c", "(x*vy-y*vx)/sqrt(x**2+y**2)", "along-circle", "along the circle"),
)


def first_readers(folder):
    """What readers of the lessons answered before they knew better."""
    known = {name: getattr(math, name) for name in ("sin", "cos", "asin", "acos", "sqrt", "pi")} | {"max": max}
    for exercise, part, formula, mistake, words in FIRST_READERS:
        numbers = json.loads(run("problem", exercise, "--seed", "3", "--json").stdout)["numbers"]
        value = eval(formula, {"__builtins__": {}}, known | numbers)
        _, _, entry = graded(folder, exercise, part, value, "--seed", "3")
        good = not entry["right"] and words in entry["explanation"] and mistake in ("", entry["mistake"])
        expect(f"{exercise} {part}: {formula} is called {mistake or words}", good, f"{entry['mistake']}: {entry['explanation']}")
    for exercise, part, answer, mistake, words in (
            ("p4", "a", "Phi'*M*Phi", "matrix", "v is missing on both sides"), ("reduced", "d", "Phi'*(C*Phi - M*Phidot)", "sign-phidot", "wrong sign"),
            ("reduced", "d", "Phidot'*M*Phi + Phi'*C*Phi", "turned", "the right factor"),
            ("drift", "f", "v - inv(M)*J'*inv(J*inv(M)*J')*J*v", "new-velocity", "the correction alone"),
            ("drift", "f", "-J'*inv(J*inv(M)*J')*J*v", "outer-mass", "stands before J'")):  # fmt: skip
        named(folder, exercise, part, answer, mistake, words)

    # where the links stood at the start the loop is closed, and the assembly mode is that of the motion
    numbers = json.loads(run("problem", "motion-plot", "--json").stdout)["numbers"]
    x, y, l2, l3 = math.cos(1), math.sin(1), numbers["l2"], numbers["l3"]
    line = math.hypot(2.2 - x, y)
    th2 = math.atan2(-y, 2.2 - x) + math.acos((l2**2 + line**2 - l3**2) / (2 * l2 * line))
    th3 = math.atan2(y + l2 * math.sin(th2), x + l2 * math.cos(th2) - 2.2)
    named(folder, "motion-plot", "d", {"th1": 1, "th2": th2, "th3": th3}, "other-time", "at another time")


def shapes(folder):
    """Two operands that do not fit are named with their shapes."""
    shown = "N'*M*Ndot is 3 x 3 and N'*h is 3 x 1: they cannot be added; a factor or a transpose may be missing"
    for answer, says in (("N'*M*Ndot + N'*h", shown), ("-(N'*M*Ndot - N'*h)", shown.replace("added", "subtracted")),
                         ("N' M u", "N' M is 3 x 5 and u is 3 x 1: they cannot be multiplied"),
                         ("M Ndot u + N*h", "N is 5 x 3 and h is 5 x 1: they cannot be multiplied")):  # fmt: skip
        named(folder, "p2", "c", answer, "shape", says)


def bases(folder):
    """What keeps a column from the null space: its rows, its angles, or the constraint that it violates."""
    right = ["l2*cos(th2)", "-l1*cos(th1)", "l1*l2*sin(th2-th1)"]
    entry = graded(folder, "basis", "c", right)[2]
    expect("a right basis is right", entry["points"] == 2, str(entry))
    named(folder, "basis", "c", [right[2], right[0], right[1]], "order", "row 2 belongs to the first coordinate")
    named(folder, "basis", "c", [*right[:2], "l1*sin(th2-th1)"], "one-row", "another row 3")
    named(folder, "basis", "c", ["l2*cos(th2*pi/180)", "-l1*cos(th1*pi/180)", "l1*l2*sin((th2-th1)*pi/180)"], "degrees")
    named(folder, "basis", "c", [1, 1, 1], "not-null", "row 1 of J with your N")
    named(folder, "basis", "c", [0, 0, 0], "rank", "N has rank 0 and needs 1")
    named(folder, "basis", "c", [1, 2], "shape", "1 column (one for each degree of freedom); yours is 2 x 1")


def numbers(folder):
    """Steps of an explicit method: the limit of another axis, the other element, a limit on the wrong side."""
    for seed in (1, 2, 7):
        who = ("--seed", str(seed))
        n = json.loads(run("problem", "stiff", "--json", *who).stdout)["numbers"]
        rate, frequency = 1000 * n["c"] / n["m"], math.sqrt(1000 * n["k"] / n["m"])
        for mistake, value in (("imaginary-axis", n["T"] * rate / 2.828), ("spring", n["T"] * frequency / 2.828), ("no-limit", n["T"] * rate),
                               ("limit-multiplied", n["T"] * rate * 2.785), ("evaluations", 4 * n["T"] * rate / 2.785), ("one-second", rate / 2.785)):  # fmt: skip
            named(folder, "stiff", "d", value, mistake, "", *who)
        h = json.loads(run("problem", "drift", "--json", *who).stdout)["numbers"]["h"] / 1000
        for mistake, value in (("imaginary-axis", 2.828 / h), ("twice", 2.785 / (2 * h)), ("squared", math.sqrt(2.785) / h), ("product", 2.785 * h)):
            named(folder, "drift", "d", value, mistake, "", *who)


def units_of_numbers(folder):
    """A wrong unit is named with three digits too; gravity is missing only where it belongs; a small number is not 0."""
    cases = (
        ("euler", "c", lambda n: round(1000 * 1000 * math.log(1.1) / (n["T"] * n["om"] ** 2), 1), "milli", "a factor of 1000"),
        ("euler", "c", lambda n: f"{1000 * math.log(1.1) / (n['T'] * n['om'] ** 2):.3g} s", "milli", "a factor of 1000"),
        ("scales", "b", lambda n: n["tol"] * 1e-9 / (n["k"] * n["L"]), "power-of-ten", "1e-12"),
        ("differences", "a", lambda n: (n["c"] * 10.0 ** -n["n"]) ** 2 / 6, "power-of-ten", "1e-12"),
        ("differences", "a", lambda n: (n["c"] * 10.0 ** (6 - n["n"])) ** 2 / 6 / 9.81, "other", ""),
        ("refine", "c", lambda n: (n["er"] * 10.0 ** -n["n1"]) ** 2, "error", "the error itself"),
    )
    for exercise, part, value, mistake, words in cases:
        for seed in (1, 2, 7):
            who = ("--seed", str(seed))
            n = json.loads(run("problem", exercise, "--json", *who).stdout)["numbers"]
            named(folder, exercise, part, value(n), mistake, words, *who)
    summary = graded(folder, "steps", "a", 1)[1]["summary"]
    expect("the summary puts the name of a part in quotes", "; look first at 'a'" in summary, summary)
    lighter = "(m1/2+m2)*l1*sin(th1) + m2/2*l2*sin(th2) + m3/2*l3*sin(th3)"
    named(folder, "code", "c", lighter, "gravity", "gravity is missing")


def wrong_ways(folder):
    """A formula upside down, cycles for radians, the whole for the difference: of one number each."""
    cases = (
        ("steps", "d", lambda n: 2828 * 2 * math.pi / n["om"], "cycles"),
        ("amplify", "b", lambda n: 1 + n["k"] * n["h"] / 1000, "upside-down"),
        ("amplify", "c", lambda n: (1 - n["k"] * n["h"] / 1000) / (1 + n["k"] * n["h"] / 1000), "no-half"),
        ("stiff", "a", lambda n: math.sqrt(n["m"] / (1000 * n["k"])), "upside-down"),
        ("stiff", "c", lambda n: 2.828 * n["m"] / n["c"], "imaginary-axis"),
        ("chaos", "b", lambda n: n["tl"] * math.log(1e6 * n["f"] / n["d0"]), "whole"),
        ("space", "b", lambda n: 3 * (3 * n["b"] - 1) / 2, "per-joint"),
        ("axes", "b", lambda n: math.sqrt((n["I2"] - n["I1"]) * (n["I3"] - n["I2"]) / (n["I1"] * n["I3"])), "no-speed"),
        ("differences", "c", lambda n: 1000 * (3e-8 * n["r"]) ** (1 / 3), "smallest-sum"),
        ("conventions", "b", lambda n: (n["j"] - 1) * n["n"] + n["i"] - 1, "row-from-one"),
    )
    for exercise, part, value, mistake in cases:
        for seed in (1, 2, 7):
            who = ("--seed", str(seed))
            n = json.loads(run("problem", exercise, "--json", *who).stdout)["numbers"]
            named(folder, exercise, part, value(n), mistake, "", *who)


def grouped_digits(folder):
    """Digits in groups of three are one number, which the note says; other groups are refused; shares have units."""
    n = json.loads(run("problem", "stiff", "--json").stdout)["numbers"]
    right = f"{n['T'] * 1000 * n['c'] / (2.785 * n['m']):.0f}"
    for blank in (" ", "\u00a0", "\u2009", "\u202f"):
        grouped = right[:-3] + blank + right[-3:]
        _, verdict, entry = graded(folder, "stiff", "d", grouped)
        expect(f"{grouped!r} is read", entry["points"] == 1 and f"was read as {right}" in verdict["note"], f"{entry} {verdict['note']}")
    for answer in (right[:-2] + " " + right[-2:], "1 2000", "1. 200"):
        expect(f"{answer!r} is refused", graded(folder, "stiff", "d", answer)[2]["mistake"] == "unreadable")
    for exercise, part, unit in (("euler", "a", "ppm"), ("refine", "a", "ppb"), ("scales", "b", "ppt")):
        shown = graded(folder, exercise, part, "1", "--show-expected")[2]["expected"].split()
        share = float(shown[0]) * {"ppm": 1e-4, "ppb": 1e-7, "ppt": 1e-10}[unit]
        for answer in (f"{shown[0]} {unit}", shown[0], f"{share:.6e} %"):
            expect(f"{exercise} {part}: {answer} is right", graded(folder, exercise, part, answer)[2]["points"] == 1, answer)


def decimal_commas(folder):
    """A list with decimal commas is read where its marks are clear, and refused where they are not."""
    right = [float(e["expected"].split()[0]) for e in graded(folder, "conventions", "a", [1, 2], "--show-expected", "--seed", "2")[1]["entries"] if e["name"].startswith("a.")]
    x, y = (f"{value:g}".replace(".", ",") for value in right)
    for answer in (f"{x}; {y}", f"[{x}; {y}]", f"({x};{y})", f"{x} {y}", f"[{x} {y}]", f"{x}\n{y}", f"{x} N; {y} N", [x, y]):
        status, verdict, entry = graded(folder, "conventions", "a", answer, "--seed", "2")
        expect(f"{answer!r} is read", status == 0 and entry["points"] == 0.5 and "was read as" in verdict["note"], f"{entry} {verdict['note']}")
    for answer in (f"{x}, {y}", f"[{x}, {y}]", f"{x},{y}", [1, 5, 2, 3]):
        status, _, entry = graded(folder, "conventions", "a", answer)
        good = status == 2 and entry["mistake"] == "unreadable" and "write a list with points, [1.5, 2.3]" in entry["explanation"]
        expect(f"{answer!r} is refused", good, str(entry))
    status, _, entry = graded(folder, "conventions", "a", "1,234; 5,678")
    expect("a comma that may part thousands is refused", status == 2 and "for thousands" in entry["explanation"], str(entry))
    status, _, entry = graded(folder, "assemble", "a", "57,3°; 60,1°")
    expect("angles of a configuration are read", status == 0 and entry["name"] == "a.th2" and entry["mistake"] != "unreadable", str(entry))


def follow_ons(folder):
    """A number that is right with a wrong earlier answer keeps its points; a rubric may give it less."""
    n = json.loads(run("problem", "stiff", "--json").stdout)["numbers"]
    right = 2.785 * n["m"] / n["c"]

    def parts(answers, *more):
        done = run("grade", "stiff", write(folder, "chain.json", answers), "--json", "--no-pictures", *more)
        return {e["name"]: (e["points"], e["mistake"]) for e in json.loads(done.stdout)["entries"]}

    wrong = 1.7 * right
    for given in (wrong, f"{wrong} ms", f"{1000 * wrong} us"):
        found = parts({"c": given, "d": n["T"] * 1000 / wrong})
        expect(f"d from the wrong c {given} keeps its point", found["d"] == (1, "follow-on") and found["c"][0] == 0, str(found))
    for name, answers in (("a right c", {"c": right, "d": n["T"] * 1000 / wrong}), ("no c", {"d": n["T"] * 1000 / wrong}),
                          ("an unreadable c", {"c": "?", "d": n["T"] * 1000 / wrong}), ("another c", {"c": 1.3 * right, "d": n["T"] * 1000 / wrong})):  # fmt: skip
        found = parts(answers)
        expect(f"with {name} it does not", found["d"][0] < 1 and found["d"][1] != "follow-on", str(found))
    found = parts({"c": wrong, "d": n["T"] * 1000 / right})
    expect("a right number is right whatever c is", found["d"] == (1, ""), str(found))

    # a rubric's share, and two earlier answers
    rubric = json.loads(run("rubric", "write", "stiff").stdout)
    expect("the rubric shows the share", rubric["shares"]["follow-on"] == 1, str(rubric["shares"]))
    rubric["shares"]["follow-on"] = 0.5
    path = write(folder, "half.json", rubric)
    expect("a rubric with a share for it is sound", run("rubric", "check", path).returncode == 0)
    found = parts({"c": wrong, "d": n["T"] * 1000 / wrong}, "--rubric", path)
    expect("a rubric gives it less", found["d"] == (0.5, "follow-on"), str(found))
    done = json.loads(run("grade", "cost", write(folder, "two.json", {"a": 700, "b": 90, "c": 700 * 45}), "--json").stdout)
    entry = next(e for e in done["entries"] if e["name"] == "c")
    expect("two wrong answers are both named", entry["points"] == 2 and "your answers to parts a and b, which are wrong" in entry["explanation"], str(entry))

    for name in ("power", "forces", "atwood", "cost"):
        asked = [p["id"] for p in json.loads(run("problem", name, "--json").stdout)["parts"] if p["kind"] == "number"]
        done = json.loads(run("grade", name, write(folder, "zero.json", dict.fromkeys(asked, 0)), "--json").stdout)
        expect(f"{name}: zeros that follow from zeros earn nothing", done["score"] == 0, str(done["entries"]))

    # an exercise whose formula is wrong is found by its check
    part = {"ask": "?", "kind": "number", "points": 1}
    exercise = {"exercise": 2, "id": "mine", "title": "t", "lesson": "l", "section": "s", "statement": ["s"], "draw": {"l": {"range": [1, 9], "digits": 1}},
                "parts": [dict(part, id="a", answer="3*l", second="l+2*l"), dict(part, id="b", answer="6*l", second="l*6")]}  # fmt: skip
    for formula, says in (("2*{a}", None), ("3*{a}", "is not the answer where the earlier answers are right"), ("6*l+0*{a}", "whatever the earlier"), ("2*{b}", "is not the answer")):
        exercise["parts"][1]["follows"] = formula
        done = run("problem", write(folder, "mine.json", exercise), "--seeds", "1..5", "--check")
        expect(f"the check of {formula}", done.returncode == (3 if says else 0) and (says or "0 variants are bad") in " ".join(done.stdout.split()), done.stdout)


if __name__ == "__main__":
    sys.exit(speak_tap([formulas, first_readers, shapes, bases, numbers, units_of_numbers, wrong_ways, grouped_digits, decimal_commas, follow_ons]))
