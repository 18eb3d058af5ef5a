# SPDX-License-Identifier: GPL-3.0-or-later
# usage: every_method.py PROGRAM [SCENE...]
# Every shipped scene by every formulation and every integrator, 2 seconds each or as long as the scene says where that is less: what
# came of it, and why. Prints CSV, one row per scene and method; none is left out: finished, stopped and refused all stand there,
# with the reason.
#
# Each formulation runs with the first integrator of FIRST_INTEGRATOR that serves it, each integrator left over with the first
# formulation of FIRST_FORMULATION that it serves. Fixed steps are the scene's own, adaptive ones have rtol = 1e-6.
#
# The error is the largest of all coordinates (angles [rad], lengths over the scene's length) against a reference solution: the first of
# REFERENCES that reaches the end, its digits those on which it agrees with the second. An error below the reference's own
# is given as that.
import csv
import json
import math
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

LONGEST = 2.0  # [s]
TOO_LONG = 120  # [s]
FIRST_INTEGRATOR = ("rk4", "radau5", "hem4", "trapezoidal")
FIRST_FORMULATION = ("projection", "index1", "ggl", "index2", "index3")
# a state that is mended after each step makes these begin anew each step
KEEPS_HISTORY = ("gsl-msadams", "gsl-msbdf")
REFERENCES = (
    "projection@dop853:rtol=1e-12",
    "partitioning@dop853:rtol=1e-12",
    "nullspace@dop853:rtol=1e-12",
    "baumgarte:alpha=5,beta=5@dop853:rtol=1e-12",
    # so small a tolerance ends at a pose where rows are lost; steps that are given go through
    "projection@rk4:h=2e-4",
    "projection@dop853:h=5e-3",
)
COLUMNS = (
    "scene", "method", "outcome", "t [s]", "error q", "reference error", "gap [m]", "velocity gap [m/s]",
    "energy change [J]", "evaluations", "operations", "incidents", "reason",
)  # fmt: skip


def ask(program, *words):
    done = subprocess.run([program, *words, "--json"], capture_output=True, text=True, check=False, timeout=TOO_LONG)
    return done.returncode, done.stdout, done.stderr


def methods(program):
    """Spellings without h or rtol, each with whether its integrator chooses its own step."""
    catalogue = json.loads(ask(program, "list", "methods")[1])
    steppers = {s["name"]: s for s in catalogue["integrators"]}
    pairs = []
    for f in catalogue["formulations"]:
        served = f["integrators"]
        pairs.append((f["name"], next((s for s in FIRST_INTEGRATOR if s in served), served[0])))
    for name, s in steppers.items():
        if name not in (p[1] for p in pairs):
            first = FIRST_FORMULATION[1:] if name in KEEPS_HISTORY else FIRST_FORMULATION
            formulation = next((f for f in first if f in s["serves"]), s["serves"][0])
            pairs.append((formulation, name))
    return [(f, s, steppers[s]["adaptive"]) for f, s in pairs]


def run(program, scene, method, duration):
    """The document of a run, or None and why there is none."""
    try:
        code, out, err = ask(program, "run", scene, "--method", method, "--time", repr(duration), "--at", repr(duration))
    except subprocess.TimeoutExpired:
        return None, f"took more than {TOO_LONG} s"
    if code in (0, 4) and out:
        return json.loads(out), ""
    try:
        return None, json.loads(out or err)["errors"][0]["detail"]
    except (ValueError, KeyError, IndexError):
        return None, (err or out).strip().split("\n")[0].removeprefix("holonom: ")


def last(found, key):
    samples = found["samples"][key]
    return samples[-1] if samples else None


def difference(a, b, kinds, length):
    worst = 0.0
    for x, y, kind in zip(last(a, "q"), last(b, "q"), kinds):
        worst = max(worst, abs(x - y) / (length if kind == "length" else 1.0))
    return worst


def reference(program, scene, kinds, length, duration):
    """A run to compare with, and how far another one is from it."""
    good = []
    for method in REFERENCES:
        found, _ = run(program, scene, method, duration)
        if found and found["status"] == "ok" and found["t_reached"] >= duration:
            good.append(found)
        if len(good) == 2:
            return good[0], difference(good[0], good[1], kinds, length)
    return None, math.nan


def number(x):
    return "-" if x is None or not math.isfinite(x) else f"{x:.2g}"


def row(program, scene, method, ref, ref_error, kinds, length, duration):
    found, why = run(program, scene, method, duration)
    if not found:
        return [scene, method, "refused", *["-"] * 9, why]
    done = found["status"] == "ok"
    error = difference(found, ref, kinds, length) if done and ref else None
    if error is not None and error < ref_error:
        error = ref_error
    incidents = sorted({i["code"] for i in found["incidents"]})
    return [
        scene, method, "finished" if done else "stopped", f"{found['t_reached']:.4g}",
        number(error), number(ref_error), number(found["worst_gap"]), number(found["worst_velocity_gap"]),
        number(found["worst_energy_change"]), found["cost"]["evaluations"], round(found["cost"]["operations"]),
        " ".join(incidents) or "-", found["reason"] or "-",
    ]  # fmt: skip


def table(program, scene, told):
    kinds = told["coordinate_kinds"]
    duration = min(LONGEST, told["duration"])
    ref, ref_error = reference(program, scene, kinds, told["length"], duration)
    for f, s, adaptive in methods(program):
        setting = "rtol=1e-6" if adaptive else f"h={told['step']:g}"
        yield row(program, scene, f"{f}@{s}:{setting}", ref, ref_error, kinds, told["length"], duration)


def main():
    program = sys.argv[1]
    shipped = {s["id"]: s for s in json.loads(ask(program, "list", "scenes")[1])["scenes"]}
    scenes = sys.argv[2:] or list(shipped)
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow(COLUMNS)
    with ThreadPoolExecutor(2) as pool:
        for rows in pool.map(lambda scene: list(table(program, scene, shipped[scene])), scenes):
            out.writerows(rows)
            sys.stdout.flush()


if __name__ == "__main__":
    main()
