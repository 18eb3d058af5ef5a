# SPDX-License-Identifier: GPL-3.0-or-later
"""holonom run and compare: times, settings, ends, verdicts on the motion, remedies, incidents and estimates of the error."""

import csv
import glob
import io
import json
import os
import pty
import re
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
sys.path.insert(0, os.path.dirname(__file__))
import driver  # noqa: E402
from command import DONE, ENDED, INPUT, RK4, Command, call, strict  # noqa: E402


class Run(Command):
    def test_a_mechanism_without_mass_is_refused_with_the_freedom(self):
        with open("lessons/01-closed-loops/scenes/four-bar.json") as f:
            scene = json.load(f)
        for body in scene["bodies"]:
            body.update(mass=0, inertia={"zz": 0})
        for method in ("projection@rk4", "index1@dopri5", "ggl@radau5"):
            done = call("run", "-", "--method", method, stdin=json.dumps(scene))
            self.assertEqual(done.returncode, ENDED, done.stderr)
            self.assertIn("moves no mass, such as that of th1", done.stderr.decode())

    def test_raw_multipliers_come_when_asked_for_and_where_there_are_some(self):
        words = ("run", "four-bar", "--method", "ggl@radau5:h=0.01", "--time", "0.1", "--every", "0.05")
        plain = strict(self.assert_exit(call(*words, "--json"), DONE))["samples"]
        self.assertNotIn("raw_lambda", plain)
        raw = strict(self.assert_exit(call(*words, "--raw-lambda", "--json"), DONE))["samples"]
        self.assertEqual(raw["q"], plain["q"])
        self.assertEqual(raw["raw_lambda"][0], [None, None])
        for found, recomputed in zip(raw["raw_lambda"][1:], raw["lambda"][1:]):
            self.assertAlmostEqual(found[0], recomputed[0], delta=0.01)
        head = self.assert_exit(call(*words, "--raw-lambda"), DONE).splitlines()[0]
        self.assertEqual(head.count("raw lambda"), 2)
        words = ("run", "four-bar", "--method", RK4, "--time", "0.1", "--raw-lambda", "--json")
        self.assertNotIn("raw_lambda", strict(self.assert_exit(call(*words), DONE))["samples"])

    def test_multipliers_without_a_digit_are_told_beside_them(self):
        # a bead where two rails cross at an angle e that grows with time: the condition number is 6 / e^2
        rails = json.dumps({
            "holonom": 1, "name": "rails", "title": "rails",
            "lagrangian": {
                "coordinates": [{"name": "x", "rate": "u", "unit": "m"}, {"name": "y", "rate": "v", "unit": "m"}],
                "kinetic": "(u^2 + v^2)/2", "potential": "9.81*y",
                "constraints": [{"name": "level", "formula": "y"}, {"name": "turning", "formula": "y*cos(1e-7 + t) - x*sin(1e-7 + t)"}],
            },
            "start": {"positions": {"x": 0, "y": 0}, "rates": {"u": 0, "v": 0}}, "duration": 1, "step": 0.01,
        })
        text = self.assert_exit(call("terms", "-", stdin=rails), DONE)
        self.assertIn("multipliers, and reactions computed from them: no digit left (condition 6e+14, rank 2 of 2)", text)
        self.assertNotIn("no digit", self.assert_exit(call("terms", "-", "--t", "1", stdin=rails), DONE))
        result = call("run", "-", "--method", RK4, "--time", "1", "--at", "0,1", stdin=rails)
        rows = list(csv.DictReader(io.StringIO(self.assert_exit(result, DONE))))
        self.assertEqual([row["lambda_mark"] for row in rows], ["2", "0"])
        said = result.stderr if isinstance(result.stderr, str) else result.stderr.decode()
        self.assertIn("in 1 of 2 samples the multipliers, and the joint forces computed from them, have no correct digit (lambda_mark 2)", said)

    def test_a_run_ends_where_it_is_told_to_whatever_its_step_is(self):
        # the shorter step to the end fails; the whole step of 5 s is none of this run
        done = call("run", "four-bar", "--method", "index3@genalpha:h=5", "--time", "1", "--at", "1", "--json")
        self.assertEqual(done.returncode, ENDED)
        told = json.loads(done.stdout)
        self.assertEqual((told["status"], told["t_reached"]), ("no-convergence", 0))
        self.assertEqual([i["code"] for i in told["incidents"]], ["step-long"])

    def test_forces_of_loops_that_stand_open_are_marked(self):
        # not stabilised, at a long step, the loop of 1.2 m opens by more than a thousandth of it
        words = ("run", "four-bar", "--method", "index1@rk4:h=0.02", "--time", "3", "--reactions", "--every", "0.5")
        result = call(*words)
        rows = list(csv.DictReader(io.StringIO(self.assert_exit(result, DONE))))
        for row in rows:
            self.assertEqual(row["lambda_mark"], "4" if float(row["gap"]) > 1.2e-3 else "0", row["t"])
        self.assertEqual({row["lambda_mark"] for row in rows}, {"0", "4"})
        said = result.stderr if isinstance(result.stderr, str) else result.stderr.decode()
        self.assertRegex(said, r"in \d of 7 samples the multipliers, and the joint forces computed from them, are those of open loops \(lambda_mark 4\)")
        # the same of one state: joint B 24 mm apart
        torn = ("terms", "four-bar", "--q", "th3=1")
        self.assertIn("of open loops", self.assert_exit(call(*torn), DONE))
        self.assertNotIn("open loops", self.assert_exit(call("terms", "four-bar"), DONE))

    def test_a_pair_that_does_not_fit_is_refused_with_what_fits(self):
        result = call("run", "four-bar", "--method", "index3@rk4")
        said = result.stderr if isinstance(result.stderr, str) else result.stderr.decode()
        self.assertEqual(result.returncode, 2)
        self.assertIn("the formulation index3 gives a differential-algebraic system, which the integrator rk4 does not solve", said)
        self.assertIn("radau5", said)
        self.assertIn("rk4 serves index1", said)

    def test_a_run_is_csv_by_default_and_the_same_numbers_in_every_form(self):
        words = ("run", "four-bar", "--method", RK4, "--time", "1", "--every", "0.1")
        rows = list(csv.reader(io.StringIO(self.assert_exit(call(*words), DONE))))
        self.assertEqual(rows[0][0], "t")
        self.assertEqual(rows[0][-5:], ["gap", "velocity_gap", "energy", "work", "energy_change"])
        self.assertEqual(len(rows), 12)
        self.assertTrue(all(len(row) == len(rows[0]) for row in rows))
        lines = [strict(line) for line in self.assert_exit(call(*words, "--format", "ndjson"), DONE).splitlines()]
        self.assertEqual(lines[0]["columns"], rows[0])
        self.assertEqual(lines[-1]["status"], "ok")
        self.assertEqual(lines[1:-1], [[float(x) for x in row] for row in rows[1:]])
        run = strict(self.assert_exit(call(*words, "--json"), DONE))
        self.assertEqual(run["samples"]["t"], [row[0] for row in lines[1:-1]])
        self.assertEqual(run["samples"]["q"][5], lines[6][1:1 + len(run["coordinates"])])

    def test_output_times_can_be_chosen(self):
        run = strict(self.assert_exit(call("run", "four-bar", "--method", RK4, "--time", "1", "--at", "0,0.25,0.7", "--json"), DONE))
        self.assertEqual(run["samples"]["t"], [0, 0.25, 0.7])

    def test_a_scene_may_be_a_name_a_file_or_standard_input(self):
        path = "lessons/01-closed-loops/scenes/pendulum.json"
        words = ("--method", RK4, "--time", "0.5", "--json")
        runs = [strict(self.assert_exit(done, DONE))["samples"] for done in
                (call("run", "pendulum", *words), call("run", path, *words), call("run", "-", *words, stdin=open(path).read()))]
        self.assertEqual(runs[0], runs[1])
        self.assertEqual(runs[0], runs[2])

    def test_a_run_that_ends_early_is_4_with_its_reason_and_its_samples(self):
        done = call("run", "four-bar", "--method", "index1@euler:h=0.5", "--time", "500")
        text = self.assert_exit(done, ENDED)
        self.assertGreater(len(text.splitlines()), 1)
        self.assertIn(b"ended early", done.stderr)
        run = strict(self.assert_exit(call("run", "four-bar", "--method", "index1@euler:h=0.5", "--time", "500", "--json"), ENDED))
        self.assertTrue(run["reason"])
        # a sample between two steps finds the end before the next step does
        run = strict(self.assert_exit(call("run", "four-bar", "--set", "l2=1.55", "--method", "reduced@rk4:h=1e-2", "--time", "1", "--json"), ENDED))
        self.assertIn("beyond the end of its range", run["reason"])
        self.assertEqual(run["incidents"][-1]["code"], "chart-lost")

    def test_a_weight_that_hangs_is_held_up_as_help_and_readme_say(self):
        bodies = [{"name": "bob", "mass": 2, "com": [0, 0, 0], "inertia": {"zz": 0.1}}]
        pin = {"name": "pin", "type": "revolute", "parent": {"body": "ground"}, "child": {"body": "bob", "at": [0, 1, 0]}, "coordinate": "th"}
        slide = {"name": "slide", "type": "prismatic", "axis": [0, 1, 0], "parent": {"body": "ground"}, "child": {"body": "bob"}, "coordinate": "y"}
        rod = {"name": "rod", "distance": {"from": [0, 2, 0], "to": {"body": "bob", "at": [0, 0, 0]}, "length": 1}}
        for joints, constraints, carrier, start in (([pin], [], "pin", {"th": 0}), ([slide], [rod], "rod", {"y": {"guess": 0.9}})):
            scene = {"holonom": 1, "name": "weight", "gravity": [0, -10, 0], "bodies": bodies, "joints": joints, "constraints": constraints,
                     "start": {"positions": start}}
            done = call("run", "-", "--method", "projection@rk4:h=1e-3", "--time", "0.01", "--at", "0.01", "--reactions", "--json",
                        stdin=json.dumps(scene))
            run = strict(self.assert_exit(done, DONE))
            force, at = run["samples"]["reaction_force"][-1], run["carriers"].index(carrier)
            upward = force[3 * at + 1]
            self.assertAlmostEqual(upward, 20, delta=1e-9, msg=carrier)  # m g, upward
        self.assertRegex(b" ".join(call("run", "--help").stdout.split()), rb"The reaction of a joint acts from the parent on the child")
        with open("core/README.md", encoding="utf-8") as readme:
            self.assertIn("| a joint | its child | its parent |", readme.read())

    def test_compare_prints_a_row_for_each_method(self):
        text = self.assert_exit(call("compare", "four-bar", "--methods", RK4, "projection@rk4:h=1e-3", "--time", "1"), DONE)
        self.assertRegex(text, r"worst gap \[m\] +velocity gap \[m/s\] +energy change \[\wJ\] +motion error +reaction error +steps +evals +ops +ops/step +CPU/step \[.?s\] +quartiles")
        self.assertRegex(text, r"(?m)^index1@rk4\S* +right +1.00 ")
        self.assertRegex(text, r"(?m)^projection@rk4\S* +right +1.00 ")
        summary = strict(self.assert_exit(call("compare", "four-bar", "--methods", RK4, "--time", "0.5", "--json"), DONE))
        self.assertEqual([m["state"] for m in summary["methods"]], ["finished"])

    def test_a_motion_that_is_wrong_is_not_called_ok(self):
        # the step is longer than the run: it comes to the end 19 rad off
        far = "projection@rk4:h=2"
        text = self.assert_exit(call("compare", "four-bar", "--methods", far, RK4, "--time", "1"), DONE)
        self.assertRegex(text, r"(?m)^projection@rk4\S* +WRONG +1.00 ")
        self.assertRegex(text, r"(?m)^! projection@rk4\S* is wrong: a2 is off by up to 32 rad$")
        self.assertRegex(text, r"(?m)^index1@rk4\S* +right +1.00 ")
        self.assertNotRegex(text, r"index1@rk4\S* is wrong")
        told = call("run", "four-bar", "--method", far, "--time", "1", "--at", "1").stderr.decode()
        self.assertRegex(told, r"the motion is wrong: up to t = 1 s the coordinates are estimated to be off by up to 19 rad \(a2\), reactions by .*largest( value)?\n")
        near = call("run", "four-bar", "--method", "index1@rk4:h=0.05", "--time", "1", "--at", "1").stderr.decode()
        self.assertNotIn("the motion is wrong", near)

    def test_a_smaller_step_is_advised_only_where_it_was_seen_to_help(self):
        # half the step keeps the loop closed to the end of this run
        helped = call("run", "four-bar", "--method", "index1@rk4:h=0.01", "--time", "5", "--at", "5").stderr.decode()
        self.assertRegex(helped, r"the motion is (inaccurate|wrong): .*; a smaller step may help\n")
        # a change of energy that grew from the start on: from a state on the way no trial removes it, from the start one does
        helped = call("run", "four-bar", "--method", "index1@rk4:h=0.01", "--time", "10", "--at", "10").stderr.decode()
        self.assertRegex(helped, r"the energy has changed by .*\nholonom:     try h=0\.0025 \(tried until t = ")
        self.assertIn("a smaller step may help", helped)
        # half this step was tried, in vain
        vain = call("run", "four-bar", "--method", "index1@rk4:h=0.05", "--time", "2", "--at", "2").stderr.decode()
        self.assertRegex(vain, r"the loop has opened: .*; tried in vain: .*\bh=0\.025\b")
        self.assertNotIn("smaller step", vain)
        # where a trial from the start is too long the sentence says so
        late = call("run", "slider-crank", "--method", "projection@euler:h=1e-3", "--time", "8", "--at", "8").stderr.decode()
        self.assertRegex(late, r"tried in vain from t = 7\.\d* s on \(where the state already holds the errors so far; a trial from the start would take too many steps\): this method with h=")
        # equations that lack a term are wrong at any step
        for method, word in ("rk4:h=0.01", "step"), ("dopri5:rtol=1e-5", "tolerance"):
            method = f"nullspace-as-printed@{method}"
            printed = call("run", "four-bar", "--method", method, "--time", "1", "--at", "1").stderr.decode()
            self.assertIn(f"; a smaller {word} does not help: the error lies in the equations of the formulation", printed)
            text = call("compare", "four-bar", "--methods", method, "--time", "1").stdout.decode()
            self.assertIn(f"a smaller {word} does not help", text)

    def test_what_ends_a_run_is_an_error_and_what_ends_there_too_no_remedy(self):
        # no motion goes on from a mass of zero
        done = call("run", "four-bar", "--method", "reduced@rk4:h=1e-2", "--set", "l1=5e-324", "--json")
        end = json.loads(done.stdout)["incidents"][-1]
        self.assertEqual((end["code"], end["t"], end["remedies"]), ("rank-loss", 0, []))
        self.assertIn("; tried in vain: projection@rk4:h=0.01, this method with h=0.005", end["message"])

    def test_a_trial_stops_at_the_end_of_the_run_unless_the_event_is_near_it(self):
        # the energy is reported at 9.18 s
        def told(time):
            done = call("run", "four-bar", "--method", "index1@rk4:h=0.01", "--time", time, "--json")
            last = json.loads(done.stdout)["incidents"][-1]
            self.assertAlmostEqual(last["t"], 9.18, places=6)
            return re.match(r"tried until t = (\S+) s(.*?): ", last["tried"][0])
        whole = told("10")
        self.assertEqual((float(whole[1]), whole[2]), (10, ""))
        near = told("9.2")
        self.assertEqual(near[2], ", past the end of the run at 9.2 s")
        # a tenth of the way to the event
        self.assertGreater(float(near[1]), 9.2)
        self.assertLess(float(near[1]), 9.18 * 1.11)

    def test_remedies_of_wrong_equations_are_tried_from_the_start(self):
        # 1615 steps in: a trial from a state of this motion would begin with its error, 0.27 J there
        done = call("run", "four-bar", "--method", "nullspace-as-printed@rk4:h=0.001", "--time", "10", "--json")
        end = json.loads(done.stdout)["incidents"][-1]
        self.assertEqual(end["code"], "chart-lost")
        tried = re.fullmatch(r"tried until t = \S+ s: largest gap \S+ m, energy changed by (\S+) J", end["tried"][0])
        self.assertLess(abs(float(tried[1])), 1e-3, end["tried"])

    def test_a_value_and_the_limit_it_exceeds_are_two_numbers(self):
        told = call("run", "four-bar", "--method", "index1@rk4:h=5e-3", "--time", "7", "--at", "7").stderr.decode()
        value, limit = re.search(r"the constraint violation of (\S+) m exceeds the limit of (\S+) m", told).groups()
        self.assertGreater(float(value), float(limit))
        self.assertLess(float(value), 1.0001 * float(limit))  # three digits do not tell them apart
        late = call("run", "four-bar", "--time", "1", "--at", "1.00000001").stderr.decode()
        self.assertIn("output time 1.00000001 s lies after the end, 1 s", late)

    def test_incidents_beyond_the_fifth_of_a_kind_are_counted(self):
        # flat twelve times in 5 s: five are announced and reported, all are counted
        words = ("parallelogram", "--time", "5")
        listed = json.loads(call("run", *words, "--method", "projection@rk4:h=1e-3", "--json").stdout)["incidents"]
        for code in "rank-ahead", "near-singular":
            told = [i["message"] for i in listed if i["code"] == code]
            self.assertEqual([("; later incidents of this kind are counted, not listed" in m) for m in told], [False] * 4 + [True])
        self.assertEqual({i["times"] for i in listed if i["code"] == "near-singular"}, {12})
        said = r"and \d+ more incidents \(--json lists the first 5 of each kind: rank-ahead came \d+ times, near-singular came 12 times\)"
        run = call("run", *words, "--method", "projection@rk4:h=1e-3", "--at", "5").stderr.decode()
        self.assertRegex(run, said)
        self.assertRegex(call("compare", *words, "--methods", "projection@rk4:h=1e-3").stdout.decode(), said)
        # before the fifth of any kind all are listed
        few = call("compare", "parallelogram", "--time", "1.3", "--methods", "projection@rk4:h=1e-3").stdout.decode()
        self.assertRegex(few, r"and \d+ more incidents \(--json lists them all\)")

    def test_a_status_that_finds_fault_says_by_which_measure(self):
        done = call("compare", "four-bar", "--methods", "nullspace@rk4:h=0.01", "--time", "3").stdout.decode()
        self.assertRegex(done, r"(?m)^nullspace\S+ +inaccurate ")
        measure = "status: by the estimated errors of motion and reactions: right up to 0.01, WRONG from a motion error of 1 on"
        self.assertIn(measure, " ".join(done.split()))
        done = call("compare", "four-bar", "--methods", "projection@rk4:h=1e-3", "--time", "1").stdout.decode()
        self.assertNotIn("status: by", done)

    def test_a_scene_whose_methods_are_meant_to_go_wrong_says_so(self):
        own = " ".join(call("compare", "four-bar").stdout.decode().split())
        self.assertIn("this is intended: The step of 0.01 s is long on purpose", own)
        # the figure of the note is the one of the run
        self.assertIn("within 10 s the angles are wrong by up to 1.8 rad", own)
        self.assertIn("index1@rk4:h=0.01 is wrong: th1 is off by up to 1.8 rad", own)
        for words in ("--methods", "index1@rk4:h=0.01"), ("--time", "1"), ("--set", "l1=0.45"):
            # methods of somebody else; nothing has gone wrong; another mechanism
            self.assertNotIn("this is intended", call("compare", "four-bar", *words).stdout.decode())
        # a run by one of its methods says it too, wherever standard error leads
        own = call("run", "parallelogram", "--at", "5").stderr.decode()
        self.assertIn("this is intended: Within 5 s, index-1 and Baumgarte leave the motion", own)
        for words in ("--method", "index1@rk4:h=2e-3"), ("--set", "w_0=3"):
            self.assertNotIn("this is intended", call("run", "parallelogram", "--at", "5", *words).stderr.decode())

    def test_the_verdict_on_a_run_is_told_whoever_reads_it(self):
        for scene, time, says in ("bennett", "1", "right: up to t = 1 s the coordinates"), ("four-bar", "10", "not judged|inaccurate|wrong|right"):
            told = call("run", scene, "--time", time).stderr.decode()  # into a pipe
            self.assertRegex(told, rf"(?m)^holonom: the motion is ({says})")
        unknown = call("run", "n-four-bar", "--set", "N=200", "--time", "0.01").stderr.decode()
        self.assertRegex(unknown, r"(?m)^holonom: the motion is not judged: the error is not known \(.+\)$")

    def test_compare_shows_each_error_under_its_own_name(self):
        text = call("compare", "parallelogram", "--wide").stdout.decode()
        summary = json.loads(call("compare", "parallelogram", "--json").stdout)
        for m in summary["methods"]:
            e = m["error_estimate"]
            motion, reaction = (re.escape(f"{e[key]:.1e}") for key in ("q", "reaction"))
            self.assertRegex(text, rf"(?m)^{re.escape(m['method'])} .* {motion} +{reaction} ")
        # the methods of every other shipped scene stay below 1 %, as the table says
        wrong, said = set(), set()
        with open("tests/tables/accuracy.txt", encoding="utf-8") as file:
            for line in file:
                if "above 1 %, " in line:
                    self.assertIn("an exhibit", line)
                    wrong.add(line.split()[0])
        for path in glob.glob("lessons/*/scenes/*.json"):
            with open(path, encoding="utf-8") as file:
                if json.load(file).get("exhibit"):
                    said.add(os.path.basename(path)[:-5])
        self.assertEqual(wrong, said)

    def test_a_status_is_the_verdict_on_the_motion(self):
        methods = ("projection@rk4:h=1e-3", "index1@rk4:h=0.01", "projection@rk4:h=0.1")
        done = call("compare", "four-bar", "--methods", *methods, "--time", "4")
        said = dict(re.findall(r"(?m)^(\w\S+@\S+) +(right|inaccurate|WRONG|ENDED EARLY) ", done.stdout.decode()))
        self.assertEqual([said[m] for m in ("projection@rk4:h=0.001", *methods[1:])], ["right", "inaccurate", "ENDED EARLY"])

    def test_incidents_come_in_order_of_time_and_each_remedy_once(self):
        # a sample at 1 s, inside the step from 0.9 s, finds another branch before the step ends the run
        told = call("run", "four-bar", "--method", "projection@rk4:h=0.3", "--time", "10").stderr.decode()
        times = [float(t) for t in re.findall(r"(?m)^holonom: (?:at )?t = (\S+?) s[:,] ", told)]
        self.assertGreater(len(times), 1)
        self.assertEqual(times, sorted(times))
        self.assertEqual(told.count("try ggl@radau5"), 1)
        self.assertIn("the run ended early: after t = 0.9 s the state stopped being finite", told)

    def test_an_end_is_told_once_and_with_one_time(self):
        run = call("run", "four-bar", "--method", "projection@rk4:h=0.3", "--time", "10").stderr.decode()
        compared = call("compare", "four-bar", "--methods", "projection@rk4:h=0.3", "index1@rk4:h=0.3", "nullspace@rk4:h=0.1", "--time", "10")
        compared = (compared.stdout + compared.stderr).decode()
        for told in (run, compared):
            self.assertEqual(told.count("the state stopped being finite"), 1, told)
            self.assertNotRegex(told, r"t = (\S+) s: (after|at) t = \1 s")
        self.assertIn("projection@rk4:h=0.3 ended early: after t = 0.9 s the state", compared)
        self.assertIn("nullspace@rk4:h=0.1 ended early at t = 1 s, in the step to t = 1.1 s with th3 = 0.808177: ", compared)
        for method in ("projection@rk4:h=0.3", "index1@rk4:h=0.3", "nullspace@rk4:h=0.1"):
            times = [float(t) for t in re.findall(rf"(?m)^! {re.escape(method)}: (?:at )?t = ([\d.]+) s[:,] ", compared)]
            self.assertGreater(len(times), 1, method)
            self.assertEqual(times, sorted(times), method)

    def test_a_loop_that_cannot_be_closed_names_what_was_changed(self):
        for command in (["run"], ["compare"], ["study", "four-bar", "budget"]):
            words = [*command, *([] if len(command) > 1 else ["four-bar"]), "--set", "l1=50", "--set", "l2=1.2"]
            done = call(*words)
            self.assert_exit(done, INPUT)
            told = done.stderr.decode()
            self.assertIn("with l1 = 50 m (0.5 in the scene), loop B cannot be closed: the side ground+crank is", told)
            self.assertIn("m are missing with th1 = 1 held", told)
            self.assertIn("go back towards l1 = 0.5 (usually 0.1 to 3 m), or", told)
            self.assertNotIn("make ", told)  # a rocker of 48 m

    def test_a_loop_that_cannot_be_closed_cuts_no_name_of_what_was_changed(self):
        changed = {"l1": 50, "l2": 1.23456, "l3": 2.345, "l4": 0.8765, "m1": 2, "m2": 3.25, "m3": 1.2345, "g": 3.71}
        done = call("run", "four-bar", *(word for name, value in changed.items() for word in ("--set", f"{name}={value}")))
        self.assert_exit(done, INPUT)
        whole = r"\w+ = [\d.]+(?: \S+)? \([\d.]+ in the scene\)"
        listed = re.match(rf"holonom: with ({whole}(?:, {whole})*)(?: and (\d+) more)?, loop B cannot be closed", done.stderr.decode())
        self.assertTrue(listed, done.stderr)
        self.assertEqual(len(re.findall(whole, listed[1])) + int(listed[2] or 0), len(changed))

    def test_compare_keeps_a_method_that_failed_and_says_which(self):
        done = call("compare", "four-bar", "--methods", "index1@euler:h=0.05", "projection@rk4:h=1e-3", "--time", "60")
        text = self.assert_exit(done, ENDED)
        self.assertRegex(text, r"(?m)^index1@euler\S* +ENDED EARLY")
        self.assertRegex(text, r"(?m)^projection@rk4\S* +(right|not judged) ")
        self.assertIn(b"index1@euler", done.stderr)

    def test_samples_appear_as_they_are_made(self):
        # nearly as many steps as are allowed; the first rows are there long before its end
        for form, first in (("csv", b"t,th1"), ("ndjson", b'{"scene":"four-bar"')):
            words = [driver.PROGRAM, "run", "four-bar", "--method", "index1@rk4:h=1e-6", "--time", "49", "--every", "1e-3", "--format", form]
            with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as run:
                try:
                    lines = [run.stdout.readline() for _ in range(3)]
                    self.assertIsNone(run.poll())
                finally:
                    run.kill()
            self.assertTrue(lines[0].startswith(first), lines[0])
            self.assertEqual([float(line.strip(b"[]\n").split(b",")[0]) for line in lines[1:]], [0, 1e-3])
        # a row has the numbers of the document
        words = ("run", "driven-crank", "--method", "index3@genalpha:h=1e-3", "--raw-lambda", "--reactions", "--at", "0,0.5")
        samples = strict(self.assert_exit(call(*words, "--json"), DONE))["samples"]
        rows = list(csv.reader(io.StringIO(self.assert_exit(call(*words), DONE))))
        flat = []
        for key in ("t", "q", "v", "lambda", "raw_lambda", "lambda_mark", "reaction_force", "reaction_moment", "effort", "points",
                    "gap", "velocity_gap", "energy", "work", "energy_change"):
            value = samples[key][1]
            flat += value if isinstance(value, list) else [value]
        self.assertEqual(len(rows[0]), len(flat))
        self.assertEqual([float(x) if x else None for x in rows[2]], flat)

    def test_a_run_ends_at_the_time_asked_for(self):
        words = ("four-bar", "--method", "projection@rk4:h=0.013", "--time", "10", "--json")
        run = strict(self.assert_exit(call("run", *words), DONE))
        self.assertEqual((run["samples"]["t"][-1], run["t_reached"]), (10, 10))
        summary = strict(self.assert_exit(call("compare", "four-bar", "--methods", "projection@rk4:h=0.013", "--time", "10", "--json"), DONE))
        self.assertEqual((summary["t"], summary["methods"][0]["t_reached"]), (10, 10))

    def test_a_setting_beyond_its_range_is_taken_with_a_remark(self):
        done = call("run", "car-axis", "--set", "eps=0.001", "--at", "0.1")
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertIn(b"eps = 0.001 is outside its range, 0.002 to 0.1", done.stderr)
        for refused in ("car-axis", "eps=-0.01"), ("ring", "n=1000000"):
            self.assertEqual(call("run", refused[0], "--set", refused[1]).returncode, INPUT)

    def test_a_start_value_that_the_loops_do_not_allow_is_told(self):
        done = call("run", "four-bar", "--set", "start.th1=1.5", "--at", "0")
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertIn(b"th1 starts at 1.32798, not at 1.5: assembly begins at the values that are set and changes them to close the loops; "
                      b"set th1_0 to hold it", b" ".join(done.stderr.split()))
        # a whole start that closes the loops is taken as it is
        same = call("run", "four-bar", *(f"--set=start.{one}" for one in ("th1=1.5", "a2=-1.2688199598248793", "th3=1.313666497269339")), "--at", "0")
        self.assertNotIn(b"starts at", same.stderr)
        self.assertRegex(same.stdout, rb"\n0,1\.5,")

    def test_the_verdict_on_a_failed_run_does_not_depend_on_the_times_asked_for(self):
        # the second is off by 0.96 at its end, at 0.72 s, and by more than 1 shortly before
        for method, end in ("index1@euler:h=0.02", 0.72), ("index1@euler:h=0.03", 0.66):
            for wanted in (["--time", "1"], ["--time", "30"], ["--time", "100"], ["--time", "100", "--at", "0.03,100"]):
                done = json.loads(call("run", "slider-crank", "--method", method, *wanted, "--json").stdout)
                self.assertEqual((done["status"], done["verdict"]["is"]), ("diverged", "wrong"), (method, wanted))
                self.assertAlmostEqual(done["t_reached"], end, delta=1e-9)
                # its last state is compared, however far apart the times of the other comparisons are
                self.assertAlmostEqual(done["error_estimate"]["t"], end, delta=1e-9)
            among = json.loads(call("compare", "slider-crank", "--methods", method, "--time", "30", "--json").stdout)["methods"][0]
            self.assertEqual(among["verdict"]["is"], "wrong")

    def test_every_run_has_an_estimate_of_its_error(self):
        far = call("run", "four-bar", "--method", "index1@rk4:h=1e-2", "--at", "10")
        self.assertRegex(far.stderr.decode(), r"the motion is wrong: up to t = 10 s the coordinates are estimated to be off by up to 1\.8 .*; a smaller step may help\n")
        near = call("run", "four-bar", "--method", "projection@rk4:h=1e-3", "--at", "1", "--json")
        estimate = json.loads(near.stdout)["error_estimate"]
        self.assertEqual((estimate["t"], estimate["reason"]), (1, ""))
        self.assertLess(max(estimate["q"], estimate["v"], estimate["reaction"]), 1e-6)
        # the verdict is another question than whether the run reached its end
        verdicts = []
        for method, time, scene in ("projection@rk4:h=1e-3", "1", ["four-bar"]), ("index1@rk4:h=1e-2", "10", ["four-bar"]), \
                ("projection@rk4:h=0.02", "2", ["four-bar"]), ("projection@rk4:h=1e-3", "0.01", ["n-four-bar", "--set", "N=200"]):
            done = json.loads(call("run", *scene, "--method", method, "--time", time, "--at", time, "--json").stdout)
            self.assertEqual(done["status"], "ok")
            verdicts.append(done["verdict"]["is"])
            estimate = done["error_estimate"]
            if estimate["q"] is not None:
                self.assertEqual((estimate["off"], estimate["unit"]), (estimate["q"], "rad"))
                self.assertIn(f"off by up to {estimate['q']:.2g} rad ({estimate['coordinate']})", done["verdict"]["text"])
        self.assertEqual(verdicts, ["right", "wrong", "inaccurate", "unknown"])
        # a mechanism without constraint rows has no reactions that could be off
        tree = json.loads(call("run", "pendulum", "--time", "1", "--json").stdout)
        self.assertIsNone(tree["error_estimate"]["reaction"])
        self.assertEqual(tree["verdict"]["is"], "right")
        self.assertNotIn("reaction", tree["verdict"]["text"])
        # a coordinate that is a length is off by metres: those from a tight run at the same times
        heights, estimates = [], []
        for method in "index1@rk4:h=0.05", "projection@dop853:rtol=1e-10":
            done = json.loads(call("run", "scott-russell", "--method", method, "--time", "1", "--every", "0.005", "--json").stdout)
            heights.append([q[done["coordinates"].index("y")] for q in done["samples"]["q"]])
            estimates.append(done["error_estimate"])
        apart = max(abs(a - b) for a, b in zip(*heights))
        self.assertEqual((estimates[0]["coordinate"], estimates[0]["unit"]), ("y", "m"))
        self.assertAlmostEqual(estimates[0]["off"] / apart, 1, delta=0.01)
        # no motion is right that an incident calls wrong, however short the part that was compared
        for method, t in ("projection@dop853:h=0.1", "40"), ("projection@dop853:h=0.1", "60"), ("projection@rk4:h=0.13", "60"):
            done = json.loads(call("run", "four-bar", "--method", method, "--time", t, "--at", t, "--json").stdout)
            self.assertIn("energy-jump", [i["code"] for i in done["incidents"]])
            self.assertIn(done["verdict"]["is"], ("wrong", "inaccurate"), (method, t))
            # an estimate that says it already needs no incident
            told = r"; at t = [\d.]+ s the energy jumped$" if done["error_estimate"]["q"] < 1 else r"off by up to 1\.2 "
            self.assertRegex(done["verdict"]["text"], told)
            among = json.loads(call("compare", "four-bar", "--time", t, "--methods", method, "--json").stdout)["methods"][0]
            self.assertIn(among["verdict"]["is"], ("wrong", "inaccurate"), (method, t))
        # a step longer than the run: its output is judged all the same
        long = ("four-bar", "--time", "1")
        alone = json.loads(call("run", *long, "--method", "projection@rk4:h=2", "--at", "1", "--json").stdout)
        among = json.loads(call("compare", *long, "--methods", "projection@rk4:h=2", "--json").stdout)["methods"][0]
        self.assertEqual([(d["t_reached"], d["verdict"]["is"]) for d in (alone, among)], [(1, "wrong")] * 2)
        stuck = json.loads(call("run", "four-bar", "--method", "index3@genalpha:h=5", "--time", "1", "--at", "1", "--json").stdout)
        self.assertEqual((stuck["t_reached"], stuck["verdict"]["is"]), (0, "unknown"))
        compared = call("compare", "four-bar", "--methods", "index1@rk4:h=1e-2", "projection@rk4:h=1e-3", "--time", "10", "--json")
        self.assertEqual([m["verdict"]["is"] for m in json.loads(compared.stdout)["methods"]], ["wrong", "right"])
        # a tolerance bounds the error of a step: what is more than ten times as much is said as a multiple
        loose = call("run", "four-bar", "--method", "ggl@ida:rtol=1e-6,safety=1", "--time", "5", "--at", "5", "--json")
        told = json.loads(loose.stdout)["error_estimate"]
        self.assertGreater(told["over_rtol"], 10)
        self.assertAlmostEqual(told["over_rtol"] / (told["q"] / 1e-6), 1, delta=1e-6)
        said = call("run", "four-bar", "--method", "ggl@ida:rtol=1e-6,safety=1", "--time", "5", "--at", "5").stderr.decode()
        self.assertIn(f"; that is {told['over_rtol']:.0f} times rtol, which limits the error of one step only", said)
        table = call("compare", "four-bar", "--methods", "ggl@ida:rtol=1e-6,safety=1", "projection@rk4:h=1e-3", "--time", "5", "--wide").stdout.decode()
        self.assertRegex(table, r"ggl@ida.* \d+ rtol ")
        self.assertEqual(table.count(" rtol "), 1)
        self.assertIsNone(estimate["over_rtol"])
        # the work that a drive does is no change of energy
        driven = json.loads(call("run", "driven-crank", "--method", "projection@rk4:h=1e-3", "--at", "1", "--json").stdout)
        samples = driven["samples"]
        self.assertGreater(abs(samples["work"][0]), 0.1)
        self.assertLess(abs(samples["energy_change"][0]), 1e-8)
        self.assertLess(driven["worst_energy_change"], 1e-8)

    def test_no_sample_is_beyond_the_last_state_that_was_sound(self):
        # the step from 0.5 s grows beyond every bound, and so does the motion inside it
        done = call("run", "bennett", "--method", "index1@rk4:h=0.1", "--time", "5", "--at", "0.5,0.525")
        self.assert_exit(done, ENDED)
        rows = done.stdout.decode().splitlines()[1:]
        self.assertEqual([row.split(",")[0] for row in rows], ["0.5"])
        self.assertIn("up to t = 0.5 s the coordinates are estimated", done.stderr.decode())

    def test_what_was_noticed_is_said_beside_the_samples(self):
        for form in "csv", "ndjson":
            done = call("run", "parallelogram", "--method", "projection@dop853:rtol=1e-6", "--time", "0.5", "--at", "0.5", "--format", form)
            self.assert_exit(done, DONE)
            said = done.stderr.decode().splitlines()
            # flat at 0.3448 s and at 0.679 s, announced before; at 0.5 s the second lies ahead still
            self.assertEqual(len(said), 4, said)
            self.assertRegex(said[0], r"^holonom: t = 0\.20\d* s: a singular configuration \(J loses rank\) lies .* ahead, at t = 0\.3448 s")
            self.assertRegex(said[1], r"^holonom: t = 0\.34\d* s: one step of .* 2 degrees of freedom there instead of 1")
            self.assertRegex(said[2], r"^holonom: t = 0\.3\d* s: a singular configuration .* ahead, at t = 0\.67\d* s")
            self.assertRegex(said[3], r"^holonom: the motion is \w+: up to t = 0\.5 s ")

    def test_run_and_compare_estimate_the_same_error(self):
        """The forces peak for 0.02 s: what is compared at few times sees too little, and divides by too little."""
        words = ["four-bar", "--time", "2", "--json"]
        run = json.loads(call("run", *words, "--method", "index1@rk4:h=1e-2").stdout)["error_estimate"]
        pair = json.loads(call("compare", *words, "--methods", "index1@rk4:h=1e-2", "projection@rk4:h=5e-3").stdout)["methods"][0]["error_estimate"]
        for key in ("q", "v", "reaction"):
            # the pilot makes the same steps but for the last bits
            self.assertAlmostEqual(run[key] / pair[key], 1, delta=1e-6, msg=key)
        # compared at each step of 0.5 ms, and divided by the peak of the pilot at such steps, it is 0.00123
        self.assertAlmostEqual(run["reaction"] / 0.00123, 1, delta=0.1)

    def test_progress_is_shown_to_a_terminal_and_to_nobody_else(self):
        words = [driver.PROGRAM, "run", "four-bar", "--method", "index1@rk4:h=4e-5", "--time", "200", "--at", "200"]
        piped = subprocess.run(words, capture_output=True, timeout=300 * driver.SLOW)
        self.assertEqual(piped.returncode, DONE)
        self.assertRegex(piped.stderr, rb"\Aholonom: the motion is right as far as it was judged: [^\n]*; the error after that was not estimated \([^\n]*\)\n\Z")  # the verdict, and no progress
        terminal, end = pty.openpty()
        process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=end)
        os.close(end)
        seen = b""
        try:
            while piece := os.read(terminal, 4096):
                seen += piece
        except OSError:  # the other end is closed
            pass
        self.assertEqual(process.stdout.read(), piped.stdout)
        self.assertEqual(process.wait(), DONE)
        process.stdout.close()
        os.close(terminal)
        self.assertRegex(seen.decode(), r"running \[[#.]+\] +\d+ %")


if __name__ == "__main__":
    driver.main()
