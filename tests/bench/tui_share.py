# SPDX-License-Identifier: GPL-3.0-or-later
"""The share of one processor that the terminal workbench takes while it draws six methods at twenty pictures a second: CSV.

The motion is recorded first, so that drawing alone is measured: computing time of the process over wall time, in a terminal
that takes what is written; the mechanism in characters, by kitty graphics and by sixels. The last column says whether it stays within a tenth."""

import fcntl
import os
import pty
import re
import select
import struct
import subprocess
import sys
import termios
import time

PROGRAM = os.path.abspath(os.environ.get("HOLONOM", "build/holonom"))
METHODS = ["index1@rk4:h=0.01", "baumgarte@rk4:h=0.01", "projection@rk4:h=0.01", "nullspace@rk4:h=0.01", "reduced@rk4:h=0.01", "ggl@radau5:rtol=1e-6"]
MOST = 0.10
CELL = (10, 20)  # [px], of the pictures


def cpu_seconds(pid):
    with open(f"/proc/{pid}/stat", encoding="ascii") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Watched:
    def __init__(self, columns, rows, drawn):
        self.master, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, columns * CELL[0], rows * CELL[1]))
        env = {**os.environ, "TERM": "xterm-256color", "LC_ALL": "C.UTF-8"}
        self.process = subprocess.Popen([PROGRAM, "tui", "four-bar", "--pictures", drawn, "--methods", *METHODS], stdin=slave, stdout=slave, stderr=slave, env=env)
        os.close(slave)
        self.bytes = 0

    def read_for(self, seconds):
        """What is written meanwhile."""
        end, seen = time.monotonic() + seconds, b""
        while time.monotonic() < end:
            if select.select([self.master], [], [], 0.01)[0]:
                seen += os.read(self.master, 65536)
        self.bytes += len(seen)
        return seen

    def close(self):
        self.process.kill()
        self.process.wait()


def measure(columns, rows, drawn):
    watched = Watched(columns, rows, drawn)
    # ten times the speed to the end: then every frame is recorded
    watched.read_for(1.0)
    os.write(watched.master, b" ===")
    seen = b""
    while not re.search(rb"running(.|\n)*paused", seen):
        seen += watched.read_for(0.2)
    os.write(watched.master, b"--- ")
    watched.read_for(0.5)
    watched.bytes, before, start = 0, cpu_seconds(watched.process.pid), time.monotonic()
    watched.read_for(7.0)
    share = (cpu_seconds(watched.process.pid) - before) / (time.monotonic() - start)
    rate = watched.bytes / (time.monotonic() - start)
    watched.close()
    return share, rate


def main():
    print("columns,rows,drawn_in,share_of_one_processor,bytes_per_second,within_a_tenth")
    good = True
    for columns, rows in ((80, 24), (120, 40), (200, 60)):
        for drawn in ("off", "kitty", "sixel"):
            share, rate = measure(columns, rows, drawn)
            good = good and share <= MOST
            words = "characters" if drawn == "off" else drawn
            print(f"{columns},{rows},{words},{share:.4f},{rate:.0f},{'yes' if share <= MOST else 'no'}", flush=True)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
