# SPDX-License-Identifier: GPL-3.0-or-later
# The terminal workbench in a pseudo-terminal and as text: keys, golden frames, and the terminal after every end.
import base64
import json
import math
import os
import re
import signal
import subprocess
import sys
import tempfile
import termios
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402
from terminal import METHODS, PATIENCE, PROGRAM, ROOT, Terminal, once  # noqa: E402


class GoldenFrames(unittest.TestCase):
    """Frames as they were last looked at and found clear. HOLONOM_RENEW=1 writes them anew."""

    FRAMES = {"80x24-braille": ("80x24", "g", ()), "120x40-blocks": ("120x40", "g", ("--blocks",)), "200x60-ascii": ("200x60", "g", ("--ascii",)),
              "80x24-why": ("80x24", "gi", ()), "80x24-parameters": ("80x24", "p", ()), "80x24-menu": ("80x24", "?", ()), "120x40-menu": ("120x40", "?", ()),
              "80x24-map": ("80x24", "2b<Right><Up>", ()), "120x40-energy": ("120x40", "gg", ())}

    @staticmethod
    def steady(frame):
        """Numbers that are rounding alone differ from machine to machine."""
        return re.sub(r"-?\d(\.\d)?e-1[3-9]( m)?", lambda m: "~" * len(m.group(0)), frame)

    def test_frames_are_as_they_were(self):
        self.maxDiff = None
        for name, (size, keys, more) in self.FRAMES.items():
            with tempfile.TemporaryDirectory() as cache:
                status, out, err = once("four-bar", "--once", "--t", "3.5", "--size", size, "--keys", keys, *METHODS, *more, HOLONOM_CACHE=cache)
            self.assertEqual((name, status, err), (name, 0, ""))
            path = os.path.join(ROOT, "tests", "cli", "frames", name + ".txt")
            if os.environ.get("HOLONOM_RENEW"):
                with open(path, "w", encoding="utf-8") as file:
                    file.write(self.steady(out))
            with open(path, encoding="utf-8") as file:
                self.assertEqual(self.steady(out), file.read(), name)


class Keys(unittest.TestCase):
    def open(self, *words, **more):
        terminal = Terminal(*words, **more)
        self.addCleanup(terminal.close)
        # nothing moves before Space
        self.assertTrue(terminal.wait_for(rb"t 0\.000 s(.|\n)*paused"))
        terminal.type(" ")
        self.assertTrue(terminal.wait_for(rb"running"))
        return terminal

    def test_space_pauses_and_q_quits_and_the_terminal_is_restored(self):
        terminal = self.open("four-bar")
        terminal.type(" ")
        self.assertTrue(terminal.wait_for(rb"paused"))
        terminal.type("q")
        self.assertEqual(terminal.ended(), 0)
        self.assertIn(b"\033[?1049l", terminal.seen)
        self.assertEqual(termios.tcgetattr(terminal.slave), terminal.modes)

    def test_another_step_is_taken_and_a_bad_one_is_refused(self):
        terminal = self.open("four-bar")
        terminal.type("d0\r")
        self.assertTrue(terminal.wait_for(rb"dt must be above 0"))
        terminal.type("\x150,02\r")  # the refused line is still there: Ctrl-U clears it
        terminal.clear()
        terminal.type("m")
        self.assertTrue(terminal.wait_for(rb"projection@rk4:h=0.02"))

    def test_scenes_parameters_help_equations_and_lessons_open(self):
        terminal = self.open("four-bar")
        for key, wanted in (("?", rb"play or pause"), ("p", rb"length of the crank"), ("f", rb"J a|lambda"), ("t", rb"01-closed-loops"),
                            ("s", rb"bennett"), ("i", rb"why: index-1")):
            terminal.clear()
            terminal.type(key)
            self.assertTrue(terminal.wait_for(wanted), key)
            terminal.clear()
            terminal.type("\033")
            self.assertTrue(terminal.wait_for(rb"loop gap"), key)

    def test_a_lesson_is_shown_as_text_not_as_its_source(self):
        terminal = self.open("four-bar")
        terminal.type("t")
        self.assertTrue(terminal.wait_for(rb"01-closed-loops"))
        terminal.clear()
        terminal.type("\r")
        self.assertTrue(terminal.wait_for(rb"1. Loops and constraints\s*(\x1b\S*\s*)*=="))

    def test_a_parameter_out_of_reach_keeps_what_was_open(self):
        terminal = self.open("four-bar")
        terminal.type("p\r")
        terminal.type("\x7f" * 20 + "30\r")
        self.assertTrue(terminal.wait_for(rb"crank|l1|close"))
        terminal.type("\033")
        terminal.clear()
        terminal.type(" ")
        self.assertTrue(terminal.wait_for(rb"paused|running"))

    def test_a_study_runs_beside_it_and_stops_with_escape(self):
        terminal = self.open("stewart-6-6")  # whose study takes seconds
        terminal.type("w")
        self.assertTrue(terminal.wait_for(rb"Esc stops"))
        terminal.clear()
        terminal.type("\033")
        self.assertTrue(terminal.wait_for(rb"Esc goes back"))
        self.assertRegex(terminal.seen, rb"stopped at [0-9]+ %")  # it does not look whole
        terminal.type("q")
        self.assertTrue(terminal.wait_for(rb"loop gap"))
        terminal.type("q")
        self.assertEqual(terminal.ended(), 0)

    def test_a_recording_is_written_once_and_never_over_a_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "r.csv")
            terminal = self.open("four-bar")
            terminal.type("x\r" + "\x7f" * 20 + path + "\r")
            self.assertTrue(terminal.wait_for(rb"frames written"))
            with open(path) as file:
                head, first = file.readline(), file.readline()
            self.assertTrue(head.startswith('t,"gap index1@rk4'))
            self.assertTrue(first.startswith("0,"))
            terminal.clear()
            terminal.type("x\r" + "\x7f" * 20 + path + "\r")
            self.assertTrue(terminal.wait_for(rb"is there already"))

    def test_a_new_size_is_drawn(self):
        terminal = self.open("four-bar", columns=80, rows=24)
        terminal.clear()
        terminal.resize(120, 40)
        self.assertTrue(terminal.wait_for(rb"\033\[40;\d+H|\033\[40d|\033\[39;"))
        terminal.resize(20, 8)
        terminal.type("q")
        self.assertEqual(terminal.ended(), 0)

    def test_signals_restore_the_terminal(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGSEGV):
            terminal = self.open("four-bar")
            terminal.process.send_signal(number)
            self.assertEqual(terminal.ended(), -number)
            # each mode that was set is what it was: keys, mouse, the other screen; the title comes back
            modes = dict(re.findall(rb"\033\[\?(\d+)([hl])", terminal.seen))
            self.assertEqual((modes[b"1049"], modes[b"1"], modes[b"25"], modes[b"1006"]), (b"l", b"l", b"h", b"l"), number)
            self.assertEqual(re.findall(rb"\033([=>])", terminal.seen)[-1], b">")
            self.assertEqual(terminal.seen.count(b"\033[22;0;0t"), terminal.seen.count(b"\033[23;0;0t"))
            self.assertEqual(termios.tcgetattr(terminal.slave)[3] & termios.ECHO, terminal.modes[3] & termios.ECHO)

    def test_it_ends_after_the_pictures_asked_for(self):
        terminal = Terminal("four-bar", "--frames", "5")
        self.addCleanup(terminal.close)
        self.assertEqual(terminal.ended(), 0)

    def test_no_color_sends_no_colours(self):
        terminal = Terminal("four-bar", "--frames", "20", NO_COLOR="1")
        self.addCleanup(terminal.close)
        self.assertEqual(terminal.ended(), 0)
        self.assertNotRegex(terminal.seen, rb"\033\[[0-9;]*38;5")

    def test_a_joint_is_dragged_with_the_mouse_and_the_drag_is_undone(self):
        terminal = self.open("four-bar", columns=80, rows=24)
        terminal.type(" \x7f")
        self.assertTrue(terminal.wait_for(rb"t 0\.000 s|0\.000"))
        # the joint between crank and coupler stands at column 14 of row 6
        terminal.type("\033[<0;14;6M\033[<32;12;6M\033[<32;10;7M")
        self.assertTrue(terminal.wait_for(rb"let go: the methods start here"))
        terminal.type("\033[<0;10;7m")
        self.assertTrue(terminal.wait_for(rb"all methods start here now"))
        self.assertIn("&set.start.th1=", self.copied(terminal))
        terminal.type("z")
        self.assertTrue(terminal.wait_for(rb"undone"))
        self.assertNotIn("start.", self.copied(terminal))

    def copied(self, terminal):
        """The link that the key l hands to the terminal's clipboard."""
        terminal.clear()
        terminal.type("l")
        self.assertTrue(terminal.wait_for(rb"\033\]52;c;[A-Za-z0-9+/=]+\a"))
        terminal.type("q")  # the panel that shows it
        return base64.b64decode(re.findall(rb"\033\]52;c;([A-Za-z0-9+/=]+)\a", terminal.seen)[-1]).decode()

    def test_the_copied_link_is_whole_and_opens_the_same(self):
        terminal = self.open("four-bar", "--set", "l1=0.45", "--methods", *["baumgarte:alpha=5,beta=%d@rk4:h=0.01" % k for k in range(11, 19)])
        link = self.copied(terminal)
        self.assertGreater(len(link), 400)
        status, out, err = once(link, "--once", "--t", "0.1")
        self.assertEqual((status, err), (0, ""))
        self.assertEqual(len(re.findall(r"Baumgarte", out)), 8)

    def test_the_link_keeps_speed_and_plot_in_the_fields_of_the_page(self):
        def link(keys, scene="four-bar"):
            out = once(scene, "--once", "--t", "0.1", "--size", "300x30", "--keys", keys + "l")[1]
            return re.search(r"http\S+", out).group(0)
        self.assertNotRegex(link(""), "speed|upper")
        for keys, fields, seen in (("---g", "&speed=0.1&upper=off", ("×0.1", "─ error against the reference")), ("=gg", "&speed=2&upper=energy_change", ("×2", "─ energy change, size"))):
            copied = link(keys)
            self.assertTrue(copied.endswith(fields), copied)
            out = once(copied, "--once", "--t", "0.1", "--size", "100x30")[1]
            for words in seen:
                self.assertIn(words, out)
            self.assertTrue(link("", copied).endswith(fields))
        # the page draws other quantities too, and says more about one
        self.assertIn("×5", once("#scene=four-bar&speed=5&upper=sigma_min,table", "--once", "--t", "0.1")[1])
        self.assertTrue(link("", "#scene=four-bar&upper=off,table").endswith("&upper=off"))
        self.assertIn("speed is 'fast'; a number from 0.001 to 1000 is needed", " ".join(once("#scene=four-bar&speed=fast", "--once", "--t", "0.1")[1].split()))

    def test_a_link_opens_paused_in_a_terminal(self):
        terminal = Terminal("#scene=four-bar&method=projection@rk4:h=0.02&frame=50")
        self.addCleanup(terminal.close)
        self.assertTrue(terminal.wait_for(rb"paused"))
        self.assertNotIn(b"running", terminal.seen)
        # the frame is recorded first
        end = time.monotonic() + PATIENCE
        while "&frame=50&" not in (link := self.copied(terminal)):
            self.assertLess(time.monotonic(), end, link)

    def test_the_link_is_shown_whole_in_a_narrow_window(self):
        methods = ["baumgarte:alpha=5,beta=%d@rk4:h=0.01" % k for k in range(11, 19)]
        _, out, _ = once("four-bar", "--once", "--t", "0.1", "--set", "l1=0.6", "--methods", *methods, "--keys", "l")
        lines = [line[1:-1].strip() for line in out.split("\n") if line.startswith("│")]
        link = "".join(lines[lines.index("") + 1:]).split("It opens")[0]
        self.assertTrue(link.startswith("http://127.0.0.1:8080/#scene=four-bar&set.l1=0.6&"), link)
        self.assertEqual([m in link for m in methods], [True] * 8)
        self.assertTrue(link.endswith("&selected=0"), link)

    def test_a_cell_of_the_map_is_taken_and_says_what_was_before(self):
        with tempfile.TemporaryDirectory() as cache:
            status, out, err = once("four-bar", "--once", "--t", "3.5", "--keys", "b<Right><Right><Right><Up><Enter>", *METHODS, HOLONOM_CACHE=cache)
        self.assertEqual((status, err), (0, ""))
        self.assertRegex(out, r"alpha = [\d.]+, beta = [\d.]+; until 3\.50 s: worst gap [\d.]+ [µm]m, before\s+[\d.]+ mm;\s+energy\s+change\s+[\d.]+ m?J,\s+before\s+\d+ mJ")

    def exercise(self, name, keys, size="100x60"):
        """The frame after these keys in an exercise, its answers, and what is said of the whole."""
        listed = json.loads(subprocess.run([PROGRAM, "list", "problems", "--json"], capture_output=True, check=True).stdout)["problems"]
        lessons = [one["id"] for one in json.loads(subprocess.run([PROGRAM, "list", "lessons", "--json"], capture_output=True, check=True).stdout)["lessons"]]
        rows = [row for lesson in lessons for row in [lesson] + [one["id"] for one in listed if one["lesson"] == lesson]]
        status, out, err = once("--once", "--size", size, "--keys", "t" + "<Down>" * rows.index(name) + "<Enter>" + keys)
        self.assertEqual((status, err), (0, ""))
        self.assertIn("exercise: Enter types an answer", out)
        return out

    def grade(self, name, submission):
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump(submission, file)
            file.flush()
            return json.loads(subprocess.run([PROGRAM, "grade", name, file.name, "--json"], capture_output=True, check=True).stdout)

    def test_an_exercise_is_answered_by_the_grader_of_the_shell(self):
        cases = {
            # formulas, a number with its unit; one sign is wrong, which has a name
            "closure": ("<Enter>-l1 sin(th1) u1 - l2 sin(th2) u2<Enter><Enter>l3 sin(th3) u3<Enter><Enter>1.2 rad/s<Enter>c",
                        {"a": "-l1 sin(th1) u1 - l2 sin(th2) u2", "b": "l3 sin(th3) u3", "c": "1.2 rad/s"}, "the sign is wrong"),
            # entries of a matrix, some left empty
            "p3": ("<Enter>-l1 sin(th1)<Enter><Down><Enter>l3 * sin(th3)<Enter>c",
                   {"J": [["-l1 sin(th1)", "", "l3 * sin(th3)", ""], ["", "", "", ""]]}, "nothing was handed in here"),
            # only one part is answered
            "ring": ("<Down><Enter>6<Enter>c", {"b": 6}, "nothing was handed in")}
        for name, (keys, submission, said) in cases.items():
            verdict, out = self.grade(name, submission), self.exercise(name, keys)
            # the workbench counts parts where one of them has several answers
            counted = r"\d of 4 parts are right" if name == "closure" else re.escape(verdict["summary"][:40])
            self.assertRegex(out, rf"{verdict['score']:g} of {verdict['max_score']:g} points: {counted}", name)
            self.assertIn(said, out, name)
            self.assertGreater(verdict["max_score"], verdict["score"], name)

    def test_a_number_beyond_the_largest_one_is_called_so(self):
        for part, down in (("b", "<Down>"), ("d", "<Down><Down><Down>")):
            out = " ".join(self.exercise("ring", f"{down}<Enter>1e999<Enter>c", "160x60").split())
            self.assertIn("'1e999' is beyond the largest number, 1.8e+308", out, part)
        # in a list of numbers as well
        out = " ".join(self.exercise("ring", "<Down><Enter>[1e999]<Enter>c", "160x60").split())
        self.assertNotIn("nothing was handed in here given null", out)

    def test_a_choice_with_its_reason_is_two_letters_and_a_file_answers_too(self):
        out = self.exercise("p1", "", "100x100")
        self.assertIn("a letter, a blank, the letter of the reason", out)
        part = re.findall(r"^│ (\w+)\) \[", out, re.M)[[i for i, text in enumerate(re.split(r"^│ \w+\) \[", out, flags=re.M)[1:]) if "reason" in text][0]]
        down = "<Down>" * (re.findall(r"^│ (\w+)\) \[", out, re.M).index(part))
        for choice in "abc":
            verdict = self.grade("p1", {part: {"choice": choice, "reason": "b"}})
            said = self.exercise("p1", f"{down}<Enter>{choice}, b<Enter>c", "100x100")
            self.assertIn(f"{verdict['score']:g} of {verdict['max_score']:g} points", said, choice)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "b.json")
            with open(path, "w") as file:
                file.write("6")
            self.assertEqual(self.exercise("ring", f"<Down><Enter>@{path}<Enter>c").split("b = @")[1].split("\n")[1].strip("│ "),
                             self.exercise("ring", "<Down><Enter>6<Enter>c").split("b = 6")[1].split("\n")[1].strip("│ "))
            self.assertIn("not checked:", self.exercise("ring", f"<Enter>@{path}x<Enter>c"))

    def test_hints_come_one_by_one_and_answers_stay(self):
        self.assertIn("h shows a hint (0 of 2 shown)", self.exercise("closure", ""))
        one = self.exercise("closure", "h")
        self.assertIn("hint 1 of 2:", one)
        self.assertIn("Formulas: a*b or a b", one)
        self.assertIn("h shows another hint (1 of 2 shown)", one)
        self.assertNotIn("hint 2 of 2", one)
        self.assertIn("all 2 hints are shown", self.exercise("closure", "hhh"))
        self.assertIn("this exercise has no hints", self.exercise("p3", "h"))
        # a changed answer takes the verdict away; closed and opened again it has its answers
        self.assertIn("right, 1 of 1 point", self.exercise("p3", "<Enter>-l1 sin(th1)<Enter>c"))
        self.assertNotIn("of 6 points:", self.exercise("closure", "<Enter>2<Enter>c<Enter>3<Enter>"))
        self.assertIn("a = 2", self.exercise("closure", "<Enter>2<Enter><Esc><Enter>"))
        # the part that is chosen is in sight in a small window
        for i, part in enumerate("abcd"):
            self.assertRegex(self.exercise("closure", "<Down>" * i, "80x24"), rf"(?m)^│ > {part} = \.\.\. \(Enter types\)")

    def test_a_program_is_exported(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([PROGRAM, "tui", "four-bar", "--once", "--keys", "x<Down><Enter><Enter>"], capture_output=True, timeout=600, cwd=folder,
                                  stdin=subprocess.DEVNULL, env={**os.environ, "LC_ALL": "C.UTF-8"})
            self.assertEqual(done.returncode, 0, done.stderr)
            with open(os.path.join(folder, "four_bar.py"), encoding="utf-8") as file:
                self.assertIn("numpy", file.read())

    def test_a_parameter_moves_with_the_arrows_and_can_be_undone(self):
        _, out, _ = once("four-bar", "--once", "--keys", "p<Down><Right>")
        self.assertRegex(out, r"l2 +1\.25 m")
        _, out, _ = once("four-bar", "--once", "--keys", "p<Down><Right><Esc>zp")
        self.assertRegex(out, r"l2 +1\.2 m")
        _, out, _ = once("four-bar", "--once", "--keys", "p<Down><Right><Esc>zyp")
        self.assertRegex(out, r"l2 +1\.25 m")

    def test_the_list_of_scenes_has_a_picture(self):
        _, out, _ = once("four-bar", "--once", "--keys", "sb")
        lines = [line[45:78] for line in out.split("\n")[2:20]]
        self.assertRegex("".join(lines), "[\u2801-\u28ff]{3}")

    def test_a_remedy_is_tried_from_the_card_of_the_reasons(self):
        # index-1 at 20 ms has opened: methods that close the loop are first, and smaller steps are
        # said to put it off
        def after(keys):
            return once("four-bar", "--once", "--t", "4", "--size", "120x40", *METHODS[:2], "--keys", "i<Enter>" + keys)[1]
        listed = after("")
        self.assertIn("what index-1 can try", listed)
        self.assertRegex(listed, r"(?m)^│ projection@rk4:h=0\.02 .*\n│ baumgarte\S+ .*\n│ ggl\S+ .*\n│ h=0\.01 +only puts it off")
        added = after("<Enter><Esc>")
        self.assertRegex(added, r"2. projection .*closed")
        # its gap and energy beside those of the method that was selected, where time has passed
        told = " ".join(after("<Enter>").split())
        self.assertRegex(told, r"method 2: projection@rk4:h=0\.02 \(before: method 1\); until 4\.00 s: worst gap \S+ m, before [\d.]+ mm; energy change \S+ mJ, before")
        _, out, _ = once("four-bar", "--once", "--t", "0", "--keys", "m<End><Enter><Enter><Enter>", *METHODS[:2])
        self.assertNotIn("before", out)
        smaller = after("<Down><Down><Down><Enter>")
        self.assertRegex(smaller, r"h = 0\.01; until 4\.00 s: worst gap [\d.]+ mm, before [\d.]+ mm")
        # a remedy that is there already is selected, not added twice
        twice = after("<Enter><Up>i<Esc>1i<Enter><Enter>")
        self.assertEqual(len(re.findall(r"(?m)^│\d\S +projection", twice)), 1)
        _, out, _ = once("four-bar", "--once", "--t", "0.1", "--keys", "i<Enter>", "--methods", "projection@rk4:h=0.001")
        self.assertIn("nothing has happened that asks for a remedy", out)
        # the card offers Enter only where it has something to try
        def card(*words):
            return re.search(r"why: [^─]*", once("four-bar", "--once", "--size", "120x40", "--keys", "i", *words)[1]).group()
        self.assertEqual(card("--t", "4", *METHODS[:2]).strip(), "why: index-1 (Enter tries, i closes)")
        self.assertEqual(card("--t", "0.1", "--methods", "projection@rk4:h=0.001").strip(), "why: projection (i closes)")

    def test_incidents_without_room_are_counted_and_paged_to(self):
        def card(keys):
            return once("parallelogram", "--once", "--size", "100x30", "--keys", keys)[1]
        before, after = card("1i"), card("1i<PageDown>")
        self.assertGreater(int(re.search(r"PageDown: (\d+) more", before).group(1)), int(re.search(r"PageDown: (\d+) more", after).group(1)))
        # what became of the motion stands first, then errors, then warnings
        self.assertIn("worst so far: open by", before)
        self.assertNotIn("PageDown: ", card("1i" + 40 * "<PageDown>").split("methods")[0])
        self.assertEqual(card("1i<PageDown><PageUp>"), before)

    def test_the_card_says_which_remedies_were_tried_and_which_not(self):
        # a loop that opens is tried against; a restart of the integrator or a long step is not
        _, out, _ = once("four-bar", "--once", "--t", "4", "--size", "150x40", *METHODS[:2], "--keys", "i")
        card = " ".join("".join(line[67:149] for line in out.split("\n")[2:20]).split())
        self.assertRegex(card, r"try projection@rk4:h=0\.02 \(tried until t = [\d.]+ s: largest gap")
        self.assertNotIn("not tried", card)
        _, out, _ = once("triple-rocker", "--once", "--t", "1", "--size", "150x60", "--methods", "nullspace@rk4:h=0.02", "--keys", "i")
        card = " ".join("".join(line[67:149] for line in out.split("\n")[2:50]).split())
        self.assertNotRegex(card, r"(?<!\() try (?!\S+ \(tried until)")

    def test_the_card_counts_incidents_that_are_not_listed(self):
        def card(scene, method):
            _, out, _ = once(scene, "--once", "--t", "3", "--size", "150x60", "--methods", method, "--keys", "i")
            return " ".join("".join(line[68:149] for line in out.split("\n")[2:58]).replace("│", " ").split())
        # flat twelve times in 5 s
        # a line may end anywhere
        self.assertRegex(card("parallelogram", "projection@rk4:h=1e-3"), r"again at [\d., ]+ s: 12 times in all")
        # five of a kind at most: all have their time
        times, n = re.search(r"limit of 1\.2 mm +again at ([\d., ]+) s: (\d) times in all", card("four-bar", "baumgarte@rk4:h=0.02")).groups()
        self.assertEqual(len(times.split(",")) + 1, int(n))

    def test_the_cheapest_method_for_an_error_keeps_that_error(self):
        methods = ("--methods", "index1@rk4:h=0.02", "index1@euler:h=0.02")
        with tempfile.TemporaryDirectory() as cache:
            def study(keys):
                return once("pendulum", "--once", "--t", "0.5", "--size", "150x40", *methods, "--keys", "wt2<Enter>" + keys, HOLONOM_CACHE=cache)[1]
            out = " ".join("".join(line[100:149] for line in study("").split("\n")[2:20]).split())
            self.assertRegex(out, r"For an error of 1 mm at the end of a bar of [\d.]+ m \(\S+ of its length\) up to t = 2 s of the scene's 10 s: index1@rk4 with h = \S+ s is the cheapest, ((about|at most) )?\d\S*")
            self.assertIn("In this study errors are the largest at 1024 times", out)
            # the axes have names, and no unit where there is none
            out = study("")
            self.assertIn("error of the coordinates over operations (log, no units; ╳: ended)", out)
            self.assertRegex(out, r"(?m)^│ +\d\S* +operations +\d\S* ")
            self.assertIn("is no error above 0; type one as 1 mm", study("e<CtrlU>0<Enter>"))
            self.assertIn("no run of this study is accurate enough", study("e<CtrlU>1e-15<Enter><Enter>"))
            # what is added by Enter has the error that was asked for, in the study's 2 s; a third of it at least, as its size is read off a line between two points for half of it
            methods = ("--methods", "index1@euler:h=0.02")
            listed = study("e<CtrlU>1 %<Enter><Enter>m")
        method = re.search(r"│ (index1@euler:h=(?!0\.02 )\S+)", listed).group(1)
        run = json.loads(subprocess.run([PROGRAM, "run", "pendulum", "--method", method, "--time", "2", "--json"], capture_output=True, check=True).stdout)
        self.assertLess(run["error_estimate"]["q"], 1e-2)
        self.assertGreater(run["error_estimate"]["q"], 0.33e-2)

    def test_after_a_change_of_length_the_error_is_unknown_until_its_reference_is_there(self):
        words = ("four-bar", "--once", "--t", "2", "--set", "l1=0.57", "--methods", "projection@rk4:h=0.002", "--keys")
        with tempfile.TemporaryDirectory() as cache:
            # one frame computes none and says how one is had
            out = once(*words, "g", HOLONOM_CACHE=cache)[1]
            self.assertIn("closed, error unknown", out)
            self.assertIn("no reference motion is", out)
            subprocess.run([PROGRAM, "reference", "four-bar", "--set", "l1=0.57"], capture_output=True, check=True, env={**os.environ, "HOLONOM_CACHE": cache})
            out = once(*words, "g", HOLONOM_CACHE=cache)[1]
            self.assertRegex(out, r"projection .*right to \d digits")
            self.assertIn("│  1e-", out)
        # in a terminal it is computed beside the motion
        with tempfile.TemporaryDirectory() as cache:
            terminal = self.open("four-bar", "--methods", "projection@rk4:h=0.002", "--set", "l1=0.57", HOLONOM_CACHE=cache)
            self.assertTrue(terminal.wait_for(rb"right to \d"))
            self.assertTrue(any(name.startswith("reference-") for name in os.listdir(cache)))

    def test_joint_forces_are_those_of_run(self):
        method, at = "projection@rk4:h=0.01", "1"
        done = subprocess.run([PROGRAM, "run", "four-bar", "--method", method, "--time", at, "--at", at, "--reactions", "--json"], capture_output=True, check=True)
        run = json.loads(done.stdout)
        _, out, _ = once("four-bar", "--once", "--t", at, "--size", "120x40", "--methods", method, "--keys", "r")
        rows = {name: [float(x) for x in numbers.split()] for name, numbers in re.findall(r"│ (\w+: \w+(?: \[N\])?)((?: +-?[\d.e+-]+)+) *│", out)}
        forces = [run["samples"]["reaction_force"][0][3 * i:3 * i + 3] for i in range(len(run["carriers"]))]
        for name, (x, y, z) in zip(run["carriers"], forces):
            row = next(numbers for key, numbers in rows.items() if key.startswith(name + ": ") and "[N]" not in key)
            self.assertEqual(z, 0)
            for seen, true in zip(row, (math.hypot(x, y), x, y)):
                self.assertAlmostEqual(seen / true, 1, delta=5e-3, msg=name)  # three digits are shown
        for name, true in zip(("B: x [N]", "B: y [N]"), run["samples"]["lambda"][0]):
            self.assertAlmostEqual(rows[name][0] / true, 1, delta=5e-3, msg=name)

    def test_joint_forces_scroll_and_say_what_has_no_room_and_when_they_are_not_unique(self):
        def view(scene, keys, size="80x24", *words):
            return once(scene, "--once", "--t", "0.1", "--size", size, *words, "--keys", "r" + keys)[1]
        self.assertIn("no room for z, [N m]", view("stewart-6-3", "<PageDown>" * 9))
        self.assertRegex(view("stewart-6-3", "<PageDown>" * 9, "150x30"), r"S6: platform .*-15 +33\.2 +16\.4 +0 *│")
        self.assertIn("multipliers lambda: determined", view("stewart-6-3", "<PageDown><PageUp><PageUp>"))
        self.assertIn("multipliers lambda: one of many", view("bennett", ""))
        self.assertIn("no multipliers", view("pendulum", ""))
        # another key, another view; r closes
        self.assertIn("loop gap", view("four-bar", "r"))
        self.assertIn("loop gap", view("four-bar", "<Esc>"))
        self.assertIn("why: index-1", view("four-bar", "i"))
        self.assertIn("joint forces: Baumgarte", view("four-bar", "<Down>"))
        # a method that has ended has no state
        self.assertIn("has ended before this time", once("four-bar", "--once", "--t", "9", "--methods", "index1@euler:h=0.5", "--keys", "r")[1])

    def test_frames_are_those_of_the_page_and_a_new_step_keeps_the_moment(self):
        # frames are multiples of the largest step of at least 1/60 s: 3 s are frame 150 of 20 ms, as in the page
        _, out, _ = once("four-bar", "--once", "--t", "3", "--size", "200x30", "--keys", "l", *METHODS)
        self.assertIn("&frame=150&", out)
        _, out, _ = once("four-bar", "--once", "--t", "3", "--keys", "d0.05<Enter>", *METHODS)
        self.assertIn("t 3.000 s of 10 s", out)
        # where the frames do not end with the motion, the last one counts as its end
        _, out, _ = once("pendulum", "--once", "--methods", "index1@rk4:h=0.017")
        self.assertIn("t 10.000 s of 10 s", out)

    def test_a_model_error_is_said_in_the_table(self):
        _, out, _ = once("four-bar", "--once", "--t", "1", "--size", "120x30", "--methods", "nullspace-as-printed@rk4:h=0.001")
        self.assertRegex(out, r"model error: closed, but \d+ mm from the true motion")
        # whole in a narrow terminal too, and with a long name
        words = ("four-bar", "--once", "--t", "1", "--methods", "nullspace@rk4:h=0.001")
        _, out, _ = once(*words, "nullspace-as-printed@rk4:h=0.001")
        self.assertRegex(out, r"model error: closed, but \d+ mm off +│")
        _, out, _ = once(*words, "nullspace-as-printed:basis=unit-length@rk4:h=0.001")
        self.assertRegex(out, r"model error: \d+ mm off +│")

    def test_the_missing_term_stands_above_the_equations_whichever_method_is_selected(self):
        words = ("four-bar", "--once", "--t", "0.1", "--methods", "index1@rk4:h=0.01", "nullspace-as-printed@rk4:h=0.001")
        for keys in ("f", "2f"):
            self.assertIn("missing on the left side:  N' M (dN/dt) u", once(*words, "--keys", keys)[1])
        self.assertNotIn("MISSING", once("four-bar", "--once", "--t", "0.1", "--keys", "f", *METHODS)[1])

    def test_what_is_typed_is_searched_in_the_list_of_scenes(self):
        def found(keys, size="120x40"):
            _, out, _ = once("four-bar", "--once", "--size", size, "--keys", "s" + keys)
            return out
        # a word of the name, of the description, of the kind; two words: both must be there
        self.assertRegex(found("STEW"), r"scenes with 'stew': \d+ of \d+")
        self.assertIn("stewart", found("STEW"))
        self.assertIn("cardan-shaft", found("fork universal"))
        self.assertNotIn("cardan-shaft", found("fork wheelbarrow"))
        self.assertIn("no scene has all of these words", found("fork wheelbarrow"))
        self.assertRegex(found("cardanx<Backspace>"), r"scenes with 'cardan': 1 of \d+")
        self.assertRegex("".join(line[70:115] for line in found("cardan").split("\n")[2:36]), "[\u2801-\u28ff]{3}")
        # Escape first forgets the words, then the list; Enter opens what was found
        self.assertRegex(found("cardan<Esc>"), r"scenes: type to search")
        self.assertIn("loop gap", found("cardan<Esc><Esc>"))
        self.assertRegex(found("cardan<Enter>"), r"holonom  cardan-shaft")
        self.assertIn("1 degree of freedom (4 − 3", " ".join(found("cardan", "80x24").replace("│", " ").split()))
        # a hit in the name comes before one in the text
        self.assertRegex(found("triple<Enter>"), r"holonom  triple-rocker")

    def test_values_taken_from_a_map_have_four_digits_and_long_ones_are_shown_so(self):
        with tempfile.TemporaryDirectory() as cache:
            _, out, _ = once("four-bar", "--once", "--t", "3.5", "--keys", "b<Right><Right><Right><Up><Enter>m", *METHODS, HOLONOM_CACHE=cache)
        values = re.search(r"baumgarte:alpha=([\d.]+),beta=([\d.]+)@", out).groups()
        self.assertLessEqual(max(len(v.replace(".", "")) for v in values), 4, values)
        long = ("--methods", "baumgarte:alpha=5.568857379998894,beta=7@rk4:h=0.01")
        _, out, _ = once("four-bar", "--once", "--t", "0.1", "--size", "100x24", "--keys", "m", *long)
        self.assertIn("baumgarte:alpha=5.569,beta=7@rk4:h=0.01", out)
        # what is typed stays: the line that changes it, and the link
        _, out, _ = once("four-bar", "--once", "--t", "0.1", "--size", "100x24", "--keys", "m<Enter>", *long)
        self.assertIn("method: baumgarte:alpha=5.568857379998894,beta=7@rk4:h=0.01", out)

    def test_the_last_line_names_the_keys_of_what_is_open(self):
        for keys, wanted in (("", "Space run"), ("s", "letters search"), ("m", "x remove"), ("p", "←→ change"), ("f", "PageDown"), ("t", "Enter open"),
                             ("x", "name a file"), ("?", "Enter do it")):
            _, out, _ = once("four-bar", "--once", "--t", "0.1", "--keys", keys)
            self.assertIn(wanted, out.rstrip("\n").split("\n")[-1], keys)

    def test_keys_that_are_none_and_too_many_methods_are_refused(self):
        status, _, err = once("--once", "--keys", "g<Foo>")
        self.assertEqual(status, 2)
        self.assertIn("'<Foo>' does not begin with a key", err)
        status, _, err = once("--once", "--methods", *["index1@rk4"] * 9)
        self.assertEqual(status, 2)
        self.assertIn("8 methods", err)

    def test_arrows_are_read_in_the_form_of_either_mode(self):
        for down in ("\x1b[B", "\x1bOB"):
            terminal = self.open("four-bar")
            self.assertTrue(terminal.wait_for(rb"index-1"))
            terminal.type("i")
            self.assertTrue(terminal.wait_for(rb"why: "))
            terminal.clear()
            terminal.type(down)
            self.assertTrue(terminal.wait_for(rb"Baumgarte"), down)
            self.assertNotIn(b"has no meaning", terminal.seen)

    def test_a_sequence_of_no_key_does_nothing(self):
        terminal = self.open("four-bar")
        terminal.type("i")
        self.assertTrue(terminal.wait_for(rb"why: "))
        terminal.clear()
        for unknown in ("\x1b[25;2~", "\x1bOz", "\x1b[1;9Z"):
            terminal.type(unknown)
        terminal.type("\x1b[1~")  # Home of some terminals
        self.assertTrue(terminal.wait_for(rb"paused"))
        self.assertNotIn(b"has no meaning", terminal.seen)
        self.assertNotIn(b"loop gap", terminal.seen)  # the card stays open

    def test_the_mouse_selects_a_time_in_the_plot(self):
        terminal = self.open("four-bar")
        terminal.type("\033[<0;80;10M\033[<0;80;10m")
        self.assertTrue(terminal.wait_for(rb"paused"))

    def test_a_click_does_nothing_while_the_window_is_too_small(self):
        terminal = self.open("four-bar")
        terminal.resize(31, 24)
        self.assertTrue(terminal.wait_for(rb"too small"))
        terminal.type("\033[<0;25;4M\033[<0;25;4m")  # where the plot would be
        self.assertTrue(terminal.taken())
        terminal.clear()
        terminal.resize(100, 30)
        self.assertTrue(terminal.wait_for(rb"running|paused"))
        self.assertNotIn(b"paused", terminal.seen)


if __name__ == "__main__":
    driver.main()
