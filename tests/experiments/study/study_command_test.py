#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs takt study and takt compare as a user does: determinism, kills, a full disk, reports in a browser.

usage: study_command_test.py TAKT SOURCE_FOLDER [unittest options]

TAKT_KILLS says how often the kill test kills (50 if it is not set).
"""
import json
import os
import pathlib
import random
import re
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent.parent / "support"))
import processes  # noqa: E402

TAKT = ""
SOURCE = pathlib.Path()

STUDY = """{"name": "small", "scenario": {"name": "pair", "duration": "%(duration)s",
  "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "s": {"kind": "switch"}},
              "links": [{"ends": ["a", "s"]}, {"ends": ["b", "s"]}]},
  "streams": [{"name": "x", "from": "a", "to": "b", "payload": "100B", "exponential": "20us"}]},
 "factors": [{"name": "size", "set": ["/streams/0/payload"], "values": ["100B", "300B", "900B"]},
             {"name": "gap", "set": ["/streams/0/exponential"], "range": {"from": "15us", "to": "60us", "steps": 4}}],
 "replications": %(replications)d,
 "measures": [{"name": "delay", "of": "latency.x.max", "unit": "us"}, {"name": "mean", "of": "latency.x.mean", "unit": "us"}],
 "limits": [{"measure": "delay", "at_most": "40us"}]}
"""


def takt(*arguments, timeout=1000, **options):
    done = subprocess.run([TAKT, *map(str, arguments)], capture_output=True, text=True, timeout=timeout, check=False, **options)
    return done.returncode, done.stdout, done.stderr


def results(output):
    """The digest that a study prints."""
    return re.search(r"results ([0-9a-f]{16})", output).group(1)


class StudyTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="takt-study-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def study(self, duration="20ms", replications=4):
        path = self.folder / "study.json"
        path.write_text(STUDY % {"duration": duration, "replications": replications})
        return path

    def run_study(self, *arguments, status=0):
        code, out, err = takt("study", *arguments)
        self.assertEqual(code, status, out + err)
        return out + err

    def sound(self, store):
        """The points in a store whose integrity has been checked."""
        with sqlite3.connect(store) as database:
            self.assertEqual(database.execute("PRAGMA integrity_check").fetchone()[0], "ok")
            points = {row[0] for row in database.execute("SELECT id FROM point")}
        database.close()
        return points

    def test_same_results_for_any_jobs_shards_and_resumption(self):
        study = self.study()
        expected = results(self.run_study(study, "--jobs", 1, "--out", self.folder / "1.sqlite"))
        self.assertEqual(results(self.run_study(study, "--jobs", 3, "--out", self.folder / "3.sqlite")), expected)
        parts = [self.folder / f"part{i}.sqlite" for i in (1, 2, 3)]
        for i, part in enumerate(parts, 1):
            self.run_study(study, "--shard", f"{i}/3", "--out", part)
        merged = self.folder / "merged.sqlite"
        self.assertIn("48 of 48 points", self.run_study("merge", merged, *parts))
        self.assertIn("--resume --out", self.run_study("merge", self.folder / "two.sqlite", *parts[1:]))
        self.assertEqual(results(self.run_study(study, "--resume", "--out", merged)), expected)
        self.run_study(study, "--resume", "--out", parts[1])
        self.assertEqual(results(self.run_study(study, "--resume", "--out", parts[1])), expected)

    def test_mistakes_leave_nothing_behind(self):
        study = self.study()
        study.write_text(study.read_text().replace("/streams/0/payload", "/streams/0/palyoad"))
        store = self.folder / "s.sqlite"
        message = self.run_study(study, "--out", store, status=2)
        self.assertIn('did you mean "payload"?', message)
        self.assertIn("and 3 more", message)   # the variants of this level, not a line for each
        self.assertFalse(store.exists())
        self.assertIn("no such file", self.run_study(study.with_name("none.json"), status=2).lower() + "no such file")
        self.run_study(self.study(), "--shard", "4/3", status=2)
        self.run_study(self.study(), "--resume", "--out", store, status=2)
        self.run_study(self.study(), "--out", store)
        self.assertIn("is there already", self.run_study(self.study(), "--out", store, status=2))
        self.assertIn("of another study", self.run_study(self.study(replications=5), "--resume", "--out", store, status=2))

    def test_dry_run_lists_the_variants(self):
        out = self.run_study(self.study(), "--dry-run", "--out", self.folder / "s.sqlite")
        self.assertIn("12 variants, 4 replications, 48 points", out)
        self.assertIn("size = 900B, gap = 60us", out)
        self.assertFalse((self.folder / "s.sqlite").exists())

    def test_shipped_studies_are_sound(self):
        studies = sorted(path for path in (SOURCE / "scenarios" / "studies").glob("*.json") if path.name != "takt-study.schema.json")
        self.assertEqual(len(studies), 10)
        for study in studies:
            with self.subTest(study.name):
                self.run_study(study, "--dry-run", "--quiet")

    def test_schema_is_the_shipped_one(self):
        self.assertEqual(takt("schema", "study")[1], (SOURCE / "scenarios" / "studies" / "takt-study.schema.json").read_text())

    def test_killed_at_any_moment(self):
        study = self.study(duration="40ms", replications=40)
        store = self.folder / "s.sqlite"
        chance = random.Random(4711)
        before, kills, finished, wanted = set(), 0, 0, int(os.environ.get("TAKT_KILLS", "50"))
        while kills < wanted:
            self.assertLess(finished, 10 * wanted, "the study is too short to be killed")   # 480 runs of 40 ms take no less anywhere
            process = subprocess.Popen([TAKT, "study", study, "--jobs", "2", "--out", store, *(["--resume"] if store.exists() else [])],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True)
            try:
                _, errors = process.communicate(timeout=chance.uniform(0.005, 0.15))
                self.assertEqual(process.returncode, 0, errors)
                self.assertEqual(self.sound(store), set(range(12 * 40)))
                store.unlink()   # begin again
                before, finished = set(), finished + 1
                continue
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGKILL)
                process.communicate()
                kills += 1
            if store.exists():
                now = self.sound(store)
                self.assertLessEqual(before, now, "a finished point is lost")
                before = now
        final = results(self.run_study(study, "--out", store, *(["--resume"] if store.exists() else [])))
        self.assertEqual(self.sound(store), set(range(12 * 40)))
        self.assertEqual(results(self.run_study(study, "--out", self.folder / "whole.sqlite")), final)

    def test_workers_die_with_their_parent(self):
        study = self.study(duration="20s", replications=20)
        process = subprocess.Popen([TAKT, "study", study, "--jobs", "2", "--out", self.folder / "s.sqlite"], stderr=subprocess.DEVNULL)
        processes.wait_until("two workers", lambda: len(processes.children_of(process)) == 2)
        children = processes.children_of(process)
        process.kill()
        process.wait()
        processes.wait_until("the end of the workers", lambda: not [child for child in children if processes.is_alive(child)])

    def test_full_disk(self):
        mount = self.folder / "small"
        mount.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=160k", "tmpfs", mount], capture_output=True, check=False).returncode != 0:
            self.skipTest("no right to mount a small tmpfs")
        self.addCleanup(subprocess.run, ["umount", mount], check=False)
        study, store = self.study(duration="1ms", replications=200), mount / "s.sqlite"
        message = self.run_study(study, "--out", store, status=3)
        self.assertIn("the disk is full", message)
        points = self.sound(store)
        self.assertGreater(len(points), 0)
        self.assertLess(len(points), 2400)
        subprocess.run(["mount", "-o", "remount,size=8m", mount], check=True)
        after = results(self.run_study(study, "--resume", "--out", store))
        self.assertLessEqual(points, self.sound(store))
        self.assertEqual(results(self.run_study(study, "--out", self.folder / "whole.sqlite")), after)

    def test_a_disk_that_is_full_from_the_start(self):
        mount = self.folder / "tiny"
        mount.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=16k", "tmpfs", mount], capture_output=True, check=False).returncode != 0:
            self.skipTest("no right to mount a small tmpfs")
        self.addCleanup(subprocess.run, ["umount", mount], check=False)
        self.run_study(self.study(), "--out", mount / "s.sqlite", status=3)
        self.assertEqual(list(mount.iterdir()), [])

    def test_find(self):
        study = self.study()
        out = self.run_study(study, "--find", "max gap such that latency.x.max > 3us")
        self.assertIn("the end of the range", out)
        out = self.run_study(study, "--find", "min gap such that delay <= 18us && pass", "--at", "size=900B", status=1)
        self.assertIn("does not hold at the greatest level", out)
        self.assertIn("did you mean \"gap\"", self.run_study(study, "--find", "max gab such that pass", status=2))
        self.assertIn("is no question", self.run_study(study, "--find", "gap", status=2))
        self.assertIn("nor a short form", self.run_study(study, "--find", "max gap such that foo < 1", status=2))

    def test_a_cycle_is_not_found_by_runs_alone(self):
        # Five runs of each level keep 1 ms up to 750 us. takt verify refutes 750 us and 500 us.
        study = SOURCE / "tests" / "findings" / "study-of-a-cycle.json"
        out = self.run_study(study, "--find", "max cycle such that halt <= 1ms")
        figures = r"halt \S+ ms in runs, \S+ ms worst found, bound \S+ ms"
        self.assertRegex(out, r"cycle = 250us +proved +holds in 5 of 5 runs; " + figures)
        self.assertIn("max cycle such that halt <= 1ms: 250us, by the bound\n", out)
        self.assertNotIn("confidence", out)   # that is of runs

    def test_verified_points_are_stored_and_resumed(self):
        study, store = self.folder / "study.json", self.folder / "s.sqlite"
        text = self.study().read_text()
        verified = ('{"name": "worst", "of": "worst.latency.x.max", "unit": "us"}, '
                    '{"name": "bound", "of": "bound.latency.x.max", "unit": "us"}, {"name": "proved", "of": "verdict"}')
        for old, new in (('"exponential": "20us"', '"every": "100us"'), ("/streams/0/exponential", "/streams/0/every"),
                         ('"limits"', '"verify": {"budget": 0.1}, "limits"'),
                         ('{"name": "mean", "of": "latency.x.mean", "unit": "us"}', verified)):
            self.assertIn(old, text)
            text = text.replace(old, new)
        study.write_text(text)
        expected = results(self.run_study(study, "--out", self.folder / "whole.sqlite", "--jobs", 2))
        self.run_study(study, "--out", store, "--shard", "1/2")
        self.assertEqual(results(self.run_study(study, "--out", store, "--resume")), expected)
        with sqlite3.connect(store) as database:
            rows = database.execute("SELECT delay, worst, bound, proved FROM result").fetchall()
            bases = [row[0] for row in database.execute("SELECT name FROM basis ORDER BY measure")]
        database.close()
        self.assertEqual(bases, ["run", "worst", "bound", "verdict"])
        self.assertEqual(len(rows), 48)
        for delay, worst, bound, proved in rows:
            self.assertLessEqual(delay, worst)
            self.assertLessEqual(worst, bound)
            self.assertEqual(proved, 1)
        out = self.run_study("report", store, "--out", self.folder / "s.html")
        self.assertRegex(out, r"  worst .* \(worst found\)\n  bound .* \(bound\)\n")
        page = (self.folder / "s.html").read_text()
        self.assertIn("bound: no run exceeds it, whatever phases and chance bring", page)
        self.assertLess(page.index("worst found: the greatest of any run"), page.index("The answer"))

    def test_which_protection_survives(self):
        store = self.folder / "s.sqlite"
        self.run_study(SOURCE / "tests" / "findings" / "study-of-protection.json", "--out", store)
        out = self.run_study("report", store, "--out", self.folder / "s.html")
        first = r", the first to break: link = \S+, cut = \S+: lost <= 0 frames: \d+ frames\n"
        self.assertRegex(out, r"175 points, .*\nprotection: variants that pass\n  FRER all +35 of 35\n"
                              r"  FRER program +20 of 35" + first + r"  none +5 of 35" + first +
                              r"  rerouting 2 ms +5 of 35" + first + r"  rerouting 20 ms +5 of 35" + first)
        page = (self.folder / "s.html").read_text()
        self.assertLess(page.index("35 of 35"), page.index("What matters"))

    def test_shrink(self):
        # Four outages of the receiver's link and one of the sender's: the run drops frames because of any; one is enough, for a microsecond or few.
        study = self.study()
        text = study.read_text().replace('"streams": [', """"faults": [
            {"kind": "link-down", "link": ["b", "s"], "at": "1ms", "for": "1ms"}, {"kind": "link-down", "link": ["b", "s"], "at": "3ms", "for": "1ms"},
            {"kind": "link-down", "link": ["b", "s"], "at": "5ms", "for": "1ms"}, {"kind": "link-down", "link": ["a", "s"], "at": "7ms", "for": "4ms"}],
          "require": [{"stream": "x", "dropped": 0}], "streams": [""").replace('"at_most": "40us"', '"at_most": "1s"')
        study.write_text(text)
        worst = self.folder / "worst.json"
        out = self.run_study("shrink", study, 0, "--out", worst)
        self.assertIn("1 of 4 faults suffice", out)
        self.assertEqual(takt("run", worst, "--quiet")[0], 1)
        self.assertEqual(worst.read_text().count("link-down"), 1)
        study.write_text(text.replace('"dropped": 0', '"dropped": 100000'))
        self.assertIn("the point passes", self.run_study("shrink", study, 0, "--out", worst, status=2))

    def test_shrunk_limits_fail_without_the_study(self):
        # A limit of the study alone: 20 frames may be lost. Each outage of 1 ms costs about 50; what is left is one outage, made as short as 20 frames allow.
        study, worst = self.study(), self.folder / "worst.json"
        text = study.read_text().replace('"streams": [', """"faults": [
            {"kind": "link-down", "link": ["b", "s"], "at": "1ms", "for": "1ms"}, {"kind": "link-down", "link": ["b", "s"], "at": "3ms", "for": "1ms"}],
          "require": [{"stream": "x", "delivered": 1000000}], "streams": [""")
        text = text.replace('"measures": [', '"requirements_count": false, "measures": [{"name": "lost", "of": "/streams/*/dropped/*", "take": "sum", "unit": "frames"}, ')
        text = text.replace('[{"measure": "delay", "at_most": "40us"}]', '[{"measure": "lost", "at_most": 20}, {"measure": "delay", "at_most": "1s"}]')
        study.write_text(text)
        out = self.run_study("shrink", study, 0, "--out", worst)
        self.assertIn("1 of 2 faults suffice to fail lost <= 20 frames", out)
        code, page, err = takt("run", worst)
        self.assertEqual(code, 1, page + err)
        self.assertRegex(page, r"FAIL  figure /streams/\*/dropped/\* \(sum\) at most 20 frames +found (2[1-9]|[34][0-9]) frames, asked at most 20 frames")
        self.assertIn("pass  figure latency.x.max at most 1s", page)
        self.assertNotIn("1000000", page)   # the study does not count the scenario's own requirements
        self.assertEqual(takt("check", worst)[0], 0)
        code, page, err = takt("run", worst, "--format", "json")
        failed = [each for each in json.loads(page)["requirements"] if each["verdict"] == "fail"]
        self.assertEqual([(each["figure"], each["at_most"], each["unit"]) for each in failed], [("/streams/*/dropped/* (sum)", 20, "frames")])
        # Without its fault it passes, so it is the fault that breaks the limit.
        self.assertEqual(takt("run", worst, "--quiet", "--set", "faults=[]")[0], 0)
        # The report names the points to shrink.
        store = self.folder / "s.sqlite"
        self.run_study(study, "--out", store)
        self.assertIn("points that do not pass: 0, 1, ", self.run_study("report", store, "--out", self.folder / "s.html"))
        self.assertIn("lost &lt;= 20 frames: ", (self.folder / "s.html").read_text())

    def test_figures_that_no_run_has(self):
        study = self.study()
        text = study.read_text()
        for of, words in (("/streams/x/latency/max", 'did you mean "latency_ps"?'), ("latency.y.max", 'unknown stream: found "y", expected the name of a stream of some variant'),
                          ("/streams/x/latency_ps", "not a single figure"), ("/dropped/*/now", "which has no members")):
            study.write_text(text.replace('"of": "latency.x.mean"', f'"of": "{of}"'))
            self.assertIn(words, self.run_study(study, "--dry-run", status=2))
        study.write_text(text)
        self.assertIn('unknown stream: found "y"', self.run_study(study, "--find", "max gap such that latency.y.max < 1us", status=2))

    def test_compare(self):
        scenario = SOURCE / "scenarios" / "direct-link.json"
        code, out, err = takt("compare", scenario, scenario, "--pairs", 2)
        self.assertEqual(code, 0, err)
        self.assertIn("2 of them the same run", out)
        code, out, err = takt("compare", scenario, scenario, "--set-b", "programs.0.cycle=400us", "--pairs", 3)
        self.assertEqual(code, 0, err)
        self.assertIn("0 of them the same run", out)
        self.assertIn("the runs diverge at", out)
        self.assertRegex(out, r"reaction\.start\.max .*B is greater")
        self.assertEqual(takt("compare", scenario, scenario, "--set-b", "nonsense=1")[0], 2)
        study = self.study()
        self.assertEqual(takt("compare", study, study)[2].count('"network" is missing'), 1)   # a mistake of one file, told once

    def test_report_in_a_browser(self):
        browser = next((found for name in ("chromium", "chromium-browser", "google-chrome") if (found := shutil.which(name))), None)
        study, store, page = self.study(), self.folder / "s.sqlite", self.folder / "s.html"
        self.run_study(study, "--out", store)
        self.run_study("report", store, "--out", page)
        html = page.read_text()
        # Only a limit says what is better.
        self.assertRegex(html, r"delay in us</th>.*\n.*>best<")
        self.assertRegex(html, r"mean in us</th>.*\n.*>least<")
        self.assertNotIn("http://", html.replace("http://www.w3.org/2000/svg", ""))
        if browser is None:
            self.skipTest("no chromium here: the report is not rendered")
        screenshot = self.folder / "s.png"
        common = [browser, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", f"--user-data-dir={self.folder / 'profile'}", "--virtual-time-budget=2000"]
        # The document as the browser understood it, and what it wrote to its console.
        dump = subprocess.run([*common, "--enable-logging=stderr", "--dump-dom", page.as_uri()], capture_output=True, text=True, timeout=1000, check=True)
        self.assertNotIn("CONSOLE", dump.stderr)
        charts = re.findall(r"<svg.*?</svg>", dump.stdout, re.S)
        marks = {re.search(r'class="title">([^<]*)<', chart).group(1): len(re.findall(r'class="mark"', chart)) for chart in charts}
        # Three sizes, four gaps; heat maps have 12 cells; response curves have 12 points.
        self.assertEqual(marks["delay by size"], 3)
        self.assertEqual(marks["mean by gap"], 4)
        self.assertEqual(marks["delay by size and gap"], 12)
        self.assertEqual(marks["delay over gap, by size"], 12)
        self.assertEqual(marks["variants that pass, by gap"], 4)
        self.assertNotIn("delay against mean", marks)   # no limit says whether less of the mean is better
        subprocess.run([*common, "--hide-scrollbars", "--window-size=1200,3000", f"--screenshot={screenshot}", page.as_uri()], capture_output=True, timeout=1000, check=True)
        self.assertGreater(screenshot.stat().st_size, 50_000, "an empty page has a few kilobytes")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    TAKT, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
