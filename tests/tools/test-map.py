# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists which unit tests call which source directly, read from the objects.

usage: test-map.py --out FOLDER [--source PART] OBJECT...

OBJECTs are those of the library, the program and the unit tests. Prints a line for each source, with the tests that use one of
its symbols; `-` where it is reached only through others. PART chooses sources whose path holds it.
"""

import argparse
import importlib.util
import os

HERE = os.path.dirname(os.path.abspath(__file__))
SPEC = importlib.util.spec_from_file_location("check_circles", os.path.join(HERE, "check-circles.py"))
circles = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(circles)


def main():
    p = argparse.ArgumentParser()
    p.add_argument("--out", required=True)
    p.add_argument("--source", default="")
    p.add_argument("objects", nargs="+")
    a = p.parse_args()
    graph = circles.arrows(a.out, a.objects)
    sources = sorted(o.removeprefix(a.out + "/").removesuffix(".o") + ".c" for o in a.objects)
    users = {s: [] for s in sources if not s.startswith("tests/")}
    for test in (s for s in sources if s.startswith("tests/unit/")):
        for source in graph.get(test, {}):
            if source in users:
                users[source].append(os.path.basename(test).removesuffix(".c"))
    for source, tests in users.items():
        if a.source in source:
            print(f"{source:56} {' '.join(tests) or '-'}")


if __name__ == "__main__":
    main()
