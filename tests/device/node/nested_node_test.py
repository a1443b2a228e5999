#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Real nodes in nested Programs: methods and halts reach the whole tree, and each Program is told, shown and logged by its name.

usage: nested_node_test.py TAKT [unittest options]
"""
import json
import signal
import sys
import unittest

sys.dont_write_bytecode = True
import real_node_test  # noqa: E402


class Nested(real_node_test.Ctl):
    """The middle is a slave of the outer Program and the master of the inner one, in one process. All nodes have the same list."""

    NAMES = ("plc", "middle", "left", "right")
    PROGRAMS = [{"name": "cell", "master": "plc", "slaves": ["middle"], "cycle": "5ms", "receive_timeout": "1000s", "initialisation": "20ms",
                 "process_data": [{"name": "d", "from": "plc", "fields": {"x": "Double"}}]},
                {"name": "my axes", "within": "cell", "master": "middle", "slaves": ["left", "right"], "cycle": "3ms", "receive_timeout": "1000s", "initialisation": "20ms",
                 "process_data": [{"name": "d", "from": "middle", "fields": {"x": "Int16"}}]}]

    def start_nodes(self, more=None, programs=None):
        port = {name: real_node_test.PORTS + i for i, name in enumerate(self.NAMES)}
        self.group = real_node_test.Group.__new__(real_node_test.Group)
        self.group.processes, self.group.files = {}, {}
        self.group.sockets = {node: self.folder / f"{node}.sock" for node in self.NAMES}
        self.addCleanup(self.group.kill)
        for node in self.NAMES:
            transport = {"kind": "udp", "port": port[node], "destinations": [f"127.0.0.1:{port[other]}" for other in self.NAMES if other != node]}
            config = {"node": node, "programs": programs or self.PROGRAMS, "transport": transport, "control": str(self.group.sockets[node])} | real_node_test.LIFE | (more or {}).get(node, {})
            path = self.folder / f"{node}.json"
            path.write_text(json.dumps(config), encoding="utf-8")
            self.group.start(node, path)

    def test_methods_reach_the_whole_tree(self):
        self.start_nodes({"middle": {"sources": [{"program": "my axes", "data_set": "d", "kind": "constant", "value": 7}], "log_values_every": "50ms"}, "right": {"log_values_every": "50ms"}})
        self.group.wait_for_state("Halted")
        sock = self.folder / "middle.sock"
        self.assertEqual(self.ctl("middle", "start", "my axes"), (1, f"Start: Bad_InvalidState; {sock} is Halted in my axes\n", ""))  # is started with the cell
        self.assertEqual(self.ctl("plc", "start")[0], 0)
        self.group.wait_for_state("Running")
        self.group.wait_for_cycles(30)  # values come
        for caller, request, state in (("right", ["suspend"], "Suspended"), ("plc", ["resume", "cell"], "Running"), ("middle", ["suspend"], "Suspended"), ("middle", ["resume", "my axes"], "Running"),
                                       ("middle", ["halt", "my axes"], "Halted"), ("plc", ["start"], "Running"), ("left", ["halt"], "Halted")):
            code, out, err = self.ctl(caller, *request)
            self.assertEqual(code, 0, out + err)
            self.group.wait_for_state(state)
        code, out, _ = self.ctl("middle", "status")
        self.assertEqual(code, 0)
        for text in ("middle: Halted, slave of cell (robust)", "middle: Halted, master of my axes (robust)", "peer plc: Halted", "peer right: Halted"):
            self.assertIn(text, out)
        self.assertNotIn("of cell", self.ctl("middle", "status", "my axes")[1])
        code, out, err = self.ctl("middle", "halt", "axes")
        self.assertEqual((code, out), (2, ""))
        self.assertIn("not in program axes", err)
        logs = self.group.end()
        self.assertEqual({event.get("program") for event in logs["middle"] if event["event"] == "transition"}, {"cell", "my axes"})
        self.assertEqual([(e["program"], e["status"]) for e in logs["middle"] if e["event"] == "call"],
                         [("my axes", "Bad_InvalidState"), ("cell", "Good"), ("my axes", "Good"), ("my axes", "Good")])
        self.assertNotIn("program", [event for event in logs["left"] if event["event"] == "transition"][0])
        self.assertEqual({event["fields"]["x"] for event in logs["right"] if event["event"] == "data"}, {7})
        self.assertEqual({(event["program"], event["fields"]["x"]) for event in logs["middle"] if event["event"] == "data"}, {("cell", 0.0)})
        # Both Programs' messages reach the middle, and neither counts as foreign; the plc has those of the inner one.
        self.assertEqual([each["statistics"]["foreign"] for each in logs["middle"][-1]["programs"]], [0, 0])
        self.assertGreater(logs["plc"][-1]["statistics"]["foreign"], 0)

    def test_a_killed_inner_slave_halts_the_tree(self):
        self.start_nodes(programs=[each | {"receive_timeout": "5s"} for each in self.PROGRAMS])
        self.group.wait_for_state("Halted")
        self.assertEqual(self.ctl("plc", "start")[0], 0)
        self.group.wait_for_state("Running")
        self.group.processes["right"].kill()
        self.group.processes.pop("right").wait()
        self.group.wait("Halted", lambda found: all(each["state"] == "Halted" for status in found.values() for each in status.get("programs", [status])))
        logs = self.group.end()
        causes = [(e["program"], e["cause"]) for e in logs["middle"] if e["event"] == "intent" and e["kind"] == "halt"]
        self.assertEqual(causes, [("my axes", "silent peer"), ("cell", "nested group")])
        self.assertEqual([logs[node][-1]["state"] for node in ("plc", "left")], ["Halted"] * 2)

    def test_the_script_names_a_program(self):
        """Nobody has started when the calls of the middle come, so both are refused, each by its Program; the start of the plc is not."""
        self.start_nodes({"middle": {"script": [{"at": "0ms", "program": "my axes", "call": "Halt"}, {"at": "1ms", "call": "Halt"}]}})
        self.group.wait_for_state("Halted")
        self.assertEqual(self.ctl("plc", "start")[0], 0)
        self.group.wait_for_state("Running")
        self.assertEqual(self.ctl("middle", "suspend", "my axes")[0], 0)
        self.group.wait_for_state("Suspended")
        logs = self.group.end()
        self.assertEqual([(e["program"], e["method"], e["status"]) for e in logs["middle"] if e["event"] == "call"],
                         [("my axes", "Halt", "Bad_InvalidState"), ("cell", "Halt", "Bad_InvalidState"), ("my axes", "Suspend", "Good")])
        for node, log in logs.items():
            for program in {event.get("program") for event in log if event["event"] == "transition"}:
                changes = [event["to"] for event in log if event["event"] == "transition" and event.get("program") == program]
                self.assertEqual(changes, ["Halted.INIT", "Ready", "Running", "Suspended"], (node, program))


if __name__ == "__main__":
    real_node_test.TAKT = sys.argv.pop(1)
    unittest.main(verbosity=2)
