# SPDX-License-Identifier: GPL-3.0-or-later
"""Tab, pressed in bash, zsh and fish: what stands on the line afterwards."""

import os
import re
import shlex
import shutil
import sys
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402
from tmux import PATIENCE, Tmux  # noqa: E402

PROGRAM = os.path.abspath(driver.PROGRAM)

# what is typed before Tab, and the line that Tab makes of it: a command, a scene, a parameter, a method and its integrator and option, an option,
# the kind of a study, the value of an option, a lesson, an exercise, a file
CASES = (("holonom sna", "holonom snapshot "), ("holonom run slider-c", "holonom run slider-crank "), ("holonom run four-bar --set l1", "holonom run four-bar --set l1="),
         ("holonom run four-bar --method baum", "holonom run four-bar --method baumgarte@"),
         ("holonom run four-bar --method projection@rk", "holonom run four-bar --method projection@rk4 "),
         ("holonom run four-bar --method baumgarte:al", "holonom run four-bar --method baumgarte:alpha="),
         ("holonom run four-bar --method baumgarte:alpha=5,be", "holonom run four-bar --method baumgarte:alpha=5,beta="),
         ("holonom run four-bar --met", "holonom run four-bar --method "), ("holonom study four-bar stab", "holonom study four-bar stability "),
         ("holonom tui four-bar --pictures si", "holonom tui four-bar --pictures sixel "), ("holonom lesson 06", "holonom lesson 06-drift "),
         ("holonom problem clos", "holonom problem closure "), ("holonom grade p3 my-ans", "holonom grade p3 my-answer.json "),
         ("holonom export four-bar --language jav", "holonom export four-bar --language java "),
         ("holonom equations four-bar --format la", "holonom equations four-bar --format latex "),
         ("holonom study four-bar stability --preset baum", "holonom study four-bar stability --preset baumgarte "),
         ("holonom run four-bar --set start.th3", "holonom run four-bar --set start.th3="), ("holonom extreme X25", "holonom extreme X25 "),
         ("holonom report four-bar slider-c", "holonom report four-bar slider-crank "))
# what Tab lists, and what it says of it: a language, a parameter with its range, an exercise
LISTS = (("holonom export four-bar --language ", r"wolfram", r"wolfram"), ("holonom run four-bar --set ", r"start\.w1", r"0\.1 to 3 m, now 0\.5: length of the crank"),
         ("holonom problem p", r"p2", r"Null-space projection"))
# values that are no files, though a file begins so: Tab leaves the line, and the next letter stands behind it
NO_FILES = ("holonom run four-bar --time my", "holonom run four-bar --set l1=my", "holonom list my")


class Completion(Tmux):
    def complete_in(self, shell, prompt, source):
        if not shutil.which(shlex.split(shell)[0]):
            self.skipTest(f"{shell} is not here")
        home = self.folder.name
        os.symlink(PROGRAM, os.path.join(home, "holonom"))
        with open(os.path.join(home, "my-answer.json"), "w", encoding="ascii") as file:
            file.write("{}")
        self.start(100, 30, source, shell=f"env HOME={home} XDG_CONFIG_HOME={home} XDG_DATA_HOME={home} PATH={home}:{os.environ['PATH']} {shell}",
                   prompt=f"{prompt}; cd {home}")
        self.wait_for(r"(?m)^ready$")
        for typed, wanted in CASES:
            self.keys("C-u")
            self.keys("-l", typed)
            self.wait_for(rf"> {re.escape(typed)}\s*\n")
            self.keys("Tab")
            self.assertTrue(self.stands(wanted), f"{shell}: after '{typed}' and Tab there is\n{self.screen()}")
        for typed in NO_FILES:
            self.drop_line()
            self.keys("-l", typed)
            self.wait_for(rf"> {re.escape(typed)}\s*\n")
            self.keys("Tab")
            self.keys("-l", "x")
            self.assertTrue(self.stands(typed + "x"), f"{shell}: after '{typed}', Tab and x there is\n{self.screen()}")
        for typed, name, says in LISTS:
            self.drop_line()
            self.keys("C-l")
            self.keys("-l", typed)
            self.wait_for(rf"> {re.escape(typed)}?\s*\n")
            self.keys(*("Tab", "Tab")[:2 if shell.startswith("bash") else 1])
            self.wait_for(f"(?s)(?=.*{name})(?=.*{says})")

    def drop_line(self):
        """Ctrl-C until the prompt is alone on its line: a shell that is still listing candidates misses the first one."""
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            self.keys("C-c")
            for _ in range(20):
                screen = self.screen().split("\n")
                if screen[int(self.tmux("display-message", "-p", "#{cursor_y}"))].rstrip() == ">":
                    return
                time.sleep(0.05)
        self.fail(f"the line was not dropped\n{self.screen()}")

    def stands(self, line):
        """Returns whether the line of the cursor is this one, the cursor behind it."""
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            screen = self.screen().split("\n")
            x, y = map(int, self.tmux("display-message", "-p", "#{cursor_x} #{cursor_y}").split())
            if screen[y].startswith("> " + line.rstrip()) and x == len("> " + line) and screen[y].rstrip() == "> " + line.rstrip():
                return True
            time.sleep(0.05)
        return False

    def test_bash(self):
        self.complete_in("bash --norc --noprofile", "PS1='> '", "source <(holonom completion bash); echo ready")

    def test_zsh(self):
        self.complete_in("zsh -f", "PS1='> '; unsetopt PROMPT_SP", "autoload -Uz compinit; compinit -u -D; source <(holonom completion zsh); echo ready")

    def test_fish(self):
        # what fish suggests by itself in grey would stand behind the cursor
        self.complete_in("fish --no-config", "function fish_prompt; echo -n '> '; end; set -g fish_autosuggestion_enabled 0", "holonom completion fish | source; echo ready")


if __name__ == "__main__":
    driver.main()
