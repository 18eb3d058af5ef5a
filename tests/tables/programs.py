# SPDX-License-Identifier: GPL-3.0-or-later
"""A class of 1,000 formulas and one of 200 programs: how fast, and whether ten kills lose anything; and every hostile program with its line.

usage: programs.py PROGRAM
"""

import concurrent.futures
import fcntl
import json
import os
import random
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import threading
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "cli"))
PROGRAM = os.path.abspath(sys.argv[1])
os.environ["HOLONOM"] = PROGRAM
import test_filled  # noqa: E402
import test_programs  # noqa: E402

F_SETPIPE_SZ = 1031
KILLS = 10


def formulas(folder):
    with open(os.path.join(HERE, "..", "..", "lessons", "01-closed-loops", "answers", "p3.json"), encoding="utf-8") as f:
        right = f.read()
    chance = random.Random(1)
    for k in range(1000):
        text = chance.choice((right, right.replace('"-l1*sin(th1)"', '"l1*sin(th1)"'), "{}", "no JSON", right.replace("sin", "cos")))
        with open(os.path.join(folder, f"student{k:04d}.json"), "w", encoding="utf-8") as f:
            f.write(text)


def programs(folder):
    blank, filled = test_filled.blank_and_filled("four-bar", "c")
    bad = ["import sys; sys.exit(3)\n", "raise ValueError('no')\n", "import os\nwhile True: os.write(1, b'x' * 65536)\n"]
    for k in range(200):
        text, ending = (bad[k // 20 % 3], "py") if k % 20 == 19 else (blank if k % 5 == 4 else filled.replace("m1*l1*l1", "m1*l1*l4") if k % 7 == 6 else filled, "c")
        with open(os.path.join(folder, f"student{k:04d}.{ending}"), "w", encoding="utf-8") as f:
            f.write(text)


def kill_in_the_middle(words):
    """Starts a run whose lines nobody reads beyond one page, and kills it when the page is full; False: it had ended."""
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    page = fcntl.fcntl(process.stdout, F_SETPIPE_SZ, 4096)
    begun, waiting = time.monotonic(), 0
    # a part of the page for a small class: ten kills must fit into it
    while process.poll() is None and waiting < (500 if "four-bar" in words else page - 500) and time.monotonic() < begun + 300:
        waiting = struct.unpack("i", fcntl.ioctl(process.stdout, termios.FIONREAD, b"0000"))[0]
        time.sleep(0.001)
    alive = process.poll() is None
    process.send_signal(signal.SIGKILL)
    process.wait()
    process.stdout.close()
    return alive


def grade_class(name, identity, fill):
    with tempfile.TemporaryDirectory() as at:
        folder, out = os.path.join(at, "handed in"), os.path.join(at, "scores.ndjson")
        os.mkdir(folder)
        fill(folder)
        words = [PROGRAM, "grade", identity, folder, "--jobs", "2", "--out", out]
        begun = time.monotonic()
        subprocess.run(words, check=True, capture_output=True)
        seconds = time.monotonic() - begun
        with open(out, "rb") as f:
            calm = f.read()
        os.remove(out)
        assert not os.path.exists(out + ".part")  # a finished class leaves none
        killed = sum(kill_in_the_middle(words) for _ in range(KILLS))
        subprocess.run(words, check=True, capture_output=True)
        with open(out, "rb") as f:
            again = f.read()
        students = [json.loads(line)["student"] for line in again.splitlines()]
        lost, twice = len(os.listdir(folder)) - len(set(students)), len(students) - len(set(students))
        kinds = [json.loads(line)["status"] for line in calm.splitlines()]
    print(f"{name:22} {len(kinds):5} {kinds.count('graded'):7} {kinds.count('ungradable'):10} {seconds:8.1f} {len(kinds) / seconds:8.1f}  "
          f"{killed:5} {lost:5} {twice:6}  {'the same' if calm == again else 'OTHER BYTES'}")
    return lost or twice or calm != again or killed < KILLS


def listing(*folders):
    return sorted(os.path.join(at, name) for folder in folders for at, _, names in os.walk(folder) for name in names)


def available():
    """Memory of the machine that is not in use [MB]."""
    with open("/proc/meminfo", encoding="ascii") as f:
        return next(int(line.split()[1]) // 1024 for line in f if line.startswith("MemAvailable"))


def hostile():
    kinds = {**test_programs.HOSTILE, **({} if test_programs.TROUBLE else test_programs.CONFINED)}
    case = test_programs.OneFile()
    outside = (os.path.expanduser("~"), "/usr/local", "/var/tmp", "/dev/shm")
    before, begun, highest = listing(*outside), time.monotonic(), 0.0

    # two programs may have 768 MB each
    done_at, taken = threading.Event(), [0]
    free = available()

    def watch():
        while not done_at.wait(0.1):
            taken[0] = max(taken[0], free - available())

    watcher = threading.Thread(target=watch)
    watcher.start()

    def run(name):
        hangs = (kinds[name][1] or "").startswith("did not answer")
        with tempfile.TemporaryDirectory() as folder:
            done = case.run_program(kinds[name][0] + "\n", "--answer-time", "0.5" if hangs else "60", folder=folder)
            return done, sorted(os.listdir(folder))

    print("\nWhat each of the hostile programs got as its line")
    bad = 0
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for name, (done, left) in zip(kinds, pool.map(run, kinds)):
            lines = [line for line in " ".join(done.stderr.split()).split("holonom: ") if "program:" in line or "mine.py" in line]
            bad += left != ["mine.py"] or "program is at fault" in done.stderr
            print(f"  {name:32} {(lines[0] if lines else 'finished').strip()[:150]}")
            highest = max(highest, os.getloadavg()[0])
    after = listing(*outside)
    done_at.set()
    watcher.join()
    print(f"\n{len(kinds)} kinds, two at a time: {time.monotonic() - begun:.0f} s; the machine's memory in use rose by at most {taken[0]} MB, "
          f"its load was at most {highest:.1f}, everything else on it included")
    # the workbench's own cache of compiled equations is no doing of a program
    changed = [path for path in set(before) ^ set(after) if ("holonom" in path or "mine" in path) and "/.cache/" not in path]
    print("".join(f"  {path}\n" for path in changed), end="")
    print(f"files written outside, into home, /usr/local, /var/tmp, /dev/shm or beside the program: {len(changed) + bad}")
    return bad or changed


def main():
    print("Classes graded by two processes; then killed ten times in the middle and gone on with")
    print(f"{'class':22} {'n':>5} {'graded':>7} {'ungradable':>10} {'s':>8} {'1/s':>8}  {'kills':>5} {'lost':>5} {'twice':>6}  result")
    bad = grade_class("formulas, p3", "p3", formulas)
    if not test_programs.TROUBLE:
        bad = grade_class("programs, four-bar", "four-bar", programs) or bad
    return 1 if hostile() or bad else 0


if __name__ == "__main__":
    sys.exit(main())
