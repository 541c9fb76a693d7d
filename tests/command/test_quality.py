#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What the command says of the quality of a mesh, and the tables of docs/quality.md. Usage: test_quality.py [Class[.test]...]"""
import pathlib
import re
import subprocess
import sys
import unittest

from test_command import BRACKET, COMMAND, PLATE, Case

BENCH = pathlib.Path(__file__).resolve().parents[2] / "bench"
TABLE, OPTIMIZER_TABLE = BENCH / "quality_table.py", BENCH / "optimizer_table.py"
# A regular tetrahedron, the corner of a cube, and one that is nearly flat; the last two have the label 2.
THREE = ("MeshVersionFormatted 2\nDimension 3\nVertices 12\n1 1 1 0\n1 -1 -1 0\n-1 1 -1 0\n-1 -1 1 0\n"
         "5 0 0 0\n6 0 0 0\n5 1 0 0\n5 0 1 0\n9 0 0 0\n10 0 0 0\n9 1 0 0\n9 0 0.1 0\n"
         "Tetrahedra 3\n1 2 4 3 1\n5 6 7 8 2\n9 10 11 12 2\nEnd\n")


class Quality(Case):
    def test_of_three_cells(self):
        said = self.pgdr("info", self.file("three.mesh", THREE), "--report", self.report, expect=0).stdout
        q = self.json()["quality"]
        self.assertEqual(sum(q["cells_by_smallest_angle"]), 3)
        self.assertEqual([i for i, n in enumerate(q["cells_by_smallest_angle"]) if n], [1, 10, 14])
        for share in ("0.1%", "1%", "5%"):
            self.assertAlmostEqual(q["smallest_angles_deg"][share], 8.0495, places=2)
        first, second = q["regions"]
        self.assertEqual((first["label"], second["label"]), (1, 2))
        for measure in ("radius_ratio", "scaled_jacobian"):
            self.assertAlmostEqual(first[measure]["min"], 1)
            self.assertEqual(q[measure]["min"], second[measure]["min"])
            self.assertAlmostEqual(q[measure]["mean"], (first[measure]["mean"] + 2 * second[measure]["mean"]) / 3)
        # Of the flat one: edges of 1, 1, sqrt(2), determinant 0.1; of the largest product of edges at a corner.
        self.assertAlmostEqual(second["scaled_jacobian"]["min"], 2 ** 0.5 * 0.1 / (2 ** 0.5 * 1.01 ** 0.5))
        rows = re.findall(r"^region (\S+) +(.*)$", said, re.M)
        self.assertEqual([label for label, _ in rows], ["1", "2"])
        self.assertIn("2 tetrahedra, dihedral angles 8.05 to", rows[1][1])

    def test_of_what_is_meshed(self):
        for model in (BRACKET, PLATE):
            self.mesh(model, "--report", self.report)
            made = self.json()
            q = made["quality"]
            self.assertEqual(sum(q["cells_by_smallest_angle"]), made["cells"])
            smallest = q["smallest_angles_deg"]
            self.assertTrue(q["min_angle_deg"] <= smallest["0.1%"] <= smallest["1%"] <= smallest["5%"])
            for measure in (q["radius_ratio"], q["scaled_jacobian"]):
                self.assertTrue(0 < measure["min"] <= measure["1%"] < measure["mean"] < 1)
            self.pgdr("info", self.output, "--report", self.report, expect=0)
            for key, value in self.json()["quality"].items():
                self.assertEqual(value, q[key], key)


class QualityTable(Case):
    def test_of_the_bracket(self):
        page = self.file("page.md", "before\n<!-- begin of the table -->\nold\n<!-- end of the table -->\nafter\n")
        done = subprocess.run([sys.executable, "-B", TABLE, COMMAND, BRACKET, "--programs", "pgdr", "--cube", "0.1", "--table", page],
                              capture_output=True, text=True, timeout=500, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        text = page.read_text()
        self.assertTrue(text.startswith("before\n") and text.endswith("after\n") and "old" not in text, text)
        rows = [[c.strip() for c in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("| ")]
        self.assertEqual([r[:2] for r in rows[2:]],
                         [[m, p] for m in ("cube, size 0.1", "bracket.poly")
                          for p in ("pgdr --no-optimize", "pgdr", "pgdr --min-dihedral 20")])
        for row in rows[2:]:
            self.assertEqual(len(row), len(rows[0]))
        least = [float(r[rows[0].index("least")]) for r in rows[2:]]
        for refined, usual, twenty in (least[:3], least[3:]):
            self.assertLess(refined, 15)
            self.assertGreaterEqual(usual, 15)
            self.assertGreaterEqual(twenty, 20)


class OptimizerTable(Case):
    def test_of_the_bracket(self):
        other = "<!-- begin of the table -->\nkept\n<!-- end of the table -->\n"
        page = self.file("page.md", other + "<!-- begin of the bounds -->\nold\n<!-- end of the bounds -->\nafter\n")
        done = subprocess.run([sys.executable, "-B", OPTIMIZER_TABLE, COMMAND, BRACKET, "--cubes", "0.1", "--angles", "15,20", "--table", page,
                               "--name", "bounds"], capture_output=True, text=True, timeout=500, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        text = page.read_text()
        self.assertTrue(text.startswith(other) and text.endswith("after\n") and "old" not in text, text)
        rows = [[c.strip() for c in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("| ")]
        self.assertEqual([r[:2] for r in rows[2:]], [[m, a] for m in ("cube, size 0.1", "bracket.poly") for a in ("15", "20")])
        for row in map(lambda r: dict(zip(rows[0], r, strict=True)), rows[2:]):
            self.assertEqual([row["left"], row["unexplained"], row["check"]], ["0"] * 3)
            self.assertGreaterEqual(float(row["least"]), float(row["bound"]))


if __name__ == "__main__":
    unittest.main()
