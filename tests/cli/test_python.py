# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python module says what the command says, and its notebook runs."""

import json
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
MODULE = os.path.join(HERE, "..", "..", "server", "python")
sys.path.insert(0, os.path.join(HERE, "..", "api"))
sys.path.insert(0, MODULE)
import driver  # noqa: E402

os.environ["HOLONOM"] = os.path.abspath(driver.PROGRAM)
import holonom  # noqa: E402


class Module(unittest.TestCase):
    def test_a_run_has_its_columns(self):
        motion = holonom.run("four-bar", "projection@rk4:h=1e-3", time=0.5, at=[0, 0.25, 0.5])
        self.assertEqual(list(motion.t), [0, 0.25, 0.5])
        self.assertEqual(motion["th1"][0], 1)
        self.assertEqual(len(motion[motion.rates[0]]), 3)
        self.assertLess(max(motion.gap), 1e-14)
        self.assertTrue(motion.finished)
        self.assertIn("3 samples", repr(motion))
        self.assertTrue(any(name.startswith("lambda ") for name in motion.keys()))

    def test_a_parameter_changes_the_motion(self):
        usual, heavy = (holonom.run("pendulum", "reduced@dop853:rtol=1e-10", time=1, every=0.5, set=s) for s in ({}, {"l": 2.0}))
        self.assertNotEqual(usual[usual.coordinates[0]][-1], heavy[heavy.coordinates[0]][-1])

    def test_a_run_that_ended_early_says_why(self):
        motion = holonom.run("four-bar", "index1@euler:h=0.05", time=60)
        self.assertFalse(motion.finished)
        self.assertTrue(motion.reason)

    def test_comparisons_studies_scenes_terms_and_grades(self):
        table = holonom.compare("four-bar", ["index1@rk4:h=1e-2", "projection@rk4:h=1e-2"], time=1)
        gaps = [m["worst_gap"] for m in table["methods"]]
        self.assertGreater(gaps[0], 1e6 * gaps[1])
        work = holonom.study("pendulum", methods=["projection@rk4"], time=0.5, levels=3, samples=0)
        self.assertEqual(len(work["methods"][0]["points"]), 3)
        self.assertIn("four-bar", [s["id"] for s in holonom.scenes()])
        self.assertEqual(holonom.scene("four-bar")["start"]["dof"], 1)
        self.assertEqual(len(holonom.terms("four-bar", q={"th1": 1.2})["M"]), 3)
        self.assertIn("p3", [p["id"] for p in holonom.problems()])
        right = {"problem": "p3", "J": [["-l1*sin(th1)", "-l2*sin(th2)", "l3*sin(th3)", "l4*sin(th4)"],
                                        ["l1*cos(th1)", "l2*cos(th2)", "-l3*cos(th3)", "-l4*cos(th4)"]]}
        self.assertEqual(holonom.grade("p3", right)["score"], 8)

    def test_what_is_refused_is_an_exception_with_the_near_miss(self):
        with self.assertRaises(holonom.HolonomError) as caught:
            holonom.run("fuor-bar")
        self.assertIn("four-bar", str(caught.exception))
        self.assertEqual(caught.exception.status, 2)
        self.assertTrue(caught.exception.faults)

    def test_every_name_that_is_offered_is_explained(self):
        for name in holonom.__all__:
            self.assertTrue(getattr(holonom, name).__doc__, name)

    def test_the_notebook_has_the_cells_of_the_script_and_runs_cell_by_cell(self):
        with open(os.path.join(MODULE, "four_bar.ipynb"), encoding="utf-8") as f:
            notebook = json.load(f)
        with open(os.path.join(MODULE, "four_bar.py"), encoding="utf-8") as f:
            script = [part.split("\n", 1) for part in f.read().split("\n# %% ")[1:]]
        code = ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]
        titles = ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "markdown"][1:]
        self.assertEqual(code, [text.strip("\n") for _, text in script])
        self.assertEqual([title.lower() for title in titles], [f"## {title}".lower() for title, _ in script])

        # as Jupyter reads it: ids, kernel, outputs empty
        self.assertEqual((notebook["nbformat"], notebook["nbformat_minor"], notebook["metadata"]["kernelspec"]["name"]), (4, 5, "python3"))
        ids = [cell["id"] for cell in notebook["cells"]]
        self.assertEqual(len(ids), len(set(ids)))
        for cell in notebook["cells"]:
            self.assertEqual(set(cell) - {"execution_count", "outputs"}, {"cell_type", "id", "metadata", "source"})
        check = "import sys, nbformat; nbformat.validate(nbformat.read(sys.argv[1], as_version=4))"
        for python in ("/usr/bin/python3", sys.executable):
            if subprocess.run([python, "-c", "import nbformat"], capture_output=True).returncode == 0:
                done = subprocess.run([python, "-c", check, os.path.join(MODULE, "four_bar.ipynb")], capture_output=True, text=True, timeout=120)
                self.assertEqual(done.returncode, 0, done.stderr)

        # as a kernel does: one cell after the other, in one namespace
        cells = "import json, sys\nspace = {'__name__': '__main__'}\nfor cell in json.load(open(sys.argv[1]))['cells']:\n" \
                "    if cell['cell_type'] == 'code':\n        exec(compile(''.join(cell['source']), cell['id'], 'exec'), space)\n"
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, "-c", cells, os.path.join(MODULE, "four_bar.ipynb")], capture_output=True, text=True, timeout=300,
                                  cwd=folder, env={**os.environ, "PYTHONPATH": MODULE})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(re.findall(r"gap +\S+ m", done.stdout)), 5)

    def test_a_program_of_ones_own_runs_and_refusals_have_their_reason(self):
        text = "import json, sys\nsys.stdin.readline()\nprint(json.dumps({'holonom': 1, 'provides': 'accelerations'}), flush=True)\n" \
               "for line in sys.stdin:\n    print(json.dumps({'id': json.loads(line)['id'], 'a': [-2.0]}), flush=True)\n"
        code = "import holonom, sys\n" \
               "motion = holonom.run('pendulum', 'program:' + sys.argv[1] + '@rk4:h=1e-2', time=0.1, allow_programs=True)\n" \
               "print(motion.rates and round(float(motion[motion.rates[0]][-1] - motion[motion.rates[0]][0]), 9))\n" \
               "print(len(holonom.compare('pendulum', ['program:' + sys.argv[1] + '@rk4:h=1e-2'], time=0.1, allow_programs=True)['methods']))\n" \
               "print('l1 = 0.45' in holonom.export('four-bar', 'c', set={'l1': 0.45}))\n" \
               "for wrong in (lambda: holonom.grade('p3', {'a': 1}), lambda: holonom.export('four-bar', 'cobol')):\n" \
               "    try:\n        wrong()\n    except holonom.HolonomError as fault:\n        print(fault)\n"
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "mine.py")
            with open(path, "w", encoding="utf-8") as f:
                f.write(text)
            done = subprocess.run([sys.executable, "-c", code, path], capture_output=True, text=True, timeout=300, env={**os.environ, "PYTHONPATH": MODULE})
        if "untrusted programs run in a sandbox" in done.stderr:
            self.skipTest("no sandbox here")
        self.assertEqual(done.returncode, 0, done.stderr)
        said = done.stdout.splitlines()
        self.assertEqual(said[:3], ["-0.2", "1", "True"])
        self.assertRegex(done.stdout, "the field 'J' is missing; as in")
        self.assertIn("'cobol' is not a language of export", done.stdout)

    def test_the_script_runs(self):
        with tempfile.TemporaryDirectory() as folder:
            env = {**os.environ, "PYTHONPATH": MODULE}
            done = subprocess.run([sys.executable, os.path.join(MODULE, "four_bar.py")], capture_output=True, text=True, timeout=300, cwd=folder, env=env)
        self.assertEqual(done.returncode, 0, done.stderr)
        gaps = [float(g) for g in re.findall(r"gap +(\S+) m", done.stdout)]
        self.assertEqual(len(gaps), 5)
        self.assertTrue(all(math.isfinite(g) for g in gaps))
        # the first is not stabilised, the second is held, the others close the loop
        self.assertGreater(gaps[0], gaps[1])
        self.assertLess(max(gaps[2:]), 1e-14)


if __name__ == "__main__":
    driver.main()
