# SPDX-License-Identifier: GPL-3.0-or-later
"""Places and queues are shared out among clients: none takes another's."""

import http.client
import json
import re
import socket
import subprocess
import threading
import time

import driver
from beside import From, RING, RK4, Timed, is_closed


class FairShares(Timed):
    MAKE = ("POST", "/api/v1/comparisons", {"scene": "four-bar", "methods": [RK4]})
    AT_ONCE = ("POST", "/api/v1/comparisons?wait=0", MAKE[2])

    def test_one_client_takes_its_share_of_comparisons_and_no_more(self):
        server = driver.Server("--max-comparisons", "4")
        greedy, modest = From(server, "127.0.0.2"), From(server, "127.0.0.3")
        self.assertEqual([greedy.ask(*self.AT_ONCE).status for _ in range(3)], [201, 201, 429])
        self.assertEqual([modest.ask(*self.AT_ONCE).status for _ in range(3)], [201, 201, 429])
        self.assertEqual(server.stop(), 0)

    def test_a_request_waits_for_a_place(self):
        server = driver.Server("--max-comparisons", "1")
        first = server.compare()
        events, answers = driver.Events(server, first["id"]), []
        events.take(1)

        def ask(wait):
            answers.append(server.ask("POST", f"/api/v1/comparisons?wait={wait}", self.MAKE[2], timeout=90))

        def waiting():
            detail = server.ask("POST", "/api/v1/comparisons?wait=0", self.MAKE[2]).json()["detail"]
            return int(re.search(r"(\d+) requests wait before", detail).group(1))

        def begin(wait):
            threads.append(threading.Thread(target=ask, args=(wait,)))
            threads[-1].start()
            # it waits, or has waited for so short a time that it was not seen to
            self.assertTrue(driver.until(lambda: waiting() == len(threads) or len(answers) > 0))

        # the first of three waits for longest, the second too short a time, the third goes away
        threads = []
        begin(50)
        begin(2)
        left = socket.create_connection(("127.0.0.1", server.port))
        body = json.dumps(self.MAKE[2]).encode()
        left.sendall(b"POST /api/v1/comparisons HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
                     + f"Content-Length: {len(body)}\r\n\r\n".encode() + body)
        time.sleep(0.5)
        busy = server.ask("POST", "/api/v1/comparisons?wait=0", self.MAKE[2])
        self.assertEqual(busy.status, 429)
        self.assertRegex(busy.json()["detail"], r"\b[23] requests wait before this one")
        left.close()
        threads[1].join()
        self.assertEqual((answers[0].status, answers[0].headers["retry-after"]), (429, "5"))
        self.assertIn("1 requests wait", answers[0].json()["detail"])

        # a place that is given up goes to who waits, and nobody made one for who had gone
        self.assertEqual(server.ask("DELETE", "/api/v1/comparisons/" + first["id"]).status, 204)
        threads[0].join()
        self.assertEqual(answers[1].status, 201)
        self.assertEqual(server.ask("GET", "/api/v1/comparisons").json()["comparisons"], [answers[1].json()["id"]])
        events.close()
        self.assertEqual(server.stop(), 0)

    def test_who_waits_for_a_place_is_told_when_the_server_ends(self):
        server = driver.Server("--max-comparisons", "1")
        events, answers = driver.Events(server, server.compare()["id"]), []
        events.take(1)
        thread = threading.Thread(target=lambda: answers.append(server.ask(*self.MAKE, timeout=90)))
        thread.start()
        busy = lambda: server.ask(*self.AT_ONCE).json()["detail"]
        self.assertTrue(driver.until(lambda: "1 requests wait before" in busy()))
        self.assertEqual(server.stop(), 0)
        thread.join()
        self.assertEqual(answers[0].status, 503)

    def test_one_client_takes_no_place_from_another_by_waiting(self):
        """A client with its share is not given the place that another client has left."""
        server = driver.Server("--max-comparisons", "4")
        greedy, modest = From(server, "127.0.0.2"), From(server, "127.0.0.3")
        theirs = modest.ask(*self.MAKE).json()["id"]
        time.sleep(6)
        own = [greedy.ask(*self.MAKE).json()["id"] for _ in range(2)]
        readers = [driver.Events(server, c) for c in own]  # they are not left alone
        self.assertEqual(greedy.ask(*self.AT_ONCE).status, 429)
        self.assertIn(theirs, server.ask("GET", "/api/v1/comparisons").json()["comparisons"])
        for reader in readers:
            reader.close()
        self.assertEqual(server.stop(), 0)

    def test_one_that_was_left_makes_room(self):
        server = driver.Server("--max-comparisons", "1")
        first = server.compare()
        events = driver.Events(server, first["id"])
        events.take(1)
        busy = server.ask(*self.AT_ONCE)
        self.assertEqual(busy.status, 429)
        events.close()
        # after the time that it was told, and on a busy machine a little later; 60 s when nobody needs the place
        time.sleep(int(busy.headers["retry-after"]))
        self.assertTrue(driver.until(lambda: server.ask(*self.AT_ONCE).status == 201, 10))
        self.assertEqual(server.ask("GET", "/api/v1/comparisons/" + first["id"]).status, 404)
        self.assertEqual(server.stop(), 0)

    def test_connections_are_shared_out(self):
        server = driver.Server("--max-connections", "80")
        request = b"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"

        def connect(request=request):
            """A connection of 127.0.0.2 that stays open, None where the server does not take it."""
            s = socket.socket()
            s.settimeout(20 * driver.SLOW)
            s.bind(("127.0.0.2", 0))
            s.connect(("127.0.0.1", server.port))
            try:
                s.sendall(request)
                if s.recv(100).startswith(b"HTTP/1.1 200"):
                    return s
            except OSError:
                pass
            s.close()
            return None

        # beyond its share a client's new connections take the places of its oldest
        held = [connect() for _ in range(50)]
        self.assertEqual([s is not None for s in held], [True] * 50)
        for s in held:
            s.setblocking(False)
        # some ten of the oldest: answers that were sent at one time are done with in any order
        self.assertTrue(driver.until(lambda: sum(is_closed(s) for s in held) == 10))
        self.assertFalse(any(is_closed(s) for s in held[30:]))
        # the others have their places
        self.assertEqual(From(server, "127.0.0.3").ask("GET", "/healthz").status, 200)
        self.assertEqual(server.ask("GET", "/healthz").status, 200)
        for s in held:
            s.close()
        # one that has its share in streams gets no more
        c = server.compare()
        stream = f"GET /api/v1/comparisons/{c['id']}/events HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n".encode()
        streams = [connect(stream) for _ in range(50)]
        self.assertEqual([s is not None for s in streams], [True] * 40 + [False] * 10)
        self.assertEqual(server.ask("GET", "/healthz").status, 200)
        for s in streams[:40]:
            s.close()
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

    # ten seconds of computing and more
    STUDY = {"scene": "four-bar", "kind": "work-precision", "methods": [RK4, "projection@rk4:h=1e-3"], "samples": 10, "time": 60, "levels": 7}
    SHORT_STUDY = {**STUDY, "scene": "pendulum", "samples": 0, "time": 0.1, "levels": 2}
    STUDIES = "/api/v1/studies"
    NO_WAIT = STUDIES + "?wait=0"

    def waiting(self, client):
        """How many requests wait for the place of a study, as one more is told."""
        found = re.search(r"; (\d+) requests wait before", client.ask("POST", self.NO_WAIT, self.STUDY).json().get("detail", ""))
        return int(found.group(1)) if found else 0

    def test_one_client_does_not_hold_every_place_for_studies(self):
        server = driver.Server()
        greedy, modest, third = (From(server, f"127.0.0.{k}") for k in (2, 3, 4))
        first = greedy.ask("POST", self.NO_WAIT, self.STUDY)
        self.assertEqual(first.status, 202)
        refused = greedy.ask("POST", self.NO_WAIT, self.STUDY)
        self.assertEqual(refused.status, 503)
        self.assertIn("1 of 2 studies, which is its share", refused.json()["detail"])
        # until its own study ends: by its limit of time at the latest
        self.assertTrue(1 <= int(refused.headers["retry-after"]) <= 1 + first.json()["time_limit_s"], refused.headers)
        self.assertEqual(modest.ask("POST", self.NO_WAIT, self.STUDY).status, 202)
        refused = third.ask("POST", self.NO_WAIT, self.STUDY)
        self.assertEqual(refused.status, 503)
        self.assertIn("all 2 places for studies are taken", refused.json()["detail"])
        # nor does it by letting a study go on
        stopped = f"{self.STUDIES}/{first.json()['id']}"
        greedy.ask("PATCH", stopped, {"state": "stopped"})
        self.assertTrue(driver.until(lambda: third.ask("POST", self.NO_WAIT, self.STUDY).status == 202))
        self.assertEqual(modest.ask("PATCH", stopped + "?wait=0", {"state": "running"}).status, 503)
        self.assertEqual(server.stop(), 0)

    def test_a_study_waits_for_a_place(self):
        """It was refused at once, without a word on who waits before it."""
        server = driver.Server()
        clients = [From(server, f"127.0.0.{k}") for k in range(2, 7)]
        first = clients[0].ask("POST", self.STUDIES, self.STUDY).json()
        self.assertEqual(clients[1].ask("POST", self.STUDIES, self.STUDY).status, 202)
        answers = {}

        def ask(name, client, wait):
            answers[name] = client.ask("POST", f"{self.STUDIES}?wait={wait}", self.STUDY)

        threads = []
        for name, client, wait in (("patient", clients[2], 25), ("hasty", clients[3], 1)):
            threads.append(threading.Thread(target=ask, args=(name, client, wait)))
            threads[-1].start()
            self.assertTrue(driver.until(lambda: self.waiting(clients[4]) >= 1))
        refused = clients[4].ask("POST", self.NO_WAIT, self.STUDY)
        self.assertEqual(refused.status, 503)
        self.assertRegex(refused.json()["detail"], r"; [12] requests wait before this one; Retry-After estimates when this request would have one$")
        self.assertGreater(int(refused.headers["retry-after"]), 1)
        threads[1].join()
        self.assertEqual(answers["hasty"].status, 503)
        self.assertIn("; 1 requests wait before this one", answers["hasty"].json()["detail"])
        # a place that is given up goes to who waits
        server.ask("DELETE", f"{self.STUDIES}/{first['id']}")
        threads[0].join()
        self.assertEqual(answers["patient"].status, 202)
        # who has its share waits for an end of its own, and is told when the server ends
        threads = [threading.Thread(target=ask, args=("own", clients[2], 25))]
        threads[0].start()
        self.assertTrue(driver.until(lambda: self.waiting(clients[4]) == 1))
        self.assertEqual(server.stop(), 0)
        threads[0].join()
        self.assertEqual((answers["own"].status, answers["own"].json()["type"]), (503, "/api/v1/errors/stopping"))

    def test_a_place_that_nobody_who_waits_may_have_is_given_at_once(self):
        """While a client with its share waited for a place, others were refused although one was free."""
        server = driver.Server("--max-comparisons", "2")
        greedy, others = From(server, "127.0.0.2"), [From(server, f"127.0.0.{k}") for k in (3, 4)]
        for path, body, made, busy in ((self.STUDIES, self.STUDY, 202, 503), (self.AT_ONCE[1].split("?")[0], self.MAKE[2], 201, 429)):
            first = greedy.ask("POST", path, body)
            self.assertEqual(first.status, made)
            waiting = threading.Thread(target=greedy.ask, args=("POST", path + "?wait=50", body))
            waiting.start()
            self.assertTrue(driver.until(lambda: "1 requests wait" in greedy.ask("POST", path + "?wait=0", body).json()["detail"]))
            self.assertEqual([o.ask("POST", path + "?wait=0", body).status for o in others], [made, busy])
            self.assertEqual(greedy.ask("DELETE", f"{path}/{first.json()['id']}").status, 204)
            waiting.join()
        self.assertEqual(server.stop(), 0)

    def test_a_study_goes_on_after_those_who_wait(self):
        """Its place was free for 0.1 s before who waited was given it: going on took it first."""
        server = driver.Server()
        first, second, waiting = (From(server, f"127.0.0.{k}") for k in (2, 3, 4))
        study = f"{self.STUDIES}/{first.ask('POST', self.STUDIES, self.STUDY).json()['id']}"
        self.assertEqual(second.ask("POST", self.STUDIES, self.STUDY).status, 202)
        answers = []
        thread = threading.Thread(target=lambda: answers.append(waiting.ask("POST", f"{self.STUDIES}?wait=50", self.STUDY)))
        thread.start()
        self.assertTrue(driver.until(lambda: "1 requests wait" in first.ask("POST", self.NO_WAIT, self.STUDY).json()["detail"]))
        first.ask("PATCH", study, {"state": "stopped"})
        # 409 as long as it is still ending; the first other answer comes at once after its end
        while (on := first.ask("PATCH", study + "?wait=0", {"state": "running"})).status == 409:
            pass
        self.assertEqual(on.status, 503, on.json())
        self.assertRegex(on.json()["detail"], "^all 2 places for studies are taken; [01] requests wait before this one; Retry-After estimates when this request would have one$")
        thread.join()
        self.assertEqual(answers[0].status, 202)
        self.assertEqual(server.stop(), 0)

    def test_a_study_that_is_to_go_on_waits_for_a_place(self):
        """It was refused at once, where a new study waits; a place that is of no use any more goes back."""
        server = driver.Server()
        first, second, third = (From(server, f"127.0.0.{k}") for k in (2, 3, 4))
        studies = []
        for client in (first, second):
            study = client.ask("POST", self.STUDIES, self.STUDY).json()["links"]["self"]
            client.ask("PATCH", study, {"state": "stopped"})
            self.assertTrue(driver.until(lambda: client.ask("GET", study).json()["state"] == "stopped"))
            studies.append(study)
        running = [client.ask("POST", self.STUDIES, self.STUDY).json()["links"]["self"] for client in (third, server)]
        answers = {}

        def go_on(client, study):
            answers[study] = client.ask("PATCH", study + "?wait=50", {"state": "running"})

        threads = []
        for client, study in zip((first, second), studies):
            threads.append(threading.Thread(target=go_on, args=(client, study)))
            threads[-1].start()
            waiting = f"; {len(threads)} requests wait"
            self.assertTrue(driver.until(lambda: waiting in server.ask("POST", self.NO_WAIT, self.STUDY).json()["detail"]))
        # the oldest has the first place that is free; the other's study is deleted while it waits
        server.ask("DELETE", studies[1])
        server.ask("DELETE", running[0])
        threads[0].join()
        self.assertEqual((answers[studies[0]].status, answers[studies[0]].json()["state"]), (200, "running"))
        server.ask("DELETE", running[1])
        threads[1].join()
        self.assertEqual(answers[studies[1]].status, 404)
        self.assertEqual(third.ask("POST", self.STUDIES, self.SHORT_STUDY).status, 202)
        self.assertEqual(server.ask("PATCH", studies[0] + "?wait=61", {"state": "running"}).status, 422)
        self.assertEqual(server.stop(), 0)

    def test_studies_of_one_client_make_no_room_by_those_of_another(self):
        server = driver.Server()
        greedy, modest = From(server, "127.0.0.2"), From(server, "127.0.0.3")

        def finish(client):
            study = f"{self.STUDIES}/{client.ask('POST', self.STUDIES, self.SHORT_STUDY).json()['id']}"
            self.assertTrue(driver.until(lambda: client.ask("GET", study).json()["state"] == "finished"))
            return study

        theirs = finish(modest)
        many = [finish(greedy) for _ in range(server.ask("GET", "/api/v1/").json()["limits"]["studies_kept"] + 1)]
        self.assertEqual(modest.ask("GET", theirs).status, 200)
        self.assertEqual([greedy.ask("GET", many[k]).status for k in (0, -1)], [404, 200])
        self.assertEqual(server.stop(), 0)

    def test_one_program_of_this_machine_fills_no_queue_alone(self):
        server = driver.Server()
        limits = server.ask("GET", "/api/v1/").json()["limits"]
        share = int(limits["long_requests_waiting"] * limits["share_of_one_client"])

        def as_program(name):
            return lambda method, path, body: server.ask(method, path, body, {"User-Agent": name})

        run = {**RING, "method": "projection@rk4:h=1e-4"}
        statuses = [as_program("script/1")("POST", "/api/v1/runs?wait=0", {**run, "time": 1000 + i}).status
                    for i in range(limits["long_requests_waiting"] + limits["long_requests_at_once"] + 5)]
        taken = statuses.count(202)
        # at most its share waits, besides those that have begun
        begun = limits["long_requests_at_once"] + limits["long_requests_set_aside"]
        self.assertTrue(share <= taken <= share + begun, statuses)
        self.assertEqual(statuses.count(429), len(statuses) - taken)
        # another program has its share, and its turn comes before the rest of the first
        other = as_program("Mozilla/5.0")("POST", "/api/v1/runs?wait=0", {"scene": "four-bar", "method": RK4, "time": 1})
        self.assertEqual(other.status, 202)
        self.assertEqual(server.stop(), 0)

    LONG = {**RING, "method": "projection@rk4:h=1e-5"}
    SHORT = {"scene": "four-bar", "method": RK4, "time": 0.02}

    def test_a_long_run_makes_way_for_another_client(self):
        """20 long runs of one client held every worker: a run of 20 ms of another client waited 25 s for its turn."""
        server = driver.Server()
        greedy, modest = From(server, "127.0.0.2"), From(server, "127.0.0.3")
        allowed = 2 * driver.SLOW  # a slice of 0.2 s of each of three workers, on a busy machine
        statuses = [greedy.ask("POST", "/api/v1/runs?wait=0", {**self.LONG, "time": 1000 + i}).status for i in range(20)]
        self.assertGreaterEqual(statuses.count(202), 16)
        tried = []

        def attempt():
            tried.append(0)
            start = time.monotonic()
            answer = modest.ask("POST", "/api/v1/runs", {**self.SHORT, "every": 0.01 / len(tried)})
            self.assertEqual(answer.status, 201)
            return time.monotonic() - start, allowed

        self.assert_within(attempt)
        # likewise where the answer is waited for
        threads = [threading.Thread(target=greedy.ask, args=("POST", "/api/v1/snapshots", {**RING, "methods": [self.LONG["method"]], "time": 1000 + i}))
                   for i in range(6)]
        for t in threads:
            t.start()
        time.sleep(0.5)

        def ask_for_terms():
            start = time.monotonic()
            self.assertEqual(modest.ask("POST", "/api/v1/terms", {"scene": "four-bar"}).status, 200)
            return time.monotonic() - start, allowed

        self.assert_within(ask_for_terms)
        self.assertEqual(server.stop(), 0)
        for t in threads:
            t.join()

    def test_who_is_refused_beside_long_runs_is_told_to_come_back_later(self):
        """After a hundred runs of some milliseconds, runs of 20 s filled the queue: it said 1 s to each, whatever it had seen of them."""
        server = driver.Server()
        greedy = From(server, "127.0.0.2")
        for i in range(30):
            self.assertEqual(greedy.ask("POST", "/api/v1/runs", {**self.SHORT, "every": 0.01 / (1 + i)}).status, 201)
        runs = [{**self.LONG, "time": 1000 + i} for i in range(40)]
        self.assertIn(429, [greedy.ask("POST", "/api/v1/runs?wait=0", run).status for run in runs])
        time.sleep(6)
        refused = [a for a in (greedy.ask("POST", "/api/v1/runs?wait=0", {**run, "every": 0.5}) for run in runs) if a.status == 429]
        self.assertTrue(refused)
        # some 20 before it, on three threads that have given each of them a second and more
        self.assertGreater(int(refused[-1].headers["retry-after"]), 3)
        self.assertEqual(server.stop(), 0)

    def test_who_waits_as_told_beside_long_runs_is_let_in(self):
        """Of thirty long runs asked for at once, those that found no place heard 1 s, again and again until there was one."""
        server = driver.Server("--run-cpu", "0.5")
        refusals = []

        def ask(i):
            run, times = {**self.LONG, "time": 1000 + i}, 0
            while (answer := server.ask("POST", "/api/v1/runs?wait=0", run)).status == 429:
                times += 1
                time.sleep(int(answer.headers["retry-after"]))
            refusals.append((answer.status, times))

        threads = [threading.Thread(target=ask, args=(i,)) for i in range(30)]
        for t in threads:
            t.start()
        for t in threads:
            t.join()
        self.assertEqual({status for status, _ in refusals}, {202})
        first, again = sum(n > 0 for _, n in refusals), sum(n - 1 for _, n in refusals if n > 0)
        # a machine that becomes busier meanwhile makes an estimate too short now and then
        self.assertGreater(first, 3)
        self.assertLessEqual(again, first // 2, refusals)
        self.assertEqual(server.stop(), 0)

    def test_a_run_that_was_set_aside_has_the_same_samples(self):
        question = {**RING, "methods": ["projection@rk4:h=1e-3", "ggl@radau5:rtol=1e-6"], "time": 0.5}
        alone = driver.Server()
        want = driver.run_to_end(alone, question).json()
        self.assertEqual(alone.stop(), 0)
        server = driver.Server()
        for i in range(6):
            for address in ("127.0.0.2", "127.0.0.3"):
                self.assertEqual(From(server, address).ask("POST", "/api/v1/runs?wait=0", {**self.LONG, "time": 1000 + i + float(address[-1]) / 10}).status, 202)
        got = driver.run_to_end(server, question).json()
        self.assertEqual([r["samples"] for r in got["runs"]], [r["samples"] for r in want["runs"]])
        self.assertEqual(server.stop(), 0)

    def test_a_proxy_names_its_clients(self):
        server = driver.Server("--max-comparisons", "4")

        def ask(forwarded):
            return server.ask(*self.AT_ONCE, {"X-Forwarded-For": forwarded}).status

        self.assertEqual([ask("10.0.0.1") for _ in range(3)], [201, 201, 429])
        self.assertEqual([ask("10.0.0.1, 10.0.0.2") for _ in range(3)], [201, 201, 429])  # the last is the proxy's own word
        self.assertEqual(server.stop(), 0)
        # who is not on this machine names nobody, be it nonsense
        server = driver.Server("--max-comparisons", "4")
        self.assertEqual([self.forward(server, "127.0.0.2", name) for name in ("10.0.0.1", "10.0.0.2", "nobody")], [201, 201, 429])
        self.assertEqual(server.stop(), 0)

    def forward(self, server, address, *names):
        """The status of a comparison that is asked for from an address, which passes it on for the names: a header for each."""
        c = http.client.HTTPConnection("127.0.0.1", server.port, timeout=30 * driver.SLOW, source_address=(address, 0))
        body = json.dumps(self.MAKE[2])
        c.putrequest("POST", self.AT_ONCE[1])
        for name, value in [("Content-Type", "application/json"), ("Content-Length", str(len(body))), *(("X-Forwarded-For", n) for n in names)]:
            c.putheader(name, value)
        c.endheaders(body.encode())
        status = driver.Answer(c.getresponse()).status
        c.close()
        return status

    def test_a_proxy_elsewhere_names_its_clients_where_the_server_knows_it(self):
        server = driver.Server("--max-comparisons", "4", "--proxy", "127.0.0.2", "--proxy", "127.1.0.0/16", "--proxy", "fd00::/8")

        def ask(address, *names):
            return self.forward(server, address, *names)

        def room():
            for c in server.ask("GET", "/api/v1/comparisons").json()["comparisons"]:
                server.ask("DELETE", "/api/v1/comparisons/" + c)

        # the same client by whatever proxy, spelling and port; another client has its own share
        self.assertEqual([ask("127.0.0.2", "10.0.0.1"), ask("127.1.7.7", "10.0.0.1:4711"), ask("127.0.0.1", "::ffff:10.0.0.1"), ask("127.0.0.2", "10.0.0.2")],
                         [201, 201, 429, 201])
        room()
        # of IPv6 a network of 64 bits is one client
        self.assertEqual([ask("127.0.0.2", n) for n in ("2001:db8::1", "[2001:db8::2]:80", "2001:db8::3", "2001:db8:0:1::1")], [201, 201, 429, 201])
        room()
        # through two proxies; what a client writes itself, in the same header or one before, counts for nothing
        self.assertEqual([ask("127.0.0.2", n) for n in ("1.1.1.1, 10.0.0.1, 127.1.0.9", "2.2.2.2, 10.0.0.1,fd00::7", "10.0.0.9, 10.0.0.1")], [201, 201, 429])
        self.assertEqual([ask("127.0.0.2", "10.0.0.9", "10.0.0.1"), ask("127.0.0.2", "nonsense", "10.0.0.1"), ask("127.0.0.2", "10.0.0.3")], [429, 429, 201])
        room()
        # an address that is no proxy's is the client, whatever it says
        self.assertEqual([ask("127.2.0.1", f"10.0.0.{k}") for k in range(3)], [201, 201, 429])
        room()
        # nonsense of a proxy is told
        for name in ("nobody", "10.0.0.256", "10.0.0.1:", "10.0.0.1:123456", "[10.0.0.1", "[::1", "1.2.3.4, ", ",", "unknowns", "unix", "x" * 3000):
            self.assertEqual(ask("127.0.0.2", name), 400, name)
        # a proxy that says nothing, or that it knows no address, asks for itself
        self.assertEqual([ask("127.0.0.2", n) for n in ("", "unknown", "10.0.0.1, unix:")], [201, 201, 429])
        self.assertEqual(server.stop(), 0)

    def test_a_proxy_that_is_no_address_is_refused_at_the_start(self):
        for word in ("proxy.example", "10.0.0.0/33", "10.0.0.0/", "10.0.0.0/-1", "fd00::/129", "[fd00::1", "[fd00::1]", ""):
            done = subprocess.run([driver.PROGRAM, "serve", "--port", "0", "--proxy", word], capture_output=True, text=True, timeout=60 * driver.SLOW)
            self.assertEqual(done.returncode, 2, word)
            self.assertIn("--proxy", done.stderr)

    def test_what_costs_nothing_has_a_queue_of_its_own(self):
        server = driver.Server("--run-cpu", "3")
        paths = ("/api/v1/scenes/four-bar", "/api/v1/scenes", "/")
        allowed = {path: max(2 * driver.SLOW, 10 * server.idle(path)) for path in paths}
        run = {**RING, "method": "projection@rk4:h=1e-4"}
        threads = [threading.Thread(target=server.ask, args=("POST", "/api/v1/runs", {**run, "time": 1000 + i})) for i in range(12)]
        for t in threads:
            t.start()
        time.sleep(0.5)

        def attempt(*request):
            answer, took = server.timed(*request)
            self.assertIn(answer.status, (200, 201), request)
            return took, allowed.get(request[1], 2 * driver.SLOW)

        for path in paths:
            self.assert_within(lambda: attempt("GET", path))
        self.assert_within(lambda: attempt(*self.MAKE))
        self.assertEqual(server.stop(), 0)
        for t in threads:
            t.join()


if __name__ == "__main__":
    driver.main()
