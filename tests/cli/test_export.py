# SPDX-License-Identifier: GPL-3.0-or-later
"""Every shipped scene as a program: it compiles without a warning, and its own self-check agrees. Speaks TAP.

The self-check of each program compares accelerations and energy to 1e-10 and the motion to 1e-6. C runs for every scene, the
other languages where the machine has them: Python for every scene, the others for a few that cover every kind of coordinate.
"""

import concurrent.futures
import json
import os
import shutil
import subprocess
import sys
import tempfile

PROGRAM = os.path.abspath(os.environ.get("HOLONOM", "build/holonom"))
FEW = ["four-bar", "heavy-top", "cardan-shaft", "delta-robot", "car-axis", "planetary-gear"]
SLOW = {("octave", "delta-robot")}  # minutes in an interpreter that solves by singular values
FACTS = 5  # lines of a self-check


def find_python():
    """A Python that has scipy, or None."""
    for python in (sys.executable, "/usr/bin/python3"):
        if subprocess.run([python, "-c", "import scipy.integrate"], capture_output=True).returncode == 0:
            return python
    return None


def languages():
    """name: (ending, how to build or None, how to run); without those whose tools the machine lacks."""
    python = find_python()
    found = {"c": (".c", ["gcc", "-std=c99", "-O1", "-Wall", "-Wextra", "-Werror", "{file}", "-o", "{out}", "-lm"], ["{out}"])}
    if python:
        found["python"] = (".py", None, [python, "{file}"])
    if shutil.which("octave"):
        found["octave"] = (".m", None, ["octave", "--no-gui", "--quiet", "--norc", "{file}"])
    if shutil.which("g++"):
        found["cpp"] = (".cpp", ["g++", "-std=c++17", "-O1", "-Wall", "-Wextra", "-Werror", "{file}", "-o", "{out}"], ["{out}"])
    if shutil.which("java"):
        found["java"] = (".java", None, ["java", "{file}"])
    if shutil.which("julia"):
        found["julia"] = (".jl", None, ["julia", "{file}"])
    return found


def call(words):
    try:
        return subprocess.run(words, capture_output=True, text=True, timeout=300)
    except subprocess.TimeoutExpired:
        return subprocess.CompletedProcess(words, -1, "", "not done after 300 s")


def faults_of(folder, scene, name, language):
    """What is wrong with the program for one scene in one language."""
    ending, build, run = language
    file, out = os.path.join(folder, f"{scene}{ending}"), os.path.join(folder, f"{scene}-{name}")
    place = {"{file}": file, "{out}": out}
    done = call([PROGRAM, "export", scene, "--language", name, "-o", file])
    if done.returncode != 0:
        return [f"export: {done.stderr.strip()[:300]}"]
    for words in filter(None, (build, run)):
        done = call([place.get(w, w) for w in words])
        if done.returncode != 0:
            return [f"{words[0]}: {line}" for line in (done.stdout + done.stderr).splitlines() if not line.startswith("ok")][:8]
    good = sum(line.startswith("ok ") for line in done.stdout.splitlines())
    return [] if good == FACTS else [f"{good} of {FACTS} lines of the self-check are ok"]


def refusals():
    """Requests that must be refused, with a word of the message."""
    cases = [(["four-bar", "--language", "pyton"], 2, "python"), (["four-baar"], 2, "four-bar"),
             (["four-bar", "-o", "no/such/folder/x.py"], 3, "no/such/folder")]  # fmt: skip
    for words, status, said in cases:
        done = call([PROGRAM, "export", *words])
        yield f"{' '.join(words)} is refused", [] if done.returncode == status and said in done.stderr else [
            f"exit {done.returncode}: {done.stderr.strip()}"]


def slip(folder):
    """A self-check that cannot fail checks nothing: a changed parameter must be found."""
    file = os.path.join(folder, "slip.c")
    text = call([PROGRAM, "export", "four-bar", "--language", "c"]).stdout
    with open(file, "w", encoding="utf-8") as f:
        f.write(text.replace("const double l2 = 1.2;", "const double l2 = 1.2000001;"))
    call(["gcc", "-O1", file, "-o", file + ".x", "-lm"])
    done = call([file + ".x"])
    return [] if done.returncode == 1 and "BAD" in done.stdout else [done.stdout]


def main():
    scenes = [s["id"] for s in json.loads(call([PROGRAM, "list", "scenes", "--json"]).stdout)["scenes"]]
    known = languages()
    results = []
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(2) as pool:
        jobs = [(s, name) for name in known for s in (scenes if name in ("c", "python") else FEW) if (name, s) not in SLOW]
        found = pool.map(lambda job: faults_of(folder, *job, known[job[1]]), jobs)
        results = [(f"{name}: {scene} agrees with the workbench", faults) for (scene, name), faults in zip(jobs, found)]
        results.append(("a parameter that is off by 1e-7 is found by the self-check", slip(folder)))
    results += refusals()
    for n, (name, faults) in enumerate(results, 1):
        for fault in faults:
            print(f"# {fault}")
        print(f"{'not ok' if faults else 'ok'} {n} - {name}")
    n = len(results)
    for name in ("python", "octave", "cpp", "java", "julia"):
        if name not in known:
            n += 1
            print(f"ok {n} - {name} # SKIP not on this machine")
    print(f"1..{n}")
    return 1 if any(faults for _, faults in results) else 0


if __name__ == "__main__":
    sys.exit(main())
