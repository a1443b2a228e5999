#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Scenarios on real nodes in network namespaces take the transitions that they take in the simulator. Needs root.

However slow the machine is: a script waits for its nodes. Time-outs are so long that only a node that is gone is silent for so long.
A machine that lets a node starve for seconds makes another history all the same, so that a run that differs is tried twice more, and shown.

usage: emulation_test.py TAKT SOURCE_FOLDER [TEST...]
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

TAKT = sys.argv[1]
SOURCES = pathlib.Path(sys.argv[2])
PATIENT = ["--set", "programs.0.receive_timeout=1000s"]

SMALL = {
    "name": "small", "duration": "1500ms",
    "network": {"nodes": {"plc": {"kind": "host"}, "left": {"kind": "host"}, "right": {"kind": "host"}, "a": {"kind": "switch"}, "b": {"kind": "switch"}},
                "links": [{"ends": ["plc", "a"]}, {"ends": ["left", "a"]}, {"ends": ["a", "b"]}, {"ends": ["right", "b"]}]},
    "programs": [{"name": "cell", "master": "plc", "slaves": ["left", "right"], "cycle": "5ms", "receive_timeout": "1000s", "initialisation": "10ms"}],
    "script": [{"at": "100.3ms", "program": "cell", "call": "Start"}, {"at": "500.3ms", "program": "cell", "call": "Suspend", "on": "left"},
               {"at": "700.3ms", "program": "cell", "call": "Resume"}, {"at": "1000.3ms", "program": "cell", "call": "Halt", "on": "right"}]}


def namespaces():
    done = subprocess.run(["ip", "netns", "list"], capture_output=True, text=True, check=False)
    return {line.split()[0] for line in done.stdout.splitlines() if line.startswith("takt-")}


def orphans():
    """Those whose emulation is no more. Another one may be at work here."""
    return {name for name in namespaces() if not pathlib.Path("/proc", name.split("-")[1]).exists()}


def why_not():
    """Why the kernel does not permit namespaces here; None if it does."""
    try:
        probe = f"probe-takt-{os.getpid()}"
        done = subprocess.run(["ip", "netns", "add", probe], capture_output=True, text=True, check=False)
    except OSError as error:
        return str(error)
    subprocess.run(["ip", "netns", "del", probe], capture_output=True, check=False)
    return done.stderr.strip() if done.returncode != 0 else None


class Emulation(unittest.TestCase):
    def setUp(self):
        reason = why_not()
        if reason:
            print(f"\nskipped: network namespaces are not permitted here: {reason}", file=sys.stderr)
            self.skipTest(reason)
        folder = tempfile.TemporaryDirectory(prefix="takt-emulation-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.before = orphans()

    def tearDown(self):
        self.assertLessEqual(orphans(), self.before, "namespaces are left")

    def file(self, **changes):
        path = self.folder / "s.json"
        path.write_text(json.dumps(SMALL | changes), encoding="utf-8")
        return str(path)

    def emulate(self, *arguments, status=0, patience=100):
        for left in (2, 1, 0):
            done = subprocess.run([TAKT, "emulate", *arguments, "--patience", str(patience), "--format", "json"], capture_output=True, text=True, timeout=1000, check=False)
            if done.returncode != 1 or status == 1 or left == 0:
                break
            print(f"\ndiffers, tried again: {done.stdout}{done.stderr}", file=sys.stderr)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return json.loads(done.stdout)

    def test_three_slaves_around_a_switch(self):
        result = self.emulate(str(SOURCES / "scenarios" / "three-slaves-star.json"), *PATIENT)
        self.assertTrue(result["same"])
        program = result["programs"][0]
        self.assertEqual(program["orders"], 33)
        self.assertEqual(program["violated"], [])
        for participant in program["participants"]:  # the halt by the gripper has reached all
            self.assertEqual(participant["emulated"], ["Halted.INIT", "Ready", "Running", "Suspended", "Running", "Halted", "Halted.INIT", "Ready", "Running"])
        self.assertEqual([node["status"]["statistics"]["foreign"] for node in result["nodes"]], [0] * 4)

    # Seven nodes, two of them in two Programs: all in the order of the simulated run, and S1 to S5 of the tree by the nodes' own logs.
    def test_three_levels_of_nested_programs(self):
        patient = [word for i in range(3) for setting in (f"receive_timeout={3000 - i}s", f"cycle={[4, 3, 2][i]}ms") for word in ("--set", f"programs.{i}.{setting}")]
        result = self.emulate(str(SOURCES / "scenarios" / "programs" / "nested-cell.json"), *patient)
        self.assertEqual([(program["program"], program["same"], program["violated"]) for program in result["programs"]], [(name, True, []) for name in ("cell", "machine", "axis")])
        states = ["Halted.INIT", "Ready", "Running", "Suspended", "Running", "Suspended", "Ready", "Running", "Halted", "Halted.INIT", "Ready", "Running"]
        for program in result["programs"]:
            for participant in program["participants"]:
                self.assertEqual(participant["emulated"], states, participant["name"])
        self.assertEqual(result["invariants"]["violated"], [])
        self.assertGreater(result["invariants"]["steps"], 9 * len(states))
        programs = {node["name"]: [each["program"] for each in node["status"].get("programs", [node["status"]])] for node in result["nodes"]}
        self.assertEqual(programs, {"plc": ["cell"], "machine1": ["cell", "machine"], "machine2": ["cell"], "axis1": ["machine", "axis"], "axis2": ["machine"], "drive1": ["axis"], "drive2": ["axis"]})

    def test_two_switches_and_either_variant(self):
        for variant in ("robust", "paper"):
            program = SMALL["programs"][0] | {"variant": variant}
            self.assertTrue(self.emulate(self.file(programs=[program]))["same"], variant)

    # A crash is a SIGKILL: the others halt within the time-out, here as there.
    def test_a_killed_node_halts_the_others(self):
        program = SMALL["programs"][0] | {"receive_timeout": "3s"}
        keep = self.folder / "kept"
        result = self.emulate(self.file(duration="4s", programs=[program], script=SMALL["script"][:1], faults=[{"kind": "crash", "node": "right", "at": "600ms"}]), "--keep", str(keep))
        self.assertTrue(result["same"])
        states = {each["name"]: each["emulated"] for each in result["programs"][0]["participants"]}
        self.assertEqual(states["plc"][-2:], ["Running", "Halted"])
        self.assertEqual(states["left"][-2:], ["Running", "Halted"])
        logs = {name: [json.loads(line) for line in (keep / f"p0-{i}.jsonl").read_text(encoding="utf-8").splitlines()] for i, name in enumerate(("plc", "left"))}
        causes = [event["cause"] for event in logs["plc"] if event["event"] == "intent" and event["kind"] == "halt"]
        self.assertEqual(causes, ["silent peer"])
        self.assertIsNone(result["nodes"][2]["status"])

    def test_a_host_that_comes_back_is_another(self):
        program = SMALL["programs"][0] | {"receive_timeout": "3s"}
        script = SMALL["script"][:1] + [{"at": "4500.3ms", "program": "cell", "call": "Start"}]
        result = self.emulate(self.file(duration="5s", programs=[program], script=script, faults=[{"kind": "crash", "node": "right", "at": "600ms", "for": "3500ms"}]))
        self.assertTrue(result["same"], json.dumps(result["programs"]))

    def test_a_pulled_cable_halts_all(self):
        program = SMALL["programs"][0] | {"receive_timeout": "3s"}
        result = self.emulate(self.file(duration="4s", programs=[program], script=SMALL["script"][:1], faults=[{"kind": "link-down", "link": ["b", "right"], "at": "600ms", "for": "3s"}]))
        self.assertTrue(result["same"], json.dumps(result["programs"]))
        for participant in result["programs"][0]["participants"]:
            self.assertEqual(participant["emulated"][-2:], ["Running", "Halted"])
    # A killed node is replaced by the spare, comes back as one, and gets the role of one that leaves: all in the order of the simulated run.
    def test_roles(self):
        keep = self.folder / "kept"
        host = {"kind": "host", "offers": ["welding"]}
        nodes = {"plc": {"kind": "host"}, "robotA": host, "robotB": host, "robotC": host, "sw": {"kind": "switch"}}
        network = {"nodes": nodes, "links": [{"ends": [name, "sw"]} for name in nodes if name != "sw"]}
        program = {"name": "cell", "master": "plc", "roles": [{"name": "left", "skill": "welding"}, {"name": "right", "skill": "welding"}], "absent": ["robotC"], "cycle": "5ms",
                   "receive_timeout": "1s", "announce_every": "300ms", "on_replacement": "restart", "initialisation": "10ms"}
        script = [{"at": "100.3ms", "program": "cell", "call": "Start"}, {"at": "300ms", "join": "robotC"}, {"at": "4.5s", "leave": "robotB"},
                  {"at": "5.3s", "program": "cell", "call": "Suspend", "on": "right"}]
        path = self.file(duration="5800ms", network=network, programs=[program], script=script, faults=[{"kind": "crash", "node": "robotA", "at": "1.2s", "for": "2s"}])
        result = self.emulate(path, "--keep", str(keep))
        self.assertEqual(result["invariants"]["violated"], [])
        self.assertTrue(result["same"], json.dumps(result["programs"]) + json.dumps(result["notes"]))
        roles = {role["name"]: role["emulated"] for role in result["programs"][0]["roles"]}
        self.assertEqual(roles, {"left": ["robotA", "robotC"], "right": ["robotB", "robotA"]})
        states = {each["name"]: each["emulated"] for each in result["programs"][0]["participants"]}
        run = ["Halted.INIT", "Ready", "Running"]
        self.assertEqual(states["plc"], run + ["Halted"] + run + ["Halted"] + run + ["Suspended"])
        self.assertEqual(states["right"], run + ["Halted"] + run + ["Halted"] + run + ["Suspended"])
        log = [json.loads(line) for line in (keep / "p0-c0.jsonl").read_text(encoding="utf-8").splitlines()]
        self.assertEqual([event.get("role") for event in log if event["event"] == "role taken"], ["left", "right"])
        self.assertEqual(len([event for event in log if event["event"] == "start"]), 2)

    # A mill in a line, whose tools come and go: both groups in the order of the simulated run.
    def test_roles_in_a_nested_group(self):
        slower = ["programs.0.receive_timeout=1000s", "programs.1.receive_timeout=1s", "programs.1.announce_every=300ms", "faults.0.at=2s", "faults.0.for=1800ms"]
        slower += [f"script.{i}.at={at}" for i, at in enumerate(("500ms", "1s", "5s", "5500ms", "6s", "6500ms", "8s", "8500ms", "10s", "10500ms", "12s"))]
        result = self.emulate(str(SOURCES / "scenarios" / "programs" / "nested-roles.json"), *(word for each in slower for word in ("--set", each)), "--duration", "13s")
        self.assertEqual(result["invariants"]["violated"], [])
        self.assertTrue(result["same"], json.dumps(result["programs"]) + json.dumps(result["notes"]))
        roles = {role["name"]: role["emulated"] for role in result["programs"][1]["roles"]}
        self.assertEqual(roles, {"cutter": ["cutterA", "cutterB", "cutterA", "", "cutterB"], "coolant": ["cooler"]})

    def test_applications_and_a_gateway_beside_a_program(self):
        nodes = {"plc": {"kind": "host"}, "left": {"kind": "host"}, "right": {"kind": "host"}, "a": {"kind": "switch"}, "b": {"kind": "switch"}}
        fields = {"x": "Int32", "v": {"type": "Double", "count": 4}}
        applications = [{"name": "speaks", "on": "left", "threads": [{"name": "say", "publish": "report", "every": "10ms"}]},
                        {"name": "hears", "on": "right", "threads": [{"name": "take", "subscribe": "report", "every": "10ms"}]}]
        script = SMALL["script"][:1]
        path = self.file(network=SMALL["network"] | {"nodes": nodes}, topics=[{"name": "report", "protocol": "opc-ua", "fields": fields}], applications=applications, script=script)
        result = self.emulate(path, *PATIENT)
        self.assertTrue(result["same"], json.dumps(result))
        threads = {thread["name"]: thread for application in result["applications"] for thread in application["threads"]}
        self.assertEqual(threads["say"]["simulated"]["activations"], 151)  # at 0, 10, ... 1500 ms
        self.assertGreater(threads["take"]["emulated"]["received"], 0)
        self.assertLessEqual(threads["take"]["emulated"]["received"], threads["say"]["emulated"]["published"])
        # Killed in the middle: the other one goes on, and of what was killed nothing is said.
        result = self.emulate(self.file(topics=[{"name": "report", "protocol": "opc-ua", "fields": fields}], applications=applications, programs=[], script=[],
                                        faults=[{"kind": "crash", "node": "left", "at": "600ms"}]))
        self.assertEqual([(each["application"], each["whole"], each["same"]) for each in result["applications"]], [("speaks", False, True), ("hears", True, True)])

    # Two hosts in namespaces: responses are waited for and drawn as in the simulated run, and a digital output follows what is published, one half period after the other.
    def test_responses_and_a_digital_output(self):
        applications = [{"name": "speaks", "on": "left", "threads": [{"name": "say", "publish": "level", "every": "20ms", "payload": "alternate", "response": "1ms"}]},
                        {"name": "hears", "on": "right", "threads": [{"name": "take", "subscribe": "level", "every": "20ms", "offset": "5ms", "response": {"uniform": {"from": "3ms", "to": "6ms"}}, "signal": "valve"}]},
                        {"name": "sleeps", "on": "right", "threads": [{"name": "late", "subscribe": "level", "every": "20ms", "response": {"table": [{"value": "2ms", "weight": 1}, {"value": "20ms", "weight": 1}]}}]}]
        path = self.file(duration="3s", topics=[{"name": "level", "protocol": "opc-ua", "fields": {"x": "Int32"}}], applications=applications, programs=[], script=[])
        result = self.emulate(path)
        self.assertTrue(result["same"], json.dumps(result))
        self.assertFalse([note for note in result["notes"] if "response" in note or "digital" in note], result["notes"])
        threads = {thread["name"]: thread for application in result["applications"] for thread in application["threads"]}
        self.assertEqual(threads["say"]["simulated"]["response"]["mean_ns"], 1_000_000)
        self.assertGreaterEqual(threads["say"]["emulated"]["response"]["min_ns"], 1_000_000)
        self.assertGreaterEqual(threads["take"]["emulated"]["response"]["min_ns"], 3_000_000)
        self.assertGreater(threads["take"]["emulated"]["signal"]["edges"], 10)
        self.assertGreaterEqual(threads["take"]["emulated"]["signal"]["latency"]["min_ns"], 3_000_000)
        self.assertGreater(threads["take"]["simulated"]["signal"]["edges"], 140)   # of 150 samples
        self.assertNotIn("signal", threads["say"]["emulated"])
        # Half of the activations draw an interval, and are missed in both worlds; 40 is more than six standard deviations, and a machine that is busy misses more.
        self.assertGreater(threads["late"]["simulated"]["missed"], 35)
        self.assertGreater(threads["late"]["emulated"]["missed"], 35)

    def test_a_gateway_between_dds_and_opc_ua(self):
        done = subprocess.run([TAKT, "emulate", str(SOURCES / "scenarios" / "applications" / "gateway.json"), "--format", "json"], capture_output=True, text=True, timeout=1000, check=False)
        if "DDS is not in this build" in done.stderr:
            self.skipTest("DDS is not in this build")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        result = json.loads(done.stdout)
        bridge = next(each for each in result["applications"] if each["application"] == "bridge")
        self.assertEqual([thread["name"] for thread in bridge["threads"]], ["receive", "send"])
        self.assertGreater(bridge["threads"][1]["emulated"]["published"], 0)

    def test_the_shipped_cell_with_roles(self):
        # Who is gone is gone for longer than the patience, so that there is one way only for it to go.
        slower = ["programs.0.announce_every=300ms", "programs.1.receive_timeout=1s", "faults.0.for=2s", "script.3.at=3.5s", "script.4.at=4s", "script.5.at=4.6s", "script.6.at=4.8s"]
        result = self.emulate(str(SOURCES / "scenarios" / "programs" / "plug-and-produce.json"), *PATIENT, *(word for each in slower for word in ("--set", each)), "--duration", "5s")
        self.assertEqual(result["invariants"]["violated"], [])
        self.assertTrue(result["same"], json.dumps(result["programs"]) + json.dumps(result["notes"]))
        roles = {role["name"]: role["emulated"] for role in result["programs"][0]["roles"]}
        self.assertEqual(roles, {"left": ["robotA", "robotC", "robotA"], "right": ["robotB"], "hand": ["gripper1", "", "robotC"]})

    def test_a_difference_is_seen(self):
        # Frames that chance loses are not emulated: they halt the group in the simulator alone.
        program = SMALL["programs"][0] | {"receive_timeout": "3s"}
        faults = [{"kind": "frame-errors", "link": ["b", "right"], "loss": 1, "at": "300ms"}]
        result = self.emulate(self.file(duration="4s", programs=[program], script=SMALL["script"][:1], faults=faults), status=1, patience=1)
        self.assertFalse(result["same"])
        self.assertTrue([note for note in result["notes"] if "not waited for any more" in note], result["notes"])

    def wait_for_running(self, pid):
        socket = pathlib.Path(tempfile.gettempdir()) / f"takt-emulate-{pid}" / "p0-0.sock"
        until = time.monotonic() + 100
        while time.monotonic() < until:
            done = subprocess.run([TAKT, "ctl", str(socket), "status", "--format", "json"], capture_output=True, text=True, check=False)
            if done.returncode == 0 and json.loads(done.stdout)["state"] == "Running":
                return
            time.sleep(0.05)
        self.fail("it does not run")

    def test_signals_and_kills_leave_nothing(self):
        for number, status in ((signal.SIGINT, 130), (signal.SIGTERM, 130)):
            process = subprocess.Popen([TAKT, "emulate", self.file(duration="1000s")], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            self.wait_for_running(process.pid)
            process.send_signal(number)
            out, err = process.communicate(timeout=1000)
            self.assertEqual(process.returncode, status, out + err)
            self.assertFalse([name for name in namespaces() if name.startswith(f"takt-{process.pid}-")])
        process = subprocess.Popen([TAKT, "emulate", self.file(duration="1000s")], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.wait_for_running(process.pid)
        left = {name for name in namespaces() if name.startswith(f"takt-{process.pid}-")}
        self.assertTrue(left)
        process.kill()
        process.wait()
        self.assertTrue(self.emulate(self.file())["same"])  # who is killed cleans up nothing, the next start does
        self.assertFalse(left & namespaces())
        self.assertFalse((pathlib.Path(tempfile.gettempdir()) / f"takt-emulate-{process.pid}").exists())


class Refusals(unittest.TestCase):
    def emulate(self, path, prefix=()):
        done = subprocess.run([*prefix, TAKT, "emulate", path], capture_output=True, text=True, timeout=1000, check=False)
        return done.returncode, done.stdout, done.stderr

    def test_nothing_to_run(self):
        with tempfile.TemporaryDirectory(prefix="takt-emulation-") as folder:
            path = pathlib.Path(folder) / "s.json"
            path.write_text(json.dumps({key: value for key, value in SMALL.items() if key not in ("programs", "script")}), encoding="utf-8")
            status, out, err = self.emulate(str(path))
        self.assertEqual((status, out), (2, ""))
        self.assertIn("neither a Program nor an application", err)

    def test_root_is_asked_for(self):
        prefix = ["setpriv", "--reuid=65534", "--clear-groups"] if os.geteuid() == 0 else []
        status, out, err = self.emulate(str(SOURCES / "scenarios" / "three-slaves-star.json"), prefix)
        if "Permission denied" in err or "Errno 13" in err:
            self.skipTest("another user cannot reach the program")
        self.assertEqual((status, out), (3, ""), err)
        self.assertIn("root", err)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
