# SPDX-License-Identifier: GPL-3.0-or-later
"""Who is let in by the name of the host, and how the server is told to end."""

import signal
import unittest

import driver


class Doors(unittest.TestCase):
    """Options of the server itself."""

    def test_a_name_that_was_allowed_is_served(self):
        server = driver.Server("--allow-host", "bench.example")
        self.assertEqual(server.ask("GET", "/healthz", headers={"Host": "bench.example:1"}).status, 200)
        self.assertEqual(server.ask("GET", "/healthz", headers={"Host": "other.example"}).status, 421)
        self.assertEqual(server.stop(), 0)

    def test_either_signal_ends_it_cleanly(self):
        for how in (signal.SIGINT, signal.SIGTERM):
            server = driver.Server()
            server.compare(paused=False)
            self.assertEqual(server.stop(how), 0, "".join(server.errors))


if __name__ == "__main__":
    driver.main()
