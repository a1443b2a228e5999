#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""import takt: the same answers as the command, arrays without copies, Ctrl-C, and what it costs.

usage: PYTHONPATH=build/release/python module_test.py TAKT SOURCE_FOLDER [unittest options]
"""
import json
import os
import pathlib
import re
import signal
import sqlite3
import subprocess
import sys
import tempfile
import threading
import time
import unittest

sys.dont_write_bytecode = True
try:
    import numpy
    import pandas
except ImportError as missing:
    print(f"not tested: {missing}")
    sys.exit(77)
import takt

TAKT = ""
SCENARIOS = pathlib.Path()


def command(*arguments):
    return subprocess.run([TAKT, *map(str, arguments)], capture_output=True, text=True, check=False, timeout=1000).stdout


class Questions(unittest.TestCase):
    def test_a_schedule_is_that_of_the_command(self):
        path = SCENARIOS / "tsn" / "automatic-gates.json"
        found = takt.schedule(path)
        told = json.loads(command("schedule", path, "--format", "json"))
        self.assertEqual(found.to_dict(), told)
        self.assertEqual(found.verdict, "scheduled")
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "out.json"
            command("schedule", path, "--out", out)
            self.assertEqual(found.scenario.override(duration="100ms").run().digest, takt.load(out, duration="100ms").run().digest)
        self.assertIsNone(found.solution)
        self.assertEqual(takt.load(path).schedule().to_dict(), told)

    def test_instances_are_scheduled_or_refuted(self):
        def instance(period):
            nodes = [{"name": "a", "bridge": False}, {"name": "b", "bridge": False}]
            links = [{"from": "a", "to": "b", "rate": 1_000_000_000}]
            streams = [{"name": name, "talker": "a", "listeners": ["b"], "octets": 1000, "period": period} for name in "xy"]
            return {"format": "schedule-problem-1", "nodes": nodes, "links": links, "streams": streams}

        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "two.json"
            path.write_text(json.dumps(instance(20_000_000)))
            found = takt.schedule(path, gates=True)
            self.assertEqual((found.verdict, set(found.solution["streams"])), ("scheduled", {"x", "y"}))
            self.assertIn("gates", found.solution)
            path.write_text(json.dumps(instance(16_000_000)))   # two frames of 1,020 octets on the wire take 16.32 us
            found = takt.schedule(path)
            self.assertEqual((found.verdict, found.certificate["kind"], found.solution), ("infeasible", "load", None))
            path.write_text("{")
            with self.assertRaises(takt.Mistake):
                takt.schedule(path)
        with self.assertRaisesRegex(takt.Mistake, "expected feasible"):
            takt.schedule(SCENARIOS / "robot-arm.json", objective="best")

    def test_an_exploration_is_that_of_the_command(self):
        def without_time(page):
            return {**page, "cpu_s": 0}

        found = takt.explore(1, variant="paper", finish=False, calls=2)
        told = json.loads(command("explore", "--slaves", 1, "--variant", "paper", "--no-finish", "--calls", 2, "--format", "json", "--quiet"))
        self.assertEqual(found.to_dict(), without_time(told))
        self.assertIn("violated", set(found.properties.to_dict().values()))
        arm = takt.load(SCENARIOS / "robot-arm.json").explore(faults="loss", calls=2)
        told = json.loads(command("explore", SCENARIOS / "robot-arm.json", "--faults", "loss", "--calls", 2, "--format", "json", "--quiet"))
        self.assertEqual(arm.to_dict(), without_time(told))
        for wrong in ({"slaves": 13}, {"slaves": 1, "faults": ["rain"]}, {"slaves": 1, "calls": -1}, {"slaves": 1, "network": "tubes"}):
            with self.assertRaises(takt.Mistake):
                takt.explore(**wrong)
        with self.assertRaisesRegex(TypeError, "there is no argument 'fault'"):
            takt.explore(1, fault="loss")


class Missing(unittest.TestCase):
    def test_the_compiled_part(self):
        """As where pybind11 was not installed when takt was built: the import says what to do."""
        with tempfile.TemporaryDirectory() as folder:
            package = pathlib.Path(folder) / "takt"
            package.mkdir()
            for file in (SCENARIOS.parent / "src/frontends/python/takt").iterdir():
                (package / file.name).write_bytes(file.read_bytes())
            environment = {**os.environ, "PYTHONPATH": folder}
            done = subprocess.run([sys.executable, "-c", "import takt"], capture_output=True, text=True, check=False,
                                  env=environment)
        self.assertEqual(done.returncode, 1)
        self.assertIn("pybind11-dev", done.stderr.splitlines()[-1])


class SameAnswers(unittest.TestCase):
    def test_a_run_is_that_of_the_command(self):
        for name in ("robot-arm", "three-slaves-star", "redundant-ring"):
            with self.subTest(name):
                result = takt.load(SCENARIOS / f"{name}.json", duration="1.2s").run()
                told = json.loads(command("run", SCENARIOS / f"{name}.json", "--duration", "1.2s", "--format", "json"))
                self.assertEqual(result.digest, told["digest"])
                self.assertEqual(result.to_dict(), told)
                self.assertEqual(result.report(), command("run", SCENARIOS / f"{name}.json", "--duration", "1.2s"))

    def test_keeping_frames_changes_nothing(self):
        arm = takt.load(SCENARIOS / "robot-arm.json", duration="1.2s")
        self.assertEqual(arm.run().digest, arm.run(frames=True).digest)

    def test_overrides_are_those_of_the_command(self):
        arm = takt.load(SCENARIOS / "robot-arm.json").override({"programs.0.cycle": "1ms"}, seed=7, duration="1.2s")
        told = json.loads(command("run", SCENARIOS / "robot-arm.json", "--set", "programs.0.cycle=1ms", "--seed", 7, "--duration", "1.2s", "--format", "json"))
        self.assertEqual(arm.run().to_dict(), told)

    def test_names_are_those_of_the_result(self):
        result = takt.load(SCENARIOS / "robot-arm.json").run()
        self.assertEqual(result.verdict, "pass")
        start = result.programs["trajectory"].reactions[0]
        self.assertEqual((start.kind, start.duration_ps), ("start", start.completed_ps - start.began_ps))
        self.assertEqual(set(result.streams["camera"].latency_ps), {"min", "mean", "p50", "p99", "max", "stddev"})
        with self.assertRaisesRegex(AttributeError, "there is no 'verdikt'"):
            result.verdikt

    def test_bounds_and_verdicts(self):
        arm = takt.load(SCENARIOS / "robot-arm.json")
        self.assertEqual(arm.bound().to_dict(), json.loads(command("bound", SCENARIOS / "robot-arm.json", "--format", "json")))
        proof = arm.verify(budget=2, seeds=1)
        told = json.loads(command("verify", SCENARIOS / "robot-arm.json", "--budget", "2", "--seeds", "1", "--format", "json"))
        self.assertEqual([line.verdict for line in proof.requirements], [line["verdict"] for line in told["requirements"]])

    def test_explanations_and_comparisons_are_those_of_the_commands(self):
        gates = takt.load(SCENARIOS / "tsn" / "gates-on-a-line.json", duration="200ms")
        told = json.loads(command("explain", SCENARIOS / "tsn" / "gates-on-a-line.json", "--duration", "200ms", "--stream", "camera", "--frame", "7", "--format", "json"))
        self.assertEqual(gates.explain("camera", frame=7).to_dict(), told)
        slowest = gates.explain("camera").frames[0]
        self.assertEqual(slowest.takes_ps, gates.run().streams["camera"].latency_ps.max)
        self.assertEqual(sum(part.takes_ps for hop in slowest.hops for part in hop.parts), slowest.takes_ps)
        self.assertEqual(len(gates.explain(lost=True).frames), 0)
        for wrong in (lambda: gates.explain("nobody"), lambda: gates.explain(frame=3), lambda: gates.explain("camera", frame=3, lost=True), lambda: gates.compare(gates, pairs=0)):
            self.assertRaises(takt.Mistake, wrong)
        slower = gates.override({"streams.1.payload": "1000B"})
        found = gates.compare(slower, pairs=2)
        self.assertEqual((found.pairs, found.same_digest), (2, 0))
        self.assertLess(found.measures["latency.mean"].difference.mean, 0)
        self.assertEqual(gates.compare(gates, pairs=2).same_digest, 2)

    def test_a_study_has_the_results_of_the_command(self):
        study = SCENARIOS / "studies" / "slaves-hops-cycle.json"
        with tempfile.TemporaryDirectory() as folder:
            said = command("study", study, "--out", f"{folder}/command.sqlite", "--jobs", "2")
            table = takt.study(study).run(f"{folder}/module.sqlite", jobs=2)
            merged = command("study", "merge", f"{folder}/both.sqlite", f"{folder}/command.sqlite", f"{folder}/module.sqlite")   # refuses other results for a point
            self.assertEqual(said.split()[-1], merged.split()[-1])
            frame = table.to_pandas()
            self.assertEqual(len(frame), len(takt.study(study)))
            self.assertLessEqual({*table.factors, *table.measures, "passes", "status"}, set(frame.columns))
            self.assertEqual(table.behaviour, takt.behaviour)
            self.assertIn(f", behaviour {takt.behaviour}", command("--version").splitlines()[0])
            with sqlite3.connect(f"{folder}/module.sqlite") as database:
                database.execute("UPDATE meta SET value = ? WHERE key = 'behaviour'", (str(takt.behaviour + 1),))
            database.close()
            with self.assertWarnsRegex(UserWarning, f"with behaviour {takt.behaviour + 1}, this is takt .* with behaviour {takt.behaviour}"):
                takt.read_store(f"{folder}/module.sqlite")
            with self.assertRaisesRegex(takt.Mistake, "Go on with a takt of that number"):
                takt.study(study).run(f"{folder}/module.sqlite", resume=True)


class Mistakes(unittest.TestCase):
    def test_all_of_them_with_places(self):
        with self.assertRaises(takt.Mistake) as caught:
            takt.loads('{"name": "x", "duration": 5, "network": {"nodes": {}, "linx": []}}')
        self.assertIn("scenario.json:1:", str(caught.exception))
        self.assertGreaterEqual(len(caught.exception.diagnostics), 2)
        self.assertTrue(all(each["line"] == 1 for each in caught.exception.diagnostics))

    def test_what_is_not_there(self):
        for wrong in (lambda: takt.load("none.json"), lambda: takt.study("none.json"), lambda: takt.read_store("none.sqlite"),
                      lambda: takt.load(SCENARIOS / "robot-arm.json").override(seed="x"), lambda: takt.load(SCENARIOS / "robot-arm.json").bound(clock_error="soon"),
                      lambda: takt.load(SCENARIOS / "robot-arm.json", duration="1ms").run().frames(), lambda: takt.load(SCENARIOS / "robot-arm.json", duration="1ms").run().histogram("none")):
            with self.assertRaises(takt.Mistake):
                wrong()


class Arrays(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.result = takt.load(SCENARIOS / "robot-arm.json", duration="1.2s").run(frames=True)

    def test_frames_are_not_copied_and_cannot_be_written(self):
        frames = self.result.frames()
        for name, column in frames.items():
            self.assertFalse(column.flags.owndata, name)
            self.assertFalse(column.flags.writeable, name)
        again = self.result.frames()
        self.assertEqual(frames.latency_ps.__array_interface__["data"], again.latency_ps.__array_interface__["data"])
        self.assertTrue(numpy.shares_memory(frames.to_pandas()["latency_ps"].to_numpy(), frames.latency_ps))

    def test_frames_outlive_their_run(self):
        frames = takt.load(SCENARIOS / "robot-arm.json", duration="20ms").run(frames=True).frames()
        self.assertEqual(int(frames.produced_ps[0]), int(frames.produced_ps.copy()[0]))

    def test_frames_are_those_of_the_file(self):
        with tempfile.TemporaryDirectory() as folder:
            command("run", SCENARIOS / "robot-arm.json", "--duration", "1.2s", "--out", folder, "--frames")
            told = pandas.read_csv(f"{folder}/frames.csv")
        mine = self.result.frames().to_pandas()
        for column in ("stream", "sequence", "event", "node", "produced_ps"):
            pandas.testing.assert_series_equal(mine[column].astype(told[column].dtype), told[column], check_names=False)
        delivered = told["event"] == "delivered"
        self.assertTrue((mine["latency_ps"][delivered] == told["latency_ps"][delivered]).all())

    def test_columns_agree_with_the_result(self):
        frame = self.result.frames().to_pandas()
        for name, stream in self.result.streams.items():
            rows = frame[(frame["stream"] == name) & (frame["event"] == "delivered")]
            self.assertEqual(len(rows), stream.delivered)
            histogram = self.result.histogram(name)
            self.assertEqual(int(histogram.count.sum()), stream.delivered)

    def test_ten_million_rows_are_a_frame(self):
        frames = self.result.frames()
        times = -(-10_000_000 // len(frames))
        large = takt.Frames.__new__(takt.Frames)
        object.__setattr__(large, "_members", {name: numpy.tile(column, times) for name, column in frames.items()})
        object.__setattr__(large, "_names", {name: frames.names(name) for name in ("stream", "node", "event", "reason")})
        began = time.process_time()   # of this process: other work of the machine does not count
        frame = large.to_pandas()
        took = time.process_time() - began
        print(f"{len(frame)} frame records into a DataFrame: {took:.3f} s", file=sys.stderr)
        self.assertGreaterEqual(len(frame), 10_000_000)   # the time is told, not asked: a busy machine is no mistake


class Cost(unittest.TestCase):
    def test_what_a_point_costs_is_told(self):
        """What Python adds to points of a study: the same results with and without it, and the times of both, which are told and not asked."""
        plan = takt.study(SCENARIOS / "studies" / "slaves-hops-cycle.json")
        points = range(0, len(plan), max(1, len(plan) // 40))
        for point in points:
            plan.run_point(point)
        from takt import _takt
        wrapped = raw = 0.0
        for point in points:
            began = time.process_time()
            bare = _takt.run_point(plan._core, point)
            middle = time.process_time()
            record = plan.run_point(point)
            raw += middle - began
            wrapped += time.process_time() - middle
            self.assertEqual(record.digest, bare["digest"])
        # The binding itself: a point that is refused at once does all of it but the run.
        began = time.process_time()
        for _ in range(1000):
            with self.assertRaises(takt.Mistake):
                plan.run_point(10**12)
        binding = (time.process_time() - began) / 1000
        print(f"overhead of a point: {binding * 1e3:.4f} ms of binding; {len(points)} points: {raw * 1e3 / len(points):.3f} ms raw, {wrapped * 1e3 / len(points):.3f} ms by Plan.run_point", file=sys.stderr)


class Manners(unittest.TestCase):
    def test_other_threads_go_on(self):
        beats = 0
        done = threading.Event()

        def beat():
            nonlocal beats
            while not done.wait(0.002):
                beats += 1
        thread = threading.Thread(target=beat)
        thread.start()
        shares = []
        takt.load(SCENARIOS / "robot-arm.json", duration="8s").run(progress=shares.append)
        done.set()
        thread.join()
        self.assertGreater(beats, 20)
        self.assertEqual(shares, sorted(shares))
        self.assertTrue(all(0 <= share <= 1 for share in shares))

    def test_ctrl_c_ends_a_run(self):
        threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
        began = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            takt.load(SCENARIOS / "robot-arm.json", duration="100h").run()
        self.assertLess(time.monotonic() - began, 60)

    def test_what_progress_raises_comes_out(self):
        def refuse(_share):
            raise RuntimeError("enough")
        with self.assertRaisesRegex(RuntimeError, "enough"):
            takt.load(SCENARIOS / "robot-arm.json", duration="100h").run(progress=refuse)

    def test_pictures_are_svg(self):
        result = takt.load(SCENARIOS / "robot-arm.json").run()
        for figure in result.timeline():
            self.assertTrue(figure._repr_svg_().lstrip().startswith("<svg"))
        self.assertIn("</html>", result.page())

    def test_everything_is_documented_and_typed(self):
        stubs = (pathlib.Path(takt.__file__).parent / "__init__.pyi").read_text()
        for name in takt.__all__:
            thing = getattr(takt, name)
            self.assertTrue(thing.__doc__, name)
            self.assertRegex(stubs, rf"(class|def) {name}\b")
            for member in vars(thing) if isinstance(thing, type) and thing.__module__ == "takt" else ():
                if not member.startswith("_"):
                    self.assertRegex(stubs, rf"(def {member}\b|{member}:)", f"{name}.{member}")


class Page(unittest.TestCase):
    def test_the_example_of_the_tasks_prints_what_its_comments_say(self):
        """The block of Python in docs/i-want-to.md, in the root of the sources."""
        page = (SCENARIOS.parent / "docs" / "i-want-to.md").read_text(encoding="utf-8")
        code = re.search(r"^```python\n(import takt\n.*?)^```", page, re.M | re.S)[1].replace("jobs=4", "jobs=2")
        said = re.findall(r"# (\S+)$", code, re.M)
        done = subprocess.run([sys.executable, "-c", code + "print(len(table))"], capture_output=True, text=True,
                              check=False, timeout=1000, cwd=SCENARIOS.parent)
        self.assertEqual(done.stdout.split(), [*said, "300"], done.stderr)
        self.assertEqual(len(said), 3)


if __name__ == "__main__":
    TAKT, SCENARIOS = sys.argv[1], pathlib.Path(sys.argv[2]) / "scenarios"
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
