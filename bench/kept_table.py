#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What keeping the surface makes of the smallest valid inputs of a folder, beside TetGen's -pY and -pq2Y.

    bench/kept_table.py PGDR FOLDER [--first 61] [--turned 20] [--part 0|1] [--only PART] [--limit SECONDS] [--table FILE.md]

The folder has an INDEX.tsv (docs/contributing.md), of whose sets "surfaces" and "plc" the files with the fewest faces are taken. Each is
meshed by `pgdr mesh --keep-boundary` on one thread, and the mesh is checked against its input. A row is as it should be if `check` ends
with the code of `mesh`, and the script ends with 1 if one is not. "Kept": `check` found each given triangle as one subfacet.
"Boundary": points on what was to be kept. "Inside": points that the recovery needed there, of pgdr's report and of `tetgen -pY`.
"Over": cells over the radius-edge bound, counted by `check` in both meshes. "Unexplained": cells over a bound, or below that on
dihedral angles, without a reason that `check` verifies. Seconds are the processor's, of `mesh`.

--turned N: the first N surfaces, turned, in place of the files themselves. --part: every other file alone, to look at the one half
and to judge by the other.
"""
import argparse
import csv
import json
import pathlib
import re
import shutil
import sys
import tempfile

import models
import tables

TURN = ((2 / 3, -1 / 3, 2 / 3), (2 / 3, 2 / 3, -1 / 3), (-1 / 3, 2 / 3, 2 / 3))  # no row of it is exact in binary
HEAD = ["model", "faces", "kept", "boundary", "inside", "cells", "over", "unexplained", "seconds", "TetGen: inside", "cells", "over"]


def smallest(folder, count):
    with open(folder / "INDEX.tsv", newline="") as file:
        rows = [r for r in csv.DictReader(file, delimiter="\t", quoting=csv.QUOTE_NONE) if r["set"] in ("surfaces", "plc")]
    valid = [r for r in rows if r["self_intersecting"] == "no"]
    return [(folder / r["file"], int(r["faces"])) for r in sorted(valid, key=lambda r: (int(r["faces"]), r["file"]))[:count]]


def turned(model, folder):
    points, faces = models.merged(*models.surface(model))
    moved = [tuple(sum(a * x for a, x in zip(row, p)) for row in TURN) for p in points]
    return models.as_off(moved, faces, folder / f"{model.stem}_turned.off")


def tetgen(args, model, folder):
    """Its points inside by -pY, and cells and those over the bound by -pq<bound>Y; what failed in their place."""
    copy = folder / model.name
    if model.suffix == ".obj" or (model.suffix not in models.TETGEN_READS and model.suffix in models.SURFACES):
        copy = models.as_off(*models.surface(model), copy.with_suffix(".off"))
    elif not copy.exists():
        shutil.copy(model, copy)
    node = model.with_suffix(".node")
    if model.suffix in (".poly", ".smesh") and node.exists():
        shutil.copy(node, copy.with_suffix(".node"))
    code, _, said = models.run([args.tetgen, "-pY", copy], args.limit, models.PEER_BYTES)
    inside = re.search(r"Steiner points inside domain: (\d+)", said)
    row = {"inside": "fails" if code else int(inside.group(1)) if inside else 0}
    code, _, _ = models.run([args.tetgen, f"-pq{args.bound:g}Y", copy], args.limit, models.PEER_BYTES)
    mesh = copy.with_suffix(".1.ele")
    if code or not mesh.exists():
        return {**row, "cells": "fails", "over": ""}
    _, report = models.checked(args.pgdr, mesh, folder / "t.json", args.bound, args.limit)
    return {**row, "cells": report["cells"], "over": report["bounds"]["over_radius_edge"]}


def one(args, model, faces, folder):
    mesh, report = folder / "m.vtu", folder / "m.json"
    code, seconds, said = models.run([args.pgdr, "mesh", model, "-o", mesh, "--report", report, "--keep-boundary", "--quiet",
                                      "--radius-edge", f"{args.bound:g}", "--threads", "1", *args.flags.split()], args.limit)
    row = {"model": model.stem, "faces": faces, "code": code, "seconds": seconds, "said": said.strip()[:200]}
    if code in (0, 1):
        made = json.loads(report.read_text())
        row.update(boundary=made["kept_boundary"]["boundary_points"], inside=made["kept_boundary"]["inner_points"])
        row["check"], verdict = models.checked(args.pgdr, mesh, folder / "c.json", args.bound, 10 * args.limit, "--input", model,
                                               "--reasons", report)
        bounds, kinds = verdict["bounds"], {f["kind"] for f in verdict["findings"]}
        row.update(cells=verdict["cells"], over=bounds["over_radius_edge"], unexplained=bounds["unexplained"],
                   kept="no" if "boundary_not_kept" in kinds else "yes", findings=sorted(kinds))
    if args.tetgen:
        row["tetgen"] = tetgen(args, model, folder)
    return row


def line_of(r):
    peer = r.get("tetgen", {})
    return [r["model"], r["faces"], *(r.get(k, "" if k != "kept" else r["said"] or "late")
                                      for k in ("kept", "boundary", "inside", "cells", "over", "unexplained")),
            f"{r['seconds']:.1f}", *(peer.get(k, "") for k in ("inside", "cells", "over"))]


def summary(rows):
    done = [r for r in rows if "cells" in r]
    both = [r for r in done if isinstance(r.get("tetgen", {}).get("cells"), int)]
    share = lambda over, cells: f"{over:,} of {cells:,} ({100 * over / max(cells, 1):.1f} %)"
    more = [r["model"] for r in both if r["over"] * r["tetgen"]["cells"] > r["tetgen"]["over"] * r["cells"]]
    count = lambda key: sum(r[key] for r in done)
    tetgens = sum(r["tetgen"]["inside"] for r in rows if isinstance(r.get("tetgen", {}).get("inside"), int))
    yield f"{len(rows)} models, {len(done)} meshed, {sum(r['kept'] == 'yes' for r in done)} kept"
    yield f"points on the boundary: {count('boundary')} on {sum(r['boundary'] > 0 for r in done)} models"
    yield f"points inside: {count('inside')}, TetGen's {tetgens}"
    yield (f"over the bound, where both mesh: {share(sum(r['over'] for r in both), sum(r['cells'] for r in both))}, TetGen "
           f"{share(sum(r['tetgen']['over'] for r in both), sum(r['tetgen']['cells'] for r in both))}")
    yield f"larger share than TetGen's: {len(more)}: {', '.join(more)}"
    yield f"unexplained: {count('unexplained')} on {sum(r['unexplained'] > 0 for r in done)} models"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pgdr")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--first", type=int, default=61)
    parser.add_argument("--turned", type=int, default=0)
    parser.add_argument("--part", type=int, choices=(0, 1))
    parser.add_argument("--only", default="")
    parser.add_argument("--limit", type=float, default=120)
    parser.add_argument("--bound", type=float, default=2)
    parser.add_argument("--tetgen", default=shutil.which("tetgen") or "")
    parser.add_argument("--flags", default="", help="more flags of `pgdr mesh`")
    tables.add_flags(parser)
    args = parser.parse_args()
    chosen = [m for i, m in enumerate(smallest(args.folder, args.first)) if args.part in (None, i % 2) and args.only in m[0].name]
    if args.turned:
        chosen = [m for m in chosen if m[0].suffix in models.SURFACES][:args.turned]
    rows, bad = [], 0
    for model, faces in chosen:
        with tempfile.TemporaryDirectory() as name:
            given = turned(model, pathlib.Path(name)) if args.turned else model
            rows.append(one(args, given, faces, pathlib.Path(name)))
        good = rows[-1]["code"] in (0, 1) and rows[-1]["check"] == rows[-1]["code"]
        bad += not good
        print("| " + " | ".join(map(str, line_of(rows[-1]))) + " |", "" if good else f"<- {rows[-1]}", flush=True)
    print(*summary(rows), f"{bad} not as they should be", sep="\n")
    return tables.keep(args, tables.markdown(HEAD, map(line_of, rows)) + [""] + [f"* {s}" for s in summary(rows)]) + bad > 0


if __name__ == "__main__":
    sys.exit(main())
