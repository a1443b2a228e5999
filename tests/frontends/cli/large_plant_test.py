#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A plant of 100 x 100 switches with 100,000 hosts and streams, each written out (22 MB): it is checked and runs.

usage: large_plant_test.py TAKT
"""
import os
import pathlib
import random
import subprocess
import sys
import tempfile

SIDE, HOSTS_PER_SWITCH = 100, 10
# Of the whole process, in KiB: 2 GiB, which a computer at a desk has to spare.
MOST_MEMORY = 2 * 1024 * 1024


def plant(out):
    draw = random.Random(1)
    switches, hosts = SIDE * SIDE, SIDE * SIDE * HOSTS_PER_SWITCH
    nodes = [f'"sw{s + 1}": {{"kind": "switch", "forwarding_delay": "1us"}}' for s in range(switches)]
    nodes += [f'"h{h + 1}": {{"kind": "host"}}' for h in range(hosts)]
    links = []
    for s in range(switches):
        if s % SIDE + 1 < SIDE:
            links.append(f'{{"ends": ["sw{s + 1}", "sw{s + 2}"], "rate": "10Gbps"}}')
        if s + SIDE < switches:
            links.append(f'{{"ends": ["sw{s + 1}", "sw{s + 1 + SIDE}"], "rate": "10Gbps"}}')
        links += [f'{{"ends": ["h{s * HOSTS_PER_SWITCH + h + 1}", "sw{s + 1}"]}}' for h in range(HOSTS_PER_SWITCH)]
    streams = []
    for h in range(hosts):
        to = (h + 1 + draw.randrange(hosts - 1)) % hosts
        streams.append(f'{{"name": "s{h + 1}", "from": "h{h + 1}", "to": "h{to + 1}", "payload": "200B", '
                       f'"every": "1ms", "offset": "{h * 7919 % 1_000_000}ns"}}')
    out.write('{"name": "plant", "duration": "1ms", "network": {"nodes": {\n' + ",\n".join(nodes) + '},\n"links": [\n')
    out.write(",\n".join(links) + ']},\n"streams": [\n' + ",\n".join(streams) + "]}\n")


def memory_of(*command):
    with tempfile.TemporaryFile("w+") as output:
        process = subprocess.Popen([str(part) for part in command], stdout=output, stderr=subprocess.STDOUT)
        _, status, used = os.wait4(process.pid, 0)
        output.seek(0)
        text = output.read()
    assert os.waitstatus_to_exitcode(status) == 0, (command, text[-2000:])
    return text, used.ru_maxrss


with tempfile.TemporaryDirectory(prefix="takt-plant-") as folder:
    file = pathlib.Path(folder) / "plant.json"
    with file.open("w", encoding="utf-8") as out:
        plant(out)
    for command in (["check"], ["run", "--quiet"]):
        text, memory = memory_of(sys.argv[1], *command, file)
        print(f"takt {command[0]}: {memory / 1024:.0f} MiB")
        assert ("100000 hosts, 10000 switches" if command[0] == "check" else "digest") in text, text[:500]
        assert memory < MOST_MEMORY, memory
