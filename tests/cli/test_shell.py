# SPDX-License-Identifier: GPL-3.0-or-later
"""Comfort in a shell: completion asks the program, the manual is made from the tables of the help."""

import fcntl
import json
import os
import pty
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import termios
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "api"))
import driver  # noqa: E402
from test_programs import TROUBLE  # noqa: E402

PROGRAM = os.path.abspath(driver.PROGRAM)
ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")


def call(*words):
    return subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=600)


def in_terminal(columns, *words, rows=24, stdin=subprocess.DEVNULL, env=None):
    """Exit status, what a terminal of that size gets (bytes), what stderr gets (text). `stdin` None: the terminal itself."""
    master, slave = pty.openpty()
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
    with tempfile.TemporaryFile("w+") as errors, \
            subprocess.Popen([PROGRAM, *words], stdin=slave if stdin is None else stdin, stdout=slave, stderr=errors, env=env) as process:
        os.close(slave)
        shown = b""
        try:
            while more := os.read(master, 65536):
                shown += more
        except OSError:  # the last writer has closed the terminal
            pass
        os.close(master)
        status = process.wait(timeout=600)
        errors.seek(0)
        return status, shown, errors.read()


def candidates(*words):
    return [line.split("\t")[0] for line in call("complete", "--", *words).stdout.splitlines()]


class Completion(unittest.TestCase):
    def test_one_method_is_described_by_its_card(self):
        card = call("list", "methods", "baumgarte").stdout
        self.assertRegex(card, r"\Abaumgarte: .*\n  idea ")
        self.assertIn("    alpha: damping of the gap [1/s]", card)
        self.assertEqual(json.loads(call("list", "methods", "rk4", "--json").stdout)["order"], 4)
        for words, said in ((("methods", "rk44"), "did you mean 'rk4'?"), (("scenes", "four-bar"), "'holonom inspect NAME' describes a scene")):
            refused = call("list", *words)
            self.assertEqual((refused.returncode, refused.stdout), (2, ""))
            self.assertIn(said, refused.stderr)

    def test_commands_options_scenes_and_words_are_offered(self):
        self.assertEqual(candidates("sna"), ["snapshot"])
        self.assertIn("--methods", candidates("compare", "four-bar", "--m"))
        self.assertEqual(candidates("run", "slider"), ["slider-crank"])
        self.assertEqual(candidates("study", "four-bar", "stab"), ["stability"])
        self.assertLessEqual({"p1", "p2", "p3", "p4", "p5"}, set(candidates("grade", "p")))
        lessons = json.loads(call("list", "lessons", "--json").stdout)["lessons"]
        self.assertEqual(candidates("lesson", ""), [lesson["id"] for lesson in lessons])

    def test_methods_and_their_options_are_offered_in_pieces(self):
        self.assertEqual(candidates("run", "four-bar", "--method", "baum"), ["baumgarte@"])
        self.assertIn("index1@rk4", candidates("run", "four-bar", "--method", "index1@rk"))
        self.assertEqual(candidates("run", "four-bar", "--method", "baumgarte:alpha=5,be"), ["baumgarte:alpha=5,beta="])
        self.assertIn("index1@rk4:h=", candidates("compare", "four-bar", "--methods", "projection@rk4", "index1@rk4:"))

    def test_parameters_come_with_their_range(self):
        text = call("complete", "--", "run", "four-bar", "--set", "l1").stdout
        self.assertRegex(text, r"^l1=\t0\.1 to 3 m, now 0\.5: length of the crank\n$")

        # behind the sign: the present value and the ends of the range
        values = call("complete", "--", "run", "four-bar", "--set", "l1=").stdout
        self.assertEqual(values, "l1=0.5\tits value now, in m\nl1=0.1\tthe smallest, in m\nl1=3\tthe largest, in m\n")

    def test_exercises_come_with_their_titles(self):
        self.assertEqual(call("complete", "--", "problem", "p2").stdout, "p2\tNull-space projection\n")
        self.assertEqual(call("complete", "--", "grade", "p2").stdout, "p2\tNull-space projection\n")

    def test_nothing_is_offered_where_nothing_is_known(self):
        for words in (["nonsense", "x"], ["run", "no-such-scene", "--set", "l"], ["import", "fi"], []):
            self.assertLess(len(candidates(*words)), 40)
        self.assertEqual(candidates("nonsense", "x"), [])

    # a line that is typed so far, and what every shell must offer for its last word: commands, scenes, parameters, methods, options of methods,
    # options, kinds of studies, files
    CASES = (("sna", "snapshot"), ("run four-b", "four-bar"), ("run four-bar --set l1", "l1="), ("run four-bar --method projection@rk", "projection@rk4"),
             ("run four-bar --method baumgarte:al", "baumgarte:alpha="), ("run four-bar --met", "--method"), ("study four-bar stab", "stability"),
             ("tui four-bar --pictures si", "sixel"), ("grade p3 ans", "answer.json"))

    def offered(self, shell, script):
        """{line: what is offered}, from a script that prints a line "> LINE" and below it what it was offered."""
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(PROGRAM, os.path.join(folder, "holonom"))
            with open(os.path.join(folder, "answer.json"), "w", encoding="ascii") as file:
                file.write("{}")
            env = {**os.environ, "PATH": folder + ":" + os.environ["PATH"], "HOME": folder, "HOLONOM_CACHE": folder, "LC_ALL": "C.UTF-8"}
            done = subprocess.run([*shell, script], capture_output=True, text=True, timeout=120, cwd=folder, env=env)
        parts = re.split(r"^> (.*)$", done.stdout, flags=re.M)
        self.assertEqual(len(parts), 2 * len(self.CASES) + 1, done.stdout + done.stderr)
        return dict(zip(parts[1::2], parts[2::2]))

    def assert_offered(self, offered):
        for line, wanted in self.CASES:
            self.assertRegex(offered[line], rf"(?m)^{re.escape(wanted)}(\s|$)", line)

    def test_bash_completes_with_what_the_program_says(self):
        cases = "".join(f"COMP_LINE='holonom {line}'; COMP_POINT=${{#COMP_LINE}}; COMP_WORDBREAKS=; COMPREPLY=(); _holonom 2>/dev/null; echo '> {line}'; "
                        # what bash does itself when nothing is offered: complete -o default
                        f'((${{#COMPREPLY[@]}})) && printf "%s\\n" "${{COMPREPLY[@]}}" || compgen -f -- "{line.split()[-1]}"; ' for line, _ in self.CASES)
        self.assert_offered(self.offered(["bash", "-c"], "source <(holonom completion bash); complete -p holonom | grep -q default || exit 1; " + cases))

    def test_zsh_completes_with_what_the_program_says(self):
        # compadd and _files outside of a completion refuse; what they are given is what counts
        head = ("compdef() { :; }; compadd() { print -rl -- ${@[$@[(i)--] + 1,-1]}; }; _files() { print -rl -- ${words[CURRENT]}*(N); }; "
                "words=(holonom); CURRENT=1; source <(holonom completion zsh) >/dev/null; ")
        cases = "".join(f"words=(holonom {line}); CURRENT={len(line.split()) + 1}; print -r -- '> {line}'; _holonom; " for line, _ in self.CASES)
        self.assert_offered(self.offered(["zsh", "-f", "-c"], head + cases))

    def test_fish_completes_with_what_the_program_says(self):
        cases = "".join(f"echo '> {line}'; complete -C 'holonom {line}'; " for line, _ in self.CASES)
        self.assert_offered(self.offered(["fish", "-c"], "holonom completion fish | source; " + cases))

    def test_an_unknown_shell_is_refused(self):
        done = call("completion", "tcsh")
        self.assertEqual(done.returncode, 2)
        self.assertIn("bash, zsh and fish", done.stderr)


# they wait for somebody, take minutes, or need files of their own; other tests run these commands
LEFT_OUT = ("serve", "report", "merge", "import")


class Help(unittest.TestCase):
    def test_every_line_of_help_fits_eighty_columns(self):
        for words in [[], ["words"], *([c] for c in re.findall(r"^  holonom (\w+)", call("help").stdout, re.M))]:
            wide = [line for line in call("help", *words).stdout.splitlines() if len(line) > 80]
            self.assertEqual(wide, [], words)

    def test_help_fits_a_narrower_terminal(self):
        env = {**os.environ, "COLUMNS": "60", "LC_ALL": "C.UTF-8"}
        for words in (["help"], ["help", "words"], ["help", "serve"], ["run", "--help"], []):
            done = subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=600, env=env)
            lines = (done.stdout or done.stderr).splitlines()
            self.assertGreater(len(lines), 8, words)
            # one word that is longer than a line stays whole
            self.assertEqual([line for line in lines if len(line) > 60 and " " in line.strip()], [], words)

    def test_terms_of_messages_are_explained(self):
        words = call("help", "words").stdout
        heads = [word for line in re.findall(r"(?m)^(\S.*)$", words) for word in line.split(", ")]
        self.assertEqual(len(heads), len(set(heads)))
        # what the reports of a run have in brackets, and the status of a table
        told = call("run", "parallelogram", "--method", "projection@rk4:h=1e-3", "--time", "1", "--at", "1").stderr
        terms = set(re.findall(r"\((?:an? )?([a-zA-Z_ ]+)\)", told)) - set(re.findall(r"\((between [^)]*)\)", told))
        self.assertGreaterEqual(terms, {"J loses rank"})
        self.assertIn("pivot ratio ", told)
        self.assertIn("a pilot run", told)
        self.assertIn("smallest singular value of the scaled J, sigma_min,", told)
        for term in terms | {"pilot run", "pivot ratio", "sigma_min", "right", "inaccurate", "WRONG", "error estimate"}:
            self.assertIn(term, heads)

    def test_a_term_is_found_by_its_name(self):
        everything = call("help", "words").stdout
        for words, head in ((["words", "lambda"], "lambda, multipliers"), (["lambda"], "lambda, multipliers"), (["Multipliers"], "lambda, multipliers"),
                            (["dead point"], "singular configuration"), (["dead", "point"], "singular configuration"),
                            (["alpha"], "alpha, beta"), (["words", "beta"], "alpha, beta")):
            done = call("help", *words)
            self.assertEqual((done.returncode, done.stdout.splitlines()[0]), (0, head), done.stderr)
            self.assertEqual(len(re.findall(r"(?m)^\S", done.stdout)), 1, words)
            self.assertIn(done.stdout, everything)
        self.assertTrue(call("help", "run").stdout.startswith("holonom run "))  # a command comes first
        done = call("help", "words", "nonsense")
        self.assertEqual((done.returncode, "'nonsense'" in done.stderr), (2, True))

    def test_holonom_alone_says_what_to_do_first(self):
        done = call()
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        for command in ("holonom serve", "holonom tui", "holonom compare", "holonom help"):
            self.assertIn(command, done.stderr)
        # each command begins with the name that was typed, and works before make install
        typed = os.path.relpath(PROGRAM)
        done = subprocess.run([typed], capture_output=True, text=True, env={**os.environ, "COLUMNS": "80"})
        self.assertIn(f"  {typed} serve ", done.stderr)
        self.assertIn("'make install' puts it on the path", done.stderr)
        self.assertLessEqual(max(map(len, done.stderr.splitlines())), 80)
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(os.path.abspath(PROGRAM), os.path.join(folder, "holonom"))
            done = subprocess.run(["holonom"], capture_output=True, text=True, env={**os.environ, "PATH": folder})
        self.assertIn("\n  holonom serve ", done.stderr)
        self.assertNotIn("make install", done.stderr)

    def test_every_command_has_three_examples_and_they_run(self):
        with tempfile.TemporaryDirectory() as folder:
            answer = os.path.join(os.path.dirname(__file__), "..", "..", "lessons", "01-closed-loops", "answers", "p3.json")
            shutil.copy(answer, os.path.join(folder, "answer.json"))
            with open(os.path.join(folder, "verdict.json"), "w", encoding="utf-8") as f:
                f.write(call("grade", "p3", os.path.join(folder, "answer.json"), "--format", "json").stdout)
            os.mkdir(os.path.join(folder, "handed-in"))
            shutil.copy(answer, os.path.join(folder, "handed-in", "ada.json"))
            call("export", "four-bar", "--language", "c", "--blanks", "-o", os.path.join(folder, "filled-in.c"))
            for command in re.findall(r"^  holonom (\w+)", call("help").stdout, re.M):
                lines = re.findall(r"^  holonom (.+)$", call("help", command).stdout.split("examples\n")[-1], re.M)
                self.assertEqual(len(lines), 3, command)
                for line in lines:
                    if command not in LEFT_OUT and not re.search(r"[|>]", line) and line != "tui" and not (TROUBLE and "filled-in" in line):
                        done = subprocess.run([PROGRAM, *line.split()], capture_output=True, text=True, timeout=300, cwd=folder,
                                              stdin=subprocess.DEVNULL)
                        self.assertEqual((line, done.returncode), (line, 0), done.stderr)

    def test_lists_have_short_names(self):
        for kind in ("scenes", "methods", "lessons", "problems"):
            self.assertEqual(call(kind).stdout, call("list", kind).stdout)

    def test_a_long_text_goes_through_the_pager_of_a_terminal(self):
        env = {**os.environ, "PAGER": "sed -n 's/^/paged /;1p'", "LC_ALL": "C.UTF-8"}
        _, shown, _ = in_terminal(80, "list", "scenes", rows=10, stdin=None, env=env)
        self.assertTrue(shown.startswith(b"paged "), shown)


class Width(unittest.TestCase):
    COMMANDS = (["list", "scenes"], ["list", "methods"], ["list", "lessons"], ["list", "problems"], ["inspect", "four-bar"],
                ["equations", "four-bar"], ["terms", "four-bar", "--reactions"], ["compare", "four-bar", "--time", "0.5"],
                ["compare", "four-bar", "--time", "0.5", "--plot"], ["run", "four-bar", "--time", "0.5", "--plot"], ["extreme", "x1", "x2"],
                ["study", "pendulum", "work-precision", "--time", "0.5", "--levels", "3", "--samples", "1"], ["study", "fb0", "budget", "--time", "0.5"],
                ["study", "slider-crank", "stability", "--over", "h=1e-4..1e-1,c=1..1000", "--grid", "6x6"], ["reference", "fb0"],
                ["problem", "p3"], ["problem", "p1", "--seeds", "1..2", "--check"], ["grade", "p3", "bad.json"], ["regrade", "verdict.json"],
                ["rubric", "check", "rubric.json"],
                ["grade", "p3", "handed-in"], ["lesson", "1"], ["snapshot", "four-bar", "-o", "a.png"], ["import", "robot.urdf", "-o", "b.json"],
                ["tui", "--once"], ["help"], ["help", "serve"], ["help", "words"], ["version", "--json"])
    # they wait for somebody, take minutes, or what they print is a program, roff or a script
    NO_TEXT = ("serve", "report", "merge", "export", "program", "manual", "completion")

    def test_every_command_that_prints_text_is_among_them(self):
        every = set(re.findall(r"^  holonom (\w+)", call("help").stdout, re.M))
        self.assertEqual({words[0] for words in self.COMMANDS}, every - set(self.NO_TEXT))

    @staticmethod
    def lines(words, columns):
        """What is printed, remarks included, in a folder with the files that commands read."""
        lessons = os.path.join(ROOT, "lessons", "01-closed-loops", "answers", "p3.json")
        with tempfile.TemporaryDirectory() as folder:
            with open(lessons, encoding="utf-8") as file:
                answer = file.read()
            os.mkdir(os.path.join(folder, "handed-in"))
            for name, text in (("answer.json", answer), ("bad.json", answer.replace("sin", "cos")), ("handed-in/ada.json", answer)):
                with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                    file.write(text)
            shutil.copy(os.path.join(ROOT, "tests", "import", "four-bar.urdf"), os.path.join(folder, "robot.urdf"))
            env = {**os.environ, "LC_ALL": "C.UTF-8", "COLUMNS": str(columns), "HOLONOM_CACHE": os.path.join(folder, "cache")}
            if words[0] == "rubric":
                subprocess.run([PROGRAM, "rubric", "write", "p3", "-o", "rubric.json"], timeout=600, cwd=folder, env=env, check=True)
            if words[0] == "regrade":
                with open(os.path.join(folder, "verdict.json"), "w", encoding="utf-8") as file:
                    subprocess.run([PROGRAM, "grade", "p3", "bad.json", "--json"], stdout=file, timeout=600, cwd=folder, env=env, check=True)
            done = subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=300, env=env, cwd=folder)
        return done.stdout.splitlines() + done.stderr.splitlines()

    def test_no_line_of_any_command_is_wider_than_eighty_columns(self):
        for words in self.COMMANDS:
            lines = self.lines(words, 80)
            self.assertTrue(lines or words[0] == "snapshot", words)
            # one word that is longer than a line stays whole
            wide = [line for line in lines if len(line) > 80 and " " in line.strip()]
            self.assertEqual(wide, [], words)

    def test_products_of_long_names_are_broken(self):
        for scene in ("bennett", "delta-robot", "stephenson-six-bar"):
            self.assertEqual([line for line in self.lines(["equations", scene], 80) if len(line) > 80], [], scene)

    def test_no_message_is_wider_than_eighty_columns(self):
        for words in (["run", "four-bar", "--set", "l1=300"], ["study", "four-bar", "stability", "--over", "h=1..2,zz=1..2"], ["compare", "nosuch.json"],
                      ["run", "four-bar", "--method", "index1@rk4:h=0.5", "--time", "2", "--plot"]):
            lines = self.lines(words, 80)
            self.assertTrue(any("holonom:" in line for line in lines), lines)
            self.assertEqual([line for line in lines if len(line) > 80], [], words)

    def test_columns_that_do_not_fit_are_named_and_wide_shows_them(self):
        narrow, wide = (self.lines(["compare", "four-bar", "--time", "0.5", *more], 80) for more in ([], ["--wide"]))
        self.assertRegex(" ".join(narrow), r"not shown in 80 columns: t, .*evals, ops.* \(--wide shows them\)")
        self.assertIn("evals", wide[1])
        self.assertNotIn("left out", " ".join(wide))

    def test_a_pipe_gets_every_column(self):
        env = {k: v for k, v in os.environ.items() if k != "COLUMNS"}
        done = subprocess.run([PROGRAM, "compare", "four-bar", "--time", "0.5"], capture_output=True, text=True, timeout=600, env=env)
        self.assertIn("evals", done.stdout)
        self.assertNotIn("\033", done.stdout)

    def test_a_pipe_gets_paragraphs_of_eighty_columns_unless_it_is_wide(self):
        env = {k: v for k, v in os.environ.items() if k != "COLUMNS"}
        narrow, wide = (subprocess.run([PROGRAM, "problem", "p3", *more], capture_output=True, text=True, timeout=600, env=env).stdout for more in ([], ["--wide"]))
        paragraphs = lambda text: [len(line) for line in text.splitlines() if not line.startswith(" ")]
        self.assertLessEqual(max(paragraphs(narrow)), 80)
        self.assertGreater(max(paragraphs(wide)), 100)
        # what is set in is formulas and answers to be copied: it keeps its lines
        self.assertEqual([line for line in narrow.splitlines() if line.startswith(" ")], [line for line in wide.splitlines() if line.startswith(" ")])
        self.assertEqual(narrow.split(), wide.split())

    def test_a_frame_of_the_workbench_fits_the_terminal_that_it_is_printed_in(self):
        for columns, widest in ((60, 60), (80, 80), (120, 80)):
            _, shown, _ = in_terminal(columns, "tui", "four-bar", "--once", env={**os.environ, "TERM": "xterm", "LC_ALL": "C.UTF-8"})
            lines = re.sub(r"\x1b\[[0-9;]*m", "", shown.decode()).splitlines()
            self.assertEqual((max(map(len, lines)), len(lines)), (widest, 24))

    def test_a_terminal_gets_colours_unless_it_says_no(self):
        for more, coloured in (({}, True), ({"NO_COLOR": "1"}, False), ({"TERM": "dumb"}, False)):
            env = {**os.environ, "TERM": "xterm-256color", "LC_ALL": "C.UTF-8", **more}
            if "NO_COLOR" not in more:
                env.pop("NO_COLOR", None)
            _, shown, _ = in_terminal(80, "list", "problems", rows=60, env=env)
            self.assertEqual(b"\033[1m" in shown, coloured, more)


class NearMisses(unittest.TestCase):
    def test_a_terminal_gets_a_table_of_a_run_that_fits_and_a_pipe_the_samples(self):
        words = ("run", "four-bar", "--time", "0.1", "--every", "0.02", "--method", "index1@rk4:h=0.01")
        for columns in (60, 80, 200):
            _, shown, told = in_terminal(columns, *words)
            rows = shown.decode().splitlines()
            self.assertEqual(len(rows), 7, rows)
            self.assertEqual(len({len(row) for row in rows}), 1, "aligned")
            self.assertLessEqual(len(rows[0]), columns)
            # the gap stays when there is little room, and what was left out is told
            self.assertEqual(rows[0].split()[0], "t")
            self.assertIn("gap", rows[0].split())
            self.assertRegex(" ".join(told.split()), r"\d+ of 27 columns have no room here; all of them, with all digits: holonom run four-bar --format csv > FILE")
        self.assertTrue(call(*words).stdout.startswith("t,th1,a2,th3,"))

    def test_one_method_and_several_are_typed_with_either_option(self):
        one = ("--time", "0.1", "--every", "0.1")
        self.assertEqual(call("run", "pendulum", "--methods", "index1@rk4", *one).stdout, call("run", "pendulum", "--method", "index1@rk4", *one).stdout)
        self.assertIn("index1@rk4", call("compare", "pendulum", "--method", "index1@rk4", "--time", "0.1").stdout)
        self.assertEqual(call("tui", "pendulum", "--method", "index1@rk4", "--once").returncode, 0)
        refused = call("run", "pendulum", "--methods", "index1@rk4", "projection@rk4", *one)
        self.assertEqual((refused.returncode, refused.stdout), (2, ""))
        self.assertEqual(" ".join(refused.stderr.split()), "holonom: 'run' takes one method, and 'projection@rk4' follows 'index1@rk4' 'holonom compare' takes several")

    def test_help_on_half_a_method_shows_its_card(self):
        for half in ("projection", "radau5"):
            card = call("help", half)
            self.assertEqual((card.returncode, card.stdout), (0, call("list", "methods", half).stdout))
            self.assertIn("source", card.stdout)

    def test_what_is_typed_wrong_is_answered_with_what_was_meant(self):
        for words, meant in ((["compar", "four-bar"], "compare"), (["compare", "fuor-bar"], "four-bar"), (["study", "four-bar", "stabilty"], "stability"),
                             (["study", "four-bar", "work-precison"], "work-precision"), (["list", "scnes"], "scenes"), (["help", "rum"], "run"),
                             (["run", "four-bar", "--mehtod", "x"], "--method"), (["run", "four-bar", "--method", "baumgrate@rk4"], "baumgarte"),
                             (["run", "four-bar", "--method", "index1@rk5"], "rk4"), (["run", "four-bar", "--set", "l11=1"], "l1"),
                             (["run", "four-bar", "--method", "baumgarte:alpa=3@rk4"], "alpha"), (["problem", "p33"], "p3"),
                             (["problem", "p33", "--check", "--seeds", "1..2"], "p3"), (["export", "four-bar", "--language", "pyton"], "python"),
                             (["run", "four-bar", "--format", "cvs"], "csv"), (["equations", "four-bar", "--format", "latx"], "latex"),
                             (["snapshot", "four-bar", "-o", "never-written.png", "--view", "fornt"], "front"),
                             (["snapshot", "four-bar", "-o", "never-written.png", "--theme", "drak"], "dark"), (["completion", "bsh"], "bash"),
                             (["terms", "four-bar", "--q", "ht1=1"], "th1"), (["extreme", "xx1"], "x1"),
                             (["run", "four-bar.json"], "the shipped scene is called 'four-bar'"),
                             (["run", "nosuch.json"], "there is no file 'nosuch.json'")):
            done = call(*words)
            self.assertEqual(done.returncode, 2, words)
            self.assertIn(meant, done.stderr + done.stdout, words)


class Plots(unittest.TestCase):
    def test_compare_draws_every_method_within_the_width(self):
        env = {**os.environ, "COLUMNS": "70", "LC_ALL": "C.UTF-8"}
        done = subprocess.run([PROGRAM, "compare", "four-bar", "--time", "2", "--plot"], capture_output=True, text=True,
                              timeout=600, env=env)
        self.assertEqual(done.returncode, 0, done.stderr)
        plot = done.stdout[done.stdout.index("loop gap (constraint violation)"):]
        self.assertLessEqual(max(map(len, plot.splitlines())), 70)
        for glyph, method in (("●", "index1@rk4"), ("▲", "projection@rk4"), ("+", "reduced@rk4")):
            self.assertRegex(plot, rf"  {re.escape(glyph)} {method}")
        # the unstabilised gap reaches 1e-4 m and more in two seconds, the projected one stays at rounding
        self.assertRegex(plot, r"1e-0[1-4]┤")
        self.assertNotIn("\033", plot)

    def test_run_draws_in_place_of_samples_and_in_ascii_where_the_locale_asks(self):
        env = {**os.environ, "LC_ALL": "C"}
        done = subprocess.run([PROGRAM, "run", "pendulum", "--time", "1", "--plot"], capture_output=True, text=True, timeout=600,
                              env=env)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(done.stdout.isascii())
        self.assertIn("energy change since the start", done.stdout)
        self.assertNotIn("t,th", done.stdout)


    @staticmethod
    def draw(*words):
        with tempfile.TemporaryDirectory() as cache:
            env = {**os.environ, "COLUMNS": "80", "LC_ALL": "C.UTF-8", "HOLONOM_CACHE": cache}
            done = subprocess.run([PROGRAM, *words, "--plot"], capture_output=True, text=True, timeout=300, env=env)
        assert done.returncode == 0, done.stderr
        assert max(map(len, done.stdout.splitlines())) <= 80, done.stdout
        return done.stdout

    def test_a_work_precision_study_draws_a_glyph_for_every_point(self):
        drawn = self.draw("study", "pendulum", "work-precision", "--time", "0.5", "--levels", "3", "--samples", "0",
                          "--methods", "index1@rk4", "projection@dop853")
        # first the answer in words
        self.assertRegex(drawn, r"^Cheapest by operations, for errors up to t = 0\.5 s\n")
        drawn = drawn[drawn.index("error of the coordinates over") :]
        plot, legend = drawn.split("  ● index1@rk4\n")
        # three steps of the first method, and what is not hidden of the second
        self.assertEqual(plot.count("●"), 3)
        self.assertGreaterEqual(plot.count("■"), 1)
        self.assertIn("■ projection@dop853", legend)
        self.assertNotIn("Reference:", drawn)

    def test_a_stability_map_draws_every_cell(self):
        drawn = self.draw("study", "four-bar", "stability", "--preset", "baumgarte", "--grid", "6x4", "--methods", "baumgarte@rk4:h=1e-2",
                          "--time", "0.5")
        rows = re.findall(r"│(.+)$", drawn, re.M)
        self.assertEqual(len(rows), 4)
        # beyond h beta = 2.8 nothing is stable, far below everything is
        self.assertEqual(rows[0][:12].split(), ["!"] * 6)
        self.assertRegex(rows[3], r"^[gve░▒▓█]{4}")  # letters: the best cells

    def test_an_error_budget_draws_a_bar_for_every_cause(self):
        drawn = self.draw("study", "fb0", "budget", "--time", "0.2", "--methods", "index1@rk4:h=1e-3")
        first = drawn.split("Energy put in")[0]
        causes = re.findall(r"^  (\w+) +[█▒░]+  [+-]?[\d.e+-]+ rad$", first, re.M)
        self.assertEqual(causes, ["truncation", "formulation", "projection", "drift", "solve", "rounding"])
        self.assertRegex(first, r"█{20}")

    def test_a_grade_draws_a_bar_for_every_entry(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "answer.json")
            with open(os.path.join(ROOT, "lessons", "01-closed-loops", "answers", "p3.json"), encoding="utf-8") as f:
                answer = f.read()
            with open(path, "w", encoding="utf-8") as f:
                f.write(answer.replace("sin", "cos", 1))
            drawn = self.draw("grade", "p3", path)
        self.assertEqual(len(re.findall(r"^  J\d\d +█+  1 of 1$", drawn, re.M)), 7)
        self.assertRegex(drawn, r"(?m)^  J\d\d +░+  0 of 1  \S+$")
        self.assertRegex(drawn, r"(?m)^  score +█+░+  7 of 8$")


class Budget(unittest.TestCase):
    def test_no_cause_falls_out_of_eighty_columns(self):
        text = {}
        for columns in ("80", "200"):
            env = {**os.environ, "COLUMNS": columns, "LC_ALL": "C.UTF-8"}
            done = subprocess.run([PROGRAM, "study", "fb0", "budget", "--time", "0.2"], capture_output=True, text=True, timeout=300, env=env)
            text[columns] = done.stdout
        numbers = re.findall(r"-?\d\.\d\de-\d\d", text["200"])
        self.assertGreater(len(numbers), 20)
        self.assertNotIn("left out", text["80"])
        # every number of the wide table stands in the narrow one
        for number in numbers:
            self.assertIn(number, text["80"])


class Manual(unittest.TestCase):
    def test_it_names_every_command_and_option(self):
        text = call("manual").stdout.replace("\\-", "-")
        for command in re.findall(r"^  holonom (\w+)", call("help").stdout, re.M):
            self.assertIn(f'.SS "holonom {command}', text)
            for option in re.findall(r"^  (--?[\w-]+)", call("help", command).stdout, re.M):
                self.assertIn(f".B {option}", text)

    def test_it_has_the_keys_of_the_workbench_as_help_has_them(self):
        keys = re.search(r"\nkeys\n((?:  .*\n)+)", call("help", "tui").stdout).group(1)
        self.assertGreater(len(keys.splitlines()), 25)
        text = call("manual").stdout.split(".SH KEYS OF THE WORKBENCH")[1].replace("\\-", "-")
        for means in re.findall(r"(?m)^  \S+(?: \S)? +(.*)$", keys):
            self.assertIn(f"\n{means}\n", text)

    def test_groff_sets_it_without_a_warning(self):
        done = subprocess.run(["groff", "-ww", "-man", "-Tascii", "-P-cbou", "-rLL=80n"], input=call("manual").stdout, capture_output=True, text=True, timeout=600)
        self.assertEqual(done.stderr, "")
        self.assertIn("SYNOPSIS", done.stdout)
        self.assertEqual([line for line in done.stdout.splitlines() if len(line) > 80], [])

    def test_no_line_is_a_request_that_roff_does_not_know(self):
        requests = set(re.findall(r"^\.(\w+)", call("manual").stdout, re.M))
        self.assertLessEqual(requests, {"TH", "SH", "SS", "TP", "PP", "B", "nf", "fi", "in"})


if __name__ == "__main__":
    driver.main()
