#!/usr/bin/env python3
"""Builds the simulator with other compilers and options and compares the digests of the shipped scenarios.

usage: across_builds.py SOURCE BUILD_FOLDER TAKT_DIGEST

TAKT_DIGEST is the binary that the others must agree with. A compiler that is not there is left out and named.
"""
import concurrent.futures
import os
import pathlib
import shutil
import subprocess
import sys

VARIANTS = {
    "gcc-O0": ("g++", "Debug", ""),
    "clang-O3": ("clang++", "Release", ""),
    "clang-asan-ubsan": ("clang++", "Dev", "address,undefined"),
}
SEEDS = {"clang-asan-ubsan": (1,)}  # it is slow
USUAL_SEEDS = (1, 2)
SHORT = {"ring-1000": "300ms"}
USUAL = "1200ms"


def run(*command):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))} ended with {done.returncode}\n{done.stdout[-4000:]}{done.stderr[-4000:]}")
    return done.stdout.strip()


def build(source, folder, compiler, build_type, sanitizers, tests=()):
    """Builds takt_digest and those tests. A sanitized tree, which is for finding errors, is optimised a little and keeps its lines."""
    flags = "-O1 -gline-tables-only" if sanitizers else ""
    run("cmake", "-S", source, "-B", folder, "-G", "Ninja", f"-DCMAKE_CXX_COMPILER={compiler}", f"-DCMAKE_BUILD_TYPE={build_type}",
        f"-DCMAKE_CXX_FLAGS={flags}", f"-DTAKT_SANITIZE={sanitizers}", f"-DTAKT_TESTS={'ON' if sanitizers else 'OFF'}", "-DTAKT_BENCH=OFF")
    run("cmake", "--build", folder, "--target", "takt_digest", *tests)
    return folder / "takt_digest"


def digest(program, scenario, seed):
    return run(program, scenario, SHORT.get(scenario.stem, USUAL), seed)


def digests(program, runs):
    """What each run, a scenario with a seed, gives."""
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return dict(zip(runs, pool.map(lambda one: digest(program, *one), runs)))


def main():
    source, builds, reference = map(pathlib.Path, sys.argv[1:4])
    scenarios = sorted(p for p in (source / "scenarios").rglob("*.json") if not p.name.endswith(".schema.json") and "studies" not in p.parts)
    if not scenarios:
        sys.exit("no scenarios to compare")
    expected = digests(reference, [(s, seed) for s in scenarios for seed in USUAL_SEEDS])
    bad = compared = 0
    for name, (compiler, build_type, sanitizers) in VARIANTS.items():
        if shutil.which(compiler) is None:
            print(f"{name}: no {compiler} here, left out")
            continue
        program = build(source, builds / name, compiler, build_type, sanitizers)
        for (scenario, seed), found in digests(program, [one for one in expected if one[1] in SEEDS.get(name, USUAL_SEEDS)]).items():
            compared += 1
            if found != expected[scenario, seed]:
                bad += 1
                print(f"{name}: {scenario.name} seed {seed}: digest and events {found}, expected {expected[scenario, seed]}")
    if compared == 0:
        sys.exit("no other compiler to compare with")
    print(f"{compared} runs compared, {bad} differ")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
