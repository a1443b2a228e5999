#!/usr/bin/env python3
"""Figures of the OPC UA server on this machine: from a call to the first frame, and what a cycle of 1 ms misses while 20 sessions subscribe. No test: they depend on the machine.

usage: measure.py TAKT BUILD_FOLDER [SECONDS]
"""
import json
import pathlib
import sys
import time

sys.dont_write_bytecode = True
import opcua_server_test as base  # noqa: E402


class Figures(base.ServerTest):
    """The nodes of the test, at 1 ms and on change."""

    def frames(self):
        print(self.client("frames", listens=base.PORTS + 6, count=50).splitlines()[-1])

    def cycles(self, seconds):
        self.client("sessions", hold=seconds * 1000)
        for process in self.processes.values():
            process.terminate()
        for node, process in self.processes.items():
            process.wait(timeout=base.PATIENCE)
            end = json.loads((self.root / f"{node}.out").read_text(encoding="utf-8").splitlines()[-1])
            statistics = end["statistics"]
            print(node, json.dumps({key: statistics[key] for key in statistics if key.startswith("missed") or key in ("late", "cpu")}))


def main():
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
