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


def stiffness(points, cells):
    """Of linear elements for the Laplacian."""
    matrix = np.zeros((len(points), len(points)))
    for cell_ in cells:
        p = points[cell_]
        gradients = np.linalg.solve(np.c_[np.ones(3), p], np.eye(3))[1:]
        area = 0.5 * abs(np.linalg.det(np.c_[np.ones(3), p]))
        matrix[np.ix_(cell_, cell_)] += area * gradients.T @ gradients
    return matrix


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
        of = np.arange(len(r.points))
        for _ in range(3):  # chains of corners
            for p in r.periodic:
                least = np.minimum(of[p.points[:, 0]], of[p.points[:, 1]])
                of[p.points[:, 0]] = of[p.points[:, 1]] = least
        unknowns, column = np.unique(of, return_inverse=True)
        fold = np.zeros((len(r.points), len(unknowns)))
        fold[np.arange(len(r.points)), column] = 1
        matrix, gradient = stiffness(r.points, r.cells), r.points @ [0.7, -1.3]
        folded = fold.T @ matrix @ fold
        w = np.linalg.lstsq(folded, -fold.T @ matrix @ gradient, rcond=None)[0]
        self.assertLess(len(unknowns), len(r.points) - 10)
        self.assertLess(np.ptp(w), 1e-12)

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
        self.assertEqual(pgdr.mesh(cell()).periodic, [])


if __name__ == "__main__":
    unittest.main()
