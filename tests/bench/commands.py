# SPDX-License-Identifier: GPL-3.0-or-later
"""What whole commands cost a user: computing time of the process, from its start to its end, as CSV in milliseconds.

The first row starts a program that does nothing. The commands take turns, so that whatever slows the machine slows all of them."""

import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile

PROGRAM = os.path.abspath(os.environ.get("HOLONOM", "build/holonom"))
ROUNDS, FRAMES, CLASS = 9, 10, 100
METHOD = "index1@rk4:h=1e-3"
ANSWERS = {"seed": 3, "a": "0.2 mm", "b": "278 ms", "c": 0.01, "d": {"choice": "b", "reason": "b"}}


def cpu_milliseconds(words, home):
    """Measures one process and its children, once it has ended as it should."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(words, capture_output=True, env={**os.environ, "HOME": home, "XDG_CACHE_HOME": os.path.join(home, "cache")})
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        sys.exit(f"{' '.join(words)} ended with {done.returncode}: {done.stderr.decode()[-300:]}")
    return 1e3 * (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def make_class(folder):
    """A submission for each student; returns the path of one of them."""
    for k in range(CLASS):
        path = os.path.join(folder, f"student{k:03}.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(ANSWERS, file)
    return path


def commands(home):
    students = os.path.join(home, "class")
    os.mkdir(students)
    one = make_class(students)
    run = [PROGRAM, "run", "four-bar", "--method", METHOD]
    picture = [PROGRAM, "snapshot", "four-bar", "--method", METHOD, "--out", os.path.join(home, "frame.png")]
    film = [PROGRAM, "snapshot", "four-bar", "--method", METHOD, "--animate", "50", "--out", os.path.join(home, "film.png")]
    return {
        "a program that does nothing": ["/bin/true"],
        "start: version": [PROGRAM, "version"],
        "start: run of one step": [*run, "--time", "0.001"],
        "run of 10 s": [*run, "--time", "10"],
        "frame: one picture": [*picture, "--at", "0.04"],
        f"frame: {FRAMES} in one film": [*film, "--at", ",".join(str((k + 1) / 1000) for k in range(FRAMES))],
        "grade: one submission": [PROGRAM, "grade", "baumgarte", one],
        f"grade: a class of {CLASS}": [PROGRAM, "grade", "baumgarte", students],
    }


def main():
    with tempfile.TemporaryDirectory() as home:
        times = {name: (words, []) for name, words in commands(home).items()}
        for _ in range(ROUNDS + 1):  # the first round fills caches
            for words, seen in times.values():
                seen.append(cpu_milliseconds(words, home))
        first = None
        print("command,cpu_ms_median,cpu_ms_quartile_1,cpu_ms_quartile_3,times_a_program_that_does_nothing")
        for name, (_, seen) in times.items():
            low, middle, high = statistics.quantiles(seen[1:], n=4)
            first = first or middle
            print(f"{name},{middle:.2f},{low:.2f},{high:.2f},{middle / first:.1f}")


if __name__ == "__main__":
    main()
