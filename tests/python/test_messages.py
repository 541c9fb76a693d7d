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
        beyond_help = pgdr.Plc([[0, 0], [1, 0], [0, 0], [1, 0]], [[0, 1], [2, 3]])
        with self.assertRaises(pgdr.InputError) as caught:
            pgdr.mesh(beyond_help)
        self.assertNotIn("(plc)", str(caught.exception))


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
