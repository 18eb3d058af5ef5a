# SPDX-License-Identifier: GPL-3.0-or-later
"""Work-precision studies from the command line: documents that agree, what is kept when a study is cut short, reports without network."""

import csv
import io
import json
import os
import re
import signal
import subprocess
import resource
import sys
import tempfile
import time
import unittest

sys.path.insert(0, os.path.dirname(__file__))
import studies  # noqa: E402
from studies import DONE, ENDED, INPUT, call, driver, strict  # noqa: E402

METHODS = ["projection@rk4", "projection@dopri5", "nullspace-as-printed@rk4"]
SMALL = ["study", "fb0", "work-precision", "--methods", *METHODS, "--time", "1", "--levels", "5", "--samples", "0"]


def without_times(document):
    """The same on every run: counts, errors, verdicts; not what a clock said."""
    document = dict(document, elapsed=None, pareto=[p for p in document["pareto"] if p["cost"] != "time"])
    for method in document["methods"]:
        for point in method["points"]:
            point.pop("cpu", None)
    return json.dumps(document, sort_keys=True)


class Study(unittest.TestCase):
    def setUp(self):
        self.kept = tempfile.TemporaryDirectory()
        self.folder = self.kept.name

    def tearDown(self):
        self.kept.cleanup()

    def path(self, name):
        return os.path.join(self.folder, name)

    def test_json_tells_errors_counts_verdicts_and_who_is_cheapest(self):
        done = call([*SMALL, "--json"], self.folder)
        self.assertEqual(done.returncode, DONE, done.stderr)
        study = strict(done.stdout)
        self.assertTrue(study["finished"])
        self.assertGreater(study["reference"]["digits"], 12)
        self.assertEqual([m["method"] for m in study["methods"]], METHODS)
        kinds = [m["class"]["kind"] for m in study["methods"]]
        self.assertEqual(kinds, ["converges", "converges", "elsewhere"])
        self.assertAlmostEqual(study["methods"][0]["class"]["order"], 4, delta=0.2)
        for method in study["methods"]:
            self.assertEqual(len(method["points"]), 5)
            for point in method["points"]:
                self.assertEqual(point["state"], "done")
                self.assertEqual(set(point["worst"]), {"q", "v", "reaction", "gap", "velocity_gap", "energy"})
                for name, value in point["worst"].items():
                    self.assertGreaterEqual(value, point["end"][name])
        front = next(p for p in study["pareto"] if p["cost"] == "operations" and p["error"] == "q")
        for band in front["bands"]:
            self.assertNotEqual(band["best"]["method"], METHODS[2], "a wrong model is not the cheapest")
        # closed to rounding, and wrong: the gap says nothing about the motion
        printed = study["methods"][2]["points"][-1]
        self.assertLess(printed["worst"]["gap"], 1e-12)
        self.assertGreater(printed["worst"]["q"], 1e-3)

    def test_a_reference_whose_halves_share_no_digit_is_called_none(self):
        # the ring is chaotic: its two references part after 2.4 s
        words = ["study", "ring", "work-precision", "--methods", "projection@rk4", "--time", "8", "--levels", "2", "--samples", "0"]
        text = call([*words, "--out", self.path("r.html")], self.folder)
        self.assertEqual(text.returncode, DONE, text.stderr)
        said = text.stdout.decode()
        self.assertRegex(said, r"Reference: none of the coordinates: .* share no digit at t = 8 s\. They agree up to about t = 2\.\d s: try --time 2\.\d\.")
        with open(self.path("r.html"), encoding="utf-8") as f:
            page = f.read()
        self.assertIn("shares no digit of the coordinates with it at the end", page)
        self.assertNotRegex(said + page, r"agrees? to -\d")

    def test_csv_and_json_hold_the_same_numbers(self):
        done = call([*SMALL, "--csv", "--out", self.path("s.json")], self.folder)
        self.assertEqual(done.returncode, DONE, done.stderr)
        rows = list(csv.DictReader(io.StringIO(done.stdout.decode())))
        with open(self.path("s.json"), encoding="utf-8") as f:
            study = strict(f.read())
        points = [p for m in study["methods"] for p in m["points"]]
        self.assertEqual(len(rows), len(points))
        for row, point in zip(rows, points):
            self.assertEqual(float(row["worst_q"]), point["worst"]["q"])
            self.assertEqual(float(row["end_energy"]), point["end"]["energy"])
            self.assertEqual(int(row["evaluations"]), point["evaluations"])

    def test_the_table_names_every_method_and_draws_them(self):
        done = call(SMALL, self.folder)
        text = done.stdout.decode()
        self.assertEqual(done.returncode, DONE, done.stderr)
        for method in METHODS:
            self.assertIn(method, text)
        self.assertIn("converges to another motion", text)
        self.assertIn("converges with order", text)
        self.assertIn("Times: errors are the largest at 1024 times, evenly over the run.\n", text)
        self.assertRegex(text, "[\u2801-\u28ff]", "braille")
        self.assertRegex(text, r"Cheapest by operations, for errors up to t = [\d.]+ s\n")
        self.assertNotIn("nan", text)
        for words in (SMALL, ["inspect", "fb0"], ["list", "scenes"]):
            plain = call(words, self.folder, LC_ALL="C").stdout
            self.assertTrue(plain.isascii() and b"?" not in plain, "a locale without UTF-8")

    def test_the_report_is_one_file_that_asks_no_network(self):
        done = call([*SMALL, "--out", self.path("report.html")], self.folder)
        self.assertEqual(done.returncode, DONE, done.stderr)
        with open(self.path("report.html"), encoding="utf-8") as f:
            text = f.read()
        studies.assert_page(self, text)
        self.assertIn("In this study errors are the largest at 1024 times, evenly over the run", text)
        self.assertEqual(text.count("<svg viewBox=\"0 0 900"), 12, "6 errors x 2 costs that were measured")
        for method in METHODS:
            self.assertIn(method, text)

    def test_the_errors_of_a_study_hold_between_its_times(self):
        def motion(method):
            words = ["run", "four-bar", "--method", method, "--time", "10", "--every", str(10 / 2048), "--json"]
            return strict(call(words, self.folder).stdout)["samples"]["q"]
        words = ["study", "four-bar", "--methods", "nullspace@rk4", "--levels", "5", "--samples", "0", "--time-limit", "0", "--json"]
        study = strict(call(words, self.folder).stdout)
        self.assertEqual(study["reference"]["times"], 1024)
        point = study["methods"][0]["points"][-1]
        true, q = motion("projection@dop853:rtol=1e-12"), motion(point["method"])
        error = [max(abs(a - b) for a, b in zip(*rows)) for rows in zip(true, q)]
        self.assertEqual(len(error), 2049)
        # the largest at every second time is that at all times; at 32 times alone it is two thirds of it
        self.assertAlmostEqual(max(error) / point["worst"]["q"], 1, delta=0.02)
        self.assertGreater(max(error), 1.4 * max(error[::64]))

    def test_a_refusal_is_told_once_for_all_sizes(self):
        # the motor's torque depends on the speed
        words = ["study", "quick-return", "--methods", "projection@rk4", "index3@rattle", "--time", "0.1", "--levels", "4", "--samples", "0"]
        done = call(words, self.folder)
        told = [line for line in done.stdout.decode().split("Runs that did not reach the end")[1].splitlines() if "rattle" in line]
        self.assertEqual(len(told), 1, told)
        self.assertIn("and 3 other sizes: a force depends on velocities", told[0])

    def test_what_is_at_fault_is_told(self):
        for words, said in (
            (["study", "fb0", "work-precison"], b"no study called 'work-precison'"),
            (["study", "fb0", "--methods", "index1@rk5"], b"rk5"),
            (["study", "fb0", "--levels", "99"], b"2 to 10"),
            (["study", "fb0", "--time", "-1"], b"are allowed"),
            (["study", "fb0", "--out", "x.pdf"], b"does not choose a form"),
            (["study", "fb0", "--samples", "1000"], b"0 to 10 are allowed"),
            (["study", "fb0", "--time-limit", "0", "--out", "/no/such/folder/x.html"], b"cannot write"),
            (["extreme", "--out", "/no/such/folder/x.html"], b"cannot write"),
            (["study", "fb0", "--json", "--csv"], b"JSON and CSV at once"),
        ):
            done = call(words, self.folder)
            self.assertEqual(done.returncode, INPUT, words)
            self.assertIn(said, done.stderr + done.stdout)

    def test_a_second_study_reads_the_reference_and_counts_the_same(self):
        first = strict(call([*SMALL, "--json"], self.folder).stdout)
        kept = os.listdir(self.folder)
        self.assertEqual([k.split("-")[0] for k in kept], ["reference"], "nothing is left of a finished study")
        second = strict(call([*SMALL, "--json"], self.folder).stdout)
        self.assertEqual(without_times(first), without_times(second))
        # a reference that was cut short is not used
        with open(self.path(kept[0]), "r+b") as f:
            f.truncate(100)
        third = strict(call([*SMALL, "--json"], self.folder).stdout)
        self.assertEqual(without_times(first), without_times(third))

    def test_a_study_killed_ten_times_ends_as_an_undisturbed_one(self):
        words = ["study", "fb0", "work-precision", "--methods", *METHODS, "--time", "4", "--levels", "6", "--samples", "2", "--json"]
        whole = tempfile.TemporaryDirectory()
        undisturbed = strict(call(words, whole.name).stdout)
        whole.cleanup()
        self.assertGreaterEqual(studies.kill_often(words, self.folder, "study", 5), 3)
        done = call(words, self.folder)
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertEqual(without_times(strict(done.stdout)), without_times(undisturbed))

    def test_an_interrupt_keeps_what_is_done_and_the_same_command_goes_on(self):
        words = ["study", "fb0", "--methods", *METHODS, "--time", "2", "--samples", "3", "--json", "--time-limit", "0"]
        for how in (signal.SIGINT, signal.SIGTERM):
            with tempfile.TemporaryDirectory() as folder:
                status, out, err = studies.interrupt(words, folder, "study", how)
                self.assertEqual(status, ENDED, err)
                study = strict(out)
                self.assertTrue(study["stopped"])
                self.assertIn("continues from here", err)
                done = sum(p["state"] == "done" for m in study["methods"] for p in m["points"])
                text = call([w for w in words if w != "--json"], folder)
                self.assertEqual(text.returncode, DONE)
                found = re.search(rb"continuing with (\d+) points", text.stderr)
                self.assertEqual(int(found.group(1)) if found else 0, done)

    def test_an_end_before_anything_is_finished_says_so(self):
        """It said "stopped on request" alone, and nothing of what had become of the work."""
        # the reference motion alone takes seconds; the signal comes as soon as it is caught
        argv, env = studies.command(["study", "stewart-6-6", "work-precision", "--time-limit", "0"], self.folder)
        with subprocess.Popen(argv, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            def is_caught():
                with open(f"/proc/{process.pid}/status", encoding="ascii") as f:
                    caught = int(re.search(r"SigCgt:\s*([0-9a-f]+)", f.read()).group(1), 16)
                return caught >> (signal.SIGTERM - 1) & 1

            self.assertTrue(driver.until(is_caught, 60, 0.002))
            process.send_signal(signal.SIGTERM)
            _, err = process.communicate(timeout=60 * driver.SLOW)
        self.assertEqual(process.returncode, ENDED, err)
        self.assertIn("nothing was finished yet", err.decode())

    def test_time_left_is_shown_and_again_when_the_study_goes_on(self):
        words = ["study", "fb0", "--methods", *METHODS, "--time", "4", "--samples", "10", "--time-limit", "0"]
        status, seen = studies.watch_terminal(words, self.folder, interrupt=True)
        self.assertEqual(status, ENDED)
        self.assertRegex(seen, r"work-precision \[[#.]+\] +\d+ %, \d+ (s|min) left")
        status, seen = studies.watch_terminal(words, self.folder)
        self.assertEqual(status, DONE)
        left = [(int(a), int(b)) for a, b in re.findall(r"(\d+) %, (\d+) s left", seen)]
        self.assertTrue(left)
        shares = [a for a, _ in left]
        self.assertGreater(shares[-1], 90)

    def test_a_budget_is_kept_and_what_it_left_out_is_told(self):
        words = ["study", "fb0", "--time", "10", "--time-limit", "2", "--json"]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = call(words, self.folder)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        study = strict(done.stdout)
        self.assertEqual(done.returncode, DONE, done.stderr)
        # of computing time, which is all of it on a quiet machine and does not grow on a busy one
        self.assertLess(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 2 * 1.1 * driver.SLOW)
        skipped = [p for m in study["methods"] for p in m["points"] if p["state"] == "skipped"]
        self.assertTrue(skipped or not study["finished"])
        for p in skipped:
            self.assertIn("time limit", p["reason"])


if __name__ == "__main__":
    driver.main()
