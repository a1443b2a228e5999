#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the takt binary as a user does: exit statuses, options, files, signals.

usage: cli_test.py TAKT SOURCE_FOLDER [unittest options]
"""
import csv
import io
import json
import os
import pathlib
import pty
import re
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

sys.dont_write_bytecode = True
sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent.parent / "support"))
import processes  # noqa: E402

TAKT = ""
SCENARIOS = pathlib.Path()

SMALL = """{"name": "small", "duration": "10ms", "network": {
  "nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]},
  "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms"}],
  "require": [{"stream": "s", "latency": "%s"}]}
"""


def takt(*arguments, cwd=None, timeout=1000):
    """Status, standard output and standard error of one run."""
    done = subprocess.run([TAKT, *map(str, arguments)], capture_output=True, text=True, cwd=cwd, timeout=timeout, check=False)
    return done.returncode, done.stdout, done.stderr


def shipped(name="robot-arm"):
    return SCENARIOS / f"{name}.json"


# What these scenarios are there to show.
MEANT = {
    "policing.json": ("a meter slower than its streams", "a filter that no frame reaches"),
    "credit-and-gates.json": ("a shaper slower than its class",),
    "token-bucket.json": ("a meter slower than its streams",),
    # Published or pinned with lists that run from 0 s on; what is required of them counts from later on.
    **dict.fromkeys(("gates-with-gptp.json", "two-sources-and-a-gate-with-gptp.json", *(f"round-trip-{n}.json" for n in (1, 5, 10, 15, 20))), ("gates that run before clocks are synchronised",)),
}


class CliTest(unittest.TestCase):
    def test_the_reference_is_the_generated_one(self):
        """To renew it: takt schema KIND --reference > docs/reference/KIND.md"""
        for kind in ("scenario", "study", "node", "applications", "key-service", "result", "bound", "verify", "explain", "explore", "schedule", "schedule-scenario", "schedule-change", "compare", "status", "describe", "statistics", "emulate"):
            with self.subTest(kind):
                status, page, _ = takt("schema", kind, "--reference")
                self.assertEqual(status, 0)
                self.assertEqual(page, (SCENARIOS.parent / "docs" / "reference" / f"{kind}.md").read_text())
                self.assertIn("properties", json.loads(takt("schema", kind)[1]))
        self.assertNotEqual(takt("schema", "plant")[0], 0)

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="takt-cli-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, text, name="s.json"):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path


class Help(CliTest):
    def test_help_teaches_by_example(self):
        status, out, err = takt("--help")
        self.assertEqual((status, err), (0, ""))
        for word in ("run", "check", "schema", "Examples:", "takt run scenarios/robot-arm.json"):
            self.assertIn(word, out)

    def test_help_of_run(self):
        status, out, _ = takt("run", "--help")
        self.assertEqual(status, 0)
        for word in ("SCENARIO", "--seed", "--duration", "--set", "--out", "--format", "--quiet", "Examples:", "Exit status"):
            self.assertIn(word, out)

    def test_help_of_check(self):
        status, out, _ = takt("check", "--help")
        self.assertEqual(status, 0)
        self.assertIn("Examples:", out)

    def test_version(self):
        status, out, err = takt("--version")
        self.assertEqual((status, err), (0, ""))
        self.assertRegex(out, r"^takt \d+\.\d+\.\d+, behaviour [1-9]\d*(, revision [0-9a-f]{12}( with changes)?)?\n((with|without) [^\n]+\n)+$")
        self.assertRegex(out, r"\n(with|without) DDS on real nodes \(Cyclone DDS\)\n")

    def test_wrong_usage_is_bad_input(self):
        for arguments in ((), ("simulate",), ("run",), ("run", shipped(), "--colour"), ("run", shipped(), "--format", "xml"),
                          ("run", shipped(), shipped())):
            with self.subTest(arguments=arguments):
                status, out, err = takt(*arguments)
                self.assertEqual((status, out), (2, ""))
                self.assertNotEqual(err, "")


class Companions(CliTest):
    def test_one_of_another_build_refuses(self):
        """As after half of a build, or half of an installation: two behaviours must not fill one store."""
        companion = pathlib.Path(TAKT).resolve().parent / "takt-study"
        for behaviour, status in (("0", 2), (None, 0)):
            environment = {**os.environ, "TAKT_STARTED_BY_BEHAVIOUR": behaviour} if behaviour else None
            done = subprocess.run([companion, "study", "--help"], capture_output=True, text=True, env=environment)
            self.assertEqual(done.returncode, status, done.stderr)
            self.assertEqual("from another build" in done.stderr, status == 2)


class Mistaken(CliTest):
    def test_a_command_that_is_not_there(self):
        for word, meant in (("rnu", "run"), ("chek", "check"), ("Verify", "verify"), ("stduy", "study")):
            with self.subTest(word):
                status, out, err = takt(word, shipped())
                self.assertEqual((status, out), (2, ""))
                self.assertEqual(err, f'takt: no command is called "{word}" (did you mean "{meant}"?)\nRun takt --help for all of them.\n')
        self.assertEqual(takt("frobnicate")[2], 'takt: no command is called "frobnicate"\nRun takt --help for all of them.\n')

    def test_an_option_that_is_not_there(self):
        status, out, err = takt("run", shipped(), "--sed", "4")
        self.assertEqual((status, out), (2, ""))
        self.assertIn('takt: run does not take "--sed" (did you mean "--seed"?)\n', err)
        self.assertIn('takt: check does not take "again"\n', takt("check", shipped(), "again")[2])

    def test_files_for_other_commands_are_recognised(self):
        study = SCENARIOS / "studies" / "slaves-hops-cycle.json"
        status, out, err = takt("run", study)
        self.assertEqual((status, out), (2, ""))
        self.assertEqual(err, f"{study}:1:1: error: a file for another command: found a study, which takt study takes, expected a scenario\n")
        self.assertIn("found a scenario, which takt run, check, bound or verify takes, expected a study", takt("study", shipped())[2])
        takt("run", self.write(SMALL % "1ms"), "--out", self.folder / "out")
        self.assertIn("found the result of a run", takt("check", self.folder / "out" / "result.json")[2])

    def test_what_editors_leave_behind(self):
        path = self.folder / "bom.json"
        path.write_bytes(b"\xef\xbb\xbf" + (SMALL % "1ms").replace("}]}", "},],}").encode())
        self.assertEqual(takt("run", path, "--quiet")[0], 0)


class Terminal(CliTest):
    def on_terminal(self, *arguments, columns=80, **environment):
        """Standard output and status of takt on a terminal of that width."""
        import fcntl
        import struct
        import termios
        leader, follower = pty.openpty()
        fcntl.ioctl(follower, termios.TIOCSWINSZ, struct.pack("HHHH", 50, columns, 0, 0))
        surroundings = {key: value for key, value in os.environ.items() if key != "NO_COLOR"} | {"TERM": "xterm"} | environment
        # What was written last may still be under way when the last writer closes, and is lost then: this end stays open,
        # and a mark behind all of it says where it ends.
        mark = b"\0end\0"
        process = subprocess.Popen([TAKT, *map(str, arguments)], stdout=follower, stderr=subprocess.DEVNULL, env=surroundings)
        said = []
        reader = threading.Thread(target=lambda: said.append(self.read_up_to(leader, mark)))
        reader.start()
        status = process.wait()
        os.write(follower, mark)
        reader.join()
        os.close(follower)
        os.close(leader)
        return said[0].decode().replace("\r\n", "\n"), status

    @staticmethod
    def read_up_to(descriptor, mark):
        octets = b""
        while not octets.endswith(mark):
            octets += os.read(descriptor, 65536)
        return octets.removesuffix(mark)

    def test_verdicts_are_coloured_and_nothing_else(self):
        path = self.write(SMALL % "1ns")
        plain = takt("run", path)[1]
        page, status = self.on_terminal("run", path, columns=200)
        self.assertEqual(status, 1)
        self.assertIn("\033[1;31mFAIL\033[0m", page)
        self.assertIn("small: \033[1;31mfail\033[0m (1 of 1 requirements)", page)
        self.assertEqual(re.sub(r"\033\[[0-9;]*m", "", page), plain)
        self.assertNotIn("\033", plain)
        self.assertIn("\033[32mpass\033[0m", self.on_terminal("run", self.write(SMALL % "1ms"))[0])

    def test_no_color_and_dumb_terminals_are_respected(self):
        path = self.write(SMALL % "1ms")
        self.assertNotIn("\033", self.on_terminal("run", path, NO_COLOR="1")[0])
        self.assertNotIn("\033", self.on_terminal("run", path, TERM="dumb")[0])
        self.assertIn("\033", self.on_terminal("run", path, NO_COLOR="")[0])   # empty means: not set

    def test_tables_fit_eighty_columns(self):
        for name in ("robot-arm", "line-of-switches", "tsn/frer-ring" if (SCENARIOS / "tsn/frer-ring.json").exists() else "redundant-ring"):
            with self.subTest(name):
                page, _ = self.on_terminal("run", shipped(name), "--duration", "1.2s", NO_COLOR="1")
                table = page[page.index("Streams, slowest first") if "Streams, slowest first" in page else page.index(" slowest of "):page.index("usiest ports")]
                self.assertLessEqual(max(map(len, table.splitlines())), 80, table)
                self.assertIn("a wider terminal shows", table)

    def test_decimal_points_stand_below_each_other(self):
        page = takt("run", shipped(), "--duration", "2s")[1]
        rows = page[page.index("Streams, slowest first"):page.index("Busiest ports")].splitlines()[2:-1]
        for column in range(5):
            points = {[m.start() for m in re.finditer(r"\.\d", row)][column] for row in rows}
            self.assertEqual(len(points), 1, rows)

    def test_long_lists_are_elided_in_the_middle(self):
        script = ", ".join(f'{{"at": "{20 + 10 * i}ms", "program": "p", "call": "{("Suspend", "Resume")[i % 2]}", "on": "b"}}' for i in range(40))
        path = self.write('{"name": "many", "duration": "500ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]},'
                          '"programs": [{"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms"}], "script": [{"at": "0ms", "program": "p", "call": "Start"}, ' + script + "]}")
        short = takt("run", path)[1]
        whole = takt("run", path, "--all")[1]
        self.assertRegex(short, r"\n  \.\.\. \d+ more, which --all shows\n")
        self.assertNotIn("--all shows", whole)
        for page in (short, whole):   # both ends are there
            self.assertIn("Start on a", page)
            self.assertIn(" 410 ms                Resume on b", page)
        self.assertEqual(whole.count("Suspend on b"), 20)
        self.assertLess(short.count("Suspend on b"), 20)


class Status(CliTest):
    def test_pass(self):
        self.assertEqual(takt("run", self.write(SMALL % "1ms"), "--quiet")[0], 0)

    def test_requirement_failed(self):
        status, out, _ = takt("run", self.write(SMALL % "1ns"), "--quiet")
        self.assertEqual(status, 1)
        self.assertRegex(out, r"^small: fail \(1 of 1 requirements\), digest [0-9a-f]{16}\n$")

    def test_bad_input(self):
        status, out, err = takt("run", self.write('{"name": "x"}'))
        self.assertEqual((status, out), (2, ""))
        self.assertIn('s.json:1:1: error: the field "network" is missing', err)

    def test_missing_file(self):
        status, out, err = takt("run", self.folder / "none.json")
        self.assertEqual((status, out), (2, ""))
        self.assertIn("none.json: error: the file cannot be opened", err)

    def test_bad_input_as_json(self):
        for command in ("run", "check"):
            status, out, err = takt(command, self.write(SMALL.replace('"seed"', '"x"') % "1ps2"), "--format", "json")
            self.assertEqual((status, err), (2, ""))
            report = json.loads(out)
            self.assertEqual(report["errors"], 1)
            diagnostic = report["diagnostics"][0]
            self.assertEqual((diagnostic["severity"], diagnostic["line"], diagnostic["pointer"]), ("error", 4, "/require/0/latency"))

    def test_check_of_sound_scenarios(self):
        for file in sorted(SCENARIOS.rglob("*.json")):
            if file.name == "takt.schema.json" or file.parent.name == "studies":
                continue
            with self.subTest(file=file.name):
                status, out, err = takt("check", file)
                if '"allow_overload": true' in file.read_text(encoding="utf-8"):   # published runs that overload a link
                    err = "\n".join(line for line in err.splitlines() if "warning at /network: an overloaded link" not in line and "warning at /network: a link that is nearly full" not in line)
                told = [line for line in err.splitlines() if not (file.name in MEANT and any(message in line for message in MEANT[file.name]))]
                self.assertEqual((status, told), (0, []))
                self.assertIn("\nNodes\n", out)

    def test_the_resolved_scenario_of_check_runs_the_same(self):
        status, out, _ = takt("check", shipped(), "--format", "json", "--duration", "1.5s")
        self.assertEqual(status, 0)
        self.assertEqual(takt("run", self.write(out), "--quiet"), takt("run", shipped(), "--quiet", "--duration", "1.5s"))


class Report(CliTest):
    def run_json(self, *arguments):
        status, out, err = takt("run", *arguments, "--format", "json")
        self.assertEqual((status, err), (0, ""))
        return json.loads(out)

    def test_json_holds_what_it_must(self):
        report = self.run_json(shipped())
        self.assertEqual((report["scenario"], report["seed"], report["simulated_ps"], report["verdict"]), ("robot-arm", 1, 10**13, "pass"))
        self.assertRegex(report["digest"], "^[0-9a-f]{16}$")
        self.assertIs(report["partial"], False)
        self.assertGreater(report["events"], 0)
        for requirement in report["requirements"]:
            self.assertLessEqual({"text", "verdict", "measured_ps", "limit_ps"}, requirement.keys())
        for stream in report["streams"].values():
            self.assertLessEqual({"sent", "delivered", "dropped", "latency_ps"}, stream.keys())
            self.assertEqual({"min", "mean", "p50", "p99", "max", "stddev"}, stream["latency_ps"].keys())
            latency = stream["latency_ps"]
            self.assertTrue(latency["min"] <= latency["p50"] <= latency["p99"] <= latency["max"], latency)
            self.assertEqual(stream["sent"], stream["delivered"] + sum(stream["dropped"].values()) + stream["in_flight"])
        program = report["programs"]["trajectory"]
        self.assertEqual([r["kind"] for r in program["reactions"]], ["start", "suspend", "resume", "halt"])
        for reaction in program["reactions"]:
            self.assertLessEqual({"kind", "initiator", "began_ps", "completed_ps", "duration_ps"}, reaction.keys())
            self.assertEqual(reaction["completed_ps"] - reaction["began_ps"], reaction["duration_ps"])
        self.assertEqual(program["states"], {"generator": "Halted", "robot": "Halted"})
        self.assertEqual(program["violations"], [])

    def test_text_shows_the_time_line(self):
        status, out, err = takt("run", shipped())
        self.assertEqual((status, err), (0, ""))
        rows = out.splitlines()
        start = next(i for i, row in enumerate(rows) if row.endswith("Start on generator"))
        self.assertIn("Halted.INIT", rows[start + 1])
        for text in ("Program trajectory: robust handshake, master generator, 1 slave, cycle 200 us", "Suspend on robot", "Requirements",
                     "Streams, slowest first", "Busiest ports"):
            self.assertIn(text, out)
        self.assertRegex(rows[-1], r"^robot-arm: pass, digest [0-9a-f]{16}$")

    def test_runs_are_reproducible(self):
        first = takt("run", shipped(), "--format", "json")
        self.assertEqual(first, takt("run", shipped(), "--format", "json"))

    def test_another_seed_is_another_run(self):
        one, two = (self.run_json(shipped("direct-link"), "--seed", seed) for seed in ("1", "2"))
        self.assertEqual((one["seed"], two["seed"]), (1, 2))
        self.assertNotEqual(one["digest"], two["digest"])

    def test_duration(self):
        path = self.write(SMALL % "1ms")
        self.assertEqual(self.run_json(path, "--duration", "3500us")["streams"]["s"]["sent"], 4)  # at 0, 1, 2 and 3 ms
        self.assertEqual(self.run_json(path, "--duration", "3500us")["simulated_ps"], 3_500_000_000)

    def test_set(self):
        path = self.write(SMALL % "1ms")
        report = self.run_json(path, "--set", "streams.0.every=2ms", "--set", "/name=other", "--set", "streams.0.payload=1B")
        self.assertEqual((report["scenario"], report["streams"]["s"]["sent"]), ("other", 6))  # at 0, 2 .. 10 ms

    def test_what_options_get_wrong_is_bad_input(self):
        path = self.write(SMALL % "1ms")
        cases = ((("--seed", "x"), "/seed"), (("--seed", "-1"), "/seed"), (("--duration", "5"), "/duration"),
                 (("--set", "streams.1.every=2ms", "--set", "streams.7.every=1ms"), "streams.7"), (("--set", "nonsense"), "nonsense"),
                 (("--set", "streams.0.evry=2ms"), "/streams/0/evry"))
        for options, word in cases:
            with self.subTest(options=options):
                status, out, err = takt("run", path, *options)
                self.assertEqual((status, out), (2, ""))
                self.assertIn(word, err)

    def test_from_another_folder(self):
        self.write(SMALL.replace('"every": "1ms"', '"trace": "t.csv"') % "1ms")
        self.write("time,payload\n1us,10B\n20us,20B\n", "t.csv")
        inside = takt("run", "s.json", "--format", "json", cwd=self.folder)
        outside = takt("run", self.folder / "s.json", "--format", "json", cwd="/")
        self.assertEqual(inside, outside)
        self.assertEqual(json.loads(inside[1])["streams"]["s"]["sent"], 2)

    def test_no_bar_and_no_escapes_without_a_terminal(self):
        _, out, err = takt("run", shipped("line-of-switches"))
        self.assertEqual(err, "")
        self.assertNotIn("\033", out)


class Folder(CliTest):
    FILES = {"files.json", "result.json", "scenario.json", "streams.csv", "reactions.csv", "ports.csv", "queues.csv", "histograms.csv"}

    def test_files_are_complete(self):
        out_folder = self.folder / "deep" / "out"
        status, out, err = takt("run", shipped(), "--duration", "2s", "--out", out_folder, "--format", "json")
        self.assertEqual(status, 1)  # some reactions are missing after 2 s
        self.assertEqual(err.count("after the end of the simulation"), 3)
        self.assertEqual({p.name for p in out_folder.iterdir()}, self.FILES)
        self.assertEqual((out_folder / "result.json").read_text(encoding="utf-8"), out)
        report = json.loads(out)
        table = list(csv.DictReader(io.StringIO((out_folder / "streams.csv").read_text(encoding="utf-8"))))
        self.assertEqual([row["stream"] for row in table], list(report["streams"]))
        for row in table:
            self.assertEqual(int(row["max_ps"]), report["streams"][row["stream"]]["latency_ps"]["max"])
        reactions = list(csv.DictReader(io.StringIO((out_folder / "reactions.csv").read_text(encoding="utf-8"))))
        self.assertEqual([row["kind"] for row in reactions], ["start"])
        counts = {}
        for row in csv.DictReader(io.StringIO((out_folder / "histograms.csv").read_text(encoding="utf-8"))):
            counts[row["stream"]] = counts.get(row["stream"], 0) + int(row["count"])
        self.assertEqual(counts, {name: stream["delivered"] for name, stream in report["streams"].items()})

    def test_each_frame_has_its_row(self):
        out_folder = self.folder / "frames"
        _, out, _ = takt("run", shipped(), "--duration", "1.2s", "--out", out_folder, "--frames", "--format", "json")
        report = json.loads(out)
        self.assertEqual({p.name for p in out_folder.iterdir()}, self.FILES | {"frames.csv", "hops.csv"})
        latencies = {}
        with (out_folder / "frames.csv").open(encoding="utf-8", newline="") as file:
            for row in csv.DictReader(file):
                if row["event"] == "delivered":
                    latencies.setdefault(row["stream"], []).append(int(row["latency_ps"]))
                    self.assertEqual(int(row["at_ps"]) - int(row["produced_ps"]), int(row["latency_ps"]))
        for name, stream in report["streams"].items():
            self.assertEqual(len(latencies.get(name, [])), stream["delivered"], name)
            if stream["delivered"] > 0:
                self.assertEqual(max(latencies[name]), stream["latency_ps"]["max"])
        status, _, err = takt("run", shipped(), "--frames")
        self.assertEqual(status, 2)
        self.assertIn("--out DIR", err)

    def test_the_resolved_copy_runs_the_same(self):
        takt("run", shipped(), "--duration", "1.5s", "--seed", "9", "--out", self.folder / "out")
        _, again, _ = takt("run", self.folder / "out" / "scenario.json", "--format", "json")
        self.assertEqual(again, (self.folder / "out" / "result.json").read_text(encoding="utf-8"))

    def test_an_earlier_result_is_replaced(self):
        path = self.write(SMALL % "1ms")
        for seed in ("1", "2"):
            self.assertEqual(takt("run", path, "--seed", seed, "--out", self.folder / "out", "--quiet")[0], 0)
        self.assertEqual(json.loads((self.folder / "out" / "result.json").read_text(encoding="utf-8"))["seed"], 2)

    def test_an_impossible_place(self):
        path = self.write(SMALL % "1ms")
        for place in (path, path / "below", "/proc/takt/out"):
            with self.subTest(place=str(place)):
                status, _, err = takt("run", path, "--out", place)
                self.assertEqual(status, 2)
                self.assertRegex(err, r"^--out: error: no folder that can be written to: found .*\n$")
        self.assertEqual({p.name for p in self.folder.iterdir()}, {"s.json"})

    def test_bad_input_writes_nothing(self):
        path = self.write('{"name": "x", "duration": "1ms", "network": {}}')
        status, _, _ = takt("run", path, "--out", self.folder / "out")
        self.assertEqual(status, 2)
        self.assertEqual({p.name for p in self.folder.iterdir()}, {"s.json"})


class Signals(CliTest):
    def start(self, *arguments, **keywords):
        process = subprocess.Popen([TAKT, "run", str(shipped()), "--duration", "100h", *map(str, arguments)], text=True, **keywords)
        self.addCleanup(lambda: process.poll() is None and process.kill())
        return process

    def interrupt(self, number, *arguments):
        process = self.start(*arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        processes.wait_for_handler(process, number)
        processes.wait_for_work(process, 0.3)
        process.send_signal(number)
        out, err = process.communicate(timeout=processes.PATIENCE)
        return process.returncode, out, err

    def test_interrupt_ends_cleanly(self):
        folder = self.folder / "out"
        status, out, err = self.interrupt(signal.SIGINT, "--format", "json", "--out", folder)
        self.assertEqual((status, err), (130, ""))
        report = json.loads(out)
        self.assertIs(report["partial"], True)
        self.assertIn(report["verdict"], ("undecided",))
        self.assertTrue(0 < report["simulated_ps"] < 360_000 * 10**12)
        self.assertEqual((folder / "result.json").read_text(encoding="utf-8"), out)
        self.assertEqual({p.name for p in folder.iterdir()}, Folder.FILES)

    def test_interrupt_is_marked_in_the_text(self):
        status, out, _ = self.interrupt(signal.SIGTERM)
        self.assertEqual(status, 130)
        self.assertRegex(out, r"PARTIAL: interrupted after \S+ m?s of 360000 s\n")
        self.assertRegex(out, r"robot-arm: undecided, digest [0-9a-f]{16}, partial\n$")

    def test_a_failure_outweighs_an_interrupt(self):
        status, out, _ = self.interrupt(signal.SIGINT, "--quiet", "--set", "require.6.dropped=0", "--set", "require.5.latency=1ns")
        self.assertEqual(status, 1)
        self.assertIn("partial", out)

    def test_a_closed_reader(self):
        """takt run ... | head -1: ends, by SIGPIPE or with a status, and reports no internal error."""
        read_end, write_end = os.pipe()
        os.close(read_end)
        done = subprocess.run([TAKT, "run", str(shipped()), "--duration", "1.5s"], stdout=write_end, stderr=subprocess.PIPE, text=True,
                              timeout=1000, check=False)
        os.close(write_end)
        self.assertIn(done.returncode, (-signal.SIGPIPE, 1, 3))
        self.assertNotIn("internal error", done.stderr)

    def test_no_standard_output(self):
        """A full disk below standard output is not a success."""
        if not os.path.exists("/dev/full"):
            self.skipTest("no /dev/full")
        with open("/dev/full", "w", encoding="utf-8") as full:
            done = subprocess.run([TAKT, "run", str(self.write(SMALL % "1ms"))], stdout=full, stderr=subprocess.PIPE, text=True, timeout=1000, check=False)
        self.assertEqual(done.returncode, 3, done.stderr)

    def test_a_bar_on_a_terminal(self):
        controller, terminal = pty.openpty()
        process = self.start(stdout=subprocess.DEVNULL, stderr=terminal)
        os.close(terminal)
        bar = re.compile(r"\[[=> ]{6,30}\] +\d+\.\d % ")   # the longer the figures behind it, the shorter
        drawn = b""
        while not bar.search(drawn.decode(errors="replace")):
            drawn += os.read(controller, 65536)
        process.send_signal(signal.SIGINT)
        try:
            while chunk := os.read(controller, 65536):
                drawn += chunk
        except OSError:
            pass  # the terminal's other end is closed
        os.close(controller)
        self.assertEqual(process.wait(timeout=processes.PATIENCE), 130)
        self.assertTrue(drawn.endswith(b"\r\033[K"), "the bar removes itself")


if __name__ == "__main__":
    TAKT = os.path.abspath(sys.argv[1])
    SCENARIOS = pathlib.Path(sys.argv[2]) / "scenarios"
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
