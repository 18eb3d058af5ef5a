# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests of exercises share: a call of the program, files of answers, and TAP of what was expected."""

import json
import os
import subprocess
import tempfile

PROGRAM = os.environ.get("HOLONOM", "build/holonom")
RESULTS = []


def run(*words, home=None):
    env = dict(os.environ, HOLONOM_HOME=home) if home else os.environ
    return subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=120, env=env)


def expect(name, good, said=""):
    RESULTS.append((name, good, said))


def write(folder, name, content):
    path = os.path.join(folder, name)
    with open(path, "w", encoding="utf-8") as f:
        f.write(content if isinstance(content, str) else json.dumps(content))
    return path


def read(path):
    with open(path, "rb") as f:
        return f.read()


def speak_tap(tests):
    """Runs each test in a folder of its own; returns the exit status of the program."""
    for test in tests:
        with tempfile.TemporaryDirectory() as folder:
            test(folder)
    for n, (name, good, said) in enumerate(RESULTS, 1):
        if not good:
            print("# " + said.replace("\n", "\n# "))
        print(f"{'ok' if good else 'not ok'} {n} - {name}")
    print(f"1..{len(RESULTS)}")
    return 0 if all(good for _, good, _ in RESULTS) else 1
