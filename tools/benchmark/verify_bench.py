# SPDX-License-Identifier: Apache-2.0
"""CPU time of takt verify over all shipped scenarios, each with its defaults."""
import os
import subprocess


def shipped(root):
    """The scenarios, without schemas and studies."""
    return sorted(file for file in (root / "scenarios").rglob("*.json") if not file.name.endswith(".schema.json") and "studies" not in file.parts)


def cpu_seconds(command):
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return used.ru_utime + used.ru_stime


def verify_all(takt, root):
    """By scenario, the dearest first."""
    times = {str(file.relative_to(root)): cpu_seconds([takt, "verify", file, "--quiet"]) for file in shipped(root)}
    return dict(sorted(times.items(), key=lambda each: -each[1]))
