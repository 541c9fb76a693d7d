# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Sizing fields that are evaluated in C++, without the GIL. Sizes are bounds of circumradii in 3D, of areas in 2D."""
from __future__ import annotations

from typing import Any, Callable, Optional, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _arguments, _pgdr
from ._doors import door
from ._errors import usage
from ._mesh import Mesh

#: A number, a field, or a function of an (n, D) array of points that returns their n sizes.
Size = Union[float, "Field", Callable[[npt.NDArray[np.float64]], npt.ArrayLike]]


class Field:
    """A sizing field; `smallest`, `sizes_at_points` and `sizes_on_mesh` make them. Any number of threads may ask one. It pickles
    with all that it was made of, as far as that does: not with a lambda."""

    def __init__(self, core: _pgdr._Field, dimension: int, recipe: Tuple[Callable[..., Size], Tuple[Any, ...]]) -> None:
        self._core = core
        self._dimension = dimension
        self._recipe = recipe

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self._dimension

    def __call__(self, points: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """The sizes at (n, D) points: (n,)."""
        return self._core.at(_arguments.coordinates("points", points, self._dimension))

    def __repr__(self) -> str:
        return f"<pgdr.Field {self._dimension}D>"

    def __reduce__(self) -> Tuple[Callable[..., Size], Tuple[Any, ...]]:
        return self._recipe


@door
def is_lasting(size: object) -> bool:
    """Is a size the same in another process: a number, or a field without functions of Python?"""
    if isinstance(size, Field):
        make, parts = size._recipe
        return make not in (smallest, in_unit) or all(map(is_lasting, parts if make is smallest else parts[:1]))
    return not callable(size)


def core_of(name: str, size: object, dimension: int) -> _pgdr._Field:
    """What the extension module takes for a size."""
    made = _pgdr.Field2 if dimension == 2 else _pgdr.Field3
    if isinstance(size, Field):
        if size.dimension != dimension:
            raise usage(f"{name} is a field of {size.dimension}D, the input has {dimension} dimensions")
        return size._core
    if callable(size):
        return made(size)
    return made(_arguments.number(name, size))


def size_unit_of(size: Optional[Size], edge_length: Optional[Size], unit: Optional[str]) -> Tuple[Optional[Size], Optional[str]]:
    """The size and its unit, of which edge_length is both."""
    if unit is not None:
        _arguments.word("size_unit", unit, ("edge", "radius", "area", "volume"))
    if edge_length is None:
        return size, unit
    if size is not None or unit not in (None, "edge"):
        raise usage('edge_length is short for size=edge_length, size_unit="edge": give one of them')
    return edge_length, "edge"


def in_unit(size: Size, unit: Optional[str], dimension: int) -> Size:
    """A size in a unit, as one of circumradii (3D) or areas (2D)."""
    if unit is None:
        return size
    if not callable(size):
        convert = _pgdr.usual_sizes2 if dimension == 2 else _pgdr.usual_sizes3
        return float(convert(np.array([_arguments.number("size", size)]), unit)[0])
    of_field = _pgdr.in_usual_unit2 if dimension == 2 else _pgdr.in_usual_unit3
    return Field(of_field(core_of("size", size, dimension), unit), dimension, (in_unit, (size, unit, dimension)))


def smallest(*fields: Size) -> Field:
    """The smallest of several sizes at every point. At least one of them is a Field, which says the dimension.

    >>> import pgdr
    >>> near = pgdr.sizes_at_points([[0.0, 0.0]], [0.25], growth=0.5)
    >>> pgdr.smallest(near, 0.5)([[0, 0], [5, 5]]).tolist()
    [0.25, 0.5]
    """
    dimensions = {f.dimension for f in fields if isinstance(f, Field)}
    if len(dimensions) != 1:
        raise usage("smallest() takes fields of one dimension, at least one, and numbers and functions beside them")
    dimension = dimensions.pop()
    join = _pgdr.smallest2 if dimension == 2 else _pgdr.smallest3
    return Field(join([core_of("a size", f, dimension) for f in fields]), dimension, (smallest, fields))


def sizes_at_points(points: npt.ArrayLike, sizes: npt.ArrayLike, growth: float) -> Field:
    """Sizes at (n, D) points, which grow with the distance: min over i of sizes[i] + growth |x - points[i]|, in 2D of the square
    root of the area. Raises UsageError: no points, a size that is not positive, a negative growth."""
    at = np.array(_arguments.points("points", points), dtype=np.float64)
    make = _pgdr.sizes_at_points2 if at.shape[1] == 2 else _pgdr.sizes_at_points3
    values = np.array(_arguments.values("sizes", sizes, len(at), "points"))
    slope = _arguments.number("growth", growth)
    return Field(make(at, values, slope), int(at.shape[1]), (sizes_at_points, (at, values, slope)))


def sizes_along(lines: npt.ArrayLike, sizes: npt.ArrayLike, growth: float) -> Field:
    """Sizes along n straight lines, (n, 2, D) ends, which grow with the distance from them as those of `sizes_at_points`; it is never
    larger than exactly that, and smaller by a twentieth of the line's size at most (2D: of its square root). Raises UsageError.

    >>> import pgdr
    >>> shore = pgdr.sizes_along([[[0, 0], [10, 0]]], [0.25], growth=0.5)
    >>> bool(abs(shore([[5, 0]])[0] - 0.24) < 0.02)
    True
    """
    given = _arguments.reals("lines", lines)
    if given.ndim != 3 or given.shape[1] != 2 or given.shape[2] not in (2, 3):
        raise usage(f"lines must have the shape (n, 2, 2) or (n, 2, 3), not {given.shape}")
    at = np.array(given, dtype=np.float64)
    make = _pgdr.sizes_along2 if at.shape[2] == 2 else _pgdr.sizes_along3
    values = np.array(_arguments.values("sizes", sizes, len(at), "lines"))
    slope = _arguments.number("growth", growth)
    return Field(make(at.reshape(-1, at.shape[2]), values, slope), int(at.shape[2]), (sizes_along, (at, values, slope)))


def sizes_on_raster(values: npt.ArrayLike, transform: Any, growth: Optional[float] = None) -> Field:
    """2D: sizes (largest areas) on a raster, interpolated linearly between the middles of its cells; beyond them, the value at the
    nearest point that has one counts.

    Parameters
    ----------
    values : (rows, columns) array
        NaN and what is masked is no value. At least three neighbours must be there.
    transform
        Six numbers a, b, c, d, e, f as rasterio's `transform` and the affine package have them: the upper left corner of the cell in
        row r and column k is (a k + b r + c, d k + e r + f). An array from GDAL's GetGeoTransform is (c, a, b, f, d, e).
    growth : float, optional
        As of `limit_growth`: values are lowered where their roots grow faster.

    Raises UsageError.

    >>> import numpy as np, pgdr
    >>> field = pgdr.sizes_on_raster(np.full((4, 5), 0.01), (1, 0, 0, 0, -1, 4))
    >>> field([[2.5, 2.0]]).tolist()
    [0.01]
    """
    sizes = np.array(_arguments.reals("values", np.asarray(values)), dtype=np.float64)
    mask = getattr(values, "mask", False)
    if not callable(mask) and np.shape(mask) == sizes.shape:  # of a numpy.ma array
        sizes[np.asarray(mask)] = np.nan
    if sizes.ndim != 2 or min(sizes.shape) < 2:
        raise usage(f"values must be a raster of two rows and columns or more, not of the shape {sizes.shape}")
    a, b, c, d, e, f = (_arguments.number("transform", number) for number in tuple(transform)[:6])
    row, column = (index.reshape(-1) + 0.5 for index in np.indices(sizes.shape))
    at = np.stack([a * column + b * row + c, d * column + e * row + f], axis=1)
    there = ~np.isnan(sizes)
    number = np.arange(sizes.size).reshape(sizes.shape)
    around = np.stack([number[rows, columns].reshape(-1) for rows, columns in _CORNERS], axis=1)
    known = there.reshape(-1)[around]
    whole = around[known.all(axis=1)]
    three = around[known.sum(axis=1) == 3][known[known.sum(axis=1) == 3]].reshape(-1, 3)
    cells = np.concatenate([whole[:, [0, 1, 2]], whole[:, [0, 2, 3]], three])
    if not len(cells):
        raise usage("no three neighbouring values are there")
    background = Mesh.from_arrays(at, cells)
    filled = np.where(there, sizes, 1.0).reshape(-1)  # of points that no cell has
    if growth is not None:
        filled = limit_growth(background, filled, growth, of="points")
    return sizes_on_mesh(background, filled, of="points")


# The four cells of a raster about a corner that they have in common, in turn about it.
_CORNERS = [(slice(1, None), slice(None, -1)), (slice(1, None), slice(1, None)), (slice(None, -1), slice(1, None)),
            (slice(None, -1), slice(None, -1))]


def sizes_on_mesh(mesh: Mesh, values: npt.ArrayLike, of: Optional[str] = None) -> Field:
    """Sizes on a background mesh, as (n,) values of its points or (m,) values of its cells. Those of points are interpolated linearly;
    outside, those of the nearest point of the boundary count. Of cells, each point has the smallest of its cells' values, so that
    nowhere in a cell more than its value is allowed.

    Parameters: `of` is "points" or "cells", and needed where a mesh has as many of both. Raises UsageError: another number of values,
    or one that is not positive (ids: the point or cell).

    >>> import pgdr
    >>> square = pgdr.Plc([[0, 0], [1, 0], [1, 1], [0, 1]], segments=[[0, 1], [1, 2], [2, 3], [3, 0]])
    >>> coarse = pgdr.mesh(square)
    >>> finer = pgdr.mesh(square, size=pgdr.sizes_on_mesh(coarse, [0.01] * len(coarse.cells)))
    >>> len(finer.cells) > 100
    True
    """
    at_points = _at_points(mesh, values, of)
    make = _pgdr.sizes_on_mesh2 if mesh.dimension == 2 else _pgdr.sizes_on_mesh3
    return Field(make(mesh._core, at_points), mesh.dimension, (sizes_on_mesh, (mesh, at_points, "points")))


def sizes_in_cells(mesh: Any, bounds: npt.NDArray[np.float64]) -> Field:
    """(m,) bounds on the volume (area) of what lies in each cell; 0 or less: any. The first cell counts of several that have a
    point."""
    make = _pgdr.sizes_in_cells2 if mesh.dimension == 2 else _pgdr.sizes_in_cells3
    return Field(make(mesh._core, bounds), mesh.dimension, (sizes_in_cells, (mesh, bounds)))


def limit_growth(mesh: Mesh, values: npt.ArrayLike, growth: float, of: Optional[str] = None) -> npt.NDArray[np.float64]:
    """(n,) values at the points of a mesh, from values of its points or cells as of `sizes_on_mesh`, lowered where they grow faster
    than `growth` along an edge (gradation)."""
    at_points = _at_points(mesh, values, of)
    limit = _pgdr.limit_growth2 if mesh.dimension == 2 else _pgdr.limit_growth3
    made: npt.NDArray[np.float64] = limit(mesh._core, at_points, _arguments.number("growth", growth))
    return made


def _at_points(mesh: Mesh, values: npt.ArrayLike, of: Optional[str]) -> npt.NDArray[np.float64]:
    """One value a point, from one a point or one a cell."""
    points, cells = len(_mesh("mesh", mesh).points), len(mesh.cells)
    given = _arguments.reals("values", values)
    if of is None:
        if given.shape == (points,) == (cells,):
            raise usage(f"the mesh has {points} points and as many cells: say which the values are of, as of=\"points\" or of=\"cells\"")
        if given.shape not in ((points,), (cells,)):
            raise usage(f"values must have one number for each of {points} points, or one for each of {cells} cells, in the shape "
                        f"({points},) or ({cells},), not {given.shape}")
        of = "points" if given.shape == (points,) else "cells"
    if _arguments.word("of", of, ("points", "cells")) == "points":
        return np.array(_arguments.values("values", given, points, "points"))
    smallest_at = _pgdr.smallest_at_vertices2 if mesh.dimension == 2 else _pgdr.smallest_at_vertices3
    return smallest_at(mesh._core, _arguments.values("values", given, cells, "cells"))


def _mesh(name: str, value: Optional[object]) -> Mesh:
    if not isinstance(value, Mesh):
        raise TypeError(f"{name} must be a pgdr.Mesh, not {type(value).__name__}")
    return value
