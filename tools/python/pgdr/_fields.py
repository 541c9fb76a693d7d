# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Sizing fields that are evaluated in C++, without the GIL. Sizes are bounds of circumradii in 3D, of areas in 2D."""
from __future__ import annotations

from typing import Callable, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _arguments, _pgdr
from ._errors import usage
from ._mesh import Mesh

#: A number, a field, or a function of an (n, D) array of points that returns their n sizes.
Size = Union[float, "Field", Callable[[npt.NDArray[np.float64]], npt.ArrayLike]]


class Field:
    """A sizing field; `smallest`, `sizes_at_points` and `sizes_on_mesh` make them. Any number of threads may ask one."""

    def __init__(self, core: _pgdr._Field, dimension: int) -> None:
        self._core = core
        self._dimension = dimension

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self._dimension

    def __call__(self, points: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """The sizes at (n, D) points: (n,)."""
        return self._core.at(_arguments.coordinates("points", points, self._dimension))

    def __repr__(self) -> str:
        return f"<pgdr.Field {self._dimension}D>"


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
    return Field(join([core_of("a size", f, dimension) for f in fields]), dimension)


def sizes_at_points(points: npt.ArrayLike, sizes: npt.ArrayLike, growth: float) -> Field:
    """Sizes at (n, D) points, which grow with the distance: min over i of sizes[i] + growth |x - points[i]|, in 2D of the square
    root of the area. Raises UsageError: no points, a size that is not positive, a negative growth."""
    at = _arguments.points("points", points).astype(np.float64)
    make = _pgdr.sizes_at_points2 if at.shape[1] == 2 else _pgdr.sizes_at_points3
    values = _arguments.values("sizes", sizes, len(at), "points")
    return Field(make(at, values, _arguments.number("growth", growth)), int(at.shape[1]))


def sizes_on_mesh(mesh: Mesh, values: npt.ArrayLike) -> Field:
    """Sizes at the vertices of a background mesh, interpolated linearly; outside, those of the nearest point of its boundary."""
    make = _pgdr.sizes_on_mesh2 if _mesh("mesh", mesh).dimension == 2 else _pgdr.sizes_on_mesh3
    return Field(make(mesh._core, _arguments.values("values", values, len(mesh.points), "points")), mesh.dimension)


def limit_growth(mesh: Mesh, values: npt.ArrayLike, growth: float) -> npt.NDArray[np.float64]:
    """(n,) values at the vertices of a mesh, lowered where they grow faster than `growth` along an edge (gradation)."""
    limit = _pgdr.limit_growth2 if _mesh("mesh", mesh).dimension == 2 else _pgdr.limit_growth3
    made: npt.NDArray[np.float64] = limit(mesh._core, _arguments.values("values", values, len(mesh.points), "points"),
                                          _arguments.number("growth", growth))
    return made


def _mesh(name: str, value: Optional[object]) -> Mesh:
    if not isinstance(value, Mesh):
        raise TypeError(f"{name} must be a pgdr.Mesh, not {type(value).__name__}")
    return value
