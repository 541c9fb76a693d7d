#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What the pgdr command does in 2D alone, from outside. Usage: test_planar_command.py [Class[.test]...]"""
import unittest

from test_command import BRACKET, MODELS, PLATE, Case

RIVER = MODELS / "river.poly"
SQUARE = "0 0 0\n1 4 0\n2 4 4\n3 0 4\n"
# A square with two diagonals that cross in its middle; counts from 0.
CROSSED = "4 2 0 0\n" + SQUARE + "6 1\n0 0 1 1\n1 1 2 1\n2 2 3 1\n3 3 0 1\n4 0 2 2\n5 1 3 3\n0\n"


class Planar(Case):
    def checked(self, model, bounds, *flags, expect=0):
        """Meshes, checks with the same flags, and returns the report of the mesh."""
        self.mesh(model, *bounds, *flags, "--report", self.report, expect=expect)
        shared = [f for f in flags if f not in ("--keep-boundary", "--no-refine", "--neighbors", "--edges")]
        self.pgdr("check", self.output, "--input", model, *bounds, *shared, "--reasons", self.report, expect=expect)
        return self.json()

    def test_the_example_of_the_manual(self):
        size = "0.4*sqrt((x-200)^2+(y-200)^2)+1"
        report = self.checked(RIVER, ["--min-angle", 25, "--size", size])
        self.assertEqual(report["bounds"]["poor_left"], 0)
        self.assertGreaterEqual(report["quality"]["min_angle_deg"], 25 - 1e-9)
        self.assertEqual([w["code"] for w in report["warnings"]], ["beyond_theory"])

    def test_least_angles(self):
        self.assertEqual(self.checked(PLATE, ["--min-angle", 20.7])["warnings"], [])
        self.checked(PLATE, ["--min-angle", 34])
        done = self.pgdr("mesh", PLATE, "-o", self.output, "--min-angle", 34.5, expect=2)
        self.assertIn("34", done.stderr)

    def test_crossings(self):
        model = self.file("crossed.poly", CROSSED)
        done = self.mesh(model, "--report", self.report, expect=3)
        self.assertIn("cross at (2, 2)", done.stderr)
        self.assertIn("--resolve-crossings makes it valid", done.stderr)
        self.assertEqual(sorted(self.json()["errors"][0]["ids"]), [0, 1, 2, 3])
        self.assertFalse(self.output.exists())
        report = self.checked(model, ["--size", 1], "--resolve-crossings")
        repair, = report["repairs"]
        self.assertEqual((repair["code"], repair["ids"], repair["points"]), ("entities_intersect", [4, 5], [[2, 2, 0]]))
        self.pgdr("check", self.output, "--input", model, expect=0)  # the segments as given, crossing or not
        self.pgdr("check", self.output, "--input", model, "--size", 1, "--reasons", self.report, expect=0)
        self.pgdr("info", model, expect=3)
        self.pgdr("info", model, "--resolve-crossings", expect=0)

    def test_convex_hull(self):
        points = self.file("points.node", "5 2 0 0\n" + SQUARE + "4 1 1.5\n")
        done = self.mesh(points, expect=3)
        self.assertIn("enclose nothing", done.stderr)
        self.assertIn("--convex-hull makes it valid", done.stderr)
        self.assertIn("--convex-hull makes it valid", self.pgdr("info", points, expect=3).stderr)
        self.checked(points, ["--min-angle", 20], "--convex-hull")
        self.pgdr("check", self.output, "--input", points, expect=6)
        self.pgdr("check", self.output, "--input", points, "--min-angle", 20, "--reasons", self.report, expect=0)

    def test_open_ends_are_named(self):
        model = self.file("open.poly", "4 2 0 0\n" + SQUARE + "3 0\n0 0 1\n1 1 2\n2 2 3\n0\n")
        done = self.mesh(model, expect=3)
        self.assertIn("enclose nothing", done.stderr)
        self.assertIn("--convex-hull makes it valid", done.stderr)
        cross = self.file("cross.poly", "4 2 0 0\n" + SQUARE + "2 0\n0 0 2\n1 1 3\n0\n")
        done = self.mesh(cross, expect=3)
        self.assertIn("--resolve-crossings with --convex-hull makes it valid", done.stderr)
        self.checked(cross, ["--size", 1], "--resolve-crossings", "--convex-hull")

    def test_flags_that_would_not_work_are_not_named(self):
        line = self.file("line.node", "3 2 0 0\n0 0 0\n1 1 1\n2 2 2\n")
        self.assertNotIn("--convex-hull", self.mesh(line, expect=3).stderr)
        done = self.mesh(self.file("cross.poly", "4 2 0 0\n" + SQUARE + "2 0\n0 0 2\n1 1 3\n0\n"), "--resolve-crossings", expect=3)
        self.assertNotIn("--resolve-crossings", done.stderr)
        self.assertIn("--convex-hull makes it valid", done.stderr)

    def test_without_refinement(self):
        model = self.file("thin.poly", "3 2 0 0\n0 0 0\n1 8 0\n2 4 0.1\n3 0\n0 0 1\n1 1 2\n2 2 0\n0\n")
        self.assertIs(self.checked(model, [], "--no-refine")["refined"], False)
        self.pgdr("check", self.output, "--input", model, "--reasons", self.report, "--radius-edge", 1.5, expect=6)  # asked for

    def test_keep_boundary(self):
        report = self.checked(PLATE, ["--size", 0.02], "--keep-boundary", expect=1)
        self.assertGreater(report["cells"], 300)
        codes = {r["code"] for r in report["bounds"]["reasons"]}
        self.assertEqual(codes, {"kept_boundary"})
        for reason in report["bounds"]["reasons"]:
            self.assertEqual(reason["entities"][0]["kind"], "segment")
        self.pgdr("info", self.output, "--report", self.report, expect=0)
        self.assertEqual(self.json()["subsegments"], 6 + 16 + 12)

    def test_flags_are_for_2d(self):
        done = self.pgdr("mesh", BRACKET, "-o", self.output, "--region-areas", expect=2)
        self.assertIn("2D", done.stderr)

    def rows(self, suffix):
        """Numbers of the lines of one of the files of the mesh, its header first."""
        lines = self.output.with_suffix(suffix).read_text().splitlines()
        return [[float(w) for w in line.split()] for line in lines if not line.startswith("#")]

    def test_files_as_triangle_writes_them(self):
        # Counts from 0; two attributes, of which the first is x + 10; markers; a region of attribute 7 and area 1.
        points = ((0, 0, 3), (4, 0, 0), (4, 4, 0), (0, 4, 0), (1, 2, 0))
        model = self.file("square.poly", "5 2 2 1\n" + "".join(
            f"{i} {x} {y} {x + 10} 5 {m}\n" for i, (x, y, m) in enumerate(points)) +
            "4 1\n0 0 1 8\n1 1 2 0\n2 2 3 0\n3 3 0 9\n0\n1\n0 1 1 7 1\n")
        self.output = self.folder / "out.node"
        self.checked(model, ["--min-angle", 30], "--neighbors", "--edges")
        for first, flags in ((0, []), (1, ["--first-index", 1]), (0, ["--first-index", 0])):
            self.mesh(model, "--min-angle", 30, "--neighbors", "--edges", *flags, expect=0)
            node, ele, edge, neigh = (self.rows(s) for s in (".node", ".ele", ".edge", ".neigh"))
            self.assertEqual(node[0][1:], [2, 2, 1])
            self.assertEqual([n[0] for n in node[1:]], list(range(first, first + len(node) - 1)))
            for _, x, y, a, b, marker in node[1:]:
                self.assertAlmostEqual(a, x + 10, 12)
                self.assertEqual(b, 5)
                wanted = 3 if (x, y) == (0, 0) else 8 if y == 0 else 9 if x == 0 else 0
                self.assertEqual(marker, wanted, (x, y))
            corners = [tuple(c[1:4]) for c in ele[1:]]
            self.assertEqual(ele[0], [len(corners), 3, 1])
            self.assertEqual({c[4] for c in ele[1:]}, {7})
            self.assertEqual((neigh[0], [c[0] for c in neigh[1:]]), ([len(corners), 3], [c[0] for c in ele[1:]]))
            sides, place = {}, {i + first: c for i, c in enumerate(corners)}
            for i, c in place.items():
                (x0, y0), (x1, y1), (x2, y2) = (node[int(v) - first + 1][1:3] for v in c)
                area = ((x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)) / 2
                self.assertTrue(0 < area <= 1)
                for k in range(3):
                    sides.setdefault(frozenset((c[k - 1], c[k - 2])), []).append(i)
            for i, *others in neigh[1:]:
                for k, other in enumerate(others):
                    side = frozenset((place[i][k - 1], place[i][k - 2]))
                    self.assertEqual(sorted(sides[side]), sorted([i] if other == -1 else [i, other]))
            self.assertEqual(sorted(tuple(sorted(e[1:3])) for e in edge[1:]), sorted(tuple(sorted(s)) for s in sides))
            self.assertEqual({e[3] for e in edge[1:]}, {0, 8, 9})
            self.pgdr("check", self.output, "--input", model, "--min-angle", 30, expect=0)

    def test_a_single_number_of_a_region_is_its_label(self):
        square = "4 2 0 0\n0 0 0\n1 4 0\n2 4 4\n3 0 4\n4 0\n0 0 1\n1 1 2\n2 2 3\n3 3 0\n0\n1\n0 1 1 "
        label, both, none = (self.file(f"{name}.poly", square + end) for name, end in
                             (("label", "0.25\n"), ("both", "0.25 0.25\n"), ("none", "0.25 0\n")))
        cells = []
        for model, *flags in ((label,), (both,), (label, "--region-areas"), (both, "--region-areas"), (none, "--region-areas")):
            self.checked(model, flags)
            cells.append(self.json()["cells"])
            self.assertEqual([r["label"] for r in self.json()["regions"]], [0.25])
        self.assertEqual(cells[0], 2)
        self.assertGreaterEqual(cells[1], 64)
        self.assertEqual(cells[2:], [cells[1], cells[1], 2])
        # The report says to check how the input was read.
        self.mesh(label, "--region-areas", "--report", self.report, expect=0)
        self.pgdr("mesh", label, "--report", self.folder / "coarse.json", "-o", self.folder / "coarse.vtu", expect=0)
        self.pgdr("check", self.folder / "coarse.vtu", "--input", label, "--reasons", self.report, expect=6)
        self.pgdr("check", self.folder / "coarse.vtu", "--input", label, "--reasons", self.folder / "coarse.json", expect=0)

    def test_no_refinement(self):
        self.mesh(PLATE, "--no-refine", "--report", self.report, expect=0)
        self.pgdr("check", self.output, "--input", PLATE, expect=0)
        self.pgdr("info", self.output, "--report", self.report, expect=0)
        corners = self.json()["vertices"]
        lines = [line for line in PLATE.read_text().splitlines() if line and not line.startswith("#")]
        self.assertEqual(corners, int(lines[0].split()[0]))
        self.mesh(BRACKET, "--no-refine", expect=0)
        self.pgdr("check", self.output, "--input", BRACKET, expect=0)

    def test_output_flags_have_their_formats(self):
        for flags, name in ((["--neighbors"], "out.vtu"), (["--edges"], "out.msh"), (["--first-index", 0], "out.mesh"),
                            (["--leaves"], "out.node"), (["--first-index", 2], "out.node")):
            done = self.pgdr("mesh", PLATE, "-o", self.folder / name, *flags, expect=2)
            self.assertIn(flags[0], done.stderr)


if __name__ == "__main__":
    unittest.main()
