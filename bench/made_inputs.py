# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs that the benchmarks make: the unit cube, and a ball with bumps of as many triangles as are wanted. `bat.py` makes another."""
import itertools
import math
import pathlib


def write_cube(path):
    corners = [(i & 1, i >> 1 & 1, i >> 2) for i in range(8)]
    sides = ["0 1 3 2", "4 5 7 6", "0 1 5 4", "2 3 7 6", "0 2 6 4", "1 3 7 5"]
    rows = ["8 3 0 0"] + [f"{i} {x} {y} {z}" for i, (x, y, z) in enumerate(corners)]
    rows += ["6 0"] + [f"1\n4 {s}" for s in sides] + ["0", "0"]
    pathlib.Path(path).write_text("\n".join(rows) + "\n", encoding="utf-8")


def ball(squares):
    """(points, triangles): the sides of a cube, each a grid of so many squares along an edge, blown up; a twentieth higher and lower.

    Rounded, so that every machine makes the same.
    """
    numbers, triangles = {}, []
    for axis, end in itertools.product(range(3), (0, squares)):
        for i, j in itertools.product(range(squares), repeat=2):
            ids = []
            for u, v in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                place = [0, 0, 0]
                place[axis], place[(axis + 1) % 3], place[(axis + 2) % 3] = end, u, v
                ids.append(numbers.setdefault(tuple(place), len(numbers)))
            a, b, c, d = ids if end else ids[::-1]
            triangles += [(a, b, c), (a, c, d)]
    along = [math.tan(math.pi / 4 * (2 * i / squares - 1)) for i in range(squares + 1)]
    points = []
    for place in numbers:
        cube = [along[i] for i in place]
        x, y, z = (c / math.hypot(*cube) for c in cube)
        height = 1 + math.sin(9 * x) * math.sin(8 * y) * math.sin(7 * z) / 20
        points.append(tuple(round(height * c, 9) for c in (x, y, z)))
    return points, triangles


def write_off(path, points, triangles):
    rows = [f"OFF\n{len(points)} {len(triangles)} 0"] + [f"{x:.9f} {y:.9f} {z:.9f}" for x, y, z in points]
    pathlib.Path(path).write_text("\n".join(rows + [f"3 {a} {b} {c}" for a, b, c in triangles]) + "\n", encoding="utf-8")


def write_million(path):
    """A ball of 1,002,252 triangles."""
    write_off(path, *ball(289))
