"""The report over several scenes: one page that asks no network, plots as files, what it counts, and what a cut leaves."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree
from html.parser import HTMLParser

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402

DONE, INPUT, ENDED = 0, 2, 4
METHODS = ["index1@rk4", "projection@rk4", "nullspace-as-printed@rk4"]
SMALL = ["report", "fb0", "n-four-bar", "--methods", *METHODS, "--levels", "4", "--samples", "0", "--budget", "0"]
VOID = {"meta", "input", "br", "circle", "path", "rect"}


def command(words, folder):
    return [driver.PROGRAM, *words], dict(os.environ, HOLONOM_CACHE=folder)


def call(words, folder):
    argv, env = command(words, folder)
    return subprocess.run(argv, capture_output=True, env=env, timeout=200 * driver.SLOW)


def strict(text):
    def refuse(word):
        raise ValueError("JSON holds " + word)

    return json.loads(text, parse_constant=refuse)


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

    def test_parts_of_an_account_add_up(self):
        accounts = [a for a in self.report["scenes"][0]["accounts"] if a["status"] == "HN_OK"]
        self.assertEqual(len(accounts), 3)
        for a in accounts:
            parts = sum(v for v in a["parts"].values() if v is not None)
            self.assertAlmostEqual(parts / a["sum"], 1, delta=1e-9)
            # to first order in the error
            self.assertAlmostEqual(a["sum"] / a["error"], 1, delta=0.05)
            bill = sum(v for v in a["bill"].values() if v is not None)
            self.assertLess(abs(bill - a["energy"]), 1e-3 * abs(a["energy"]) + 1e-12)

    def test_the_page_is_one_file_that_asks_no_network(self):
        with open(self.page, encoding="utf-8") as f:
            text = f.read()
        self.assertNotRegex(text, r"https?://|src=|@import|url\(|<link|fetch\(|XMLHttpRequest")
        self.assertNotRegex(text, r">[^<]*\b(nan|inf)\b[^<]*<")
        for method in METHODS:
            self.assertIn(method, text)
        self.assertIn("survived 24 of 24", text)
        self.assertIn("No account of errors and energy", text)
        self.assertIn("not chaotic: with one freedom", text)
        ids = re.findall(r'\bid="([^"]*)"', text)
        self.assertEqual(len(ids), len(set(ids)), "no id twice")
        for anchor in re.findall(r'href="#([^"]*)"', text):
            self.assertIn(anchor, ids)
        open_tags = []

        class Balance(HTMLParser):
            def handle_starttag(self, tag, attrs):
                if tag not in VOID:
                    open_tags.append(tag)

            def handle_startendtag(self, tag, attrs):
                pass

            def handle_endtag(self, tag):
                assert open_tags.pop() == tag, tag

        Balance().feed(text)
        self.assertEqual(open_tags, [])

    def test_every_plot_is_a_file_of_its_own(self):
        names = sorted(os.listdir(self.plots))
        svgs = [n for n in names if n.endswith(".svg")]
        # six errors by two costs that were counted, for each; accounts of the one that has some, survival of the other
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
        self.assertFalse([n for n in os.listdir(self.kept.name) if n.startswith("study")])
        again = strict(call([*SMALL, "--json"], self.kept.name).stdout)
        self.assertEqual(without_clocks(again), without_clocks(strict(self.done.stdout)))

    def test_an_interrupt_keeps_scenes_that_are_done(self):
        words = ["report", "fb0", "seven-body-squeezer", "--methods", *METHODS, "--json", "--budget", "100"]
        with tempfile.TemporaryDirectory() as folder:
            argv, env = command(words, folder)
            with subprocess.Popen(argv, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
                deadline = time.monotonic() + 60 * driver.SLOW
                while time.monotonic() < deadline and not any(k.startswith("study") for k in os.listdir(folder)):
                    time.sleep(0.02)
                time.sleep(0.3 * driver.SLOW)
                process.send_signal(signal.SIGINT)
                out, err = process.communicate(timeout=60 * driver.SLOW)
            self.assertEqual(process.returncode, ENDED, err)
            report = strict(out)
            self.assertTrue(report["stopped"])
            self.assertIn(b"goes on from here", err)
            self.assertIn("not begun", report["scenes"][1]["reason"])
            self.assertTrue([k for k in os.listdir(folder) if k.startswith("study")])

    def test_what_is_at_fault_is_told(self):
        for words, said in (
            (["report", "fb-0"], b"fb0"),
            (["report", "fb0", "--methods", "index1@rk5"], b"rk5"),
            (["report", "fb0", "--levels", "99"], b"2 to 10"),
            (["report", "fb0", "--budget", "-3"], b"above 0"),
            (["report", "fb0", "--out", "x.pdf"], b"cannot be told from its name"),
        ):
            done = call(words, self.kept.name)
            self.assertEqual(done.returncode, INPUT, words)
            self.assertIn(said, done.stderr + done.stdout)


if __name__ == "__main__":
    driver.main()
