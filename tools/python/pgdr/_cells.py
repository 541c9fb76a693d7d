# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs from points and blocks of cells, as meshio and PyVista have them: what is a wall, what is volume, and what that says."""
from __future__ import annotations

import itertools
import os
import tempfile
from typing import Any, Dict, List, NamedTuple, Sequence, Set, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _arguments
from ._errors import InputError, UsageError, usage
from ._plc import Plc
from ._run import mesh

Rows = Union[npt.NDArray[Any], List[npt.NDArray[Any]]]
LINES, FACES = ("line",), ("triangle", "quad", "polygon")
VOLUMES = ("tetra", "hexahedron", "wedge", "pyramid")
_WIDTHS = {"line": 2, "triangle": 3, "quad": 4, "tetra": 4, "hexahedron": 8, "wedge": 6, "pyramid": 5}
# Sections of a .mesh.
_MEDIT = {"line": "Edges", "triangle": "Triangles", "quad": "Quadrilaterals", "tetra": "Tetrahedra", "hexahedron": "Hexahedra",
          "wedge": "Prisms", "pyramid": "Pyramids"}


class Block(NamedTuple):
    """Cells of one kind."""

    kind: str  #: one of LINES, FACES, VOLUMES
    corners: Rows  #: (n, k) indices, or, of polygons of several sizes, n arrays of them
    numbers: npt.NDArray[np.int64]  #: (n,) markers, or labels where the cells fill what is to be meshed


def block_of(kind: str, rows: Union[Rows, Sequence[Any]], numbers: npt.NDArray[np.int64]) -> Block:
    """A block of rows of indices, which are looked at."""
    name = f"cells of the type {kind}"
    if kind == "polygon" and isinstance(rows, np.ndarray) and rows.ndim == 2 and rows.shape[1] > 2 and len(rows):
        return Block(kind, _arguments.indices(name, rows, None), numbers)
    if kind == "polygon":
        sizes = np.array([np.size(row) for row in rows], dtype=np.int64)
        if (sizes < 3).any():
            raise usage(f"face {int(np.argmax(sizes < 3))} has less than three corners")
        flat = _arguments.indices(name, [np.concatenate(rows)] if len(rows) else np.zeros((1, 0), dtype=np.int64), None).reshape(-1)
        if (sizes == sizes[:1]).all():
            return Block(kind, flat.reshape(len(rows), -1) if len(rows) else np.zeros((0, 3), dtype=np.int64), numbers)
        return Block(kind, np.split(flat, np.cumsum(sizes)[:-1]), numbers)
    try:
        return Block(kind, _arguments.indices(name, rows if isinstance(rows, np.ndarray) else np.array(rows), _WIDTHS[kind]), numbers)
    except ValueError as error:
        if isinstance(error, UsageError):
            raise
        raise usage(f"{name} must have {_WIDTHS[kind]} corners each") from None


def is_flat(points: npt.NDArray[Any], kinds: Sequence[str]) -> bool:
    """Is it 2D? Two coordinates, or z = 0 everywhere and nothing that has a volume."""
    return points.shape[1] == 2 or (not points[:, 2].any() and not any(kind in VOLUMES for kind in kinds))


def input_of(points: npt.NDArray[Any], blocks: Sequence[Block]) -> Plc:
    """The input that cells make: of lines and faces alone what they are; with cells that fill the domain (tetra, in 2D faces) also
    their common boundary, and their labels and the voids between them as seeds, as with a file of them."""
    Plc(points)  # says which coordinate is not finite
    for block in blocks:
        _require_indices(block, len(points))
    flat = is_flat(points, [block.kind for block in blocks])
    if flat:
        points = points[:, :2]
        blocks = [triangles for block in blocks for triangles in _triangulated(points, block)]
    kinds = {block.kind for block in blocks if len(block.corners)}
    if flat and "triangle" in kinds:
        return _by_medit(points, blocks)
    if kinds.isdisjoint(VOLUMES):
        return _of_walls(points, blocks, flat)
    others = sorted(kinds & set(VOLUMES) - {"tetra"})
    if others and kinds.isdisjoint(FACES):
        raise usage(f"cells of the type {', '.join(others)} are not meshed again by themselves: give their surface, as triangles or "
                    "quadrilaterals (extract_surface() of PyVista)")
    blocks, polygons = _without_polygons([part for block in blocks for part in _by_size(block)])
    return _by_medit(points, blocks, polygons)


def _require_indices(block: Block, count: int) -> None:
    for cell, corners in enumerate(block.corners) if isinstance(block.corners, list) else ((None, block.corners),):
        wrong = np.argwhere((corners < 0) | (corners >= count)) if corners.size else np.zeros((0, 1))
        if len(wrong):
            row, index = (cell if cell is not None else int(wrong[0][0])), int(corners[tuple(wrong[0])])
            raise InputError(f"{block.kind} {row} has index {index}, there are {count} points, counted from 0", code="index_out_of_range",
                             ids=[row, index])


def _of_walls(points: npt.NDArray[Any], blocks: Sequence[Block], flat: bool) -> Plc:
    """Lines as segments, faces as facets, in their order."""
    lines = [block for block in blocks if block.kind in LINES]
    segments = np.concatenate([np.zeros((0, 2), dtype=np.int64), *(np.asarray(block.corners) for block in lines)])
    segment_markers = np.concatenate([np.zeros(0, dtype=np.int64), *(block.numbers for block in lines)])
    if flat:
        return Plc(points, segments, markers=segment_markers)
    faces = [block for block in blocks if block.kind in FACES]
    if not sum(len(block.corners) for block in faces):
        raise usage("there are no faces: a closed surface is needed, or, for a mesh in 2D, the plane z = 0")
    uniform = [block.corners for block in faces if isinstance(block.corners, np.ndarray) and len(block.corners)]
    if len(uniform) == len(faces) and len({corners.shape[1] for corners in uniform}) == 1:
        facets: Any = np.concatenate(uniform)
    else:
        facets = [row.tolist() for block in faces for row in block.corners]
    return Plc(points, segments, facets, markers=np.concatenate([block.numbers for block in faces]), segment_markers=segment_markers)


def _by_size(block: Block) -> List[Block]:
    """Polygons of three corners as triangles, of four as quadrilaterals, and the others."""
    if block.kind != "polygon":
        return [block]
    if isinstance(block.corners, np.ndarray) and block.corners.shape[1] <= 4:
        return [Block("triangle" if block.corners.shape[1] == 3 else "quad", block.corners, block.numbers)]
    sizes = np.array([len(row) for row in block.corners], dtype=np.int64)
    parts = []
    for kind, chosen in (("triangle", sizes == 3), ("quad", sizes == 4), ("polygon", sizes > 4)):
        rows = [np.asarray(block.corners[i]) for i in np.flatnonzero(chosen)]
        if rows:
            parts.append(Block(kind, rows if kind == "polygon" else np.stack(rows), block.numbers[chosen]))
    return parts


def _triangulated(points: npt.NDArray[Any], block: Block) -> List[Block]:
    """2D: faces as triangles of the same labels. A quadrilateral is cut where both halves lie on the same side, a polygon by its
    constrained Delaunay triangulation."""
    made = []
    for part in _by_size(block):
        if part.kind == "quad":
            a, b, c, d = (np.asarray(part.corners)[:, i] for i in range(4))
            halves = np.sign(_twice_areas(points, a, b, c)) * np.sign(_twice_areas(points, a, c, d))
            first = np.where((halves > 0)[:, None], np.stack([a, b, c], axis=1), np.stack([a, b, d], axis=1))
            second = np.where((halves > 0)[:, None], np.stack([a, c, d], axis=1), np.stack([b, c, d], axis=1))
            part = Block("triangle", np.concatenate([first, second]), np.tile(part.numbers, 2))
        elif part.kind == "polygon":
            pieces = [_triangles_of(points, row) for row in part.corners]
            part = Block("triangle", np.concatenate(pieces), np.repeat(part.numbers, [len(piece) for piece in pieces]))
        made.append(part)
    return made


def _twice_areas(points: npt.NDArray[Any], *corners: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
    a, b, c = (points[i].astype(np.float64) for i in corners)
    made: npt.NDArray[np.float64] = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    return made


def _triangles_of(points: npt.NDArray[Any], ring: npt.NDArray[Any]) -> npt.NDArray[Any]:
    made = mesh(Plc.from_polygons(points[ring]), refine=False, threads=1)
    corner_of = np.empty(len(made.points), dtype=np.int64)
    corner_of[made.point_of_input] = np.arange(len(made.point_of_input))
    triangles: npt.NDArray[Any] = ring[corner_of[made.cells]]
    return triangles


def _without_polygons(blocks: Sequence[Block]) -> Tuple[List[Block], List[Block]]:
    """3D, with tetrahedra: a polygon whose corners have faces of tetrahedra between them that fill it is those faces, with its
    marker; one that has none is kept as it is, apart."""
    polygons = [(row, number) for block in blocks if block.kind == "polygon" for row, number in zip(block.corners, block.numbers)]
    if not polygons:
        return list(blocks), []
    faces = _faces_between(blocks, np.unique(np.concatenate([row for row, _ in polygons])))
    triangles: List[Any] = []
    markers: List[int] = []
    apart: List[Tuple[npt.NDArray[Any], int]] = []
    for i, (row, number) in enumerate(polygons):
        found = [face for face in itertools.combinations(sorted(row.tolist()), 3) if face in faces]
        if found and len(found) != len(row) - 2:
            raise usage(f"polygon {i} and the tetrahedra do not fit: it has {len(row)} corners, with {len(found)} faces of tetrahedra "
                        f"between them instead of {len(row) - 2}. Give those faces as triangles")
        triangles += found
        markers += [int(number)] * len(found)
        if not found:
            apart.append((row, int(number)))
    kept = [block for block in blocks if block.kind != "polygon"]
    if triangles:
        kept.append(Block("triangle", np.array(triangles, dtype=np.int64), np.array(markers, dtype=np.int64)))
    if not apart:
        return kept, []
    return kept, [Block("polygon", [row for row, _ in apart], np.array([number for _, number in apart], dtype=np.int64))]


def _faces_between(blocks: Sequence[Block], corners: npt.NDArray[Any]) -> Set[Tuple[int, ...]]:
    """Faces of tetrahedra that have these corners alone, sorted."""
    found: Set[Tuple[int, ...]] = set()
    for block in blocks:
        if block.kind == "tetra":
            cells = np.sort(np.asarray(block.corners), axis=1)
            for i in range(4):
                face = np.delete(cells, i, axis=1)
                found.update(map(tuple, face[np.isin(face, corners).all(axis=1)].tolist()))
    return found


def _by_medit(points: npt.NDArray[Any], blocks: Sequence[Block], polygons: Sequence[Block] = ()) -> Plc:
    """The input that the reader of Medit files makes of cells: their common faces, seeds of labels and of voids. `polygons` become
    further facets."""
    with tempfile.TemporaryDirectory() as folder:
        name = os.path.join(folder, "cells.mesh")
        with open(name, "w", encoding="ascii") as file:
            file.write(f"MeshVersionFormatted 2\nDimension {points.shape[1]}\nVertices\n{len(points)}\n")
            np.savetxt(file, np.column_stack([points, np.arange(1, len(points) + 1)]), fmt=["%.17g"] * points.shape[1] + ["%d"])
            for kind, section in _MEDIT.items():
                rows = [np.column_stack([np.asarray(block.corners) + 1, block.numbers]) for block in blocks
                        if block.kind == kind and len(block.corners)]
                if rows:
                    file.write(f"{section}\n{sum(map(len, rows))}\n")
                    np.savetxt(file, np.concatenate(rows), fmt="%d")
            if polygons:
                corners = np.unique(np.concatenate([row for block in polygons for row in block.corners])) + 1
                file.write(f"RequiredVertices\n{len(corners)}\n")
                np.savetxt(file, corners, fmt="%d")
            file.write("End\n")
        try:
            read = Plc.read(name)
        except InputError as error:  # without the name of a file that is gone
            raise InputError(error.message, code=error.code) from None
    arguments: Dict[str, Any] = {"markers": read.markers, "holes": read.holes, "regions": read.regions}
    if read.dimension == 3:
        arguments.update(facets=read.facets, segment_markers=read.segment_markers)
    if polygons:
        row_of = np.zeros(len(points) + 1, dtype=np.int64)
        row_of[read.point_markers] = np.arange(len(read.points))  # markers were the numbers that points had
        further = [row_of[row + 1].tolist() for block in polygons for row in block.corners]
        arguments["facets"] = [list(row) for row in read.facets] + further
        arguments["markers"] = np.concatenate([read.markers, *(block.numbers for block in polygons)])
    return Plc(read.points.astype(_arguments.points("points", points).dtype), read.segments, **arguments)
