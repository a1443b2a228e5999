#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the reports of run and check say of TSN features: exact counters of small scenarios that are derived beside them; what a node says of its messages.

usage: features_test.py TAKT SOURCE_FOLDER [unittest options]
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

TAKT = ""
SCENARIOS = pathlib.Path()

PORTS = "Preemption, cut-through, overruns"
INGRESS = "Ingress of switches"
REDUNDANT = "Redundant streams"
CHECKED_PORTS = "Ports beyond strict priority (numbers are traffic classes)"


def takt(*arguments):
    done = subprocess.run([TAKT, *map(str, arguments)], capture_output=True, text=True, timeout=1000, check=False)
    return done.returncode, done.stdout, done.stderr


class FeaturesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="takt-features-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, scenario):
        path = self.folder / "s.json"
        path.write_text(json.dumps(scenario), encoding="utf-8")
        return path

    def both(self, path, *arguments):
        """The result as JSON, and the page."""
        if isinstance(path, dict):
            path = self.write(path)
        status, out, err = takt("run", path, "--format", "json", *arguments)
        self.assertIn(status, (0, 1), err)
        return json.loads(out), takt("run", path, *arguments)[1]

    def row(self, page, heading, start):
        """The rest of the one row that begins so below a heading."""
        self.assertIn(f"\n\n{heading}\n", page)
        section = page.split(f"\n\n{heading}\n")[1].split("\n\n")[0]
        found = [line.strip()[len(start):].strip() for line in section.splitlines() if line.strip().startswith(start + "  ")]
        self.assertEqual(len(found), 1, (start, page))
        return found[0]


def port(report, name):
    node, number = name.split(":")
    return next(p for p in report["ports"] if (p["node"], p["port"]) == (node, int(number)))


def star(streams, ingress=None, **more):
    """Hosts a, b and c at the switch sw, 100 Mb/s."""
    return {"name": "star", "duration": "10ms", "network": {
        "nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "c": {"kind": "host"}, "sw": {"kind": "switch", **({"ingress": ingress} if ingress else {})}},
        "links": [{"ends": [n, "sw"], "rate": "100Mbps", "delay": "0s"} for n in "abc"]}, "streams": streams, **more}


class Ports(FeaturesTest):
    def test_nothing_is_said_where_there_is_nothing(self):
        report, page = self.both(star([{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms"}]))
        self.assertEqual((report["dropped"], report["ingress"], report["redundancy"]), ({}, {}, {"splits": [], "recoveries": []}))
        for p in report["ports"]:
            self.assertEqual([p[key] for key in ("fragments_cut", "frames_cut_through", "bad_fcs_forwarded", "transmission_overrun")], [0] * 4)
        for heading in ("Preemption", "Ingress", "Redundant", "dropped in all"):
            self.assertNotIn(heading, page)

    def test_preemption(self):
        # One express frame in each of 1000 periods comes while a preemptable one is under way.
        report, page = self.both(SCENARIOS / "validation/preemption.json")
        self.assertEqual(port(report, "talker:0")["fragments_cut"], 1000)
        self.assertEqual(self.row(page, PORTS, "talker:0 to listener"), "1000 frames cut for express ones")

    def test_cut_through_of_damaged_frames(self):
        # Every frame is damaged on its way from a to sw, and cut through there: all reach b, which drops them.
        scenario = star([{"name": "s", "from": "a", "to": "b", "payload": "1000B", "every": "1ms"}])
        scenario["network"]["nodes"]["sw"]["egress"] = [{"cut_through": [1]}]
        scenario["faults"] = [{"kind": "frame-errors", "link": ["a", "sw"], "corruption": 1}]
        report, page = self.both(scenario, "--duration", "9500us")
        self.assertEqual(report["dropped"], {"bad_fcs": 10})
        self.assertEqual((port(report, "sw:1")["frames_cut_through"], port(report, "sw:1")["bad_fcs_forwarded"]), (10, 10))
        self.assertEqual(self.row(page, PORTS, "sw:1 to b"), "10 cut through, 10 of them damaged")

    def test_overrun(self):
        # The gate breaks at 100 us, while the frame that came at 84.32 us is being sent.
        scenario = star([{"name": "s", "from": "a", "to": "b", "payload": "1000B", "every": "20ms"}])
        scenario["network"]["nodes"]["sw"]["egress"] = [{"gates": {"entries": [{"open": list(range(8)), "for": "1ms"}]}}]
        scenario["faults"] = [{"kind": "stuck-gate", "node": "sw", "class": 1, "state": "closed", "at": "100us"}]
        report, page = self.both(scenario)
        self.assertEqual(port(report, "sw:1")["transmission_overrun"], 1)
        self.assertEqual(self.row(page, PORTS, "sw:1 to b"), "1 sent beyond the end of their gate")

    def test_drops_of_several_streams_are_summed(self):
        # A gate that lets no SDU of more than 500 octets pass: all but the last frame, which is under way at the end.
        scenario = star([{"name": n, "from": n, "to": "c", "payload": "1000B", "every": "1ms"} for n in "ab"])
        scenario["network"]["nodes"]["sw"]["egress"] = [{"max_sdu": [{"class": 1, "size": "500B"}]}]
        report, page = self.both(scenario)
        self.assertEqual(report["dropped"], {"queue_max_sdu": 20})
        self.assertIn("\n  dropped in all  queue_max_sdu: 20\n", page)


class Ingress(FeaturesTest):
    def test_filter_and_gate(self):
        # a sends 1 000-octet payloads at 0, 1 .. 9 ms (the frame of 10 ms is under way at the end). The gate is open in the first half of each
        # 2 ms: frames of even milliseconds, which are in after 84.32 us, pass. b's are too long.
        scenario = star([{"name": "s", "from": "a", "to": "c", "payload": "1000B", "every": "1ms", "pcp": 3},
                         {"name": "long", "from": "b", "to": "c", "payload": "1400B", "every": "1ms", "pcp": 2}],
                        {"filters": [{"stream": "s", "gate": "g"}, {"stream": "long", "max_sdu": "1000B", "block_oversize": True}],
                         "gates": [{"name": "g", "entries": [{"open": True, "for": "1ms"}, {"open": False, "for": "1ms"}]}]})
        report, page = self.both(scenario)
        ingress = report["ingress"]["sw"]
        self.assertEqual(ingress["filters"][0], {"stream": "s", "pcp": None, "matching": 10, "passing": 5, "not_passing": 5, "passing_sdu": 10,
                                                 "not_passing_sdu": 0, "red": 0, "blocked_due_to_oversize": False})
        self.assertEqual(ingress["filters"][1]["not_passing_sdu"], 10)
        self.assertIs(ingress["filters"][1]["blocked_due_to_oversize"], True)
        self.assertEqual(ingress["gates"]["g"], {"passed": 5, "closed": 5, "octets_exceeded": 0, "closed_due_to_invalid_rx": False,
                                                 "closed_due_to_octets_exceeded": False})
        self.assertEqual(self.row(page, INGRESS, "sw filter s"), "10 matched, 5 stopped by the gate")
        self.assertEqual(self.row(page, INGRESS, "sw filter long"), "10 matched, 10 too long, BLOCKED since one was too long")
        self.assertEqual(self.row(page, INGRESS, "sw gate g"), "5 passed, 5 came while it was closed")
        self.assertEqual(report["dropped"], {"stream_max_sdu": 10, "stream_gate": 5})

    def test_a_gate_that_closes_for_good_shows(self):
        # The frame of 1 ms comes while the gate is closed; the nine from then on are stopped.
        scenario = star([{"name": "s", "from": "a", "to": "c", "payload": "1000B", "every": "1ms", "pcp": 3}],
                        {"filters": [{"stream": "s", "gate": "g"}],
                         "gates": [{"name": "g", "block_invalid_rx": True, "entries": [{"open": True, "for": "1ms"}, {"open": False, "for": "1ms"}]}]})
        report, page = self.both(scenario)
        self.assertIs(report["ingress"]["sw"]["gates"]["g"]["closed_due_to_invalid_rx"], True)
        self.assertEqual(self.row(page, INGRESS, "sw gate g"), "1 passed, 9 came while it was closed, CLOSED since one came while it was closed")

    def test_meter_colours(self):
        # Ten frames of 1046 octets at once. The buckets hold two and one; no token comes that fast (1 kb/s).
        scenario = star([{"name": "s", "from": "a", "to": "c", "payload": "1000B", "burst": {"frames": 10, "every": "20ms", "spacing": "100us"}}],
                        {"filters": [{"stream": "s", "meter": "m"}],
                         "meters": [{"name": "m", "cir": "1kbps", "cbs": "2100B", "eir": "1kbps", "ebs": "1100B"}]})
        report, page = self.both(scenario)
        self.assertEqual(report["ingress"]["sw"]["meters"]["m"], {"green": 2, "yellow": 1, "red": 7, "discarded": 7, "marks_all_red": False})
        self.assertEqual(self.row(page, INGRESS, "sw meter m"), "2 green, 1 yellow, 7 red, 7 discarded")
        self.assertEqual(self.row(page, INGRESS, "sw filter s"), "10 matched, 7 discarded by the meter")

    def test_ats(self):
        # Three frames back to back, 1066 octets each with preamble and gap, at 8 528 bit / 1 Mb/s = 8.528 ms each; the bucket holds one.
        # The first is eligible as it comes, the second 8.528 ms later. It came 85.28 us after the first: held for 8.44272 ms. The third would
        # be held for 16.9 ms, longer than 10 ms.
        scenario = star([{"name": "s", "from": "a", "to": "c", "payload": "1000B", "burst": {"frames": 3, "every": "100ms", "spacing": "0s"}}],
                        {"filters": [{"stream": "s", "ats": "t"}], "ats": [{"name": "t", "rate": "1Mbps", "burst": "1066B"}], "max_residence_time": "10ms"},
                        duration="20ms")
        scenario["network"]["nodes"]["sw"]["egress"] = [{"ats": [1]}]
        report, page = self.both(scenario)
        self.assertEqual(report["ingress"]["sw"]["ats"]["t"], {"passed": 2, "discarded": 1, "longest_hold_ps": 8_442_720_000})
        self.assertEqual(self.row(page, INGRESS, "sw ats t"), "2 passed, held for up to 8.44272 ms, 1 would have stayed too long")


class Redundancy(FeaturesTest):
    def test_switches(self):
        # A frame each millisecond. From 20 to 80 ms one way brings none, so 60 of 100 have no copy to discard.
        report, page = self.both(SCENARIOS / "validation/frer.json")
        split, = report["redundancy"]["splits"]
        self.assertEqual(split, {"node": "s1", "stream": "frames", "members": 2, "frames": 100, "copies": 100})
        recovery, = report["redundancy"]["recoveries"]
        self.assertEqual((recovery["node"], recovery["passed"], recovery["discarded"], recovery["lost"]), ("s3", 100, 40, 0))
        self.assertEqual(self.row(page, REDUNDANT, "frames at s1"), "100 split into 2 members")
        self.assertEqual(self.row(page, REDUNDANT, "frames at s3"), "100 passed, 40 discarded")

    def test_hosts(self):
        report, page = self.both(SCENARIOS / "tsn/frer-hosts.json")
        self.assertEqual([s["node"] for s in report["redundancy"]["splits"]], ["talker"])
        recovery, = report["redundancy"]["recoveries"]
        self.assertEqual((recovery["node"], recovery["passed"], recovery["discarded"]), ("listener", 2000, 2000))
        self.assertEqual([(i["member"], i["passed"], i["discarded"]) for i in recovery["individual"]], [(0, 2000, 0), (1, 2000, 0)])
        self.assertEqual(self.row(page, REDUNDANT, "control at listener"), "2000 passed, 2000 discarded")

    def test_a_latent_error_shows(self):
        # One way is cut at 210 ms for good: its copies are missing from the test at 250 ms on, while nothing is lost.
        text = (SCENARIOS / "tsn/frer-ring.json").read_text(encoding="utf-8")
        fault = '"faults": [{"kind": "link-down", "link": ["sw1", "sw2"], "at": "210ms"}], "require": ['
        path = self.folder / "cut.json"
        path.write_text(text.replace('"require": [', fault).replace('"../takt.schema.json"', '"takt.schema.json"'), encoding="utf-8")
        report, page = self.both(path)
        recovery, = report["redundancy"]["recoveries"]
        latent = recovery["latent_errors"]
        self.assertEqual((latent["paths"], latent["first_ps"], recovery["lost"]), (2, 250 * 10**9, 0))
        self.assertEqual(latent["errors"], 16)  # 250, 300 .. 1000 ms; at 1 s the test comes before the reset
        self.assertRegex(self.row(page, REDUNDANT, "control at sw3"), r", LATENT ERROR signalled 16 times, first at 250 ms$")


class Check(FeaturesTest):
    def page(self, name):
        status, out, err = takt("check", SCENARIOS / f"{name}.json")
        self.assertEqual(status, 0)
        if name != "tsn/policing":   # which shows a meter slower than its streams, and says so
            self.assertEqual(err, "")
        return out

    def test_ports(self):
        self.assertEqual(self.row(self.page("validation/gates"), CHECKED_PORTS, "switch:2 to server"), "gates: 2 entries, cycle 1 ms; untagged")
        self.assertEqual(self.row(self.page("tsn/cut-through-and-bad-frames"), CHECKED_PORTS, "sw1:0 to sw2"), "gates: 2 entries, cycle 500 us; cut through: 7")
        self.assertEqual(self.row(self.page("tsn/preemption-on-a-line"), CHECKED_PORTS, "sw1:0 to sw2"), "shaper of class 4: 20Mbps; preemptable: 0 1 2 3 4 5")
        self.assertEqual(self.row(self.page("validation/launch-time"), CHECKED_PORTS, "talker:0 to listener"), "launch times: 1")
        self.assertEqual(self.row(self.page("tsn/ats"), CHECKED_PORTS, "sw1:0 to sw2"), "ATS: 5")
        self.assertEqual(self.row(self.page("tsn/ets"), CHECKED_PORTS, "sw1:0 to sw2"), "ETS: 1 (30 %) 2 (70 %)")

    def test_ingress(self):
        self.assertEqual(self.row(self.page("tsn/policing"), INGRESS, "switch"), "3 stream filters; 1 stream gate; 2 flow meters")
        self.assertEqual(self.row(self.page("tsn/cqf"), INGRESS, "sw1"), "CQF: 2 buffers of 250 us, classes 5 6; 1 stream filter; 1 stream gate")

    def test_redundancy_and_faults(self):
        self.assertIn("\n  control  2 members, split at sw1, merged at sw3, vector recovery of 16 numbers, latent errors tested every 50 ms\n", self.page("tsn/frer-ring"))
        page = self.page("tsn/link-down-and-rerouting")
        self.assertEqual(self.row(page, "Faults", "link-down"), "sw2 - sw3 is down at 100 ms for 200 ms")
        self.assertEqual(self.row(page, "Faults", "crash"), "sw6 crashes at 500 ms for 100 ms")
        self.assertEqual(self.row(page, "Faults", "rerouting"), "20 ms after a change of links; other paths 4 times")

    def test_plain_scenarios_say_nothing(self):
        page = self.page("robot-arm")
        for heading in ("Ports beyond", "Ingress", "Redundant", "Faults"):
            self.assertNotIn(heading, page)

    def test_a_node_describes_its_messages(self):
        """All ids differ, fields stand one behind the other to the end of the message, and nothing is opened or run."""
        status, said, errors = takt("node", "--describe", SCENARIOS.parent / "docs" / "nodes" / "opcua-server.json")
        self.assertEqual((status, errors), (0, ""))
        described = json.loads(said)
        messages = [message for program in described["programs"] for message in program["messages"]]
        self.assertTrue(any(message["own"] for message in messages) and not all(message["own"] for message in messages))
        self.assertEqual(len({(message["publisher_id"], message["writer_group_id"]) for message in messages}), len(messages))
        octets = {"Boolean": 1, "Byte": 1, "SByte": 1, "UInt16": 2, "Int16": 2, "UInt32": 4, "Int32": 4, "Float": 4, "UInt64": 8, "Int64": 8, "Double": 8}
        for message in messages:
            at = 20
            for field in message["fields"]:
                self.assertEqual(field["offset"], at)
                at += field["count"] * octets[field["type"]]
            self.assertEqual(message["octets"], at)

    def test_objectives_of_instances_are_refused_for_scenarios(self):
        for objective in ("latency", "entries"):
            status, _, errors = takt("schedule", SCENARIOS / "tsn" / "automatic-gates.json", "--objective", objective)
            self.assertEqual(status, 2)
            self.assertIn("expected an instance", errors)

    def test_a_scheduled_scenario_changes(self):
        """What is written is what the command says: the plant afterwards is taken as it is, and the way there passes as a scenario of its own."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            cell = {"name": "cell", "duration": "10ms", "network": {"generate": [{"topology": "ring", "switches": 4, "forwarding_delay": "1us"}]}, "gates": {"plan": "auto", "classes": [6]},
                    "streams": [{"name": name, "from": "h1", "to": to, "payload": "100B", "every": "500us", "offset": "auto", "pcp": 6} for name, to in (("a", "h2"), ("b", "h3"))]}
            (folder / "cell.json").write_text(json.dumps(cell))
            coming = {"streams": [{"name": "c", "from": "h4", "to": "h2", "payload": "400B", "every": "1ms", "offset": "auto", "pcp": 6}], "require": [{"stream": "c", "latency": "40us"}]}
            (folder / "c.json").write_text(json.dumps(coming))
            files = [folder / each for each in ("scheduled.json", "changed.json", "plant.json", "transition.json")]
            self.assertEqual(takt("schedule", folder / "cell.json", "--out", files[0])[0], 0)
            change = ("schedule", folder / "cell.json", "--to", files[0], "--add", folder / "c.json", "--remove", "b", "--fail", "sw1>sw2", "--lead", "2ms", "--at", "5ms")
            status, said, errors = takt(*change, "--out", files[1], "--plant", files[2], "--transition", files[3], "--format", "json")
            self.assertEqual((status, errors), (0, ""))
            answer = json.loads(said)
            self.assertEqual(answer["verdict"], "changed")
            self.assertEqual({each["stream"]: each["what"] for each in answer["changes"]}, {"a": "moves", "b": "goes", "c": "comes"})
            self.assertEqual(answer["at_ps"], 5_000_000_000)
            for each in answer["lists"]:
                self.assertGreaterEqual(each["holds_from_ps"] - each["written_ps"], 2_000_000_000)
                self.assertEqual(each["holds_from_ps"] % each["cycle_ps"], 0)
                self.assertEqual(sum(entry["for_ps"] for entry in each["entries"]), each["cycle_ps"])
            # Its script is what the table says.
            script = json.loads(files[3].read_text())["script"]
            self.assertEqual([f"{each['set_gates']['node']} to {each['set_gates']['to']}" for each in script], [each["port"] for each in answer["lists"]])
            for each in files[1], files[3]:
                status, said, _ = takt("run", each, "--format", "json")
                self.assertEqual(status, 0, said)
            streams = json.loads(said)["streams"]
            self.assertEqual([(streams[each]["lost"], streams[each]["delivered"] > 2) for each in ("a moved", "c")], [(0, True)] * 2)
            self.assertEqual({stream["name"] for stream in json.loads(files[2].read_text())["streams"]}, {"a", "c"})
            # The next change starts from there; the plant alone goes over what is down.
            self.assertEqual(takt("schedule", files[2], "--to", files[1], "--remove", "c")[0], 0)
            status, said, _ = takt("schedule", files[2])
            self.assertEqual(status, 4)
            self.assertIn("goes over what is down from the start on", said)
            # Without a place it is status 4, and with mistakes 2 and nothing written.
            self.assertEqual(takt("schedule", "--to", files[0], "--fail", "h2")[0], 4)
            for wrong, told in ((("--remove", "x"), "no stream with windows"), (("--lead", "0s", "--remove", "a"), "not a time for a change"), (("--at", "soon", "--remove", "a"), "not a time for a change"),
                                ((), "a change that changes nothing"), (("--remove", "a", "--plant", folder / "p.json"), "no plant that could be written"), (("--add", folder / "none.json"), "cannot be opened")):
                status, _, errors = takt("schedule", "--to", files[0], *wrong, "--out", folder / "never.json")
                self.assertEqual(status, 2)
                self.assertIn(told, errors)
            self.assertFalse((folder / "never.json").exists())
            for wrong, told in (((), "nothing to schedule"), ((folder / "cell.json", "--add", folder / "c.json"), "a change without a schedule"), ((folder / "cell.json", "--at", "1ms"), "a transition of what is no scenario"),
                                ((folder / "cell.json", "--to", files[0], "--remove", "b", "--objective", "slack"), "an option that a change of a scenario does not have")):
                status, _, errors = takt("schedule", *wrong)
                self.assertEqual(status, 2)
                self.assertIn(told, errors)


if __name__ == "__main__":
    TAKT = os.path.abspath(sys.argv[1])
    SCENARIOS = pathlib.Path(sys.argv[2]) / "scenarios"
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
