#!/usr/bin/env python3
"""Real nodes in nested Programs: methods and halts reach the whole tree, and each Program is told, shown and logged by its name.

usage: nested_node_test.py TAKT [unittest options]
"""
import json
import signal
import subprocess
import sys
import time
import unittest

sys.dont_write_bytecode = True
import real_node_test  # noqa: E402


class Nested(real_node_test.Ctl):
    """The middle is a slave of the outer Program and the master of the inner one, in one process. All nodes have the same list."""

    NAMES = ("plc", "middle", "left", "right")
    PROGRAMS = [{"name": "cell", "master": "plc", "slaves": ["middle"], "cycle": "5ms", "receive_timeout": "1s", "initialisation": "20ms",
                 "process_data": [{"name": "d", "from": "plc", "fields": {"x": "Double"}}]},
                {"name": "my axes", "within": "cell", "master": "middle", "slaves": ["left", "right"], "cycle": "3ms", "receive_timeout": "1s", "initialisation": "20ms",
                 "process_data": [{"name": "d", "from": "middle", "fields": {"x": "Int16"}}]}]

    def start_nodes(self, more=None):
        port = {name: 48421 + i for i, name in enumerate(self.NAMES)}
        self.group = real_node_test.Group.__new__(real_node_test.Group)
        self.group.processes = {}
        self.addCleanup(self.group.kill)
        for node in self.NAMES:
            transport = {"kind": "udp", "port": port[node], "destinations": [f"127.0.0.1:{port[other]}" for other in self.NAMES if other != node]}
            config = {"node": node, "programs": self.PROGRAMS, "transport": transport, "control": str(self.folder / f"{node}.sock")} | (more or {}).get(node, {})
            path = self.folder / f"{node}.json"
            path.write_text(json.dumps(config), encoding="utf-8")
            self.group.processes[node] = subprocess.Popen([real_node_test.TAKT, "node", str(path)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def all_states(self):
        """(node, program): state; None where somebody is not heard yet."""
        states = {}
        for node in self.NAMES:
            code, out, _ = self.ctl(node, "status", "--format", "json")
            status = json.loads(out) if code == 0 else {"programs": []}
            for each in status.get("programs", [status]):
                states[node, each["program"]] = each["state"] if all(peer["state"] for peer in each["peers"]) else None
        return states

    def wait_for_all(self, state):
        for _ in range(400):
            states = self.all_states()
            if len(states) == 5 and set(states.values()) == {state}:
                return
            time.sleep(0.02)
        self.fail(f"not all are {state}: {states}")

    def end(self):
        for process in self.group.processes.values():
            process.send_signal(signal.SIGTERM)
        return self.group.events()

    def test_methods_reach_the_whole_tree(self):
        self.start_nodes({"middle": {"sources": [{"program": "my axes", "data_set": "d", "kind": "constant", "value": 7}], "log_values_every": "50ms"}, "right": {"log_values_every": "50ms"}})
        self.wait_for_all("Halted")
        sock = self.folder / "middle.sock"
        self.assertEqual(self.ctl("middle", "start", "my axes"), (1, f"Start: Bad_InvalidState; {sock} is Halted in my axes\n", ""))  # is started with the cell
        self.assertEqual(self.ctl("plc", "start")[0], 0)
        self.wait_for_all("Running")
        time.sleep(0.3)
        for caller, request, state in (("right", ["suspend"], "Suspended"), ("plc", ["resume", "cell"], "Running"), ("middle", ["suspend"], "Suspended"), ("middle", ["resume", "my axes"], "Running"),
                                       ("middle", ["halt", "my axes"], "Halted"), ("plc", ["start"], "Running"), ("left", ["halt"], "Halted")):
            code, out, err = self.ctl(caller, *request)
            self.assertEqual(code, 0, out + err)
            self.wait_for_all(state)
        code, out, _ = self.ctl("middle", "status")
        self.assertEqual(code, 0)
        for text in ("middle: Halted, slave of cell (robust)", "middle: Halted, master of my axes (robust)", "peer plc: Halted", "peer right: Halted"):
            self.assertIn(text, out)
        self.assertNotIn("of cell", self.ctl("middle", "status", "my axes")[1])
        code, out, err = self.ctl("middle", "halt", "axes")
        self.assertEqual((code, out), (2, ""))
        self.assertIn("not in program axes", err)
        logs = self.end()
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
        self.start_nodes()
        self.wait_for_all("Halted")
        self.assertEqual(self.ctl("plc", "start")[0], 0)
        self.wait_for_all("Running")
        self.group.processes["right"].kill()
        self.group.processes.pop("right").communicate()
        for _ in range(400):
            states = self.all_states()
            if {state for (node, _), state in states.items() if node in ("plc", "left")} == {"Halted"}:
                break
            time.sleep(0.02)
        logs = self.end()
        causes = [(e["program"], e["cause"]) for e in logs["middle"] if e["event"] == "intent" and e["kind"] == "halt"]
        self.assertEqual(causes, [("my axes", "silent peer"), ("cell", "nested group")])
        self.assertEqual([logs[node][-1]["state"] for node in ("plc", "left")], ["Halted"] * 2)

    def test_the_script_names_a_program(self):
        self.start_nodes({"plc": {"script": [{"at": "700ms", "call": "Start"}]},
                          "middle": {"script": [{"at": "1200ms", "program": "my axes", "call": "Suspend"}, {"at": "1500ms", "call": "Halt"}]}})
        time.sleep(2.2)
        logs = self.end()
        for node, log in logs.items():
            for program in {event.get("program") for event in log if event["event"] == "transition"}:
                changes = [event["to"] for event in log if event["event"] == "transition" and event.get("program") == program]
                self.assertEqual(changes, ["Halted.INIT", "Ready", "Running", "Suspended", "Halted"], (node, program))
        self.assertEqual([(e["program"], e["method"]) for e in logs["middle"] if e["event"] == "call"], [("my axes", "Suspend"), ("cell", "Halt")])


if __name__ == "__main__":
    real_node_test.TAKT = sys.argv.pop(1)
    unittest.main(verbosity=2)
