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


if __name__ == "__main__":
    unittest.main(verbosity=2)
