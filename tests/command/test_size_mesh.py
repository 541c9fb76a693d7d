#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Sizes from a background mesh. PGDR_COMMAND names the command. Usage: test_size_mesh.py [Class[.test]...]"""
import unittest

from test_command import BRACKET, PLATE, Case


class SizeMesh(Case):
    def test_background_mesh(self):
        """A mesh with sizes in a .sol file beside it bounds the next one, and `check` reads it likewise."""
        for model, size, fine in ((BRACKET, "0.5", 0.1), (PLATE, "0.05", 0.001)):
            with self.subTest(model.name):
                background = self.folder / "background.mesh"
                self.pgdr("mesh", model, "--size", size, "-o", background, expect=0)
                words = background.read_text().split()
                vertices = int(words[words.index("Vertices") + 1])
                values = [fine] + [float(size)] * (vertices - 1)
                dimension = 3 if model == BRACKET else 2
                head = f"MeshVersionFormatted 2\nDimension {dimension}\nSolAtVertices {vertices}\n1 1\n"
                self.file("background.sol", head + "\n".join(map(str, values)) + "\nEnd\n")
                cells = []
                for flags in ([], ["--size-growth", "0.3"], ["--size-growth", "0.3", "--size", str(float(size) / 2)]):
                    flags = ["--size-mesh", background, *flags]
                    self.mesh(model, *flags, "--report", self.report)
                    cells.append(self.json()["cells"])
                    self.pgdr("check", self.output, "--input", model, *flags, expect=0)
                self.assertLess(cells[0], cells[1])
                self.assertLess(cells[1], cells[2])
                self.pgdr("check", self.output, "--input", model, "--size", fine, expect=6)
                self.file("background.sol", head + "0\n" * vertices)
                done = self.mesh(model, "--size-mesh", background, expect=2)
                self.assertIn("size at point 0", done.stderr)
                (self.folder / "background.sol").unlink()
                self.mesh(model, "--size-mesh", background, expect=4)
        self.mesh(PLATE, "--size-growth", "0.3", expect=2)


HALVES_2D = """6 2 0 0
1 0 0
2 0.5 0
3 1 0
4 0 1
5 0.5 1
6 1 1
7 0
1 1 2
2 2 3
3 3 6
4 6 5
5 5 4
6 4 1
7 2 5
0
2
1 0.25 0.5 1
2 0.75 0.5 7.5
"""

HALVES_3D = """12 3 0 0
1 0 0 0
2 0.5 0 0
3 1 0 0
4 0 1 0
5 0.5 1 0
6 1 1 0
7 0 0 1
8 0.5 0 1
9 1 0 1
10 0 1 1
11 0.5 1 1
12 1 1 1
7 0
1
4 1 4 10 7
1
4 2 5 11 8
1
4 3 6 12 9
1
6 1 2 3 9 8 7
1
6 4 5 6 12 11 10
1
6 1 2 3 6 5 4
1
6 7 8 9 12 11 10
0
2
1 0.25 0.5 0.5 1
2 0.75 0.5 0.5 7.5
"""


class RegionSize(Case):
    def test_sizes_of_regions(self):
        """Each region has its size, `check` reads it likewise, and any number of threads makes the same bytes."""
        for text, fine, coarse in ((HALVES_2D, "0.0005", "0.01 * (1 - 0.7*y)"), (HALVES_3D, "0.07", "0.25 * (1 - 0.7*y)")):
            with self.subTest(fine):
                model = self.file("halves.poly", text)
                flags = ["--region-size", f"1={fine}", "--region-size", f"7.5={coarse}"]
                made = set()
                for threads in ("1", "2", "8"):
                    self.mesh(model, *flags, "--threads", threads, "--report", self.report)
                    made.add(self.output.read_bytes())
                self.assertEqual(len(made), 1)
                cells = self.json()["cells"]
                self.pgdr("check", self.output, "--input", model, *flags, expect=0)
                self.pgdr("check", self.output, *flags, expect=0)
                self.pgdr("check", self.output, "--input", model, "--region-size", f"7.5={fine}", expect=6)
                self.pgdr("check", self.output, "--region-size", "2=1", expect=2)
                self.mesh(model, *flags, "--size", fine, "--report", self.report)
                self.assertGreater(self.json()["cells"], 1.5 * cells)
                done = self.mesh(model, "--region-size", "2=1", expect=2)
                self.assertIn("label 2, which no region has; there are 0, 1, 7.5", done.stderr)
                done = self.mesh(model, "--region-size", "7.5=0.8 - x", expect=2)
                self.assertIn("the size function returned", done.stderr)

    def test_usage(self):
        """What is no label and size."""
        model = self.file("halves.poly", HALVES_2D)
        for text in ("1", "=1", "1=", "a=1", "nan=1", "1,2=1", "1=0", "1=-1", "1=w", "1=x="):
            done = self.mesh(model, "--region-size", text, expect=2)
            self.assertIn("--region-size", done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
