#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Verdicts for continuous integration: names of requirements, --only, --junit, several scenarios a call; the help.

usage: integration_test.py TAKT SOURCE_FOLDER [unittest options]
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as xml

TAKT = ""
SOURCE = pathlib.Path()

# A frame with a payload of 100 octets has 154 octets at 1 Gb/s, 1.232 us, and 50 ns of cable.
NETWORK = {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]}
STREAM = {"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms"}
MET = {"name": "REQ-1", "stream": "s", "latency": "1ms"}
BROKEN = {"name": "REQ-2", "stream": "s", "latency": "1ns"}
COUNT = {"name": "REQ-3", "stream": "s", "delivered": 5}
# Of which takt has no bound: neither proved nor refuted.
OPEN = {"name": "REQ-4", "figure": "utilisation", "at_most": 1}


def takt(*arguments, cwd=None):
    """Status, standard output and standard error of one run."""
    command = [TAKT, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, cwd=cwd, timeout=600, check=False)
    return done.returncode, done.stdout, done.stderr


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="takt-ci-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, stem, *require, **more):
        path = self.folder / f"{stem}.json"
        scenario = {"name": stem, "duration": "10ms", "network": NETWORK, "streams": [STREAM], "require": require}
        path.write_text(json.dumps({**scenario, **more}), encoding="utf-8")
        return path

    def suites(self, name="v.xml"):
        return xml.parse(self.folder / name).getroot()


class Names(Folder):
    def test_reports_call_a_requirement_by_its_name(self):
        file = self.write("x", MET, COUNT)
        for command in ("run", "verify"):
            with self.subTest(command):
                page = takt(command, file)[1]
                self.assertRegex(page, r"pass +REQ-1: stream s latency at most 1ms")
                report = json.loads(takt(command, file, "--format", "json")[1])
                self.assertEqual([(each["name"], each["text"]) for each in report["requirements"]],
                                 [("REQ-1", "stream s latency at most 1ms"), ("REQ-3", "stream s delivers at least 5")])
        self.assertIn("REQ-1: stream s latency", takt("bound", file)[1])
        self.assertIn("REQ-1: stream s latency", takt("explain", file)[1])
        page = self.folder / "page.html"
        takt("run", file, "--report", page)
        self.assertIn("REQ-1: stream s latency", page.read_text(encoding="utf-8"))

    def test_a_name_is_that_of_one_requirement(self):
        status, _, err = takt("check", self.write("x", MET, {**COUNT, "name": "REQ-1"}))
        self.assertEqual(status, 2)
        self.assertIn('error at /require/1/name: a name twice: found "REQ-1", expected a name that no other requi', err)
        self.assertEqual(takt("check", self.write("x", {**MET, "name": ""}))[0], 2)

    def test_one_without_a_name_has_none(self):
        report = json.loads(takt("run", self.write("x", {"stream": "s", "latency": "1ms"}), "--format", "json")[1])
        self.assertNotIn("name", report["requirements"][0])


class Only(Folder):
    def texts(self, command, *arguments):
        status, out, err = takt(command, *arguments, "--format", "json")
        self.assertEqual(err, "")
        return status, [each["text"] for each in json.loads(out)["requirements"]]

    def test_a_name_a_spelling_or_a_part_of_it(self):
        file = self.write("x", MET, BROKEN, COUNT)
        for command in ("run", "verify"):
            for only, status, texts in ((["REQ-1"], 0, ["stream s latency at most 1ms"]),
                                        (["stream s latency at most 1ns"], 1, ["stream s latency at most 1ns"]),
                                        (["*latency*"], 1, ["stream s latency at most 1ms",
                                                            "stream s latency at most 1ns"]),
                                        (["REQ-3", "REQ-1"], 0, ["stream s latency at most 1ms",
                                                                 "stream s delivers at least 5"])):
                with self.subTest(command=command, only=only):
                    options = [word for each in only for word in ("--only", each)]
                    self.assertEqual(self.texts(command, file, *options), (status, texts))

    def test_what_is_not_asked_for_still_holds_for_the_others(self):
        """A frame that is lost breaks a latency, unless another requirement says how many may be."""
        losses = {"faults": [{"kind": "frame-errors", "link": ["a", "b"], "loss": 0.3}]}
        file = self.write("x", MET, {"stream": "s", "dropped": 10}, **losses)
        self.assertEqual(self.texts("run", file, "--only", "REQ-1"), (0, ["stream s latency at most 1ms"]))

    def test_an_unknown_name_is_a_mistake(self):
        for command in ("run", "verify"):
            status, out, err = takt(command, self.write("x", MET), "--only", "REQ-2", "--junit", self.folder / "v.xml")
            self.assertEqual((status, out), (2, ""))
            self.assertEqual(err, '--only: error: unknown requirement: found "REQ-2", expected the name or the spelling '
                                  'of a requirement, with * for any text (did you mean "REQ-1"?)\n')
            self.assertFalse((self.folder / "v.xml").exists())

    def test_one_of_several_scenarios(self):
        a, b = self.write("a", MET), self.write("b", BROKEN)
        status, out, err = takt("run", a, b, "--only", "REQ-1", "--quiet")
        self.assertEqual((status, out.count("\n")), (0, 1))
        self.assertIn("b.json is left out: none of its requirements is asked for", err)


class Junit(Folder):
    def cases(self, root):
        return {case.get("name"): case for case in root.iter("testcase")}

    def properties(self, case):
        return {each.get("name"): each.get("value") for each in case.iter("property")}

    def test_each_requirement_is_a_case_with_verdict_figure_and_limit(self):
        file = self.write("x", MET, BROKEN, COUNT)
        self.assertEqual(takt("run", file, "--junit", self.folder / "v.xml", "--quiet")[0], 1)
        root = self.suites()
        counts = [root.get(name) for name in ("tests", "failures", "skipped", "errors")]
        self.assertEqual((root.tag, counts), ("testsuites", ["3", "1", "0", "0"]))
        self.assertEqual([(each.get("name"), each.get("tests")) for each in root], [("x", "3")])
        cases = self.cases(root)
        self.assertEqual(self.properties(cases["REQ-1: stream s latency at most 1ms"]),
                         {"verdict": "pass", "measured": "1.282us", "limit": "1ms", "remark": "10 frames"})
        broken = cases["REQ-2: stream s latency at most 1ns"]
        self.assertEqual((broken.get("classname"), broken.get("file")), ("x", str(file)))
        outcomes = [(each.tag, each.get("type")) for each in broken if each.tag != "properties"]
        self.assertEqual(outcomes, [("failure", "fail")])
        self.assertIn("1.282 us of 1 ns", broken.find("failure").get("message"))

    def test_a_verification_has_its_three_figures(self):
        file = self.write("x", MET, BROKEN)
        where = ("--junit", self.folder / "v.xml", "--out", self.folder / "worst")
        self.assertEqual(takt("verify", file, *where, "--quiet")[0], 1)
        cases = self.cases(self.suites())
        found = self.properties(cases["REQ-1: stream s latency at most 1ms"])
        self.assertEqual({key: found[key] for key in ("verdict", "simulated", "adversarial", "bound", "limit")},
                         {"verdict": "pass", "limit": "1ms",
                          **dict.fromkeys(("simulated", "adversarial", "bound"), "1.282us")})
        self.assertTrue(pathlib.Path(found["replay"]).is_file())
        self.assertEqual(cases["REQ-2: stream s latency at most 1ns"].find("failure").get("type"), "refuted")

    def test_undecided_is_skipped_and_says_why(self):
        self.assertEqual(takt("verify", self.write("x", OPEN), "--junit", self.folder / "v.xml", "--quiet")[0], 4)
        root = self.suites()
        self.assertEqual((root.get("failures"), root.get("skipped")), ("0", "1"))
        self.assertRegex(next(root.iter("skipped")).get("message"), r"^undecided: .+")

    def test_it_is_well_formed_whatever_the_names_are(self):
        for name in ('<&>"\'', "]]>", "\ufffe\uffff", "M\u00fchle \u2192 \U0001f642", "a" * 100, "&#0;"):
            with self.subTest(name):
                file = self.write("x", {**MET, "name": name}, name=name)
                self.assertEqual(takt("run", file, "--junit", self.folder / "v.xml", "--quiet")[0], 0)
                case = next(self.suites().iter("testcase"))
                shown = name.replace("\ufffe", "\\ufffe").replace("\uffff", "\\uffff")
                self.assertEqual(case.get("name"), f"{shown}: stream s latency at most 1ms")

    def test_equal_verdicts_are_equal_files(self):
        file = self.write("x", MET)
        for name in ("1.xml", "2.xml"):
            takt("run", file, "--junit", self.folder / name, "--quiet")
        self.assertEqual((self.folder / "1.xml").read_bytes(), (self.folder / "2.xml").read_bytes())


class Several(Folder):
    def test_one_suite_a_scenario_and_the_gravest_status(self):
        met, broken, undecided = self.write("met", MET), self.write("broken", BROKEN), self.write("open", OPEN)
        for command, files, status in (("run", [met, broken], 1), ("verify", [met, undecided], 4),
                                       ("verify", [undecided, broken, met], 1), ("run", [met], 0)):
            with self.subTest(command=command, files=files):
                got, out, _ = takt(command, *files, "--junit", self.folder / "v.xml", "--quiet")
                self.assertEqual((got, out.count("\n")), (status, len(files)))
                self.assertEqual([each.get("name") for each in self.suites()], [each.stem for each in files])
                self.assertEqual(self.suites().get("tests"), str(len(files)))

    def test_json_is_one_array_and_folders_have_the_names_of_the_files(self):
        files = [self.write("met", MET), self.write("broken", BROKEN)]
        for command, file in (("run", "result.json"), ("verify", "files.json")):
            status, out, _ = takt(command, *files, "--format", "json", "--out", self.folder / command)
            self.assertEqual(status, 1)
            self.assertEqual([each["scenario"] for each in json.loads(out)], ["met", "broken"])
            for each in files:
                self.assertTrue((self.folder / command / each.stem / file).is_file())

    def test_mistakes_of_all_are_reported_and_nothing_is_written(self):
        good = self.write("good", MET)
        bad = [self.write(name, {"stream": name, "latency": "1ms"}) for name in ("x", "y")]
        status, out, err = takt("run", good, *bad, "--out", self.folder / "out", "--junit", self.folder / "v.xml")
        self.assertEqual((status, out, err.count("unknown stream")), (2, "", 2))
        self.assertEqual(len(json.loads(takt("run", good, *bad, "--format", "json")[1])["diagnostics"]), 2)
        self.assertFalse((self.folder / "out").exists() or (self.folder / "v.xml").exists())

    def test_what_is_of_one_scenario_alone(self):
        a, b = self.write("a", MET), self.write("b", MET)
        (self.folder / "c").mkdir()
        twin = self.folder / "c" / "a.json"
        twin.write_bytes(a.read_bytes())
        for arguments, what in (([a, a], "a scenario twice"),
                                ([a, b, "--report", self.folder / "p.html"], "one page for several scenarios"),
                                ([a, twin, "--out", self.folder / "out"], "two scenarios with one folder"),
                                ([a, b, "--timeline", "--out", self.folder / "o"], "a recording of several scenarios")):
            with self.subTest(what):
                status, out, err = takt("run", *arguments)
                self.assertEqual((status, out), (2, ""))
                self.assertIn(what, err)
        self.assertFalse((self.folder / "out").exists())


class Defaults(unittest.TestCase):
    def test_the_help_says_them(self):
        for command, option, default in (("verify", "--seeds", "4"), ("verify", "--budget", "12"),
                                         ("run", "--threads", "1"), ("run", "--seed", "the scenario's"),
                                         ("run", "--format", "text"), ("compare", "--pairs", "10"),
                                         ("study", "--out", "study.sqlite"), ("bound", "--clock-error", "1us")):
            with self.subTest(command=command, option=option):
                page = " ".join(takt(command, "--help")[1].split())
                self.assertRegex(page, rf"{option} [^()]*(\([^()]*\)[^()]*)*\(default: {re.escape(default)}\)")

    def test_each_option_with_a_number_has_one(self):
        for command in json.loads(takt("--describe")[1])["commands"]:
            for option in command["options"]:
                is_question = option["name"] in ("--requirement", "--threads")
                if option["value"].split(":")[0] in ("N", "M", "D", "STATES", "FORMAT") and not is_question:
                    with self.subTest(command=command["name"], option=option["name"]):
                        self.assertNotEqual(option["default"], "")


if __name__ == "__main__":
    TAKT = str(pathlib.Path(sys.argv[1]).resolve())
    SOURCE = pathlib.Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
