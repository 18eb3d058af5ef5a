# SPDX-License-Identifier: GPL-3.0-or-later
# usage: summary.py [FILE]
# The table of every scene by every method, as one line for each method: how many scenes it finished, where it stopped or was refused.
import csv
import sys
from collections import defaultdict

FILE = "tests/tables/every_method.csv"


def main():
    with open(sys.argv[1] if len(sys.argv) > 1 else FILE, encoding="utf-8") as f:
        rows = list(csv.DictReader(f))
    by_method = defaultdict(list)
    for r in rows:
        by_method[r["method"].rsplit(":", 1)[0]].append(r)
    print(f"{'method':36} finished  stopped  refused  stopped or refused at")
    for method, cells in by_method.items():
        count = {o: [r["scene"] for r in cells if r["outcome"] == o] for o in ("finished", "stopped", "refused")}
        names = ", ".join(count["stopped"] + count["refused"]) or "-"
        print(f"{method:36} {len(count['finished']):8} {len(count['stopped']):8} {len(count['refused']):8}  {names}")
    print(f"\n{len(by_method)} methods, {len({r['scene'] for r in rows})} scenes, {len(rows)} runs")


if __name__ == "__main__":
    main()
