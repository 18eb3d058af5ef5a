# SPDX-License-Identifier: GPL-3.0-or-later
# The words of the terminal workbench about studies, and the causes that its cards name.
import os
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402
from terminal import PROGRAM, ROOT, notice, once  # noqa: E402


class Studies(unittest.TestCase):
    METHODS = ("--methods", "projection@rk4:h=0.02", "index1@rk4:h=0.02")

    def study(self, keys, scene="pendulum", *more):
        with tempfile.TemporaryDirectory() as cache:
            return once(scene, "--once", "--t", "0.5", "--size", "120x40", *(more or self.METHODS), "--keys", keys, HOLONOM_CACHE=cache)[1]

    def test_the_menu_opens_over_a_study_which_is_there_again_after_it(self):
        self.assertIn("select a method", self.study("w?"))
        self.assertIn("what accuracy costs in 10 s: Esc goes back", self.study("w?<Esc>"))
        # what is chosen is done, and the study is gone
        self.assertIn("equations of motion: Esc goes back", self.study("w?" + "<Down>" * 23 + "<Enter>"))
        self.assertIn("loop gap", self.study("w?" + "<Down>" * 23 + "<Enter><Esc>"))
        # a remark of the menu does nothing
        self.assertIn("what accuracy costs in 10 s", self.study("w?<End><Enter>"))
        # a method that is taken leaves the study: the next list goes back to the motion
        self.assertIn("loop gap", self.study("w<Enter>m<Esc>"))

    def test_a_method_has_one_symbol_in_table_and_plot(self):
        table = dict(re.findall(r"(?m)^│\d(\S) (\S+)", self.study("")))
        legend = dict((name.split("@")[0], glyph) for glyph, name in re.findall(r"(\S) 6/6 (\S+)", self.study("w")))
        self.assertEqual({glyph: name.replace("index-1", "index1") for glyph, name in table.items()}, {glyph: name for name, glyph in legend.items()})
        self.assertEqual(len(table), 2)

    def test_the_time_of_a_study_is_said_and_typed(self):
        shorter = self.study("wt500 ms<Enter>")
        self.assertIn("what accuracy costs in 0.5 s: Esc goes back", shorter)
        self.assertIn("up to t = 0.5 s", " ".join(shorter.split()))
        self.assertIn("'99' is no time of motion above 0 and up to 10 s", self.study("wt99<Enter>"))
        # whether the answer holds for another length is said where both were measured
        self.assertRegex(" ".join(shorter.replace("│", " ").split()), r"For 10 s and for 0\.5 s of motion the cheapest is \w+@rk4|For 0\.5 s of motion the cheapest is \w+@rk4, for 10 s it was \w+@rk4")
        # of other methods nothing has been measured yet
        once_more = self.study("wt2<Enter><Esc>d0.01<Enter>w")
        self.assertIn("For 2 s of motion; for 10 s another may be cheaper (t measures it).", " ".join(once_more.replace("│", " ").split()))
        # it is kept for the next study of this scene
        self.assertIn("what accuracy costs in 0.5 s", self.study("wt0.5<Enter><Esc>w"))
        self.assertIn("what accuracy costs in 0.5 s", self.study("wt0.5<Enter><Esc>p<Right><Esc>w"))

    def test_the_answer_about_two_seconds_is_followed_by_that_about_the_whole_motion(self):
        out = self.study("w", "four-bar", "--methods", "index1@rk4:h=0.01", "nullspace@rk4:h=0.01")
        self.assertIn("what accuracy costs in 10 s: Esc goes back", out)
        words = " ".join(row.split("│")[1][-46:] for row in out.split("\n") if row.startswith("│"))
        self.assertIn("For 10 s of motion the cheapest is nullspace@rk4, for 2 s it was index1@rk4.", " ".join(words.split()))
        # a time that was typed is the user's own: nothing is measured beyond it
        self.assertIn("what accuracy costs in 2 s: Esc goes back", self.study("wt2<Enter>"))

    def test_a_key_without_a_meaning_says_so(self):
        def said(keys):
            return once("pendulum", "--once", "--t", "0.5", *self.METHODS, "--keys", keys)[1].split("\n")[-3].strip()
        self.assertEqual(said("u"), "u has no meaning here; ? lists the keys")
        self.assertEqual(said("7"), "there is no method 7, but 1 to 2; m adds one")
        self.assertEqual(said("u2"), "")

    def test_the_equation_above_a_map_is_whole_or_absent(self):
        for method, law in (("baumgarte@rk4:h=0.02", "the gap e obeys e'' + 2 alpha e' + beta² e = 0 "),
                            ("baumgarte:alpha=20,beta=20@rk4:h=0.02", "h=0.02  e'' + 2 alpha e' + beta² e = 0 "),
                            ("baumgarte:alpha=20.123456,beta=20.123456@rk4:h=0.002", "h=0.002  ")):
            out = once("four-bar", "--once", "--size", "80x24", "--methods", method, "--keys", "bt0.1<Enter>")[1]
            self.assertIn(law, out.split("\n")[2])
            self.assertNotRegex(out.split("\n")[2], r"alpha e' \+ (?!beta² e = 0 )")

    def test_a_map_marks_its_best_cells_and_says_what_they_show(self):
        with open(os.path.join(ROOT, "web", "views", "study-map-parts.js"), encoding="utf-8") as file:
            page = "".join(re.findall(r'"([^"]*)"', file.read().split("export const SWEET_SPOT =")[1].split(";\n")[0]))
        spot = page.replace("α", "alpha").replace("β", "beta")
        out = self.study("bt0.2<Enter>", "four-bar", "--methods", "baumgarte@rk4:h=0.02")
        words = " ".join(out.replace("│", " ").split())
        self.assertIn(spot, words)
        grid = [row.split("│")[2][:48] for row in out.split("\n") if re.search(r"│ +[0-9.]+ │", row)]
        lines = dict((mark, float(at)) for mark, at in re.findall(r"([gve]) smallest [a-z ]+: \S+ \S+ at alpha = [\d.]+ 1/s, beta = ([\d.]+) 1/s", words))
        self.assertEqual(sorted(lines), ["e", "g", "v"])
        rows = [row for row in out.split("\n") if re.search(r"│ +[0-9.]+ │", row)]
        for mark, beta in lines.items():
            marked = [float(row.split("│")[1]) for row, cells in zip(rows, grid) if mark in cells]
            self.assertIn(beta, marked, out)
        # as text too
        done = subprocess.run([PROGRAM, "study", "four-bar", "stability", "--preset", "baumgarte", "--grid", "12x6", "--time", "0.2", "--plot",
                               "--methods", "baumgarte@rk4:h=0.02"], capture_output=True, text=True, check=True, env={**os.environ, "COLUMNS": "100", "LC_ALL": "C.UTF-8"})
        self.assertIn("g smallest worst loop gap: ", done.stdout)

    def test_what_a_small_map_has_no_room_for_is_reached_by_a_key(self):
        small = [once("four-bar", "--once", "--size", "80x24", "--methods", "baumgarte@rk4:h=0.02", "--keys", "bt0.2<Enter>" + pages * "<PageDown>")[1]
                 for pages in range(5)]
        self.assertIn("PageDown: more", small[0])
        self.assertIn("g smallest worst loop gap: ", small[0])
        self.assertTrue(any("prediction right in" in page for page in small), small[-1])
        self.assertIn("PageUp: back", small[-1])
        self.assertIn(" ★ is now, Esc goes back ─", small[-1].split("\n")[1])

    def test_a_page_of_a_map_is_what_fits_and_an_arrow_shows_the_line_of_its_cell(self):
        def foot(keys):
            out = once("four-bar", "--once", "--size", "100x30", "--methods", "baumgarte@rk4:h=0.02", "--keys", "bt0.2<Enter>" + keys)[1]
            rows = out.split("\n")
            at = next(i for i, row in enumerate(rows) if "across: alpha" in row)
            return " ".join(" ".join(rows[at + 1:-3]).replace("│", " ").split())
        # before the first arrow the line is that of the present point
        first = foot("")
        self.assertRegex(first, r"^alpha = 4\.56 1/s, beta = 5\.08 1/s: .*; worst gap .*\(★ is in this cell\) g smallest")
        self.assertIn("The best place lies between, and it is another one for the gap, the motion and the energy.", first)
        self.assertIn("PageDown: more", first)
        # one page reaches the end
        self.assertIn("prediction right in", foot("<PageDown>"))
        self.assertIn("PageUp: back", foot("<PageDown>"))
        self.assertEqual(foot("<PageDown>"), foot("<End>"))
        self.assertEqual(foot("<End><Home>"), first)
        moved = foot("<PageDown><Right>")
        self.assertRegex(moved, r"^alpha = 5\.57 1/s, beta = 5\.08 1/s: .*\(Enter takes these\)")
        self.assertEqual(moved, foot("<Right>"))

    def test_a_cost_study_marks_that_its_text_goes_on_and_end_goes_there(self):
        with tempfile.TemporaryDirectory() as cache:
            def shown(keys):
                return once("four-bar", "--once", "--size", "100x30", "--keys", "wt1<Enter>" + keys, HOLONOM_CACHE=cache)[1]
            first = shown("")
            self.assertIn("PageDown: more", first)
            last = shown("<End>")
            self.assertIn("PageUp: back", last)
            self.assertEqual(last, shown(20 * "<PageDown>"))
            self.assertNotEqual(last, first)
            self.assertEqual(shown("<End><Home>"), first)

    def test_the_legend_of_a_map_stands_beside_it_or_below_unbroken(self):
        out = self.study("bt0.2<Enter>", "four-bar", "--methods", "baumgarte@rk4:h=0.02")
        rows = out.split("\n")
        first = next(row for row in rows if "! unstable" in row)
        self.assertRegex(first, r"│ +[0-9.]+ │!")
        done = subprocess.run([PROGRAM, "study", "four-bar", "stability", "--preset", "baumgarte", "--grid", "24x4", "--time", "0.2", "--plot",
                               "--methods", "baumgarte@rk4:h=0.02"], capture_output=True, text=True, check=True, env={**os.environ, "COLUMNS": "60", "LC_ALL": "C.UTF-8"})
        for entry in ("! unstable: the error grew", "━ predicted limit"):
            self.assertTrue(any(entry in row for row in done.stdout.split("\n")), done.stdout)
        # outcomes that no cell has are not in the legend
        self.assertNotRegex(done.stdout + out, "stopped with a reason|refused|out of time")

    def test_the_present_point_beyond_a_map_stands_at_its_edge_with_a_word(self):
        out = self.study("bt0.2<Enter>", "four-bar", "--methods", "baumgarte:beta=0@rk4:h=0.02")
        lowest = [row for row in out.split("\n") if re.search(r"│ +[0-9.]+ │", row)][-1]
        self.assertIn("★", lowest)
        self.assertIn("★ at the edge: now alpha = 5, beta = 0, beyond the map", out)
        inside = self.study("bt0.2<Enter>", "four-bar", "--methods", "baumgarte@rk4:h=0.02")
        self.assertNotIn("at the edge", inside)

    def test_no_mark_of_a_method_has_another_meaning(self):
        out = self.study("bt0.2<Enter><Right>", "four-bar", "--methods", "baumgarte@rk4:h=0.02")
        self.assertNotRegex(out, "[●■▲◆✕○]")
        # paused, a method that stopped, the ghosts: only marks of methods, each with its name in the table
        out = once("four-bar", "--once", "--t", "10", "--methods", "index1@rk4:h=0.02", "baumgarte:alpha=-5@rk4:h=0.02", "projection@rk4:h=0.02")[1]
        above, table = out.split("─ methods ─")
        self.assertNotRegex(above.split("\n")[0], "[●■▲◆✕○]")
        self.assertRegex(table, r"2■ .* ⇥ stopped at")
        out = once("four-bar", "--once", "--t", "10", "--size", "100x30", "--methods", *(f"{name}@rk4:h=0.02" for name in ("baumgarte", "nullspace", "index1", "projection")))[1]
        above, table = out.split("─ methods ─")
        for mark, name in re.findall(r"(?m)^│\d(\S) (\S+)", table):
            self.assertIn(mark, "".join(row.split("││")[0] for row in above.split("\n")[2:]), name)

    def test_an_error_budget_has_all_methods_side_by_side_under_their_names(self):
        five = ("index1", "baumgarte", "projection", "nullspace", "reduced")
        for size, n_tables in (("120x60", 1), ("80x60", 2)):
            with tempfile.TemporaryDirectory() as cache:
                _, out, _ = once("pendulum", "--once", "--t", "0.5", "--size", size, "--methods", *(f"{name}@rk4:h=0.02" for name in five), "--keys", "e", HOLONOM_CACHE=cache)
            heads = [line for line in out.split("\n") if re.search(r"index-1 +Baumgarte", line)]
            self.assertEqual(len(heads), n_tables, out)
            for head in heads:
                self.assertEqual(len(re.sub("[│]", "", head).split()), len(five), head)

    def test_the_map_says_what_alpha_and_beta_are(self):
        out = self.study("bt0.2<Enter>", "four-bar", "--methods", "baumgarte@rk4:h=0.02")
        self.assertIn("the gap e obeys e'' + 2 alpha e' + beta² e = 0", out)
        self.assertIn("stability over alpha and beta in 0.2 s", out)


class Causes(unittest.TestCase):
    def card(self, scene, keys, *words):
        status, out, err = once(scene, "--once", "--size", "200x60", "--keys", keys, *words)
        self.assertEqual((status, err), (0, ""))
        rows = [row.split("││")[1].rstrip("│ ") for row in out.split("\n") if "││" in row]
        return " ".join(" ".join(rows).split())

    def test_a_step_that_is_too_long_is_named_with_the_step_that_would_do(self):
        for method in ("baumgarte@rk4:h=0.02", "nullspace@rk4:h=0.02"):
            words = self.card("four-bar", "i", "--t", "3.5", "--methods", method)
            self.assertRegex(words, r"worst so far: .* mm from the true motion Cause: the step h = 0\.02 s is too long\. try h=0\.00\d+ \(tried until t = 10 s: right to \d digits")
        # it stands in the list of remedies, and taking it makes the method right
        out = once("four-bar", "--once", "--t", "10", "--methods", "nullspace@rk4:h=0.02", "--keys", "i<Enter><Enter><End>")[1]
        self.assertRegex(out, r"null-space .* right to \d digits")

    def test_a_tolerance_that_is_too_coarse_is_named_too(self):
        words = self.card("four-bar", "i", "--t", "10", "--methods", "nullspace@dopri5:rtol=1e-2,atol=1e-9")
        self.assertRegex(words, r"Cause: the tolerance rtol = 0\.01 is too coarse\. try rtol=\S+ \(tried until t = 10 s: right to")

    def test_a_right_method_and_a_wrong_model_have_no_such_cause(self):
        self.assertNotIn("Cause", self.card("four-bar", "i", "--t", "3.5", "--methods", "projection@rk4:h=0.001"))
        self.assertNotIn("Cause", self.card("four-bar", "i", "--t", "1", "--methods", "nullspace-as-printed@rk4:h=0.01"))

    def test_row_notice_and_card_give_one_time_of_an_end(self):
        words = ("--methods", "nullspace-as-printed@rk4:h=0.01")
        card = self.card("four-bar", "i", "--t", "5", *words)
        out = once("four-bar", "--once", "--t", "5", *words)[1]
        self.assertIn("1.43 s: in the step to t = 1.44 s with th3 = 0.211506: no configuration", card)
        self.assertIn("stopped at 1.43 s", out)
        self.assertIn("as printed at 1.43 s: in the step to t = 1.44 s with", notice(out))
        # a time that the message says itself is not said twice
        self.assertRegex(self.card("four-bar", "i", "--t", "2", "--methods", "baumgarte:alpha=-5@rk4:h=0.02"), r"1\.72 s: the loops are open by")

    def test_change_points_and_dead_points_have_their_names(self):
        words = self.card("parallelogram", "i", "--t", "0.5", "--methods", "projection@rk4:h=0.001")
        self.assertIn("change point: two branches of motion cross", words)
        words = self.card("four-bar", "i", "--t", "1", "--set", "l4=1.6", "--methods", "reduced@rk4:h=0.01")
        self.assertIn("past a dead point", words)


if __name__ == "__main__":
    driver.main()
