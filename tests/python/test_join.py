# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes that are joined."""
import unittest

import numpy as np

import pgdr


def tile(low, high, parts, **options):
    """A rectangle whose sides are so many segments each."""
    corners = np.array([low, (high[0], low[1]), high, (low[0], high[1])], dtype=float)
    points = np.concatenate([a + (b - a) * np.arange(parts)[:, None] / parts for a, b in zip(corners, np.roll(corners, -1, 0))])
    n = len(points)
    segments = [[i, (i + 1) % n] for i in range(n)]
    plc = pgdr.Plc(points, segments=segments, markers=np.arange(n) // parts + 1)
    return pgdr.mesh(plc, keep_boundary=True, **options)


class Join(unittest.TestCase):
    def test_joined(self):
        meshes = [tile((0, 0), (1, 1), 4, size=0.01), tile((1, 0), (2, 1), 4, size=0.1), tile((0, 1), (1, 2), 4)]
        joined = pgdr.join(meshes, relabel=True)
        self.assertTrue(pgdr.check(joined.mesh))
        self.assertEqual(joined.interfaces, [pgdr.Shared((0, 1), (2, 4), 4), pgdr.Shared((0, 2), (3, 1), 4)])
        self.assertEqual(joined.labels, [pgdr.JoinedLabel(m, 0, m + 1) for m in range(3)])
        self.assertEqual(joined.shared_points, 9)
        self.assertEqual(joined.warnings, [])
        for m, mesh in enumerate(meshes):
            cells = joined.mesh.cells[joined.first_cell[m]:joined.first_cell[m + 1]]
            self.assertTrue(np.array_equal(cells, joined.vertices[m][mesh.cells]))
            self.assertTrue(np.array_equal(joined.mesh.points[joined.vertices[m]], mesh.points))
            self.assertEqual(set(joined.mesh.regions[joined.first_cell[m]:joined.first_cell[m + 1]]), {m + 1})

    def test_refused(self):
        a, b = tile((0, 0), (1, 1), 2), tile((1, 0), (2, 1), 4)
        with self.assertRaises(pgdr.InputError) as caught:
            pgdr.join([a, b], names=["left", "right"])
        self.assertEqual({d.code for d in caught.exception.diagnostics}, {"point_on_segment"})
        self.assertIn("of right lies inside the edge with the vertices", str(caught.exception))
        for wrong in ([], [a, pgdr.Mesh.from_arrays(np.eye(4, 3), [[3, 0, 1, 2]])]):
            with self.assertRaises(pgdr.UsageError):
                pgdr.join(wrong)
        with self.assertRaises(TypeError):
            pgdr.join([a, "b.vtu"])
        with self.assertRaises(pgdr.UsageError):
            pgdr.join([a, b], names=["left"])


if __name__ == "__main__":
    unittest.main()
