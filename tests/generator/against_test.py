#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""takt_soak --against: what differs between two builds is found and shrunk, what only moves is not. The other build is this one behind a script that changes what it says.

usage: against_test.py TAKT_SOAK TAKT TAKT_DIGEST
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOAK, TAKT, DIGEST = sys.argv[1:4]
COUNT = 12


class Against(unittest.TestCase):
    def setUp(self):
        self.kept = tempfile.TemporaryDirectory()
        self.addCleanup(self.kept.cleanup)
        self.folder = pathlib.Path(self.kept.name)

    def soak(self, program, *options, count=COUNT):
        found = self.folder / "found"
        done = subprocess.run([SOAK, "--against", program, "--count", str(count), "--jobs", "2", "--folder", found, *options], capture_output=True, text=True, check=False, timeout=600)
        return done, {path.name: path.read_text() for path in found.glob("against-*")} if found.exists() else {}

    def script(self, name, text):
        path = self.folder / name
        path.write_text(f"#!/usr/bin/env bash\n{text}\n", encoding="utf-8")
        os.chmod(path, 0o755)
        return str(path)

    def test_the_same_build(self):
        for program, options in ((TAKT, []), (DIGEST, []), (TAKT, ["--recordings"])):
            with self.subTest(program=program, options=options):
                done, files = self.soak(program, *options)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                self.assertRegex(done.stdout, rf"^{COUNT} scenarios, \d+ of them refused by one of the builds, 0 differ\n")
                self.assertEqual(files, {})

    def test_another_seed_is_found_and_shrunk(self):
        # Scenarios with an oscillator, random gaps or an operating system go another way; some are the same with every seed.
        other = self.script("takt", f'exec {TAKT} "$@" --seed 77')
        done, files = self.soak(other, count=4)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertTrue(files)
        for name, text in files.items():
            if name.endswith(".txt"):
                self.assertRegex(text, r"digest here [0-9a-f]{16}, there [0-9a-f]{16}")
        scenarios = {name: text for name, text in files.items() if name.endswith(".json")}
        number = min(scenarios, key=lambda name: int(name.split("-")[1].split(".")[0]))
        whole = subprocess.run([SOAK, "--show", number.split("-")[1].split(".")[0]], capture_output=True, text=True, check=True).stdout
        self.assertLess(len(scenarios[number]), len(whole) / 2)

    def test_recordings_in_another_order_are_the_same(self):
        # The other build says another digest, and what happens at one instant in another order.
        other = self.script("takt", f"""{TAKT} "$@" | sed 's/digest ......../digest 01234567/'
folder="${{@: -1}}"
for table in frames hops; do
  {{ head -n 1 "$folder/$table.csv"; tail -n +2 "$folder/$table.csv" | tac; }} >"$folder/turned" && mv "$folder/turned" "$folder/$table.csv"
done""")
        done, files = self.soak(other, "--recordings")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr + str(files))
        self.assertEqual(self.soak(other, count=1)[0].returncode, 1)

    def test_a_row_that_differs(self):
        other = self.script("takt", f"""{TAKT} "$@" || true
sed -i '$s/,[0-9]*,/,31415,/' "${{@: -1}}/frames.csv" """)
        done, files = self.soak(other, "--recordings", count=2)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertTrue(any("31415" in text and "here:" in text for text in files.values()), files)

    def test_what_the_other_build_refuses_is_no_finding(self):
        done, files = self.soak(self.script("takt", "exit 2"))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn(f"{COUNT} of them refused", done.stdout)
        done, files = self.soak(self.script("takt", "exit 3"), count=1)
        self.assertEqual(done.returncode, 1)
        self.assertTrue(any("there: ends with status 3" in text for text in files.values()))

    def test_no_program(self):
        done, _ = self.soak(str(self.folder / "nothing"))
        self.assertEqual(done.returncode, 2)
        self.assertIn("expected a program", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
