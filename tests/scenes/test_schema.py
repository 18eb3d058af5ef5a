# SPDX-License-Identifier: GPL-3.0-or-later
# Every shipped scene is what scene.schema.json says, and the schema says something: a scene with one field too
# many, anywhere, or one that is needed taken away, is refused. Speaks TAP.
import glob
import json

import jsonschema

with open("core/scene/scene.schema.json") as f:
    SCHEMA = json.load(f)
jsonschema.Draft202012Validator.check_schema(SCHEMA)
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)
results = []


def report(good, name, why=""):
    results.append(good)
    print(f"{'ok' if good else 'not ok'} {len(results)} - {name}")
    if not good:
        print(f"# {why}")


def faults(scene):
    return [f"{e.json_path}: {e.message[:200]}" for e in VALIDATOR.iter_errors(scene)]


def objects(node, path=()):
    """Paths of all objects that are not maps of the author's own names."""
    own = {"parameters", "positions", "rates", "points", "forces", "for"}
    if isinstance(node, dict):
        if not (path and path[-1] in own):
            yield path
        for key, value in node.items():
            yield from objects(value, path + (key,))
    elif isinstance(node, list):
        for i, value in enumerate(node):
            yield from objects(value, path + (i,))


def at(node, path):
    for key in path:
        node = node[key]
    return node


shipped = sorted(glob.glob("lessons/*/scenes/*.json"))
report(len(shipped) >= 9, "the shipped scenes are found", str(shipped))
others = set(glob.glob("tests/scenes/*.json") + glob.glob("tests/reference/*.json")) - {"tests/scenes/texts.json"}
for name in shipped + sorted(others):
    with open(name) as f:
        scene = json.load(f)
    found = faults(scene)
    report(not found, f"{name} is what the schema says", "; ".join(found))

    let_through = []
    for path in list(objects(scene)):
        place = at(scene, path)
        place["unheard_of"] = {"unheard_of": []}
        if VALIDATOR.is_valid(scene):
            let_through.append("/".join(map(str, path)))
        del place["unheard_of"]
    report(not let_through, f"{name} with an unknown field in any object is refused", "; ".join(let_through))

    let_through = []
    for key in ("holonom", "name", "bodies" if "bodies" in scene else "lagrangian"):
        if VALIDATOR.is_valid({k: v for k, v in scene.items() if k != key}):
            let_through.append(key)
    report(not let_through, f"{name} without a field it needs is refused", "; ".join(let_through))
print(f"1..{len(results)}")
raise SystemExit(0 if all(results) else 1)
