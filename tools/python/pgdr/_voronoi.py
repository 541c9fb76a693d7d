# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The Voronoi cells of the vertices of a mesh in 2D, clipped to its domain, for finite volumes."""
from __future__ import annotations

from typing import Iterator, NamedTuple, Tuple

import numpy as np
import numpy.typing as npt

from . import _arguments, _pgdr
from ._doors import door
from ._ending import WORK
from ._errors import usage
from ._mesh import Mesh

_Reals = npt.NDArray[np.float64]
_Ints = npt.NDArray[np.int64]


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
        with WORK:
            _pgdr.write_voronoi(self.sites, self.points, self.offsets, self.corners, _arguments.path(path))


@door
def voronoi(mesh: Mesh) -> Voronoi:
    """See Mesh.voronoi."""
    if mesh.dimension != 2:
        raise usage("Voronoi cells are of meshes in 2D")
    with WORK:
        points, offsets, corners, areas, links, widths, lengths = _pgdr.voronoi_cells(mesh._core)
    return Voronoi(np.asarray(mesh.points), points, offsets, corners, areas, links, widths, lengths)
