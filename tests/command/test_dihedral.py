#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""--min-dihedral and --no-optimize of the pgdr command from outside. Usage: test_dihedral.py [Class[.test]...]"""
import unittest

from test_command import BRACKET, PLATE, Case


class Dihedral(Case):
    def test_bound_and_none(self):
        self.mesh(BRACKET, "--size", "0.3", "--report", self.report)
        r = self.json()
        self.assertFalse(r["delaunay"])
        self.assertEqual(r["optimization"]["target"], 15)
        self.assertEqual((r["optimization"]["left"], r["optimization"]["unexplained"]), (0, 0))
        self.assertGreaterEqual(r["quality"]["min_angle_deg"], 15 - 1e-9)
        self.assertLess(r["quality"]["max_angle_deg"], 163)
        self.assertIn("optimize_cheap", [s["name"] for s in r["stages"]])
        self.assertGreater(r["seconds"]["optimize"], 0)
        check = ["check", self.output, "--input", BRACKET, "--radius-edge", 2, "--size", "0.3"]
        self.pgdr(*check, "--reasons", self.report, expect=0)
        self.pgdr(*check, "--min-dihedral", 15, expect=0)
        self.pgdr(*check, "--min-dihedral", 30, expect=1)
        self.pgdr(*check, "--reasons", self.report, "--delaunay", expect=6)
        self.mesh(BRACKET, "--size", "0.3", "--no-optimize", "--report", self.report)
        r = self.json()
        self.assertTrue(r["delaunay"])
        self.assertNotIn("optimization", r)
        self.assertLess(r["quality"]["min_angle_deg"], 10)
        self.pgdr(*check, "--reasons", self.report, "--delaunay", expect=0)
        without = self.output.read_bytes()
        self.mesh(BRACKET, "--size", "0.3", "--min-dihedral", 0)
        self.assertEqual(self.output.read_bytes(), without)
        self.mesh(BRACKET, "--size", "0.3", "--selector", "off-center", "--report", self.report)
        self.assertTrue(self.json()["delaunay"])

    def test_bounds_that_cannot_be(self):
        for flags in (["--min-dihedral", "36"], ["--min-dihedral", "-1"], ["--min-dihedral", "nan"],
                      ["--min-dihedral", "10", "--no-optimize"]):
            self.mesh(BRACKET, *flags, expect=2)
        self.assertIn("--min-angle", self.mesh(PLATE, "--min-dihedral", "10", expect=2).stderr)
        self.mesh(PLATE, "--no-optimize", expect=0)
        done = self.mesh(BRACKET, "--min-dihedral", "31", expect=None)
        self.assertIn("beyond practice", done.stdout + done.stderr)



if __name__ == "__main__":
    unittest.main(verbosity=2)
