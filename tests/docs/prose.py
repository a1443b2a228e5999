#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Counts what makes documents and sources hard to read. The counts are a ratchet: they may fall, never rise.

usage: prose.py SOURCE [--renew]

Exit status 1 if a count is above that of prose_counts.json, or below it (then --renew writes the lower one down, so that it stays).
"""
import json
import pathlib
import re
import subprocess
import sys

MOST_WORDS = 35        # of a sentence
MOST_IN_CELL = 160     # characters of a table cell
MOST_IN_PARAGRAPH = 600
MOST_COLUMNS = 120     # of a line of code
COUNTS = pathlib.Path(__file__).resolve().parent / "prose_counts.json"
CODE = {".cpp", ".hpp", ".py", ".mjs", ".ts", ".cmake"}
PRIVATE_WORDS = re.compile(r"\b(tell_\w+|\w*(?:surely|seldom|closely|among_others|perhaps)\w*) *\(")


def tracked(root):
    done = subprocess.run(["git", "-C", root, "ls-files", "-z"], capture_output=True, text=True, check=False)
    names = done.stdout.split("\0") if done.returncode == 0 else [str(p.relative_to(root)) for p in pathlib.Path(root).rglob("*") if "build" not in p.parts]
    return [pathlib.PurePosixPath(name) for name in names if name and (root / name).is_file()]


def blocks(text):
    """("cell" | "paragraph", text) of a Markdown page, without fenced code, headings and comments."""
    text = re.sub(r"^```.*?^```", "", text, flags=re.S | re.M)
    text = re.sub(r"<!--.*?-->", "", text, flags=re.S)
    for block in re.split(r"\n\s*\n", text):
        paragraph = []
        for line in block.split("\n"):
            if line.startswith("|"):
                yield from (("cell", cell.strip()) for cell in re.split(r"(?<!\\)\|", line)[1:-1] if not re.fullmatch(r"[\s:-]*", cell))
            elif re.match(r"\s*(?:[-*]|\d+\.)\s", line):
                if paragraph:
                    yield "paragraph", " ".join(paragraph)
                paragraph = [line.strip()]
            elif line.strip() and not line.startswith("#"):
                paragraph.append(line.strip())
        if paragraph:
            yield "paragraph", " ".join(paragraph)


def sentences(text):
    text = re.sub(r"`[^`]*`", "code", text)
    text = re.sub(r"\]\([^)]*\)", "]", text)
    return [part for part in re.split(r"(?<=[.!?:;])\s+", text) if part]


def comment_sentences(text):
    lines = [re.match(r"\s*//+!?<?\s?(.*)", line) for line in text.split("\n")]
    run = []
    for match in [*lines, None]:
        if match:
            run.append(match.group(1))
        elif run:
            yield from sentences(" ".join(run))
            run = []


def count(root):
    counts = {"long sentences in documents": 0, "long table cells": 0, "long paragraphs": 0, "long sentences in comments": 0, "long lines of code": 0, "private words in names": 0}
    for name in tracked(root):
        if name.suffix == ".md" and "reference" not in name.parts:
            for kind, text in blocks((root / name).read_text(encoding="utf-8")):
                counts["long table cells"] += kind == "cell" and len(text) > MOST_IN_CELL
                counts["long paragraphs"] += kind == "paragraph" and len(text) > MOST_IN_PARAGRAPH
                counts["long sentences in documents"] += sum(len(each.split()) > MOST_WORDS for each in sentences(text))
        elif name.suffix in CODE and name.parts[0] in ("sim", "models", "src", "tests", "tools", "cmake"):
            text = (root / name).read_text(encoding="utf-8")
            counts["long lines of code"] += sum(len(line) > MOST_COLUMNS for line in text.split("\n"))
            if name.suffix in (".cpp", ".hpp"):
                counts["long sentences in comments"] += sum(len(each.split()) > MOST_WORDS for each in comment_sentences(text))
                counts["private words in names"] += len(set(PRIVATE_WORDS.findall(text)))
    return counts


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    found = count(root)
    if "--renew" in sys.argv:
        COUNTS.write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
        return 0
    pinned = json.loads(COUNTS.read_text(encoding="utf-8"))
    wrong = 0
    for what, number in found.items():
        if number > pinned[what]:
            print(f"{what}: {number}, at most {pinned[what]} before: shorten what was added")
            wrong = 1
        elif number < pinned[what]:
            print(f"{what}: {number}, {pinned[what]} before: write the lower count down with {sys.argv[0]} {sys.argv[1]} --renew")
            wrong = 1
    print(", ".join(f"{number} {what}" for what, number in found.items()))
    return wrong


if __name__ == "__main__":
    sys.exit(main())
