#!/usr/bin/env python3
"""Breaks the handshake in one place at a time and expects that the explorer, or a test of the handshake, notices.

usage: mutants.py --sources FOLDER --compiler CXX --archives A.a... --probe PROBE.o --tests TEST.o... [--gtest LIB...]
                  [--only NAME] [--print]

Each edit of mutants.json replaces a piece of text that occurs exactly once in a copy of src/handshake/FILE. Only that file is
compiled anew (of a header, all that include it); the object goes before the library that holds the right one. A mutant that survives the explorer is shown
to the property tests of the handshake. Exit status 0: all were killed by what mutants.json says kills them.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent


def mutated(sources, mutant):
    """The changed files, by name."""
    texts = {}
    for edit in mutant["edits"]:
        name = edit["file"]
        text = texts.get(name) or (sources / "src" / "handshake" / name).read_text(encoding="utf-8")
        if text.count(edit["from"]) != 1:
            sys.exit(f"mutants: \"{mutant['name']}\": the text to replace occurs {text.count(edit['from'])} times in {name}: {edit['from']!r}")
        texts[name] = text.replace(edit["from"], edit["to"])
    return texts


def run(command, timeout):
    try:
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=timeout, check=False)
        return done.returncode, done.stdout, done.stderr
    except subprocess.TimeoutExpired as late:
        return None, (late.stdout or b"").decode() if isinstance(late.stdout, bytes) else late.stdout or "", ""


def killer_of(options, mutant, folder):
    """What kills the mutant: a property, "check", a test's name; None if it survives. And the question, for people."""
    made = []
    changed = mutated(options.sources, mutant)
    # A header comes before the right one, and whoever may look into it is compiled anew.
    (folder / "handshake").mkdir()
    for name, text in changed.items():
        (folder / "handshake" / name).write_text(text, encoding="utf-8")
    units = {name for name in changed if name.endswith(".cpp")}
    if len(units) < len(changed):
        units |= {each.name for each in (options.sources / "src" / "handshake").glob("*.cpp") if '"handshake/participant.hpp"' in each.read_text(encoding="utf-8")}
    for name in sorted(units):
        source = folder / "handshake" / name if name in changed else options.sources / "src" / "handshake" / name
        made.append(folder / f"{name}.o")
        includes = ["-I", folder, "-I", options.sources, "-I", options.sources / "src"]
        status, _, err = run([options.compiler, "-std=c++20", "-O1", *includes, "-c", source, "-o", made[-1]], 300)
        if status != 0:
            return "does not compile", err[:2000]
    probe = folder / "probe"
    status, _, err = run([options.compiler, options.probe, *made, *options.archives, "-o", probe], 300)
    if status != 0:
        return "does not link", err[:2000]
    status, out, _ = run([probe], 300)
    lines = out.splitlines() or [""]
    if status is None:
        return "no end", lines[-1]
    if status != 0:
        return "CHECK", lines[-1]
    if lines[-1].startswith("killed "):
        if mutant.get("chart", "") not in out:
            return "another chart", out
        return lines[-1].split()[1], lines[-2]
    tests = folder / "tests"
    status, _, err = run([options.compiler, *options.tests, *made, *options.archives, *options.gtest, "-lpthread", "-o", tests], 300)
    if status != 0:
        return "does not link", err[:2000]
    status, out, _ = run([tests, "--gtest_fail_fast", "--gtest_brief=1"], 300)
    if status == 0:
        return None, "survived"
    failed = [line.split("]")[1].split("(")[0].split(",")[0].strip() for line in out.splitlines() if "  FAILED  ]" in line]
    return (failed[0] if failed else "CHECK"), "tests of the handshake"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sources", type=pathlib.Path, required=True)
    parser.add_argument("--compiler", required=True)
    parser.add_argument("--archives", nargs="+", required=True)
    parser.add_argument("--probe", required=True)
    parser.add_argument("--tests", nargs="+", required=True)
    parser.add_argument("--gtest", nargs="*", default=[])
    parser.add_argument("--only")
    parser.add_argument("--print", action="store_true", help="the table of who kills what, as Markdown")
    options = parser.parse_args()
    mutants = json.loads((HERE / "mutants.json").read_text(encoding="utf-8"))
    if options.only:
        mutants = [each for each in mutants if options.only in each["name"] or options.only == each["killed_by"]]

    def judged(mutant):
        with tempfile.TemporaryDirectory(prefix="takt-mutant-") as folder:
            return mutant, *killer_of(options, mutant, pathlib.Path(folder))

    wrong = 0
    with concurrent.futures.ThreadPoolExecutor(max_workers=min(4, os.cpu_count() or 1)) as pool:
        for mutant, killer, where in pool.map(judged, mutants):
            as_said = killer == mutant["killed_by"]
            wrong += not as_said
            if options.print:
                print(f"| {mutant['name']} | {killer} | {where} |", flush=True)
            elif not as_said:
                print(f"\"{mutant['name']}\": expected to be killed by {mutant['killed_by']}, found {killer} ({where})", flush=True)
    print(f"{len(mutants)} mutants, {len(mutants) - wrong} killed as expected")
    return 0 if wrong == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
