# SPDX-License-Identifier: GPL-3.0-or-later
"""nginx in front, with the configuration of server/deploy, and the unit file for systemd as systemd reads it."""

import http.client
import json
import os
import re
import shutil
import socket
import subprocess
import tempfile
import time
import unittest
import urllib.parse

import driver

NGINX = shutil.which("nginx") or shutil.which("nginx", path="/usr/sbin")
NAME = "mechanisms.example.org"


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


@unittest.skipUnless(NGINX, "no nginx here")
class Proxy(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        os.chmod(self.folder.name, 0o755)
        self.server = driver.Server("--allow-host", NAME)
        self.port = free_port()
        with open("server/deploy/nginx.conf") as f:
            site = f.read().replace("listen 80;", f"listen 127.0.0.1:{self.port};").replace("127.0.0.1:8080", f"127.0.0.1:{self.server.port}")
        path, here = os.path.join(self.folder.name, "nginx.conf"), self.folder.name
        with open(path, "w") as f:
            f.write(f"daemon off; pid {here}/pid; error_log {here}/error.log; events {{ }} http {{ access_log off; "
                    + " ".join(f"{kind}_temp_path {here}/{kind};" for kind in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi"))
                    + "\n" + site + "\n}\n")
        self.nginx = subprocess.Popen([NGINX, "-c", path, "-p", here], stderr=subprocess.DEVNULL)
        self.addCleanup(self.stop)
        self.assertTrue(driver.until(self.is_up), "nginx does not listen")

    def stop(self):
        self.nginx.terminate()
        self.nginx.wait(timeout=30)
        self.assertEqual(self.server.stop(), 0, self.server.errors)

    def is_up(self):
        try:
            socket.create_connection(("127.0.0.1", self.port), timeout=5).close()
            return True
        except OSError:
            return False

    def ask(self, method, path, body=None, headers=()):
        c = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        c.request(method, path, json.dumps(body) if body else None, {"Host": NAME, "Content-Type": "application/json", **dict(headers)})
        answer = driver.Answer(c.getresponse())
        c.close()
        return answer

    def test_page_and_api_pass_at_the_root_and_the_api_below_a_prefix(self):
        self.assertEqual(self.ask("GET", "/").type, "text/html")
        for prefix in ("", "/mechanisms"):
            self.assertEqual(self.ask("GET", prefix + "/api/v1/scenes/four-bar").status, 200)
            run = self.ask("POST", prefix + "/api/v1/runs", {"scene": "pendulum", "method": "index1@rk4:h=1e-2", "time": 0.1})
            self.assertIn(run.status, (200, 201))
            self.assertEqual(self.ask("GET", prefix + run.headers["location"]).json()["id"], run.json()["id"])

    def text_of(self, path):
        answer = self.ask("GET", path)
        self.assertEqual(answer.status, 200, path)
        return answer.type, answer.body.decode(errors="replace")

    def test_every_file_that_the_page_names_is_found_below_a_prefix(self):
        """Styles, scripts with what they import, and pictures: followed from the page on, as a browser would."""
        start = "/mechanisms/"
        seen, ahead = set(), [start]
        while ahead:
            path = ahead.pop()
            seen.add(path)
            media, text = self.text_of(path)
            if media == "text/html":
                named = re.findall(r'<(?:link|script|img|source)\b[^>]*?\b(?:href|src)="([^"#?]+)', text)
            elif media == "text/css":
                named = re.findall(r"""url\(["']?([^"')#?]+)""", text)
            elif "javascript" in media:
                named = re.findall(r"""(?:\bfrom|\bimport)\s*\(?\s*["'](\.{1,2}/[^"']+)["']""", text)
            else:
                named = []
            for name in named:
                # of each font a browser takes the first form, woff2; the others are not shipped
                if not re.match(r"(?:data|https?):", name) and not name.endswith((".ttf", ".woff")):
                    address = urllib.parse.urljoin(path, name)
                    self.assertTrue(address.startswith(start), f"{path} names '{name}', which is outside the prefix")
                    if address not in seen and address not in ahead:
                        ahead.append(address)
        kinds = {os.path.splitext(path)[1] for path in seen}
        self.assertLessEqual({".js", ".css", ".svg"}, kinds)
        self.assertGreater(len(seen), 50)

    def test_a_stream_passes_frame_by_frame(self):
        for prefix in ("", "/mechanisms"):
            made = self.ask("POST", prefix + "/api/v1/comparisons", {"scene": "four-bar", "methods": ["projection@rk4:h=1e-2"]}).json()
            c = http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
            c.request("GET", prefix + made["links"]["events"], headers={"Host": NAME})
            stream = c.getresponse()
            self.assertEqual(stream.status, 200)

            def next_frame():
                while not (line := stream.readline()).startswith(b"event: frame"):
                    self.assertTrue(line, "the stream ended")
                return json.loads(stream.readline().removeprefix(b"data: "))["frame"]

            # a paused comparison makes one frame when it is told to; a proxy that buffers would hold it back for ever
            self.assertEqual(next_frame(), 0)
            for k in (1, 2, 3):
                self.assertEqual(self.ask("PATCH", prefix + made["links"]["self"], {"step": 1}).status, 200)
                self.assertEqual(next_frame(), k)
                time.sleep(0.1)
            c.close()

    def test_the_origin_of_a_page_has_the_port_of_the_proxy(self):
        """The proxy dropped the port from the Host header, so that the page's own requests came from elsewhere."""
        own, body = f"{NAME}:{self.port}", {"scene": "four-bar", "methods": ["projection@rk4:h=1e-2"]}
        for prefix in ("", "/mechanisms"):
            for origin, status in ((f"http://{own}", 201), (f"http://{NAME}:{self.port + 1}", 403), (f"http://{NAME}", 403)):
                answer = self.ask("POST", prefix + "/api/v1/comparisons", body, {"Host": own, "Origin": origin})
                self.assertEqual(answer.status, status, (prefix, origin, answer.body[:300]))

    def test_a_body_that_is_too_large_is_refused_by_the_server(self):
        answer = self.ask("POST", "/api/v1/runs", {"scene": "x" * (1 << 20)})
        self.assertEqual((answer.status, answer.type), (413, "application/problem+json"))

    def test_another_name_is_refused(self):
        c = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        c.request("GET", "/api/v1/", headers={"Host": "evil.example"})
        self.assertEqual(c.getresponse().status, 421)
        c.close()


class Unit(unittest.TestCase):
    @unittest.skipUnless(shutil.which("systemd-analyze"), "no systemd here")
    def test_systemd_understands_the_unit_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "holonom.service")
            with open("server/deploy/holonom.service") as f:
                text = f.read()
            # the program stands where it was built
            with open(path, "w") as f:
                f.write(re.sub(r"ExecStart=\S+", "ExecStart=" + os.path.abspath(driver.PROGRAM), text))
            done = subprocess.run(["systemd-analyze", "verify", "--man=no", path], capture_output=True, text=True)
            told = [line for line in (done.stdout + done.stderr).splitlines() if "holonom" in line]
            self.assertEqual((done.returncode, told), (0, []), done.stderr)

    def test_its_options_are_those_of_the_program(self):
        with open("server/deploy/holonom.service") as f:
            words = re.search(r"ExecStart=\S+ (.*)", f.read()).group(1).split()
        with tempfile.TemporaryDirectory() as folder:
            # the driver chooses the port
            self.assertEqual(words[0], "serve")
            at = words.index("--port")
            server = driver.Server(*(folder if word.startswith("/var") else word for word in words[1:at] + words[at + 2 :]))
            self.assertEqual((server.ask("GET", "/healthz").status, server.stop()), (200, 0))


if __name__ == "__main__":
    driver.main()
