# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Which solids the facets of an input mean."""
from __future__ import annotations

from typing import NamedTuple, Sequence, Tuple

from . import _arguments, _pgdr
from ._ending import WORK
from ._errors import Diagnostic, usage
from ._plc import Plc


class BodyRegion(NamedTuple):
    """What has one label, of the bodies of an input."""

    label: float  #: of its cells
    volume: float  #: exact, rounded once
    bodies: Sequence[int]  #: that it is of, counted from 0


class Bodies(NamedTuple):
    """What is known of the bodies of an input."""

    regions: Sequence[BodyRegion]  #: by label
    names: Sequence[str]  #: of each body; "" where it has none
    repairs: Sequence[Diagnostic]  #: where crossings were resolved
    warnings: Sequence[Diagnostic]  #: `unsure_volume`, of open bodies; `inconsistent_orientation`: what was turned over


def with_bodies(plc: Plc, regions: str, *, resolve_crossings: bool = False, markers: str = "smallest") -> Tuple[Plc, Bodies]:
    """3D: the input with seeds that say which bodies are where, for `pgdr.mesh(plc)` as it stands.

    A body is what hangs together by edges of facets. Winding numbers say what is inside of it, exactly where it is closed.

    Parameters
    ----------
    plc : its facets may touch, repeat, overlap in a plane, or lie in each other
    regions : "union": a label each connected solid, and no facets in it; "fragments": a label each set of bodies; "priority": a label
        each body, and the first one has what several share; "disjoint": as "fragments", but bodies that overlap are an error
    resolve_crossings, markers : facets may cross, too, and are cut along each other, as by `pgdr.resolve_crossings`

    >>> import pgdr
    >>> corners = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    >>> sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    >>> points = corners + [[3 * x - 1 for x in p] for p in corners]
    >>> plc = pgdr.Plc(points, facets=sides + [[i + 8 for i in side] for side in sides])
    >>> labelled, bodies = pgdr.with_bodies(plc, "fragments")
    >>> [(r.label, r.volume, list(r.bodies)) for r in bodies.regions]
    [(1.0, 26.0, [1]), (2.0, 1.0, [0, 1])]
    """
    if not isinstance(plc, Plc):
        raise TypeError(f"plc must be a pgdr.Plc, not {type(plc).__name__}")
    if not isinstance(plc._core, _pgdr.Plc3):
        raise usage("bodies are told in 3D")
    word = _arguments.word("regions", regions, ("union", "fragments", "priority", "disjoint"))
    rule = _arguments.word("markers", markers, ("smallest", "first", "last"))
    with WORK:
        core, found, names, repairs, warnings = _pgdr.with_bodies(
            plc._core, word, _arguments.flag("resolve_crossings", resolve_crossings), rule)
    return Plc._of(core), Bodies([BodyRegion(*r) for r in found], names, repairs, warnings)
