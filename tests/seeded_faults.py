#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Puts one fault after the other into the sources, a changed sign or bound, and says which test finds it.

The faults are the rows of seeded_faults.txt: file, what stands there once, what takes its place, separated by tabs. For each
the sources are changed in a copy, what depends on the file is built, and tests run until one fails: those of `run-tests quick`,
then those of the file's room in other programs. A fault that nothing finds is a missing test.

Usage: seeded_faults.py [--work FOLDER] [--only REGEX]
  --work FOLDER   of the copy and its build, kept for the next time (default: build/faults)
  --only REGEX    faults of files that it matches
"""
import argparse
import collections
import pathlib
import re
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
FAULTS = ROOT / "tests/seeded_faults.txt"
QUICK = ["tests_geometry", "tests_core", "tests_check", "tests_io", "tests_exact"]
# Rooms whose tests are those of another one, and a program that takes hours.
TESTED_BY = {"build": "input", "join": "input", "quality": "output", "given": "check", "plans": "run", "visits": "run"}
LEFT_OUT = "tests_parallel_models"
SECONDS = 900  # of one program


def faults():
    for line in FAULTS.read_text().splitlines():
        if line and not line.startswith("#"):
            file, before, after = line.split("\t")
            yield file, before, after


def copy_tree(tree):
    listed = subprocess.check_output(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, text=True)
    for name in listed.split("\n"):
        source, copy = ROOT / name, tree / name
        if name and source.is_file() and not (copy.exists() and copy.read_bytes() == source.read_bytes()):
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(source.read_bytes())
            copy.chmod(source.stat().st_mode)


def build(folder, targets):
    done = subprocess.run(["ninja", "-j2", "-C", str(folder), *targets], capture_output=True, text=True)
    return "" if done.returncode == 0 else (re.findall(r"error: .*", done.stdout) or ["does not build"])[0]


def linked_at(folder, program):
    path = folder / "tests" / program
    return path.stat().st_mtime_ns if path.exists() else 0


def run_program(folder, program, only):
    """The first test that fails, or an empty string."""
    try:
        done = subprocess.run([folder / "tests" / program, "--gtest_brief=1", f"--gtest_filter={only}", "--gtest_fail_fast"],
                              capture_output=True, text=True, errors="replace", timeout=SECONDS)
    except subprocess.TimeoutExpired:
        return f"{program} does not end"
    failed = re.search(r"\[  FAILED  \] ([\w./]+)", done.stdout)
    if failed:
        return failed[1]
    return "" if done.returncode == 0 else f"{program} ends with {done.returncode}"


def tests_of_room(tree, room):
    """(program, filter) of the tests of a room that are in other programs than the quick ones."""
    room = TESTED_BY.get(room, room)
    listed = re.sub(r"#.*", "", (tree / "tests/CMakeLists.txt").read_text())
    programs = {p: name for name, p in re.findall(r"pgdr_test\((\w+) PROGRAM (\w+)", listed)}
    files = collections.defaultdict(list)
    for words in re.findall(rf"pgdr_room_tests\({room}\s([^)]*)\)", listed):
        for word in words.split():
            if word in programs:
                program = programs[word]
            else:
                files[program].append(tree / f"tests/test_{room}_{word}.cpp")
    for program, sources in files.items():
        suites = {s for source in sources for s in re.findall(r"^(?:TYPED_)?TEST(?:_[FP])?\((\w+)", source.read_text(), re.M)}
        if program not in [*QUICK, LEFT_OUT]:
            yield program, ":".join(f"{s}.*:*/{s}.*:{s}/*" for s in sorted(suites))


def find(tree, folder, file):
    """Which test finds the fault, and in which part."""
    parts = [(program, "*", "quick") for program in QUICK]
    parts += [(program, only, "room") for program, only in tests_of_room(tree, file.split("/")[1])]
    for program, only, part in parts:
        before = linked_at(folder, program)
        if said := build(folder, [program]):
            return said, "build"
        if linked_at(folder, program) == before:
            continue  # it has nothing of the file
        if said := run_program(folder, program, only):
            return said, part
    return "", ""


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "build/faults")
    parser.add_argument("--only", default="")
    given = parser.parse_args()
    tree, folder = given.work.resolve() / "tree", given.work.resolve() / "build"
    chosen = [f for f in faults() if re.search(given.only, f[0])]
    for file, before, after in chosen:
        if (ROOT / file).read_text().count(before) != 1 or before == after:
            sys.exit(f"{file}: this does not stand there once: {before}")
    copy_tree(tree)
    if not (folder / "build.ninja").exists():
        subprocess.run(["cmake", "--preset", "release", "-B", str(folder), "-DCMAKE_UNITY_BUILD=OFF"], cwd=tree, check=True,
                       stdout=subprocess.DEVNULL)
    if said := build(folder, QUICK):
        sys.exit(f"without a fault: {said}")
    print("| file | stands there | fault | found by | in |\n| --- | --- | --- | --- | --- |", flush=True)
    missed = 0
    for file, before, after in chosen:
        path = tree / file
        sound = path.read_text()
        path.write_text(sound.replace(before, after))
        try:
            start = time.monotonic()
            test, part = find(tree, folder, file)
        finally:
            path.write_text(sound)
        missed += not test
        code = [f"`{text.replace('|', chr(92) + '|')}`" for text in (before, after)]
        print(f"| `{file}` | {code[0]} | {code[1]} | {test or 'nothing'} | {part} |", flush=True)
        print(f"{time.monotonic() - start:.0f} seconds", file=sys.stderr, flush=True)
    sys.exit(1 if missed else 0)


if __name__ == "__main__":
    main()
