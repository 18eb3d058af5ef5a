# SPDX-License-Identifier: GPL-3.0-or-later
# The terminal workbench in a pseudo-terminal and as text: keys, sizes, character sets, and the terminal after every end.
import fcntl
import os
import pty
import re
import select
import signal
import struct
import subprocess
import tempfile
import termios
import time
import unittest

PROGRAM = os.path.abspath(os.environ.get("HOLONOM", "build/holonom"))
PATIENCE = 20.0  # [s] a crowded machine; what is waited for comes in a fraction of a second


def once(*words, **environment):
    """(status, standard output, standard error) of one frame as text."""
    env = {**os.environ, "LC_ALL": "C.UTF-8", **environment}
    done = subprocess.run([PROGRAM, "tui", *words], capture_output=True, timeout=60, env=env, stdin=subprocess.DEVNULL)
    return done.returncode, done.stdout.decode(), done.stderr.decode()


class Terminal:
    """The program in a pseudo-terminal of its own; `seen` is all that it has written."""

    def __init__(self, *words, columns=100, rows=30, **environment):
        self.master, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
        self.modes = termios.tcgetattr(slave)
        env = {**os.environ, "TERM": "xterm-256color", "LC_ALL": "C.UTF-8", **environment}
        self.process = subprocess.Popen([PROGRAM, "tui", *words], stdin=slave, stdout=slave, stderr=slave, env=env,
                                        start_new_session=True)
        self.slave = slave
        self.seen = b""

    def read(self, seconds=0.05):
        while select.select([self.master], [], [], seconds)[0]:
            try:
                self.seen += os.read(self.master, 65536)
            except OSError:
                return

    def wait_for(self, pattern):
        """True when the pattern has been written since the last call of clear()."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            self.read()
            if re.search(pattern, self.seen):
                return True
        return False

    def clear(self):
        self.read()
        self.seen = b""

    def type(self, text):
        os.write(self.master, text.encode())

    def resize(self, columns, rows):
        fcntl.ioctl(self.slave, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
        self.process.send_signal(signal.SIGWINCH)

    def ended(self):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            self.read(0.02)
            if self.process.poll() is not None:
                self.read(0.02)
                return self.process.returncode
        return None

    def close(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        os.close(self.slave)
        os.close(self.master)


class Frame(unittest.TestCase):
    def test_one_frame_fills_the_size_asked_for_and_says_the_verdicts(self):
        status, out, err = once("four-bar", "--once", "--t", "3.5", "--size", "110x32")
        self.assertEqual((status, err), (0, ""))
        lines = out.rstrip("\n").split("\n")
        self.assertEqual(len(lines), 32)
        self.assertTrue(all(len(line) <= 110 for line in lines))
        self.assertIn("t 3.500 s of 10 s", lines[0])
        # index-1 at h = 0.01 is 3.4 mm open after 3.5 s (the table of the lesson), the others are closed and right to two digits
        self.assertRegex(out, r"index-1 .*gap +3\.4 mm .*open by 3\.4 mm and \d+ mm from the true motion")
        self.assertRegex(out, r"projection .*right to 2 digits")

    def test_the_same_frame_has_the_same_bytes(self):
        words = ("slider-crank", "--once", "--t", "1")
        self.assertEqual(once(*words), once(*words))

    def test_every_shipped_scene_is_drawn_in_80_columns(self):
        names = subprocess.run([PROGRAM, "list", "scenes", "--json"], capture_output=True, text=True).stdout
        for name in re.findall(r'"id":"([^"]+)"', names):
            status, out, err = once(name, "--once", "--t", "0.1")
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


class Keys(unittest.TestCase):
    def open(self, *words, **more):
        terminal = Terminal(*words, **more)
        self.addCleanup(terminal.close)
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
        terminal.type("d0,02\r")
        terminal.clear()
        terminal.type("m")
        self.assertTrue(terminal.wait_for(rb"projection@rk4:h=0.02"))

    def test_scenes_parameters_help_equations_and_lessons_open(self):
        terminal = self.open("four-bar")
        for key, wanted in (("?", rb"play or pause"), ("p", rb"length of the crank"), ("f", rb"J a|lambda"), ("t", rb"01-closed-loops"),
                            ("s", rb"bennett"), ("y", rb"why: index-1")):
            terminal.clear()
            terminal.type(key)
            self.assertTrue(terminal.wait_for(wanted), key)
            terminal.type("\033")
            time.sleep(0.2)

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
        terminal = self.open("four-bar")
        terminal.type("w")
        self.assertTrue(terminal.wait_for(rb"work-precision of four-bar"))
        time.sleep(0.5)
        terminal.type("\033")
        terminal.clear()
        terminal.type("q")
        self.assertEqual(terminal.ended(), 0)

    def test_a_recording_is_written_once_and_never_over_a_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "r.csv")
            terminal = self.open("four-bar")
            terminal.type("x" + "\x7f" * 20 + path + "\r")
            self.assertTrue(terminal.wait_for(rb"frames written"))
            with open(path) as file:
                head, first = file.readline(), file.readline()
            self.assertTrue(head.startswith('t,"gap index1@rk4'))
            self.assertTrue(first.startswith("0,"))
            terminal.clear()
            terminal.type("x" + "\x7f" * 20 + path + "\r")
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
        for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGSEGV):
            terminal = self.open("four-bar")
            terminal.process.send_signal(number)
            self.assertEqual(terminal.ended(), -number)
            self.assertIn(b"\033[?1049l", terminal.seen)
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

    def test_the_mouse_selects_a_time_in_the_plot(self):
        terminal = self.open("four-bar")
        terminal.type("\033[<0;80;10M\033[<0;80;10m")
        self.assertTrue(terminal.wait_for(rb"paused"))


if __name__ == "__main__":
    suite = unittest.defaultTestLoader.loadTestsFromModule(__import__("__main__"))
    cases = [case for group in suite for case in group]
    print(f"1..{len(cases)}")
    for number, case in enumerate(cases, 1):
        result = unittest.TestResult()
        case.run(result)
        bad = result.failures + result.errors
        print(f"{'not ok' if bad else 'ok'} {number} - {case.id().split('.')[-1]}", flush=True)
        for _, words in bad:
            print("\n".join("# " + line for line in words.strip().split("\n")))
