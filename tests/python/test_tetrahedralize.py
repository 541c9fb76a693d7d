# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""`pgdr.tetrahedralize`: keywords and switches as users of PyVista's `tetgen` and of `meshpy.tet` know them."""
import unittest

import numpy as np

import pgdr

POINTS = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
BOX = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]


def volumes(made):
    a, b, c, d = made.nodes[made.elems].transpose(1, 0, 2)
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


def ratios(made):
    """Circumradius over shortest edge."""
    corners = made.nodes[made.elems]
    rows = corners[:, 1:] - corners[:, :1]
    centers = np.linalg.solve(rows, (rows ** 2).sum(axis=2)[:, :, None] / 2)[:, :, 0]
    edges = [np.linalg.norm(corners[:, i] - corners[:, j], axis=1) for i in range(4) for j in range(i)]
    return np.linalg.norm(centers, axis=1) / np.min(edges, axis=0)


class Tetrahedralize(unittest.TestCase):
    def made(self, *arguments, **keywords):
        """The unit box, and its check against the input."""
        made = pgdr.tetrahedralize(POINTS, BOX, *arguments, **keywords)
        plc = pgdr.Plc(POINTS, facets=BOX, **{key: keywords[key] for key in ("markers", "holes", "regions") if key in keywords})
        self.assertTrue(pgdr.check(made.mesh, plc))
        self.assertGreater(volumes(made).min(), 0)
        self.assertAlmostEqual(volumes(made).sum(), 1, places=12)
        return made

    def test_unpacks_as_tetgen(self):
        made = self.made(order=1, mindihedral=20, minratio=1.5)
        nodes, elems = made
        self.assertEqual((nodes.dtype.name, nodes.shape[1], elems.dtype.name, elems.shape[1]), ("float64", 3, "int32", 4))
        self.assertEqual(nodes[:8].tolist(), POINTS)
        self.assertLessEqual(ratios(made).max(), 1.5 + 1e-9)
        self.assertIs(made[0], nodes)
        self.assertEqual(len(made), 2)

    def test_names_of_meshpy(self):
        made = self.made(max_volume=0.01, markers=[1, 2, 3, 4, 5, 6])
        self.assertLessEqual(volumes(made).max(), 0.01)
        self.assertEqual(set(made.face_markers.tolist()), {1, 2, 3, 4, 5, 6})
        corners = made.points[made.faces]
        self.assertTrue((corners[made.face_markers == 2][:, :, 2] == 1).all())
        self.assertEqual(made.elements.tolist(), made.elems.tolist())
        self.assertEqual(set(made.attributes.tolist()), {0.0})

    def test_switches_say_what_keywords_say(self):
        for switches, keywords in (("pq1.5/18a0.01", {"minratio": 1.5, "mindihedral": 18, "max_volume": 0.01}),
                                   ("-pqS40", {"steinerleft": 40}), ("pqzQVfen", {})):
            with self.subTest(switches):
                one, other = self.made(switches=switches), self.made(**keywords)
                self.assertEqual(one.nodes.tobytes(), other.nodes.tobytes())
                self.assertEqual(one.elems.tobytes(), other.elems.tobytes())

    def test_p_alone_adds_nothing(self):
        self.assertEqual(self.made(switches="p").nodes.tolist(), POINTS)

    def test_the_surface_may_be_kept(self):
        one, other = self.made(switches="pqa0.01YC"), self.made(max_volume=0.01, nobisect=True)
        self.assertEqual(one.nodes.tobytes(), other.nodes.tobytes())
        self.assertEqual(len(one.faces), 12)
        self.assertLess(int(one.faces.max()), len(POINTS))
        self.assertGreater(len(one.nodes), len(POINTS))

    def test_regions(self):
        regions = [[0.5, 0.5, 0.5, 7, 0.005]]
        made = self.made(switches="pqaAC", regions=regions)
        self.assertEqual(set(made.attributes.tolist()), {7.0})
        self.assertLessEqual(volumes(made).max(), 0.005)
        self.assertLess(len(pgdr.tetrahedralize(POINTS, BOX, switches="pqAC", regions=regions).elems), len(made.elems))

    def test_a_plc_has_its_own_faces(self):
        plc = pgdr.Plc(POINTS, facets=BOX)
        self.assertEqual(pgdr.tetrahedralize(plc).elems.tobytes(), self.made().elems.tobytes())
        with self.assertRaises(pgdr.UsageError):
            pgdr.tetrahedralize(plc, BOX)

    def test_refusals_say_what_to_use(self):
        for keywords, word in (({"order": 2}, "order"), ({"cdt": True}, "cdt"),
                               ({"switches": "pY", "nobisect": True}, "two ways"), ({"switches": "pr"}, "a mesh in the place of the surface"), ({"switches": "pu"}, "'u'"),
                               ({"switches": "pq", "minratio": 2}, "two ways"), ({"switches": "pq1.2.3"}, "1.2.3"),
                               ({"maxvolume": 1, "max_volume": 1}, "the same")):
            with self.subTest(keywords), self.assertRaises(pgdr.UsageError) as caught:
                pgdr.tetrahedralize(POINTS, BOX, **keywords)
            self.assertIn(word, str(caught.exception))
        for arguments in ((POINTS,), ([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]]), (POINTS, BOX[0])):
            with self.subTest(arguments), self.assertRaises((pgdr.UsageError, pgdr.InputError)):
                pgdr.tetrahedralize(*arguments)
        with self.assertRaises(pgdr.InputError):
            pgdr.tetrahedralize(POINTS, BOX[:5])


if __name__ == "__main__":
    unittest.main()
