# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Sides that correspond, vertex by vertex."""
from __future__ import annotations

from typing import Any, List, NamedTuple, Sequence, Tuple

import numpy as np
import numpy.typing as npt

from . import _arguments, _pgdr
from ._ending import WORK
from ._errors import usage

Sides = Tuple[int, int, List[float]]


class Periodic(NamedTuple):
    """Two sides of a mesh, vertex by vertex."""

    from_marker: int  #: of the side that the other is an image of
    to_marker: int  #: of that one
    motion: npt.NDArray[np.float64]  #: (D, D + 1): of each coordinate of an image the factors, and what is added
    points: npt.NDArray[np.int32]  #: (n, 2) rows of vertices, and of their images
    walls: int  #: so many subsegments (3D: subfacets) of each, image by image
    exact: int  #: of the points: the image is that by the motion, exact and rounded once
    largest_gap: float  #: most that an image is from that


def sides_of(given: Sequence[Any], dimension: int) -> List[Sides]:
    """(from, to) or (from, to, motion) each, as the extension module takes them."""
    made: List[Sides] = []
    for row in given:
        if not isinstance(row, (tuple, list)) or len(row) not in (2, 3):
            raise usage("periodic must be a list of (from, to) or (from, to, motion)")
        markers = [_arguments.whole_number("a marker of periodic", marker, -2**31, 2**31 - 1) for marker in row[:2]]
        motion = [] if len(row) == 2 else _arguments.reals("a motion of periodic", row[2]).ravel().tolist()
        if motion and len(motion) != dimension * (dimension + 1):
            raise usage(f"a motion of periodic has {dimension * (dimension + 1)} numbers in {dimension}D, row by row, not {len(motion)}")
        made.append((markers[0], markers[1], motion))
    return made


def paired(core: _pgdr._Mesh, sides: Sequence[Sides], tolerance: float) -> List[Periodic]:
    """The pairs of a mesh, which has them from then on."""
    pair = _pgdr.pair2 if isinstance(core, _pgdr.Mesh2) else _pgdr.pair3
    made = []
    for side in sides:
        with WORK:
            markers_from, markers_to, motion, points, walls, exact, gap = pair(core, side, tolerance)
        dimension = 2 if isinstance(core, _pgdr.Mesh2) else 3
        made.append(Periodic(markers_from, markers_to, np.array(motion).reshape(dimension, dimension + 1), _arguments.signed(points),
                             walls, exact, gap))
    return made
