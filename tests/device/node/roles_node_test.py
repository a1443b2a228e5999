#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Real nodes in a group with roles: who offers its skills gets a role, a spare takes over from a killed node, and a node leaves. Waits for what must
come, however long it takes.

usage: roles_node_test.py TAKT [unittest options]
"""
import json
import random
import signal
import socket
import sys
import time
import unittest

sys.dont_write_bytecode = True
import real_node_test  # noqa: E402


class Roles(real_node_test.Ctl):
    """plc is the master; three robots weld, two are needed. Only a node that is gone is silent for seconds."""

    NAMES = ("plc", "robotA", "robotB", "robotC")
    PROGRAM = {"name": "cell", "master": "plc", "cycle": "5ms", "receive_timeout": "3s", "initialisation": "20ms", "announce_every": "800ms", "on_replacement": "restart",
               "roles": [{"name": "left", "skill": "welding"}, {"name": "right", "skill": "welding"}], "candidates": ["robotA", "robotB", "robotC"],
               "process_data": [{"name": "seam", "from": "left", "fields": {"x": "Double"}}]}

    def setUp(self):
        super().setUp()
        self.group = real_node_test.Group.__new__(real_node_test.Group)
        self.group.processes, self.group.files = {}, {}
        self.addCleanup(self.group.kill)
        self.logs = {}
        self.also_to = []  # who else hears all nodes

    def start(self, node, more=None):
        port = {name: 48441 + i for i, name in enumerate(self.NAMES)}
        transport = {"kind": "udp", "port": port[node], "destinations": [f"127.0.0.1:{port[other]}" for other in self.NAMES if other != node] + self.also_to}
        config = {"node": node, "program": self.PROGRAM, "transport": transport, "control": str(self.folder / f"{node}.sock"), "realtime": True} | (more or {})
        if node != "plc":
            config = {"offers": ["welding"], "sources": [{"data_set": "seam", "kind": "constant", "value": 7}]} | config
        path = self.folder / f"{node}.json"
        path.write_text(json.dumps(config), encoding="utf-8")
        self.group.start(node, path)

    def status(self, node):
        code, out, _ = self.ctl(node, "status", "--format", "json")
        return json.loads(out) if code == 0 else None

    def wait(self, what, done):
        for _ in range(3000):
            status = self.status("plc")
            if status and done(status):
                return status
            time.sleep(0.02)
        self.fail(f"not {what}: {status}")

    @staticmethod
    def roles_of(status):
        return {role["name"]: role["node"] for role in status["roles"]}

    @staticmethod
    def present(status, node):
        return {each["name"]: each["present"] for each in status["candidates"]}[node]

    def wait_for(self, state, **roles):
        self.wait(f"{state} with {roles}", lambda status: status["state"] == state and self.roles_of(status) == roles and status["complete"])
        for role, node in roles.items():
            for _ in range(3000):
                status = self.status(node)
                if status and (status["bound_to"], status["state"]) == (role, state):
                    break
                time.sleep(0.02)
            self.assertEqual((status["bound_to"], status["state"]), (role, state), node)

    def start_all(self):
        self.start("plc")
        self.wait("there", lambda status: True)
        self.assertEqual(self.ctl("plc", "start")[:2], (1, f"Start: Bad_ResourceUnavailable; {self.folder / 'plc.sock'} is Halted\n"))
        for node in ("robotA", "robotB"):
            self.start(node)
            self.wait(f"{node} there", lambda status, node=node: self.present(status, node))
        self.start("robotC", {"absent": True})
        self.wait_for("Halted", left="robotA", right="robotB")
        self.assertEqual(self.ctl("plc", "start")[0], 0)
        self.wait_for("Running", left="robotA", right="robotB")

    def join_the_spare(self):
        for _ in range(3000):
            if self.status("robotC"):
                break
            time.sleep(0.02)
        self.assertIn("robotC: away from cell (robust)\n", self.ctl("robotC", "status")[1])
        self.assertFalse(self.present(self.status("plc"), "robotC"))
        self.assertEqual(self.ctl("robotC", "join")[:2], (0, f"Join: Good; {self.folder / 'robotC.sock'} is Halted\n"))
        self.wait("robotC there", lambda status: self.present(status, "robotC"))

    def end(self):
        for process in self.group.processes.values():
            process.send_signal(signal.SIGTERM)
        return self.group.events()

    def test_a_spare_takes_over_and_the_old_node_is_the_next_spare(self):
        self.start_all()
        self.join_the_spare()
        text = self.ctl("plc", "status")[1]
        for line in ("plc: Running, master of cell (robust)\n", "  role left (welding): robotA\n", "  role right (welding): robotB\n", "  spare: robotC\n", "  peer left: Running, heard "):
            self.assertIn(line, text)
        self.assertIn("robotB: Running, right of cell (robust)\n", self.ctl("robotB", "status")[1])
        self.assertIn("robotC: spare of cell (robust)\n", self.ctl("robotC", "status")[1])
        self.assertEqual(self.ctl("robotC", "suspend")[0], 1)  # a spare is in no group
        self.group.processes["robotA"].kill()
        self.group.processes.pop("robotA").wait()
        self.wait_for("Running", left="robotC", right="robotB")
        self.start("robotA")
        self.wait("robotA a spare", lambda status: self.present(status, "robotA"))
        self.wait_for("Running", left="robotC", right="robotB")
        self.assertIn("robotA: spare of cell (robust)\n", self.ctl("robotA", "status")[1])
        logs = self.end()
        self.assertEqual([(e["role"], e["to"]) for e in logs["plc"] if e["event"] == "bound"], [("left", "robotA"), ("right", "robotB"), ("left", "robotC")])
        changes = [event for event in logs["robotC"] if event["event"] == "transition"]
        self.assertEqual([event["to"] for event in changes], ["Halted.INIT", "Ready", "Running"])
        self.assertEqual({event["role"] for event in changes}, {"left"})
        self.assertEqual([e["to"] for e in logs["robotB"] if e["event"] == "transition"], ["Halted.INIT", "Ready", "Running", "Halted", "Halted.INIT", "Ready", "Running"])
        causes = {e["cause"] for e in logs["plc"] if e["event"] == "intent" and e["kind"] == "halt"}
        self.assertTrue(causes and causes <= {"silent peer", "peer left"}, causes)  # of its words or of its announcements
        self.assertEqual([event for event in logs["robotA"] if event["event"] == "transition"], [])  # of its second life
        self.assertEqual((logs["robotA"][-1]["bound_to"], logs["robotC"][-1]["bound_to"]), (None, "left"))

    def test_a_node_leaves(self):
        self.start_all()
        self.join_the_spare()
        code, out, err = self.ctl("plc", "leave")
        self.assertEqual((code, out, err), (2, "", "takt: plc is not a candidate for roles\n"))
        self.assertEqual(self.ctl("robotB", "leave")[0], 0)
        self.wait_for("Running", left="robotA", right="robotC")
        self.wait("robotB away", lambda status: not self.present(status, "robotB"))
        self.assertEqual(self.ctl("robotC", "suspend")[0], 0)
        self.wait_for("Suspended", left="robotA", right="robotC")
        self.assertIn("robotB: away from cell (robust)\n", self.ctl("robotB", "status")[1])
        self.assertIn("  away: robotB\n", self.ctl("plc", "status")[1])
        logs = self.end()
        self.assertEqual([(e["event"], e.get("role")) for e in logs["robotB"] if e["event"] in ("leave", "role taken", "role dropped")], [("role taken", "right"), ("leave", None), ("role dropped", "right")])
        self.assertIn(("halt", "peer left"), [(e["kind"], e["cause"]) for e in logs["plc"] if e["event"] == "intent"])

    def settled(self):
        """Waits until all roles are bound to nodes that know it, and all run; who has them."""
        for _ in range(3000):
            status = self.status("plc")
            roles = self.roles_of(status) if status else {}
            if status and status["state"] == "Running" and status["complete"] and None not in roles.values():
                theirs = {role: self.status(node) for role, node in roles.items()}
                if all(each and (each["bound_to"], each["state"]) == (role, "Running") for role, each in theirs.items()):
                    return roles
            time.sleep(0.02)
        self.fail(f"not settled: {status}")

    def test_after_a_flood_of_forged_announcements_roles_settle(self):
        """A stranger hears the announcements and says them again with other octets, for seconds: the group may halt meanwhile. Then all run again without a call, and the next loss is replaced."""
        stranger = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(stranger.close)
        stranger.bind(("127.0.0.1", 0))
        stranger.settimeout(10)
        self.also_to = [f"127.0.0.1:{stranger.getsockname()[1]}"]
        self.start_all()
        self.join_the_spare()
        heard = {}  # the newest of each sender and length
        until = time.monotonic() + 3
        while time.monotonic() < until:
            octets, (_, port) = stranger.recvfrom(2048)
            heard[port, len(octets)] = octets
        lengths = {length for port, length in heard if port == 48444}  # a spare says nothing but announcements
        self.assertEqual(len(lengths), 1)
        announcements = [octets for (_, length), octets in heard.items() if length in lengths]
        self.assertGreaterEqual(len(announcements), 3)
        chance = random.Random(1)
        forged = 0
        until = time.monotonic() + 5
        while time.monotonic() < until:
            for octets in announcements:
                other = bytearray(octets)
                for _ in range(chance.randrange(3)):
                    other[chance.randrange(8, len(other))] = chance.randrange(256)
                for port in range(48441, 48445):
                    stranger.sendto(other, ("127.0.0.1", port))
                forged += 1
            time.sleep(0.0005)
        self.assertGreater(forged, 1000)
        before = self.settled()
        time.sleep(4)  # longer than three announcements and a time-out: nothing that was said in the flood may count any more
        self.assertEqual(self.settled(), before)
        lost = before["left"]
        self.group.processes[lost].kill()
        self.group.processes.pop(lost).wait()
        for _ in range(3000):
            if self.roles_of(self.status("plc") or {"roles": []}).get("left") not in (lost, None):
                break
            time.sleep(0.02)
        after = self.settled()
        self.assertNotIn(lost, after.values())
        bound = [e for e in self.end()["plc"] if e["event"] == "bound"]
        self.assertGreater(len(bound), 5, "the flood was believed: nothing is signed")

    # Nothing left to fill the role: the group halts, a Start is refused until the script of the leaver lets it come back.
    def test_a_role_that_nobody_has(self):
        self.start("plc")
        self.start("robotA", {"script": [{"at": "1s", "plug": "join"}], "absent": True, "sources": []})
        self.wait("half complete", lambda status: self.roles_of(status) == {"left": "robotA", "right": None})
        self.assertIn("  role right (welding): nobody\n", self.ctl("plc", "status")[1])
        self.assertEqual(self.ctl("plc", "start")[:2], (1, f"Start: Bad_ResourceUnavailable; {self.folder / 'plc.sock'} is Halted\n"))
        logs = self.end()
        self.assertEqual([e["event"] for e in logs["robotA"] if e["event"] in ("join", "role taken")], ["join", "role taken"])


if __name__ == "__main__":
    real_node_test.TAKT = sys.argv.pop(1)
    unittest.main(verbosity=2)
