# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Sides that correspond, and what stands on them: finite elements with periodic ends."""
import math
import pickle
import tempfile
import unittest

import numpy as np

import pgdr


def cell(shear=0.0, radius=0.1):
    corners = np.array([[0, 0], [1, 0], [1 + shear, 1], [shear, 1]])
    angle = np.arange(12) * np.pi / 6
    disk = np.c_[0.8 + radius * np.cos(angle), 0.3 + radius * np.sin(angle)]
    segments = [[i, (i + 1) % 4] for i in range(4)] + [[4 + i, 4 + (i + 1) % 12] for i in range(12)]
    return pgdr.Plc(np.concatenate([corners, disk]), segments=segments, markers=[1, 2, 3, 4] + [9] * 12)


def box(shear=(0.0, 0.0, 0.0)):
    """A cell of a crystal: markers 1, 2 at the ends of the first axis, 3, 4 and 5, 6 of the others."""
    axes = np.array([[1, 0, 0], [shear[0], 1, 0], [shear[1], shear[2], 1]])
    corners = np.array([[v & 1, v >> 1 & 1, v >> 2] for v in range(8)]) @ axes
    faces = [[0, 2, 6, 4], [1, 3, 7, 5], [0, 4, 5, 1], [2, 6, 7, 3], [0, 1, 3, 2], [4, 5, 7, 6]]
    return pgdr.Plc(corners, facets=faces, markers=[1, 2, 3, 4, 5, 6])


def stiffness(points, cells, conductivity=None):
    """Of linear elements for the Laplacian."""
    n = len(cells[0])
    matrix = np.zeros((len(points), len(points)))
    for c, cell_ in enumerate(cells):
        p = points[cell_]
        gradients = np.linalg.solve(np.c_[np.ones(n), p], np.eye(n))[1:]
        measure = abs(np.linalg.det(np.c_[np.ones(n), p])) / math.factorial(n - 1)
        matrix[np.ix_(cell_, cell_)] += (1 if conductivity is None else conductivity[c]) * measure * gradients.T @ gradients
    return matrix


def folded(r):
    """(vertices, unknowns): ones where a vertex is an unknown, as all that are one with it are."""
    of = np.arange(len(r.points))
    for _ in range(4):  # chains of corners
        for p in r.periodic:
            least = np.minimum(of[p.points[:, 0]], of[p.points[:, 1]])
            of[p.points[:, 0]] = of[p.points[:, 1]] = least
    unknowns, column = np.unique(of, return_inverse=True)
    fold = np.zeros((len(r.points), len(unknowns)))
    fold[np.arange(len(r.points)), column] = 1
    return fold


class Periodic(unittest.TestCase):
    def test_pairs(self):
        for shear in (0.0, 0.3):
            plc = cell(shear)
            r = pgdr.mesh(plc, size=lambda at: 0.001 + 0.01 * at[:, 0], periodic=[(4, 2), (1, 3)])
            self.assertTrue(r.check(plc))
            self.assertEqual([(p.from_marker, p.to_marker) for p in r.periodic], [(4, 2), (1, 3)])
            for p in r.periodic:
                self.assertEqual((p.exact, p.largest_gap, p.walls + 1), (len(p.points), 0, len(p.points)))
                images = r.points[p.points[:, 0]] @ p.motion[:, :2].T + p.motion[:, 2]
                self.assertTrue(np.array_equal(images, r.points[p.points[:, 1]]))
            self.assertEqual(len(r.point_of_input), len(plc.points))
            self.assertTrue(np.array_equal(r.points[r.point_of_input], plc.points))
            again = pickle.loads(pickle.dumps(r))
            with tempfile.TemporaryDirectory() as folder:
                for mesh, name in ((r, "one.msh"), (again, "other.msh")):
                    mesh.write(f"{folder}/{name}")
                with open(f"{folder}/one.msh", "rb") as one, open(f"{folder}/other.msh", "rb") as other:
                    bytes_ = one.read()
                    self.assertEqual(bytes_, other.read())
                self.assertIn(b"$Periodic\n", bytes_)

    def test_a_linear_field(self):
        """u(x) = g x + w(x) with w periodic: the energy has its least at w = 0 in a cell without holes, to rounding."""
        plc = pgdr.Plc(cell(0.25).points[:4], segments=[[0, 1], [1, 2], [2, 3], [3, 0]], markers=[1, 2, 3, 4])
        r = pgdr.mesh(plc, size=lambda at: 0.002 + 0.01 * at[:, 1], periodic=[(4, 2), (1, 3)])
        fold = folded(r)
        matrix, gradient = stiffness(r.points, r.cells), r.points @ [0.7, -1.3]
        w = np.linalg.lstsq(fold.T @ matrix @ fold, -fold.T @ matrix @ gradient, rcond=None)[0]
        self.assertLess(fold.shape[1], len(r.points) - 10)
        self.assertLess(np.ptp(w), 1e-12)

    def test_cells_of_crystals(self):
        """The same in space, in a cell whose edges and corners are shared by three pairs; and a layered one, whose effective
        conductivity is known."""
        plc = box((0.3, -0.2, 0.25))
        r = pgdr.mesh(plc, size=0.25, periodic=[(1, 2), (3, 4), (5, 6)])
        self.assertTrue(r.check(plc))
        self.assertEqual(len(r.periodic), 3)
        for p in r.periodic:
            self.assertEqual(p.motion.shape, (3, 4))
            self.assertLess(p.largest_gap, 1e-15)
        fold = folded(r)
        matrix, gradient = stiffness(r.points, r.cells), r.points @ [0.7, -1.3, 0.4]
        w = np.linalg.lstsq(fold.T @ matrix @ fold, -fold.T @ matrix @ gradient, rcond=None)[0]
        self.assertLess(fold.shape[1], len(r.points) - 20)
        self.assertLess(np.ptp(w), 1e-12)

        other = pgdr.mesh(plc, size=0.25, periodic=[(1, 2), (3, 4), (5, 6)], surface_tolerance="1%")  # all of it are sides
        self.assertTrue(other.check(plc))
        self.assertEqual(len(other.periodic), 3)

        points = [[x, y, z] for x in (0, 0.5, 1) for y in (0, 1) for z in (0, 1)]
        facets, markers = [[0, 1, 3, 2], [4, 5, 7, 6], [8, 9, 11, 10]], [1, 9, 2]
        for half in (0, 4):
            facets += [[half, half + 1, half + 5, half + 4], [half + 2, half + 3, half + 7, half + 6],
                       [half, half + 2, half + 6, half + 4], [half + 1, half + 3, half + 7, half + 5]]
            markers += [3, 4, 5, 6]
        layered = pgdr.Plc(points, facets=facets, markers=markers, regions=[[0.2, 0.5, 0.5, 1], [0.8, 0.5, 0.5, 2]])
        r = pgdr.mesh(layered, size=0.3, periodic=[(1, 2), (3, 4), (5, 6)])
        self.assertTrue(r.check(layered))
        fold, conductivity = folded(r), np.where(r.regions == 1, 1.0, 3.0)
        matrix = stiffness(r.points, r.cells, conductivity)
        for direction, known in ((0, 1.5), (1, 2.0), (2, 2.0)):  # harmonic and arithmetic mean of 1 and 3
            linear = r.points[:, direction]
            u = linear + fold @ np.linalg.lstsq(fold.T @ matrix @ fold, -fold.T @ matrix @ linear, rcond=None)[0]
            self.assertAlmostEqual(u @ matrix @ u, known, places=12)

    def test_a_sector(self):
        c, s = 0.5, math.sqrt(0.75)
        plc = pgdr.Plc([[0, 0], [2, 0], [2 * c, 2 * s]], segments=[[0, 1], [1, 2], [2, 0]], markers=[1, 2, 3])
        r = pgdr.mesh(plc, size=0.01, periodic=[(1, 3, [[c, -s, 0], [s, c, 0]])])
        self.assertTrue(r.check(plc))
        self.assertLess(r.periodic[0].largest_gap, 1e-15)

    def test_refused(self):
        for wrong in ([(4, 4)], [(4, 7)], [(4, 3)], [(4, 2, [1, 0])], [(4,)], ["42"], [(4, 2, [1, 0, 1, 0, 2, 0])]):
            with self.assertRaises(pgdr.UsageError):
                pgdr.mesh(cell(), periodic=wrong)
        corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
        with self.assertRaises(pgdr.UsageError):
            pgdr.mesh(pgdr.with_convex_hull(pgdr.Plc(corners)), periodic=[(1, 2)])
        with self.assertRaises(pgdr.UsageError):
            pgdr.mesh(box(), periodic=[(1, 2, [1, 0, 1, 0, 1, 0])])
        self.assertEqual(pgdr.mesh(cell()).periodic, [])


if __name__ == "__main__":
    unittest.main()
