#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs that the benchmarks make, and the scripts of their tables in small. Usage: test_bench_tables.py [Class[.test]...]"""
import collections
import json
import math
import os
import subprocess
import sys
import unittest

from scripts import BENCH, COMMAND, ScriptCase

sys.path.insert(0, str(BENCH))
import bat  # noqa: E402
import made_inputs  # noqa: E402


class MadeInputs(ScriptCase):
    def closed(self, points, triangles):
        """Every edge has two triangles, which run through it in opposite directions; a sphere; outwards. Returns the least
        angle in degrees, and the volume."""
        edges = collections.Counter((t[i], t[(i + 1) % 3]) for t in triangles for i in range(3))
        self.assertEqual(set(edges.values()), {1})
        self.assertTrue(all((b, a) in edges for a, b in edges))
        self.assertEqual(len(points) - len(edges) // 2 + len(triangles), 2)
        self.assertEqual(len(set(points)), len(points))
        cross = lambda a, b: (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
        dot = lambda a, b: sum(x * y for x, y in zip(a, b))
        volume = sum(dot(points[a], cross(points[b], points[c])) for a, b, c in triangles) / 6
        self.assertGreater(volume, 0)
        least = math.pi
        for t in triangles:
            for i in range(3):
                p, q, r = (points[t[(i + k) % 3]] for k in range(3))
                u, v = [a - b for a, b in zip(q, p)], [a - b for a, b in zip(r, p)]
                least = min(least, math.acos(dot(u, v) / math.hypot(*u) / math.hypot(*v)))
        return math.degrees(least), volume

    def accepted(self, file, volume):
        report = self.folder / "info.json"
        done = subprocess.run([COMMAND, "info", file, "--report", report, "--quiet"], capture_output=True, text=True, timeout=200)
        self.assertEqual(done.returncode, 0, done.stderr)
        found = json.loads(report.read_text())
        self.assertEqual(found["repairs"], [])
        self.assertEqual(found["diagnosis"].get("inconsistent_orientation", {"count": 0})["count"], 0)
        self.assertEqual(len(found["regions"]), 1)
        self.assertAlmostEqual(found["regions"][0]["volume_given"] / volume, 1, delta=1e-9)

    def test_bat(self):
        """Thousands of triangles, no needles; the air without the body is what is meshed."""
        points, triangles = bat.body(bat.EDGE)
        self.assertGreater(len(triangles), 5000)
        angle, volume = self.closed(points, triangles)
        self.assertGreater(angle, 25)
        low, high = ([f(p[axis] for p in points) for axis in range(3)] for f in (min, max))
        for axis in range(3):
            self.assertLess(bat.WAKE[axis][0], low[axis])
            self.assertLess(high[axis], bat.WAKE[axis][1])
            self.assertLess(bat.AIR[axis][0], bat.WAKE[axis][0])
            self.assertLess(bat.WAKE[axis][1], bat.AIR[axis][1])
        self.assertEqual((low[2], high[2]), (-bat.SPAN, bat.SPAN))
        file = self.folder / "bat.poly"
        self.assertEqual(bat.write_poly(file), len(triangles))
        self.accepted(file, math.prod(b - a for a, b in bat.AIR) - volume)

    def test_wings_are_thin(self):
        points, _ = bat.body(bat.EDGE)
        for z in (2.5, 4.0):
            near = [p for p in points if abs(p[2] - z) < bat.EDGE]  # a section or two
            self.assertGreater(len(near), 20)
            chord = max(p[0] for p in near) - min(p[0] for p in near)
            self.assertGreater(chord, 10 * bat.MEMBRANE)
            self.assertLess(bat.shape(z)[3], 1.3 * bat.MEMBRANE)

    def test_ball(self):
        points, triangles = made_inputs.ball(20)
        self.assertEqual(len(triangles), 12 * 20 * 20)
        angle, volume = self.closed(points, triangles)
        self.assertGreater(angle, 20)
        self.assertAlmostEqual(volume, 4 / 3 * math.pi, delta=0.1)
        file = self.folder / "ball.off"
        made_inputs.write_off(file, points, triangles)
        self.accepted(file, volume)


class BenchTables(ScriptCase):
    def rows(self, text):
        """The table in a text, as dictionaries."""
        lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("|")]
        return [dict(zip(lines[0], line)) for line in lines[2:]]

    def test_table_3_5(self):
        table = self.folder / "table.md"
        table.write_text("before\n<!-- begin of the table 3.5 -->\nold\n<!-- end of the table 3.5 -->\nafter\n")
        self.run_script(BENCH / "table_3_5.py", COMMAND, "--quick", "--threads", "1,2", "--repeat", "1", "--table", table)
        text = table.read_text()
        self.assertTrue(text.startswith("before\n") and text.endswith("\nafter\n") and "old" not in text, text)
        rows = self.rows(text)
        rules = {r["claims"] for r in rows}
        self.assertIn(rules, ({"-"}, {"boxes", "leaves"}))
        self.assertEqual(len(rows), 2 * 2 * 2 * len(rules))  # models, schedules, threads
        for r in rows:
            self.assertIn(r["check"], ("0", "1"))
            self.assertGreater(float(r["efficiency"].strip(" %")), 0)
            self.assertEqual(r["the text's seconds"], {"cube1": "77.2", "cube2": "47", "bat1": "235.2", "bat2": "142.1"}[r["model"] + r["threads"]])
            self.assertEqual(r["path"] != "", r["schedule"] == "reproducible")
            if r["path"]:
                self.assertGreaterEqual(float(r["work / path"]), 0.9)

    def test_table_3_5_finds_other_bytes(self):
        liar = self.script("pgdr", f'case "$*" in mesh*"--threads 2"*) exec {COMMAND} "$@" --max-volume 0.0001;; esac\nexec {COMMAND} "$@"\n')
        done = self.run_script(BENCH / "table_3_5.py", liar, "--quick", "--threads", "1,2", "--repeat", "1", "--models", "cube",
                               "--schedules", "reproducible", expect=1)
        self.assertIn("2 threads, round 1: not the bytes of the first run", done.stdout)

    def test_table_3_5_ends_in_time(self):
        done = self.run_script(BENCH / "table_3_5.py", COMMAND, "--quick", "--threads", "1", "--repeat", "100000", "--models", "cube",
                               "--minutes", "0.05")
        self.assertIn("the time is over in round", done.stderr)
        self.assertGreaterEqual(len(self.rows(done.stdout)), 1)

    def test_path_table(self):
        record = self.folder / "runs.json"
        done = self.run_script(BENCH / "path_table.py", COMMAND, "--before", COMMAND, "--quick", "--models", "cube,elephant,pipe16",
                               "--model-folder", self.folder, "--repeat", "3", "--peers", "", "--json", record)
        self.assertIn("elephant is left out", done.stderr)
        rows, runs = self.rows(done.stdout), json.loads(record.read_text())["runs"]
        self.assertEqual([r["model"] for r in rows], ["cube", "pipe16"])
        for r in rows:
            self.assertEqual((r["TetGen"], r["HXT"]), ("-", "-"))
            own = runs[r["model"]]["after"]
            self.assertEqual(len(own), 3)
            self.assertLessEqual(float(r["path"]), max(s["seconds_mesh"] for s in own) + 0.001)
            self.assertEqual({s["sha256"] for s in own}, {s["sha256"] for s in runs[r["model"]]["before"]})
            self.assertRegex(r["longest on the path"], r"^\w+ \d+ %, \w+ \d+ %, \w+ \d+ %$")

    def test_path_table_finds_what_is_wrong(self):
        count = self.folder / "count"
        liar = self.script("pgdr", f'case "$*" in mesh*--report*) echo >>{count}; [ $(wc -l <{count}) = 2 ] && '
                                   f'exec {COMMAND} "$@" --max-volume 0.0001;; esac\nexec {COMMAND} "$@"\n')
        done = self.run_script(BENCH / "path_table.py", liar, "--quick", "--models", "cube", "--repeat", "2", "--peers", "", expect=1)
        self.assertIn("WRONG: cube, after, round 2: not the bytes of the first round", done.stdout)

    def test_bundle(self):
        """It runs without this tree, and finds the models that came along."""
        folder, model = self.folder / "bundle", self.folder / "elephant.off"
        made_inputs.write_off(model, *made_inputs.ball(4))
        self.run_script(BENCH / "bundle.py", COMMAND, folder, model)
        self.run_script(BENCH / "bundle.py", COMMAND, folder, model)  # over the old one
        done = subprocess.run([folder / "run", "--quick", "--models", "cube,elephant", "--threads", "1", "--repeat", "1"],
                              capture_output=True, text=True, timeout=200, env={"PATH": os.environ["PATH"]}, cwd="/")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual({r["model"] for r in self.rows(done.stdout)}, {"cube", "elephant"})
        (self.folder / "other").mkdir()
        (self.folder / "other" / "file").touch()
        self.assertIn("has other files", self.run_script(BENCH / "bundle.py", COMMAND, self.folder / "other", expect=2).stderr)
        self.assertIn("no /nowhere", self.run_script(BENCH / "bundle.py", "/nowhere", folder, expect=2).stderr)

    def test_usage(self):
        for script, flags in (("table_3_5.py", ["--models", "sphere"]), ("table_3_5.py", ["--repeat", "0"]),
                              ("path_table.py", ["--models", "sphere"]), ("path_table.py", ["--before", "/nowhere"])):
            self.assertIn(script + ": ", self.run_script(BENCH / script, COMMAND, *flags, expect=2).stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
