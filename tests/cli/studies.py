# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of studies from the command line share: calls with a folder of their own, strict documents, interrupts and kills."""

import json
import os
import pty
import random
import signal
import subprocess
import sys
import time
from html.parser import HTMLParser

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402

DONE, INPUT, PROGRAM, ENDED = 0, 2, 3, 4
VOID = {"meta", "input", "br", "circle", "path", "rect"}


def command(words, folder, **more):
    """What to run, and in which environment: unfinished work is kept in the folder, the terminal shows UTF-8."""
    return [driver.PROGRAM, *words], {**os.environ, "LC_ALL": "C.UTF-8", "HOLONOM_CACHE": folder, **more}


def call(words, folder, text=False, **more):
    argv, env = command(words, folder, **more)
    return subprocess.run(argv, capture_output=True, env=env, timeout=200 * driver.SLOW, check=False, text=text)


def strict(text):
    """JSON without the NaN and Infinity that Python would let pass."""
    def refuse(word):
        raise ValueError("JSON holds " + word)

    return json.loads(text, parse_constant=refuse)


def journals(folder, kind):
    return [name for name in os.listdir(folder) if name.startswith(kind)]


def kept_bytes(folder, kind):
    """How much the journals of that kind hold."""
    total = 0
    for name in journals(folder, kind):
        try:
            total += os.path.getsize(os.path.join(folder, name))
        except FileNotFoundError:  # the command has ended and removed it
            pass
    return total


def interrupt(words, folder, kind, how=signal.SIGINT):
    """Ctrl-C, or another signal, once there is a piece in the journal: exit status, what was written and what was told."""
    argv, env = command(words, folder)
    with subprocess.Popen(argv, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        deadline = time.monotonic() + 60 * driver.SLOW
        while time.monotonic() < deadline and kept_bytes(folder, kind) == 0:
            time.sleep(0.005)
        process.send_signal(how)
        out, err = process.communicate(timeout=60 * driver.SLOW)
    return process.returncode, out, err.decode()


def kill_often(words, folder, kind, seed, times=10):
    """Starts the command so many times and kills it: in turn at a random moment of its start, and a random moment after its journal has grown
    by a piece, so that the work goes on from kill to kill whatever the machine's speed. Returns how often the command had not come to its end."""
    argv, env = command(words, folder)
    chance = random.Random(seed)
    killed = 0
    for i in range(times):
        kept = kept_bytes(folder, kind)
        with subprocess.Popen(argv, env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            deadline = time.monotonic() + 60 * driver.SLOW
            while i % 2 and process.poll() is None and kept_bytes(folder, kind) <= kept and time.monotonic() < deadline:
                time.sleep(0.001)
            time.sleep(chance.uniform(0, 0.02 if i % 2 else 0.2))
            killed += process.poll() is None
            process.kill()
    return killed


def watch_terminal(words, folder, interrupt=False):
    """The command with a terminal for what it tells, stopped by Ctrl-C once time left is told, if asked for: exit status and what was told."""
    argv, env = command(words, folder)
    terminal, end = pty.openpty()
    process = subprocess.Popen(argv, stdout=subprocess.DEVNULL, stderr=end, env=env)
    os.close(end)
    seen = b""
    try:
        while piece := os.read(terminal, 4096):
            seen += piece
            if interrupt and b" left" in seen:
                process.send_signal(signal.SIGINT)
                interrupt = False
    except OSError:  # the other end is closed
        pass
    os.close(terminal)
    return process.wait(), seen.decode()


def assert_page(test, text, scripts=False):
    """One file: no network, no number that is none, every tag closed; and no script, where it is not to have one."""
    test.assertNotRegex(text, r"https?://|src=|@import|url\(|<link|fetch\(|XMLHttpRequest" + ("" if scripts else "|<script"))
    test.assertNotRegex(text, r">[^<]*\b(nan|inf)\b[^<]*<")
    open_tags = []

    class Balance(HTMLParser):
        def handle_starttag(self, tag, attrs):
            if tag not in VOID:
                open_tags.append(tag)

        def handle_startendtag(self, tag, attrs):
            pass

        def handle_endtag(self, tag):
            test.assertEqual(open_tags.pop(), tag)

    Balance().feed(text)
    test.assertEqual(open_tags, [])
