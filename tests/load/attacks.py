# SPDX-License-Identifier: GPL-3.0-or-later
"""What a hostile client does, and what another one notices, as a table: attacks.py PROGRAM [WORD...].

Each attack has a server of its own. Beside it a client from another address asks for healthz again and again, each time on a new
connection. WORDs choose the attacks whose names hold one of them. Exit status 1 where healthz took longer than its bound, 0.2 s at the
95th percentile, where an answer was not what it should be, or where the server did not end within 3 s and with 0.
The bounds are for a machine that does nothing else."""

import http.client
import json
import os
import resource
import signal
import socket
import statistics
import sys
import threading
import time

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402
from beside import RING, RK4, many_members  # noqa: E402
from test_sockets import ManySockets  # noqa: E402

BOUND = 0.2  # [s]
LONG = {**RING, "method": "projection@rk4:h=1e-5"}
JSON = {"Content-Type": "application/json"}


def post(server, path, body, timeout=120, method="POST"):
    return server.ask(method, "/api/v1/" + path, body, JSON, timeout=timeout)


def statuses(answers):
    """"3 x 422, 1 x 429" of a list of answers; none: the connection broke, or time was up."""
    seen = [a.status if a else "none" for a in answers]
    return ", ".join(f"{seen.count(s)} x {s}" for s in sorted(set(seen), key=str))


def at_once(n, ask):
    """Calls ask(i) on n threads; what they returned, None where a connection broke."""
    answers = [None] * n

    def run(i):
        try:
            answers[i] = ask(i)
        except (OSError, http.client.HTTPException):
            pass

    threads = [threading.Thread(target=run, args=(i,)) for i in range(n)]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    return answers


# ---- attacks: each returns what happened, and whether that is as it should be ----

def members_of_a_patch(server):
    c = server.compare()
    answer = post(server, "comparisons/" + c["id"], many_members('"speed":1'), method="PATCH")
    return f"{answer.status}", answer.status == 422


def members_of_bodies(server):
    answers = at_once(3, lambda i: post(server, "terms", many_members('"t":1', 0, 80000)))
    return statuses(answers), all(a.status == 422 for a in answers)


def equal_times(server):
    answers = at_once(3, lambda i: post(server, "runs", {"scene": "four-bar", "method": RK4, "time": 1, "at": [0.55] * (60000 - i), "reactions": True}))
    return statuses(answers), all(a.status in (201, 202, 422) for a in answers)


def long_formulas(server):
    with open("lessons/11-cabinet/scenes/ring.json") as f:
        scene = json.load(f)
    long = "+".join(["sin(th_0)*cos(th_0)"] * 1000)
    scene["draw"] = {"points": {f"p{k} {{i}}": {"for": {"i": [1, 4999]}, "body": "link 1", "at": [long, long]} for k in range(2)}}
    answer = post(server, "assemble", {"scene": scene})
    return f"{answer.status}, peak {peak(server)} MB", answer.status == 422 and peak(server) < 300


def peak(server):
    with open(f"/proc/{server.process.pid}/status") as f:
        return next(int(line.split()[1]) for line in f if line.startswith("VmHWM")) // 1024


def large_rings(server):
    answers = at_once(4, lambda i: post(server, "inspect", {"scene": "ring", "parameters": {"n": 90 + i}}))
    return statuses(answers) + f", peak {peak(server)} MB", all(a.status in (200, 422) for a in answers)


def long_runs(server):
    answers = [post(server, "runs?wait=0", {**LONG, "time": 1000 + i}) for i in range(20)]
    start = time.monotonic()
    c = http.client.HTTPConnection("127.0.0.1", server.port, timeout=60, source_address=("127.0.0.3", 0))
    c.request("POST", "/api/v1/runs", json.dumps({"scene": "four-bar", "method": RK4, "time": 0.02}), JSON)
    other = c.getresponse()
    other.read()
    took = time.monotonic() - start
    return f"{statuses(answers)}; another's of 20 ms after {took:.2f} s", other.status == 201 and took < 2


def long_requests(server):
    answers = at_once(40, lambda i: post(server, "snapshots", {**RING, "methods": [LONG["method"]], "time": 1000 + i}, timeout=4))
    return f"{sum(a is not None for a in answers)} of 40 answered in 4 s, {statuses([a for a in answers if a])}", True


def a_tiny_step(server):
    c = server.compare(methods=["index1@rk4:h=1e-9"] * 3, paused=False)
    time.sleep(1)
    answer, took = server.timed("PATCH", "/api/v1/comparisons/" + c["id"], {"methods": ["index1@rk4:h=1e-2"]})
    return f"the change acts after {took:.2f} s", answer.status == 200 and took < 0.3


def slow_readers(server):
    c = server.compare(paused=False, duration=600)
    sockets = []
    for _ in range(200):
        s = socket.create_connection(("127.0.0.1", server.port), timeout=10)
        s.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
        s.sendall(f"GET /api/v1/comparisons/{c['id']}/events HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
        sockets.append(s)
    end = time.monotonic() + 5
    while time.monotonic() < end:
        for s in sockets:
            s.recv(1)
        time.sleep(0.5)
    served = sum(s.recv(3, socket.MSG_PEEK) != b"" for s in sockets)
    for s in sockets:
        s.close()
    return f"{served} of 200 streams go on", served == 200


def idle_sockets(name):
    def attack(server):
        sockets = ManySockets("hold").hold(server, "127.0.0.1", ManySockets.HOLDING[name], 1400)
        time.sleep(3)
        for s in sockets:
            s.close()
        return "", True

    return attack


def slow_heads(server):
    sockets = ManySockets("hold").hold(server, "127.0.0.1", ManySockets.HOLDING["half a head"], 256)
    end, closed = time.monotonic() + 15, set()
    while time.monotonic() < end and len(closed) < 256:
        for s in sockets:
            try:
                s.send(b"a")
            except BlockingIOError:
                pass
            except OSError:
                closed.add(s)
        time.sleep(0.5)
    for s in sockets:
        s.close()
    return f"{len(closed)} of 256 closed after 15 s", len(closed) == 256


def unread_answers(server):
    run = post(server, "runs", {"scene": "four-bar", "method": RK4, "time": 30, "every": 1e-3}).json()
    request = f"GET /api/v1/runs/{run['id']}/samples HTTP/1.1\r\nHost: localhost\r\n\r\n".encode()
    sockets = ManySockets("hold").hold(server, "127.0.0.1", request, 60)
    time.sleep(3)
    figure = peak(server)
    for s in sockets:
        s.close()
    return f"peak {figure} MB", figure < 900


def large_pictures(server):
    picture = {"scene": "stewart-6-6", "methods": ["projection@rk4:h=1e-3"], "time": 0.1, "width": 4096, "height": 4096}
    answers = at_once(3, lambda i: post(server, "snapshots", {**picture, "width": 4096 - i}))
    return statuses(answers) + f", peak {peak(server)} MB", all(a.status == 200 for a in answers)


def computing_from_another_site(server):
    answers = [server.ask("GET", "/api/v1/scenes/seven-body-squeezer/reference?compute=true&time=30", headers={"Sec-Fetch-Site": "cross-site"})
               for _ in range(35)]
    return statuses(answers), all(a.status == 403 for a in answers)


def references(server):
    answers = at_once(5, lambda i: server.ask("GET", f"/api/v1/scenes/seven-body-squeezer/reference?compute=true&time={30 + i}", timeout=600))
    return statuses(answers), all(a and a.status in (200, 422) for a in answers)


def chains(server):
    def scene(n):
        bodies = [{"name": f"b{i}", "mass": 1, "com": [0, -1, 0]} for i in range(n)]
        joints = [{"name": f"j{i}", "type": "revolute", "parent": {"body": f"b{i - 1}" if i else "ground"}, "child": {"body": f"b{i}", "at": [0, 1]},
                   "coordinate": f"q{i}", "rate": f"w{i}"} for i in range(n)]
        return {"holonom": 1, "name": "chain", "bodies": bodies, "joints": joints, "gravity": [0, -9.81, 0]}

    answers = [post(server, "assemble", {"scene": scene(n)}) for n in (200, 300, 350, 1000, 2000)]
    return statuses(answers), all(a.status in (200, 422) for a in answers)


def nested_xml(server):
    defaults = "".join(f'<default class="c{i}">' + "<geom/>" * 1 for i in range(90)) + "</default>" * 90
    geoms = "".join('<geom type="sphere" size="1"/>' for _ in range(1500))
    text = f"<mujoco><default>{defaults}</default><worldbody><body>{geoms}</body></worldbody></mujoco>"
    bomb = '<!DOCTYPE a [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;">]><mujoco>&b;</mujoco>'
    answers = [post(server, "import", {"text": t}) for t in (text, bomb, "<a>" * 100000)]
    return statuses(answers), all(a.status in (200, 422) for a in answers)


def extreme_numbers(server):
    bad = 0
    for x in ("0", "-0", "5e-324", "1e-308", "1e308", "-1e308", "1.7976931348623157e308", "1e-20"):
        for body in ('{"scene":"four-bar","parameters":{"l1":X}}', '{"scene":"four-bar","state":{"th1":X}}', '{"scene":"four-bar","state":{"w1":X}}',
                     '{"scene":"four-bar","t":X}'):
            answer = post(server, "terms", body.replace("X", x))
            answer.json()  # refuses NaN and Infinity
            bad += answer.status >= 500
        for body in ('{"scene":"four-bar","method":"index1@rk4:h=X","time":0.01}', '{"scene":"four-bar","method":"ggl@radau5:rtol=X","time":0.01}',
                     '{"scene":"four-bar","method":"index1@rk4:h=1e-3","time":X}', '{"scene":"four-bar","method":"index1@rk4:h=1e-3","time":1,"every":X}'):
            answer = post(server, "runs?wait=1", body.replace("X", x))
            answer.json()
            bad += answer.status >= 500
    return f"64 requests, {bad} x 5xx, no NaN", bad == 0


def broken_heads(server):
    from test_malformed import RAW

    for data in RAW:
        server.raw(data, timeout=0.3)
    return f"{len(RAW)} heads", True


ATTACKS = [
    ("PATCH of 90,000 members", members_of_a_patch),
    ("3 bodies of 80,000 equal members", members_of_bodies),
    ("3 runs with 60,000 equal times", equal_times),
    ("a scene of 190 MB of formulas", long_formulas),
    ("4 rings of 90 links and more", large_rings),
    ("20 long runs of one client", long_runs),
    ("40 long pictures at once", long_requests),
    ("a step of 1e-9 s, then a change", a_tiny_step),
    ("200 readers of a few bytes a second", slow_readers),
    *((f"1,400 sockets: {name}", idle_sockets(name)) for name in ManySockets.HOLDING),
    ("256 heads, a byte each half second", slow_heads),
    ("60 answers of 10 MB that nobody reads", unread_answers),
    ("3 pictures of 4096 x 4096", large_pictures),
    ("35 references for another site", computing_from_another_site),
    ("5 references of 30 s", references),
    ("chains of 200 to 2,000 bodies", chains),
    ("XML: classes, entities, depth", nested_xml),
    ("numbers from 5e-324 to 1.8e308", extreme_numbers),
    ("heads that are not HTTP", broken_heads),
]


def beside(server, attack):
    """What the attack returned, and how long healthz took meanwhile [s]."""
    result, times = [], []
    thread = threading.Thread(target=lambda: result.append(attack(server)))
    thread.start()
    while thread.is_alive() or not times:
        start = time.monotonic()
        c = http.client.HTTPConnection("127.0.0.1", server.port, timeout=60, source_address=("127.0.0.9", 0))
        c.request("GET", "/healthz")
        assert c.getresponse().status == 200
        c.close()
        times.append(time.monotonic() - start)
        time.sleep(0.02)
    return (result or [("the attack itself failed", False)])[0], times


def main():
    program, words = sys.argv[1], sys.argv[2:]
    resource.setrlimit(resource.RLIMIT_NOFILE, (resource.getrlimit(resource.RLIMIT_NOFILE)[1],) * 2)
    good = True
    print(f"healthz beside each attack; bound {BOUND} s at the 95th percentile; load of the machine before: {os.getloadavg()[0]:.1f}\n")
    print(f"{'attack':38} {'median':>9} {'95 %':>9} {'longest':>9} {'to end':>7}  outcome")
    for name, attack in ATTACKS:
        if words and not any(w in name for w in words):
            continue
        server = driver.Server(program=program)
        (outcome, right), times = beside(server, attack)
        start = time.monotonic()
        ended = server.stop(signal.SIGTERM)
        took = time.monotonic() - start
        late = sorted(times)[min(len(times) - 1, int(0.95 * len(times)))]
        ok = right and late <= BOUND and ended == 0 and took < 3
        good &= ok
        print(f"{name:38} {1e3 * statistics.median(times):6.1f} ms {1e3 * late:6.1f} ms {1e3 * max(times):6.1f} ms {took:5.2f} s  "
              f"{outcome}{'' if ok else '  BEYOND'}", flush=True)
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
