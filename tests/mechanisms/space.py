# SPDX-License-Identifier: GPL-3.0-or-later
"""Mechanisms in space: overconstrained loops, joints between oblique axes, tops and governors."""
import math

from linkages import CLOSE
from machines import G, MASSLESS, MOTION, drum
from workshop import ball, every, pin, scene, slide, turned

DOWN = [0, 0, -G]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def about(axis, phi, v):
    """v turned by phi about the unit axis (Rodrigues)."""
    c, s = math.cos(phi), math.sin(phi)
    w = cross(axis, v)
    d = dot(axis, v)
    return [c * x + s * y + (1 - c) * d * a for x, y, a in zip(v, w, axis)]


def joint(name, parent, at, axis, child, on=(0, 0, 0), **more):
    return {"name": name, "type": "revolute", "axis": list(axis), "parent": {"body": parent, "at": list(at)},
            "child": {"body": child, "at": list(on)}, **more}


def conical_fact(motion):
    """A conical pendulum turns with w^2 = g / (l cos a) and stays at its angle."""
    l, a = 1.2, 0.7
    w = math.sqrt(G / (l * math.cos(a)))
    for t, turn, tilt in zip(motion.t, motion.q("turn"), motion.q("tilt")):
        yield "turn", turn, w * t, MOTION * 10
        yield "tilt", tilt, a, 1e-6


def conical_scene():
    l, a = 1.2, 0.7
    return scene("conical-pendulum", [{"name": "post", "mass": 0}, {"name": "bob", "mass": 0.7, "com": [0, 0, -l]}],
                 [joint("turn", "ground", (0, 0, 0), (0, 0, 1), "post"), joint("tilt", "post", (0, 0, 0), (0, -1, 0), "bob")],
                 {"turn": 0, "tilt": a}, {"d_turn": math.sqrt(G / (l * math.cos(a))), "d_tilt": 0}, DOWN)


def hoop_fact(motion):
    """A bead on a hoop that turns with w: from rest at the bottom's neighbourhood its relative energy is kept:
    R^2 a'^2 / 2 - w^2 R^2 sin^2 a / 2 - g R cos a."""
    R, w = 0.5, 6.0

    def kept(a, da):
        return R**2 * da**2 / 2 - w**2 * R**2 * math.sin(a)**2 / 2 - G * R * math.cos(a)

    first = kept(0.2, 0)
    for a, da in zip(motion.q("bead"), motion.v("d_bead")):
        yield "relative energy", kept(a, da), first, 1e-5
    yield "it climbs", float(max(motion.q("bead")) > math.acos(G / (w**2 * R))), 1.0, 0


def hoop_scene():
    return scene("bead-on-hoop", [drum("hoop", 1, 0.1), {"name": "bead", "mass": 0.3, "com": [0, 0, -0.5]}],
                 [joint("turn", "ground", (0, 0, 0), (0, 0, 1), "hoop"), joint("bead", "hoop", (0, 0, 0), (0, -1, 0), "bead")],
                 {"turn": [0], "bead": 0.2}, {"d_bead": 0}, DOWN,
                 constraints=[{"name": "motor", "motion": {"joint": "turn", "value": "6*t"}}])


def sarrus_fact(motion):
    """A Sarrus linkage: two hinged pairs of leaves in perpendicular planes carry the plate along one straight line. Leaves
    without mass: the plate falls freely. Twelve equations for a loop of six joints with one freedom."""
    for t, z in zip(motion.t, motion.q("z")):
        yield "falls freely", z, 0.8 - G * t**2 / 2, MOTION
    for a1, a2, b1, b2, z in zip(motion.q("a1"), motion.q("a2"), motion.q("b1"), motion.q("b2"), motion.q("z")):
        fold = math.asin(z / 1.0)
        for name, lower, upper in (("a", a1, a2), ("b", b1, b2)):
            yield f"leaf {name}", abs(turned(lower, 0)), fold, CLOSE
            yield f"hinge {name}", abs(turned(upper, 0)), 2 * fold, CLOSE


def sarrus_scene():
    """Leaves of 0.5; the plate at height z = 2 * 0.5 sin(fold) above the ground hinges."""
    z = 0.8
    fold = math.asin(z)
    # chain a folds outwards along +x about y, chain b along +y about x
    bodies = [{"name": "plate", "mass": 3, "inertia": {"xx": 0.1, "yy": 0.1, "zz": 0.2}}]
    joints = [{"name": "z", "type": "prismatic", "axis": [0, 0, 1], "parent": {"body": "ground"}, "child": {"body": "plate"}}]
    for leaf, axis, way in (("a", (0, -1, 0), (1, 0, 0)), ("b", (1, 0, 0), (0, 1, 0))):
        out = [0.5 * c for c in way]
        bodies += [{"name": leaf + "_low", "mass": 0}, {"name": leaf + "_high", "mass": 0}]
        joints += [joint(leaf + "1", "ground", [0.3 * c for c in way], axis, leaf + "_low"),
                   joint(leaf + "2", leaf + "_low", out, axis, leaf + "_high"),
                   joint(leaf + "3", leaf + "_high", [-c for c in out], axis, "plate", [0.3 * c for c in way], cut=True)]
    return scene("sarrus", bodies, joints, {"z": z, "a1": [fold], "a2": [-2 * fold], "b1": [fold], "b2": [-2 * fold]}, {"d_z": 0}, DOWN)


def bricard_fact(motion):
    """The threefold-symmetric Bricard loop of six equal links, twists of +90 and -90 degrees in turn: opposite joints move
    alike, and cos p + cos q + cos p cos q = 0 for the two angles p and q (Chen, You & Tarnai 2005)."""
    for a, b, c, d, e in zip(*(motion.q(f"j{i}") for i in range(1, 6))):
        yield "closure", math.cos(a) + math.cos(b) + math.cos(a) * math.cos(b), 0, 20 * CLOSE
        yield "third as first", turned(c, a), 0, 20 * CLOSE
        yield "fourth as second", turned(d, b), 0, 20 * CLOSE
        yield "fifth as first", turned(e, a), 0, 20 * CLOSE
    scale = max(abs(e) for e in motion.energy)
    yield "energy", (max(motion.energy) - min(motion.energy)) / scale, 0, 1e-6
    yield "moves", float(max(motion.q("j1")) - min(motion.q("j1")) > 0.3), 1.0, 0


def bricard_scene():
    """Denavit-Hartenberg: link i carries joint i + 1 at [1, 0, 0] with its axis twisted about x by +-90 degrees."""
    p = 2.0
    q = math.acos(-math.cos(p) / (1 + math.cos(p)))
    bodies = [{"name": f"l{i}", "mass": 1.0, "com": [0.5, 0, 0], "inertia": {"xx": 0.01, "yy": 0.09, "zz": 0.09}} for i in range(1, 6)]
    joints = []
    for i in range(1, 7):
        twist = 1 if i % 2 else -1
        axis = [0, -twist, 0]    # z turned about x by twist * 90 degrees, in the frame of the link before
        parent = "ground" if i == 1 else f"l{i - 1}"
        child = "ground" if i == 6 else f"l{i}"
        at = [0, 0, 0] if i == 1 else [1, 0, 0]
        if i == 1:
            entry = {"name": "j1", "type": "revolute", "axis": [0, 0, 1], "ref": [1, 0, 0], "parent": {"body": "ground", "at": [0, 0, 0]},
                     "child": {"body": "l1"}}
        else:
            entry = {"name": f"j{i}", "type": "revolute", "axis": axis, "ref": [1, 0, 0], "parent": {"body": parent, "at": at},
                     "child": {"body": child, "axis": [0, 0, 1], "ref": [1, 0, 0]}}
        if i == 6:
            # the ground is link 6: its frame's joint 1 stands at [1, 0, 0] with axis z; so joint 6's frame in the world is
            entry["child"] = {"body": "ground", "at": [-1, 0, 0], "axis": [0, twist_axis(6)[1], twist_axis(6)[2]], "ref": [1, 0, 0]}
            entry["cut"] = True
        joints.append(entry)
    return scene("bricard", bodies, joints, {"j1": p, "j2": [q], "j3": [p], "j4": [q], "j5": [p]}, {"d_j1": 0.8})


def twist_axis(i):
    """Axis of joint i in the frame of joint i + 1's link start: z turned back by the twist of link i."""
    twist = 1 if (i + 1) % 2 else -1
    return [0, twist, 0]


def spherical_fact(motion):
    """A spherical four-bar: arcs of 40, 70, 60 and 80 degrees; the angle between the moving axes stays that of the coupler."""
    in_arc, coupler, out_arc, base = (math.radians(d) for d in (40, 70, 60, 80))
    for a, b in zip(motion.q("in"), motion.q("out")):
        first = about([0, 0, 1], a, [math.sin(in_arc), 0, math.cos(in_arc)])
        axis = [math.sin(base), 0, math.cos(base)]
        second = about(axis, b, [math.sin(base + out_arc), 0, math.cos(base + out_arc)])
        yield "coupler arc", math.acos(dot(first, second)), coupler, CLOSE
    yield "moves", float(max(motion.q("in")) - min(motion.q("in")) > 1), 1.0, 0


def spherical_scene():
    in_arc, coupler, out_arc, base = (math.radians(d) for d in (40, 70, 60, 80))
    way = lambda phi: [math.sin(phi), 0, math.cos(phi)]
    solid = lambda name: {"name": name, "mass": 1, "com": [0, 0, 0.3], "inertia": {"xx": 0.02, "yy": 0.03, "zz": 0.02}}
    # the coupler's frame has its first axis along z and its second at the coupler's arc
    joints = [joint("in", "ground", (0, 0, 0), (0, 0, 1), "input"),
              {"name": "c", "type": "revolute", "axis": way(in_arc), "parent": {"body": "input"},
               "child": {"body": "coupler", "axis": [0, 0, 1]}},
              joint("out", "ground", (0, 0, 0), way(base), "output"),
              {"name": "B", "type": "revolute", "axis": way(coupler), "cut": True, "parent": {"body": "coupler"},
               "child": {"body": "output", "axis": way(base + out_arc)}}]
    return scene("spherical-four-bar", [solid("input"), solid("coupler"), solid("output")], joints,
                 {"in": 0.6, "c": [1.0], "out": [1.0]}, {"d_in": 2.0})


def governor_fact(motion):
    """A governor's balls at steady speed: w^2 = g (1 + M / m) / (l cos a), sleeve of mass M on arms of equal length."""
    for a in motion.q("left"):
        yield "angle", a, 0.6, 1e-7
    for z in motion.q("z"):
        yield "sleeve", z, -2 * 0.3 * math.cos(0.6), 1e-7


def governor_scene():
    l, a, m, M = 0.3, 0.6, 0.4, 1.0
    w = math.sqrt(G * (1 + M / m) / (l * math.cos(a)))
    bodies = [drum("shaft", 1, 0.05), {"name": "sleeve", "mass": M, "inertia": {"xx": 1e-3, "yy": 1e-3, "zz": 1e-3}}]
    joints = [joint("turn", "ground", (0, 0, 0), (0, 0, 1), "shaft"),
              {"name": "z", "type": "prismatic", "axis": [0, 0, 1], "parent": {"body": "shaft"}, "child": {"body": "sleeve"}}]
    start = {"turn": [0], "z": [-2 * l * math.cos(a)]}
    for side, way in (("left", -1), ("right", 1)):
        # swings outwards by its coordinate
        bodies += [{"name": side + "_arm", "mass": m, "com": [0, 0, -l]}, {"name": side + "_link", "mass": 0}]
        axis = [0, -way, 0]
        joints += [joint(side, "shaft", (0, 0, 0), axis, side + "_arm"), joint(side + "_k", side + "_arm", (0, 0, -l), axis, side + "_link"),
                   joint(side + "_b", side + "_link", (0, 0, -l), axis, "sleeve", cut=True)]
        start[side] = [a]
        start[side + "_k"] = [-2 * a]
    start["left"] = a
    return scene("governor", bodies, joints, start, {"d_left": 0}, DOWN,
                 constraints=[{"name": "motor", "motion": {"joint": "turn", "value": f"{w!r}*t"}}])


def screw_fact(motion):
    """A screw press: thread of pitch p, torque T against the force F: the nut's reduced mass is I (2 pi / p)^2 + m."""
    i, m, p, torque = 0.01, 5.0, 0.02, 2.0
    k = 2 * math.pi / p
    a = (torque * k - m * G) / (i * k**2 + m)
    for t, z, turn in zip(motion.t, motion.q("way"), motion.q("angle")):
        yield "rise", z, a * t**2 / 2, MOTION
        yield "turn", turn, k * a * t**2 / 2, MOTION * k


def screw_scene():
    return scene("screw-jack", [{"name": "screw", "mass": 5.0, "inertia": {"xx": 0.02, "yy": 0.02, "zz": 0.01}}],
                 [{"name": "j", "type": "cylindrical", "axis": [0, 0, 1], "coordinates": ["angle", "way"], "parent": {"body": "ground"},
                   "child": {"body": "screw"}}], {"angle": 0}, {"d_angle": 0}, DOWN,
                 constraints=[{"name": "thread", "gear": {"coordinates": ["way", "angle"], "ratio": -0.02 / (2 * math.pi)}}],
                 loads=[{"torque": {"coordinate": "angle", "value": 2.0}}])


def double_cardan_fact(motion):
    """Two Hooke joints with their forks in one plane and equal bends: the second undoes what the first did."""
    for a, b in zip(motion.q("in"), motion.q("out")):
        yield "constant velocity", turned(a, b), 0, 10 * CLOSE
    bend = 0.5
    for a, wa, wm in zip(motion.q("in"), motion.v("d_in"), motion.v("d_mid")):
        ratio = math.cos(bend) / (1 - math.sin(bend)**2 * math.sin(a)**2)
        yield "middle shaft", wm, wa * ratio, 1e-6 * abs(wa)


def double_cardan_scene():
    """Input along x, middle bent by 0.5 rad towards y, output along x again; shafts are carried by bearings in the ground."""
    bend = 0.5
    middle = (math.cos(bend), math.sin(bend), 0)
    shaft = lambda name: {"name": name, "mass": 1, "inertia": {"xx": 0.01, "yy": 0.01, "zz": 0.01}}
    bodies = [shaft("a"), shaft("b"), shaft("c")]
    joints = [joint("in", "ground", (0, 0, 0), (1, 0, 0), "a", ref=(0, 0, 1)), joint("mid", "ground", (0, 0, 0), middle, "b", ref=(0, 0, 1)),
              joint("out", "ground", middle, (1, 0, 0), "c", ref=(0, 0, 1))]
    # each cross keeps two fork axes perpendicular: with z for the input's fork the middle's is perpendicular to z and its own shaft
    c, s = math.cos(bend), math.sin(bend)
    condition = lambda a, m: f"sin({a})*cos({m}) - {c!r}*cos({a})*sin({m})"
    return scene("double-cardan", bodies, joints, {"in": 0.3, "mid": [0.3], "out": [0.3]}, {"d_in": 5.0},
                 constraints=[{"name": "cross1", "formula": condition("mid", "in")}, {"name": "cross2", "formula": condition("mid", "out")}])


def precession_fact(motion):
    """A free symmetric body: its axis runs round the angular momentum at L / I_t, keeping its angle to it."""
    i_t, i_a, spin, wobble = 0.3, 0.5, 4.0, 1.5
    L = math.hypot(i_t * wobble, i_a * spin)
    nutation = math.atan2(i_t * wobble, i_a * spin)
    rate = L / i_t
    for t, q in zip(motion.t, zip(*(motion.q(n) for n in ("o_rx", "o_ry", "o_rz")))):
        phi = math.sqrt(dot(q, q))
        axis = about([x / phi for x in q], phi, [0, 0, 1]) if phi else [0, 0, 1]
        # L lies in the body's x-z plane at the start, where body and world agree
        direction = [math.sin(nutation), 0, math.cos(nutation)]
        expected = about(direction, rate * t, [0, 0, 1])
        yield "axis", math.sqrt(sum((x - y)**2 for x, y in zip(axis, expected))), 0, 2e-5


def precession_scene():
    return scene("free-precession", [{"name": "top", "mass": 1, "inertia": {"xx": 0.3, "yy": 0.3, "zz": 0.5}}],
                 [{"name": "o", "type": "spherical", "parent": {"body": "ground"}, "child": {"body": "top"}}],
                 {"o_rx": 0, "o_ry": 0, "o_rz": 0}, {"d_o_rx": 1.5, "d_o_ry": 0, "d_o_rz": 4.0})


def gimbal_fact(motion):
    """A gyroscope's wheel in two massless gimbals, hung with a weight: steady precession m g d / (I w) for a level axle."""
    for t, turn, tilt in zip(motion.t, motion.q("turn"), motion.q("tilt")):
        rate = 0.5 * G * 0.1 / (0.004 * 200)
        yield "precession", turn, rate * t, 2e-3 * rate * t + 1e-9
        yield "level", tilt, 0, 2e-4


def gimbal_scene():
    m, d, i, w = 0.5, 0.1, 0.004, 200.0
    rate = m * G * d / (i * w)
    return scene("gimbal", [{"name": "outer", "mass": 0}, {"name": "inner", "mass": 0},
                            {"name": "wheel", "mass": m, "com": [0.1, 0, 0], "inertia": {"xx": i, "yy": i / 2, "zz": i / 2}}],
                 [joint("turn", "ground", (0, 0, 0), (0, 0, 1), "outer"), joint("tilt", "outer", (0, 0, 0), (0, 1, 0), "inner"),
                  joint("spin", "inner", (0, 0, 0), (1, 0, 0), "wheel")],
                 {"turn": 0, "tilt": 0, "spin": 0}, {"d_turn": rate, "d_tilt": 0, "d_spin": w}, DOWN)


def trifilar_fact(motion):
    """A trifilar pendulum: a plate on three wires turns about its centre and rises by l - sqrt(l^2 - 4 r^2 sin^2(a/2)); the
    energy of this one motion, written down, is kept."""
    l, r, m, i = 1.0, 0.2, 2.0, 0.03

    def drop(a):
        return math.sqrt(l**2 - 4 * r**2 * math.sin(a / 2)**2)

    def kept(a, da):
        slope = -2 * r**2 * math.sin(a / 2) * math.cos(a / 2) / drop(a)
        return i * da**2 / 2 + m * (slope * da)**2 / 2 - m * G * drop(a)

    first = kept(1.0, 0)
    for a, da, z in zip(motion.q("p_angle"), motion.v("d_p_angle"), motion.q("z")):
        yield "height", z, -drop(a), 10 * CLOSE
        yield "energy", kept(a, da), first, 1e-5
    yield "swings back", float(min(motion.q("p_angle")) < -0.5), 1.0, 0


def trifilar_scene():
    l, r = 1.0, 0.2
    corner = lambda k: [r * math.cos(2 * math.pi * k / 3), r * math.sin(2 * math.pi * k / 3)]
    z = -math.sqrt(l**2 - 4 * r**2 * math.sin(0.5)**2)
    return scene("trifilar", [{"name": "lift", "mass": 0}, {"name": "plate", "mass": 2, "inertia": {"xx": 0.015, "yy": 0.015, "zz": 0.03}}],
                 [{"name": "z", "type": "prismatic", "axis": [0, 0, 1], "parent": {"body": "ground"}, "child": {"body": "lift"}},
                  {"name": "p", "type": "planar", "axis": [0, 0, 1], "ref": [1, 0, 0], "parent": {"body": "lift"}, "child": {"body": "plate"}}],
                 {"z": [z], "p_x": [0], "p_y": [0], "p_angle": 1.0}, {"d_p_angle": 0}, DOWN,
                 constraints=[{"name": f"wire{k}", "distance": {"from": [*corner(k), 0], "to": {"body": "plate", "at": corner(k)}, "length": l}}
                              for k in range(3)])


SERVES = ["projection@rk4:h=1e-3", "nullspace@dop853:rtol=1e-10", "index1@dop853:rtol=1e-11"]

SPACE = [
    dict(name="conical-pendulum", scene=conical_scene(), fact=conical_fact, time=5, at=every(0.5, 5)),
    dict(name="bead-on-hoop", scene=hoop_scene(), fact=hoop_fact, time=2, at=every(0.05, 2), methods=MASSLESS),
    dict(name="sarrus", scene=sarrus_scene(), fact=sarrus_fact, time=0.25, at=every(0.05, 0.25), methods=MASSLESS),
    dict(name="bricard", scene=bricard_scene(), fact=bricard_fact, time=1, at=every(0.05, 1), methods=SERVES),
    dict(name="spherical-four-bar", scene=spherical_scene(), fact=spherical_fact, time=2, at=every(0.05, 2), methods=SERVES),
    dict(name="governor", scene=governor_scene(), fact=governor_fact, time=1, at=every(0.1, 1), methods=MASSLESS[:2]),
    dict(name="screw-jack", scene=screw_scene(), fact=screw_fact, time=1, at=every(0.1, 1)),
    dict(name="double-cardan", scene=double_cardan_scene(), fact=double_cardan_fact, time=2, at=every(0.05, 2)),
    dict(name="free-precession", scene=precession_scene(), fact=precession_fact, time=2, at=every(0.05, 2), methods=SERVES[::2]),
    dict(name="gimbal", scene=gimbal_scene(), fact=gimbal_fact, time=0.5, at=every(0.1, 0.5)),
    dict(name="trifilar", scene=trifilar_scene(), fact=trifilar_fact, time=2, at=every(0.05, 2),
         # hanging straight, the wires lose rank (all three rows pull upwards): methods that project pass it
         methods=SERVES[:2]),
]
