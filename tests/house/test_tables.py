# SPDX-License-Identifier: GPL-3.0-or-later
"""The stored table of every scene by every method has no cell missing. Speaks TAP."""

import csv
import json
import os
import subprocess
import sys
from pathlib import Path

PROGRAM = os.environ.get("HOLONOM", "build/holonom")
TABLE = "tests/tables/every_method.csv"
ESTIMATES = "tests/tables/accuracy.txt"

# suggested methods that are meant to be off: the exhibit that falls apart, at a step at which one sees it, and loops
# that go over to their other branch where they cross
MEANT_TO_BE_OFF = {("four-bar", None), ("parallelogram", "index1"), ("parallelogram", "baumgarte")}


def listed(what):
    done = subprocess.run([PROGRAM, "list", what, "--json"], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def method(row):
    """Formulation and integrator of a row."""
    formulation, integrator = row["method"].split("@")
    return formulation.split(":")[0], integrator.split(":")[0]


def missing(rows, scenes, names, part):
    there = {(r["scene"], method(r)[part]) for r in rows}
    return [f"{scene} by {name}" for scene in scenes for name in names if (scene, name) not in there]


def inaccurate():
    """Scenes with a suggested method that has no estimate of its error, or one above 1 %."""
    rows = {}
    with open(ESTIMATES, encoding="utf-8") as f:
        for line in f:
            words = line.split()
            if len(words) > 5 and "@" in words[1]:
                rows.setdefault((words[0], words[1]), line)
    faults = []
    for path in sorted(Path("lessons").glob("*/scenes/*.json")):
        for name in json.loads(path.read_text(encoding="utf-8"))["methods"]:
            if {(path.stem, None), (path.stem, name.split("@")[0].split(":")[0])} & MEANT_TO_BE_OFF:
                continue
            if "above 1 %" in rows.get((path.stem, name), "above 1 %"):
                faults.append(f"{path.stem} by {name}")
    return faults


def main():
    with open(TABLE, encoding="utf-8") as f:
        rows = list(csv.DictReader(f))
    scenes = [s["id"] for s in listed("scenes")["scenes"]]
    methods = listed("methods")
    facts = {
        "every scene was run by every formulation": missing(rows, scenes, [m["name"] for m in methods["formulations"]], 0),
        "every scene was run by every integrator": missing(rows, scenes, [m["name"] for m in methods["integrators"]], 1),
        "what did not finish says why": [
            f"{r['scene']} {r['method']}" for r in rows if r["outcome"] != "finished" and r["reason"] == "-"
        ],
        "no error is claimed below that of the reference": [
            f"{r['scene']} {r['method']}"
            for r in rows
            if r["error q"] not in ("-", "") and r["reference error"] != "-"
            and float(r["error q"]) < float(r["reference error"])
        ],
        "suggested methods and steps keep errors below 1 %": inaccurate(),
    }  # fmt: skip
    for k, (fact, faults) in enumerate(facts.items(), 1):
        for fault in faults[:10]:
            print(f"# {fault}")
        print(f"{'not ok' if faults else 'ok'} {k} - {fact}")
    print(f"1..{len(facts)}")
    return 1 if any(facts.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
