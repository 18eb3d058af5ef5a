# SPDX-License-Identifier: GPL-3.0-or-later
"""The report over several scenes: one page that asks no network, plots as files, what it counts, and what a cut leaves."""

import json
import os
import re
import shutil
import sys
import tempfile
import unittest
import xml.etree.ElementTree

sys.path.insert(0, os.path.dirname(__file__))
import studies  # noqa: E402
from studies import DONE, ENDED, INPUT, call, driver, strict  # noqa: E402

METHODS = ["index1@rk4", "projection@rk4", "nullspace-as-printed@rk4"]
SMALL = ["report", "fb0", "n-four-bar", "--methods", *METHODS, "--levels", "4", "--samples", "0", "--time-limit", "0"]


def without_clocks(report):
    """What a second run has to say again; one that was cut was not told the same times."""
    for scene in report["scenes"]:
        scene["study"].pop("elapsed")
    return json.dumps(report["scenes"], sort_keys=True)


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.kept = tempfile.TemporaryDirectory()
        cls.page = os.path.join(cls.kept.name, "report.html")
        cls.plots = os.path.join(cls.kept.name, "plots")
        cls.done = call([*SMALL, "--json", "--out", cls.page, "--plots", cls.plots], cls.kept.name)
        cls.report = strict(cls.done.stdout) if cls.done.returncode == DONE else None

    @classmethod
    def tearDownClass(cls):
        cls.kept.cleanup()

    def test_it_answers_per_scene_and_accuracy(self):
        self.assertEqual(self.done.returncode, DONE, self.done.stderr)
        self.assertEqual([s["scene"] for s in self.report["scenes"]], ["fb0", "n-four-bar"])
        for scene in self.report["scenes"]:
            self.assertEqual([a["accuracy"] for a in scene["answers"]], [1e-3, 1e-6, 1e-9])
        four_bar = self.report["scenes"][0]
        self.assertNotIn(METHODS[2], [a["method"] for a in four_bar["answers"]], "a wrong model is nobody's answer")
        printed = four_bar["verdicts"][2]
        self.assertRegex(printed["verdict"], "^(elsewhere|fails)")
        self.assertTrue(printed["why"])

    def test_only_the_scene_with_flat_poses_is_singular_and_survivors_are_counted(self):
        plain, ladder = self.report["scenes"]
        self.assertIsNone(plain["singular_at"])
        self.assertNotIn("survival", plain)
        self.assertGreater(ladder["singular_at"], 0)
        index1, projection, _ = ladder["survival"]
        self.assertEqual(index1["tried"], 24)
        # the same as the table of the ladder of two four-bars says: nobody, and everybody
        self.assertEqual(index1["survived"], 0)
        self.assertEqual(projection["survived"], projection["tried"])
        for strip in ladder["survival"]:
            self.assertNotIn("silent", [run["end"] for run in strip["runs"]])
            self.assertEqual(strip["survived"], sum(run["end"] == "survived" for run in strip["runs"]))
            for run in strip["runs"]:
                self.assertLessEqual(run["t"], 10)

    def test_parts_of_a_budget_add_up(self):
        budgets = [a for a in self.report["scenes"][0]["budgets"] if a["state"] == "done"]
        self.assertEqual(len(budgets), 3)
        for a in budgets:
            parts = sum(v for v in a["error"]["parts"].values() if v is not None)
            self.assertAlmostEqual(parts / a["error"]["sum"], 1, delta=1e-9)
            # to first order in the error
            self.assertAlmostEqual(a["error"]["sum"] / a["error"]["value"], 1, delta=0.05)
            parts = sum(v for v in a["energy"]["parts"].values() if v is not None)
            self.assertLess(abs(parts - a["energy"]["change"]), 1e-3 * abs(a["energy"]["change"]) + 1e-12)

    def test_the_page_is_one_file_that_asks_no_network(self):
        with open(self.page, encoding="utf-8") as f:
            text = f.read()
        studies.assert_page(self, text, scripts=True)
        for method in METHODS:
            self.assertIn(method, text)
        self.assertIn("survived 24 of 24", text)
        self.assertIn("No budget of errors and energy", text)
        self.assertIn("not chaotic: one degree of freedom", text)
        ids = re.findall(r'\bid="([^"]*)"', text)
        self.assertEqual(len(ids), len(set(ids)), "no id twice")
        for anchor in re.findall(r'href="#([^"]*)"', text):
            self.assertIn(anchor, ids)

    def test_it_begins_with_what_the_answers_come_to(self):
        with open(self.page, encoding="utf-8") as f:
            text = f.read()
        said = re.findall("<li>(.*?)</li>", re.search('<ul class="answers">(.*?)</ul>', text).group(1))
        answers = [a["method"] for s in self.report["scenes"] for a in s["answers"] if a["method"]]
        best = max(METHODS, key=answers.count)
        self.assertTrue(said[0].startswith(f"Cheapest: {best} in {answers.count(best)} of {len(answers)}"), said)
        # projection alone closes the loops and passes the flat poses with every size
        self.assertRegex(said[1], "^These methods reach the end at every size in every scene, .*: projection@rk4.$")
        self.assertIn("Methods that fail at some or all sizes in fb0: nullspace-as-printed@rk4.", said)
        self.assertIn("Ranked by operations: no time was measured.", said)

    def test_tables_have_heads_and_headings_go_down_one_level_at_a_time(self):
        with open(self.page, encoding="utf-8") as f:
            text = f.read()
        rows = re.findall("<tr>(.*?)</tr>", text, re.S)
        self.assertGreater(len(rows), 20)
        for row in rows:
            self.assertRegex(row, "^<th", "each row begins with what it is of")
        levels = [int(n) for n in re.findall(r"<h(\d)", text)]
        self.assertEqual(levels[0], 1)
        for above, below in zip(levels, levels[1:]):
            self.assertLessEqual(below, above + 1)
        for svg in re.findall("<svg [^>]*>", text):
            self.assertRegex(svg, 'role="img" aria-label="[^"]{10}|aria-hidden="true"')
        for box in re.findall("<input [^>]*>", text):
            self.assertRegex(box, 'aria-label="(error of|against) ')

    def test_every_plot_is_a_file_of_its_own(self):
        names = sorted(os.listdir(self.plots))
        svgs = [n for n in names if n.endswith(".svg")]
        # six errors by two costs that were counted, for each; budgets of the one that has some, survival of the other
        self.assertEqual(len(svgs), 2 * 12 + 2 + 1, svgs)
        for name in svgs:
            with open(os.path.join(self.plots, name), encoding="utf-8") as f:
                text = f.read()
            self.assertNotIn("var(", text, "not every reader knows variables")
            xml.etree.ElementTree.fromstring(text.encode())
        if shutil.which("rsvg-convert"):
            self.assertEqual(len(names), 2 * len(svgs))
            with open(os.path.join(self.plots, svgs[0][:-3] + "png"), "rb") as f:
                self.assertEqual(f.read(8), b"\x89PNG\r\n\x1a\n")

    def test_nothing_is_left_of_a_whole_report_and_a_second_counts_the_same(self):
        self.assertFalse(studies.journals(self.kept.name, "study"))
        again = strict(call([*SMALL, "--json"], self.kept.name).stdout)
        self.assertEqual(without_clocks(again), without_clocks(strict(self.done.stdout)))

    def test_an_interrupt_keeps_scenes_that_are_done(self):
        words = ["report", "fb0", "seven-body-squeezer", "--methods", *METHODS, "--json", "--time-limit", "100"]
        with tempfile.TemporaryDirectory() as folder:
            status, out, err = studies.interrupt(words, folder, "study")
            self.assertEqual(status, ENDED, err)
            report = strict(out)
            self.assertTrue(report["stopped"])
            self.assertIn("continues from here", err)
            self.assertIn("not begun", report["scenes"][1]["reason"])
            self.assertTrue(studies.journals(folder, "study"))

    def test_what_is_at_fault_is_told(self):
        for words, said in (
            (["report", "fb-0"], b"fb0"),
            (["report", "fb0", "--methods", "index1@rk5"], b"rk5"),
            (["report", "fb0", "--levels", "99"], b"2 to 10"),
            (["report", "fb0", "--time-limit", "-3"], b"are allowed"),
            (["report", "fb0", "--out", "x.pdf"], b"does not choose a form"),
        ):
            done = call(words, self.kept.name)
            self.assertEqual(done.returncode, INPUT, words)
            self.assertIn(said, done.stderr + done.stdout)


if __name__ == "__main__":
    driver.main()
