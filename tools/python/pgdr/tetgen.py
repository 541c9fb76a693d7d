# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""In the place of PyVista's package tetgen: `from pgdr import tetgen` instead of `import tetgen`, and the lines after it stay.

>>> from pgdr import tetgen
>>> points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
>>> tet = tetgen.TetGen(points, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
>>> nodes, elems, attributes, triface_markers = tet.tetrahedralize(order=1, minratio=1.5, quiet=True)
>>> nodes.shape[1], elems.shape[1]
(3, 4)
"""
from __future__ import annotations

import os
from typing import Any, List, Optional, Tuple

import numpy as np
import numpy.typing as npt

from . import _arguments
from ._doors import through
from ._errors import usage
from ._plc import Plc
from ._tetgen import Tetrahedralization, tetrahedralize

__all__ = ["TetGen"]


class TetGen:
    """A closed surface, and once `tetrahedralize` was called, its mesh. One thread at a time.

    TetGen(surface), with a pyvista.PolyData, a file or a pgdr.Plc, or TetGen(points, faces[, markers]): (n, 3) and (m, 3) arrays, or
    lists of polygons; (m,) markers of the faces.
    """

    def __init__(self, surface: Any, faces: Any = None, face_markers: Any = None) -> None:
        if faces is not None:
            surface = Plc(surface, facets=faces, markers=face_markers)
        elif face_markers is not None:
            raise usage("face_markers come with points and faces; of a PolyData, cell data \"marker\" are the markers")
        elif isinstance(surface, (str, os.PathLike)):
            surface = Plc.read(surface)
        elif hasattr(surface, "faces"):
            surface = Plc.from_pyvista(surface)
        if not isinstance(surface, Plc) or surface.dimension != 3:
            raise usage("TetGen takes a surface in 3D: a pyvista.PolyData, a file, a pgdr.Plc, or points and faces")
        self._plc = surface
        self._holes: List[Tuple[float, ...]] = []
        self._regions: List[Tuple[float, ...]] = []
        self._made: Optional[Tetrahedralization] = None

    def add_region(self, id: float, point_in_region: npt.ArrayLike, max_vol: float = 0.0) -> None:
        """A label for the volume about a point; no cell in it is larger than max_vol, 0: any size."""
        at = _arguments.coordinates("point_in_region", [point_in_region], 3)[0]
        self._regions.append((*at.tolist(), _arguments.number("id", id), max(_arguments.number("max_vol", max_vol), 0.0)))

    def add_hole(self, point: npt.ArrayLike) -> None:
        """The volume about a point stays empty."""
        self._holes.append(tuple(_arguments.coordinates("point", [point], 3)[0].tolist()))

    def make_manifold(self, verbose: bool = False) -> None:
        """Refused: surfaces are not repaired by guesses. What is wrong with one, `pgdr.diagnose` says; `pgdr.resolve_crossings` and
        `pgdr.close_planar_openings` mend what crosses, and what is open in a plane."""
        raise usage("make_manifold has no equivalent: pgdr.diagnose says what is wrong with the surface; pgdr.resolve_crossings and "
                    "pgdr.close_planar_openings mend some of it. Surfaces that are not manifold are taken as they are")

    def tetrahedralize(self, *, switches: str = "", bgmesh: Any = None, metric: bool = False, fixedvolume: bool = False,
                       maxvolume: float = -1.0, threads: int = 0, **keywords: Any
                       ) -> Tuple[npt.NDArray[np.float64], npt.NDArray[np.int32], npt.NDArray[np.float64], npt.NDArray[np.int32]]:
        """Meshes it. Returns nodes (n, 3), elems (m, 4), attributes (m,), the labels of `add_region`, 0 without; and
        triface_markers (k,), those of the faces of `trifaces`.

        Parameters are those of `pgdr.tetrahedralize`; maxvolume below 0, as it is by default, is none. `metric` and `fixedvolume` say
        what bgmesh and maxvolume say anyway. refine=True (r) and coarsen=True (R) are of what was made before. Keywords that change nothing in the mesh are taken, those that would and have no
        equivalent are refused by name. Raises as `pgdr.tetrahedralize`.
        """
        volume = _arguments.number("maxvolume", maxvolume)
        if _arguments.flag("metric", metric) and bgmesh is None:
            raise usage("metric=True needs bgmesh, which says the sizes")
        if _arguments.flag("fixedvolume", fixedvolume) and volume <= 0 and not switches:
            raise usage("fixedvolume=True needs maxvolume")
        if keywords.get("mindihedral", 0) == 0:
            keywords.pop("mindihedral", None)
        if volume > 0:
            keywords["maxvolume"] = volume
        again = bool(keywords.get("refine") or keywords.get("coarsen") or set(switches) & set("rR"))
        given: Any = self.result.mesh if again else self._plc.with_seeds(holes=self._holes or None, regions=self._regions)
        self._made = tetrahedralize(given, switches=switches or None, bgmesh=bgmesh, threads=threads, **keywords)
        return self.node, self.elem, self.attributes, self.triface_markers

    @property
    def result(self) -> Tetrahedralization:
        """What was made; its `mesh` is the pgdr.Mesh."""
        if self._made is None:
            raise usage("there is no mesh yet: call tetrahedralize() first")
        return self._made

    @property
    def node(self) -> npt.NDArray[np.float64]:
        """(n, 3) points of the mesh."""
        return self.result.nodes

    @property
    def elem(self) -> npt.NDArray[np.int32]:
        """(m, 4) its tetrahedra."""
        return self.result.elems

    @property
    def attributes(self) -> npt.NDArray[np.float64]:
        """(m,) labels of the tetrahedra."""
        return self.result.attributes

    @property
    def trifaces(self) -> npt.NDArray[np.int32]:
        """(k, 3) triangles of the surface and of the facets inside."""
        return self.result.faces

    @property
    def triface_markers(self) -> npt.NDArray[np.int32]:
        """(k,) their markers."""
        return self.result.face_markers

    @property
    def grid(self) -> Any:
        """The mesh as a pyvista.UnstructuredGrid of its tetrahedra, with cell data "region"."""
        return self.result.mesh.to_pyvista(constraints=False)

    @property
    def v(self) -> npt.NDArray[np.float64]:
        """(n, 3) points of the surface."""
        return self._plc.points

    @property
    def f(self) -> Any:
        """(m, 3) its faces, or polygons."""
        return self._plc.facets

    @property
    def mesh(self) -> Any:
        """The surface as a pyvista.PolyData."""
        return through("surface_to_pyvista")(self._plc)

    def write(self, filename: _arguments.Path) -> None:
        """Writes the mesh, as `pgdr.Mesh.write`: .vtu, .vtk, .msh, ... by the extension."""
        self.result.mesh.write(filename)

    def plot(self, **keywords: Any) -> Any:
        """Shows the mesh by PyVista."""
        return self.grid.plot(**keywords)

    def __repr__(self) -> str:
        state = "not meshed" if self._made is None else f"{len(self.node)} nodes, {len(self.elem)} elems"
        return f"<pgdr.tetgen.TetGen of {self._plc!r}: {state}>"
