# SPDX-License-Identifier: GPL-3.0-or-later
"""A real Slurm on this machine for a test: munged, slurmctld and some slurmd, all of them gone afterwards."""
from __future__ import annotations

import os
import shutil
import signal
import socket
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

DAEMONS = ("munged", "slurmctld", "slurmd", "sbatch")
NODE_LOST_S = 10      #: a node that does not answer for so long is down and its jobs are requeued
REQUEUED_S = 10       #: a requeued job waits so long
FIRST_WITHOUT_CGROUP = 23   #: Slurm that else wants /sys/fs/cgroup, which a chroot need not have; earlier ones do not

CONF = """ClusterName=reachcast
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/munge.socket,cred_expire={requeued}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd-%n.log
SlurmdTimeout={lost}
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
MailProg=/bin/true
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
KillWait=2
{nodes}
PartitionName=all Nodes=ALL Default=YES State=UP MaxTime=INFINITE
"""


class SmallCluster:
    """`with SmallCluster(folder, ("a", "b")) as cluster`: nodes of one CPU each; `environment` is for its commands."""

    def __init__(self, folder: Path, nodes: tuple[str, ...]) -> None:
        self.folder, self.nodes = folder, nodes
        self.environment = {**os.environ, "SLURM_CONF": f"{folder}/slurm.conf",
                            "PATH": os.environ["PATH"] + ":/usr/sbin:/sbin"}

    def __enter__(self) -> SmallCluster:
        (self.folder / "state").mkdir(parents=True)
        self._configure()
        try:
            (self.folder / "munge.key").write_bytes(os.urandom(128))
            (self.folder / "munge.key").chmod(0o600)
            self._start("munged", "--force", *(f"--{what}={self.folder}/munge.{name}" for what, name in (
                ("key-file", "key"), ("socket", "socket"), ("pid-file", "pid"), ("log-file", "log"),
                ("seed-file", "seed"))))
            self._start("slurmctld", "-i")
            for node in self.nodes:
                self._start("slurmd", "-N", node)
            self.wait_for(lambda: self.states() == dict.fromkeys(self.nodes, "idle"), 60.0, "idle nodes")
        except BaseException:
            self.stop()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def run(self, *command: object) -> str:
        """Standard output of a command of this cluster; RuntimeError with what it said when it fails."""
        done = subprocess.run([*map(str, command)], env=self.environment, capture_output=True, text=True, check=False)
        if done.returncode:
            raise RuntimeError(f"{command[0]} ended with {done.returncode}: {done.stdout}{done.stderr}")
        return done.stdout

    def states(self) -> dict[str, str]:
        """Each node's state in sinfo's words: idle, mixed, allocated, down*, ..."""
        return dict(line.split() for line in self.run("sinfo", "-h", "-N", "-o", "%N %T").splitlines())

    def wait_for(self, what: Callable[[], Any], seconds: float, name: str) -> Any:
        ends = time.monotonic() + seconds
        while not (found := what()):
            if time.monotonic() > ends:
                raise TimeoutError(f"No {name} within {seconds:g} s; {self.run('sinfo', '-N', '-l')}")
            time.sleep(0.1)
        return found

    def kill_node(self, node: str) -> None:
        """As when its power fails: its daemon and all that runs there are gone at once."""
        self._kill(lambda variables: variables.get("SLURMD_NODENAME", variables.get("SMALL_CLUSTER_NODE")) == node)

    def stop(self) -> None:
        self._kill(lambda variables: True)

    def processes(self) -> dict[int, dict[str, str]]:
        """Environment variables of all processes that belong to this cluster, by process."""
        found = {}
        for folder in Path("/proc").glob("[0-9]*"):
            try:
                text = (folder / "environ").read_bytes().decode(errors="replace")
            except OSError:
                continue  # it has ended, or is another user's
            variables = dict(item.split("=", 1) for item in text.split("\0") if "=" in item)
            if variables.get("SLURM_CONF") == self.environment["SLURM_CONF"] and int(folder.name) != os.getpid():
                found[int(folder.name)] = variables
        for process, variables in list(found.items()):  # a step's daemon may have written its title over its own
            if (parent := _parent(process)) not in found and _name(parent) == "slurmstepd":
                found[parent] = variables
        return dict(sorted(found.items()))  # who would report that another was killed is older than that one

    def _kill(self, is_meant: Callable[[dict[str, str]], bool]) -> None:
        ends = time.monotonic() + 20.0
        while doomed := [process for process, variables in self.processes().items() if is_meant(variables)]:
            if time.monotonic() > ends:
                raise TimeoutError(f"These processes do not end: {doomed}")
            for process in doomed:
                try:
                    os.kill(process, signal.SIGKILL)
                except ProcessLookupError:
                    pass
            time.sleep(0.05)

    def _start(self, *command: str) -> None:
        """A daemon; it goes into the background by itself."""
        node = {"SMALL_CLUSTER_NODE": command[-1]} if command[0] == "slurmd" else {}
        with (self.folder / "daemons.log").open("ab") as log:
            done = subprocess.run(command, env={**self.environment, **node}, stdout=log, stderr=log,
                                  stdin=subprocess.DEVNULL, check=False, timeout=60)
        if done.returncode:
            said = (self.folder / "daemons.log").read_text()
            raise RuntimeError(f"{command[0]} ended with {done.returncode}: {said}")

    def _configure(self) -> None:
        host = socket.gethostname().partition(".")[0]
        ports = _free_ports(len(self.nodes) + 1)
        nodes = "\n".join(f"NodeName={node} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs=1 State=UNKNOWN"
                          for node, port in zip(self.nodes, ports[1:]))
        user = subprocess.run(["id", "-un"], capture_output=True, text=True, check=True).stdout.strip()
        (self.folder / "slurm.conf").write_text(CONF.format(
            host=host, ports=ports, user=user, folder=self.folder, nodes=nodes, lost=NODE_LOST_S, requeued=REQUEUED_S))
        if int(self.run("slurmctld", "-V").split()[-1].partition(".")[0]) >= FIRST_WITHOUT_CGROUP:
            (self.folder / "cgroup.conf").write_text("CgroupPlugin=disabled\n")


def _name(process: int) -> str:
    try:
        return Path(f"/proc/{process}/comm").read_text().strip()
    except OSError:
        return ""


def _parent(process: int) -> int:
    """0 for one that has ended."""
    try:
        return int(Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[1])
    except OSError:
        return 0


def missing_daemons() -> list[str]:
    where = os.environ["PATH"] + ":/usr/sbin:/sbin"
    return [name for name in DAEMONS if shutil.which(name, path=where) is None]


def _free_ports(count: int) -> list[int]:
    sockets = [socket.socket() for _ in range(count)]
    try:
        for each in sockets:
            each.bind(("127.0.0.1", 0))
        return [each.getsockname()[1] for each in sockets]
    finally:
        for each in sockets:
            each.close()
