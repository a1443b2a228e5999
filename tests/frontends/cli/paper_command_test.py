#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""takt paper: published evaluations, reproduced. Short forms.

usage: paper_command_test.py TAKT SOURCE_FOLDER [unittest options]
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

TAKT = ""
SOURCE = pathlib.Path()


def paper(*arguments):
    done = subprocess.run([TAKT, "paper", *map(str, arguments)], capture_output=True, text=True, timeout=1000, check=False, cwd=SOURCE)
    return done.returncode, done.stdout, done.stderr


class Paper:
    """What both papers promise."""

    NAME = ""
    FIGURES = ()
    OTHERS = ()

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls.folder.name) / "made"
        cls.status, cls.json, cls.err = paper(cls.NAME, "--short", "--quiet", "--format", "json", "--out", cls.out)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_is_reproduced(self):
        self.assertEqual((self.status, self.err), (0, ""), self.json)
        made = json.loads(self.json)
        self.assertTrue(made["holds"])
        self.assertTrue(made["short"])
        self.assertEqual(made["paper"], self.NAME)
        for comparison in made["comparisons"]:
            self.assertTrue(comparison["holds"], comparison)

    def test_folder(self):
        names = {path.name for path in self.out.iterdir()}
        self.assertLessEqual({"report.txt", "report.json", "scenarios", *(f + ".svg" for f in self.FIGURES), *self.OTHERS}, names)
        self.assertEqual((self.out / "report.json").read_text(), self.json)
        text = (self.out / "report.txt").read_text()
        self.assertTrue(text.endswith("\nREPRODUCED\n"), text[-200:])
        self.assertIn("published", text)

    def test_figures_are_svg(self):
        for path in self.out.glob("*.svg"):
            root = xml.etree.ElementTree.parse(path).getroot()
            self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg", path.name)

    def test_scenarios_can_be_checked(self):
        made = sorted((self.out / "scenarios").glob("*.json"))
        self.assertTrue(made)
        for path in made[:3]:
            done = subprocess.run([TAKT, "check", str(path)], capture_output=True, text=True, timeout=1000, check=False)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_missing_scenarios(self):
        status, out, err = paper(self.NAME, "--short", "--quiet", "--scenarios", "/nowhere")
        self.assertEqual((status, out), (2, ""))
        self.assertIn("/nowhere/", err)


class Programs(Paper, unittest.TestCase):
    NAME = "programs"
    FIGURES = ("fig-1", "fig-3", "fig-4a", "fig-6b", "fig-8a", "fig-8e", "beyond-slaves")


class Coexistence(Paper, unittest.TestCase):
    NAME = "coexistence"
    FIGURES = ("criterion-1", "fig-4", "fig-5", "fig-6", "fig-7", "fig-8", "fig-9")
    OTHERS = tuple(f"fig-{n}.vcd" for n in range(5, 10))

    def test_every_cell_has_its_verdict(self):
        made = json.loads(self.json)
        cells = [c for c in made["comparisons"] if c["what"].startswith("Table ")]
        self.assertEqual(len(cells), 32)
        self.assertEqual({c["standing"] for c in cells if ", 2 ms" in c["what"] or ", 10 ms" in c["what"]}, {"predicted"})
        self.assertEqual({c["standing"] for c in cells if ", 1 ms" in c["what"] or ", 5 ms" in c["what"]}, {"calibrated"})
        for cell in cells:
            self.assertLessEqual(abs(cell["deviation_points"]), cell["tolerance_points"], cell)
        self.assertEqual(set(made["signals"]), {"100ms", "10ms", "5ms", "2ms", "1ms"})
        self.assertEqual(len(made["improvements"]), 8)

    def test_same_again(self):
        self.assertEqual(paper("coexistence", "--short", "--quiet", "--format", "json")[1], self.json)

    def test_unknown_option(self):
        self.assertEqual(paper("coexistence", "--long")[0], 2)


class Validation(unittest.TestCase):
    """Published figures: the short form is met, and its lines stand in the page."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls.folder.name) / "made"
        cls.status, cls.text, cls.err = paper("validation", "--short", "--quiet", "--jobs", "2", "--out", cls.out)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_no_figure_is_missed(self):
        self.assertEqual((self.status, self.err), (0, ""), self.text)
        made = json.loads((self.out / "report.json").read_text())
        self.assertTrue(made["holds"])
        self.assertGreater(len(made["figures"]), 300)
        self.assertLessEqual({figure["verdict"] for figure in made["figures"]}, {"met", "calibrated", "differs", "met after all"})
        self.assertLessEqual(sum(figure["verdict"] == "calibrated" for figure in made["figures"]), 1)

    def test_the_page_says_what_comes_out(self):
        def rows(path):
            return {line for line in path.read_text().splitlines() if line.startswith("| ")}

        page = SOURCE / "docs" / "validation.md"
        self.assertGreater(len(rows(page)), 550)
        self.assertLessEqual(rows(self.out / "validation.md"), rows(page), "takt paper validation --out DIR, then copy DIR/validation.md")

    def test_the_whole_page_is_what_comes_out(self):
        out = self.out.parent / "full"
        self.assertEqual(paper("validation", "--quiet", "--out", out)[0], 0)
        made = (out / "validation.md").read_text()
        self.assertTrue(made == (SOURCE / "docs" / "validation.md").read_text(), "docs/validation.md is old: takt paper validation --out DIR, then copy DIR/validation.md")

    def test_pictures(self):
        for name in ("ratios", "conext22"):
            root = xml.etree.ElementTree.parse(self.out / f"{name}.svg").getroot()
            self.assertGreater(len(root.findall("{http://www.w3.org/2000/svg}circle")), 20)

    def test_a_wrong_figure_is_missed(self):
        tables = pathlib.Path(self.folder.name) / "tables"
        tables.mkdir()
        figure = {"what": "delay", "scenario": str(SOURCE / "scenarios/validation/cut-through.json"), "figure": "latency.frames.max", "published": 10.535}
        (tables / "t.json").write_text(json.dumps({"source": "s", "reference": "r", "figures": [figure]}))
        status, out, _ = paper("validation", "--quiet", "--tables", tables)
        self.assertEqual(status, 1)
        self.assertIn("s: delay: published 10.535 us, takt 10.534 us; must be equal", out)
        self.assertTrue(out.endswith("\nNOT REPRODUCED: 1 missed\n"), out)

    def test_bad_tables(self):
        status, out, err = paper("validation", "--quiet", "--tables", "/nowhere")
        self.assertEqual((status, out), (2, ""))
        self.assertIn("/nowhere", err)


if __name__ == "__main__":
    TAKT = str(pathlib.Path(sys.argv[1]).resolve())
    SOURCE = pathlib.Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
