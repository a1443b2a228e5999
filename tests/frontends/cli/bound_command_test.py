#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""takt bound: bounds of a scenario and of a network of servers.

usage: bound_command_test.py TAKT SCENARIOS [unittest options]
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

TAKT = ""
SCENARIOS = pathlib.Path()
TANDEM = """{"servers": {"s0": {"rate": 20, "latency": 20}, "s1": {"rate": 20, "latency": 20}, "s2": {"rate": "20", "latency": 2e1}},
 "flows": {"f0": {"path": ["s0", "s1"], "rate": 5, "burst": 25}, "f1": {"path": ["s2"], "rate": 5, "burst": 25},
           "f2": {"path": ["s0", "s1", "s2"], "rate": 5, "burst": 25}}}"""


def bound(*arguments):
    done = subprocess.run([TAKT, "bound", *map(str, arguments)], capture_output=True, text=True, timeout=1000, check=False)
    return done.returncode, done.stdout, done.stderr


def bound_text(text, *arguments):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "n.json"
        path.write_text(text)
        return bound(path, *arguments)


class Scenario(unittest.TestCase):
    def test_page(self):
        status, out, err = bound(SCENARIOS / "robot-arm.json")
        self.assertEqual((status, err), (0, ""))
        for words in ("camera", "sw1:0 to generator", "bits", "Reactions", "start", "[1] nothing-else", "[2] os-latency", "reaction start within 12ms"):
            self.assertIn(words, out)

    def test_json(self):
        status, out, err = bound(SCENARIOS / "robot-arm.json", "--format", "json")
        self.assertEqual((status, err), (0, ""))
        made = json.loads(out)
        stream = next(s for s in made["streams"] if s["name"] == "camera")
        self.assertGreater(stream["bound_ps"], sum(hop["delay_ps"] for hop in stream["hops"]))
        self.assertEqual({r["kind"] for r in made["reactions"]}, {"start", "halt", "suspend", "resume", "reset"})
        for reaction in made["reactions"]:
            self.assertEqual(sum(part["duration_ps"] for part in reaction["parts"]), reaction["bound_ps"])
        self.assertEqual(len(made["requirements"]), 7)

    def test_unbounded_has_a_reason(self):
        _, out, _ = bound(SCENARIOS / "three-slaves-star.json", "--format", "json")
        log = next(s for s in json.loads(out)["streams"] if s["name"] == "log")
        self.assertIsNone(log["bound_ps"])
        self.assertIn("logger:0 to sw1", log["reason"])

    def test_clock_error(self):
        gates = SCENARIOS / "clocks" / "two-nodes.json"
        self.assertEqual(bound(gates, "--clock-error", "2us")[0], 0)
        self.assertEqual(bound(gates, "--clock-error", "soon")[:2], (2, ""))


class Servers(unittest.TestCase):
    def test_known_answers(self):
        status, out, err = bound_text(TANDEM, "--format", "json")
        self.assertEqual((status, err), (0, ""))
        made = json.loads(out)
        self.assertEqual([f["delay"] for f in made["TFA"]], ["55", "2205/64", "5725/64"])
        self.assertEqual([f["delay"] for f in made["SFA"]], ["295/6", "6695/192", "845/12"])

    def test_mistakes(self):
        status, out, err = bound_text(TANDEM.replace('"s0", "s1"', '"s0", "s9"', 1).replace("25", "-1", 1))
        self.assertEqual((status, out), (2, ""))
        self.assertIn("unknown server", err)
        self.assertIn("/flows/f0/burst", err)
        self.assertEqual(bound_text(TANDEM, "--duration", "1s")[0], 2)
        self.assertEqual(bound_text("[]")[0], 2)


if __name__ == "__main__":
    TAKT = sys.argv.pop(1)
    SCENARIOS = pathlib.Path(sys.argv.pop(1))
    unittest.main(verbosity=2)
