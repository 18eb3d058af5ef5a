# SPDX-License-Identifier: GPL-3.0-or-later
"""The same numbers from two compilers, on every shipped scene: compilers.py PROGRAM PROGRAM [SCENE...].

Each program runs each scene for a second, or to its end, by the methods below and writes every number with 17 digits. A row of the
table says how many numbers a scene's documents hold and how many of them differ. Exit status 1 when any does."""

import json
import subprocess
import sys

METHODS = ["index1@rk4:h=0.01", "projection@rk4:h=0.01", "baumgarte@dopri5:rtol=1e-8", "nullspace@rk4:h=0.01", "ggl@radau5:rtol=1e-8",
           "penalty@radau5:rtol=1e-6", "reduced@dopri5:rtol=1e-8"]
SECONDS = 1


def ask(program, *words):
    done = subprocess.run([program, *words, "--json"], capture_output=True, text=True, timeout=900)
    if not done.stdout.strip():
        return {"refused": done.stderr}
    return json.loads(done.stdout)


def leaves(value, place=()):
    """Every number and text of a document with its place; computing times are those of the machine."""
    if isinstance(value, dict):
        for name, item in value.items():
            if name not in ("cpu_seconds", "build"):
                yield from leaves(item, (*place, name))
    elif isinstance(value, list):
        for i, item in enumerate(value):
            yield from leaves(item, (*place, i))
    else:
        yield place, value


def main():
    first, second, *wanted = sys.argv[1:]
    scenes = [s for s in ask(first, "list", "scenes")["scenes"] if not wanted or s["id"] in wanted]
    if not scenes:
        sys.exit("compilers.py: no shipped scene is called that")
    print(f"{'scene':28} {'methods':>7} {'refused':>7} {'numbers':>9} {'different':>9}")
    total = differing = 0
    for scene in scenes:
        n = bad = refused = 0
        for method in METHODS:
            words = ["run", scene["id"], "--method", method, "--time", f"{min(SECONDS, scene['duration']):g}", "--no-native"]
            a, b = (dict(leaves(ask(program, *words))) for program in (first, second))
            refused += ("refused",) in a
            n += len(a)
            # repr: -0 is not 0
            bad += len(a.keys() ^ b.keys()) + sum(repr(a[place]) != repr(b[place]) for place in a.keys() & b.keys())
        print(f"{scene['id']:28} {len(METHODS):7} {refused:7} {n:9,} {bad:9,}", flush=True)
        total, differing = total + n, differing + bad
    print(f"{len(scenes)} scenes, {total:,} numbers: {differing:,} differ")
    sys.exit(1 if differing else 0)


main()
