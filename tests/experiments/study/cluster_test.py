#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tools/slurm/study.sbatch, run by what there is: a Slurm of one node where it starts, else GNU parallel, else one task after the other.

usage: cluster_test.py TAKT SOURCE_FOLDER
"""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import one_node_slurm

TAKT, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
SCRIPT = SOURCE / "tools" / "slurm" / "study.sbatch"
STUDY = SOURCE / "scenarios" / "studies" / "slaves-hops-cycle.json"
TASKS = 3


def run(*command, **options):
    return subprocess.run([str(part) for part in command], capture_output=True, text=True, check=True, timeout=1000, **options).stdout


def by_slurm(out):
    scratch = out.parent / "slurm"
    scratch.mkdir()
    try:
        with one_node_slurm.Slurm(scratch) as slurm:
            done = subprocess.run(["sbatch", "--wait", f"--array=1-{TASKS}", SCRIPT, STUDY, out], capture_output=True, text=True, check=False, timeout=1000, cwd=out,
                                  env={**slurm.environment, "TAKT": str(TAKT)})
            logs = sorted(out.glob("part-*.log"))
            assert done.returncode == 0, (done.stderr, [log.read_text() for log in logs])
            assert len(logs) == TASKS, logs
            # One share is lost, and sent again by itself.
            (out / "part-2.sqlite").unlink()
            again = subprocess.run(["sbatch", "--wait", "--array=2", SCRIPT, STUDY, out, str(TASKS)], capture_output=True, text=True, check=False, timeout=1000, cwd=out,
                                   env={**slurm.environment, "TAKT": str(TAKT)})
            assert again.returncode == 0, (again.stderr, [log.read_text() for log in logs])
    except one_node_slurm.Unavailable as problem:
        return str(problem)
    return ""


def task_environment():
    return {**os.environ, "TAKT": str(TAKT), "SLURM_ARRAY_TASK_MIN": "1", "SLURM_ARRAY_TASK_MAX": str(TASKS)}


def by_parallel(out):
    if not shutil.which("parallel"):
        return "GNU parallel is not installed"
    run("parallel", "--jobs", 2, "--env", "TAKT", f"SLURM_ARRAY_TASK_ID={{}} {SCRIPT} {STUDY} {out}", ":::", *range(1, TASKS + 1), env=task_environment())
    return ""


def in_turn(out):
    for task in range(1, TASKS + 1):
        run(SCRIPT, STUDY, out, env={**task_environment(), "SLURM_ARRAY_TASK_ID": str(task)})
    return ""


def main():
    with tempfile.TemporaryDirectory(prefix="takt-cluster-") as name:
        folder = pathlib.Path(name)
        for way in (by_slurm, by_parallel, in_turn):
            out = folder / way.__name__
            out.mkdir()
            reason = way(out)
            if not reason:
                break
            print(f"not {way.__name__}: {reason}")
        print(f"run {way.__name__}")
        parts = sorted(out.glob("part-*.sqlite"))
        assert len(parts) == TASKS, parts
        merged = folder / "merged.sqlite"
        run(TAKT, "study", "merge", merged, *parts)
        after = run(TAKT, "study", STUDY, "--resume", "--out", merged)
        assert " 0 run now" in after, after
        whole = run(TAKT, "study", STUDY, "--out", folder / "whole.sqlite")
        assert after.split()[-1] == whole.split()[-1], (after, whole)
        # A share of its own, whatever the array is; its log is beside its part.
        lone = folder / "lone"
        run(SCRIPT, STUDY, lone, TASKS, env={**os.environ, "TAKT": str(TAKT), "SLURM_ARRAY_TASK_ID": "2", "SLURM_ARRAY_TASK_MIN": "2", "SLURM_ARRAY_TASK_MAX": "2"})
        assert "part-2.sqlite" in (lone / "part-2.log").read_text()
        for wrong in (("4", "3"), ("2", "x"), ("2",)):   # beyond the last; no number; an array that does not begin at 1
            refused = subprocess.run([SCRIPT, STUDY, lone, *wrong[1:]], capture_output=True, text=True, check=False, timeout=100,
                                     env={**os.environ, "TAKT": str(TAKT), "SLURM_ARRAY_TASK_ID": wrong[0], "SLURM_ARRAY_TASK_MIN": "2", "SLURM_ARRAY_TASK_MAX": "5"})
            assert refused.returncode == 2, refused
        assert sorted(part.name for part in lone.glob("part-*.sqlite")) == ["part-2.sqlite"]
        # Out of time: the task ends cleanly, and goes on when it comes back.
        slow = subprocess.Popen([SCRIPT, STUDY, folder / "slow", "1"], env={**os.environ, "TAKT": str(TAKT), "SLURM_ARRAY_TASK_ID": "1"})
        while not (folder / "slow" / "part-1.sqlite").exists() and slow.poll() is None:
            time.sleep(0.01)
        slow.send_signal(signal.SIGUSR1)
        assert slow.wait(timeout=100) in (0, 130)   # 0: it had ended already
        run(SCRIPT, STUDY, folder / "slow", "1", env={**os.environ, "TAKT": str(TAKT), "SLURM_ARRAY_TASK_ID": "1"})
        assert (folder / "slow" / "part-1.log").read_text().strip().endswith(whole.split()[-1])
        # A task that is requeued goes on.
        run(SCRIPT, STUDY, out, env={**task_environment(), "SLURM_ARRAY_TASK_ID": "2"})


main()
