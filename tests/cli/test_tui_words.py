# SPDX-License-Identifier: GPL-3.0-or-later
# The words of the terminal workbench: whose step a key changes, which remedy runs already, what was written.
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402
from terminal import PROGRAM, Terminal, message, notice, once  # noqa: E402

OPENS = ("--methods", "index1@rk4:h=0.02", "projection@rk4:h=0.02")  # the first one's loop opens


class Table(unittest.TestCase):
    def test_eighty_columns_show_gap_and_error_and_the_whole_verdict(self):
        _, out, _ = once("four-bar", "--once", "--t", "3.5")
        head = next(line for line in out.split("\n") if "methods" in line)
        self.assertEqual(re.findall(r"gap|error|energy|ops", head), ["gap", "error"])
        self.assertRegex(out, r"(?m)^│1\S index-1 +[\d.]+ mm +[\d.]+ mm ↗ open by [\d.]+ mm and \d+ mm from the true motion │$")
        # with more room the energy comes before the cost
        for columns, heads in ((88, ["gap", "error"]), (95, ["gap", "error", "energy"]), (120, ["gap", "error", "energy", "ops"])):
            _, out, _ = once("four-bar", "--once", "--t", "1", "--size", f"{columns}x24")
            head = next(line for line in out.split("\n") if "methods" in line)
            self.assertEqual(re.findall(r"gap|error|energy|ops", head), heads, columns)

    def test_the_longest_line_of_keys_that_fits_is_shown_whole(self):
        for columns in (80, 92, 100, 106, 120):
            _, out, _ = once("four-bar", "--once", "--t", "0.1", "--size", f"{columns}x24")
            self.assertTrue(out.rstrip("\n").endswith(("? menu  q", "? menu  q quit")), columns)


    def test_an_arrow_does_not_end_the_search_of_scenes(self):
        _, out, _ = once("four-bar", "--once", "--size", "100x30", "--keys", "sxq<Down><Backspace><Backspace>benn<Enter>")
        self.assertRegex(out, r"holonom +bennett")

    def test_x_on_a_row_that_is_no_method_says_so(self):
        _, out, _ = once("four-bar", "--once", "--size", "100x30", "--keys", "m<End>x")
        self.assertIn("x removes a method of the list; none is chosen", out)
        _, out, _ = once("four-bar", "--once", "--size", "100x30", "--methods", "projection@rk4:h=0.01", "--keys", "mx")
        self.assertIn("one method stays", out)

    def test_a_method_that_has_stopped_is_told_to_the_end_with_its_reason(self):
        words = ("triple-rocker", "--once", "--t", "5", "--methods", "projection@rk4:h=0.01", "reduced@rk4:h=0.01")
        _, out, _ = once(*words, "--size", "120x40")
        self.assertRegex(out, r"(?m)^│2\S reduced .* stopped at 0\.\d\d s: a dead point of the independent coordinates +│$")
        self.assertRegex(" ".join(out.split()), r"! reduced at 0\.\d\d s: .*past a dead point")

    def test_a_model_error_is_none_that_starts_closed(self):
        _, out, _ = once("four-bar", "--once", "--t", "0.02", "--size", "100x30", "--methods", "nullspace-as-printed@rk4:h=0.01", "projection@rk4:h=0.01")
        self.assertIn("model error: it solves other equations", out)
        self.assertRegex(out, r"2\S projection .* starts closed")

    def test_incidents_and_cards_name_the_options_in_which_methods_differ(self):
        methods = ("--methods", "baumgarte:alpha=5,beta=5@rk4:h=0.02", "baumgarte:alpha=20,beta=20@rk4:h=0.02")
        _, out, _ = once("four-bar", "--once", "--t", "10", "--size", "120x40", "--keys", "2i", *methods)
        self.assertIn("why: Baumgarte 20/20", out)
        self.assertRegex(out, r"! Baumgarte 20/20 at ")

    def test_the_frame_of_the_mechanism_says_what_it_is(self):
        for size, title in (("80x24", "crank-rocker"), ("100x30", "crank-rocker, 1 degree of freedom"),
                            ("200x60", "crank-rocker, 1 degree of freedom (3 − 2 independent constraints)")):
            self.assertIn(f"─ {title} ─", once("four-bar", "--once", "--size", size)[1], size)

    def test_a_parameter_that_is_taken_is_said(self):
        _, out, _ = once("four-bar", "--once", "--size", "100x30", "--keys", "p<Enter><CtrlU>45 cm<Enter>")
        self.assertIn("l1 = 0.45 m: the methods start again; p changes another one", out)

    def test_methods_that_differ_in_their_step_alone_show_it(self):
        _, out, _ = once("pendulum", "--once", "--t", "0.1", "--size", "100x30", "--methods", "index1@rk4:h=0.02", "index1@rk4:h=0.01", "projection@rk4:h=0.02")
        self.assertRegex(out, r"index-1 20 ms +[^\n]*\n[^\n]*index-1 10 ms ")
        self.assertRegex(out, r"projection  +\S")

    def test_own_options_of_a_method_stand_in_its_row(self):
        def names(*methods):
            out = once("four-bar", "--once", "--t", "0.1", "--methods", *methods)[1]
            return re.findall(r"(?m)^│\d\S +(\S.*?) +[\d.e-]+ [µnm]?m ", out)
        self.assertEqual(names("baumgarte:alpha=20,beta=20@rk4", "projection@rk4"), ["Baumgarte 20/20", "projection"])
        self.assertEqual(names("baumgarte@rk4", "index1@rk4"), ["Baumgarte", "index-1"])
        # beside another of the same name the default is said too
        self.assertEqual(names("baumgarte@rk4", "baumgarte:alpha=20,beta=20@rk4"), ["Baumgarte 5/5", "Baumgarte 20/20"])
        self.assertEqual(names("nullspace-as-printed:basis=unit-length@rk4"), ["as printed unit-length"])
        # a name that is too long ends at a word, with a sign that it goes on
        self.assertEqual(names("augmented-lagrangian:omega=25,iterations=5@rk4:h=0.01"), ["augm. omega=25…"])

    def test_names_are_shortened_before_the_energy_goes(self):
        methods = ("baumgarte:alpha=20,beta=20@rk4:h=0.02", "baumgarte:alpha=20,beta=20@rk4:h=0.01")
        for size, named in (("100x30", "Bau. 20/20"), ("120x30", "Baumgarte 20/20")):
            out = once("four-bar", "--once", "--t", "0.5", "--size", size, "--methods", *methods)[1]
            self.assertRegex(out, r"now: gap ─+ error ─+ energy", size)
            self.assertIn(f"{named} 20 ms", out)
            self.assertIn(f"{named} 10 ms", out)

    def test_a_changed_method_says_its_numbers_before_and_after_and_its_warning(self):
        def said(alpha):
            keys = f"m<Down><Enter><CtrlU>baumgarte:alpha={alpha},beta=20@rk4:h=0.02<Enter>"
            out = once("four-bar", "--once", "--t", "10", "--keys", keys, "--methods", "index1@rk4:h=0.02", "baumgarte@rk4:h=0.02")[1]
            return " ".join(out.split("└")[-1].split())
        # the table of the lesson: the gap falls, the energy is hardly better
        self.assertRegex(said(20), r"method 2: baumgarte:alpha=20,beta=20@rk4:h=0\.02; until 10\.00 s: worst gap 6\d\d µm, before [23]\.\d mm; energy change [67]\d\d mJ, before [78]\d\d mJ")
        self.assertIn("alpha = -5 1/s is negative: it drives the loop open; until it stopped at 2.26 s: ", said(-5))
        # its gap is that of the incident that ended it, not that of the last frame before
        self.assertRegex(said(-5), r"worst gap 67\d mm, energy change \S+ J; before, until 10\.00 s: worst gap [23]\.\d mm")

    def test_the_mechanism_lies_above_its_scale_bar(self):
        # at the end the crank of the unstabilised run hangs lowest
        for size in ("80x24", "120x40"):
            _, out, _ = once("four-bar", "--once", "--t", "10", "--size", size)
            bar = next(line for line in out.split("\n") if "├──" in line and " mm" in line)
            self.assertRegex(bar, r"^│ ├─+┤ \d+ mm +│", size)

    def test_the_heads_say_what_is_now_and_what_the_worst(self):
        for columns in (80, 120):
            _, out, _ = once("four-bar", "--once", "--t", "1", "--size", f"{columns}x24")
            self.assertRegex(out, r"methods ─* now: gap ─+ error ─.* worst so far ─", columns)

    def test_a_window_without_room_for_the_views_says_so(self):
        # one row or column less than the size that is named is too small, and that size is not
        for size, small in (("40x12", True), ("32x16", True), ("31x17", True), ("32x17", False), ("80x24", False)):
            status, out, err = once("four-bar", "--once", "--t", "0.1", "--size", size)
            self.assertEqual((status, "32x17 is needed" in err), (2, True) if small else (0, False), (size, err))
            self.assertEqual("e-17┤" in out or "e-16┤" in out or "e-15┤" in out, not small, size)

    def test_keys_do_nothing_while_the_window_is_too_small(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "r.csv")
            for size, written in (("40x12", False), ("80x24", True)):
                once("pendulum", "--once", "--t", "0.1", "--size", size, "--keys", f"x<Enter><CtrlU>{path}<Enter>")
                self.assertEqual(os.path.exists(path), written, size)

    def test_a_narrow_line_of_keys_keeps_its_end(self):
        for columns, keys, wanted in ((60, "", "Space run  ←→ step  1-8 method  d dt  g plot  ? menu  q"), (40, "", "Space run  ←→ step  ? menu  q quit"),
                                      (60, "i", "Enter try a remedy  ↑↓ another method  ? menu  q quit"), (40, "s", "letters search  Backspace  Esc back"),
                                      (40, "t", "↑↓ choose  Enter open  Esc back")):
            _, out, _ = once("four-bar", "--once", "--t", "4", "--size", f"{columns}x24", "--keys", keys)
            self.assertEqual(out.rstrip("\n").split("\n")[-1].strip(), wanted, (columns, keys))

    def test_a_time_outside_the_motion_is_refused_with_the_range(self):
        for t in ("-1", "10.001", "99"):
            status, out, err = once("four-bar", "--once", "--t", t)
            self.assertEqual((status, out), (2, ""), t)
            self.assertIn(f"--t is {t} s; the motion of four-bar allows 0 to 10 s", err)
        self.assertEqual([once("four-bar", "--once", "--t", t)[0] for t in ("0", "10")], [0, 0])


class Lists(unittest.TestCase):
    def frame(self, keys, *words):
        status, out, err = once(*(words or ("four-bar",)), "--once", "--t", "0.1", "--size", "120x40", "--keys", keys)
        self.assertEqual((status, err), (0, ""))
        return out

    def foot(self, keys):
        """The words below a list: those of the item under the cursor."""
        return next(row for row in reversed(self.frame(keys).split("\n")[:-5]) if row.strip("│ "))

    def test_escape_in_a_lesson_goes_back_to_the_list_and_its_item(self):
        for keys in ("t<Down>", "t<Down><Down>"):  # a lesson's exercises, each in its own panel
            before = self.frame(keys).split("\n")[:-2]
            self.assertEqual(self.frame(keys + "<Enter><Esc>").split("\n")[:-2], before, keys)
            self.assertIn("loop gap", self.frame(keys + "<Enter><Esc><Esc>"))
        self.assertIn("lessons and exercises", self.frame("t<Enter><Esc>"))
        # "add a method" came from the list of methods
        self.assertIn("methods: Enter changes", self.frame("m<End><Enter><Esc>"))
        self.assertIn("loop gap", self.frame("m<End><Enter><Esc><Esc>"))

    def test_a_word_finds_the_item_that_begins_with_it_or_has_it(self):
        def opened(keys):
            return self.frame(keys).rstrip().split("\n")[-1].strip()
        add = "m<End><Enter>"
        self.assertTrue(opened(add + "nullspace<Enter>").startswith("method: nullspace"))
        self.assertTrue(opened(add + "null<Enter>").startswith("method: nullspace"))
        # another key begins a new word
        self.assertTrue(opened(add + "null<Home>index1<Enter>").startswith("method: index1"))
        self.assertTrue(opened(add + "nullz<Backspace><Enter>").startswith("method: nullspace"))
        self.assertIn("no item has 'nullz'; Backspace takes a letter back", self.frame(add + "nullz"))
        self.assertIn("search: drift", self.frame("tdrift"))
        self.assertIn("drift", self.foot("tdrift").lower())

    def test_the_list_of_methods_begins_at_the_selected_one(self):
        line = self.frame("3m<Enter>", "four-bar", "--methods", "index1@rk4", "projection@rk4", "reduced@rk4").rstrip().split("\n")[-1]
        self.assertIn("method: reduced@rk4", line)

    def test_why_starts_at_its_top_each_time(self):
        def card(keys):
            out = once("parallelogram", "--once", "--t", "5", "--size", "80x24", "--keys", keys)[1]
            return [line[37:79] for line in out.split("\n")[2:15]]
        top = card("1i")
        self.assertNotEqual(card("1i<PageDown>"), top)
        self.assertEqual(card("1i<PageDown>ii"), top)
        self.assertEqual(card("1i<PageDown>21"), top)

    def test_a_parameter_is_typed_in_any_unit_that_fits(self):
        def said(typed):
            return " ".join(self.frame(f"p<Enter>{typed}<Enter>").split())
        plain = self.frame("p<Enter>0.45<Enter>p")
        for typed in ("45 cm", "450mm", "0,45 m"):
            self.assertEqual(self.frame(f"p<Enter>{typed}<Enter>p"), plain, typed)
        self.assertIn("'45 kg' is not a number in a unit that fits m", said("45 kg"))
        self.assertIn("'45 x' is not a number in a unit that fits m", said("45 x"))


class Messages(unittest.TestCase):
    def test_undo_counts_changes_and_stays_at_its_time(self):
        def after(keys):
            status, out, err = once("pendulum", "--once", "--t", "0.5", "--size", "100x30", "--methods", "index1@rk4:h=0.02", "--keys", keys)
            self.assertEqual((status, err), (0, ""))
            return out
        undone = after("d0.01<Enter>z")
        self.assertIn("undone: change 1 of 1; now method 1 is index1@rk4:h=0.02", undone)
        self.assertIn("t 0.500 s", undone)
        self.assertIn("done again: change 1 of 1", after("d0.01<Enter>zy"))
        self.assertIn("undone: change 1 of 2; now method 1 is index1@rk4:h=0.02", after("d0.01<Enter>d0.005<Enter>zz"))
        # frames of 50 ms have none at 0.54 s: the moment asked for comes back with the old step
        moved = "<Right>" * 2 + "d50 ms<Enter>"
        self.assertIn("t 0.550 s", after(moved))
        self.assertIn("t 0.540 s", after(moved + "z"))
        self.assertIn("t 0.560 s", after(moved + "z<Right>"))
        self.assertIn("undone: change 1 of 1; now l as the scene has it", after("p<Enter>0.5<Enter><Esc>z"))

    def test_a_long_message_keeps_its_values_and_its_end(self):
        for size in ("120x40", "80x24"):
            _, out, _ = once("four-bar", "--once", "--t", "0.5", "--size", size, "--methods", "index1@rk4:h=0.02", "--keys", "p<Enter>2.5<Enter>")
            self.assertIn("make rocker longer than 0.932719 m or coupler longer than 1.33272 m, or change what is held at the start (th1 = 1)", " ".join(out.split()), size)

    def test_why_says_how_the_gap_decays_where_alpha_is_above_beta(self):
        _, out, _ = once("four-bar", "--once", "--t", "0.1", "--size", "200x40", "--methods", "baumgarte:alpha=13.61,beta=7.462@rk4", "--keys", "i")
        text = " ".join(re.sub("[│┌┐└┘─⠀-⣿]", " ", out).split())
        self.assertIn("alpha above beta", text)
        self.assertIn("sqrt(alpha^2 - beta^2)", text)

    def test_names_of_scenes_have_one_column_and_a_cut_text_says_so(self):
        _, out, _ = once("four-bar", "--once", "--t", "0.1", "--size", "120x40", "--keys", "s")
        rows = [line for line in out.split("\n") if re.match(r"│ (four-bar|four-angles-as-printed|pendulum)  ", line)]
        self.assertEqual(len(rows), 3)
        self.assertEqual({re.match(r"│ \S+ +", row).end() for row in rows}, {len("│ four-angles-as-printed  ")})
        self.assertRegex(out, r"Bennett's linkage: a spatial loop …")

    def test_titles_of_scenes_end_at_a_word_and_the_rest_is_counted(self):
        whole = {scene["title"] for scene in json.loads(subprocess.run([PROGRAM, "list", "scenes", "--json"], capture_output=True).stdout)["scenes"]}
        for columns in (80, 100, 120, 160):
            _, out, _ = once("four-bar", "--once", "--t", "0.1", "--size", f"{columns}x24", "--keys", "s<Home>")
            titles = [re.split("[⠀-⣿├]|│$", line)[0][26:].strip() for line in out.split("\n")[2:10]]
            for title in filter(None, titles):
                self.assertTrue(title in whole or any(name.startswith(title.removesuffix("…")) for name in whole) and title.endswith(" …"), (columns, title))
            self.assertRegex(out, r"│ ↓ \d+ more ", columns)
        # the longest description has room, and the last scene nothing below it
        _, out, _ = once("four-bar", "--once", "--t", "0.1", "--keys", "s")
        self.assertIn("energy of 14.05 J must stay what it is.", out)
        _, out, _ = once("four-bar", "--once", "--t", "0.1", "--keys", "s<End>")
        self.assertRegex(out, r"│ ↑ \d+ more +│")

    def test_the_menu_and_a_text_say_that_there_is_more(self):
        self.assertRegex(once("four-bar", "--once", "--t", "0.1", "--keys", "?")[1], r"│ ↓ \d+ more ")
        text = [once("four-bar", "--once", "--t", "0.1", "--keys", "t<Enter>" + keys)[1] for keys in ("", "<PageDown>", "<End>")]
        for out, wanted in zip(text, (" ↓ more ─┘", " ↑↓ more ─┘", " ↑ more ─┘")):
            self.assertIn(wanted, out)

    def test_a_new_step_says_whose_it_is(self):
        def after(*methods):
            return message(once("four-bar", "--once", "--t", "0.1", "--keys", "d20 ms<Enter>", "--methods", *methods)[1])
        self.assertEqual(after("index1@rk4", "reduced@rk4"), "dt = 0.02 s for every method")
        self.assertEqual(after("index1@rk4", "reduced@dopri5"), "dt = 0.02 s for the methods of fixed step; the others choose it by a tolerance")
        self.assertEqual(after("reduced@dopri5"), "no method here has a fixed step: all choose it by a tolerance (m)")

    def test_times_are_read_as_people_type_them(self):
        for typed, said in (("20 ms", "dt = 0.02 s"), ("0,02", "dt = 0.02 s"), ("0.02 s", "dt = 0.02 s"), ("2e-2s", "dt = 0.02 s"), ("5 m", "dt: '5 m' is not a number of seconds"), ("0.02x", "dt: '0.02x' is not a number of seconds"),
                            ("-1", "dt must be above 0"), ("", "dt = 0.001 s"), ("0.02 seconds", "dt: '0.02 seconds' is not a number"), ("nan", "dt: 'nan' is not a number")):
            _, out, _ = once("four-bar", "--once", "--t", "0.1", "--keys", f"d{typed}<Enter>", "--methods", "index1@rk4")
            self.assertTrue(message(out).startswith(said), (typed, message(out)))
        # a line that is longer than any number
        self.assertIn("dt: '" + "9" * 40 + "' is not a number", " ".join(once("four-bar", "--once", "--t", "0.1", "--keys", f"d{'9' * 70}<Enter>")[1].split()))

    def test_a_step_without_end_or_too_short_is_refused_and_the_methods_stay(self):
        def after(step):
            frames = []
            for more in ("", "<Esc>m"):
                status, out, err = once("four-bar", "--once", "--t", "0.1", "--size", "120x40", "--methods", "index1@rk4:h=0.02", "--keys", f"d{step}<Enter>{more}")
                self.assertEqual((status, err), (0, ""))
                frames.append(out)
            self.assertIn("index1@rk4:h=0.02", frames[1])
            return " ".join(frames[0].split())
        self.assertIn("'1e999' is beyond the largest number", after("1e999"))
        self.assertIn("dt must be above 0 s; '-1' is not", after("-1"))
        self.assertIn("dt = 100 s is longer than the motion of 10 s", after("100"))
        # 10 s of motion in 50 million steps at most
        self.assertRegex(after("1e-12"), r"dt = 1e-12 s needs 1e\+13 steps to t = 10 s, and 5e\+07 are allowed; the shortest dt here is 2e-07 s")

    def test_a_refused_line_stays_open_as_it_was_typed(self):
        for keys, line, said in (("d-1<Enter>", "20 ms: -1", "dt must be above 0"), ("dabc<Enter>", "20 ms: abc", "dt: 'abc' is not a number"),
                                 ("m<Enter>nonsense@rk4<Enter>", "method: nonsense@rk4", "nonsense"), ("p<Enter>long<Enter>", "value: long", "is not a number"),
                                 ("p<Enter>-3<Enter>", "value: -3", ""), ("x<Enter>/no/such/folder.csv<Enter>", "write to: /no/such/folder.csv", "No such file"),
                                 ("bt99<Enter>", "to study [s]: 99", "no time of motion above 0")):
            status, out, err = once("four-bar", "--once", "--t", "0.1", "--size", "120x30", "--methods", "baumgarte:alpha=10,beta=10@rk4:h=0.02", "--keys", keys)
            self.assertEqual((status, err), (0, ""))
            self.assertTrue(out.rstrip().endswith(line), (keys, out.rstrip()[-200:]))
            self.assertTrue(message(out), keys)
            self.assertIn(said, " ".join(out.split()), keys)
        # it is mended there, and taken
        _, out, _ = once("four-bar", "--once", "--t", "0.1", "--methods", "index1@rk4", "--keys", "d-1<Enter><CtrlU>0.02<Enter>")
        self.assertEqual(message(out), "dt = 0.02 s for every method")

    def test_the_first_letter_replaces_what_was_filled_in(self):
        def line(keys):
            status, out, err = once("pendulum", "--once", "--t", "0.1", "--size", "100x30", "--methods", "index1@rk4:h=0.02", "--keys", keys)
            self.assertEqual((status, err), (0, ""))
            return out.splitlines()[-1].strip()
        for keys, wanted in (("m<Enter>7", "method: 7"), ("m<Enter><Right>7", "method: index1@rk4:h=0.027"), ("m<Enter>", "method: index1@rk4:h=0.02"),
                             ("m<Enter><Backspace>5", "method: index1@rk4:h=0.05"), ("m<Enter>75", "method: 75")):
            self.assertEqual(line(keys), wanted, keys)

    def test_a_long_incident_is_whole_and_covers_nothing(self):
        _, out, _ = once("parallelogram", "--once", "--t", "1", "--size", "80x24")
        self.assertIn("largest 1.3\n", out)
        self.assertRegex(out, r"(?m)^└─+┘\n !")

    def test_the_card_shows_every_line_of_a_long_incident(self):
        lines = []
        for pages in range(12):
            _, out, _ = once("parallelogram", "--once", "--t", "5", "--size", "80x24", "--keys", "1i" + pages * "<PageDown>")
            card = [line[37:79] for line in out.split("\n")[2:15]]
            self.assertIn("why: index-1", out)
            lines += [row.rstrip(" │") for row in card if row not in lines]
            if not any("PageDown: " in row for row in card):
                break
        text = " ".join(" ".join(lines).split())
        # sentences that a page of 12 lines used to cut, to their last words
        self.assertIn("the multipliers grew to", text)
        self.assertRegex(text, r"again at [\d., ]+ s: \d+ times in all")
        self.assertIn("PageUp: back", text)

    def test_a_notice_without_room_says_which_key_shows_the_rest(self):
        methods = ["index1@rk4", "baumgarte@rk4", "projection@rk4", "reduced@rk4", "nullspace@rk4", "ggl@radau5", "index3@rattle"]
        _, out, _ = once("parallelogram", "--once", "--t", "1", "--size", "60x20", "--methods", *methods)
        self.assertRegex(out, r" … i: the rest\n")

    def test_a_method_that_went_wrong_is_not_said_to_be_well(self):
        for keys in ("d5<Enter>2i", "d5<Enter>2i<PageDown>"):
            _, out, _ = once("four-bar", "--once", "--size", "150x50", "--keys", keys)
            self.assertNotIn("nothing is wrong so far", " ".join(out.split()))
            self.assertIn("stopped at", out)

    def test_what_became_of_the_motion_comes_before_warnings(self):
        _, out, _ = once("parallelogram", "--once", "--size", "150x50", "--keys", "2i")
        card = " ".join("".join(line[67:149] for line in out.split("\n")[2:40]).split())
        self.assertIn("worst so far: open by", card)
        self.assertLess(card.index("the energy changed by"), card.find("a singular configuration (J") % 10**6)

    def test_the_scene_of_the_typed_name_is_first(self):
        _, out, _ = once("pendulum", "--once", "--keys", "sfour-bar<Enter>")
        self.assertRegex(out, r"^ holonom  four-bar  ")

    def test_another_scene_says_how_methods_that_were_chosen_come_back(self):
        chosen = ("--methods", "projection@rk4:h=0.01", "nullspace@rk4:h=0.01")
        away = once("four-bar", "--once", "--keys", "sslider-crank<Enter>", *chosen)[1]
        self.assertEqual(message(away), "slider-crank has its own methods; z: back to four-bar with yours, at t = 0")
        back = once("four-bar", "--once", "--keys", "sslider-crank<Enter>z", *chosen)[1]
        self.assertRegex(message(back), "now scene four-bar, with its methods of then, at t = 0$")
        self.assertRegex(back, r"(?m)^│2\S null-space ")
        self.assertEqual(message(once("four-bar", "--once", "--keys", "sslider-crank<Enter>")[1]), "")

    def test_keys_and_size_without_once_are_refused_in_a_terminal(self):
        for words in (("--keys", "g"), ("--size", "100x30")):
            terminal = Terminal("four-bar", *words)
            self.assertTrue(terminal.wait_for(words[0].encode() + rb" is about a frame as text, and this terminal shows the workbench"))
            terminal.process.wait()
            self.assertEqual(terminal.process.returncode, 2)

    def test_a_scene_without_a_loop_has_no_map_of_alpha_and_beta(self):
        _, out, _ = once("double-pendulum", "--once", "--t", "0.1", "--keys", "b")
        self.assertIn("double-pendulum has no loop: there is nothing to stabilise", out)

    def test_the_list_of_methods_stays_open_when_one_goes(self):
        _, out, _ = once("four-bar", "--once", "--t", "0.1", "--size", "100x30", "--keys", "mxx")
        self.assertIn("─ methods: Enter changes", out)
        self.assertNotIn("index1@rk4", out)
        self.assertNotIn("baumgarte", out)

    def test_a_method_is_added_from_a_list(self):
        def after(keys):
            return once("four-bar", "--once", "--t", "0.1", "--size", "120x40", "--keys", keys, "--methods", "index1@rk4:h=0.02")[1]
        self.assertRegex(after("m<End><Enter>"), r"(?m)^│ nullspace-as-printed +\S")
        self.assertIn("method: ggl@radau5", after("m<End><Enter>g<Enter>"))
        added = after("m<End><Enter>proj<Enter><Enter>m")
        self.assertRegex(added, r"(?m)^│ p\S+@rk4:h=0\.02 ")
        self.assertRegex(added, r"(?m)^│ index1@rk4:h=0\.02 ")

    def test_the_step_is_on_the_screen_and_in_its_prompt(self):
        _, out, _ = once("four-bar", "--once", "--t", "0.1", "--keys", "d")
        self.assertIn("dt 10.0 ms", out)
        self.assertTrue(out.rstrip().endswith("20 ms: 0.01"))

    def test_a_remedy_of_several_incidents_stands_once_on_the_card(self):
        status, out, err = once("parallelogram", "--once", "--size", "150x50", "--methods", "projection@rk4:h=0.01", "--keys", "i")
        self.assertEqual((status, err), (0, ""))
        # the incidents of one kind are one entry, with their times
        self.assertEqual(out.count("a singular configuration (J"), 1)
        self.assertRegex(out, r"again at \d[\d., ]+ s: \d+ times in all")
        self.assertEqual(out.count("projection@rk4:h=0.007: not tried"), 1)

    def test_the_card_begins_with_what_to_try_and_offers_critical_damping(self):
        for size in ("80x24", "120x40"):
            _, out, _ = once("four-bar", "--once", "--t", "3.5", "--size", size, "--keys", "i", *OPENS)
            column = out.split("\n")[1].index("why:") - 2
            card = " ".join("".join(line[column:-1] + " " for line in out.split("\n")[2:14]).split())
            self.assertRegex(card, r"^worst so far: open by .* off try baumgarte:alpha=20,beta=20@rk4:h=0\.02 \(tried until t = [\d.]+ s: largest gap \d+ µm, .*\)"
                                   r" this method with h=0\.01 only puts it off, as nothing closes the loop \(tried until t = [\d.]+ s: .*\) projection@rk4:h=0\.02 runs already: method 2", size)
        # in the list too, where what cures it comes first
        rows = re.findall(r"(?m)^│ (\S+@\S+|h=\S+) +(.*)", once("four-bar", "--once", "--t", "3.5", "--size", "120x40", "--keys", "i<Enter>", *OPENS)[1])
        self.assertRegex(rows[0][0], "^baumgarte:alpha=20,beta=20@rk4")
        self.assertTrue(all(words.startswith("only puts it off, as nothing closes the loop; tried until") for name, words in rows if name.startswith("h=")), rows)

    def test_the_card_has_each_remedy_once_and_lengths_as_the_table(self):
        for scene, words in (("parallelogram", ("--t", "5")), ("four-bar", OPENS)):
            out = once(scene, "--once", "--size", "120x150", "--keys", "1i", *words)[1]
            card = " ".join(" ".join(row.split("││")[1].rstrip("│ ") for row in out.split("\n") if "││" in row).split())
            offered = re.findall(r"(?:try )?(h=[\d.]+|\S+@\S+)(?: \(tried|: not tried| only puts)", card)
            self.assertEqual(len(offered), len(set(offered)), offered)
            self.assertNotRegex(card, r" 0\.0\d* (m|J)\b|e-0\d (m|J)\b")

    def test_the_flat_position_and_the_other_branch_stand_before_what_follows_from_them(self):
        out = once("parallelogram", "--once", "--size", "120x150", "--t", "5", "--keys", "1i")[1]
        card = " ".join(" ".join(row.split("││")[1].rstrip("│ ") for row in out.split("\n") if "││" in row).split())
        times = [float(t) for t in re.findall(r"([\d.]+) s: (?:the|a) ", card)]
        self.assertRegex(card, r"so the gap grows\. 0\.343 s: the constraint equations are almost dependent")
        # errors and then warnings follow, each in the order of time
        self.assertEqual(sum(later < earlier for earlier, later in zip(times, times[1:])), 1, times)

    def test_a_remedy_that_runs_already_is_said_and_selected(self):
        def frame(keys, *methods):
            return once("four-bar", "--once", "--t", "4", "--size", "120x40", "--keys", keys, *(methods or OPENS))[1]
        self.assertIn("projection@rk4:h=0.02 runs already: method 2", frame("i"))
        self.assertRegex(frame("i<Enter>"), r"(?m)^│ projection@rk4:h=0\.02 +runs already as method 2; ")
        # what runs already is the last of the list
        taken = frame("i<Enter><End><Enter>")
        self.assertEqual(message(taken), "projection@rk4:h=0.02 runs already: it is method 2, now selected")
        self.assertIn("why: projection", taken)
        self.assertEqual(len(re.findall(r"(?m)^│\d\S", taken)), 2)
        # another spelling of it is the same method
        other = frame("i<Enter><End><Enter>", "--methods", "index1@rk4:h=0.02", "projection@rk4:h=2e-2")
        self.assertEqual(len(re.findall(r"(?m)^│\d\S", other)), 2)
        # where it does not run, it is tried
        self.assertRegex(" ".join(frame("i", "--methods", "index1@rk4:h=0.02").split()), r"try projection@rk4:h=0\.02 \(tried")

    def test_an_export_says_what_was_written_or_that_it_failed(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "p.py")
            _, out, _ = once("four-bar", "--once", "--t", "0.1", "--size", "150x24", "--set", "l1=0.55", "--keys", f"xp<Enter><CtrlU>{path}<Enter>")
            self.assertEqual(message(out), f"{path}: written, {os.path.getsize(path)} bytes")
            # the program is that of the values shown
            with open(path, encoding="utf-8") as file:
                self.assertIn("0.55", file.read())
            _, out, _ = once("four-bar", "--once", "--t", "0.1", "--size", "150x24", "--keys", f"xp<Enter><CtrlU>{folder}/no/p.py<Enter>")
            self.assertEqual(message(out), "the command failed; its reason is above")
            self.assertIn("(failed; Esc goes back)", out)

    def test_an_incident_leaves_the_line_when_it_is_no_news(self):
        # the first run opens at 1 s; a fifth of the motion later only its own line still tells
        def line(t, keys):
            return notice(once("four-bar", "--once", "--t", t, "--size", "150x30", "--keys", keys, *OPENS)[1])
        happened = float(re.search(r"! index-1 at ([\d.]+) s: the loop has opened", line("1.9", "1")).group(1))
        self.assertLess(happened, 1.9)
        self.assertIn("! index-1 at", line("1.9", "2"))
        later = happened + 0.2 * 10 + 0.5
        self.assertIn("! index-1 at", line(f"{later:.2f}", "1"))
        self.assertNotIn(f"at {happened:g} s", line(f"{later:.2f}", "2"))


    def test_an_incident_is_whole_in_eighty_columns(self):
        _, out, _ = once("four-bar", "--once", "--t", "2.5", "--size", "80x24", *OPENS)
        self.assertRegex(notice(out), r"^! index-1 at [\d.]+ s: the energy has changed by [^…]* 1 % of the largest energies so far$")


class Forces(unittest.TestCase):
    def test_arrows_at_the_joints_have_the_sizes_of_the_list(self):
        def frame(keys, *more):
            return once("four-bar", "--once", "--t", "0", "--size", "200x60", "--methods", "projection@rk4:h=0.01", "--keys", keys, *more)[1].split("\n")[2:50]
        shown, plain = frame("r"), frame("")
        listed = [f"{float(size):.2g}" for size in re.findall(r"│ \w+: \w+ +([\d.]+) ", "\n".join(line[89:] for line in shown))]
        self.assertEqual(len(listed), 4)
        mechanism = "\n".join(line[:89] for line in shown)
        named = re.findall(r"([\d.]+) N\b", mechanism)
        self.assertGreater(len(named), 1)
        self.assertLessEqual({f"{float(x):.2g}" for x in named}, set(listed))
        self.assertNotIn(" N", "\n".join(line[:89] for line in plain))
        # arrows are dots more than the mechanism alone
        def dots(lines):
            return sum(bin(ord(c) - 0x2800).count("1") for line in lines for c in line[:89] if 0x2800 <= ord(c) < 0x2900)
        self.assertGreater(dots(shown), dots(plain) + 20)
        self.assertEqual(dots(frame("rr")), dots(plain))

    def test_multipliers_are_explained(self):
        _, out, _ = once("four-bar", "--once", "--t", "0.1", "--keys", "r<PageDown>")
        self.assertIn("Each multiplier is the force (or moment)", " ".join("".join(line[37:79] for line in out.split("\n")[2:16]).split()))
        self.assertIn("forces (moments) that keep the loop closed", once("four-bar", "--once", "--t", "0.1", "--keys", "r")[1])


if __name__ == "__main__":
    driver.main()
