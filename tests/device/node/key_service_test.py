#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A key service and real nodes that pull the keys of their messages from it: the group runs while keys change, also with a node that has the file, and while the service is away.
Services that are none are refused in words.

No test depends on how fast the machine is, but for the lifetime of keys: a node that comes two lifetimes late is not heard.

usage: key_service_test.py TAKT BUILD_FOLDER [unittest options]
"""
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
import unittest

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE / "server"))
import opcua_server_test  # noqa: E402
import real_node_test  # noqa: E402
from real_node_test import NODES, PATIENCE, PORTS  # noqa: E402

SECRET = bytes(range(32))
LIFETIME = 2
PORT = PORTS + 8
PASSWORDS = {"plc": "the plc's", "left": "the left one's", "right": "the right one's", "anna": "no node", "stranger": "of another group"}


def write_private(path, text):
    with open(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "w", encoding="utf-8") as file:
        file.write(text)


class KeyServiceTest(real_node_test.NodeTest):
    PROGRAM = {"name": "cell", "master": "plc", "slaves": ["left", "right"], "cycle": "10ms", "receive_timeout": "3s", "initialisation": "20ms",
               "process_data": [{"name": "targets", "from": "plc", "fields": {"x": "Double"}}]}

    def setUp(self):
        super().setUp()
        write_private(self.folder / "cell.keys", json.dumps({"group": "cell", "secret": SECRET.hex()}))
        roles = {"anna": "operator"}
        users = [{"name": name, "password": opcua_server_test.hash_of(password), "role": roles.get(name, "key-access")} for name, password in PASSWORDS.items()]
        write_private(self.folder / "users.json", json.dumps({"users": users}))
        for name, password in PASSWORDS.items():
            write_private(self.folder / f"{name}.password", password + "\n")
        self.service = None
        self.held = []
        self.addCleanup(self.stop_service)

    def start_service(self, lifetime=LIFETIME, address="127.0.0.1"):
        path = self.folder / "sks.json"
        path.write_text(json.dumps({"node": "sks", "duration": "600s", "server": {
            "endpoint": f"opc.tcp://{address}:{PORT}", "users": str(self.folder / "users.json"), "limits": {"channels_per_second": 100},
            "key_service": {"groups": [{"keys": "cell.keys", "key_lifetime": f"{lifetime}s", "users": NODES + ["anna"]}]}}}), encoding="utf-8")
        with open(self.folder / "sks.out", "w", encoding="utf-8") as out, open(self.folder / "sks.err", "a", encoding="utf-8") as err:
            self.service = subprocess.Popen([real_node_test.TAKT, "node", str(path)], stdout=out, stderr=err)
        until = time.monotonic() + PATIENCE
        while "start" not in (self.folder / "sks.out").read_text(encoding="utf-8"):
            self.assertIsNone(self.service.poll(), self.said_by("sks"))
            self.assertLess(time.monotonic(), until)
            time.sleep(0.02)

    def stop_service(self):
        if self.service is not None and self.service.poll() is None:
            self.service.send_signal(signal.SIGTERM)
            self.service.wait(timeout=PATIENCE)
        self.service = None

    def said_by(self, name):
        return (self.folder / f"{name}.err").read_text(encoding="utf-8")

    def wait_until_said(self, name, text):
        until = time.monotonic() + PATIENCE
        while text not in self.said_by(name):
            self.assertLess(time.monotonic(), until, (text, self.said_by(name)))
            time.sleep(0.02)

    def access(self, user, **more):
        return {"endpoint": f"opc.tcp://127.0.0.1:{PORT}", "certificate": "sks-pki/own/certs/certificate.der", "user": user, "password_file": f"{user}.password"} | more

    def pulled(self, node, **more):
        return {"security": {"key_service": self.access(more.pop("user", node), **more), "group": "cell", "memory": str(self.folder / f"{node}.memory")}}

    def from_file(self, node):
        return {"security": {"key_lifetime": f"{LIFETIME}s", "keys": "cell.keys", "memory": str(self.folder / f"{node}.memory")}}

    def let_in(self, *nodes):
        """Each node has made its certificate at its start, and the service has kept it as one that it does not trust."""
        trusted = self.folder / "sks-pki/trusted/certs"
        for node in nodes:
            own = self.folder / f"{node}-pki/own/certs/certificate.der"
            until = time.monotonic() + PATIENCE
            while not own.exists():
                self.assertLess(time.monotonic(), until, (node, self.said_by(node)))
                time.sleep(0.02)
            shutil.copy(own, trusted / f"{node}.der")

    def start(self, more):
        self.group = real_node_test.Group(self, self.folder, real_node_test.loopback, program=self.PROGRAM, more=more)
        self.let_in(*(node for node in NODES if "key_service" in more[node]["security"]))
        self.group.wait_for_state("Halted")

    def tokens(self):
        return {node: self.group.status(node)["security"]["token"] for node in NODES}

    def run_over(self, changes):
        """Until all send with a key so many changes later; then everybody runs still."""
        before = self.tokens()
        self.group.wait("other keys", lambda found: all(found[node]["security"]["token"] >= before[node] + changes for node in NODES))
        for node in NODES:
            self.assertEqual(self.group.status(node)["state"], "Running", (node, self.said_by(node)))

    def end(self):
        events = self.group.end()
        for node, log in events.items():
            self.assertLessEqual({event["cause"] for event in log if event["event"] == "intent"}, {"command"}, (node, self.group.said[node]))
            self.assertEqual([event["to"] for event in log if event["event"] == "transition"][-1], "Running", node)
        everything = "".join(path.read_text(encoding="utf-8") for path in [*self.folder.glob("*.out"), *self.folder.glob("*.err")])
        for secret in [SECRET.hex()[:16], *PASSWORDS.values()]:
            self.assertNotIn(secret, everything)


class Rollover(KeyServiceTest):
    def test_the_group_runs_while_keys_change(self):
        """Two nodes pull, the third has the file: they agree, and nobody halts."""
        self.start_service()
        self.start({"plc": self.pulled("plc"), "left": self.pulled("left"), "right": self.from_file("right")})
        self.assertEqual(self.group.call("plc", "start").returncode, 0)
        self.group.wait_for_state("Running")
        self.run_over(5)
        self.end()
        for node in ("plc", "left"):
            self.assertIn("takt: keys of cell: pulled from opc.tcp://127.0.0.1", self.group.said[node])

    def test_an_outage_of_the_service_is_bridged(self):
        self.start_service()
        self.start({node: self.pulled(node) for node in NODES})
        self.assertEqual(self.group.call("plc", "start").returncode, 0)
        self.group.wait_for_state("Running")
        self.stop_service()
        self.run_over(2)
        for node in NODES:
            self.wait_until_said(node, "those that are there last for")
        self.start_service()
        self.run_over(4)
        self.end()

    def test_the_status_says_what_the_service_does(self):
        """Who gave how many keys, which is current, and what went wrong when it was asked last."""
        self.start_service()
        self.start({"plc": self.pulled("plc"), "left": self.pulled("left"), "right": self.from_file("right")})
        seen = self.group.wait("keys", lambda found: all(found[node]["security"]["key_service"]["keys"] > 0 for node in ("plc", "left")))
        self.assertNotIn("key_service", seen["right"]["security"])
        for node in ("plc", "left"):
            service = seen[node]["security"]["key_service"]
            self.assertEqual((service["service"], service["answered_by"], service["problem"]), (f"opc.tcp://127.0.0.1:{PORT}", f"127.0.0.1:{PORT}", None))
            self.assertAlmostEqual(service["token"], time.time() // LIFETIME + 1, delta=PATIENCE / LIFETIME)
            self.assertTrue(1 <= service["keys"] <= 5, service)
            self.assertTrue(0 < service["ends_in_ns"] <= service["keys"] * LIFETIME * 1e9, service)
            self.assertTrue(0 <= service["silent_ns"] < PATIENCE * 1e9, service)
            self.assertGreater(service["pulls"], service["failures"])
        self.stop_service()
        seen = self.group.wait("a failure", lambda found: found["left"]["security"]["key_service"]["problem"])
        service = seen["left"]["security"]["key_service"]
        self.assertEqual(service["problem"], "no connection: Connection refused")
        self.assertGreater(service["failures"], 0)
        text = subprocess.run([real_node_test.TAKT, "ctl", str(self.group.sockets["left"]), "status"], capture_output=True, text=True, check=True).stdout
        self.assertIn(f"  keys of opc.tcp://127.0.0.1:{PORT}: ", text)
        self.assertIn("the last time: no connection: Connection refused", text)
        seen = self.group.wait("the end of the keys", lambda found: found["left"]["security"]["key_service"]["keys"] == 0)
        self.assertEqual((seen["left"]["security"]["key_service"]["token"], seen["left"]["security"]["key_service"]["ends_in_ns"]), (0, 0))

    def test_a_node_that_hears_of_later_keys_asks_at_once(self):
        """The service begins to change keys each 2 s instead of each hour. Whoever has come later has its keys; the others would ask half an hour later by themselves."""
        self.start_service(3600)
        self.start({node: self.pulled(node) for node in NODES})
        self.assertEqual(self.group.call("plc", "start").returncode, 0)
        self.group.wait_for_state("Running")
        self.assertLess(max(self.tokens().values()), time.time() / 1800)
        self.stop_service()
        self.start_service(LIFETIME)
        self.group.processes["plc"].kill()
        self.group.processes.pop("plc").wait()
        self.group.start("plc", self.group.files["plc"])
        found = self.group.wait("later keys", lambda found: all(each["security"]["token"] > time.time() / 4 for each in found.values()))
        for node in ("left", "right"):
            self.assertGreaterEqual(found[node]["security"]["key_service"]["wished"], 1, node)
        self.group.wait_for_state("Halted")
        self.assertEqual(self.group.call("plc", "start").returncode, 0)
        self.group.wait_for_state("Running")
        self.run_over(2)

    def test_who_sends_forged_tokens_lets_nobody_ask_all_the_time(self):
        self.start_service(3600)
        self.start({node: self.pulled(node) for node in NODES})
        self.group.wait("keys", lambda found: all(each["security"]["token"] for each in found.values()))
        forged = bytearray.fromhex("b111ba080f6400010000000100070003ffffff3f08a1a2a3a4010000001e209ad43fe359df81a0bfe6137a21b09a9683d55caaba8fb0f513d6ecf59b70f44850ac25743ca8837b6462d72d3a8d0515e9bf22216b029a54")
        began = time.monotonic()
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
            while time.monotonic() < began + 4:
                for i in range(len(NODES)):
                    stranger.sendto(forged, ("127.0.0.1", PORTS + i))
                time.sleep(0.0005)
        found = {node: self.group.status(node) for node in NODES}
        lasted = time.monotonic() - began
        for node, status in found.items():
            refused = {each["verdict"]: each["messages"] for source in status["sources"] for each in source["refused"]}
            self.assertGreater(refused.get("token", 0), 100, node)
            wished = status["security"]["key_service"]["wished"]
            self.assertTrue(1 <= wished <= lasted, (node, wished, lasted))
            self.assertEqual(status["state"], "Halted")
        self.assertEqual(self.group.call("plc", "start").returncode, 0)
        self.group.wait_for_state("Running")

    def test_a_killed_node_comes_back(self):
        self.start_service()
        self.start({node: self.pulled(node) for node in NODES})
        self.group.processes["left"].kill()
        self.group.processes.pop("left").wait()
        self.group.start("left", self.group.files["left"])
        self.group.wait("back", lambda found: "left" in found)
        self.group.wait_for_state("Halted")
        self.assertEqual(self.group.call("plc", "start").returncode, 0)
        self.group.wait_for_state("Running")


class Topics(KeyServiceTest):
    def test_topics_with_keys_of_the_service(self):
        """A node that publishes and one that subscribes pull keys, which change under way; each tells at its end what it has seen."""
        self.start_service()
        processes = {}
        for node, port, other in (("left", PORTS, PORTS + 1), ("right", PORTS + 1, PORTS)):
            path = self.folder / f"{node}.json"
            path.write_text(json.dumps({"node": node, "topics": [{"name": "x", "protocol": "opc-ua", "fields": {"n": "UInt32", "m": "UInt32"}}],
                                        "applications": [{"name": "p", "on": "left", "threads": [{"name": "t", "publish": "x", "every": "5ms"}]},
                                                         {"name": "s", "on": "right", "threads": [{"name": "t", "subscribe": "x", "every": "5ms", "buffer": 1000}]}],
                                        "transport": {"kind": "udp", "interface": "lo", "port": port, "destinations": [f"127.0.0.1:{other}"]}} | self.pulled(node)), encoding="utf-8")
            with open(self.folder / f"{node}.out", "w", encoding="utf-8") as out, open(self.folder / f"{node}.err", "w", encoding="utf-8") as err:
                processes[node] = subprocess.Popen([real_node_test.TAKT, "node", str(path)], stdout=out, stderr=err)
            self.addCleanup(processes[node].kill)
        self.let_in("left", "right")
        for node in processes:
            self.wait_until_said(node, "keys of cell: pulled from")
        time.sleep(3 * LIFETIME)
        seen = {}
        for node, process in processes.items():
            process.send_signal(signal.SIGTERM)
            self.assertEqual(process.wait(timeout=PATIENCE), 0, self.said_by(node))
            seen[node] = json.loads((self.folder / f"{node}.out").read_text(encoding="utf-8").splitlines()[-1])
        sent = seen["left"]["applications"][0]["threads"][0]
        taken = seen["right"]["applications"][0]["threads"][0]
        self.assertGreater(sent["sent"], 100)
        self.assertGreater(taken["taken"], 100)
        self.assertEqual(taken["lost"], 0)
        for node in processes:
            service = seen[node]["security"]["key_service"]
            self.assertGreaterEqual(service["pulls"] - service["failures"], 3)
            self.assertEqual(service["answered_by"], f"127.0.0.1:{PORT}")
            refused = {each["verdict"] for source in seen[node]["sources"] for each in source["refused"]}
            self.assertLessEqual(refused, {"token"}, (node, "but for what comes before the first keys"))
        self.assertIn(f"  keys of opc.tcp://127.0.0.1:{PORT}: ", self.said_by("left"))


class Refusals(KeyServiceTest):
    """One node against services that give nothing: it says why, once, sends nothing, and goes on."""

    def start_one(self, **more):
        path = self.folder / "left.json"
        config = {"node": "left", "program": self.PROGRAM, "transport": real_node_test.loopback("left"), "control": str(self.folder / "left.sock"), "duration": "600s"}
        path.write_text(json.dumps(config | self.pulled("left", **more)), encoding="utf-8")
        with open(self.folder / "left.out", "w", encoding="utf-8") as out, open(self.folder / "left.err", "w", encoding="utf-8") as err:
            process = subprocess.Popen([real_node_test.TAKT, "node", str(path)], stdout=out, stderr=err)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def expect(self, text, **more):
        process = self.start_one(**more)
        self.let_in("left")
        self.wait_until_said("left", text)
        self.assertIn("nothing is sent without keys", self.said_by("left"))
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=PATIENCE), 0)

    def test_who_is_not_let_in(self):
        self.start_service()
        process = self.start_one()
        self.wait_until_said("left", "it refuses: Bad_SecurityChecksFailed")
        self.let_in("left")
        self.wait_until_said("left", "keys of cell: pulled from")
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=PATIENCE), 0)
        self.expect("it gives no keys of cell to anna: Bad_UserAccessDenied", user="anna")
        self.expect("it gives no keys of cell to stranger: Bad_UserAccessDenied", user="stranger")
        self.assertIn("keys: stranger: Bad_UserAccessDenied", self.said_by("sks"))
        write_private(self.folder / "left.password", "another one\n")
        self.expect("it refuses the sign-in: Bad_UserAccessDenied")

    def test_another_certificate(self):
        self.start_service()
        process = self.start_one()  # makes its own certificate, which is taken for the service's then
        self.let_in("left")
        self.wait_until_said("left", "pulled from")
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=PATIENCE), 0)
        self.expect("it refuses: Bad_CertificateInvalid", certificate="left-pki/own/certs/certificate.der")

    def test_nobody_there(self):
        self.start_service()
        self.stop_service()
        self.expect("Connection refused")

    def test_a_service_by_its_name(self):
        """This machine by its own name, if it has an address by that; and names that have none."""
        name = socket.gethostname()
        try:
            address = socket.getaddrinfo(name, None, socket.AF_INET)[0][4][0]
        except OSError:
            address = None
        self.start_service(address="0.0.0.0")
        if address is not None:
            process = self.start_one(endpoint=f"opc.tcp://{name}:{PORT}")
            self.let_in("left")
            self.wait_until_said("left", f"keys of cell: pulled from opc.tcp://{name}:{PORT}")
            done = subprocess.run([real_node_test.TAKT, "ctl", str(self.folder / "left.sock"), "status", "--format", "json"], capture_output=True, text=True, check=True)
            self.assertEqual(json.loads(done.stdout)["security"]["key_service"]["answered_by"], f"{address}:{PORT}")
            process.send_signal(signal.SIGTERM)
            self.assertEqual(process.wait(timeout=PATIENCE), 0)
        self.expect("opc.tcp://no-such-host.invalid:4840: no address of no-such-host.invalid: ", endpoint="opc.tcp://no-such-host.invalid:4840")

    def test_a_service_that_says_nothing_or_anything(self):
        """A server that closes, one that talks without an end, and one that is silent, from which a signal gets the node away."""
        self.start_service()
        self.stop_service()
        listener = socket.create_server(("127.0.0.1", PORT))
        self.addCleanup(listener.close)
        self.addCleanup(listener.shutdown, socket.SHUT_RDWR)  # who waits for connections goes on, and ends
        say = {"what": b"", "is_over": False}

        def serve():
            while True:
                try:
                    connection, _ = listener.accept()
                    if say["what"] is None:
                        self.held.append(connection)  # held, in silence
                        continue
                    with connection:
                        connection.recv(65536)
                        for _ in range(2000 if say["what"] else 0):
                            connection.sendall(say["what"])
                except OSError:
                    if say["is_over"] or listener.fileno() < 0:
                        return

        threading.Thread(target=serve, daemon=True).start()
        self.expect("closed the connection behind Hello")
        say["what"] = b"MSGC\xff\xff\x00\x00" * 100
        self.expect("a message that is not due now")
        say["what"] = b"\x00" * 65536
        self.expect("no message of UA-TCP")
        say["what"] = None
        process = self.start_one()
        until = time.monotonic() + PATIENCE
        while not self.held and time.monotonic() < until:
            time.sleep(0.02)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=PATIENCE), 0)
        for connection in self.held:
            connection.close()
        say["is_over"] = True

    def test_files(self):
        self.start_service()
        def check(config):
            path = self.folder / "check.json"
            path.write_text(json.dumps(config), encoding="utf-8")
            done = subprocess.run([real_node_test.TAKT, "node", "--check", str(path)], capture_output=True, text=True, check=False)
            return done.returncode, done.stderr
        base = {"node": "left", "program": self.PROGRAM, "transport": real_node_test.loopback("left")}
        self.assertEqual(check(base | self.pulled("left"))[0], 0, check(base | self.pulled("left"))[1])
        for change, expected in (({"certificate": "left.password"}, "no certificate"), ({"endpoint": "opc.tcp://0.0.0.0:1"}, "no endpoint"), ({"endpoint": "opc.tcp://10.0.0.300:1"}, "no endpoint"),
                                 ({"endpoint": "opc.tcp://-a.plant:1"}, "no endpoint"), ({"endpoint": "opc.tcp://a..plant:1"}, "no endpoint"), ({"endpoint": "opc.tcp://sks.plant:0"}, "no endpoint"), ({"endpoint": f"opc.tcp://{64 * 'a'}"}, "no endpoint"),
                                 ({"endpoint": "opc.tcp://sks.plant/a"}, "no endpoint"), ({"password_file": "none"}, "cannot be read")):
            config = base | self.pulled("left")
            config["security"]["key_service"] |= change
            status, said = check(config)
            self.assertEqual(status, 2, said)
            self.assertIn(expected, said)
        for name in ("sks.plant", "sks-1.plant:4841", "10.0.0.1", "localhost:48400", "3com.example"):
            self.assertEqual(check(base | self.pulled("left", endpoint=f"opc.tcp://{name}"))[0], 0, name)
        (self.folder / "left.password").chmod(0o644)
        self.assertIn("others than its owner may read", check(base | self.pulled("left"))[1])
        (self.folder / "left.password").chmod(0o600)
        config = base | self.pulled("left")
        del config["security"]["group"]
        self.assertIn("keys of no group", check(config)[1])
        config = base | self.pulled("left")
        config["security"]["key_lifetime"] = "1h"
        self.assertIn("a lifetime of keys that a service gives", check(config)[1])
        server = json.loads((self.folder / "sks.json").read_text(encoding="utf-8"))
        self.assertEqual(check(server)[0], 0)
        del server["server"]["users"]
        self.assertIn("keys that nobody can have", check(server)[1])
        del server["server"]["key_service"]
        self.assertIn("a server of nothing", check(server)[1])


class Stock(KeyServiceTest):
    def test_node_opcua(self):
        """A client of others gets the keys that the file makes."""
        if not opcua_server_test.install_client(BUILD):
            self.skipTest("no node-opcua")
        self.start_service(3600)
        given = {"endpoint": f"opc.tcp://127.0.0.1:{PORT}", "pki": str(self.folder / "client-pki"), "trusted": str(self.folder / "sks-pki/trusted/certs"),
                 "user": {"name": "left", "password": PASSWORDS["left"]}, "operator": {"name": "anna", "password": PASSWORDS["anna"]}}
        done = subprocess.run(["node", str(HERE / "key_service_client.js"), str(opcua_server_test.MODULES), json.dumps(given)], capture_output=True, text=True, timeout=PATIENCE, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        from secured_node_test import key_of
        answer = json.loads(done.stdout.splitlines()[-1])
        self.assertEqual(answer["policy"], "http://opcfoundation.org/UA/SecurityPolicy#PubSub-Aes128-CTR")
        self.assertEqual(answer["lifetime"], 3_600_000)
        self.assertTrue(0 < answer["next"] <= 3_600_000, answer)
        self.assertEqual(answer["keys"], [key_of(answer["first"] + i).hex() for i in range(3)])
        self.assertAlmostEqual(answer["first"], time.time() // 3600 + 1, delta=1)


if __name__ == "__main__":
    real_node_test.TAKT = opcua_server_test.TAKT = str(pathlib.Path(sys.argv.pop(1)).resolve())
    BUILD = pathlib.Path(sys.argv.pop(1))
    unittest.main(verbosity=2)
