# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of the terminal workbench share: one frame as text, and the program in a pseudo-terminal of its own."""

import fcntl
import os
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import time

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402

PROGRAM = os.path.abspath(os.environ.get("HOLONOM", "build/holonom"))
ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
METHODS = ("--methods", "index1@rk4:h=0.02", "baumgarte@rk4:h=0.02", "projection@rk4:h=0.02")
STATE = tempfile.TemporaryDirectory()  # scores of exercises are kept here and not in the user's own folder
PATIENCE = 60.0 * driver.SLOW  # [s] a crowded machine; what is waited for comes in a fraction of a second
END = b"<the program has ended>"


def once(*words, **environment):
    """(status, standard output, standard error) of one frame as text."""
    env = {**os.environ, "LC_ALL": "C.UTF-8", "XDG_STATE_HOME": STATE.name, **environment}
    done = subprocess.run([PROGRAM, "tui", *words], capture_output=True, timeout=600, env=env, stdin=subprocess.DEVNULL)
    return done.returncode, done.stdout.decode(), done.stderr.decode()


def message(frame):
    """The line above the keys."""
    return frame.rstrip("\n").split("\n")[-2].strip()


def notice(frame):
    """The incident above the keys, whose lines are one again; "" where there is none."""
    found = re.search(r"(?m)^ (! .*(?:\n .*)*)\n .*$\Z", frame.rstrip("\n"))
    return " ".join(found.group(1).split()) if found else ""


class Terminal:
    """The program in a pseudo-terminal of its own; `seen` is all that it has written."""

    def __init__(self, *words, columns=100, rows=30, **environment):
        self.master, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
        self.before_start(slave)
        self.modes = termios.tcgetattr(slave)
        env = {**os.environ, "TERM": "xterm-256color", "LC_ALL": "C.UTF-8", "XDG_STATE_HOME": STATE.name, **environment}
        self.process = subprocess.Popen([PROGRAM, "tui", *words], stdin=slave, stdout=slave, stderr=slave, env=env,
                                        start_new_session=True)
        self.slave = slave
        self.seen = b""

    def before_start(self, slave):
        """For terminals that know more."""

    def read(self, seconds=0.05):
        """Waits so long for something, and takes all that is there; a motion that goes on writing does not hold it up."""
        while select.select([self.master], [], [], seconds)[0]:
            seconds = 0
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
                return self.process.returncode if self.read_to_the_end(end) else None
        return None

    def read_to_the_end(self, end):
        """All that the program has written stands before what is written after it."""
        os.write(self.slave, END)
        while END not in self.seen and time.monotonic() < end:
            self.read()
        found = END in self.seen
        self.seen = self.seen.replace(END, b"")
        return found

    def taken(self):
        """Waits until the program has read all that was typed."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            self.read(0.02)
            if struct.unpack("i", fcntl.ioctl(self.slave, termios.FIONREAD, b"\0" * 4))[0] == 0:
                return True
        return False

    def close(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        os.close(self.slave)
        os.close(self.master)
