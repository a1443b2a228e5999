# SPDX-License-Identifier: Apache-2.0
"""What it costs to build takt from nothing and after an edit, as a ratio to one fixed file compiled in the same run.

Processors and compilers differ by machine (the same tree took 5 and 16 CPU minutes on two of them), the ratio does not.
"""
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

REFERENCE = pathlib.Path(__file__).resolve().parent / "reference.cpp"
# A build without a compiler cache, whatever the machine has.
ENVIRONMENT = {**os.environ, "CCACHE_DISABLE": "1"}
# After an edit of one of these: takt again.
EDITS = ["src/questions/analysis/bounds.cpp", "models/egress/egress_port.cpp", "src/frontends/cli/run_command.cpp",
         "src/simulation/scenario/description/description.hpp"]


def timed(command, folder):
    """CPU and wall seconds of a command and all that it starts; output goes to the error if it fails."""
    began = time.monotonic()
    with tempfile.TemporaryFile("w+") as output:
        process = subprocess.Popen(list(map(str, command)), cwd=folder, env=ENVIRONMENT, stdout=output, stderr=output)
        _, status, used = os.wait4(process.pid, 0)
        if os.waitstatus_to_exitcode(status) != 0:
            output.seek(0)
            sys.exit(f"tools/bench: {' '.join(map(str, command))} failed\n{output.read()[-4000:]}")
    return used.ru_utime + used.ru_stime, time.monotonic() - began


def run(root, committed, short):
    with tempfile.TemporaryDirectory(prefix="takt-build-") as name:
        folder = pathlib.Path(name)
        references = []

        def reference():
            compile_reference = ["c++", "-std=c++20", "-O2", "-c", REFERENCE, "-o", folder / "reference.o"]
            references.append(timed(compile_reference, folder)[0])

        def built(target):
            reference()
            cpu, wall = timed(["cmake", "--build", folder / "build", "--target", target], folder)
            reference()
            return cpu, wall

        # The sources are copied, so that edits touch no file of the user.
        subprocess.run(f"git -C '{root}' ls-files -z -co --exclude-standard"
                       f" | tar -C '{root}' --null -T - --ignore-failed-read -cf -"
                       f" | tar -C '{folder}' --one-top-level=takt -xf -", shell=True, check=True)
        timed(["cmake", "-S", folder / "takt", "-B", folder / "build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
               "-DTAKT_TESTS=OFF"], folder)
        figures = {"core": built("takt")}
        if not short:
            figures["everything"] = tuple(a + b for a, b in zip(figures["core"], built("all")))
            for edited in EDITS:
                (folder / "takt" / edited).open("a").write("\n// an edit\n")
                figures[f"edit {edited}"] = built("takt")
            timed(["cmake", folder / "build", "-DTAKT_TESTS=ON"], folder)
            figures["with tests"] = tuple(a + b for a, b in zip(figures["everything"], built("all")))
        unit = statistics.median(references)
        print(f"reference: {unit:.2f} CPU s in the median of {len(references)}"
              f" ({min(references):.2f} to {max(references):.2f})\n")
        print(f"{'built':<52} {'CPU s':>7} {'wall s':>7} {'ratio':>7} {'committed':>10}")
        for name, (cpu, wall) in figures.items():
            known = committed.get(name.replace(" ", "_"))
            beside = f"{known:>10.1f}  {100 * (cpu / unit / known - 1):+.1f} %" if known else f"{'-':>10}"
            print(f"{name:<52} {cpu:>7.1f} {wall:>7.1f} {cpu / unit:>7.1f} {beside}")
    return 0
