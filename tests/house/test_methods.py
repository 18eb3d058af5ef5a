"""The README's tables of methods are those that the program lists. `test_methods.py --write` puts them there. Speaks TAP."""

import json
import os
import subprocess
import sys

PROGRAM = os.environ.get("HOLONOM", "build/holonom")
README = "README.md"
BEGIN, END = "<!-- methods: tests/house/test_methods.py --write -->\n", "<!-- end of methods -->\n"
# of the cards: what every one has to say
FORMULATION = ("title", "rule", "drift", "when", "when_not", "source", "needs")
INTEGRATOR = ("title", "about", "source")


def listed():
    done = subprocess.run([PROGRAM, "list", "methods", "--json"], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def row(*cells):
    return "| " + " | ".join(str(c).replace("|", "\\|") for c in cells) + " |\n"


def tables(methods):
    text = row("formulation", "what it is", "index", "needs", "the gap") + row(*["---"] * 5)
    for f in methods["formulations"]:
        text += row(f"`{f['name']}`", f["title"], f["index"], f["needs"], f["drift"])
    text += "\n" + row("integrator", "what it is", "order", "step", "serves") + row(*["---"] * 5)
    for i in methods["integrators"]:
        step = "adaptive" if i["adaptive"] else "fixed"
        forms = ", ".join(i["forms"])
        text += row(f"`{i['name']}`", i["title"], i["order"], step, forms)
    return text


def main():
    methods = listed()
    with open(README, encoding="utf-8") as f:
        readme = f.read()
    before, rest = readme.split(BEGIN)
    found, after = rest.split(END)
    if "--write" in sys.argv:
        with open(README, "w", encoding="utf-8") as f:
            f.write(before + BEGIN + tables(methods) + END + after)
        return 0
    dumb = [f"{c['name']}: {key}" for kind, keys in (("formulations", FORMULATION), ("integrators", INTEGRATOR))
            for c in methods[kind] for key in keys if not c.get(key)]
    text = subprocess.run([PROGRAM, "list", "methods"], capture_output=True, text=True, check=True).stdout
    unsaid = [f["name"] for f in methods["formulations"] if f["when_not"] not in text or f["source"] not in text]
    results = [
        ("the README's tables of methods are those of the program", found == tables(methods), "run tests/house/test_methods.py --write"),
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
