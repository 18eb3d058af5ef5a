# SPDX-License-Identifier: GPL-3.0-or-later
"""A class is graded: as platforms export it, in any order, through kills, and nobody's submission stops the batch."""

import csv
import fcntl
import io
import json
import os
import random
import re
import resource
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import time
import unittest
import zipfile

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402

PROGRAM = os.path.abspath(driver.PROGRAM)
F_SETPIPE_SZ = 1031  # of Linux; fcntl has a name for it from Python 3.10 on
with open(os.path.join(os.path.dirname(__file__), "..", "..", "lessons", "01-closed-loops", "answers", "p3.json"), encoding="utf-8") as answer_file:
    RIGHT = answer_file.read()
WRONG_SIGN = RIGHT.replace('"-l1*sin(th1)"', '"l1*sin(th1)"')
SPACED = WRONG_SIGN.replace("*", " * ")


def call(*words):
    return subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=300 * driver.SLOW)


def zipped(files):
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as z:
        for name, text in files.items():
            z.writestr(name, text)
    return out.getvalue()


class Class(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = os.path.join(self.temporary.name, "handed in")
        self.out = os.path.join(self.temporary.name, "scores.ndjson")

    def put(self, path, content):
        whole = os.path.join(self.folder, path)
        os.makedirs(os.path.dirname(whole), exist_ok=True)
        with open(whole, "wb") as f:
            f.write(content if isinstance(content, bytes) else content.encode())

    def grade(self, *words):
        done = call("grade", "p3", self.folder, *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def lines(self, *words):
        self.grade("--out", self.out, *words)
        with open(self.out, encoding="utf-8") as f:
            return [json.loads(line) for line in f]

    def test_every_platforms_folder_is_understood(self):
        self.put("Ada Lovelace_4711_assignsubmission_file_/answer.json", RIGHT)  # Moodle
        self.put("Alan Turing_4712_assignsubmission_file_answer.json", RIGHT)  # Moodle, flat
        self.put("hopper_LATE_4713_99_answer.json", RIGHT)  # Canvas
        self.put("noether_4714_99_answer.zip", zipped({"answer.json": RIGHT}))  # Canvas, zip
        self.put("submission_4715/answer.json", RIGHT)  # Gradescope
        self.put("submission_4715/metadata.yml", "x: 1\n")
        self.put("exercise-euler/part-1/answer.json", RIGHT)  # GitHub Classroom
        self.put("exercise-euler/.git/config.json", "{}")
        self.put("gauss.json", RIGHT)
        self.put("lagrange/all.zip", zipped({"my work/answer.json": RIGHT, "__MACOSX/x.json": "{}", "readme": "hello"}))
        lines = self.lines()
        self.assertEqual([(line["student"], line["status"], line["score"]) for line in lines],
                         [(name, "graded", 8) for name in sorted(("Ada Lovelace", "Alan Turing", "hopper", "noether", "submission_4715", "exercise-euler", "gauss", "lagrange"))])

    def test_an_export_of_gradescope_names_its_students_by_their_mail_address(self):
        """As its autograder does, so that both grade the same variant."""
        entries = ("submission_1:\n  :submitters:\n  - :name: Ada Lovelace\n    :sid: '1815'\n    :email: ada@example.org\n  :score: 3.0\n"
                   "  :results:\n    tests:\n    - output: |\n        :email: nobody@example.org\n"
                   "submission_2:\r\n  :submitters:\r\n  - :name: Alan Turing\r\n    :email: 'alan@example.org'\r\n  - :name: Grace\n    :email: grace@example.org\n"
                   "submission_3:\n  :submitters:\n  - :name: \"Emmy Noether\"\n    :sid: ''\n")
        self.put("submission_metadata.yml", "---\n" + entries)
        for n in range(1, 5):
            self.put(f"submission_{n}/answer.json", RIGHT)
        lines = self.lines()
        self.assertEqual([(line["student"], line["file"].split("/")[-2]) for line in lines],
                         [("Emmy Noether", "submission_3"), ("ada@example.org", "submission_1"), ("alan@example.org", "submission_2"), ("submission_4", "submission_4")])
        # the variant is that of the address: a file that says another student is not graded
        self.put("submission_1/answer.json", RIGHT.replace("{", '{"student": "ada@example.org", ', 1))
        self.put("submission_2/answer.json", RIGHT.replace("{", '{"student": "submission_2", ', 1))
        self.assertEqual([line["status"] for line in self.lines()], ["graded", "graded", "ungradable", "graded"])

    def test_what_cannot_be_graded_says_why_and_stops_nobody(self):
        bad = {"empty": "", "words": "I do not know", "nothing": "{}", "numbers": '{"J": [[NaN]]}', "deep": "[" * 100000, "binary": bytes(range(256)) * 40}
        for name, content in bad.items():
            self.put(f"{name}.json", content)
        self.put("two/a.json", RIGHT)
        self.put("two/b.json", RIGHT)
        self.put("none/readme.txt", "later")
        self.put("named/answer.json.txt", RIGHT)
        self.put("named/notes.txt", "x")
        self.put("large.json", '{"J": "' + "x" * (2 << 20) + '"}')
        self.put("broken.zip", b"PK\3\4 and no more")
        self.put("cut.zip", zipped({"answer.json": RIGHT})[:-40])
        self.put("bomb.zip", zipped({"answer.json": "0" * (64 << 20)}))
        os.makedirs(os.path.join(self.folder, "link"))
        os.symlink("/etc/passwd", os.path.join(self.folder, "link", "answer.json"))
        self.put("good.json", RIGHT)
        lines = {line["student"]: line for line in self.lines("--jobs", "2")}
        self.assertEqual({name: line["status"] for name, line in lines.items() if line["status"] != "ungradable"}, {"good": "graded"})
        self.assertEqual(len(lines), 15)
        for name, said in (("two", "2 JSON files"), ("none", "no JSON file was handed in, only 'readme.txt'"), ("named", "only 'answer.json.txt' and 1 other file"), ("bomb", "larger than"), ("link", "no JSON file"), ("broken", "zip"), ("cut", "zip")):
            self.assertIn(said, lines[name]["reason"])
        for line in lines.values():
            self.assertTrue(line.get("reason") or line.get("summary"), line)

    def test_the_summary_has_histogram_mistakes_and_equal_wrong_answers(self):
        for k in range(6):
            self.put(f"right{k}.json", RIGHT)
        self.put("copy1.json", WRONG_SIGN)
        self.put("copy2.json", SPACED)
        self.put("own.json", RIGHT.replace('"l3*sin(th3)"', '"l3*cos(th3)"'))
        text = self.grade().stdout
        self.assertIn("9 submissions: 9 graded, 0 not gradable, 0 failed in the grader", text)
        self.assertRegex(text, r"(?m)^ +all +6  #+$")
        self.assertRegex(text, r"commonest mistakes\n +2  \S+ in J11\n")
        self.assertIn("copy1, copy2", text)
        self.assertNotRegex(text.split("equal wrong")[1], "right|own")

    def test_fields_that_are_no_answers_hide_no_copy(self):
        answers = json.loads(WRONG_SIGN)
        more = {"plain": {}, "named": {"student": "named"}, "hinted": {"hints": 0}, "told": {"comment": "by myself", "problem": "p3"}}
        for name, fields in more.items():
            self.put(f"{name}.json", json.dumps(dict(fields, **answers)))
        self.put("own.json", RIGHT.replace('"l3*sin(th3)"', '"l3*cos(th3)"'))
        text = self.grade().stdout
        self.assertIn("hinted, named, plain, told", text.split("equal wrong")[1], text)

    def test_a_row_says_why_no_answer_can_be_read(self):
        self.put("ann.json", '{"a": 1, "a": 2}')
        line = json.loads(call("grade", "closure", self.folder, "--json").stdout)
        self.assertEqual((line["status"], line["reason"]), ("ungradable", "no answer can be read (a); 'a' is there more than once, with different values: keep one"))

    def test_order_and_jobs_change_nothing_and_csv_holds_the_same(self):
        chance = random.Random(3)
        for k in chance.sample(range(60), 60):
            self.put(f"student{k:02d}.json", chance.choice((RIGHT, WRONG_SIGN, "{}", "nonsense")))
        one = self.lines("--jobs", "1")
        os.remove(self.out)
        self.assertEqual(self.lines("--jobs", "7"), one)
        table = os.path.join(self.temporary.name, "scores.csv")
        self.grade("--out", table)
        with open(table, encoding="utf-8", newline="") as f:
            rows = list(csv.DictReader(f))
        self.assertEqual([(r["student"], r["status"], float(r["score"])) for r in rows], [(line["student"], line["status"], line["score"]) for line in one])
        self.assertEqual([r["mistakes"] for r in rows], ["; ".join(line.get("mistakes", [])) for line in one])
        self.assertTrue(any(r["mistakes"].startswith("sign in J") for r in rows))

    def test_killed_ten_times_none_is_lost_and_none_is_graded_twice(self):
        chance = random.Random(5)
        for k in range(1000):
            self.put(f"student{k:03d}.json", chance.choice((RIGHT, WRONG_SIGN, SPACED, "{}")).replace("}", f', "n": {k}}}' if k % 7 == 0 else "}"))
        calm = self.lines()
        with open(self.out, "rb") as f:
            calm_bytes = f.read()
        os.remove(self.out)
        # its lines go into a pipe of one page that nobody reads: full, it holds the run in the middle, however fast the machine is
        for _ in range(10):
            process = subprocess.Popen([PROGRAM, "grade", "p3", self.folder, "--jobs", "2", "--out", self.out], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
            page = fcntl.fcntl(process.stdout, F_SETPIPE_SZ, 4096)
            deadline, waiting = time.monotonic() + 60 * driver.SLOW, 0
            while process.poll() is None and waiting < page - 500 and time.monotonic() < deadline:
                waiting = struct.unpack("i", fcntl.ioctl(process.stdout, termios.FIONREAD, b"0000"))[0]
                time.sleep(0.001)
            self.assertIsNone(process.poll(), "it ended before it could be killed")
            process.send_signal(signal.SIGKILL)
            process.wait()
            process.stdout.close()
        done = self.grade("--out", self.out)
        self.assertIn("were graded before", done.stderr)
        with open(self.out, "rb") as f:
            self.assertEqual(f.read(), calm_bytes)
        self.assertFalse(os.path.exists(self.out + ".part"), "nothing is left of a finished run")
        students = [json.loads(line)["student"] for line in calm_bytes.splitlines()]
        self.assertEqual(sorted(students), sorted(line["student"] for line in calm))
        # a submission that is changed is graded anew, the others are not
        self.put("student000.json", "{}")
        done = self.grade("--out", self.out)
        self.assertIn("999 of 1000 submissions were graded before", done.stderr)

    def test_a_finished_run_leaves_its_scores_alone_and_a_mark_changed_by_hand_is_graded_again(self):
        for name in ("ann", "bob", "cid"):
            self.put(f"{name}.json", RIGHT)
        table = os.path.join(self.temporary.name, "scores.csv")
        self.grade("--out", table)
        calm = self.lines()
        self.assertEqual(sorted(os.listdir(self.temporary.name)), ["handed in", "scores.csv", "scores.ndjson"])
        with open(self.out, encoding="utf-8") as f:
            text = f.read()
        with open(self.out, "w", encoding="utf-8") as f:
            f.write(text.replace('"score":8', '"score":7', 1))
        done = self.grade("--out", self.out)
        self.assertIn("2 of 3 submissions were graded before", done.stderr)
        with open(self.out, encoding="utf-8") as f:
            self.assertEqual([json.loads(line) for line in f], calm)

    def test_a_class_that_transposes_a_matrix_has_a_commonest_mistake(self):
        rows = json.loads(RIGHT)["J"]
        turned = [list(column) for column in zip(*rows)]
        self.put("ann.json", json.dumps({"J": turned}))
        turned[0][0] = "l1*sin(th1)"
        self.put("bob.json", json.dumps({"J": turned}))
        table = os.path.join(self.temporary.name, "scores.csv")
        self.assertRegex(self.grade("--out", table).stdout, r"commonest mistakes\n +2  transposed in J\n")
        with open(table, encoding="utf-8", newline="") as f:
            self.assertEqual([row["mistakes"] for row in csv.DictReader(f)], ["transposed in J", "sign in J11; transposed in J"])
        alone = call("grade", "p3", os.path.join(self.folder, "ann.json"), "--format", "csv").stdout
        self.assertIn("J11: transposed; J12: transposed", alone)

    def test_every_entry_of_the_folder_has_a_row(self):
        self.put("ada.json", RIGHT)
        self.put("sam.txt", "see my mail")
        self.put("tom.docx", b"PK")
        self.put("Dr. Who_4711_assignsubmission_file_/answer.json", RIGHT)
        for junk in (".DS_Store", "Thumbs.db", "desktop.ini", "submission_metadata.yml", "__MACOSX/x.json"):
            self.put(junk, "{}")
        os.symlink("/nowhere/will.json", os.path.join(self.folder, "will.json"))
        os.mkfifo(os.path.join(self.folder, "pipe.json"))
        lines = {line["student"]: line for line in self.lines()}
        self.assertEqual(sorted(lines), ["Dr. Who", "ada", "pipe", "sam", "tom", "will"])
        for name, said in (("sam", "'sam.txt' is no .json file"), ("tom", "'tom.docx' is no .json file"), ("will", "'will.json' is a link"), ("pipe", "'pipe.json' is no .json file")):
            self.assertEqual(lines[name]["status"], "ungradable")
            self.assertIn(said, lines[name]["reason"])
        self.assertIn("6 submissions: 2 graded, 4 not gradable", self.grade().stdout)

    def test_the_mean_names_its_number_and_a_name_with_two_files_is_remarked(self):
        for name in ("ida.json", "ada.json"):
            self.put(name, RIGHT)
        self.put("ida.zip", zipped({"answer.json": WRONG_SIGN}))
        self.put("sam.txt", "later")
        table = os.path.join(self.temporary.name, "scores.csv")
        text = self.grade("--out", table).stdout
        self.assertRegex(text, r"(?m)^mean of the 3 graded: \d\.\d\d of 8$")
        self.assertRegex(text, r"(?m)^more than one submission of a name: keep one\n  ida: \S.*ida\.json, \S.*ida\.zip:answer\.json$")
        self.assertEqual(text.count("2 submissions have this name"), 2)
        with open(table, encoding="utf-8", newline="") as f:
            rows = list(csv.DictReader(f))
        self.assertEqual([(r["student"], r["max_score"], r["remark"]) for r in rows],
                         [("ada", "8", ""), *[("ida", "8", "2 submissions have this name; keep one")] * 2, ("sam", "8", "")])
        # the second file goes: the row of the first loses its remark
        os.remove(os.path.join(self.folder, "ida.zip"))
        self.assertNotIn("more than one submission", self.grade("--out", table).stdout)
        with open(table, encoding="utf-8", newline="") as f:
            self.assertEqual({r["remark"] for r in csv.DictReader(f)}, {""})

    def test_the_name_chooses_the_variant_and_another_one_is_reported(self):
        answer = {"a": {"matrix": [["M", "J'"], ["J", "0"]], "right": ["S'*tau - h", "-gamma"], "unknowns": ["a", "-lambda"]}}
        own = json.loads(call("problem", "p1", "--student", "own", "--json").stdout)["seed"]
        for name, said in (("own", {"seed": int(own)}), ("named", {"student": "named"}), ("silent", {}), ("other", {"seed": 7}), ("borrowed", {"student": "own"})):
            self.put(f"{name}.json", json.dumps(dict(said, **answer)))
        done = call("grade", "p1", self.folder, "--json")
        lines = {line["student"]: line for line in map(json.loads, done.stdout.splitlines())}
        self.assertEqual({name: line["status"] for name, line in lines.items()},
                         {"own": "graded", "named": "graded", "silent": "graded", "other": "ungradable", "borrowed": "ungradable"})
        self.assertIn("answers the variant of seed 7, this is", lines["other"]["reason"])
        self.assertIn("answers the variant of student 'own', this is", lines["borrowed"]["reason"])
        said = " ".join(call("help", "grade").stdout.split())
        self.assertIn("whose name chooses the variant unless --seed does", said)

    def test_a_name_chooses_one_variant_in_all_its_spellings(self):
        def seed(name):
            return json.loads(call("problem", "gears", "--student", name, "--json").stdout)["seed"]

        self.assertEqual(seed("José Núñez"), seed("Jose\u0301 Nu\u0301n\u0303ez"))
        self.assertEqual(seed("ada"), seed(" ada "))
        self.assertNotEqual(seed("ada"), seed("Ada"))
        self.put("Jose\u0301.json", json.dumps({"student": "José"}))
        lines = [json.loads(line) for line in call("grade", "gears", self.folder, "--json").stdout.splitlines()]
        self.assertEqual([line["student"] for line in lines], ["José"])
        self.assertNotIn("answers the variant of", lines[0]["reason"])

    def test_a_file_with_the_name_of_another_student_is_not_graded(self):
        self.put("ben.json", RIGHT.replace("{", '{"student": "ben",', 1))
        self.put("eve.json", RIGHT.replace("{", '{"student": "ben",', 1))
        lines = {line["student"]: line for line in self.lines()}
        self.assertEqual({name: line["status"] for name, line in lines.items()}, {"ben": "graded", "eve": "ungradable"})
        self.assertIn("by student 'ben', and it was handed in by 'eve'", lines["eve"]["reason"])
        eve = os.path.join(self.folder, "eve.json")
        for student, status in (("eve", 2), ("ben", 0), (" ben", 0)):
            self.assertEqual(call("grade", "p3", eve, "--student", student).returncode, status, student)
        # names of folders that are no students': one variant for all, and no name is compared
        self.assertEqual(call("grade", "p3", eve).returncode, 0)
        done = call("grade", "p3", self.folder, "--seed", "7", "--json")
        self.assertEqual([json.loads(line)["status"] for line in done.stdout.splitlines()], ["graded"] * 2)

    def test_whose_variant_it_is_is_said_by_name(self):
        self.put("bob.json", '{"student": "Bob", "a": 1}')
        done = call("grade", "gears", os.path.join(self.folder, "bob.json"), "--student", "Ada Lovelace")
        self.assertEqual(done.returncode, 2)
        self.assertRegex(" ".join(done.stdout.split()), r"the variant of student 'Bob', this is that of student 'Ada Lovelace' \(seed \d+\)")

    def test_near_copies_are_listed_when_only_their_names_differ(self):
        wrong = '{"J": [["-a*cos(x)", "b*y"], ["a*sin(x)", "0"]], "n": 3}'.replace('"n": 3', '"note": "a b"')
        shape = json.dumps({"problem": "p3", "J": [["l1*cos(th1)", "l2*sin(th2)", "l3*sin(th3)", "l4*sin(th4)"], ["l1", "l2", "l3", "l4"]]})
        self.put("ann.json", shape)
        self.put("bob.json", shape.replace("l1", "l9").replace("l2", "l1").replace("l9", "l2"))
        self.put("cid.json", shape.replace("cos", "sin"))
        self.put("dan.json", wrong)
        text = self.grade().stdout
        self.assertRegex(text, r"(?m)^near-copies: the same but for the names\n  ann, bob$")
        self.assertNotIn("cid", text.split("near-copies")[1].split("equal wrong parts")[0])

    def copies(self, exercise, **answers):
        """The groups of equal wrong parts in a class in which everybody has a variant of his own."""
        for name, answer in answers.items():
            self.put(f"{name}.json", json.dumps(answer))
        text = call("grade", exercise, self.folder).stdout
        return re.findall(r"(?m)^  (.*)$", text.partition("another has another answer)\n")[2])

    def test_equal_wrong_parts_are_listed_among_variants(self):
        asked = {name: json.loads(call("problem", "fourbar", "--student", name, "--json").stdout) for name in ("ann", "bob", "cid", "dan")}
        own = {name: {"m2": float(re.search(r"m2 = ([0-9.]+) kg", text).group(1)), "l1": float(re.search(r"l1 = ([0-9.]+) m;", text).group(1))}
               for name, text in ((name, json.dumps(e)) for name, e in asked.items())}
        self.assertNotIn(own["bob"]["l1"], [own[name]["l1"] for name in ("ann", "cid", "dan")])

        # a mistake that nobody expects: spelled otherwise, with the own number; and one that has the same name but is another
        groups = self.copies("fourbar", ann={"b": "m2*l1*l2*cos(th1-th2)/7", "c": "th1"}, bob={"b": f"cos(th2-th1) {own['bob']['l1']} l2 m2 / 7", "c": "th2"},
                             cid={"b": f"m2*{own['cid']['l1']}*l2*cos(th1-th2)/8"}, dan={"b": f"m2*{own['bob']['l1']}*l2*cos(th1-th2)/7"})
        self.assertEqual(groups, ["b: ann, bob (wrong-factor)"])

        # a known mistake: the same text, or else it is only a frequent mistake
        groups = self.copies("fourbar", ann={"b": "m2*l1*l2*cos(th1+th2)/2"}, bob={"b": f"{own['bob']['m2']} * L1*l2*cos(th1+th2)/2".lower()},
                             cid={"b": "0.5*m2*l1*l2*cos(th1+th2)"}, dan={"b": "m2*l1*l2*cos(th1-th2)/2"})
        self.assertEqual(groups, ["b: ann, bob (sum-of-angles)"])

        # numbers alone say nothing among variants
        self.assertEqual(self.copies("fourbar", ann={"a": 1.2345}, bob={"a": 1.2345}, cid={}, dan={}), [])

    def test_equal_wrong_entries_of_a_matrix_are_listed(self):
        def answer(first, second):
            return {"J": [[first, "l2*th2", "sin(th3)", "l4*sin(th4)"], ["l1*cos(th1)", second, "-l3*cos(th3)", "-l4*cos(th4)"]]}

        groups = self.copies("p3", ann=answer("l1*th1", "th1^2"), bob=answer("th1*l1", "th2^2"), cid=answer("l1", "th2^3"))
        self.assertEqual(groups, ["J12: ann, bob, cid (other)", "J11: ann, bob (other)"])

    def test_scores_of_before_are_kept(self):
        out = os.path.join(self.temporary.name, "scores.csv")
        self.put("ann.json", RIGHT)
        self.assertNotIn("the old contents", self.grade("--out", out).stderr)
        self.assertNotIn("the old contents", self.grade("--out", out).stderr)  # the same scores once more
        for n in (1, 2):
            with open(out, "a", encoding="utf-8") as f:
                f.write(f"changed by hand, {n}\n")
            self.assertIn(f"the old contents of '{out}' are kept in '{out}.{n}'", self.grade("--out", out).stderr)
            with open(f"{out}.{n}", encoding="utf-8") as f:
                self.assertIn(f"changed by hand, {n}", f.read())
        with open(out, encoding="utf-8") as f:
            self.assertNotIn("changed", f.read())

    def test_parts_put_together_are_the_whole(self):
        for k in range(11):
            self.put(f"student{k:02d}.json", RIGHT if k % 3 else WRONG_SIGN)
        whole = self.lines()
        parts = [os.path.join(self.temporary.name, f"part{i}.ndjson") for i in (1, 2, 3, 4)]
        for i, part in enumerate(parts, 1):
            done = self.grade("--shard", f"{i}/4", "--out", part)
            self.assertIn(f"{3 if i < 4 else 2} submissions:", done.stdout)
        merged = os.path.join(self.temporary.name, "merged.ndjson")
        done = call("grade", "p3", "--merge", *parts, "--out", merged)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("11 submissions: 11 graded", done.stdout)
        with open(merged, "rb") as a, open(self.out, "rb") as b:
            self.assertEqual(a.read(), b.read())
        self.assertEqual(len(whole), 11)

    def test_parts_of_another_exercise_rubric_or_seed_are_refused(self):
        for k in range(4):
            self.put(f"student{k}.json", '{"a": "1"}')
        rubric = os.path.join(self.temporary.name, "rubric.json")
        self.assertEqual(call("rubric", "write", "gears", "--out", rubric).returncode, 0)
        with open(rubric, encoding="utf-8") as f:
            dearer = re.sub(r'"total": [0-9.]+,', "", f.read()).replace('"a": ', '"a": 1', 1)
        with open(rubric, "w", encoding="utf-8") as f:
            f.write(dearer)

        def part(name, i, exercise, *words):
            out = os.path.join(self.temporary.name, name + ".ndjson")
            done = call("grade", exercise, self.folder, "--shard", f"{i}/2", "--out", out, *words)
            self.assertEqual(done.returncode, 0, done.stderr)
            return out

        def merged(exercise, *parts):
            return call("grade", exercise, "--merge", *parts, "--out", os.path.join(self.temporary.name, "all.csv"))

        first, second = part("first", 1, "gears"), part("second", 2, "gears")
        dear = [part(f"dear{i}", i, "gears", "--rubric", rubric) for i in (1, 2)]
        self.assertEqual(merged("gears", first, second).returncode, 0)
        self.assertEqual(merged("gears", *dear).returncode, 0)
        # the journal of a part is none of the whole class
        whole = os.path.join(self.temporary.name, "first.ndjson")
        self.assertEqual(call("grade", "gears", self.folder, "--out", whole).returncode, 0)
        with open(whole, encoding="utf-8") as f:
            self.assertNotIn('"place"', f.read())
        self.assertEqual(merged("gears", whole, second).returncode, 2)
        first = part("first", 1, "gears")
        for exercise, parts, said in (
            ("p3", [first, second], "is a part of exercise 'gears', not of 'p3'"),
            ("gears", [first, part("other", 2, "p1")], "is a part of exercise 'p1', not of 'gears'"),
            ("gears", [first, dear[1]], "was graded with another rubric, another --seed or another version of exercise 'gears' than"),
            ("gears", [first, part("seeded", 2, "gears", "--seed", "7")], "was graded with another rubric, another --seed"),
        ):
            done = merged(exercise, *parts)
            self.assertEqual(done.returncode, 2, done.stdout)
            self.assertIn(said, " ".join(done.stderr.split()))

    def test_a_disk_that_is_full_is_called_that_and_the_run_goes_on_later(self):
        for k in range(40):
            self.put(f"student{k:02d}.json", RIGHT)

        def small_files():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # a write beyond the limit fails, as on a full disk
            resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))

        words = [driver.PROGRAM, "grade", "p3", self.folder, "--jobs", "2", "--out", self.out]
        done = subprocess.run(words, capture_output=True, text=True, timeout=120 * driver.SLOW, preexec_fn=small_files)
        self.assertEqual(done.returncode, 3)
        self.assertRegex(done.stderr, r"holonom: '.*\.part' cannot be written: File too large\n +make room")
        self.assertFalse(os.path.exists(self.out))
        done = subprocess.run(words, capture_output=True, text=True, timeout=120 * driver.SLOW)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stderr, r"holonom: \d+ of 40 submissions were graded before")
        with open(self.out, encoding="utf-8") as f:
            self.assertEqual(len(set(json.loads(line)["student"] for line in f)), 40)

    def test_lines_that_standard_output_does_not_take_are_no_result(self):
        self.put("ann.json", RIGHT)
        with open("/dev/full", "w", encoding="ascii") as full:
            done = subprocess.run([driver.PROGRAM, "grade", "p3", self.folder], stdout=full, stderr=subprocess.PIPE, text=True, timeout=120 * driver.SLOW)
        self.assertEqual(done.returncode, 3)
        self.assertIn("standard output takes no more", done.stderr)

    def test_a_folder_that_is_none_is_refused(self):
        for folder, said in (("/nowhere", "cannot be graded"), (self.temporary.name + "/empty", "there is nobody")):
            os.makedirs(self.temporary.name + "/empty", exist_ok=True)
            done = call("grade", "p3", folder)
            self.assertEqual(done.returncode, 2)
            self.assertIn(said, done.stdout + done.stderr)
        self.assertEqual(call("grade", "no-such", self.temporary.name).returncode, 3)


if __name__ == "__main__":
    driver.main()
