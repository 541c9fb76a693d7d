#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What `pgdr mesh` and `pgdr info` say before anything takes long, and how soon they end when told to.

PGDR_COMMAND names the command, PGDR_SANITIZE its sanitizers, if any. Usage: test_estimates.py [Class[.test]...]
"""
import math
import re
import resource
import sys
import unittest

from test_command import BRACKET, MODELS, PLATE, SANITIZE, Case

# Two facets at 6e-6 degrees: no program recovers that boundary in a time that anybody would wait.
WEDGE = """10 3 0 1
1 0.0 0.0 0.0 0
2 100.0 0.0 0.0 0
3 100.0 40.0 0.0 0
4 0.0 40.0 0.0 0
5 100.0 0.0 1.064650843716545e-05 0
6 100.0 40.0 1.064650843716545e-05 0
7 0.0 0.0 50.0 0
8 100.0 0.0 50.0 0
9 100.0 40.0 50.0 0
10 0.0 40.0 50.0 0
10 1
1 0 1\n4 1 2 3 4
1 0 2\n4 1 5 6 4
1 0 3\n4 7 8 9 10
1 0 4\n3 1 2 5
1 0 4\n3 4 3 6
1 0 5\n4 2 3 6 5
1 0 6\n4 1 5 8 7
1 0 6\n4 4 6 9 10
1 0 7\n4 5 6 9 8
1 0 8\n4 1 4 10 7
0
0
"""


def box(x, y, z, first=0):
    """Points and facets of a box from the origin."""
    points = [(a, b, c) for c in (0, z) for b in (0, y) for a in (0, x)]
    faces = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
    return points, [tuple(first + v for v in face) for face in faces]


def poly(points, faces):
    lines = [f"{len(points)} 3 0 0"] + [f"{i} {p[0]!r} {p[1]!r} {p[2]!r}" for i, p in enumerate(points)]
    lines += [f"{len(faces)} 0"] + ["1 0\n" + " ".join(map(str, (len(f),) + f)) for f in faces]
    return "\n".join(lines + ["0", "0", ""])


class Estimates(Case):
    def test_models_have_no_fewer_cells(self):
        """A mesh within sizes has some 2.5 times as many in 3D, where no regular tetrahedra fill space, and 1.6 times in 2D."""
        for model, flags in ((BRACKET, []), (BRACKET, ["--size", "0.1"]), (BRACKET, ["--max-volume", "0.0005"]),
                             (BRACKET, ["--size", "0.05+0.1*abs(x)"]), (PLATE, []), (PLATE, ["--size", "0.001"])):
            with self.subTest(model=model.name, flags=flags):
                done = self.mesh(model, *flags, "--report", self.report, expect=0)
                r = self.json()
                self.assertLessEqual(r["estimated_cells"], r["cells"])
                self.assertGreater(r["estimated_cells"], r["cells"] / 3 if flags else 10)
                self.assertRegex(done.stdout, r"estimate +at least [\d ]+")
                self.assertLess(done.stdout.index("estimate"), done.stdout.index("input"))

    def test_the_narrowest_gap_is_named(self):
        points, faces = box(2.0, 3.0, 0.125)
        model = self.file("slab.poly", poly(points, faces))
        for command in (["info", model], ["mesh", model, "-o", self.output]):
            done = self.pgdr(*command, "--report", self.report, expect=0)
            gap = self.json()["narrowest_gap"]
            self.assertEqual(gap["distance"], 0.125)
            self.assertEqual([e["kind"] for e in gap["entities"]], ["facet", "facet"])
            self.assertEqual(sorted(e["id"] for e in gap["entities"]), [0, 1])
            self.assertEqual(math.dist(*gap["points"]), 0.125)
            self.assertRegex(done.stdout, r"narrowest +facets \d and \d, 0\.125 apart")
            self.assertGreater(self.json()["estimated_cells"], 0)

    def test_numbers_can_be_read_back(self):
        done = self.mesh(BRACKET, "--size", "x-2", "--report", self.report, expect=2)
        error = self.json()["errors"][0]
        said = re.search(r"returned (\S+) at \((.*)\); sizes", done.stderr)
        self.assertEqual([float(x) for x in said[2].split(", ")], error["points"][0])
        self.assertEqual(float(said[1]), error["points"][0][0] - 2)

    def test_what_is_not_refined_has_no_estimate(self):
        self.mesh(BRACKET, "--no-refine", "--report", self.report)
        self.assertNotIn("estimated_cells", self.json())
        self.assertIn("narrowest_gap", self.json())

    @unittest.skipIf(SANITIZE, "a limit on addresses leaves sanitizers none")
    def test_what_there_is_no_memory_for(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))

        model = self.file("slab.poly", poly(*box(1.0, 1.0, 1e-6)))
        done = self.mesh(model, "--report", self.report, expect=7, preexec_fn=limit)
        self.assertRegex(done.stderr, r"facets \d and \d are 1e-06 apart.*--time-limit")
        self.assertEqual(self.json()["errors"][0]["code"], "out_of_memory")
        self.assertEqual(len(self.json()["errors"][0]["points"]), 2)
        self.mesh(model, "--max-vertices", "1000", expect=5, preexec_fn=limit)  # the user has bounded it


def children_seconds():
    """The processor's, of all commands that have ended."""
    return sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])


class TimeLimit(Case):
    """1.1 S + 1 s, of the processor, on one thread: what else the machine does takes nothing of that."""

    def ends_in_time(self, model, seconds, expect):
        begin = children_seconds()
        done = self.mesh(model, "--threads", 1, "--time-limit", seconds, "--report", self.report, expect=expect)
        self.assertLess(children_seconds() - begin, (20 if SANITIZE else 1) * (1.1 * seconds + 1))
        return done

    def test_a_boundary_that_is_not_recovered(self):
        done = self.ends_in_time(self.file("wedge.poly", WEDGE), 4, 5)
        self.assertRegex(done.stdout, r"sharpest +facets 1 and 2, at 6\.1e-06 degrees")
        self.assertRegex(done.stdout, r"narrowest .*\bfacet \d")
        self.assertIn("before the boundary was there", done.stdout)
        self.assertFalse(self.output.exists())

    def test_before_there_is_a_boundary(self):
        done = self.ends_in_time(BRACKET, 0, 5)
        self.assertIn("before the boundary was there", done.stdout)
        self.assertEqual(self.json()["stop"], "time_limit")


class Proposals(Case):
    def prism(self, decimals):
        """Over a polygon of 12 corners, turned: its side faces are planar but for the digits."""
        corners = [(math.cos(math.pi * k / 6), math.sin(math.pi * k / 6)) for k in range(12)]
        points = [(x, y, z) for z in (0, 1) for x, y in corners]
        c, s = math.cos(0.7), math.sin(0.7)
        points = [(c * x - s * z, y, s * x + c * z) for x, y, z in points]
        points = [(x, c * y - s * z, s * y + c * z) for x, y, z in points]
        points = [tuple(round(100 * value, decimals) for value in p) for p in points]
        sides = [[(k, (k + 1) % 12, 12 + (k + 1) % 12), (k, 12 + (k + 1) % 12, 12 + k)] for k in range(12)]
        ends = [(first, first + k, first + k + 1) for first in (0, 12) for k in range(1, 11)]
        return self.file("prism.poly", poly(points, [f for side in sides for f in side] + ends))

    def test_faces_of_few_digits(self):
        model = self.prism(4)
        done = self.pgdr("info", model, "--report", self.report, expect=0)
        proposal = self.json()["proposal"]
        self.assertEqual(proposal["tolerance"], 0.0002)
        self.assertGreater(proposal["facets"], proposal["facets_then"])
        self.assertEqual(proposal["facets_then"], 14)
        self.assertRegex(done.stdout, r"--tolerance (0\.0002|2e-04), .* makes 14 facets")
        self.pgdr("info", model, "--tolerance", "0.0002", "--report", self.report, expect=0)
        self.assertNotIn("proposal", self.json())
        self.assertEqual(self.json()["diagnosis"]["maximal_facets"], 14)

    def test_none_where_it_changes_nothing(self):
        for model in (BRACKET, PLATE, self.prism(17)):
            self.pgdr("info", model, "--report", self.report, expect=0)
            self.assertNotIn("proposal", self.json())

    # A square; a line ends at its right side, but for a thousandth.
    SQUARE = ("6 2 0 0\n0 0 0\n1 10.111 0.333\n2 9.777 10.555\n3 0.123 9.876\n4 {x} 5.170\n5 4.123 5.678\n"
              "5 0\n0 0 1\n1 1 2\n2 2 3\n3 3 0\n4 4 5\n0\n")

    def test_a_point_that_misses_a_line(self):
        self.pgdr("info", self.file("square.poly", self.SQUARE.format(x="9.952")), "--report", self.report, expect=0)
        proposal = self.json()["proposal"]
        self.assertEqual((proposal["tolerance"], proposal["joined"]), (0.002, 1))

    def test_a_refusal_names_it(self):
        model = self.file("square.poly", self.SQUARE.format(x="9.953"))  # crosses the side by 5e-5
        self.assertIn("--tolerance 0.002 makes it valid", self.pgdr("info", model, expect=3).stderr)
        self.pgdr("info", model, "--tolerance", "0.002", expect=0)

    def test_no_refusal_names_what_would_join_features(self):
        model = self.file("square.poly", self.SQUARE.format(x="9.953") + "\n")
        text = model.read_text().replace("6 2 0 0", "8 2 0 0")
        text = text.replace("5 4.123 5.678\n", "5 4.123 5.678\n6 2.000 5.000\n7 2.015 5.000\n")
        self.assertNotIn("--tolerance", self.pgdr("info", self.file("near.poly", text), expect=3).stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
