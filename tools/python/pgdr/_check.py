# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The checker, the diagnosis of inputs, and what is in a file."""
from __future__ import annotations

import math
from typing import Any, Dict, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _arguments, _pgdr
from ._bounds import bounds_of
from ._doors import door
from ._ending import WORK
from ._errors import Diagnostic, usage
from ._estimate import estimate_if_valid
from ._mesh import Mesh, required_mask
from ._plc import Plc
from ._report import CheckReport

_BOUNDS = ("min_angle", "radius_edge", "size", "region_sizes", "min_dihedral", "max_volume", "regions")


@door
def check(mesh: Mesh, plc: Union[None, Plc, Mesh] = None, *, delaunay: Optional[bool] = None,
          conforming_delaunay: Optional[bool] = None, reasons: bool = True,
          surface_tolerance: Union[None, float, str] = None, feature_angle: float = 40.0,
          keep_boundary: Union[None, bool, Sequence[int]] = None, required: Optional[npt.ArrayLike] = None,
          **bounds: Any) -> CheckReport:
    """Certifies a mesh, with exact arithmetic: that its cells are one, that it conforms to the input as given, and that the bounds
    hold but where its reasons, each of which is verified, say why not. Those that regions of the input have count unless the run that
    made the mesh ended early. Some 5 microseconds a cell.

    Parameters
    ----------
    mesh : Mesh
        Of any origin.
    plc : Plc or Mesh, optional
        The input. None: only what can be said without it. A mesh: the one that `remesh` has made this one of. Its boundary, the faces
        between its labels, its subfacets and subsegments are to be there, and of its points the required ones.
    required : (n,) array of bool, optional
        With a mesh as input: which of its points are to be points of this one.
    delaunay : bool, optional
        Are faces to be locally Delaunay? None: if the run that made the mesh says so.
    conforming_delaunay : bool, optional
        2D: are triangles to be Delaunay across segments, too, and their circumcentres in the domain? None: if the mesh was made so.
        `Mesh.not_delaunay` lists cells that are not Delaunay.
    reasons : bool
        False: no cell has an excuse.
    surface_tolerance : float or str, optional
        3D: the mesh is of another surface, which is certified to be within this length of the given one, both ways, with its
        topology, markers and volumes; "0.1%" is of the diagonal of all points. 16 times the tolerance of the input at least.
    feature_angle : float
        With it: given edges at which normals differ by more than so many degrees, 0 to 180, have subsegments as near.
    keep_boundary : bool or sequence of int, optional
        Was the boundary to be kept, all or with these markers? Then it may have no points but given ones, and each given triangle is
        one subfacet (2D: each segment one subsegment). None: if the run that made the mesh kept it.
    min_angle, radius_edge, size, region_sizes, min_dihedral, max_volume, regions
        As `pgdr.mesh`. What is not given is no bound; `Mesh.check` takes those that the mesh was made with.

    >>> import pgdr
    >>> square = pgdr.Plc([[0, 0], [1, 0], [1, 1], [0, 1]], segments=[[0, 1], [1, 2], [2, 3], [3, 0]])
    >>> coarse = pgdr.mesh(square)
    >>> pgdr.check(coarse, square, size=0.001).exit_code
    6
    """
    if not isinstance(mesh, Mesh):
        raise TypeError(f"mesh must be a pgdr.Mesh, not {type(mesh).__name__}")
    if plc is not None and not isinstance(plc, (Plc, Mesh)):
        raise TypeError(f"plc must be a pgdr.Plc or a pgdr.Mesh, not {type(plc).__name__}")
    if plc is not None and plc.dimension != mesh.dimension:
        raise usage(f"the mesh has {mesh.dimension} dimensions, the input {plc.dimension}")
    points: Optional[npt.NDArray[np.uint8]] = None
    if isinstance(plc, Mesh):
        boundary = _pgdr.remesh_boundary2 if plc.dimension == 2 else _pgdr.remesh_boundary3
        core, points = boundary(plc._core, required_mask(plc, required), surface_tolerance is not None)
        plc = Plc._of(core)
        tolerance = mesh.statistics.get("tolerance")
        if tolerance is not None:
            plc = plc.with_tolerance(tolerance, coarse=True)
    elif required is not None:
        raise usage("required is of a mesh as input; of a pgdr.Plc all points are")
    unknown = sorted(set(bounds) - set(_BOUNDS))
    if unknown:
        raise TypeError(f"check() has no argument {unknown[0]!r}")
    bounds = {name: value for name, value in bounds.items() if value is not None}
    bounds.setdefault("regions", mesh._bounds.get("regions", "seeds"))
    options = bounds_of(mesh.dimension, bounds)
    if "radius_edge" not in bounds and "min_angle" not in bounds:
        options.radius_edge_bound = math.inf
    cosine = _pgdr.claimed_cosine(float(bounds["min_dihedral"])) if bounds.get("min_dihedral") else 1.0
    if delaunay is None:
        delaunay = bool(mesh.statistics.get("delaunay", False))
    made_so = bool(mesh._facts.get("conforming_delaunay", False))
    options.conforming_delaunay = made_so if conforming_delaunay is None else _arguments.flag("conforming_delaunay", conforming_delaunay)
    surface = _surface_tolerance(surface_tolerance, plc)
    angle = float(feature_angle)
    if not 0 <= angle <= 180:
        raise usage(f"feature_angle must be 0 to 180 degrees, not {feature_angle!r}")
    kept = mesh._facts.get("kept_boundary", False) if keep_boundary is None else keep_boundary
    options.keep_boundary, options.kept_markers = _arguments.kept("keep_boundary", kept)
    of_dimension = _pgdr.check2 if mesh.dimension == 2 else _pgdr.check3
    with WORK:
        return CheckReport(of_dimension(mesh._core, plc._core if plc is not None else None, options, cosine,
                                        _arguments.flag("delaunay", delaunay), int(mesh.statistics.get("not_delaunay_left") or 0),
                                        _arguments.flag("reasons", reasons),
                                        mesh.stop == "finished", surface, angle, points))


def _surface_tolerance(value: Union[None, float, str], plc: Optional[Plc]) -> str:
    """As the command has it; empty: none."""
    if value is None:
        return ""
    if plc is None or plc.dimension != 3:
        raise usage("surface_tolerance needs an input of three dimensions")
    return value if isinstance(value, str) else repr(float(value))


class Finding(NamedTuple):
    """All findings of one kind in an input."""

    kind: str  #: a stable word such as "facets_cross"
    number: int  #: of all of them
    is_error: bool  #: no mesh has these entities
    listed: Sequence[Tuple[Diagnostic, float]]  #: the first of them, with a measure: degrees of an angle, a length; or 0


def diagnose(plc: Plc, *, most_listed: int = 20, errors_only: bool = False) -> List[Finding]:
    """All that is wrong with an input, and where; then what is odd about it. Exact; about a second a million triangles.

    >>> import pgdr
    >>> cross = pgdr.Plc([[0, 0], [2, 2], [0, 2], [2, 0]], segments=[[0, 1], [2, 3]])
    >>> [f.kind for f in pgdr.diagnose(cross) if f.is_error]
    ['segments_cross']
    """
    if not isinstance(plc, Plc):
        raise TypeError(f"plc must be a pgdr.Plc, not {type(plc).__name__}")
    of_dimension = _pgdr.diagnose2 if plc.dimension == 2 else _pgdr.diagnose3
    most = _arguments.whole_number("most_listed", most_listed, 0, 2**32)
    with WORK:
        return [Finding(*found) for found in of_dimension(plc._core, most, _arguments.flag("errors_only", errors_only))]


def info(what: Union[Plc, Mesh, _arguments.Path]) -> Dict[str, Any]:
    """What is in an input, a mesh, or a file of either: counts, extent, labels; of a mesh its quality; of an input an `Estimate`, with
    the default bounds, as `estimate` (None: it is refused, and `diagnose` says why), which takes a while of large ones.

    >>> import pgdr
    >>> pgdr.info(pgdr.Plc([[0, 0], [1, 0], [1, 2]], segments=[[0, 1], [1, 2], [2, 0]]))["upper"]
    [1.0, 2.0]
    """
    if not isinstance(what, (Plc, Mesh)):
        file = _arguments.path(what)
        what = Mesh.read(file) if _pgdr.holds_cells(file) else Plc.read(file)
    points = what.points
    found: Dict[str, Any] = {"kind": "input" if isinstance(what, Plc) else "mesh", "dimension": what.dimension, "points": len(points),
                             "lower": points.min(axis=0).tolist() if len(points) else None,
                             "upper": points.max(axis=0).tolist() if len(points) else None}
    if isinstance(what, Plc):
        found.update(segments=len(what.segments), facets=what._core.facet_count, holes=len(what.holes), regions=len(what.regions),
                     tolerance=what.tolerance, file=what.file, estimate=estimate_if_valid(what))
    else:
        labels = sorted(set(what.regions.tolist()))
        found.update(cells=len(what.cells), subsegments=len(what.subsegments), subfacets=len(what.subfacets), labels=labels,
                     quality=what.quality())
    return found
