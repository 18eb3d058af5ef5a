# SPDX-License-Identifier: GPL-3.0-or-later
"""Starts the real server on a free port and speaks HTTP to it; runs unittest cases and prints TAP."""

import http.client
import json
import os
import signal
import socket
import statistics
import subprocess
import sys
import threading
import time
import unittest

PROGRAM = os.environ.get("HOLONOM", "build/holonom")
SLOW = 5 if "san" in PROGRAM else 1  # sanitisers cost time, never correctness
AT_WORK = 0.2  # a server that has computed so long is in the middle of what it was asked [s]
TRIES = 3  # a time that is measured on a busy machine is the best of so many


def until(holds, seconds=20, every=0.05):
    """Waits until it holds, at most so long; whether it does. The condition must never come true by itself."""
    end = time.monotonic() + seconds * SLOW
    while not holds():
        if time.monotonic() > end:
            return False
        time.sleep(every)
    return True


def best_of_tries(attempt):
    """Calls attempt() -> (seconds, allowed) until one is within what is allowed, at most TRIES times; the attempts."""
    figures = []
    for _ in range(TRIES):
        figures.append(attempt())
        if figures[-1][0] < figures[-1][1]:
            break
    return figures


class Answer:
    """Status, headers (lower-case names) and bytes of one reply."""

    def __init__(self, response):
        self.status = response.status
        self.headers = {k.lower(): v for k, v in response.getheaders()}
        self.body = response.read()

    @property
    def type(self):
        return self.headers.get("content-type", "").split(";")[0]

    def json(self):
        """Parses strictly: a NaN or an Infinity is an error."""

        def refuse(word):
            raise ValueError("JSON holds " + word)

        return json.loads(self.body.decode("utf-8"), parse_constant=refuse)


class Server:
    """A server process of its own."""

    def __init__(self, *options, environment=None, program=PROGRAM, folder=None):
        env = {k: v for k, v in {**os.environ, **(environment or {})}.items() if v is not None}
        command = program if isinstance(program, list) else [program]
        self.process = subprocess.Popen(
            [*command, "serve", "--port", "0", "--json", *options],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=env, cwd=folder)
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError("the server did not start: " + self.process.stderr.read().decode())
        self.started = json.loads(line)
        self.port = self.started["port"]
        self.errors = []
        self.reader = threading.Thread(target=self._read_errors, daemon=True)
        self.reader.start()

    def _read_errors(self):
        for line in self.process.stderr:
            self.errors.append(line.decode(errors="replace"))

    def connect(self, timeout=60):
        return http.client.HTTPConnection("127.0.0.1", self.port, timeout=timeout * SLOW)

    def ask(self, method, path, body=None, headers=None, timeout=60):
        """One request on a connection of its own. A dict or list is sent as JSON."""
        headers = dict(headers or {})
        if isinstance(body, (dict, list)):
            body = json.dumps(body)
            headers.setdefault("Content-Type", "application/json")
        connection = self.connect(timeout)
        try:
            connection.request(method, path, body=body, headers=headers)
            return Answer(connection.getresponse())
        finally:
            connection.close()

    def raw(self, data, timeout=60):
        """Sends bytes as they are; everything that comes back until the server closes or is silent."""
        with socket.create_connection(("127.0.0.1", self.port), timeout=timeout * SLOW) as s:
            s.settimeout(timeout)
            try:
                s.sendall(data)
                s.shutdown(socket.SHUT_WR)
            except OSError:
                pass
            reply = b""
            try:
                while piece := s.recv(65536):
                    reply += piece
            except OSError:
                pass
            return reply.removeprefix(b"HTTP/1.1 100 Continue\r\n\r\n")  # who has closed one side may be asked whether it is still there

    def timed(self, method, path, body=None, headers=None):
        """One request; its answer and how long it took [s]."""
        start = time.monotonic()
        answer = self.ask(method, path, body, headers)
        return answer, time.monotonic() - start

    def idle(self, path="/healthz"):
        """What a GET takes at this moment, when nobody asks for anything else: the median of 20 [s]."""
        return statistics.median(self.timed("GET", path)[1] for _ in range(20))

    def cpu(self):
        """Computing time of the server so far [s]; a busy machine does not change what a request needs of it."""
        with open(f"/proc/{self.process.pid}/stat") as f:
            fields = f.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def is_at_work(self, before, threads=()):
        """Waits until it has computed for some time since `before`, what cpu() said, or until all threads that ask it have their answers."""
        begun = until(lambda: self.cpu() - before > AT_WORK or (threads and not any(t.is_alive() for t in threads)), 60)
        assert begun, "the server does not compute"

    def compare(self, **fields):
        """Makes a comparison; its description."""
        body = {"scene": "four-bar", "methods": ["projection@rk4:h=1e-3"], **fields}
        answer = self.ask("POST", "/api/v1/comparisons", body)
        assert answer.status == 201, answer.body
        return answer.json()

    def stop(self, how=signal.SIGTERM):
        """Ends it; its exit status. The words of a sanitiser are in `errors`, and are printed where a signal ended it that was not sent."""
        self.process.send_signal(how)
        status = self.process.wait(timeout=30 * SLOW)
        self.reader.join(timeout=5)
        if status < 0 and status != -how:
            print("".join(self.errors), file=sys.stderr)
        self.process.stdout.close()
        self.process.stderr.close()
        return status


def run_to_end(server, question):
    """Asks for a run until it has ended, however slow the machine; the answer, which holds the whole document."""
    while (answer := server.ask("POST", "/api/v1/runs?wait=60", question, timeout=90)).status == 202:
        time.sleep(0.05)
    return answer


class Events:
    """A reader of a comparison's event stream, or of the one at an address: yields (event, id or None, data)."""

    def __init__(self, server, comparison, last_id=None, query="", timeout=30, receive_buffer=None, address=None):
        self.connection = server.connect(timeout)
        if receive_buffer:  # must be set before connecting
            self.connection.sock = socket.socket()
            self.connection.sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
            self.connection.sock.settimeout(timeout * SLOW)
            self.connection.sock.connect(("127.0.0.1", server.port))
        headers = {} if last_id is None else {"Last-Event-ID": str(last_id)}
        self.connection.request("GET", (address or f"/api/v1/comparisons/{comparison}/events") + query, headers=headers)
        self.socket = self.connection.sock
        self.response = self.connection.getresponse()
        self.status = self.response.status
        self.comments = 0
        self.last_id = last_id

    def __iter__(self):
        event, ident, data = "message", None, []
        while True:
            line = self.response.readline()
            if not line:
                return
            line = line.decode("utf-8").rstrip("\n")
            if line.startswith(":"):
                self.comments += 1
                yield ("comment", None, None)
            elif line.startswith("event: "):
                event = line[7:]
            elif line.startswith("id: "):
                ident = int(line[4:])
            elif line.startswith("data: "):
                data.append(line[6:])
            elif line == "" and data:
                self.last_id = ident if ident is not None else self.last_id
                yield (event, ident, json.loads("\n".join(data)))
                event, ident, data = "message", None, []

    def until(self, wanted):
        """Everything up to and with the first event of that name."""
        seen = []
        for event in self:
            seen.append(event)
            if event[0] == wanted:
                return seen
        raise AssertionError(f"the stream ended without {wanted!r}: {[e[0] for e in seen]}")

    def take(self, n):
        """The next n events that carry data."""
        seen = []
        for event in self:
            if event[0] != "comment":
                seen.append(event)
            if len(seen) == n:
                return seen
        raise AssertionError(f"the stream ended after {len(seen)} of {n} events")

    def frames_up_to(self, number):
        """The frames that come next, up to and with that one; other events are passed over."""
        seen = []
        for name, _, data in self:
            if name == "frame":
                seen.append(data)
                if data["frame"] == number:
                    return seen
        raise AssertionError(f"the stream ended before frame {number}")

    def close(self):
        # cut off, with no goodbye
        try:
            self.socket.shutdown(socket.SHUT_RDWR)
        except OSError:
            pass  # the server was quicker
        self.response.close()
        self.connection.close()


class TapResult(unittest.TestResult):
    """Prints a TAP line for each test as it ends."""

    def _say(self, test, good, reason="", skipped=""):
        self.number = getattr(self, "number", 0) + 1
        name = test.id().split(".", 1)[1] if test.id().startswith("__main__.") else test.id()
        name = name.replace("_", " ") + (f" # SKIP {skipped}" if skipped else "")
        print(f"{'ok' if good else 'not ok'} {self.number} - {name}", flush=True)
        for line in reason.splitlines():
            print("# " + line, flush=True)

    def addSuccess(self, test):
        self._say(test, True)

    def addFailure(self, test, err):
        super().addFailure(test, err)
        self._say(test, False, self._exc_info_to_string(err, test))

    def addError(self, test, err):
        super().addError(test, err)
        self._say(test, False, self._exc_info_to_string(err, test))

    def addSubTest(self, test, subtest, err):
        super().addSubTest(test, subtest, err)
        if err is not None:
            self._say(subtest, False, self._exc_info_to_string(err, test))

    def addSkip(self, test, reason):
        super().addSkip(test, reason)
        self._say(test, True, skipped=reason)


class ServerCase(unittest.TestCase):
    """A case whose tests share one server; a server that does not end cleanly fails the case."""

    options = ()
    environment = None

    @classmethod
    def setUpClass(cls):
        cls.server = Server(*cls.options, environment=cls.environment)

    @classmethod
    def tearDownClass(cls):
        status = cls.server.stop()
        if status != 0:
            raise RuntimeError(f"the server ended with {status}: {''.join(cls.server.errors)[-4000:]}")

    def assert_within(self, attempt):
        """One of the tries of attempt() -> (seconds, allowed) keeps within what is allowed."""
        figures = best_of_tries(attempt)
        self.assertLess(figures[-1][0], figures[-1][1], f"(seconds, allowed) of each try: {figures}")

    def assert_problem(self, answer, status, code=None):
        """A problem document of that status, its members sound."""
        self.assertEqual(answer.status, status, answer.body[:500])
        self.assertEqual(answer.type, "application/problem+json")
        document = answer.json()
        self.assertEqual(document["status"], status)
        for member in ("type", "title", "detail"):
            self.assertTrue(document[member], member)
        if code:
            self.assertEqual(document["type"], "/api/v1/errors/" + code)
        for error in document.get("errors", []):
            self.assertTrue(error["detail"])
            self.assertTrue(error["pointer"] == "" or error["pointer"].startswith("/"), error)
        return document


def main():
    suite = unittest.defaultTestLoader.loadTestsFromModule(sys.modules["__main__"])
    result = TapResult()
    print(f"1..{suite.countTestCases()}", flush=True)
    suite.run(result)
    sys.exit(0 if result.wasSuccessful() else 1)
