# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies in parts: whatever the number of parts, their order, repetition and overlap, and whatever happens to one on the way, together they are
the study of one process; parts that do not belong together are refused by the field."""

import json
import os
import shutil
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(__file__))
import studies  # noqa: E402
from studies import DONE, ENDED, INPUT, driver  # noqa: E402

METHODS = ["projection@rk4", "projection@dopri5", "nullspace-as-printed@rk4", "ggl@radau5"]
STUDY = ["study", "fb0", "work-precision", "--methods", *METHODS, "--time", "1", "--levels", "5"]
COUNTED = [*STUDY, "--samples", "0"]
CLOCK = ("cpu", "elapsed")


def other_value(words, option, value):
    """The words with another value of one option."""
    at = words.index(option) + 1
    return [*words[:at], value, *words[at + 1 :]]


def bytes_of(path):
    with open(path, "rb") as f:
        return f.read()


def without_clock(value):
    """A document without what a clock said: samples, medians, rankings by time."""
    if isinstance(value, dict):
        return {k: without_clock(v) for k, v in value.items() if k not in CLOCK}
    if isinstance(value, list):
        return [without_clock(v) for v in value if not (isinstance(v, dict) and v.get("cost") == "time")]
    return value


class Merge(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.kept = tempfile.TemporaryDirectory()
        cls.folder = cls.kept.name
        cls.whole = os.path.join(cls.folder, "whole")
        for ending in (".json", ".csv", ".html"):
            done = cls.call([*COUNTED, "--out", cls.whole + ending])
            assert done.returncode == DONE, done.stderr

    @classmethod
    def tearDownClass(cls):
        cls.kept.cleanup()

    @classmethod
    def cache(cls, name="cache"):
        os.makedirs(cls.path(name), exist_ok=True)
        return cls.path(name)

    @classmethod
    def call(cls, words):
        return studies.call(words, cls.cache())

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    @classmethod
    def parts(cls, n, study=COUNTED, only=None, tag=""):
        """Runs the parts that are not there yet; their files in order."""
        files = []
        for i in only or range(1, n + 1):
            file = cls.path(f"part{tag}-{i}-{n}.json")
            if not os.path.exists(file):
                done = cls.call([*study, "--shard", f"{i}/{n}", "--out", file])
                assert done.returncode == DONE, done.stderr
            files.append(file)
        return files

    def merged(self, files, ending=".json"):
        out = self.path("merged" + ending)
        done = self.call(["merge", *files, "--out", out])
        self.assertEqual(done.returncode, DONE, done.stderr)
        return bytes_of(out)

    def refused(self, files, *said):
        done = self.call(["merge", *files])
        self.assertEqual(done.returncode, INPUT, done.stdout[:200])
        for text in said:
            self.assertIn(text, done.stderr.decode())

    def edited(self, file, change):
        """A copy of a part with something changed."""
        with open(file, encoding="utf-8") as f:
            part = json.load(f)
        change(part)
        copy = self.path("edited.json")
        with open(copy, "w", encoding="utf-8") as f:
            json.dump(part, f)
        return copy

    def test_whatever_the_number_of_parts_the_merged_bytes_are_those_of_one_process(self):
        for n in (1, 2, 3, 7):
            files = self.parts(n)
            for ending in (".json", ".csv", ".html"):
                self.assertEqual(self.merged(files, ending), bytes_of(self.whole + ending), (n, ending))

    def test_more_parts_than_points_leave_some_empty_and_nothing_out(self):
        words = ["study", "fb0", "--methods", "projection@rk4", "--time", "0.5", "--levels", "2", "--samples", "0"]
        self.call([*words, "--out", self.path("two.json")])
        files = self.parts(4, words, tag="few")
        self.assertEqual(self.merged(files), bytes_of(self.path("two.json")))

    def test_order_repetition_and_overlap_change_nothing(self):
        whole = bytes_of(self.whole + ".json")
        three, two = self.parts(3), self.parts(2)
        self.assertEqual(self.merged(three[::-1]), whole)
        self.assertEqual(self.merged([*three, *three, three[1]]), whole)
        self.assertEqual(self.merged([*two, three[0], *self.parts(1)]), whole)
        # parts of different splits that are not whole by themselves
        seven = self.parts(7)
        points = {}
        for file in (*three[:2], *seven):
            points[file] = {(p["m"], p["k"]) for p in json.loads(bytes_of(file))["points"]}
        needed = [f for f in seven if points[f] - points[three[0]] - points[three[1]]]
        self.assertLess(len(needed), 7)
        self.assertEqual(self.merged([*three[:2], *needed]), whole)

    def test_tables_and_json_on_standard_output_are_those_of_one_process(self):
        files = self.parts(3)
        for option in ([], ["--json"], ["--csv"]):
            one = self.call([*COUNTED, *option])
            together = self.call(["merge", *files, *option])
            self.assertEqual(together.returncode, DONE, together.stderr)
            self.assertEqual(together.stdout, one.stdout)

    def test_missing_parts_are_named(self):
        self.refused([*self.parts(7, only=(1, 3))], "5 of 7 parts are missing: 2/7, 4/7, 5/7, 6/7, 7/7")
        self.refused([self.parts(2)[1]], "1 of 2 parts are missing: 1/2")

    def test_parts_of_another_study_are_refused_by_the_field(self):
        one = self.parts(2)[0]
        for tag, study, field in (
            ("t", other_value(COUNTED, "--time", "0.5"), "request/time"),
            ("l", other_value(COUNTED, "--levels", "4"), "request/levels"),
            ("s", [*STUDY, "--samples", "1"], "request/samples"),
            ("m", [w for w in COUNTED if w != "ggl@radau5"], "request/methods"),
            ("g", [*COUNTED, "--set", "l1=1.01"], "scene/hash"),
        ):
            other = self.parts(2, study, only=[2], tag=tag)[0]
            self.refused([one, other], "contradict each other in " + field, os.path.basename(one), os.path.basename(other))

    def test_parts_that_contradict_each_other_are_refused_by_the_field(self):
        one, two = self.parts(2)

        def set_build(part):
            part["build"] = "0.0.0 cc 1"

        def set_reference(part):
            part["reference"]["q"][5] += 1e-15

        def set_point(part):
            part["points"][3]["worst"][0] *= 1 + 1e-15

        self.refused([one, self.edited(two, set_build)], "contradict each other in build", "0.0.0 cc 1")
        self.refused([one, self.edited(two, set_reference)], "contradict each other in reference")
        self.refused([one, two, self.edited(two, set_point)], "contradict each other in worst of ")

    def test_what_is_no_part_is_told_as_such(self):
        one = self.parts(1)[0]
        junk = self.path("junk.json")
        for text in (b"", b"{", b"[]", b"null", b"{}", b"[" * 100000, bytes_of(one)[:-50], b"\x00\xff", bytes_of(self.whole + ".json")):
            with open(junk, "wb") as f:
                f.write(text)
            self.refused([junk], "is no part of a study")
        self.refused([self.path("nowhere.json")], "cannot read")
        self.refused([self.folder], "cannot read")
        for key, value in (("format", 99), ("of", 0), ("of", 1e9), ("shard", 2), ("shard", "1"), ("points", {})):
            self.refused([self.edited(one, lambda p: p.update({key: value}))], "is no part of a study")
        for path, value in (
            (["points", 0, "m"], 99), (["points", 0, "k"], -1), (["points", 0, "state"], 7), (["points", 0, "status"], 1e6),
            (["points", 0, "numbers"], [0, 1e300, 0]), (["points", 0, "worst"], [1]), (["points", 0, "q"], []),
            (["points", 0, "reason"], "x" * 10000), (["points", 0, "cpu"], [1] * 50), (["points", 0, "busy"], 1e12),
            (["request", "levels"], 1e6), (["request", "methods"], ["index1@rk5"]), (["request", "methods"], []),
            (["reference", "q"], [1, 2]), (["scene", "text"], {}), (["scene", "set"], {"l1": 3.0}), (["request", "time"], -1),
            (["request", "step"], 0),
        ):
            def change(part):
                for key in path[:-1]:
                    part = part[key]
                part[path[-1]] = value

            done = self.call(["merge", self.edited(one, change)])
            self.assertEqual(done.returncode, INPUT, (path, value, done.stderr))

    def test_words_at_fault_are_told(self):
        for words, said in (
            ([*COUNTED, "--shard", "0/2"], b"no part of a study"),
            ([*COUNTED, "--shard", "3/2"], b"part 3 of 2"),
            ([*COUNTED, "--shard", "1/9999"], b"1 to 240 parts"),
            ([*COUNTED, "--shard", "1"], b"no part of a study"),
            ([*COUNTED, "--shard", "1/2", "--csv"], b"a part of a study is written as JSON"),
            ([*COUNTED, "--shard", "1/2", "--out", "x.html"], b"a part of a study is written as JSON"),
            (["merge", self.parts(1)[0], "--out", "x.pdf"], b"does not choose a form"),
            (["merge"], b"needs PART"),
        ):
            done = self.call(words)
            self.assertEqual(done.returncode, INPUT, words)
            self.assertIn(said, done.stderr)

    def test_a_part_brings_its_scene_along(self):
        scene = self.path("mine.json")
        shipped = os.path.join("lessons", "01-closed-loops", "scenes", "fb0.json")
        shutil.copy(shipped, scene)
        words = ["study", scene, "--set", "l1=1.01", "--methods", *METHODS[:2], "--time", "0.5", "--levels", "3", "--samples", "0"]
        whole = self.call([*words, "--json"])
        files = self.parts(2, words, tag="own")
        os.remove(scene)
        together = self.call(["merge", *files, "--json"])
        self.assertEqual(together.stdout, whole.stdout, together.stderr)

    def test_timed_parts_differ_from_one_process_by_the_clock_alone(self):
        words = [*STUDY[:-2], "--levels", "3", "--samples", "4", "--time-limit", "0"]
        whole = json.loads(self.call([*words, "--json"]).stdout)
        files = self.parts(2, words, tag="timed")
        together = json.loads(self.merged(files))
        self.assertEqual(json.dumps(without_clock(together)), json.dumps(without_clock(whole)))
        for method in together["methods"]:
            for point in method["points"]:
                self.assertEqual(point["cpu"]["samples"], 4)
                self.assertEqual(len(point["cpu"]["halves"]), 2)
        # again and again: the same clock's numbers too
        self.assertEqual(self.merged([files[1], *files, files[0]]), self.merged(files))
        # a part whose clock ran half as fast as the other's is found out by the run that both timed
        with open(files[0], encoding="utf-8") as f:
            other = json.load(f)["yardstick"]["cpu"]

        def slow_down(part):
            part["yardstick"]["cpu"] = [2 * s for s in other]

        apart = json.loads(self.merged([files[0], self.edited(files[1], slow_down)]))
        for front in apart["pareto"]:
            self.assertEqual(front["ranked"], front["cost"] != "time")
        self.assertIn("longer in one part than in another", next(p["sentences"] for p in apart["pareto"] if p["cost"] == "time"))

    def test_a_ranking_by_time_stands_only_where_both_halves_agree(self):
        words = ["study", "fb0", "--methods", *METHODS, "--time", "1", "--levels", "3", "--samples", "6", "--time-limit", "0", "--json"]
        study = json.loads(self.call(words).stdout)
        points = {(m["method"], p["size"]): p for m in study["methods"] for p in m["points"]}
        bands = 0
        for front in study["pareto"]:
            for band in front["bands"] if front["cost"] == "time" and front["ranked"] else []:
                self.assertIn(band["ranking"], ("ranked", "too close to rank", "the halves of the timing disagree"))
                bands += 1
                if band["ranking"] != "ranked":
                    self.assertIn("not ranked by time", front["sentences"])
                    self.assertIn("by operations", front["sentences"])
                    continue
                for place in (band["best"], band.get("next", band["best"])):
                    a, b = points[place["method"], place["size"]]["cpu"]["halves"]
                    self.assertLessEqual(max(a, b) / min(a, b), 1.10)
        self.assertGreater(bands, 0)

    def test_a_part_killed_ten_times_ends_as_an_undisturbed_one(self):
        study = other_value(other_value(STUDY, "--time", "8"), "--levels", "6")
        words = [*study, "--samples", "1", "--time-limit", "0", "--shard"]
        undisturbed = [self.path(f"calm-{i}.json") for i in (1, 2)]
        for i in (1, 2):
            self.assertEqual(self.call([*words, f"{i}/2", "--out", undisturbed[i - 1]]).returncode, DONE)
        out, cache = self.path("killed.json"), self.cache("cache-of-the-killed")
        words = [*words, "1/2", "--out", out]
        self.assertGreaterEqual(studies.kill_often(words, cache, "study", 7), 3)
        done = studies.call(words, cache)
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertEqual(studies.journals(cache, "study"), [], "nothing is left of a finished part")
        together = json.loads(self.merged([out, undisturbed[1]]))
        calm = json.loads(self.merged(undisturbed))
        self.assertEqual(json.dumps(without_clock(together)), json.dumps(without_clock(calm)))

    def test_an_interrupted_part_is_told_and_goes_on(self):
        words = [*STUDY[:-4], "--time", "4", "--levels", "6", "--samples", "2", "--time-limit", "0", "--shard"]
        files = [self.path(f"int-{i}.json") for i in (1, 2)]
        self.assertEqual(self.call([*words, "2/2", "--out", files[1]]).returncode, DONE)
        words, cache = [*words, "1/2", "--out", files[0]], self.cache("cache-of-the-interrupted")
        status, _, err = studies.interrupt(words, cache, "study")
        self.assertEqual(status, ENDED, err)
        self.assertIn("continues from here", err)
        self.refused(files, "1 of 2 parts are missing: 1/2", "stopped before its end")
        done = studies.call(words, cache)
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertRegex(done.stderr, rb"continuing with \d+ points")
        self.assertEqual(self.call(["merge", *files]).returncode, DONE)

    def test_what_the_budget_left_out_stays_and_a_richer_run_of_that_part_fills_it(self):
        poor, rich = self.path("poor.json"), self.parts(2)
        done = self.call([*COUNTED, "--time-limit", "1e-4", "--shard", "1/2", "--out", poor])
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertIn(b"the time limit of 0.0001 s left points out", done.stderr)
        study = json.loads(self.merged([poor, rich[1]]))
        skipped = [p for m in study["methods"] for p in m["points"] if p["state"] == "skipped"]
        self.assertTrue(skipped)
        self.assertFalse(study["finished"])
        for p in skipped:
            self.assertIn("time limit", p["reason"])
        self.assertEqual(self.merged([poor, *rich]), bytes_of(self.whole + ".json"))


if __name__ == "__main__":
    driver.main()
