# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs from meshio and PyVista; meshes to both. Where PyVista is not installed, a module stands in for it that asks of the
arrays what PyVista asks."""
import os
import sys
import tempfile
import types
import unittest

import numpy as np

import pgdr

try:
    import meshio
except ImportError:
    meshio = None
try:
    import vtk
    from vtk.util import numpy_support
except ImportError:
    numpy_support = None

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

    def test_cell_sets(self):
        faces = {"bottom": [0], "sides": [2, 3, 4, 5]}
        given = meshio.Mesh(POINTS, [("quad", QUADS)], cell_sets={name: [np.array(rows)] for name, rows in faces.items()})
        plc = pgdr.Plc.from_meshio(given)
        self.assertEqual((plc.markers.tolist(), plc.marker_names), ([1, 0, 2, 2, 2, 2], {1: "bottom", 2: "sides"}))
        mesh = self.meshed(pgdr.Plc(POINTS, facets=QUADS, markers=[4, 5, 6, 6, 6, 6], regions=[[0.5, 0.5, 0.5, 7]],
                                    region_names={7: "steel"}, marker_names={4: "bottom", 6: "sides"}), 1.0)
        there = mesh.to_meshio()
        there.field_data = {}
        again = pgdr.Plc.from_meshio(there)
        self.assertEqual((again.region_names, again.marker_names), ({7.0: "steel"}, {4: "bottom", 6: "sides"}))
        del there.cell_data["marker"], there.cell_data["region"], there.cell_data["gmsh:physical"]
        again = pgdr.Plc.from_meshio(there)
        self.assertEqual(sorted(again.marker_names.values()), ["bottom", "sides"])
        self.assertEqual(list(again.region_names.values()), ["steel"])
        self.meshed(again, 1.0)
        with self.assertRaisesRegex(pgdr.UsageError, "cell set"):
            pgdr.Plc.from_meshio(meshio.Mesh(POINTS, [("quad", QUADS)], cell_sets={"a": [np.array([6])]}))

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

    def test_writers_that_look_at_the_type_of_indices(self):
        mesh = self.meshed(pgdr.Plc(POINTS, facets=QUADS, markers=[1, 2, 3, 4, 5, 6]), 1.0)
        with tempfile.TemporaryDirectory() as folder:
            for name, more in (("a.vtk", {}), ("b.vtk", {"file_format": "vtk42"}), ("a.vtu", {})):
                with self.subTest(name, **more):
                    file = os.path.join(folder, name)
                    meshio.write(file, mesh.to_meshio(), **more)
                    read = meshio.read(file)
                    self.assertEqual(read.get_cells_type("tetra").tolist(), mesh.cells.tolist())

    def test_gmsh_writes_points_lines_surface_and_volume(self):
        first = self.meshed(pgdr.Plc(POINTS, facets=QUADS, markers=[1, 2, 3, 4, 5, 6], regions=[[0.5, 0.5, 0.5, 7]]), 1.0)
        cells = [("vertex", [[0]]), ("line", first.subsegments), ("triangle", first.subfacets), ("tetra", first.cells)]
        physical = [np.array([9]), np.full(len(first.subsegments), 8), first.subfacet_markers, np.full(len(first.cells), 7)]
        plc = pgdr.Plc.from_meshio(meshio.Mesh(first.points, cells, cell_data={"gmsh:physical": physical}))
        again = self.meshed(plc, 1.0)
        self.assertEqual(set(again.regions.tolist()), {7.0})
        self.assertEqual(set(again.subfacet_markers.tolist()), {1, 2, 3, 4, 5, 6})
        self.assertIn(8, again.subsegment_markers.tolist())

    def test_polygons_beside_tetrahedra(self):
        roof = np.array([[0, 0], [2, 0], [3, 1], [2, 2], [0, 2.0]])
        points = np.vstack([np.column_stack([roof, np.full(5, z)]) for z in (0.0, 1.0)])
        sides = [[i, (i + 1) % 5, (i + 1) % 5 + 5, i + 5] for i in range(5)]
        first = self.meshed(pgdr.Plc(points, facets=[list(range(5)), list(range(5, 10))] + sides), 5.0)
        top = [face for face in first.subfacets.tolist() if all(first.points[v][2] == 1 for v in face)]
        self.assertEqual(len(top), 3)
        ring = [int(first.point_of_input[v]) for v in range(5, 10)]
        for polygon, marker in ((ring, 4), (ring[::-1], 5)):
            plc = pgdr.Plc.from_meshio(meshio.Mesh(first.points, [("polygon", [polygon]), ("tetra", first.cells)],
                                                   cell_data={"marker": [np.array([marker]), np.zeros(len(first.cells), dtype=int)]}))
            again = self.meshed(plc, 5.0)
            at = again.points[again.subfacets[again.subfacet_markers == marker]]
            self.assertTrue(len(at) >= 3 and (at[..., 2] == 1).all())
        inside = np.vstack([first.points, points[:5] + [0, 0, 0.5]])
        level = list(range(len(first.points), len(inside)))
        plc = pgdr.Plc.from_meshio(meshio.Mesh(inside, [("tetra", first.cells), ("polygon", [level])]))
        self.assertEqual(len(plc.points), 15)
        self.assertGreater(len(self.meshed(plc, 5.0).points), 15 - 1)

    def test_cells_in_the_plane(self):
        quads = meshio.Mesh(np.array(SQUARE + [[5, 0], [4, 1.0]]), [("quad", [[0, 1, 2, 3], [1, 4, 5, 2]])],
                            cell_data={"gmsh:physical": [np.array([1, 2])]})
        made = self.meshed(pgdr.Plc.from_meshio(quads), 9 + 2.5)
        self.assertEqual(set(made.regions.tolist()), {1, 2})
        bent = [[0, 0], [3, 0], [3, 3], [2, 3], [2, 1], [0, 1.0]]
        made = self.meshed(pgdr.Plc.from_meshio(meshio.Mesh(np.array(bent), [("polygon", [list(range(6))])])), 5.0)
        self.assertEqual(len(made.points), 6)
        frame = np.array([[x, y] for y in range(4) for x in range(4)], dtype=float)
        cells = [[4 * y + x, 4 * y + x + 1, 4 * y + x + 5, 4 * y + x + 4] for y in range(3) for x in range(3) if (x, y) != (1, 1)]
        self.meshed(pgdr.Plc.from_meshio(meshio.Mesh(frame, [("quad", cells)])), 8.0)

    def test_other_cells_have_the_surface_that_is_listed(self):
        cube = [[0, 1, 3, 2, 4, 5, 7, 6]]
        self.meshed(pgdr.Plc.from_meshio(meshio.Mesh(POINTS, [("hexahedron", cube), ("quad", QUADS)])), 1.0)

    def test_refusals(self):
        wedge = meshio.Mesh(POINTS, [("wedge", [[0, 1, 2, 4, 5, 6]])])
        curved = meshio.Mesh(POINTS, [("triangle6", [[0, 1, 2, 3, 4, 5]])])
        half = meshio.Mesh(POINTS, [("triangle", [[0, 1, 2]])], cell_data={"medit:ref": [np.array([0.5])]})
        empty = meshio.Mesh(POINTS, [("line", [[0, 1]])])
        wide = meshio.Mesh(POINTS, [("triangle", [[0, 1, 2, 3]])])
        unfit = meshio.Mesh(np.vstack([POINTS, [[0.5, 0.5, 0.0]]]), [("tetra", [[0, 1, 8, 4]]), ("polygon", [[0, 1, 8, 3, 2]])])
        for given, word in ((wedge, "wedge.*surface"), (curved, "triangle6.*curved"), (half, "medit:ref"), (empty, "no faces"),
                            (wide, "shape"), (unfit, "polygon 0")):
            with self.subTest(word), self.assertRaisesRegex(pgdr.UsageError, word):
                pgdr.Plc.from_meshio(given)
        for corners in ([[0, 1, 8]], [[0, -1, 2]]):
            with self.assertRaises(pgdr.InputError) as caught:
                pgdr.Plc.from_meshio(meshio.Mesh(POINTS, [("triangle", corners), ("tetra", [[0, 1, 2, 4]])]))
            self.assertEqual(caught.exception.code, "index_out_of_range")
            self.assertEqual(caught.exception.file, "")
        for cells in ([("tetra", [[0, 1, 2, 3]])], [("tetra", [[0, 0, 1, 2]])]):
            with self.assertRaises(pgdr.InputError) as caught:
                pgdr.mesh(pgdr.Plc.from_meshio(meshio.Mesh(POINTS, cells)))
            self.assertEqual(caught.exception.file, "")


class StandInGrid:
    """pyvista.UnstructuredGrid(cells, celltypes, points): padded `cells`, `celltypes`, and data by cell and point."""

    def __init__(self, cells, celltypes, points, cell_data=None):
        cells, celltypes, points = np.asarray(cells), np.asarray(celltypes), np.asarray(points)
        if celltypes.dtype != np.uint8 or cells.ndim != 1 or points.ndim != 2 or points.shape[1] != 3:
            raise TypeError("arrays that PyVista refuses")
        at = 0
        for kind in celltypes:
            if int(cells[at]) != {3: 2, 5: 3, 9: 4, 10: 4, 12: 8}.get(int(kind), int(cells[at])):
                raise ValueError("cells that VTK refuses")
            at += 1 + int(cells[at])
        if at != len(cells):
            raise ValueError("cells that VTK refuses")
        self.points, self.cells, self.celltypes, self.cell_data, self.point_data = points, cells, celltypes, cell_data or {}, {}


class StandInSurface:
    """pyvista.PolyData: padded `verts`, `lines`, `faces` and `strips`, and data of its cells in this order."""

    def __init__(self, points, faces=(), lines=(), verts=(), strips=(), cell_data=None):
        self.points, self.cell_data, self.point_data = points, cell_data or {}, {}
        self.verts, self.lines, self.faces, self.strips = (np.array(a, dtype=np.int64) for a in (verts, lines, faces, strips))


def padded(rows):
    return np.concatenate([[len(row), *row] for row in rows])


class Pyvista(Meshed):
    def setUp(self):
        self.before = sys.modules.get("pyvista")

    def tearDown(self):
        sys.modules.pop("pyvista", None)
        if self.before is not None:
            sys.modules["pyvista"] = self.before

    def test_grid_there_and_back(self):
        sys.modules["pyvista"] = types.SimpleNamespace(UnstructuredGrid=StandInGrid)
        for plc, kind in ((pgdr.Plc(POINTS, facets=QUADS, regions=[[0.5, 0.5, 0.5, 7]]), 10), (pgdr.Plc.from_polygons(SQUARE), 5)):
            mesh = self.meshed(plc, 1.0 if kind == 10 else 9.0)
            grid = mesh.to_pyvista()
            self.assertEqual(set(grid.celltypes.tolist()), {kind})
            self.assertEqual(grid.cells.reshape(len(mesh.cells), -1)[:, 1:].tolist(), mesh.cells.tolist())
            self.assertEqual(grid.points[:, :mesh.dimension].tolist(), mesh.points.tolist())
            self.assertEqual(len(grid.cell_data["region"]), len(mesh.cells))
            again = self.meshed(pgdr.Plc.from_pyvista(grid), 1.0 if kind == 10 else 9.0)
            self.assertEqual(again.dimension, mesh.dimension)
            self.assertEqual(set(again.regions.tolist()), {7.0} if kind == 10 else {0.0})

    def test_missing_package_is_named(self):
        sys.modules["pyvista"] = None
        mesh = self.meshed(pgdr.Plc.from_polygons(SQUARE), 9.0)
        with self.assertRaisesRegex(ImportError, "pip install pyvista"):
            mesh.to_pyvista()

    def test_faces_with_markers(self):
        plc = pgdr.Plc.from_pyvista(StandInSurface(POINTS.astype(np.float32), padded(QUADS), cell_data={"marker": np.arange(1, 7)}))
        self.assertEqual(plc.markers.tolist(), [1, 2, 3, 4, 5, 6])
        self.assertGreater(plc.tolerance, pgdr.Plc(POINTS, facets=QUADS).tolerance)
        self.meshed(plc, 1.0)

    def test_cell_data_is_of_vertices_lines_and_faces(self):
        at = np.vstack([POINTS, [[0.5, 0.5, 0.25], [0.5, 0.5, 0.75]]])
        plc = pgdr.Plc.from_pyvista(StandInSurface(at, padded(QUADS), [2, 8, 9], [1, 8, 1, 9],
                                                   cell_data={"marker": np.array([20, 21, 30, 1, 2, 3, 4, 5, 6])}))
        self.assertEqual((plc.segment_markers.tolist(), plc.markers.tolist()), ([30], [1, 2, 3, 4, 5, 6]))
        self.assertIn(30, self.meshed(plc, 1.0).subsegment_markers.tolist())

    def test_triangles(self):
        triangles = [t for a, b, c, d in QUADS for t in ([3, a, b, c], [3, a, c, d])]
        plc = pgdr.Plc.from_pyvista(StandInSurface(POINTS, np.concatenate(triangles)))
        self.assertEqual(plc.facets.shape, (12, 3))
        self.meshed(plc, 1.0)

    def test_grid_of_surface_cells(self):
        rows = [QUADS[0][:3], [QUADS[0][0], QUADS[0][2], QUADS[0][3]]] + QUADS[1:]
        grid = StandInGrid(padded(rows), np.array([5, 5, 9, 9, 9, 9, 7], dtype=np.uint8), POINTS, {"marker": np.arange(1, 8)})
        plc = pgdr.Plc.from_pyvista(grid)
        self.assertEqual(plc.markers.tolist(), [1, 2, 3, 4, 5, 6, 7])
        self.meshed(plc, 1.0)

    def test_lines_and_faces_in_the_plane(self):
        at = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]])
        self.meshed(pgdr.Plc.from_pyvista(StandInSurface(at, lines=[4, 0, 1, 2, 0])), 0.5)
        self.meshed(pgdr.Plc.from_pyvista(StandInSurface(at, faces=[3, 0, 1, 2])), 0.5)

    def test_refusals(self):
        hexahedron = StandInGrid([8, 0, 1, 3, 2, 4, 5, 7, 6], np.array([12], dtype=np.uint8), POINTS)
        voxel = StandInGrid([8, 0, 1, 2, 3, 4, 5, 6, 7], np.array([11], dtype=np.uint8), POINTS)
        for given, word in ((StandInSurface(POINTS), "no faces"), (StandInSurface(POINTS, [3, 0, 1]), "damaged"),
                            (StandInSurface(POINTS, strips=[4, 0, 1, 2, 3]), "triangulate"), (hexahedron, "extract_surface"),
                            (voxel, "extract_surface"), (StandInSurface(POINTS, [2, 0, 1]), "three corners")):
            with self.subTest(word), self.assertRaisesRegex(pgdr.UsageError, word):
                pgdr.Plc.from_pyvista(given)
        with self.assertRaisesRegex(TypeError, "PolyData"):
            pgdr.Plc.from_pyvista(object())


@unittest.skipUnless(numpy_support, "VTK's Python is not installed")
class Vtk(Meshed):
    """PyVista's classes are VTK's with these arrays: so VTK's take its place."""

    def surface(self, made):
        def numbers(cells):
            return numpy_support.vtk_to_numpy(cells.GetData()) if cells.GetNumberOfCells() else np.zeros(0, dtype=np.int64)
        data = made.GetCellData()
        names = [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())]
        return StandInSurface(numpy_support.vtk_to_numpy(made.GetPoints().GetData()), numbers(made.GetPolys()),
                              numbers(made.GetLines()), numbers(made.GetVerts()), numbers(made.GetStrips()),
                              {name: numpy_support.vtk_to_numpy(data.GetArray(name)) for name in names})

    def test_a_source_of_vtk(self):
        for source, volume in ((vtk.vtkCubeSource(), 1.0), (vtk.vtkSphereSource(), None)):
            clean = vtk.vtkCleanPolyData()
            clean.SetInputConnection(source.GetOutputPort())
            clean.Update()
            plc = pgdr.Plc.from_pyvista(self.surface(clean.GetOutput()))
            made = pgdr.mesh(plc)
            self.assertTrue(made.check(plc))
            if volume:
                self.assertAlmostEqual(measure(made), volume)
            self.assertGreater(len(made.cells), 4)

    def test_a_grid_there_and_back(self):
        mesh = self.meshed(pgdr.Plc(POINTS, facets=QUADS, regions=[[0.5, 0.5, 0.5, 7]]), 1.0)
        sys.modules["pyvista"] = types.SimpleNamespace(UnstructuredGrid=StandInGrid)
        try:
            grid = mesh.to_pyvista()
        finally:
            del sys.modules["pyvista"]
        made = vtk.vtkUnstructuredGrid()
        points, cells = vtk.vtkPoints(), vtk.vtkCellArray()
        points.SetData(numpy_support.numpy_to_vtk(grid.points, deep=True))
        cells.ImportLegacyFormat(numpy_support.numpy_to_vtkIdTypeArray(grid.cells, deep=True))
        made.SetPoints(points)
        made.SetCells(numpy_support.numpy_to_vtk(grid.celltypes, deep=True, array_type=vtk.VTK_UNSIGNED_CHAR), cells)
        self.assertEqual(made.GetNumberOfCells(), len(mesh.cells))
        size = vtk.vtkMeshQuality()
        size.SetInputData(made)
        size.SetTetQualityMeasureToVolume()
        size.Update()
        volumes = numpy_support.vtk_to_numpy(size.GetOutput().GetCellData().GetArray("Quality"))
        self.assertAlmostEqual(volumes.sum(), 1.0)
        self.assertGreater(volumes.min(), 0)
        back = StandInGrid(numpy_support.vtk_to_numpy(made.GetCells().GetData()), numpy_support.vtk_to_numpy(made.GetCellTypesArray()),
                           numpy_support.vtk_to_numpy(made.GetPoints().GetData()), {"region": grid.cell_data["region"]})
        again = self.meshed(pgdr.Plc.from_pyvista(back), 1.0)
        self.assertEqual(set(again.regions.tolist()), {7.0})


if __name__ == "__main__":
    unittest.main()
