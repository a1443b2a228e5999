#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""takt verify ends: within its budget, within a second of Ctrl-C, and within memory that does not grow with requirements times nodes.

usage: verify_command_test.py TAKT SOURCE_FOLDER [unittest options]
"""
import json
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest

TAKT = ""
SOURCE = pathlib.Path()


def cpu_seconds(pid):
    """Of a process that lives: user and system."""
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def measured(*arguments):
    """Exit status, standard output, CPU seconds and the greatest size in memory, in MB."""
    with tempfile.TemporaryFile("w+") as out:
        process = subprocess.Popen([TAKT, *map(str, arguments)], stdout=out, stderr=subprocess.DEVNULL)
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        return process.returncode, out.read(), used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


class Ends(unittest.TestCase):
    # A queue that grows with the duration: each frame waits for more frames than the one before. Twice the duration took six times the time.
    def test_twice_the_duration_takes_twice_as_long(self):
        file = SOURCE / "scenarios/clocks/two-sources-and-a-gate.json"
        times = []
        for duration in ("2s", "4s"):
            status, out, seconds, _ = measured("verify", file, "--set", f"duration={duration}", "--format", "json", "--budget", "20")
            self.assertIn(status, (0, 1, 4))
            self.assertTrue(json.loads(out)["requirements"])
            times.append(seconds)
        self.assertLess(times[1], 3 * times[0], times)

    def test_the_budget_holds_for_all_of_it(self):
        file = SOURCE / "scenarios/clocks/two-sources-and-a-gate.json"
        _, _, one_run, _ = measured("run", file, "--set", "duration=2s", "--quiet")
        _, _, seconds, _ = measured("verify", file, "--set", "duration=2s", "--budget", "0", "--quiet")
        self.assertLess(seconds, 2 * one_run + 0.5)

    def test_ctrl_c_ends_it_within_a_second(self):
        # What takes longest: runs of a long scenario; analyses; states of the handshake.
        for name in ("clocks/two-sources-and-a-gate", "clocks/hot-standby", "applications/dds", "findings/paper-start-in-ready-S2", "first-cell"):
            for wait in (0.3, 1.5):
                with self.subTest(name=name, wait=wait):
                    process = subprocess.Popen([TAKT, "verify", str(SOURCE / f"scenarios/{name}.json"), "--budget", "100000", "--set", "seed=3"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
                    before = 0.0
                    while process.poll() is None and before < wait:
                        time.sleep(0.05)
                        before = cpu_seconds(process.pid)
                    if process.poll() is None:
                        process.send_signal(signal.SIGINT)
                    process.stdout.read()
                    _, status, used = os.wait4(process.pid, 0) if process.returncode is None else (0, 0, None)
                    process.stdout.close()
                    if used is None:
                        continue
                    process.returncode = os.waitstatus_to_exitcode(status)
                    self.assertIn(process.returncode, (0, 1, 4, 130))
                    self.assertLess(used.ru_utime + used.ru_stime - before, 1.0)

    # A thousand nodes: each requirement kept four copies of the scenario, 13 to 15 MB.
    def test_many_requirements_in_a_large_network(self):
        for count, most in ((300, 300), (1000, 400)):
            with tempfile.TemporaryDirectory(prefix="takt-many-") as folder:
                file = pathlib.Path(folder) / "many.json"
                file.write_text(subprocess.run([sys.executable, str(SOURCE / "tests/findings/many-requirements.py"), str(count)], capture_output=True, text=True, check=True).stdout, encoding="utf-8")
                status, out, _, megabytes = measured("verify", file, "--budget", "0", "--format", "json")
                self.assertEqual(status, 0)
                self.assertEqual(len(json.loads(out)["requirements"]), count)
                self.assertLess(megabytes, most)


class Says(unittest.TestCase):
    def verified(self, file, *arguments):
        status, out, _, _ = measured("verify", SOURCE / file, "--format", "json", *arguments)
        return status, json.loads(out)

    # Two cycles of the halt of six drives: behind the publication of the drive that is called, and of the master that has just published.
    def test_the_worst_halt_of_six_drives_is_found(self):
        status, report = self.verified("tests/findings/halt-of-six-drives.json")
        self.assertEqual(status, 1)
        halt = next(each for each in report["requirements"] if "halt" in each["text"])
        self.assertEqual(halt["verdict"], "refuted")
        self.assertGreater(halt["adversarial_ps"], 2_150_000_000)

    # With a cycle that meets the limit all is proved: the handshake for every number of slaves.
    def test_six_drives_pass(self):
        status, report = self.verified("tests/findings/halt-of-six-drives.json", "--set", "/programs/0/cycle=800us")
        self.assertEqual(status, 0)
        self.assertEqual({each["verdict"] for each in report["requirements"]}, {"pass"})

    def test_why_the_search_ended(self):
        _, report = self.verified("tests/findings/waits-before-it-meets.json")
        for each in report["requirements"]:
            self.assertIn(each["ended"], ("bound_reached", "all_meetings"))
        page = measured("verify", SOURCE / "tests/findings/waits-before-it-meets.json")[1]
        self.assertIn("to find the worst: the worst found reaches the bound", page)
        _, report = self.verified("tests/findings/halt-of-six-drives.json", "--budget", "0")
        self.assertEqual({each["ended"] for each in report["requirements"]}, {"budget"})

    def test_violations_that_are_reported_only(self):
        status, report = self.verified("scenarios/findings/paper-one-runs-before-all-ready-S1.json")
        self.assertEqual(status, 0)
        line = next(each for each in report["requirements"] if "reported only" in each["text"])
        self.assertEqual(line["verdict"], "reported")
        self.assertGreater(line["violations"], 0)


if __name__ == "__main__":
    TAKT = sys.argv[1]
    SOURCE = pathlib.Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
