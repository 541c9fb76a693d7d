# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs from rings and polygons: arrays, and whatever has a __geo_interface__, as Shapely and GeoPandas have it."""
from __future__ import annotations

import warnings
from typing import Any, Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Set, Tuple

import numpy as np
import numpy.typing as npt

from . import _arguments, _pgdr
from ._doors import door
from ._ending import WORK
from ._errors import usage
from ._plc import Plc, _tolerance, resolve_crossings

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


def _flat(rings: Sequence[_Points]) -> npt.NDArray[np.float64]:
    """The coordinates of rings, one behind the other."""
    return np.ascontiguousarray(np.concatenate([np.empty((0, 2)), *rings]), dtype=np.float64)


def _counts(lists: Sequence[Any]) -> npt.NDArray[np.int64]:
    return np.array([len(one) for one in lists], dtype=np.int64)


def _seeds(plc: Plc, polygons: Sequence[_Polygon], labels: Optional[_Points]) -> Tuple[_Points, List[Any]]:
    """Holes, and rows of regions, one in each part that needs it."""
    if len(polygons) == 1 and labels is None:
        return np.array([_inside(f"hole {i}", ring) for i, ring in enumerate(polygons[0].rings[1:])]).reshape(-1, 2), []
    rings = [ring for polygon in polygons for ring in polygon.rings]
    with WORK:
        seeds, owners = _pgdr.seeds_of_faces(plc._core, _counts([polygon.rings for polygon in polygons]), _counts(rings), _flat(rings))
    rows = [] if labels is None else [[*seed, labels[owner]] for seed, owner in zip(seeds, owners) if owner >= 0]
    return seeds[owners < 0], rows


class _Map(NamedTuple):
    """What geometries consist of: parts, each with its kind, the row that it is of, and its paths."""

    kinds: List[int]  #: as MapPart::Kind of C++
    rows: List[int]
    paths: List[List[_Points]]

    def rows_of(self, *kinds: str) -> Set[int]:
        return {row for kind, row in zip(self.kinds, self.rows) if _KINDS[kind] in kinds}


_KINDS = ("Polygon", "LineString", "Point")


def _paths_of(kind: str, at: Any, row: int) -> List[_Points]:
    """Of a polygon its rings, of a line its points, of a point itself."""
    try:
        if kind == "Polygon":
            return [_ring(f"ring {i} of a polygon of row {row}", [corner[:2] for corner in ring]) for i, ring in enumerate(at)]
        if kind == "Point":
            return [_arguments.points(f"a point of row {row}", [at[:2]], 2)]
        return [_arguments.points(f"a line of row {row}", [corner[:2] for corner in at], 2)]
    except (TypeError, IndexError):
        raise usage(f"row {row}: the coordinates of a {kind} must be as GeoJSON has them") from None


def _map_of(geometries: Sequence[object]) -> _Map:
    made = _Map([], [], [])
    for row, value in enumerate(geometries):
        if value is None:  # GeoPandas has rows without a geometry
            continue
        geometry = _geometry(value)
        if geometry is None:
            raise TypeError(f"row {row} must be a geometry of Shapely, or what has a __geo_interface__, not {type(value).__name__}")
        for kind, at in _simple_parts(geometry):
            made.paths.append(_paths_of(kind, at, row))
            made.kinds.append(_KINDS.index(kind) if kind in _KINDS else _KINDS.index("LineString"))
            made.rows.append(row)
    if not made.rows_of("Polygon", "LineString"):
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


def _whole(markers: _Points, count: int) -> _Points:
    whole = np.asarray(markers, dtype=np.int64)
    if not np.array_equal(markers, whole):
        raise usage("markers must be whole numbers")
    return _arguments.markers("markers", whole, count, "rows")


@door
def from_shapely(geometries: object, *, labels: Optional[Sequence[Any]] = None, sizes: Optional[npt.ArrayLike] = None,
                 names: Optional[Sequence[Any]] = None, markers: Optional[Sequence[Any]] = None,
                 tolerance: Optional[float] = None) -> Plc:
    """See Plc.from_shapely."""
    given = list(geometries) if isinstance(geometries, (list, tuple, np.ndarray)) else [geometries]
    parts = _map_of(given)
    of_rows, words = _numbered("labels", labels, len(given))
    numbers, marker_words = _numbered("markers", markers, len(given))
    largest = np.zeros(len(given))
    if sizes is not None:
        largest = np.array(_arguments.reals("sizes", np.nan_to_num(np.asarray(sizes, dtype=np.float64))))
        if largest.shape != (len(given),) or (largest < 0).any():
            raise usage(f"sizes must be {len(given)} areas, one a row; 0 or NaN: any size")
    if names is not None and len(names) != len(given):
        raise usage(f"names must have one entry for each of {len(given)} rows, not {len(names)}")
    label_names = [words.get(label, "") for label in of_rows] if names is None else list(map(str, names))
    lines = parts.rows_of("LineString")
    marker_names = ([marker_words.get(marker, "") for marker in numbers] if names is None
                    else [str(name) if row in lines else "" for row, name in enumerate(names)])
    paths = [path for part in parts.paths for path in part]
    with WORK:
        core = _pgdr.plc_of_map(np.asarray(of_rows, dtype=np.float64), largest, _whole(numbers, len(given)), label_names, marker_names,
                                np.array(parts.kinds, dtype=np.uint8), np.array(parts.rows, dtype=np.int64), _counts(parts.paths),
                                _counts(paths), _flat(paths), _tolerance(tolerance))
    return resolve_crossings(Plc._of(core))[0]


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
