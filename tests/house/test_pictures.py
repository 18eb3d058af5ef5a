# SPDX-License-Identifier: GPL-3.0-or-later
"""Every shipped scene has a picture, and its lesson shows it. Speaks TAP."""

import glob
import json
import os
import sys


def scenes():
    """(id, folder of the lesson) of every scene."""
    for path in sorted(glob.glob("lessons/*/scenes/*.json")):
        with open(path, encoding="utf-8") as f:
            yield json.load(f).get("id") or os.path.basename(path).removesuffix(".json"), os.path.dirname(os.path.dirname(path))


def main():
    faults = []
    for scene, lesson in scenes():
        with open(os.path.join(lesson, "text.md"), encoding="utf-8") as f:
            shown = f"(pictures/{scene}.png)" in f.read()
        picture = os.path.join(lesson, "pictures", scene + ".png")
        if not shown or not os.path.isfile(picture):
            faults.append(f"{picture}: {'missing' if shown else 'not shown in the text'}; `make pictures` draws them")
    for fault in faults:
        print(f"# {fault}")
    print(f"{'not ok' if faults else 'ok'} 1 - every scene has a picture in its lesson\n1..1")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
