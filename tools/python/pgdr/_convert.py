# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs from rings, meshio and PyVista; meshes to meshio and PyVista. Neither package is needed until it is asked for."""
from __future__ import annotations

import importlib
import os
import tempfile
from typing import Any, Dict, Iterable, List, Optional, Sequence, Tuple

import numpy as np
import numpy.typing as npt

from . import _arguments
from ._errors import usage

_MARKERS = ("marker", "gmsh:physical", "medit:ref")  # of constraints, the first that is there
_LABELS = ("region", "gmsh:physical", "medit:ref")  # of cells
_FACETS = ("triangle", "quad", "polygon")
_VTK_TRIANGLE, _VTK_TETRA = 5, 10


def _package(name: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(f"this needs the package {name}: python3 -m pip install {name}") from error


def _ring(name: str, value: object) -> npt.NDArray[Any]:
    """The corners of a ring, without the first one again at its end."""
    ring = _arguments.points(name, value, 2)
    if len(ring) > 1 and np.array_equal(ring[0], ring[-1]):
        ring = ring[:-1]
    if len(np.unique(ring, axis=0)) < 3:
        raise usage(f"{name} must have three different corners or more, not {len(np.unique(ring, axis=0))}")
    return ring


def _inside(name: str, ring: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
    """A point inside a ring that does not cross itself: in the middle of the widest span of a horizontal line midway between the two
    neighbouring levels of corners that are farthest apart."""
    corners = ring.astype(np.float64)
    levels = np.unique(corners[:, 1])
    if len(levels) < 2:
        raise usage(f"{name} encloses nothing: all its corners are on one line")
    widest = int(np.argmax(np.diff(levels)))
    y = levels[widest] + (levels[widest + 1] - levels[widest]) / 2
    a, b = corners, np.roll(corners, -1, axis=0)
    crossing = (a[:, 1] < y) != (b[:, 1] < y)
    a, b = a[crossing], b[crossing]
    x = np.sort(a[:, 0] + (b[:, 0] - a[:, 0]) * ((y - a[:, 1]) / (b[:, 1] - a[:, 1])))
    width = x[1::2] - x[0::2]
    span = int(np.argmax(width))
    if not width[span] > 0:
        raise usage(f"{name} encloses nothing: it has no area")
    return np.array([x[2 * span] + width[span] / 2, y])


def from_polygons(outer: object, holes: Sequence[object] = (), *, markers: Optional[Sequence[int]] = None,
                  tolerance: Optional[float] = None) -> Any:
    """See Plc.from_polygons."""
    from ._plc import Plc
    rings = [_ring("outer", outer)] + [_ring(f"hole {i}", hole) for i, hole in enumerate(holes)]
    given = _arguments.markers("markers", list(range(1, len(rings) + 1)) if markers is None else markers, len(rings), "rings")
    segments, begin = [], 0
    for ring in rings:
        number = np.arange(len(ring))
        segments.append(begin + np.stack([number, (number + 1) % len(ring)], axis=1))
        begin += len(ring)
    seeds = [_inside(f"hole {i}", ring) for i, ring in enumerate(rings[1:])]
    return Plc(np.concatenate(rings), np.concatenate(segments), markers=np.repeat(given, [len(ring) for ring in rings]),
               holes=np.array(seeds).reshape(-1, 2), tolerance=tolerance)


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


def _medit(points: npt.NDArray[Any], blocks: Sequence[Tuple[str, npt.NDArray[Any], npt.NDArray[Any]]]) -> Any:
    """The input that the reader of Medit files makes of cells: their common faces, seeds of labels and of voids."""
    from ._plc import Plc
    words = {"line": "Edges", "triangle": "Triangles", "quad": "Quadrilaterals", "tetra": "Tetrahedra"}
    with tempfile.TemporaryDirectory() as folder:
        name = os.path.join(folder, "cells.mesh")
        with open(name, "w", encoding="ascii") as file:
            file.write(f"MeshVersionFormatted 2\nDimension {points.shape[1]}\nVertices\n{len(points)}\n")
            np.savetxt(file, np.column_stack([points, np.zeros(len(points))]), fmt=["%.17g"] * points.shape[1] + ["%d"])
            for kind in words:
                rows = [np.column_stack([corners + 1, numbers]) for k, corners, numbers in blocks if k == kind and len(corners)]
                if rows:
                    file.write(f"{words[kind]}\n{sum(map(len, rows))}\n")
                    np.savetxt(file, np.concatenate(rows), fmt="%d")
            file.write("End\n")
        read = Plc.read(name)
    arguments: Dict[str, Any] = {"markers": read.markers, "holes": read.holes, "regions": read.regions}
    if read.dimension == 3:  # made anew, so that errors name no file that is gone
        arguments.update(facets=read.facets, segment_markers=read.segment_markers)
    return Plc(read.points, read.segments, **arguments)


def from_meshio(mesh: Any) -> Any:
    """See Plc.from_meshio. Of blocks of cells, line, triangle, quad, polygon, tetra and vertex are taken; vertex blocks add nothing.
    With cells of the full dimension, their labels and the voids between them become seeds, as with a file of them, and points that cells
    alone have are left out."""
    from ._plc import Plc
    points = np.asarray(mesh.points)
    kinds = [str(block.type) for block in mesh.cells]
    unknown = sorted({kind for kind in kinds if kind.rstrip("0123456789") not in ("polygon",)
                      and kind not in (*_FACETS, "line", "tetra", "vertex")})
    if unknown:
        raise usage(f"cells of the type {', '.join(unknown)} are not taken: there are line, triangle, quad, polygon and tetra")
    flat = points.shape[1] == 2 or (not points[:, 2].any() and "tetra" not in kinds)
    points = points[:, :2] if flat else points
    full = "triangle" if flat else "tetra"
    blocks = []
    for number, (kind, block) in enumerate(zip(kinds, mesh.cells)):
        corners = np.asarray(block.data)
        names = _LABELS if kind == full else _MARKERS
        blocks.append(("polygon" if kind.startswith("polygon") else kind, corners,
                       _numbers_of(mesh.cell_data, names, number, len(corners))))
    if flat and any(kind in ("quad", "polygon") for kind, _, _ in blocks):
        raise usage("in 2D quadrilaterals and polygons are not taken: give their edges as cells of the type line")
    if any(kind == full and len(corners) for kind, corners, _ in blocks):
        if any(kind == "polygon" for kind, _, _ in blocks):
            raise usage("polygons beside tetrahedra are not taken: split them into triangles")
        return _medit(points, blocks)
    lines = [(corners, numbers) for kind, corners, numbers in blocks if kind == "line"]
    segments = np.concatenate([c for c, _ in lines]) if lines else np.zeros((0, 2), dtype=np.int64)
    segment_markers = np.concatenate([m for _, m in lines]) if lines else np.zeros(0, dtype=np.int64)
    if flat:
        return Plc(points, segments, markers=segment_markers)
    faces = [(corners, numbers) for kind, corners, numbers in blocks if kind in _FACETS]
    if len({corners.shape[1] for corners, _ in faces}) == 1:
        facets: Any = np.concatenate([corners for corners, _ in faces])
    else:
        facets = [row.tolist() for corners, _ in faces for row in corners]
    markers = np.concatenate([numbers for _, numbers in faces]) if faces else None
    return Plc(points, segments, facets, markers=markers, segment_markers=segment_markers)


def _constraints(mesh: Any) -> List[Tuple[str, npt.NDArray[Any], npt.NDArray[Any]]]:
    lines = [("line", mesh.subsegments, mesh.subsegment_markers)]
    return lines if mesh.dimension == 2 else [("triangle", mesh.subfacets, mesh.subfacet_markers)] + lines


def _labels(mesh: Any) -> npt.NDArray[np.float64]:
    labels = np.asarray(mesh.regions, dtype=np.float64)
    return labels if labels.size else np.zeros(len(mesh.cells))


def to_meshio(mesh: Any) -> Any:
    """A meshio.Mesh: the cells, then in 3D the subfacets, then the subsegments; cell data `region` (0 for constraints) and `marker`
    (0 for cells), as in a .vtu. Raises ImportError without meshio."""
    meshio = _package("meshio")
    constraints = [block for block in _constraints(mesh) if len(block[1])]
    cells = [("triangle" if mesh.dimension == 2 else "tetra", np.asarray(mesh.cells))]
    cells += [(kind, np.asarray(vertices)) for kind, vertices, _ in constraints]
    regions = [_labels(mesh)] + [np.zeros(len(vertices)) for _, vertices, _ in constraints]
    markers = [np.zeros(len(mesh.cells), dtype=np.int32)] + [np.asarray(numbers) for _, _, numbers in constraints]
    point_markers = np.asarray(mesh.point_markers)
    return meshio.Mesh(np.asarray(mesh.points), cells, cell_data={"region": regions, "marker": markers},
                       point_data={"marker": point_markers} if point_markers.size else {})


def to_pyvista(mesh: Any) -> Any:
    """A pyvista.UnstructuredGrid of the cells, with cell data `region`; z = 0 in 2D. Raises ImportError without pyvista."""
    pyvista = _package("pyvista")
    cells = np.asarray(mesh.cells, dtype=np.int64)
    padded = np.column_stack([np.full(len(cells), cells.shape[1], dtype=np.int64), cells]).reshape(-1)
    points = np.asarray(mesh.points)
    if mesh.dimension == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    kinds = np.full(len(cells), _VTK_TRIANGLE if mesh.dimension == 2 else _VTK_TETRA, dtype=np.uint8)
    grid = pyvista.UnstructuredGrid(padded, kinds, np.ascontiguousarray(points))
    grid.cell_data["region"] = _labels(mesh)
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


def _faces(flat: object) -> Any:
    numbers = np.asarray(flat, dtype=np.int64).reshape(-1)
    if len(numbers) and len(numbers) % 4 == 0 and (numbers[::4] == 3).all():
        return numbers.reshape(-1, 4)[:, 1:]
    return [face.tolist() for face in _unpadded("faces", numbers)]


def from_pyvista(mesh: Any) -> Any:
    """See Plc.from_pyvista. Faces become facets, with the cell data `marker` if it is there, and lines segments; of a PolyData in
    the plane z = 0 that has lines alone, an input in 2D is made."""
    from ._plc import Plc
    if not hasattr(mesh, "faces"):
        raise usage(f"a pyvista.PolyData is taken, not {type(mesh).__name__}: of a grid, take extract_surface()")
    points = np.asarray(mesh.points)
    facets = _faces(mesh.faces)
    lines = _unpadded("lines", getattr(mesh, "lines", ()))
    pieces = [np.stack([line[:-1], line[1:]], axis=1) for line in lines if len(line) > 1]
    segments = np.concatenate(pieces) if pieces else np.zeros((0, 2), dtype=np.int64)
    if not len(facets):
        if points[:, 2].any():
            raise usage("there are no faces: a closed surface is needed, or lines in the plane z = 0")
        return Plc(points[:, :2], segments)
    markers = None
    if "marker" in mesh.cell_data:  # cells of a PolyData are its vertices, its lines, then its faces
        markers = _numbers_of({"marker": [np.asarray(mesh.cell_data["marker"])[-len(facets):]]}, ("marker",), 0, len(facets))
    return Plc(points, segments, facets, markers=markers)
