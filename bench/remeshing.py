#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What remeshing costs beside meshing the same surface from a file, and what carrying fields over costs beside remeshing.

    PYTHONPATH=build/release/python bench/remeshing.py build/release/pgdr [--rounds 5] [--models NAME,...] [--most 1.3]

Each model is meshed with one edge length, to a .msh, and that is meshed anew with another: by `pgdr remesh`, and by `pgdr mesh`, which takes
the surface of that file with its markers, and seeds of its labels and voids, as it takes any input. Both use one thread, write the same format,
and take turns; processor seconds are those of the processes, a cell that they make. Of the rounds the median of the ratios counts. Then, in one
process: `pgdr.remesh`, `Transfer` with one field of cells, and with one of points, in microseconds of the processor a new cell.
A table; exit code 1 if a median is above --most.
"""
import argparse
import json
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile

import made_inputs

TRANSFER = """
import json, resource, sys
import numpy as np
import pgdr
old, size, rounds = pgdr.Mesh.read(sys.argv[1]), float(sys.argv[2]), int(sys.argv[3])

def taken(work):
    before = resource.getrusage(resource.RUSAGE_SELF)
    made = work()
    after = resource.getrusage(resource.RUSAGE_SELF)
    return made, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

rows = []
for _ in range(rounds):
    new, remesh = taken(lambda: pgdr.remesh(old, edge_length=size, threads=1))
    values = np.linspace(1, 2, len(old.cells))
    made, cells = taken(lambda: pgdr.Transfer(old, new).cells(values))
    _, points = taken(lambda: pgdr.Transfer(old, new).points(np.linspace(1, 2, len(old.points))))
    rows.append([1e6 * x / len(new.cells) for x in (remesh, cells, points)])
print(json.dumps(rows))
"""


def run(command):
    """Processor seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(list(map(str, command)), check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def measured(args, model, lengths, folder):
    old, made = folder / "old.msh", folder / "made.vtu"
    common = ["--threads", 1, "--quiet"]
    run([args.pgdr, "mesh", model, "-o", old, "--size", lengths[0], "--size-unit", "edge", *common])
    flags = ["-o", made, "--size", lengths[1], "--size-unit", "edge", *common]
    report = folder / "report.json"
    ratios, cells = [], []
    for _ in range(args.rounds):
        pair = []
        for command in (["remesh", old], ["mesh", old]):
            pair.append(run([args.pgdr, *command, *flags, "--report", report]))
            cells.append(json.loads(report.read_text(encoding="utf-8"))["cells"])
        ratios.append(pair[0] / cells[-2] / (pair[1] / cells[-1]))
    inside = json.loads(subprocess.run([sys.executable, "-c", TRANSFER, str(old), str(lengths[1]), str(args.rounds)], check=True,
                                       stdout=subprocess.PIPE).stdout)
    return cells[0], cells[1], statistics.median(ratios), [statistics.median(column) for column in zip(*inside)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pgdr", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--models", default="")
    parser.add_argument("--most", type=float, default=1.3)
    args = parser.parse_args()
    root = pathlib.Path(__file__).resolve().parent.parent / "tests" / "models"
    models = {"cube": (None, 0.06, 0.045), "bracket": (root / "bracket.poly", 0.12, 0.09), "rocket": (root / "rocket.poly", 0.3, 0.2),
              "plate": (root / "plate.poly", 0.02, 0.013), "river": (root / "river.poly", 3, 2)}
    print("| model | cells by remesh | by mesh | remesh / mesh | remesh, us a cell | cells carried over | points carried over |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    over = False
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for label, (model, *lengths) in models.items():
            if args.models and label not in args.models.split(","):
                continue
            if model is None:
                model = folder / "cube.poly"
                made_inputs.write_cube(model)
            cells, others, ratio, (remesh, of_cells, of_points) = measured(args, model, lengths, folder)
            over = over or ratio > args.most
            print(f"| {label} | {cells:,} | {others:,} | {ratio:.2f} | {remesh:.2f} | {of_cells:.2f} | {of_points:.2f} |", flush=True)
    return 1 if over else 0


if __name__ == "__main__":
    sys.exit(main())
