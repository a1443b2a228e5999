#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The coexistence paper measured on this machine: every thread was tested at every interval, samples of both protocols came, and nothing is left behind.

How many calls took place is this machine's matter, and no test's.

usage: coexistence_test.py TAKT SOURCE
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

TAKT = ""
SOURCE = ""


class Coexistence(unittest.TestCase):
    def test_all_nodes_are_measured(self):
        folder = tempfile.TemporaryDirectory(prefix="takt-coexistence-")
        self.addCleanup(folder.cleanup)
        done = subprocess.run([TAKT, "paper", "coexistence", "--real", "--short", "--quiet", "--out", folder.name], capture_output=True, text=True, cwd=SOURCE)
        if "DDS is not in this build" in done.stderr:
            self.skipTest(done.stderr.strip())
        self.assertEqual(done.returncode, 0, done.stdout[-2000:] + done.stderr)
        self.assertIn("measured", done.stdout)   # beside what was published and simulated
        measured = json.loads((pathlib.Path(folder.name) / "measured.json").read_text(encoding="utf-8"))
        self.assertEqual(len(measured["mirror"]), 8)   # Tables 1 to 8
        self.assertEqual(len(measured["gateway"]), 8)
        for row in measured["mirror"] + measured["gateway"]:
            for column in range(4):
                self.assertGreater(row["tests"][column] + row["discarded"][column], 0, row)
                for key in ("success_percent", "buffered_percent"):
                    if row["tests"][column] > 0 and key in row:
                        self.assertTrue(0 <= row[key][column] <= 100, row)
        for buffer in measured["buffers"]:
            self.assertGreater(buffer["forwarded"], 0)
            self.assertGreaterEqual(buffer["received"], buffer["forwarded"])
        left = subprocess.run(["ip", "netns", "list"], capture_output=True, text=True).stdout
        self.assertEqual([name for name in left.splitlines() if name.startswith("takt-") and not alive(name)], [])


def alive(name):
    """Another emulation may be at work here."""
    pid = name.split("-")[1]
    return subprocess.run(["kill", "-0", pid], capture_output=True).returncode == 0


if __name__ == "__main__":
    TAKT, SOURCE = sys.argv[1:3]
    unittest.main(argv=[sys.argv[0]] + sys.argv[3:])
