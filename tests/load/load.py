# SPDX-License-Identifier: GPL-3.0-or-later
"""A class and a script at one server, as a table: load.py PROGRAM [--seconds S] [--runs N] [PART...].

streams   300 readers of one comparison at 30 frames a second; then 700 more that read a byte a second: the 300 do not notice
browsers  30 that open a comparison, change its step, play, and leave, again and again: nobody is refused, the memory comes back
runs      N questions asked twice, with a kill -9 in the middle of each round: the second time none is computed, no id is lost or wrong
Exit status 1 where a figure is beyond its bound. The bounds are for a machine that does nothing else."""

import argparse
import concurrent.futures
import http.client
import json
import os
import selectors
import signal
import socket
import statistics
import sys
import tempfile
import threading
import time

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402

METHODS = ["index1@rk4:h=1e-2", "baumgarte@rk4:h=1e-2", "projection@rk4:h=1e-2", "nullspace@rk4:h=1e-2", "reduced@rk4:h=1e-2"]


def memory(server):
    """Resident memory [MB]."""
    with open(f"/proc/{server.process.pid}/status") as f:
        return next(int(line.split()[1]) for line in f if line.startswith("VmRSS")) / 1024


def row(what, figure, bound, good):
    print(f"{what:58} {figure:>16}   {bound:16} {'ok' if good else 'BEYOND'}", flush=True)
    return good


# ---- streams ----

def open_stream(server, comparison):
    s = socket.create_connection(("127.0.0.1", server.port), timeout=30)
    s.sendall(f"GET /api/v1/comparisons/{comparison}/events?mode=live HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n".encode())
    return s


def read_streams(sockets, seconds, slow=()):
    """Gaps between frames of each reader [s], and how many streams ended; slow ones give up a byte each second."""
    chooser, last, gaps, ended, frames, buffer = selectors.DefaultSelector(), {}, [], 0, 0, bytearray(1 << 18)
    for s in sockets:
        s.setblocking(False)
        chooser.register(s, selectors.EVENT_READ)
    end, sip = time.monotonic() + seconds, time.monotonic()
    while time.monotonic() < end:
        for key, _ in chooser.select(0.05):
            s = key.fileobj
            try:
                size = s.recv_into(buffer)
            except BlockingIOError:
                continue
            if size == 0:
                ended += 1
                chooser.unregister(s)
                continue
            n = buffer.count(b"event: frame", 0, size)
            if n:
                now = time.monotonic()
                if s in last:
                    gaps.append(now - last[s])
                last[s] = now
                frames += n
        if slow and time.monotonic() > sip + 1:
            sip = time.monotonic()
            for s in slow:
                try:
                    s.recv(1)
                except BlockingIOError:
                    pass
    return gaps, ended, frames


def part_streams(program, seconds, _):
    server = driver.Server("--max-streams", "1100", "--max-connections", "1200", program=program)
    c = server.compare(methods=METHODS, duration=3600, frame_dt=1 / 30)
    sockets = [open_stream(server, c["id"]) for _ in range(300)]
    server.ask("PATCH", "/api/v1/comparisons/" + c["id"], {"state": "running"})
    read_streams(sockets, 3)
    before = memory(server)
    gaps, ended, frames = read_streams(sockets, seconds)
    after = memory(server)
    p99 = statistics.quantiles(gaps, n=100)[98]
    good = row("300 streams: gap between frames, 99th percentile", f"{1e3 * p99:.0f} ms", "at most 100 ms", p99 <= 0.1)
    good &= row("300 streams: longest gap", f"{1e3 * max(gaps):.0f} ms", "", True)
    good &= row("300 streams: frames a second and reader", f"{frames / 300 / seconds:.1f}", "30", frames / 300 / seconds > 29)
    good &= row("300 streams: ended early", str(ended), "0", ended == 0)
    good &= row("300 streams: memory before and after", f"{before:.0f}, {after:.0f} MB", "history fills", after < before + 120)

    slow = [open_stream(server, c["id"]) for _ in range(700)]
    for s in slow:
        s.setblocking(False)
    gaps, ended, _ = read_streams(sockets, seconds / 2, slow)
    p99 = statistics.quantiles(gaps, n=100)[98]
    good &= row("beside 700 that read a byte a second: 99th percentile", f"{1e3 * p99:.0f} ms", "at most 100 ms", p99 <= 0.1)
    good &= row("beside 700: ended early", str(ended), "0", ended == 0)
    for s in sockets + slow:
        s.close()
    return good & (server.stop() == 0)


# ---- browsers ----

def browse(server, until, refused, visits, changes, steps):
    """Opens a comparison, reads, changes the step, plays, steps, leaves."""
    k = 0
    while time.monotonic() < until:
        made, took = server.timed("POST", "/api/v1/comparisons", {"scene": "four-bar", "methods": METHODS})
        if made.status != 201:
            refused.append(made.status)
            time.sleep(0.5)
            continue
        address, events = "/api/v1/comparisons/" + made.json()["id"], driver.Events(server, made.json()["id"], query="?mode=live")
        events.take(2)
        for body in ({"state": "running"}, {"methods": [m.replace("1e-2", f"{2 ** -(k % 5) / 50:g}") for m in METHODS]},
                     {"state": "paused"}, {"reset": True}, {"step": 100}, {"state": "running"}):
            answer, one = server.timed("PATCH", address, body)
            (steps if "step" in body else changes).append(one)
            if answer.status != 200:
                refused.append(answer.status)
            time.sleep(0.1)
        events.close()  # without a goodbye, as a tab that is closed
        visits.append(took)
        k += 1


def part_browsers(program, seconds, _):
    server = driver.Server("--expiry", "20", program=program)
    browse(server, time.monotonic() + 2, [], [], [], [])
    time.sleep(1)
    before, refused, visits, changes, steps = memory(server), [], [], [], []
    until = time.monotonic() + seconds
    threads = [threading.Thread(target=browse, args=(server, until, refused, visits, changes, steps)) for _ in range(30)]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    good = row(f"30 browsers for {seconds:.0f} s: comparisons opened", str(len(visits)), "", True)
    good &= row("30 browsers: refused", str(len(refused)), "0", not refused)
    good &= row("30 browsers: until a change is in force, median", f"{1e3 * statistics.median(changes):.0f} ms", "at most 300 ms", statistics.median(changes) <= 0.3)
    good &= row("30 browsers: until a change is in force, 99th percentile", f"{1e3 * statistics.quantiles(changes, n=100)[98]:.0f} ms", "", True)
    good &= row("30 browsers: 100 frames at once, 99th percentile", f"{1e3 * statistics.quantiles(steps, n=100)[98]:.0f} ms", "", True)
    row("30 browsers: memory at the end", f"{memory(server):.0f} MB", "", True)
    driver.until(lambda: not server.ask("GET", "/api/v1/comparisons").json()["comparisons"], 90, 1)
    time.sleep(2)
    after = memory(server)
    good &= row("30 browsers: memory before, and when all have gone", f"{before:.0f}, {after:.0f} MB", "within 60 MB", after < before + 60)
    return good & (server.stop() == 0)


# ---- runs ----

def ask_all(server, questions, answers, states):
    """Every question by eight hands, until the server goes away: ids and hashes of samples by question, and how each was answered."""
    def ask(part):
        connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=60)
        for k in part:
            try:
                while True:
                    connection.request("POST", "/api/v1/runs", json.dumps(questions[k]), {"Content-Type": "application/json"})
                    answer = driver.Answer(connection.getresponse())
                    if answer.status != 429:
                        break
                    time.sleep(0.05)
            except (OSError, http.client.HTTPException):
                return
            document = answer.json()
            states.append(answer.status)
            answers.setdefault(k, set()).add((document["id"], hash(json.dumps(document["samples"]))))

    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        list(pool.map(ask, [range(i, len(questions), 8) for i in range(8)]))


def part_runs(program, _, n):
    questions = [{"scene": "four-bar", "method": "projection@rk4:h=1e-2", "time": 0.1, "every": 0.05, "parameters": {"l1": 0.4 + k / 100000}}
                 for k in range(n)]
    answers, good = {}, True
    with tempfile.TemporaryDirectory() as folder:
        # the answers that eight hands wait for when the server is killed may have been kept: they are not computed again
        for round_ in (1, 2):
            states, start = [], time.monotonic()
            for part in (1, 2):  # killed in the middle, then to the end
                server = driver.Server("--runs", folder, program=program)
                if part == 1:
                    killer = threading.Timer(2 if round_ == 1 else 1, server.process.send_signal, (signal.SIGKILL,))
                    killer.start()
                ask_all(server, questions, answers, states)
                if part == 1:
                    killer.join()
                    server.process.wait()
                else:
                    good &= server.stop() == 0
            took, computed = time.monotonic() - start, states.count(201)
            bad = [s for s in states if s not in (200, 201)]
            good &= row(f"{n:,} runs, round {round_}: computed, in {took:.0f} s", f"{computed:,}", f"{n - 8:,} to {n:,}" if round_ == 1 else "0",
                        (n - 8 <= computed <= n if round_ == 1 else computed == 0) and not bad)
        good &= row("answers to one question that differ in id or samples", str(sum(len(a) != 1 for a in answers.values())), "0",
                    all(len(a) == 1 for a in answers.values()))
        good &= row("ids in all, files kept", f"{len({i for a in answers.values() for i, _ in a}):,}, {len(os.listdir(folder)):,}", f"{n:,}",
                    len(os.listdir(folder)) == n == len(answers))
    return good


PARTS = {"streams": part_streams, "browsers": part_browsers, "runs": part_runs}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--runs", type=int, default=10000)
    parser.add_argument("parts", nargs="*", default=[], metavar="PART", help=", ".join(PARTS))
    options = parser.parse_intermixed_args()
    good = [PARTS[name](options.program, options.seconds, options.runs) for name in options.parts or PARTS]
    sys.exit(0 if all(good) else 1)


main()
