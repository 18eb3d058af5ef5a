# SPDX-License-Identifier: GPL-3.0-or-later
"""Whoever holds up the server holds up himself: what a hostile or careless client sends, and how soon the server ends beside it."""

import concurrent.futures
import http.client
import json
import math
import socket
import threading
import time

import driver
from beside import JSON, RING, RK4, Timed, many_members


class NobodyWaitsForAnother(Timed):
    def setUp(self):
        self.server = driver.Server("--run-cpu", "2")

    def tearDown(self):
        self.assertEqual(self.server.stop(), 0, self.server.errors)

    def post(self, path, body, method="POST"):
        return self.server.ask(method, "/api/v1/" + path, body, {"Content-Type": "application/json"}, timeout=120)

    def computing(self, ask, times):
        """What one of these requests costs the server [s]: the mean of some, the clock has hundredths."""
        before = self.server.cpu()
        for _ in range(times):
            ask()
        return (self.server.cpu() - before) / times

    def test_a_body_of_many_members_is_checked_in_one_pass(self):
        c = self.server.compare()

        def check(answer, cpu):
            self.assertEqual(answer.status, 422, answer.body[:200])
            self.assertLessEqual(len(answer.json()["errors"]), 16)
            self.assertLess(cpu, 1 * driver.SLOW)  # 14 s when each member was looked up from the start

        for path, method, known in (("comparisons/" + c["id"], "PATCH", '"speed":1'), ("terms", "POST", '"t":1')):
            for body in (many_members(known), many_members(known, n_unknown=0, n_known=80000)):
                self.assert_unhindered(self.server, lambda: self.post(path, body, method), check)

    def test_a_shipped_scene_waits_for_no_large_mechanism(self):
        """Both take the threads for what is quick: one that forms equations for seconds makes way."""
        ring = {"scene": "ring", "parameters": {"n": 100}}

        def attempt():
            """What a shipped scene takes beside two large ones, and half of what they take."""
            start, before = time.monotonic(), self.server.cpu()
            with concurrent.futures.ThreadPoolExecutor(2) as pool:
                large = [pool.submit(self.post, "comparisons", {**ring, "methods": ["projection@rk4:h=1e-2"]}),
                         pool.submit(self.server.ask, "GET", "/api/v1/scenes/ring?set=n:100", timeout=120)]
                self.server.is_at_work(before)
                answer, took = self.server.timed("GET", "/api/v1/scenes/four-bar", headers={"User-Agent": "another"})
                self.assertEqual(answer.status, 200)
                self.assertTrue({f.result().status for f in large} <= {200, 201, 422})
            return took, (time.monotonic() - start) / 2

        self.assert_within(attempt)

    def test_many_members_by_name_are_refused(self):
        body = json.dumps({"scene": "four-bar", "state": {f"x{i}": 0 for i in range(50000)}})

        def check(answer, cpu):
            self.assertEqual(answer.status, 422)
            self.assertLess(cpu, 1 * driver.SLOW)

        self.assert_unhindered(self.server, lambda: self.post("terms", body), check)

    def test_samples_at_one_time_count_against_the_limit(self):
        run = {"scene": "four-bar", "method": RK4, "time": 1, "at": [0.5005] * 99999, "reactions": True}
        tried = []

        def ask():
            # another question each time, so that it is computed
            tried.append(0)
            return self.post("runs", json.dumps({**run, "at": run["at"][: 60000 - len(tried)]}))

        def check(answer, cpu):
            self.assertIn(answer.status, (201, 202, 422), answer.body[:300])
            self.assertLess(cpu, (2 + 2) * driver.SLOW)

        self.assert_unhindered(self.server, ask, check)
        # more numbers than one answer holds are refused before anything is computed
        before = self.server.cpu()
        answer = self.post("runs", json.dumps({**run, **RING, "method": "projection@rk4:h=1e-3"}))
        self.assertEqual(answer.status, 422)
        self.assertIn("more than one answer may hold", answer.json()["errors"][0]["detail"])
        self.assertLess(self.server.cpu() - before, 2 * driver.SLOW)

    def test_a_scene_has_a_budget_of_characters(self):
        with open("lessons/11-cabinet/scenes/ring.json") as f:
            scene = json.load(f)
        long = "+".join(["sin(th_0)*cos(th_0)"] * 1000)
        scene["draw"] = {"points": {f"p{k} {{i}}": {"for": {"i": [1, 4999]}, "body": "link 1", "at": [long, long]} for k in range(2)}}

        def check(answer, cpu):
            self.assertEqual(answer.status, 422)
            self.assertIn("characters", json.dumps(answer.json()))
            self.assertLess(cpu, 2 * driver.SLOW)  # 27 s without the budget

        self.assert_unhindered(self.server, lambda: self.post("assemble", json.dumps({"scene": scene})), check)
        with open(f"/proc/{self.server.process.pid}/status") as f:
            peak = next(int(line.split()[1]) for line in f if line.startswith("VmHWM"))
        self.assertLess(peak, 250000 * driver.SLOW)  # 607 MB without the budget

    def many_points(self, size, n=4000):
        """A picture of so many pixels a side, of a mechanism with so many points that have names."""
        with open("lessons/11-cabinet/scenes/ring.json") as f:
            scene = json.load(f)
        scene["draw"] = {"points": {"p {i}": {"for": {"i": [1, n]}, "body": "link 1", "at": ["sin(0.7*i)", "cos(1.3*i)"]}}}
        return json.dumps({"scene": scene, "methods": [RK4], "time": 0.01, "width": size, "height": size})

    def test_names_of_many_points_take_no_time_without_end(self):
        def check(answer, cpu):
            self.assertEqual(answer.status, 200, answer.body[:300])
            self.assertLess(cpu, 10 * driver.SLOW)  # 90 s when each name was held against each point

        server = driver.Server()
        self.assert_unhindered(server, lambda: server.ask("POST", "/api/v1/snapshots", self.many_points(4096, 4000 // driver.SLOW), JSON, timeout=120), check)
        self.assertEqual(server.stop(), 0)

    def test_a_small_picture_waits_for_no_large_ones(self):
        """One thread paints at a time: it gives way between tiles."""
        small = json.dumps({"scene": "four-bar", "methods": [RK4], "time": 0.01, "width": 64, "height": 64})
        server = driver.Server()

        def attempt():
            """What a small picture takes beside two large ones, and half of what they take."""
            start, before = time.monotonic(), server.cpu()
            with concurrent.futures.ThreadPoolExecutor(2) as pool:
                large = [pool.submit(server.ask, "POST", "/api/v1/snapshots", self.many_points(4096, 10), JSON, timeout=120) for _ in range(2)]
                server.is_at_work(before)
                answer, took = server.timed("POST", "/api/v1/snapshots", small, JSON)
                self.assertEqual([answer.status] + [f.result().status for f in large], [200] * 3)
            return took, (time.monotonic() - start) / 2

        self.assert_within(attempt)
        self.assertEqual(server.stop(), 0)

    def test_painting_counts_against_the_limit(self):
        for renderer in ("", "built-in"):
            server = driver.Server("--run-cpu", "0.2", environment={"HOLONOM_RENDERER": renderer})
            answer = server.ask("POST", "/api/v1/snapshots", self.many_points(4096, 1000), JSON, timeout=120)
            self.assertEqual(answer.status, 422, renderer)
            self.assertIn("take more than 0.2 s of computing", answer.json()["detail"])
            self.assertEqual(server.stop(), 0)

    def test_equations_count_against_the_limit(self):
        # between what the scene that a comparison goes on with needs on this machine and what the cheapest of the others does
        ring = {"scene": "ring", "parameters": {"n": 60}}
        small = {"scene": "ring", "parameters": {"n": 3}, "methods": ["projection@rk4:h=1e-2"]}
        least, most = self.computing(lambda: self.server.compare(**small), 8), self.computing(lambda: self.post("terms", json.dumps(ring)), 2)
        self.assertLess(4 * least, most)
        limit = round(math.sqrt(least * most), 3)
        server = driver.Server("--run-cpu", str(limit))
        for method, path, body in (("GET", "scenes/ring?set=n:60", None), ("POST", "inspect", ring), ("POST", "terms", ring),
                                   ("POST", "comparisons", {**ring, "methods": ["projection@rk4:h=1e-2"]}),
                                   ("POST", "runs?wait=60", {**ring, "method": "ggl@radau5:rtol=1e-6", "time": 100})):
            before = server.cpu()
            answer = server.ask(method, "/api/v1/" + path, body, timeout=120)
            self.assertEqual(answer.status, 422, path)
            self.assertIn(f"take more than {limit:g} s of computing", answer.json()["detail"], path)
            # a run has as much for its scene as for its method; the scene is read before that
            self.assertLess(server.cpu() - before, 2 * limit + 1 * driver.SLOW, path)
        # a comparison goes on with the scene that it has
        c = server.compare(**small)
        address = "/api/v1/comparisons/" + c["id"]
        self.assertEqual(server.ask("PATCH", address, {"parameters": {"n": 60}}, timeout=120).status, 422)
        self.assertEqual(server.ask("PATCH", address, {"methods": ["index1@rk4:h=1e-2"], "step": 3}).json()["frame"], 3)
        self.assertEqual(server.stop(), 0)

    def test_a_grading_counts_against_the_limit(self):
        server = driver.Server("--run-cpu", "0.1")  # the steps of both parts take more than ten times that
        method = "nullspace-tangent@radau5:h="
        answer = server.ask("POST", "/api/v1/grade", {"problem": "method", "submission": {"a": method + "1.01e-5", "b": method + "2.51e-5"}})
        self.assertEqual(answer.status, 422)
        self.assertIn("take more than 0.1 s of computing", answer.json()["detail"])
        self.assertLess(server.cpu(), 2 * driver.SLOW)
        self.assertEqual(server.stop(), 0)

    def test_a_change_interrupts_a_frame(self):
        slow = ["index1@rk4:h=1e-9", "baumgarte@rk4:h=1e-9", "projection@rk4:h=1e-9"]
        fast = json.dumps({"methods": [m.replace("1e-9", "0.01") for m in slow]})

        def attempt():
            # the same change of one that is at rest, then of one in the middle of a frame of 96 s
            at_rest, before = self.server.compare(methods=slow), self.server.cpu()
            busy = self.server.compare(methods=slow, paused=False)
            usual = min(self.server.timed("PATCH", "/api/v1/comparisons/" + at_rest["id"], fast, JSON)[1] for _ in range(3))
            self.server.is_at_work(before)
            answer, took = self.server.timed("PATCH", "/api/v1/comparisons/" + busy["id"], fast, JSON)
            self.assertEqual(answer.status, 200)
            self.assertTrue(driver.until(lambda: self.server.ask("GET", "/api/v1/comparisons/" + busy["id"]).json()["frame"] > 3))
            for c in (at_rest, busy):
                self.server.ask("DELETE", "/api/v1/comparisons/" + c["id"])
            return took, max(0.3 * driver.SLOW, 10 * usual)

        self.assert_within(attempt)

    def test_a_frame_that_takes_too_long_says_how_slow_it_is(self):
        c = self.server.compare(methods=["index1@rk4:h=1e-9"])
        answer = self.post("comparisons/" + c["id"], '{"step": 1}', "PATCH")
        reason = answer.json()["latest"]["methods"][0]["reason"]
        self.assertRegex(reason, r"times as long as real time; take a larger step")

    def test_a_slow_frame_is_reported_while_it_is_computed(self):
        """Nothing was sent, and the lag was 0, until all methods had used up their 2 s for the frame."""
        c = self.server.compare(methods=["projection@rk4:h=1e-9", "index1@rk4:h=1e-9"], paused=False)
        events = driver.Events(self.server, c["id"])
        slow = events.until("slow")[-1][2]
        self.assertEqual((slow["generation"], slow["frame"], slow["method"]), (0, 1, 0))
        self.assertGreater(slow["slowness"], 1)
        self.assertLess(slow["computed_s"], 1)
        self.assertRegex(slow["detail"], r"^projection@rk4:h=1e-09 runs [0-9.e+]+ times slower than the clock")
        self.assertRegex(slow["hint"], "take a larger step, .* more than 2 s for a frame is stopped")
        late = []  # a method has 2 s of computing, so there is time to ask
        self.assertTrue(driver.until(lambda: late.append(self.server.ask("GET", "/api/v1/comparisons/" + c["id"]).json()) or late[-1]["lag"] > 0))
        self.assertEqual(late[-1]["frame"], 0)
        events.close()
        self.server.ask("DELETE", "/api/v1/comparisons/" + c["id"])

    def test_steps_make_way_for_a_later_request(self):
        def attempt():
            c = self.server.compare(**RING, methods=["projection@rk4:h=1e-4"])
            address, replies = "/api/v1/comparisons/" + c["id"], []
            usual = min(self.server.timed("PATCH", address, '{"reset": true}', JSON)[1] for _ in range(3))
            steps = threading.Thread(target=lambda: replies.append(self.post("comparisons/" + c["id"], '{"step": 600}', "PATCH")))
            before = self.server.cpu()
            steps.start()
            self.server.is_at_work(before)
            answer, took = self.server.timed("PATCH", address, '{"reset": true}', JSON)
            steps.join()
            self.assertEqual((answer.status, replies[0].status, answer.json()["frame"]), (200, 200, 0))
            self.server.ask("DELETE", address)
            return took, max(1 * driver.SLOW, 10 * usual)

        self.assert_within(attempt)


class NobodyReads(Timed):
    def test_answers_to_runs_that_nobody_reads_are_bounded(self):
        """One run, asked for by many who do not read: each had its copy, however many there were."""
        server = driver.Server()
        question = {"scene": "four-bar", "method": "index1@rk4:h=1e-2", "time": 30, "every": 1e-3}
        size = len(driver.run_to_end(server, question).body)
        bound = server.ask("GET", "/api/v1/").json()["limits"]["unread_bytes"]
        most = bound // size
        question["time"] -= 1e-3  # another one, which all wait for at once
        body = json.dumps(question).encode()
        head = f"POST /api/v1/runs?wait=60 HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\nContent-Length: {len(body)}\r\n\r\n"
        sockets = []
        for _ in range(most + 8):
            s = socket.socket()
            s.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            s.settimeout(60 * driver.SLOW)
            s.connect(("127.0.0.1", server.port))
            s.sendall(head.encode() + body)
            sockets.append(s)
        answers = [s.recv(2048) for s in sockets]
        refused = [a for a in answers if a.startswith(b"HTTP/1.1 429 ")]
        self.assertEqual(len(refused) + sum(a.startswith((b"HTTP/1.1 200 ", b"HTTP/1.1 201 ")) for a in answers), len(answers))
        self.assertGreaterEqual(len(refused), 7)
        for answer in refused:
            self.assertIn(b"\r\nRetry-After: 5\r\n", answer)

        # whoever reads again has the whole
        for s in sockets:
            s.close()
        again = []
        self.assertTrue(driver.until(lambda: again.append(server.ask("POST", "/api/v1/runs", question)) or again[-1].status == 200))
        self.assertGreater(len(again[-1].body), 0.9 * size)
        self.assertEqual(server.stop(), 0, server.errors)


class GoingDown(Timed):
    """SIGTERM ends it within 3 s, whatever runs."""

    def end(self, begin):
        """Begins something, again if the machine was busy, and stops the server."""

        def attempt():
            server = begin()
            start = time.monotonic()
            self.assertEqual(server.stop(), 0)
            return time.monotonic() - start, 3 * driver.SLOW

        self.assert_within(attempt)

    def beginning(self, *requests):
        server = driver.Server()
        before, threads = server.cpu(), []
        for method, path, body in requests:
            def ask(method=method, path=path, body=body):
                try:
                    server.ask(method, path, body)
                except (OSError, http.client.HTTPException):
                    pass
            threads.append(threading.Thread(target=ask, daemon=True))
            threads[-1].start()
        server.is_at_work(before, threads)
        return server

    def test_while_equations_are_formed(self):
        ring = {"scene": "ring", "parameters": {"n": 100}}
        requests = [("GET", "/api/v1/scenes/ring?set=n:100", None), ("POST", "/api/v1/inspect", ring),
                    ("POST", "/api/v1/comparisons", {**ring, "methods": ["projection@rk4:h=1e-2"]}),
                    ("POST", "/api/v1/runs", {**ring, "methods": ["ggl@radau5:rtol=1e-6"], "time": 100})]
        self.end(lambda: self.beginning(*requests))

    def test_while_studies_form_equations(self):
        ring = {"scene": "ring", "parameters": {"n": 100}, "time": 1}
        self.end(lambda: self.beginning(
            ("POST", "/api/v1/studies", {**ring, "kind": "work-precision", "methods": ["ggl@radau5", "projection@rk4"]}),
            ("POST", "/api/v1/studies", {**ring, "kind": "budget", "methods": ["index1@rk4:h=1e-2"]})))
        self.end(lambda: self.beginning(("POST", "/api/v1/studies", {**ring, "kind": "stability", "methods": ["baumgarte@rk4:h=1e-2"]})))

    def test_while_steps_are_computed(self):
        def begin():
            server = driver.Server()
            c = server.compare(**RING, methods=["projection@rk4:h=1e-4", "nullspace@rk4:h=1e-4", "index1@rk4:h=1e-4"])
            before = server.cpu()
            threading.Thread(target=lambda: server.ask("PATCH", "/api/v1/comparisons/" + c["id"], {"step": 600}), daemon=True).start()
            server.is_at_work(before)
            self.assertEqual(server.ask("DELETE", "/api/v1/comparisons/" + c["id"]).status, 204)
            return server

        self.end(begin)

    def test_while_long_requests_run_and_wait(self):
        run = {**RING, "method": "projection@rk4:h=1e-5", "time": 1000}
        self.end(lambda: self.beginning(*[("POST", "/api/v1/runs", {**run, "time": 1000 + i}) for i in range(30)]))

    def test_while_bodies_are_checked(self):
        self.end(lambda: self.beginning(*[("POST", "/api/v1/terms", many_members('"t":1'))] * 3))

    def test_while_samples_are_taken_at_one_time(self):
        run = {**RING, "method": "projection@rk4:h=1e-3", "time": 1, "at": [0.5] * 20000}
        self.end(lambda: self.beginning(*[("POST", "/api/v1/runs", run)] * 3))

    def test_who_waits_for_a_picture_is_told_that_the_server_ends(self):
        """422, "stopped on request", was a fault of the request."""
        server, answers = driver.Server(), []
        picture = {**RING, "methods": ["projection@rk4:h=1e-5"], "time": 1000}
        thread = threading.Thread(target=lambda: answers.append(server.ask("POST", "/api/v1/snapshots", picture)))
        before = server.cpu()
        thread.start()
        server.is_at_work(before, [thread])
        self.assertEqual(server.stop(), 0)
        thread.join()
        self.assertEqual((answers[0].status, answers[0].json()["type"]), (503, "/api/v1/errors/stopping"))

    def test_while_large_pictures_are_painted(self):
        """They were painted to their ends: 2 to 3.4 s, and then the process was ended by force, without an answer."""
        picture = {"scene": "four-bar", "methods": ["index1@rk4:h=1e-2"], "time": 1, "width": 4096, "height": 4096}

        def attempt(renderer):
            server, answers = driver.Server(environment={"HOLONOM_RENDERER": renderer}), []
            threads = [threading.Thread(target=lambda: answers.append(server.ask("POST", "/api/v1/snapshots", picture))) for _ in range(3)]
            before = server.cpu()
            for t in threads:
                t.start()
            server.is_at_work(before, threads)
            start = time.monotonic()
            self.assertEqual((server.stop(), server.errors), (0, []))
            took = time.monotonic() - start
            for t in threads:
                t.join()
            self.assertEqual([a.json()["type"] for a in answers if a.status != 200], ["/api/v1/errors/stopping"] * 3)
            return took, 1 * driver.SLOW

        for renderer in ("", "built-in"):
            self.assert_within(lambda: attempt(renderer))

    def test_while_pictures_are_drawn_and_references_computed(self):
        picture = {**RING, "methods": ["projection@rk4:h=1e-5"], "time": 1000}
        self.end(lambda: self.beginning(("POST", "/api/v1/snapshots", picture),
                                        ("GET", "/api/v1/scenes/ring/reference?compute=true&time=30", None)))


if __name__ == "__main__":
    driver.main()
