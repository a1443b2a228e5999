#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Builds the tests of models, scenarios and properties with AddressSanitizer and UndefinedBehaviorSanitizer, and runs them in short form.

usage: sanitized_tests.py SOURCE BUILD_FOLDER TAKT_DIGEST

The same build runs every shipped scenario; its digests must be those of TAKT_DIGEST. In this build every frame is an allocation of
its own (models/ethernet/frame_pool.hpp), so an access to a frame after its end is found.
"""
import concurrent.futures
import os
import pathlib
import shutil
import subprocess
import sys
import time

import across_builds

VARIANT = across_builds.Variant("clang++", "Dev", "-O1 -gline-tables-only", "address,undefined")
# What each test finds in its environment so that it takes seconds: less of the same cases.
TESTS = {
    "takt_models_parts_test": {},
    "takt_network_test": {},
    "takt_host_test": {},
    "takt_ingress_pipeline_test": {},
    "takt_frer_test": {"RC_PARAMS": "seed=2026 max_success=20"},
    "takt_preemption_test": {},
    "takt_regression_test": {},
    "takt_evaluation_test": {},
    "takt_uadp_test": {},
    "takt_pubsub_test": {},
    "takt_security_test": {},
    "takt_opcua_test": {},
    "takt_network_property_test": {"RC_PARAMS": "seed=2026 max_success=20"},
    "takt_determinism_property_test": {"RC_PARAMS": "seed=2026 max_success=10"},
    "takt_feature_pairs_test": {"GTEST_FILTER": "*Triples*", "RC_PARAMS": "seed=2026 max_success=100"},
}
SANITIZERS = {
    "ASAN_OPTIONS": "detect_stack_use_after_return=1:strict_init_order=1:check_initialization_order=1",
    "UBSAN_OPTIONS": "print_stacktrace=1",
}


def run_test(folder, name):
    began = time.monotonic()
    done = subprocess.run([folder / name, "--gtest_brief=1"], capture_output=True, text=True, env={**os.environ, **SANITIZERS, **TESTS[name]})
    return name, done.returncode, time.monotonic() - began, done.stdout + done.stderr


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    source, builds, reference = map(pathlib.Path, sys.argv[1:4])
    if shutil.which(VARIANT.compiler) is None:
        print(f"no {VARIANT.compiler} here, left out")
        return 77  # skipped, for ctest
    program = across_builds.build(source, builds / "clang-asan-ubsan", VARIANT, TESTS)
    folder = program.parent
    runs = across_builds.shipped_runs(source, seeds=(1,))
    failed = across_builds.differences("sanitized", across_builds.digests(program, runs), across_builds.digests(reference, runs))
    print(f"{len(runs)} runs compared, {failed} differ")
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for name, status, seconds, output in pool.map(lambda name: run_test(folder, name), TESTS):
            print(f"{name}: {'passed' if status == 0 else f'ended with {status}'}, {seconds:.0f} s")
            if status != 0:
                failed += 1
                print(output[-8000:])
    print(f"{len(TESTS)} tests with {VARIANT.sanitizers}, {failed} failures")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
