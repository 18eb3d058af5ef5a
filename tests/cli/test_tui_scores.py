# SPDX-License-Identifier: GPL-3.0-or-later
# Exercises in the terminal workbench: answers, scores that are kept, feedback folded to the window.
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402
from terminal import PROGRAM, message, once  # noqa: E402


class Scores(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.state = os.path.join(folder.name, "state")
        self.file = os.path.join(self.state, "holonom", "lessons.json")
        listed = json.loads(subprocess.run([PROGRAM, "list", "problems", "--json"], capture_output=True, check=True).stdout)["problems"]
        lessons = [one["id"] for one in json.loads(subprocess.run([PROGRAM, "list", "lessons", "--json"], capture_output=True, check=True).stdout)["lessons"]]
        rows = [row for lesson in lessons for row in [lesson] + [one["id"] for one in listed if one["lesson"] == lesson]]
        self.keys_to = lambda name: "t" + "<Down>" * rows.index(name)
        self.ring, self.closure = self.keys_to("ring"), self.keys_to("closure")

    def frame(self, keys, **environment):
        status, out, err = once("pendulum", "--once", "--t", "0.1", "--size", "160x60", "--keys", keys, **{"XDG_STATE_HOME": self.state, **environment})
        self.assertEqual((status, err), (0, ""))
        return out

    def lines(self, name, wide):
        """The first page of an exercise in a window of 80 columns."""
        _, out, _ = once("pendulum", "--once", "--t", "0.1", "--size", "80x24", "--keys", self.keys_to(name) + "<Enter>")
        return [row[2:wide].rstrip() for row in out.split("\n")[2:21]]

    def kept(self):
        with open(self.file, encoding="utf-8") as file:
            return json.load(file)["solved"]["ring"]

    def test_the_best_score_is_kept_and_listed(self):
        self.assertNotIn("best ", self.frame(self.ring))
        some = self.frame(self.ring + "<Enter><Down><Enter>2<Enter>c")
        score, most = map(float, re.search(r"([\d.]+) of ([\d.]+) points:", message(some)).groups())
        self.assertGreater(score, 0)
        self.assertEqual(self.kept(), {"score": score, "most": most})
        self.assertIn(f"best {score:g} of {most:g}: ", self.frame(self.ring))
        # a lower one does not replace it; what else is in the file stays
        with open(self.file, "w", encoding="utf-8") as file:
            json.dump({"lessons": {"x": {"read": True}}, "solved": {"ring": {"score": most, "most": most}}}, file)
        self.frame(self.ring + "<Enter><Down><Enter>2<Enter>c")
        self.assertEqual(self.kept()["score"], most)
        with open(self.file, "w", encoding="utf-8") as file:
            json.dump({"lessons": {"x": {"read": True}}, "solved": {"ring": {"score": 0, "most": most}}}, file)
        self.frame(self.ring + "<Enter><Down><Enter>2<Enter>c")
        self.assertEqual(self.kept()["score"], score)
        with open(self.file, encoding="utf-8") as file:
            self.assertTrue(json.load(file)["lessons"]["x"]["read"])

    def test_without_a_folder_the_score_stands_and_says_that_it_is_not_kept(self):
        answer = self.ring + "<Enter><Down><Enter>2<Enter>c"
        self.assertIn("this score is not kept: neither XDG_STATE_HOME nor HOME is set", self.frame(answer, XDG_STATE_HOME="", HOME=""))
        # a folder that cannot be made, a file that is not one of scores
        with open(self.state, "w", encoding="ascii") as file:
            file.write("a file")
        self.assertRegex(self.frame(answer), r"of [\d.]+ points: .*this score is not kept: ")
        os.remove(self.state)
        os.makedirs(os.path.dirname(self.file))
        with open(self.file, "w", encoding="ascii") as file:
            file.write("[not scores")
        self.assertIn("holds no scores", " ".join(self.frame(answer).split()))
        with open(self.file, encoding="ascii") as file:
            self.assertEqual(file.read(), "[not scores")

    def test_paragraphs_are_folded_to_the_window(self):
        rows = self.lines("p3", 78)
        # no line ends where the next word had room, except at a paragraph's end
        for row, after in zip(rows, rows[1:]):
            if row and after and row[0] != " " and after[0] != " " and not after.startswith(">"):
                self.assertGreater(len(row) + 1 + len(after.split()[0]), 76, (row, after))
        self.assertIn("    phi_1 = l1 cos th1 + l2 cos th2 - l3 cos th3 - l4 cos th4 = 0,", rows)

    def test_feedback_keeps_its_indent_where_it_is_folded(self):
        keys = self.keys_to("p3") + "<Enter><Enter>2.5<Enter>c"
        _, out, _ = once("pendulum", "--once", "--t", "0.1", "--size", "60x40", "--keys", keys, XDG_STATE_HOME=self.state)
        rows = [line[2:].rstrip("│ ") for line in out.split("\n")[2:-4]]
        told = next(i for i, row in enumerate(rows) if "off by more than" in " ".join(rows[i : i + 2]))
        indent = len(rows[told]) - len(rows[told].lstrip())
        self.assertGreater(indent, 1)
        after = rows[told + 1]
        self.assertEqual(len(after) - len(after.lstrip()), indent, rows[told : told + 2])

    def test_a_wrong_number_is_not_said_to_equal_itself(self):
        out = self.frame(self.keys_to("p3") + "<Enter><Enter>2.5<Enter>c")
        self.assertNotIn("2.5 = 2.5", out)
        self.assertRegex(out, r"given +2\.5, off by more than the [0-9.e-]+ allowed")

    def test_answers_and_points_are_told_apart(self):
        out = self.frame(self.closure + "<Enter><Enter>1<Enter><Enter>l3 sin(th3) u3<Enter>c")
        worth = re.search(r"(\d+) answers are checked, worth (.*) points; one that", " ".join(line.strip("│ ") for line in out.split("\n")))
        self.assertTrue(worth, out)
        points = [float(one.split()[-1]) for one in worth.group(2).split(",")]
        self.assertEqual(len(points), int(worth.group(1)))
        self.assertEqual(sum(points), float(re.search(r"of ([\d.]+) points:", message(out)).group(1)))
        # parts are counted, not the answers that they have, and what is partly right is said
        self.assertIn("points: 0 of 4 parts are right; b is partly right: 0.5 of 1 point", message(out))
        # where each answer is worth a point nothing is explained
        self.assertNotIn("answers are checked", self.frame(self.ring + "<Enter><Down><Enter>2<Enter>c"))

    def test_an_answer_that_cannot_be_read_is_refused_as_it_is_typed(self):
        def said(keys):
            return " ".join(self.frame(self.closure + "<Enter>" + keys).split("\n└")[1].split())
        typed = self.frame(self.closure + "<Enter><Enter>l1*sin(th1<Enter>")
        why = "column 11: the end of the formula was found where ',' or ')' is expected"
        self.assertIn("a: 'l1*sin(th1' cannot be read: " + why, said("<Enter>l1*sin(th1<Enter>"))
        # it stays chosen, to be put right; one that can be read leads to the next
        self.assertIn("> a = l1*sin(th1", typed)
        self.assertIn("> b = ", self.frame(self.closure + "<Enter><Enter>l1*sin(th1)<Enter>"))
        # the check says the reason too
        self.assertRegex(said("<Enter>l1*sin(th1<Enter>c"), r"not graded: no answer can be read \(a\); 'l1\*sin\(th1' cannot be read: " + re.escape(why))


if __name__ == "__main__":
    driver.main()
