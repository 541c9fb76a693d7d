# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Cells of crystals: boxes, sheared or not, with spheres that their faces, edges and corners cut."""
import math
import random


def octahedron(times):
    """Triangles of a sphere about the origin, none of which crosses a plane between axes."""
    top = [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
    triangles = []
    for signs in range(8):
        s = [1 - 2 * (signs >> i & 1) for i in range(3)]
        t = [tuple(s[i] * p[i] for i in range(3)) for p in top]
        triangles.append(t if s[0] * s[1] * s[2] > 0 else [t[0], t[2], t[1]])
    half = lambda a, b: tuple((a[i] + b[i]) / math.sqrt(sum((x + y) ** 2 for x, y in zip(a, b))) for i in range(3))
    for _ in range(times):
        finer = []
        for a, b, c in triangles:
            d, e, f = half(a, b), half(b, c), half(c, a)
            finer += [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
        triangles = finer
    return triangles


def spheres_of(chance, count):
    """Centres with coordinates in [0, 1) and radii; a coordinate 0 is on a face. None meets another, or a face otherwise."""
    spheres, tries = [], 0
    while len(spheres) < count and tries < 2000:
        tries += 1
        radius = round(chance.uniform(0.08, 0.3), 6)
        cut = [chance.random() < 0.5 for _ in range(3)]
        if any(not c and radius > 0.44 for c in cut):
            continue
        centre = tuple(0.0 if c else round(chance.uniform(radius + 0.03, 0.97 - radius), 6) for c in cut)
        apart = lambda d: min(abs(d), 1 - abs(d))
        if all(math.sqrt(sum(apart(a - b) ** 2 for a, b in zip(centre, o))) > radius + r + 0.03 for o, r in spheres):
            spheres.append((centre, radius))
    return spheres


class Cell:
    """Markers: 1, 2 at x = 0, 1; 3, 4 at y; 5, 6 at z; 9 of spheres. Labels: 1 about spheres, 2 in them, unless these are voids."""

    def __init__(self, spheres, times=2, axes=((1, 0, 0), (0, 1, 0), (0, 0, 1)), voids=False):
        self.points, self.number, self.facets, self.seeds, self.holes = [], {}, [], [], []
        self.axes = axes
        faces = []
        for axis in range(3):
            for level in (0, 1):
                corners = []
                for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    p = [0, 0, 0]
                    p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = level, u, v
                    corners.append(self.add(p))
                faces.append([[corners], [], 2 * axis + level + 1])
        sphere = octahedron(times)
        for centre, radius in spheres:
            for shift in range(8):
                c = [x + (shift >> i & 1) for i, x in enumerate(centre)]
                if any(x > 1 for x in c):
                    continue
                inwards = [1 if x == 0 else -1 if x == 1 else 0 for x in c]
                if shift and not any(x == 1 for x in c):
                    continue
                lines = {}
                for t in sphere:
                    if any(i and any(p[k] * i < 0 for p in t) for k, i in enumerate(inwards)):
                        continue
                    placed = [[c[k] + radius * p[k] if p[k] else c[k] for k in range(3)] for p in t]
                    corners = [self.add(p) for p in placed]
                    self.facets.append([[corners], [], 9])
                    for k in range(3):
                        for i in range(3):
                            a, b = placed[i], placed[(i + 1) % 3]
                            if a[k] == b[k] and a[k] in (0, 1) and inwards[k]:
                                lines.setdefault((k, int(a[k])), set()).add(tuple(sorted((corners[i], corners[(i + 1) % 3]))))
                for (k, level), edges in lines.items():
                    faces[2 * k + level][0] += [list(e) for e in sorted(edges)]
                    if voids:
                        inside = [x + radius * 0.3 * i for x, i in zip(c, inwards)]
                        inside[k] = level
                        faces[2 * k + level][1].append(self.place(inside))
                seed = self.place([x + radius * 0.3 * i for x, i in zip(c, inwards)])
                (self.holes if voids else self.seeds).append(seed)
        self.facets = faces + self.facets

    def place(self, p):
        return tuple(sum(p[k] * self.axes[k][i] for k in range(3)) for i in range(3))

    def add(self, p):
        key = tuple(float(x) for x in p)
        if key not in self.number:
            self.number[key] = len(self.points)
            self.points.append(self.place(key))
        return self.number[key]

    def poly(self):
        text = f"{len(self.points)} 3 0 0\n" + "".join("{} {!r} {!r} {!r}\n".format(i, *p) for i, p in enumerate(self.points))
        text += f"{len(self.facets)} 1\n"
        for polygons, holes, marker in self.facets:
            text += f"{len(polygons)} {len(holes)} {marker}\n" + "".join(f"{len(p)} {' '.join(map(str, p))}\n" for p in polygons)
            text += "".join("{} {!r} {!r} {!r}\n".format(i, *h) for i, h in enumerate(holes))
        text += f"{len(self.holes)}\n" + "".join("{} {!r} {!r} {!r}\n".format(i, *h) for i, h in enumerate(self.holes))
        text += f"{len(self.seeds)}\n" + "".join("{} {!r} {!r} {!r} 2\n".format(i, *s) for i, s in enumerate(self.seeds))
        return text


def drawn(seed):
    """A cell of some spheres, of odd numbers sheared, of multiples of three with voids."""
    chance = random.Random(seed)
    shear = [chance.uniform(-0.5, 0.5) for _ in range(3)] if seed % 2 else [0, 0, 0]
    axes = ((1, 0, 0), (shear[0], 1, 0), (shear[1], shear[2], 1))
    return Cell(spheres_of(chance, chance.randint(1, 6)), chance.choice((1, 2, 3)), axes, voids=seed % 3 == 0)


if __name__ == "__main__":  # python3 periodic_cells.py 7 > cell.poly
    import sys
    print(drawn(int(sys.argv[1])).poly(), end="")
