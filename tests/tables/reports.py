#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which predictions of a singular configuration came true: every shipped scene and random four-bars.

usage: reports.py PROGRAM [N]    N random four-bars (200); prints the table that tests/tables/reports.txt keeps

A prediction (rank-ahead) came true when the run reports a singular configuration (near-singular, rank-loss) at its time within
0.05 s or a quarter of the lead, or ends there; it is withdrawn when the run itself says so. An event nobody announced is a
singular configuration later than 0.3 s after the start without a prediction for it.
"""
import json
import random
import subprocess
import sys

PROGRAM, N = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 200
EVENTS = ("near-singular", "rank-loss")


def run(scene, step, time, sets=()):
    args = [PROGRAM, "run", scene, "--method", f"projection@rk4:h={step:g}", "--time", f"{time:g}", "--every", f"{time:g}", "--json"]
    for s in sets:
        args += ["--set", s]
    done = subprocess.run(args, capture_output=True, text=True, timeout=300)
    try:
        document = json.loads(done.stdout)
    except ValueError:
        return None
    return document if "incidents" in document else None  # lengths that do not close make no run


def judge(document):
    """(true, false, withdrawn, unannounced, lead times of the true ones)"""
    told = document["incidents"]
    events = [i["t"] for i in told if i["code"] in EVENTS and i["t"] > 0]
    if document["status"] != "ok":
        events.append(document["t_reached"])
    right, wrong, withdrawn, met, leads = 0, 0, 0, set(), []
    for i in told:
        if i["code"] != "rank-ahead":
            continue
        when = i["t"] + i["value"]
        near = [e for e in events if abs(e - when) < max(0.05, 0.25 * i["value"])]
        beyond = when > document["t_reached"]
        withdrawn += "withdrawn" in i["message"]
        if near:
            right += 1
            met.update(near)
            leads.append(i["value"])
        elif not beyond:
            wrong += 1
    alone = [e for e in events if e not in met and e > 0.3]
    return right, wrong, withdrawn, len(alone), leads


def main():
    scenes = json.loads(subprocess.run([PROGRAM, "list", "scenes", "--json"], capture_output=True, text=True).stdout)["scenes"]
    total, leads = [0, 0, 0, 0], []
    print(f"{'scene':26} came true  did not  withdrawn  unannounced")

    def add(name, document):
        *row, more = judge(document)
        leads.extend(more)
        for k in range(4):
            total[k] += row[k]
        if name and any(row):
            print(f"{name:26} {row[0]:9} {row[1]:8} {row[2]:10} {row[3]:12}")
        return row

    for scene in scenes:
        document = run(scene["id"], scene.get("step", 0.01) or 0.01, min(scene.get("duration", 10) or 10, 10))
        if document:
            add(scene["id"], document)
    shipped = list(total)
    draw, made = random.Random(1), 0
    while made < N:
        sets = [f"l2={draw.uniform(0.5, 2):.4f}", f"l3={draw.uniform(0.5, 2):.4f}"]
        document = run("four-bar", 0.01, 4, sets)
        if document:
            made += 1
            add(None, document)
    rest = [total[k] - shipped[k] for k in range(4)]
    print(f"{f'{N} random four-bars':26} {rest[0]:9} {rest[1]:8} {rest[2]:10} {rest[3]:12}")
    print(f"{'all':26} {total[0]:9} {total[1]:8} {total[2]:10} {total[3]:12}")
    said = total[0] + total[1]
    if said:
        print(f"\n{total[0]} of {said} predictions came true; the shortest lead of those was {min(leads, default=0):.3g} s")


main()
