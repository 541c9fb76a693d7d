#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The volumes (2D: areas) of a mesh by label, exactly, against those that its input encloses by the numbers in its file.

Usage: given_volumes.py INPUT MESH.mesh REPORT.json   compares
       given_volumes.py INPUT                         prints what the input encloses
       given_volumes.py --folder FOLDER...            meshes every input below (PGDR_COMMAND, PGDR_SECONDS each: 20) and compares
"""
import collections
import dataclasses
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
from fractions import Fraction

import enclosed
import input_files
from input_files import UnknownInput


@dataclasses.dataclass
class Volume:
    given: Fraction       # as the coordinates have it
    area: float = 0       # of its boundary (2D: the length)
    perimeter: float = 0  # of the faces there (2D: how many points)
    bent: float = 0       # by how much it depends on how polygons that are not planar are triangulated

    def allowance(self, tolerance, ulp):
        return self.area * (tolerance + 2 * ulp) + self.perimeter * tolerance ** 2 + self.bent


@dataclasses.dataclass
class Given:
    """What an input encloses: by label, and (`unlabelled`) volumes whose labels are not known, of RegionMode::automatic and all."""
    volumes: dict
    leaks: bool           # some faces end in the open, by the coordinates as they are
    is_hull: bool = False  # of points that lie beside its edges, too, which count as on them within the tolerance
    unlabelled: list = dataclasses.field(default_factory=list)


def length(v):
    return math.sqrt(sum(x * x for x in v))


class Measures:
    """Volumes of labels over the faces of a Complex, in units of the input."""

    def __init__(self, shape, unit):
        self.shape, self.unit, self.dimension = shape, unit, shape.dimension
        self.factor = (2 if self.dimension == 2 else 6) * unit ** self.dimension

    def edge(self, u, v):
        return [float(Fraction(d, self.unit)) for d in enclosed.minus(self.shape.points[v], self.shape.points[u])]

    def sizes(self, i):
        """Area, perimeter, and what a triangulation may change, of face i."""
        face = self.shape.faces[i]
        if self.dimension == 2:
            return length(self.edge(*face)), 1, 0
        normal = [float(Fraction(n, 2 * self.unit ** 2)) for n in self.shape.normals[i]]
        area, off = length(normal), 0
        if len(face) > 3 and area > 0:
            heights = [enclosed.dot(self.shape.normals[i], enclosed.minus(self.shape.points[u], self.shape.points[face[0][0]]))
                       for u, _ in face]
            off = float(Fraction(max(heights) - min(heights), 2 * self.unit ** 3)) / area
        return area, sum(length(self.edge(u, v)) for u, v in face), 2 * area * off

    def of_labels(self, label_of):
        """`label_of`: of a set of sides; None: nothing is meshed there."""
        sums, volumes = collections.defaultdict(int), {}
        for i in range(len(self.shape.faces)):
            front, back = (label_of(self.shape.of_side(2 * i + k)) for k in range(2))
            if front == back:
                continue
            area, perimeter, bent = self.sizes(i)
            part = self.shape.measure(i) * (1 if self.dimension == 2 else -1)
            for label, sign in ((front, 1), (back, -1)):
                if label is None:
                    continue
                sums[label] += sign * part
                volume = volumes.setdefault(label, Volume(Fraction(0)))
                volume.area += area
                volume.perimeter += perimeter
                volume.bent += bent
        for label, volume in volumes.items():
            volume.given = Fraction(sums[label], self.factor)
        return volumes


def solid_sides(shape):
    """The volumes that nesting makes solid: an odd number of faces away from the outside; None if ways there disagree."""
    beside = collections.defaultdict(set)
    for i in range(len(shape.faces)):
        a, b = shape.of_side(2 * i), shape.of_side(2 * i + 1)
        if a != b:
            beside[a].add(b)
            beside[b].add(a)
    depth, last = {shape.of_side(shape.outside): 0}, [shape.of_side(shape.outside)]
    while last:
        new = []
        for a in last:
            for b in beside[a]:
                if b not in depth:
                    depth[b] = depth[a] + 1
                    new.append(b)
                elif (depth[a] + depth[b]) % 2 == 0:
                    return None
        last = new
    return {a for a, d in depth.items() if d % 2 == 1}


def hull_edges(points):
    """Edges of the convex hull through all points on it (Andrew 1979)."""
    unit = enclosed.unit_of(points)
    steps = sorted((enclosed.in_steps(p, unit), i) for i, p in enumerate(points))
    edges = []
    for chain in (steps, steps[::-1]):
        hull = []
        for p, i in chain:
            while len(hull) > 1 and enclosed.determinant(enclosed.minus(hull[-1][0], hull[-2][0]), enclosed.minus(p, hull[-1][0])) < 0:
                hull.pop()
            hull.append((p, i))
        edges += [(a[1], b[1], 0) for a, b in zip(hull, hull[1:])]
    return edges


def volumes_given(path, flags=()):
    """What the input encloses, as the flags of `pgdr mesh` have it. @raises UnknownInput"""
    given = input_files.read(path)
    if "--resolve-crossings" in flags:
        raise UnknownInput("crossings are not resolved here")
    if "--convex-hull" in flags:
        given.segments += hull_edges(given.points)
    mode = next((m for m in ("auto", "all") if m in flags or f"--regions={m}" in flags), "seeds")
    shape, unit = enclosed.complex_of(given)
    outside = shape.of_side(shape.outside)
    label_of = {outside: None}
    for hole in given.holes:
        label_of[shape.volume_at(enclosed.in_steps(hole, unit))] = None
    for point, attribute in given.regions:
        label_of.setdefault(shape.volume_at(enclosed.in_steps(point, unit)), attribute)
    leaks, is_hull = bool(shape.open_ridges), "--convex-hull" in flags
    measures = Measures(shape, unit)
    if mode == "seeds":
        return Given(measures.of_labels(lambda side: label_of.get(side, 0.0)), leaks, is_hull)
    solid = solid_sides(shape) if mode == "auto" else None
    if mode == "auto" and solid is None:
        raise UnknownInput("nesting is ambiguous")
    volumes = measures.of_labels(lambda side: label_of.get(side, ("volume", side) if solid is None or side in solid else None))
    unlabelled = [v for label, v in volumes.items() if isinstance(label, tuple)]
    return Given({label: v for label, v in volumes.items() if not isinstance(label, tuple)}, leaks, is_hull, unlabelled)


class Mesh:
    """Points, cells and labels of a .mesh that pgdr wrote; doubles as they are."""

    def __init__(self, path):
        lines = iter(pathlib.Path(path).read_text(encoding="ascii").splitlines())
        self.points, self.cells, self.labels, self.dimension = [], [], [], 0
        for line in lines:
            if line.startswith("Dimension"):
                self.dimension = int(line.split()[1])
            elif line == "Vertices":
                self.points = [tuple(map(float, next(lines).split()[:self.dimension])) for _ in range(int(next(lines)))]
            elif line == ("Tetrahedra" if self.dimension == 3 else "Triangles"):
                for _ in range(int(next(lines))):
                    *corners, label = map(int, next(lines).split())
                    self.cells.append([c - 1 for c in corners])
                    self.labels.append(float(label))

    def volumes(self):
        unit = enclosed.unit_of(self.points)
        steps = [enclosed.in_steps(p, unit) for p in self.points]
        sums = collections.defaultdict(int)
        for cell, label in zip(self.cells, self.labels):
            p, *others = (steps[v] for v in cell)
            sums[label] += abs(enclosed.determinant(*(enclosed.minus(q, p) for q in others)))
        factor = (2 if self.dimension == 2 else 6) * unit ** self.dimension
        return {label: Fraction(s, factor) for label, s in sums.items()}

    def ulp(self):
        return math.ulp(max(abs(c) for p in self.points for c in p))


def matched(given, meshed, allowance):
    """The given volumes by the labels of the mesh, those of unknown labels by their size; None if that cannot be. What the tolerance
    closes, between two courses of one border, has no cells."""
    volumes = {label: v for label, v in given.volumes.items() if label in meshed or abs(v.given) > allowance(v)}
    rest = sorted((label for label in meshed if label not in volumes), key=lambda label: meshed[label])
    if len(rest) != len(given.unlabelled) or any(label not in meshed for label in volumes):
        return None
    volumes.update(zip(rest, sorted(given.unlabelled, key=lambda v: v.given)))
    return volumes


def complaints_about(given, mesh, report):
    """What is wrong with the volumes of a mesh, and with what its report says of them."""
    meshed = mesh.volumes()
    told = {entry["label"]: entry for entry in report.get("regions", [])}
    if any(label != int(label) for label in told):  # which a .mesh numbers from 1 on
        meshed = dict(zip(sorted(told), (meshed[label] for label in sorted(meshed))))
    if "regions" in report:
        if sorted(told) != sorted(meshed):
            yield f"the report has regions {sorted(told)}, the mesh {sorted(meshed)}"
        for label in set(told) & set(meshed):
            if told[label]["volume_meshed"] != float(meshed[label]):
                yield f"region {label:g}: volume_meshed is {told[label]['volume_meshed']!r}, not {float(meshed[label])!r}"
    unknown = {label for label, entry in told.items() if entry["volume_given"] is None}

    def allowance(volume):
        return volume.allowance(report.get("tolerance", 0), mesh.ulp())

    volumes = matched(given, meshed, allowance)
    if volumes is None:
        if not unknown:
            yield f"labels {sorted(meshed)}, not {sorted(given.volumes)} and {len(given.unlabelled)} others"
            return
        volumes = {label: v for label, v in given.volumes.items() if label in meshed}
    for label, volume in sorted(volumes.items()):
        if label in unknown:  # it closes by what the tolerance joins, which is not known here
            continue
        allowed = allowance(volume)
        if abs(meshed[label] - volume.given) > allowed:
            yield (f"region {label:g}: {float(meshed[label])!r} meshed, {float(volume.given)!r} given, "
                   f"off by {float(abs(meshed[label] - volume.given)):.3g}, not {allowed:.3g} at most")
        rounding = abs(Fraction(float(volume.given)) - volume.given)
        off = abs(Fraction(told[label]["volume_given"]) - volume.given) if label in told else 0
        if off > (allowed if given.is_hull else max(Fraction(volume.bent), rounding)):
            yield f"region {label:g}: volume_given is {told[label]['volume_given']!r}, not {float(volume.given)!r}"


def compare(path, mesh, report, flags=()):
    return list(complaints_about(volumes_given(path, flags), Mesh(mesh), json.loads(pathlib.Path(report).read_text())))


def compare_folder(folder):
    """Meshes what pgdr takes, and prints a line each."""
    command, limit, failed = os.environ.get("PGDR_COMMAND", "build/release/pgdr"), os.environ.get("PGDR_SECONDS", "20"), 0
    for path in sorted(p for p in pathlib.Path(folder).rglob("*") if p.suffix in input_files.READERS):
        with tempfile.TemporaryDirectory(prefix="pgdr_") as name:
            mesh, report = pathlib.Path(name) / "out.mesh", pathlib.Path(name) / "report.json"
            done = subprocess.run([command, "mesh", path, "-o", mesh, "--report", report, "--quiet", "--time-limit", limit],
                                  capture_output=True, text=True, stdin=subprocess.DEVNULL, check=False)
            if not mesh.exists():
                print(f"{path}: no mesh, exit {done.returncode}: {done.stderr.strip()[:160]}")
                continue
            try:
                complaints = compare(path, mesh, report)
                print(f"{path}: " + ("; ".join(complaints) if complaints else "as given"), flush=True)
                failed += bool(complaints)
            except UnknownInput as e:
                print(f"{path}: not compared: {e}", flush=True)
    return failed


def main(arguments):
    if arguments[:1] == ["--folder"] and len(arguments) > 1:
        return 1 if sum(compare_folder(folder) for folder in arguments[1:]) else 0
    if len(arguments) == 3:
        complaints = compare(*arguments)
        print("\n".join(complaints) or "as given")
        return 1 if complaints else 0
    if len(arguments) == 1 and not arguments[0].startswith("-"):
        given = volumes_given(arguments[0])
        for label, volume in sorted(given.volumes.items()):
            print(f"{label:g}: {float(volume.given)!r}")
        return 0
    print(__doc__, file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
