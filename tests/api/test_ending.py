# SPDX-License-Identifier: GPL-3.0-or-later
"""How the server ends while clients go on asking: cleanly, and each of them is told."""

import http.client
import os
import signal
import socket
import subprocess
import tempfile
import threading
import time
import unittest

import driver

# What takes a listening socket out of an event loop waits first where the main thread asks for it: any event loop that wakes
# meanwhile comes before it.
LATE = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

int epoll_ctl(int epoll, int op, int fd, struct epoll_event *event) {
    int (*next)(int, int, int, struct epoll_event *) = (int (*)(int, int, int, struct epoll_event *))dlsym(RTLD_NEXT, "epoll_ctl");
    int listens = 0;
    socklen_t size = sizeof listens;
    if (op == EPOLL_CTL_DEL && gettid() == getpid() && getsockopt(fd, SOL_SOCKET, SO_ACCEPTCONN, &listens, &size) == 0 && listens) {
        nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
    }
    return next(epoll, op, fd, event);
}
"""


class Ending(unittest.TestCase):
    def status_on(self, connection):
        """The status of healthz on that connection; None when it gets no answer."""
        try:
            connection.request("GET", "/healthz")
            answer = connection.getresponse()
            answer.read()
            return answer.status
        except (OSError, http.client.HTTPException):
            return None

    def ask_on(self, server, is_over, statuses):
        """Asks again and again on one connection, and on another when it is closed."""
        while not is_over.is_set():
            connection = server.connect()
            while not is_over.is_set():
                statuses.append(self.status_on(connection))
                if statuses[-1] is None:
                    break
            connection.close()

    def stop_beside(self, server, n):
        """Stops the server while n clients ask; what they were answered."""
        is_over, statuses = threading.Event(), []
        threads = [threading.Thread(target=self.ask_on, args=(server, is_over, statuses)) for _ in range(n)]
        for t in threads:
            t.start()
        driver.until(lambda: len(statuses) > 10 * n)
        status = server.stop()
        is_over.set()
        for t in threads:
            t.join()
        self.assertEqual(status, 0, "".join(server.errors))
        return set(statuses)

    def test_an_event_loop_that_wakes_while_the_server_ends(self):
        """The HTTP library aborted the program: the loop and the end of the server both gave up the listening socket."""
        with tempfile.TemporaryDirectory() as folder:
            late = os.path.join(folder, "late.so")
            subprocess.run(["gcc", "-O1", "-Wall", "-Werror", "-shared", "-fPIC", "-x", "c", "-", "-o", late], input=LATE.encode(), check=True)
            preload = {"LD_PRELOAD": late, "ASAN_OPTIONS": os.environ.get("ASAN_OPTIONS", "") + ":verify_asan_link_order=0"}
            for _ in range(3):
                answered = self.stop_beside(driver.Server(environment=preload), 4)
                self.assertLessEqual(answered, {200, 503, None})

    def test_who_comes_while_the_server_ends_is_told_so(self):
        """A request that stops half-way keeps the server for a moment; whoever connects then waited until it was gone."""
        told = []
        for _ in range(driver.TRIES):
            server = driver.Server()
            half = socket.create_connection(("127.0.0.1", server.port))
            half.sendall(b"POST /api/v1/terms HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\nContent-Length: 99\r\n\r\n{")
            known = server.connect()
            server.process.send_signal(signal.SIGTERM)
            driver.until(lambda: self.status_on(known) != 200, every=0.01)
            time.sleep(0.05)
            told.append(self.status_on(server.connect()))
            half.close()
            server.process.wait(timeout=30 * driver.SLOW)
            self.assertEqual(server.stop(), 0, "".join(server.errors))
            if 503 in told:
                break
        self.assertIn(503, told)


if __name__ == "__main__":
    driver.main()
