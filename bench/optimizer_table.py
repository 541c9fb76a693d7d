#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What the optimiser reaches at each bound on dihedral angles, and what that costs: the last tables of docs/quality.md.

    bench/optimizer_table.py build/release/pgdr [MODEL...] [--angles 15,20,25,30] [--cubes 0.04,0.0155] [--table docs/quality.md --name NAME]

The unit cube with bounds of size, and every MODEL without one, each with the tolerance that `pgdr info` proposes for it, if any, once with
`--no-optimize` and once with each bound, on one thread. `pgdr check` verifies each mesh with all its bounds, and the reasons. Vertices are
compared with those of `--no-optimize`; "before" are the cells over the radius-edge bound and the largest ratio there. Evaluations are those of
a cell's quality, the unit of the optimiser's work, over the cells of the mesh; they do not depend on the machine, as "time", the optimiser's
seconds over the refinement's, does. Exit code 1 if a mesh fails its check.
"""
import argparse
import json
import pathlib
import sys
import tempfile

import models
import quality_table
import suite_models
import tables

BOUND = 2
HEAD = ["model", "bound", "cells", "vertices", "left", "unexplained", "least", "largest", "ratio", "before: over", "before: ratio", "evaluations",
        "time", "check"]


class Runs:
    def __init__(self, args, given, folder):
        self.args, self.given, self.folder = args, given, folder
        self.before = self.mesh(["--no-optimize"])

    def mesh(self, flags):
        """Report of `pgdr mesh`, "exit" as well. @raises Failure if there is none"""
        mesh, report = self.folder / "m.vtu", self.folder / "m.json"
        report.unlink(missing_ok=True)
        command = [self.args.pgdr, "mesh", self.given.path, "-o", mesh, "--report", report, "--radius-edge", BOUND, "--threads", 1,
                   "--quiet", *self.given.pgdr_flags, *flags]
        code, _, words = models.run(list(map(str, command)), self.args.limit)
        if code not in (0, 1):
            raise quality_table.Failure(f"over {self.args.limit:g} s" if code is None else f"exit {code}: " + words.strip()[:80])
        return {**json.loads(report.read_text()), "exit": code}

    def check(self, angle):
        size = ["--size", str(self.given.size)] if self.given.size else []
        return models.checked(self.args.pgdr, self.folder / "m.vtu", self.folder / "c.json", BOUND, 10 * self.args.limit, *size, "--min-dihedral",
                              str(angle), "--input", self.given.path, "--reasons", self.folder / "m.json")

    def line(self, angle):
        """(a line of the table, whether the check went well)"""
        found = self.mesh(["--min-dihedral", str(angle)])
        code, _ = self.check(angle)
        before, quality, work, seconds = self.before, found["quality"], found["optimization"], found["seconds"]
        good = code == found["exit"]
        values = [self.given.name, f"{angle:g}", f"{found['cells']:,}", f"{100 * (found['vertices'] / before['vertices'] - 1):+.1f} %",
                  f"{work['left']:,}", f"{work['unexplained']:,}", f"{quality['min_angle_deg']:.2f}", f"{quality['max_angle_deg']:.1f}",
                  f"{quality['max_radius_edge']:.3g}", f"{before['bounds']['poor_left']:,}", f"{before['quality']['max_radius_edge']:.3g}",
                  f"{work['evaluated'] / found['cells']:.1f}", f"{100 * seconds['optimize'] / seconds['refine']:.0f} %",
                  f"{code}" if good else f"{code}, mesh {found['exit']}"]
        return "| " + " | ".join(values) + " |", good


def main():
    numbers = lambda text: [float(word) for word in text.split(",") if word]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pgdr", type=pathlib.Path)
    parser.add_argument("models", nargs="*", type=pathlib.Path)
    parser.add_argument("--angles", type=numbers, default=[15, 20, 25, 30], help="default: 15,20,25,30")
    parser.add_argument("--cubes", type=numbers, default=[0.04, 0.0155], help="the cube's bounds of size; default: 0.04,0.0155")
    parser.add_argument("--limit", type=float, default=300, help="seconds for one mesh; default: %(default)s")
    tables.add_flags(parser)
    parser.add_argument("--name", default="optimizer's table", help="what the marks of that table call it; default: %(default)s")
    args = parser.parse_intermixed_args()
    args.pgdr = args.pgdr.resolve()
    lines, wrong = ["| " + " | ".join(HEAD) + " |", "|" + " --- |" * len(HEAD)], 0
    print("\n".join(lines), flush=True)
    with tempfile.TemporaryDirectory(prefix="pgdr_optimizer_") as folder:
        folder = pathlib.Path(folder)
        cube = folder / "cube.poly"
        suite_models.write_cube(cube)
        inputs = [quality_table.Input(cube, size) for size in args.cubes]
        proposals = quality_table.Table(args, folder)
        inputs += [proposals.with_proposal(quality_table.Input(m.resolve())) for m in args.models]
        for given in inputs:
            try:
                runs = Runs(args, given, folder)
            except quality_table.Failure as failure:
                runs, why = None, failure
            for angle in args.angles:
                try:
                    if not runs:
                        raise why
                    line, good = runs.line(angle)
                except quality_table.Failure as failure:
                    line, good = f"| {given.name} | {angle:g} | {failure} |" + " |" * (len(HEAD) - 3), False
                wrong += not good
                lines.append(line)
                print(line, flush=True)
    return wrong + tables.keep(args, lines, args.name) > 0


if __name__ == "__main__":
    sys.exit(main())
