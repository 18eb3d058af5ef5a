# SPDX-License-Identifier: GPL-3.0-or-later
"""Every exercise over 200 seeds: a row each. usage: exercises.py PROGRAM [SEEDS]

A row says how many variants were drawn, how many differ, how many right answers got full marks, how many listed mistakes were
named, and how many variants are bad. Right answers of formulas are handed in in five spellings besides. Exit status 1 if any
variant is bad or a right answer loses a point.
"""

import glob
import json
import os
import re
import subprocess
import sys
import tempfile

PROGRAM = sys.argv[1]
SEEDS = int(sys.argv[2]) if len(sys.argv) > 2 else 200
GREEK = {"th": "θ", "gamma": "γ", "lambda": "λ", "tau": "τ", "Phi": "Φ"}
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


def spellings(exercise, folder):
    """(tried, accepted) of the formulas in five spellings, with seed 1."""
    tried = accepted = 0
    for part in exercise.get("parts", []):
        if part["kind"] not in ("formula", "formulas", "matrix", "blocks", "basis"):
            continue
        for form in FORMS:
            path = os.path.join(folder, "answer.json")
            with open(path, "w", encoding="utf-8") as f:
                json.dump({part["id"]: spell(part["answer"], form, part["kind"] in ("matrix", "blocks"))}, f)
            done = subprocess.run([PROGRAM, "grade", exercise["id"], path, "--format", "json"], capture_output=True, text=True, check=False)
            entries = [e for e in json.loads(done.stdout)["entries"] if e["name"].split(".")[0] == part["id"]]
            good = bool(entries) and all(e["right"] for e in entries)
            tried += 1
            accepted += good
            if not good:
                print(f"# {exercise['id']} {part['id']} {form}: {entries[0]['explanation'] if entries else done.stdout}")
    return tried, accepted


def main():
    bad = 0
    print(f"# every exercise over seeds 1 to {SEEDS}; answers of formulas in {len(FORMS)} spellings\n")
    print(f"{'exercise':24} {'parts':>5} {'variants':>8} {'distinct':>8} {'right':>6} {'mistakes':>8} {'bad':>4} {'spellings':>10}")
    with tempfile.TemporaryDirectory() as folder:
        for path in sorted(glob.glob("lessons/*/problems/*.json"), key=lambda p: (p.split("/")[1], p)):
            with open(path, encoding="utf-8") as f:
                exercise = json.load(f)
            if "exercise" not in exercise:
                continue
            slow = any(part["kind"] == "method" for part in exercise["parts"])
            seeds = min(SEEDS, 20) if slow else SEEDS  # a method is run on its scene for each
            done = subprocess.run([PROGRAM, "problem", exercise["id"], "--seeds", f"1..{seeds}", "--check", "--json"],
                                  capture_output=True, text=True, check=False)  # fmt: skip
            report = json.loads(done.stdout)
            tried, accepted = spellings(exercise, folder)
            bad += report["bad"] + tried - accepted
            print(f"{exercise['id']:24} {len(exercise['parts']):5} {report['variants']:8} {report['distinct']:8} {report['right_answers']:6} "
                  f"{report['mistakes']:8} {report['bad']:4} {f'{accepted} of {tried}' if tried else '':>10}")  # fmt: skip
            if report["first_fault"]:
                print(f"  {report['first_fault']}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
