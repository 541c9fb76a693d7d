# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Nothing stays allocated of what is dropped: the address sanitizer counts the bytes, of C++ and of Python (PYTHONMALLOC=malloc)."""
import ctypes
import gc
import os
import pickle
import tempfile
import threading
import unittest

import numpy as np

import pgdr
from shapes import CUBE_FACETS, CUBE_POINTS, SQUARE_POINTS, SQUARE_SEGMENTS, cube, square

try:
    allocated = ctypes.CDLL(None).__sanitizer_get_current_allocated_bytes
    allocated.restype = ctypes.c_size_t
except AttributeError:
    allocated = None
TIMES = 12
NOISE = 400  # bytes a call: caches that grow for a while, of Python, numpy and TBB


def refused(call):
    """Calls what raises an error of pgdr, or of a callback."""
    try:
        call()
    except (pgdr.Error, TypeError, ZeroDivisionError) as error:
        return error.args
    raise AssertionError("nothing was refused")


def write_and_read(mesh, folder):
    for ending in ("vtu", "msh", "mesh"):
        file = os.path.join(folder, f"m.{ending}")
        mesh.write(file)
        pgdr.Mesh.read(file), pgdr.Plc.read(file) if ending != "vtu" else None


def stopped_by_another_thread():
    stop = pgdr.StopSource()
    timer = threading.Timer(0.01, stop.stop)
    timer.start()
    pgdr.mesh(cube(), size=0.02, stop=stop, threads=1)
    timer.join()


@unittest.skipUnless(allocated, "needs the address sanitizer")
class Leaks(unittest.TestCase):
    def growth(self, call):
        """Bytes a call."""
        gc.collect()
        before = allocated()
        for _ in range(TIMES):
            call()
        gc.collect()
        return (allocated() - before) / TIMES

    def test_calls(self):
        needle = pgdr.Plc([[0, 0], [4, 0], [4, 0.5], [0, 0.5], [0.02, 0.01]], SQUARE_SEGMENTS)
        cross = pgdr.Plc([[0, 0], [2, 2], [0, 2], [2, 0]], segments=[[0, 1], [2, 3]])
        plc, flat = cube(), square()
        mesh, sheet = pgdr.mesh(plc, size=0.3, threads=1), pgdr.mesh(flat, size=0.02, threads=1)
        field = pgdr.sizes_at_points(CUBE_POINTS, np.full(8, 0.3), 0.5)
        with tempfile.TemporaryDirectory() as folder:
            calls = {
                "Plc": lambda: (cube(regions=[[.5, .5, .5, 1]], point_markers=range(8)).points, cube().facets, square().segments),
                "mesh": lambda: pgdr.mesh(plc, size=0.3, threads=1),
                "mesh 2D": lambda: pgdr.mesh(flat, size=0.02, threads=1).points,
                "size function": lambda: pgdr.mesh(plc, size=lambda at: np.full(len(at), 0.3), threads=1),
                "selector": lambda: pgdr.mesh(needle, selector=lambda e: e.disk_center, threads=1),
                "progress": lambda: pgdr.mesh(plc, size=0.2, threads=1, progress=lambda p: None),
                "raises": lambda: refused(lambda: pgdr.mesh(plc, size=lambda at: 1 / 0, threads=1)),
                "raises, selector": lambda: refused(lambda: pgdr.mesh(needle, selector=lambda e: 1 / 0, threads=1)),
                "raises, progress": lambda: refused(lambda: pgdr.mesh(plc, size=0.2, progress=lambda p: 1 / 0, threads=1)),
                "returns nonsense": lambda: refused(lambda: pgdr.mesh(plc, size=lambda at: "a", threads=1)),
                "diagnosed": lambda: refused(lambda: pgdr.mesh(cross)),
                "wrong index": lambda: refused(lambda: pgdr.Plc(CUBE_POINTS, facets=[[0, 1, 9]])),
                "wrong type": lambda: refused(lambda: pgdr.Plc("abc")),
                "views": lambda: (mesh.points, mesh.cells[1:], mesh.subfacets, mesh.markers, mesh.neighbors(), mesh.edges(), mesh.reasons),
                "quality": lambda: (mesh.quality(), mesh.statistics, mesh.repairs, pgdr.info(mesh), pgdr.info(plc), repr(mesh)),
                "picture": lambda: (mesh._repr_html_(), sheet._repr_html_()),
                "check": lambda: (mesh.check(plc), sheet.check(flat), pgdr.check(mesh, plc, size=0.01)),
                "check with a function": lambda: mesh.check(plc, size=lambda at: np.full(len(at), 0.3)),
                "diagnose": lambda: (pgdr.diagnose(cross), pgdr.resolve_crossings(cross), pgdr.with_convex_hull(cross)),
                "fields": lambda: (pgdr.smallest(field, 0.2, lambda at: at[:, 0] + 1)(CUBE_POINTS),
                                   pgdr.sizes_on_mesh(mesh, pgdr.limit_growth(mesh, np.ones(len(mesh.points)), 0.1))(CUBE_POINTS)),
                "pickle": lambda: (pickle.loads(pickle.dumps(mesh)), pickle.loads(pickle.dumps(plc))),
                "files": lambda: write_and_read(mesh, folder),
                "from arrays": lambda: pgdr.Mesh.from_arrays(mesh.points, mesh.cells),
                "triangulate": lambda: pgdr.triangulate({"vertices": SQUARE_POINTS, "segments": SQUARE_SEGMENTS}, "pqa0.05en"),
                "tetrahedralize": lambda: pgdr.tetrahedralize(CUBE_POINTS, CUBE_FACETS, minratio=2, threads=1),
                "stopped": stopped_by_another_thread,
            }
            for name, call in calls.items():
                with self.subTest(name):
                    growth = [self.growth(call) for _ in range(2)]
                    while min(growth[1:]) > NOISE and len(growth) < 6:  # a leak grows every time
                        growth.append(self.growth(call))
                    self.assertLess(min(growth[1:]), NOISE, growth)

    def test_a_leak_would_be_seen(self):
        kept = []
        for _ in range(3):
            self.assertGreater(self.growth(lambda: kept.append(pgdr.mesh(square(), size=0.02, threads=1))), NOISE)


if __name__ == "__main__":
    unittest.main()
