# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Random inputs of boxes of which a part of a facet is not in the mesh: voids on a floor, bodies on plates, cities.

    PGDR_COMMAND=build/release/pgdr python3 tests/regressions/random_models.py [--models N] [--first SEED] [--optimize] [KIND ...]

meshes N models of each kind, as they are, turned and at coordinates of UTM, and holds that each has its volume and that `pgdr check`
takes its mesh. Whoever changes how a mesh is compared with its input runs some hundred; a few are a test (copies.py has others).
"""
import argparse
import itertools
import os
import pathlib
import random
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "oracles"))

import given_volumes
import input_files
import motions
from shapes import Shape

COMMAND = os.environ.get("PGDR_COMMAND", "pgdr")


def overlap(a, b):
    """Of boxes, given by two corners: they have a volume in common."""
    return all(a[0][k] < b[1][k] and b[0][k] < a[1][k] for k in range(3))


def volume(box):
    x, y, z = (high - low for low, high in zip(*box))
    return x * y * z


def middle(box):
    return tuple((low + high) / 2 for low, high in zip(*box))


def random_boxes(rng, count, low, high, apart=False):
    """Of whole coordinates, with no volume in common; they may touch, unless they are `apart`. low and high: of their corners."""
    boxes = []
    for _ in range(20 * count):
        corners = [sorted(rng.sample(range(a, b + 1), 2)) if b > a else None for a, b in zip(low, high)]
        box = tuple(tuple(c[end] for c in corners) for end in (0, 1))
        wide = tuple(tuple(c + (2 * end - 1) for c in box[end]) for end in (0, 1)) if apart else box
        if not any(overlap(wide, other) for other in boxes):
            boxes.append(box)
        if len(boxes) == count:
            break
    return boxes


def on_floor(rng, boxes, at=0):
    """The same, let down to the floor, where they do not overlap there."""
    down = []
    for low, high in boxes:
        box = ((*low[:2], at), (*high[:2], at + high[2] - low[2]))
        if not any(overlap(box, other) for other in down):
            down.append(box)
    return down


def voids_on_floor(rng):
    """Voids by hole seeds that stand on the floor of a room, one or two also at a wall or on each other."""
    s, size = Shape(3), 10
    s.box((0, 0, 0), (size, size, size))
    low = rng.choice((0, 1))
    boxes = on_floor(rng, random_boxes(rng, rng.randint(1, 6), (low, low, 1), (size - low, size - low, 6)))
    if rng.random() < 0.3:
        base = rng.choice(boxes)
        top = base[1][2]
        upper = ((*base[0][:2], top), (base[1][0], base[1][1], top + 1))
        if not any(overlap(upper, b) for b in boxes):
            boxes.append(upper)
    for box in boxes:
        s.box(*box, without=[(2, 0)] if rng.random() < 0.2 else ())
        s.holes.append(middle(box))
    return s, size ** 3 - sum(map(volume, boxes))


def auto_voids(rng):
    """Voids by nesting, without seeds, some of which touch."""
    s, size = Shape(3), 10
    s.box((0, 0, 0), (size, size, size))
    boxes = random_boxes(rng, rng.randint(1, 7), (1, 1, 1), (size - 1, size - 1, size - 1))
    for box in boxes:
        s.box(*box)
    s.flags = ["--regions", "auto"]
    return s, size ** 3 - sum(map(volume, boxes))


def floating_voids(rng):
    """Voids by hole seeds in the middle of a room, some of which touch."""
    s, size = Shape(3), 10
    s.box((0, 0, 0), (size, size, size))
    boxes = random_boxes(rng, rng.randint(2, 8), (1, 1, 1), (size - 1, size - 1, size - 1))
    for box in boxes:
        s.box(*box)
        s.holes.append(middle(box))
    return s, size ** 3 - sum(map(volume, boxes))


def bodies_on_plate(rng):
    """Bodies above and below a plate that sticks out beyond them, sometimes two plates that overlap."""
    s = Shape(3)
    boxes = random_boxes(rng, rng.randint(1, 5), (-4, -4, 1), (5, 5, 5))
    bodies = on_floor(rng, boxes)
    if rng.random() < 0.5:
        bodies += [((*low[:2], low[2] - high[2]), (*high[:2], 0))
                   for low, high in on_floor(rng, random_boxes(rng, rng.randint(1, 3), (-4, -4, 1), (5, 5, 4)))]
    for box in bodies:
        s.box(*box, without=[(2, 0)] if box[0][2] == 0 and rng.random() < 0.3 else ())
    a, b = rng.randint(5, 7), rng.randint(5, 7)
    s.facet([(-a, -b, 0), (b, -a, 0), (a, b, 0), (-b, a, 0)])
    if rng.random() < 0.5:
        s.facet([(-8, -1, 0), (8, -2, 0), (9, 2, 0), (-9, 1, 0)])
    return s, sum(map(volume, bodies))


def tents_on_plate(rng):
    """Tetrahedra that stand on a plate with a corner or a facet, at odd places."""
    s, total, used = Shape(3), 0.0, []
    for _ in range(rng.randint(1, 6)):
        x, y = rng.randint(-5, 3), rng.randint(-5, 3)
        if any(abs(x - u) < 3 and abs(y - v) < 3 for u, v in used):
            continue
        used.append((x, y))
        base = [(x, y, 0), (x + rng.randint(1, 2), y + rng.choice((0, 1)), 0), (x + rng.choice((0, 1)), y + 2, 0)]
        tip = (x + 1, y + 1, rng.choice((-3, 2)))
        for i, j, k in ((0, 1, 2), (0, 1, 3), (1, 2, 3), (2, 0, 3)):
            corners = [*base, tip]
            s.facet([corners[i], corners[j], corners[k]])
        u, v = ([b - a for a, b in zip(base[0], p)] for p in base[1:])
        total += abs((u[0] * v[1] - u[1] * v[0]) * tip[2]) / 6
    s.facet([(-7, -6, 0), (6, -7, 0), (7, 6, 0), (-6, 7, 0)])
    return s, total


def plates(rng):
    """A room with plates in the planes of two of its walls: on them, half on them and beside them."""
    s, size, axis = Shape(3), 6, rng.randrange(3)
    s.box((0, 0, 0), (size, size, size))
    for _ in range(rng.randint(1, 6)):
        at = rng.choice((0, size))
        u, v = (axis + 1) % 3, (axis + 2) % 3
        (a, b), (c, d) = (sorted(rng.sample(range(-4, size + 5), 2)) for _ in range(2))
        corners = []
        for i, k in ((a, c), (b, c), (b, d), (a, d)):
            p = [0, 0, 0]
            p[axis], p[u], p[v] = at, i, k
            corners.append(p)
        if rng.random() < 0.5:
            s.facet(corners)
        else:
            s.facet(corners[:3])
            s.facet([corners[0], *corners[2:]])
    return s, size ** 3


def city(rng):
    """Buildings on a ground, as holes of the air above; some have a wall in common."""
    s, n, total = Shape(3), rng.randint(2, 4), 0
    width = 40 * n + 20
    s.box((0, 0, 0), (width, width, 200))
    for i in range(n):
        for k in range(n):
            if rng.random() < 0.2:
                continue
            x, y = 40 * i + rng.randint(10, 20), 40 * k + rng.randint(10, 20)
            box = ((x, y, 0), (x + rng.randint(5, 28), y + rng.randint(5, 28), rng.randint(5, 150)))
            boxes = [box]
            if rng.random() < 0.4:
                cut = rng.randint(box[0][0] + 1, box[1][0] - 1)
                boxes = [(box[0], (cut, *box[1][1:])), ((cut, *box[0][1:]), (*box[1][:2], rng.randint(5, 150)))]
            for b in boxes:
                s.box(*b)
                s.holes.append(middle(b))
                total += volume(b)
    return s, width * width * 200 - total


def doors(rng):
    """Rooms side by side with doors in the walls between, as facets of their own; one of the rooms may be a hole."""
    s, n = Shape(3), rng.randint(2, 3)
    for i in range(n):
        s.box((6 * i, 0, 0), (6 * i + 6, 8, 4))
        if i:
            y = rng.randint(1, 6)
            z = rng.randint(0, 1)
            s.facet([(6 * i, y, z), (6 * i, y + 1, z), (6 * i, y + 1, z + 2), (6 * i, y, z + 2)], marker=3)
    hole = rng.randrange(n)
    s.holes.append((6 * hole + 2.5, 4.5, 2.5))
    s.facet([(-3, -2, 0), (6 * n + 2, -3, 0), (6 * n + 3, 11, 0), (-2, 10, 0)])
    return s, 192 * (n - 1)


def given_twice(rng):
    """Bodies that touch, with facets given again: whole, with further points on the edges, or in triangles about a point within."""
    s = Shape(3)
    boxes = random_boxes(rng, rng.randint(1, 4), (0, 0, 0), (6, 6, 6))
    for box in boxes:
        s.box(*box)
        s.regions.append((middle(box), float(len(s.regions) + 1)))
    ways = rng.choice(((0,), (1,), (0, 1, 2), (0, 1, 2, 3)))  # 3: not again
    for polygons, _, _ in list(s.pieces):
        corners = [list(s.number)[v] for v in polygons[0]]
        about = tuple(sum(c) / 4 for c in zip(*corners))
        halves = [tuple((a + b) / 2 for a, b in zip(p, q)) for p, q in zip(corners, [*corners[1:], corners[0]])]
        way = rng.choice(ways)
        if way == 0:
            s.facet([p for pair in zip(corners, halves) for p in pair])
        elif way == 1:
            for p, q in zip(corners, [*corners[1:], corners[0]]):
                s.facet([p, q, about])
        elif way == 2:
            s.facet([corners[0], halves[0], halves[2], corners[3]])
            s.facet([halves[0], corners[1], corners[2], halves[2]])
    return s, sum(map(volume, boxes))


def divided(rng):
    """A box in a box, cut by walls that end on others where these have no points; some of the rooms are holes, so is at times what is
    around them."""
    s, rooms = Shape(3), [((1, 1, 1), (9, 9, 9))]
    s.box((0, 0, rng.choice((0, 1))), (10, 10, 10))
    s.box(*rooms[0])
    around = ((0, 0, min(p[2] for p in s.number)), (10, 10, 10))
    for _ in range(rng.randint(1, 8)):
        low, high = room = rng.choice(rooms)
        axis = rng.randrange(3)
        if high[axis] - low[axis] < 2:
            continue
        at = rng.randint(low[axis] + 1, high[axis] - 1)
        u, v = (axis + 1) % 3, (axis + 2) % 3
        corners = []
        for i, k in ((low[u], low[v]), (high[u], low[v]), (high[u], high[v]), (low[u], high[v])):
            p = [0, 0, 0]
            p[axis], p[u], p[v] = at, i, k
            corners.append(p)
        s.facet(corners)
        rooms.remove(room)
        rooms += [(low, tuple(at if k == axis else c for k, c in enumerate(high))),
                  (tuple(at if k == axis else c for k, c in enumerate(low)), high)]
    kept = [room for room in rooms if rng.random() < 0.4] or rooms[:1]
    s.holes = [middle(room) for room in rooms if room not in kept]
    if rng.random() < 0.5:
        s.holes.append((0.5, 0.5, 5))
        return s, sum(map(volume, kept))
    return s, volume(around) - 8 ** 3 + sum(map(volume, kept))


def crossing_boxes(rng):
    """Boxes in and through each other. What crosses where it has no edge in common is refused; where both facets have points at the ends
    of what they have in common it may be an edge of each, and the line is in the mesh. Some are holes of what they are in."""
    s, size, filled = Shape(3), 5, set()
    s.may_cross = True
    for _ in range(rng.randint(2, 4)):
        low, high = zip(*(sorted(rng.sample(range(size + 1), 2)) for _ in range(3)))
        s.box(low, high)
        filled |= set(itertools.product(*(range(a, b) for a, b in zip(low, high))))
    if rng.random() < 0.5:
        s.box((-1, -1, -1), (size + 1, size + 1, size + 1))
        s.holes = [tuple(x + 0.5 for x in cell) for cell in sorted(filled)]
        return s, (size + 2) ** 3 - len(filled)
    return s, len(filled)


def hair_gaps(rng):
    """Bodies with a gap between them that is as thin as a hair and that nobody wants to be meshed: side by side, with faces of other
    outlines, or one in the void of another, by nesting or with a hole seed."""
    s, hair, size = Shape(3), 10 ** rng.uniform(-6, -2), 10
    between = lambda low, high: round(rng.uniform(low, high), 3)
    if rng.random() < 0.5:
        room, body = ((2, 2, 2), (8, 8, 8)), ((2 + hair, between(3, 5), 2 + hair), (between(4, 7), 8 - hair, between(3, 6)))
        s.box((0, 0, 0), (size, size, size))
        s.box(*room)
        s.box(*body)
        if rng.random() < 0.5:
            s.holes.append((7.5, 2.5, 7))
        else:
            s.flags = ["--regions", "auto"]
        return s, size ** 3 - volume(room) + volume(body)
    bodies = [((0, 0, 0), (size, size, size))]
    for axis, side in rng.sample([(axis, side) for axis in range(3) for side in (0, 1)], rng.randint(1, 4)):
        low = [between(1, 5), between(1, 5), between(1, 5)]
        high = [x + between(1, 4) for x in low]  # opposite to a face of the first body, and to no other
        low[axis], high[axis] = (size + hair, size + between(2, 5)) if side else (-between(2, 5), -hair)
        bodies.append((tuple(low), tuple(high)))
    for body in bodies:
        s.box(*body)
    return s, sum(map(volume, bodies))


KINDS = {make.__name__: make for make in (voids_on_floor, auto_voids, floating_voids, bodies_on_plate, tents_on_plate, plates, city,
                                          doors, given_twice, divided, crossing_boxes, hair_gaps)}


def in_triangles(given, rng):
    """Each facet of one polygon in triangles of any diagonals that a fan of it has."""
    facets = []
    for polygons, holes, marker in given.facets:
        polygon = polygons[0]
        k = rng.randrange(len(polygon))
        polygon = polygon[k:] + polygon[:k]
        facets += [([[polygon[0], *pair]], holes, marker) for pair in zip(polygon[1:], polygon[2:])]
    return given.replaced(facets=facets)


def utm(given, _):
    copy = motions.mapped(given, lambda p: (p[0] + 4.3e5, p[1] + 5.1e6, p[2]))
    return copy, 1, motions.ulp_of(copy)


PLACES = {"as it is": lambda given, _: (given, 1, 0), "turned": motions.turned,
          "turned at UTM": lambda given, rng: utm(motions.turned(given, rng)[0], rng), "UTM": utm,
          "points of its own for each facet": motions.soup}


def model(kind, seed, place):
    """-> (input, volume, by how much rounding may change it, flags, whether it may be refused for facets that cross)"""
    rng = random.Random(f"{kind} {seed}")
    shape, expected = KINDS[kind](rng)
    given = shape.input()
    if seed % 2:
        given = in_triangles(given, rng)
    given, _, rounding = PLACES[place](given, rng)
    size = max(max(c) - min(c) for c in zip(*given.points))
    return given, expected, 1e-9 * expected + 40 * rounding * size * size, shape.flags, shape.may_cross


def complaints_about(given, expected, off, flags, may_cross, folder, optimize):
    path, mesh, report = folder / "model.poly", folder / "out.mesh", folder / "report.json"
    input_files.write_poly(given, path)
    flags = [*flags, *([] if optimize else ["--no-optimize"])]

    def pgdr(*arguments):
        return subprocess.run([COMMAND, *map(str, arguments)], capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=300,
                              check=False)

    done = pgdr("mesh", path, "-o", mesh, "--report", report, "--quiet", *flags)
    if may_cross and done.returncode == 3 and ("intersect" in done.stderr or "crosses what is in it" in done.stderr):
        return
    if done.returncode not in (0, 1):
        yield f"mesh ended with {done.returncode}: {done.stderr.strip()[:300]}"
        return
    meshed = sum(given_volumes.Mesh(mesh).volumes().values())
    if abs(meshed - expected) > off:
        yield f"volume {float(meshed)!r}, not {expected!r} by {off:g}"
    checked = pgdr("check", mesh, "--input", path, "--reasons", report)
    if checked.returncode != done.returncode:
        yield f"check ended with {checked.returncode}, mesh with {done.returncode}: {checked.stdout.strip()[-300:]}{checked.stderr}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kinds", nargs="*", default=[], help=", ".join(KINDS))
    parser.add_argument("--models", type=int, default=3)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--optimize", action="store_true")
    parser.add_argument("--place", choices=PLACES, action="append")
    parser.add_argument("--keep", type=pathlib.Path, help="a folder for the inputs that failed")
    options = parser.parse_args()
    failed = 0
    for kind in options.kinds or KINDS:
        for place in options.place or PLACES:
            bad = 0
            for seed in range(options.first, options.first + options.models):
                given, expected, off, flags, may_cross = model(kind, seed, place)
                with tempfile.TemporaryDirectory(prefix="pgdr_") as name:
                    found = list(complaints_about(given, expected, off, flags, may_cross, pathlib.Path(name), options.optimize))
                for complaint in found:
                    print(f"{kind} {seed}, {place}: {complaint}", flush=True)
                if found and options.keep:
                    options.keep.mkdir(parents=True, exist_ok=True)
                    input_files.write_poly(given, options.keep / f"{kind}_{seed}_{place.replace(' ', '_')}.poly")
                bad += bool(found)
            print(f"{kind}, {place}: {bad} of {options.models}", flush=True)
            failed += bad
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
