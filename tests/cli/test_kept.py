# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that the program keeps for itself: believed only when they are whole and its own, and what becomes of work when they cannot be
written. A limit of the size of files stands for a full disk: both end a write in the middle."""

import json
import os
import re
import resource
import signal
import stat
import subprocess
import tempfile
import time
import unittest

import studies
from studies import call, command

LONG = ["study", "four-bar", "--levels", "10"]
REFERENCE = ["reference", "pendulum", "--time", "0.7", "--json"]


class Kept(unittest.TestCase):
    def setUp(self):
        self.kept = tempfile.TemporaryDirectory()
        self.addCleanup(self.kept.cleanup)
        self.folder = self.kept.name

    def reference(self):
        document = json.loads(call(REFERENCE, self.folder).stdout)
        files = [os.path.join(self.folder, name) for name in os.listdir(self.folder) if name.startswith("reference-")]
        return document, files[0]

    def test_a_kept_reference_that_was_changed_is_computed_again(self):
        first, path = self.reference()
        self.assertEqual((first["source"], self.reference()[0]["source"]), ("computed", "kept"))
        with open(path, "rb") as f:
            whole = f.read()
        at = whole.index(b'"q":[') + 8
        digit = b"1" if whole[at : at + 1] != b"1" else b"2"
        for damaged in (whole[:at] + digit + whole[at + 1 :], whole[:-5], whole[: len(whole) // 2], b"", whole + b" ", whole.replace(b'"checksum"', b'"checksun"')):
            with open(path, "wb") as f:
                f.write(damaged)
            again = self.reference()[0]
            self.assertEqual((again["source"], again["q"]), ("computed", first["q"]))
            with open(path, "rb") as f:
                self.assertEqual(f.read(), whole, "and kept anew")

    def test_a_kept_reference_is_a_regular_file_of_its_own(self):
        _, path = self.reference()
        elsewhere = os.path.join(self.folder, "elsewhere")
        os.rename(path, elsewhere)
        os.symlink(elsewhere, path)
        with open(elsewhere, "a") as f:
            f.write("mine\n")
        self.assertEqual(self.reference()[0]["source"], "computed", "a link is not followed")
        with open(elsewhere) as f:
            self.assertTrue(f.read().endswith("mine\n"), "nor is what it leads to overwritten")
        self.assertFalse(os.path.islink(path))
        os.unlink(path)
        os.mkfifo(path)
        done = call(REFERENCE, self.folder)  # nobody writes into it, and nobody waits
        self.assertEqual((done.returncode, json.loads(done.stdout)["source"]), (0, "computed"))

    def journal(self):
        """The path of the journal of LONG, which is stopped once it has begun."""
        status, _, told = studies.interrupt(LONG, self.folder, "study-")
        self.assertEqual(status, studies.ENDED, told)
        return os.path.join(self.folder, studies.journals(self.folder, "study-")[0])

    def test_a_line_of_a_kept_map_whose_steps_are_no_count_is_computed_again(self):
        words = ["study", "four-bar", "stability", "--methods", "baumgarte@rk4", "--grid", "24x24", "--json"]
        status, _, told = studies.interrupt(words, self.folder, "stability-")
        self.assertEqual(status, studies.ENDED, told)
        path = os.path.join(self.folder, studies.journals(self.folder, "stability-")[0])
        with open(path, encoding="utf-8") as f:
            lines = f.read()
        damaged = re.sub(r'("numbers":\[[^]]*,)[\d.e+]+\]', lambda m: m[1] + "6.7e82]", lines, count=1)
        self.assertNotEqual(lines, damaged)
        with open(path, "w", encoding="utf-8") as f:
            f.write(damaged)
        done = call([*words, "--time-limit", "0.1"], self.folder)
        self.assertEqual(done.returncode, studies.DONE, done.stderr)
        for wrong in (b"e+82", b"e82", b"-9223372036854775808"):  # the last is what a cast makes of it
            self.assertNotIn(wrong, done.stdout)

    def test_nothing_in_the_place_of_a_journal_is_followed_or_waited_for(self):
        path = self.journal()
        other = os.path.join(self.folder, "precious")
        for make, why in ((lambda: os.symlink(other, path), "it is a link"), (lambda: os.mkfifo(path), "it is not a regular file")):
            with open(other, "w") as f:
                f.write("precious\n")
            os.unlink(path)
            make()
            done = call(LONG, self.folder, text=True)
            self.assertEqual(done.returncode, studies.INPUT, done.stderr)
            self.assertIn(why, done.stderr)
            with open(other) as f:
                self.assertEqual(f.read(), "precious\n")

    def test_the_folder_is_for_its_owner_alone(self):
        folder = os.path.join(self.folder, "new")
        call(REFERENCE, folder)
        self.assertEqual(stat.S_IMODE(os.stat(folder).st_mode), 0o700)

    def test_a_full_disk_is_told_when_the_work_ends_early(self):
        argv, env = command(LONG, self.folder)
        for how in (signal.SIGINT, signal.SIGTERM):
            def no_room():
                signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # a write then fails, as on a full disk
                resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))

            with subprocess.Popen(argv, env=env, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, preexec_fn=no_room) as process:
                deadline = time.monotonic() + 60
                while not studies.journals(self.folder, "study-") and time.monotonic() < deadline:
                    time.sleep(0.01)
                time.sleep(studies.driver.SLOW)
                process.send_signal(how)
                told = process.stderr.read().decode()
                self.assertEqual(process.wait(timeout=600), studies.ENDED, told)
            self.assertIn("not all that is finished could be kept: the same command computes the rest of it again", told)
            self.assertNotIn("continues from here", told)


if __name__ == "__main__":
    studies.driver.main()
