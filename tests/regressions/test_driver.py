#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The driver of the regressions: what is not as expected is found, and a .expect that says nothing is refused.

PGDR_COMMAND names the command. Usage: test_driver.py [Class[.test]...]
"""
import contextlib
import io
import pathlib
import tempfile
import unittest
from fractions import Fraction

import copies
import run  # which finds the oracles
import expect_file
import given_volumes
import motions
import same_outcome
import shapes

SQUARE = "4 2 0 0\n1 0 0\n2 1.5 0\n3 1.5 1.5\n4 0 1.5\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n1\n1 0.5 0.5 7 0.25\n"
CUBE = ("8 3 0 0\n" + "".join(f"{i} {i & 1} {i >> 1 & 1} {i >> 2}.25\n" for i in range(8)) + "6 0\n" + "".join(
    f"1 0\n4 {f}\n" for f in ("0 4 6 2", "1 3 7 5", "0 1 5 4", "2 6 7 3", "0 2 3 1", "4 5 7 6")) + "0\n0\n")
HEAD = "story: none\n"
RIGHT = HEAD + "regions: 7 = 2.25\nmost_cells: 100\nmost_poor: 0\nreasons: none\nmost_flat: 0\ncopies: turned, rounded, shifted\n"


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="pgdr_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def file(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return self.folder / name

    def main(self, *arguments):
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            return run.main([str(a) for a in arguments]), out.getvalue()


class ExpectFile(unittest.TestCase):
    def test_keys(self):
        first, second = expect_file.parse("# a comment\nstory: a\n  b\n" + "flags: --size\n  2\nexit: 0, 1\nvolume: -2e3 +- 1\n"
                                          "most_cells: 9\nsays: a\nsays: b\n---\nregions: 1 = 2; 2.5 = 3 +- 0.5\nmost_cells: 7\n")
        self.assertEqual(first.flags, ["--size", "2"])
        self.assertEqual(first.exit, (0, 1))
        self.assertEqual((first.volume.value, first.volume.tolerance), (-2000, 1))
        self.assertEqual([p.pattern for p in first.says], ["a", "b"])
        self.assertEqual(second.exit, (0,))
        self.assertEqual(second.regions[1].tolerance, 2e-6)
        self.assertTrue(second.regions[2.5].has(3.4) and not second.regions[2.5].has(3.6))

    def test_what_says_nothing_is_refused(self):
        body = "volume: 1\nmost_cells: 2\n"
        for text, word in ((body, "no story"), (HEAD + body + "most_cell: 3\n", "most_cell"), (HEAD + body + "volume: 2\n", "twice"),
                           (HEAD + "most_cells: 2\n", "volume"), (HEAD + "volume: 1\n", "most_cells"), (HEAD + "exit: 3\n", "says"),
                           (HEAD + "exit: 3\nsays: a\nvolume: 1\n", "no mesh"), (HEAD + body + "says: (\n", "regular expression"),
                           (HEAD + body + "copies: bent\n", "bent"), (HEAD + body + "flags: --threads 2\n", "driver"),
                           (HEAD + body + "exit: no\n", "whole numbers"), (HEAD + body + "regions: 1 = a\n", "LABEL"),
                           (HEAD + body + "most_poor: -1\n", "count"), (HEAD + body + "seconds: 0\n", "seconds"),
                           (HEAD + body + "volume\n", "key: value"), ("  x\n", "continues"), (HEAD + body + "---\n", "volume"),
                           (HEAD + body + "flags: --size 2\ncopies: turned\n", "--size"), (HEAD + "regions: 1 = 1; 1 = 2\n", "twice")):
            with self.subTest(text), self.assertRaisesRegex(expect_file.ExpectError, word):
                expect_file.parse(text)


class Copies(Folder):
    def copy(self, name, text, kind):
        path = self.file(name, text)
        scale = copies.copy(path, kind, self.folder / f"copy{path.suffix}")
        return scale, (self.folder / f"copy{path.suffix}").read_text().split()

    def test_turned_exactly(self):
        scale, words = self.copy("a.poly", SQUARE, "turned")
        self.assertEqual(scale, 50)
        self.assertEqual(words[4:16], "1 0 0 2 45 60 3 -15 105 4 -60 45".split())
        self.assertEqual([float(w) for w in words[-5:]], [1, -5, 35, 7, 625])
        scale, words = self.copy("a.off", "OFF\n# no comment\n3 1 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n", "turned")
        self.assertEqual((scale, words), (65, "OFF 3 1 0 39 20 48 -52 15 36 0 -60 25 3 0 1 2".split()))
        scale, words = self.copy("a.obj", "v 1 0 0\nvn 1 1 1\nv 0 1 0\nv 0 0 1\nf 1/1 2/2 3/3\n", "turned")
        self.assertEqual(words, "v 39 20 48 v -52 15 36 v 0 -60 25 f 1 2 3".split())

    def test_others(self):
        scale, words = self.copy("a.poly", SQUARE, "rounded")
        self.assertEqual((scale, [float(w) for w in words[8:13]]), (1, [0.9, 1.2, 3, -0.3, 2.1]))
        scale, words = self.copy("a.poly", CUBE, "shifted")
        self.assertEqual((scale, words[4:9]), (100, ["0", "131072", "-262144", "65561", "1"]))
        with self.assertRaises(copies.CopyError):
            self.copy("a.off", "OFF\n3 1 0\n1 0 0\n0 1 0\n0 0 0.1234567890123456789\n3 0 1 2\n", "turned")


class Driver(Folder):
    def expect(self, text, word="", name="a.poly", content=SQUARE):
        path = self.file(name, content)
        self.file("a.expect", text)
        code, said = self.main(path)
        self.assertEqual(code, 1 if word else 0, said)
        self.assertIn(word, said)

    def test_what_is_right(self):
        self.expect(RIGHT)
        self.expect(HEAD + "volume: 1\nmost_cells: 100\ncopies: turned, rounded, shifted\n", content=CUBE)

    def test_what_is_wrong_is_found(self):
        for change, word in (("exit: 1\n", "mesh ended with 0"), ("check: 1\n", "check ended with 0"), ("volume: 2.24\n", "volume 2.25"),
                             ("regions: 7 = 2\n", "region 7"), ("regions: 8 = 2.25\n", "labels [7]"), ("most_cells: 1\n", "cells"),
                             ("reasons: small_angle\n", "reasons []"), ("stop: max_vertices\n", "stop is finished"),
                             ("says: no such word\n", "no such word"), ("says_not: wrote\n", "wrote"),
                             ("report_says: no_key\n", "no_key"), ("seconds: 1e-5\n", "no end")):
            with self.subTest(change):
                key = change.split(":")[0]
                kept = "".join(line + "\n" for line in RIGHT.splitlines() if not line.startswith(key) and "copies" not in line)
                self.expect(kept + change, word)
        self.expect(HEAD + "exit: 3\nsays: .\n", "mesh ended with 0")
        self.expect("volume: 1\n", "no story")

    def test_flat_and_poor_elements_are_counted(self):
        needle = "3 2 0 0\n1 0 0\n2 1 0\n3 1 1e-5\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n"
        text = HEAD + "flags: --no-refine\ncheck: 0, 1, 6\nvolume: 5e-6\nmost_cells: 1\nmost_flat: 0\n"
        self.expect(text, "1 flat cells", content=needle)
        self.assertTrue(run.is_flat([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 1e-5)]))
        self.assertFalse(run.is_flat([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 1e-3)]))

    def test_files_are_pairs(self):
        path = self.file("a.poly", SQUARE)
        self.assertEqual(self.main("--files", self.folder), (1, f"{path}: no a.expect\n"))
        self.assertEqual(self.main(path)[0], 1)
        self.file("a.expect", RIGHT)
        self.assertEqual(self.main("--files", self.folder), (0, ""))
        self.file("b.expect", RIGHT)
        self.assertIn("0 inputs", self.main("--files", self.folder)[1])
        self.file("b.off", "")
        self.file("b.obj", "")
        self.assertIn("2 inputs", self.main("--files", self.folder)[1])


class FakeOutcome:
    """What became of an input, without a run."""

    def __init__(self, exit="meshed", volumes=None, given=True, entities=6):
        self.exit, self.volumes, self.report, self.ulp = exit, volumes or {1.0: Fraction(8)}, {"dimension": 3, "tolerance": 1e-9}, 1e-12
        self.entities = {"maximal_facets": entities}
        self.given = given_volumes.Given({1.0: given_volumes.Volume(Fraction(8), area=24)}, False) if given else None


class SameOutcome(unittest.TestCase):
    def test_what_differs_is_found(self):
        first = FakeOutcome()
        for copy, factor, word in ((FakeOutcome(), 1, ""), (FakeOutcome("no end"), 1, "exit no end"), (FakeOutcome(3), 1, "exit 3"),
                                   (FakeOutcome(volumes={2.0: Fraction(8)}), 1, "regions"), (FakeOutcome(), 2, "region 1"),
                                   (FakeOutcome(entities=7), 1, "facets"), (FakeOutcome(volumes={1.0: Fraction(64)}), 2, ""),
                                   (FakeOutcome(volumes={1.0: Fraction(9)}, given=False), 1, ""),
                                   (FakeOutcome(volumes={1.0: 8 + Fraction(1, 10 ** 6)}), 1, "region 1")):
            found = list(same_outcome.differences(first, copy, factor, 1e-12))
            self.assertEqual(len(found), 1 if word else 0, found)
            self.assertIn(word, "".join(found))

    def test_copies_of_a_pile(self):
        given = shapes.ALL["pile"]().input()
        self.assertEqual(same_outcome.of_input(run.COMMAND, "pile", given, [], 120, 0, motions.KINDS), [])


if __name__ == "__main__":
    unittest.main()
