# SPDX-License-Identifier: GPL-3.0-or-later
"""Similar mechanisms: lengths times s, masses times s^3, times times sqrt(s), for s = 1e-9 to 1e6.

In the same gravity these are one mechanism in other units, and every method has to give the same angles to rounding. A tolerance
or a threshold that is an absolute number shows as a difference, or as a refusal. Prints one line per scene and method: the
largest difference of a coordinate from s = 1 (lengths over s) for each s; "worst" is the largest of the line.

usage: similarity.py PROGRAM [SCENE...]   (make similarity keeps the table in tests/tables/similarity.txt)
"""

import glob
import json
import math
import os
import subprocess
import sys
import tempfile

SCALES = [1e-9, 1e-6, 1e-4, 1e-2, 1, 1e2, 1e4, 1e6]
LESSONS = os.path.join(os.path.dirname(__file__), "..", "..", "lessons")
SCENES = {"four-bar": 0.5, "slider-crank": 0.5, "stewart-6-3": 0.1}  # [s] of motion
# how a parameter grows with s, by its unit
POWER = {"m": 1, "kg": 3, "rad/s": -0.5, "N/m": 2, "N*s/m": 2.5, "m/s^2": 0, "rad": 0, "": 0, "kg*m^2": 5, "N*m": 4, "m/s": 0.5,
         "N*m*s/rad": 4.5, "N": 3}
FIXED = ["index1@rk4", "baumgarte:alpha={a},beta={a}@rk4", "projection@rk4", "nullspace@rk4", "nullspace:basis=orthonormal@rk4",
         "nullspace-tangent@rk4", "partitioning@rk4", "reduced@rk4", "udwadia-kalaba@rk4", "nullspace-solver@rk4",
         "augmented-lagrangian:omega={w}@rk4", "penalty:omega={w}@rk4", "symmetric-projection@midpoint", "index1@implicit-euler",
         "projection@gauss2", "partitioning@gauss2", "index2@midpoint", "index2@hem4", "index2@radau5", "index3@radau5", "ggl@radau5",
         "index3@genalpha", "ggl@genalpha", "index3@hht", "index3@rattle", "ali3p@trapezoidal"]
ADAPTIVE = ["projection@dopri5:rtol=1e-9", "nullspace-tangent@dopri5:rtol=1e-9", "ggl@radau5:rtol=1e-9", "index1@ida:rtol=1e-8"]


def scaled(name, s, folder):
    """The scene in other units, as a file."""
    with open(glob.glob(os.path.join(LESSONS, "*", "scenes", name + ".json"))[0], encoding="utf-8") as file:
        scene = json.load(file)
    for parameter in scene["parameters"].values():
        if isinstance(parameter, dict):
            parameter["value"] *= s ** POWER[parameter["unit"]]
            parameter.pop("min", None)
            parameter.pop("max", None)
    path = os.path.join(folder, f"{name}-{s:g}.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(scene, file)
    return path


def spelled(method, s, scene):
    root = math.sqrt(s)
    method = method.format(a=repr(5 / root), w=repr(10 / root))
    if "rtol" in method:
        return method
    method += f":h={2e-3 * root!r}"
    return method + ",speed-forces=split" if "rattle" in method and scene.startswith("stewart") else method


def run(program, path, method, T):
    call = [program, "run", path, "--method", method, "--time", repr(T), "--at", repr(T), "--json"]
    done = subprocess.run(call, capture_output=True, timeout=300)
    try:
        document = json.loads(done.stdout)
        q = document["samples"]["q"]
        return document["status"], q[-1] if q else None, document["coordinates"]
    except (ValueError, KeyError, IndexError):
        return "refused", None, []


def is_length(name):
    """Coordinates of the three scenes that are lengths."""
    return name in ("x", "X", "Y", "Z", "s") or name[0] in "xL"


def compare(program, name, method, folder):
    """For each scale the largest difference from s = 1, or the status as a word."""
    T = SCENES[name]
    results = {s: run(program, scaled(name, s, folder), spelled(method, s, name), T * math.sqrt(s)) for s in SCALES}
    status, reference, coordinates = results[1]
    row = []
    for s in SCALES:
        status, q, _ = results[s]
        if status != "ok" or q is None or reference is None:
            row.append(status)
        else:
            row.append(max(abs((b / s if is_length(c) else b) - a) for c, a, b in zip(coordinates, reference, q)))
    return row


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        print("# similar mechanisms: largest difference of a coordinate from s = 1")
        print("%-14s %-40s %s   worst" % ("scene", "method", " ".join("%8s" % f"s={s:g}" for s in SCALES)))
        for name in sys.argv[2:] or SCENES:
            for method in FIXED + ADAPTIVE:
                row = compare(program, name, method, folder)
                numbers = [x for x in row if not isinstance(x, str)]
                worst = "refused" if len(numbers) < len(row) else "%.0e" % max(numbers)
                cells = " ".join("%8s" % (x[:8] if isinstance(x, str) else "%.0e" % x) for x in row)
                print("%-14s %-40s %s   %s" % (name, method, cells, worst), flush=True)


if __name__ == "__main__":
    main()
