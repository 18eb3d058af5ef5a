# SPDX-License-Identifier: GPL-3.0-or-later
"""Exported MJCF in MuJoCo itself: every model loads, and what MJCF holds moves there as it does here. Skipped without libmujoco-dev.

MuJoCo holds loops by stiff springs; tests/cli/mujoco_run.c makes them as stiff as it allows. Each scene of which nothing is left out
is run for 0.5 s by both, and the hinges and slides of both are compared at the end.
"""

import os
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "api"))
sys.path.insert(0, HERE)
import driver  # noqa: E402
from test_export_mechanism import LEFT_OUT, TIME, WITHOUT_BODIES, call, column, names, run  # noqa: E402

STEP = 1e-4  # s
TREE = 1e-9  # rad or m: a fourth-order method at this step
# rad or m: an equality gives way by up to some 1e-5 m at this step, and a motion of 0.5 s carries that on; a wrong frame, axis or
# moment of inertia shows in the second digit
LOOP = 1e-3
RING = 1e-2  # twelve rods hang in one loop, and the gap is ten times that of the others


@unittest.skipUnless(os.path.exists("/usr/include/mujoco/mujoco.h"), "libmujoco-dev is not installed")
class MuJoCo(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.kept = tempfile.TemporaryDirectory()
        cls.program = os.path.join(cls.kept.name, "mujoco_run")
        subprocess.run(["gcc", "-O1", "-Wall", os.path.join(HERE, "mujoco_run.c"), "-o", cls.program, "-lmujoco", "-lm"], check=True)

    @classmethod
    def tearDownClass(cls):
        cls.kept.cleanup()

    def in_mujoco(self, scene):
        """The number of equalities, and the hinges and slides at the end."""
        model = os.path.join(self.kept.name, scene + ".xml")
        self.assertEqual(call("export", scene, "--format", "mjcf", "-o", model).returncode, 0)
        done = subprocess.run([self.program, model, str(TIME), str(STEP)], capture_output=True, text=True, cwd=self.kept.name,
                              timeout=120 * driver.SLOW)
        self.assertEqual((done.returncode, done.stderr), (0, ""), scene)
        head, *rest = done.stdout.splitlines()
        words = head.split()
        self.assertEqual(words[-1], "0", f"{scene}: MuJoCo warns")
        return int(words[1]), dict(line.split("\t") for line in rest)

    def test_what_mjcf_holds_moves_in_mujoco_as_it_does_here(self):
        compared = 0
        for name in names():
            if name in WITHOUT_BODIES or name in LEFT_OUT:
                continue
            with self.subTest(name):
                equalities, theirs = self.in_mujoco(name)
                ours = run(name)
                allowed = RING if name == "ring" else LOOP if equalities else TREE
                for joint in set(theirs) & set(ours["coordinates"]):
                    compared += 1
                    self.assertLess(abs(float(theirs[joint]) - column(ours, "q", joint)[-1]), allowed, joint)
        self.assertGreater(compared, 60)

    def test_models_of_which_something_is_left_out_load_and_run(self):
        for name in LEFT_OUT:
            with self.subTest(name):
                self.in_mujoco(name)


if __name__ == "__main__":
    driver.main()
