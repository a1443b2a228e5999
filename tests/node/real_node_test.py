#!/usr/bin/env python3
"""Three real nodes start, run, suspend, resume and halt together, and take the transitions that the simulator takes.

usage: real_node_test.py TAKT [unittest options]
"""
import json
import os
import pathlib
import signal
import struct
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


def simulated(program, calls, duration="2s", see=lambda out: states_of_timeline(out / "timeline.json")):
    """Transitions of each participant in a simulation of the same set-up, or what else `see` makes of its results."""
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
        done = subprocess.run([TAKT, "run", str(path), "--out", str(out), "--timeline", "--pcap", "all", "--quiet"], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
        return see(out)


def frames_of_pcap(path):
    octets = path.read_bytes()
    order = "<" if octets[:4] in (b"\x4d\x3c\xb2\xa1", b"\xd4\xc3\xb2\xa1") else ">"
    at = 24
    while at < len(octets):
        size = struct.unpack_from(order + "I", octets, at + 8)[0]
        yield octets[at + 16:at + 16 + size]
        at += 16 + size


def kinds_of_frames(path):
    """Tagged UADP frames from the tag on, without padding; 0 for what each message or start of a node has anew: sequence numbers, runs, incarnations."""
    lengths = {1: 42, 2: 24 + 16, 3: 24 + 8}  # by WriterGroupId: state, "targets", "actual"
    kinds = set()
    for frame in frames_of_pcap(path):
        if frame[12:14] != b"\x81\x00" or frame[16:18] != b"\xb6\x2c":
            continue
        message = bytearray(frame[18:])
        group = int.from_bytes(message[5:7], "little")
        del message[lengths[group]:]
        for begin, end in [(13, 15), (16, 18)] + ([(24, 32), (36, 40)] if group == 1 else [(20, 24)]):
            message[begin:end] = bytes(end - begin)
        kinds.add((frame[12:18] + message).hex())
    return kinds


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

    def __init__(self, test, folder, transport_of, prefix_of=lambda node: [], duration="2s", program=None, calls=True, more=None):
        self.processes = {}
        for node in NODES:
            config = {"node": node, "program": program or PROGRAM, "transport": transport_of(node), "script": script_of(node) if calls else [],
                      "control": str(folder / f"{node}.sock")} | (more or {}).get(node, {})
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
        self.said = {}
        for node, process in self.processes.items():
            out, err = process.communicate(timeout=30)
            self.said[node] = err
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

    def expect_as_simulated(self, events, program=None):
        self.assertEqual(states(events), simulated(program or PROGRAM, CALLS))
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

    def test_paper(self):
        program = PROGRAM | {"variant": "paper"}
        self.expect_as_simulated(Group(self, self.folder, loopback, program=program).events(), program)

    def test_values_travel(self):
        more = {"plc": {"sources": [{"data_set": "targets", "kind": "counter", "value": 100, "step": 2}]}, "left": {"log_values_every": "0ns"},
                "right": {"log_values_every": "200ms"}}
        events = Group(self, self.folder, loopback, more=more).events()
        values = [e["fields"]["x"] for e in events["left"] if e["event"] == "data" and e["data_set"] == "targets"]
        self.assertGreater(len(values), 50)
        self.assertTrue(all(x[0] == x[1] and x[0] >= 100 and x[0] % 2 == 0 for x in values), values)
        self.assertEqual(values, sorted(values))
        often = len([e for e in events["right"] if e["event"] == "data"])
        self.assertTrue(1 <= often <= 12, often)  # of two data sets, in 700 ms

    def test_statistics(self):
        for log in Group(self, self.folder, loopback).events().values():
            end = log[-1]
            statistics = end["statistics"]
            self.assertGreater(statistics["late"]["count"], 100)
            self.assertLessEqual(statistics["late"]["min_ns"], statistics["late"]["mean_ns"])
            self.assertEqual(statistics["jitter_ns"], statistics["late"]["max_ns"] - statistics["late"]["min_ns"])
            self.assertEqual(statistics["missed_cycles"], statistics["missed_by_code"] + statistics["missed_by_system"])
            for peer in end["peers"]:
                self.assertGreater(peer["answer"]["count"], 100)
                self.assertEqual(peer["state"], "Halted")
        # Whoever raised an intent has seen the master's agreement come back.
        self.assertGreater(log[-1]["peers"][0]["round_trip"]["count"], 0)

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


class Ctl(NodeTest):
    def ctl(self, node, request, *more):
        done = subprocess.run([TAKT, "ctl", node if "/" in node else str(self.folder / f"{node}.sock"), request, *more], capture_output=True, text=True, timeout=30, check=False)
        return done.returncode, done.stdout, done.stderr

    def wait_for(self, node, state):
        for _ in range(400):
            code, out, _ = self.ctl(node, "status", "--format", "json")
            if code == 0 and json.loads(out)["state"] == state and all(peer["state"] for peer in json.loads(out)["peers"]):
                return
            time.sleep(0.02)
        self.fail(f"{node} is not {state}: {out}")


class Control(Ctl):
    def test_methods_and_status(self):
        group = Group(self, self.folder, loopback, duration=None, calls=False)
        for node in NODES:
            self.wait_for(node, "Halted")
        self.assertEqual(self.ctl("plc", "suspend")[:2], (1, f"Suspend: Bad_InvalidState; {self.folder / 'plc.sock'} is Halted\n"))
        self.assertEqual(self.ctl("left", "start")[0], 1)  # a slave does not start a robust group
        for caller, request, state in (("plc", "start", "Running"), ("left", "suspend", "Suspended"), ("plc", "resume", "Running"),
                                       ("right", "suspend", "Suspended"), ("right", "reset", "Ready"), ("plc", "start", "Running"), ("right", "halt", "Halted")):
            code, out, err = self.ctl(caller, request)
            self.assertEqual(code, 0, out + err)
            self.assertIn("Good", out)
            for node in NODES:
                self.wait_for(node, state)
        code, out, _ = self.ctl("plc", "status")
        self.assertEqual(code, 0)
        for text in ("plc: Halted, master of cell (robust)", "last intent: halt by right", "peer left: Halted", "late for the cycle", "round trip to right", "by the operating system"):
            self.assertIn(text, out)
        for process in group.processes.values():
            process.send_signal(signal.SIGTERM)
        for log in group.events().values():
            self.assertEqual([e["status"] for e in log if e["event"] == "call"].count("Bad_InvalidState"), 1 if log[0]["node"] in ("plc", "left") else 0)
        self.assertEqual(list(self.folder.glob("*.sock")), [])

    def test_nobody_there(self):
        code, out, err = self.ctl("plc", "status")
        self.assertEqual((code, out), (3, ""))
        self.assertIn("plc.sock", err)
        self.assertEqual(self.ctl("plc", "stop")[0], 2)

    def test_one_node_a_socket(self):
        group = Group(self, self.folder, loopback, duration=None, calls=False)
        self.wait_for("plc", "Halted")
        self.assertEqual(oct((self.folder / "plc.sock").stat().st_mode)[-3:], "600")
        again = subprocess.run([TAKT, "node", str(self.folder / "plc.json")], capture_output=True, text=True, timeout=30, check=False)
        self.assertEqual((again.returncode, again.stdout), (3, ""))
        self.assertIn("already", again.stderr)
        # A killed node leaves its socket; the next one takes its place.
        group.processes["plc"].kill()
        group.processes.pop("plc").communicate()
        self.assertTrue((self.folder / "plc.sock").exists())
        process = subprocess.Popen([TAKT, "node", str(self.folder / "plc.json")], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        group.processes["plc"] = process
        self.wait_for("plc", "Halted")

    def test_by_name(self):
        environment = os.environ | {"XDG_RUNTIME_DIR": str(self.folder)}
        config = {"node": "plc", "program": PROGRAM, "transport": loopback("plc"), "duration": "20s"}
        (self.folder / "n.json").write_text(json.dumps(config), encoding="utf-8")
        process = subprocess.Popen([TAKT, "node", str(self.folder / "n.json")], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        for _ in range(200):
            done = subprocess.run([TAKT, "ctl", "plc", "start"], env=environment, capture_output=True, text=True, check=False)
            if done.returncode == 0:
                break
            time.sleep(0.02)
        self.assertEqual(done.stdout, "Start: Good; plc is Halted.INIT\n")


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

    def test_sources(self):
        config = {"node": "plc", "program": PROGRAM, "transport": loopback("plc"), "launch_lead": "5ms",
                  "sources": [{"data_set": "actual", "kind": "counter"}, {"data_set": "targets", "field": "y", "kind": "sine"}]}
        status, out, err = self.run_node(json.dumps(config))
        self.assertEqual((status, out), (2, ""))
        for text in ("not published here", "no such field", "a lead of more than the cycle"):
            self.assertIn(text, err)

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

    def captured(self, transport, fields):
        """Runs the group; what tshark dissects of the frames of its bridge, one line a frame, and complains of."""
        pcap = self.folder / "frames.pcap"
        capture = subprocess.Popen(["tshark", "-q", "-i", f"{self.tag}v0", "-F", "pcap", "-w", str(pcap), "-a", "duration:8"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(capture.kill)
        for line in capture.stderr:
            if "Capturing" in line:
                break
        time.sleep(0.5)
        events = Group(self, self.folder, lambda node: transport, self.prefix).events()
        capture.send_signal(signal.SIGINT)
        capture.communicate(timeout=30)
        self.expect_as_simulated(events)
        checks = ["-o", "ip.check_checksum:TRUE", "-o", "udp.check_checksum:TRUE"]
        shown = subprocess.run(["tshark", "-r", str(pcap), *checks, "-Y", "udp.port == 4840 || eth.type == 0xb62c || vlan.etype == 0xb62c", "-T", "fields",
                                *[part for field in fields for part in ("-e", field)]], capture_output=True, text=True, check=True)
        bad = subprocess.run(["tshark", "-r", str(pcap), *checks, "-Y", "_ws.malformed || ip.checksum.status == 0 || udp.length.bad"], capture_output=True, text=True, check=False)
        self.assertEqual(bad.stdout, "")
        frames = [line.split("\t") for line in shown.stdout.splitlines()]
        self.assertGreater(len(frames), 300)
        return frames

    # The state of a robust participant has 42 octets; UDP and IP say so.
    def test_udp_multicast(self):
        transport = {"kind": "udp", "interface": "eth0", "destinations": ["239.0.2.14"], "pcp": 5}
        frames = self.captured(transport, ["ip.src", "ip.dst", "udp.dstport", "udp.length", "ip.len", "eth.dst", "ip.dsfield.dscp"])
        self.assertEqual({frame[0] for frame in frames}, {"10.77.0.1", "10.77.0.2", "10.77.0.3"})
        self.assertEqual({tuple(frame[1:3]) + tuple(frame[5:]) for frame in frames}, {("239.0.2.14", "4840", "01:00:5e:00:02:0e", "40")})
        self.assertEqual({(int(frame[3]), int(frame[4])) for frame in frames}, {(8 + size, 28 + size) for size in (42, 24 + 16, 24 + 8)})

    def test_ethernet(self):
        transport = {"kind": "ethernet", "interface": "eth0"}
        frames = self.captured(transport, ["eth.dst", "eth.type", "vlan.id", "frame.len"])
        self.assertEqual({tuple(frame[:3]) for frame in frames}, {("01:00:5e:7f:00:01", "0xb62c", "")})
        self.assertLessEqual({int(frame[3]) for frame in frames}, {14 + size for size in (42, 40, 32)})

    def test_ethernet_with_a_tag(self):
        transport = {"kind": "ethernet", "interface": "eth0", "vlan": 5, "pcp": 6}
        frames = self.captured(transport, ["eth.dst", "vlan.etype", "vlan.id", "vlan.priority"])
        self.assertEqual({tuple(frame) for frame in frames}, {("01:00:5e:7f:00:01", "0xb62c", "5", "6")})
        # Octet for octet what the simulator sends: the same set of messages.
        there = simulated(PROGRAM | {"vlan": 5, "pcp": 6}, CALLS, see=lambda out: kinds_of_frames(out / "all.pcap"))
        self.assertEqual(kinds_of_frames(self.folder / "frames.pcap"), there)
        self.assertGreater(len(there), 20)

    def test_launch_times(self):
        transport = {"kind": "ethernet", "interface": "eth0"}
        more = {node: {"launch_lead": "1ms"} for node in NODES}
        group = Group(self, self.folder, lambda node: transport, self.prefix, more=more)
        self.expect_as_simulated(group.events())
        self.assertIn("without launch times", group.said["plc"])
        for node in NODES:
            done = subprocess.run(["tc", "-n", f"{self.tag}{node}", "qdisc", "replace", "dev", "eth0", "root", "fq"], capture_output=True, text=True, check=False)
            if done.returncode != 0:
                print(f"\nskipped: no qdisc fq here: {done.stderr.strip()}", file=sys.stderr)
                self.skipTest(done.stderr)
        group = Group(self, self.folder, lambda node: transport, self.prefix, more=more)
        self.expect_as_simulated(group.events())
        self.assertNotIn("without launch times", group.said["plc"])


if __name__ == "__main__":
    TAKT = sys.argv.pop(1)
    unittest.main(verbosity=2)
