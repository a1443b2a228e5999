#!/usr/bin/env python3
"""Three real nodes start, run, suspend, resume and halt together, and take the transitions that the simulator takes.

usage: real_node_test.py TAKT [unittest options]
"""
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

TAKT = ""
NODES = ["plc", "left", "right"]
PROGRAM = {
    "name": "cell", "master": "plc", "slaves": ["left", "right"], "cycle": "5ms", "receive_timeout": "200ms", "initialisation": "20ms",
    "process_data": [{"name": "targets", "from": "plc", "fields": {"x": {"type": "Double", "count": 2}}},
                     {"name": "actual", "from": "left", "fields": {"x": "Double"}}]}
# (node, milliseconds after the begin, method)
CALLS = [("plc", 500, "Start"), ("left", 900, "Suspend"), ("plc", 1200, "Resume"), ("right", 1500, "Halt")]


def script_of(node):
    return [{"at": f"{at}ms", "call": call} for who, at, call in CALLS if who == node]


def simulated(program, calls, duration="2s"):
    """Transitions of each participant in a simulation of the same set-up."""
    nodes = {name: {"kind": "host"} for name in NODES} | {"sw": {"kind": "switch"}}
    program_there = {key: value for key, value in program.items() if key != "publisher_id"}
    scenario = {
        "name": "same", "duration": duration,
        "network": {"nodes": nodes, "links": [{"ends": [name, "sw"]} for name in NODES]},
        "programs": [program_there],
        "script": [{"at": f"{at}.137ms", "program": "cell", "call": call, "on": who} for who, at, call in calls]}
    with tempfile.TemporaryDirectory(prefix="takt-node-") as folder:
        path = pathlib.Path(folder) / "s.json"
        path.write_text(json.dumps(scenario), encoding="utf-8")
        out = pathlib.Path(folder) / "out"
        done = subprocess.run([TAKT, "run", str(path), "--out", str(out), "--timeline", "--quiet"], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
        return states_of_timeline(out / "timeline.json")


def states_of_timeline(path):
    """The sequence of states of each participant."""
    events = json.loads(path.read_text(encoding="utf-8"))
    events = events["traceEvents"] if isinstance(events, dict) else events
    names = {(e["pid"], e["tid"]): e["args"]["name"] for e in events if e.get("ph") == "M" and e.get("name") == "thread_name"}
    states = {name: [] for name in NODES}
    known = ("Halted", "Halted.INIT", "Ready", "Running", "Suspended")
    for event in sorted((e for e in events if e.get("ph") == "X" and e.get("name") in known), key=lambda e: e["ts"]):
        name = names.get((event["pid"], event["tid"]))
        if name in states:
            states[name].append(event["name"])
    return states


class Group:
    """The nodes of one test, started as processes."""

    def __init__(self, test, folder, transport_of, prefix_of=lambda node: [], duration="2s", program=None, calls=True):
        self.processes = {}
        for node in NODES:
            config = {"node": node, "program": program or PROGRAM, "transport": transport_of(node), "script": script_of(node) if calls else []}
            if duration:
                config["duration"] = duration
            path = folder / f"{node}.json"
            path.write_text(json.dumps(config), encoding="utf-8")
            self.processes[node] = subprocess.Popen(prefix_of(node) + [TAKT, "node", str(path)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        test.addCleanup(self.kill)

    def kill(self):
        for process in self.processes.values():
            if process.poll() is None:
                process.kill()
            process.communicate()

    def events(self):
        """Waits for the ends; the events of each node."""
        events = {}
        for node, process in self.processes.items():
            out, err = process.communicate(timeout=30)
            assert process.returncode == 0, (node, process.returncode, out, err)
            events[node] = [json.loads(line) for line in out.splitlines()]
        return events


def states(events):
    return {node: ["Halted"] + [e["to"] for e in log if e["event"] == "transition"] for node, log in events.items()}


def loopback(node):
    port = {name: 48401 + i for i, name in enumerate(NODES)}
    return {"kind": "udp", "port": port[node], "destinations": [f"127.0.0.1:{port[other]}" for other in NODES if other != node]}


class NodeTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="takt-node-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def expect_as_simulated(self, events):
        self.assertEqual(states(events), simulated(PROGRAM, CALLS))
        for node, log in events.items():
            self.assertEqual(log[-1]["event"], "end", node)
            self.assertEqual(log[-1]["statistics"]["foreign"], 0, node)
            causes = [e["cause"] for e in log if e["event"] == "intent"]
            self.assertTrue(all(cause == "command" for cause in causes), (node, causes))
        # Process data arrives while Running: about 400 and 300 ms of 5 ms cycles, besides the states.
        self.assertGreater(events["left"][-1]["statistics"]["taken"], 50)


class Loopback(NodeTest):
    def test_the_same_transitions_as_simulated(self):
        self.expect_as_simulated(Group(self, self.folder, loopback).events())

    def test_all_to_all(self):
        program = PROGRAM | {"subscription": "all-to-all", "publish": "on-change"}
        events = Group(self, self.folder, loopback, program=program).events()
        self.assertEqual(states(events), simulated(program, CALLS))

    def test_a_killed_node_halts_the_others(self):
        group = Group(self, self.folder, loopback, duration="1500ms")
        time.sleep(0.8)
        group.processes["right"].send_signal(signal.SIGKILL)
        group.processes["right"].communicate()
        del group.processes["right"]
        events = group.events()
        causes = [e["cause"] for e in events["plc"] if e["event"] == "intent" and e["kind"] == "halt"]
        self.assertEqual(causes, ["silent peer"])
        for log in events.values():
            self.assertEqual(log[-1]["state"], "Halted")

    def test_a_signal_ends_it_cleanly(self):
        group = Group(self, self.folder, loopback, duration=None, calls=False)
        time.sleep(0.3)
        for process in group.processes.values():
            process.send_signal(signal.SIGTERM)
        for log in group.events().values():
            self.assertEqual(log[-1]["event"], "end")


class Mistakes(NodeTest):
    def run_node(self, text):
        path = self.folder / "n.json"
        path.write_text(text, encoding="utf-8")
        done = subprocess.run([TAKT, "node", str(path)], capture_output=True, text=True, timeout=30, check=False)
        return done.returncode, done.stdout, done.stderr

    def test_bad_input(self):
        status, out, err = self.run_node('{"node": "x"}')
        self.assertEqual((status, out), (2, ""))
        self.assertIn("n.json:1", err)

    def test_no_such_interface(self):
        config = {"node": "plc", "program": PROGRAM, "transport": {"kind": "udp", "interface": "nope0", "destinations": ["224.0.2.14"]}}
        status, out, err = self.run_node(json.dumps(config))
        self.assertEqual((status, out), (3, ""))
        self.assertIn("nope0", err)


class Namespaces(NodeTest):
    """Three namespaces, each joined to a Linux bridge by a veth pair. Needs root."""

    def setUp(self):
        super().setUp()
        self.tag = f"tk{os.getpid() % 10000}"
        self.addCleanup(self.take_down)
        try:
            self.ip("link", "add", f"{self.tag}br", "type", "bridge", "mcast_snooping", "0")
            self.ip("link", "set", f"{self.tag}br", "up")
            for i, node in enumerate(NODES):
                space = f"{self.tag}{node}"
                self.ip("netns", "add", space)
                self.ip("link", "add", f"{self.tag}v{i}", "type", "veth", "peer", "name", "eth0", "netns", space)
                self.ip("link", "set", f"{self.tag}v{i}", "master", f"{self.tag}br", "up")
                self.ip("-n", space, "addr", "add", f"10.77.0.{i + 1}/24", "dev", "eth0")
                self.ip("-n", space, "link", "set", "eth0", "up")
                self.ip("-n", space, "link", "set", "lo", "up")
        except (OSError, subprocess.CalledProcessError) as error:
            reason = (getattr(error, "stderr", "") or str(error)).strip()
            print(f"\nskipped: network namespaces are not permitted here: {reason}", file=sys.stderr)
            self.skipTest(reason)
        time.sleep(0.3)

    def ip(self, *arguments):
        subprocess.run(["ip", *arguments], check=True, capture_output=True, text=True)

    def take_down(self):
        for node in NODES:
            subprocess.run(["ip", "netns", "del", f"{self.tag}{node}"], capture_output=True, check=False)
        subprocess.run(["ip", "link", "del", f"{self.tag}br"], capture_output=True, check=False)

    def prefix(self, node):
        return ["ip", "netns", "exec", f"{self.tag}{node}"]

    def test_udp_multicast(self):
        transport = {"kind": "udp", "interface": "eth0", "destinations": ["239.0.2.14"]}
        self.expect_as_simulated(Group(self, self.folder, lambda node: transport, self.prefix).events())

    def test_ethernet(self):
        transport = {"kind": "ethernet", "interface": "eth0"}
        self.expect_as_simulated(Group(self, self.folder, lambda node: transport, self.prefix).events())

    def test_ethernet_with_a_tag(self):
        transport = {"kind": "ethernet", "interface": "eth0", "vlan": 5, "pcp": 6}
        self.expect_as_simulated(Group(self, self.folder, lambda node: transport, self.prefix).events())


if __name__ == "__main__":
    TAKT = sys.argv.pop(1)
    unittest.main(verbosity=2)
