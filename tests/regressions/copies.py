# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Copies of an input in another position, in .poly, .smesh, .node, .off and .obj.

turned   by the rotations (3, 4, 5) about z and (5, 12, 13) about x; scaled so that all coordinates are integers. They are exact:
         what is collinear or coplanar in the decimals of the file is so in the copy.
rounded  by the same rotations, of the same size: each coordinate is rounded once.
shifted  by a thousand times the extent or so, scaled so that all coordinates are integers. Exact as well.
"""
from decimal import Decimal
from fractions import Fraction
import pathlib


class CopyError(Exception):
    """An input that has no such copy."""


class Coordinates:
    """The text of an input with gaps for what a motion changes: points, and measures (bounds of regions)."""

    def __init__(self):
        self.parts = []       # text, ("point", [Decimal ...]) or ("measure", Decimal)
        self.dimension = None

    def text(self, text):
        self.parts.append(text)

    def point(self, words):
        if self.dimension is None:
            self.dimension = len(words)
        self.parts.append(("point", [Decimal(w) for w in words]))

    def measure(self, word):
        self.parts.append(("measure", Decimal(word)))

    def points(self):
        return [part[1] for part in self.parts if isinstance(part, tuple) and part[0] == "point"]

    def moved(self, move, scale):
        """`move`: a list of Decimal to a list of text; `scale`: of lengths."""
        out = []
        for part in self.parts:
            if isinstance(part, str):
                out.append(part)
            elif part[0] == "point":
                out.append(" ".join(move(part[1])))
            else:
                out.append(repr(float(Fraction(part[1]) * Fraction(scale) ** self.dimension)))
        return "".join(out)


def lines_of(text):
    """Words of the lines that say something."""
    for line in text.splitlines():
        words = line.split("#")[0].split()
        if words:
            yield words


class TetgenReader:
    """Triangle's and TetGen's .poly, .smesh and .node."""

    def __init__(self, text, extension):
        self.lines, self.extension, self.out = lines_of(text), extension, Coordinates()

    def head(self):
        words = next(self.lines)
        self.out.text(" ".join(words) + "\n")
        return [int(w) for w in words]

    def numbered_point(self, dimension, measure_at=None):
        """`N x y ...`; the word `measure_at` of the line, if it is there, is a measure."""
        words = next(self.lines)
        self.out.text(words[0] + " ")
        self.out.point(words[1:1 + dimension])
        for at, word in enumerate(words[1 + dimension:], 1 + dimension):
            self.out.text(" ")
            self.out.measure(word) if at == measure_at and float(word) > 0 else self.out.text(word)
        self.out.text("\n")

    def polygon(self):
        words = next(self.lines)
        while len(words) < 1 + int(words[0]):
            words += next(self.lines)
        self.out.text(" ".join(words) + "\n")

    def facets(self, number, dimension):
        for _ in range(number):
            if dimension == 2 or self.extension == ".smesh":
                self.polygon() if dimension == 3 else self.out.text(" ".join(next(self.lines)) + "\n")
                continue
            head = self.head()
            for _ in range(head[0]):
                self.polygon()
            for _ in range(head[1] if len(head) > 1 else 0):
                self.numbered_point(dimension)

    def seeds(self, dimension, regions):
        words = next(self.lines, None)
        if words is None:
            return
        self.out.text(words[0] + "\n")
        for _ in range(int(words[0])):
            self.numbered_point(dimension, measure_at=dimension + 2 if regions else None)

    def read(self):
        number, dimension = (self.head() + [0, 0])[:2]
        if number == 0:
            raise CopyError("the points are in a file of their own")
        for _ in range(number):
            self.numbered_point(dimension)
        if self.extension != ".node":
            self.facets(self.head()[0], dimension)
            self.seeds(dimension, regions=False)
            self.seeds(dimension, regions=True)
        return self.out


def read_off(text):
    out, lines = Coordinates(), lines_of(text)
    words = next(lines)
    if words == ["OFF"]:
        words += next(lines)
    if words[0] != "OFF":
        raise CopyError("no plain OFF file")
    out.text("OFF\n" + " ".join(words[1:]) + "\n")
    for _ in range(int(words[1])):
        out.point(next(lines)[:3])
        out.text("\n")
    for words in lines:
        out.text(" ".join(words) + "\n")
    return out


def read_obj(text):
    out = Coordinates()
    for words in lines_of(text):
        if words[0] == "v":
            out.text("v ")
            out.point(words[1:4])
            out.text("\n")
        elif words[0] in ("f", "o", "g", "usemtl", "l"):  # no normals, which would be turned, too
            out.text(" ".join(w.split("/")[0] if words[0] == "f" else w for w in words) + "\n")
    return out


def read(path):
    path = pathlib.Path(path)
    text = path.read_text(encoding="ascii")
    if path.suffix in (".poly", ".smesh", ".node"):
        return TetgenReader(text, path.suffix).read()
    if path.suffix == ".off":
        return read_off(text)
    if path.suffix == ".obj":
        return read_obj(text)
    raise CopyError(f"copies of {path.suffix} are not made")


def integers_exactly(values):
    for v in values:
        if int(float(v)) != v:
            raise CopyError(f"{v} is no double: the coordinates have too many digits")
    return [str(v) for v in values]


def rotated(p):
    """5 times (2D) or 65 times (3D) as large."""
    if len(p) == 2:
        return [3 * p[0] - 4 * p[1], 4 * p[0] + 3 * p[1]]
    x, y, z = 3 * p[0] - 4 * p[1], 4 * p[0] + 3 * p[1], 5 * p[2]
    return [13 * x, 5 * y - 12 * z, 12 * y + 5 * z]


def copy(path, kind, target):
    """Writes a copy of `path` to `target`. Returns by which factor its lengths are larger."""
    all_of = read(path)
    points = all_of.points()
    decimals = max(0, max(-c.normalize().as_tuple().exponent for p in points for c in p))
    unit = 10 ** decimals
    length = 5 if all_of.dimension == 2 else 65

    def whole(p):
        return [int(Fraction(c) * unit) for c in p]

    if kind == "turned":
        scale, move = unit * length, lambda p: integers_exactly(rotated(whole(p)))
    elif kind == "rounded":
        scale, move = 1, lambda p: [repr(float(c / length)) for c in rotated([Fraction(float(c)) for c in p])]
    else:
        extent = max(max(c) - min(c) for c in zip(*map(whole, points)))
        step = 1 << max(extent, 1).bit_length()
        offset = [1024 * step, -2048 * step, 512 * step]
        scale, move = unit, lambda p: integers_exactly([c + o for c, o in zip(whole(p), offset)])
    pathlib.Path(target).write_text(all_of.moved(move, scale), encoding="ascii")
    return scale
