# SPDX-License-Identifier: GPL-3.0-or-later
# usage: steps.py PROGRAM
# The work of adaptive integrators for the same accuracy: accepted steps, rejected ones and evaluations of the equations of
# motion, ours beside the libraries' (GSL, SUNDIALS IDA), on three problems whose end state is trusted.
#
# Error: largest error of a position at the end, each divided by the largest value that it takes in the list of trusted
# states. An evaluation is one right-hand side (GSL, ours) or one residual (IDA, whose matrix is exact and not counted).
#
# The second table compares at equal error: evaluations between two tolerances are read off the straight line through
# (log error, log evaluations), never beyond the runs made. Exit status 1 when ours needs more than ALLOWED times the best.
import json
import math
import subprocess
import sys

PROBLEMS = [  # name of the trusted states, scene, end
    ("FB0", "fb0-lagrangian", 2),
    ("Andrews' squeezer", "tests/reference/andrews.json", 0.03),
    ("car axis", "tests/reference/caraxis.json", 3),
]
STATES = {  # where the trusted states stand; FB0's three angles come from two independent solutions
    "Andrews' squeezer": "tests/reference/states/andrews.json",
    "car axis": "tests/reference/states/caraxis.json",
}
FB0 = {"th1": 7.4113667986921135, "th2": 0.4646903788895538, "th3": 1.5617825877135394}
OURS = ("index1@dopri5", "index1@dop853", "index1@radau5")
LIBRARIES = ("index1@gsl-rk8pd", "index1@gsl-msadams", "index1@gsl-msbdf", "index1@gsl-bsimp", "index1@ida", "index2@ida", "ggl@ida")
TOLERANCES = [10.0**-k for k in range(4, 11)]
ALLOWED = 1.3  # ours over the best of the libraries


def trusted(problem, t):
    """(value, scale) of each coordinate of the scene at the end."""
    if problem == "FB0":
        return {name: (x, abs(x)) for name, x in FB0.items()}
    with open(STATES[problem], encoding="utf-8") as f:
        known = json.load(f)
    found = {}
    for i, c in enumerate(known["coordinates"]):
        end = next(s for s in known["states"] if s["t"] == t)
        found[c["name"]] = (float(end["q"][i]), max(abs(float(s["q"][i])) for s in known["states"]), c)
    return found


def error_of(found, reference):
    names, q, worst = found["coordinates"], found["samples"]["q"][-1], 0
    for name, (value, scale, *of) in reference.items():
        at = {name: 1} if not of else of[0]["of"]
        offset = float(of[0].get("offset", 0)) if of else 0
        worst = max(worst, abs(sum(f * q[names.index(n)] for n, f in at.items()) + offset - value) / scale)
    return worst


def run(program, scene, method, t):
    command = [program, "run", scene, "--method", method, "--at", repr(t), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 4):
        sys.exit(f"{' '.join(command)}: {done.stderr or done.stdout}")
    return json.loads(done.stdout)


def measure(program, problem, scene, t, methods):
    reference = trusted(problem, t)
    points = {}
    for method in methods:
        for rtol in TOLERANCES:
            found = run(program, scene, f"{method}:rtol={rtol:g}", t)
            cost, reached = found["cost"], found["t_reached"] >= t
            row = [problem, method, f"{rtol:.0e}", str(cost["steps"]), str(cost["rejected"]), str(cost["evaluations"])]
            if reached:
                error = error_of(found, reference)
                points.setdefault(method, []).append((error, cost["evaluations"]))
                yield row + [f"{error:.1e}"], points
            else:
                yield row + ["stopped: " + found["reason"]], points


def evaluations_at(curve, error):
    """Fewest evaluations with which a method was seen to reach an error, None outside what was run."""
    best = None
    for (e0, n0), (e1, n1) in zip(curve, curve[1:]):
        lo, hi = min(e0, e1), max(e0, e1)
        if lo <= error <= hi and hi > lo:
            w = math.log(error / e0) / math.log(e1 / e0)
            n = math.exp((1 - w) * math.log(n0) + w * math.log(n1))
            best = n if best is None else min(best, n)
    return best


def best_of(points, methods, error):
    found = [(n, m) for m in methods if m in points for n in [evaluations_at(points[m], error)] if n]
    return min(found, default=(None, "-"))


def compare(problem, points):
    for k in range(2, 11):
        error = 10.0**-k
        (ours, our_name), (theirs, their_name) = best_of(points, OURS, error), best_of(points, LIBRARIES, error)
        if ours and theirs:
            ratio = ours / theirs
            yield [problem, f"{error:.0e}", our_name, f"{ours:.0f}", their_name, f"{theirs:.0f}", f"{ratio:.2f}", "" if ratio <= ALLOWED else "more"]


def print_table(table):
    widths = [max(map(len, column)) for column in zip(*table)]
    for row in table:
        print("  ".join(cell.ljust(w) for cell, w in zip(row, widths)).rstrip())


def main():
    program = sys.argv[1]
    listed = json.loads(subprocess.run([program, "list", "methods", "--json"], capture_output=True, text=True, check=True).stdout)
    there = {i["name"] for i in listed["integrators"]}
    methods = [m for m in OURS + LIBRARIES if m.split("@")[1] in there]
    runs = [["problem", "method", "rtol", "steps", "rejected", "evaluations", "error"]]
    equal = [["problem", "error", "ours", "evaluations", "library", "evaluations", "ratio", f"above {ALLOWED}"]]
    for problem, scene, t in PROBLEMS:
        points = {}
        for row, points in measure(program, problem, scene, t, methods):
            runs.append(row)
        equal += compare(problem, points)
    print("Steps of adaptive integrators, ours and the libraries' (tests/reference/steps.py says how they are counted)\n")
    print_table(runs)
    print("\nAt equal error, the best of each side\n")
    print_table(equal)
    sys.exit(any(row[-1] == "more" for row in equal))


main()
