# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Faults put into right meshes, each of which `pgdr check` has to refuse for what it is.

    PGDR_COMMAND=build/release/pgdr PGDR_MUTATIONS=12 python3 tests/regressions/mutations.py

meshes models with voids, labels, markers, sheets and facets that overlap or are partly in the mesh, and makes so many faults of each
kind in each of them. It prints how many of each kind were refused, and by which findings. Nothing is made that may be right: a point
of a facet is moved off its plane, and none that lies in no facet; a marker that another facet at the place has is left out.
"""
import collections
import copy
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "oracles"))
import input_files  # noqa: E402  pylint: disable=wrong-import-position
import shapes  # noqa: E402  pylint: disable=wrong-import-position

DONE = (0, 1)
UNUSED_MARKER = 77
BORDER = {"stray_constraint", "segment_not_conforming", "facet_not_conforming", "missing_input_point"}


class Mesh:
    """A Medit file."""

    SECTIONS = {"Vertices": None, "Edges": 2, "Triangles": 3, "Tetrahedra": 4}

    def __init__(self, path):
        words = iter(path.read_text(encoding="utf-8").split("\n"))
        self.lists, self.comments = {}, ""  # which have labels that are no integers
        for line in words:
            name = line.strip()
            self.comments += line + "\n" if name.startswith("# region") else ""
            if name.startswith("Dimension"):
                self.dimension = int(name.split()[1])
            elif name in self.SECTIONS or name == "RequiredVertices":
                self.lists[name] = [next(words).split() for _ in range(int(next(words)))]
        self.unused_label = self.comments.count("\n") + 1 if self.comments else 91
        if self.comments:
            self.comments += f"# region {self.unused_label} = 91\n"
        self.points = [tuple(map(float, row[:self.dimension])) for row in self.lists["Vertices"]]
        self.point_markers = [int(row[-1]) for row in self.lists["Vertices"]]
        self.required = {int(row[0]) - 1 for row in self.lists.get("RequiredVertices", [])}
        named = {name: [([int(w) - 1 for w in row[:-1]], int(row[-1])) for row in self.lists.get(name, [])]
                 for name in ("Edges", "Triangles", "Tetrahedra")}
        self.subsegments = named["Edges"]
        self.walls = named["Edges" if self.dimension == 2 else "Triangles"]
        self.cells = named["Triangles" if self.dimension == 2 else "Tetrahedra"]

    def write(self, path):
        def section(name, rows):
            return f"{name}\n{len(rows)}\n" + "".join(" ".join(map(str, row)) + "\n" for row in rows)

        def numbered(rows):
            return [[*(v + 1 for v in row), reference] for row, reference in rows]

        text = f"MeshVersionFormatted 2\nDimension {self.dimension}\n{self.comments}"
        text += section("Vertices", [[*map(repr, p), m] for p, m in zip(self.points, self.point_markers)])
        text += section("Edges", numbered(self.subsegments))
        if self.dimension == 3:
            text += section("Triangles", numbered(self.walls))
        text += section("Triangles" if self.dimension == 2 else "Tetrahedra", numbered(self.cells))
        text += section("RequiredVertices", [[v + 1] for v in sorted(self.required)]) + "End\n"
        path.write_text(text, encoding="utf-8")

    def copy(self):
        other = copy.copy(self)
        other.points, other.point_markers = list(self.points), list(self.point_markers)
        other.subsegments, other.cells = list(self.subsegments), list(self.cells)
        other.walls = other.subsegments if self.dimension == 2 else list(self.walls)
        return other

    def size(self):
        return math.dist(*([f(p[k] for p in self.points) for k in range(self.dimension)] for f in (min, max)))

    def centre(self, c):
        cell = self.cells[c][0]
        return [sum(self.points[v][k] for v in cell) / len(cell) for k in range(self.dimension)]

    def faces(self):
        """The cells at each face."""
        found = collections.defaultdict(list)
        for c, (cell, _) in enumerate(self.cells):
            for v in cell:
                found[tuple(sorted(w for w in cell if w != v))].append(c)
        return found

    def wall_at(self):
        return {tuple(sorted(vertices)): i for i, (vertices, _) in enumerate(self.walls)}


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(u, v):
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


def unit(v):
    length = math.hypot(*v)
    return tuple(x / length for x in v)


def normal(mesh, wall):
    a, b, *c = (mesh.points[v] for v in wall)
    d = minus(b, a)
    return unit(cross(d, minus(c[0], a))) if c else unit((d[1], -d[0]))


def moved(p, direction, by):
    return tuple(x + by * d for x, d in zip(p, direction))


def some_direction(rng, dimension):
    return unit([rng.gauss(0, 1) for _ in range(dimension)])


# Each takes a model and a random generator, and gives a mesh, or a mesh and a report, or None where the model has no such thing.

def wall_missing(model, rng):
    mesh = model.mesh.copy()
    del mesh.walls[rng.randrange(len(mesh.walls))]
    return mesh


def creases(mesh):
    """3D: numbers of the subsegments that do not lie between two subfacets of one plane and marker."""
    at = collections.defaultdict(list)
    for wall, marker in mesh.walls:
        for v in wall:
            at[tuple(sorted(w for w in wall if w != v))].append((normal(mesh, wall), marker))
    for i, (edge, _) in enumerate(mesh.subsegments):
        here = at[tuple(sorted(edge))]
        if len(here) != 2 or here[0][1] != here[1][1] or abs(sum(a * b for a, b in zip(here[0][0], here[1][0]))) < 0.99:
            yield i


def subsegment_missing(model, rng):
    if model.mesh.dimension == 2:
        return None
    mesh = model.mesh.copy()
    del mesh.subsegments[rng.choice(list(creases(mesh)))]
    return mesh


def border_shifted(model, rng):
    """Both ends of a subsegment, and so the walls there, across it."""
    mesh = model.mesh.copy()
    ends, _ = rng.choice(mesh.subsegments)
    along = unit(minus(*(mesh.points[v] for v in ends)))
    across = some_direction(rng, mesh.dimension)
    across = unit(moved(across, along, -sum(a * b for a, b in zip(across, along))))
    for v in ends:
        mesh.points[v] = moved(mesh.points[v], across, 1e-4 * mesh.size())
    return mesh


def marker_border_shifted(model, rng):
    """A wall gets the marker of its neighbour."""
    mesh, pairs, at = model.mesh.copy(), [], collections.defaultdict(list)
    for i, (wall, _) in enumerate(mesh.walls):
        for v in wall:
            at[tuple(sorted(w for w in wall if w != v))].append(i)
    for here in at.values():
        pairs += [(i, k) for i in here for k in here if mesh.walls[i][1] != mesh.walls[k][1]]
    if not pairs or model.has_overlaps:
        return None
    i, k = rng.choice(sorted(pairs))
    mesh.walls[i] = (mesh.walls[i][0], mesh.walls[k][1])
    return mesh


def wall_added(model, rng):
    """A sheet goes on by a face beyond its border."""
    mesh, walls = model.mesh.copy(), model.mesh.wall_at()
    near = {v: m for wall, m in mesh.walls for v in wall}
    faces = [f for f, cells in mesh.faces().items() if len(cells) == 2 and f not in walls and any(v in near for v in f)]
    if not faces:
        return None
    face = rng.choice(sorted(faces))
    mesh.walls.append((list(face), near[next(v for v in face if v in near)]))
    return mesh


def marker_changed(model, rng):
    mesh = model.mesh.copy()
    others = sorted({m for _, m in mesh.walls})
    kind = rng.choice(("wall", "wall", "subsegment", "point"))
    if kind == "point":
        v = rng.choice(sorted(mesh.required))
        mesh.point_markers[v] = UNUSED_MARKER
        return mesh
    listed = mesh.walls if kind == "wall" else mesh.subsegments
    i = rng.randrange(len(listed))
    others = [m for m in others if m != listed[i][1]]
    new = rng.choice(others) if others and kind == "wall" and not model.has_overlaps else UNUSED_MARKER
    listed[i] = (listed[i][0], new)
    return mesh


def label_changed(model, rng):
    mesh = model.mesh.copy()
    labels = sorted({label for _, label in mesh.cells})
    if labels == [0]:
        return None
    way = rng.choice(("one cell", "swapped", "one region"))
    if way == "one cell":
        c = rng.randrange(len(mesh.cells))
        mesh.cells[c] = (mesh.cells[c][0], rng.choice([label for label in (*labels, mesh.unused_label) if label != mesh.cells[c][1]]))
        return mesh
    a = rng.choice(labels)
    b = rng.choice([label for label in labels if label != a]) if way == "swapped" and len(labels) > 1 else mesh.unused_label
    change = {a: b, b: a}
    mesh.cells = [(cell, change.get(label, label)) for cell, label in mesh.cells]
    return mesh


def void_filled(model, rng):
    if not model.filled:
        model.filled = [model.meshed(model.input.replaced(holes=[h for i, h in enumerate(model.input.holes) if i != k]))
                        for k in range(len(model.input.holes))]
    return rng.choice(model.filled).copy() if model.filled else None


def cell_dropped(model, rng):
    mesh = model.mesh.copy()
    del mesh.cells[rng.randrange(len(mesh.cells))]
    return mesh


def cell_dropped_with_its_walls(model, rng):
    """At the hull, so that the walls close again."""
    mesh, faces, at = model.mesh.copy(), model.mesh.faces(), model.mesh.wall_at()
    on_hull = [c for c, (cell, _) in enumerate(mesh.cells)
               if any(len(faces[tuple(sorted(w for w in cell if w != v))]) == 1 for v in cell)]
    c = rng.choice(on_hull)
    cell = mesh.cells.pop(c)[0]
    gone, fresh = [], []
    for v in cell:
        face = tuple(sorted(w for w in cell if w != v))
        if len(faces[face]) == 1:
            gone.append(at[face])
        elif face not in at:
            fresh.append(list(face))
    marker = mesh.walls[gone[0]][1]
    for i in sorted(gone, reverse=True):
        del mesh.walls[i]
    mesh.walls += [(face, marker) for face in fresh]
    if mesh.dimension == 3:
        edges = {tuple(sorted((a, b))) for wall, _ in mesh.walls for a in wall for b in wall if a < b}
        mesh.subsegments = [s for s in mesh.subsegments if tuple(sorted(s[0])) in edges]
    return mesh


def cell_twice(model, rng):
    mesh = model.mesh.copy()
    mesh.cells.append(rng.choice(mesh.cells))
    return mesh


def vertex_moved(model, rng):
    """By 1e-6 of the size, off the lowest entity that it lies on."""
    mesh = model.mesh.copy()
    kind = rng.choice(("input", "segment", "facet"))
    on_segments = {v for edge, _ in mesh.subsegments for v in edge}
    if kind == "input":
        used = {v for cell, _ in mesh.cells for v in cell}
        v, direction = rng.choice(sorted(mesh.required & used)), some_direction(rng, mesh.dimension)
    elif kind == "segment":
        steiner = sorted((v, i) for i, (edge, _) in enumerate(mesh.subsegments) for v in edge if v not in mesh.required)
        if not steiner:
            return None
        v, i = rng.choice(steiner)
        along = unit(minus(*(mesh.points[w] for w in mesh.subsegments[i][0])))
        across = some_direction(rng, mesh.dimension)
        direction = unit(moved(across, along, -sum(a * b for a, b in zip(across, along))))
    else:
        inner = sorted((v, i) for i, (wall, _) in enumerate(mesh.walls) for v in wall
                       if v not in mesh.required and v not in on_segments)
        if not inner:
            return None
        v, i = rng.choice(inner)
        direction = normal(mesh, mesh.walls[i][0])
    mesh.points[v] = moved(mesh.points[v], direction, 1e-6 * mesh.size() * rng.choice((-1, 1)))
    return mesh


def reason_false(model, rng):
    """Of another angle, of what is not there; in 2D, where it is of a cell over the ratio, of another cell or kind, or none."""
    report = copy.deepcopy(model.report)
    reasons = report["bounds"]["reasons"]
    angles = [i for i, r in enumerate(reasons) if r["code"] == "small_angle"]
    if not angles:
        return None
    mesh, i = model.mesh, rng.choice(angles)
    poor = {r["cell"] for r in reasons}
    named = [r for r in reasons if r["cell"] == reasons[i]["cell"]]
    way = rng.choice(("angle", "nothing", *(("cell", "entity", "code", "left out") if mesh.dimension == 2 else ())))
    if way == "cell":
        other = rng.choice([c for c in range(len(mesh.cells)) if c not in poor] + [len(mesh.cells) + 3])
        for r in named:
            r["cell"] = other
    elif way == "entity":
        here = mesh.centre(reasons[i]["cell"])
        far = max((reasons[k] for k in angles), key=lambda r: math.dist(mesh.centre(r["cell"]), here))
        if math.dist(mesh.centre(far["cell"]), here) < mesh.size() / 3:
            return None
        for r in named:
            r["code"], r["entities"], r["angle"] = "small_angle", far["entities"], far["angle"]
    elif way != "left out":
        change = {"angle": {"angle": reasons[i]["angle"] * rng.choice((1 - 1e-6, 1 + 1e-6, 0.5))},
                  "nothing": {"entities": [{"kind": "segment", "ends": [[0, 0, 0], [1e3, 0, 0]]}, reasons[i]["entities"][1]]},
                  "code": {"code": rng.choice(("rounding", "kept_boundary", "beyond_theory"))}}
        for r in named:
            r.update(change[way])
    else:
        report["bounds"]["reasons"] = [r for r in reasons if r not in named]
    return mesh, report


KINDS = {
    "wall missing": (wall_missing, BORDER | {"bad_link", "wrong_region", "wrong_volume"}),
    "subsegment missing": (subsegment_missing, {"segment_not_conforming"}),
    "border shifted": (border_shifted, BORDER),
    "marker border shifted": (marker_border_shifted, {"wrong_marker"}),
    "wall added": (wall_added, {"stray_constraint", "facet_not_conforming", "segment_not_conforming"}),
    "marker changed": (marker_changed, {"wrong_marker"}),
    "label changed": (label_changed, {"wrong_region"}),
    "void filled": (void_filled, {"hole_filled"}),
    "cell dropped": (cell_dropped, {"bad_link", "stray_constraint"}),
    "cell dropped with its walls": (cell_dropped_with_its_walls, BORDER | {"wrong_volume"}),
    "cell twice": (cell_twice, {"bad_link"}),
    "vertex moved": (vertex_moved, BORDER),
    "reason false": (reason_false, {"bad_reason", "over_radius_edge"}),
}


def marked(shape):
    """Each piece of the shape with a marker of its own."""
    given = shape.input()
    name = "segments" if given.dimension == 2 else "facets"
    return given.replaced(**{name: [(*piece[:-1], i + 1) for i, piece in enumerate(getattr(given, name))]})


def lake():
    """And the land around it, each with a border of its own."""
    s = shapes.Shape(2)
    s.ring([(0, 0), (8, 0), (8, 6), (0, 6)])
    s.ring([(2, 1), (4, 1), (6, 1), (6, 4), (2, 4)])
    s.ring([(2, 1), (6, 1), (6, 2), (6, 4), (5, 4), (3, 4), (2, 4), (2, 2)])
    s.ring([(1, 5), (2, 5), (2, 5.5), (1, 5.5)])
    s.holes, s.regions = [(1.5, 5.2)], [((3.0, 2.0), 1.0), ((7.0, 5.0), 2.0)]
    return s


def spikes():
    """A room with narrow corners at its two ends."""
    s = shapes.Shape(2)
    s.ring([(-8, 0), (0, -1), (8, 0), (1, 0.4), (1, 3), (-1, 3), (-1, 0.4)])
    return s


def blades():
    """3D: the same, upright."""
    s = shapes.Shape(3)
    s.prism([(-8, 0), (0, -1), (8, 0), (1, 0.4), (1, 3), (-1, 3), (-1, 0.4)], 0, 2)
    return s


def pit():
    """A void that stands on the floor of a room, so that a part of the floor is in the mesh, and another void in its middle."""
    s = shapes.Shape(3)
    s.box((0, 0, 0), (4, 4, 3))
    s.box((1, 1, 0), (2, 2, 1))
    s.box((2.5, 2.5, 1), (3.5, 3, 2))
    s.facet([(0, 0, 2.5), (4, 0, 2.5), (4, 4, 2.5), (0, 4, 2.5)])
    s.holes, s.regions = [(1.5, 1.5, 0.5), (3.0, 2.7, 1.5)], [((0.2, 0.2, 0.2), 1.0), ((0.2, 0.2, 2.8), 2.0)]
    return s


def sheets():
    """A cube with two loose walls, one of which ends on the other."""
    s = shapes.Shape(3)
    s.box((0, 0, 0), (3, 3, 3))
    s.facet([(1, 0.5, 0.5), (1, 2.5, 0.5), (1, 2.5, 2.5), (1, 0.5, 2.5)])
    s.facet([(1, 1.5, 1), (2.5, 1.5, 1), (2.5, 1.5, 2), (1, 1.5, 2)])
    return s


MODELS = {  # and the flags; whether pieces overlap, so that markers of several may be right
    "lake": (lake, ["--size", "0.8"], True), "rooms": (shapes.rooms, ["--size", "2"], True),
    "rings": (shapes.rings, ["--size", "1"], False), "parcels": (shapes.parcels, ["--size", "4"], True),
    "pipes": (shapes.pipes, [], False), "cracked_plate": (shapes.cracked_plate, [], False), "spikes": (spikes, ["--size", "0.1"], False),
    "pit": (pit, ["--size", "0.7"], True), "sheets": (sheets, ["--size", "0.8"], False), "blades": (blades, ["--size", "0.4"], False),
    "refined_blades": (blades, ["--size", "0.4", "--no-optimize"], False),
    "box_on_floor": (shapes.box_on_floor, ["--size", "0.7"], True), "half_faces": (shapes.half_faces, ["--size", "0.8"], True),
    "lead": (shapes.lead, [], False), "layers": (shapes.layers, [], False), "tunnel": (shapes.tunnel, [], False),
    "crossing": (shapes.crossing_boxes, ["--size", "0.8"], True),
}


class Model:
    """A right mesh, and what it is a mesh of."""

    def __init__(self, command, name, folder):
        make, self.flags, self.has_overlaps = MODELS[name]
        self.command, self.name, self.folder, self.input, self.filled = command, name, folder, marked(make()), []
        self.mesh = self.meshed(self.input)
        self.report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
        input_files.write_poly(self.input, folder / "input.poly")
        code, _ = self.checked(self.mesh, self.report)
        self.is_refused = code not in DONE

    def pgdr(self, *arguments):
        return subprocess.run([self.command, *map(str, arguments)], capture_output=True, text=True, stdin=subprocess.DEVNULL,
                              timeout=600, check=False)

    def meshed(self, given):
        file, mesh = self.folder / "given.poly", self.folder / "given.mesh"
        input_files.write_poly(given, file)
        done = self.pgdr("mesh", file, "-o", mesh, "--report", self.folder / "report.json", "--quiet", *self.flags)
        if done.returncode not in DONE:
            raise RuntimeError(f"{self.name}: mesh ended with {done.returncode}: {done.stderr.strip()[:300]}")
        return Mesh(mesh)

    def checked(self, mesh, report):
        """The exit code, and the kinds of findings."""
        mesh.write(self.folder / "other.mesh")
        (self.folder / "other.json").write_text(json.dumps(report), encoding="utf-8")
        done = self.pgdr("check", self.folder / "other.mesh", "--input", self.folder / "input.poly", "--reasons",
                         self.folder / "other.json", "--report", self.folder / "found.json", "--quiet")
        if done.returncode not in (*DONE, 6):
            raise RuntimeError(f"{self.name}: check ended with {done.returncode}: {done.stderr.strip()[:300]}")
        found = json.loads((self.folder / "found.json").read_text(encoding="utf-8"))
        return done.returncode, {f["kind"] for f in found["findings"]}


class Table:
    """What became of the faults of each kind."""

    def __init__(self):
        self.refused, self.findings, self.complaints = collections.Counter(), {kind: collections.Counter() for kind in KINDS}, []
        self.accepted, self.misnamed = collections.Counter(), collections.Counter()

    def add(self, kind, where, code, found):
        if code in DONE:
            self.accepted[kind] += 1
            self.complaints.append(f"{kind}, {where}: accepted")
            return
        self.refused[kind] += 1
        self.findings[kind].update(found)
        if not found & KINDS[kind][1]:
            self.misnamed[kind] += 1
            self.complaints.append(f"{kind}, {where}: found {', '.join(sorted(found))}")

    def print(self):
        print(f"{'fault':28} refused accepted misnamed  findings")
        for kind in KINDS:
            found = ", ".join(f"{name} {n}" for name, n in self.findings[kind].most_common())
            print(f"{kind:28} {self.refused[kind]:7} {self.accepted[kind]:8} {self.misnamed[kind]:8}  {found}")
        totals = [sum(c.values()) for c in (self.refused, self.accepted, self.misnamed)]
        print(f"{'all':28} {totals[0]:7} {totals[1]:8} {totals[2]:8}")


def main(names):
    command, each = os.environ["PGDR_COMMAND"], int(os.environ.get("PGDR_MUTATIONS", "1"))
    table = Table()
    for name in names or MODELS:
        with tempfile.TemporaryDirectory(prefix="pgdr_") as folder:
            model = Model(command, name, pathlib.Path(folder))
            if model.is_refused:
                table.complaints.append(f"{name}: the right mesh is refused")
                continue
            for kind, (mutate, _) in KINDS.items():
                for seed in range(each):
                    made = mutate(model, random.Random(f"{name} {kind} {seed}"))
                    if made is None:
                        continue
                    mesh, report = made if isinstance(made, tuple) else (made, model.report)
                    table.add(kind, f"{name} {seed}", *model.checked(mesh, report))
    table.print()
    if not names:
        table.complaints += [f"no fault of the kind: {kind}" for kind in KINDS if not table.refused[kind]]
    for complaint in table.complaints:
        print(complaint)
    return 1 if table.complaints else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
