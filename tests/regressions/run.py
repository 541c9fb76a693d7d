#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes inputs as the .expect beside each says, checks every mesh against its input with `pgdr check --reasons`, measures it
itself, and compares the meshes of several numbers of threads byte for byte. README.md has the keys of a .expect.

Usage: run.py INPUT...            (PGDR_COMMAND: the command; PGDR_SANITIZE: its sanitizers, if any)
       run.py --files FOLDER...   whether each input there has its .expect, and each .expect its input
       run.py --copies INPUT...   whether random copies come to the same (PGDR_SEEDS of each kind: 1); files, names of shapes.py, or
                                  `all` of these
"""
import collections
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "oracles"))
# pylint: disable=wrong-import-position
import copies
import expect_file
import given_volumes
import input_files
import motions
import same_outcome
import shapes

COMMAND = os.environ.get("PGDR_COMMAND", "build/release/pgdr")
SANITIZED = bool(os.environ.get("PGDR_SANITIZE", ""))
SLOWER = 20 if SANITIZED else 1
INPUTS = {".poly", ".smesh", ".node", ".off", ".obj", ".stl", ".ply", ".msh", ".mesh"}
BESIDES = {".py", ".md", ".txt", ".tsv"}
# Flags of `pgdr mesh` that `pgdr check` has to be given; the others it finds in the report.
OF_CHECK = {"--size", "--region-size", "--size-mesh", "--size-growth", "--max-volume"}
# What has to be equal in the reports of several numbers of threads.
SAME = ["vertices", "cells", "stop", "reproducible", "quality", "bounds", "insertions", "warnings", "repairs"]
FLAT_DEGREES = 0.01


class Mesh:
    """Points, cells and labels of a .mesh that the command wrote."""

    def __init__(self, path):
        lines = iter(pathlib.Path(path).read_text(encoding="ascii").splitlines())
        self.points, self.cells, self.labels = [], [], []
        dimension = 0
        for line in lines:
            if line.startswith("Dimension"):
                dimension = int(line.split()[1])
            elif line == "Vertices":
                self.points = [tuple(map(float, next(lines).split()[:dimension])) for _ in range(int(next(lines)))]
            elif line == ("Tetrahedra" if dimension == 3 else "Triangles"):
                for _ in range(int(next(lines))):
                    *corners, label = map(int, next(lines).split())
                    self.cells.append([self.points[c - 1] for c in corners])
                    self.labels.append(label)

    def measures(self):
        """Volume (2D: area) by label."""
        parts = collections.defaultdict(list)
        for cell, label in zip(self.cells, self.labels):
            parts[label].append(measure(cell))
        return {label: math.fsum(part) for label, part in parts.items()}

    def flat_cells(self):
        return sum(is_flat(cell) for cell in self.cells)


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def measure(cell):
    edges = [minus(p, cell[0]) for p in cell[1:]]
    if len(edges) == 2:
        return (edges[0][0] * edges[1][1] - edges[0][1] * edges[1][0]) / 2
    return abs(dot(cross(edges[0], edges[1]), edges[2])) / 6


def is_flat(cell):
    """Whether an angle (3D: a dihedral angle) is within FLAT_DEGREES of 0 or 180 degrees, or is none."""
    if len(cell) == 3:
        pairs = [(minus(cell[i - 1], cell[i]), minus(cell[i - 2], cell[i])) for i in range(3)]
    else:
        normals = []
        for i in range(4):
            p, q, r = (cell[k] for k in range(4) if k != i)
            normals.append(cross(minus(q, p), minus(r, p)))
            if dot(normals[-1], minus(cell[i], p)) < 0:
                normals[-1] = minus((0, 0, 0), normals[-1])
        pairs = [(normals[i], normals[k]) for i in range(4) for k in range(i)]
    for a, b in pairs:
        lengths = math.sqrt(dot(a, a) * dot(b, b))
        if lengths == 0 or abs(dot(a, b)) >= lengths * math.cos(math.radians(FLAT_DEGREES)):
            return True
    return False


class Driver:
    """One run of a .expect on one input. `complaints` is what was not as expected."""

    def __init__(self, run, path, folder, scale=1, is_copy=False):
        self.run, self.path, self.folder, self.scale, self.is_copy = run, path, folder, scale, is_copy
        self.complaints = []

    def complain(self, text):
        self.complaints.append(text)

    def pgdr(self, *arguments):
        limit = self.run.seconds * SLOWER
        try:
            return subprocess.run([COMMAND, *map(str, arguments)], capture_output=True, text=True, stdin=subprocess.DEVNULL,
                                  timeout=limit, check=False)
        except subprocess.TimeoutExpired:
            self.complain(f"pgdr {arguments[0]} has no end in {limit:g} s")
            return None

    def mesh(self, threads):
        """The finished process, the mesh's and the report's file."""
        output, report = self.folder / f"{threads}.mesh", self.folder / f"{threads}.json"
        done = self.pgdr("mesh", self.path, "-o", output, "--report", report, "--threads", threads, *self.run.flags)
        return done, output, report

    def expect(self):
        done, output, report = self.mesh(self.run.threads[0])
        if done is None:
            return self.complaints
        said = done.stdout + done.stderr
        if done.returncode not in self.run.exit:
            self.complain(f"mesh ended with {done.returncode}, not {self.run.exit}: {done.stderr.strip()}")
            return self.complaints
        self.expect_words(said, report.read_text(encoding="utf-8") if report.exists() else "")
        if not self.run.makes_a_mesh:
            if output.exists():
                self.complain("what was refused left a mesh")
            return self.complaints
        self.expect_checked(done, output, report)
        self.expect_volumes_as_given(output, report)
        self.expect_measures(output, json.loads(report.read_text(encoding="utf-8")))
        if not self.is_copy:
            self.expect_same_for_any_threads(output, report)
        return self.complaints

    def expect_words(self, said, report):
        for pattern in self.run.says:
            if not pattern.search(said):
                self.complain(f"does not say {pattern.pattern!r}: {said.strip()}")
        for pattern in self.run.says_not:
            if pattern.search(said):
                self.complain(f"says {pattern.pattern!r}: {said.strip()}")
        for pattern in self.run.report_says:
            if not pattern.search(report):
                self.complain(f"the report does not say {pattern.pattern!r}")

    def expect_checked(self, done, output, report):
        bounds = []
        for at, flag in enumerate(self.run.flags):
            if flag.split("=")[0] in OF_CHECK:
                bounds += [flag] if "=" in flag and flag.startswith("--") else self.run.flags[at:at + 2]
        checked = self.pgdr("check", output, "--input", self.path, "--reasons", report, *bounds)
        expected = self.run.check if self.run.check is not None else (done.returncode,)
        if checked is not None and checked.returncode not in expected:
            self.complain(f"check ended with {checked.returncode}, not {expected}: {checked.stdout}{checked.stderr}".strip())

    def expect_volumes_as_given(self, output, report):
        """By the file and the mesh alone."""
        try:
            self.complaints += given_volumes.compare(self.path, output, report, self.run.flags)
        except input_files.UnknownInput:
            pass  # the .expect has the volumes

    def expect_measures(self, output, report):
        mesh, run = Mesh(output), self.run
        measures = mesh.measures()
        factor = float(self.scale) ** len(mesh.points[0])
        if run.volume is not None and not run.volume.scaled(factor).has(sum(measures.values())):
            self.complain(f"volume {sum(measures.values()):.12g}, not {run.volume.scaled(factor)}")
        if run.regions is not None:
            if set(measures) != set(run.regions):
                self.complain(f"labels {sorted(measures)}, not {sorted(run.regions)}")
            for label in sorted(set(measures) & set(run.regions)):
                expected = run.regions[label].scaled(factor)
                if not expected.has(measures[label]):
                    self.complain(f"region {label:g}: volume {measures[label]:.12g}, not {expected}")
        not_delaunay = (report["quality"].get("not_delaunay") or {}).get("refused", 0)
        counts = [("cells", len(mesh.cells), run.most_cells), ("poor cells", report["bounds"]["poor_left"], run.most_poor),
                  ("faces not Delaunay", not_delaunay, run.most_not_delaunay)]
        if run.most_flat is not None:
            counts.append(("flat cells", mesh.flat_cells(), run.most_flat))
        for what, number, most in counts:
            if most is not None and number > most:
                self.complain(f"{number} {what}, more than {most}")
        codes = {reason["code"] for reason in report["bounds"]["reasons"]}
        if run.reasons is not None and codes != run.reasons:
            self.complain(f"reasons {sorted(codes)}, not {sorted(run.reasons)}")
        if report["stop"] != run.stop:
            self.complain(f"stop is {report['stop']}, not {run.stop}")

    def expect_same_for_any_threads(self, output, report):
        first = json.loads(report.read_text(encoding="utf-8"))
        for threads in self.run.threads[1:]:
            done, other, its_report = self.mesh(threads)
            if done is None:
                return
            if not other.exists() or other.read_bytes() != output.read_bytes():
                self.complain(f"another mesh by {threads} threads than by {self.run.threads[0]}")
                return
            second = json.loads(its_report.read_text(encoding="utf-8"))
            for key in SAME:
                if first.get(key) != second.get(key):
                    self.complain(f"another {key} by {threads} threads than by {self.run.threads[0]}")


def complaints_about(path):
    """All runs of an input, and their copies."""
    found = []
    for run in expect_file.read(path.with_suffix(".expect")):
        if SANITIZED:
            run.threads, run.copies = run.threads[:1], ()
        for kind in ("", *run.copies):
            with tempfile.TemporaryDirectory(prefix="pgdr_") as name:
                folder = pathlib.Path(name)
                target, scale = (folder / f"{kind}{path.suffix}" if kind else path), 1
                if kind:
                    scale = copies.copy(path, kind, target)
                what = " ".join(["mesh", path.name, *run.flags] + ([f"({kind})"] if kind else []))
                found += [f"{what}: {complaint}" for complaint in Driver(run, target, folder, scale, bool(kind)).expect()]
    return found


def complaints_about_copies(names):
    """What does not come to the same, of copies of inputs."""
    if "all" in names:
        names = [*(n for n in names if n != "all"), *shapes.ALL]
    for name, given, flags in same_outcome.inputs(names):
        for seed in range(int(os.environ.get("PGDR_SEEDS", "1"))):
            for kind, complaint in same_outcome.of_input(COMMAND, name, given, flags, 60 * SLOWER, seed, motions.KINDS):
                yield f"{name} ({kind}): {complaint}"


def unpaired(folder):
    """Inputs without .expect, and so on, below a folder."""
    files = [p for p in sorted(folder.rglob("*")) if p.is_file() and "__pycache__" not in p.parts and p.suffix not in BESIDES]
    inputs = collections.Counter(p.with_suffix("") for p in files if p.suffix in INPUTS)
    for path in files:
        stem = path.with_suffix("")
        if path.suffix == ".expect":
            if inputs[stem] != 1:
                yield f"{path}: {inputs[stem]} inputs of that name, not one"
            try:
                expect_file.read(path)
            except expect_file.ExpectError as e:
                yield str(e)
        elif path.suffix not in INPUTS:
            yield f"{path}: no input by its extension"
        elif not path.with_suffix(".expect").exists():
            yield f"{path}: no {stem.name}.expect"
    if not inputs:
        yield f"{folder}: no inputs"


def main(arguments):
    if not arguments:
        print(__doc__, file=sys.stderr)
        return 2
    if arguments[0] == "--files":
        complaints = [c for folder in arguments[1:] for c in unpaired(pathlib.Path(folder))]
    elif arguments[0] == "--copies":
        complaints = complaints_about_copies(arguments[1:])
    else:
        complaints = []
        for path in map(pathlib.Path, arguments):
            try:
                complaints += complaints_about(path)
            except (expect_file.ExpectError, copies.CopyError) as e:
                complaints.append(f"{path.name}: {e}")
    failed = False
    for complaint in complaints:
        print(complaint, flush=True)
        failed = True
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
