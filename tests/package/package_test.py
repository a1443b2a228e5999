#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Installs the library into a folder, builds projects of their own against it, and lets the example speak to takt node.

usage: package_test.py TAKT BUILD_FOLDER COMPILER TESTS_FOLDER
"""
import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True
sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "support"))
import reservation  # noqa: E402

TAKT, BUILD, COMPILER, TESTS = (pathlib.Path(each) for each in sys.argv[1:5])
PROGRAM = {
    "name": "cell", "master": "plc", "slaves": ["robot"], "cycle": "5ms", "receive_timeout": "1000s", "initialisation": "5ms",
    "process_data": [{"name": "targets", "from": "plc", "fields": {"q": {"type": "Double", "count": 6}}},
                     {"name": "actual", "from": "robot", "fields": {"q": {"type": "Double", "count": 6}, "count": "UInt32"}}]}


def run(*command):
    done = subprocess.run([str(each) for each in command], capture_output=True, text=True, timeout=1000, check=False)
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

    def ctl(self, node, *request):
        """What `takt ctl` prints; nothing while the node does not answer."""
        return subprocess.run([TAKT, "ctl", self.folder / f"{node}.sock", *request], capture_output=True, text=True, timeout=1000, check=False).stdout

    def test_the_robot_follows_its_master(self):
        first = reservation.ports()
        ports = {"plc": first, "robot": first + 1}
        files = {}
        for name, port in ports.items():
            other = next(each for each in ports if each != name)
            config = {"node": name, "program": PROGRAM, "transport": {"kind": "udp", "port": port, "destinations": [f"127.0.0.1:{ports[other]}"]},
                      "control": str(self.folder / f"{name}.sock"), "duration": "600s", "log_values_every": "0ns"}
            if name == "plc":
                config |= {"sources": [{"data_set": "targets", "kind": "constant", "value": 8}]}
            files[name] = self.folder / f"{name}.json"
            files[name].write_text(json.dumps(config), encoding="utf-8")
        robot = subprocess.Popen([self.folder / "build" / "robot", files["robot"]], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(robot.kill)
        plc = subprocess.Popen([TAKT, "node", files["plc"]], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(plc.kill)
        # The plc starts when it has heard its robot. Both run until the robot has come to its target.
        while '"state":"Halted"' not in self.ctl("plc", "status", "--format", "json").replace(" ", "").partition('"peers"')[2]:
            self.assertIsNone(plc.poll())
            self.assertIsNone(robot.poll())
            time.sleep(0.02)
        self.ctl("plc", "start")
        heard = []
        for line in plc.stdout:
            event = json.loads(line)
            if event["event"] == "data" and event["data_set"] == "actual":
                heard.append(event["fields"])
                if event["fields"]["q"] == [8.0] * 6:
                    break
        for process in (plc, robot):
            process.send_signal(signal.SIGTERM)
            out, err = process.communicate(timeout=1000)
            self.assertEqual(process.returncode, 0, out + err)
        self.assertGreater(len(heard), 0)
        for fields in heard:
            if fields["count"] < 50:  # then 8 - 8/2^n is exact
                self.assertEqual(fields["q"], [8 - 8 * 0.5 ** fields["count"]] * 6)
        self.assertEqual([f["count"] for f in heard], sorted(f["count"] for f in heard))
        self.assertEqual(heard[-1]["q"], [8.0] * 6)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
