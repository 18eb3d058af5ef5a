# SPDX-License-Identifier: GPL-3.0-or-later
"""Snapshots from the command line: formats, several moments, marks, the built-in renderer."""

import glob
import json
import math
import os
import re
import sys
import tempfile
import xml.etree.ElementTree
import zlib

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
sys.path.insert(0, os.path.dirname(__file__))
import driver  # noqa: E402
from command import DONE, INPUT, RK4, Command, call, strict  # noqa: E402


class Snapshot(Command):
    @staticmethod
    def chunks(png):
        names, at = [], 8
        while at < len(png):
            size = int.from_bytes(png[at : at + 4], "big")
            body = png[at + 4 : at + 8 + size]
            assert zlib.crc32(body) == int.from_bytes(png[at + 8 + size : at + 12 + size], "big")
            names.append((body[:4].decode(), body[4:]))
            at += 12 + size
        return names

    def picture(self, folder, name, *words, scene="four-bar", width="600", height="400", **env):
        """The bytes of a snapshot of the scene, and the document that describes it."""
        path = os.path.join(folder, name)
        done = call("snapshot", scene, "--method", RK4, "--width", width, "--height", height, "-o", path, "--describe", *words, environment=env)
        document = strict(self.assert_exit(done, DONE))
        with open(path, "rb") as f:
            return f.read(), document, done.stderr

    def test_dimensions_show_the_angles_of_joints(self):
        with tempfile.TemporaryDirectory() as folder:
            svg, document, _ = self.picture(folder, "a.svg", "--time", "0", "--dimensions")
            plain, bare, _ = self.picture(folder, "b.svg", "--time", "0")
        angles = {angle["name"]: angle for angle in document["picture"]["angles"]}
        self.assertEqual(sorted(angles), ["a2", "th1", "th3"])  # b3 closes the loop: it is no coordinate
        self.assertEqual(angles["th1"]["value"], 1)
        for name in ("th1", "th3"):  # from the ground: the bar's own direction
            (x, y, _), (p, q, _) = angles[name]["end"], angles[name]["pivot"]
            self.assertAlmostEqual(math.atan2(y - q, x - p), angles[name]["value"], 12)
        self.assertEqual(bare["picture"]["angles"], [])
        self.assertGreater(svg.count(b"<path"), plain.count(b"<path"))

    def test_the_angle_of_a_joint_is_measured_round_its_axis_in_the_world(self):
        for scene, names in (("four-bar", "a2 th1 th3"), ("rssr", "ps th"), ("oblique-four-bar", "a2 th1 th3")):
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "a.svg")
                done = call("snapshot", scene, "--time", "0.3", "--dimensions", "-o", path, "--describe")
                angles = strict(self.assert_exit(done, DONE))["picture"]["angles"]
            self.assertEqual(" ".join(sorted(angle["name"] for angle in angles)), names, scene)
            for angle in angles:
                bar = [end - pivot for end, pivot in zip(angle["end"], angle["pivot"])]
                length = math.hypot(*bar)
                for k in range(3):
                    turned = math.cos(angle["value"]) * angle["zero"][k] + math.sin(angle["value"]) * angle["quarter"][k]
                    self.assertAlmostEqual(bar[k] / length, turned, 9, (scene, angle["name"]))

    def test_ball_and_universal_joints_have_symbols_of_their_own(self):
        expected = {"rssr": {"spherical", "revolute"}, "cardan-shaft": {"universal", "revolute"}, "stewart-6-6": {"spherical", "universal"}, "four-bar": {"revolute"}}
        with tempfile.TemporaryDirectory() as folder:
            for scene, joints in expected.items():
                path = os.path.join(folder, scene + ".png")
                document = strict(self.assert_exit(call("snapshot", scene, "--time", "0", "-o", path, "--describe"), DONE))
                self.assertEqual({shape["joint"] for shape in document["picture"]["primitives"] if "joint" in shape}, joints, scene)

    @staticmethod
    def lies_on(box, strip):
        """Whether a box touches a strip of hatching (Liang and Barsky)."""
        half, first, last = strip["half"], 0, 1
        for k in (0, 1):
            low, high = box[k] - half, box[k + 2] + half
            start, way = strip["from"][k], strip["to"][k] - strip["from"][k]
            if way == 0:
                if not low < start < high:
                    return False
            else:
                ends = sorted(((low - start) / way, (high - start) / way))
                first, last = max(first, ends[0]), min(last, ends[1])
        return first < last

    def test_no_text_of_any_scene_lies_on_another_or_on_hatching(self):
        sets = (["--dimensions", "--forces"], ["--dimensions", "--forces", "--width", "600", "--height", "400"], ["--forces", "--view", "space", "--at", "0,0.05,0.1", "--ghosts"])
        texts = pictures = overlaps = hatched = 0
        with tempfile.TemporaryDirectory() as folder:
            for scene in sorted(glob.glob("lessons/*/scenes/*.json")):
                for words in sets:
                    times = [] if "--at" in words else ["--time", "0.1"]
                    done = call("snapshot", scene, "--method", "projection@rk4:h=0.01", *times, *words, "-o", os.path.join(folder, "x.svg"), "--describe")
                    self.assertIn(done.returncode, (DONE, 4), (scene, done.stderr))
                    picture = strict(done.stdout)["picture"]
                    boxes = [label["box"] for label in picture["labels"]]
                    texts, pictures = texts + len(boxes), pictures + 1
                    for i, a in enumerate(boxes):
                        overlaps += sum(all(max(a[k], b[k]) < min(a[k + 2], b[k + 2]) for k in (0, 1)) for b in boxes[:i] if picture["labels"][i]["text"])
                        hatched += any(self.lies_on(a, strip) for strip in picture["hatching"] if picture["labels"][i]["text"])
        print(f"# {pictures} pictures, {texts} texts: {overlaps} overlap, {hatched} lie on hatching")
        self.assertGreater(texts, 5 * pictures)
        self.assertEqual((overlaps, hatched), (0, 0))

    def test_forces_have_a_scale_and_short_arrows_are_named(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = self.picture(folder, "a.svg", "--time", "0.4", "--forces", scene="stewart-6-6")[1]["picture"]
            scale = picture["force_scale"]
            self.assertIn("50 N in the picture plane", picture["legend"])
            self.assertIn("shorter than drawn", picture["legend"])
            flat = self.picture(folder, "b.svg", "--time", "0.4", "--forces")[1]["picture"]
            self.assertIn("5 N", flat["legend"])
            self.assertNotIn("shorter than drawn", flat["legend"])
        self.assertEqual(scale["force"], 50)
        self.assertGreater(scale["pixels"], 20)

    def test_forces_of_a_crowded_picture_are_numbered_and_listed(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = self.picture(folder, "a.svg", "--time", "0.4", "--forces", "--dimensions", scene="stewart-6-6", width="1200", height="720")[1]["picture"]
        numbers = [label["text"] for label in picture["labels"] if label["kind"] == "force"]
        self.assertEqual(sorted(map(int, numbers)), list(range(1, 19)))
        self.assertEqual(len([row for row in picture["listed"] if re.fullmatch(r"\d+ [UPS]\d [\d.]+ N", row)]), 18)
        self.assertEqual([label["text"] for label in picture["labels"] if label["kind"] == "length"], ["12 \u00d7 463 mm"])
        self.assertIn(picture["inset"]["tear"], [label["text"] for label in picture["labels"]])  # the inset's joint

    def test_angles_have_values_all_or_none_and_turns_apart(self):
        with tempfile.TemporaryDirectory() as folder:
            for scene, time in (("watt-six-bar", "0.4"), ("bennett", "0.4"), ("3-rrr", "0.4"), ("slider-crank", "1"), ("seven-body-squeezer", "0.03")):
                picture = self.picture(folder, "a.svg", "--time", time, "--dimensions", scene=scene)[1]["picture"]
                drawn = [label["text"] for label in picture["labels"] if label["kind"] == "angle"]
                self.assertIn(sum("=" in text for text in drawn), (0, len(drawn)), scene)
                rows = drawn if any("=" in text for text in drawn) else picture["listed"]
                values = {text.split(" = ")[0]: text.split(" = ")[1].removesuffix(", no arc") for text in rows + picture["listed"] if " = " in text}
                for angle in picture["angles"]:
                    turns = math.trunc(angle["value"] / (2 * math.pi))
                    more = f" {'-' if turns < 0 else '+'} {abs(turns)} turn{'s' if abs(turns) > 1 else ''}" if turns else ""
                    self.assertEqual(values[angle["name"]], f"{math.fmod(angle['value'], 2 * math.pi):.2f} rad{more}", scene)

    def test_earlier_poses_have_times_and_paths_have_names(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = self.picture(folder, "a.svg", "--at", "0,0.2,0.4", "--ghosts", "--trace", "B")[1]["picture"]
        self.assertEqual(picture["legend"], ["earlier: t = 0, 0.2 s", "path of a point on coupler", "path of B"])
        self.assertEqual([label["text"] for label in picture["labels"] if label["kind"] == "time"], ["0 s", "0.2 s"])

    def test_a_path_that_the_scene_draws_is_not_drawn_twice(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = self.picture(folder, "a.svg", "--time", "0.2", "--trace", "P", "--trace", "P", scene="peaucellier")[1]["picture"]
        self.assertEqual(picture["legend"], ["path of P"])

    def test_joints_that_the_legend_names_are_named_in_the_drawing(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = self.picture(folder, "a.svg", "--time", "0.3", "--forces", scene="slider-crank")[1]["picture"]
            robot = self.picture(folder, "b.svg", "--time", "0.3", scene="delta-robot")[1]["picture"]
        self.assertIn("S on slider", picture["poses"][0]["note"])
        self.assertIn("S", [label["text"] for label in picture["labels"]])
        self.assertIn(robot["inset"]["tear"], [label["text"] for label in robot["labels"]])

    def test_a_stopped_run_has_its_own_time_and_the_reason_of_compare(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.svg")
            method = "index1@rk4:h=2e-2"
            done = call("snapshot", "four-bar", "--method", method, "--time", "60", "-o", path, "--describe")
            document = strict(self.assert_exit(done, 4))
            reason = "the loops are open by 0.601 m, more than half the mechanism's length"
            self.assertIn(reason.encode(), done.stderr)
            self.assertIn(reason, document["picture"]["poses"][0]["note"])
            self.assertIn(reason.encode(), call("compare", "four-bar", "--methods", method, "--time", "60").stderr)
            self.assertEqual((document["picture"]["time"], document["picture"]["stopped"]), (37.88, True))
            self.assertGreater(document["picture"]["traces"][0], 5900)  # 0.01 s from point to point

    def test_a_strip_leaves_few_places_empty_and_says_title_and_names_once(self):
        with tempfile.TemporaryDirectory() as folder:
            for n, across, down in ((2, 2, 1), (3, 3, 1), (4, 2, 2), (5, 3, 2), (6, 3, 2), (7, 4, 2), (8, 4, 2), (10, 5, 2)):
                svg, document, _ = self.picture(folder, "s.svg", "--at", ",".join(str(0.01 * k) for k in range(n)), "--forces")
                root = xml.etree.ElementTree.fromstring(svg)
                self.assertEqual((root.get("width"), root.get("height")), (str(600 * across), str(400 * down)), n)
            first, later = document["before"][-1], document["picture"]
            self.assertEqual(first["legend"][0], "5 N")
            self.assertNotIn("path of a point on coupler", first["legend"])  # at the start there is none
            self.assertLessEqual(set(later["legend"]), {"shorter than drawn"})
            for k, panel in enumerate([panel for panel in root.iter("{http://www.w3.org/2000/svg}svg")][1:]):
                starts = [tuple(map(float, re.match(r"[mM]([-\d.]+)[ ,]?([-\d.]+)", path.get("d")).groups())) for path in panel.iter("{http://www.w3.org/2000/svg}path")]
                self.assertEqual(any(x < 300 and y < 30 for x, y in starts), k == 0)  # the title

    def test_supports_and_guides_of_a_plane_are_hatched_in_that_plane(self):
        def slope(strip):
            return math.atan2(strip["to"][1] - strip["from"][1], strip["to"][0] - strip["from"][0])

        with tempfile.TemporaryDirectory() as folder:
            for view, tilted in (("front", False), ("35,22", True), ("space", True)):
                strips = self.picture(folder, "a.svg", "--time", "0.1", "--view", view, scene="slider-crank")[1]["picture"]["hatching"]
                self.assertEqual(len(strips), 2)
                self.assertAlmostEqual(slope(strips[0]), slope(strips[1]), 6)
                self.assertEqual(abs(slope(strips[0])) > 0.1, tilted)

    def test_many_springs_are_drawn_from_any_side(self):
        # each is drawn twice, itself and its pins: the program ends badly where it has no room for both
        spring = {"to": {"body": "bob", "at": [0, 0, 0]}, "stiffness": 1, "rest": 1}
        scene = {"holonom": 1, "name": "springs", "bodies": [{"name": "bob", "mass": 1, "com": [0, 0, 0], "inertia": {"zz": 0.1}}],
                 "joints": [{"name": "pin", "type": "revolute", "parent": {"body": "ground"}, "child": {"body": "bob", "at": [0, 1, 0]}, "coordinate": "th"}],
                 "loads": [{"name": f"s{i}", "spring": {"from": [i / 10, 2, 0], **spring}} for i in range(40)]}
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "springs.json")
            with open(path, "w", encoding="utf-8") as file:
                json.dump(scene, file)
            for view in ("front", "35,22"):
                svg = self.picture(folder, "a.svg", "--view", view, scene=path)[0].decode()
                self.assertGreater(svg.count("<path"), 80, view)

    def test_gears_are_circles(self):
        with tempfile.TemporaryDirectory() as folder:
            svg = self.picture(folder, "a.svg", "--time", "0", scene="planetary-gear")[0].decode()
        long = sorted(path.count("l") for path in re.findall(r' d="([^"]*)"', svg))
        self.assertGreater(long[-1], 8 * 36 - 2)  # the rim, from 36 bars
        self.assertGreater(sum(180 < n < 200 for n in long), 3)  # sun and planets, from 24 corners each

    def test_a_mechanism_without_room_is_reported(self):
        with tempfile.TemporaryDirectory() as folder:
            for size, said in (("300", True), ("600", False)):
                _, document, stderr = self.picture(folder, "a.png", "--time", "0.1", "--dimensions", width=size, height=str(int(size) * 2 // 3))
                self.assertEqual(b"pixels large" in stderr, said, stderr)
                self.assertEqual(document["picture"]["mechanism_pixels"] < 120, said)

    def test_the_renderer_is_an_option(self):
        with tempfile.TemporaryDirectory() as folder:
            for asked, name in (("built-in", "built-in"), ("osmesa", "OSMesa"), ("auto", "OSMesa")):
                _, document, stderr = self.picture(folder, "a.png", "--time", "0.1", "--renderer", asked)
                self.assertEqual(document["renderer"], name)
                self.assertIn(f"drawn by {'the built-in renderer' if name == 'built-in' else name}".encode(), stderr)
            done = call("snapshot", "four-bar", "--renderer", "gpu", "-o", os.path.join(folder, "b.png"))
            self.assert_exit(done, INPUT)
            self.assertIn(b"auto, osmesa or built-in", done.stderr)
            self.assertEqual(self.picture(folder, "c.png", "--t", "0.2")[0], self.picture(folder, "d.png", "--time", "0.2")[0])
            self.assert_exit(call("snapshot", "four-bar", "--t", "1", "--time", "1", "-o", os.path.join(folder, "b.png")), INPUT)

    def test_exercises_that_describe_a_shipped_mechanism_have_its_picture(self):
        named = []
        with tempfile.TemporaryDirectory() as folder:
            for file in sorted(glob.glob("lessons/*/problems/*.json")):
                with open(file, encoding="utf-8") as f:
                    exercise = json.load(f)
                for seed in ("1", "42") if "picture" in exercise else ():
                    done = call("snapshot", exercise["id"], "--seed", seed, "-o", os.path.join(folder, "a.svg"), "--describe")
                    self.assertEqual(strict(self.assert_exit(done, DONE))["scene"], exercise["picture"]["scene"])
                    self.assertIn(b"lengths are those of the variant", done.stderr)
                named += [exercise["id"]] if "picture" in exercise else []
            self.assertLessEqual({"fourbar", "slider", "closure"}, set(named))
            one, two = (call("snapshot", "closure", "--seed", seed, "-o", os.path.join(folder, "a.svg"), "--describe").stdout for seed in ("1", "2"))
            self.assertNotEqual(one, two)

    def test_lengths_of_a_picture_have_one_unit(self):
        with tempfile.TemporaryDirectory() as folder:
            for scene, unit in (("four-bar", "m"), ("slider-crank", "mm"), ("fb0", "m")):
                picture = self.picture(folder, "a.svg", "--time", "0.1", "--dimensions", scene=scene)[1]["picture"]
                lengths = [label["text"] for label in picture["labels"] if label["kind"] == "length"]
                self.assertGreater(len(lengths), 1)
                self.assertEqual({text.split()[-1] for text in lengths}, {unit}, (scene, lengths))

    def test_the_ending_of_a_snapshot_is_its_format_or_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("x.pdf", "x", "x.jpg"):
                path = os.path.join(folder, name)
                done = call("snapshot", "four-bar", "--time", "0.1", "-o", path)
                self.assert_exit(done, INPUT)
                self.assertIn(b".png", done.stderr)
                self.assertFalse(os.path.exists(path))

    def test_a_snapshot_is_a_png_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.png")
            done = call("snapshot", "four-bar", "--method", RK4, "--time", "0.3", "-o", path, "--width", "400", "--height", "300", "--json")
            self.assertTrue(strict(self.assert_exit(done, DONE)))
            data = open(path, "rb").read()
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual((int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")), (400, 300))

    def test_several_moments_are_a_strip_or_an_animation(self):
        with tempfile.TemporaryDirectory() as folder:
            strip, document, _ = self.picture(folder, "a.png", "--at", "0,0.1,0.2,0.3")
            self.assertEqual((int.from_bytes(strip[16:20], "big"), int.from_bytes(strip[20:24], "big")), (1200, 800))  # four panels are two rows of two
            self.assertEqual(len(document["before"]), 3)
            alone, single, _ = self.picture(folder, "b.png", "--time", "0.3")
            self.assertEqual(single["picture"]["primitives"], document["picture"]["primitives"])
            film = self.chunks(self.picture(folder, "c.png", "--at", "0,0.1,0.2,0.3", "--animate", "40")[0])
            names = [name for name, _ in film]
            self.assertEqual((names[0], names[-1], names.count("acTL"), names.count("fcTL")), ("IHDR", "IEND", 1, 4))
            order = [int.from_bytes(body[:4], "big") for name, body in film if name in ("fcTL", "fdAT")]
            self.assertEqual(order, list(range(len(order))))
            self.assertEqual(b"".join(body for name, body in film if name == "IDAT"),
                             b"".join(body for name, body in self.chunks(self.picture(folder, "d.png", "--time", "0")[0]) if name == "IDAT"))  # fmt: skip

    def test_marks_of_a_snapshot_are_in_the_picture_and_in_its_description(self):
        with tempfile.TemporaryDirectory() as folder:
            plain, bare, _ = self.picture(folder, "a.png", "--time", "0.3")
            for words, key, count in ((["--ghosts", "--at", "0,0.1,0.3"], "poses", 3), (["--dimensions"], "poses", 1),
                                      (["--forces"], "loads", 4), (["--trace", "B"], "traces", 1)):  # fmt: skip
                more = [] if "--at" in words else ["--time", "0.3"]
                marked, document, _ = self.picture(folder, "b.png", *words, *more)
                self.assertEqual(len(document["picture"][key]), count, words)
                self.assertNotEqual(plain, marked, words)
            traced = self.picture(folder, "c.png", "--trace", "B", "--time", "0.3")[1]["picture"]["traces"]
            self.assertGreater(traced[0], bare["picture"]["traces"][0])
            kinds = {p["kind"] for p in bare["picture"]["primitives"]}
            self.assertTrue({"bar", "pivot", "ground"} <= kinds, kinds)
            self.assertIn("B at (", bare["words"])
            done = call("snapshot", "four-bar", "--trace", "Q", "-o", os.path.join(folder, "n.png"))
            self.assert_exit(done, INPUT)
            self.assertIn(b"its points are: A B", done.stderr)

    def test_the_legend_says_on_which_bodies_the_forces_act(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "f.png")
            for scene, said in (("four-bar", "forces: O1 on crank, A on coupler, O3 on rocker, B on rocker"), ("fb0-lagrangian", "no force at any joint"),
                                ("heavy-top", "no constraints; forces: foot on top"), ("bennett", "forces, one set of many: J1 on crank"), ("stewart-6-6", "each on the second body of its joint")):  # fmt: skip
                done = call("snapshot", scene, "--time", "0.1", "--forces", "-o", path, "--describe")
                self.assertIn(said, strict(self.assert_exit(done, DONE))["picture"]["poses"][0]["note"], scene)

    def test_the_legend_of_forces_is_whole_or_names_none(self):
        with tempfile.TemporaryDirectory() as folder:
            with open("lessons/01-closed-loops/scenes/four-bar.json", encoding="utf-8") as f:
                text = f.read()
            for length in (20, 31):
                long, scene = text, os.path.join(folder, "long.json")
                for name in ("crank", "coupler", "rocker", "O1", "O3", "A", "B"):
                    long = long.replace(f'"{name}"', f'"{(name + "-" + 40 * "x")[:length]}"')
                with open(scene, "w", encoding="utf-8") as f:
                    f.write(long)
                done = call("snapshot", scene, "--time", "0.1", "--forces", "-o", os.path.join(folder, "f.png"), "--describe")
                note = strict(self.assert_exit(done, DONE))["picture"]["poses"][0]["note"]
                named = re.fullmatch(rf"gap [^;]*; forces:(,? [^ ]{{{length}}} on [^ ]{{{length}}}){{4}}", note)
                self.assertTrue(named or note.endswith("; arrows: forces, each on the second body of its joint"), note)

    def test_the_legend_names_the_forces_that_are_drawn_and_no_others(self):
        with tempfile.TemporaryDirectory() as folder:  # the shafts of this gear carry no force
            picture = self.picture(folder, "f.png", "--time", "0.3", "--forces", scene="planetary-gear")[1]["picture"]
            self.assertEqual(len(picture["loads"]), 3)
            self.assertRegex(picture["poses"][0]["note"], r"forces(, one set of many)?: pin 1 on planet1, pin 2 on planet2, pin 3 on planet3$")

    def test_an_exercise_with_one_configuration_says_that_times_are_not_used(self):
        with tempfile.TemporaryDirectory() as folder:
            for times in (["--time", "0.5"], ["--t", "0.5"], ["--at", "0.5"], ["--at", "0,0.5", "--ghosts"]):
                done = call("snapshot", "p3", "--seed", "42", *times, "-o", os.path.join(folder, "p.png"))
                self.assert_exit(done, DONE)
                self.assertIn(b"one configuration and no motion", done.stderr)
                self.assertIn(b"'holonom snapshot four-angles-as-printed' draws its scene", done.stderr)

    def test_several_loops_have_a_gap_over_all_constraints(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "g.png")
            for scene, over_all in (("four-bar", False), ("stewart-6-6", True)):
                done = call("snapshot", scene, "--method", "index1@rk4:h=0.01", "--time", "0.5", "-o", path, "--describe")
                note = strict(self.assert_exit(done, DONE))["picture"]["poses"][0]["note"]
                self.assertEqual(note.endswith(" over all constraints"), over_all, note)

    def test_the_pictures_of_a_strip_have_one_scale_of_forces(self):
        def largest(picture):
            return max(math.hypot(*load["force"]) for load in picture["loads"])

        with tempfile.TemporaryDirectory() as folder:
            strip = self.picture(folder, "s.png", "--at", "0.5,1", "--forces")[1]
            first, last = strip["before"][0], strip["picture"]
            self.assertGreater(largest(last), 2 * largest(first))
            for picture in (first, last):
                self.assertAlmostEqual(picture["longest_load"], largest(last), delta=1e-9 * largest(last))
            # alone, its own largest force sets the scale
            alone = self.picture(folder, "a.png", "--time", "0.5", "--forces")[1]["picture"]
            self.assertAlmostEqual(alone["longest_load"], largest(alone), delta=1e-9 * largest(alone))

    def test_a_snapshot_may_be_vector_graphics(self):
        with tempfile.TemporaryDirectory() as folder:
            svg, document, _ = self.picture(folder, "a.svg", "--at", "0,0.1")
            root = xml.etree.ElementTree.fromstring(svg)
            space = "{http://www.w3.org/2000/svg}"
            self.assertEqual((root.get("width"), root.get("height")), ("1200", "400"))
            self.assertEqual(len(root.findall(space + "svg")), 2)
            self.assertEqual(root.find(space + "desc").text, document["words"])
            self.assertGreater(len(list(root.iter(space + "path"))), 50)

    def test_vector_graphics_draw_lines_with_pens_and_stay_small(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, *options in (("forces", "--time", "1", "--forces"), ("ghosts", "--at", "0,0.2,0.4", "--ghosts"), ("dimensions", "--time", "1", "--dimensions")):
                svg, _, _ = self.picture(folder, name + ".svg", *options)
                self.assertLess(len(svg), 150_000, name)
                pens = [p for p in xml.etree.ElementTree.fromstring(svg).iter("{http://www.w3.org/2000/svg}path") if p.get("class") == "p"]
                self.assertGreater(len(pens), 30)
                self.assertTrue(all(float(p.get("stroke-width")) > 0 and p.get("stroke") for p in pens))

    def test_an_exercise_is_drawn_with_the_numbers_of_a_variant(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "p.png")
            places = [call("snapshot", "p3", *seed, "-o", path, "--describe").stdout for seed in ((), ("--seed", "42"), ("--seed", "42"), ("--student", "ada"))]
            self.assertEqual(places[1], places[2])
            self.assertEqual(len(set(places)), 3)
            self.assertEqual(json.loads(places[1])["scene"], "four-angles-as-printed")
            self.assert_exit(call("snapshot", "four-bar", "--seed", "42", "-o", path), INPUT)

    def test_a_file_that_is_no_picture_of_this_program_is_kept(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, content in (("k.svg", b"{}"), ("k.png", b"\x89PNG\r\n\x1a\n of somebody else, who wants to have it later too")):
                path = os.path.join(folder, name)
                with open(path, "wb") as f:
                    f.write(content)
                for t in ("0", "0.1", "0.2"):
                    done = call("snapshot", "four-bar", "--method", RK4, "--time", t, "-o", path)
                    self.assert_exit(done, DONE)
                    self.assertEqual(b"are kept in" in done.stderr, t == "0", done.stderr)
                with open(path + ".1", "rb") as f:
                    self.assertEqual(f.read(), content)
            film = os.path.join(folder, "k.png")
            for _ in range(2):
                self.assert_exit(call("snapshot", "four-bar", "--method", RK4, "--at", "0,0.1", "--animate", "40", "-o", film), DONE)
            self.assertEqual(sorted(os.listdir(folder)), ["k.png", "k.png.1", "k.svg", "k.svg.1"])

    def test_options_that_say_two_things_are_refused(self):
        for words, said in ((["--ghosts"], b"--at names their times"), (["--ghosts", "--at", "1"], b"two or more"), (["--time", "1", "--at", "0,0.5"], b"both choose the time"), (["--at", "0,1", "--ghosts", "--animate", "9"], b"--ghosts draws all times into one")):
            done = call("snapshot", "four-bar", *words, "-o", os.path.join(tempfile.gettempdir(), "never.png"))
            self.assert_exit(done, INPUT)
            self.assertIn(said, done.stderr)

    def test_a_configuration_that_is_asked_for_is_not_drawn_and_that_is_said(self):
        with tempfile.TemporaryDirectory() as folder:
            for exercise, said in (("assemble", True), ("p3", False)):
                done = call("snapshot", exercise, "--student", "ada", "-o", os.path.join(folder, "a.png"))
                self.assert_exit(done, DONE)
                self.assertEqual(b"angles are those of the scene's start" in done.stderr, said)

    def test_times_must_rise(self):
        done = call("snapshot", "four-bar", "--at", "0.5,0.2", "-o", os.path.join(tempfile.gettempdir(), "never.png"))
        self.assert_exit(done, INPUT)
        self.assertIn(b"0.2 s comes after 0.5 s", done.stderr)

    def test_without_osmesa_the_built_in_renderer_draws_and_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            png, document, said = self.picture(folder, "a.png", "--time", "0.3", HOLONOM_RENDERER="built-in")
            self.assertEqual(document["renderer"], "built-in")
            self.assertIn(b"built-in renderer", said)
            other, document, said = self.picture(folder, "b.png", "--time", "0.3")
            self.assertEqual((document["renderer"], said), ("OSMesa", b""))
            self.assertEqual([name for name, _ in self.chunks(png)], [name for name, _ in self.chunks(other)])


if __name__ == "__main__":
    driver.main()
