#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What another surface within a tolerance makes of models: triangles, cells and cells left over a bound, before and after.

Usage: surface_table.py PGDR FOLDER [--tolerance E%] [--table FILE] [MODEL...]

MODEL: files of the folder; without any, those of the table in docs/surface.md. Each mesh of another surface is certified by `pgdr check`, and
a table is only made if all are. With --table the rows in FILE are written anew, between the lines that name this script.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

MODELS = ["cgal_hand.off", "cgal_anchor.off", "cgal_femur.off", "cgal_homer.off", "cgal_rotor.off", "cgal_retinal.off",
          "prusa_m3_hex_nut.stl", "occt_sh1.stl", "cgal_elephant.off", "oded_spot_low_resolution.obj"]
FIRST, LAST = "<!-- surfaces: bench/surface_table.py build/release/pgdr FOLDER --table docs/surface.md -->\n", "<!-- end of surfaces -->\n"


def run(pgdr, folder, model, *flags):
    """The report of a mesh, which lies in the folder as out.vtu."""
    report = folder / "report.json"
    done = subprocess.run([pgdr, "mesh", model, "-o", folder / "out.vtu", "--regions", "auto", "--quiet", "--report", report, *flags],
                          capture_output=True, text=True)
    if done.returncode not in (0, 1):
        sys.exit(f"{model}: {done.stderr}")
    return json.loads(report.read_text())


def is_certified(pgdr, folder, model, tolerance):
    done = subprocess.run([pgdr, "check", folder / "out.vtu", "--input", model, "--surface-tolerance", tolerance, "--reasons",
                           folder / "report.json", "--quiet"], capture_output=True, text=True)
    return done.returncode in (0, 1)


def row(pgdr, model, tolerance):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        before = run(pgdr, folder, model)
        after = run(pgdr, folder, model, "--surface-tolerance", tolerance)
        if not is_certified(pgdr, folder, model, tolerance):
            sys.exit(f"{model}: not certified")
        if after["surface"]["given"] != after["surface"]["meshed"]:
            sys.exit(f"{model}: another topology")
    triangles = after["surface_tolerance"]["triangles"]
    cells = [f"{r['cells']:,} | {r['bounds']['poor_left']:,}" for r in (before, after)]
    return f"| {model.name} | {triangles[0]:,} → {triangles[1]:,} | {cells[0]} | {cells[1]} |\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pgdr", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("models", nargs="*", default=MODELS)
    parser.add_argument("--tolerance", default="0.1%")
    parser.add_argument("--table", type=pathlib.Path)
    arguments = parser.parse_args()
    text = "| model | triangles | cells | left | cells after | left after |\n| --- | --- | --- | --- | --- | --- |\n"
    for model in arguments.models:
        text += row(arguments.pgdr.resolve(), arguments.folder / model, arguments.tolerance)
    if not arguments.table:
        return print(text, end="")
    before, rest = arguments.table.read_text().split(FIRST)
    arguments.table.write_text(before + FIRST + text + LAST + rest.split(LAST)[1])


if __name__ == "__main__":
    main()
