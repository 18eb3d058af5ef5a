# SPDX-License-Identifier: GPL-3.0-or-later
"""Where errors and energy come from, from the command line: the parts add up, and what cannot be told is null."""

import csv
import io
import json
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(__file__))
import studies  # noqa: E402
from studies import DONE, ENDED, INPUT, driver, strict  # noqa: E402

METHODS = ["index1@rk4:h=1e-2", "projection@rk4:h=1e-2", "ggl@radau5:rtol=1e-6", "projection@rk4:h=1e-6"]


SECONDS = ["study", "fb0", "budget", "--time", "4", "--methods", "index1@rk4:h=2e-3", "projection@rk4:h=2e-3", "baumgarte@rk4:h=2e-3",
           "nullspace@rk4:h=2e-3", "partitioning@rk4:h=2e-3", "index1@rk4:h=1e-3"]


def call(*words):
    """With a folder of its own for what is unfinished."""
    with tempfile.TemporaryDirectory() as folder:
        return studies.call(words, folder, text=True)


class Budget(unittest.TestCase):
    def test_flows_that_cannot_be_followed_are_told_with_figures(self):
        done = call("study", "bennett", "budget", "--time", "0.3", "--methods", "udwadia-kalaba@rk4:h=0.1", "--json")
        row = strict(done.stdout)["methods"][0]
        failure = row["failure"]
        self.assertEqual((row["state"], failure["code"], failure["quantity"], failure["limit"]), ("refused", "no-convergence", "t", 0.3))
        self.assertEqual(failure["value"], failure["t"])
        self.assertTrue(0 <= failure["value"] < 0.3, failure)
        self.assertEqual(failure["message"], row["reason"])

    def test_a_coordinate_without_a_unit_has_none_in_the_table(self):
        scene = {"holonom": 1, "name": "bare", "title": "A number that swings", "start": {"positions": {"u": 1}},
                 "lagrangian": {"coordinates": [{"name": "u", "rate": "v", "unit": "1"}], "kinetic": "v^2/2", "potential": "2*u^2"}}
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "bare.json")
            with open(path, "w", encoding="utf-8") as f:
                json.dump(scene, f)
            text = call("study", path, "budget", "--time", "1", "--methods", METHODS[0]).stdout
            self.assertIn("  u [1] ", text)
            found = strict(call("study", path, "budget", "--time", "1", "--methods", METHODS[0], "--json").stdout)
        self.assertEqual([m["error"]["unit"] for m in found["methods"]], ["1"])

    def test_json_adds_up_and_says_what_cannot_be_told(self):
        done = call("study", "fb0", "budget", "--time", "1", "--methods", *METHODS, "--json")
        self.assertEqual(done.returncode, DONE, done.stderr)
        methods = strict(done.stdout)["methods"]
        self.assertEqual([m["method"] for m in methods[:2]], ["index1@rk4:h=0.01", "projection@rk4:h=0.01"])
        for m in methods[:3]:
            self.assertEqual(m["state"], "done")
            error, energy = m["error"], m["energy"]
            parts = [p for p in error["parts"].values() if p is not None]
            self.assertAlmostEqual(sum(parts) / error["value"], 1, delta=1e-3)  # first order in the error
            parts = [p for p in energy["parts"].values() if p is not None]
            self.assertAlmostEqual(sum(parts), energy["change"], delta=1e-12 * energy["swing"])
        self.assertIsNone(methods[2]["error"]["parts"]["formulation"])
        self.assertIsNone(methods[2]["error"]["parts"]["rounding"])
        # a million steps do not fit, and that is said in place of the budget
        self.assertEqual(methods[3]["state"], "refused")
        self.assertIn("200000 steps", methods[3]["reason"])

    def test_where_first_order_has_ended_that_is_said_and_no_bars_are_drawn(self):
        method = "index1@rk4:h=0.01"
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "budget.html")
            done = call("study", "four-bar", "budget", "--methods", method, "--json", "--out", path)
            error = strict(done.stdout)["methods"][0]["error"]
            with open(path, encoding="utf-8") as f:
                page = f.read()
        # 1.27 rad of parts against an error of 1.78 rad
        self.assertAlmostEqual(error["mismatch"], abs(1 - error["sum"] / error["value"]), delta=1e-9)
        self.assertGreater(error["mismatch"], 0.2)
        self.assertFalse(error["holds"])
        self.assertEqual(error["holds_until"], 5)
        self.assertIn("the error is too large to be split", page)
        errors, energies = page.split("Causes that put energy in", 1)
        self.assertNotIn('<g class="part">', errors)
        self.assertIn('<g class="part">', energies)
        # the table marks the sum and says so below, before the energy; drawn, a sentence replaces the bars
        words = ["study", "four-bar", "budget", "--methods", method]
        table = call(*words).stdout.split("\nEnergy put in")[0]
        self.assertRegex(table, r"1\.27\*")
        self.assertIn(f"  * {method}: the error is too large to be split", table)
        self.assertIn("at t = 5 s the parts still added up to the error, within 10 %", " ".join(table.split()))
        drawn = call(*words, "--plot").stdout.split("\nEnergy put in")[0]
        self.assertIn("the error is too large to be split", drawn)
        self.assertNotIn("truncation", drawn)
        # and until then they do add up
        shorter = strict(call("study", "four-bar", "budget", "--methods", method, "--time", "5", "--json").stdout)["methods"][0]["error"]
        self.assertTrue(shorter["holds"])
        self.assertLess(shorter["mismatch"], 0.1)

    def test_the_table_names_every_part_and_a_file_holds_the_same_document(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "budget.json")
            done = call("study", "fb0", "budget", "--time", "0.5", "--methods", METHODS[0], "--out", path)
            self.assertEqual(done.returncode, DONE, done.stderr)
            for word in ("truncation", "formulation", "projection", "drift", "solve", "rounding", "their sum", "error at the end", "outside", "a2 [rad]"):
                self.assertIn(word, done.stdout)
            with open(path, encoding="utf-8") as f:
                self.assertEqual(json.load(f)["methods"][0]["method"], "index1@rk4:h=0.01")

    def test_the_error_of_a_chosen_coordinate_is_split(self):
        methods = ["projection@rk4:h=1e-2", "nullspace@rk4:h=1e-2"]
        words = ["study", "fb0", "budget", "--time", "0.5", "--methods", *methods, "--json"]
        largest = strict(call(*words).stdout)["methods"]
        self.assertNotEqual({m["error"]["coordinate"] for m in largest}, {"th1"})
        chosen = strict(call(*words, "--coordinate", "th1").stdout)["methods"]
        for free, of in zip(largest, chosen):
            self.assertEqual(of["error"]["coordinate"], "th1")
            self.assertNotEqual(of["error"]["value"], free["error"]["value"])
            self.assertLess(of["error"]["mismatch"], 0.1, "the parts add up to the error of this one")

    def test_csv_and_page_tell_what_json_tells(self):
        words = ["study", "fb0", "budget", "--time", "0.5", "--methods", *METHODS]
        document = strict(call(*words, "--json").stdout)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "budget.html")
            rows = list(csv.DictReader(io.StringIO(call(*words, "--csv", "--out", path).stdout)))
            with open(path, encoding="utf-8") as f:
                page = f.read()
        self.assertEqual([r["method"] for r in rows], [m["method"] for m in document["methods"]])
        for row, m in zip(rows, document["methods"]):
            self.assertEqual((row["state"], row["reason"]), (m["state"], m["reason"]))
            for prefix, whole, parts in (("error_", "error", m.get("error")), ("energy_", "energy_change", m.get("energy"))):
                told = {whole: parts.get("value", parts.get("change")), **{prefix + n: v for n, v in parts["parts"].items()}} if parts else {whole: None}
                for name, value in told.items():
                    self.assertEqual(float(row[name]) if row[name] else None, value, name)
        studies.assert_page(self, page)
        self.assertEqual(page.count("<svg"), 2)
        for text in (*[m["method"] for m in document["methods"]], "an error budget can have at most 200000 steps", "Causes that put energy in"):
            self.assertIn(text, page)
        # a block of its colour a part, its number where it is pointed at
        self.assertRegex(page, r"<g class=\"part\"><title>truncation: [+\u2212][0-9.]+ .rad</title>")

    def test_ctrl_c_keeps_what_is_done_and_the_same_command_goes_on(self):
        with tempfile.TemporaryDirectory() as folder:
            status, out, err = studies.interrupt([*SECONDS, "--json"], folder, "budget")
            self.assertEqual(status, ENDED, err)
            self.assertIn("stopped on request; the same command continues from here", err)
            states = [m["state"] for m in strict(out)["methods"]]
            self.assertEqual(len(states), 6)
            self.assertEqual(sorted(set(states)), ["done", "left out"])
            done = studies.call(SECONDS, folder, text=True)
            self.assertEqual(done.returncode, DONE, done.stderr)
            self.assertIn(f"continuing with {states.count('done')} methods of an earlier run", done.stderr)
            self.assertEqual(studies.journals(folder, "budget"), [], "nothing is left of whole budgets")

    def test_time_left_is_shown(self):
        with tempfile.TemporaryDirectory() as folder:
            status, seen = studies.watch_terminal(["study", "fb0", "budget", "--time", "60", "--methods", "index1@rk4:h=1e-3", "projection@rk4:h=1e-3"], folder, interrupt=True)
        self.assertEqual(status, ENDED, seen)
        self.assertRegex(seen, r"budget \[[#.]+\] +\d+ %, \d+ (?:s|min) left")

    def test_killed_ten_times_it_ends_with_the_bytes_of_an_undisturbed_one(self):
        undisturbed = call(*SECONDS, "--json")
        with tempfile.TemporaryDirectory() as folder:
            self.assertGreaterEqual(studies.kill_often(SECONDS, folder, "budget", 11), 3)
            done = studies.call([*SECONDS, "--json"], folder, text=True)
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertEqual(done.stdout, undisturbed.stdout)

    def test_options_of_other_kinds_and_names_that_tell_no_form_are_refused(self):
        for words, said in (
            (["--levels", "3"], "kind budget has no 'levels'"),
            (["--out", "budget.txt"], "end it in .html, .json or .csv"),
            (["--json", "--csv"], "JSON and CSV at once"),
            (["--methods", "projecton@rk4"], "projection"),
            (["--time", "-1"], "are allowed"),
            (["--coordinate", "th9"], "one of th1, a2, th3"),
        ):
            done = call("study", "fb0", "budget", *words)
            self.assertEqual(done.returncode, INPUT, words)
            self.assertIn(said, done.stderr + done.stdout)


if __name__ == "__main__":
    driver.main()
