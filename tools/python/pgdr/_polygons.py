# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs from rings and polygons: arrays, and whatever has a __geo_interface__, as Shapely and GeoPandas have it."""
from __future__ import annotations

import warnings
from typing import Any, Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Tuple

import numpy as np
import numpy.typing as npt

from . import _arguments
from ._doors import door
from ._errors import InputError, usage
from ._plc import Plc, resolve_crossings
from ._run import mesh

_Points = npt.NDArray[Any]


def _crossings(ring: _Points, y: float) -> npt.NDArray[np.float64]:
    """Where a horizontal line crosses a ring."""
    a, b = ring, np.roll(ring, -1, axis=0)
    chosen = (a[:, 1] < y) != (b[:, 1] < y)
    a, b = a[chosen], b[chosen]
    made: npt.NDArray[np.float64] = a[:, 0] + (b[:, 0] - a[:, 0]) * ((y - a[:, 1]) / (b[:, 1] - a[:, 1]))
    return made


class _Polygon(NamedTuple):
    rings: List[_Points]  #: the outer one, then those of the holes; none has its first corner again at its end

    def has(self, x: float, y: float) -> bool:
        """Is a point in it that is on none of its edges?"""
        crossed = sum(int((_crossings(ring, y) > x).sum()) for ring in self.rings)
        return crossed % 2 == 1


def _ring(name: str, value: object) -> _Points:
    """The corners of a ring, without the first one again at its end."""
    ring = _arguments.points(name, value, 2)
    if len(ring) > 1 and np.array_equal(ring[0], ring[-1]):
        ring = ring[:-1]
    if len(np.unique(ring, axis=0)) < 3:
        raise usage(f"{name} must have three different corners or more, not {len(np.unique(ring, axis=0))}")
    return ring


def _inside(name: str, ring: _Points) -> npt.NDArray[np.float64]:
    """A point inside a ring that does not cross itself: in the middle of the widest span of a horizontal line midway between the two
    neighbouring levels of corners that are farthest apart."""
    corners = ring.astype(np.float64)
    levels = np.unique(corners[:, 1])
    if len(levels) < 2:
        raise usage(f"{name} encloses nothing: all its corners are on one line")
    widest = int(np.argmax(np.diff(levels)))
    y = levels[widest] + (levels[widest + 1] - levels[widest]) / 2
    x = np.sort(_crossings(corners, y))
    width = x[1::2] - x[0::2]
    span = int(np.argmax(width))
    if not width[span] > 0:
        raise usage(f"{name} encloses nothing: it has no area")
    return np.array([x[2 * span] + width[span] / 2, y])


def _geometry(value: object) -> Optional[Mapping[str, Any]]:
    """A geometry as GeoJSON has it; None: it is none."""
    if not isinstance(value, type):
        value = getattr(value, "__geo_interface__", value)
    return value if isinstance(value, Mapping) else None


def _coordinates_of(geometry: Mapping[str, Any], left_out: Dict[str, int]) -> Iterator[Sequence[Any]]:
    """The rings of each polygon in a geometry. What else there is, is counted in `left_out`."""
    kind = geometry.get("type")
    try:
        if kind == "Polygon":
            if len(geometry["coordinates"]):  # else it is empty
                yield geometry["coordinates"]
        elif kind == "MultiPolygon":
            yield from geometry["coordinates"]
        elif kind in ("GeometryCollection", "FeatureCollection"):
            for part in geometry["geometries" if kind == "GeometryCollection" else "features"]:
                yield from _coordinates_of(_geometry(part) or {}, left_out)
        elif kind == "Feature":
            yield from _coordinates_of(_geometry(geometry["geometry"]) or {}, left_out)
        else:
            name = str(kind) if kind else "no geometry"
            left_out[name] = left_out.get(name, 0) + 1
    except (KeyError, TypeError, AttributeError) as error:
        raise usage(f"a {kind} must be as GeoJSON has it: {type(error).__name__}: {error}") from None


def _depth(value: Any) -> int:
    """How deep its first numbers lie: 1 in a point, 2 in a ring, 3 in a list of rings, 4 in a list of these."""
    if isinstance(value, np.ndarray):
        return value.ndim
    if isinstance(value, (str, bytes)) or not hasattr(value, "__getitem__") or not hasattr(value, "__len__"):
        return 0
    return 1 + (_depth(value[0]) if isinstance(value, (list, tuple)) and len(value) else 1 if np.ndim(value) > 1 else 0)


def _rings_of(value: Any, left_out: Dict[str, int]) -> Iterator[Sequence[Any]]:
    """The rings of each polygon that a caller gives: one ring, a geometry, or a list of rings, of lists of rings, and of geometries."""
    geometry = _geometry(value)
    if geometry is not None:
        for rings in _coordinates_of(geometry, left_out):
            try:
                yield [[list(corner)[:2] for corner in ring] for ring in rings]  # some have heights, too
            except TypeError:
                raise usage("a polygon must be a list of rings, each a list of corners, as GeoJSON has it") from None
        return
    is_list = isinstance(value, (list, tuple)) and len(value) > 0
    if is_list and all(_geometry(part) is not None for part in value):
        for part in value:
            yield from _rings_of(part, left_out)
    elif is_list and any(_geometry(part) is not None or _depth(part) > 1 for part in value) or _depth(value) > 2:
        for part in value:
            if _geometry(part) is not None:
                yield from _rings_of(part, left_out)
            else:
                yield part if _depth(part) > 2 else [part]
    else:
        yield [value]


def _polygons_of(outer: object, holes: Sequence[object]) -> List[_Polygon]:
    """All that is given, checked."""
    left_out: Dict[str, int] = {}
    given = [list(rings) for rings in _rings_of(outer, left_out)]
    if left_out:
        words = ", ".join(f"{count} {kind}" for kind, count in sorted(left_out.items()))
        if not given:
            raise usage(f"there are no polygons: {words}, which enclose no area")
        warnings.warn(f"from_polygons takes polygons; left out: {words}", stacklevel=4)
    if not given:
        raise usage("there are no polygons")
    holes = list(holes)
    if len(given) == 1 and (not holes or len(given[0]) == 1):
        rings = given[0] + holes
        return [_Polygon([_ring("outer", rings[0])] + [_ring(f"hole {i}", hole) for i, hole in enumerate(rings[1:])])]
    if holes:
        raise usage("holes come with a single ring: of several polygons, give each as a list of its rings, the outer one first")
    return [_Polygon([_ring(f"polygon {k}", rings[0])] + [_ring(f"hole {i} of polygon {k}", hole) for i, hole in enumerate(rings[1:])])
            for k, rings in enumerate(given)]


class _Parts(NamedTuple):
    """What polygons divide the plane into, without what is outside of all."""

    seeds: npt.NDArray[np.float64]  #: (k, 2) a point in each part, far from its edges
    owners: npt.NDArray[Any]  #: the first polygon that has it; -1: none has, so it is a void


def _parts_of(plc: Plc, polygons: Sequence[_Polygon]) -> _Parts:
    """By a triangulation of all edges. Raises InputError where there is none."""
    made = mesh(resolve_crossings(plc)[0], refine=False, regions="all")
    corners = made.points[made.cells]
    edges = corners - np.roll(corners, 1, axis=1)
    areas = np.abs(edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0])
    widths = areas / np.linalg.norm(edges, axis=2).sum(axis=1)
    order = np.lexsort((-widths, made.regions))
    widest = order[np.unique(made.regions[order], return_index=True)[1]]
    seeds = corners[widest].mean(axis=1)
    seeds = seeds[np.argsort(seeds[:, 0])]
    owners = np.full(len(seeds), -1)
    for k, polygon in enumerate(polygons):
        low, high = polygon.rings[0].min(axis=0), polygon.rings[0].max(axis=0)
        begin, end = np.searchsorted(seeds[:, 0], [low[0], high[0]])
        near = begin + np.flatnonzero((low[1] <= seeds[begin:end, 1]) & (seeds[begin:end, 1] <= high[1]) & (owners[begin:end] < 0))
        owners[near] = [k if polygon.has(*seeds[i]) else -1 for i in near]
    return _Parts(seeds, owners)


def _seeds(plc: Plc, polygons: Sequence[_Polygon], labels: Optional[_Points]) -> Tuple[_Points, List[Any]]:
    """Holes, and rows of regions, one in each part that needs it."""
    if len(polygons) > 1 or labels is not None:
        try:
            parts = _parts_of(plc, polygons)
        except InputError:  # what is wrong is said when it is meshed
            pass
        else:
            holes = [seed for seed, owner in zip(parts.seeds, parts.owners) if owner < 0]
            rows = [] if labels is None else [[*seed, labels[owner]] for seed, owner in zip(parts.seeds, parts.owners) if owner >= 0]
            return np.array(holes).reshape(-1, 2), rows
    holes = [_inside(f"hole {i}", ring) for polygon in polygons for i, ring in enumerate(polygon.rings[1:])]
    return np.array(holes).reshape(-1, 2), []


class _Rows(NamedTuple):
    """What geometries consist of, each with the row that it is of."""

    polygons: List[_Polygon]
    polygon_rows: List[int]
    lines: List[_Points]
    line_rows: List[int]
    points: List[_Points]


def _sorted_out(geometries: Sequence[object]) -> _Rows:
    made = _Rows([], [], [], [], [])
    for row, value in enumerate(geometries):
        if value is None:  # GeoPandas has rows without a geometry
            continue
        geometry = _geometry(value)
        if geometry is None:
            raise TypeError(f"row {row} must be a geometry of Shapely, or what has a __geo_interface__, not {type(value).__name__}")
        for kind, at in _simple_parts(geometry):
            try:
                if kind == "Polygon":
                    rings = [_ring(f"ring {i} of a polygon of row {row}", [corner[:2] for corner in ring]) for i, ring in enumerate(at)]
                    made.polygons.append(_Polygon(rings))
                    made.polygon_rows.append(row)
                elif kind == "Point":
                    made.points.append(_arguments.points(f"a point of row {row}", [at[:2]], 2))
                else:
                    made.lines.append(_arguments.points(f"a line of row {row}", [corner[:2] for corner in at], 2))
                    made.line_rows.append(row)
            except (TypeError, IndexError):
                raise usage(f"row {row}: the coordinates of a {kind} must be as GeoJSON has them") from None
    if not made.polygons and not made.lines:
        raise usage("there are no polygons and no lines: nothing encloses an area")
    return made


def _simple_parts(geometry: Mapping[str, Any]) -> Iterator[Tuple[str, Any]]:
    """Polygons, lines and points of a geometry, whatever it is made of."""
    kind = str(geometry.get("type"))
    try:
        if kind in ("GeometryCollection", "FeatureCollection"):
            for part in geometry["geometries" if kind == "GeometryCollection" else "features"]:
                yield from _simple_parts(_geometry(part) or {})
        elif kind == "Feature":
            yield from _simple_parts(_geometry(geometry["geometry"]) or {"type": "Polygon", "coordinates": ()})
        elif kind in ("MultiPolygon", "MultiLineString", "MultiPoint"):
            for at in geometry["coordinates"]:
                yield kind[len("Multi"):], at
        elif kind in ("Polygon", "LineString", "LinearRing", "Point"):
            if len(geometry["coordinates"]):  # else it is empty
                yield kind, geometry["coordinates"]
        else:
            raise usage(f"a geometry of the type {kind} is not taken: there are points, lines, polygons and collections of them")
    except (KeyError, TypeError, AttributeError) as error:
        raise usage(f"a {kind} must be as GeoJSON has it: {type(error).__name__}: {error}") from None


def _graph(rows: _Rows, markers: _Points) -> Tuple[_Points, _Points, _Points]:
    """Points, segments and their markers: of equal points one, and of equal segments the one of the first row."""
    paths = [np.concatenate([ring, ring[:1]]) for polygon in rows.polygons for ring in polygon.rings]
    owners = [row for polygon, row in zip(rows.polygons, rows.polygon_rows) for _ in polygon.rings]
    paths, owners = paths + rows.lines, owners + rows.line_rows
    at = np.concatenate([*paths, *rows.points])
    begin = np.cumsum([0] + [len(path) for path in paths])
    ends = np.stack([np.arange(begin[-1] - 1), np.arange(1, begin[-1])], axis=1)
    kept = np.ones(len(ends), dtype=bool)
    kept[begin[1:-1] - 1] = False
    points, first, place = np.unique(at, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)  # as they come
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    segments, owner = rank[place.reshape(-1)][ends[kept]], np.repeat(owners, np.diff(begin))[:-1][kept]
    owner, segments = owner[segments[:, 0] != segments[:, 1]], segments[segments[:, 0] != segments[:, 1]]
    by_row = np.argsort(owner, kind="stable")
    keys = np.sort(segments[by_row], axis=1)
    chosen = np.sort(by_row[np.unique(keys, axis=0, return_index=True)[1]])
    return points[order], segments[chosen], markers[owner[chosen]]


def _numbered(name: str, values: Optional[Sequence[Any]], count: int) -> Tuple[_Points, Dict[int, str]]:
    """Labels or markers of rows; of words, numbers in the order in which they come, and what these are called."""
    if values is None:
        return np.arange(1, count + 1), {}
    given = list(values)
    if len(given) != count:
        raise usage(f"{name} must have one entry for each of {count} rows, not {len(given)}")
    if any(isinstance(value, str) for value in given):
        numbers: Dict[str, int] = {}
        made = np.array([numbers.setdefault(str(value), len(numbers) + 1) for value in given])
        return made, {number: word for word, number in numbers.items()}
    return np.asarray(_arguments.values(name, np.array(given), count, "rows")), {}


def _whole(markers: _Points) -> _Points:
    if not np.array_equal(markers, np.asarray(markers, dtype=np.int64)):
        raise usage("markers must be whole numbers")
    return np.asarray(markers, dtype=np.int64)


@door
def from_shapely(geometries: object, *, labels: Optional[Sequence[Any]] = None, sizes: Optional[npt.ArrayLike] = None,
                 names: Optional[Sequence[Any]] = None, markers: Optional[Sequence[Any]] = None,
                 tolerance: Optional[float] = None) -> Plc:
    """See Plc.from_shapely."""
    given = list(geometries) if isinstance(geometries, (list, tuple, np.ndarray)) else [geometries]
    rows = _sorted_out(given)
    of_rows, label_names = _numbered("labels", labels, len(given))
    numbers, marker_names = _numbered("markers", markers, len(given))
    largest = np.zeros(len(given))
    if sizes is not None:
        largest = np.array(_arguments.reals("sizes", np.nan_to_num(np.asarray(sizes, dtype=np.float64))))
        if largest.shape != (len(given),) or (largest < 0).any():
            raise usage(f"sizes must be {len(given)} areas, one a row; 0 or NaN: any size")
    if names is not None:
        if len(names) != len(given):
            raise usage(f"names must have one entry for each of {len(given)} rows, not {len(names)}")
        label_names = {of_rows[row]: str(names[row]) for row in reversed(rows.polygon_rows)}
        marker_names = {int(numbers[row]): str(names[row]) for row in reversed(rows.line_rows)}
    points, segments, owned = _graph(rows, _whole(numbers))
    plc = resolve_crossings(Plc(points, segments, markers=owned, tolerance=tolerance))[0]
    if rows.polygons:
        parts = _parts_of(plc, rows.polygons)
        of_part = np.array([*rows.polygon_rows, -1])[parts.owners]  # -1: none
        plc = plc.with_seeds(holes=parts.seeds[of_part < 0] if (of_part < 0).any() else None,
                             regions=[[*seed, of_rows[row], largest[row]] for seed, row in zip(parts.seeds, of_part) if row >= 0])
    used = set(plc.regions[:, 2].tolist()), set(plc.markers.tolist())
    return plc.with_names(regions={float(label): name for label, name in label_names.items() if label in used[0]},
                          markers={marker: name for marker, name in marker_names.items() if marker in used[1]})


@door
def from_geopandas(frame: Any, *, label: Optional[str] = None, size: Optional[str] = None, name: Optional[str] = None,
                   marker: Optional[str] = None, tolerance: Optional[float] = None) -> Plc:
    """See Plc.from_geopandas."""
    if not hasattr(frame, "geometry"):
        raise TypeError(f"a GeoDataFrame or GeoSeries is taken, not {type(frame).__name__}")

    def column(of: Optional[str]) -> Optional[List[Any]]:
        if of is None:
            return None
        if of not in getattr(frame, "columns", ()):
            raise usage(f"there is no column {of!r}: there are {', '.join(map(str, getattr(frame, 'columns', ())))}")
        return list(frame[of])

    return from_shapely(list(frame.geometry), labels=column(label), sizes=column(size), names=column(name), markers=column(marker),
                        tolerance=tolerance)


@door
def from_polygons(outer: object, holes: Sequence[object] = (), *, markers: Optional[Sequence[int]] = None,
                  labels: Optional[npt.ArrayLike] = None, tolerance: Optional[float] = None) -> Plc:
    """See Plc.from_polygons."""
    polygons = _polygons_of(outer, holes)
    rings = [ring for polygon in polygons for ring in polygon.rings]
    given = _arguments.markers("markers", list(range(1, len(rings) + 1)) if markers is None else markers, len(rings), "rings")
    of_polygons = None if labels is None else _arguments.values("labels", labels, len(polygons), "polygons")
    sizes = [len(ring) for ring in rings]
    number = np.arange(sum(sizes))
    following = number + 1
    following[np.cumsum(sizes) - 1] = np.cumsum([0, *sizes[:-1]])
    points, segments, numbers = np.concatenate(rings), np.stack([number, following], axis=1), np.repeat(given, sizes)
    if markers is None and len(polygons) > 1:  # a common edge has the number of the first, which nobody has to be told
        place = np.unique(points, axis=0, return_inverse=True)[1].reshape(-1)
        first = np.sort(np.unique(np.sort(place[segments], axis=1), axis=0, return_index=True)[1])
        segments, numbers = segments[first], numbers[first]
    seeds, regions = _seeds(Plc(points, segments, tolerance=tolerance), polygons, of_polygons)
    return Plc(points, segments, markers=numbers, holes=seeds, regions=regions, tolerance=tolerance)
