#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The oracle of volumes knows what inputs enclose, and finds meshes that are something else."""
import math
import pathlib
import random
import struct
import sys
import tempfile
import unittest
from fractions import Fraction

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "regressions"))
# pylint: disable=wrong-import-position
import given_volumes
import input_files
import motions
import shapes

SQUARE = "4 2 0 0\n0 0 0\n1 3 0\n2 3 2\n3 0 2\n4 0\n0 0 1\n1 1 2\n2 2 3\n3 3 0\n0\n"
MESH = ("MeshVersionFormatted 2\nDimension 2\nVertices\n4\n0 0 0\n3 0 0\n3 {} 0\n0 2 0\nTriangles\n2\n1 2 3 {}\n1 3 4 {}\nEnd\n")


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="pgdr_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def file(self, name, data):
        (self.folder / name).write_bytes(data if isinstance(data, bytes) else data.encode())
        return self.folder / name

    def volumes(self, path, *flags):
        given = given_volumes.volumes_given(path, flags)
        return {label: float(v.given) for label, v in given.volumes.items()}

    def of_shape(self, name):
        path = self.folder / "shape.poly"
        input_files.write_poly(shapes.ALL[name]().input(), path)
        return self.volumes(path)


class Volumes(Folder):
    def test_made_shapes(self):
        for name, expected in (("rooms", {0: 34, 1: 14, 2: 12}), ("parcels", {1: 60, 2: 63}), ("bricks", {0: 36}), ("house", {0: 2080}),
                               ("walls", {1: 54, 2: 30, 3: 60}), ("layers", {1: 24, 2.5: 12, 4.5: 36}), ("half_faces", {1: 8, 2: 8}),
                               ("box_on_floor", {1: 26, 2: 1}), ("cells", {0: 26, 4: 1}), ("cracked_plate", {0: 16})):
            with self.subTest(name):
                self.assertEqual(self.of_shape(name), expected)

    def test_copies_enclose_as_much(self):
        for name in ("pipes", "tunnel", "lead"):
            given = shapes.ALL[name]().input()
            first = self.of_shape(name)
            for kind in ("turned", "permuted", "floats"):
                copy, factor, rounding = motions.KINDS[kind](given, random.Random(1))
                self.assertEqual(factor, 1)
                input_files.write_poly(copy, self.folder / "copy.poly")
                for label, volume in self.volumes(self.folder / "copy.poly").items():
                    self.assertAlmostEqual(volume, first[label], delta=1e5 * rounding)

    def test_nested_shells(self):
        text = "24 3 0 0\n" + "".join(f"{8 * k + i} {s * (i & 1) - s / 2} {s * (i >> 1 & 1) - s / 2} {s * (i >> 2) - s / 2}\n"
                                      for k, s in enumerate((6, 4, 2)) for i in range(8)) + "18 0\n"
        for k in range(3):
            for f in ("0 4 6 2", "1 3 7 5", "0 1 5 4", "2 6 7 3", "0 2 3 1", "4 5 7 6"):
                text += "1 0\n4 " + " ".join(str(8 * k + int(v)) for v in f.split()) + "\n"
        path = self.file("nested.poly", text + "1\n0 0 0 0\n1\n0 0 0 1.5 7\n")
        self.assertEqual(self.volumes(path), {0: 152, 7: 56})
        automatic = given_volumes.volumes_given(self.file("nested.poly", text + "0\n0\n"), ["--regions", "auto"])
        self.assertEqual((automatic.volumes, sorted(v.given for v in automatic.unlabelled)), ({}, [8, 152]))
        every = given_volumes.volumes_given(self.file("nested.poly", text + "0\n0\n"), ["--regions", "all"])
        self.assertEqual((every.volumes, sorted(v.given for v in every.unlabelled)), ({}, [8, 56, 152]))

    def test_convex_hull(self):
        path = self.file("points.node", "5 2 0 0\n1 0 0\n2 1 0\n3 3 0\n4 3 2\n5 0 2\n")
        self.assertEqual(self.volumes(path, "--convex-hull"), {0: 6})

    def test_walls_that_miss_by_an_ulp(self):
        for end, leaks in ((2.0, False), (math.nextafter(2, 0), True), (math.nextafter(2, 3), None)):
            wall = SQUARE.replace("4 2 0 0", "6 2 0 0").replace("4 0\n0 0 1", f"4 1 0\n5 1 {end!r}\n5 0\n4 4 5\n0 0 1")
            path = self.file("wall.poly", wall)
            if leaks is None:
                with self.assertRaisesRegex(input_files.UnknownInput, "cross"):
                    given_volumes.volumes_given(path)
            else:
                self.assertEqual(given_volumes.volumes_given(path).leaks, leaks)


class Formats(Folder):
    def test_surfaces(self):
        corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
        faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
        head = "ply\nformat {} 1.0\nelement vertex 4\n" + "".join(f"property float {c}\n" for c in "xyz") + \
            "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
        points = "".join(f"{x} {y} {z}\n" for x, y, z in corners)
        stl = b"\0" * 80 + struct.pack("<I", 4)
        for f in faces:
            stl += struct.pack("<12fH", 0, 0, 0, *(c for v in f for c in corners[v]), 0)
        files = {
            "a.off": f"OFF\n4 4 0\n{points}" + "".join(f"3 {a} {b} {c}\n" for a, b, c in faces),
            "a.obj": "".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "".join(f"f {a - 4}/1 {b + 1} {c + 1}\n" for a, b, c in faces),
            "a.ply": head.format("ascii") + points + "".join(f"3 {a} {b} {c}\n" for a, b, c in faces),
            "b.ply": head.format("binary_little_endian").encode() + b"".join(struct.pack("<3f", *p) for p in corners) + b"".join(
                struct.pack("<B3i", 3, *f) for f in faces),
            "a.stl": "solid\n" + "".join(f"facet normal 0 0 0\nouter loop\n" + "".join(
                f"vertex {corners[v][0]} {corners[v][1]} {corners[v][2]}\n" for v in f) + "endloop\nendfacet\n" for f in faces),
            "b.stl": stl,
        }
        for name, data in files.items():
            with self.subTest(name):
                self.assertEqual(self.volumes(self.file(name, data)), {0: 1 / 6})


class Comparison(Folder):
    def complaints(self, height="2", labels=(0, 0), regions=None, tolerance=0.0):
        given = given_volumes.volumes_given(self.file("a.poly", SQUARE))
        mesh = given_volumes.Mesh(self.file("a.mesh", MESH.format(height, *labels)))
        report = {"tolerance": tolerance, **({} if regions is None else {"regions": regions})}
        return list(given_volumes.complaints_about(given, mesh, report))

    def test_what_is_right(self):
        self.assertEqual(self.complaints(), [])
        self.assertEqual(self.complaints(regions=[{"label": 0, "volume_meshed": 6.0, "volume_given": 6.0}]), [])
        self.assertEqual(self.complaints(height="2.0000001", tolerance=1e-6), [])

    def test_what_is_wrong_is_found(self):
        self.assertIn("off by", self.complaints(height="2.0000001")[0])
        self.assertIn("labels [0.0, 1.0]", self.complaints(labels=(0, 1))[0])
        self.assertIn("volume_meshed", self.complaints(regions=[{"label": 0, "volume_meshed": 6.1, "volume_given": 6.0}])[0])
        self.assertIn("volume_given", self.complaints(regions=[{"label": 0, "volume_meshed": 6.0, "volume_given": 6.1}])[0])
        self.assertIn("has regions [1]", self.complaints(regions=[{"label": 1, "volume_meshed": 6.0, "volume_given": 6.0}])[0])

    def test_allowance(self):
        volume = given_volumes.Volume(Fraction(1), area=3, perimeter=5, bent=0.5)
        self.assertEqual(volume.allowance(2, 0.25), 3 * 2.5 + 5 * 4 + 0.5)


if __name__ == "__main__":
    unittest.main()
