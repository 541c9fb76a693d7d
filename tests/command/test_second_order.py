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
