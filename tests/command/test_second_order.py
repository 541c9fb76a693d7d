#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes of second order, as they are written, and read by their corners. Environment and usage: as test_command.py."""
import collections
import shutil
import sys
import unittest

from test_command import BRACKET, PLATE
from test_formats import FormatCase

sys.dont_write_bytecode = True


def ascii_msh(path):
    """Points by tag, and elements (type, nodes) of a .msh 2.2 in text."""
    lines = iter(path.read_text().splitlines())
    points, elements = {}, []
    for line in lines:
        if line == "$Nodes":
            for _ in range(int(next(lines))):
                tag, *at = next(lines).split()
                points[int(tag)] = tuple(map(float, at))
        elif line == "$Elements":
            for _ in range(int(next(lines))):
                words = list(map(int, next(lines).split()))
                elements.append((words[1], words[3 + words[2]:]))
    return points, elements


class SecondOrder(FormatCase):
    """--order 2: a node in the middle of each edge, in each format's order; read by the corners."""

    # The ends of the edges whose middles the nodes behind the corners are, as the manuals draw them.
    ABAQUS = {3: ((0, 1), (1, 2), (2, 0)), 4: ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))}
    GMSH = {2: ((0, 1),), 3: ABAQUS[3], 4: ((0, 1), (1, 2), (2, 0), (0, 3), (2, 3), (1, 3))}

    def assert_middles(self, at, nodes, edges):
        corners = {1: 2, 3: 3, 6: 4}[len(edges)]
        self.assertEqual(len(nodes), corners + len(edges))
        for node, (a, b) in zip(nodes[corners:], edges):
            for x, y, z in zip(at[node], at[nodes[a]], at[nodes[b]]):
                self.assertAlmostEqual(x, (y + z) / 2, delta=1e-13 * max(1, abs(x)))

    def test_written_and_read(self):
        for model, dimension in ((BRACKET, 3), (PLATE, 2), *self.inputs()):
            for extension in ("msh", "vtu"):
                with self.subTest(model.name, extension=extension):
                    linear = self.made(model, extension)
                    self.pgdr("info", linear, "--report", self.report, expect=0)
                    before = self.json()
                    self.output = self.folder / f"second.{extension}"
                    self.mesh(model, "--order", "2")
                    self.assertGreater(self.output.stat().st_size, 1.5 * linear.stat().st_size)
                    done = self.pgdr("check", self.output, "--input", model, expect=0)
                    self.assertIn("read by their corners", done.stderr)
                    self.pgdr("info", self.output, "--report", self.report, expect=0)
                    after = self.json()
                    for key in ("vertices", "cells", "subsegments", "regions"):
                        self.assertEqual(after[key], before[key])
                    again = self.folder / f"again.{extension}"
                    done = self.pgdr("remesh", self.output, "-o", again)
                    self.assertIn("read by their corners", done.stderr)

    def test_nodes_of_abaqus(self):
        for model, dimension in ((BRACKET, 3), (PLATE, 2)):
            self.output = self.folder / "second.inp"
            self.mesh(model, "--order", "2")
            text = self.output.read_text()
            kind, edges = ("C3D10", self.ABAQUS[4]) if dimension == 3 else ("CPS6", self.ABAQUS[3])
            self.assertNotIn("TYPE=C3D4", text)
            at, elements, section = {}, 0, ""
            for line in text.splitlines():
                if line.startswith("*"):
                    section = line
                elif section == "*NODE":
                    tag, *x = line.split(",")
                    at[int(tag)] = tuple(map(float, x))
                elif section.startswith(f"*ELEMENT, TYPE={kind}"):
                    elements += 1
                    self.assert_middles(at, [int(word) for word in line.split(",")[1:]], edges)
            self.assertGreater(elements, 100 if dimension == 3 else 20)

    def test_nodes_of_gmsh(self):
        """gmsh reads them, and makes the same of our mesh of first order: elements with the same nodes at the same places."""
        if shutil.which("gmsh") is None:
            self.skipTest("gmsh is not there")
        for model, dimension in ((BRACKET, 3), (PLATE, 2)):
            made = []
            for order, flags in (("2", ["-save"]), ("1", [f"-{dimension}", "-order", "2"])):
                self.output, theirs = self.folder / f"order{order}.msh", self.folder / f"theirs{order}.msh"
                self.mesh(model, "--order", order)
                log = self.run_ok("gmsh", self.output, *flags, "-format", "msh22", "-o", theirs)
                self.assertNotIn("Error", log)
                at, elements = ascii_msh(theirs)
                for kind, nodes in elements:
                    if kind in (8, 9, 11):
                        self.assert_middles(at, nodes, self.GMSH[{8: 2, 9: 3, 11: 4}[kind]])
                made.append(collections.Counter((kind, tuple(tuple(round(x, 9) + 0.0 for x in at[n]) for n in nodes))
                                                for kind, nodes in elements))
                self.assertGreater(sum(kind == (11 if dimension == 3 else 9) for kind, _ in elements), 20)
                self.pgdr("check", theirs, "--input", model, expect=0)
            self.assertEqual(made[0], made[1])

    def quadratic(self, linear):
        """A linear .mesh with a node in the middle of each edge, written as other programs do: .mesh, .vtk and .node with .ele. A node
        of an edge comes before the corners in some of them."""
        head, lists = self.sections(linear)
        points, edges = lists["Vertices"], {}
        for name in ("Edges", "Triangles", "Tetrahedra"):
            for row in lists.get(name, ()):
                for a, b in self.GMSH[len(row) - 1]:
                    edges.setdefault((min(row[a], row[b]), max(row[a], row[b])), len(edges))
        middles = [[(x + y) / 2 for x, y in zip(points[a - 1][:-1], points[b - 1][:-1])] for a, b in edges]

        def wide(row, order):
            return [v + len(middles) for v in row[:-1]] + [edges[min(row[a], row[b]), max(row[a], row[b])] + 1
                                                            for a, b in order[len(row) - 1]]
        at = middles + [row[:-1] for row in points]
        files = [self.folder / name for name in ("p2.mesh", "p2.vtk", "p2.ele")]
        text = head + f"Vertices\n{len(at)}\n" + "".join(" ".join(map(repr, p)) + " 0\n" for p in at)
        rows = [(name, row) for name in ("Edges", "Triangles", "Tetrahedra") for row in lists.get(name, ())]
        for name in ("Edges", "Triangles", "Tetrahedra"):
            chosen = [row for kind, row in rows if kind == name]
            text += f"{name}P2\n{len(chosen)}\n" + "".join(" ".join(map(str, [*wide(row, self.GMSH), row[-1]])) + "\n" for row in chosen)
        files[0].write_text(text + "End\n")
        dimension = 3 if "Tetrahedra" in lists else 2
        kinds = {2: 21, 3: 22, 4: 24}
        text = f"# vtk DataFile Version 3.0\nmesh\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {len(at)} double\n"
        text += "".join(" ".join(map(repr, (p + [0.0])[:3])) + "\n" for p in at)
        order = {2: ((0, 1),), **self.ABAQUS}
        written = [wide(row, order) for _, row in rows]
        text += f"CELLS {len(rows)} {sum(len(w) + 1 for w in written)}\n"
        text += "".join(f"{len(w)} " + " ".join(str(v - 1) for v in w) + "\n" for w in written)
        text += f"CELL_TYPES {len(rows)}\n" + "".join(f"{kinds[len(row) - 1]}\n" for _, row in rows)
        text += f"CELL_DATA {len(rows)}\nSCALARS marker int 1\nLOOKUP_TABLE default\n"
        text += "".join(f"{row[-1] if len(row) - 1 <= dimension else 0}\n" for _, row in rows)
        text += f"POINT_DATA {len(at)}\nSCALARS heat double 1\nLOOKUP_TABLE default\n" + "".join(f"{p[0]!r}\n" for p in at)
        files[1].write_text(text)
        files[2].with_suffix(".node").write_text(f"{len(at)} {dimension} 0 0\n" + "".join(
            f"{i} " + " ".join(map(repr, p[:dimension])) + "\n" for i, p in enumerate(at)))
        for name, extension in (("Tetrahedra", ".ele"), ("Triangles", ".face" if dimension == 3 else ".ele"), ("Edges", ".edge")):
            chosen = [row for kind, row in rows if kind == name]
            if not chosen:
                continue
            is_cell = len(chosen[0]) - 2 == dimension
            counts = f"{len(chosen)} {len(wide(chosen[0], order))} 0" if is_cell else f"{len(chosen)} 1"
            files[2].with_suffix(extension).write_text(counts + "\n" + "".join(
                f"{i} " + " ".join(str(v - 1) for v in wide(row, order)) + ("" if is_cell else f" {row[-1]}") + "\n"
                for i, row in enumerate(chosen)))
        return files, len(middles)

    @staticmethod
    def sections(file):
        """What stands before the vertices, and rows of numbers by section."""
        text = file.read_text()
        head, lists, words = text[:text.index("Vertices")], {}, iter(text[text.index("Vertices"):].splitlines())
        for line in words:
            if line in ("Vertices", "Edges", "Triangles", "Tetrahedra"):
                of = float if line == "Vertices" else int
                lists[line] = [list(map(of, next(words).split())) for _ in range(int(next(words)))]
        return head, lists

    def test_of_others(self):
        for model in (BRACKET, PLATE):
            linear = self.made(model, "mesh")
            self.pgdr("info", linear, "--report", self.report, expect=0)
            before = self.json()
            files, middles = self.quadratic(linear)
            for file in files:
                with self.subTest(file.name, model=model.name):
                    done = self.pgdr("check", file, "--input", model, "--report", self.report, expect=0)
                    self.assertIn(f"read by their corners: {middles} nodes", done.stderr)
                    self.assertEqual([w["code"] for w in self.json()["warnings"]], ["unknown_format"])
                    self.pgdr("info", file, "--report", self.report, expect=0)
                    after = self.json()
                    for key in ("vertices", "cells", "subsegments", "subfacets"):
                        self.assertEqual(after.get(key), before.get(key), key)
            self.output = self.folder / "coarse.vtu"
            self.pgdr("remesh", files[1], "-o", self.output)
            self.assertIn(b'Name="heat"', self.output.read_bytes())
            volumes = self.folder / ("p2.vol" if model == BRACKET else "p2.area")
            count = before["cells"]
            volumes.write_text(f"{count}\n" + "".join(f"{i + 1} {1 if i else 1e-3}\n" for i in range(count)))
            self.pgdr("refine", files[2], "--cell-bounds", volumes, "-o", self.folder / "fine.vtu")

    def test_nodes_that_are_not_there(self):
        files, _ = self.quadratic(self.made(BRACKET, "mesh"))
        for file, place, word in zip(files, (-2, 0, 1), (-2, -1, -1)):
            lines = file.read_text().splitlines()
            if file.suffix == ".vtk":
                place = next(i for i, line in enumerate(lines) if line.startswith("CELLS")) + 1
            for wrong in ("999999", ""):
                words = lines[place].split()
                words[word] = wrong
                file.write_text("\n".join([*lines[:place], " ".join(words), *lines[place + 1:]]))
                with self.subTest(file.name, wrong=wrong):
                    self.pgdr("info", file, expect=3)
            file.write_text("\n".join(lines))

    def test_of_tetgen_and_gmsh(self):
        if shutil.which("tetgen"):
            said = []  # TetGen gives all faces and edges, and segments without a marker another one: of either order the same is found
            for flags in ("-pqfe", "-pqo2fe"):
                shutil.copy(BRACKET, self.folder / "b.poly")
                self.run_ok("tetgen", flags, self.folder / "b.poly")
                mesh = self.folder / "b.1.ele"
                done = self.pgdr("check", mesh, "--input", BRACKET, "--report", self.report, expect=None)
                self.assertEqual("read by their corners" in done.stderr, "o2" in flags)
                said.append([self.json()[key] for key in ("vertices", "cells", "finding_count", "findings", "quality")])
                self.pgdr("info", mesh, "--report", self.report, expect=0)
                said[-1] += [self.json()[key] for key in ("subfacets", "subsegments")]
            self.assertEqual(said[0], said[1])
            self.assertGreater(said[0][-1], 1000)
        if shutil.which("gmsh"):
            for model, dimension in ((BRACKET, 3), (PLATE, 2)):
                self.output, theirs = self.folder / "linear.msh", self.folder / "theirs.mesh"
                self.mesh(model)
                self.run_ok("gmsh", self.output, f"-{dimension}", "-order", "2", "-format", "mesh", "-o", theirs)
                self.assertIn("P2", theirs.read_text())
                done = self.pgdr("check", theirs, "--input", model, "--report", self.report, expect=None)
                self.assertIn("read by their corners", done.stderr)
                self.assertLessEqual({f["kind"] for f in self.json()["findings"]}, {"wrong_marker"})  # .mesh has gmsh's own numbers
                said = []
                for mesh in (self.output, theirs):
                    self.pgdr("info", mesh, "--report", self.report, expect=0)
                    said.append([self.json().get(key) for key in ("vertices", "cells", "subfacets", "subsegments")])
                self.assertEqual(said[0], said[1])
        if not shutil.which("tetgen") and not shutil.which("gmsh"):
            self.skipTest("neither TetGen nor gmsh is there")

    def test_fields(self):
        """Of points in the middles of edges, and left out when the file is read."""
        self.output = self.folder / "linear.vtu"
        self.mesh(BRACKET)
        try:
            import numpy  # noqa: F401: what puts the field in needs it
        except ImportError:
            self.skipTest("numpy is not there")
        from test_remesh import add_point_field
        self.output.write_bytes(add_point_field(self.output.read_bytes(), "h", lambda x, y, z: 1 + x))
        second, third = self.folder / "second.vtu", self.folder / "third.vtu"
        self.pgdr("remesh", self.output, "-o", second, "--order", "2")
        self.assertIn(b'Name="h"', second.read_bytes())
        self.pgdr("remesh", second, "-o", third, "--size-field", "h")
        self.assertIn(b'Name="h"', third.read_bytes())

    def test_refused(self):
        for extension in ("mesh", "ele", "mfem", "vtk", "pvtu"):
            self.output = self.folder / f"out.{extension}"
            self.pgdr("mesh", BRACKET, "-o", self.output, "--order", "2", expect=2)
        self.pgdr("mesh", BRACKET, "-o", self.folder / "out.msh", "--order", "3", expect=2)


if __name__ == "__main__":
    run = unittest.main(verbosity=2, exit=False).result
    if run.testsRun == len(run.skipped) and run.wasSuccessful():
        print("skipped:", run.skipped[0][1])
        sys.exit(77)
    sys.exit(not run.wasSuccessful())
