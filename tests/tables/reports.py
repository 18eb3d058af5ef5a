#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Counts the reports that are right: every shipped scene, and random mechanisms of ten of them.

usage: reports.py PROGRAM [N]    N random mechanisms (200); prints the table that tests/tables/reports.txt keeps

Each mechanism runs by projection, index1, nullspace, penalty and udwadia-kalaba with its own step of rk4, and by
projection@dopri5. Its reports are judged by other runs:

  rank-ahead   a prediction: came true when the run reports a configuration that is singular or nearly so (near-singular,
               rank-loss), or ends, at the time that was predicted, within 0.05 s or a quarter of the lead. Predictions for
               times after the end of the run are not judged.
  branch-flip  right when the state a little later is more than FAR off the same motion computed at rtol 1e-10 from the
               start, or when that motion cannot be computed; a run that has been reported once is not judged again
  stiff        right when an implicit method of the same tolerance needs less than half the steps
  chart-lost   by nullspace@rk4: right when the motion is singular there, when the run had left its motion before, or when
               partitioning and projection end there too
  energy       energy-drift and energy-jump, also of a run by index1@rk4: right when the state of the run is more than SLIGHT off
               the same motion computed at rtol 1e-10, at the report or at the end; of a run the first report is judged
  multipliers  multipliers-grow, by penalty and udwadia-kalaba: right when the run meets a configuration that is singular or
               nearly so within 0.05 s of it, or stands at one

An event that no report announced is a singular configuration, or one nearly so, later than 0.3 s after the start without a
prediction. A prediction is early when it comes 0.2 s before the event, or a quarter of the time 2 pi / |fastest rate|.
"""
import json
import math
import os
import random
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from bounded import run_bounded

EVENTS = ("near-singular", "rank-loss")
NEARLY = 0.1  # of the rows' volume at the start
FAR, SLIGHT = 0.05, 0.01  # of the size of a state
KINDS = ("rank-ahead", "branch-flip", "stiff", "chart-lost", "energy", "multipliers")
ENERGY = ("energy-drift", "energy-jump")
FAMILIES = ("four-bar", "five-bar", "slider-crank", "watt-six-bar", "stephenson-six-bar", "quick-return", "double-rocker",
            "rssr", "spatial-slider-crank", "oblique-four-bar")
LONGEST = 4.0  # [s] of motion of a random mechanism
TOO_DEAR = 120  # [s] of computing time for one run


def run(program, scene, method, time, sets=(), at=None):
    """the document of a run; None where the loops of the setting do not close, or it takes too much computing time"""
    args = [program, "run", scene, "--no-native", "--method", method, "--time", f"{time:.9g}", "--at", f"{at or time:.9g}", "--json"]
    for s in sets:
        args += ["--set", s]
    done = run_bounded(args, TOO_DEAR)
    try:
        document = json.loads(done.stdout) if done else {}
    except ValueError:
        return None
    return document if "incidents" in document else None


def state(document):
    samples = document["samples"]
    return samples["q"][-1] + samples["v"][-1] if samples["t"] else None


def is_off(program, scene, method, t, sets, much=FAR):
    """whether the run is off its motion at t by more than this share of the state's size"""
    here, exact = run(program, scene, method, t, sets), run(program, scene, "projection@dop853:rtol=1e-10", t, sets)
    if not here or not exact or exact["status"] != "ok" or not here["samples"]["t"]:
        return True
    a, b = state(here), state(exact)
    size = 1 + math.sqrt(sum(x * x for x in b))
    return math.sqrt(sum((x - y) ** 2 for x, y in zip(a, b))) > much * size


def is_early(lead, document):
    rates = [abs(x) for row in document["samples"]["v"] for x in row]
    return lead >= 0.2 or (rates and lead >= 0.25 * 2 * math.pi / max(1e-9, max(rates)))


class Table:
    def __init__(self):
        self.right = dict.fromkeys(KINDS, 0)
        self.wrong = dict.fromkeys(KINDS, 0)
        self.withdrawn = self.unannounced = self.early = self.runs = 0
        self.notes = []

    def add(self, other):
        for kind in KINDS:
            self.right[kind] += other.right[kind]
            self.wrong[kind] += other.wrong[kind]
        self.withdrawn += other.withdrawn
        self.unannounced += other.unannounced
        self.early += other.early
        self.runs += other.runs
        self.notes += other.notes

    def row(self, name):
        cells = "".join(f"{self.right[kind]:7}{self.wrong[kind]:6}" for kind in KINDS)
        return f"{name:26}{self.runs:5}{cells}{self.withdrawn:11}{self.unannounced:13}{self.early:7}"


def judge_ahead(table, name, document):
    told = document["incidents"]
    events = [i["t"] for i in told if i["code"] in EVENTS and i["t"] > 0]
    ends = [document["t_reached"]] if document["status"] != "ok" else []
    met = set()
    for i in told:
        if i["code"] != "rank-ahead":
            continue
        when, lead = i["t"] + i["value"], i["value"]
        near = [e for e in events + ends if abs(e - when) < max(0.05, 0.25 * lead)]
        table.withdrawn += "withdrawn" in i["message"]
        if near:
            table.right["rank-ahead"] += 1
            table.early += is_early(lead, document)
            met.update(near)
        elif when <= document["t_reached"]:
            table.wrong["rank-ahead"] += 1
            table.notes.append(f"rank-ahead, {name}: {i['message']}")
    for e in sorted(set(events) - met):
        if e > 0.3:
            table.unannounced += 1
            table.notes.append(f"unannounced, {name}: t = {e:.4g} s")


def judge_branch(table, program, name, scene, document, sets):
    flips = [i for i in document["incidents"] if i["code"] == "branch-flip"]
    if not flips:
        return
    later = min(flips[0]["t"] + 0.05, document["t_reached"])
    right = is_off(program, scene, document["method"], later, sets)
    (table.right if right else table.wrong)["branch-flip"] += 1
    if not right:
        table.notes.append(f"branch-flip, {name}: {document['method']} {flips[0]['t']:.4g} s: {flips[0]['message']}")


def judge_stiff(table, program, name, scene, document, sets, time):
    if not any(i["code"] == "stiff" for i in document["incidents"]):
        return
    implicit = run(program, scene, "ggl@radau5:rtol=1e-6", time, sets)
    right = implicit and implicit["status"] == "ok" and 2 * implicit["cost"]["steps"] < document["cost"]["steps"]
    (table.right if right else table.wrong)["stiff"] += 1
    if not right:
        steps = implicit["cost"]["steps"] if implicit else "no"
        table.notes.append(f"stiff, {name}: {document['cost']['steps']} steps, and {steps} of the implicit method")


def judge_chart(table, program, name, scene, document, sets, step):
    if document["status"] != "chart-lost":
        return
    end = document["t_reached"]
    singular = "singular" in document["reason"] or any(abs(i["t"] - end) < 0.01 for i in document["incidents"] if i["code"] in EVENTS)
    others = [run(program, scene, f"{f}@rk4:h={step:g}", end + 20 * step, sets) for f in ("partitioning", "projection")]
    lost = end > 0 and is_off(program, scene, document["method"], end, sets)
    right = singular or lost or all(not o or o["status"] != "ok" for o in others)
    (table.right if right else table.wrong)["chart-lost"] += 1
    if not right:
        table.notes.append(f"chart-lost, {name}: {document['reason']}")


def judge_energy(table, program, name, scene, document, sets):
    told = [i for i in document["incidents"] if i["code"] in ENERGY]
    if not told:
        return
    times = sorted({told[0]["t"], document["t_reached"]} - {0.0})
    right = any(is_off(program, scene, document["method"], t, sets, SLIGHT) for t in times)
    (table.right if right else table.wrong)["energy"] += 1
    if not right:
        table.notes.append(f"energy, {name}: {document['method']} {told[0]['t']:.4g} s: {told[0]['message']}")


def volume(J):
    """of the box that the rows of J span: 0 where they are dependent, or one vanishes"""
    rows, box = [list(row) for row in J], 1
    for k, row in enumerate(rows):
        size = math.sqrt(sum(x * x for x in row))
        box *= size
        if size > 0:
            unit = [x / size for x in row]
            for other in range(k + 1, len(rows)):
                along = sum(x * y for x, y in zip(unit, rows[other]))
                rows[other] = [y - along * x for x, y in zip(unit, rows[other])]
    return box


def jacobian(program, scene, sets, q=()):
    args = [program, "terms", scene, "--no-native", "--json"]
    for s in sets:
        args += ["--set", s]
    done = run_bounded(args + (["--q", *q] if q else []), TOO_DEAR)
    return json.loads(done.stdout)["J"] if done and done.returncode == 0 else None


def is_near_singular(program, scene, method, t, sets):
    """whether the rows of J at the run's own configuration are nearly dependent, beside those of the start: an event is listed
    three times of a kind, and not at all where the run ends or leaves its motion before it"""
    here = run(program, scene, method, t, sets)
    if not here or not here["samples"]["q"]:
        return False
    q = [f"{name}={x!r}" for name, x in zip(here["coordinates"], here["samples"]["q"][-1])]
    start, there = jacobian(program, scene, sets), jacobian(program, scene, sets, q)
    return bool(start and there) and volume(there) < NEARLY * volume(start)


def judge_multipliers(table, program, name, scene, document, sets):
    events = [i["t"] for i in document["incidents"] if i["code"] in EVENTS and i["t"] > 0]
    for i in document["incidents"]:
        if i["code"] != "multipliers-grow":
            continue
        right = any(abs(e - i["t"]) < 0.05 for e in events) or is_near_singular(program, scene, document["method"], i["t"], sets)
        (table.right if right else table.wrong)["multipliers"] += 1
        if not right:
            table.notes.append(f"multipliers, {name}: {document['method']} {i['t']:.4g} s: {i['message']}")


def judge(program, name, scene, step, time, sets=()):
    table = Table()
    fixed = run(program, scene, f"projection@rk4:h={step:g}", time, sets)
    if not fixed:
        return None
    table.runs += 1
    judge_ahead(table, name, fixed)
    judge_branch(table, program, name, scene, fixed, sets)
    judge_energy(table, program, name, scene, fixed, sets)
    open_loops = run(program, scene, f"index1@rk4:h={step:g}", time, sets)
    if open_loops:
        table.runs += 1
        judge_energy(table, program, name, scene, open_loops, sets)
    for loads in ("penalty", "udwadia-kalaba"):
        document = run(program, scene, f"{loads}@rk4:h={step:g}", time, sets)
        if document:
            table.runs += 1
            judge_branch(table, program, name, scene, document, sets)
            judge_energy(table, program, name, scene, document, sets)
            judge_multipliers(table, program, name, scene, document, sets)
    for other in ("projection@dopri5:rtol=1e-6", f"nullspace@rk4:h={step:g}"):
        document = run(program, scene, other, time, sets)
        if document:
            table.runs += 1
            judge_branch(table, program, name, scene, document, sets)
            judge_stiff(table, program, name, scene, document, sets, time)
            judge_chart(table, program, name, scene, document, sets, step)
            judge_energy(table, program, name, scene, document, sets)
    return table


def draw(rng, scene):
    sets = []
    for slider, p in scene["parameters"].items():
        if isinstance(p, dict) and "min" in p and rng.random() < 0.5:
            low, high = p["min"], p["max"]
            wide = low > 0 and high / low > 100
            value = low * (high / low) ** rng.random() if wide else low + (high - low) * rng.random()
            sets.append(f"{slider}={value:.4g}")
    return tuple(sets)


def main():
    os.nice(10)
    program, n = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 200
    scenes = {path.stem: json.loads(path.read_text()) for path in sorted(Path("lessons").glob("*/scenes/*.json"))}
    listed = json.loads(subprocess.run([program, "list", "scenes", "--json"], capture_output=True, text=True, check=True).stdout)["scenes"]
    steps = {s["id"]: s.get("step") or 0.01 for s in listed}
    rng = random.Random(1)
    chances = [(FAMILIES[k % len(FAMILIES)], draw(rng, scenes[FAMILIES[k % len(FAMILIES)]])) for k in range(4 * n)]

    def shipped(name):
        return judge(program, name, name, steps[name], min(scenes[name].get("duration", 10), 10))

    def chance(task):
        scene, sets = task
        return judge(program, f"{scene} {' '.join(sets)}", scene, steps[scene], LONGEST, sets)

    print("which reports are right: of each kind the reports that were right and that were not")
    heads = "".join(f"{kind:>13}" for kind in KINDS)
    print(f"{'mechanism':26} runs{heads}  withdrawn  unannounced  early")
    total, by_family, made = Table(), {f: Table() for f in FAMILIES}, 0
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for name, table in zip(scenes, pool.map(shipped, scenes)):
            if table:
                total.add(table)
                print(table.row(name), flush=True)
        while made < n and chances:
            batch, chances = chances[: n - made], chances[n - made :]
            for (scene, _), table in zip(batch, pool.map(chance, batch)):
                if table:
                    made += 1
                    by_family[scene].add(table)
    for family, table in by_family.items():
        total.add(table)
        print(table.row(f"random {family}"))
    print(total.row("all"))

    right, wrong = sum(total.right.values()), sum(total.wrong.values())
    print(f"\n{right} of {right + wrong} reports were right ({100 * right / max(1, right + wrong):.1f} %); {total.early} of {total.right['rank-ahead']} predictions that came true were early")
    print("\n".join(["", "reports that were not right, and events that none announced", *(f"  {note}" for note in total.notes)]))


if __name__ == "__main__":
    main()
