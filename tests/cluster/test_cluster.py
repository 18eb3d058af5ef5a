# SPDX-License-Identifier: GPL-3.0-or-later
"""The recipes for a Slurm job array and for GNU parallel, run as they are: both merge to the file of one process."""

import contextlib
import glob
import os
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "api"))
sys.path.insert(0, HERE)
import driver  # noqa: E402
import slurm  # noqa: E402

PROGRAM = os.path.abspath(driver.PROGRAM)
STUDY = ["fb0", "work-precision", "--methods", "projection@rk4", "baumgarte:alpha=20,beta=20@rk4", "projection@dopri5", "ggl@radau5", "--time", "1",
         "--levels", "5", "--samples", "0", "--time-limit", "0"]

with_root = unittest.skipUnless(os.geteuid() == 0, f"SLURM WAS NOT TRIED: its daemons start as root only, and this is user {os.geteuid()}")


def bytes_of(path):
    with open(path, "rb") as f:
        return f.read()


class Cluster(unittest.TestCase):
    def setUp(self):
        self.kept = tempfile.TemporaryDirectory()
        self.folder = self.kept.name
        self.environment = dict(os.environ, HOLONOM=PROGRAM, HOLONOM_CACHE=self.path("cache"))
        os.mkdir(self.path("cache"))

    def tearDown(self):
        self.kept.cleanup()

    def path(self, name):
        return os.path.join(self.folder, name)

    def holonom(self, *words):
        done = subprocess.run([PROGRAM, *words], env=self.environment, capture_output=True, timeout=120 * driver.SLOW)
        self.assertEqual(done.returncode, 0, done.stderr)

    def assert_like_one_process(self, parts, n):
        self.assertEqual(len(parts), n)
        for ending in (".json", ".html"):
            self.holonom("study", *STUDY, "--out", self.path("one" + ending))
            if not os.path.exists(self.path("merged" + ending)):
                self.holonom("merge", *parts, "--out", self.path("merged" + ending))
            self.assertEqual(bytes_of(self.path("merged" + ending)), bytes_of(self.path("one" + ending)))

    @contextlib.contextmanager
    def slurm_of_two_processors(self):
        """Slurm started anew; its jobs see the program and the folder of unfinished work that all these tests use."""
        self.assertEqual(slurm.missing(), [], "not installed")
        os.chmod(self.folder, 0o755)
        with slurm.Slurm(cpus=2) as cluster:
            cluster.environment.update(self.environment, SLURM_CONF=cluster.environment["SLURM_CONF"], PATH=cluster.environment["PATH"])
            yield cluster

    def test_gnu_parallel_with_two_jobs_merges_to_the_file_of_one_process(self):
        done = subprocess.run([os.path.join(HERE, "parallel.sh"), "2", "5", self.path("results"), *STUDY], env=self.environment, capture_output=True,
                              stdin=subprocess.DEVNULL, timeout=120 * driver.SLOW)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_like_one_process(sorted(glob.glob(self.path("results/part-*-of-5.json"))), 5)

    def test_gnu_parallel_tells_when_a_part_fails(self):
        done = subprocess.run([os.path.join(HERE, "parallel.sh"), "2", "2", self.path("results"), "no-such-scene"], env=self.environment, capture_output=True,
                              stdin=subprocess.DEVNULL, timeout=120 * driver.SLOW)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn(b"no shipped scene is called 'no-such-scene'", done.stderr)

    @with_root
    def test_a_slurm_array_of_four_tasks_merges_to_the_file_of_one_process(self):
        with self.slurm_of_two_processors() as cluster:
            array = cluster.call("sbatch", "--parsable", "--array=1-4", "--chdir=" + self.folder, os.path.join(HERE, "array.sbatch"), "4",
                                 "results", *STUDY)
            cluster.call("sbatch", "--dependency=afterok:" + array, "--chdir=" + self.folder, "--output=merge.log",
                         f"--wrap={PROGRAM} merge results/part-*-of-4.json --out merged.json")
            cluster.wait_for_jobs()
        logs = b"".join(bytes_of(f) for f in sorted(glob.glob(self.path("*.log"))))
        for i in range(1, 5):
            self.assertIn(b"Part %d of 4" % i, logs)
        self.assert_like_one_process(sorted(glob.glob(self.path("results/part-*-of-4.json"))), 4)


ANSWER = os.path.join(HERE, "..", "..", "lessons", "01-closed-loops", "answers", "p3.json")


class Class(Cluster):
    """A class in parts: the merged scores are those of one process, to the byte."""

    STUDENTS = 14

    def setUp(self):
        super().setUp()
        with open(ANSWER, encoding="utf-8") as f:
            right = f.read()
        os.mkdir(self.path("handed in"))
        for k in range(self.STUDENTS):
            text = (right, "{}", "no JSON", right.replace('"-l1*sin(th1)"', '"l1*sin(th1)"'))[k % 4]
            with open(self.path(f"handed in/student {k}.json"), "w", encoding="utf-8") as f:
                f.write(text)

    def assert_like_one_process(self, parts, n):
        self.assertEqual(len(parts), n)
        self.holonom("grade", "p3", self.path("handed in"), "--jobs", "1", "--out", self.path("one.ndjson"))
        self.holonom("grade", "p3", "--merge", *parts, "--out", self.path("merged.ndjson"))
        self.assertEqual(bytes_of(self.path("merged.ndjson")), bytes_of(self.path("one.ndjson")))
        self.assertEqual(bytes_of(self.path("one.ndjson")).count(b"\n"), self.STUDENTS)

    def test_gnu_parallel_with_two_jobs_merges_to_the_file_of_one_process(self):
        words = [os.path.join(HERE, "class.sh"), "2", "5", self.path("results"), "p3", self.path("handed in")]
        done = subprocess.run(words, env=self.environment, capture_output=True, stdin=subprocess.DEVNULL, timeout=120 * driver.SLOW)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_like_one_process(sorted(glob.glob(self.path("results/part-*-of-5.ndjson"))), 5)

    def test_gnu_parallel_tells_when_a_part_fails(self):
        words = [os.path.join(HERE, "class.sh"), "2", "2", self.path("results"), "p33", self.path("handed in")]
        done = subprocess.run(words, env=self.environment, capture_output=True, stdin=subprocess.DEVNULL, timeout=120 * driver.SLOW)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn(b"p33", done.stderr)

    def test_the_tasks_of_an_array_one_by_one_merge_to_the_file_of_one_process(self):
        """Without Slurm's daemons: each task as Slurm starts it, by its number; the third is started twice."""
        for task in (4, 2, 3, 1, 3):
            environment = {**self.environment, "SLURM_ARRAY_TASK_ID": str(task)}
            words = ["sh", os.path.join(HERE, "class.sbatch"), "4", "results", "p3", self.path("handed in")]
            done = subprocess.run(words, env=environment, capture_output=True, cwd=self.folder, timeout=120 * driver.SLOW)
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_like_one_process(sorted(glob.glob(self.path("results/part-*-of-4.ndjson"))), 4)

    @with_root
    def test_a_slurm_array_of_four_tasks_merges_to_the_file_of_one_process(self):
        with self.slurm_of_two_processors() as cluster:
            cluster.call("sbatch", "--parsable", "--array=1-4", "--chdir=" + self.folder, os.path.join(HERE, "class.sbatch"), "4", "results", "p3",
                         self.path("handed in"))
            cluster.wait_for_jobs()
        self.assert_like_one_process(sorted(glob.glob(self.path("results/part-*-of-4.ndjson"))), 4)


if __name__ == "__main__":
    driver.main()
