#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""bench/suite.py in small: what it writes, and that it finds what is wrong. Usage: test_bench_suite.py [Class[.test]...]"""
import csv
import json
import os
import shutil
import subprocess
import sys
import time
import unittest
import xml.etree.ElementTree as ElementTree

from scripts import BENCH, COMMAND, ScriptCase

DIAGNOSIS = os.environ.get("PGDR_BENCH_DIAGNOSIS", "")
SUITE = BENCH / "suite.py"
SVG = "{http://www.w3.org/2000/svg}"


class BenchSuite(ScriptCase):
    def setUp(self):
        super().setUp()
        self.out = self.folder / "out"

    def suite(self, *flags, command=COMMAND, path=None, expect=0):
        return self.run_script(SUITE, command, "--quick", "--out", self.out, *flags, path=path, expect=expect)

    def rows(self, name):
        with open(self.out / name, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_files(self):
        more = ["--bench-diagnosis", DIAGNOSIS] if DIAGNOSIS else []
        self.suite("--models", "cube,square", "--threads", "1,2", "--repeat", "2", *more)
        runs, summary = self.rows("runs.csv"), self.rows("summary.csv")
        own = [r for r in runs if r["program"] == "pgdr"]
        self.assertEqual(len(own), 2 * 2 * 2 * 2)  # models, schedules, threads, rounds
        for r in own:
            self.assertIn(r["exit"], "01")
            self.assertEqual(r["check"], r["exit"])
            self.assertGreater(float(r["bytes_per_cell"]), 10)
            self.assertGreater(int(r["cells"]), 1000)
            if r["schedule"] == "reproducible":
                self.assertGreaterEqual(float(r["work_over_path"]), 0.999)
            self.assertGreaterEqual(float(r["seconds_mesh"]), float(r["seconds_refine"]))
            self.assertLessEqual(float(r["max_radius_edge"]), 2)
        for model in ("cube", "square"):
            self.assertEqual(len({r["sha256"] for r in own if r["model"] == model and r["schedule"] == "reproducible"}), 1)
        for s in summary:
            if s["program"] == "pgdr":
                times = sorted(float(r["seconds_mesh"]) for r in own
                               if all(r[k] == s[k] for k in ("model", "schedule", "threads")))
                self.assertEqual(len(times), int(s["runs"]))
                self.assertAlmostEqual(float(s["seconds_mesh"]), sum(times) / 2)
                self.assertEqual((float(s["seconds_mesh_min"]), float(s["seconds_mesh_max"])), (times[0], times[1]))
                self.assertAlmostEqual(float(s["efficiency"]) * int(s["threads"]), float(s["speed_up"]))
        for s in summary:
            if s["program"] == "pgdr" and s["schedule"] == "reproducible":
                mine = [t for t in self.rows("stages.csv") if all(t[k] == s[k] for k in ("model", "schedule", "threads"))]
                self.assertGreater(len(mine), 3)
                for t in mine:
                    self.assertLessEqual(float(t["path"]), float(t["work"]) + 1e-9, t)
                self.assertAlmostEqual(sum(float(t["path"]) for t in mine), float(s["critical_path_seconds"]),
                                       delta=0.2 * float(s["critical_path_seconds"]) + 0.005)
        data = json.loads((self.out / "results.json").read_text())
        self.assertEqual(data["wrong"], [])
        self.assertEqual((self.out / "wrong.txt").read_text(), "")
        self.assertEqual(len(data["runs"]), len(runs))
        for key in ("date", "commit", "compiler", "build_type", "flags", "programs", "sizes"):
            self.assertTrue(data[key] or key in ("commit", "flags"), key)
        for key in ("processor", "usable_cores", "governor", "memory_bytes", "kernel", "load_before"):
            self.assertIn(key, data["machine"])
        if DIAGNOSIS:
            self.assertEqual({int(r["pairs"]) > 0 for r in self.rows("diagnosis.csv")}, {True, False})

    @unittest.skipUnless(shutil.which("gnuplot"), "gnuplot is not there")
    def test_plots(self):
        self.suite("--models", "cube", "--threads", "1,2", "--repeat", "1", "--peers", "")
        for name, words in {"time_cube": {"cube: seconds of meshing", "pgdr, greedy", "threads"},
                            "efficiency": {"cube", "threads"}, "rate": {"pgdr, greedy, 1"},
                            "path": {"pgdr, reproducible: critical path"}, "work_path": {"pgdr, reproducible, 1"},
                            "path_stages": {"insert", "others", "cube"}, "work_path_stages": {"insert", "cube"}, "bytes_per_cell": {"bytes a cell"}}.items():
            root = ElementTree.parse(self.out / (name + ".svg")).getroot()
            self.assertEqual(root.tag, SVG + "svg")
            said = {"".join(t.itertext()).strip() for t in root.iter(SVG + "text")}
            self.assertLessEqual(words, said, name)
            self.assertGreater(len(list(root.iter(SVG + "path"))), 4)

    def test_without_gnuplot(self):
        place = self.folder / "bin"
        place.mkdir()
        for program in ("git", "sh"):
            (place / program).symlink_to(shutil.which(program))
        done = self.suite("--models", "cube", "--threads", "1", "--repeat", "1", "--schedules", "reproducible", path=place)
        self.assertIn("gnuplot is not there", done.stderr)
        self.assertIn("tetgen is not installed", done.stderr)
        self.assertEqual([r["program"] for r in self.rows("summary.csv")], ["pgdr"])

    def test_bytes_that_depend_on_threads_are_found(self):
        liar = self.script("pgdr", f'case "$*" in mesh*"--threads 2"*) exec {COMMAND} "$@" --max-volume 0.0001;; esac\n'
                                   f'exec {COMMAND} "$@"\n')
        flags = ["--models", "cube", "--threads", "1,2", "--repeat", "1", "--schedules", "reproducible", "--peers", ""]
        done = self.suite(*flags, command=liar, expect=1)
        self.assertIn("not the bytes of 1 threads", done.stdout)
        self.assertIn("2 threads", (self.out / "wrong.txt").read_text())

    def test_meshes_that_break_their_bounds_are_found(self):
        liar = self.script("pgdr", f'case "$*" in mesh*) exec {COMMAND} $(echo "$*" | sed "s/--size [^ ]*/--size 0.3/");; esac\n'
                                   f'exec {COMMAND} "$@"\n')
        flags = ["--models", "cube", "--threads", "1", "--repeat", "1", "--schedules", "reproducible", "--peers", ""]
        done = self.suite(*flags, command=liar, expect=1)
        self.assertIn("exit code 0, of the check 6", done.stdout)

    def test_peers_may_fail(self):
        self.script("tetgen", "echo it breaks; exit 3\n")
        self.script("gmsh", "case $1 in --version) echo 1; exit;; esac\nexec sleep 100\n")
        self.suite("--models", "cube", "--threads", "1", "--repeat", "1", "--schedules", "reproducible", "--limit", "15",
                   path=f"{self.folder}:{os.environ['PATH']}")
        remarks = {r["program"]: r["remark"] for r in self.rows("runs.csv")}
        self.assertEqual(remarks, {"pgdr": "", "TetGen": "no mesh: it breaks", "gmsh HXT": "out of time"})

    def test_interrupted(self):
        """What ran is summed up."""
        number = self.folder / "pid"
        slow = self.script("pgdr", f'case "$*" in mesh*greedy*) echo $$ >{number}; exec sleep 100;; esac\nexec {COMMAND} "$@"\n')
        command = [sys.executable, "-B", SUITE, slow, "--quick", "--out", self.out, "--models", "cube", "--threads", "1",
                   "--peers", ""]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            self.assertIn("round 1, 1/2", process.stdout.readline())
            while not number.exists() or not number.read_text().strip():
                time.sleep(0.01)
            process.terminate()  # this one alone: it has to end the others
            said, errors = process.communicate(timeout=100)
        self.assertEqual(process.returncode, 1, said + errors)
        self.assertEqual([s["schedule"] for s in self.rows("summary.csv")], ["reproducible"])
        self.assertEqual((self.out / "wrong.txt").read_text(), "ended by Ctrl-C\n")
        with self.assertRaises(ProcessLookupError):
            os.kill(int(number.read_text()), 0)

    def test_usage(self):
        for flags in (["--models", "sphere"], ["--threads", "0"], ["--repeat", "0"], ["--schedules", "fast"], ["--peers", "x"]):
            self.assertIn("suite.py: ", self.suite(*flags, expect=2).stderr)
        self.assertIn("none of these", self.suite("--models", "elephant", "--model-folder", self.folder, expect=2).stderr)
        self.assertIn("build it first", self.suite(command="/nowhere/pgdr", expect=2).stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
