#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What the refusals of `pgdr mesh` say that helps: each cure is carried out, and the input is meshed then.

PGDR_COMMAND names the command, PGDR_SANITIZE its sanitizers, if any. Usage: test_cures.py [Class[.test]...]
"""
import math
import random
import re
import resource
import unittest

from test_command import SANITIZE, Case
from test_estimates import box, poly


def turned(points, seed):
    """By a random rotation, and moved."""
    r = random.Random(seed)
    q = [r.gauss(0, 1) for _ in range(4)]
    n = math.sqrt(sum(x * x for x in q))
    w, x, y, z = (v / n for v in q)
    rows = [(1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y))]
    return [tuple(sum(a * b for a, b in zip(row, p)) + 100 for row in rows) for p in points]


class Cures(Case):
    def is_meshed(self, *arguments, **keywords):
        done = self.mesh(*arguments, expect=None, **keywords)
        self.assertIn(done.returncode, (0, 1), done.stderr)

    def tetrahedra(self, upper):
        """Two, whose edges cross at (0, 0, 0), or where the upper one is moved to."""
        points = [(-1, 0, 0), (1, 0, 0), (0, -1, -1), (0, 1, -1), (upper, -1, 0), (upper, 1, 0), (upper - 1, 0, 1), (upper + 1, 0, 1)]
        faces = [(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2), (4, 5, 6), (4, 7, 5), (4, 6, 7), (5, 7, 6)]
        return points, faces

    def test_a_point_where_edges_cross(self):
        for seed in range(6):
            points, faces = self.tetrahedra(0.1 * seed)
            points = turned([tuple(map(float, p)) for p in points], seed)
            said = self.mesh(self.file("touch.poly", poly(points, faces)), expect=3).stderr
            place = re.search(r"add a point at \((.*)\) to the input makes it valid", said)
            self.assertTrue(place, f"{seed}: {said}")
            points.append(tuple(map(float, place[1].split(", "))))
            self.is_meshed(self.file("cured.poly", poly(points, faces)))
        points, faces = self.tetrahedra(0)
        said = self.mesh(self.file("touch.poly", poly(points, faces)), expect=3).stderr
        self.assertIn("add a point at (0, 0, 0)", said)
        self.mesh(self.file("cured.poly", poly(points + [(0, 0, 0)], faces)), expect=0)

    def test_bodies_that_overlap_are_cut(self):
        for seed in range(3):
            points, faces = box(4, 4, 4)
            others, more = box(4, 2, 2, first=8)
            points += [(x + 2, y + 1, z + 1) for x, y, z in others]
            model = self.file("bodies.poly", poly(turned([tuple(map(float, p)) for p in points], seed), faces + more))
            self.assertIn("--resolve-crossings makes it valid", self.mesh(model, expect=3).stderr)
            self.mesh(model, "--resolve-crossings", "--markers", "last", "--regions", "all", "--report", self.report, expect=0)
            self.assertEqual([r["code"] for r in self.json()["repairs"] if r["message"].startswith("facets that cross")],
                             ["entities_intersect"])
            volumes = sorted(r["volume_meshed"] for r in self.json()["regions"])
            for volume, exact in zip(volumes, (8, 8, 56), strict=True):
                self.assertAlmostEqual(volume, exact, delta=1e-9)
            self.pgdr("check", self.output, "--input", model, "--reasons", self.report, expect=0)
            self.pgdr("info", model, "--resolve-crossings", expect=0)
            self.pgdr("mesh", model, "-o", self.output, "--markers", "first", expect=2)

    def unwelded(self, n, apart, seed, turn=True):
        """The surface of a cube, of n x n squares a side: each triangle has corners of its own, up to so far off."""
        r = random.Random(seed)
        triangles = []
        for axis in range(3):
            for level in (0.0, 1.0):
                for i in range(n):
                    for j in range(n):
                        at = [(a / n, b / n) for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))]
                        corners = [tuple((level, u, v)[(k - axis) % 3] for k in range(3)) for u, v in at]
                        triangles += [(corners[0], corners[1], corners[2]), (corners[0], corners[2], corners[3])]
        points = [tuple(c + r.uniform(-apart, apart) / 2 for c in p) for t in triangles for p in t]
        points = turned(points, seed) if turn else points
        return poly(points, [(3 * k, 3 * k + 1, 3 * k + 2) for k in range(len(triangles))])

    def test_a_surface_that_is_not_welded(self):
        for seed, apart in enumerate((1e-7, 1e-5, 1e-4, 1e-3, 5e-3)):
            model = self.file("unwelded.poly", self.unwelded(4, apart, seed))
            said = self.mesh(model, expect=3).stderr
            cure = re.search(r"not welded: .* up to (\S+) apart; (--tolerance \S+(?: --yes-coarse)?) joins them", said)
            self.assertTrue(cure, said)
            self.assertLess(float(cure[1]), 2 * apart)
            self.is_meshed(model, *cure[2].split())

    def test_no_tolerance_welds_what_is_open(self):
        points, faces = box(1.0, 1.0, 1.0)
        said = self.mesh(self.file("open.poly", poly(points, faces[:3])), expect=3).stderr
        self.assertNotIn("--tolerance", said)

    def test_bodies_that_overlap_are_counted(self):
        points, faces = [], []
        for k in range(5):
            p, f = box(1.0, 1.1, 1.2, 8 * k)
            points += [(x + 0.7 * k, y + 0.31 * k, z + 0.23 * k) for x, y, z in p]
            faces += f
        for copy in (points, turned(points, 1)):
            said = self.mesh(self.file("bodies.poly", poly(copy, faces)), "--report", self.report, expect=3).stderr
            self.assertRegex(said, r"5 closed bodies that overlap: \d+ pairs of their facets intersect")
            self.assertEqual(said.count("intersect from"), 1)
            self.assertGreater(len(self.json()["errors"]), 4)  # all of them are there
            for mode in ("union", "fragments"):
                self.assertIn(f"--regions {mode}", said)
                self.is_meshed(self.file("bodies.poly", poly(copy, faces)), "--resolve-crossings", "--regions", mode)
        p, f = box(1.0, 1.0, 1.0)  # a sheet through a box is no body
        sheet = [(0.5, -1.0, -1.0), (0.5, 2.0, -1.0), (0.5, 2.0, 2.0), (0.5, -1.0, 2.0)]
        said = self.mesh(self.file("sheet.poly", poly(p + sheet, f + [(8, 9, 10, 11)])), expect=3).stderr
        self.assertNotIn("bodies", said)

    # A line of 400 m, a unit of the last digit above the upper side of a strip: coordinates of 13 digits.
    STRIP = ("10 2 0 0\n" + "\n".join(
        f"{i} {412345 + x:.6f} {5012345 + y:.6f}" for i, (x, y) in enumerate(
            [(0, 0), (4000, 0), (4000, 10), (0, 10), (100, 5), (3900, 5), (3900, 10 - 1e-6), (100, 10 - 1e-6), (0, 10 - 1e-6),
             (100, 10 - 1e-6)])) + "\n9 0\n0 0 1\n1 1 2\n2 2 3\n3 3 0\n4 4 5\n5 5 6\n6 6 7\n7 7 4\n8 8 9\n0\n")

    @unittest.skipIf(SANITIZE, "a limit on addresses leaves sanitizers none")
    def test_a_gap_of_one_digit(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))

        model = self.file("strip.poly", self.STRIP)
        self.pgdr("info", model, "--report", self.report, expect=0)
        self.assertEqual(self.json()["proposal"]["tolerance"], 2e-6)
        said = self.mesh(model, expect=7, preexec_fn=limit).stderr
        cure = re.search(r"(--tolerance \S+), two units of the last digit", said)
        self.assertTrue(cure, said)
        self.is_meshed(model, *cure[1].split(), preexec_fn=limit)

    def test_no_proposal_closes_a_gap_that_is_not_meshed(self):
        p, f = box(5000.0, 10000.0, 4000.0)
        q, g = box(4999.9, 10000.0, 4000.0, 8)
        model = self.file("blocks.poly", poly(p + [(x + 5000.1, y, z) for x, y, z in q], f + g))
        self.pgdr("info", model, "--report", self.report, expect=0)
        self.assertNotIn("proposal", self.json())
        self.assertEqual(self.json()["narrowest_gap"]["distance"], 4000)


if __name__ == "__main__":
    unittest.main(verbosity=2)
