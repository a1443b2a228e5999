#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Real nodes whose messages are secured, and a stranger who hears all of them but has no key: he moves nobody, keys change under way, and a killed node is heard again.

What the nodes send is opened here by an implementation of its own: hmac of Python, and AES by the openssl command.

usage: secured_node_test.py TAKT [unittest options]
"""
import hashlib
import hmac
import json
import os
import pathlib
import random
import shutil
import socket
import struct
import subprocess
import sys
import threading
import time
import unittest

sys.dont_write_bytecode = True
import real_node_test  # noqa: E402
from attack_test import Attack  # noqa: E402
from real_node_test import NODES, PATIENCE, PORTS  # noqa: E402

SECRET = bytes(range(32))
LIFETIME = 2
HEADER, NONCE_AT, PAYLOAD_AT, SIGNATURE = 15, 21, 29, 32


def key_of(token):
    """The key of 52 octets, by docs/security.md."""
    part, whole = b"", b""
    for i in (1, 2, 3):
        part = hmac.new(SECRET, part + b"takt SecurityGroup" + b"cell" + struct.pack("<I", token) + bytes([0, i]), hashlib.sha256).digest()
        whole += part
    return whole[:52]


def opened(message):
    """Headers and clear payload; None if the signature is wrong."""
    token = struct.unpack_from("<I", message, HEADER + 1)[0]
    key = key_of(token)
    if hmac.new(key[:32], message[:-SIGNATURE], hashlib.sha256).digest() != message[-SIGNATURE:]:
        return None
    block = key[48:52] + message[NONCE_AT:PAYLOAD_AT] + bytes([0, 0, 0, 1])
    done = subprocess.run(["openssl", "enc", "-d", "-aes-128-ctr", "-K", key[32:48].hex(), "-iv", block.hex()], input=message[PAYLOAD_AT:-SIGNATURE], capture_output=True, check=True)
    return message[:HEADER] + done.stdout


class Secured(real_node_test.NodeTest, Attack):
    PROGRAM = {"name": "cell", "master": "plc", "slaves": ["left", "right"], "cycle": "10ms", "receive_timeout": "3s", "initialisation": "20ms",
               "process_data": [{"name": "targets", "from": "plc", "fields": {"x": "Double"}}]}

    def setUp(self):
        super().setUp()
        self.heard = []
        self.stranger = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(self.stranger.close)
        self.stranger.bind(("127.0.0.1", PORTS + 9))
        self.stranger.settimeout(0.1)
        self.is_done = False
        listener = threading.Thread(target=self.listen)
        listener.start()
        self.addCleanup(listener.join)
        self.addCleanup(self.stop_listening)

    def stop_listening(self):
        self.is_done = True

    def listen(self):
        while not self.is_done:
            try:
                self.heard.append(self.stranger.recv(2000))
            except OSError:
                pass

    @staticmethod
    def transport(node):
        plain = real_node_test.loopback(node)
        return plain | {"destinations": plain["destinations"] + [f"127.0.0.1:{PORTS + 9}"]}

    def start(self):
        keys = self.folder / "cell.keys"
        with open(os.open(keys, os.O_WRONLY | os.O_CREAT, 0o600), "w", encoding="utf-8") as file:
            json.dump({"group": "cell", "secret": SECRET.hex()}, file)
        more = {node: {"security": {"key_lifetime": f"{LIFETIME}s", "keys": "cell.keys", "memory": str(self.folder / f"{node}.memory")}} for node in NODES}
        self.group = real_node_test.Group(self, self.folder, self.transport, program=self.PROGRAM, more=more)
        self.group.wait_for_state("Halted")

    def say(self, octets):
        for i in range(len(NODES)):
            self.stranger.sendto(octets, ("127.0.0.1", PORTS + i))

    def attack(self, seconds, chance):
        """Replays, forgeries, and all between."""
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            octets = bytearray(chance.choice(self.heard))
            kind = chance.randrange(5)
            if kind == 1:
                octets[chance.randrange(len(octets))] ^= chance.randrange(1, 256)
            elif kind == 2:
                octets = octets[:chance.randrange(len(octets))]
            elif kind == 3:
                octets = octets[:1] + bytes([octets[1] & ~0x10]) + octets[2:HEADER] + octets[PAYLOAD_AT:-SIGNATURE]
            elif kind == 4:
                octets[chance.randrange(HEADER, PAYLOAD_AT)] = chance.randrange(256)
            self.say(bytes(octets))
            time.sleep(0.0005)

    def test_a_stranger_moves_nobody_while_keys_change(self):
        self.start()
        chance = random.Random(2026)
        tokens = {status["security"]["token"] for status in map(self.group.status, NODES)}
        self.attack(1, chance)
        self.assertEqual(self.group.call("plc", "start").returncode, 0)
        self.group.wait_for_state("Running")
        self.attack(3.2 * LIFETIME, chance)
        found = {node: self.group.status(node) for node in NODES}
        for node, status in found.items():
            self.assertEqual(status["state"], "Running", node)
            self.assertEqual((status["statistics"]["foreign"], status["security"]["unsealed"]), (0, 0), node)
            self.assertTrue({"replayed", "signature", "unsecured", "token"} <= set(self.refusals(status)), (node, self.refusals(status)))
            self.assertGreaterEqual(status["security"]["token"] - max(tokens), 3, node)
        self.assertEqual(self.group.call("left", "suspend").returncode, 0)
        self.group.wait_for_state("Suspended")
        events = self.group.end()
        for node, log in events.items():
            self.assertEqual([event["to"] for event in log if event["event"] == "transition"][-2:], ["Running", "Suspended"], node)
            causes = {event["cause"] for event in log if event["event"] == "intent"}
            self.assertTrue(causes <= {"command"}, (node, causes))
            for event in log:
                self.assertNotIn(SECRET.hex()[:16], json.dumps(event))

    def test_what_is_sent_is_what_the_standard_says(self):
        if shutil.which("openssl") is None:
            self.skipTest("no openssl command")
        self.start()
        self.assertEqual(self.group.call("plc", "start").returncode, 0)
        self.group.wait_for_state("Running")
        self.group.wait("process data", lambda found: found["left"]["statistics"]["taken"] > 100)
        seen, nonces = set(), []
        for message in list(self.heard):
            nonces.append((message[HEADER + 1:HEADER + 5], message[NONCE_AT:PAYLOAD_AT]))
        self.assertEqual(len(set(nonces)), len(nonces))
        for message in self.heard[::max(1, len(self.heard) // 100)]:
            clear = opened(message)
            self.assertIsNotNone(clear)
            seen.add((len(message), message[HEADER], clear[HEADER]))
        self.assertTrue({(42 + 46, 3, 0x1B), (32 + 46, 3, 0x1B)} >= seen and seen, seen)

    def test_a_killed_node_is_heard_again_and_hears_nothing_old(self):
        self.start()
        self.assertEqual(self.group.call("plc", "start").returncode, 0)
        self.group.wait_for_state("Running")
        life = self.group.status("left")["security"]["life"]
        self.group.processes["left"].kill()
        self.group.processes.pop("left").wait()
        old = list(self.heard)
        self.group.start("left", self.group.files["left"])
        self.group.wait("back", lambda found: "left" in found)
        for message in old[-400:]:
            self.stranger.sendto(message, ("127.0.0.1", PORTS + 1))
            time.sleep(0.0002)
        self.group.wait_for_state("Halted")
        status = self.group.status("left")
        self.assertIn((status["security"]["life"] - life) % 65536, range(1, 32768), "later lives follow the time of day")
        self.assertGreater(self.refusals(status).get("replayed", 0) + self.refusals(status).get("token", 0), 0)
        self.assertEqual(self.group.call("plc", "start").returncode, 0)
        self.group.wait_for_state("Running")

    def test_a_file_of_keys_that_others_may_read(self):
        self.start()
        (self.folder / "cell.keys").chmod(0o640)
        done = subprocess.run([real_node_test.TAKT, "node", "--check", str(self.folder / "plc.json")], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("others than its owner may read", done.stderr)
        self.assertNotIn(SECRET.hex()[:16], done.stderr)


if __name__ == "__main__":
    real_node_test.TAKT = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main(verbosity=2)
