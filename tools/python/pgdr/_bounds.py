# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The bounds that `mesh`, `check` and `estimate` share."""
from __future__ import annotations

from typing import Any, Dict, Mapping

from . import _arguments, _pgdr
from ._errors import DiagnosedError, Diagnostic, usage
from ._fields import core_of
from ._plc import Plc


def require_walls(plc: Plc) -> None:
    """Points alone enclose nothing: says what is missing."""
    if plc.dimension == 2 and not len(plc.segments):
        words = "there are no segments: of points alone, pgdr.with_convex_hull(plc) has the edges of their hull as segments"
    elif plc.dimension == 3 and not plc._core.facet_count:
        words = ("there are no facets: the triangles or polygons of a closed surface are needed, as facets of pgdr.Plc; of points alone, "
                 "pgdr.with_convex_hull(plc) has those of their hull")
    else:
        return
    raise DiagnosedError._of(Diagnostic("encloses_nothing", words))


def sizes_by_label(sizes: Mapping[Any, Any], names: Mapping[float, str]) -> Mapping[Any, Any]:
    """Sizes of regions by label, some of which are given by name. @raises UsageError for a name that no region has"""
    made: Dict[Any, Any] = {}
    for key, size in _arguments.mapping("region_sizes", sizes, "label and size").items():
        labels = [label for label, name in names.items() if name == key] if isinstance(key, str) else [key]
        if not labels:
            raise usage(f"region_sizes: no region is called {key!r}; " + (f"there are {', '.join(names.values())}" if names else
                                                                          "none has a name"))
        for label in labels:
            if label in made:
                raise usage(f"region_sizes: two sizes for the label {label}")
            made[label] = size
    return made


def bounds_of(dimension: int, bounds: Mapping[str, Any]) -> _pgdr._Options:
    """Options of the extension module with these bounds, which `mesh` and `check` share."""
    options = _pgdr.Options2() if dimension == 2 else _pgdr.Options3()
    for name in ("min_angle",) if dimension == 3 else ("min_dihedral", "max_volume"):
        if bounds.get(name) is not None:
            raise usage(f"{name} is for {5 - dimension}D: " + ("radius_edge bounds circumradius over shortest edge, min_dihedral the "
                        "dihedral angles" if dimension == 3 else "min_angle bounds the angles of triangles, size their areas"))
    if "min_angle" in bounds and "radius_edge" in bounds:
        raise usage("min_angle and radius_edge are the same bound: give one of them")
    if "min_angle" in bounds:
        options.radius_edge_bound = _pgdr.min_angle_degrees(_arguments.number("min_angle", bounds["min_angle"]))
    if "radius_edge" in bounds:
        options.radius_edge_bound = _arguments.number("radius_edge", bounds["radius_edge"])
    if "size" in bounds:
        options.set_size(core_of("size", bounds["size"], dimension))
    for label, size in _arguments.mapping("region_sizes", bounds.get("region_sizes", {}), "label and size").items():
        options.add_region_size(_arguments.number("a label of region_sizes", label),
                                core_of(f"region_sizes[{label!r}]", size, dimension))
    if "min_dihedral" in bounds:
        options.min_dihedral = _arguments.number("min_dihedral", bounds["min_dihedral"])
    if "max_volume" in bounds:
        options.max_volume = _arguments.number("max_volume", bounds["max_volume"])
    if "regions" in bounds:
        options.set_regions(_arguments.word("regions", bounds["regions"], ("seeds", "auto", "all")))
    return options
