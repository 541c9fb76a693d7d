# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What is known of a mesh before it is made."""
from __future__ import annotations

from typing import Any, Mapping, NamedTuple, Optional, Sequence, Tuple

from . import _pgdr
from ._bounds import bounds_of, require_walls
from ._ending import WORK
from ._errors import InputError
from ._fields import Size
from ._plc import Plc

#: What an entity of the input is, and its number there: ("facet", 3). An edge of facets that is no segment has None.
Entity = Tuple[str, Optional[int]]


class Gap(NamedTuple):
    """Two entities without a common point, and where they are nearest to each other."""

    distance: float  #: a length
    entities: Sequence[Entity]  #: both
    points: Sequence[Sequence[float]]  #: (D,) coordinates on each of them


class SharpAngle(NamedTuple):
    """Two segments at a point, or two facets at a segment."""

    degrees: float  #: the angle
    entities: Sequence[Entity]  #: both
    point: Sequence[float]  #: that they share


class Proposal(NamedTuple):
    """A tolerance for an input of few digits: two units of their last one."""

    tolerance: float  #: for `pgdr.mesh(tolerance=)`
    facets: int  #: 3D: how many there are, those in one plane counting as one
    facets_then: int  #: with it
    joined: int  #: points that it joins to points, segments and facets


class Estimate(NamedTuple):
    """What a mesh of an input will be like."""

    cells: float  #: at least so many: by sizes, by the walls, or `at_least`; infinity: no size that can be used
    at_least: float  #: the same by gaps alone, since they are so narrow; sizes do not count
    narrowest_gap: Optional[Gap]  #: None: no two entities are apart
    sharpest_angle: Optional[SharpAngle]  #: None: nothing meets
    proposal: Optional[Proposal]  #: None: a tolerance was given, or there is none that would change anything


def estimate(plc: Plc, *, min_angle: Optional[float] = None, radius_edge: Optional[float] = None, size: Optional[Size] = None,
             region_sizes: Optional[Mapping[float, Size]] = None, max_volume: Optional[float] = None,
             tolerance: Optional[float] = None) -> Estimate:
    """How many cells a mesh will have at least, and what it owes many of them to: near-linear time, half a second for a million
    triangles. The bounds are those of `pgdr.mesh`. A mesh within a size has some 2.5 times as many cells (2D: 1.6 times). Other
    Python threads run meanwhile.

    Raises UsageError and InputError as `pgdr.mesh` does, ResourceError where memory runs out.

    >>> import pgdr
    >>> square = pgdr.Plc([[0, 0], [1, 0], [1, 1], [0, 1]], segments=[[0, 1], [1, 2], [2, 3], [3, 0]])
    >>> ahead = pgdr.estimate(square, size=0.001)
    >>> 500 < ahead.cells < 5000, ahead.narrowest_gap.distance
    (True, 1.0)
    """
    if not isinstance(plc, Plc):
        raise TypeError(f"plc must be a pgdr.Plc, not {type(plc).__name__}")
    require_walls(plc)
    if tolerance is not None:
        plc = plc.with_tolerance(tolerance)
    given = {"min_angle": min_angle, "radius_edge": radius_edge, "size": size, "region_sizes": region_sizes, "max_volume": max_volume}
    options = bounds_of(plc.dimension, {name: value for name, value in given.items() if value is not None})
    of_dimension = _pgdr.estimate2 if plc.dimension == 2 else _pgdr.estimate3
    with WORK:
        cells, at_least, gap, angle, proposal = of_dimension(plc._core, options)
    return Estimate(cells, at_least, _made(Gap, gap), _made(SharpAngle, angle), _made(Proposal, proposal))


def _made(kind: Any, values: Optional[Tuple[Any, ...]]) -> Any:
    return None if values is None else kind(*values)


def estimate_if_valid(plc: Plc) -> Optional[Estimate]:
    """None of an input that has no mesh."""
    try:
        return estimate(plc)
    except InputError:
        return None
