# SPDX-License-Identifier: GPL-3.0-or-later
"""Mechanisms with closed loops from Python: runs, comparisons, studies, scenes and grades of the command `holonom`.

    import holonom
    motion = holonom.run("four-bar", "projection@rk4:h=1e-3", time=2)
    motion.t, motion["th1"], motion.gap          # numpy arrays where numpy is installed, else lists
    table = holonom.compare("four-bar", ["index1@rk4:h=1e-2", "ggl@radau5:rtol=1e-6"], time=5, set={"l1": 0.45})

One file and no build step: it calls the command and reads its JSON. The command is the one named by HOLONOM, else the one that
was installed or built with this file, else the `holonom` of PATH.
"""

import json
import os
import shutil
import subprocess
import tempfile

try:
    import numpy
except ImportError:  # lists then
    numpy = None

__all__ = ["HolonomError", "Motion", "run", "compare", "study", "scenes", "scene", "terms", "equations", "problems", "export", "grade"]

DONE, ENDED = 0, 4


class HolonomError(Exception):
    """What the command refused: `faults` is its list of {"status", "pointer", "detail", "hint"}, `status` its exit status."""

    def __init__(self, status, faults, text):
        self.status, self.faults = status, faults
        words = ["; ".join(part for part in (f.get("detail", ""), f.get("hint", "")) if part) for f in faults]
        super().__init__("\n".join(words) or text.strip() or f"holonom ended with exit status {status}")


def command():
    """The path of the command that is called."""
    found = os.environ.get("HOLONOM")
    # beside this file: bin/ of an installation (PREFIX/share/holonom/python), build/ of a checkout
    for place in (("..", "..", "..", "bin"), ("..", "..", "build")):
        here = os.path.join(os.path.dirname(os.path.abspath(__file__)), *place, "holonom")
        found = found or (here if os.access(here, os.X_OK) else None)
    found = found or shutil.which("holonom")
    if not found:
        raise HolonomError(127, [], "there is no command holonom in PATH; name it in the variable HOLONOM")
    return found


def _call(*words):
    """Runs the command with --json; the object that it writes."""
    done = subprocess.run([command(), *map(str, words), "--json"], capture_output=True, text=True, check=False)
    try:
        answer = json.loads(done.stdout)
    except ValueError:
        raise HolonomError(done.returncode, [], done.stderr or done.stdout) from None
    if done.returncode not in (DONE, ENDED):
        # a submission that cannot be graded is told in the verdict
        refused = [{"detail": answer["reason"], "hint": answer.get("hint", "")}] if answer.get("reason") else []
        raise HolonomError(done.returncode, answer.get("errors") or refused, done.stderr)
    return answer


def _text(*words):
    """Runs the command; the text that it writes."""
    done = subprocess.run([command(), *map(str, words)], capture_output=True, text=True, check=False)
    if done.returncode != DONE:
        raise HolonomError(done.returncode, [], done.stderr or done.stdout)
    return done.stdout


def _options(**given):
    """--name value for each that is not None; True is a flag, a list is several words."""
    words = []
    for name, value in given.items():
        option = "--" + name.replace("_", "-")
        if value is True:
            words.append(option)
        elif isinstance(value, (list, tuple)):
            words += [option, *map(str, value)]
        elif value is not None and value is not False:
            words += [option, str(value)]
    return words


def _settings(parameters):
    return [word for name, value in (parameters or {}).items() for word in ("--set", f"{name}={value!r}")]


def _array(values):
    return numpy.array([numpy.nan if v is None else v for v in values], dtype=float) if numpy else list(values)


class Motion:
    """A run: t, gap, velocity_gap, energy as arrays; motion[name] for a coordinate or a rate; `document` is all that the command said."""

    def __init__(self, document):
        self.document = document
        samples = document["samples"]
        self.method = document["method"]
        self.finished = document.get("status", "ok") == "ok" and not document.get("reason")
        self.reason = document.get("reason", "")
        self.incidents = document.get("incidents", [])
        self.coordinates, self.rates, self.rows = (document.get(key, []) for key in ("coordinates", "rates", "rows"))
        self.t, self.gap, self.velocity_gap, self.energy = (_array(samples[key]) for key in ("t", "gap", "velocity_gap", "energy"))
        self._columns = {}
        for names, key in ((self.coordinates, "q"), (self.rates, "v"), (["lambda " + row for row in self.rows], "lambda")):
            for i, name in enumerate(names):
                self._columns[name] = _array([entry[i] if entry else None for entry in samples.get(key, [])])

    def __getitem__(self, name):
        return self._columns[name]

    def keys(self):
        """Names of coordinates, rates ("w1" or the coordinate's own) and multipliers ("lambda " and the row)."""
        return self._columns.keys()

    def __repr__(self):
        return f"<{self.document['scene']} by {self.method}: {len(self.t)} samples to t = {self.t[-1]:g} s>"


def run(scene, method=None, time=None, at=None, every=None, set=None, reactions=False, allow_programs=False):
    """One method; a Motion. A run that ended early is one too: `reason` says why.

    allow_programs=True lets the method be a program of your own, in a sandbox: "program:./mine.py@rk4:h=1e-2".
    """
    return Motion(_call("run", scene, *_options(method=method, time=time, every=every, reactions=reactions, allow_programs=allow_programs,
                                                at=None if at is None else ",".join(repr(float(t)) for t in at)), *_settings(set)))


def compare(scene, methods=None, time=None, set=None, allow_programs=False):
    """Several methods on one clock: {"methods": [{"method", "state", "worst_gap", "worst_energy_change", "evals", ...}], "incidents": [...]}."""
    return _call("compare", scene, *_options(methods=methods, time=time, allow_programs=allow_programs), *_settings(set))


def study(scene, kind="work-precision", methods=None, time=None, set=None, **options):
    """A study: kind work-precision, budget or stability; options as on the command line (levels=5, time_limit=20, over="h=1e-4..1e-1", allow_programs=True)."""
    return _call("study", scene, kind, *_options(methods=methods, time=time, **options), *_settings(set))


def scenes():
    """The shipped scenes: a list of {"id", "title", ...}."""
    return _call("list", "scenes")["scenes"]


def scene(name, set=None):
    """What is known of a scene: sizes, degrees of freedom, rank, start."""
    return _call("inspect", name, *_settings(set))


def terms(name, q=None, v=None, t=None, set=None):
    """M, f, J, gamma, accelerations and multipliers at one state."""
    pairs = [[f"{key}={value!r}" for key, value in (given or {}).items()] or None for given in (q, v)]
    return _call("terms", name, *_options(q=pairs[0], v=pairs[1], t=t), *_settings(set))


def equations(name):
    """The equations of motion as a document of formulas."""
    return _call("equations", name)


def problems():
    """The exercises: a list of {"id", "title", "points", ...}."""
    return _call("list", "problems")["problems"]


def export(scene, language="python", set=None, **options):
    """The text of a program that solves the equations of the scene; options as on the command line (style="skeleton", blanks=True)."""
    return _text("export", scene, *_options(language=language, **options), *_settings(set))


def grade(problem, submission, seed=None, set=None):
    """The verdict on a submission: a dictionary, or the path of a file.

    `problem` is an exercise, or a scene whose program with blanks the file is: `set` then holds the parameters it was written with.
    """
    if isinstance(submission, (str, os.PathLike)):
        return _call("grade", problem, submission, *_options(seed=seed), *_settings(set))
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "submission.json")
        with open(path, "w", encoding="utf-8") as f:
            json.dump(submission, f)
        return _call("grade", problem, path, *_options(seed=seed))
