#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What takt schedule decides and how long it takes: used by tools/bench, or for folders of instances alone.

  tools/benchmark/schedule_bench.py FOLDER [--limit 1s] [--takt build/release/takt]

One line a folder below FOLDER, and one for the files in FOLDER itself. Reads what takt schedule reads: *.json, *.top with the *.pat whose names begin like it, *_task.csv with *_topo.csv.
One thread; times of the processor as takt says them, without reading.
Exit status: 0, also where something is undecided; 1 if takt fails.
"""
import argparse
import json
import pathlib
import random
import re
import subprocess
import sys
import tempfile

NS, US = 1_000, 1_000_000  # in ps


def run(takt, *arguments, passes=(0, 1, 4)):
    done = subprocess.run([str(takt), "schedule", *map(str, arguments)], capture_output=True, text=True)
    if done.returncode not in passes:
        sys.exit(f"schedule_bench: takt schedule {' '.join(map(str, arguments))[:300]} ended with {done.returncode}\n{done.stderr}")
    return done.stdout


def instances_of(files):
    """Lists of files that takt schedule takes in one go."""
    files = sorted(files)
    for top in (f for f in files if f.suffix == ".top"):
        sets = [f for f in files if f.suffix == ".pat" and f.parent == top.parent and f.name.startswith(top.stem + "_")]
        if sets:
            yield [top, *sets]
    tables = [part for f in files if f.name.endswith("_task.csv") for part in (f, f.with_name(f.name.replace("_task.csv", "_topo.csv")))]
    texts = [f for f in files if f.suffix == ".json"]
    for group in (tables, texts):
        for begin in range(0, len(group), 100):
            yield group[begin:begin + 100]


def decide(takt, files, limit):
    """How many are scheduled, infeasible and undecided, and ms of the processor of each."""
    verdicts, times = {"scheduled": 0, "infeasible": 0, "undecided": 0}, []
    for group in instances_of(files):
        said = run(takt, *group, "--jobs", 1, "--limit", limit)
        for verdict in re.findall(r"^[^ ].*?: (scheduled|infeasible|undecided)", said, re.M):
            verdicts[verdict] += 1
        times += [float(t) for t in re.findall(r"^  in ([0-9.]+) ms of the processor$", said, re.M)]
    if sum(verdicts.values()) != len(times):
        sys.exit(f"schedule_bench: {sum(verdicts.values())} verdicts but {len(times)} times")
    return verdicts, times


def folders_of(folder):
    """Name and files of each folder in it that holds any, and of the files beside them."""
    for each in sorted(p for p in folder.iterdir() if p.is_dir()):
        yield each.name, [p for p in each.rglob("*") if p.is_file()]
    yield folder.resolve().name, [p for p in folder.iterdir() if p.is_file()]


# --- problems made here: the same on every machine ---

class Draw:
    """Only random(), whose numbers Python keeps the same in all versions."""

    def __init__(self, seed):
        self.source = random.Random(seed)

    def below(self, n):
        return int(self.source.random() * n)

    def pick(self, items):
        return items[self.below(len(items))]


def problem(name, bridges, hosts_of, edges, streams, rate, **link):
    """A neutral problem: `edges` between bridges, `hosts_of` bridges each, a link in both directions."""
    nodes = [{"name": f"b{b}", "bridge": True} for b in range(bridges)]
    pairs = [(f"b{a}", f"b{b}") for a, b in edges]
    for host, bridge in enumerate(hosts_of):
        nodes.append({"name": f"h{host}", "bridge": False})
        pairs.append((f"h{host}", f"b{bridge}"))
    links = [{"from": a, "to": b, "rate": rate, "propagation": 100 * NS, "forwarding": US, **link} for pair in pairs for a, b in (pair, pair[::-1])]
    return {"format": "schedule-problem-1", "name": name, "model": {"strict": True, "no_wait": True}, "nodes": nodes, "links": links, "streams": streams}


def draw_streams(draw, count, hosts, periods, octets, near=None, first=0):
    """Streams between different hosts; with `near` most listeners are at most so many hosts away."""
    out = []
    for s in range(first, first + count):
        talker = draw.below(hosts)
        reach = near if near and draw.below(8) else hosts
        listener = (talker + 1 + draw.below(reach - 1)) % hosts
        period = draw.pick(periods) * US
        out.append({"name": f"s{s}", "talker": f"h{talker}", "listeners": [f"h{listener}"], "period": period, "octets": octets[0] + draw.below(octets[1] - octets[0] + 1),
                    "latency": period})
    return out


def rings(bridges, size=10):
    """Rings of `size` bridges whose first ones are a ring as well."""
    heads = range(0, bridges, size)
    inner = [(h + i, h + (i + 1) % size) for h in heads for i in range(size)]
    return inner + [(h, (h + size) % bridges) for h in heads]


def one_change(takt, changes=200):
    """At 10,000 streams on 2,000 nodes: streams that come and go one by one. Mean and longest ms each, and how many had no place."""
    draw = Draw(1)
    hosts, periods = 1500, [1000, 2000, 4000, 8000]
    plant = problem("plant", 500, [h // 3 for h in range(hosts)], rings(500), draw_streams(draw, 10_000, hosts, periods, (64, 256), near=30), 10**9)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "plant.json").write_text(json.dumps(plant))
        (folder / "new.json").write_text(json.dumps({"streams": draw_streams(draw, changes, hosts, periods, (64, 256), near=30, first=10_000)}))
        run(takt, folder / "plant.json", "--jobs", 1, "--out", folder / "runs.json", passes=(0,))
        leaving = [part for s in range(changes) for part in ("--remove", f"s{50 * s}")]
        said = run(takt, folder / "plant.json", "--to", folder / "runs.json", "--add", folder / "new.json", *leaving, "--out", folder / "changed.json")
        return summary_of(said)


def summary_of(said):
    count, together, slowest, scheduled = re.search(r"^(\d+) changes in ([0-9.]+) ms of the processor, the slowest in ([0-9.]+) ms; (\d+) streams are scheduled$", said, re.M).groups()
    return {"changes": int(count), "mean_ms": float(together) / int(count), "slowest_ms": float(slowest), "scheduled": int(scheduled)}


def failed_links(takt):
    """241 streams, 5 bridges in a full mesh, 15 end stations, 100 Mbit/s; eight times one link fails, in both directions, in the schedule of the whole plant. ms and streams left over of each."""
    draw = Draw(1)
    edges = [(a, b) for a in range(5) for b in range(a)]
    cell = problem("cell", 5, [h // 3 for h in range(15)], edges, draw_streams(draw, 241, 15, [4000, 8000, 16000, 32000], (64, 400)), 10**8)
    out = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "cell.json").write_text(json.dumps(cell))
        run(takt, folder / "cell.json", "--jobs", 1, "--out", folder / "runs.json", passes=(0,))
        for a, b in edges[:8]:
            said = run(takt, folder / "cell.json", "--to", folder / "runs.json", "--fail", f"b{a}>b{b}", "--fail", f"b{b}>b{a}", "--out", folder / "changed.json")
            summary = summary_of(said)
            out.append({"ms": summary["mean_ms"] * summary["changes"], "left_over": 241 - summary["scheduled"]})
    return out


def industrial(seed):
    """A line, ring, tree or ring with chords of 8 to 20 bridges, two hosts each, 20 to 320 streams of 0.5 to 4 ms."""
    draw = Draw(seed)
    bridges = 8 + draw.below(13)
    kind = draw.pick(["line", "ring", "tree", "chords"])
    edges = [(i // 2 if kind == "tree" else i, i + 1) for i in range(bridges - 1)]
    if kind in ("ring", "chords"):
        edges.append((bridges - 1, 0))
    if kind == "chords":
        edges += [(i, i + bridges // 2) for i in range(0, bridges // 2, 2)]
    streams = draw_streams(draw, 20 + draw.below(301), 2 * bridges, [500, 1000, 2000, 4000], (64, 1522))
    return problem(f"{kind}-{seed}", bridges, [h // 2 for h in range(2 * bridges)], edges, streams, 10**9)


def within_entries(takt, networks):
    """Of so many industrial networks: how many have a schedule whose lists are all within 8, and within 16, entries a port."""
    met = {}
    with tempfile.TemporaryDirectory() as name:
        files = [pathlib.Path(name) / f"{seed:05}.json" for seed in range(1, networks + 1)]
        for seed, file in enumerate(files, 1):
            file.write_text(json.dumps(industrial(seed)))
        for entries in (8, 16):
            met[entries] = 0
            for begin in range(0, networks, 100):
                said = json.loads(run(takt, *files[begin:begin + 100], "--jobs", 1, "--limit", "1s", "--gates", "--entries", entries, "--format", "json"))
                for report in said if isinstance(said, list) else [said]:
                    met[entries] += report["verdict"] == "scheduled" and "no_lists" not in report and 0 < report.get("gate_entries", 0) <= entries
    return met


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--limit", default="1s")
    parser.add_argument("--takt", default="build/release/takt")
    arguments = parser.parse_args()
    print(f"{'folder':24} {'instances':>9} {'scheduled':>9} {'infeasible':>10} {'undecided':>9} {'ms together':>12} {'longest ms':>11}")
    for name, files in folders_of(arguments.folder):
        verdicts, times = decide(arguments.takt, files, arguments.limit)
        if times:
            print(f"{name:24} {len(times):9} {verdicts['scheduled']:9} {verdicts['infeasible']:10} {verdicts['undecided']:9} {sum(times):12.1f} {max(times):11.2f}")


if __name__ == "__main__":
    main()
