# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line as a person and a script use it: exit statuses, outputs that parse, faults that are told."""

import functools
import json
import os
import pty
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
sys.path.insert(0, os.path.dirname(__file__))
import driver  # noqa: E402
from command import DONE, ENDED, INPUT, PROGRAM, RK4, SUBMISSION, Command, call, strict  # noqa: E402


def write_in(folder, name, text):
    """The path of a new file."""
    path = os.path.join(folder, name)
    with open(path, "w") as f:
        f.write(text)
    return path


class CommandLine(Command):
    def test_help_names_every_command_and_every_command_has_help(self):
        text = self.assert_exit(call("help"), DONE)
        self.assertLessEqual(max(map(len, text.splitlines())), 80)
        commands = re.findall(r"^  holonom (\w+)", text, re.M)
        self.assertTrue({"serve", "list", "inspect", "terms", "equations", "run", "compare", "snapshot", "grade"} <= set(commands))
        for command in commands:
            self.assertIn(command, self.assert_exit(call("help", command), DONE))
            self.assertIn(command, self.assert_exit(call(command, "--help"), DONE))

    def test_version_is_told(self):
        self.assertRegex(self.assert_exit(call("--version"), DONE), r"^holonom \d+\.\d+")
        self.assertIn("version", strict(self.assert_exit(call("version", "--json"), DONE)))

    def test_no_command_is_at_fault(self):
        done = call()
        self.assertEqual((done.returncode, done.stdout), (INPUT, b""))
        self.assertIn(b"holonom run", done.stderr)

    def test_lists_come_as_tables_and_as_json(self):
        for what, key, known in (("scenes", "scenes", "four-bar"), ("methods", "formulations", "baumgarte"),
                                 ("lessons", "lessons", "01-closed-loops"), ("problems", "problems", "p3")):
            self.assertIn(known, self.assert_exit(call("list", what), DONE))
            self.assertTrue(strict(self.assert_exit(call("list", what, "--json"), DONE))[key])
        exercises = strict(self.assert_exit(call("list", "problems", "--json"), DONE))["problems"]
        self.assertEqual({exercise["time_limit"] for exercise in exercises}, {60})
        self.assertTrue(all(5 <= exercise["minutes"] <= 45 and exercise["minutes"] % 5 == 0 for exercise in exercises))

    def test_inspect_equations_and_terms_speak_of_the_scene(self):
        text = self.assert_exit(call("inspect", "four-bar"), DONE)
        self.assertIn("coordinates that the scene marks as actuated", text)
        self.assertNotIn("driven", text)  # nothing drives it
        self.assertTrue(strict(self.assert_exit(call("inspect", "four-bar", "--json"), DONE)))
        self.assertTrue(self.assert_exit(call("equations", "four-bar"), DONE))
        self.assertIn("\\", self.assert_exit(call("equations", "four-bar", "--format", "latex"), DONE))
        self.assertTrue(strict(self.assert_exit(call("equations", "four-bar", "--json"), DONE)))
        self.assertIn("mass matrix", self.assert_exit(call("terms", "four-bar"), DONE))
        terms = strict(self.assert_exit(call("terms", "pendulum", "--json"), DONE))
        name = terms["coordinates"][0]
        moved = strict(self.assert_exit(call("terms", "pendulum", "--json", "--q", name + "=0.5", "--t", "2"), DONE))
        self.assertEqual((moved["q"][0], moved["t"]), (0.5, 2))

    def test_equations_of_every_shipped_scene_are_told_with_angles_joined(self):
        scenes = strict(self.assert_exit(call("list", "scenes", "--json"), DONE))
        ids = [scene["id"] for scene in scenes.get("scenes", scenes) if not scene.get("errors")]
        self.assertGreater(len(ids), 30)
        for scene in ids:
            with self.subTest(scene=scene):
                self.assertIn("M[1][1] = ", self.assert_exit(call("equations", scene), DONE))
        text = self.assert_exit(call("equations", "four-bar"), DONE)
        self.assertIn("M[2][1] = 0.5*l1*l2*m2*cos(th1 - theta_coupler)\n", text)
        self.assertIn("f[2] = 0.5*w1^2*l1*l2*m2*sin(th1 - theta_coupler) - 0.5*l2*m2*g*cos(theta_coupler)\n", text)
        latex = self.assert_exit(call("equations", "four-bar", "--format", "latex"), DONE)
        self.assertIn("\\cos\\left(\\theta_{1} - \\theta_{coupler}\\right)", latex)

    def test_equations_give_the_pose_from_the_independent_coordinates(self):
        text = self.assert_exit(call("equations", "slider-crank"), DONE)
        self.assertIn("independent: th1\n", text)
        self.assertIn("\n  x = r*cos(th1) + l*cos(theta_rod)\n", text)
        latex = self.assert_exit(call("equations", "four-bar", "--format", "latex"), DONE)
        self.assertIn(r"\rho_{1} &= \sigma_{1}\, \sqrt{", latex)
        position = strict(self.assert_exit(call("equations", "four-bar", "--json"), DONE))["position"]
        self.assertEqual((position["independent"], len(position["steps"])), (["th1"], 1))
        step = position["steps"][0]
        self.assertEqual([line["name"] for line in step["unknowns"]], ["theta_coupler", "th3"])
        self.assertIn(step["sign"]["value"], (-1, 1))
        self.assertIn("the others: Newton, because 4 unknowns appear", self.assert_exit(call("equations", "3-rrr"), DONE))
        self.assertNotIn("independent:", self.assert_exit(call("equations", "pendulum"), DONE))

    def test_terms_say_of_which_state_they_are(self):
        at_start = self.assert_exit(call("terms", "four-bar"), DONE)
        self.assertTrue(at_start.startswith("four-bar at its start: "), at_start[:80])
        # a time does not move the mechanism, and the text says so
        later = self.assert_exit(call("terms", "four-bar", "--t", "1", "--reactions"), DONE)
        self.assertIn("at its start, with t = 1 s in the formulas that depend on time: ", later.split("\n")[0])
        self.assertIn("holonom run four-bar --at 1 --reactions", later.split("\n")[1])
        moved = self.assert_exit(call("terms", "four-bar", "--q", "th1=1"), DONE)
        self.assertIn("four-bar at its start, changed by --q and --v: ", moved)

    def test_terms_name_the_velocities_and_show_rounding_as_zero(self):
        text = self.assert_exit(call("terms", "four-bar", "--set", "th1_0=0"), DONE)
        self.assertRegex(text, r"\nv, velocities, to which M, f, J and a belong\n  w1 +4\n  wa2 +-8\n  w3 +-4\n"
                               r"M, mass matrix of the velocities v\n +w1 +wa2 +w3\n  w1 ")
        # -2.84217e-15 beside -16
        self.assertRegex(text, r"\ngamma = Jdot v\n  B: x +-16\n  B: y +0\n")
        exact = strict(self.assert_exit(call("terms", "four-bar", "--set", "th1_0=0", "--json"), DONE))
        self.assertEqual(exact["rates"], ["w1", "wa2", "w3"])

    def test_the_equations_name_the_mirror_of_a_symmetric_matrix(self):
        text = self.assert_exit(call("equations", "four-bar"), DONE)
        self.assertRegex(text, r"M \(mass matrix; symmetric: of M\[i,j\] = M\[j,i\] one is listed; entries that are not listed are zero\)")
        self.assertRegex(text, r"J \(closure Jacobian; entries not listed are zero\)")

    def test_terms_show_the_equations_left_on_the_free_motion(self):
        text = self.assert_exit(call("terms", "five-bar"), DONE)
        self.assertIn("independent: th1, th2 (the motors)", text)
        for title in ("Phi, v = Phi v_r", "M_r = Phi' M Phi", "C_r", "g_r", "tau_r", "a_r"):
            self.assertIn(title, text)
        moving = self.assert_exit(call("terms", "driven-crank"), DONE)
        self.assertIn("M_r a_r + C_r v_r + d_r + g_r = tau_r", moving)
        self.assertIn("s, velocities at v_r = 0", moving)
        ball = strict(self.assert_exit(call("terms", "heavy-top", "--json"), DONE))["reduced"]
        self.assertFalse(ball["exists"])
        self.assertIn("the entries of an orientation cannot be", ball["why"])
        self.assertIn("the entries of an orientation cannot be", self.assert_exit(call("terms", "heavy-top"), DONE))
        unfit = self.assert_exit(call("terms", "five-bar", "--v", "w1=1"), DONE)
        self.assertIn("the given velocities violate the closed loops", unfit)

    def test_inspect_says_why_a_loop_stays_open(self):
        # crank 3 at 1 rad and ground 1 are sqrt(3^2 + 1^2 - 2*3*cos(1)) = 2.59965 apart, coupler and rocker reach 1.2 + 0.8
        text = self.assert_exit(call("inspect", "four-bar", "--set", "l1=3"), INPUT)
        self.assertIn("0.599651 m are missing", text)
        self.assertIn("make rocker longer than 1.39965 m", text)
        start = strict(self.assert_exit(call("inspect", "four-bar", "--set", "l1=3", "--json"), INPUT))["start"]
        self.assertFalse(start["ok"])
        self.assertIn("loop B cannot be closed", start["reason"])
        closed = strict(self.assert_exit(call("inspect", "four-bar", "--json"), DONE))["start"]
        for scene, driven in (("car-axis", True), ("pantograph", True), ("ring", False)):
            reading = strict(self.assert_exit(call("inspect", scene, "--json"), DONE))["actuation"]["reading"]
            self.assertEqual("nothing is driven" not in reading, driven)
        self.assertTrue(closed["ok"])
        self.assertNotIn("reason", closed)

    def test_lists_are_whole_and_in_tables_marked_where_they_are_cut(self):
        text = self.assert_exit(call("inspect", "n-four-bar", "--set", "N=60"), DONE)
        self.assertRegex(text, r"ground +no +vertical 0, .*, \u2026\n")  # the bodies of the ground's group are 122
        self.assertIn("B60: tilt 2\n", text)  # rows that vanish: not in a table

    def test_inspect_names_everything_in_words(self):
        def members(value):
            for key, inner in value.items() if isinstance(value, dict) else ():
                yield key
                yield from members(inner)
            for inner in value if isinstance(value, list) else ():
                yield from members(inner)

        for scene in "bennett", "fb0-lagrangian", "car-axis", "3-rrr":
            names = {key for key in members(strict(self.assert_exit(call("inspect", scene, "--json"), DONE))) if "_" in key}
            text = self.assert_exit(call("inspect", scene), DONE)
            self.assertGreater(len(names), 10)
            self.assertEqual([name for name in names if name in text.split()], [], scene)

    def test_inspect_tells_how_positions_are_found(self):
        def answers(scene):
            return strict(self.assert_exit(call("inspect", scene, "--json"), DONE))["position_analysis"]

        squeezer = answers("seven-body-squeezer")
        self.assertEqual(squeezer["answers"], "dyads: closed form (3 of them)")
        self.assertLess(squeezer["operations"], squeezer["operations_of_a_newton_step"])
        self.assertEqual([step["kind"] for step in squeezer["steps"]], ["RRR"] * 3)
        self.assertTrue(answers("3-rrr")["answers"].startswith("Newton, because 4 unknowns appear together"))
        self.assertIn("no loops", answers("pendulum")["answers"])
        refused = call("run", "3-rrr", "--method", "reduced:position=dyads@rk4:h=1e-3", "--time", "0.1")
        self.assertNotEqual(refused.returncode, DONE)
        self.assertIn(b"no position analysis in closed form", refused.stderr)
        flat = call("run", "parallelogram", "--method", "reduced:position=dyads@rk4:h=1e-3", "--time", "0.5", "--json")
        self.assertEqual(flat.returncode, ENDED)
        self.assertIn("RRR of B: x and B: y (a circle and a circle) went over to its other assembly mode",
                      strict(flat.stdout)["reason"])

    def test_formulas_beside_bodies_act_in_the_joints(self):
        scene = "tests/scenes/formulas-beside-bodies.json"
        text = self.assert_exit(call("terms", scene, "--reactions"), 0)
        self.assertIn("reactions on the body that is named, in world axes", text)
        self.assertRegex(text, r"\n  O +on \w+")
        self.assertIn("efforts along coordinates\n  energies          along a ", text)
        t = json.loads(call("terms", scene, "--reactions", "--json").stdout)
        self.assertEqual([r["name"] for r in t["reactions"]], ["O"])  # the formulas' own coordinate has no joint
        effort = next(e for e in t["efforts"] if e["coordinate"] == "a")
        self.assertEqual((effort["name"], effort["kind"], effort["unit"]), ("energies", "energies", "N m"))
        self.assertAlmostEqual(t["reactions"][0]["moment"][2], effort["value"], delta=1e-11)
        head = call("run", scene, "--time", "0.01", "--reactions").stdout.decode().splitlines()[0].split(",")
        self.assertIn("effort energies along a [N m]", head)
        self.assertIn("moment O z", head)
        alone = self.assert_exit(call("terms", "fb0-lagrangian", "--reactions"), 0)
        self.assertIn("loop x            along th1", alone)
        self.assertNotIn("reactions on the body", alone)

    def test_a_setting_changes_the_scene(self):
        before = strict(self.assert_exit(call("list", "scenes", "--json"), DONE))
        parameter = next(s for s in before["scenes"] if s["id"] == "four-bar")["parameters"][0]
        changed = f"{parameter['name']}={parameter['value'] * 1.02!r}"
        plain, moved = (strict(self.assert_exit(call("terms", "four-bar", "--json", *more), DONE)) for more in ((), ("--set", changed)))
        self.assertNotEqual(plain["M"], moved["M"])

    def test_the_letters_of_the_list_of_methods_are_explained(self):
        text = " ".join(call("list", "methods").stdout.decode().split())
        self.assertEqual(text.count("h: step, p: order of the integrator, t: time. needs: terms that the method evaluates"), 1)

    def test_grading_a_wrong_answer_is_done_and_an_unreadable_one_is_not(self):
        with tempfile.TemporaryDirectory() as folder:
            write = functools.partial(write_in, folder)
            wrong = json.loads(json.dumps(SUBMISSION))
            wrong["J"][1][2] = "l3*cos(th3)"
            right, wrong = write("right.json", json.dumps(SUBMISSION)), write("wrong.json", json.dumps(wrong))
            best = strict(self.assert_exit(call("grade", "p3", right, "--json"), DONE))
            less = strict(self.assert_exit(call("grade", "p3", wrong, "--json"), DONE))
            self.assertEqual(best["score"], best["max_score"])
            self.assertLess(less["score"], less["max_score"])
            for name, text in (("empty.json", ""), ("nan.json", '{"J": NaN}'), ("odd.json", "[]"), ("zero.json", "{}")):
                done = call("grade", "p3", write(name, text))
                self.assertTrue(self.assert_exit(done, INPUT).strip() or done.stderr)
            self.assert_exit(call("grade", "p3", os.path.join(folder, "missing.json")), INPUT)
            out = os.path.join(folder, "deep", "results")
            self.assert_exit(call("grade", "p3", wrong, "--format", "gradescope", "--out", out), DONE)
            results = strict(open(os.path.join(out, "results.json")).read())
            self.assertTrue(results["tests"])
            self.assertEqual(open(os.path.join(out, "results.png"), "rb").read(4), b"\x89PNG")
            many = call("grade", "p3", right, os.path.join(folder, "empty.json"), wrong, "--format", "json", "--out", out)
            self.assert_exit(many, INPUT)
            self.assertTrue({"right.json", "empty.json", "wrong.json"} <= set(os.listdir(out)))

    def test_a_fault_names_the_option_that_was_typed_and_a_file_has_its_pointer(self):
        rows = [
            (("run", "four-bar", "--method", "foo"), "(in --method)"),
            (("compare", "four-bar", "--methods", RK4, "foo"), "(in --methods)"),
            (("run", "for-bar"), "(in SCENE)"),
            (("run", "four-bar", "--time", "-1"), "(in --time)"),
            (("run", "four-bar", "--set", "nonsense=1"), "(in --set nonsense)"),
            (("run", "four-bar", "--set", "l1=50"), "(start value of th1)"),
            (("terms", "four-bar", "--q", "nonsense=1"), "(in --q nonsense)"),
            (("terms", "four-bar", "--v", "nonsense=1"), "(in --v nonsense)"),
            (("study", "four-bar", "stability", "--over", "nonsense=1..2"), "(in --over)"),
            (("inspect", "-"), "(at /title)"),
        ]
        for words, place in rows:
            with self.subTest(words=words):
                said = call(*words, stdin='{"holonom": 1, "title": 3}').stderr.decode()
                self.assertIn(place, said.replace("\n", " "))
        # a member of a file that is called like an option
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "mine.json")
            with open(path, "w", encoding="utf-8") as f:
                f.write('{"holonom": 1, "title": "mine", "methods": 5}')
            for words in ((), ("--methods", RK4)):
                self.assertIn("(at /methods)", call("compare", path, *words).stderr.decode().replace("\n", " "))
        # what a program reads has pointers
        told = strict(call("run", "four-bar", "--method", "foo", "--json").stdout)
        self.assertEqual(told["errors"][0]["pointer"], "/method")

    def test_input_at_fault_is_2_and_says_what_to_do(self):
        rows = [
            (("rnu",), "run"),
            (("list",), "needs"),
            (("list", "scene"), "scenes"),
            (("inspect",), "needs"),
            (("inspect", "for-bar"), "four-bar"),
            (("inspect", "no/such/file.json"), "file.json"),
            (("inspect", "."), ""),
            (("run", "four-bar", "--method", "indx1@rk4:h=1e-3"), "index1"),
            (("run", "four-bar", "--method", "index1@rk4:h=0"), "h"),
            (("run", "four-bar", "--method", "index1"), "@"),
            (("run", "four-bar", "--metod", RK4), "--method"),
            (("run", "four-bar", "--time", "-1"), "time"),
            (("run", "four-bar", "--time", "0"), "time"),
            (("run", "four-bar", "--time", "nan"), "finite"),
            (("run", "four-bar", "--every", "0"), "interval"),
            (("run", "four-bar", "--at", "2,1"), "ascending"),
            (("run", "four-bar", "--format", "xml"), "ndjson"),
            (("run", "four-bar", "--set", "l1"), "NAME=VALUE"),
            (("run", "four-bar", "--set", "l1=long"), "NAME=VALUE"),
            (("run", "four-bar", "--set", "nonsense=1"), "nonsense"),
            (("run", "-"), "empty"),
            (("compare", "four-bar", "--methods", RK4, "nonsense"), ""),
            (("compare", "four-bar", "--methods"), "needs"),
            (("compare", "four-bar", "--time", "-3"), "time"),
            (("terms", "four-bar", "--q", "nonsense=1"), "nonsense"),
            (("terms", "four-bar", "--q", "0.5"), "NAME=VALUE"),
            (("equations", "four-bar", "--format", "latx"), "latex"),
            (("snapshot", "four-bar"), "-o"),
            (("snapshot", "four-bar", "-o", "-", "--theme", "drak"), "dark"),
            (("snapshot", "bennett", "-o", "-", "--view", "tob"), "top"),
            (("snapshot", "four-bar", "-o", "-", "--width", "3"), "16"),
            (("snapshot", "four-bar", "-o", "-", "--width", "0"), "--width is 0; 16 to 4096 pixels are allowed"),
            (("snapshot", "four-bar", "-o", "-", "--height", "1e9"), "--height is 1000000000; 16 to 4096"),
            (("snapshot", "four-bar", "-o", "a.png", "--out", "b.png"), "--out is given twice"),
            (("run", "four-bar", "--time", "1", "--time=2"), "--time is given twice; it takes one value"),
            (("run", "four-bar", "--at", "1,2", "--at", "3"), "--at is given twice"),
            (("run", "four-bar", "--method", RK4, "--method", RK4), "--method is given twice"),
            (("run", "four-bar", "--set", "l1=0.5", "--set", "l1=0.6"), "--set gives 'l1' twice, 0.5 and 0.6"),
            (("run", "four-bar", "--set", "l1=0.5,l1=0.6"), "--set gives 'l1' twice"),
            (("study", "four-bar", "budget", "--time-limit", "1", "--time-limit", "2"), "--time-limit is given twice"),
            (("serve", "--port", "0", "--port", "0"), "--port is given twice"),
            (("grade", "p3"), "needs"),
            (("grade", "p3", "x.json", "--format", "gradscope"), "gradescope"),
            (("serve", "--port", "99999"), "65535"),
            (("run", "four-bar", "--set", "start.th1=1e8"), "th1 = 1e+08 rad is too large: numbers of this size are 2.2e-08 rad apart"),
            (("run", "four-bar", "--set", "start.th1=1e99"), "subtract whole turns of 2 pi"),
            (("run", "four-bar", "--set", "l1=9"), "cannot be closed"),
            (("run", "four-bar", "--set", "start.w1=1e99"), "below 1e+09 (at /scene/start)"),
            (("compare", "four-bar", "--set", "start.w1=1e99"), "below 1e+09 (at /scene/start)"),
            (("serve", "--port", "http"), "whole number"),
            (("serve", "--port", "0x50"), "--port takes a whole number from 0, not '0x50'"),
            (("run", "four-bar", "--time", "0x1"), "--time takes a finite decimal number, not '0x1'"),
            (("run", "four-bar", "--at", "0,0x1"), "not '0,0x1'"),
            (("run", "four-bar", "--time", "1000001"), "above 0 and at most 1e6 s"),
            (("study", "four-bar", "budget", "--time", "1000001"), "1e-09 to 1e+06 are allowed"),
            (("run", "four-bar", "--every", "1e-300", "--time", "1"), " 1e+300 samples were asked for"),
            (("serve", "--runs", "Makefile"), "it is not a folder"),
            (("serve", "--runs", "/proc/none/runs"), "no run can be kept in '/proc/none/runs'"),
            (("serve", "--max-streams", "99999999999"), "--max-streams is 99999999999; a whole number from 1 to 4000"),
            (("serve", "--max-comparisons", "0"), "--max-comparisons is 0; a whole number from 1 to 1000"),
            (("serve", "--keep-alive", "1e9"), "--keep-alive is 1000000000; a number from 0.1 to 20"),
            (("serve", "--host", "no.such.host.invalid"), "no.such.host.invalid"),
            (("serve", "--host", "203.0.113.7"), "not an address of this machine"),
            (("help", "rnu"), "run"),
        ]
        for words, word in rows:
            with self.subTest(words=words):
                done = call(*words)
                self.assert_exit(done, INPUT)
                text = done.stderr.decode()
                self.assertTrue(text.startswith("holonom: "), text)
                self.assertIn(word, text)

    def test_a_file_at_fault_is_named_in_every_message(self):
        with tempfile.TemporaryDirectory() as folder:
            write = functools.partial(write_in, folder)
            with open("lessons/01-closed-loops/scenes/four-bar.json") as f:
                four_bar = f.read()
            fields, syntax = write("a.json", '{"name": "x", "bodies": [{"nam": "a"}]}'), write("b.json", '{"name":')
            far = write("far.json", four_bar.replace('"l1": {"value": 0.5,', '"l1": {"value": 50,'))
            submission = write("s.json", json.dumps(SUBMISSION))
            model = write("c.xml", "<mujoco><worldbody><body></worldbody></mujoco>")
            for path in (fields, syntax, far):
                for words in (("run", path), ("inspect", path), ("compare", path), ("terms", path), ("export", path), ("study", path, "budget"),
                              ("snapshot", path, "-o", "-"), ("tui", path, "--once"), ("reference", path)):
                    if path == far and words[0] in ("inspect", "export", "reference"):
                        continue  # these take a loop that is open
                    with self.subTest(words=words):
                        text = call(*words).stderr.decode()
                        faults = [line for line in text.splitlines() if line.startswith("holonom: ") and not line.startswith("holonom: and ")]
                        self.assertTrue(faults, text)
                        for line in faults:
                            self.assertTrue(line.startswith(f"holonom: {path}: "), line)
            for words, path in ((("import", model), model), (("problem", fields), fields), (("grade", syntax, submission), syntax),
                                (("rubric", "check", syntax), syntax), (("grade", "p3", submission, "--rubric", syntax), syntax)):
                with self.subTest(words=words):
                    self.assertTrue(call(*words).stderr.decode().startswith(f"holonom: {path}: "), words)
            # standard input has a name too, and --json says the same
            done = subprocess.run([driver.PROGRAM, "run", "-"], input=b'{"name":', capture_output=True)
            self.assertTrue(done.stderr.startswith(b"holonom: standard input: line 1"), done.stderr)
            for error in strict(call("run", fields, "--json").stdout.decode())["errors"]:
                self.assertTrue(error["detail"].startswith(fields + ": "), error)

    def test_faults_come_as_json_where_json_was_asked(self):
        done = call("run", "for-bar", "--json")
        document = strict(self.assert_exit(done, INPUT))
        self.assertEqual(document["status"], "input")
        self.assertIn("four-bar", document["errors"][0]["hint"])
        self.assertEqual(done.stderr, b"")

    def test_malformed_scenes_never_crash_it(self):
        for text in ("{", "[]", "null", '{"a": 1}', "\x00", "[" * 10000, '{"bodies": 1}', "é", '{"title": "\\ud800"}'):
            with self.subTest(text=text[:20]):
                self.assert_exit(call("inspect", "-", stdin=text), INPUT)

    def test_nothing_is_coloured_when_nobody_looks(self):
        for command in (("list", "scenes"), ("compare", "four-bar", "--methods", RK4, "--time", "0.1")):
            done = call(*command)
            self.assertNotIn(b"\x1b", done.stdout + done.stderr)

    def test_without_its_scenes_the_program_says_where_it_looked(self):
        done = call("list", "scenes", environment={"HOLONOM_HOME": "/nowhere"})
        self.assertEqual(done.returncode, PROGRAM)
        self.assertIn(b"/nowhere", done.stderr)

    def test_a_port_that_is_taken_is_told_and_the_next_one_is_used(self):
        first = driver.Server()
        second = subprocess.Popen([driver.PROGRAM, "serve", "--port", str(first.port), "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        try:
            port = json.loads(second.stdout.readline())["port"]
            self.assertNotEqual(port, first.port)
            self.assertIn(f"port {first.port} is already in use", second.stderr.readline().decode())
        finally:
            second.terminate()
            second.communicate(timeout=30 * driver.SLOW)
            first.stop()

    @unittest.skipIf(driver.SLOW > 1, "a sanitiser reserves more than the limit")
    def test_a_server_without_memory_for_its_threads_says_what_it_needs(self):
        done = subprocess.run(["sh", "-c", 'ulimit -v 300000; exec "$0" serve --port 0', driver.PROGRAM], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (PROGRAM, ""))
        self.assertRegex(done.stderr, "(?s)refuses memory or a thread .* seventy threads, each with a stack of .*'ulimit -v'")

    def test_serve_tells_its_address_and_to_a_terminal_its_keys(self):
        """A journal has no keys: 'Ctrl+C here ends it' stood in that of a service."""
        screen, terminal = pty.openpty()
        for told, out in ((os.fdopen(screen, "rb"), terminal), (None, subprocess.PIPE)):
            server = subprocess.Popen([driver.PROGRAM, "serve", "--port", "0"], stdout=out)
            told = told or server.stdout
            try:
                self.assertRegex(told.readline().decode(), r"http://127\.0\.0\.1:\d+/")
                if out == terminal:
                    self.assertIn("Ctrl+C here ends it", told.readline().decode())
            finally:
                server.terminate()
                rest = server.communicate(timeout=30 * driver.SLOW)[0]
            self.assertEqual((server.returncode, rest), (DONE, None if out == terminal else b""))
        os.close(terminal)


if __name__ == "__main__":
    driver.main()
