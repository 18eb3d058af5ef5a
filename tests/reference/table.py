# SPDX-License-Identifier: GPL-3.0-or-later
# usage: table.py PROGRAM
# Runs every problem of tests/reference/states/ by its methods through the command line and prints to how many
# digits the states agree with the trusted ones, and with those that were published.
#
# Digits: -log10 of the largest error of a component, each divided by the largest value that component takes in
# the list of trusted states (a component that passes through zero keeps its scale); 16 at most.
import glob
import json
import math
import subprocess
import sys

KINDS = ("q", "v", "lambda")


def run(program, problem, scene, method, times):
    command = [program, "run", scene, "--method", method, "--at", ",".join(map(repr, times)), "--json"]
    for setting in problem.get("set", "").split():
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 4):  # 4: the run ended early and said why
        sys.exit(f"{' '.join(command)}: {done.stderr or done.stdout}")
    return json.loads(done.stdout)


def read(problem, found, k):
    """The state of sample k in the coordinates of the reference."""
    samples, names = found["samples"], found["coordinates"]
    state = {"lambda": [problem["lambda_factor"] * x for x in samples["lambda"][k]]}
    for kind in ("q", "v"):
        state[kind] = [
            sum(f * samples[kind][k][names.index(n)] for n, f in c["of"].items())
            + (float(c.get("offset", 0)) if kind == "q" else 0)
            for c in problem["coordinates"]
        ]
    return state


def scales(problem):
    return {
        kind: [max(map(abs, map(float, column))) for column in zip(*(s[kind] for s in problem["states"] if kind in s))]
        for kind in KINDS
    }


def digits(state, reference, scale):
    """Digits of q, v, lambda as text; - where the reference has none."""
    columns = []
    for kind in KINDS:
        errors = [
            abs(x - float(r)) / (s or 1)
            for x, r, s in zip(state[kind], reference.get(kind, []), scale[kind])
            if r is not None
        ]
        columns.append(f"{min(16, -math.log10(max(max(errors), 1e-16))):.1f}" if errors else "-")
    return columns


def rows(program, problem):
    times = sorted({s["t"] for s in problem["states"] + problem["published"]})
    scale = scales(problem)
    for scene in problem["scenes"]:
        path = f"tests/reference/{scene}.json" if glob.glob(f"tests/reference/{scene}.json") else scene
        for entry in problem["methods"]:
            found = run(program, problem, path, entry["method"], times)
            for k, t in enumerate(times):
                if t > found["t_reached"] * (1 + 1e-12):
                    yield [problem["problem"], scene, entry["method"], f"{t:g}", "stopped: " + found["reason"]]
                    break
                state = read(problem, found, k)
                trusted = [digits(state, s, scale) for s in problem["states"] if s["t"] == t] or [["-"] * 3]
                known = [digits(state, s, scale) for s in problem["published"] if s["t"] == t]
                published = "; ".join("/".join(d) for d in known) or "-"
                yield [problem["problem"], scene, entry["method"], f"{t:g}", *trusted[0], published]


def main():
    table = [["problem", "scene", "method", "t [s]", "q", "v", "lambda", "published q/v/lambda"]]
    for name in sorted(glob.glob("tests/reference/states/*.json")):
        with open(name, encoding="utf-8") as f:
            table += rows(sys.argv[1], json.load(f))
    widths = [max(map(len, column)) for column in zip(*(row for row in table if len(row) == len(table[0])))]
    print("Digits that agree with trusted states, and with published ones (tests/reference/table.py says how they are counted)\n")
    for row in table:
        print("  ".join(cell.ljust(w) for cell, w in zip(row, widths)).rstrip())


main()
