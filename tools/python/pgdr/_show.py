# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What a notebook shows of a mesh: an SVG picture and a table. Of a large mesh the boundary alone is drawn, or a part of it, and the
caption says so."""
from __future__ import annotations

import html
from typing import Any, List, Sequence, Tuple

import numpy as np
import numpy.typing as npt

from ._doors import door
from ._errors import Error
from ._mesh import Mesh

MOST_CELLS = 4000  # 2D: above, the boundary alone is drawn
MOST_PIECES = 6000  # faces of a surface, or edges of a boundary: above, evenly chosen ones
_SIDE = 360.0  # of the picture's longer side, in pixels
_EYE = np.array([1.0, -1.5, 0.8])  # from the mesh towards the eye, as `pgdr view`
_COLORS = ((120, 160, 205), (222, 165, 110), (140, 185, 130), (200, 135, 150), (165, 145, 200), (205, 195, 120), (120, 190, 190),
           (175, 155, 140))


def _spread(count: int, most: int) -> npt.NDArray[np.int64]:
    """At most `most` of the numbers below `count`, evenly."""
    return np.arange(count) if count <= most else np.linspace(0, count - 1, most).astype(np.int64)


def _on_paper(flat: npt.NDArray[np.float64]) -> Tuple[npt.NDArray[np.float64], float, float]:
    """(n, 2) places in pixels, y downwards; width and height of the picture."""
    low = flat.min(axis=0)
    extent = np.maximum(flat.max(axis=0) - low, 1e-300)
    scale = _SIDE / extent.max()
    width, height = np.maximum(extent * scale, 1.0)
    places = (flat - low) * scale
    return np.stack([places[:, 0] + 4, height - places[:, 1] + 4], axis=1), width + 8, height + 8


def _polygons(places: npt.NDArray[np.float64], triangles: npt.NDArray[Any], fills: Sequence[str]) -> List[str]:
    corners = np.round(places[triangles], 1).tolist()
    return [f'<polygon points="{a[0]},{a[1]} {b[0]},{b[1]} {c[0]},{c[1]}" fill="{fill}"/>'
            for (a, b, c), fill in zip(corners, fills)]


def _lines(places: npt.NDArray[np.float64], edges: npt.NDArray[Any]) -> str:
    """One path of all these edges."""
    ends = np.round(places[edges], 1).tolist()
    path = "".join(f"M{a[0]} {a[1]}L{b[0]} {b[1]}" for a, b in ends)
    return f'<path d="{path}" fill="none" stroke="#223" stroke-width="1.2"/>'


def _rgb(color: npt.NDArray[np.float64]) -> str:
    return "#{:02x}{:02x}{:02x}".format(*(int(c) for c in np.clip(color, 0, 255)))


def _planar(mesh: Mesh) -> Tuple[str, float, float, str]:
    places, width, height = _on_paper(np.asarray(mesh.points, dtype=np.float64))
    cells, labels = np.asarray(mesh.cells), np.asarray(mesh.regions)
    parts, caption = [], ""
    if len(cells) <= MOST_CELLS:
        number = np.unique(labels, return_inverse=True)[1]
        fills = [_rgb(np.array(_COLORS[i % len(_COLORS)], dtype=float)) for i in number]
        parts.append('<g stroke="#fff" stroke-width="0.4">' + "".join(_polygons(places, cells, fills)) + "</g>")
    else:
        caption = f"the boundary alone is drawn: there are more than {MOST_CELLS:,} triangles"
    edges = np.asarray(mesh.subsegments)
    chosen = _spread(len(edges), MOST_PIECES)
    if len(chosen) < len(edges):
        caption += f"; {len(chosen):,} of its {len(edges):,} edges"
    if len(edges):
        parts.append(_lines(places, edges[chosen]))
    return "".join(parts), width, height, caption


def _surface(mesh: Mesh) -> npt.NDArray[np.int64]:
    """The faces that one cell has, seen counterclockwise from outside."""
    cells = np.asarray(mesh.cells, dtype=np.int64)
    beyond = np.asarray(mesh.neighbors(), dtype=np.int64)
    cell, corner = np.nonzero(beyond < 0)
    opposite = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
    faces = np.take_along_axis(cells[cell], opposite[corner], axis=1)
    points = np.asarray(mesh.points)
    a, b, c = points[faces].transpose(1, 0, 2)
    inwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), points[cells[cell, corner]] - a) > 0
    faces[inwards] = faces[inwards][:, ::-1]
    return faces


def _solid(mesh: Mesh) -> Tuple[str, float, float, str]:
    eye = _EYE / np.linalg.norm(_EYE)
    right = np.cross([0.0, 0.0, 1.0], eye)
    right /= np.linalg.norm(right)
    up = np.cross(eye, right)
    points = np.asarray(mesh.points, dtype=np.float64)
    try:
        faces = _surface(mesh)
    except Error:  # cells that are no mesh
        faces = np.asarray(mesh.subfacets, dtype=np.int64)
    a, b, c = points[faces].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1)
    towards = np.einsum("ij,j->i", normals, eye) / np.where(lengths > 0, lengths, 1)
    seen = np.flatnonzero(towards > 0)
    seen = seen[np.argsort((points[faces[seen]] @ eye).mean(axis=1), kind="stable")]  # the farthest first
    chosen = seen[_spread(len(seen), MOST_PIECES)]
    caption = "" if len(chosen) == len(seen) else f"{len(chosen):,} of {len(seen):,} faces are drawn"
    places, width, height = _on_paper(np.stack([points @ right, points @ up], axis=1))
    base = np.array(_COLORS[0], dtype=float)
    fills = [_rgb(base * (0.45 + 0.65 * shade)) for shade in towards[chosen]]
    parts = '<g stroke="#345" stroke-width="0.3" stroke-linejoin="round">' + "".join(_polygons(places, faces[chosen], fills)) + "</g>"
    return parts, width, height, caption


def _rows(mesh: Mesh) -> List[Tuple[str, str]]:
    labels = np.unique(np.asarray(mesh.regions))
    rows = [("dimension", str(mesh.dimension)), ("points", f"{len(mesh.points):,}"), ("cells", f"{len(mesh.cells):,}")]
    if mesh.dimension == 3:
        rows.append(("subfacets", f"{len(mesh.subfacets):,}"))
    rows.append(("subsegments", f"{len(mesh.subsegments):,}"))
    if labels.any():
        rows.append(("regions", ", ".join(f"{label:g}" for label in labels[:8]) + (", ..." if labels.size > 8 else "")))
    for name in ("poor_left", "stop"):
        value = getattr(mesh, name, None)
        if value is not None:
            rows.append((name, str(value)))
    return rows


@door
def repr_html(mesh: Mesh) -> str:
    """HTML of a picture, coloured by region (2D) or shaded (3D), and of a table. At most some 6,000 polygons, whatever the mesh."""
    picture = ""
    if len(mesh.cells):
        body, width, height, caption = _planar(mesh) if mesh.dimension == 2 else _solid(mesh)
        picture = (f'<svg xmlns="http://www.w3.org/2000/svg" role="img" width="{width:.0f}" height="{height:.0f}" '
                   f'viewBox="0 0 {width:.1f} {height:.1f}">{body}</svg>')
        if caption:
            picture += f"<div><small>{html.escape(caption)}</small></div>"
    table = "".join(f"<tr><th>{html.escape(name)}</th><td>{html.escape(value)}</td></tr>" for name, value in _rows(mesh))
    return f'<div style="display:flex;gap:1em;flex-wrap:wrap"><div>{picture}</div><table>{table}</table></div>'
