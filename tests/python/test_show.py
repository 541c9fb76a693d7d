# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The picture and the table that a notebook shows: well-formed, complete, and small whatever the mesh."""
import re
import unittest
import xml.etree.ElementTree

import pgdr
from pgdr import _show

SQUARE = {"points": [[0, 0], [2, 0], [2, 1], [0, 1], [1, 0], [1, 1]], "segments": [[0, 4], [4, 1], [1, 2], [2, 5], [5, 3], [3, 0], [4, 5]]}
BOX = {"points": [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)],
       "facets": [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]}


class Show(unittest.TestCase):
    def shown(self, plc, **options):
        mesh = pgdr.mesh(plc, **options)
        self.assertTrue(pgdr.check(mesh, plc))
        text = mesh._repr_html_()
        return mesh, text, xml.etree.ElementTree.fromstring(text)

    def polygons(self, tree):
        return list(tree.iter("{http://www.w3.org/2000/svg}polygon"))

    def test_triangles_have_the_colours_of_their_regions(self):
        mesh, _, tree = self.shown(pgdr.Plc(**SQUARE, regions=[[0.5, 0.5, 1], [1.5, 0.5, 2]]), size=0.05)
        fills = [polygon.get("fill") for polygon in self.polygons(tree)]
        self.assertEqual(len(fills), len(mesh.cells))
        self.assertEqual(len(set(zip(fills, mesh.regions.tolist()))), 2)
        self.assertEqual(len(set(fills)), 2)

    def test_polygons_lie_in_the_picture(self):
        for plc in (pgdr.Plc(**SQUARE), pgdr.Plc(**BOX)):
            _, _, tree = self.shown(plc)
            width, height = (float(x) for x in next(tree.iter("{http://www.w3.org/2000/svg}svg")).get("viewBox").split()[2:])
            for polygon in self.polygons(tree):
                for point in polygon.get("points").split():
                    x, y = map(float, point.split(","))
                    self.assertTrue(0 <= x <= width and 0 <= y <= height, point)

    def test_three_sides_of_a_box_are_seen_and_shaded(self):
        _, _, tree = self.shown(pgdr.Plc(**BOX))
        self.assertEqual(len({polygon.get("fill") for polygon in self.polygons(tree)}), 3)

    def test_the_surface_is_what_one_cell_has(self):
        mesh, _, _ = self.shown(pgdr.Plc(**BOX))
        ours = sorted(tuple(sorted(face)) for face in _show._surface(mesh).tolist())
        self.assertEqual(ours, sorted(tuple(sorted(face)) for face in mesh.subfacets.tolist()))

    def test_large_meshes_are_drawn_in_part(self):
        _, text, tree = self.shown(pgdr.Plc(**SQUARE), size=2 / 6000)
        self.assertEqual(len(self.polygons(tree)), 0)
        self.assertIn("the boundary alone is drawn", text)
        self.assertLess(len(text), 1_000_000)
        _, text, tree = self.shown(pgdr.Plc(**BOX), size=0.022, optimize=False)
        self.assertEqual(len(self.polygons(tree)), _show.MOST_PIECES)
        self.assertRegex(text, "6,000 of [0-9,]+ faces are drawn")
        self.assertLess(len(text), 1_000_000)

    def test_table(self):
        mesh, text, _ = self.shown(pgdr.Plc(**BOX, regions=[[0.5, 0.5, 0.5, 4]]))
        rows = dict(re.findall("<tr><th>(.*?)</th><td>(.*?)</td></tr>", text))
        self.assertEqual((rows["dimension"], rows["cells"], rows["regions"]), ("3", f"{len(mesh.cells):,}", "4"))
        self.assertEqual(rows["stop"], "finished")

    def test_text_is_escaped(self):
        class Odd:
            dimension, points, cells, subsegments, regions, stop = 2, [], [], [], [], "<script>&"
        text = _show.repr_html(Odd())
        self.assertIn("&lt;script&gt;&amp;", text)
        self.assertNotIn("<script>", text)


if __name__ == "__main__":
    unittest.main()
