# SPDX-License-Identifier: GPL-3.0-or-later
"""Plane linkages against compass-and-ruler geometry: the closed pose at the angle that the crank has reached."""
import math

from workshop import angle, circles, every, pin, plate, polar, rod, scene, slide, turned

# [m, rad] projection and partitioning close to rounding; radau5 with rtol = 1e-9 is read between its steps, in lengths up to 5 m;
# rtol limits the error of one step, and errors of 2.4e-8 were measured
CLOSE = 4e-8


def four_bar(name, crank, coupler, rocker, base, start, side, rate=3.0, gravity=None):
    """Crank th1 at (0, 0), rocker th3 at (base, 0); the loop is cut at the end of the coupler."""
    b = circles(polar((0, 0), crank, start), coupler, (base, 0), rocker, side)
    a = polar((0, 0), crank, start)
    return scene(
        name,
        [rod("crank", crank), rod("coupler", coupler), rod("rocker", rocker)],
        [pin("th1", "ground", (0, 0), "crank"), pin("a2", "crank", (crank, 0), "coupler"),
         pin("th3", "ground", (base, 0), "rocker"), pin("B", "coupler", (coupler, 0), "rocker", (rocker, 0), cut=True)],
        {"th1": start, "a2": [angle(a, b) - start], "th3": [angle((base, 0), b)]}, {"th1": rate}, gravity)


def same_pose(motion, crank, coupler, rocker, base, side):
    """Both dependent angles by circle intersection. The side holds where the linkage does not pass a dead point."""
    for th1, a2, th3 in zip(motion.q("th1"), motion.q("a2"), motion.q("th3")):
        a = polar((0, 0), crank, th1)
        b = circles(a, coupler, (base, 0), rocker, side)
        yield "coupler", turned(th1 + a2, angle(a, b)), 0, CLOSE
        yield "rocker", turned(th3, angle((base, 0), b)), 0, CLOSE


def chebyshev(motion):
    """Cranks 5, coupler 2, base 4: the middle of the coupler is at height 4 exactly for x = 0, 2, 4, and near it between."""
    yield from same_pose(motion, 5, 2, 5, 4, -1)
    for th1, a2 in zip(motion.q("th1"), motion.q("a2")):
        x, y = polar(polar((0, 0), 5, th1), 1, th1 + a2)
        if 0 <= x <= 4:
            # its own polynomial: no more than 0.026 above or below the chord (found by scanning the circle construction)
            yield f"height at x = {x:.2f}", y, 4, 0.026


def hoecken(motion):
    """Crank 1, base 2, coupler and rocker 2.5, the pen 2.5 beyond: straight for half a turn, the pen's own construction."""
    yield from same_pose(motion, 1, 2.5, 2.5, 2, 1)


def grashof_turns(motion):
    """A crank-rocker's crank keeps turning one way while the rocker swings between two circle intersections."""
    swing = motion.q("th3")
    outer = circles((0, 0), 1.5 + 0.5, (2, 0), 1.2, 1)   # crank and coupler in one line, drawn out
    inner = circles((0, 0), 1.5 - 0.5, (2, 0), 1.2, 1)   # folded
    low, high = angle((2, 0), outer), angle((2, 0), inner)
    # samples every 10 ms at about 9 rad/s miss a turning point by at most (0.05 rad)^2 of the swing's curvature
    yield "least rocker angle", min(swing), min(low, high), 2e-3
    yield "greatest rocker angle", max(swing), max(low, high), 2e-3
    yield "crank turned", float(motion.q("th1")[-1] > 4 * math.pi), 1.0, 0


def watt(motion):
    """Watt's linkage: the coupler's middle draws a lemniscate, whose points lie on the line of symmetry to third order."""
    for th1, a2, th3 in zip(motion.q("th1"), motion.q("a2"), motion.q("th3")):
        a = polar((0, 0), 3, th1)
        b = polar(a, 1, th1 + a2)
        c = polar((6, 1), 3, th3)
        yield "closed", math.hypot(b[0] - c[0], b[1] - c[1]), 0, CLOSE
        middle = ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
        # by symmetry about (3, 0.5) the deviation is odd in the height: for 20 degrees of swing below one hundredth of the arm
        yield "straight", middle[0], 3, 0.03


def watt_scene():
    return scene("watt", [rod("left", 3), rod("coupler", 1), rod("right", 3)],
                 [pin("th1", "ground", (0, 0), "left"), pin("a2", "left", (3, 0), "coupler"),
                  pin("th3", "ground", (6, 1), "right"), pin("B", "coupler", (1, 0), "right", (3, 0), cut=True)],
                 {"th1": 0.3, "a2": [1.2], "th3": [3.4]}, {"th1": 0.0})


def hart(motion):
    """Hart's inversor: O, P, Q at fixed fractions of the sides of an antiparallelogram keep |OP| |OQ|; with P on a circle
    through O, Q draws a straight line."""
    xs = []
    for th, a, b in zip(motion.q("ab"), motion.q("bc"), motion.q("ad")):
        A = (motion_x(motion, "ax", len(xs)), motion_x(motion, "ay", len(xs)))
        AB = th
        B = polar(A, 4, AB)
        C = polar(B, 2, AB + a)
        D = polar(A, 2, AB + b)
        yield "closed", abs(math.hypot(C[0] - D[0], C[1] - D[1]) - 4), 0, CLOSE
        Q = (B[0] + (C[0] - B[0]) / 2, B[1] + (C[1] - B[1]) / 2)
        xs.append(Q)
    # the line is perpendicular to the one through O and the circle's centre
    for Q in xs:
        yield "straight", Q[0], xs[0][0], 1e-8


def motion_x(motion, name, k):
    return motion.q(name)[k]


def hart_scene():
    """AB = CD = 4, BC = AD = 2. O, P, Q are the middles of AB, AD, BC: parallel to the diagonals, so O P Q lie on one line."""
    # antiparallelogram with diagonals AC and BD parallel: |AC| |BD| = AB^2 - AD^2 = 12, so |OP| |OQ| = 3
    # a symmetric trapezium: put AC and BD horizontally, at heights 0 and h
    s = 2.5                       # |BD| / 2
    r = 12 / (2 * s) / 2          # |AC| / 2
    h = math.sqrt(16 - (s + r)**2)
    A, C, B, D = (-r, 0.0), (r, 0.0), (s, h), (-s, h)
    mid = lambda u, v: ((u[0] + v[0]) / 2, (u[1] + v[1]) / 2)
    O, P = mid(A, B), mid(A, D)
    shift = lambda p: (p[0] - O[0], p[1] - O[1])
    A, B, C, D, P = map(shift, (A, B, C, D, P))
    half = abs(P[0]) / 2          # the centre of P's circle, on the line of O and P: the circle passes through O
    centre = (P[0] / 2, 0.0)
    ab, bc, ad, dc = angle(A, B), angle(B, C), angle(A, D), angle(D, C)
    # AB turns about O, which is fixed; A's place is told by two massless sliders so that its coordinates are there to read
    bodies = [{"name": "cross", "mass": 0.1}, {"name": "carriage", "mass": 0.1}, rod("AB", 4), rod("BC", 2), rod("AD", 2),
              rod("DC", 4), rod("arm", half)]
    joints = [slide("ax", "ground", (0, 0), (1, 0, 0), "cross"), slide("ay", "cross", (0, 0), (0, 1, 0), "carriage"),
              pin("ab", "carriage", (0, 0), "AB"), pin("O", "ground", (0, 0), "AB", (2, 0), cut=True),
              pin("bc", "AB", (4, 0), "BC"), pin("ad", "AB", (0, 0), "AD"), pin("dc", "AD", (2, 0), "DC"),
              pin("C", "DC", (4, 0), "BC", (2, 0), cut=True), pin("arm", "ground", centre, "arm"),
              pin("P", "arm", (half, 0), "AD", (1, 0), cut=True)]
    return scene("hart", bodies, joints,
                 {"ax": [A[0]], "ay": [A[1]], "ab": [ab], "bc": [bc - ab], "ad": [ad - ab], "dc": [dc - ad],
                  "arm": angle(centre, P)}, {"arm": 0.4})


# ---- legs ----

JANSEN = dict(a=38.0, b=41.5, c=39.3, d=40.1, e=55.8, f=39.4, g=36.7, h=65.7, i=49.0, j=50.0, k=61.9, l=7.8, m=15.0)


def jansen_pose(theta):
    """Theo Jansen's eleven holy numbers by five circle intersections: crank m at (0, 0), frame pivot at (-a, -l)."""
    n = JANSEN
    frame = (-n["a"], -n["l"])
    crank = polar((0, 0), n["m"], theta)
    up = circles(crank, n["j"], frame, n["b"], 1)
    if up[1] < frame[1]:
        up = circles(crank, n["j"], frame, n["b"], -1)
    down = circles(crank, n["k"], frame, n["c"], 1)
    if down[1] > frame[1]:
        down = circles(crank, n["k"], frame, n["c"], -1)
    left = min(circles(up, n["e"], frame, n["d"], 1), circles(up, n["e"], frame, n["d"], -1))
    knee = min(circles(left, n["f"], down, n["g"], 1), circles(left, n["f"], down, n["g"], -1))
    foot = min((circles(knee, n["h"], down, n["i"], s) for s in (1, -1)), key=lambda p: p[1])
    return dict(crank=crank, up=up, down=down, left=left, knee=knee, foot=foot, frame=frame)


def triangle(name, third, base, mass=1.0):
    """A plate with corners (0, 0), (base, 0), third."""
    com = ((base + third[0]) / 3, third[1] / 3)
    return plate(name, mass, com, mass * 200.0)


def local(origin, toward, point):
    """The point in the frame at origin with its x axis through toward."""
    phi = angle(origin, toward)
    dx, dy = point[0] - origin[0], point[1] - origin[1]
    return (dx * math.cos(phi) + dy * math.sin(phi), -dx * math.sin(phi) + dy * math.cos(phi))


def jansen_scene():
    n, theta = JANSEN, 0.4
    p = jansen_pose(theta)
    frame = p["frame"]
    upper_third = local(frame, p["up"], p["left"])
    lower_third = local(p["down"], p["knee"], p["foot"])
    bodies = [rod("crank", n["m"]), rod("j", n["j"]), rod("k", n["k"]), triangle("upper", upper_third, n["b"]), rod("c", n["c"]),
              rod("f", n["f"]), triangle("foot", lower_third, n["g"])]
    joints = [pin("th", "ground", (0, 0), "crank"), pin("j", "crank", (n["m"], 0), "j"), pin("k", "crank", (n["m"], 0), "k"),
              pin("upper", "ground", frame, "upper"), pin("c", "ground", frame, "c"),
              pin("J", "j", (n["j"], 0), "upper", (n["b"], 0), cut=True), pin("K", "k", (n["k"], 0), "c", (n["c"], 0), cut=True),
              pin("f", "upper", upper_third, "f"), pin("foot", "c", (n["c"], 0), "foot"),
              pin("F", "f", (n["f"], 0), "foot", (n["g"], 0), cut=True)]
    at = lambda u, v: angle(p[u], p[v])
    positions = {"th": theta, "j": [at("crank", "up") - theta], "k": [at("crank", "down") - theta], "upper": [at("frame", "up")],
                 "c": [at("frame", "down")], "f": [at("left", "knee") - at("frame", "up")],
                 "foot": [at("down", "knee") - at("frame", "down")]}
    return scene("jansen", bodies, joints, positions, {"th": 6.0})


def jansen(motion):
    n = JANSEN
    third = local(jansen_pose(0.4)["down"], jansen_pose(0.4)["knee"], jansen_pose(0.4)["foot"])
    for th, c, foot in zip(motion.q("th"), motion.q("c"), motion.q("foot")):
        p = jansen_pose(th)
        down = polar(p["frame"], n["c"], c)
        phi = c + foot
        x = down[0] + third[0] * math.cos(phi) - third[1] * math.sin(phi)
        y = down[1] + third[0] * math.sin(phi) + third[1] * math.cos(phi)
        # lengths are of the order of 100
        yield f"foot at {th:.2f} rad", math.hypot(x - p["foot"][0], y - p["foot"][1]), 0, 100 * CLOSE


def driven_jansen_scene():
    """The same leg, its crank turned by a motor: no freedom is left, nothing but the drive bounds a step."""
    made = jansen_scene()
    made["start"]["positions"]["th"], made["start"]["rates"] = {"guess": 0.4}, {}
    made["constraints"] = [{"name": "motor", "motion": {"joint": "th", "value": "0.4 + 40*t"}}]
    return {**made, "name": "driven-jansen"}


def driven_jansen(motion):
    yield from jansen(motion)
    for t, th in zip(motion.t, motion.q("th")):
        yield "crank", th, 0.4 + 40 * t, CLOSE
    told = [i["message"] for i in motion.document["incidents"]]
    yield f"reports {told}", len(told), 0, 0


# ---- sliders, suspensions, presses ----


def offset_slider(motion):
    """Stroke of an offset slider-crank: sqrt((l + r)^2 - e^2) - sqrt((l - r)^2 - e^2)."""
    r, l, e = 0.3, 1.0, 0.2
    for th, x in zip(motion.q("th"), motion.q("x")):
        yield "slider", x, r * math.cos(th) + math.sqrt(l**2 - (r * math.sin(th) - e)**2), CLOSE
    stroke = math.sqrt((l + r)**2 - e**2) - math.sqrt((l - r)**2 - e**2)
    # samples every 2 ms at 8 rad/s: the ends are missed by at most r (8 * 0.001)^2 / 2 * 1.5
    yield "stroke", max(motion.q("x")) - min(motion.q("x")), stroke, 2e-5


def offset_slider_scene():
    return scene("offset-slider-crank", [rod("crank", 0.3), rod("rod", 1.0), {"name": "piston", "mass": 0.5}],
                 [pin("th", "ground", (0, 0), "crank"), pin("a", "crank", (0.3, 0), "rod"),
                  slide("x", "ground", (0, 0.2), (1, 0, 0), "piston"), pin("B", "rod", (1.0, 0), "piston", cut=True)],
                 {"th": 0.5, "a": [-0.4], "x": [1.2]}, {"th": 8.0})


def wishbone_pose(low):
    a = polar((0, 0), 0.5, low)
    b = circles(a, 0.29, (0.1, 0.25), 0.37, -1)
    return a, b


def wishbone(motion):
    """Double wishbone: camber of the upright by circle intersection; it swings in its spring, energy kept."""
    for low, up in zip(motion.q("low"), motion.q("upright")):
        a, b = wishbone_pose(low)
        yield "camber", turned(low + up, angle(a, b)), 0, CLOSE
    scale = max(abs(e) for e in motion.energy)
    yield "energy", (max(motion.energy) - min(motion.energy)) / scale, 0, 1e-7
    yield "moves", float(max(motion.q("low")) - min(motion.q("low")) > 0.02), 1.0, 0


def wishbone_scene():
    low = -0.1
    a, b = wishbone_pose(low)
    return scene("double-wishbone", [rod("lower", 0.5, 2), plate("wheel", 15, (0.05, 0.125), 0.4), rod("upper", 0.37, 1.5)],
                 [pin("low", "ground", (0, 0), "lower"), pin("upright", "lower", (0.5, 0), "wheel"),
                  pin("up", "ground", (0.1, 0.25), "upper"), pin("B", "wheel", (0.29, 0), "upper", (0.37, 0), cut=True)],
                 {"low": low, "upright": [angle(a, b) - low], "up": [angle((0.1, 0.25), b)]}, {"low": 0}, [0, -9.81, 0],
                 loads=[{"spring": {"from": {"body": "ground", "at": [0.15, 0.5]}, "to": {"body": "lower", "at": [0.35, 0]},
                                    "stiffness": 12000, "rest": 0.555}}])


def scissor(motion):
    """A scissor lift of one pair of arms 2a with a load W on the platform, arms without mass, pushed at the floor:
    virtual work gives the push F = W / tan(theta), whatever the height."""
    a, weight = 0.6, 50 * 9.81
    for x, f in zip(motion.q("x"), motion.row("hold")):
        theta = math.acos(x / (2 * a))
        # the drive stands still: the force along x that holds the foot
        yield "push", abs(f), weight / math.tan(theta), 1e-6 * weight


def scissor_scene():
    a, theta = 0.6, 0.7
    foot, top = 2 * a * math.cos(theta), 2 * a * math.sin(theta)
    bodies = [{"name": "foot", "mass": 0.0}, rod("arm1", 2 * a, 0.0), rod("arm2", 2 * a, 0.0), {"name": "shoe", "mass": 0.0},
              {"name": "platform", "mass": 50.0, "com": [foot / 2, 0, 0], "inertia": {"zz": 1.0}}]
    joints = [pin("th1", "ground", (0, 0), "arm1"), slide("x", "ground", (0, 0), (1, 0, 0), "foot"),
              pin("th2", "foot", (0, 0), "arm2"), pin("mid", "arm1", (a, 0), "arm2", (a, 0), cut=True),
              pin("p", "arm2", (2 * a, 0), "platform"), slide("s", "platform", (0, 0), (1, 0, 0), "shoe"),
              pin("top", "arm1", (2 * a, 0), "shoe", cut=True)]
    return scene("scissor-lift", bodies, joints,
                 {"th1": [theta], "x": [foot], "th2": [math.pi - theta], "p": [theta - math.pi], "s": [foot]}, {}, [0, -9.81, 0],
                 constraints=[{"name": "hold", "motion": {"coordinate": "x", "value": foot}}])


def toggle(motion):
    """A toggle press near its dead point: equal links at angle alpha to the line of the ram pass a force P at the knee on as
    P / (2 tan alpha) to the ram (all without weight; the ram stands on a motion)."""
    for th, f in zip(motion.q("th"), motion.row("work")):
        alpha = math.pi / 2 - th
        yield "ram force", abs(f), 1000 / (2 * math.tan(alpha)), 1e-6 * 1000 / (2 * math.tan(alpha))


def toggle_scene():
    l, alpha = 0.4, 0.08
    return scene("toggle-press", [rod("upper", l), rod("lower", l), {"name": "ram", "mass": 1.0}],
                 [pin("th", "ground", (0, 0), "upper"), pin("knee", "upper", (l, 0), "lower"),
                  slide("y", "ground", (0, 0), (0, 1, 0), "ram"), pin("B", "lower", (l, 0), "ram", cut=True)],
                 {"th": [math.pi / 2 - alpha], "knee": [2 * alpha], "y": [2 * l * math.cos(alpha)]}, {},
                 constraints=[{"name": "work", "motion": {"coordinate": "y", "value": 2 * l * math.cos(alpha)}}],
                 loads=[{"force": {"at": {"body": "upper", "at": [l, 0]}, "value": [-1000, 0]}}])


def bucket(motion):
    """A hydraulic cylinder between ground and arm: the arm's angle by the law of cosines from the cylinder's length."""
    d, r = math.hypot(0.4, 0.3), 0.7
    base = math.atan2(-0.3, 0.4)
    for s, th in zip(motion.q("s"), motion.q("arm")):
        length = 0.5 + s
        opening = math.acos((d**2 + r**2 - length**2) / (2 * d * r))
        yield "arm", turned(th, base + opening), 0, CLOSE
    for t, s in zip(motion.t, motion.q("s")):
        yield "drive", s, 0.1 + 0.15 * math.sin(t), 2 * CLOSE


def bucket_scene():
    d, r, length = math.hypot(0.4, 0.3), 0.7, 0.6
    th = math.atan2(-0.3, 0.4) + math.acos((d**2 + r**2 - length**2) / (2 * d * r))
    tip = polar((0, 0), r, th)
    return scene("excavator-arm", [rod("arm", 2.0, 30), rod("barrel", 0.5, 5), rod("piston", 0.5, 4)],
                 [pin("arm", "ground", (0, 0), "arm"), pin("barrel", "ground", (0.4, -0.3), "barrel"),
                  slide("s", "barrel", (0, 0), (1, 0, 0), "piston"), pin("B", "piston", (0.5, 0), "arm", (0.7, 0), cut=True)],
                 {"arm": [th], "barrel": [angle((0.4, -0.3), tip)], "s": [0.1]}, {}, [0, -9.81, 0],
                 constraints=[{"name": "cylinder", "motion": {"coordinate": "s", "value": "0.1 + 0.15*sin(t)"}}])


DRIVEN = ["projection@rk4:h=1e-3", "ggl@radau5:rtol=1e-9", "index1@dop853:rtol=1e-11"]

LINKAGES = [
    dict(name="chebyshev", scene=four_bar("chebyshev", 5, 2, 5, 4, math.acos(0.2) - 0.2, -1, rate=-0.3), fact=chebyshev, time=1.5,
         at=every(0.05, 1.5)),
    dict(name="hoecken", scene=four_bar("hoecken", 1, 2.5, 2.5, 2, 0.5, 1), fact=hoecken, time=3, at=every(0.05, 3)),
    dict(name="crank-rocker", scene=four_bar("crank-rocker", 0.5, 1.5, 1.2, 2, 1.0, 1, rate=9.0), fact=grashof_turns, time=3,
         at=every(0.01, 3)),
    dict(name="watt", scene=watt_scene(), fact=watt, time=1, at=every(0.05, 1)),
    dict(name="hart", scene=hart_scene(), fact=hart, time=1, at=every(0.05, 1)),
    dict(name="jansen", scene=jansen_scene(), fact=jansen, time=1.2, at=every(0.02, 1.2)),
    # four turns; rk4 with steps of 0.4 rad
    dict(name="driven-jansen", scene=driven_jansen_scene(), fact=driven_jansen, time=0.63, at=every(0.007, 0.63),
         methods=["partitioning@dop853:rtol=1e-10", "reduced@dopri5:rtol=1e-6", "projection@rk4:h=1e-2"]),
    dict(name="offset-slider-crank", scene=offset_slider_scene(), fact=offset_slider, time=2, at=every(0.002, 2)),
    dict(name="double-wishbone", scene=wishbone_scene(), fact=wishbone, time=1, at=every(0.01, 1)),
    dict(name="scissor-lift", scene=scissor_scene(), fact=scissor, time=0.1, at=[0.05, 0.1],
         methods=["projection@rk4:h=1e-3", "index3@radau5:rtol=1e-9", "index1@dop853:rtol=1e-11"]),
    dict(name="toggle-press", scene=toggle_scene(), fact=toggle, time=0.1, at=[0.05, 0.1], methods=DRIVEN),
    dict(name="excavator-arm", scene=bucket_scene(), fact=bucket, time=2, at=every(0.05, 2), methods=DRIVEN),
]
