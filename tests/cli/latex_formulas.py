# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the formulas of an exported sheet in LaTeX as expressions of Python."""

import re

MACROS = {r"\sin": "sin", r"\cos": "cos", r"\tan": "tan", r"\arcsin": "asin", r"\arccos": "acos", r"\arctan": "atan", r"\sinh": "sinh", r"\cosh": "cosh",
          r"\tanh": "tanh", r"\exp": "exp", r"\ln": "log", r"\min": "min", r"\max": "max", r"\sqrt": "sqrt", r"\,": "*", r"\cdot": "*", r"\lvert": "abs(", r"\rvert": ")"}  # fmt: skip


def closing(text, at):
    """Where the bracket that opens at `at` closes."""
    depth = 0
    for i in range(at, len(text)):
        depth += text[i] in "({"
        depth -= text[i] in ")}"
        if depth == 0:
            return i
    raise ValueError(f"never closed: {text[at:at + 40]}")


def formula(text, names):
    """A formula as an expression of Python; `names` has the spelling of each symbol and its number."""
    out, i = "", 0
    group = lambda at: (formula(text[at + 1:closing(text, at)], names), closing(text, at) + 1)
    while i < len(text):
        name = next((n for n in names if text.startswith(n, i) and not (n[-1].isalpha() and n[0] == "\\" and text[i + len(n):i + len(n) + 1].isalpha())), None)
        macro = re.match(r"\\operatorname\{\w+\}|\\[A-Za-z]+|\\,", text[i:])
        if name:
            out, i = f"{out}N[{names[name]}]", i + len(name)
        elif macro and macro.group(0) in (r"\frac", r"\tfrac"):
            above, i = group(i + macro.end())
            below, i = group(i)
            out += f"(({above})/({below}))"
        elif macro and macro.group(0) == r"\ensuremath":
            inner, i = group(i + macro.end())
            out += f"({inner})"
        elif macro:
            word, i, power = macro.group(0), i + macro.end(), ""
            word = MACROS.get(word) or word[14:-1]
            if text[i:i + 2] == "^{":
                power, i = group(i + 1)
            if text[i:i + 1] in "({" and word.isalnum():
                inner, i = group(i)
                word = f"{word}({inner})"
            out += f"{word}**({power})" if power else word
        elif text[i] == "^":
            power, i = group(i + 1)
            out += f"**({power})"
        else:
            out, i = out + text[i], i + 1
    return out
