#!/usr/bin/env python3
"""Installs the library into a folder, builds projects of their own against it, and lets the example speak to takt node.

usage: package_test.py TAKT BUILD_FOLDER COMPILER TESTS_FOLDER
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

TAKT, BUILD, COMPILER, TESTS = (pathlib.Path(each) for each in sys.argv[1:5])
PROGRAM = {
    "name": "cell", "master": "plc", "slaves": ["robot"], "cycle": "5ms", "receive_timeout": "500ms", "initialisation": "5ms",
    "process_data": [{"name": "targets", "from": "plc", "fields": {"q": {"type": "Double", "count": 6}}},
                     {"name": "actual", "from": "robot", "fields": {"q": {"type": "Double", "count": 6}, "count": "UInt32"}}]}


def run(*command):
    done = subprocess.run([str(each) for each in command], capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="takt-package-")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        run("cmake", "--install", BUILD, "--component", "takt_library", "--prefix", cls.folder / "prefix")
        run("cmake", "-S", TESTS / "package" / "project", "-B", cls.folder / "build", f"-DCMAKE_PREFIX_PATH={cls.folder / 'prefix'}",
            f"-DCMAKE_CXX_COMPILER={COMPILER}", f"-DEXAMPLES={TESTS / 'examples'}")
        run("cmake", "--build", cls.folder / "build")

    def test_each_layer_stands_alone(self):
        for name in ("speed", "group", "codec", "topic"):
            run(self.folder / "build" / name)

    def test_the_examples_are_short(self):
        for example in (TESTS / "examples").glob("*.cpp"):
            self.assertLess(len(example.read_text(encoding="utf-8").splitlines()), 60, example)

    def test_the_robot_follows_its_master(self):
        ports = {"plc": 48451, "robot": 48452}
        files = {}
        for name, port in ports.items():
            other = next(each for each in ports if each != name)
            config = {"node": name, "program": PROGRAM, "transport": {"kind": "udp", "port": port, "destinations": [f"127.0.0.1:{ports[other]}"]},
                      "control": str(self.folder / f"{name}.sock"), "duration": "2s", "log_values_every": "0ns"}
            if name == "plc":
                config |= {"sources": [{"data_set": "targets", "kind": "constant", "value": 8}], "script": [{"at": "500ms", "call": "Start"}]}
            files[name] = self.folder / f"{name}.json"
            files[name].write_text(json.dumps(config), encoding="utf-8")
        robot = subprocess.Popen([self.folder / "build" / "robot", files["robot"]], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(robot.kill)
        plc = run(TAKT, "node", files["plc"])
        out, err = robot.communicate(timeout=30)
        self.assertEqual(robot.returncode, 0, out + err)
        heard = [event["fields"] for event in map(json.loads, plc.stdout.splitlines()) if event["event"] == "data" and event["data_set"] == "actual"]
        self.assertGreater(len(heard), 10)
        for fields in heard:
            if fields["count"] < 50:  # then 8 - 8/2^n is exact
                self.assertEqual(fields["q"], [8 - 8 * 0.5 ** fields["count"]] * 6)
        self.assertEqual([f["count"] for f in heard], sorted(f["count"] for f in heard))
        self.assertEqual(heard[-1]["q"], [8.0] * 6)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
