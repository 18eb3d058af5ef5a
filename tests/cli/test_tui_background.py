# SPDX-License-Identifier: GPL-3.0-or-later
# The terminal workbench as a job of a shell: in the background it waits, and draws nothing.
import os
import pty
import re
import select
import signal
import sys
import tempfile
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402
from terminal import PATIENCE, PROGRAM  # noqa: E402


class Shell:
    """An interactive bash with a terminal of its own; `seen` is all that the terminal got."""

    def __init__(self):
        self.state = tempfile.TemporaryDirectory()
        self.pid, self.master = pty.fork()
        if self.pid == 0:
            env = {**os.environ, "TERM": "xterm", "PS1": "ready> ", "LC_ALL": "C.UTF-8", "XDG_STATE_HOME": self.state.name, "HISTFILE": ""}
            os.execvpe("bash", ["bash", "--norc", "--noprofile", "--noediting", "-i"], env)
        self.seen = b""

    def until(self, pattern):
        """True once the pattern has come since the last clear()."""
        end = time.monotonic() + PATIENCE
        while not re.search(pattern, self.seen) and time.monotonic() < end:
            if select.select([self.master], [], [], 0.05)[0]:
                try:
                    self.seen += os.read(self.master, 65536)
                except OSError:
                    break
        return re.search(pattern, self.seen) is not None

    def type(self, text):
        self.seen = b""
        os.write(self.master, text.encode())

    def close(self):
        self.type("\x15kill -KILL %1 2>/dev/null; exit\n")
        self.until(rb"exit")
        os.close(self.master)
        os.kill(self.pid, signal.SIGKILL)
        os.waitpid(self.pid, 0)
        self.state.cleanup()


class Background(unittest.TestCase):
    def test_a_job_in_the_background_draws_nothing_until_it_is_in_front(self):
        shell = Shell()
        self.addCleanup(shell.close)
        self.assertTrue(shell.until(rb"ready> "))
        shell.type(f"'{PROGRAM}' tui pendulum --pictures off &\n")
        self.assertTrue(shell.until(rb"ready> "))
        drawn = False
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            shell.type("jobs\n")
            self.assertTrue(shell.until(rb"\[1\]\+?\s+\S[^\n]*\n[^\n]*ready> "))
            drawn = drawn or b"\033[?1049h" in shell.seen
            if b"Stopped" in shell.seen:
                break
        self.assertIn(b"Stopped", shell.seen)
        self.assertFalse(drawn)

        # in front it is as ever, and the shell is there after it
        shell.type("fg\n")
        self.assertTrue(shell.until(rb"paused"))
        shell.type("q")
        self.assertTrue(shell.until(rb"1049l(.|\n)*ready> "))


if __name__ == "__main__":
    driver.main()
