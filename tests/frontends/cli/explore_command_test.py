#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""takt explore as a user runs it: answers, exit statuses, one JSON document, Ctrl-C.

usage: explore_command_test.py TAKT SOURCE_FOLDER [unittest options]
"""
import json
import os
import pathlib
import pty
import signal
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent.parent / "support"))
import processes  # noqa: E402

TAKT = ""
SCENARIOS = pathlib.Path()

TWO_PROGRAMS = """{"name": "two", "duration": "10ms", "network": {
  "nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]},
  "programs": [{"name": "first", "variant": "paper", "master": "a", "slaves": ["b"], "cycle": "1ms"},
               {"name": "second", "master": "b", "slaves": ["a"], "cycle": "1ms"}]}
"""
NAMED = ("variant", "slaves", "faults", "states", "depth", "cpu_s", "exhausted", "properties")


def explore(*arguments, timeout=1000):
    done = subprocess.run([TAKT, "explore", *map(str, arguments)], capture_output=True, text=True, timeout=timeout, check=False)
    return done.returncode, done.stdout, done.stderr


class Answers(unittest.TestCase):
    def test_one_group_is_one_object(self):
        status, out, err = explore("--slaves", 1, "--faults", "loss,crash", "--format", "json")
        answer = json.loads(out)
        self.assertEqual((status, err), (0, ""))
        self.assertEqual([key for key in NAMED if key not in answer], [])
        self.assertNotIn("program", answer)
        self.assertEqual(answer["faults"], ["loss", "crash"])
        self.assertEqual({answer["properties"][p] for p in ("S1", "S2", "S3", "S4", "S5", "F1", "L1")}, {"holds"})
        self.assertEqual({answer["properties"][p] for p in ("all_running", "silence", "HaltedToReady")}, {"reached"})

    def test_silence_is_left_out_where_nobody_can_be_silent(self):
        for faults in ((), ("--faults", "loss")):
            _, out, _ = explore("--slaves", 1, *faults, "--format", "json")
            self.assertNotIn("F1", json.loads(out)["properties"])
            self.assertNotIn("F1 ", explore("--slaves", 1, *faults)[1])

    def test_roles_are_explored_with_their_candidates(self):
        status, out, err = explore("--slaves", 1, "--candidates", 2, "--calls", 1, "--format", "json")
        answer = json.loads(out)
        self.assertEqual((status, err, answer["states"], answer["candidates"]), (0, "", 12709, 2))
        self.assertEqual(answer["properties"]["B1"], "holds")
        self.assertNotIn("B1", json.loads(explore("--slaves", 1, "--calls", 1, "--format", "json")[1])["properties"])
        for wrong, why in ((("--faults", "forge"), "loss, crash, restart and timeout"), (("--variant", "paper"), "paper knows no roles"), (("--joining",), "join by themselves")):
            status, _, err = explore("--slaves", 1, "--candidates", 2, *wrong)
            self.assertEqual((status, why in err), (2, True), err)

    def test_replays_are_explored_signed_and_not(self):
        status, out, err = explore("--slaves", 1, "--calls", 1, "--faults", "replay", "--signed", "--format", "json")
        answer = json.loads(out)
        self.assertEqual((status, err, answer["states"], answer["signed"], answer["key_changes"]), (0, "", 5809, True, 1))
        self.assertEqual({answer["properties"][p] for p in ("S1", "S5", "L1", "R1")}, {"holds"})
        status, out, _ = explore("--slaves", 1, "--calls", 0, "--faults", "replay,restart", "--fault-budget", 2)
        self.assertEqual(status, 1)
        self.assertIn("R1 is violated: a word that is older than one that has come of its sender moves nobody", out)
        for wrong, why in ((("--signed",), "give --faults replay, too"), (("--faults", "replay", "--variant", "paper"), "robust"), (("--faults", "replay", "--network", "channels"), "on registers"),
                           (("--faults", "replay,forge", "--signed"), "without the key"), (("--faults", "replay", "--key-changes", 1), "those of --signed"), (("--faults", "replay", "--joining"), "one group"),
                           (("--faults", "replay,duplicate"), "leave duplicate and reorder out")):
            status, _, err = explore("--slaves", 1, *wrong)
            self.assertEqual((status, why in err), (2, True), err)

    def test_roles_within_another_group(self):
        status, out, err = explore("--slaves", 1, "--nested", "--candidates", 1, "--calls", 1, "--format", "json")
        answer = json.loads(out)
        self.assertEqual((status, err, answer["states"], answer["nested"], answer["candidates"]), (0, "", 5764, True, 1))
        self.assertIn("1 master and 1 slave, the last of them master of 2 inner roles for 2 candidates", explore("--slaves", 1, "--nested", "--inner-slaves", 2, "--candidates", 2, "--calls", 0)[1])
        for wrong, why in (((1, "--candidates", 3), "at most 2 candidates"), ((3, "--candidates", 1), "at most 2 outer slaves"), ((1, "--candidates", 1, "--starts-again"), "started by the one outside")):
            status, _, err = explore("--nested", "--slaves", *wrong)
            self.assertEqual((status, why in err), (2, True), err)

    def test_programs_of_a_tree_are_explored_together(self):
        hosts = {name: {"kind": "host"} for name in "mca"} | {"b": {"kind": "host", "offers": ["x"]}, "sw": {"kind": "switch"}}
        tree = {"name": "tree", "duration": "1ms", "network": {"nodes": hosts, "links": [{"ends": [name, "sw"]} for name in "mcab"]},
                "programs": [{"name": "line", "master": "m", "slaves": ["a", "c"], "cycle": "1ms"},
                             {"name": "cell", "within": "line", "master": "c", "roles": [{"name": "r", "skill": "x"}], "cycle": "1ms"}],
                "script": [{"at": "0s", "program": "line", "call": "Start"}]}
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "tree.json"
            path.write_text(json.dumps(tree))
            status, out, err = explore(path, "--calls", 0)
        self.assertEqual((status, err), (1, ""))  # without a call only some transitions are reached
        self.assertIn("1 master and 2 slaves, the last of them master of 1 inner role for 1 candidate;", out)
        self.assertNotIn("violated", out)
        self.assertIn("trees of two groups can be explored, not of 3", explore(SCENARIOS / "programs" / "nested-cell.json", "--calls", 0)[2])

    def test_paper_is_violated(self):
        status, out, _ = explore("--slaves", 1, "--variant", "paper", "--format", "json")
        self.assertEqual(status, 1)
        self.assertEqual(json.loads(out)["properties"]["S1"], "violated")

    def test_a_violation_is_explained(self):
        group = ("--slaves", 1, "--variant", "paper", "--no-finish")
        violations = json.loads(explore(*group, "--format", "json")[1])["violations"]
        self.assertEqual([(each["property"], each["ends"]) for each in violations], [("S1", "violation"), ("S2", "violation"), ("S3", "violation"), ("L1", "standstill"), ("L1", "cycle")])
        for each in violations:
            self.assertEqual([step["step"] for step in each["steps"]], list(range(1, len(each["steps"]) + 1)))
            self.assertNotEqual(each["why"], [])
            for step in each["steps"]:
                self.assertEqual(list(step["states"]), each["participants"])
                for belief in step["knowledge"]:
                    self.assertEqual((belief["word"] == belief["now"], belief["now"]), (belief["is_true"], step["states"][belief["of"]]))
        last = violations[0]["steps"][-1]
        self.assertEqual([(each["who"], each["heard"]) for each in last["knowledge"] if each["is_cause"]], [("master", "Suspended")])
        brief, full = explore(*group)[1], explore(*group, "--explain")[1]
        why = "      - master: all that it knows of slave 1: Suspended, heard before the first step, and so slave 1 still is.\n"
        note = "slave 1 takes master for Suspended, heard before the first step; it is Ready since step 1\n"
        self.assertEqual((why in brief, why in full, note in brief, note in full), (True, True, False, True))
        self.assertEqual(json.loads(explore("--slaves", 1, "--calls", 1, "--format", "json")[1])["violations"], [])

    def test_several_programs_are_one_array(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "two.json"
            path.write_text(TWO_PROGRAMS, encoding="utf-8")
            status, out, _ = explore(path, "--format", "json")
        answers = json.loads(out)
        self.assertEqual(status, 1)
        self.assertEqual([(each["program"], each["variant"]) for each in answers], [("first", "paper"), ("second", "robust")])

    def test_one_program_is_one_object(self):
        status, out, _ = explore(SCENARIOS / "direct-link.json", "--format", "json")
        self.assertEqual(status, 0)
        self.assertIn("program", json.loads(out))

    def test_networks_and_subscriptions(self):
        for options in (("--network", "channels=1"), ("--network", "channels"), ("--subscription", "all-to-all"), ("--beginnings", "switched-on", "--calls", 6, "--no-finish")):
            status, out, _ = explore("--slaves", 1, "--faults", "loss", *options, "--format", "json")
            answer = json.loads(out)
            self.assertNotIn("violated", answer["properties"].values(), options)
            self.assertTrue(answer["exhausted"], options)
        self.assertEqual(answer["beginnings"], "switched-on")

    def test_nested_groups_and_joining_slaves(self):
        for options, inner, joining in ((("--nested",), 1, False), (("--nested", "--inner-slaves", 2, "--calls", 1), 2, False), (("--joining", "--faults", "crash,restart"), 0, True),
                                        (("--nested", "--joining", "--calls", 1), 1, True)):
            status, out, err = explore("--slaves", 1, *options, "--format", "json")
            answer = json.loads(out)
            self.assertEqual((status, err), (0, ""), options)
            self.assertEqual([key for key in NAMED if key not in answer], [])
            self.assertEqual((answer["nested"], answer["inner_slaves"], answer["joining"]), (inner > 0, inner, joining), options)
            self.assertTrue(answer["exhausted"])
        self.assertIn("the last inner slave joins", explore("--slaves", 1, "--nested", "--joining", "--calls", 1)[1])

    def test_what_trees_cannot_do_is_refused(self):
        for options in (("--nested", "--variant", "paper"), ("--joining", "--network", "channels=1"), ("--nested", "--subscription", "all-to-all"), ("--joining", "--faults", "reorder"),
                        ("--inner-slaves", 1), ("--nested", "--inner-slaves", 3), ("--nested", "--out", "nowhere")):
            status, out, err = explore("--slaves", 1, *options)
            self.assertEqual((status, out), (2, ""), options)
            self.assertNotEqual(err, "", options)
        self.assertEqual(explore("--slaves", 3, "--nested")[0], 2)
        self.assertEqual(explore(SCENARIOS / "direct-link.json", "--nested")[0], 2)

    def test_octets_a_state(self):
        _, out, _ = explore("--slaves", 3, "--faults", "loss", "--format", "json")
        self.assertLessEqual(json.loads(out)["octets_per_state"], 64)

    def test_mistakes(self):
        for arguments in ((), ("--slaves", 13), ("--slaves", 1, "--network", "channels=9"), ("--slaves", 1, "--network", "pigeons"),
                          ("--slaves", 4, "--subscription", "all-to-all"), ("--slaves", 1, "--faults", "fire"), ("nowhere.json",)):
            status, out, err = explore(*arguments)
            self.assertEqual((status, out), (2, ""), arguments)
            self.assertNotEqual(err, "", arguments)


class Interruption(unittest.TestCase):
    LONG = ("--slaves", "3", "--calls", "4", "--faults", "loss,crash,restart", "--fault-budget", "3")

    def test_a_partial_verdict_after_ctrl_c(self):
        with subprocess.Popen([TAKT, "explore", *self.LONG, "--format", "json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as running:
            processes.wait_for_handler(running, signal.SIGINT)
            processes.wait_for_work(running, 1)
            running.send_signal(signal.SIGINT)
            out, _ = running.communicate(timeout=1000)
        answer = json.loads(out)
        self.assertEqual(running.returncode, 130)
        self.assertTrue(answer["interrupted"])
        self.assertFalse(answer["exhausted"])
        self.assertGreater(answer["states"], 0)
        self.assertEqual(answer["properties"]["L1"], "unknown")
        self.assertEqual(answer["properties"]["S1"], "holds")

    def test_progress_on_a_terminal(self):
        main, terminal = pty.openpty()
        with subprocess.Popen([TAKT, "explore", *self.LONG], stdout=subprocess.DEVNULL, stderr=terminal) as running:
            os.close(terminal)
            seen = b""
            while b"M states" not in seen or b"a second" not in seen or b" MB" not in seen:
                seen += os.read(main, 4096)
            running.send_signal(signal.SIGINT)
            running.wait(timeout=1000)
        os.close(main)
        self.assertIn(b"depth", seen)


if __name__ == "__main__":
    TAKT = sys.argv[1]
    SCENARIOS = pathlib.Path(sys.argv[2]) / "scenarios"
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
