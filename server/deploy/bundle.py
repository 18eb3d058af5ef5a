# SPDX-License-Identifier: GPL-3.0-or-later
"""What a teaching platform is given to grade an exercise: a folder and a zip archive with the program and all that it needs.

usage: bundle.py gradescope|prairielearn PROGRAM ID FOLDER

The program and its shared libraries are copied, with the loader that started it here, so that any Linux of the same processor runs it.
"""

import json
import os
import re
import shutil
import stat
import subprocess
import sys
import uuid

VARIANTS = 40  # texts of a PrairieLearn question: its server draws one, and cannot run the program

RUN = """#!/bin/sh
# the program with the libraries it was built with
here=$(cd "$(dirname "$0")" && pwd)
exec "$here/lib/{loader}" --library-path "$here/lib" "$here/holonom.bin" "$@"
"""

SETUP = """#!/bin/sh
# Gradescope runs this once, when it builds the image. Everything that is needed came with the bundle.
chmod +x /autograder/source/holonom /autograder/source/holonom.bin /autograder/source/lib/{loader}
"""

# the student's mail address chooses the variant
RUN_AUTOGRADER = """#!/bin/sh
# Gradescope runs this for each submission.
who=$(sed -n 's/.*"email": *"\\([^"]*\\)".*/\\1/p' /autograder/submission_metadata.json | head -n 1)
mkdir -p /autograder/results
set -- /autograder/submission/*.json
/autograder/source/holonom grade {id} "$1" --student "$who" --format gradescope --out /autograder/results
# a file that cannot be graded is a result too: the student reads why
exit 0
"""

# the seed of the variant is in the question's parameters
GRADE = """#!/bin/sh
# PrairieLearn runs this for each submission.
seed=$(sed -n 's/.*"variant": *\\([0-9]*\\).*/\\1/p' /grade/data/data.json | head -n 1)
/grade/tests/holonom grade {id} /grade/student/answer.json --seed "$seed" --format prairielearn --out /grade/results
exit 0
"""

SERVER = '''"""Chooses a variant of the exercise; its text was written when the question was made."""

import json
import os


def generate(data):
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "variants.json"), encoding="utf-8") as f:
        texts = json.load(f)
    data["params"]["variant"] = int(data["variant_seed"]) % len(texts) + 1
    data["params"]["text"] = texts[data["params"]["variant"] - 1]
'''

QUESTION = """<pl-question-panel><pre>{{params.text}}</pre></pl-question-panel>
<pl-file-upload file-names="answer.json"></pl-file-upload>
<pl-submission-panel>
  <pl-external-grader-results></pl-external-grader-results>
  <pl-file-preview></pl-file-preview>
</pl-submission-panel>
"""


def write(path, text, run=False):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as f:
        f.write(text)
    if run:
        os.chmod(path, os.stat(path).st_mode | stat.S_IXUSR | stat.S_IXGRP | stat.S_IXOTH)


def copy_program(program, folder):
    """The program, its libraries and its loader into a folder; the loader's name."""
    os.makedirs(os.path.join(folder, "lib"))
    shutil.copy(program, os.path.join(folder, "holonom.bin"))
    said = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout
    if "not found" in said:
        sys.exit(f"bundle: a library of the program is missing:\n{said}")
    paths = re.findall(r"(/\S+) \(0x", said)
    loader = next(os.path.basename(path) for path in paths if os.path.basename(path).startswith("ld-"))
    for path in paths:
        shutil.copy(path, os.path.join(folder, "lib", os.path.basename(path)))
    write(os.path.join(folder, "holonom"), RUN.replace("{loader}", loader), run=True)
    return loader


def call(program, *words):
    done = subprocess.run([program, *words], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"bundle: {done.stderr.strip()}")
    return done.stdout


def gradescope(program, identity, folder):
    loader = copy_program(program, folder)
    write(os.path.join(folder, "setup.sh"), SETUP.replace("{loader}", loader), run=True)
    write(os.path.join(folder, "run_autograder"), RUN_AUTOGRADER.replace("{id}", identity), run=True)


def prairielearn(program, identity, folder):
    copy_program(program, os.path.join(folder, "tests"))
    problem = json.loads(call(program, "problem", identity, "--json"))
    info = {"uuid": str(uuid.uuid5(uuid.NAMESPACE_URL, f"holonom/{identity}")), "title": problem["title"], "topic": "Dynamics", "type": "v3",
            "gradingMethod": "External",
            "externalGradingOptions": {"enabled": True, "image": "debian:12", "entrypoint": "/grade/tests/run.sh", "timeout": 60}}  # fmt: skip
    write(os.path.join(folder, "info.json"), json.dumps(info, indent=2) + "\n")
    write(os.path.join(folder, "question.html"), QUESTION)
    write(os.path.join(folder, "server.py"), SERVER)
    texts = [call(program, "problem", identity, "--seed", str(seed)) for seed in range(1, VARIANTS + 1)]
    write(os.path.join(folder, "variants.json"), json.dumps(texts))
    write(os.path.join(folder, "tests", "run.sh"), GRADE.replace("{id}", identity), run=True)


def main():
    if len(sys.argv) != 5 or sys.argv[1] not in ("gradescope", "prairielearn"):
        sys.exit(__doc__)
    kind, program, identity, folder = sys.argv[1:]
    call(program, "problem", identity)  # refuses an unknown exercise, with the nearest
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    {"gradescope": gradescope, "prairielearn": prairielearn}[kind](program, identity, folder)
    print(f"{kind}: {shutil.make_archive(folder, 'zip', folder)}")


if __name__ == "__main__":
    main()
