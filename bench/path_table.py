#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The critical path of whole runs beside the seconds of an earlier build on one thread: how much faster any machine could be.

    bench/path_table.py build/release/pgdr --before OTHER/pgdr [--models LIST] [--model-folder DIR] [--repeat 5] [--table FILE.md]

Both builds mesh each model on one thread by turns, refinement alone, and each checks its own meshes. TetGen and gmsh's HXT run once a
model, where they are installed and can do it. Seconds are `seconds.mesh`, the path is over all of it; all are medians, and "of" are the
ratios' medians, run beside run. Exit code: 0; 1 if a mesh is wrong, or not the same in all rounds; 2 for wrong usage.
"""
import argparse
import collections
import dataclasses
import json
import os
import pathlib
import shutil
import signal
import statistics
import sys
import tempfile

import suite
import suite_machine
import suite_models
import tables
from suite_programs import Configuration, Suite

SIZES = {"elephant": 0.0059, "armadillo": 1.04}  # where the suite has another
NAMES = ["elephant", "fandisk", "armadillo", "nefertiti", "bunny00", "million", "cube", "cube10", "bat", "pipe16"]
HEAD = ["model", "cells", "before", "after", "after of before", "path", "before of path", "work of path", "refused a committed",
        "set aside", "bytes a cell", "longest on the path", "check", "TetGen", "HXT"]


def arguments():
    listed = lambda text: [word for word in text.split(",") if word]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("pgdr", nargs="?", type=pathlib.Path, default=suite_models.ROOT / "build" / "release" / "pgdr", help="the command")
    add("--before", type=pathlib.Path, help="another build's command; none: half of the columns are empty")
    add("--models", type=listed, default=NAMES, help=f"of bench/suite.py's; default: {','.join(NAMES)}")
    add("--model-folder", default=os.environ.get("PGDR_MODELS", ""), help="where surfaces are; $PGDR_MODELS")
    add("--repeat", type=int, default=5, help="rounds; default: %(default)s")
    add("--peers", type=listed, default=["tetgen", "gmsh"], help="default: tetgen,gmsh; '' for none")
    add("--quick", action="store_true", help="small meshes: the script itself is tried")
    add("--json", type=pathlib.Path, help="a file for all runs")
    add("--table", type=pathlib.Path, help="a file whose table, between its marks, is replaced")
    return parser.parse_args()


def refinement_alone(pgdr):
    return ["--no-optimize"] if "--no-optimize" in suite_machine.said([pgdr, "mesh", "--help"]) else []


def run_model(model, builds, a):
    """{build: rows}: "before" and "after" by turns, and the peers once."""
    runs = collections.defaultdict(list)
    for number in range(1, a.repeat + 1):
        for name, build in builds.items():
            runs[name].append(build.run(Configuration(model, "pgdr", "reproducible", 1), number))
    build = builds["after"]
    if build.tetgen_program and (model.volume or model.background):
        runs["TetGen"].append(build.run(Configuration(model, "TetGen", "", 1), 1))
    if build.gmsh_program and model.geo:
        runs["HXT"].append(build.run(Configuration(model, "gmsh HXT", "", 1, model.geo[0][1]), 1))
    return runs


def wrong_runs(name, runs):
    for build in ("before", "after"):
        for r in runs.get(build, []):
            if r["exit"] not in (0, 1) or r["check"] != r["exit"]:
                yield f"{name}, {build}, round {r['round']}: exit code {r['exit']}, of the check {r['check']}; {r['remark'] or ''}"
            elif r["sha256"] != runs[build][0]["sha256"]:
                yield f"{name}, {build}, round {r['round']}: not the bytes of the first round"


def longest(rows, count=3):
    """The stages with the longest paths, in per cent of the whole path."""
    stages = suite.summarize_stages(rows)
    whole = statistics.median(r["critical_path_seconds"] for r in rows)
    first = sorted(stages, key=lambda s: -s["path"])[:count]
    return ", ".join(f"{s['stage']} {100 * s['path'] / whole:.0f} %" for s in first)


def line_of(name, runs):
    """A line of the table; a model without a mesh has its remark."""
    meshes = {build: [r for r in rows if r["seconds_mesh"]] for build, rows in runs.items()}
    after, before = meshes["after"], meshes.get("before", [])
    if not after:
        return f"| {name} | {runs['after'][0]['remark']} |" + " |" * (len(HEAD) - 2)
    middle = lambda rows, key: statistics.median(key(r) for r in rows)
    pairs = [(b, r) for b in before for r in after if b["round"] == r["round"]]
    of = lambda key: middle(pairs, key) if pairs else None
    both = lambda key, form: " → ".join(format(middle(rows, key), form) for rows in (before, after) if rows)
    peer = lambda build: "; ".join(f"{r['seconds_mesh']:.2f} s, {r['cells']:,} cells" if r["seconds_mesh"] and r["cells"] else "fails"
                                   for r in runs.get(build, [])) or "-"
    some = lambda value, form: "" if value is None else format(value, form)
    path = lambda r: r["critical_path_seconds"]
    values = [name, f"{after[0]['cells']:,}", some(middle(before, lambda r: r["seconds_mesh"]) if before else None, ".2f"),
              f"{middle(after, lambda r: r['seconds_mesh']):.2f}", some(of(lambda p: p[1]["seconds_mesh"] / p[0]["seconds_mesh"]), ".2f"),
              f"{middle(after, path):.3f}", some(of(lambda p: p[0]["seconds_mesh"] / path(p[1])), ".1f"),
              f"{middle(after, lambda r: r['work_seconds'] / path(r)):.1f}", both(lambda r: r["refused"] / max(1, r["committed"]), ".2f"),
              both(lambda r: 100 * r["set_aside"] / max(1, r["committed"]), ".2f") + " %", both(lambda r: r["bytes_per_cell"], ".0f"),
              longest(after), "/".join(sorted({str(r["check"]) for r in before + after})), peer("TetGen"), peer("HXT")]
    return "| " + " | ".join(values) + " |"


def main():
    a = arguments()
    known = {m.name: m for m in suite_models.MODELS}
    lost = [str(p) for p in (a.pgdr, a.before) if p and not p.is_file()] + [n for n in a.models if n not in known]
    if lost or a.repeat < 1:
        print(f"path_table.py: no {', '.join(lost)}" if lost else "path_table.py: --repeat takes 1 or more", file=sys.stderr)
        return 2
    lines, wrong, everything = ["| " + " | ".join(HEAD) + " |", "|" + " --- |" * len(HEAD)], [], {}
    print("\n".join(lines), flush=True)
    record = suite_machine.record(suite_models.ROOT, a.pgdr)
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # so that what was made is removed
    for name in a.models:  # one after the other, so that the largest inputs are not all made before the first figure
        model = dataclasses.replace(known[name], size=SIZES.get(name, known[name].size))
        with tempfile.TemporaryDirectory(prefix="pgdr_path_") as folder:
            inputs = suite_models.inputs_of([model], a.model_folder, pathlib.Path(folder))
            if not inputs:
                continue
            sizes = {name: model.quick if a.quick else model.size}
            programs = [shutil.which(p) if p in a.peers else None for p in ("tetgen", "gmsh")]
            builds = {build: Suite(pgdr, inputs, sizes, 3600, *programs, flags=refinement_alone(pgdr))
                      for build, pgdr in (("before", a.before), ("after", a.pgdr)) if pgdr}
            runs = run_model(model, builds, a)
        everything[name] = runs
        wrong += wrong_runs(name, runs)
        lines.append(line_of(name, runs))
        print(lines[-1], flush=True)
    words = ["", f"{suite_machine.words(record)}, medians of {a.repeat}."]
    print("\n".join(words + [f"WRONG: {w}" for w in wrong]))
    if a.json:
        a.json.write_text(json.dumps({**record, "wrong": wrong, "runs": everything}, indent=1) + "\n")
    if a.table:
        tables.write_table(a.table, lines + words, "path table")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
