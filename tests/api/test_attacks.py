# SPDX-License-Identifier: GPL-3.0-or-later
"""Whoever holds up the server holds up himself: what a hostile or careless client sends, and what the others notice."""

import http.client
import json
import signal
import socket
import threading
import time
import unittest

import driver

RK4 = "index1@rk4:h=1e-3"
BESIDE = 0.2 * driver.SLOW  # the longest answer of healthz beside an attack [s]
RING = {"scene": "ring", "parameters": {"n": 12}}


def beside(server, attack):
    """Runs the attack; what healthz took meanwhile, and what the attack returned."""
    result = []
    thread = threading.Thread(target=lambda: result.append(attack()))
    thread.start()
    times = []
    while thread.is_alive() or not times:
        start = time.monotonic()
        assert server.ask("GET", "/healthz").status == 200
        times.append(time.monotonic() - start)
        time.sleep(0.01)
    thread.join()
    return max(times), result[0]


def many_members(known, n_unknown=70000, n_known=20000):
    members = [f'"x{i}":0' for i in range(n_unknown)] + [known] * n_known
    return ("{" + ",".join(members) + "}").encode()


class NobodyWaitsForAnother(unittest.TestCase):
    def setUp(self):
        self.server = driver.Server("--run-cpu", "2")

    def tearDown(self):
        self.assertEqual(self.server.stop(), 0, self.server.errors)

    def post(self, path, body, method="POST"):
        start = time.monotonic()
        answer = self.server.ask(method, "/api/v1/" + path, body, {"Content-Type": "application/json"})
        return answer, time.monotonic() - start

    def test_a_body_of_many_members_is_checked_in_one_pass(self):
        c = self.server.compare()
        for path, method, known in (("comparisons/" + c["id"], "PATCH", '"speed":1'), ("terms", "POST", '"t":1')):
            for body in (many_members(known), many_members(known, n_unknown=0, n_known=80000)):
                longest, (answer, took) = beside(self.server, lambda: self.post(path, body, method))
                self.assertEqual(answer.status, 422, answer.body[:200])
                self.assertLessEqual(len(answer.json()["errors"]), 16)
                self.assertLess(took, 1 * driver.SLOW)
                self.assertLess(longest, BESIDE)

    def test_many_members_by_name_are_refused(self):
        body = json.dumps({"scene": "four-bar", "state": {f"x{i}": 0 for i in range(50000)}})
        longest, (answer, took) = beside(self.server, lambda: self.post("terms", body))
        self.assertEqual(answer.status, 422)
        self.assertLess(took, 1 * driver.SLOW)
        self.assertLess(longest, BESIDE)

    def test_samples_at_one_time_count_against_the_limit(self):
        run = {"scene": "four-bar", "method": RK4, "time": 1, "at": [0.5005] * 99999, "reactions": True}
        longest, (answer, took) = beside(self.server, lambda: self.post("runs", json.dumps({**run, "at": run["at"][:60000]})))
        self.assertIn(answer.status, (201, 422), answer.body[:300])
        self.assertLess(took, (2 + 2) * driver.SLOW)
        self.assertLess(longest, BESIDE)
        # more numbers than one answer holds are refused before anything is computed
        answer, took = self.post("runs", json.dumps({**run, **RING, "method": "projection@rk4:h=1e-3"}))
        self.assertEqual(answer.status, 422)
        self.assertIn("more than one answer may hold", answer.json()["errors"][0]["detail"])
        self.assertLess(took, 2 * driver.SLOW)

    def test_a_scene_has_a_budget_of_characters(self):
        with open("lessons/02-mechanisms/scenes/ring.json") as f:
            scene = json.load(f)
        long = "+".join(["sin(th_0)*cos(th_0)"] * 1000)
        scene["draw"] = {"points": {f"p{k} {{i}}": {"for": {"i": [1, 4999]}, "body": "link 1", "at": [long, long]} for k in range(2)}}
        longest, (answer, took) = beside(self.server, lambda: self.post("assemble", json.dumps({"scene": scene})))
        self.assertEqual(answer.status, 422)
        self.assertIn("characters", json.dumps(answer.json()))
        self.assertLess(took, 2 * driver.SLOW)
        self.assertLess(longest, BESIDE)
        with open(f"/proc/{self.server.process.pid}/status") as f:
            peak = next(int(line.split()[1]) for line in f if line.startswith("VmHWM"))
        self.assertLess(peak, 250000 * driver.SLOW)  # 607 MB without the budget

    def test_a_change_interrupts_a_frame(self):
        slow = ["index1@rk4:h=1e-9", "baumgarte@rk4:h=1e-9", "projection@rk4:h=1e-9"]
        c = self.server.compare(methods=slow, paused=False)
        time.sleep(0.5)
        fast = [m.replace("1e-9", "0.01") for m in slow]
        answer, took = self.post("comparisons/" + c["id"], json.dumps({"methods": fast}), "PATCH")
        self.assertEqual(answer.status, 200)
        self.assertLess(took, 0.3 * driver.SLOW)
        time.sleep(0.5)
        self.assertGreater(self.server.ask("GET", "/api/v1/comparisons/" + c["id"]).json()["frame"], 3)

    def test_a_frame_that_takes_too_long_says_how_slow_it_is(self):
        c = self.server.compare(methods=["index1@rk4:h=1e-9"])
        answer, took = self.post("comparisons/" + c["id"], '{"step": 1}', "PATCH")
        reason = answer.json()["latest"]["methods"][0]["reason"]
        self.assertRegex(reason, r"times slower than the clock; take a larger step")

    def test_steps_make_way_for_a_later_request(self):
        c = self.server.compare(**RING, methods=["projection@rk4:h=1e-4"])
        replies = []
        steps = threading.Thread(target=lambda: replies.append(self.post("comparisons/" + c["id"], '{"step": 600}', "PATCH")))
        steps.start()
        time.sleep(0.3)
        answer, took = self.post("comparisons/" + c["id"], '{"reset": true}', "PATCH")
        steps.join()
        self.assertEqual((answer.status, replies[0][0].status, answer.json()["frame"]), (200, 200, 0))
        self.assertLess(took, 1 * driver.SLOW)


class ManySockets(unittest.TestCase):
    def test_any_number_of_sockets_that_are_ready_at_one_instant_is_served(self):
        for n in (127, 128, 129, 255, 256):
            server = driver.Server()
            clients = [socket.create_connection(("127.0.0.1", server.port), timeout=10 * driver.SLOW) for _ in range(n)]
            time.sleep(0.5)
            # held back, so that they arrive together
            server.process.send_signal(signal.SIGSTOP)
            for c in clients:
                c.sendall(b"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
            time.sleep(0.2)
            server.process.send_signal(signal.SIGCONT)
            start = time.monotonic()
            for c in clients:
                self.assertTrue(c.recv(4096).startswith(b"HTTP/1.1 200"), n)
            self.assertLess(time.monotonic() - start, 2 * driver.SLOW, n)
            for c in clients:
                c.close()
            self.assertEqual(server.stop(), 0)

    def test_a_head_that_never_ends_loses_its_place(self):
        server = driver.Server()
        clients = []
        for _ in range(200):
            c = socket.create_connection(("127.0.0.1", server.port), timeout=1)
            c.sendall(b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX-A: ")
            clients.append(c)
        times, end = [], time.monotonic() + 11.5
        while time.monotonic() < end:
            start = time.monotonic()
            self.assertEqual(server.ask("GET", "/healthz").status, 200)
            times.append(time.monotonic() - start)
            for c in clients:
                try:
                    c.send(b"a")
                except OSError:
                    pass
            time.sleep(0.5)
        self.assertLess(max(times), BESIDE)
        alive = 0
        for c in clients:
            try:
                alive += c.recv(1) != b""
            except ConnectionError:
                pass
            except OSError:
                alive += 1
            c.close()
        self.assertEqual(alive, 0)
        self.assertEqual(server.stop(), 0)


class From:
    """A client with another address of this machine."""

    def __init__(self, server, address):
        self.server, self.address = server, address

    def ask(self, method, path, body=None):
        c = http.client.HTTPConnection("127.0.0.1", self.server.port, timeout=30 * driver.SLOW, source_address=(self.address, 0))
        c.request(method, path, json.dumps(body) if body is not None else None, {"Content-Type": "application/json"})
        answer = driver.Answer(c.getresponse())
        c.close()
        return answer


class FairShares(unittest.TestCase):
    MAKE = ("POST", "/api/v1/comparisons", {"scene": "four-bar", "methods": [RK4]})

    def test_one_client_takes_its_share_of_comparisons_and_no_more(self):
        server = driver.Server("--max-comparisons", "4")
        greedy, modest = From(server, "127.0.0.2"), From(server, "127.0.0.3")
        self.assertEqual([greedy.ask(*self.MAKE).status for _ in range(3)], [201, 201, 429])
        self.assertEqual([modest.ask(*self.MAKE).status for _ in range(3)], [201, 201, 429])
        self.assertEqual(server.stop(), 0)

    def test_one_that_was_left_makes_room(self):
        server = driver.Server("--max-comparisons", "1")
        first = server.compare()
        events = driver.Events(server, first["id"])
        events.take(1)
        busy = server.ask(*self.MAKE)
        self.assertEqual(busy.status, 429)
        events.close()
        time.sleep(int(busy.headers["retry-after"]) + 1)
        self.assertEqual(server.ask(*self.MAKE).status, 201)
        self.assertEqual(server.ask("GET", "/api/v1/comparisons/" + first["id"]).status, 404)
        self.assertEqual(server.stop(), 0)

    def test_streams_are_shared_out(self):
        server = driver.Server("--max-streams", "4")
        c = server.compare()
        streams, statuses = [], []
        for _ in range(3):
            s = socket.socket()
            s.bind(("127.0.0.2", 0))
            s.connect(("127.0.0.1", server.port))
            s.sendall(f"GET /api/v1/comparisons/{c['id']}/events HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n".encode())
            statuses.append(s.recv(15)[9:12])
            streams.append(s)
        self.assertEqual(statuses, [b"200", b"200", b"429"])
        self.assertEqual(driver.Events(server, c["id"]).status, 200)
        for s in streams:
            s.close()
        self.assertEqual(server.stop(), 0)

    def test_what_costs_nothing_has_a_queue_of_its_own(self):
        server = driver.Server("--run-cpu", "3")
        run = {**RING, "method": "projection@rk4:h=1e-4", "time": 1000}
        threads = [threading.Thread(target=server.ask, args=("POST", "/api/v1/runs", run)) for _ in range(12)]
        for t in threads:
            t.start()
        time.sleep(0.5)
        for path in ("/api/v1/scenes/four-bar", "/api/v1/scenes", "/"):
            start = time.monotonic()
            self.assertEqual(server.ask("GET", path).status, 200)
            self.assertLess(time.monotonic() - start, 2 * driver.SLOW, path)
        start = time.monotonic()
        self.assertEqual(server.ask(*self.MAKE).status, 201)
        self.assertLess(time.monotonic() - start, 2 * driver.SLOW)
        start = time.monotonic()
        self.assertEqual(server.stop(), 0)
        self.assertLess(time.monotonic() - start, 3 * driver.SLOW)
        for t in threads:
            t.join()


class GoingDown(unittest.TestCase):
    """SIGTERM ends it within 3 s, whatever runs."""

    def end(self, server):
        start = time.monotonic()
        self.assertEqual(server.stop(), 0)
        self.assertLess(time.monotonic() - start, 3 * driver.SLOW)

    def beginning(self, *requests):
        server = driver.Server()
        ids = []
        for method, path, body in requests:
            def ask(method=method, path=path, body=body):
                try:
                    server.ask(method, path, body)
                except (OSError, http.client.HTTPException):
                    pass
            threading.Thread(target=ask, daemon=True).start()
        time.sleep(1)
        return server

    def test_while_steps_are_computed(self):
        server = driver.Server()
        c = server.compare(**RING, methods=["projection@rk4:h=1e-4", "nullspace@rk4:h=1e-4", "index1@rk4:h=1e-4"])
        threading.Thread(target=lambda: server.ask("PATCH", "/api/v1/comparisons/" + c["id"], {"step": 600}), daemon=True).start()
        time.sleep(0.5)
        self.assertEqual(server.ask("DELETE", "/api/v1/comparisons/" + c["id"]).status, 204)
        self.end(server)

    def test_while_long_requests_run_and_wait(self):
        run = {**RING, "method": "projection@rk4:h=1e-5", "time": 1000}
        self.end(self.beginning(*[("POST", "/api/v1/runs", run)] * 30))

    def test_while_bodies_are_checked(self):
        self.end(self.beginning(*[("POST", "/api/v1/terms", many_members('"t":1'))] * 3))

    def test_while_samples_are_taken_at_one_time(self):
        run = {**RING, "method": "projection@rk4:h=1e-3", "time": 1, "at": [0.5] * 20000}
        self.end(self.beginning(*[("POST", "/api/v1/runs", run)] * 3))

    def test_while_pictures_are_drawn_and_references_computed(self):
        picture = {**RING, "methods": ["projection@rk4:h=1e-5"], "time": 1000}
        self.end(self.beginning(("POST", "/api/v1/snapshots", picture), ("GET", "/api/v1/scenes/ring/reference?compute=true&time=30", None)))


if __name__ == "__main__":
    driver.main()
