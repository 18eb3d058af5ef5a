# SPDX-License-Identifier: GPL-3.0-or-later
"""holonom export --format mjcf and urdf: the mechanism itself. The file that import reads back moves as the scene does.

Every shipped scene is exported. LEFT_OUT lists what MJCF does not hold, scene by scene; the others are read back and run
beside the original, and coordinates of the same name, spins of balls and the energy agree along the way.
MuJoCo itself is not run here.
"""

import glob
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ET

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402

DONE, INPUT = 0, 2
TIME = 0.5
NEAR = 1e-6  # of the largest value: each run errs by some 1e-11 a step; a wrong place or rate shows in the second digit
METHOD = "projection@dop853:rtol=1e-11"

# scene: the things that MJCF does not hold, as the program names them
LEFT_OUT = {
    "five-bar": ["load 'left motor'", "load 'right motor'"],
    "cardan-shaft": ["joint 'U2'"],
    "delta-robot": ["load 'drive 1'", "load 'drive 2'", "load 'drive 3'", "constraint 'rod 1 right'",
                    "constraint 'rod 2 right'", "constraint 'rod 3 right'", "constraint 'rod 1 left'", "constraint 'rod 2 left'",
                    "constraint 'rod 3 left'"],
    "driven-crank": ["constraint 'drive'"],
    "planetary-gear": ["load 'motor'", "constraint 'sun and planet 1'", "constraint 'sun and planet 2'",
                       "constraint 'sun and planet 3'"],
    "rolling-wheel": ["constraint 'road'"],
    "seven-body-squeezer": ["load 'spring'"],
    "stewart-6-3": ["load 'drive 1'", "load 'drive 3'", "load 'drive 5'", "load 'drive 2'", "load 'drive 4'", "load 'drive 6'"],
    "stewart-6-6": ["load 'drive 1'", "load 'drive 3'", "load 'drive 5'", "load 'drive 2'", "load 'drive 4'", "load 'drive 6'"],
    "3-rrr": ["load 'motor 1'", "load 'motor 2'", "load 'motor 3'"],
    "pantograph": ["load 'hand'"],
    "quick-return": ["load 'motor'"],
}
# what URDF does not hold beside those; the motors of two scenes are switched off as shipped, so that nothing moves otherwise
BALLS = {"heavy-top", "rssr"}
LOADS = {"slider-crank": ["load 'motor'"], "cardan-shaft": ["load 'motor'"], "stiff-four-bar": ["stiffness of load 'spring'"]}
WITHOUT_BODIES = {"fb0-lagrangian", "four-angles-as-printed", "car-axis"}


def call(*words):
    return subprocess.run([driver.PROGRAM, *words], capture_output=True, text=True, timeout=120 * driver.SLOW)


def run(scene):
    result = call("run", scene, "--method", METHOD, "--time", str(TIME), "--every", "0.05", "--json")
    if result.returncode != DONE:
        raise AssertionError(scene + ": " + result.stderr[-600:])
    return json.loads(result.stdout)


def column(answer, kind, name):
    names = answer["coordinates" if kind == "q" else "rates"]
    return [row[names.index(name)] for row in answer["samples"][kind]]


def spin(answer, first):
    """The angular velocity of a ball, whatever its axes: its three rates begin at entry `first`."""
    return [math.hypot(*row[first:first + 3]) for row in answer["samples"]["v"]]


def rotation(r):
    """The matrix of a rotation vector."""
    angle = math.hypot(*r)
    x, y, z = (c / angle for c in r) if angle > 0 else (0, 0, 1)
    c, s = math.cos(angle), math.sin(angle)
    return [[c + x * x * (1 - c), x * y * (1 - c) - z * s, x * z * (1 - c) + y * s],
            [y * x * (1 - c) + z * s, c + y * y * (1 - c), y * z * (1 - c) - x * s],
            [z * x * (1 - c) - y * s, z * y * (1 - c) + x * s, c + z * z * (1 - c)]]  # fmt: skip


def turn(answer, first):
    """How a ball has turned since the start, nine columns: a model counts its rotation vector from the start, a scene from its own zero."""
    turns = [rotation(row[first:first + 3]) for row in answer["samples"]["q"]]
    at_start = turns[0]
    return [[sum(at_start[k][i] * now[k][j] for k in range(3)) for now in turns] for i in range(3) for j in range(3)]


def worst(a, b):
    """The largest difference of what both have: coordinates by name, turns and spins of balls, energy; relative to its largest value."""
    pairs = [(a["samples"]["energy"], b["samples"]["energy"])]
    for name in set(a["coordinates"]) & set(b["coordinates"]):
        pairs.append((column(a, "q", name), column(b, "q", name)))
    for i, name in enumerate(b["coordinates"]):
        if name.endswith("_rx"):
            pairs.append((spin(a, i), spin(b, i)))
            pairs += zip(turn(a, i), turn(b, i))
    return len(pairs), max(abs(x - y) / (1 + max(map(abs, p))) for p, r in pairs for x, y in zip(p, r))


def names():
    return sorted(os.path.basename(path)[:-5] for path in glob.glob("lessons/*/scenes/*.json"))


class Mechanism(unittest.TestCase):
    def written(self, scene, folder):
        """The model of a scene, and the lines about what is not in it."""
        path = os.path.join(folder, scene + ".xml")
        result = call("export", scene, "--format", "mjcf", "-o", path)
        self.assertEqual(result.returncode, DONE, result.stderr)
        return path, re.findall(r"^left out: (.*?'.*?'):", result.stderr, re.MULTILINE)

    def there_and_back(self, scene):
        """The motions of a scene that MJCF holds whole, and of what import reads back of its model."""
        with tempfile.TemporaryDirectory() as folder:
            own, model, back = (os.path.join(folder, f) for f in ("own.json", "model.xml", "back.json"))
            with open(own, "w") as f:
                json.dump(scene, f)
            result = call("export", own, "--format", "mjcf", "-o", model)
            self.assertEqual((result.returncode, result.stderr), (DONE, ""))
            self.assertEqual(call("import", model, "-o", back).returncode, DONE)
            return run(own), run(back)

    def test_what_mjcf_holds_moves_as_the_scene_does(self):
        held = [name for name in names() if name not in LEFT_OUT and name not in WITHOUT_BODIES]
        self.assertGreater(len(held), 20)
        for name in held:
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                path, left = self.written(name, folder)
                self.assertEqual(left, [])
                back = os.path.join(folder, "back.json")
                result = call("import", path, "-o", back)
                self.assertEqual(result.returncode, DONE, result.stderr)
                self.assertIn("0 approximated, 0 refused", result.stderr)
                n, error = worst(run(name), run(back))
                self.assertGreater(n, 1)
                self.assertLess(error, NEAR)

    def test_what_it_does_not_hold_is_named_and_the_rest_is_a_model(self):
        for name, expected in LEFT_OUT.items():
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                path, left = self.written(name, folder)
                self.assertEqual(left, expected)
                result = call("import", path, "-o", os.path.join(folder, "back.json"))
                self.assertEqual(result.returncode, DONE, result.stderr)
                self.assertIn("0 approximated, 0 refused", result.stderr)

    def test_names_are_unique_as_mujoco_asks(self):
        for name in set(names()) - WITHOUT_BODIES:
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                root = ET.parse(self.written(name, folder)[0]).getroot()
                for part in (root.iter("body"), root.find("worldbody").iter("joint"), root.find("equality"), root.find("actuator")):
                    found = [e.get("name") for e in part]
                    self.assertEqual(len(found), len(set(found)), found)

    def test_drives_and_gears_come_back(self):
        """A constant torque, a follower with a limit, a gear and a free body that flies and spins."""
        scene = {"holonom": 1, "name": "drives", "gravity": [0, -9.81, 0],
                 "bodies": [{"name": n, "mass": 1.5, "com": [0.3, 0.1, 0], "inertia": {"xx": 0.2, "yy": 0.25, "zz": 0.3, "xy": 0.02}}
                            for n in ("a", "b", "c & d", "flyer")],
                 "joints": [{"name": "A", "type": "revolute", "parent": {"body": "ground"}, "child": {"body": "a"}, "coordinate": "x"},
                            {"name": "B", "type": "revolute", "parent": {"body": "ground", "at": [2, 0, 0]}, "child": {"body": "b"},
                             "coordinate": "y"},
                            {"name": "C", "type": "universal", "parent": {"body": "a", "at": [1, 0, 0]}, "child": {"body": "c & d"},
                             "axis": [0, 1, 0], "axis2": [1, 0, 0], "coordinates": ["u", "w"]},
                            {"name": "F", "type": "free", "parent": {"body": "ground", "at": [0, 1, 0]},
                             "child": {"body": "flyer", "at": [0.2, 0, 0]}, "coordinates": ["fx", "fy", "fz", "f1", "f2", "f3"]}],
                 "loads": [{"name": "motor", "torque": {"coordinate": "x", "value": 2.5}},
                           {"name": "servo", "follow": {"coordinate": "u", "stiffness": 30, "damping": 2, "target": 0.4, "limit": 5}}],
                 "constraints": [{"name": "wheels", "gear": {"coordinates": ["x", "y"], "ratio": 2, "phase": 0.5}}],
                 "start": {"positions": {"x": 0.3, "y": {"guess": 0.1}, "u": 0.2, "w": -0.3, "f1": 0.4, "f2": 0.1, "f3": 0, "fy": 0.5},
                           "rates": {"d_x": 1, "d_u": -1, "d_f1": 2, "d_f3": 1, "d_fx": 0.5}}}
        n, error = worst(*self.there_and_back(scene))
        self.assertGreaterEqual(n, 6)  # energy, x, y, u, w, the flyer's spin
        self.assertLess(error, NEAR)

    def refused(self, scene, folder):
        path = os.path.join(folder, "scene.json")
        with open(path, "w") as f:
            json.dump(scene, f)
        result = call("export", path, "--format", "mjcf")
        self.assertEqual((result.returncode, result.stdout), (INPUT, ""))
        return result.stderr

    def test_welds_and_joints_that_are_written_from_the_body_to_the_ground(self):
        """The first joint has the ground as its child, a ball hangs from its own child, and a weld closes a loop."""
        bodies = [{"name": n, "mass": 1, "com": [0.4, 0, 0.1], "inertia": {"xx": 0.1, "yy": 0.2, "zz": 0.15}} for n in "abcd"]
        scene = {"holonom": 1, "name": "turned", "gravity": [0, -9.81, 0], "bodies": bodies,
                 "joints": [{"name": "A", "type": "cylindrical", "parent": {"body": "a"}, "child": {"body": "ground"},
                             "axis": [0, 0.6, 0.8], "coordinates": ["x", "s"]},
                            {"name": "B", "type": "spherical", "parent": {"body": "b"}, "child": {"body": "a", "at": [1, 0, 0]},
                             "coordinates": ["b1", "b2", "b3"]},
                            {"name": "C", "type": "revolute", "parent": {"body": "b", "at": [1, 0, 0]}, "child": {"body": "c"},
                             "coordinate": "y"},
                            {"name": "D", "type": "revolute", "parent": {"body": "b", "at": [1, 0, 0]}, "child": {"body": "d"},
                             "coordinate": "z"},
                            {"name": "W", "type": "fixed", "parent": {"body": "c"}, "child": {"body": "d"}, "cut": True}],
                 "start": {"positions": {"x": 0.3, "s": 0.2, "y": 0.4, "z": {"guess": 0.3}, "b1": 0.2, "b2": 0.1, "b3": 0.3},
                           "rates": {"d_x": 1, "d_s": 0.2, "d_b1": 2, "d_b2": -1, "d_b3": 0.5, "d_y": 1}}}
        a, b = self.there_and_back(scene)
        for name in ("x", "s", "y", "z"):
            for p, q in zip(column(a, "q", name), column(b, "q", name)):
                self.assertLess(abs(p - q), NEAR)
        self.assertLess(abs(a["samples"]["energy"][-1] - b["samples"]["energy"][-1]), NEAR * 10)

    def test_a_body_named_world_and_a_free_joint_between_bodies_are_refused(self):
        body = {"mass": 1, "inertia": {"xx": 1, "yy": 1, "zz": 1}}
        hinge = {"name": "A", "type": "revolute", "parent": {"body": "ground"}, "child": {"body": "world"}, "coordinate": "x"}
        free = {"name": "F", "type": "free", "parent": {"body": "a"}, "child": {"body": "b"},
                "coordinates": ["f1", "f2", "f3", "f4", "f5", "f6"]}
        with tempfile.TemporaryDirectory() as folder:
            one = {"holonom": 1, "name": "one", "bodies": [{"name": "world", **body}], "joints": [hinge]}
            self.assertIn("a body cannot be called 'world'", self.refused(one, folder))
            hinge = {**hinge, "child": {"body": "a"}}
            two = {"holonom": 1, "name": "two", "bodies": [{"name": n, **body} for n in "ab"], "joints": [hinge, free]}
            self.assertIn("a free joint in MJCF always begins at the world", self.refused(two, folder))

    def test_a_scene_of_formulas_is_refused(self):
        for name in WITHOUT_BODIES:
            result = call("export", name, "--format", "mjcf")
            self.assertEqual((result.returncode, result.stdout), (INPUT, ""))
            self.assertIn("consists of formulas", result.stderr)

    def test_an_unknown_format_and_options_of_programs_are_refused(self):
        for words, said in ((("--format", "sdf"), "--format mjcf or --format urdf"), (("--format", "mjcf", "--language", "c"), "--language"),
                            (("--format", "mjcf", "--blanks"), "--blanks")):
            result = call("export", "four-bar", *words)
            self.assertEqual((result.returncode, result.stdout), (INPUT, ""))
            self.assertIn(said, result.stderr)
        # a language is no format, and a format no language: each names the option of the other
        for words, said in ((("--format", "modelica"), "--language modelica writes a program"), (("--language", "urdf"), "--format urdf writes the mechanism")):
            result = call("export", "four-bar", *words)
            self.assertEqual(result.returncode, INPUT)
            self.assertIn(said, " ".join(result.stderr.split()))


class Urdf(unittest.TestCase):
    """The tree of a mechanism; with a loop file beside it, all that both hold moves to rounding as the scene does."""

    def written(self, scene, folder, *words):
        path = os.path.join(folder, "model.urdf")
        result = call("export", scene, "--format", "urdf", "-o", path, *words)
        self.assertEqual(result.returncode, DONE, result.stderr)
        return path, re.findall(r"^left out: (.*?):", result.stderr, re.MULTILINE)

    def round_trip(self, scene, folder, *allowed):
        """How many quantities were compared, and the largest difference; everything is held but what is allowed to miss."""
        loops, back = (os.path.join(folder, name) for name in ("loops.json", "back.json"))
        path, left = self.written(scene, folder, "--loops", loops)
        self.assertEqual(left, list(allowed))
        result = call("import", path, "--loops", loops, "-o", back)
        self.assertEqual(result.returncode, DONE, result.stderr)
        self.assertIn("0 refused", result.stderr)
        return worst(run(scene), run(back))

    def test_trees_and_loops_move_as_the_scene_does(self):
        held = [name for name in names() if name not in WITHOUT_BODIES | set(LEFT_OUT) | BALLS | set(LOADS)]
        self.assertGreater(len(held), 15)
        for name in held:
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                n, error = self.round_trip(name, folder)
                self.assertGreater(n, 1)
                self.assertLess(error, NEAR)

    def test_a_universal_joint_closes_a_loop_where_mjcf_has_none(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertLess(self.round_trip("cardan-shaft", folder, *LOADS["cardan-shaft"])[1], NEAR)
            self.assertLess(self.round_trip("slider-crank", folder, *LOADS["slider-crank"])[1], NEAR)
            self.assertGreater(self.round_trip("stiff-four-bar", folder, *LOADS["stiff-four-bar"])[1], 100 * NEAR)

    def test_chains_gears_dampers_limits_and_a_floating_body(self):
        """Joints of two and three coordinates, from either side; a mimic; a damper; turned frames; products of inertia."""
        bodies = [{"name": n, "mass": 1.5, "com": [0.3, 0.1, 0.2], "inertia": {"xx": 0.2, "yy": 0.25, "zz": 0.3, "xy": 0.02}}
                  for n in ("a", "b", "c & d", "e", "flyer")]
        scene = {"holonom": 1, "name": "chains", "gravity": [0.5, -9.81, 1], "bodies": bodies,
                 "joints": [{"name": "A", "type": "cylindrical", "parent": {"body": "a", "at": [0.1, 0.2, 0]}, "child": {"body": "ground"},
                             "axis": [0, 0.6, 0.8], "coordinates": ["x", "s"]},
                            {"name": "B", "type": "revolute", "parent": {"body": "ground", "at": [2, 0, 0]},
                             "child": {"body": "b", "at": [0.2, 0, 0], "axis": [0, 1, 0], "ref": [1, 0, 0]}, "axis": [0.6, 0.8, 0],
                             "coordinate": "y", "limits": [-30, 30]},
                            {"name": "C", "type": "universal", "parent": {"body": "a", "at": [1, 0, 0]}, "child": {"body": "c & d"},
                             "axis": [0, 1, 0], "axis2": [1, 0, 0], "coordinates": ["u", "w"]},
                            {"name": "P", "type": "planar", "parent": {"body": "b", "at": [0, 0, 1]}, "child": {"body": "e", "at": [0, 0.2, 0]},
                             "axis": [0, 0, 1], "coordinates": ["px", "py", "pt"]},
                            {"name": "F", "type": "free", "parent": {"body": "ground", "at": [0, 1, 0]},
                             "child": {"body": "flyer", "at": [0.2, 0, 0], "axis": [0, 1, 0], "ref": [0, 0, 1]}, "axis": [0, 0, 1],
                             "coordinates": ["fx", "fy", "fz", "f1", "f2", "f3"]}],
                 "loads": [{"name": "damper", "joint_spring": {"coordinate": "w", "damping": 0.3}}],
                 "constraints": [{"name": "wheels", "gear": {"coordinates": ["x", "y"], "ratio": 2, "phase": 0.5}}],
                 "start": {"positions": {"x": 0.3, "s": 0.2, "y": {"guess": 0.1}, "u": 0.2, "w": -0.3, "px": 0.1, "pt": 0.5, "f1": 0.4, "f2": 0.1, "f3": 0,
                                         "fy": 0.5},
                           "rates": {"d_x": 1, "d_s": 0.2, "d_u": -1, "d_w": 2, "d_pt": 1, "d_f1": 2, "d_f3": 1, "d_fx": 0.5}}}
        with tempfile.TemporaryDirectory() as folder:
            own = os.path.join(folder, "own.json")
            with open(own, "w") as f:
                json.dump(scene, f)
            n, error = self.round_trip(own, folder)
            self.assertGreaterEqual(n, 9)  # energy, x, s, y, u, w, px, py, pt and the flyer's spin
            self.assertLess(error, NEAR)

    def test_what_a_urdf_alone_does_not_hold_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            path, left = self.written("four-bar", folder)
            self.assertEqual(left, ["joint 'B'", "start", "gravity"])
            root = ET.parse(path).getroot()
            self.assertEqual([link.get("name") for link in root.iter("link")][0], "world")
            self.assertEqual(len(list(root.iter("link"))), 1 + len(list(root.iter("joint"))))
            _, left = self.written("delta-robot", folder)
            self.assertTrue(set(LEFT_OUT["delta-robot"]) <= set(left))

    def test_balls_wrong_loop_files_and_misplaced_options_are_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            taken = os.path.join(folder, "same")
            for words, said in ((("heavy-top", "--format", "urdf"), "no ball joint"), (("four-bar", "--loops", taken), "belongs to a URDF"),
                                (("four-bar", "--format", "mjcf", "--loops", taken), "describes closed loops itself"),
                                (("four-bar", "--format", "urdf", "--loops", taken, "-o", taken), "choose another name")):
                result = call("export", *words)
                self.assertEqual((result.returncode, result.stdout), (INPUT, ""), words)
                self.assertIn(said, result.stderr)
                self.assertFalse(os.path.exists(taken))
            path, loops = os.path.join(folder, "model.urdf"), os.path.join(folder, "loops.json")
            self.assertEqual(call("export", "pendulum", "--format", "urdf", "--loops", loops, "-o", path).returncode, DONE)
            for start, said in (([], "expected an object"), ({"speeds": {}}, "positions or rates"), ({"rates": {"no": 1}}, "no joint of this name"),
                                ({"rates": {"th": [1, 2]}}, "as many numbers"), ({"positions": {"th": "x"}}, "expected numbers")):
                with open(loops, "w") as f:
                    json.dump({"holonom_loops": 1, "start": start}, f)
                result = call("import", path, "--loops", loops)
                self.assertEqual(result.returncode, INPUT)
                self.assertIn(said, result.stderr)



class Redundant(unittest.TestCase):
    def test_bennett_read_back_runs_by_projection_too(self):
        """Four of its six rows follow from the others, and disagree by what rounding makes of angles of some radians."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "bennett")
            done = call("export", "bennett", "--format", "mjcf", "-o", path + ".xml")
            self.assertEqual(done.returncode, DONE, done.stderr)
            done = call("import", path + ".xml", "-o", path + ".json")
            self.assertEqual(done.returncode, DONE, done.stderr)
            methods = [f"projection@rk4:h={h}" for h in ("1e-3", "5e-3", "1e-2")]
            done = call("compare", path + ".json", "--methods", *methods, "--time", "2", "--json")
            self.assertEqual(done.returncode, DONE, done.stderr)
            for method in json.loads(done.stdout)["methods"]:
                self.assertEqual(method["state"], "finished", method)
                # as closed as 64-bit numbers can say, in metres and metres a second
                self.assertLess(method["worst_gap"], 1e-13)
                self.assertLess(method["worst_velocity_gap"], 1e-11)


if __name__ == "__main__":
    driver.main()
