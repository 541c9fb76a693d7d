# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Finished meshes."""
from __future__ import annotations

import warnings
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Type, Union

import numpy as np
import numpy.typing as npt

from . import _arguments, _pgdr
from ._doors import through
from ._ending import WORK
from ._errors import Diagnostic, usage
from ._periodic import Periodic, paired
from ._plc import Plc
from ._report import CheckReport

_CORES: Dict[int, Type[_pgdr._Mesh]] = {2: _pgdr.Mesh2, 3: _pgdr.Mesh3}
_Entity = Tuple[str, Union[int, Tuple[Tuple[float, ...], ...]]]


class Reason(NamedTuple):
    """Why a cell is over a bound: which entities of the input are to blame (docs/small-angles.md)."""

    cell: int  #: its row in `cells`
    code: str  #: a stable word such as "small_angle"
    #: of each its kind and what it is in the input: ("facet", its row in the input, or, with `surface_tolerance`, a place on it),
    #: ("segment", its two ends, where the mesh has them)
    entities: Sequence[_Entity]
    angle: float  #: in degrees, between these; 0: none


class Mesh:
    """A mesh: arrays, and what is known of how it came to be. Never changed; any number of threads may read it.

    The arrays are read-only views of the memory of C++, which they keep alive. Lengths are in the units of the input; rows count
    from 0. The same input makes the same bytes, whatever the number of threads.
    """

    def __init__(self) -> None:
        raise TypeError("meshes are made by pgdr.mesh, Mesh.read and Mesh.from_arrays")

    @classmethod
    def _of(cls, core: _pgdr._Mesh, facts: Optional[Dict[str, Any]] = None, bounds: Optional[Dict[str, Any]] = None) -> Mesh:
        made = cls.__new__(cls)
        made._core = core
        made._facts = facts or {}
        made._bounds = bounds or {}
        return made

    _core: _pgdr._Mesh
    _facts: Dict[str, Any]
    _bounds: Dict[str, Any]

    @classmethod
    def read(cls, path: _arguments.Path) -> Mesh:
        """The mesh in a .vtu, .pvtu, .msh, .mesh or .ele file. Cells of second order are read by their corners, which a Python warning
        says. Raises FileError, InputError with file and line."""
        file = _arguments.path(path)
        core, left_out = (_pgdr.read_mesh2 if _pgdr.file_dimension(file) == 2 else _pgdr.read_mesh3)(file)
        for message in left_out:
            warnings.warn(message, stacklevel=2)
        return cls._of(core)

    @classmethod
    def from_arrays(cls, points: npt.ArrayLike, cells: npt.ArrayLike, *, regions: Optional[npt.ArrayLike] = None,
                    point_markers: Optional[npt.ArrayLike] = None, point_attributes: Optional[npt.ArrayLike] = None,
                    subsegments: Optional[npt.ArrayLike] = None, subsegment_markers: Optional[npt.ArrayLike] = None,
                    subfacets: Optional[npt.ArrayLike] = None, subfacet_markers: Optional[npt.ArrayLike] = None) -> Mesh:
        """A mesh of (n, D) points and (m, D + 1) cells: a background mesh, one to check, to remesh or to refine. By further arrays it
        has (m,) labels of cells, (n,) markers and (n, k) attributes of points, and (k, 2) subsegments and, in 3D, (k, 3) subfacets
        with (k,) markers, 0 without. Raises UsageError."""
        at = _arguments.points("points", points)
        dimension = int(at.shape[1])
        core = _CORES[dimension](at, _arguments.indices("cells", cells, dimension + 1))
        if dimension == 2 and subfacets is not None:
            raise usage("subfacets are of three dimensions")
        labels = np.zeros(0) if regions is None else _arguments.values("regions", regions, len(core.cells), "cells")
        markers = np.zeros(0, dtype=np.int32) if point_markers is None else _whole("point_markers", point_markers, len(at))
        attributes = np.zeros(0) if point_attributes is None else _arguments.reals("point_attributes", point_attributes)
        if attributes.size and len(attributes) != len(at):
            raise usage(f"point_attributes must have a row for each of {len(at)} points, not {len(attributes)}")
        core.set_labels(labels, 0, markers, attributes.reshape(-1), np.zeros(0, dtype=np.int64))
        for name, rows, given, columns in (("subsegment", subsegments, subsegment_markers, 2), ("subfacet", subfacets, subfacet_markers, 3)):
            if rows is None:
                if given is not None:
                    raise usage(f"{name}_markers are of {name}s")
                continue
            wall = _arguments.indices(f"{name}s", rows, columns)
            if wall.size and not 0 <= wall.min() <= wall.max() < len(at):
                raise usage(f"{name}s refer to points from 0 to {len(at) - 1}")
            of = np.zeros(len(wall), dtype=np.int32) if given is None else _whole(f"{name}_markers", given, len(wall))
            getattr(core, f"set_{name}s")(wall.astype(np.uint32), of, np.zeros(len(wall), dtype=np.uint32))
        return cls._of(core)

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return 2 if isinstance(self._core, _pgdr.Mesh2) else 3

    @property
    def points(self) -> npt.NDArray[np.float64]:
        """(n, D) coordinates: first the distinct points of the input, in their order, then the others."""
        return self._core.points

    @property
    def cells(self) -> npt.NDArray[np.int32]:
        """(m, D + 1) vertices of the triangles (2D, counterclockwise) or tetrahedra (3D, of positive orientation)."""
        return _arguments.signed(self._core.cells)

    @property
    def regions(self) -> npt.NDArray[np.float64]:
        """(m,) label of each cell: the attribute of its seed, its number with regions="auto" or "all", else 0."""
        labels = self._core.regions
        if len(labels) != len(self._core.cells):  # nothing has a label
            labels = np.zeros(len(self._core.cells))
            labels.setflags(write=False)
        return labels

    @property
    def point_markers(self) -> npt.NDArray[np.int32]:
        """(n,) markers; (0,) if the input has none."""
        return self._core.point_markers

    @property
    def point_attributes(self) -> npt.NDArray[np.float64]:
        """(n, a) attributes, interpolated at new points."""
        flat = self._core.point_attributes
        return flat.reshape(len(self.points), -1) if len(flat) else flat.reshape(len(self.points), 0)

    @property
    def input_points(self) -> int:
        """So many of the points, the first ones, are of the input, or crossings of its edges."""
        return self._core.input_points

    @property
    def subsegments(self) -> npt.NDArray[np.int32]:
        """(k, 2) edges that segments, or edges of facets, have become."""
        return _arguments.signed(self._core.subsegments)

    @property
    def subsegment_markers(self) -> npt.NDArray[np.int32]:
        """(k,) the markers of their segments."""
        return self._core.subsegment_markers

    @property
    def subfacets(self) -> npt.NDArray[np.int32]:
        """3D: (k, 3) triangles that the facets have become; those on the hull face outwards."""
        return _arguments.signed(self._core.subfacets.reshape(-1, 3))

    @property
    def subfacet_markers(self) -> npt.NDArray[np.int32]:
        """3D: (k,) the markers of their facets."""
        return self._core.subfacet_markers

    @property
    def markers(self) -> npt.NDArray[np.int32]:
        """(k,) markers of what bounds cells: of `subsegments` in 2D, of `subfacets` in 3D."""
        return self.subsegment_markers if self.dimension == 2 else self.subfacet_markers

    @property
    def region_names(self) -> Dict[float, str]:
        """What the labels in `regions` are called, where the input had names for them."""
        return self._core.names[0]

    @property
    def marker_names(self) -> Dict[int, str]:
        """What markers are called, where the input had names for them."""
        return self._core.names[1]

    @property
    def point_of_input(self) -> npt.NDArray[np.int64]:
        """The row in `points` of each point of the input, -1 if it was dropped; (0,) of a mesh that was not made here."""
        rows: npt.NDArray[np.int64] = self._core.point_of_input[:self._facts.get("given_points")]
        return rows

    def neighbors(self) -> npt.NDArray[np.int64]:
        """(m, D + 1) the cell beyond the face opposite each vertex; -1: none. Linear time."""
        return self._core.neighbors()

    def not_delaunay(self) -> npt.NDArray[np.int64]:
        """(k, 2) the cells with a vertex strictly inside their circumsphere across a face that is no subfacet (2D: subsegment), and such
        a vertex; exact. What is beyond subfacets does not count; none: the mesh is constrained Delaunay. Linear time."""
        return (_pgdr.not_delaunay2 if self.dimension == 2 else _pgdr.not_delaunay3)(self._core)

    def edges(self) -> npt.NDArray[np.int32]:
        """(k, 2) all edges, each once, the smaller row first, sorted. n log n."""
        return _arguments.signed(self._core.edges())

    def quality(self) -> Dict[str, Any]:
        """Angles in degrees, radius-edge ratio, radius ratio and scaled Jacobian: of all cells, and of each region."""
        return self._core.quality()

    @property
    def reasons(self) -> List[Reason]:
        """Of each cell over a bound, why. Empty where all bounds hold."""
        def named(kind: int, facet: int, ends: npt.NDArray[np.float64]) -> List[_Entity]:
            word = _pgdr.entity_kinds[kind]
            if word == "facet":  # of another surface than the input's: a place on it
                return [(word, int(facet) if facet != 2**32 - 1 else tuple(tuple(x) for x in ends[:1].tolist()))]
            return [(word, tuple(tuple(x) for x in ends[:, :self.dimension].tolist()))] if word == "segment" else []

        return [Reason(int(cell), _pgdr.reason_codes[code], sum(map(named, kinds, facets, ends), []), float(angle))
                for cell, code, kinds, facets, ends, angle in zip(*self._core.reason_arrays)]

    @property
    def poor_left(self) -> int:
        """Cells over a bound; each has a reason when `stop` is "finished"."""
        return self._facts.get("poor_left", 0)

    @property
    def stop(self) -> str:
        """Why the run ended: "finished", "max_vertices", "min_edge", "time_limit" or "cancelled"."""
        return self._facts.get("stop", "finished")

    @property
    def statistics(self) -> Dict[str, Any]:
        """Counts and times (seconds) of the run; {} of a mesh that was not made here. As in the command's report (docs/usage.md)."""
        return self._facts.get("statistics", {})

    @property
    def repairs(self) -> List[Diagnostic]:
        """What was done to the input: each repair, with the numbers and places of what it is about."""
        return list(self._facts.get("repairs", []))

    @property
    def surface(self) -> Optional[Dict[str, Any]]:
        """With `surface_tolerance`: what was made of the surface, by the names of the command's report (docs/usage.md). None: it is
        the surface as given."""
        return self._facts.get("surface")

    @property
    def periodic(self) -> List[Periodic]:
        """The sides that correspond, as asked for by `periodic`, vertex by vertex."""
        return list(self._facts.get("periodic", []))

    @property
    def warnings(self) -> List[Diagnostic]:
        """What is odd about the input, and was taken as it is."""
        return list(self._facts.get("warnings", []))

    def check(self, plc: Union[None, Plc, Mesh] = None, **bounds: Any) -> CheckReport:
        """`pgdr.check` with the bounds, the reasons and the tolerance of the run that made this mesh; `bounds` are instead of those.
        Of a run that ended early (`stop`), the bounds are not asked for."""
        lost = [name for name, value in self._bounds.items() if value is _Lost and name not in bounds]
        if lost:
            raise usage(f"a pickled mesh has no {' and '.join(lost)} that is a function: give it again")
        asked = dict(self._bounds) if self.stop == "finished" else {}
        if "radius_edge" in bounds or "min_angle" in bounds:
            asked.pop("radius_edge", None)
        asked.update(bounds)
        tolerance = self.statistics.get("tolerance")
        if tolerance is not None and isinstance(plc, Plc) and plc.tolerance != tolerance:  # what met then meets now
            plc = plc.with_tolerance(tolerance, coarse=True)
        report: CheckReport = through("check")(self, plc, **asked)
        return report

    def write(self, path: _arguments.Path, *, first_index: int = 1, edges: bool = False, neighbors: bool = False,
              pieces: int = 0, order: int = 1) -> None:
        """Writes .vtu, .pvtu, .msh, .mesh, or .node with .ele, by the extension, or for other programs .inp (Abaqus, CalculiX), .mfem, or
        a folder named polyMesh (OpenFOAM); a file there is replaced when all is written. Names that the format cannot hold are
        written as it can, which a Python warning says.

        first_index, edges, neighbors are for .node and .ele; pieces for .pvtu. order=2, of .msh, .vtu and .inp: with a node in the middle
        of each edge, which stays straight. Raises FileError, UsageError.
        """
        file = _arguments.path(path)
        for unfit in self._core.unfit_names(file):
            warnings.warn(unfit.message, stacklevel=2)
        with WORK:
            self._core.write(file, _arguments.whole_number("first_index", first_index, 0, 1),
                             _arguments.flag("edges", edges), _arguments.flag("neighbors", neighbors),
                             _arguments.whole_number("pieces", pieces, 0, 100000), _arguments.whole_number("order", order, 1, 2))

    def voronoi(self) -> Any:
        """2D: the Voronoi cells of the vertices, clipped to the domain, as a `pgdr.Voronoi`. Of meshes of conforming_delaunay=True;
        of others, a UsageError says at how many edges circumcentres are not where they have to be. n log n."""
        return through("voronoi")(self)

    def to_meshio(self) -> Any:
        """A meshio.Mesh of the cells, the subfacets and the subsegments, with cell data "region" and "marker"; where anything has a name
        also with cell sets and field data of the names, and with cell data "gmsh:physical"."""
        return through("to_meshio")(self)

    def to_pyvista(self, constraints: bool = False) -> Any:
        """A pyvista.UnstructuredGrid of the cells, with cell data "region"; z = 0 in 2D. With `constraints` also, behind them, the
        subfacets (3D) and the subsegments, whose cell data "marker" is theirs. Names are field data, pairs of the label or marker and
        the dimension of what has it, which `Plc.from_pyvista` reads. Raises ImportError without pyvista."""
        return through("to_pyvista")(self, constraints)

    def to_html(self, path: _arguments.Path, *, color: Optional[str] = None, point_data: Optional[Mapping[str, npt.ArrayLike]] = None,
                cell_data: Optional[Mapping[str, npt.ArrayLike]] = None, title: Optional[str] = None) -> Any:
        """Writes a page, one file, that shows the mesh in any browser: it turns, zooms, is cut by a plane, coloured, and says the figures
        of the cell under the pointer. As `pgdr view MESH -o PAGE.html`.

        color: what it is coloured by at first: "quality" (the default), "dihedral", "radius_edge", "volume", "region", "name", "marker", or
        the name of a field. point_data, cell_data: fields, {name: (n,) or (n, k) numbers}, of the points and cells of this mesh. title: of
        the page; else the name of the file. Returns a Page, with its `path`, which a notebook shows. Raises FileError, UsageError.
        """
        return through("to_html")(self, path, color, point_data, cell_data, title)

    def show(self, color: Optional[str] = None, *, point_data: Optional[Mapping[str, npt.ArrayLike]] = None,
             cell_data: Optional[Mapping[str, npt.ArrayLike]] = None) -> Any:
        """Shows the mesh, and fields of it: by PyVista, where it is installed, whose plot() is returned (`color` is then the name of a
        field, or "region"); else as a page of `to_html`, in the browser or, in a notebook, as the value of the cell. The page is a
        temporary file, which stays.
        """
        return through("show")(self, color, point_data, cell_data)

    def _repr_html_(self) -> str:
        drawn: str = through("repr_html")(self)
        return drawn

    def __repr__(self) -> str:
        words = f"<pgdr.Mesh {self.dimension}D: {len(self.points)} points, {len(self.cells)} cells"
        words += f", {self.poor_left} over a bound" if self.poor_left else ""
        return words + ("" if self.stop == "finished" else f", ended by {self.stop}") + ">"

    def __reduce__(self) -> Tuple[Callable[..., Mesh], Tuple[Any, ...]]:
        core = self._core
        arrays: Dict[str, Any] = {name: np.array(getattr(core, name)) for name in _PICKLED}
        arrays["reasons"] = tuple(np.array(a) for a in core.reason_arrays)
        is_lasting = through("is_lasting")
        bounds = {name: value if all(map(is_lasting, value.values() if name == "region_sizes" else (value,))) else _Lost
                  for name, value in self._bounds.items()}
        return _restored, (self.dimension, arrays, core.input_points, core.names, self._facts, bounds)


def _whole(name: str, values: npt.ArrayLike, count: int) -> npt.NDArray[np.int32]:
    """(count,) markers."""
    array = np.asarray(values)
    if array.dtype.kind not in "iu" or array.shape != (count,):
        raise usage(f"{name} must be {count} integers, not {array.dtype} in the shape {array.shape}")
    if array.size and not -2**31 <= int(array.min()) <= int(array.max()) < 2**31:
        raise usage(f"{name} must be integers of 32 bits")
    return np.ascontiguousarray(array, dtype=np.int32)


def required_mask(mesh: Mesh, required: Optional[npt.ArrayLike]) -> npt.NDArray[np.uint8]:
    """(n,) flags of the points of a mesh; (0,): none is required."""
    if required is None:
        return np.zeros(0, dtype=np.uint8)
    mask = np.asarray(required)
    if mask.dtype != np.bool_ or mask.shape != (len(mesh.points),):
        raise usage(f"required must be True or False for each of {len(mesh.points)} points, not {mask.dtype} in the shape {mask.shape}")
    return np.ascontiguousarray(mask, dtype=np.uint8)


class _Lost:
    """Stands for a size that could not be pickled."""


_PICKLED = ("points", "cells", "regions", "point_markers", "point_attributes", "subsegments", "subsegment_markers",
            "subsegment_entities", "subfacets", "subfacet_markers", "subfacet_entities", "point_of_input")


def _restored(dimension: int, arrays: Dict[str, Any], input_points: int, names: Tuple[Dict[float, str], Dict[int, str]],
              facts: Dict[str, Any], bounds: Dict[str, Any]) -> Mesh:
    core = _CORES[dimension](arrays["points"], arrays["cells"])
    core.set_labels(arrays["regions"], input_points, arrays["point_markers"], arrays["point_attributes"], arrays["point_of_input"])
    core.set_subsegments(arrays["subsegments"], arrays["subsegment_markers"], arrays["subsegment_entities"])
    core.set_subfacets(arrays["subfacets"], arrays["subfacet_markers"], arrays["subfacet_entities"])
    core.set_reasons(*arrays["reasons"])
    core.set_names(names)
    for p in facts.get("periodic", []):
        paired(core, [(p.from_marker, p.to_marker, p.motion.ravel().tolist())], p.largest_gap)
    return Mesh._of(core, facts, bounds)
