# SPDX-License-Identifier: GPL-3.0-or-later
"""Every route answers, in the shape that the OpenAPI document promises."""

import gzip
import json
import math
import os
import re
import subprocess
import tempfile
import unittest
import urllib.parse

import jsonschema

import driver

METHODS = ["index1@rk4:h=1e-3", "projection@rk4:h=1e-3"]


class Catalogue(driver.ServerCase):
    def test_every_answer_names_the_build(self):
        """Version, hash of the sources, compiler."""
        build = self.server.ask("GET", "/api/v1/").json()["build"]
        self.assertRegex(build, r"^0\.1\.0 [0-9a-f]{12} (gcc|clang) [0-9]+\.")
        for method, path in (("GET", "/"), ("GET", "/healthz"), ("GET", "/nowhere"), ("POST", "/api/v1/terms"), ("GET", "/api/v1/scenes/four-bar")):
            self.assertEqual(self.server.ask(method, path).headers["holonom-build"], build, path)

    def get(self, path):
        answer = self.server.ask("GET", path)
        self.assertEqual(answer.status, 200, answer.body[:300])
        self.assertEqual(answer.type, "application/json")
        return answer.json()

    def test_methods_say_which_pairs_fit(self):
        methods = self.get("/api/v1/methods")
        serves = {i["name"]: set(i["serves"]) for i in methods["integrators"]}
        for f in methods["formulations"]:
            self.assertEqual(set(f["integrators"]), {name for name, served in serves.items() if f["name"] in served})
        self.assertNotIn("index3", serves["rk4"])
        self.assertIn("index3", serves["radau5"])

    def test_health_says_ok(self):
        self.assertEqual(self.get("/healthz")["status"], "ok")
        self.assertEqual(self.get("/api/v1/healthz")["status"], "ok")

    def test_index_lists_links_limits_and_routes(self):
        index = self.get("/api/v1/")
        for link in index["links"].values():
            self.assertEqual(self.server.ask("GET", link).status, 200, link)
        self.assertGreater(index["limits"]["body_bytes"], 0)
        self.assertGreaterEqual(len(index["routes"]), 20)
        kinds = {k["code"]: k for k in index["incidents"]}
        self.assertIn("gap-open", kinds)
        self.assertTrue(all(k["name"] and k["rule"].endswith(".") for k in kinds.values()))

    def test_front_doors_lead_to_the_index(self):
        for path in ("/api", "/api/", "/api/v1"):
            answer = self.server.ask("GET", path)
            self.assertEqual(answer.status, 308)
            # relative, so that it holds below a prefix of a proxy too
            self.assertEqual(urllib.parse.urljoin("http://a/b" + path, answer.headers["location"]), "http://a/b/api/v1/")

    def test_each_scene_of_the_list_can_be_had(self):
        scenes = self.get("/api/v1/scenes")["scenes"]
        self.assertIn("four-bar", [s["id"] for s in scenes])
        for scene in scenes:
            with self.subTest(scene=scene["id"]):
                self.assertNotIn("errors", scene)
                document = self.get("/api/v1/scenes/" + scene["id"])
                self.assertEqual(document["id"], scene["id"])
                self.assertTrue(document["assembly"]["ok"])
                self.assertEqual(len(document["points"]), 3 * document["drawing"]["points"])

    def test_four_bar_has_one_freedom_and_closes(self):
        scene = self.get("/api/v1/scenes/four-bar")
        self.assertEqual(scene["dof"], 1)
        self.assertLess(scene["assembly"]["gap"], 1e-12)

    def test_a_scene_is_had_as_the_file_it_was_written_in(self):
        answer = self.server.ask("GET", "/api/v1/scenes/four-bar/document")
        self.assertEqual((answer.status, answer.json()["name"]), (200, "four-bar"))
        self.assertIn(b"\n", answer.body)
        self.assertEqual(self.server.ask("GET", "/api/v1/scenes/five-barr/document").status, 404)
        self.assertIn("joint", self.get("/api/v1/schema")["$defs"])

    def test_a_model_of_another_program_becomes_a_scene(self):
        text = ('<mujoco><worldbody><body name="arm"><joint name="j" axis="0 0 1"/>'
                '<geom type="sphere" pos="1 0 0" size="0.1" mass="2" rgba="1 0 0 1"/></body></worldbody></mujoco>')
        answer = self.server.ask("POST", "/api/v1/import", {"text": text, "name": "arm"}).json()
        scene = json.loads(answer["document"])
        self.assertEqual((answer["format"], scene["name"], scene["bodies"][0]["mass"]), ("MJCF", "arm", 2))
        self.assertTrue(answer["notes"])
        made = self.server.ask("POST", "/api/v1/assemble", {"scene": scene})
        self.assertEqual(made.status, 200)
        bad = self.server.ask("POST", "/api/v1/import", {"text": "<robot>"})
        self.assertEqual(bad.status, 422)
        self.assertIn("line", bad.json()["errors"][0]["detail"])

    def test_pictures_of_lessons_are_served_and_no_other_file(self):
        lesson = self.get("/api/v1/lessons")["lessons"][0]["id"]
        picture = self.server.ask("GET", f"/api/v1/lessons/{lesson}/pictures/four-bar.png")
        self.assertEqual((picture.status, picture.headers["content-type"]), (200, "image/png"))
        for path in ("..%2ftext.md", "four-bar.json", ".png", "a.b.png", "nothing.png"):
            self.assertEqual(self.server.ask("GET", f"/api/v1/lessons/{lesson}/pictures/{path}").status, 404, path)

    def test_joints_say_where_they_sit(self):
        scene = self.get("/api/v1/scenes/four-bar")
        self.assertEqual([b["name"] for b in scene["bodies"]], ["crank", "coupler", "rocker"])
        crank = scene["joints"][0]
        self.assertEqual((crank["type"], crank["parent"], crank["child_axis"]), ("revolute", -1, [0, 0, 1]))

    def test_a_setting_in_the_query_moves_the_scene(self):
        scene = self.get("/api/v1/scenes/four-bar")
        name, value = scene["parameters"][0]["name"], scene["parameters"][0]["value"] * 1.05
        moved = self.get(f"/api/v1/scenes/four-bar?set={name}:{value!r}")
        self.assertEqual(moved["parameters"][0]["value"], value)
        self.assertNotEqual(moved["points"], scene["points"])

    def test_methods_have_cards_with_settings(self):
        methods = self.get("/api/v1/methods")
        self.assertIn("baumgarte", [f["name"] for f in methods["formulations"]])
        self.assertIn("rk4", [i["name"] for i in methods["integrators"]])

    def test_look_lessons_and_problems_are_there(self):
        self.assertTrue(self.get("/api/v1/look"))
        lessons = self.get("/api/v1/lessons")["lessons"]
        self.assertTrue(any("four-bar" in lesson["scenes"] for lesson in lessons))
        lesson = self.get("/api/v1/lessons/1")
        self.assertEqual((lesson["number"], lesson["blocks"][0]["kind"]), (1, "heading"))
        self.assertEqual(self.get("/api/v1/lessons/" + lesson["id"]), lesson)
        problems = self.get("/api/v1/problems")["problems"]
        self.assertIn("p3", [p["id"] for p in problems])
        self.assertEqual(self.get("/api/v1/problems/p3")["id"], "p3")

    def test_hints_come_one_after_the_other(self):
        hints = self.get("/api/v1/problems/p1")["hints"]
        texts = [self.get(f"/api/v1/problems/p1?hint={i + 1}")["text"] for i in range(hints)]
        self.assertEqual(len(set(texts)), hints)
        self.assertGreater(hints, 1)
        for wrong in ("0", str(hints + 1), "x", "1x"):
            self.assertEqual(self.server.ask("GET", f"/api/v1/problems/p1?hint={wrong}").status, 422, wrong)

    def test_every_kind_of_error_has_a_page(self):
        for error in self.get("/api/v1/errors")["errors"]:
            self.assertEqual(self.get("/api/v1/errors/" + error["code"])["status"], error["status"])


class Compressed(driver.ServerCase):
    def test_text_is_zipped_for_who_takes_it(self):
        for path in ("/", "/main.js", "/api/v1/methods", "/api/v1/scenes/four-bar", "/api/v1/openapi.json"):
            plain = self.server.ask("GET", path)
            zipped = self.server.ask("GET", path, headers={"Accept-Encoding": "br, gzip;q=0.8"})
            self.assertNotIn("content-encoding", plain.headers, path)
            self.assertEqual(zipped.headers["content-encoding"], "gzip", path)
            self.assertIn("accept-encoding", zipped.headers["vary"].lower())
            self.assertEqual(gzip.decompress(zipped.body), plain.body, path)
            self.assertLess(len(zipped.body), len(plain.body) / 2 if len(plain.body) > 4000 else len(plain.body))
            refused = self.server.ask("GET", path, headers={"Accept-Encoding": "gzip;q=0.0, br"})
            self.assertEqual(refused.body, plain.body, path)
        run = {"scene": "four-bar", "method": "index1@rk4:h=1e-3", "time": 1}
        zipped = self.server.ask("POST", "/api/v1/runs", run, {"Content-Type": "application/json", "Accept-Encoding": "gzip"})
        self.assertEqual(len(json.loads(gzip.decompress(zipped.body))["samples"]["t"]), 201)


class Examples(driver.ServerCase):
    def test_every_body_has_an_example_that_is_served(self):
        document = self.server.ask("GET", "/api/v1/openapi.json").json()
        comparison, study, sent = self.server.compare()["id"], None, 0
        for path, operations in document["paths"].items():
            for verb in ("post", "patch"):
                if verb not in operations:
                    continue
                content = operations[verb]["requestBody"]["content"]["application/json"]
                address = path.replace("{id}", comparison if "comparisons" in path else study or "")
                answer = self.server.ask(verb.upper(), address, content["example"])
                self.assertIn(str(answer.status), operations[verb]["responses"], (path, answer.body[:300]))
                self.assertLess(answer.status, 300, (path, answer.body[:300]))
                study = answer.json()["id"] if path == "/api/v1/studies" else study
                sent += 1
        self.assertGreaterEqual(sent, 11)

    def test_every_operation_is_described_and_may_fail_by_name(self):
        document = self.server.ask("GET", "/api/v1/openapi.json").json()
        tags = {t["name"] for t in document["tags"]}
        self.assertEqual((document["servers"][0]["url"], document["security"]), ("/", [{}]))
        for path, operations in document["paths"].items():
            self.assertFalse(path.endswith("/"), path)
            for verb, operation in operations.items():
                self.assertTrue(operation["description"] and set(operation["tags"]) <= tags, path)
                failures = [s for s in operation["responses"] if s.startswith("4")]
                self.assertIn("400", failures)
                self.assertEqual("404" in failures, "{" in path and verb != "delete", (verb, path))
                self.assertEqual("422" in failures, "requestBody" in operation or any(p["in"] == "query" for p in operation["parameters"]), (verb, path))


class Stateless(driver.ServerCase):
    def post(self, path, body, status=200):
        answer = self.server.ask("POST", "/api/v1/" + path, body)
        # a run is a resource: 201 where it is new, 200 where it was asked for before
        self.assertIn(answer.status, (200, 201) if path == "runs" and status == 200 else (status,), answer.body[:500])
        return answer

    def test_terms_solve_the_equations_they_show(self):
        t = self.post("terms", {"scene": "four-bar"}).json()
        for i in range(len(t["coordinates"])):
            left = sum(t["M"][i][j] * t["a"][j] for j in range(len(t["a"])))
            right = t["f"][i] + sum(t["J"][k][i] * t["lambda"][k] for k in range(len(t["lambda"])))
            self.assertAlmostEqual(left, right, delta=1e-9 * (1 + abs(right)))
        for k in range(len(t["rows"])):
            self.assertAlmostEqual(sum(t["J"][k][j] * t["a"][j] for j in range(len(t["a"]))), -t["gamma"][k], delta=1e-9)

    def test_reduced_terms_follow_from_the_whole_ones(self):
        for scene in ("four-bar", "five-bar", "3-rrr"):
            t = self.post("terms", {"scene": scene}).json()
            n, red = len(t["coordinates"]), t["reduced"]
            phi, r = red["Phi"], len(red["independent"])
            self.assertEqual([t["coordinates"].index(name) for name in red["independent"]],
                             [i for j in range(r) for i in range(n) if phi[i] == [float(k == j) for k in range(r)]])
            for i in range(r):
                for j in range(r):
                    mass = sum(phi[a][i] * t["M"][a][b] * phi[b][j] for a in range(n) for b in range(n))
                    self.assertAlmostEqual(red["M_r"][i][j], mass, delta=1e-12 * (1 + abs(mass)))
                left = sum(red["M_r"][i][j] * red["a_r"][j] + red["C_r"][i][j] * red["v_r"][j] for j in range(r))
                self.assertAlmostEqual(left + red["g_r"][i], red["tau_r"][i], delta=1e-11 * (1 + abs(red["tau_r"][i])))
                self.assertAlmostEqual(red["a_r"][i], t["a"][t["coordinates"].index(red["independent"][i])], delta=1e-10)
            for row, v in zip(phi, t["v"], strict=True):
                self.assertAlmostEqual(sum(p * u for p, u in zip(row, red["v_r"], strict=True)), v, delta=1e-12)

    def test_terms_tell_what_joints_carry(self):
        self.assertNotIn("reactions", self.post("terms", {"scene": "four-bar"}).json())
        t = self.post("terms", {"scene": "four-bar", "reactions": True}).json()
        by_name = {r["name"]: r for r in t["reactions"]}
        # the joint that closes the loop pushes its child with the multipliers of its rows, turned round
        for k in range(2):
            self.assertAlmostEqual(by_name["B"]["force"][k], -t["lambda"][k], delta=1e-12)
        self.assertTrue(all(r["determined"] for r in t["reactions"]))
        run = self.post("runs", {"scene": "four-bar", "method": "projection@rk4:h=1e-3", "time": 0.01, "at": [0, 0.01], "reactions": True}).json()
        self.assertEqual(run["carriers"], [r["name"] for r in t["reactions"]])
        flat = [x for r in t["reactions"] for x in r["force"]]
        for got, want in zip(run["samples"]["reaction_force"][0], flat, strict=True):
            self.assertAlmostEqual(got, want, delta=1e-9)

    def test_rows_of_formulas_are_told_as_efforts_along_coordinates(self):
        asked = {"scene": "fb0-lagrangian", "reactions": True}
        t = self.post("terms", asked).json()
        self.assertEqual(t["reactions"], [])
        self.assertEqual({e["unit"] for e in t["efforts"]}, {"N m"})
        for j, name in enumerate(t["coordinates"]):  # M a = f + J' lambda
            lacks = sum(m * a for m, a in zip(t["M"][j], t["a"], strict=True)) - t["f"][j]
            given = sum(e["value"] for e in t["efforts"] if e["coordinate"] == name)
            self.assertAlmostEqual(given, lacks, delta=1e-11 * (1 + abs(lacks)))
        run = self.post("runs", {**asked, "method": "projection@rk4:h=1e-3", "time": 0.01, "at": [0, 0.01]}).json()
        self.assertEqual(run["carriers"], [])
        for got, want in zip(run["samples"]["effort"][0], t["efforts"], strict=True):
            self.assertAlmostEqual(got, want["value"], delta=1e-9)
        self.assertEqual([e["name"] for e in run["efforts"]], [e["name"] for e in t["efforts"]])

    def test_terms_take_a_state(self):
        start = self.post("terms", {"scene": "pendulum"}).json()
        name = start["coordinates"][0]
        moved = self.post("terms", {"scene": "pendulum", "state": {name: 0.25}, "t": 1.5}).json()
        self.assertEqual((moved["q"][0], moved["t"]), (0.25, 1.5))

    def test_assembly_closes_the_loop(self):
        self.assertLess(self.post("assemble", {"scene": "four-bar"}).json()["gap"], 1e-12)

    def test_an_assembled_start_has_the_places_of_the_drawn_points(self):
        made = self.post("assemble", {"scene": "four-bar", "parameters": {"l1": 0.6}}).json()
        crank = math.dist(made["points"][0:3], made["points"][3:6])
        self.assertAlmostEqual(crank, 0.6, delta=1e-12)  # the two ends of the crank

    def test_a_coordinate_names_the_parameter_that_is_its_start(self):
        start = {one["name"]: (one["start_parameter"], one["rate_parameter"])
                 for one in self.server.ask("GET", "/api/v1/scenes/four-bar").json()["coordinates"]}
        self.assertEqual(start, {"th1": ("th1_0", "w1_0"), "a2": (None, None), "th3": (None, None)})

    def test_inspect_counts_operations(self):
        self.assertTrue(self.post("inspect", {"scene": "four-bar"}).json())

    def test_equations_come_in_three_forms(self):
        for form in ("text", "latex"):
            answer = self.post("equations", {"scene": "four-bar", "format": form}).json()
            self.assertEqual(answer["format"], form)
            self.assertGreater(len(answer["text"]), 100)
        position = self.post("equations", {"scene": "four-bar", "format": "json"}).json()["position"]
        self.assertEqual(position["independent"], ["th1"])
        self.assertEqual([line["name"] for line in position["steps"][0]["unknowns"]], ["theta_coupler", "th3"])

    def test_a_run_has_its_samples_in_columns(self):
        run = self.post("runs", {"scene": "four-bar", "method": METHODS[1], "time": 1, "every": 0.25}).json()
        self.assertEqual(run["status"], "ok")
        self.assertEqual(run["samples"]["t"], [0, 0.25, 0.5, 0.75, 1])
        self.assertEqual(len(run["samples"]["q"]), 5)
        self.assertLess(max(run["samples"]["gap"]), 1e-10)

    def test_multipliers_that_are_not_determined_are_marked(self):
        # at 1e-8 from flat the rows of a parallelogram are one; a second later they are two
        near = {"scene": "parallelogram", "parameters": {"th_0": 1e-8, "w_0": 1, "g": 0}}
        self.assertEqual(self.post("terms", {**near, "reactions": True}).json()["lambda_mark"], "one of many")
        run = self.post("runs", {**near, "method": "projection@rk4:h=1e-3", "time": 1, "at": [0, 1]}).json()
        self.assertEqual([run["lambda_marks"][m] for m in run["samples"]["lambda_mark"]], ["one of many", "determined"])
        # Bennett's linkage has rows to spare
        spare = self.post("runs", {"scene": "bennett", "method": METHODS[0], "time": 0.1, "at": [0, 0.1]}).json()
        self.assertEqual([spare["lambda_marks"][m] for m in spare["samples"]["lambda_mark"]], ["one of many"] * 2)
        self.assertEqual(self.post("terms", {"scene": "bennett"}).json()["lambda_mark"], "one of many")
        free = self.post("runs", {"scene": "pendulum", "method": METHODS[0], "time": 0.1}).json()
        self.assertNotIn("lambda_mark", free["samples"])

    def test_a_mechanism_is_dragged_from_answer_to_answer(self):
        body, state = {"scene": "four-bar", "coordinate": "th1"}, {}
        for target in (1.5, 2.5, 3.5, 4.5):
            dragged = self.post("drag", {**body, "target": [target], "state": state}).json()
            state = dragged["state"]
            self.assertEqual((dragged["end"], dragged["reason"]), ("reached", None))
            self.assertAlmostEqual(state["th1"], target, 8)
            self.assertLess(dragged["gap"], 1e-12)
        # the state is one that the terms know, closed in position and velocity
        terms = self.post("terms", {"scene": "four-bar", "state": state}).json()
        self.assertLess(max(abs(x) for x in terms["phi"]), 1e-12)
        # a point as far as the loops let it go, which is said
        far = self.post("drag", {"scene": "four-bar", "point": 1, "target": [3, 4]}).json()
        self.assertEqual((far["end"], far["reached"]), ("nearest", False))
        self.assertAlmostEqual(far["distance"], 4.5, 6)
        self.assertIn("no closed configuration near this one", far["reason"])
        for wrong, place in ((body, "/target"), ({**body, "target": [1, 2]}, "/target"), ({**body, "point": 1, "target": [1]}, "/point"),
                             ({"scene": "four-bar", "target": [1, 2]}, "/point"), ({"scene": "four-bar", "point": 99, "target": [1, 2]}, "/point"),
                             ({"scene": "four-bar", "coordinate": "b3", "target": [1]}, "/coordinate"),
                             ({**body, "target": [1], "state": {"th1": 1, "a2": 3, "th3": -2}}, "/state")):
            document = self.assert_problem(self.post("drag", wrong, 422), 422)
            self.assertEqual(document["errors"][0]["pointer"], place)

    def test_a_scene_is_exported_as_a_program_that_checks_itself(self):
        answer = self.server.ask("GET", "/api/v1/scenes/four-bar/export?language=c&set=l1:0.6&method=projection@rk4:h=1e-2")
        self.assertEqual((answer.status, answer.type), (200, "text/plain"))
        self.assertEqual(answer.headers["content-disposition"], 'attachment; filename="four-bar.c"')
        program = answer.body.decode()
        self.assertIn("projection@rk4:h=0.01", program.splitlines()[-1])
        by_body = self.post("export", {"scene": "four-bar", "parameters": {"l1": 0.6}, "language": "c", "method": "projection@rk4:h=1e-2"})
        self.assertEqual(by_body.body, answer.body)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "motion")
            subprocess.run(["gcc", "-std=c99", "-O1", "-x", "c", "-", "-o", path, "-lm"], input=answer.body, check=True)
            done = subprocess.run([path], capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stdout)
        # with blanks: the student's parts are marked
        for answer in (self.server.ask("GET", "/api/v1/scenes/four-bar/export?language=c&blanks=true"),
                       self.post("export", {"scene": "four-bar", "language": "c", "blanks": True})):
            self.assertEqual((answer.status, answer.body.count(b"YOUR PART")), (200, 4))
        self.assertNotIn(b"YOUR PART", self.server.ask("GET", "/api/v1/scenes/four-bar/export?language=c&blanks=false").body)
        unclear = self.server.ask("GET", "/api/v1/scenes/four-bar/export?language=c&blanks=1")
        self.assertEqual((unclear.status, unclear.json()["hint"]), (422, "blanks=true"))
        # every language that is listed, and what is not
        for language in self.server.ask("GET", "/api/v1/languages").json()["languages"]:
            one = self.server.ask("GET", "/api/v1/scenes/pendulum/export?language=" + language["name"])
            self.assertEqual(one.status, 200)
            self.assertTrue(one.headers["content-disposition"].endswith(language["suffix"] + '"'))
        # the method says how the program holds its loops, where a program can; another solver; the functions alone
        held = self.post("export", {"scene": "four-bar", "language": "cpp", "method": "baumgarte:alpha=3,beta=7@rk4", "solver": "eigen"}).body
        self.assertIn(b"ALPHA = 3.0, BETA = 7.0;", held)
        self.assertIn(b"Eigen/Dense", held)
        bare = self.server.ask("GET", "/api/v1/scenes/four-bar/export?language=c&style=skeleton").body
        self.assertNotIn(b"CHECK_A", bare)
        # the mechanism itself, with what it does not hold
        for ending, format in ((".xml", "mjcf"), (".urdf", "urdf")):
            answers = [self.server.ask("GET", "/api/v1/scenes/delta-robot/export?format=" + format),
                       self.post("export", {"scene": "delta-robot", "format": format})]
            self.assertEqual(answers[0].body, answers[1].body)
            self.assertEqual(answers[0].headers["content-disposition"], f'attachment; filename="delta-robot{ending}"')
            self.assertRegex(answers[0].body.decode(), r"<!--\n(.*\n)*left out: load 'drive 1'(.*\n)*-->\n$")
            self.assertEqual(self.post("import", {"text": answers[0].body.decode(), "name": "back"}).status, 200)
        for word, place in (("format=sdf", "/format"), ("format=mjcf&language=c", "/format"), ("style=bare", "/style"), ("solver=eigen", "/solver"),
                            ("language=c&solver=eigen", "/solver"), ("format=mjcf&method=index1@rk4", "/format")):
            wrong = self.assert_problem(self.server.ask("GET", "/api/v1/scenes/four-bar/export?" + word), 422)
            self.assertEqual(wrong["errors"][0]["pointer"], place, word)
        wrong = self.assert_problem(self.server.ask("GET", "/api/v1/scenes/four-bar/export?language=pyton"), 422)
        self.assertEqual((wrong["errors"][0]["pointer"], wrong["hint"]), ("/language", "did you mean 'python'?"))
        self.assert_problem(self.server.ask("GET", "/api/v1/scenes/four-bar/export?method=x@rk4"), 422)
        self.assert_problem(self.server.ask("GET", "/api/v1/scenes/four-ba/export"), 404)

    def test_a_run_gives_raw_multipliers_when_asked_for(self):
        body = {"scene": "four-bar", "method": "index2@midpoint:h=0.01", "time": 0.1, "every": 0.05}
        self.assertNotIn("raw_lambda", self.post("runs", body).json()["samples"])
        self.assertEqual(len(self.post("runs", {**body, "raw_lambda": True}).json()["samples"]["raw_lambda"]), 3)

    def test_a_run_gives_the_same_bits_twice(self):
        body = {"scene": "four-bar", "method": METHODS[0], "time": 0.5, "at": [0.1, 0.5]}
        first = self.post("runs", body)
        self.assertEqual(self.server.ask("DELETE", first.headers["location"]).status, 204)
        again = self.post("runs", body)
        self.assertEqual(again.status, 201)
        self.assertEqual(first.json()["samples"], again.json()["samples"])

    def test_a_run_that_ends_early_says_why_and_is_still_an_answer(self):
        run = self.post("runs", {"scene": "four-bar", "method": "index1@euler:h=0.5", "time": 500}).json()
        self.assertNotEqual(run["status"], "ok")
        self.assertTrue(run["reason"])
        self.assertLess(run["t_reached"], 500)
        failure = run["failure"]
        self.assertEqual(set(failure), {"code", "quantity", "value", "limit", "t", "message", "remedies"})
        self.assertEqual((failure["message"], failure["t"]), (run["reason"], run["t_reached"]))
        # the figures are those of the incident, and the comparison says the same
        incident = next(i for i in run["incidents"] if i["code"] == failure["code"])
        self.assertEqual([failure[k] for k in ("quantity", "value", "limit", "remedies")], [incident[k] for k in ("quantity", "value", "limit", "remedies")])
        self.assertGreater(failure["value"], failure["limit"])
        c = self.server.compare(methods=["index1@euler:h=0.5", "projection@rk4:h=0.01"], frame_dt=0.5)
        for _ in range(5):
            latest = self.server.ask("PATCH", c["links"]["self"], {"step": 1}).json()["latest"]["methods"]
        self.assertEqual((latest[0]["failure"]["code"], latest[1]["failure"]), (failure["code"], None))
        cut = self.post("runs", {"scene": "four-bar", "method": "index1@rk4:h=1e-3", "time": 1}).json()
        self.assertIsNone(cut["failure"])

    def test_a_scene_may_be_given_whole(self):
        text = open("lessons/01-closed-loops/scenes/pendulum.json").read()
        run = self.post("runs", {"scene": json.loads(text), "method": "index1@rk4:h=1e-3", "time": 0.1}).json()
        shipped = self.post("runs", {"scene": "pendulum", "method": "index1@rk4:h=1e-3", "time": 0.1}).json()
        self.assertEqual(run["samples"]["q"], shipped["samples"]["q"])

    def test_a_snapshot_is_a_png_of_the_size_asked(self):
        answer = self.post("snapshots", {"scene": "four-bar", "methods": METHODS, "time": 0.2, "width": 640, "height": 480})
        self.assertEqual(answer.type, "image/png")
        self.assertEqual(answer.body[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual((int.from_bytes(answer.body[16:20], "big"), int.from_bytes(answer.body[20:24], "big")), (640, 480))

    def test_grading_tells_right_from_wrong(self):
        right = {"J": [["-l1*sin(th1)", "-l2*sin(th2)", "l3*sin(th3)", "l4*sin(th4)"],
                       ["l1*cos(th1)", "l2*cos(th2)", "-l3*cos(th3)", "-l4*cos(th4)"]]}
        wrong = json.loads(json.dumps(right))
        wrong["J"][0][0] = "l1*sin(th1)"
        best = self.post("grade", {"problem": "p3", "submission": right}).json()
        less = self.post("grade", {"problem": "p3", "submission": wrong}).json()
        self.assertEqual(best["score"], best["max_score"])
        self.assertLess(less["score"], best["score"])


class Bounded(driver.ServerCase):
    LIMIT = 0.5 * driver.SLOW  # a sanitised program forms its equations within it too
    options = ("--run-cpu", str(LIMIT))

    def ask_cut(self, **fields):
        """A run that is cut at the bound; its document. Computing time is counted, so a busy machine changes nothing."""
        address = self.server.ask("POST", "/api/v1/runs?wait=0", fields).headers["location"]
        self.assertTrue(driver.until(lambda: self.server.ask("GET", address + "?wait=5").json()["state"] == "finished", 300))
        run = self.server.ask("GET", address).json()
        self.assertEqual(run["status"], "stopped", run.get("detail"))
        self.assertIn("computing time", run["reason"])
        self.assertLess(run["cost"]["cpu_seconds"], 2 * self.LIMIT, "the limit, and the look at the clock after it")
        return run

    def test_a_run_is_cut_however_often_its_samples_are_asked_for(self):
        run = self.ask_cut(scene="four-bar", method="index1@rk4:h=1e-6", time=9, every=1e-4)
        self.assertGreater(len(self.server.ask("GET", run["links"]["samples"] + "?fields=t").json()["rows"]), 10)

    def test_a_run_is_cut_however_long_one_step_takes(self):
        self.ask_cut(scene="ring", parameters={"n": 30}, method="nullspace@rk4:h=1e-3", time=100, every=10)


class Document(driver.ServerCase):
    """The OpenAPI document, and answers against its schemas."""

    def setUp(self):
        self.document = self.server.ask("GET", "/api/v1/openapi.json").json()

    def test_it_is_openapi_3_1_with_sound_references(self):
        self.assertTrue(self.document["openapi"].startswith("3.1."))
        text = json.dumps(self.document)
        for place in re.findall(r'"\$ref": "#/([^"]+)"', text):
            node = self.document
            for step in place.split("/"):
                self.assertIn(step, node, place)
                node = node[step]
        self.assertNotIn("nullable", text)

    def test_operations_have_ids_of_their_own_and_declare_their_parameters(self):
        ids = []
        for path, item in self.document["paths"].items():
            for verb, operation in item.items():
                self.assertIn(verb, ("get", "post", "patch", "delete"))
                ids.append(operation["operationId"])
                declared = [p["name"] for p in operation["parameters"] if p["in"] == "path"]
                self.assertEqual(re.findall(r"\{(\w+)\}", path), declared)
                self.assertTrue(any(code[0] == "2" for code in operation["responses"]))
                for name in ("description",):
                    for response in operation["responses"].values():
                        self.assertTrue(name in response or "$ref" in response)
        self.assertEqual(len(ids), len(set(ids)))

    def test_it_names_every_route_of_the_index(self):
        for route in self.server.ask("GET", "/api/v1/").json()["routes"]:
            self.assertIn(route["method"].lower(), self.document["paths"][route["path"].rstrip("/")])

    def test_schemas_are_json_schema_2020_12(self):
        for schema in self.document["components"]["schemas"].values():
            jsonschema.Draft202012Validator.check_schema(schema)
        for item in self.document["paths"].values():
            for operation in item.values():
                for content in operation.get("requestBody", {}).get("content", {}).values():
                    jsonschema.Draft202012Validator.check_schema(content["schema"])

    def validate(self, value, schema):
        root = {"$ref": "#/components/schemas/" + schema, "components": self.document["components"]}
        jsonschema.Draft202012Validator(root).validate(value)

    def test_answers_are_what_their_schemas_say(self):
        comparison = self.server.compare(methods=METHODS)
        self.validate(comparison, "Comparison")
        self.validate(comparison["latest"], "Frame")
        self.validate(self.server.ask("GET", "/api/v1/").json(), "Index")
        self.validate(self.server.ask("GET", "/api/v1/scenes").json(), "Scenes")
        self.validate(self.server.ask("GET", "/api/v1/scenes/four-bar").json(), "Scene")
        self.validate(self.server.ask("GET", "/api/v1/methods").json(), "Methods")
        self.validate(self.server.ask("GET", "/api/v1/scenes/four-bar/reference?every=0.5").json(), "Reference")
        self.validate(self.server.ask("GET", "/api/v1/nothing").json(), "Problem")
        run = {"scene": "four-bar", "method": METHODS[0], "time": 0.1}
        self.validate(self.server.ask("POST", "/api/v1/runs", run).json(), "Run")
        self.validate(self.server.ask("POST", "/api/v1/runs", {}).json(), "Problem")

    def test_the_request_schemas_accept_what_the_server_accepts(self):
        schema = self.document["paths"]["/api/v1/comparisons"]["post"]["requestBody"]["content"]["application/json"]["schema"]
        validator = jsonschema.Draft202012Validator(schema)
        validator.validate({"scene": "four-bar", "methods": METHODS, "speed": 2, "paused": False})
        self.assertFalse(validator.is_valid({"scene": "four-bar"}))
        self.assertFalse(validator.is_valid({"scene": "four-bar", "methods": METHODS, "sped": 2}))


class Page(driver.ServerCase):
    """Files of the page."""

    def test_the_front_page_comes_with_its_guards(self):
        answer = self.server.ask("GET", "/")
        self.assertEqual((answer.status, answer.type), (200, "text/html"))
        policy = answer.headers["content-security-policy"]
        self.assertIn("default-src 'self'", policy)
        self.assertNotIn("unsafe", policy)
        self.assertEqual(answer.headers["x-content-type-options"], "nosniff")
        self.assertNotIn("access-control-allow-origin", answer.headers)

    def test_a_known_tag_is_not_sent_again(self):
        first = self.server.ask("GET", "/index.html")
        again = self.server.ask("GET", "/index.html", headers={"If-None-Match": first.headers["etag"]})
        self.assertEqual((again.status, again.body), (304, b""))
        other = self.server.ask("GET", "/index.html", headers={"If-None-Match": '"other"'})
        self.assertEqual((other.status, other.body), (200, first.body))

    def test_scripts_have_the_type_a_browser_wants(self):
        page = self.server.ask("GET", "/").body.decode()
        scripts = re.findall(r'<script[^>]+src="([^"]+)"', page)
        self.assertTrue(scripts)
        for script in scripts:
            answer = self.server.ask("GET", "/" + script.lstrip("./"))
            self.assertEqual((answer.status, answer.type), (200, "text/javascript"), script)

    def test_an_address_is_never_a_path(self):
        for path in ("/../Makefile", "/%2e%2e/Makefile", "/..%2fMakefile", "/vendor/../../Makefile", "//etc/passwd",
                     "/package.json", "/node_modules/x", "/.git/config", "/index.html/", "/INDEX.HTML"):
            with self.subTest(path=path):
                self.assert_problem(self.server.ask("GET", path), 404, "not-found")

    def test_head_is_get_without_a_body(self):
        for path in ("/", "/api/v1/", "/api/v1/scenes/four-bar"):
            get, head = self.server.ask("GET", path), self.server.ask("HEAD", path)
            self.assertEqual((head.status, head.body), (200, b""))
            self.assertEqual(head.headers["content-type"], get.headers["content-type"])
            self.assertEqual(head.headers["content-length"], str(len(get.body)))


if __name__ == "__main__":
    driver.main()
