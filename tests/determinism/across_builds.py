#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Builds the simulator with other compilers and levels of optimisation and compares the digests of the shipped scenarios.

usage: across_builds.py SOURCE BUILD_FOLDER TAKT_DIGEST

TAKT_DIGEST is the binary of a release build (-O3) with which the others must agree. A missing compiler is left out and named.
"""
import concurrent.futures
import dataclasses
import os
import pathlib
import shutil
import subprocess
import sys


@dataclasses.dataclass(frozen=True)
class Variant:
    compiler: str
    build_type: str
    flags: str = ""
    sanitizers: str = ""


VARIANTS = {
    "gcc-O0": Variant("g++", "Debug"),
    "gcc-O1": Variant("g++", "Dev", "-O1"),
    "gcc-O2": Variant("g++", "Dev", "-O2"),
    "clang-O0": Variant("clang++", "Debug"),
    "clang-O2": Variant("clang++", "Dev", "-O2"),
    "clang-O3": Variant("clang++", "Release"),
}
SEEDS = (1, 2)
SHORT = {"ring-1000": "300ms"}
USUAL = "1200ms"


def run(*command):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))} ended with {done.returncode}\n{done.stdout[-4000:]}{done.stderr[-4000:]}")
    return done.stdout.strip()


def build(source, folder, variant, tests=()):
    """Builds takt_digest and those tests; returns the path of takt_digest."""
    run("cmake", "-S", source, "-B", folder, "-G", "Ninja", f"-DCMAKE_CXX_COMPILER={variant.compiler}",
        f"-DCMAKE_BUILD_TYPE={variant.build_type}", f"-DCMAKE_CXX_FLAGS={variant.flags}", f"-DTAKT_SANITIZE={variant.sanitizers}",
        f"-DTAKT_TESTS={'ON' if tests else 'OFF'}", "-DTAKT_BENCH=OFF")
    run("cmake", "--build", folder, "--target", "takt_digest", *tests)
    return folder / "takt_digest"


def shipped_runs(source, seeds=SEEDS):
    """Each shipped scenario with each seed."""
    scenarios = sorted(p for p in (source / "scenarios").rglob("*.json") if not p.name.endswith(".schema.json") and "studies" not in p.parts)
    if not scenarios:
        sys.exit("no scenarios to compare")
    return [(scenario, seed) for scenario in scenarios for seed in seeds]


def digests(program, runs):
    """Digest and number of events of each run."""
    def digest(one):
        scenario, seed = one
        return run(program, scenario, SHORT.get(scenario.stem, USUAL), seed)

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return dict(zip(runs, pool.map(digest, runs)))


def differences(name, found, expected):
    """How many runs differ; each is printed."""
    wrong = [one for one in found if found[one] != expected[one]]
    for scenario, seed in wrong:
        print(f"{name}: {scenario.name} seed {seed}: digest and events {found[scenario, seed]}, expected {expected[scenario, seed]}")
    return len(wrong)


def main():
    source, builds, reference = map(pathlib.Path, sys.argv[1:4])
    runs = shipped_runs(source)
    expected = digests(reference, runs)
    bad = compared = 0
    for name, variant in VARIANTS.items():
        if shutil.which(variant.compiler) is None:
            print(f"{name}: no {variant.compiler} here, left out")
            continue
        bad += differences(name, digests(build(source, builds / name, variant), runs), expected)
        compared += len(runs)
    if compared == 0:
        sys.exit("no other compiler to compare with")
    print(f"{compared} runs compared, {bad} differ")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
