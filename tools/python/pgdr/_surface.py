# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Another surface within a tolerance."""
from __future__ import annotations

from typing import Any, Dict, NamedTuple, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import _arguments, _pgdr
from ._ending import WORK
from ._errors import usage
from ._plc import Plc


class ReplacedSurface(NamedTuple):
    """Another surface, and what it stands for."""

    plc: Plc  #: what to mesh; points and facets are in an order of their own
    facet_of_input: npt.NDArray[np.int64]  #: of each facet of plc a facet of the input that it is near
    report: Dict[str, Any]  #: by the names of the command's report (docs/usage.md)


def replace_surface(plc: Plc, tolerance: Union[float, str], *, feature_angle: float = 40.0,
                    wanted_corner: float = 30.0, fixed_markers: Sequence[int] = ()) -> ReplacedSurface:
    """3D: another surface in the place of the input's, without its needles, within a distance of it both ways and marker by marker,
    with its topology, creases, segments and volumes (docs/surface.md). Any thread; other Python threads run meanwhile.

    Parameters
    ----------
    plc : Plc
    tolerance : float or str
        Most that one surface is from the other: a length, or "0.1%" of the diagonal of all points.
    feature_angle : float
        Degrees: where normals differ by more is a crease, which stays; 180: there are none.
    wanted_corner : float
        Degrees: smaller angles of facets are made larger, where that is possible.
    fixed_markers : sequence of int
        Facets with these markers stay as they are, with all of their points.

    Raises
    ------
    UsageError
        The tolerance is not positive, or below 16 times that within which things meet.
    InputError
        An input that has no mesh, or a seed within the tolerance of the surface.

    >>> import pgdr
    >>> corners = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    >>> sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    >>> made = pgdr.replace_surface(pgdr.Plc(corners, facets=sides), "0.1%")
    >>> made.plc.points.shape, made.report["creases"], made.report["split"]
    ((8, 3), 12, 0)
    """
    if not isinstance(plc, Plc):
        raise TypeError(f"plc must be a pgdr.Plc, not {type(plc).__name__}")
    if not isinstance(plc._core, _pgdr.Plc3):
        raise usage("surfaces are replaced in 3D")
    text = tolerance if isinstance(tolerance, str) else repr(_arguments.number("tolerance", tolerance))
    with WORK:
        core, facets, report = _pgdr.replace_surface(plc._core, text, _arguments.number("feature_angle", feature_angle),
                                                     _arguments.number("wanted_corner", wanted_corner),
                                                     [_arguments.whole_number("a marker", marker, -2**31, 2**31 - 1) for marker in fixed_markers])
    return ReplacedSurface(Plc._of(core), np.array(facets, dtype=np.int64), report)
