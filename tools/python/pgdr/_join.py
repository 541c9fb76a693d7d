# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes that are joined."""
from __future__ import annotations

from typing import NamedTuple, Sequence, Tuple

import numpy as np
import numpy.typing as npt

from . import _arguments, _pgdr
from ._ending import WORK
from ._errors import Diagnostic, usage
from ._mesh import Mesh


class Shared(NamedTuple):
    """Faces (2D: edges), or edges of segments, that two meshes have in common, of equal markers each."""

    meshes: Tuple[int, int]  #: the first one, whose marker stands, and a later one
    markers: Tuple[int, int]  #: what the two of them say; 0 where one lists none
    number: int  #: so many


class JoinedLabel(NamedTuple):
    """A label of one mesh, and what has become of it."""

    mesh: int  #: which, from 0
    given: float  #: what its cells had
    label: float  #: what they have


class Joined(NamedTuple):
    """The mesh, and what is what of those that were given."""

    mesh: Mesh  #: cells mesh by mesh, in their order
    vertices: Sequence[npt.NDArray[np.int32]]  #: of each mesh, the row in `mesh.points` that each of its points has become
    first_cell: Sequence[int]  #: the row of each mesh's first cell; and behind them how many cells there are
    shared_points: int  #: points of several meshes
    interfaces: Sequence[Shared]  #: faces (2D: edges) with a cell of one mesh and one of another
    shared_segments: Sequence[Shared]  #: 3D: subsegments that several meshes list
    labels: Sequence[JoinedLabel]  #: all labels of all meshes
    added_walls: int  #: faces of one cell alone, of two labels or of two meshes that no mesh lists: with marker 0
    dropped: Sequence[str]  #: what of the meshes does not come along, and why
    warnings: Sequence[Diagnostic]  #: points that may be meant to be one (`near_points`)


def join(meshes: Sequence[Mesh], *, relabel: bool = False, names: Sequence[str] = ()) -> Joined:
    """One conforming mesh of meshes whose boundaries match. Any thread; other Python threads run meanwhile.

    Points are one where their coordinates are equal, faces (2D: edges) where their corners are: exactly, without a tolerance. Where
    several meshes have something, what the first one says of it stands. Labels, markers, names come along, markers and attributes of
    points if all meshes have them.

    Parameters
    ----------
    meshes : sequence of Mesh
        All 2D or all 3D, each sound in itself (`pgdr.check(mesh)`).
    relabel : bool
        Labels of different meshes become different ones, 1, 2, ...; else equal labels stay one label.
    names : sequence of str
        What the meshes are called in messages; "mesh 0", "mesh 1", ... if there are none.

    Raises
    ------
    InputError
        The boundaries meet, and do not match, or the insides overlap: `diagnostics` has the first twenty of each kind, with rows of
        points and cells, and where they are.

    >>> import pgdr
    >>> def square(x):
    ...     corners = [[x, 0], [x + 1, 0], [x + 1, 1], [x, 1]]
    ...     return pgdr.mesh(pgdr.Plc(corners, segments=[[0, 1], [1, 2], [2, 3], [3, 0]]), refine=False)
    >>> joined = pgdr.join([square(0), square(1)], relabel=True)
    >>> joined.mesh.points.shape, joined.shared_points, sorted(set(joined.mesh.regions)), bool(joined.mesh.check())
    ((6, 2), 2, [1.0, 2.0], True)
    >>> joined.interfaces
    [Shared(meshes=(0, 1), markers=(0, 0), number=1)]
    """
    given = list(meshes)
    for mesh in given:
        if not isinstance(mesh, Mesh):
            raise TypeError(f"meshes must be a sequence of pgdr.Mesh, not of {type(mesh).__name__}")
    if not given:
        raise usage("there is no mesh to join")
    dimension = given[0].dimension
    if any(mesh.dimension != dimension for mesh in given):
        raise usage("meshes of 2D and of 3D cannot be joined")
    call = _pgdr.join2 if dimension == 2 else _pgdr.join3
    with WORK:
        core, vertices, first, points, interfaces, segments, labels, added, dropped, warnings = call(
            [mesh._core for mesh in given], [str(name) for name in names], _arguments.flag("relabel", relabel))
    shared = [[Shared((m[0], m[1]), (k[0], k[1]), number) for m, k, number in found] for found in (interfaces, segments)]
    return Joined(Mesh._of(core), [_arguments.signed(v) for v in vertices], first, points, shared[0], shared[1],
                  [JoinedLabel(*label) for label in labels], added, dropped, warnings)
