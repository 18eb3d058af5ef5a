# SPDX-License-Identifier: GPL-3.0-or-later
"""What is handed out: the form of a submission, and the ranges of the numbers. Speaks TAP."""

import json
import os
import sys

sys.path.insert(0, os.path.dirname(__file__))
from exercise import expect, run, speak_tap, write  # noqa: E402


def templates(folder):
    """The submission that `problem --json` writes is read as it stands, once its places are filled in."""
    def fill(node, name=""):
        if isinstance(node, dict):
            return {key: fill(value, key) for key, value in node.items()}
        if isinstance(node, list):
            return [fill(value) for value in node]
        return 1.5 if node is None else "a" if name in ("choice", "reason") else node

    for problem in json.loads(run("problems", "--json").stdout)["problems"]:
        told = json.loads(run("problem", problem["id"], "--json", "--student", "Ada").stdout)
        if "parts" not in told:
            continue  # a matrix of formulas: its form is another test's
        form = json.loads(told["submission"])
        expect(f"{problem['id']}: the form has the parts and the student", list(form) == ["student", *(p["id"] for p in told["parts"])] and form["student"] == "Ada", str(form))
        empty = json.loads(run("grade", problem["id"], write(folder, "form.json", told["submission"]), "--json", "--no-pictures").stdout)
        expect(f"{problem['id']}: an empty form answers nothing", empty["score"] == 0 and {e["mistake"] for e in empty["entries"]} == {"blank"}, str(empty)[:600])

        # numbers and letters in their places
        kinds = {p["id"]: p["kind"] for p in told["parts"]}
        filled = {key: fill(value) for key, value in form.items() if kinds.get(key, "") in ("", "number", "vector", "reading", "configuration", "choice", "scene")}
        done = run("grade", problem["id"], write(folder, "filled.json", filled), "--json", "--no-pictures")
        bad = [e for e in json.loads(done.stdout).get("entries", []) if e["name"].split(".")[0] in filled and e["mistake"] in ("unreadable", "shape", "blank")]
        expect(f"{problem['id']}: a filled form is read", len(filled) == 1 or (done.returncode == 0 and not bad), f"{done.stdout[:300]} {bad}")


def forms_in_every_spelling(folder):
    """A choice, a number and a list in the form are graded as what they are, and what is left out is blank."""
    told = json.loads(run("problem", "drift", "--json").stdout)
    form, n = json.loads(told["submission"]), told["numbers"]
    form.update(a=n["g"] * n["k"] ** 2, e="-gamma - 2*alpha*J*v - beta^2*phi")
    entries = json.loads(run("grade", "drift", write(folder, "two.json", form), "--json").stdout)["entries"]
    expect("two filled places of six are graded", {e["name"]: e["mistake"] for e in entries} == dict.fromkeys("bcdf", "blank") | dict.fromkeys("ae", ""), str(entries))
    for part, form in (("p1 a", {"matrix": [], "right": [], "unknowns": []}), ("method a", ""), ("p5 a", []), ("p4 b", {"M": [], "Phi": [], "v": []})):
        name, part = part.split()
        own = json.loads(json.loads(run("problem", name, "--json").stdout)["submission"])[part]
        expect(f"the form of {name} {part} tells nothing of the answer", own == form, str(own))


def ranges(_):
    """A student and a teacher read between which values the numbers are drawn."""
    text = run("problem", "stiff", "--wide").stdout
    expect("the text has the ranges", "Other variants have other numbers: m 0.5 to 4 kg; k 100 to 900 kN/m; c 2 to 20 kN s/m; tl 0.3 to 1.5 s; T 1 to 5 s; n 6, 8 or 10." in text, text)
    text = run("problem", "p3", "--wide").stdout
    expect("that of a matrix too", "Other variants have other numbers: l1 0.3 to 3 m; " in text and "th4 -3 to 3 rad." in text, text)
    text = run("problem", "coupler-curve", "--wide").stdout
    expect("hidden numbers stay hidden", "c1 0.42 to 0.55 m" in text and "k2 1.1" not in text and "formula" not in text, text)
    expect("where nothing is drawn, nothing is said", "Other variants" not in run("problem", "slips-1").stdout)
    table = run("problems", "--wide").stdout
    expect("the wide table has the ranges", "m1 1 to 3 kg; m2 3.5 to 6 kg" in table and "the order of the options" in table, table[:2000])
    expect("the folded one has the names", "1 to 3 kg" not in run("problems").stdout)


if __name__ == "__main__":
    sys.exit(speak_tap([templates, forms_in_every_spelling, ranges]))
