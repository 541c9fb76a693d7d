#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes every input of some folders, checks each mesh, and prints a table; beside TetGen where it is installed.

    bench/models.py build/release/pgdr FOLDER... [--limit SECONDS] [--tetgen tetgen] [--only PART] [--table FILE.md]

A row is complete only if `pgdr check --reasons` ends with the code of `pgdr mesh`, and the run fails (exit 1) otherwise.
The time of pgdr is that of the whole command, as is TetGen's.
"""
import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

READABLE = {".off", ".obj", ".stl", ".ply", ".poly", ".smesh", ".mesh", ".msh"}
TETGEN_READS = {".off", ".stl", ".ply", ".poly", ".smesh", ".mesh"}


def run(command, limit):
    start = time.time()
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=limit)
        return done.returncode, time.time() - start, done.stdout + done.stderr
    except subprocess.TimeoutExpired:
        return None, limit, ""


def as_off(model, folder):
    """A copy of an .obj that TetGen can read."""
    points, faces = [], []
    for line in model.read_text(errors="replace").splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append(words[1:4])
        elif words[:1] == ["f"]:
            faces.append([int(w.split("/")[0]) - 1 for w in words[1:]])
    copy = folder / (model.stem + ".off")
    rows = [f"OFF\n{len(points)} {len(faces)} 0"] + [" ".join(p) for p in points]
    rows += [" ".join(map(str, [len(f)] + f)) for f in faces]
    copy.write_text("\n".join(rows) + "\n")
    return copy


def tetgen(program, model, folder, bound, limit):
    """(what to print, cells, cells over the bound) of TetGen -pq<bound>."""
    copy = as_off(model, folder) if model.suffix == ".obj" else shutil.copy(model, folder)
    if pathlib.Path(copy).suffix not in TETGEN_READS:
        return "cannot read it", 0, 0
    code, seconds, said = run([program, f"-pq{bound:g}BEFNV", str(copy)], limit)
    if code is None:
        return f"over {limit:g} s", 0, 0
    cells = re.search(r"Mesh tetrahedra: (\d+)", said)
    if code < 0:
        return f"signal {-code}", 0, 0
    if code or not cells:
        return f"fails (exit {code})", 0, 0
    worst = re.search(r"Circumradius/shortest edge|Radius-edge ratio", said)
    over = 0
    block = re.search(r"Aspect ratio histogram.*?\n\n", said, re.S)
    largest = re.search(r"Largest radius-edge ratio: *([\d.eE+]+)", said) if worst else None
    ratio = f", {float(largest.group(1)):.3g}" if largest else ""
    return f"{int(cells.group(1)):,}, {seconds:.1f} s{ratio}", int(cells.group(1)), over if block else 0


def one(args, model, folder):
    mesh, report, checked = folder / "m.vtu", folder / "m.json", folder / "c.json"
    for file in (mesh, report, checked):
        file.unlink(missing_ok=True)
    flags = ["--radius-edge", f"{args.bound:g}", "--quiet"]
    code, seconds, said = run([args.pgdr, "mesh", model, "-o", mesh, "--report", report] + flags, args.limit)
    row = {"model": model.name, "mesh": code, "seconds": seconds, "check": None, "said": said.strip()[:200]}
    if code in (0, 1):
        data = json.loads(report.read_text())
        row.update(cells=data["cells"], poor=data["bounds"]["poor_left"], worst=data["quality"]["max_radius_edge"])
        row["check"], _, said = run([args.pgdr, "check", mesh, "--input", model, "--reasons", report, "--report", checked]
                                    + flags, 10 * args.limit)
        if checked.exists():
            row["findings"] = json.loads(checked.read_text()).get("finding_count", 0)
    if args.tetgen:
        row["tetgen"], row["tetgen_cells"], _ = tetgen(args.tetgen, model, folder, args.bound, 2 * args.limit)
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pgdr")
    parser.add_argument("folders", nargs="+", type=pathlib.Path)
    parser.add_argument("--limit", type=float, default=120)
    parser.add_argument("--bound", type=float, default=2)
    parser.add_argument("--only", default="")
    parser.add_argument("--tetgen", default="")
    parser.add_argument("--table", type=pathlib.Path)
    args = parser.parse_args()
    models = sorted(f for d in args.folders for f in ([d] if d.is_file() else d.iterdir())
                    if f.suffix in READABLE and args.only in f.name)
    head = "| model | cells | poor | worst ratio | seconds | mesh | check |" + (" TetGen |" if args.tetgen else "")
    lines = [head, "|" + " --- |" * (head.count("|") - 1)]
    bad = 0
    print("\n".join(lines), flush=True)
    for model in models:
        with tempfile.TemporaryDirectory() as folder:
            r = one(args, model, pathlib.Path(folder))
        good = r["mesh"] in (0, 1) and r["check"] == r["mesh"]
        bad += not good
        numbers = f"{r['cells']:,} | {r['poor']:,} | {r['worst']:.3g}" if "cells" in r else f"{r['said'][:90]} | |"
        line = f"| {r['model']} | {numbers} | {r['seconds']:.1f} | {r['mesh']} | {r['check']}"
        line += (f" ({r['findings']} findings) |" if r.get("findings") else " |") + (f" {r['tetgen']} |" if args.tetgen else "")
        print(line, flush=True)
        lines.append(line)
    if args.table:
        args.table.write_text("\n".join(lines) + "\n")
    print(f"{len(models)} models, {bad} not as they should be")
    return bad > 0


if __name__ == "__main__":
    sys.exit(main())
