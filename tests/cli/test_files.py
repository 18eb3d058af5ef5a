# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that the command line reads and writes: none is lost or overwritten, and whose fault a failure is."""

import json
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
sys.path.insert(0, os.path.dirname(__file__))
import driver  # noqa: E402
from command import DONE, ENDED, INPUT, PROGRAM, SUBMISSION, Command, call, strict  # noqa: E402


class Files(Command):
    def test_no_verdict_is_lost_and_no_submission_overwritten(self):
        with tempfile.TemporaryDirectory() as folder:
            paths = []
            for student, sign in (("a", "-"), ("b", "")):
                os.mkdir(os.path.join(folder, student))
                paths.append(os.path.join(folder, student, "p3.json"))
                with open(paths[-1], "w") as f:
                    json.dump({"J": [[sign + "l1*sin(th1)", *SUBMISSION["J"][0][1:]], SUBMISSION["J"][1]]}, f)
            out = os.path.join(folder, "v")
            self.assert_exit(call("grade", "p3", *paths, "--out", out, "--format", "json"), DONE)
            scores = [strict(open(os.path.join(out, student, "p3.json")).read())["score"] for student in "ab"]
            self.assertEqual(scores, [8, 7.5])
            # two endings of one name in one folder
            shutil.copy(paths[0], os.path.join(folder, "a", "p3.txt"))
            self.assert_exit(call("grade", "p3", paths[0], os.path.join(folder, "a", "p3.txt"), "-o", out), DONE)
            self.assertTrue({"p3.json.txt", "p3.txt.txt"} <= set(os.listdir(out)))
            # one file under two names, and a folder of verdicts that is the folder of the submissions
            twice = call("grade", "p3", paths[0], os.path.join(folder, "b", "..", "a", "p3.json"), "-o", out)
            self.assert_exit(twice, INPUT)
            self.assertIn(b"one submission", twice.stderr)
            before = open(paths[0]).read()
            here = call("grade", "p3", paths[0], "-o", os.path.dirname(paths[0]), "--format", "json")
            self.assert_exit(here, INPUT)
            self.assertIn(b"would overwrite the submission", here.stderr)
            self.assertEqual(open(paths[0]).read(), before)

    def test_no_command_overwrites_its_input(self):
        with tempfile.TemporaryDirectory() as folder:
            scene, model = os.path.join(folder, "s.json"), os.path.join(folder, "m.xml")
            shutil.copy("lessons/01-closed-loops/scenes/four-bar.json", scene)
            shutil.copy("tests/import/four-bar.xml", model)
            link = os.path.join(folder, "link.png")
            os.symlink(scene, link)
            for words, path in ((("import", model, "-o", model), model), (("snapshot", scene, "-o", scene), scene),
                                (("snapshot", scene, "-o", link), scene), (("reference", scene, "--out", scene), scene)):
                before = open(path, "rb").read()
                done = call(*words)
                self.assert_exit(done, INPUT)
                self.assertIn(b"would be overwritten", done.stderr)
                self.assertEqual(open(path, "rb").read(), before)

    # what each command with --out writes, and the name of its file; {folder} holds submissions and a part of a study
    SHORT = ("--time", "0.05", "--methods", "index1@rk4:h=1e-2", "--levels", "2", "--samples", "0")
    WRITES = (
        (("export", "four-bar", "--language", "python"), "own.py"),
        (("export", "four-bar", "--language", "c"), "own.c"),
        (("export", "four-bar", "--language", "latex"), "own.tex"),
        (("export", "four-bar", "--format", "mjcf"), "own.xml"),
        (("study", "four-bar", "work-precision", *SHORT), "w.html"),
        (("study", "four-bar", "work-precision", *SHORT, "--shard", "1/2"), "part.json"),
        (("study", "four-bar", "budget", "--time", "0.05", "--methods", "index1@rk4:h=1e-2"), "f.html"),
        (("study", "four-bar", "stability", "--grid", "2x2"), "map.svg"),
        (("report", "fb0", *SHORT[2:]), "r.json"),
        (("reference", "fb0", "--time", "0.05"), "g.json"),
        (("merge", "{folder}/study.json"), "m.csv"),
        (("extreme", "x3"), "e.json"),
        (("snapshot", "four-bar"), "s.svg"),
        (("snapshot", "four-bar"), "s.png"),
        (("import", "tests/import/four-bar.xml"), "i.json"),
        (("problem", "gap-plot"), "p.svg"),
        (("grade", "p3", "{folder}/ann.json"), "v.json"),
        (("grade", "p3", "{folder}/ann.json", "--format", "gradescope"), "results.json"),
        (("grade", "p3", "{folder}/class"), "scores.csv"),
    )
    REFUSE = (
        (("program", "python"), "mine.py"),
        (("rubric", "write", "gears"), "rubric.json"),
        (("export", "four-bar", "--language", "c", "--blanks"), "blanks.c"),
    )

    def test_no_command_destroys_the_file_that_is_there(self):
        with tempfile.TemporaryDirectory() as folder:
            os.mkdir(os.path.join(folder, "class"))
            for name in ("ann.json", "class/ann.json"):
                with open(os.path.join(folder, name), "w") as f:
                    json.dump(SUBMISSION, f)
            environment = {"HOLONOM_CACHE": os.path.join(folder, "cache")}
            part = call("study", "four-bar", "work-precision", *self.SHORT, "--shard", "1/1", "-o", os.path.join(folder, "study.json"), environment=environment)
            self.assert_exit(part, DONE)
            for option in ("-o", "--out"):
                for words, name in self.WRITES + self.REFUSE:
                    with self.subTest(words=words, option=option):
                        place = tempfile.mkdtemp(dir=folder)
                        path = os.path.join(place, name)
                        with open(path, "w") as f:
                            f.write("mine\n")
                        given = path.replace("p-a.svg", "p.svg")  # a file for each part that has a plot
                        done = call(*(word.format(folder=folder) for word in words), option, given, environment=environment)
                        if (words, name) in self.REFUSE:
                            self.assert_exit(done, INPUT)
                            self.assertEqual((os.listdir(place), open(path).read()), ([name], "mine\n"))
                            continue
                        self.assertIn(done.returncode, (DONE, ENDED), done.stderr)
                        self.assertEqual(open(path + ".1").read(), "mine\n")
                        self.assertNotEqual(open(path, "rb").read(), b"mine\n")
                        told = " ".join(done.stderr.decode().split())
                        self.assertIn(f"the old contents of '{path}' are kept in '{path}.1'", told)
                if option == "-o":
                    # every command that has the option is in the tables
                    names = {line.split()[1] for line in call("help").stdout.decode().splitlines() if line.startswith("  holonom ")}
                    self.assertEqual({name for name in names if b"--out FILE" in call("help", name).stdout}, {words[0] for words, _ in self.WRITES + self.REFUSE})

    def test_what_stands_beside_the_output_is_kept_too(self):
        with tempfile.TemporaryDirectory() as folder:
            path = {name: os.path.join(folder, name) for name in ("a.urdf", "loops.json", "real.py", "link.py")}
            for name in ("loops.json", "real.py"):
                with open(path[name], "w") as f:
                    f.write("mine\n")
            self.assert_exit(call("export", "four-bar", "--format", "urdf", "--loops", path["loops.json"], "-o", path["a.urdf"]), DONE)
            self.assertEqual(open(path["loops.json"] + ".1").read(), "mine\n")
            # what a link leads to
            os.symlink("real.py", path["link.py"])
            self.assert_exit(call("export", "four-bar", "-o", path["link.py"]), DONE)
            self.assertEqual(open(path["link.py"] + ".1").read(), "mine\n")
            self.assertTrue(os.path.islink(path["link.py"]))
            # the same once more changes nothing, --force keeps nothing
            before = sorted(os.listdir(folder))
            self.assertEqual(call("export", "four-bar", "-o", path["link.py"]).stderr, b"")
            self.assert_exit(call("export", "four-bar", "--language", "c", "--force", "-o", path["link.py"]), DONE)
            self.assertEqual(sorted(os.listdir(folder)), before)

    def test_plots_of_a_report_keep_what_is_there(self):
        with tempfile.TemporaryDirectory() as folder:
            words = ("report", "fb0", *self.SHORT[2:], "--plots", folder)
            self.assertIn(call(*words).returncode, (DONE, ENDED))
            names = os.listdir(folder)
            self.assertTrue(any(name.endswith(".svg") for name in names), names)
            for name in names:
                with open(os.path.join(folder, name), "w") as f:
                    f.write("mine\n")
            self.assertIn(call(*words).returncode, (DONE, ENDED))
            for name in names:
                self.assertEqual(open(os.path.join(folder, name + ".1")).read(), "mine\n", name)
                self.assertNotEqual(open(os.path.join(folder, name), "rb").read(), b"mine\n", name)

    def test_a_link_that_leads_nowhere_is_called_a_link(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, to in (("round.json", "back.json"), ("back.json", "round.json"), ("lost.json", "nothing.json")):
                os.symlink(to, os.path.join(folder, name))
            for name, why in (("round.json", b"it is a link that leads back to itself"), ("lost.json", b"it is a link to a file that is not there")):
                for word in (name, "./" + name):
                    done = subprocess.run([os.path.abspath(driver.PROGRAM), "inspect", word], cwd=folder, capture_output=True)
                    self.assert_exit(done, INPUT)
                    self.assertIn(why, done.stderr)
            missing = subprocess.run([os.path.abspath(driver.PROGRAM), "inspect", "nothing.json"], cwd=folder, capture_output=True)
            self.assertIn(b"there is no file 'nothing.json'", missing.stderr)

    def test_a_name_cannot_command_the_terminal(self):
        done = call("inspect", "no\x1b[31m\nfile.json")
        self.assert_exit(done, INPUT)
        self.assertIn(b"'no?[31m?file.json'", done.stderr)
        with tempfile.TemporaryDirectory() as folder:
            scene = os.path.join(folder, "\x1b[31mred\x07\nblue.json")
            with open("lessons/01-closed-loops/scenes/four-bar.json") as f:
                document = json.load(f)
            with open(scene, "w") as f:
                json.dump({k: v for k, v in document.items() if k != "title"}, f)
            for words in (("inspect", scene), ("equations", scene), ("terms", scene), ("compare", scene, "--time", "0.05"),
                          ("study", scene, "budget", "--time", "0.05"), ("reference", scene, "--time", "0.05"), ("run", scene, "--time", "0.05", "--plot")):
                done = call(*words)
                self.assert_exit(done, DONE)
                self.assertIsNone(re.search(rb"[\x00-\x08\x0b-\x1f\x7f]|\nblue", done.stdout + done.stderr), words)
            self.assertIn("scene                          ?[31mred??blue\n", call("inspect", scene).stdout.decode())
            # what a student's file is called, and the note about a file that is kept
            handed_in, kept = os.path.join(folder, "\x1b[31mp3\x07.json"), os.path.join(folder, "\x1b[31mkept\x07.svg")
            for path in (handed_in, kept):
                with open(path, "w") as f:
                    json.dump(SUBMISSION, f)
            for words in (("grade", "p3", handed_in, "-o", os.path.join(folder, "verdicts")), ("snapshot", "four-bar", "-o", kept)):
                done = call(*words)
                self.assert_exit(done, DONE)
                self.assertNotRegex(done.stdout + done.stderr, b"[\x07\x1b]")
                self.assertIn(b"?[31m", done.stdout + done.stderr)

    def test_a_folder_in_place_of_a_file_is_told_before_anything_is_computed(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, words in (("d.svg", ("snapshot", "four-bar", "--method", "index1@rk4:h=1e-6", "--time", "3600")),
                                ("d.json", ("reference", "fb0")), ("d.c", ("export", "four-bar", "--language", "c"))):
                path = os.path.join(folder, name)
                os.mkdir(path)
                done = call(*words, "-o", path)
                self.assert_exit(done, INPUT)
                self.assertIn(b"it is a folder", done.stderr)
                self.assertEqual(os.listdir(path), [])

    def test_a_picture_that_cannot_be_written_leaves_the_old_file_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "x.svg")
            with open(path, "w") as f:
                f.write("somebody's work")

            def no_room():
                signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
                resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))

            done = subprocess.run([driver.PROGRAM, "snapshot", "four-bar", "--no-native", "-o", path], capture_output=True, preexec_fn=no_room,
                                  restore_signals=False, timeout=120 * driver.SLOW)
            self.assert_exit(done, PROGRAM)
            self.assertIn(b"cannot write", done.stderr)
            self.assertNotIn(b"is kept", done.stderr)
            self.assertEqual(os.listdir(folder), ["x.svg"])
            self.assertEqual(open(path).read(), "somebody's work")
            # with room it is kept
            done = call("snapshot", "four-bar", "-o", path)
            self.assert_exit(done, DONE)
            self.assertIn(b"are kept in", done.stderr)
            self.assertEqual(open(path + ".1").read(), "somebody's work")

    @unittest.skipUnless(os.path.exists("/dev/full"), "no /dev/full here")
    def test_an_output_that_cannot_be_written_is_no_fault_of_the_input(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "s.json")
            with open(path, "w") as f:
                json.dump(SUBMISSION, f)
            self.assert_exit(call("export", "four-bar", "--language", "c", "-o", "/dev/full"), PROGRAM)
            # a file where a folder should be is the fault of the name
            self.assertIn(b"the folder '/dev/full' is no folder", call("grade", "p3", path, "-o", "/dev/full/v").stderr)
            self.assert_exit(call("grade", "p3", path, "-o", "/dev/full/v"), INPUT)
            # a folder that is not there is, and is told before anything is computed: this picture takes an hour
            for words in (("reference", "fb0", "--out", "/nowhere/x.json"),
                          ("snapshot", "four-bar", "--method", "index1@rk4:h=1e-6", "--time", "3600", "-o", "/no/such/folder/a.png"),
                          ("export", "four-bar", "--language", "c", "-o", path + "/a.c"), ("problem", "p3", "-o", "/nowhere/a.svg"),
                          ("import", "tests/import/four-bar.urdf", "-o", "/nowhere/a.json"), ("program", "python", "-o", "/nowhere/a.py")):
                done = call(*words)
                self.assert_exit(done, INPUT)
                self.assertRegex(done.stderr, b"no such folder|Not a directory")
            # rows that are printed as they are made, and a document
            for words in ((), ("--json",)):
                with open("/dev/full", "w") as full:
                    done = subprocess.run([driver.PROGRAM, "run", "four-bar", "--time", "2", "--every", "0.001", *words], stdout=full,
                                          stderr=subprocess.PIPE, timeout=600)
                self.assertEqual((done.returncode, b"cannot write to standard output: No space left" in done.stderr, b"memory" in done.stderr), (PROGRAM, True, False))

    def test_what_somebody_wrote_is_kept_beside_an_export(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, words in (("own.py", ("export", "four-bar", "--language", "python")), ("own.xml", ("export", "four-bar", "--format", "mjcf")),
                                ("own.json", ("import", "tests/import/four-bar.urdf"))):
                path = os.path.join(folder, name)
                with open(path, "w") as f:
                    f.write("mine\n")
                done = call(*words, "-o", path)
                self.assert_exit(done, DONE)
                self.assertIn(b"are kept in", done.stderr)
                self.assertEqual(open(path + ".1").read(), "mine\n")
                # the same once more changes nothing
                self.assertNotIn(b"kept", call(*words, "-o", path).stderr)
                self.assertFalse(os.path.exists(path + ".2"))
            path = os.path.join(folder, "forced.py")
            with open(path, "w") as f:
                f.write("mine\n")
            self.assert_exit(call("export", "four-bar", "--language", "python", "-o", path, "--force"), DONE)
            self.assertFalse(os.path.exists(path + ".1"))

    def test_a_setting_that_an_exercise_does_not_have_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "s.json")
            with open(path, "w") as f:
                json.dump(SUBMISSION, f)
            done = call("grade", "p3", path, "--set", "l3=1")
            self.assert_exit(done, INPUT)
            self.assertIn(b"--set is for the program of a scene", done.stderr)

    def test_a_picture_goes_to_a_pipe_that_somebody_reads(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "pipe.png")
            os.mkfifo(path)
            refused = call("snapshot", "four-bar", "-o", path)
            self.assertEqual((refused.returncode, refused.stdout), (PROGRAM, b""))
            self.assertIn(b"it is a pipe that no program reads", refused.stderr)
            with subprocess.Popen(["cat", path], stdout=subprocess.PIPE) as reader:
                # until it has opened the pipe, nobody reads
                self.assertTrue(driver.until(lambda: call("snapshot", "four-bar", "-o", path).returncode == DONE))
                self.assertTrue(reader.communicate()[0].startswith(b"\x89PNG"))

    def test_a_submission_that_is_a_pipe_does_not_hang(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "pipe.json")
            os.mkfifo(path)
            self.assertIn("not a regular file", self.assert_exit(call("grade", "p3", path), INPUT))


if __name__ == "__main__":
    driver.main()
