# SPDX-License-Identifier: GPL-3.0-or-later
"""Students' programs: the starting points give what Baumgarte gives, and whatever a program does, its row says what it did."""

import concurrent.futures
import csv
import io
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402

PROGRAM = os.path.abspath(driver.PROGRAM)
DONE, INPUT, ENDED = 0, 2, 4
BUILDS = {"c": ["gcc", "-O2", "-Wall", "-Werror", "-x", "c"], "cpp": ["g++", "-O2", "-Wall", "-Werror", "-x", "c++"]}
NEEDS = {"python": "python3", "javascript": "node", "octave": "octave-cli", "java": "java", "c": "gcc", "cpp": "g++", "julia": "julia"}
ENDINGS = {"python": "py", "javascript": "js", "octave": "m", "c": "c", "cpp": "cpp", "java": "java", "julia": "jl"}


def call(*words, cwd=None):
    return subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=300 * driver.SLOW, cwd=cwd)


def sandbox_trouble():
    """Why the sandbox cannot be set up on this machine; "" where it can."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "true.py")
        with open(path, "w", encoding="utf-8") as f:
            f.write("pass\n")
        said = call("run", "pendulum", "--method", f"program:{path}", "--time", "0.1", "--allow-programs").stderr
    found = re.search(r"untrusted programs run in a sandbox, and .*", said)
    return found.group(0) if found else ""


TROUBLE = sandbox_trouble()
ALLOW = "--trust-programs" if TROUBLE else "--allow-programs"


def has_numpy():
    python = shutil.which("python3") if TROUBLE else "/usr/bin/python3"
    return python and subprocess.run([python, "-c", "import numpy"], capture_output=True).returncode == 0


class StartingPoints(unittest.TestCase):
    def compare_with_baumgarte(self, language):
        with tempfile.TemporaryDirectory() as folder:
            name = "mine." + ENDINGS[language]
            self.assertEqual(call("program", language, "-o", name, cwd=folder).returncode, DONE)
            if language in BUILDS:
                subprocess.run([*BUILDS[language], "-o", "mine", name, "-lm"], check=True, cwd=folder)
                name = "mine"
            for scene, time in (("four-bar", "0.3"), ("double-pendulum", "0.2"), ("heavy-top", "0.1"))[:3 if language in ("python", "c") else 1]:
                done = call("compare", scene, "--methods", f"program:./{name}@rk4:h=1e-2", "baumgarte@rk4:h=1e-2", "--time", time, "--json", ALLOW, cwd=folder)
                self.assertEqual(done.returncode, DONE, (language, scene, done.stderr))
                own, ours = json.loads(done.stdout)["methods"]
                self.assertEqual(own["evals"], ours["evals"], (language, scene))
                # the same equations by another elimination: equal to rounding, grown over some steps
                for key in ("worst_gap", "worst_energy_change"):
                    self.assertLess(abs(own[key] - ours[key]), 1e-12 + 1e-6 * abs(ours[key]), (language, scene, key))

    def test_each_language_gives_what_baumgarte_gives(self):
        there = []
        for language, tool in NEEDS.items():
            if shutil.which(tool) and (language != "python" or has_numpy()):
                there.append(language)
            else:
                print(f"# {language}: {tool} is not here, its starting point was not run")
        self.assertGreaterEqual(len(there), 2)
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            list(pool.map(self.compare_with_baumgarte, there))

    def test_the_starting_point_in_c_says_that_a_scene_is_too_large(self):
        greeting = json.dumps({"holonom": 1}) + "\n"
        with tempfile.TemporaryDirectory() as folder:
            text = call("program", "c", "-o", "mine.c", cwd=folder)
            self.assertEqual(text.returncode, DONE)
            subprocess.run([*BUILDS["c"], "-fsanitize=address", "-o", "mine", "mine.c", "-lm"], check=True, cwd=folder)
            # more velocities, more constraints, and more of both together than there is room for
            for n, m in ((61, 0), (0, 61), (31, 30), (30, 30), (200, 200)):
                numbers = {"f": [1.0] * n, "v": [0.0] * n, "gamma": [0.0] * m, "phi": [0.0] * m, "phi_t": [0.0] * m}
                matrix = [[float(i == j) for j in range(n)] for i in range(n)]
                question = json.dumps({"id": 1, **numbers, "M": matrix, "J": matrix[:m] or [[] for _ in range(m)]}, separators=(",", ":"))
                done = subprocess.run(["./mine"], input=greeting + question + "\n", capture_output=True, text=True, timeout=600, cwd=folder)
                if n + m <= 60:
                    self.assertEqual((done.returncode, done.stderr, len(done.stdout.splitlines())), (0, "", 2))
                else:
                    self.assertEqual((done.returncode, done.stderr), (1, "this scene is too large for MOST = 60 in mine.c\n"), (n, m))

    def test_the_starting_point_in_julia_has_what_the_conversation_needs(self):
        """Debian 12 has no Julia: the text is read here, and run by the test above where there is one."""
        text = call("program", "julia").stdout
        for word in ('\\"holonom\\":1', '\\"provides\\":\\"accelerations\\"', '\\"id\\":', '\\"lambda\\":', "flush(stdout)"):
            self.assertIn(word, text)
        wanted = re.search(r'wants.*\[(.*?)\]', text).group(1).replace("\\", "").replace('"', "").split(",")
        self.assertEqual(wanted, ["M", "f", "J", "gamma", "phi", "phi_t"])
        # what is wanted is what is read
        self.assertEqual(set(re.findall(r'numbers\(line, "(\w+)"\)', text)), {*wanted, "v", "id"})
        text = re.sub(r'"(\\.|[^"\\])*"|\'.\'|#.*', "", text.replace("J'", "J"))
        for pair in ("()", "[]", "{}"):
            self.assertEqual(text.count(pair[0]), text.count(pair[1]), pair)
        opened = len(re.findall(r"^(function|for)\b", text, re.M))
        self.assertEqual((opened, len(re.findall(r"^end$", text, re.M))), (3, 3))

    def test_the_help_and_every_starting_point_say_how_a_program_steps_by_itself(self):
        texts = {language: call("program", language).stdout for language in ENDINGS}
        texts["help"] = call("help", "program").stdout
        for name, text in texts.items():
            flat = re.sub(r"\s+", " ", text)
            for words in ('"provides": "step"', "asked t, h, q, v", "q, v at t + h", "@own:h=", "server/program/README.md", "serve --programs DIR"):
                self.assertIn(words, flat, name)
            # what a student would find out by a failure
            if name != "help":
                self.assertIn("holds this one file", flat, name)
        # narrow enough for an editor, but for the command
        self.assertLessEqual(max(len(line) for line in texts["python"].splitlines() if "--methods" not in line), 100)

    def test_it_does_not_write_over_the_work_of_a_student(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "mine.py")
            for words in (("program", "python"), ("export", "pendulum", "--blanks")):
                self.assertEqual(call(*words, "-o", path, "--force").returncode, DONE)
                self.assertEqual(call(*words, "-o", path).returncode, DONE, "the same text again does no harm")
                with open(path, "a", encoding="utf-8") as f:
                    f.write("# my own\n")
                done = call(*words, "-o", path)
                self.assertEqual(done.returncode, INPUT)
                self.assertIn("--force", done.stderr)
                self.assertTrue(open(path, encoding="utf-8").read().endswith("# my own\n"))
                self.assertEqual(call(*words, "-o", path, "--force").returncode, DONE)
                self.assertNotIn("# my own", open(path, encoding="utf-8").read())

    def test_what_the_starting_point_in_python_needs_is_said(self):
        self.assertIn("python3-numpy", call("program", "python").stdout)
        self.assertIn("needs numpy", " ".join(call("program", "--help").stdout.split()))
        # a Python without it: a sentence in place of a traceback
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "mine.py"), "w", encoding="utf-8") as f:
                f.write(call("program", "python").stdout.replace("import numpy as np", "import no_such_module as np"))
            done = subprocess.run([sys.executable, "mine.py"], cwd=folder, input="", capture_output=True, text=True, timeout=600)
            self.assertEqual(done.returncode, 1)
            self.assertEqual(done.stderr.splitlines(), ["This program needs numpy (apt install python3-numpy): No module named 'no_such_module'"])

    def test_a_run_starts_a_program_that_gives_accelerations_once(self):
        counting = """
import json, os, sys
open(os.environ["STARTS"], "a").write("x")
scene = json.loads(sys.stdin.readline())
print(json.dumps({"holonom": 1, "provides": "accelerations", "wants": ["f"]}), flush=True)
for line in sys.stdin:
    ask = json.loads(line)
    print(json.dumps({"id": ask["id"], "a": [x for x in ask["f"]], "lambda": []}), flush=True)
"""
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "mine.py"), "w", encoding="utf-8") as f:
                f.write(counting.replace('os.environ["STARTS"]', repr(os.path.join(folder, "starts"))))
            for methods, starts in ((1, 1), (2, 2)):
                names = [f"program:./mine.py@rk4:h={h}" for h in ("1e-2", "2e-2")[:methods]]
                # samples between the steps need an instance of their own, but no process
                done = call("compare", "pendulum", "--methods", *names, "--time", "0.1", "--json", "--trust-programs", cwd=folder)
                self.assertEqual(done.returncode, DONE, done.stderr)
                with open(os.path.join(folder, "starts"), encoding="utf-8") as f:
                    self.assertEqual(len(f.read()), starts, methods)
                os.remove(os.path.join(folder, "starts"))

    def test_a_language_that_is_not_there_is_answered_with_those_that_are(self):
        done = call("program", "pyton")
        self.assertEqual(done.returncode, INPUT)
        self.assertIn("did you mean 'python'", done.stderr)


# what every program below begins with
GREETING = """
import json, os, sys, time
scene = json.loads(sys.stdin.readline())
def say(**what):
    print(json.dumps(what), flush=True)
def greet(provides="accelerations", **more):
    say(holonom=1, provides=provides, **more)
def questions():
    for line in sys.stdin:
        yield json.loads(line)
n = len(scene["coordinates"])
"""
EULER = ("import math\ndef euler(q, v, h):\n"
         "    return [x + h * y for x, y in zip(q, v)], [y - h * 9.81 * math.sin(x) for x, y in zip(q, v)]\n")
STEP = EULER + "greet('step')\nfor ask in questions():\n    q, v = euler(ask['q'], ask['v'], ask['h'])\n    say(id=ask['id'], q=q, v=v)\n"
SOLVE = EULER + ("greet('solve')\nfor ask in questions():\n    t, q, v, rows = ask['t'], ask['q'], ask['v'], []\n    for to in ask['times']:\n"
                 "        (q, v), t = euler(q, v, to - t), to\n        rows.append((q, v))\n"
                 "    say(id=ask['id'], q=[r[0] for r in rows], v=[r[1] for r in rows])\n")


class OneFile(unittest.TestCase):
    """Calls with one program of Python in a folder of its own."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def run_program(self, text, *words, method="program:./mine.py@own:h=1e-2", allow=ALLOW, folder=None):
        folder = folder or self.folder.name
        with open(os.path.join(folder, "mine.py"), "w", encoding="utf-8") as f:
            f.write(GREETING + text)
        allow = [allow] if allow else []
        return call("compare", "pendulum", "--methods", method, "baumgarte@rk4:h=1e-2", "--time", "0.2", *words, *allow, cwd=folder)


# the equations of index 1 by elimination, without numpy
INDEX1 = """import json, sys
sys.stdin.readline()
print(json.dumps({"holonom": 1, "provides": "accelerations", "wants": ["M", "f", "J", "gamma"]}), flush=True)
for line in sys.stdin:
    ask = json.loads(line)
    M, f, J, g = ask["M"], ask["f"], ask["J"], ask["gamma"]
    n, m = len(f), len(g)
    A = [M[i] + [J[k][i] for k in range(m)] + [f[i]] for i in range(n)] + [J[k] + [0.0] * m + [-g[k]] for k in range(m)]
    for i in range(n + m):
        p = max(range(i, n + m), key=lambda r: abs(A[r][i]))
        A[i], A[p] = A[p], A[i]
        for r in range(n + m):
            if r != i and A[i][i]:
                c = A[r][i] / A[i][i]
                A[r] = [x - c * y for x, y in zip(A[r], A[i])]
    print(json.dumps({"id": ask["id"], "a": [A[i][-1] / A[i][i] for i in range(n)]}), flush=True)
"""


class Services(OneFile):
    def test_steps_and_whole_runs_are_the_same_motion(self):
        step, solve = (json.loads(self.run_program(text, "--json").stdout)["methods"][0] for text in (STEP, SOLVE))
        self.assertEqual((step["state"], solve["state"], step["steps"], solve["steps"]), ("finished", "finished", 20, 20))
        # explicit Euler gains energy; differences of times are h to rounding
        self.assertGreater(step["worst_energy_change"], 1e-3)
        self.assertAlmostEqual(step["worst_energy_change"], solve["worst_energy_change"], delta=1e-12)
        # a question is for many steps
        asked = [int(re.search(r"asked (\d+) times", self.run_program(text).stderr).group(1)) for text in (STEP, SOLVE)]
        self.assertGreaterEqual(asked[0], 20)
        self.assertLessEqual(asked[1], asked[0] // 5)

    def test_run_study_and_snapshot_take_them(self):
        self.run_program(STEP)
        method = "program:./mine.py@own:h=1e-2"
        done = call("run", "pendulum", "--method", method, "--time", "0.1", ALLOW, cwd=self.folder.name)
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertEqual(len(done.stdout.splitlines()), 202)
        done = call("snapshot", "pendulum", "--method", method, "--time", "0.1", "-o", "a.png", ALLOW, cwd=self.folder.name)
        self.assertEqual(done.returncode, DONE, done.stderr)
        done = call("study", "pendulum", "--methods", method, "projection@rk4", "--time", "0.2", "--levels", "3", "--samples", "0", "--json", ALLOW, cwd=self.folder.name)
        self.assertEqual(done.returncode, DONE, done.stderr)
        own = json.loads(done.stdout)["methods"][0]
        self.assertEqual([p["state"] for p in own["points"]], ["done"] * 3)
        # nobody has said which order its steps have
        self.assertIsNone(own["class"]["theory"])
        self.assertNotRegex(own["class"]["text"], "theory|integrator|nan")
        shown = call("compare", "pendulum", "--methods", method, "baumgarte@rk4:h=1e-2", "--time", "0.1", "--json", ALLOW, cwd=self.folder.name)
        self.assertEqual(shown.returncode, DONE, shown.stderr)

    def test_a_program_that_ends_at_once_is_no_motion_that_diverged(self):
        method = "program:./mine.py@own:h=1e-2"
        with open(os.path.join(self.folder.name, "mine.py"), "w", encoding="utf-8") as f:
            f.write("raise SystemExit(1)\n")
        done = call("compare", "pendulum", "--methods", method, "--time", "0.2", ALLOW, cwd=self.folder.name)
        self.assertEqual(done.returncode, ENDED)
        # the head names the time that was asked for, not that of the first look
        self.assertRegex(done.stdout.splitlines()[0], r": every method ended before t = 0\.2 s$")
        end = json.loads(call("run", "pendulum", "--method", method, "--time", "0.2", "--json", ALLOW, cwd=self.folder.name).stdout)["incidents"][-1]
        self.assertEqual((end["code"], end["remedies"]), ("program-failed", []))

    def test_no_trial_of_a_remedy_asks_the_program(self):
        """A trial takes thousands of steps, each across a pipe, while everybody waits for the end of the run."""
        with open(os.path.join(self.folder.name, "mine.py"), "w", encoding="utf-8") as f:
            f.write(INDEX1)
        done = call("compare", "four-bar", "--methods", "program:./mine.py@rk4:h=2e-2", "--time", "4", "--json", ALLOW, cwd=self.folder.name)
        self.assertEqual(done.returncode, DONE, done.stderr)
        tried = [text for incident in json.loads(done.stdout)["incidents"] for text in incident.get("tried", [])]
        self.assertTrue(any("your program" in text for text in tried), done.stdout[-2000:])
        # 200 steps of 4 questions, and what is sampled between
        self.assertLess(int(re.search(r"asked (\d+) times", done.stderr).group(1)), 1200)

    def test_an_answer_depends_on_the_state_alone_or_the_program_is_told(self):
        """Samples between two steps are questions of the same process: what it remembers would make the motion depend on them."""
        sine = "    say(id=ask['id'], a=[-9.81 * math.sin(q) {} for q in ask['q']])\n"
        begin = "import math\ngreet()\nlast, seen = 0.0, 0\nfor ask in questions():\n"
        memories = {"the time of the last question": ("- 0.1 * (ask['t'] - last)", "    last = ask['t']\n", 0.2),
                    "how often it was asked": ("+ 1e-3 * seen", "    seen += 1\n", 0.2),
                    # one that begins to count late is found as well
                    "many questions": ("+ (seen > 300) * 1e-3 * seen", "    seen += 1\n", 2)}
        for what, (term, more, end) in memories.items():
            with open(os.path.join(self.folder.name, "mine.py"), "w", encoding="utf-8") as f:
                f.write(GREETING + begin + sine.format(term) + more)
            done = call("run", "pendulum", "--method", "program:./mine.py@rk4:h=1e-2", "--time", str(end), ALLOW, cwd=self.folder.name)
            self.assertEqual(done.returncode, ENDED, (what, done.stderr))
            self.assertRegex(" ".join(done.stderr.split()), r"question \d+ \(t = \S+ s\) was asked again as question \d+: a\[0\] was \S+ and is \S+ now; "
                             "an answer may depend on t, q and v alone", what)
        # one without a memory is asked again too, and its motion is that of the workbench
        own, ours = json.loads(self.run_program(begin + sine.format(""), "--json", method="program:./mine.py@rk4:h=1e-2").stdout)["methods"]
        self.assertEqual((own["state"], own["evals"]), ("finished", ours["evals"]))
        for text in (call("program", "--help").stdout, *(call("program", language).stdout for language in ENDINGS)):
            self.assertIn("t, q and v alone", re.sub(r"\s+", " ", text))

    def test_nobody_says_which_order_steps_of_its_own_have(self):
        self.run_program(STEP)
        words = ("study", "pendulum", "--methods", "program:./mine.py@own", "--time", "0.2", "--levels", "4", "--samples", "0", ALLOW)
        done = call(*words, "--json", cwd=self.folder.name)
        self.assertEqual(done.returncode, DONE, done.stderr)
        found = json.loads(done.stdout)["methods"][0]
        self.assertNotIn("integrator has", json.dumps(found))
        self.assertIsNone(found["theory"] if "theory" in found else found["class"]["theory"])
        self.assertNotIn("theory", call(*words, cwd=self.folder.name).stdout)

    def test_they_are_off_until_the_command_line_allows_them(self):
        done = self.run_program(STEP, allow=None)
        self.assertEqual(done.returncode, INPUT)
        self.assertIn("--allow-programs", done.stderr)

    def test_a_scene_file_cannot_bring_one(self):
        scene = json.load(open(os.path.join(os.path.dirname(__file__), "..", "..", "lessons", "01-closed-loops", "scenes", "four-bar.json"), encoding="utf-8")) \
            if os.path.exists(os.path.join(os.path.dirname(__file__), "..", "..", "lessons", "01-closed-loops", "scenes", "four-bar.json")) else None
        if scene is None:
            self.skipTest("the scene is elsewhere")
        scene["methods"] = ["program:/bin/true"]
        path = os.path.join(self.folder.name, "scene.json")
        with open(path, "w", encoding="utf-8") as f:
            json.dump(scene, f)
        done = call("compare", path, "--time", "0.1")
        self.assertEqual(done.returncode, INPUT)

    def test_the_wrong_way_of_asking_is_answered_with_the_right_one(self):
        done = self.run_program(STEP, method="program:./mine.py@rk4:h=1e-2")
        self.assertEqual(done.returncode, INPUT)
        self.assertIn("it makes its own steps", done.stderr)
        done = self.run_program("greet()\nfor ask in questions(): say(id=ask['id'], a=[0.0] * n)\n")
        self.assertEqual(done.returncode, INPUT)
        self.assertIn("spell it with an integrator", done.stderr)

    def test_one_that_does_not_start_leaves_the_others_in_the_table(self):
        done = self.run_program("sys.exit(3)\n")
        self.assertEqual(done.returncode, ENDED)
        # a motion that there is none of has no error
        self.assertRegex(done.stdout, r"(?m)^program:\S+ +ENDED EARLY +0 +\S+ +\S+ +\S+ +- +- ")
        self.assertRegex(done.stdout, r"(?m)^baumgarte@rk4\S* +right")
        self.assertIn("it ended with exit status 3 instead of an answer", " ".join(done.stderr.split()))

    def test_operations_that_nobody_counts_are_no_zeros(self):
        done = self.run_program(STEP)
        self.assertEqual(done.returncode, DONE, done.stderr)
        heads, row = (re.split(r" {2,}", line) for line in done.stdout.splitlines()[1:3])
        self.assertEqual([row[heads.index(head)] for head in ("ops", "ops/step")], ["-", "-"], done.stdout)

    def test_the_documents_say_null_and_why(self):
        own, ours = json.loads(self.run_program(STEP, "--json").stdout)["methods"]
        self.assertIsNone(own["ops"])
        self.assertIn("not counted", own["ops_reason"])
        self.assertGreater(ours["ops"], 0)
        self.assertNotIn("ops_reason", ours)
        where = {"cwd": self.folder.name}
        cost = json.loads(call("run", "pendulum", "--method", "program:./mine.py@own:h=1e-2", "--time", "0.1", "--json", ALLOW, **where).stdout)["cost"]
        self.assertIsNone(cost["operations"])
        self.assertIn("not counted", cost["operations_reason"])
        self.assertGreater(cost["evaluations"], 0)
        words = ("study", "pendulum", "--methods", "program:./mine.py@own", "projection@rk4", "--time", "0.2", "--levels", "2", "--samples", "0", ALLOW)
        own, ours = (m["points"] for m in json.loads(call(*words, "--json", **where).stdout)["methods"])
        self.assertEqual({(p["operations"], "not counted" in p["operations_reason"]) for p in own}, {(None, True)})
        self.assertTrue(all(p["operations"] > 0 and "operations_reason" not in p for p in ours))
        rows = list(csv.DictReader(io.StringIO(call(*words, "--csv", **where).stdout)))
        self.assertEqual({r["operations"] == "" for r in rows if r["method"].startswith("program")}, {True})
        self.assertRegex(call(*words, **where).stdout, r"(?m)program:\S+ +2/2 .* -$")

    def test_the_time_of_a_step_holds_what_the_program_computes(self):
        """Two programs in one comparison: each has its own time, and the workbench's own steps theirs."""
        busy = STEP.replace("    say(", "    end = time.process_time() + 2e-3\n    while time.process_time() < end: pass\n    say(")
        for name, text in (("busy.py", busy), ("quick.py", STEP)):
            with open(os.path.join(self.folder.name, name), "w", encoding="utf-8") as f:
                f.write(GREETING + text)
        methods = ["program:./busy.py@own:h=1e-2", "program:./quick.py@own:h=1e-2", "projection@rk4:h=1e-2"]
        done = call("compare", "pendulum", "--methods", *methods, "--time", "2", "--json", ALLOW, cwd=self.folder.name)
        busy, quick, ours = (m["step_cpu"]["median"] for m in json.loads(done.stdout)["methods"])
        self.assertGreater(busy, 2e-3)
        self.assertLess(quick, 0.6 * busy)
        self.assertLess(ours, 0.1 * quick)

    def test_a_file_that_is_none_is_refused(self):
        for name, said in (("no-such.py", "there is no program"), ("/tmp", "is not a file"), ("/etc/passwd", "cannot be started")):
            done = call("run", "pendulum", "--method", f"program:{name}", "--time", "0.1", ALLOW)
            self.assertEqual(done.returncode, INPUT, name)
            self.assertIn(said, done.stderr)


ANSWER = "say(id=ask['id'], q=ask['q'], v=ask['v'])"
# name: (the program, what its line says)
HOSTILE = {
    "says nothing and ends": ("", "it ended with exit status 0 instead of an answer"),
    "ends with an error": ("raise ValueError('wrong sign')", "ValueError: wrong sign"),
    "dies by a signal": ("os.kill(os.getpid(), 11)", "signal 11"),
    "greets with another version": ("say(holonom=7, provides='step')", 'must say "holonom": 1'),
    "greets with nothing to offer": ("say(holonom=1, provides='miracles')", "what it provides"),
    "wants what there is not": ("greet(wants=['truth'])", "wants 'truth'"),
    "greets twice": ("greet('step'); greet('step'); time.sleep(9)", "before it was asked|has no id"),
    "dies after a while": (STEP.replace("    say(", "    if ask['id'] == 5: sys.exit(3)\n    say("), "exit status 3"),
    "sends too many numbers": ("greet('step')\nfor ask in questions(): say(id=ask['id'], q=[0.0] * 50, v=ask['v'])", "q has 50 numbers, 1 are needed"),
    "sends no numbers": ("greet('step')\nfor ask in questions(): say(id=ask['id'])", "has no list q"),
    "sends words for numbers": ("greet('step')\nfor ask in questions(): say(id=ask['id'], q=['x'], v=ask['v'])", "q[0] is not a finite number"),
    "sends nested lists": ("greet('step')\nfor ask in questions(): say(id=ask['id'], q=[[1]], v=ask['v'])", "q[0] is not a finite number"),
    "sends NaN": ("greet('step')\nfor ask in questions(): say(id=ask['id'], q=[float('nan')], v=ask['v'])", "answer 1: q[0] is NaN; every number must be finite"),
    "sends NaN behind numbers": ("greet('step')\nfor ask in questions(): print('{\"id\":%d,\"q\":[0, 1.5, NaN]}' % ask['id'], flush=True)", "q[2] is NaN"),
    "sends Infinity in a row": ("greet('solve')\nfor ask in questions(): print('{\"id\":%d,\"q\":[[0], [2, 3], [1, -Infinity]]}' % ask['id'], flush=True)", "q[2][1] is Infinity"),
    "sends numbers beyond all bounds": ("greet('step')\nfor ask in questions(): print('{\"id\":%d,\"q\":[1e999],\"v\":[0]}' % ask['id'], flush=True)", "q[0] is not a finite number"),
    "answers out of order": ("greet('step')\nfor ask in questions(): say(id=ask['id'] + 1, q=ask['q'], v=ask['v'])", "has the id 2; question 1 was asked"),
    "answers without an id": ("greet('step')\nfor ask in questions(): say(q=ask['q'], v=ask['v'])", "has no id"),
    "answers twice": (f"greet('step')\nfor ask in questions():\n    sys.stdout.write(2 * (json.dumps(dict(id=ask['id'], q=ask['q'], v=ask['v'])) + '\\n')); sys.stdout.flush()", "more than one line"),
    "writes prose": ("greet('step')\nfor ask in questions(): print('the answer is 42', flush=True)", "is no JSON object: 'the answer is 42'"),
    "writes binary": ("greet('step')\nfor ask in questions(): os.write(1, bytes(range(256)) + b'\\n')", "answer 1"),
    "writes zero bytes": ("greet('step')\nfor ask in questions(): os.write(1, b'{\\0}\\n')", "zero byte"),
    "writes deep nests": ("greet('step')\nfor ask in questions(): os.write(1, b'[' * 100000 + b'\\n')", "is no JSON object"),
    "floods without an end of line": ("greet('step')\nfor ask in questions():\n    while True: os.write(1, b'x' * 65536)", "it wrote more than 4194304 bytes without an end of line"),
    "floods with lines": ("greet('step')\nfor ask in questions():\n    while True: os.write(1, b'{\"id\":1}\\n' * 9999)", "more than one line"),
    "floods its errors": (STEP.replace("    say(", "    os.write(2, b'e' * 300000)\n    say("), None),
    "hangs": ("greet('step')\nfor ask in questions(): time.sleep(99)", "did not answer within 0.5 s"),
    "computes without end": ("greet('step')\nfor ask in questions():\n    while True: pass", "did not answer within 0.5 s"),
    "ignores signals and hangs": ("import signal\nfor s in range(1, 32):\n    try: signal.signal(s, signal.SIG_IGN)\n    except OSError: pass\ngreet('step')\ntime.sleep(99)", "did not answer within 0.5 s"),
    "never reads": ("greet('step')\ntime.sleep(99)", "did not answer within 0.5 s"),
    "closes its output": ("greet('step')\nos.close(1); time.sleep(99)", "did not answer within 0.5 s|it closed its output"),
    "takes all memory": ("greet('step')\nx = []\nwhile True: x.append(bytearray(1 << 24))", "MemoryError|MB of memory"),
    "shares all memory": ("import mmap\ngreet('step')\nx = []\nwhile True:\n    m = mmap.mmap(-1, 1 << 26); m.write(b'x' * (1 << 26)); x.append(m)", "it holds more than 768 MB of memory"),
}
# what only the sandbox stops: (the program, what its line says)
CONFINED = {
    "forks without end": ("greet('step')\nwhile True:\n    try: os.fork()\n    except OSError: time.sleep(0.01)", "did not answer within 0.5 s|processes; 64 are allowed|MB of memory"),
    "forks away": ("greet('step')\nif os.fork() == 0:\n    os.setsid()\n    if os.fork() == 0:\n        time.sleep(60)\nos._exit(0)", "instead of an answer"),
    "fills its disk": ("greet('step')\nfor k in range(99):\n    open('/tmp/%d' % k, 'wb').write(b'x' * (1 << 24))", "No space left"),
    "writes a large file": ("greet('step')\nimport signal\nsignal.signal(signal.SIGXFSZ, signal.SIG_DFL)\nopen('/tmp/a', 'wb').write(b'x' * (1 << 25))", "file of more than 16 MB"),
    "hangs for want of threads": ("import threading\ngreet('step')\nwhile True: threading.Thread(target=time.sleep, args=(99,)).start()", "did not answer within 0.5 s; it had written: RuntimeError: can't start new thread (mine.py, line "),
    "calls home": ("import socket\ngreet('step')\nsocket.create_connection(('127.0.0.1', 22), timeout=3)", "refused"),
    "writes into the system": ("open('/usr/mine', 'w')", "Read-only file system"),
    "writes beside itself": ("open('/program/other', 'w')", "Read-only file system"),
    "reads the home of others": ("print(open('/root/.profile').read() + open('/home').read())", "No such file"),
    "counts its processes": ("greet('step')\nk = 0\ntry:\n    while k < 500:\n        if os.fork() == 0: time.sleep(20)\n        k += 1\nexcept OSError: raise ValueError('%d forked' % k)", "forked|MB of memory|processes; 64 are allowed"),
    "looks for other processes": ("greet('step')\nwant = [p for p in os.listdir('/proc') if p.isdigit()]\nraise ValueError('%d processes' % len(want))", "ValueError: [23] processes"),
    "makes itself root": ("import ctypes\ngreet('step')\nlibc = ctypes.CDLL(None, use_errno=True)\nraise OSError(libc.unshare(0x10000000), ctypes.get_errno())", "OSError"),
}


class Hostile(OneFile):
    def check_all(self, programs):
        def run(name):
            # those that hang are waited for half a second, the others as long as a busy machine needs
            hangs = (programs[name][1] or "").startswith("did not answer")
            with tempfile.TemporaryDirectory() as folder:
                return self.run_program(programs[name][0] + "\n", "--answer-time", "0.5" if hangs else "60", folder=folder)

        with concurrent.futures.ThreadPoolExecutor(4) as pool:
            for name, done in zip(programs, pool.map(run, programs)):
                with self.subTest(name):
                    self.check(name, done, programs[name][1])

    def check(self, name, done, said):
        line = " ".join(done.stderr.split())
        self.assertIn(done.returncode, (DONE, INPUT, ENDED), (name, line))
        self.assertNotIn("program is at fault", line, name)
        if said is None:
            self.assertEqual(done.returncode, DONE, (name, line))
            return
        self.assertNotEqual(done.returncode, DONE, name)
        self.assertRegex(line, "|".join(re.escape(words).replace(r"\[23\]", "[23]") for words in said.split("|")), name)
        self.assertLess(len(done.stderr), 4000, name)
        # one that fails on its way leaves the others in the table
        if done.returncode == ENDED:
            self.assertRegex(done.stdout, r"(?m)^baumgarte@rk4\S* +right", name)
            self.assertRegex(done.stdout, r"(?m)^program:\S+ +ENDED EARLY", name)

    def test_whatever_it_does_its_line_says_what(self):
        self.check_all(HOSTILE)

    def test_a_crash_names_the_line_and_what_ran_out_its_limit(self):
        """Line n of the program is line n of its file: the greeting of these tests stands before it."""
        begin = GREETING.count("\n") + 1
        crashes = {"greet('step')\ndef half(x):\n    raise ValueError('wrong sign')\nhalf(2)\n": rf"ValueError: wrong sign \(mine\.py, line {begin + 2}\)",
                   "greet('step')\nx = []\nwhile True: x.append(bytearray(1 << 24))\n": rf"MemoryError \(mine\.py, line {begin + 2}\); 768 MB of memory are allowed|holds more than 768 MB of memory"}
        if not TROUBLE:
            crashes["greet('step')\nimport neighbour\n"] = rf"No module named 'neighbour' \(mine\.py, line {begin + 1}\); the sandbox holds this file and the packages of the system alone"
            crashes["greet('step')\nopen('/tmp/a', 'wb').write(b'x' * (1 << 25))\n"] = r"File too large \(mine\.py, line \d+\); 16 MB of files are allowed"
            crashes["greet('step')\nfor k in range(99):\n    open('/tmp/%d' % k, 'wb').write(b'x' * (1 << 23))\n"] = r"No space left on device \(mine\.py, line \d+\); 16 MB of files are allowed"
        for text, said in crashes.items():
            done = self.run_program(text, "--answer-time", "60")
            self.assertEqual(done.returncode, ENDED, done.stderr)
            self.assertRegex(" ".join(done.stderr.split()), said, text)

    @unittest.skipIf(not shutil.which("node"), "node is not here")
    def test_a_crash_in_javascript_names_its_message(self):
        with open(os.path.join(self.folder.name, "mine.js"), "w", encoding="utf-8") as f:
            f.write(call("program", "javascript").stdout.replace("function accelerations(", "null.x;\nfunction accelerations("))
        done = call("run", "four-bar", "--method", "program:./mine.js@rk4:h=1e-2", "--time", "0.1", ALLOW, cwd=self.folder.name)
        self.assertEqual(done.returncode, ENDED, done.stderr)
        self.assertRegex(" ".join(done.stderr.split()), r"TypeError: Cannot read properties of null \(reading 'x'\) \(mine\.js, line \d+\)")

    @unittest.skipIf(TROUBLE, TROUBLE)
    def test_the_sandbox_holds(self):
        self.check_all(CONFINED)

    @unittest.skipIf(TROUBLE, TROUBLE)
    def test_nothing_is_left_running(self):
        mark = f"sleep-{os.getpid()}"
        self.run_program(f"greet('step')\nif os.fork() == 0:\n    os.setsid()\n    os.execvp('python3', ['{mark}', '-c', 'import time; time.sleep(60)'])\ntime.sleep(0.3)\nos._exit(0)\n")
        # the kernel ends what is left of a closed sandbox, in its own time; the process would sleep for 60 s
        end, left = time.monotonic() + 20, ["not looked yet"]
        while left and time.monotonic() < end:
            left = [p for p in os.listdir("/proc") if p.isdigit() and mark in self.words_of(p)]
            time.sleep(0.05)
        self.assertEqual(left, [])

    @staticmethod
    def words_of(pid):
        try:
            with open(f"/proc/{pid}/cmdline", "rb") as f:
                return f.read().decode(errors="replace")
        except OSError:
            return ""

    def test_without_a_sandbox_untrusted_programs_are_refused(self):
        if not TROUBLE:
            self.skipTest("there is a sandbox here")
        done = self.run_program(STEP, allow="--allow-programs")
        self.assertEqual(done.returncode, INPUT)
        self.assertIn("--trust-programs", done.stderr)


class InTheServer(OneFile):
    @unittest.skipIf(TROUBLE, TROUBLE)
    def test_a_folder_of_programs_is_served_and_nothing_else(self):
        with open(os.path.join(self.folder.name, "mine.py"), "w", encoding="utf-8") as f:
            f.write(GREETING + STEP)
        with open(os.path.join(self.folder.name, "readme.txt"), "w", encoding="utf-8") as f:
            f.write("no program")
        # links: one to a program outside, one to a program of the folder
        outside = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, outside)
        shutil.copy(os.path.join(self.folder.name, "mine.py"), os.path.join(outside, "other.py"))
        os.symlink(os.path.join(outside, "other.py"), os.path.join(self.folder.name, "away.py"))
        os.symlink("mine.py", os.path.join(self.folder.name, "again.py"))
        body = {"scene": "pendulum", "method": "program:mine.py@own:h=1e-2", "time": 0.1}
        for options, methods in (([], {"program:mine.py@own:h=1e-2": 422}),
                                 (["--programs", self.folder.name], {"program:mine.py@own:h=1e-2": 201, "program:../mine.py": 422, "program:/bin/true": 422, "program:gone.py@own": 422,
                                                                     "program:away.py@own:h=1e-2": 422, "program:again.py@own:h=1e-2": 201})):
            server = driver.Server(*options)
            try:
                for method, status in methods.items():
                    answer = server.ask("POST", "/api/v1/runs", {**body, "method": method})
                    self.assertIn(answer.status, (status, 200 if status == 201 else status), answer.body[:300])
                    # no answer tells where the folder is
                    self.assertNotIn(self.folder.name.encode(), answer.body)
                # the page offers what the server lists: files that can be started, of the folder that was given
                listed = server.ask("GET", "/api/v1/methods").json()["programs"]
                self.assertEqual(listed, ["program:again.py", "program:mine.py"] if options else [])
            finally:
                server.stop()


if __name__ == "__main__":
    driver.main()
