# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Another surface within a tolerance."""
import math
import unittest

import numpy as np

import pgdr


def ball(n=24):
    """A sphere of radius 1, n points a ring."""
    rings = [[(math.cos(2 * math.pi * k / n) * math.sin(a), math.sin(2 * math.pi * k / n) * math.sin(a), math.cos(a))
              for k in range(n)] for a in (math.pi * r / (n // 2) for r in range(1, n // 2))]
    points = np.array([(0.0, 0.0, 1.0)] + [p for ring in rings for p in ring] + [(0.0, 0.0, -1.0)])
    at = lambda ring, k: 1 + ring * n + k % n  # noqa: E731
    facets = [(0, at(0, k), at(0, k + 1)) for k in range(n)]
    for r in range(len(rings) - 1):
        for k in range(n):
            facets += [(at(r, k), at(r + 1, k), at(r, k + 1)), (at(r, k + 1), at(r + 1, k), at(r + 1, k + 1))]
    facets += [(len(points) - 1, at(len(rings) - 1, k + 1), at(len(rings) - 1, k)) for k in range(n)]
    return pgdr.Plc(points, facets=facets, markers=[7] * len(facets))


class Surface(unittest.TestCase):
    def test_replaced(self):
        plc = ball()
        made = pgdr.replace_surface(plc, 0.03)
        self.assertLess(made.report["triangles"][1], made.report["triangles"][0])
        self.assertEqual(len(made.facet_of_input), len(made.plc.facets))
        self.assertLess(np.abs(np.linalg.norm(made.plc.points, axis=1) - 1).max(), 0.05)
        mesh = pgdr.mesh(made.plc)
        self.assertTrue(pgdr.check(mesh, plc, surface_tolerance=0.03))
        self.assertFalse(pgdr.check(mesh, plc, surface_tolerance=0.003))
        self.assertEqual(set(mesh.subfacet_markers), {7})
        percent = pgdr.replace_surface(plc, f"{100 * 0.03 / (2 * math.sqrt(3))}%")
        self.assertLess(abs(percent.report["length"] - 0.03), 0.001)

    def test_meshed(self):
        plc = ball()
        mesh = pgdr.mesh(plc, surface_tolerance="1%")
        self.assertTrue(pgdr.check(mesh, plc, surface_tolerance="1%"))
        self.assertEqual(mesh.surface["triangles"][0], len(plc.facets))
        self.assertIsNone(pgdr.mesh(plc).surface)

    def test_refused(self):
        for tolerance in (0, -1, 1e-17, "x"):
            with self.assertRaises(pgdr.UsageError):
                pgdr.replace_surface(ball(8), tolerance)
        with self.assertRaises(pgdr.UsageError):
            pgdr.replace_surface(pgdr.Plc([[0, 0], [1, 0], [0, 1]], segments=[[0, 1], [1, 2], [2, 0]]), 0.1)
        with self.assertRaises(pgdr.InputError):
            pgdr.replace_surface(ball(8), "30%")


if __name__ == "__main__":
    unittest.main()
