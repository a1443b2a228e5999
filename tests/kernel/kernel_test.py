#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What takt exports for Linux, judged by Linux: Debian's own kernel in an emulated PC (kernel_lab).

usage: kernel_test.py TAKT SOURCE_DIR FRAME_PROBE
"""
import concurrent.futures
import csv
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
TAKT, SOURCE, PROBE = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
LAB = SOURCE / "tests" / "kernel" / "kernel_lab"
NEEDED = ("qemu-system-x86_64", "busybox", "cpio", "tc", "ip", "bridge")
SHIPPED = sorted(path for folder in ("", "tsn", "clocks", "programs", "applications", "validation") for path in (SOURCE / "scenarios" / folder).glob("*.json") if not path.name.endswith("schema.json"))
SOFTWARE = ("-o", "gates=software", "-o", "timestamps=software")


def takt(*arguments):
    done = subprocess.run([TAKT, *map(str, arguments)], capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


def digest(scenario):
    status, page, error = takt("run", scenario, "--duration", "20ms", "--format", "json")
    assert status in (0, 1), error
    return json.loads(page)["digest"]


def in_kernel(folder, timeout=170):
    done = subprocess.run([str(LAB), "--timeout", str(timeout), str(folder)], capture_output=True, text=True)
    if done.returncode == 125:
        raise unittest.SkipTest(done.stderr)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr
    return done.stdout


def interfaces_of(script):
    return sorted(set(re.findall(r"\bdev ((?:eth|swp)\d+)\b", script)), key=lambda name: (len(name), name))


def links_of(script):
    """A pair of virtual interfaces for each that the script names, with the queues of takt's ports."""
    lines = []
    for name in interfaces_of(script):
        lines += [f"link add {name} numtxqueues 8 numrxqueues 8 type veth peer name p{name} numtxqueues 8", f"link set p{name} up"]
    return "\n".join(lines) + "\n"


def without_peers(dump):
    """The other ends of the pairs are no interfaces of the device."""
    interfaces = [each for each in json.loads(dump) if not each.get("ifname", each.get("dev", "")).startswith("p")]
    return json.dumps(interfaces)


def bare(script):
    """Without comments, and without what the addresses are: scripts that differ in these alone are judged once."""
    lines = [line for line in script.splitlines() if not line.startswith("#")]
    return re.sub(r"0[23]:00:5e:[0-9a-f:]{8}", "ADDRESS", "\n".join(lines))


# Scripts take seconds each in the emulated PC: those of a few scenarios in the full tier, of all at night.
AT_NIGHT = os.environ.get("TAKT_TIER") == "night"
FEW = ("two-sources-and-a-gate", "credit-based-shaper", "launch-time", "gates-behind-stream-gates")
# A dump does not say whether VLAN 1 leaves without a tag by default or since somebody wants it: it is not read.
WITHOUT_WAY_BACK = ("window-of-untagged-frame",)
JUDGED = [path for path in SHIPPED if AT_NIGHT or path.stem in FEW]
IN_ONE_KERNEL = 12   # scripts
DUMPS = {"qdisc": "tc -j qdisc show", "link": "ip -j -d link show", "vlan": "bridge -j vlan show"}


class Scripts(unittest.TestCase):
    """Each script of each shipped scenario that is exported without loss runs twice, and what the kernel says is the scenario."""

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name)

    def export(self):
        scripts, nodes = {}, {}
        for scenario in JUDGED:
            out = self.folder / "out" / scenario.relative_to(SOURCE).with_suffix("")
            if takt("export", "linux", scenario, *SOFTWARE, "--out", out)[0] != 0:
                continue
            for script in sorted(out.glob("*.sh")):
                text = script.read_text()
                key = hashlib.sha256(bare(text).encode()).hexdigest()[:12]
                scripts.setdefault(key, text)
                nodes.setdefault(scenario, {})[script.stem] = key
        return scripts, nodes

    def lab(self, number, scripts):
        folder = self.folder / f"lab{number}"
        folder.mkdir()
        run = ["set -u"]
        for key, text in scripts.items():
            (folder / f"{key}.sh").write_text(text)
            (folder / f"{key}.links").write_text(links_of(text))
            run += [f"ip netns add {key}; ip -n {key} -batch /lab/{key}.links"]
            run += [f"ip netns exec {key} sh /lab/{key}.sh; echo \"@status {key} $?\""] * 2
            run += [f"echo \"@dump {key} {name}\"; ip netns exec {key} {command}" for name, command in DUMPS.items()]
            run += [f"echo '@end'; ip netns del {key}"]
        (folder / "run.sh").write_text("\n".join(run) + "\n")
        return folder

    def test_scripts_run_twice_and_come_back(self):
        scripts, nodes = self.export()
        self.assertGreater(len(nodes), 20 if AT_NIGHT else len(FEW) - 1)
        count = -(-len(scripts) // IN_ONE_KERNEL)
        folders = [self.lab(i, dict(list(scripts.items())[i::count])) for i in range(count)]
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            said = "\n".join(pool.map(lambda folder: in_kernel(folder, 400), folders))
        for key, text in scripts.items():
            with self.subTest(script=text.splitlines()[1]):
                self.assertEqual(re.findall(rf"^@status {key} (\d+)$", said, re.M), ["0", "0"], said[max(0, said.find(f"@status {key}") - 500):][:600])
        self.assertNotIn("addattr_l ERROR", said)   # tc 6.1 says so and ends with 0
        dumped = re.findall(r"^@dump (\w+) (\w+)\n(.*)$", said, re.M)
        dumps = {(key, kind): without_peers(text) for key, kind, text in dumped}
        for key, text in scripts.items():
            flags = {each["ifname"]: each["flags"] for each in json.loads(dumps[key, "link"])}
            with self.subTest(up=text.splitlines()[1]):
                for name in interfaces_of(text) + (["br0"] if " br0 " in text else []):
                    self.assertIn("UP", flags[name])
        self.come_back(scripts, nodes, dumps)

    def come_back(self, scripts, nodes, dumps):
        compared = 0
        for scenario, keys in nodes.items():
            if any("police" in scripts[key] or "action gate" in scripts[key] for key in keys.values()):
                continue   # tc -j prints no rates of meters
            if scenario.stem in WITHOUT_WAY_BACK:
                continue
            files = []
            for node, key in keys.items():
                for kind in DUMPS:
                    path = self.folder / "in" / scenario.stem / f"{node}.{kind}.json"
                    path.parent.mkdir(parents=True, exist_ok=True)
                    path.write_text(dumps[key, kind])
                    files.append(f"{node}={path}")
            again = self.folder / "in" / scenario.stem / "again.json"
            with self.subTest(scenario=scenario.name):
                status, _, error = takt("import", "linux", *files, "--into", scenario, "-o", "never-open=accept", "--out", again)
                self.assertEqual(status, 0, error)
                self.assertEqual(digest(scenario), digest(again))
                compared += 1
        self.assertGreater(compared, 15 if AT_NIGHT else len(FEW) - 2)


def line(name, egress=None):
    """h1, two switches and h2, in a line: a stream of each priority without a VLAN, and one in VLAN 7."""
    switch = {"kind": "switch"}
    return {"name": name, "duration": "1s",
            "network": {"nodes": {"h1": {"kind": "host"}, "sw1": switch, "sw2": switch | ({"egress": egress} if egress else {}), "h2": {"kind": "host"}},
                        "links": [{"ends": ["h1", "sw1"]}, {"ends": ["sw1", "sw2"]}, {"ends": ["sw2", "h2"]}]},
            "streams": [{"name": f"p{p}", "from": "h1", "to": "h2", "payload": "46B", "every": "7ms", "pcp": p} for p in range(8)] +
                       [{"name": "v7", "from": "h1", "to": "h2", "payload": "46B", "every": "7ms", "pcp": 5, "vlan": 7}]}


class Frames(unittest.TestCase):
    """Two exported bridges between a talker and a listener, each in a namespace."""

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name)

    def network(self, scenario, commands, *settings):
        """Runs the scripts of all nodes in namespaces that are linked as they are, then the commands."""
        (self.folder / "s.json").write_text(json.dumps(scenario))
        status, _, error = takt("export", "linux", self.folder / "s.json", *SOFTWARE, *settings, "--out", self.folder / "lab")
        self.assertEqual(status, 0, error)
        ports = {}
        for node in scenario["network"]["nodes"]:
            for interface, peer in re.findall(r"^# (\w+) to (\w+), ", (self.folder / "lab" / f"{node}.sh").read_text(), re.M):
                ports[node, peer] = interface
        run = ["set -eu"] + [f"ip netns add {node}" for node in scenario["network"]["nodes"]]
        for link in scenario["network"]["links"]:
            a, b = link["ends"]
            run.append(f"ip link add {ports[a, b]} netns {a} numtxqueues 8 numrxqueues 8 type veth peer name {ports[b, a]} netns {b} numtxqueues 8 numrxqueues 8")
        run += [f"ip netns exec {node} sh /lab/{node}.sh" for node in scenario["network"]["nodes"]]
        shutil.copy(PROBE, self.folder / "lab" / "probe")
        (self.folder / "lab" / "run.sh").write_text("\n".join(run + commands) + "\n")
        return in_kernel(self.folder / "lab")

    def assert_simulated_windows(self, opens, cycle, half):
        """In the simulation frames reach h2 in these windows of the cycle, and no sooner than 10 us after their ends."""
        with open(self.folder / "run" / "frames.csv") as table:
            rows = [row for row in csv.DictReader(table) if row["stream"] in opens and row["event"] == "delivered"]
        self.assertGreater(len(rows), 100)
        for row in rows:
            at = int(row["at_ps"]) / 1e9 % cycle   # ms
            self.assertTrue(opens[row["stream"]] <= at < opens[row["stream"]] + half + 0.01, row)

    def test_tags_cross_two_bridges(self):
        said = self.network(line("tags"), ["ip netns exec h2 /lab/probe hear eth0 4 & sleep 1"] + [f"ip netns exec h1 /lab/probe send eth0 {vlan} {p} 1 1000" for vlan in (0, 7) for p in range(8)] + ["wait"])
        heard = {(int(vlan), int(priority)) for priority, vlan in re.findall(r"^heard (-?\d+) (-?\d+) ", said, re.M)}
        # A frame with a priority tag alone is in VLAN 1 within bridges; its priority stays.
        self.assertEqual(heard, {(vlan, p) for vlan in (1, 7) for p in range(8)}, said[-1500:])

    def test_windows_are_those_of_the_simulation(self):
        cycle, half = 200, 100   # ms
        entries = [{"open": [7], "for": f"{half}ms"}, {"open": [0, 1, 2, 3, 4, 5, 6], "for": f"{half}ms"}]
        scenario = line("windows", [{"to": "h2", "gates": {"entries": entries}}])
        sends = [f"ip netns exec h1 /lab/probe send eth0 7 {p} 200 7000 &" for p in (5, 7)]
        said = self.network(scenario, ["ip netns exec h2 /lab/probe hear eth0 5 & sleep 1"] + sends + ["wait"])
        status, _, error = takt("run", self.folder / "s.json", "--frames", "--out", self.folder / "run")
        self.assertIn(status, (0, 1), error)
        self.assert_simulated_windows({"p7": 0, "p5": half}, cycle, half)
        heard = [(int(p), int(ns) % (cycle * 1_000_000) // 1_000_000) for p, ns in re.findall(r"^heard (\d+) 7 (\d+)$", said, re.M)]
        late = 15   # ms, of an emulated processor
        for priority, opens in ((7, 0), (5, half)):
            times = [at for p, at in heard if p == priority]
            self.assertGreater(len(times), 50, said[-1000:])
            outside = [at for at in times if not (opens <= at < opens + half or opens <= (at - late) % cycle < opens + half)]
            self.assertLess(len(outside), len(times) * 0.03, outside)


class Clocks(unittest.TestCase):
    """ptp4l with exported files elects whom the simulation elects, and sends as often."""

    def test_the_same_grandmaster_and_intervals(self):
        if shutil.which("ptp4l") is None and not pathlib.Path("/usr/sbin/ptp4l").exists():
            self.skipTest("ptp4l is not installed (Debian: linuxptp)")
        scenario = {"name": "gm", "duration": "20s", "network": {"nodes": {"a": {"kind": "host"}, "sw": {"kind": "switch"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "sw"]}, {"ends": ["sw", "b"]}]},
                    "clocks": {"model": "free-running", "gptp": {"log_sync_interval": -2, "link_delay_threshold": "20ms", "nodes": {"sw": {"priority1": 250}, "a": {"priority1": 247}, "b": {"priority1": 246}}}}}
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "s.json").write_text(json.dumps(scenario))
            status, _, error = takt("export", "linux", folder / "s.json", *SOFTWARE, "--out", folder / "lab")
            self.assertEqual(status, 0, error)
            status, page, error = takt("run", folder / "s.json", "--format", "json")
            self.assertIn("b", page, error)
            run = ["set -u; mkdir -p /var/run /run"] + [f"ip netns add {node}" for node in "a sw b".split()]
            run += ["ip link add eth0 netns a type veth peer name swp0 netns sw", "ip link add eth0 netns b type veth peer name swp1 netns sw"]
            run += ["ip -n a link set eth0 up; ip -n b link set eth0 up; ip -n sw link set swp0 up; ip -n sw link set swp1 up"]
            for node, ports in (("a", ["eth0"]), ("sw", ["swp0", "swp1"]), ("b", ["eth0"])):
                run.append(f"ip netns exec {node} ptp4l -f /lab/{node}.ptp4l.conf --uds_address /run/{node} --logging_level 3 " + " ".join(f"-i {port}" for port in ports) + f" >/tmp/{node}.log 2>&1 &")
            run += ["sleep 25"]
            run += [f"echo '@node {node}'; ip netns exec {node} pmc -u -b 0 -t 1 -s /run/{node} 'GET PARENT_DATA_SET' 'GET PORT_DATA_SET' 'GET DEFAULT_DATA_SET'; cat /tmp/{node}.log" for node in "a sw b".split()]
            (folder / "lab" / "run.sh").write_text("\n".join(run) + "\n")
            said = in_kernel(folder / "lab")
        parts = {part.split()[0]: part for part in said.split("@node ")[1:]}
        identity = re.search(r"clockIdentity +(\S+)", parts["b"]).group(1)
        for node, part in parts.items():
            self.assertEqual(re.search(r"grandmasterIdentity +(\S+)", part).group(1), identity, said)
            self.assertEqual(set(re.findall(r"logSyncInterval +(-?\d+)", part)), {"-2"}, said)


if __name__ == "__main__":
    missing = [program for program in NEEDED if shutil.which(program, path="/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin") is None]
    if missing or not list(pathlib.Path("/boot").glob("vmlinuz-*-amd64")):
        print("skipped: no kernel to judge by (Debian: qemu-system-x86 linux-image-amd64 busybox-static cpio iproute2 ethtool kmod); missing:", ", ".join(missing) or "a kernel in /boot")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
