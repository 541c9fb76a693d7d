#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The table of docs/quality.md: angles and shapes of the cells that several programs make of the same inputs.

    bench/quality_table.py build/release/pgdr [MODEL...] [--limit SECONDS] [--programs LIST] [--table|--compare docs/quality.md]

The unit cube with a bound of size, and every MODEL (.off .stl .ply .obj .poly .smesh) without one, by pgdr without optimisation, as it is by
default, and with `--min-dihedral 20`, each with the tolerance that `pgdr info` proposes for the input, if any; by TetGen with `-q2` and with `-q2/15`; by gmsh's HXT with its optimiser. What is not
installed is left out. `pgdr info` and `pgdr check` measure all of them, from the files that the programs wrote.

HXT keeps the triangles of a surface as they are: it gets those of pgdr's mesh, which are better than the input's. Seconds are
the processor's, of the whole commands, files as well, on one thread. Exit code 1 if a mesh of pgdr fails its check.
"""
import argparse
import collections
import dataclasses
import json
import pathlib
import resource
import shutil
import sys
import tempfile

import models
import suite_models
import tables

CUBE = next(m for m in suite_models.MODELS if m.name == "cube")
BOUND = 2
ANGLES = (5, 10, 15, 20)
HEAD = ["model", "program", "cells", "least", "largest", "0.1 %", "1 %", "5 %", *(f"< {a}" for a in ANGLES), "gamma", f"ratio > {BOUND}",
        "seconds"]
PGDR = {"pgdr --no-optimize": ["--no-optimize"], "pgdr": [], "pgdr --min-dihedral 20": ["--min-dihedral", "20"]}
TETGEN = {"TetGen -pq2": "-pq2", "TetGen -pq2/15": "-pq2/15"}
HXT = "HXT, optimised"


@dataclasses.dataclass(frozen=True)
class Input:
    """A file, or the cube, whose cells have a bound of size."""
    path: pathlib.Path
    size: float = 0
    tolerance: float = 0  # of pgdr; 0: its default

    @property
    def name(self):
        tolerance = f", tolerance {self.tolerance:g}" if self.tolerance else ""
        return f"cube, size {self.size:g}" if self.size else self.path.name + tolerance

    @property
    def pgdr_flags(self):
        return (["--size", self.size] if self.size else []) + (["--tolerance", self.tolerance] if self.tolerance else [])


class Failure(Exception):
    """Why there is no mesh, in few words."""


class Table:
    def __init__(self, args, folder):
        self.args, self.folder, self.wrong = args, folder, 0

    def measured(self, mesh, *input_and_reasons):
        """Report of `pgdr info` and of `pgdr check` of a mesh, as one object; of the latter "exit" as well."""
        info, check = self.folder / "info.json", self.folder / "check.json"
        models.run([self.args.pgdr, "info", mesh, "--report", info, "--quiet"], 10 * self.args.limit)
        code, found = models.checked(self.args.pgdr, mesh, check, BOUND, 10 * self.args.limit, *input_and_reasons)
        if not info.exists() or "bounds" not in found:
            raise Failure("a mesh that cannot be read")
        return {**json.loads(info.read_text()), "over": found["bounds"]["over_radius_edge"], "exit": code}

    def seconds(self, command, memory=resource.RLIM_INFINITY):
        """The seconds that a command takes, with so many bytes at most. @raises Failure if it does not end well"""
        code, seconds, words = models.run(list(map(str, command)), self.args.limit, memory)
        if code is None:
            raise Failure(f"over {self.args.limit:g} s")
        if code not in (0, 1):
            raise Failure(f"signal {-code}" if code < 0 else f"exit {code}: " + words.strip()[:80])
        return seconds

    def pgdr(self, given, flags):
        mesh, report = self.folder / "m.vtu", self.folder / "m.json"
        seconds = self.seconds([self.args.pgdr, "mesh", given.path, "-o", mesh, "--report", report, "--radius-edge", BOUND,
                                "--threads", 1, "--quiet", *given.pgdr_flags, *flags])
        found = self.measured(mesh, "--input", given.path, "--reasons", report)
        if found["exit"] not in (0, 1):
            self.wrong += 1
            print(f"{given.name} {' '.join(flags)}: check says {found['exit']}", file=sys.stderr)
        return found, seconds

    def tetgen(self, given, switches):
        copy = self.folder / given.path.name
        if given.path.suffix in models.TETGEN_READS:
            shutil.copy(given.path, copy)
        else:
            copy = models.as_off(*models.surface(given.path), copy.with_suffix(".off"))
        volume = f"a{CUBE.volume * given.size ** 3:.12f}" if given.size else ""
        regions = "aA" if copy.suffix in {".poly", ".smesh"} and not given.size else ""
        seconds = self.seconds([self.args.tetgen, f"{switches}{volume}{regions}BF", copy], models.PEER_BYTES)
        mesh = copy.with_suffix(".1.ele")
        if not mesh.exists():
            raise Failure("no mesh")
        return self.measured(mesh), seconds

    def hxt(self, given):
        if given.size:
            geo, edge = "cube.geo", CUBE.edge * given.size
        else:
            geo, edge = "surface.geo", 0
            self.write_surface(given)
        shutil.copy(suite_models.ROOT / "bench" / "peers" / geo, self.folder)
        mesh = self.folder / "hxt.msh"
        seconds = self.seconds([self.args.gmsh, "-3", "-algo", "hxt", "-nt", 1, "-setnumber", "edge", edge, "-setnumber", "optimize",
                                1, self.folder / geo, "-o", mesh], models.PEER_BYTES)
        found = self.measured(mesh)
        if not found["cells"]:
            raise Failure("no mesh")
        return found, seconds

    def write_surface(self, given):
        """surface.msh: the triangles on the boundary of pgdr's mesh, not optimised. @raises Failure if they are no closed surface"""
        mesh = self.folder / "surface.mesh"
        flags = PGDR["pgdr --no-optimize"]
        self.seconds([self.args.pgdr, "mesh", given.path, "-o", mesh, "--radius-edge", BOUND, "--quiet", *given.pgdr_flags, *flags])
        words = iter(mesh.read_text().split())
        points, triangles = [], []
        for word in words:
            if word == "Vertices":
                points = [[next(words) for _ in range(4)][:3] for _ in range(int(next(words)))]
            elif word == "Triangles":
                triangles = [[int(next(words)) - 1 for _ in range(4)][:3] for _ in range(int(next(words)))]
        sides = collections.Counter(tuple(sorted((t[i - 1], t[i]))) for t in triangles for i in range(3))
        if set(sides.values()) != {2}:
            raise Failure("not tried: no closed surface")
        off = models.as_off([tuple(map(float, points[i])) for i in range(len(points))], triangles, self.folder / "surface.off")
        suite_models.off_to_msh(off, self.folder / "surface.msh")

    def with_proposal(self, given):
        """With the tolerance that pgdr proposes for it."""
        info = self.folder / "proposal.json"
        models.run([self.args.pgdr, "info", given.path, "--report", info, "--quiet"], self.args.limit)
        proposal = json.loads(info.read_text()).get("proposal") if info.exists() else None
        return dataclasses.replace(given, tolerance=proposal["tolerance"]) if proposal else given

    def lines(self, given):
        """A line a program."""
        given = self.with_proposal(given)
        programs = {**{name: lambda flags=flags: self.pgdr(given, flags) for name, flags in PGDR.items()},
                    **{name: lambda switches=switches: self.tetgen(given, switches) for name, switches in TETGEN.items()},
                    HXT: lambda: self.hxt(given)}
        for name, make in programs.items():
            if not any(name.lower().startswith(p) for p in self.args.programs):
                continue
            try:
                found, seconds = make()
                yield line_of(given.name, name, found, seconds)
            except Failure as failure:
                yield f"| {given.name} | {name} | {failure} |" + " |" * (len(HEAD) - 3)


def line_of(model, program, found, seconds):
    q = found["quality"]
    below = q["cells_by_smallest_angle"]
    values = [model, program, f"{found['cells']:,}", f"{q['min_angle_deg']:.2f}", f"{q['max_angle_deg']:.1f}",
              *(f"{q['smallest_angles_deg'][k]:.1f}" for k in ("0.1%", "1%", "5%")),
              *(f"{sum(below[:a // 5]):,}" for a in ANGLES), f"{q['radius_ratio']['min']:.3f}", f"{found['over']:,}", f"{seconds:.1f}"]
    return "| " + " | ".join(values) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pgdr", type=pathlib.Path)
    parser.add_argument("models", nargs="*", type=pathlib.Path)
    parser.add_argument("--cube", type=float, default=0.04, help="the cube's bound of size; default: %(default)s")
    parser.add_argument("--limit", type=float, default=300, help="seconds for one run of a program; default: %(default)s")
    parser.add_argument("--programs", default="pgdr,tetgen,hxt", help="default: %(default)s")
    parser.add_argument("--tetgen", default="tetgen")
    parser.add_argument("--gmsh", default="gmsh")
    tables.add_flags(parser)
    args = parser.parse_intermixed_args()
    args.pgdr = args.pgdr.resolve()
    needed = {"tetgen": args.tetgen, "hxt": args.gmsh}
    args.programs = [p for p in args.programs.split(",") if p not in needed or shutil.which(needed[p])]
    lines, wrong = ["| " + " | ".join(HEAD) + " |", "|" + " --- |" * len(HEAD)], 0
    print("\n".join(lines), flush=True)
    with tempfile.TemporaryDirectory(prefix="pgdr_quality_") as folder:
        cube = pathlib.Path(folder) / "cube.poly"
        suite_models.write_cube(cube)
        for given in [Input(cube, args.cube)] + [Input(m.resolve()) for m in args.models]:
            with tempfile.TemporaryDirectory(prefix="pgdr_quality_") as work:
                table = Table(args, pathlib.Path(work))
                for line in table.lines(given):
                    print(line, flush=True)
                    lines.append(line)
                wrong += table.wrong
    return wrong + tables.keep(args, lines) > 0


if __name__ == "__main__":
    sys.exit(main())
