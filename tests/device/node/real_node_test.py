#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Three real nodes start, run, suspend, resume and halt together, and take the transitions that the simulator takes.

No test depends on how fast the machine is: calls are made when all nodes have come where the one before leads them, and only a node that is gone is
silent for as long as a time-out.

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

sys.dont_write_bytecode = True
sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent.parent / "support"))
import capture  # noqa: E402
import reservation  # noqa: E402

TAKT = ""
PORTS = reservation.ports()
NODES = ["plc", "left", "right"]
PROGRAM = {
    "name": "cell", "master": "plc", "slaves": ["left", "right"], "cycle": "5ms", "receive_timeout": "1000s", "initialisation": "20ms",
    "process_data": [{"name": "targets", "from": "plc", "fields": {"x": {"type": "Double", "count": 2}}},
                     {"name": "actual", "from": "left", "fields": {"x": "Double"}}]}
# (node, milliseconds after the begin of the simulated run, method, where it leads all)
CALLS = [("plc", 500, "Start", "Running"), ("left", 900, "Suspend", "Suspended"), ("plc", 1200, "Resume", "Running"), ("right", 1500, "Halt", "Halted")]
HALTED_INIT = 15  # on the wire
PATIENCE = 300  # seconds; what takes longer hangs
LIFE = {"duration": "600s"}  # nodes end by themselves if the test is killed


def simulated(program, calls, duration="2s", see=lambda out: states_of_timeline(out / "timeline.json")):
    """Transitions of each participant in a simulation of the same set-up, or what else `see` makes of its results."""
    nodes = {name: {"kind": "host"} for name in NODES} | {"sw": {"kind": "switch"}}
    program_there = {key: value for key, value in program.items() if key != "publisher_id"}
    scenario = {
        "name": "same", "duration": duration,
        "network": {"nodes": nodes, "links": [{"ends": [name, "sw"]} for name in NODES]},
        "programs": [program_there],
        "script": [{"at": f"{at}.137ms", "program": "cell", "call": call, "on": who} for who, at, call, _ in calls]}
    with tempfile.TemporaryDirectory(prefix="takt-node-") as folder:
        path = pathlib.Path(folder) / "s.json"
        path.write_text(json.dumps(scenario), encoding="utf-8")
        out = pathlib.Path(folder) / "out"
        done = subprocess.run([TAKT, "run", str(path), "--out", str(out), "--timeline", "--pcap", "all", "--quiet"], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
        return see(out)


def frames_of_capture(path):
    """The frames of a pcapng file, little-endian: Enhanced Packet Blocks."""
    octets = path.read_bytes()
    at = 0
    while at < len(octets):
        kind, length = struct.unpack_from("<II", octets, at)
        if kind == 6:
            yield octets[at + 28:at + 28 + struct.unpack_from("<I", octets, at + 20)[0]]
        at += length


def kinds_of_frames(path):
    """Tagged UADP frames from the tag on, without padding; 0 for what each message or start of a node has anew: sequence numbers, runs, incarnations."""
    lengths = {1: 42, 2: 24 + 16, 3: 24 + 8}  # by WriterGroupId: state, "targets", "actual"
    kinds = set()
    for frame in frames_of_capture(path):
        if frame[12:14] != b"\x81\x00" or frame[16:18] != b"\xb6\x2c":
            continue
        message = bytearray(frame[18:])
        group = int.from_bytes(message[5:7], "little")
        del message[lengths[group]:]
        for begin, end in [(13, 15), (16, 18)] + ([(24, 32), (36, 40)] if group == 1 else [(20, 24)]):
            message[begin:end] = bytes(end - begin)
        kinds.add((frame[12:18] + message).hex())
    return kinds


def is_passing(kind):
    """Whether it is the word of a node in Halted.INIT, which a slave may leave before its next cycle, so that nobody hears of it."""
    message = bytes.fromhex(kind)[6:]
    return int.from_bytes(message[5:7], "little") == 1 and int.from_bytes(message[20:24], "little") == HALTED_INIT


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

    def __init__(self, test, folder, transport_of, prefix_of=lambda node: [], program=None, more=None):
        self.processes, self.files = {}, {}
        self.sockets = {node: folder / f"{node}.sock" for node in NODES}
        for node in NODES:
            config = {"node": node, "program": program or PROGRAM, "transport": transport_of(node), "control": str(self.sockets[node])} | LIFE | (more or {}).get(node, {})
            path = folder / f"{node}.json"
            path.write_text(json.dumps(config), encoding="utf-8")
            self.start(node, path, prefix_of(node))
        test.addCleanup(self.kill)

    def start(self, node, path, prefix=()):
        """Into files: a pipe that nobody reads would stop a node that logs much."""
        with open(path.with_suffix(".out"), "w", encoding="utf-8") as out, open(path.with_suffix(".err"), "w", encoding="utf-8") as err:
            self.processes[node] = subprocess.Popen([*prefix, TAKT, "node", str(path)], stdout=out, stderr=err)
        self.files[node] = path

    def kill(self):
        for process in self.processes.values():
            if process.poll() is None:
                process.kill()
            process.wait()

    def status(self, node):
        """What a node says of itself; nothing while it does not answer."""
        done = subprocess.run([TAKT, "ctl", str(self.sockets[node]), "status", "--format", "json"], capture_output=True, text=True, timeout=PATIENCE, check=False)
        return json.loads(done.stdout) if done.returncode == 0 else None

    def call(self, node, method):
        return subprocess.run([TAKT, "ctl", str(self.sockets[node]), method.lower()], capture_output=True, text=True, timeout=PATIENCE, check=False)

    def wait(self, what, is_so):
        """Until is_so(status of all nodes)."""
        until = time.monotonic() + PATIENCE
        while True:
            found = {node: self.status(node) for node in self.processes}
            if all(found.values()) and is_so(found):
                return found
            assert time.monotonic() < until, (what, found)
            time.sleep(0.02)

    def wait_for_state(self, state):
        """Until all are in the state and know it of each other: a slave suspends only when it has heard that its master runs."""
        self.wait(state, lambda found: all(is_there(each, state) for each in found.values()))

    def wait_for_cycles(self, count):
        """Until everybody has begun so many more cycles: what is published cyclically has been published in this state."""
        def cycles(status):
            return min(each["statistics"]["late"]["count"] for each in status.get("programs", [status]))
        before = {node: cycles(self.status(node)) for node in self.processes}
        self.wait("cycles", lambda found: all(cycles(found[node]) >= before[node] + count for node in found))

    def go_through(self, calls):
        """Makes the calls, each when all are where the one before leads; the events of each node."""
        self.wait_for_state("Halted")
        for node, _, method, state in calls:
            if state == "Halted":  # before: process data comes while Running
                self.wait("process data", lambda found: found["left"]["statistics"]["taken"] > 50)
            done = self.call(node, method)
            assert done.returncode == 0, (method, done.stdout, done.stderr)
            self.wait_for_state(state)
            self.wait_for_cycles(3)
        return self.end()

    def end(self):
        for process in self.processes.values():
            process.send_signal(signal.SIGTERM)
        return self.events()

    def events(self):
        """Waits for the ends; the events of each node."""
        events = {}
        self.said = {}
        for node, process in self.processes.items():
            process.wait(timeout=PATIENCE)
            out, err = (self.files[node].with_suffix(suffix).read_text(encoding="utf-8") for suffix in (".out", ".err"))
            self.said[node] = err
            assert process.returncode == 0, (node, process.returncode, out, err)
            events[node] = [json.loads(line) for line in out.splitlines()]
        return events


def states(events):
    return {node: ["Halted"] + [e["to"] for e in log if e["event"] == "transition"] for node, log in events.items()}


def is_there(status, state):
    return all(each["state"] == state and all(peer["state"] == state for peer in each["peers"]) for each in status.get("programs", [status]))


def loopback(node):
    port = {name: PORTS + i for i, name in enumerate(NODES)}
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


class Loopback(NodeTest):
    def test_the_same_transitions_as_simulated(self):
        self.expect_as_simulated(Group(self, self.folder, loopback).go_through(CALLS))

    def test_all_to_all(self):
        program = PROGRAM | {"subscription": "all-to-all", "publish": "on-change"}
        events = Group(self, self.folder, loopback, program=program).go_through(CALLS)
        self.assertEqual(states(events), simulated(program, CALLS))

    def test_paper(self):
        program = PROGRAM | {"variant": "paper"}
        self.expect_as_simulated(Group(self, self.folder, loopback, program=program).go_through(CALLS), program)

    def test_values_travel(self):
        more = {"plc": {"sources": [{"data_set": "targets", "kind": "counter", "value": 100, "step": 2}]}, "left": {"log_values_every": "0ns"},
                "right": {"log_values_every": "200ms"}}
        events = Group(self, self.folder, loopback, more=more).go_through(CALLS)
        values = [e["fields"]["x"] for e in events["left"] if e["event"] == "data" and e["data_set"] == "targets"]
        self.assertGreater(len(values), 10)
        self.assertTrue(all(x[0] == x[1] and x[0] >= 100 and x[0] % 2 == 0 for x in values), values)
        self.assertEqual(values, sorted(values))
        logged = [e["time_ns"] for e in events["right"] if e["event"] == "data" and e["data_set"] == "targets"]
        self.assertGreater(len(logged), 0)
        self.assertTrue(all(after - before >= 200_000_000 for before, after in zip(logged, logged[1:])), logged)

    def test_statistics(self):
        group = Group(self, self.folder, loopback)
        group.wait("answers", lambda found: all(peer["answer"]["count"] > 100 for each in found.values() for peer in each["peers"]))
        for log in group.go_through(CALLS).values():
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
        group = Group(self, self.folder, loopback, program=PROGRAM | {"receive_timeout": "5s"})
        group.wait_for_state("Halted")
        self.assertEqual(group.call("plc", "Start").returncode, 0)
        group.wait_for_state("Running")
        group.processes["right"].send_signal(signal.SIGKILL)
        group.processes.pop("right").wait()
        group.wait("Halted", lambda found: all(each["state"] == "Halted" for each in found.values()))
        events = group.end()
        causes = [e["cause"] for e in events["plc"] if e["event"] == "intent" and e["kind"] == "halt"]
        self.assertEqual(causes, ["silent peer"])
        for log in events.values():
            self.assertEqual(log[-1]["state"], "Halted")

    def test_a_signal_ends_it_cleanly(self):
        group = Group(self, self.folder, loopback)
        group.wait("an answer", lambda found: True)
        for log in group.end().values():
            self.assertEqual(log[-1]["event"], "end")

    def test_the_script(self):
        """Calls come in their order, none before its time; how long after it is the machine's matter, so the second one fits any state but Halted."""
        group = Group(self, self.folder, loopback, more={"plc": {"script": [{"at": "100ms", "call": "Start"}, {"at": "600ms", "call": "Halt"}]}})
        group.wait("the halt", lambda found: all(each["state"] == "Halted" and each["intent"]["number"] == 2 for each in found.values()))
        log = group.end()["plc"]
        calls = [(e["method"], e["status"]) for e in log if e["event"] == "call"]
        times = [e["time_ns"] - log[0]["time_ns"] for e in log if e["event"] == "call"]
        self.assertEqual(calls, [("Start", "Good"), ("Halt", "Good")])
        self.assertTrue(times[0] >= 100_000_000 and times[1] >= 600_000_000, times)

    def test_the_duration(self):
        for log in Group(self, self.folder, loopback, more={node: {"duration": "300ms"} for node in NODES}).events().values():
            self.assertEqual(log[-1]["event"], "end")
            self.assertGreaterEqual(log[-1]["time_ns"] - log[0]["time_ns"], 300_000_000)


class Ctl(NodeTest):
    def ctl(self, node, request, *more):
        done = subprocess.run([TAKT, "ctl", node if "/" in node else str(self.folder / f"{node}.sock"), request, *more], capture_output=True, text=True, timeout=PATIENCE, check=False)
        return done.returncode, done.stdout, done.stderr


class Control(Ctl):
    def test_methods_and_status(self):
        group = Group(self, self.folder, loopback)
        group.wait_for_state("Halted")
        self.assertEqual(self.ctl("plc", "suspend")[:2], (1, f"Suspend: Bad_InvalidState; {self.folder / 'plc.sock'} is Halted\n"))
        self.assertEqual(self.ctl("left", "start")[0], 1)  # a slave does not start a robust group
        for caller, request, state in (("plc", "start", "Running"), ("left", "suspend", "Suspended"), ("plc", "resume", "Running"),
                                       ("right", "suspend", "Suspended"), ("right", "reset", "Ready"), ("plc", "start", "Running"), ("right", "halt", "Halted")):
            code, out, err = self.ctl(caller, request)
            self.assertEqual(code, 0, out + err)
            self.assertIn("Good", out)
            group.wait_for_state(state)
        code, out, _ = self.ctl("plc", "status")
        self.assertEqual(code, 0)
        for text in ("plc: Halted, master of cell (robust)", "last intent: halt by right", "peer left: Halted", "late for the cycle", "round trip to right", "by the operating system"):
            self.assertIn(text, out)
        for log in group.end().values():
            self.assertEqual([e["status"] for e in log if e["event"] == "call"].count("Bad_InvalidState"), 1 if log[0]["node"] in ("plc", "left") else 0)
        self.assertEqual(list(self.folder.glob("*.sock")), [])

    def test_nobody_there(self):
        code, out, err = self.ctl("plc", "status")
        self.assertEqual((code, out), (3, ""))
        self.assertIn("plc.sock", err)
        self.assertEqual(self.ctl("plc", "stop")[0], 2)

    def test_a_node_that_has_stopped(self):
        """Whoever asks it gives up, also when its socket has no more room for connections."""
        group = Group(self, self.folder, loopback)
        group.wait("an answer", lambda found: True)
        group.processes["plc"].send_signal(signal.SIGSTOP)
        asking = [subprocess.Popen([TAKT, "ctl", str(self.folder / "plc.sock"), "status"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) for _ in range(12)]
        self.addCleanup(lambda: [each.kill() for each in asking])
        for each in asking:
            self.assertEqual((each.communicate(timeout=PATIENCE)[0], each.returncode), ("", 3))
        group.processes["plc"].send_signal(signal.SIGCONT)
        group.wait("an answer", lambda found: True)

    def test_one_node_a_socket(self):
        group = Group(self, self.folder, loopback)
        group.wait_for_state("Halted")
        self.assertEqual(oct((self.folder / "plc.sock").stat().st_mode)[-3:], "600")
        again = subprocess.run([TAKT, "node", str(self.folder / "plc.json")], capture_output=True, text=True, timeout=1000, check=False)
        self.assertEqual((again.returncode, again.stdout), (3, ""))
        self.assertIn("already", again.stderr)
        # A killed node leaves its socket; the next one takes its place.
        group.processes["plc"].kill()
        group.processes.pop("plc").wait()
        self.assertTrue((self.folder / "plc.sock").exists())
        group.start("plc", self.folder / "plc.json")
        group.wait_for_state("Halted")

    def test_by_name(self):
        environment = os.environ | {"XDG_RUNTIME_DIR": str(self.folder)}
        config = {"node": "plc", "program": PROGRAM, "transport": loopback("plc")} | LIFE
        (self.folder / "n.json").write_text(json.dumps(config), encoding="utf-8")
        process = subprocess.Popen([TAKT, "node", str(self.folder / "n.json")], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        until = time.monotonic() + PATIENCE
        done = None
        while (done is None or done.returncode != 0) and time.monotonic() < until:
            done = subprocess.run([TAKT, "ctl", "plc", "start"], env=environment, capture_output=True, text=True, check=False)
        self.assertEqual(done.stdout, "Start: Good; plc is Halted.INIT\n")


class Mistakes(NodeTest):
    def run_node(self, text):
        path = self.folder / "n.json"
        path.write_text(text, encoding="utf-8")
        done = subprocess.run([TAKT, "node", str(path)], capture_output=True, text=True, timeout=1000, check=False)
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

    made = 0  # the kernel takes its time to take namespaces down

    def setUp(self):
        super().setUp()
        Namespaces.made += 1
        self.tag = f"tk{os.getpid() % 10000}{chr(ord('a') + Namespaces.made % 26)}"
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
        pcap = self.folder / "frames.pcapng"
        captured = capture.Capture(f"{self.tag}v0", pcap)
        self.addCleanup(captured.kill)
        self.assertEqual(captured.problem, "")
        events = Group(self, self.folder, lambda node: transport, self.prefix).go_through(CALLS)
        captured.end()
        self.assertEqual(captured.dropped, 0)
        self.expect_as_simulated(events)
        checks = ["-o", "ip.check_checksum:TRUE", "-o", "udp.check_checksum:TRUE"]
        shown = subprocess.run(["tshark", "-r", str(pcap), *checks, "-Y", "udp.port == 4840 || eth.type == 0xb62c || vlan.etype == 0xb62c", "-T", "fields",
                                *[part for field in fields for part in ("-e", field)]], capture_output=True, text=True, check=True)
        bad = subprocess.run(["tshark", "-r", str(pcap), *checks, "-Y", "_ws.malformed || ip.checksum.status == 0 || udp.length.bad"], capture_output=True, text=True, check=False)
        self.assertEqual(bad.stdout, "")
        frames = [line.split("\t") for line in shown.stdout.splitlines()]
        # At least the cycles that the group waited for, of three nodes in each of four states.
        self.assertGreater(len(frames), 3 * 3 * 4)
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
        # Octet for octet what the simulator sends: no other messages, and all those of states in which a node has to stay until others have heard of it.
        there = simulated(PROGRAM | {"vlan": 5, "pcp": 6}, CALLS, see=lambda out: kinds_of_frames(out / "all.pcapng"))
        here = kinds_of_frames(self.folder / "frames.pcapng")
        self.assertEqual(here - there, set())
        self.assertEqual({kind for kind in there - here if not is_passing(kind)}, set())
        self.assertGreater(len(there), 20)

    def test_launch_times(self):
        transport = {"kind": "ethernet", "interface": "eth0"}
        more = {node: {"launch_lead": "1ms"} for node in NODES}
        group = Group(self, self.folder, lambda node: transport, self.prefix, more=more)
        self.expect_as_simulated(group.go_through(CALLS))
        self.assertIn("without launch times", group.said["plc"])
        for node in NODES:
            done = subprocess.run(["tc", "-n", f"{self.tag}{node}", "qdisc", "replace", "dev", "eth0", "root", "fq"], capture_output=True, text=True, check=False)
            if done.returncode != 0:
                print(f"\nskipped: no qdisc fq here: {done.stderr.strip()}", file=sys.stderr)
                self.skipTest(done.stderr)
        group = Group(self, self.folder, lambda node: transport, self.prefix, more=more)
        self.expect_as_simulated(group.go_through(CALLS))
        self.assertNotIn("without launch times", group.said["plc"])


if __name__ == "__main__":
    TAKT = sys.argv.pop(1)
    unittest.main(verbosity=2)
