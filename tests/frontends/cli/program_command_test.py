#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""takt program: the table and the graph of the state machine.

usage: program_command_test.py TAKT [unittest options]
"""
import re
import subprocess
import sys
import unittest

TAKT = ""


def program(*arguments):
    done = subprocess.run([TAKT, "program", *arguments], capture_output=True, text=True, timeout=1000, check=False)
    return done.returncode, done.stdout, done.stderr


class Program(unittest.TestCase):
    def test_table(self):
        status, out, err = program("--table")
        self.assertEqual((status, err), (0, ""))
        for word in ("Halted", "Ready", "Running", "Suspended", "RunningToReady", "Start", "Suspend", "Resume", "Halt", "Reset"):
            self.assertIn(word, out)
        self.assertEqual(program(), (0, out, ""))

    def test_dot(self):
        status, out, err = program("--dot")
        self.assertEqual((status, err), (0, ""))
        self.assertTrue(out.startswith("digraph"))
        self.assertEqual(len(re.findall(r"->", out)), 9)

    def test_not_both(self):
        status, out, _ = program("--dot", "--table")
        self.assertEqual((status, out), (2, ""))


if __name__ == "__main__":
    TAKT = sys.argv.pop(1)
    unittest.main(verbosity=2)
