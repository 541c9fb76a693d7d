#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures that `pgdr view` draws, from outside. Usage: test_view.py [Class[.test]...]"""
import json
import struct
import unittest
import xml.etree.ElementTree as ElementTree
import zlib

from test_command import BRACKET, PLATE, Case

SVG = "{http://www.w3.org/2000/svg}"
# Two triangles with an edge in common and labels of their own; their smallest angles are 45 and 36.9 degrees.
TWO = ("MeshVersionFormatted 2\nDimension 2\nVertices 4\n0 0 0\n2 0 0\n0 2 0\n4 4 0\n"
       "Triangles 2\n1 2 3 1\n2 4 3 2\nEdges 1\n2 3 7\nEnd\n")
# Two tetrahedra on top of each other: the lower one is hidden from above, the upper one from below.
STACK = ("MeshVersionFormatted 2\nDimension 3\nVertices 8\n"
         "0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 2 0\n1 0 2 0\n0 1 2 0\n0 0 3 0\n"
         "Tetrahedra 2\n1 2 3 4 1\n5 6 7 8 2\nEnd\n")


def pixels(path):
    """Width, height and rows of RGB triples of an 8 bit RGB .png without interlacing; of RGBA without the last. Of a file, or its bytes."""
    data, at, body = path if isinstance(path, bytes) else path.read_bytes(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, *rest = struct.unpack(">IIBBBBB", data[at + 8:at + 8 + size])
        elif kind == b"IDAT":
            body += data[at + 8:at + 8 + size]
        at += size + 12
    if rest not in ([8, 2, 0, 0, 0], [8, 6, 0, 0, 0]):
        raise ValueError(f"{rest}")
    size = 3 if rest[1] == 2 else 4
    raw, stride, rows, before = zlib.decompress(body), size * width, [], bytes(size * width)
    for y in range(height):
        method, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for x in range(stride) if method else ():
            left, up, corner = line[x - size] if x >= size else 0, before[x], before[x - size] if x >= size else 0
            nearest = min((left, up, corner), key=lambda v: abs(left + up - corner - v))
            line[x] = (line[x] + (0, left, up, (left + up) // 2, nearest)[method]) & 255
        rows.append([tuple(line[x:x + 3]) for x in range(0, stride, size)])
        before = line
    return width, height, rows


class View(Case):
    def view(self, mesh, *flags, name="out.svg", expect=0):
        picture = self.folder / name
        done = self.pgdr("view", mesh, "-o", picture, "--report", self.report, *flags, expect=expect)
        if expect == 0:
            self.assertEqual(list(self.folder.glob("*.tmp")), [])
        else:
            self.assertFalse(picture.exists())
            self.assertTrue(done.stderr.startswith("pgdr: error: "), done.stderr)
        return picture

    def polygons(self, picture):
        root = ElementTree.parse(picture).getroot()
        self.assertEqual((root.get("width"), root.get("height")), tuple(str(self.json()[k]) for k in ("width", "height")))
        found = list(root.iter(SVG + "polygon"))
        self.assertEqual(len(found), self.json()["triangles_drawn"])
        for polygon in found:
            for point in polygon.get("points").split():
                x, y = map(float, point.split(","))
                self.assertTrue(0 <= x <= self.json()["width"] and 0 <= y <= self.json()["height"], point)
        return found

    def png(self, *arguments):
        picture = self.folder / "out.png"
        if "without Cairo" in self.pgdr("view", *arguments, "-o", picture, "--report", self.report).stderr:
            self.skipTest("built without Cairo")
        width, height, rows = pixels(picture)
        self.assertEqual((width, height), (self.json()["width"], self.json()["height"]))
        return width, height, rows

    def test_two_triangles(self):
        mesh = self.file("two.mesh", TWO)
        picture = self.view(mesh, "--size", 100)
        left, right = self.polygons(picture)  # a square of 4 x 4, with margins of 2 pixels
        self.assertEqual(left.get("points"), "2.00,98.00 50.00,98.00 2.00,50.00")
        self.assertEqual(right.get("points"), "50.00,98.00 98.00,2.00 2.00,50.00")
        self.assertNotEqual(left.get("fill"), right.get("fill"))  # 45 degrees and less
        lines, = ElementTree.parse(picture).getroot().iter(SVG + "path")
        self.assertEqual(lines.get("d").count("M"), 1)
        left, right = self.polygons(self.view(mesh, "--color", "region"))
        self.assertNotEqual(left.get("fill"), right.get("fill"))
        same = self.file("same.mesh", TWO.replace("2 4 3 2", "2 4 3 1"))
        left, right = self.polygons(self.view(same, "--color", "region"))
        self.assertEqual(left.get("fill"), right.get("fill"))

    def test_classes_of_dihedral_angles(self):
        # A corner of a cube (54.7 degrees), and one that is flattened to a dihedral angle of 8.05.
        for height, fill in ((1, "#4575b4"), (0.1, "#fc8d59")):
            text = ("MeshVersionFormatted 2\nDimension 3\nVertices 4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n"
                    f"0 0 {height} 0\nTetrahedra 1\n1 2 3 4 1\nEnd\n")
            seen = self.polygons(self.view(self.file("cell.mesh", text), "--color", "dihedral"))
            self.assertGreater(len(seen), 0)
            for polygon in seen:  # shaded: the colour times a brightness
                ratios = [int(polygon.get("fill")[i:i + 2], 16) / int(fill[i:i + 2], 16) for i in (1, 3, 5)]
                self.assertLess(max(ratios) - min(ratios), 0.02)
        # Of triangles: 45 and 36.9 degrees.
        left, right = self.polygons(self.view(self.file("two.mesh", TWO), "--color", "dihedral"))
        self.assertEqual((left.get("fill"), right.get("fill")), ("#4575b4", "#91bfdb"))

    def test_cells_of_a_plane_mesh(self):
        self.mesh(PLATE, "--size", 0.01)
        for flags in ([], ["--color", "region"]):
            polygons = self.polygons(self.view(self.output, *flags))
            self.pgdr("info", self.output, "--report", self.report, expect=0)
            self.assertEqual(len(polygons), self.json()["cells"])

    def test_png(self):
        mesh = self.file("two.mesh", TWO)
        width, height, rows = self.png(mesh, "--size", 120, "--color", "region")
        self.assertEqual((width, height), (120, 120))
        self.assertEqual(rows[5][5], (255, 255, 255))
        fills = ["#%02x%02x%02x" % rows[y][x] for x, y in ((20, 100), (70, 50))]
        self.assertEqual(fills, [p.get("fill") for p in self.polygons(self.view(mesh, "--color", "region"))])

    def test_the_nearer_hides_the_farther(self):
        mesh = self.file("stack.mesh", STACK)
        seen = []
        for height in (5, -5):
            _, _, rows = self.png(mesh, "--color", "region", "--from", f"0.1,0.1,{height}", "--size", 60)
            seen.append(rows[len(rows) // 2][30])
        hue = lambda color: max(range(3), key=color.__getitem__)
        self.assertNotEqual(hue(seen[0]), hue(seen[1]), seen)
        for color, eye in zip(seen, ("0,0,1", "0,0,-1")):  # in the .svg what hides comes last
            fills = [p.get("fill") for p in self.polygons(self.view(mesh, "--color", "region", "--from", eye))]
            farther, nearer = [hue(tuple(bytes.fromhex(fill[1:]))) for fill in fills]
            self.assertEqual(nearer, hue(color))
            self.assertNotEqual(farther, hue(color))

    def test_cut(self):
        self.mesh(BRACKET, "--size", 0.3)
        whole = self.polygons(self.view(self.output))
        self.assertGreater(len(whole), 100)
        cut = self.polygons(self.view(self.output, "--cut", "x=1", "--from", "1,0.2,0.1"))
        hues = {p.get("fill") for p in cut} - {p.get("fill") for p in whole}
        self.assertGreater(len(hues), 5)  # quality of the cells that the cut opens
        self.view(self.output, "--cut", "x=-100", "--from", "1,0,0", name="none.svg", expect=2)
        self.view(self.output, "--cut", "x=100", "--from", "-1,0,0", name="none.svg", expect=2)
        everything = self.polygons(self.view(self.output, "--cut", "x=100"))
        self.assertEqual([p.attrib for p in everything], [p.attrib for p in whole])

    def test_leaves(self):
        self.mesh(PLATE, "--size", 0.0005, expect=0)
        self.view(self.output, "--color", "leaf", expect=2)
        self.mesh(PLATE, "--size", 0.0005, "--leaves", "--report", self.folder / "mesh.json", expect=0)
        leaves = json.loads((self.folder / "mesh.json").read_text())["scheduler"]["leaves"]
        self.assertGreater(leaves, 3)
        fills = {p.get("fill") for p in self.polygons(self.view(self.output, "--color", "leaf"))}
        self.assertTrue(3 < len(fills) <= leaves, (len(fills), leaves))

    def test_wrong_flags(self):
        plane, space = self.file("two.mesh", TWO), self.file("stack.mesh", STACK)
        for flag in ("--color=leaf", "--size=0", "--size=8001", "--size=x", "--cut=x", "--cut=w=1", "--cut=x=", "--cut=x=nan",
                     "--cut=x=1,2", "--from=1,2", "--from=0,0,0", "--from=1,2,inf", "--from=a,b,c"):
            done = self.pgdr("view", space, "-o", self.folder / "out.svg", flag, expect=2)
            self.assertIn(flag.split("=")[0], done.stderr)
        self.view(plane, "--cut", "x=1", expect=2)
        self.view(plane, "--from", "1,2,3", expect=2)
        self.pgdr("view", plane, expect=2)
        self.pgdr("view", plane, "-o", self.report, "--report", self.report, expect=2)
        self.assertIn("Usage", self.pgdr("view", "--help", expect=0).stdout)

    def test_bad_files(self):
        mesh = self.file("two.mesh", TWO)
        self.view(mesh, name="out.gif", expect=2)
        self.view(PLATE, expect=3)
        self.view(self.file("broken.mesh", TWO[:60]), expect=3)
        self.view(self.file("point.mesh", TWO.replace("2 0 0", "0 0 0").replace("0 2 0", "0 0 0").replace("4 4 0", "0 0 0")),
                  expect=3)
        self.view(self.folder / "missing.mesh", expect=4)
        self.view(mesh, name="no folder/out.svg", expect=4)
        self.pgdr("view", mesh, "-o", mesh / "out.svg", expect=4)


if __name__ == "__main__":
    unittest.main()
