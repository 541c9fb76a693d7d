# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes as inputs: labels, volumes, markers and names stay, sizes are met, the checker agrees with the old mesh as input, fields come
along, and threads make no difference."""
import importlib
import pathlib
import pickle
import sys
import tempfile
import unittest

import numpy as np

import pgdr
from shapes import CUBE_FACETS, CUBE_POINTS, same


def measures(mesh):
    corners = mesh.points[mesh.cells]
    return np.linalg.det(corners[:, 1:] - corners[:, :1]) / (2 if mesh.dimension == 2 else 6)


def turned(points, seed):
    """Points about some axis, and moved: no coordinates are round numbers any more."""
    random = np.random.default_rng(seed)
    rotation, _ = np.linalg.qr(random.normal(size=(points.shape[1],) * 2))
    return points @ (rotation * np.sign(np.linalg.det(rotation))) + random.normal(size=points.shape[1])


def boxes(seed):
    """A cube in a cube, with labels, markers, names, a void in the inner one, and a sheet in the outer one."""
    points = np.concatenate([0.5 + scale * (CUBE_POINTS - 0.5) for scale in (1.0, 0.5, 0.2)]
                            + [[[0.8, 0.3, 0.3], [0.95, 0.3, 0.3], [0.95, 0.6, 0.3], [0.8, 0.6, 0.3]]])
    facets = [[8 * k + v for v in facet] for k in range(3) for facet in CUBE_FACETS] + [[24, 25, 26, 27]]
    seeds = np.array([[0.05, 0.05, 0.05], [0.3, 0.3, 0.3], [0.5, 0.5, 0.5]])
    all_points = np.concatenate([points, seeds])
    if seed:
        all_points = turned(all_points, seed)
    points, seeds = all_points[:-3], all_points[-3:]
    plc = pgdr.Plc(points, facets=facets, markers=[1, 2, 3, 4, 5, 6] + [7] * 6 + [8] * 6 + [9], holes=seeds[2:],
                   regions=[(*seeds[0], 5), (*seeds[1], 12)])
    return plc.with_names(regions={5: "coat", 12: "core"}, markers={1: "floor", 9: "sheet"})


def plates(seed):
    """Two rectangles side by side with labels, one with a hole, a line in the other, and names."""
    points = np.array([[0, 0], [1, 0], [2, 0], [2, 1], [1, 1], [0, 1], [0.3, 0.3], [0.6, 0.3], [0.6, 0.7], [0.3, 0.7],
                       [1.3, 0.5], [1.8, 0.6], [0.1, 0.5], [1.1, 0.5], [0.5, 0.5]], dtype=float)
    if seed:
        points = turned(points, seed)
    points, left, right, hole = points[:12], points[12], points[13], points[14]
    segments = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 0], [1, 4], [6, 7], [7, 8], [8, 9], [9, 6], [10, 11]]
    plc = pgdr.Plc(points, segments, markers=[1, 1, 2, 3, 3, 4, 5, 6, 6, 6, 6, 7], holes=[hole], regions=[(*left, 5), (*right, 12)])
    return plc.with_names(regions={5: "coat", 12: "core"}, markers={1: "floor", 7: "line"})


def amounts(mesh, values):
    """By label."""
    return {label: (measures(mesh)[mesh.regions == label] * values[mesh.regions == label]).sum() for label in set(mesh.regions)}


class Remesh(unittest.TestCase):
    def assert_is_of(self, new, old):
        report = pgdr.check(new, old)
        self.assertLessEqual(report.exit_code, 1, report)
        before, after = amounts(old, np.ones(len(old.cells))), amounts(new, np.ones(len(new.cells)))
        self.assertEqual(before.keys(), after.keys())
        for label, volume in before.items():
            self.assertAlmostEqual(after[label], volume, delta=1e-12)
        self.assertEqual((new.region_names, new.marker_names), (old.region_names, old.marker_names))
        self.assertEqual(set(new.markers), set(old.markers))

    def test_finer_and_coarser(self):
        """By sizes a factor 4 apart, turned, and again and again: the corners alone are left of what is not asked for."""
        for make, size, corners in ((plates, 0.05, 12), (boxes, 0.2, 28)):
            for seed in range(4):
                with self.subTest(make.__name__, seed=seed):
                    plc = make(seed)
                    old = pgdr.mesh(plc, edge_length=size)
                    fine = pgdr.remesh(old, edge_length=size / 2 if make is boxes else size / 4)
                    coarse = pgdr.remesh(fine, edge_length=4 * size)
                    bare = pgdr.remesh(fine, refine=False)
                    self.assert_is_of(fine, old)
                    self.assert_is_of(coarse, fine)
                    self.assertTrue(pgdr.check(coarse, plc).exit_code <= 1)
                    self.assertGreater(len(fine.cells), 4 * len(old.cells))
                    self.assertLess(len(coarse.cells), len(old.cells))
                    self.assertEqual((bare.input_points, coarse.input_points), (corners, corners))
                    for point in plc.points:
                        self.assertTrue((coarse.points[:corners] == point).all(axis=1).any(), point)

    def test_threads_make_no_difference(self):
        for make, size in ((plates, 0.03), (boxes, 0.1)):
            old = pgdr.mesh(make(3), edge_length=size)
            sizes = 0.3 * size + 0.3 * np.linalg.norm(old.points - old.points[0], axis=1)
            one, two, eight = (pgdr.remesh(old, point_sizes=sizes, size_unit="edge", growth=0.2, threads=n) for n in (1, 2, 8))
            self.assertTrue(same(one, two))
            self.assertTrue(same(one, eight))
            self.assert_is_of(one, old)

    def test_sizes_of_points_and_cells(self):
        for make, size in ((plates, 0.03), (boxes, 0.12)):
            old = pgdr.mesh(make(1), edge_length=size)
            power = 2 if old.dimension == 2 else 1
            native = 0.625 * size**2 if old.dimension == 2 else 0.75 * size
            at_points = np.where(old.points[:, 0] < np.median(old.points[:, 0]), size / 2, size)
            of_cells = np.where(old.points[old.cells].mean(axis=1)[:, 0] < np.median(old.points[:, 0]), size / 2, size)
            for sizes in ({"point_sizes": at_points}, {"cell_sizes": of_cells}):
                new = pgdr.remesh(old, size_unit="edge", **sizes)
                field = pgdr.sizes_on_mesh(old, native * (next(iter(sizes.values())) / size)**power)
                self.assertEqual(pgdr.check(new, old, size=field).over_size, 0)
                self.assertTrue(same(new, pgdr.remesh(old, size=field)))
                self.assertGreater(len(new.cells), len(old.cells))
            with self.assertRaises(pgdr.UsageError):
                pgdr.remesh(old, point_sizes=at_points[1:])
            with self.assertRaises(pgdr.UsageError):
                pgdr.remesh(old, growth=0.3)

    def test_required_points(self):
        for make in (plates, boxes):
            old = pgdr.mesh(make(2), edge_length=0.1)
            required = np.zeros(len(old.points), dtype=bool)
            required[::37] = True
            new = pgdr.remesh(old, required=required, refine=False)
            for point in old.points[required]:
                self.assertTrue((new.points == point).all(axis=1).any())
            self.assertTrue(pgdr.check(new, old, required=required))
            without = pgdr.remesh(old, refine=False)
            self.assertIn("missing_input_point", [f.kind for f in pgdr.check(without, old, required=required).findings])

    def test_the_checker_sees_what_is_wrong(self):
        old = pgdr.mesh(boxes(0), edge_length=0.2)
        other = pgdr.mesh(pgdr.Plc(CUBE_POINTS, facets=CUBE_FACETS, markers=[1, 2, 3, 4, 5, 6]), edge_length=0.2)
        self.assertEqual(pgdr.check(other, old).exit_code, 6)
        points = np.array(CUBE_POINTS)
        points[0] -= 1e-9
        moved = pgdr.mesh(pgdr.Plc(points, facets=CUBE_FACETS, markers=[1, 2, 3, 4, 5, 6]), edge_length=0.2)
        self.assertEqual(pgdr.check(pgdr.remesh(other), other).exit_code, 0)
        self.assertEqual(pgdr.check(moved, other).exit_code, 6)

    def test_kept_boundary(self):
        old = pgdr.mesh(plates(1), edge_length=0.1)
        new = pgdr.remesh(old, keep_boundary=True, edge_length=0.02)
        edges = lambda mesh: {tuple(sorted(map(tuple, mesh.points[s]))) for s in mesh.subsegments}
        self.assertEqual(edges(new), edges(old))

    def test_another_surface(self):
        """What another surface is made of the old mesh's is what is made of the input's: lines that a mesh has for its facets pin
        nothing."""
        rings, ring = 20, 40
        at = lambda r, k: 1 + r * ring + k % ring
        points = [(0.0, 0.0, 1.0)] + [(np.cos(2 * np.pi * k / ring) * np.sin(a), np.sin(2 * np.pi * k / ring) * np.sin(a), np.cos(a))
                                      for a in np.linspace(0, np.pi, rings)[1:-1] for k in range(ring)] + [(0.0, 0.0, -1.0)]
        facets = [[0, at(0, k), at(0, k + 1)] for k in range(ring)]
        facets += [f for r in range(rings - 3) for k in range(ring)
                   for f in ([at(r, k), at(r + 1, k), at(r, k + 1)], [at(r, k + 1), at(r + 1, k), at(r + 1, k + 1)])]
        facets += [[len(points) - 1, at(rings - 3, k + 1), at(rings - 3, k)] for k in range(ring)]
        plc = pgdr.Plc(turned(np.array(points), 5), facets=facets, markers=[3] * len(facets))
        old = pgdr.mesh(plc)
        new = pgdr.remesh(old, surface_tolerance=0.04)
        self.assertLess(new.input_points, len(points) / 4)
        # The meshes have other diagonals in the flat facets, from where on not quite the same is made of both.
        self.assertLess(abs(new.input_points / pgdr.mesh(plc, surface_tolerance=0.04).input_points - 1), 0.1)
        self.assertLessEqual(pgdr.check(new, old, surface_tolerance=0.04).exit_code, 1)


class Units(unittest.TestCase):
    def test_edges_are_so_long_on_average(self):
        for make, lengths in ((plates, (0.08, 0.02)), (boxes, (0.1, 0.05))):
            for length in lengths:
                made = pgdr.mesh(make(1), edge_length=length)
                edges = made.points[made.edges()]
                mean = np.linalg.norm(edges[:, 0] - edges[:, 1], axis=1).mean()
                self.assertLess(abs(mean / length - 1), 0.12, (make.__name__, length, mean))
                self.assertTrue(made.check(make(1)))
                self.assertTrue(same(made, pgdr.mesh(make(1), size=length, size_unit="edge")))

    def test_all_units(self):
        plc = boxes(0)
        made = pgdr.mesh(plc, size=1e-4, size_unit="volume")
        self.assertLessEqual(measures(made).max(), 1e-4)
        self.assertTrue(same(pgdr.mesh(plc, size=0.1, size_unit="radius"), pgdr.mesh(plc, size=0.1)))
        by_label = pgdr.mesh(plc, region_sizes={"core": 0.06}, size_unit="edge")
        self.assertTrue(same(by_label, pgdr.mesh(plc, region_sizes={12: 0.75 * 0.06})))
        field = pgdr.mesh(plates(0), size=lambda at: 0.03 + 0.05 * at[:, 0], size_unit="edge")
        self.assertTrue(same(field, pgdr.mesh(plates(0), size=lambda at: 0.625 * (0.03 + 0.05 * at[:, 0])**2)))
        for wrong in ({"size": 1, "size_unit": "area"}, {"size": 1, "edge_length": 1}, {"size": 1, "size_unit": "inch"},
                      {"edge_length": 1, "size_unit": "volume"}):
            with self.assertRaises(pgdr.UsageError):
                pgdr.mesh(plc, **wrong)
        with self.assertRaises(pgdr.UsageError):
            pgdr.mesh(plates(0), size=1, size_unit="volume")

    def test_what_was_made_by_edges_pickles_with_its_bounds(self):
        made = pgdr.mesh(plates(0), edge_length=pgdr.sizes_at_points([[0.0, 0.0]], [0.01], 0.1))
        self.assertTrue(pickle.loads(pickle.dumps(made)).check(plates(0)))


class Fields(unittest.TestCase):
    def test_what_comes_along(self):
        for make, size in ((plates, 0.05), (boxes, 0.15)):
            old = pgdr.mesh(make(1), edge_length=size)
            new = pgdr.remesh(old, edge_length=0.7 * size)
            transfer = pgdr.Transfer(old, new)
            gradient = np.arange(1.0, old.dimension + 1)
            np.testing.assert_allclose(transfer.points(old.points @ gradient), new.points @ gradient, rtol=0, atol=1e-12)
            tensor = np.einsum("ni,j->nij", old.points, gradient)
            self.assertEqual(transfer.points(tensor).shape, (len(new.points),) + tensor.shape[1:])
            np.testing.assert_allclose(transfer.points(tensor), np.einsum("ni,j->nij", new.points, gradient), rtol=0, atol=1e-12)
            random = np.random.default_rng(1)
            values = random.normal(size=(len(old.cells), 3))
            made = transfer.cells(values)
            for k in range(3):
                before, after = amounts(old, values[:, k]), amounts(new, made[:, k])
                scale = amounts(old, abs(values[:, k]))
                for label, sum_ in before.items():
                    self.assertLess(abs(after[label] - sum_), 1e-12 * scale[label])
            labels = transfer.cells(old.regions.astype(np.int16))
            self.assertEqual(labels.dtype, np.int16)
            np.testing.assert_array_equal(labels, new.regions)
            with self.assertRaises(pgdr.UsageError):
                transfer.points(values[:-1])

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "fields.vtu"
            old = pgdr.mesh(boxes(0), edge_length=0.3)
            points = {"u": old.points.copy(), "h": np.arange(len(old.points)), "marker": old.points[:, 0]}
            cells = {"region": measures(old), "tensor": np.arange(9.0 * len(old.cells)).reshape(-1, 9)}
            pgdr.write_fields(old, file, points, cells)
            self.assertTrue(same(old, pgdr.Mesh.read(file)) or len(pgdr.Mesh.read(file).point_of_input) == 0)
            np.testing.assert_array_equal(pgdr.Mesh.read(file).cells, old.cells)
            read = pgdr.read_fields(file)
            self.assertEqual((read.point_data.keys(), read.cell_data.keys()), (points.keys(), cells.keys()))
            for data, back in ((points, read.point_data), (cells, read.cell_data)):
                for name in data:
                    np.testing.assert_array_equal(back[name], data[name])
            with self.assertRaises(pgdr.UsageError):
                pgdr.write_fields(old, pathlib.Path(folder) / "fields.msh", points)


EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "tools" / "examples"


class Loop(unittest.TestCase):
    def setUp(self):
        if str(EXAMPLES) not in sys.path:
            sys.path.insert(0, str(EXAMPLES))

    def rounds(self, example, count, markers):
        """Each mesh is certified against the one before."""
        try:
            import scipy  # noqa: F401
        except ImportError:
            self.skipTest("scipy is not there")
        made = list(importlib.import_module(example).rounds(count))
        self.assertEqual(len(made), count)
        for before, after in zip(made, made[1:]):
            self.assertLess(after.error, 0.87 * before.error)
            self.assertLessEqual(pgdr.check(after.mesh, before.mesh).exit_code, 1)
            self.assertLessEqual(markers, set(after.mesh.markers))
            self.assertAlmostEqual(measures(after.mesh).sum(), measures(before.mesh).sum(), places=12)
        return made

    def test_the_error_falls_at_the_optimal_rate(self):
        """In an L and in a cube without an eighth, whose solutions are singular: the error times the root of the number of unknowns (in 3D
        the cube root) does not grow, while cells go where nothing happens."""
        for example, count, ratio in (("l_shape", 9, 500), ("fichera", 8, 2000)):
            with self.subTest(example):
                made = self.rounds(example, count, set(range(1, 7 if example == "l_shape" else 8)))
                root = 1 / made[0].mesh.dimension
                constants = [r.error * r.unknowns**root for r in made]
                self.assertLess(max(constants[4:]), 1.05 * constants[3])
                self.assertLess(made[-1].error, 0.1 * made[0].error)
                for r in made[3:]:
                    self.assertLess(abs(r.estimate / r.error - 1), 0.2)
                sizes = measures(made[-1].mesh)
                self.assertGreater(sizes.max(), ratio * sizes.min())
                self.assertLess(made[1].unknowns, made[0].unknowns)

    def test_a_mesh_follows_a_source(self):
        """As many cells in each step to a tenth, and nothing of what was left is lost."""
        import moving_source
        made = list(moving_source.steps(20))
        self.assertEqual(len(made), 20)
        cells = [len(step.mesh.cells) for step in made]
        self.assertLess(max(cells), 1.1 * min(cells))
        for k, step in enumerate(made):
            self.assertAlmostEqual(moving_source.integral(step), k + 1, delta=1e-12 * (k + 1))
            self.assertGreaterEqual(step.left.min(), 0)
        for before, after in zip(made, made[1:]):
            self.assertTrue(pgdr.check(after.mesh, before.mesh))
        self.assertEqual(moving_source.picture(made[-1]).count("<path"), cells[-1])

    def test_sizes_from_error(self):
        mesh = pgdr.mesh(plates(0), edge_length=0.1)
        eta = np.ones(len(mesh.cells))
        same_size = pgdr.sizes_from_error(mesh, eta, np.sqrt(len(mesh.cells)))
        np.testing.assert_allclose(same_size, measures(mesh) / 0.645, rtol=1e-12)
        self.assertLess(pgdr.sizes_from_error(mesh, eta, 1).max(), same_size.min())
        np.testing.assert_allclose(pgdr.sizes_from_error(mesh, 0 * eta, 1), 4 * same_size, rtol=1e-12)
        for wrong in ({"eta": -eta, "target": 1}, {"eta": eta[1:], "target": 1}, {"eta": eta, "target": 0}):
            with self.assertRaises(pgdr.UsageError):
                pgdr.sizes_from_error(mesh, **wrong)


if __name__ == "__main__":
    unittest.main()
