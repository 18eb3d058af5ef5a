"""Where errors and energy come from, from the command line: the parts add up, and what cannot be told is null."""

import json
import os
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402

DONE, INPUT = 0, 2
METHODS = ["index1@rk4:h=1e-2", "projection@rk4:h=1e-2", "ggl@radau5:rtol=1e-6", "projection@rk4:h=1e-6"]


def call(*words):
    return subprocess.run([driver.PROGRAM, *words], capture_output=True, text=True, timeout=120 * driver.SLOW)


class Budget(unittest.TestCase):
    def test_json_adds_up_and_says_what_cannot_be_told(self):
        done = call("study", "fb0", "budget", "--time", "1", "--methods", *METHODS, "--json")
        self.assertEqual(done.returncode, DONE, done.stderr)
        methods = json.loads(done.stdout)["methods"]
        self.assertEqual([m["method"] for m in methods[:2]], ["index1@rk4:h=0.01", "projection@rk4:h=0.01"])
        for m in methods[:3]:
            self.assertEqual(m["state"], "done")
            error, energy = m["error"], m["energy"]
            parts = [p for p in error["parts"].values() if p is not None]
            self.assertAlmostEqual(sum(parts) / error["value"], 1, delta=1e-3)  # first order in the error
            bill = [p for p in energy["parts"].values() if p is not None]
            self.assertAlmostEqual(sum(bill), energy["change"], delta=1e-12 * energy["swing"])
        self.assertIsNone(methods[2]["error"]["parts"]["formulation"])
        self.assertIsNone(methods[2]["error"]["parts"]["rounding"])
        # a million steps do not fit, and that is said in place of the account
        self.assertEqual(methods[3]["state"], "refused")
        self.assertIn("200000 steps", methods[3]["reason"])

    def test_the_table_names_every_part_and_a_file_holds_the_same_document(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "budget.json")
            done = call("study", "fb0", "budget", "--time", "0.5", "--methods", METHODS[0], "--out", path)
            self.assertEqual(done.returncode, DONE, done.stderr)
            for word in ("truncation", "formulation", "projection", "drift", "solve", "rounding", "their sum", "outside", "nrad"):
                self.assertIn(word, done.stdout)
            with open(path, encoding="utf-8") as f:
                self.assertEqual(json.load(f)["methods"][0]["method"], "index1@rk4:h=0.01")

    def test_options_of_other_kinds_and_names_that_tell_no_form_are_refused(self):
        for words, said in (
            (["--levels", "3"], "--levels"),
            (["--out", "budget.txt"], ".json"),
            (["--methods", "projecton@rk4"], "projection"),
            (["--time", "-1"], "above 0"),
        ):
            done = call("study", "fb0", "budget", *words)
            self.assertEqual(done.returncode, INPUT, words)
            self.assertIn(said, done.stderr)


if __name__ == "__main__":
    driver.main()
