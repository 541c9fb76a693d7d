#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""A picture of a tetrahedral mesh cut open, as the README shows it. Python's standard library alone.

Usage: picture.py MESH.mesh PICTURE.png [--cut NX NY NZ D] [--view AZIMUTH ELEVATION] [--width PIXELS]

Cells whose centroid x has N.x > D are left out. Faces of the surface are blue, faces of inner cells orange.
The README's picture:
    build/release/pgdr mesh tests/models/bracket.poly --radius-edge 2 --size 0.15 -o out/bracket.mesh
    docs/picture.py out/bracket.mesh docs/images/bracket.png --width 800
"""
import argparse
import math
import struct
import zlib

SURFACE, INSIDE, PAPER, INK = (120, 160, 205), (245, 190, 105), (255, 255, 255), (45, 50, 60)
SAMPLES = 2  # a side, a pixel


def read_medit(path):
    """Points and tetrahedra of an ASCII .mesh file."""
    with open(path, encoding="ascii") as file:
        words = iter(file.read().split())
    points, cells = [], []
    for word in words:
        if word == "Vertices":
            points = [(tuple(float(next(words)) for _ in range(3)), next(words))[0] for _ in range(int(next(words)))]
        elif word == "Tetrahedra":
            cells = [(tuple(int(next(words)) - 1 for _ in range(4)), next(words))[0] for _ in range(int(next(words)))]
        elif word == "End":
            break
    return points, cells


def faces_of(cells):
    """Faces (sorted -> in order, seen from outside) that belong to exactly one of the cells."""
    once = {}
    for a, b, c, d in cells:
        for face in ((a, c, b), (a, b, d), (b, c, d), (a, d, c)):
            key = tuple(sorted(face))
            if once.pop(key, None) is None:
                once[key] = face
    return once


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def shade(points, face, color, light):
    normal = cross(minus(points[face[1]], points[face[0]]), minus(points[face[2]], points[face[0]]))
    length = math.sqrt(dot(normal, normal)) or 1
    brightness = 0.62 + 0.38 * max(0.0, dot(normal, light) / length)
    return tuple(int(c * brightness) for c in color)


def fill(image, depth, width, height, corners, color):
    """One triangle with its edges inked; corners are (column, row, depth), nearer is larger."""
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = corners
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    if abs(area) < 1e-9:
        return
    lengths = (math.hypot(cx - bx, cy - by), math.hypot(ax - cx, ay - cy), math.hypot(bx - ax, by - ay))
    pen = [0.5 * SAMPLES * l / abs(area) for l in lengths]  # half a line's width as a barycentric coordinate
    for row in range(max(0, math.ceil(min(ay, by, cy))), min(height - 1, math.floor(max(ay, by, cy))) + 1):
        for column in range(max(0, math.ceil(min(ax, bx, cx))), min(width - 1, math.floor(max(ax, bx, cx))) + 1):
            u = ((bx - column) * (cy - row) - (by - row) * (cx - column)) / area
            v = ((cx - column) * (ay - row) - (cy - row) * (ax - column)) / area
            w = 1 - u - v
            if u < 0 or v < 0 or w < 0:
                continue
            z = u * az + v * bz + w * cz
            at = row * width + column
            if z > depth[at]:
                depth[at] = z
                image[at] = INK if u < pen[0] or v < pen[1] or w < pen[2] else color


def write_png(path, image, width, height):
    """Averages SAMPLES x SAMPLES samples to a pixel."""
    rows = bytearray()
    for y in range(0, height, SAMPLES):
        rows.append(0)
        for x in range(0, width, SAMPLES):
            block = [image[(y + j) * width + x + i] for j in range(SAMPLES) for i in range(SAMPLES)]
            rows.extend(sum(channel) // len(block) for channel in zip(*block))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width // SAMPLES, height // SAMPLES, 8, 2, 0, 0, 0)
    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(rows), 9)) +
                  chunk(b"IEND", b""))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("mesh")
    parser.add_argument("picture")
    parser.add_argument("--cut", nargs=4, type=float, default=[0.25, -1, 0.1, -1.2], metavar=("NX", "NY", "NZ", "D"))
    parser.add_argument("--view", nargs=2, type=float, default=[-52, 28], metavar=("AZIMUTH", "ELEVATION"))
    parser.add_argument("--width", type=int, default=960)
    options = parser.parse_args()

    points, cells = read_medit(options.mesh)
    normal, distance = options.cut[:3], options.cut[3]
    kept = [c for c in cells if dot(normal, [sum(x) / 4 for x in zip(*(points[v] for v in c))]) <= distance]
    surface, shown = faces_of(cells), faces_of(kept)

    azimuth, elevation = map(math.radians, options.view)
    back = (math.cos(elevation) * math.cos(azimuth), math.cos(elevation) * math.sin(azimuth), math.sin(elevation))
    right = (-math.sin(azimuth), math.cos(azimuth), 0.0)
    up = cross(back, right)
    light = tuple(0.6 * b + 0.65 * u - 0.35 * r for b, u, r in zip(back, up, right))
    light = tuple(l / math.sqrt(dot(light, light)) for l in light)

    used = {v for face in shown for v in face}
    flat = {v: (dot(points[v], right), -dot(points[v], up), dot(points[v], back)) for v in used}
    low, high = ([f(p[i] for p in flat.values()) for i in range(2)] for f in (min, max))
    width = options.width * SAMPLES
    scale = 0.94 * width / (high[0] - low[0])
    margin = 0.03 * width
    height = int((high[1] - low[1]) * scale + 2 * margin) // SAMPLES * SAMPLES
    screen = {v: ((p[0] - low[0]) * scale + margin, (p[1] - low[1]) * scale + margin, p[2]) for v, p in flat.items()}

    image, depth = [PAPER] * (width * height), [-math.inf] * (width * height)
    for key, face in shown.items():
        color = shade(points, face, SURFACE if key in surface else INSIDE, light)
        fill(image, depth, width, height, [screen[v] for v in face], color)
    write_png(options.picture, image, width, height)
    print(f"{len(kept)} of {len(cells)} tetrahedra, {len(shown)} faces: {options.picture}")


if __name__ == "__main__":
    main()
