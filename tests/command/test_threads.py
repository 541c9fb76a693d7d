#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Threads, schedule and trace of the pgdr command from outside. Usage: test_threads.py [Class[.test]...]"""
import json
import math
import re
import unittest

from test_command import BRACKET, PLATE, SANITIZE, WEDGE, Case

# Numbers that cannot be 1 by accident: cosine and sine of a generic angle, and a shift.
COSINE, SINE, SHIFT = math.cos(0.7), math.sin(0.7), (3.1, -2.7, 0.9)


def turned(x, y, z):
    """A generic rotation (about z, then about x), and a shift."""
    x, y = COSINE * x - SINE * y, SINE * x + COSINE * y
    y, z = COSINE * y - SINE * z, SINE * y + COSINE * z
    return tuple(c + s for c, s in zip((x, y, z), SHIFT))


def box_stl(width, depth, height):
    """A box as an ASCII .stl, turned, so that no point of its facets is exact."""
    corner = [turned(x * width, y * depth, z * height) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    text = "solid box\n"
    for a, b, c, d in quads:
        for triangle in ((a, b, c), (a, c, d)):
            text += "facet normal 0 0 0\nouter loop\n"
            text += "".join("vertex %r %r %r\n" % corner[v] for v in triangle) + "endloop\nendfacet\n"
    return text + "endsolid box\n"


def off_of_stl(text):
    """The same triangles."""
    corners = [line.split()[1:] for line in text.splitlines() if line.startswith("vertex")]
    points = sorted(set(map(tuple, corners)))
    faces = [[points.index(tuple(c)) for c in corners[i:i + 3]] for i in range(0, len(corners), 3)]
    return "OFF\n%d %d 0\n" % (len(points), len(faces)) + "".join("%s %s %s\n" % p for p in points) + "".join(
        "3 %d %d %d\n" % tuple(f) for f in faces)


def tetrahedron_poly():
    """Four facets that meet at about 70 degrees: too small an angle for the theory, and turned."""
    points = [turned(*p) for p in ((0, 0, 0), (4, 0.1, 0), (1.9, 3.3, 0.2), (2.1, 1.2, 3))]
    text = "4 3 0 0\n" + "".join("%d %r %r %r\n" % (i, *p) for i, p in enumerate(points)) + "4 0\n"
    return text + "".join("1 0\n3 %d %d %d\n" % f for f in ((0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3))) + "0\n0\n"


class AnyThreads(Case):
    """Eight threads run on any machine: the command tells TBB that they may."""

    def made(self, *arguments, threads, expect=0):
        """The bytes of the mesh, and its report."""
        self.mesh(*arguments, "--threads", threads, "--report", self.report, expect=expect)
        return self.output.read_bytes(), self.json()

    def assert_same_for_all(self, *arguments, expect=0):
        mesh, first = self.made(*arguments, threads=1, expect=expect)
        self.assertEqual(first["threads"], {"requested": 1, "ran": 1})
        self.assertEqual(first["scheduler"]["max_concurrent"], 1)
        for threads in (8,) if SANITIZE else (2, 8):
            again, r = self.made(*arguments, threads=threads, expect=expect)
            self.assertTrue(again == mesh, f"{arguments}: {threads} threads make another mesh")
            self.assertEqual(r["threads"]["requested"], threads)
            self.assertTrue(1 <= r["threads"]["ran"] <= threads)
            for key in ("vertices", "cells", "quality", "bounds", "insertions", "warnings", "repairs"):
                self.assertEqual(r[key], first[key], key)
            for key in ("leaves", "generations", "visits", "set_aside"):
                self.assertEqual(r["scheduler"][key], first["scheduler"][key], key)
        return first


class Threads(AnyThreads):
    def test_same_mesh(self):
        box = self.file("box.stl", box_stl(2, 1, 0.5))
        tetrahedron = self.file("tetrahedron.poly", tetrahedron_poly())
        wedge = self.file("wedge.poly", WEDGE)
        many = 0
        for arguments, expect in (((BRACKET, "--size", "0.12"), 0), ((BRACKET, "--size", "0.1+0.1*z"), 0),
                                  ((PLATE, "--size", "0.0005"), 0), ((PLATE, "--size", "0.0001+0.0002*x^2"), 0),
                                  ((box, "--size", "0.06"), None), ((tetrahedron, "--size", "0.08"), None),
                                  ((wedge, "--min-angle", "20", "--size", "0.0002"), 1)):
            with self.subTest(arguments):
                many += self.assert_same_for_all(*arguments, expect=expect)["scheduler"]["leaves"] > 20
        self.assertGreater(many, 5)

    def test_same_partial_mesh(self):
        for model, size in ((BRACKET, "0.05"), (PLATE, "0.0002")):
            r = self.assert_same_for_all(model, "--size", size, "--max-vertices", "5000", expect=5)
            self.assertTrue(r["reproducible"])
            self.assertLessEqual(r["vertices"], 5000)

    def test_eight_threads_run(self):
        # Which threads get a visit is up to the system; on a busy machine one may come too late.
        for _ in range(10):
            done = self.mesh(BRACKET, "--size", "0.07", "--threads", "8", "--report", self.report)
            self.assertEqual(done.stderr, "")
            r = self.json()
            if r["threads"]["ran"] == 8:
                break
        self.assertEqual(r["threads"], {"requested": 8, "ran": 8})
        self.assertRegex(done.stdout, r"threads +8 threads, [\d ]+ visits of [\d ]+ leaves in [\d ]+ generations")
        s = r["scheduler"]
        self.assertEqual(len(s["busy_seconds"]), 8)
        self.assertTrue(all(busy > 0 for busy in s["busy_seconds"]))
        self.assertTrue(2 <= s["max_concurrent"] <= 8)

    def test_scheduler_in_the_report(self):
        for model, size in ((BRACKET, "0.1"), (PLATE, "0.0005")):
            _, r = self.made(model, "--size", size, threads=2)
            s, seconds = r["scheduler"], r["seconds"]
            self.assertEqual(set(s), {"leaves", "generations", "cycles", "visits", "set_aside", "serial_seconds", "work_seconds",
                                      "critical_path_seconds", "max_concurrent", "busy_seconds"})
            self.assertGreater(s["leaves"], 8)
            self.assertGreater(s["generations"], 1)
            self.assertGreater(s["visits"], s["generations"])
            self.assertGreaterEqual(s["set_aside"], 0)
            self.assertEqual(len(s["busy_seconds"]), r["threads"]["ran"])
            self.assertLess(sum(s["busy_seconds"]) + s["serial_seconds"], s["work_seconds"] + 1e-6)
            self.assertTrue(0 < s["serial_seconds"] < s["critical_path_seconds"] <= s["work_seconds"] + 1e-9)
            self.assertLessEqual(s["serial_seconds"], seconds["mesh"])
            stages = r["stages"]
            self.assertEqual([t["name"] for t in stages][:5], ["prepare", "diagnose", "triangulate", "recover", "carve"])
            self.assertEqual([t["name"] for t in stages][-2:], ["count", "number"])
            for t in stages:
                self.assertTrue(0 <= t["path"] <= t["work"] + 1e-9, t)
            for part, whole in (("seconds", seconds["mesh"]), ("work", s["work_seconds"]), ("path", s["critical_path_seconds"])):
                self.assertLessEqual(sum(t[part] for t in stages), whole + 1e-6)
            self.assertEqual(r["quality"]["not_delaunay"], {"rounding": 0, "refused": 0} if r["delaunay"] else None)

    def test_not_delaunay_is_what_the_checker_counts(self):
        for name, content in (("box.stl", box_stl(2, 1, 0.5)), ("tetrahedron.poly", tetrahedron_poly())):
            path = self.file(name, content)
            self.mesh(path, "--size", "0.1", "--no-optimize", "--report", self.report, expect=None)
            made = self.json()["quality"]["not_delaunay"]
            self.pgdr("check", self.output, "--input", path, "--radius-edge", "2", "--reasons", self.report,
                      "--report", self.folder / "check.json", expect=None)
            checked = json.loads((self.folder / "check.json").read_text())
            beyond = sum(f["kind"] == "not_delaunay" for f in checked["findings"])
            checked = checked["quality"]["not_delaunay"]
            self.assertEqual(sum(made.values()), sum(checked.values()) + beyond, name)

    def test_the_checker_takes_the_tolerance_from_the_report(self):
        exact = box_stl(2, 1, 0.5)
        digits = "".join("vertex %.5f %.5f %.5f\n" % tuple(float(x) for x in line.split()[1:]) if line.startswith("vertex")
                         else line + "\n" for line in exact.splitlines())
        box = self.file("box.off", off_of_stl(digits))
        self.mesh(box, "--tolerance", "2e-5", "--size", "0.2", "--report", self.report, expect=0)
        self.assertEqual(self.json()["tolerance"], 2e-5)
        self.pgdr("check", self.output, "--input", box, "--reasons", self.report, expect=0)
        self.pgdr("check", self.output, "--input", box, "--tolerance", "2e-5", expect=0)
        self.pgdr("check", self.output, "--input", box, expect=6)  # the diagonals of the faces are segments then
        self.mesh(box, "--tolerance", "auto", expect=2)
        self.mesh(box, "--tolerance", "-1", expect=2)
        self.assertIn("--yes-coarse", self.mesh(box, "--tolerance", "0.02", expect=2).stderr)

        # The numbers of .stl are floats, which needs no word.
        as_stl = self.file("box.stl", exact)
        self.mesh(as_stl, "--size", "0.2", "--report", self.report, expect=0)
        self.assertEqual(self.json()["tolerance"], 2.0 ** -20)  # 2 ulps of a float from 4 to 8
        self.pgdr("check", self.output, "--input", as_stl, expect=0)
        self.pgdr("info", as_stl, "--report", self.report, expect=0)
        self.assertEqual((self.json()["diagnosis"]["maximal_facets"], self.json()["tolerance"]), (6, 2.0 ** -20))

    def test_points_written_with_different_digits(self):
        """In a file of floats they are one; in others with a tolerance, by the checker too."""
        count = 0
        lines = []
        for line in box_stl(2, 1, 0.5).splitlines():
            if line.startswith("vertex"):
                x, y, z = (float(x) for x in line.split()[1:])
                count += 1
                line = "vertex %r %r %r" % (x + 1e-11 * (count % 3 - 1), y, z + 1e-11 * (count % 5 - 2))
            lines.append(line)
        box = self.file("box.stl", "\n".join(lines) + "\n")
        self.mesh(box, "--report", self.report, expect=None)
        self.assertIn("near_points", [repair["code"] for repair in self.json()["repairs"]])
        self.mesh(box, "--tolerance", "0", "--report", self.report, expect=3)
        self.assertGreater(self.json()["diagnosis"]["near_points"]["count"], 8)
        self.mesh(box, "--tolerance", "1e-9", "--size", "0.2", "--report", self.report, expect=0)
        self.assertLess(self.json()["largest_move"], 2e-10)
        self.pgdr("check", self.output, "--input", box, "--reasons", self.report, expect=0)
        self.pgdr("check", self.output, "--input", box, "--tolerance", "1e-9", expect=0)
        self.pgdr("info", box, "--tolerance", "1e-9", expect=0)

    def test_a_tower_on_its_plate_turned(self):
        points = [(x, y, z) for z in (0, 2) for y in (0, 8) for x in (0, 10)]
        points += [(x, y, z) for z in (2, 6) for y in (2, 5) for x in (3, 5)]
        sides = [(0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5), (4, 5, 7, 6)]
        facets = [(0, 1, 3, 2)] + sides + [tuple(8 + v for v in side) for side in sides]
        for k in range(1, 6):
            a, b = 0.3 * k, 0.17 * k
            there = [(x * math.cos(a) - y * math.sin(a), x * math.sin(a) + y * math.cos(a), z) for x, y, z in points]
            there = [(x, y * math.cos(b) - z * math.sin(b), y * math.sin(b) + z * math.cos(b)) for x, y, z in there]
            tower = self.file("tower.poly", "16 3 0 0\n" + "".join("%d %r %r %r\n" % (i, *p) for i, p in enumerate(there)) +
                              "11 1\n" + "".join("1 0 %d\n4 %d %d %d %d\n" % (f, *p) for f, p in enumerate(facets)) + "0\n0\n")
            self.mesh(tower, "--report", self.report, expect=0)
            self.assertIn("point_on_facet", [repair["code"] for repair in self.json()["repairs"]])
            self.pgdr("check", self.output, "--input", tower, "--radius-edge", "2", expect=0)

        # A wall that ends an ulp above the plate stands on it.
        gap = self.file("gap.poly", "12 3 0 0\n" + "".join("%d %d %d %d\n" % (i, *p) for i, p in enumerate(points[:8])) +
                        "8 2 2 1.9999999999999996\n9 5 2 1.9999999999999996\n10 5 2 1\n11 2 2 1\n" + "7 1\n" +
                        "".join("1 0 1\n4 %d %d %d %d\n" % p for p in facets[:6] + [(8, 9, 10, 11)]) + "0\n0\n")
        self.mesh(gap, "--report", self.report, expect=0)
        self.assertIn("point_on_facet", [repair["code"] for repair in self.json()["repairs"]])

    def test_granularity(self):
        whole, _ = self.made(BRACKET, "--size", "0.12", threads=2)
        for g in ("3", "1"):
            self.assert_same_for_all(BRACKET, "--size", "0.12", "--granularity", g)
            self.pgdr("check", self.output, "--input", BRACKET, "--radius-edge", "2", "--size", "0.12", expect=0)
        self.assertTrue(self.output.read_bytes() != whole, "a granularity of 1 makes no other mesh")
        self.made(BRACKET, "--size", "0.12", "--granularity", 2 ** 31 - 1, threads=2)
        self.assertTrue(self.output.read_bytes() == whole, "an unlimited granularity makes another mesh")

    def test_wrong_usage(self):
        for flag, values in {"--threads": "0 -1 1.5 x 1025 4294967297", "--granularity": "0 -1 1.5 x 4294967297",
                             "--schedule": "greedily Reproducible 0"}.items():
            for value in values.split():
                done = self.mesh(BRACKET, flag + "=" + value, expect=2)
                self.assertIn(flag, done.stderr)
                self.assert_only()


class Uniform(AnyThreads):
    """--schedule uniform, and --lattice."""

    def test_same_mesh(self):
        for model, size in ((BRACKET, "0.1"), (PLATE, "0.0005")):
            arguments = (model, "--size", size, "--schedule", "uniform")
            r = self.assert_same_for_all(*arguments)
            self.assertEqual((r["schedule"], r["reproducible"]), ("uniform", True))
            s = r["scheduler"]
            self.assertTrue(1 <= s["cycles"] <= 3, s)
            self.assertGreaterEqual(s["leaves"], 8)
            self.pgdr("check", self.output, "--input", model, "--reasons", self.report, expect=0)
            by_default = self.output.read_bytes()
            for lattice, leaves in ((1, 1), (2, 8 if model == BRACKET else 4)):
                r = self.assert_same_for_all(*arguments, "--lattice", lattice)
                self.assertEqual(r["scheduler"]["leaves"], leaves)
                self.assertTrue(self.output.read_bytes() != by_default, "another lattice makes no other mesh")
            self.mesh(model, "--size", size, "--report", self.report)
            self.assertEqual(self.json()["scheduler"]["cycles"], 0)

    def test_same_partial_mesh(self):
        r = self.assert_same_for_all(PLATE, "--size", "0.0002", "--schedule", "uniform", "--max-vertices", "5000", expect=5)
        self.assertEqual((r["stop"], r["reproducible"]), ("max_vertices", True))
        self.assertLessEqual(r["vertices"], 5000)

    def test_poor_left(self):
        wedge = self.file("wedge.poly", WEDGE)
        r = self.assert_same_for_all(wedge, "--min-angle", "20", "--size", "0.0002", "--schedule", "uniform", expect=1)
        self.assertGreater(r["bounds"]["poor_left"], 0)

    def test_wrong_usage(self):
        uniform = ("--schedule", "uniform")
        for arguments in ((BRACKET, *uniform, "--lattice", "0"), (BRACKET, *uniform, "--lattice", "x"),
                          (BRACKET, *uniform, "--lattice", "8"), (PLATE, *uniform, "--lattice", "11"),
                          (BRACKET, "--lattice", "3"), (BRACKET, "--schedule", "greedy", "--lattice", "3"),
                          (BRACKET, *uniform, "--claims", "leaves")):
            with self.subTest(arguments):
                done = self.mesh(*arguments, expect=2)
                self.assertRegex(done.stderr, "lattice|claims")
                self.assert_only()


class Trace(Case):
    def setUp(self):
        super().setUp()
        self.trace = self.folder / "trace.json"

    def traced(self, *arguments, expect=0):
        self.mesh(*arguments, "--trace", self.trace, "--report", self.report, expect=expect)
        self.assert_only("out.vtu", "report.json", "trace.json")
        events = json.loads(self.trace.read_text())["traceEvents"]
        names = {e["tid"]: e["args"]["name"] for e in events if e["ph"] == "M" and e["name"] == "thread_name"}
        rows = {name: [] for name in names.values()}
        for e in events:
            if e["ph"] == "X":
                rows[names[e["tid"]]].append(e)
        return rows, self.json()

    def assert_in_sequence(self, slices):
        """In nanoseconds, which they are rounded to."""
        end = 0
        for s in sorted(slices, key=lambda s: (s["ts"], s["dur"])):
            self.assertGreaterEqual(round(s["ts"] * 1000), end)
            self.assertGreaterEqual(s["dur"], 0)
            end = round(s["ts"] * 1000) + round(s["dur"] * 1000)

    def test_slices(self):
        for model, size in ((BRACKET, "0.1"), (PLATE, "0.0005")):
            rows, r = self.traced(model, "--size", size, "--threads", "3")
            for slices in rows.values():
                self.assert_in_sequence(slices)
            phases = {s["name"]: s for s in rows.pop("phases")}
            self.assertEqual(list(phases), ["read", "initial", "refine", "optimize", "compact", "write"])
            for name in ("read", "initial", "refine", "optimize", "write"):
                self.assertAlmostEqual(phases[name]["dur"] / 1e6, r["seconds"][name], 6)
            stages = [(s["name"], s["dur"] / 1e6) for s in rows.pop("stages")]
            self.assertEqual([name for name, _ in stages], [s["name"] for s in r["stages"]])
            for (_, traced), s in zip(stages, r["stages"]):
                self.assertAlmostEqual(traced, s["seconds"], 6)
            self.assertEqual(len(rows), r["threads"]["ran"])
            for n, busy in enumerate(r["scheduler"]["busy_seconds"]):
                self.assertAlmostEqual(sum(s["dur"] for s in rows[f"thread {n}"]) / 1e6, busy, 3)
            visits = sum(rows.values(), [])
            self.assertEqual(len(visits), r["scheduler"]["visits"])
            refine, optimize = phases["refine"], phases["optimize"]
            for s in visits:
                self.assertRegex(s["name"], r"^(leaf \d+ L\d+|whole tree)$")
                self.assertEqual(set(s["args"]), {"generation", "order", "committed", "set_aside"})
                self.assertGreaterEqual(s["ts"], refine["ts"] - 1e4)  # microseconds
                self.assertLessEqual(s["ts"] + s["dur"], optimize["ts"] + optimize["dur"] + 1e4)
            self.assertEqual(max(s["args"]["generation"] for s in visits), r["scheduler"]["generations"])
            inserted = r["insertions"]["committed"] + r.get("optimization", {"inserted": 0})["inserted"]
            self.assertEqual(sum(s["args"]["committed"] for s in visits), inserted)
            # The report leaves out what is dead when the generation ends.
            self.assertGreaterEqual(sum(s["args"]["set_aside"] for s in visits), r["scheduler"]["set_aside"])

    def test_the_mesh_is_the_same(self):
        self.mesh(BRACKET, "--size", "0.2")
        mesh = self.output.read_bytes()
        self.traced(BRACKET, "--size", "0.2")
        self.assertEqual(self.output.read_bytes(), mesh)

    def test_of_a_run_that_was_stopped(self):
        rows, r = self.traced(BRACKET, "--size", "0.01", "--time-limit", "0.3", expect=5)
        self.assertFalse(r["reproducible"])
        self.assertGreater(len(rows["thread 0"]), 0)

    def test_that_cannot_be_written(self):
        for place in (self.folder / "absent" / "trace.json", self.folder):  # known before any work
            self.mesh(PLATE, "--trace", place, expect=4)
            self.assert_only()
        done = self.mesh(PLATE, "--trace", "/proc/trace.json", expect=4)
        self.assertIn("/proc/trace.json", done.stderr)

    def test_that_would_replace_another_file(self):
        path = self.file("plate.poly", PLATE.read_bytes())
        for other in (path, self.folder / "." / "plate.poly", self.output, self.report):
            self.mesh(path, "--report", self.report, "--trace", other, expect=2)
            self.assert_only("plate.poly", *(["report.json"] if self.report.exists() else []))
            self.assertEqual(path.read_bytes(), PLATE.read_bytes())


if __name__ == "__main__":
    unittest.main(verbosity=2)
