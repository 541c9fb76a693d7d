# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Arguments as users give them: checked, with words for what is wrong, and made what the extension module reads in place. Nothing is
copied that is contiguous and of a type that the module knows."""
from __future__ import annotations

import math
import numbers
import os
from typing import Any, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from ._errors import usage

Array = npt.NDArray[Any]
Path = Union[str, "os.PathLike[str]"]


def _array(name: str, value: object) -> Array:
    try:
        with np.errstate(all="raise"):
            array: Array = np.asarray(value)
    except ValueError as error:  # rows of different lengths
        raise usage(f"{name}: no array can be made of it: {error}") from None
    if array.dtype == object:
        raise usage(f"{name} must be an array of numbers, not of the type {type(value).__name__} with rows of different lengths "
                    "or other objects")
    if isinstance(value, np.ma.MaskedArray) and bool(np.any(value.mask)):
        raise usage(f"{name} has masked entries: leave their rows out, or fill them in")
    return array


def _dense(array: Array, kind: Any) -> Array:
    """As the extension module reads it in place: contiguous, and where the processor may read it."""
    return np.require(array, dtype=kind, requirements=["C", "A"])


def reals(name: str, value: object) -> Array:
    """Real numbers in any shape, as float64."""
    array = _array(name, value)
    if array.dtype.kind not in "fiu":
        raise usage(f"{name} must be real numbers, not {array.dtype}")
    return _dense(array, np.float64)


def points(name: str, value: object, dimension: Optional[int] = None) -> Array:
    """(n, 2) or (n, 3) coordinates, float64 or float32, contiguous. `dimension`: what it must be; None: either."""
    array = _array(name, value)
    wanted = f"(n, {dimension})" if dimension else "(n, 2) or (n, 3)"
    if dimension and array.size == 0:
        array = np.zeros((0, dimension))
    if array.ndim != 2 or (array.shape[1] != dimension if dimension else array.shape[1] not in (2, 3)):
        raise usage(f"{name} must have the shape {wanted}, not {array.shape}")
    if array.dtype.kind not in "fiu":
        raise usage(f"{name} must be real numbers, not {array.dtype}")
    kept = array.dtype if array.dtype in (np.float32, np.float64) and array.dtype.isnative else np.dtype(np.float64)
    return _dense(array, kept)


def coordinates(name: str, value: object, dimension: int) -> Array:
    """(n, dimension) float64."""
    return _dense(points(name, value, dimension), np.float64)


def indices(name: str, value: object, columns: Optional[int]) -> Array:
    """(n, columns) integers of 32 or 64 bits, contiguous. Their range is checked where the points are known."""
    array = _array(name, value)
    if array.size == 0 and (array.ndim < 2 or columns is not None):
        return np.zeros((0, columns or 3), dtype=np.int64)
    if array.ndim != 2 or (columns is not None and array.shape[1] != columns):
        raise usage(f"{name} must have the shape (m, {columns or 'k'}), not {array.shape}")
    if array.dtype.kind not in "iu":
        raise usage(f"{name} must be integers, not {array.dtype}")
    kept = array.dtype if array.dtype.itemsize >= 4 and array.dtype.isnative else np.dtype(np.int64)
    return _dense(array, kept)


def signed(ids: Array) -> npt.NDArray[np.int32]:
    """Numbers of points, as the extension module has them, as int32 in the same memory: there are fewer than 2**31, and differences
    of unsigned numbers wrap."""
    made: npt.NDArray[np.int32] = ids.view(np.int32)
    return made


def markers(name: str, value: object, count: int, what: str) -> Array:
    """(count,) int32; None: empty."""
    if value is None:
        return np.zeros(0, dtype=np.intc)
    array = _array(name, value)
    if array.size == 0 and count == 0:
        return np.zeros(0, dtype=np.intc)
    if array.dtype.kind not in "iu":
        raise usage(f"{name} must be integers, not {array.dtype}")
    if array.shape != (count,):
        raise usage(f"{name} must have one number for each of {count} {what}, in the shape ({count},), not {array.shape}")
    narrow = array.astype(np.intc)
    if not np.array_equal(narrow, array):
        raise usage(f"{name} must be integers of 32 bits")
    return _dense(narrow, np.intc)


def values(name: str, value: object, count: int, what: str) -> Array:
    """(count,) float64."""
    array = reals(name, value)
    if array.shape != (count,):
        raise usage(f"{name} must have one number for each of {count} {what}, in the shape ({count},), not {array.shape}")
    return array


def number(name: str, value: object) -> float:
    """A real number, finite or infinite."""
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (numbers.Real, np.number)) or isinstance(value, complex):
        raise TypeError(f"{name} must be a number, not {type(value).__name__}")
    made = float(value)
    if math.isnan(made):
        raise usage(f"{name} must be a number, not NaN")
    return made


def whole_number(name: str, value: object, least: int, most: int) -> int:
    """An integer from least to most."""
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (numbers.Integral, np.integer)):
        raise TypeError(f"{name} must be an integer, not {type(value).__name__}")
    if not least <= int(value) <= most:
        raise usage(f"{name} must lie between {least} and {most}, not {value}")
    return int(value)


def flag(name: str, value: object) -> bool:
    """True or False, and nothing that merely looks like it."""
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name} must be True or False, not {type(value).__name__}")
    return bool(value)


def kept(name: str, value: object) -> Tuple[bool, List[int]]:
    """True or False, or the markers of what is kept: whether anything is, and these."""
    if isinstance(value, (bool, np.bool_)):
        return bool(value), []
    if isinstance(value, (str, bytes)) or not isinstance(value, (Sequence, np.ndarray)):
        raise TypeError(f"{name} must be True, False, or markers, not {type(value).__name__}")
    markers = [whole_number(name, marker, -2**31, 2**31 - 1) for marker in value]
    return bool(markers), markers


def mapping(name: str, value: object, of_what: str) -> Mapping[Any, Any]:
    """A dict, or what looks like one."""
    if not isinstance(value, Mapping):
        raise TypeError(f"{name} must be a dict of {of_what}, not {type(value).__name__}")
    return value


def word(name: str, value: object, words: Sequence[str]) -> str:
    """One of these words."""
    if not isinstance(value, str):
        raise TypeError(f"{name} must be a word, not {type(value).__name__}")
    if value not in words:
        raise usage(f"{name} must be one of {', '.join(words)}, not {value!r}")
    return value


def path(value: object) -> str:
    """The name of a file."""
    try:
        return os.fsdecode(value)  # type: ignore[arg-type]
    except TypeError:
        raise TypeError(f"the name of a file must be a str or a path, not {type(value).__name__}") from None


def regions(value: object, dimension: int) -> Array:
    """(k, dimension + 2) float64: a point, the attribute, the largest measure of cells (0: none). Rows may lack the measure, and may
    be dicts of point, attribute and max_size."""
    rows = []
    try:
        given = list(value)  # type: ignore[call-overload]
    except TypeError:
        raise usage(f"regions must be a list of rows, not {type(value).__name__}") from None
    for i, row in enumerate(given):
        if isinstance(row, dict):
            unknown = set(row) - {"point", "attribute", "max_size"}
            if unknown or "point" not in row:
                raise usage(f"region {i} must have the keys point, attribute and max_size, not {sorted(map(str, row))}")
            row = [*row["point"], row.get("attribute", 0), row.get("max_size") or 0]
        numbers_of_row = _array(f"region {i}", row)
        if numbers_of_row.dtype.kind not in "fiu" or numbers_of_row.shape not in ((dimension + 1,), (dimension + 2,)):
            raise usage(f"region {i} must be {dimension} coordinates, an attribute and, if there is one, the largest "
                        f"{'area' if dimension == 2 else 'volume'} of its cells: not {row!r}")
        full = np.zeros(dimension + 2)
        full[:numbers_of_row.size] = numbers_of_row
        if not np.isfinite(full).all():
            raise usage(f"region {i} has a number that is not finite: {row!r}")
        rows.append(full)
    return np.array(rows, dtype=np.float64).reshape(len(rows), dimension + 2)


def polygons(value: object) -> Tuple[Array, Array, Array]:
    """Facets as the corners of all polygons, how many corners each polygon has, and how many polygons each facet; the latter is empty
    where that is one each. An (m, k) array is m polygons of k corners."""
    if isinstance(value, np.ndarray) and value.dtype != object:
        corners = indices("facets", value, None)
        if corners.shape[1] < 3 and corners.size:
            raise usage(f"facets must have three corners or more each, in the shape (m, 3), not {corners.shape}")
        sizes: Array = np.full(len(corners), corners.shape[1], dtype=np.int64)
        return corners.reshape(-1), sizes, np.zeros(0, dtype=np.int64)
    flat, polygon_sizes, facet_sizes = [], [], []
    try:
        given = list(value)  # type: ignore[call-overload]
    except TypeError:
        raise usage(f"facets must be an array or a list, not {type(value).__name__}") from None
    for i, facet in enumerate(given):
        several = len(facet) > 0 and np.ndim(facet[0]) > 0 if isinstance(facet, (list, tuple)) else np.ndim(facet) == 2
        facet_polygons = facet if several else [facet]
        facet_sizes.append(len(facet_polygons))
        for polygon in facet_polygons:
            corners = _array(f"facet {i}", polygon)
            if corners.ndim != 1 or (corners.size and corners.dtype.kind not in "iu"):
                raise usage(f"facet {i} must be a list of indices, or a list of such lists, not {facet!r}")
            polygon_sizes.append(corners.size)
            flat.append(corners.astype(np.int64))
    one_each = all(size == 1 for size in facet_sizes)
    return (np.concatenate(flat) if flat else np.zeros(0, dtype=np.int64), np.array(polygon_sizes, dtype=np.int64),
            np.array([] if one_each else facet_sizes, dtype=np.int64))


def names(name: str, value: object, number: Any) -> Any:
    """A dict from numbers to names."""
    made = {}
    for key, text in mapping(name, value, "number and name").items():
        if isinstance(key, bool) or not isinstance(key, (numbers.Real, np.number)) or float(key) != number(key):
            raise usage(f"{name}: {key!r} is no {'label' if number is float else 'marker'}")
        if not isinstance(text, str) or not text.strip():
            raise usage(f"{name}[{key}] must be a name, not {text!r}")
        made[number(key)] = text
    return made
