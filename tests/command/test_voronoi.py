#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Voronoi cells of the command, `mesh --voronoi`, against brute force. PGDR_COMMAND names the command.
Usage: test_voronoi.py [Class[.test]...]"""
import math
import random
import unittest

from test_command import PLATE, Case


class Voronoi(Case):
    def test_cells(self):
        """Of random points of a domain with a hole the nearest vertex is that of the one cell that they are in."""
        text = ("7 2 0 0\n1 0 0\n2 10 0\n3 10 4\n4 0 4\n5 3 1.3\n6 6 1\n7 5 3\n"
                "7 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n5 5 6\n6 6 7\n7 7 5\n1\n1 4.5 1.5\n")
        cells = self.folder / "a.voronoi"
        made = []
        for threads in ("1", "4"):
            self.mesh(self.file("a.poly", text), "--conforming-delaunay", "--size", 0.3, "--voronoi", cells, "--threads", threads,
                      "--report", self.report)
            made.append(cells.read_bytes())
        self.assertEqual(made[0], made[1])
        lines = [line.split() for line in cells.read_text().splitlines()]
        points, count = map(int, lines[1])
        self.assertEqual((lines[0], self.json()["voronoi"]), (["#", "pgdr", "voronoi", "1"], {"cells": count, "points": points}))
        self.assertEqual(count, self.json()["vertices"])
        at = [tuple(map(float, line)) for line in lines[2:2 + points]]
        sites, polygons = [], []
        for x, y, corners, *rows in lines[2 + points:]:
            self.assertEqual(int(corners), len(rows))
            sites.append((float(x), float(y)))
            polygons.append([at[int(row)] for row in rows])
        self.assertEqual(len(sites), count)

        def cross(o, a, b):
            return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])
        areas = [sum(cross(site, a, b) for a, b in zip(p, p[1:] + p[:1])) / 2 for site, p in zip(sites, polygons)]
        hole = cross((3, 1.3), (6, 1), (5, 3)) / 2
        self.assertAlmostEqual(sum(areas), 40 - hole, delta=1e-11)
        self.assertGreater(min(areas), 0)
        draw, tried = random.Random(3), 0
        for _ in range(300):
            x = (10 * draw.random(), 4 * draw.random())
            inside = cross((3, 1.3), (6, 1), x) > 0 and cross((6, 1), (5, 3), x) > 0 and cross((5, 3), (3, 1.3), x) > 0
            first, second = sorted(range(count), key=lambda i: math.dist(x, sites[i]))[:2]
            if inside or math.dist(x, sites[second]) - math.dist(x, sites[first]) < 1e-9:
                continue
            tried += 1
            p = polygons[first]
            turns = sum(math.atan2(cross(x, a, b), (a[0] - x[0]) * (b[0] - x[0]) + (a[1] - x[1]) * (b[1] - x[1]))
                        for a, b in zip(p, p[1:] + p[:1]))
            self.assertAlmostEqual(turns / (2 * math.pi), 1, places=6)
        self.assertGreater(tried, 200)

    def test_what_is_refused(self):
        """Without conforming Delaunay triangles, in another format, in the place of the mesh, in no folder, and of a stopped run."""
        cells = self.folder / "a.voronoi"
        flags = ["--conforming-delaunay", "--voronoi"]
        self.mesh(PLATE, "--voronoi", cells, expect=2)
        self.mesh(PLATE, *flags, self.folder / "a.txt", expect=2)
        self.mesh(PLATE, *flags, cells, "--min-edge", "0.1", expect=2)
        self.mesh(PLATE, *flags, cells, "--report", cells, expect=2)
        self.mesh(PLATE, *flags, self.folder / "none" / "a.voronoi", expect=4)
        self.assertFalse(self.output.exists())
        self.mesh(PLATE, *flags, cells, "--size", 0.001, "--max-vertices", 50, expect=5)
        self.assertTrue(self.output.exists())
        self.assertFalse(cells.exists())


if __name__ == "__main__":
    unittest.main()
