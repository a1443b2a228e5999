# SPDX-License-Identifier: Apache-2.0
"""Where a workload of takt_bench spends its time: what valgrind counts, the same on every machine, and what the processor counts where it does."""
import json
import re
import subprocess
import tempfile

# Arguments of takt_bench for a short and for a longer run: what is counted is the difference, so that what is done once drops out. Only the event loop is counted: set-up of a plant
# differs from run to run by more than a run takes.
WORKLOADS = {
    "plant": (["plant", "32", "spread", "0.0005"], ["plant", "32", "spread", "0.0025"]),
    "plant-at-once": (["plant", "32", "at-once", "0.0005"], ["plant", "32", "at-once", "0.0025"]),
    "line": (["line", "0.1"], ["line", "0.5"]),
    "line-gates": (["line-gates", "0.1"], ["line-gates", "0.5"]),
    "line-preemption": (["line-preemption", "0.1"], ["line-preemption", "0.5"]),
    "line-short-gates": (["line-short-gates", "0.1"], ["line-short-gates", "0.5"]),
    "line-cbs": (["line-cbs", "0.1"], ["line-cbs", "0.5"]),
    "line-ats": (["line-ats", "0.1"], ["line-ats", "0.5"]),
    "line-psfp": (["line-psfp", "0.1"], ["line-psfp", "0.5"]),
    "line-frer": (["line-frer", "0.1"], ["line-frer", "0.5"]),
    "pair": (["pair", "0.05"], ["pair", "0.25"]),
}
LOOP = "takt::sim::Simulation::run*"
# valgrind's names: reads of instructions, reads and writes of data, and misses of the first and the last cache; branches and those that were guessed wrong.
EVENTS = {"Ir": "instructions", "Dr": "data reads", "Dw": "data writes", "D1mr": "read misses, first cache", "D1mw": "write misses, first cache", "DLmr": "read misses, last cache",
          "DLmw": "write misses, last cache", "Bc": "conditional branches", "Bcm": "guessed wrong"}
COUNTERS = ["instructions", "cache-misses", "branches", "branch-misses"]


def figures_of(text):
    """What takt_bench printed: frame-hops, or simulated nanoseconds where there are none."""
    figures = json.loads(text)
    return figures.get("frame_hops") or figures["simulated_s"] * 1e9


def counted(program, arguments, out):
    done = subprocess.run(["valgrind", "--tool=callgrind", "--cache-sim=yes", "--branch-sim=yes", f"--toggle-collect={LOOP}", f"--callgrind-out-file={out}", program, *arguments], capture_output=True, text=True)
    names = re.search(r"Events\s*: (.*)", done.stderr)
    values = re.search(r"Collected : (.*)", done.stderr)
    if done.returncode != 0 or not names or not values:
        raise SystemExit(f"tools/bench: valgrind did not count\n{done.stderr}")
    return dict(zip(names.group(1).split(), map(int, values.group(1).split()))), figures_of(done.stdout)


def instructions_per_hop(program, workload):
    """Instructions of the event loop per frame-hop; None if valgrind is not there or does not count."""
    counts = []
    for arguments in WORKLOADS[workload]:
        try:
            done = subprocess.run(["valgrind", "--tool=callgrind", f"--toggle-collect={LOOP}",
                                   "--callgrind-out-file=/dev/null", program, *arguments],
                                  capture_output=True, text=True)
        except FileNotFoundError:
            return None
        found = re.search(r"Collected : (\d+)", done.stderr)
        if done.returncode != 0 or not found:
            return None
        counts.append((int(found.group(1)), figures_of(done.stdout)))
    (few, few_hops), (many, many_hops) = counts
    return (many - few) / (many_hops - few_hops)


def by_function(file):
    """Instructions of each function itself."""
    text = subprocess.run(["callgrind_annotate", "--threshold=100", "--show=Ir", "--auto=no", file], capture_output=True, text=True).stdout
    found = {}
    for line in text.splitlines():
        match = re.match(r"\s*([\d,]+) \([^)]*\)\s+(?:\S*?:)?(.*?)(?: \[.*\])?$", line)
        if match and "PROGRAM TOTALS" not in line:
            found[match.group(2)] = found.get(match.group(2), 0) + int(match.group(1).replace(",", ""))
    return found


def perf(program, arguments):
    """What the processor counts, by event; {} where it does not."""
    done = subprocess.run(["perf", "stat", "-x", ";", "-e", ",".join(COUNTERS), program, *arguments], capture_output=True, text=True)
    found = {}
    for line in done.stderr.splitlines():
        fields = line.split(";")
        if len(fields) > 2 and fields[0].isdigit():
            found[fields[2]] = int(fields[0])
    return (found, figures_of(done.stdout)) if found else ({}, 1)


def run(program, workload, top=25):
    short, long = WORKLOADS[workload]
    with tempfile.TemporaryDirectory() as folder:
        few, few_hops = counted(program, short, f"{folder}/short")
        many, many_hops = counted(program, long, f"{folder}/long")
        hops = many_hops - few_hops
        unit = "simulated ns" if workload == "pair" else "frame-hop"
        print(f"{workload}: valgrind, {hops:.0f} {'ns' if workload == 'pair' else 'frame-hops'}\n\n  per {unit}")
        for name, meaning in EVENTS.items():
            if name in many:
                print(f"  {(many[name] - few[name]) / hops:10.3f}  {meaning}")
        before, after = by_function(f"{folder}/short"), by_function(f"{folder}/long")
        rows = sorted(((count - before.get(name, 0), name) for name, count in after.items()), reverse=True)[:top]
        total = many["Ir"] - few["Ir"]
        print(f"\n  instructions per {unit}, of a function itself")
        for count, name in rows:
            print(f"  {count / hops:10.3f}  {100 * count / total:5.1f} %  {name[:140]}")
    try:
        few, few_hops = perf(program, short)
        many, many_hops = perf(program, long)
    except FileNotFoundError:
        few, many = {}, {}
    if not many:
        print("\n  perf stat: nothing, perf is not there or this machine has no counters")
        return
    print(f"\n  perf stat, per {unit}")
    for name, count in many.items():
        print(f"  {(count - few.get(name, 0)) / (many_hops - few_hops):10.3f}  {name}")
