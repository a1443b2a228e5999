#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What takt export writes as YANG is valid: asked is yanglint with the modules of IEEE, which are not part of the repository.

usage: yang_valid_test.py TAKT SOURCE_DIR       TAKT_YANG_MODULES is a folder with published/, fixes/, 2018/ and ietf/ (docs/interchange.md); without it the test is skipped
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

TAKT, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
MODULES = pathlib.Path(os.environ.get("TAKT_YANG_MODULES", ""))
SKIPPED = 77

PUBLISHED = ("types bridge preemption-bridge sched-bridge psfp-bridge ats-bridge cbsa-bridge").split()


def newest(folder, name):
    return str(sorted((MODULES / folder).glob(f"{name}@*.yang"))[-1])


def yanglint(dialect, corrected):
    common = [newest("ietf", "iana-if-type")]
    if dialect == "2018":
        paths = ["2018", "ietf"]
        files = [newest("2018", f"ieee802-dot1q-{name}") for name in ("types", "bridge", "preemption", "sched")]
    else:
        paths = (["fixes"] if corrected else []) + ["published", "ietf"]
        first = "fixes" if corrected else "published"
        files = [newest(first, "ieee802-dot1q-sched"), newest(first, "ieee802-dot1q-psfp")]
        files += [newest("published", f"ieee802-dot1q-{name}") for name in PUBLISHED]
        files += [newest("published", name) for name in ("ieee802-dot1cb-stream-identification", "ieee802-dot1cb-frer", "ieee802-ethernet-mac-merge", "ieee802-dot1as-gptp", "ieee802-dot1as-hs")]
    command = ["yanglint", "-D"]
    for path in paths:
        command += ["-p", str(MODULES / path)]
    return command + ["-t", "config", "-e", *common, *files]


def main():
    if not (MODULES / "published").is_dir() or shutil.which("yanglint") is None:
        print("skipped: no modules (TAKT_YANG_MODULES) or no yanglint (Debian: libyang2-tools)")
        return SKIPPED
    bad = checked = 0
    names = [f"{folder}{name}" for folder, name in (("tsn/", "preemption-on-a-line"), ("tsn/", "policing"), ("tsn/", "automatic-gates"), ("tsn/", "ats"), ("tsn/", "cqf"), ("tsn/", "gates-on-a-line"),
                                                    ("tsn/", "frer-ring"), ("tsn/", "frer-hosts"), ("", "redundant-ring"), ("clocks/", "gates-with-gptp"), ("clocks/", "hot-standby"), ("clocks/", "grandmaster-fail-over"),
                                                    ("validation/", "credit-and-gates"), ("validation/", "gates-behind-stream-gates"), ("", "robot-arm"))]
    for name in names:
        for dialect in ("published", "2018"):
            for encoding in ("json", "xml"):
                with tempfile.TemporaryDirectory() as folder:
                    subprocess.run([TAKT, "export", "yang", SOURCE / "scenarios" / f"{name}.json", "-o", f"dialect={dialect}", "-o", f"encoding={encoding}", "--lossy", "--out", folder], check=True, capture_output=True)
                    files = [path for path in pathlib.Path(folder).iterdir() if not path.name.endswith(".names.json")]
                    for corrected in (True, False) if dialect == "published" else (False,):
                        for path in sorted(files)[:6]:
                            done = subprocess.run([*yanglint(dialect, corrected), str(path)], capture_output=True, text=True)
                            checked += 1
                            if done.returncode != 0:
                                bad += 1
                                errors = [line for line in (done.stdout + done.stderr).splitlines() if "err" in line]
                                print(f"{name} {dialect} {encoding} {'corrected' if corrected else ''} {path.name}: {errors[:2]}")
    print(f"{checked} checked, {bad} invalid")
    wrong = validates_itself()
    for each in wrong:
        print(each)
    return 1 if bad or wrong or not checked else 0


def validates_itself():
    """takt export yang --validate says the same, and by modules that ask for less is not content. What is wrong, as texts."""
    if "with libyang" not in subprocess.run([TAKT, "--version"], check=True, capture_output=True, text=True).stdout:
        return []
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        stricter, out = pathlib.Path(folder) / "modules", pathlib.Path(folder) / "out"
        for part in ("published", "2018", "ietf"):
            shutil.copytree(MODULES / part, stricter / part)
        interfaces = next((stricter / "ietf").glob("ietf-interfaces@*.yang"))
        text = interfaces.read_text()
        changed = text.replace("leaf name {\n        type string;", 'leaf name {\n        type string { length "1..2"; }')
        interfaces.chmod(0o644)
        interfaces.write_text(changed)
        if changed == text:
            wrong.append("the module of interfaces is not as this test knows it")
        for dialect in ("published", "2018"):
            command = [TAKT, "export", "yang", SOURCE / "scenarios/tsn/gates-on-a-line.json", "-o", f"dialect={dialect}", "--lossy", "--out", out]
            done = subprocess.run([*command, "--validate", stricter], capture_output=True, text=True)
            if done.returncode != 1 or "length" not in done.stderr or out.exists():
                wrong.append(f"{dialect}: names of at most two letters: status {done.returncode}: {done.stderr}")
        for name in ("tsn/preemption-on-a-line", "tsn/frer-ring", "clocks/gates-with-gptp"):
            for encoding in ("json", "xml"):
                done = subprocess.run([TAKT, "export", "yang", SOURCE / f"scenarios/{name}.json", "-o", f"encoding={encoding}", "--validate", MODULES, "--out", out], capture_output=True, text=True)
                if done.returncode != 0:
                    wrong.append(f"{name} {encoding}: status {done.returncode}: {done.stderr}")
    return wrong


if __name__ == "__main__":
    sys.exit(main())
