# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes as inputs of other meshes, and what lives on them."""
from __future__ import annotations

from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _arguments, _pgdr
from ._ending import WORK
from ._errors import usage
from ._fields import Size, in_unit, limit_growth, size_unit_of, sizes_in_cells, sizes_on_mesh, smallest
from ._mesh import Mesh, required_mask
from ._plc import Plc
from ._run import mesh as _mesh

_Values = Mapping[str, npt.ArrayLike]


def remesh(old: Mesh, *, point_sizes: Optional[npt.ArrayLike] = None, cell_sizes: Optional[npt.ArrayLike] = None,
           size: Optional[Size] = None, growth: Optional[float] = None, size_unit: Optional[str] = None,
           edge_length: Optional[Size] = None, required: Optional[npt.ArrayLike] = None, tolerance: Optional[float] = None,
           keep_boundary: Union[bool, Sequence[int]] = False, **options: Any) -> Mesh:
    """Meshes anew what a mesh fills (docs/remeshing.md): its boundary, the faces between its labels, its subfacets and subsegments,
    with labels, markers and names. Planar parts are whole facets, and straight ones whole segments, within the tolerance; vertices
    inside of these, and of cells, go unless they are required.

    Parameters
    ----------
    old : Mesh
    point_sizes, cell_sizes : array, optional
        (n,) sizes at the points of the old mesh, or (m,) of its cells, as `sizes_on_mesh` takes them.
    size : float, Field, or function, optional
        A further bound.
    growth : float, optional
        Most that point_sizes and cell_sizes may grow a unit of length: `limit_growth`.
    size_unit : "edge", "radius", "area" or "volume", optional
        What all sizes are of, as in `pgdr.mesh`.
    edge_length : float, Field, or function, optional
        Short for size=edge_length, size_unit="edge".
    required : (n,) array of bool, optional
        Points of the old mesh that are points of the new one, wherever they are.
    tolerance : float, optional
        The length within which parts of the boundary are of one plane or line, and more (docs/inputs.md).
    keep_boundary : bool or sequence of int
        No edge and, in 3D, no triangle of the boundary is joined with others or gets a point. Numbers: nothing is joined, and those
        with these markers get no points.
    **options
        Of `pgdr.mesh`: min_angle, radius_edge, min_dihedral, region_sizes, surface_tolerance, threads, stop, ...

    Point attributes come along by linear interpolation; other arrays by `Transfer`. `pgdr.check(new, old)` certifies the new mesh
    against the old one.

    >>> import pgdr
    >>> square = pgdr.Plc([[0, 0], [1, 0], [1, 1], [0, 1]], segments=[[0, 1], [1, 2], [2, 3], [3, 0]])
    >>> fine = pgdr.mesh(square, size=0.01)
    >>> coarse = pgdr.remesh(fine)
    >>> len(coarse.points), bool(pgdr.check(coarse, fine))
    (4, True)
    """
    _require_mesh(old)
    size = _size_of(old, point_sizes, cell_sizes, size, growth, size_unit, edge_length, options)
    return _anew(old, required_mask(old, required), tolerance, keep_boundary, False, size, options)


def refine(old: Mesh, *, cell_bounds: Optional[npt.ArrayLike] = None, point_sizes: Optional[npt.ArrayLike] = None,
           cell_sizes: Optional[npt.ArrayLike] = None, size: Optional[Size] = None, growth: Optional[float] = None,
           size_unit: Optional[str] = None, edge_length: Optional[Size] = None, tolerance: Optional[float] = None,
           keep_boundary: Union[bool, Sequence[int]] = False, **options: Any) -> Mesh:
    """What -r of TetGen and Triangle is for: all points, segments and facets of a mesh stay, and points are added where bounds ask. Cells
    are those of the constrained Delaunay triangulation of all points, and not the old ones where these are not Delaunay; the
    optimiser may change them, but for optimize=False.

    Parameters
    ----------
    old : Mesh
    cell_bounds : array, optional
        (m,) the largest volume (2D: area) of what lies in each old cell; 0 or less: any.
    point_sizes, cell_sizes, size, growth, size_unit, edge_length, tolerance
        As of `remesh`.
    keep_boundary : bool or sequence of int
        No segment and, in 3D, no triangle of the boundary gets a point, all or those with these markers.
    **options
        Of `pgdr.mesh`.

    The points of the old mesh come first, in their order. `pgdr.check(new, old, required=np.ones(len(old.points), bool))` certifies it.

    >>> import numpy as np, pgdr
    >>> square = pgdr.Plc([[0, 0], [1, 0], [1, 1], [0, 1]], segments=[[0, 1], [1, 2], [2, 3], [3, 0]])
    >>> coarse = pgdr.mesh(square)
    >>> fine = pgdr.refine(coarse, cell_bounds=[0.01, 0])
    >>> bool((fine.points[:4] == coarse.points).all()), len(fine.cells) > 20
    (True, True)
    """
    _require_mesh(old)
    size = _size_of(old, point_sizes, cell_sizes, size, growth, size_unit, edge_length, options)
    if cell_bounds is not None:
        inside = sizes_in_cells(old, _arguments.values("cell_bounds", cell_bounds, len(old.cells), "cells"))
        size = inside if size is None else smallest(size, inside)
    return _anew(old, required_mask(old, None), tolerance, keep_boundary, True, size, options)


def _require_mesh(old: Any) -> None:
    if not isinstance(old, Mesh):
        raise TypeError(f"old must be a pgdr.Mesh, not {type(old).__name__}")


def _size_of(old: Mesh, point_sizes: Optional[npt.ArrayLike], cell_sizes: Optional[npt.ArrayLike], size: Optional[Size],
             growth: Optional[float], size_unit: Optional[str], edge_length: Optional[Size], options: Dict[str, Any]) -> Optional[Size]:
    """All sizes as one, in the usual unit, as region_sizes of the options are then."""
    dimension = old.dimension
    size, unit = size_unit_of(size, edge_length, size_unit)
    sizes = [] if size is None else [in_unit(size, unit, dimension)]
    for name, values, of in (("point_sizes", point_sizes, "points"), ("cell_sizes", cell_sizes, "cells")):
        if values is None:
            continue
        count = len(old.points) if of == "points" else len(old.cells)
        native = _usual(_arguments.values(name, values, count, of), unit, dimension)
        if growth is not None:
            grown = _arguments.number("growth", growth) * _growth_of(unit, dimension)
            native, of = limit_growth(old, native, grown, of=of), "points"
        sizes.append(sizes_on_mesh(old, native, of=of))
    if growth is not None and point_sizes is None and cell_sizes is None:
        raise usage("growth is of point_sizes or cell_sizes")
    if unit is not None and options.get("region_sizes") is not None:
        options["region_sizes"] = {key: in_unit(value, unit, dimension) for key, value in options["region_sizes"].items()}
    return None if not sizes else sizes[0] if len(sizes) == 1 else smallest(*sizes)


def _anew(old: Mesh, required: npt.NDArray[np.uint8], tolerance: Optional[float], keep_boundary: Union[bool, Sequence[int]],
          keep_vertices: bool, size: Optional[Size], options: Dict[str, Any]) -> Mesh:
    if size is not None:
        options["size"] = size
    of_dimension = _pgdr.remesh_input2 if old.dimension == 2 else _pgdr.remesh_input3
    limit = None if tolerance is None else _arguments.number("tolerance", tolerance)
    is_kept, _ = _arguments.kept("keep_boundary", keep_boundary)
    with WORK:
        core, facets = of_dimension(old._core, required, limit, is_kept, keep_vertices)
    made = _mesh(Plc._of(core), keep_boundary=keep_boundary, **options)
    finish = _pgdr.finish_remesh2 if old.dimension == 2 else _pgdr.finish_remesh3
    finish(made._core, old._core, facets)
    return made


def _usual(values: npt.NDArray[np.float64], unit: Optional[str], dimension: int) -> npt.NDArray[np.float64]:
    if unit is None:
        return values
    convert = _pgdr.usual_sizes2 if dimension == 2 else _pgdr.usual_sizes3
    return convert(values, unit)


def _growth_of(unit: Optional[str], dimension: int) -> float:
    if unit is None:
        return 1.0
    return (_pgdr.growth_of_unit2 if dimension == 2 else _pgdr.growth_of_unit3)(unit)


def sizes_from_error(mesh: Mesh, eta: npt.ArrayLike, target: float, *, order: int = 1, finer: float = 4.0,
                     coarser: float = 2.0) -> npt.NDArray[np.float64]:
    """Sizes of cells with which the error will be `target`, by an estimate of it on each cell: (m,), as `remesh(mesh, cell_sizes=...)`
    takes them in the usual unit.

    All new cells are to have the same error e. One of a cell of length h falls as h**(order + D / 2), and a cell becomes (h / h')**D
    new ones; so e follows from the sum over all of them, whose squares add up to that of `target`. How large cells are on average
    within a bound is taken into account. Where the solution is singular a few rounds do it (tools/examples/l_shape.py).

    Parameters
    ----------
    mesh : Mesh
    eta : array
        (m,) estimates, not negative: the square root of the sum of their squares is the error.
    target : float
        The error that is wanted.
    order : int
        Of the elements: the error in energy falls as h**order where the solution is smooth.
    finer, coarser : float
        Cells get no shorter than by the first of these factors at once, and no longer than by the second.
    """
    if not isinstance(mesh, Mesh):
        raise TypeError(f"mesh must be a pgdr.Mesh, not {type(mesh).__name__}")
    errors = _arguments.values("eta", eta, len(mesh.cells), "cells")
    wanted = _arguments.number("target", target)
    if not (errors >= 0).all() or not np.isfinite(errors).all() or not wanted > 0:
        raise usage("eta must be finite and not negative, target above 0")
    if not finer >= 1 or not coarser >= 1 or order < 1:
        raise usage("finer, coarser and order must be 1 or more")
    dimension = mesh.dimension
    power = order + dimension / 2
    q = dimension / power
    total = float((errors**q).sum())
    each = (wanted**2 / total)**(1 / (2 - q)) if total > 0 else np.inf
    with np.errstate(divide="ignore"):
        ratio = np.clip((each / errors)**(1 / power), 1 / finer, coarser)
    corners = mesh.points[mesh.cells]
    measure = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / (2 if dimension == 2 else 6) * ratio**dimension
    if dimension == 2:
        return np.asarray(measure / _MEAN_AREA)
    return np.asarray(np.cbrt(measure / _MEAN_VOLUME))


#: Of the bound on the area, the mean area of cells; of the cube of the bound on the circumradius, their mean volume (measured).
_MEAN_AREA, _MEAN_VOLUME = 0.645, 0.21


class Transfer:
    """What lives on one mesh, on another one of the same volumes. Where points are, and what cells have in common, is found when it is
    asked for first, for as many arrays as there are.

    >>> import numpy as np, pgdr
    >>> square = pgdr.Plc([[0, 0], [1, 0], [1, 1], [0, 1]], segments=[[0, 1], [1, 2], [2, 3], [3, 0]])
    >>> old, new = pgdr.mesh(square, size=0.01), pgdr.mesh(square, size=0.003)
    >>> transfer = pgdr.Transfer(old, new)
    >>> bool(np.abs(transfer.points(old.points @ [2.0, 1.0]) - new.points @ [2.0, 1.0]).max() < 1e-14)
    True
    """

    def __init__(self, old: Mesh, new: Mesh) -> None:
        for name, value in (("old", old), ("new", new)):
            if not isinstance(value, Mesh):
                raise TypeError(f"{name} must be a pgdr.Mesh, not {type(value).__name__}")
        if old.dimension != new.dimension:
            raise usage(f"the old mesh has {old.dimension} dimensions, the new one {new.dimension}")
        self._old, self._new = old, new
        self._at_points: Any = None
        self._on_cells: Any = None

    def points(self, values: npt.ArrayLike) -> npt.NDArray[Any]:
        """(n, ...) values at the points of the old mesh, numbers, vectors or tensors: those at the points of the new one, interpolated
        linearly in the old cell that a point lies in; outside, those of the nearest point of the boundary. Whole numbers are those
        of the nearest corner of the cell."""
        given, flat, width = _rows("values", values, len(self._old.points), "points")
        if self._at_points is None:
            make = _pgdr.PointTransfer2 if self._old.dimension == 2 else _pgdr.PointTransfer3
            with WORK:
                self._at_points = make(self._old._core, np.ascontiguousarray(self._new.points))
        is_whole = given.dtype.kind in "iub"
        made = (self._at_points.nearest if is_whole else self._at_points.means)(flat, width)
        return _shaped(made, given, is_whole)

    def cells(self, values: npt.ArrayLike) -> npt.NDArray[Any]:
        """(m, ...) values of the cells of the old mesh, per volume (2D: area): those of the cells of the new one, so that the integral
        stays, label by label. Whole numbers, (m,), are those that have the largest share of a cell."""
        given, flat, width = _rows("values", values, len(self._old.cells), "cells")
        if self._on_cells is None:
            make = _pgdr.CellTransfer2 if self._old.dimension == 2 else _pgdr.CellTransfer3
            with WORK:
                self._on_cells = make(self._old._core, self._new._core)
        if given.dtype.kind in "iub" and given.ndim == 1:
            return _shaped(self._on_cells.largest_share(flat), given, True)
        return _shaped(self._on_cells.means(flat, width), given, False)


def _rows(name: str, values: npt.ArrayLike, count: int, what: str) -> Tuple[npt.NDArray[Any], npt.NDArray[np.float64], int]:
    given = np.asarray(values)
    if given.ndim == 0 or len(given) != count:
        raise usage(f"{name} must have a row for each of {count} {what}, not the shape {given.shape}")
    flat = _arguments.reals(name, given.astype(np.float64) if given.dtype.kind == "b" else given)
    width = int(np.prod(given.shape[1:], dtype=np.int64))
    if width == 0:
        raise usage(f"{name} has rows without numbers: {given.shape}")
    return given, flat.reshape(-1), width


def _shaped(made: npt.NDArray[np.float64], given: npt.NDArray[Any], is_whole: bool) -> npt.NDArray[Any]:
    shaped = made.reshape((-1,) + given.shape[1:])
    return shaped.astype(given.dtype) if is_whole else shaped


class FileFields(NamedTuple):
    """The arrays of a file that are not part of its mesh, by their names."""

    point_data: Dict[str, npt.NDArray[Any]]  #: (n,) or (n, width)
    cell_data: Dict[str, npt.NDArray[Any]]  #: (m,) or (m, width)


def read_fields(path: _arguments.Path) -> FileFields:
    """Fields of a .vtu; none of other formats. Raises FileError, InputError with file and line."""
    file = _arguments.path(path)
    made = FileFields({}, {})
    for name, of_cells, width, is_whole, values in _pgdr.read_fields(file):
        array: npt.NDArray[Any] = values.astype(np.int64) if is_whole else values
        (made.cell_data if of_cells else made.point_data)[name] = array if width == 1 else array.reshape(-1, width)
    return made


def write_fields(mesh: Mesh, path: _arguments.Path, point_data: Optional[_Values] = None,
                 cell_data: Optional[_Values] = None) -> None:
    """Writes a mesh with fields to a .vtu: arrays with a row for each point or cell, of any width. Raises FileError, UsageError."""
    if not isinstance(mesh, Mesh):
        raise TypeError(f"mesh must be a pgdr.Mesh, not {type(mesh).__name__}")
    rows: List[Tuple[str, bool, int, bool, npt.NDArray[np.float64]]] = []
    for of_cells, data in ((False, point_data), (True, cell_data)):
        count, what = (len(mesh.cells), "cells") if of_cells else (len(mesh.points), "points")
        for name, values in _arguments.mapping("fields", data or {}, "name and array").items():
            given, flat, width = _rows(f"the field {name!r}", values, count, what)
            rows.append((str(name), of_cells, width, given.dtype.kind in "iub", flat))
    write = _pgdr.write_fields2 if mesh.dimension == 2 else _pgdr.write_fields3
    with WORK:
        write(mesh._core, rows, _arguments.path(path))
