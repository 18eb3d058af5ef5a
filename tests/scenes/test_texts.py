# SPDX-License-Identifier: GPL-3.0-or-later
"""Every number in the text of a lesson comes from a command that is run here. Speaks TAP.

texts.json lists, for each text, what it says (word for word) with the command and the numbers that the command must give: `is`
within a share, `at_most`, `contains` ... A number of the text that no entry covers is a fault, and so is an entry that the text
no longer says. An entry without a command says in `because` why it needs none.
"""

import glob
import json
import math
import os
import re
import shlex
import subprocess
import sys

PROGRAM = os.environ.get("HOLONOM", "build/holonom")
FACTS = "tests/scenes/texts.json"
WORDS = {"no": 0, "one": 1, "two": 2, "three": 3, "four": 4, "five": 5, "six": 6, "18": 18}
# what a line "* **scene** - one degree of freedom, two loops ..." counts, and where inspect has it
COUNTED = {
    r"degrees? of freedom": "start.freedoms|start.dof",
    r"loops?": "sizes.loops",
    r"rows?": "sizes.rows",
    r"motors?": "actuation.actuated",
    r"drives?": "actuation.actuated",
}
_documents = {}


def document(command):
    """What the command prints, as JSON; a run that ends early prints one too."""
    if command not in _documents:
        done = subprocess.run([PROGRAM, *shlex.split(command)], capture_output=True, text=True, timeout=300)
        _documents[command] = json.loads(done.stdout)
    return _documents[command]


def unreadable(texts):
    """Lessons that the program cannot read, with what it says of them."""
    faults = []
    for text in texts:
        lesson = document(f"lesson {text.split('/')[1]} --json")
        if not lesson.get("blocks"):
            faults.append(f"{text}: {lesson.get('errors') or lesson}")
    return faults


def pick(value, path):
    """'methods.0.worst_gap', 'integrators.name=rk4.real_limit'; 'a|b': the first that is there."""
    for way in path.split("|"):
        at = value
        for step in way.split("."):
            if isinstance(at, list) and "=" in step:
                key, wanted = step.split("=")
                at = next((row for row in at if row.get(key) == wanted), None)
            elif isinstance(at, list):
                at = at[int(step)] if int(step) < len(at) else None
            else:
                at = at.get(step) if isinstance(at, dict) else None
        if at is not None:
            return at
    raise KeyError(path)


def holds(doc, check):
    """Returns whether the check holds, and the value that was found."""
    found = pick(doc, check["at"])
    if "minus" in check:
        found -= pick(doc, check["minus"])
    if "contains" in check:
        return check["contains"] in found, found
    if "count" in check:
        return len(found) == check["count"], len(found)
    if "at_most" in check:
        return found <= check["at_most"], found
    if "least_of" in check:
        return all(found < pick(doc, other) for other in check["least_of"]), found
    if "largest_of" in check:
        return all(found > pick(doc, other) for other in check["largest_of"]), found
    return abs(found - check["is"]) <= check["within"] * abs(check["is"]), found


def faults_of(fact, text):
    if fact["says"] not in text:
        return [f"the text does not say: {fact['says']!r}"]
    if "command" not in fact:
        return [] if fact.get("because") else [f"no command and no reason: {fact['says']!r}"]
    doc = document(fact["command"])
    try:
        found = [(check, *holds(doc, check)) for check in fact["checks"]]
    except (KeyError, ValueError) as error:
        return [f"{fact['command']}: there is no {error}"]
    return [f"{check}: found {value}" for check, good, value in found if not good]


def look_at(block, blank):
    """The block blanked, but for what an exhibit says to look at."""
    head, empty, rest = block[0].partition("\n\n")
    return re.sub(r"[^\n]", " ", head) + empty + rest if block[1] == "exhibit" else blank(block)


def prose(text):
    """The text with everything blanked that states no number of its own: code, names, links, headings, numbers of lists."""
    def blank(m):
        return re.sub(r"[^\n]", " ", m[0])

    # a formula states no measured number; of the special blocks only predictions and what to look at do
    text = re.sub(r"^```(exhibit|slip|exercise|python)\b.*?^```$", lambda m: look_at(m, blank), text, flags=re.M | re.S)
    text = re.sub(r"\$\$.*?\$\$", blank, text, flags=re.S)
    # wrong choices of a prediction, and years of sources
    text = re.sub(r"^```predict\b.*?^```$", lambda m: re.sub(r"^- .*$", blank, m[0], flags=re.M), text, flags=re.M | re.S)
    text = re.sub(r"^## Sources$.*?(?=^## |\Z)", blank, text, flags=re.M | re.S)
    for pattern in (r"\$[^$\n]*\$", r"^ {4}\S.*$", r"^#.*$", r"^!\[.*$", r"^\d+\. ", r"\*\*[\w-]+\*\* - ", r"`[^`\n]*`"):
        text = re.sub(pattern, blank, text, flags=re.M)
    return text


def uncovered(text, facts):
    """Numbers of the prose that no fact covers."""
    spans = []
    for fact in facts:
        at = text.find(fact["says"])
        spans += [(at, at + len(fact["says"]))] if at >= 0 else []
    numbers = re.finditer(r"(?<![\w.-])-?\d+(?:\.\d+)?(?:e-?\d+)?", prose(text))
    return [m[0] + " in: " + " ".join(text[max(0, m.start() - 40) : m.end() + 20].split()) for m in numbers
            if not any(a <= m.start() and m.end() <= b for a, b in spans)]  # fmt: skip


TEX_VALUES = (
    (r"\\(?:text|mathrm)\{[^}]*\}(?:\^\d)?|\\(?:[ ,;:!]|[bB]ig[lr])", " "),  # units among them
    (r"\\[td]?frac(\d)(\d)", r"(\1/\2)"),
    (r"\\[td]?frac(\d)\{([^{}]*)\}", r"(\1/(\2))"),
    (r"\\[td]?frac\{([^{}]*)\}\{([^{}]*)\}", r"((\1)/(\2))"),
    (r"\\sqrt\{([^{}]*)\}", r"sqrt(\1)"),
    (r"\\(?:cdot|times)", "*"),
    (r"\\(sin|cos)", r"\1"),
    (r"\^\{?(-?\d+)\}?", r"**(\1)"),
    (r"(\d|\)) *(?=sqrt|\()", r"\1*"),
)


def value_of(tex):
    """A formula of numbers alone, computed; None for one that has letters."""
    for pattern, python in TEX_VALUES:
        tex = re.sub(pattern, python, tex)
    tex = tex.strip().rstrip(".,;").strip()
    if not re.fullmatch(r"[-+*/().\d\s]+", re.sub(r"sqrt|sin|cos", "", tex)):
        return None
    try:  # digits, signs and three functions, no names
        return eval(tex, {"__builtins__": {}, "sqrt": math.sqrt, "sin": math.sin, "cos": math.cos})
    except SyntaxError:
        return None


def sums(text):
    """How many equations of numbers there are, and those that are not true of the figures as they are printed, to the last digit
    of the result."""
    n, faults = 0, []
    for formula in re.findall(r"\$\$(.*?)\$\$|\$([^$\n]+)\$", text, flags=re.S):
        for equation in re.split(r"\\q?quad|,\s+(?![^()]*\))", "".join(formula)):
            sides = [(side, value_of(side)) for side in equation.split("=")]
            for (_, left), (said, right) in zip(sides, sides[1:]):
                if left is not None and right is not None:
                    n += 1
                    last = re.search(r"\d+(?:\.(\d+))?", said)
                    good = abs(left - right) <= 0.5001 * 10.0 ** -len(last[1] or "")
                    faults += [] if good else [f"{' '.join(equation.split())}: {left}"]
    return n, faults


def commands_of_tex(texts):
    """Commands of TeX that the terminal would print by their names."""
    source = read("server/lesson/tex_text.c")
    known = set(re.findall(r'"([A-Za-z]+)"', source)) | {"sin", "cos", "tan", "arcsin", "arccos", "arctan", "det", "exp", "log", "max", "min"}
    return [f"{t}: \\{name}" for t in texts for name in sorted(set(re.findall(r"\\([A-Za-z]+)", " ".join(
        "".join(m) for m in re.findall(r"\$\$(.*?)\$\$|\$([^$\n]+)\$", read(t), flags=re.S)))) - known)]  # fmt: skip


def counts(text):
    """(scene, what, number said, number found) for the lists of scenes."""
    for scene, words in re.findall(r"^\* \*\*([\w-]+)\*\* - ([^.:]*)", text, flags=re.M):
        doc = document(f"inspect {scene} --json")
        for part in re.split(r",| although | though ", words):
            m = re.match(r"\s*(\w+) (.*)", part)
            for what, path in COUNTED.items():
                if m and m[1] in WORDS and re.match(rf"{what}(?![\w-])", m[2]):
                    yield scene, part.strip(), WORDS[m[1]], pick(doc, path)


def read(path):
    with open(path, encoding="utf-8") as f:
        return f.read()


def exercises(texts):
    """Exercises that a text names and that are not there, and the other way round."""
    named = {name for t in texts for name in re.findall(r"^```exercise (\S+)$", read(t), flags=re.M)}
    there = {p["id"] for p in document("list problems --json")["problems"]}
    return sorted(named ^ there)


def slips(texts):
    """Numbers of slips, 1 to 38, that no text or no exercise has."""
    told = {int(n) for t in texts for n in re.findall(r"^```slip (\d+)$", read(t), flags=re.M)}
    asked = {int(part["id"][1:]) for path in glob.glob("lessons/*/problems/slips-*.json") for part in json.loads(read(path))["parts"]}
    return [f"slip {n} is in no {where}" for where, seen in (("text", told), ("exercise", asked)) for n in range(1, 39) if n not in seen]


def shown_slips(facts):
    """Rows of the table of slips in lessons/README.md that name nothing that runs: a command that gives a document, a part of an
    exercise, or a program in a lesson; and rows whose last column no fact holds and no exercise says."""
    table = read("lessons/README.md").split("## The 38 slips")[1]
    rows = re.findall(r"^\| (\d+) \|.*\| ([^|]*) \| ([^|]*) \|$", table, flags=re.M)
    faults = [] if [int(n) for n, _, _ in rows] == list(range(1, 39)) else ["the table does not have slips 1 to 38, each once"]
    for number, shown, seen in rows:
        command = re.fullmatch(r"`holonom (.*)`", shown)
        part = re.fullmatch(r"exercise ([\w-]+), parts? (\w)(?: and (\w))?", shown)
        program = re.fullmatch(r"the program in lesson (\d+), section (\d+)", shown)
        if command:
            # all cases of the extreme matrix have a test of their own
            held = any(f["says"].strip("| ") in seen and f["command"] == f"{command[1]} --json" for f in facts)
            good = held or (command[1] == "extreme" and seen == f"{len(glob.glob('lessons/extreme/x*.json'))} cases")
        elif part:
            parts = json.loads(read(glob.glob(f"lessons/*/problems/{part[1]}.json")[0]))["parts"]
            named = [json.dumps(p) for p in parts if p["id"] in part.groups()[1:]]
            good = len(named) == len([p for p in part.groups()[1:] if p]) and all(seen.strip('"') in p for p in named)
        elif program:
            section = re.search(rf"^## {program[2]}\..*?(?=^## )", read(glob.glob(f"lessons/{int(program[1]):02}-*/text.md")[0]), flags=re.M | re.S)
            good = bool(section) and f"```slip {number}\n" in section[0] and "```python\n" in section[0]
        else:
            good = False
        faults += [] if good else [f"slip {number}: {shown}"]
    return faults


def unreadable_in_ascii(texts):
    """Lessons with characters that a terminal without UTF-8 shows as question marks."""
    def marks(text, locale):
        done = subprocess.run([PROGRAM, "lesson", text.split("/")[1]], capture_output=True, text=True, timeout=600, env={**os.environ, "LC_ALL": locale})
        return done.stdout.count("?")

    return [t for t in texts if marks(t, "C") != marks(t, "C.UTF-8")]


def kinds():
    """Kinds of answers whose row in lessons/README.md names an exercise of another kind, and kinds without a row."""
    shipped = {}
    for path in glob.glob("lessons/*/problems/*.json"):
        exercise = json.loads(read(path))
        shipped.update({(exercise["id"], p["id"]): p for p in exercise.get("parts", [])})
    rows = re.findall(r"^\| (`[^|]*`) \| [^|]* \| ([^|]*) \| ([^|]*) \|$", read("lessons/README.md"), flags=re.M)
    copied = [(re.findall(r"`(\w+)`", names), re.findall(r"`([\w-]+)` (\w)", places), re.findall(r"`(\w+)`", members)) for names, places, members in rows]
    copied = [row for row in copied if row[1]]
    faults = [f"{place}: {shipped[place]['kind']}" for names, places, _ in copied for place in places if shipped[place]["kind"] not in names]
    faults += [f"{names}: no exercise has {m}" for names, _, members in copied for m in members if not any(m in p for p in shipped.values() if p["kind"] in names)]
    return faults + sorted({p["kind"] for p in shipped.values()} - {name for names, _, _ in copied for name in names})


def exhibits(texts):
    """Commands of exhibits that do not run. A method that ends early, and says so (status 4), may be the point of an exhibit."""
    faults = []
    for t in texts:
        for block in document(f"lesson {t.split('/')[1]} --json").get("blocks", []):
            # study has a time limit in the text; here a second tells whether its options are right
            command = re.sub(r"--time-limit \d+", "--time-limit 1", block["command"]) if block["kind"] == "exhibit" else ""
            if command and f"{command} --json" not in _documents:
                done = subprocess.run([PROGRAM, *shlex.split(command)], capture_output=True, text=True, timeout=300, stdin=subprocess.DEVNULL)
                faults += [f"{t}: {command}: {done.stderr[-200:]}"] if done.returncode not in (0, 4) else []
    return faults


def charts():
    """Commands in the boxes of the flow charts that do not run; a figure without a title, or that no text shows."""
    faults = []
    for path in sorted(glob.glob("lessons/*/pictures/*.svg")):
        drawing, text = read(path), read(os.path.join(os.path.dirname(os.path.dirname(path)), "text.md"))
        faults += [] if f"(pictures/{os.path.basename(path)})" in text else [f"{path}: no text shows it"]
        faults += [] if re.search(r"<title>[^<]{10,}</title>", drawing) else [f"{path}: no title"]
        boxes = re.findall(r'class="command"[^>]*>holonom (.*?)</text>', drawing)
        faults += [f"{path}: no command"] if "/chart-" in path and not boxes else []
        for command in (re.sub(r"<[^>]*>", "", box) for box in boxes):
            done = subprocess.run([PROGRAM, *shlex.split(command)], capture_output=True, text=True, timeout=300, stdin=subprocess.DEVNULL)
            faults += [f"{path}: {command}: {done.stderr[-200:]}"] if done.returncode else []
    return faults


def programs(texts):
    """Python programs of the texts that end with a fault; the one with NumPy is Debian's."""
    faults = []
    for t in texts:
        for code in re.findall(r"^```python\n(.*?)^```$", read(t), flags=re.M | re.S):
            done = subprocess.run(["/usr/bin/python3", "-c", code], capture_output=True, text=True, timeout=300)
            faults += [f"{t}: {done.stderr[-200:]}"] if done.returncode else []
    return faults


def main():
    with open(FACTS, encoding="utf-8") as f:
        all_facts = json.load(f)
    results = []
    texts = sorted(f"lessons/{d}/text.md" for d in os.listdir("lessons") if os.path.exists(f"lessons/{d}/text.md"))
    computed = 0
    for path, facts in all_facts.items():
        with open(path, encoding="utf-8") as f:
            text = f.read()
        for fact in facts:
            results.append((f"{path}: {' '.join(fact['says'].split())[:90]}", faults_of(fact, text)))
        if not path.endswith("/text.md"):
            continue
        told = list(counts(text))
        wrong = [f"{scene}: {part}, found {found}" for scene, part, said, found in told if said != found]
        results.append((f"{path}: {len(told)} counts of its scenes are those of inspect", wrong))
        results.append((f"{path}: no number without a command", uncovered(text, facts)))
        n, wrong = sums(text)
        computed += n
        results.append((f"{path}: {n} sums are right with the figures as printed", wrong))
    results.append(("every exercise of a text is there, and every exercise is in a text", exercises(texts)))
    results.append(("sums are found in the texts", [] if computed >= 10 else [f"{computed} of at least 10"]))
    results.append(("the terminal knows every command of a formula", commands_of_tex(texts)))
    results.append(("every slip of the printed lesson is in a text and in an exercise", slips(texts)))
    results.append(("what the table of slips names runs, and shows what is seen", shown_slips(all_facts["lessons/README.md"])))
    results.append(("a terminal without UTF-8 shows every text and formula", unreadable_in_ascii(texts)))
    results.append(("every kind of answer has an exercise to copy from", kinds()))
    results.append(("every text can be read", unreadable(texts)))
    results.append(("every exhibit runs", exhibits(texts)))
    results.append(("every figure has a title and is shown, and the commands in its boxes run", charts()))
    results.append(("the programs of the texts run", programs(texts)))
    results.append(("every text of a lesson is listed", [t for t in texts if t not in all_facts]))
    for n, (name, faults) in enumerate(results, 1):
        for fault in faults:
            print(f"# {fault}")
        print(f"{'not ok' if faults else 'ok'} {n} - {name}")
    print(f"1..{len(results)}")
    return 1 if any(faults for _, faults in results) else 0


if __name__ == "__main__":
    sys.exit(main())
