#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The tables of runs on ranks, in small. PGDR_MPI_COMMAND and PGDR_MPIEXEC name the command of several processes and the launcher.
Usage: test_bench_ranks.py [Class[.test]...]"""
import json
import os
import sys
import unittest

from scripts import BENCH, COMMAND, ScriptCase

MPI_COMMAND = os.environ.get("PGDR_MPI_COMMAND", "build/openmpi/pgdr-mpi")
LAUNCHER = os.environ.get("PGDR_MPIEXEC", "mpirun.openmpi")

sys.path.insert(0, str(BENCH))
import ranks_model  # noqa: E402


class RanksModel(ScriptCase):
    def test_what_is_held(self):
        """Two halves of four squares: each holds a layer, half a square wide, of the other."""
        self.assertEqual(ranks_model.held_beside_own(2, 4, 1), 0)
        self.assertEqual(ranks_model.held_beside_own(2, 4, 2), 2 * 8 / 64)
        self.assertEqual(ranks_model.held_beside_own(3, 2, 2), 2 * 16 / 64)

    def test_efficiency(self):
        for dimension in (2, 3):
            self.assertEqual(ranks_model.efficiency(dimension, 1e6, 1, 0), 1)
            self.assertEqual(ranks_model.efficiency(dimension, 1e6, 4, 0), 0.25)
            more = [ranks_model.efficiency(dimension, 1e6, p, 20000) for p in (2, 4, 8, 16)]
            self.assertEqual(sorted(more, reverse=True), more)
            self.assertGreater(min(more), 0)
            self.assertGreater(ranks_model.efficiency(dimension, 1e8, 4, 1e5), ranks_model.efficiency(dimension, 1e6, 4, 1e5))


class RanksTables(ScriptCase):
    def bench(self, *flags, command=MPI_COMMAND, expect=0):
        return self.run_script(BENCH / "ranks.py", COMMAND, command, "--launcher", LAUNCHER, "--cells", "9000", "--cube-cells", "6000",
                               "--repeat", "1", *flags, expect=expect)

    def test_tables(self):
        table, runs = self.folder / "table.md", self.folder / "runs.json"
        table.write_text("before\n<!-- begin of the tables of ranks -->\nold\n<!-- end of the tables of ranks -->\nafter\n")
        self.bench("--ranks", "1,4", "--table", table, "--json", runs)
        text = table.read_text()
        self.assertTrue(text.startswith("before\n") and text.endswith("\nafter\n") and "old" not in text, text)
        self.assertEqual(text.count("| 4 |"), 8)  # two models: both workloads, the breakdown, ranks and threads
        self.assertIn("| 293.7 | 1.00 |", text)
        self.assertIn("0.24, 218.7, 32.7, 39.9", text)
        self.assertIn("220.3, 214.1", text)
        rows = json.loads(runs.read_text())["runs"]
        self.assertEqual(len(rows), 2 * (4 + 4))
        for r in rows:
            self.assertGreater(r["cells"], 4000)
            self.assertGreater(r["cpu"], 0)
            self.assertEqual(r["shared"] is None, r["case"]["ranks"] == 0)

    def test_other_bytes_are_found(self):
        liar = self.script("pgdr-mpi", f'exec {MPI_COMMAND} "$@" --radius-edge 1.6\n')
        done = self.bench("--ranks", "1", "--models", "square", command=liar, expect=1)
        self.assertIn("1 ranks, round 1: not the bytes of one process", done.stdout)

    def test_usage(self):
        for flags in (["--models", "sphere"], ["--ranks", "0"]):
            self.assertIn("ranks.py: ", self.bench(*flags, expect=2).stderr)
        self.bench(command="/nowhere", expect=2)


if __name__ == "__main__":
    unittest.main(verbosity=2)
