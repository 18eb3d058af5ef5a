# SPDX-License-Identifier: GPL-3.0-or-later
"""A concept is one .h and one .c of the same name. Finds sources without a header of their own name.

usage: check-names.py EXCEPTIONS SOURCE...

EXCEPTIONS lists the sources that need none, one pattern a line with its reason: `core/layer/*.c: reason`. A pattern that
excuses no source is a fault too. Exit status 1 if there is any fault.
"""

import fnmatch
import os
import sys


def exceptions(path):
    """Pairs (pattern, reason) of the file; lines that begin with # and empty lines are for people."""
    with open(path, encoding="utf-8") as f:
        lines = [line.strip() for line in f]
    pairs = [line.partition(": ") for line in lines if line and not line.startswith("#")]
    return [(pattern, reason.strip()) for pattern, _, reason in pairs]


def faults(path, sources):
    excused = exceptions(path)
    found = [f"{path}: '{pattern}' gives no reason" for pattern, reason in excused if not reason]
    alone = [s for s in sources if not os.path.exists(os.path.splitext(s)[0] + ".h")]
    for source in alone:
        if not any(fnmatch.fnmatchcase(source, pattern) for pattern, _ in excused):
            found.append(f"{source}: no header of the same name; give it one, or name it in {path} with the reason")
    for pattern, _ in excused:
        if not any(fnmatch.fnmatchcase(source, pattern) for source in alone):
            found.append(f"{path}: '{pattern}' excuses no source any more; take the line out")
    return found


def main():
    found = faults(sys.argv[1], sys.argv[2:])
    for fault in found:
        print(fault)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
