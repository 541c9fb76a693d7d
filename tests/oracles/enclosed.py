# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What an input encloses, in integers: its volumes (2D: areas), which seeds name them, and how large they are. Shares nothing with
pgdr, and takes the coordinates as they are: where facets miss each other by an ulp, a volume leaks.

Every face has two sides. Sides that follow each other round an edge (2D: a point) are of one volume, and so are those that follow
each other along a line that meets nothing between. Volumes are sums of determinants over the faces about them.
"""
import bisect
import collections
import functools
import math
from fractions import Fraction

from input_files import UnknownInput

SLOPE = (1009, 10007, 1000003)  # of the lines that are cast: y and z per x, over the last. No coordinates that people choose


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def determinant(*rows):
    if len(rows) == 2:
        return rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0]
    return dot(rows[0], cross(rows[1], rows[2]))


def unit_of(points):
    """The number of steps to a unit of length that makes all coordinates integers."""
    return max((c.as_integer_ratio()[1] for p in points for c in p), default=1)


def in_steps(point, unit):
    return tuple(n * (unit // d) for n, d in (c.as_integer_ratio() for c in point))


def normal_of(points, face):
    """Of directed edges: as long as twice the area."""
    origin, sums = points[face[0][0]], (0, 0, 0)
    for u, v in face:
        n = cross(minus(points[u], origin), minus(points[v], origin))
        sums = tuple(a + b for a, b in zip(sums, n))
    return sums


class Sets:
    """Disjoint sets of numbers."""

    def __init__(self, size):
        self.parent = list(range(size))

    def find(self, x):
        while self.parent[x] != x:
            self.parent[x] = self.parent[self.parent[x]]
            x = self.parent[x]
        return x

    def unite(self, a, b):
        a, b = self.find(a), self.find(b)
        self.parent[max(a, b)] = min(a, b)


def by_angle(vectors, about=None):
    """Their numbers, counter-clockwise (in 3D about an axis to which all are perpendicular), from any of them on."""
    first = vectors[0]
    turn = (lambda a, b: dot(about, cross(a, b))) if about else determinant

    def half(v):
        s = turn(first, v)
        return 0 if s > 0 or (s == 0 and dot(first, v) > 0) else 1

    def compare(i, k):
        a, b = vectors[i], vectors[k]
        if half(a) != half(b):
            return half(a) - half(b)
        s = turn(a, b)
        return -1 if s > 0 else 1 if s < 0 else 0

    order = sorted(range(len(vectors)), key=functools.cmp_to_key(compare))
    for i, k in zip(order, order[1:]):
        if compare(i, k) == 0:
            raise UnknownInput("faces or segments overlap")
    return order


class Complex:
    """Faces: 2D segments as (from, to); 3D lists of directed edges, the face on their left. Side 2i of face i is that of its normal
    (2D: its left), side 2i + 1 the other; the last side is the outside."""

    def __init__(self, points, faces):
        self.points, self.faces, self.dimension = points, faces, len(points[0])
        self.outside = 2 * len(faces)
        self.sides = Sets(2 * len(faces) + 1)
        self.open_ridges = []  # of one face
        self.normals = None if self.dimension == 2 else [normal_of(points, f) for f in faces]
        self.unite_round_ridges()
        self.sheared = [self.shear(p) for p in points]
        self.boxes = [self.box(i) for i in range(len(faces))]
        self.components = Sets(len(faces))
        self.unite_along_lines()

    @staticmethod
    def shear(p):
        """Along x: lines of SLOPE are parallel to it then. Times SLOPE[-1]."""
        return (p[0] * SLOPE[-1],) + tuple(c * SLOPE[-1] - p[0] * s for c, s in zip(p[1:], SLOPE))

    def corners(self, i):
        face = self.faces[i]
        return face if self.dimension == 2 else [u for u, _ in face]

    def box(self, i):
        corners = [self.sheared[v][1:] for v in self.corners(i)]
        return tuple((min(c), max(c)) for c in zip(*corners))

    def unite_round_ridges(self):
        uses = collections.defaultdict(list)  # ridge: (face, its side that is met next counter-clockwise, the one before)
        for i, face in enumerate(self.faces):
            if self.dimension == 2:
                uses[face[0]].append((i, 2 * i, 2 * i + 1))
                uses[face[1]].append((i, 2 * i + 1, 2 * i))
            else:
                for u, v in face:
                    uses[min(u, v), max(u, v)].append((i, 2 * i, 2 * i + 1) if u < v else (i, 2 * i + 1, 2 * i))
        self.uses = uses
        for ridge, around in uses.items():
            if len(around) == 1:
                self.open_ridges.append(ridge)
            order = range(len(around)) if len(around) < 3 else self.around(ridge, around)
            for here, after in zip(order, [*order[1:], order[0]]):
                self.sides.unite(around[here][1], around[after][2])

    def around(self, ridge, around):
        if self.dimension == 2:
            ends = [next(v for v in self.faces[i] if v != ridge) for i, _, _ in around]
            return by_angle([minus(self.points[v], self.points[ridge]) for v in ends])
        axis = minus(self.points[ridge[1]], self.points[ridge[0]])
        into = [cross(self.normals[i], axis) for i, _, _ in around]
        return by_angle([v if side % 2 == 0 else minus((0, 0, 0), v) for v, (_, side, _) in zip(into, around)], axis)

    def hits(self, place):
        """(x, face, whether its first side is beyond) of the line through a place of the sheared coordinates but x, ascending."""
        found = []
        low, high = [math.floor(c) for c in place], [math.ceil(c) for c in place]
        for i, box in enumerate(self.boxes):
            if any(b[0] > h or b[1] < w for b, w, h in zip(box, low, high)):
                continue
            x = self.hit(i, place)
            if x is not None:
                found.append((x, i, self.faces_forwards(i)))
        return sorted(found)

    def sheared_normal(self, i):
        face = self.faces[i]
        if self.dimension == 2:
            d = minus(self.sheared[face[1]], self.sheared[face[0]])
            return (-d[1], d[0])
        return normal_of(self.sheared, face)

    def faces_forwards(self, i):
        return self.sheared_normal(i)[0] > 0

    def hit(self, i, place):
        face, normal = self.faces[i], self.sheared_normal(i)
        if normal[0] == 0:
            return None
        if self.dimension == 2:
            if any(self.sheared[v][1] == place[0] for v in face):
                raise UnknownInput("a line through a point")
            if (self.sheared[face[0]][1] < place[0]) == (self.sheared[face[1]][1] < place[0]):
                return None
        elif not self.is_inside(face, place):
            return None
        origin = self.sheared[self.corners(i)[0]]
        return origin[0] - Fraction(sum(n * (c - o) for n, c, o in zip(normal[1:], place, origin[1:]))) / normal[0]

    def is_inside(self, face, place):
        inside = False
        for u, v in face:
            a, b = self.sheared[u][1:], self.sheared[v][1:]
            if (a[1] < place[1]) == (b[1] < place[1]):
                continue
            turn = (b[0] - a[0]) * (place[1] - a[1]) - (b[1] - a[1]) * (place[0] - a[0])
            if turn == 0:
                raise UnknownInput("a line through an edge")
            inside ^= (turn > 0) == (a[1] < b[1])
        return inside

    def unite_along(self, hits):
        before = self.outside
        for _, i, forwards in hits:
            self.sides.unite(before, 2 * i + (1 if forwards else 0))
            before = 2 * i + (0 if forwards else 1)
        self.sides.unite(before, self.outside)

    def unite_along_lines(self):
        for around in self.uses.values():
            for i, _, _ in around[1:]:
                self.components.unite(around[0][0], i)
        done = set()
        for i in range(len(self.faces)):
            component = self.components.find(i)
            if component in done:
                continue
            place = self.place_on(i)
            if place is not None:
                done.add(component)
                self.unite_along(self.hits(place))
        if any(self.components.find(i) not in done for i in range(len(self.faces))):
            raise UnknownInput("a component along the lines")

    def place_on(self, i):
        """Inside the face's projection along x; None if there is none to be found."""
        if self.sheared_normal(i)[0] == 0:
            return None
        corners = [self.sheared[v][1:] for v in self.corners(i)]
        if self.dimension == 2:
            return [Fraction(1013 * corners[0][0] + 1021 * corners[1][0], 2034)]
        for first in range(len(corners)):
            for second in range(first + 1, len(corners) - 1):
                three = corners[first], corners[second], corners[second + 1]
                place = [Fraction(1013 * a + 1021 * b + 1031 * c, 3065) for a, b, c in zip(*three)]
                if determinant(minus(three[1], three[0]), minus(three[2], three[0])) != 0 and self.is_inside(self.faces[i], place):
                    return place
        return None

    def volume_at(self, point):
        """The volume that holds a point: the name of a set of sides."""
        x, *place = self.shear(point)
        side = self.outside
        for at, i, forwards in self.hits(place):
            if at == x:
                raise UnknownInput("a seed on a face")
            if at > x:
                side = 2 * i + (1 if forwards else 0)
                break
        return self.sides.find(side)

    def of_side(self, side):
        return self.sides.find(side)

    def measure(self, i):
        """Six times (2D: twice) what face i adds to the volume on the other side than its normal's (2D: on its left)."""
        face = self.faces[i]
        if self.dimension == 2:
            return determinant(self.points[face[0]], self.points[face[1]])
        origin = self.points[face[0][0]]
        return sum(determinant(origin, self.points[u], self.points[v]) for u, v in face)


def split_at_points(points, edges, candidates):
    """The edges, each as a chain through those candidates (points) that lie exactly inside it."""
    by_x = sorted((points[v], v) for v in candidates)
    for u, v in edges:
        low, high = sorted((points[u], points[v]))
        found = []
        for p, w in by_x[bisect.bisect_right(by_x, (low, math.inf)):bisect.bisect_left(by_x, (high,))]:
            if any(not min(a, b) <= c <= max(a, b) for a, b, c in zip(low, high, p)):
                continue
            d, e = minus(high, low), minus(p, low)
            if (determinant(d, e) == 0) if len(d) == 2 else not any(cross(d, e)):
                found.append((p, w))
        found.sort(reverse=points[u] > points[v])
        yield [u, *(w for _, w in found), v]


def pieces_of(chain):
    return [(a, b) for a, b in zip(chain, chain[1:]) if a != b]


def projection(normal):
    """The two axes to keep, in the order in which the normal is upwards."""
    axis = max(range(3), key=lambda k: abs(normal[k]))
    keep = [(axis + 1) % 3, (axis + 2) % 3]
    return keep if normal[axis] > 0 else keep[::-1]


def plane_complex(points, edges, keep):
    """Of edges of one plane, split at each other's ends."""
    flat = [tuple(p[k] for k in keep) for p in points]
    chains = split_at_points(flat, sorted(edges), {v for e in edges for v in e})
    pieces = sorted({tuple(sorted(e)) for chain in chains for e in pieces_of(chain)})
    refuse_crossings(flat, pieces)
    return Complex(flat, pieces)


def faces_in_plane(flat, removed):
    """Directed edges about each part of the plane but for these."""
    faces = collections.defaultdict(list)
    for i, (u, v) in enumerate(flat.faces):
        faces[flat.of_side(2 * i)].append((u, v))
        faces[flat.of_side(2 * i + 1)].append((v, u))
    return [edges for side, edges in sorted(faces.items()) if side not in removed]


def plane_faces(points, polygons, holes):
    """The faces of a facet of several polygons: what its polygons bound, but for what the outside and its holes reach."""
    outlines = [list(zip(p, p[1:] + p[:1])) for p in polygons]
    edges = {tuple(sorted(e)) for outline in outlines for e in outline if e[0] != e[1]}
    keep = projection(max((normal_of(points, outline) for outline in outlines), key=lambda n: max(map(abs, n))))
    flat = plane_complex(points, edges, keep)
    removed = {flat.of_side(flat.outside)} | {flat.volume_at(tuple(h[k] for k in keep)) for h in holes}
    return faces_in_plane(flat, removed)


def divided(points, face, inner):
    """The parts into which edges in its plane divide a face."""
    flat = plane_complex(points, {tuple(sorted(e)) for e in [*face, *inner]}, projection(normal_of(points, face)))
    directed, removed = collections.Counter(face), {flat.of_side(flat.outside)}
    outline = {e for e in face if not directed[e[::-1]]}
    chains = dict(zip(outline, split_at_points(flat.points, outline, {v for e in inner for v in e})))
    pieces = {piece for chain in chains.values() for piece in pieces_of(chain)}
    for i, e in enumerate(flat.faces):  # what lies right of the outline is not of the face
        if e in pieces:
            removed.add(flat.of_side(2 * i + 1))
        if e[::-1] in pieces:
            removed.add(flat.of_side(2 * i))
    return faces_in_plane(flat, removed)


def is_strictly_inside(place, outline):
    """Whether a place of the plane is inside of directed edges, and not on them; all by coordinates."""
    inside = False
    for a, b in outline:
        turn = determinant(minus(b, a), minus(place, a))
        if turn == 0 and all(min(c, d) <= x <= max(c, d) for c, d, x in zip(a, b, place)):
            return False
        if (a[1] <= place[1]) != (b[1] <= place[1]):
            inside ^= (turn > 0) == (a[1] < b[1])
    return inside


def plane_of(points, face):
    """Equal for faces of one plane, whichever way they face."""
    normal = normal_of(points, face)
    common = math.gcd(*normal) * (1 if max(normal, key=abs) > 0 else -1)
    normal = tuple(c // common for c in normal)
    return (*normal, dot(normal, points[face[0][0]]))


def divided_by_coplanar(points, faces):
    """Faces that overlap in a plane divided by each other's edges, so that what they have in common is a face of each; once."""
    planes = collections.defaultdict(list)
    for i, face in enumerate(faces):
        planes[plane_of(points, face)].append(i)
    inner = collections.defaultdict(set)
    for plane, members in planes.items():
        if len(members) < 2:
            continue
        keep = projection(plane[:3])
        outlines = {i: [tuple(tuple(2 * points[v][k] for k in keep) for v in e) for e in faces[i]] for i in members}
        boxes = {i: [(min(c), max(c)) for c in zip(*(p for e in outlines[i] for p in e))] for i in members}
        members.sort(key=lambda i: boxes[i])
        for at, i in enumerate(members):
            for k in members[at + 1:]:
                if boxes[k][0][0] >= boxes[i][0][1]:
                    break
                if all(a[0] < b[1] and b[0] < a[1] for a, b in zip(boxes[i], boxes[k])):
                    for one, other in ((i, k), (k, i)):
                        for e, (a, b) in zip(faces[other], outlines[other]):
                            if is_strictly_inside(tuple((c + d) // 2 for c, d in zip(a, b)), outlines[one]):
                                inner[one].add(e)
    out, seen = [], set()
    for i, face in enumerate(faces):
        for part in divided(points, face, inner[i]) if i in inner else [face]:
            key = frozenset(tuple(sorted(e)) for e in part)
            if key not in seen:
                seen.add(key)
                out.append(part)
    return out


def edges_that_end(points, faces):
    """Those of one face alone, and of faces of one plane alone: where another plane's face has such an edge inside, they end there."""
    planes, uses = collections.defaultdict(set), collections.Counter()
    for face in faces:
        plane = plane_of(points, face)
        for e in face:
            planes[tuple(sorted(e))].add(plane)
            uses[tuple(sorted(e))] += 1
    return [(e, planes[e] if uses[e] > 1 else set()) for e in planes if len(planes[e]) == 1]


def divided_by_ends(points, faces):
    """Faces divided where edges at which others end run in them."""
    ends = sorted(((tuple((min(c), max(c)) for c in zip(*(points[v] for v in e))), e, planes)
                   for e, planes in edges_that_end(points, faces)), key=lambda end: end[0])
    lows = [box[0][0] for box, _, _ in ends]
    out = []
    for face in faces:
        own = {tuple(sorted(e)) for e in face}
        box = [(min(c), max(c)) for c in zip(*(points[v] for e in face for v in e))]
        normal, origin = normal_of(points, face), points[face[0][0]]
        found = ends[bisect.bisect_left(lows, box[0][0]):bisect.bisect_right(lows, box[0][1])]
        inner = [e for other, e, planes in found
                 if all(b[0] <= o[0] and o[1] <= b[1] for b, o in zip(box, other))
                 and e not in own
                 and all(dot(normal, minus(points[v], origin)) == 0 for v in e)
                 and plane_of(points, face) not in planes]
        out += divided(points, face, inner) if inner else [face]
    return out


def refuse_bent(points, polygons):
    """@raises UnknownInput of a facet that has no plane to speak of: what it bounds depends on how it is triangulated"""
    largest = max(polygons, key=len)
    normal, origin = normal_of(points, list(zip(largest, largest[1:] + largest[:1]))), points[largest[0]]
    size = math.isqrt(dot(normal, normal))
    if len(largest) < 4 or size == 0:
        return
    heights = [dot(normal, minus(points[v], origin)) for p in polygons for v in p]
    extent = max(max(c) - min(c) for c in zip(*(points[v] for p in polygons for v in p)))
    if 10000 * (max(heights) - min(heights)) > extent * size:
        raise UnknownInput("a polygon far from planar")


def faces_of(given, points, number, unit):
    """The faces of all facets, by the numbers of distinct points; repeated ones once."""
    faces, seen = [], set()
    for polygons, holes, _ in given.facets:
        polygons = [[number[v] for v in p] for p in polygons]
        polygons = [[v for k, v in enumerate(p) if v != p[k - 1]] for p in polygons if p]
        if not any(len(set(p)) > 2 for p in polygons):
            continue
        refuse_bent(points, polygons)
        if len(polygons) == 1 and len(set(polygons[0])) == len(polygons[0]):
            p = polygons[0]
            new = [list(zip(p, p[1:] + p[:1]))]
        else:
            new = plane_faces(points, [p for p in polygons if len(p) > 1], [in_steps(h, unit) for h in holes])
        for face in new:
            key = frozenset(tuple(sorted(e)) for e in face)
            if key not in seen and any(normal_of(points, face)):
                seen.add(key)
                faces.append(face)
    return faces


def refuse_crossings(points, edges):
    """@raises UnknownInput where segments cross, or lie on each other, be it by an ulp"""
    def turn(a, b, c):
        return determinant(minus(points[b], points[a]), minus(points[c], points[a]))

    def are_apart(a, b, c, d):
        x, y = turn(a, b, c), turn(a, b, d)
        return (x > 0 and y > 0) or (x < 0 and y < 0)

    by_x = sorted((min(points[a], points[b]), max(points[a], points[b]), a, b) for a, b in edges)
    for i, (_, high, a, b) in enumerate(by_x):
        ys = sorted((points[a][1], points[b][1]))
        for low, _, c, d in by_x[i + 1:]:
            if low[0] > high[0]:
                break
            if {a, b} & {c, d} or max(points[c][1], points[d][1]) < ys[0] or min(points[c][1], points[d][1]) > ys[1]:
                continue
            if not are_apart(a, b, c, d) and not are_apart(c, d, a, b):
                raise UnknownInput("segments cross")


def complex_of(given):
    """The Complex of an input, and the steps to a unit."""
    seeds = [*given.holes, *(p for p, _ in given.regions), *(h for _, holes, _ in given.facets for h in holes)]
    unit = unit_of([*given.points, *seeds])
    place, number, points = {}, [], []
    for p in given.points:
        p = in_steps(p, unit)
        if p not in place:
            place[p] = len(points)
            points.append(p)
        number.append(place[p])
    if given.dimension == 2:
        edges = {tuple(sorted((number[a], number[b]))) for a, b, _ in given.segments if number[a] != number[b]}
        chains = split_at_points(points, sorted(edges), {v for e in edges for v in e})
        pieces = sorted({tuple(sorted(e)) for chain in chains for e in pieces_of(chain)})
        refuse_crossings(points, pieces)
        return Complex(points, pieces), unit
    faces = faces_of(given, points, number, unit)
    if not faces:
        raise UnknownInput("no faces")
    faces = divided_by_ends(points, divided_by_coplanar(points, faces))
    uses = collections.Counter(tuple(sorted(e)) for face in faces for e in face)
    open_edges = [e for e, n in uses.items() if n == 1]
    if open_edges:
        ends = {v for e in open_edges for v in e}
        chains = dict(zip(open_edges, split_at_points(points, open_edges, ends)))
        faces = [[piece for u, v in face for piece in pieces_of(
            (lambda c: c if c[0] == u else c[::-1])(chains.get((min(u, v), max(u, v)), [u, v])))] for face in faces]
    return Complex(points, faces), unit
