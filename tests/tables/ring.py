# SPDX-License-Identifier: GPL-3.0-or-later
# usage: ring.py PROGRAM [N...]
# The closed ring of n links, 10 seconds, by every formulation: gap and energy, or why it ended early. Fixed steps of 0.012 s / n,
# the scene's own; radau5 chooses its own (rtol = 1e-6). The motion is chaotic, so positions are not compared.
import json
import subprocess
import sys

from every_method import FIRST_INTEGRATOR, ask

SIZES = (3, 4, 5, 6, 8, 10, 12, 16, 20, 27, 35)
# one formulation of each family; at 100 links the null space and coordinate partitioning take four minutes each, and Radau half an hour
FAMILIES = ("baumgarte", "projection", "nullspace", "partitioning", "penalty", "ggl")
LONG = {60: FAMILIES, 100: FAMILIES}
DURATION = 10
HEADINGS = "  n  method                           freedoms  outcome    t [s]  worst gap [m]  energy change / range  operations"


def pairs(program):
    for f in json.loads(ask(program, "list", "methods")[1])["formulations"]:
        yield f["name"], next((s for s in FIRST_INTEGRATOR if s in f["integrators"]), f["integrators"][0])


def line(program, n, formulation, integrator):
    step = "rtol=1e-6" if integrator == "radau5" else f"h={0.012 / n:.6g}"
    method = f"{formulation}@{integrator}:{step}"
    words = [program, "run", "ring", "--set", f"n={n}", "--method", method]
    done = subprocess.run(
        [*words, "--time", str(DURATION), "--every", "0.05", "--json"], capture_output=True, text=True, check=False
    )
    told = json.loads(done.stdout or done.stderr)
    if done.returncode not in (0, 4):
        return f"{n:3}  {method:32} {n - 2:8}  refused: {told['errors'][0]['detail']}"
    energy = told["samples"]["energy"]
    # a ring of circumference C = 3 m and mass m = 2 kg that hangs down has about m g C / pi less energy than one that stands up
    spread = 2 * 9.81 * 3 / 3.14159265
    change = max((abs(e - energy[0]) for e in energy), default=0) / spread
    outcome = "finished" if done.returncode == 0 else "stopped"
    why = f"  {told['reason']}" if told["reason"] else ""
    return (
        f"{n:3}  {method:32} {n - 2:8}  {outcome:9} {told['t_reached']:6.4g}  {told['worst_gap']:13.1e}"
        f"  {change:21.1e}  {told['cost']['operations']:10.2e}{why}"
    )


def main():
    program = sys.argv[1]
    sizes = [int(n) for n in sys.argv[2:]] or [*SIZES, *LONG]
    print("The closed ring of n links, 10 s from a polygon at rest, by every formulation (steps of 0.012 s / n)\n")
    print(HEADINGS)
    for n in sizes:
        for formulation, integrator in pairs(program):
            if n in LONG and formulation not in LONG[n]:
                continue
            print(line(program, n, formulation, integrator), flush=True)


if __name__ == "__main__":
    main()
