#!/usr/bin/env python3
"""The documentation: every command in it is one that takt takes, cheap ones are run; tools/docs makes pages of it.

usage: pages_test.py TAKT SOURCE_FOLDER [unittest options]
"""
import json
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

TAKT = ""
SOURCE = pathlib.Path()
# These end by themselves within seconds and write nothing. A run is cut to its first milliseconds: whether the requirements hold is asked elsewhere.
CHEAP = {"check", "program", "schema", "bound"}


def pages():
    return [SOURCE / "README.md", *sorted((SOURCE / "docs").rglob("*.md"))]


def commands(page):
    """Lines of code blocks, and spans of code, that begin with takt: as words, without what stands behind as a comment or goes through a pipe."""
    text = page.read_text(encoding="utf-8").replace("\\\n", " ")
    blocks = re.findall(r"^```[a-z]*\n(.*?)^```", text, re.M | re.S)
    spans = re.findall(r"(?<!`)`((?:sudo )?takt [^`\n]+)`", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S))
    for line in [line for block in blocks for line in block.splitlines()] + spans:
        if not re.match(r"(?:sudo )?takt [a-z]", line):
            continue
        line = re.split(r"\s{2,}[^-\s]|\s#|\s[|&]|;", line.removeprefix("sudo "))[0]
        try:
            yield shlex.split(line.replace("[", "").replace("]", ""))
        except ValueError:
            yield line.split()


class Pages(unittest.TestCase):
    def test_commands_are_those_of_takt(self):
        root = json.loads(subprocess.run([TAKT, "--describe"], capture_output=True, text=True, check=True).stdout)
        by_name = {command["name"]: command for command in root["commands"]}
        seen = 0
        for page in pages():
            for words in commands(page):
                with self.subTest(page=page.name, command=" ".join(words)):
                    name = words[1].rstrip(",.:")
                    self.assertIn(name, by_name)
                    known = by_name[name]
                    options = {each for command in [known, *known["commands"]] for option in command["options"] for each in option["name"].split(",")}
                    for word in words[2:]:
                        if word.startswith("--"):
                            self.assertIn(word.split("=")[0].rstrip(",."), options)
                        if word.startswith("scenarios/") and not re.search(r"[*A-Z<{]", word):
                            self.assertTrue((SOURCE / word).exists(), word)
                    seen += 1
        self.assertGreater(seen, 50)

    def test_commands_that_cost_nothing_run(self):
        ran = set()
        for page in pages():
            for words in commands(page):
                file = next((word for word in words[2:] if word.startswith("scenarios/") and (SOURCE / word).is_file()), None)
                if words[1] == "run" and file:
                    words = [*words, "--duration", "2ms"] if not {"--out", "--report", "--duration"} & set(words) else []
                elif words[1] not in CHEAP or (words[1] in ("check", "bound") and not file):
                    words = []
                if not words or tuple(words) in ran or any(re.search(r"[A-Z]{3}|\.\.\.", word) for word in words[1:]) or "ring-1000" in " ".join(words):
                    continue
                ran.add(tuple(words))
                with self.subTest(page=page.name, command=" ".join(words)):
                    done = subprocess.run([TAKT, *words[1:]], capture_output=True, text=True, check=False, timeout=300, cwd=SOURCE)
                    self.assertIn(done.returncode, (0, 1), done.stderr)   # 1: what is required comes later than that
        self.assertGreater(len(ran), 5)

    def test_streams_to_gate_lists_in_three_commands(self):
        """The tutorial as it stands: its scenario, its commands one after the other, and what it says that the first one says."""
        page = (SOURCE / "docs" / "schedules.md").read_text(encoding="utf-8")
        section = page.split("## From streams to gate lists in three commands\n")[1].split("\n## ")[0]
        scenario, listing, said = re.findall(r"^```[a-z]*\n(.*?)^```", section, re.M | re.S)[:3]
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "cell.json").write_text(scenario, encoding="utf-8")
            outputs = []
            for line in listing.splitlines():
                words = shlex.split(re.split(r"\s{2,}", line)[0])
                with self.subTest(command=" ".join(words)):
                    done = subprocess.run([TAKT, *words[1:]], capture_output=True, text=True, check=False, timeout=300, cwd=folder)
                    self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                    outputs.append(done.stdout)
            self.assertGreaterEqual(len(outputs), 3)
            self.assertTrue(outputs[0].startswith(said), outputs[0])
            self.assertTrue(any((pathlib.Path(folder) / "lists").iterdir()))

    def test_one_spelling(self):
        for page in pages():
            for line in page.read_text(encoding="utf-8").splitlines():
                self.assertNotRegex(line, r"^\s*(\./)?build/release/takt ", page)

    @unittest.skipUnless(shutil.which("mkdocs"), "mkdocs is not installed")
    def test_pages_with_search(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([SOURCE / "tools" / "docs", folder], check=True, capture_output=True, timeout=300)
            index = json.loads((pathlib.Path(folder) / "search" / "search_index.json").read_text(encoding="utf-8"))
            self.assertTrue(any("reaction" in entry["text"] for entry in index["docs"]))
            for page in (SOURCE / "docs").rglob("*.md"):
                self.assertTrue((pathlib.Path(folder) / page.relative_to(SOURCE / "docs")).with_suffix(".html").exists(), page)


if __name__ == "__main__":
    TAKT, SOURCE = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
