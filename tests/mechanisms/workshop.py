# SPDX-License-Identifier: GPL-3.0-or-later
"""Pieces to write mechanisms with, and the run of one: nothing in here knows an equation of motion.

A mechanism of the tests is a dict {name, scene, fact, time, at, methods}; its fact is a function of a Motion that yields
(what, value, expected, tolerance), with numbers that come from geometry or from a closed form.
"""
import json
import math
import os
import subprocess

PROGRAM = os.environ.get("HOLONOM", "build/holonom")

# one method of each family; a step of 1 ms is far inside the asymptotic range of every mechanism here
METHODS = ["projection@rk4:h=1e-3", "partitioning@dop853:rtol=1e-10", "ggl@radau5:rtol=1e-9"]


def rod(name, length, mass=1.0):
    """A uniform thin rod along its own x axis, from 0 to length."""
    return {"name": name, "mass": mass, "com": [length / 2, 0, 0], "inertia": {"zz": mass * length**2 / 12}}


def plate(name, mass, com, izz):
    return {"name": name, "mass": mass, "com": [*com, 0], "inertia": {"xx": izz / 2, "yy": izz / 2, "zz": izz}}


def ball(name, mass, i=1e-3):
    return {"name": name, "mass": mass, "inertia": {"xx": i, "yy": i, "zz": i}}


def pin(name, parent, at, child, on=(0, 0), **more):
    """A revolute joint about z, or about `axis`; its coordinate has the joint's name."""
    return {"name": name, "type": "revolute", "parent": {"body": parent, "at": list(at)}, "child": {"body": child, "at": list(on)}, **more}


def slide(name, parent, at, axis, child, on=(0, 0), **more):
    return {"name": name, "type": "prismatic", "axis": list(axis), "parent": {"body": parent, "at": list(at)},
            "child": {"body": child, "at": list(on)}, **more}


def scene(name, bodies, joints, positions, rates=None, gravity=None, **more):
    """A number in positions or rates is kept; a one-entry list is a guess."""
    def start(entries):
        return {k: {"guess": v[0]} if isinstance(v, list) else v for k, v in (entries or {}).items()}

    document = {"holonom": 1, "name": name, "bodies": bodies, "joints": joints, **more}
    if gravity:
        document["gravity"] = gravity
    document["start"] = {"positions": start(positions), "rates": start(rates)}
    return document


class Motion:
    """The answer of one run, by name."""

    def __init__(self, document):
        self.document = document
        self.t = document["samples"]["t"]
        self.energy = document["samples"]["energy"]
        self.lam = document["samples"]["lambda"]

    def q(self, name):
        return [row[self.document["coordinates"].index(name)] for row in self.document["samples"]["q"]]

    def v(self, name):
        return [row[self.document["rates"].index(name)] for row in self.document["samples"]["v"]]

    def row(self, name):
        return [row[self.document["rows"].index(name)] for row in self.lam]

    def point(self, name):
        """World places of a point of the drawing."""
        k = 3 * self.document["points"].index(name)
        return [row[k:k + 3] for row in self.document["samples"]["points"]]

    def force(self, carrier):
        """On the child of a joint, world axes."""
        k = 3 * self.document["carriers"].index(carrier)
        return [row[k:k + 3] for row in self.document["samples"]["reaction_force"]]

    def moment(self, carrier):
        k = 3 * self.document["carriers"].index(carrier)
        return [row[k:k + 3] for row in self.document["samples"]["reaction_moment"]]


def run(document, method, time, at):
    """The motion, or the words with which it was refused."""
    command = [PROGRAM, "run", "-", "--method", method, "--time", repr(time), "--at", ",".join(repr(t) for t in at),
               "--reactions", "--json"]
    done = subprocess.run(command, input=json.dumps(document), capture_output=True, text=True, timeout=120)
    if done.returncode != 0:
        return None, f"exit {done.returncode}: {done.stderr.strip()[:400]} {done.stdout[:200]}"
    return Motion(json.loads(done.stdout)), ""


# ---- plane geometry, written apart from the program ----


def polar(origin, length, angle):
    return (origin[0] + length * math.cos(angle), origin[1] + length * math.sin(angle))


def circles(a, ra, b, rb, side):
    """Where the circles about a and b meet; side +1: to the left of the way from a to b."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    d = math.hypot(dx, dy)
    along = (ra**2 - rb**2 + d**2) / (2 * d)
    across = side * math.sqrt(ra**2 - along**2)
    return (a[0] + (along * dx - across * dy) / d, a[1] + (along * dy + across * dx) / d)


def near(x, ys):
    """The one of ys that differs least from x by whole turns, brought to x's turn."""
    return x - min((math.remainder(x - y, 2 * math.pi) for y in ys), key=abs)


def angle(a, b):
    return math.atan2(b[1] - a[1], b[0] - a[0])


def turned(x, y):
    """How far two angles differ, whole turns apart."""
    return math.remainder(x - y, 2 * math.pi)


def every(step, end):
    return [round(step * k, 12) for k in range(1, int(round(end / step)) + 1)]
