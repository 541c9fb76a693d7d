#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The counts that stand in sentences and small tables of README.md and docs/: makes them again, and compares.

    bench/figures.py build/release/pgdr [--models FOLDER] [--write]

FOLDER has further surfaces, in it or in its folder `surfaces`; figures of those that are not there are left out, and said. With
--write the documents get the new figures. Exit code 1 if one is otherwise. Tables of other scripts: bench/quality_table.py,
bench/optimizer_table.py and bench/selector_tables.py with --compare.
"""
import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
INSIDE = [ROOT / folder for folder in ("tests/models", "tests/models/planar", "tests/models/real/surfaces", "tests/regressions")]
REFINED = "--no-optimize"


class Meshes:
    """The reports of runs of the command, each made once."""

    def __init__(self, pgdr, folders, work):
        self.pgdr, self.folders, self.work, self.known = pgdr, folders, work, {}

    def model(self, name):
        return next((f / name for f in self.folders if (f / name).is_file()), None)

    def report(self, name, *flags):
        """@throws LookupError: there is no such model"""
        model = self.model(name)
        if not model:
            raise LookupError(name)
        if (name, flags) not in self.known:
            mesh, report, verdict = (self.work / name for name in ("m.vtu", "m.json", "c.json"))
            subprocess.run([self.pgdr, "mesh", model, "-o", mesh, "--quiet", "--report", report, *flags], check=False)
            bounds = [flag for flag in flags if flag != REFINED]
            done = subprocess.run([self.pgdr, "check", mesh, "--input", model, "--reasons", report, "--quiet", "--report", verdict, *bounds],
                                  check=False)
            if done.returncode > 1:
                sys.exit(f"{name} {' '.join(flags)}: pgdr check ends with {done.returncode}")
            self.known[name, flags] = {**json.loads(report.read_text()), "check": json.loads(verdict.read_text())}
        return self.known[name, flags]


def number(value):
    """As documents write it: 1,234; 0.4; 1.4e5."""
    if isinstance(value, float):
        return f"{value:,.0f}" if 100 <= value < 1e4 else f"{value:.2g}".replace("e+0", "e") if value >= 1e4 else f"{value:.3g}"
    return f"{value:,}" if isinstance(value, int) else value


def below(report, degrees):
    return sum(report["quality"]["cells_by_smallest_angle"][:degrees // 5])


def over_ratio(report):
    return report["check"]["bounds"]["over_radius_edge"]


def angles(report):
    q = report["quality"]
    return {"least": f"{q['min_angle_deg']:.1f}", "largest": f"{q['max_angle_deg']:.1f}"}


def counts(report):
    return {"vertices": report["vertices"], "cells": report["cells"], "poor": report["bounds"]["poor_left"]}


def bracket(meshes):
    refined, optimised = (meshes.report("bracket.poly", "--size", "0.15", *more) for more in ([REFINED], []))
    yield "README.md", "of the bracket's {cells} after the refinement {flat} have a dihedral angle below 15 degrees; " \
        "the smallest is {least}, the largest {largest}.", {**counts(refined), **angles(refined), "flat": below(refined, 15)}
    yield "README.md", "{cells} cells with angles from {least} to {largest} degrees.", {**counts(optimised), **angles(optimised)}


def bunny(meshes):
    found = counts(meshes.report("cgal_bunny00.off", REFINED))
    yield "README.md", "CGAL's bunny00: {poor} of {cells}, where the optimiser leaves none", found
    yield "docs/limits.md", "bunny00: {poor} of {cells};", found


def elephant(meshes):
    yield "docs/limits.md", "elephant: {poor} of {cells};", counts(meshes.report("cgal_elephant.off", REFINED))


def thin_plate(meshes):
    yield "docs/limits.md", "(../tests/regressions/plate_thin.poly): {poor} |", counts(meshes.report("plate_thin.poly", REFINED))


def unexplained(name):
    def find(meshes):
        report = meshes.report(name)
        yield "docs/limits.md", name + ": {unexplained} of {cells}", {**counts(report), **report["optimization"]}
    return find


def small_angles(name, *flags):
    """A row of the table of docs/small-angles.md."""
    def find(meshes):
        row = {}
        for key, more in (("r", [REFINED]), ("o", [])):
            report = meshes.report(name, *flags, *more)
            ratio = report["quality"]["max_radius_edge"]
            row |= {key + "over": over_ratio(report), key + "cells": report["cells"],
                    key + "ratio": "flat cells" if ratio > 1e12 else number(ratio)}
        yield "docs/small-angles.md", f"| {name}" + "{words} | {rover} of {rcells}; {rratio} | {oover} of {ocells}; {oratio} | " \
            "{below} | {unexplained} |", {**row, "below": below(report, 15), "unexplained": report["optimization"]["unexplained"]}
    return find


def planar(name, angle, size):
    """A row of the table of graded meshes of docs/2d.md."""
    def find(meshes):
        found = counts(meshes.report(name + ".poly", "--min-angle", str(angle), "--size", size))
        yield "docs/2d.md", f"| {name} | {angle} | `{size}` | " + "{vertices} | {cells} |", found
    return find


def parallelogram(meshes):
    yield "docs/2d.md", "(`tests/regressions/thin_parallelogram_2.poly`): {cells} triangles", \
        counts(meshes.report("thin_parallelogram_2.poly"))


FIGURES = [bracket, bunny, elephant, thin_plate, unexplained("cgal_hand.off"), unexplained("cgal_anchor.off"),
           small_angles("cgal_elephant.off"), small_angles("foam_flange.stl"), small_angles("cgal_bunny00.off"),
           small_angles("cgal_femur.off"), small_angles("occt_sh1.stl"), small_angles("cgal_hand.off"),
           small_angles("cgal_anchor.off", "--tolerance", "2e-6"),
           planar("pipe_like", 20, "0.5*(sqrt((x-200)^2+(y-200)^2)+1)"),
           planar("key_like", 30, "0.004*(sqrt((x-3)^2+(y-0.5)^2)+1)"),
           planar("cylinder_like", 30, "0.05*(sqrt((x-10)^2+(y-10)^2)-0.4)"), parallelogram]


def pattern(phrase):
    """What finds a phrase, whatever its {fields} are and wherever its lines end; {words} is kept as it is."""
    parts = re.split(r"\{(\w+)\}", phrase)
    text = lambda words: r"\s+".join(re.escape(word) for word in re.split(r"\s+", words))
    group = lambda name: f"(?P<{name}>" + (r"[^|]*?" if name == "words" else r"[\d.,e+]*\d|flat cells") + ")"
    return re.compile("".join(group(part) if i % 2 else text(part) for i, part in enumerate(parts)))


def compare(document, phrase, values, write):
    """What is otherwise, in words. @throws SystemExit: the phrase is not there once"""
    text = document.read_text(encoding="utf-8")
    found = list(pattern(phrase).finditer(text))
    if len(found) != 1:
        sys.exit(f"{document}: {len(found)} places say: {phrase}")
    values = {name: number(values[name]) for name in found[0].groupdict() if name != "words"}
    others = [(found[0].span(name), value) for name, value in values.items() if found[0][name] != value]
    if write:
        for (begin, end), value in sorted(others, reverse=True):
            text = text[:begin] + value + text[end:]
        document.write_text(text, encoding="utf-8")
    return [f"{document.relative_to(ROOT)}: {found[0].string[b:e]} is {value} now: {phrase}" for (b, e), value in others]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pgdr", type=pathlib.Path)
    parser.add_argument("--models", type=pathlib.Path, default=ROOT, help="a folder of further surfaces")
    parser.add_argument("--write", action="store_true", help="the documents get the new figures")
    args = parser.parse_args()
    different = 0
    with tempfile.TemporaryDirectory(prefix="pgdr_figures_") as work:
        meshes = Meshes(args.pgdr.resolve(), [*INSIDE, args.models, args.models / "surfaces"], pathlib.Path(work))
        for figure in FIGURES:
            try:
                lines = [line for f in figure(meshes) for line in compare(ROOT / f[0], f[1], f[2], args.write)]
            except LookupError as missing:
                lines = []
                print(f"left out: {missing}")
            different += len(lines)
            for line in lines:
                print(line, flush=True)
    return different > 0


if __name__ == "__main__":
    sys.exit(main())
