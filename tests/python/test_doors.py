# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Scripts as users of other packages have them, with the import changed: pgdr.tetgen, pgdr.triangle, PyVista's accessor, Shapely and
GeoPandas. Where PyVista, Shapely or matplotlib is not installed, something small stands in that refuses wrong calls."""
import importlib
import json
import os
import sys
import tempfile
import types
import unittest

import numpy as np

import pgdr
from pgdr import tetgen, triangle

try:
    import shapely.geometry as shapely
except ImportError:
    shapely = None
try:
    import geopandas
except ImportError:
    geopandas = None
try:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
except ImportError:
    pyplot = None

POINTS = np.array([[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)])
QUADS = np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])
SQUARE = {"vertices": [[0, 0], [1, 0], [1, 1], [0, 1]], "segments": [[0, 1], [1, 2], [2, 3], [3, 0]]}


class Grid:
    """pyvista.UnstructuredGrid(cells, celltypes, points)."""

    def __init__(self, cells, celltypes, points):
        if celltypes.dtype != np.uint8 or cells.dtype != np.int64 or points.shape[1:] != (3,) or points.dtype != np.float64:
            raise TypeError("arrays that PyVista refuses")
        sizes = np.array([{3: 2, 5: 3, 10: 4}[int(kind)] for kind in celltypes])
        starts = np.cumsum(np.concatenate([[0], sizes + 1]))
        if len(cells) != starts[-1] or (cells[starts[:-1]] != sizes).any():
            raise ValueError("cells that VTK refuses")
        self.cells, self.celltypes, self.points = cells, celltypes, points
        self.cell_data, self.point_data, self.field_data = {}, {}, {}


class Surface:
    """pyvista.PolyData(points, faces)."""

    def __init__(self, points, faces):
        if points.shape[1:] != (3,) or faces.ndim != 1:
            raise TypeError("arrays that PyVista refuses")
        self.points, self.faces, self.lines, self.verts, self.strips = points, faces, [], [], []
        self.cell_data, self.field_data = {}, {}


class DataSet:
    pass


def padded(rows):
    return np.concatenate([[len(row), *row] for row in rows])


class WithPyvista(unittest.TestCase):
    def setUp(self):
        self.before = sys.modules.get("pyvista")
        self.registered = {}

        def register_dataset_accessor(name, target):
            self.assertIs(target, DataSet)

            def put(accessor):
                self.registered[name] = accessor
                return accessor
            return put

        sys.modules["pyvista"] = types.SimpleNamespace(UnstructuredGrid=Grid, PolyData=Surface, DataSet=DataSet,
                                                       register_dataset_accessor=register_dataset_accessor)

    def tearDown(self):
        sys.modules.pop("pyvista", None)
        sys.modules.pop("pgdr._accessor", None)
        if self.before is not None:
            sys.modules["pyvista"] = self.before

    def test_tetgen_as_its_users_call_it(self):
        tet = tetgen.TetGen(Surface(POINTS, padded(QUADS)))
        tet.add_region(3, (0.5, 0.5, 0.5), max_vol=0.02)
        nodes, elems, attributes, markers = tet.tetrahedralize(
            order=1, mindihedral=10, minratio=1.6, quality=True, plc=True, quiet=False, verbose=2, zeroindex=True, facesout=True,
            edgesout=True, neighout=True, nobisect=False, steinerleft=-1, docheck=True, maxvolume=-1.0, regionattrib=True, noexact=False)
        a, b, c, d = nodes[elems].transpose(1, 0, 2)
        volumes = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6
        self.assertAlmostEqual(volumes.sum(), 1.0, places=12)
        self.assertTrue(volumes.min() > 0 and volumes.max() <= 0.02)
        self.assertEqual((set(attributes.tolist()), attributes.shape, markers.shape), ({3.0}, (len(elems),), (len(tet.trifaces),)))
        self.assertIs(tet.node, nodes)
        self.assertEqual(tet.grid.cell_data["region"].tolist(), [3.0] * len(elems))
        self.assertEqual(tet.grid.celltypes.tolist(), [10] * len(elems))
        self.assertEqual(tet.mesh.faces.tolist(), padded(QUADS).tolist())
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "box.vtu")
            tet.write(file)
            self.assertEqual(len(pgdr.Mesh.read(file).cells), len(elems))

    def test_holes_files_and_markers(self):
        inner = 0.25 + 0.5 * POINTS
        tet = tetgen.TetGen(np.concatenate([POINTS, inner]), np.concatenate([QUADS, QUADS + 8]), np.arange(1, 13))
        tet.add_hole([0.5, 0.5, 0.5])
        nodes, elems, _, markers = tet.tetrahedralize(switches="pq")
        self.assertEqual(set(markers.tolist()), set(range(1, 13)))
        a, b, c, d = nodes[elems].transpose(1, 0, 2)
        self.assertAlmostEqual((np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6).sum(), 1 - 0.125, places=12)
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "box.off")
            with open(file, "w", encoding="ascii") as made:
                made.write("OFF\n8 6 0\n" + "\n".join(" ".join(map(str, p)) for p in POINTS) + "\n")
                made.write("\n".join("4 " + " ".join(map(str, q)) for q in QUADS) + "\n")
            self.assertEqual(len(tetgen.TetGen(file).tetrahedralize(quality=False)[0]), 8)

    def test_a_background_mesh(self):
        background = pgdr.mesh(pgdr.Plc(POINTS, facets=QUADS), size=0.5).to_pyvista()
        background.point_data["target_size"] = np.full(len(background.points), 0.25)
        tet = tetgen.TetGen(POINTS, QUADS)
        nodes, elems, *_ = tet.tetrahedralize(bgmesh=background, metric=True)
        corners = nodes[elems]
        rows = corners[:, 1:] - corners[:, :1]
        radii = np.linalg.norm(np.linalg.solve(rows, (rows ** 2).sum(axis=2)[:, :, None] / 2)[:, :, 0], axis=1)
        self.assertLessEqual(radii.max(), 0.25 * 6 ** 0.5 / 4 * (1 + 1e-12))
        self.assertLess(len(tet.tetrahedralize()[1]), len(elems))
        del background.point_data["target_size"]
        with self.assertRaisesRegex(pgdr.UsageError, "target_size"):
            tet.tetrahedralize(bgmesh=background)

    def test_what_tetgen_does_and_this_does_not(self):
        tet = tetgen.TetGen(POINTS, QUADS)
        with self.assertRaisesRegex(pgdr.UsageError, "no mesh yet"):
            tet.grid
        for keywords, word in (({"order": 2}, "order.*four corners"), ({"refine": True}, "no mesh yet"),
                               ({"coarsen": True}, "no mesh yet"), ({"weighted": True}, "weighted"), ({"metric": True}, "bgmesh"),
                               ({"opt_scheme": 3}, "opt_scheme"), ({"minration": 2}, "minration"), ({"order": True}, "order")):
            with self.subTest(keywords), self.assertRaisesRegex(pgdr.UsageError, word):
                tet.tetrahedralize(**keywords)
        with self.assertRaisesRegex(pgdr.UsageError, "diagnose"):
            tet.make_manifold()
        for arguments in ((POINTS,), (Surface(POINTS, padded(QUADS)), None, [1]), ([[0, 0], [1, 0]], [[0, 1, 1]])):
            with self.subTest(arguments=arguments), self.assertRaises((pgdr.UsageError, TypeError)):
                tetgen.TetGen(*arguments)

    def test_names_and_faces_there_and_back(self):
        plc = pgdr.Plc(POINTS, facets=QUADS, markers=[1, 2, 3, 4, 5, 6], regions=[[0.5, 0.5, 0.5, 7]], region_names={7: "steel"},
                       marker_names={2: "roof"})
        made = pgdr.mesh(plc, size=0.4)
        grid = made.to_pyvista(constraints=True)
        self.assertEqual(grid.field_data["roof"].tolist(), [2, 2])
        faces = grid.celltypes == 5
        self.assertEqual(grid.cell_data["marker"][faces].tolist(), made.subfacet_markers.tolist())
        again = pgdr.Plc.from_pyvista(grid)
        self.assertEqual((again.region_names, again.marker_names), ({7.0: "steel"}, {2: "roof"}))
        self.assertEqual(set(again.markers.tolist()), {1, 2, 3, 4, 5, 6})
        self.assertTrue(pgdr.mesh(again).check(again))

    def test_many_faces_of_several_sizes(self):
        halves = [[3, a, b, c, 3, a, c, d] for a, b, c, d in QUADS[:2].tolist()]
        mixed = np.concatenate([np.concatenate(halves), padded(QUADS[2:])])
        plc = pgdr.Plc.from_pyvista(Surface(POINTS, mixed))
        self.assertEqual([len(f) for f in plc.facets], [3, 3, 3, 3, 4, 4, 4, 4])
        self.assertTrue(pgdr.mesh(plc).check(plc))
        for damaged in ([3, 0, 1, 2, 2, 0], [4, 0, 1, 2], [3, 0, 1, 2, -1, 0, 1, 2]):
            with self.subTest(damaged), self.assertRaisesRegex(pgdr.UsageError, "damaged"):
                pgdr.Plc.from_pyvista(Surface(POINTS, np.array(damaged)))

    def test_accessor(self):
        importlib.import_module("pgdr._accessor")
        accessor = self.registered["pgdr"](Surface(POINTS, padded(QUADS)))
        self.assertIsInstance(accessor.mesh(size=0.5), Grid)
        self.assertEqual(accessor.diagnose(), [])
        self.assertIsInstance(accessor.plc(), pgdr.Plc)


class Axes:
    """What is drawn; stands in for matplotlib's."""

    def __init__(self):
        self.axes, self.drawn = self, []

    def set_aspect(self, how):
        self.drawn.append(("aspect", how))

    def triplot(self, x, y, triangles, *_, **__):
        if np.shape(triangles)[1] != 3 or np.max(triangles) >= len(x) or len(x) != len(y):
            raise ValueError("triangles that matplotlib refuses")
        self.drawn.append(("triangles", len(triangles)))

    def scatter(self, x, y, **_):
        self.drawn.append(("points", len(x)))

    def plot(self, x, y, **_):
        self.drawn.append(("line", len(x)))

    def get_xaxis(self):
        return types.SimpleNamespace(set_visible=lambda _: None)

    get_yaxis = get_xaxis


class RefinedAndCoarse(unittest.TestCase):
    def test_meshes(self):
        """r and R take the mesh in the place of the surface."""
        old = pgdr.tetrahedralize(pgdr.Plc(POINTS, facets=QUADS, markers=[1, 2, 3, 4, 5, 6]), max_volume=0.01).mesh
        for keywords in ({"refine": True, "max_volume": 0.001, "docheck": True}, {"switches": "rqa0.001C"}):
            fine = pgdr.tetrahedralize(old, **keywords)
            np.testing.assert_array_equal(fine.nodes[:len(old.points)], old.points)
            at = fine.nodes[fine.elems]
            self.assertLessEqual(np.linalg.det(at[:, 1:] - at[:, :1]).max() / 6, 0.001)
        for keywords in ({"coarsen": True, "docheck": True}, {"switches": "RqC"}):
            coarse = pgdr.tetrahedralize(fine.mesh, **keywords)
            self.assertLess(len(coarse.elems), len(old.cells) / 4)
            self.assertEqual(set(coarse.face_markers), {1, 2, 3, 4, 5, 6})
        for given, keywords in (((POINTS, QUADS), {"refine": True}), ((old,), {"refine": True, "markers": [1] * 6}),
                                ((old,), {"switches": "rqa"})):
            with self.assertRaises(pgdr.UsageError):
                pgdr.tetrahedralize(*given, **keywords)
        tet = tetgen.TetGen(POINTS, QUADS)
        tet.tetrahedralize(maxvolume=0.01)
        count = len(tet.elem)
        tet.tetrahedralize(refine=True, maxvolume=0.002)
        self.assertGreater(len(tet.elem), 3 * count)


class Triangle(unittest.TestCase):
    def test_functions_of_points(self):
        pts = np.random.default_rng(1).random((40, 2))
        hull = triangle.convex_hull(pts)
        self.assertEqual(set(np.unique(hull, return_counts=True)[1].tolist()), {2})
        triangles = triangle.delaunay(pts)
        self.assertEqual(len(triangles), 2 * 40 - 2 - len(hull))
        centers, edges, origins, directions = triangle.voronoi(pts)
        self.assertEqual((len(centers), len(edges), len(origins)), (len(triangles), (3 * len(triangles) - len(hull)) // 2, len(hull)))
        near = np.sort(np.linalg.norm(centers[:, None] - pts[None], axis=2), axis=1)
        np.testing.assert_allclose(near[:, 0], near[:, 2], rtol=1e-9)  # three points are nearest, as far as each other
        for origin, direction in zip(origins, directions):  # far out on a ray two are
            far = np.sort(np.linalg.norm(centers[origin] + 1e3 * direction / np.linalg.norm(direction) - pts, axis=1))
            self.assertAlmostEqual(far[0], far[1], places=6)

    def test_second_order(self):
        tri = {**SQUARE, "segment_markers": [2, 3, 4, 5], "vertex_attributes": [0.0, 1.0, 1.0, 0.0]}
        made = triangle.triangulate(tri, "pqa0.05o2C")
        at, cells = made["vertices"], made["triangles"]
        self.assertEqual(cells.shape[1], 6)
        for i in range(3):
            np.testing.assert_allclose(at[cells[:, 3 + i]], (at[cells[:, (i + 1) % 3]] + at[cells[:, (i + 2) % 3]]) / 2, atol=1e-15)
        np.testing.assert_allclose(made["vertex_attributes"][:, 0], at[:, 0], atol=1e-12)
        bottom = (at[:, 1] == 0) & (at[:, 0] > 0) & (at[:, 0] < 1)
        self.assertEqual(set(made["vertex_markers"][bottom].ravel().tolist()), {2})
        self.assertEqual(len(np.unique(cells)), len(at))

    def test_refined(self):
        """r: a result is refined by areas of its triangles; all vertices stay, first and in their order, and so do segments."""
        tri = {**SQUARE, "segment_markers": [2, 3, 4, 5], "vertex_attributes": [0.0, 1.0, 1.0, 0.0]}
        coarse = triangle.triangulate(tri, "pqa0.05A")
        areas = np.where(coarse["vertices"][coarse["triangles"]].mean(axis=1)[:, 0] < 0.5, 0.002, -1)
        for opts, key in (("rpqaAC", areas), ("rpqaC", areas[:, None])):
            fine = triangle.triangulate({**coarse, "triangle_max_area": key}, opts)
            count = len(coarse["vertices"])
            np.testing.assert_array_equal(fine["vertices"][:count], coarse["vertices"])
            np.testing.assert_allclose(fine["vertex_attributes"][:, 0], fine["vertices"][:, 0], atol=1e-12)
            at = fine["vertices"][fine["triangles"]]
            size = np.linalg.det(at[:, 1:] - at[:, :1]) / 2
            self.assertLessEqual(size[at.max(axis=1)[:, 0] < 0.4].max(), 0.002)
            self.assertGreater(size.max(), 0.005)
            self.assertAlmostEqual(size.sum(), 1, places=12)
            self.assertEqual(set(fine["segment_markers"].ravel()), {2, 3, 4, 5})
        labelled = {**coarse, "triangle_attributes": np.arange(len(coarse["triangles"]))[:, None] % 2}
        self.assertEqual(set(triangle.triangulate(labelled, "rpqA")["triangle_attributes"].ravel()), {0, 1})
        for opts, given in (("rpqa", coarse), ("rpq", SQUARE)):
            with self.assertRaises(pgdr.UsageError):
                triangle.triangulate(given, opts)

    def test_sizes_by_a_function(self):
        made = triangle.triangulate(SQUARE, "pqa0.02uC", size=lambda at: 0.002 + at[:, 0])
        a, b, c = made["vertices"][made["triangles"]].transpose(1, 0, 2)
        areas = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
        self.assertTrue((areas <= np.minimum(0.02, 0.002 + (a + b + c)[:, 0] / 3) * (1 + 1e-12)).all())
        for opts, more in (("pu", {}), ("pq", {"size": 0.1})):
            with self.assertRaisesRegex(pgdr.UsageError, "together"):
                triangle.triangulate(SQUARE, opts, **more)

    def test_drawn(self):
        made = triangle.triangulate({**SQUARE, "holes": [[9, 9]]}, "pqa0.1e")
        axes = Axes()
        triangle.plot(axes, **made)
        self.assertIn(("triangles", len(made["triangles"])), axes.drawn)
        self.assertEqual(axes.drawn.count(("line", 2)), len(made["segments"]))
        centers, edges, origins, directions = triangle.voronoi(SQUARE["vertices"])
        axes = Axes()
        triangle.plot(axes, vertices=centers, edges=edges, ray_origins=origins, ray_directions=directions)
        self.assertEqual(axes.drawn.count(("line", 2)), len(edges) + len(origins))

    @unittest.skipUnless(pyplot, "matplotlib is not installed")
    def test_compare_draws(self):
        made = triangle.triangulate(SQUARE, "pqa0.1")
        left, right = triangle.compare(pyplot, SQUARE, made)
        self.assertTrue(left.lines and right.lines)


def polygon(*rings):
    return {"type": "Polygon", "coordinates": [list(ring) for ring in rings]}


LAND = polygon([[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]], [[1, 1], [2, 1], [2, 2], [1, 2], [1, 1]])
BAY = polygon([[4, 1], [6, 1], [6, 3], [4, 3]])
RIVER = {"type": "LineString", "coordinates": [[-1, 3], [5, 3.25], [5, 2]]}
WELL = {"type": "Point", "coordinates": [3, 3.5]}


class Geodata(unittest.TestCase):
    def meshed(self, plc, expected, **bounds):
        made = pgdr.mesh(plc, **bounds)
        self.assertTrue(made.check(plc))
        at = made.points[made.cells]
        u, v = at[:, 1] - at[:, 0], at[:, 2] - at[:, 0]
        areas = (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
        found = {label: areas[made.regions == label].sum() for label in np.unique(made.regions)}
        self.assertEqual(set(found), set(expected))
        for label, area in expected.items():
            self.assertAlmostEqual(found[label] / area, 1, places=6)
        return made, areas

    def test_rows_of_all_kinds(self):
        plc = pgdr.Plc.from_shapely([LAND, BAY, RIVER, WELL], labels=["land", "bay", "", ""], sizes=[0, 0.05, np.nan, 0],
                                    names=["land", "bay", "river", "well"])
        made, areas = self.meshed(plc, {1.0: 15.0, 2.0: 4.0}, min_angle=25)
        self.assertEqual((made.region_names, made.marker_names), ({1.0: "land", 2.0: "bay"}, {3: "river"}))
        self.assertLessEqual(areas[made.regions == 2].max(), 0.05)
        self.assertTrue((made.points == [3, 3.5]).all(axis=1).any())
        ends = made.points[made.subsegments]
        common = (ends[:, :, 0] == 4).all(axis=1) & (ends[:, :, 1] >= 1).all(axis=1) & (ends[:, :, 1] <= 3).all(axis=1)
        self.assertEqual(set(made.markers[common].tolist()), {1})
        self.assertIn(3, made.markers.tolist())

    def test_overlaps_islands_and_gaps(self):
        frame = [polygon([[0, 0], [3, 0], [3, 1], [0, 1]]), polygon([[0, 2], [3, 2], [3, 3], [0, 3]]),
                 polygon([[0, 1], [1, 1], [1, 2], [0, 2]]), polygon([[2, 1], [3, 1], [3, 2], [2, 2]])]
        self.meshed(pgdr.Plc.from_shapely(frame), {1.0: 3.0, 2.0: 3.0, 3.0: 1.0, 4.0: 1.0})
        isle = polygon([[1, 1], [2, 1], [2, 2], [1, 2]])
        self.meshed(pgdr.Plc.from_shapely([LAND, isle], labels=[5, 6]), {5.0: 15.0, 6.0: 1.0})
        over = polygon([[1, 0], [3, 0], [3, 2], [1, 2]])
        self.meshed(pgdr.Plc.from_shapely([polygon([[0, 0], [2, 0], [2, 2], [0, 2]]), over]), {1.0: 4.0, 2.0: 2.0})
        both = {"type": "MultiPolygon", "coordinates": [BAY["coordinates"], isle["coordinates"]]}
        self.meshed(pgdr.Plc.from_shapely([both]), {1.0: 5.0})

    def test_large_coordinates(self):
        far = np.array([512345.67, 5812345.67])
        def moved(g):
            return polygon(*[(np.array(ring) + far).tolist() for ring in g["coordinates"]])
        near = pgdr.mesh(pgdr.Plc.from_shapely([LAND, BAY]), min_angle=25)
        made, _ = self.meshed(pgdr.Plc.from_shapely([moved(LAND), moved(BAY)]), {1.0: 15.0, 2.0: 4.0}, min_angle=25)
        self.assertLess(abs(len(made.cells) - len(near.cells)), 0.2 * len(near.cells) + 5)

    def assert_one_input(self, rows, **columns):
        """A file of GeoJSON, with --resolve-crossings, and the rows as geometries are one input, to the last bit."""
        keys = {"labels": "label", "sizes": "size", "names": "name", "markers": "marker"}
        features = [{"type": "Feature", "geometry": row, "properties": {keys[name]: values[i] for name, values in columns.items()}}
                    for i, row in enumerate(rows)]
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "map.geojson")
            with open(file, "w", encoding="utf-8") as text:
                json.dump({"type": "FeatureCollection", "features": features}, text)
            read = pgdr.resolve_crossings(pgdr.Plc.read(file))[0]
        made = pgdr.Plc.from_shapely(rows, **columns)
        for name in ("points", "segments", "markers", "holes", "regions"):
            self.assertEqual(getattr(made, name).tolist(), getattr(read, name).tolist(), name)
        self.assertEqual((made.region_names, made.marker_names), (read.region_names, read.marker_names))
        return made

    def test_files_and_geometries_are_one_input(self):
        rows = [RIVER, LAND, None, WELL, BAY, {"type": "GeometryCollection", "geometries": [BAY, RIVER]}]
        made = self.assert_one_input(rows)
        self.assertEqual((set(made.regions[:, 2]), len(made.holes)), ({2, 5}, 2))
        named = self.assert_one_input(rows, labels=[0, 7, 0, 0, 8, 8], sizes=[0, 0.5, 0, 0, 0.1, 0], names=list("abcdef"),
                                      markers=[3, 1, 1, 0, 2, 5])
        self.assertEqual((named.region_names, named.marker_names), ({7.0: "b", 8.0: "e"}, {3: "a", 5: "f"}))
        rng = np.random.default_rng(5)
        for trial in range(6):
            rows = []
            for at in rng.uniform(0, 4, (12, 2)):
                a, b = np.sort(rng.uniform(0, 2 * np.pi, (2, 5)))
                rows.append([polygon((at + np.array([np.cos(a), np.sin(a)]).T).tolist()),
                             {"type": "LineString", "coordinates": (at + np.array([np.cos(b), np.sin(b)]).T).tolist()},
                             {"type": "Point", "coordinates": at.tolist()}][rng.integers(0, 3)])
            with self.subTest(trial=trial):
                made = self.assert_one_input(rows + [LAND])
                self.assertGreater(len(made.regions), 3)

    def test_lines_alone(self):
        ring = {"type": "LineString", "coordinates": [[0, 0], [2, 0], [2, 2], [0, 2], [0, 0]]}
        self.meshed(pgdr.Plc.from_shapely([ring, {"type": "LineString", "coordinates": [[0.5, 1], [1.5, 1]]}]), {0.0: 4.0})

    def test_refusals(self):
        for given, more, word in (([WELL], {}, "nothing encloses"), ([LAND], {"labels": [1, 2]}, "1 rows"),
                                  ([LAND], {"sizes": [-1]}, "areas"), ([LAND], {"markers": [0.5]}, "whole"),
                                  ([{"type": "Curve", "coordinates": [[0, 0]]}], {}, "Curve"), ([LAND], {"names": []}, "names"),
                                  ([{"type": "Polygon", "coordinates": [[1, 2]]}], {}, "Polygon|ring")):
            with self.subTest(word), self.assertRaisesRegex(pgdr.UsageError, word):
                pgdr.Plc.from_shapely(given, **more)
        with self.assertRaises(TypeError):
            pgdr.Plc.from_shapely([5])
        with self.assertRaises(TypeError):
            pgdr.Plc.from_geopandas([LAND])

    @unittest.skipUnless(shapely, "Shapely is not installed")
    def test_shapely(self):
        plc = pgdr.Plc.from_shapely([shapely.shape(g) for g in (LAND, BAY, RIVER, WELL)])
        self.meshed(plc, {1.0: 15.0, 2.0: 4.0})
        self.meshed(pgdr.Plc.from_shapely(shapely.shape(LAND).buffer(0)), {1.0: 15.0})

    def frame(self, geometries, **columns):
        if geopandas:
            return geopandas.GeoDataFrame(columns, geometry=[None if g is None else shapely.shape(g) for g in geometries])
        made = type("GeoDataFrame", (dict,), {"columns": property(lambda self: list(self))})(**columns)
        made.geometry = geometries
        return made

    def test_geopandas(self):
        frame = self.frame([LAND, BAY, None, RIVER], use=["land", "sea", "land", "river"], area=[0.5, 0.1, np.nan, np.nan])
        made, areas = self.meshed(pgdr.Plc.from_geopandas(frame, label="use", size="area", marker="use"), {1.0: 15.0, 2.0: 4.0})
        self.assertEqual((made.region_names, made.marker_names), ({1: "land", 2: "sea"}, {1: "land", 2: "sea", 3: "river"}))
        self.assertLessEqual(areas[made.regions == 2].max(), 0.1)
        with self.assertRaisesRegex(pgdr.UsageError, "no column 'uses'.*use"):
            pgdr.Plc.from_geopandas(frame, label="uses")


if __name__ == "__main__":
    unittest.main()
