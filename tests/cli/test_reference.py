# SPDX-License-Identifier: GPL-3.0-or-later
"""`holonom reference`: where a reference solution comes from, what it says of itself, what is refused."""

import json
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(__file__))
import studies  # noqa: E402
from studies import DONE, ENDED, INPUT  # noqa: E402

SCENE = os.path.join("lessons", "01-closed-loops", "scenes", "fb0-lagrangian.json")


class Reference(unittest.TestCase):
    def setUp(self):
        self.kept = tempfile.TemporaryDirectory()
        self.folder = self.kept.name

    def tearDown(self):
        self.kept.cleanup()

    def call(self, *words):
        return studies.call(["reference", *words], self.folder, text=True)

    def answer(self, *words):
        done = self.call(*words, "--json")
        self.assertEqual(done.returncode, DONE, done.stderr + done.stdout)
        return json.loads(done.stdout)

    def edited(self, change):
        with open(SCENE, encoding="utf-8") as f:
            scene = json.load(f)
        change(scene)
        path = os.path.join(self.folder, os.path.basename(SCENE))
        with open(path, "w", encoding="utf-8") as f:
            json.dump(scene, f)
        return path

    def test_what_is_shipped_serves_the_scene_as_it_is_and_nothing_else(self):
        shipped = self.answer("fb0-lagrangian")
        self.assertEqual((shipped["source"], shipped["time"]), ("shipped", shipped["duration"]))
        self.assertEqual(self.answer("fb0-lagrangian", "--set", "l1=1", "--time", "10")["source"], "shipped")
        changed = self.answer("fb0-lagrangian", "--set", "l1=1.01", "--time", "0.5")
        self.assertEqual(changed["source"], "computed")
        self.assertNotEqual(changed["scene_hash"], shipped["scene_hash"])
        self.assertEqual(self.answer("fb0-lagrangian", "--time", "0.5")["source"], "computed")

    def test_what_is_computed_is_kept_and_computed_again_on_request(self):
        words = ["fb0-lagrangian", "--set", "g=9.7", "--time", "0.5"]
        first, second = self.answer(*words), self.answer(*words)
        self.assertEqual((first["source"], second["source"]), ("computed", "kept"))
        self.assertEqual(first["q"], second["q"])
        self.assertEqual(self.answer(*words, "--recompute")["source"], "computed")
        self.assertEqual(self.answer("fb0-lagrangian", "--recompute")["source"], "computed")

    def test_words_of_a_scene_do_not_part_it_from_its_reference_and_numbers_do(self):
        def reword(scene):
            scene["title"], scene["about"], scene["look_for"] = "Other", "Other words", "else"
            scene["methods"], scene["step"] = ["index1@rk4"], 0.5

        def heavier(scene):
            scene["parameters"]["m1"]["value"] = 1.5

        self.assertEqual(self.answer(self.edited(reword))["source"], "shipped")
        self.assertEqual(self.answer(self.edited(heavier), "--time", "0.2")["source"], "computed")

    def test_a_damaged_file_is_not_used(self):
        words = ["fb0-lagrangian", "--set", "g=9.7", "--time", "0.5"]
        good = self.answer(*words)
        path, = [os.path.join(self.folder, name) for name in os.listdir(self.folder)]
        with open(path, encoding="utf-8") as f:
            text = f.read()
        for damaged in (text[:len(text) // 2], text.replace(good["scene_hash"], "0" * 16), "{}", "",
                        text.replace('"n":32', '"n":31')):
            with open(path, "w", encoding="utf-8") as f:
                f.write(damaged)
            again = self.answer(*words)
            self.assertEqual((again["source"], again["q"]), ("computed", good["q"]))

    def test_it_has_the_digits_it_claims(self):
        # th1 of the reference four-bar: one-coordinate equation by extrapolation in 30-digit arithmetic
        answer = self.answer("fb0-lagrangian", "--time", "2")
        self.assertGreater(answer["digits"], 14)
        self.assertLess(abs(answer["q"][-1][0] - 7.41136679869211579), 3e-15)
        self.assertEqual(len(set(answer["means"])), 2)
        for row, length in (("q", 3), ("v", 3), ("lambda", 2)):
            self.assertEqual([len(entry) for entry in answer[row]], [length] * len(answer["t"]))
        self.assertEqual(len(answer["digits_at"]), len(answer["t"]))
        self.assertAlmostEqual(min(answer["digits_at"]), answer["digits"], places=9)

    def test_a_chaotic_motion_is_held_to_where_digits_are_sure(self):
        whole = self.answer("ring", "--set", "n=6", "--time", "6")
        held = self.answer("ring", "--set", "n=6", "--time", "6", "--hold")
        self.assertLess(whole["digits"], 6)
        self.assertGreaterEqual(held["digits"], 6)
        self.assertLess(held["time"], 6)

    def test_the_table_names_both_means_and_their_digits(self):
        done = self.call("ring")
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertIn("saddle@extrapolation in long double", done.stdout)
        self.assertIn("nullspace@gauss10 in long double", done.stdout)
        self.assertIn("the motion is chaotic", done.stdout)
        self.assertIn("digits", done.stdout)

    def test_time_left_is_shown_and_ctrl_c_ends_it(self):
        status, seen = studies.watch_terminal(["reference", "ring", "--set", "n=12", "--time", "60", "--recompute"], self.folder, interrupt=True)
        self.assertEqual(status, ENDED, seen)
        self.assertRegex(seen, r"reference \[[#.]+\] +\d+ %, \d+ (?:s|min) left")
        self.assertIn("stopped on request", seen)

    def test_a_kept_reference_of_nulls_is_computed_again(self):
        self.call("fb0", "--time", "0.5", "--json")
        names = [name for name in os.listdir(self.folder) if name.startswith("reference-")]
        self.assertEqual(len(names), 1)
        path = os.path.join(self.folder, names[0])
        with open(path) as f:
            kept = json.load(f)
        for member in ("q", "v", "energy", "scales"):
            with open(path, "w") as f:
                json.dump({**kept, member: [None] * len(kept[member])}, f)
            answer = json.loads(self.call("fb0", "--time", "0.5", "--json").stdout)
            self.assertEqual(answer["source"], "computed", member)

    def test_faults_are_told(self):
        for words, status, text in ((["fb0", "--time", "-1"], INPUT, "are allowed"), (["fbo"], INPUT, "did you mean"),
                                    (["fb0", "--recompute", "--time-limit", "1e-9"], ENDED, "takes more"),
                                    (["fb0", "--out", "/nowhere/x.json"], INPUT, "there is no such folder")):
            done = self.call(*words)
            self.assertEqual(done.returncode, status, (words, done.stderr))
            self.assertIn(text, done.stderr)


if __name__ == "__main__":
    studies.driver.main()
