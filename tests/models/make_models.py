#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the models that ship with the project: bracket.poly, rocket.poly (3D, TetGen), plate.poly and river.poly
(2D, Triangle).

Usage: make_models.py [FOLDER]     (default: the folder of this script)

bracket: an angle bracket, an L profile with rounded inner corner and chamfered outer edges, extruded along y, with two
round holes in its base and one in its upright. Polygons stand for arcs. Every angle between facets, and between edges,
is 90 degrees or more, so every bound of the theory can be met.

rocket: a rocket in a box of air: an octagonal body with a blunt nose and a nozzle, and four fins, sheets without thickness
that meet the body in its edges. Both the rocket (region 1) and the air (region 2) are meshed.
"""
import math
import os
import sys


def arc(cu, cv, radius, start, end, steps):
    """Points of an arc, angles in degrees, rounded so that the file is short."""
    angles = [math.radians(start + (end - start) * i / steps) for i in range(steps + 1)]
    return [(round(cu + radius * math.cos(a), 4), round(cv + radius * math.sin(a), 4)) for a in angles]


class Solid:
    """Points without duplicates, and facets: a list of polygons, seeds of their holes, a marker."""

    def __init__(self):
        self.points, self.number, self.facets, self.regions = [], {}, [], []

    def point(self, p):
        if p not in self.number:
            self.number[p] = len(self.points)
            self.points.append(p)
        return self.number[p]

    def facet(self, polygons, holes, marker):
        self.facets.append(([[self.point(p) for p in polygon] for polygon in polygons], holes, marker))

    def write(self, path, comment):
        with open(path, "w", encoding="ascii") as out:
            out.write(comment)
            out.write(f"{len(self.points)} 3 0 0\n")
            for i, p in enumerate(self.points):
                out.write(f"{i} " + " ".join(f"{c:g}" for c in p) + "\n")
            out.write(f"{len(self.facets)} 1\n")
            for polygons, holes, marker in self.facets:
                out.write(f"{len(polygons)} {len(holes)} {marker}\n")
                for polygon in polygons:
                    out.write(f"{len(polygon)} " + " ".join(map(str, polygon)) + "\n")
                for i, hole in enumerate(holes):
                    out.write(f"{i} " + " ".join(f"{c:g}" for c in hole) + "\n")
            out.write(f"0\n{len(self.regions)}\n")
            for i, (seed, attribute) in enumerate(self.regions):
                out.write(f"{i} " + " ".join(f"{c:g}" for c in seed) + f" {attribute}\n")


def bracket():
    width, thick, long, tall = 4.0, 0.8, 5.0, 4.0
    fillet, chamfer, steps = 0.8, 0.2, 4
    # the L profile in (x, z), counter-clockwise: base, end of the base, inner corner, upright, heel
    profile = [(chamfer, 0.0), (long - chamfer, 0.0), (long, chamfer), (long, thick)]
    profile += arc(thick + fillet, thick + fillet, fillet, 270, 180, steps)
    profile += [(thick, tall), (chamfer, tall), (0.0, tall - chamfer), (0.0, chamfer)]

    circle = lambda u, v, r, n: arc(u, v, r, 0, 360, n)[:-1]
    base_holes = [circle(3.6, 1.0, 0.4, 12), circle(3.6, 3.0, 0.4, 12)]  # in (x, y), along z
    upright_holes = [circle(2.0, 2.7, 0.7, 16)]  # in (y, z), along x

    s = Solid()
    for y, marker in ((0.0, 1), (width, 2)):
        s.facet([[(x, y, z) for x, z in profile]], [], marker)
    for (x0, z0), (x1, z1) in zip(profile, profile[1:] + profile[:1]):
        side = [(x0, 0.0, z0), (x1, 0.0, z1), (x1, width, z1), (x0, width, z0)]
        holes, marker = [], 3
        if z0 == z1 == 0.0 or (z0 == z1 == thick and x0 > thick):  # under and over the base
            holes, marker = [[(x, y, z0) for x, y in h] for h in base_holes], 4
            seeds = [(3.6, 1.0, z0), (3.6, 3.0, z0)]
        elif x0 == x1 and x0 in (0.0, thick):  # the faces of the upright
            holes, marker = [[(x0, y, z) for y, z in h] for h in upright_holes], 5
            seeds = [(x0, 2.0, 2.7)]
        s.facet([side] + holes, seeds if holes else [], marker)
    for hole in base_holes:
        for (x0, y0), (x1, y1) in zip(hole, hole[1:] + hole[:1]):
            s.facet([[(x0, y0, 0.0), (x1, y1, 0.0), (x1, y1, thick), (x0, y0, thick)]], [], 6)
    for hole in upright_holes:
        for (y0, z0), (y1, z1) in zip(hole, hole[1:] + hole[:1]):
            s.facet([[(0.0, y0, z0), (0.0, y1, z1), (thick, y1, z1), (thick, y0, z0)]], [], 7)
    return s


def rocket():
    octagon = [(1.0, 0.5), (0.5, 1.0), (-0.5, 1.0), (-1.0, 0.5), (-1.0, -0.5), (-0.5, -1.0), (0.5, -1.0), (1.0, -0.5)]
    at = lambda i, scale, z: (scale * octagon[i][0], scale * octagon[i][1], z)
    ring = lambda scale, z: [at(i, scale, z) for i in range(8)]  # binary fractions, so that every facet is planar
    exhaust, throat, base, shoulder, nose = ring(0.375, -1.0), ring(0.5, 0.0), ring(1.0, 0.0), ring(1.0, 6.0), ring(0.25, 7.5)
    s = Solid()
    s.facet([exhaust], [], 1)
    s.facet([base, throat], [(0.0, 0.0, 0.0)], 1)
    s.facet([nose], [], 1)
    for low, high in ((exhaust, throat), (shoulder, nose)):
        for i in range(8):
            j = (i + 1) % 8
            s.facet([[low[i], low[j], high[j], high[i]]], [], 1)
    for i in range(8):  # the body's sides, with the fins' upper ends on every other edge
        j = (i + 1) % 8
        right = [at(j, 1.0, 2.0)] if j % 2 == 0 else []
        left = [at(i, 1.0, 2.0)] if i % 2 == 0 else []
        s.facet([[base[i], base[j]] + right + [shoulder[j], shoulder[i]] + left], [], 1)
        if i % 2 == 0:
            s.facet([[base[i], at(i, 2.0, -0.5), at(i, 2.0, 1.75), at(i, 1.0, 2.0)]], [], 2)
    corner = lambda i: (4.0 if i & 1 else -4.0, 4.0 if i & 2 else -4.0, 10.0 if i & 4 else -3.0)
    for face in ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)):
        s.facet([[corner(i) for i in face]], [], 3)
    s.regions = [((0.0, 0.0, 3.0), 1), ((3.5, 3.5, 9.5), 2)]
    return s


def write_loops(path, comment, loops, holes):
    """Closed polygons, one marker each, in Triangle's .poly."""
    points = [p for loop in loops for p in loop]
    with open(path, "w", encoding="ascii") as out:
        out.write(comment)
        out.write(f"{len(points)} 2 0 0\n")
        for i, (x, y) in enumerate(points, 1):
            out.write(f"{i} {x:g} {y:g}\n")
        out.write(f"{len(points)} 1\n")
        first = number = 1
        for marker, loop in enumerate(loops, 1):
            for i in range(len(loop)):
                out.write(f"{number} {first + i} {first + (i + 1) % len(loop)} {marker}\n")
                number += 1
            first += len(loop)
        out.write(f"{len(holes)}\n" + "".join(f"{i} {x:g} {y:g}\n" for i, (x, y) in enumerate(holes, 1)))


def plate(path):
    """A plate with two holes; its angles are 90 degrees or more."""
    outline = [(0, 0), (6, 0), (6, 2), (4.5, 2), (3.5, 3), (0, 3)]
    loops = [outline, arc(1.5, 1.5, 0.75, 0, 360, 16)[:-1], arc(5, 1, 0.4, 0, 360, 12)[:-1]]
    write_loops(path, "# A plate with two holes (Triangle's .poly). Made by make_models.py\n", loops, [(1.5, 1.5), (5, 1)])


def river(path):
    """A winding river with an island and two piers of a bridge, about 400 long."""
    def bank(x, side):
        middle = 200 + 55 * math.sin(x / 45) + 9 * math.sin(x / 13)
        return (x, round(middle + side * (22 + 7 * math.sin(x / 29 + side)), 3))

    steps = range(0, 401, 8)
    outline = [bank(x, -1) for x in steps] + [bank(x, 1) for x in reversed(steps)]
    mid = (bank(200, -1)[1] + bank(200, 1)[1]) / 2
    island = [(round(200 + 24 * math.cos(a), 3), round(mid + (6 + 2 * math.sin(3 * a)) * math.sin(a), 3))
              for a in (2 * math.pi * i / 28 for i in range(28))]
    piers, seeds = [], [(200, mid)]
    for x in (96, 104):
        y = (bank(x, -1)[1] + bank(x, 1)[1]) / 2 + (x - 100)
        piers.append([(x - 1, y - 2), (x + 1, y - 2), (x + 1, y + 2), (x, y + 3), (x - 1, y + 2)])
        seeds.append((x, y))
    write_loops(path, "# A river with an island and two piers (Triangle's .poly). Made by make_models.py\n",
                [outline, island] + piers, seeds)


if __name__ == "__main__":
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))
    bracket().write(os.path.join(folder, "bracket.poly"),
                    "# An angle bracket with three holes (TetGen's .poly). Made by make_models.py\n")
    rocket().write(os.path.join(folder, "rocket.poly"),
                   "# A rocket in a box of air (TetGen's .poly). Made by make_models.py\n")
    plate(os.path.join(folder, "plate.poly"))
    river(os.path.join(folder, "river.poly"))
