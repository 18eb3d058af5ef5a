# SPDX-License-Identifier: GPL-3.0-or-later
"""What an exported program says about its coordinates, parameters and numbers is true of the scene."""

import json
import os
import re
import subprocess
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402

PROGRAM = os.path.abspath(driver.PROGRAM)


def call(*words):
    done = subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=120 * driver.SLOW)
    assert done.returncode == 0, done.stderr
    return done.stdout


def start_of(program):
    """Names of q and v of a program in Python, with their numbers at the start."""
    symbols = {}
    for array in "qv":
        names = dict(re.findall(rf"^# {array}\[(\d+)\] (\w+)$", program, re.M))
        numbers = re.search(rf"^START_{array.upper()} = np.array\(\[(.*)\]\)$", program, re.M)[1].split(", ")
        symbols |= {names[str(i)]: float(x) for i, x in enumerate(numbers)}
    return symbols


class Names(unittest.TestCase):
    def test_coordinates_of_the_scene_follow_from_those_of_the_program(self):
        for scene in ("four-bar", "bennett", "planetary-gear", "stewart-6-6", "seven-body-squeezer", "slider-crank"):
            program = call("export", scene, "--language", "python")
            terms = json.loads(call("terms", scene, "--json"))
            wanted = dict(zip(terms["coordinates"] + terms["rates"], terms["q"] + terms["v"]))
            own = start_of(program)
            said = {name: eval(text, {}, own) for line in re.findall(r"^# (\w+ = .*, \w+ = .*)$", program, re.M) for name, text in re.findall(r"(\w+) = ([^,]+)", line)}
            self.assertTrue(said or scene == "slider-crank", scene)
            turned = {name for names in re.findall(r"^# (\w+, \w+, \w+) are the rotation vector", program, re.M) for name in names.split(", ")}
            for name, number in wanted.items():
                if name not in turned:
                    self.assertAlmostEqual(said.get(name, own.get(name)), number, 9, (scene, name))

    def test_every_language_says_it(self):
        for language in ("c", "cpp", "java", "octave", "julia", "modelica"):
            self.assertIn(" a2 = theta_coupler - th1, wa2 = omega_coupler - w1\n", call("export", "four-bar", "--language", language), language)
        self.assertIn("(* a2 = theta$coupler - th1, wa2 = omega$coupler - w1 *)\n", call("export", "four-bar", "--language", "wolfram"))
        self.assertIn("\\eq{a_{2}}{\\theta_{\\mathrm{coupler}} - \\theta_{1}}\n", call("export", "four-bar", "--language", "latex"))
        self.assertNotIn("differ from these", call("export", "pendulum", "--language", "python"))

    def test_a_parameter_that_follows_from_others_says_how(self):
        self.assertIn("k = 0.0005 # computed from M*eps^2/2", call("export", "car-axis", "--language", "python").splitlines())
        self.assertIn("rr = 0.5 # computed from rs + 2*rp", call("export", "planetary-gear", "--language", "python").splitlines())
        self.assertNotIn("computed from", call("export", "car-axis", "--language", "python", "--set", "k=0.001"))

    def test_numbers_have_no_power_of_ten_where_few_digits_do(self):
        for language in ("python", "c", "java", "octave", "wolfram", "modelica"):
            program = call("export", "stewart-6-6", "--language", language)
            self.assertRegex(program, r"kp( =|:=|\b.*=) ?20000(\.0)?\b", language)
            self.assertNotIn("e+0", re.sub(r'["\'].*?["\']', "", program), language)


if __name__ == "__main__":
    driver.main()
