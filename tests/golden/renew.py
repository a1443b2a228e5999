#!/usr/bin/env python3
"""Renews the pinned digests of runs, after a change that is meant to change what happens in a run or what the digest
covers, and raises the number of behaviour.

usage: renew.py BUILD_FOLDER [--hour] [--because TEXT]     renews the digests, and the number if one of them changed
       renew.py --number [--because TEXT | --same]         renews the number alone, without a build
       renew.py --check                                    says what is not renewed

BUILD_FOLDER holds takt and takt_runs_test of the changed sources. Renewed are tests/golden/scenario_digests.txt, what the pages show of
outputs (tests/docs/renew.py) and, with --hour (an hour simulated, some minutes), the digest in docs/papers/programs.md. The commit says why they change.

The number of behaviour is the number of lines in src/simulation/results/behaviours.inc; --because adds one: "cut-through starts
behind closed gates, too". tests/golden/behaviour.txt holds it beside what it is the number of: a hash of the pinned
digests and one of docs/reference/result.md, where the meaning of each figure stands. --same keeps the number: there are
only new scenarios, new figures or better words. Lines that two branches add to both files are all kept, so each branch
raises the number; after the merge renew.py --number notes the digests of both.
"""
import argparse
import hashlib
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PIN = "[0-9a-f]{16}"
DIGESTS = "tests/golden/scenario_digests.txt"
MEANINGS = "docs/reference/result.md"
REASONS = "src/simulation/results/behaviours.inc"
NOTED = "tests/golden/behaviour.txt"
HEAD = "# number of behaviour, hash of the pinned digests, hash of the meanings of figures (tests/golden/renew.py)\n"


def digest_of(takt, scenario, *arguments):
    done = subprocess.run([takt, "run", ROOT / "scenarios" / scenario, "--quiet", *arguments], capture_output=True, text=True)
    return re.search(f"digest ({PIN})", done.stdout).group(1)


def renew(path, before, digest):
    """Puts the digest behind the words `before`, which stand there once."""
    text = (ROOT / path).read_text()
    renewed, count = re.subn(f"({re.escape(before)}){PIN}", rf"\g<1>{digest}", text)
    if count != 1:
        sys.exit(f'{path}: "{before}" and a digest stand there {count} times, expected once')
    (ROOT / path).write_text(renewed)


def lines_of(root, path, comment):
    return [line for line in (root / path).read_text().splitlines() if line.strip() and not line.startswith(comment)]


class Behaviour:
    """The number of behaviour of a tree, and what was noted of it."""

    def __init__(self, root=ROOT):
        self.root = root
        self.number = len(lines_of(root, REASONS, "//"))
        self.now = [self._hash(lines_of(root, DIGESTS, "#")), self._hash(lines_of(root, MEANINGS, "\0"))]
        self.noted = [line.split() for line in lines_of(root, NOTED, "#")]

    @staticmethod
    def _hash(lines):
        return hashlib.sha256("\n".join(lines).encode()).hexdigest()[:16]

    def _of_number(self):
        return [noted[1:] for noted in self.noted if noted[0] == str(self.number)]

    def problem(self):
        """What keeps the number from being that of these digests and meanings; empty if it is."""
        if self.noted == [[str(self.number), *self.now]]:
            return ""
        known = self._of_number()
        if not known or self.now in known:
            return f"The number of behaviour is {self.number}, and {NOTED} does not say so: tests/golden/renew.py --number notes it."
        is_of_runs = self.now[0] not in [digests for digests, _ in known]
        what = "pinned digests changed" if is_of_runs else f"meanings of figures changed ({MEANINGS})"
        return (f"The {what}, and the number of behaviour is still {self.number}: stores and results of before would be "
                "taken for those of now. tests/golden/renew.py --number --because "
                '"what runs or figures do differently" raises it; '
                "--same keeps it, if there are only new scenarios, new figures or better words.")

    def must_be_raised(self):
        known = self._of_number()
        return bool(known) and self.now not in known

    def raise_by(self, reason):
        path = self.root / REASONS
        path.write_text(path.read_text() + '"' + reason.replace("\\", "\\\\").replace('"', '\\"') + '",\n')
        self.number += 1

    def note(self):
        (self.root / NOTED).write_text(HEAD + " ".join([str(self.number), *self.now]) + "\n")


def renew_number(because, same):
    behaviour = Behaviour()
    if because:
        behaviour.raise_by(because)
    elif behaviour.must_be_raised() and not same:
        sys.exit(behaviour.problem())
    behaviour.note()
    print(f"behaviour {behaviour.number}")


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("build", nargs="?")
    for option in ("--hour", "--number", "--same", "--check"):
        parser.add_argument(option, action="store_true")
    parser.add_argument("--because")
    options = parser.parse_args()
    if options.check:
        sys.exit(Behaviour().problem() or 0)
    is_line = options.because is None or (options.because.strip() and len(options.because.splitlines()) == 1)
    if not is_line or (options.because and options.same):
        sys.exit("--because: expected a line that says what runs or figures do differently, and not --same")
    if options.number == bool(options.build):
        sys.exit(__doc__)
    if options.build:
        build = pathlib.Path(options.build).resolve()
        was_noted, before = not Behaviour().problem(), lines_of(ROOT, DIGESTS, "#")
        subprocess.run([build / "takt_runs_test", "--gtest_brief=1", "--gtest_filter=Runs.DigestsAreThePinnedOnes"], env={**os.environ, "TAKT_UPDATE_GOLDEN": "1"}, check=True)
        subprocess.run([ROOT / "tests" / "docs" / "renew.py", build], check=True)
        if options.hour:
            renew("docs/papers/programs.md", "Digest of the hour at n = 20: `", digest_of(build / "takt", "papers/programs/round-trip-20.json", "--duration", "3610s"))
        has_only_new_ones = was_noted and set(before) <= set(lines_of(ROOT, DIGESTS, "#"))
        options.same = options.same or has_only_new_ones
    renew_number(options.because, options.same)


if __name__ == "__main__":
    main()
