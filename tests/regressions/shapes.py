# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Made inputs of the kinds whose copies have gone wrong: walls that end on others, plates that touch, rods, roofs, layers. By name."""
import math

from input_files import Input


class Shape:
    """An input in the making; points are distinct."""

    def __init__(self, dimension):
        self.dimension, self.number, self.pieces, self.holes, self.regions, self.flags = dimension, {}, [], [], [], []
        self.may_cross = False  # an input in which facets cross may be refused

    def point(self, *p):
        return self.number.setdefault(tuple(map(float, p)), len(self.number))

    def segment(self, a, b):
        self.pieces.append((self.point(*a), self.point(*b), 0))

    def ring(self, points):
        for a, b in zip(points, [*points[1:], points[0]]):
            self.segment(a, b)

    def facet(self, *polygons, holes=(), marker=0):
        self.pieces.append(([[self.point(*p) for p in polygon] for polygon in polygons], list(holes), marker))

    def box(self, low, high, without=()):
        """Six facets; `without`: (axis, end) of those that are left out."""
        for axis in range(3):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            for end, at in enumerate((low, high)):
                if (axis, end) in without:
                    continue
                corners = []
                for i, k in ((low[u], low[v]), (high[u], low[v]), (high[u], high[v]), (low[u], high[v])):
                    p = [0, 0, 0]
                    p[axis], p[u], p[v] = at[axis], i, k
                    corners.append(p)
                self.facet(corners)

    def prism(self, outline, low, high, caps=True):
        """Walls over an outline of the plane, and floor and roof."""
        for a, b in zip(outline, [*outline[1:], outline[0]]):
            self.facet([(*a, low), (*b, low), (*b, high), (*a, high)])
        if caps:
            for z in (low, high):
                self.facet([(*p, z) for p in outline])

    def input(self):
        lists = {"segments": self.pieces} if self.dimension == 2 else {"facets": self.pieces}
        return Input(self.dimension, list(self.number), holes=self.holes, regions=self.regions, **lists)


def circle(n, radius, centre=(0, 0), start=0.0):
    return [(centre[0] + radius * math.cos(start + 2 * math.pi * i / n), centre[1] + radius * math.sin(start + 2 * math.pi * i / n))
            for i in range(n)]


def rooms():
    """A floor plan: walls that end on others, where these have no point."""
    s = Shape(2)
    s.ring([(0, 0), (10, 0), (10, 6), (0, 6)])
    for a, b in (((4, 0), (4, 6)), ((4, 2), (10, 2)), ((7, 2), (7, 6)), ((0, 3.5), (4, 3.5)), ((8.5, 2), (8.5, 0))):
        s.segment(a, b)
    s.regions = [((1.0, 1.0), 1.0), ((8.0, 5.0), 2.0)]
    return s


def parcels():
    """Two plots with a common border on which they have different points, at thirds and fifths."""
    s = Shape(2)
    border = [(6, 10 * t) for t in (0, 1)]
    s.ring([(0, 0), border[0], *[(6, 10 * k / 3) for k in (1, 2)], border[1], (0, 10)])
    s.ring([(13, 1), (13, 9), border[1], *[(6, 10 * k / 5) for k in (4, 3, 2, 1)], border[0]])
    s.regions = [((1.0, 1.0), 1.0), ((12.0, 5.0), 2.0)]
    return s


def octagon():
    """With the midpoints of its sides as points of their own."""
    s = Shape(2)
    outline = circle(8, 5)
    s.ring(outline)
    for a, b in zip(outline, [*outline[1:], outline[0]]):
        s.point((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
    return s


def rings():
    s = Shape(2)
    for radius in (4, 3, 1):
        s.ring(circle(24, radius))
    s.holes, s.regions = [(0.0, 0.0)], [((2.0, 0.1), 5.0)]
    return s


def bricks():
    """Courses of bricks, each shifted by a third of the one below."""
    s = Shape(2)
    s.ring([(0, 0), (9, 0), (9, 4), (0, 4)])
    for y in range(1, 4):
        s.segment((0, y), (9, y))
    for y in range(4):
        for x in range(3):
            at = 3 * x + 1 + y / 3
            s.segment((at, y), (at, y + 1))
    return s


def comb():
    s = Shape(2)
    outline = [(0, 0), (11, 0)]
    for k in range(10, 0, -1):
        outline += [(k + 0.4, 3), (k, 3), (k, 1), (k - 0.6, 1)]
    s.ring([*outline[:-2], (0, 3)])
    return s


def cracked_plate():
    """A plate with cracks that end in it, on its rim, and on each other."""
    s = Shape(2)
    s.ring([(-2, -2), (2, -2), (2, 2), (-2, 2)])
    s.segment((-2, 0.5), (0.5, 0.25))
    s.segment((0.5, 0.25), (1, 1))
    s.segment((-1, -1.5), (1.5, -1.25))
    return s


def mosaic():
    """Six by six squares, each with both or one of its diagonals."""
    s = Shape(2)
    for x in range(6):
        for y in range(6):
            s.ring([(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)])
            s.segment((x, y), (x + 0.5, y + 0.5))
            if (x + y) % 2:
                s.segment((x + 1, y), (x + 0.5, y + 0.5))
    s.pieces = sorted({(min(a, b), max(a, b), m) for a, b, m in s.pieces})
    return s


def star():
    s = Shape(2)
    s.ring([p for pair in zip(circle(7, 3), circle(7, 1.2, start=math.pi / 7)) for p in pair])
    return s


def pipes():
    """A square with 9 round holes, named by seeds."""
    s = Shape(2)
    s.ring([(0, 0), (9, 0), (9, 9), (0, 9)])
    for x in (2, 4.5, 7):
        for y in (2, 4.5, 7):
            s.ring(circle(12, 0.8, (x, y)))
            s.holes.append((float(x), float(y)))
    return s


def grid():
    """Points without segments."""
    s = Shape(2)
    for x in range(6):
        for y in range(6):
            s.point(x, y / 3)
    s.flags = ["--convex-hull"]
    return s


def house():
    s = Shape(3)
    front = [(0, 0), (8, 0), (8, 5), (4, 8), (0, 5)]
    for y in (0, 40):
        s.facet([(x, y, z) for x, z in front])
    for (x, z), (u, w) in zip(front, [*front[1:], front[0]]):
        s.facet([(x, 0, z), (u, 0, w), (u, 40, w), (x, 40, z)])
    return s


def tunnel():
    """Rock with a tunnel of 16 sides, whose mouths are holes of facets."""
    s = Shape(3)
    s.box((-20, 0, -20), (20, 100, 20), without=((1, 0), (1, 1)))
    mouth = circle(16, 5)
    for y in (0, 100):
        s.facet([(-20, y, -20), (20, y, -20), (20, y, 20), (-20, y, 20)], [(x, y, z) for x, z in mouth], holes=[(0.0, float(y), 0.0)])
    for (x, z), (u, w) in zip(mouth, [*mouth[1:], mouth[0]]):
        s.facet([(x, 0, z), (u, 0, w), (u, 100, w), (x, 100, z)])
    return s


def crossing_boxes():
    """Boxes in each other, of which two facets cross where neither has an edge of its own."""
    s = Shape(3)
    for low, high in (((3, 2, 3), (5, 3, 4)), ((0, 2, 1), (4, 5, 4)), ((2, 3, 3), (4, 5, 4))):
        s.box(low, high)
    return s


def rod():
    s = Shape(3)
    s.prism(circle(12, 0.635), 0, 20)
    return s


def pile():
    s = Shape(3)
    s.prism(circle(6, 0.4), 0, 6)
    return s


def walls():
    """A hall with walls that end on its floor, its roof and each other, which have no edges there."""
    s = Shape(3)
    s.box((0, 0, 0), (8, 6, 3))
    s.facet([(3, 0, 0), (3, 6, 0), (3, 6, 3), (3, 0, 3)])
    s.facet([(3, 2, 0), (8, 2, 0), (8, 2, 3), (3, 2, 3)])
    s.regions = [((1.0, 1.0, 1.0), 1.0), ((5.0, 1.0, 1.0), 2.0), ((5.0, 5.0, 1.0), 3.0)]
    return s


def layers():
    """Soil in layers that share their sides' edges, with labels."""
    s = Shape(3)
    heights = (0, 1, 1.5, 3)
    for low, high in zip(heights, heights[1:]):
        s.prism([(0, 0), (6, 0), (6, 4), (0, 4)], low, high, caps=False)
        s.regions.append(((1.0, 1.0, (low + high) / 2), float(low + high)))
    for z in heights:
        s.facet([(0, 0, z), (6, 0, z), (6, 4, z), (0, 4, z)], marker=int(2 * z))
    return s


def box_on_floor():
    """In a room, without an edge of it in the floor."""
    s = Shape(3)
    s.box((0, 0, 0), (3, 3, 3))
    s.box((1, 1, 0), (2, 2, 1))
    s.regions = [((0.5, 0.5, 0.5), 1.0), ((1.5, 1.5, 0.5), 2.0)]
    return s


def half_faces():
    """Two boxes that touch at half a face of each."""
    s = Shape(3)
    s.box((0, 0, 0), (2, 2, 2))
    s.box((2, 1, 0), (4, 3, 2))
    s.regions = [((1.0, 1.0, 1.0), 1.0), ((3.0, 2.0, 1.0), 2.0)]
    return s


def lead():
    """A rod of rings in a box, for a hole of it."""
    s = Shape(3)
    s.box((-3, -3, -1), (3, 3, 9))
    outline = circle(8, 0.635)
    for low in range(0, 8, 2):
        s.prism(outline, low, low + 2, caps=False)
    for z in range(0, 10, 2):
        s.facet([(*p, z) for p in outline])
    s.regions = [((0.0, 0.0, 3.0), 7.0)]
    s.holes = [(0.0, 0.0, 1.0)]
    return s


def cells():
    """A cube in 27, as facets of all their faces."""
    s = Shape(3)
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for at in range(4):
            for i in range(3):
                for k in range(3):
                    corners = []
                    for a, b in ((i, k), (i + 1, k), (i + 1, k + 1), (i, k + 1)):
                        p = [0, 0, 0]
                        p[axis], p[u], p[v] = at, a, b
                        corners.append(p)
                    s.facet(corners)
    s.regions = [((1.5, 1.5, 1.5), 4.0)]
    return s


def terrain():
    """A block under triangles of a survey, with walls of many corners."""
    s, n = Shape(3), 5

    def at(x, y):
        return (2 * x, 2 * y, round(math.sin(x) + math.cos(2 * y), 2))

    for x in range(n):
        for y in range(n):
            s.facet([at(x, y), at(x + 1, y), at(x + 1, y + 1)])
            s.facet([at(x, y), at(x + 1, y + 1), at(x, y + 1)])
    rim = [*[(k, 0) for k in range(n)], *[(n, k) for k in range(n)], *[(n - k, n) for k in range(n)], *[(0, n - k) for k in range(n)]]
    for side in range(4):
        top = [at(*rim[(side * n + k) % len(rim)]) for k in range(n + 1)]
        s.facet([*top, (*top[-1][:2], -5), (*top[0][:2], -5)])
    s.facet([(0, 0, -5), (2 * n, 0, -5), (2 * n, 2 * n, -5), (0, 2 * n, -5)])
    return s


PLANAR = (rooms, parcels, octagon, rings, bricks, comb, cracked_plate, mosaic, star, pipes, grid)
SPATIAL = (house, tunnel, rod, pile, walls, layers, box_on_floor, half_faces, lead, cells, terrain)
ALL = {make.__name__: make for make in (*PLANAR, *SPATIAL)}
