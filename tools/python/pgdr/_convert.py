# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs from meshio and PyVista, meshes to these. Neither package is needed until it is asked for."""
from __future__ import annotations

import importlib
from typing import Any, Dict, Iterable, List, NamedTuple, Sequence, Tuple

import numpy as np
import numpy.typing as npt

from . import _arguments
from ._cells import FACES, LINES, VOLUMES, Rows, block_of, input_of, is_flat
from ._doors import door
from ._errors import usage
from ._mesh import Mesh
from ._plc import Plc

_MARKERS = ("marker", "gmsh:physical", "medit:ref")  # of constraints, the first that is there
_LABELS = ("region", "gmsh:physical", "medit:ref")  # of cells
_VTK_TRIANGLE, _VTK_TETRA = 5, 10
_VTK_KINDS = {1: "vertex", 2: "vertex", 3: "line", 4: "line", _VTK_TRIANGLE: "polygon", 7: "polygon", 9: "polygon", _VTK_TETRA: "tetra",
              12: "hexahedron", 13: "wedge", 14: "pyramid"}
_VTK_OF_WIDTH = {2: 3, 3: _VTK_TRIANGLE, 4: _VTK_TETRA}


def _package(name: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(f"this needs the package {name}: python3 -m pip install {name}") from error


def _refuse_own(mesh: Any) -> None:
    if isinstance(mesh, Mesh):
        raise TypeError("a pgdr.Mesh is taken by pgdr.Plc.from_mesh")


def _numbers_of(data: Dict[str, Any], names: Iterable[str], block: int, count: int) -> npt.NDArray[np.int64]:
    """The markers or labels of a block of cells, 0 where it has none."""
    for name in names:
        if name in data:
            given = np.asarray(data[name][block])
            whole = given.astype(np.int64)
            if given.shape != (count,) or not np.array_equal(whole, given):
                raise usage(f"cell data {name!r} must be one integer a cell")
            return whole
    return np.zeros(count, dtype=np.int64)


@door
def from_meshio(mesh: Any) -> Plc:
    """See Plc.from_meshio. Vertex blocks add nothing."""
    _refuse_own(mesh)
    if not hasattr(mesh, "points") or not hasattr(mesh, "cells"):
        raise TypeError(f"a meshio.Mesh is taken, with points and cells, not {type(mesh).__name__}")
    points = np.asarray(mesh.points)
    kinds = ["polygon" if str(block.type).startswith("polygon") else str(block.type) for block in mesh.cells]
    unknown = sorted(set(kinds) - {*LINES, *FACES, *VOLUMES, "vertex"})
    if unknown:
        curved = any(kind.rstrip("0123456789") in (*LINES, *FACES, *VOLUMES) for kind in unknown)
        raise usage(f"cells of the type {', '.join(unknown)} are not taken: there are {', '.join((*LINES, *FACES, *VOLUMES))}"
                    + ("; those with further points on their edges would be curved" if curved else ""))
    full = FACES if is_flat(_arguments.points("points", points), kinds) else VOLUMES
    sets = _Sets(mesh, [kind in full for kind in kinds])
    made = input_of(points, [block_of(kind, block.data, sets.numbers(number, len(block.data)))
                             for number, (kind, block) in enumerate(zip(kinds, mesh.cells)) if kind != "vertex"])
    return sets.named(_named(made, getattr(mesh, "field_data", {}) or {}))


class _Sets:
    """The cell sets of a meshio.Mesh. Where cells have no numbers, sets number them from 1, as they come, and a cell has that of the
    first one that has it; else a set that has just the cells of one number is the name of that. Those of cells that fill the domain are
    of labels, others of markers."""

    def __init__(self, mesh: Any, fills: Sequence[bool]) -> None:
        self._data = mesh.cell_data
        self._fills = list(fills)
        self._numbers: Dict[int, npt.NDArray[np.int64]] = {}
        given = getattr(mesh, "cell_sets", None) or {}
        self._rows = {str(name): [np.zeros(0, dtype=np.int64) if rows is None else np.asarray(rows).astype(np.int64) for rows in parts]
                      for name, parts in given.items() if not str(name).startswith("gmsh:")}

    def _of(self, fills: bool) -> Dict[str, Dict[int, npt.NDArray[np.int64]]]:
        """The sets that have such cells: by name and block, the rows."""
        parts = {name: {block: rows for block, rows in enumerate(parts) if len(rows) and self._fills[block] == fills}
                 for name, parts in self._rows.items()}
        return {name: blocks for name, blocks in parts.items() if blocks}

    def numbers(self, block: int, count: int) -> npt.NDArray[np.int64]:
        """The markers or labels of a block."""
        names = _LABELS if self._fills[block] else _MARKERS
        made = _numbers_of(self._data, names, block, count)
        if not any(name in self._data for name in names):
            for number, blocks in reversed(list(enumerate(self._of(self._fills[block]).values(), 1))):
                rows = blocks.get(block, made[:0])
                if (rows < 0).any() or (rows >= count).any():
                    raise usage(f"a cell set has a row that block {block} of the cells lacks")
                made[rows] = number
        self._numbers[block] = made
        return made

    def _names(self, fills: bool) -> Dict[int, str]:
        """Of numbers, the first set that has just their cells."""
        names: Dict[int, str] = {}
        for name, blocks in self._of(fills).items():
            own = {int(number) for block, rows in blocks.items() if block in self._numbers
                   for number in np.unique(self._numbers[block][rows])}
            everywhere = sum(int(np.isin(numbers, list(own)).sum()) for block, numbers in self._numbers.items()
                             if self._fills[block] == fills)
            if len(own) == 1 and everywhere == sum(map(len, blocks.values())):
                names.setdefault(own.pop(), name)
        return names

    def named(self, plc: Plc) -> Plc:
        """With the names of sets, where numbers have none yet."""
        labels, markers = set(plc.regions[:, plc.dimension].tolist()), set(plc.markers.tolist())
        regions: Dict[float, str] = {float(n): name for n, name in self._names(True).items() if n in labels}
        of_markers = {n: name for n, name in self._names(False).items() if n in markers}
        if not regions and not of_markers:
            return plc
        return plc.with_names(regions={**regions, **plc.region_names}, markers={**of_markers, **plc.marker_names})


def _named(plc: Plc, field_data: Dict[str, Any]) -> Plc:
    """With the names that are keys of pairs (number, dimension), as of gmsh's physical groups."""
    dimension = plc.dimension
    pairs = [(name, np.asarray(pair).reshape(-1).tolist()) for name, pair in field_data.items()]
    of = {d: {int(pair[0]): str(name) for name, pair in pairs if len(pair) == 2 and pair[1] == d} for d in (dimension, dimension - 1)}
    labels, markers = set(plc.regions[:, dimension].tolist()), set(plc.markers.tolist())
    regions = {float(label): name for label, name in of[dimension].items() if label in labels}
    named = {marker: name for marker, name in of[dimension - 1].items() if marker in markers}
    return plc.with_names(regions=regions, markers=named) if regions or named else plc


def _constraints(mesh: Mesh) -> List[Tuple[str, npt.NDArray[Any], npt.NDArray[Any]]]:
    lines = [("line", mesh.subsegments, mesh.subsegment_markers)]
    return lines if mesh.dimension == 2 else [("triangle", mesh.subfacets, mesh.subfacet_markers)] + lines


@door
def to_meshio(mesh: Mesh) -> Any:
    """A meshio.Mesh: the cells, then in 3D the subfacets, then the subsegments; cell data `region` (0 for constraints) and `marker`
    (0 for cells), as in a .vtu. Where anything has a name, also a cell set of each name; field data of each, a label or marker and the
    dimension of what has it; and cell data `gmsh:physical`, label or marker in one. Raises ImportError without meshio."""
    meshio = _package("meshio")
    constraints = [block for block in _constraints(mesh) if len(block[1])]
    cells = [("triangle" if mesh.dimension == 2 else "tetra", np.asarray(mesh.cells))]
    cells += [(kind, np.asarray(vertices)) for kind, vertices, _ in constraints]
    regions = [np.asarray(mesh.regions)] + [np.zeros(len(vertices)) for _, vertices, _ in constraints]
    markers = [np.zeros(len(mesh.cells), dtype=np.int32)] + [np.asarray(numbers) for _, _, numbers in constraints]
    point_markers = np.asarray(mesh.point_markers)
    cell_data = {"region": regions, "marker": markers}
    if not mesh.region_names and not mesh.marker_names:
        return meshio.Mesh(np.asarray(mesh.points), cells, cell_data=cell_data,
                           point_data={"marker": point_markers} if point_markers.size else {})
    physical = [regions[0]] + markers[1:]
    if all(np.array_equal(numbers, numbers.astype(np.int32)) for numbers in physical):
        cell_data["gmsh:physical"] = [numbers.astype(np.int32) for numbers in physical]
    return meshio.Mesh(np.asarray(mesh.points), cells, cell_data=cell_data, cell_sets=_cell_sets(mesh, physical),
                       field_data=_field_data(mesh), point_data={"marker": point_markers} if point_markers.size else {})


def _cell_sets(mesh: Mesh, physical: List[npt.NDArray[Any]]) -> Dict[str, List[npt.NDArray[np.int64]]]:
    """Of each name the rows of the cells of each block that have it."""
    sets: Dict[str, List[npt.NDArray[np.int64]]] = {}
    of_kinds: List[Dict[Any, str]] = [dict(mesh.region_names), dict(mesh.marker_names)]
    for name in sorted({name for names in of_kinds for name in names.values()}):
        rows = []
        for block, numbers in enumerate(physical):
            labels = [label for label, own in of_kinds[min(block, 1)].items() if own == name]
            rows.append(np.flatnonzero(np.isin(numbers, labels)))
        sets[name] = rows
    return sets


def _field_data(mesh: Mesh) -> Dict[str, npt.NDArray[Any]]:
    """Of names that several have, the first, and regions before markers."""
    data: Dict[str, npt.NDArray[Any]] = {}
    for marker, name in sorted(mesh.marker_names.items(), reverse=True):
        data[name] = np.array([marker, mesh.dimension - 1])
    for label, name in sorted(mesh.region_names.items(), reverse=True):
        data[name] = np.array([int(label) if label == int(label) else label, mesh.dimension])
    return data


def _padded(rows: npt.NDArray[Any]) -> npt.NDArray[np.int64]:
    """Rows of indices, each behind its length, as VTK has them."""
    made: npt.NDArray[np.int64] = np.pad(np.asarray(rows, dtype=np.int64), ((0, 0), (1, 0)), constant_values=rows.shape[1]).reshape(-1)
    return made


def _spatial(points: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
    """With z = 0 in 2D."""
    made: npt.NDArray[np.float64] = np.pad(np.asarray(points), ((0, 0), (0, 3 - points.shape[1])))
    return np.ascontiguousarray(made)


@door
def to_pyvista(mesh: Mesh, constraints: bool = False) -> Any:
    """See Mesh.to_pyvista."""
    pyvista = _package("pyvista")
    blocks = [(np.asarray(mesh.cells), np.asarray(mesh.regions), np.zeros(len(mesh.cells), dtype=np.int32))]
    if _arguments.flag("constraints", constraints):
        blocks += [(np.asarray(rows), np.zeros(len(rows)), np.asarray(markers)) for _, rows, markers in _constraints(mesh)]
    kinds = np.concatenate([np.full(len(rows), _VTK_OF_WIDTH[rows.shape[1]], dtype=np.uint8) for rows, _, _ in blocks])
    grid = pyvista.UnstructuredGrid(np.concatenate([_padded(rows) for rows, _, _ in blocks]), kinds, _spatial(mesh.points))
    grid.cell_data["region"] = np.concatenate([labels for _, labels, _ in blocks])
    if constraints:
        grid.cell_data["marker"] = np.concatenate([markers for _, _, markers in blocks])
    if np.asarray(mesh.point_markers).size:
        grid.point_data["marker"] = np.array(mesh.point_markers)
    for name, pair in _field_data(mesh).items():
        grid.field_data[name] = pair
    return grid


@door
def surface_to_pyvista(plc: Plc) -> Any:
    """A pyvista.PolyData of the facets of an input, with cell data `marker`. Of a facet of several polygons each is a face."""
    pyvista = _package("pyvista")
    facets, markers = plc.facets, np.asarray(plc.markers)
    if isinstance(facets, np.ndarray):
        made = pyvista.PolyData(_spatial(plc.points), _padded(facets))
    else:
        polygons = [facet if isinstance(facet[0], list) else [facet] for facet in facets]
        markers = np.repeat(markers, [len(part) for part in polygons])
        made = pyvista.PolyData(_spatial(plc.points), np.array([n for part in polygons for row in part for n in (len(row), *row)]))
    made.cell_data["marker"] = markers
    return made


class _Lists(NamedTuple):
    """Lists of indices, one behind the other."""

    flat: npt.NDArray[np.int64]
    sizes: npt.NDArray[np.int64]

    def rows(self, chosen: npt.NDArray[np.bool_]) -> Rows:
        """Some of them: an array where all have one size."""
        sizes, flat = self.sizes[chosen], self.flat[np.repeat(chosen, self.sizes)]
        if (sizes == sizes[:1]).all():
            return flat.reshape(len(sizes), -1)
        return np.split(flat, np.cumsum(sizes)[:-1])


def _unpadded(name: str, given: object) -> _Lists:
    """Lists of indices, each behind its length, as VTK keeps them."""
    numbers = np.asarray(given, dtype=np.int64).reshape(-1)
    count = len(numbers)
    if not count:
        return _Lists(numbers, numbers)
    width = int(numbers[0]) + 1
    starts = np.arange(0, count, max(width, 1))
    if width < 1 or count % width or (numbers[starts] != width - 1).any():
        starts = _starts(numbers)
    sizes = numbers[starts]
    if sizes[-1] < 0 or starts[-1] + 1 + sizes[-1] > count:  # what is before the last one led here
        raise usage(f"{name} is damaged: a list of {sizes[-1]} indices at {starts[-1]} does not fit")
    return _Lists(np.delete(numbers, starts), sizes)


def _starts(numbers: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Where the lists begin, in their order, up to the first that does not fit. After k rounds, the first 2^k of them are known, and
    the 2^k-th list behind each number."""
    count = len(numbers)
    beyond = np.arange(1, count + 1) + numbers
    beyond = np.append(np.where((numbers < 0) | (beyond > count), count, beyond), count)
    starts = np.zeros(1, dtype=np.int64)
    while beyond[0] < count:
        further = beyond[starts]
        starts = np.concatenate([starts, further[further < count]])
        beyond = beyond[beyond]
    return starts


def _numbers(mesh: Any, names: Sequence[str], chosen: npt.NDArray[np.bool_]) -> npt.NDArray[np.int64]:
    """The markers or labels of some cells of a data set of PyVista, 0 where there are none."""
    data = {name: [np.asarray(mesh.cell_data[name])[chosen]] for name in names if name in mesh.cell_data}
    return _numbers_of(data, names, 0, int(chosen.sum()))


def _cells_of_grid(mesh: Any) -> Tuple[_Lists, npt.NDArray[np.str_]]:
    """The corners of each cell of an UnstructuredGrid, and its kind."""
    types = np.asarray(mesh.celltypes)
    other = sorted(set(np.unique(types).tolist()) - set(_VTK_KINDS))
    if other:
        raise usage(f"cells of the VTK types {', '.join(map(str, other))} are not taken: the surface of the grid is what is needed, "
                    "which grid.extract_surface() gives")
    cells = _unpadded("cells", mesh.cells)
    if len(cells.sizes) != len(types):
        raise usage(f"cells is damaged: it has {len(cells.sizes)} cells, celltypes has {len(types)}")
    kinds = np.array([_VTK_KINDS.get(number, "") for number in range(max(_VTK_KINDS) + 1)])
    return cells, kinds[types]


def _cells_of_surface(mesh: Any) -> Tuple[_Lists, npt.NDArray[np.str_]]:
    """The same of a PolyData, whose cells are its vertices, its lines, its faces, then its strips."""
    if np.size(getattr(mesh, "strips", ())):
        raise usage("strips of triangles are not taken: call triangulate() first")
    lists = [_unpadded(name, getattr(mesh, name, ())) for name in ("verts", "lines", "faces")]
    kinds = np.repeat(np.array(["vertex", "line", "polygon"]), [len(part.sizes) for part in lists])
    return _Lists(np.concatenate([part.flat for part in lists]), np.concatenate([part.sizes for part in lists])), kinds


def _pieces(lines: Rows, numbers: npt.NDArray[np.int64]) -> Tuple[Rows, npt.NDArray[np.int64]]:
    """The edges of lines of two points or more."""
    if isinstance(lines, np.ndarray) and lines.shape[1] == 2:
        return lines, numbers
    rows = [np.stack([row[:-1], row[1:]], axis=1) for row in lines]
    return np.concatenate(rows), np.repeat(numbers, [len(row) for row in rows])


@door
def from_pyvista(mesh: Any) -> Plc:
    """See Plc.from_pyvista."""
    _refuse_own(mesh)
    if hasattr(mesh, "celltypes"):  # a grid may have `faces`, too, those of its polyhedra
        cells, kinds = _cells_of_grid(mesh)
    elif hasattr(mesh, "faces"):
        cells, kinds = _cells_of_surface(mesh)
    else:
        raise TypeError(f"a PolyData or an UnstructuredGrid of PyVista is taken, not {type(mesh).__name__}: other data sets have "
                        "extract_surface() or cast_to_unstructured_grid()")
    points = np.asarray(mesh.points)
    full = FACES if is_flat(_arguments.points("points", points), np.unique(kinds).tolist()) else VOLUMES
    blocks = []
    for kind in (*FACES, *VOLUMES, "line"):
        chosen = kinds == kind
        if chosen.any():
            rows, numbers = cells.rows(chosen), _numbers(mesh, _LABELS if kind in full else _MARKERS, chosen)
            if kind == "line":
                rows, numbers = _pieces(rows, numbers)
            blocks.append(block_of(kind, rows, numbers))
    return _named(input_of(points, blocks), _pairs(getattr(mesh, "field_data", {})))


def _pairs(field_data: Any) -> Dict[str, Any]:
    """Field data that may be a name's number and dimension."""
    arrays = {str(name): np.asarray(field_data[name]) for name in (field_data.keys() if hasattr(field_data, "keys") else ())}
    return {name: pair for name, pair in arrays.items() if pair.dtype.kind in "fiu" and pair.shape == (2,)}
