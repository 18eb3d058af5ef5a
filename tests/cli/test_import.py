# SPDX-License-Identifier: GPL-3.0-or-later
"""holonom import: files of other programs become scenes that the schema allows, and what is not taken over is told."""

import glob
import json
import os
import subprocess
import sys
import tempfile
import unittest

import jsonschema

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402

DONE, INPUT = 0, 2
HERE = "tests/import/"
FOUR_BAR_URDF = (HERE + "four-bar.urdf", "--loops", HERE + "four-bar.loops.json")
with open("core/scene/scene.schema.json") as f:
    SCHEMA = jsonschema.Draft202012Validator(json.load(f))


def call(*words, stdin=b""):
    return subprocess.run([driver.PROGRAM, *words], input=stdin, capture_output=True, timeout=60 * driver.SLOW)


class Import(unittest.TestCase):
    def done(self, *words, stdin=b""):
        result = call(*words, stdin=stdin)
        self.assertEqual(result.returncode, DONE, result.stderr[-600:])
        return result

    def test_every_example_is_a_scene_of_the_schema(self):
        examples = [(name,) for name in sorted(glob.glob(HERE + "*.xml")) + [HERE + "double-pendulum.urdf"]]
        self.assertGreaterEqual(len(examples), 5)
        for words in [*examples, FOUR_BAR_URDF]:
            scene = json.loads(self.done("import", *words).stdout)
            self.assertEqual([e.message for e in SCHEMA.iter_errors(scene)], [], words)

    def test_the_scene_runs(self):
        for words in ((HERE + "four-bar.xml",), FOUR_BAR_URDF):
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "scene.json")
                self.done("import", *words, "-o", path)
                run = json.loads(self.done("run", path, "--method", "projection@rk4:h=1e-3", "--time", "0.2", "--json").stdout)
                self.assertEqual(run["status"], "ok")
                self.assertLess(max(run["samples"]["gap"]), 1e-11)

    def test_one_degree_of_freedom_is_one(self):
        told = self.done("import", HERE + "four-bar.xml").stderr.decode()
        self.assertRegex(told, r" m and 1 degree of freedom; closure equations that depend on others: 0; that hold in every configuration: 1")

    def test_json_lists_the_notes_and_the_assembly(self):
        answer = json.loads(self.done("import", HERE + "four-bar.xml", "--json").stdout)
        self.assertEqual((answer["format"], answer["bodies"], answer["closing"]), ("MJCF", 3, 1))
        self.assertAlmostEqual(answer["mass"], 4.8, 12)
        self.assertEqual((answer["assembly"]["dof"], answer["assembly"]["vanished"]), (1, 1))
        self.assertLess(answer["assembly"]["gap"], 1e-14)
        self.assertEqual([(n["outcome"], n["line"]) for n in answer["notes"]], [("ignored", 11), ("ignored", 12), ("ignored", 16)])
        self.assertEqual(answer["scene"]["holonom"], 1)

    def test_a_loop_that_cannot_close_is_told_with_its_reason(self):
        with open(HERE + "four-bar.loops.json") as f:
            loops = json.load(f)
        loops["joints"][0]["child"]["at"] = [9, 0, 0]  # on the rocker: out of reach of crank and coupler
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "loops.json")
            with open(path, "w") as f:
                json.dump(loops, f)
            words = ("import", HERE + "four-bar.urdf", "--loops", path)
            assembly = json.loads(self.done(*words, "--json").stdout)["assembly"]
            self.assertFalse(assembly["ok"])
            self.assertIn("cannot be closed", assembly["reason"])
            self.assertIn("cannot be assembled: loop", self.done(*words).stderr.decode())

    def test_people_read_the_notes_on_standard_error(self):
        text = self.done("import", HERE + "leg.xml").stderr.decode()
        self.assertIn("line 21: refused: the inertia of a rotor", text)
        self.assertIn("line 43: refused", text)
        self.assertIn("1 approximated, 3 refused", text)

    def test_standard_input_is_read(self):
        with open(HERE + "four-bar.xml", "rb") as f:
            self.assertEqual(json.loads(self.done("import", "-", stdin=f.read()).stdout)["name"], "four-bar")

    def test_files_of_the_model_s_folder_are_included_and_no_others(self):
        with open(HERE + "four-bar.xml") as f:
            whole = f.read()
        world = whole.index("<worldbody>")
        end = whole.index("</worldbody>") + len("</worldbody>")
        with tempfile.TemporaryDirectory() as top:
            folder = os.path.join(top, "model")
            os.makedirs(os.path.join(folder, "parts"))

            def put(name, text):
                with open(os.path.join(folder, name), "w") as f:
                    f.write(text)
                return os.path.join(folder, name)

            put("parts/world.xml", "<mujoco>" + whole[world:end] + "</mujoco>")
            main = put("main.xml", whole[:world] + '<include file="parts/world.xml"/>' + whole[end:])
            answer = json.loads(self.done("import", main, "--json").stdout)
            self.assertEqual(answer["scene"], json.loads(self.done("import", HERE + "four-bar.xml", "--json").stdout)["scene"])
            self.assertIn("parts/world.xml", {n.get("file") for n in answer["notes"]})
            self.assertIn("parts/world.xml, line ", self.done("import", main).stderr.decode())

            with open(main, "rb") as f:
                result = call("import", "-", stdin=f.read())
            self.assertEqual(result.returncode, INPUT)
            self.assertIn("not known", result.stderr.decode())

            os.rename(os.path.join(folder, "parts", "world.xml"), os.path.join(top, "world.xml"))
            os.symlink(os.path.join(top, "world.xml"), os.path.join(folder, "parts", "world.xml"))
            result = call("import", main)
            self.assertEqual(result.returncode, INPUT)
            self.assertIn("a link that leads out of the model's folder", result.stderr.decode())
            os.remove(os.path.join(folder, "parts", "world.xml"))
            result = call("import", main)
            self.assertEqual(result.returncode, INPUT)
            self.assertIn("cannot read 'parts/world.xml': No such file", result.stderr.decode())

    def test_what_is_no_mechanism_is_at_fault(self):
        for text, says in ((b"", "line 1"), (b"<html/>", "<mujoco>"), (b"<mujoco><worldbody>", "line 1, column"),
                           (b"<mujoco>" + b" " * (5 << 20), "more than 4194304 bytes"),
                           (b"<!DOCTYPE a [<!ENTITY a 'aaaa'><!ENTITY b '&a;&a;&a;'>]><mujoco model='&b;'/>", "document type"),
                           (b"<mujoco>" + b"<body>" * 100000, "nested far too deep")):
            result = call("import", "-", stdin=text)
            self.assertEqual((result.returncode, result.stdout), (INPUT, b""), text[:60])
            self.assertIn(says, result.stderr.decode())
        self.assertEqual(call("import", "nowhere.xml").returncode, INPUT)
        self.assertEqual(call("import", HERE + "four-bar.xml", "--key", "nowhere").returncode, INPUT)
        self.assertEqual(json.loads(call("import", "-", "--json", stdin=b"<a/>").stdout)["status"], "input")


if __name__ == "__main__":
    driver.main()
