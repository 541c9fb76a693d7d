# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Twenty tasks of a stranger, each with what the package alone offers."""
import os
import pickle
import tempfile
import threading
import unittest

import numpy as np

import pgdr

SQUARE = np.array([[0, 0], [2, 0], [2, 2], [0, 2]])
RING = [[0, 1], [1, 2], [2, 3], [3, 0]]
BOX = np.array([[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)])
SIDES = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]


def area(mesh):
    a, b, c = mesh.points[mesh.cells.astype(int)].transpose(1, 0, 2)
    return 0.5 * float(((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]).sum())


class Tasks(unittest.TestCase):
    def setUp(self):
        self.square, self.box = pgdr.Plc(SQUARE, RING), pgdr.Plc(BOX, facets=SIDES)

    def done(self, mesh, plc):
        report = mesh.check(plc)
        self.assertTrue(report, report)
        return mesh

    def test_01_a_square_without_small_angles(self):
        r = self.done(pgdr.mesh(self.square, min_angle=30, size=0.01), self.square)
        self.assertGreaterEqual(r.quality()["min_angle_deg"], 30)
        self.assertAlmostEqual(area(r), 4)

    def test_02_a_hole(self):
        plc = pgdr.Plc.from_polygons(SQUARE, holes=[[[.5, .5], [1.5, .5], [1.5, 1.5], [.5, 1.5]]])
        self.assertAlmostEqual(area(self.done(pgdr.mesh(plc), plc)), 3)

    def test_03_a_hole_by_its_seed(self):
        plc = pgdr.Plc(np.vstack([SQUARE, SQUARE / 2 + 0.5]), RING + [[a + 4, b + 4] for a, b in RING], holes=[[1, 1]])
        self.assertAlmostEqual(area(self.done(pgdr.mesh(plc), plc)), 3)

    def test_04_regions_with_labels_and_areas(self):
        plc = pgdr.Plc(np.vstack([SQUARE, SQUARE / 2 + 0.5]), RING + [[a + 4, b + 4] for a, b in RING],
                       regions=[(0.1, 0.1, 1), (1, 1, 2, 0.01)])
        r = self.done(pgdr.mesh(plc), plc)
        self.assertGreater((r.regions == 2).sum(), 100)

    def test_05_what_is_inside_by_nesting(self):
        plc = pgdr.Plc(np.vstack([SQUARE, SQUARE / 2 + 0.5]), RING + [[a + 4, b + 4] for a, b in RING])
        self.assertAlmostEqual(area(self.done(pgdr.mesh(plc, regions="auto"), plc)), 3)

    def test_06_boundary_conditions_by_marker(self):
        plc = pgdr.Plc(SQUARE, RING, markers=[10, 20, 30, 40])
        r = self.done(pgdr.mesh(plc, size=0.05), plc)
        left = r.points[r.subsegments[r.markers == 40]]
        self.assertTrue((left[..., 0] == 0).all() and len(left) > 1)

    def test_07_a_box_of_tetrahedra_without_slivers(self):
        r = self.done(pgdr.mesh(self.box, size=0.2, min_dihedral=15), self.box)
        self.assertGreaterEqual(r.quality()["min_angle_deg"], 15)

    def test_08_a_delaunay_mesh(self):
        r = self.done(pgdr.mesh(self.box, size=0.3, optimize=False), self.box)
        self.assertTrue(pgdr.check(r, self.box, delaunay=True, radius_edge=2))

    def test_09_sizes_by_a_function(self):
        def f(at):
            return 0.001 + 0.05 * at[:, 0]
        r = self.done(pgdr.mesh(self.square, size=f), self.square)
        centres = r.points[r.cells.astype(int)].mean(axis=1)
        self.assertGreater((centres[:, 0] < 0.5).sum(), 2 * (centres[:, 0] > 1.5).sum())

    def test_10_sizes_at_points(self):
        r = self.done(pgdr.mesh(self.box, size=pgdr.sizes_at_points([[0, 0, 0]], [0.05], 0.5)), self.box)
        self.assertGreater(len(r.cells), 100)

    def test_11_points_of_my_own(self):
        plc = pgdr.Plc([[0, 0], [4, 0], [4, 0.5], [0, 0.5], [0.02, 0.01]], RING)
        asked = []

        def middle(elements):
            asked.append(len(elements.circumradius))
            return elements.disk_center
        self.done(pgdr.mesh(plc, selector=middle), plc)
        self.assertTrue(asked)

    def test_12_what_is_wrong_with_my_input(self):
        plc = pgdr.Plc(np.vstack([SQUARE, [[1, -1], [1, 3]]]), RING + [[4, 5]])
        with self.assertRaises(pgdr.InputError) as caught:
            pgdr.mesh(plc)
        self.assertEqual(caught.exception.code, "entities_intersect")
        self.assertTrue([f for f in pgdr.diagnose(plc) if f.is_error])

    def test_13_mend_it(self):
        plc = pgdr.Plc(np.vstack([SQUARE, [[1, -1], [1, 3]]]), RING + [[4, 5]])
        split, repairs = pgdr.resolve_crossings(plc)
        self.done(pgdr.mesh(split), split)
        self.assertEqual(len(repairs), 1)

    def test_14_stop_after_a_while(self):
        stop = pgdr.StopSource()
        threading.Timer(0.2, stop.stop).start()
        r = pgdr.mesh(self.box, size=0.003, stop=stop)
        self.assertEqual(r.stop, "cancelled")
        self.assertTrue(pgdr.check(r, self.box))

    def test_15_every_format_there_and_back(self):
        r = self.done(pgdr.mesh(self.box, size=0.3), self.box)
        with tempfile.TemporaryDirectory() as folder:
            for name in ("a.vtu", "a.msh", "a.mesh"):
                r.write(os.path.join(folder, name))
                self.assertTrue(pgdr.check(pgdr.Mesh.read(os.path.join(folder, name)), self.box))

    def test_16_one_thread_or_four(self):
        one, four = (pgdr.mesh(self.box, size=0.1, threads=t) for t in (1, 4))
        self.assertTrue(np.array_equal(one.points, four.points) and np.array_equal(one.cells, four.cells))

    def test_17_send_a_mesh_to_another_process(self):
        r = self.done(pgdr.mesh(self.box, size=0.3), self.box)
        self.assertTrue(np.array_equal(pickle.loads(pickle.dumps(r)).cells, r.cells))

    def test_18_two_meshes_at_once(self):
        made = {}
        threads = [threading.Thread(target=lambda s=s: made.update({s: pgdr.mesh(self.box, size=s)})) for s in (0.1, 0.15)]
        for t in threads:
            t.start()
        for t in threads:
            t.join()
        for r in made.values():
            self.done(r, self.box)

    def test_19_neighbours_edges_and_a_picture(self):
        r = self.done(pgdr.mesh(self.square, size=0.1), self.square)
        self.assertEqual(len(r.points) - len(r.edges()) + len(r.cells), 1)  # Euler
        self.assertEqual((r.neighbors() < 0).sum(), len(r.subsegments))
        self.assertIn("<svg", r._repr_html_())

    def test_20_as_with_triangle_and_tetgen(self):
        made = pgdr.triangulate(dict(vertices=SQUARE, segments=RING), "pq30a0.1")
        self.assertEqual(made["triangles"].shape[1], 3)
        solid = pgdr.tetrahedralize(BOX, SIDES, minratio=2, mindihedral=10)
        nodes, elements = solid
        self.assertEqual((nodes.shape[1], elements.shape[1]), (3, 4))
        self.done(solid.mesh, self.box)


if __name__ == "__main__":
    unittest.main()
