#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""pgdr-mpi from outside: the bytes of plain pgdr, exit codes, messages that come once, processes that die.

PGDR_COMMAND and PGDR_MPI_COMMAND name the commands, PGDR_MPIEXEC the launcher. Usage: test_mpi_command.py [Class[.test]...]
"""
import os
import pathlib
import signal
import subprocess
import time
import unittest

from test_command import BRACKET, COMMAND, MODELS, PLATE, WEDGE, Case

MPI_COMMAND = os.environ.get("PGDR_MPI_COMMAND", "build/openmpi/pgdr-mpi")
LAUNCHER = os.environ.get("PGDR_MPIEXEC", "mpirun.openmpi")
SECONDS_TO_END = 60  # after a process has died; the others would wait for ever


def children(pid):
    """All processes below this one."""
    below = []
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            parent = int(folder.joinpath("stat").read_text().rpartition(")")[2].split()[1])
        except (OSError, IndexError):
            continue  # it has ended meanwhile
        if parent == pid:
            below += [int(folder.name), *children(int(folder.name))]
    return below


def ranks_below(pid):
    """The processes of pgdr-mpi that this launcher has started."""
    found = []
    for child in children(pid):
        try:
            if pathlib.Path(os.readlink(f"/proc/{child}/exe")).name == "pgdr-mpi":
                found.append(child)
        except OSError:
            continue
    return sorted(found)


class RanksCase(Case):
    def launch(self, ranks, *arguments):
        return [LAUNCHER, "-n", str(ranks), *map(str, arguments)]

    def ranks(self, number, *arguments, expect=None, program=MPI_COMMAND, **keywords):
        done = subprocess.run(self.launch(number, program, *arguments), capture_output=True, text=True, timeout=120,
                              stdin=subprocess.DEVNULL, **keywords)
        if expect is not None:
            self.assertEqual(done.returncode, expect, f"{arguments}\n{done.stdout}{done.stderr}")
        return done


class Bytes(RanksCase):
    def assert_same(self, *arguments, name="out.vtu", expect=0):
        plain, shared = self.folder / ("plain_" + name), self.folder / name
        self.pgdr("mesh", *arguments, "-o", plain, "--quiet", expect=expect)
        for number in (1, 2, 3, 4):
            for threads in (1, 2):
                self.ranks(number, "mesh", *arguments, "-o", shared, "--threads", threads, "--quiet", expect=expect)
                self.assertEqual(shared.read_bytes(), plain.read_bytes(), f"{number} ranks, {threads} threads")
                shared.unlink()

    def test_volume(self):
        self.assert_same(BRACKET, "--size", "0.2")

    def test_plane(self):
        self.assert_same(MODELS / "planar" / "key_like.poly")

    def test_another_format(self):
        self.assert_same(PLATE, name="out.mesh")

    def test_report(self):
        self.ranks(3, "mesh", BRACKET, "-o", self.output, "--report", self.report, expect=0)
        report = self.json()
        self.assertEqual(report["ranks"], 3)
        distributed = report["distributed"]
        self.assertGreater(distributed["messages"], 0)
        self.assertGreater(distributed["bytes_sent"], 0)
        self.assertLessEqual(distributed["peak_rss_bytes"]["min"], distributed["peak_rss_bytes"]["max"])
        self.pgdr("check", self.output, "--input", BRACKET, "--reasons", self.report, expect=0)


CUBE = """8 3 0 0
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0 0 1
6 1 0 1
7 1 1 1
8 0 1 1
6 0
1
4 1 2 3 4
1
4 5 6 7 8
1
4 1 2 6 5
1
4 2 3 7 6
1
4 3 4 8 7
1
4 4 1 5 8
0
"""
SQUARE = """6 2 0 0
1 0 0
2 0.5 0
3 1 0
4 1 1
5 0.5 1
6 0 1
7 0
1 1 2
2 2 3
3 3 4
4 4 5
5 5 6
6 6 1
7 2 5
0
2
1 0.25 0.5 1
2 0.75 0.5 2
"""


class UniformCase(RanksCase):
    """Meshes of which every rank makes its part."""

    def setUp(self):
        super().setUp()
        self.cube = [self.file("cube.poly", CUBE), "--no-optimize", "--schedule", "uniform", "--size", "0.018"]
        self.square = [self.file("square.poly", SQUARE), "--schedule", "uniform", "--size", "0.000008"]

    def assert_is_shared(self, is_gathered=False):
        distributed = self.json()["distributed"]
        self.assertGreater(distributed["cut_cells"], 0)
        self.assertEqual(distributed["gathered"], is_gathered)


class Shared(UniformCase):
    def assert_same(self, arguments, name, *flags):
        shared, plain = self.folder / "shared", self.folder / "plain"
        plain.mkdir()
        self.pgdr("mesh", *arguments, *flags, "-o", plain / name, "--quiet", expect=0)
        for number in (1, 2, 3, 4):
            for threads in (1, 2):
                with self.subTest(f"{number} ranks, {threads} threads, {flags}"):
                    shared.mkdir()
                    self.ranks(number, "mesh", *arguments, *flags, "-o", shared / name, "--threads", threads, "--quiet",
                               "--report", self.report, expect=0)
                    self.assertEqual({p.name: p.read_bytes() for p in shared.iterdir()},
                                     {p.name: p.read_bytes() for p in plain.iterdir()})
                    if number > 1:
                        self.assert_is_shared()
                    for p in shared.iterdir():
                        p.unlink()
                    shared.rmdir()
        return plain / name

    def test_volume(self):
        mesh = self.assert_same(self.cube, "out.vtu")
        self.pgdr("check", mesh, "--input", self.cube[0], expect=0)

    def test_plane(self):
        mesh = self.assert_same(self.square, "out.vtu")
        self.pgdr("check", mesh, "--input", self.square[0], expect=0)

    def test_pieces(self):
        self.assert_same(self.square, "out.pvtu", "--pieces", "1")

    def test_three_pieces(self):
        self.assert_same(self.square, "out.pvtu", "--pieces", "3")

    def test_time_limit(self):
        self.ranks(2, "mesh", *self.cube[:-1], "0.008", "-o", self.output, "--time-limit", "2", "--threads", "1", expect=5)
        self.pgdr("check", self.output, "--input", self.cube[0], expect=0)

    def test_a_signal(self):
        """To the first rank, which decides."""
        run = subprocess.Popen(
            self.launch(2, MPI_COMMAND, "mesh", *self.cube[:-1], "0.008", "-o", self.output, "--threads", "1", "--quiet"),
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
        patience = time.monotonic() + 30
        while len(ranks_below(run.pid)) < 2 and time.monotonic() < patience:
            time.sleep(0.02)
        time.sleep(3)
        self.assertIsNone(run.poll(), "the run was over before the signal")
        for process in ranks_below(run.pid):
            os.kill(process, signal.SIGTERM)
        self.assertEqual(run.wait(timeout=60), 5)
        self.pgdr("check", self.output, "--input", self.cube[0], expect=0)


class Reports(UniformCase):
    """The report of ranks says what that of one process says."""
    OF_RANKS = {"ranks", "distributed"}
    UNLIKE = {"seconds", "peak_rss_bytes", "threads", "stages", "predicates", "scheduler"}

    def assert_same(self, *arguments, expect=0, is_gathered=False):
        self.pgdr("mesh", *arguments, "-o", self.output, "--report", self.report, "--quiet", expect=expect)
        alone = self.json()
        for number in (1, 2, 3):
            with self.subTest(ranks=number):
                self.ranks(number, "mesh", *arguments, "-o", self.output, "--report", self.report, "--quiet", "--threads", "1",
                           expect=expect)
                shared = self.json()
                self.assertEqual(set(shared), set(alone) | self.OF_RANKS)
                for key in set(alone) - self.UNLIKE:
                    self.assertEqual(shared[key], alone[key], key)
                for key in ("visits", "generations", "leaves"):
                    self.assertEqual(shared["scheduler"][key], alone["scheduler"][key], key)
                if number > 1 and is_gathered is not None:
                    self.assert_is_shared(is_gathered)

    def test_volume(self):
        self.assert_same(*self.cube)

    def test_plane_with_regions(self):
        self.assert_same(*self.square)

    def test_optimised(self):
        self.assert_same(*[a for a in self.cube if a != "--no-optimize"], is_gathered=True)

    def test_small_angles(self):
        self.assert_same(self.file("wedge.poly", WEDGE), "--size", "0.001", "--schedule", "uniform", expect=1, is_gathered=None)


class AnotherSurface(RanksCase):
    """Each rank makes it, from the file: the same one."""
    def test_same_bytes(self):
        model = BRACKET.parent / "real" / "surfaces" / "cgal_anchor.off"
        self.pgdr("mesh", model, "--surface-tolerance", "0.5%", "-o", self.output, expect=None)
        alone = self.output.read_bytes()
        self.ranks(2, "mesh", model, "--surface-tolerance", "0.5%", "-o", self.output, "--report", self.report, expect=None)
        self.assertEqual(self.output.read_bytes(), alone)
        self.assertEqual(self.json()["ranks"], 2)


class Codes(RanksCase):
    def assert_said_once(self, done, text):
        self.assertEqual((done.stdout + done.stderr).count(text), 1, done.stdout + done.stderr)

    def test_what_is_printed_is_printed_once(self):
        done = self.ranks(3, "mesh", BRACKET, "-o", self.output, expect=0)
        self.assert_said_once(done, "every bound is met")
        self.assert_said_once(self.ranks(3, "--version", expect=0), "pgdr ")
        self.assert_said_once(self.ranks(3, "info", BRACKET, expect=0), "verdict")
        self.ranks(3, "check", self.output, "--input", BRACKET, expect=0)

    def test_errors(self):
        broken = self.file("broken.poly", "3 2 0 0\n1 0 x\n")
        cases = ((2, ["mesh", BRACKET], "error"),
                 (2, ["mesh", BRACKET, "-o", self.output, "--schedule", "greedy"], "greedy"),
                 (3, ["mesh", broken, "-o", self.output], "broken.poly"),
                 (4, ["mesh", self.folder / "none.poly", "-o", self.output], "none.poly"),
                 (4, ["mesh", BRACKET, "-o", self.folder / "none" / "out.vtu"], "there is no such folder"))
        for code, arguments, text in cases:
            with self.subTest(text):
                self.assert_said_once(self.ranks(3, *arguments, expect=code), "pgdr: error: ")
                self.assert_only("broken.poly")

    def test_elements_that_stay_poor(self):
        wedge = self.file("wedge.poly", WEDGE)
        done = self.ranks(2, "mesh", wedge, "-o", self.output, expect=1)
        self.assert_said_once(done, "small_angle")

    def test_time_limit(self):
        self.ranks(2, "mesh", BRACKET, "--size", "0.03", "-o", self.output, "--time-limit", "1", expect=5)
        self.pgdr("check", self.output, "--input", BRACKET, expect=0)

    def test_the_plain_command_is_for_one_process(self):
        done = self.ranks(2, "mesh", BRACKET, "-o", self.output, program=COMMAND)
        self.assertEqual(done.returncode, 2)
        self.assertIn("use pgdr-mpi", done.stderr)
        self.assert_only()
        self.ranks(1, "mesh", BRACKET, "-o", self.output, program=COMMAND, expect=0)

    def test_a_flag_for_ranks(self):
        done = self.mesh(BRACKET, "--rank-timeout", "5", expect=2)
        self.assertIn("pgdr-mpi", done.stderr)
        self.ranks(2, "mesh", BRACKET, "-o", self.output, "--rank-timeout", "60", expect=0)


class Failures(RanksCase):
    def assert_no_final_file(self):
        self.assertFalse(self.output.exists())
        self.assertFalse(self.report.exists())

    def test_a_process_is_killed(self):
        for victim, schedule in ((0, "reproducible"), (2, "reproducible"), (0, "uniform"), (2, "uniform")):
            for moment in (0.3, 2) if schedule == "reproducible" else (0.3, 2, 4):
                with self.subTest(victim=victim, schedule=schedule, moment=moment):
                    run = subprocess.Popen(
                        self.launch(3, MPI_COMMAND, "mesh", BRACKET, "--size", "0.02", "-o", self.output, "--report",
                                    self.report, "--threads", "1", "--quiet", "--schedule", schedule),
                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
                    patience = time.monotonic() + 30
                    while len(ranks_below(run.pid)) < 3 and time.monotonic() < patience:
                        time.sleep(0.02)
                    time.sleep(moment)
                    self.assertIsNone(run.poll(), "the run was over before anything was killed")
                    os.kill(ranks_below(run.pid)[victim], signal.SIGKILL)
                    code = run.wait(timeout=SECONDS_TO_END)
                    self.assertNotEqual(code, 0)
                    self.assert_no_final_file()

    def test_a_full_disk(self):
        """Files of a process end at 8 MiB, which MPI's own files of shared memory stay below; the mesh is larger."""
        program = self.file("limited.sh", "#!/bin/sh\nulimit -f 16384\ntrap '' XFSZ\nexec \"$@\"\n")
        program.chmod(0o755)
        done = self.ranks(2, MPI_COMMAND, "mesh", BRACKET, "--size", "0.06", "-o", self.folder / "out.mesh",
                          "--no-optimize", program=program)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertEqual(done.stderr.count("pgdr: error: "), 1, done.stderr)
        self.assert_only("limited.sh")


if __name__ == "__main__":
    unittest.main()
