#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Strangers on the wire of real nodes: what must not reach a Program does not, and a flood costs neither the log nor the loop.

usage: attack_test.py TAKT [unittest options]
"""
import json
import os
import pathlib
import select
import signal
import socket
import struct
import subprocess
import sys
import textwrap
import time
import unittest

sys.dont_write_bytecode = True
import real_node_test  # noqa: E402
from real_node_test import PORTS, PROGRAM  # noqa: E402

ETHER_TYPE = b"\xb6\x2c"
GROUP_ADDRESS = bytes.fromhex("01005e7f0001")
WORD = bytes.fromhex("b10102000f0100" + "00000000" + "0100" + "0700" + "1b0700" + "0000" + "0b000000" + "e9030000" + "00000000" + "02000000" + "00000000" + "0501")


class Attack(unittest.TestCase):
    def ask(self, path):
        done = subprocess.run([real_node_test.TAKT, "ctl", str(path), "status", "--format", "json"], capture_output=True, text=True, timeout=100, check=False)
        return json.loads(done.stdout) if done.returncode == 0 else None

    def wait(self, path, what, done):
        until = time.monotonic() + real_node_test.PATIENCE
        status = None
        while time.monotonic() < until:
            status = self.ask(path)
            if status and done(status):
                return status
            time.sleep(0.05)
        return self.fail(f"not {what}: {status}")

    @staticmethod
    def refusals(status):
        """How many messages of all senders were refused, by verdict."""
        sums = {}
        for source in status["sources"]:
            for each in source["refused"]:
                sums[each["verdict"]] = sums.get(each["verdict"], 0) + each["messages"]
        return sums


class Isolation(real_node_test.Namespaces, Attack):
    """What comes by another VLAN, to another address or to another group is not for a node."""

    def start_plc(self, transport):
        config = {"node": "plc", "program": PROGRAM, "transport": transport, "control": str(self.folder / "plc.sock")} | real_node_test.LIFE
        path = self.folder / "plc.json"
        path.write_text(json.dumps(config), encoding="utf-8")
        group = real_node_test.Group.__new__(real_node_test.Group)
        group.processes, group.files = {}, {}
        self.addCleanup(group.kill)
        group.start("plc", path, ["ip", "netns", "exec", f"{self.tag}plc"])
        self.wait(self.folder / "plc.sock", "there", lambda status: True)
        return group

    def as_stranger(self, script, space="right"):
        subprocess.run(["ip", "netns", "exec", f"{self.tag}{space}", sys.executable, "-c", textwrap.dedent(script)], check=True, timeout=100)

    def say_frames(self, tags):
        frames = [GROUP_ADDRESS + bytes.fromhex("020000000007") + bytes.fromhex(tag) + ETHER_TYPE + WORD for tag in tags]
        self.as_stranger(f"""
            import socket
            s = socket.socket(socket.AF_PACKET, socket.SOCK_RAW)
            s.bind(("eth0", 0))
            for frame in {[frame.hex() for frame in frames]!r}:
                s.send(bytes.fromhex(frame))
        """)

    def test_a_vlan_is_taken_alone(self):
        self.start_plc({"kind": "ethernet", "interface": "eth0", "vlan": 5})
        self.say_frames(["", "8100c000", "8100c007"])
        status = self.wait(self.folder / "plc.sock", "refused", lambda status: self.refusals(status).get("vlan") == 3)
        self.assertEqual((self.refusals(status), status["statistics"]["foreign"]), ({"vlan": 3}, 0))
        self.say_frames(["8100c005"])
        status = self.wait(self.folder / "plc.sock", "heard", lambda status: status["statistics"]["foreign"] == 1)
        self.assertEqual(self.refusals(status), {"vlan": 3, "other_version": 1})
        self.assertEqual({(source["address"], source["publisher_id"]) for source in status["sources"]}, {("02:00:00:00:00:07", None), ("02:00:00:00:00:07", 2)})

    def test_without_a_vlan_none_is_taken(self):
        self.start_plc({"kind": "ethernet", "interface": "eth0"})
        self.say_frames(["8100c005", "8100c007"])
        self.wait(self.folder / "plc.sock", "refused", lambda status: self.refusals(status) == {"vlan": 2})
        self.say_frames(["", "8100c000"])  # a tag that tells a priority only is none
        self.wait(self.folder / "plc.sock", "heard", lambda status: self.refusals(status) == {"vlan": 2, "other_version": 2})

    def test_an_interface_is_taken_alone(self):
        plc, right = f"{self.tag}plc", f"{self.tag}right"
        self.ip("-n", plc, "link", "add", "eth1", "type", "veth", "peer", "name", "eth2")
        self.ip("-n", plc, "link", "set", "eth2", "up")
        self.ip("-n", plc, "addr", "add", "10.78.0.1/24", "dev", "eth1")
        self.ip("-n", plc, "link", "set", "eth1", "up")
        self.ip("-n", right, "route", "add", "10.78.0.0/24", "via", "10.77.0.1")
        self.ip("-n", right, "route", "add", "224.0.0.0/4", "dev", "eth0")
        self.start_plc({"kind": "udp", "interface": "eth0", "destinations": ["224.0.2.14"]})
        say = f"""
            import socket
            s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            for address in %r:
                s.sendto(bytes.fromhex("{WORD.hex()}"), (address, 4840))
        """
        self.as_stranger(say % (["10.78.0.1"] * 3,))
        status = self.wait(self.folder / "plc.sock", "refused", lambda status: self.refusals(status).get("address") == 3)
        self.assertEqual((self.refusals(status), status["statistics"]["foreign"]), ({"address": 3}, 0))
        self.as_stranger(say % (["10.77.0.1", "224.0.2.14"],))
        self.wait(self.folder / "plc.sock", "heard", lambda status: self.refusals(status) == {"address": 3, "other_version": 2})
        self.as_stranger(say % (["10.78.0.1", "10.77.0.1"],), "plc")  # from the machine itself
        self.wait(self.folder / "plc.sock", "heard", lambda status: self.refusals(status) == {"address": 4, "other_version": 3})

    def test_an_interface_that_is_made_anew_is_bound_again(self):
        plc = f"{self.tag}plc"

        def make():
            self.ip("-n", plc, "link", "add", "usb0", "type", "veth", "peer", "name", "cable0")
            for end in ("usb0", "cable0"):
                self.ip("-n", plc, "link", "set", end, "up")

        make()
        self.start_plc({"kind": "ethernet", "interface": "usb0"})
        path = self.folder / "plc.sock"
        self.ip("-n", plc, "link", "del", "usb0")
        self.wait(path, "told of", lambda status: not status["interface"]["there"])
        make()
        self.wait(path, "bound again", lambda status: status["interface"] == {"name": "usb0", "there": True, "bound_again": 1})
        failures = self.ask(path)["statistics"]["send_failures"]
        time.sleep(0.2)
        self.assertEqual(self.ask(path)["statistics"]["send_failures"], failures)  # it sends again

    def test_groups_of_other_processes_are_not_heard(self):
        self.start_plc({"kind": "udp", "destinations": ["224.0.2.14"]} | {"interface": "eth0"})
        self.ip("-n", f"{self.tag}plc", "route", "add", "default", "dev", "eth0")
        other = subprocess.Popen(["ip", "netns", "exec", f"{self.tag}plc", sys.executable, "-c", textwrap.dedent("""
            import socket, struct
            s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            s.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, struct.pack("4s4s", socket.inet_aton("224.0.2.15"), socket.inet_aton("10.77.0.1")))
            print("joined", flush=True)
            s.recv(1)
        """)], stdout=subprocess.PIPE)
        self.addCleanup(other.stdout.close)
        self.addCleanup(other.wait)
        self.addCleanup(other.kill)
        other.stdout.readline()
        self.as_stranger(f"""
            import socket
            s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            s.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("10.77.0.3"))
            for address in ("224.0.2.15", "224.0.2.15", "224.0.2.14"):
                s.sendto(bytes.fromhex("{WORD.hex()}"), (address, 4840))
        """)
        status = self.wait(self.folder / "plc.sock", "heard", lambda status: status["sources"])
        self.assertEqual((self.refusals(status), status["statistics"]["foreign"]), ({"other_version": 1}, 1))


for inherited in [name for name in dir(real_node_test.Namespaces) if name.startswith("test_")]:
    setattr(Isolation, inherited, None)  # they are run where they stand


class Floods(real_node_test.NodeTest, Attack):
    """The master of a group whose slave is a stranger, who says what makes it log."""

    PROGRAM = {"name": "cell", "master": "plc", "slaves": ["left"], "cycle": "5ms", "receive_timeout": "1s"}

    def start_plc(self, stdout):
        self.port = PORTS + 10
        transport = {"kind": "udp", "port": self.port, "destinations": [f"127.0.0.1:{self.port + 1}"]}
        config = {"node": "plc", "program": self.PROGRAM, "transport": transport, "control": str(self.folder / "plc.sock")} | real_node_test.LIFE
        (self.folder / "plc.json").write_text(json.dumps(config), encoding="utf-8")
        self.stranger = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(self.stranger.close)
        self.stranger.bind(("127.0.0.1", self.port + 1))
        self.stranger.settimeout(real_node_test.PATIENCE)
        self.plc = subprocess.Popen([real_node_test.TAKT, "node", str(self.folder / "plc.json")], stdout=stdout, stderr=subprocess.DEVNULL)
        self.addCleanup(self.plc.wait)
        self.addCleanup(self.plc.kill)
        self.heard = self.stranger.recv(1500)

    def flood(self, lines):
        """Words of the slave: each time another life of it has heard of another start."""
        header = self.heard[:2] + struct.pack("<H", 2) + self.heard[4:13]
        for i in range(lines):
            number = struct.pack("<H", i & 0xFFFF)
            fields = struct.pack("<iIIIIBB", 15, 1000 + i, 0, 10 + 3 * i, 7 << 16 | (9 + 3 * i) % 0xFFFF + 1, 0, 0)
            self.stranger.sendto(header + number + b"\x1b" + number + b"\0\0" + fields, ("127.0.0.1", self.port))
            if i % 100 == 0:
                time.sleep(0.002)  # what a socket holds

    def test_a_flood_does_not_fill_the_disk(self):
        with open(self.folder / "log", "wb") as log:
            self.start_plc(log)
        self.flood(100_000)
        status = self.wait(self.folder / "plc.sock", "there", lambda status: status["log_lines_left_out"] > 0)
        self.assertLess((self.folder / "log").stat().st_size, 4 << 20)
        self.plc.send_signal(signal.SIGTERM)
        self.plc.wait(timeout=real_node_test.PATIENCE)
        events = [json.loads(line) for line in (self.folder / "log").read_text(encoding="utf-8").splitlines()]
        self.assertGreaterEqual(sum(event["lines"] for event in events if event["event"] == "left out"), status["log_lines_left_out"])
        self.assertEqual(events[-1]["event"], "end")

    def test_a_pipe_that_nobody_reads_stops_nobody(self):
        read, write = os.pipe()
        self.addCleanup(os.close, read)
        self.start_plc(write)
        os.close(write)
        self.flood(20_000)
        status = self.wait(self.folder / "plc.sock", "at work", lambda status: status["log_lines_left_out"] > 0)
        again = self.wait(self.folder / "plc.sock", "at work", lambda later: later["time_ns"] > status["time_ns"])
        self.assertGreater(again["log_lines_left_out"], 0)
        self.stranger.setblocking(False)
        while select.select([self.stranger], [], [], 0)[0]:
            self.stranger.recv(1500)
        self.stranger.settimeout(real_node_test.PATIENCE)
        self.assertEqual(len(self.stranger.recv(1500)), 42)  # it still publishes
        self.plc.send_signal(signal.SIGTERM)
        self.plc.wait(timeout=real_node_test.PATIENCE)

    def test_a_reader_that_goes_stops_nobody(self):
        read, write = os.pipe()
        self.start_plc(write)
        os.close(write)
        os.close(read)
        self.flood(1000)
        self.wait(self.folder / "plc.sock", "at work", lambda status: status["statistics"]["taken"] > 0)
        self.assertIsNone(self.plc.poll())

    def test_what_is_refused_is_told_once(self):
        with open(self.folder / "log", "wb") as log:
            self.start_plc(log)
        for octets in [b"", b"\x02", WORD, WORD, b"\0" * 1501, WORD[:30], self.heard]:
            self.stranger.sendto(octets, ("127.0.0.1", self.port))
        status = self.wait(self.folder / "plc.sock", "refused", lambda status: sum(self.refusals(status).values()) == 6)
        self.assertEqual(self.refusals(status), {"empty": 1, "not_uadp": 1, "other_version": 3, "too_long": 1})
        told = [json.loads(line) for line in (self.folder / "log").read_text(encoding="utf-8").splitlines() if '"refused"' in line]
        self.assertEqual(sorted((event["publisher_id"] or 0, event["verdict"]) for event in told), [(0, "empty"), (0, "not_uadp"), (0, "too_long"), (2, "other_version")])
        text = subprocess.run([real_node_test.TAKT, "ctl", str(self.folder / "plc.sock"), "status"], capture_output=True, text=True, check=True).stdout
        self.assertIn(f"  refused of 127.0.0.1:{self.port + 1}, publisher 2: 3 other_version\n", text)


if __name__ == "__main__":
    real_node_test.TAKT = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main(verbosity=2)
