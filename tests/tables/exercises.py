# SPDX-License-Identifier: GPL-3.0-or-later
"""Every exercise over 200 seeds: a row each. usage: exercises.py PROGRAM [SEEDS [ID ...]]

A row says how many variants were drawn, how many differ, how many right answers got full marks, how many listed mistakes were
named, and how many variants are bad. Right formulas and numbers are handed in in five spellings besides, for every seed. Below the
rows stands how fast formulas are graded. Exit status 1 if any variant is bad, a right answer loses a point, or fewer than 500
submissions a second are graded.
"""

import glob
import json
import os
import random
import re
import resource
import subprocess
import sys
import tempfile
import time

PROGRAM = sys.argv[1]
SEEDS = int(sys.argv[2]) if len(sys.argv) > 2 else 200
ONLY = sys.argv[3:]
GREEK = {"th": "θ", "gamma": "γ", "lambda": "λ", "tau": "τ", "Phi": "Φ"}
NUMBERS = ("number", "vector", "reading", "configuration")
FUNCTIONS = r"\b(sin|cos|sqrt|atan2)\("


def respell(text, form, matrix):
    """One formula in another spelling."""
    if form == "blanks":
        return f" ( {text} ) ".replace("*", " * ")
    if form == "python":
        return re.sub(r"(\w+)'", r"\1.T", text).replace("*", " @ ") if matrix else re.sub(FUNCTIONS, r"np.\1(", text).replace("^", "**")
    if form == "capital":
        return re.sub(r"(\w+)'", r"transpose(\1)", text) if matrix else re.sub(r"\b(sin|cos|sqrt)\(", lambda m: m[1].capitalize() + "(", text)
    if form == "typeset":
        text = text.replace("-", "−").replace("*", "·")
        return re.sub(r"(\w+)'", r"\1ᵀ", text) if matrix else re.sub(r"\bth(\d)", r"θ\1", text)
    return re.sub(r"(\w+)'", r"\1^T", text).replace("*", " ") if matrix else re.sub(r"\bth(\d)", r"theta_\1", text)


FORMS = ("blanks", "python", "capital", "typeset", "underscore")


def spell(answer, form, matrix):
    if isinstance(answer, str):
        return respell(answer, form, matrix)
    if isinstance(answer, list):
        return [spell(a, form, matrix) for a in answer]
    return {k: a if k == "unknowns" else spell(a, form, matrix) for k, a in answer.items()} if isinstance(answer, dict) else answer


def number_in(form, expected, unit):
    """The number that a teacher's verdict expects, as text in one of five spellings."""
    x = float(expected)
    return {"blanks": f"  {x:.6g} {unit} ", "python": x, "capital": f"{x:.6E}", "typeset": f"{x:.6g}".replace("-", "−"), "underscore": f"{x:.6f}{unit}"}[form]


def grade(exercise, paths, seed, *more):
    """The entries of each file's verdict."""
    done = subprocess.run([PROGRAM, "grade", exercise, *paths, "--format", "json", "--seed", str(seed), *more],
                          capture_output=True, text=True, check=False)  # fmt: skip
    return [json.loads(line)["entries"] for line in done.stdout.splitlines()]


def write(folder, name, content):
    path = os.path.join(folder, name)
    with open(path, "w", encoding="utf-8") as f:
        json.dump(content, f)
    return path


def like_answer(part, numbers):
    """Numbers in the shape of the part's answer."""
    if part["kind"] == "configuration":
        return dict(zip(part["asked"], numbers))
    return numbers if isinstance(part.get("answer"), list) else numbers[0]


def respelt(exercise, form, expected):
    """All parts whose answers are formulas or numbers, in one spelling."""
    answers = {}
    for part in exercise["parts"]:
        kind = part["kind"]
        if kind in ("formula", "formulas", "matrix", "blocks", "basis"):
            answers[part["id"]] = spell(part["answer"], form, kind in ("matrix", "blocks"))
        elif kind in NUMBERS:
            # what a reading and a configuration are measured in stands behind the number
            told = [number_in(form, e.split()[0], part.get("unit", " ".join(e.split()[1:2]) if kind in NUMBERS[2:] else ""))
                    for name, e in expected if name.split(".")[0] == part["id"]]  # fmt: skip
            answers[part["id"]] = like_answer(part, told)
    return answers


def spellings(exercise, folder, seeds):
    """(tried, accepted) of formulas and numbers in five spellings, for each seed."""
    tried = accepted = 0
    # an answer to learn the numbers from; no reference is this large
    asked = {p["id"]: like_answer(p, [1e150] * len(p.get("asked", p.get("answer", "")) or "1")) for p in exercise["parts"] if p["kind"] in NUMBERS}
    for seed in range(1, seeds + 1):
        expected = []
        if asked:
            entries = grade(exercise["id"], [write(folder, "ask.json", asked)], seed, "--show-expected")[0]
            expected = [(e["name"], e["expected"]) for e in entries]
        answers = [respelt(exercise, form, expected) for form in FORMS]
        if not answers[0]:
            return 0, 0
        paths = [write(folder, f"{form}.json", a) for form, a in zip(FORMS, answers)]
        for form, told, verdict in zip(FORMS, answers, grade(exercise["id"], paths, seed)):
            for entry in verdict:
                if entry["name"].split(".")[0] in told:
                    tried += 1
                    accepted += entry["right"]
                    if not entry["right"]:
                        print(f"# {exercise['id']} {entry['name']} seed {seed} {form}: {entry['given']}: {entry['explanation']}")
    return tried, accepted


def matrix_exercise(exercise, folder, seeds):
    """A row of an exercise of the first form: the Jacobian, entry by entry, right and with mistakes that must be named."""
    right = [["-l1*sin(th1)", "-l2*sin(th2)", "l3*sin(th3)", "l4*sin(th4)"], ["l1*cos(th1)", "l2*cos(th2)", "-l3*cos(th3)", "-l4*cos(th4)"]]
    mistakes = {
        "sign": "-({0})", "degrees": "l1*sin(th1*pi/180)", "length": "-sin(th1)", "variable": "-l2*sin(th1)", "zero": "0",
        "number": "1.5", "swapped": "-l1*cos(th1)", "column": "-l2*sin(th2)", "factor": "2*({0})", "undifferentiated":
        "l1*cos(th1) + l2*cos(th2) - l3*cos(th3) - l4*cos(th4)",
    }  # fmt: skip
    tried = accepted = faults = bad = 0
    for seed in range(1, seeds + 1):
        paths = [write(folder, f"{form}.json", {"J": spell(right, form, False)}) for form in FORMS]
        for name, wrong in mistakes.items():
            paths.append(write(folder, f"{name}.json", {"J": [[wrong.format(right[0][0]), *right[0][1:]], right[1]]}))
        verdicts = grade(exercise["id"], paths, seed)
        for entries in verdicts[: len(FORMS)]:
            tried += 8
            accepted += sum(e["right"] for e in entries)
        for name, entries in zip(mistakes, verdicts[len(FORMS) :]):
            faults += 1
            named = entries[0]["mistake"]
            good = named == name or (name, named) in (("swapped", "row"), ("degrees", "sign"))
            bad += not good or any(e["mistake"] for e in entries[1:])
            if not good:
                print(f"# {exercise['id']} seed {seed}: {name} was taken for {named}")
    print(f"{exercise['id']:24} {1:5} {seeds:8} {seeds:8} {seeds:6} {faults:8} {bad:4} {f'{accepted} of {tried}':>16}")
    return bad + tried - accepted


def guesses():
    """What a guess earns in the parts with options."""
    parts = []
    for path in glob.glob("lessons/*/problems/*.json"):
        with open(path, encoding="utf-8") as f:
            parts += [p for p in json.load(f).get("parts", []) if p["kind"] == "choice"]

    def is_longest(part, key):
        return max(part[key], key=lambda o: len(o["text"])).get("right", False)

    both = sum(1 / len(p["options"]) / len(p["reasons"]) for p in parts)
    half = sum(0.5 / len(p["options"]) for p in parts) + 0.5 * both
    print(f"\n{len(parts)} parts with options, each with reasons: letters drawn at random earn full marks in {both:.1f} of them, and {100 * half / len(parts):.0f} % "
          "of their points;")  # fmt: skip
    print(f"the longest option is the right one in {sum(is_longest(p, 'options') for p in parts)}, with the longest reason in "
          f"{sum(is_longest(p, 'options') and is_longest(p, 'reasons') for p in parts)}")  # fmt: skip


def speed(folder):
    """Formula submissions a second of one core, without pictures: right ones, and ones whose mistakes have to be found."""
    random.seed(1)
    right = [["-l1*sin(th1)", "-l2*sin(th2)", "l3*sin(th3)", "l4*sin(th4)"], ["l1*cos(th1)", "l2*cos(th2)", "-l3*cos(th3)", "-l4*cos(th4)"]]
    paths = []
    for i in range(250):
        rows = [row[:] for row in right]
        for _ in range(random.choice((0, 0, 1, 2, 8))):
            row, column = random.randrange(2), random.randrange(4)
            rows[row][column] = random.choice(("0", f"-({rows[row][column]})", "sin(th1)", "l1", f"2*({rows[row][column]})", "l1*sin(th1)*x"))
        paths.append(write(folder, f"s{i}.json", {"J": rows}))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    for _ in range(4):
        subprocess.run([PROGRAM, "grade", "p3", *paths, "--format", "csv"], capture_output=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(f"\n1,000 submissions of p3 (8 formulas each, three in five with mistakes): {spent:.2f} s of one core, {1000 / spent:.0f} a second")
    return 1000 / spent < 500


def main():
    bad = 0
    start = time.time()
    print(f"# every exercise over seeds 1 to {SEEDS}; answers of formulas and numbers in {len(FORMS)} spellings for every seed\n")
    print(f"{'exercise':24} {'parts':>5} {'variants':>8} {'distinct':>8} {'right':>6} {'mistakes':>8} {'bad':>4} {'spellings':>16}")
    with tempfile.TemporaryDirectory() as folder:
        for path in sorted(glob.glob("lessons/*/problems/*.json"), key=lambda p: (p.split("/")[1], p)):
            with open(path, encoding="utf-8") as f:
                exercise = json.load(f)
            if ONLY and exercise["id"] not in ONLY:
                continue
            if "exercise" not in exercise:
                bad += matrix_exercise(exercise, folder, SEEDS)
                continue
            done = subprocess.run([PROGRAM, "problem", exercise["id"], "--seeds", f"1..{SEEDS}", "--check", "--json"],
                                  capture_output=True, text=True, check=False)  # fmt: skip
            report = json.loads(done.stdout)
            tried, accepted = spellings(exercise, folder, SEEDS)
            bad += report["bad"] + tried - accepted
            print(f"{exercise['id']:24} {len(exercise['parts']):5} {report['variants']:8} {report['distinct']:8} {report['right_answers']:6} "
                  f"{report['mistakes']:8} {report['bad']:4} {f'{accepted} of {tried}' if tried else '':>16}")  # fmt: skip
            if report["first_fault"]:
                print(f"  {report['first_fault']}")
        guesses()
        bad += speed(folder)
    print(f"all of it took {time.time() - start:.0f} s")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
