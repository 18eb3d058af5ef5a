# SPDX-License-Identifier: GPL-3.0-or-later
"""The reference solution of a scene: stored, computed on request within bounds, and the motion between stored times."""

import unittest

import driver

AT = "/api/v1/scenes/fb0-lagrangian/reference"
# th1 of the reference four-bar: one-coordinate equation by extrapolation in 30-digit arithmetic
TH1_AT_2 = 7.41136679869211579


class Reference(driver.ServerCase):
    def get(self, query="", path=AT):
        answer = self.server.ask("GET", path + query)
        self.assertEqual(answer.status, 200, answer.body[:300])
        return answer.json()

    def refused(self, query, status, path=AT):
        answer = self.server.ask("GET", path + query)
        self.assertEqual(answer.status, status, answer.body[:300])
        self.assertEqual(answer.type, "application/problem+json")
        return answer.json()

    def test_the_shipped_one_is_handed_out_with_its_digits(self):
        reference = self.get()
        self.assertEqual((reference["source"], reference["time"]), ("shipped", 10))
        self.assertEqual(len(set(reference["means"])), 2)
        self.assertGreater(reference["digits"], 13)
        self.assertEqual(len(reference["t"]), len(reference["q"]))
        self.assertNotIn("motion", reference)

    def test_what_is_not_stored_is_computed_only_on_request(self):
        problem = self.refused("?set=g:9&time=1", 404)
        self.assertIn("has to be computed", problem["detail"])
        self.assertIn("compute=true", problem["hint"])
        reference = self.get("?set=g:9&time=1&compute=true")
        self.assertEqual((reference["source"], reference["time"]), ("computed", 1))
        self.refused("?time=1&compute=false", 404)
        computed = self.get("?time=2&compute=true")
        self.assertLess(abs(computed["q"][-1][0] - TH1_AT_2), 3e-15)

    def test_the_motion_between_passes_through_the_stored_states(self):
        reference = self.get("?every=0.3125")  # 10 s in 32 parts: the stored times themselves
        motion = reference["motion"]
        self.assertEqual(len(motion["q"]), len(reference["q"]))
        for moved, stored in zip(motion["q"], reference["q"]):
            for a, b in zip(moved, stored):
                self.assertLessEqual(abs(a - b), motion["between"] * reference["scales"]["length"])
        self.assertLess(motion["between"], 1e-9)
        self.assertGreaterEqual(motion["between"], reference["error"]["q"])

    def test_the_motion_goes_through_poses_where_rows_are_lost(self):
        for scene in "n-four-bar", "parallelogram":
            motion = self.get("?every=0.1", f"/api/v1/scenes/{scene}/reference")["motion"]
            self.assertLess(motion["between"], 1e-9)
            self.assertIn("@rk4", motion["method"])  # steps of a tolerance end at such a pose

    def test_the_points_are_those_of_a_run(self):
        motion = self.get("?every=1")["motion"]
        comparison = self.server.compare(scene="fb0-lagrangian", methods=["projection@dop853:rtol=1e-12"], frame_dt=1)
        self.server.ask("PATCH", "/api/v1/comparisons/" + comparison["id"], {"step": 3})
        frame = self.server.ask("GET", "/api/v1/comparisons/" + comparison["id"]).json()["latest"]
        self.assertEqual(frame["t"], 3)
        points = frame["methods"][0]["points"]
        self.assertEqual(len(points), len(motion["points"][3]))
        for a, b in zip(points, motion["points"][3]):
            self.assertAlmostEqual(a, b, delta=1e-8)

    def test_numbers_are_bounded_and_faults_are_told(self):
        for query in ("?every=0", "?every=-1", "?every=x", "?every=nan", "?every=1e-9", "?time=-1", "?time=1e99", "?time=",
                      "?compute=maybe", "?set=nothing:1", "?set=g"):
            problem = self.refused(query, 422)
            self.assertTrue(problem["errors"][0]["detail"], query)
        self.assertIn("four-bar", self.refused("", 404, "/api/v1/scenes/four-barr/reference")["hint"])


class Bounded(unittest.TestCase):
    def test_computing_ends_where_the_server_says(self):
        # on a crowded machine too enough for the equations of a four-bar, which count as well; 3000 s of it need many times that
        server = driver.Server("--run-cpu", str(1.0 * driver.SLOW))
        try:
            answer = server.ask("GET", "/api/v1/scenes/four-bar/reference?compute=true&time=3000")
            self.assertEqual(answer.status, 422, answer.body[:300])
            self.assertIn("takes more", answer.json()["errors"][0]["detail"])
        finally:
            server.stop()


if __name__ == "__main__":
    driver.main()
