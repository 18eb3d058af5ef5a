# SPDX-License-Identifier: GPL-3.0-or-later
"""Mechanisms at the edges of what a program can do: of a micrometre and of a hundred kilometres, beside a change point, stiff, with
redundant rows in space, without a degree of freedom, with masses that differ by nine powers of ten. Each fact is a closed form.
"""
import math

from machines import DOWN, G, agm_period, back_at_start
from workshop import circles, every, near, angle, pin, polar, rod, scene, slide

REGULAR = ["projection@rk4:h=1e-3", "partitioning@dop853:rtol=1e-10", "index1@dop853:rtol=1e-11"]
EASY = 1e-6  # of what moves with radians of order one; steps of 1 ms leave 1e-9 of it


def scaled(period, *names):
    """The methods with steps in parts of a period: similar mechanisms get similar steps."""
    return [f"{name}@rk4:h={period / 2000!r}" for name in names] + ["partitioning@dop853:rtol=1e-10", "ggl@radau5:rtol=1e-9"]


# ---- one pendulum in two sizes; both sides of half a period, and the whole one

def swing(name, length, mass):
    """A uniform rod of this length that is let go 2.2 rad from where it hangs."""
    period = agm_period(2 / 3 * length / G, 2.2)

    def fact(motion):
        th = motion.q("th")
        yield "other side", th[0], -math.pi / 2 - 2.2, 1e-5
        yield "back", th[1], -math.pi / 2 + 2.2, 1e-5

    return dict(name=name, scene=scene(name, [rod("rod", length, mass)], [pin("th", "ground", (0, 0), "rod")],
                                       {"th": -math.pi / 2 + 2.2}, {"d_th": 0}, DOWN), fact=fact, time=period,
                at=back_at_start(period), methods=scaled(period, "projection", "nullspace"))


# ---- a plate on two equal cranks, let go beside its change point: the plate moves on a circle without turning

SWING_L, SWING_OFF = 0.4, 1e-3
SWING_PERIOD = agm_period(SWING_L / G, math.pi / 2 - SWING_OFF)


def porch_fact(motion):
    for what, k, end in (("other side", 0, -math.pi + SWING_OFF), ("back", 1, -SWING_OFF)):
        yield what, motion.q("th")[k], end, 1e-4
        yield "the plate does not turn", motion.q("th")[k] + motion.q("p")[k], 0, 1e-7


def porch_scene():
    """Massless cranks of 0.4 m under a beam, the plate's mass at its middle; all four joints in one line at 1e-3 rad from here."""
    a = polar((0, 0), SWING_L, -SWING_OFF)
    light = lambda name: {"name": name, "mass": 0}
    plate = {"name": "plate", "mass": 3.0, "com": [0.5, 0, 0], "inertia": {"zz": 0.2}}
    return scene("porch-swing", [light("c"), light("d"), plate],
                 [pin("th", "ground", (0, 0), "c"), pin("ph", "ground", (1, 0), "d"), pin("p", "c", (SWING_L, 0), "plate"),
                  {**pin("B", "plate", (1, 0), "d", (SWING_L, 0)), "cut": True}],
                 {"th": math.atan2(a[1], a[0]), "ph": [-SWING_OFF], "p": [SWING_OFF]}, {"d_th": 0}, DOWN)


# ---- a door on three hinges in line: ten rows too many, an axis that leans by 0.3 rad

DOOR_LEAN = 0.3
DOOR_PERIOD = agm_period(2 / 3 * 0.9 / (G * math.sin(DOOR_LEAN)), 1.1)


def door_fact(motion):
    th = motion.q("th")
    yield "other side", th[0], -1.1, 1e-5
    yield "back", th[1], 1.1, 1e-5


def door_scene():
    """The axis leans towards x by 0.3 rad, so the door hangs lowest where it points there, at th = 0."""
    axis = [math.sin(DOOR_LEAN), 0, math.cos(DOOR_LEAN)]
    at = lambda s: [s * x for x in axis]
    joint = lambda name, s, **more: {"name": name, "type": "revolute", "axis": axis, "parent": {"body": "ground", "at": at(s)},
                                     "child": {"body": "door", "at": at(s)}, **more}
    x = [math.cos(DOOR_LEAN), 0, -math.sin(DOOR_LEAN)]
    door = {"name": "door", "mass": 30, "com": [0.45 * c for c in x],
            "inertia": {"xx": 30 * 0.9**2 / 12, "yy": 30 * 0.9**2 / 12, "zz": 30 * 0.9**2 / 12}}
    return scene("leaning-door", [door], [joint("th", 0), joint("upper", 1.6, cut=True), joint("middle", 0.8, cut=True)],
                 {"th": 1.1}, {"d_th": 0}, [0, 0, -G])


# ---- a stiff buffer spring of 1e8 N/m below a mass of 1 kg: x = -sag (1 - cos(w t)), 1592 turns a second

STIFF_W = 1e4


def stiff_fact(motion):
    sag = G / STIFF_W**2
    for t, x in zip(motion.t, motion.q("x")):
        yield "height", x / sag, math.cos(STIFF_W * t) - 1, 1e-3


STIFF = scene("stiff-spring", [{"name": "m", "mass": 1.0}], [slide("x", "ground", (0, 0), (0, 1, 0), "m")], {"x": 0}, {"d_x": 0},
              DOWN, loads=[{"force": {"joint": "x", "value": f"-{STIFF_W**2!r}*x"}}])


# ---- two drums geared 1 : 1000 with inertias 1e-6 and 1e3: the ratio's square makes the small one count a thousandth of the other

def gear_fact(motion):
    rate = 0.5 / (1e3 + 1000**2 * 1e-6)
    for t, slow, fast in zip(motion.t, motion.q("slow"), motion.q("fast")):
        yield "slow", slow / rate, t**2 / 2, 1e-6
        yield "fast, the other way round", fast / rate, -1000 * t**2 / 2, 1e-3


def gear_scene():
    wheel = lambda name, i: {"name": name, "mass": 1, "inertia": {"zz": i}}
    return scene("thousandfold-gear", [wheel("s", 1e3), wheel("f", 1e-6)], [pin("slow", "ground", (0, 0), "s"), pin("fast", "ground", (2, 0), "f")],
                 {"slow": 0}, {"d_slow": 0}, None, constraints=[{"name": "mesh", "gear": {"coordinates": ["fast", "slow"], "ratio": 1000}}],
                 loads=[{"torque": {"joint": "slow", "value": 0.5}}])


# ---- a double Atwood machine with massless pulleys: the moving pulley carries 2 kg and 1 kg, 3.2 kg hang against it

def double_atwood_fact(motion):
    """A = 3.2, reduced mass of the pair 4 m1 m2 / (m1 + m2) = 8/3: the pulley falls with -a, and the pair parts as beside a rope in g + a."""
    pair = 4 * 2.0 * 1.0 / 3.0
    a = (3.2 - pair) / (3.2 + pair) * G    # of the 3.2 kg, down; the moving pulley goes up
    part = (2.0 - 1.0) / 3.0 * (G + a)     # of the 2 kg against the pulley, down
    for t, big, two, one in zip(motion.t, motion.q("big"), motion.q("two"), motion.q("one")):
        yield "3.2 kg", big, -a * t**2 / 2, EASY
        yield "2 kg", two, (a - part) * t**2 / 2, EASY
        yield "1 kg", one, (a + part) * t**2 / 2, EASY


def double_atwood_scene():
    """Heights above the start; the rope over the moving pulley keeps two + one - 2 pulley, and the pulley is at -big."""
    mass = lambda name, m: {"name": name, "mass": m}
    up = (0, 1, 0)
    return scene("double-atwood", [mass("b", 3.2), mass("t", 2.0), mass("o", 1.0)],
                 [slide("big", "ground", (0, 0), up, "b"), slide("two", "ground", (1, 0), up, "t"), slide("one", "ground", (2, 0), up, "o")],
                 {"big": 0, "two": 0}, {"d_big": 0, "d_two": 0}, DOWN,
                 constraints=[{"name": "ropes", "formula": "two + one + 2*big"}])


# ---- a four-bar whose crank is driven 12 times round: its rocker stands where two circles meet

def driven_fact(motion):
    for t, r in zip(motion.t, motion.q("r")):
        a = polar((0, 0), 0.3, 0.5 + 25 * t)
        b = circles(a, 1.0, (1.1, 0), 0.8, 1)
        yield "rocker", r, near(r, [angle((1.1, 0), b)]), 1e-8
    yield "reports", len(motion.document["incidents"]), 0, 0


def driven_scene():
    a = polar((0, 0), 0.3, 0.5)
    b = circles(a, 1.0, (1.1, 0), 0.8, 1)
    return scene("driven-rocker", [rod("c", 0.3), rod("k", 1.0), rod("w", 0.8)],
                 [pin("th", "ground", (0, 0), "c"), pin("k", "c", (0.3, 0), "k"), pin("r", "ground", (1.1, 0), "w"),
                  {**pin("B", "k", (1.0, 0), "w", (0.8, 0)), "cut": True}],
                 {"th": [0.5], "k": [angle(a, b) - 0.5], "r": [angle((1.1, 0), b)]}, None, DOWN,
                 constraints=[{"name": "motor", "motion": {"joint": "th", "value": "0.5 + 25*t"}}])


# ---- a crank and a rod of one length and 1 g each, a slider of 1000 t: the rod's end runs along the rail at 2 r cos(th)

def isosceles_fact(motion):
    """In a horizontal plane, until short of the dead point at 90 degrees; kinetic energy stays, and geometry holds."""
    for th, x, w, vx in zip(motion.q("th"), motion.q("x"), motion.v("d_th"), motion.v("d_x")):
        yield "slider", x, 2 * 0.25 * math.cos(th), 1e-9
        yield "its speed", vx, -2 * 0.25 * math.sin(th) * w, 1e-8
    first, energy = motion.v("d_x")[0], motion.energy[0]
    for vx in motion.v("d_x"):    # all that counts of the mass is the slider's: it goes on as it began
        yield "slider's speed", vx, first, 1e-7
    for e in motion.energy:
        yield "energy", e / energy, 1, 1e-7


def isosceles_scene():
    light = lambda name: {"name": name, "mass": 1e-3, "com": [0.125, 0, 0], "inertia": {"zz": 1e-3 * 0.25**2 / 12}}
    return scene("isosceles-slider", [light("c"), light("k"), {"name": "s", "mass": 1e6}],
                 [pin("th", "ground", (0, 0), "c"), pin("k", "c", (0.25, 0), "k"), slide("x", "ground", (0, 0), (1, 0, 0), "s"),
                  {**pin("B", "k", (0.25, 0), "s"), "cut": True}],
                 {"th": 0.7, "k": [-1.4], "x": [2 * 0.25 * math.cos(0.7)]}, {"d_th": 1.0}, None)


EDGES = [
    swing("rod-of-a-micrometre", 1e-6, 1e-15),
    swing("rod-of-a-hundred-kilometres", 1e5, 1e9),
    dict(name="porch-swing", scene=porch_scene(), fact=porch_fact, time=SWING_PERIOD, at=back_at_start(SWING_PERIOD),
         methods=REGULAR),  # the cranks have no mass, and index 3 finds no step beside the change point
    dict(name="leaning-door", scene=door_scene(), fact=door_fact, time=DOOR_PERIOD, at=back_at_start(DOOR_PERIOD)),
    dict(name="stiff-spring", scene=STIFF, fact=stiff_fact, time=5e-3, at=every(2.5e-4, 5e-3),
         methods=["projection@rk4:h=1e-5", "partitioning@dop853:rtol=1e-10", "ggl@radau5:rtol=1e-9,atol=1e-15"]),
    dict(name="thousandfold-gear", scene=gear_scene(), fact=gear_fact, time=1, at=every(0.1, 1)),
    dict(name="double-atwood", scene=double_atwood_scene(), fact=double_atwood_fact, time=1, at=every(0.1, 1)),
    dict(name="driven-rocker", scene=driven_scene(), fact=driven_fact, time=3, at=every(0.013, 2.99),
         methods=["partitioning@dop853:rtol=1e-10", "reduced@dopri5:rtol=1e-6", "projection@rk4:h=1e-2"]),
    dict(name="isosceles-slider", scene=isosceles_scene(), fact=isosceles_fact, time=0.5, at=every(0.05, 0.5),
         methods=REGULAR),
]
