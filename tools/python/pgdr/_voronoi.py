# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The Voronoi cells of the vertices of a mesh in 2D, clipped to its domain, for finite volumes."""
from __future__ import annotations

from typing import Iterator, NamedTuple, Tuple

import numpy as np
import numpy.typing as npt

from . import _arguments
from ._doors import door
from ._errors import FileError, usage
from ._mesh import Mesh
from .triangle import circumcenters

_Reals = npt.NDArray[np.float64]
_Ints = npt.NDArray[np.int64]
_ROUNDING = 1e-9  # of a cosine: so much over a right angle is rounding


class Voronoi(NamedTuple):
    """Cells about the n vertices of a mesh, and the m links between them. Arrays; indices count from 0."""

    sites: _Reals  #: (n, 2) the vertices of the mesh
    points: _Reals  #: (k, 2) corners of cells: circumcentres of triangles, middles of boundary edges, vertices of the boundary
    offsets: _Ints  #: (n + 1,) the corners of cell i are corners[offsets[i]:offsets[i + 1]]; none: a vertex without triangles
    corners: _Ints  #: (c,) rows of `points`, counterclockwise
    areas: _Reals  #: (n,) of the cells; their sum is the domain's
    links: _Ints  #: (m, 2) cells with a common side, smaller first, sorted: the edges of the mesh
    widths: _Reals  #: (m,) the length of that side, which is at right angles to the link
    lengths: _Reals  #: (m,) from site to site

    def cells(self) -> Iterator[_Reals]:
        """The corners of one cell after the other."""
        for begin, end in zip(self.offsets[:-1], self.offsets[1:]):
            yield self.points[self.corners[begin:end]]

    def write(self, path: _arguments.Path) -> None:
        """Writes a text, .voronoi: a line `# pgdr voronoi 1`; the numbers of points and cells; the points; of each cell its site, how
        many corners it has, and their rows, from 0. Raises FileError."""
        rows = [f"# pgdr voronoi 1\n{len(self.points)} {len(self.sites)}\n"]
        rows += [f"{x!r} {y!r}\n" for x, y in self.points.tolist()]
        at = self.offsets.tolist()
        numbers = list(map(str, self.corners.tolist()))
        rows += [f"{x!r} {y!r} {end - begin} {' '.join(numbers[begin:end])}".rstrip() + "\n"
                 for (x, y), begin, end in zip(self.sites.tolist(), at[:-1], at[1:])]
        name = _arguments.path(path)
        try:
            with open(name, "w", encoding="ascii") as file:
                file.writelines(rows)
        except OSError as error:
            raise FileError(f"cannot be written: {error.strerror}", code="cannot_write", file=name) from None


def _cosines(at: _Reals) -> _Reals:
    """(m, 3) of the angles of (m, 3, 2) triangles."""
    to_next, to_last = np.roll(at, -1, axis=1) - at, np.roll(at, 1, axis=1) - at
    made: _Reals = (to_next * to_last).sum(axis=2) / np.sqrt((to_next ** 2).sum(axis=2) * (to_last ** 2).sum(axis=2))
    return made


def _require_centers_inside(at: _Reals, beyond: _Ints) -> None:
    """No angle opposite a boundary edge is obtuse, and no two opposite an inner edge are more than 180 degrees together."""
    cosine = _cosines(at)
    other, back = beyond // 3, beyond % 3
    opposite = np.where(beyond < 0, 0, cosine[other, back])
    wrong = (cosine + opposite < -_ROUNDING).sum()
    if wrong:
        raise usage(f"at {wrong} edges of the mesh the circumcentres are not in the domain, or in the wrong order: make the mesh with "
                    "conforming_delaunay=True")


def _faces_beyond(mesh: Mesh, cells: _Ints) -> _Ints:
    """(m, 3) three times the triangle beyond the edge opposite each corner, and its corner opposite that; -1: none."""
    neighbor = np.asarray(mesh.neighbors(), dtype=np.int64)
    total = cells.sum(axis=1)
    apex = total[neighbor] - (total[:, None] - cells)
    place = (cells[neighbor] == apex[:, :, None]).argmax(axis=2)
    return np.where(neighbor < 0, -1, 3 * neighbor + place)


@door
def voronoi(mesh: Mesh) -> Voronoi:
    """See Mesh.voronoi."""
    if mesh.dimension != 2:
        raise usage("Voronoi cells are of meshes in 2D")
    sites, cells = np.asarray(mesh.points), np.asarray(mesh.cells, dtype=np.int64)
    beyond = _faces_beyond(mesh, cells)
    _require_centers_inside(sites[cells], beyond)
    centers = circumcenters(sites[cells])
    first, second = np.roll(cells, -1, axis=1), np.roll(cells, -2, axis=1)  # of each corner, the others in turn
    starts, ends = np.roll(beyond, -2, axis=1) < 0, np.roll(beyond, -1, axis=1) < 0  # nothing before it, behind it
    edges, cell, corner = _boundary(cells, beyond)
    middles = len(centers) + np.arange(len(edges))
    on_boundary = np.unique(edges)
    own = np.full(len(sites), -1)
    own[on_boundary] = len(centers) + len(edges) + np.arange(len(on_boundary))
    points = np.concatenate([centers, sites[edges].mean(axis=1), sites[on_boundary]])
    middle_of = np.full(cells.shape, -1)
    middle_of[cell, corner] = middles  # of the edge opposite a corner
    order = _about_vertices(sites, cells, first, second, starts)
    vertex = cells.reshape(-1)[order]
    triangle = order // 3
    start, end = starts.reshape(-1)[order], ends.reshape(-1)[order]
    columns = np.stack([np.where(start, own[vertex], -1), np.where(start, np.roll(middle_of, -2, axis=1).reshape(-1)[order], -1), triangle,
                        np.where(end, np.roll(middle_of, -1, axis=1).reshape(-1)[order], -1)], axis=1)
    there = columns >= 0
    corners = columns[there]
    offsets = np.concatenate([[0], np.cumsum(np.bincount(vertex, weights=there.sum(axis=1), minlength=len(sites)).astype(np.int64))])
    links, widths = _links(cells, beyond, centers, points, middle_of)
    lengths = np.linalg.norm(sites[links[:, 0]] - sites[links[:, 1]], axis=1)
    return Voronoi(sites, points, offsets, corners, _areas(sites, points, offsets, corners), links, widths, lengths)


def _boundary(cells: _Ints, beyond: _Ints) -> Tuple[_Ints, _Ints, _Ints]:
    """The edges with one triangle, and the corner that each is opposite of."""
    cell, corner = np.nonzero(beyond < 0)
    return np.stack([cells[cell, (corner + 1) % 3], cells[cell, (corner + 2) % 3]], axis=1), cell, corner


def _about_vertices(sites: _Reals, cells: _Ints, first: _Ints, second: _Ints, starts: npt.NDArray[np.bool_]) -> _Ints:
    """The corners of triangles, vertex by vertex, counterclockwise about each, from one with nothing before it, if there is one."""
    vertex = cells.reshape(-1)
    a, b = (sites[other.reshape(-1)] - sites[vertex] for other in (first, second))
    direction = a / np.linalg.norm(a, axis=1)[:, None] + b / np.linalg.norm(b, axis=1)[:, None]
    angle = np.arctan2(direction[:, 1], direction[:, 0])
    order = np.lexsort((angle, vertex))
    of = vertex[order]
    begins = np.searchsorted(of, np.arange(len(sites) + 1))
    counts = np.diff(begins)
    place = np.arange(len(of)) - begins[of]
    shift = np.full(len(sites), 3 * len(cells))
    np.minimum.at(shift, of, np.where(starts.reshape(-1)[order], place, 3 * len(cells)))
    shift = np.where(shift < counts, shift, 0)
    made: _Ints = order[begins[of] + (place + shift[of]) % np.maximum(counts[of], 1)]
    return made


def _links(cells: _Ints, beyond: _Ints, centers: _Reals, points: _Reals, middle_of: _Ints) -> Tuple[_Ints, _Reals]:
    """The edges, and how wide their cells' common sides are."""
    number = 3 * np.arange(len(cells))[:, None] + np.arange(3)
    chosen = (beyond < 0) | (number < beyond)
    cell, corner = np.nonzero(chosen)
    edges = np.sort(np.stack([cells[cell, (corner + 1) % 3], cells[cell, (corner + 2) % 3]], axis=1), axis=1)
    other = beyond[cell, corner]
    to = np.where((other < 0)[:, None], points[middle_of[cell, corner]], centers[other // 3])
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    return edges[order], np.linalg.norm(to - centers[cell], axis=1)[order]


def _areas(sites: _Reals, points: _Reals, offsets: _Ints, corners: _Ints) -> _Reals:
    """By triangles with the site, so that far from the origin nothing cancels."""
    owner = np.repeat(np.arange(len(sites)), np.diff(offsets))
    following = np.arange(1, len(corners) + 1)
    last = offsets[1:][np.diff(offsets) > 0] - 1
    following[last] = offsets[:-1][np.diff(offsets) > 0]
    a, b = points[corners] - sites[owner], points[corners[following]] - sites[owner]
    halves = (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
    return np.asarray(np.bincount(owner, weights=halves, minlength=len(sites)), dtype=np.float64)
