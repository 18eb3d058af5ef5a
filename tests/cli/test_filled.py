# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs with blanks: filled in rightly they get all points in every language, mistakes are named, and a class of them is graded."""

import concurrent.futures
import csv
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402
import honest_programs  # noqa: E402
from test_programs import NEEDS, TROUBLE, has_numpy  # noqa: E402

PROGRAM = os.path.abspath(driver.PROGRAM)
ENDINGS = {"python": ("py", "    return mass"), "c": ("c", "}"), "cpp": ("cpp", "}"), "java": ("java", "        }"), "octave": ("m", "end")}
NEAR = "the same but for names, comments and the order of statements"
POINTS = 8  # of a scene with constraints: four parts


def call(*words):
    return subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=300 * driver.SLOW)


def blank_and_filled(scene, language, *settings):
    """The program with blanks, and the same with the statements of the whole program in their place."""
    blank, whole = (call("export", scene, "--language", language, *settings, *more).stdout.splitlines() for more in (["--blanks"], []))
    end = ENDINGS[language][1]
    begins = next(i for i, line in enumerate(blank) if "YOUR PART 1" in line)
    after = next(i for i in range(begins, len(blank)) if blank[i].startswith(end))
    start = next(i for i, line in enumerate(whole) if line == blank[begins - 1])
    # an anchor that stands there twice would cut the wrong piece out
    assert whole.count(blank[begins - 1]) == 1, blank[begins - 1]
    stop = next(i for i in range(start, len(whole)) if whole[i].startswith(end))
    return "\n".join(blank) + "\n", "\n".join(blank[:begins] + whole[start + 1 : stop] + blank[after:]) + "\n"


@unittest.skipIf(TROUBLE, TROUBLE)
class Filled(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)

    def put(self, name, text):
        path = os.path.join(self.temporary.name, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as f:
            f.write(text)
        return path

    @staticmethod
    def two_at_a_time(function, jobs):
        """What the function gives for each job, in their order."""
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            return list(zip(jobs, pool.map(lambda job: function(*job), jobs)))

    def grade(self, scene, path):
        done = call("grade", scene, path, "--json")
        return done.returncode, json.loads(done.stdout)

    def test_a_right_program_gets_all_points_in_every_language_and_a_blank_one_none(self):
        jobs = []
        for language, (ending, _) in ENDINGS.items():
            if not shutil.which(NEEDS[language]) or (language == "python" and not has_numpy()):
                print(f"# {language} is not here")
                continue
            scenes = ("four-bar", "heavy-top", "driven-crank") if language in ("python", "c") else ("four-bar",)
            for scene in scenes:
                blank, filled = blank_and_filled(scene, language)
                jobs += [(scene, self.put(f"{scene}.{ending}", filled)), (scene, self.put(f"{scene}-blank.{ending}", blank))]
        for (scene, path), (status, verdict) in self.two_at_a_time(self.grade, jobs):
            if "-blank." in path:
                self.assertEqual((status, verdict["score"], {e["mistake"] for e in verdict["entries"]}), (0, 0, {"empty"}), path)
            else:
                self.assertEqual((status, verdict["score"]), (0, verdict["max_score"]), (path, verdict))
                self.assertGreaterEqual(verdict["max_score"], 4)
        self.assertGreaterEqual(len(jobs), 6)

    def test_the_blanks_do_not_hold_the_answer(self):
        blank, filled = blank_and_filled("four-bar", "c")
        self.assertIn("mass[0][0] =", filled)
        for part in ("mass[", "force[", "jacobian[", "bias["):
            statements = [line for line in blank.splitlines() if line.strip().startswith(part)]
            self.assertEqual(statements, [])
        # and it compiles as it is
        path = self.put("blank.c", blank)
        done = subprocess.run(["gcc", "-std=c99", "-Wall", "-Wextra", "-Wno-unused-variable", "-Werror", "-o", path + ".x", path, "-lm"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_whole_program_is_no_program_with_blanks(self):
        path = self.put("whole.c", call("export", "four-bar", "--language", "c").stdout)
        status, verdict = self.grade("four-bar", path)
        self.assertEqual((status, verdict["status"]), (2, "ungradable"), verdict)
        self.assertIn("'export SCENE --blanks'", verdict["hint"])

    def test_mistakes_are_named(self):
        _, filled = blank_and_filled("four-bar", "c")
        last = filled.rindex("    energy[0] =")
        # after every statement of the right answer, one that spoils a part
        cases = {"sign": ("jacobian", "for (int i = 0; i < NC * NV; i++) jacobian[i / NV][i % NV] *= -1;"),
                 "factor": ("mass", "for (int i = 0; i < NV * NV; i++) mass[i / NV][i % NV] *= 0.5;"),
                 "transposed": ("jacobian", "{ double t[NV * NC]; for (int i = 0; i < NC * NV; i++) t[i % NV * NC + i / NV] = jacobian[i / NV][i % NV]; memcpy(jacobian, t, sizeof t); }"),
                 "symmetry": ("mass", "mass[0][1] = 0;"),
                 "empty": ("bias", "bias[0] = bias[1] = 0;"),
                 "velocity": ("force", "{ double still[NV] = {-0.5*g*l1*(m1 + 2*m2)*cos(th1), -0.5*g*l2*m2*cos(theta_coupler), -0.5*g*l3*m3*cos(th3)}; "
                                       "memcpy(force, still, sizeof still); }"),
                 "number": ("force", "force[0] = sqrt(-1.0);"),
                 "other": ("force", "force[2] += 0.001;"),
                 "sign-term": ("force", "force[0] += m2*l1*l2*omega_coupler*omega_coupler*sin(th1 - theta_coupler);"),
                 "missing-term": ("force", "force[1] += 0.5*g*l2*m2*cos(theta_coupler);"),
                 "factor-term": ("force", "force[1] -= 0.5*g*l2*m2*cos(theta_coupler);")}  # fmt: skip
        # what is left of the two points of the part: each of its entries counts alike (mass 5, force 3, jacobian 6, bias 2); a wrong sign
        # leaves a half of an entry, a missing term or factor a quarter
        left = {"sign": 1, "factor": 0.5, "symmetry": 1.6, "empty": 0, "velocity": 1, "number": 1.33, "other": 1.33, "sign-term": 1.67, "missing-term": 1.5, "factor-term": 1.5}
        jobs = [("four-bar", self.put(f"{mistake}.c", filled[:last] + "    " + statement + "\n" + filled[last:]))
                for mistake, (_, statement) in cases.items()]  # fmt: skip
        for (mistake, (part, _)), (_, (status, verdict)) in zip(cases.items(), self.two_at_a_time(self.grade, jobs)):
            entries = {e["name"]: e for e in verdict["entries"]}
            self.assertEqual((status, entries[part]["mistake"]), (0, mistake), verdict)
            if mistake in left:
                self.assertAlmostEqual(verdict["score"], POINTS - 2 + left[mistake], 9, (mistake, verdict))
            self.assertRegex(entries[part]["explanation"], r"; \d of \d entries are right$")
            self.assertEqual("no known mistake; force[2] differs most" in entries[part]["explanation"], mistake == "other")
            self.assertNotIn("expected_value", entries[part])

    def test_where_several_faults_explain_an_entry_all_are_named_and_the_least_is_given(self):
        # with m1 = m2 the terms of gravity in force[0] are one to two
        _, filled = blank_and_filled("double-pendulum", "c")
        sums = {"k3 + k8": "one of its 3 terms is missing, or one of its 3 terms lacks a factor 2",
                "k3": "one of its 3 terms has the wrong sign, or one of its 3 terms is missing"}  # fmt: skip
        self.assertEqual(filled.count("k3 + 2.0*k8"), 1)
        for wrong, says in sums.items():
            _, verdict = self.grade("double-pendulum", self.put("wrong.c", filled.replace("k3 + 2.0*k8", wrong)))
            entry = {e["name"]: e for e in verdict["entries"]}["force"]
            self.assertEqual((entry["mistake"], entry["explanation"], entry["points"]), ("missing-term", f"force[0]: {says}; 1 of 2 entries are right", 1.25))

    def test_two_faults_of_an_entry_a_moment_about_the_other_point_and_another_name_are_named(self):
        blank = call("export", "four-bar", "--language", "c", "--blanks").stdout
        right = honest_programs.FOUR_BAR["direct"]
        about = "1/4 of the right one, as m l^2/12 (about the centre) in place of m l^2/3"
        cases = {
            # with m1 = m2 the terms of gravity are one to two: the lesser one's sign, or the other one is missing
            "two": (("force[0] = -m2", "force[0] = m2"), ("(m1/2 + m2)", "(m1/2)"), "force", "two-terms",
                    "force[0]: one of its 3 terms has the wrong sign and another one has the wrong sign, or one of its 3 terms has the wrong sign and another one is missing", 0.125 + 2),
            "signs": ("- (m1/2 + m2)*g*l1", "+ (m1/2 + m2)*g*l1", "force", "two-terms", "force[0]: one of its 3 terms has the wrong sign and another one has the wrong sign", 0.25 + 2),
            "entries": (("*w1*w1 - m2", "*w1*w1 + m2"), ("-m3*g*l3/2", "-m3*g*l3"), "force", "sign-term",
                        "force[1]: one of its 2 terms has the wrong sign; force[2]: a factor 1/2 is missing", 0.5 + 0.25 + 1),
            # of a rod about its centre
            "whole": ("m2*l2*l2/3", "m2*l2*l2/12", "mass", "inertia", f"mass[1, 1]: it is {about}", 0.25 + 4),
            "term": ("m1*l1*l1/3", "m1*l1*l1/12", "mass", "inertia-term", f"mass[0, 0]: one of its 2 terms is {about}, or ", 0.25 + 4),
            "name": ("-m2*l1*l2/2*sin", "-m2*l1*l3/2*sin", "force", "other-name", "force[0]: one of its 3 terms is 0.6667 times the right one, as l3 in place of l2", 0.25 + 2)}  # fmt: skip
        entries = {"mass": 5, "force": 3}
        jobs = []
        for name, (old, new, *_) in cases.items():
            text = right
            for a, b in [old, new] if isinstance(old, tuple) else [(old, new)]:
                self.assertEqual(text.count(a), 1, (name, a))
                text = text.replace(a, b)
            jobs.append(("four-bar", self.put(f"{name}.c", honest_programs.fill(blank, text))))
        for (name, (_, _, part, mistake, says, of_entries)), (_, (_, verdict)) in zip(cases.items(), self.two_at_a_time(self.grade, jobs)):
            entry = {e["name"]: e for e in verdict["entries"]}[part]
            self.assertEqual((entry["mistake"], entry["explanation"][: len(says)]), (mistake, says), name)
            self.assertRegex(entry["explanation"], r"; \d of \d entries are right$")
            self.assertAlmostEqual(entry["points"], round(2 * of_entries / entries[part], 2), 9, name)

    def test_a_wrong_symbol_degrees_and_another_order_are_named(self):
        """Faults that depend on the state: no constant factor explains them."""
        blank = call("export", "four-bar", "--language", "c", "--blanks").stdout
        right, degree = honest_programs.FOUR_BAR["direct"], "57.29577951308232*"
        degrees = "its angles count as degrees, and they are in radians"
        cases = {
            # name: (what is changed, part, mistake, explanation, share of the part that is left)
            "whole": ([("l1*l2/2*cos(th1 - theta_coupler)", "l1*l2/2*cos(th1 - th3)")], "mass", "other-coordinate", "mass[0, 1], mass[1, 0]: it has th3 in place of theta_coupler", 3.5 / 5),
            "term": ([("l2/2*cos(theta_coupler)", "l2/2*cos(th1)")], "force", "other-coordinate", "force[1]: one of its 2 terms has th1 in place of theta_coupler", 2.25 / 3),
            "velocity": ([("l3*cos(th3)*w3*w3", "l3*cos(th3)*w1*w3")], "bias", "other-coordinate", "bias[0]: one of its 3 terms has w1 in place of w3", 1.25 / 2),
            "square": ([("l3*cos(th3)*w3*w3", "l3*cos(th3)*w3")], "bias", "power", "bias[0]: one of its 3 terms lacks a factor w3", 1.25 / 2),
            "sine": ([("jacobian[0][2] = l3*sin", "jacobian[0][2] = l3*cos")], "jacobian", "sine-cosine", "jacobian[0, 2]: it has sine and cosine exchanged", 5.25 / 6),
            "degrees": ([(f"{call}({angle}", f"{call}({degree}{angle}") for call in ("sin", "cos") for angle in ("th3", "theta_coupler")]
                        + [("(th1", f"({degree}th1"), ("- theta_coupler", f"- {degree}theta_coupler")], "force", "degrees", f"force[0], force[1], force[2]: {degrees}", 0.25),
            "rows": ([("jacobian[0]", "jacobian[2]"), ("jacobian[1]", "jacobian[0]"), ("jacobian[2]", "jacobian[1]")], "jacobian", "exchanged", "rows 0 and 1 are exchanged", 0.25),
            "coordinates": ([("mass[0][0] =", "mass[3][3] ="), ("mass[2][2] =", "mass[0][0] ="), ("mass[3][3] =", "mass[2][2] ="), ("mass[0][1] =", "mass[2][1] ="),
                             ("mass[1][0] = mass[0][1]", "mass[1][2] = mass[2][1]")], "mass", "exchanged", "rows and columns 0 and 2 are exchanged", 2 / 5),
            # with the terms of gravity go guesses that explain one entry each
            "gravity": ([(" - (m1/2 + m2)*g*l1*cos(th1)", ""), (" - m2*g*l2/2*cos(theta_coupler)", "")], "force", "missing-term", "force[0], force[1]: all terms with g are missing", 1.5 / 3),
            # any number is some multiple of constant terms
            "constant": ([("m1*l1*l1/3 + m2*l1*l1", "2*m1*l1*l1/3 + m2*l1*l1/12")], "mass", "other", "no known mistake; mass[0, 0] differs most, at state 1 of 5 (t = 0 s)", 4 / 5)}  # fmt: skip
        jobs = []
        for name, (changes, *_) in cases.items():
            text = right
            for a, b in changes:
                self.assertIn(a, text, name)
                text = text.replace(a, b)
            jobs.append(("four-bar", self.put(f"{name}.c", honest_programs.fill(blank, text))))
        for (name, (_, part, mistake, says, share)), (_, (_, verdict)) in zip(cases.items(), self.two_at_a_time(self.grade, jobs)):
            entry = {e["name"]: e for e in verdict["entries"]}[part]
            self.assertEqual((entry["mistake"], entry["explanation"].rsplit("; ", 1)[0]), (mistake, says), name)
            self.assertAlmostEqual(entry["points"], round(2 * share, 2), 9, name)

    def test_angles_that_are_counted_from_others_are_named(self):
        """A student derives everything for a relative angle, by the chain rule or by putting the sum in; each takes away what it spoils."""
        whole = {"mass": (0.55, """
    mass[0][0] = m1*l1*l1/3 + m2*l1*l1 + m2*l2*l2/3 + m2*l1*l2*cos(theta_coupler);
    mass[0][1] = mass[1][0] = m2*l2*l2/3 + m2*l1*l2/2*cos(theta_coupler);
    mass[1][1] = m2*l2*l2/3;
    mass[2][2] = m3*l3*l3/3;
"""), "force": (0.5, """
    force[1] = -m2*l1*l2/2*sin(theta_coupler)*w1*w1 - m2*g*l2/2*cos(A);
    force[0] = force[1] + m2*l1*l2/2*sin(theta_coupler)*W*W - (m1/2 + m2)*g*l1*cos(th1);
    force[2] = -m3*g*l3/2*cos(th3);
"""), "jacobian": (0.5, """
    jacobian[0][0] = -l1*sin(th1) - l2*sin(A);
    jacobian[0][1] = -l2*sin(A);
    jacobian[0][2] = l3*sin(th3);
    jacobian[1][0] = l1*cos(th1) + l2*cos(A);
    jacobian[1][1] = l2*cos(A);
    jacobian[1][2] = -l3*cos(th3);
"""), "bias": (0.25, """
    bias[0] = -l1*cos(th1)*w1*w1 - l2*cos(A)*W*W + l3*cos(th3)*w3*w3;
    bias[1] = -l1*sin(th1)*w1*w1 - l2*sin(A)*W*W + l3*sin(th3)*w3*w3;
""")}  # fmt: skip
        blank = call("export", "four-bar", "--language", "c", "--blanks").stdout
        relative = "    const double A = th1 + theta_coupler, W = w1 + omega_coupler;\n" + "".join(text for _, text in whole.values())
        right, entry = honest_programs.FOUR_BAR["direct"], "jacobian[0][1] = -l2*sin(theta_coupler)"
        self.assertIn(entry, right)
        put_in = right.replace(entry, "jacobian[0][1] = -l2*sin(th1 + theta_coupler)")
        # the angle alone is taken so, its rate is not
        alone = right.replace("theta_coupler)", "(th1 + theta_coupler))")
        # and an entry of one term with another length
        length = right.replace(entry, "jacobian[0][1] = -l1*sin(theta_coupler)")
        jobs = [("four-bar", self.put(f"{i}.c", honest_programs.fill(blank, text))) for i, text in enumerate((relative, put_in, alone, length))]
        (_, (_, all_of_them)), (_, (_, one)), (_, (_, angles)), (_, (_, other)) = self.two_at_a_time(self.grade, jobs)
        for e in all_of_them["entries"]:
            self.assertEqual((e["mistake"], e["explanation"].rsplit("; ", 1)[0]),
                             ("angle-origin", "it takes theta_coupler for an angle against th1: th1 + theta_coupler stands in its place"), e["name"])  # fmt: skip
            self.assertAlmostEqual(e["points"], round(2 * whole[e["name"]][0], 2), 9, e["name"])
        e = {e["name"]: e for e in one["entries"]}["jacobian"]
        said = "jacobian[0, 1]: it has th1 + theta_coupler in place of theta_coupler, as if that were counted from th1"
        self.assertEqual((e["mistake"], e["explanation"].rsplit("; ", 1)[0], e["points"]), ("angle-origin", said, 1.75))
        self.assertEqual(one["score"], POINTS - 0.25)
        for e in angles["entries"]:
            self.assertEqual((e["mistake"], said.partition(" has ")[2] in e["explanation"]), ("angle-origin", True), e)
        e = {e["name"]: e for e in other["entries"]}["jacobian"]
        self.assertEqual((e["mistake"], e["explanation"].rsplit("; ", 1)[0]), ("other-name", "jacobian[0, 1]: it is 0.4167 times the right one, as l1 in place of l2"))

    def test_an_explanation_ends_where_a_sentence_does(self):
        # each entry of the mass matrix has another fault with long words
        blank = call("export", "four-bar", "--language", "c", "--blanks").stdout
        text = honest_programs.FOUR_BAR["direct"]
        for a, b in (("m1*l1*l1/3", "m1*l1*l1/12"), ("m2*l2*l2/3", "m2*l2*l2/4"), ("m3*l3*l3/3", "m3*l3*l3"), ("l1*l2/2*cos(th1 -", "l1*l2*cos(th1 -")):
            self.assertIn(a, text)
            text = text.replace(a, b)
        _, verdict = self.grade("four-bar", self.put("long.c", honest_programs.fill(blank, text)))
        explanation = verdict["entries"][0]["explanation"]
        self.assertLessEqual(len(explanation), 360)
        ends = r"(in place of m l\^2/(3|12)|is missing|wrong sign|a factor (2|1/2)|are missing|or others)"
        for piece in explanation.rsplit("; ", 1)[0].split("; "):
            self.assertRegex(piece, ends + "$", explanation)

    def test_what_a_comment_is_depends_on_the_language(self):
        """In C a '%' divides: formulas that differ behind one are no copies; in Python '//' divides."""
        blank = {language: call("export", "four-bar", "--language", language, "--blanks").stdout for language in ("c", "python")}
        for language, ending, behind in (("c", "c", ("int k = 7 % 4; mass[0][0] = k*m1*l1*l1;", "int k = 7 % 4; mass[0][0] = k*m2*l2*l3;")),
                                         ("python", "py", ("    k = 7 // 4; mass[0, 0] = k*m1*l1*l1", "    k = 7 // 4; mass[0, 0] = k*m2*l2*l3"))):
            if language == "python" and not has_numpy():
                continue
            folder = tempfile.mkdtemp(dir=self.temporary.name)
            for name, statement in zip(("ann", "bob"), behind):
                lines = blank[language].splitlines()
                at = max(i for i, line in enumerate(lines) if "YOUR PART" in line)
                self.put(os.path.join(folder, f"{name}.{ending}"), "\n".join(lines[: at + 1] + [statement] + lines[at + 1 :]) + "\n")
            done = call("grade", "four-bar", folder)
            self.assertIn("2 graded, 0 not gradable", done.stdout, done.stderr)
            self.assertNotIn("near-copies", done.stdout, language)
            self.assertNotIn("the same", done.stdout, language)

    def test_a_small_mechanism_is_marked_as_a_large_one(self):
        for size, mass in ((0.01, 0.001), (1e-4, 1e-9), (1e3, 1e6)):
            settings = [word for name, value in (("l1", size), ("l2", size), ("m1", mass), ("m2", mass)) for word in ("--set", f"{name}={value}")]
            _, filled = blank_and_filled("double-pendulum", "c", *settings)
            for factor, right in (("1.0", 2), ("1.009", 1), ("1.00000001", 1)):
                last = filled.rindex("    energy[0] =")
                path = self.put("one.c", f"{filled[:last]}    mass[0][0] *= {factor};\n{filled[last:]}")
                verdict = json.loads(call("grade", "double-pendulum", path, *settings, "--json").stdout)
                self.assertEqual(verdict["summary"], f"{right} of 2 parts are right", (size, factor))

    def test_a_program_that_does_not_compile_is_told_the_line_with_the_error(self):
        path = self.put("syntax.c", "int main(void) {\n    return ((0);\n}\n")
        status, verdict = self.grade("four-bar", path)
        self.assertEqual((status, verdict["status"]), (2, "ungradable"), verdict)
        self.assertRegex(verdict["reason"], r"syntax\.c:2:\d+: error: expected")
        status, verdict = self.grade("four-bar", self.put("empty.py", "\n"))
        self.assertEqual((status, verdict["reason"]), (2, "the file is empty"), verdict)
        # a table of several names their files
        rows = call("grade", "four-bar", path, self.put("other.py", "\n"), "--format", "csv").stdout.splitlines()[1:]
        self.assertEqual([row.split(",")[1] for row in rows], ['"syntax.c"', '"other.py"'])

    def test_a_program_of_other_parameters_or_another_scene_is_no_zero(self):
        for language in ("c", "python" if has_numpy() else "c"):
            _, filled = blank_and_filled("four-bar", language)
            path = self.put(f"right.{ENDINGS[language][0]}", filled)
            done = call("grade", "four-bar", path, "--set", "l1=0.45", "--json")
            verdict = json.loads(done.stdout)
            self.assertEqual((done.returncode, verdict["status"]), (2, "ungradable"), verdict)
            self.assertEqual(verdict["reason"], "this program has l1 = 0.5; it is graded with l1 = 0.45")
            self.assertIn("--set l1=0.5", verdict["hint"])
            status, verdict = self.grade("slider-crank", path)
            self.assertEqual((status, verdict["reason"]), (2, "this is the program of the scene 'four-bar'; it is graded as one of 'slider-crank'"), verdict)

    def test_a_program_goes_to_the_scene_and_an_answer_to_the_exercise_of_the_same_name(self):
        blank, filled = blank_and_filled("ring", "c")
        right, empty = self.put("right.c", filled), self.put("blank.c", blank)
        done = call("grade", "ring", right, "--json")
        verdict = json.loads(done.stdout)
        self.assertEqual((done.returncode, verdict["score"], verdict["max_score"]), (0, POINTS, POINTS), verdict)
        kept = self.put("verdict.json", done.stdout)
        self.assertTrue(json.loads(call("regrade", kept, "--json").stdout)["same"])
        _, verdict = self.grade("ring", empty)
        self.assertEqual((verdict["status"], verdict["score"]), ("graded", 0))

        # the exercise `ring` has 4 points
        answer = self.put("answer.json", json.dumps({"problem": "ring", "a": 7}))
        status, verdict = self.grade("ring", answer)
        self.assertEqual((status, verdict["status"], verdict["max_score"], verdict["problem"]), (0, "graded", 4, "ring"), verdict)

        # a program of another scene is one; a file that no export wrote is none; both kinds at once are refused
        _, other = blank_and_filled("slider-crank", "c")
        status, verdict = self.grade("ring", self.put("other.c", other))
        self.assertEqual((status, verdict["reason"]), (2, "this is the program of the scene 'slider-crank'; it is graded as one of 'ring'"))
        status, verdict = self.grade("ring", self.put("nothing.c", "x"))
        self.assertEqual((status, verdict["reason"]), (2, "the submission is not JSON: it begins with 'x'"))
        done = call("grade", "ring", answer, right)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("'ring' is an exercise and a scene", done.stderr)
        self.assertIn("grade answers (exercise:ring) and programs (scene:ring) apart", done.stderr)

        # a class is of the exercise, and a note names both; a prefix says which
        self.put("both/ann.c", filled)
        self.put("both/bob.json", json.dumps({"problem": "ring", "a": 7}))
        both = os.path.join(self.temporary.name, "both")
        notes = {}
        for name, graded in (("ring", "bob: 0 of 4"), ("exercise:ring", "bob: 0 of 4"), ("scene:ring", f"ann: {POINTS} of {POINTS}")):
            done = call("grade", name, both)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertRegex(done.stdout, rf"(?m)^{graded}, ")
            self.assertIn("2 submissions: 1 graded, 1 not gradable", done.stdout)
            notes[name] = done.stderr
        self.assertIn("'ring' is an exercise and a scene; graded as the exercise, with scene:ring as the program of the scene", notes["ring"])
        self.assertEqual((notes["exercise:ring"], notes["scene:ring"]), ("", ""))
        self.assertEqual(call("grade", "scene:four-bar", right).returncode, 2)
        done = call("grade", "scene:p3", right)
        self.assertEqual((done.returncode, "no shipped scene is called 'p3'" in done.stderr), (3, True), done.stderr)

    def test_a_verdict_holds_the_program_and_is_made_again_from_it(self):
        _, filled = blank_and_filled("four-bar", "c")
        last = filled.rindex("    energy[0] =")
        spoilt = (filled[:last] + "    force[1] += 0.5;\n" + filled[last:]).replace("l1 = 0.5", "l1 = 0.45")
        path = self.put("folder/spoilt.c", spoilt)
        done = call("grade", "four-bar", path, "--set", "l1=0.45", "--student", "Ann", "--json")
        verdict = json.loads(done.stdout)
        self.assertEqual((verdict["score"], verdict["submission"], verdict["submission_file"], verdict["set"]), (7.33, spoilt, "spoilt.c", ["l1=0.45"]))
        kept = self.put("verdict.json", done.stdout)
        os.remove(path)
        again = json.loads(call("regrade", kept, "--json").stdout)
        self.assertEqual((again["same"], again["score"]), (True, 7.33))
        self.assertIn("the same score: 7.33 of 8 before, 7.33 of 8 now", call("regrade", kept).stdout)

        # another program in its place
        right = self.put("right.c", filled.replace("l1 = 0.5", "l1 = 0.45"))
        done = call("regrade", kept, right)
        self.assertIn("ANOTHER SCORE: 7.33 of 8 before, 8 of 8 now", done.stdout)
        self.assertIn("the submission is another one than was graded", done.stdout)

    def test_the_page_of_a_verdict_says_what_was_given_and_expected(self):
        _, filled = blank_and_filled("four-bar", "c")
        last = filled.rindex("    energy[0] =")
        path = self.put("spoilt.c", filled[:last] + "    force[0] += 0.5;\n" + filled[last:])
        page = call("grade", "four-bar", path, "--student", "Ann", "--format", "html", "--show-expected").stdout
        self.assertIn("program spoilt.c, handed in by Ann", page)
        self.assertNotIn("variant of seed", page)
        given, expected = (float(x) for x in re.findall(r"<code>force\[0\] = ([-\d.]+)</code>", page))
        self.assertAlmostEqual(given - expected, 0.5, 7)
        self.assertNotIn("expected", call("grade", "four-bar", path, "--format", "html").stdout.split("<body>")[1])

        # what is for a table or a robot says the same, and to the student nothing of what is expected
        for form in ("csv", "junit"):
            asked = call("grade", "four-bar", path, "--format", form, "--show-expected").stdout
            self.assertAlmostEqual(float(re.search(r"expected +force\[0\] = ([-\d.]+)", asked)[1]), expected, 5)
            self.assertNotIn("expected", call("grade", "four-bar", path, "--format", form).stdout)

    def test_a_program_that_was_not_filled_in_has_no_points_in_any_scene(self):
        # bennett has entries that are 0 but for rounding, parallelogram a whole part, oblique-four-bar a parameter d
        # that no part needs, and a variable of that name elsewhere
        for scene in ("four-bar", "bennett", "parallelogram", "oblique-four-bar", "heavy-top"):
            path = self.put(f"{scene}.c", call("export", scene, "--language", "c", "--blanks").stdout)
            status, verdict = self.grade(scene, path)
            self.assertEqual((status, verdict["score"], {e["mistake"] for e in verdict["entries"]}), (0, 0, {"empty"}), scene)

    def test_the_points_of_the_parts_stand_in_one_column(self):
        path = self.put("empty.c", call("export", "four-bar", "--language", "c", "--blanks").stdout)
        lines = re.findall(r"^  (?:mass|force|jacobian|bias) +\S+ / 2", call("grade", "four-bar", path).stdout, re.M)
        self.assertEqual([len(line) for line in lines], 4 * [len(lines[0])], lines)

    def test_a_program_has_no_variant_to_choose(self):
        done = call("grade", "four-bar", self.put("any.py", "x"), "--seed", "7")
        self.assertEqual((done.returncode, "the program of a scene has none" in done.stderr), (2, True), done.stderr)

    def test_a_parameter_that_was_set_for_the_export_is_set_for_the_grade(self):
        text = call("export", "four-bar", "--language", "c", "--blanks", "--set", "l1=0.45").stdout
        self.assertIn("l1 = 0.45", text)
        _, filled = blank_and_filled("four-bar", "c")
        path = self.put("set.c", filled.replace("l1 = 0.5", "l1 = 0.45"))
        self.assertEqual(self.grade("four-bar", path)[1]["status"], "ungradable")
        done = call("grade", "four-bar", path, "--set", "l1=0.45", "--json")
        self.assertEqual(json.loads(done.stdout)["score"], POINTS)

    def test_terms_of_a_parameter_that_is_zero_are_said_to_be_not_compared(self):
        said = "terms that are zero for T0 = 0, c = 0 were not compared; export and grade with '--set T0=...' compare them"
        for settings, wrong, note in ([], "right", said), (["--set", "c=2", "--set", "T0=1"], "sign", ""):
            _, filled = blank_and_filled("slider-crank", "c", *settings)
            path = self.put("other_sign.c", filled.replace("force[2] = -(vx*c);", "force[2] = vx*c;"))
            done = call("grade", "slider-crank", path, "--json", *settings)
            verdict = json.loads(done.stdout)
            force = next(e for e in verdict["entries"] if e["name"] == "force")
            self.assertEqual((force.get("mistake") or "right", verdict.get("note", "")), (wrong, note))

    def test_what_does_not_answer_says_which_limit(self):
        cases = {"ends": ("import sys\nsys.exit(3)", "exit status 3"),
                 "raises": ("raise ValueError('not done')", "not done"),
                 "prints": ("for x in iter(input, ''): print('hello', flush=True)", "numbers of its parts"),
                 "takes all memory": ("x = []\nwhile True: x.append(bytearray(1 << 24))", "MemoryError|MB of memory"),
                 "floods": ("import os\nwhile True: os.write(1, b'x' * 65536)", "without an end of line"),
                 "writes away": ("open('/usr/mine', 'w')", "Read-only file system")}  # fmt: skip
        jobs = [("four-bar", self.put(f"{name}.py", text + "\n")) for name, (text, _) in cases.items()]
        for (name, (_, said)), (_, (status, verdict)) in zip(cases.items(), self.two_at_a_time(self.grade, jobs)):
            self.assertEqual(status, 2, (name, verdict))
            self.assertRegex(verdict["reason"], said, name)
        status, verdict = self.grade("four-bar", self.put("a.txt", "x"))
        self.assertEqual((status, "does not end in" in verdict["reason"]), (2, True))

    def make_class(self):
        """17 students: right ones, near-copies, wrong ones, hostile ones; the folder."""
        _, filled = blank_and_filled("four-bar", "c")
        blank = call("export", "four-bar", "--language", "c", "--blanks").stdout
        for k, statements in enumerate(list(honest_programs.FOUR_BAR.values())[:9]):
            self.put(f"class/student{k}.c", honest_programs.fill(blank, statements))
        copy = filled.replace("    energy[0] =", "    double mine = 3.0 - 4.0; (void)mine;\n    energy[0] =", 1)
        self.put("class/ann_4711_assignsubmission_file_/work.c", copy)
        # other names, one of which the program has elsewhere already, other comments, two statements in another order
        self.put("class/bob_4712_assignsubmission_file_/work.c", copy.replace("k1", "first").replace("mine", "i").replace("/// ", "/// My words: ") + "// my own work\n")
        swapped = re.search(r"\n( *mass\[0\]\[0\] = .*)\n( *mass\[.*)\n", copy)
        self.put("class/cid.c", copy.replace(swapped[0], f"\n{swapped[2]}\n{swapped[1]}\n").replace("k2", "second"))
        self.put("class/wrong.c", filled.replace("m1*l1*l1", "m1*l1*l4"))
        self.put("class/floods.py", "import os\nwhile True: os.write(1, b'x' * 65536)\n")
        self.put("class/dies.py", "import os\nos.kill(os.getpid(), 9)\n")
        self.put("class/junk.c", "@ no program\n")
        self.put("class/text.txt", "later")
        return os.path.join(self.temporary.name, "class")

    def test_programs_that_use_another_variable_at_one_place_are_no_copies(self):
        for language in ("c", "python"):
            ending = ENDINGS[language][0]
            _, filled = blank_and_filled("double-pendulum", language)
            end = filled.rindex("    energy[0] =")
            own = "    const double a = 2.0, c = 4.0;\n    const double b = 2.0;\n    mass[0][0] *= a*b/c;\n"
            loop = "    for (int i = 0; i < NV; i++) for (int j = 0; j < NV; j++) mass[i][j] *= 1.0;\n"
            if language == "python":
                own = "    a = 2.0; c = 4.0\n    b = 2.0\n    mass[0, 0] *= a*b/c\n"
                loop = "    for i in range(NV):\n        for j in range(NV): mass[i, j] *= 1.0\n"
            added = {"own": own, "own-twice": own.replace("a*b", "a*a"), "own-renamed": re.sub(r"\bb\b", "k30", re.sub(r"\ba\b", "zz", own)),
                     "loop": loop, "loop-across": loop.replace("[i][j]", "[j][i]").replace("[i, j]", "[j, i]")}  # fmt: skip
            programs = {"ann": filled, "factor": re.sub(r"(k\d+ = )l1\*m2", r"\1l2*m1", filled), "force": filled.replace("(k3 + 2", "(k7 + 2"),
                        "mass": re.sub(r"(mass\[1(?:\]\[|, )1\] = 0.3333333333333333\*)k6", r"\1k9", filled)}  # fmt: skip
            programs |= {name: filled[:end] + text + filled[end:] for name, text in added.items()}
            self.assertEqual(len(set(programs.values())), len(programs))
            for name, text in programs.items():
                self.put(f"{language}/{name}.{ending}", text)
            out = os.path.join(self.temporary.name, f"{language}.ndjson")
            done = call("grade", "double-pendulum", os.path.join(self.temporary.name, language), "--out", out)
            groups = re.findall(rf"(?s)near-copies: {NEAR}\n(.*?)\n\S", done.stdout + "\nend")
            self.assertEqual([line.strip() for line in "".join(groups).splitlines()], ["own, own-renamed"], (language, done.stdout))

    def alike_groups(self, scene, programs):
        """The groups of programs that the pairs of the summary link, as sets of names; the remarks."""
        folder = tempfile.mkdtemp(dir=self.temporary.name)
        for name, text in programs.items():
            self.put(os.path.join(folder, f"{name}.c"), text)
        done = call("grade", scene, folder, "--jobs", "2", "--out", folder + ".csv")
        self.assertIn(f"{len(programs)} graded, 0 not gradable", done.stdout)
        with open(folder + ".csv", encoding="utf-8") as f:
            remarks = {row["student"]: row["remark"] for row in csv.DictReader(f)}
        found = re.search(r"(?s)pairs of programs that share 60 % or more of their statements, the most alike first .*? by chance\n((?:  .*\n)+)", done.stdout)
        pairs = re.findall(r"(?m)^ +(\d+) %  (\S+), (\S+)$", found[1]) if found else []
        shares, groups = [int(share) for share, *_ in pairs], []
        self.assertEqual((len(pairs), shares), (len(found[1].splitlines()) if found else 0, sorted(shares, reverse=True)))
        for _, *names in pairs:
            linked = [group for group in groups if group & set(names)]
            groups = [group for group in groups if group not in linked] + [set(names).union(*linked)]
        return groups, remarks

    def test_ten_honest_programs_are_not_called_alike(self):
        for scene, statements in (("four-bar", honest_programs.FOUR_BAR), ("double-pendulum", honest_programs.DOUBLE_PENDULUM)):
            blank = call("export", scene, "--language", "c", "--blanks").stdout
            groups, remarks = self.alike_groups(scene, {name: honest_programs.fill(blank, text) for name, text in statements.items()})
            self.assertEqual((groups, set(remarks.values())), ([], {""}), scene)

    def test_a_copy_with_a_statement_added_taken_apart_or_turned_round_is_found(self):
        def turned(text):
            return re.sub(r"\b([a-z]\w*)\*([a-z]\w*)\b(?![(\[])", r"\2*\1", text)

        def added(text, statement):
            return text.replace(";\n", ";\n    " + statement + "\n", 1)

        changes = {"print": lambda text: added(text, 'fprintf(stderr, "%g\\n", th1 + 2*w1);'),
                   "unused": lambda text: added(added(text, "double unused = 3*l1; (void)unused;"), "double more = g + 2*l2; (void)more;"),
                   "turned": turned,
                   "helper": lambda text: "    const double help = l1*cos(th1);\n" + text.replace("l1*cos(th1)", "help", 2),
                   "all": lambda text: "    // mine\n" + added(turned(re.sub(r"\b(h|d|c1|s1|T1|I1|X|ax)\b", r"my_\1", text)), "double own = 2*l1 + th1; (void)own;")}  # fmt: skip
        blank = call("export", "four-bar", "--language", "c", "--blanks").stdout
        for student in ("direct", "shorter-names", "centres", "terse"):
            own = honest_programs.FOUR_BAR[student]
            programs = {student: own, **{name: change(own) for name, change in changes.items()}}
            # an honest one stands beside them
            programs["careful"] = honest_programs.FOUR_BAR["careful"]
            groups, remarks = self.alike_groups("four-bar", {name: honest_programs.fill(blank, text) for name, text in programs.items()})
            self.assertEqual([sorted(group) for group in groups], [sorted({student, *changes})], student)
            self.assertRegex(remarks["print"], rf"^shares at least \d\d % of its statements with .*\b{student}\b")
            self.assertEqual(remarks["careful"], "")

    def test_a_zip_file_of_a_class_is_answered_with_how_to_unpack_it(self):
        path = self.put("class.bin", "")
        shutil.make_archive(path[:-4], "zip", os.path.dirname(__file__), "frames")
        for subject in ("four-bar", "p3"):
            status, verdict = self.grade(subject, path[:-4] + ".zip")
            self.assertEqual((status, verdict["status"], verdict["reason"]), (2, "ungradable", "it is a zip file"), verdict)
            self.assertIn("unzip FILE.zip -d FOLDER", verdict["hint"])

    def test_a_class_of_programs_is_graded_in_parts_through_kills_with_the_same_bytes(self):
        folder, out = self.make_class(), os.path.join(self.temporary.name, "scores.ndjson")
        done = call("grade", "four-bar", folder, "--out", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(out, encoding="utf-8") as f:
            lines = {line["student"]: line for line in map(json.loads, f)}
        self.assertEqual(len(lines), 17)
        self.assertEqual({name: line["score"] for name, line in lines.items() if name.startswith("student")}, {f"student{k}": POINTS for k in range(9)})
        self.assertEqual((lines["wrong"]["score"] < POINTS, lines["floods"]["status"], lines["dies"]["status"], lines["text"]["status"]), (True, *["ungradable"] * 3))
        self.assertIn("without an end of line", lines["floods"]["reason"])
        self.assertIn("/program/program.c:1:1: error", lines["junk"]["reason"])
        self.assertRegex(done.stdout, rf"near-copies: {NEAR}\n +ann, bob, cid\n")
        self.assertNotIn("student1, student2", done.stdout)
        with open(out, "rb") as f:
            calm = f.read()

        # a table names them beside each
        table = os.path.join(self.temporary.name, "scores.csv")
        self.assertEqual(call("grade", "four-bar", folder, "--out", table).returncode, 0)
        with open(table, encoding="utf-8") as f:
            remarks = {row["student"]: row["remark"] for row in csv.DictReader(f)}
        # the wrong one is theirs without their own statement, and with another length at one place
        self.assertRegex(remarks["ann"], rf"^{NEAR} as bob, cid; shares 9\d % of its statements with wrong$")
        self.assertRegex(remarks["cid"], rf"^{NEAR} as ann, bob; shares 9\d % of its statements with wrong$")
        self.assertEqual({remarks[f"student{k}"] for k in range(9)}, {""})

        # three parts on three machines, put together
        parts = [os.path.join(self.temporary.name, f"part{i}.ndjson") for i in (1, 2, 3)]
        for i, part in enumerate(parts, 1):
            self.assertEqual(call("grade", "four-bar", folder, "--shard", f"{i}/3", "--out", part).returncode, 0)
        merged = os.path.join(self.temporary.name, "merged.ndjson")
        done = call("grade", "four-bar", "--merge", *reversed(parts), "--out", merged)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(merged, "rb") as f:
            self.assertEqual(f.read(), calm)
        done = call("grade", "four-bar", "--merge", *parts[:2], "--out", merged)
        self.assertEqual(done.returncode, 2)
        self.assertIn("5 of 17 submissions are in none of these parts", done.stderr)
        done = call("grade", "four-bar", folder, "--shard", "4/3")
        self.assertEqual((done.returncode, "is no part of a class" in done.stderr), (2, True))

        # killed in the middle, then on
        os.remove(out)
        process = subprocess.Popen([PROGRAM, "grade", "four-bar", folder, "--jobs", "1", "--out", out], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        deadline = time.monotonic() + 120
        while process.poll() is None and time.monotonic() < deadline and not (os.path.exists(out + ".part") and os.path.getsize(out + ".part") > 0):
            time.sleep(0.01)
        process.send_signal(signal.SIGKILL)
        process.wait()
        done = call("grade", "four-bar", folder, "--out", out)
        self.assertIn("were graded before", done.stderr)
        with open(out, "rb") as f:
            self.assertEqual(f.read(), calm)


if __name__ == "__main__":
    driver.main()
