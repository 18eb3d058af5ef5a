#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The motions of `seldom.py` without multibody dynamics: particles and rods, or one formula, by scipy's DOP853.

usage: seldom_oracle.py > seldom.json    (needs numpy and scipy; 15 s)

Particles on rods, all in Cartesian coordinates: M a = F + J' l, J a = -2 |v_i - v_j|^2 for each rod, least squares where
rods are redundant. Nothing is shared with the program, nor with the scenes but the numbers. Each answer is computed with
rtol 1e-12 and again with 1e-10; what they differ by is printed on standard error.
"""
import json
import math
import sys

import numpy as np
import seldom
from scipy.integrate import solve_ivp


def integrate(f, y0, times, rtol, longest=math.inf):
    done = solve_ivp(f, (0, times[-1]), y0, "DOP853", times, rtol=rtol, atol=rtol * 1e-2, max_step=longest)
    assert done.success, done.message
    return done.y.T


def particles(m, times, rtol):
    """m: a mechanism of seldom.PARTICLES. The places of its free points at the times, and the energy kept."""
    free = [p for p in m["points"] if p not in m["fixed"]]
    at = {p: np.array(x, float) for p, x in m["points"].items()}
    size = max(np.abs(x).max() for x in at.values())
    index = {p: slice(3 * k, 3 * k + 3) for k, p in enumerate(free)}
    mass = np.repeat([m["mass"][p] for p in free], 3)
    gravity = np.tile(m["gravity"], len(free))

    def place(y, p):
        return y[index[p]] if p in index else at[p]

    def speed(v, p):
        return v[index[p]] if p in index else np.zeros(3)

    def rows(x, v):
        J, gamma = [], []
        for i, k in m["rods"]:
            r, w, row = place(x, i) - place(x, k), speed(v, i) - speed(v, k), np.zeros(len(x))
            for p, sign in ((i, 1), (k, -1)):
                if p in index:
                    row[index[p]] += sign * r
            J.append(row)
            gamma.append(w @ w)
        for p, normal in m.get("planes", []):
            row = np.zeros(len(x))
            row[index[p]] = np.array(normal, float) * size  # as large as a rod's row
            J.append(row)
            gamma.append(0.0)
        return np.array(J), np.array(gamma)

    def forces(t, x, v):
        F = mass * gravity
        for a, b, stiffness, rest, damping in m.get("springs", []):
            r = place(x, b) - place(x, a)
            length = math.sqrt(r @ r)
            pull = stiffness * (length - rest) + damping * (r @ (speed(v, b) - speed(v, a))) / length
            for p, sign in ((a, 1), (b, -1)):
                if p in index:
                    F[index[p]] += sign * pull * r / length
        for p, force in m.get("forces", lambda *_: [])(t, lambda p: place(x, p), lambda p: speed(v, p)):
            if p in index:
                F[index[p]] += force
        return F

    def slope(t, y):
        x, v = y[:len(mass)], y[len(mass):]
        J, gamma = rows(x, v)
        free_fall = forces(t, x, v) / mass
        l = np.linalg.lstsq((J / mass) @ J.T, -gamma - J @ free_fall, rcond=1e-11)[0]
        return np.concatenate([v, free_fall + J.T @ l / mass])

    x0 = np.concatenate([at[p] for p in free])
    v0 = np.zeros(len(x0))
    if m.get("speeds"):
        J, _ = rows(x0, v0)
        told = [np.eye(len(x0))[index[p].start + i] * size for p in m["speeds"] for i in range(3)]
        wanted = [m["speeds"][p][i] * size for p in m["speeds"] for i in range(3)]
        v0 = np.linalg.lstsq(np.vstack([J, told]), np.concatenate([np.zeros(len(J)), wanted]), rcond=1e-11)[0]
    y = integrate(slope, np.concatenate([x0, v0]), times, rtol, m.get("longest", math.inf))
    open_by = max(abs(np.linalg.norm(place(x, i) - place(x, k)) - np.linalg.norm(at[i] - at[k])) for x in y for i, k in m["rods"])
    return {p: [list(x[index[p]]) for x in y] for p in free}, open_by / size


def main():
    answer = {}
    for name, m in seldom.PARTICLES.items():
        times = m["times"]
        fine, open_by = particles(m, times, 1e-12)
        coarse, _ = particles(m, times, 1e-10)
        apart = max(np.abs(np.array(fine[p]) - np.array(coarse[p])).max() for p in fine)
        answer[name] = {"times": times, "points": fine}
        print(f"{name:24} rods kept to {open_by:.1e} of its size, two tolerances {apart:.1e} apart", file=sys.stderr)
    for name, m in seldom.FORMULAS.items():
        times = m["times"]
        fine, coarse = (integrate(m["slope"], m["start"], times, rtol, m.get("longest", math.inf)) for rtol in (1e-12, 1e-10))
        answer[name] = {"times": times, "states": [list(y) for y in fine]}
        print(f"{name:24} two tolerances {np.abs(fine - coarse).max():.1e} apart", file=sys.stderr)
    json.dump(answer, sys.stdout, indent=None)
    print()


main()
