# SPDX-License-Identifier: GPL-3.0-or-later
"""10,000 s of the four-bar's turning crank, more than 8000 turns: nothing may depend on how far its angle has wound up.

usage: long_runs.py PROGRAM [SECONDS]   (make long-runs keeps the table in tests/tables/long_runs.txt)
"""

import json
import subprocess
import sys

# the energy of symmetric-projection@midpoint grows with t h^2 on a crank that turns one way round: with h=0.005 it has thirty
# times what it began with after 4,100 s, and no step is found any more
METHODS = ["projection@rk4:h=0.005", "projection@dop853:rtol=1e-8", "symmetric-projection@midpoint:h=0.0025",
           "symmetric-projection@gauss2:h=0.005", "partitioning@gauss2:h=0.005", "reduced@rk4:h=0.005"]


def main():
    program, seconds = sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 1e4
    print("# four-bar: the state after a long run")
    print("%-40s %-12s %9s %9s %10s %10s %9s" % ("method", "status", "t [s]", "turns", "gap [m]", "energy [J]", "steps"))
    for method in METHODS:
        call = [program, "run", "four-bar", "--method", method, "--time", repr(seconds), "--at", repr(seconds), "--json"]
        done = subprocess.run(call, capture_output=True)
        document = json.loads(done.stdout)
        samples = document["samples"]
        turns = samples["q"][-1][0] / 6.283185307179586 if samples["q"] else 0
        print("%-40s %-12s %9.5g %9.1f %10.1e %10.2e %9d" % (method, document["status"], document["t_reached"], turns,
              document["worst_gap"], document["worst_energy_change"], document["cost"]["steps"]), flush=True)


if __name__ == "__main__":
    main()
