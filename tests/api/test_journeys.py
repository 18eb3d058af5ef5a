# SPDX-License-Identifier: GPL-3.0-or-later
"""Ten minutes of a script at the API, with what Python has: what there is, a run, its samples and events, a sweep, a failure, code to take home."""

import concurrent.futures
import csv
import io
import json
import math
import os
import shutil
import subprocess
import tempfile
import time
import unittest
import urllib.error
import urllib.parse
import urllib.request

import driver

RUN = {"scene": "four-bar", "methods": ["index1@rk4:h=1e-2", "projection@rk4:h=1e-2"], "time": 1}
AT = "/api/v1/runs"


class Answer:
    def __init__(self, response):
        self.status, self.headers, self.body, self.url = response.status, response.headers, response.read(), response.geturl()

    def json(self):
        """The document; the words NaN and Infinity, which are no JSON, are a fault."""
        return json.loads(self.body, parse_constant=lambda word: self._fail(word))

    def _fail(self, word):
        raise AssertionError(f"{word} in a document: {self.body[:300]}")


class Script(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = driver.Server()

    @classmethod
    def tearDownClass(cls):
        assert cls.server.stop() == 0, cls.server.errors

    def ask(self, path, body=None, method=None, server=None, **headers):
        """One request by urllib; an answer with a status of 400 and more is an answer too."""
        data = body if body is None or isinstance(body, bytes) else json.dumps(body).encode()
        headers = {"Content-Type": "application/json", **{k.replace("_", "-"): v for k, v in headers.items()}} if data else headers
        request = urllib.request.Request(f"http://127.0.0.1:{(server or self.server).port}{path}", data, headers, method=method)
        try:
            with urllib.request.urlopen(request, timeout=60 * driver.SLOW) as response:
                return Answer(response)
        except urllib.error.HTTPError as refusal:
            return Answer(refusal)

    def test_1_the_index_has_links_version_and_limits(self):
        answer = self.ask("/api")
        self.assertTrue(answer.url.endswith("/api/v1/"), "a shorter address leads there")
        index = answer.json()
        self.assertTrue(index["version"] and index["build"] and index["limits"]["body_bytes"])
        for path in index["links"].values():
            self.assertEqual(self.ask(path).status, 200, path)
        self.assertTrue(self.ask(index["links"]["openapi"]).json()["openapi"].startswith("3.1"))

    def test_2_scenes_come_with_parameters_unit_and_range(self):
        scenes = {s["id"]: s for s in self.ask("/api/v1/scenes").json()["scenes"]}
        self.assertTrue(scenes["four-bar"]["title"])
        self.assertEqual(scenes["four-bar"]["dof"], 1)
        for parameter in scenes["four-bar"]["parameters"]:
            for member in ("name", "value", "unit", "min", "max"):
                self.assertIn(member, parameter)

    def test_3_a_run_is_made_once_and_faults_are_told(self):
        first, again = (self.ask(AT, {**RUN, "time": 0.9}) for _ in range(2))
        self.assertEqual((first.status, again.status), (201, 200))
        self.assertEqual(first.headers["Location"], again.headers["Location"])
        self.assertEqual(first.json()["id"], again.json()["id"])
        fault = self.ask(AT, {**RUN, "methds": []})
        self.assertEqual((fault.status, fault.json()["errors"][0]["pointer"]), (422, "/methds"))
        self.assertIn("methods", fault.json()["errors"][0]["hint"])
        broken = self.ask(AT, b'{"scene": four}')
        self.assertEqual((broken.status, broken.json()["offset"]), (400, 10))
        self.assertEqual(self.ask(AT, b"scene=1", Content_Type="text/plain").status, 415)
        self.assertEqual(self.ask(AT, b" " * (2 << 20)).status, 413)
        verb = self.ask(AT, RUN, method="PUT")
        self.assertEqual((verb.status, "POST" in verb.headers["Allow"]), (405, True))

    def test_4_a_run_is_waited_for(self):
        long = self.ask(AT + "?wait=0", {"scene": "ring", "parameters": {"n": 30}, "method": "projection@rk4:h=1e-4", "time": 1000})
        self.assertEqual(long.status, 202)
        where = long.headers["Location"]
        waited = self.ask(where + "?wait=0.2")
        self.assertEqual((waited.status, waited.json()["state"]), (200, "running"))
        self.assertTrue(0 <= waited.json()["progress"] < 1)
        self.assertGreater(int(waited.headers["Retry-After"]), 0)
        self.assertEqual(self.ask(where, method="DELETE").status, 204)
        done = self.ask(self.ask(AT, RUN).headers["Location"] + "?wait=10").json()
        self.assertEqual(done["state"], "finished")
        for run in done["runs"]:
            self.assertTrue(run["worst_gap"] < 1 and run["cost"]["evaluations"] > 0 and run["status"] == "ok" and run["reason"] == "")

    def test_5_samples_keep_every_digit_in_three_forms(self):
        samples = self.ask(AT, RUN).json()["links"]["samples"] + "?fields=t,q,gap&stride=10"
        rows = self.ask(samples).json()["rows"]
        table = list(csv.reader(io.StringIO(self.ask(samples, Accept="text/csv").body.decode())))[1:]
        lines = [json.loads(line) for line in self.ask(samples, Accept="application/x-ndjson").body.splitlines()]
        self.assertEqual([[float(x) for x in row] for row in table], [[t, *q, gap] for t, q, gap in rows])
        self.assertEqual([[line["t"], line["q"], line["gap"]] for line in lines], rows)
        page = self.ask(samples + "&limit=3")
        self.assertIn('rel="next"', page.headers["Link"])
        asked = urllib.parse.quote(samples.split("?")[0]) + "?fields=t&limit=3&method="
        self.assertIn("&method=0&", self.ask(asked + "0").headers.get("Link", ""))
        self.assertEqual(self.ask(asked + "%0d%0a0").status, 422)  # a number behind blanks, as C reads numbers
        self.assertEqual(self.ask(samples, Accept="image/png").status, 406)
        self.assertEqual(self.ask(samples.replace("=10", "=0")).status, 422)

    def test_6_events_go_on_where_a_reader_left(self):
        def events(last=None):
            request = urllib.request.Request(f"http://127.0.0.1:{self.server.port}{where}/events?mode=complete", headers={"Last-Event-ID": last} if last else {})
            with urllib.request.urlopen(request, timeout=60 * driver.SLOW) as stream:
                blocks = stream.read().decode().split("\n\n")
            return [dict(line.split(": ", 1) for line in block.splitlines() if ": " in line) for block in blocks if "event: " in block]

        where = self.ask(AT, RUN).headers["Location"]
        whole = events()
        self.assertEqual((whole[0]["event"], whole[-1]["event"]), ("hello", "end"))
        samples = [e for e in whole if e["event"] == "sample"]
        rest = [e for e in events(samples[99]["id"]) if e["event"] == "sample"]
        self.assertEqual(rest, samples[100:], "no gap and no repeat")

    def test_7_a_sweep_of_500_loses_nothing(self):
        questions = [{"scene": "four-bar", "parameters": {"l1": 0.9 + 0.0002 * k}, "method": "projection@rk4:h=2e-2", "time": 0.2} for k in range(500)]

        def until_taken(question):
            while (answer := self.ask(AT, question)).status == 429:
                time.sleep(float(answer.headers["Retry-After"]))
            return answer

        with concurrent.futures.ThreadPoolExecutor(8) as hands:
            answers = list(hands.map(until_taken, questions))
        self.assertEqual({a.status for a in answers}, {201})
        self.assertEqual(len({a.json()["id"] for a in answers}), 500)
        self.assertEqual(len({json.dumps(a.json()["samples"]) for a in answers}), 500, "each is a motion of its own")
        self.assertEqual(self.ask(answers[0].headers["Location"], method="DELETE").status, 204)
        self.assertEqual(self.ask(answers[0].headers["Location"]).status, 404)

    def test_8_a_run_that_blew_up_is_data(self):
        run = self.ask(AT, {"scene": "four-bar", "method": "index1@euler:h=0.1", "time": 20}).json()
        failure = run["failure"]
        self.assertEqual((run["status"], failure["code"], failure["quantity"]), ("diverged", "diverged", "gap"))
        self.assertGreater(failure["value"], failure["limit"])
        self.assertEqual(failure["t"], run["t_reached"])
        self.assertTrue(failure["message"] == run["reason"] and failure["remedies"])
        # the columns end at the last sample, all numbers
        self.assertEqual(run["samples"]["t"][-1], run["t_reached"])
        self.assertTrue(all(math.isfinite(x) for q in run["samples"]["q"] for x in q))

    def test_9_code_to_take_home_runs_and_checks_itself(self):
        where = self.ask(AT, RUN).headers["Location"]
        code = self.ask(where + "/export?language=octave")
        self.assertEqual(code.status, 200, code.body[:300])
        wrong = self.ask(where + "/export?language=fortran")
        self.assertEqual(wrong.status, 422)
        self.assertIn("octave", wrong.body.decode())
        if not shutil.which("octave-cli"):
            self.skipTest("octave is not here: its file was not run")
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "mine.m"), "wb") as f:
                f.write(code.body)
            done = subprocess.run(["octave-cli", "--no-gui", "--norc", "mine.m"], cwd=folder, capture_output=True, text=True, timeout=120 * driver.SLOW)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_10_another_server_has_the_same_ids_and_numbers(self):
        other = driver.Server()
        try:
            here, there = self.ask(AT, RUN), self.ask(AT, RUN, server=other)
            self.assertEqual(here.headers["Location"], there.headers["Location"])
            self.assertEqual(here.headers["ETag"], there.headers["ETag"])
            self.assertEqual(here.headers["Holonom-Build"], there.headers["Holonom-Build"])
            self.assertEqual([r["samples"] for r in here.json()["runs"]], [r["samples"] for r in there.json()["runs"]])
        finally:
            self.assertEqual(other.stop(), 0)


if __name__ == "__main__":
    driver.main()
