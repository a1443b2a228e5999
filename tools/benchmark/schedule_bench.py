#!/usr/bin/env python3
"""How many instances of a folder takt schedule decides, and how long it takes: one line a folder below FOLDER.

  tools/benchmark/schedule_bench.py FOLDER [--limit 1s] [--takt build/release/takt]

Reads what takt schedule reads: *.json, *.top with the *.pat whose names begin like it, *_task.csv with *_topo.csv. One thread; times of the processor as takt says them, without reading.
Exit status: 0, also where something is undecided; 1 if takt fails.
"""
import argparse
import pathlib
import re
import subprocess
import sys


def instances_of(folder):
    """Lists of files that takt schedule takes in one go."""
    files = sorted(p for p in folder.rglob("*") if p.is_file())
    for top in (f for f in files if f.suffix == ".top"):
        yield [top, *(f for f in files if f.suffix == ".pat" and f.parent == top.parent and f.name.startswith(top.stem + "_"))]
    tables = [part for f in files if f.name.endswith("_task.csv") for part in (f, f.with_name(f.name.replace("_task.csv", "_topo.csv")))]
    texts = [f for f in files if f.suffix == ".json"]
    for group in (tables, texts):
        for begin in range(0, len(group), 100):
            yield group[begin:begin + 100]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--limit", default="1s")
    parser.add_argument("--takt", default="build/release/takt")
    arguments = parser.parse_args()
    folders = sorted(p for p in arguments.folder.iterdir() if p.is_dir()) or [arguments.folder]
    print(f"{'folder':24} {'instances':>9} {'scheduled':>9} {'infeasible':>10} {'undecided':>9} {'ms together':>12} {'longest ms':>11}")
    for folder in folders:
        verdicts, times = {"scheduled": 0, "infeasible": 0, "undecided": 0}, []
        for files in instances_of(folder):
            done = subprocess.run([arguments.takt, "schedule", *map(str, files), "--jobs", "1", "--limit", arguments.limit], capture_output=True, text=True)
            if done.returncode not in (0, 1, 4):
                sys.exit(f"schedule_bench: {files[0]}: {done.stderr}")
            for verdict in re.findall(r"^[^ ].*?: (scheduled|infeasible|undecided)", done.stdout, re.M):
                verdicts[verdict] += 1
            times += [float(t) for t in re.findall(r"^  in ([0-9.]+) ms of the processor$", done.stdout, re.M)]
        if times:
            print(f"{folder.name:24} {len(times):9} {verdicts['scheduled']:9} {verdicts['infeasible']:10} {verdicts['undecided']:9} {sum(times):12.1f} {max(times):11.2f}")


if __name__ == "__main__":
    main()
