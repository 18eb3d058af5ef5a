# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests of the command line share: a call, its exit statuses, a submission."""

import json
import os
import subprocess
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402

DONE, INPUT, PROGRAM, ENDED = 0, 2, 3, 4
RK4 = "index1@rk4:h=1e-3"
SUBMISSION = {"J": [["-l1*sin(th1)", "-l2*sin(th2)", "l3*sin(th3)", "l4*sin(th4)"],
                    ["l1*cos(th1)", "l2*cos(th2)", "-l3*cos(th3)", "-l4*cos(th4)"]]}


def call(*words, stdin="", environment=None):
    env = dict(os.environ, **(environment or {}))
    return subprocess.run([driver.PROGRAM, *words], input=stdin.encode(), capture_output=True, env=env, timeout=120 * driver.SLOW)


def strict(text):
    def refuse(word):
        raise ValueError("JSON holds " + word)

    return json.loads(text, parse_constant=refuse)


class Command(unittest.TestCase):
    def assert_exit(self, done, status):
        self.assertEqual(done.returncode, status, (done.stdout[-300:], done.stderr[-600:]))
        return done.stdout.decode()
