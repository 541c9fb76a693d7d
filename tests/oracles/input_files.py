# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs as their files have them, read anew: nothing here knows how pgdr reads. .poly, .smesh, .node, .off, .obj, .stl, .ply."""
import dataclasses
import pathlib
import re
import struct


class UnknownInput(Exception):
    """What this reader, or the oracle behind it, cannot tell."""


@dataclasses.dataclass
class Input:
    """Points are tuples of doubles, indices count from 0."""
    dimension: int
    points: list
    segments: list = dataclasses.field(default_factory=list)  # (from, to, marker) each; 2D
    facets: list = dataclasses.field(default_factory=list)    # (polygons, holes, marker) each; 3D
    holes: list = dataclasses.field(default_factory=list)     # points
    regions: list = dataclasses.field(default_factory=list)   # (point, attribute)

    def replaced(self, **changes):
        return dataclasses.replace(self, **changes)


def lines_of(text):
    """Words of the lines that say something."""
    for line in text.splitlines():
        words = line.split("#")[0].replace(",", " ").split()
        if words:
            yield words


def read_nodes(lines, head, file):
    number, dimension = int(head[0]), int(head[1]) if len(head) > 1 else 0
    if number == 0:
        beside = lines_of(file.with_suffix(".node").read_text())
        return read_nodes(beside, next(beside), file)
    first, points = None, []
    for _ in range(number):
        words = next(lines)
        first = int(words[0]) if first is None else first
        points.append(tuple(map(float, words[1:1 + dimension])))
    return points, first, dimension


def read_polygon(lines, first):
    """The points, and the words behind them."""
    words = next(lines)
    end = 1 + int(words[0])
    while len(words) < end:
        words += next(lines)
    return [int(w) - first for w in words[1:end]], words[end:]


def read_tetgen(path):
    lines = lines_of(path.read_text())
    points, first, dimension = read_nodes(lines, next(lines), path)
    out = Input(dimension, points)
    if path.suffix == ".node":
        return out
    head = next(lines)
    marked = len(head) > 1 and int(head[1]) != 0

    def marker(words):
        return int(words[0]) if marked and words else 0

    for _ in range(int(head[0])):
        if dimension == 2:
            words = next(lines)
            out.segments.append((int(words[1]) - first, int(words[2]) - first, marker(words[3:])))
        elif path.suffix == ".smesh":
            polygon, rest = read_polygon(lines, first)
            out.facets.append(([polygon], [], marker(rest)))
        else:
            words = next(lines)
            polygons = [read_polygon(lines, first)[0] for _ in range(int(words[0]))]
            number = int(words[1]) if len(words) > 1 else 0
            holes = [tuple(map(float, next(lines)[1:4])) for _ in range(number)]
            out.facets.append((polygons, holes, marker(words[2:])))
    for _ in range(int(next(lines, ["0"])[0])):
        out.holes.append(tuple(map(float, next(lines)[1:1 + dimension])))
    for _ in range(int(next(lines, ["0"])[0])):
        words = next(lines)
        out.regions.append((tuple(map(float, words[1:1 + dimension])), float(words[1 + dimension])))
    return out


def of_surface(points, polygons):
    return Input(3, points, facets=[([list(p)], [], 0) for p in polygons])


def read_off(path):
    words = list(lines_of(path.read_text()))
    head = words.pop(0)
    if not re.fullmatch(r"(?:ST|C|N)*OFF", head[0]):
        raise UnknownInput("no plain OFF file")
    counts = head[1:] or words.pop(0)
    points, faces = int(counts[0]), int(counts[1])
    polygons = [[int(w) for w in line[1:1 + int(line[0])]] for line in words[points:points + faces]]
    return of_surface([tuple(map(float, line[:3])) for line in words[:points]], polygons)


def read_obj(path):
    points, polygons = [], []
    for words in lines_of(path.read_text().replace("\\\n", " ")):
        if words[0] == "v":
            points.append(tuple(map(float, words[1:4])))
        elif words[0] == "f":
            numbers = [int(w.split("/")[0]) for w in words[1:]]
            polygons.append([n - 1 if n > 0 else len(points) + n for n in numbers])
    return of_surface(points, polygons)


def read_stl(path):
    data = path.read_bytes()
    count = struct.unpack_from("<I", data, 80)[0] if len(data) >= 84 else -1
    corners = []
    if len(data) == 84 + 50 * count:
        for i in range(count):
            numbers = struct.unpack_from("<12f", data, 84 + 50 * i)
            corners += [numbers[3:6], numbers[6:9], numbers[9:12]]
    else:
        for words in lines_of(data.decode("ascii", "replace")):
            if words[0].lower() == "vertex":
                corners.append(tuple(map(float, words[1:4])))
    return of_surface(corners, [[i, i + 1, i + 2] for i in range(0, len(corners), 3)])


PLY_TYPES = {"char": "b", "int8": "b", "uchar": "B", "uint8": "B", "short": "h", "int16": "h", "ushort": "H", "uint16": "H",
             "int": "i", "int32": "i", "uint": "I", "uint32": "I", "float": "f", "float32": "f", "double": "d", "float64": "d"}


def read_ply(path):
    head, body = path.read_bytes().split(b"end_header", 1)
    body = body[body.index(b"\n") + 1:]
    elements, order = [], None
    for words in (line.split() for line in head.decode("ascii", "replace").splitlines()):
        if words[:1] == ["format"]:
            order = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}[words[1]]
        elif words[:1] == ["element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == ["property"]:
            elements[-1][2].append(words[1:])
    words, at = iter(body.split()) if order is None else None, 0

    def number(kind):
        nonlocal at
        if order is None:
            return float(next(words)) if kind in "fd" else int(float(next(words)))
        value = struct.unpack_from(order + kind, body, at)[0]
        at += struct.calcsize(kind)
        return value

    points, polygons = [], []
    for name, count, properties in elements:
        for _ in range(count):
            item = {}
            for p in properties:
                if p[0] == "list":
                    item[p[3]] = [number(PLY_TYPES[p[2]]) for _ in range(number(PLY_TYPES[p[1]]))]
                else:
                    item[p[1]] = number(PLY_TYPES[p[0]])
            if name == "vertex":
                points.append((item["x"], item["y"], item["z"]))
            elif name == "face":
                polygons.append(item.get("vertex_indices", item.get("vertex_index")))
    return of_surface(points, polygons)


READERS = {".poly": read_tetgen, ".smesh": read_tetgen, ".node": read_tetgen, ".off": read_off, ".obj": read_obj,
           ".stl": read_stl, ".ply": read_ply}


def read(path):
    path = pathlib.Path(path)
    if path.suffix not in READERS:
        raise UnknownInput(f"{path.suffix} is not read here")
    return READERS[path.suffix](path)


def write_poly(given, path):
    """A .poly of doubles that read back as they are."""
    out = [f"{len(given.points)} {given.dimension} 0 0"]

    def row(number, values):
        return " ".join([str(number), *map(repr, values)])

    out += [row(i, p) for i, p in enumerate(given.points)]
    if given.dimension == 2:
        out.append(f"{len(given.segments)} 1")
        out += [f"{i} {a} {b} {marker}" for i, (a, b, marker) in enumerate(given.segments)]
    else:
        out.append(f"{len(given.facets)} 1")
        for polygons, holes, marker in given.facets:
            out.append(f"{len(polygons)} {len(holes)} {marker}")
            out += [" ".join(map(str, [len(p), *p])) for p in polygons]
            out += [row(i, h) for i, h in enumerate(holes)]
    out.append(str(len(given.holes)))
    out += [row(i, h) for i, h in enumerate(given.holes)]
    out.append(str(len(given.regions)))
    out += [row(i, [*p, attribute, -1.0]) for i, (p, attribute) in enumerate(given.regions)]
    pathlib.Path(path).write_text("\n".join(out) + "\n", encoding="ascii")
