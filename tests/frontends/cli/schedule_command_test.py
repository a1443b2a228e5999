#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""takt schedule as a user runs it: ways that scenarios leave open, limits of the search, and its answer as JSON.

usage: schedule_command_test.py TAKT SOURCE_FOLDER [unittest options]
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

TAKT = ""
SOURCE = pathlib.Path()

SCHEDULED, INFEASIBLE, MISTAKE, UNDECIDED = 0, 1, 2, 4


def takt(*arguments):
    done = subprocess.run([TAKT, *map(str, arguments)], capture_output=True, text=True, timeout=1000, check=False)
    return done.returncode, done.stdout, done.stderr


def two_ways(route):
    """Two streams of 11.728 us each 20 us from sw1 to sw2 of a ring: one has to go round. `route` is said of the first."""
    streams = [{"name": name, "from": talker, "to": listener, "payload": "1400B", "every": "20us", "offset": "auto", "pcp": 6} for name, talker, listener in (("a", "h1", "h2"), ("b", "x", "y"))]
    if route:
        streams[0]["route"] = route
    return {"name": "two-ways", "duration": "2ms", "network": {"generate": [{"topology": "ring", "switches": 4, "forwarding_delay": "1us"}], "nodes": {"x": {"kind": "host"}, "y": {"kind": "host"}},
                                                               "links": [{"ends": ["x", "sw1"]}, {"ends": ["y", "sw2"]}]}, "gates": {"plan": "auto", "classes": [6]}, "streams": streams}


def to_be_moved():
    """A frame of 1 us each 4 us, twice, and one each 6 us. As soon as possible the first two begin at 0 and 1, and then the third, which meets what is 2 us apart, has no place: one of them must move."""
    us = 1_000_000
    streams = [{"name": name, "talker": "a", "listeners": ["b"], "octets": 125, "period": period * us} for name, period in (("s", 4), ("t", 4), ("u", 6))]
    return {"format": "schedule-problem-1", "name": "move", "model": {"strict": True, "preamble": 0, "gap": 0}, "nodes": [{"name": "a", "bridge": False}, {"name": "b", "bridge": False}],
            "links": [{"name": "a>b", "from": "a", "to": "b", "rate": 10**9}], "streams": streams}


class ScheduleCommand(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="takt-schedule-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, scenario):
        path = self.folder / "s.json"
        path.write_text(json.dumps(scenario), encoding="utf-8")
        return path

    def test_routes(self):
        for routes, with_auto, without in (("given", SCHEDULED, INFEASIBLE), ("shortest", INFEASIBLE, INFEASIBLE), ("search", SCHEDULED, SCHEDULED)):
            with self.subTest(routes):
                self.assertEqual(takt("schedule", self.write(two_ways("auto")), "--routes", routes)[0], with_auto)
                self.assertEqual(takt("schedule", self.write(two_ways(None)), "--routes", routes)[0], without)

    def test_what_comes_out_has_paths_and_no_route(self):
        out = self.folder / "scheduled.json"
        self.assertEqual(takt("schedule", self.write(two_ways("auto")), "--routes", "given", "--out", out)[0], SCHEDULED)
        streams = json.loads(out.read_text())["streams"]
        self.assertEqual(streams[0]["path"], ["h1", "sw1", "sw4", "sw3", "sw2", "h2"])
        self.assertNotIn("route", streams[0])
        status, _, told = takt("run", out, "--quiet")
        self.assertEqual((status, told), (0, ""))

    def test_others_take_the_shortest_path_and_check_says_so(self):
        scenario = two_ways("auto")
        for stream in scenario["streams"]:
            stream["every"] = "50us"
        status, _, told = takt("check", self.write(scenario))
        self.assertEqual(status, 0)
        self.assertIn("warning at /streams/0/route: a route that nobody has searched for", told)

    def test_limits(self):
        """A limit that is over at once leaves what needs a search undecided; what is found is found whatever the limit counts."""
        path = self.write(to_be_moved())
        for limit in ("--limit", "--cpu-limit"):
            with self.subTest(limit):
                self.assertEqual(takt("schedule", path, limit, "1ns")[0], UNDECIDED)
                self.assertEqual(takt("schedule", path, limit, "100s")[0], SCHEDULED)
                for bad in ("0s", "soon"):
                    status, _, told = takt("schedule", path, limit, bad)
                    self.assertEqual(status, MISTAKE)
                    self.assertIn(f'{limit}: error: not a time to search: found "{bad}"', told)
        self.assertEqual(takt("schedule", path, "--limit", "100s", "--cpu-limit", "1ns")[0], UNDECIDED)

    def keys(self, value):
        if isinstance(value, dict):
            return set(value) | {key for each in value.values() for key in self.keys(each)}
        return {key for each in value for key in self.keys(each)} if isinstance(value, list) else set()

    def test_every_key_of_the_answer_stands_in_the_reference(self):
        page = (SOURCE / "docs" / "reference" / "schedule-scenario.md").read_text()
        known = set(re.findall(r"^\| `([a-z_]+)` \|", page, re.MULTILINE))
        promised = two_ways("auto")
        promised["streams"].append({"name": "camera", "from": "h1", "to": "h3", "payload": "100B", "every": "1ms", "pcp": 4})
        seen = set()
        for latency in ("1ms", "1us"):
            promised["require"] = [{"stream": "camera", "latency": latency}]
            status, answer, _ = takt("schedule", self.write(promised), "--format", "json", "--objective", "slack")
            self.assertEqual(status, SCHEDULED if latency == "1ms" else UNDECIDED)
            seen |= self.keys(json.loads(answer))
        self.assertLessEqual(seen, known)
        self.assertLessEqual({"verdict", "how", "gate_entries", "slack_ps", "streams", "requirements", "placements", "bound_ps", "limit_ps"}, seen)


if __name__ == "__main__":
    TAKT = os.path.abspath(sys.argv[1])
    SOURCE = pathlib.Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
