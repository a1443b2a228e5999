#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every block of the pages that shows what takt prints is what it prints now. Renewal: tests/docs/renew.py.

usage: outputs_test.py TAKT SOURCE_FOLDER [unittest options]
"""
import pathlib
import sys
import tempfile
import unittest

import outputs
import pictures

TAKT = pathlib.Path()
SOURCE = pathlib.Path()


class Held(unittest.TestCase):
    """What the comparison finds, on pages made for it."""

    def blocks(self, text):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        page = pathlib.Path(folder.name) / "page.md"
        page.write_text(text, encoding="utf-8")
        return page, outputs.blocks_of(page)

    def excerpt(self, *lines):
        text = "\n".join(["<!-- excerpt of: c -->", "```", *lines, "```", ""])
        return self.blocks(text)[1][0]

    def test_a_command_is_run_once_and_its_files_are_there(self):
        command = "cat scenarios/robot-arm.json | head -n 1; echo x >>seen; cat seen; cat given"
        page = f"<!-- file: given -->\n```json\nof the page\n```\n<!-- output of: {command} -->\n```\n```\n<!-- excerpt of: {command} -->\n```\n```\n"
        printed = outputs.Printer(TAKT, SOURCE).run_page(self.blocks(page)[1])
        self.assertEqual(list(printed), [command])
        self.assertEqual(printed[command][-2:], ["x", "of the page"])

    def test_the_program_that_runs_is_the_one_that_is_given(self):
        printed = outputs.Printer(TAKT, SOURCE).run_page(self.blocks("<!-- output of: command -v takt -->\n```\n```\n")[1])
        self.assertEqual(printed, {"command -v takt": [str(TAKT)]})

    def test_a_whole_output(self):
        block = self.blocks("<!-- output of: c -->\n```\nall 1 us   \nof it\n```\n")[1][0]
        self.assertEqual(outputs.difference(block, ["all 1 us", "of it"]), "")
        changed = outputs.difference(block, ["all 2 us", "of it"])
        self.assertIn("page.md:2", changed)
        self.assertIn("-all 1 us\n+all 2 us", changed)
        self.assertIn("+and more", outputs.difference(block, ["all 1 us", "of it", "and more"]))

    def test_an_excerpt(self):
        printed = ["head", "a 1 us", "b 2 us", "", "c 3 us", "d 4 us", "end"]
        self.assertEqual(outputs.difference(self.excerpt("a 1 us", "b 2 us", "...", "d 4 us"), printed), "")
        self.assertIn("-b 3 us\n+b 2 us", outputs.difference(self.excerpt("a 1 us", "b 3 us", "...", "d 4 us"), printed))
        # Two parts are in order, and between lines of a part nothing stands.
        self.assertIn("not printed any more", outputs.difference(self.excerpt("d 4 us", "...", "a 1 us"), printed))
        self.assertIn("+c 3 us", outputs.difference(self.excerpt("a 1 us", "d 4 us"), printed))
        self.assertIn("not printed any more", outputs.difference(self.excerpt("a 1 us", "...", "x 4 us"), printed))

    def test_a_part_whose_figures_change_is_found_again(self):
        block = self.excerpt("pass  start", "      simulated 5.1 us <= 7 us", "...", "pass  halt", "      simulated 1 us <= 2 us", "...")
        printed = ["x", "pass  start", "      simulated 5.25 us <= 7.5 us", "", "pass  halt", "      a line more", "      simulated 1.5 us <= 2 us", "y"]
        self.assertEqual(outputs.renewed(block, printed), [*printed[1:3], "...", *printed[4:7], "..."])

    def test_renewal_changes_what_differs_and_nothing_else(self):
        page, blocks = self.blocks("text\n\n<!-- output of: c -->\n```\nold\nlines\n```\nmore\n<!-- excerpt of: c -->\n```\nn 1\n```\nend\n")
        self.assertEqual(outputs.renew(page, blocks, {"c": ["n 2"]}, SOURCE), [])
        self.assertEqual(page.read_text(), "text\n\n<!-- output of: c -->\n```\nn 2\n```\nmore\n<!-- excerpt of: c -->\n```\nn 2\n```\nend\n")
        left = outputs.renew(page, outputs.blocks_of(page), {"c": ["other"]}, SOURCE)
        self.assertEqual(len(left), 1)
        self.assertIn("not printed any more", left[0])

    def test_a_figure_of_the_bench(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        page = pathlib.Path(folder.name) / "docs" / "performance.md"
        page.parent.mkdir()
        page.write_text("```\nline      3.25  3.1  3.4    1  yes  x 7 of 8\npair    418.52    -    -  500  NO   y\n```\n", encoding="utf-8")
        self.assertEqual(outputs.with_figures("4<!-- bench: pair --> and 1.0<!-- bench: line --> of 9", pathlib.Path(folder.name)), "419<!-- bench: pair --> and 3.3<!-- bench: line --> of 9")

    def test_a_block_without_a_marker_is_found(self):
        def lacking(text):
            return [block.lacks_a_marker() for block in self.blocks(text)[1]]

        self.assertEqual(lacking("```\npass  5 us\n```\n"), [True])
        self.assertEqual(lacking("```\ntakt run a.json    what happens\n```\n```json\n{}\n```\n"), [False, False])
        self.assertEqual(lacking("```\ntakt run a.json    839 us was found\n```\n"), [True])
        self.assertEqual(lacking("<!-- not held here: a formula -->\n```\na = b\n```\n"), [False])
        # A marker is on the line above.
        self.assertEqual(lacking("<!-- not held here: a formula -->\n\n```\na = b\n```\n"), [True])


class Pages(unittest.TestCase):
    def test_every_block_says_what_it_is(self):
        lacking = [block.place for page in outputs.pages_of(SOURCE) for block in outputs.blocks_of(page) if block.lacks_a_marker()]
        self.assertEqual(lacking, [], "blocks without a language, without a marker, that are no list of commands: see outputs.py")

    def test_figures_of_the_bench_are_those_of_its_page(self):
        for page in outputs.pages_of(SOURCE):
            text = page.read_text(encoding="utf-8")
            self.assertEqual(text, outputs.with_figures(text, SOURCE), page.name)

    def test_the_picture_shows_what_is_printed_now(self):
        printed = outputs.Printer(TAKT, SOURCE).run_once(pictures.COMMAND)
        drawn = (SOURCE / pictures.NAME).read_text(encoding="utf-8")
        self.assertEqual(drawn, pictures.draw(printed), "If that is meant: tests/docs/renew.py FOLDER_OF_TAKT")
        self.assertEqual(drawn.count("<title>bound"), 6)
        self.assertIn("reaction start within 12ms", drawn)

    def test_outputs_are_what_is_printed_now(self):
        printer = outputs.Printer(TAKT, SOURCE)
        held = 0
        for page in outputs.pages_of(SOURCE):
            blocks = outputs.blocks_of(page)
            printed = printer.run_page(blocks)
            for block in blocks:
                if block.is_held():
                    held += 1
                    with self.subTest(block=block.place):
                        text = outputs.difference(block, printed[block.argument])
                        if text:
                            self.fail(f"\n{text}\n\nIf that is meant: tests/docs/renew.py FOLDER_OF_TAKT")
        self.assertGreater(held, 15)


if __name__ == "__main__":
    TAKT, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
