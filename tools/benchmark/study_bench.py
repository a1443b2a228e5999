# SPDX-License-Identifier: Apache-2.0
"""What the machinery of studies costs: used by tools/bench. CPU time of takt and of its workers, which the kernel adds up."""
import pathlib
import re
import resource
import sqlite3
import subprocess
import tempfile
import time

STUDY = """{"name": "bench", "base": "%(base)s",
 "factors": [{"name": "payload", "set": ["/streams/0/payload"], "values": ["600B", "800B", "1000B", "1200B"]},
             {"name": "duration", "set": ["/duration"], "values": ["20s"]}],
 "replications": %(replications)d, "measures": [{"name": "start", "of": "reaction.start.max", "unit": "ms"}]}"""

MANY = """{"name": "many", "base": "%(base)s",
 "factors": [{"name": "payload", "set": ["/streams/0/payload"], "range": {"from": "100B", "to": "1090B", "step": "10B"}},
             {"name": "length", "set": ["/network/links/0/length"], "range": {"from": "1m", "to": "100m", "step": "1m"}}],
 "replications": 100, "impossible": "recorded",
 "measures": [{"name": "start", "of": "reaction.start.max", "unit": "ms"}, {"name": "camera", "of": "latency.camera.max", "unit": "us"}],
 "limits": [{"measure": "camera", "at_most": "100us"}]}"""


def cpu_of(*command):
    """CPU seconds of a command and of all processes that it waited for."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([str(part) for part in command], check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def run_points(takt, root, replications):
    """CPU and wall-clock seconds with one job and with two, and what the points themselves took in the first."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        study = folder / "study.json"
        study.write_text(STUDY % {"base": root / "scenarios" / "robot-arm.json", "replications": replications})
        began = time.monotonic()
        one = cpu_of(takt, "study", study, "--jobs", 1, "--out", folder / "1.sqlite")
        between = time.monotonic()
        two = cpu_of(takt, "study", study, "--jobs", 2, "--out", folder / "2.sqlite")
        ended = time.monotonic()
        with sqlite3.connect(folder / "1.sqlite") as database:
            points, inside = database.execute("SELECT count(*), sum(cpu_us) * 1e-6 FROM point").fetchone()
        database.close()
        return {"points": points, "one_s": one, "two_s": two, "inside_s": inside, "one_wall_s": between - began, "two_wall_s": ended - between}


def report_of_a_million(takt, root):
    """CPU seconds of takt study report for a store of a million rows."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        study, store = folder / "study.json", folder / "s.sqlite"
        study.write_text(MANY % {"base": root / "scenarios" / "robot-arm.json"})
        subprocess.run([str(takt), "study", study, "--shard", "1/1000000", "--out", store], check=True, capture_output=True)
        with sqlite3.connect(store) as database:
            # What a run would have brought does not matter here; figures that vary do.
            database.execute("""INSERT OR IGNORE INTO point WITH RECURSIVE n(i) AS (SELECT 0 UNION ALL SELECT i + 1 FROM n WHERE i < 999999)
              SELECT i, i / 100, i % 100, i % 100 + 1, 'done', (i / 100) % 100 < 80, 'pass', printf('%016x', i * 7919), 1000, 5000, '',
                     5 + (i * 7919 % 1000) / 1000.0, 30 + (i / 100) % 100 + (i * 104729 % 1000) / 100.0 FROM n""")
        database.close()
        rows = subprocess.run([str(takt), "study", "report", store, "--out", folder / "r.html"], check=True, capture_output=True, text=True).stdout
        assert re.search(r"1000000 of 1000000 points", rows), rows
        return cpu_of(takt, "study", "report", store, "--out", folder / "r.html")
