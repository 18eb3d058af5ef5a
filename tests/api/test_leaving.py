# SPDX-License-Identifier: GPL-3.0-or-later
"""A client that goes away during a long request: its computation ends in seconds, and nobody else's does."""

import glob
import json
import socket
import threading
import time

import driver
from beside import RING

LONG = {**RING, "methods": ["projection@rk4:h=1e-5"], "time": 1000}
RUN_CPU = "600"  # nothing here ends by itself


def request(path, body=None, version="1.1"):
    text = json.dumps(body).encode() if body is not None else b""
    head = f"{'POST' if body is not None else 'GET'} {path} HTTP/{version}\r\nHost: 127.0.0.1\r\n"
    if body is not None:
        head += f"Content-Type: application/json\r\nContent-Length: {len(text)}\r\n"
    return head.encode() + b"\r\n" + text


def state_of(task):
    try:
        with open(task) as f:
            return f.read().rsplit(")", 1)[1].split()[0]
    except OSError:
        return ""  # the thread has ended


class Leaving(driver.ServerCase):
    options = ("--run-cpu", RUN_CPU)
    environment = {"HOLONOM_NATIVE": "0"}  # a compiler in the background computes for whoever asks next

    def send(self, *what):
        s = socket.create_connection(("127.0.0.1", self.server.port), timeout=60 * driver.SLOW)
        s.sendall(request(*what))
        return s

    def share_at_work(self, looks=20):
        """The part of some looks, in a second, at which a thread of the server computes, or would if the machine had time for it."""
        n = 0
        for _ in range(looks):
            time.sleep(1 / looks)
            tasks = glob.glob(f"/proc/{self.server.process.pid}/task/*/stat")
            n += any(state_of(path) == "R" for path in tasks)
        return n / looks

    def works(self):
        return self.share_at_work() > 0.8

    def rests(self):
        return self.share_at_work() < 0.2

    def assert_ends_when_left(self, *what):
        self.assertTrue(driver.until(self.rests, 60), "the server did not come to rest before")
        s = self.send(*what)
        self.assertTrue(driver.until(self.works), f"{what}: it does not compute")
        self.assertTrue(self.works(), f"{what}: it ended by itself")
        s.close()
        self.assertTrue(driver.until(self.rests, 60), f"{what}: it goes on for nobody")

    def test_a_picture(self):
        self.assert_ends_when_left("/api/v1/snapshots", LONG)

    def test_a_reference_motion(self):
        self.assert_ends_when_left("/api/v1/scenes/ring/reference?compute=true&set=n:20")

    def test_gradings(self):
        """Each would end by itself, after 400,000 steps: those that were left cost less than as many whole ones."""
        a, b = (f"nullspace-tangent@radau5:h={driver.SLOW * h:g}" for h in (1.01e-5, 2.51e-5))
        body = {"problem": "method", "submission": {"a": a, "b": b}}
        before = self.server.cpu()
        self.assertEqual(self.server.ask("POST", "/api/v1/grade", body).status, 200)
        whole = self.server.cpu() - before
        many = 12
        before = self.server.cpu()
        for s in [self.send("/api/v1/grade", body) for _ in range(many)]:
            s.close()
        self.assertTrue(driver.until(self.rests, 120))
        self.assertLess(self.server.cpu() - before, 0.8 * many * whole)

    def test_a_comparison_or_study_that_is_being_made_is_not_kept(self):
        # its equations take seconds: the client has gone before they are there, on a busy machine too
        question = {"scene": "ring", "parameters": {"n": 100}, "methods": ["projection@rk4"]}
        self.send("/api/v1/comparisons", question).close()
        self.send("/api/v1/studies", {**question, "kind": "work-precision"}).close()
        self.assertTrue(driver.until(self.rests, 60))
        for route in ("comparisons", "studies"):
            self.assertEqual(self.server.ask("GET", "/api/v1/" + route).json()[route], [])

    def test_a_run_that_nobody_was_told_of(self):
        self.assert_ends_when_left("/api/v1/runs?wait=50", LONG)
        # it is gone, and asked again it begins anew
        again = self.server.ask("POST", "/api/v1/runs?wait=0", LONG)
        self.assertEqual(again.status, 202)
        self.assertEqual(self.server.ask("DELETE", "/api/v1/runs/" + again.json()["id"]).status, 204)

    def test_a_run_that_another_waits_for_goes_on(self):
        question = {**LONG, "time": 1001}
        first, second = self.send("/api/v1/runs?wait=50", question), self.send("/api/v1/runs?wait=50", question)
        self.assertTrue(driver.until(self.works))
        first.close()
        time.sleep(2)
        self.assertTrue(self.works())
        second.close()
        self.assertTrue(driver.until(self.rests, 60))

    def test_a_run_whose_id_was_told_goes_on(self):
        run = self.server.ask("POST", "/api/v1/runs?wait=0", {**LONG, "time": 1002}).json()["id"]
        left = self.send(f"/api/v1/runs/{run}?wait=50")
        time.sleep(0.5)
        left.close()
        time.sleep(2)
        self.assertTrue(self.works())
        self.assertEqual(self.server.ask("GET", "/api/v1/runs/" + run).json()["state"], "running")
        self.server.ask("DELETE", "/api/v1/runs/" + run)

    def test_a_run_whose_id_was_listed_goes_on(self):
        s = self.send("/api/v1/runs?wait=50", {**LONG, "time": 1004})
        self.assertTrue(driver.until(self.works))
        listed = self.server.ask("GET", "/api/v1/runs").json()["runs"]
        s.close()
        time.sleep(2)
        self.assertIn("running", [self.server.ask("GET", f"/api/v1/runs/{run}").json().get("state") for run in listed])
        for run in listed:
            self.server.ask("DELETE", "/api/v1/runs/" + run)

    def ask_and_close_own_side(self, *what):
        """The answer to a client that sends no more and reads on, as `nc -N` does. It may get a "100 Continue" first."""
        s = self.send(*what)
        s.shutdown(socket.SHUT_WR)
        reply = b""
        while piece := s.recv(65536):
            reply += piece
        s.close()
        return reply.replace(b"HTTP/1.1 100 Continue\r\n\r\n", b"", 1)

    PICTURE = {**RING, "methods": ["projection@rk4:h=1e-3"], "time": 3}

    def test_a_client_that_closes_its_own_side_only_has_its_answer(self):
        answers = {}

        def ask(name, *what):
            answers[name] = self.ask_and_close_own_side(*what)

        threads = [threading.Thread(target=ask, args=("run", "/api/v1/runs?wait=2", {**LONG, "time": 1003})),
                   threading.Thread(target=ask, args=("picture", "/api/v1/snapshots", self.PICTURE))]
        for t in threads:
            t.start()
        for t in threads:
            t.join()
        self.assertTrue(answers["run"].startswith(b"HTTP/1.1 202 "), answers["run"][:200])
        self.assertTrue(answers["picture"].startswith(b"HTTP/1.1 200 "), answers["picture"][:200])
        run = json.loads(answers["run"].split(b"\r\n\r\n", 1)[1])["id"]
        self.assertEqual(self.server.ask("DELETE", "/api/v1/runs/" + run).status, 204)

    def test_a_client_of_http_1_0_that_closes_its_own_side_has_its_answer(self):
        """It takes no "100 Continue": it was held to have gone."""
        for path, body in (("/api/v1/snapshots", self.PICTURE), ("/api/v1/runs?wait=50", self.PICTURE)):
            answer = self.ask_and_close_own_side(path, body, "1.0")
            self.assertRegex(answer, rb"^HTTP/1\.[01] 20[01] ")

    def test_connections_that_are_idle_take_no_answer_from_who_has_closed_its_own_side(self):
        """Beside an older connection in the same event loop, a connection was read before its answer was sent, and closed."""
        idle = [self.send("/healthz") for _ in range(8)]  # in every loop
        for s in idle:
            self.assertTrue(s.recv(65536).startswith(b"HTTP/1.1 200 "))
        for i in range(12):
            answer = self.ask_and_close_own_side("/api/v1/snapshots", {"scene": "four-bar", "methods": ["projection@rk4:h=1e-3"], "time": 0.1 * i})
            self.assertTrue(answer.startswith(b"HTTP/1.1 200 "), (i, answer[:200]))
        for s in idle:
            s.close()


if __name__ == "__main__":
    driver.main()
