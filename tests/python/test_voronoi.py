# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Conforming Delaunay meshes and their Voronoi cells, against brute force; sizes along lines and on rasters."""
import os
import tempfile
import unittest
from fractions import Fraction

import numpy as np

import pgdr

SQUARE = [[0, 0], [3, 0], [3, 3], [0, 3]]


def random_plc(seed):
    """A turned square with slanted segments, which are split where they cross, and points."""
    rng = np.random.default_rng(seed)
    turn = rng.random() * 2 * np.pi
    frame = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]]) @ [[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]]
    inner = 0.02 + 0.96 * rng.random((20, 2))
    inner = inner @ [[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]]
    segments = [[0, 1], [1, 2], [2, 3], [3, 0]] + [[4 + 2 * i, 5 + 2 * i] for i in range(5)]
    return pgdr.resolve_crossings(pgdr.Plc(np.concatenate([frame, inner]), segments))[0]


def solid(**options):
    rng = np.random.default_rng(2)
    points = np.concatenate([[[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], 0.05 + 0.9 * rng.random((12, 3))])
    facets = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return pgdr.mesh(pgdr.Plc(points, facets=facets), **options)


def determinant(rows):
    """By fractions; zero columns do not come."""
    if len(rows) == 1:
        return rows[0][0]
    return sum((-1) ** i * row[0] * determinant([r[1:] for r in rows[:i] + rows[i + 1:]]) for i, row in enumerate(rows) if row[0])


def inside_sphere(corners, p):
    """Strictly inside the circumsphere of a simplex, by exact arithmetic."""
    rows = [[Fraction(a) - Fraction(b) for a, b in zip(corner, p)] for corner in corners]
    edges = [[Fraction(a) - Fraction(b) for a, b in zip(corner, corners[0])] for corner in corners[1:]]
    side = determinant([row + [sum(x * x for x in row)] for row in rows]) * determinant(edges)
    return side > 0 if len(p) == 2 else side < 0


def not_conforming(r):
    """Is a vertex well inside of a circumcircle across an edge, or of the diametral circle of an edge of the boundary?"""
    for corners, beyond in zip(r.cells.tolist(), r.neighbors().tolist()):
        for i, other in enumerate(beyond):
            a, b, x = (r.points[corners[(i + k) % 3]] for k in (1, 2, 0))
            if other < 0 and np.dot(a - x, b - x) < -1e-12:
                return True
            if other >= 0:
                apex = next(v for v in r.cells[other].tolist() if v not in corners)
                y = r.points[apex]
                angles = [np.arccos(np.dot(a - z, b - z) / np.linalg.norm(a - z) / np.linalg.norm(b - z)) for z in (x, y)]
                if sum(angles) > np.pi + 1e-9:
                    return True
    return False


class Conforming(unittest.TestCase):
    def assert_cells(self, r, v, area):
        """Each cell is what brute force says: of random points in the domain, the nearest site is that of the cell."""
        self.assertAlmostEqual(v.areas.sum() / area, 1, places=9)
        self.assertTrue((v.areas > 0).all())
        rng = np.random.default_rng(0)
        chosen = rng.integers(0, len(r.cells), 300)
        weights = rng.dirichlet([1, 1, 1], 300)
        at = (r.points[r.cells[chosen]] * weights[:, :, None]).sum(axis=1)
        distance = np.linalg.norm(at[:, None] - v.sites[None], axis=2)
        nearest = distance.argmin(axis=1)
        least = np.sort(distance, axis=1)
        sure = least[:, 1] - least[:, 0] > 1e-9
        for x, site in zip(at[sure], nearest[sure]):
            cell = v.points[v.corners[v.offsets[site]:v.offsets[site + 1]]]
            a, b = cell - x, np.roll(cell, -1, axis=0) - x
            self.assertGreater((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).min(), -1e-9)

    def test_random_inputs(self):
        for seed in range(6):
            for bounds in ({"radius_edge": float("inf")}, {"min_angle": 25, "size": 0.01}):
                with self.subTest(seed=seed, **bounds):
                    plc = random_plc(seed)
                    r = pgdr.mesh(plc, conforming_delaunay=True, **bounds)
                    self.assertTrue(r.check(plc))
                    self.assert_cells(r, r.voronoi(), 1)

    def test_what_the_checker_says(self):
        """As exact arithmetic does, edge by edge: of meshes with it, and of meshes without."""
        refused = 0
        for seed in range(6):
            plc = random_plc(seed)
            conforming = pgdr.mesh(plc, radius_edge=float("inf"), conforming_delaunay=True)
            self.assertTrue(conforming.check(plc))
            plain = pgdr.mesh(plc, radius_edge=float("inf"))
            self.assertTrue(plain.check(plc))
            self.assertEqual(len(plain.not_delaunay()), 0)
            report = plain.check(plc, conforming_delaunay=True)
            self.assertEqual(not report, not_conforming(plain))
            self.assertTrue(all(f.kind == "not_delaunay" for f in report.findings))
            refused += not report
        self.assertGreater(refused, 2)
        with self.assertRaises(pgdr.UsageError):
            pgdr.check(solid(), conforming_delaunay=True)

    def test_cells_that_are_not_delaunay(self):
        """All cells with the vertex of a neighbour inside, across a face that is no subfacet, by exact arithmetic."""
        for optimize in (True, False):
            r = solid(optimize=optimize)
            walls = {tuple(sorted(f)) for f in r.subfacets.tolist()}
            wanted = set()
            for cell, (corners, beyond) in enumerate(zip(r.cells.tolist(), r.neighbors().tolist())):
                for i, other in enumerate(beyond):
                    face = corners[:i] + corners[i + 1:]
                    if other < 0 or tuple(sorted(face)) in walls:
                        continue
                    apex = next(v for v in r.cells[other].tolist() if v not in face)
                    if inside_sphere(r.points[corners].tolist(), r.points[apex].tolist()):
                        wanted.add(cell)
            found = r.not_delaunay()
            self.assertEqual(found[:, 0].tolist(), sorted(wanted))
            self.assertEqual(len(wanted) > 0, optimize)
            for cell, vertex in found.tolist():
                self.assertTrue(inside_sphere(r.points[r.cells[cell]].tolist(), r.points[vertex].tolist()))

    def test_what_it_is_for(self):
        """A mesh without it has no such cells, where a segment has an obtuse angle before it."""
        plc = pgdr.Plc([[0, 0], [10, 0], [10, 1], [0, 1], [5, 0.1]], segments=[[0, 1], [1, 2], [2, 3], [3, 0]])
        with self.assertRaisesRegex(pgdr.UsageError, "conforming_delaunay"):
            pgdr.mesh(plc, radius_edge=float("inf")).voronoi()
        r = pgdr.mesh(plc, radius_edge=float("inf"), conforming_delaunay=True)
        self.assert_cells(r, r.voronoi(), 10)
        made = pgdr.triangulate({"vertices": plc.points, "segments": plc.segments}, "pDC")
        self.assertEqual(len(made["triangles"]), len(r.cells))

    def test_a_hole_and_links(self):
        ring = pgdr.Plc.from_polygons(SQUARE, [[[1, 1], [2, 1], [2, 2], [1, 2]]])
        r = pgdr.mesh(ring, min_angle=28, size=0.05, conforming_delaunay=True)
        v = r.voronoi()
        self.assertAlmostEqual(v.areas.sum(), 8, places=12)
        self.assertEqual(v.links.tolist(), r.edges().tolist())
        self.assertAlmostEqual((v.widths * v.lengths).sum() / 2, 8, places=12)  # kites over all links
        sizes = [len(cell) for cell in v.cells()]
        self.assertEqual(sizes, np.diff(v.offsets).tolist())
        for cell, area in zip(v.cells(), v.areas):
            x, y = cell.T
            self.assertAlmostEqual((x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2, area, places=12)

    def test_two_fans_at_a_point(self):
        """Two squares that meet in a corner: its cell has a part in each."""
        plc = pgdr.Plc([[0, 0], [1, 0], [1, 1], [0, 1], [2, 1], [2, 2], [1, 2]],
                       segments=[[0, 1], [1, 2], [2, 3], [3, 0], [2, 4], [4, 5], [5, 6], [6, 2]])
        v = pgdr.mesh(plc, conforming_delaunay=True).voronoi()
        np.testing.assert_allclose(v.areas, [0.25, 0.25, 0.5, 0.25, 0.25, 0.25, 0.25], atol=1e-15)

    def test_written(self):
        v = pgdr.mesh(pgdr.Plc.from_polygons(SQUARE), size=0.5, conforming_delaunay=True).voronoi()
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "a.voronoi")
            v.write(file)
            with open(file, encoding="ascii") as text:
                lines = text.read().splitlines()
            with self.assertRaises(pgdr.FileError):
                v.write(os.path.join(folder, "none", "a.voronoi"))
        self.assertEqual(lines[:2], ["# pgdr voronoi 1", f"{len(v.points)} {len(v.sites)}"])
        points = np.array([line.split() for line in lines[2:2 + len(v.points)]], dtype=float)
        self.assertTrue(np.array_equal(points, v.points))
        cells = [line.split() for line in lines[2 + len(v.points):]]
        self.assertEqual([int(c[2]) for c in cells], np.diff(v.offsets).tolist())
        self.assertEqual([int(x) for c in cells for x in c[3:]], v.corners.tolist())

    def test_refusals(self):
        cube = pgdr.Plc([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)],
                        facets=[[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])
        with self.assertRaisesRegex(pgdr.UsageError, "2D"):
            pgdr.mesh(cube).voronoi()
        for plc, more in ((cube, {}), (pgdr.Plc.from_polygons(SQUARE), {"keep_boundary": True}), (pgdr.Plc.from_polygons(SQUARE), {"refine": False})):
            with self.assertRaisesRegex(pgdr.UsageError, "conforming"):
                pgdr.mesh(plc, conforming_delaunay=True, **more)


class Sizes(unittest.TestCase):
    def test_along_lines(self):
        rng = np.random.default_rng(3)
        for dimension in (2, 3):
            lines, sizes = rng.random((6, 2, dimension)), 0.001 + 0.05 * rng.random(6)
            lines[0, 1] = lines[0, 0]  # a point
            at = rng.random((200, dimension))
            a, along = lines[:, 0], lines[:, 1] - lines[:, 0]
            t = ((at[:, None] - a) * along).sum(axis=2) / np.maximum((along ** 2).sum(axis=1), 1e-300)
            away = np.linalg.norm(at[:, None] - a - np.clip(t, 0, 1)[:, :, None] * along, axis=2)
            roots = sizes ** (1 / (4 - dimension))
            for growth in (0.0, 0.1, 1.0):
                exact, least = (roots + growth * away).min(axis=1), (0.95 * roots + growth * away).min(axis=1)
                found = pgdr.sizes_along(lines, sizes, growth)(at) ** (1 / (4 - dimension))
                self.assertTrue((found <= exact * (1 + 1e-12)).all() and (found >= least * (1 - 1e-12)).all())
        for lines, sizes, growth in (([[0, 0, 1, 1]], [1], 1), ([[[0, 0], [1, 1]]], [0], 1), ([[[0, 0], [1, 1]]], [1], -1),
                                     ([[[0, 0], [1e9, 1]]], [1e-9], 1), ([[[0, 0], [1, 1]]], [1, 2], 1)):
            with self.assertRaises(pgdr.UsageError):
                pgdr.sizes_along(lines, sizes, growth)

    def test_on_rasters(self):
        rng = np.random.default_rng(4)
        values = 0.01 + rng.random((7, 5))
        transform = (0.5, 0.1, 10, -0.05, -0.4, 20)  # turned a little
        rows, columns = np.indices(values.shape) + 0.5
        at = np.stack([0.5 * columns + 0.1 * rows + 10, -0.05 * columns - 0.4 * rows + 20], axis=-1)
        np.testing.assert_allclose(pgdr.sizes_on_raster(values, transform)(at.reshape(-1, 2)), values.reshape(-1), rtol=1e-9)
        middle = (at[2, 2] + at[2, 3]) / 2
        self.assertAlmostEqual(pgdr.sizes_on_raster(values, transform)([middle])[0], (values[2, 2] + values[2, 3]) / 2)
        holes = np.ma.masked_array(values, mask=np.zeros_like(values, dtype=bool))
        holes[2, 2] = np.ma.masked
        for given in (holes, np.where(holes.mask, np.nan, values)):
            found = pgdr.sizes_on_raster(given, transform)(at.reshape(-1, 2)).reshape(values.shape)
            np.testing.assert_allclose(found[~holes.mask], values[~holes.mask], rtol=1e-9)
        slow = pgdr.sizes_on_raster(values, transform, growth=0.1)(at.reshape(-1, 2)).reshape(values.shape)
        steps = np.abs(np.diff(np.sqrt(slow), axis=1))
        self.assertLessEqual(steps.max(), 0.1 * np.hypot(0.5, 0.05) * (1 + 1e-9))
        for given, by in ((values[0], transform), (-values, transform), (np.full((3, 3), np.nan), transform), (values, "abcdef")):
            with self.assertRaises((pgdr.UsageError, TypeError)):
                pgdr.sizes_on_raster(given, by)

    def test_a_mesh(self):
        field = pgdr.sizes_on_raster([[0.5, 0.5, 0.5], [0.5, 0.001, 0.001], [0.5, 0.001, 0.001]], (1, 0, 0, 0, -1, 3))
        r = pgdr.mesh(pgdr.Plc.from_polygons(SQUARE), size=field)
        self.assertTrue(r.check())
        a, b, c = r.points[r.cells].transpose(1, 0, 2)
        areas = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
        self.assertTrue((areas <= field((a + b + c) / 3) * (1 + 1e-9)).all())


if __name__ == "__main__":
    unittest.main()
