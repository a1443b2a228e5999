#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Breaks the sources in one place at a time and expects that a test, or a probe, notices.

usage: mutants.py --build FOLDER --table FILE.json [--below src/FOLDER] [--programs NAME...] [--sample N] [--only NAME] [--jobs N] [--print]

Each edit of a row of the table replaces a piece of text that occurs exactly once in its file, which is named from src/ (or from --below) on. Only the
changed file is compiled (of a header, all of its folder that include it), and the sources that the build compiles with it, as the build does but
with -O1; the object goes before the library that holds the right one. A row with a "program" is linked with that test and shown to the tests that "killed_by" names, as a
--gtest_filter: one of them must fail. All others are shown to --programs, one after the other, until one kills them: a probe prints
"killed NAME" as its last line, of a GoogleTest program it is the first test that fails; that must be "killed_by".

A mutant that survives shows a hole in the tests. Exit status 0: all were killed by what the table says. The build must be one of Ninja, and up to date.

A mutant that was killed as expected is remembered in the build folder (mutants_killed.json). It is not tried again while its row, the
changed text, the commands of the build and the programs that it is shown to are the same. --all forgets. With TAKT_TIER=night
--sample is ignored.
"""
import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SECONDS = 300   # for any one command


def run(command, folder):
    try:
        done = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True, timeout=SECONDS, check=False)
        return done.returncode, done.stdout, done.stderr
    except subprocess.TimeoutExpired as late:
        return None, late.stdout.decode() if isinstance(late.stdout, bytes) else late.stdout or "", ""


class Build:
    """How the build makes its objects and programs."""

    def __init__(self, folder, ninja):
        self.folder = folder.resolve()
        self.ninja = ninja
        self.objects = {}   # by source
        self.unities = {}   # the sources of each object that is made of several
        for target in self.asked("targets", "all").splitlines():
            output = target.split(":")[0]
            if "/CMakeFiles/" not in output or not output.startswith("src/"):
                continue
            if output.endswith(".cpp.o"):
                before, after = output.split("/CMakeFiles/")
                self.objects[f"{before}/{after.split('/', 1)[1][:-2]}"] = output
            elif output.endswith("_cxx.cxx.o"):
                text = (self.folder / output[:-2]).read_text(encoding="utf-8")
                self.unities[output] = [str(pathlib.Path(name).relative_to(ROOT)) for name in re.findall(r'#include "(/[^"]+)"', text)]
                self.objects.update(dict.fromkeys(self.unities[output], output))

    def asked(self, tool, *arguments):
        status, out, err = run([self.ninja, "-C", self.folder, "-t", tool, *arguments], self.folder)
        if status != 0:
            sys.exit(f"mutants: {err.strip() or out.strip()}")
        return "\n".join(line for line in out.splitlines() if not line.startswith("ninja: Entering"))

    def command(self, output):
        words = shlex.split(self.asked("commands", "-s", output).splitlines()[-1])
        words = [word for word in words if word not in (":", "&&")]
        names = [pathlib.Path(word).name for word in words]
        return words[names.index("ccache") + 1:] if "ccache" in names else words  # what is compiled once needs no cache

    def compiled(self, output, changed, folder, made):
        """`output`: the object as the build names it; made of the `changed` sources and headers below `folder` where there are such."""
        units = self.unities.get(output) or [unit for unit, each in self.objects.items() if each == output]
        sources = [folder / unit if unit in changed else ROOT / unit for unit in units]
        source = sources[0]
        if output in self.unities:
            source = made.with_suffix(".cpp")
            source.write_text("".join(f'#include "{each}"\n' for each in sources), encoding="utf-8")
        words = []
        given = iter(self.command(output))
        for word in given:
            if word in ("-o", "-c", "-MT", "-MF"):
                next(given)
            elif word != "-MD":
                words.append(word)
        wings = [option for wing in sorted((ROOT / "src").iterdir()) for option in ("-I", folder / "src" / wing.name)]
        status, _, err = run([words[0], *wings, *words[1:], "-O1", "-w", "-o", made, "-c", source], self.folder)
        return "" if status == 0 else err[:2000] or "no end"

    def linked(self, program, objects, made):
        words = self.command(program)
        at = words.index("-o")
        status, _, err = run([*words[:at], *objects, "-o", made, *words[at + 2:]], self.folder)
        return "" if status == 0 else err[:2000] or "no end"


class Memory:
    """Mutants that were killed as expected, by a key of everything that decides about it."""

    def __init__(self, build, options):
        self.build = build
        self.options = options
        self.path = build.folder / "mutants_killed.json"
        self.digests = {}   # of programs
        try:
            self.killed = {} if options.all else json.loads(self.path.read_text(encoding="utf-8"))
        except (OSError, ValueError):
            self.killed = {}

    def key(self, mutant):
        changed = mutated(self.options.below, mutant)
        programs = [mutant["program"]] if "program" in mutant else self.options.programs
        commands = [self.build.command(self.build.objects[name]) for name in sorted(changed) if name in self.build.objects]
        parts = [mutant, changed, commands, [(name, self.digest(name)) for name in programs]]
        return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()

    def digest(self, program):
        """Of the program as it is built: it holds the sources and the tests that a mutant meets."""
        if program not in self.digests:
            words = self.build.command(program)
            self.digests[program] = hashlib.sha256((self.build.folder / words[words.index("-o") + 1]).read_bytes()).hexdigest()
        return self.digests[program]

    def keep(self, key, killer, where):
        self.killed[key] = [killer, where]
        part = self.path.with_suffix(f".{os.getpid()}.part")
        part.write_text(json.dumps(self.killed, indent=0), encoding="utf-8")
        part.replace(self.path)


def fails_anyway(build, mutants):
    """Says which of the named tests fail, or are not there, without any mutant: they would kill all of them."""
    said = ""
    for program in sorted({each["program"] for each in mutants if "program" in each}):
        words = build.command(program)
        tests = sorted({each["killed_by"] for each in mutants if each.get("program") == program})
        status, out, _ = run([build.folder / words[words.index("-o") + 1], f"--gtest_filter={':'.join(tests)}"], build.folder)
        missing = [test for test in tests if f"[       OK ] {test}" not in out]
        if status != 0 or missing:
            said += f"{program} fails without any mutant, or has no such tests: {' '.join(missing)}\n"
    return said


def spaced(text):
    """The pattern of a piece of source, however it is spaced and wrapped."""
    tokens = re.findall(r"\w+|\s+|[^\w\s]", text)
    return re.compile(r"\s*".join(r"\s+" if token.isspace() else re.escape(token) for token in tokens))


def mutated(below, mutant):
    """The changed files, by name from the sources' root on."""
    texts = {}
    for edit in mutant["edits"]:
        name = f"{below}/{edit['file']}"
        text = texts.get(name) or (ROOT / name).read_text(encoding="utf-8")
        found = list(spaced(edit["from"]).finditer(text))
        if len(found) != 1:
            sys.exit(f"mutants: \"{mutant['name']}\": the text to replace occurs {len(found)} times in {name}: {edit['from']!r}")
        texts[name] = text[:found[0].start()] + edit["to"] + text[found[0].end():]
    return texts


def compiled(build, changed, folder):
    """The objects, and why there are none."""
    for name, text in changed.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    units = {name for name in changed if name.endswith(".cpp")}
    for name in changed:
        if name.endswith(".hpp"):
            path = pathlib.PurePath(name)
            include = f'"{path.relative_to(*path.parts[:2]) if path.parts[0] == "src" else path}"'
            units |= {str(each.relative_to(ROOT)) for each in (ROOT / name).parent.glob("*.cpp") if include in each.read_text(encoding="utf-8")}
    made = []
    for output in sorted({build.objects[unit] for unit in units}):
        made.append(folder / f"{len(made)}.o")
        mistake = build.compiled(output, changed, folder, made[-1])
        if mistake:
            return [], mistake
    return made, ""


def verdict_of(status, out, mutant):
    """What killed it, None if nothing did, and the question or the like, for people."""
    lines = out.splitlines() or [""]
    failed = [line.split("]")[1].split("(")[0].split(",")[0].strip() for line in lines if "  FAILED  ]" in line]
    if status is None:
        return "no end", lines[-1]
    if status != 0:
        return (failed[0] if failed else "CHECK"), lines[-1]
    if lines[-1].startswith("killed "):
        return lines[-1].split()[1] if mutant.get("chart", "") in out else "another chart", lines[-2]
    return None, "survived"


def killer_of(build, options, mutant, folder):
    objects, mistake = compiled(build, mutated(options.below, mutant), folder)
    if mistake:
        return "does not compile", mistake
    named = mutant.get("program")
    for program in [named] if named else options.programs:
        made = folder / program
        mistake = build.linked(program, objects, made)
        if mistake:
            return "does not link", mistake
        is_test = not program.endswith("_probe")
        arguments = ["--gtest_fail_fast", "--gtest_brief=1"] if is_test else []
        if named:
            arguments = ["--gtest_fail_fast", f"--gtest_filter={mutant['killed_by']}"]
        status, out, _ = run([made, *arguments], folder)
        killer, where = verdict_of(status, out, mutant)
        if killer:
            return killer, program if is_test else where
    return None, "survived"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--ninja", default="ninja")
    parser.add_argument("--table", type=pathlib.Path, required=True)
    parser.add_argument("--below", default="src", help="the folder from which files are named")
    parser.add_argument("--programs", nargs="*", default=[], help="what rows without a program are shown to")
    parser.add_argument("--sample", type=int, default=0, help="so many of the table, spread over it, the same each time")
    parser.add_argument("--only", help="those with this in their name, or killed by it")
    parser.add_argument("--jobs", type=int, default=min(4, os.cpu_count() or 1))
    parser.add_argument("--all", action="store_true", help="also those that are remembered as killed")
    parser.add_argument("--print", action="store_true", help="the table of who kills what, as Markdown")
    options = parser.parse_args()
    mutants = json.loads(options.table.read_text(encoding="utf-8"))
    for mutant in mutants:
        mutated(options.below, mutant)   # a table that does not fit the sources is told at once, also of a sample
    if options.only:
        mutants = [each for each in mutants if options.only in each["name"] or options.only == each["killed_by"]]
    if 0 < options.sample < len(mutants) and os.environ.get("TAKT_TIER") != "night":
        mutants = [mutants[i * len(mutants) // options.sample] for i in range(options.sample)]
    build = Build(options.build, options.ninja)
    memory = Memory(build, options)
    keys = {id(mutant): memory.key(mutant) for mutant in mutants}
    if said := fails_anyway(build, [mutant for mutant in mutants if keys[id(mutant)] not in memory.killed]):
        sys.exit(f"mutants: {said.strip()}")

    def judged(mutant):
        if found := memory.killed.get(keys[id(mutant)]):
            return mutant, *found
        with tempfile.TemporaryDirectory(prefix="takt-mutant-") as folder:
            return mutant, *killer_of(build, options, mutant, pathlib.Path(folder))

    wrong = remembered = 0
    with concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs) as pool:
        for mutant, killer, where in pool.map(judged, mutants):
            # A filter may name several tests, and a broken CHECK ends a program before it can say which one it was.
            as_said = killer not in (None, "does not compile", "does not link", "no end") if "program" in mutant else killer == mutant["killed_by"]
            wrong += not as_said
            if keys[id(mutant)] in memory.killed:
                remembered += 1
            elif as_said:
                memory.keep(keys[id(mutant)], killer, where)
            if options.print:
                print(f"| {mutant['name']} | {killer} | {where} |", flush=True)
            elif not as_said:
                print(f"\"{mutant['name']}\": expected to be killed by {mutant['killed_by']}, found {killer} ({where})", flush=True)
    print(f"{len(mutants)} mutants, {len(mutants) - wrong} killed as expected, {remembered} of them earlier")
    return 0 if wrong == 0 and mutants else 1


if __name__ == "__main__":
    sys.exit(main())
