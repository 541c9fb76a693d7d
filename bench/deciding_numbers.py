#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What each of the numbers decides that stand in the headers numbers.hpp of the rooms: meshes with half and with twice of it.

It copies the sources, makes the numbers variables that the environment may set (in the copy alone), builds the command there,
once, and meshes the files with each number as it is, halved and doubled, on one thread. A row of the table has the ratios, over
all files together, of cells, poor cells, faces not locally Delaunay and the processor's seconds, the files that made the same
mesh to the last byte, and those that ended otherwise (exit code). What ends later than --seconds counts as that.

Usage: deciding_numbers.py --list                              the numbers, with their rooms and values
       deciding_numbers.py [options] FILE...                   the table, as Markdown
  --only REGEX        only numbers whose room/name it matches
  --no-optimize       without the optimiser, for the numbers that come before it
  --work FOLDER       of the copy and its build, kept for the next time (default: build/numbers)
  --seconds N         the longest that a file may take (default 60)
"""
import argparse
import hashlib
import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
LAYERS = ("geometry", "core", "scheduler", "mpi")
DECLARED = re.compile(r"^inline constexpr ([\w:]+) (.*);")
READ = """#pragma once
#include <cstdlib>
#include <string>
namespace pgdr::numbers {
template <class T>
T from_environment(const char* name, T value) {
  const char* text = std::getenv(("PGDR_NUMBER_" + std::string(name)).c_str());
  return text ? static_cast<T>(std::atof(text)) : value;
}
}  // namespace pgdr::numbers
"""


def numbers():
    """(room, type, name, text of the value) of each."""
    found = []
    for header in sorted(ROOT.glob("*/*/numbers.hpp")):
        room = str(header.parent.relative_to(ROOT))
        for line in header.read_text().splitlines():
            if declared := DECLARED.match(line):
                for part in declared[2].split(", "):
                    name, value = part.split(" = ")
                    found.append((room, declared[1], name, value))
    return found


def value_of(text):
    return float.fromhex(text) if "0x" in text else float(text.replace("'", ""))


def prepare(work):
    """The command that reads the numbers from the environment."""
    tree = work / "tree"
    for name in subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, capture_output=True, text=True,
                               check=True).stdout.split():
        source, copy = ROOT / name, tree / name
        if not source.is_file():
            continue
        data = source.read_bytes()
        if name.endswith((".hpp", ".cpp")) and name.startswith(LAYERS):
            data = with_variables(name, data.decode()).encode()
        if not copy.exists() or copy.read_bytes() != data:
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(data)
            shutil.copymode(source, copy)
    (tree / "geometry/from_environment.hpp").write_text(READ)
    build = work / "build"
    if not (build / "build.ninja").exists():
        subprocess.run(["cmake", "--preset", "release", "-B", str(build), "-DCMAKE_UNITY_BUILD=OFF"], cwd=tree, check=True,
                       stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", str(build), "--target", "pgdr_command"], check=True, stdout=sys.stderr)
    return build / "pgdr"


def with_variables(name, text):
    lines = []
    for line in text.splitlines():
        declared = DECLARED.match(line)
        if name.endswith("/numbers.hpp") and declared:
            for part in declared[2].split(", "):
                number, value = part.split(" = ")
                lines.append(f'inline const {declared[1]} {number} = from_environment<{declared[1]}>("{number}", {value});')
            continue
        if re.search(r"(?<!std::)numbers::", line):
            line = re.sub(r"(?<!if )constexpr", "const", line).replace("static const ", "static inline const ")
        lines.append(line)
    text = "\n".join(lines) + "\n"
    if not name.endswith("/numbers.hpp"):
        return text
    return text.replace("#pragma once\n", '#pragma once\n#include "from_environment.hpp"\n', 1)


def mesh(command, file, flags, seconds, setting):
    """Exit code, the report's figures, a hash of the mesh."""
    with tempfile.TemporaryDirectory() as folder:
        out, report = pathlib.Path(folder, "m.vtu"), pathlib.Path(folder, "r.json")

        def limit():
            resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))

        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        done = subprocess.run([command, "mesh", file, "-o", out, "--report", report, "--threads", "1", "--quiet", *flags],
                              env=os.environ | setting, preexec_fn=limit, capture_output=True)
        took = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        result = {"exit": done.returncode, "seconds": took, "cells": 0, "poor": 0, "not Delaunay": 0, "hash": ""}
        if out.exists() and report.exists():
            said = json.loads(report.read_text())
            faces = said["quality"]["not_delaunay"] or {}
            result |= {"cells": said["cells"], "poor": said["bounds"]["poor_left"],
                       "not Delaunay": sum(faces.values()),
                       "hash": hashlib.sha256(out.read_bytes()).hexdigest()}
        return result


def row(room, name, text, factor, before, after):
    both = [f for f in before if before[f]["hash"] and after[f]["hash"]]

    def ratio(key):
        old, new = (sum(runs[f][key] for f in both) for runs in (before, after))
        return f"{new / old:.3f}" if old else f"{new - old:+g}"

    same = sum(before[f]["hash"] == after[f]["hash"] for f in before)
    ended = [f"{pathlib.Path(f).name} {after[f]['exit']} ({before[f]['exit']})" for f in before
             if before[f]["exit"] != after[f]["exit"]]
    figures = " | ".join(ratio(key) for key in ("cells", "poor", "not Delaunay", "seconds"))
    print(f"| `{room}` {name} | {text} | {factor} | {figures} | {same} of {len(before)} | {', '.join(ended)} |", flush=True)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("files", nargs="*")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--only", default="")
    parser.add_argument("--no-optimize", action="store_true")
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "build/numbers")
    parser.add_argument("--seconds", type=int, default=60)
    given = parser.parse_args()
    if given.list:
        for room, _, name, text in numbers():
            print(f"{room}\t{name}\t{text}")
        return
    command = prepare(given.work.resolve())
    flags = ["--no-optimize"] if given.no_optimize else []
    before = {f: mesh(command, f, flags, given.seconds, {}) for f in given.files}
    print("| number | value | times | cells | poor | not Delaunay | seconds | same mesh | ends otherwise |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |", flush=True)
    for room, _, name, text in numbers():
        if not re.search(given.only, f"{room}/{name}"):
            continue
        for factor in (0.5, 2):
            setting = {f"PGDR_NUMBER_{name}": repr(value_of(text) * factor)}
            row(room, name, text, factor, before, {f: mesh(command, f, flags, given.seconds, setting) for f in given.files})


if __name__ == "__main__":
    main()
