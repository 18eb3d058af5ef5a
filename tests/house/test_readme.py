# SPDX-License-Identifier: GPL-3.0-or-later
"""The README files: links and paths lead somewhere, commands run, the first page stays short. Speaks TAP."""

import glob
import os
import re
import shlex
import subprocess
import sys
import tempfile

PROGRAM = os.path.abspath(os.environ.get("HOLONOM", "build/holonom"))
ROOT = os.getcwd()
MOST_LINES = 110  # of README.md
MOST_SECONDS = 120  # of one command; the longest takes a few
# only pages that were written for this test
PAGES = ["README.md", *sorted(glob.glob("core/**/README.md", recursive=True)), "lessons/README.md", "tests/README.md",
         *glob.glob("server/README.md"), *glob.glob("web/README.md")]  # fmt: skip
# what a command in a page stands for, where it cannot be run as it is
PLACES = ("SCENE", "FILE", "ID", "FOLDER", "...", "PART", "serve", "report SCENE")


def read(page):
    with open(page, encoding="utf-8") as f:
        return f.read()


def dead_links(page):
    """Relative links and pictures that lead nowhere."""
    targets = re.findall(r"\]\(([^)#\s]+)\)", read(page))
    here = os.path.dirname(page)
    return [t for t in targets if "://" not in t and not os.path.exists(os.path.join(here, t))]


def dead_paths(page):
    """Paths in backticks, from the root of the tree, that are not there."""
    names = re.findall(r"`((?:core|server|web|tests|lessons)/[A-Za-z0-9_./*-]+)`", read(page))
    return [n for n in names if "NN-" not in n and "NAME" not in n and not glob.glob(n.rstrip("/"))]


def commands(page):
    """Lines of the page that call the program, without what stands beside them."""
    found = []
    for line in re.findall(r"^    build/holonom (.*)$", read(page), re.M):
        words = re.split(r"\s{3,}", line)[0]
        if not any(place in words for place in PLACES) and "serve" not in words.split():
            found.append(words)
    return found


def run(command, folder):
    words = [os.path.join(ROOT, w) if w.startswith(("lessons/", "tests/")) else w for w in shlex.split(command)]
    done = subprocess.run([PROGRAM, *words], cwd=folder, capture_output=True, text=True, timeout=MOST_SECONDS,
                          env=os.environ | {"HOLONOM_CACHE": os.path.join(folder, "cache")})  # fmt: skip
    return done


def failed_commands(page):
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        for command in commands(page):
            done = run(command, folder)
            if done.returncode != 0:
                faults.append(f"{command}: exit {done.returncode}: {done.stderr.strip()[:200]}")
    return faults


def rooms_left_out():
    """Rooms of core/ that the picture in core/README.md does not name."""
    picture = re.search(r"^## Layers and rooms.*?^\|", read("core/README.md"), re.M | re.S).group()
    rooms = [f.rstrip("/").split("/")[-1] for f in glob.glob("core/*/*/") if glob.glob(f + "*.h")]
    return [room for room in rooms if not re.search(rf"\b{room}\b", picture)]


def main():
    lines = len(read("README.md").splitlines())
    results = [("README.md has at most 110 lines", [] if lines <= MOST_LINES else [f"{lines} lines"])]
    for page in PAGES:
        results.append((f"{page}: its links lead somewhere", dead_links(page)))
        results.append((f"{page}: the paths it names are there", dead_paths(page)))
        if commands(page):
            results.append((f"{page}: its commands run", failed_commands(page)))
    results.append(("core/README.md: its picture names every room", rooms_left_out()))
    none = [p for p in ("README.md", "core/session/README.md", "core/import/README.md", "lessons/README.md") if not commands(p)]
    results.append(("the pages have commands to run", none))
    for n, (name, faults) in enumerate(results, 1):
        for fault in faults:
            print(f"# {fault}")
        print(f"{'not ok' if faults else 'ok'} {n} - {name}")
    print(f"1..{len(results)}")
    return 1 if any(faults for _, faults in results) else 0


if __name__ == "__main__":
    sys.exit(main())
