#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Tables 3.1 to 3.4 of the dissertation anew: the uniform schedule on ranks, with scaled and with fixed workload.

    bench/ranks.py build/openmpi/pgdr build/openmpi/pgdr-mpi [--launcher mpirun.openmpi] [--ranks 1,4,9,16]
                   [--cells 6000000] [--cube-cells 1000000] [--repeat 3] [--minutes M] [--table bench/notebook/ranks.md]

The square (with 1000 points, as in the text) and the cube, with so many cells a rank, and so many at all. All configurations run by
turns, one thread a rank, refinement alone (`--no-optimize`); figures are medians. Beside each mesh `pgdr` makes the same in one
process: the bytes must be equal, and that mesh goes through `pgdr check`. Where there are fewer cores than ranks the time on the wall
says little, and CPU seconds, of all processes together, are what counts. Python's standard library is enough. Exit code: 0; 1 if a mesh
is wrong or bytes differ; 2 for wrong usage.
"""
import argparse
import dataclasses
import json
import os
import pathlib
import shutil
import signal
import statistics
import sys
import tempfile
import time

import made_inputs
import ranks_model
import suite_machine
import tables
from suite_programs import measure, read_json, sha256

ROOT = pathlib.Path(__file__).resolve().parents[1]
CELLS_TIMES_SIZE = {"square": 1.5, "cube": 4.9}  # cells times the area bound; times the cube of the bound on radii
# Processors; seconds and millions of elements, scaled; seconds, fixed. Table 3.1.
TEXT_SQUARE = {4: (293.7, 23.8, 293.7), 9: (294.7, 58.8, 122.3), 16: (295.4, 109.3, 67.2), 25: (296.8, 175.4, 43.3), 36: (293.4, 255.0, 30.2),
               49: (294.5, 352.6, 23.3), 64: (300.1, 470.7, 19.4), 81: (296.2, 587.8, 17.0), 100: (300.3, 738.9, 15.6), 121: (293.7, 873.5, 15.1)}
# Table 3.3, of the pipe.
TEXT_PIPE = {4: (179.1, 14.6, 179.1), 9: (204.8, 32.8, 105.6), 16: (225.7, 58.3, 80.5), 25: (239.8, 91.1, 54.2), 36: (255.3, 131.2, 40.1),
             49: (253.7, 178.6, 30.2), 64: (273.6, 233.3, 21.9), 81: (258.6, 295.3, 17.1), 100: (232.2, 364.6, 15.0), 121: (212.7, 441.1, 14.8)}
# Seconds before the refinement, in it, of communication, of filling in and merging. Table 3.2.
TEXT_PARTS = {4: (0.24, 218.7, 32.7, 39.9), 9: (0.44, 220.0, 35.4, 40.3), 16: (0.71, 218.8, 37.1, 40.0), 25: (1.05, 219.1, 39.1, 40.8),
              36: (1.43, 218.6, 36.1, 40.0), 49: (1.88, 217.7, 37.5, 40.7), 64: (2.49, 221.0, 40.7, 41.5), 81: (3.04, 216.6, 46.2, 41.1),
              100: (3.69, 218.4, 46.5, 41.5), 121: (4.42, 210.3, 53.6, 40.9)}
TEXT_MPI_AND_SHARED = (220.3, 214.1)  # seconds of four processors. Table 3.4.
# More processes than cores, processes of root, as in containers, and no core of one's own for any.
ENVIRONMENT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
               "OMPI_MCA_btl_vader_single_copy_mechanism": "none", "OMPI_MCA_hwloc_base_binding_policy": "none"}
WAYS = ["scaled", "fixed"]


@dataclasses.dataclass(frozen=True)
class Case:
    model: str
    way: str
    size: float
    ranks: int  # 0: one process, `threads` of it
    threads: int = 1

    def words(self):
        who = f"{self.ranks} ranks" if self.ranks else f"one process, {self.threads} threads"
        return f"{self.model}, {self.way}, size {self.size:.3g}, {who}"


def arguments():
    numbers = lambda text: [int(word) for word in text.split(",") if word]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("pgdr", type=pathlib.Path, help="the command of one process")
    add("pgdr_mpi", type=pathlib.Path, help="the command of several, of the same commit")
    add("--launcher", default="mpirun.openmpi", help="default: %(default)s; mpirun.mpich for a build with MPICH")
    add("--ranks", type=numbers, default=[1, 4, 9, 16], help="default: 1,4,9,16")
    add("--models", type=lambda text: text.split(","), default=["square", "cube"], help="default: square,cube")
    add("--cells", type=float, default=6e6, help="of the square: a rank, scaled; at all, fixed; default: %(default).0f")
    add("--cube-cells", type=float, default=1e6, help="of the cube; default: %(default).0f")
    add("--repeat", type=int, default=3, help="rounds, of which the tables have medians; default: %(default)s")
    add("--minutes", type=float, default=float("inf"), help="no run begins after that; default: no limit")
    add("--folder", type=pathlib.Path, help="for meshes, one or two at a time, each of up to 60 bytes a cell; default: a temporary one")
    add("--json", type=pathlib.Path, help="a file for all runs")
    add("--table", type=pathlib.Path, help="a file whose tables, between their marks, are replaced")
    return parser.parse_args()


def cases(a):
    """One round. Of each size the run of one process comes first."""
    for model in a.models:
        cells, power = (a.cells, 1) if model == "square" else (a.cube_cells, 1 / 3)
        size = lambda n: (CELLS_TIMES_SIZE[model] / n) ** power
        for way in WAYS:
            for n, ranks in enumerate(a.ranks):
                now = size(cells * ranks if way == "scaled" else cells)
                if way == "scaled" or n == 0:
                    yield Case(model, way, now, 0)
                yield Case(model, way, now, ranks)
                if way == "fixed" and ranks > 1:  # Table 3.4: as many threads as ranks
                    yield Case(model, way, now, 0, ranks)


class Runner:
    """Makes meshes, checks them, and keeps a row of each run."""

    def __init__(self, a, folder):
        self.a, self.folder, self.rows, self.wrong, self.hashes, self.checked = a, folder, [], [], {}, set()
        made_inputs.write_cube(folder / "cube.poly")
        self.inputs = {"cube": folder / "cube.poly", "square": ROOT / "tests" / "models" / "planar" / "square1000.poly"}

    def run(self, case, number):
        mesh, report = self.folder / "mesh.vtu", self.folder / "report.json"
        program = [shutil.which(self.a.launcher), "-n", case.ranks, self.a.pgdr_mpi.resolve()] if case.ranks else [self.a.pgdr.resolve()]
        code, said, row = measure([*program, "mesh", self.inputs[case.model], "-o", mesh, "--report", report, "--quiet", "--size", repr(case.size),
                                   "--schedule", "uniform", "--threads", case.threads, *self.flags(case)], self.folder, 36000, ENVIRONMENT)
        if code != 0 or not mesh.exists():
            self.wrong.append(f"{case.words()}, round {number}: exit code {code}; {said.strip()[:300]}")
            return
        self.compare(case, number, mesh)
        data = read_json(report)
        row.update(case=case, round=number, cells=data["cells"], seconds=data["seconds"], shared=data.get("distributed"),
                   cpu=row["cpu_user"] + row["cpu_system"], peak=data["peak_rss_bytes"], load=os.getloadavg()[0])
        self.rows.append(row)
        mesh.unlink()
        report.unlink()

    @staticmethod
    def flags(case):
        return ["--no-optimize"] if case.model == "cube" else []

    def compare(self, case, number, mesh):
        """With the first mesh of this size, which the checker sees."""
        key, found = (case.model, case.size), sha256(mesh)
        if self.hashes.setdefault(key, found) != found:
            self.wrong.append(f"{case.words()}, round {number}: not the bytes of one process")
        if key in self.checked:
            return
        self.checked.add(key)
        code, said, _ = measure([self.a.pgdr.resolve(), "check", mesh, "--input", self.inputs[case.model], "--quiet"], self.folder, 36000)
        if code != 0:
            self.wrong.append(f"{case.words()}: the checker ends with {code}; {said.strip()[:300]}")


def run_all(runner, a):
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    end = time.monotonic() + 60 * a.minutes
    try:
        for number in range(1, a.repeat + 1):
            for case in cases(a):
                if time.monotonic() > end:
                    print(f"the time is over in round {number}", file=sys.stderr)
                    return
                runner.run(case, number)
                print(f"round {number}: {case.words()}", file=sys.stderr, flush=True)
    except KeyboardInterrupt:
        print("ended by Ctrl-C", file=sys.stderr)


class Figures:
    """Medians of the rows of a case."""

    def __init__(self, rows):
        self.groups = {}
        for r in rows:
            self.groups.setdefault(r["case"], []).append(r)

    def middle(self, case, get):
        rows = self.groups.get(case)
        return statistics.median(get(r) for r in rows) if rows else None

    def wall(self, case):
        return self.middle(case, lambda r: r["seconds"]["mesh"])

    def cpu_a_million(self, case):
        return self.middle(case, lambda r: r["cpu"] / r["cells"] * 1e6)

    def on_ranks(self, model, way):
        return sorted((c for c in self.groups if c.model == model and c.way == way and c.ranks), key=lambda c: c.ranks)


def table(head, rows):
    return ["", "| " + " | ".join(head) + " |", "|" + " --- |" * len(head), *("| " + " | ".join(row) + " |" for row in rows), ""]


def workload(figures, model, way):
    """Tables 3.1 and 3.3: a line a number of ranks."""
    dimension = 2 if model == "square" else 3
    text = TEXT_SQUARE if model == "square" else TEXT_PIPE
    head = ["ranks", "cells, millions", "seconds", "CPU seconds a million", "efficiency", "model", "the text's seconds", "its efficiency"]
    cases_here, rows = figures.on_ranks(model, way), []
    one = figures.cpu_a_million(cases_here[0]) if cases_here and cases_here[0].ranks == 1 else None
    for c in cases_here:
        cells, cpu = figures.middle(c, lambda r: r["cells"]), figures.cpu_a_million(c)
        cut = figures.middle(c, lambda r: r["shared"]["cut_cells"])
        seconds = text[c.ranks][0 if way == "scaled" else 2] if c.ranks in text else None
        four = text[4]
        its = None if seconds is None else (four[0] / four[1] * text[c.ranks][1] / seconds / c.ranks * 4 if way == "scaled" else four[2] * 4 / seconds / c.ranks)
        rows.append([str(c.ranks), f"{cells / 1e6:.3f}", f"{figures.wall(c):.2f}", f"{cpu:.3f}", f"{one / cpu:.2f}" if one else "",
                     f"{ranks_model.efficiency(dimension, cells, c.ranks, cut):.2f}", f"{seconds:g}" if seconds else "", f"{its:.2f}" if its else ""])
    return table(head, rows)


def breakdown(figures, model):
    """Table 3.2, of the scaled workload."""
    head = ["ranks", "prologue", "pack", "apply", "wait", "finish", "MB sent", "bytes sent a cell", "cells applied a cell", "cut at cells",
            "alone at the end", "memory, MB a rank", "of one process", "the text: before, refinement, communication, filling in"]
    rows = []
    for c in figures.on_ranks(model, "scaled"):
        get = lambda key: figures.middle(c, lambda r: r["shared"][key])
        seconds = lambda key: f"{figures.middle(c, lambda r: r['shared']['seconds'][key]):.2f}"
        memory = lambda key: f"{figures.middle(c, lambda r: r['shared']['peak_rss_bytes'][key]) / 1e6:.0f}"
        cells, alone = figures.middle(c, lambda r: r["cells"]), figures.middle(dataclasses.replace(c, ranks=0), lambda r: r["peak"])
        text = TEXT_PARTS.get(c.ranks) if model == "square" else None
        rows.append([str(c.ranks), *map(seconds, ("prologue", "pack", "apply", "wait", "finish")), f"{get('bytes_sent') / 1e6:.1f}",
                     f"{get('bytes_sent') / cells:.1f}", f"{get('cells_applied') / cells:.2f}", f"{get('cut_cells'):,.0f}",
                     "yes" if get("gathered") else "no", f"{memory('min')} to {memory('max')}", f"{alone / 1e6:.0f}" if alone else "",
                     ", ".join(f"{t:g}" for t in text) if text else ""])
    return table(head, rows)


def beside_threads(figures, model):
    """Table 3.4: as many ranks as threads."""
    head = ["ranks or threads", "seconds of ranks", "of threads", "CPU seconds of ranks", "of threads", "the text's MPI, OpenMP"]
    rows = []
    for c in figures.on_ranks(model, "fixed"):
        shared = dataclasses.replace(c, ranks=0, threads=c.ranks)
        if figures.wall(shared) is None:
            continue
        cpu = lambda case: f"{figures.middle(case, lambda r: r['cpu']):.2f}"
        rows.append([str(c.ranks), f"{figures.wall(c):.2f}", f"{figures.wall(shared):.2f}", cpu(c), cpu(shared),
                     "{:g}, {:g}".format(*TEXT_MPI_AND_SHARED) if c.ranks == 4 else ""])
    return table(head, rows)


def lines_of(rows, a, record):
    figures, lines = Figures(rows), []
    for model in a.models:
        for way in WAYS:
            beside = "Table 3.1" if model == "square" else "Table 3.3, of the pipe in 2D"
            lines += [f"**{model.capitalize()}, {way} workload** (beside {beside})", *workload(figures, model, way)]
        lines += [f"**{model.capitalize()}, where the time goes**, scaled workload: seconds, the most of any rank (beside Table 3.2)",
                  *breakdown(figures, model), f"**{model.capitalize()}, ranks and threads**, fixed workload (beside Table 3.4)",
                  *beside_threads(figures, model)]
    return lines + [f"{suite_machine.words(record)}, {a.launcher}, medians of {max([r['round'] for r in rows], default=0)}. Efficiency is of CPU "
                    "seconds, a million cells, beside one rank; where there are fewer cores than ranks they are what counts, and seconds on "
                    "the wall are those of ranks that take turns. The text's efficiency is beside its four processors."]


def main():
    a = arguments()
    lost = [str(p) for p in (a.pgdr, a.pgdr_mpi) if not p.is_file()] + [m for m in a.models if m not in CELLS_TIMES_SIZE]
    if lost or not shutil.which(a.launcher) or a.repeat < 1 or not a.ranks or min(a.ranks) < 1:
        print(f"ranks.py: no {', '.join(lost) or a.launcher}, or no such number", file=sys.stderr)
        return 2
    record = suite_machine.record(ROOT, a.pgdr_mpi)
    with tempfile.TemporaryDirectory(prefix="pgdr_ranks_", dir=a.folder) as folder:
        runner = Runner(a, pathlib.Path(folder))
        run_all(runner, a)
    lines = lines_of(runner.rows, a, record)
    print("\n".join(lines + [f"WRONG: {w}" for w in runner.wrong]))
    if a.json:
        rows = [{**r, "case": dataclasses.asdict(r["case"])} for r in runner.rows]
        a.json.write_text(json.dumps({**record, "wrong": runner.wrong, "runs": rows}, indent=1) + "\n")
    if a.table:
        tables.write_table(a.table, lines, "tables of ranks")
    return 1 if runner.wrong else 0


if __name__ == "__main__":
    sys.exit(main())
