#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The tables of docs/selectors.md, of the models in tests/models.

Usage: selector_tables.py COMMAND [--table|--compare docs/selectors.md]

COMMAND is the pgdr command. Every mesh is checked with
`pgdr check`; a mesh that is not sound ends the script. Poor elements that are left are shown as +N. Meshes in 3D are those of the
refinement, without the optimiser, which would move the points that the selectors have chosen.
"""
import argparse
import json
import math
import pathlib
import subprocess
import sys
import tempfile

import tables

MODELS = pathlib.Path(__file__).resolve().parent.parent / "tests" / "models"
SELECTORS = ["circumcenter", "off-center", "optimized", "sliver-avoiding"]
RATIOS = range(2, 21, 2)
# Table 2.3 of Chernikov's dissertation, and TetGen -pqR/0, for two points in a cube.
DISSERTATION = {"circumcenter": [1126, 560, 527, 482, 457, 429, 432, 417, 417, 415],
                "off-center": [777, 298, 190, 184, 236, 157, 180, 181, 169, 172],
                "optimized": [1723, 1619, 174, 174, 174, 174, 174, 174, 174, 174]}
TETGEN = {"TetGen 1.5": [1065, 531, 477, 456, 407, 382, 378, 377, 352, 352],
          "TetGen 1.6": [1060, 506, 420, 361, 355, 343, 324, 311, 295, 289]}
# Triangle 1.6 with circumcentres, and with off-centres, without an area bound, at these angles in degrees.
ANGLES = [10, 20, 25, 30]
TRIANGLE = {"pipe_like": ([4964, 8368, 11754, 16880], [4902, 7376, 11068, 15032]),
            "cylinder_like": ([190, 305, 466, 847], [157, 235, 297, 556]),
            "key_like": ([80, 136, 157, 189], [82, 130, 145, 191]),
            "square1000": ([2412, 3781, 5371, 10567], [2336, 3311, 4178, 5932])}
AREAS = {"pipe_like": 1.0, "cylinder_like": 0.01}  # of Table 2.2


class Command:
    def __init__(self, path, folder):
        self.path, self.mesh_file, self.report_file = path, folder / "out.mesh", folder / "out.json"

    def mesh(self, model, selector, *bounds):
        """Meshes and checks; the report."""
        done = subprocess.run([self.path, "mesh", model, "-o", self.mesh_file, "--selector", selector, "--no-optimize", "--quiet",
                               "--report", self.report_file, *bounds], check=False)
        checked = subprocess.run([self.path, "check", self.mesh_file, "--input", model, "--reasons", self.report_file,
                                  "--quiet", *bounds], check=False)
        if done.returncode > 1 or checked.returncode > 1:
            sys.exit(f"{model} {selector} {' '.join(bounds)}: exit codes {done.returncode}, {checked.returncode}")
        return json.loads(self.report_file.read_text())

    def cells(self, *arguments):
        report = self.mesh(*arguments)
        poor = report["bounds"]["poor_left"]
        return f"{report['cells']}" + (f" +{poor}" if poor else "")

    def least_angles(self):
        """Of each cell of the last mesh (3D), the smallest dihedral angle in degrees, sorted."""
        words = iter(self.mesh_file.read_text().split())
        points, cells = [], []
        for word in words:
            if word == "Vertices":
                points = [(*(float(next(words)) for _ in range(3)), next(words))[:3] for _ in range(int(next(words)))]
            elif word == "Tetrahedra":
                cells = [(*(int(next(words)) - 1 for _ in range(4)), next(words))[:4] for _ in range(int(next(words)))]
        return sorted(least_dihedral([points[v] for v in cell]) for cell in cells)


def least_dihedral(p):
    sub = lambda a, b: [x - y for x, y in zip(a, b)]
    dot = lambda a, b: sum(x * y for x, y in zip(a, b))
    cross = lambda a, b: [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    least = 180.0
    for i, j, k, l in ((0, 1, 2, 3), (0, 2, 1, 3), (0, 3, 1, 2), (1, 2, 0, 3), (1, 3, 0, 2), (2, 3, 0, 1)):
        axis = sub(p[j], p[i])
        u, v = cross(axis, sub(p[k], p[i])), cross(axis, sub(p[l], p[i]))
        w = cross(u, v)
        least = min(least, math.degrees(math.atan2(math.sqrt(dot(w, w)), dot(u, v))))
    return least


def two_points(folder):
    corners = [(i & 1, i >> 1 & 1, i >> 2 & 1) for i in range(8)] + [(0.5, 0.5, 0.5), (0.5001, 0.5, 0.5)]
    faces = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    path = folder / "two_points.poly"
    path.write_text("10 3 0 0\n" + "".join(f"{i} {x} {y} {z}\n" for i, (x, y, z) in enumerate(corners)) + "6 0\n" +
                    "".join("1\n4 " + " ".join(map(str, f)) + "\n" for f in faces) + "0\n0\n")
    return path


def by_ratio(command, model, published):
    """The lines of a table: cells by selector and ratio."""
    rows = []
    for selector in SELECTORS:
        rows.append([selector] + [command.cells(model, selector, "--radius-edge", str(r)) for r in RATIOS])
        if selector in published:
            rows.append([f"{selector}, dissertation"] + published[selector])
    if published:
        rows += [[name] + counts for name, counts in TETGEN.items()]
    return tables.markdown(["tetrahedra at ratio", *RATIOS], rows)


def quality(command, model, *bounds):
    """The lines of two tables: quantiles of the cells' least dihedral angles, and shares of all dihedral angles."""
    rows, classes = [], []
    for selector in SELECTORS:
        report = command.mesh(model, selector, *bounds)
        least = command.least_angles()
        quantile = lambda q: f"{least[int(q * len(least))]:.2f}"
        poor = report["bounds"]["poor_left"]
        ratio = f"{report['quality']['max_radius_edge']:.3g}"
        rows.append([selector, report["cells"], poor, ratio, f"{least[0]:.2f}", quantile(0.01), quantile(0.05), quantile(0.1)])
        histogram = report["quality"]["histogram"]
        classes.append([selector] + [f"{100 * n / sum(histogram):.1f}" for n in histogram])
    return [tables.markdown(["selector", "tetrahedra", "poor", "worst ratio", "smallest dihedral angle", "1 %", "5 %", "10 %"], rows),
            tables.markdown(["% of dihedral angles from", *(f"{10 * i}°" for i in range(18))], classes)]


def plane(command):
    """The lines of two tables: triangles by angle, without and with a bound on the area."""
    rows, bounded = [], []
    for name, (circumcenters, off_centers) in TRIANGLE.items():
        model = MODELS / "planar" / f"{name}.poly"
        for selector, triangle in (("circumcenter", circumcenters), ("off-center", off_centers), ("optimized", None)):
            ours = [command.cells(model, selector, "--min-angle", str(a)) for a in ANGLES]
            rows.append([name, selector] + [f"{n} ({t})" if triangle else n for n, t in zip(ours, triangle or ours)])
            if name in AREAS:
                bounded.append([name, AREAS[name], selector] +
                               [command.cells(model, selector, "--min-angle", str(a), "--size", str(AREAS[name]))
                                for a in (10, 20, 30)])
    return [tables.markdown(["model", "selector", *(f"{a}°" for a in ANGLES)], rows),
            tables.markdown(["model", "area", "selector", "10°", "20°", "30°"], bounded)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command")
    tables.add_flags(parser)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        command = Command(arguments.command, folder)
        found = {"two points": by_ratio(command, two_points(folder), DISSERTATION),
                 "rocket by ratio": by_ratio(command, MODELS / "rocket.poly", {})}
        found["rocket"], found["rocket's angles"] = quality(command, MODELS / "rocket.poly", "--radius-edge", "2")
        elephant = MODELS / "real" / "surfaces" / "cgal_elephant.off"
        found["elephant"], found["elephant's angles"] = quality(command, elephant, "--radius-edge", "2")
        found["angles in the plane"], found["areas in the plane"] = plane(command)
    for name, lines in found.items():
        print("\n".join([f"\n{name}\n", *lines]))
    return sum(tables.keep(arguments, lines, name) for name, lines in found.items()) > 0


if __name__ == "__main__":
    sys.exit(main())
