#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""pgdr join: one mesh of several. Usage: test_join.py [Class[.test]...]"""
import unittest

from test_command import Case


def rectangle(low, high, parts, label=True):
    """A .poly of a rectangle, each side in so many segments, with markers 1 to 4; maybe a label."""
    corners = [low, (high[0], low[1]), high, (low[0], high[1])]
    points = [tuple(a[i] + (b[i] - a[i]) * k / parts for i in range(2))
              for a, b in zip(corners, corners[1:] + corners[:1]) for k in range(parts)]
    n = len(points)
    text = f"{n} 2 0 0\n" + "".join(f"{i} {x!r} {y!r}\n" for i, (x, y) in enumerate(points)) + f"{n} 1\n"
    text += "".join(f"{i} {i} {(i + 1) % n} {1 + i // parts}\n" for i in range(n))
    return text + "0\n" + f"1\n0 {(low[0] + high[0]) / 2!r} {(low[1] + high[1]) / 2!r} 3\n" * label


def box(low, high, seed):
    """A .poly of a box with markers 1 to 6 and a label."""
    points = [(x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])]
    sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    text = "8 3 0 0\n" + "".join(f"{i} {p[0]} {p[1]} {p[2]}\n" for i, p in enumerate(points)) + "6 1\n"
    text += "".join(f"1 0 {m}\n4 {' '.join(map(str, side))}\n" for m, side in enumerate(sides, 1))
    return text + "0\n1\n0 " + " ".join(str((a + b) / 2) for a, b in zip(low, high)) + f" {seed}\n"


class Join(Case):
    def made(self, name, text, extension="vtu", *flags):
        mesh = self.folder / f"{name}_mesh.{extension}"
        self.pgdr("mesh", self.file(name + ".poly", text), "-o", mesh, *flags, expect=None)
        return mesh

    def join(self, *arguments, expect=0):
        return self.pgdr("join", *arguments, "-o", self.output, "--report", self.report, expect=expect)

    def test_plane(self):
        """Of different sizes, from files of three formats."""
        flags = "--keep-boundary", "--size"
        left = self.made("left", rectangle((0, 0), (1, 1), 8, False), "msh", *flags, 0.001, "--seed",
                         "0.1,0.1=steel")
        right = self.made("right", rectangle((1, 0), (2, 1), 8, False), "vtu", *flags, 0.01, "--seed",
                          "1.1,0.1=iron")
        upper = self.made("upper", rectangle((0, 1), (1, 2), 8), "mesh", *flags, 0.1)
        done = self.join(left, right, upper)
        report = self.json()
        self.assertEqual(report["interfaces"], [{"files": [str(left), str(right)], "markers": [2, 4], "count": 8},
                                                {"files": [str(left), str(upper)], "markers": [3, 1], "count": 8}])
        self.assertEqual(report["shared_points"], 9 + 9 - 1)
        self.assertEqual([(row["given"], row["label"]) for row in report["labels"]], [(1, 1), (1, 1), (3, 3)])
        self.assertIn(f'the name "iron" that {right} has for the label 1, which is called "steel"', report["dropped"])
        self.assertIn(f"8 edges of {left} and {right}, marker 2, there 4", done.stdout)
        self.assertIn("everything holds", self.pgdr("check", self.output, expect=0).stdout)
        self.join(left, right, upper, "--relabel")
        self.assertEqual([(row["given"], row["label"]) for row in self.json()["labels"]], [(1, 1), (1, 2), (3, 3)])
        self.pgdr("check", self.output, expect=0)
        info = self.pgdr("info", self.output, expect=0).stdout
        self.assertIn("steel (1), iron (2)", info)

    def test_space(self):
        low = self.made("low", box((0, 0, 0), (1, 1, 1), 1), "vtu", "--no-refine")
        high = self.made("high", box((0, 0, 1), (1, 1, 2), 2), "ele", "--no-refine")
        self.join(low, high)
        self.assertEqual(self.json()["interfaces"], [{"files": [str(low), str(high)], "markers": [2, 1], "count": 2}])
        self.assertEqual(self.json()["shared_segments"], [{"files": [str(low), str(high)], "markers": [0, 0], "count": 4}])
        self.pgdr("check", self.output, expect=0)

    def test_refused(self):
        flags = "--keep-boundary", "--size", 0.1
        left = self.made("left", rectangle((0, 0), (1, 1), 4), "vtu", *flags)
        right = self.made("right", rectangle((1, 0), (2, 1), 8), "vtu", *flags)
        done = self.join(left, right, expect=3)
        errors = self.json()["errors"]
        self.assertEqual({e["code"] for e in errors}, {"point_on_segment"})
        self.assertEqual(sorted(e["points"][0] for e in errors), [[1, k / 8, 0] for k in (1, 3, 5, 7)])
        self.assertIn(f"of {right} lies inside the edge with the vertices", done.stderr)
        self.assertFalse(self.output.exists())
        done = self.join(left, left, expect=3)
        self.assertIn("are on the same side of the edge", done.stderr)
        self.assertIn("more errors", done.stderr)

    def test_apart(self):
        left = self.made("left", rectangle((0, 0), (1, 1), 1), "vtu", "--no-refine")
        right = self.made("right", rectangle((1 + 1e-12, 0), (2, 1), 1), "vtu", "--no-refine")
        done = self.join(left, right)
        self.assertIn("nothing: no two meshes share a face", done.stdout)
        self.assertEqual([w["code"] for w in self.json()["warnings"]], ["near_points"] * 2)
        self.assertIn("apart, and not one, at (1.000000000001, 0)", done.stderr)

    def test_usage(self):
        left = self.made("left", rectangle((0, 0), (1, 1), 1), "vtu", "--no-refine")
        cube = self.made("cube", box((0, 0, 0), (1, 1, 1), 1), "vtu", "--no-refine")
        poly = self.folder / "left.poly"
        for arguments, code, words in [((left,), 2, "At least 2 required"),
                                       ((left, cube), 2, f"this mesh is 3D, {left} is 2D"),
                                       ((left, poly), 3, "this is no mesh: there are no cells to join"),
                                       ((left, self.folder / "none.vtu"), 4, "No such file"),
                                       ((left, self.file("bad.vtu", "<VTK")), 3, "bad.vtu")]:
            self.assertIn(words, self.join(*arguments, expect=code).stderr)
        done = self.pgdr("join", left, cube, "-o", left, expect=2)
        self.assertIn("the output would replace a mesh", done.stderr)
        self.assertIn("meshes are written as", self.pgdr("join", left, left, "-o", "x.stl", expect=2).stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
