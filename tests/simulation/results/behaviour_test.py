#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The number of behaviour: it is raised whenever a pinned digest or a figure's meaning changes, and what takt writes carries it.

usage: behaviour_test.py TAKT SOURCE_FOLDER [unittest options]
"""
import json
import pathlib
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True

TAKT = ""
SOURCE = pathlib.Path()
STUDY = """{"name": "small", "scenario": {"name": "pair", "duration": "2ms",
  "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]},
  "streams": [{"name": "x", "from": "a", "to": "b", "payload": "100B", "every": "1ms"}]},
 "factors": [{"name": "size", "set": ["/streams/0/payload"], "values": ["100B", "300B"]}],
 "measures": [{"name": "delay", "of": "latency.x.max", "unit": "us"}]}"""


def takt(*arguments):
    done = subprocess.run([TAKT, *map(str, arguments)], capture_output=True, text=True, timeout=1000, check=False)
    return done.returncode, done.stdout, done.stderr


class Tree(unittest.TestCase):
    """Copies of the files that the number rests on."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="takt-behaviour-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def copy(self, name="tree"):
        root = self.folder / name
        for path in (renew.DIGESTS, renew.MEANINGS, renew.REASONS, renew.NOTED, ".gitattributes"):
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(SOURCE / path, root / path)
        return root

    def edit(self, root, path, old, new):
        text = (root / path).read_text()
        self.assertIn(old, text)
        (root / path).write_text(text.replace(old, new, 1))

    def test_this_tree_is_noted(self):
        self.assertEqual(renew.Behaviour(SOURCE).problem(), "")
        self.assertIn(f", behaviour {renew.Behaviour(SOURCE).number}", takt("--version")[1].splitlines()[0])

    def test_a_digest_that_changes_without_the_number(self):
        root = self.copy()
        digest = renew.lines_of(root, renew.DIGESTS, "#")[0].split()[2]
        self.edit(root, renew.DIGESTS, digest, "0" * 16)
        problem = renew.Behaviour(root).problem()
        now = renew.Behaviour(SOURCE).number
        self.assertIn(f"pinned digests changed, and the number of behaviour is still {now}", problem)
        self.assertIn("--because", problem)
        # Raised by a line, but not noted yet; then noted.
        changed = renew.Behaviour(root)
        changed.raise_by('frames of class "7" go first')
        self.assertEqual(renew.Behaviour(root).number, renew.Behaviour(SOURCE).number + 1)
        self.assertFalse(renew.Behaviour(root).must_be_raised())
        self.assertIn("--number notes it", renew.Behaviour(root).problem())
        renew.Behaviour(root).note()
        self.assertEqual(renew.Behaviour(root).problem(), "")
        self.assertIn(r'"frames of class \"7\" go first",', (root / renew.REASONS).read_text())

    def test_a_figure_that_means_something_else(self):
        root = self.copy()
        self.edit(root, renew.MEANINGS, "Events handled. |", "Events handled after the warm-up. |")
        self.assertIn("meanings of figures changed", renew.Behaviour(root).problem())

    def test_two_branches_raise_it_twice(self):
        if shutil.which("git") is None:
            self.skipTest("no git here")
        root = self.copy()

        def git(*arguments):
            words = ["git", "-C", root, "-c", "user.name=t", "-c", "user.email=t@t", *arguments]
            return subprocess.run(words, capture_output=True, text=True, check=True).stdout

        before = renew.Behaviour(root).number
        git("init", "-q", "-b", "main")
        git("add", "-A")
        git("commit", "-qm", "before")
        lines = renew.lines_of(root, renew.DIGESTS, "#")
        for branch, line in (("one", lines[0]), ("two", lines[-1])):
            git("checkout", "-q", "-b", branch, "main")
            self.edit(root, renew.DIGESTS, line, line[:-16] + "0" * 16)
            changed = renew.Behaviour(root)
            self.assertTrue(changed.must_be_raised())
            changed.raise_by(f"branch {branch} does it otherwise")
            changed.note()
            self.assertEqual(renew.Behaviour(root).problem(), "")
            git("commit", "-qam", branch)
        git("merge", "-q", "one")   # no conflict
        self.assertEqual(renew.Behaviour(root).number, before + 2)
        self.assertIn("notes it", renew.Behaviour(root).problem())
        self.assertFalse(renew.Behaviour(root).must_be_raised())


class Files(unittest.TestCase):
    """What takt writes, and what it says of files with another number."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="takt-behaviour-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.number = renew.Behaviour(SOURCE).number
        self.study = self.folder / "study.json"
        self.study.write_text(STUDY)

    def age(self, store, number):
        with sqlite3.connect(store) as database:
            if number is None:
                database.execute("DELETE FROM meta WHERE key = 'behaviour'")
            else:
                database.execute("UPDATE meta SET value = ? WHERE key = 'behaviour'", (str(number),))
        database.close()

    def test_stores(self):
        store, part = self.folder / "s.sqlite", self.folder / "part.sqlite"
        self.assertEqual(takt("study", self.study, "--out", store, "--jobs", 1)[0], 0)
        self.assertEqual(takt("study", self.study, "--out", part, "--jobs", 1, "--shard", "1/2")[0], 0)
        self.assertEqual(takt("study", self.study, "--out", store, "--resume")[0], 0)
        self.assertEqual(takt("study", "report", store, "--out", self.folder / "s.html")[2], "")
        self.assertIn(f"with behaviour {self.number}", (self.folder / "s.html").read_text())
        others = ((self.number + 1, f"with behaviour {self.number + 1}"), (None, "without a number of behaviour"))
        for other, words in others:
            with self.subTest(other):
                self.age(store, other)
                merge = ("study", "merge", self.folder / "all.sqlite", part, store)
                for command in (("study", self.study, "--out", store, "--resume"), merge):
                    status, out, err = takt(*command)
                    self.assertEqual((status, out), (2, ""))
                    self.assertIn(words, err)
                    self.assertIn(f"with behaviour {self.number}", err)
                    self.assertIn("anew", err)
                status, out, err = takt("study", "report", store, "--out", self.folder / "s.html")
                self.assertEqual(status, 0)
                self.assertIn(f"{words}, this is takt", err)

    def test_results_and_captures(self):
        scenario, out = SOURCE / "scenarios" / "direct-link.json", self.folder / "out"
        status = takt("run", scenario, "--duration", "20ms", "--out", out, "--pcap", "all", "--quiet")[0]
        self.assertIn(status, (0, 1))   # the requirements are of a longer run
        self.assertEqual(json.loads((out / "result.json").read_text())["behaviour"], self.number)
        self.assertEqual(json.loads((out / "files.json").read_text())["written"][0]["behaviour"], self.number)
        # Section header block, then its option 4, shb_userappl.
        maker = rb"\x04\x00.\x00takt \d+\.\d+\.\d+ with behaviour " + str(self.number).encode() + rb"\x00*"
        self.assertRegex((out / "all.pcapng").read_bytes()[:200], maker)
        status, page, err = takt("compare", scenario, scenario, "--pairs", 1, "--format", "json")
        self.assertEqual((status, json.loads(page)["behaviour"]), (0, self.number), err)

    def test_scenarios_that_another_takt_wrote(self):
        out = self.folder / "out"
        takt("run", SOURCE / "scenarios" / "direct-link.json", "--duration", "20ms", "--out", out, "--quiet")
        copy, files = out / "scenario.json", out / "files.json"
        self.assertEqual(takt("run", copy, "--quiet")[2], "")
        files.write_text(files.read_text().replace(f'"behaviour": {self.number}', f'"behaviour": {self.number + 1}'))
        both = rf"was made by takt \S+ with behaviour {self.number + 1}, this is takt \S+ with behaviour {self.number}"
        words = rf"warning: {re.escape(str(copy))} {both}: what it showed then need not happen now"
        self.assertRegex(takt("run", copy, "--quiet")[2], words)
        self.assertRegex(takt("compare", copy, copy, "--pairs", 1)[2], words)
        # Files of two commands in one folder.
        err = takt("verify", copy, "--out", out, "--budget", "0.01")[2]
        self.assertRegex(err, rf"What takt run wrote there {both}: do not compare it")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    TAKT, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
    sys.path.append(str(SOURCE / "tests" / "golden"))
    import renew
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
