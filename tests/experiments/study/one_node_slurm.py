# SPDX-License-Identifier: Apache-2.0
"""Slurm on this machine alone: munged, slurmctld and slurmd in a scratch folder, with ports and a key of their own.

Nothing of a Slurm that the machine may have is touched: every path and port is ours, and all that was started is ended.
"""
import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent.parent / "support"))
import reservation  # noqa: E402

DAEMONS = ("munged", "slurmctld", "slurmd")
CLIENTS = ("sbatch", "sinfo", "squeue", "scancel")

CONFIGURATION = """
ClusterName=takt
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SwitchType=switch/none
SchedulerType=sched/backfill
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
ReturnToService=2
MinJobAge=60
KillWait=2
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=8192 State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


# Nothing here uses cgroups, yet slurmd starts only if the plugin does: which one can, depends on the release and on what a container shows.
CGROUPS = ("CgroupPlugin=autodetect\n", "CgroupPlugin=disabled\n", "CgroupPlugin=cgroup/v1\n", "CgroupPlugin=autodetect\nIgnoreSystemd=yes\n")


class Unavailable(Exception):
    """Why Slurm does not start here."""


def find(program):
    return shutil.which(program) or shutil.which(program, path="/usr/sbin:/sbin")


class Slurm:
    """A context: in it `environment` lets Slurm's commands find this cluster."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.at = self.folder
        self.started = []
        self.port = reservation.ports()
        self.environment = dict(os.environ)

    def __enter__(self):
        missing = [program for program in DAEMONS + CLIENTS if not find(program)]
        if missing:
            raise Unavailable(f"{', '.join(missing)} not installed (Debian: slurm-wlm)")
        if os.geteuid() != 0:
            raise Unavailable("slurmd wants root")
        reasons = []
        for number, cgroups in enumerate(CGROUPS):
            try:
                self.begin(self.folder / str(number), cgroups)
                return self
            except Unavailable as problem:
                reasons.append(f"{cgroups.strip()}: {problem}")
                self.stop()
            except BaseException:
                self.stop()
                raise
        raise Unavailable("; ".join(reasons))

    def begin(self, folder, cgroups):
        self.at = folder
        self.environment["SLURM_CONF"] = str(folder / "slurm.conf")
        self.configure(cgroups)
        self.start("munged", "--foreground", "--force", f"--key-file={folder}/munge.key", f"--socket={folder}/munge.socket", f"--pid-file={folder}/munged.pid",
                   f"--log-file={folder}/munged.log", f"--seed-file={folder}/munged.seed")
        self.wait_for("munged", lambda: (folder / "munge.socket").exists())
        self.start("slurmctld", "-D", "-c", "-f", folder / "slurm.conf")
        self.start("slurmd", "-D", "-c", "-N", self.host, "-f", folder / "slurm.conf")
        self.wait_for("slurmd", lambda: "idle" in self.say("sinfo", "--noheader", "--format=%T"))

    def __exit__(self, *_):
        self.stop()

    def configure(self, cgroups):
        self.host = socket.gethostname().split(".")[0]
        self.at.mkdir()
        for name in ("state", "spool"):
            (self.at / name).mkdir()
        key = self.at / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        (self.at / "slurm.conf").write_text(CONFIGURATION.format(host=self.host, folder=self.at, ports=[self.port, self.port + 1]))
        (self.at / "cgroup.conf").write_text(cgroups)

    def start(self, program, *arguments):
        log = open(self.at / f"{program}.out", "wb")
        self.started.append((program, subprocess.Popen([find(program), *map(str, arguments)], stdout=log, stderr=log, env=self.environment, start_new_session=True)))
        log.close()

    def say(self, *command):
        return subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False, env=self.environment, timeout=1000).stdout

    def tail(self, program):
        text = ""
        for name in (f"{program}.log", f"{program}.out"):
            path = self.at / name
            text += path.read_text(errors="replace") if path.exists() else ""
        errors = [line for line in text.splitlines() if re.search(r"error|fatal|fail", line, re.I)] or text.splitlines()
        return " / ".join(errors[-3:])

    def wait_for(self, program, is_there, seconds=60):
        for _ in range(seconds * 5):
            for name, process in self.started:
                if process.poll() is not None:
                    raise Unavailable(f"{name} ended: {self.tail(name)}")
            if is_there():
                return
            time.sleep(0.2)
        raise Unavailable(f"{program} is not ready after {seconds} s: {self.tail(program)}")

    def stop(self):
        """Jobs first, so that none of their processes is left; then the daemons, the last one first."""
        if any(name == "slurmd" for name, _ in self.started):
            self.say("scancel", "--user=root")
            for _ in range(50):
                if not self.say("squeue", "--noheader").strip():
                    break
                time.sleep(0.2)
        for _, process in reversed(self.started):
            process.terminate()
            try:
                process.wait(timeout=20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        self.started = []
