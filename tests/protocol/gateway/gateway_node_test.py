#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""`takt node` as a gateway between a `takt node` of OPC UA and stock Cyclone DDS programs, in processes, over real sockets; what is on
the interface is dissected by tshark.

usage: gateway_node_test.py TAKT STOCK_FOLDER [unittest options]
"""
import json
import os
import pathlib
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent.parent / "support"))
import capture  # noqa: E402
import reservation  # noqa: E402

TAKT = ""
STOCK = pathlib.Path()
FIELDS = {"counter": "UInt32", "speed": "Double", "axes": {"type": "Int16", "count": 3}, "on": "Boolean"}
DOMAIN = reservation.domain()
PORT = reservation.ports()
GROUP = "239.192.7.1"
ENVIRONMENT = os.environ | {"CYCLONEDDS_URI": "<General><Interfaces><NetworkInterface name=\"lo\"/></Interfaces></General>"}
COUNT = 40


def node_file(folder, node, duration):
    """The same file for all nodes but for its first key, as one would do it."""
    qos = {"reliability": "reliable", "history": "keep-all", "durability": "transient-local"}  # who matches late loses nothing
    content = {
        "node": node,
        "topics": [{"name": "plc", "protocol": "opc-ua", "publisher_id": 21, "fields": FIELDS}, {"name": "copy", "protocol": "opc-ua", "publisher_id": 22, "fields": FIELDS},
                   {"name": "Motion", "protocol": "dds", "type": "Plant::Motion", "domain": DOMAIN, "qos": qos, "fields": FIELDS}],
        "applications": [{"name": "control", "on": "control", "threads": [{"name": "publish", "publish": "plc", "every": "10ms"}]},
                         {"name": "diagnose", "on": "diagnose", "threads": [{"name": "subscribe", "subscribe": "copy", "every": "10ms", "buffer": 1000}]}],
        "gateways": [{"name": "out", "on": "out", "from": "plc", "to": "Motion", "receive_every": "5ms", "send_every": "5ms", "buffer": 1000},
                     {"name": "back", "on": "back", "from": "Motion", "to": "copy", "receive_every": "5ms", "send_every": "5ms", "send_offset": "2ms", "buffer": 1000}],
        "transport": {"kind": "udp", "interface": "lo", "port": PORT, "destinations": [GROUP]},
        "dds": "lo", "duration": duration, "statistics": str(folder / f"{node}.json")}
    path = folder / f"{node}.node.json"
    path.write_text(json.dumps(content))
    return path


class Listener:
    """Hears what is published by OPC UA, beside the nodes."""

    def __init__(self):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.socket.bind(("", PORT))
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(GROUP) + struct.pack("@ii", 0, socket.if_nametoindex("lo")))
        self.socket.settimeout(capture.PATIENCE)

    def wait_for(self, count, publisher_id):
        """Until so many messages of a publisher have been sent."""
        while count > 0:
            count -= publisher_of(self.socket.recv(65536)) == publisher_id


def publisher_of(message):
    """The PublisherId, if it is UADPVersion 1 with PublisherId, GroupHeader and PayloadHeader, and ExtendedFlags1 says UInt16."""
    return int.from_bytes(message[2:4], "little") if message[:2] == b"\xf1\x01" else None


def frames(file, display_filter):
    found = subprocess.run(["tshark", "-r", str(file), "-Y", display_filter, "-T", "fields", "-e", "frame.number", "-e", "udp.payload"], capture_output=True, text=True, check=True)
    return [line.split("\t") for line in found.stdout.splitlines()]


class GatewayNode(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="takt-gateway-"))
        self.processes = []
        self.listener = Listener()
        self.addCleanup(self.listener.socket.close)

    def capture(self, name):
        """Of the loopback interface, where that is permitted."""
        captured = capture.Capture("lo", self.folder / name, "udp")
        self.addCleanup(captured.kill)
        if captured.problem:
            print(f"nothing is dissected: {captured.problem}", file=sys.stderr)
        return captured

    def is_captured(self, captured):
        """Whether the capture ends with all that was sent."""
        if captured.problem:
            return False
        captured.end()
        self.assertEqual(captured.dropped, 0)
        return True

    def tearDown(self):
        for process in self.processes:
            if process.poll() is None:
                process.kill()
            process.communicate()
        shutil.rmtree(self.folder)

    def start(self, *command):
        process = subprocess.Popen([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=ENVIRONMENT)
        self.processes.append(process)
        return process

    def start_node(self, node, duration="1000s"):
        process = self.start(TAKT, "node", node_file(self.folder, node, duration))
        self.assertEqual(json.loads(process.stdout.readline())["event"], "start")
        return process

    def end(self, process):
        process.send_signal(signal.SIGTERM)
        out, err = process.communicate(timeout=capture.PATIENCE)
        self.assertEqual(process.returncode, 0, err)
        return json.loads(out.splitlines()[-1])

    def dissect(self, file, publisher_id):
        self.assertEqual(frames(file, f"udp && (_ws.malformed || _ws.expert.severity == error) && (rtps || udp.port == {PORT})"), [])
        rtps = frames(file, "rtps.sm.id == 0x15")
        self.assertGreater(len(rtps), COUNT)
        protocols = subprocess.run(["tshark", "-G", "protocols"], capture_output=True, text=True, check=True).stdout
        known = [name for name in ("opcua_pubsub", "uadp") if f"\t{name}\n" in protocols]
        if known:
            self.assertGreaterEqual(len(frames(file, known[0])), COUNT)
            return
        print("this tshark knows no UADP: its header is looked at here", file=sys.stderr)
        uadp = [bytes.fromhex(payload) for _, payload in frames(file, f"udp.dstport == {PORT}")]
        self.assertGreaterEqual(len([message for message in uadp if publisher_of(message) == publisher_id]), COUNT)

    def test_a_stock_subscriber_receives_what_a_plc_publishes(self):
        captured = self.capture("out.pcapng")
        gateway = self.start_node("out")
        stock = self.start(STOCK / "stock_subscriber", "Motion", DOMAIN, COUNT)
        control = self.start_node("control")
        lines = stock.communicate(timeout=capture.PATIENCE)[0].splitlines()
        self.assertEqual(lines[:2], ["ready", "matched"])
        samples = [json.loads(line) for line in lines[2:]]
        first = samples[0]["counter"]
        # Nothing is lost between the first sample and the last, and what was not set is zero.
        self.assertEqual(samples, [{"counter": first + n, "speed": 0, "axes": [0, 0, 0], "on": 0} for n in range(COUNT)])
        self.end(control)
        figures = self.end(gateway)["gateways"][0]["buffer"]
        self.assertGreaterEqual(figures["forwarded"], COUNT)
        self.assertEqual((figures["mapping_errors"], figures["dropped"], figures["stale"], figures["overwritten"]), (0, 0, 0, 0))
        self.assertEqual(json.loads((self.folder / "out.json").read_text())["gateways"][0]["buffer"], figures)
        if self.is_captured(captured):
            self.dissect(captured.file, 21)

    def test_what_a_stock_publisher_writes_reaches_a_subscriber_of_opc_ua(self):
        captured = self.capture("back.pcapng")
        gateway = self.start_node("back")
        diagnose = self.start_node("diagnose")
        stock = self.start(STOCK / "stock_publisher", "Motion", DOMAIN, COUNT, 10)
        self.assertEqual(stock.communicate(timeout=capture.PATIENCE)[0].splitlines(), ["matched"])
        self.listener.wait_for(COUNT, 22)
        figures = self.end(gateway)["gateways"][0]["buffer"]
        self.assertEqual((figures["received"], figures["forwarded"], figures["mapping_errors"]), (COUNT, COUNT, 0))
        taken = self.end(diagnose)["applications"][0]["threads"][0]
        self.assertEqual((taken["taken"], taken["lost"]), (COUNT, 0))
        if not self.is_captured(captured):
            return
        self.dissect(captured.file, 22)
        # The octets of the last sample, by hand: UInt32 40, Double 10.0, Int16[3] {40, -40, 7}, Boolean false.
        messages = [bytes.fromhex(payload) for _, payload in frames(captured.file, f"udp.dstport == {PORT}")]
        values = bytes.fromhex("0728000000" "0b0000000000002440" "84030000002800d8ff0700" "0100")
        self.assertTrue(messages[-1].endswith(values), messages[-1].hex())


if __name__ == "__main__":
    TAKT, STOCK = sys.argv[1], pathlib.Path(sys.argv[2])
    unittest.main(argv=[sys.argv[0]] + sys.argv[3:])
