# SPDX-License-Identifier: Apache-2.0
"""What --certificate writes of a proof by clauses is read again by somebody else: each axiom is tried out with all starts, each step replayed.

  certificate_test.py TAKT
"""
import itertools
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

TAKT = sys.argv[1]
US = 1_000_000
LENGTHS = {"short": 1, "long": 10, "other": 1}
LINKS = ["h0>b0", "b0>b1", "b1>b2", "b2>b3", "b3>h3"]


def instance(period):
    """A frame of 1 us and one of 10 us over five links, bridges of 1 us: on each link they are 9 us further apart, so they forbid each other 47 us of phases. Below 48 us a third one has no place."""
    nodes = [{"name": n, "bridge": n[0] == "b"} for n in ["h0", "b0", "b1", "b2", "b3", "h3"]]
    links = [{"name": l, "from": l[:2], "to": l[3:], "rate": 10**9, "forwarding": US if l[3] == "b" else 0} for l in LINKS]
    streams = [{"name": n, "talker": "h0", "listeners": ["h3"], "octets": 125 * l, "period": period, "latency": (5 * l + 4) * US} for n, l in LENGTHS.items()]
    return {"format": "schedule-problem-1", "name": "three", "model": {"strict": True, "preamble": 0, "gap": 0}, "nodes": nodes, "links": links, "streams": streams}


def meet(period, a, u_a, b, u_b):
    """Nobody waits: a stream starts on the i-th link i (length + 1) us after it has begun."""
    for i in range(len(LINKS)):
        apart = (u_b + i * (LENGTHS[b] + 1) * US - u_a - i * (LENGTHS[a] + 1) * US) % period
        if apart < LENGTHS[a] * US or period - apart < LENGTHS[b] * US:
            return True
    return False


class Clausal(unittest.TestCase):
    def decide(self, period):
        with tempfile.TemporaryDirectory(prefix="takt-certificate-") as folder:
            folder = pathlib.Path(folder)
            (folder / "p.json").write_text(json.dumps(instance(period)), encoding="utf-8")
            done = subprocess.run([TAKT, "schedule", folder / "p.json", "--certificate", folder / "c.json"], capture_output=True, text=True, check=False)
            return done.returncode, json.loads((folder / "c.json").read_text(encoding="utf-8")) if done.returncode == 1 else None

    def setUp(self):
        if "without clausal proofs" in subprocess.run([TAKT, "--version"], capture_output=True, text=True, check=True).stdout:
            self.skipTest("takt was built without CaDiCaL")

    def test_half_a_us_more_is_enough(self):
        self.assertEqual(self.decide(48 * US)[0], 0)

    def test_the_proof_is_one(self):
        period = 47 * US + US // 2
        status, proof = self.decide(period)
        self.assertEqual((status, proof["kind"]), (1, "clausal"))
        self.assertEqual(set(proof["streams"]), set(LENGTHS))
        anchor, thresholds = proof["anchor"], proof["thresholds"]

        def holds(literal, starts):
            stream, _, modulus, at = thresholds[abs(literal) - 1]
            number = starts[stream] % modulus if modulus else starts[stream]
            return (number >= at) == (literal > 0)

        # All lengths and periods are multiples of half a us, so starts are tried at these; who begins at 0 is compared with in each axiom.
        for axiom in proof["axioms"]:
            streams = sorted({thresholds[abs(literal) - 1][0] for literal in axiom} - {anchor})
            for starts in itertools.product(range(0, period, US // 2), repeat=len(streams)):
                starts = {anchor: 0, **dict(zip(streams, starts))}
                if not any(holds(literal, starts) for literal in axiom):
                    self.assertTrue(any(meet(period, a, starts[a], b, starts[b]) for a, b in itertools.combinations(starts, 2)), axiom)

        clauses = list(proof["axioms"])
        for literals, reasons in proof["steps"]:
            false = set(literals)
            left = None
            for reason in reasons:
                self.assertLess(reason, len(clauses))
                left = set(clauses[reason]) - false
                if not left:
                    break
                self.assertEqual(len(left), 1)
                literal = left.pop()
                self.assertNotIn(-literal, false, "it held already")
                false.add(-literal)
                left = {literal}
            self.assertEqual(left, set())
            clauses.append(literals)
        self.assertEqual(clauses[-1], [])

    def test_no_certificate_is_rejected(self):
        folder = pathlib.Path(__file__).parents[2] / "findings"
        for seed in "1", "3":
            done = subprocess.run([TAKT, "schedule", folder / "09999_task.csv", folder / "09999_topo.csv", "--seed", seed],
                                  capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stderr), (1, ""))
            self.assertIn("infeasible (clausal)", done.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
