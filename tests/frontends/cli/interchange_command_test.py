#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""takt export and takt import as a user runs them.

usage: interchange_command_test.py TAKT SOURCE_DIR
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
import pubsub_configuration

TAKT, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
SCENARIOS = SOURCE / "scenarios"


def takt(*arguments):
    done = subprocess.run([TAKT, *map(str, arguments)], capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


def digest(scenario):
    with tempfile.TemporaryDirectory() as folder:
        status, page, error = takt("run", scenario, "--duration", "20ms", "--format", "json")
        assert status in (0, 1), error
        return json.loads(page)["digest"]


class Interchange(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.out = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def test_out_and_in_again_is_the_same_run(self):
        scenario = SCENARIOS / "clocks" / "gates-with-gptp.json"
        status, _, error = takt("export", "linux", scenario, "--out", self.out / "scripts")
        self.assertEqual(status, 0, error)
        files = sorted((self.out / "scripts").iterdir())
        status, _, error = takt("import", "linux", *files, "--into", scenario, "-o", "never-open=accept", "--out", self.out / "again.json")
        self.assertEqual(status, 0, error)
        self.assertEqual(digest(scenario), digest(self.out / "again.json"))

    def test_a_capture_of_a_run_gives_its_talkers_back(self):
        """Talkers on a grid, at hosts without delays: a capture of their run, into the bare network, is the same run."""
        plant = {"name": "plant", "duration": "20ms", "network": {"nodes": {name: {"kind": "switch" if name == "sw" else "host"} for name in ("a", "b", "c", "sw")},
                 "links": [{"ends": ["a", "sw"]}, {"ends": ["b", "sw"]}, {"ends": ["c", "sw"], "rate": "100Mbps"}]}}
        streams = [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "500us", "offset": "0s", "pcp": 5},
                   {"name": "t", "from": "b", "to": "c", "payload": "300B", "every": "1ms", "offset": "100us", "pcp": 3, "vlan": 7},
                   {"name": "u", "from": "c", "to": "a", "payload": "60B", "every": "250us", "offset": "30us", "encapsulation": "ethernet"}]
        (self.out / "bare.json").write_text(json.dumps(plant))
        (self.out / "plant.json").write_text(json.dumps(plant | {"streams": streams}))
        self.assertEqual(takt("run", self.out / "plant.json", "--pcap", "all", "--out", self.out / "run")[0], 0)
        self.assertEqual(takt("export", "linux", self.out / "plant.json", "--out", self.out / "names")[0], 0)
        status, _, error = takt("import", "pcap", self.out / "run" / "all.pcapng", self.out / "names" / "takt.names.json", "--into", self.out / "bare.json", "--out", self.out / "again.json")
        self.assertEqual(status, 0, error)
        self.assertNotIn("lost:", error)
        self.assertEqual(digest(self.out / "plant.json"), digest(self.out / "again.json"))
        self.assertNotEqual(digest(self.out / "plant.json"), digest(self.out / "bare.json"))

    def test_nothing_is_written_if_something_is_lost(self):
        scenario = SCENARIOS / "tsn" / "ats.json"
        status, page, error = takt("export", "linux", scenario, "--out", self.out / "scripts")
        self.assertEqual((status, page), (2, ""))
        self.assertIn("ATS", error)
        self.assertFalse((self.out / "scripts").exists())
        status, _, error = takt("export", "linux", scenario, "--out", self.out / "scripts", "--lossy")
        self.assertEqual(status, 0, error)
        self.assertIn("# cannot be said: ", (self.out / "scripts" / "sw3.sh").read_text())

    def test_validation_is_refused_where_it_cannot_be(self):
        scenario = SCENARIOS / "tsn" / "preemption-on-a-line.json"
        status, page, error = takt("export", "linux", scenario, "--validate", self.out, "--out", self.out / "scripts")
        self.assertEqual((status, page), (2, ""))
        self.assertIn("expected yang", error)
        status, page, error = takt("export", "yang", scenario, "--validate", self.out / "nowhere", "--out", self.out / "data")
        self.assertEqual((status, page), (2, ""))
        has_libyang = "with libyang" in takt("--version")[1]
        self.assertIn("expected a folder with YANG modules" if has_libyang else "install libyang2-dev", error)
        status, page, error = takt("export", "yang", scenario, "--validate", self.out, "--out", self.out / "data")
        self.assertEqual((status, page), (2, ""))
        self.assertIn("module ietf-interfaces" if has_libyang else "install libyang2-dev", error)
        self.assertFalse((self.out / "data").exists())

    def test_one_node_goes_to_standard_output(self):
        status, page, _ = takt("export", "linux", SCENARIOS / "robot-arm.json", "--node", "sw1")
        self.assertEqual(status, 0)
        self.assertIn("==> sw1.sh <==", page)
        self.assertNotIn("==> robot.sh <==", page)
        status, _, error = takt("export", "linux", SCENARIOS / "robot-arm.json", "--node", "sw")
        self.assertEqual(status, 2)
        self.assertIn("unknown node", error)

    def test_mistakes_have_places_and_nothing_is_written(self):
        wrong = self.out / "sw1.sh"
        wrong.write_text("tc qdisc replace dev swp0 root taprio num_tc 99\ntc qdisc replace swp0 root\n")
        status, page, error = takt("import", "linux", wrong, "--out", self.out / "x.json")
        self.assertEqual((status, page), (2, ""))
        self.assertIn("sw1.sh:1:46: error", error)
        self.assertIn("sw1.sh:2:18: error", error)
        self.assertFalse((self.out / "x.json").exists())

    def test_pubsub_configurations_say_what_is_on_the_wire(self):
        scenario = SCENARIOS / "robot-arm.json"
        status, _, error = takt("export", "uadp", scenario, "--out", self.out / "uadp")
        self.assertEqual((status, error), (0, ""))
        self.assertEqual(sorted(path.name for path in (self.out / "uadp").iterdir()), ["generator.uadp.bin", "robot.uadp.bin"])
        nodes = {path.name.split(".")[0]: pubsub_configuration.read(path.read_bytes()) for path in (self.out / "uadp").iterdir()}
        sent, heard = {}, {}
        for node, configuration in nodes.items():
            self.assertEqual([each["Name"] for each in configuration["PublishedDataSets"]], [each["Name"] for each in configuration["Connections"] if each["WriterGroups"]])
            for connection in configuration["Connections"]:
                self.assertRegex(connection["Address"]["Url"], r"^opc\.eth://([0-9a-f]{2}-){5}[0-9a-f]{2}:0\.6$")
                for group in connection["WriterGroups"]:
                    self.assertEqual((group["PublishingInterval"], group["MessageSettings"]["NetworkMessageContentMask"]), (0.2, 0x3F))   # 200 us; UADP-Periodic-Fixed
                    sent[connection["PublisherId"], group["WriterGroupId"]] = (connection["Name"], connection["Address"]["Url"], group["MessageSettings"]["GroupVersion"])
                for group in connection["ReaderGroups"]:
                    for reader in group["DataSetReaders"]:
                        heard[reader["PublisherId"], reader["WriterGroupId"]] = (connection["Name"], connection["Address"]["Url"], reader["MessageSettings"]["GroupVersion"])
                        self.assertEqual(len(reader["SubscribedDataSet"]["TargetVariables"]), len(reader["DataSetMetaData"]["Fields"]))
        self.assertEqual(sent, heard)   # two nodes: what the one sends the other hears
        self.assertEqual({name for name, _, _ in sent.values()}, {"trajectory/state/generator", "trajectory/state/robot", "trajectory/target", "trajectory/actual"})
        # The state of robust: README of src/protocol/wire.
        fields = next(each for each in nodes["robot"]["PublishedDataSets"] if "state" in each["Name"])["DataSetMetaData"]["Fields"]
        self.assertEqual([each["BuiltInType"] for each in fields], [6, 7, 7, 7, 7, 3, 3])
        status, _, error = takt("export", "uadp", SCENARIOS / "tsn" / "ats.json")
        self.assertEqual(status, 2)
        self.assertIn("no Programs", error)

    def test_names_neither_act_nor_lead_out(self):
        findings = SOURCE / "tests" / "findings" / "export"
        inside = self.out / "a" / "b"
        status, page, error = takt("export", "svg", findings / "name-leads-out.json", "--out", inside)
        self.assertEqual((status, page), (2, ""), error)
        self.assertEqual(list(self.out.rglob("*.svg")), [])
        for name in ("stream-is-a-command", "stream-is-a-command-lossy", "name-hides-the-verdict"):
            for command in (("export", "linux", findings / f"{name}.json", "--lossy"), ("run", findings / f"{name}.json"), ("check", findings / f"{name}.json")):
                status, page, error = takt(*command)
                self.assertEqual((status, page), (2, ""), name)
                self.assertIn("a control character in a name", error)
                self.assertNotIn("\x1b", error)

    def test_entries_of_bridges_are_written_once(self):
        """Two streams to one host: one entry, that can be set again."""
        status, _, error = takt("export", "linux", SOURCE / "tests" / "findings" / "export" / "two-streams-to-one-host.json", "--out", self.out)
        self.assertEqual(status, 0, error)
        lines = (self.out / "sw.sh").read_text().splitlines()
        entries = [line for line in lines if line.startswith("bridge fdb")]
        self.assertEqual(len(entries), len(set(entries)))
        self.assertTrue(entries and all(line.startswith("bridge fdb replace") for line in entries), entries)
        self.assertIn("ip link set dev br0 up", lines)

    def test_more_entries_than_tc_sends_are_a_loss(self):
        status, page, error = takt("export", "linux", SOURCE / "tests" / "findings" / "export" / "forty-entries.json", "--out", self.out / "scripts")
        self.assertEqual((status, page), (2, ""), error)
        self.assertIn("40 entries of a gate list of which tc sends at most 30", error)
        self.assertFalse((self.out / "scripts").exists())

    def test_names_of_interfaces_are_kept_beside_the_scenario(self):
        script = SOURCE / "tests" / "findings" / "import" / "swp5-and-swp2.sh"
        status, _, error = takt("import", "linux", f"sw={script}", "--out", self.out / "plant.json")
        self.assertEqual(status, 0, error)
        self.assertIn("swp5", json.loads((self.out / "plant.names.json").read_text())["interfaces"]["sw"])
        status, _, error = takt("export", "linux", self.out / "plant.json", "--node", "sw", "--out", self.out / "scripts")
        self.assertEqual(status, 0, error)
        status, _, error = takt("import", "linux", self.out / "scripts" / "sw.sh", self.out / "plant.names.json", "--into", self.out / "plant.json", "--out", self.out / "again.json")
        self.assertEqual(status, 0, error)
        self.assertEqual(digest(self.out / "plant.json"), digest(self.out / "again.json"))

    def test_mistakes_of_tables_are_told_at_their_lines(self):
        (self.out / "cables.csv").write_text("from,to\nplc,sw\ndrive,sw\n")
        (self.out / "streams.csv").write_text("name;from;to;payload;every\nset;plc;drive;64;1 ms\nact;drive;pls;64;1 ms\n")
        status, page, error = takt("import", "csv", self.out / "cables.csv", self.out / "streams.csv")
        self.assertEqual((status, page), (2, ""))
        self.assertIn("streams.csv:3:", error)
        self.assertNotIn("scenario.json", error)

    def test_many_files_cost_what_they_are_long(self):
        import resource
        for i in range(400):
            (self.out / f"n{i}.sh").write_text("ip link set dev eth0 up\n")
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
        status, _, error = takt("import", "linux", *sorted(self.out.glob("*.sh")), "--out", self.out / "all.json")
        self.assertEqual(status, 0, error)
        self.assertLess(max(before, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss), 400_000)   # kB; 64 MiB for each were 26 GB

    def test_settings_are_those_of_the_format(self):
        for arguments in (("-o", "gates=nowhere"), ("-o", "speed=1"), ("-o", "start=-1")):
            status, _, error = takt("export", "linux", SCENARIOS / "robot-arm.json", *arguments)
            self.assertEqual(status, 2)
            self.assertIn("expected", error)

    def test_help_lists_the_formats(self):
        for command in ("export", "import"):
            status, page, _ = takt(command, "--help")
            self.assertEqual(status, 0)
            self.assertIn("linux", page)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
