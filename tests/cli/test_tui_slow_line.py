# SPDX-License-Identifier: GPL-3.0-or-later
# The terminal workbench over a slow line: fewer pictures are sent, none is late, and keys are seen at once.
import os
import re
import select
import sys
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402
from terminal import PATIENCE, Terminal  # noqa: E402


class SlowLine:
    """A terminal that takes `rate` bytes in a second, and knows the top row of its screen; it answers the question after its health as terminals do."""

    SEQUENCE = re.compile(rb"\033\[([?0-9;]*)([@-~])|\033\][^\a]*\a|\033[()][0-9A-Z]|\033[=>78M]")

    def __init__(self, terminal, rate):
        self.terminal, self.rate = terminal, rate  # [bytes/s]
        self.line = b""  # what has arrived and is not yet understood
        self.row, self.column, self.top = 0, 0, {}
        self.since = time.monotonic()
        self.read_bytes = 0

    def serve(self, until, seconds):
        """Reads at the rate until the condition holds; returns whether it did within the time."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            time.sleep(0.01)
            due = int((time.monotonic() - self.since) * self.rate) - self.read_bytes
            if due > 0 and select.select([self.terminal.master], [], [], 0)[0]:
                try:
                    piece = os.read(self.terminal.master, due)
                except OSError:
                    piece = b""
                self.read_bytes += len(piece)
                self.line += piece
                self.understand()
            elif due > 0:
                self.read_bytes += due  # what is not used of the line is lost
            if until():
                return True
        return False

    def understand(self):
        while self.line:
            found = self.SEQUENCE.match(self.line)
            if found:
                self.line = self.line[found.end():]
                self.obey(found.group(1), found.group(2))
            elif self.line[:1] == b"\033" and len(self.line) < 64:
                return  # the rest of it is on its way
            else:
                length = 1 + (self.line[0] >= 0xC0) + (self.line[0] >= 0xE0) + (self.line[0] >= 0xF0)
                if len(self.line) < length:
                    return
                self.put(self.line[:length].decode("utf-8", "replace"))
                self.line = self.line[length:]

    def put(self, character):
        if character == "\r":
            self.column = 0
        elif character == "\n":
            self.row += 1
        elif character == "\b":
            self.column -= 1
        elif character >= " ":
            if self.row == 0:
                self.top[self.column] = character
            self.column += 1

    def obey(self, numbers, final):
        if final == b"n" and numbers == b"5":
            os.write(self.terminal.master, b"\033[0n")
        if not final or numbers.startswith(b"?"):
            return
        values = [int(v) if v else 1 for v in numbers.split(b";")]
        if final == b"H":
            self.row, self.column = values[0] - 1, (values + [1])[1] - 1
        elif final == b"d":
            self.row = values[0] - 1
        elif final in b"G`":
            self.column = values[0] - 1
        elif final == b"C":
            self.column += values[0]
        elif final == b"D":
            self.column -= values[0]
        elif final == b"A":
            self.row -= values[0]
        elif final == b"B":
            self.row += values[0]

    def paused(self):
        return "paused" in "".join(self.top.get(k, " ") for k in range(100))

    def time_shown(self):
        """[s] of the motion, as the top row has it; None before it is there."""
        row = "".join(self.top.get(k, " ") for k in range(100))
        found = re.search(r"t (\d+\.\d+) s", row)
        return float(found.group(1)) if found else None


class ASlowLine(unittest.TestCase):
    def open(self, rate=2000.0):
        """The workbench after eight seconds of motion: what queues up has queued up by then."""
        terminal = Terminal("four-bar")
        self.addCleanup(terminal.close)
        line = SlowLine(terminal, rate)
        self.assertTrue(line.serve(line.paused, 3 * PATIENCE), line.top)
        terminal.type(" ")
        begun = line.read_bytes
        self.assertTrue(line.serve(lambda: line.read_bytes - begun > 8 * line.rate and not line.paused() and line.time_shown() is not None, 3 * PATIENCE), line.top)
        return terminal, line

    def test_fewer_pictures_are_sent_and_none_is_late(self):
        # of these eight seconds 7.8 have been shown, the rest is under way; 0.7 where every picture is sent
        terminal, line = self.open()
        self.assertGreater(line.time_shown(), 3.5)
        # one picture and the next have to pass until a key is seen: 1.5 s
        before = line.read_bytes
        terminal.type(" ")
        self.assertTrue(line.serve(line.paused, 2 * PATIENCE))
        self.assertLess(line.read_bytes - before, 5 * line.rate)

    def test_9600_baud_shows_no_picture_late(self):
        # ten bits a byte: the first picture takes most of the eight seconds, and nothing may have queued up behind it
        terminal, line = self.open(960.0)
        before = line.read_bytes
        terminal.type(" ")
        self.assertTrue(line.serve(line.paused, 2 * PATIENCE))
        self.assertLess(line.read_bytes - before, 5 * line.rate)

    def test_q_quits_at_once(self):
        # at most 1.5 s for the answer to the last picture, that the shell shall not read
        terminal, line = self.open()
        before = line.read_bytes
        terminal.type("q")
        self.assertTrue(line.serve(lambda: terminal.process.poll() is not None, 2 * PATIENCE))
        self.assertEqual(terminal.process.returncode, 0)
        self.assertLess(line.read_bytes - before, 5 * line.rate)


if __name__ == "__main__":
    driver.main()
