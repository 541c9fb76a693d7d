#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Sides that correspond: --periodic. Usage: test_periodic.py [Class[.test]...]"""
import math
import random
import re
import struct
import unittest

import periodic_cells
from test_command import Case


def cell(shear, turn, pieces, holes):
    """A .poly of a unit cell, sheared and turned, its sides with markers 1 to 4 in so many pieces each, holes with marker 9."""
    place = lambda x, y: (math.cos(turn) * (x + shear * y) - math.sin(turn) * y, math.sin(turn) * (x + shear * y) + math.cos(turn) * y)
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    points, segments = [], []
    for side, (a, b) in enumerate(zip(corners, corners[1:] + corners[:1])):
        for k in range(pieces[side]):
            points.append(tuple(a[i] + (b[i] - a[i]) * k / pieces[side] for i in range(2)))
            segments.append((len(points) - 1, len(points), side + 1))
    segments[-1] = (segments[-1][0], 0, 4)
    for x, y, radius in holes:
        first = len(points)
        points += [(x + radius * math.cos(k * math.pi / 6), y + radius * math.sin(k * math.pi / 6)) for k in range(12)]
        segments += [(first + k, first + (k + 1) % 12, 9) for k in range(12)]
    row = lambda i, p: "{} {!r} {!r}\n".format(i, *place(*p))
    text = f"{len(points)} 2 0 0\n" + "".join(row(i, p) for i, p in enumerate(points))
    text += f"{len(segments)} 1\n" + "".join(f"{i} {a} {b} {m}\n" for i, (a, b, m) in enumerate(segments))
    return text + f"{len(holes)}\n" + "".join(row(i, hole[:2]) for i, hole in enumerate(holes))


def drawn(chance, count):
    """Disks that stay off each other and off the sides."""
    holes = []
    while len(holes) < count:
        radius = chance.uniform(0.02, 0.12)
        x, y = (chance.uniform(radius + 0.02, 0.98 - radius) for _ in range(2))
        if all(math.hypot(x - a, y - b) > radius + r + 0.02 for a, b, r in holes):
            holes.append((x, y, radius))
    return holes


class Periodic(Case):
    SIDES = "--periodic", "4=2", "--periodic", "1=3"

    def meshed(self, model, *flags, expect=(0, 1)):
        done = self.mesh(model, *self.SIDES, *flags, "--report", self.report, expect=None)
        self.assertIn(done.returncode, expect, done.stderr)
        checked = self.pgdr("check", self.output, "--input", model, "--reasons", self.report, expect=done.returncode).stdout
        self.assertEqual(checked.count("\nperiodic "), 2)
        return self.json()

    def test_cells(self):
        chance = random.Random(6)
        for k in range(12):
            shear, turn = chance.uniform(-0.8, 0.8), chance.choice((0, chance.uniform(0, 6)))
            pieces = [chance.choice((1, 1, 2, 3)) for _ in range(4)]
            model = self.file("cell.poly", cell(shear, turn, pieces, drawn(chance, chance.choice((0, 1, 3)))))
            flags = chance.choice(([], ["--size", 0.002], ["--min-angle", 28], ["--size", "0.0005+0.01*abs(x)"]))
            report = self.meshed(model, *flags)
            for pairs in report["periodic"]:
                self.assertEqual(len(pairs["points"]), pairs["walls"] + 1)
                self.assertLess(pairs["largest_gap"], 1e-15)
            alone = self.mesh(model, *flags, "--report", self.report, expect=None)
            self.assertLess(report["cells"], 2.5 * self.json()["cells"] + 10, alone.stdout)

    def test_threads(self):
        model = self.file("cell.poly", cell(0.3, 0.2, (1, 2, 1, 1), [(0.9, 0.3, 0.07)]))
        meshes = set()
        for threads in (1, 2, 8):
            self.meshed(model, "--size", 0.0005, "--threads", threads)
            meshes.add(self.output.read_bytes())
        self.assertEqual(len(meshes), 1)

    def test_files(self):
        """.vtu: of each vertex the least that is one with it. .msh: gmsh's section."""
        model = self.file("cell.poly", cell(0, 0, (1, 1, 1, 1), [(0.9, 0.3, 0.07)]))
        report = self.meshed(model)
        pairs = {frozenset(pair) for p in report["periodic"] for pair in p["points"]}
        data = self.output.read_bytes()
        offset = int(re.search(rb'Name="periodic_of"[^>]* offset="(\d+)"', data).group(1))
        begin = data.index(b"_", data.index(b"<AppendedData")) + 1 + offset
        size, = struct.unpack_from("<Q", data, begin)
        of = struct.unpack_from(f"<{size // 8}q", data, begin + 8)
        self.assertEqual(len(of), report["vertices"])
        for v, w in map(sorted, pairs):
            self.assertEqual(of[v], of[w])
        self.assertEqual(len({of[v] for v in range(4)}), 1)  # the corners are one
        self.assertEqual(sum(w != v for v, w in enumerate(of)), sum(len(p["points"]) for p in report["periodic"]) - 1)
        self.output = self.folder / "out.msh"
        self.meshed(model)
        data = self.output.read_bytes()
        at = data.index(b"$Periodic\n") + len(b"$Periodic\n")
        links, dimension, _, _, numbers = struct.unpack_from("<QiiiQ", data, at)
        self.assertEqual((links, dimension, numbers), (2, 1, 16))
        affine = struct.unpack_from("<16d", data, at + 28)
        self.assertEqual(affine, (1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1))
        count, = struct.unpack_from("<Q", data, at + 28 + 128)
        nodes = struct.unpack_from(f"<{2 * count}Q", data, at + 28 + 136)
        wanted = [[w + 1, v + 1] for v, w in report["periodic"][0]["points"]]
        self.assertEqual([list(nodes[i:i + 2]) for i in range(0, 2 * count, 2)], wanted)
        self.pgdr("info", self.output, expect=0)

    def test_check_by_itself(self):
        """Of a mesh that was made without the flag."""
        model = self.file("cell.poly", cell(0, 0, (1, 1, 1, 1), [(0.9, 0.3, 0.07)]))
        self.mesh(model, expect=0)
        done = self.pgdr("check", self.output, *self.SIDES, expect=6)
        self.assertRegex(done.stdout, r"\nperiodic +FAILED: vertex \d+ of the side with marker \d .* that with marker \d, at ")
        self.assertIn("\nverdict    FAILED", done.stdout)
        self.mesh(model, *self.SIDES, expect=0)
        self.pgdr("check", self.output, *self.SIDES, expect=0)
        self.pgdr("check", self.output, "--periodic", "4=2:1,0,1,0,1,0.25", expect=6)

    def test_usage(self):
        model = self.file("cell.poly", cell(0, 0, (1, 1, 1, 1), []))
        for flag, words in [("4", "FROM=TO or FROM=TO:MOTION"), ("4=2:1,2", "FROM=TO or FROM=TO:MOTION"), ("=2", "FROM=TO"),
                            ("4=left", 'no marker is called "left"'), ("4=4", "are one side"), ("4=8", "no segment has the marker 8"),
                            ("4=3", "do not match within the tolerance"),
                            ("4=2:1,0,0,0,0,1,0,0,0,0,1,0", "takes a motion of 6 numbers in 2D"),
                            ("4=2:1,0,1,0,2,0", "must keep lengths")]:
            self.assertIn(words, self.mesh(model, "--periodic", flag, expect=2).stderr)


class PeriodicCells(Case):
    """3D: cells of crystals, whose faces, edges and corners cut spheres."""
    SIDES = "--periodic", "1=2", "--periodic", "3=4", "--periodic", "5=6"

    def meshed(self, model, *flags):
        done = self.mesh(model, *self.SIDES, *flags, "--report", self.report, expect=None)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        checked = self.pgdr("check", self.output, "--input", model, "--reasons", self.report, expect=done.returncode).stdout
        self.assertEqual(checked.count("\nperiodic "), 3)
        return self.json()

    def test_cells(self):
        """Of 30 by hand (0 to 29) none has a poor cell."""
        for seed in (0, 1, 2, 3, 7, 13):
            model = self.file("cell.poly", periodic_cells.drawn(seed).poly())
            report = self.meshed(model)
            self.assertEqual(report["bounds"]["poor_left"], 0)
            for pairs in report["periodic"]:
                self.assertLess(pairs["largest_gap"], 1e-15)
                self.assertGreater(pairs["walls"], 0)
            for region in report["regions"]:
                self.assertAlmostEqual(region["volume_meshed"], region["volume_given"], delta=1e-14)
            self.mesh(model, "--report", self.report, expect=None)
            self.assertLess(report["cells"], 1.5 * self.json()["cells"] + 100)

    def test_sizes(self):
        model = self.file("cell.poly", periodic_cells.drawn(2).poly())
        report = self.meshed(model, "--size", "0.03+0.1*x")
        self.assertTrue(report["bounds"]["size_met"])
        for p in report["periodic"]:  # what is asked for at x = 0 is so at x = 1
            self.assertGreater(len(p["points"]), 500)

    def test_threads(self):
        model = self.file("cell.poly", periodic_cells.drawn(1).poly())
        meshes = set()
        for threads in (1, 2, 8):
            self.meshed(model, "--size", 0.1, "--threads", threads)
            meshes.add(self.output.read_bytes())
        self.assertEqual(len(meshes), 1)

    def test_files(self):
        model = self.file("cell.poly", periodic_cells.drawn(0).poly())
        self.output = self.folder / "out.msh"
        report = self.meshed(model)
        data = self.output.read_bytes()
        at = data.index(b"$Periodic\n") + len(b"$Periodic\n")
        links, dimension, _, _, numbers = struct.unpack_from("<QiiiQ", data, at)
        self.assertEqual((links, dimension, numbers), (3, 2, 16))
        self.assertEqual(struct.unpack_from("<16d", data, at + 28), (1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1))
        count, = struct.unpack_from("<Q", data, at + 28 + 128)
        self.assertEqual(count, len(report["periodic"][0]["points"]))

    def test_read_back(self):
        """The files say which sides correspond: `check` verifies it from them alone, and `remesh` keeps it."""
        model = self.file("cell.poly", periodic_cells.drawn(0).poly())
        first = None
        for name in ("out.msh", "out.vtu"):
            self.output = self.folder / name
            pairs = [p["points"] for p in self.meshed(model)["periodic"]]
            self.assertEqual(first or pairs, pairs)
            first = pairs
            checked = self.pgdr("check", self.output, "--report", self.report, expect=0).stdout
            self.assertEqual(checked.count("\nperiodic "), 3)
            self.assertEqual([p["points"] for p in self.json()["periodic"]], pairs)
            old, self.output = self.output, self.folder / ("other" + name[3:])
            self.pgdr("remesh", old, "-o", self.output, "--size", 0.1, "--report", self.report, expect=0)
            finer = self.json()
            self.assertEqual(len(finer["periodic"]), 3)
            self.assertGreater(len(finer["periodic"][0]["points"]), 2 * len(pairs[0]))
            self.pgdr("check", self.output, "--input", old, "--reasons", self.report, expect=0)

    def test_another_surface(self):
        """Spheres get coarser, sides stay as they are: so they correspond as before."""
        chance = random.Random(3)
        model = self.file("cell.poly", periodic_cells.Cell(periodic_cells.spheres_of(chance, 4), times=4).poly())
        given, tolerance, meshes = self.meshed(model)["cells"], ("--surface-tolerance", "0.3%"), set()
        for threads in (1, 2, 8):
            self.mesh(model, *self.SIDES, *tolerance, "--threads", threads, "--report", self.report, expect=0)
            meshes.add(self.output.read_bytes())
        report = self.json()
        before, after = report["surface_tolerance"]["triangles"]
        self.assertLess(2 * after, before)
        self.assertLess(report["cells"], given)
        self.assertEqual(len(meshes), 1)
        checked = self.pgdr("check", self.output, "--input", model, "--reasons", self.report, *tolerance, expect=0).stdout
        self.assertEqual(checked.count("\nperiodic "), 3)
        old, self.output = self.output, self.folder / "again.vtu"
        done = self.pgdr("remesh", old, "-o", self.output, "--surface-tolerance", "0.2%", "--report", self.report, expect=None)
        self.assertIn(done.returncode, (0, 1))
        self.assertEqual(len(self.json()["periodic"]), 3)
        self.pgdr("check", self.output, "--input", old, "--reasons", self.report, "--surface-tolerance", "0.2%", expect=done.returncode)

    def test_false_files(self):
        """A pair that is another in the file than in the mesh."""
        model = self.file("cell.poly", periodic_cells.drawn(0).poly())
        self.output = self.folder / "out.msh"
        self.meshed(model)
        data = bytearray(self.output.read_bytes())
        at = data.index(b"$Periodic\n") + len(b"$Periodic\n") + 28 + 128 + 8
        data[at:at + 8], data[at + 16:at + 24] = data[at + 16:at + 24], data[at:at + 8]
        self.output.write_bytes(data)
        self.assertIn("the file pairs other vertices", self.pgdr("check", self.output, expect=6).stdout)
        self.assertIn("the file pairs other vertices", self.pgdr("remesh", self.output, "-o", self.folder / "b.msh", expect=2).stderr)
        self.output = self.folder / "out.vtu"
        self.meshed(model)
        data = bytearray(self.output.read_bytes())
        offset = int(re.search(rb'Name="periodic_of"[^>]* offset="(\d+)"', data).group(1))
        begin = data.index(b"_", data.index(b"<AppendedData")) + 1 + offset
        count, = struct.unpack_from("<Q", data, begin)
        of = list(struct.unpack_from(f"<{count // 8}q", data, begin + 8))
        image = next(v for v, first in enumerate(of) if first < v)
        struct.pack_into("<q", data, begin + 8 + 8 * image, image)
        self.output.write_bytes(data)
        self.assertIn("the file says that vertex", self.pgdr("check", self.output, expect=6).stdout)

    def test_check_by_itself(self):
        model = self.file("cell.poly", periodic_cells.drawn(1).poly())
        self.mesh(model, expect=0)
        self.assertIn("FAILED", self.pgdr("check", self.output, *self.SIDES, expect=6).stdout)
        self.assertIn("--periodic takes a motion of 12 numbers in 3D",
                      self.mesh(model, "--periodic", "1=2:1,0,1,0,1,0", expect=2).stderr)

    def test_limits(self):
        """A mesh that a limit has ended has no pairs, and what is ahead is said of the facets as given."""
        model = self.file("cell.poly", periodic_cells.drawn(2).poly())
        facets = int(model.read_text().split("\n")[109].split()[0])
        done = self.mesh(model, *self.SIDES, "--size", 0.1, "--max-vertices", 600, "--report", self.report, expect=5)
        for number in re.findall(r"facets? (\d+)", done.stdout):
            self.assertLess(int(number), facets)
        self.assertEqual(self.json()["periodic"], [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
