#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tools/docs makes a site of the pages: all of them, with search and next steps; broken links are refused.

usage: site_test.py SOURCE_FOLDER [unittest options]; exit status 77 without mkdocs
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path()


def build(source, out):
    return subprocess.run([sys.executable, source / "tools" / "docs", out], capture_output=True, text=True, check=False,
                          timeout=600)


class Site(unittest.TestCase):
    def folder(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        return pathlib.Path(folder.name)

    def small(self, **changed):
        """A source of three pages, with other texts for some of them."""
        texts = {"README": "# takt\n\n[I](docs/limits.md#none)\n", "limits": "# Limits\n\n## None\n\ntext\n",
                 "tsn": "# TSN\n\n[back](../README.md)\n\nNext: [limits](limits.md).\n"} | changed
        folder = self.folder()
        (folder / "docs").mkdir()
        (folder / "tools").mkdir()
        shutil.copy(SOURCE / "tools" / "docs", folder / "tools" / "docs")
        for name, text in texts.items():
            (folder / ("README.md" if name == "README" else f"docs/{name}.md")).write_text(text, encoding="utf-8")
        return folder

    def test_every_page_is_there_and_leads_on(self):
        out = self.folder()
        done = build(SOURCE, out)
        self.assertEqual(done.returncode, 0, done.stderr)
        pages = [SOURCE / "ARCHITECTURE.md", *(SOURCE / "docs").rglob("*.md"), *(SOURCE / "src").rglob("README.md")]
        for page in pages:
            name = page.relative_to(SOURCE).with_suffix(".html")
            made = out / (name.with_name("index.html") if page.name == "README.md" else name)
            with self.subTest(page=name):
                self.assertRegex(made.read_text(encoding="utf-8"), "Next: (?:<|\\w)")
        index = json.loads((out / "search" / "search_index.json").read_text(encoding="utf-8"))
        self.assertTrue(any("idle slope" in entry["text"] for entry in index["docs"]))
        front = (out / "index.html").read_text(encoding="utf-8")
        for part in ("Bounds", "Reference", "How it is built"):
            self.assertIn(part, front)
        self.assertTrue((out / "docs" / "pictures" / "verdict.svg").exists())

    def test_a_page_without_a_next_step_gets_that_of_the_navigation(self):
        out = self.folder()
        self.assertEqual(build(self.small(), out).returncode, 0)
        self.assertIn('Next: <a href="tsn.html">TSN</a>', (out / "docs" / "limits.html").read_text(encoding="utf-8"))
        self.assertEqual((out / "docs" / "tsn.html").read_text(encoding="utf-8").count("Next: "), 1)

    def refused(self, because, **changed):
        out = self.folder() / "site"
        done = build(self.small(**changed), out)
        self.assertEqual(done.returncode, 1)
        self.assertIn(because, done.stdout + done.stderr)
        self.assertFalse(out.exists())

    def test_broken_links_are_refused(self):
        self.refused("nowhere.md", limits="Limits\n\n[x](nowhere.md)\n")
        self.refused("docs/limits.html#none", limits="# Limits\n\n## Some\n")

    def test_a_page_outside_of_the_navigation_is_refused(self):
        self.refused("docs/new.md", new="# New\n")


if __name__ == "__main__":
    SOURCE = pathlib.Path(sys.argv[1]).resolve()
    if not shutil.which("mkdocs"):
        print("mkdocs is not installed")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
