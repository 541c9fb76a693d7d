# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs from rings, meshio and PyVista; meshes to both. Where PyVista is not installed, a module stands in for it that asks of the
arrays what PyVista asks."""
import sys
import types
import unittest

import numpy as np

import pgdr

try:
    import meshio
except ImportError:
    meshio = None

POINTS = np.array([[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)])
QUADS = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
SQUARE = [[0, 0], [3, 0], [3, 3], [0, 3]]


def measure(mesh):
    corners = np.asarray(mesh.points)[np.asarray(mesh.cells)]
    return abs(np.linalg.det(corners[:, 1:] - corners[:, :1])).sum() / (2 if mesh.dimension == 2 else 6)


class Meshed(unittest.TestCase):
    def meshed(self, plc, expected):
        made = pgdr.mesh(plc)
        self.assertTrue(pgdr.check(made, plc))
        self.assertAlmostEqual(measure(made), expected, places=12)
        return made


class Polygons(Meshed):
    def test_rings_in_any_direction_closed_or_not(self):
        hole = [[1, 1], [2, 1], [2, 2], [1, 2]]
        for outer in (SQUARE, SQUARE[::-1], SQUARE + SQUARE[:1]):
            for inner in (hole, hole[::-1], hole + hole[:1]):
                plc = pgdr.Plc.from_polygons(outer, [inner])
                self.assertEqual((len(plc.points), len(plc.segments)), (8, 8))
                self.meshed(plc, 8.0)

    def test_seeds_lie_in_holes_of_any_shape(self):
        star = [[1.5 + r * np.cos(t), 1.5 + r * np.sin(t)] for r, t in zip([1, 0.1] * 9, np.arange(18) * np.pi / 9)]
        comb = [[0.5, 0.5], [2.5, 0.5], [2.5, 2.5], [2.4, 0.6], [0.6, 0.6], [0.5, 2.5]]
        for ring in (star, comb):
            at = np.array(ring)
            area = abs((at[:, 0] * np.roll(at[:, 1], -1) - at[:, 1] * np.roll(at[:, 0], -1)).sum()) / 2
            self.meshed(pgdr.Plc.from_polygons(SQUARE, [ring]), 9 - area)

    def test_markers(self):
        hole = [[1, 1], [2, 1], [2, 2]]
        self.assertEqual(pgdr.Plc.from_polygons(SQUARE, [hole]).markers.tolist(), [1] * 4 + [2] * 3)
        self.assertEqual(pgdr.Plc.from_polygons(SQUARE, [hole], markers=[5, 0]).markers.tolist(), [5] * 4 + [0] * 3)

    def test_refusals(self):
        for outer, holes in (([[0, 0], [1, 0]], []), ([[0, 0], [1, 0], [0, 0]], []), (SQUARE, [[[1, 1], [2, 1], [1.5, 1]]]),
                             ([[0, 0, 0]] * 3, [])):
            with self.subTest(outer=outer), self.assertRaises(pgdr.UsageError):
                pgdr.Plc.from_polygons(outer, holes)


@unittest.skipUnless(meshio, "meshio is not installed")
class Meshio(Meshed):
    def test_surface_of_two_types(self):
        triangles = [[4, 5, 7], [4, 7, 6]]
        given = meshio.Mesh(POINTS, [("quad", QUADS[:1] + QUADS[2:]), ("triangle", triangles), ("line", [[0, 1]])],
                            cell_data={"medit:ref": [np.arange(1, 6), np.array([9, 9]), np.array([4])]})
        plc = pgdr.Plc.from_meshio(given)
        self.assertEqual(plc.markers.tolist(), [1, 2, 3, 4, 5, 9, 9])
        self.assertEqual(plc.segment_markers.tolist(), [4])
        made = self.meshed(plc, 1.0)
        self.assertEqual(set(made.subfacet_markers.tolist()), {1, 2, 3, 4, 5, 9})

    def test_planar_lines(self):
        given = meshio.Mesh(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]]), [("line", [[0, 1], [1, 2], [2, 0]])],
                            cell_data={"gmsh:physical": [np.array([1, 2, 3])]})
        plc = pgdr.Plc.from_meshio(given)
        self.assertEqual((plc.dimension, plc.markers.tolist()), (2, [1, 2, 3]))
        self.meshed(plc, 0.5)

    def test_cells_give_surface_and_labels(self):
        plc = pgdr.Plc(POINTS, facets=QUADS, markers=[1, 2, 3, 4, 5, 6], regions=[[0.5, 0.5, 0.5, 7]])
        first = self.meshed(plc, 1.0)
        again = self.meshed(pgdr.Plc.from_meshio(first.to_meshio()), 1.0)
        self.assertEqual(set(again.regions.tolist()), {7.0})
        self.assertEqual(set(again.subfacet_markers.tolist()), {1, 2, 3, 4, 5, 6})

    def test_planar_cells(self):
        first = self.meshed(pgdr.Plc.from_polygons(SQUARE, [[[1, 1], [2, 1], [2, 2], [1, 2]]]), 8.0)
        again = self.meshed(pgdr.Plc.from_meshio(first.to_meshio()), 8.0)
        self.assertEqual(set(again.subsegment_markers.tolist()), {1, 2})

    def test_to_meshio_keeps_everything(self):
        mesh = self.meshed(pgdr.Plc(POINTS, facets=QUADS, markers=[1, 2, 3, 4, 5, 6]), 1.0)
        made = mesh.to_meshio()
        self.assertEqual([block.type for block in made.cells], ["tetra", "triangle", "line"])
        self.assertEqual(made.cells[0].data.tolist(), mesh.cells.tolist())
        self.assertEqual(made.cell_data["marker"][1].tolist(), mesh.subfacet_markers.tolist())
        self.assertEqual([len(a) for a in made.cell_data["region"]], [len(block.data) for block in made.cells])

    def test_refusals(self):
        wedge = meshio.Mesh(POINTS, [("wedge", [[0, 1, 2, 4, 5, 6]])])
        planar = meshio.Mesh(POINTS[:4], [("quad", [[0, 1, 3, 2]])])
        half = meshio.Mesh(POINTS, [("triangle", [[0, 1, 2]])], cell_data={"medit:ref": [np.array([0.5])]})
        for given, word in ((wedge, "wedge"), (planar, "quadrilaterals"), (half, "medit:ref")):
            with self.subTest(word), self.assertRaises(pgdr.UsageError) as caught:
                pgdr.Plc.from_meshio(given)
            self.assertIn(word, str(caught.exception))


class StandInGrid:
    """pyvista.UnstructuredGrid(cells, celltypes, points), as far as the arrays go."""

    def __init__(self, cells, celltypes, points):
        if celltypes.dtype != np.uint8 or cells.ndim != 1 or points.ndim != 2 or points.shape[1] != 3:
            raise TypeError("arrays that PyVista refuses")
        width = {5: 3, 10: 4}[int(celltypes[0])]
        if len(cells) != len(celltypes) * (width + 1) or (cells[::width + 1] != width).any():
            raise ValueError("cells that VTK refuses")
        self.points, self.celltypes, self.cell_data = points, celltypes, {}
        self.connectivity = cells.reshape(-1, width + 1)[:, 1:]


class StandInSurface:
    """pyvista.PolyData with faces of several sizes."""

    def __init__(self, points, faces=(), lines=(), cell_data=None):
        self.points, self.faces, self.lines, self.cell_data = points, np.array(faces), np.array(lines), cell_data or {}


class Pyvista(Meshed):
    def setUp(self):
        self.before = sys.modules.get("pyvista")

    def tearDown(self):
        sys.modules.pop("pyvista", None)
        if self.before is not None:
            sys.modules["pyvista"] = self.before

    def test_grid(self):
        sys.modules["pyvista"] = types.SimpleNamespace(UnstructuredGrid=StandInGrid)
        for plc, kind in ((pgdr.Plc(POINTS, facets=QUADS), 10), (pgdr.Plc.from_polygons(SQUARE), 5)):
            mesh = self.meshed(plc, 1.0 if kind == 10 else 9.0)
            grid = mesh.to_pyvista()
            self.assertEqual(set(grid.celltypes.tolist()), {kind})
            self.assertEqual(grid.connectivity.tolist(), mesh.cells.tolist())
            self.assertEqual(grid.points[:, :mesh.dimension].tolist(), mesh.points.tolist())
            self.assertEqual(len(grid.cell_data["region"]), len(mesh.cells))

    def test_missing_package_is_named(self):
        sys.modules["pyvista"] = None
        mesh = self.meshed(pgdr.Plc.from_polygons(SQUARE), 9.0)
        with self.assertRaisesRegex(ImportError, "pip install pyvista"):
            mesh.to_pyvista()

    def test_faces_with_markers(self):
        flat = np.concatenate([[len(quad)] + quad for quad in QUADS])
        plc = pgdr.Plc.from_pyvista(StandInSurface(POINTS.astype(np.float32), flat, cell_data={"marker": np.arange(1, 7)}))
        self.assertEqual(plc.markers.tolist(), [1, 2, 3, 4, 5, 6])
        self.meshed(plc, 1.0)

    def test_triangles(self):
        triangles = [t for a, b, c, d in QUADS for t in ([3, a, b, c], [3, a, c, d])]
        plc = pgdr.Plc.from_pyvista(StandInSurface(POINTS, np.concatenate(triangles)))
        self.assertEqual(plc.facets.shape, (12, 3))
        self.meshed(plc, 1.0)

    def test_lines_in_the_plane(self):
        at = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]])
        self.meshed(pgdr.Plc.from_pyvista(StandInSurface(at, lines=[4, 0, 1, 2, 0])), 0.5)

    def test_refusals(self):
        for given in (StandInSurface(POINTS), StandInSurface(POINTS, [3, 0, 1]), object()):
            with self.subTest(given), self.assertRaises(pgdr.UsageError):
                pgdr.Plc.from_pyvista(given)


if __name__ == "__main__":
    unittest.main()
