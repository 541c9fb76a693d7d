# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs."""
from __future__ import annotations

from typing import Any, Callable, Dict, Iterable, List, Mapping, Optional, Protocol, Sequence, Tuple, Type, Union

import numpy as np
import numpy.typing as npt

from . import _arguments, _pgdr
from ._doors import through
from ._ending import WORK
from ._errors import Diagnostic, usage

_HOLES = 9  # the place of the holes among the arguments of the extension's classes; those of regions follow
_CORES: Dict[int, Type[_pgdr._Plc]] = {2: _pgdr.Plc2, 3: _pgdr.Plc3}


class _Finished(Protocol):
    """A `Mesh`, which is made of inputs, so that it is not known here."""

    @property
    def dimension(self) -> int: ...
    @property
    def cells(self) -> npt.NDArray[np.int32]: ...


class Plc:
    """An input: a planar straight line graph (2D) or a piecewise linear complex (3D).

    Made once, from arrays or a file, and never changed: any number of threads may read and mesh one. Its arrays are views, which
    keep it alive, and are read-only. Lengths are in the units of the coordinates; indices count from 0.

    Parameters
    ----------
    points : (n, 2) or (n, 3) array
        The coordinates, which say the dimension. float64 and float32 are read as they are (of float32, rounding of that size is
        expected), other numbers as float64.
    segments : (m, 2) array of integers, optional
        Ends of the straight edges that the mesh is to have. 2D: the boundary and all constraints inside; 3D: those that no
        facet has.
    facets : (m, k) array of integers, or list, optional
        3D: polygons of k corners each, triangles mostly; or a list whose items are polygons, or lists of polygons that lie in one
        plane (the outer one, then those inside it, as in TetGen's .poly).
    markers : (m,) array of integers, optional
        One a segment (2D) or facet (3D); the mesh hands it on. 0 where there are none.
    point_markers : (n,) array of integers, optional
        One a point.
    holes : (k, D) array, optional
        A point in each area (volume) that stays empty.
    regions : list of rows, optional
        Labels: (x, y[, z], attribute[, max_size]) or dicts of point, attribute, max_size, where max_size bounds the area (2D)
        or volume (3D) of the region's cells.
    segment_markers : (m,) array of integers, optional
        3D: one a segment.
    point_attributes : (n, a) array, optional
        Numbers that are interpolated at new points.
    facet_holes : dict, optional
        3D: for the number of a facet of several polygons, (k, 3) points in its holes.
    tolerance : float, optional
        What lies within this distance meets. None: the rounding of the coordinates; 0: everything is exactly as given.
    coarse : bool
        A tolerance above a thousandth of the diagonal of all points is meant.
    region_names, marker_names : dict, optional
        What labels, and markers, are called; the mesh has these names, too, and writes them.

    Raises
    ------
    UsageError
        An array of a wrong shape, length or type.
    InputError
        A coordinate that is not finite (ids: the point), an index out of range (ids: the segment or facet, the index).

    Examples
    --------
    >>> import pgdr
    >>> square = pgdr.Plc([[0, 0], [1, 0], [1, 1], [0, 1]], segments=[[0, 1], [1, 2], [2, 3], [3, 0]])
    >>> square
    <pgdr.Plc 2D: 4 points, 4 segments>
    """

    _core: _pgdr._Plc

    def __init__(self, points: npt.ArrayLike, segments: Optional[npt.ArrayLike] = None, facets: Optional[Any] = None, *,
                 markers: Optional[npt.ArrayLike] = None, point_markers: Optional[npt.ArrayLike] = None,
                 holes: Optional[npt.ArrayLike] = None, regions: Optional[Iterable[Any]] = None,
                 segment_markers: Optional[npt.ArrayLike] = None, point_attributes: Optional[npt.ArrayLike] = None,
                 facet_holes: Optional[Mapping[int, npt.ArrayLike]] = None, tolerance: Optional[float] = None,
                 coarse: bool = False, region_names: Optional[Mapping[float, str]] = None,
                 marker_names: Optional[Mapping[int, str]] = None) -> None:
        at = _arguments.points("points", points)
        dimension = int(at.shape[1])
        if dimension == 2 and (facets is not None or facet_holes is not None):
            raise usage("facets are for 3D: the points have two coordinates each")
        shape = np.asarray(segments, dtype=object).shape if dimension == 3 and facets is None else ()
        if len(shape) == 2 and shape[1] > 2:
            raise usage(f"segments must have the shape (m, 2), not {shape}: triangles and polygons are given by name, as facets=...")
        ends = _arguments.indices("segments", [] if segments is None else segments, 2)
        corners, polygon_sizes, facet_sizes = _arguments.polygons([] if facets is None else facets)
        facet_count = len(facet_sizes) or len(polygon_sizes)
        if dimension == 2:
            if markers is not None and segment_markers is not None:
                raise usage("markers and segment_markers are the same in 2D: give one of them")
            segment_markers = segment_markers if markers is None else markers
            markers = None
        attributes = np.zeros(0)
        if point_attributes is not None:
            attributes = _arguments.reals("point_attributes", point_attributes)
            if attributes.ndim != 2 or len(attributes) != len(at):
                raise usage(f"point_attributes must have the shape ({len(at)}, a), not {attributes.shape}")
        self._core = _CORES[dimension](
            at, at.dtype == np.float32, ends, _arguments.markers("segment_markers" if dimension == 3 else "markers",
                                                                 segment_markers, len(ends), "segments"),
            corners, polygon_sizes, facet_sizes, _arguments.markers("markers", markers, facet_count, "facets"),
            _hole_rows(facet_holes, facet_count), _arguments.coordinates("holes", [] if holes is None else holes, dimension),
            _arguments.regions([] if regions is None else regions, dimension),
            _arguments.markers("point_markers", point_markers, len(at), "points"), attributes.reshape(-1),
            _tolerance(tolerance), _arguments.flag("coarse", coarse))
        if region_names is not None or marker_names is not None:
            self._core = self.with_names(regions=region_names, markers=marker_names)._core

    @classmethod
    def _of(cls, core: _pgdr._Plc) -> Plc:
        made = cls.__new__(cls)
        made._core = core
        return made

    @classmethod
    def read(cls, path: Union[_arguments.Path, Sequence[_arguments.Path]], *, tolerance: Optional[float] = None, coarse: bool = False,
             region_areas: bool = False) -> Plc:
        """The input in a file: .poly, .smesh, .node, .off, .obj, .ply, .stl, .msh, .vtk or .mesh, by its extension; or in a list of files, as
        `joined` makes it. With `region_areas`, a region of a .poly in 2D that has one number behind its point has it as label and as
        largest area; else as label alone.

        Raises FileError if it cannot be opened, InputError with file and line if it is not what its format asks for.
        """
        if isinstance(path, (list, tuple)):
            one = cls.joined([cls.read(each, region_areas=region_areas) for each in path])
            return one if tolerance is None else one.with_tolerance(tolerance, coarse=coarse)
        file = _arguments.path(path)
        read = _pgdr.read_plc2 if _pgdr.file_dimension(file) == 2 else _pgdr.read_plc3
        made = cls._of(read(file, _arguments.flag("region_areas", region_areas)))
        return made if tolerance is None else made.with_tolerance(tolerance, coarse=coarse)

    @classmethod
    def joined(cls, plcs: Sequence[Plc], names: Optional[Sequence[str]] = None) -> Plc:
        """One input of several, as if they stood in one file: points, segments, facets, holes and regions of each in turn.

        Each is a body with a name, that of its file or of `names`, or has several, the solids of an .stl. A marker belongs to one of
        them alone: it keeps its number unless that is 0 or taken, and has a name. Labels of regions are treated alike. The tolerance
        is the largest that was given.

        >>> import pgdr
        >>> left = pgdr.Plc([[0, 0], [1, 0], [1, 1], [0, 1]], segments=[[0, 1], [1, 2], [2, 3], [3, 0]])
        >>> right = pgdr.Plc([[1, 0], [2, 0], [2, 1], [1, 1]], segments=[[0, 1], [1, 2], [2, 3], [3, 0]])
        >>> pgdr.Plc.joined([left, right], names=["left", "right"]).marker_names
        {1: 'left', 2: 'right'}
        """
        inputs = list(plcs)
        for plc in inputs:
            if not isinstance(plc, Plc):
                raise TypeError(f"plcs must be pgdr.Plc, not {type(plc).__name__}")
        if not inputs or any(plc.dimension != inputs[0].dimension for plc in inputs):
            raise usage("the inputs that are joined must be one or more, of one dimension")
        join = _pgdr.joined2 if inputs[0].dimension == 2 else _pgdr.joined3
        return cls._of(join([plc._core for plc in inputs], [] if names is None else [str(name) for name in names]))

    @classmethod
    def from_polygons(cls, outer: Any, holes: Sequence[npt.ArrayLike] = (), *, markers: Optional[Sequence[int]] = None,
                      labels: Optional[npt.ArrayLike] = None, tolerance: Optional[float] = None) -> Plc:
        """2D: the area inside a ring, less those inside further rings; or of several polygons the union of their areas, in which the
        edges of all stay.

        Parameters
        ----------
        outer
            A ring: an (n, 2) array of its corners, in either direction, with or without the first one again at the end. Or a
            polygon, multipolygon or collection: what has a `__geo_interface__` (Shapely, GeoPandas), or a dict as of GeoJSON. Or a
            list of these, and of lists of rings, the outer one first. Heights of geometries, and what is no polygon in them, are left
            out; the latter is said in a Python warning.
        holes : list of rings
            Of a single ring: inside of it, and apart.
        markers
            One a ring: of each polygon in turn the outer one, then its holes; else they are numbered from 1.
        labels
            One a polygon: the cells in it are labelled so, where polygons overlap by the first of them.

        Parts of the plane that polygons enclose and none has become holes, one by one. Where edges cross, `resolve_crossings` splits
        them before the input can be meshed.

        >>> import pgdr
        >>> pgdr.Plc.from_polygons([[0, 0], [3, 0], [3, 3], [0, 3]], holes=[[[1, 1], [2, 1], [2, 2], [1, 2]]])
        <pgdr.Plc 2D: 8 points, 8 segments, 1 hole>
        """
        made: Plc = through("from_polygons")(outer, holes, markers=markers, labels=labels, tolerance=tolerance)
        return made

    @classmethod
    def from_shapely(cls, geometries: Any, *, labels: Optional[Sequence[Any]] = None, sizes: Optional[npt.ArrayLike] = None,
                     names: Optional[Sequence[Any]] = None, markers: Optional[Sequence[Any]] = None,
                     tolerance: Optional[float] = None) -> Plc:
        """2D: the union of polygons, with lines and points in it as constraints. Geometries of Shapely, or what has a
        `__geo_interface__` (dicts of GeoJSON, too): one, or a list of n rows, each a polygon, line, point, or a collection of these.

        Parameters
        ----------
        labels
            (n,) one a row: cells in its polygons are labelled so, where polygons overlap by the first row. Numbers, or words, which
            are numbered from 1 and become names. None: rows are numbered from 1.
        sizes
            (n,) largest area of the cells in its polygons; 0 or NaN: any.
        names
            (n,) names of the labels of rows with polygons, and of the markers of rows with lines.
        markers
            (n,) of its edges, numbers or words, as labels; a common edge has that of the first row. None: rows are numbered from 1.

        Edges that neighbours have in common are there once, those of the same ends by being equal, others within the tolerance; what
        crosses is split there. What polygons enclose and none has is a hole. Heights are left out. Coordinates may be large, as those
        of a projection are: signs are exact, and nothing has to be moved to the origin. Without polygons, what lines enclose is
        meshed. A file of GeoJSON is read as the same (`Plc.read`, then `resolve_crossings`). Raises UsageError, TypeError.

        >>> import pgdr
        >>> field = {"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 2], [0, 2]]]}
        >>> ditch = {"type": "LineString", "coordinates": [[1, 1], [3, 1]]}
        >>> pgdr.Plc.from_shapely([field, ditch], names=["field", "ditch"])
        <pgdr.Plc 2D: 6 points, 5 segments, 1 region>
        """
        made: Plc = through("from_shapely")(geometries, labels=labels, sizes=sizes, names=names, markers=markers, tolerance=tolerance)
        return made

    @classmethod
    def from_geopandas(cls, frame: Any, *, label: Optional[str] = None, size: Optional[str] = None, name: Optional[str] = None,
                       marker: Optional[str] = None, tolerance: Optional[float] = None) -> Plc:
        """2D: the rows of a GeoDataFrame or GeoSeries, as `from_shapely` takes them; labels, sizes, names and markers are the columns
        of these names. Rows without a geometry count for nothing. Areas are in the units of its coordinates, so project it first
        (`to_crs`): degrees are no lengths."""
        made: Plc = through("from_geopandas")(frame, label=label, size=size, name=name, marker=marker, tolerance=tolerance)
        return made

    @classmethod
    def from_mesh(cls, mesh: _Finished) -> Plc:
        """The boundary of a finished mesh, to be meshed again: its subsegments and subfacets with their markers, what else bounds its
        cells or lies between labels, with marker 0; labels and voids as seeds. Points inside are left out but for those of the input;
        the tolerance is the default, and bounds of regions are not known to a mesh.

        >>> import pgdr
        >>> square = pgdr.Plc([[0, 0], [1, 0], [1, 1], [0, 1]], segments=[[0, 1], [1, 2], [2, 3], [3, 0]], markers=[1, 2, 3, 4])
        >>> sorted(set(pgdr.Plc.from_mesh(pgdr.mesh(square, size=0.1)).markers.tolist()))
        [1, 2, 3, 4]
        """
        core = getattr(mesh, "_core", None)
        if isinstance(core, _pgdr.Mesh2):
            return cls._of(_pgdr.boundary_of_mesh2(core))
        if isinstance(core, _pgdr.Mesh3):
            return cls._of(_pgdr.boundary_of_mesh3(core))
        raise TypeError(f"mesh must be a pgdr.Mesh, not {type(mesh).__name__}")

    @classmethod
    def from_meshio(cls, mesh: Any) -> Plc:
        """The surface, or the cells to be meshed again, in a meshio.Mesh, as gmsh and others write them.

        line: segments; triangle, quad, polygon: facets. Their markers: cell data "marker", "gmsh:physical" or "medit:ref", else the
        cell set that they are in, numbered from 1; else 0. Names: field data, and cell sets that have just the cells of a number.
        With tetra: also the faces between cells of different labels ("region", "gmsh:physical", "medit:ref") and at the outside; the
        labels and the voids become seeds, and points that cells alone have are left out. 2D, where all z are 0 (or missing) and
        nothing has a volume: faces are the cells. Raises UsageError, with what would help, for other cells.
        """
        made: Plc = through("from_meshio")(mesh)
        return made

    @classmethod
    def from_pyvista(cls, mesh: Any) -> Plc:
        """The faces and lines of a pyvista.PolyData, or the cells of an UnstructuredGrid: lines, triangles, quadrilaterals, polygons,
        tetrahedra, taken as `from_meshio` takes them, with the same names of cell data, and names in field data as
        `Mesh.to_pyvista` has them. Of other grids, take extract_surface()."""
        made: Plc = through("from_pyvista")(mesh)
        return made

    def with_tolerance(self, tolerance: Optional[float], *, coarse: bool = False) -> Plc:
        """The same input with another tolerance, None being the rounding of the coordinates. It is copied."""
        return self._of(self._core.with_tolerance(_tolerance(tolerance), _arguments.flag("coarse", coarse)))

    def with_seeds(self, *, holes: Optional[npt.ArrayLike] = None, regions: Optional[Iterable[Any]] = None) -> Plc:
        """The same input with further holes and regions, each as of `Plc`, behind its own. It is copied."""
        dimension, parts, names = self.__reduce__()[1]
        further = (_arguments.coordinates("holes", [] if holes is None else holes, dimension),
                   _arguments.regions([] if regions is None else regions, dimension))
        own = [np.concatenate([mine, more]) for mine, more in zip(parts[_HOLES:_HOLES + 2], further)]
        return _restored(dimension, (*parts[:_HOLES], *own, *parts[_HOLES + 2:]), names)

    def with_names(self, *, regions: Optional[Mapping[float, str]] = None, markers: Optional[Mapping[int, str]] = None) -> Plc:
        """The same input with these names of labels, and of markers; None: as they are. It is copied."""
        of_regions, of_markers = self._core.names
        names = (of_regions if regions is None else _arguments.names("region_names", regions, float),
                 of_markers if markers is None else _arguments.names("marker_names", markers, int))
        return self._of(self._core.with_names(names, np.array(self._core.facet_bodies), self._core.body_names))

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return 2 if isinstance(self._core, _pgdr.Plc2) else 3

    @property
    def region_names(self) -> Dict[float, str]:
        """What labels of regions are called, where they have names."""
        return self._core.names[0]

    @property
    def marker_names(self) -> Dict[int, str]:
        """What markers are called, where they have names."""
        return self._core.names[1]

    @property
    def body_names(self) -> List[str]:
        """3D: what the bodies are called: the solids of an .stl with several, or the inputs that were joined. Else []."""
        return self._core.body_names

    @property
    def facet_bodies(self) -> npt.NDArray[np.int32]:
        """3D: (m,) the body of each facet, its row in `body_names`; (0,) where bodies are what hangs together."""
        return _arguments.signed(self._core.facet_bodies)

    @property
    def points(self) -> npt.NDArray[np.float64]:
        """(n, D) coordinates."""
        return self._core.points

    @property
    def segments(self) -> npt.NDArray[np.int32]:
        """(m, 2) ends of the segments."""
        return _arguments.signed(self._core.segments)

    @property
    def facets(self) -> Union[npt.NDArray[np.int64], List[Any]]:
        """3D: an (m, k) array where all facets are one polygon of k corners each; else a list of polygons and of lists of polygons."""
        corners, polygon_sizes, facet_sizes, _, _ = self._core.facet_arrays
        if len(facet_sizes) == 0 and (len(polygon_sizes) == 0 or (polygon_sizes == polygon_sizes[0]).all()):
            return corners.reshape(len(polygon_sizes), polygon_sizes[0] if len(polygon_sizes) else 3)
        all_polygons = [polygon.tolist() for polygon in np.split(corners, np.cumsum(polygon_sizes)[:-1])]
        if len(facet_sizes) == 0:
            return all_polygons
        begin = np.concatenate([[0], np.cumsum(facet_sizes)])
        return [all_polygons[a] if b - a == 1 else all_polygons[a:b] for a, b in zip(begin[:-1], begin[1:])]

    @property
    def markers(self) -> npt.NDArray[np.int32]:
        """(m,) markers: of the segments (2D) or facets (3D)."""
        return self._core.segment_markers if self.dimension == 2 else self._core.facet_arrays[3]

    @property
    def segment_markers(self) -> npt.NDArray[np.int32]:
        """(m,) markers of the segments."""
        return self._core.segment_markers

    @property
    def point_markers(self) -> npt.NDArray[np.int32]:
        """(n,) markers of the points; (0,) if there are none."""
        return self._core.point_markers

    @property
    def point_attributes(self) -> npt.NDArray[np.float64]:
        """(n, a) attributes of the points."""
        return self._core.point_attributes

    @property
    def holes(self) -> npt.NDArray[np.float64]:
        """(k, D) points in what stays empty."""
        return self._core.holes

    @property
    def regions(self) -> npt.NDArray[np.float64]:
        """(k, D + 2) seeds of regions: a point, the attribute, the largest area or volume of the cells (0: none)."""
        return self._core.regions

    @property
    def tolerance(self) -> float:
        """What lies within this distance meets; 0: everything is exactly as given."""
        return self._core.effective_tolerance

    @property
    def file(self) -> str:
        """Where it was read from; empty: it was not."""
        return self._core.file

    def __repr__(self) -> str:
        counts = [_count(len(self.points), "point"), _count(len(self.segments), "segment") if len(self.segments) else "",
                  _count(self._core.facet_count, "facet") if self.dimension == 3 else "",
                  _count(len(self.holes), "hole") if len(self.holes) else "",
                  _count(len(self.regions), "region") if len(self.regions) else ""]
        return f"<pgdr.Plc {self.dimension}D: {', '.join(c for c in counts if c)}>"

    def __reduce__(self) -> Tuple[Callable[..., Plc], Tuple[Any, ...]]:
        core = self._core
        corners, polygon_sizes, facet_sizes, facet_markers, facet_holes = core.facet_arrays
        parts = (np.array(core.points), core.are_floats, np.array(core.segments), np.array(core.segment_markers), corners,
                 polygon_sizes, facet_sizes, facet_markers, facet_holes, np.array(core.holes), core.regions,
                 np.array(core.point_markers), np.array(core.point_attributes).reshape(-1), core.tolerance, core.is_coarse)
        return _restored, (self.dimension, parts, (core.names, np.array(core.facet_bodies), core.body_names))


def _restored(dimension: int, parts: Tuple[Any, ...], names: Tuple[Any, ...]) -> Plc:
    return Plc._of(_CORES[dimension](*parts).with_names(*names))


def _count(number: int, word: str) -> str:
    return f"{number} {word}{'' if number == 1 else 's'}"


def _tolerance(value: Optional[float]) -> Optional[float]:
    if value is None:
        return None
    made = _arguments.number("tolerance", value)
    if not 0 <= made < float("inf"):
        raise usage(f"the tolerance must be a length, 0 or more, not {value}")
    return made


def _hole_rows(holes: Optional[Mapping[int, npt.ArrayLike]], facets: int) -> npt.NDArray[np.float64]:
    rows: List[Any] = []
    for facet, at in ({} if holes is None else _arguments.mapping("facet_holes", holes, "facet and points")).items():
        number = _arguments.whole_number("a key of facet_holes", facet, 0, facets - 1)
        rows += [[number, *point] for point in _arguments.coordinates(f"facet_holes[{facet}]", at, 3)]
    return np.array(rows, dtype=np.float64).reshape(len(rows), 4)


def resolve_crossings(plc: Plc, *, markers: str = "smallest") -> Tuple[Plc, List[Diagnostic]]:
    """Splits segments where they cross, at new points behind those of the input; in 3D also cuts facets that cross along each other,
    and segments where they go through facets. Returns the input so made, and what was done.

    `markers`, in 3D: whose marker a piece has that several facets cover: of the facet of "smallest" area, or of the "first" or "last"
    in the input.

    >>> import pgdr
    >>> cross = pgdr.Plc([[0, 0], [2, 2], [0, 2], [2, 0]], segments=[[0, 1], [2, 3]])
    >>> split, repairs = pgdr.resolve_crossings(cross)
    >>> len(split.segments), [r.code for r in repairs]
    (4, ['entities_intersect'])
    """
    if not isinstance(plc, Plc):
        raise TypeError(f"plc must be a pgdr.Plc, not {type(plc).__name__}")
    if markers not in ("smallest", "first", "last"):
        raise usage(f'markers must be "smallest", "first" or "last", not {markers!r}')
    if isinstance(plc._core, _pgdr.Plc2):
        core2, repairs = _pgdr.resolve_crossings2(plc._core, markers)
        return Plc._of(core2), repairs
    core3, repairs = _pgdr.resolve_crossings3(plc._core, markers)
    return Plc._of(core3), repairs


def close_planar_openings(plc: Plc) -> Tuple[Plc, List[Diagnostic]]:
    """3D: closes the openings of the surface that lie in a plane, within the tolerance, by facets. Returns the input so made, and an
    entry for each opening: the points of its loops.

    The new facets stand behind those of the input. Each has a marker of its own, which nothing else has, with the name
    closed_opening_1, closed_opening_2, ... in `marker_names`. Of loops in one plane, one in the other, the ring between is closed where
    their facets run in opposite directions, as those of the two sides of a pipe's wall do; else both are.

    >>> import pgdr
    >>> corners = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    >>> box = pgdr.Plc(corners, facets=[[0, 2, 3, 1], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])
    >>> closed, openings = pgdr.close_planar_openings(box)
    >>> [sorted(o.ids) for o in openings], closed.marker_names
    ([[4, 5, 6, 7]], {1: 'closed_opening_1'})
    """
    if not isinstance(plc, Plc):
        raise TypeError(f"plc must be a pgdr.Plc, not {type(plc).__name__}")
    if not isinstance(plc._core, _pgdr.Plc3):
        raise usage("openings are closed in 3D")
    with WORK:
        core, openings = _pgdr.close_planar_openings(plc._core)
    return Plc._of(core), openings


def with_convex_hull(plc: Plc) -> Plc:
    """The same input with the convex hull of all points, too: its edges as segments in 2D, its facets in 3D, with marker 0. Exact: what
    lies in one plane is one facet. Raises InputError (`no_volume`) if all points lie in one plane.

    >>> import pgdr
    >>> corners = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    >>> plc = pgdr.with_convex_hull(pgdr.Plc(corners + [[0.5, 0.4, 0.3]]))
    >>> len(plc.facets), pgdr.mesh(plc).check(plc).exit_code
    (6, 0)
    """
    if not isinstance(plc, Plc):
        raise TypeError(f"plc must be a pgdr.Plc, not {type(plc).__name__}")
    core = plc._core
    with WORK:
        made = _pgdr.with_convex_hull2(core) if isinstance(core, _pgdr.Plc2) else _pgdr.with_convex_hull3(core)
    return Plc._of(made)
