# SPDX-License-Identifier: GPL-3.0-or-later
"""Asks every program for FB0 over 10 s, and writes tests/tables/peers.csv and tests/tables/peers.svg.
Usage: peers.py HOLONOM FOLDER, where FOLDER holds the compiled programs."""
import csv
import io
import json
import math
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
TABLES = HERE.parent.parent / "tables"
SCENE = "lessons/01-closed-loops/scenes/fb0.json"
COLOURS = {"holonom": "#0b6e4f", "hand-written C": "#222222", "GSL": "#8a5a00", "SUNDIALS": "#b03060",
           "MuJoCo": "#1f5fbf", "Simbody": "#7a3fb0", "SciPy": "#c04a1a", "Octave": "#5a6b7b"}
WIDTH, HEIGHT, LEFT, TOP, RIGHT, BOTTOM = 820, 460, 70, 24, 170, 50


def output(*words):
    return subprocess.run([str(w) for w in words], check=True, capture_output=True, text=True).stdout


def start_and_end(holonom):
    """The six numbers of the start, and the crank angle at the end by the reference solution."""
    run = json.loads(output(holonom, "run", "fb0", "--method", "index1@rk4:h=1e-3", "--time", "0.01", "--at", "0", "--json"))
    reference = json.loads(output(holonom, "reference", "fb0", "--json"))
    return run["samples"]["q"][0] + run["samples"]["v"][0], reference


def measure(holonom, folder, start):
    numbers = [repr(x) for x in start]
    asked = [[folder / "ours", SCENE, *numbers], [folder / "mujoco", *numbers], [folder / "simbody", *numbers],
             ["/usr/bin/python3", HERE / "with_scipy.py", *numbers],
             ["octave-cli", "-q", "--no-gui", HERE / "with_octave.m", *numbers]]
    lines = "".join(output(*words) for words in asked)
    return [dict(zip(("program", "method", "setting", "seconds", "angle"), row)) for row in csv.reader(io.StringIO(lines))]


def curves(rows):
    found = {}
    for row in rows:
        if math.isfinite(row["error"]):
            found.setdefault((row["program"], row["method"]), []).append((row["seconds"], max(row["error"], 1e-14)))
    return found


def plot(rows):
    points = [p for curve in curves(rows).values() for p in curve]
    low_t, high_t = (f(math.log10(p[0]) for p in points) for f in (min, max))
    low_t, high_t, low_e, high_e = math.floor(low_t), math.ceil(high_t), -12, 1
    x = lambda t: LEFT + (math.log10(t) - low_t) / (high_t - low_t) * (WIDTH - LEFT - RIGHT)
    y = lambda e: TOP + (high_e - min(max(math.log10(e), low_e), high_e)) / (high_e - low_e) * (HEIGHT - TOP - BOTTOM)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="DejaVu Sans, sans-serif" '
           'font-size="12"><title>Error against computing time of eight programs</title>'
           f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>']
    for k in range(low_t, high_t + 1):
        out.append(f'<path d="M{x(10.0 ** k):.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="#ddd"/><text x="{x(10.0 ** k):.1f}" '
                   f'y="{HEIGHT - BOTTOM + 18}" text-anchor="middle">{label(k, "s")}</text>')
    for k in range(low_e, high_e + 1, 2):
        out.append(f'<path d="M{LEFT} {y(10.0 ** k):.1f}H{WIDTH - RIGHT}" stroke="#ddd"/><text x="{LEFT - 8}" '
                   f'y="{y(10.0 ** k) + 4:.1f}" text-anchor="end">1e{k}</text>')
    out.append(f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 10}" text-anchor="middle">computing time of 10 s of motion</text>'
               f'<text transform="translate(16 {HEIGHT / 2}) rotate(-90)" text-anchor="middle">error of the crank angle [rad]</text>')
    for (program, _), curve in curves(rows).items():
        path = "L".join(f"{x(t):.1f} {y(e):.1f}" for t, e in curve)
        out.append(f'<path d="M{path}" fill="none" stroke="{COLOURS[program]}" stroke-width="1.8"/>')
        out += [f'<circle cx="{x(t):.1f}" cy="{y(e):.1f}" r="2.6" fill="{COLOURS[program]}"/>' for t, e in curve]
    for i, (program, colour) in enumerate(COLOURS.items()):
        out.append(f'<rect x="{WIDTH - RIGHT + 20}" y="{TOP + 22 * i}" width="12" height="12" fill="{colour}"/>'
                   f'<text x="{WIDTH - RIGHT + 38}" y="{TOP + 22 * i + 11}">{program}'
                   f'{", same C" if program in ("GSL", "SUNDIALS") else ""}</text>')
    return "".join(out) + "</svg>\n"


def label(k, unit):
    return {0: f"1 {unit}", -3: f"1 m{unit}", -6: f"1 µ{unit}", 1: f"10 {unit}", -1: f"100 m{unit}", -2: f"10 m{unit}",
            -4: f"100 µ{unit}", -5: f"10 µ{unit}"}.get(k, f"1e{k} {unit}")


def summary(rows, limit=1e-5):
    """Per program, the quickest run within the limit."""
    best = {}
    for row in rows:
        if row["error"] <= limit and row["seconds"] < best.get(row["program"], row)["seconds"] + 1e-12:
            best[row["program"]] = row
    ours = best["holonom"]["seconds"]
    print(f"quickest run with an error of at most {limit:g} rad:")
    for program in COLOURS:
        row = best.get(program)
        print(f"  {program:15} " + (f"{row['seconds'] * 1e3:9.2f} ms  {row['seconds'] / ours:7.1f} times ours  {row['method']} {row['setting']}"
                                     if row else "none"))


def main():
    holonom, folder = sys.argv[1], Path(sys.argv[2])
    start, reference = start_and_end(holonom)
    truth = reference["q"][-1][0]
    rows = measure(holonom, folder, start)
    for row in rows:
        row["seconds"], row["error"] = float(row["seconds"]), abs(float(row.pop("angle")) - truth)
    with open(TABLES / "peers.csv", "w", newline="") as f:
        writer = csv.writer(f, lineterminator="\n")
        writer.writerow(["program", "method", "step or tolerance", "seconds", "error_rad"])
        for row in rows:
            writer.writerow([row["program"], row["method"], row["setting"], f"{row['seconds']:.4g}",
                             f"{row['error']:.3g}" if math.isfinite(row["error"]) else "no result"])
    (TABLES / "peers.svg").write_text(plot(rows))
    summary(rows)
    return shutil.which("octave-cli") is None


sys.exit(main())
