#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""A thin-winged body in a box of air, in the manner of Table 3.5 of the dissertation: the model `bat` of the suite.

    bench/bat.py OUT.poly [--edge 0.16]

The flow goes towards -x, the wings reach along z and bend upwards along y. The body is a loft: its section at each z is a stadium, two
parallel lines with a half circle at either end, which is thick in the middle and thin as a membrane in the wings, and shrinks to a
point at either tip. It is smooth, closed and manifold, and void; the air around it is what is meshed. EDGE is the length of edges where
the surface is flat; around the rims of the wings they are shorter. Coordinates are rounded, so that every machine writes the same file.
"""
import argparse
import bisect
import itertools
import math
import pathlib

SPAN = 5.0      # from the middle to a tip
MEMBRANE = 0.1  # half of a wing's thickness
BODY = 0.9      # half of the body's
RIM_STEPS = 3   # edges around the half circle of a rim
GROWTH = 0.3    # of edge lengths, a unit of length away from a rim
CAMBER = 0.3    # height of the middle of a section above its ends, over half of its chord
SAMPLES = 60    # points on a line or quarter of a circle of a section; ten times as many along the span
AIR = ((-32.0, 24.0), (-21.6, 24.0), (-22.8, 22.8))
WAKE = ((-19.89, 6.50), (-5.65, 8.05), (-5.61, 5.61))  # the text's box of fine cells, about the bat and its trail
EDGE = 0.16     # of the surface's triangles
FINE, COARSE = 0.25, 0.5  # the text's bounds on circumradii, in that box and around it


def size_expression(scale=1.0):
    """The text's bound on circumradii, times `scale`, in the words of `pgdr mesh --size`."""
    inside = " && ".join(f"{axis} > {low:g} && {axis} < {high:g}" for axis, (low, high) in zip("xyz", WAKE))
    return f"({inside}) ? {FINE * scale:.9g} : {COARSE * scale:.9g}"


def shape(z):
    """Of the section at z: the middle of its chord, half of the chord, the height, and half of the thickness."""
    s, to_tip = abs(z) / SPAN, SPAN - abs(z)
    body = 1 / (1 + (z / 0.9) ** 4)
    scallops = 0.5 * math.sin(3 * math.pi * s) ** 2
    front, back = 2.2 - 1.2 * s * s + 1.6 * body, -2.0 + 2.2 * s * s + scallops - 1.5 * body
    thickness = MEMBRANE + (BODY - MEMBRANE) * body
    if to_tip < MEMBRANE:  # the rim of the tip is round, too
        thickness *= math.sqrt(1 - (1 - to_tip / MEMBRANE) ** 2)
    return (front + back) / 2, (front - back) / 2 * math.sqrt(1 - s ** 12), 1.8 * s * s - 0.6 * s ** 4, thickness


def section(z):
    """The section at z: four lines of many points, the rear rim from below, the top, the front rim and the bottom. A point is (x, y,
    distance from the next rim)."""
    middle, half, height, t = shape(z)
    flat = half - t
    at = lambda x, y, d: (x, y + CAMBER * half * (1 - ((x - middle) / half) ** 2), d)
    arc = lambda x, begin: [at(x + t * math.cos(a), height + t * math.sin(a), 0.0)
                            for a in (math.pi * (begin - i / (2 * SAMPLES)) for i in range(2 * SAMPLES + 1))]
    line = lambda side: [at(middle + side * (2 * i / SAMPLES - 1) * flat, height + side * t, 2 * flat * min(i, SAMPLES - i) / SAMPLES)
                         for i in range(SAMPLES + 1)]
    return [arc(middle - flat, 1.5), line(1), arc(middle + flat, 0.5), line(-1)]


def spaced(lengths, spacing):
    """Where to cut a line of points: (point, part of the way to the next) at equal steps of length over spacing, the first included."""
    steps = [2 * a / (h + g) for a, h, g in zip(lengths, spacing, spacing[1:])]
    done = [0.0, *itertools.accumulate(steps)]
    count = max(1, round(done[-1]))
    for i in range(count):
        at = min(bisect.bisect_right(done, i * done[-1] / count) - 1, len(steps) - 1)
        yield at, (i * done[-1] / count - done[at]) / steps[at]


def ring(z, edge):
    """The vertices of the section at z, a list for each of its lines, which has its first point and not its last."""
    rim = shape(z)[3] * math.pi / RIM_STEPS
    parts = []
    for line in section(z):
        lengths = [math.dist(a[:2], b[:2]) for a, b in zip(line, line[1:])]
        places = spaced(lengths, [min(edge, rim + GROWTH * d) for _, _, d in line])
        parts.append([tuple(a + part * (b - a) for a, b in zip(line[i][:2], line[i + 1][:2])) + (z,) for i, part in places])
    return parts


def stations(edge):
    """The z of the rings of one wing, from the middle outwards, so far apart that no point of a section moves farther than an edge."""
    z = [SPAN * i / (10 * SAMPLES) for i in range(10 * SAMPLES + 1)]
    shapes = [shape(v) for v in z]
    ends = [[(m + h, y), (m - h, y), (m, y + t)] for m, h, y, t in shapes]
    step = SPAN / (10 * SAMPLES)
    lengths = [max(math.hypot(math.dist(p, q), step) for p, q in zip(a, b)) for a, b in zip(ends, ends[1:])]
    to_tip = [sum(lengths) - d for d in itertools.accumulate([0.0, *lengths])]
    spacing = [min(edge, MEMBRANE * math.pi / RIM_STEPS + GROWTH * d) for d in to_tip]
    return [z[i] + part * step for i, part in spaced(lengths, spacing)]


def stitched(a, b, points):
    """Triangles between two lines of numbers of points; of the next two diagonals the shorter one goes first."""
    triangles, i, j = [], 0, 0
    length = lambda p, q: math.dist(points[p], points[q])
    while i + 1 < len(a) or j + 1 < len(b):
        if j + 1 == len(b) or i + 1 < len(a) and length(a[i + 1], b[j]) <= length(a[i], b[j + 1]):
            triangles.append((a[i], b[j], a[i + 1]))
            i += 1
        else:
            triangles.append((a[i], b[j], b[j + 1]))
            j += 1
    return triangles


def body(edge):
    """(points, triangles) of the closed surface, counterclockwise from outside."""
    right, points, rings = stations(edge), [], []
    for z in [-z for z in right[:0:-1]] + right:
        starts = []
        for part in ring(z, edge):
            starts.append(len(points))
            points += [tuple(round(c, 9) for c in p) for p in part]
        ends = starts[1:] + [len(points)]  # a line ends where the next begins, the last one where the first does
        rings.append([[*range(start, end), end if end < len(points) else starts[0]] for start, end in zip(starts, ends)])
    triangles = [t for below, above in zip(rings, rings[1:]) for a, b in zip(below, above) for t in stitched(a, b, points)]
    for z, tip in ((-SPAN, rings[0]), (SPAN, rings[-1])):
        x, _, y, _ = shape(z)
        triangles += [(a, len(points), b)[::1 if z > 0 else -1] for part in tip for a, b in zip(part, part[1:])]
        points.append((x, y, z))
    return points, triangles


def write_poly(path, edge=EDGE):
    """The body in its box, with a hole in the body, as .poly; the number of its triangles."""
    points, triangles = body(edge)
    n = len(points)
    corners = [tuple(AIR[axis][i >> axis & 1] for axis in range(3)) for i in range(8)]
    sides = ["0 2 3 1", "4 5 7 6", "0 1 5 4", "2 6 7 3", "0 4 6 2", "1 3 7 5"]
    rows = [f"{n + 8} 3 0 0"] + [f"{i} {x:.12g} {y:.12g} {z:.12g}" for i, (x, y, z) in enumerate(points + corners)]
    rows.append(f"{len(triangles) + 6} 0")
    rows += [f"1\n3 {a} {b} {c}" for a, b, c in triangles]
    rows += ["1\n4 " + " ".join(str(n + int(c)) for c in side.split()) for side in sides]
    x, half, y, _ = shape(0.0)
    rows += ["1", f"0 {x:.9g} {y + CAMBER * half:.9g} 0", "0"]
    pathlib.Path(path).write_text("\n".join(rows) + "\n", encoding="utf-8")
    return len(triangles)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--edge", type=float, default=EDGE, help="of the surface's triangles; default: %(default)s")
    args = parser.parse_args()
    print(f"{write_poly(args.out, args.edge):,} triangles; --size \"{size_expression()}\"")


if __name__ == "__main__":
    main()
