#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Openings that --close-planar-openings closes, what a refused file needs, and what is wrong with it as geometry.

PGDR_COMMAND names the command, PGDR_SANITIZE its sanitizers, if any. Usage: test_openings.py [Class[.test]...]
"""
import math
import random
import shutil
import signal
import subprocess
import time
import unittest
import xml.etree.ElementTree

from test_command import COMMAND, Case
from test_cures import turned
from test_estimates import poly


def box(x, y, z, first=0):
    """Its sides look outwards."""
    points = [(x * (i & 1), y * (i >> 1 & 1), z * (i >> 2)) for i in range(8)]
    faces = ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6))
    return points, [tuple(first + v for v in f) for f in faces]


def pipe(n, radius, low, high, outwards=True, first=0):
    """A wall of n quadrilaterals about the z axis."""
    points = [(radius * math.cos(2 * math.pi * k / n), radius * math.sin(2 * math.pi * k / n), z) for k in range(n) for z in (low, high)]
    faces = [(2 * k, 2 * ((k + 1) % n), 2 * ((k + 1) % n) + 1, 2 * k + 1) for k in range(n)]
    return points, [tuple(first + v for v in (f if outwards else f[::-1])) for f in faces]


def area(n, radius):
    return n * radius * radius * math.sin(2 * math.pi / n) / 2


def wall(n=24, m=16):
    """Of a pipe: two surfaces, open at both ends."""
    points, faces = pipe(n, 2.0, 0.0, 3.0)
    inner, more = pipe(m, 1.0, 0.0, 3.0, False, len(points))
    return points + inner, faces + more, 3 * (area(n, 2) - area(m, 1))


class Openings(Case):
    def test_a_pipe(self):
        points, faces, volume = wall()
        for copy in (points, turned(points, 1), turned(points, 2)):
            model = self.file("pipe.poly", poly(copy, faces))
            said = self.mesh(model, expect=3).stderr
            self.assertIn("needs: open, with 2 openings that lie in planes: --close-planar-openings\n", said)
            done = self.mesh(model, "--close-planar-openings", "--report", self.report)
            self.assertIn("2 openings are closed by facets that the input does not have", done.stderr + done.stdout)
            made = self.json()
            self.assertTrue(made["close_planar_openings"])
            closed = [r for r in made["repairs"] if r["code"] == "open_boundary"]
            self.assertEqual([len(r["ids"]) for r in closed], [40, 40])
            self.assertIn("open_boundary", [w["code"] for w in made["warnings"]])
            self.assertEqual(made["marker_names"], {"1": "closed_opening_1", "2": "closed_opening_2"})
            self.assertAlmostEqual(made["regions"][0]["volume_meshed"], volume, delta=1e-9)
            self.assertAlmostEqual(made["regions"][0]["volume_given"], volume, delta=1e-9)
            self.pgdr("check", self.output, "--input", model, "--radius-edge", 2, "--reasons", self.report, expect=0)
            self.pgdr("check", self.output, "--input", model, "--radius-edge", 2, "--close-planar-openings", expect=0)
            self.pgdr("check", self.output, "--input", model, "--radius-edge", 2, expect=6)  # as it was given it encloses nothing
            said = self.pgdr("info", model, "--close-planar-openings", expect=0).stdout
            self.assertIn("closed_opening_2 (2)", said)

    def test_names_in_files(self):
        points, faces, _ = wall()
        model = self.file("pipe.poly", poly(points, faces))
        self.pgdr("mesh", model, "--close-planar-openings", "-o", self.folder / "pipe.msh", expect=0)
        text = (self.folder / "pipe.msh").read_bytes().decode(errors="replace")
        self.assertIn('2 1 "closed_opening_1"', text)
        self.assertIn('2 2 "closed_opening_2"', text)

    def test_what_is_closed_is_as_it_was(self):
        points, faces = box(1.0, 2.0, 3.0)
        model = self.file("box.poly", poly(points, faces))
        self.mesh(model)
        before = self.output.read_bytes()
        self.mesh(model, "--close-planar-openings")
        self.assertEqual(self.output.read_bytes(), before)

    def test_other_openings_stay(self):
        points, faces = box(1.0, 1.0, 1.0)
        model = self.file("corner.poly", poly(points, [faces[0], faces[2], faces[4]]))
        said = self.mesh(model, "--close-planar-openings", "--report", self.report, expect=3).stderr
        self.assertIn("enclose nothing", said)
        self.assertNotIn("needs", said)
        self.assertEqual(self.json()["diagnosis"]["open_boundaries"]["count"], 1)
        self.pgdr("mesh", self.file("flat.poly", "3 2\n1 0 0\n2 1 0\n3 0 1\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n"), "-o", self.output,
                  "--close-planar-openings", expect=2)

    def test_pipes_that_cross(self):
        points, faces = pipe(12, 1.0, -2.0, 2.0)
        other, more = pipe(12, 0.5, -2.1, 2.1, first=len(points))
        model = self.file("cross.poly", poly(points + [(z, x, y) for x, y, z in other], faces + more))
        said = self.mesh(model, expect=3).stderr
        self.assertIn("needs: 34 pairs of facets cross: --resolve-crossings\n", said)  # what is in both of them is enclosed then
        self.assertIn("--close-planar-openings with --resolve-crossings makes it valid", said)
        flags = ["--close-planar-openings", "--resolve-crossings"]
        self.mesh(model, *flags, "--regions", "union", "--report", self.report, expect=0)
        self.assertEqual(len([r for r in self.json()["repairs"] if r["code"] == "open_boundary"]), 4)
        self.assertEqual(len(self.json()["regions"]), 1)
        self.pgdr("check", self.output, "--input", model, "--reasons", self.report, expect=0)


class Needs(Case):
    def needs(self, model, *flags):
        """The line, which `info`, `mesh` and both reports have."""
        said = self.mesh(model, *flags, "--report", self.report, expect=3).stderr
        line = next((line[13:] for line in said.splitlines() if line.startswith("pgdr: needs: ")), None)
        first = self.json().get("needs", [None])[0]
        if first and first["flags"]:
            self.assertEqual(line, first["ailment"] + ": " + first["flags"])
        shown = self.pgdr("info", model, *flags, "--report", self.report, expect=3).stdout
        rows = [row.split(None, 1)[1] for row in shown.splitlines() if row.startswith("needs")]
        self.assertEqual(rows, [line] if line else [])
        self.assertEqual(self.json().get("needs", [None])[0], first)
        return line

    def cured(self, model, line, *flags):
        done = self.mesh(model, *flags, *line[line.rindex(": ") + 2:].split(), expect=None)
        self.assertIn(done.returncode, (0, 1), done.stderr)

    def test_bodies_that_overlap(self):
        points, faces = [], []
        for k in range(5):
            p, f = box(1.0, 1.1, 1.2, 8 * k)
            points += [(x + 0.7 * k, y + 0.31 * k, z + 0.23 * k) for x, y, z in p]
            faces += f
        model = self.file("bodies.poly", poly(points, faces))
        line = self.needs(model)
        self.assertEqual(line, "5 closed bodies that overlap: --resolve-crossings --regions union")
        self.cured(model, line)
        for mode in ("union", "fragments", "priority"):  # where bodies are told, facets that cross are refused like anywhere
            line = self.needs(model, "--regions", mode)
            self.assertRegex(line, r"^\d+ pairs of facets cross: --resolve-crossings$")
            self.cured(model, line, "--regions", mode)
        line = self.needs(model, "--regions", "disjoint", "--resolve-crossings")
        self.assertEqual(line, "bodies that overlap: --regions fragments")

    def test_edges_that_touch(self):
        points = [(-1, 0, 0), (1, 0, 0), (0, -1, -1), (0, 1, -1), (0, -1, 0), (0, 1, 0), (-1, 0, 1), (1, 0, 1)]
        faces = [(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2), (4, 5, 6), (4, 7, 5), (4, 6, 7), (5, 7, 6)]
        model = self.file("touch.poly", poly(points, faces))
        line = self.needs(model)
        self.assertEqual(line, "edges touch at a point: --resolve-crossings")
        self.cured(model, line)

    def test_seams(self):
        points, faces = box(1.0, 1.0, 1.0)
        apart = [(x, y, z + 1.2e-5 * (z > 0)) for x, y, z in points]
        seamed = points + apart  # the lid has points of its own
        lid = [f for f in faces if all(points[v][2] == 1 for v in f)]
        rest = [f for f in faces if f not in lid]
        model = self.file("seam.poly", poly(seamed, rest + [tuple(v + 8 for v in f) for f in lid]))
        line = self.needs(model)
        self.assertRegex(line, r"^not welded, gaps up to 1.2e-05: --tolerance \S+$")
        self.cured(model, line)

    def test_nothing_helps(self):
        points, faces = box(1.0, 1.0, 1.0)
        corner = [faces[0], faces[2], faces[4]]
        self.assertIsNone(self.needs(self.file("open.poly", poly(points, corner))))

    def soup(self, triangles):
        r = random.Random(1)
        points = [tuple(r.random() for _ in range(3)) for _ in range(3 * triangles)]
        return self.file("soup.poly", poly(points, [(3 * k, 3 * k + 1, 3 * k + 2) for k in range(triangles)]))

    def test_a_signal_ends_the_search(self):
        with subprocess.Popen([COMMAND, "mesh", str(self.soup(600)), "-o", str(self.output)], stderr=subprocess.PIPE,
                              stdout=subprocess.DEVNULL, text=True) as run:
            self.assertIn("error", run.stderr.readline())  # cures are looked for from here on
            begin = time.monotonic()
            run.send_signal(signal.SIGINT)
            run.stderr.read()
            self.assertEqual(run.wait(), 3)
            self.assertLess(time.monotonic() - begin, 15)

    def test_a_time_limit_ends_the_search(self):
        begin = time.monotonic()
        done = self.mesh(self.soup(400), "--time-limit", "3", expect=None)
        self.assertIn(done.returncode, (3, 5))  # 5: it was over before anything was refused
        self.assertLess(time.monotonic() - begin, 20)


class Problems(Case):
    """What is written is read again: by Python's parser, and by gmsh where it is there."""

    def vtp(self, model, expect=3):
        file = self.folder / "problems.vtp"
        self.pgdr("info", model, "--write-problems", file, expect=expect)
        root = xml.etree.ElementTree.parse(file).getroot()
        self.assertEqual(root.get("type"), "PolyData")
        piece = root.find("PolyData/Piece")
        words = "".join(chr(int(n)) for n in root.find("PolyData/FieldData/Array").text.split()).split("\0")

        def numbers(element, name, kind):
            return [kind(w) for w in next(a for a in element if a.get("Name") == name).text.split()]

        flat = numbers(piece.find("Points"), "Points", float)
        points = list(zip(flat[::3], flat[1::3], flat[2::3]))
        self.assertEqual(len(points), int(piece.get("NumberOfPoints")))
        data = piece.find("CellData")
        columns = {name: numbers(data, name, float if name == "measure" else int)
                   for name in ("finding", "role", "id", "other_id", "measure")}
        cells = []
        for part, count in (("Verts", "NumberOfVerts"), ("Lines", "NumberOfLines"), ("Polys", "NumberOfPolys")):
            corners, ends = (numbers(piece.find(part), name, int) for name in ("connectivity", "offsets"))
            self.assertEqual(len(ends), int(piece.get(count)))
            for begin, end in zip([0, *ends], ends):
                i = len(cells)
                cells.append((part, words[columns["finding"][i]], ("culprit", "where")[columns["role"][i]], columns["id"][i],
                              columns["other_id"][i], columns["measure"][i], [points[v] for v in corners[begin:end]]))
        for column in columns.values():
            self.assertEqual(len(column), len(cells))
        return cells

    def boxes(self):
        points, faces = box(4.0, 4.0, 4.0)
        others, more = box(4.0, 2.0, 2.0, first=8)
        return self.file("boxes.poly", poly(points + [(x + 2, y + 1, z + 1) for x, y, z in others], faces + more))

    def test_facets_that_cross(self):
        cells = [c for c in self.vtp(self.boxes()) if c[1] == "facets_cross"]
        culprits = [c for c in cells if c[2] == "culprit"]
        places = [c for c in cells if c[2] == "where"]
        self.assertEqual({c[0] for c in culprits}, {"Polys"})
        self.assertEqual(len(culprits), 5)  # four sides of the one go through a side of the other
        self.assertEqual(len({c[3] for c in culprits}), 5)
        self.assertEqual(len(places), 4)
        for part, _, _, a, b, _, points in places:
            self.assertEqual(part, "Lines")
            self.assertTrue({a, b} <= {c[3] for c in culprits})
            self.assertEqual([p[0] for p in points], [4, 4])
            self.assertAlmostEqual(math.dist(*points), 2)

    def test_loops_and_gaps(self):
        points, faces, _ = wall()
        loops = [c for c in self.vtp(self.file("pipe.poly", poly(points, faces))) if c[1] == "open_boundaries"]
        self.assertEqual([len(c[6]) for c in loops], [25, 25, 17, 17])
        for loop in loops:
            self.assertEqual(loop[6][0], loop[6][-1])
            self.assertAlmostEqual(sum(map(math.dist, loop[6], loop[6][1:])), loop[5])
        points, faces = box(1.0, 1.0, 1.0)
        lid = [f for f in faces if all(points[v][2] == 1 for v in f)]
        rest = [f for f in faces if f not in lid]
        seamed = points + [(x, y, z + 1e-7 * (z > 0)) for x, y, z in points]
        gaps = [c for c in self.vtp(self.file("seam.poly", poly(seamed, rest + [tuple(v + 8 for v in f) for f in lid])))
                if c[1] == "near_points"]
        self.assertEqual([(c[0], len(c[6])) for c in gaps], [("Lines", 2)] * 4)
        for gap in gaps:
            self.assertAlmostEqual(gap[5], 1e-7, delta=1e-12)

    def test_a_needle_that_is_a_line(self):
        points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (2, 2, 2), (2, 2, 3)]
        text = poly(points, [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3), (4, 5, 4, 5)])
        cells = self.vtp(self.file("flat.poly", text), expect=None)
        self.assertTrue(all(c[0] in ("Verts", "Lines", "Polys") for c in cells))

    def test_of_an_input_that_is_taken(self):
        points, faces = box(1.0, 1.0, 1.0)
        self.assertEqual([c for c in self.vtp(self.file("box.poly", poly(points, faces)), expect=0)], [])

    def test_other_formats(self):
        model = self.boxes()
        for name in ("p.vtk", "p.vtu", "p.obj"):
            self.pgdr("info", model, "--write-problems", self.folder / name, expect=3)
        text = (self.folder / "p.obj").read_text().splitlines()
        self.assertIn("g facets_cross", text)
        self.assertEqual(sum(line.startswith("f ") for line in text), 5)
        grid = xml.etree.ElementTree.parse(self.folder / "p.vtu").getroot()
        types = next(a for a in grid.find("UnstructuredGrid/Piece/Cells") if a.get("Name") == "types").text.split()
        self.assertEqual(sorted(types), ["4"] * 4 + ["7"] * 5)
        self.pgdr("info", model, "--write-problems", self.folder / "p.stl", expect=2)
        self.pgdr("info", model, "--write-problems", model, expect=2)

    @unittest.skipUnless(shutil.which("gmsh"), "gmsh is not here")
    def test_gmsh_reads_it(self):
        file = self.folder / "p.vtk"
        self.pgdr("info", self.boxes(), "--write-problems", file, expect=3)
        done = subprocess.run(["gmsh", str(file), "-", "-save", "-o", str(self.folder / "p.msh")], capture_output=True, text=True,
                              timeout=100)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertNotIn("Error", done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
