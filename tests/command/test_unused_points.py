#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Points of an input in no cell: counted, warned of, and left out on request. Usage: test_unused_points.py [Class[.test]...]"""
import itertools
import math
import random
import unittest

from test_command import BRACKET, PLATE, Case

CUBE = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


def turned(p, angle):
    """By a turn about a slanted axis that is no symmetry of anything."""
    c, s = math.cos(angle), math.sin(angle)
    x, y = c * p[0] - s * p[1], s * p[0] + c * p[1]
    return (x, y) if len(p) == 2 else (c * x - s * p[2], y, s * x + c * p[2])


class UnusedPoints(Case):
    def box_with_void(self, extra, angle=0.0, shift=0.0):
        """3D: a box of side 3 with a void of side 1 in it, volume 26, and further points."""
        place = lambda p: tuple(x + shift for x in turned(p, angle))
        points = [place(tuple(3 * x for x in p)) for p in CUBE] + [place(tuple(1 + x for x in p)) for p in CUBE]
        points += [place(p) for p in extra]
        text = f"{len(points)} 3 0 1\n" + "".join(f"{i} {p[0]!r} {p[1]!r} {p[2]!r} {i}\n" for i, p in enumerate(points, 1))
        text += f"{2 * len(FACES)} 1\n"
        for box, face in itertools.product((1, 9), FACES):
            text += f"1 0 {box}\n4 " + " ".join(str(box + v) for v in face) + "\n"
        seed = place((1.5, 1.5, 1.5))
        return self.file("void.poly", text + f"1\n1 {seed[0]!r} {seed[1]!r} {seed[2]!r}\n0\n")

    def square_with_void(self, extra, angle=0.0, shift=0.0):
        """2D: a square of side 3 with a hole of side 1, area 8, and further points."""
        place = lambda p: tuple(x + shift for x in turned(p, angle))
        points = [(0, 0), (3, 0), (3, 3), (0, 3), (1, 1), (2, 1), (2, 2), (1, 2), *extra]
        points = [place(p) for p in points]
        text = f"{len(points)} 2 1 1\n" + "".join(f"{i} {p[0]!r} {p[1]!r} {i / 2} {i}\n" for i, p in enumerate(points, 1))
        text += "8 1\n" + "".join(f"{i} {i} {i + 1 if i % 4 else i - 3} {i}\n" for i in range(1, 9))
        seed = place((1.5, 1.5))
        return self.file("hole.poly", text + f"1\n1 {seed[0]!r} {seed[1]!r}\n")

    def nodes(self, *flags):
        """Markers and cells' vertices of a mesh in TetGen's files."""
        self.output = self.folder / "out.ele"
        rows = [line.split() for line in (self.folder / "out.node").read_text().splitlines() if not line.startswith("#")]
        cells = [line.split() for line in self.output.read_text().splitlines() if not line.startswith("#")]
        used = {v for row in cells[1:] for v in row[1:int(cells[0][1]) + 1]}
        return rows[1:], used

    def expect(self, model, unused, volume, expect=(0, 1)):
        """Points of the input in no cell, by their numbers, with and without the flag."""
        self.output = self.folder / "out.ele"
        names = sorted(unused)
        meshes = []
        for flags in ([], ["--drop-unused-points"]):
            done = self.mesh(model, *flags, "--report", self.report, expect=None)
            self.assertIn(done.returncode, expect, done.stderr)
            report = self.json()
            self.assertEqual(report["unused_points"], {"count": len(unused), "dropped": bool(flags)})
            said = [w for w in report["warnings"] if "in no cell" in w["message"]]
            self.assertEqual([w["ids"] for w in said], [names] if names else [])
            self.assertEqual(done.stderr.count("in no cell"), len(said), done.stderr)
            self.assertAlmostEqual(sum(r["volume_meshed"] for r in report["regions"]), volume, 5)
            rows, used = self.nodes()
            lonely = {row[0] for row in rows} - used
            self.assertEqual(len(lonely), 0 if flags else len(unused))
            self.assertEqual(report["vertices"], len(rows))
            self.pgdr("check", self.output, "--input", model, "--reasons", self.report, "--report", self.folder / "check.json",
                      expect=done.returncode)
            checked = self.pgdr("check", self.output, "--input", model, "--reasons", self.report, expect=done.returncode).stdout
            self.assertEqual("in no cell" in checked, not flags and bool(unused))
            meshes.append((rows, {tuple(row[1:]) for row in rows if row[0] in used}))
        self.assertEqual(meshes[0][1], meshes[1][1])  # the same vertices with their markers and attributes
        if not unused:
            self.assertEqual(meshes[0][0], meshes[1][0])
        return meshes[1][0]

    def test_space(self):
        inside, void, outside = (0.5, 0.5, 0.5), (1.4, 1.6, 1.5), (7, 8, 9)
        for angle, shift in ((0.0, 0.0), (0.37, 0.0), (1.1, 4e5)):
            for extra in ([], [inside], [void], [outside], [void, inside, outside]):
                unused = [17 + i for i, p in enumerate(extra) if p is not inside]
                self.expect(self.box_with_void(extra, angle, shift), unused, 26)

    def test_plane(self):
        inside, void, outside = (0.5, 0.4), (1.4, 1.6), (7, 8)
        for angle, shift in ((0.0, 0.0), (0.37, 0.0), (1.1, 4e5)):
            for extra in ([], [inside], [void], [outside, inside], [void, inside, outside, (1.3, 1.2)]):
                unused = [9 + i for i, p in enumerate(extra) if p is not inside]
                self.expect(self.square_with_void(extra, angle, shift), unused, 8)

    def test_many_at_random(self):
        chance = random.Random(7)
        for _ in range(6):
            count = chance.randrange(1, 30)
            extra = [tuple(chance.uniform(-1, 4) for _ in range(2)) for _ in range(count)]
            is_used = lambda p: all(0 < x < 3 for x in p) and not all(1 < x < 2 for x in p)
            self.expect(self.square_with_void(extra), [9 + i for i, p in enumerate(extra) if not is_used(p)], 8)
            extra = [tuple(chance.uniform(-1, 4) for _ in range(3)) for _ in range(count)]
            self.expect(self.box_with_void(extra), [17 + i for i, p in enumerate(extra) if not is_used(p)], 26)

    def test_stopped_and_unrefined_runs(self):
        model = self.square_with_void([(7, 8), (0.5, 0.5), (1.5, 1.4)])
        for flags, code in ((["--max-vertices", "20", "--size", "0.01"], 5), (["--no-refine"], 0), (["--time-limit", "0.3", "--size", "1e-7"], 5)):
            done = self.mesh(model, *flags, "--drop-unused-points", "--report", self.report, expect=code)
            self.assertEqual(self.json()["unused_points"], {"count": 2, "dropped": True})
            self.pgdr("check", self.output, "--input", model, "--reasons", self.report, expect=0)
            self.assertIn("2 points are in no cell", done.stderr)

    def test_nothing_unused(self):
        for model in (PLATE, BRACKET):
            plain = (self.mesh(model, "--report", self.report, expect=None), self.output.read_bytes())[1]
            self.assertEqual(self.json()["unused_points"], {"count": 0, "dropped": False})
            self.mesh(model, "--drop-unused-points", expect=None)
            self.assertEqual(self.output.read_bytes(), plain)


if __name__ == "__main__":
    unittest.main(verbosity=2)
