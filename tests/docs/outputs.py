# SPDX-License-Identifier: Apache-2.0
"""Blocks of the pages that show what takt prints, found by the comment above them, held against the program and renewed from it.

A comment stands on the line above its block, and readers of the page do not see it:

    <!-- output of: COMMAND -->      the block is all that the command prints
    <!-- excerpt of: COMMAND -->     the block is a part of it; a line "..." stands for what is left out between two parts
    <!-- not held here: REASON -->       the block cannot be held: times of a machine, real networks
    <!-- no output: WHAT -->         the block is not what takt prints: a formula, a file
    <!-- file: NAME -->              the block is the file NAME of the folder in which the commands of the page run

Behind a figure in a sentence, <!-- bench: NAME --> says that it is that of the printed bench in docs/performance.md, rounded.

COMMAND is a line of bash. It runs in a folder of the page in which `scenarios` is that of the repository and `takt` is the program.
A command runs once for all pages that show it, unless it names a file of its page.
"""
import dataclasses
import decimal
import difflib
import itertools
import os
import pathlib
import re
import subprocess
import tempfile

MARKER = re.compile(r"<!-- (output of|excerpt of|not held here|no output|file): (\S.*) -->")
# Lines of a block that lists commands and what each is for. A measured time behind a command would be output.
COMMAND_LINE = re.compile(r"(sudo )?(takt|tools/\w+|cmake|sbatch|apt) |\(umask | ")
FIGURE = re.compile(r"\s{2,}.*\b\d[\d.]* ?(ps|ns|us|ms|s|%)(?!\w)")
LEFT_OUT = "..."


@dataclasses.dataclass
class Block:
    page: pathlib.Path
    at: int                 # index of its first line in the page
    lines: list
    language: str
    marker: str = ""        # "" if there is none
    argument: str = ""

    @property
    def place(self):
        return f"{self.page.name}:{self.at}"

    def is_held(self):
        return self.marker in ("output of", "excerpt of")

    def is_list_of_commands(self):
        return all(COMMAND_LINE.match(line) and not FIGURE.search(line) for line in self.lines)

    def lacks_a_marker(self):
        """Blocks with a language are inputs; all others say what they are."""
        return not self.language and not self.marker and not self.is_list_of_commands()


def blocks_of(page):
    lines = page.read_text(encoding="utf-8").splitlines()
    found, begin, language = [], None, ""
    for at, line in enumerate(lines):
        if not line.startswith("```"):
            continue
        if begin is None:
            begin, language = at + 1, line[3:]
            continue
        marker = MARKER.fullmatch(lines[begin - 2].strip()) if begin >= 2 else None
        found.append(Block(page, begin, [each.rstrip() for each in lines[begin:at]], language, *(marker.groups() if marker else ("", ""))))
        begin = None
    return found


def pages_of(source):
    return [source / "README.md", *sorted((source / "docs").glob("*.md")), *sorted((source / "docs" / "papers").glob("*.md"))]


def files_of(blocks):
    """The files of a page, by name."""
    return {block.argument: "\n".join(block.lines) + "\n" for block in blocks if block.marker == "file"}


def shape(line):
    """A line without its numbers: what stays when figures change."""
    return re.sub(r"\s+", " ", re.sub(r"[+-]?\d[\d.]*(e[+-]?\d+)?( (ps|ns|us|ms|s)\b)?", "#", line)).strip()


def find(printed, part, begin):
    """Where a part of an excerpt stands, from `begin` on: as it is, else from a line like its first one to one like its last one, numbers apart."""
    for at in range(begin, len(printed) - len(part) + 1):
        if printed[at:at + len(part)] == part:
            return at, at + len(part)
    first, last = shape(part[0]), shape(part[-1])
    places = [(abs(end - at + 1 - len(part)), at, end + 1)
              for at in range(begin, len(printed)) if shape(printed[at]) == first
              for end in range(at, len(printed)) if shape(printed[end]) == last]
    return min(places)[1:] if places else None


def renewed(block, printed):
    """The lines of the block as the program prints them now; None if a part of an excerpt cannot be found any more."""
    if block.marker == "output of":
        return printed
    lines, begin = [], 0
    for is_left_out, part in itertools.groupby(block.lines, lambda line: line.strip() == LEFT_OUT):
        part = list(part)
        if not is_left_out:
            place = find(printed, part, begin)
            if place is None:
                return None
            begin = place[1]
            part = printed[place[0]:place[1]]
        lines += part
    return lines


def difference(block, printed):
    """What differs between a block and what its command prints, as text; "" if nothing does."""
    lines = renewed(block, printed)
    if lines == block.lines:
        return ""
    found = "a part of the excerpt is not printed any more" if lines is None else "figures have changed"
    text = difflib.unified_diff(block.lines, printed if lines is None else lines, "in the page", "printed now", lineterm="", n=1)
    return "\n".join([f"{block.place}: {found}: {block.argument}", *text])


def with_figures(text, source):
    """The text with the figures of the bench as docs/performance.md shows them."""
    printed = dict(re.findall(r"^(\w+) +([\d.]+) +(?:[\d.]+ +|- +){2}[\d.]+ +(?:yes|NO) ", (source / "docs" / "performance.md").read_text(encoding="utf-8"), re.M))

    def rounded(match):
        decimals = len(match[1].partition(".")[2])
        return f"{decimal.Decimal(printed[match[2]]).quantize(decimal.Decimal(1).scaleb(-decimals), decimal.ROUND_HALF_UP)}<!-- bench: {match[2]} -->"

    return re.sub(r"([\d.]+)<!-- bench: (\w+) -->", rounded, text)


def lines_of(text):
    """Without spaces at the ends of lines, which nobody sees, and blank lines around."""
    lines = [line.rstrip() for line in text.splitlines()]
    while lines and not lines[-1]:
        lines.pop()
    while lines and not lines[0]:
        lines.pop(0)
    return lines


class Printer:
    """Runs commands of pages, each once."""

    def __init__(self, takt, source):
        self.takt, self.source, self.printed = takt, source, {}

    def run(self, command, folder):
        environment = {**os.environ, "PATH": f"{self.takt.parent}:{os.environ['PATH']}", "LC_ALL": "C.UTF-8"}
        done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False, timeout=120, cwd=folder, env=environment)
        return lines_of(done.stdout) or lines_of(done.stderr)

    def run_once(self, command):
        """What a command prints that needs nothing but the scenarios, as text."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "scenarios").symlink_to(self.source / "scenarios")
            return "\n".join(self.run(command, folder))

    def run_page(self, blocks):
        """What the commands of a page print, by command."""
        files = files_of(blocks)
        commands = dict.fromkeys(block.argument for block in blocks if block.is_held())
        printed = {}
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "scenarios").symlink_to(self.source / "scenarios")
            for file, content in files.items():
                (folder / file).write_text(content, encoding="utf-8")
            for command in commands:
                known = printed if any(file in command for file in files) else self.printed
                if command not in known:
                    known[command] = self.run(command, folder)
                printed[command] = known[command]
        return printed


def renew(page, blocks, printed, source):
    """Writes the page anew. Returns what differs in blocks that a hand has to mend."""
    lines = page.read_text(encoding="utf-8").splitlines()
    left = []
    for block in reversed(blocks):
        if not block.is_held():
            continue
        fresh = renewed(block, printed[block.argument])
        if fresh is None:
            left.append(difference(block, printed[block.argument]))
        elif fresh != block.lines:
            lines[block.at:block.at + len(block.lines)] = fresh
    page.write_text(with_figures("\n".join(lines) + "\n", source), encoding="utf-8")
    return left
