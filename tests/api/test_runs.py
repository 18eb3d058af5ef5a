# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs as resources: the same question has the same address, is computed once, and is read in pages."""

import csv
import io
import json
import os
import tempfile
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
        self.assertEqual((again.status, again.body), (304, b""))

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

    def test_faults_of_a_query_are_told(self):
        address = self.ask(RUN).json()["links"]["samples"]
        for query, status, word in (("?stride=0", 422, "stride"), ("?fields=t,qq", 422, "did you mean 'q'"), ("?strid=2", 400, "did you mean 'stride'"),
                                    ("?from=x", 422, "from"), ("?limit=1e9", 422, "limit"), ("?method=1", 422, "method"), ("?cursor=-1", 422, "cursor")):
            answer = self.server.ask("GET", address + query)
            self.assertEqual((answer.status, answer.type), (status, "application/problem+json"), query)
            self.assertIn(word, json.dumps(answer.json()), query)
        self.assertEqual(self.server.ask("GET", address, headers={"Accept": "image/png"}).status, 406)
        for question, pointer in (({"scene": "four-bar", "time": 1}, "/method"), ({**RUN, "methods": [RUN["method"]]}, "/method"),
                                  ({**RUN, "method": "indx1@rk4:h=1e-3"}, "/method")):
            self.assertEqual(self.ask(question, status=422).json()["errors"][0]["pointer"], pointer)

    def test_several_methods_are_one_run(self):
        methods = ["index1@rk4:h=1e-3", "projection@rk4:h=1e-3"]
        document = self.ask({"scene": "four-bar", "methods": methods, "time": 1}).json()
        self.assertEqual([r["method"] for r in document["runs"]], ["index1@rk4:h=0.001", "projection@rk4:h=0.001"])
        for i, run in enumerate(document["runs"]):
            rows = self.server.ask("GET", document["links"]["samples"] + f"?method={i}&fields=gap").json()["rows"]
            self.assertEqual([g for g, in rows], run["samples"]["gap"])

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
        self.assertEqual(self.ask({**LONG, "time": 0.05}).json()["state"], "finished")


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
            for i, (question, answer) in enumerate(zip(questions, answers)):
                again = server.ask("POST", "/api/v1/runs", question)
                self.assertEqual(again.status, 201 if i == 7 else 200)
                self.assertEqual(again.json()["samples"], answer["samples"])
            self.assertEqual(server.ask("GET", "/api/v1/runs/" + answers[3]["id"]).status, 200)
            self.assertEqual(server.ask("DELETE", "/api/v1/runs/" + answers[3]["id"]).status, 204)
            self.assertFalse(os.path.exists(os.path.join(folder, answers[3]["id"] + ".json")))
            self.assertEqual(server.stop(), 0)

    def test_what_used_up_its_time_is_computed_again(self):
        server = driver.Server("--run-cpu", "0.2")
        first, again = (server.ask("POST", "/api/v1/runs", LONG) for _ in range(2))
        self.assertEqual((first.status, again.status, first.json()["status"]), (201, 201, "budget"))
        self.assertEqual(server.stop(), 0)


if __name__ == "__main__":
    driver.main()
