#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What the pgdr command says of words that it does not know, which it knows, and that it warns once of each thing.
Usage: test_words.py [Class[.test]...]"""
import json
import math
import pathlib
import re
import unittest

from test_command import BRACKET, PLATE, Case

USAGE = pathlib.Path(__file__).resolve().parents[2] / "docs" / "usage.md"


class Expressions(Case):
    def refusal(self, text, model=PLATE):
        return self.mesh(model, "--size", text, expect=2).stderr

    def test_unknown_names_are_named_with_the_known_ones(self):
        for text, word in {"0.1*r": "r", "sine(x)": "sine", "X + 1": "X", "x + e": "e", "sqr(x) + 1": "sqr", "_pi": "_pi"}.items():
            said = self.refusal(text)
            self.assertIn(f'there is no "{word}"', said)
            for known in ("x, y;", "pi", "hypot", "if", "pow", "sqrt"):
                self.assertIn(known, said)
        self.assertIn('there is no "z"', self.refusal("0.1 + z"))
        self.assertIn("x, y, z", self.refusal("0.1 + w", BRACKET))
        self.assertIn('"sin"', self.refusal("sin + 1"))
        self.assertIn("parentheses", self.refusal("sin + 1"))

    def test_an_assignment_is_no_comparison(self):
        for text in ("x=1", "if(x = 1, 2, 3)", "1 + (y=2)"):
            self.assertIn("==", self.refusal(text))
        for text in ("if(x==1,0.5,1)", "if(x>=1,0.5,1)", "if(x<=1, 0.5, 1)", "if(x!=1, 0.5, 1)"):
            self.mesh(PLATE, "--size", text)

    def same(self, one, other, model=PLATE):
        """Both make the same mesh, and one that follows them."""
        made = []
        for text in (one, other):
            self.mesh(model, "--size", text, "--quiet", "--max-vertices", 3000, "--no-refine" if model is BRACKET else "--quiet")
            made.append(self.output.read_bytes())
        self.assertEqual(*made, f"{one}, {other}")

    def test_new_functions_are_what_they_say(self):
        self.same("0.1 + pow(x, 2)", "0.1 + x^2")
        self.same("0.1 + pow(x + 1, y)", "0.1 + (x + 1)^y")
        self.same("0.1 + hypot(x, y)", "0.1 + sqrt(x^2 + y^2)")
        self.same("if(x < 3, 0.1, 0.5)", "x < 3 ? 0.1 : 0.5")
        self.same("if(x < 3, 0.1, 1/0)", "x < 3 ? 0.1 : 1/0")  # an infinite size bounds nothing
        self.same("0.1*pi", f"{0.1 * math.pi!r}")
        self.same("0.1 + log(x + 2)", "0.1 + ln(x + 2)")
        self.assertIn("two or three", self.refusal("hypot(x)"))
        self.mesh(BRACKET, "--size", "0.2 + hypot(x, y, z)", "--no-optimize")

    def test_the_documents_list_what_there_is(self):
        """All functions that the message names are in docs/usage.md, which names no others."""
        said = self.refusal("unknown + 1")
        functions = set(re.search(r"functions: (.*)", said).group(1).split(", "))
        section = USAGE.read_text().split("### Expressions\n", 1)[1].split("\n#", 1)[0]
        listed = {re.match(r"\w+", code).group() for row in section.splitlines() if row.startswith("| functions")
                  for code in re.findall(r"`([^`]+)`", row)}
        self.assertEqual(listed, functions)
        self.assertGreater(len(listed), 20)
        for name in sorted(listed):
            arguments = {"if": "x, 1, 2", "hypot": "x, y", "pow": "x, y", "atan2": "x, y", "acosh": "1.5"}.get(name, "0.5")
            done = self.mesh(PLATE, "--size", f"1 + abs({name}({arguments}))", "--no-refine", expect=None)
            self.assertNotEqual(done.returncode, 2, f"{name}: {done.stderr}")


class Flags(Case):
    def refusal(self, *arguments):
        return self.pgdr(*arguments, expect=2).stderr

    def test_subcommands(self):
        for word in ("mehs", "triangulate", "--meesh"):
            said = self.refusal(word, PLATE, "-o", self.output)
            self.assertIn(f'"{word}"', said)
            self.assertIn("mesh, remesh, refine, check, info, view", said)
        self.assertIn("mesh, remesh, refine, check, info, view", self.refusal())

    def test_flags(self):
        for flag, meant in {"--sizes": "--size", "--radius-edges": "--radius-edge", "--kep-boundary": "--keep-boundary",
                            "--outptu": "--output"}.items():
            said = self.refusal("mesh", PLATE, "-o", self.output, flag, "3")
            self.assertIn(f"no flag {flag}; there is {meant}\n", said)
        said = self.refusal("check", self.output, "--reason=r.json")
        self.assertIn("no flag --reason; there is --reasons", said)
        said = self.refusal("mesh", PLATE, "-o", self.output, "--frobnicate")
        self.assertIn("mesh has no flag --frobnicate\n", said)
        self.assertIn("other.poly", self.pgdr("mesh", PLATE, "other.poly", "-o", self.output, expect=4).stderr)  # another input

    def test_values(self):
        """The wrong word, and all that would be right."""
        view = ["view", self.output, "-o", self.folder / "out.svg"]
        mesh = ["mesh", PLATE, "-o", self.output]
        for command, flag, known in ((mesh, "--selector", "circumcenter, off-center, optimized, sliver-avoiding, random"),
                                     (mesh, "--disk", "type1, type2"), (mesh, "--schedule", "greedy, reproducible, uniform"),
                                     (mesh, "--claims", "boxes, leaves"), (mesh, "--regions", "seeds"),
                                     (view, "--color", "dihedral, leaf, quality, region"), (view, "--cut", "x=, y= or z="),
                                     (mesh, "--first-index", "0 to 1"), (mesh, "--threads", "1 to 1024"),
                                     (mesh, "--min-dihedral", "between 0 and 35"), (mesh, "--region-size", "LABEL=S")):
            said = self.refusal(*command, flag, "wrong word")
            self.assertIn(flag, said)
            self.assertIn('"wrong word"', said)
            self.assertIn(known, said)

    def test_extensions(self):
        for name, known in (("model.xyz", ".poly"), ("model", ".stl")):
            self.assertIn(known, self.mesh(self.file(name, "0"), expect=3).stderr)
        self.assertIn(".vtu", self.pgdr("check", PLATE, expect=3).stderr)


class Warnings(Case):
    def test_each_is_said_once(self):
        """A segment that others split repeats these piece by piece."""
        points = "8 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n5 1 0\n6 2 0\n7 3 0\n8 2 4\n"
        model = self.file("twice.poly", points + "6 1\n1 1 2 1\n2 2 3 1\n3 3 4 1\n4 4 1 1\n5 1 7 2\n6 3 4 5\n0\n")
        for command in (("mesh", model, "-o", self.output), ("info", model)):
            done = self.pgdr(*command, "--report", self.report, expect=0)
            warnings = [line for line in done.stderr.splitlines() if "warning" in line]
            self.assertEqual(len(warnings), 2, done.stderr)
            self.assertEqual(len(set(warnings)), 2)
            said = [(w["line"], w["message"]) for w in self.json()["warnings"]]
            self.assertEqual(len(said), 2)
        self.assertEqual(sorted(line for line, _ in said), [15, 16])


class Quadrilaterals(Case):
    """2D: cells of four corners are cut into triangles, with their labels; 3D: facets."""

    def msh(self, name, points, elements):
        text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n" % len(points)
        text += "".join("%d %r %r 0\n" % (i, *p) for i, p in enumerate(points, 1)) + "$EndNodes\n$Elements\n%d\n" % len(elements)
        text += "".join("%d %d 2 %d 1 %s\n" % (i, code, label, " ".join(map(str, corners)))
                        for i, (code, label, corners) in enumerate(elements, 1))
        return self.file(name, text + "$EndElements\n")

    def grid(self, angle=0.0, shift=0.0):
        """4 by 4 points, and 3 by 3 quadrilaterals between them, of label 1 and, in the last column, 2."""
        c, s = math.cos(angle), math.sin(angle)
        points = [(c * i - s * j + shift, s * i + c * j + 10 * shift) for j in range(4) for i in range(4)]
        corner = lambda i, j: 4 * j + i + 1
        quads = [(3, 1 + (i == 2), (corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)))
                 for j in range(3) for i in range(3)]
        return points, quads

    def areas(self, model, expect=0):
        self.mesh(model, "--tolerance", "1e-7", "--report", self.report, expect=expect)
        self.pgdr("check", self.output, "--input", model, "--tolerance", "1e-7", expect=expect)
        return {r["label"]: round(r["volume_meshed"], 6) for r in self.json()["regions"]}

    def test_cells_of_a_plane(self):
        for angle, shift in ((0, 0), (0.7, 0), (1.9, 4e5)):
            points, quads = self.grid(angle, shift)
            self.assertEqual(self.areas(self.msh("quads.msh", points, quads)), {1: 6, 2: 3})
            lines = [(1, 5, (1 + i, 2 + i)) for i in range(3)]
            model = self.msh("lines.msh", points, lines + quads)
            self.assertEqual(self.areas(model), {1: 6, 2: 3})
            self.assertIn("5", (self.pgdr("mesh", model, "-o", self.folder / "o.ele", "--tolerance", "1e-7", expect=0),
                                (self.folder / "o.edge").read_text())[1].split())  # its marker
            mixed = quads[1:] + [(2, 1, (1, 2, 6)), (2, 1, (1, 6, 5))]
            self.assertEqual(self.areas(self.msh("mixed.msh", points, mixed)), {1: 6, 2: 3})
            void = [q for k, q in enumerate(quads) if k != 4]
            self.assertEqual(self.areas(self.msh("void.msh", points, void)), {1: 5, 2: 3})

    def test_a_dart_is_cut_where_it_can_be(self):
        for first in range(4):  # (1, 1) is a corner of more than 180 degrees
            order = [(first + k) % 4 + 1 for k in range(4)]
            for corners in (order, order[::-1]):
                model = self.msh("dart.msh", [(0, 0), (4, 1), (1, 1), (1, 4)], [(3, 0, corners)])
                self.mesh(model, "--report", self.report, expect=None)
                self.assertEqual([r["volume_meshed"] for r in self.json()["regions"]], [3.0])

    def test_what_crosses_itself_is_named(self):
        points, quads = self.grid()
        crossed = [(3, 1, (1, 6, 2, 5)), *quads[1:]]
        said = self.mesh(self.msh("crossed.msh", points, crossed), expect=3).stderr
        self.assertRegex(said, r"crossed.msh:\d+: quadrilateral 1 crosses itself")

    def test_they_are_no_cells_of_meshes(self):
        points, quads = self.grid()
        model = self.msh("quads.msh", points, quads)
        self.assertIn("Quadrilaterals", self.pgdr("check", model, expect=3).stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
