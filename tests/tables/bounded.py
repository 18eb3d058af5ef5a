# SPDX-License-Identifier: GPL-3.0-or-later
"""A command with a limit on its computing time, which other programs on the machine do not use up."""
import signal
import subprocess


def run_bounded(words, seconds):
    """What the command printed and its exit status; None where it was ended for its computing time [s]."""
    command = ["sh", "-c", 'ulimit -t "$1" && shift && exec "$@"', "sh", str(seconds), *words]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return None if -done.returncode in (signal.SIGXCPU, signal.SIGKILL) else done
