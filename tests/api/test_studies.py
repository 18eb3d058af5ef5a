# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies as resources: the documents of the command line, progress while they last, bounds, stopping, and what is left of them."""

import concurrent.futures
import json
import os
import subprocess
import tempfile
import time
import unittest

import driver

AT = "/api/v1/studies"
METHODS = ["index1@rk4:h=1e-3", "projection@rk4:h=1e-3"]
COMPUTING = 20 * driver.SLOW  # of one study [s]: what a server allows, and more of a program that sanitisers slow down
SERVER = () if driver.SLOW == 1 else ("--run-cpu", str(COMPUTING))
# counts alone: nothing in the document that a clock said
QUICK = {"scene": "pendulum", "kind": "work-precision", "methods": METHODS, "time": 0.5, "levels": 3, "samples": 0}
BUDGET = {"scene": "four-bar", "kind": "budget", "methods": METHODS, "time": 0.2}
MAP = {"scene": "four-bar", "kind": "stability", "methods": ["baumgarte:alpha=5,beta=5@rk4:h=1e-2"], "time": 0.5,
       "preset": "baumgarte", "columns": 4, "rows": 3}
# ten seconds of computing and more, ten times what any test here waits for
LONG = {"scene": "four-bar", "kind": "work-precision", "methods": METHODS, "samples": 10, "time": 60, "levels": 7}

# changes of QUICK, pointer of the fault, a word of its detail or hint
AT_FAULT = [
    ({"kind": "work-precison"}, "/kind", "work-precision"),
    ({"kind": None}, "/kind", "missing"),
    ({"methods": []}, "/methods", ""),
    ({"methods": METHODS[:1] * 13}, "/methods", "12"),
    ({"methods": ["index1@rk4", "indx1@rk4"]}, "/methods/1", "index1"),
    ({"scene": "pendulumm"}, "/scene", "pendulum"),
    ({"parameters": {"nonsense": 1}}, None, "nonsense"),
    ({"levels": 8}, "/levels", "7"),
    ({"levels": 1}, "/levels", "2"),
    ({"levels": 2.5}, "/levels", ""),
    ({"samples": -1}, "/samples", "0"),
    ({"samples": 11}, "/samples", "10"),
    ({"time_limit": 0}, "/time_limit", ""),
    ({"time_limit": COMPUTING + 1}, "/time_limit", f"0.001 to {COMPUTING} are allowed"),
    ({"time": 0}, "/time", ""),
    ({"time": 5000}, "/time", "3600"),
    ({"level": 3}, "/level", "levels"),
    ({"columns": 4}, "/columns", "work-precision"),
]


def but(body, **changes):
    return {k: v for k, v in {**body, **changes}.items() if v is not None}


def command_line(*words):
    """What `holonom study ... --json` prints, with nothing kept from before."""
    with tempfile.TemporaryDirectory() as cache:
        done = subprocess.run([driver.PROGRAM, "study", *words, "--json"], capture_output=True, check=True,
                              env=dict(os.environ, HOLONOM_CACHE=cache))
    return json.loads(done.stdout)


def start(server, body):
    answer = server.ask("POST", AT, body)
    assert answer.status == 202, answer.body[:500]
    study = answer.json()
    assert answer.headers["location"] == study["links"]["self"] == f"{AT}/{study['id']}"
    return study


def look(server, study):
    return server.ask("GET", study["links"]["self"]).json()


def wait(server, study, seconds=60, again=False):
    """The study when it has ended; its progress never falls. `again`: it was stopped before, and has a document from then."""
    end, before = time.monotonic() + seconds * driver.SLOW, 0
    while True:
        now = look(server, study)
        if now["state"] != "running":
            return now
        assert before <= now["progress"] <= 1, (before, now["progress"])
        assert (now["document"] is None) == (not again)
        before = now["progress"]
        assert time.monotonic() < end, now
        time.sleep(0.05)


class Failures(driver.ServerCase):
    """Why a part of a study failed is the same object as in a run."""

    options = SERVER

    KEYS = {"code", "quantity", "value", "limit", "t", "message", "remedies"}

    def check(self, failure, reason):
        self.assertEqual(set(failure), self.KEYS)
        self.assertTrue(failure["code"])
        self.assertEqual(failure["message"], reason)

    def check_figures(self, failure, cell):
        """The figure that the reason names, beyond its limit."""
        quantity, value, limit = failure["quantity"], failure["value"], failure["limit"]
        if quantity in ("gap", "energy"):
            self.assertEqual(value, cell[quantity])
            self.assertGreater(value, limit)
            self.assertIn("stand", failure["message"])
        elif cell["class"] in ("grew", "stopped"):
            self.assertEqual((quantity, value), ("t", cell["t"]))

    def test_points_of_a_work_precision_study(self):
        # the coarsest steps of an explicit method of first order end with the loops open
        study = wait(self.server, start(self.server, {"scene": "four-bar", "kind": "work-precision", "time": 5, "samples": 0, "levels": 4,
                                                      "methods": ["index1@euler", "projection@rk4"]}))
        points = [p for m in study["document"]["methods"] for p in m["points"]]
        failed = [p for p in points if p["state"] == "failed"]
        self.assertTrue(failed)
        for p in failed:
            self.check(p["failure"], p["reason"])
            self.assertEqual(p["failure"]["t"], p["t_reached"])
        self.assertTrue(all(p["failure"]["code"] == "diverged" and p["failure"]["remedies"] for p in failed), failed)
        self.assertTrue(any(p["state"] == "done" for p in points))
        self.assertTrue(all(p["failure"] is None for p in points if p["state"] != "failed"))

    def test_cells_of_a_map_and_rows_of_an_error_budget(self):
        study = wait(self.server, start(self.server, {"scene": "four-bar", "kind": "stability", "time": 2, "methods": ["baumgarte@rk4"]}))
        cells = [c for m in study["document"]["methods"] for row in m["rows"] for c in row]
        self.assertEqual({c["failure"] is None for c in cells}, {True, False})
        for c in cells:
            self.assertEqual(c["failure"] is None, not c.get("reason"))
            if c["failure"]:
                self.check(c["failure"], c["reason"])
                self.assertEqual(c["failure"]["code"], c["class"])
                self.check_figures(c["failure"], c)
        study = wait(self.server, start(self.server, {"scene": "four-bar", "kind": "budget", "time": 1,
                                                      "methods": ["index1@euler:h=0.5", "index3@trapezoidal:h=0.5", "projection@rk4:h=0.01"]}))
        rows = study["document"]["methods"]
        self.assertEqual([r["failure"] is None for r in rows], [r["state"] == "done" for r in rows])
        self.assertGreater(sum(r["failure"] is not None for r in rows), 0)
        for r in rows:
            if r["failure"]:
                self.check(r["failure"], r["reason"])
                # the incident that ended the run, as in a run
                self.assertIn(r["failure"]["code"], ("diverged", "newton-failed"))
                self.assertIn(r["failure"]["quantity"], ("gap", "t"))
                self.assertIsNotNone(r["failure"]["value"])
                if r["failure"]["quantity"] == "gap":
                    self.assertGreater(r["failure"]["value"], r["failure"]["limit"])


class Studies(driver.ServerCase):
    options = SERVER

    def test_work_precision_is_the_document_of_the_command_line(self):
        done = wait(self.server, start(self.server, QUICK))
        self.assertEqual((done["state"], done["reason"], done["progress"], done["time_left_s"]), ("finished", "", 1, 0))
        self.assertEqual((done["kind"], done["scene"], done["methods"]), ("work-precision", "pendulum", METHODS))
        same = command_line("pendulum", "work-precision", "--methods", *METHODS, "--time", "0.5", "--levels", "3",
                            "--samples", "0", "--time-limit", str(COMPUTING))
        self.assertEqual(done["document"], same)

    def test_budget_is_the_document_of_the_command_line(self):
        done = wait(self.server, start(self.server, BUDGET))
        self.assertEqual(done["state"], "finished")
        self.assertEqual(done["document"], command_line("four-bar", "budget", "--methods", *METHODS, "--time", "0.2"))

    def test_a_map_of_stability_is_the_document_of_the_command_line(self):
        done = wait(self.server, start(self.server, MAP))
        self.assertEqual(done["state"], "finished", done["reason"])
        same = command_line("four-bar", "stability", "--methods", *MAP["methods"], "--time", "0.5", "--preset", "baumgarte",
                            "--grid", "4x3", "--time-limit", str(COMPUTING))
        for document in (done["document"], same):
            self.assertGreater(document.pop("elapsed"), 0)
        self.assertEqual(done["document"], same)

    def test_a_map_without_a_preset_is_the_telling_one_with_the_largest_steps_beside_it(self):
        body = {"scene": "four-bar", "kind": "stability", "time": 1, "columns": 4, "rows": 3, "methods": ["projection@rk4", "baumgarte@rk4:h=1e-2"]}
        done = wait(self.server, start(self.server, body))
        self.assertEqual((done["state"], done["progress"]), ("finished", 1), done["reason"])
        document = done["document"]
        self.assertEqual((document["preset"], document["stiff"], document["telling"]), ("baumgarte", False, None))
        self.assertEqual([m["method"] for m in document["methods"]], ["baumgarte@rk4:h=0.01"])
        self.assertEqual([m["method"] for m in document["steps"]], ["projection@rk4", "baumgarte@rk4"])
        self.assertIn("the velocities are right to 1 %", document["steps"][0]["agreement"]["text"])
        # a stiff one is answered by the steps
        done = wait(self.server, start(self.server, {**body, "scene": "stiff-four-bar", "time": 0.1}))
        document = done["document"]
        self.assertEqual((document["preset"], document["stiff"], document["telling"], document["steps"]), ("limits", True, None, None))
        self.assertIsNone(document["x"])

    def test_a_map_over_a_parameter_loads_the_scene_with_each_value(self):
        body = but(MAP, methods=["projection@symplectic-euler"], preset=None, over="g=1..20:lin,h=1e-3..1e-1", time=0.3)
        done = wait(self.server, start(self.server, body))
        self.assertEqual(done["state"], "finished", done["reason"])
        x, y = done["document"]["x"], done["document"]["y"]
        self.assertEqual((x["name"], x["kind"], y["kind"]), ("g", "parameter", "step"))
        errors = [cell["error"] for cell in done["document"]["methods"][0]["rows"][0]]
        self.assertEqual(len(set(errors)), 4, "each column is another motion")
        # the values of the map are stronger than a parameter of the request
        done = wait(self.server, start(self.server, {**body, "parameters": {"g": 5}}))
        self.assertEqual(done["state"], "finished", done["reason"])
        again = [cell["error"] for cell in done["document"]["methods"][0]["rows"][0]]
        self.assertEqual(len(set(again)), 4)

    def test_faults_of_a_map_are_told_before_it_starts(self):
        for changes, pointer in (({"over": "h=1e-3..1e-1"}, "/over"), ({"preset": None, "over": "nonsense=1..2"}, None),
                                 ({"preset": "stiffness"}, "/preset"), ({"columns": 25}, "/columns"), ({"rows": 1}, "/rows"),
                                 ({"methods": MAP["methods"] * 5}, "/methods"), ({"levels": 3}, "/levels"),
                                 ({"preset": "stiffnes"}, "/preset")):
            with self.subTest(changes=changes):
                answer = self.server.ask("POST", AT, but(MAP, **changes))
                document = self.assert_problem(answer, 422)
                if pointer:
                    self.assertEqual(document["errors"][0]["pointer"], pointer)

    def test_a_report_is_one_file_to_save(self):
        for body, kind in ((QUICK, "work-precision"), (MAP, "stability"), (BUDGET, "budget")):
            done = wait(self.server, start(self.server, body))
            answer = self.server.ask("GET", done["links"]["report"])
            self.assertEqual((answer.status, answer.type), (200, "text/html"))
            self.assertEqual(answer.headers["content-disposition"], f'attachment; filename="holonom-{kind}.html"')
            self.assertIn(b"<svg", answer.body)
            self.assertNotIn(b'src="http', answer.body)
        running = start(self.server, LONG)
        self.assertNotIn("report", running["links"])
        self.assert_problem(self.server.ask("GET", running["links"]["self"] + "/report"), 404, "not-found")
        self.server.ask("DELETE", running["links"]["self"])

    def test_parameters_and_scenes_of_ones_own_are_studied(self):
        scene = json.load(open("lessons/01-closed-loops/scenes/pendulum.json"))
        own = wait(self.server, start(self.server, but(QUICK, scene=scene, parameters={"g": 5})))
        shipped = wait(self.server, start(self.server, but(QUICK, parameters={"g": 5})))
        other = wait(self.server, start(self.server, QUICK))
        self.assertEqual(own["parameters"], {"g": 5})
        points = [[m["points"] for m in done["document"]["methods"]] for done in (own, shipped, other)]
        self.assertEqual(points[0], points[1])
        self.assertNotEqual(points[0], points[2])

    def test_every_number_is_bounded_and_every_fault_is_told(self):
        for changes, pointer, word in AT_FAULT:
            with self.subTest(changes=changes):
                document = self.assert_problem(self.server.ask("POST", AT, but(QUICK, **changes)), 422, "invalid-input")
                fault = document["errors"][0]
                if pointer is not None:
                    self.assertEqual(fault["pointer"], pointer)
                self.assertIn(word, fault["detail"] + fault.get("hint", ""))
        self.assert_problem(self.server.ask("PATCH", f"{AT}/0", {"state": "paused"}), 422)
        self.assert_problem(self.server.ask("PATCH", f"{AT}/0", {"state": "running"}), 404)

    def test_the_index_tells_the_bounds_that_hold(self):
        index = self.server.ask("GET", "/api/v1/").json()
        kinds = {kind["name"]: {field["name"]: field for field in kind["fields"]} for kind in index["studies"]}
        wp, stability = kinds["work-precision"], kinds["stability"]
        for body, name, bound, change in (
            (QUICK, "methods", wp["methods"]["max"], lambda n: METHODS[:1] * n),
            (QUICK, "levels", wp["levels"]["max"], lambda n: n),
            (QUICK, "samples", wp["samples"]["max"], lambda n: n),
            (MAP, "methods", stability["methods"]["max"], lambda n: MAP["methods"] * n),
            (MAP, "columns", stability["columns"]["max"], lambda n: n),
            (MAP, "rows", stability["rows"]["max"], lambda n: n),
            (QUICK, "time_limit", wp["time_limit"]["max"], lambda n: n),
            (MAP, "time_limit", stability["time_limit"]["max"], lambda n: n),
            (BUDGET, "time_limit", kinds["budget"]["time_limit"]["max"], lambda n: n),
            (QUICK, "time", index["limits"]["comparison_duration_s"], lambda n: n)):
            with self.subTest(name=name, kind=body["kind"]):
                document = self.assert_problem(self.server.ask("POST", AT, but(body, **{name: change(bound + 1)})), 422)
                self.assertEqual(document["errors"][0]["pointer"], "/" + name)

    def test_the_index_lists_the_kinds_with_what_each_takes(self):
        kinds = {kind["name"]: kind for kind in self.server.ask("GET", "/api/v1/").json()["studies"]}
        self.assertEqual(set(kinds), {"work-precision", "stability", "budget"})
        presets = {preset["name"]: preset for preset in kinds["stability"]["presets"]}
        choices = next(f["choices"] for f in kinds["stability"]["fields"] if f["name"] == "preset")
        self.assertEqual(list(presets), choices)
        self.assertEqual(presets["baumgarte"]["chooses"], ["alpha", "beta"])
        self.assertEqual(presets["stiffness"]["units"], ["N/m", "N*m/rad"])
        self.assertEqual(presets["limits"]["units"], [])
        self.assertEqual(kinds["budget"]["title"], "where the error comes from")
        self.assertEqual(kinds["work-precision"]["chooses"], ["h", "rtol"])
        parts = kinds["budget"]["parts"]
        self.assertEqual([p["letter"] for p in parts["error"]], list("TFPDLR"))
        self.assertEqual([p["letter"] for p in parts["energy"]], list("TFPOW"))
        self.assertTrue(all(p["name"] and p["word"] and p["about"] for of in parts.values() for p in of))
        self.assertNotIn("parts", kinds["stability"])
        for kind in kinds.values():
            for field in kind["fields"]:
                self.assertTrue(field["about"], field)
                self.assertNotEqual(field["name"], "shard", "a part of a study is for the command line")

    def test_no_more_than_two_run_at_once_and_the_next_is_told_when_to_ask_again(self):
        running = [start(self.server, LONG) for _ in range(2)]
        answer = self.server.ask("POST", AT + "?wait=0", LONG)
        self.assert_problem(answer, 503, "studies-busy")
        self.assertGreater(int(answer.headers["retry-after"]), 0)
        listed = self.server.ask("GET", AT).json()["studies"]
        self.assertLessEqual({s["id"] for s in running}, {s["id"] for s in listed if s["state"] == "running"})
        for study in running:
            self.assertEqual(self.server.ask("DELETE", study["links"]["self"]).status, 204)
            self.assert_problem(self.server.ask("GET", study["links"]["self"]), 404, "not-found")
        end = time.monotonic() + 20 * driver.SLOW
        while (answer := self.server.ask("POST", AT + "?wait=0", QUICK)).status == 503:
            self.assertLess(time.monotonic(), end, "the places of deleted studies are not given back")
            time.sleep(0.1)
        self.assertEqual(wait(self.server, answer.json())["state"], "finished")

    def test_a_stopped_study_keeps_what_was_done(self):
        study = start(self.server, LONG)
        self.assertTrue(driver.until(lambda: look(self.server, study)["progress"] > 0.02))
        self.assertEqual(self.server.ask("PATCH", study["links"]["self"], {"state": "stopped"}).status, 200)
        done = wait(self.server, study, 20)
        self.assertEqual(done["state"], "stopped")
        self.assertIn("stopped on request", done["reason"])
        self.assertTrue(done["document"]["stopped"])
        states = [point["state"] for method in done["document"]["methods"] for point in method["points"]]
        self.assertTrue({"done", "failed"} & set(states), states)  # the coarsest steps end early, which is an outcome
        self.assertEqual(self.server.ask("DELETE", study["links"]["self"]).status, 204)

    def test_a_study_that_is_over_stays_as_it_is_whatever_it_is_told(self):
        done = wait(self.server, start(self.server, QUICK))
        for state in ("stopped", "running", "running"):
            answer = self.server.ask("PATCH", done["links"]["self"], {"state": state})
            self.assertEqual(answer.status, 200)
            self.assertEqual({**answer.json(), "elapsed_s": None}, {**done, "elapsed_s": None})
        self.assertEqual(look(self.server, done)["document"], done["document"])

    def test_finished_ones_make_room_for_others(self):
        first = wait(self.server, start(self.server, QUICK))
        for _ in range(16):
            last = wait(self.server, start(self.server, but(QUICK, levels=2, time=0.01)))
        self.assertLessEqual(len(self.server.ask("GET", AT).json()["studies"]),
                             self.server.ask("GET", "/api/v1/").json()["limits"]["studies_kept"])
        self.assert_problem(self.server.ask("GET", first["links"]["self"]), 404)
        self.assertEqual(look(self.server, last)["state"], "finished")


class GoingOn(driver.ServerCase):
    """PATCH {"state": "running"}: a study that was stopped goes on, and computes nothing twice."""

    options = SERVER

    # half a second of work, of which this limit leaves most out on any machine, the motion itself for a start
    CUT = but(MAP, columns=12, rows=12, time=20, time_limit=0.001)

    def tearDown(self):
        """All places are free again: a study that is seen to have ended has given its own back."""
        for study in self.running():
            self.server.ask("PATCH", f"{AT}/{study['id']}", {"state": "stopped"})
        self.assertTrue(driver.until(lambda: not self.running()))

    def running(self):
        return [s for s in self.server.ask("GET", AT).json()["studies"] if s["state"] == "running"]

    def go_on(self, study, **more):
        return self.server.ask("PATCH", study["links"]["self"] + "?wait=0", {"state": "running", **more})

    def stop_with_a_point(self, body):
        """The study, stopped when a part of it was done."""
        study = start(self.server, body)
        self.assertTrue(driver.until(lambda: look(self.server, study)["progress"] > 0.02))
        self.assertEqual(self.server.ask("PATCH", study["links"]["self"], {"state": "stopped"}).status, 200)
        return wait(self.server, study)

    def test_what_the_time_limit_left_out_is_computed_later_and_nothing_twice(self):
        study = wait(self.server, start(self.server, self.CUT))
        self.assertEqual(study["state"], "stopped", study["reason"])
        self.assertIn("time limit of 0.001 s", study["reason"])
        runs, cells, elapsed = 1, [], study["elapsed_s"]
        while study["state"] == "stopped":
            cells.append([c for m in study["document"]["methods"] for row in m["rows"] for c in row])
            answer = self.go_on(study, time_limit=min(COMPUTING, 0.001 * 2 ** runs))  # a slow machine gets there too
            self.assertEqual((answer.status, answer.json()["id"]), (200, study["id"]))
            self.assertIsNotNone(answer.json()["document"], "what was done is shown while the study goes on")
            study = wait(self.server, study, again=True)
            self.assertGreater(study["elapsed_s"], elapsed)
            elapsed, runs = study["elapsed_s"], runs + 1
        self.assertEqual((study["state"], study["reason"], study["progress"]), ("finished", "", 1))
        self.assertGreater(runs, 2)
        # a cell that had an outcome keeps it
        last = [c for m in study["document"]["methods"] for row in m["rows"] for c in row]
        for before in cells:
            for one, other in zip(before, last):
                if one["class"] != "pending":
                    self.assertEqual(one["class"], other["class"])
        whole = wait(self.server, start(self.server, but(self.CUT, time_limit=None)))
        for document in (whole["document"], study["document"]):
            document.pop("elapsed")
        self.assertEqual(study["document"], whole["document"])
        self.assertIn(b"<svg", self.server.ask("GET", study["links"]["report"]).body)

    def test_the_time_limit_of_going_on_has_the_bounds_of_a_study(self):
        study = wait(self.server, start(self.server, self.CUT))
        for wrong in (0, -1, COMPUTING + 1, "1"):
            document = self.assert_problem(self.go_on(study, time_limit=wrong), 422)
            self.assertEqual(document["errors"][0]["pointer"], "/time_limit")
        # of all its computing the first run has used some
        limit = self.go_on(study, time_limit=COMPUTING).json()["time_limit_s"]
        self.assertTrue(COMPUTING / 2 < limit < COMPUTING, limit)

    def test_a_study_that_was_stopped_goes_on_for_longer_than_was_left_of_its_limit(self):
        limit = 0.75 * COMPUTING
        study = self.stop_with_a_point(but(LONG, time_limit=limit))
        self.assertEqual((study["state"], study["time_limit_s"]), ("stopped", limit))
        # the computing took no longer than the study, so of its computing a quarter more is left than of its limit
        self.assertGreater(self.go_on(study).json()["time_limit_s"], limit - study["elapsed_s"] + 0.2 * COMPUTING)

    def test_a_study_that_was_stopped_before_its_first_point_goes_on(self):
        for kind in ("work-precision", "budget"):
            for _ in range(4):
                study = start(self.server, {"kind": kind, "scene": "four-bar", "time": 2, "samples": 0, "levels": 3} if kind == "work-precision"
                              else but(BUDGET, time=1))
                for _ in range(3):  # wherever the stop meets it
                    self.assertEqual(self.server.ask("PATCH", study["links"]["self"], {"state": "stopped"}).status, 200)
                    self.assertTrue(driver.until(lambda: look(self.server, study)["state"] != "running"))
                    self.assertIn(look(self.server, study)["state"], ("stopped", "finished"))
                    self.assertEqual(self.go_on(study).status, 200)
                self.assertTrue(driver.until(lambda: look(self.server, study)["state"] != "running"))
                done = look(self.server, study)
                self.assertEqual(done["state"], "finished", done["reason"])
                self.assertNotIn("memory", json.dumps(done["document"]))

    def test_turns_share_the_computing_time_of_one_study(self):
        server = driver.Server("--run-cpu", "1")
        try:
            study = start(server, LONG)
            at = study["links"]["self"]

            def is_refused():
                server.ask("PATCH", at, {"state": "stopped"})
                driver.until(lambda: look(server, study)["state"] != "running")
                answer = server.ask("PATCH", at, {"state": "running", "time_limit": 1})
                time.sleep(0.2)
                # where other work leaves it so little that no point was done it has failed, for the same reason
                used_up = "computing time is used up" in answer.json().get("detail", "")
                return answer.status == 409 and (used_up or "the computing time of one study" in look(server, study)["reason"])

            self.assertTrue(driver.until(is_refused, 120), look(server, study))
            self.assertIn(look(server, study)["state"], ("stopped", "failed"))
        finally:
            self.assertEqual(server.stop(), 0)

    def test_of_two_that_ask_at_once_one_starts_it(self):
        study = self.stop_with_a_point(LONG)
        before = self.server.ask("GET", AT).json()["studies"]
        with concurrent.futures.ThreadPoolExecutor(8) as hands:
            answers = list(hands.map(lambda _: self.go_on(study), range(8)))
        self.assertEqual({a.status for a in answers}, {200})
        self.assertEqual([s["id"] for s in self.server.ask("GET", AT).json()["studies"]], [s["id"] for s in before])
        # the other place is free: had it been started twice there would be none
        other = start(self.server, LONG)
        self.assert_problem(self.server.ask("POST", AT + "?wait=0", LONG), 503, "studies-busy")
        # stopping frees the place, and going on needs one
        self.assertEqual(self.server.ask("PATCH", study["links"]["self"], {"state": "stopped"}).status, 200)
        stopped = wait(self.server, study, again=True)
        third = start(self.server, LONG)
        self.assert_problem(self.go_on(stopped), 503, "studies-busy")
        self.assertEqual(self.server.ask("DELETE", stopped["links"]["self"]).status, 204)
        self.assert_problem(self.go_on(stopped), 404)
        self.assertEqual({s["id"] for s in self.running()}, {other["id"], third["id"]})

    def test_the_methods_of_a_budget_that_were_left_out_follow(self):
        study = self.stop_with_a_point(but(BUDGET, time=2, methods=["projection@rk4:h=1e-3", "index1@rk4:h=2e-3", "nullspace@rk4:h=1e-3"]))
        while study["state"] == "stopped":
            self.assertEqual(self.go_on(study).status, 200)
            study = wait(self.server, study, again=True)
        self.assertEqual((study["state"], study["progress"]), ("finished", 1))
        self.assertEqual([m["state"] for m in study["document"]["methods"]], ["done"] * 3)


class Bounded(unittest.TestCase):
    """Options of the server that bound a study."""

    def test_the_time_limit_is_the_same_wherever_it_is_told(self):
        server = driver.Server("--run-cpu", "7")
        try:
            index = server.ask("GET", "/api/v1/").json()
            self.assertEqual(index["limits"]["run_cpu_s"], 7)
            for kind in index["studies"]:
                field = next(f for f in kind["fields"] if f["name"] == "time_limit")
                self.assertEqual(field["max"], 7, kind["name"])
                self.assertIn("; 7 when left out", field["about"], kind["name"])
            document = server.ask("GET", "/api/v1/openapi.json").json()
            body = document["paths"]["/api/v1/studies"]["post"]["requestBody"]["content"]["application/json"]["schema"]
            while "$ref" in body:
                body = document["components"]["schemas"][body["$ref"].rsplit("/", 1)[1]]
            self.assertEqual(body["properties"]["time_limit"]["maximum"], 7)
            self.assertIn("; 7 when left out", body["properties"]["time_limit"]["description"])
            self.assertEqual(wait(server, start(server, QUICK))["time_limit_s"], 7)
        finally:
            self.assertEqual(server.stop(), 0)

    def test_computing_ends_where_the_server_says(self):
        limit = 0.1 if driver.SLOW == 1 else 0.7  # the smallest of these takes six times as long, and its equations a fifteenth
        server = driver.Server("--run-cpu", str(limit))
        try:
            large = {"scene": "ring", "parameters": {"n": 60}}  # a step of it takes milliseconds
            for body in (LONG, but(BUDGET, time=10), but(MAP, time=20, columns=24, rows=24), {**LONG, **large}, {**MAP, **large}):
                done = wait(server, start(server, body), 60)
                self.assertEqual(done["time_limit_s"], limit)
                self.assertIn(done["state"], ("stopped", "failed"), done["reason"])
                self.assertTrue(done["reason"])
        finally:
            self.assertEqual(server.stop(), 0)

    def test_equations_count_against_the_time_limit_of_a_study(self):
        """The ring of 60 links has its equations after some 2 s; the study ends before, and says why."""
        server, ring = driver.Server(), {"scene": "ring", "parameters": {"n": 60}, "time": 1, "time_limit": 0.3}
        try:
            for body in ({"kind": "work-precision", "methods": ["ggl@radau5", "nullspace@rk4"]}, {"kind": "stability", "methods": ["baumgarte@rk4:h=1e-2"]},
                         {"kind": "budget", "methods": ["index1@rk4:h=1e-2"]}):
                study = start(server, {**ring, **body})
                before = server.cpu()
                done = wait(server, study, 120)
                self.assertIn(done["state"], ("stopped", "failed"), body)
                self.assertIn("the time limit of 0.3 s", done["reason"], body)
                self.assertNotIn("memory", json.dumps(done))
                # a tape that is being made is finished first
                self.assertLess(server.cpu() - before, (0.3 + 1) * driver.SLOW, body)  # 2.7 s and more without the limit
        finally:
            self.assertEqual(server.stop(), 0)

    def test_what_nobody_touches_goes(self):
        server = driver.Server("--expiry", "0.3")
        try:
            done = wait(server, start(server, but(QUICK, time=0.01)))
            # asking for it would be touching it; the list is not
            self.assertTrue(driver.until(lambda: server.ask("GET", AT).json()["studies"] == []))
            self.assertEqual(server.ask("GET", done["links"]["self"]).status, 404)
        finally:
            self.assertEqual(server.stop(), 0)

    def test_the_server_ends_cleanly_while_studies_run(self):
        server = driver.Server(*SERVER)
        studies = [start(server, body) for body in (LONG, but(LONG, levels=6))]
        self.assertTrue(driver.until(lambda: any(look(server, study)["progress"] > 0 for study in studies)))
        self.assertEqual(server.stop(), 0, "".join(server.errors))
        self.assertIn("the server ends while 2 of its studies run; their results are lost", "".join(server.errors))

    def test_a_study_whose_journal_cannot_be_written_is_not_said_to_be_kept(self):
        """The limit on the size of files stands for a full disk; the server said that what the study had done was kept."""
        with tempfile.TemporaryDirectory() as folder:
            server = driver.Server("--runs", folder, *SERVER, program=["sh", "-c", 'trap "" XFSZ; ulimit -f 0; exec "$0" "$@"', driver.PROGRAM])
            study = start(server, LONG)
            self.assertTrue(driver.until(lambda: look(server, study)["progress"] > 0.3, 60))  # a point is done
            self.assertEqual(server.stop(), 0, "".join(server.errors))
            self.assertIn("could be written to the folder of --runs", "".join(server.errors))
            self.assertNotIn("is kept", "".join(server.errors))

    def test_a_study_goes_on_in_the_next_server_with_the_same_folder(self):
        body = {"scene": "four-bar", "kind": "work-precision", "time": 5, "samples": 0, "levels": 6,
                "methods": ["projection@rk4", "index1@rk4", "ggl@radau5"]}

        def points(document):
            return {(m["method"], p["method"]): (p["worst"], p["steps"]) for m in document["methods"] for p in m["points"] if p["state"] == "done"}

        with tempfile.TemporaryDirectory() as folder:
            server = driver.Server("--runs", folder, *SERVER)
            study = start(server, body)
            kept = os.path.join(folder, "studies")

            def lines():
                return sum(open(os.path.join(kept, name), "rb").read().count(b"\n") for name in os.listdir(kept) if name.endswith(".ndjson"))

            self.assertTrue(driver.until(lambda: lines() >= 3), os.listdir(kept))
            self.assertEqual(server.stop(), 0, "".join(server.errors))
            self.assertIn("what they have done is kept", "".join(server.errors))

            # a second name for the journal, which goes when the study is whole
            journal = [os.path.join(kept, name) for name in os.listdir(kept) if name.endswith(".ndjson")]
            self.assertEqual(len(journal), 1)
            with open(journal[0], "rb") as file:
                before = file.read()
            os.link(journal[0], os.path.join(folder, "seen"))

            # the same question: the lines that were kept stand, with the times measured then, and the rest is computed
            server = driver.Server("--runs", folder, *SERVER)
            try:
                study = wait(server, start(server, body))
                self.assertEqual(study["state"], "finished", study["reason"])
                self.assertEqual([n for n in os.listdir(kept) if n.endswith(".ndjson")], [])  # whole: nothing is left unfinished
                with open(os.path.join(folder, "seen"), "rb") as file:
                    whole = file.read()
                self.assertTrue(whole.startswith(before[:before.rindex(b"\n") + 1]))
                self.assertGreater(len(whole), len(before))
                again = wait(server, start(server, body))
                self.assertEqual(points(study["document"]), points(again["document"]))
            finally:
                self.assertEqual(server.stop(), 0)


if __name__ == "__main__":
    driver.main()
