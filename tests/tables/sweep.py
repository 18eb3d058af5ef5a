# SPDX-License-Identifier: GPL-3.0-or-later
# usage: sweep.py PROGRAM [SCENE...]
# Every shipped scene over the ranges of its sliders, by every method that the scene suggests: which runs end early, and why.
#
# Settings of a scene: its own; each slider alone at its ends and in the middle (logarithmic where the range spans
# two decades); and RANDOM settings with all sliders at once. A setting whose loops cannot be closed is counted apart.
#
# A run that ends early is explained when
#   step           the same method ends later, or not at all, with a step SMALLER times as small
#   chart          the method keeps one set of coordinates for the whole run, and says that these no longer determine the rest
#   drift          an unstabilised method (index1) lets its loops open: at this speed rounding alone drives them apart
#   configuration  every other method ends there too, with a step SMALLER times as small: the mechanism cannot go on
# and unexplained otherwise. Prints a line for each scene, then one for each run that ended; exit status 1 if any is unexplained.
import json
import random
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

LONGEST = 2.0  # [s] of motion
TOO_LONG = 20  # [s] for one run
RANDOM = 3
SMALLER = 16
OTHERS = ("projection@rk4", "ggl@radau5", "nullspace@rk4")
REFUSED = 2  # exit status where the setting itself is at fault


def scenes(names):
    for path in sorted(Path("lessons").glob("*/scenes/*.json")):
        scene = json.loads(path.read_text())
        if not names or path.stem in names:
            yield path.stem, scene


def sliders(scene):
    for name, p in scene.get("parameters", {}).items():
        if isinstance(p, dict) and "min" in p and "max" in p:
            yield name, p


def between(p, share):
    low, high = p["min"], p["max"]
    if low > 0 and high / low > 100:
        value = low * (high / low) ** share
    else:
        value = low + share * (high - low)
    return round(value) if p.get("integer") else float(f"{value:.6g}")


def settings(name, scene):
    chance = random.Random(name)
    yield {}
    for slider, p in sliders(scene):
        for share in (0, 0.5, 1):
            yield {slider: between(p, share)}
    for _ in range(RANDOM):
        yield {slider: between(p, chance.random()) for slider, p in sliders(scene)}


def run(program, scene, setting, method, duration):
    words = [program, "run", scene, "--method", method, "--time", f"{duration:g}", "--every", f"{duration:g}", "--json"]
    for name, value in setting.items():
        words += ["--set", f"{name}={value:g}"]
    try:
        done = subprocess.run(words, capture_output=True, text=True, check=False, timeout=TOO_LONG)
    except subprocess.TimeoutExpired:
        return {"status": "slow", "reason": f"more than {TOO_LONG} s", "t_reached": 0.0}
    if done.returncode == REFUSED:
        return None
    return json.loads(done.stdout)


def finer(method, scene):
    if "rtol=" in method:
        return re.sub(r"rtol=([0-9.e+-]+)", lambda m: f"rtol={float(m[1]) / 1e3:g}", method)
    return re.sub(r"([:,])h=([0-9.e+-]+)", lambda m: f"{m[1]}h={float(m[2]) / SMALLER:g}", method)


def explain(program, name, scene, setting, method, duration, told):
    """step, chart, drift, configuration, or UNEXPLAINED"""
    if told["status"] == "chart-lost" and method.startswith("reduced"):
        return "chart"
    reached = told["t_reached"]
    again = run(program, name, setting, finer(method, scene), duration)
    if again and (again["status"] == "ok" or again["t_reached"] > 1.2 * reached + 1e-9):
        return "step"
    if method.startswith("index1") and told["status"] == "diverged":
        return "drift"
    step = scene["step"] if isinstance(scene.get("step"), float) else duration / 2000
    step /= SMALLER
    for other in OTHERS:
        how = "rtol=1e-9" if other.endswith("radau5") else f"h={step:g}"
        further = run(program, name, setting, f"{other}:{how}", duration)
        if further and (further["status"] == "ok" or further["t_reached"] > 1.05 * reached + 0.02):
            return "UNEXPLAINED"
    return "configuration"


def sweep(program, name, scene):
    duration = min(scene.get("duration", LONGEST), LONGEST)
    counts = {"settings": 0, "open": 0, "runs": 0}
    ended = []
    for setting in settings(name, scene):
        counts["settings"] += 1
        if run(program, name, setting, scene["methods"][0], 1e-9) is None:
            counts["open"] += 1
            continue
        for method in scene["methods"]:
            counts["runs"] += 1
            told = run(program, name, setting, method, duration)
            if told["status"] != "ok":
                why = explain(program, name, scene, setting, method, duration, told)
                given = " ".join(f"{k}={v:g}" for k, v in setting.items()) or "as it is"
                ended.append((why, f"  {why:13} {name} {given}: {method} {told['status']} {told['reason']}"))
    return name, counts, ended


def main():
    program = sys.argv[1]
    tasks = list(scenes(sys.argv[2:]))
    kinds = ("step", "chart", "drift", "configuration", "UNEXPLAINED")
    print(f"Every shipped scene over its sliders, by the methods that it suggests, {LONGEST:g} s or the scene's time where shorter\n")
    print("scene                   settings  cannot close  runs  ended:  step  chart  drift  configuration  unexplained")
    ends = []
    with ThreadPoolExecutor(2) as pool:
        for name, counts, ended in pool.map(lambda task: sweep(program, *task), tasks):
            n = [sum(1 for why, _ in ended if why == kind) for kind in kinds]
            print(
                f"{name:23} {counts['settings']:8} {counts['open']:13} {counts['runs']:5} {len(ended):6}"
                f" {n[0]:6} {n[1]:6} {n[2]:6} {n[3]:14} {n[4]:12}",
                flush=True,
            )
            ends += ended
    print("\nruns that ended early")
    for _, line in ends:
        print(line)
    return 1 if any(why == "UNEXPLAINED" for why, _ in ends) else 0


if __name__ == "__main__":
    sys.exit(main())
