#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Points alone, in space: --convex-hull. Usage: test_hull.py [Class[.test]...]"""
import itertools
import math
import random
import unittest

from test_command import BRACKET, Case
from test_unused_points import turned


class Hull(Case):
    def cloud(self, points, name="points.node"):
        rows = (f"{i} {p[0]!r} {p[1]!r} {p[2]!r}\n" for i, p in enumerate(points))
        return self.file(name, f"{len(points)} 3 0 0\n" + "".join(rows))

    def checked(self, points):
        """Meshed and checked: the report."""
        model = self.cloud(points)
        done = self.mesh(model, "--convex-hull", "--report", self.report, expect=None)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        self.assertIs(self.json()["convex_hull"], True)
        self.pgdr("check", self.output, "--input", model, "--reasons", self.report, expect=done.returncode)
        self.pgdr("check", self.output, "--input", model, expect=6)  # without the flag nothing is to be meshed
        return self.json()

    def test_grids(self):
        """Turned, shifted, scaled: rounding puts points beside the planes and lines that they are meant to be on."""
        grid = [tuple(map(float, p)) for p in itertools.product(range(5), range(4), range(3))]
        self.assertEqual(self.checked(grid)["vertices"], len(grid))
        chance = random.Random(3)
        for _ in range(8):
            angle, shift, scale = chance.uniform(0, 6), chance.choice((0, 10, 1e4)), 10 ** chance.uniform(-6, 6)
            report = self.checked([tuple(scale * (x + shift) for x in turned(p, angle)) for p in grid])
            self.assertLess(report["vertices"], 2 * len(grid))
            self.assertAlmostEqual(report["regions"][0]["volume_meshed"] / (24 * scale**3), 1, 9)

    def test_at_random(self):
        chance = random.Random(4)
        points = [tuple(chance.gauss(0, 1) for _ in range(3)) for _ in range(200)]
        report = self.checked(points)
        meshes = set()
        for threads in (1, 2, 8):
            self.mesh("points.node", "--convex-hull", "--threads", threads, expect=None, cwd=self.folder)
            meshes.add(self.output.read_bytes())
        self.assertEqual(len(meshes), 1)
        self.assertGreaterEqual(report["vertices"], len(points))

    def test_what_is_said(self):
        points = self.cloud([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (0.2, 0.2, 0.2)])
        for command in (self.mesh(points, expect=3), self.pgdr("info", points, expect=3)):
            self.assertIn("pgdr: needs: points alone: --convex-hull\n", command.stderr)
            self.assertIn("pgdr: --convex-hull makes it valid: the convex hull of all points is meshed then\n", command.stderr)
        self.pgdr("info", points, "--convex-hull", expect=0)
        flat = self.cloud([(x, y, x + y) for x in range(4) for y in range(4)])
        for flags in ([], ["--convex-hull"]):
            done = self.mesh(flat, *flags, "--report", self.report, expect=3)
            self.assertIn("lie in one plane", done.stderr)
            self.assertNotIn("makes it valid", done.stderr)
            self.assertIn("no_volume", {e["code"] for e in self.json()["errors"]})

    def test_besides_facets(self):
        """A body in its hull: what is between is meshed, too."""
        self.mesh(BRACKET, "--convex-hull", "--report", self.report, "--regions", "all", expect=None)
        volumes = [r["volume_meshed"] for r in self.json()["regions"]]
        self.mesh(BRACKET, "--report", self.report, expect=None)
        alone = sum(r["volume_meshed"] for r in self.json()["regions"])
        self.assertGreater(len(volumes), 1)
        self.assertGreater(sum(volumes), alone + 1e-3)


if __name__ == "__main__":
    unittest.main(verbosity=2)
