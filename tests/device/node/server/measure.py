#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Figures of the OPC UA server on this machine: from a call to the first frame, and what a cycle of 1 ms misses while 20 sessions subscribe. No test: they depend on the machine.

What the kernel did in interrupts while a thread ran, and what a hypervisor took from it, counts as CPU time of that thread, so "missed by the code" has it too. How much that is
on this machine says a witness beside the nodes: a process that only counts for as long as a cycle of a node takes, and tells how often its CPU time said that it took a whole cycle.

usage: measure.py TAKT BUILD_FOLDER [SECONDS]
"""
import json
import pathlib
import subprocess
import sys
import time

sys.dont_write_bytecode = True
import opcua_server_test as base  # noqa: E402


CYCLE_NS = 1_000_000
WORK_NS = 60_000


def witness(seconds):
    """Counts for WORK_NS in each cycle, and prints in how many it had a cycle's CPU time, the most that it had, and how many cycles there were."""
    due = time.monotonic_ns()
    end = due + seconds * 1_000_000_000
    last = time.thread_time_ns()
    cycles = too_long = most = 0
    while due < end:
        due += CYCLE_NS
        time.sleep(max(0, due - time.monotonic_ns()) / 1e9)
        until = time.thread_time_ns() + WORK_NS
        while (now := time.thread_time_ns()) < until:
            pass
        cycles += 1
        too_long += now - last >= CYCLE_NS
        most = max(most, now - last)
        last = now
        due = max(due, time.monotonic_ns() - CYCLE_NS)
    print(f"witness: {too_long} of {cycles} cycles had {CYCLE_NS // 1000} us of CPU time or more, the most was {most // 1000} us")


class Figures(base.ServerTest):
    """The nodes of the test, at 1 ms and on change."""

    def frames(self):
        print(self.client("frames", listens=base.PORTS + 6, count=50).splitlines()[-1])

    def cycles(self, seconds):
        beside = subprocess.Popen([sys.executable, __file__, "--witness", str(seconds)])
        self.client("sessions", hold=seconds * 1000)
        beside.wait()
        for process in self.processes.values():
            process.terminate()
        for node, process in self.processes.items():
            process.wait(timeout=base.PATIENCE)
            end = json.loads((self.root / f"{node}.out").read_text(encoding="utf-8").splitlines()[-1])
            statistics = end["statistics"]
            print(node, json.dumps({key: statistics[key] for key in statistics if key.startswith("missed") or key in ("late", "cpu")}))


def main():
    if sys.argv[1] == "--witness":
        witness(int(sys.argv[2]))
        return
    base.TAKT = sys.argv[1]
    if not base.install_client(pathlib.Path(sys.argv[2])):
        sys.exit("node-opcua-client is not to be had here")
    seconds = int(sys.argv[3]) if len(sys.argv) > 3 else 60
    base.PROGRAM = base.PROGRAM | {"cycle": "1ms", "publish": "on-change"}
    base.ALSO_TO = [base.PORTS + 6]
    Figures.setUpClass()
    try:
        figures = Figures()
        figures.frames()
        time.sleep(1)
        figures.cycles(seconds)
    finally:
        Figures.doClassCleanups()


if __name__ == "__main__":
    main()
