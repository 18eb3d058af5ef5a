# SPDX-License-Identifier: GPL-3.0-or-later
"""Every shipped scene over the ranges of its sliders, by every method that it suggests: which runs end early, and why.

usage: sweep.py PROGRAM [SCENE...]   (make sweep keeps the table in tests/tables/sweep.txt)

Settings of a scene: its own; each slider alone at its ends and in the middle (logarithmic where the range spans two
decades); corners, every slider at one of its ends; and random settings with all sliders at once. A setting whose loops
cannot be closed is counted apart. A sweep that was broken off goes on where it was: build/sweep.jsonl holds what this
very program has done.

A run that ends early is explained when
  step           the same method ends later, or not at all, with a step 16 or 256 times as small, or with steps
                 chosen by dop853 at rtol=1e-10
  chart          the method keeps one set of coordinates for the whole run, and says that these no longer determine the rest
  drift          an unstabilised method (index1) lets its loops open: at this speed rounding alone drives them apart
  configuration  every other method ends there too, with a step 16 times as small: the mechanism cannot go on
  singular       the method does not close the loops, or needs independent coordinates, and the run reported a singular
                 configuration where it ended
  dear           it takes more than TOO_DEAR s of computing time, or the runs that could explain its end do: not judged. Time of the
                 processor counts, so other programs on the machine change nothing; a slow machine leaves more runs unjudged
and unexplained otherwise. Prints a line for each scene, then one for each run that ended; exit status 1 if any is unexplained.
"""

import hashlib
import json
import os
import random
import re
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Lock

from bounded import run_bounded

LONGEST = 1.0  # [s] of motion
LONGEST_OF_MANY = 0.1  # [s] where a slider counts loops or links,
MOST_OF_MANY = 20  # [s] and no more than this over their number: steps times loops bound the work, on any machine
TOO_DEAR = 120  # [s] of computing time for one run
CORNERS = 4
RANDOM = 4
LIMITS = [LONGEST, LONGEST_OF_MANY, MOST_OF_MANY, TOO_DEAR, CORNERS, RANDOM]  # results of others do not serve
SMALLER = (16, 256)
OTHERS = ("projection@rk4", "ggl@radau5", "nullspace@rk4")
OPEN_OR_CHART = ("index1", "baumgarte", "nullspace", "partitioning", "reduced")
REFUSED = 2  # exit status where the setting itself is at fault
KINDS = ("step", "chart", "singular", "drift", "configuration", "dear", "UNEXPLAINED")
DONE = Path("build/sweep.jsonl")


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
    for _ in range(CORNERS):
        yield {slider: between(p, chance.randrange(2)) for slider, p in sliders(scene)}
    for _ in range(RANDOM):
        yield {slider: between(p, chance.random()) for slider, p in sliders(scene)}


def run(program, scene, setting, method, duration):
    words = [program, "run", scene, "--no-native", "--method", method, "--time", f"{duration:g}", "--every", f"{duration:g}", "--json"]
    for name, value in setting.items():
        words += ["--set", f"{name}={value:g}"]
    done = run_bounded(words, TOO_DEAR)
    if done is None:
        return {"status": "dear", "reason": f"more than {TOO_DEAR} s of computing time", "t_reached": 0.0}
    if done.returncode == REFUSED:
        return None
    return json.loads(done.stdout)


def finer(method, times):
    if "rtol=" in method:
        return re.sub(r"rtol=([0-9.e+-]+)", lambda m: f"rtol={float(m[1]) / times:g}", method)
    return re.sub(r"([:,])h=([0-9.e+-]+)", lambda m: f"{m[1]}h={float(m[2]) / times:g}", method)


def is_at_singular(told):
    """whether the run named a singular configuration at its end: in its reason, as an event, or as a prediction"""
    times = [i["t"] for i in told.get("incidents", []) if i["code"] in ("near-singular", "rank-loss")]
    times += [i["t"] + i["value"] for i in told.get("incidents", []) if i["code"] == "rank-ahead"]
    reason = told["reason"].replace("singular value", "")  # how far from singular it was
    return "singular" in reason or any(abs(t - told["t_reached"]) <= 0.02 * told["t_reached"] for t in times)


def explain(program, name, scene, setting, method, duration, told):
    """one of KINDS"""
    if told["status"] == "dear":
        return "dear"
    if told["status"] == "chart-lost" and method.startswith("reduced"):
        return "chart"
    reached = told["t_reached"]
    further = min(duration, 1.25 * reached + 0.02)  # a short way past the end is enough
    dear = False
    for smaller in [*(finer(method, times) for times in SMALLER), method.split("@")[0] + "@dop853:rtol=1e-10"]:
        again = run(program, name, setting, smaller, further)
        dear |= bool(again) and again["status"] == "dear"
        if again and (again["status"] == "ok" or again["t_reached"] > 1.2 * reached + 1e-9):
            return "step"
    if method.startswith(OPEN_OR_CHART) and is_at_singular(told):
        return "singular"
    if method.startswith("index1") and told["status"] == "diverged":
        return "drift"
    step = scene["step"] if isinstance(scene.get("step"), float) else duration / 2000
    step /= SMALLER[0]
    for other in OTHERS:
        how = "rtol=1e-9" if other.endswith("radau5") else f"h={step:g}"
        beyond = run(program, name, setting, f"{other}:{how}", further)
        dear |= bool(beyond) and beyond["status"] == "dear"
        if beyond and (beyond["status"] == "ok" or beyond["t_reached"] > 1.05 * reached + 0.02):
            return "dear" if dear else "UNEXPLAINED"
    return "dear" if dear else "configuration"


def sweep(program, name, scene, setting):
    """what came of one setting: "open" where its loops cannot be closed, else the runs that ended"""
    counts = [setting.get(slider, p["value"]) for slider, p in sliders(scene) if p.get("integer")]
    longest = min(LONGEST_OF_MANY, MOST_OF_MANY / max(counts)) if counts else LONGEST
    duration = min(scene.get("duration", LONGEST), longest)
    if run(program, name, setting, scene["methods"][0], 1e-9) is None:
        return {"open": 1, "runs": 0, "ended": []}
    ended = []
    for method in scene["methods"]:
        told = run(program, name, setting, method, duration)
        if told["status"] != "ok":
            why = explain(program, name, scene, setting, method, duration, told)
            given = " ".join(f"{k}={v:g}" for k, v in setting.items()) or "as it is"
            ended.append((why, f"{name} {given}: {method} {told['status']} {told['reason']}"))
    return {"open": 0, "runs": len(scene["methods"]), "ended": ended}


def sweep_all(program, tasks):
    """the results by (scene, number of its setting); those of this very program that are kept already are read"""
    with open(program, "rb") as binary:
        version = hashlib.sha256(binary.read()).hexdigest()[:16]
    kept = [json.loads(line) for line in DONE.read_text().splitlines()] if DONE.exists() else []
    kept = [one for one in kept if one["version"] == version and one["limits"] == LIMITS]
    DONE.write_text("".join(json.dumps(one) + "\n" for one in kept))
    results = {tuple(one["key"]): one["result"] for one in kept}
    lock = Lock()

    def work(key, scene, setting):
        if key in results:
            return
        result = sweep(program, key[0], scene, setting)
        with lock, DONE.open("a") as file:
            results[key] = result
            file.write(json.dumps({"version": version, "limits": LIMITS, "key": key, "result": result}) + "\n")

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(lambda task: work(*task), tasks))
    return results


def main():
    os.nice(10)
    program = sys.argv[1]
    all_scenes = list(scenes(sys.argv[2:]))
    tasks = [((name, n), scene, setting) for name, scene in all_scenes for n, setting in enumerate(settings(name, scene))]
    results = sweep_all(program, tasks)

    print(f"# every shipped scene over its sliders, by the methods that it suggests, {LONGEST:g} s or the scene's time where shorter")
    print("scene                   settings  cannot close  runs  ended:  step  chart  singular  drift  configuration  dear  unexplained")
    ends, total = [], [0] * 11
    for name, _ in all_scenes + [("all", None)]:
        mine = [result for key, result in results.items() if key[0] == name]
        ended = [one for result in mine for one in result["ended"]]
        row = [len(mine), sum(r["open"] for r in mine), sum(r["runs"] for r in mine), len(ended)]
        row += [sum(1 for why, _ in ended if why == kind) for kind in KINDS]
        row = total if name == "all" else row
        print(f"{name:23} {row[0]:8} {row[1]:13} {row[2]:5} {row[3]:6} {row[4]:6} {row[5]:6} {row[6]:9} {row[7]:6} {row[8]:14} {row[9]:5} {row[10]:12}")
        total = [a + b for a, b in zip(total, row)]
        ends += sorted(ended, key=lambda end: end[1])
    print("\nruns that ended early")
    for why, line in ends:
        print(f"  {why:13} {line}")
    return 1 if any(why == "UNEXPLAINED" for why, _ in ends) else 0


if __name__ == "__main__":
    sys.exit(main())
