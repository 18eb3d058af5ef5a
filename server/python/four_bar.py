# SPDX-License-Identifier: GPL-3.0-or-later
"""A notebook as a script: the four-bar by five methods. Each part between the marks is a cell."""

# %% the motion
import holonom

METHODS = ["index1@rk4:h=0.01", "baumgarte@rk4:h=0.01", "projection@rk4:h=0.01", "nullspace@rk4:h=0.01", "reduced@rk4:h=0.01"]
motions = [holonom.run("four-bar", method, time=2, every=0.02) for method in METHODS]

# %% how far the loop has opened, and what became of the energy
for motion in motions:
    print(f"{motion.method:24} gap {max(motion.gap):8.1e} m   energy {max(abs(e - motion.energy[0]) for e in motion.energy):8.1e} J")

# %% the same as curves
try:
    import matplotlib

    matplotlib.use("svg")
    from matplotlib import pyplot
except ImportError:
    print("no curves: matplotlib is not installed")
else:
    figure, axes = pyplot.subplots()
    for motion in motions:
        axes.semilogy(motion.t, [max(gap, 1e-17) for gap in motion.gap], label=motion.method)
    axes.set_xlabel("t [s]")
    axes.set_ylabel("loop gap [m]")
    axes.legend()
    figure.savefig("four_bar.svg")

# %% which one to take: the cheapest for four digits
work = holonom.study("four-bar", methods=["projection@rk4", "projection@dop853"], time=1, levels=5, samples=0)
for method in work["methods"]:
    print(method["method"], [point["state"] for point in method["points"]])
