# SPDX-License-Identifier: GPL-3.0-or-later
# Mechanisms in the spirit of a textbook's end-of-chapter problems, by three methods each, against facts that are computed
# without the program: compass-and-ruler geometry, closed forms, virtual work, conserved quantities. Speaks TAP.
# usage: test_mechanisms.py [NAME...]; with --table it prints the largest deviation beside each tolerance.
import sys

from edges import EDGES
from linkages import LINKAGES
from machines import MACHINES
from seldom import SELDOM
from space import SPACE
from workshop import METHODS, run

ALL = LINKAGES + MACHINES + SPACE + SELDOM + EDGES


def check(mechanism, method):
    """(worst deviation in parts of its tolerance, words of the first fault)."""
    motion, refusal = run(mechanism["scene"], method, mechanism["time"], mechanism["at"])
    if motion is None:
        return None, refusal
    if motion.document["status"] != "ok":
        return None, f"status {motion.document['status']}: {motion.document['reason']}"
    worst, fault, count = 0.0, "", 0
    for what, value, expected, tolerance in mechanism["fact"](motion):
        count += 1
        off = abs(value - expected)
        if not off <= tolerance and not fault:
            fault = f"{what} is {value!r}, expected {expected!r} within {tolerance:g}"
        worst = max(worst, off / tolerance if tolerance else off)
    return worst, fault if count else "the fact says nothing"


def main():
    wanted = [a for a in sys.argv[1:] if not a.startswith("-")]
    table = "--table" in sys.argv
    cases = [(m, method) for m in ALL if not wanted or m["name"] in wanted for method in m.get("methods", METHODS)]
    if not table:
        print(f"1..{len(cases)}")
    faults, highest = 0, 0.0
    for number, (mechanism, method) in enumerate(cases, 1):
        worst, fault = check(mechanism, method)
        faults += bool(fault)
        highest = max(highest, worst or 0.0)
        if table:
            print(f"{mechanism['name']:28s} {method:34s} " + (fault or f"{worst:.1e} of its tolerance"))
        else:
            print(f"{'not ok' if fault else 'ok'} {number} - {mechanism['name']} by {method}")
            if fault:
                print(f"# {fault}")
    if table:
        mechanisms = len({m["name"] for m, _ in cases})
        print(f"\n{mechanisms} mechanisms, {len(cases)} runs, {faults} against their fact; the largest deviation is {highest:.2g} of its tolerance")


main()
