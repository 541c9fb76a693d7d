# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""`pgdr.triangulate`: keys, shapes, types and switches as users of the package `triangle` know them."""
import unittest

import numpy as np

import pgdr

SQUARE = {"vertices": [[0, 0], [1, 0], [1, 1], [0, 1]], "segments": [[0, 1], [1, 2], [2, 3], [3, 0]]}
INNER = [[0.25, 0.25], [0.75, 0.25], [0.75, 0.75], [0.25, 0.75]]
RING = {"vertices": SQUARE["vertices"] + INNER, "segments": SQUARE["segments"] + [[4, 5], [5, 6], [6, 7], [7, 4]]}


def areas(made):
    a, b, c = made["vertices"][made["triangles"]].transpose(1, 0, 2)
    return ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2


def smallest_angle(made):
    corners = made["vertices"][made["triangles"]]
    least = 180.0
    for i in range(3):
        u, v = corners[:, (i + 1) % 3] - corners[:, i], corners[:, (i + 2) % 3] - corners[:, i]
        cosine = (u * v).sum(axis=1) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1)
        least = min(least, np.degrees(np.arccos(cosine)).min())
    return least


class Triangulate(unittest.TestCase):
    def made(self, tri, opts, area=1.0):
        """What comes of it, with the check of pgdr (switch C), and with this total area."""
        made = pgdr.triangulate(tri, opts + "C")
        self.assertGreater(areas(made).min(), 0)
        self.assertAlmostEqual(areas(made).sum(), area, places=12)
        return made

    def test_types_and_shapes(self):
        made = self.made(SQUARE, "pen")
        expected = {"vertices": ("float64", (4, 2)), "vertex_markers": ("int32", (4, 1)), "triangles": ("int32", (2, 3)),
                    "segments": ("int32", (4, 2)), "segment_markers": ("int32", (4, 1)), "edges": ("int32", (5, 2)),
                    "edge_markers": ("int32", (5, 1)), "neighbors": ("int32", (2, 3))}
        self.assertEqual({key: (value.dtype.name, value.shape) for key, value in made.items()}, expected)
        self.assertEqual(made["vertices"].tolist(), SQUARE["vertices"])
        self.assertEqual(made["vertex_markers"].ravel().tolist(), [1] * 4)
        self.assertEqual(sorted(made["edge_markers"].ravel().tolist()), [0, 1, 1, 1, 1])
        self.assertEqual(sorted(made["neighbors"].ravel().tolist()), [-1, -1, -1, -1, 0, 1])

    def test_neighbors_lie_opposite_the_corners(self):
        made = self.made(SQUARE, "pqa0.01n")
        for triangle, beyond in zip(made["triangles"], made["neighbors"]):
            for i in range(3):
                if beyond[i] >= 0:
                    shared = {triangle[(i + 1) % 3], triangle[(i + 2) % 3]}
                    self.assertTrue(shared <= set(made["triangles"][beyond[i]].tolist()))

    def test_angles_and_areas(self):
        made = self.made(SQUARE, "pq30a0.01")
        self.assertLessEqual(areas(made).max(), 0.01)
        self.assertGreaterEqual(smallest_angle(made), 30 - 1e-9)
        self.assertGreaterEqual(smallest_angle(self.made({"vertices": [[0, 0], [9, 0], [9, 1]], "segments": [[0, 1], [1, 2], [2, 0]]},
                                                         "pa0.1", area=4.5)), 0)

    def test_without_p_the_hull_is_filled(self):
        made = self.made({"vertices": SQUARE["vertices"] + [[0.5, 0.25]]}, "")
        self.assertEqual(sorted(made), ["triangles", "vertex_markers", "vertices"])
        self.assertEqual(len(made["triangles"]), 4)
        self.assertEqual(made["vertex_markers"].ravel().tolist(), [1, 1, 1, 1, 0])

    def test_c_fills_an_open_outline(self):
        self.made({"vertices": SQUARE["vertices"], "segments": SQUARE["segments"][:3]}, "pc")

    def test_holes_and_unused_vertices(self):
        hole = {**RING, "vertices": RING["vertices"] + [[0.5, 0.5]], "holes": [[0.4, 0.5]]}
        self.assertEqual(len(self.made(hole, "p", area=0.75)["vertices"]), 9)
        self.assertEqual(len(self.made(hole, "pj", area=0.75)["vertices"]), 8)
        self.assertEqual(len(self.made(hole, "pO")["vertices"]), 9)

    def test_regions(self):
        regions = {**RING, "regions": [[0.5, 0.5, 7, 0.002], [0.1, 0.1, 3, 0]]}
        made = self.made(regions, "pqaA")
        labels = made["triangle_attributes"]
        self.assertEqual(labels.shape, (len(made["triangles"]), 1))
        inner = labels[:, 0] == 7
        self.assertAlmostEqual(areas(made)[inner].sum(), 0.25, places=12)
        self.assertLessEqual(areas(made)[inner].max(), 0.002)
        self.assertLess(len(self.made(regions, "pqA")["triangles"]), len(made["triangles"]))
        labels = self.made({**RING, "regions": [[0.5, 0.5, 0.001], [0.1, 0.1, 3]]}, "pqaA")  # without areas
        self.assertEqual(set(labels["triangle_attributes"][:, 0]), {0.001, 3})
        self.assertLess(len(labels["triangles"]), 200)

    def test_markers_and_attributes_are_handed_on(self):
        marked = {**SQUARE, "segment_markers": [[5], [0], [6], [0]], "vertex_attributes": [[0.0], [1.0], [1.0], [0.0]]}
        made = self.made(marked, "pqa0.01")
        middle = made["vertices"][made["segments"]].mean(axis=1)
        below, above = middle[:, 1] == 0, middle[:, 1] == 1
        self.assertEqual(set(made["segment_markers"][below].ravel()), {5})
        self.assertEqual(set(made["segment_markers"][above].ravel()), {6})
        self.assertEqual(set(made["segment_markers"][~below & ~above].ravel()), {1})
        np.testing.assert_allclose(made["vertex_attributes"][:, 0], made["vertices"][:, 0], atol=1e-12)

    def test_duplicates_keep_the_numbers(self):
        made = self.made({"vertices": [[0, 0], [0, 0], [1, 0], [1, 1], [0, 1]], "segments": [[0, 2], [2, 3], [3, 4], [4, 1]]}, "pe")
        self.assertEqual(made["vertices"].tolist(), [[0, 0], [0, 0], [1, 0], [1, 1], [0, 1]])
        self.assertNotIn(1, made["triangles"])
        self.assertNotIn(1, made["edges"])

    def test_crossing_segments_are_split(self):
        made = self.made({"vertices": SQUARE["vertices"], "segments": SQUARE["segments"] + [[0, 2], [1, 3]]}, "p")
        self.assertEqual(made["vertices"].tolist(), SQUARE["vertices"] + [[0.5, 0.5]])
        self.assertEqual(len(made["triangles"]), 4)

    def test_steiner_points(self):
        made = self.made(SQUARE, "pqa0.01Y")
        self.assertEqual(len(made["segments"]), 4)
        self.assertLessEqual(len(pgdr.triangulate(SQUARE, "pqa0.0001S10C")["vertices"]), 14)

    def test_what_is_left_out(self):
        self.assertEqual(sorted(pgdr.triangulate(SQUARE, "pBPQzC")), ["triangles", "vertices"])
        self.assertEqual(sorted(pgdr.triangulate(SQUARE, "pNEVC")), ["segment_markers", "segments"])

    def test_results_are_inputs(self):
        self.made(self.made(SQUARE, "p"), "pq30a0.1")

    def test_refusals_name_the_switch(self):
        for opts, word in (("pr", "r of"), ("pqDY", "conforming"), ("ps", "s of"), ("pu", "u and size"), ("po3", "o of"), ("po", "o of"),
                           ("pk", "'k'"), ("p3", "no number"), ("pS", "whole number"), ("pqa1.2.3", "1.2.3")):
            with self.subTest(opts), self.assertRaises(pgdr.UsageError) as caught:
                pgdr.triangulate(SQUARE, opts)
            self.assertIn(word, str(caught.exception))

    def test_refusals_of_keys_and_arrays(self):
        for tri, opts in (({"segments": [[0, 1]]}, "p"), ({**SQUARE, "segmnts": 1}, "p"), (SQUARE, "q"),
                          ({**SQUARE, "regions": [[0.5, 0.5]]}, "p"), ({"vertices": [[0, 0, 0]]}, ""),
                          ({**SQUARE, "segments": [[0, 1, 2]]}, "p"), ({**SQUARE, "segment_markers": [1, 2]}, "p")):
            with self.subTest(tri=tri), self.assertRaises(pgdr.UsageError):
                pgdr.triangulate(tri, opts)
        with self.assertRaises(TypeError):
            pgdr.triangulate(SQUARE, 5)


if __name__ == "__main__":
    unittest.main()
