#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes of another surface, certified to be near the given one by the pgdr command. Usage: test_surface.py [Class[.test]...]"""
import math
import unittest

from test_command import Case


def ball(n):
    """A sphere of radius 1, n points a ring, as an .off."""
    rings = [[(math.cos(2 * math.pi * k / n) * math.sin(a), math.sin(2 * math.pi * k / n) * math.sin(a), math.cos(a))
              for k in range(n)] for a in (math.pi * r / (n // 2) for r in range(1, n // 2))]
    points = [(0.0, 0.0, 1.0)] + [p for ring in rings for p in ring] + [(0.0, 0.0, -1.0)]

    def at(ring, k):
        return 1 + ring * n + k % n

    facets = [(0, at(0, k), at(0, k + 1)) for k in range(n)]
    for r in range(len(rings) - 1):
        for k in range(n):
            facets += [(at(r, k), at(r + 1, k), at(r, k + 1)), (at(r, k + 1), at(r + 1, k), at(r + 1, k + 1))]
    facets += [(len(points) - 1, at(len(rings) - 1, k + 1), at(len(rings) - 1, k)) for k in range(n)]
    return "OFF\n%d %d 0\n" % (len(points), len(facets)) + "".join("%r %r %r\n" % p for p in points) + "".join(
        "3 %d %d %d\n" % f for f in facets)


class Surface(Case):
    def setUp(self):
        super().setUp()
        self.fine, self.coarse = self.file("fine.off", ball(40)), self.file("coarse.off", ball(20))
        self.mesh(self.coarse, "--no-refine")
        self.told = ("check", self.output, "--input", self.fine)

    def test_near(self):
        said = self.pgdr(*self.told, "--surface-tolerance", "0.03", "--report", self.report, expect=0)
        self.assertIn("another one, to be within 0.03", said.stdout)
        found = self.json()["surface_tolerance"]
        self.assertEqual(found, {"given": "0.03", "length": 0.03, "feature_angle": 40, "undecided_volumes": 0})
        self.pgdr(*self.told, "--surface-tolerance", "1%", "--feature-angle", "90", "--report", self.report, expect=0)
        found = self.json()["surface_tolerance"]
        self.assertAlmostEqual(found["length"], 0.02 * math.sqrt(3), 3)
        self.assertEqual(found["feature_angle"], 90)

    def test_not_near(self):
        self.pgdr(*self.told, expect=6)  # it is not the given surface
        self.pgdr(*self.told, "--surface-tolerance", "0.002", "--report", self.report, expect=6)
        self.assertIn("off_surface", {f["kind"] for f in self.json()["findings"]})
        self.assertIn("surface_not_covered", {f["kind"] for f in self.json()["findings"]})

    def test_reasons_beside_a_sharp_corner(self):
        """Two segments from one point that enclose 0.06 degrees, and a polygon that is bent by more than they are apart there:
        check took the first edges of the one for edges of the other, and said that a facet at the other has the one."""
        points = [(0, 0, 0), (4, 0, 0), (4, .004, 0), (2, .002, 3), (6, 0, 0), (7, 0, 0), (7, 1, 0), (6, 1, 0), (6, 0, 1), (7, 0, 1),
                  (7, 1, 1.002), (6, 1, 1)]
        facets = [(0, 1, 2), (0, 1, 3), (1, 2, 3), (2, 0, 3), (4, 5, 6, 7), (4, 5, 9, 8), (5, 6, 10, 9), (6, 7, 11, 10), (7, 4, 8, 11)]

        def poly(name, top):
            lines = [f"{len(points)} 3 0 0"] + ["%d %r %r %r" % (i, *p) for i, p in enumerate(points)] + [f"{len(facets) + len(top)} 0"]
            for facet in facets + top:
                lines += ["1", " ".join(map(str, (len(facet), *facet)))]
            return self.file(name, "\n".join([*lines, "0", "0"]) + "\n")

        bent, even = poly("bent.poly", [(8, 9, 10, 11)]), poly("even.poly", [(8, 9, 10), (8, 10, 11)])
        for size in ("0.3", "0.1"):
            self.pgdr("mesh", bent, "-o", self.output, "--tolerance", "1.2e-3", "--no-optimize", "--size", size, "--report", self.report,
                      expect=1)
            said = self.pgdr("check", self.output, "--input", even, "--surface-tolerance", "0.02", "--reasons", self.report, expect=1)
            self.assertIn("only where the reasons explain it", said.stdout)

    def test_wrong_words(self):
        for text, word in (("x", "a length, or a percentage"), ("%", "a length, or a percentage"), ("1 %", "a length, or a percentage"),
                           ("0", "above 0"), ("-1", "above 0"), ("nan", "a length"), ("inf", "finite"), ("1e999", "finite"),
                           ("1e-16", "16 times the tolerance"), ("0%", "above 0")):
            said = self.pgdr(*self.told, f"--surface-tolerance={text}", expect=2)
            self.assertIn(word, said.stderr, text)
        said = self.pgdr(*self.told, "--surface-tolerance", "0.01", "--tolerance", "0.001", expect=2)
        self.assertIn("is 0.01, and has to be 16 times", said.stderr)
        self.assertIn("0.001", said.stderr)
        for flags in (("check", self.output, "--surface-tolerance", "0.1"), (*self.told, "--feature-angle", "20"),
                      (*self.told, "--surface-tolerance", "0.1", "--feature-angle", "181")):
            self.pgdr(*flags, expect=2)

    def test_one_point_has_no_percentage(self):
        point = self.file("point.node", "1 3 0 0\n1 1 1 1\n")
        said = self.pgdr("check", self.output, "--input", point, "--surface-tolerance", "1%", expect=2)
        self.assertIn("no diagonal", said.stderr)

    def test_in_the_plane_there_is_none(self):
        square = self.file("square.poly", "4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n")
        self.mesh(square)
        said = self.pgdr("check", self.output, "--input", square, "--surface-tolerance", "0.1", expect=2)
        self.assertIn("is for 3D", said.stderr)


if __name__ == "__main__":
    unittest.main()
