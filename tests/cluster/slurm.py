# SPDX-License-Identifier: GPL-3.0-or-later
"""A Slurm of one machine that lives in a folder: its own key, ports and daemons, no systemd, and nothing left of it afterwards."""

import contextlib
import ctypes
import os
import shutil
import signal
import socket
import subprocess
import tempfile
import time

PATIENCE = 60  # seconds until a daemon answers
CONFIGURATION = """\
ClusterName=holonom
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={node}
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
PlugStackConfig=/dev/null
MailProg=/bin/true
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_interval=1
SlurmdParameters=config_overrides
NodeName=one NodeHostname={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes=one Default=YES MaxTime=60 State=UP
"""


def die_with_parent():
    """In a child before it becomes a daemon: whatever ends the test ends it too."""
    PR_SET_PDEATHSIG = 1
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def free_ports(n):
    with contextlib.ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(n)]
        for s in sockets:
            s.bind(("127.0.0.1", 0))
        return [s.getsockname()[1] for s in sockets]


def missing():
    """Programs that are not installed."""
    path = os.environ.get("PATH", "") + ":/usr/sbin:/sbin"
    return [name for name in ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "sinfo") if not shutil.which(name, path=path)]


class Slurm:
    """Use as a context. Needs root: munge and slurmd insist on it."""

    def __init__(self, cpus=2):
        self.cpus = cpus
        self.daemons = []

    def __enter__(self):
        # of the system's own folder: sockets have short names
        self.folder = tempfile.mkdtemp(prefix="slurm-", dir="/tmp")
        os.chmod(self.folder, 0o755)
        self.environment = dict(os.environ, SLURM_CONF=self.path("slurm.conf"))
        self.environment["PATH"] += ":/usr/sbin:/sbin"
        try:
            self._start()
        except BaseException:
            self.__exit__(None, None, None)
            raise
        return self

    def __exit__(self, *_):
        for daemon in reversed(self.daemons):
            daemon.terminate()
            try:
                daemon.wait(timeout=20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def call(self, *words):
        """What a command of Slurm prints."""
        done = subprocess.run(words, env=self.environment, capture_output=True, text=True, timeout=PATIENCE)
        if done.returncode != 0:
            raise RuntimeError(f"{' '.join(words)}: {done.stderr.strip()}")
        return done.stdout.strip()

    def wait_until(self, holds, what):
        deadline = time.monotonic() + PATIENCE
        while not holds():
            ended = [d.args[0] for d in self.daemons if d.poll() is not None]
            if ended or time.monotonic() > deadline:
                why = f"{ended[0]} ended" if ended else f"not within {PATIENCE} s"
                raise RuntimeError(f"{what}: {why}\n{self._logs()}")
            time.sleep(0.1)

    def wait_for_jobs(self):
        self.wait_until(lambda: self.call("squeue", "--noheader") == "", "the jobs end")

    def _start(self):
        for name in ("munge", "state", "spool"):
            os.mkdir(self.path(name), 0o755)
        with open(os.open(self.path("munge/key"), os.O_WRONLY | os.O_CREAT, 0o400), "wb") as f:
            f.write(os.urandom(1024))
        controller, node = free_ports(2)
        with open(self.path("slurm.conf"), "w", encoding="ascii") as f:
            f.write(CONFIGURATION.format(folder=self.folder, host=socket.gethostname().split(".")[0], controller=controller, node=node, cpus=self.cpus))
        # where nothing mounts control groups, to look for them would end slurmd
        with open(self.path("cgroup.conf"), "w", encoding="ascii") as f:
            f.write(f"CgroupPlugin=cgroup/v1\nCgroupMountpoint={self.folder}/cgroup\n")
        self._daemon("munged", "--foreground", "--key-file=" + self.path("munge/key"), "--socket=" + self.path("munge/socket"),
                     "--pid-file=" + self.path("munge/pid"), "--log-file=" + self.path("munge/log"), "--seed-file=" + self.path("munge/seed"))
        self.wait_until(lambda: os.path.exists(self.path("munge/socket")), "munged answers")
        self._daemon("slurmctld", "-D")
        self._daemon("slurmd", "-D")
        self.wait_until(self._is_idle, "the node is there")

    def _daemon(self, name, *words):
        log = open(self.path(name + ".log"), "wb")
        with log:
            self.daemons.append(subprocess.Popen([shutil.which(name, path=self.environment["PATH"]), *words], env=self.environment, stdin=subprocess.DEVNULL,
                                                 stdout=log, stderr=log, preexec_fn=die_with_parent))

    def _is_idle(self):
        try:
            return self.call("sinfo", "--noheader", "--format=%T") == "idle"
        except RuntimeError:  # the controller does not listen yet
            return False

    def _logs(self):
        text = ""
        for name in sorted(os.listdir(self.folder)):
            if name.endswith(".log"):
                with open(self.path(name), errors="replace", encoding="utf-8") as f:
                    text += f"{name}:\n" + "".join(f.readlines()[-15:])
        return text
