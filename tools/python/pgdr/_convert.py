# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs from meshio and PyVista, meshes to these. Neither package is needed until it is asked for."""
from __future__ import annotations

import importlib
from typing import Any, Dict, Iterable, List, Optional, Sequence, Tuple

import numpy as np
import numpy.typing as npt

from . import _arguments
from ._cells import FACES, LINES, VOLUMES, block_of, input_of, is_flat
from ._doors import door
from ._errors import usage
from ._mesh import Mesh
from ._plc import Plc

_MARKERS = ("marker", "gmsh:physical", "medit:ref")  # of constraints, the first that is there
_LABELS = ("region", "gmsh:physical", "medit:ref")  # of cells
_VTK_TRIANGLE, _VTK_TETRA = 5, 10
_VTK_KINDS = {1: "vertex", 2: "vertex", 3: "line", 4: "line", _VTK_TRIANGLE: "polygon", 7: "polygon", 9: "polygon", _VTK_TETRA: "tetra",
              12: "hexahedron", 13: "wedge", 14: "pyramid"}


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
    made = input_of(points, [block_of(kind, block.data, _numbers_of(mesh.cell_data, _LABELS if kind in full else _MARKERS, number,
                                                                    len(block.data)))
                             for number, (kind, block) in enumerate(zip(kinds, mesh.cells)) if kind != "vertex"])
    return _named(made, getattr(mesh, "field_data", {}) or {})


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


@door
def to_pyvista(mesh: Mesh) -> Any:
    """A pyvista.UnstructuredGrid of the cells, with cell data `region`; z = 0 in 2D. Raises ImportError without pyvista."""
    pyvista = _package("pyvista")
    cells = np.asarray(mesh.cells, dtype=np.int64)
    padded = np.column_stack([np.full(len(cells), cells.shape[1], dtype=np.int64), cells]).reshape(-1)
    points = np.asarray(mesh.points)
    if mesh.dimension == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    kinds = np.full(len(cells), _VTK_TRIANGLE if mesh.dimension == 2 else _VTK_TETRA, dtype=np.uint8)
    grid = pyvista.UnstructuredGrid(padded, kinds, np.ascontiguousarray(points))
    grid.cell_data["region"] = np.array(mesh.regions)
    return grid


def _unpadded(name: str, flat: object) -> List[npt.NDArray[np.int64]]:
    """Lists of indices, each behind its length, as VTK keeps them."""
    numbers = np.asarray(flat, dtype=np.int64).reshape(-1)
    lists, at = [], 0
    while at < len(numbers):
        end = at + 1 + int(numbers[at])
        if numbers[at] < 0 or end > len(numbers):
            raise usage(f"{name} is damaged: a list of {numbers[at]} indices at {at} does not fit")
        lists.append(numbers[at + 1:end])
        at = end
    return lists


def _numbers(mesh: Any, names: Sequence[str], chosen: npt.NDArray[np.bool_]) -> npt.NDArray[np.int64]:
    """The markers or labels of some cells of a data set of PyVista, 0 where there are none."""
    data = {name: [np.asarray(mesh.cell_data[name])[chosen]] for name in names if name in mesh.cell_data}
    return _numbers_of(data, names, 0, int(chosen.sum()))


def _cells_of_grid(mesh: Any) -> Tuple[List[npt.NDArray[np.int64]], npt.NDArray[Any]]:
    """The corners of each cell of an UnstructuredGrid, and its kind."""
    types = np.asarray(mesh.celltypes)
    other = sorted(set(types.tolist()) - set(_VTK_KINDS))
    if other:
        raise usage(f"cells of the VTK types {', '.join(map(str, other))} are not taken: the surface of the grid is what is needed, "
                    "which grid.extract_surface() gives")
    cells = _unpadded("cells", mesh.cells)
    if len(cells) != len(types):
        raise usage(f"cells is damaged: it has {len(cells)} cells, celltypes has {len(types)}")
    return cells, np.array([_VTK_KINDS[int(t)] for t in types], dtype=object)


def _cells_of_surface(mesh: Any) -> Tuple[List[npt.NDArray[np.int64]], npt.NDArray[Any]]:
    """The same of a PolyData, whose cells are its vertices, its lines, its faces, then its strips."""
    if np.size(getattr(mesh, "strips", ())):
        raise usage("strips of triangles are not taken: call triangulate() first")
    cells: List[npt.NDArray[np.int64]] = []
    kinds: List[str] = []
    for name, kind in (("verts", "vertex"), ("lines", "line"), ("faces", "polygon")):
        lists = _unpadded(name, getattr(mesh, name, ()))
        cells += lists
        kinds += [kind] * len(lists)
    return cells, np.array(kinds, dtype=object)


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
    full = FACES if is_flat(_arguments.points("points", points), kinds.tolist()) else VOLUMES
    blocks = []
    for kind in (*FACES, *VOLUMES, "line"):
        chosen = kinds == kind
        rows = [cells[i] for i in np.flatnonzero(chosen)]
        if rows:
            numbers = _numbers(mesh, _LABELS if kind in full else _MARKERS, chosen)
            if kind == "line":  # of two points or more
                numbers = np.repeat(numbers, [max(len(row) - 1, 0) for row in rows])
                rows = [row[i:i + 2] for row in rows for i in range(len(row) - 1)]
            blocks.append(block_of(kind, rows, numbers))
    return input_of(points, blocks)
