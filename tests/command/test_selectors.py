#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""--selector, --disk and --delta of the pgdr command from outside. Usage: test_selectors.py [Class[.test]...]"""
import unittest

from test_command import BRACKET, MODELS, PLATE, SANITIZE, Case

ROCKET = MODELS / "rocket.poly"
TWO_POINTS = ("10 3 0 0\n" + "".join(f"{i} {i & 1} {i >> 1 & 1} {i >> 2}\n" for i in range(8)) +
              "8 0.5 0.5 0.5\n9 0.5001 0.5 0.5\n6 0\n" +
              "".join(f"1\n4 {f}\n" for f in ("0 4 6 2", "1 3 7 5", "0 1 5 4", "2 6 7 3", "0 2 3 1", "4 5 7 6")) + "0\n0\n")


class Selectors(Case):
    def made(self, *arguments):
        """The report and the bytes of a mesh, which is checked."""
        self.mesh(*arguments, "--report", self.report)
        self.pgdr("check", self.output, "--input", arguments[0], "--radius-edge", "4", expect=0)
        return self.json(), self.output.read_bytes()

    def test_names_and_parameters(self):
        """Each gives another mesh that holds; the report repeats the name with its parameter."""
        for model in (self.file("two_points.poly", TWO_POINTS), ROCKET, BRACKET, PLATE):
            seen = set()
            for name in ("circumcenter", "off-center", "off-center:0.3", "optimized", "optimized:20", "sliver-avoiding",
                         "sliver-avoiding:3"):
                with self.subTest(model=model.name, selector=name):
                    report, mesh = self.made(model, "--radius-edge", "3", "--selector", name)
                    self.assertEqual(report["selector"], name)
                    self.assertEqual(report["selector_outside"], 0)
                    self.assertEqual((report["selector_further"], report["selector_dropped"]), (0, 0))  # one point each
                    seen.add(mesh)
            self.assertGreaterEqual(len(seen), 3 if model in (BRACKET, PLATE) else 7)

    def test_seeds(self):
        """Random points by a seed: the same again with the same, others with another; none is outside of its disk."""
        made = lambda *flags: self.made(ROCKET, "--radius-edge", "2", *flags)
        (report, zero), (_, plain), (_, seven) = (made("--selector", name) for name in ("random:0", "random", "random:7"))
        self.assertEqual(report["selector_outside"], 0)
        self.assertTrue(zero == plain)
        self.assertFalse(zero == seven)

    def test_defaults_of_parameters(self):
        for model, factor, samples in ((TWO_POINTS, "0.6", "1000"), (None, "0.95", "64")):
            path = self.file("two_points.poly", model) if model else PLATE
            for name, parameter in (("off-center", factor), ("optimized", samples), ("sliver-avoiding", "20")):
                with self.subTest(name=name):
                    plain = self.made(path, "--radius-edge", "2", "--selector", name)[1]
                    self.assertTrue(self.made(path, "--radius-edge", "2", "--selector", f"{name}:{parameter}")[1] == plain)

    def test_disks(self):
        """Selectors other than the circumcentre get the disk of type 1 unless a disk, or a delta, is asked for."""
        model = self.file("two_points.poly", TWO_POINTS)
        made = lambda *flags: self.made(model, "--radius-edge", "3", "--selector", "off-center", *flags)[1]
        usual, type2, graded = made(), made("--disk", "type2"), made("--delta", "0.9")
        self.assertTrue(usual == made("--disk", "type1"))
        self.assertTrue(graded == made("--disk", "type2", "--delta", "0.9"))
        self.assertEqual(len({usual, type2, graded}), 3)

    def test_the_same_for_any_threads(self):
        for name in ("off-center", "optimized:50", "sliver-avoiding", "random:7"):
            for model in (ROCKET, PLATE):
                meshes = {self.made(model, "--radius-edge", "2", "--selector", name, "--threads", n)[1] for n in ("18" if SANITIZE else "128")}
                self.assertEqual(len(meshes), 1)

    def test_wrong_names_and_parameters(self):
        for value in ("nearest", "", ":", "circumcenter:1", "off-center:", "off-center:0", "off-center:nan", "off-center:inf",
                      "off-center:0.6x", "optimized:0", "optimized:1.5", "optimized:1000001", "sliver-avoiding:-1", "random:-1", "random:1.5",
                      "random:4294967296",
                      "sliver-avoiding:x"):
            with self.subTest(value):
                done = self.pgdr("mesh", BRACKET, "-o", self.output, "--selector=" + value, expect=2)
                self.assertIn("--selector", done.stderr)
                self.assert_only()


if __name__ == "__main__":
    unittest.main(verbosity=2)
