# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""`triangulate`: what users of the Python package `triangle` call, in terms of `pgdr.mesh`."""
from __future__ import annotations

import re
from typing import Any, Dict, Mapping, Optional, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _arguments
from ._check import check
from ._errors import InputError, usage
from ._fields import Field, Size, smallest
from ._mesh import Mesh
from ._plc import Plc, resolve_crossings, with_convex_hull
from ._remesh import refine
from ._run import mesh

_KEYS = ("vertices", "vertex_attributes", "vertex_markers", "segments", "segment_markers", "holes", "regions")
_RESULTS = ("triangles", "triangle_attributes", "triangle_max_area", "neighbors", "edges", "edge_markers")

# Switches that change nothing here, each for a reason: i, F, l choose algorithms whose triangulations are the same; X asks for
# inexact arithmetic, which is never needed; Q and V are about printing, which is never done; z counts from 0, as always; I is about
# names of files; v has nothing to say in this result, pgdr.triangle.voronoi has the diagram.
_WITHOUT_EFFECT = "iFlXQVzIv"
_REFUSED = {
    "s": "segments are inserted without new points: leave s out, or give D, which makes all triangles Delaunay",
    "g": "no file is written: call Mesh.write",
    "h": "see help(pgdr.triangulate)",
}
_PLAIN = "prcjenYAPNEBOCuD"


def _switches(opts: str) -> Dict[str, Any]:
    """What each letter says: True, a number, or how often it stands there."""
    if not isinstance(opts, str):
        raise TypeError(f"opts must be a str of switches, not {type(opts).__name__}")
    found: Dict[str, Any] = {}
    for letter, number in re.findall(r"(.)([0-9.]*)", opts.replace("-", "").replace(" ", ""), re.DOTALL):
        if letter in _REFUSED:
            raise usage(f"switch {letter} of {opts!r}: {_REFUSED[letter]}")
        if letter not in _PLAIN + _WITHOUT_EFFECT + "qaSo":
            raise usage(f"{opts!r} has the unknown switch {letter!r}")
        if number and letter not in "qaSo":
            raise usage(f"switch {letter} of {opts!r} takes no number")
        if letter == "S" and not number.isdigit():
            raise usage(f"switch S of {opts!r} needs a whole number: the most points to add")
        if letter == "o" and number not in ("1", "2"):
            raise usage(f"switch o of {opts!r} is o2: triangles with a vertex in the middle of each edge; or o1")
        if letter in "qa" and number:
            try:
                found[letter + "#"] = float(number)
            except ValueError:
                raise usage(f"switch {letter} of {opts!r}: {number!r} is no number") from None
        elif letter == "S":
            found["S"] = int(number)
        elif letter != "o" or number == "2":
            found[letter] = True
    return found


def _given(tri: Mapping[str, Any], switches: Mapping[str, Any]) -> Dict[str, Any]:
    """The entries of the input that count."""
    tri = _arguments.mapping("tri", tri, "arrays")
    unknown = [str(key) for key in tri if key not in _KEYS + _RESULTS]
    if unknown:
        raise usage(f"unknown keys {', '.join(sorted(unknown))}: there are {', '.join(_KEYS)}")
    if tri.get("vertices") is None or not np.size(tri["vertices"]):
        raise usage("the key vertices is missing: an (n, 2) array")
    given = {key: tri[key] for key in _KEYS if tri.get(key) is not None and np.size(tri[key])}
    if "p" not in switches and "r" not in switches:
        ignored = [key for key in ("segments", "segment_markers", "holes", "regions") if key in given]
        if ignored:
            raise usage(f"{', '.join(ignored)} count with the switch p alone: add it, or leave them out")
    if "O" in switches:
        given.pop("holes", None)
    return given


def _flat_markers(value: Any) -> Any:
    """Markers in the shape (n,) or (n, 1), as `triangle` takes both."""
    array = np.asarray(value)
    return array[:, 0] if array.ndim == 2 and array.shape[1] == 1 else array


def _plc(given: Mapping[str, Any], switches: Mapping[str, Any]) -> Plc:
    arguments: Dict[str, Any] = {"segments": given.get("segments"), "holes": given.get("holes")}
    if "segment_markers" in given:
        arguments["markers"] = _flat_markers(given["segment_markers"])
    if "vertex_markers" in given:
        arguments["point_markers"] = _flat_markers(given["vertex_markers"])
    if "vertex_attributes" in given:
        attributes = _arguments.reals("vertex_attributes", given["vertex_attributes"])
        arguments["point_attributes"] = attributes[:, None] if attributes.ndim == 1 else attributes
    if "regions" in given:
        rows = np.array(_arguments.reals("regions", given["regions"]))
        if rows.ndim == 2 and rows.shape[1] == 3:  # labels alone
            rows = np.pad(rows, ((0, 0), (0, 1)))
        if rows.ndim != 2 or rows.shape[1] != 4:
            raise usage(f"regions must have the shape (k, 4): x, y, attribute, largest area; or (k, 3), without; not {rows.shape}")
        if "a" not in switches:  # areas of regions count with a bare a
            rows[:, 3] = 0
        arguments["regions"] = np.maximum(rows, [-np.inf, -np.inf, -np.inf, 0])
    plc = Plc(given["vertices"], **arguments)
    if plc.dimension != 2:
        raise usage("vertices must have the shape (n, 2)")
    if "p" in switches:
        plc, _ = resolve_crossings(plc)
    return with_convex_hull(plc) if "c" in switches or "p" not in switches else plc


def _old(tri: Mapping[str, Any], given: Mapping[str, Any]) -> Mesh:
    """The triangulation that the switch r refines."""
    if tri.get("triangles") is None or not np.size(tri["triangles"]):
        raise usage("switch r of a dict without the key triangles, which it refines")
    arrays: Dict[str, Any] = {}
    if tri.get("triangle_attributes") is not None and np.size(tri["triangle_attributes"]):
        attributes = _arguments.reals("triangle_attributes", tri["triangle_attributes"])
        arrays["regions"] = attributes[:, 0] if attributes.ndim == 2 else attributes
    if "segments" in given:
        arrays["subsegments"] = given["segments"]
        if "segment_markers" in given:
            arrays["subsegment_markers"] = _flat_markers(given["segment_markers"])
    if "vertex_markers" in given:
        arrays["point_markers"] = _flat_markers(given["vertex_markers"])
    if "vertex_attributes" in given:
        arrays["point_attributes"] = given["vertex_attributes"]
    return Mesh.from_arrays(_arguments.points("vertices", given["vertices"], 2), np.asarray(tri["triangles"])[:, :3], **arrays)


def _refined(tri: Mapping[str, Any], given: Mapping[str, Any], switches: Mapping[str, Any], size: Optional[Size]) -> Tuple[Mesh, Mesh]:
    """What the switch r refines, and what that becomes. Holes and regions are those of the triangles."""
    old = _old(tri, given)
    options = _options(switches, len(old.points), size)
    areas = tri.get("triangle_max_area")
    if "a" in switches and areas is not None and np.size(areas):
        options["cell_bounds"] = _arguments.reals("triangle_max_area", areas).reshape(-1)
    elif "a" in switches:
        raise usage("switches r and a together need the key triangle_max_area, or a number behind a")
    return old, refine(old, **options)


def _options(switches: Mapping[str, Any], points: int, size: Optional[Size]) -> Dict[str, Any]:
    """The arguments of pgdr.mesh."""
    options: Dict[str, Any] = {"refine": any(key in switches for key in ("q", "q#", "a", "a#", "u", "D"))}
    angle = switches.get("q#", 20.0 if "q" in switches else 0.0)
    if angle > 0:
        options["min_angle"] = angle
    elif options["refine"]:  # an area alone, or q0
        options["radius_edge"] = float("inf")
    if "a#" in switches:
        options["size"] = switches["a#"]
    if "D" in switches:
        options["conforming_delaunay"] = True
    if "Y" in switches:
        options["keep_boundary"] = True
    if "S" in switches:
        options["max_vertices"] = points + switches["S"]
    if size is not None:
        own = options.pop("size", None)
        options["size"] = size if own is None else _smaller(size, own)
    return options


def _smaller(size: Size, own: float) -> Size:
    """The smaller of two sizes at each point."""
    if isinstance(size, Field):
        return smallest(size, own)
    if callable(size):
        function = size
        return lambda at: np.minimum(np.asarray(function(at)), own)
    return min(size, own)


def _numbering(result: Mesh) -> Tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """For each vertex to be, that of the mesh; and for each vertex of the mesh, the one to be: those of the input first, in its order,
    whether or not several are one in the mesh."""
    of_input = np.asarray(result.point_of_input, dtype=np.int64)
    others = np.ones(len(result.points), dtype=bool)
    others[of_input] = False
    source = np.concatenate([of_input, np.flatnonzero(others)])
    new = np.empty(len(result.points), dtype=np.int64)
    new[source[::-1]] = np.arange(len(source))[::-1]  # of several the first
    return source, new


def _ints(array: Any) -> npt.NDArray[np.int32]:
    return np.ascontiguousarray(array, dtype=np.int32)


def _columns(array: Any) -> npt.NDArray[np.int32]:
    return _ints(array).reshape(-1, 1)


def _edges(result: Mesh, boundary: npt.NDArray[np.int32]) -> Tuple[Any, Any]:
    """All edges, and a marker each: that of its subsegment, else 0."""
    edges = np.sort(np.asarray(result.edges(), dtype=np.int64), axis=1)
    count = len(result.points)
    subsegments = np.sort(np.asarray(result.subsegments, dtype=np.int64), axis=1)
    keys = subsegments[:, 0] * count + subsegments[:, 1]
    order = np.argsort(keys)
    wanted = edges[:, 0] * count + edges[:, 1]
    place = np.minimum(np.searchsorted(keys[order], wanted), max(len(keys) - 1, 0))
    found = keys[order][place] == wanted
    return edges, np.where(found, boundary[order][place], 0)


def _boundary_markers(result: Mesh) -> Tuple[npt.NDArray[np.int32], npt.NDArray[np.int32]]:
    """Markers of vertices and subsegments; what lies on the boundary and has none gets 1, as Triangle does it."""
    cells = np.asarray(result.cells, dtype=np.int64)
    beyond = np.asarray(result.neighbors(), dtype=np.int64)
    cell, corner = np.nonzero(beyond < 0)
    hull = np.sort(np.stack([cells[cell, (corner + 1) % 3], cells[cell, (corner + 2) % 3]], axis=1), axis=1)
    count = len(result.points)
    subsegments = np.sort(np.asarray(result.subsegments, dtype=np.int64), axis=1)
    on_hull = np.isin(subsegments[:, 0] * count + subsegments[:, 1], hull[:, 0] * count + hull[:, 1])
    segments = np.array(result.subsegment_markers, dtype=np.int32)
    vertices = np.array(result.point_markers, dtype=np.int32)
    if not len(vertices):
        vertices = np.zeros(count, dtype=np.int32)
        marked = np.flatnonzero(segments)[::-1]  # of several segments with a marker the first
        vertices[np.asarray(result.subsegments)[marked]] = np.asarray(result.subsegment_markers)[marked, None]
    at_hull = np.zeros(count, dtype=bool)
    at_hull[hull] = True
    vertices[at_hull & (vertices == 0)] = 1
    segments[on_hull & (segments == 0)] = 1
    return vertices, segments


def _output(result: Any, switches: Mapping[str, Any]) -> Dict[str, npt.NDArray[Any]]:
    vertex_markers, segment_markers = _boundary_markers(result)
    source, new = _numbering(result)
    if "j" in switches:
        used = np.unique(np.asarray(result.cells))
        source = source[np.isin(source, used) & (new[source] == np.arange(len(source)))]
        new = np.full(len(result.points), -1)
        new[source] = np.arange(len(source))
    out: Dict[str, npt.NDArray[Any]] = {}
    if "N" not in switches:
        out["vertices"] = np.asarray(result.points)[source]
        attributes = np.asarray(result.point_attributes)
        if attributes.size:
            out["vertex_attributes"] = attributes.reshape(len(result.points), -1)[source]
        out["vertex_markers"] = _columns(vertex_markers[source])
    if "E" not in switches:
        out["triangles"] = _ints(new[np.asarray(result.cells)])
        if "A" in switches:
            out["triangle_attributes"] = np.array(result.regions).reshape(-1, 1)
    if ("p" in switches or "c" in switches or "r" in switches) and "P" not in switches:
        out["segments"] = _ints(new[np.asarray(result.subsegments)])
        out["segment_markers"] = _columns(segment_markers)
    if "e" in switches:
        edges, markers = _edges(result, segment_markers)
        out["edges"], out["edge_markers"] = _ints(new[edges]), _columns(markers)
    if "n" in switches:
        out["neighbors"] = _ints(result.neighbors())
    if "o" in switches:
        _add_middles(out, result, source, segment_markers)
    return {key: value for key, value in out.items() if "B" not in switches or not key.endswith("_markers")}


def _add_middles(out: Dict[str, npt.NDArray[Any]], result: Mesh, source: npt.NDArray[np.int64], boundary: npt.NDArray[np.int32]) -> None:
    """A vertex in the middle of each edge, behind the others, and three further corners of each triangle, each opposite one."""
    edges, markers = _edges(result, boundary)
    cells, count = np.asarray(result.cells, dtype=np.int64), len(result.points)
    place = np.searchsorted(edges[:, 0] * count + edges[:, 1], [
        sides.min(axis=1) * count + sides.max(axis=1) for sides in (cells[:, [1, 2]], cells[:, [2, 0]], cells[:, [0, 1]])])
    attributes = np.asarray(result.point_attributes)
    for key, middles in (("vertices", np.asarray(result.points)[edges].mean(axis=1)), ("vertex_markers", _columns(markers)),
                         ("vertex_attributes", attributes.reshape(count, -1)[edges].mean(axis=1))):
        if key in out:
            out[key] = np.concatenate([out[key], middles])
    if "triangles" in out:
        out["triangles"] = np.concatenate([out["triangles"], _ints(len(source) + place.T)], axis=1)


def triangulate(tri: Mapping[str, Any], opts: str = "", *, size: Optional[Size] = None) -> Dict[str, npt.NDArray[Any]]:
    """2D: triangulates a dict of arrays, called as `triangle.triangulate` is. Any thread; other Python threads run meanwhile.

    Parameters
    ----------
    tri : dict
        vertices (n, 2); vertex_attributes (n, a); vertex_markers (n,) or (n, 1); and with the switch p: segments (m, 2),
        segment_markers (m,) or (m, 1), holes (k, 2), regions (k, 4) of x, y, attribute, largest area, or (k, 3), without the area. The keys of a result
        (triangles, neighbors, ...) may be there, too, so that a result is an input; they mean nothing without the switch r.
    opts : str
        p: segments, holes and regions count; without p or with c, the convex hull is the boundary. q, q25: no angle below 20
        degrees, or 25; at most 34. a0.1: no triangle is larger; a: nor larger than its region says. A: triangle_attributes. Y, YY:
        no new point on any segment. S100: at most so many new points. j: no vertex without a triangle. e: edges, edge_markers.
        n: neighbors. O: no holes. B, P, N, E: no markers, segments, vertices, triangles in the result. C: the result is checked.
        o2: six corners, the last three in the middle of the edges opposite the first three. u: no triangle is larger than `size`
        says. D: all triangles are Delaunay, as of conforming_delaunay of pgdr.mesh; not with Y. r: the triangles (and segments) of a result are
        refined: all vertices stay, as of pgdr.refine; triangle_attributes are labels, and with a, triangle_max_area, (m,) or (m, 1),
        bounds what lies in each triangle, 0 or less: any. i, F, l, X, Q, V, z, I, v change nothing. s, g are refused.
    size : float, Field, or function
        With the switch u: the largest area at a triangle's centroid, as of pgdr.mesh.

    Returns
    -------
    dict
        vertices (float64), vertex_attributes, vertex_markers (n, 1), triangles (m, 3), counterclockwise, triangle_attributes
        (m, 1), segments (k, 2), segment_markers (k, 1), edges, edge_markers, neighbors (m, 3), -1 beyond the boundary: as the
        switches say; integers are int32. The input's vertices come first, in their order. What lies on the boundary and has no
        marker has the marker 1.

    Raises
    ------
    UsageError
        A switch or key that is unknown or has no equivalent, or an array of a wrong shape or type.
    InputError
        What `pgdr.mesh` refuses. Segments that cross are no error: they are split there, as in Triangle.

    Examples
    --------
    >>> import pgdr
    >>> square = dict(vertices=[[0, 0], [1, 0], [1, 1], [0, 1]], segments=[[0, 1], [1, 2], [2, 3], [3, 0]])
    >>> made = pgdr.triangulate(square, "p")
    >>> sorted(made), made["triangles"].shape
    (['segment_markers', 'segments', 'triangles', 'vertex_markers', 'vertices'], (2, 3))
    """
    switches = _switches(opts)
    given = _given(tri, switches)
    if ("u" in switches) != (size is not None):
        raise usage("the switch u and size= come together: size is a number, a pgdr.Field, or a function of an (n, 2) array of points "
                    "that returns their n largest areas")
    made_of: Union[Plc, Mesh]
    if "r" in switches:
        made_of, result = _refined(tri, given, switches, size)
        required: Optional[npt.NDArray[np.bool_]] = np.ones(len(made_of.points), dtype=bool)
    else:
        plc = made_of = _plc(given, switches)
        result, required = mesh(plc, **_options(switches, len(plc.points), size)), None
    if "C" in switches:
        report = check(result, made_of, required=required)
        if not report:
            raise InputError(f"the mesh does not pass the check: {report}", code="internal")
    return _output(result, switches)
