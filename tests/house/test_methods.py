# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of methods in two README files are those that the program lists. `test_methods.py --write` puts them there. Speaks TAP."""

import json
import os
import subprocess
import sys

PROGRAM = os.environ.get("HOLONOM", "build/holonom")
PAGES = {"formulations": "core/formulations/README.md", "integrators": "core/integrators/README.md"}
# of the cards: what every one has to say
FORMULATION = ("title", "rule", "drift", "when", "when_not", "source", "needs")
INTEGRATOR = ("title", "about", "source")


def listed():
    done = subprocess.run([PROGRAM, "list", "methods", "--json"], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def row(*cells):
    return "| " + " | ".join(str(c).replace("|", "\\|") for c in cells) + " |\n"


def formulations(listed_methods):
    text = row("formulation", "what it is", "index", "needs", "the gap") + row(*["---"] * 5)
    for f in listed_methods:
        text += row(f"`{f['name']}`", f["title"], f["index"], f["needs"], f["drift"])
    return text


def integrators(listed_methods):
    text = row("integrator", "what it is", "order", "step", "serves") + row(*["---"] * 5)
    for i in listed_methods:
        step = "adaptive" if i["adaptive"] else "fixed"
        text += row(f"`{i['name']}`", i["title"], i["order"], step, ", ".join(i["forms"]))
    return text


def replace_table(kind, table):
    """Puts the table into its page where it differs; True where it was there already."""
    begin, end = f"<!-- {kind}: tests/house/test_methods.py --write -->\n", f"<!-- end of {kind} -->\n"
    with open(PAGES[kind], encoding="utf-8") as f:
        page = f.read()
    before, rest = page.split(begin)
    found, after = rest.split(end)
    if found != table and "--write" in sys.argv:
        with open(PAGES[kind], "w", encoding="utf-8") as f:
            f.write(before + begin + table + end + after)
    return found == table


UNITS = "zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen seventeen eighteen nineteen".split()
TENS = {2: "twenty", 3: "thirty", 4: "forty", 5: "fifty"}


def in_words(n):
    tens, unit = divmod(n, 10)
    return UNITS[n] if n < 20 else TENS[tens] + (f"-{UNITS[unit]}" if unit else "")


def wrong_counts(formulations, integrators):
    """Sentences with a count that are not in their page as they have to be."""
    wanted = (("README.md", f"knows {in_words(formulations)} formulations"),
              ("core/README.md", f"constraints enter: {in_words(formulations)} rows"),
              ("core/README.md", f"time advance: {in_words(integrators)} rows"))
    missing = []
    for page, words in wanted:
        with open(page, encoding="utf-8") as f:
            if words not in " ".join(f.read().split()):
                missing.append(f"{page} should say '{words}'")
    return missing


def main():
    methods = listed()
    same = {kind: replace_table(kind, make(methods[kind])) for kind, make in
            (("formulations", formulations), ("integrators", integrators))}
    if "--write" in sys.argv:
        return 0
    dumb = [f"{c['name']}: {key}" for kind, keys in (("formulations", FORMULATION), ("integrators", INTEGRATOR))
            for c in methods[kind] for key in keys if not c.get(key)]
    text = subprocess.run([PROGRAM, "list", "methods"], capture_output=True, text=True, check=True).stdout
    unsaid = [f["name"] for f in methods["formulations"] if f["when_not"] not in text or f["source"] not in text]
    counts = wrong_counts(len(methods["formulations"]), len(methods["integrators"]))
    results = [
        *((f"{PAGES[kind]} has the table of the program", good, "run tests/house/test_methods.py --write") for kind, good in same.items()),
        ("README files count formulations and integrators right", not counts, ", ".join(counts)),
        ("every card says what it has to", not dumb, ", ".join(dumb)),
        ("a person's list shows every card", not unsaid, ", ".join(unsaid)),
    ]
    print(f"1..{len(results)}")
    for n, (name, good, why) in enumerate(results, 1):
        print(f"{'ok' if good else 'not ok'} {n} - {name}")
        if not good:
            print(f"# {why}")
    return not all(good for _, good, _ in results)


if __name__ == "__main__":
    sys.exit(main())
