#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Records the shipped scenarios of TSN features and reads the recordings back: captures with tshark, wave forms, time lines.

usage: recordings_test.py TAKT SOURCE_FOLDER [unittest options]
"""
import collections
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

TAKT = ""
SCENARIOS = pathlib.Path()

# What would make captures of hundreds of megabytes, or time lines (a queue that only grows: each frame waits for all before it); what happens in them happens early enough.
SHORT = {"cqf-three-buffers": "200ms", "credit-and-gates": "100ms", "frer-ring": "100ms", "gates-on-a-line": "200ms", "four-talkers": "100ms", "servo": "2s", "token-bucket": "100ms"}


def run(scenario, *arguments):
    """The result of a run as JSON. A requirement may fail where the run was shortened."""
    done = subprocess.run([TAKT, "run", str(scenario), "--format", "json", *map(str, arguments)], capture_output=True, text=True, timeout=1000, check=False)
    if done.returncode not in (0, 1):
        raise AssertionError(f"{scenario.name} ended with {done.returncode}\n{done.stderr}")
    return json.loads(done.stdout)


def tshark(capture, *fields):
    """Rows of fields, as tshark dissects the frames; checksums are verified."""
    command = ["tshark", "-n", "-r", str(capture), "-o", "ip.check_checksum:TRUE", "-o", "udp.check_checksum:TRUE", "-T", "fields"]
    for field in fields:
        command += ["-e", field]
    done = subprocess.run(command, capture_output=True, text=True, timeout=1000, check=True)
    return [line.split("\t") for line in done.stdout.splitlines()]


def waves_of(path):
    """{scope.name: [(time in ps, value)]} of a value change dump, or an AssertionError."""
    names, waves, scopes = {}, {}, []
    time, lines = None, iter(path.read_text(encoding="ascii").splitlines())
    for line in lines:
        words = line.split()
        if words[0] == "$scope":
            scopes.append(words[2])
        elif words[0] == "$upscope":
            scopes.pop()
        elif words[0] == "$var":
            name = ".".join([*scopes, words[4]])
            assert words[3] not in names and name not in waves, line
            names[words[3]] = name
            waves[name] = []
        elif words[0] == "$enddefinitions":
            break
        else:
            assert words[0] in ("$version", "$timescale"), line
    assert not scopes
    for line in lines:
        if line in ("$dumpvars", "$end"):
            continue
        if line[0] == "#":
            assert time is None or int(line[1:]) > time, f"time goes on: {line}"
            time = int(line[1:])
        elif line[0] == "b":
            value, code = line[1:].split()
            waves[names[code]].append((time, int(value, 2)))
        else:
            waves[names[line[1:]]].append((time, int(line[0], 2)))
    return waves


def gate_wave(lists, end):
    """The changes of a gate list's states up to `end`: [(from, [(bits, duration)])], each list in force until the next; all in ps."""
    changes = []
    for number, (start, entries) in enumerate(lists):
        until = lists[number + 1][0] if number + 1 < len(lists) else end + 1
        time, entry = start, 0
        while time < until:
            bits, duration = entries[entry % len(entries)]
            if not changes or changes[-1][1] != bits:
                changes.append((time, bits))
            time, entry = time + duration, entry + 1
    return changes


US = 10**6
MS = 10**9


class RecordingsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="takt-recordings-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def scenarios(self):
        found = sorted([*SCENARIOS.glob("tsn/*.json"), *SCENARIOS.glob("validation/*.json")])
        self.assertGreater(len(found), 15)
        return found

    def record(self, scenario, *arguments):
        out = self.folder / scenario.stem
        return run(scenario, "--out", out, *arguments), out


class Clocks(RecordingsTest):
    def test_ptp_is_dissected(self):
        """Every message type of gPTP, by what Wireshark says of it."""
        seen = collections.Counter()
        for name in ("two-nodes", "ring", "hot-standby"):
            _, out = self.record(SCENARIOS / "clocks" / f"{name}.json", "--duration", "3s", "--pcap", "all")
            rows = tshark(out / "all.pcapng", "_ws.malformed", "_ws.expert", "ptp.v2.messagetype")
            self.assertFalse([row for row in rows if row[0] or row[1]])
            seen.update(row[2] for row in rows)
        # Sync, Pdelay_Req, Pdelay_Resp, Follow_Up, Pdelay_Resp_Follow_Up, Announce
        self.assertEqual({int(kind, 16) for kind in seen}, {0x0, 0x2, 0x3, 0x8, 0xA, 0xB})


class All(RecordingsTest):
    def test_captures_are_sound_and_recording_changes_nothing(self):
        self.assertIsNotNone(shutil.which("tshark"), "this test needs tshark")
        for scenario in self.scenarios():
            with self.subTest(scenario=scenario.name):
                short = ["--duration", SHORT[scenario.stem]] if scenario.stem in SHORT else []
                plain = run(scenario, *short)
                recorded, out = self.record(scenario, "--pcap", "all", "--timeline", "--waves", *short)
                self.assertEqual(recorded, plain)  # digest, number of events and all figures
                rows = tshark(out / "all.pcapng", "_ws.malformed", "_ws.expert", "ip.checksum.status", "udp.checksum.status")
                self.assertEqual(len(rows), sum(port["frames"] for port in plain["ports"]))
                kinds = collections.Counter(map(tuple, rows))
                self.assertLessEqual(set(kinds), {("", "", "1", "1"), ("", "", "", "")}, kinds)
                json.loads((out / "timeline.json").read_text(encoding="utf-8"))
                self.assertTrue(waves_of(out / "waves.vcd"))
                shutil.rmtree(out)


class Threads(RecordingsTest):
    def test_files_are_those_of_one_thread(self):
        side = 16
        hosts = side * side * 10
        network = {"topology": "mesh", "rows": side, "columns": side, "hosts_per_switch": 10, "rate": "1Gbps", "length": "10m", "forwarding_delay": "1us"}
        streams = [{"name": f"s{h}", "from": f"h{h + 1}", "to": f"h{(h * 37 + 13) % hosts + 1}", "payload": "200B", "every": "1ms", "offset": f"{h * 7919 % 1000000}ns"} for h in range(hosts)]
        scenario = self.folder / "plant.json"
        scenario.write_text(json.dumps({"name": "plant", "duration": "1ms", "network": {"generate": [network]}, "streams": streams}), encoding="utf-8")
        kinds = ["--pcap", "all", "--timeline", "--waves", "--frames"]
        folders = {threads: self.folder / f"threads-{threads}" for threads in (1, 2)}
        for threads, out in folders.items():
            done = subprocess.run([TAKT, "run", str(scenario), "--quiet", "--threads", str(threads), "--out", str(out), *kinds], capture_output=True, text=True, timeout=1000, check=True)
            self.assertNotIn("instead of", done.stderr)
        names = sorted(path.name for path in folders[1].iterdir())
        self.assertLessEqual({"all.pcapng", "timeline.json", "waves.vcd", "frames.csv", "hops.csv", "result.json"}, set(names))
        for name in names:
            self.assertEqual((folders[1] / name).read_bytes(), (folders[2] / name).read_bytes(), name)


class Folder(RecordingsTest):
    def takt(self, *arguments):
        done = subprocess.run([TAKT, *map(str, arguments)], capture_output=True, text=True, timeout=1000, check=False)
        self.assertIn(done.returncode, (0, 1, 4), done.stderr)
        return done

    def test_says_what_it_wrote_and_what_to_open(self):
        scenario, out = SCENARIOS / "direct-link.json", self.folder / "out"
        done = self.takt("run", scenario, "--out", out, "--timeline", "--waves", "--pcap", "all")
        self.assertEqual(done.stderr.splitlines(), [
            f"Written to {out}: all.pcapng, timeline.json, waves.vcd, waves.gtkw, scenario.json, result.json, 5 tables (.csv)",
            "To open: all.pcapng in Wireshark, with takt.lua of tools/wireshark; timeline.json in ui.perfetto.dev; waves.gtkw in GTKWave"])
        entry, = json.loads((out / "files.json").read_text())["written"]
        self.assertEqual({*entry["files"], "files.json"}, {path.name for path in out.iterdir()})
        result = json.loads((out / "result.json").read_text())
        self.assertEqual([entry[key] for key in ("command", "takt", "scenario", "digest")], ["run", result["takt"], "direct-link", result["digest"]])
        # Quietly, and as JSON, nothing more is said; what the older run wrote goes all the same.
        self.assertEqual(self.takt("run", scenario, "--out", out, "--frames", "--quiet").stderr, "")
        self.assertFalse({"timeline.json", "waves.vcd", "waves.gtkw", "all.pcapng"} & {path.name for path in out.iterdir()})
        self.assertTrue((out / "hops.csv").exists())
        done = self.takt("run", out / "scenario.json", "--out", out, "--report", out / "page.html")
        self.assertIn("To open: page.html in a browser\nRemoved, of an older run: 2 tables (.csv)\n", done.stderr)
        self.assertFalse((out / "hops.csv").exists())
        self.assertIn("page.html, for a browser", self.takt("run", scenario, "--report", self.folder / "page.html").stderr)

    def test_of_a_verification(self):
        out = self.folder / "worst"
        done = self.takt("verify", SCENARIOS / "direct-link.json", "--out", out, "--budget", "0.05")
        self.assertIn(f"Written to {out}: ", done.stderr)
        older = {path.name for path in out.iterdir()}
        (out / "note.txt").write_text("mine")
        self.takt("verify", SCENARIOS / "validation" / "gates.json", "--out", out, "--budget", "0.05")
        now = {path.name for path in out.iterdir()}
        self.assertIn("note.txt", now)
        self.assertEqual(older & now, {"files.json"})


class Captures(RecordingsTest):
    def test_a_stream_at_all_ports_that_it_passes(self):
        # camera -> sw1 -> generator at 1 Gb/s: 1046 octets, 1 us in the bridge, 50 m of cable; nothing else is there.
        _, out = self.record(SCENARIOS / "robot-arm.json", "--duration", "100ms", "--pcap", "stream:camera", "--pcap", "all", "--pcap", "all")
        rows = tshark(out / "stream-camera.pcapng", "frame.interface_name", "frame.len")
        self.assertEqual({row[0] for row in rows}, {"camera:0 to sw1", "sw1:0 to generator"})
        self.assertEqual({row[1] for row in rows}, {"1046"})
        every = tshark(out / "all.pcapng", "frame.interface_name", "frame.len", "frame.time_epoch")
        self.assertEqual(rows, [row[:2] for row in every if row[1] == "1046"])
        times = [float(row[2]) for row in every]
        self.assertEqual(times, sorted(times))
        self.assertGreater(times[-1], 0.099)

    def test_what_is_no_capture(self):
        def said(*ports):
            done = subprocess.run([TAKT, "run", str(SCENARIOS / "robot-arm.json"), "--out", str(self.folder / "no"), *[a for port in ports for a in ("--pcap", port)]], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertFalse((self.folder / "no").exists())
            return done.stderr
        self.assertIn('no such stream: found "camra"', said("stream:camra"))
        self.assertIn('did you mean "robot"?', said("robto"))
        self.assertIn("no such port", said("robot:7"))

    def test_import_finds_the_talkers(self):
        """What a run sends comes back as streams: those of the scenario, although every port captured them."""
        _, out = self.record(SCENARIOS / "robot-arm.json", "--duration", "300ms", "--pcap", "all")
        done = subprocess.run([TAKT, "import", "pcap", str(out / "all.pcapng")], capture_output=True, text=True, check=True)
        streams = {(stream["from"], stream["to"]): stream for stream in json.loads(done.stdout)["streams"]}
        camera = streams["host-000002", "host-000000"]
        self.assertEqual([camera[key] for key in ("payload", "every", "offset")], ["1000B", "20us", "0s"])
        self.assertNotIn("jitter", camera)
        for there in (("host-000000", "host-000001"), ("host-000001", "host-000000")):   # states of the Program, once a cycle
            self.assertEqual([streams[there][key] for key in ("payload", "every", "encapsulation", "pcp")], ["42B", "200us", "ethernet", 6])
        self.assertIn("further interfaces", done.stderr)


class Dissector(RecordingsTest):
    """With tools/wireshark/takt.lua no frame of takt is mere data, and no message of OPC UA PubSub ends too early."""

    def test_every_frame_is_known(self):
        seen = collections.Counter()
        script = ["-X", f"lua_script:{SCENARIOS.parent / 'tools' / 'wireshark' / 'takt.lua'}"]
        for name in ("robot-arm", "three-slaves-star", "redundant-ring", "applications/opc-ua", "applications/gateway", "applications/dds", "tsn/frer-ring", "tsn/cqf", "clocks/two-nodes"):
            with self.subTest(name=name):
                _, out = self.record(SCENARIOS / f"{name}.json", "--duration", "1100ms", "--pcap", "all")
                command = ["tshark", "-n", "-r", str(out / "all.pcapng"), "-c", "20000", *script, "-T", "fields", "-e", "frame.protocols", "-e", "_ws.malformed", "-e", "takt_uadp.cut_short"]
                done = subprocess.run(command, capture_output=True, text=True, timeout=1000, check=True)
                rows = [line.split("\t") for line in done.stdout.splitlines()]
                self.assertTrue(rows)
                self.assertFalse([row for row in rows if "data" in row[0].split(":") or row[1] or row[2]])
                seen.update(protocol for row in rows for protocol in set(row[0].split(":")))
                shutil.rmtree(out)
        for protocol in ("takt_uadp", "takt_stream", "rtps", "ptp", "ieee8021cb"):
            self.assertGreater(seen[protocol], 0, protocol)

    def test_fields_of_a_state(self):
        _, out = self.record(SCENARIOS / "robot-arm.json", "--duration", "1100ms", "--pcap", "generator")
        command = ["tshark", "-n", "-r", str(out / "generator.pcapng"), "-X", f"lua_script:{SCENARIOS.parent / 'tools' / 'wireshark' / 'takt.lua'}", "-Y", "takt_uadp.program.state", "-T", "fields",
                   "-e", "takt_uadp.program.state", "-e", "takt_uadp.writer_group_id", "-e", "takt_uadp.publisher_id"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=1000, check=True)
        states = [line.split("\t") for line in done.stdout.splitlines()]
        self.assertEqual({(row[1], row[2]) for row in states}, {("1", "1")})
        order = [state for i, (state, *_) in enumerate(states) if i == 0 or states[i - 1][0] != state]
        self.assertEqual(order, ["11", "15", "12", "13"])   # Halted, Halted.INIT, Ready, Running: as the start of the README


class RTags(RecordingsTest):
    """Member frames carry an R-TAG behind the VLAN tag: both members the same numbers, one after the other."""

    def sequences(self, capture):
        rows = tshark(capture, "ieee8021cb.seq", "ieee8021cb.etype", "eth.type", "vlan.etype")
        tagged = [row for row in rows if row[0]]
        for row in tagged:
            self.assertEqual(int(row[1], 16), 0x0800)
            self.assertIn((row[2], row[3]), {("0x8100", "0xf1c1"), ("0xf1c1", "")})
        return rows, [int(row[0], 16) for row in tagged]

    def test_between_split_and_merge(self):
        for name, ports in (("tsn/frer-ring", ("sw1:0", "sw1:1")), ("validation/frer", ("s1:1", "s1:2"))):
            with self.subTest(name=name):
                scenario = SCENARIOS / f"{name}.json"
                _, out = self.record(scenario, "--duration", "19ms", *[a for port in ports for a in ("--pcap", port)])
                captured = [self.sequences(out / f"{port.replace(':', '-')}.pcapng")[1] for port in ports]
                self.assertGreater(len(captured[0]), 15)
                self.assertEqual(captured[0], list(range(len(captured[0]))))
                self.assertEqual(captured[0], captured[1])

    def test_not_outside(self):
        _, out = self.record(SCENARIOS / "validation/frer.json", "--duration", "19ms", "--pcap", "source", "--pcap", "s3:2")
        for file in ("source.pcapng", "s3-2.pcapng"):
            rows, numbers = self.sequences(out / file)
            self.assertGreater(len(rows), 15)
            self.assertEqual(numbers, [])


class Waves(RecordingsTest):
    def test_gates_follow_their_list(self):
        # Class 4 for 20 us, classes 0 and 1 for 980 us.
        _, out = self.record(SCENARIOS / "validation/gates.json", "--waves", "--duration", "20ms")
        waves = waves_of(out / "waves.vcd")
        expected = gate_wave([(0, [(0x10, 20 * US), (0x03, 980 * US)])], 20 * MS)
        self.assertEqual(waves["switch.port2_to_server.gates"], expected)
        self.assertEqual(waves["switch.port0_to_client1.gates"], [(0, 0xFF)])  # no list: open

    def test_another_list_takes_over(self):
        # Asked at 1.5003 s; the new list has a cycle of 500 us and base time 0, so it begins at 1.5005 s (802.1Q 8.6.9.1.1).
        _, out = self.record(SCENARIOS / "tsn/gates-on-a-line.json", "--waves", "--duration", "1503ms")
        waves = waves_of(out / "waves.vcd")
        slow = (0, [(0xC0, 100 * US), (0x0F, 900 * US)])
        fast = (1_500_500 * US, [(0xC0, 100 * US), (0x0F, 400 * US)])
        self.assertEqual(waves["sw2.port1_to_sw3.gates"], gate_wave([slow, fast], 1503 * MS))
        self.assertEqual(waves["sw1.port0_to_sw2.gates"], gate_wave([slow], 1503 * MS))

    def test_a_stuck_gate_shows(self):
        # All gates are open for 400 us after 100 us of class 7 alone; that of class 0 is stuck closed from 50 to 55 ms.
        _, out = self.record(SCENARIOS / "tsn/cut-through-and-bad-frames.json", "--waves", "--duration", "60ms")
        wave = waves_of(out / "waves.vcd")["sw4.port1_to_sw5.gates"]
        seen = {time: bits for time, bits in wave if 50 * MS <= time < 55 * MS}
        self.assertEqual(set(seen.values()), {0x80, 0xFE})
        self.assertEqual({bits for time, bits in wave if time < 50 * MS or time >= 55 * MS + 100 * US}, {0x80, 0xFF})


class TimeLine(RecordingsTest):
    def slices(self, scenario, *arguments):
        _, out = self.record(scenario, "--timeline", *arguments)
        events = json.loads((out / "timeline.json").read_text(encoding="utf-8"), parse_float=str)["traceEvents"]
        ports = {(e["pid"], e["tid"]): e["args"]["name"] for e in events if e["name"] == "thread_name"}
        return [e for e in events if e["ph"] == "X"], ports

    def test_fragments(self):
        # The figures of the scenario's own derivation: 117 octets and an mCRC, the express frame, 1405 octets; 80 ns an octet, 8 of
        # preamble before each.
        slices, _ = self.slices(SCENARIOS / "validation/preemption.json", "--duration", "2500us")
        first_period = [(e["name"], e["args"].get("fragment"), e["args"]["octets"], e["ts"], e["dur"]) for e in slices if float(e["ts"]) < 1000]
        self.assertEqual(sorted(first_period, key=lambda e: float(e[3])), [
            ("bulk", "first", 121, "0.000000", "10.320000"),
            ("express", None, 150, "11.280000", "12.640000"),
            ("bulk", "last", 1405, "24.880000", "113.040000")])
        self.assertEqual(sum(e["args"].get("fragment") == "first" for e in slices), 3)

    def test_slices_of_a_port_do_not_overlap_and_fragments_add_up(self):
        # 12 octets of gap at least between two slices; data octets of all fragments of a frame make the frame.
        slices, ports = self.slices(SCENARIOS / "tsn/preemption-on-a-line.json", "--duration", "50ms")
        by_port = collections.defaultdict(list)
        for e in slices:
            by_port[(e["pid"], e["tid"])].append((round(float(e["ts"]) * 10**6), round(float(e["dur"]) * 10**6), e))
        cut = 0
        for port, own in by_port.items():
            own.sort(key=lambda s: s[0])
            for (start, duration, e), (following, _, _) in zip(own, own[1:]):
                octet = duration // (e["args"]["octets"] + 8)
                self.assertGreaterEqual(following, start + duration + 12 * octet, ports[port])
            lengths = collections.defaultdict(set)
            open_frame = {}
            for _, _, e in own:
                key, part, octets = (e["name"], e["args"]["sequence"]), e["args"].get("fragment"), e["args"]["octets"]
                if part == "first":
                    self.assertEqual(open_frame, {}, "one frame is cut at a time")
                    open_frame = {key: octets - 4}
                    cut += 1
                elif part == "middle":
                    open_frame[key] += octets - 4
                elif part == "last":
                    lengths[e["name"]].add(open_frame.pop(key) + octets)
                else:
                    lengths[e["name"]].add(octets)
            for name, found in lengths.items():
                self.assertEqual(len(found), 1, (ports[port], name, found))
        self.assertGreater(cut, 100)


if __name__ == "__main__":
    TAKT = os.path.abspath(sys.argv[1])
    SCENARIOS = pathlib.Path(sys.argv[2]) / "scenarios"
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
