#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The pgdr command from outside: exit codes, files, report keys. Python's standard library alone.

PGDR_COMMAND names the command, PGDR_SANITIZE its sanitizers, if any. Usage: test_command.py [Class[.test]...]
"""
import json
import os
import pathlib
import pty
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest

from bad_inputs import BAD_INPUTS

COMMAND = os.environ.get("PGDR_COMMAND", "build/release/pgdr")
SANITIZE = os.environ.get("PGDR_SANITIZE", "")
MODELS = pathlib.Path(__file__).resolve().parent.parent / "models"
BRACKET, PLATE = MODELS / "bracket.poly", MODELS / "plate.poly"

# A triangle with a corner of 10 degrees: its bounds cannot be met.
WEDGE = "3 2 0 0\n1 0 0\n2 5 0\n3 5 0.88\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n"


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="pgdr_")))
        self.output = self.folder / "out.vtu"
        self.report = self.folder / "report.json"

    def enterContext(self, manager):  # unittest has it from Python 3.11 on
        value = manager.__enter__()
        self.addCleanup(manager.__exit__, None, None, None)
        return value

    def pgdr(self, *arguments, expect=None, **keywords):
        done = subprocess.run([COMMAND, *map(str, arguments)], capture_output=True, text=True, timeout=500,
                              stdin=subprocess.DEVNULL, **keywords)
        if expect is not None:
            self.assertEqual(done.returncode, expect, f"{arguments}\n{done.stdout}{done.stderr}")
        return done

    def mesh(self, *arguments, expect=0, **keywords):
        return self.pgdr("mesh", *arguments, "-o", self.output, expect=expect, **keywords)

    def file(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def json(self):
        return json.loads(self.report.read_text())

    def assert_only(self, *names):
        """Nothing else lies in the folder: no output, no temporary file."""
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), sorted(names))


class Usage(Case):
    def refused(self, *arguments, saying=""):
        done = self.pgdr(*arguments, expect=2)
        self.assertTrue(done.stderr.startswith("pgdr: error: "), done.stderr)
        self.assertIn(saying, done.stderr)
        self.assertEqual(done.stdout, "")
        self.assert_only()

    def test_help_and_version(self):
        for arguments in (["--help"], ["mesh", "--help"], ["check", "--help"], ["info", "--help"]):
            self.assertIn("Usage", self.pgdr(*arguments, expect=0).stdout)
        self.assertRegex(self.pgdr("--version", expect=0).stdout, r"^pgdr \d+\.\d+\.\d+( \([0-9a-f]+\+?\))?\n$")

    def test_command_line(self):
        self.refused()
        self.refused("frobnicate")
        self.refused("mesh")
        self.refused("mesh", BRACKET)
        self.refused("mesh", BRACKET, "-o", self.output, "--frobnicate")
        self.refused("check")
        self.refused("check", self.output, "--reasons", self.report)
        self.refused("info")

    def test_numbers(self):
        for flag, values in {"--radius-edge": "nan 0 -1 x", "--max-volume": "0 -1 nan", "--min-edge": "-1 nan inf",
                             "--max-vertices": "-1 x", "--time-limit": "-1 nan inf", "--threads": "0 -1 1.5",
                             "--delta": "-0.1 1.1 nan", "--disk": "type3", "--schedule": "random"}.items():
            for value in values.split():
                self.refused("mesh", BRACKET, "-o", self.output, flag + "=" + value, saying=flag)

    def test_flags_of_the_other_dimension(self):
        self.refused("mesh", PLATE, "-o", self.output, "--max-volume", "1", saying="--max-volume")
        self.refused("mesh", BRACKET, "-o", self.output, "--min-angle", "20", saying="--min-angle")
        self.refused("mesh", PLATE, "-o", self.output, "--min-angle", "20", "--radius-edge", "1.5")

    def test_sizes(self):
        for size in ("1+", "w", "", "x)", "0", "-1", "nan", "0/0", "1-2"):
            self.refused("mesh", BRACKET, "-o", self.output, "--size=" + size, saying="--size")
        self.refused("mesh", PLATE, "-o", self.output, "--size", "0.1+z", saying="z")
        for size in ("0,2", "x,1", "1+x,2,3"):  # several values, of which the last would count
            self.refused("mesh", BRACKET, "-o", self.output, "--size", size, saying="values")
            self.refused("mesh", BRACKET, "-o", self.output, "--region-size", "1=" + size, saying="values")
        self.mesh(PLATE, "--size", "min(1,2)")

    def test_output_is_not_the_input(self):
        self.output = self.file("both.vtu", "")
        self.mesh(self.output, expect=2)


class BadInput(Case):
    """Each is refused with the line, leaves no file, and (under the address sanitizer) leaks nothing."""

    def test_all(self):
        for name, (content, line) in BAD_INPUTS.items():
            with self.subTest(name):
                path = self.file(name, content)
                done = self.mesh(path, "--report", self.report, expect=3)
                self.assert_only(name, "report.json")
                error = self.json()["errors"][0]
                self.assertEqual(error["file"], str(path))
                self.assertNotEqual(error["message"], "")
                if line is not None:
                    self.assertEqual(error["line"], line, error)
                    self.assertIn(f"{path}:{line}: ", done.stderr)
                self.pgdr("info", path, expect=3)
                self.assert_only(name, "report.json")
                path.unlink()
                self.report.unlink()

    def test_a_billion_costs_no_memory(self):
        if SANITIZE:
            self.skipTest("sanitizers reserve address space")
        limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (1 << 28, 1 << 28))
        for name, (content, _) in BAD_INPUTS.items():
            if "billion" in name:
                self.mesh(self.file(name, content), expect=3, preexec_fn=limit)

    def test_every_prefix(self):
        """The first n bytes of a file, for any n, are refused, or accepted where what was cut off is not needed."""
        whole = PLATE.read_bytes()
        step = 97 if SANITIZE else 41
        for n in range(0, len(whole), step):
            done = self.mesh(self.file("cut.poly", whole[:n]), expect=None)
            self.assertIn(done.returncode, (0, 1, 3), f"{n} bytes\n{done.stderr}")
            self.assertEqual(self.output.exists(), done.returncode != 3)
            self.output.unlink(missing_ok=True)

    def test_unknown_formats(self):
        path = self.file("model.xyz", "0 0 0\n")
        self.mesh(path, expect=3)
        self.mesh(self.file("model", "0 0 0\n"), expect=3)
        self.output = self.folder / "out.pdf"
        self.mesh(BRACKET, expect=2)
        self.assert_only("model.xyz", "model")


class Files(Case):
    def test_input_that_cannot_be_opened(self):
        done = self.mesh(self.folder / "absent.poly", expect=4)
        self.assertIn("absent.poly", done.stderr)
        self.pgdr("info", self.folder / "absent.off", expect=4)
        self.pgdr("check", self.folder / "absent.vtu", expect=4)
        self.assert_only()

    def test_a_folder_is_no_file(self):
        (self.folder / "folder.poly").mkdir()
        (self.folder / "folder.vtu").mkdir()
        self.mesh(self.folder / "folder.poly", expect=4)
        self.output = self.folder / "folder.vtu"
        self.mesh(PLATE, expect=4)

    def test_output_that_cannot_be_written(self):
        self.output = self.folder / "absent" / "out.vtu"
        self.mesh(PLATE, expect=4)
        self.output = pathlib.Path("/proc/out.vtu")  # not even root can write there
        self.mesh(PLATE, expect=4)
        if os.getuid() != 0:
            self.folder.chmod(0o555)
            self.output = self.folder / "out.vtu"
            self.mesh(PLATE, expect=4)
            self.folder.chmod(0o755)
        self.assert_only()

    def test_report_that_cannot_be_written(self):
        done = self.mesh(PLATE, "--report", self.folder / "absent" / "report.json", expect=4)
        self.assertIn("report", done.stderr)
        self.assert_only()  # which is known before there is a mesh

    def test_disk_full(self):
        """A file size limit stands for a full disk: nothing half written stays."""
        limit = lambda: (signal.signal(signal.SIGXFSZ, signal.SIG_IGN),
                         resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096)))
        self.mesh(BRACKET, "--size", "0.5", expect=4, preexec_fn=limit)
        self.assert_only()


class Mesh(Case):
    KEYS = {"version", "input", "dimension", "vertices", "cells", "threads", "schedule", "reproducible", "selector",
            "seconds", "peak_rss_bytes", "quality", "bounds", "scheduler", "insertions", "predicates", "errors", "warnings",
            "repairs", "selector_outside", "selector_further", "selector_dropped", "delaunay", "stages"}

    def test_report(self):
        for model, dimension in ((BRACKET, 3), (PLATE, 2)):
            self.mesh(model, "--report", self.report, "--threads", "3")
            r = self.json()
            self.assertLessEqual(self.KEYS, r.keys())
            self.assertEqual(r["input"], str(model))
            self.assertEqual(r["dimension"], dimension)
            self.assertGreater(r["vertices"], 50)
            self.assertGreater(r["cells"], 50)
            self.assertEqual(r["threads"]["requested"], 3)
            self.assertTrue(1 <= r["threads"]["ran"] <= 3)
            self.assertEqual((r["schedule"], r["reproducible"]), ("reproducible", True))
            self.assertEqual(r["selector"], "circumcenter" if dimension == 3 else "off-center")
            self.assertLessEqual({"read", "mesh", "initial", "refine", "optimize", "write", "total"}, r["seconds"].keys())
            self.assertGreaterEqual(r["seconds"]["total"], r["seconds"]["mesh"])
            self.assertGreater(r["peak_rss_bytes"], 1 << 20)
            bound = 2 if dimension == 3 else 2 ** 0.5
            self.assertEqual(r["bounds"], {"radius_edge": bound, "size_met": True, "poor_left": 0, "poor_unavoidable": 0,
                                           "reasons": []})
            self.assertLessEqual(r["quality"]["max_radius_edge"], bound * (1 + 1e-9))
            angles = 6 if dimension == 3 else 3
            self.assertEqual(sum(r["quality"]["histogram"]), angles * r["cells"])
            self.assertGreater(r["insertions"]["committed"], 0)
            shares = [r["predicates"][stage] for stage in ("filter", "expansion", "exact", "perturbed")]
            self.assertAlmostEqual(sum(shares), 1, places=6)
            self.assertEqual(r["errors"], [])
            self.assert_only("out.vtu", "report.json")

    def test_summary_and_quiet(self):
        done = self.mesh(BRACKET, "--size", "0.1")
        self.assertEqual(done.stderr, "")
        for word in ("tetrahedra", "leaves", "radius-edge", "dihedral", "every bound is met", str(self.output)):
            self.assertIn(word, done.stdout)
        done = self.mesh(BRACKET, "--quiet")
        self.assertEqual(done.stdout + done.stderr, "")

    def test_same_mesh_every_time(self):
        self.mesh(BRACKET, "--size", "0.3")
        first = self.output.read_bytes()
        for flags in ([], ["--schedule", "reproducible"]):
            self.mesh(BRACKET, "--size", "0.3", *flags)
            self.assertEqual(self.output.read_bytes(), first)

    def test_formats(self):
        for extension in ("vtu", "mesh"):
            self.output = self.folder / ("out." + extension)
            for model in (BRACKET, PLATE):
                self.mesh(model)
                self.pgdr("check", self.output, "--input", model, "--radius-edge", "2", expect=0)

    def test_progress_on_a_terminal_only(self):
        master, slave = pty.openpty()
        try:
            subprocess.run([COMMAND, "mesh", BRACKET, "-o", self.output, "--size", "0.07"], stderr=slave,
                           stdout=subprocess.DEVNULL, timeout=500, check=True)
        finally:
            os.close(slave)
        shown = b""
        try:
            while chunk := os.read(master, 4096):
                shown += chunk
        except OSError:
            pass
        os.close(master)
        self.assertIn(b"vertices", shown)
        self.assertTrue(shown.endswith(b"\r\x1b[K"), shown[-40:])


class Sizes(Case):
    def cells(self, model, *flags):
        self.mesh(model, "--report", self.report, *flags)
        return self.json()["cells"]

    def test_bounds_are_made_and_checked(self):
        for model, flags in ((BRACKET, ["--size", "0.4"]), (BRACKET, ["--size", "0.2+0.1*x+0*y*z"]),
                             (BRACKET, ["--max-volume", "0.05"]), (PLATE, ["--size", "0.02"]),
                             (PLATE, ["--size", "0.01+0.01*(x-3)^2"]), (PLATE, ["--min-angle", "20"])):
            with self.subTest(flags):
                self.mesh(model, *flags)
                done = self.pgdr("check", self.output, "--input", model, *flags, expect=0)
                self.assertIn("everything holds", done.stdout)

    def test_smaller_means_more(self):
        self.assertGreater(self.cells(BRACKET, "--size", "0.25"), 2 * self.cells(BRACKET, "--size", "0.5"))
        self.assertGreater(self.cells(PLATE, "--size", "0.01"), 2 * self.cells(PLATE, "--size", "0.04"))

    def test_constant_and_expression_agree(self):
        self.mesh(BRACKET, "--size", "0.25")
        constant = self.output.read_bytes()
        self.mesh(BRACKET, "--size", "0.25+0*x")
        self.assertEqual(self.output.read_bytes(), constant)

    def test_a_size_that_is_not_positive_names_the_point(self):
        for size in ("x-2", "0/(x-x)", "sqrt(x-2)"):
            with self.subTest(size):
                self.mesh(BRACKET, "--size", size, "--report", self.report, expect=2)
                error = self.json()["errors"][0]
                self.assertEqual(error["code"], "bad_size")
                self.assertEqual(len(error["points"]), 1)
                self.assert_only("report.json")


class Stopped(Case):
    def assert_partial(self, model):
        self.assertTrue(self.output.exists())
        self.pgdr("check", self.output, "--input", model, expect=0)

    def test_max_vertices(self):
        for model, most in ((BRACKET, 400), (PLATE, 200)):
            self.mesh(model, "--size", "0.005", "--max-vertices", most, "--report", self.report, expect=5)
            self.assertLessEqual(self.json()["vertices"], most)
            self.assertTrue(self.json()["reproducible"])
            self.assertGreater(self.json()["bounds"]["poor_left"], 0)
            self.assert_partial(model)

    def test_time_limit(self):
        for model, size in ((BRACKET, "0.005"), (PLATE, "0.000001")):
            done = self.mesh(model, "--size", size, "--time-limit", "1", "--report", self.report, expect=5)
            self.assertIn("--time-limit", done.stdout)
            self.assertFalse(self.json()["reproducible"])
            self.assertIsNone(self.json()["quality"]["not_delaunay"])  # who sets a limit does not want to wait
            self.assert_partial(model)

    def test_min_edge(self):
        self.mesh(PLATE, "--size", "0.0001", "--min-edge", "0.2", expect=5)
        self.assert_partial(PLATE)

    def test_signals(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            run = subprocess.Popen([COMMAND, "mesh", BRACKET, "-o", self.output, "--size", "0.01"],
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            time.sleep(1)
            run.send_signal(number)
            said, _ = run.communicate(timeout=300)
            self.assertEqual(run.returncode, 5, said)
            self.assertIn("by a signal", said)
            self.assert_partial(BRACKET)
            self.output.unlink()


class PoorLeft(Case):
    def test_small_angle(self):
        model = self.file("wedge.poly", WEDGE)
        bound = ["--min-angle", "20"]
        done = self.mesh(model, *bound, "--report", self.report, expect=1)
        self.assertIn("small_angle", done.stdout)
        bounds = self.json()["bounds"]
        self.assertGreater(bounds["poor_left"], 0)
        self.assertEqual(len(bounds["reasons"]), bounds["poor_left"])
        for reason in bounds["reasons"]:
            self.assertEqual(set(reason), {"cell", "code", "entities", "angle"})
            self.assertEqual(reason["code"], "small_angle")
            self.assertEqual(len(reason["entities"]), 2)
            self.assertTrue(0 < reason["angle"] < 60)
        check = ["check", self.output, "--input", model, *bound]
        self.pgdr(*check, "--reasons", self.report, expect=1)
        self.pgdr(*check, expect=6)
        self.pgdr("check", self.output, "--input", model, "--reasons", self.report, expect=1)  # the report's bound
        false = self.json()
        false["bounds"]["reasons"][0]["angle"] += 1e-6
        self.assertIn("degrees, but at", self.pgdr(*check, "--reasons", self.file("false.json", json.dumps(false)), expect=6).stdout)

    def test_reasons_that_are_none(self):
        model = self.file("wedge.poly", WEDGE)
        self.mesh(model, expect=None)
        for content in ("", "{", "[]", "{}", '{"bounds": {"reasons": [1]}}',
                        '{"bounds": {"reasons": [{"cell": -1, "code": "small_angle", "entities": [], "angle": 1}]}}'):
            reasons = self.file("reasons.json", content)
            self.pgdr("check", self.output, "--input", model, "--reasons", reasons, expect=3)
        self.pgdr("check", self.output, "--input", model, "--reasons", self.folder / "absent", expect=4)


class Check(Case):
    def test_over_a_bound(self):
        self.mesh(BRACKET)
        done = self.pgdr("check", self.output, "--radius-edge", "0.7", "--delaunay", "--report", self.report, expect=6)
        self.assertIn("FAILED", done.stdout)
        r = self.json()
        self.assertEqual(r["verdict"], 6)
        self.assertGreater(r["bounds"]["over_radius_edge"], 0)
        self.assertIn("over_radius_edge", {finding["kind"] for finding in r["findings"]})
        self.assertLessEqual({"rounding", "refused"}, r["quality"]["not_delaunay"].keys())

    def test_a_mesh_of_something_else(self):
        self.mesh(PLATE)
        other = self.file("other.poly", PLATE.read_text().replace("\n3 6 2\n", "\n3 6 2.5\n", 1))
        self.pgdr("check", self.output, "--input", other, expect=6)
        self.pgdr("check", self.output, "--input", BRACKET, expect=2)

    def test_a_mesh_that_was_tampered_with(self):
        self.output = self.folder / "out.mesh"
        self.mesh(PLATE, "--size", "0.05")
        text = self.output.read_text()
        lines = text.split("\n")
        at = next(i for i, l in enumerate(lines) if l.strip().startswith("Vertices"))
        # the last vertex, moved far away
        number = re.search(r"Vertices\s+(\d+)\s*\n", text)
        last = text[:number.end()].count("\n") + int(number.group(1)) - 1
        self.assertGreater(last, at)
        fields = lines[last].split()
        lines[last] = " ".join([repr(float(fields[0]) + 100), *fields[1:]])
        self.output.write_text("\n".join(lines))
        self.pgdr("check", self.output, "--input", PLATE, expect=6)

    def test_files_that_are_no_meshes(self):
        for name, content in (("empty.vtu", ""), ("empty.mesh", ""), ("cut.vtu", "<?xml version=\"1.0\"?>\n<VTKFile"),
                              ("billion.mesh", "MeshVersionFormatted 2\nDimension 3\nVertices 1000000000\n"),
                              ("some.pdf", "x")):
            self.pgdr("check", self.file(name, content), expect=3)


class Info(Case):
    def test_inputs(self):
        for model, dimension in ((BRACKET, 3), (PLATE, 2)):
            done = self.pgdr("info", model, "--report", self.report, expect=0)
            self.assertIn("pgdr mesh takes it", done.stdout)
            r = self.json()
            self.assertEqual((r["kind"], r["dimension"]), ("input", dimension))
            self.assertTrue(r["diagnosis"]["accepted"])
            self.assertTrue(r["diagnosis"]["closed"])
            self.assertGreater(r["diagnosis"]["smallest_angle_deg"], 89.999)

    def test_meshes(self):
        for model in (BRACKET, PLATE):
            self.mesh(model)
            self.pgdr("info", self.output, "--report", self.report, expect=0)
            self.assertEqual(self.json()["kind"], "mesh")
            self.assertGreater(self.json()["cells"], 0)

    def test_refused(self):
        path = self.file("flat.poly", "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 1 1 0\n3 0 1 0\n1 0\n1 0\n4 0 1 2 3\n0\n0\n")
        self.pgdr("info", path, "--report", self.report, expect=3)
        self.assertFalse(self.json().get("diagnosis", {}).get("accepted", False))
        self.assertNotEqual(self.json()["errors"], [])


class Diagnosis(Case):
    """Refused before any meshing, by the facets of the file; what is only reported is reported."""

    TETRAHEDRON = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]

    def off(self, name, points, faces):
        return self.file(name, f"OFF\n{len(points)} {len(faces)} 0\n" + "".join("%r %r %r\n" % p for p in points) +
                         "".join("3 %d %d %d\n" % f for f in faces))

    def two_tetrahedra(self, x):
        points = [(0, 0, 0), (4, 0, 0), (0, 4, 0), (0, 0, 4)]
        points += [(x, 1, 1), (x + 0.25, 1, 1), (x, 1.25, 1), (x, 1, 1.25)]
        return self.off("two.off", points, self.TETRAHEDRON + [tuple(v + 4 for v in f) for f in self.TETRAHEDRON])

    def test_facets_that_cross_are_named(self):
        path = self.two_tetrahedra(-0.125)  # the second one through the wall x = 0, facet 3
        for command in (lambda: self.mesh(path, "--report", self.report, expect=3),
                        lambda: self.pgdr("info", path, "--report", self.report, expect=3)):
            done = command()
            self.assert_only("report.json", "two.off")
            r = self.json()
            self.assertEqual([e["ids"] for e in r["errors"]], [[3, 4], [3, 5], [3, 6]])
            for e in r["errors"]:
                self.assertEqual((e["code"], e["line"], len(e["points"])), ("entities_intersect", 14, 2))
                self.assertEqual([p[0] for p in e["points"]], [0, 0])
            self.assertEqual(r["diagnosis"]["facets_cross"]["count"], 3)
            self.assertIn(f"{path}:14: facets 3 and 4 intersect from (0, ", done.stderr)

    def test_what_is_open_is_told(self):
        path = self.off("open.off", [(0, 0, 0), (4, 0, 0), (0, 4, 0), (0, 0, 4)], self.TETRAHEDRON[1:])
        self.mesh(path, "--report", self.report, expect=3)
        r = self.json()
        self.assertEqual((r["errors"][0]["code"], r["errors"][0]["ids"]), ("encloses_nothing", [0, 1, 2]))
        self.assertEqual(r["diagnosis"]["open_boundaries"]["listed"][0]["ids"], [0, 1, 2])

    def test_what_is_taken(self):
        path = self.two_tetrahedra(0.125)
        self.pgdr("info", path, "--report", self.report, expect=0)
        d = self.json()["diagnosis"]
        self.assertEqual(d["facets_cross"], {"count": 0, "listed": []})
        self.assertEqual(d["facets_below_90"]["count"], 6)
        self.assertAlmostEqual(d["facets_below_90"]["listed"][0]["measure"], 54.7356, 3)


class Memory(Case):
    def test_address_space(self):
        if SANITIZE:
            self.skipTest("sanitizers reserve address space")
        limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (1 << 27, 1 << 27))
        done = self.mesh(BRACKET, "--size", "0.02", "--report", self.report, expect=7, preexec_fn=limit)
        self.assertIn("memory", done.stderr)
        self.assertEqual(self.json()["errors"][0]["code"], "out_of_memory")
        self.assert_only("report.json")


if __name__ == "__main__":
    unittest.main(verbosity=2)
