#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Comments and documents name no source file and no test, and READMEs no function, that is not there.

usage: names_test.py SOURCE
"""
import pathlib
import re
import subprocess
import sys

NAME = re.compile(r"(?<![\w./*<-])((?:[\w-]+/)*[\w-]+\.(?:hpp|cpp|md))\b")
# A function as READMEs write it: `Class::function`, `function()`.
FUNCTION = re.compile(r"`(?:\w+::)*?(?:\w+::(\w+)|(\w+)\(\))`")
# A test as pages write it: `Suite.Case`.
CASE = re.compile(r"`([A-Z]\w*[a-z]\w*\.[A-Z]\w*[a-z]\w*)`")
TEST = re.compile(r"^TEST(?:_[FP])?\((\w+), *(\w+)", re.M)
CODE = (".cpp", ".hpp", ".inc", ".py", ".ts", ".mjs", ".cmake")
COMMENT = re.compile(r"//.*|#.*")
# Placeholders of instructions, by the file that has them.
EXAMPLES = {("cmake/takt.cmake", name) for name in ("a.cpp", "b.cpp", "a_test.cpp", "main.cpp", "command.cpp")} | {("src/frontends/cli/CMakeLists.txt", "command.cpp")}


def files(root):
    done = subprocess.run(["git", "-C", root, "ls-files", "-co", "--exclude-standard"], capture_output=True, text=True, check=False)
    if done.returncode == 0:
        return [name for name in done.stdout.split("\n") if name and (root / name).is_file()]
    return [p.relative_to(root).as_posix() for p in root.rglob("*") if p.is_file() and "build" not in p.relative_to(root).parts]


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    names = files(root)
    tails = {"/".join(name.split("/")[at:]) for name in names for at in range(name.count("/") + 1)}
    wrong = looked_at = functions = tests = 0
    words, cases = set(), set()
    for name in names:
        if name.endswith(CODE) or name.startswith("tools/"):
            content = (root / name).read_text(encoding="utf-8", errors="ignore")
            words |= set(re.findall(r"\w+", content))
            if name.endswith("_test.cpp"):
                cases |= {f"{suite}.{case}" for suite, case in TEST.findall(content)}
    for name in names:
        if not name.endswith((".cpp", ".hpp", ".py", ".cmake", "CMakeLists.txt", ".md")):
            continue
        for number, line in enumerate((root / name).read_text(encoding="utf-8").split("\n"), 1):
            text = line if name.endswith(".md") else (COMMENT.search(line) or [""])[0]
            if text.startswith("#include"):
                continue
            for member, function in FUNCTION.findall(line) if name.endswith(".md") and not name.startswith("docs/") else ():
                functions += 1
                if (member or function) not in words:
                    print(f"{name}:{number}: {member or function} is not there")
                    wrong += 1
            for case in CASE.findall(line) if name.endswith(".md") else ():
                tests += 1
                if case not in cases:
                    print(f"{name}:{number}: the test {case} is not there")
                    wrong += 1
            for found in NAME.findall(text):
                looked_at += 1
                if found not in tails and (name, found) not in EXAMPLES:
                    print(f"{name}:{number}: {found} is not there")
                    wrong += 1
    print(f"{looked_at} names of files, {functions} of functions, {tests} of tests; {wrong} of none")
    return 1 if wrong or looked_at < 100 or functions < 50 or tests < 3 else 0


if __name__ == "__main__":
    sys.exit(main())
