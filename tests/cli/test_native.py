# SPDX-License-Identifier: GPL-3.0-or-later
"""Native tapes in the program: what they cost is reported, switching them off works, bits stay, a bad folder does no harm."""

import glob
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402


def call(*words, cache=None, **more):
    return subprocess.run([driver.PROGRAM, *words], capture_output=True, timeout=120 * driver.SLOW,
                          env={**os.environ, "HOLONOM_CACHE": cache or "", **more})


class Native(unittest.TestCase):
    def setUp(self):
        self.cache = tempfile.mkdtemp(prefix="holonom-native-")
        self.addCleanup(shutil.rmtree, self.cache)

    def native(self, *words, **more):
        result = call("inspect", "fb0", "--json", *words, cache=self.cache, **more)
        self.assertEqual(result.returncode, 0, result.stderr[-600:])
        return json.loads(result.stdout)["native"]

    def test_inspect_states_costs_and_break_even(self):
        first, second = self.native(), self.native()
        self.assertEqual(first["status"], "compiled")
        self.assertGreater(first["compile_seconds"], 0)
        self.assertEqual(second["compile_seconds"], 0)  # kept in the folder
        for n in first, second:
            for key in "instructions", "emit_seconds", "load_seconds", "interpreter_ns", "native_ns":
                self.assertGreater(n[key], 0, key)
            self.assertIn("break_even_evaluations", n)

    def test_both_switches_leave_the_interpreter(self):
        off = {"status": "machine code is switched off"}
        self.assertEqual(self.native("--no-native"), off)
        self.assertEqual(self.native(HOLONOM_NATIVE="0"), off)
        self.assertEqual(os.listdir(self.cache), [])

    def test_a_folder_that_others_may_write_is_not_used(self):
        folder = os.path.join(self.cache, "native")
        os.mkdir(folder)
        os.chmod(folder, 0o777)
        self.assertIn("only this user may write", self.native()["status"])
        self.assertEqual(os.listdir(folder), [])

    def test_no_compiler_in_the_path_is_reported(self):
        self.assertIn("there is no C compiler", self.native(PATH=self.cache)["status"])

    def test_a_cache_that_cannot_be_made_is_told(self):
        for folder in "/proc/no-folder", os.path.join(self.cache, "no", "folder"):
            status = self.native(HOLONOM_CACHE=folder)["status"]
            self.assertEqual(status, "there is no folder for machine code; HOLONOM_CACHE can name one")

    def test_samples_are_the_same_to_the_last_bit(self):
        # long enough that the tape is compiled while it runs: 2,400,000 evaluations, and more where the compiler has little of the processor
        made = []
        for time in 6, 30, 150:
            words = ("run", "fb0-lagrangian", "--method", "projection@rk4:h=1e-5", "--time", str(time), "--every", "0.5", "--json")
            plain, native = (json.loads(call(*words, cache=self.cache, HOLONOM_NATIVE=on).stdout) for on in "01")
            for document in plain, native:
                document.pop("cost", None)  # seconds differ
            self.assertEqual(plain, native)
            made = [f for f in os.listdir(os.path.join(self.cache, "native")) if f.endswith(".so")]
            if made:
                break
        self.assertTrue(made)


class Start(unittest.TestCase):
    def test_a_start_does_not_load_what_pictures_need(self):
        needed = subprocess.run(["ldd", driver.PROGRAM], capture_output=True, text=True, check=True).stdout
        self.assertIn("libc.so", needed)
        for library in "OSMesa", "LLVM":
            self.assertNotIn(library, needed)

    def test_a_start_does_not_load_what_lies_in_the_program(self):
        needed = subprocess.run(["ldd", driver.PROGRAM], capture_output=True, text=True, check=True).stdout
        for library in "gsl", "sundials_ida", "klu", "png":
            if glob.glob(f"/usr/lib/*/lib{library}.a") or glob.glob(f"/usr/lib/lib{library}.a"):
                self.assertNotIn(f"lib{library}", needed)

    def test_a_start_takes_little_memory(self):
        child = subprocess.Popen([driver.PROGRAM, "version"], stdout=subprocess.DEVNULL)
        _, status, used = os.wait4(child.pid, 0)
        self.assertEqual(status, 0)
        if driver.SLOW == 1:  # sanitisers have a shadow of their own
            self.assertLess(used.ru_maxrss, 30 * 1024)  # kB; 57 MB with OSMesa, 14 without


if __name__ == "__main__":
    driver.main()
