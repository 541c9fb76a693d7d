# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""In the place of the package triangle: `from pgdr import triangle` instead of `import triangle`, and the lines after it stay.

>>> from pgdr import triangle
>>> made = triangle.triangulate(dict(vertices=[[0, 0], [1, 0], [1, 1], [0, 1]]), "qa0.1")
>>> triangle.delaunay([[0, 0], [1, 0], [0, 1]]).tolist()
[[0, 1, 2]]
"""
from __future__ import annotations

from typing import Any, Mapping, Tuple

import numpy as np
import numpy.typing as npt

from . import _arguments
from ._triangle import triangulate

__all__ = ["compare", "convex_hull", "delaunay", "plot", "triangulate", "voronoi"]

_Ints = npt.NDArray[np.int32]
_Reals = npt.NDArray[np.float64]


def delaunay(pts: npt.ArrayLike) -> _Ints:
    """(m, 3) triangles of the Delaunay triangulation of (n, 2) points, counterclockwise. Raises as `triangulate`."""
    return triangulate({"vertices": _arguments.points("pts", pts, 2)})["triangles"]


def convex_hull(pts: npt.ArrayLike) -> _Ints:
    """(k, 2) edges of the convex hull of (n, 2) points; points on an edge split it. Raises as `triangulate`."""
    return triangulate({"vertices": _arguments.points("pts", pts, 2)}, "c")["segments"]


def voronoi(pts: npt.ArrayLike) -> Tuple[_Reals, _Ints, _Ints, _Reals]:
    """The Voronoi diagram of (n, 2) points: (m, 2) its points, the circumcentres of the triangles of `delaunay`; (e, 2) edges between
    these; (k,) points from which rays go, and (k, 2) their directions. Of points on one circle several Voronoi points are one and the
    same place. `Mesh.voronoi` has the cells of a mesh, clipped to its domain."""
    at = np.asarray(_arguments.points("pts", pts, 2), dtype=np.float64)
    made = triangulate({"vertices": at}, "n")
    triangles, beyond = made["triangles"], made["neighbors"]
    centers = circumcenters(at[triangles])
    cell, corner = np.nonzero(beyond >= 0)
    other = beyond[cell, corner]
    edges = np.stack([cell, other], axis=1)[cell < other].astype(np.int32)
    cell, corner = np.nonzero(beyond < 0)
    along = at[triangles[cell, (corner + 2) % 3]] - at[triangles[cell, (corner + 1) % 3]]
    return centers, edges, cell.astype(np.int32), np.stack([along[:, 1], -along[:, 0]], axis=1)


def circumcenters(corners: _Reals) -> _Reals:
    """(m, 2) circumcentres of (m, 3, 2) triangles."""
    origin = corners[:, 0]
    b, c = corners[:, 1] - origin, corners[:, 2] - origin
    twice = 2 * (b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0])
    squares = np.stack([(b * b).sum(axis=1), (c * c).sum(axis=1)], axis=1)
    x = (c[:, 1] * squares[:, 0] - b[:, 1] * squares[:, 1]) / twice
    y = (b[:, 0] * squares[:, 1] - c[:, 0] * squares[:, 0]) / twice
    made: _Reals = origin + np.stack([x, y], axis=1)
    return made


def plot(ax: Any, **tri: Any) -> None:
    """Draws into axes of matplotlib what of vertices, triangles, segments, holes, edges with ray_origins and ray_directions there is,
    as `plot(ax, **triangulate(...))`."""
    at = np.asarray(tri["vertices"], dtype=float)
    ax.axes.set_aspect("equal")
    if "triangles" in tri:
        ax.triplot(at[:, 0], at[:, 1], np.asarray(tri["triangles"])[:, :3], "k-", lw=0.8, zorder=1)
    else:
        ax.scatter(at[:, 0], at[:, 1], s=8, color="black", zorder=2)
    for key, color, width in (("edges", "gray", 0.8), ("segments", "red", 1.5)):
        if key == "edges" and "triangles" in tri and "ray_origins" not in tri:
            continue
        rows = np.asarray(tri.get(key, ()), dtype=int).reshape(-1, 2)
        for a, b in at[rows]:
            ax.plot([a[0], b[0]], [a[1], b[1]], color=color, lw=width, zorder=3)
    if "holes" in tri:
        holes = np.asarray(tri["holes"], dtype=float).reshape(-1, 2)
        ax.scatter(holes[:, 0], holes[:, 1], marker="x", color="blue", zorder=4)
    reach = float(np.ptp(at, axis=0).max()) if len(at) else 1.0
    for origin, direction in zip(tri.get("ray_origins", ()), tri.get("ray_directions", ())):
        end = at[origin] + reach * np.asarray(direction) / np.linalg.norm(direction)
        ax.plot([at[origin, 0], end[0]], [at[origin, 1], end[1]], color="gray", ls="--", lw=0.8, zorder=3)
    ax.get_xaxis().set_visible(False)
    ax.get_yaxis().set_visible(False)


def compare(plt: Any, A: Mapping[str, Any], B: Mapping[str, Any], figsize: Tuple[float, float] = (6, 3)) -> Any:
    """Draws two results beside each other, by matplotlib.pyplot. Returns the two axes."""
    plt.figure(figsize=figsize)
    left = plt.subplot(121)
    plot(left, **A)
    right = plt.subplot(122, sharex=left, sharey=left)
    plot(right, **B)
    plt.tight_layout()
    return left, right
