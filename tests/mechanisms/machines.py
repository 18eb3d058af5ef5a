# SPDX-License-Identifier: GPL-3.0-or-later
"""Machines of few degrees of freedom whose motion, period or forces have a closed form."""
import math

from linkages import CLOSE, DRIVEN
from workshop import every, pin, plate, rod, scene, slide, turned

G = 9.81
DOWN = [0, -G, 0]

# rk4 with 1 ms, dop853 with 1e-10, radau5 with 1e-9: relative error of a smooth motion over a few seconds
MOTION = 2e-6


def agm_period(length_over_g, amplitude):
    """Period of a pendulum of any amplitude: 2 pi sqrt(l/g) / agm(1, cos(amplitude / 2))."""
    a, b = 1.0, math.cos(amplitude / 2)
    for _ in range(30):
        a, b = (a + b) / 2, math.sqrt(a * b)
    return 2 * math.pi * math.sqrt(length_over_g) / a


def back_at_start(period, count=1):
    return [period * count / 2, period * count]


def drum(name, mass, inertia):
    return {"name": name, "mass": mass, "inertia": {"xx": inertia / 2, "yy": inertia / 2, "zz": inertia}}


def pendulum_fact(motion):
    """A rod of length L swings as a pendulum of 2 L / 3: after half a period it stands on the other side, at rest."""
    th, w = motion.q("th"), motion.v("d_th")
    start = -math.pi / 2 + 2.5
    yield "other side", th[0], -math.pi - start, 1e-5
    yield "back", th[1], start, 1e-5
    yield "at rest", w[1], 0, 1e-4


def atwood_fact(motion):
    """a = (m1 - m2) g / (m1 + m2 + I / R^2); the rope's force on m1 is m1 (g - a)."""
    m1, m2, i, r = 3.0, 2.0, 0.02, 0.1
    a = (m1 - m2) * G / (m1 + m2 + i / r**2)
    for t, y in zip(motion.t, motion.q("y1")):
        yield "fall", y, -a * t**2 / 2, MOTION
    for s in motion.row("left"):
        yield "rope", abs(s), m1 * (G - a), 1e-7


def atwood_scene():
    m1, m2, i, r = 3.0, 2.0, 0.02, 0.1
    return scene("atwood", [{"name": "m1", "mass": m1}, {"name": "m2", "mass": m2}, drum("pulley", 1, i)],
                 [slide("y1", "ground", (-r, -1), (0, 1, 0), "m1"), slide("y2", "ground", (r, -1), (0, 1, 0), "m2"),
                  pin("th", "ground", (0, 0), "pulley")], {"y1": 0}, {"d_y1": 0}, DOWN,
                 constraints=[{"name": "left", "gear": {"coordinates": ["y1", "th"], "ratio": r}},
                              {"name": "right", "gear": {"coordinates": ["y2", "th"], "ratio": -r}}])


def yoyo_fact(motion):
    """A yo-yo unwinds with a = g / (1 + I / (m r^2)); the string carries m (g - a)."""
    m, i, r = 0.2, 5e-5, 0.01
    a = G / (1 + i / (m * r**2))
    for t, y in zip(motion.t, motion.q("y")):
        yield "fall", y, -a * t**2 / 2, MOTION
    for s in motion.row("string"):
        yield "string", abs(s), m * (G - a), 1e-8


def yoyo_scene():
    return scene("yo-yo", [{"name": "hub", "mass": 0.0}, drum("disc", 0.2, 5e-5)],
                 [slide("y", "ground", (0, 0), (0, 1, 0), "hub"), pin("th", "hub", (0, 0), "disc")],
                 {"y": 0}, {"d_y": 0}, DOWN, constraints=[{"name": "string", "gear": {"coordinates": ["y", "th"], "ratio": 0.01}}])


def differential_fact(motion):
    """A planetary gear with a fixed ring: Willis. Sun 20 teeth, planet 15, ring 50: the arm turns 2/7 as fast as the sun."""
    i_sun, i_arm, m, i_planet, r = 0.02, 0.05, 0.5, 0.001, 0.035
    k = 20 / 70
    planet = -(50 / 15 - 1) * k    # absolute spin of the planet for one turn of the sun
    inertia = i_sun + (i_arm + m * r**2) * k**2 + i_planet * planet**2
    for t, s, arm in zip(motion.t, motion.q("sun"), motion.q("arm")):
        yield "sun", s, 0.3 / inertia * t**2 / 2, MOTION * 10
        yield "arm", arm, k * s, 1e-9


def differential_scene():
    return scene("planetary-willis", [drum("s", 1, 0.02), drum("a", 1, 0.05), drum("p", 0.5, 0.001)],
                 [pin("sun", "ground", (0, 0), "s"), pin("arm", "ground", (0, 0), "a"), pin("planet", "a", (0.035, 0), "p")],
                 {"sun": 0, "arm": 0}, {"d_sun": 0}, None,
                 constraints=[{"name": "inner", "formula": "20*(sun - arm) + 15*planet"},
                              {"name": "outer", "formula": "-50*arm - 15*planet"}],
                 loads=[{"torque": {"joint": "sun", "value": 0.3}}])


def cycloid_fact(motion):
    """A bead on a cycloid is isochronous: s = 4 a sin(phi / 2) is harmonic with 4 pi sqrt(a / g), however large."""
    a, s0 = 0.5, 4 * 0.5 * math.sin(1.4 / 2)
    for t, phi in zip(motion.t, motion.q("phi")):
        yield "harmonic", 4 * a * math.sin(phi / 2), s0 * math.cos(math.sqrt(G / (4 * a)) * t), 1e-5


def cycloid_scene():
    return {"holonom": 1, "name": "cycloid",
            "lagrangian": {"coordinates": [{"name": "x", "unit": "m"}, {"name": "y", "unit": "m"}, {"name": "phi"}],
                           "kinetic": "0.5*(d_x^2 + d_y^2)", "potential": "9.81*y",
                           "constraints": ["x - 0.5*(phi + sin(phi))", "y + 0.5*cos(phi)"]},
            "start": {"positions": {"phi": 1.4, "x": {"guess": 1.2}, "y": {"guess": -0.1}}, "rates": {"d_phi": 0}}}


def hinged_rod_fact(motion):
    """A rod falls from upright about its hinge: along the rod the hinge carries m g (5 cos a - 3) / 2 and across m g sin a / 4."""
    for th, f in zip(motion.q("th"), motion.force("th")):
        a = math.pi / 2 - th
        along = f[0] * math.cos(th) + f[1] * math.sin(th)
        across = -f[0] * math.sin(th) + f[1] * math.cos(th)
        start = 0.1
        # the start at a = 0.1 rad instead of 0 takes 3 (1 - cos 0.1) / 2 from the centripetal part
        yield "along", along, 2 * G * (2.5 * math.cos(a) - 1.5 * math.cos(start)), 1e-4
        yield "across", across, 2 * G * math.sin(a) / 4, 1e-4


def ladder_fact(motion):
    """A ladder slides down a smooth wall: from rest at height y0 the wall's force is m g (9 sin(e) - 6 sin(e0)) cos(e) / 4,
    zero at 2/3 of the height, where a real one leaves the wall."""
    m, e0 = 4.0, 1.2
    signs = []
    for th, wall in zip(motion.q("tilt"), motion.row("wall: across 1")):
        e = th                          # elevation of the ladder, its foot at the x axis
        expected = m * G * (9 * math.sin(e) - 6 * math.sin(e0)) * math.cos(e) / 4
        yield "wall", abs(wall), abs(expected), 2e-4
        signs.append((math.sin(e) / math.sin(e0) - 2 / 3, wall))
    above = [w for k, w in signs if k > 0.01]
    below = [w for k, w in signs if k < -0.01]
    yield "changes its sign at 2/3", float(above and below and all(w * above[0] > 0 for w in above) and all(w * above[0] < 0 for w in below)), 1.0, 0


def ladder_scene():
    l, e0 = 3.0, 1.2
    body = rod("ladder", l, 4.0)
    return scene("ladder", [{"name": "nx", "mass": 0}, {"name": "ny", "mass": 0}, body],
                 [slide("x", "ground", (0, 0), (1, 0, 0), "nx"), slide("y", "nx", (0, 0), (0, 1, 0), "ny"),
                  pin("tilt", "ny", (0, 0), "ladder")],
                 {"tilt": e0, "x": [-l * math.cos(e0)], "y": [0]}, {"d_tilt": 0}, DOWN,
                 constraints=[{"name": "floor", "line": {"point": {"body": "ladder", "at": [0, 0]}, "through": [0, 0], "direction": [1, 0]}},
                              {"name": "wall", "line": {"point": {"body": "ladder", "at": [l, 0]}, "through": [0, 0], "direction": [0, 1]}}])


def trammel_scene():
    return scene("elliptic-trammel", [{"name": "a", "mass": 0}, {"name": "b", "mass": 0}, rod("bar", 1.5)],
                 [slide("x", "ground", (0, 0), (1, 0, 0), "a"), slide("y", "ground", (0, 0), (0, -1, 0), "b"),
                  pin("th", "a", (0, 0), "bar"), pin("B", "bar", (1.5, 0), "b", cut=True)],
                 {"x": [1.5 * math.cos(0.3)], "y": [1.5 * math.sin(0.3)], "th": math.pi - 0.3}, {"d_th": -2.0})


def trammel_motion(motion):
    """An elliptic trammel without weight: the rod's energy is m l^2 w^2 / 6 at every angle, so it turns uniformly."""
    for t, th, x, y in zip(motion.t, motion.q("th"), motion.q("x"), motion.q("y")):
        yield "uniform", th, math.pi - 0.3 - 2 * t, MOTION * 5
        yield "foot", x, -1.5 * math.cos(th), CLOSE
        yield "head", y, -1.5 * math.sin(th), CLOSE


def yoke_fact(motion):
    """A Scotch yoke at constant speed: x = r cos(w t); the crank's torque is -m r^2 w^2 sin(wt) cos(wt) (yoke alone has mass)."""
    m, r, w = 2.0, 0.25, 5.0
    for t, x, torque in zip(motion.t, motion.q("x"), motion.row("motor")):
        yield "yoke", x, r * math.cos(w * t), CLOSE
        yield "torque", torque, m * r**2 * w**2 * math.sin(w * t) * math.cos(w * t), 1e-6


def yoke_scene():
    return scene("scotch-yoke", [rod("crank", 0.25, 0.0), {"name": "yoke", "mass": 2.0}],
                 [pin("th", "ground", (0, 0), "crank"), slide("x", "ground", (0, 0), (1, 0, 0), "yoke")],
                 {"th": [0], "x": [0.25]}, {},
                 constraints=[{"name": "motor", "motion": {"joint": "th", "value": "5*t"}},
                              {"name": "slot", "line": {"point": {"body": "crank", "at": [0.25, 0]}, "through": {"body": "yoke", "at": [0, 0]},
                                                        "direction": [0, 1]}}])


def oldham_scene():
    e, a = 0.1, 0.6
    return scene("oldham", [drum("shaft1", 1, 0.01), drum("disc", 0.5, 0.005), drum("shaft2", 1, 0.01)],
                 [pin("in", "ground", (0, 0), "shaft1"), slide("s", "shaft1", (0, 0), (1, 0, 0), "disc"),
                  slide("u", "disc", (0, 0), (0, 1, 0), "shaft2"), pin("out", "ground", (e, 0), "shaft2", cut=True)],
                 {"in": a, "s": [e * math.cos(a)], "u": [-e * math.sin(a)]}, {"d_in": 3.0})


def oldham_motion(motion):
    """Both shafts turn alike (the slots carry the angle over), the disc's centre runs on the circle over the offset."""
    e = 0.1
    for a, s, u in zip(motion.q("in"), motion.q("s"), motion.q("u")):
        yield "slot of the first shaft", s, e * math.cos(a), 4 * CLOSE
        yield "slot of the second shaft", u, -e * math.sin(a), 4 * CLOSE
        yield "circle", math.hypot(s * math.cos(a) - e / 2, s * math.sin(a)), e / 2, 4 * CLOSE


def cam_fact(motion):
    """A harmonic cam lifts a follower under weight and spring: the contact force is m (g + y'') + k (y + y0)."""
    m, e, w, k = 0.8, 0.03, 12.0, 500.0
    for t, y, force in zip(motion.t, motion.q("y"), motion.row("cam")):
        lift = e * (1 - math.cos(w * t))
        yield "lift", y, lift, CLOSE
        yield "force", abs(force), m * (G + e * w**2 * math.cos(w * t)) + k * (lift + 0.05), 1e-6 * k


def cam_scene():
    return scene("cam", [drum("shaft", 1, 0.01), {"name": "follower", "mass": 0.8}],
                 [pin("th", "ground", (0, 0), "shaft"), slide("y", "ground", (0, 0), (0, 1, 0), "follower")],
                 {"th": [0], "y": [0]}, {}, DOWN,
                 constraints=[{"name": "motor", "motion": {"joint": "th", "value": "12*t"}},
                              {"name": "cam", "formula": "y - 0.03*(1 - cos(th))"}],
                 loads=[{"joint_spring": {"joint": "y", "stiffness": 500, "rest": -0.05}}])


def beats_fact(motion):
    """Two bobs on rods without weight, joined by a torsion spring between their angles: exact modes of the small swing."""
    l, k, small = 1.0, 0.5, 1e-3
    slow, fast = math.sqrt(G / l), math.sqrt(G / l + 2 * k / l**2)
    for t, a, b in zip(motion.t, motion.q("a"), motion.q("b")):
        # the cubic term of the sine is worth small^2 / 16 of the phase, 30 rad here; radau5 is within 1e-9 / small
        # of each of its steps
        yield "first", (a + math.pi / 2) / small, (math.cos(slow * t) + math.cos(fast * t)) / 2, 2e-5
        yield "second", (b + math.pi / 2) / small, (math.cos(slow * t) - math.cos(fast * t)) / 2, 2e-5


def beats_scene():
    bob = lambda name: {"name": name, "mass": 1.0, "com": [1.0, 0, 0]}
    return scene("coupled-pendulums", [bob("p"), bob("r")],
                 [pin("a", "ground", (0, 0), "p"), pin("b", "ground", (0.5, 0), "r")],
                 {"a": -math.pi / 2 + 1e-3, "b": -math.pi / 2}, {"d_a": 0, "d_b": 0}, DOWN,
                 loads=[{"torque": {"joint": "a", "value": "-0.5*(a - b)"}}, {"torque": {"joint": "b", "value": "-0.5*(b - a)"}}])


def balance_fact(motion):
    """A balance wheel and its hairspring: the period 2 pi sqrt(I / k) knows no amplitude (here 4.5 rad)."""
    w = math.sqrt(2e-3 / 1.2e-5)
    for t, th in zip(motion.t, motion.q("th")):
        yield "balance", th, 4.5 * math.cos(w * t), 2e-4


def crane_fact(motion):
    """A load hangs from a trolley that accelerates with a: at the angle atan(a / g) it stays where it is."""
    a = 2.0
    for t, th, x in zip(motion.t, motion.q("rope"), motion.q("x")):
        yield "trolley", x, a * t**2 / 2, CLOSE
        yield "angle", th, -math.pi / 2 - math.atan(a / G), 1e-7
    for f in motion.row("motor"):
        yield "drive", abs(f), (5 + 20) * a, 1e-5


def crane_scene():
    return scene("crane", [{"name": "trolley", "mass": 5}, {"name": "load", "mass": 20, "com": [4, 0, 0]}],
                 [slide("x", "ground", (0, 0), (1, 0, 0), "trolley"), pin("rope", "trolley", (0, 0), "load")],
                 {"x": [0], "rope": -math.pi / 2 - math.atan(2 / G)}, {"d_rope": 0}, DOWN,
                 constraints=[{"name": "motor", "motion": {"joint": "x", "value": "t^2"}}])


def planet_in_ring_fact(motion):
    """A disc rolls inside a ring: a pendulum of length 3 (R - r) / 2, by any amplitude."""
    start = -math.pi / 2 + 1.2
    th = motion.q("arm")
    yield "other side", th[0], -math.pi - start, 1e-5
    yield "back", th[1], start, 1e-5


def planet_in_ring_scene():
    R, r, m = 1.0, 0.2, 2.0
    return scene("disc-in-ring", [{"name": "arm", "mass": 0}, drum("disc", m, m * r**2 / 2)],
                 [pin("arm", "ground", (0, 0), "arm"), pin("spin", "arm", (R - r, 0), "disc")],
                 {"arm": -math.pi / 2 + 1.2}, {"d_arm": 0}, DOWN,
                 constraints=[{"name": "no slip", "gear": {"coordinates": ["spin", "arm"], "ratio": R / r}}])


RING_PERIOD = agm_period(1.5 * 0.8 / G, 1.2)
ROD_PERIOD = agm_period(2 / 3 * 1.0 / G, 2.5)
EXPLICIT = ["projection@rk4:h=1e-3", "index1@dop853:rtol=1e-11", "ggl@radau5:rtol=1e-9"]
MASSLESS = ["projection@rk4:h=1e-3", "index1@dop853:rtol=1e-11", "index3@radau5:rtol=1e-9"]

MACHINES = [
    dict(name="rod-pendulum", scene=scene("rod-pendulum", [rod("rod", 1.0)], [pin("th", "ground", (0, 0), "rod")],
                                          {"th": -math.pi / 2 + 2.5}, {"d_th": 0}, DOWN), fact=pendulum_fact, time=ROD_PERIOD,
         at=back_at_start(ROD_PERIOD)),
    dict(name="atwood", scene=atwood_scene(), fact=atwood_fact, time=1, at=every(0.1, 1)),
    dict(name="yo-yo", scene=yoyo_scene(), fact=yoyo_fact, time=1, at=every(0.1, 1), methods=MASSLESS),
    dict(name="planetary-willis", scene=differential_scene(), fact=differential_fact, time=1, at=every(0.1, 1)),
    dict(name="cycloid", scene=cycloid_scene(), fact=cycloid_fact, time=3, at=every(0.1, 3), methods=EXPLICIT[:2] + ["partitioning@dop853:rtol=1e-10"]),
    dict(name="falling-chimney", scene=scene("falling-chimney", [rod("rod", 1.5, 2.0)], [pin("th", "ground", (0, 0), "rod")],
                                             {"th": math.pi / 2 - 0.1}, {"d_th": 0}, DOWN), fact=hinged_rod_fact, time=1.2,
         at=every(0.1, 1.2)),
    dict(name="ladder", scene=ladder_scene(), fact=ladder_fact, time=0.85, at=every(0.05, 0.85), methods=MASSLESS),
    dict(name="elliptic-trammel", scene=trammel_scene(), fact=trammel_motion, time=4, at=every(0.1, 4), methods=MASSLESS),
    dict(name="scotch-yoke", scene=yoke_scene(), fact=yoke_fact, time=2, at=every(0.05, 2), methods=MASSLESS),
    dict(name="oldham", scene=oldham_scene(), fact=oldham_motion, time=3, at=every(0.1, 3)),
    dict(name="cam", scene=cam_scene(), fact=cam_fact, time=1, at=every(0.05, 1), methods=DRIVEN),
    dict(name="coupled-pendulums", scene=beats_scene(), fact=beats_fact, time=10, at=every(0.5, 10)),
    dict(name="balance-wheel", scene=scene("balance-wheel", [drum("wheel", 0.01, 1.2e-5)], [pin("th", "ground", (0, 0), "wheel")],
                                           {"th": 4.5}, {"d_th": 0},
                                           loads=[{"joint_spring": {"joint": "th", "stiffness": 2e-3}}]), fact=balance_fact, time=5,
         at=every(0.25, 5)),
    dict(name="crane", scene=crane_scene(), fact=crane_fact, time=3, at=every(0.5, 3), methods=DRIVEN),
    dict(name="disc-in-ring", scene=planet_in_ring_scene(), fact=planet_in_ring_fact, time=RING_PERIOD, at=back_at_start(RING_PERIOD),
         methods=MASSLESS),
]
