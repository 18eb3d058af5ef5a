# SPDX-License-Identifier: GPL-3.0-or-later
"""What the commands and the workbench say to a terminal or a pipe: colours, widths, digits, options, fields of a link."""

import os
import pty
import re
import subprocess
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402
from terminal import PROGRAM, ROOT, once  # noqa: E402


def shown(*words, term="xterm-256color"):
    """(status, all that the command writes to a terminal): it is read to its end, however slowly it comes."""
    master, slave = pty.openpty()
    env = {**os.environ, "TERM": term, "LC_ALL": "C.UTF-8", "COLUMNS": "80"}
    env.pop("NO_COLOR", None)
    process = subprocess.Popen([PROGRAM, *words], stdin=subprocess.DEVNULL, stdout=slave, stderr=subprocess.DEVNULL, env=env)
    os.close(slave)
    seen = b""
    try:
        while piece := os.read(master, 65536):
            seen += piece
    except OSError:
        pass  # a terminal that nobody writes to any more ends so
    os.close(master)
    return process.wait(timeout=600), seen.decode().replace("\r\n", "\n")


def said(*words):
    done = subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=600, stdin=subprocess.DEVNULL)
    return done.returncode, done.stdout, done.stderr


class Terminals(unittest.TestCase):
    def test_colours_go_to_terminals_that_are_known_to_have_them(self):
        for words in (("tui", "four-bar", "--once", "--t", "0.1"), ("compare", "four-bar", "--time", "0.2", "--plot")):
            for term, coloured in (("xterm-256color", True), ("nonsense", False), ("", False), ("vt100", False), ("dumb", False)):
                status, out = shown(*words, term=term)
                self.assertEqual((status, "\033" in out), (0, coloured), (words, term))

    def test_times_of_a_short_run_have_the_digits_that_tell_them_apart(self):
        def times(*words):
            status, out = shown("run", "four-bar", "--method", "projection@rk4:h=1e-3", *words)
            self.assertEqual(status, 0)
            column = [line.split()[0] for line in out.split("\n")[1:] if line.strip()]
            self.assertEqual(len({len(time) for time in column}), 1, column[:3])
            return column
        for words in (("--time", "1e-5"), ("--time", "2e-4", "--every", "5e-5"), ("--at", "0.1,0.1000001,0.1000002"), ("--time", "1e-12")):
            column = times(*words)
            self.assertEqual(len(column), len(set(column)), (words, column[:4]))
        self.assertEqual(times("--time", "1", "--every", "0.5"), ["0.00000", "0.50000", "1.00000"])

    def test_a_wide_table_of_a_run_has_all_columns(self):
        head = said("run", "four-bar", "--time", "0.1")[1].split("\n")[0].split(",")
        status, out = shown("run", "four-bar", "--time", "0.1", "--wide")
        self.assertEqual(status, 0)
        self.assertEqual(re.split(r"\s{2,}", out.split("\n")[0].strip()), head)
        # a pipe gets CSV as before
        self.assertEqual(said("run", "four-bar", "--time", "0.1", "--wide")[1], said("run", "four-bar", "--time", "0.1")[1])


class Options(unittest.TestCase):
    def test_an_option_of_another_command_is_no_slip_of_the_pen(self):
        status, _, err = said("report", "four-bar", "--time", "3")
        self.assertEqual(status, 2)
        self.assertIn("'report' has no option '--time'", err)
        self.assertNotIn("did you mean", err)
        self.assertIn("'holonom help report' lists its options", err)
        self.assertIn("did you mean '--time'?", said("run", "four-bar", "--tim", "3")[2])

    def test_a_parameter_that_is_refused_has_its_usual_range(self):
        for value in ("-1", "50"):
            status, _, err = said("run", "four-bar", "--set", f"l1={value}", "--time", "0.1")
            self.assertEqual(status, 2)
            self.assertRegex(err, r"l1 (is|= 0\.5) \(?usually 0\.1 to 3 m")

    def test_a_size_without_room_is_refused_with_the_smallest(self):
        status, out, err = once("four-bar", "--once", "--size", "20x8")
        self.assertEqual((status, out), (2, ""))
        least = re.search(r"(\d+x\d+) is needed", err).group(1)
        status, out, err = once("four-bar", "--once", "--t", "0.1", "--size", least)
        self.assertEqual((status, err), (0, ""))

    def test_frames_in_a_pipe_are_as_many_as_asked_for(self):
        status, out, _ = once("four-bar", "--frames", "3", "--methods", "projection@rk4:h=0.01")
        self.assertEqual((status, re.findall(r"holonom  four-bar  t (\d\.\d{3}) s", out)), (0, ["0.000", "0.060", "0.100"]))
        # one frame is the end of the motion
        self.assertIn("t 10.000 s", once("four-bar", "--methods", "projection@rk4:h=0.01")[1])


class Links(unittest.TestCase):
    def words(self, link):
        status, out, err = once(link, "--once", "--t", "0.1")
        self.assertEqual((status, err), (0, ""))
        return " ".join(out.split())

    def test_fields_that_are_none_are_named_and_the_rest_is_opened(self):
        words = self.words("#scene=four-bar&selectd=1&foo=2&set.l1=abc&method=index1@rk4&frame")
        self.assertIn("no field is called 'selectd'; did you mean 'selected'?", words)
        self.assertIn("no field is called 'foo'", words)
        self.assertIn("l1 is 'abc', which is no number; it has the scene's value", words)
        self.assertIn("'frame' has no value", words)
        self.assertIn("frame is 'soon'; a number from 0 to", self.words("#scene=four-bar&frame=soon"))
        self.assertIn("selected is '-1'", self.words("#scene=four-bar&selected=-1"))
        # the motion of the page is another one
        self.assertIn("a hand pulls at the mechanism", self.words("#scene=four-bar&pulls=1,2,0,0,0,1,1"))

    def test_every_field_of_the_page_is_known(self):
        with open(os.path.join(ROOT, "web", "state", "link.js"), encoding="utf-8") as file:
            table = re.search(r"const FIELDS = \{\n(.*?)\n\};", file.read(), re.S).group(1)
        fields = re.findall(r"^  (\w+):", table, re.M)
        self.assertGreater(len(fields), 20)
        values = {"scene": "four-bar", "method": "index1@rk4", "frame": "0", "selected": "0"}
        link = "#scene=four-bar" + "".join(f"&{name}={values.get(name, '1')}" for name in fields)
        self.assertNotIn("no field is called", self.words(link))


if __name__ == "__main__":
    driver.main()
