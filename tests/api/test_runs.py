# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs as resources: the same question has the same address, is computed once, and is read in pages."""

import concurrent.futures
import csv
import io
import json
import os
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import driver

RUN = {"scene": "four-bar", "method": "index1@rk4:h=1e-3", "time": 1}
LONG = {"scene": "ring", "parameters": {"n": 30}, "method": "projection@rk4:h=1e-4", "time": 1000}


class Runs(unittest.TestCase):
    def setUp(self):
        self.server = driver.Server()

    def tearDown(self):
        self.assertEqual(self.server.stop(), 0, self.server.errors)

    def ask(self, question, query="", status=201):
        answer = self.server.ask("POST", "/api/v1/runs" + query, question)
        self.assertEqual(answer.status, status, answer.body[:300])
        return answer

    def test_the_same_question_has_the_same_address_and_answer(self):
        first = self.ask(RUN)
        for same in (RUN, {**RUN, "parameters": {}}, {**RUN, "every": 0.005}, {**RUN, "method": "index1@rk4:h=0.001"},
                     dict(reversed(RUN.items())), {**RUN, "reactions": False}):
            again = self.ask(same, status=200)
            self.assertEqual(again.json(), first.json())
            self.assertEqual(again.headers["location"], first.headers["location"])
        others = [{**RUN, "time": 1.5}, {**RUN, "method": "index1@rk4:h=2e-3"}, {**RUN, "parameters": {"l1": 1.01}}, {**RUN, "at": [0.5]},
                  {**RUN, "reactions": True}, {**RUN, "scene": "four-angles-as-printed", "method": "projection@rk4:h=1e-3"}]
        addresses = {self.ask(q).headers["location"] for q in others}
        self.assertEqual(len(addresses | {first.headers["location"]}), len(others) + 1)
        # parameters in any order
        one = self.ask({**RUN, "parameters": {"l1": 1.01, "l4": 2.01}})
        self.ask({**RUN, "parameters": {"l4": 2.01, "l1": 1.01}}, status=200)
        self.assertIn(one.json()["id"], self.server.ask("GET", "/api/v1/runs").json()["runs"])

    def test_a_run_is_read_without_its_samples_and_not_twice(self):
        first = self.ask(RUN)
        answer = self.server.ask("GET", first.headers["location"])
        whole, summary = first.json(), answer.json()
        del whole["samples"]
        self.assertEqual(summary, whole)
        self.assertLess(len(answer.body), 3000)
        again = self.server.ask("GET", first.headers["location"], headers={"If-None-Match": answer.headers["etag"]})
        self.assertEqual((again.status, again.body, again.headers["cache-control"]), (304, b"", "no-cache"))
        # so are its rows, each form by a name of its own
        address, etags = whole["links"]["samples"] + "?fields=t,gap", set()
        for form in ("application/json", "application/x-ndjson", "text/csv"):
            etag = self.server.ask("GET", address, headers={"Accept": form}).headers["etag"]
            again = self.server.ask("GET", address, headers={"Accept": form, "If-None-Match": etag})
            self.assertEqual((again.status, again.body), (304, b""))
            etags.add(etag)
        self.assertEqual(len(etags), 3)
        self.assertEqual(self.server.ask("GET", address, headers={"If-None-Match": answer.headers["etag"]}).status, 200)

    def test_samples_come_in_three_forms_with_every_digit(self):
        document = self.ask(RUN).json()
        address = document["links"]["samples"]
        rows = self.server.ask("GET", address + "?fields=t,q,gap").json()["rows"]
        columns = document["samples"]
        self.assertEqual(rows, [[t, q, g] for t, q, g in zip(columns["t"], columns["q"], columns["gap"])])
        text = self.server.ask("GET", address + "?fields=t,q,gap", headers={"Accept": "text/csv"}).body.decode()
        table = list(csv.reader(io.StringIO(text)))
        self.assertEqual(table[0], ["t", *document["coordinates"], "gap"])
        self.assertEqual([[float(x) for x in row] for row in table[1:]], [[t, *q, g] for t, q, g in rows])
        lines = self.server.ask("GET", address, headers={"Accept": "application/x-ndjson"}).body.decode().splitlines()
        self.assertEqual([json.loads(line) for line in lines], [dict(zip(columns, values)) for values in zip(*columns.values())])

    def test_rows_are_chosen_and_paged(self):
        document = self.ask(RUN).json()
        address = document["links"]["samples"]
        every = self.server.ask("GET", address + "?fields=t&stride=7").json()["rows"]
        self.assertEqual(every, [[t] for t in document["samples"]["t"][::7]])
        between = self.server.ask("GET", address + "?fields=t&from=0.25&to=0.5").json()["rows"]
        self.assertEqual(between, [[t] for t in document["samples"]["t"] if 0.25 <= t <= 0.5])
        pages, next_address = [], address + "?fields=t,energy&stride=3&limit=10"
        while next_address:
            page = self.server.ask("GET", next_address)
            pages += page.json()["rows"]
            link = page.headers.get("link")
            self.assertEqual(link is None, page.json()["next_cursor"] is None)
            next_address = link and link[1:link.index(">")]
        samples = document["samples"]
        self.assertEqual(pages, [list(row) for row in zip(samples["t"][::3], samples["energy"][::3])])

    def test_the_form_that_is_most_welcome_is_sent(self):
        """The first that was not refused was sent, JSON, however little it was wanted."""
        address = self.ask(RUN).json()["links"]["samples"]
        for accept, form in (("text/csv;q=0.9, application/json;q=0.1", "text/csv"), ("text/csv, */*;q=0.5", "text/csv"), ("*/*", "application/json"),
                             ("application/json;q=0.2, application/x-ndjson;q=0.3", "application/x-ndjson"), ("text/csv, application/json", "application/json")):
            self.assertEqual(self.server.ask("GET", address, headers={"Accept": accept}).type, form, accept)

    def test_faults_of_a_query_are_told(self):
        address = self.ask(RUN).json()["links"]["samples"]
        for query, status, word in (("?stride=0", 422, "stride"), ("?fields=t,qq", 422, "did you mean 'q'"), ("?fields=", 422, "columns: t, "),
                                    ("?fields=" + "t," * 30, 422, "the column 't' twice"), ("?fields=t,gap,t", 422, "the column 't' twice"), ("?strid=2", 400, "did you mean 'stride'"),
                                    ("?from=x", 422, "from"), ("?limit=1e9", 422, "limit"), ("?method=1", 422, "method"), ("?cursor=-1", 422, "cursor"),
                                    ("?cursor=0x10", 422, "in digits"), ("?cursor=%2B1", 422, "in digits"), ("?cursor=%201", 422, "in digits"),
                                    ("?limit=1.0", 422, "in digits"), ("?from=0x1p-1", 422, "from"), ("?to=inf", 422, "to"), ("?to=.5", 422, "to"),
                                    ("?from=0.5&to=0.25", 422, "no time is between them"), ("?from=1e400", 422, "from")):
            answer = self.server.ask("GET", address + query)
            self.assertEqual((answer.status, answer.type), (status, "application/problem+json"), query)
            self.assertIn(word, json.dumps(answer.json()), query)
        self.assertEqual(self.server.ask("GET", address, headers={"Accept": "image/png"}).status, 406)
        for question, pointer in (({"scene": "four-bar", "time": 1}, "/method"), ({**RUN, "methods": [RUN["method"]]}, "/method"),
                                  ({**RUN, "method": "indx1@rk4:h=1e-3"}, "/method")):
            self.assertEqual(self.ask(question, status=422).json()["errors"][0]["pointer"], pointer)

    def test_who_waits_for_a_run_is_told_when_the_server_ends(self):
        """The answer was a finished run whose computing time was used up, after a second of it."""
        server, answers = driver.Server(), []
        threads = [threading.Thread(target=lambda q=q: answers.append(server.ask("POST", "/api/v1/runs?wait=50", q, timeout=90))) for q in (LONG, {**LONG, "time": 999})]
        before = server.cpu()
        for t in threads:
            t.start()
        server.is_at_work(before)
        self.assertEqual(server.stop(), 0)
        for t in threads:
            t.join()
        self.assertEqual([(a.status, a.json()["type"]) for a in answers], [(503, "/api/v1/errors/stopping")] * 2)

    def test_several_methods_are_one_run(self):
        methods = ["index1@rk4:h=1e-3", "projection@rk4:h=1e-3"]
        document = self.ask({"scene": "four-bar", "methods": methods, "time": 1}).json()
        self.assertEqual([r["method"] for r in document["runs"]], ["index1@rk4:h=0.001", "projection@rk4:h=0.001"])
        for i, run in enumerate(document["runs"]):
            rows = self.server.ask("GET", document["links"]["samples"] + f"?method={i}&fields=gap").json()["rows"]
            self.assertEqual([g for g, in rows], run["samples"]["gap"])

    def test_the_pages_of_a_method_are_followed_by_pages_of_that_method(self):
        """The second page was that of the first method."""
        document = self.ask({"scene": "four-bar", "methods": ["index1@rk4:h=1e-2", "projection@rk4:h=1e-2"], "time": 0.5, "every": 0.01}).json()
        address = document["links"]["samples"] + "?method=1&from=0.1&to=0.4"
        whole, pages, following = self.server.ask("GET", address).json()["rows"], [], address + "&limit=7"
        while following:
            page = self.server.ask("GET", following)
            pages += page.json()["rows"]
            link = page.headers.get("link")
            following = link and link[1:link.index(">")]
        self.assertEqual(pages, whole)
        self.assertEqual(len(whole), 31)

    def test_a_long_run_is_told_of_and_waited_for(self):
        answer = self.ask(LONG, "?wait=0", 202)
        address = answer.headers["location"]
        self.assertIn(answer.json()["state"], ("waiting", "running"))
        start = time.monotonic()
        waited = self.server.ask("GET", address + "?wait=1")
        self.assertGreater(time.monotonic() - start, 0.9)
        self.assertEqual((waited.status, waited.json()["state"], waited.headers["retry-after"]), (200, "running", "1"))
        self.assertEqual(self.server.ask("GET", address + "/samples").status, 409)
        # the same question waits for the same run
        self.assertEqual(self.ask(LONG, "?wait=0", 202).headers["location"], address)
        self.assertEqual(self.server.ask("DELETE", address).status, 204)
        self.assertEqual(self.server.ask("GET", address).status, 404)
        self.assertEqual(driver.run_to_end(self.server, {**LONG, "time": 0.01}).json()["state"], "finished")


PYTHON = next((p for p in (sys.executable, "/usr/bin/python3") if subprocess.run([p, "-c", "import numpy, scipy"], capture_output=True).returncode == 0), None)
FALLS_APART = {"scene": "four-bar", "methods": ["index1@euler:h=0.05", "projection@rk4:h=1e-2"], "time": 3, "every": 0.01}


class Events(unittest.TestCase):
    def setUp(self):
        self.server = driver.Server("--run-cpu", str(20 * driver.SLOW))
        self.addCleanup(lambda: self.assertEqual(self.server.stop(), 0, self.server.errors))

    def read(self, address, last=None, query=""):
        """(name, id or None, data) of every event, to the end of the stream."""
        answer = self.server.ask("GET", address + query, headers={"Last-Event-ID": str(last)} if last is not None else None)
        self.assertEqual((answer.status, answer.type), (200, "text/event-stream"), answer.body[:300])
        events = []
        for block in answer.body.decode().strip().split("\n\n"):
            fields = dict(line.split(": ", 1) for line in block.splitlines())
            events.append((fields["event"], int(fields["id"]) if "id" in fields else None, json.loads(fields["data"])))
        return events

    def test_samples_and_incidents_come_in_the_order_of_time(self):
        run = driver.run_to_end(self.server, FALLS_APART).json()
        events = self.read(run["links"]["events"])
        self.assertEqual((events[0][0], events[-1][0]), ("hello", "end"))
        self.assertEqual([i for _, i, _ in events[1:]], list(range(1, len(events))))
        for m, document in enumerate(run["runs"]):
            samples = [d for name, _, d in events if name == "sample" and d["method"] == m]
            columns = document["samples"]
            self.assertEqual(samples, [{"method": m, **dict(zip(columns, row))} for row in zip(*columns.values())])
            incidents = [d for name, _, d in events if name == "incident" and d["method"] == m]
            self.assertEqual(incidents, [{"method": m, **i} for i in document["incidents"]])
            times = [d["t"] for name, _, d in events if name in ("sample", "incident") and d["method"] == m]
            self.assertEqual(times, sorted(times))
        self.assertGreater(len(run["runs"][0]["incidents"]), 2)
        self.assertEqual(events[-1][2], self.server.ask("GET", run["links"]["self"]).json())

    def test_a_reader_goes_on_behind_any_event(self):
        address = driver.run_to_end(self.server, FALLS_APART).json()["links"]["events"]
        every = self.read(address, query="?fields=t,gap")
        self.assertEqual(set(every[1][2]), {"method", "t", "gap"})
        for last in (1, 2, 57, len(every) - 2):
            self.assertEqual(self.read(address, last, "?fields=t,gap")[1:], every[last + 1:])
            self.assertEqual(self.read(address, query=f"?fields=t,gap&last_event_id={last}")[1:], every[last + 1:])
        whole = self.server.ask("GET", address, headers={"Last-Event-ID": str(len(every) - 1)})
        self.assertEqual((whole.status, whole.body), (204, b""))

    def test_live_leaves_out_samples_and_no_incident(self):
        address = driver.run_to_end(self.server, {**FALLS_APART, "every": 1e-3}).json()["links"]["events"]
        every, live = self.read(address), self.read(address, query="?mode=live")
        self.assertTrue(all(event in every for event in live))
        self.assertEqual([e for e in live if e[0] != "sample"], [e for e in every if e[0] != "sample"])
        for m in (0, 1):
            n = sum(e[0] == "sample" and e[2]["method"] == m for e in live)
            self.assertTrue(100 <= n <= 201, n)
        middle = live[len(live) // 2][1]
        self.assertEqual(self.read(address, middle, "?mode=live")[1:], [e for e in live[1:] if e[1] > middle])

    def test_a_long_run_is_sent_in_small_pieces_of_reading(self):
        """One look at a run of 51 MB kept the event loop from its other connections for 0.15 s."""
        run = driver.run_to_end(self.server, {"scene": "four-bar", "method": "index1@rk4:h=1e-3", "time": 20, "every": 1e-3, "reactions": True}).json()
        size = sum(len(json.dumps(column)) for column in run["samples"].values())
        with socket.create_connection(("127.0.0.1", self.server.port), timeout=60 * driver.SLOW) as s:
            s.sendall(f"GET {run['links']['events']}?mode=live HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n".encode())
            head, _, body = b"".join(iter(lambda: s.recv(65536), b"")).partition(b"\r\n\r\n")
        self.assertIn(b"chunked", head)
        chunks, events = 0, b""
        while not body.startswith(b"0\r\n"):
            length, _, body = body.partition(b"\r\n")
            events, body, chunks = events + body[:int(length, 16)], body[int(length, 16) + 2:], chunks + 1
        self.assertEqual(events.count(b"event: sample"), 199 + 2)
        # a quarter of a megabyte is read for each, whose columns the server writes without the blanks of json.dumps
        self.assertGreater(chunks, size / 2 / (1 << 18), size)

    def test_a_run_that_goes_on_tells_its_progress(self):
        made = self.server.ask("POST", "/api/v1/runs?wait=0", LONG).json()
        reader = driver.Events(self.server, None, address=made["links"]["events"])
        seen = reader.until("progress") + reader.until("progress") + reader.until("progress")
        self.assertEqual(seen[0][0], "hello")
        self.assertEqual(seen[-1][2]["state"], "running")
        # who deletes it ends the stream
        self.assertEqual(self.server.ask("DELETE", made["links"]["self"]).status, 204)
        self.assertEqual(reader.until("end")[-1][2], {"state": "stopped"})
        reader.close()

    def test_a_stream_is_open_while_the_run_ends(self):
        question = {**RUN, "method": "index1@rk4:h=1e-5", "time": 20, "every": 1}
        made = self.server.ask("POST", "/api/v1/runs?wait=0", question).json()
        reader = driver.Events(self.server, None, address=made["links"]["events"])
        seen = reader.until("end")
        self.assertEqual([d["t"] for name, _, d in seen if name == "sample"], [float(t) for t in range(21)])
        self.assertEqual(seen[-1][2]["state"], "finished")

    def test_the_end_of_the_server_ends_the_stream(self):
        server = driver.Server()
        made = server.ask("POST", "/api/v1/runs?wait=0", LONG).json()
        reader = driver.Events(server, None, address=made["links"]["events"])
        reader.until("progress")
        start = time.monotonic()
        self.assertEqual(server.stop(), 0)
        self.assertLess(time.monotonic() - start, 10)
        reader.close()

    def test_faults_are_told(self):
        run = self.server.ask("POST", "/api/v1/runs", RUN).json()
        for query, status in (("?mode=some", 400), ("?last_event_id=-1", 422), ("?moode=live", 400)):
            self.assertEqual(self.server.ask("GET", run["links"]["events"] + query).status, status, query)
        self.assertEqual(self.server.ask("GET", run["links"]["events"], headers={"Last-Event-ID": "x"}).status, 400)
        self.assertEqual(self.server.ask("GET", "/api/v1/runs/nothing/events").status, 404)
        events = self.read(run["links"]["events"], query="?fields=t,qq")
        self.assertEqual(events[1], ("problem", None, {"detail": "the run has no column 'qq'"}))


class Export(unittest.TestCase):
    def test_a_run_is_exported_with_its_parameters_after_a_restart_too(self):
        with tempfile.TemporaryDirectory() as folder, open("lessons/01-closed-loops/scenes/four-bar.json") as f:
            scene = json.load(f)
            server = driver.Server("--runs", folder)
            question = {"scene": "four-bar", "parameters": {"l1": 0.45}, "methods": FALLS_APART["methods"], "time": 0.5}
            made = [server.ask("POST", "/api/v1/runs", {**question, "scene": s}).json() for s in ("four-bar", scene)]
            self.assertEqual(server.stop(), 0)
            server = driver.Server("--runs", folder)
            for run in made:
                answer = server.ask("GET", run["links"]["export"] + "?language=python&method=1")
                self.assertEqual((answer.status, answer.type), (200, "text/plain"), answer.body[:300])
                self.assertIn('filename="four-bar.py"', answer.headers["content-disposition"])
                self.assertRegex(answer.body.decode(), r"(?m)^l1 = 0\.45\b")
                self.assertIn("projection@rk4:h=0.01", answer.body.decode().splitlines()[-1])
                path = os.path.join(folder, "exported.py")
                with open(path, "wb") as f:
                    f.write(answer.body)
                if PYTHON:  # the program needs numpy
                    done = subprocess.run([PYTHON, path], capture_output=True, text=True, timeout=120)
                    self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            for query, status, word in (("?language=pyton", 422, "did you mean 'python'?"), ("?method=2", 422, "method"), ("?lang=c", 400, "language")):
                answer = server.ask("GET", made[0]["links"]["export"] + query)
                self.assertEqual(answer.status, status, query)
                self.assertIn(word, answer.body.decode(), query)
            self.assertEqual(server.stop(), 0)


class Kept(unittest.TestCase):
    def test_a_server_that_was_killed_loses_no_run_and_believes_no_damaged_one(self):
        with tempfile.TemporaryDirectory() as folder:
            server = driver.Server("--runs", folder)
            questions = [{**RUN, "time": 0.1, "parameters": {"l1": 1 + i / 10000}} for i in range(100)]
            answers = [server.ask("POST", "/api/v1/runs", q).json() for q in questions]
            server.process.kill()
            server.process.wait()
            self.assertEqual({name[:-5] for name in os.listdir(folder)}, {a["id"] for a in answers})
            damaged = answers[7]["id"]
            path = os.path.join(folder, damaged + ".json")
            with open(path, "r+b") as f:
                f.seek(1000)
                f.write(b"9")
            server = driver.Server("--runs", folder)
            # nothing has been asked for yet: the folder is listed
            for _ in range(2):  # the second time from what was seen the first time
                listed = server.ask("GET", "/api/v1/runs").json()
                self.assertEqual(listed, {"runs": sorted(a["id"] for a in answers if a["id"] != damaged), "spoilt": 1, "unchecked": 0})
            # a file that is spoilt later is found out
            other = os.path.join(folder, answers[5]["id"] + ".json")
            with open(other, "rb") as f:
                whole = f.read()
            with open(other, "wb") as f:
                f.write(whole[:-3])
            self.assertEqual(server.ask("GET", "/api/v1/runs").json()["spoilt"], 2)
            with open(other, "wb") as f:
                f.write(whole)
            self.assertEqual(server.ask("GET", "/api/v1/runs").json()["spoilt"], 1)
            for i, (question, answer) in enumerate(zip(questions, answers)):
                again = server.ask("POST", "/api/v1/runs", question)
                self.assertEqual(again.status, 201 if i == 7 else 200)
                self.assertEqual(again.json()["samples"], answer["samples"])
            self.assertEqual(server.ask("GET", "/api/v1/runs/" + answers[3]["id"]).status, 200)
            self.assertEqual(server.ask("DELETE", "/api/v1/runs/" + answers[3]["id"]).status, 204)
            self.assertFalse(os.path.exists(os.path.join(folder, answers[3]["id"] + ".json")))
            with open(os.path.join(folder, "notes.json"), "w") as f:
                f.write("{}")
            kept = sorted(a["id"] for a in answers if a is not answers[3])
            self.assertEqual(server.ask("GET", "/api/v1/runs").json()["runs"], kept)
            self.assertEqual(server.stop(), 0)

    @staticmethod
    def add_long_files(folder, n, megabytes):
        """Files with the names of runs, of which the server finds out that they are spoilt when it has read them whole."""
        for i in range(n):
            with open(os.path.join(folder, f"{i:022d}.json"), "wb") as f:
                f.write(b"A" * 44 + b"\n{")
                f.truncate(megabytes << 20)

    def test_lists_that_are_asked_for_at_once_make_way_for_one_another(self):
        """More of them than threads: one that waited for what another held kept that other from its turn, and all stood still."""
        with tempfile.TemporaryDirectory() as folder:
            self.add_long_files(folder, 12, 12 // driver.SLOW)  # more than a slice of time for each list
            server = driver.Server("--runs", folder)
            with concurrent.futures.ThreadPoolExecutor(8) as pool:
                lists = list(pool.map(lambda _: server.ask("GET", "/api/v1/runs", timeout=120).json(), range(8)))
            self.assertEqual(lists, [{"runs": [], "spoilt": 12, "unchecked": 0}] * 8)
            self.assertEqual(server.stop(), 0)

    def test_a_run_that_is_read_from_a_large_file_holds_up_no_connection(self):
        with tempfile.TemporaryDirectory() as folder:
            self.add_long_files(folder, 1, 128 // driver.SLOW)
            server = driver.Server("--runs", folder, "--max-connections", "20")  # few event loops: each has some of those below
            kept = [server.connect() for _ in range(12)]

            def health(connection):
                start = time.monotonic()
                connection.request("GET", "/healthz")
                self.assertEqual(driver.Answer(connection.getresponse()).status, 200)
                return time.monotonic() - start

            def attempt():
                """The longest answer beside the reading of the file, and half of what that takes."""
                with concurrent.futures.ThreadPoolExecutor(1) as pool:
                    reading = pool.submit(server.timed, "GET", f"/api/v1/runs/{0:022d}")
                    longest = 0
                    while not reading.done():
                        longest = max([longest] + [health(c) for c in kept])
                answer, took = reading.result()
                self.assertEqual(answer.status, 404)
                return longest, took / 2

            for connection in kept:
                health(connection)
            figures = driver.best_of_tries(attempt)
            self.assertLess(figures[-1][0], figures[-1][1], figures)
            for connection in kept:
                connection.close()
            self.assertEqual(server.stop(), 0)

    def test_a_folder_that_is_not_there_is_made_for_its_owner(self):
        with tempfile.TemporaryDirectory() as outer:
            folder = os.path.join(outer, "runs")
            server = driver.Server("--runs", folder)
            made = server.ask("POST", "/api/v1/runs", {**RUN, "time": 0.1}).json()
            self.assertEqual(server.stop(), 0)
            self.assertEqual(server.errors, [])
            self.assertEqual(os.listdir(folder), [made["id"] + ".json"])
            self.assertEqual(os.stat(folder).st_mode & 0o777, 0o700)

    def test_what_used_up_its_time_is_computed_again(self):
        server = driver.Server("--run-cpu", "0.2")
        endless = {**RUN, "method": "index1@rk4:h=1e-7", "time": 1000}
        first, again = (server.ask("POST", "/api/v1/runs", endless) for _ in range(2))
        self.assertEqual((first.status, again.status, first.json()["status"]), (201, 201, "stopped"))
        self.assertEqual(server.stop(), 0)


if __name__ == "__main__":
    driver.main()
