# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Arrays in and out: types, shapes, views and their owners, and what is refused."""
import gc
import pickle
import unittest

import numpy as np

import pgdr
from shapes import CUBE_FACETS, CUBE_POINTS, SQUARE_POINTS, SQUARE_SEGMENTS, checked, cube, same, square


class ArraysIn(unittest.TestCase):
    def test_any_type_and_layout_makes_the_same_mesh(self):
        wanted = checked(self, square(), size=0.01)
        for points in (SQUARE_POINTS.tolist(), SQUARE_POINTS.astype(np.int32), np.asfortranarray(SQUARE_POINTS),
                       np.repeat(SQUARE_POINTS, 2, axis=0)[::2], SQUARE_POINTS.astype(">f8")):
            for kind in (np.int8, np.uint16, np.int32, np.uint32, np.int64, np.uint64, ">i4"):
                made = checked(self, pgdr.Plc(points, SQUARE_SEGMENTS.astype(kind)), size=0.01)
                self.assertTrue(same(wanted, made), (points, kind))

    def test_float32_says_how_far_rounding_goes(self):
        self.assertGreater(pgdr.Plc(SQUARE_POINTS.astype(np.float32), SQUARE_SEGMENTS).tolerance, square().tolerance)

    def test_facets_as_array_list_and_polygons_with_a_hole(self):
        triangles = np.array([[q[0], q[i], q[i + 1]] for q in CUBE_FACETS for i in (1, 2)])
        made = checked(self, pgdr.Plc(CUBE_POINTS, facets=triangles, markers=np.arange(12)), size=0.5)
        self.assertAlmostEqual(volume(made), 1)
        points = np.vstack([CUBE_POINTS, [[.25, .25, 0], [.75, .25, 0], [.75, .75, 0], [.25, .75, 0]]])
        facets = [[CUBE_FACETS[0], [8, 9, 10, 11]]] + CUBE_FACETS[1:]
        made = checked(self, pgdr.Plc(points, facets=facets, markers=[1, 2, 3, 4, 5, 6]), size=0.5)
        self.assertEqual(sorted(set(made.markers.tolist())), [1, 2, 3, 4, 5, 6])

    def test_what_is_wrong_is_said(self):
        cases = [
            (lambda: pgdr.Plc(np.zeros((3, 4))), pgdr.UsageError, "shape"),
            (lambda: pgdr.Plc(np.zeros(6)), pgdr.UsageError, "shape"),
            (lambda: pgdr.Plc([[0, 0], [1]]), pgdr.UsageError, "array"),
            (lambda: pgdr.Plc([["a", "b"]]), pgdr.UsageError, "numbers"),
            (lambda: pgdr.Plc(SQUARE_POINTS * 1j), pgdr.UsageError, "real"),
            (lambda: pgdr.Plc(SQUARE_POINTS, SQUARE_SEGMENTS.astype(float)), pgdr.UsageError, "integers"),
            (lambda: pgdr.Plc(SQUARE_POINTS, [[0, 1, 2]]), pgdr.UsageError, "shape"),
            (lambda: pgdr.Plc(SQUARE_POINTS, SQUARE_SEGMENTS, markers=[1, 2]), pgdr.UsageError, "4 segments"),
            (lambda: pgdr.Plc(SQUARE_POINTS, SQUARE_SEGMENTS, markers=[2**40] * 4), pgdr.UsageError, "32 bits"),
            (lambda: pgdr.Plc(SQUARE_POINTS, SQUARE_SEGMENTS, holes=[[0, 0, 0]]), pgdr.UsageError, "shape"),
            (lambda: pgdr.Plc(SQUARE_POINTS, SQUARE_SEGMENTS, regions=[[0, 0]]), pgdr.UsageError, "region 0"),
            (lambda: pgdr.Plc(SQUARE_POINTS, facets=[[0, 1, 2]]), pgdr.UsageError, "3D"),
            (lambda: pgdr.Mesh.from_arrays(CUBE_POINTS, [[0, 1, 2, 8]]), pgdr.InputError, "8"),
            (lambda: pgdr.Mesh.from_arrays(CUBE_POINTS, [[0, 1, 2]]), pgdr.UsageError, "shape"),
            (lambda: pgdr.Mesh(), TypeError, "pgdr.mesh"),
        ]
        for make, error, words in cases:
            with self.subTest(words=words), self.assertRaisesRegex(error, words):
                make()

    def test_an_error_has_all_that_is_wrong(self):
        """It had the first of six crossings."""
        points, segments = [[0, 0], [7, 0], [7, 7], [0, 7]], [[0, 1], [1, 2], [2, 3], [3, 0]]
        for i in range(6):
            k = len(points)
            points += [[i + 0.5, 1], [i + 0.5, 6], [i + 0.2, 3], [i + 0.8, 3]]
            segments += [[k, k + 1], [k + 2, k + 3]]
        with self.assertRaises(pgdr.InputError) as caught:
            pgdr.mesh(pgdr.Plc(points, segments))
        self.assertEqual(len(caught.exception.diagnostics), 6)
        self.assertEqual({d.code for d in caught.exception.diagnostics}, {"entities_intersect"})

    def test_indices_and_coordinates_are_named(self):
        with self.assertRaises(pgdr.InputError) as caught:
            pgdr.Plc(SQUARE_POINTS, [[0, 1], [1, -2]])
        self.assertEqual((caught.exception.code, caught.exception.ids), ("index_out_of_range", [1, -2]))
        with self.assertRaises(pgdr.InputError) as caught:
            pgdr.Plc([[0, 0], [np.nan, 1]])
        self.assertEqual((caught.exception.code, caught.exception.ids), ("not_finite", [1]))


class ArraysOut(unittest.TestCase):
    def test_views_are_read_only_and_keep_their_owner(self):
        made = checked(self, cube(), size=0.2)
        views = [made.points, made.cells, made.subfacets, made.subsegments, made.subfacet_markers, made.point_of_input]
        copies = [np.array(v) for v in views]
        for v in views:
            with self.assertRaises(ValueError):
                v[...] = 0
        self.assertTrue(np.shares_memory(made.points, made.points))
        del made
        gc.collect()
        for _ in range(20):  # what would take the place of freed memory
            pgdr.mesh(square(), size=0.001)
        for v, copy in zip(views, copies):
            np.testing.assert_array_equal(v, copy)

    def test_points_of_the_input_come_first(self):
        made = checked(self, square(point_markers=[5, 6, 7, 8]), size=0.02)
        np.testing.assert_array_equal(made.points[made.point_of_input], SQUARE_POINTS)
        self.assertEqual(made.point_markers[:4].tolist(), [5, 6, 7, 8])
        self.assertEqual(made.input_points, 4)

    def test_points_in_no_cell(self):
        points = [[9, 9], *SQUARE_POINTS, [0.5, 0.5], [-1, 5]]
        plc = pgdr.Plc(points, segments=[[1, 2], [2, 3], [3, 4], [4, 1]])
        for drop, rows in ((False, [0, 1, 2, 3, 4, 5, 6]), (True, [-1, 0, 1, 2, 3, 4, -1])):
            made = pgdr.mesh(plc, size=0.02, drop_unused_points=drop)
            self.assertEqual(made.point_of_input.tolist(), rows)
            used = np.unique(made.cells)
            self.assertEqual(len(used), len(made.points) - (0 if drop else 2))
            self.assertEqual(made.input_points, 5 if drop else 7)
            kept = np.flatnonzero(made.point_of_input >= 0)
            np.testing.assert_array_equal(made.points[made.point_of_input[kept]], np.asarray(points)[kept])
            self.assertEqual([w.ids for w in made.warnings], [[0, 6]])
            self.assertEqual(made.statistics["unused_points"], 2)
            self.assertEqual(made.check(plc).exit_code, 0)
            again = pickle.loads(pickle.dumps(made))
            self.assertEqual(again.point_of_input.tolist(), rows)

    def test_neighbors_and_edges(self):
        made = checked(self, cube(), size=0.3)
        beyond, cells = made.neighbors(), made.cells
        self.assertEqual((beyond.shape, beyond.dtype), (cells.shape, np.int64))
        for c, i in zip(*np.nonzero(beyond >= 0)):
            self.assertEqual(set(np.delete(cells[c], i)) - set(cells[beyond[c, i]]), set())
        self.assertEqual(int((beyond < 0).sum()), len(made.subfacets))
        pairs = {tuple(sorted((a, b))) for c in cells.tolist() for a in c for b in c if a != b}
        self.assertEqual([tuple(e) for e in made.edges().tolist()], sorted(pairs))

    def test_quality(self):
        q = checked(self, cube(), size=0.2).quality()
        self.assertGreaterEqual(q["min_angle_deg"], 15)
        self.assertEqual(sum(q["cells_by_smallest_angle"]), len(pgdr.mesh(cube(), size=0.2).cells))


def volume(mesh):
    p = mesh.points[mesh.cells.astype(np.int64)]
    return float((np.linalg.det(p[:, 1:] - p[:, :1]) / 6).sum())


if __name__ == "__main__":
    unittest.main()
