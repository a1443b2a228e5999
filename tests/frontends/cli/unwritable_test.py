#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A place that cannot be written to is found before the work: by every command that writes, for every kind of such a place, as root and as somebody else.

usage: unwritable_test.py TAKT SOURCE_FOLDER [unittest options]
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

TAKT = ""
SOURCE = pathlib.Path()

PLANT = """{"name": "plant", "duration": "%s", "network": {
  "nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]},
  "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "10us"}], "require": [{"stream": "s", "latency": "1ms"}]}
"""
STUDY = """{"name": "study", "scenario": "long.json", "replications": {"count": 100000}, "measures": ["stream.s.latency.max"]}"""
INSTANCE = "plant.problem.json"   # setUp() makes it

# Each command that writes: what it takes, the option (or "" for a position), the kind of place, and whether the answer can be JSON. Done as asked, most would take hours.
COMMANDS = [
    (["run", "long.json"], "--out", "folder", True),
    (["run", "long.json"], "--report", "file", True),
    (["run", "long.json"], "--junit", "file", True),
    (["verify", "long.json", "--budget", "1000000"], "--out", "folder", True),
    (["verify", "long.json", "--budget", "1000000"], "--report", "file", True),
    (["verify", "long.json", "--budget", "1000000"], "--junit", "file", True),
    (["explore", "--slaves", "4", "--calls", "4", "--faults", "restart,timeout,loss", "--quiet"], "--out", "folder", True),
    (["study", "study.json", "--quiet"], "--out", "file", False),
    (["study", "shrink", "study.json", "0"], "--out", "file", False),
    (["study", "report", "study.sqlite"], "--out", "file", False),
    (["study", "merge", "{}", "study.sqlite"], "", "file", False),
    (["schedule", "auto.json"], "--out", "file", True),
    (["schedule", INSTANCE], "--out", "file", True),
    (["schedule", INSTANCE], "--out", "folder/", True),
    (["schedule", INSTANCE], "--certificate", "file", True),
    (["schedule", INSTANCE, "--to", "plant.solution.json"], "--plant", "file", True),
    (["schedule", "--to", "auto.json", "--remove", "s"], "--transition", "file", True),
    (["export", "linux", "plant.json"], "--out", "folder", True),
    (["export", "svg", "plant.json"], "--out", "folder", True),
    (["import", "neutral", INSTANCE], "--out", "file", False),
    (["paper", "programs"], "--out", "folder", True),
    (["paper", "coexistence"], "--out", "folder", True),
    (["paper", "validation"], "--out", "folder", True),
    (["emulate", "long.json"], "--keep", "folder", True),
]


def takt(*arguments, cwd, user=None, timeout=60):
    done = subprocess.run([TAKT, *map(str, arguments)], capture_output=True, text=True, cwd=cwd, timeout=timeout, check=False, user=user, group=user, extra_groups=[] if user else None)
    return done.returncode, done.stdout, done.stderr


class Unwritable(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(dir="/tmp"))
        self.addCleanup(shutil.rmtree, self.folder, True)
        self.folder.chmod(0o755)
        for name, text in {"plant.json": PLANT % "1ms", "long.json": PLANT % "100h", "study.json": STUDY, "study.sqlite": "", "a-file": "kept",
                           "auto.json": (PLANT % "1ms").replace('"every"', '"offset": "auto", "every"')}.items():
            (self.folder / name).write_text(text, encoding="utf-8")
        # Scenarios of the published evaluations are found from where the command is run.
        for name in ("scenarios", "validation"):
            (self.folder / name).symlink_to(SOURCE / name)
        self.assertEqual(takt("export", "neutral", "plant.json", "--out", ".", cwd=self.folder)[0], 0)
        self.made = self.contents()

    def contents(self):
        return {str(p.relative_to(self.folder)): p.stat().st_mtime_ns for p in self.folder.rglob("*") if not p.is_dir()} | {str(p.relative_to(self.folder)): 0 for p in self.folder.rglob("*") if p.is_dir() and not p.is_symlink()}

    def refuse(self, command, option, place, as_json, user=None):
        arguments = [place if each == "{}" else each for each in command] + ([option, place] if option else [])
        status, out, err = takt(*arguments, *(["--format", "json"] if as_json else []), cwd=self.folder, user=user)
        self.assertEqual(status, 2, err)
        where = option or "OUT"
        if as_json:
            self.assertEqual(err, "")
            told = json.loads(out)["diagnostics"]
            self.assertEqual({(each["file"], each["severity"]) for each in told}, {(where, "error")})
            self.assertTrue(all(each["found"] and each["expected"] for each in told))
        else:
            self.assertEqual(out, "")
            self.assertRegex(err, rf"^{re.escape(where)}: error: no (file|folder) that can be written( to)?: found [^\n]*, expected a [^\n]*\n$")
        self.assertEqual(self.contents(), self.made)

    def every(self, places, user=None):
        """`places` by kind."""
        for command, option, kind, has_json in COMMANDS:
            for place in places[kind.rstrip("/")]:
                with self.subTest(command=" ".join(command), option=option, place=place, user=user):
                    self.refuse(command, option, place + ("/" if kind.endswith("/") else ""), has_json and len(place) % 2 == 0, user)
                    if has_json and len(command) == 2:
                        self.refuse(command, option, place + ("/" if kind.endswith("/") else ""), False, user)

    def test_whoever_asks(self):
        """A file where a folder is needed, a folder where a file is needed, a file as the parent of either, a file system without files, a device that takes nothing, a name that is too long."""
        (self.folder / "a-folder" / "below").mkdir(parents=True)
        self.made = self.contents()
        everywhere = ["a-file/below", "a-file/below/deeper", "/proc/takt/out", "/dev/full/out", "x" * 300]
        self.every({"folder": ["a-file", "/dev/null", "/proc", *everywhere], "file": ["a-folder", "a-folder/below", "/dev/full", "x" * 253, *everywhere]})

    @unittest.skipUnless(os.geteuid() == 0, "only root becomes somebody else")
    def test_somebody_else(self):
        nobody = 65534
        (self.folder / "roots").mkdir()
        (self.folder / "roots" / "old").write_text("kept", encoding="utf-8")
        self.made = self.contents()
        self.assertEqual(takt("check", "plant.json", cwd=self.folder, user=nobody)[0], 0, "somebody else can read it")
        self.every({kind: ["new", "roots/new/deeper", "roots/old" if kind == "file" else "roots"] for kind in ("folder", "file")}, nobody)

    def test_files_of_a_folder(self):
        """Where a file of the results would be a folder, the run would be for nothing."""
        for name, options in (("result.json", []), ("streams.csv", []), ("files.json", []), ("all.pcapng", ["--pcap", "all"]), ("timeline.json", ["--timeline"])):
            with self.subTest(name):
                (self.folder / "out" / name).mkdir(parents=True)
                self.made = self.contents()
                self.refuse(["run", "long.json", *options], "--out", "out", False)
                shutil.rmtree(self.folder / "out")
        (self.folder / "out" / "a.sh").mkdir(parents=True)
        self.made = self.contents()
        self.refuse(["export", "linux", "plant.json"], "--out", "out", False)

    def test_several_at_once(self):
        status, _, err = takt("run", "long.json", "--out", "a-file", "--report", "a-file/x", cwd=self.folder)
        self.assertEqual((status, err.count("error: no f")), (2, 2))

    def test_what_is_missing_is_made(self):
        """A place that can be made is no mistake; nor is a device or a pipe."""
        for command, option, name in ((["run", "plant.json", "--quiet"], "--out", "result.json"), (["export", "linux", "plant.json"], "--out", "a.sh")):
            with self.subTest(command[0]):
                self.assertEqual(takt(*command, option, "new/and/deeper/", cwd=self.folder)[0], 0)
                self.assertTrue((self.folder / "new" / "and" / "deeper" / name).is_file())
        for command, option in ((["run", "plant.json", "--quiet"], "--report"), (["import", "neutral", INSTANCE], "--out"), (["schedule", INSTANCE], "--out")):
            with self.subTest(command[0]):
                self.assertEqual(takt(*command, option, "made/here/it", cwd=self.folder)[0], 0)
                self.assertTrue((self.folder / "made" / "here" / "it").is_file())
                shutil.rmtree(self.folder / "made")
                self.assertEqual(takt(*command, option, "/dev/null", cwd=self.folder)[0], 0)
                self.assertTrue(pathlib.Path("/dev/null").is_char_device())
        read, write = os.pipe()
        done = subprocess.run([TAKT, "import", "neutral", INSTANCE, "--out", f"/dev/fd/{write}"], cwd=self.folder, pass_fds=[write], timeout=60, check=False)
        os.close(write)
        self.assertEqual((done.returncode, json.loads(os.read(read, 65536))["name"]), (0, "plant"))
        os.close(read)

    def test_a_link_is_followed(self):
        (self.folder / "link").symlink_to("a-file")
        self.assertEqual(takt("import", "neutral", INSTANCE, "--out", "link", cwd=self.folder)[0], 0)
        self.assertTrue((self.folder / "link").is_symlink())
        self.assertIn('"plant"', (self.folder / "a-file").read_text(encoding="utf-8"))

    def test_no_command_is_forgotten(self):
        """Every option that names a place to write, by the help of all commands, is in the list above."""
        commands = json.loads(takt("--describe", cwd=self.folder)[1])
        told = set()

        def walk(command, path):
            for option in command.get("options", []):
                names = option["name"] if isinstance(option.get("name"), str) else ",".join(option.get("names", []))
                if re.search(r"--(out|report|junit|certificate|plant|transition|keep)\b", names) or (path[-2:] == ["study", "merge"] and names == "OUT"):
                    told.add((" ".join(path), re.search(r"--\w+|OUT", names).group()))
            for sub in command.get("commands", []):
                walk(sub, path + [sub["name"]])

        walk(commands, [])
        listed = set()
        for command, option, _, _ in COMMANDS:
            words = command[:2] if command[0] == "paper" or command[1] in ("shrink", "report", "merge") else command[:1]
            listed.add((" ".join(words), option or "OUT"))
        self.assertEqual(told, listed)


if __name__ == "__main__":
    TAKT = str(pathlib.Path(sys.argv.pop(1)).resolve())
    SOURCE = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
