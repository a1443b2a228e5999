#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A page printed on A4: nothing is cut, nothing stays folded, heads of tables are repeated. Takes chromium and pdftotext.

usage: print_test.py TAKT SOURCE_FOLDER
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

TAKT, SCENARIOS = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve() / "scenarios"
BROWSER = next((found for name in ("chromium", "chromium-browser", "google-chrome") if (found := shutil.which(name))), None)
# The sides of A4 in points, and what browsers make of them.
SHORT, LONG, ROUNDING = 595.3, 841.9, 1.0


class Paper:
    """The pages of a PDF: size, and words with where they stand."""

    def __init__(self, html):
        with tempfile.TemporaryDirectory() as folder:
            pdf = pathlib.Path(folder) / "page.pdf"
            command = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={folder}/profile", "--no-pdf-header-footer", f"--print-to-pdf={pdf}", html.as_uri()]
            subprocess.run(command, check=True, capture_output=True, timeout=300)
            text = subprocess.run(["pdftotext", "-bbox", pdf, "-"], check=True, capture_output=True, text=True).stdout
            self.layout = subprocess.run(["pdftotext", "-layout", pdf, "-"], check=True, capture_output=True, text=True).stdout.split("\f")
        self.pages = []
        for width, height, body in re.findall(r'<page width="([\d.]+)" height="([\d.]+)">(.*?)</page>', text, re.S):
            words = re.findall(r'<word xMin="([-\d.]+)" yMin="([-\d.]+)" xMax="([-\d.]+)" yMax="([-\d.]+)">(.*?)</word>', body)
            self.pages.append((float(width), float(height), [(*map(float, place), word) for *place, word in words]))


@unittest.skipUnless(BROWSER and shutil.which("pdftotext"), "no chromium or no pdftotext here: nothing is printed")
class Printed(unittest.TestCase):
    def paper(self, scenario, *options):
        with tempfile.TemporaryDirectory() as folder:
            html = pathlib.Path(folder) / "report.html"
            subprocess.run([TAKT, "run", scenario, "--quiet", "--report", html, *options], check=False, capture_output=True, timeout=300)
            return Paper(html), html.read_text(encoding="utf-8")

    def check_pages(self, paper):
        for number, (width, height, words) in enumerate(paper.pages, 1):
            self.assertAlmostEqual(min(width, height), SHORT, delta=ROUNDING)
            self.assertAlmostEqual(max(width, height), LONG, delta=ROUNDING)
            for left, top, right, bottom, word in words:
                inside = left >= 0 and top >= 0 and right <= width and bottom <= height
                self.assertTrue(inside, f"page {number} of {width} x {height}: {word} from {left}, {top} to {right}, {bottom}")

    def test_thirteen_participants_and_what_is_folded(self):
        paper, html = self.paper(SCENARIOS / "daisy-chain.json")
        self.check_pages(paper)
        participants = ["plc", *(f"m{n}" for n in range(1, 13))]
        charts = [words for width, height, words in paper.pages if width > height]
        self.assertTrue(charts, "a chart of thirteen participants stands across")
        across = [[word for *_, word in words] for words in charts]
        self.assertTrue(any(all(name in words for name in participants) for words in across), across)
        # Letters of at least 4 points: of names in the chart that has them all.
        sizes = [bottom - top for words in charts for _, top, _, bottom, word in words if word in participants]
        self.assertGreater(min(sizes), 4.0)
        # Each row of the folded tables is there, and so are the folded charts.
        printed = " ".join(" ".join(page.split()) for page in paper.layout)
        self.assertEqual(printed.count("Its figures, hop by hop"), html.count("Its figures, hop by hop"))
        rows = html.count("<td>transmission</td>")
        self.assertGreater(rows, 50)
        self.assertGreaterEqual(len(re.findall(r"(?<!: )\btransmission\b", printed)), rows)

    def test_heads_are_repeated(self):
        paper, _ = self.paper(SCENARIOS / "daisy-chain.json")
        continued = [page for page in paper.layout if re.match(r"\s*(hop\s+cause|m\d+|plc|cable|forwarding|transmission|operating)", page)]
        self.assertGreaterEqual(len(continued), 2, "the long table takes several pages")
        for page in continued:
            self.assertRegex(page, r"^\s*hop\s+cause\s+behind\s+took\s+share", page[:300])

    def test_gates_and_long_names(self):
        long_name = "a-drive-with-a-name-that-somebody-has-copied-from-a-plan-of-the-plant"
        text = (SCENARIOS / "tsn" / "gates-on-a-line.json").read_text(encoding="utf-8").replace('"control"', f'"{long_name}"')
        with tempfile.TemporaryDirectory() as folder:
            scenario = pathlib.Path(folder) / "long.json"
            scenario.write_text(re.sub(r'"\$schema": "[^"]*",', "", text), encoding="utf-8")
            paper, _ = self.paper(scenario)
        self.check_pages(paper)
        printed = "".join("".join(page.split()) for page in paper.layout)
        self.assertIn(long_name, printed)

    def test_two_hundred_and_fifty_hops(self):
        with tempfile.TemporaryDirectory() as folder:
            scenario = pathlib.Path(folder) / "line.json"
            scenario.write_text("""{"name": "line", "duration": "30ms", "network": {"generate": [{"topology": "line", "switches": 250, "forwarding_delay": "1us"}]},
              "streams": [{"name": "far", "from": "h1", "to": "h250", "payload": "100B", "every": "5ms", "pcp": 5}, {"name": "beside", "from": "h60", "to": "h200", "payload": "1400B", "every": "70us"}]}""", encoding="utf-8")
            paper, html = self.paper(scenario)
        self.check_pages(paper)
        self.assertLess(html.split("Where the time went")[1].split("</details>")[0].count("<tr>"), 100)
        # Each piece of the bar has room for its name.
        self.assertLess(html.split("Where the time went")[1].split("</h3>")[1].split("</details>")[0].count('class="group"'), 30)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
