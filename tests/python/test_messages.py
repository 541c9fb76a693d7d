# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What is said: in the words of the package, with what helps, and where a callback never came to its turn."""
import inspect
import pathlib
import re
import unittest
import warnings

import numpy as np

import pgdr
from pgdr._errors import in_python
from shapes import checked, cube, square

ROOT = pathlib.Path(__file__).resolve().parents[2]
ARGUMENTS = {*inspect.signature(pgdr.mesh).parameters, *inspect.signature(pgdr.Plc).parameters}


class Words(unittest.TestCase):
    def test_flags_have_names_here(self):
        """Every flag that a string of the library names is an argument or a function of the package."""
        found = set()
        for layer in ("geometry", "core", "scheduler"):
            for source in (ROOT / layer).rglob("*.[ch]pp"):
                for literal in re.findall(r'"(?:[^"\\\n]|\\.)*"', source.read_text(encoding="utf-8")):
                    found.update(re.findall(r"--[a-z]+(?:-[a-z]+)*", literal))
        self.assertIn("--yes-coarse", found)
        for flag in sorted(found) + ["--resolve-crossings", "--convex-hull", "--max-vertices", "--time-limit", "--keep-boundary"]:
            with self.subTest(flag):
                name = re.match(r"(?:pgdr\.)?(\w+)", in_python(flag)).group(1)
                self.assertTrue(name in ARGUMENTS or hasattr(pgdr, name), name)
                self.assertNotIn("--", in_python(f"with {flag} it is valid"))

    def test_values(self):
        for flag, words in (("--tolerance 1e-05 makes it valid", "tolerance=1e-05 makes it valid"), ("--tolerance=2", "tolerance=2"),
                            ("--regions auto, say", 'regions="auto", say'), ("--min-edge and so on", "min_edge and so on"),
                            ("two--dashes - -- a", "two--dashes - -- a"), ("--max-vertices or --time-limit", "max_vertices or time_limit")):
            self.assertEqual(in_python(flag), words)

    def test_a_coarse_tolerance(self):
        with self.assertRaises(pgdr.UsageError) as caught:
            pgdr.mesh(square(tolerance=0.3))
        self.assertIn("coarse=True", str(caught.exception))
        self.assertNotIn("--", str(caught.exception))

    def test_what_makes_a_plane_graph_valid(self):
        cross = pgdr.Plc([[0, 0], [2, 0], [2, 2], [0, 2], [-1, 1], [3, 1]], [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5]])
        bare = pgdr.Plc([[0, 0], [1, 1], [0, 1], [1, 0]], [[0, 1], [2, 3]])
        opened = pgdr.Plc([[0, 0], [2, 0], [2, 2]], [[0, 1], [1, 2]])
        for plc, names, mend in ((cross, ["resolve_crossings"], lambda p: pgdr.resolve_crossings(p)[0]),
                                 (bare, ["resolve_crossings", "with_convex_hull"],
                                  lambda p: pgdr.resolve_crossings(pgdr.with_convex_hull(p))[0]),
                                 (opened, ["with_convex_hull"], pgdr.with_convex_hull)):
            with self.assertRaises(pgdr.InputError) as caught:
                pgdr.mesh(plc)
            for name in names:
                self.assertIn(f"pgdr.{name}(plc)", str(caught.exception))
                self.assertIn(f"pgdr.{name}(plc)", caught.exception.message)
            checked(self, mend(plc))

    def test_points_alone_in_space(self):
        bare = pgdr.Plc([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0.2, 0.3, 0.2]])
        with self.assertRaises(pgdr.InputError) as caught:
            pgdr.mesh(bare)
        self.assertIn("pgdr.with_convex_hull(plc)", caught.exception.message)
        hull = pgdr.with_convex_hull(bare)
        self.assertEqual((len(hull.facets), hull.dimension), (4, 3))
        checked(self, hull)
        with self.assertRaises(pgdr.InputError) as caught:
            pgdr.with_convex_hull(pgdr.Plc([[0, 0, 1], [1, 0, 1], [0, 1, 1]]))
        self.assertEqual(caught.exception.code, "no_volume")
        beyond_help = pgdr.Plc([[0, 0], [1, 0], [0, 0], [1, 0]], [[0, 1], [2, 3]])
        with self.assertRaises(pgdr.InputError) as caught:
            pgdr.mesh(beyond_help)
        self.assertNotIn("(plc)", str(caught.exception))


    def test_a_tolerance_that_welds(self):
        """A tetrahedron each of whose triangles has corners of its own, 1e-4 off."""
        corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])[[0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3]]
        points = corners + np.random.default_rng(1).uniform(-5e-5, 5e-5, corners.shape)
        plc = pgdr.Plc(points, facets=np.arange(12).reshape(4, 3))
        with self.assertRaises(pgdr.InputError) as caught:
            pgdr.mesh(plc)
        found = re.search(r"not welded: .* apart; tolerance=(\S+) joins them, and makes it valid", str(caught.exception))
        self.assertTrue(found, str(caught.exception))
        checked(self, plc, tolerance=float(found.group(1)))

    def test_a_box_without_a_lid(self):
        corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
        sides = [(0, 2, 3, 1), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        plc = pgdr.Plc(corners, facets=sides)
        with self.assertRaises(pgdr.InputError) as caught:
            pgdr.mesh(plc)
        self.assertIn("open, with 1 opening that lies in a plane: pgdr.close_planar_openings(plc)", str(caught.exception))
        closed, openings = pgdr.close_planar_openings(plc)
        self.assertEqual([(o.code, sorted(o.ids)) for o in openings], [("open_boundary", [4, 5, 6, 7])])
        made = checked(self, closed)
        self.assertEqual(made.marker_names, {1: "closed_opening_1"})
        self.assertEqual(pgdr.close_planar_openings(closed)[1], [])
        with self.assertRaises(TypeError):
            pgdr.close_planar_openings(corners)
        with self.assertRaises(pgdr.UsageError):
            pgdr.close_planar_openings(square())

    def test_bodies_that_overlap(self):
        corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
        sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        plc = pgdr.Plc([*corners, *[tuple(x + 0.5 for x in p) for p in corners]], facets=sides + [[v + 8 for v in f] for f in sides])
        with self.assertRaises(pgdr.InputError) as caught:
            pgdr.mesh(plc)
        self.assertIn('2 closed bodies that overlap: pgdr.with_bodies(plc, "union", resolve_crossings=True)', str(caught.exception))
        self.assertNotIn("--", str(caught.exception))
        checked(self, pgdr.with_bodies(plc, "union", resolve_crossings=True)[0])

    def test_points_that_make_an_input_valid(self):
        """Two tetrahedra whose edges cross where neither has a point."""
        points = [(-1, 0, 0), (1, 0, 0), (0, -1, -1), (0, 1, -1), (0, -1, 0), (0, 1, 0), (-1, 0, 1), (1, 0, 1)]
        facets = [(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2), (4, 5, 6), (4, 7, 5), (4, 6, 7), (5, 7, 6)]
        with self.assertRaisesRegex(pgdr.InputError, r"to add a point at \(0, 0, 0\) to the input makes it valid"):
            pgdr.mesh(pgdr.Plc(points, facets=facets))
        checked(self, pgdr.Plc([*points, (0, 0, 0)], facets=facets))

    def test_a_tolerance_that_makes_an_input_valid(self):
        """A strut whose end is beyond the wall by the last digit: it is on the wall with the tolerance that the message names."""
        points = [[0, 0], [3.1, 0], [3.1, 3.1], [0, 3.1], [1.2345671, -0.0000001], [1.7, 1.8]]
        plc = pgdr.Plc(points, [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5]])
        with self.assertRaises(pgdr.InputError) as caught:
            pgdr.mesh(plc)
        found = re.search(r"tolerance=([-+0-9.e]+) makes it valid", str(caught.exception))
        self.assertIsNotNone(found, caught.exception)
        checked(self, plc, tolerance=float(found.group(1)))


class Ahead(unittest.TestCase):
    """`estimate`, and what `info` says of it."""

    def test_a_narrow_gap(self):
        """Two plates a little apart, in a box: both are named, and no mesh has fewer cells than is said."""
        for gap in (0.05, 0.01):
            at = np.vstack([cube().points * [4, 4, 1], cube().points * [1, 1, 0.2] + [1, 1, 0.3],
                            cube().points * [1, 1, 0.2] + [1, 1, 0.5 + gap]])
            plc = pgdr.Plc(at, facets=[[8 * k + v for v in facet] for k in range(3) for facet in cube().facets.tolist()])
            ahead = pgdr.estimate(plc)
            self.assertAlmostEqual(ahead.narrowest_gap.distance, gap)
            self.assertEqual(sorted(ahead.narrowest_gap.entities), [("facet", 7), ("facet", 12)])
            self.assertAlmostEqual(ahead.narrowest_gap.points[1][2] - ahead.narrowest_gap.points[0][2], gap)
            self.assertAlmostEqual(ahead.sharpest_angle.degrees, 90)
            self.assertTrue(50 < ahead.at_least <= ahead.cells, ahead)
            self.assertLessEqual(ahead.at_least, len(pgdr.mesh(plc, optimize=False).cells))
            self.assertEqual(pgdr.info(plc)["estimate"], ahead)

    def test_what_there_is_no_memory_for(self):
        """Two plates 1e-7 apart in a box: refused at once, unless the run is bounded, or somebody says that it may be tried."""
        plate = cube().points * [1, 1, 0.2]
        at = np.vstack([cube().points * [4, 4, 1], plate + [1, 1, 0.3], plate + [1, 1, 0.5000001]])
        plc = pgdr.Plc(at, facets=[[8 * k + v for v in facet] for k in range(3) for facet in cube().facets.tolist()])
        with self.assertRaisesRegex(pgdr.ResourceError, "apart"):
            pgdr.mesh(plc)
        self.assertEqual(pgdr.mesh(plc, max_vertices=1000).stop, "max_vertices")
        stop = pgdr.StopSource()
        stop.stop()
        self.assertEqual(pgdr.mesh(plc, memory_guard=False, stop=stop).stop, "cancelled")

    def test_sizes(self):
        for plc, size in ((square(), 0.001), (cube(), 0.08)):
            cells = len(checked(self, plc, size=size).cells)
            for given in (size, lambda at, size=size: np.full(len(at), size), pgdr.sizes_at_points(plc.points[:1], [size], 0)):
                self.assertTrue(cells / 3 < pgdr.estimate(plc, size=given).cells <= cells)
        labelled = cube(regions=[(0.5, 0.5, 0.5, 7)])
        self.assertGreater(pgdr.estimate(labelled, region_sizes={7: 0.05}).cells, 10 * pgdr.estimate(labelled).cells)
        self.assertAlmostEqual(pgdr.estimate(cube(), max_volume=1e-5).cells, 1e5)

    def test_a_proposal(self):
        """A square of eight points, the middle ones a last digit off the line of the others."""
        at = [[0, 0, 0], [1.23456, 0, 0.00001], [2.46913, 0, 0], [2.46913, 1, 0], [1.23456, 1, 0], [0, 1, 0]]
        top = [[x, y, 1] for x, y, _ in at]
        facets = [[0, 5, 4, 1], [1, 4, 3, 2], [6, 7, 10, 11], [7, 8, 9, 10], [0, 1, 7, 6], [1, 2, 8, 7], [2, 3, 9, 8], [3, 4, 10, 9],
                  [4, 5, 11, 10], [5, 0, 6, 11]]
        plc = pgdr.Plc(at + top, facets=facets)
        ahead = pgdr.estimate(plc)
        self.assertEqual(ahead.proposal.tolerance, 2e-5)
        self.assertLess(ahead.proposal.facets_then, ahead.proposal.facets)
        self.assertIsNone(pgdr.estimate(plc, tolerance=1e-5).proposal)
        self.assertIsNone(pgdr.estimate(cube()).proposal)

    def test_what_has_no_mesh(self):
        cross = pgdr.Plc([[0, 0], [1, 1], [0, 1], [1, 0]], [[0, 1], [2, 3]])
        for plc in (cross, pgdr.Plc(cube().points), pgdr.Plc(cross.points)):
            with self.assertRaises(pgdr.InputError):
                pgdr.estimate(plc)
            self.assertIsNone(pgdr.info(plc)["estimate"])
        with self.assertRaises(TypeError):
            pgdr.estimate([[0, 0]])
        with self.assertRaises(ZeroDivisionError):
            pgdr.estimate(cube(), size=lambda at: 1 / 0)


class Selectors(unittest.TestCase):
    NEEDLE = [[0, 0], [4, 0], [4, 0.5], [0, 0.5], [0.02, 0.01]]

    def test_one_that_is_never_called(self):
        for plc, size in ((square(), 0.005), (cube(), 0.2)):
            with self.assertWarnsRegex(UserWarning, "never called"):
                made = checked(self, plc, size=size, selector=lambda e: 1 / 0)
            said, = [w for w in made.warnings if w.code == "unused_selector"]
            self.assertIn("radius-edge", said.message)
        with self.assertWarnsRegex(UserWarning, "refine=False"):
            pgdr.mesh(square(), refine=False, selector=lambda e: 1 / 0)

    def test_one_that_is_called(self):
        plc = pgdr.Plc(self.NEEDLE, [[0, 1], [1, 2], [2, 3], [3, 0]])
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            made = checked(self, plc, selector=lambda e: e.circumcenter)
            self.assertEqual([w for w in made.warnings if w.code == "unused_selector"], [])
            with self.assertRaises(ZeroDivisionError):
                pgdr.mesh(plc, selector=lambda e: 1 / 0)
            self.assertEqual(pgdr.mesh(square(), size=0.1, selector="circumcenter").warnings, [])
        self.assertGreater(len(made.points), np.array(self.NEEDLE).shape[0])


if __name__ == "__main__":
    unittest.main()
