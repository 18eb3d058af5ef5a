# SPDX-License-Identifier: GPL-3.0-or-later
"""Every shipped scene as a program: it compiles without a warning, and its own self-check agrees. Speaks TAP.

The self-check of each program compares accelerations and energy to 1e-10 and the motion to 1e-6. C runs for every scene, the
other languages where the machine has them: Python for every scene, the others for a few that cover every kind of coordinate.
With --all every language runs every scene, and what was seen is a table (make languages).

Wolfram's and Modelica's programs are run by nobody here, and Julia's only where it is installed. Their equations are evaluated all
the same: each statement is respelled for Python, and every entry of every term must be what the program in Python has, to rounding.
What they do with the equations (solve, integrate, print) is not tried that way; their brackets must match. With --all, and --parsers
NODE_MODULES, the whole of each Julia program is parsed by tree-sitter's grammar; no parser of the two others was found in Debian 12 or npm.
"""

import concurrent.futures
import contextlib
import io
import json
import os
import queue
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading

from latex_formulas import closing
from program_equations import RESPELLED, equations_faults, formulas_faults, unmatched

PROGRAM = os.path.abspath(os.environ.get("HOLONOM", "build/holonom"))
# with another solver: dependent constraints and a spinning body are among them
TWO = ["cardan-shaft", "heavy-top"]
FEW = ["four-bar", "heavy-top", "cardan-shaft", "delta-robot", "car-axis", "planetary-gear"]
EJML = ["/usr/share/java/ejml-core.jar", "/usr/share/java/ejml-ddense.jar"]
SLOW = {("octave", "delta-robot"), ("octave ode15s", "delta-robot")}  # minutes in an interpreter that solves by singular values
# scenes that another solver does not hold to 1e-6, and why: the table of all languages says so
NOT_HELD = {("python petsc", "stiff-four-bar"): "rounding of a spring of 1e9 N/m is in the residual, and PETSc's Newton stops at 3e-6"}
FACTS = 5  # lines of a self-check
CPU = 600  # [s] of computing for one program: the slowest takes 60 alone, and a machine that does other things too takes none of it
WALL = 3600  # [s] for one that waits and computes nothing


def find_python():
    """A Python that has scipy, or None."""
    for python in (sys.executable, "/usr/bin/python3"):
        if subprocess.run([python, "-c", "import scipy.integrate"], capture_output=True).returncode == 0:
            return python
    return None


def languages():
    """name: (ending, how to build or None, how to run); without those whose tools the machine lacks."""
    python = find_python()
    # what gcc finds when it optimises is looked for in the few alone: without, it takes half the time
    found = {"c": (".c", ["gcc", "-std=c99", "{optimise}", "-Wall", "-Wextra", "-Werror", "{file}", "-o", "{out}", "-lm"], ["{out}"])}
    if python:
        found["python"] = (".py", None, [python, "{file}"])
    if python and subprocess.run([python, "-c", "import petsc4py"], capture_output=True).returncode == 0:
        found["python petsc"] = (".py", None, [python, "{file}"])
    if shutil.which("octave"):
        found["octave"] = (".m", None, ["octave", "--no-gui", "--quiet", "--norc", "{file}"])
        found["octave ode15s"] = found["octave"]
    if shutil.which("g++"):
        found["cpp"] = (".cpp", ["g++", "-std=c++17", "-O1", "-Wall", "-Wextra", "-Werror", "{file}", "-o", "{out}"], ["{out}"])
        if os.path.exists("/usr/include/eigen3/Eigen/Dense"):
            found["cpp eigen"] = found["cpp"]
    if shutil.which("java"):
        found["java"] = (".java", None, ["java", "{file}"])
        if all(map(os.path.exists, EJML)):
            found["java ejml"] = (".java", None, ["java", "-cp", ":".join(EJML), "{file}"])
    if shutil.which("julia"):
        found["julia"] = (".jl", None, ["julia", "{file}"])
    if shutil.which("pdflatex"):
        found["latex"] = (".tex", None, ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "-output-directory={folder}", "{file}"])
    return found


FORKS = """
import os, resource, runpy, sys
import numpy, scipy.integrate
CPU = int(sys.argv[1])
for line in sys.stdin:
    file = line.rstrip()
    child = os.fork()
    if child == 0:
        os.dup2(os.open(file + ".out", os.O_WRONLY | os.O_CREAT | os.O_TRUNC), 1)
        os.dup2(1, 2)
        resource.setrlimit(resource.RLIMIT_CPU, (CPU, CPU))
        sys.argv = [file]
        runpy.run_path(file, run_name="__main__")
        os._exit(99)  # a program ends by itself
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
"""


class Python:
    """Processes that have imported scipy, and fork for each program: the import takes longer than most programs."""

    def __init__(self, python, n):
        self.idle = queue.Queue()
        for _ in range(n):
            self.idle.put(subprocess.Popen([python, "-c", FORKS, str(CPU)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True))

    def run(self, file):
        process = self.idle.get()
        watch = threading.Timer(WALL, process.kill)
        watch.start()
        try:
            process.stdin.write(file + "\n")
            process.stdin.flush()
            status = int(process.stdout.readline() or -1)
        finally:
            watch.cancel()
            self.idle.put(process)
        with open(file + ".out", encoding="utf-8") as f:
            return subprocess.CompletedProcess([file], status, f.read(), "")

    def close(self):
        while not self.idle.empty():
            process = self.idle.get()
            process.stdin.close()
            process.wait()
            process.stdout.close()


def call(words, cpu=CPU):
    """Runs a program within its computing time [s]; one that is stopped says so in stderr."""
    if isinstance(words[0], Python):
        return words[0].run(words[1])
    try:
        done = subprocess.run(["prlimit", f"--cpu={cpu}", "--", *words], capture_output=True, text=True, timeout=WALL)
    except subprocess.TimeoutExpired:
        return subprocess.CompletedProcess(words, -1, "", f"not done after {WALL} s")
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        done.stderr += f"not done after {cpu} s of computing"
    return done


def faults_of(folder, scene, name, language, out_name=None):
    """What is wrong with the program for one scene in one language: "python", or "python petsc" with a solver."""
    ending, build, run = language
    words, scene = scene, out_name or scene
    name, *solver = name.split()
    file, out = os.path.join(folder, f"{'-'.join([scene, *solver])}{ending}"), os.path.join(folder, "-".join([scene, name, *solver]))
    place = {"{file}": file, "{out}": out, "-output-directory={folder}": f"-output-directory={folder}", "{optimise}": "-O1" if words in FEW else "-O0"}
    done = call([PROGRAM, "export", words, "--language", name, *(["--solver", *solver] if solver else []), "-o", file])
    if done.returncode != 0:
        return [f"export: {done.stderr.strip()[:300]}"]
    for words in filter(None, (build, run)):
        done = call([place.get(w, w) for w in words])
        if done.returncode != 0:
            return [f"{os.path.basename(str(words[0]))}: {line}" for line in (done.stdout + done.stderr).splitlines() if not line.startswith("ok")][:8]
    if name == "latex":
        return [] if os.path.getsize(os.path.join(folder, f"{scene}.pdf")) > 10000 else ["the document is empty"]
    good = sum(line.startswith("ok ") for line in done.stdout.splitlines())
    return [] if good == FACTS else [f"{good} of {FACTS} lines of the self-check are ok"]


def hostile_words(folder):
    """A title that would end the comment it stands in: every program stays the program it is."""
    scene = json.loads(call([PROGRAM, "inspect", "pendulum", "--json"]).stdout)
    path = os.path.join(os.path.dirname(__file__), "..", "..", "lessons")
    files = [os.path.join(at, name) for at, _, names in os.walk(path) for name in names if name == "pendulum.json" and "scenes" in at]
    with open(files[0], encoding="utf-8") as f:
        scene = json.load(f)
    scene["title"] = 'a """ b */ c *) \\u000a d \\input{x} $ % \n import os; os._exit(7) #'
    for p in scene["parameters"].values():
        p["about"] = "x\nraise SystemExit(7)"
    mine = os.path.join(folder, "words.json")
    with open(mine, "w", encoding="utf-8") as f:
        json.dump(scene, f)
    known, faults = languages(), []
    for name in known:
        if " " not in name:  # another solver has the same words
            faults += [f"{name}: {fault}" for fault in faults_of(folder, mine, name, known[name], "words")]
    return faults + [f"{name}: {fault}" for name in RESPELLED for fault in equations_faults(mine, name)]


def helpers(folder):
    """A program defines and imports what its scene calls, and nothing else; with sign and step in a load it still agrees."""
    faults, known = [], languages()
    path = os.path.join(os.path.dirname(__file__), "..", "..", "lessons", "01-closed-loops", "scenes", "pendulum.json")
    with open(path, encoding="utf-8") as f:
        scene = json.load(f)
    # they do not change before the self-check ends: the numbers it compares are of a smooth motion
    scene["loads"] = [{"torque": {"joint": "O", "value": "0.3*step(t+1)*exp(-t) - 0.1*sign(th+4)"}}]
    mine = os.path.join(folder, "calls.json")
    with open(mine, "w", encoding="utf-8") as f:
        json.dump(scene, f)
    for name in known:
        if " " not in name:
            faults += [f"{name}: {fault}" for fault in faults_of(folder, mine, name, known[name], "calls")]
    of = lambda *words: call([PROGRAM, "export", *words]).stdout
    for name, defined in (("python", ("def sign", "def step")), ("c", ("double sign(", "double step(")), ("cpp", ("double sign(", "double step("))):
        texts = [of(at, "--language", name) for at in (mine, "four-bar")]
        faults += [f"{name}: {word}: {[word in t for t in texts]}" for word in defined if [word in t for t in texts] != [True, False]]
    for at, line in ((mine, "from math import cos, exp, sin"), ("four-bar", "from math import cos, sin")):
        faults += [] if f"\n{line}\n" in of(at, "--language", "python") else [f"{at}: not '{line}'"]
    # only a scene with an orientation has a quaternion whose sign may differ
    for name in (*known, *RESPELLED):
        if " " in name or name == "latex":
            continue
        texts = [of(at, "--language", name) for at in ("heavy-top", "four-bar")]
        said = [[word in t for t in texts] for word in ("quaternion", "orientation")]
        faults += [] if said == [[True, False]] * 2 else [f"{name}: {said}"]
    return faults


def joined():
    """The sheet has differences of angles, and says of which coordinates its pieces are; each is defined before it is used."""
    text = call([PROGRAM, "export", "four-bar", "--language", "latex"]).stdout
    wanted = (r"\eq{\term{mass}_{1,2}}{\tfrac{1}{2}\, m_{2}\, l_{1}\, l_{2}\, \cos(\theta_{1} - \theta_{\mathrm{coupler}})}",)
    faults = [f"not in the sheet: {line}" for line in wanted if line not in text]
    faults += ["products of sines are left"] if re.search(r"\\sin\([^()]*\)\\, \\(sin|cos)\(", text) else []
    seen, sheet = set(), call([PROGRAM, "export", "stewart-6-6", "--language", "latex"]).stdout
    terms = sheet.partition("subsection*{Terms}")[2].partition("subsection*{Rates")[0]
    long = re.findall(r"(?<![\w.])\d+\.\d{9,}", terms)
    faults += [f"{len(long)} long numbers, {len(set(long))} different"] if len(long) > 2 * len(set(long)) or len(long) < 50 else []
    faults += [f"{x} has more than 14 digits" for x in long if len(x.replace(".", "").lstrip("0")) > 14]
    faults += [] if r"\eq{n_{1}}{" in terms and terms.index(r"\pieces{Numbers}") < terms.index("n_{1}") < terms.index("k_{1}") else ["no table of numbers before the pieces"]
    for line in (line for line in sheet.splitlines() if line.startswith(r"\eq{")):
        end = closing(line, 3)
        left, right = line[4:end], line[end + 2:closing(line, end + 1)]
        used = set(re.findall(r"(?<![A-Za-z])([cku]_\{\d+\})", right))
        faults += [f"{left} uses {sorted(used - seen)[0]} before it is defined"] if used - seen else []
        faults += [f"{left} is of velocities: {right[:80]}"] if left[0] == "k" and re.search(r"\\dot|\\omega|dL|u_\{", right) else []
        seen |= {left} if re.fullmatch(r"[cku]_\{\d+\}", left) else set()
    faults += [] if any(k[0] == "k" for k in seen) and any(k[0] == "u" for k in seen) else [f"pieces: {sorted(seen)[:5]}"]
    return faults + ([] if r"\remark{of $L_{1}$}" in sheet else ["no piece says that it is of one coordinate"])


def named():
    """What the head of a program calls its terms, the program calls them too."""
    faults = []
    for name in ("python", "c", "cpp", "java", "octave", *RESPELLED):
        text = call([PROGRAM, "export", "four-bar", "--language", name]).stdout
        head = re.search(r"(\S+) is M, (\S+) is f, (\S+) is J, (\S+) is gamma, (\S+) is phi, (\S+) its partial derivative", text)
        faults += [f"{name}: no {word}" for word in head.groups() if text.count(word) < 3] if head else [f"{name}: its head names no terms"]
    return faults


def limits():
    """The limit counts computing alone: a program that waits is not stopped, whatever else the machine does."""
    waits = call([sys.executable, "-c", "import time; time.sleep(3)"], cpu=2)
    computes = call([sys.executable, "-c", "while True: pass"], cpu=1)
    faults = [f"one that waits: {waits.returncode} {waits.stderr}"] if waits.returncode != 0 or waits.stderr else []
    return faults + ([] if "not done after 1 s of computing" in computes.stderr else [f"one that computes: {computes}"])


def ends():
    """What the table of all languages ends with: an error, unless it names the reason of every scene that does not agree."""
    (name, scene), _ = next(iter(NOT_HELD.items()))
    with contextlib.redirect_stdout(io.StringIO()):
        named, other = (table([("c", "run", "four-bar", []), (name, "run", at, ["x"])]) for at in (scene, "four-bar"))
    return [] if (named, other) == (0, 1) else [f"named: {named}, another: {other}"]


def refusals():
    """Requests that must be refused, with a word of the message."""
    cases = [(["four-bar", "--language", "pyton"], 2, "python"), (["four-baar"], 2, "four-bar"),
             (["four-bar", "--method", "projection@rk4"], 2, "do not have the formulation 'projection'"), (["four-bar", "--method", "x@rk4"], 2, "x"),
             (["four-bar", "-o", "no/such/folder/x.py"], 2, "no/such/folder")]  # fmt: skip
    for words, status, said in cases:
        done = call([PROGRAM, "export", *words])
        yield f"{' '.join(words)} is refused", [] if done.returncode == status and said in done.stderr else [
            f"exit {done.returncode}: {done.stderr.strip()}"]


def methods(folder):
    """The method says how the loops are held: its numbers are in the program, and without any the loop opens."""
    faults, known = [], languages()
    for method, first, second in (("baumgarte:alpha=3,beta=7@rk4:h=0.01", "3", "7"), ("index1@rk4", "0", "0")):
        text = call([PROGRAM, "export", "four-bar", "--language", "c", "--method", method]).stdout
        if f"ALPHA = {first}.0, BETA = {second}.0;" not in text:
            faults.append(f"{method}: not in the program")
        file = os.path.join(folder, f"method{first}.c")
        with open(file, "w", encoding="utf-8") as f:
            f.write(text)
        call(["gcc", "-O1", file, "-o", file + ".x", "-lm"])
        done = call([file + ".x"])
        if done.returncode != 0:
            faults.append(f"{method}: {done.stdout}")
    return faults if "c" in known else ["no C"]


def run_text(folder, name, language, text):
    """What a program of this text prints, built and run as the table of languages says."""
    ending, build, run = languages()[language]
    file = os.path.join(folder, name + ending)
    with open(file, "w", encoding="utf-8") as f:
        f.write(text)
    fill = {"file": file, "out": file + ".x", "optimise": "-O1"}
    for words in (build, run):
        done = call([word.format(**fill) for word in words]) if words else None
    return done.returncode, done.stdout + done.stderr


def steps_of_the_method(folder):
    """With a fixed step of euler, heun or rk4 a program repeats the steps, and finds the gap that `compare` prints; else it says why not."""
    faults, known = [], languages()
    for method, time in (("index1@rk4:h=0.01", 10), ("baumgarte@heun:h=0.01", 10), ("index1@euler:h=0.001", 2)):
        gap = json.loads(call([PROGRAM, "compare", "four-bar", "--methods", method, "--time", str(time), "--json"]).stdout)["methods"][0]["worst_gap"]
        for language in [name for name in ("c", "python", "cpp", "octave") if name in known and (name == "c" or method.startswith("index1@rk4"))]:
            text = call([PROGRAM, "export", "four-bar", "--language", language, "--method", method]).stdout
            status, said = run_text(folder, f"steps{time}", language, text)
            found = re.search(rf"(?m)^ok  worst gap of {re.escape(method)}, to t = {time}: (\S+) m, in the workbench (\S+) m", said)
            # six digits are printed
            if status != 0 or not found or any(abs(float(x) - gap) > 1e-5 * gap for x in found.groups()):
                faults.append(f"{method} in {language}: exit {status}, {gap} expected: {said}")
    # a gap that is off is found
    text = call([PROGRAM, "export", "four-bar", "--language", "c", "--method", "index1@rk4:h=0.01"]).stdout
    status, said = run_text(folder, "steps_off", "c", text.replace("METHOD_GAP = 0.0333", "METHOD_GAP = 0.0334"))
    if status != 1 or "BAD worst gap" not in said:
        faults.append(f"a gap that is off: exit {status}: {said}")
    # others say why, on standard error and in the program
    for language, scene, method, why in (("c", "four-bar", "index1@dopri5:rtol=1e-6", "it can take the steps of euler, heun and rk4"),
                                         ("java", "four-bar", "index1@rk4:h=0.01", "it has one integrator, which is its own"),
                                         ("c", "heavy-top", "index1@rk4:h=0.01", "its own integrator alone takes orientations"),
                                         ("c", "bennett", "index1@rk4:h=0.01", "its constraints depend on each other"),
                                         ("c", "parallelogram", "baumgarte@rk4:h=0.002", "rounding changes its motion too much")):  # fmt: skip
        done = call([PROGRAM, "export", scene, "--language", language, "--method", method])
        wanted = f"does not take the steps of {method}: {why}".replace("rtol=1e-6", "rtol=1e-06")
        if done.returncode != 0 or wanted not in done.stdout or why not in " ".join(done.stderr.split()):
            faults.append(f"{scene} by {method} in {language}: {wanted} is not said: {done.stderr}")
    return faults


def no_warnings(folder):
    """A trial step that is too long is no warning of numpy's: the program of Bennett's linkage tries one."""
    python = find_python()
    if not python:
        return []
    file = os.path.join(folder, "quiet.py")
    with open(file, "w", encoding="utf-8") as f:
        f.write(call([PROGRAM, "export", "bennett", "--language", "python"]).stdout)
    done = call([python, file])
    return [done.stderr] if done.returncode != 0 or "Warning" in done.stderr else []


def slip(folder):
    """A self-check that cannot fail checks nothing: a changed parameter must be found."""
    file = os.path.join(folder, "slip.c")
    text = call([PROGRAM, "export", "four-bar", "--language", "c"]).stdout
    with open(file, "w", encoding="utf-8") as f:
        f.write(text.replace("const double l2 = 1.2;", "const double l2 = 1.2000001;"))
    call(["gcc", "-O1", file, "-o", file + ".x", "-lm"])
    done = call([file + ".x"])
    return [] if done.returncode == 1 and "BAD" in done.stdout else [done.stdout]


def skeleton():
    """Without the self-check: every function of the full program, and from the start the same motion, to the last bit."""
    python, faults = find_python(), []
    for scene in ("four-bar", "heavy-top") if python else ():
        full, bare = (call([PROGRAM, "export", scene, "--language", "python", "--style", style]).stdout for style in ("full", "skeleton"))
        if full != call([PROGRAM, "export", scene, "--language", "python"]).stdout:
            faults.append(f"{scene}: full is not what is written without --style")
        if "check" in bare.lower() or "@" in bare.replace(" @ ", "") or not len(bare) < len(full):
            faults.append(f"{scene}: checks or places are left in the skeleton")
        ends = []
        for text in (full, bare):
            after = "; import numpy; print(repr(list(move(START_Q, START_V, 0.3).y[:, -1])))"
            done = call([python, "-c", f"__name__ = 'taken'; exec({text!r}){after}"])
            ends.append(done.stdout or done.stderr)
        if ends[0] != ends[1] or "[" not in ends[0]:
            faults.append(f"{scene}: {ends}")
        done = call([python, "-c", bare])
        if done.returncode != 0 or not re.search(r"^q \[", done.stdout, re.MULTILINE):
            faults.append(f"{scene}: {done.stdout} {done.stderr}")
        if subprocess.run([python, "-c", "import matplotlib"], capture_output=True).returncode == 0:
            faults += plot_faults(python, scene, bare)
    for words, said in ((("--language", "latex", "--style", "skeleton"), "no skeleton in latex"), (("--style", "bare"), "full or skeleton"),
                        (("--language", "c", "--solver", "eigen"), "only one solver"), (("--language", "cpp", "--solver", "egen"), "eigen"),
                        (("--language", "java", "--solver", "ejml", "--blanks"), "without further libraries"),
                        (("--format", "mjcf", "--solver", "eigen"), "--solver"),
                        (("--blanks", "--style", "skeleton"), "leave one of them out")):
        done = call([PROGRAM, "export", "four-bar", *words])
        if done.returncode != 2 or said not in done.stderr or done.stdout:
            faults.append(f"{words}: {done.returncode} {done.stderr}")
    return faults


def without_numpy():
    """The first line says what is missing, and the end is no success."""
    text = call([PROGRAM, "export", "four-bar", "--language", "python"]).stdout
    # a folder of a module that cannot be imported, before all others
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "numpy.py"), "w", encoding="utf-8") as f:
            f.write("raise ImportError('there is no numpy here')\n")
        done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, timeout=600, env={**os.environ, "PYTHONPATH": folder})
    said = "This program needs numpy and scipy (on Debian: apt install python3-scipy; elsewhere: python3 -m pip install scipy): there is no numpy here\n"
    return [] if (done.returncode, done.stdout, done.stderr) == (1, "", said) else [f"{done.returncode}: {done.stderr}"]


def plot_faults(python, scene, text):
    """With the word plot the program draws each coordinate, and the gap."""
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "motion.py")
        with open(file, "w", encoding="utf-8") as f:
            f.write(text)
        done = subprocess.run([python, file, "plot"], capture_output=True, text=True, timeout=300, cwd=folder)
        drawn = os.path.join(folder, scene + ".svg")
        if not os.path.exists(drawn):
            return [f"{scene}: no plot: {done.stderr[-300:]}"]
        with open(drawn, encoding="utf-8") as f:
            curves = f.read().count('id="line2d_')
    return [] if done.returncode == 0 and curves > 4 else [f"{scene}: {curves} curves"]


def tables(folder):
    """Skeletons of compiled languages print the motion, as the full programs do when they are asked for the table."""
    known, faults = languages(), []
    for name in ("c", "cpp", "java"):
        if name not in known:
            continue
        ending, build, run = known[name]
        lines = []
        for style, words in (("full", ["table"]), ("skeleton", [])):
            file, out = (os.path.join(folder, f"table-{style}{e}") for e in (ending, ""))
            call([PROGRAM, "export", "four-bar", "--language", name, "--style", style, "-o", file])
            place = {"{file}": file, "{out}": out, "{optimise}": "-O1"}
            done = [call([place.get(w, w) for w in step] + (words if step is run else [])) for step in filter(None, (build, run))]
            lines.append(done[-1].stdout.splitlines())
        numbers = [float(x) for x in lines[1][-1].split()] if lines[1] else []
        if lines[0] != lines[1] or len(lines[1]) != 201 or len(numbers) != 1 + 3 + 3:
            faults.append(f"{name}: {len(lines[0])} and {len(lines[1])} lines, the last of the skeleton is {lines[1][-1:]}")
    for name in ("wolfram", "julia", "octave"):
        full, bare = (call([PROGRAM, "export", "four-bar", "--language", name, "--style", style]).stdout for style in ("full", "skeleton"))
        left = (name != "octave" and unmatched(name, bare)) or ("differ by" in bare and "its self-check")
        if left or not 1000 < len(bare) < len(full):
            faults.append(f"{name}: {left}")
    return faults


def parsed(folder, scenes, modules):
    """Julia programs by tree-sitter's grammar, as rows of the table. One that is broken must be found to be broken."""
    files = {scene: os.path.join(folder, f"{scene}.jl") for scene in scenes}
    for scene, file in files.items():
        call([PROGRAM, "export", scene, "--language", "julia", "-o", file])
    broken = os.path.join(folder, "broken.jl")
    with open(files["four-bar"], encoding="utf-8") as f, open(broken, "w", encoding="utf-8") as out:
        out.write(f.read().replace("\nend", "\nen", 1))
    script = os.path.join(os.path.dirname(__file__), "..", "tools", "parse-julia.mjs")
    done = call(["node", script, modules, *files.values(), broken])
    said = dict(line.split("\t") for line in done.stdout.splitlines())
    if not said.get(broken):
        return [("julia", "parsed", scene, [f"the parser finds no fault in a broken program: {done.stderr[:200]}"]) for scene in scenes]
    return [("julia", "parsed", scene, [said.get(file) or "it was not parsed"] if said.get(file, "?") else []) for scene, file in files.items()]


def table(results):
    """What was seen, a line for each language."""
    print("Every shipped scene as a program in every language: run, and compared with the workbench by its own self-check")
    print("(accelerations and energy to 1e-10, the motion to 1e-6). Respelled: the equations alone were evaluated. Parsed: the whole")
    print("program was read by tree-sitter's grammar. Debian 12 has no Julia, Wolfram or Modelica; no parser of the last two was")
    print("found there or in npm: how their programs solve, integrate and print was not tried. Evaluated: each formula of the sheet")
    print("in LaTeX was read back and its value at the start compared with the program in Python.")
    print(f"{'language':14} {'how':10} {'scenes':>6} {'agree':>6}  those that do not")
    for name, how in dict.fromkeys((name, how) for name, how, *_ in results):
        mine = [(scene, faults) for n, h, scene, faults in results if (n, h) == (name, how)]
        said = [f"{scene} ({NOT_HELD.get((name, scene), faults[0])})" for scene, faults in mine if faults]
        bad = ", ".join(said)
        print(f"{name:14} {how:10} {len(mine):6} {sum(not faults for _, faults in mine):6}  {bad or 'none'}")
    return 1 if any(faults and (name, scene) not in NOT_HELD for name, _, scene, faults in results) else 0


def main():
    scenes = [s["id"] for s in json.loads(call([PROGRAM, "list", "scenes", "--json"]).stdout)["scenes"]]
    known = languages()
    every = "--all" in sys.argv
    forks = Python(find_python(), 2) if "python" in known else None
    if forks:
        known["python"] = (".py", None, [forks, "{file}"])
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(2) as pool:
        jobs = [(s, name) for name in known for s in (scenes if every or name in ("c", "python") else TWO if " " in name else FEW)
                if every or (name, s) not in SLOW]  # fmt: skip
        found = pool.map(lambda job: faults_of(folder, *job, known[job[1]]), jobs)
        ran = [(name, "run", scene, faults) for (scene, name), faults in zip(jobs, found)]
        if forks:
            forks.close()
        with concurrent.futures.ProcessPoolExecutor(2) as processes:
            pairs = [(scene, name) for name in RESPELLED for scene in scenes]
            faults = processes.map(equations_faults, *zip(*sorted(pairs)), chunksize=len(RESPELLED))
            ran += [(name, "respelled", scene, found) for (scene, name), found in zip(sorted(pairs), faults)]
            ran += [("latex", "evaluated", scene, found) for scene, found in zip(scenes, processes.map(formulas_faults, scenes))]
        ran.sort(key=lambda row: row[1] == "respelled" and RESPELLED.index(row[0]) + 1)
        if every:
            modules = sys.argv[sys.argv.index("--parsers") + 1] if "--parsers" in sys.argv else None
            return table(ran + (parsed(folder, scenes, modules) if modules else []))
        results = [(f"{name}: {scene} agrees with the workbench ({how})", faults) for name, how, scene, faults in ran]
        results.append(("a parameter that is off by 1e-7 is found by the self-check", slip(folder)))
        results.append(("a limit on a program counts its computing alone", limits()))
        results.append(("only a reason in the table excuses a scene", ends()))
        results.append(("a method says how the loops are held", methods(folder)))
        results.append(("a method's own steps open the loops as far as the workbench says", steps_of_the_method(folder)))
        results.append(("a trial step that is too long prints no warning", no_warnings(folder)))
        results.append(("a skeleton is the program without its self-check", skeleton()))
        results.append(("a program without its libraries says so in its first line", without_numpy()))
        results.append(("a skeleton in a compiled language prints the motion", tables(folder)))
        results.append(("the terms have the names that the head of a program gives them", named()))
        results.append(("a program has the helpers that its scene calls, and no others", helpers(folder)))
        results.append(("the sheet joins angles, and names its pieces by what they depend on", joined()))
        results.append(("words of a scene stay words in every language", hostile_words(folder)))
    results += refusals()
    for n, (name, faults) in enumerate(results, 1):
        for fault in faults:
            print(f"# {fault}")
        print(f"{'not ok' if faults else 'ok'} {n} - {name}")
    n = len(results)
    for name in ("python", "octave", "cpp", "java", "julia", "latex"):
        if name not in known:
            n += 1
            print(f"ok {n} - {name} # SKIP not on this machine")
    print(f"1..{n}")
    return 1 if any(faults for _, faults in results) else 0


if __name__ == "__main__":
    sys.exit(main())
