# SPDX-License-Identifier: GPL-3.0-or-later
# usage: table.py PROGRAM [SCENE...] [--errors METHOD]
# Measures the order of every pair of formulation and integrator with a fixed step: positions, speeds, multipliers
# recomputed from the saddle system, and the scheme's own ("raw") multipliers, against what theory says.
#
# Error: root mean square over the entries at eight times of the run, so that one entry that passes through the exact value
# at one time hardly counts. Exact is what projection@dop853 at rtol 1e-13 says, known as far as partitioning@dop853 agrees. A
# formulation whose own exact motion is another one (penalty: springs in place of joints) is compared with that, and the
# distance between the two is told.
# Order: slope of the line through the logarithms over the finest window of steps that is straight: over its halvings the slope
# changes by less than STRAIGHT, or by little more than anywhere; errors near the reference's are left out. Steps too coarse for
# the leading term of the error and steps at rounding both bend the line. The window of positions is printed. An order more than 0.2 from theory has to have its reason in REASONS, or this program fails.
# --errors prints the errors themselves.
import concurrent.futures
import fnmatch
import json
import math
import os
import subprocess
import sys

NEAR = 0.2
STRAIGHT = 0.2
FALLS = 0.3  # a slope below it is none
ABOVE = 10   # errors this often the reference's count
TIMES = 8
# steps in a run, by the order the integrator has
STEPS = {1: (64, 128, 256, 512, 1024, 2048), 2: (64, 128, 256, 512, 1024, 2048), 3: (32, 64, 128, 256, 512, 1024),
         4: (32, 64, 128, 256, 512, 1024, 2048), 5: (8, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512),
         6: (8, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512)}
# At steps that are fine enough to show their order these are at the floor of the reference; their order conditions are tested one by one.
NO_WINDOW = ("dopri5", "dop853")
SPAN = 4  # least ratio of the steps of a window
SCENES = [
    # name, file, end of the run [s], what it is
    ("fb0", "lessons/01-closed-loops/scenes/fb0.json", 2.0, "four-bar in angles, mass turns with the links"),
    ("pendulum", "tests/orders/cartesian-pendulum.json", 2.0, "Cartesian coordinates, constant mass"),
    ("spatial", "lessons/09-space-and-drives/scenes/spatial-slider-crank.json", 0.25, "spatial slider-crank with ball joints"),
    ("bennett", "lessons/11-cabinet/scenes/bennett.json", 0.25, "spatial loop with dependent rows"),
]
QUANTITIES = ("q", "v", "lambda", "raw")
# springs that the steps can follow: with the stiff ones of the defaults the leading term shows only below the reference's error
SETTINGS = {"penalty": ":a=1e4", "augmented-lagrangian": ":a=1e4,iterations=4"}
DEPENDENT = ("bennett",)  # single multipliers are not determined: those of a scheme are not compared

# Orders of q, v, lambda and raw where they are not the integrator's order in q, v and lambda.
# (formulation or *, integrator or *): (orders, why)
THEORY = {
    ("*", "hem3"): ((3, 3, 3, 2), "raw: the last stage's multiplier"),
    ("*", "hem4"): ((4, 4, 4, 2), "raw: the last stage's multiplier"),
    ("*", "half-explicit-rk4"): ((3, 3, 3, 1), "order conditions of index 2 are not met"),
    ("*", "rattle"): ((2, 2, 2, 1), "raw: belongs to one side of the step's end"),
    ("*", "hht"): ((1, 1, 1, None), "2 for constant mass alone"),
    ("*", "genalpha"): ((2, 2, 2, 2), "rho = 0.8"),
    ("index3", "radau3"): ((3, 2, 2, 1), "Hairer, Lubich & Roche 1989"),
    ("index2", "radau3"): ((3, 3, 3, 2), "Hairer, Lubich & Roche 1989"),
    ("ggl", "radau3"): ((3, 3, 3, 2), "as index 2"),
    ("index3", "radau5"): ((5, 3, 3, 2), "Hairer, Lubich & Roche 1989"),
    ("index2", "radau5"): ((5, 5, 5, 3), "Hairer, Lubich & Roche 1989"),
    ("ggl", "radau5"): ((5, 5, 5, 3), "as index 2"),
    ("index2", "midpoint"): ((2, 2, 2, 1), "raw: lives at the midpoint"),
    ("index3", "trapezoidal"): ((2, 2, 2, None), "raw and speeds are unstable in the long run"),
    ("ali3p", "trapezoidal"): ((2, 2, 2, None), ""),
}
SQUARED = "errors of the speeds across the path enter lambda squared, those along it are of the order of q"
# The same where it depends on the scene as well.
THEORY_OF_SCENE = {
    ("pendulum", "index3", "radau3"): ((3, 2, 3, 1), SQUARED),
    ("pendulum", "index3", "radau5"): ((5, 3, 5, 2), SQUARED),
    ("pendulum", "index3", "hht"): ((2, 2, 2, None), "2 for constant mass"),
}
FALLING = "slopes of lambda fall from 6.7 to 6.1 over the halvings, then its reference's error is reached"
RISING = "slopes of lambda rise from 5.1 to 5.9 over the halvings, then its reference's error, 1e-12, is reached"
EULER = "the term of order 2 still leads: slopes of q fall from 1.7 to 1.3 over the halvings"
PARTED = "takes rows that parted by rounding for independent ones: what that adds is of the motion's size at every h"
LOCKED = "a step's error opens the loop, rows that depend on each other part, and a solver that takes them all stops the motion"
# Where measurement and theory part, and why: (scene or *, formulation or *, integrator or *): reason
REASONS = {
    ("*", "nullspace-untracked", "*"): "the basis changes its sign: no order",
    ("fb0", "nullspace-as-printed", "*"): "terms of higher order lead on this motion; slopes of lambda turn to theory at the finest steps",
    ("fb0", "penalty", "gauss3"): FALLING,
    ("fb0", "nullspace-tangent", "symplectic-euler"): "slopes of lambda pass through 1.25 and fall to 1.2 at the finest steps",
    ("spatial", "baumgarte", "gauss3"): FALLING,
    ("spatial", "index1", "gauss3"): RISING,
    ("spatial", "udwadia-kalaba", "gauss3"): RISING,
    ("spatial", "nullspace-solver", "gauss3"): RISING,
    ("spatial", "augmented-lagrangian", "gauss3"): FALLING,
    ("spatial", "penalty", "gauss3"): "terms of higher order lead until its own motion's error is reached",
    ("bennett", "augmented-lagrangian", "gauss3"): "terms of higher order lead until the reference's error is reached",
    ("spatial", "index3", "hht"): "the term of order 2 still leads: slopes of q fall from 1.7 to 1.1 over the halvings",
    ("bennett", "penalty", "euler"): EULER,
    ("bennett", "penalty", "symplectic-euler"): EULER,
    ("bennett", "penalty", "implicit-euler"): EULER,
    ("bennett", "augmented-lagrangian", "euler"): EULER,
    ("bennett", "augmented-lagrangian", "symplectic-euler"): EULER,
    ("bennett", "augmented-lagrangian", "implicit-euler"): EULER,
    ("bennett", "index2", "*"): LOCKED,
    ("bennett", "udwadia-kalaba", "*"): PARTED,
    ("spatial", "index3", "radau3"): "the term of order 4 leads above h = 1e-3 s: slopes fall from 3.9 to 3.6",
}


def look_up(table, *key):
    """The entry of the first pattern that fits, most special first."""
    for bits in range(2 ** len(key)):
        pattern = tuple("*" if bits >> i & 1 else k for i, k in enumerate(key))
        if pattern in table:
            return table[pattern]
    return None


def run(program, scene, end, method):
    times = ",".join(repr(end * (i + 1) / TIMES) for i in range(TIMES))
    command = [program, "run", scene, "--method", method, "--at", times, "--json", "--raw-lambda"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    try:
        return json.loads(done.stdout)
    except ValueError:
        return {"status": "refused", "reason": done.stderr.strip().splitlines()[0].removeprefix("holonom: ")}


def states(found):
    """q, v, lambda, raw at all times, each as one list; None when the run did not get to its end."""
    samples = found.get("samples")
    if not samples or len(samples["t"]) != TIMES:
        return None
    raw = samples.get("raw_lambda") or [[None]]
    rows = {"q": samples["q"], "v": samples["v"], "lambda": samples["lambda"], "raw": raw}
    return {k: [x for row in table for x in row or [None]] for k, table in rows.items()}


def distance(x, y):
    """Root mean square of the differences; infinite where there is nothing to compare."""
    if len(x) != len(y) or None in x or None in y:
        return math.inf
    return math.sqrt(sum((a - b) ** 2 for a, b in zip(x, y)) / max(len(x), 1))


def goal(exact, k):
    return exact["lambda" if k == "raw" else k]


def slope(points):
    """Returns the slope of the least-squares line through the logarithms of [(h, error)]."""
    x = [math.log(h) for h, _ in points]
    y = [math.log(e) for _, e in points]
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)


def wobble(points):
    """How much the slopes over halvings of the step differ along these points; infinite for a single halving."""
    local = [slope((a, b)) for a in points for b in points if abs(a[0] / b[0] - 2) < 1e-6]
    return max(local) - min(local) if len(local) > 1 else math.inf


def window(points):
    """The finest window with this ratio of steps that is straight enough; None where there are too few points, or errors do
    not fall."""
    parts = [points[first:last + 1] for last in range(len(points)) for first in range(last)
             if points[first][0] / points[last][0] > SPAN * 0.999]
    bent = [wobble(part) for part in parts]
    enough = max(STRAIGHT, 1.5 * min(bent, default=math.inf))
    straight = [part for part, b in zip(parts, bent) if b <= enough]
    best = min(straight, key=lambda part: (part[-1][0], -len(part)), default=None)
    return best if best and slope(best) > FALLS else None


def measure(program, scene, end, method, p, tight, limit):
    """{quantity: (order, window) or None}, or a text that says why no run got to its end."""
    errors = {k: [] for k in QUANTITIES}
    reason, rounding = "", {}
    for n in STEPS[p]:
        found = run(program, scene, end, f"{method}:h={end / n!r}{tight}")
        got = states(found)
        if got is None:
            reason = found.get("reason") or found["status"]
            continue
        for k in QUANTITIES:
            e = distance(got[k], goal(limit["exact"], k))
            errors[k].append((end / n, e))
    if not errors["q"]:
        return reason, errors
    out = {}
    for k in QUANTITIES:
        least = min((e for _, e in errors[k]), default=0)
        to_least = errors[k][:[e for _, e in errors[k]].index(least) + 1]  # beyond it errors grow again: rounding
        good = [(h, e) for h, e in to_least if ABOVE * limit["floor"][k] < e < math.inf]
        part = window(good)
        out[k] = (slope(part), part) if part else None
        at_floor = [(h, e) for h, e in errors[k] if e <= ABOVE * limit["floor"][k]]
        if not part and at_floor and len(good) < 5:
            rounding[k] = f"{k}: at the reference's own error, {at_floor[0][1]:.0e}, from h = {at_floor[0][0]:.1e} s on"
    out["rounding"] = rounding
    return out, errors


def agreement(x, y):
    """For each quantity how far two computations are apart, no less than what doubles can tell."""
    out = {}
    for k in QUANTITIES:
        size = math.sqrt(sum(v * v for v in goal(x, k)) / max(len(goal(x, k)), 1))
        out[k] = max(distance(goal(x, k), goal(y, k)), 1e-15 * max(size, 1))
    return out


def reference_of(program, scene, end):
    exact = states(run(program, scene, end, "projection@dop853:rtol=1e-13"))
    other = states(run(program, scene, end, "partitioning@dop853:rtol=1e-13"))
    if exact is None or other is None:
        sys.exit(f"{scene}: the reference does not reach t = {end} s")
    return {"exact": exact, "floor": agreement(exact, other), "off": 0}


def limit_of(program, scene, end, formulation, serves, reference):
    """What the formulation converges to: the reference, or a motion of its own, as Gauss 3 has it with small steps."""
    if "gauss3" not in serves:
        return reference
    spelling = f"{formulation}{SETTINGS.get(formulation, '')}@gauss3:h="
    own, rough = (states(run(program, scene, end, f"{spelling}{end / n!r}")) for n in (1024, 768))
    if own is None or rough is None:
        return reference
    off = distance(own["q"], reference["exact"]["q"])
    if off < 1e4 * reference["floor"]["q"]:
        return reference
    return {"exact": own, "floor": agreement(own, rough), "off": off}


def pairs(program):
    methods = json.loads(subprocess.run([program, "list", "methods", "--json"], capture_output=True, text=True,
                                        check=True).stdout)
    steppers = {s["name"]: s for s in methods["integrators"]}
    for f in methods["formulations"]:
        for name in f["integrators"]:
            keys = [s["key"] for s in steppers[name]["options"]]
            if "h" in keys and name not in NO_WINDOW:
                # where the iteration inside a step follows rtol too, it must not be what is measured
                yield f, name, steppers[name]["order"], ",rtol=1e-14" if "rtol" in keys else ""


def expected(scene, formulation, stepper, p):
    found = THEORY_OF_SCENE.get((scene, formulation, stepper)) or look_up(THEORY, formulation, stepper)
    return found if found else ((p, p, p, None), "")


def show(x):
    return "  -  " if x is None else f"{x[0]:5.2f}"


def parted(quantity, found, theory):
    """The scheme's own multipliers may do better than theory promises, on some scenes they do."""
    if found is None:
        return True
    return found[0] < theory - NEAR if quantity == "raw" else abs(found[0] - theory) > NEAR


def line(scene, formulation, stepper, p, got, limit):
    """One row of the table, and whether it is as it should be."""
    name = f"{scene:9} {formulation + '@' + stepper:38}"
    reason = look_up(REASONS, scene, formulation, stepper)
    if isinstance(got, str):
        return f"{name} {got}", True
    theory, why = expected(scene, formulation, stepper, p)
    if scene in DEPENDENT:
        got = {**got, "raw": None}
        theory = (*theory[:3], None)
    parts = [k for k, t in zip(QUANTITIES, theory) if t is not None and parted(k, got[k], t)]
    remarks = [why] if why else []
    if limit["off"]:
        remarks.append(f"to a motion of its own, {limit['off']:.0e} off")
    if limit["floor"]["q"] > 1e-3 * limit["off"] > 0:
        remarks.append(f"which is not found: with 768 and 1024 steps of Gauss 3 it is {limit['floor']['q']:.0e} apart")
        parts = []
    remarks += [got["rounding"][k] for k in parts if k in got["rounding"]]
    parts = [k for k in parts if k not in got["rounding"]]
    if parts:
        remarks.append(reason or "UNEXPLAINED: " + " ".join(parts))
    wants = " ".join("-" if t is None else str(t) for t in theory)
    at = f"{got['q'][1][0][0]:.1e}..{got['q'][1][-1][0]:.1e}" if got["q"] else ""
    text = f"{name} {' '.join(show(got[k]) for k in QUANTITIES)}   {wants:9} {at:18} {'; '.join(remarks)}"
    return text.rstrip(), not parts or reason is not None


def print_errors(errors):
    for k in QUANTITIES:
        print(f"          {k:6}", " ".join(f"{e:.1e}" for _, e in errors[k]))
        print(f"                 ", " ".join(f"{slope(two):7.2f}" for two in zip(errors[k], errors[k][1:])
                                              if 0 < two[0][1] < math.inf and 0 < two[1][1] < math.inf))


def main():
    program, only, wanted = sys.argv[1], sys.argv[2:], None
    if "--errors" in only:
        at = only.index("--errors")
        only, wanted = only[:at], only[at + 1:]
    good = True
    print("Orders measured: positions, speeds, multipliers recomputed, multipliers of the scheme; then theory, and the steps [s]\n"
          "over which positions were fitted.")
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for scene, path, end, about in SCENES:
            if only and scene not in only:
                continue
            reference = reference_of(program, path, end)
            told = ", ".join(f"{reference['floor'][k]:.0e}" for k in QUANTITIES[:3])
            print(f"\n{scene}: {about}, {TIMES} times to {end} s; reference known to {told}")
            table = [(f["name"], f["integrators"], s, p, tight) for f, s, p, tight in pairs(program)
                     if not wanted or any(fnmatch.fnmatch(f"{f['name']}@{s}", w) for w in wanted)]
            serves = {f: i for f, i, *_ in table}
            limits = dict(zip(serves, pool.map(
                lambda f: limit_of(program, path, end, f, serves[f], reference), serves)))
            done = pool.map(lambda m: measure(program, path, end, f"{m[0]}{SETTINGS.get(m[0], '')}@{m[2]}", m[3], m[4], limits[m[0]]), table)
            for (formulation, _, stepper, p, _), (got, errors) in zip(table, done):
                text, fine = line(scene, formulation, stepper, p, got, limits[formulation])
                good &= fine
                print(text, flush=True)
                if wanted is not None:
                    print_errors(errors)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
