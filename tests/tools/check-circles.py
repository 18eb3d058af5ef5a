# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds which source uses a symbol of which, and with it circles inside layers, and arrows that lead upwards.

usage: check-circles.py --layers 'a: b:a ...' --rooms 'b.low: b.high:low ...' --natural FILE --out FOLDER OBJECT...

The arrows are read from the objects with `nm`, so that a function that is declared by hand counts like one from a header.
FILE lists the circles that are natural, one a line with its reason: `core/expr/a.c core/expr/b.c: reason`, and the sources
that may reach into an upper room, as the table of a registry does: `up core/layer/room/registry.c: reason`. Any other circle
or upward arrow is a fault, and so is a line that allows something that is not there. Exit status 1 if there is any fault.
"""

import argparse
import subprocess
import sys

DEFINED = set("TDBRVWGSC")  # letters of nm for symbols that an object defines for others


def table(text):
    """'a:b,c d:' as {a: {b, c}, d: set()}"""
    return {name: set(filter(None, needs.split(","))) for name, _, needs in (e.partition(":") for e in text.split())}


def symbols(out, objects):
    """For each source: what it defines and what it uses."""
    lines = subprocess.run(["nm", "-A", "-g", "-P", *objects], capture_output=True, text=True, check=True).stdout
    defined, used = {}, {}
    for line in lines.splitlines():
        place, name, letter = line.split()[:3]
        source = place.rstrip(":").removeprefix(out + "/").removesuffix(".o") + ".c"
        if letter in DEFINED:
            defined[name] = source
        elif letter == "U":
            used.setdefault(source, set()).add(name)
    return defined, used


def arrows(out, objects):
    """{source: {sources that it uses: a symbol}}"""
    defined, used = symbols(out, objects)
    graph = {}
    for source, names in used.items():
        for name in sorted(names):
            if name in defined and defined[name] != source:
                graph.setdefault(source, {}).setdefault(defined[name], name)
    return graph


def circles(graph):
    """The strongly connected components of two nodes and more (Tarjan, with a stack of its own)."""
    index, low, on, stack, found = {}, {}, set(), [], []

    def enter(v):
        index[v] = low[v] = len(index)
        stack.append(v)
        on.add(v)
        return v, iter(graph.get(v, {}))

    for root in list(graph):
        work = [] if root in index else [enter(root)]
        while work:
            v, rest = work[-1]
            w = next((w for w in rest), None)
            if w is not None:
                if w not in index:
                    work.append(enter(w))
                elif w in on:
                    low[v] = min(low[v], index[w])
                continue
            work.pop()
            if work:
                low[work[-1][0]] = min(low[work[-1][0]], low[v])
            if low[v] == index[v]:
                part = set()
                while not part or w != v:
                    w = stack.pop()
                    on.discard(w)
                    part.add(w)
                if len(part) > 1:
                    found.append(frozenset(part))
    return found


def place(source):
    """Layer and room of a source: all folders between the layer and the file, "" for a file outside all rooms, which all may use."""
    parts = source.split("/")
    parts = parts[1:] if parts[0] == "core" else parts
    return parts[0], "/".join(parts[1:-1])


def climbs(graph, layers, rooms):
    """Pairs (source, sentence) for each arrow to a layer or a room that the source may not use."""
    with_rooms = {name.split(".")[0] for name in rooms}
    for source, targets in sorted(graph.items()):
        layer, room = place(source)
        for target, name in sorted(targets.items()):
            other, other_room = place(target)
            if other != layer and other not in layers.get(layer, ()):
                yield source, f"{source}: uses {name} of {target}: layer {layer} may not use layer {other}"
            elif other == layer in with_rooms and other_room not in ("", room) and other_room not in rooms.get(f"{layer}.{room}", ()):
                yield source, f"{source}: uses {name} of {target}: room {room} may not use room {other_room}"


def allowed(path):
    """The circles and the upward sources that the file allows: two dictionaries to the reason."""
    with open(path, encoding="utf-8") as f:
        lines = [line.strip() for line in f if line.strip() and not line.startswith("#")]
    natural, up = {}, {}
    for line in lines:
        members, _, reason = line.partition(": ")
        if members.startswith("up "):
            up[members[3:]] = reason
        else:
            natural[frozenset(members.split())] = reason
    return natural, up


def faults(graph, path, layers, rooms):
    natural, up = allowed(path)
    found = [f"{path}: no reason for {' '.join(sorted(c))}" for c, reason in natural.items() if not reason]
    found += [f"{path}: no reason for up {source}" for source, reason in up.items() if not reason]

    # circles: exactly those of the list
    present = circles(graph)
    found += [f"circle: {' '.join(sorted(c))}" for c in present if c not in natural]
    found += [f"{path}: is no circle (any more): {' '.join(sorted(c))}" for c in natural if c not in present]

    # arrows upwards: from the sources of the list alone
    upward = list(climbs(graph, layers, rooms))
    found += [sentence for source, sentence in upward if source not in up]
    found += [f"{path}: has no arrow upwards (any more): {source}" for source in up if source not in dict(upward)]
    return found


def main():
    p = argparse.ArgumentParser()
    for option in ("--layers", "--rooms", "--natural", "--out"):
        p.add_argument(option, required=True)
    p.add_argument("objects", nargs="+")
    a = p.parse_args()
    found = faults(arrows(a.out, a.objects), a.natural, table(a.layers), table(a.rooms))
    for fault in found:
        print(fault)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
