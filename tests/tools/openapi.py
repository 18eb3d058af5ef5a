# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints the description of the API that a program serves: openapi.py PROGRAM."""

import json
import subprocess
import sys
import urllib.request

server = subprocess.Popen([sys.argv[1], "serve", "--port", "0", "--json"], stdout=subprocess.PIPE)
try:
    address = json.loads(server.stdout.readline())["address"]
    with urllib.request.urlopen(address + "/api/v1/openapi.json") as answer:
        sys.stdout.write(answer.read().decode())
finally:
    server.terminate()
    server.wait()
