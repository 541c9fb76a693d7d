#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Formats from outside: what the command reads and writes, and what other programs make of it.

gmsh, tetgen and meshio are asked where they are installed; a test that lacks one says so and is skipped.
Environment and usage: as test_command.py.
"""
import collections
import functools
import itertools
import json
import shutil
import struct
import subprocess
import sys
import unittest

from test_command import BRACKET, PLATE, WEDGE, Case

sys.dont_write_bytecode = True

FORMATS = ("vtu", "pvtu", "msh", "mesh", "node", "ele")

# Two boxes side by side, of which the wall between them is a facet, with markers and regions of all kinds.
BOXES = """12 3 0 1
1 0 0 0 7
2 1 0 0 0
3 2 0 0 0
4 0 1 0 0
5 1 1 0 0
6 2 1 0 0
7 0 0 1 0
8 1 0 1 0
9 2 0 1 0
10 0 1 1 0
11 1 1 1 -4
12 2 1 1 0
11 1
1 0 1
4 1 4 5 2
1 0 1
4 2 5 6 3
1 0 -2
4 7 8 11 10
1 0 -2
4 8 9 12 11
1 0 0
4 1 2 8 7
1 0 0
4 2 3 9 8
1 0 4
4 4 10 11 5
1 0 4
4 5 11 12 6
1 0 5
4 1 7 10 4
1 0 6
4 3 6 12 9
1 0 2147483647
4 2 5 11 8
0
2
1 0.5 0.5 0.5 2.5 -1
2 1.5 0.5 0.5 -3 0.05
"""

WHOLE_BOXES = BOXES.replace("2.5 -1", "2 -1")  # some programs write, or read, integers alone

# The same in two dimensions.
SQUARES = """6 2 0 1
1 0 0 7
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 -4
6 2 1 0
7 1
1 1 2 1
2 2 3 1
3 3 6 -2
4 6 5 0
5 5 4 5
6 4 1 3
7 2 5 2147483647
0
2
1 0.5 0.5 2 -1
2 1.5 0.5 3 0.01
"""


@functools.lru_cache(maxsize=None)
def python_with(module):
    for python in (sys.executable, "/usr/bin/python3"):
        if subprocess.run([python, "-c", "import " + module], capture_output=True).returncode == 0:
            return python
    return None


class FormatCase(Case):
    def inputs(self):
        yield self.file("boxes.poly", BOXES), 3
        yield self.file("squares.poly", SQUARES), 2

    def made(self, model, extension, *flags):
        """A mesh of the model in that format, which the checker accepts."""
        self.output = self.folder / f"out.{extension}"
        self.mesh(model, *flags)
        self.pgdr("check", self.output, "--input", model, *flags, expect=0)
        return self.output

    def run_ok(self, *command):
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=500,
                              stdin=subprocess.DEVNULL)
        self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout}{done.stderr}")
        return done.stdout


class Own(FormatCase):
    def test_each_is_written_read_and_checked(self):
        for model, dimension in self.inputs():
            counts = set()
            for extension in FORMATS:
                with self.subTest(extension, dimension=dimension):
                    self.made(model, extension)
                    self.pgdr("info", self.folder / f"out.{extension.replace('node', 'ele')}", "--report", self.report,
                              expect=0)
                    r = self.json()
                    self.assertEqual((r["kind"], r["dimension"], len(r["regions"])), ("mesh", dimension, 2))
                    counts.add(tuple(r.get(k, 0) for k in ("vertices", "cells", "subsegments", "subfacets")))
            self.assertEqual(len(counts), 1, counts)

    def test_markers_are_looked_at(self):
        """What is read back has the markers: a mesh of an input with another marker fails."""
        for model, _ in self.inputs():
            other = self.file("other.poly", model.read_text().replace("2147483647", "17"))
            for extension in FORMATS:
                self.made(model, extension)
                done = self.pgdr("check", self.output, "--input", other, expect=6)
                self.assertIn("wrong_marker", done.stdout)

    def test_reasons_name_the_cells_of_each_format(self):
        model = self.file("wedge.poly", WEDGE)
        for extension in FORMATS:
            self.output = self.folder / f"out.{extension}"
            self.mesh(model, "--min-angle", "20", "--report", self.report, expect=1)
            self.pgdr("check", self.output, "--input", model, "--min-angle", "20", "--reasons", self.report, expect=1)

    def test_meshes_are_inputs(self):
        """The surface of a mesh is meshed again, with its markers and regions, by any number of threads alike."""
        for model, _ in self.inputs():  # without bounds of regions, which no mesh has
            model = self.file("plain.poly", model.read_text().replace("-3 0.05", "-3 -1").replace("3 0.01", "3 -1"))
            for extension in ("msh", "mesh"):
                first = self.made(model, extension, "--size", "0.2")
                self.output = self.folder / "again.vtu"
                bytes_of = set()
                for threads in (1, 2, 8):
                    self.mesh(first, "--threads", threads, "--report", self.report)
                    bytes_of.add(self.output.read_bytes())
                self.assertEqual(len(bytes_of), 1)
                self.pgdr("check", self.output, "--input", first, "--radius-edge", "2", expect=0)
                self.pgdr("check", self.output, "--input", model, expect=0)
                self.pgdr("info", self.output, "--report", self.report, expect=0)
                self.assertEqual(len(self.json()["regions"]), 2)

    def test_voids_of_meshes_stay_voids(self):
        """A box with two boxes inside: one is a hole, one a region with a hole of its own."""
        def box(low, high, first, label):
            points = [(x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])]
            faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]
            return points, ["1 0 %d\n4 %d %d %d %d" % (label, *(c + first for c in f)) for f in faces]
        boxes = [((0, 0, 0), (8, 4, 4), 1), ((1, 1, 1), (3, 3, 3), 2), ((4, 1, 1), (7, 3, 3), 3), ((5, 1.5, 1.5), (6, 2, 2), 4)]
        points, facets = [], []
        for low, high, label in boxes:
            p, f = box(low, high, len(points), label)
            points += p
            facets += f
        text = f"{len(points)} 3 0 0\n" + "".join(f"{i} {x} {y} {z}\n" for i, (x, y, z) in enumerate(points))
        text += f"{len(facets)} 1\n" + "\n".join(facets) + "\n2\n1 2 2 2\n2 5.5 1.75 1.75\n"
        text += "2\n1 0.5 0.5 0.5 1\n2 4.5 2 2 2\n"
        square = [(0, 0), (1, 0), (1, 1), (0, 1)]
        rings = [(0, 0, 8, 1), (1, 1, 2, 2), (4, 1, 3, 3), (5, 2, 1, 4)]  # corner, side, marker: the same in the plane
        corners = [(x + s * u, y + s * v) for x, y, s, _ in rings for u, v in square]
        flat = "16 2 0 0\n" + "".join(f"{i} {x} {y}\n" for i, (x, y) in enumerate(corners))
        flat += "16 1\n" + "".join(f"{i} {i} {i // 4 * 4 + (i + 1) % 4} {rings[i // 4][3]}\n" for i in range(16))
        flat += "2\n1 2 2\n2 5.5 2.5\n2\n1 0.5 0.5 1 -1\n2 4.5 2 2 -1\n"
        models = (self.file("boxes.poly", text), self.file("flat.poly", flat))
        for model, extension in itertools.product(models, ("msh", "mesh")):
            first = self.made(model, extension)
            self.output = self.folder / "again.vtu"
            self.mesh(first)
            self.pgdr("check", self.output, "--input", model, expect=0)
            self.pgdr("check", self.output, "--input", first, expect=0)

    def test_the_input_is_not_replaced(self):
        points = self.file("part.node", PLATE.read_text().split("\n34 1")[0] + "\n")
        content = PLATE.read_text()
        head = next(line for line in content.split("\n") if line.strip() and not line.startswith("#"))
        lines = content.split("\n")
        begin = lines.index(head)
        count = int(head.split()[0])
        points.write_text("\n".join(lines[begin:begin + count + 1]) + "\n")
        poly = self.file("part.poly", "\n".join(["0 2 0 0", *lines[begin + count + 1:]]))
        before = points.read_bytes()
        for name in ("part.node", "part.ele"):
            self.output = self.folder / name
            done = self.mesh(poly, expect=2)
            self.assertIn("replace the input", done.stderr)
        self.assertEqual(points.read_bytes(), before)
        self.output = self.folder / "part.1.ele"
        self.mesh(poly)
        self.pgdr("check", self.output, "--input", poly, expect=0)
        self.assert_only("part.1.edge", "part.1.ele", "part.1.node", "part.node", "part.poly")

    def test_ply(self):
        corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
        faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]
        head = ("ply\nformat %s 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
                "element face 6\nproperty list uchar int vertex_indices\nend_header\n")
        text = head % "ascii" + "".join("%g %g %g\n" % p for p in corners) + "".join("4 %d %d %d %d\n" % f for f in faces)
        meshes = set()
        for name, order in (("little", "<"), ("big", ">")):
            data = b"".join(struct.pack(order + "3f", *p) for p in corners)
            data += b"".join(struct.pack(order + "B4i", 4, *f) for f in faces)
            path = self.file(name + ".ply", (head % f"binary_{name}_endian").encode() + data)
            self.mesh(path, "--size", "0.4")
            meshes.add(self.output.read_bytes())
        path = self.file("text.ply", text)
        for threads in (1, 2, 8):
            self.mesh(path, "--size", "0.4", "--threads", threads)
            meshes.add(self.output.read_bytes())
        self.assertEqual(len(meshes), 1)
        self.pgdr("check", self.output, "--input", path, "--size", "0.4", "--radius-edge", "2", expect=0)


@unittest.skipUnless(shutil.which("gmsh"), "gmsh is not installed")
class Gmsh(FormatCase):
    def test_meshes_go_through_it_and_back(self):
        """gmsh reads our .msh and writes it again in each of its variants: no marker, region or element is lost."""
        models = [(BRACKET, 3), (PLATE, 2), *self.inputs()]
        for model, _ in models:
            ours = self.made(model, "msh")
            for version in ("msh22", "msh41"):
                for binary in ([], ["-bin"]):
                    with self.subTest(model.name, version=version, binary=binary):
                        theirs = self.folder / "theirs.msh"
                        log = self.run_ok("gmsh", ours, "-save", "-format", version, *binary, "-o", theirs)
                        self.assertNotIn("Warning", log)
                        self.assertNotIn("Error", log)
                        self.pgdr("check", theirs, "--input", model, expect=0)
                        theirs.unlink()

    GEOMETRY = """
        SetFactory("Built-in");
        Point(1) = {0,0,0,%(h)s}; Point(2) = {2,0,0,%(h)s}; Point(3) = {2,1,0,%(h)s}; Point(4) = {0,1,0,%(h)s};
        Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,4}; Line(4) = {4,1};
        Curve Loop(1) = {1,2,3,4}; Plane Surface(1) = {1};
        """
    SOLID = GEOMETRY + """
        out[] = Extrude{0,0,1}{Surface{1};};
        Physical Surface("bottom", 3) = {1};
        Physical Surface(9) = {out[0]};
        Physical Surface("sides", 7) = {out[2], out[3], out[4], out[5]};
        Physical Volume("inside", 5) = {out[1]};
        Physical Curve("edge", 4) = {1,2,3,4};
        Physical Point("corner", 8) = {1};
        """
    PLANE = GEOMETRY + 'Physical Curve("rim", 6) = {1,2,3,4}; Physical Surface("face", 2) = {1};\n'

    def test_its_meshes_are_inputs(self):
        """Geometry meshed by gmsh in each variant and meshed again here: the groups are markers and regions."""
        for geometry, dimension in ((self.SOLID, 3), (self.PLANE, 2)):
            source = self.file("part.geo", geometry % {"h": "0.5"})
            for made in range(dimension - 1, dimension + 1):  # the boundary alone, and the volume
                for variant in ("msh22", "msh22 -bin", "msh41", "msh41 -bin", "mesh"):
                    with self.subTest(variant, dimension=dimension, made=made):
                        theirs = self.folder / f"theirs.{variant[:3] if variant != 'mesh' else 'mesh'}"
                        self.run_ok("gmsh", source, f"-{made}", "-format", *variant.split(), "-o", theirs)
                        again = self.made(theirs, "msh")
                        groups, names = self.groups(again)
                        if variant == "mesh":
                            continue  # gmsh writes numbers of entities, not of groups, there
                        if dimension == 3:
                            self.assertEqual(groups[2], {3, 7, 9})
                            self.assertLessEqual({"bottom", "sides", "edge", "corner"}, names)
                            self.assertLessEqual({4}, groups[1])
                            self.assertEqual(groups[0], {8})
                        else:
                            self.assertEqual(groups[1], {6})
                            self.assertIn("rim", names)
                        if made == dimension:
                            self.assertEqual(groups[dimension], {5 if dimension == 3 else 2})
                            self.assertIn("inside" if dimension == 3 else "face", names)

    def groups(self, path):
        """Numbers of the physical groups that have elements and stand for their labels, by dimension, as gmsh itself counts them; and
        the names of all."""
        text = self.folder / "text.msh"
        self.run_ok("gmsh", path, "-save", "-format", "msh22", "-o", text)
        lines = iter(text.read_text().split("\n"))
        names = {}
        groups = collections.defaultdict(set)
        for line in lines:
            if line == "$PhysicalNames":
                for _ in range(int(next(lines))):
                    dimension, number, name = next(lines).split(" ", 2)
                    names[int(dimension), int(number)] = name
            if line == "$Elements":
                for _ in range(int(next(lines))):
                    words = list(map(int, next(lines).split()))
                    dimension = {15: 0, 1: 1, 2: 2, 4: 3}[words[1]]
                    if not names.get((dimension, words[3]), "").startswith('"pgdr '):
                        groups[dimension].add(words[3])
        text.unlink()
        return groups, {name[1:-1] for name in names.values()}


@unittest.skipUnless(shutil.which("tetgen"), "tetgen is not installed")
class Tetgen(FormatCase):
    def test_reads_our_files(self):
        model, _ = next(iter(self.inputs()))
        self.made(model, "node", "--size", "0.3", "--report", str(self.report))
        log = self.run_ok("tetgen", "-rNEF", self.folder / "out")
        self.pgdr("info", self.folder / "out.ele", "--report", self.report, expect=0)
        r = self.json()
        for words, key in (("Mesh tetrahedra", "cells"), ("Mesh points", "vertices"),
                           ("Mesh faces on facets", "subfacets"), ("Mesh edges on segments", "subsegments")):
            self.assertIn(f"{words}: {r[key]}\n", log)

    def test_its_meshes_are_checked(self):
        """It gives segments without a marker the marker 1; all else is as asked for."""
        model = self.file("boxes.poly", WHOLE_BOXES)
        self.run_ok("tetgen", "-pqAa0.05", model)
        for name in ("boxes.1.node", "boxes.1.ele"):
            self.pgdr("check", self.folder / name, "--input", model, "--report", self.report, expect=6)
            for finding in self.json()["findings"]:
                self.assertEqual(finding["kind"], "wrong_marker")
                self.assertRegex(finding["message"], "^Subsegment .* has marker 1, but no input segment with that marker has all of it")


@unittest.skipUnless(python_with("meshio"), "no Python has meshio")
class Meshio(FormatCase):
    SCRIPT = """
import collections, json, sys
import meshio
mesh = meshio.read(sys.argv[1])
counts = collections.Counter()
labels = collections.defaultdict(collections.Counter)
for i, block in enumerate(mesh.cells):
    counts[block.type] += len(block.data)
    for key in mesh.cell_data:
        for v in map(float, mesh.cell_data[key][i]):
            labels[key + "/" + block.type][repr(v)] += 1
print(json.dumps({"points": len(mesh.points), "counts": counts, "labels": labels}))
"""

    def seen(self, path):
        script = self.file("script.py", self.SCRIPT)
        return json.loads(self.run_ok(python_with("meshio"), script, path).strip().split("\n")[-1])

    def test_counts_and_labels(self):
        for model, dimension in self.inputs():
            kinds = {"cells": "tetra" if dimension == 3 else "triangle", "subsegments": "line"}
            if dimension == 3:
                kinds["subfacets"] = "triangle"
            truth = None
            for extension, key in (("vtu", None), ("mesh", "medit:ref"), ("msh", "gmsh:physical")):
                with self.subTest(extension, dimension=dimension):
                    path = self.made(model, extension)
                    self.pgdr("info", path, "--report", self.report, expect=0)
                    r = self.json()
                    seen = self.seen(path)
                    self.assertEqual(seen["points"], r["vertices"])
                    for ours, theirs in kinds.items():
                        self.assertEqual(seen["counts"][theirs], r[ours])
                    labels = {k: self.labels(seen["labels"], key, kind, k) for k, kind in kinds.items()}
                    if extension == "mesh" and dimension == 3:  # whose regions, no integers, are numbered
                        labels["cells"] = {{"1.0": "-3.0", "2.0": "2.5"}[v]: n for v, n in labels["cells"].items()}
                    truth = truth or labels
                    if extension != "msh":
                        self.assertEqual(labels, truth)
                        continue
                    for kind in kinds:  # where labels that are no positive integers have other numbers
                        self.assertEqual(sorted(labels[kind].values()), sorted(truth[kind].values()))
                        for label, n in truth[kind].items():
                            if float(label) >= 1 and float(label).is_integer():
                                self.assertEqual(labels[kind][label], n)
            if dimension == 3:
                self.assertEqual(set(truth["subfacets"]), {"1.0", "-2.0", "0.0", "4.0", "5.0", "6.0", "2147483647.0"})
                self.assertEqual(set(truth["cells"]), {"2.5", "-3.0"})
            else:
                self.assertEqual(set(truth["subsegments"]), {"1.0", "-2.0", "0.0", "5.0", "3.0", "2147483647.0"})
                self.assertEqual(set(truth["cells"]), {"2.0", "3.0"})

    @staticmethod
    def labels(seen, key, kind, ours):
        """How many elements of a kind have each label."""
        return seen[f"{key or ('region' if ours == 'cells' else 'marker')}/{kind}"]

    def test_tetgen_files(self):
        model = self.file("boxes.poly", WHOLE_BOXES)  # it reads integers alone
        path = self.made(model, "ele")
        self.pgdr("info", path, "--report", self.report, expect=0)
        seen = self.seen(path)
        self.assertEqual((seen["points"], seen["counts"]), (self.json()["vertices"], {"tetra": self.json()["cells"]}))
        self.assertEqual(set(seen["labels"]["tetgen:ref/tetra"]), {"2.0", "-3.0"})


@unittest.skipUnless(python_with("vtk"), "no Python has VTK")
class Vtk(FormatCase):
    SCRIPT = """
import collections, json, sys
import vtk
reader = vtk.vtkXMLUnstructuredGridReader()
reader.SetFileName(sys.argv[1])
reader.Update()
grid = reader.GetOutput()
data = grid.GetCellData()
counts = collections.Counter()
for i in range(grid.GetNumberOfCells()):
    kind = grid.GetCellType(i)
    array = data.GetArray("region" if kind == (10 if sys.argv[2] == "3" else 5) else "marker")
    counts["%d: %r" % (kind, array.GetTuple1(i))] += 1
corners = collections.Counter(grid.GetPointData().GetArray("marker").GetTuple1(i) for i in range(grid.GetNumberOfPoints()))
print(json.dumps({"bounds": grid.GetBounds(), "counts": counts, "markers": {repr(k): v for k, v in corners.items()}}))
"""

    def test_counts_and_labels(self):
        script = self.file("script.py", self.SCRIPT)
        for model, dimension in self.inputs():
            path = self.made(model, "vtu")
            self.pgdr("info", path, "--report", self.report, expect=0)
            seen = json.loads(self.run_ok(python_with("vtk"), script, path, dimension))
            counts = collections.Counter()
            labels = collections.defaultdict(set)
            for key, n in seen["counts"].items():
                kind, label = key.split(": ")
                counts[int(kind)] += n
                labels[int(kind)].add(float(label))
            r = self.json()
            self.assertEqual(counts[10 if dimension == 3 else 5], r["cells"])
            self.assertEqual(counts[3], r["subsegments"])
            if dimension == 3:
                self.assertEqual(counts[5], r["subfacets"])
                self.assertEqual(labels[5], {1, -2, 0, 4, 5, 6, 2147483647})
                self.assertEqual(labels[10], {2.5, -3})
            else:
                self.assertEqual(labels[3], {1, -2, 0, 5, 3, 2147483647})
                self.assertEqual(labels[5], {2, 3})
            self.assertEqual((seen["markers"]["7.0"], seen["markers"]["-4.0"]), (1, 1))
            self.assertEqual(seen["bounds"], [0, 2, 0, 1, 0, 1 if dimension == 3 else 0])


if __name__ == "__main__":
    run = unittest.main(verbosity=2, exit=False).result
    if run.testsRun == len(run.skipped) and run.wasSuccessful():
        print("skipped:", run.skipped[0][1])
        sys.exit(77)
    sys.exit(not run.wasSuccessful())
