# SPDX-License-Identifier: GPL-3.0-or-later
"""As many sockets as a client likes, silent or half served: the others are answered meanwhile."""

import http.client
import json
import resource
import select
import signal
import socket
import statistics
import time

import driver
from beside import Timed, is_closed, most_beside


class ManySockets(Timed):
    def test_any_number_of_sockets_that_are_ready_at_one_instant_is_served(self):
        for n in (127, 128, 129, 255, 256):
            server = driver.Server()
            clients = [socket.create_connection(("127.0.0.1", server.port), timeout=20 * driver.SLOW) for _ in range(n)]
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
            self.assertLess(time.monotonic() - start, 8 * driver.SLOW, n)  # 28 s where the library waits for a 129th
            for c in clients:
                c.close()
            self.assertEqual(server.stop(), 0)

    def test_what_takes_milliseconds_is_no_work_of_an_event_loop(self):
        """The exercises are read anew for each request, 13 ms: 300 of them at one instant, done by the event loops, kept all others waiting
        for as long. In the queue of what is quick one client has its share, and the rest is refused."""
        for path in ("problems", "lessons/1"):
            server = driver.Server()
            clients = [socket.create_connection(("127.0.0.1", server.port), timeout=60 * driver.SLOW) for _ in range(300)]
            server.ask("GET", "/healthz")
            server.process.send_signal(signal.SIGSTOP)
            for c in clients:
                c.sendall(f"GET /api/v1/{path} HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n".encode())
            server.process.send_signal(signal.SIGCONT)
            statuses = [c.recv(4096).split(b" ")[1] for c in clients]
            self.assertEqual(set(statuses), {b"200", b"429"}, path)
            for c in clients:
                c.close()
            self.assertEqual(server.stop(), 0)

    def test_a_crowd_that_connects_at_once_is_taken_in(self):
        """A full queue of new connections drops some, which try again after 1 s, 3 s, 7 s: none may be held up so."""
        server = driver.Server()
        with open("/proc/sys/net/core/somaxconn") as f:
            crowd = min(400, int(f.read()))  # the system's own bound
        server.process.send_signal(signal.SIGSTOP)  # nobody is accepted meanwhile
        clients = []
        for _ in range(crowd):
            c = socket.socket()
            c.setblocking(False)
            c.connect_ex(("127.0.0.1", server.port))
            clients.append(c)
        pending = set(clients)
        driver.until(lambda: not pending.difference_update(select.select([], list(pending), [], 0)[1]) and not pending, 10)
        server.process.send_signal(signal.SIGCONT)
        self.assertEqual(len(pending), 0)
        for c in clients:
            c.close()
        self.assertEqual(server.stop(), 0)

    def test_one_connection_serves_one_request_after_another(self):
        """Quick and long ones, refused ones, streams that end, bodies that nobody wants: none costs the client its connection."""
        server = driver.Server()
        run = {"scene": "pendulum", "method": "index1@rk4:h=1e-2"}
        connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=60 * driver.SLOW)
        connection.connect()
        first = connection.sock

        def ask(verb, path, body=None):
            connection.request(verb, path, json.dumps(body) if body is not None else None, {"Content-Type": "application/json"} if body is not None else {})
            answer = driver.Answer(connection.getresponse())
            self.assertNotIn("connection", answer.headers, (verb, path, answer.status))
            self.assertIs(connection.sock, first, (verb, path, answer.status))
            return answer

        for i in range(100):
            made = ask("POST", "/api/v1/runs", {**run, "time": 0.1 + 1e-6 * i})
            self.assertEqual(made.status, 201)
            at = made.json()["links"]["self"]
            self.assertEqual([ask("GET", at + end).status for end in ("", "/samples?fields=t", "/events?mode=live")], [200, 200, 200])
            self.assertEqual([ask("POST", path, {"scene": "pendulum"}).status for path in ("/api/v1/terms", "/api/v1/nothing", "/api/v1/runs?weit=1")], [200, 404, 400])
        self.assertEqual(ask("DELETE", at).status, 204)
        connection.close()
        self.assertEqual(server.stop(), 0)

    HOST = b"Host: 127.0.0.1\r\n"
    HOLDING = {  # what 1,400 sockets do that want nothing but their places
        "silent": b"",
        "half a head": b"GET / HTTP/1.1\r\n" + HOST + b"X-A: ",
        "half a body": b"POST /api/v1/runs HTTP/1.1\r\n" + HOST + b"Content-Type: application/json\r\nContent-Length: 9\r\n\r\n{",
        "kept alive": b"GET /healthz HTTP/1.1\r\n" + HOST + b"\r\n",
        "answer unread": b"GET /api/v1/openapi.json HTTP/1.1\r\n" + HOST + b"\r\n"}

    def hold(self, server, address, bytes_, n):
        """Opens n sockets that send these bytes and read nothing."""
        sockets = []
        for _ in range(n):
            s = socket.socket()
            s.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            s.settimeout(20 * driver.SLOW)
            s.bind((address, 0))
            s.connect(("127.0.0.1", server.port))
            s.setblocking(False)
            sockets.append(s)
            try:
                s.send(bytes_)
            except OSError:
                pass  # its place was given to another already
        return sockets

    def test_more_sockets_than_there_are_places_hold_up_nobody(self):
        resource.setrlimit(resource.RLIMIT_NOFILE, (resource.getrlimit(resource.RLIMIT_NOFILE)[1],) * 2)
        if resource.getrlimit(resource.RLIMIT_NOFILE)[0] < 3000:
            self.skipTest("the system allows fewer than 3000 open files")
        for address in ("127.0.0.1", "127.0.0.2"):
            for name, bytes_ in self.HOLDING.items():
                server = driver.Server()

                def attempt():
                    allowed, times = most_beside(server), []
                    sockets = self.hold(server, address, bytes_, 1400)
                    for _ in range(20):
                        answer, took = server.timed("GET", "/healthz")
                        self.assertEqual(answer.status, 200)
                        times.append(took)
                    for s in sockets:
                        s.close()
                    usual, longest = statistics.median(times), max(times)
                    return usual if longest < 3 * driver.SLOW else longest, allowed  # all waited for 10 s

                with self.subTest(name, address=address):
                    self.assert_within(attempt)
                self.assertEqual(server.stop(), 0)

    def test_a_connection_that_is_served_keeps_its_place(self):
        server = driver.Server("--max-connections", "20")
        events = driver.Events(server, server.compare(paused=False)["id"])
        events.take(1)
        sockets = self.hold(server, "127.0.0.1", b"", 60)
        self.assertEqual(server.ask("GET", "/healthz").status, 200)
        events.take(20)  # the stream goes on
        self.assertTrue(driver.until(lambda: sum(is_closed(s) for s in sockets) >= 40))
        for s in sockets:
            s.close()
        events.close()
        self.assertEqual(server.stop(), 0)

    def test_there_are_as_many_places_as_the_system_has_descriptors(self):
        hard = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
        program = ["bash", "-c", "ulimit -n 300 && exec \"$0\" \"$@\"", driver.PROGRAM]
        server = driver.Server(program=program)
        places = server.ask("GET", "/api/v1/").json()["limits"]["connections"]
        self.assertLess(places, 300)
        sockets = self.hold(server, "127.0.0.1", b"", 400) if hard >= 1000 else []
        self.assertEqual(server.ask("GET", "/healthz").status, 200)
        for s in sockets:
            s.close()
        self.assertEqual(server.stop(), 0)
        self.assertIn(f"300 open files, so the server takes {places} connections at once", "".join(server.errors))

    def test_a_head_that_never_ends_loses_its_place(self):
        server = driver.Server()
        idle, clients = server.idle(), []
        for _ in range(200):
            c = socket.create_connection(("127.0.0.1", server.port), timeout=10 * driver.SLOW)
            c.sendall(b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX-A: ")
            c.setblocking(False)
            clients.append(c)

        def is_gone(c):
            try:
                c.send(b"a")
                return c.recv(1) == b""
            except BlockingIOError:
                return False
            except OSError:
                return True

        # a byte from each now and then: the library alone would let them go on for ever
        times, alive, end = [], clients, time.monotonic() + 25 * driver.SLOW
        while alive and time.monotonic() < end:
            answer, took = server.timed("GET", "/healthz")
            self.assertEqual(answer.status, 200)
            times.append(took)
            alive = [c for c in alive if not is_gone(c)]
            time.sleep(0.5)
        self.assertEqual(len(alive), 0)
        self.assertLess(statistics.median(times), max(0.2 * driver.SLOW, 10 * idle))
        self.assertLess(max(times), 5 * driver.SLOW)  # those who were shut out had to wait for 30 s
        for c in clients:
            c.close()
        self.assertEqual(server.stop(), 0)


if __name__ == "__main__":
    driver.main()
