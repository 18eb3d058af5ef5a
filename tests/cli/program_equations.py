# SPDX-License-Identifier: GPL-3.0-or-later
"""Equations of exported programs that no tool here runs, statement by statement, beside those of the program in Python.

Each statement is respelled for Python, and every entry of every term must be what the program in Python has, to rounding.
"""

import functools
import math
import os
import re
import subprocess

from latex_formulas import closing, formula

PROGRAM = os.path.abspath(os.environ.get("HOLONOM", "build/holonom"))
RESPELLED = ("wolfram", "modelica", "julia")
TERMS = {"mass", "force", "jacobian", "bias", "closure", "closure_rate", "energy"}
FUNCTIONS = {"Sin": math.sin, "Cos": math.cos, "Tan": math.tan, "ArcSin": math.asin, "ArcCos": math.acos, "Sqrt": math.sqrt, "Exp": math.exp, "Log": math.log,
             "Sinh": math.sinh, "Cosh": math.cosh, "Tanh": math.tanh, "Abs": abs, "Max": max, "Min": min, "UnitStep": lambda x: float(x >= 0),
             "ArcTan": lambda *x: math.atan2(x[1], x[0]) if len(x) == 2 else math.atan(x[0]), "Sign": lambda x: (x > 0) - (x < 0), "Float64": float,
             "sign": lambda x: (x > 0) - (x < 0), "step": lambda x: float(x >= 0), **{n: getattr(math, n) for n in dir(math) if n[0] != "_"}, "abs": abs, "min": min, "max": max,
             "atan": lambda *x: math.atan2(*x) if len(x) == 2 else math.atan(x[0])}  # fmt: skip


def exported(scene, language):
    """The program of a scene in a language."""
    return subprocess.run([PROGRAM, "export", scene, "--language", language], capture_output=True, text=True, timeout=3600).stdout


def respell(language, line):
    """A statement as Python writes it."""
    line = re.sub(r"\(\*.*?\*\)|//.*|#.*", "", line).strip().rstrip(";")
    if language == "wolfram":
        line = re.sub(r"\[\[([^\]]*)\]\]", r"<\1>", line.replace("*^", "e").replace("$", "_"))
        line = re.sub(r"<([0-9, ]+)>", r"[\1]", line.replace("[", "(").replace("]", ")"))
    if language == "modelica":
        line = re.sub(r"\(if (.*?) then 1\.0 else 0\.0\)", r"float(\1)", line.replace(":=", "="))
    return line.replace("^", "**")


def evaluate(language, text):
    """(term, row, column): value at the start, by the statements of a program."""
    first = 0 if language == "python" else 1
    names = {**FUNCTIONS, "t": 0.0, **{term: {} for term in TERMS}}
    for array, word in (("q", "START_Q"), ("v", "START_V")):
        word = {"wolfram": f"start{array.upper()}"}.get(language, word)
        if language == "julia":
            lists = re.search(r"const START_Q, START_V, CHECK_T = (.*)", text).group(1)
            numbers = re.findall(r"\[(.*?)\]", lists)["qv".index(array)]
        else:
            numbers = re.search(rf"{word}(?:\[\w+\])? = (?:np\.array\()?[\[{{](.*?)[\]}}]", text).group(1)
        names[array] = {k + first: float(x.replace("*^", "e")) for k, x in enumerate(numbers.split(","))}
    wanted = re.compile(r"[A-Za-z_]\w*(\[[0-9, ]+\])? = .+")
    begins, ends = {"python": (r"def terms", r"\n    return "), "wolfram": (r"terms\[t_", r"\n\];"), "modelica": (r"  algorithm", r"end terms"),
                    "julia": (r"function terms", r"\n    return")}[language]  # fmt: skip
    head, _, rest = text.partition(re.search(begins, text).group(0))
    block = re.split(ends, rest)[0]
    for line in (head + "\n" + block if language in ("python", "wolfram") else block).splitlines():
        line = respell(language, line)
        is_setting = wanted.fullmatch(line) and not re.search(r"zeros|Array|range|import|np\.", line) and line.split(" ")[0] not in ("NQ", "ALPHA")
        is_setting = is_setting and not re.match(r"(energy|closure\w*|bias) = ", line)
        if is_setting:
            exec(line, names)  # noqa: S102 (the program's own statements)
    index = lambda key: tuple(k - first for k in key) if isinstance(key, tuple) else (key - first,)
    return {(term, *index(key)): value for term in TERMS for key, value in names[term].items()}


def unmatched(language, text):
    """The first bracket that has no partner, outside comments and texts."""
    text = re.sub({"wolfram": r"\(\*.*?\*\)", "modelica": r"//[^\n]*", "julia": r"#[^\n]*"}[language], "", text, flags=re.S)
    stack = []
    for c in re.sub(r'"[^"]*"' if language != "julia" else r'"[^"\n]*"', "", text.replace("jacobian'", "jacobian").replace("y'", "y")):
        if c in "([{":
            stack.append(c)
        elif c in ")]}" and (not stack or "([{".index(stack.pop()) != ")]}".index(c)):
            return f"a {c} without its partner"
    return f"{stack[-1]} is never closed" if stack else ""


@functools.lru_cache
def equations_in_python(scene):
    return evaluate("python", exported(scene, "python"))


def equations_faults(scene, language):
    """Where the equations of a language differ from those of the program in Python."""
    text = exported(scene, language)
    ours, theirs = equations_in_python(scene), evaluate(language, text)
    faults = [unmatched(language, text)] if unmatched(language, text) else []
    faults += [f"entries that differ: {sorted(ours.keys() ^ theirs.keys())[:5]}"] if ours.keys() != theirs.keys() or not ours else []
    # the same operations on the same numbers, but for the order in which a library rounds
    return faults + [f"{key}: {theirs[key]!r} is not {value!r}" for key, value in ours.items() if key in theirs and not abs(theirs[key] - value) <= 1e-13 * max(1.0, abs(value))][:5]


def formulas_faults(scene):
    """Where the formulas of the sheet differ from the program in Python. Symbols get the program's numbers, which have all digits."""
    text, program = (exported(scene, name) for name in ("latex", "python"))
    numbers = [float(x) for x in re.findall(r"^\w+ = (\S+) # ", program.partition("def ")[0], re.M)]
    for word in ("START_Q", "START_V"):
        numbers += [float(x) for x in re.search(rf"{word} = np\.array\(\[(.*?)\]", program).group(1).split(",")]
    lines = []
    for line in (line for line in text.splitlines() if line.startswith(r"\eq{")):
        end = closing(line, 3)
        lines.append((line[4:end], line[end + 2:closing(line, end + 1)]))
    first = next(i for i, (left, _) in enumerate(lines) if left == "q_{1}")
    symbols = [left for left, _ in lines[:first]] + [right for left, right in lines[first:] if re.fullmatch(r"[qv]_\{\d+\}", left)]
    if len(symbols) != len(numbers):
        return [f"{len(symbols)} symbols, {len(numbers)} numbers"]
    values, got = {**dict(zip(symbols, numbers)), "t": 0.0}, {}
    for left, right in lines[len(symbols):]:
        if left.startswith(r"\term{rate}"):
            continue
        spelled = sorted(values, key=len, reverse=True)
        known = {name: i for i, name in enumerate(spelled)}
        value = eval(formula(right, known), {**FUNCTIONS, "N": [values[name] for name in spelled]})  # noqa: S307 (the sheet's own formulas)
        term = re.fullmatch(r"\\term\{(\w+)\}_\{([\d,]+)\}", left)
        if term:
            got[(term.group(1), *(int(k) - 1 for k in term.group(2).split(",")))] = value
        else:
            values[left] = value
    wanted = {key: value for key, value in equations_in_python(scene).items() if key[0] != "mass" or key[1] <= key[2]}
    faults = [f"entries that differ: {sorted(got.keys() ^ wanted.keys())[:5]}"] if got.keys() != wanted.keys() or not got else []
    # the same terms in another order: each entry is rounded a few dozen times at the size of its largest term
    return faults + [f"{key}: {got[key]!r} is not {value!r}" for key, value in wanted.items() if key in got and not abs(got[key] - value) <= 1e-11 * max(1.0, abs(value))][:5]
