#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What takt export writes as uadp, decoded by node-opcua, whose codec is made from OPC UA's schemas: it reads every octet, encodes them again alike, and reads what our own independent
reader (tests/frontends/cli/pubsub_configuration.py) reads. Skipped where node-opcua cannot be had.

usage: pubsub_configuration_test.py TAKT BUILD_FOLDER SOURCE_FOLDER
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
sys.path += [str(HERE), str(HERE.parent.parent.parent / "frontends" / "cli")]
import opcua_server_test as client  # noqa: E402
import pubsub_configuration  # noqa: E402

TAKT = ""
SOURCE = pathlib.Path()


def named(value, name):
    """A member of a structure as node-opcua has it: "writerGroupId" for "WriterGroupId"."""
    return value.get(name[0].lower() + name[1:])


def all_of(value, name):
    """An array as node-opcua's JSON has it: absent if it is null."""
    return value.get(name) or []


class Decoded(unittest.TestCase):
    def same(self, ours, theirs, *names):
        for name in names:
            self.assertEqual(named(theirs, name), ours[name], name)

    def compare(self, ours, theirs):
        self.assertEqual([each["name"] for each in all_of(theirs, "publishedDataSets")], [each["Name"] for each in ours["PublishedDataSets"]])
        for our, their in zip(ours["PublishedDataSets"], all_of(theirs, "publishedDataSets")):
            self.assertEqual([(each["name"], each["builtInType"]) for each in their["dataSetMetaData"]["fields"]], [(each["Name"], each["BuiltInType"]) for each in our["DataSetMetaData"]["Fields"]])
            version = their["dataSetMetaData"]["configurationVersion"]
            self.assertEqual((version["majorVersion"], version["minorVersion"]), (our["DataSetMetaData"]["MajorVersion"], our["DataSetMetaData"]["MinorVersion"]))
            self.assertEqual(len(their["dataSetSource"]["publishedData"]), len(our["DataSetSource"]["PublishedData"]))
        self.assertEqual(len(theirs["connections"]), len(ours["Connections"]))
        for our, their in zip(ours["Connections"], theirs["connections"]):
            self.same(our, their, "Name", "TransportProfileUri")
            self.assertEqual(their["address"]["url"], our["Address"]["Url"])
            self.assertEqual(len(all_of(their, "writerGroups")), len(our["WriterGroups"]))
            self.assertEqual(len(all_of(their, "readerGroups")), len(our["ReaderGroups"]))
            for group, other in zip(our["WriterGroups"], all_of(their, "writerGroups")):
                self.same(group, other, "Name", "WriterGroupId", "PublishingInterval", "HeaderLayoutUri")
                self.same(group["MessageSettings"], other["messageSettings"], "GroupVersion", "SamplingOffset", "PublishingOffset")
                self.writers += len(group["DataSetWriters"])
                for writer, its in zip(group["DataSetWriters"], other["dataSetWriters"], strict=True):
                    self.same(writer, its, "Name", "DataSetWriterId", "DataSetName", "KeyFrameCount")
                    self.same(writer["MessageSettings"], its["messageSettings"], "ConfiguredSize", "NetworkMessageNumber", "DataSetOffset")
            for group, other in zip(our["ReaderGroups"], all_of(their, "readerGroups")):
                for reader, its in zip(group["DataSetReaders"], other["dataSetReaders"], strict=True):
                    self.same(reader, its, "Name", "WriterGroupId", "DataSetWriterId", "MessageReceiveTimeout")
                    self.readers += 1

    def test_every_scenario_with_programs(self):
        self.writers = self.readers = files = 0
        for scenario in sorted([*(SOURCE / "scenarios").glob("*.json"), *(SOURCE / "scenarios" / "programs").glob("*.json")]):
            if scenario.name.endswith(".schema.json") or '"programs"' not in scenario.read_text(encoding="utf-8"):
                continue
            with self.subTest(scenario.name), tempfile.TemporaryDirectory() as folder:
                done = subprocess.run([TAKT, "export", "uadp", scenario, "--lossy", "--out", folder], capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 0, done.stderr)
                for path in sorted(pathlib.Path(folder).glob("*.uadp.bin"))[:3]:
                    read = subprocess.run(["node", HERE / "pubsub_configuration.js", client.MODULES, path], capture_output=True, text=True, check=True, timeout=client.PATIENCE)
                    theirs = json.loads(read.stdout)
                    self.assertEqual({key: theirs[key] for key in ("rest", "same", "type", "body")}, {"rest": 0, "same": True, "type": "UABinaryFileDataType", "body": "PubSubConfigurationDataType"})
                    self.compare(pubsub_configuration.read(path.read_bytes()), theirs["configuration"])
                    files += 1
        self.assertGreaterEqual(files, 6)
        self.assertGreaterEqual(self.writers, 6)
        self.assertGreaterEqual(self.readers, 6)


if __name__ == "__main__":
    TAKT = sys.argv.pop(1)
    can_install = client.install_client(pathlib.Path(sys.argv.pop(1)))
    SOURCE = pathlib.Path(sys.argv.pop(1)).resolve()
    if not can_install:
        print("skipped: node-opcua-client is not to be had here (node and npm, and a network at the first run)")
        sys.exit(client.SKIPPED)
    unittest.main(verbosity=2)
