#!/usr/bin/env python3
"""Builds takt with other compilers and options and compares the digests of the shipped scenarios.

usage: across_builds.py SOURCE BUILD_FOLDER TAKT

TAKT is the binary that the others must agree with. A compiler that is not there is left out and named.
"""
import json
import pathlib
import shutil
import subprocess
import sys

VARIANTS = {
    "gcc-O0": ("g++", "Debug", ""),
    "clang-O3": ("clang++", "Release", ""),
    "clang-asan-ubsan": ("clang++", "Debug", "address,undefined"),
}
SHORT = {"ring-1000": "300ms"}
USUAL = "1200ms"


def run(*command, **options):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, **options)
    if done.returncode not in (0, 1):  # 1: a requirement failed, because the run was cut short
        sys.exit(f"{' '.join(map(str, command))} ended with {done.returncode}\n{done.stdout[-4000:]}{done.stderr[-4000:]}")
    return done


def build(source, folder, compiler, build_type, sanitizers):
    configured = run("cmake", "-S", source, "-B", folder, "-G", "Ninja", f"-DCMAKE_CXX_COMPILER={compiler}", f"-DCMAKE_BUILD_TYPE={build_type}",
                     f"-DTAKT_SANITIZE={sanitizers}", "-DTAKT_TESTS=OFF", "-DTAKT_BENCH=OFF")
    built = run("cmake", "--build", folder, "--target", "takt")
    if configured.returncode or built.returncode:
        sys.exit(f"the build with {compiler} failed\n{configured.stderr[-4000:]}{built.stdout[-4000:]}")
    return folder / "takt"


def digest(takt, scenario, *options):
    duration = SHORT.get(scenario.stem, USUAL)
    done = run(takt, "run", scenario, "--format", "json", "--duration", duration, *options)
    if not done.stdout:  # a sanitizer ends with 1, too
        sys.exit(f"{takt} run {scenario} {' '.join(options)} printed no result\n{done.stderr[-4000:]}")
    result = json.loads(done.stdout)
    return result["digest"], result["events"]


def main():
    source, builds, reference = map(pathlib.Path, sys.argv[1:4])
    scenarios = sorted(p for p in (source / "scenarios").rglob("*.json") if not p.name.endswith(".schema.json") and "studies" not in p.parts)
    if not scenarios:
        sys.exit("no scenarios to compare")
    expected = {(s, seed): digest(reference, s, "--seed", seed) for s in scenarios for seed in (1, 2)}
    bad = compared = 0
    for name, (compiler, build_type, sanitizers) in VARIANTS.items():
        if shutil.which(compiler) is None:
            print(f"{name}: no {compiler} here, left out")
            continue
        takt = build(source, builds / name, compiler, build_type, sanitizers)
        for (scenario, seed), wanted in expected.items():
            found = digest(takt, scenario, "--seed", seed)
            compared += 1
            if found != wanted:
                bad += 1
                print(f"{name}: {scenario.name} seed {seed}: digest and events {found}, expected {wanted}")
    if compared == 0:
        sys.exit("no other compiler to compare with")
    print(f"{compared} runs compared, {bad} differ")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
