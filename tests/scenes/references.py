#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The reference solution of every shipped scene, into lessons/NN-topic/references: `make references`.

    references.py PROGRAM

Two at once. Those that are current (the program itself says so) are left alone, so an interrupted run goes on where it
was; a file of a scene that is gone is removed. A chaotic motion ends where fewer than six digits are sure.
"""

import concurrent.futures
import glob
import json
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
AT_ONCE = 2


def place_of(scene):
    """lessons/NN-topic/scenes/ID.json -> lessons/NN-topic/references/ID.json"""
    folder, name = os.path.split(scene)
    return os.path.join(os.path.dirname(folder), "references", name)


def ask(program, *words):
    with tempfile.TemporaryDirectory() as cache:
        done = subprocess.run([program, "reference", *words, "--json"], capture_output=True, text=True, check=False,
                              env={**os.environ, "HOLONOM_CACHE": cache, "HOLONOM_HOME": ROOT})
    return done.returncode, json.loads(done.stdout) if done.stdout else {}


def is_current(program, name, path):
    return os.path.exists(path) and ask(program, name)[1].get("source") == "shipped"


def refresh(program, scene):
    name, path = os.path.basename(scene)[:-len(".json")], place_of(scene)
    if is_current(program, name, path):
        return name, "current"
    os.makedirs(os.path.dirname(path), exist_ok=True)
    status, answer = ask(program, name, "--recompute", "--hold", "--out", path)
    if status != 0:
        raise SystemExit(f"{name}: {answer.get('errors', status)}")
    return name, f"{answer['digits']:.1f} digits to t = {answer['time']:g} s"


def main(program):
    scenes = sorted(glob.glob(os.path.join(ROOT, "lessons", "*", "scenes", "*.json")))
    for path in glob.glob(os.path.join(ROOT, "lessons", "*", "references", "*.json")):
        if path not in map(place_of, scenes):
            os.remove(path)
    with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
        for name, told in pool.map(lambda scene: refresh(program, scene), scenes):
            print(f"{name:24} {told}", flush=True)


if __name__ == "__main__":
    main(os.path.abspath(sys.argv[1]))
