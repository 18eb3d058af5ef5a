# SPDX-License-Identifier: GPL-3.0-or-later
# usage: pictures.py PROGRAM
# A picture of every shipped scene at its start, into the folder `pictures` of its lesson.
import glob
import json
import os
import subprocess
import sys


def main():
    program = sys.argv[1]
    for path in sorted(glob.glob("lessons/*/scenes/*.json")):
        with open(path, encoding="utf-8") as f:
            scene = json.load(f).get("id") or os.path.basename(path).removesuffix(".json")
        folder = os.path.join(os.path.dirname(os.path.dirname(path)), "pictures")
        os.makedirs(folder, exist_ok=True)
        words = ["--method", "projection@rk4:h=1e-3", "--time", "0", "--width", "640", "--height", "384"]
        subprocess.run([program, "snapshot", scene, *words, "-o", os.path.join(folder, scene + ".png")], check=True)


if __name__ == "__main__":
    main()
