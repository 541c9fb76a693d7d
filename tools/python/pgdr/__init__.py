# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Delaunay meshes with guaranteed quality, in 2D and 3D: arrays in, arrays out.

>>> import pgdr
>>> square = pgdr.Plc([[0, 0], [1, 0], [1, 1], [0, 1]], segments=[[0, 1], [1, 2], [2, 3], [3, 0]])
>>> r = pgdr.mesh(square, min_angle=25, size=0.01)
>>> r.points.shape[1], r.cells.shape[1], bool(r.check(square))
(2, 3, True)
"""
from . import _convert, _page, _polygons, _show, tetgen, triangle  # noqa: F401: methods find their functions (_doors.py)
from ._bodies import Bodies, BodyRegion, with_bodies
from ._check import Finding, check, diagnose, info
from ._errors import (CancelledError, DiagnosedError, Diagnostic, Error, FileError, InputError, ResourceError, UsageError)
from ._estimate import Estimate, Gap, Proposal, SharpAngle, estimate
from ._fields import Field, limit_growth, sizes_along, sizes_at_points, sizes_on_mesh, sizes_on_raster, smallest
from ._join import Joined, JoinedLabel, Shared, join
from ._mesh import Mesh, Reason
from ._pgdr import version as __version__
from ._page import Page
from ._periodic import Periodic
from ._plc import Plc, close_planar_openings, resolve_crossings, with_convex_hull
from ._remesh import FileFields, Transfer, read_fields, refine, remesh, sizes_from_error, write_fields
from ._report import CheckFinding, CheckReport
from ._run import Elements, Progress, StopSource, mesh
from ._surface import ReplacedSurface, replace_surface
from ._tetgen import Tetrahedralization, tetrahedralize
from ._triangle import triangulate
from ._voronoi import Voronoi

__all__ = ["Bodies", "BodyRegion", "CancelledError", "CheckFinding", "CheckReport", "DiagnosedError", "Diagnostic",
           "Elements", "Error", "Estimate", "Field", "FileError", "FileFields", "Finding", "Gap", "InputError",
           "Joined", "JoinedLabel", "Mesh", "Page", "Periodic", "Plc", "Progress", "Proposal", "Reason",
           "ReplacedSurface", "ResourceError", "Shared", "SharpAngle", "StopSource", "Tetrahedralization",
           "Transfer", "UsageError", "Voronoi", "__version__", "check", "close_planar_openings", "diagnose",
           "estimate", "info", "join", "limit_growth", "mesh", "read_fields", "refine", "remesh", "replace_surface",
           "resolve_crossings", "sizes_along", "sizes_at_points", "sizes_from_error", "sizes_on_mesh",
           "sizes_on_raster", "smallest", "tetgen", "tetrahedralize", "triangle", "triangulate", "with_bodies",
           "with_convex_hull", "write_fields"]
