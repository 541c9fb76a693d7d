#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Maps on the command line: GeoJSON, sizes at points and along lines, rasters of sizes, conforming Delaunay meshes, legacy .vtk.
PGDR_COMMAND names the command. Usage: test_geodata.py [Class[.test]...]"""
import itertools
import json
import math
import random
import struct
import subprocess
import unittest
from fractions import Fraction

from test_command import BRACKET, COMMAND, PLATE, Case

LAND = [[[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]], [[1, 1], [2, 1], [2, 2], [1, 2], [1, 1]]]
BAY = [[[4, 0], [6, 0], [6, 3], [4, 4], [4, 0]]]
ISLE = [[[1, 1], [2, 1], [2, 2], [1, 2]]]


def feature(kind, coordinates, **properties):
    return {"type": "Feature", "properties": properties, "geometry": {"type": kind, "coordinates": coordinates}}


def collection(*features):
    return json.dumps({"type": "FeatureCollection", "name": "x", "features": list(features)}, indent=1)


class Mesh:
    """What a .mesh file has."""

    def __init__(self, path):
        words = path.read_text().split("\n")
        self.points, self.triangles, self.edges = [], [], []
        lists = {"Vertices": self.points, "Triangles": self.triangles, "Edges": self.edges}
        for i, line in enumerate(words):
            if line in lists:
                lists[line] += [list(map(float, row.split())) for row in words[i + 2:i + 2 + int(words[i + 1])]]

    def corners(self, triangle):
        return [self.points[int(v) - 1][:2] for v in triangle[:3]]

    def areas(self):
        """By label."""
        made = {}
        for t in self.triangles:
            (ax, ay), (bx, by), (cx, cy) = self.corners(t)
            made[t[3]] = made.get(t[3], 0) + ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2
        return made

    def lengths(self, inside):
        """Of edges whose middle is inside."""
        return [math.dist(p, q) for t in self.triangles for p, q in itertools.combinations(self.corners(t), 2)
                if inside((p[0] + q[0]) / 2, (p[1] + q[1]) / 2)]


class GeoJson(Case):
    def meshed(self, text, *flags, **keywords):
        path = self.file("map.geojson", text)
        self.output = self.folder / "out.mesh"
        self.mesh(path, *flags, "--report", self.report, **keywords)
        self.pgdr("check", self.output, "--input", path, "--reasons", self.report, *(f for f in flags if f == "--resolve-crossings"),
                  expect=0)
        return Mesh(self.output), self.json()

    def assert_areas(self, mesh, expected):
        found = mesh.areas()
        self.assertEqual(set(found), set(expected))
        for label, area in expected.items():
            self.assertAlmostEqual(found[label], area, places=9)

    def test_features_of_all_kinds(self):
        mesh, report = self.meshed(collection(
            feature("Polygon", LAND, name="land", size=0.5), feature("MultiPolygon", [BAY, ISLE], name="bay", label=7, marker=-3),
            feature("LineString", [[0, 4], [3, 3], [4, 0]], name="river"), feature("Point", [3.5, 3.5, 8]),
            {"type": "Feature", "properties": None, "geometry": None}), "--min-angle", "10")
        self.assert_areas(mesh, {1: 15, 7: 8})
        self.assertEqual(report["region_names"], {"1": "land", "7": "bay"})
        self.assertEqual(report["marker_names"], {"3": "river"})
        self.assertIn([3.5, 3.5], [p[:2] for p in mesh.points])
        self.assertEqual({e[2] for e in mesh.edges}, {1, -3, 3})

    def test_holes_overlaps_and_gaps(self):
        box = lambda x, y, w, h: [[[x, y], [x + w, y], [x + w, y + h], [x, y + h]]]
        frame = [feature("Polygon", box(*b)) for b in ((0, 0, 3, 1), (0, 2, 3, 1), (0, 1, 1, 1), (2, 1, 1, 1))]
        self.assert_areas(self.meshed(collection(*frame))[0], {1: 3, 2: 3, 3: 1, 4: 1})
        self.assert_areas(self.meshed(collection(feature("Polygon", LAND)))[0], {1: 15})
        island = collection(feature("Polygon", LAND), feature("Polygon", box(1.25, 1.25, 0.5, 0.5)))
        self.assert_areas(self.meshed(island)[0], {1: 15, 2: 0.25})
        self.assert_areas(self.meshed(json.dumps({"type": "Polygon", "coordinates": LAND}))[0], {1: 15})
        lines = {"type": "GeometryCollection", "geometries": [{"type": "MultiLineString", "coordinates": box(0, 0, 2, 1) + [[[0, 1], [0, 0]]]}]}
        lines["geometries"][0]["coordinates"][0].append([0, 0])
        self.assert_areas(self.meshed(json.dumps(lines))[0], {0: 2})

    def test_borders_that_meet_where_one_has_no_corner(self):
        """As neighbours in maps do: and lines that end on a border, or cross it."""
        left, right = [[[0, 0], [2, 0], [2, 3], [0, 3]]], [[[2, 0], [4, 0], [4, 3], [2, 3], [2, 2], [2, 1]]]
        tall = [[[0, 3], [1, 3], [4, 3], [4, 5], [0, 5]]]
        lines = feature("MultiLineString", [[[0, 1], [2, 2.5]], [[1, 4], [5, 4]], [[3, -1], [3, 4.5]]])
        text = collection(feature("Polygon", left), feature("Polygon", right), feature("Polygon", tall), lines)
        self.assert_areas(self.meshed(text, "--resolve-crossings", "--min-angle", "10")[0], {1: 6, 2: 6, 3: 8})

    def test_far_from_the_origin(self):
        far = [[[x + 512345.67, y + 5812345.67] for x, y in ring] for ring in LAND]
        mesh, _ = self.meshed(collection(feature("Polygon", far)))
        self.assertAlmostEqual(mesh.areas()[1], 15, places=6)

    def test_random_maps(self):
        """Boxes of a grid by random labels; each label's area is that of its boxes."""
        for seed in range(5):
            random.seed(seed)
            n, features, expected = 6, [], {}
            for i, j in itertools.product(range(n), repeat=2):
                label = random.randint(0, 3)
                if label:
                    ring = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]]
                    features.append(feature("Polygon", [ring[::random.choice((1, -1))]], label=label))
                    expected[label] = expected.get(label, 0) + 1
            with self.subTest(seed):
                self.assert_areas(self.meshed(collection(*features))[0], expected)

    def test_refusals_name_the_line(self):
        good = '{"type": "Polygon",\n"coordinates": [[[0, 0], [1, 0],\n[1, 1]]]}'
        for text, line, word in ((good.replace("[1, 1]", "[1, x]"), 3, "x"), (good.replace("[1, 1]", "[1, 1e999]"), 3, "finite"),
                                 (good[:-3], None, "ends"), (good.replace("Polygon", "Polygone"), None, "Polygone"),
                                 (good.replace("[1, 1]", "[1]"), 3, "two coordinates"), (good.replace(",\n[1, 1]", ""), None, "three"),
                                 (good + "1", 3, "behind"), ('{"type": "Point", "coordinates": [0, 0]}', 1, "no polygons"),
                                 ("[" * 200, 1, "object"), ('{"a": ' + "[" * 200, 1, "deep"), ("", 1, "ends"),
                                 (good.replace('"type"', '"kind"'), None, "type"), ('{"type": "Feature"}', 1, "geometry"),
                                 (good.replace("Polygon", "Poly\\qgon"), 1, "escape")):
            with self.subTest(text[:60]):
                path = self.file("bad.geojson", text)
                done = self.mesh(path, "--report", self.report, expect=3)
                error = self.json()["errors"][0]
                self.assertIn(word, error["message"])
                if line is not None:
                    self.assertEqual(error["line"], line, done.stderr)


class SizesAt(Case):
    def test_points_and_lines(self):
        sizes = self.file("sizes.txt", "# x y area\n0.5 0.5 0.0001\n0 0 1 0 0.0004\n")
        square = self.file("square.poly", "4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n")
        self.output = self.folder / "out.mesh"
        for growth in ([], ["--size-growth", "0.5"]):
            self.mesh(square, "--min-angle", "25", "--size-at", sizes, *growth)
            self.pgdr("check", self.output, "--input", square, "--size-at", sizes, *growth, expect=0)
            mesh, slope = Mesh(self.output), float(growth[1]) if growth else 0.2
            for t in mesh.triangles:
                (ax, ay), (bx, by), (cx, cy) = mesh.corners(t)
                x, y = (ax + bx + cx) / 3, (ay + by + cy) / 3
                wanted = min(0.01 + slope * math.dist((x, y), (0.5, 0.5)), 0.02 + slope * y) ** 2
                self.assertLessEqual(((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2, wanted * (1 + 1e-9))
        for text in ("1 2\n", "1 2 0\n", "", "1 2 3 4\n", "a b c\n"):
            self.mesh(square, "--size-at", self.file("sizes.txt", text), expect=3)
        self.mesh(square, "--size-at", self.folder / "none.txt", expect=4)

    def test_in_space(self):
        sizes = self.file("sizes.txt", "0 0 0 0.3\n0 0 0 1 0 0 0.3\n")
        self.mesh(BRACKET, "--size-at", sizes, "--max-vertices", "2000", expect=None)
        self.mesh(BRACKET, "--size-at", self.file("sizes.txt", "0 0 0.3\n"), expect=3)

    def test_a_raster(self):
        head = "ncols 3\nnrows 2\nxllcorner -0.5\nyllcorner -0.5\ncellsize 1\nNODATA_value -1\n"
        raster = self.file("sizes.asc", head + "0.01 0.01 -1\n0.01 0.0001 0.0001\n")
        square = self.file("square.poly", "4 2 0 0\n1 0 0\n2 2 0\n3 2 1\n4 0 1\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n")
        self.output = self.folder / "out.mesh"
        self.mesh(square, "--min-angle", "25", "--size-mesh", raster)
        self.pgdr("check", self.output, "--input", square, "--size-mesh", raster, expect=0)
        mesh = Mesh(self.output)
        near = mesh.lengths(lambda x, y: x > 1 and y < 0.2)
        far = mesh.lengths(lambda x, y: x < 0.3 and y > 0.5)
        self.assertLess(max(near), min(far))
        for bad in ("0.01 0.01 -1\n0.01 0\n", "0.01 0.01 -1\n0.01 0 1\n", "0.01 0.01 -1\n0.01 1 1 1\n", "-1 -1 -1\n-1 -1 1\n", ""):
            self.mesh(square, "--size-mesh", self.file("sizes.asc", head + bad), expect=3)
        self.mesh(square, "--size-mesh", self.file("sizes.asc", head.replace("cellsize 1\n", "") + "1 1 1\n1 1 1\n"), expect=3)
        self.mesh(square, "--size-mesh", self.file("sizes.asc", "ncols 4000000000\nnrows 4000000000\ncellsize 1\n1 1\n"), expect=3)


def in_circle(a, b, c, d):
    """Exactly: is d inside the circumcircle of the counterclockwise triangle abc?"""
    rows = [[Fraction(p[0]) - Fraction(d[0]), Fraction(p[1]) - Fraction(d[1])] for p in (a, b, c)]
    (ax, ay), (bx, by), (cx, cy) = rows
    sa, sb, sc = (x * x + y * y for x, y in rows)
    return ax * (by * sc - sb * cy) - ay * (bx * sc - sb * cx) + sa * (bx * cy - by * cx) > 0


class Conforming(Case):
    def meshed(self, text, *flags):
        self.output = self.folder / "out.mesh"
        made = []
        for threads in ("1", "4"):
            self.mesh(self.file("a.poly", text), "--conforming-delaunay", "--threads", threads, *flags, expect=None)
            made.append(self.output.read_bytes())
        self.assertEqual(made[0], made[1])
        self.pgdr("check", self.output, "--input", self.folder / "a.poly", "--conforming-delaunay", expect=0)
        return Mesh(self.output)

    def assert_delaunay(self, mesh):
        """No vertex across an edge is inside a circumcircle, and no boundary edge has one in its diametral circle; on a slanted
        segment, vertices are rounded, which one ulp of the cosine allows."""
        across = {}
        for t in mesh.triangles:
            v = [int(x) - 1 for x in t[:3]]
            for i in range(3):
                across.setdefault(frozenset((v[i - 1], v[i - 2])), []).append((v, i))
        at = [p[:2] for p in mesh.points]
        for edge, sides in across.items():
            for v, i in sides:
                (ox, oy), (ax, ay), (bx, by) = at[v[i]], at[v[i - 2]], at[v[i - 1]]
                dot = (ax - ox) * (bx - ox) + (ay - oy) * (by - oy)
                if len(sides) == 1:
                    self.assertGreaterEqual(dot, -1e-12 * math.dist((ax, ay), (ox, oy)) * math.dist((bx, by), (ox, oy)), edge)
            if len(sides) == 2:
                (v, i), (w, j) = sides
                if in_circle(*(at[x] for x in v), at[w[j]]):
                    angle = sum(math.acos(max(-1, min(1, self.cosine(at, u, k)))) for u, k in sides)
                    self.assertLess(angle, math.pi + 1e-9, edge)

    @staticmethod
    def cosine(at, v, i):
        o, a, b = at[v[i]], at[v[i - 2]], at[v[i - 1]]
        return ((a[0] - o[0]) * (b[0] - o[0]) + (a[1] - o[1]) * (b[1] - o[1])) / math.dist(a, o) / math.dist(b, o)

    @staticmethod
    def poly(points, segments):
        return (f"{len(points)} 2 0 0\n" + "".join(f"{i} {x!r} {y!r}\n" for i, (x, y) in enumerate(points, 1)) + f"{len(segments)} 0\n"
                + "".join(f"{i} {a} {b}\n" for i, (a, b) in enumerate(segments, 1)) + "0\n")

    def test_narrow_strips(self):
        """A line along a wall: without the flag its triangles are constrained Delaunay alone."""
        points = [(0, 0), (10, 0), (10, 1), (0, 1), (3.0, 0.05), (9.0, 0.05), (5.0, 0.9)]
        text = self.poly(points, [(1, 2), (2, 3), (3, 4), (4, 1), (5, 6)])
        for flags in (["--radius-edge", "1e300"], ["--min-angle", "25"], ["--min-angle", "25", "--size", "0.01"]):
            with self.subTest(flags):
                self.assert_delaunay(self.meshed(text, *flags))
        self.output = self.folder / "out.mesh"
        self.mesh(self.folder / "a.poly", "--radius-edge", "1e300")
        with self.assertRaises(AssertionError):
            self.assert_delaunay(Mesh(self.output))
        self.pgdr("check", self.output, "--input", self.folder / "a.poly", expect=0)
        self.pgdr("check", self.output, "--conforming-delaunay", "--report", self.report, expect=6)
        kinds = {finding["kind"] for finding in self.json()["findings"]}
        self.assertEqual(kinds, {"not_delaunay"})

    def test_the_report_says_so(self):
        """A report of --conforming-delaunay asks for it, of another mesh, too; not of a run that did not end. 3D has none."""
        text = self.poly([(0, 0), (10, 0), (10, 1), (0, 1), (5.0, 0.1)], [(1, 2), (2, 3), (3, 4), (4, 1)])
        self.output = self.folder / "out.mesh"
        self.mesh(self.file("a.poly", text), "--radius-edge", "1e300", "--conforming-delaunay", "--report", self.report)
        self.assertIs(self.json()["conforming_delaunay"], True)
        self.pgdr("check", self.output, "--input", self.folder / "a.poly", "--reasons", self.report, expect=0)
        plain = self.folder / "plain.mesh"
        self.pgdr("mesh", self.folder / "a.poly", "--radius-edge", "1e300", "-o", plain)
        self.pgdr("check", plain, "--input", self.folder / "a.poly", "--reasons", self.report, expect=6)
        cube = self.folder / "cube.mesh"
        self.pgdr("mesh", BRACKET, "-o", cube)
        self.pgdr("check", cube, "--conforming-delaunay", expect=2)

    def test_cells_that_are_not_delaunay(self):
        """A list in words and in the report; the optimiser leaves some, and the refinement none."""
        for flags, is_any in (((), True), (("--no-optimize",), False)):
            mesh = self.folder / "bracket.mesh"
            self.pgdr("mesh", BRACKET, "--radius-edge", "2", "-o", mesh, *flags)
            said = self.pgdr("check", mesh, "--list-not-delaunay", "--report", self.report, expect=0).stdout
            listed = self.json()["not_delaunay_cells"]
            self.assertEqual(listed["count"], len(listed["cells"]))
            self.assertEqual(len({cell for cell, _ in listed["cells"]}), listed["count"])
            self.assertEqual(listed["count"] > 0, is_any)
            self.assertIn("inside its circumsphere" if is_any else "all cells are", said)

    def test_small_angles(self):
        for degrees in (50.0, 30.0, 10.0, 3.0, 0.5):
            a = math.radians(degrees)
            points = [(0, 0), (7, 0), (5 * math.cos(a), 5 * math.sin(a)), (-6, -4), (9, -4), (8, 6), (-6, 6)]
            text = self.poly(points, [(1, 2), (1, 3), (4, 5), (5, 6), (6, 7), (7, 4)])
            for flags in (["--radius-edge", "1e300"], ["--min-angle", "20"]):
                with self.subTest(degrees=degrees, flags=flags):
                    mesh = self.meshed(text, *flags)
                    self.assert_delaunay(mesh)
                    self.assertLess(len(mesh.triangles), 3000)

    def test_random_inputs(self):
        for seed in range(12):
            random.seed(seed)
            n = 8
            points = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
            segments = [(1, 2), (2, 3), (3, 4), (4, 1)]
            for _ in range(n):  # slanted segments that may cross, and points
                p = [(random.random(), random.random()) for _ in range(2)]
                segments.append((len(points) + 1, len(points) + 2))
                points += p
            points += [(random.random(), random.random()) for _ in range(20)]
            with self.subTest(seed):
                self.assert_delaunay(self.meshed(self.poly(points, segments), "--radius-edge", "1e300", "--resolve-crossings"))

    def test_refusals(self):
        self.mesh(PLATE, "--conforming-delaunay", "--keep-boundary", expect=2)
        self.mesh(PLATE, "--conforming-delaunay", "--no-refine", expect=2)
        self.mesh(BRACKET, "--conforming-delaunay", expect=2)


class LegacyVtk(Case):
    def test_cells_and_data(self):
        for model, kinds in ((PLATE, {5, 3}), (BRACKET, {10, 5, 3})):
            self.output = self.folder / "out.vtk"
            self.mesh(model)
            words = self.output.read_text().split()
            count = int(words[words.index("CELL_TYPES") + 1])
            types = list(map(int, words[words.index("CELL_TYPES") + 2:][:count]))
            self.assertEqual(set(types), kinds)
            begin, at = words.index("CELLS"), 0
            self.assertEqual(int(words[begin + 1]), count)
            cells = list(map(int, words[begin + 3:begin + 3 + int(words[begin + 2])]))
            for kind in types:
                self.assertEqual(cells[at], {3: 2, 5: 3, 10: 4}[kind])
                at += cells[at] + 1
            self.assertEqual(at, len(cells))
            self.assertLess(max(cells), int(words[words.index("POINTS") + 1]))
            for name in ("region", "marker"):
                place = words.index(name)
                self.assertEqual(words[place - 1], "SCALARS")
                float(words[place + 5 + count - 1])
            self.pgdr("check", self.output, "--input", model, expect=0)

    def binary(self, text):
        """The same file with numbers as bytes, big-endian; and with offsets, as version 5.1 has them."""
        codes = {"double": "d", "int": "i"}
        old, new = b"", b""
        lines = iter(text.split("\n")[:-1])

        def numbers(n):
            found = []
            while len(found) < n:
                found += next(lines).split()
            return found

        for line in lines:
            words = line.split()
            as_bytes = lambda code, values: struct.pack(f">{len(values)}{code}", *map(int if code in "iq" else float, values)) + b"\n"
            both = lambda head, body=b"": ((head + "\n").encode() + body,) * 2
            made = both(line.replace("ASCII", "BINARY").replace("3.0", "4.2"))
            if words and words[0] == "POINTS":
                made = both(line, as_bytes("d", numbers(3 * int(words[1]))))
            elif words and words[0] == "CELL_TYPES":
                made = both(line, as_bytes("i", numbers(int(words[1]))))
                count = int(words[1])
            elif words and words[0] == "CELL_DATA":
                count = int(words[1])
            elif words and words[0] == "POINT_DATA":
                count = int(words[1])
            elif words and words[0] == "SCALARS":
                made = both(line + "\n" + next(lines), as_bytes(codes[words[2]], numbers(count)))
            elif words and words[0] == "CELLS":
                values = list(map(int, numbers(int(words[2]))))
                offsets, corners, at = [0], [], 0
                while at < len(values):
                    corners += values[at + 1:at + 1 + values[at]]
                    at += 1 + values[at]
                    offsets.append(len(corners))
                made = (both(line, as_bytes("i", values))[0],
                        f"CELLS {len(offsets)} {len(corners)}\nOFFSETS vtktypeint64\n".encode() + as_bytes("q", offsets)
                        + b"CONNECTIVITY vtktypeint64\n" + as_bytes("q", corners))
            old, new = old + made[0], new + made[1]
        return old, new.replace(b"Version 4.2", b"Version 5.1")

    def test_all_versions_are_one_mesh(self):
        for model in (PLATE, BRACKET):
            self.output = self.folder / "text.vtk"
            self.mesh(model, "--no-refine")
            text, seen = self.output.read_text(), set()
            for name, data in zip(("old", "new"), self.binary(text)):
                file = self.folder / f"{name}.vtk"
                file.write_bytes(data)
                self.pgdr("check", file, "--input", model, expect=0)
                for n in (40, len(data) // 3, len(data) // 2, len(data) - 9):  # cut short
                    cut = self.folder / "cut.vtk"
                    cut.write_bytes(data[:n])
                    self.pgdr("check", cut, expect=3)
                self.pgdr("mesh", file, "-o", self.folder / "again.mesh")  # its boundary as an input
                seen.add((self.folder / "again.mesh").read_bytes())
            self.pgdr("mesh", self.output, "-o", self.folder / "again.mesh")
            self.assertEqual(seen, {(self.folder / "again.mesh").read_bytes()})

    def test_surfaces(self):
        """Polygonal data: a cube of quadrilaterals, one as a strip; polygons of more corners are refused."""
        head = "# vtk DataFile Version 2.0\na cube, of # six faces\nASCII\nDATASET POLYDATA\nPOINTS 8 float\n"
        points = "".join(f"{i & 1} {i >> 1 & 1} {i >> 2}\n" for i in range(8))
        faces = "POLYGONS 5 25\n4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\nTRIANGLE_STRIPS 1 5\n4 1 3 5 7\n"
        data = "CELL_DATA 6\nSCALARS marker int\nLOOKUP_TABLE default\n1 2 3 4 5 6\nFIELD FieldData 1\nheat%20in 2 6 float\n" + "1 2 " * 6 + "\n"
        cube = self.file("cube.vtk", head + points + faces + data)
        self.output = self.folder / "cube.mesh"
        self.mesh(cube, "--size", "0.3")
        self.pgdr("check", self.output, "--input", cube, expect=0)
        text = self.output.read_text()
        rows = text[text.index("\nTriangles"):text.index("\nTetrahedra")].split("\n")[3:]
        self.assertEqual({row.split()[3] for row in rows if len(row.split()) == 4}, set("123456"))
        for wrong in (head.replace("POLYDATA", "STRUCTURED_GRID") + points, head + points + "POLYGONS 1 6\n5 0 1 3 2 4\n",
                      head + points + "POLYGONS 1 4\n3 0 1 8\n", head + points + "POLYGONS 2 4\n3 0 1 2\n", head + "0 0 0\n",
                      head + points + faces + "CELL_DATA 5\n", head.replace("2.0", "9.0") + points, head.replace("float", "bit") + points,
                      "# vtk\n", head + points + "POLYGONS 1 99999999999\n3 0 1 2\n", head + points + "WHAT 1\n"):
            self.pgdr("mesh", self.file("wrong.vtk", wrong), "-o", self.output, expect=3)

    def test_fields(self):
        """Point and cell data come along, those of cells without those of constraints."""
        self.output = self.folder / "a.vtk"
        self.mesh(PLATE)
        words = self.output.read_text()
        cells, points = (int(words.split(name)[1].split()[0]) for name in ("CELL_TYPES ", "POINTS "))
        data = "FIELD more 1\nheat 1 %d double\n" % cells + " ".join(map(str, range(cells))) + "\n"
        more = words.replace("POINT_DATA", data + "POINT_DATA") if "POINT_DATA" in words else words + data + f"POINT_DATA {points}\n"
        more += f"VECTORS flow float\n" + "1 2 3\n" * points
        file = self.file("b.vtk", more)
        self.pgdr("remesh", file, "-o", self.folder / "c.vtu", "--size", "1")
        made = (self.folder / "c.vtu").read_bytes()
        self.assertIn(b'Name="heat"', made)
        self.assertIn(b'Name="flow"', made)

    def test_meshio_reads_it(self):
        try:
            import meshio
        except ImportError:
            self.skipTest("meshio is not installed")
        self.output = self.folder / "out.vtk"
        self.mesh(BRACKET)
        read = meshio.read(self.output)
        self.assertGreater(len(read.get_cells_type("tetra")), 10)
        self.assertEqual(len(read.get_cell_data("region", "tetra")), len(read.get_cells_type("tetra")))


class Dash(Case):
    def piped(self, data, *arguments, expect=0):
        done = subprocess.run([COMMAND, *map(str, arguments)], input=data, capture_output=True, timeout=500, check=False)
        self.assertEqual(done.returncode, expect, done.stderr)
        return done

    def test_through_a_pipe(self):
        self.output = self.folder / "out.vtu"
        self.mesh(PLATE, "--min-angle", "25")
        data = PLATE.read_bytes()
        done = self.piped(data, "mesh", "-", "-o", "-", "--format", "poly,vtu", "--min-angle", "25")
        self.assertEqual(done.stdout, self.output.read_bytes())
        self.piped(data, "mesh", "-", "--format", "poly", "-o", self.folder / "b.vtu", "--min-angle", "25")
        self.assertEqual((self.folder / "b.vtu").read_bytes(), self.output.read_bytes())
        self.assertEqual(self.piped(None, "mesh", PLATE, "-o", "-", "--format", "vtu", "--min-angle", "25").stdout, done.stdout)
        self.assertIn(b"everything holds", self.piped(done.stdout, "check", "-", "--format", "vtu", "--input", PLATE).stdout)
        self.assertIn(b"verdict", self.piped(data, "info", "-", "--format", "poly").stdout)
        self.assert_only("out.vtu", "b.vtu")

    def test_refusals(self):
        self.assertIn(b"--format", self.piped(b"", "mesh", "-", "-o", self.output, expect=2).stderr)
        self.assertIn(b"-.off", self.piped(b"OFF\n1 x\n", "mesh", "-", "--format", "off", "-o", self.output, expect=3).stderr)
        self.piped(b"", "mesh", PLATE, "-o", "-", "--format", "nothing", expect=2)
        self.assert_only()

    def test_files_of_that_name(self):
        self.file("-.poly", PLATE.read_bytes())
        self.piped(b"", "mesh", self.folder / "-.poly", "-o", self.folder / "-.vtu")
        self.assert_only("-.poly", "-.vtu")


if __name__ == "__main__":
    unittest.main()
