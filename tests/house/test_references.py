# SPDX-License-Identifier: GPL-3.0-or-later
"""Every shipped scene has its reference solution, current and shipped whole; three of them computed anew. Speaks TAP."""

import glob
import json
import os
import subprocess
import sys
import tempfile

PROGRAM = os.path.abspath(os.environ.get("HOLONOM", "build/holonom"))
MOST_BYTES = 2_000_000
LEAST_DIGITS = 6
QUICK = ["fb0-lagrangian", "seven-body-squeezer", "heavy-top"]


def reference(name, *words):
    with tempfile.TemporaryDirectory() as cache:
        done = subprocess.run([PROGRAM, "reference", name, "--json", *words], capture_output=True, text=True, check=False,
                              env={**os.environ, "HOLONOM_CACHE": cache})
    return json.loads(done.stdout)


def names():
    return sorted(os.path.basename(path).removesuffix(".json") for path in glob.glob("lessons/*/scenes/*.json"))


def not_current():
    faults = []
    for name in names():
        paths = glob.glob(f"lessons/*/references/{name}.json")
        with open(paths[0], encoding="utf-8") if paths else open(os.devnull, encoding="utf-8") as f:
            stored = json.loads(f.read() or "{}")
        # a budget in which nothing can be computed: what comes was stored
        answer = reference(name, "--time-limit", "0.001") if paths else {}
        if answer.get("source") != "shipped":
            faults.append(f"{name}: {'not of this scene any more' if paths else 'missing'}; `make references` computes them")
        elif answer["digits"] < LEAST_DIGITS or stored["T"] != answer["time"]:
            faults.append(f"{name}: {answer['digits']:.1f} digits to {answer['time']} s")
    return faults


def too_short():
    """Ends before the scene does only where the motion is chaotic: digits fall towards the end."""
    faults = []
    for name in names():
        answer = reference(name, "--time-limit", "0.001")
        digits = answer.get("digits_at", [0])
        if answer.get("time", 0) < answer.get("duration", 1) and not digits[-1] < digits[0] - 4:
            faults.append(f"{name}: ends at {answer.get('time')} s with {digits[-1]:.1f} digits")
    return faults


def too_large():
    size = sum(os.path.getsize(path) for path in glob.glob("lessons/*/references/*.json"))
    return [f"{size} bytes"] if size > MOST_BYTES else []


def gone():
    return [path for path in glob.glob("lessons/*/references/*") if os.path.basename(path).removesuffix(".json") not in names()]


def not_reproduced():
    """Both computations again: each entry within what the two differed by, and a unit in the last place or two."""
    faults = []
    for name in QUICK:
        stored, again = reference(name), reference(name, "--recompute")
        if again["source"] != "computed":
            faults.append(f"{name}: not computed")
        allowed = 2 * max(stored["error"]["q"], again["error"]["q"])
        lengths = max(1, stored["scales"]["length"])
        worst = max(abs(a - b) for x, y in zip(stored["q"], again["q"]) for a, b in zip(x, y))
        if not worst <= allowed * lengths:
            faults.append(f"{name}: {worst} from what is shipped, {allowed} allowed")
    return faults


def main():
    tests = [("every scene has its reference solution, of its present meaning, with six digits and more", not_current),
             ("a reference that ends before its scene does so because digits are lost", too_short),
             ("references take less than two million bytes", too_large),
             ("no reference is left of a scene that is gone", gone),
             ("three of them come out the same when computed anew", not_reproduced)]
    failed = 0
    for number, (fact, check) in enumerate(tests, 1):
        faults = check()
        for fault in faults:
            print(f"# {fault}")
        print(f"{'not ok' if faults else 'ok'} {number} - {fact}")
        failed += bool(faults)
    print(f"1..{len(tests)}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
