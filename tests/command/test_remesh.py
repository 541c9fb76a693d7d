#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes as inputs. PGDR_COMMAND names the command. Usage: test_remesh.py [Class[.test]...]"""
import unittest

from test_command import BRACKET, PLATE, Case

BLOCKS = """16 3 0 0
0 0 0 0
1 1 0 0
2 1 1 0
3 0 1 0
4 0 0 1
5 1 0 1
6 1 1 1
7 0 1 1
8 2 0 0
9 2 1 0
10 2 0 1
11 2 1 1
12 0.3 0.3 0.3
13 0.6 0.3 0.3
14 0.6 0.6 0.3
15 0.3 0.6 0.3
12 1
1 0 1
4 0 1 2 3
1 0 2
4 4 5 6 7
1 0 3
4 0 1 5 4
1 0 4
4 1 2 6 5
1 0 5
4 2 3 7 6
1 0 6
4 3 0 4 7
1 0 1
4 1 8 9 2
1 0 2
4 5 10 11 6
1 0 3
4 1 8 10 5
1 0 7
4 8 9 11 10
1 0 5
4 9 2 6 11
1 0 9
4 12 13 14 15
0
2
0 0.5 0.5 0.8 3
1 1.5 0.5 0.5 4
"""


class Remesh(Case):
    def remesh(self, mesh, *flags, output="new.vtu", expect=(0, 1)):
        new = self.folder / output
        done = self.pgdr("remesh", mesh, "-o", new, "--report", self.report, *flags)
        self.assertIn(done.returncode, expect if isinstance(expect, tuple) else (expect,), done.stdout + done.stderr)
        return new, done

    def check(self, mesh, old, *flags):
        done = self.pgdr("check", mesh, "--input", old, "--reasons", self.report, *flags)
        self.assertIn(done.returncode, (0, 1), done.stdout + done.stderr)

    def volumes(self):
        return {r["label"]: r["volume_meshed"] for r in self.json()["regions"]}

    def test_formats(self):
        """What any format that is read has of labels and markers is there in the new mesh; the checker agrees, with the old file alone."""
        blocks = self.file("blocks.poly", BLOCKS)
        for name in ("old.vtu", "old.msh", "old.mesh", "old.node"):
            with self.subTest(name):
                old = self.folder / name
                self.pgdr("mesh", blocks, "-o", old, "--size", "0.15", "--report", self.report, expect=0)
                cells, volumes = self.json()["cells"], self.volumes()
                new, _ = self.remesh(old.with_suffix(".ele") if name == "old.node" else old, "--size", "0.3")
                self.assertLess(self.json()["cells"], cells)
                self.assertEqual(self.volumes(), volumes)
                self.check(new, old.with_suffix(".ele") if name == "old.node" else old)
                self.pgdr("check", new, "--input", blocks, expect=0)
                self.pgdr("check", old, "--input", new, "--remeshed", expect=0)

    def test_planar(self):
        old = self.folder / "old.msh"
        self.pgdr("mesh", PLATE, "-o", old, "--size", "0.001", expect=0)
        new, _ = self.remesh(old, "--size-unit", "edge", "--size", "0.2")
        self.check(new, old)
        self.pgdr("check", new, "--input", PLATE, expect=0)
        kept, _ = self.remesh(old, "--keep-boundary", "--size", "0.0003")
        self.check(kept, old)

    def test_threads(self):
        old = self.folder / "old.vtu"
        self.pgdr("mesh", self.file("blocks.poly", BLOCKS), "-o", old, "--size", "0.2", expect=0)
        made = [self.remesh(old, "--size", "0.1", "--threads", n, output=f"t{n}.vtu")[0].read_bytes() for n in (1, 2, 8)]
        self.assertEqual(made[0], made[1])
        self.assertEqual(made[0], made[2])

    def test_required_and_names(self):
        old = self.folder / "old.vtu"
        self.pgdr("mesh", self.file("blocks.poly", BLOCKS), "-o", old, "--size", "0.2", expect=0)
        free, _ = self.remesh(old, "--no-refine", output="free.vtu")
        points = self.json()["vertices"]
        new, _ = self.remesh(old, "--no-refine", "--required", "9")
        self.assertGreater(self.json()["vertices"], points)
        self.check(new, old)
        self.pgdr("check", free, "--input", old, "--remeshed", expect=0)
        done = self.pgdr("check", free, "--input", old, "--remeshed", "--required", "9", expect=6)
        self.assertIn("missing_input_point", done.stdout)
        self.pgdr("remesh", old, "-o", new, "--required", "roof", expect=2)
        self.pgdr("remesh", old, "-o", new, "--required", "77", expect=2)

    def test_fields(self):
        try:
            import numpy as np
        except ImportError:
            self.skipTest("numpy is not there")
        old, text = self.folder / "old.vtu", self.file("blocks.poly", BLOCKS)
        self.pgdr("mesh", text, "-o", old, "--size", "0.25", expect=0)
        with_h = add_point_field(old.read_bytes(), "h", lambda x, y, z: 0.05 + 0.1 * x)
        old.write_bytes(with_h)
        new, _ = self.remesh(old, "--size-field", "h")
        self.check(new, old, "--size-field", "h")
        self.assertIn(b'Name="h"', new.read_bytes())
        cells = self.json()["cells"]
        self.remesh(old, "--size-field", "h", "--size-unit", "edge")
        self.assertGreater(self.json()["cells"], cells)
        self.remesh(old, "--size-field", "h", "--size-growth", "0.01")
        self.assertGreater(self.json()["cells"], cells)
        without, done = self.remesh(old, "--size", "0.3", "--no-fields")
        self.assertNotIn(b'Name="h"', without.read_bytes())
        _, done = self.remesh(old, "--size", "0.3", output="new.msh")
        self.assertIn("stay behind: h", done.stderr + done.stdout)
        done = self.pgdr("remesh", old, "-o", new, "--size-field", "g", expect=2)
        self.assertIn("it has h", done.stderr)
        self.assertEqual(np.float64(1), 1)

    def test_usage(self):
        old = self.folder / "old.vtu"
        self.pgdr("mesh", BRACKET, "-o", old, expect=0)
        self.pgdr("remesh", old, expect=2)
        self.pgdr("remesh", BRACKET, "-o", self.output, expect=3)
        self.pgdr("remesh", self.folder / "none.vtu", "-o", self.output, expect=4)
        self.pgdr("mesh", BRACKET, "-o", self.output, "--size", "1", "--size-unit", "area", expect=2)
        self.pgdr("mesh", BRACKET, "-o", self.output, "--size", "1", "--size-unit", "inch", expect=2)
        self.pgdr("check", old, "--remeshed", expect=2)


class Refine(Case):
    def test_all_vertices_stay(self):
        for model, bounds, flags in ((BRACKET, ".vol", ["--size", "1"]), (PLATE, ".area", ["--size", "0.05"])):
            old, new = self.folder / "old.ele", self.folder / "new.ele"
            self.pgdr("mesh", model, "-o", old, "--report", self.report, *flags, expect=0)
            cells = self.json()["cells"]
            half = self.json()["regions"][0]["volume_meshed"] / cells / 3
            lines = [f"{i + 1} {half if i < cells // 2 else -1}" for i in range(cells)]
            file = self.file("old" + bounds, f"{cells}\n" + "\n".join(lines) + "\n")
            self.pgdr("refine", old, "-o", new, "--cell-bounds", file, "--report", self.report, expect=0)
            self.assertGreater(self.json()["cells"], cells)
            self.pgdr("check", new, "--input", old, "--reasons", self.report, expect=0)
            points = [set(tuple(line.split()[1:4]) for line in f.with_suffix(".node").read_text().splitlines()
                          if line and not line.startswith("#")) for f in (old, new)]
            self.assertLess(len(points[0] - points[1]), 2)  # the line of counts
            file.write_text("3\n1 1\n2 1\n3 1\n")
            self.pgdr("refine", old, "-o", new, "--cell-bounds", file, expect=2)
            file.write_text(f"{cells}\n5 1\n")
            self.pgdr("refine", old, "-o", new, "--cell-bounds", file, expect=3)


def add_point_field(data, name, function):
    """The bytes of a .vtu of pgdr with another array of points before all others, a number each."""
    import re
    import numpy as np
    count = int(re.search(rb'NumberOfPoints="(\d+)"', data).group(1))
    mark = b'<AppendedData encoding="raw">\n_'
    begin = data.index(mark) + len(mark)
    head, rows = data[:begin], data[begin:]
    offset = int(re.search(rb'Name="Points"[^>]*offset="(\d+)"', head).group(1))
    points = np.frombuffer(rows, dtype="<f8", count=3 * count, offset=offset + 8).reshape(-1, 3)
    values = np.array([function(*p) for p in points], dtype="<f8").tobytes()
    head = re.sub(rb'offset="(\d+)"', lambda m: b'offset="%d"' % (int(m.group(1)) + 8 + len(values)), head)
    array = f'<DataArray type="Float64" Name="{name}" format="appended" offset="0"/>\n'.encode()
    return head.replace(b"</PointData>", array + b"</PointData>") + len(values).to_bytes(8, "little") + values + rows


if __name__ == "__main__":
    unittest.main()
