# SPDX-License-Identifier: GPL-3.0-or-later
"""The extreme matrix from the command line: all cases parse, a cheap part is run, documents agree, faults of files are told."""

import csv
import glob
import io
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(__file__))
import studies  # noqa: E402
from studies import DONE, ENDED, INPUT, driver  # noqa: E402

HERE = "lessons/extreme"
SECONDS = ["x4", "x6", "x16"]  # cases that take some together
CHEAP = ["x3", "x7", "x8", "x12", "x13", "x19", "x21", "x22"]


def call(words, **more):
    """With a folder of its own for what is unfinished."""
    with tempfile.TemporaryDirectory() as folder:
        return studies.call(["extreme", *words], folder, text=True, **more)


def verdicts(document):
    return [(c["id"], t["what"], t["verdict"], t["observed"]) for c in document["cases"] for t in c["trials"]]


class Extreme(unittest.TestCase):
    def test_all_cases_parse_and_each_has_a_trial_with_a_reason(self):
        done = call(["--json", "--time-limit", "1e-9"])
        self.assertEqual(done.returncode, DONE, done.stderr)
        cases = json.loads(done.stdout)["cases"]
        self.assertEqual([c["id"] for c in cases], [f"X{n}" for n in range(1, 26)])
        for case in cases:
            self.assertGreater(len(case["trials"]), 0)
            for trial in case["trials"]:
                self.assertTrue(trial["predicted"]["reason"], trial["what"])
                self.assertIn(trial["verdict"], ["not run", "needs --long"])

    def test_a_cheap_part_is_as_predicted_and_the_same_each_time(self):
        first, second = call([*CHEAP, "--json"]), call([*CHEAP, "--json"])
        self.assertEqual(first.returncode, DONE, first.stdout)
        self.assertEqual(first.stdout, second.stdout)
        for case, what, verdict, observed in verdicts(json.loads(first.stdout)):
            self.assertEqual(verdict, "pass", f"{case} {what}: {observed}")

    def test_text_csv_json_and_page_tell_the_same(self):
        with tempfile.TemporaryDirectory() as folder:
            page = os.path.join(folder, "x.html")
            text = call(["X13", "x3", "--out", page])
            with open(page, encoding="utf-8") as f:
                html = f.read()
        self.assertEqual(text.returncode, DONE, text.stderr)
        rows = list(csv.DictReader(io.StringIO(call(["x3", "x13", "--csv"]).stdout)))
        document = json.loads(call(["x3", "x13", "--json"]).stdout)
        self.assertEqual(len(rows), len(verdicts(document)))
        for row, (case, what, verdict, observed) in zip(rows, verdicts(document)):
            self.assertEqual((row["id"], row["what"], row["verdict"], row["observed"]), (case, what, verdict, observed))
            self.assertIn(what[:20], text.stdout)
            self.assertIn(observed[:20], html)
        self.assertNotRegex(html, r"(?:src|href)=\"?(?:https?:)?//")
        self.assertIn(f"{len(rows)} pass; 2 cases", text.stdout)

    def test_the_stored_table_has_every_trial(self):
        with open("tests/tables/extreme.txt", encoding="utf-8") as f:
            table = f.read()
        for path in sorted(glob.glob(f"{HERE}/x*.json")):
            with open(path, encoding="utf-8") as f:
                case = json.load(f)
            self.assertRegex(table, rf"(?m)^{case['id']} +{re.escape(case['title'])} \(", path)
        trials = sum(len(json.load(open(p, encoding="utf-8"))["trials"]) for p in glob.glob(f"{HERE}/x*.json"))
        counts = [int(n) for n in re.findall(r"(\d+) (?:pass|warn|fail|not run|needs --long)", table.splitlines()[-1])]
        self.assertEqual(sum(counts), trials)
        self.assertNotIn(" fail", table.splitlines()[-1])

    def test_an_unknown_case_and_a_wrong_file_name_are_told(self):
        cases = len(glob.glob(HERE + "/x*.json"))
        for words, says in ([["x99"], "no case 'x99'"], [["x99"], f"the cases are x1 to x{cases}"], [["x3", "--out", "a.doc"], "does not choose a form"]):
            done = call(words)
            self.assertEqual(done.returncode, INPUT)
            self.assertIn(says, done.stderr)

    def test_ctrl_c_keeps_what_is_done_and_the_same_command_goes_on(self):
        words = ["extreme", *SECONDS, "--json"]
        with tempfile.TemporaryDirectory() as folder:
            status, out, err = studies.interrupt(words, folder, "extreme")
            self.assertEqual(status, ENDED, err)
            self.assertIn("stopped on request; the same command continues from here", err)
            document = json.loads(out)
            self.assertTrue(document["stopped"])
            seen = [t for t in verdicts(document) if t[2] == "pass"]
            self.assertTrue(seen)
            self.assertIn("not run", {v for _, _, v, _ in verdicts(document)})
            done = studies.call([w for w in words if w != "--json"], folder, text=True)
            self.assertEqual(done.returncode, DONE, done.stderr)
            self.assertIn(f"continuing with {len(seen)} trials of an earlier run", done.stderr)
            self.assertEqual(studies.journals(folder, "extreme"), [], "nothing is left of a whole matrix")

    def test_killed_ten_times_it_ends_with_the_bytes_of_an_undisturbed_one(self):
        words = [*SECONDS, "--json"]
        undisturbed = call(words)
        with tempfile.TemporaryDirectory() as folder:
            self.assertGreaterEqual(studies.kill_often(["extreme", *words], folder, "extreme", 3), 3)
            done = studies.call(["extreme", *words], folder, text=True)
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertEqual(done.stdout, undisturbed.stdout)

    def test_time_left_is_shown_in_a_trial_that_lasts(self):
        with tempfile.TemporaryDirectory() as folder:
            status, seen = studies.watch_terminal(["extreme", "x6", "x4", "x16", "x11", "--long"], folder, interrupt=True)
        self.assertEqual(status, ENDED, seen)
        self.assertRegex(seen, r"extreme X\d+ \[[#.]+\] +\d+ %, \d+ (?:s|min) left")

    def test_a_budget_leaves_trials_that_a_richer_run_of_the_same_does(self):
        with tempfile.TemporaryDirectory() as folder:
            poor = studies.call(["extreme", *SECONDS, "--json", "--time-limit", "0.2"], folder, text=True)
            self.assertTrue(json.loads(poor.stdout)["out_of_time"])
            self.assertIn("the time limit of 0.2 s left trials out; the same command continues from here", poor.stderr)
            rich = studies.call(["extreme", *SECONDS, "--json"], folder, text=True)
        self.assertEqual(rich.stdout, call([*SECONDS, "--json"]).stdout)

    def test_what_another_build_did_is_not_gone_on_with(self):
        words = ["extreme", *SECONDS]
        with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as place:
            studies.interrupt(words, folder, "extreme")
            other = shutil.copy(driver.PROGRAM, place)  # the same bytes, made later
            argv, env = studies.command(words, folder, HOLONOM_HOME=os.environ.get("HOLONOM_HOME", os.getcwd()))
            done = subprocess.run([other, *argv[1:]], capture_output=True, text=True, env=env, check=False, timeout=200 * driver.SLOW)
            self.assertEqual(done.returncode, DONE, done.stderr)
            self.assertNotIn("continuing", done.stderr)
            self.assertEqual(len(studies.journals(folder, "extreme")), 1, "that of the first waits for it")

    def test_a_journal_that_was_cut_or_damaged_is_used_as_far_as_it_is_whole(self):
        words = ["extreme", *SECONDS, "--json"]
        undisturbed = call(SECONDS + ["--json"]).stdout
        with tempfile.TemporaryDirectory() as folder:
            studies.interrupt(words, folder, "extreme")
            path, = [os.path.join(folder, name) for name in studies.journals(folder, "extreme")]
            with open(path, encoding="utf-8") as f:
                lines = f.readlines()
            for text in (lines[0] + lines[0][:40], lines[0] + '{"case":99,"trial":0,"seen":[]}\n', '{"case":0,"trial":0,"seen":[]}\n', "[1]\n", "\0\n"):
                with open(path, "w", encoding="utf-8") as f:
                    f.write(text)
                self.assertEqual(studies.call(words, folder, text=True).stdout, undisturbed, text[:80])


class Files(unittest.TestCase):
    """A copy of the lessons with one case, changed."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        home = self.folder.name
        os.mkdir(os.path.join(home, "web"))
        os.makedirs(os.path.join(home, "lessons", "extreme"))
        shutil.copytree("lessons/01-closed-loops/scenes", os.path.join(home, "lessons", "01-closed-loops", "scenes"))
        self.path = os.path.join(home, "lessons", "extreme", "x03-changed.json")
        with open(glob.glob(f"{HERE}/x03-*.json")[0], encoding="utf-8") as f:
            self.case = json.load(f)

    def tearDown(self):
        self.folder.cleanup()

    def run_changed(self):
        with open(self.path, "w", encoding="utf-8") as f:
            json.dump(self.case, f)
        return call(["x3"], HOLONOM_HOME=self.folder.name)

    def test_a_wrong_prediction_is_a_failure_and_a_near_one_a_warning(self):
        predicted = self.case["trials"][0]["predicted"]
        predicted["value"] = 1.1e-3 * 1.02  # two tolerances off
        warned = self.run_changed()
        self.assertEqual(warned.returncode, DONE)
        self.assertIn("1 warn", warned.stdout)
        predicted["value"] = 1.2e-3
        failed = self.run_changed()
        self.assertEqual(failed.returncode, ENDED)
        self.assertIn("1 fail", failed.stdout)

    def test_each_fault_is_told_with_its_place(self):
        def change(path, value):
            node = self.case
            for key in path[:-1]:
                node = node[key]
            before = node.get(path[-1])
            node[path[-1]] = value
            done = self.run_changed()
            if before is None:
                del node[path[-1]]
            else:
                node[path[-1]] = before
            return done

        trial = ["trials", 0]
        for path, value, says in (
            ([*trial, "measur"], 1, "did you mean 'measure'?"),
            ([*trial, "measure"], "vale", "did you mean 'value'?"),
            ([*trial, "of"], "gapp", "did you mean 'gap'?"),
            ([*trial, "scene"], "fb9", "/trials/0/scene"),
            ([*trial, "time"], -1, "expected a number from 0"),
            ([*trial, "time"], "2*", "/trials/0/time"),
            ([*trial, "predicted"], {"value": 1, "reason": "x"}, "within"),
            ([*trial, "predicted"], {"word": "finished", "reason": "x"}, "gives a number"),
            ([*trial, "predicted"], {"value": 1, "within": 1}, "/trials/0/predicted/reason"),
            ([*trial, "sweep"], {"name": "h", "values": [1]}, "takes no sweep"),
            ([*trial, "refine"], 21, "from 0 to 20"),
            (["trials"], [], "1 to 32 trials"),
        ):
            done = change(path, value)
            self.assertEqual(done.returncode, INPUT, (path, value, done.stdout))
            self.assertIn(says, done.stderr)
            self.assertIn("x03-changed.json", done.stderr)


if __name__ == "__main__":
    driver.main()
