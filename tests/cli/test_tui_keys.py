# SPDX-License-Identifier: GPL-3.0-or-later
# The keys of the terminal workbench: one table, what the menu says, those of the page.
import os
import re
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402
from terminal import METHODS, ROOT, once  # noqa: E402


KEY_NAMES = {"HN_KEY_RIGHT": "<Right>", "HN_KEY_LEFT": "<Left>", "HN_KEY_SHIFT_RIGHT": "<ShiftRight>", "HN_KEY_SHIFT_LEFT": "<ShiftLeft>",
             "HN_KEY_BACKSPACE": "<Backspace>", "HN_KEY_HOME": "<Home>", "HN_KEY_END": "<End>", "HN_KEY_UP": "<Up>", "HN_KEY_DOWN": "<Down>"}
# what is seen after each key, typed at t = 0.5 s while the second of the methods is selected
SEEN = {"PLAY": "running", "NEXT": r"t 0\.520 s", "BACK": r"t 0\.480 s", "NEXT_TEN": r"t 0\.700 s", "BACK_TEN": r"t 0\.300 s",
        "START": r"t 0\.000 s", "FIRST": r"t 0\.000 s", "LAST": r"t 10\.000 s", "SLOWER": "×0.5", "FASTER": "×2", "UP": "why: index-1", "DOWN": "why: projection", "CYCLE": "why: projection",
        "PICTURES": "does not say that it shows pictures", "HIDE": r"Baumgarte .*\(hidden\)", "PLOT": r"error against the reference", "WHY": "why: Baumgarte", "REACTIONS": r"joint forces: Baumgarte .*\n.*multipliers lambda: determined", "STEP": r"dt of every method, as 0.02 or 20 ms:",
        "PARAMETERS": "length of the crank", "METHODS": "methods: Enter changes", "SCENES": "bennett", "FORMULAS": r"M a = f", "LESSONS": "Where do the links stand",
        "STUDY": "what accuracy costs in 10 s: Esc goes back", "MAP": "stability over alpha and beta in 3 s: arrows", "BUDGET": "their sum",
        "LINK": r"sent to the terminal's clipboard \(OSC 52\)[^#]+http://127.0.0.1:8080/#scene=four-bar", "EXPORT": "recording .*a row a frame", "UNDO": "nothing to undo",
        "REDO": "nothing to redo", "GLOSSARY": "Distance between the two halves of the joints", "HELP": "play or pause", "QUIT": None}


def keys_of_the_terminal():
    """[(action, key, what it means)] from the one table."""
    with open(os.path.join(ROOT, "server", "terminal", "keys.h"), encoding="utf-8") as file:
        rows = re.findall(r'X\((\w+), (\'.\'|\w+), "[^"]*", "([^"]*)"\)', file.read())
    return [(action, KEY_NAMES.get(key, key.strip("'")), means) for action, key, means in rows]


class TableOfKeys(unittest.TestCase):
    def test_no_key_is_bound_twice_and_the_digits_are_free(self):
        keys = [key for _, key, _ in keys_of_the_terminal()]
        self.assertGreater(len(keys), 25)
        self.assertEqual(len(keys), len(set(keys)))
        self.assertFalse(set(keys) & set("12345678"))

    def test_every_key_does_what_the_menu_says(self):
        table = keys_of_the_terminal()
        self.assertEqual({action for action, _, _ in table}, set(SEEN))
        with tempfile.TemporaryDirectory() as cache:
            for action, key, means in table:
                if SEEN[action] is None:
                    continue  # leaves no frame: the terminal's own tests type it
                # what is selected shows in the card of the reasons
                after = "i" if action in ("UP", "DOWN", "CYCLE") else ""
                # of a pendulum a study takes a second
                scene = "pendulum" if action in ("STUDY", "BUDGET") else "four-bar"
                methods = METHODS[:2] if scene == "pendulum" else METHODS
                status, out, err = once(scene, "--once", "--t", "0.5", "--size", "100x30", *methods, "--keys", "2" + key + after, HOLONOM_CACHE=cache)
                self.assertEqual((action, status, err), (action, 0, ""))
                self.assertRegex(out, SEEN[action], means)

    def test_keys_of_the_page_do_the_same_here(self):
        with open(os.path.join(ROOT, "web", "state", "keys.js"), encoding="utf-8") as file:
            text = file.read()
        here = {key: action for action, key, _ in keys_of_the_terminal()}
        same = {"toggle": "PLAY", "step 1": "NEXT", "step -1": "BACK", "step 10": "NEXT_TEN", "step -10": "BACK_TEN", "reset": "START",
                "slower": "SLOWER", "faster": "FASTER", "share": "LINK", "study work-precision": "STUDY", "study stability": "MAP",
                "study budget": "BUDGET", "undo": "UNDO", "redo": "REDO", "cycle": "CYCLE"}
        names = {"ArrowRight": "<Right>", "ArrowLeft": "<Left>", "Backspace": "<Backspace>"}
        rows = re.findall(r'key: "([^"]+)",(\s+shift: true,)?\s+context: "page",\s+action: "(\w+)"(?:,\s+argument: ("?[\w-]+"?))?', text)
        self.assertGreater(len(rows), 14)
        for key, shift, action, argument in rows:
            key = names.get(key, key)
            key = key.replace("<", "<Shift") if shift else key
            does = f"{action} {argument.strip(chr(34))}".strip()
            if does in ("help", "toggleKept"):
                # F1 opens the menu here too; the page alone keeps recordings
                self.assertNotIn(key, here)
            else:
                self.assertEqual(here.get(key), same[does], key)


if __name__ == "__main__":
    driver.main()
