# SPDX-License-Identifier: GPL-3.0-or-later
"""How the workbench spells what it says: the glossary, colours, and signs of a terminal without UTF-8."""

import json
import os
import re
import shutil
import subprocess
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402
from terminal import PROGRAM, ROOT, Terminal, once  # noqa: E402


class Glossary(unittest.TestCase):
    def test_the_words_of_the_screen_stand_before_the_others(self):
        def text(keys, *words):
            out = once(*words, "--once", "--size", "120x150", "--keys", keys)[1]
            return " ".join(out.replace("│", " ").split())
        near = text("h", "parallelogram", "--t", "3")
        used, others = near.split(" Other terms ")
        for term in ("pilot run", "pivot ratio", "sigma_min", "scaled J"):
            self.assertRegex(used, rf"(?:\. |here ){term} [A-Z]", term)
            self.assertNotRegex(others, rf"\. {term} [A-Z]", term)
        # of a pendulum nothing of that is said; all terms are there all the same
        calm = text("h", "pendulum", "--t", "0.1")
        self.assertRegex(calm.split(" Other terms ")[1], r"\. pilot run A second run")
        # the menu opens it too
        self.assertIn("h words: what the terms here mean", text("?", "pendulum", "--t", "0.1"))
        self.assertIn("words: Esc goes back", text("?" + "<End>" + 5 * "<Up>" + "<Enter>", "pendulum", "--t", "0.1"))


class Colours(unittest.TestCase):
    def colours(self, term, *words):
        terminal = Terminal("four-bar", "--frames", "20", "--t", "1", *words, TERM=term)
        self.addCleanup(terminal.close)
        self.assertEqual(terminal.ended(), 0)
        return set(re.findall(rb"\033\[(?:\d+;)*?(3\d|9\d)m", terminal.seen))

    def test_no_method_is_blue_on_black_where_there_are_eight_colours(self):
        # index-1, Baumgarte, projection, null-space, reduced: five colours
        self.assertLessEqual({b"36", b"31", b"32", b"35", b"33"}, seen := self.colours("xterm"))
        self.assertNotIn(b"34", seen)
        self.assertIn(b"34", self.colours("xterm", "--theme", "light"))

    @unittest.skipUnless(shutil.which("infocmp") and subprocess.run(["infocmp", "xterm-direct"], capture_output=True).returncode == 0,
                         "no description of a terminal of true colours is here")
    def test_true_colours_are_those_of_the_page(self):
        terminal = Terminal("four-bar", "--frames", "20", "--t", "1", TERM="xterm-direct")
        self.addCleanup(terminal.close)
        self.assertEqual(terminal.ended(), 0)
        sent = {tuple(map(int, found)) for found in re.findall(rb"38[:;]2[:;]+(\d+)[:;](\d+)[:;](\d+)m", terminal.seen)}
        with open(os.path.join(ROOT, "core", "render", "look.c"), encoding="utf-8") as file:
            known = {tuple(bytes.fromhex(colour)) for colour in re.findall(r"0x([0-9a-fA-F]{6})", file.read())}
        self.assertGreater(len(sent), 4)
        self.assertLessEqual(sent, known)

    @unittest.skipUnless(shutil.which("infocmp") and subprocess.run(["infocmp", "xterm-16color"], capture_output=True).returncode == 0,
                         "no description of a terminal of 16 colours is here")
    def test_sixteen_colours_are_bright_on_black(self):
        self.assertIn(b"94", self.colours("xterm-16color"))


class Ascii(unittest.TestCase):
    """Where a terminal shows no UTF-8, each character of a text is spelled out: a '?' stands there in the source alone."""

    @staticmethod
    def listed(kind, of):
        return [one["id"] for one in json.loads(subprocess.run([PROGRAM, "list", kind, "--json"], capture_output=True, check=True).stdout)[of]]

    def questions(self, keys, *more, **environment):
        """Question marks of the text that the keys open, and the text."""
        _, out, err = once("pendulum", "--once", "--t", "0", "--size", "100x480", *more, "--keys", keys, **environment)
        self.assertEqual(err, "")
        text = "\n".join(out.split("\n")[:-3])
        self.assertEqual(text.isascii(), bool(more or environment))
        return text.count("?"), text

    def test_lessons_and_exercises_of_the_workbench(self):
        ids = self.listed("lessons", "lessons") + self.listed("problems", "problems")
        self.assertGreater(len(ids), 60)
        for one in ids:
            keys = f"t{one}<Enter>"
            wanted, text = self.questions(keys)
            self.assertEqual(self.questions(keys, "--ascii")[0], wanted, one)
        self.assertEqual(self.questions("t01<Enter>", LC_ALL="C")[0], self.questions("t01<Enter>")[0])

    def test_the_words_are_those_of_the_formulas(self):
        text = " ".join(self.questions("t01<Enter>", "--ascii")[1].replace("|", " ").split())
        self.assertIn("all measured from the x axis: theta_1 of the crank, theta_2 of the coupler, theta_3 of the rocker.", text)
        self.assertIn("J(q) v = 0, J = (d phi)/(d q), v = qdot .", text)

    def test_texts_of_commands(self):
        commands = [["lesson", one] for one in self.listed("lessons", "lessons")] + [["problem", one, "--seed", "1"] for one in self.listed("problems", "problems")]
        commands += [["equations", scene] for scene in ("four-bar", "heavy-top", "rssr")] + [["help", "words"], ["manual"], ["inspect", "four-bar"]]
        for words in commands:
            texts = [subprocess.run([PROGRAM, *words], capture_output=True, check=True, env={**os.environ, "LC_ALL": locale}).stdout.decode() for locale in ("C.UTF-8", "C")]
            self.assertTrue(texts[1].isascii(), words)
            self.assertEqual(texts[1].count("?"), texts[0].count("?"), words)
        self.assertIn("rho1 = sigma1*sqrt(-kappa1^2 + (eta1^2 + xi1^2))", subprocess.run([PROGRAM, "equations", "four-bar"], capture_output=True, text=True, check=True, env={**os.environ, "LC_ALL": "C"}).stdout)


if __name__ == "__main__":
    driver.main()
