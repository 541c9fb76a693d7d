# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes made of meshes: sizes a cell, boundaries as inputs, labels of nested volumes, and what pickles."""
import pickle
import unittest

import numpy as np

import pgdr
from shapes import CUBE_FACETS, CUBE_POINTS, SQUARE_POINTS, SQUARE_SEGMENTS, checked, cube, same, square


def measures(mesh):
    corners = mesh.points[mesh.cells]
    return np.linalg.det(corners[:, 1:] - corners[:, :1]) / (2 if mesh.dimension == 2 else 6)


def sizes_by_place(at):
    return 0.01 + 0.02 * at[:, 0]


def nested(*scales):
    """Cubes in one another about the middle of the first."""
    points = np.concatenate([0.5 + scale * (CUBE_POINTS - 0.5) for scale in scales])
    return pgdr.Plc(points, facets=[[8 * k + v for v in facet] for k in range(len(scales)) for facet in CUBE_FACETS])


class SizesOfCells(unittest.TestCase):
    def test_no_cell_gets_more_than_its_value(self):
        for plc, size in ((square(), 0.02), (cube(), 0.3)):
            coarse = checked(self, plc, size=size)
            values = np.where(coarse.points[coarse.cells].mean(axis=1)[:, 0] < 0.3, size / 4, size)
            field = pgdr.sizes_on_mesh(coarse, values)
            self.assertTrue((field(coarse.points[coarse.cells].mean(axis=1)) <= values * (1 + 1e-12)).all())
            least = np.full(len(coarse.points), np.inf)
            for i in range(coarse.dimension + 1):
                np.minimum.at(least, coarse.cells[:, i], values)
            by_hand = checked(self, plc, size=pgdr.sizes_on_mesh(coarse, least))
            self.assertTrue(same(by_hand, checked(self, plc, size=field)))
            self.assertGreater(len(by_hand.cells), len(coarse.cells))
            np.testing.assert_array_equal(pgdr.limit_growth(coarse, values, 0.1), pgdr.limit_growth(coarse, least, 0.1))

    def test_a_loop(self):
        made = checked(self, square(), min_angle=30, size=0.1)
        for _ in range(4):
            error, wanted = 1 / np.linalg.norm(made.points[made.cells].mean(axis=1) - [1, 1], axis=1), measures(made)
            wanted[error > np.quantile(error, 0.7)] /= 4
            made = checked(self, square(), min_angle=30, size=pgdr.sizes_on_mesh(made, wanted))
        self.assertLess(measures(made).min(), 0.001)

    def test_refusals(self):
        made = checked(self, square(), size=0.02)
        values = np.full(len(made.cells), 0.1)
        for wrong, words in ((values[:-1], "for each of"), (values[:, None], "for each of"), (-values, "cell 0")):
            with self.subTest(words), self.assertRaisesRegex(pgdr.UsageError, words):
                pgdr.sizes_on_mesh(made, wrong)
        values[5] = np.nan
        with self.assertRaises(pgdr.UsageError) as caught:
            pgdr.sizes_on_mesh(made, values)
        self.assertEqual(caught.exception.ids, [5])

    def test_as_many_points_as_cells(self):
        at = [[0, 0], [2, 0], [2, 2], [0, 2], [1, 1]]
        fan = pgdr.Mesh.from_arrays(at + [[1, 0.4]], [[0, 1, 5], [1, 4, 5], [0, 5, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
        values = [1, 1, 1, 1, 2, 3]
        with self.assertRaisesRegex(pgdr.UsageError, 'of="cells"'):
            pgdr.sizes_on_mesh(fan, values)
        self.assertEqual(pgdr.sizes_on_mesh(fan, values, of="points")([[1, 1]]).tolist(), [2])
        self.assertEqual(pgdr.sizes_on_mesh(fan, values, of="cells")([[1, 1]]).tolist(), [1])


class Boundaries(unittest.TestCase):
    def test_markers_labels_and_voids_come_through(self):
        outer, inner = SQUARE_POINTS * 4, SQUARE_POINTS + 1
        flat = pgdr.Plc(np.vstack([outer, inner, SQUARE_POINTS * 0.5 + 2.5]),
                        np.vstack([SQUARE_SEGMENTS + 4 * k for k in range(3)]), markers=np.arange(1, 13),
                        holes=[[1.5, 1.5]], regions=[(0.1, 0.1, 2.5), (2.7, 2.7, -3)])
        solid = pgdr.Plc(nested(1, 0.5).points, facets=nested(1, 0.5).facets, markers=range(1, 13),
                         regions=[(0.5, 0.5, 0.5, 7), (0.1, 0.1, 0.1, 0.25)])
        for plc, size in ((flat, 0.1), (solid, 0.2)):
            made = checked(self, plc, size=size)
            boundary = pgdr.Plc.from_mesh(made)
            again = checked(self, boundary, size=size / 2)
            self.assertEqual(set(again.markers.tolist()), set(made.markers.tolist()))
            for label in set(made.regions.tolist()):
                self.assertAlmostEqual(measures(again)[again.regions == label].sum(), measures(made)[made.regions == label].sum())
            self.assertEqual(len(set(again.regions.tolist())), 2)

    def test_a_mesh_without_constraints(self):
        made = checked(self, cube(), size=0.4)
        self.assertAlmostEqual(measures(checked(self, pgdr.Plc.from_mesh(pgdr.Mesh.from_arrays(made.points, made.cells)))).sum(), 1)

    def test_others_name_it(self):
        made = checked(self, cube(), size=0.5)
        for call in (pgdr.Plc.from_meshio, pgdr.Plc.from_pyvista, pgdr.mesh):
            with self.assertRaisesRegex(TypeError, "pgdr.Plc.from_mesh"):
                call(made)
        with self.assertRaises(TypeError):
            pgdr.Plc.from_mesh(cube())


class Labels(unittest.TestCase):
    def test_every_enclosed_volume(self):
        plc = nested(1, 0.5, 0.25)
        made = checked(self, plc, regions="all")
        self.assertEqual([round(measures(made)[made.regions == k].sum(), 9) for k in (1, 2, 3)], [0.875, 0.109375, 0.015625])
        self.assertFalse(pgdr.check(made, plc, regions="auto"))
        self.assertEqual(set(checked(self, plc, regions="auto").regions.tolist()), {1, 2})
        ring = pgdr.Plc(np.vstack([SQUARE_POINTS * 3, SQUARE_POINTS + 1]), np.vstack([SQUARE_SEGMENTS, SQUARE_SEGMENTS + 4]))
        made = checked(self, ring, regions="all")
        self.assertEqual([round(measures(made)[made.regions == k].sum(), 9) for k in (1, 2)], [8, 1])

    def test_as_tetgen(self):
        plc = nested(1, 0.5)
        for switches in ("pA", "pqA"):
            made = pgdr.tetrahedralize(plc.points, plc.facets, switches=switches)
            self.assertEqual(set(made.attributes.tolist()), {1, 2})
            self.assertTrue(made.mesh.check(plc))
        made = pgdr.tetrahedralize(plc.points, plc.facets, switches="pA", regions=[[0.5, 0.5, 0.5, 1, 0]])
        self.assertEqual(set(made.attributes.tolist()), {1, 2})
        self.assertEqual(set(pgdr.tetrahedralize(plc.points, plc.facets, switches="p").attributes.tolist()), {0})

    def test_a_label_a_cell(self):
        for plc in (square(), cube()):
            made = checked(self, plc, size=0.3)
            self.assertEqual(made.regions.tolist(), [0.0] * len(made.cells))
            self.assertEqual(pgdr.info(made)["labels"], [0.0])
            with self.assertRaises(ValueError):
                made.regions[0] = 1


class Signs(unittest.TestCase):
    def test_differences_do_not_wrap(self):
        made = checked(self, cube(), size=0.3)
        for rows in (made.cells, made.subfacets, made.subsegments, made.edges(), made.point_of_input, made.neighbors(), square().segments):
            self.assertEqual(rows.dtype.kind, "i")
        self.assertLess((made.cells[:, 0] - made.cells[:, 1]).min(), 0)


class Pickles(unittest.TestCase):
    def test_fields(self):
        made = checked(self, square(), size=0.05)
        at = np.random.default_rng(0).random((50, 2))
        near = pgdr.sizes_at_points([[0.5, 0.5]], [0.001], 0.1)
        on_mesh = pgdr.sizes_on_mesh(made, np.linspace(0.01, 0.02, len(made.cells)))
        for field in (near, on_mesh, pgdr.smallest(near, on_mesh, 0.005), pgdr.smallest(near, sizes_by_place)):
            again = pickle.loads(pickle.dumps(field))
            np.testing.assert_array_equal(again(at), field(at))
        with self.assertRaises((pickle.PicklingError, AttributeError)):
            pickle.dumps(pgdr.smallest(near, lambda x: x[:, 0] + 1))

    def test_a_mesh_keeps_its_fields(self):
        near = pgdr.sizes_at_points([[0.5, 0.5]], [0.001], 0.1)
        for size, is_kept in ((near, True), (pgdr.smallest(near, 0.01), True), (pgdr.smallest(near, lambda x: x[:, 0] + 1), False)):
            again = pickle.loads(pickle.dumps(checked(self, square(), size=size)))
            if is_kept:
                self.assertTrue(again.check(square()))
            else:
                with self.assertRaisesRegex(pgdr.UsageError, "give it again"):
                    again.check(square())


if __name__ == "__main__":
    unittest.main()
