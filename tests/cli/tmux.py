# SPDX-License-Identifier: GPL-3.0-or-later
"""A shell in a terminal of its own, inside tmux: keys go in, the screen comes out."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402

PATIENCE = 60 * driver.SLOW  # [s] until something that must appear has appeared


@unittest.skipUnless(shutil.which("tmux"), "tmux is not here")
class Tmux(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.remove_folder)
        self.starts = 0
        self.addCleanup(self.stop)

    def tmux(self, *words, check=True):
        env = {**os.environ, "LC_ALL": "C.UTF-8", "TERM": "xterm-256color", "HOLONOM_CACHE": self.folder.name}
        env.pop("TMUX", None)
        done = subprocess.run(["tmux", "-u", "-S", self.socket, "-f", "/dev/null", *words], capture_output=True, text=True, env=env, timeout=600)
        if check:
            self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def start(self, width, height, command, shell="bash --norc --noprofile", prompt="PS1='$ '"):
        """An interactive shell, in a server of its own, that is told to run the command."""
        self.starts += 1
        self.socket = os.path.join(self.folder.name, f"tmux{self.starts}")
        self.tmux("new-session", "-d", "-x", str(width), "-y", str(height), shell)
        self.keys(f"{prompt}; clear; {command}", "Enter")

    def stop(self):
        self.tmux("kill-server", check=False)

    def remove_folder(self):
        """A shell that was told to end may still write its history, or a compiler its cache: the folder is emptied again until it is gone."""
        deadline = time.monotonic() + PATIENCE
        while True:
            try:
                return self.folder.cleanup()
            except OSError:
                if time.monotonic() > deadline:
                    raise
            time.sleep(0.05)

    def screen(self):
        return self.tmux("capture-pane", "-p")

    def wait_for(self, pattern):
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            screen = self.screen()
            if re.search(pattern, screen):
                return screen
            time.sleep(0.1)
        self.fail(f"'{pattern}' did not appear in\n{screen}")

    def keys(self, *keys):
        self.tmux("send-keys", *keys)
