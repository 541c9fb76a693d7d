#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What a size function of Python costs: the unit cube with the size S + S x as a function of numpy, over the same run with the same
expression in C++ (`pgdr mesh --size`).

    PYTHONPATH=build/release/python bench/python_sizes.py build/release/pgdr [--size 0.0121] [--threads 1,2] [--rounds 3] [--no-optimize]

Both read the same input and must make a mesh of as many cells. Seconds are those of the whole call of mesh(), the least of the rounds, which
take turns; processor seconds are those of the processes, that is, with what it takes to begin, to read and to write. A table, with the calls
of the function and its points. Exit code 1 if the meshes differ.
"""
import argparse
import json
import pathlib
import resource
import subprocess
import sys
import tempfile

import made_inputs

MESH = """
import json, sys, pgdr
size, threads, optimize, cube, mesh = json.loads(sys.argv[1])
asked = [0, 0]

def function(at):
    asked[0] += 1
    asked[1] += len(at)
    return size + size * at[:, 0]

made = pgdr.mesh(pgdr.Plc.read(cube), size=function, threads=threads, optimize=optimize)
made.write(mesh)
print(json.dumps({"cells": len(made.cells), "mesh": made.statistics["seconds"]["mesh"], "calls": asked[0], "points": asked[1]}))
"""


def run(command):
    """(what it printed, processor seconds)"""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    printed = subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return printed, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def by_python(args, threads, folder):
    given = [args.size, threads, not args.no_optimize, str(folder / "cube.poly"), str(folder / "m.vtu")]
    printed, processor = run([sys.executable, "-c", MESH, json.dumps(given)])
    return {**json.loads(printed), "processor": processor}


def by_command(args, threads, folder):
    command = [args.pgdr, "mesh", folder / "cube.poly", "-o", folder / "m.vtu", "--report", folder / "m.json", "--quiet", "--threads", threads,
               "--size", f"{args.size!r} + {args.size!r} * x", *["--no-optimize"] * args.no_optimize]
    _, processor = run(list(map(str, command)))
    report = json.loads((folder / "m.json").read_text(encoding="utf-8"))
    return {"cells": report["cells"], "mesh": report["seconds"]["mesh"], "processor": processor}


def least(rounds, key):
    return min(r[key] for r in rounds)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("pgdr", type=pathlib.Path)
    parser.add_argument("--size", type=float, default=0.0121)
    parser.add_argument("--threads", default="1,2")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--no-optimize", action="store_true")
    args = parser.parse_args()
    print("| threads | cells | calls | points a call | seconds | in C++ | ratio | processor seconds | in C++ | ratio |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    same = True
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        made_inputs.write_cube(folder / "cube.poly")
        for threads in map(int, args.threads.split(",")):
            python, command = [], []
            for _ in range(args.rounds):
                command.append(by_command(args, threads, folder))
                python.append(by_python(args, threads, folder))
            one = python[0]
            same = same and {r["cells"] for r in python + command} == {one["cells"]}
            row = [str(threads), f"{one['cells']:,}", f"{one['calls']:,}", f"{one['points'] / one['calls']:.0f}"]
            for key in ("mesh", "processor"):
                of_python, of_command = least(python, key), least(command, key)
                row += [f"{of_python:.2f}", f"{of_command:.2f}", f"{of_python / of_command:.2f}"]
            print("| " + " | ".join(row) + " |", flush=True)
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
