# SPDX-License-Identifier: GPL-3.0-or-later
"""The five skeletons of the usual lesson (section 7 to 11) beside the programs of `holonom export`: each slip, what it does to the
answer, and what is written instead. The four-bar and Bennett's linkage as exported supply the matrices; the slips are made on them.
Fails where a slip no longer does what its row says. Slips of Java and Mathematica are done on the same matrices with numpy.

usage: skeletons.py PROGRAM
"""

import importlib.util
import os
import subprocess
import sys
import tempfile

import numpy as np
from scipy.integrate import solve_ivp

PROGRAM = os.path.abspath(sys.argv[1])
SECONDS = 10.0


def exported(scene, folder):
    path = os.path.join(folder, scene.replace("-", "_") + ".py")
    subprocess.run([PROGRAM, "export", scene, "--language", "python", "-o", path], check=True)
    spec = importlib.util.spec_from_file_location(scene, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def saddle(m, q, v, upper=-1.0, rows=None):
    """The skeleton's system: [M upper*J'; J 0] x = [f; -gamma]; rows: of J' that are kept."""
    mass, force, jacobian, bias, *_ = m.terms(0.0, q, v)
    corner = upper * jacobian.T
    if rows is not None:
        corner = np.where(np.arange(m.NV)[:, None] < rows, corner, 0.0)
    matrix = np.block([[mass, corner], [jacobian, np.zeros((m.NC, m.NC))]])
    return matrix, np.concatenate([force, -bias])


def skeleton_slope(m):
    def slope(_, y):
        q, v = y[: m.NQ], y[m.NQ :]
        matrix, right = saddle(m, q, v)
        return np.concatenate([m.rates(q, v), np.linalg.solve(matrix, right)[: m.NV]])

    return slope


def to_rounding(difference):
    """A difference in words: below 1e-12 its digits depend on the libraries that are installed."""
    return "less than 1e-12" if difference < 1e-12 else f"{difference:.0e}"


def gap(m, y):
    return float(np.linalg.norm(m.terms(0.0, y[: m.NQ], np.zeros(m.NV))[4]))


def late_times():
    """How many of 100 ends t_eval = arange(t0, t1 + dt, dt) passes, so that solve_ivp refuses."""
    ends = [k / 10 for k in range(1, 101)]
    refused = 0
    for end in ends:
        try:
            solve_ivp(lambda t, y: -y, (0, end), [1.0], t_eval=np.arange(0, end + 1e-3, 1e-3))
        except ValueError:
            refused += 1
    return refused


def rows():
    with tempfile.TemporaryDirectory() as folder:
        m, b = exported("four-bar", folder), exported("bennett", folder)
    start = np.concatenate([m.START_Q, m.START_V])
    a = m.START_A

    # drift: no stabilisation, and the tolerance that was left as it is (1e-3); the same in ode45
    loose = solve_ivp(skeleton_slope(m), (0, SECONDS), start, method="RK45")
    ours = m.move(m.START_Q, m.START_V, SECONDS)
    gaps = gap(m, loose.y[:, -1]), gap(m, ours.y[:, -1])
    energies = [abs(m.terms(0.0, y[: m.NQ], y[m.NQ :])[-1] - m.ENERGY) for y in (loose.y[:, -1], ours.y[:, -1])]
    yield ("Python, MATLAB", "no stabilisation, default tolerance 1e-3", f"after {SECONDS:g} s the loop is open by {gaps[0]:.2g} m, the energy off by {energies[0]:.2g} J",
           f"Baumgarte's terms and rtol 1e-10: {gaps[1]:.1g} m, {energies[1]:.1g} J", gaps[0] > 1e-3 > 1e3 * gaps[1])  # fmt: skip

    refused = late_times()
    yield ("Python", "t_eval = arange(t0, t1 + dt, dt) may pass t1", f"{refused} of 100 end times: solve_ivp ends with ValueError", "the end is an argument, no list of times is made", refused > 0)

    # redundant rows
    matrix, right = saddle(b, b.START_Q, b.START_V)
    rank = np.linalg.matrix_rank(matrix)
    try:
        wrong = np.linalg.solve(matrix, right)
        error = np.abs(wrong[: b.NV] - b.START_A).max() / max(1, np.abs(b.START_A).max())
        did = f"Bennett: rank {rank} of {len(matrix)}; no error is raised, a is off by {error:.1g} of its size, multipliers up to {np.abs(wrong[b.NV :]).max():.1g}"
    except np.linalg.LinAlgError:
        did = f"Bennett: rank {rank} of {len(matrix)}; LinAlgError, nothing is computed"
    good = np.abs(b.accelerations(0.0, b.START_Q, b.START_V)[0] - b.START_A).max()
    yield ("all five", "the system is solved as if J had full rank", did, f"scaled, to rank, least squares: a differs by {to_rounding(good)}", rank < len(matrix) and good < 1e-9)
    yield ("C++", "fullPivLu().solve() without a question about the rank", "not run here: complete pivoting gives one of many sets of multipliers without a word",
           "multipliers that are not unique are what the rank leaves; the accelerations are checked", True)  # fmt: skip
    yield ("Java, MATLAB", "the boolean of solve() is dropped; K \\ rhs prints a warning and goes on", "not run here", "a self-check that ends with 1", True)

    # the sign of the multipliers
    mass, force, jacobian, *_ = m.terms(0.0, m.START_Q, m.START_V)
    x = np.linalg.solve(*saddle(m, m.START_Q, m.START_V, upper=1.0))
    balance = np.abs(mass @ x[: m.NV] - force - jacobian.T @ x[m.NV :]).max() / np.abs(jacobian.T @ x[m.NV :]).max()
    yield ("Java", "J' is put into K where -J' belongs", f"a is right (differs by {to_rounding(np.abs(x[: m.NV] - a).max())}), every force of a constraint has the wrong sign: M a - f - J' lambda is {balance:.2g} of J' lambda",
           "[M J'; J 0] [a; -lambda]: the sign is in the unknown, and is turned", abs(balance - 2) < 1e-6)  # fmt: skip
    yield ("Java", "Sa() and tauA() return null", "NullPointerException in the first step (S.getNumRows())", "drives are in the force of the scene", True)
    yield ("C++, Java, MATLAB", "the right-hand side alone: no integrator, no start that closes the loop", "nothing moves", "an integrator, a closed start, close() where parameters were changed", True)

    # Wolfram's equations
    x = np.linalg.solve(*saddle(m, m.START_Q, m.START_V, rows=2))
    off = np.abs(x[: m.NV] - a).max() / np.abs(a).max()
    yield ("Wolfram", "If[i <= 2, ...]: multipliers act on the first two coordinates alone", f"a is off by {100 * off:.0f} % at the start", "J' lambda in every row", off > 0.01)
    angles, lengths = m.START_Q, np.array([m.l1, m.l2, m.l3])
    masses = np.array([m.m1, m.m2, m.m3])
    printed = np.block([[np.diag(masses * lengths**2), -jacobian.T], [jacobian, np.zeros((m.NC, m.NC))]])
    bias = m.terms(0.0, m.START_Q, m.START_V)[3]
    x = np.linalg.solve(printed, np.concatenate([masses * m.g * lengths * np.sin(angles), -bias]))
    off = np.abs(x[: m.NV] - a).max() / np.abs(a).max()
    yield ("Wolfram", "T = 1/2 m l^2 q'^2 for each rod, V = m g l cos q: point masses at their ends, each on the ground, angles from the vertical",
           f"a is off by {100 * off:.0f} % at the start", "centres of mass carried by the links before them; V from heights", off > 0.1)  # fmt: skip
    yield ("Wolfram", "q1 = q1[t] defines q1 by itself", "not run here: Mathematica stops at $RecursionLimit", "functions of numbers; q is a list", True)
    yield ("Wolfram", "qi and tau[i] stand where no rule reaches them", "not run here: NDSolve is given free symbols", "lists by index", True)


def main():
    bad = 0
    print("The skeletons of the usual lesson beside the exported programs: each slip, what it does, what is written instead\n")
    for language, slip, did, instead, holds in rows():
        bad += not holds
        print(f"{language}: {slip}\n    does:     {did}\n    we write: {instead}{'' if holds else '      NO LONGER SO'}\n")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
