# SPDX-License-Identifier: GPL-3.0-or-later
"""Comparisons and their event streams: order, resuming, gaps, ends, readers that are slow or go away."""

import json
import select
import threading
import time
import unittest

import driver
from driver import Events

METHODS = ["index1@rk4:h=1e-3", "projection@rk4:h=1e-3"]


def frames(events):
    return [data for name, _, data in events if name == "frame"]


class Streams(driver.ServerCase):
    options = ("--keep-alive", "0.5")

    def patch(self, ident, status=200, **body):
        answer = self.server.ask("PATCH", "/api/v1/comparisons/" + ident, body)
        self.assertEqual(answer.status, status, answer.body[:400])
        return answer.json()

    def test_frames_come_in_order_from_the_first_to_the_end(self):
        c = self.server.compare(methods=METHODS, duration=0.5, speed=20, paused=False)
        reader = Events(self.server, c["id"])
        seen = [e for e in reader.until("end") if e[0] != "comment"]
        self.assertEqual(seen[0][0], "hello")
        self.assertEqual(seen[0][2]["description"]["id"], c["id"])
        self.assertEqual([i for _, i, _ in seen[1:]], list(range(1, len(seen))))
        numbers = [f["frame"] for f in frames(seen)]
        self.assertEqual(numbers, list(range(len(numbers))))
        self.assertAlmostEqual(frames(seen)[-1]["t"], 0.5, delta=c["frame_dt"])
        self.assertTrue(all(len(f["methods"]) == 2 and f["generation"] == 0 for f in frames(seen)))
        self.assertEqual(len(seen[-1][2]["summary"]["methods"]), 2)
        # the server closes after the end
        self.assertEqual([e for e in reader if e[0] != "comment"], [])

    def test_a_comparison_whose_readers_have_left_computes_for_nobody(self):
        c = self.server.compare(methods=METHODS, duration=3600, paused=False)
        reader = Events(self.server, c["id"])
        reader.take(5)
        reader.close()
        left = time.monotonic()
        time.sleep(8)
        now = self.server.ask("GET", "/api/v1/comparisons/" + c["id"]).json()
        # as far as 2 s behind the last reader, who is missed within 1 s; the rest is for a busy machine
        self.assertEqual(now["state"], "running")
        self.assertLess(now["frame"] * c["frame_dt"], (time.monotonic() - left) - 2)
        # it goes on when somebody is back, from where it stood
        back = Events(self.server, c["id"], last_id=now["last_event"])
        self.assertEqual([f["frame"] for f in frames(back.take(20))][:3], [now["frame"] + k for k in (1, 2, 3)])
        back.close()
        self.assertEqual(self.server.ask("DELETE", "/api/v1/comparisons/" + c["id"]).status, 204)

    def test_frames_of_a_stream_are_the_frames_of_a_run(self):
        c = self.server.compare(methods=METHODS[:1], duration=0.2, speed=50, paused=False)
        last = frames(Events(self.server, c["id"]).until("end"))[-1]
        run = self.server.ask("POST", "/api/v1/runs", {"scene": "four-bar", "method": METHODS[0], "time": last["t"],
                                                       "at": [last["t"]]}).json()
        for a, b in zip(last["methods"][0]["q"], run["samples"]["q"][0]):
            self.assertAlmostEqual(a, b, delta=1e-12)

    def test_a_reader_that_was_cut_off_goes_on_without_gap_or_repeat(self):
        c = self.server.compare(methods=METHODS, duration=1.5, speed=3, paused=False)
        seen, last = [], None
        for _ in range(6):
            reader = Events(self.server, c["id"], last_id=last)
            seen += [e for e in reader.take(8) if e[0] != "hello"]
            last = reader.last_id
            reader.close()
        seen += [e for e in Events(self.server, c["id"], last_id=last).until("end") if e[1] is not None]
        self.assertEqual([i for _, i, _ in seen], list(range(1, len(seen) + 1)))
        self.assertEqual([f["frame"] for f in frames(seen)], list(range(len(frames(seen)))))

    def test_the_query_resumes_as_the_header_does(self):
        c = self.server.compare()
        self.patch(c["id"], step=5)
        reader = Events(self.server, c["id"], query="?last_event_id=3")
        self.assertEqual([i for _, i, _ in reader.take(4)], [None, 4, 5, 6])
        reader.close()

    def test_a_finished_comparison_that_was_read_to_its_end_gets_204(self):
        c = self.server.compare(duration=0.1, speed=50, paused=False)
        reader = Events(self.server, c["id"])
        reader.until("end")
        again = Events(self.server, c["id"], last_id=reader.last_id)
        self.assertEqual(again.status, 204)
        # not so for somebody who has not seen it
        self.assertEqual(Events(self.server, c["id"]).until("end")[0][0], "hello")

    def test_after_a_reset_the_same_reader_goes_on(self):
        c = self.server.compare(duration=0.05, speed=50, paused=False)
        reader = Events(self.server, c["id"])
        reader.until("end")
        self.assertEqual(self.patch(c["id"], reset=True)["generation"], 1)
        again = Events(self.server, c["id"], last_id=reader.last_id)
        seen = again.take(3)
        self.assertEqual([e[0] for e in seen], ["hello", "reset", "frame"])
        self.assertEqual((seen[1][2]["generation"], seen[2][2]["frame"]), (1, 0))
        self.assertEqual(seen[1][1], reader.last_id + 1)
        again.close()

    def test_ids_that_cannot_be_are_refused(self):
        c = self.server.compare()
        for ident in ("x", "-1", "1.5", "99999999", "9" * 40):
            answer = self.server.ask("GET", f"/api/v1/comparisons/{c['id']}/events", headers={"Last-Event-ID": ident})
            self.assert_problem(answer, 400, "bad-request")
        self.assert_problem(self.server.ask("GET", f"/api/v1/comparisons/{c['id']}/events?mode=lve"), 400)

    def test_head_of_a_stream_has_its_type_and_no_body(self):
        c = self.server.compare()
        answer = self.server.ask("HEAD", f"/api/v1/comparisons/{c['id']}/events")
        self.assertEqual((answer.status, answer.type, answer.body), (200, "text/event-stream", b""))

    def test_a_frame_says_more_to_those_who_ask(self):
        c = self.server.compare(methods=METHODS[:2])
        self.patch(c["id"], step=3)
        plain = Events(self.server, c["id"])
        frames_without = plain.frames_up_to(3)
        plain.close()
        for query, names in (("?fields=lambda", {"lambda"}), ("?fields=sigma_min", {"sigma_min"}), ("?fields=sigma_min,lambda,condition", {"sigma_min", "lambda", "condition"})):
            reader = Events(self.server, c["id"], query=query)
            for without, frame in zip(frames_without, reader.frames_up_to(3)):
                extras = {name: frame.pop(name) for name in names}
                self.assertEqual(frame, without)
                for values in extras.values():
                    self.assertEqual(len(values), 2)
            reader.close()
        # the multipliers are those of the terms at this state, and the rows are far from dependent
        state = dict(zip(("th1", "a2", "th3"), frame["methods"][1]["q"])) | dict(zip(("w1", "wa2", "w3"), frame["methods"][1]["v"]))
        terms = self.server.ask("POST", "/api/v1/terms", {"scene": "four-bar", "t": frame["t"], "state": state}).json()
        for a, b in zip(extras["lambda"][1], terms["lambda"]):
            self.assertAlmostEqual(a, b, 9)
        self.assertTrue(all(0.1 < s < 10 for s in extras["sigma_min"]), extras["sigma_min"])
        self.assertTrue(all(1 <= c < 100 for c in extras["condition"]), extras["condition"])
        answer = self.server.ask("GET", f"/api/v1/comparisons/{c['id']}/events?fields=sigma")
        self.assert_problem(answer, 400, "bad-request")
        self.assertIn("sigma_min", answer.json()["hint"])

    def test_a_quiet_stream_has_comment_lines(self):
        c = self.server.compare()
        reader = Events(self.server, c["id"])
        reader.until("comment")
        reader.until("comment")
        reader.close()

    def test_frames_keep_real_time(self):
        """Half a second of the clock for one of the motion at speed 2. A machine that is busy gives later frames at times, never earlier ones."""

        def attempt():
            c = self.server.compare(methods=METHODS[1:], duration=10, speed=2, paused=False)
            reader, start = Events(self.server, c["id"]), None
            for name, _, data in reader:
                if name == "frame" and data["frame"] == 10:
                    start, t = time.monotonic(), data["t"]
                if name == "frame" and start and data["t"] >= t + 1:
                    break
            wall = time.monotonic() - start
            reader.close()
            self.server.ask("DELETE", "/api/v1/comparisons/" + c["id"])
            # when frame 10 came late, the rest seems quick
            return (wall if wall > 0.35 else 100), 0.65 * driver.SLOW

        self.assert_within(attempt)

    def test_pausing_stops_the_frames_and_playing_goes_on(self):
        c = self.server.compare(duration=100, paused=False)
        reader = Events(self.server, c["id"])
        reader.take(5)
        self.assertEqual(self.patch(c["id"], state="paused")["state"], "paused")
        frame = self.server.ask("GET", "/api/v1/comparisons/" + c["id"]).json()["frame"]
        time.sleep(0.3)
        self.assertEqual(self.server.ask("GET", "/api/v1/comparisons/" + c["id"]).json()["frame"], frame)
        self.patch(c["id"], state="running")
        seen = reader.until("state") + reader.until("state") + reader.until("frame")
        states = [d["state"] for n, _, d in seen if n == "state"]
        self.assertEqual(states, ["paused", "running"])
        self.assertEqual(frames(seen)[-1]["frame"], frame + 1)
        reader.close()

    def test_steps_go_forward_by_frames_while_paused(self):
        c = self.server.compare(methods=METHODS)
        self.assertEqual(self.patch(c["id"], step=1)["frame"], 1)
        stepped = self.patch(c["id"], step=7)
        self.assertEqual((stepped["frame"], stepped["state"]), (8, "paused"))
        self.assertEqual(stepped["latest"]["frame"], 8)
        self.assertAlmostEqual(stepped["t"], 8 * c["frame_dt"])

    def test_what_does_not_fit_the_state_changes_nothing(self):
        c = self.server.compare(duration=0.05)
        self.patch(c["id"], step=100)
        self.assertEqual(self.server.ask("GET", "/api/v1/comparisons/" + c["id"]).json()["state"], "finished")
        for body in ({"step": 1}, {"state": "running"}):
            self.assert_problem(self.server.ask("PATCH", "/api/v1/comparisons/" + c["id"], body), 409, "conflict")
        running = self.server.compare(paused=False, duration=100)
        self.assert_problem(self.server.ask("PATCH", "/api/v1/comparisons/" + running["id"], {"step": 1}), 409)

    def test_new_methods_start_anew_and_a_fault_leaves_the_old_run_going(self):
        c = self.server.compare(methods=METHODS, paused=False, duration=100)
        reader = Events(self.server, c["id"])
        reader.take(4)
        answer = self.server.ask("PATCH", "/api/v1/comparisons/" + c["id"], {"methods": [METHODS[0], "index1@rk4:h=0"]})
        document = self.assert_problem(answer, 422)
        self.assertEqual(document["errors"][0]["pointer"], "/methods/1")
        self.assertEqual({f["generation"] for f in frames(reader.take(4))}, {0})
        changed = self.patch(c["id"], methods=["index1@rk4:h=2e-3"])
        self.assertEqual((changed["generation"], len(changed["comparison"]["methods"])), (1, 1))
        seen = reader.until("reset") + reader.take(2)
        self.assertEqual(len(seen[-3][2]["description"]["comparison"]["methods"]), 1)
        self.assertEqual([(f["generation"], f["frame"]) for f in frames(seen)[-2:]], [(1, 0), (1, 1)])
        reader.close()

    def test_new_settings_start_anew(self):
        c = self.server.compare(methods=METHODS)
        parameter = c["scene"]["parameters"][0]
        changed = self.patch(c["id"], parameters={parameter["name"]: parameter["value"] * 1.01})
        self.assertEqual(changed["parameters"], {parameter["name"]: parameter["value"] * 1.01})
        self.assertEqual(changed["generation"], 1)
        self.assertNotEqual(changed["latest"]["methods"][0]["points"], c["latest"]["methods"][0]["points"])
        answer = self.server.ask("PATCH", "/api/v1/comparisons/" + c["id"], {"parameters": {"nonsense": 1}})
        self.assert_problem(answer, 422)
        self.assertEqual(self.server.ask("GET", "/api/v1/comparisons/" + c["id"]).json()["parameters"], changed["parameters"])

    def test_a_setting_of_a_formulation_changes_while_running(self):
        c = self.server.compare(methods=["baumgarte:alpha=5,beta=5@rk4:h=1e-3", METHODS[0]])
        self.patch(c["id"], step=3)
        changed = self.patch(c["id"], set={"method": 0, "key": "alpha", "value": 20})
        self.assertEqual((changed["frame"], changed["generation"]), (3, 0))
        self.assertIn("alpha=20", changed["comparison"]["methods"][0]["method"]["spelling"])
        for bad in ({"method": 1, "key": "alpha", "value": 1}, {"method": 0, "key": "alhpa", "value": 1}, {"key": "alpha"},
                    {"method": 7, "key": "alpha", "value": 1}):
            self.assert_problem(self.server.ask("PATCH", "/api/v1/comparisons/" + c["id"], {"set": bad}), 422)

    def test_a_method_that_fails_stays_in_the_frames_and_tells_an_incident(self):
        c = self.server.compare(methods=["index1@euler:h=0.05", METHODS[1]], duration=60, speed=100, paused=False)
        seen = Events(self.server, c["id"], timeout=120).until("end")
        last = frames(seen)[-1]["methods"]
        self.assertEqual((last[0]["state"], last[1]["state"]), ("failed", "finished"))
        self.assertTrue(last[0]["reason"])
        incidents = [d for n, _, d in seen if n == "incident"]
        self.assertTrue(any(i["method"] == 0 for i in incidents))

    def test_the_end_of_the_server_is_told_to_its_readers(self):
        server = driver.Server()
        readers = [Events(server, server.compare(paused=paused, duration=600)["id"]) for paused in (True, False)]
        for reader in readers:
            reader.take(2)
        self.assertEqual(server.stop(), 0)
        for reader in readers:
            events = [(name, data) for name, _, data in reader if name != "comment"]
            self.assertEqual(events[-1], ("stopping", {"detail": "the server is shutting down"}))
            reader.close()

    def test_readers_that_lag_are_told_of_the_end_of_the_server_too(self):
        """What they had not read filled the buffers, and the stream broke off without a word."""
        server = driver.Server()
        c = server.compare(methods=[METHODS[0]] * 8, duration=600)
        # some 8 MB of frames, more than the systems on both sides keep
        self.assertEqual(server.ask("PATCH", "/api/v1/comparisons/" + c["id"], {"step": 600}, timeout=120).json()["frame"], 600)
        question = {"scene": "four-bar", "method": METHODS[0], "time": 20, "every": 1e-3}
        run = driver.run_to_end(server, question).json()["id"]
        readers = [Events(server, c["id"], receive_buffer=4096), Events(server, None, address=f"/api/v1/runs/{run}/events", receive_buffer=4096)]
        for reader in readers:
            reader.take(2)
        self.assertEqual(server.stop(), 0)
        for reader in readers:
            events = [(name, data) for name, _, data in reader if name != "comment"]
            self.assertEqual(events[-1], ("stopping", {"detail": "the server is shutting down"}))
            reader.close()
        self.assertGreater(len(events), 1)

    def test_deleting_ends_the_stream_with_an_end(self):
        c = self.server.compare(paused=False, duration=100)
        reader = Events(self.server, c["id"])
        reader.take(3)
        self.assertEqual(self.server.ask("DELETE", "/api/v1/comparisons/" + c["id"]).status, 204)
        seen = reader.until("end")
        self.assertEqual(seen[-1][2], {"deleted": True})
        self.assertEqual([e for e in reader], [])
        self.assert_problem(self.server.ask("GET", "/api/v1/comparisons/" + c["id"]), 404)

    def test_live_readers_skip_frames_when_slow_and_complete_ones_never(self):
        c = self.server.compare(methods=METHODS, duration=100)
        live, complete = (Events(self.server, c["id"], query="?mode=" + m) for m in ("live", "complete"))
        live.take(2), complete.take(2)
        self.patch(c["id"], step=400)
        self.assertEqual([f["frame"] for f in complete.frames_up_to(400)], list(range(1, 401)))
        numbers = [f["frame"] for f in live.frames_up_to(400)]
        self.assertEqual(numbers, sorted(set(numbers)))
        live.close(), complete.close()

    def test_a_reader_that_does_not_read_holds_up_nobody(self):
        c = self.server.compare(methods=METHODS, duration=1000)
        slow = Events(self.server, c["id"], receive_buffer=4096)
        # more than the system takes for it; less than 30 s, after which a connection that takes nothing is closed
        n = 1800 // driver.SLOW
        for _ in range(3):
            self.patch(c["id"], step=n // 3)
        reader = Events(self.server, c["id"])
        self.assertEqual(len(reader.frames_up_to(n)), n + 1)
        reader.close()
        # and the slow one, when it reads at last, has lost nothing
        self.assertEqual([f["frame"] for f in slow.frames_up_to(n)], list(range(n + 1)))
        slow.close()


class SmallHistory(driver.ServerCase):
    options = ("--history", "20")

    def test_what_was_evicted_is_told_as_a_gap(self):
        c = self.server.compare()
        answer = self.server.ask("PATCH", "/api/v1/comparisons/" + c["id"], {"step": 100})
        last = answer.json()["last_event"]
        self.assertGreaterEqual(last, 101)
        reader = Events(self.server, c["id"], last_id=5)
        seen = reader.take(22)
        self.assertEqual(seen[1], ("gap", None, {"from": 6, "to": last - 20}))
        self.assertEqual([i for _, i, _ in seen[2:]], list(range(last - 19, last + 1)))
        reader.close()

    def test_no_gap_is_told_where_there_is_none(self):
        c = self.server.compare()
        last = self.server.ask("PATCH", "/api/v1/comparisons/" + c["id"], {"step": 100}).json()["last_event"]
        reader = Events(self.server, c["id"], last_id=last - 20)
        self.assertEqual([i for _, i, _ in reader.take(3)], [None, last - 19, last - 18])
        reader.close()


class Bounds(driver.ServerCase):
    options = ("--max-comparisons", "3", "--max-streams", "2")

    def test_a_full_server_says_429_and_deleting_makes_room(self):
        made = [self.server.compare()["id"] for _ in range(3)]
        self.assertEqual(set(self.server.ask("GET", "/api/v1/comparisons").json()["comparisons"]), set(made))
        body = {"scene": "four-bar", "methods": METHODS}
        answer = self.server.ask("POST", "/api/v1/comparisons?wait=0", body)
        self.assert_problem(answer, 429, "busy")
        self.assertGreater(int(answer.headers["retry-after"]), 0)
        self.server.ask("DELETE", "/api/v1/comparisons/" + made[0])
        made.append(self.server.compare()["id"])
        for ident in made[1:]:
            self.assertEqual(self.server.ask("DELETE", "/api/v1/comparisons/" + ident).status, 204)

    def test_a_comparison_at_fault_takes_no_room(self):
        for _ in range(5):
            self.assert_problem(self.server.ask("POST", "/api/v1/comparisons", {"scene": "x", "methods": METHODS}), 422)
        c = self.server.compare()
        self.server.ask("DELETE", "/api/v1/comparisons/" + c["id"])

    def test_streams_are_bounded_and_closing_one_makes_room(self):
        c = self.server.compare(paused=False, duration=100)
        first, second = Events(self.server, c["id"]), Events(self.server, c["id"])
        self.assert_problem(self.server.ask("GET", f"/api/v1/comparisons/{c['id']}/events"), 429, "busy")
        first.close()
        deadline = time.monotonic() + 20 * driver.SLOW
        third = Events(self.server, c["id"])
        while third.status != 200 and time.monotonic() < deadline:
            time.sleep(0.05)
            third = Events(self.server, c["id"])
        self.assertEqual(third.status, 200)
        second.close(), third.close()
        self.server.ask("DELETE", "/api/v1/comparisons/" + c["id"])


class Unwatched(driver.ServerCase):
    options = ("--idle-pause", "0.4")

    def test_a_comparison_nobody_reads_pauses_itself_and_says_so(self):
        c = self.server.compare(paused=False, duration=1000)
        time.sleep(4)  # ten times what it takes; to look at it would be to touch it
        reader = Events(self.server, c["id"])
        seen = reader.until("state")
        self.assertEqual(seen[-1][2]["state"], "paused")
        self.assertTrue(seen[-1][2]["reason"])
        reader.close()


class Untouched(driver.ServerCase):
    options = ("--expiry", "1.5")

    def test_a_comparison_nobody_touches_is_gone_and_one_that_is_read_stays(self):
        left, read = self.server.compare(), self.server.compare()
        reader = Events(self.server, read["id"])
        # asking for it would be touching it; the list is not
        self.assertTrue(driver.until(lambda: left["id"] not in self.server.ask("GET", "/api/v1/comparisons").json()["comparisons"]))
        self.assert_problem(self.server.ask("GET", "/api/v1/comparisons/" + left["id"]), 404)
        self.assertEqual(self.server.ask("GET", "/api/v1/comparisons/" + read["id"]).status, 200)
        reader.close()


@unittest.skipIf(driver.SLOW > 1, "a sanitiser keeps freed memory to itself")
class Memory(driver.ServerCase):
    options = ("--expiry", "5")

    def memory(self, server=None):
        """Resident memory of the server, or of this one [kB]."""
        with open(f"/proc/{(server or self.server).process.pid}/status") as f:
            return next(int(line.split()[1]) for line in f if line.startswith("VmRSS"))

    def visit(self):
        """Opens a comparison, reads, computes, and leaves as a tab does that is closed: nothing is deleted."""
        c = self.server.compare(methods=METHODS * 3, duration=100)
        events = Events(self.server, c["id"], query="?mode=live")
        events.take(2)
        for _ in range(2):
            self.assertEqual(self.server.ask("PATCH", "/api/v1/comparisons/" + c["id"], {"step": 600}).status, 200)
        events.close()

    def test_the_memory_comes_back_when_a_class_has_left(self):
        self.visit()
        before = self.memory()
        threads = [threading.Thread(target=self.visit) for _ in range(20)]
        for t in threads:
            t.start()
        # the histories stay until their comparisons expire: some 7 MB each, all of them for a while at least
        most = 0
        while any(t.is_alive() for t in threads):
            most = max(most, self.memory())
            time.sleep(0.05)
        for t in threads:
            t.join()
        self.assertGreater(most, before + 40000)
        self.assertTrue(driver.until(lambda: not self.server.ask("GET", "/api/v1/comparisons").json()["comparisons"], 60))
        # what may stay: the stacks and heaps of the threads that serve, 100 kB each, and the pieces that lie between what is in use
        self.assertTrue(driver.until(lambda: self.memory() < before + 15000), (before, most, self.memory()))

    def test_the_memory_of_comparisons_that_have_gone_comes_back(self):
        server = driver.Server()  # none of these expires, however slow the machine

        def memory():
            return self.memory(server)

        before, made = memory(), [server.compare(methods=METHODS)["id"] for _ in range(30)]
        for ident in made:
            server.ask("PATCH", "/api/v1/comparisons/" + ident, {"step": 200})
        most = memory()
        for ident in made:
            self.assertEqual(server.ask("DELETE", "/api/v1/comparisons/" + ident).status, 204)
        self.assertGreater(most, before + 5000)
        # 80 % stayed with the heaps of threads that had ended
        self.assertTrue(driver.until(lambda: memory() < before + (most - before) / 2), (before, most, memory()))
        self.assertEqual(server.stop(), 0)


class Crowd(driver.ServerCase):
    options = ("--run-cpu", "3")

    def test_many_comparisons_stream_at_once_each_in_order(self):
        faults = []

        def one(k):
            try:
                c = self.server.compare(methods=[METHODS[k % 2]], duration=0.5, speed=5, paused=False)
                seen = Events(self.server, c["id"], timeout=60).until("end")
                numbers = [f["frame"] for f in frames(seen)]
                if numbers != list(range(len(numbers))):
                    faults.append(numbers)
                self.server.ask("DELETE", "/api/v1/comparisons/" + c["id"])
            except Exception as fault:  # told below, from the test's own thread
                faults.append(fault)

        threads = [threading.Thread(target=one, args=(k,)) for k in range(24)]
        for t in threads:
            t.start()
        for t in threads:
            t.join()
        self.assertEqual(faults, [])

    def test_patches_from_many_hands_are_carried_out_one_by_one(self):
        c = self.server.compare(duration=1000)
        threads = [threading.Thread(target=self.server.ask, args=("PATCH", "/api/v1/comparisons/" + c["id"], {"step": 2}))
                   for _ in range(20)]
        for t in threads:
            t.start()
        for t in threads:
            t.join()
        self.assertEqual(self.server.ask("GET", "/api/v1/comparisons/" + c["id"]).json()["frame"], 40)

    def test_deleting_while_patching_and_streaming_breaks_nothing(self):
        for _ in range(8):
            c = self.server.compare(duration=1000, paused=False, speed=20)
            readers = [Events(self.server, c["id"]) for _ in range(3)]
            patches = [threading.Thread(target=self.server.ask, args=("PATCH", "/api/v1/comparisons/" + c["id"], {"speed": s}))
                       for s in (1, 10, 50)]
            for t in patches:
                t.start()
            readers[0].close()
            self.assertEqual(self.server.ask("DELETE", "/api/v1/comparisons/" + c["id"]).status, 204)
            for t in patches:
                t.join()
            for reader in readers[1:]:
                reader.until("end")

    def test_short_questions_are_answered_while_long_ones_run(self):
        long = {"scene": "four-bar", "method": "index1@rk4:h=2.5e-6", "time": 100, "at": [100]}
        answers = []

        def ask(i):
            # three questions, so that three threads compute; what takes longer than the wait is asked for again
            answer = self.server.ask("POST", "/api/v1/runs", {**long, "time": 100 + i}, timeout=200)
            while answer.status == 202 or answer.json()["state"] != "finished":
                answer = self.server.ask("GET", "/api/v1/runs/" + answer.json()["id"] + "?wait=60", timeout=200)
            answers.append(answer)

        threads = [threading.Thread(target=ask, args=(i,)) for i in range(3)]
        for t in threads:
            t.start()
        time.sleep(0.3)
        self.assertEqual(self.server.ask("GET", "/api/v1/").status, 200)
        self.assertTrue(all(t.is_alive() for t in threads))
        for t in threads:
            t.join()
        # and the long ones were cut at their bound, said so, and told how far they came
        for run in (answer.json() for answer in answers):
            self.assertEqual(run["status"], "stopped")
            self.assertIn("computing time", run["reason"])
            self.assertTrue(0 < run["t_reached"] < 103)

    def test_a_full_queue_says_429_and_stopping_cuts_long_work_short(self):
        server = driver.Server()
        asked = []
        for i in range(45):
            long = json.dumps({"scene": "four-bar", "method": "index1@rk4:h=2.5e-5", "time": 1000 + i, "at": [1000]})
            connection = server.connect()
            connection.request("POST", "/api/v1/runs", body=long, headers={"Content-Type": "application/json"})
            asked.append(connection)
        # 3 are worked on and 32 wait; the others hear it at once, whichever they are
        sockets = {c.sock: c for c in asked}
        ready, _, _ = select.select(list(sockets), [], [], 20 * driver.SLOW)
        busy = driver.Answer(sockets[ready[0]].getresponse())
        self.assert_problem(busy, 429, "busy")
        self.assertGreater(int(busy.headers["retry-after"]), 0)
        # the process ends itself; without that, 45 times the limit of computing time
        start = time.monotonic()
        self.assertEqual(server.stop(), 0, "".join(server.errors)[-3000:])
        self.assertLess(time.monotonic() - start, 10 * driver.SLOW)
        for connection in asked:
            connection.close()


if __name__ == "__main__":
    driver.main()
