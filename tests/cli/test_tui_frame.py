# SPDX-License-Identifier: GPL-3.0-or-later
# One frame of the terminal workbench as text: sizes, character sets, links and what is said.
import os
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402
from terminal import PROGRAM, once  # noqa: E402


class Frame(unittest.TestCase):
    def test_one_frame_fills_the_size_asked_for_and_says_the_verdicts(self):
        status, out, err = once("four-bar", "--once", "--t", "3.5", "--size", "110x32")
        self.assertEqual((status, err), (0, ""))
        lines = out.rstrip("\n").split("\n")
        self.assertEqual(len(lines), 32)
        self.assertTrue(all(len(line) <= 110 for line in lines))
        self.assertIn("t 3.500 s of 10 s", lines[0])
        # index-1 at h = 0.01 is 3.4 mm open after 3.5 s (the table of the lesson), the others are closed and right to two digits
        self.assertRegex(out, r"index-1 +3\.4 mm .*open by 3\.4 mm and \d+ mm from the true motion")
        self.assertRegex(out, r"projection .*right to 2 digits")

    def test_what_moves_is_inside_the_view_and_joints_have_their_names(self):
        # methods that leave their branch reach beyond the motion that the view is fitted to first
        for words in (["parallelogram", "--t", "5"], ["four-bar", "--t", "10", "--methods", "index1@euler:h=0.01"]):
            _, out, _ = once(*words, "--once")
            view = [line[1:35] for line in out.split("\n")[2:14]]
            self.assertTrue(any("⣀" <= c <= "⣿" for line in view for c in line))
            self.assertEqual({line[0] + line[-1] for line in view}, {"  "}, words)
        _, out, _ = once("four-bar", "--once", "--t", "1")
        view = "\n".join(line[1:35] for line in out.split("\n")[2:12])
        self.assertEqual(re.findall(r"\b(O1|A|B|O3)\b", view), ["B", "O1", "A"])

    def test_an_open_loop_that_is_too_small_to_be_seen_is_drawn_enlarged(self):
        def enlarged(t, step, keys=""):
            out = once("four-bar", "--once", "--t", t, "--methods", f"index1@rk4:h={step}", "projection@rk4:h=0.01", "--keys", keys)[1]
            return re.findall(r"gap (?:enlarged )?×(\d+)", out)
        # 4 mm at 3.5 s: some tenths of a dot; 10 cm need no enlargement, nor has a closed loop any
        self.assertEqual(len(enlarged("3.5", "0.01")), 1)
        self.assertGreater(int(enlarged("2", "0.01")[0]), int(enlarged("3.5", "0.01")[0]))
        self.assertEqual(enlarged("10", "0.02"), [])
        self.assertEqual(enlarged("3.5", "0.01", "2"), [])

    def test_the_equations_name_the_term_that_the_printed_ones_lack(self):
        _, out, _ = once("four-bar", "--once", "--t", "0.1", "--methods", "nullspace-as-printed@rk4", "nullspace@rk4", "--keys", "f")
        self.assertRegex(out, r"it solves +N' M N du/dt = N' f")
        self.assertRegex(out, r"missing on the left side: +N' M \(dN/dt\) u")
        self.assertNotIn("MISSING", once("four-bar", "--once", "--t", "0.1", "--methods", "penalty@rk4:h=1e-3", "--keys", "f")[1])

    def test_the_same_frame_has_the_same_bytes(self):
        words = ("slider-crank", "--once", "--t", "1")
        self.assertEqual(once(*words), once(*words))

    def test_every_shipped_scene_is_drawn_in_80_columns(self):
        names = subprocess.run([PROGRAM, "list", "scenes", "--json"], capture_output=True, text=True).stdout
        for name in re.findall(r'"id":"([^"]+)"', names):
            status, out, err = once(name, "--once", "--t", "0.03")
            self.assertEqual((name, status, err), (name, 0, ""))
            self.assertTrue(all(len(line) <= 80 for line in out.split("\n")), name)
            self.assertRegex(out, "[\u2801-\u28ff]", name)
            self.assertNotRegex(out, r"\bnan\b|\binf\b", name)

    def test_ascii_and_blocks_hold_no_braille(self):
        for words, environment in ((["--ascii"], {}), ([], {"LC_ALL": "C"})):
            _, out, _ = once("four-bar", "--once", "--t", "1", *words, **environment)
            self.assertTrue(out.isascii(), words)
            self.assertRegex(out, r"[/\\_|'-]{3}")
        _, out, _ = once("four-bar", "--once", "--t", "1", "--blocks")
        self.assertNotRegex(out, "[\u2801-\u28ff]")
        self.assertRegex(out, "[▘▝▖▗▀▄▌▐▙▟▛▜▞▚]")

    def test_without_a_terminal_there_is_plain_text_without_escapes(self):
        status, out, _ = once("pendulum")
        self.assertEqual(status, 0)
        self.assertNotIn("\033", out)

    def test_faults_are_told_and_end_with_2(self):
        for words, wanted in ((["four-bat", "--once"], "four-bar"), (["four-bar", "--once", "--size", "5x5"], "20x8"),
                              (["four-bar", "--once", "--methods", "indx1@rk4"], "index1"),
                              (["four-bar", "--once", "--set", "l9=1"], "l9")):
            status, _, err = once(*words)
            self.assertEqual(status, 2, words)
            self.assertIn(wanted, err)

    def test_a_link_of_the_page_opens_its_scene_and_methods(self):
        link = "http://127.0.0.1:8080/#scene=slider-crank&set.l=0.9&method=projection@rk4:h=0.002&frame=3"
        status, out, err = once(link, "--once", "--t", "0.1")
        self.assertEqual((status, err), (0, ""))
        self.assertIn("slider-crank", out)
        self.assertEqual(len(re.findall(r"^│\d", out, re.M)), 1)

    def test_a_link_with_faults_opens_with_the_rest_and_names_them(self):
        def opened(link):
            status, out, err = once(link, "--once", "--t", "0.5")
            self.assertEqual((status, err), (0, ""), link)
            return out, " ".join(out.split())
        out, words = opened("#scene=four-bar&set.l11=0.6&method=index9@rk4&method=projection@rk4:h=0.02")
        self.assertIn("the link: ", words)
        self.assertIn("no parameter 'l11'; did you mean 'l1'?; all parameters have the scene's values", words)
        self.assertIn("formulation 'index9' is not known", words)
        self.assertIn("did you mean 'index1'?; this method is left out", words)
        self.assertEqual(re.findall(r"(?m)^│\d\S (\S+)", out), ["projection"])
        out, words = opened("#scene=four-bar&method=inde")
        self.assertIn("the methods are those of the scene", words)
        self.assertGreater(len(re.findall(r"(?m)^│\d\S (\S+)", out)), 2)
        # without its scene there is nothing to open
        self.assertEqual(once("#scene=four-baz&method=projection@rk4", "--once")[0], 2)

    def test_a_link_opens_paused_at_its_frame_with_its_method_selected(self):
        link = "#scene=four-bar&method=projection@rk4:h=0.02&method=index1@rk4:h=0.02&frame=150&selected=1"
        _, out, _ = once(link, "--once", "--keys", "i")
        self.assertRegex(out, r"t 3\.000 s of 10 s .*paused")
        self.assertIn("why: index-1", out)
        # a frame beyond the motion is its end, and what is no number is no frame
        _, out, _ = once(link.replace("150", "999999"), "--once")
        self.assertIn("t 10.000 s of 10 s", out)
        _, out, _ = once(link.replace("150", "soon"), "--once", "--t", "0")
        self.assertIn("t 0.000 s of 10 s", out)

    def test_the_help_and_the_manual_say_how_ctrl_c_ends(self):
        for word in ("help", "manual"):
            said = subprocess.run([PROGRAM, word], capture_output=True, text=True, timeout=600).stdout
            self.assertRegex(said, r"130\s+Ctrl\\?-C\s+ended\s+the\s+workbench\s+in\s+the\s+terminal", word)

    def test_in_ascii_a_power_is_written_as_one(self):
        out = once("four-bar", "--once", "--ascii", "--t", "1", "--size", "120x30", "--keys", "i", "--methods", "index1@rk4:h=1e-3")[1]
        self.assertTrue(out.isascii())
        self.assertRegex(out, r"gap \d\.\de-10 m and growing +\|\n")
        self.assertNotIn("x10-", out)
        self.assertEqual(len({len(line) for line in out.split("\n")[1:26]}), 1)
        with tempfile.TemporaryDirectory() as cache:
            self.assertIn("beta^2 e = 0", once("four-bar", "--once", "--ascii", "--t", "0.1", "--keys", "b", HOLONOM_CACHE=cache)[1])

    def test_json_is_refused(self):
        status, out, err = once("--json")
        self.assertEqual(status, 2)
        self.assertIn("tui draws text and has no --json", out + err)
        self.assertNotIn("--json", subprocess.run([PROGRAM, "tui", "--help"], capture_output=True, text=True).stdout)

    def test_a_text_ends_with_a_full_page(self):
        def lesson(keys):
            return once("--once", "--keys", "t<Enter>" + keys)[1].split("\n")[2:-4]
        end = lesson("<End>")
        self.assertEqual(lesson("<End><PageDown>"), end)
        self.assertGreater(sum(line.strip("│ ") != "" for line in end[-6:]), 3)
        self.assertEqual(lesson("<End><Up>")[1:], end[:-1])
        self.assertTrue(any(line.strip("│ ") for line in lesson("<End><PageUp>")[:5]))

    def test_numbers_are_as_short_as_they_can_be_and_lines_are_cleared(self):
        def line(keys):
            return once("four-bar", "--once", "--t", "0.1", "--set", "l1=0.55", "--keys", keys)[1].rstrip("\n").split("\n")[-1].strip()
        self.assertEqual(line("p<Enter>"), "value: 0.55")
        self.assertEqual(line("p<Enter><CtrlU>0.6"), "value: 0.6")
        self.assertEqual(line("d20 ms<CtrlW>s"), "dt of every method, as 0.02 or 20 ms: 20 s")
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "r.csv")
            once("pendulum", "--once", "--t", "0.1", "--methods", "index1@rk4:h=0.017", "--keys", "x<Enter><CtrlU>" + path + "<Enter>")
            with open(path) as file:
                self.assertEqual(file.read().split("\n")[2].split(",")[0], "0.017")


if __name__ == "__main__":
    driver.main()
