#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Bodies by winding numbers, through the pgdr command. Usage: test_bodies.py [Class[.test]...]"""
import unittest

from test_command import Case
from test_structure import boxes_poly

INNER, OUTER = (1, 2), (0, 4)


def side_by_side(inside_out=False):
    """Two boxes with half a face in common, as an .off of triangles."""
    points, facets = [], []
    for low, high in (((0, 0, 0), (2, 2, 2)), ((2, 1, 0), (4, 3, 2))):
        base = len(points)
        points += [tuple((high if i >> k & 1 else low)[k] for k in range(3)) for i in range(8)]
        for a, b, c, d in ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)):
            facets += [[base + v for v in t[::-1 if inside_out else 1]] for t in ((a, b, c), (a, c, d))]
    text = "OFF\n%d %d 0\n" % (len(points), len(facets)) + "".join("%r %r %r\n" % p for p in points)
    return text + "".join("3 %d %d %d\n" % tuple(f) for f in facets)


class Bodies(Case):
    def made(self, source, regions, *flags):
        """The regions of the report, by their bodies; what `check` says of the mesh, by the report and by the flag."""
        self.mesh(source, "--regions", regions, "--report", self.report, *flags)
        found = self.json()
        self.assertEqual(found["region_mode"], regions)
        self.assertEqual([r["label"] for r in found["regions"]], list(range(1, len(found["regions"]) + 1)))
        for r in found["regions"]:
            self.assertAlmostEqual(r["volume_meshed"], r["volume_given"], 9)
        told = ("check", self.output, "--input", source, "--radius-edge", 2)
        checked = self.folder / "checked.json"
        for how in (("--reasons", self.report), ("--regions", regions, *flags)):
            said = self.pgdr(*told, *how, "--report", checked, expect=0)
            self.assertIn("as rays through the given facets count them", said.stdout)
        return {tuple(r["bodies"]): r["volume_meshed"] for r in found["regions"]}

    def test_box_in_box(self):
        nested = self.file("nested.poly", boxes_poly(INNER, OUTER))
        self.assertEqual(self.made(nested, "fragments"), {(0, 1): 1, (1,): 63})
        self.assertEqual(self.made(nested, "union"), {(0, 1): 64})
        self.pgdr("check", self.output, "--input", nested, "--radius-edge", 2, "--regions", "auto", expect=6)
        self.assertEqual(self.made(nested, "priority"), {(0,): 1, (1,): 63})
        self.assertEqual(self.json()["body_names"], ["", ""])

    def test_first_body_has_what_is_shared(self):
        nested = self.file("nested.poly", boxes_poly(OUTER, INNER))
        self.assertEqual(self.made(nested, "priority"), {(0,): 64})

    def test_bodies_that_touch(self):
        for inside_out in (False, True):
            touching = self.file("touching.off", side_by_side(inside_out))
            self.assertEqual(self.made(touching, "disjoint"), {(0,): 8, (1,): 8})
            self.assertEqual(self.made(touching, "union"), {(0, 1): 16})

    def test_bodies_that_cross(self):
        crossing = self.file("crossing.poly", boxes_poly((0, 2), (1, 3)))
        self.assertIn("intersect", self.mesh(crossing, "--regions", "union", expect=3).stderr)
        for regions, wanted in (("fragments", {(0,): 7, (0, 1): 1, (1,): 7}), ("union", {(0, 1): 15}),
                                ("priority", {(0,): 8, (1,): 7})):
            self.assertEqual(self.made(crossing, regions, "--resolve-crossings"), wanted)

    def test_overlap_is_an_error(self):
        nested = self.file("nested.poly", boxes_poly(INNER, OUTER))
        said = self.mesh(nested, "--regions", "disjoint", "--report", self.report, expect=3).stderr
        self.assertIn("bodies 0 and 1 have a volume of 1 in common, as at (1.", said)
        self.assertIn("--regions fragments", said)
        self.assertEqual(self.json()["errors"][0]["code"], "bodies_overlap")
        self.assertEqual(self.json()["errors"][0]["ids"], [0, 1])

    def test_seeds_win(self):
        nested = self.file("nested.poly", boxes_poly(INNER, OUTER, regions=[(1.5, 1.5, 1.5, 7, 0.01)]))
        self.mesh(nested, "--regions", "fragments", "--report", self.report)
        self.assertEqual([(r["label"], r["bodies"]) for r in self.json()["regions"]], [(1, [1]), (7, [0, 1])])
        said = self.pgdr("check", self.output, "--input", nested, "--reasons", self.report, expect=0).stdout
        self.assertIn("not checked: seeds of the input win", said)
        hole = self.file("hole.poly", boxes_poly(INNER, OUTER, holes=[(1.5, 1.5, 1.5)]))
        self.mesh(hole, "--regions", "fragments", "--report", self.report)
        self.assertEqual([(r["label"], r["volume_meshed"]) for r in self.json()["regions"]], [(1, 63)])

    def test_info(self):
        nested = self.file("nested.poly", boxes_poly(INNER, OUTER))
        said = self.pgdr("info", nested, "--regions", "fragments", "--report", self.report, expect=0).stdout
        self.assertIn("2 bodies in 2 regions", said)
        self.assertIn("bodies 0, 1, volume 1\n", said)
        self.assertEqual([r["bodies"] for r in self.json()["regions"]], [[1], [0, 1]])

    def test_wrong_mesh_is_found(self):
        """A mesh of one of two boxes is no union of them; nor are these fragments."""
        both = self.file("both.poly", boxes_poly((0, 1), (2, 3)))
        one = self.file("one.poly", boxes_poly((0, 1)))
        self.mesh(one, "--regions", "union")
        self.pgdr("check", self.output, "--input", both, "--regions", "union", expect=6)
        nested = self.file("nested.poly", boxes_poly(INNER, OUTER))
        self.mesh(nested, "--regions", "union")
        self.pgdr("check", self.output, "--input", nested, "--regions", "fragments", expect=6)

    def test_not_in_2d(self):
        square = self.file("square.poly", "4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n")
        self.assertIn("--regions union is for bodies in 3D", self.mesh(square, "--regions", "union", expect=2).stderr)


if __name__ == "__main__":
    unittest.main()
