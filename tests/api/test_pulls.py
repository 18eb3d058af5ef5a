# SPDX-License-Identifier: GPL-3.0-or-later
"""A hand that pulls a comparison while it runs: its log, done again, gives the same bits; its work is counted."""

import driver

METHODS = ["projection@rk4:h=1e-2", "ggl@radau5:rtol=1e-8", "nullspace@dopri5:rtol=1e-8"]
POINT = 2  # of the four-bar: a joint that moves


def states(description):
    return [(m["q"], m["v"], m["work"]) for m in description["latest"]["methods"]]


class Pulls(driver.ServerCase):
    def patch(self, ident, status=200, **body):
        answer = self.server.ask("PATCH", "/api/v1/comparisons/" + ident, body)
        self.assertEqual(answer.status, status, answer.body[:400])
        return answer.json()

    def pull_about(self, ident):
        """Holds a point over 40 frames, at places that move, and lets go."""
        self.patch(ident, step=30)
        for k in range(8):
            to = [1.2 + 0.05 * k, 0.5 + 0.04 * k]
            self.patch(ident, pull={"point": POINT, "to": to}, step=5)
        return self.patch(ident, release=True, step=30)

    def log_of(self, ident):
        return self.server.ask("GET", f"/api/v1/comparisons/{ident}/pulls").json()

    def test_a_first_pull_leaves_the_clock_where_it_was(self):
        c = self.server.compare(methods=METHODS)
        before = self.patch(c["id"], step=30)
        now = self.patch(c["id"], pull={"point": POINT, "to": [1.2, 0.5]})
        self.assertEqual((now["frame"], now["generation"], now["pulls"]), (30, 1, 1))
        # nothing has pulled so far: the same motion, but for the order of sums
        for was, is_now in zip(before["latest"]["methods"], now["latest"]["methods"]):
            for a, b in zip(was["q"], is_now["q"]):
                self.assertAlmostEqual(a, b, delta=1e-6)
        # felt from the latest time that a method, or the pilot run, has stepped to: their steps are shorter than 0.1 s here
        held = self.patch(c["id"], step=5)["latest"]
        self.assertEqual(held["pull"]["point"], POINT)
        self.assertGreater(held["pull"]["stiffness"], 0)
        self.assertEqual(len(held["methods"][0]["pull_force"]), 3)

    def test_the_log_done_again_gives_the_same_bits(self):
        c = self.server.compare(methods=METHODS)
        live = self.pull_about(c["id"])
        log = self.log_of(c["id"])
        self.assertEqual((len(log["pulls"]), live["pulls"]), (9, 9))
        self.assertEqual([entry[0] for entry in log["pulls"]], [30 + 5 * k for k in range(9)])
        self.assertTrue(all(abs(m["work"]) > 0.1 for m in live["latest"]["methods"]))

        # another comparison with the log, and the same one set back
        again = self.server.compare(methods=METHODS, pulls=log["pulls"])
        self.assertEqual(states(self.patch(again["id"], step=live["frame"])), states(live))
        self.patch(c["id"], reset=True)
        self.assertEqual(states(self.patch(c["id"], step=live["frame"])), states(live))

    def test_the_work_of_the_hand_is_what_the_energy_changes_by(self):
        c = self.server.compare(methods=METHODS[1:])
        energy = c["latest"]["methods"][0]["energy"]
        for m in self.pull_about(c["id"])["latest"]["methods"]:
            # tolerances of 1e-8 leave 1e-6 of some joules
            self.assertAlmostEqual(m["energy"] - energy, m["work"], delta=1e-4)
            self.assertAlmostEqual(m["energy_change"], 0, delta=1e-4)

    def test_new_methods_feel_the_same_hand_and_an_empty_list_forgets_it(self):
        c = self.server.compare(methods=METHODS[1:])
        live = self.pull_about(c["id"])
        changed = self.patch(c["id"], methods=[METHODS[2]])
        self.assertEqual(changed["pulls"], 9)
        again = self.patch(c["id"], step=live["frame"])
        for a, b in zip(states(again)[0][0], states(live)[1][0]):
            self.assertAlmostEqual(a, b, delta=1e-5)
        self.assertEqual(self.patch(c["id"], pulls=[])["pulls"], 0)
        self.assertNotIn("pull", self.patch(c["id"], step=1)["latest"])

    def test_a_hand_that_takes_hold_in_a_replay_forgets_what_would_follow(self):
        c = self.server.compare(methods=METHODS[:1])
        self.pull_about(c["id"])
        self.patch(c["id"], reset=True)
        self.patch(c["id"], step=42)
        self.patch(c["id"], pull={"point": POINT, "to": [1, 1]})
        self.assertEqual([entry[0] for entry in self.log_of(c["id"])["pulls"]], [30, 35, 40, 42])

    def test_forces_in_the_joints_contain_the_hand(self):
        asked = {"scene": "four-bar", "reactions": True}
        free = self.server.ask("POST", "/api/v1/terms", asked).json()
        asked["pull"] = {"point": POINT, "to": [3, 3], "stiffness": 100, "damping": 0}
        held = self.server.ask("POST", "/api/v1/terms", asked).json()
        self.assertNotEqual(free["reactions"], held["reactions"])
        asked["pull"]["stiffness"] = 0
        idle = self.server.ask("POST", "/api/v1/terms", asked).json()
        for a, b in zip(free["reactions"], idle["reactions"]):
            for x, y in zip(a["force"], b["force"]):
                self.assertAlmostEqual(x, y, delta=1e-9)

    def test_pulls_at_fault_change_nothing(self):
        c = self.server.compare(methods=METHODS[:1])
        url = "/api/v1/comparisons/" + c["id"]
        for body, pointer in (
                ({"pull": {"point": 99, "to": [0, 0]}}, "/pull/point"),
                ({"pull": {"point": POINT}}, "/pull/to"),
                ({"pull": {"point": POINT, "to": [1]}}, "/pull/to"),
                ({"pull": {"point": POINT, "to": [1, -1e101]}}, "/pull/to/1"),
                ({"pull": {"point": POINT, "to": [1, 2], "stiffness": -1}}, "/pull/stiffness"),
                ({"pulls": [[0, POINT, 1, 1, 0, 5]]}, "/pulls/0"),
                ({"pulls": [[5, POINT, 1, 1, 0, 5, 1], [4, POINT, 1, 1, 0, 5, 1]]}, "/pulls/1"),
                ({"pulls": "none"}, "/pulls")):
            problem = self.assert_problem(self.server.ask("PATCH", url, body), 422)
            self.assertEqual(problem["errors"][0]["pointer"], pointer)
        self.assertEqual(self.server.ask("GET", url).json()["generation"], 0)
        self.assertEqual(self.patch(c["id"], release=True)["pulls"], 0)

    def test_a_scene_of_formulas_is_pulled_too(self):
        c = self.server.compare(scene="four-angles-as-printed", methods=["projection@rk4:h=1e-2"])
        point = next(i for i in range(c["scene"]["drawing"]["points"]) if i not in c["scene"]["ground_points"])
        self.patch(c["id"], pull={"point": point, "to": [0.5, 0.5]}, step=20)
        method = self.patch(c["id"], step=1)["latest"]["methods"][0]
        self.assertEqual(method["state"], "running", method["reason"])
        self.assertNotEqual(method["work"], 0)


if __name__ == "__main__":
    driver.main()
