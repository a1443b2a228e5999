#!/usr/bin/env python3
"""Renews the pinned digests of runs, after a change that is meant to change what happens in a run or what the digest covers.

usage: renew.py BUILD_FOLDER [--hour]

BUILD_FOLDER holds takt and takt_runs_test of the changed sources. Renewed are tests/golden/scenario_digests.txt, the sample output of the README
and, with --hour (an hour simulated, some minutes), the digest in docs/papers/programs.md. The commit says why they change.
"""
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PIN = "[0-9a-f]{16}"


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


def main():
    options = [argument for argument in sys.argv[1:] if argument.startswith("--")]
    folders = [argument for argument in sys.argv[1:] if not argument.startswith("--")]
    if len(folders) != 1 or not set(options) <= {"--hour"}:
        sys.exit(__doc__)
    build = pathlib.Path(folders[0]).resolve()
    subprocess.run([build / "takt_runs_test", "--gtest_brief=1", "--gtest_filter=Runs.DigestsAreThePinnedOnes"], env={**os.environ, "TAKT_UPDATE_GOLDEN": "1"}, check=True)
    renew("README.md", "robot-arm: pass, digest ", digest_of(build / "takt", "robot-arm.json"))
    if "--hour" in options:
        renew("docs/papers/programs.md", "Digest of the hour at n = 20: `", digest_of(build / "takt", "papers/programs/round-trip-20.json", "--duration", "3610s"))


if __name__ == "__main__":
    main()
