#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renews every block of the pages that shows what takt prints, and the picture of the README.

For a change that is meant to change them.

usage: renew.py BUILD_FOLDER [PAGE...]

BUILD_FOLDER holds takt of the changed sources. Without pages all are renewed. Blocks of which a part is not printed any more are left and named.
"""
import pathlib
import sys

import outputs
import pictures

ROOT = pathlib.Path(__file__).resolve().parents[2]


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    printer = outputs.Printer((pathlib.Path(sys.argv[1]) / "takt").resolve(), ROOT)
    wanted = [pathlib.Path(name).resolve() for name in sys.argv[2:]]
    left = []
    for page in outputs.pages_of(ROOT):
        if not wanted or page in wanted:
            blocks = outputs.blocks_of(page)
            left += outputs.renew(page, blocks, printer.run_page(blocks), ROOT)
    if not wanted:
        (ROOT / pictures.NAME).write_text(pictures.draw(printer.run_once(pictures.COMMAND)), encoding="utf-8")
    if left:
        sys.exit("\n\n".join(["to be mended by hand:", *left]))


if __name__ == "__main__":
    main()
