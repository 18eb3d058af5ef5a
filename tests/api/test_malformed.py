# SPDX-License-Identifier: GPL-3.0-or-later
"""Requests at fault: each gets a problem document that says where and what, and the server goes on."""

import json
import random
import socket

import driver

RUN = {"scene": "four-bar", "method": "index1@rk4:h=1e-3", "time": 0.1}
COMPARISON = {"scene": "four-bar", "methods": ["index1@rk4:h=1e-3"]}


def but(body, **changes):
    """The body with members changed; None takes one out."""
    changed = {**body, **changes}
    return {k: v for k, v in changed.items() if v is not None}


# bytes sent to POST /api/v1/runs, the byte at which they stop being JSON
NOT_JSON = [
    (b"", 0),
    (b"   ", 3),
    (b"{", 1),
    (b'{"scene"', 8),
    (b'{"scene" "four-bar"}', 9),
    (b'{"scene": four-bar}', 10),
    (b"{'scene': 1}", 1),
    (b'{"time": 01}', None),
    (b'{"time": +1}', 9),
    (b'{"time": .5}', 9),
    (b'{"time": 1.}', None),
    (b'{"time": NaN}', 9),
    (b'{"time": Infinity}', 9),
    (b'{"time": -Infinity}', None),
    (b'{"time": 1e400}', None),
    (b'{"time": 0x10}', None),
    (b'{"time": 1,}', None),
    (b'{"time": 1} {}', 12),
    (b'{"scene": "four\nbar"}', None),
    (b'{"scene": "\\x41"}', None),
    (b'{"scene": "\\u00"}', None),
    (b'{"scene": "\xff\xfe"}', None),
    (b'{"scene": "\xed\xa0\x80"}', None),
    (b'\xef\xbb\xbf{}', 0),
    (b'{"scene": "four-bar', None),
    (b'{"time": 1}\x00', 11),
    (b"[" * 100 + b"]" * 100, 64),
    (b"[" * 100000, 64),
]

# path, body, pointer of a fault, a word of its detail or hint
AT_FAULT = [
    ("runs", [], "", "object"),
    ("runs", {}, "/scene", "missing"),
    ("runs", but(RUN, scene=None), "/scene", "missing"),
    ("runs", but(RUN, method=None), "/method", "missing"),
    ("runs", but(RUN, scene=7), "/scene", "scene"),
    ("runs", but(RUN, scene=["four-bar"]), "/scene", "scene"),
    ("runs", but(RUN, scene="for-bar"), "/scene", "four-bar"),
    ("runs", but(RUN, scene=""), "/scene", ""),
    ("runs", but(RUN, scene="../../etc/passwd"), "/scene", ""),
    ("runs", but(RUN, scene={}), "/scene", ""),
    ("runs", but(RUN, method=1), "/method", "string"),
    ("runs", but(RUN, method="index1"), "/method", "@"),
    ("runs", but(RUN, method="indx1@rk4:h=1e-3"), "/method", "index1"),
    ("runs", but(RUN, method="index1@rk5:h=1e-3"), "/method", "rk4"),
    ("runs", but(RUN, method="index1@rk4:hh=1e-3"), "/method", "h"),
    ("runs", but(RUN, method="index1@rk4:h=0"), "/method", ""),
    ("runs", but(RUN, method="index1@rk4:h=-1"), "/method", ""),
    ("runs", but(RUN, method="index1@rk4:h=abc"), "/method", ""),
    ("runs", but(RUN, method="index1@rk4:h=1e-3,h=1e-4"), "/method", ""),
    ("runs", but(RUN, method="@"), "/method", ""),
    ("runs", but(RUN, method="x" * 5000), "/method", ""),
    ("runs", but(RUN, time="1"), "/time", "number"),
    ("runs", but(RUN, time=0), "/time", ""),
    ("runs", but(RUN, time=-1), "/time", ""),
    ("runs", but(RUN, time=1e300), "/time", ""),
    ("runs", but(RUN, tiem=1), "/tiem", "time"),
    ("runs", but(RUN, every=-0.1), "/every", ""),
    ("runs", but(RUN, every=1e-9), "/every", ""),
    ("runs", but(RUN, at=[]), "/at", ""),
    ("runs", but(RUN, at=[1, "2"]), "/at/1", "entry 2 of 'at' is the text '2'; it must be a number"),
    ("runs", but(RUN, at=[0.05, 0.01]), "/at", "ascending"),
    ("runs", but(RUN, at=[0.05, 5]), "/at", ""),
    ("runs", but(RUN, parameters={"l1": "long"}), "/parameters/l1", "'l1' is the text 'long'; it must be a number"),
    ("runs", but(RUN, parameters=[1]), "/parameters", "'parameters' is an array; it must be an object of numbers"),
    ("runs", but(RUN, time=True), "/time", "'time' is true; it must be a number"),
    ("runs", but(RUN, time="1"), "/time", "'time' is the text '1'; it must be a number"),
    ("runs", but(RUN, scene=[]), "/scene", "'scene' is an array; it must be the id of a shipped scene or a scene object"),
    ("runs", but(RUN, methods=["index1@rk4", 7]), "/methods/1", "entry 2 of 'methods' is 7; it must be a string"),
    ("studies", {"kind": "stability", "scene": "four-bar", "methods": ["baumgarte@rk4"], "columns": 4.5}, "/columns", "'columns' is 4.5; it must be a whole number"),
    ("runs", but(RUN, parameters={"nonsense": 1}), "/parameters/nonsense", "nonsense"),
    ("runs", but(RUN, parameters={"a/b~c": 1}), "/parameters/a~1b~0c", "a/b~c"),
    ("terms", {"scene": "four-bar", "state": {"nonsense": 1}}, "/state/nonsense", ""),
    ("terms", {"scene": "four-bar", "state": {"th1": 1e16}}, "/state/th1", "so large that rounding changes"),
    ("drag", {"scene": "four-bar", "state": {"th1": -1e20}, "point": 1, "target": [0, 1]}, "/state/th1", "so large that rounding changes"),
    ("terms", {"scene": "four-bar", "t": "now"}, "/t", "number"),
    ("equations", {"scene": "four-bar", "format": "latx"}, "/format", "latex"),
    ("comparisons", but(COMPARISON, methods=[]), "/methods", ""),
    ("comparisons", but(COMPARISON, methods=["index1@rk4:h=1e-3"] * 9), "/methods", ""),
    ("comparisons", but(COMPARISON, methods=["index1@rk4:h=1e-3", "nonsense"]), "/methods/1", ""),
    ("comparisons", but(COMPARISON, methods="index1@rk4"), "/methods", "array"),
    ("comparisons", but(COMPARISON, speed=0), "/speed", ""),
    ("comparisons", but(COMPARISON, speed=1000), "/speed", ""),
    ("comparisons", but(COMPARISON, duration=5000), "/duration", ""),
    ("comparisons", but(COMPARISON, frame_dt=0), "/frame_dt", ""),
    ("comparisons", but(COMPARISON, paused="yes"), "/paused", "true"),
    ("snapshots", {"scene": "four-bar", "methods": ["index1@rk4:h=1e-3"], "time": 0, "width": 5}, "/width", ""),
    ("snapshots", {"scene": "four-bar", "methods": ["index1@rk4:h=1e-3"], "time": 0, "width": 1e9}, "/width", ""),
    ("snapshots", {"scene": "four-bar", "methods": ["index1@rk4:h=1e-3"], "time": 0, "theme": "drak"}, "/theme", "dark"),
    ("snapshots", {"scene": "four-bar", "methods": ["index1@rk4:h=1e-3"], "time": 0, "view": "tob"}, "/view", "top"),
    ("grade", {"problem": "p33", "submission": {}}, "/problem", "p3"),
    ("grade", {"problem": "p3"}, "/submission", "missing"),
]

# method, path, headers, body, status, code
WRONG_REQUESTS = [
    ("GET", "/api/v1/scnes", {}, None, 404, "not-found"),
    ("GET", "/api/v2/scenes", {}, None, 404, "not-found"),
    ("GET", "/api/v1/scenes/for-bar", {}, None, 404, "not-found"),
    ("GET", "/api/v1/scenes/", {}, None, 404, "not-found"),
    ("GET", "/api/v1/scenes/four-bar/x", {}, None, 404, "not-found"),
    ("GET", "/api/v1/errors/nothing", {}, None, 404, "not-found"),
    ("GET", "/api/v1/problems/p9", {}, None, 404, "not-found"),
    ("GET", "/api/v1/comparisons/0123456789abcdef", {}, None, 404, "not-found"),
    ("GET", "/api/v1/comparisons/0123456789abcdef/events", {}, None, 404, "not-found"),
    ("PATCH", "/api/v1/comparisons/0123456789abcdef", {"Content-Type": "application/json"}, "{}", 404, "not-found"),
    ("POST", "/nothing", {}, "x", 404, "not-found"),
    ("POST", "/", {}, "x", 405, "method-not-allowed"),
    ("DELETE", "/index.html", {}, None, 405, "method-not-allowed"),
    ("POST", "/api/v1/scenes", {}, "x", 405, "method-not-allowed"),
    ("PUT", "/api/v1/comparisons", {}, "x", 405, "method-not-allowed"),
    ("GET", "/api/v1/terms", {}, None, 405, "method-not-allowed"),
    ("BREW", "/api/v1/", {}, None, 405, "method-not-allowed"),
    ("GET", "/api/v1/scenes", {"Accept": "text/html"}, None, 406, "not-acceptable"),
    ("GET", "/api/v1/scenes", {"Accept": "application/json;q=0"}, None, 406, "not-acceptable"),
    ("POST", "/api/v1/snapshots", {"Accept": "application/json", "Content-Type": "application/json"}, "{}", 406, "not-acceptable"),
    ("POST", "/api/v1/runs", {}, "{}", 415, "media-type"),
    ("POST", "/api/v1/runs", {"Content-Type": "text/plain"}, "{}", 415, "media-type"),
    ("POST", "/api/v1/runs", {"Content-Type": "application/jsonx"}, "{}", 415, "media-type"),
    ("POST", "/api/v1/runs", {"Content-Type": "application/json; charset=utf-16"}, "{}", 415, "media-type"),
    ("POST", "/api/v1/runs", {"Content-Type": "application/json", "Content-Encoding": "gzip"}, "{}", 415, "media-type"),
    ("CONNECT", "127.0.0.1:443", {}, None, 405, "method-not-allowed"),
    ("CONNECT", "/api/v1/runs", {}, None, 405, "method-not-allowed"),
    ("POST", "/api/v1/runs", {"Content-Type": "application/json"}, " " * 1100000, 413, "too-large"),
    ("GET", "/api/v1/", {"Host": "evil.example"}, None, 421, "unknown-host"),
    ("GET", "/", {"Host": "evil.example:80"}, None, 421, "unknown-host"),
    ("GET", "/", {"Host": "127.0.0.1.evil.example"}, None, 421, "unknown-host"),
    ("GET", "/", {"Host": "127.0.0.1:80:80"}, None, 421, "unknown-host"),
    ("GET", "/", {"Host": "[::1"}, None, 421, "unknown-host"),
    ("POST", "/api/v1/runs", {"Origin": "http://evil.example", "Content-Type": "application/json"}, "{}", 403, "foreign-origin"),
    ("GET", "/api/v1/", {"Origin": "null"}, None, 403, "foreign-origin"),
    ("GET", "/api/v1/scenes/four-bar?set=l1", {}, None, 422, "invalid-input"),
    ("GET", "/api/v1/scenes/four-bar?set=l1:x", {}, None, 422, "invalid-input"),
    ("GET", "/api/v1/scenes/four-bar?set=l1:0x1", {}, None, 422, "invalid-input"),
    ("GET", "/api/v1/scenes/four-bar?set=l1:%201", {}, None, 422, "invalid-input"),
    ("GET", "/api/v1/scenes/four-bar/reference?time=%2B1", {}, None, 422, "invalid-input"),
    ("GET", "/api/v1/problems/p3?hint=%2B1", {}, None, 422, "invalid-input"),
    ("GET", "/api/v1/scenes/four-bar?set=:1", {}, None, 422, "invalid-input"),
    ("GET", "/api/v1/scenes/four-bar?set=l1:nan", {}, None, 422, "invalid-input"),
    ("GET", "/api/v1/scenes/four-bar?set=nonsense:1", {}, None, 422, "invalid-input"),
]

# what no HTTP client would send; the server may answer as it likes, but must go on
RAW = [
    b"\r\n\r\n",
    b"GET\r\n\r\n",
    b"GET / HTTP/9.9\r\nHost: localhost\r\n\r\n",
    b"GET / HTTP/1.1\r\n\r\n",
    b"\x00\x01\x02\x03\r\n\r\n",
    b"GET /%00 HTTP/1.1\r\nHost: localhost\r\n\r\n",
    b"GET /%zz HTTP/1.1\r\nHost: localhost\r\n\r\n",
    b"GET /\xff\xfe HTTP/1.1\r\nHost: localhost\r\n\r\n",
    b"GET /" + b"a" * 100000 + b" HTTP/1.1\r\nHost: localhost\r\n\r\n",
    b"GET / HTTP/1.1\r\nHost: localhost\r\n" + b"X: y\r\n" * 20000 + b"\r\n",
    b"POST /api/v1/runs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: -5\r\n\r\n{}",
    b"POST /api/v1/runs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 99999999999999999999\r\n\r\n{}",
    b"POST /api/v1/runs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 100\r\n\r\n{}",
    b"POST /api/v1/runs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n",
    b"GET / HTTP/1.1\r\nHost: localhost\r\nHost: evil.example\r\n\r\n",
]


# what heads at random are made of
VERBS = [b"GET", b"POST", b"HEAD", b"OPTIONS", b"PATCH", b"DELETE", b"PUT", b"BREW", b""]
ADDRESSES = [b"/", b"/index.html", b"/api", b"/api/v1/", b"/healthz", b"/api/v1/runs", b"/api/v1/comparisons", b"/api/v1/comparisons/0123456789abcdef/events",
             b"/api/v1/studies", b"/api/v1/scenes/four-bar", b"/api/v1/nothing", b"*", b"http://localhost/", b"/%2e%2e/x", b"/?x=1", b"/?" + b"a&" * 300]
LINES = [b"Content-Type: application/json", b"Accept-Encoding: gzip", b"Expect: 100-continue", b"Connection: close", b"Upgrade: websocket", b"Accept: text/html",
         b"If-None-Match: *", b"Origin: http://evil.example", b"Authorization: Bearer x", b"Range: bytes=0-1", b"X-A: a\0b", b"X-Forwarded-For: 1.2.3.4, 5.6.7.8"]
LENGTHS = [b"Content-Length: " + n for n in (b"0", b"2", b"1100000", b"9000000", b"99999999999999999999", b"-1", b"x", b"2, 2")]
ENCODINGS = [b"Transfer-Encoding: " + name for name in (b"chunked", b"Chunked", b"gzip")]
BODIES = [b"", b"{}", b'{"scene":"pendulum","method":"index1@rk4:h=1e-2","time":0.1}', b"2\r\n{}\r\n0\r\n\r\n", b"2\r\n{}\r\n", b"fffffff\r\n" + b" " * 3000, b" " * 70000, b"zz\r\n"]


def random_request(chance):
    lines = [chance.choice(VERBS) + b" " + chance.choice(ADDRESSES) + b" HTTP/" + chance.choice([b"1.1"] * 4 + [b"1.0", b"2.0"])]
    lines += [b"Host: localhost"] * (chance.random() < 0.95) + chance.sample(LINES, chance.randrange(4))
    lines += chance.sample(LENGTHS, chance.random() < 0.5) + chance.sample(ENCODINGS, chance.random() < 0.3)
    request = bytearray(chance.choice([b"\r\n"] * 5 + [b"\n"]).join(lines) + b"\r\n\r\n" + chance.choice(BODIES))
    for _ in range(chance.randint(1, 5) if chance.random() < 0.2 else 0):
        request[chance.randrange(len(request))] = chance.randrange(256)
    return bytes(request)


class Malformed(driver.ServerCase):
    def tearDown(self):
        self.assertEqual(self.server.ask("GET", "/healthz").status, 200)

    def test_bytes_that_are_not_json_get_400_with_their_byte(self):
        for body, offset in NOT_JSON:
            with self.subTest(body=body[:40]):
                answer = self.server.ask("POST", "/api/v1/runs", body, {"Content-Type": "application/json"})
                document = self.assert_problem(answer, 400, "bad-json")
                self.assertLessEqual(document["offset"], len(body))
                if offset is not None:
                    self.assertEqual(document["offset"], offset)

    def test_fields_at_fault_get_422_with_their_pointer(self):
        for path, body, pointer, word in AT_FAULT:
            with self.subTest(path=path, body=json.dumps(body)[:200]):
                document = self.assert_problem(self.server.ask("POST", "/api/v1/" + path, body), 422, "invalid-input")
                errors = document["errors"]
                if pointer is not None:
                    self.assertTrue(any(e["pointer"].startswith(pointer) for e in errors), errors)
                self.assertIn(word, json.dumps(errors))

    def test_a_member_written_twice_is_at_fault(self):
        body = b'{"scene": "four-bar", "method": "index1@rk4:h=1e-3", "time": 1, "time": 2}'
        answer = self.server.ask("POST", "/api/v1/runs", body, {"Content-Type": "application/json"})
        self.assertIn("twice", self.assert_problem(answer, 422)["errors"][0]["detail"])

    def test_a_name_written_twice_below_the_top_is_at_fault(self):
        scene = open("lessons/01-closed-loops/scenes/pendulum.json").read()
        for path, body, pointer in (
                ("runs", '{"scene": "four-bar", "method": "index1@rk4", "parameters": {"l1": 0.5, "l2": 1, "l1": 0.6}}', "/parameters/l1"),
                ("terms", '{"scene": "four-bar", "state": {"th1": 0.5, "th1": 0.6}}', "/state/th1"),
                ("terms", '{"scene": "four-bar", "pull": {"point": 1, "to": [0, 1], "point": 2}}', "/pull/point"),
                ("grade", '{"problem": "p3", "submission": {"J": [], "notes": [{"a": 1, "b": 2, "a": 3}]}}', "/submission/notes/0/a"),
                ("assemble", '{"scene": ' + scene.replace('"mass": "m"', '"mass": "m", "mass": 2') + "}", "/scene/bodies/0/mass")):
            with self.subTest(path=path, pointer=pointer):
                answer = self.server.ask("POST", "/api/v1/" + path, body, {"Content-Type": "application/json"})
                error = self.assert_problem(answer, 422)["errors"][0]
                self.assertEqual(error["pointer"], pointer)
                self.assertIn("twice", error["detail"])

    def test_a_query_parameter_given_twice_is_refused_by_its_name(self):
        run = self.server.ask("POST", "/api/v1/runs", but(RUN, time=0.1)).json()["id"]
        for path, name in ((f"runs/{run}/samples?stride=2&stride=3", "stride"), (f"runs/{run}?wait=0&wait=0", "wait"),
                           ("scenes/four-bar/reference?time=1&compute=false&time=2", "time")):
            detail = self.assert_problem(self.server.ask("GET", "/api/v1/" + path), 400, "bad-request")["detail"]
            self.assertIn(f"'{name}' is given twice", detail)
        # set is the one that may come several times, each parameter once
        self.assertEqual(self.server.ask("GET", "/api/v1/scenes/four-bar?set=l1:0.5&set=l2:1").status, 200)
        document = self.assert_problem(self.server.ask("GET", "/api/v1/scenes/four-bar?set=l1:0.5&set=l1:0.6"), 422)
        self.assertIn("'l1' is given twice", document["detail"])

    def test_heads_that_say_two_things_are_refused(self):
        post = b"POST /api/v1/runs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
        for head, word in ((b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nHost: evil.example\r\n\r\n", b"Host"),
                           (b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nHost: localhost\r\n\r\n", b"Host"),
                           (post + b"Content-Length: 2\r\nContent-Length: 3\r\n\r\n{} ", b"Content-Length"),
                           (post + b"Content-Length: 2\r\nTransfer-Encoding: chunked\r\n\r\n2\r\n{}\r\n0\r\n\r\n", b"only one is allowed"),
                           (post + b"Transfer-Encoding: chunked\r\nTransfer-Encoding: gzip\r\n\r\n2\r\n{}\r\n0\r\n\r\n", b"Transfer-Encoding is given 2"),
                           (post + b"Transfer-Encoding: gzip\r\n\r\n{}", b"'gzip'")):
            with self.subTest(head=head):
                reply = self.server.raw(head)
                self.assertTrue(reply.startswith(b"HTTP/1.1 400 "), reply[:200])
                problem = json.loads(reply.partition(b"\r\n\r\n")[2])
                self.assertEqual(problem["type"], "/api/v1/errors/bad-request")
                self.assertIn(word.decode(), problem["detail"])

    def test_nothing_follows_a_head_whose_length_is_not_certain(self):
        """A proxy may take the rest for the body: it was read as the next request."""
        post = b"POST /api/v1/inspect HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
        hidden = b"GET /api/v1/hidden HTTP/1.1\r\nHost: localhost\r\n\r\n"
        chunked = b"\r\n\r\n%x\r\n" % len(hidden) + hidden + b"\r\n0\r\n\r\n"
        for head, word in ((post + b"Content-Length: 2\r\nContent-Length: 50\r\n\r\n{}" + hidden, "Content-Length is given 2"),
                           (post + b"Content-Length: 2\r\nContent-Length: 2\r\n\r\n{}" + hidden, "Content-Length is given 2"),
                           (post + b"Transfer-Encoding : chunked" + chunked, "'Transfer-Encoding ' is not the name of a header"),
                           (b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nContent-Length\t: 50\r\n\r\n" + hidden, "is not the name of a header"),
                           (b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nX(): 1\r\n\r\n" + hidden, "'X()' is not the name of a header"),
                           (post + b"Transfer-Encoding: identity" + chunked, "'identity'")):
            with self.subTest(head=head):
                reply = self.server.raw(head)
                self.assertEqual((reply[:13], reply.count(b"HTTP/1.1 ")), (b"HTTP/1.1 400 ", 1), reply)
                self.assertIn(b"\r\nConnection: close\r\n", reply)
                self.assertIn(word, json.loads(reply.partition(b"\r\n\r\n")[2])["detail"])

    def test_every_fault_of_a_body_is_told_at_once(self):
        document = self.assert_problem(self.server.ask("POST", "/api/v1/runs", {"scen": 1, "time": "x", "every": -1}), 422)
        self.assertEqual({"/scen", "/time", "/every", "/scene"}, {e["pointer"] for e in document["errors"]})

    def test_a_missing_field_hides_no_misspelt_method_or_scene(self):
        """They were told one request after the other."""
        for path, body, pointers in (
                ("runs", {"scene": "four-bra", "method": "projektion@rk4"}, ["/method", "/time", "/scene"]),
                ("runs", {"scene": "four-bar", "methods": ["index1@rk4", "indx1@rk4", "index1@rk5"], "time": 1}, ["/methods/1", "/methods/2"]),
                ("comparisons", {"scene": "four-bra", "methods": ["indx1@rk4"], "speed": 0}, ["/methods/0", "/speed", "/scene"]),
                ("snapshots", {"scene": "four-bar", "methods": ["index1@rk4:h=x"]}, ["/methods/0", "/time"])):
            with self.subTest(path=path, body=body):
                document = self.assert_problem(self.server.ask("POST", "/api/v1/" + path, body), 422)
                self.assertEqual([e["pointer"] for e in document["errors"]], pointers)

    def test_a_byte_order_mark_is_told(self):
        for text in (json.dumps(RUN).encode("utf-8-sig"), json.dumps(RUN).encode("utf-16")):
            document = self.assert_problem(self.server.ask("POST", "/api/v1/runs", text, {"Content-Type": "application/json"}), 400, "bad-json")
            self.assertEqual(document["hint"], "save the text as UTF-8 without a byte order mark")

    def test_faults_inside_a_scene_are_told_by_their_place_in_the_body(self):
        scene = json.load(open("lessons/01-closed-loops/scenes/pendulum.json"))
        scene["bodies"][0]["mass"] = "heavy +"
        document = self.assert_problem(self.server.ask("POST", "/api/v1/runs", but(RUN, scene=scene)), 422)
        self.assertTrue(document["errors"][0]["pointer"].startswith("/scene/bodies/0/mass"), document["errors"])

    def test_wrong_requests_get_their_status(self):
        for method, path, headers, body, status, code in WRONG_REQUESTS:
            with self.subTest(method=method, path=path, headers=headers):
                answer = self.server.ask(method, path, body, headers)
                self.assert_problem(answer, status, code)
                if status == 405:
                    self.assertIn("OPTIONS", answer.headers["allow"])

    def test_an_oversized_body_without_a_length_is_refused(self):
        connection = self.server.connect()
        connection.request("POST", "/api/v1/runs", body=(b" " * 65536 for _ in range(20)),
                           headers={"Content-Type": "application/json"}, encode_chunked=True)
        self.assert_problem(driver.Answer(connection.getresponse()), 413, "too-large")
        connection.close()

    def test_a_body_in_chunks_that_is_refused_is_told_so_before_its_end(self):
        """The end is never sent: 408 after half a minute was the answer."""
        post = b" HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n"
        for first_line, sent, status, header in ((b"POST /api/v1/runs", b"140000\r\n" + b" " * 0x140000, 413, b"Connection: close"),
                                                 (b"POST /api/v1/nothing", b"2\r\n{}", 404, b"Connection: close"),
                                                 (b"POST /api/v1/scenes", b"2\r\n{}", 405, b"Allow: GET, HEAD, OPTIONS")):
            with self.subTest(first_line=first_line), socket.create_connection(("127.0.0.1", self.server.port), timeout=20 * driver.SLOW) as s:
                s.sendall(first_line + post + sent)
                reply = b""
                while not reply.endswith(b"}"):
                    piece = s.recv(65536)
                    self.assertTrue(piece, reply)
                    reply += piece
                head, _, body = reply.partition(b"\r\n\r\n")
                self.assertTrue(head.startswith(f"HTTP/1.1 {status} ".encode()), reply[:300])
                self.assertIn(header, head.split(b"\r\n"))
                self.assertEqual(json.loads(body)["status"], status)

    def test_a_body_that_is_sent_to_a_file_of_the_page_is_read_or_refused(self):
        """One that was longer than is read ended the server."""

        def ask(method, path, size, chunked, headers=()):
            connection = self.server.connect()
            piece = b" " * (1 << 20)
            body = (piece[:min(size - at, len(piece))] for at in range(0, size, len(piece)))
            connection.request(method, path, body=body, encode_chunked=chunked, headers={**dict(headers), **({} if chunked else {"Content-Length": str(size)})})
            answer = driver.Answer(connection.getresponse())
            connection.close()
            return answer

        for method, path, status in (("GET", "/", 200), ("GET", "/index.html", 200), ("GET", "/api", 308), ("OPTIONS", "/", 204)):
            for headers in ({}, {"Accept-Encoding": "gzip"}):
                for chunked in (False, True):
                    with self.subTest(method=method, path=path, chunked=chunked, headers=headers):
                        self.assertEqual(ask(method, path, 3 << 20, chunked, headers).status, status)
                        document = self.assert_problem(ask(method, path, 9 << 20, chunked, headers), 413, "too-large")
                        self.assertIn("takes no body", document["detail"])

    def test_a_client_that_sends_much_reads_why_it_was_refused(self):
        """http.client sends the whole body before it reads: a connection that is closed meanwhile would break its pipe."""
        length, piece = 50 << 20, b" " * (1 << 20)
        headers = {"Content-Type": "application/json"}

        def plain(path):
            return self.server.ask("POST", path, piece * 50, headers)

        def chunked(path):
            connection = self.server.connect()
            connection.request("POST", path, body=(piece for _ in range(50)), headers=headers, encode_chunked=True)
            answer = driver.Answer(connection.getresponse())
            connection.close()
            return answer

        def waiting(path):
            """As curl does: it sends the body when it is told to go on, and here it never is."""
            head = f"POST {path} HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nExpect: 100-continue\r\nContent-Length: {length}\r\n\r\n"
            return self.server.raw(head.encode())

        for send in (plain, chunked):
            document = self.assert_problem(send("/api/v1/runs"), 413, "too-large")
            self.assertIn("1048576", document["detail"])
        self.assertTrue(waiting("/api/v1/runs").startswith(b"HTTP/1.1 413 "))
        self.assert_problem(plain("/api/v1/nothing"), 404, "not-found")

    def test_an_address_that_is_too_long_is_told_so(self):
        limits = self.server.ask("GET", "/api/v1/").json()["limits"]
        most, parameters = limits["address_bytes"], limits["address_parameters"]

        def ask(query):
            return self.server.ask("GET", "/api/v1/scenes/four-bar?" + query)

        for query in ("set=l1:0.6&" * 1000, "a&" * 4500, "set=" + "9" * 9000, "a=b&" * parameters, "&" * 30000, "x" * 60000):
            with self.subTest(query=query[:20], n=len(query)):
                self.assert_problem(ask(query), 414, "address-too-long")
        # at the bounds it is read
        parameter = "set=l1:0.6&"
        self.assertEqual(ask(parameter * (parameters - 1) + "set=l1:0.6").status, 422)  # more than a scene has
        self.assertEqual(ask("set=l1:0.6" + "0" * (most - len("/api/v1/scenes/four-bar?set=l1:0.6"))).status, 200)
        self.assertEqual(ask("set=l1:0.6" + "0" * (most + 1 - len("/api/v1/scenes/four-bar?set=l1:0.6"))).status, 414)

    def test_a_zero_byte_in_an_address_is_refused(self):
        for path in ("/api/v1/%00scenes", "/api/v1/scenes/four-bar%00x", "/api/v1/scenes/four-bar?set=l1:0.6%00x", "/%00", "/index.html%00.png"):
            document = self.assert_problem(self.server.ask("GET", path), 400, "bad-request")
            self.assertIn("%00", document["detail"])

    def test_a_raw_zero_byte_in_an_address_is_refused(self):
        """The HTTP library reads it as the end of the address: '/' and a zero byte was the start page."""
        for address in (b"/\0abc", b"/index.html\0.png", b"/healthz\0?x", b"/healthz?a\0b", b"/\0"):
            reply = self.server.raw(b"GET " + address + b" HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")
            self.assertTrue(reply.startswith(b"HTTP/1.1 400 "), (address, reply[:200]))

    def test_a_zero_byte_in_a_header_is_refused(self):
        """The HTTP library reads it as the end of the value: 'Host: localhost' and a zero byte was ours, whatever followed."""
        end = b"Connection: close\r\n\r\n"
        for headers in (b"Host: localhost\0.example\r\n" + end, b"Host: localhost\r\nX-A: a\0b\r\n" + end, b"X-A: \0b\r\nHost: localhost\r\n" + end,
                        b"Host: localhost\r\nConnection: close\0keep\r\n\r\n", b"Host: localhost\nX-A: a\0b\n\n",
                        b"Host: localhost\r\nX-A: a\r\n b\r\n" + end):  # it goes on in a second line, which is refused too
            reply = self.server.raw(b"GET /healthz HTTP/1.1\r\n" + headers)
            self.assertTrue(reply.startswith(b"HTTP/1.1 400 "), (headers, reply[:200]))
        # the library reads one that begins a line as the end of the head, and the rest as another request
        for headers in (b"Host: localhost\r\n\0X-A: b\r\n" + end, b"Host: localhost\r\n\0\r\n" + end, b"Host: localhost\r\nX-A: b\r\n\0\r\n\r\n",
                        b"Host: localhost\n\0X-A: b\n" + end, b"Host: localhost\r\nX-A: \r\n\0Host: evil.example\r\n" + end, b"\0X-A: b\r\nHost: localhost\r\n" + end):
            reply = self.server.raw(b"GET /healthz HTTP/1.1\r\n" + headers)
            self.assertTrue(reply.startswith(b"HTTP/1.1 400 "), (headers, reply[:200]))
            self.assertEqual(reply.count(b"HTTP/1.1 "), 1, headers)
        # other things between a value and the next name are none
        for headers in (b"Host: localhost\r\nX-A: a  \t \r\n" + end, b"Host: localhost\nX-A: a\nX-B:\nConnection: close\n\n", b"X-A:\r\nX-B:   \r\nHost:  localhost\r\n" + end):
            reply = self.server.raw(b"GET /healthz?x HTTP/1.1\r\n" + headers)
            self.assertTrue(reply.startswith(b"HTTP/1.1 400 "), (headers, reply[:200]))
            self.assertIn(b"'x' is unknown here", reply)
        body = b"POST /api/v1/runs HTTP/1.1\nHost: localhost\nContent-Type: application/json\nContent-Length: 2\nConnection: close\n\n{}"
        self.assertTrue(self.server.raw(body).startswith(b"HTTP/1.1 422 "))

    def test_blanks_around_the_value_of_a_header_are_no_part_of_it(self):
        for head, status in ((b"GET /healthz HTTP/1.1\r\nHost: localhost \r\n", 200), (b"GET /healthz HTTP/1.1\r\nHost:\t localhost \t \r\n", 200),
                             (b"GET http://localhost/healthz HTTP/1.1\r\nHost: localhost \r\n", 200),
                             (b"GET /healthz HTTP/1.1\r\nHost: localhost \r\nOrigin: http://localhost \r\n", 200),
                             (b"GET /api/v1/ HTTP/1.1\r\nHost: localhost \r\nAccept: application/json \r\n", 200),
                             (b"POST /api/v1/terms HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json \r\nSec-Fetch-Site: same-origin \r\nContent-Length: 0\r\n", 400),
                             (b"GET /healthz HTTP/1.1\r\nHost: local host \r\n", 421), (b"GET /healthz HTTP/1.1\r\nHost:  \t\r\n", 400)):
            reply = self.server.raw(head + b"Connection: close \r\n\r\n")
            self.assertTrue(reply.startswith(f"HTTP/1.1 {status} ".encode()), (head, reply[:300]))
        etag = self.server.ask("GET", "/").headers["etag"]
        reply = self.server.raw(b"GET / HTTP/1.1\r\nHost: localhost\r\nIf-None-Match: " + etag.encode() + b" \r\nConnection: close\r\n\r\n")
        self.assertTrue(reply.startswith(b"HTTP/1.1 304 "), reply[:300])

    def test_what_has_gone_is_deleted_once_more_without_a_fault(self):
        made = self.server.compare()["links"]["self"]
        for address in (made, "/api/v1/comparisons/0123456789abcdef", "/api/v1/studies/0123456789abcdef", "/api/v1/runs/" + 22 * "a"):
            for _ in range(2):
                answer = self.server.ask("DELETE", address)
                self.assertEqual((answer.status, answer.body), (204, b""), address)
            self.assertEqual(self.server.ask("GET", address).status, 404)
        paths = self.server.ask("GET", "/api/v1/openapi.json").json()["paths"]
        self.assertFalse([path for path, verbs in paths.items() if "404" in verbs.get("delete", {}).get("responses", {})])

    def test_a_request_that_the_http_library_cannot_read_gets_a_problem_document(self):
        head = b"POST /api/v1/runs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
        for data, status, code in ((b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nno colon\r\n\r\n", 400, "bad-request"),
                                   (b"GET /healthz\r\n\r\n", 400, "bad-request"),
                                   (head + b"Content-Length: -5\r\n\r\n{}", 400, "bad-request"),
                                   (head + b"Transfer-Encoding: chunked\r\n\r\nzz\r\n", 400, "bad-request"),
                                   (head + b"Transfer-Encoding: chunked\r\n\r\n1;" + b"x" * 100000, 400, "bad-request"),
                                   (head + b"Content-Length: 99999999999999999999\r\n\r\n{}", 413, "too-large"),
                                   (b"GET /" + b"a" * 100000 + b" HTTP/1.1\r\nHost: localhost\r\n\r\n", 414, "address-too-long"),
                                   (b"GET / HTTP/1.1\r\nHost: localhost\r\n" + b"X: y\r\n" * 20000 + b"\r\n", 431, "head-too-long"),
                                   (b"GET / HTTP/9.9\r\nHost: localhost\r\n\r\n", 505, "http-version")):
            with self.subTest(data=data[:60]):
                reply = self.server.raw(data)
                first, _, body = reply.partition(b"\r\n\r\n")
                self.assertTrue(first.startswith(f"HTTP/1.1 {status} ".encode()), reply[:300])
                self.assertIn(b"\r\nContent-Type: application/problem+json", first)
                document = json.loads(body)
                self.assertEqual((document["status"], document["type"]), (status, "/api/v1/errors/" + code))
                self.assertTrue(document["detail"])
                self.assertEqual(self.server.ask("GET", "/api/v1/errors/" + code).status, 200)

    def test_an_address_in_absolute_form_is_taken_with_its_own_host(self):
        host = f"localhost:{self.server.port}".encode()
        for address, named, status in ((b"http://" + host + b"/healthz", host, 200), (b"HTTP://" + host.upper() + b"/api/v1/scenes/four-bar?set=l1:0.6", host, 200),
                                       (b"http://" + host, host, 200), (b"http://localhost/healthz", b"localhost:80", 200), (b"http://localhost:80/healthz", b"localhost", 200),
                                       (b"http://evil.example/healthz", host, 400), (b"http://localhost:81/healthz", b"localhost", 400),
                                       (b"http://evil.example/healthz", b"evil.example", 421), (b"http://" + host + b"/nothing", host, 404)):
            reply = self.server.raw(b"GET " + address + b" HTTP/1.1\r\nHost: " + named + b"\r\nConnection: close\r\n\r\n")
            self.assertTrue(reply.startswith(f"HTTP/1.1 {status} ".encode()), (address, reply[:200]))

    def test_a_head_that_stops_coming_in_is_told_so(self):
        with socket.create_connection(("127.0.0.1", self.server.port), timeout=60 * driver.SLOW) as half, \
                socket.create_connection(("127.0.0.1", self.server.port), timeout=60 * driver.SLOW) as silent:
            half.sendall(b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nX-A: ")
            reply = b""
            while piece := half.recv(65536):
                reply += piece
            first, _, body = reply.partition(b"\r\n\r\n")
            self.assertTrue(first.startswith(b"HTTP/1.1 408 "), reply[:300])
            self.assertEqual(json.loads(body)["type"], "/api/v1/errors/timeout")
            self.assertEqual(silent.recv(65536), b"")  # no request began: browsers open connections ahead
        self.assertEqual(self.server.ask("GET", "/api/v1/errors/timeout").status, 200)

    def test_the_page_takes_the_verbs_that_its_allow_header_lists(self):
        for method in ("FOO", "POST", "DELETE", "PUT"):
            answer = self.server.ask(method, "/")
            self.assert_problem(answer, 405, "method-not-allowed")
            self.assertEqual(answer.headers["allow"], "GET, HEAD, OPTIONS")
        answer = self.server.ask("OPTIONS", "/")
        self.assertEqual((answer.status, answer.headers["allow"]), (204, "GET, HEAD, OPTIONS"))

    def test_a_fault_in_the_scene_of_a_request_is_told_by_its_place_in_the_body(self):
        with open("lessons/01-closed-loops/scenes/four-bar.json") as f:
            scene = json.load(f)

        def told(**fields):
            document = self.assert_problem(self.server.ask("POST", "/api/v1/runs", {"scene": scene, "method": "index1@rk4:h=1e-3", "time": 0.1, **fields}), 422)
            return [e["pointer"] for e in document["errors"]]

        scene["parameters"]["l1"] = {"value": 0.4, "min": 2, "max": 1}
        self.assertEqual(told(), ["/scene/parameters/l1/min"])
        self.assertEqual(told(parameters={"l1": 0.5}), ["/scene/parameters/l1/min"])
        scene["parameters"]["l1"] = 0.4
        self.assertEqual(told(parameters={"none": 1}), ["/parameters/none"])
        scene["parameters"]["l1"] = {"value": 0.4, "min": 0.3, "max": "a"}
        self.assertEqual(told(), ["/scene/parameters/l1/max"])
        scene["parameters"] = 7
        self.assertEqual(told(), ["/scene/parameters"])
        self.assertEqual(told(parameters={"l1": 1})[0], "/scene/parameters")

    def test_options_lists_the_verbs_and_allows_no_other_origin(self):
        answer = self.server.ask("OPTIONS", "/api/v1/comparisons")
        self.assertEqual((answer.status, answer.headers["allow"]), (204, "GET, HEAD, POST, OPTIONS"))
        self.assertFalse([h for h in answer.headers if h.startswith("access-control")])

    def test_loopback_names_and_our_own_origin_are_served(self):
        port = self.server.port
        for host in ("localhost", f"localhost:{port}", "127.0.0.1", "[::1]", f"[::1]:{port}", "LOCALHOST"):
            self.assertEqual(self.server.ask("GET", "/healthz", headers={"Host": host}).status, 200, host)
        origin = {"Origin": f"http://127.0.0.1:{port}"}
        self.assertEqual(self.server.ask("GET", "/healthz", headers=origin).status, 200)

    def test_accept_headers_of_browsers_and_tools_are_served(self):
        for accept in ("*/*", "application/json", "application/*", "text/html, application/json;q=0.9, */*;q=0.8",
                       "text/html;q=1, */*;q=0.1"):
            self.assertEqual(self.server.ask("GET", "/api/v1/", headers={"Accept": accept}).status, 200, accept)

    def test_bytes_that_are_not_http_never_stop_the_server(self):
        for data in RAW:
            with self.subTest(data=data[:60]):
                self.server.raw(data, timeout=2)
                self.assertEqual(self.server.ask("GET", "/healthz").status, 200)

    def test_heads_at_random_never_stop_the_server(self):
        chance = random.Random(20240216)  # its 286th request ended the server once
        for k in range(1000):
            request = random_request(chance)
            with socket.create_connection(("127.0.0.1", self.server.port), timeout=60 * driver.SLOW) as s:
                s.settimeout(0.02)  # long enough for an answer that is there, and no more: most of them want the rest of the body
                try:
                    s.sendall(request)
                    s.recv(4096)
                except OSError:
                    pass
            self.assertIsNone(self.server.process.poll(), (k, request[:300], self.server.errors))

    def test_random_changes_of_a_sound_body_never_stop_the_server(self):
        random.seed(20240214)
        scene = json.load(open("lessons/01-closed-loops/scenes/four-bar.json"))
        text = json.dumps(but(RUN, scene=scene)).encode()
        for _ in range(150):
            body = bytearray(text)
            for _ in range(random.randint(1, 4)):
                body[random.randrange(len(body))] = random.randrange(256)
            answer = self.server.ask("POST", "/api/v1/runs", bytes(body), {"Content-Type": "application/json"})
            self.assertIn(answer.status, (200, 201, 400, 422), body)
            answer.json()


if __name__ == "__main__":
    driver.main()
