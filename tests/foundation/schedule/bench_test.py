# SPDX-License-Identifier: Apache-2.0
"""The figures of tools/bench about schedules: its problems are the same at every call, and it finds in the output of takt what it counts.

  bench_test.py TAKT ROOT
"""
import json
import pathlib
import sys
import tempfile
import unittest

TAKT, ROOT = sys.argv[1], pathlib.Path(sys.argv[2])
sys.path.insert(0, str(ROOT / "tools" / "benchmark"))
sys.dont_write_bytecode = True
import schedule_bench  # noqa: E402


def cell(name, octets, period):
    """One stream over one bridge: its frame and the preamble take (octets + 8) 80 ns at 100 Mbit/s on each of two links."""
    stream = {"name": "s", "talker": "h0", "listeners": ["h1"], "period": period, "octets": octets, "latency": period}
    return schedule_bench.problem(name, 1, [0, 0], [], [stream], 10**8)


class ScheduleBench(unittest.TestCase):
    def test_a_seed_is_one_network(self):
        self.assertEqual(schedule_bench.industrial(7), schedule_bench.industrial(7))
        self.assertNotEqual(schedule_bench.industrial(7), schedule_bench.industrial(8))

    def test_counts_what_is_decided(self):
        # 1,000 octets: two times 80.64 us, 100 ns of way and 1 us of forwarding on each link. 1 ms is enough; 100 us is not.
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "inner").mkdir()
            (folder / "inner" / "possible.json").write_text(json.dumps(cell("possible", 1000, 1000 * schedule_bench.US)))
            (folder / "impossible.json").write_text(json.dumps(cell("impossible", 1000, 100 * schedule_bench.US)))
            found = {each: schedule_bench.decide(TAKT, files, "1s") for each, files in schedule_bench.folders_of(folder)}
        self.assertEqual(list(found), ["inner", folder.name])
        self.assertEqual(found["inner"][0], {"scheduled": 1, "infeasible": 0, "undecided": 0})
        self.assertEqual(found[folder.name][0], {"scheduled": 0, "infeasible": 1, "undecided": 0})
        self.assertEqual([len(times) for _, times in found.values()], [1, 1])

    def test_eight_links_fail(self):
        failed = schedule_bench.failed_links(TAKT)
        self.assertEqual([each["left_over"] for each in failed], [0] * 8)
        self.assertTrue(all(each["ms"] > 0 for each in failed))

    def test_entries(self):
        self.assertEqual(schedule_bench.within_entries(TAKT, 2), {8: 2, 16: 2})


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
