#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Three real nodes with OPC UA servers, and a stock client (node-opcua), which is installed below the build folder; skipped where npm or that cannot be had.

No test depends on how fast the machine is.

usage: opcua_server_test.py TAKT BUILD_FOLDER [unittest options]
"""
import json
import os
import pathlib
import shutil
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
MODULES = pathlib.Path()
SKIPPED = 77
PORTS = reservation.ports()
NODES = ["plc", "left", "right"]
PROGRAM = {"name": "cell", "master": "plc", "slaves": ["left", "right"], "cycle": "5ms", "receive_timeout": "1000s", "initialisation": "20ms"}
SECURITIES = [("None", "None")] + [(policy, mode) for policy in ("Basic256Sha256", "Aes128_Sha256_RsaOaep", "Aes256_Sha256_RsaPss") for mode in ("Sign", "SignAndEncrypt")]
PATIENCE = 300
ALSO_TO = []  # ports that all nodes send to besides
OPERATOR = {"name": "operator", "password": "open sesame"}
OBSERVER = {"name": "observer", "password": "just looking"}


def install_client(build):
    """node-opcua-client below the build folder, as the lock file has it; false if it cannot be had."""
    global MODULES
    folder = build.resolve() / "opcua-client"
    MODULES = folder / "node_modules"
    if shutil.which("npm") is None or shutil.which("node") is None:
        return False
    folder.mkdir(exist_ok=True)
    lock = (HERE / "package-lock.json").read_text(encoding="utf-8")
    done = folder / "installed"
    if done.exists() and done.read_text(encoding="utf-8") == lock:
        return True
    for name in ("package.json", "package-lock.json"):
        shutil.copy(HERE / name, folder / name)
    # Scripts of packages are not run: the client needs none.
    if subprocess.run(["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund"], cwd=folder, capture_output=True, timeout=PATIENCE, check=False).returncode != 0:
        return False
    done.write_text(lock, encoding="utf-8")
    return True


def hash_of(password):
    return subprocess.run([TAKT, "node", "--hash-password"], input=password + "\n", capture_output=True, text=True, check=True).stdout.strip()


class Raw:
    """A client that says what no client says."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=PATIENCE)

    def say(self, *messages):
        try:
            for message in messages:
                self.socket.sendall(message)
        except OSError:
            pass  # refused in the middle of it
        return self

    def answer(self):
        """All until the server closes."""
        octets = b""
        try:
            while more := self.socket.recv(65536):
                octets += more
        except OSError:
            pass
        self.socket.close()
        return octets


def hello(size=65536):
    url = b"opc.tcp://127.0.0.1:4840"
    body = struct.pack("<IIIIII", 0, size, size, 0, 0, len(url)) + url
    return b"HELF" + struct.pack("<I", 8 + len(body)) + body


def error_in(octets):
    """The status of the ERR at the end of an answer."""
    at = octets.rfind(b"ERRF")
    return struct.unpack_from("<I", octets, at + 8)[0] if at >= 0 else None


class ServerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="takt-opcua-")
        root = pathlib.Path(cls.folder.name)
        cls.port = {node: PORTS + 3 + i for i, node in enumerate(NODES)}
        users = root / "users.json"
        users.touch(mode=0o600)
        users.write_text(json.dumps({"users": [{"name": user["name"], "password": hash_of(user["password"]), "role": user["name"]} for user in (OPERATOR, OBSERVER)]}), encoding="utf-8")
        cls.users = users
        udp = {node: PORTS + i for i, node in enumerate(NODES)}
        cls.processes = {}
        cls.addClassCleanup(cls.end)
        for node in NODES:
            server = {"endpoint": f"opc.tcp://127.0.0.1:{cls.port[node]}", "users": str(users), "anonymous": True, "policies": ["None"] + sorted({p for p, _ in SECURITIES} - {"None"}),
                      "modes": ["Sign", "SignAndEncrypt"], "halt_without_encryption": True,
                      "limits": {"hello_within": "10s", "idle_channel": "10s", "least_token": "500ms", "channels_per_second": 1000, "connections": 40}}
            if node == "right":
                del server["limits"]  # as most servers are
            config = {"node": node, "program": PROGRAM, "duration": "900s", "control": str(root / f"{node}.sock"),
                      "transport": {"kind": "udp", "port": udp[node], "destinations": [f"127.0.0.1:{udp[other]}" for other in NODES if other != node] + [f"127.0.0.1:{port}" for port in ALSO_TO]}, "server": server}
            path = root / f"{node}.json"
            path.write_text(json.dumps(config), encoding="utf-8")
            with open(root / f"{node}.out", "w", encoding="utf-8") as out, open(root / f"{node}.err", "w", encoding="utf-8") as err:
                cls.processes[node] = subprocess.Popen([TAKT, "node", str(path)], stdout=out, stderr=err)
        cls.root = root
        for node in NODES:
            cls.wait_for_port(node)
        # The client makes its certificate when it is first there, is rejected, and is then trusted.
        cls.given = {"pki": str(root / "client"), "endpoints": {node: f"opc.tcp://127.0.0.1:{cls.port[node]}" for node in NODES}, "operator": OPERATOR, "observer": OBSERVER,
                     "securities": [{"policy": policy, "mode": mode} for policy, mode in SECURITIES], "count": 20}
        cls.client("untrusted")
        rejected = list((root / "plc-pki" / "rejected").glob("*.der"))
        assert len(rejected) == 1, rejected
        for node in NODES:
            shutil.copy(rejected[0], root / f"{node}-pki" / "trusted" / "certs")
        time.sleep(2.5)  # the folder is looked at once a second

    @classmethod
    def end(cls):
        for process in cls.processes.values():
            process.terminate()
        for process in cls.processes.values():
            process.wait(timeout=PATIENCE)
        cls.folder.cleanup()

    @classmethod
    def wait_for_port(cls, node):
        until = time.monotonic() + PATIENCE
        while True:
            try:
                socket.create_connection(("127.0.0.1", cls.port[node])).close()
                return
            except OSError:
                assert cls.processes[node].poll() is None, (cls.root / f"{node}.err").read_text(encoding="utf-8")
                assert time.monotonic() < until
                time.sleep(0.05)

    @classmethod
    def client(cls, check, **more):
        done = subprocess.run(["node", str(HERE / "client.js"), str(MODULES), check, json.dumps(cls.given | more)], capture_output=True, text=True, timeout=PATIENCE, check=False,
                              env=os.environ | {"NODEOPCUADEBUG": ""})
        assert done.returncode == 0, (check, done.stdout[-4000:], done.stderr[-4000:], cls.errors())
        return done.stdout

    @classmethod
    def errors(cls):
        return {node: (cls.root / f"{node}.err").read_text(encoding="utf-8")[-2000:] for node in NODES}

    def expect_undisturbed(self):
        for node, process in self.processes.items():
            self.assertIsNone(process.poll(), self.errors()[node])
        self.assertIn("halted", self.client("program"))

    def test_policies(self):
        said = self.client("policies").splitlines()
        self.assertEqual([line for line in said if tuple(line.split(" ")) in SECURITIES], [" ".join(each) for each in SECURITIES])

    def test_browse(self):
        self.client("browse")

    def test_program(self):
        self.client("program")

    def test_rights(self):
        self.client("rights")

    def test_renewals(self):
        self.client("renewals")

    def test_twenty_sessions(self):
        self.client("sessions")

    def test_twenty_that_come_back(self):
        self.client("returning", endpoints={"plc": self.given["endpoints"]["right"]})

    def test_latency(self):
        print(self.client("latency").strip())

    def test_key_is_the_owners_only(self):
        key = self.root / "plc-pki" / "own" / "private" / "key.pem"
        self.assertEqual(key.stat().st_mode & 0o777, 0o600)
        self.assertEqual(key.parent.stat().st_mode & 0o777, 0o700)

    def test_hostile_octets(self):
        """Refused with an ERR, or without a word; and others are not disturbed."""
        port = self.port["plc"]
        none = b"http://opcfoundation.org/UA/SecurityPolicy#None"
        cases = {
            "no OPC UA": (b"GET / HTTP/1.1\r\n\r\n", 0x807E0000),
            "a second hello": (hello() + hello(), 0x807E0000),
            "a message before a channel": (hello() + b"MSGF" + struct.pack("<IIIII", 24, 1, 1, 1, 1), 0x807F0000),
            "larger than the buffer, in one piece with a good hello": (hello() + b"OPNF" + struct.pack("<I", 0x7FFFFFFF) + bytes(4096), 0x80800000),
            "small buffers": (hello(1024), 0x80810000),
            "shorter than its header": (b"HELF" + struct.pack("<I", 4), 0x807E0000),
            "an unknown policy": (hello() + b"OPNF" + struct.pack("<II", 36, 0) + struct.pack("<I", 4) + b"else" + struct.pack("<iiII", -1, -1, 1, 1), 0x80550000),
            "an OPN whose lengths lie": (hello() + b"OPNF" + struct.pack("<II", 40, 0) + struct.pack("<i", 0x7FFFFFFF) + bytes(24), 0x80130000),
            "an OPN without a body": (hello() + b"OPNF" + struct.pack("<II", 12 + 4 + len(none) + 16, 0) + struct.pack("<I", len(none)) + none + struct.pack("<iiII", -1, -1, 1, 1), 0x80070000),
        }
        for what, (octets, status) in cases.items():
            with self.subTest(what):
                self.assertEqual(error_in(Raw(port).say(octets).answer()), status, what)
                # Octet by octet it is the same.
                raw = Raw(port)
                raw.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                self.assertEqual(error_in(raw.say(*[octets[i:i + 1] for i in range(min(len(octets), 200))], octets[200:]).answer()), status, what)
        randoms = [os.urandom(2000) for _ in range(20)]
        for octets in randoms:
            Raw(port).say(octets).answer()
            Raw(port).say(hello() + octets).answer()
        self.expect_undisturbed()

    def test_half_open_and_slow(self):
        """Those who say nothing, or one octet now and then, go; those who come in crowds do not keep others out."""
        silent = [Raw(self.port["plc"]) for _ in range(60)]  # more than there may be
        slow = Raw(self.port["plc"]).say(hello()[:5])
        self.expect_undisturbed()
        self.assertIn(error_in(slow.answer()), (0x800A0000, 0x80810000))
        for raw in silent:
            self.assertIn(error_in(raw.answer()), (0x800A0000, 0x80810000))

    def test_refusals_are_told_once(self):
        for _ in range(50):
            Raw(self.port["left"]).say(b"GET / HTTP/1.1\r\n\r\n").answer()
        said = (self.root / "left.err").read_text(encoding="utf-8")
        self.assertEqual(said.count("Bad_TcpMessageTypeInvalid"), said.count("what is no message of UA-TCP") + said.count("a message that is not due now"))
        self.assertLessEqual(said.count("what is no message of UA-TCP"), 1)

    def test_example(self):
        example = HERE.parent.parent.parent.parent / "docs" / "nodes" / "opcua-server.json"
        self.assertEqual(subprocess.run([TAKT, "node", "--check", str(example)], check=False).returncode, 0)

    def test_files_that_others_may_read(self):
        users = self.root / "open.json"
        users.write_text(self.users.read_text(encoding="utf-8"), encoding="utf-8")
        users.chmod(0o644)
        config = json.loads((self.root / "left.json").read_text(encoding="utf-8"))
        config["server"]["users"] = str(users)
        path = self.root / "other.json"
        path.write_text(json.dumps(config), encoding="utf-8")
        done = subprocess.run([TAKT, "node", "--check", str(path)], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("others than its owner may read", done.stderr)


if __name__ == "__main__":
    TAKT = sys.argv.pop(1)
    if not install_client(pathlib.Path(sys.argv.pop(1))):
        print("skipped: node-opcua-client is not to be had here (node and npm, and a network at the first run)")
        sys.exit(SKIPPED)
    unittest.main(verbosity=2)
