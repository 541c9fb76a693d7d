# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Runs: sizes, selectors, stopping, threads, pickles, files, and the bytes of the command."""
import contextlib
import io
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path

import numpy as np

import pgdr
from shapes import CUBE_POINTS, SQUARE_POINTS, SQUARE_SEGMENTS, checked, cube, same, square

MODELS = Path(__file__).resolve().parents[1] / "models"
COMMAND = os.environ.get("PGDR_COMMAND", "")


class Sizes(unittest.TestCase):
    def test_a_function_makes_the_mesh_of_the_field_that_it_is(self):
        field = pgdr.sizes_at_points(CUBE_POINTS[:1], [0.0625], 0.25)
        wanted = checked(self, cube(), size=field)
        self.assertTrue(same(wanted, checked(self, cube(), size=lambda at: field(at))))
        self.assertTrue(same(wanted, checked(self, cube(), size=pgdr.smallest(field, 9.0))))
        self.assertGreater(len(wanted.cells), 200)

    def test_sizes_on_a_mesh_and_gradation(self):
        coarse = checked(self, square(), size=0.01)
        values = np.full(len(coarse.points), 0.01)
        values[0] = 0.0001
        limited = pgdr.limit_growth(coarse, values, 0.2)
        self.assertTrue((limited <= values).all() and (limited < values).sum() > 1)
        fine = checked(self, square(), size=pgdr.sizes_on_mesh(coarse, limited))
        self.assertGreater(len(fine.cells), len(coarse.cells))

    def test_regions_have_sizes(self):
        plc = pgdr.Plc([[0, 0], [1, 0], [2, 0], [2, 1], [1, 1], [0, 1]], [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 0], [1, 4]],
                       regions=[(0.5, 0.5, 1), {"point": (1.5, 0.5), "attribute": 2, "max_size": 0.1}])
        made = checked(self, plc, region_sizes={1: 0.001})
        self.assertEqual(set(made.regions.tolist()), {1, 2})
        self.assertGreater((made.regions == 1).sum(), 4 * (made.regions == 2).sum())

    def test_what_a_function_raises_comes_out(self):
        class Mine(Exception):
            pass

        def fails(at):
            raise Mine("at", at.shape)

        for threads in (1, 2):
            with self.assertRaises(Mine) as caught:
                pgdr.mesh(cube(), size=fails, threads=threads)
            self.assertEqual(caught.exception.args[0], "at")

        def selects(elements):
            raise Mine("elements")

        with self.assertRaises(Mine):
            pgdr.mesh(pgdr.Plc.read(MODELS / "bracket.poly"), selector=selects)

    def test_what_a_function_returns_is_looked_at(self):
        for size, words in ((lambda at: at, "shape"), (lambda at: None, "None"), (lambda at: ["a"] * len(at), "type"),
                            (lambda at: -at[:, 0], "positive"), (lambda at: at[:, 0] * np.nan, "nan|positive"),
                            (-1, "positive"), (float("nan"), "NaN")):
            with self.subTest(words=words), self.assertRaisesRegex(pgdr.UsageError, words):
                pgdr.mesh(cube(), size=size)
        with self.assertRaises(TypeError):
            pgdr.mesh(cube(), size="0.1")


class Selectors(unittest.TestCase):
    def test_a_function_is_the_selector_that_it_computes(self):
        seen = []

        def centre(elements):
            seen.append(elements)
            return elements.circumcenter

        bracket = pgdr.Plc.read(MODELS / "bracket.poly")  # the cube has no cells but those that are too big
        made = checked(self, bracket, selector=centre, optimize=False)
        self.assertTrue(same(made, checked(self, bracket, selector="circumcenter", optimize=False)))
        e = seen[0]
        self.assertEqual(e.corners.shape[1:], (4, 3))
        radius = np.linalg.norm(e.corners - e.circumcenter[:, None], axis=2)
        np.testing.assert_allclose(radius, e.circumradius[:, None] * np.ones((1, 4)), rtol=1e-9)

    def test_blocks_make_the_mesh_of_single_elements(self):
        rng = np.random.default_rng(1)
        plc = pgdr.Plc(np.vstack([SQUARE_POINTS, 0.01 + 0.98 * rng.random((2000, 2))]), SQUARE_SEGMENTS)
        lengths = []

        def half_way(e):
            lengths.append(len(e.circumradius))
            to_corner = e.corners[:, 0] - e.disk_center
            return e.disk_center + to_corner * (0.5 * e.disk_radius / e.circumradius)[:, None]

        def one_by_one(e):
            return np.concatenate([half_way(pgdr.Elements(*(a[i:i + 1] for a in e))) for i in range(len(e.circumradius))])

        wanted = checked(self, plc, selector=half_way, threads=1)
        self.assertGreater(np.mean(lengths), 2)
        for threads in (1, 2, 8):
            self.assertTrue(same(wanted, checked(self, plc, selector=one_by_one, threads=threads)), threads)

    def test_what_it_returns_is_looked_at(self):
        bracket = pgdr.Plc.read(MODELS / "bracket.poly")
        for selector, words in ((lambda e: e.circumradius, r"selector .*shape \(\d+, 3\), .*k up to 8, not .*shape \(\d+,\)"),
                                (lambda e: e.circumcenter[:, :2], r"shape \(\d+, 3\), .* not .*\(\d+, 2\)"),
                                (lambda e: e.corners[:, :, :2], r"shape \(\d+, 4, 3\), not .*\(\d+, 4, 2\)"),
                                (lambda e: e.corners[:1].repeat(3, 1), r"not .*\(\d+, 12, 3\)"), (lambda e: None, "None")):
            with self.subTest(words=words), self.assertRaisesRegex(pgdr.UsageError, words):
                pgdr.mesh(bracket, selector=selector)
        nowhere = checked(self, bracket, selector=lambda e: e.circumcenter * np.nan)
        self.assertTrue(same(nowhere, checked(self, bracket, selector="circumcenter", optimize=False)))
        self.assertGreater(nowhere.statistics["selector_outside"], 0)

    def test_several_points(self):
        """A ring of points in each element: what goes in is the same for any number of threads, and rows of NaN are none."""
        rng = np.random.default_rng(3)
        pairs = np.concatenate([p + [[0, 0], [1e-3, 0]] for p in rng.random((40, 1, 2)) * 0.9 + 0.05])
        plc = pgdr.Plc(np.vstack([[[0, 0], [1, 0], [1, 1], [0, 1]], pairs]), segments=[[0, 1], [1, 2], [2, 3], [3, 0]])
        turns = np.linspace(0, 2 * np.pi, 5)[:4]

        def ring(e):
            points = np.full((len(e.circumradius), 6, 2), np.nan)
            points[:, 0] = e.circumcenter
            points[:, 1:5] = e.circumcenter[:, None] + 0.6 * e.circumradius[:, None, None] * np.stack([np.cos(turns), np.sin(turns)], 1)
            return points

        one, eight = (checked(self, plc, min_angle=20, selector=ring, threads=n) for n in (1, 8))
        self.assertTrue(same(one, eight))
        for name in ("selector_further", "selector_dropped"):
            self.assertGreater(one.statistics[name], 10)
            self.assertEqual(one.statistics[name], eight.statistics[name])
        plain = checked(self, plc, min_angle=20, selector="circumcenter")
        self.assertEqual(plain.statistics["selector_further"], 0)
        self.assertFalse(same(one, plain))
        alone = checked(self, plc, min_angle=20, selector=lambda e: ring(e)[:, [0, 5, 5]])
        self.assertTrue(same(alone, checked(self, plc, min_angle=20, selector=lambda e: e.circumcenter)))
        self.assertEqual(alone.statistics["selector_further"] + alone.statistics["selector_dropped"], 0)

    def test_names(self):
        for name in ("off-center", "sliver-avoiding", "random", "random:7"):
            checked(self, cube(), size=0.3, selector=name)
        with self.assertRaisesRegex(pgdr.UsageError, "circumcenter"):
            pgdr.mesh(cube(), selector="nowhere")


class Stopping(unittest.TestCase):
    def assert_partial(self, made, plc):
        self.assertEqual(made.stop, "cancelled")
        self.assertTrue(pgdr.check(made, plc))

    def test_a_source_and_an_event(self):
        for stop, set_it in ((pgdr.StopSource(), "stop"), (threading.Event(), "set")):
            timer = threading.Timer(0.3, getattr(stop, set_it))
            timer.start()
            self.assert_partial(pgdr.mesh(cube(), size=0.003, stop=stop), cube())
            timer.join()

    def test_ctrl_c_leaves_a_valid_mesh(self):
        timer = threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt) as caught:
            pgdr.mesh(cube(), size=0.003)
        timer.join()
        self.assert_partial(caught.exception.mesh, cube())

    def test_python_ends_while_daemon_threads_mesh(self):
        script = ("import threading, time, sys; sys.path[:0] = [%r]; import pgdr; from shapes import cube\n"
                  "for f in (None, lambda at: 0.003 + 0 * at[:, 0]):\n"
                  "    threading.Thread(target=lambda f=f: pgdr.mesh(cube(), size=f or 0.003), daemon=True).start()\n"
                  "time.sleep(0.3)\nprint('ends')" % str(Path(__file__).resolve().parent))
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60)
        self.assertEqual((done.returncode, done.stdout), (0, "ends\n"), done.stderr)

    def test_limits(self):
        made = pgdr.mesh(cube(), size=0.01, max_vertices=500)
        self.assertEqual(made.stop, "max_vertices")
        self.assertTrue(pgdr.check(made, cube()))
        square = [[0, 0], [1, 0], [1, 1], [0, 1]]
        fine = pgdr.Plc(square, segments=[[0, 1], [1, 2], [2, 3], [3, 0]], regions=[(0.5, 0.5, 1, 0.001)])
        stopped = pgdr.mesh(fine, max_vertices=50)
        self.assertEqual(stopped.stop, "max_vertices")
        self.assertTrue(stopped.check(fine))
        self.assertEqual(pgdr.mesh(cube(), size=0.002, time_limit=0.2).stop, "time_limit")

    def test_progress_ends_at_its_end(self):
        told = []
        made = checked(self, cube(), size=0.03, progress=told.append)
        self.assertEqual([p.finished for p in told], [False] * (len(told) - 1) + [True])
        self.assertEqual((told[-1].vertices, told[-1].waiting), (len(made.points), 0))
        self.assertEqual((told[-1].stage, told[-1].done), ("done", 1.0))
        known = [p.done for p in told if p.done is not None]
        self.assertEqual(known, sorted(known))
        self.assertTrue(all(0 <= done <= 1 for done in known))
        with contextlib.redirect_stderr(io.StringIO()) as line:
            checked(self, cube(), size=0.02, progress=True)
        self.assertTrue(line.getvalue().endswith("\n"))
        with self.assertRaises(ZeroDivisionError):
            pgdr.mesh(cube(), size=0.02, progress=lambda p: 1 / 0)


class Reproducible(unittest.TestCase):
    def test_threads_and_two_meshes_at_once(self):
        for plc, options in ((cube(), {"size": 0.08}), (cube(), {"size": 0.1, "schedule": "uniform"}), (square(), {"size": 1e-4})):
            wanted, made = checked(self, plc, threads=1, **options), {}
            workers = [threading.Thread(target=lambda t=t: made.update({t: pgdr.mesh(plc, threads=t, **options)})) for t in (1, 2, 8)]
            for w in workers:
                w.start()
            for w in workers:
                w.join()
            for t in (1, 2, 8):
                self.assertTrue(same(wanted, made[t]), (t, options))

    def test_pickles(self):
        plc = pickle.loads(pickle.dumps(cube(holes=[], markers=[1, 2, 3, 4, 5, 6])))
        made = checked(self, plc, size=0.2)
        again = pickle.loads(pickle.dumps(made))
        self.assertTrue(same(made, again))
        self.assertTrue(again.check(plc))
        self.assertEqual((again.reasons, again.stop, again.statistics["delaunay"]), (made.reasons, made.stop, False))
        graded = pickle.loads(pickle.dumps(checked(self, plc, size=lambda at: 0.2 + 0.1 * at[:, 0])))
        with self.assertRaisesRegex(pgdr.UsageError, "size"):
            graded.check(plc)
        self.assertTrue(graded.check(plc, size=lambda at: 0.2 + 0.1 * at[:, 0]))

    @unittest.skipUnless(COMMAND, "the command is not built")
    def test_the_bytes_of_the_command(self):
        for name, size in (("bracket.poly", 0.2), ("rocket.poly", None), ("plate.poly", None)):
            with self.subTest(model=name), tempfile.TemporaryDirectory() as folder:
                plc = pgdr.Plc.read(MODELS / name)
                options = {} if size is None else {"size": size}
                checked(self, plc, **options).write(f"{folder}/a.vtu")
                flags = [] if size is None else ["--size", str(size)]
                done = subprocess.run([COMMAND, "mesh", str(MODELS / name), "-o", f"{folder}/b.vtu", *flags], capture_output=True)
                self.assertIn(done.returncode, (0, 1), done.stderr)
                self.assertEqual(Path(folder, "a.vtu").read_bytes(), Path(folder, "b.vtu").read_bytes())
                done = subprocess.run([COMMAND, "check", f"{folder}/a.vtu", "--input", str(MODELS / name)], capture_output=True)
                self.assertEqual(done.returncode, 0, done.stdout)


class Files(unittest.TestCase):
    def test_formats_keep_the_mesh(self):
        for plc in (cube(markers=[1, 2, 3, 4, 5, 6]), square(markers=[1, 2, 3, 4])):
            made = checked(self, plc, size=0.1)
            with tempfile.TemporaryDirectory() as folder:
                for ending in ("vtu", "pvtu", "msh", "mesh", "node"):
                    file = Path(folder, f"m.{ending}")
                    made.write(file)
                    again = pgdr.Mesh.read(file.with_suffix(".ele") if ending == "node" else file)
                    self.assertEqual(len(again.cells), len(made.cells), ending)
                    self.assertTrue(pgdr.check(again, plc), ending)
                with self.assertRaises(pgdr.FileError):
                    made.write(Path(folder, "none", "m.vtu"))
                with self.assertRaises(pgdr.InputError):
                    made.write(Path(folder, "m.xyz"))

    def test_errors_name_file_and_line(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "bad.poly")
            file.write_text("2 2 0 0\n1 0 0\n2 x 0\n0 0\n0\n")
            with self.assertRaises(pgdr.InputError) as caught:
                pgdr.Plc.read(file)
            self.assertEqual((caught.exception.file, caught.exception.line), (str(file), 3))
            with self.assertRaises(OSError):
                pgdr.Plc.read(Path(folder, "none.poly"))


class Inputs(unittest.TestCase):
    def test_what_crosses_is_named_and_can_be_resolved(self):
        cross = pgdr.Plc([[0, 0], [2, 0], [2, 2], [0, 2], [-1, 1], [3, 1]], [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5]])
        with self.assertRaises(pgdr.InputError) as caught:
            pgdr.mesh(cross)
        self.assertEqual(caught.exception.code, "entities_intersect")
        self.assertGreaterEqual(len(caught.exception.points), 1)
        split, repairs = pgdr.resolve_crossings(cross)
        self.assertEqual([r.code for r in repairs], ["entities_intersect"])
        checked(self, split)
        self.assertIn("segments_cross", [f.kind for f in pgdr.diagnose(cross) if f.is_error])

    def test_facets_that_cross_can_be_resolved(self):
        corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
        faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
        boxes = pgdr.Plc(np.vstack([4 * corners, 2 * corners + [3, 1, 1]]), facets=faces + [[8 + v for v in f] for f in faces],
                         markers=[1] * 6 + [2] * 6)
        with self.assertRaises(pgdr.InputError) as caught:
            pgdr.mesh(boxes)
        self.assertIn("pgdr.resolve_crossings(plc)", str(caught.exception))
        cut, repairs = pgdr.resolve_crossings(boxes, markers="last")
        self.assertEqual([r.code for r in repairs], ["entities_intersect"])
        made = checked(self, cut, regions="all")
        self.assertEqual(set(made.subfacet_markers.tolist()), {1, 2})
        self.assertEqual(len(set(made.regions.tolist())), 3)
        with self.assertRaises(pgdr.UsageError):
            pgdr.resolve_crossings(boxes, markers="both")

    def test_bounds_of_another_dimension_are_refused(self):
        for plc, options in ((square(), {"min_dihedral": 10}), (square(), {"max_volume": 1}), (cube(), {"min_angle": 20}),
                             (square(), {"min_angle": 20, "radius_edge": 2}), (cube(), {"optimize": False, "min_dihedral": 10})):
            with self.subTest(options=options), self.assertRaises(pgdr.UsageError):
                pgdr.mesh(plc, **options)

    def test_a_check_that_fails(self):
        made = checked(self, cube(), size=0.3)
        self.assertFalse(pgdr.check(made, pgdr.Plc(CUBE_POINTS * 2, facets=[f for f in cube().facets])))
        self.assertFalse(pgdr.check(pgdr.Mesh.from_arrays(made.points, made.cells[:, [1, 0, 2, 3]]), cube()))
        self.assertEqual(made.check(cube(), size=0.01).exit_code, 6)

    def test_info(self):
        found = pgdr.info(MODELS / "bracket.poly")
        self.assertEqual((found["kind"], found["dimension"]), ("input", 3))
        self.assertGreater(pgdr.info(checked(self, cube(), size=0.3))["quality"]["min_angle_deg"], 14.9)


if __name__ == "__main__":
    unittest.main()
