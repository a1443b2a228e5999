# SPDX-License-Identifier: Apache-2.0
"""What a test may ask about a process that it has started, instead of sleeping for a while."""
import os
import pathlib
import time

PATIENCE = 300  # seconds; what takes longer hangs


def wait_until(what, is_so):
    until = time.monotonic() + PATIENCE
    while not is_so():
        assert time.monotonic() < until, f"in vain: {what}"
        time.sleep(0.01)


def wait_for_handler(process, number):
    """Until the process handles the signal, which would kill it before."""
    def is_handled():
        assert process.poll() is None, "it has ended"
        for line in pathlib.Path(f"/proc/{process.pid}/status").read_text(encoding="utf-8").splitlines():
            if line.startswith("SigCgt:"):
                return int(line.split()[1], 16) >> (number - 1) & 1 == 1
        return False
    wait_until("a handler", is_handled)


def wait_for_work(process, cpu_seconds):
    """Until the process has used so much more CPU time."""
    def used():
        assert process.poll() is None, "it has ended"
        fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    begin = used()
    wait_until("work", lambda: used() >= begin + cpu_seconds)


def children_of(process):
    """The numbers of its children."""
    path = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children")
    return [int(each) for each in path.read_text(encoding="utf-8").split()]


def is_alive(number):
    """Not gone, and not dead while nobody has asked for its status."""
    try:
        return pathlib.Path(f"/proc/{number}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False
