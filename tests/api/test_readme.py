# SPDX-License-Identifier: GPL-3.0-or-later
"""The examples of server/README.md, as they stand there."""

import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import driver


def block(language, which=0):
    with open("server/README.md") as f:
        return re.findall(rf"```{language}\n(.*?)```", f.read(), re.S)[which]


class Examples(driver.ServerCase):
    def run_example(self, words, text):
        with tempfile.TemporaryDirectory() as folder:
            environment = {**os.environ, "HOLONOM_URL": f"http://127.0.0.1:{self.server.port}"}
            done = subprocess.run(words, input=text.encode(), capture_output=True, env=environment, cwd=folder, timeout=60 * driver.SLOW)
            self.assertEqual(done.returncode, 0, done.stderr.decode())
            files = {}
            for name in os.listdir(folder):
                with open(os.path.join(folder, name)) as f:
                    files[name] = f.read()
            return done.stdout.decode(), files

    @unittest.skipUnless(shutil.which("curl"), "no curl here")
    def test_the_shell(self):
        _, files = self.run_example(["sh", "-e"], block("sh"))
        self.assertIn('"state":"finished"', files["summary.json"])
        lines = files["samples.csv"].splitlines()
        self.assertEqual((lines[0], len(lines)), ('t,"th1","a2","th3",gap', 1 + 21))

    @unittest.skipUnless(shutil.which("curl"), "no curl here")
    def test_the_shell_reads_events_and_a_program(self):
        _, files = self.run_example(["sh", "-e"], block("sh") + block("sh", 1))
        self.assertEqual(files["events.txt"].count("event: sample"), 201)
        self.assertIn("event: end", files["events.txt"])
        self.assertIn("in the workbench: projection@rk4:h=0.001", files["motion.m"])

    @unittest.skipUnless(shutil.which("curl"), "no curl here")
    def test_the_shell_drags_and_exports(self):
        _, files = self.run_example(["sh", "-e"], block("sh", 2))
        dragged = json.loads(files["drag.json"])
        self.assertEqual(dragged["end"], "nearest")
        self.assertAlmostEqual(dragged["state"]["th1"], math.atan2(0.9, -0.3), 2)
        _, files = self.run_example(["sh", "-e"], block("sh", 3))
        self.assertIn("int main(", files["motion.c"])

    def test_python(self):
        out, _ = self.run_example([sys.executable, "-"], block("python"))
        self.assertEqual([line.split()[0] for line in out.splitlines()], ["index1@rk4:h=0.01", "projection@rk4:h=0.01"])
        self.assertGreater(*(float(line.split()[1]) for line in out.splitlines()))

    def test_python_with_numpy(self):
        python = next((p for p in (sys.executable, "/usr/bin/python3") if subprocess.run([p, "-c", "import numpy"], capture_output=True).returncode == 0), None)
        if not python:
            self.skipTest("no numpy here")
        out, _ = self.run_example([python, "-"], block("python", 1))
        self.assertRegex(out, r"^\['a2', 'gap', 't', 'th1', 'th3'\] [0-9.]+ [0-9.e-]+\n$")

    @unittest.skipUnless(shutil.which("octave-cli") and shutil.which("curl"), "no octave-cli and curl here")
    def test_octave(self):
        # it reads a program from a file only; its own words at the end of a process are not the example's
        text = block("octave")
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "example.m")
            with open(path, "w") as f:
                f.write(text)
            out, _ = self.run_example(["octave-cli", "--norc", "--quiet", path], "")
        self.assertRegex(out, r"^ok 201 [0-9.e-]+\n$")

    @unittest.skipUnless(shutil.which("node"), "no node here")
    def test_javascript(self):
        out, _ = self.run_example(["node", "--input-type=module", "-"], block("javascript"))
        self.assertRegex(out, r"^ok 201 [0-9.e-]+\n$")


if __name__ == "__main__":
    driver.main()
