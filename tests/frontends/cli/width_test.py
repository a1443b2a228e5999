#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every page for people fits a terminal of 80 columns.

usage: width_test.py TAKT SOURCE_DIR
"""
import fcntl
import os
import pathlib
import pty
import re
import struct
import subprocess
import sys
import termios
import threading
import unittest

TAKT, SCENARIOS = sys.argv[1], pathlib.Path(sys.argv[2]) / "scenarios"
ARM, LINE = SCENARIOS / "robot-arm.json", SCENARIOS / "line-of-switches.json"
PAGES = (
    ("check", LINE),
    ("bound", LINE),
    ("verify", ARM, "--budget", "2", "--seeds", "1"),
    ("explain", ARM, "--duration", "3s"),
    ("explore", "--slaves", "1", "--variant", "paper", "--no-finish", "--calls", "2"),
    ("schedule", SCENARIOS / "tsn" / "automatic-gates.json"),
    ("compare", ARM, ARM, "--set-a", "duration=2s", "--set-b", "duration=2s", "--set-b", "seed=2", "--pairs", "2"),
    ("run", SCENARIOS / "shared-cpu.json", "--duration", "1s"),
    ("program",),
    ("--help",),
    ("run", "--help"),
    ("schedule", "--help"),
    ("import", "--help"),
    ("export", "--help"),
    ("study", "--help"),
)


def read_up_to(descriptor, mark):
    octets = b""
    while not octets.endswith(mark):
        octets += os.read(descriptor, 65536)
    return octets.removesuffix(mark)


def on_terminal(arguments, columns):
    """The lines that stand on the terminal at the end."""
    leader, follower = pty.openpty()
    fcntl.ioctl(follower, termios.TIOCSWINSZ, struct.pack("HHHH", 50, columns, 0, 0))
    # What was written last would be lost if the last writer closed: this end stays open, and a mark says where the page ends.
    mark = b"\0end\0"
    process = subprocess.Popen([TAKT, *map(str, arguments)], stdin=subprocess.DEVNULL, stdout=follower, stderr=subprocess.DEVNULL, env={**os.environ, "TERM": "xterm"})
    said = []
    reader = threading.Thread(target=lambda: said.append(read_up_to(leader, mark)))
    reader.start()
    process.wait()
    os.write(follower, mark)
    reader.join()
    os.close(follower)
    os.close(leader)
    page = said[0]
    text = re.sub(r"\033\[[0-9;?]*[A-Za-z]", "", page.decode().replace("\r\n", "\n"))
    return [line.rsplit("\r", 1)[-1] for line in text.splitlines()]


class Width(unittest.TestCase):
    def test_pages_fit(self):
        for columns in (80, 100):
            for arguments in PAGES:
                with self.subTest(command=arguments[0], columns=columns):
                    lines = on_terminal(arguments, columns)
                    self.assertGreater(len(lines), 5)
                    self.assertLessEqual(max(map(len, lines)), columns, max(lines, key=len))

    def test_nothing_is_folded_where_nobody_looks(self):
        page = subprocess.run([TAKT, "bound", LINE], capture_output=True, text=True, check=True).stdout
        self.assertGreater(max(map(len, page.splitlines())), 100)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
