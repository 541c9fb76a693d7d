#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes every input of some folders, checks each mesh, and prints a table; beside TetGen where it is installed.

    bench/models.py build/release/pgdr FOLDER... [--limit SECONDS] [--tetgen tetgen] [--only PART] [--table FILE.md]

A row is complete only if `pgdr check --reasons` ends with the code of `pgdr mesh`, and the run fails (exit 1) otherwise.
Seconds are the processor's, of the whole commands, on one thread; `pgdr check` counts the poor cells of both, from their files.
"Sharp": of pgdr's, those in corners of facets where every mesh that keeps the facets has one (`poor_unavoidable`).
"""
import argparse
import contextlib
import io
import json
import math
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile

import tables

READABLE = {".off", ".obj", ".stl", ".ply", ".poly", ".smesh", ".mesh", ".msh"}
SURFACES = {".off", ".obj", ".stl", ".ply"}
TETGEN_READS = {".off", ".stl", ".ply", ".poly", ".smesh", ".mesh"}
WAIT = 20  # times the limit on the wall, should a command sleep
PEER_BYTES = 8 << 30  # a peer that does not end may take all memory


def run(command, limit, memory=resource.RLIM_INFINITY):
    """(exit code, seconds, what it said) of a command; exit code None if it took more than `limit` seconds. All seconds are the
    processor's: those on the wall depend on what else the machine does."""
    def limits():
        resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(limit), math.ceil(limit) + 5))
        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
    used = lambda: sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
    start = used()
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", preexec_fn=limits,
                              timeout=WAIT * limit)
    except subprocess.TimeoutExpired:
        return None, used() - start, ""
    late = done.returncode in (-signal.SIGXCPU, -signal.SIGKILL)
    return None if late else done.returncode, used() - start, done.stdout + done.stderr


def surface(model):
    """Points and faces of a surface, no matter which of the four formats."""
    if model.suffix == ".obj":
        rows = [line.split() for line in model.read_text(errors="replace").splitlines()]
        return ([tuple(map(float, r[1:4])) for r in rows if r[:1] == ["v"]],
                [[int(w.split("/")[0]) - 1 for w in r[1:]] for r in rows if r[:1] == ["f"]])
    if model.suffix == ".off":  # OFF, COFF, NOFF: what follows the coordinates and the corners is dropped
        body = re.sub(r"^\s*\w*OFF\b", "", model.read_text(), count=1, flags=re.MULTILINE)
        lines = [words for line in body.splitlines() if (words := line.split("#")[0].split())]
        points, polygons = map(int, lines[0][:2])
        rows, faces = lines[1:1 + points], lines[1 + points:1 + points + polygons]
        return [tuple(map(float, r[:3])) for r in rows], [list(map(int, r[1:1 + int(r[0])])) for r in faces]
    import meshio  # Debian: python3-meshio; only for what TetGen cannot take as it is
    with contextlib.redirect_stdout(io.StringIO()):
        read = meshio.read(model)
    return [tuple(p) for p in read.points.tolist()], [f for block in read.cells if block.dim == 2 for f in block.data.tolist()]


def merged(points, faces):
    """The same surface without points given twice, points that belong to nothing and faces with a corner twice, at some of which
    TetGen stops; the points in the order of their coordinates."""
    number = {p: i for i, p in enumerate(sorted({points[i] for face in faces for i in face}))}
    renumbered = [[number[points[i]] for i in face] for face in faces]
    return list(number), [face for face in renumbered if len(set(face)) == len(face)]


def as_off(points, faces, copy):
    lines = [f"OFF\n{len(points)} {len(faces)} 0"] + [" ".join(map(repr, p)) for p in points]
    copy.write_text("\n".join(lines + [" ".join(map(str, [len(f)] + f)) for f in faces]) + "\n")
    return copy


def checked(pgdr, mesh, report, bound, limit, *more):
    """(exit code, report) of `pgdr check`; (None, {}) if it did not end in time."""
    code, _, _ = run([pgdr, "check", mesh, "--radius-edge", f"{bound:g}", "--report", report, "--quiet", *more], limit)
    return code, json.loads(report.read_text()) if report.exists() else {}


def tetgen(args, model, folder):
    """TetGen -pq<bound> of a model: what it said, or the seconds, the cells, those over the bound and the worst of them.

    The last two are `pgdr check`'s, of the files that TetGen wrote: its own statistics have other measures. Where it fails on a
    surface as the file has it, it gets another, shorter try with the `merged` one as .off: "first" is what it said before."""
    copy = folder / model.name
    if model.suffix in TETGEN_READS:
        shutil.copy(model, copy)
    elif model.suffix in SURFACES:
        copy = as_off(*surface(model), copy.with_suffix(".off"))
    else:
        return {"failure": "cannot read it"}
    found = tetgen_of_copy(args, copy, folder)
    if "failure" not in found or model.suffix not in SURFACES:
        return found
    try:
        points, faces = surface(model)
    except (ImportError, SystemExit):  # no meshio, or none that reads it
        return found
    plain = tetgen_of_copy(args, as_off(*merged(points, faces), folder / f"{model.stem}_plain.off"), folder, args.limit / 10)
    return found if "failure" in plain else {**plain, "first": found["failure"]}


def tetgen_of_copy(args, copy, folder, limit=None):
    """The same of a file that may lie beside what TetGen writes."""
    limit = limit or args.limit
    volumes = "aA" if copy.suffix in {".poly", ".smesh"} else ""  # bounds of regions, which pgdr always heeds
    code, seconds, _ = run([args.tetgen, f"-pq{args.bound:g}{volumes}BF", copy], limit, PEER_BYTES)
    mesh = copy.with_suffix(".1.ele")
    if code is None:
        return {"failure": f"over {limit:g} s"}
    if code < 0:
        return {"failure": f"signal {-code}"}
    if code or not mesh.exists():
        return {"failure": f"no mesh, exit {code}"}
    code, report = checked(args.pgdr, mesh, folder / "t.json", args.bound, 10 * args.limit)
    if "cells" not in report or "quality" not in report:
        return {"failure": f"a mesh that the checker cannot read, exit {code}"}
    return {"seconds": seconds, "cells": report["cells"], "poor": report["bounds"]["over_radius_edge"],
            "worst": report["quality"]["max_radius_edge"]}


def one(args, model, folder):
    mesh, report = folder / "m.vtu", folder / "m.json"
    code, seconds, said = run([args.pgdr, "mesh", model, "-o", mesh, "--report", report, "--radius-edge", f"{args.bound:g}",
                               "--threads", "1", "--quiet"], args.limit)
    if code is None:
        said = f"over {args.limit:g} s"
    row = {"model": model.name, "mesh": code, "seconds": seconds, "check": None, "said": said.strip()[:200]}
    if code in (0, 1):
        data = json.loads(report.read_text())
        row.update(cells=data["cells"], poor=data["bounds"]["poor_left"], sharp=data["bounds"]["poor_unavoidable"],
                   worst=data["quality"]["max_radius_edge"])
        row["check"], verdict = checked(args.pgdr, mesh, folder / "c.json", args.bound, 10 * args.limit,
                                        "--input", model, "--reasons", report)
        row["findings"] = verdict.get("finding_count", 0)
    if args.tetgen:
        row["tetgen"] = tetgen(args, model, folder)
    return row


def numbers(r):
    poor = f"{r['poor']:,} | {r['sharp']:,}" if "sharp" in r else f"{r['poor']:,}"
    return f"{r['cells']:,} | {poor} | {r['worst']:.3g} | {r['seconds']:.1f}"


def line_of(r, beside_tetgen):
    own = numbers(r) if "cells" in r else f"{r['said'][:90]} | | | | {r['seconds']:.1f}"
    line = f"| {r['model']} | {own} | {r['mesh']} | {r['check']}"
    line += f" ({r['findings']} findings) |" if r.get("findings") else " |"
    if beside_tetgen:
        other = r["tetgen"]
        first = f"{other['first']}; as merged .off " if "first" in other else ""
        line += f" {first}{numbers(other)} |" if "cells" in other else f" {other['failure']} | | | |"
    return line


def remarks(r):
    """What is worth a second look, though the mesh is right."""
    other = r.get("tetgen", {})
    if "cells" not in r:
        return
    if r["poor"] > max(0.01 * r["cells"], other.get("poor", 0)):
        avoidable = r["poor"] - r["sharp"]
        few = "few" if avoidable <= 0.01 * r["cells"] else "more than 1 %"
        yield (f"{r['poor']:,} poor cells: more than 1 % of all, and than TetGen leaves; {few} ({avoidable:,}) elsewhere than in "
               "corners where every mesh has such")
    if r["cells"] > 10 * other.get("cells", r["cells"]):
        yield "more than 10 times TetGen's cells"
    if r["seconds"] > 10 * max(other.get("seconds", r["seconds"]), 0.1):
        yield "more than 10 times TetGen's seconds"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pgdr")
    parser.add_argument("folders", nargs="+", type=pathlib.Path)
    parser.add_argument("--limit", type=float, default=120)
    parser.add_argument("--bound", type=float, default=2)
    parser.add_argument("--only", default="")
    parser.add_argument("--tetgen", default="")
    tables.add_flags(parser)
    args = parser.parse_args()
    models = sorted(f for d in args.folders for f in ([d] if d.is_file() else d.iterdir())
                    if f.suffix in READABLE and args.only in f.name)
    head = "| model | cells | poor | sharp | worst ratio | seconds | mesh | check |"
    if args.tetgen:
        head += " TetGen: cells | poor | worst ratio | seconds |"
    lines, looks = [head, "|" + " --- |" * (head.count("|") - 1)], []
    bad = 0
    print("\n".join(lines), flush=True)
    for model in models:
        with tempfile.TemporaryDirectory() as folder:
            r = one(args, model, pathlib.Path(folder))
        good = r["mesh"] in (0, 1) and r["check"] == r["mesh"]
        bad += not good
        line = line_of(r, args.tetgen)
        print(line, flush=True)
        lines.append(line)
        looks += [f"{r['model']}: {remark}" for remark in remarks(r)]
    print("\n".join(looks))
    if args.table:
        tables.write_table(args.table, lines + [""] + [f"* {look}" for look in looks])
    print(f"{len(models)} models, {bad} not as they should be")
    return bad > 0


if __name__ == "__main__":
    sys.exit(main())
