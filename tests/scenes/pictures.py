# SPDX-License-Identifier: GPL-3.0-or-later
# usage: pictures.py PROGRAM
# A picture of every shipped scene at its start, into the folder `pictures` of its lesson; and the animation of README.md.
import glob
import json
import os
import subprocess
import sys


def animate(program):
    """The first four-bar falls apart, beside one that is held together; 0.1 s of the motion in each picture."""
    methods = ["index1@rk4:h=0.04", "projection@rk4:h=0.04"]
    times = ",".join(f"{0.1 * k:.1f}" for k in range(26))
    words = ["--at", times, "--animate", "120", "--width", "600", "--height", "360"]
    picture = "lessons/01-closed-loops/falls-apart.png"
    subprocess.run([program, "snapshot", "four-bar", "--methods", *methods, *words, "-o", picture], check=True)


def main():
    program = sys.argv[1]
    animate(program)
    for path in sorted(glob.glob("lessons/*/scenes/*.json")):
        with open(path, encoding="utf-8") as f:
            scene = json.load(f).get("id") or os.path.basename(path).removesuffix(".json")
        folder = os.path.join(os.path.dirname(os.path.dirname(path)), "pictures")
        os.makedirs(folder, exist_ok=True)
        words = ["--method", "projection@rk4:h=1e-3", "--time", "0", "--width", "640", "--height", "384"]
        subprocess.run([program, "snapshot", scene, *words, "-o", os.path.join(folder, scene + ".png")], check=True)


if __name__ == "__main__":
    main()
