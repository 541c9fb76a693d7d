# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs from rings and polygons, as arrays, as GeoJSON, and as Shapely hands them out (a class stands in for it)."""
import unittest
import warnings

import numpy as np

import pgdr

SQUARE = [[0, 0], [3, 0], [3, 3], [0, 3]]


class Geometry:
    """What Shapely's geometries and GeoPandas' tables have in common."""

    def __init__(self, kind, **parts):
        self.__geo_interface__ = {"type": kind, **parts}


def ring(x, y, width, height=None):
    """Closed, as GeoJSON has it."""
    height = width if height is None else height
    return [[x, y], [x + width, y], [x + width, y + height], [x, y + height], [x, y]]


def polygon(*rings):
    return Geometry("Polygon", coordinates=tuple(tuple(map(tuple, r)) for r in rings))


class Meshed(unittest.TestCase):
    def meshed(self, plc, expected, **options):
        made = pgdr.mesh(plc, **options)
        self.assertTrue(pgdr.check(made, plc))
        self.assertAlmostEqual(area(made), expected, delta=1e-9 * expected)
        return made


def area(mesh, label=None):
    corners = mesh.points[mesh.cells if label is None else mesh.cells[mesh.regions == label]]
    return abs(np.linalg.det(corners[:, 1:] - corners[:, :1])).sum() / 2


class Polygons(Meshed):
    def test_rings_in_any_direction_closed_or_not(self):
        hole = [[1, 1], [2, 1], [2, 2], [1, 2]]
        for outer in (SQUARE, SQUARE[::-1], SQUARE + SQUARE[:1]):
            for inner in (hole, hole[::-1], hole + hole[:1]):
                plc = pgdr.Plc.from_polygons(outer, [inner])
                self.assertEqual((len(plc.points), len(plc.segments)), (8, 8))
                self.meshed(plc, 8.0)

    def test_seeds_lie_in_holes_of_any_shape(self):
        star = [[1.5 + r * np.cos(t), 1.5 + r * np.sin(t)] for r, t in zip([1, 0.1] * 9, np.arange(18) * np.pi / 9)]
        comb = [[0.5, 0.5], [2.5, 0.5], [2.5, 2.5], [2.4, 0.6], [0.6, 0.6], [0.5, 2.5]]
        for ring in (star, comb):
            at = np.array(ring)
            area = abs((at[:, 0] * np.roll(at[:, 1], -1) - at[:, 1] * np.roll(at[:, 0], -1)).sum()) / 2
            self.meshed(pgdr.Plc.from_polygons(SQUARE, [ring]), 9 - area)

    def test_markers(self):
        hole = [[1, 1], [2, 1], [2, 2]]
        self.assertEqual(pgdr.Plc.from_polygons(SQUARE, [hole]).markers.tolist(), [1] * 4 + [2] * 3)
        self.assertEqual(pgdr.Plc.from_polygons(SQUARE, [hole], markers=[5, 0]).markers.tolist(), [5] * 4 + [0] * 3)

    def test_refusals(self):
        for outer, holes in (([[0, 0], [1, 0]], []), ([[0, 0], [1, 0], [0, 0]], []), (SQUARE, [[[1, 1], [2, 1], [1.5, 1]]]),
                             ([[0, 0, 0]] * 3, [])):
            with self.subTest(outer=outer), self.assertRaises(pgdr.UsageError):
                pgdr.Plc.from_polygons(outer, holes)


class SeveralPolygons(Meshed):
    def test_whatever_has_a_geo_interface(self):
        holed = polygon(ring(0, 0, 4, 3), ring(1, 1, 1))
        apart = polygon(ring(6, 0, 1))
        both = Geometry("MultiPolygon", coordinates=[p.__geo_interface__["coordinates"] for p in (holed, apart)])
        collection = Geometry("GeometryCollection", geometries=[holed.__geo_interface__, apart.__geo_interface__])
        table = Geometry("FeatureCollection", features=[{"type": "Feature", "properties": {}, "geometry": p.__geo_interface__}
                                                        for p in (holed, apart)])
        self.meshed(pgdr.Plc.from_polygons(holed), 11)
        self.meshed(pgdr.Plc.from_polygons(holed.__geo_interface__), 11)
        for several in (both, collection, table, [holed, apart], [both], (holed.__geo_interface__, apart), [ring(0, 0, 4, 3), ring(6, 0, 1)],
                        [[ring(0, 0, 4, 3), ring(1, 1, 1)], ring(6, 0, 1)], both.__geo_interface__["coordinates"]):
            hole = 0 if several == [ring(0, 0, 4, 3), ring(6, 0, 1)] else 1
            self.meshed(pgdr.Plc.from_polygons(several), 13 - hole)
        self.meshed(pgdr.Plc.from_polygons(np.array([ring(0, 0, 1), ring(2, 0, 1)])), 2)
        self.meshed(pgdr.Plc.from_polygons([np.array(ring(0, 0, 1)), np.array(ring(2, 0, 3))]), 10)
        heights = polygon([corner + [5.0] for corner in ring(0, 0, 2)])
        self.meshed(pgdr.Plc.from_polygons(heights), 4)

    def test_an_island_in_a_hole(self):
        lake, island = polygon(ring(0, 0, 9), ring(1, 1, 7)), polygon(ring(3, 3, 2))
        plc = pgdr.Plc.from_polygons([lake, island], labels=[1, 2])
        made = self.meshed(plc, 81 - 49 + 4)
        self.assertAlmostEqual(area(made, 2), 4)
        self.meshed(pgdr.Plc.from_polygons([island, lake]), 36)

    def test_a_void_that_several_enclose(self):
        """Four walls around a yard, which none of them has as a hole."""
        walls = [ring(0, 0, 5, 1), ring(0, 4, 5, 1), ring(0, 1, 1, 3), ring(4, 1, 1, 3)]
        plc = pgdr.Plc.from_polygons(walls, labels=[1, 2, 3, 4])
        self.assertEqual(len(plc.holes), 1)
        made = self.meshed(plc, 16)
        self.assertEqual([round(area(made, k), 9) for k in (1, 2, 3, 4)], [5, 5, 3, 3])

    def test_tiles_and_overlaps_turned_and_far_away(self):
        rng = np.random.default_rng(3)
        for trial in range(12):
            angle, far = rng.uniform(0, 6.28), rng.choice([0.0, 4e5])
            turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
            tiles = [(np.array(ring(2 * i, 3 * j, 2, 3)) @ turn.T + far * np.array([1, 12.5])) for i in range(3) for j in range(3)]
            kept = [tile for k, tile in enumerate(tiles) if k != 4]  # the one in the middle is a void
            with self.subTest(trial=trial):
                self.meshed_about(pgdr.Plc.from_polygons(kept, labels=range(8)), 48, 8)
                self.meshed_about(pgdr.Plc.from_polygons(tiles), 54, 1)
                self.assertEqual(pgdr.mesh(pgdr.Plc.from_polygons(tiles)).warnings, [])

    def meshed_about(self, plc, expected, labels):
        made = pgdr.mesh(plc)
        self.assertTrue(pgdr.check(made, plc))
        self.assertAlmostEqual(area(made), expected, delta=1e-6 * expected)
        self.assertEqual(len(set(made.regions.tolist())), labels)

    def test_overlaps_are_split_when_asked_for(self):
        plc = pgdr.Plc.from_polygons([ring(0, 0, 3), ring(2, 2, 3)], labels=[1, 2])
        with self.assertRaises(pgdr.InputError) as caught:
            pgdr.mesh(plc)
        self.assertIn("pgdr.resolve_crossings(plc)", str(caught.exception))
        made = self.meshed(pgdr.resolve_crossings(plc)[0], 17)
        self.assertAlmostEqual(area(made, 1), 9)

    def test_markers_are_of_rings(self):
        plc = pgdr.Plc.from_polygons([polygon(ring(0, 0, 4), ring(1, 1, 1)), ring(6, 0, 1)], markers=[7, 8, 9])
        self.assertEqual(plc.markers.tolist(), [7] * 4 + [8] * 4 + [9] * 4)

    def test_what_encloses_nothing_is_said(self):
        line = Geometry("LineString", coordinates=((0, 0), (1, 1)))
        mixed = Geometry("GeometryCollection", geometries=[line.__geo_interface__, polygon(ring(0, 0, 1)).__geo_interface__])
        with self.assertWarnsRegex(UserWarning, "1 LineString"):
            self.meshed(pgdr.Plc.from_polygons(mixed), 1)
        for nothing in (line, [line, line], Geometry("MultiPolygon", coordinates=()), Geometry("Polygon", coordinates=()), {"type": "Disk"},
                        {}, {"type": "Polygon"}, {"type": "MultiPolygon", "coordinates": 3}, Geometry("Polygon", coordinates=None)):
            with self.subTest(nothing), self.assertRaises(pgdr.UsageError), warnings.catch_warnings():
                warnings.simplefilter("error")
                pgdr.Plc.from_polygons(nothing)
        with self.assertRaisesRegex(pgdr.UsageError, "outer one first"):
            pgdr.Plc.from_polygons([ring(0, 0, 4), ring(6, 0, 4)], holes=[ring(1, 1, 1)])
        with self.assertRaisesRegex(pgdr.UsageError, "2 polygons"):
            pgdr.Plc.from_polygons([ring(0, 0, 4), ring(6, 0, 4)], labels=[1])


if __name__ == "__main__":
    unittest.main()
