#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Strangers and observers use up the OPC UA server of a real node: what is left for the operator. Over real sockets, without encryption; tests/protocol/opcua has the same
attacks as octets and times. Passwords and certificates are made by openssl.

usage: exhaustion_test.py TAKT [unittest options]
"""
import json
import os
import pathlib
import re
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE.parent.parent.parent / "support"))
import reservation  # noqa: E402

TAKT = ""
PORTS = reservation.ports()
PATIENCE = 300
MOST_MIB = 64
NONE = b"http://opcfoundation.org/UA/SecurityPolicy#None"
BASIC256SHA256 = b"http://opcfoundation.org/UA/SecurityPolicy#Basic256Sha256"
OAEP = b"http://www.w3.org/2001/04/xmlenc#rsa-oaep"
NOTHING = b"\0\0\0"  # an ExtensionObject without a type


def u32(value):
    return struct.pack("<I", value)


def text(value):
    return struct.pack("<i", -1) if value is None else struct.pack("<i", len(value)) + value


def node(number, name_space=0):
    return b"\1" + struct.pack("<BH", name_space, number)


def named(name, name_space=1):
    return b"\3" + struct.pack("<H", name_space) + text(name)


def several(elements):
    return struct.pack("<i", len(elements)) + b"".join(elements)


def extension(number, body):
    return node(number) + b"\1" + text(body)


class Client:
    """Over None: requests and the octets of their answers."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=PATIENCE)
        self.url = b"opc.tcp://127.0.0.1:%d" % port
        self.octets, self.sequence, self.channel, self.token = b"", 0, 0, b"\0\0"

    def say(self, kind, body):
        self.socket.sendall(kind + u32(8 + len(body)) + body)

    def hear(self):
        """The next message: its kind and what is behind its header."""
        while len(self.octets) < 8 or len(self.octets) < struct.unpack_from("<I", self.octets, 4)[0]:
            more = self.socket.recv(1 << 20)
            if not more:
                raise ConnectionError("closed")
            self.octets += more
        size = struct.unpack_from("<I", self.octets, 4)[0]
        kind, body, self.octets = self.octets[:4], self.octets[8:size], self.octets[size:]
        if kind == b"ERRF":
            raise ConnectionError(hex(struct.unpack_from("<I", body)[0]))
        return kind, body

    def numbers(self):
        self.sequence += 1
        return u32(self.sequence) * 2

    def header(self):
        return self.token + struct.pack("<qII", 0, 0, 0) + text(None) + u32(0) + NOTHING

    def open(self):
        self.say(b"HELF", u32(0) + u32(65536) * 2 + u32(0) * 2 + text(self.url))
        self.hear()
        request = node(446) + self.header() + u32(0) * 2 + u32(1) + text(None) + u32(3_600_000)
        self.say(b"OPNF", u32(0) + text(NONE) + text(None) * 2 + self.numbers() + request)
        self.channel = struct.unpack_from("<I", self.hear()[1])[0]
        return self

    def send(self, number, body):
        self.say(b"MSGF", u32(self.channel) + u32(1) + self.numbers() + node(number) + self.header() + body)

    def ask(self, number, body):
        """The result of the service, and what is behind the header of its response."""
        self.send(number, body)
        octets = b""
        while True:
            kind, part = self.hear()
            octets += part[16:]
            if kind[3:] == b"F":
                break
        status = struct.unpack_from("<I", octets, 4 + 12)[0]
        return status, octets[4 + 16 + 1 + 4 + 3:]

    def begin(self, user=None, password=b"", certificate=None):
        """Signs in; the result of the activation."""
        self.token = b"\0\0"
        client = text(b"urn:x") + text(b"p") + b"\0" + u32(1) + text(None) * 2 + several([])
        status, body = self.ask(461, client + text(None) + text(self.url) + text(b"x") + text(None) * 2 + struct.pack("<d", 3_600_000.0) + u32(0))
        if status:
            return status
        session = 3 + 4  # ns=1, a number
        self.token = body[session:session + 3 + 4 + 32]
        nonce = body[session + 39 + 8 + 4:session + 39 + 8 + 4 + 32]
        identity = extension(321, text(b"anonymous"))
        if user:
            clear = u32(len(password) + len(nonce)) + password + nonce
            encrypt = ["openssl", "pkeyutl", "-encrypt", "-certin", "-keyform", "DER", "-inkey", str(certificate), "-pkeyopt", "rsa_padding_mode:oaep"]
            cipher = subprocess.run(encrypt, input=clear, capture_output=True, check=True).stdout
            identity = extension(324, text(b"username_Basic256Sha256") + text(user) + text(cipher) + text(OAEP))
        return self.ask(467, text(None) * 2 + several([]) * 2 + identity + text(None) * 2)[0]

    def subscribe(self, interval=1000.0):
        status, body = self.ask(787, struct.pack("<dII", interval, 10_000_000, 1_000_000) + u32(0) + b"\1\0")
        return status, struct.unpack_from("<I", body)[0] if status == 0 else 0

    def monitor_events(self, subscription, event_filter):
        item = node(2253) + u32(12) + text(None) + struct.pack("<H", 0) + text(None) + u32(2) + u32(1) + struct.pack("<d", 0.0) + event_filter + u32(100_000) + b"\1"
        status, body = self.ask(751, u32(subscription) + u32(3) + several([item]))
        return status or struct.unpack_from("<I", body, 4)[0]

    def close(self):
        self.socket.close()


CLAUSE = node(2041) + several([struct.pack("<H", 0) + text(b"Message")]) + u32(13) + text(None)
LITERAL = extension(597, b"\0")
COMPARING = extension(727, several([CLAUSE]) + several([u32(9) + several([extension(594, u32(1))] + [LITERAL] * 999),
                                                        u32(9) + several([extension(597, b"\x0c" + text(b"x"))] + [LITERAL] * 999)]))


def selecting(clauses):
    return extension(727, several([CLAUSE] * clauses) + several([]))


class Exhaustion(unittest.TestCase):
    number = 0

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="takt-exhaustion-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        users = self.folder / "users.json"
        users.touch(mode=0o600)
        hashed = {name: subprocess.run([TAKT, "node", "--hash-password"], input=name, capture_output=True, text=True, check=True).stdout.strip() for name in ("anna", "olaf")}
        users.write_text(json.dumps({"users": [{"name": name, "password": hashed[name], "role": role} for name, role in (("anna", "operator"), ("olaf", "observer"))]}),
                         encoding="utf-8")

    def start(self, stderr=None):
        port = PORTS + 3
        program = {"name": "cell", "master": "plc", "slaves": ["left"], "cycle": "5ms", "receive_timeout": "1000s"}
        left = {"node": "left", "program": program, "control": str(self.folder / "left.sock"),
                "transport": {"kind": "udp", "port": PORTS + 1, "destinations": [f"127.0.0.1:{PORTS}"]}}
        (self.folder / "left.json").write_text(json.dumps(left), encoding="utf-8")
        slave = subprocess.Popen([TAKT, "node", "left.json"], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(slave.wait)
        self.addCleanup(slave.kill)
        config = {"node": "plc", "program": program, "control": str(self.folder / "plc.sock"),
                  "transport": {"kind": "udp", "port": PORTS, "destinations": [f"127.0.0.1:{PORTS + 1}"]},
                  "server": {"endpoint": f"opc.tcp://127.0.0.1:{port}", "users": "users.json", "anonymous": True, "policies": ["None", "Basic256Sha256"], "halt_without_encryption": True}}
        (self.folder / "plc.json").write_text(json.dumps(config), encoding="utf-8")
        out = open(self.folder / "plc.log", "w", encoding="utf-8")
        err = open(self.folder / "plc.err", "w", encoding="utf-8") if stderr is None else stderr
        self.addCleanup(out.close)
        if stderr is None:
            self.addCleanup(err.close)
        self.plc = subprocess.Popen([TAKT, "node", "plc.json"], cwd=self.folder, stdout=out, stderr=err)
        self.addCleanup(self.plc.wait)
        self.addCleanup(self.plc.kill)
        self.port = port
        until = time.monotonic() + PATIENCE
        while time.monotonic() < until:
            try:
                if (self.folder / "plc-pki/own/certs/certificate.der").exists():
                    return socket.create_connection(("127.0.0.1", port)).close()
                time.sleep(0.05)
            except OSError:
                self.assertIsNone(self.plc.poll())
                time.sleep(0.05)
        return self.fail("no server")

    def client(self):
        return Client(self.port).open()

    def anonymous(self):
        client = self.client()
        self.assertEqual(client.begin(), 0)
        return client

    def user(self, name):
        client = self.client()
        self.assertEqual(client.begin(name.encode(), name.encode(), self.folder / "plc-pki/own/certs/certificate.der"), 0)
        return client

    def control(self, *words):
        done = subprocess.run([TAKT, "ctl", str(self.folder / "plc.sock"), *words, "--format", "json"], capture_output=True, text=True, timeout=100, check=False)
        return json.loads(done.stdout)

    def memory_mib(self):
        return int(re.search(r"VmRSS:\s+(\d+)", pathlib.Path(f"/proc/{self.plc.pid}/status").read_text(encoding="utf-8")).group(1)) // 1024

    def transitions(self, count):
        for _ in range(count):
            for method, state in (("start", "Running"), ("halt", "Halted")):
                self.control(method)
                until = time.monotonic() + PATIENCE
                while self.control("status")["state"] != state:
                    self.assertLess(time.monotonic(), until)

    def halt(self, client):
        begin = time.monotonic()
        status, _ = client.ask(712, several([named(b"cell") + node(2429) + several([])]))
        self.assertEqual(status, 0)
        return time.monotonic() - begin

    def test_filters_of_an_observer_who_has_gone(self):
        self.start()
        observer = self.user("olaf")
        subscription = observer.subscribe(3_600_000.0)[1]
        for _ in range(20):
            observer.monitor_events(subscription, COMPARING)
        observer.close()
        anna = self.user("anna")
        self.transitions(3)
        self.assertLess(self.halt(anna), 20.0)  # 43 to 57 s before; 50 ms on a machine at rest
        self.assertLess(self.memory_mib(), MOST_MIB)

    def test_items_with_many_clauses(self):
        self.start()
        client = self.anonymous()
        results = set()
        for _ in range(20):
            subscription = client.subscribe()[1]
            results |= {client.monitor_events(subscription, selecting(clauses)) for clauses in [2200] + [900] * 6}
        self.assertEqual(results, {0, 0x80470000, 0x80DB0000})  # Good, Bad_EventFilterInvalid, Bad_TooManyMonitoredItems
        self.transitions(20)
        self.assertLess(self.memory_mib(), MOST_MIB)
        self.user("anna").close()

    def test_sessions_that_were_left(self):
        self.start()
        for _ in range(50):
            self.anonymous().close()
        self.user("anna").close()

    def test_subscriptions_that_were_left(self):
        self.start()
        for _ in range(10):
            client = self.anonymous()
            for _ in range(20):
                client.subscribe(3_600_000.0)
            self.assertEqual(client.ask(473, b"\0")[0], 0)
            client.close()
        self.assertEqual(self.user("anna").subscribe()[0], 0)

    def test_connections_that_say_nothing(self):
        self.start()
        silent = [socket.create_connection(("127.0.0.1", self.port)) for _ in range(300)]
        for _ in range(10):
            self.user("anna").close()
        for each in silent:
            each.close()

    def test_discovery_that_nobody_reads(self):
        self.start()
        for _ in range(50):
            client = self.client()
            client.socket.settimeout(0.2)
            try:
                for _ in range(2000):
                    client.send(428, text(client.url) + several([]) * 2)
            except (TimeoutError, OSError):
                pass
        self.assertLess(self.memory_mib(), MOST_MIB)
        self.user("anna").close()

    def strangers(self, count, subject):
        """OPNs with certificates of nobody: refused before anything is decrypted."""
        key = self.folder / "stranger.pem"
        subprocess.run(["openssl", "genrsa", "-out", str(key), "2048"], capture_output=True, check=True)
        own = subprocess.run(["openssl", "x509", "-inform", "DER", "-in", str(self.folder / "plc-pki/own/certs/certificate.der"), "-fingerprint", "-sha1", "-noout"],
                             capture_output=True, text=True, check=True).stdout
        thumbprint = bytes.fromhex(own.strip().split("=")[1].replace(":", ""))
        for i in range(count):
            make = ["openssl", "req", "-x509", "-new", "-key", str(key), "-sha256", "-days", "30", "-outform", "DER", "-subj", subject % i, "-addext", "subjectAltName=URI:urn:x"]
            der = subprocess.run(make, capture_output=True, check=True).stdout
            client = Client(self.port)
            client.say(b"HELF", u32(0) + u32(65536) * 2 + u32(0) * 2 + text(client.url))
            client.hear()
            client.say(b"OPNF", u32(0) + text(BASIC256SHA256) + text(der) + text(thumbprint) + bytes(256))
            with self.assertRaises(ConnectionError):
                client.hear()
            client.close()

    def test_certificates_of_strangers(self):
        self.start()
        self.strangers(100, "/CN=s%d")
        rejected = list((self.folder / "plc-pki/rejected").glob("*.der"))
        self.assertEqual(len(rejected), 64)
        client = self.client()
        self.assertNotEqual(client.begin(b"anna", b"wrong", self.folder / "plc-pki/own/certs/certificate.der"), 0)
        until = time.monotonic() + PATIENCE
        while "a sign-in" not in (self.folder / "plc.err").read_text(encoding="utf-8"):
            self.assertLess(time.monotonic(), until)
            time.sleep(0.1)
        while self.control("status")["server"]["rejected"] != 100:
            self.assertLess(time.monotonic(), until)
            time.sleep(0.1)

    def test_standard_error_that_nobody_reads(self):
        read, write = os.pipe()
        self.addCleanup(os.close, read)
        self.start(write)
        os.close(write)
        long_name = "".join(f"/OU={'x' * 60}{i:02}" for i in range(99))
        self.strangers(5, "/CN=s%d" + long_name)
        self.user("anna").close()
        begin = time.monotonic()
        self.plc.terminate()
        self.plc.wait(timeout=PATIENCE)
        self.assertLess(time.monotonic() - begin, 20.0)  # 2 s on a machine at rest


if __name__ == "__main__":
    TAKT = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main(verbosity=2)
