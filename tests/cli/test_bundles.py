# SPDX-License-Identifier: GPL-3.0-or-later
"""The bundles for Gradescope and PrairieLearn, run as the platforms do: their folders at their places, none of this tree in sight."""

import importlib.util
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402
from test_programs import TROUBLE  # noqa: E402

PROGRAM = os.path.abspath(driver.PROGRAM)
ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
BUNDLE = os.path.join(ROOT, "server", "deploy", "bundle.py")


def call(*words):
    return subprocess.run(list(words), capture_output=True, text=True, timeout=120 * driver.SLOW)


def inside(folder, place, command):
    """Runs a command where the folder lies at its place and of this machine only what any image has: no library of ours beside those of the bundle."""
    return call("bwrap", "--unshare-all", "--die-with-parent", "--ro-bind", "/usr", "/usr", "--symlink", "usr/bin", "/bin", "--symlink", "usr/lib", "/lib",
                "--symlink", "usr/lib64", "/lib64", "--proc", "/proc", "--dev", "/dev", "--tmpfs", "/tmp", "--bind", folder, place, "--clearenv",
                "--setenv", "PATH", "/usr/bin:/bin", command)  # fmt: skip


# a sanitiser wants to see its whole machine
SANITISED = "san.so" in subprocess.run(["ldd", PROGRAM], capture_output=True, text=True).stdout


@unittest.skipIf(TROUBLE or SANITISED, TROUBLE or "a sanitised program is no bundle")
class Bundles(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.made = os.path.join(self.temporary.name, "made")
        self.at = os.path.join(self.temporary.name, "at")
        os.makedirs(self.at)

    def make(self, kind, identity):
        done = call(sys.executable, BUNDLE, kind, PROGRAM, identity, self.made)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(os.path.exists(self.made + ".zip"))

    def put(self, path, text):
        whole = os.path.join(self.at, path)
        os.makedirs(os.path.dirname(whole), exist_ok=True)
        with open(whole, "w", encoding="utf-8") as f:
            f.write(text)

    def test_gradescope(self):
        self.make("gradescope", "p3")
        # the archive, unpacked as the platform does, without the marks of what may be run
        source = os.path.join(self.at, "source")
        shutil.unpack_archive(self.made + ".zip", source)
        for name in ("setup.sh", "run_autograder"):
            os.chmod(os.path.join(source, name), 0o755)
        self.assertEqual(inside(self.at, "/autograder", "/autograder/source/setup.sh").returncode, 0)
        shutil.copy(os.path.join(source, "run_autograder"), os.path.join(self.at, "run_autograder"))
        with open(os.path.join(ROOT, "lessons", "01-closed-loops", "answers", "p3.json"), encoding="utf-8") as f:
            right = f.read()
        self.put("submission_metadata.json", '{"users": [{"email": "ada@example.org", "name": "Ada"}], "assignment": {}}')
        for text, score in ((right, 8), (right.replace('"-l1*sin(th1)"', '"l1*sin(th1)"'), None), ("no JSON", 0)):
            self.put("submission/answer.json", text)
            done = inside(self.at, "/autograder", "/autograder/run_autograder")
            self.assertEqual(done.returncode, 0, done.stderr)
            with open(os.path.join(self.at, "results", "results.json"), encoding="utf-8") as f:
                results = json.load(f)
            if score is None:
                self.assertGreater(sum(t["score"] for t in results["tests"]), 0)
                self.assertLess(sum(t["score"] for t in results["tests"]), 8)
            else:
                self.assertEqual(results.get("score", sum(t["score"] for t in results.get("tests", []))), score, results)
            os.remove(os.path.join(self.at, "results", "results.json"))

    def test_prairielearn(self):
        self.make("prairielearn", "p1")
        with open(os.path.join(self.made, "info.json"), encoding="utf-8") as f:
            info = json.load(f)
        self.assertEqual(info["externalGradingOptions"]["entrypoint"], "/grade/tests/run.sh")
        # the question draws its variant; its text is that of the variant
        spec = importlib.util.spec_from_file_location("server", os.path.join(self.made, "server.py"))
        server = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(server)
        data = {"params": {}, "variant_seed": "12345"}
        server.generate(data)
        seed = data["params"]["variant"]
        self.assertEqual(data["params"]["text"], call(PROGRAM, "problem", "p1", "--seed", str(seed)).stdout)
        # the grader's container: tests, submission and data at their places
        shutil.copytree(os.path.join(self.made, "tests"), os.path.join(self.at, "tests"))
        self.put("data/data.json", json.dumps({"params": data["params"], "submitted_answers": {}}))
        right = {"a": {"matrix": [["M", "J'"], ["J", "0"]], "right": ["S'*tau - h", "-gamma"], "unknowns": ["a", "-lambda"]}}
        for answer, gradable in ((json.dumps(right), True), ("no JSON", False)):
            self.put("student/answer.json", answer)
            done = inside(self.at, "/grade", "/grade/tests/run.sh")
            self.assertEqual(done.returncode, 0, done.stderr)
            with open(os.path.join(self.at, "results", "results.json"), encoding="utf-8") as f:
                results = json.load(f)
            self.assertEqual(results["gradable"], gradable, results)
            if gradable:
                self.assertGreater(results["score"], 0)
                self.assertLessEqual(results["score"], 1)
            os.remove(os.path.join(self.at, "results", "results.json"))

    def test_an_exercise_that_there_is_not_is_refused(self):
        done = call(sys.executable, BUNDLE, "gradescope", PROGRAM, "gaers", self.made)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("gears", done.stderr)
        self.assertFalse(os.path.exists(self.made))


if __name__ == "__main__":
    driver.main()
