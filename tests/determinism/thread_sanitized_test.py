#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Builds the tests of divided runs with ThreadSanitizer and runs them: parts of a run share nothing but their mailboxes, and what is recorded is written while they stand still.

usage: thread_sanitized_test.py SOURCE BUILD_FOLDER
"""
import os
import pathlib
import shutil
import subprocess
import sys

import across_builds

VARIANT = across_builds.Variant("clang++", "Dev", "-O1 -gline-tables-only", "thread")
TESTS = {
    # What is shipped is divided without sanitizers; here a plant, faults, clocks, and a promise that is not kept.
    "takt_division_test": "DividedRun.HasTheResultOfOneThread:DividedRun.DoesWhatTheScriptSaysWhereItBelongs:DividedRun.HasTheClocksOfOneThread:DividedRun.AWrongPromiseEndsTheRun",
    "takt_recording_test": "Recording.IsTheSameForEveryDivision:Recording.IsTheSameWithFaults",
}


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    source, builds = map(pathlib.Path, sys.argv[1:3])
    if shutil.which(VARIANT.compiler) is None:
        print(f"no {VARIANT.compiler} here, left out")
        return 77  # skipped, for ctest
    folder = across_builds.build(source, builds / "clang-tsan", VARIANT, TESTS).parent
    failed = 0
    for name, which in TESTS.items():
        done = subprocess.run([folder / name, "--gtest_brief=1", f"--gtest_filter={which}"], capture_output=True, text=True, env={**os.environ, "TSAN_OPTIONS": "halt_on_error=1"})
        print(f"{name}: {'passed' if done.returncode == 0 else f'ended with {done.returncode}'}")
        if done.returncode != 0:
            failed += 1
            print((done.stdout + done.stderr)[-8000:])
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
