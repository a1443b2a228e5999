#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Lines of progress on a terminal of 80 columns: within one line, and gone where something else is printed.

usage: progress_test.py TAKT SOURCE_DIR
"""
import fcntl
import json
import os
import pathlib
import pty
import re
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import unittest

TAKT, SCENARIOS = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve() / "scenarios"
COLUMNS = 80


def on_terminal(arguments, folder, interrupt_after=None):
    """All that a command writes to its terminal, on both of its outputs."""
    leader, follower = pty.openpty()
    fcntl.ioctl(follower, termios.TIOCSWINSZ, struct.pack("HHHH", 50, COLUMNS, 0, 0))
    written = b""
    with subprocess.Popen([TAKT, *map(str, arguments)], stdin=subprocess.DEVNULL, stdout=follower, stderr=follower, cwd=folder, env={**os.environ, "TERM": "xterm", "NO_COLOR": "1"}) as process:
        os.close(follower)
        while True:
            try:
                octets = os.read(leader, 65536)
            except OSError:   # the last writer has closed
                break
            if not octets:
                break
            written += octets
            if interrupt_after and interrupt_after in written:
                process.send_signal(signal.SIGINT)
                interrupt_after = None
        process.wait(timeout=600)
    os.close(leader)
    return written.decode()


def screen_of(written):
    """The lines that stand there at the end, and every text that a line of progress was."""
    lines, column, texts = [""], 0, []
    pieces = re.findall(r"\r|\n|\x1b\[K|[^\r\n\x1b]+", written)
    for before, piece, behind in zip(["", *pieces], pieces, [*pieces[1:], ""]):
        if piece == "\r":
            column = 0
        elif piece == "\n":
            lines.append("")
        elif piece == "\x1b[K":
            lines[-1] = lines[-1][:column]
        else:
            lines[-1] = lines[-1][:column] + piece + lines[-1][column + len(piece):]
            column += len(piece)
            if before == "\r" and behind == "\x1b[K":
                texts.append(piece)
    return lines, texts


class Progress(unittest.TestCase):
    def check(self, arguments, shown, result, **how):
        with tempfile.TemporaryDirectory() as folder:
            for file, content in how.pop("files", {}).items():
                (pathlib.Path(folder) / file).write_text(content, encoding="utf-8")
            written = on_terminal(arguments, folder, **how)
        lines, texts = screen_of(written)
        self.assertTrue([text for text in texts if re.search(shown, text)], f"no progress in {written[:2000]!r}")
        for text in texts:
            self.assertLess(len(text), COLUMNS, text)
        for line in lines:
            self.assertNotRegex(line, shown, written[-2000:])
        self.assertTrue([line for line in lines if re.match(result, line)], lines)

    def test_run(self):
        self.check(["run", SCENARIOS / "robot-arm.json", "--duration", "10h"], r"events/s", r"robot-arm: ", interrupt_after=b"events/s")

    def test_verify(self):
        self.check(["verify", SCENARIOS / "first-cell.json", "--budget", "30"], r"searching for the worst", r"first-cell: ")

    def test_study(self):
        scenario = re.sub(r'"\$schema": "[^"]*",', "", (SCENARIOS / "robot-arm.json").read_text(encoding="utf-8"))
        rest = {"replications": {"count": 30}, "factors": [{"name": "seed", "patches": {"one": {}, "two": {"/seed": 2}}}], "measures": [{"name": "halt", "of": "reaction.halt.max", "unit": "us"}]}
        study = f'{{"name": "many", "scenario": {scenario}, {json.dumps(rest)[1:]}'
        self.check(["study", "many.json", "--out", "many.sqlite"], r"a second", r"many: ", files={"many.json": study})

    def test_compare(self):
        self.check(["compare", SCENARIOS / "robot-arm.json", SCENARIOS / "robot-arm.json", "--set-b", "seed=2", "--pairs", "30"], r"a second", r".*robot-arm.json")

    def test_explore(self):
        self.check(["explore", "--slaves", "3", "--calls", "4", "--faults", "loss,crash,restart", "--fault-budget", "3"], r"M a second", r"robust, ", interrupt_after=b"M a second")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
