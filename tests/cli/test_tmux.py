# SPDX-License-Identifier: GPL-3.0-or-later
"""The workbench in a real terminal: sizes, keys, storms of resizes, suspension, ends; nothing is left of it afterwards."""

import os
import re
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402
from tmux import PATIENCE, Tmux  # noqa: E402

PROGRAM = os.path.abspath(driver.PROGRAM)


class Terminal(Tmux):
    def pid(self):
        shell = self.tmux("list-panes", "-F", "#{pane_pid}").strip()
        return int(subprocess.run(["pgrep", "-P", shell, "-f", "holonom"], capture_output=True, text=True, check=True).stdout.split()[0])

    def assert_restored(self):
        """The line is echoed again, the cursor is back, the screen is the shell's."""
        self.keys("stty -a | grep -cw -- -echo; echo a'  'line", "Enter")
        self.wait_for(r"\n0\na  line\n")
        self.assertEqual(self.tmux("display-message", "-p", "#{cursor_flag} #{alternate_on} #{mouse_any_flag}").split(), ["1", "0", "0"])

    def test_each_size_shows_mechanism_plot_and_methods_within_its_width(self):
        for width, height in ((80, 24), (120, 40), (200, 60)):
            with self.subTest(f"{width}x{height}"):
                self.start(width, height, f"{PROGRAM} tui four-bar")
                screen = self.wait_for("Baumgarte|baumgarte")
                lines = screen.rstrip("\n").split("\n")
                self.assertLessEqual(max(map(len, lines)), width)
                self.assertGreaterEqual(len(lines), height - 1)
                self.assertRegex(screen, "[\u2801-\u28ff]")
                self.keys("q")
                self.assert_restored()
                self.stop()

    def test_time_goes_on_until_space(self):
        self.start(100, 30, f"{PROGRAM} tui four-bar")
        # it waits for Space, and goes on from there
        seen = re.search(r"t +([0-9.]+) s", self.wait_for("paused"))
        self.assertEqual(seen.group(1), "0.000")
        self.keys("Space")
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            now = re.search(r"t +([0-9.]+) s", self.screen())
            if seen and now and float(now.group(1)) > float(seen.group(1)):
                break
            time.sleep(0.1)
        else:
            self.fail(self.screen())
        self.keys("Space")
        self.wait_for("paused")
        self.keys("q")
        self.assert_restored()

    def test_a_map_fills_the_window_and_its_title_fits(self):
        self.start(80, 24, f"HOLONOM_CACHE=$(mktemp -d) {PROGRAM} tui four-bar")
        self.wait_for("Baumgarte|baumgarte")
        self.keys("b")
        self.wait_for(r"stability over alpha and beta in 3 s: \d+ % done, ★ is now, Esc stops ─")
        self.wait_for(r"stability over alpha and beta in 3 s: arrows move, ★ is now, Esc goes back ─")
        self.tmux("resize-window", "-x", "100", "-y", "50")
        self.wait_for(r"(│ +[\d.]+ │[^\n]+\n){24}(.|\n)*[^\n]*")
        self.wait_for("Esc goes back")
        self.assertEqual(len(re.findall(r"(?m)^│ +[\d.]+ │", self.screen())), 24)
        self.keys("Escape")
        self.wait_for("Space run")
        self.keys("q")
        self.assert_restored()

    def test_a_storm_of_resizes_and_a_tiny_window_do_not_end_it(self):
        self.start(80, 24, f"{PROGRAM} tui four-bar")
        self.wait_for("Baumgarte|baumgarte")
        self.keys("Space")
        for k in range(60):
            self.tmux("resize-window", "-x", str(20 + 37 * k % 150), "-y", str(5 + 13 * k % 50))
        self.tmux("resize-window", "-x", "20", "-y", "5")
        self.wait_for(r"^\s*20x5 is too\s+small:\s+32x17 is\s+needed;\s+q\s+quits\s*$")
        self.tmux("resize-window", "-x", "100", "-y", "30")
        self.wait_for("Baumgarte|baumgarte")
        self.keys("q")
        self.assert_restored()

    def test_ctrl_c_and_termination_restore_the_terminal(self):
        for how in ("C-c", "TERM", "HUP"):
            with self.subTest(how):
                self.start(80, 24, f"{PROGRAM} tui four-bar")
                self.wait_for("Baumgarte|baumgarte")
                if how == "C-c":
                    self.keys("C-c")
                else:
                    subprocess.run(["kill", "-" + how, str(self.pid())], check=True)
                self.assert_restored()
                self.stop()

    def test_a_crash_restores_the_terminal(self):
        for number in ("SEGV", "ABRT", "FPE"):
            with self.subTest(number):
                self.start(80, 24, f"ulimit -c 0; {PROGRAM} tui four-bar")
                self.wait_for("Baumgarte|baumgarte")
                subprocess.run(["kill", "-" + number, str(self.pid())], check=True)
                self.assert_restored()
                self.stop()

    def test_the_shell_that_started_it_is_killed(self):
        # an inner shell dies, the outer one has the terminal again
        self.start(80, 24, f"bash --norc -c '{PROGRAM} tui four-bar; true'")
        self.wait_for("Baumgarte|baumgarte")
        shell = self.tmux("list-panes", "-F", "#{pane_pid}").strip()
        inner = subprocess.run(["pgrep", "-P", shell], capture_output=True, text=True, check=True).stdout.split()[0]
        program = subprocess.run(["pgrep", "-P", inner], capture_output=True, text=True, check=True).stdout.split()[0]
        subprocess.run(["kill", "-KILL", inner], check=True)
        deadline = time.monotonic() + PATIENCE
        while os.path.exists(f"/proc/{program}") and time.monotonic() < deadline:
            time.sleep(0.05)
        self.assertFalse(os.path.exists(f"/proc/{program}"), "the program outlived its shell")
        self.assert_restored()

    def test_the_terminal_is_closed(self):
        self.start(80, 24, f"{PROGRAM} tui four-bar")
        self.wait_for("Baumgarte|baumgarte")
        program = self.pid()
        self.stop()
        deadline = time.monotonic() + PATIENCE
        while os.path.exists(f"/proc/{program}") and time.monotonic() < deadline:
            time.sleep(0.05)
        self.assertFalse(os.path.exists(f"/proc/{program}"), "the program outlived its terminal")

    def test_a_terminal_without_utf8_gets_ascii(self):
        self.start(80, 24, f"LC_ALL=C {PROGRAM} tui four-bar")
        screen = self.wait_for("Baumgarte|baumgarte")
        self.assertTrue(screen.isascii(), screen)
        self.assertRegex(screen, r"[-/|']{3}")
        self.keys("q")
        self.assert_restored()

    def test_suspended_it_leaves_the_screen_and_comes_back(self):
        self.start(80, 24, f"{PROGRAM} tui four-bar")
        self.wait_for("Baumgarte|baumgarte")
        self.keys("C-z")
        self.wait_for("Stopped")
        self.keys("echo out'  'side", "Enter")
        self.wait_for(r"\nout  side\n")
        self.keys("fg", "Enter")
        self.wait_for(r"Baumgarte|baumgarte")
        self.keys("q")
        self.assert_restored()

    def test_it_opens_at_the_time_that_is_asked_for(self):
        self.start(80, 24, f"{PROGRAM} tui four-bar --t 3 --methods projection@rk4:h=0.01")
        self.wait_for(r"t 3\.000 s of 10 s .*paused(.|\n)*right to \d digits")

    def test_a_stop_from_outside_leaves_the_shell_its_screen(self):
        self.start(80, 24, f"{PROGRAM} tui four-bar")
        self.wait_for("Space run")
        pid = self.pid()
        # once more in the background: it stops again and draws nothing
        for number in (signal.SIGTSTP, signal.SIGCONT):
            os.kill(pid, number)
            self.wait_for_state(pid, "T")
            self.wait_for(r"Stopped")
        self.keys("echo out'  'side", "Enter")
        self.assertNotIn("Space run", self.wait_for(r"\nout  side\n"))
        self.keys("fg", "Enter")
        self.wait_for("Space run")
        self.keys("q")
        self.assert_restored()

    def wait_for_state(self, pid, state):
        """Waits until the process has been in this state twice in a row: it may be about to leave it."""
        deadline, before = time.monotonic() + PATIENCE, ""
        while time.monotonic() < deadline:
            with open(f"/proc/{pid}/stat") as file:
                now = file.read().rsplit(")", 1)[1].split()[0]
            if now == before == state:
                return
            before = now
            time.sleep(0.2)
        self.fail(f"{pid} is in state {now}, not {state}")

    def test_a_dumb_terminal_and_a_pipe_get_plain_text(self):
        for command in (f"TERM=dumb {PROGRAM} tui four-bar", f"{PROGRAM} tui four-bar | cat"):
            with self.subTest(command):
                self.start(80, 24, command)
                self.keys("echo ended'  'with $?", "Enter")
                screen = self.wait_for(r"ended  with 0")
                self.assertNotIn("\033", screen)
                self.stop()


if __name__ == "__main__":
    driver.main()
