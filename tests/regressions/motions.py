# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Copies of which the same is expected as of an input: other doubles of the same shape.

Each kind is a function of an Input and a random.Random. It returns the copy, by which factor its lengths are larger, by how much
rounding may have moved a point, in units of the copy, and flags that it needs, if any.
"""
import math
import struct


def mapped(given, f):
    return given.replaced(points=[f(p) for p in given.points], holes=[f(p) for p in given.holes],
                          regions=[(f(p), attribute) for p, attribute in given.regions],
                          facets=[(polygons, [f(h) for h in holes], marker) for polygons, holes, marker in given.facets])


def ulp_of(given):
    return math.ulp(max(abs(c) for p in given.points for c in p))


def rotation(dimension, random):
    if dimension == 2:
        a = random.uniform(0, 2 * math.pi)
        return ((math.cos(a), -math.sin(a)), (math.sin(a), math.cos(a)))
    q = [random.gauss(0, 1) for _ in range(4)]
    size = math.sqrt(sum(x * x for x in q))
    w, x, y, z = (c / size for c in q)
    return ((1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))


def turned(given, random):
    rows = rotation(given.dimension, random)
    copy = mapped(given, lambda p: tuple(sum(r * c for r, c in zip(row, p)) for row in rows))
    return copy, 1, 3 * max(ulp_of(copy), ulp_of(given))


def scaled(given, factor):
    copy = mapped(given, lambda p: tuple(factor * c for c in p))
    return copy, factor, ulp_of(copy)


def shifted(given, random):
    """By 1e4 to 1e7 times the size."""
    size = max(max(c) - min(c) for c in zip(*given.points))
    offset = [random.choice((-1, 1)) * size * 10 ** random.uniform(4, 7) for _ in range(given.dimension)]
    copy = mapped(given, lambda p: tuple(c + o for c, o in zip(p, offset)))
    return copy, 1, ulp_of(copy)


def permuted(given, random):
    """Points, facets, polygons, segments and seeds in another order; polygons from another corner on, and the other way round."""
    order = list(range(len(given.points)))
    random.shuffle(order)
    number = {v: i for i, v in enumerate(order)}

    def polygon(p):
        k = random.randrange(len(p))
        p = [number[v] for v in p[k:] + p[:k]]
        return p[::-1] if random.random() < 0.5 else p

    def shuffled(values):
        values = list(values)
        random.shuffle(values)
        return values

    facets = [(shuffled(map(polygon, polygons)), holes, marker) for polygons, holes, marker in given.facets]
    segments = [(number[a], number[b], marker) for a, b, marker in given.segments]
    return given.replaced(points=[given.points[v] for v in order], facets=shuffled(facets), segments=shuffled(segments),
                          holes=shuffled(given.holes), regions=shuffled(given.regions)), 1, 0


def floats(given, _):
    copy = mapped(given, lambda p: struct.unpack(f"<{len(p)}f", struct.pack(f"<{len(p)}f", *p)))
    return copy, 1, ulp_of(given) * 2 ** 29


def digits(given, _):
    """Of the largest coordinate, as a file of fixed decimals has them."""
    decimals = 7 - math.floor(math.log10(max(abs(c) for p in given.points for c in p)))
    return mapped(given, lambda p: tuple(round(c, decimals) for c in p)), 1, 10.0 ** -decimals


def soup(given, random):
    """Turned, each facet and segment with points of its own, which miss those of others by an ulp."""
    given, _, rounding = turned(given, random)
    ulp, points, used = ulp_of(given), [], set()

    def own(v):
        used.add(v)
        points.append(tuple(c + random.choice((-1, 0, 1)) * ulp for c in given.points[v]))
        return len(points) - 1

    facets = []
    for polygons, holes, marker in given.facets:
        copies = {v: own(v) for v in dict.fromkeys(v for p in polygons for v in p)}
        facets.append(([[copies[v] for v in p] for p in polygons], holes, marker))
    segments = [(own(a), own(b), marker) for a, b, marker in given.segments]
    points += [p for v, p in enumerate(given.points) if v not in used]
    return given.replaced(points=points, facets=facets, segments=segments), 1, rounding + 2 * ulp


def coarse(given, random):
    """As soup, of few decimals, with the tolerance that these need: a point is up to half a unit off in each coordinate, so two are up
    to sqrt(3) units apart."""
    copy, _, rounding = soup(given, random)
    size = max(max(c) - min(c) for c in zip(*given.points))
    decimals = 5 - math.floor(math.log10(size))
    unit = 10.0 ** -decimals
    copy = mapped(copy, lambda p: tuple(round(c, decimals) for c in p))
    return copy, 1, rounding + unit, ["--tolerance", repr(2 * unit)]


KINDS = {
    "turned": turned,
    "soup": soup,
    "coarse": coarse,
    "small": lambda given, _: scaled(given, 1e-9),
    "large": lambda given, _: scaled(given, 1e9),
    "shifted": shifted,
    "permuted": permuted,
    "floats": floats,
    "digits": digits,
}
# What lay on an edge or in a plane is off it by more than the rounding of doubles.
MISSING = {"floats", "digits"}
