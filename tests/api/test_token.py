# SPDX-License-Identifier: GPL-3.0-or-later
"""A server for other machines: a token in its link, then in a cookie, or in a header; guests read."""

import subprocess
import sys
import unittest
import urllib.request

import driver

# becomes the program named behind it, for which socket(AF_NETLINK) is refused as systemd does: EAFNOSUPPORT
WITHOUT_NETLINK = """
import ctypes, os, platform, socket, struct, sys
number = 41 if platform.machine() == "x86_64" else 198
load, equal, end = 0x20, 0x15, 0x06
steps = [(load, 0, 0, 0), (equal, 0, 3, number), (load, 0, 0, 16), (equal, 0, 1, socket.AF_NETLINK), (end, 0, 0, 0x50000 | 97), (end, 0, 0, 0x7FFF0000)]
code = ctypes.create_string_buffer(b"".join(struct.pack("HBBI", *step) for step in steps))
program = ctypes.create_string_buffer(struct.pack("HxxxxxxP", len(steps), ctypes.addressof(code)))
libc = ctypes.CDLL(None, use_errno=True)
for words in ((38, 1, 0, 0, 0), (22, 2, ctypes.addressof(program), 0, 0)):
    if libc.prctl(*map(ctypes.c_ulong, words)) != 0:
        sys.exit("prctl: " + os.strerror(ctypes.get_errno()))
os.execv(sys.argv[1], sys.argv[1:])
"""

BODY = {"scene": "four-bar", "methods": ["index1@rk4:h=1e-3"]}


def next_frame(guest):
    return guest.until("frame")[-1][2]["frame"]


class Token(unittest.TestCase):
    def serve(self, *options):
        server = driver.Server("--token", "a-long-secret-1", *options)
        self.addCleanup(lambda: self.assertEqual(server.stop(), 0, server.errors))
        return server

    def test_nothing_is_served_without_the_token_or_with_a_wrong_one(self):
        server = self.serve()
        for headers in ({}, {"Authorization": "Bearer a-long-secret-2"}, {"Authorization": "Bearer a-long-secret-11"}, {"Authorization": "Bearer "},
                        {"Cookie": "holonom_token=a-long-secret"}):
            for method, path in (("GET", "/"), ("GET", "/api/v1/"), ("POST", "/api/v1/comparisons"), ("GET", "/?token=a-long-secret-2"), ("GET", "/nowhere")):
                answer = server.ask(method, path, BODY if method == "POST" else None, headers)
                self.assertEqual((answer.status, answer.headers.get("www-authenticate")), (401, 'Bearer realm="holonom"'), (path, headers))
                self.assertEqual(answer.type, "application/problem+json")
                self.assertNotIn(b"a-long-secret-1", answer.body)
        self.assertEqual(server.ask("GET", "/healthz").status, 200)

    def test_the_link_becomes_a_cookie(self):
        server = self.serve()
        first = server.ask("GET", "/?token=a-long-secret-1")
        self.assertEqual((first.status, first.headers["location"]), (303, "./"))  # relative: below a prefix of a proxy it holds too
        self.assertEqual(server.ask("GET", "/index.html?token=a-long-secret-1").headers["location"], "./index.html")
        cookie = first.headers["set-cookie"]
        self.assertIn("HttpOnly; SameSite=Strict", cookie)
        self.assertNotIn("Path", cookie)  # the browser takes the folder of the link, with the prefix of a proxy
        headers = {"Cookie": cookie.split(";")[0]}
        self.assertEqual(server.ask("GET", "/", headers=headers).status, 200)
        self.assertEqual(server.ask("POST", "/api/v1/comparisons", BODY, headers).status, 201)

    def test_a_script_sends_a_header_or_the_query(self):
        server = self.serve()
        self.assertEqual(server.ask("POST", "/api/v1/comparisons", BODY, {"Authorization": "Bearer a-long-secret-1"}).status, 201)
        for scheme in ("bearer", "BEARER", "Bearer "):
            self.assertEqual(server.ask("GET", "/api/v1/scenes", headers={"Authorization": scheme + " a-long-secret-1"}).status, 200, scheme)
        for header in ("Basic a-long-secret-1", "a-long-secret-1", "bearera-long-secret-1"):
            self.assertEqual(server.ask("GET", "/api/v1/scenes", headers={"Authorization": header}).status, 401, header)
        self.assertEqual(server.ask("GET", "/api/v1/scenes?token=a-long-secret-1").status, 200)
        self.assertEqual(server.ask("GET", "/api/v1/openapi.json?token=a-long-secret-1").json()["security"], [{"token": []}])

    def test_guests_read_and_change_nothing(self):
        server = self.serve("--guests")
        bearer = {"Authorization": "Bearer a-long-secret-1"}
        made = server.ask("POST", "/api/v1/comparisons", BODY, bearer).json()
        for path in ("/", "/api/v1/", "/api/v1/scenes/four-bar", made["links"]["self"]):
            self.assertEqual(server.ask("GET", path).status, 200, path)
        for method, path, body in (("POST", "/api/v1/comparisons", BODY), ("PATCH", made["links"]["self"], {"step": 1}), ("DELETE", made["links"]["self"], None),
                                   ("POST", "/api/v1/runs", {}), ("GET", "/api/v1/scenes/four-bar/reference?compute=true", None)):
            self.assertEqual(server.ask(method, path, body).status, 401, (method, path))
        events = driver.Events(server, made["id"])
        self.assertEqual(events.status, 200)
        events.close()

    def test_a_wrong_token_is_told_where_guests_read(self):
        """Who mistyped it was a guest without knowing."""
        server = self.serve("--guests")
        for path, headers in (("/api/v1/?token=a-long-secret-2", {}), ("/?token=", {}), ("/api/v1/", {"Authorization": "Bearer a-long-secret-2"})):
            answer = server.ask("GET", path, headers=headers)
            self.assertEqual(answer.status, 401, path)
            self.assertEqual(answer.json()["detail"], "the token that was sent is not that of this server")
        # a cookie of an earlier server, and what a proxy asks for itself, make a guest
        for headers in ({"Cookie": "holonom_token=a-long-secret-2"}, {"Authorization": "Basic YTpi"}):
            self.assertEqual(server.ask("GET", "/api/v1/", headers=headers).status, 200, headers)

    def test_a_token_that_can_be_guessed_is_refused(self):
        for token, said in (("", "has 0 characters; 12 to 128"), ("eleven-char", "has 11 characters"), ("x" * 129, "has 129 characters"),
                            ("two words and more", "no blanks"), (" ", "no blanks"), ("a-long-secret\n", "no blanks")):
            done = subprocess.run([driver.PROGRAM, "serve", "--port", "0", "--token", token], capture_output=True, text=True, timeout=60 * driver.SLOW)
            self.assertEqual(done.returncode, 2, token)
            self.assertIn(said, done.stderr)

    def test_two_guests_at_once_read_the_same_frames(self):
        server = self.serve("--guests")
        bearer = {"Authorization": "Bearer a-long-secret-1"}
        made = server.ask("POST", "/api/v1/comparisons", BODY, bearer).json()
        guests = [driver.Events(server, made["id"]) for _ in range(2)]
        self.assertEqual([guest.status for guest in guests], [200, 200])
        seen = [[next_frame(guest)] for guest in guests]

        # the owner steps; a guest who tries to stops nobody
        for _ in range(3):
            self.assertEqual(server.ask("PATCH", made["links"]["self"], {"step": 1}).status, 401)
            self.assertEqual(server.ask("PATCH", made["links"]["self"], {"step": 1}, bearer).status, 200)
            for guest, frames in zip(guests, seen):
                frames.append(next_frame(guest))
        self.assertEqual(seen, [[0, 1, 2, 3]] * 2)

        # one leaves, the other reads on
        guests[0].close()
        self.assertEqual(server.ask("PATCH", made["links"]["self"], {"step": 1}, bearer).status, 200)
        self.assertEqual(next_frame(guests[1]), 4)
        guests[1].close()

    def test_a_server_for_others_makes_a_token_of_its_own(self):
        server = driver.Server("--host", "0.0.0.0")
        self.addCleanup(server.stop)
        self.assertGreaterEqual(len(server.started["token"]), 22)
        self.assertEqual(server.ask("GET", "/").status, 401)
        self.assertEqual(server.ask("GET", "/", headers={"Authorization": "Bearer " + server.started["token"]}).status, 200)
        alone = driver.Server()
        self.addCleanup(alone.stop)
        self.assertNotIn("token", alone.started)
        self.assertEqual(alone.started["addresses"], [f"http://127.0.0.1:{alone.port}"])

    def test_a_server_for_others_names_addresses_that_others_can_open(self):
        """The link of 0.0.0.0 named 0.0.0.0, which opens on this machine alone."""
        for host in ("0.0.0.0", "::"):
            try:
                server = driver.Server("--host", host)
            except RuntimeError as why:  # a machine without IPv6
                self.assertEqual(host, "::", why)
                continue
            self.addCleanup(server.stop)
            named = server.started["addresses"]
            self.assertEqual(named[0], server.started["address"])
            bearer = {"Authorization": "Bearer " + server.started["token"]}
            for address in named:
                self.assertNotIn("//0.0.0.0:", address)
                self.assertNotIn("//[::]:", address)
                with urllib.request.urlopen(urllib.request.Request(address + "/api/v1/", headers=bearer), timeout=60 * driver.SLOW) as answer:
                    self.assertEqual(answer.status, 200)

    def test_a_sandbox_without_netlink_names_the_same_addresses(self):
        """Under systemd's RestrictAddressFamilies=AF_INET AF_INET6 the link named 127.0.0.1, which opens on this machine alone."""
        named = []
        for program in (driver.PROGRAM, [sys.executable, "-c", WITHOUT_NETLINK, driver.PROGRAM]):
            server = driver.Server("--host", "0.0.0.0", program=program)
            self.addCleanup(server.stop)
            named.append([address.rsplit(":", 1)[0] for address in server.started["addresses"]])
        self.assertEqual(named[0], named[1])


if __name__ == "__main__":
    driver.main()
