# SPDX-License-Identifier: GPL-3.0-or-later
"""Answers that only look right, and right ones in unusual spelling; the checks that an exercise must prove. Speaks TAP."""

import json
import math
import os
import re
import sys

sys.path.insert(0, os.path.dirname(__file__))
from exercise import expect, run, speak_tap, write  # noqa: E402


def verdict(folder, exercise, answers, *more):
    done = run("grade", exercise, write(folder, "answer.json", answers), "--json", "--no-pictures", *more)
    return json.loads(done.stdout)


def entry(folder, exercise, part, answer, *more):
    return next(e for e in verdict(folder, exercise, {part: answer}, *more)["entries"] if e["name"] == part)


def told(folder, exercise, part, answer, *more):
    found = entry(folder, exercise, part, answer, *more)
    return found["mistake"] or ("right" if found["right"] else "wrong")


UNIT, ALIKE = [[1, 0], [0, 1]], [[1, 1], [1, 1]]


def examples(folder):
    """What is nearly singular or nearly zero is neither; what is exactly so is, with decimals and fractions too."""
    cases = (
        ("p4", "b", {"M": UNIT, "Phi": [[1, 0], [0, 1e-9]], "v": [0, 1]}, "not-a-counter-example"),
        ("p4", "b", {"M": UNIT, "Phi": [[1, 1], [1, 1.0000001]], "v": [1, -1]}, "phi-full-rank"),
        ("p4", "b", {"M": ALIKE, "Phi": ALIKE, "v": [1, -1]}, "not-definite"),
        ("p4", "b", {"M": [[1, 2], [2, 1]], "Phi": ALIKE, "v": [1, -1]}, "not-definite"),
        ("p4", "b", {"M": [[1, 1], [1, 1 + 1e-10]], "Phi": ALIKE, "v": [1, -1]}, "right"),
        ("p4", "b", {"M": UNIT, "Phi": [[0.1, 0.2], [0.3, 0.6]], "v": [2, -1]}, "right"),
        ("p4", "b", {"M": UNIT, "Phi": [["1/3", 1], [1, "3"]], "v": [3, -1]}, "right"),
        ("p4", "c", {"M": [[1, 0], [0, 1e-14]], "Phi": [0, 1]}, "not-singular"),
        ("p4", "c", {"M": ALIKE, "Phi": [[1], [-1]]}, "mr-not-positive"),
        ("p4", "c", {"M": [[1, 0], [0, 0]], "Phi": [[1], [5]]}, "right"),
        ("singular", "a", {"J": [[1, 2, 3], [2, 4, 6.000001]]}, "independent"),
        ("singular", "a", {"J": [[1, 0, 0], [0, 1e-7, 0]]}, "independent"),
        ("singular", "a", {"J": [[0.1, 0.2, 0.3], [0.3, 0.6, 0.9]]}, "right"),
        ("singular", "a", [[1, 2, 3], [2, 4, 6]], "right"),
        ("singular", "b", {"J": [[1, 0]], "M": [[1, 0], [0, 1e-9]], "x": [0, 1]}, "has-mass"),
        ("singular", "b", {"J": [1, 0], "M": [[1, 0], [0, 0]], "x": [0, 1e-20]}, "right"),
        ("singular", "c", {"l1": "1 m", "l2": "110 cm", "l3": 1.2, "d": "2"}, "right"),
        ("singular", "c", {"l1": "1 kg", "l2": 1.1, "l3": 1.2, "d": 2}, "unreadable"),
    )
    for exercise, part, answer, expected in cases:
        if expected == "unreadable":
            answer = dict(answer)
            done = run("grade", exercise, write(folder, "answer.json", {part: answer}))
            expect(f"{exercise} {part} {json.dumps(answer)} cannot be read", done.returncode == 2 and "l1 is no number in m" in done.stdout, done.stdout)
        else:
            found = told(folder, exercise, part, answer)
            expect(f"{exercise} {part} {json.dumps(answer)} is {expected}", found == expected, found)


def told_truly(folder):
    """The nearest mistake is named, one slip is one mistake, and a sentence says what is so."""
    ada = "Ada Lovelace"
    found = entry(folder, "forces", "a", 9.3669812279571154, "--student", ada)
    expect("an angle in degrees is named before what is near it", (found["mistake"], " or: " in found["explanation"]) == ("degrees", False), found["explanation"])
    found = entry(folder, "joint-shaft", "d", 37, "--student", "Chén 3")
    expect("the rate of the input is no angle in degrees", (found["mistake"], "degrees" in found["explanation"]) == ("cancelled", False), found["explanation"])
    for exercise, part, answer, mistake in (
            ("forces", "a", -0.0841174420034223, "weight-sign"), ("p2", "c", "N' M Ndot u - N' h", "h-sign"),
            ("p2", "c", "N' h - N' M Ndot u", "ndot-sign"), ("drift", "e", "gamma-2*alpha*J*v-beta^2*phi", "sign-gamma"),
            ("drift", "e", "-gamma+2*alpha*J*v-beta^2*phi", "sign-rate"), ("drift", "e", "-gamma-2*alpha*J*v+beta^2*phi", "sign-gap")):  # fmt: skip
        found = entry(folder, exercise, part, answer, "--student", ada)
        expect(f"{exercise} {part} = {answer} is one mistake", found["mistake"] == mistake and "as well" not in found["explanation"], found["explanation"])

    # the exercise of a matrix
    right = [["-l1*sin(th1)", "-l2*sin(th2)", "l3*sin(th3)", "l4*sin(th4)"], ["l1*cos(th1)", "l2*cos(th2)", "-l3*cos(th3)", "-l4*cos(th4)"]]
    swapped = {e["name"]: "not differentiated" in e["explanation"] for e in verdict(folder, "p3", {"J": right[::-1]})["entries"]}
    expect("a term that was not differentiated is told where it may be one", swapped == {f"J{i}{j}": i == 1 for i in (1, 2) for j in (1, 2, 3, 4)}, str(swapped))
    near = verdict(folder, "p3", {"J": [[e + "+0.001*l1" for e in row] for row in right]})["entries"][0]
    expect("a small term may be wrong where no number was rounded", near["mistake"] == "rounded" and "a small term is wrong" in near["explanation"], near["explanation"])
    named, path = verdict(folder, "p3", {"J": right, "student": ada}), os.path.join(folder, "ada.html")
    seed = str(verdict(folder, "p3", {"J": right}, "--student", ada)["seed"])
    run("grade", "p3", write(folder, "answer.json", {"J": right, "student": ada}), "-o", path)
    with open(path, encoding="utf-8") as page:
        said = f"handed in by {ada}; variant of seed {seed}" in page.read()
    expect("a matrix takes the variant of the student whom the file names", (str(named["seed"]), said) == (seed, True), f"{named['seed']} {seed}")
    chosen = verdict(folder, "p3", {"J": right, "student": ada}, "--seed", "7")
    expect("a seed on the command line goes first", str(chosen["seed"]) == "7", str(chosen["seed"]))

    # what is allowed, what was read, what was not
    told_allowed = entry(folder, "newton-step", "a", -0.25, "--student", ada)["explanation"]
    expect("one of two tolerances is enough, as the question says", "must be right to 0.5 %" in told_allowed, told_allowed)
    note = verdict(folder, "gears", {"b": "$0.85967\\,\\mathrm{kg\\,m^2}$"}, "--student", ada)["note"]
    expect("a number is told as it was read", note == "b was read as 0.85967*(kg*m^2)", note)
    note = verdict(folder, "gears", {"b": "0,85967"}, "--student", ada)["note"]
    expect("with its decimal comma too", note == "b was read as 0.85967", note)
    flat = entry(folder, "turning", "b", {"l2": 2.0, "l3": 1.8}, "--student", ada)["explanation"]
    expect("a value is told with its name", "(abs(sin(th2-th3))-0.6442 must stay above 0 on the way round and falls to -0.0203)" in flat, flat)
    for exercise, answer, field in (("gears", {"answers": {"a": 1}}, "answers"), ("p3", {"j": right}, "j")):
        answer = write(folder, "answer.json", answer)
        path = os.path.join(folder, exercise + ".html")
        said = run("grade", exercise, answer).stdout
        run("grade", exercise, answer, "-o", path)
        with open(path, encoding="utf-8") as page:
            expect(f"{exercise}: what was not read is told without a grade", f"the field '{field}' was not read" in said and "\nnote: " in said and "was not read" in page.read(), said)


def formulas(folder):
    """A rate may be negative; a name with the right number by chance is no right answer; a right formula explains no mistake."""
    found = told(folder, "closure", "a", "-l1*sin(th1)*abs(u1)-l2*sin(th2)*u2")
    expect("the size of a rate is not the rate", found != "right", found)
    found = told(folder, "loops", "e", "-l1*cos(th1)*w1*abs(w1)-l2*cos(th2)*w2^2+l3*cos(th3)*w3^2")
    expect("nor is its signed square its square", found != "right", found)

    # an exercise whose two lengths are the same number
    part = {"id": "a", "ask": "?", "kind": "formula", "points": 1, "states": {"x": {"range": [1, 2]}, "y": {"range": [1, 2], "unit": "rad"}},
            "answer": "l1*x*cos(y)", "second": "x*l1*cos(y)"}  # fmt: skip
    exercise = {"exercise": 2, "id": "mine", "title": "t", "lesson": "l", "section": "s", "statement": ["s"],
                "draw": {"l1": {"choose": [0.5]}, "l2": {"choose": [0.5]}}, "parts": [part]}  # fmt: skip
    mine = write(folder, "mine.json", exercise)
    expect("a name with the same number by chance is named", told(folder, mine, "a", "l2*x*cos(y)") == "stray-name")
    expect("the name itself is right", told(folder, mine, "a", "l1*x*cos(y)") == "right")
    expect("and so is its number", told(folder, mine, "a", "0.5*x*cos(y)") == "right")
    found = entry(folder, "code", "d", "(m2/2*(l1^2*w1^2+l2^2*w2^2/3+l1*l2*cos(th1-th2)*w1*w2))*(1+1e-5)")
    expect("what is nearly right has no exchanged sines", found["mistake"] == "rounded", found["explanation"])
    expect("blanks about a power are read", told(folder, "drift", "e", "-gamma - 2*alpha*J*v - beta ^ 2 * phi") == "right")
    said = run("grade", "p3", write(folder, "answer.json", {"J": [["-0.5*sin(th1)", "1", "1", "1"], ["1", "1", "1", "1"]]})).stdout
    expect("a factor may be a length in numbers", "a factor of 1/2 is wrong as well; if it is a length, write its name" in said, said)
    said = run("grade", "p3", write(folder, "answer.json", {"J": [["-0.8081*sin(th1)", "1", "1", "1"], ["1", "1", "1", "1"]]})).stdout
    expect("a number for a length is told", "write lengths by their names" in said, said)


def spellings(folder):
    """The note says how a formula was read that is spelt otherwise; numbers and units in their usual spellings."""
    row = ["-l1*np.sin(θ1)", "-l_2 \\sin\\theta_2", "l3*sin(q3)", "l4*Sin[th4]"]
    plain = ["l1*cos(th1)", "l2 * cos(th2)", "-l3*cos(th3)", "-l4*cos(th4)**1"]
    found = verdict(folder, "p3", {"J": [row, plain]})
    expect("p3 in four spellings is right", found["score"] == 8, found["summary"])
    expect("and the note says how it was read", found["note"] == "J11 was read as -l1*sin(th1), and 3 more likewise", found["note"])
    found = verdict(folder, "p3", {"J": [["-l1*sin(th1)", "-l2*sin(th2)", "l3*sin(th3)", "l4*sin(th4)"], plain]})
    expect("without another spelling there is no note", found["note"] == "", found["note"])
    found = verdict(folder, "fourbar", {"b": "np.cos(θ1-θ2)*m2*l1*l2/2", "seed": 1})
    expect("in a part too", found["note"] == "b was read as cos(th1-th2)*m2*l1*l2/2", found["note"])

    # one value in many spellings
    right = float(entry(folder, "fourbar", "a", 1e150, "--show-expected")["expected"].split()[0])
    comma = f"{right:.4f}".replace(".", ",")
    for text in (f"{right:.4f} kgm²", f"{right:.4f} kg m2", f"{right * 1000:.1f} g m^2", f"M11 = {right:.4f} kg m^2", f"≈ {right:.4f}", comma):
        expect(f"fourbar a = {text} is right", told(folder, "fourbar", "a", text) == "right")
    found = verdict(folder, "fourbar", {"a": comma, "seed": 1})
    expect("a decimal comma is told", found["note"] == f"a was read as {right:.4f}", found["note"])
    done = run("grade", "fourbar", write(folder, "answer.json", {"a": "1,234"}))
    expect("a comma that may part thousands is not read", done.returncode == 2 and "comma at column 2" in done.stdout, done.stdout)
    for text, expected in ((f"{right:.4f} kg m", "unit"), (f"{right:.4f} g m^2", "kilo")):
        expect(f"fourbar a = {text} is {expected}", told(folder, "fourbar", "a", text) == expected, told(folder, "fourbar", "a", text))

    # a question that names the unit takes it
    for exercise, part, unit in (("forecast", "a", "µm"), ("forecast", "c", "s"), ("energy-drift", "a", "mJ"), ("checks", "b", "mrad"), ("differences", "a", "pm")):
        right = float(entry(folder, exercise, part, 1e150, "--show-expected")["expected"].split()[0])
        expect(f"{exercise} {part} takes its number in {unit}", told(folder, exercise, part, f"{right:.6g} {unit}") == "right")


def names(folder):
    """The members of an answer may be spelt otherwise; those that are not read are told."""
    asked = verdict(folder, "assemble", {"a": {"th2": 1e150, "th3": 1e150}}, "--show-expected")["entries"]
    right = [float(e["expected"].split()[0]) for e in asked if e["name"].startswith("a.")]
    for second, third in (("θ2", "theta_3"), ("th_2", "th3")):
        found = verdict(folder, "assemble", {"seed": 1, "a": {second: right[0], third: right[1]}})
        expect(f"{second} and {third} are read", found["score"] == 4 and found["note"] == "", str(found["entries"][:2]) + found["note"])
    for off, said in ((0.12, "not exact enough"), (0.9, "not this configuration")):
        texts = {e["explanation"] for sign in (-1, 1) for e in verdict(folder, "assemble", {"a": {"th2": right[0] + sign * off, "th3": right[1]}})["entries"] if e["name"] == "a.th2"}
        expect(f"a configuration that is off by {off} gives no distance", all(re.fullmatch(f"{said}; with the whole answer the loop is open by [0-9.]+ m", text) for text in texts), str(texts))
    found = verdict(folder, "assemble", {"a": {"th2": right[0], "th4": right[1]}})
    expect("another name is told", found["score"] == 2 and "the field 'th4' was not read" in found["note"], found["note"])
    found = entry(folder, "turning", "a", {"l_1": 0.1, "l₃": 0.1})
    expect("an open loop has no number without unit", found["mistake"] == "not-assembled" and "off by" not in found["explanation"], found["explanation"])


def slips_by_name(folder):
    """Frequent slips are named; half a count is no missing factor; a value beside 0 is none of the curve."""
    for exercise, part, answer, mistake in (
            ("baumgarte", "b", 250, "one"), ("gap-plot", "a", 0.033, "other"), ("gap-plot", "a", 0.0212, "power-of-ten"),
            ("gap-plot", "a", 0, "other-place"), ("loops", "b", 2, "other"), ("loops", "b", 8, "other"), ("loops", "b", -4, "sign")):  # fmt: skip
        found = entry(folder, exercise, part, answer, "--seed", "1")
        expect(f"{exercise} {part} = {answer} is {mistake}", found["mistake"] == mistake, str(found))
    found = entry(folder, "gap-plot", "b", 0, "--seed", "1")["explanation"]
    expect("a place on the axis that is asked for is named first", found.startswith("this is the time of the smallest value"), found)

    # slips that are computed from the numbers of the variant
    def numbers(exercise):
        return json.loads(run("problem", exercise, "--seed", "1", "--json").stdout)["numbers"]

    x, y = numbers("euler"), numbers("flywheel")
    for exercise, part, answer, mistake in (
            ("euler", "a", (x["om"] * x["h"] / 1000) ** 2, "fraction"), ("euler", "b", math.log(1 + (x["om"] * x["h"] / 1000) ** 2), "one-step"),
            ("euler", "c", 100 / (x["T"] * x["om"] ** 2), "a-tenth"), ("flywheel", "b", y["w"] * (y["M1"] + y["If"]) / (y["M2"] + y["If"]), "momentum"),
            ("flywheel", "b", y["w"] * math.sqrt((y["M1"] + y["If"]) / y["M2"]), "other-side")):  # fmt: skip
        found = told(folder, exercise, part, f"{answer:.4g}", "--seed", "1")
        expect(f"{exercise} {part} names {mistake}", found == mistake, found)

    # two mistakes at once are named for a number that agrees with them closely: three digits may agree by chance
    right = y["w"] * math.sqrt((y["M1"] + y["If"]) / y["M2"])
    pair = entry(folder, "flywheel", "b", 2 * right, "--seed", "1")
    expect("two mistakes are named for exact digits", pair["mistake"] == "other-side" and "1/2 is missing as well" in pair["explanation"], str(pair))
    expect("and not for what is near", told(folder, "flywheel", "b", 2 * right * 1.003, "--seed", "1") == "other")


def one_slip(folder):
    """A slip at one place of the reference is named, of a formula and, where few are possible, of a number."""
    for exercise, part, answer, mistake in (
            ("closure", "a", "-l1*cos(th1)*u1-l2*sin(th2)*u2", "sine"), ("loops", "e", "-l1*cos(th1)*w1^2-l2*cos(th2)*w2+l3*cos(th3)*w3^2", "not-squared"),
            ("code", "c", "9.81*(m1*l1/2*sin(th1)+m2*(l1*sin(th1)+l2*sin(th2))+m3*l3/2*sin(th3))", "double-term"),
            ("code", "d", "m2/2*(l1^2*w1^2-l2^2*w2^2/3+l1*l2*cos(th1-th2)*w1*w2)", "sign-term"),
            ("fourbar", "c", "-m2*l1*l2*sin(th1-th2)*u1/2+g*m2*l2*cos(th2)/2", "not-squared"),
            ("drift", "e", "-gamma", "no-feedback"), ("drift", "e", "-gamma-alpha*J*v-beta*phi", "both-factors"), ("drift", "e", "gamma", "gamma-alone"),
            ("drift", "f", "-inv(M)*J'*J*v", "no-multipliers"), ("loops", "b", 5, "tree"), ("code", "f", 0.4, "one-more")):  # fmt: skip
        found = told(folder, exercise, part, answer, "--seed", "1")
        expect(f"{exercise} {part} = {answer} is {mistake}", found == mistake, found)

    def numbers(exercise):
        return json.loads(run("problem", exercise, "--seed", "3", "--json").stdout)["numbers"]

    w, x, y, z = numbers("atwood"), numbers("energy"), numbers("slider"), numbers("trammel")
    crank, coupler, rocker = (9.81 * x["m1"] * x["l1"] / 2 * math.sin(x["t1"]), 9.81 * x["m2"] * (x["l1"] * math.sin(x["t1"]) + x["l2"] / 2 * math.sin(x["t2"])),
                              9.81 * x["m3"] * x["l3"] / 2 * math.sin(x["t3"]))  # fmt: skip
    high = 9.81 * (x["m1"] * x["l1"] * math.sin(x["t1"]) + x["m2"] * (x["l1"] * math.sin(x["t1"]) + x["l2"] * math.sin(x["t2"])) + x["m3"] * x["l3"] * math.sin(x["t3"]))
    rod = math.degrees(math.asin(y["r"] * math.sin(y["th"]) / y["l"]))
    for exercise, part, answer, mistake in (
            ("energy", "c", crank + coupler, "no-rocker"), ("energy", "c", coupler, "coupler-alone"), ("energy", "c", high, "no-half"),
            ("energy", "c", crank + coupler - rocker, "sign-term"), ("energy", "a", coupler - 9.81 * x["m2"] * x["l2"] * math.sin(x["t2"]), "sign-term"),
            ("slider", "a", y["r"] * math.cos(y["th"]) + y["l"], "horizontal"), ("slider", "b", rod, "degrees"), ("slider", "b", -rod, "degrees"),
            ("atwood", "b", 2 * 9.81 * w["m1"] ** 2 / (w["m1"] + w["m2"]), "lowered"), ("ring", "d", 3 * numbers("ring")["n"] - 3, "links"), ("code", "f", 0.3, "step"),
            ("energy", "b", x["m1"] * x["l1"] * x["w1"] ** 2 / 6, "not-squared"), ("trammel", "b", z["m"] * z["L"] ** 2 / 3, "uniform")):  # fmt: skip
        found = entry(folder, exercise, part, f"{answer:.5g}", "--seed", "3")
        expect(f"{exercise} {part} names {mistake}", found["mistake"] == mistake, str(found))
        if mistake == "degrees":
            expect("degrees turned the wrong way are two mistakes", ("sign is wrong as well" in found["explanation"]) == (answer > 0), found["explanation"])

    # divisors, exponents, single terms; many slips are possible in a long formula: it takes exact digits to tell them apart
    a, b, c, d, e, f, g = (numbers(exercise) for exercise in ("atwood", "transmission", "gears", "closure", "loops", "amplify", "checks"))
    cosine = 2 * b["l1"] * b["d"] * math.cos(b["th"])
    area = b["l2"] * b["l3"] * math.sqrt(1 - ((b["l2"] ** 2 - b["l1"] ** 2 - b["d"] ** 2 + cosine) / (2 * b["l2"] * b["l3"])) ** 2)
    for exercise, part, answer, digits, mistake in (
            ("atwood", "b", 2 * 9.81 * a["m1"] * a["m2"], 4, "no-divisor"),
            ("transmission", "a", b["l2"] ** 2 + b["l3"] ** 2 - b["l1"] ** 2 - b["d"] ** 2 + cosine, 6, "no-divisor"),
            ("transmission", "a", cosine / (2 * b["l2"] * b["l3"]), 6, "missing-term"),
            ("transmission", "b", area, 6, "missing-term"), ("transmission", "b", area, 4, "other"),
            ("gears", "b", c["I1"] + c["I2"] * (c["z1"] / c["z2"]) ** 2 + c["I3"] * c["z1"] / c["z3"], 4, "not-squared"),
            ("closure", "c", d["l1"] * d["w1"] * math.cos(d["t2"] - d["t1"]) / (d["l3"] * math.sin(d["t2"] - d["t3"])), 5, "sine"),
            ("energy", "c", crank / math.tan(x["t1"]) + coupler + rocker, 6, "sine"),  # at one of two places where sin(t1) stands
            ("amplify", "a", 1 - f["k"] * f["h"], 5, "milliseconds"), ("checks", "a", math.log(g["e1"] / g["e2"]), 5, "natural"),
            ("loops", "a", 3 * e["b"] + 2 * e["j"], 3, "sign-term"), ("loops", "b", e["j"] + e["b"], 3, "other")):  # fmt: skip
        found = entry(folder, exercise, part, f"{answer:.{digits}g}", "--seed", "3")
        expect(f"{exercise} {part} to {digits} digits is {mistake}", found["mistake"] == mistake, str(found))


def names_in_formulas(folder):
    """One name in place of another, relative angles and wrong factors in a formula are named, with numbers in place of names too."""
    kinetic, bias = "m2/2*(l1^2*w1^2+{}*l2^2*w2^2+l1*l2*cos(th1-th2)*w1*w2)", "-0.5*m2*l1*l2*sin(th1-th2)*u1^2+g*{}*l2/2*cos({})"
    for exercise, part, answer, mistake, said in (
            ("code", "d", kinetic.format("1/12"), "wrong-factor", "one term is 1/4 times as large as it must be"),
            ("fourbar", "b", "m2*l1*l2*cos(th1-th2)/3", "wrong-factor", "this is 2/3 times the right formula: a number in it is wrong"),
            ("loops", "e", "-l1*w1^2*cos(th1)-3*l2*w2^2*cos(th2)+l3*w3^2*cos(th3)", "wrong-factor", "one term is 3 times as large as it must be"),
            ("closure", "a", "-l1*sin(th1)*u1-l1*sin(th2)*u2", "other-name", "l1 stands where l2 belongs"),
            ("closure", "a", "-{l1}*sin(th1)*u1-{l1}*sin(th2)*u2", "other-name", "probably this mistake: l1 stands where l2 belongs"),
            ("fourbar", "c", bias.format("m3", "th2"), "other-name", "m3 stands where m2 belongs in one term"),
            ("fourbar", "c", bias.format("m2", "th1"), "other-name", "th1 stands where th2 belongs in one term"),
            ("loops", "e", "-l1*w1^2*cos(th1)-l2*w3^2*cos(th2)+l3*w2^2*cos(th3)", "exchanged-names", "w2 and w3 are exchanged"),
            ("closure", "a", "-l1*sin(th1)*u1-l2*sin(th1+th2)*(u1+u2)", "relative-angle", "angle 2 is taken from link 1; the angles of the question are absolute"),
            ("fourbar", "b", "m2*l1*l2*cos(th2)/2", "relative-angle", "angle 2 is taken from link 1; the angles of the question are absolute"),
            ("fourbar", "c", bias.format("m2", "th1+th2"), "relative-angle", "angle 2 is taken from link 1 in one term; the angles of the question are absolute"),
            ("code", "d", "m2/2*(l1^2*w1^2+l2^2*w2^2/3+l1*l2*w1*w2)", "no-sine", "a sine or cosine is missing"),
            ("closure", "a", "-l1*sin(th1)*u1-l2*sin(th2)*u2*u1", "other", "wrong; the cause is none of the known mistakes")):  # fmt: skip
        for name, number in json.loads(run("problem", exercise, "--seed", "2", "--json").stdout)["numbers"].items():
            answer = answer.replace("{" + name + "}", str(number))
        found = entry(folder, exercise, part, answer, "--seed", "2")
        expect(f"{exercise} {part} = {answer} is {mistake}", (found["mistake"], found["explanation"]) == (mistake, said), str(found))
    found = entry(folder, "closure", "a", "(" * 101 + "th1" + ")" * 101)
    expect("a formula that is nested too deep is to be written shorter", found["explanation"].endswith("nested more than 100 deep; write it shorter"), found["explanation"])


def two_in_a_formula(folder):
    """Two mistakes at once, in different terms or in one, are both named; a third leaves nothing to name."""
    kinetic, potential = "m2/2*(l1^2*w1^2+l2^2*w2^2/12+l1*l2*{}w1*w2)", "{}(m1*l1/2*sin(th1)+m2*{}+m3*l3/2*sin(th3))"
    coupler = "(l1*sin(th1)+l2/2*sin(th2))"
    for exercise, part, answer, mistake, first, second in (
            ("closure", "a", "-l1*cos(th1)*u1-l2*sin(th2)*u1", "sine", "sine and cosine are exchanged at one place", "u1 stands where u2 belongs"),
            ("closure", "a", "l1*sin(th1)*u1-l1*sin(th2)*u2", "crank-sign", "the crank's term has the wrong sign: differentiate l1 cos th1", "l1 stands where l2 belongs"),
            ("loops", "e", "-l1*w1*cos(th1)-l2*w2^2*sin(th2)+l3*w3^2*cos(th3)", "not-squared", "a square is missing", "sine and cosine are exchanged at one place"),
            ("fourbar", "e", "l1*l3*sin(th3-th2)", "sign", "the sign is wrong", "l1 stands where l2 belongs"),
            ("code", "d", kinetic.format(""), "no-sine", "a sine or cosine is missing", "one term is 1/4 times as large as it must be"),
            ("code", "d", kinetic.format("sin(th1-th2)*"), "sine", "sine and cosine are exchanged at one place", "one term is 1/4 times as large as it must be"),
            ("fourbar", "c", "-0.5*m2*l1*l2*sin(th1-th2)*u1^2+m2*l2/2*cos(th1+th2)", "gravity", "the acceleration of gravity is missing",
             "angle 2 is taken from link 1; the angles of the question are absolute"),
            ("closure", "a", "-l1*sin(th1)*u1-2*l2*sin(th1+th2)*(u1+u2)", "double", "twice the right value: a factor 1/2 is missing",
             "angle 2 is taken from link 1; the angles of the question are absolute")):  # fmt: skip
        found = entry(folder, exercise, part, answer, "--seed", "2")
        both = re.fullmatch(r"(?:probably this mistake: )?two mistakes (?:at once|in one term): (.*); and (.*)", found["explanation"])
        expect(f"{exercise} {part} = {answer} has two mistakes", found["mistake"] == mistake and bool(both) and both.groups() == (first, second), str(found))
        expect("they earn less than one", 0 < found["points"] <= found["max_points"] / 4, str(found))
    found = entry(folder, "code", "c", potential.format("", coupler))
    expect("gravity that is left out is told", (found["mistake"], found["explanation"]) == ("gravity", "the acceleration of gravity is missing"), str(found))
    found = entry(folder, "closure", "a", "-l2*cos(th1)*u2-l1*cos(th2)*u1*u2")
    expect("many mistakes are not named by chance", found["mistake"] == "other", str(found))


def pasted(folder):
    """A matrix that was pasted as one text is read, with a remark."""
    rows = [["-l1*sin(th1)", "-l2*sin(th2)", "l3*sin(th3)", "l4*sin(th4)"], ["l1*cos(th1)", "l2*cos(th2)", "-l3*cos(th3)", "-l4*cos(th4)"]]
    python = "[[" + "], [".join(", ".join(row) for row in rows) + "]]"
    matlab = "J = [" + "; ".join(" ".join(row) for row in rows) + "];"
    wolfram = python.replace("[", "{").replace("]", "}").replace("sin(", "Sin[").replace("cos(", "Cos[").replace(")", "]")
    for name, text in (("a list", python), ("numpy", f"np.array({python})".replace("sin", "np.sin")), ("MATLAB", matlab), ("Wolfram", wolfram)):
        found = verdict(folder, "p3", {"J": text})
        expect(f"{name} as one text is read", found["score"] == 8 and found["note"].startswith("the text of 'J' was read as a list"), found["note"] + found["summary"])
    latex = r"\begin{pmatrix} -l_1\sin\theta_1 & -l_2\sin\theta_2 & l_3\sin\theta_3 & l_4\sin\theta_4 \\ l_1\cos\theta_1 & l_2\cos\theta_2 & -l_3\cos\theta_3 & -l_4\cos\theta_4 \end{pmatrix}"
    for name, text in (("LaTeX", json.dumps({"J": latex})), ("LaTeX without doubled backslashes", '{"J": "' + latex + '"}')):
        said = json.loads(run("grade", "p3", write(folder, "latex.json", text), "--json", "--no-pictures").stdout)
        expect(f"{name} as one text is read", said["score"] == 8, said["note"] + said.get("reason", ""))
    empty = verdict(folder, "p3", {"J": python.replace(rows[0][1], "")})
    expect("an empty entry is told", empty["score"] == 7 and "nothing stands at 1 place of it" in empty["note"], empty["note"])
    said = run("grade", "p3", write(folder, "comma.json", '{"J": [[1,,2]]}')).stdout
    expect("a value that is missing in JSON is told", "write the value that is missing before the comma" in said, said)
    expect("a matrix of numbers too", told(folder, "singular", "a", {"J": "[1 2 3; 2 4 6]"}) == "right")
    said = run("grade", "p3", write(folder, "answer.json", {"J": "[1, 2"})).stdout
    expect("what is no list is refused as before", "'J' is a text, expected a list of 2 rows" in said, said)


def shown(folder):
    """--show-expected gives the answer in every form, and an example where many are right."""
    rows = [["l1*sin(th1)", "-l2*sin(th2)", "l3*sin(th3)", "l4*sin(th4)"], ["l1*cos(th1)", "l2*cos(th2)", "-l3*cos(th3)", "-l4*cos(th4)"]]
    for form, said in (("text", "expected  -l1*sin(th1) = "), ("csv", "J11: sign (expected -l1*sin(th1) = "), ("junit", "\nexpected  -l1*sin(th1) = ")):
        asked = run("grade", "p3", write(folder, "answer.json", {"J": rows}), "--format", form, "--show-expected").stdout
        hidden = run("grade", "p3", write(folder, "answer.json", {"J": rows}), "--format", form).stdout
        expect(f"the teacher's {form} has the formula", said in asked, asked)
        expect(f"the student's {form} has not", "-l1*sin(th1)" not in hidden, hidden)
    for exercise, part, said in (("basis", "a", "full rank, for example [["), ("p2", "b", "the formula, for example "), ("p5", "a", "at zero, for example [")):
        found = entry(folder, exercise, part, None, "--show-expected")["expected"]
        expect(f"{exercise} {part} shows an example", said in found, found)


def branches(folder):
    """A closed loop of the other branch is closed as exactly as the digits are, as the picture shows."""
    verdicts = verdict(folder, "assemble", {"a": {"th2": -1.047, "th3": -2.489}}, "--seed", "1")["entries"]
    found = next(e for e in verdicts if e["name"] == "a.th2")
    huge = next(e for e in verdict(folder, "assemble", {"a": {"th2": 1e99, "th3": 1}}, "--seed", "1")["entries"] if e["name"] == "a.th2")
    expect("a huge angle is no direction", "says no direction" in huge["explanation"] and "away from" not in huge["explanation"], str(huge))
    expect("what the digits leave open is said", found["explanation"] == "the loop closes here too (your digits leave 155 µm open), but in the other assembly mode", str(found))


def plots(folder):
    """The plot of a question is a picture of its own: ink on paper."""
    run("problem", "gap-plot", "--seed", "1", "-o", os.path.join(folder, "gap.svg"))
    expect("parts that ask about one plot share its file", sorted(f for f in os.listdir(folder) if f.startswith("gap")) == ["gap.svg"], str(os.listdir(folder)))
    with open(os.path.join(folder, "gap.svg"), encoding="utf-8") as f:
        svg = f.read()
    expect("it has a background", 'width="640" height="300"' in svg and "#FCFCFA" in svg.upper(), svg[:400])
    expect("its letters are those of the other pictures: lines", "<text" not in svg and svg.count("<path") > 20, svg[:400])
    expect("the curve joins all samples", max(d.count("l") for d in re.findall(r' d="([^"]*)"', svg)) >= 490, svg[:400])


def frames(folder):
    """What stands around a formula is read or refused with words: a name before it, a unit behind it, other names in it."""
    for exercise, part, text, note in (
        ("fourbar", "b", "y = m2*l1*l2*cos(th1-th2)/2", "b was read as m2*l1*l2*cos(th1-th2)/2"),
        ("passive", "a", "-B*sin(q)/2 m", "a was read as -B*sin(q)/2"),
        ("trammel", "a", "-L*sin(th) m", "a was read as -L*sin(th)"),  # m is a mass as well
        ("trammel", "a", "M_{12}(th) = -L*sin(th) m", "a was read as -L*sin(th)"),
        ("p2", "b", "M_r = N^{\\top} M N", "b was read as N'*M*N"),
        ("p2", "b", "np.transpose(N) @ M @ N", "b was read as (N)'*M*N"),
        ("p2", "b", "N'*M*N", ""),
        ("p2", "b", "N' * M*N", ""),
        ("basis", "a", [["np.sin(θ2-θ3) l2 l3"], ["-l1*l3*sin(th1-th3)"], ["l1*l2*sin(th2-th1)"]], "a was read as sin(th2-th3) *l2 *l3"),
    ):  # fmt: skip
        found = verdict(folder, exercise, {"seed": 1, part: text})
        right = next(e for e in found["entries"] if e["name"] == part)["right"]
        expect(f"{text} is read, and the note says how", right and found["note"] == note, str(right) + found["note"])
    for exercise, part, text, words in (
        ("passive", "a", "-g*sin(q)/2", "'g' is not known here; known here: A, B, tq, q0, w, q"),
        ("p2", "b", "N'*Q*N", "there is no matrix 'Q'; known here: M, J, N; products"),
        ("fourbar", "b", "m2*l1 = 3", "'=' was found"),
    ):
        found = verdict(folder, exercise, {"seed": 1, part: text})
        expect(f"{text} is refused with what is known", found["status"] == "ungradable" and words in found["hint"], found["hint"])
    found = entry(folder, "trammel", "a", "-L*cos(th) m", "--seed", "1")
    expect("a wrong formula before a unit is wrong", not found["right"] and found["points"] == 0, str(found))


def two_at_once(folder):
    """Two mistakes in different terms of a formula of matrices are both named; two in one term are not taken for them."""
    for text, words in (("-gamma - J*v*alpha - beta^2*phi", ["the factor 2 before alpha"]),
                        ("gamma - 2*alpha*J*v - beta*phi", ["two mistakes at once", "gamma has the wrong sign", "beta is a rate"]),
                        ("2*alpha*J*v - beta*phi - gamma", ["two mistakes at once", "the term in J v has the wrong sign", "beta is a rate"]),
                        ("gamma - alpha*J*v - beta^2*phi", ["two mistakes at once", "gamma has the wrong sign", "the factor 2 before alpha"])):  # fmt: skip
        found = entry(folder, "drift", "e", text, "--seed", "3")
        expect(f"{text} is named", all(word in found["explanation"] for word in words) and (len(words) > 1) == ("two mistakes" in found["explanation"]), found["explanation"])
    found = entry(folder, "drift", "e", "-gamma + alpha*J*v - beta^2*phi", "--seed", "3")
    expect("a term is not missing where it has the wrong sign", "oscillates" not in found["explanation"], found["explanation"])
    # so are two mistakes in different blocks of a system
    lower, plain = [["M", "J'"], ["J", "0"]], "S'*tau - h"
    for matrix, right, unknowns, words in ((lower, [plain, "gamma"], ["a", "lambda"], ["J' has the other sign", "gamma has the wrong sign"]),
                                           (lower, ["S'*tau + h", "gamma"], ["a", "-lambda"], ["gamma has the wrong sign", "h goes to the right-hand side"])):  # fmt: skip
        found = entry(folder, "p1", "a", {"matrix": matrix, "right": right, "unknowns": unknowns})
        expect(f"a system with {right} and {unknowns} is named", found["explanation"].startswith("two mistakes at once") and found["points"] == 1
               and all(word in found["explanation"] for word in words), str(found))  # fmt: skip
    # an angle of hundredths has the cosine of none
    for exercise, answer in (("quaternion", 1), ("joint-shaft", json.loads(run("problem", "joint-shaft", "--seed", "3", "--json").stdout)["numbers"]["w"])):
        found = entry(folder, exercise, "a", answer, "--seed", "3")
        expect(f"{exercise}: degrees are not the only cause", "the angle was left out, or sine and cosine were taken of degrees" in found["explanation"], found["explanation"])


def quaternions(folder):
    """-p is named, as what it is."""
    right = float(entry(folder, "quaternion", "a", 1e150, "--show-expected")["expected"].split()[0])
    found = entry(folder, "quaternion", "a", -right)
    expect("the scalar part of -p is not called a wrong sign", found["mistake"] == "other-sign" and "the same orientation" in found["explanation"], str(found))


def proofs(folder):
    """A check that no listed mistake triggers is a fault of the exercise."""
    part = {"id": "a", "ask": "?", "kind": "example", "points": 1, "given": ["M"], "shapes": {"M": [2, 2]}, "answer": {"M": UNIT},
            "checks": [{"id": "singular", "test": "nonsingular", "of": "M", "says": "M is singular"}]}  # fmt: skip
    exercise = {"exercise": 2, "id": "mine", "title": "t", "lesson": "l", "section": "s", "statement": ["s"], "parts": [part]}
    done = run("problem", write(folder, "mine.json", exercise), "--seeds", "1..2", "--check")
    expect("it is named", done.returncode != 0 and "no listed mistake triggers the check 'singular'" in done.stdout, done.stdout)
    done = run("problem", "loops", "--seeds", "1..20", "--check")
    expect("draws that were refused are listed with their condition", "drawn again" in done.stdout and "for not 3*b-2*j+0.5 > 0" in done.stdout, done.stdout)
    spread = [line for line in done.stdout.splitlines() if "right answers of part b" in line]
    expect("the spread of right answers is told, and is one", len(spread) == 1 and spread[0].split()[-3] != spread[0].split()[-1], done.stdout)
    bad = {"id": "a", "ask": "?", "kind": "number", "points": 1, "answer": "l", "second": "2*l-l",
           "faults": [{"id": "beyond", "answer": "acos(l)", "says": "no", "share": 0.5}]}  # fmt: skip
    far = dict(exercise, parts=[bad], draw={"l": {"range": [2, 9], "digits": 2}})
    done = run("problem", write(folder, "far.json", far), "--seeds", "1..2", "--check")
    expect("so is a listed mistake without a finite value", done.returncode == 3 and "the mistake 'beyond' (null) is named unreadable" in done.stdout, done.stdout + done.stderr)
    bad.update(answer="sqrt(3-l)", second="sqrt(3-l)", faults=[])
    done = run("problem", write(folder, "far.json", far), "--seeds", "1..9", "--check")
    expect("a reference without a value is told with the seed that was asked for", ", part a: the reference is not finite with the numbers" in done.stdout
           and "part a: part a" not in done.stdout and done.returncode == 3, done.stdout)  # fmt: skip
    part["faults"] = [{"id": "singular", "answer": {"M": ALIKE}}]
    done = run("problem", write(folder, "mine.json", exercise), "--seeds", "1..2", "--check")
    expect("with the mistake the exercise is sound", done.returncode == 0, done.stdout)


if __name__ == "__main__":
    sys.exit(speak_tap([examples, formulas, told_truly, spellings, names, slips_by_name, one_slip, names_in_formulas, two_in_a_formula, pasted, shown, branches, plots, quaternions, two_at_once, frames, proofs]))
