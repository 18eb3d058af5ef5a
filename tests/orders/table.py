# usage: table.py PROGRAM [SCENE...]
# Measures the order of every pair of formulation and integrator with a fixed step: positions, speeds, multipliers
# recomputed from the saddle system, and the scheme's own ("raw") multipliers, against what theory says.
#
# Order: median of log2(error at h / error at h / 2) over the last points before errors stop falling, above the reference's. The reference is
# projection@dop853; partitioning@dop853 says to how many digits it can be trusted. An order more than 0.2 from theory has
# to have its reason in NOTES, or this program fails.
import concurrent.futures
import json
import math
import os
import subprocess
import sys

STEPS = [6 * 2**k for k in range(9)]
MOST_POINTS, FEWEST_POINTS = 6, 3
NEAR = 0.2
FALLS = 0.1   # a local order below this is none
SLOWER = 0.6  # of the median local order so far: errors have come near a level at which they stay
SCENES = [
    # name, file, end of the run [s], what it is
    ("fb0", "lessons/01-closed-loops/scenes/fb0.json", 1.0, "four-bar in angles, mass turns with the links"),
    ("pendulum", "tests/orders/cartesian-pendulum.json", 1.0, "Cartesian coordinates, constant mass"),
    ("spatial", "lessons/03-space-and-drives/scenes/spatial-slider-crank.json", 0.2, "spatial slider-crank with ball joints"),
    ("bennett", "lessons/02-mechanisms/scenes/bennett.json", 0.2, "spatial loop with dependent rows"),
]
QUANTITIES = ("q", "v", "lambda", "raw")
DEPENDENT = ("bennett",)  # single multipliers are not determined: those of a scheme are not compared

# Orders of q, v, lambda and raw where they are not the integrator's order in q, v and lambda.
# (formulation or *, integrator or *): (orders, why)
THEORY = {
    ("*", "hem3"): ((3, 3, 3, 2), "raw: the last stage's multiplier"),
    ("*", "hem4"): ((4, 4, 4, 2), "raw: the last stage's multiplier"),
    ("*", "half-explicit-rk4"): ((3, 3, 3, 1), "order conditions of index 2 are not met"),
    ("*", "rattle"): ((2, 2, 2, 1), "raw: belongs to one side of the step's end"),
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
# Where measurement and theory part, and why: (scene or *, formulation or *, integrator or *): reason
NOTES = {
    ("*", "penalty", "*"): "the error of the penalty itself stands below every h",
    ("*", "nullspace-as-printed", "*"): "converges to another motion: a term is missing",
    ("*", "nullspace-untracked", "*"): "the basis changes its sign: no order",
    ("fb0", "*", "hht"): "order 2 for constant mass only",
    ("spatial", "*", "hht"): "order 2 for constant mass only",
    ("bennett", "*", "hht"): "order 2 for constant mass only",
    ("pendulum", "baumgarte", "implicit-euler"): "the error of lambda changes its sign between these steps",
    ("pendulum", "baumgarte", "euler"): "the error of lambda changes its sign between these steps",
    ("bennett", "index2", "*"): "rows that depend on each other part where positions drift",
    ("*", "*", "gauss3"): "few steps between the roughest and rounding",
    ("*", "*", "radau5"): "few steps between the roughest and the noise of its own iteration",
    ("bennett", "*", "rk4"): "at the reference's own error after a few halvings",
    ("bennett", "projection", "*"): "where the step opens the loop, rows that depend on each other part",
    ("bennett", "augmented-lagrangian", "*"): "where the step opens the loop, rows that depend on each other part",
    ("bennett", "udwadia-kalaba", "*"): "takes rows that parted by rounding for independent ones",
    ("*", "index3", "trapezoidal"): "speeds and multipliers swing from step to step, growing slowly",
}


def look_up(table, *key):
    """The entry of the first pattern that fits, most special first."""
    for bits in range(2 ** len(key)):
        pattern = tuple("*" if bits >> i & 1 else k for i, k in enumerate(key))
        if pattern in table:
            return table[pattern]
    return None


def run(program, scene, end, method):
    command = [program, "run", scene, "--method", method, "--at", repr(end), "--json", "--raw-lambda"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    try:
        return json.loads(done.stdout)
    except ValueError:
        return {"status": "refused", "reason": done.stderr.strip().splitlines()[0].removeprefix("holonom: ")}


def state(found, end):
    """q, v, lambda, raw at the end, or None when the run did not get there."""
    samples = found.get("samples")
    if not samples or not samples["t"] or abs(samples["t"][-1] - end) > 1e-9:
        return None
    raw = samples.get("raw_lambda") or [None]
    return {"q": samples["q"][-1], "v": samples["v"][-1], "lambda": samples["lambda"][-1], "raw": raw[-1]}


def distance(x, y):
    if x is None or y is None or None in x or None in y:
        return math.inf
    return max((abs(a - b) for a, b in zip(x, y)), default=0)


def falling(points):
    """The points from the first that is followed by a smaller error to the last before errors fall markedly slower than
    they did: there the noise of an iteration inside the step, or of the reference, is reached."""
    kept, slopes = points[:1], []
    for before, here in zip(points, points[1:]):
        s = math.log(before[1] / here[1]) / math.log(before[0] / here[0])
        if slopes and s < SLOWER * sorted(slopes)[len(slopes) // 2]:
            break
        if s <= FALLS:
            kept, slopes = [here], []
            continue
        kept.append(here)
        slopes.append(s)
    return kept


def order(errors, floor):
    """Observed order from [(h, error)]: the median of the last local ones, which a component's error that changes its sign
    does not move. None when fewer points than needed are above the floor."""
    good = [(h, e) for h, e in errors if floor < e < math.inf]
    run_down = falling(good)
    good = (run_down if len(run_down) >= FEWEST_POINTS else good)[-MOST_POINTS:]
    local = sorted(math.log(a[1] / b[1]) / math.log(a[0] / b[0]) for a, b in zip(good, good[1:]))
    n = len(local)
    return (local[(n - 1) // 2] + local[n // 2]) / 2 if n + 1 >= FEWEST_POINTS else None


def measure(program, scene, end, method, tight, reference):
    """Orders of the four quantities, or a text that says why there are none."""
    exact, floors = reference
    errors = {k: [] for k in QUANTITIES}
    reason = ""
    for n in STEPS:
        h = end / n
        found = run(program, scene, end, f"{method}:h={h!r}{tight}")
        at_end = state(found, end)
        if at_end is None:
            reason = found.get("reason") or found["status"]
            continue
        for k in QUANTITIES:
            goal = exact["lambda"] if k == "raw" else exact[k]
            errors[k].append((h, distance(at_end[k], goal)))
    if not errors["q"]:
        return reason
    return {k: order(errors[k], floors[k]) for k in QUANTITIES}


def reference_of(program, scene, end):
    exact = state(run(program, scene, end, "projection@dop853:rtol=1e-13"), end)
    other = state(run(program, scene, end, "partitioning@dop853:rtol=1e-13"), end)
    if exact is None or other is None:
        sys.exit(f"{scene}: the reference does not reach t = {end} s")
    floors = {}
    for k in QUANTITIES:
        kind = "lambda" if k == "raw" else k
        size = max(map(abs, exact[kind]), default=1)
        floors[k] = max(10 * distance(exact[kind], other[kind]), 1e-12 * max(size, 1))
    return exact, floors


def pairs(program):
    methods = json.loads(subprocess.run([program, "list", "methods", "--json"], capture_output=True, text=True,
                                        check=True).stdout)
    steppers = {s["name"]: s for s in methods["integrators"]}
    for f in methods["formulations"]:
        for name in f["integrators"]:
            keys = [s["key"] for s in steppers[name]["settings"]]
            if "h" in keys:
                # where the iteration inside a step follows rtol too, it must not be what is measured
                yield f["name"], name, steppers[name]["order"], ",rtol=1e-14" if "rtol" in keys else ""


def expected(formulation, stepper, p):
    found = look_up(THEORY, formulation, stepper)
    return found if found else ((p, p, p, None), "")


def show(x):
    return "  -  " if x is None else f"{x:5.2f}"


def parted(quantity, found, theory):
    """The scheme's own multipliers may do better than theory promises, on some scenes they do."""
    return found < theory - NEAR if quantity == "raw" else abs(found - theory) > NEAR


def line(scene, formulation, stepper, p, got):
    """One row of the table, and whether it is as it should be."""
    name = f"{scene:9} {formulation + '@' + stepper:38}"
    if isinstance(got, str):
        return f"{name} {got}", True
    theory, why = expected(formulation, stepper, p)
    if scene in DEPENDENT:
        got = {**got, "raw": None}
    parts = [k for k, t in zip(QUANTITIES, theory) if t is not None and got[k] is not None and parted(k, got[k], t)]
    note = look_up(NOTES, scene, formulation, stepper)
    if not note and all(got[k] > t for k, t in zip(QUANTITIES, theory) if k in parts):
        note = "better on this scene than theory promises"
    remark = why if not parts else note or "UNEXPLAINED"
    wants = " ".join("-" if t is None else str(t) for t in theory)
    return f"{name} {' '.join(show(got[k]) for k in QUANTITIES)}   {wants:9} {remark}".rstrip(), remark != "UNEXPLAINED"


def main():
    program = sys.argv[1]
    good = True
    print("Orders measured: positions, speeds, multipliers recomputed, multipliers of the scheme; then theory.")
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for scene, path, end, about in SCENES:
            if sys.argv[2:] and scene not in sys.argv[2:]:
                continue
            reference = reference_of(program, path, end)
            print(f"\n{scene}: {about}, t = {end} s; reference to {max(reference[1]['q'], 1e-16) / 10:.0e} in positions")
            table = list(pairs(program))
            done = pool.map(lambda m: measure(program, path, end, f"{m[0]}@{m[1]}", m[3], reference), table)
            for (formulation, stepper, p, _), got in zip(table, done):
                text, fine = line(scene, formulation, stepper, p, got)
                good &= fine
                print(text, flush=True)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
