# SPDX-License-Identifier: GPL-3.0-or-later
"""Mechanisms whose mass sits in their points, as a scene of bodies and joints: `oracle.py` moves the same points as particles,
without bodies, joints, angles or inertia.

Every body's frame is the world at the start, so joints are given by the place where they are and all coordinates start at 0.
"""
from workshop import scene


def body(name, *lumps):
    """A body of point masses (mass, place at the start)."""
    mass = sum(m for m, _ in lumps)
    com = [sum(m * p[i] for m, p in lumps) / mass if mass else 0.0 for i in range(3)]
    off = [(m, [p[i] - com[i] for i in range(3)]) for m, p in lumps]
    tensor = {}
    for i, a in enumerate("xyz"):
        for k, b in enumerate("xyz"):
            if k >= i:
                tensor[a + b] = sum(m * ((sum(c * c for c in r) if i == k else 0.0) - r[i] * r[k]) for m, r in off)
    return {"name": name, "mass": mass, "com": com, "inertia": tensor}


def hinge(name, parent, child, at, axis=(0, 0, 1), **more):
    return {"name": name, "type": "revolute", "axis": list(axis), "parent": {"body": parent, "at": list(at)},
            "child": {"body": child, "at": list(at)}, **more}


def rail(name, parent, child, at, axis, **more):
    return {**hinge(name, parent, child, at, axis, **more), "type": "prismatic"}


def lumped(name, bodies, joints, points, start=None, **more):
    """points: {name: (body, place at the start)}, watched beside the coordinates; start: rates that are kept."""
    draw = {"points": {key: {"body": on, "at": list(at)} for key, (on, at) in points.items()}}
    return scene(name, bodies, joints, {}, start, draw=draw, **more)
