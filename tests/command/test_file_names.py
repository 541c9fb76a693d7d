#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What the pgdr command says of names of files before it touches any. Usage: test_file_names.py [Class[.test]...]"""
import unittest

from test_command import PLATE, Case


class FileNames(Case):
    def refused_in(self, kept, *arguments, saying):
        """Exit code 2, and the folder is as it was."""
        done = self.pgdr(*arguments, expect=2, cwd=self.folder)
        self.assertIn(saying, done.stderr)
        self.assertEqual({p.name: p.read_bytes() for p in self.folder.iterdir()}, kept)

    def test_no_file_is_written_that_is_read(self):
        self.file("plate.poly", PLATE.read_text())
        self.file("plate.node", "")  # may have the points of plate.poly
        self.pgdr("mesh", "plate.poly", "-o", "sizes.mesh", expect=0, cwd=self.folder)
        vertices = self.folder.joinpath("sizes.mesh").read_text().split("Vertices\n")[1].split()[0]
        self.file("sizes.sol", f"MeshVersionFormatted 2\nDimension 2\nSolAtVertices {vertices}\n1 1\n" + "1\n" * int(vertices) + "End\n")
        self.pgdr("mesh", "plate.poly", "-o", "out.mesh", "--report", "reasons.json", expect=0, cwd=self.folder)
        (self.folder / "link.poly").symlink_to("plate.poly")
        kept = {p.name: p.read_bytes() for p in self.folder.iterdir()}
        mesh = ("mesh", "plate.poly", "-o")
        sized = ("--size-mesh", "sizes.mesh")
        for name in ("plate.poly", "./plate.poly", self.folder / "plate.poly", "link.poly", "plate.node"):
            for flag in ("--report", "--trace"):
                self.refused_in(kept, *mesh, "new.vtu", flag, name, saying="would replace the input")
        for flag in ("--report", "--trace"):
            for name in ("new.vtu", "./new.vtu", self.folder / "new.vtu"):  # not yet there
                self.refused_in(kept, *mesh, "new.vtu", flag, name, saying="would replace the output")
            for name in ("new.node", "new.ele", "new.edge", "new.neigh"):
                self.refused_in(kept, *mesh, "new.ele", "--neighbors", flag, name, saying="would replace the output")
            for name in ("sizes.mesh", "sizes.sol"):
                self.refused_in(kept, *mesh, "new.vtu", *sized, flag, name, saying="--size-mesh")
        self.refused_in(kept, *mesh, "new.vtu", "--report", "r.json", "--trace", "./r.json", saying="would replace the trace")
        self.refused_in(kept, *mesh, "sizes.mesh", *sized, saying="would replace the mesh of --size-mesh")
        self.refused_in(kept, *mesh, "plate.node", saying="would replace the input")
        check = ("check", "out.mesh", "--input", "plate.poly", "--reasons", "reasons.json", "--report")
        for name, what in (("out.mesh", "the mesh"), ("plate.poly", "the input"), ("reasons.json", "the report of --reasons")):
            self.refused_in(kept, *check, name, saying="the report would replace " + what)
        self.refused_in(kept, "info", "plate.poly", "--report", "link.poly", saying="would replace the input")
        self.refused_in(kept, "view", "out.mesh", "-o", "out.svg", "--report", "out.mesh", saying="would replace the mesh")
        self.refused_in(kept, "view", "out.mesh", "-o", "out.svg", "--report", "out.svg", saying="would replace the picture")

    def test_meshes_that_are_no_inputs(self):
        self.mesh(PLATE)
        self.output = self.folder / "out.ele"
        self.mesh(PLATE)
        for name in ("out.vtu", "out.ele"):
            for arguments in (("mesh", self.folder / name, "-o", self.folder / "again.mesh"),
                              ("check", self.folder / "out.vtu", "--input", self.folder / name)):
                self.assertIn("write the mesh as .mesh or .msh", self.pgdr(*arguments, expect=3).stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
