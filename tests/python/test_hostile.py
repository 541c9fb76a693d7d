# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What no caller should pass, and some do: every argument gets every odd object, meshes are no meshes, owners die, arrays change.
What comes of it is a result, or an error of pgdr or a TypeError; under a sanitizer also nothing that memory forbids."""
import array
import datetime
import gc
import threading
import unittest
import warnings

import numpy as np

import pgdr
from shapes import CUBE_FACETS, CUBE_POINTS, SQUARE_POINTS, SQUARE_SEGMENTS, checked, cube, same, square


def unaligned(like):
    """The same numbers, a byte away from where the processor wants them."""
    given = np.ascontiguousarray(like)
    moved = np.frombuffer(b"x" + given.tobytes(), dtype=given.dtype, offset=1).reshape(given.shape)
    assert not moved.flags.aligned
    return moved


ODD = [None, True, 0, -1, 7, 2**31, 2**63, 2**70, -2**70, 1.5, -0.0, np.nan, np.inf, 1j, "", "a", "seeds", b"\0", [], [[]], [[[]]], [None],
       [[None, None]], {}, {"a": 1}, {0: [[0, 0, 0]]}, set(), object(), object, len, lambda *_: None, datetime.date(2026, 1, 1),
       np.array(3.0), np.array([], dtype=int), np.zeros((0, 2)), np.zeros((0, 3), dtype=int), np.zeros((2, 0)), np.zeros((2, 2, 2)),
       np.zeros((3, 2), dtype=bool), np.array([[0, 1], [1, 2]], dtype=object), np.array([["a", "b"]]), np.zeros(3, dtype="M8[s]"),
       np.zeros(2, dtype=[("x", float), ("y", float)]), np.array([[0, 2**64 - 1]], dtype=np.uint64), np.array([[0, 2**32]]),
       np.array([[-1, 0]]), np.array([[0.0, 1.0]]), np.array([[np.nan, 1], [0, 1]]), np.full((4, 2), 1e308), np.full((4, 3), 5e-324),
       np.zeros((1, 4)), np.zeros((4, 1), dtype=np.int8), np.broadcast_to(np.array([0, 1]), (5, 2)), memoryview(array.array("d", [0, 1])),
       range(4), iter([1, 2]), np.ma.masked_array([[0, 1]], mask=[[True, False]]), np.matrix([[0, 1], [1, 2]])]


class EveryArgument(unittest.TestCase):
    def throw(self, call, name):
        """One argument of a call, each odd object in turn. How many were refused."""
        refused = 0
        for value in ODD:
            with self.subTest(argument=name, value=repr(value)[:60]), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                try:
                    call(value)
                except (pgdr.Error, TypeError) as error:
                    self.assertNotIn("incompatible", str(error), "words of the extension module, not of the package")
                    refused += 1
        return refused

    def test_inputs(self):
        for name in ("segments", "markers", "point_markers", "holes", "regions", "segment_markers", "point_attributes", "tolerance",
                     "coarse", "facets", "facet_holes"):
            for make in (square, cube):
                with self.subTest(name):
                    points, more = (SQUARE_POINTS, {"segments": SQUARE_SEGMENTS}) if make is square else (CUBE_POINTS, {"facets": CUBE_FACETS})
                    self.assertGreater(self.throw(lambda v: pgdr.Plc(points, **{**more, name: v}), name), 20)
        self.assertGreater(self.throw(pgdr.Plc, "points"), 30)
        self.assertGreater(self.throw(lambda v: pgdr.Plc.from_polygons(v, []), "outer"), 30)
        self.assertGreater(self.throw(lambda v: pgdr.Plc.from_polygons(SQUARE_POINTS, v), "holes"), 30)
        self.assertGreater(self.throw(lambda v: pgdr.Plc.from_polygons(SQUARE_POINTS, [], markers=v), "markers"), 30)
        self.assertGreater(self.throw(lambda v: pgdr.Plc.from_polygons([v, SQUARE_POINTS]), "a polygon"), 30)
        self.assertGreater(self.throw(lambda v: pgdr.Plc.from_polygons({"type": "Polygon", "coordinates": v}), "coordinates"), 30)
        self.assertGreater(self.throw(lambda v: pgdr.Plc.from_polygons(SQUARE_POINTS, labels=v), "labels"), 30)
        self.assertEqual(self.throw(pgdr.Plc.from_mesh, "mesh"), len(ODD))
        self.assertEqual(self.throw(pgdr.Plc.from_meshio, "mesh"), len(ODD))
        self.assertEqual(self.throw(pgdr.Plc.from_pyvista, "mesh"), len(ODD))
        self.assertEqual(self.throw(pgdr.Plc.read, "path"), len(ODD))
        self.assertGreater(self.throw(lambda v: square().with_tolerance(v), "tolerance"), 30)

    def test_runs(self):
        names = ("min_angle", "radius_edge", "size", "min_dihedral", "optimize", "threads", "regions", "region_sizes", "selector",
                 "keep_boundary", "tolerance", "max_volume", "min_edge", "time_limit", "max_vertices", "refine", "schedule", "progress",
                 "drop_unused_points", "memory_guard", "stop")
        for name in names:
            for plc in (square(), cube()):
                self.assertGreater(self.throw(lambda v: pgdr.mesh(plc, **{"max_vertices": 40, name: v}), name), 15, name)
        self.assertEqual(self.throw(pgdr.mesh, "plc"), len(ODD))

    def test_meshes(self):
        made = checked(self, square(), size=0.1)
        self.assertGreater(self.throw(lambda v: pgdr.Mesh.from_arrays(v, [[0, 1, 2]]), "points"), 30)
        self.assertGreater(self.throw(lambda v: pgdr.Mesh.from_arrays(SQUARE_POINTS, v), "cells"), 30)
        for name in ("plc", "delaunay", "reasons", "min_angle", "size", "region_sizes", "regions"):
            self.assertGreater(self.throw(lambda v: pgdr.check(made, **{name: v}), name), 25, name)
        for call in (pgdr.check, pgdr.diagnose, pgdr.resolve_crossings, pgdr.with_convex_hull, pgdr.info, pgdr.Mesh.read):
            self.assertEqual(self.throw(call, call.__name__), len(ODD), call)
        self.assertEqual(self.throw(lambda v: made.write(v), "path"), len(ODD))

    def test_fields(self):
        made = checked(self, square(), size=0.1)
        field = pgdr.sizes_at_points([[0, 0]], [0.1], 0.5)
        for call, least in ((lambda v: pgdr.sizes_at_points(v, [1], 0.1), 30), (lambda v: pgdr.sizes_at_points([[0, 0]], v, 0.1), 30),
                            (lambda v: pgdr.sizes_at_points([[0, 0]], [1], v), 30), (lambda v: pgdr.sizes_on_mesh(v, [1]), len(ODD)),
                            (lambda v: pgdr.sizes_on_mesh(made, v), len(ODD)), (lambda v: pgdr.limit_growth(made, v, 1), len(ODD)),
                            (lambda v: pgdr.sizes_on_mesh(made, np.ones(len(made.cells)), v), len(ODD) - 1),
                            (lambda v: pgdr.smallest(field, v), 30), (field, 30)):
            self.assertGreaterEqual(self.throw(call, "of a field"), least)

    def test_what_others_call(self):
        tri = {"vertices": SQUARE_POINTS, "segments": SQUARE_SEGMENTS}
        for key in ("vertices", "segments", "holes", "regions", "vertex_markers", "segment_markers", "vertex_attributes"):
            self.assertGreater(self.throw(lambda v: pgdr.triangulate({**tri, key: v}, "p"), key), 20, key)
        self.assertGreater(self.throw(lambda v: pgdr.triangulate(v, "p"), "tri"), 40)
        self.assertGreater(self.throw(lambda v: pgdr.triangulate(tri, v), "opts"), 40)
        for name in ("minratio", "mindihedral", "max_volume", "steinerleft", "switches", "markers", "holes", "regions"):
            self.assertGreater(self.throw(lambda v: pgdr.tetrahedralize(CUBE_POINTS, CUBE_FACETS, **{name: v}), name), 15, name)


class ArraysOfEveryKind(unittest.TestCase):
    def test_layouts(self):
        wanted = checked(self, cube(), size=0.5)
        triangles = np.array([[q[0], q[i], q[i + 1]] for q in CUBE_FACETS for i in (1, 2)])
        whole = pgdr.mesh(pgdr.Plc(CUBE_POINTS, facets=triangles), size=0.5)
        frozen = CUBE_POINTS.copy()
        frozen.setflags(write=False)
        for points in (unaligned(CUBE_POINTS), frozen, CUBE_POINTS[::-1][::-1], np.asfortranarray(CUBE_POINTS), CUBE_POINTS.astype(">f8"),
                       np.ma.masked_array(CUBE_POINTS), CUBE_POINTS.astype(np.longdouble), CUBE_POINTS.astype(np.float16),
                       np.lib.stride_tricks.as_strided(CUBE_POINTS, CUBE_POINTS.shape, CUBE_POINTS.strides)):
            self.assertTrue(same(wanted, checked(self, pgdr.Plc(points, facets=CUBE_FACETS), size=0.5)))
        for kind in (np.int32, np.uint32, np.int64, np.uint64, np.longlong, np.ulonglong, ">u8", np.int16):
            facets = triangles.astype(kind)
            for given in (facets, unaligned(facets), np.asfortranarray(facets), np.repeat(facets, 2, axis=1)[:, ::2]):
                self.assertTrue(same(whole, checked(self, pgdr.Plc(CUBE_POINTS, facets=given), size=0.5)), kind)

    def test_unaligned_arrays_wherever_arrays_go(self):
        plc = pgdr.Plc(unaligned(SQUARE_POINTS), unaligned(SQUARE_SEGMENTS), markers=unaligned(np.arange(4)), holes=None,
                       regions=unaligned(np.array([[0.5, 0.5, 3.0]])), point_markers=unaligned(np.arange(4, dtype=np.int32)),
                       point_attributes=unaligned(SQUARE_POINTS))
        made = checked(self, plc, size=lambda at: unaligned(np.full(len(at), 0.02)))
        field = pgdr.sizes_on_mesh(made, unaligned(np.full(len(made.points), 0.01)))
        np.testing.assert_array_equal(field(unaligned(SQUARE_POINTS)), [0.01] * 4)
        near = pgdr.sizes_at_points(unaligned(SQUARE_POINTS), unaligned(np.full(4, 0.01)), 0.5)
        np.testing.assert_allclose(near(SQUARE_POINTS), [0.01] * 4)
        again = pgdr.Mesh.from_arrays(unaligned(made.points), unaligned(made.cells))
        self.assertTrue(np.array_equal(again.points, made.points) and np.array_equal(again.cells, made.cells))


class OwnersAndChanges(unittest.TestCase):
    def test_inputs_are_copies(self):
        points, segments = SQUARE_POINTS.copy(), SQUARE_SEGMENTS.copy()
        plc = pgdr.Plc(points, segments)
        points[:], segments[:] = np.nan, 2**40
        self.assertTrue(same(checked(self, plc, size=0.1), pgdr.mesh(square(), size=0.1)))

    def test_fields_outlive_what_they_were_made_of(self):
        made = checked(self, cube(), size=0.3)
        values, at, sizes = np.full(len(made.points), 0.2), CUBE_POINTS.copy(), np.full(8, 0.2)
        fields = [pgdr.sizes_on_mesh(made, values), pgdr.sizes_at_points(at, sizes, 0.0)]
        fields.append(pgdr.smallest(*fields, lambda x: np.full(len(x), 0.3)))
        values[:], at[:], sizes[:] = -1, np.nan, -1
        del made, values, at, sizes
        gc.collect()
        kept = [np.ones(1000) for _ in range(200)]  # what would take the place of freed memory
        for field in fields:
            np.testing.assert_array_equal(field(CUBE_POINTS), [0.2] * 8)
            checked(self, cube(), size=field)
        del kept

    def test_views_of_views_and_of_inputs(self):
        plc = cube(regions=[[0.5, 0.5, 0.5, 3]], holes=np.zeros((0, 3)), point_markers=np.arange(8))
        made = checked(self, plc, size=0.3)
        views = [plc.points[2:], plc.point_markers[::2], plc.regions[0], plc.facets[1:], made.regions[5:], made.points.T[1], made.neighbors()[1:],
                 made.edges()[::3], made.subsegment_markers[1:], memoryview(made.cells[3:])]
        copies = [np.array(v) for v in views]
        del plc, made
        gc.collect()
        for _ in range(5):
            pgdr.mesh(cube(), size=0.2)
        for view, copy in zip(views, copies):
            np.testing.assert_array_equal(view, copy)

    def test_a_callback_may_keep_and_change_what_it_gets_and_gives(self):
        kept = []

        def size(at):
            given = np.full(len(at), 0.02)
            kept.append((at, given))
            for earlier, returned in kept[:-1]:
                earlier[:] = returned[:] = np.nan
            at += 1
            return given

        self.assertTrue(same(checked(self, square(), size=0.02), pgdr.mesh(square(), size=size)))
        self.assertTrue(kept)
        elements = []

        def select(e):
            elements.append(e)
            for field in e:
                field.setflags(write=True)
            centre = e.disk_center.copy()
            for field in e:
                field[...] = 0
            return centre

        plc = pgdr.Plc([[0, 0], [4, 0], [4, 0.5], [0, 0.5], [0.02, 0.01]], SQUARE_SEGMENTS)
        self.assertTrue(same(pgdr.mesh(plc, selector=lambda e: e.disk_center), pgdr.mesh(plc, selector=select)))
        self.assertTrue(elements)

    def test_arrays_that_another_thread_changes(self):
        rng = np.random.default_rng(1)
        points = np.vstack([SQUARE_POINTS, rng.random((3000, 2))])
        ids = np.tile(SQUARE_SEGMENTS, (2000, 1))
        calm, over = ids.copy(), threading.Event()

        def change():
            while not over.is_set():
                ids[...] = 2**62
                ids[...] = calm

        thread = threading.Thread(target=change)
        thread.start()
        try:
            made = 0
            for _ in range(60):
                try:
                    plc = pgdr.Plc(points, ids)
                except pgdr.InputError as error:
                    self.assertEqual(error.code, "index_out_of_range")
                else:
                    self.assertLess(int(plc.segments.max()), 4)
                    made += 1
        finally:
            over.set()
            thread.join()
        self.assertGreaterEqual(made, 0)

    def test_many_threads_make_use_and_drop_one_mesh(self):
        made = checked(self, cube(), size=0.3)
        failed = []

        def use():
            try:
                for _ in range(3):
                    views = [made.points, made.cells, made.neighbors(), made.edges()]
                    made.quality(), made.check(cube()), made._repr_html_(), [v.sum() for v in views]
            except Exception as error:  # pylint: disable=broad-except
                failed.append(error)

        threads = [threading.Thread(target=use) for _ in range(4)]
        for t in threads:
            t.start()
        for t in threads:
            t.join()
        self.assertEqual(failed, [])


class MeshesThatAreNone(unittest.TestCase):
    def meshes(self):
        good = pgdr.mesh(cube(), size=0.4)
        points, cells = np.array(good.points), np.array(good.cells)
        yield "reversed", points, cells[:, [1, 0, 2, 3]]
        yield "each twice", points, np.vstack([cells, cells])
        yield "thrice at a face", points, np.vstack([cells[:1], cells[:1, [0, 2, 1, 3]], cells[:1]])
        yield "one vertex", points, np.zeros((5, 4), dtype=int)
        yield "all in one place", np.zeros_like(points), cells
        yield "huge", points * 1e300, cells
        yield "no cells", points, np.zeros((0, 4), dtype=int)
        yield "nothing", np.zeros((0, 3)), np.zeros((0, 4), dtype=int)
        yield "flat", points * [1, 1, 0], cells
        yield "shuffled", points, np.random.default_rng(2).permutation(cells.reshape(-1)).reshape(-1, 4)
        flat = pgdr.mesh(square(), size=0.05)
        yield "2D twice", flat.points, np.vstack([flat.cells, flat.cells])

    def test_what_is_asked_of_them_has_an_answer(self):
        count = 0
        for name, points, cells in self.meshes():
            with self.subTest(name), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                made = pgdr.Mesh.from_arrays(points, cells)
                plc = square() if made.dimension == 2 else cube()
                self.assertFalse(pgdr.check(made, plc), name)
                made._repr_html_()
                for ask in (made.neighbors, made.edges, made.quality, made.__reduce__, lambda: repr(made), lambda: pgdr.info(made),
                            lambda: pgdr.check(made), lambda: pgdr.check(made, delaunay=True, radius_edge=2),
                            lambda: pgdr.limit_growth(made, np.ones(len(points)), 0.1),
                            lambda: pgdr.sizes_on_mesh(made, np.ones(len(points)))(np.zeros((3, made.dimension)))):
                    try:
                        ask()
                    except pgdr.Error as error:
                        self.assertNotEqual(error.code, "internal", error)
                count += 1
        self.assertEqual(count, 11)

    def test_points_are_finite(self):
        for value in (np.nan, np.inf, -np.inf):
            points = CUBE_POINTS.copy()
            points[3, 1] = value
            with self.assertRaises(pgdr.InputError) as caught:
                pgdr.Mesh.from_arrays(points, [[0, 1, 2, 4]])
            self.assertEqual((caught.exception.code, caught.exception.ids), ("not_finite", [3]))

    def test_reasons_are_of_another_input(self):
        needle = pgdr.Plc([[0, 0, 0], [1, 0, 0], [1, 0.02, 0], [0.5, 0.01, 1]], facets=[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
        made = checked(self, needle, size=0.02)
        named = [entity for reason in made.reasons for entity in reason.entities]
        self.assertTrue(named)
        for kind, what in named:
            self.assertTrue(what in range(4) if kind == "facet" else kind == "segment" and np.shape(what) == (2, 3), (kind, what))
        for other in (pgdr.Plc(CUBE_POINTS[:4] + CUBE_POINTS[1:5], facets=[[0, 1, 2]]), cube(), pgdr.Plc(np.zeros((0, 3)))):
            try:
                self.assertFalse(pgdr.check(made, other))
            except pgdr.InputError:
                pass

    def test_facets_that_are_none(self):
        wrong = ([[]], [[[]]], [[[], []]], [[0]], [[0, 0, 0]], [[0, 1, 1, 0]], [[0, 1]], [[[0, 1, 2], [3]]], [[0, 1, 2], [[]]], [[0, 3, 1, 2]],
                 [list(range(8))], [[0, 1, 7, 6, 5, 4, 3, 2]] * 3, np.zeros((3, 5), dtype=int))
        for facets in wrong:
            with self.subTest(facets=str(facets)), self.assertRaises(pgdr.Error):
                plc = pgdr.Plc(CUBE_POINTS, facets=facets)
                list(plc.facets), repr(plc), pgdr.diagnose(plc)
                pgdr.mesh(plc)

    def test_numbers_at_the_ends_of_the_range(self):
        for scale in (1e-320, 1e-160, 1e150, 1e300, 1.7e308):
            for plc in (pgdr.Plc(SQUARE_POINTS * scale, SQUARE_SEGMENTS), pgdr.Plc(CUBE_POINTS * scale, facets=CUBE_FACETS)):
                for options in ({}, {"max_vertices": 60, "size": scale * 0.2}):
                    with self.subTest(scale=scale, dimension=plc.dimension, **options):
                        try:
                            made = pgdr.mesh(plc, **options)
                            made.quality(), made._repr_html_()
                        except pgdr.Error as error:
                            self.assertNotEqual(error.code, "internal", error)


if __name__ == "__main__":
    unittest.main()
