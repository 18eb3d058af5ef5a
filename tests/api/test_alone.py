# SPDX-License-Identifier: GPL-3.0-or-later
"""A program that was copied alone into an empty folder serves the page, the lessons and all else; files of the page that are added
while a server runs are served too."""

import gzip
import json
import os
import shutil
import subprocess
import tempfile
import unittest

import driver

PAGES = ["/api/v1/scenes", "/api/v1/scenes/four-bar", "/api/v1/lessons", "/api/v1/problems/p3", "/api/v1/scenes/pendulum/reference",
         "/api/v1/scenes/pendulum/export?language=python"]


def files_of(folder):
    """Addresses of the page's files."""
    for place, folders, files in os.walk(folder):
        folders[:] = [name for name in folders if name != "node_modules" and not name.startswith(".")]
        for name in files:
            if not name.startswith((".", "package")) and name != "README.md":
                yield "/" + os.path.relpath(os.path.join(place, name), folder)


class Alone(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.program = os.path.join(self.folder.name, "holonom")
        shutil.copy(driver.PROGRAM, self.program)

    def test_it_serves_what_a_checkout_serves(self):
        alone = driver.Server(program=self.program, folder=self.folder.name, environment={"HOLONOM_HOME": None})
        beside = driver.Server(environment={"HOLONOM_HOME": os.getcwd()})
        for path in PAGES:
            self.assertEqual(alone.ask("GET", path).body, beside.ask("GET", path).body, path)
        # the page as it was when the program was built
        for address in sorted(files_of("web")):
            plain = alone.ask("GET", address)
            zipped = alone.ask("GET", address, headers={"Accept-Encoding": "gzip"})
            text = gzip.decompress(zipped.body) if zipped.headers.get("content-encoding") == "gzip" else zipped.body
            with open("web" + address, "rb") as f:
                self.assertEqual((plain.status, plain.body, text), (200, f.read(), plain.body), address)
            self.assertEqual(plain.type, beside.ask("GET", address).type, address)
        again = alone.ask("GET", "/main.js", headers={"If-None-Match": alone.ask("GET", "/main.js").headers["etag"]})
        self.assertEqual((again.status, again.body), (304, b""))
        for address in ("/web/main.js", "/../lessons/README.md", "/package.json", "/README.md", "/nothing.js"):
            self.assertEqual(alone.ask("GET", address).status, 404, address)
        self.assertEqual((alone.stop(), beside.stop()), (0, 0))
        self.assertEqual(os.listdir(self.folder.name), ["holonom"], "it leaves nothing")

    def test_the_commands_need_nothing_else(self):
        environment = {k: v for k, v in os.environ.items() if k != "HOLONOM_HOME"}

        def call(*words):
            done = subprocess.run([self.program, *words], capture_output=True, cwd=self.folder.name, env=environment, timeout=120)
            self.assertEqual(done.returncode, 0, done.stderr.decode())
            return done.stdout.decode()

        self.assertIn("four-bar", call("list", "scenes"))
        self.assertEqual(json.loads(call("run", "four-bar", "--time", "0.1", "--json"))["status"], "ok")
        self.assertIn("import", call("export", "four-bar", "--language", "python"))

    def test_a_folder_that_is_named_counts_and_no_other(self):
        done = subprocess.run([self.program, "list", "scenes"], capture_output=True, env={**os.environ, "HOLONOM_HOME": self.folder.name})
        self.assertNotEqual(done.returncode, 0)
        self.assertIn(self.folder.name, done.stderr.decode())


class Later(unittest.TestCase):
    def test_a_file_that_is_added_while_it_runs_is_served(self):
        with tempfile.TemporaryDirectory() as home:
            for name in ("web", "lessons"):
                shutil.copytree(name, os.path.join(home, name), ignore=shutil.ignore_patterns("node_modules"))
            server = driver.Server(environment={"HOLONOM_HOME": home})
            self.assertEqual(server.ask("GET", "/later/new.js").status, 404)
            os.mkdir(os.path.join(home, "web", "later"))
            for name in ("new.js", ".hidden.js", "package.json"):
                with open(os.path.join(home, "web", "later", name), "w") as f:
                    f.write("1;\n")
            os.symlink("/etc/passwd", os.path.join(home, "web", "later", "link.txt"))
            os.symlink("/etc", os.path.join(home, "web", "link"))
            answer = server.ask("GET", "/later/new.js")
            self.assertEqual((answer.status, answer.type, answer.body), (200, "text/javascript", b"1;\n"))
            for address in ("/later/.hidden.js", "/later/package.json", "/later/link.txt", "/link/passwd", "/later", "/later/", "/later//new.js",
                            "/later/../../lessons/01-closed-loops/text.md", "/later/new.js/x"):
                self.assertEqual(server.ask("GET", address).status, 404, address)
            # and a changed one is another version
            with open(os.path.join(home, "web", "later", "new.js"), "w") as f:
                f.write("12;\n")
            changed = server.ask("GET", "/later/new.js", headers={"If-None-Match": answer.headers["etag"]})
            self.assertEqual((changed.status, changed.body), (200, b"12;\n"))
            self.assertEqual(server.stop(), 0)


if __name__ == "__main__":
    driver.main()
