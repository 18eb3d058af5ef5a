# SPDX-License-Identifier: GPL-3.0-or-later
"""Every joint type of core/scene/scene.h is in the tables that follow it by hand: schema and page. Speaks TAP."""

import json
import re
import sys


def text(path):
    with open(path, encoding="utf-8") as f:
        return f.read()


def keys(path, table):
    """The keys of an object literal of a module of the page."""
    body = re.search(rf"^const {table} = {{\n(.*?)^}};", text(path), re.S | re.M).group(1)
    return set(re.findall(r"^  (\w+):", body, re.M))


def schema_types():
    joint = json.loads(text("core/scene/scene.schema.json"))["$defs"]["joint"]["properties"]["type"]
    return set(joint["enum"]), joint["description"]


def main():
    types = set(re.findall(r'X\(HN_JOINT_\w+, "(\w+)"\)', text("core/scene/scene.h")))
    named, described = schema_types()
    drawn = types - {"fixed", "free"}  # nothing moves there, or nothing holds
    lacks = {
        "scene.schema.json names every type": types ^ named,
        "scene.schema.json describes every type": {t for t in types if t not in described},
        "MOTIONS of web/state/kinematics.js moves every type": types ^ keys("web/state/kinematics.js", "MOTIONS"),
        "GLYPHS of web/views/space/joints.js draws every type": drawn ^ keys("web/views/space/joints.js", "GLYPHS"),
    }
    print(f"1..{len(lacks)}")
    for n, (name, missing) in enumerate(lacks.items(), 1):
        print(f"{'not ok' if missing else 'ok'} {n} - {name}")
        if missing:
            print("# " + ", ".join(sorted(missing)))
    return 1 if any(lacks.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
