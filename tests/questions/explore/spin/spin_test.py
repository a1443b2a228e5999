#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The explorer against SPIN on the Promela twin (robust.pml): the same number of states, the same verdicts.

usage: spin_test.py TAKT COMPILER [--bench]

Exit status 77 with a reason where SPIN is not installed. --bench prints both rates as JSON.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

TWIN = pathlib.Path(__file__).resolve().parent / "robust.pml"


def output_of(*command, cwd=None):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, cwd=cwd, check=False, timeout=1000)
    return done.stdout + done.stderr


def cpu_seconds():
    times = os.times()
    return times.children_user + times.children_system


def spin(compiler, slaves, calls, faults, broken=0, flags=("-DSAFETY",), options=(), defines=()):
    """States, transitions, errors and CPU seconds of an exhaustive verification; and the assertion that failed."""
    with tempfile.TemporaryDirectory(prefix="takt-spin-") as folder:
        output_of("spin", f"-DN={slaves}", f"-DCALLS={calls}", f"-DFAULTS={faults}", f"-DBREAK={broken}", *defines, "-a", TWIN, cwd=folder)
        made = output_of(compiler, "-O2", "-w", *flags, "-o", "pan", "pan.c", cwd=folder)
        if not (pathlib.Path(folder) / "pan").exists():
            sys.exit(f"spin_test: the verifier does not compile\n{made}")
        began = cpu_seconds()
        text = output_of("./pan", "-m1000000", *options, cwd=folder)
        spent = cpu_seconds() - began
    number = lambda pattern: int(re.search(pattern, text).group(1))
    failed = re.search(r"assertion violated \((\w+)", text)
    return {"states": number(r"(\d+) states, stored"), "transitions": number(r"(\d+) transitions"), "errors": number(r"errors: (\d+)"),
            "cpu_s": spent, "failed": failed.group(1) if failed else "", "text": text}


def explorer(takt, slaves, calls, faults):
    began = cpu_seconds()
    text = output_of(takt, "explore", "--slaves", slaves, "--calls", calls, "--fault-budget", faults, "--faults", "loss,crash", "--beginnings", "switched-on",
                     "--no-symmetry", "--format", "json", "--quiet")
    answer = json.loads(text)
    answer["process_cpu_s"] = cpu_seconds() - began
    return answer


def violated(answer):
    return [name for name, verdict in answer["properties"].items() if verdict == "violated"]


def compare(takt, compiler):
    wrong = []

    def expect(what, found, expected):
        print(f"{what}: {found}" + ("" if found == expected else f", expected {expected}"))
        if found != expected:
            wrong.append(what)

    for slaves, calls, faults in ((1, 2, 0), (1, 3, 1), (1, 3, 2), (2, 2, 0), (2, 1, 1), (2, 2, 1)):
        name = f"{slaves} slaves, {calls} calls, {faults} faults"
        ours = explorer(takt, slaves, calls, faults)
        theirs = spin(compiler, slaves, calls, faults)
        expect(f"{name}: states of SPIN", theirs["states"], ours["states"])
        # SPIN counts the step that checks the goal where nothing changes any more, too, and, as one matched with nothing, the initial state.
        expect(f"{name}: transitions of SPIN", theirs["transitions"], ours["steps"] + ours["quiescent"] + 1)
        expect(f"{name}: errors of SPIN", theirs["errors"], 0)
        expect(f"{name}: violated for the explorer", violated(ours), [])
    # No cycle of network steps at all, so none outside the goal either.
    cycles = spin(compiler, 2, 1, 1, flags=("-DNP",), options=("-l", "-E"), defines=("-DCYCLES",))
    expect("errors of SPIN, cycles", cycles["errors"], 0)
    # A twin that is broken as a mutant of mutants.json is, fails in the same property: S1 is an assertion on was_ready, L1 and F1 on the goal.
    killers = {each["name"]: each["killed_by"] for each in json.loads((TWIN.parent.parent / "mutants" / "mutants.json").read_text(encoding="utf-8"))}
    for broken, mutant, variable, properties in ((1, "ready barrier skips a slave", "was_ready", {"S1"}), (2, "silence is ignored", "", {"F1"}),
                                                 (3, "intents compared by number alone", "", {"L1"})):
        found = spin(compiler, 2, 2, 1, broken)
        expect(f"errors of SPIN, broken: {mutant}", found["errors"], 1)
        expect(f"asserted, broken: {mutant}", found["failed"], variable)
        expect(f"killer of the mutant: {mutant}", killers[mutant] in properties, True)
    return 1 if wrong else 0


def bench(takt, compiler):
    ours = explorer(takt, 2, 3, 1)
    theirs = spin(compiler, 2, 3, 1, flags=())
    print(json.dumps({"states": ours["states"], "spin_states": theirs["states"], "cpu_s": ours["process_cpu_s"], "spin_cpu_s": theirs["cpu_s"]}))
    return 0


def main():
    takt, compiler = sys.argv[1:3]
    if shutil.which("spin") is None:
        print("skipped: spin is not installed (tools/setup test installs it)")
        return 77
    return bench(takt, compiler) if "--bench" in sys.argv else compare(takt, compiler)


if __name__ == "__main__":
    sys.exit(main())
