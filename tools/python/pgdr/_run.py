# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Meshing."""
from __future__ import annotations

import sys
import warnings
from typing import Any, Callable, Dict, Mapping, NamedTuple, Optional, Protocol, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _arguments, _pgdr
from ._bounds import bounds_of, require_walls, sizes_by_label
from ._ending import WORK
from ._errors import DiagnosedError, Diagnostic, in_python, usage
from ._fields import Size, in_unit, size_unit_of
from ._mesh import Mesh
from ._periodic import paired, sides_of
from ._plc import Plc
from ._surface import replace_surface


class Elements(NamedTuple):
    """Poor elements, as a selector gets them: n rows each. Lengths are in the units of the input."""

    corners: npt.NDArray[np.float64]  #: (n, D + 1, D)
    circumcenter: npt.NDArray[np.float64]  #: (n, D)
    circumradius: npt.NDArray[np.float64]  #: (n,)
    shortest_edge: npt.NDArray[np.float64]  #: (n,) its length
    disk_center: npt.NDArray[np.float64]  #: (n, D) of the selection disk
    disk_radius: npt.NDArray[np.float64]  #: (n,) 0: the centre alone
    over_radius_edge: npt.NDArray[np.bool_]  #: (n,) else it is only too big


class Progress(NamedTuple):
    """How far a run is."""

    vertices: int  #: so far
    waiting: int  #: elements that wait to be refined
    finished: bool  #: the last report of a run, however it ended
    stage: str = ""  #: what it is at: "recover", "insert", "optimize_cheap", ..., in the end "done"; "" while the input is prepared
    done: Optional[float] = None  #: about this share of its time is over: 0 to 1, never falls; None while nothing is known


class _Event(Protocol):
    def is_set(self) -> bool: ...


class StopSource:
    """Stops runs: give it to `mesh(..., stop=)` and call `stop()` from any thread, or a signal handler."""

    def __init__(self) -> None:
        self._core = _pgdr.StopSource()

    def stop(self) -> None:
        """Ends all runs that it was given to, within some hundredths of a second; they return the mesh so far."""
        self._core.stop()

    def is_set(self) -> bool:
        """Was it stopped?"""
        return bool(self._core.is_set())

    def __repr__(self) -> str:
        return f"<pgdr.StopSource: {'set' if self.is_set() else 'not set'}>"


def mesh(plc: Union[Plc, Sequence[Plc]], *, min_angle: Optional[float] = None, radius_edge: Optional[float] = None, size: Optional[Size] = None,
         min_dihedral: Optional[float] = None, optimize: bool = True, threads: int = 0, regions: Optional[str] = None,
         region_sizes: Optional[Mapping[Union[float, str], Size]] = None,
         size_unit: Optional[str] = None, edge_length: Optional[Size] = None,
         selector: Union[None, str, Callable[[Elements], npt.ArrayLike]] = None, keep_boundary: Union[bool, Sequence[int]] = False,
         conforming_delaunay: bool = False, periodic: Sequence[Tuple[Any, ...]] = (),
         tolerance: Optional[float] = None, surface_tolerance: Union[None, float, str] = None, feature_angle: float = 40.0,
         max_volume: Optional[float] = None, min_edge: float = 0.0,
         time_limit: Optional[float] = None, max_vertices: Optional[int] = None, refine: bool = True,
         schedule: Optional[str] = None, drop_unused_points: bool = False, memory_guard: bool = True,
         progress: Union[bool, Callable[[Progress], object]] = False, stop: Union[None, StopSource, _Event] = None) -> Mesh:
    """Meshes an input. Other Python threads run meanwhile, and may mesh, too. The mesh is the same for any number of threads.

    Parameters
    ----------
    plc : Plc, or list of them
        The input; several are one, as `Plc.joined` makes it.
    min_angle : float, optional
        2D: bound on the angles, in degrees, above 0 and at most 60; up to 20.7 there is a proof, beyond some 33 few inputs have
        such a mesh. Instead of `radius_edge`.
    radius_edge : float, optional
        Bound on circumradius over shortest edge; the default is the smallest with a proof: 2 in 3D, sqrt(2) in 2D (20.7 degrees).
    size : float, Field, or function, optional
        Bound on the circumradius (3D, a length) or area (2D) of each cell, at its centroid. Regular cells with edges h have 0.61 h,
        and 0.43 h h. A function gets an (n, D) float64 array of points, and returns their n sizes; it must say the same whenever it
        is asked for a point, and what it raises comes out of this call.
    size_unit : "edge", "radius", "area" or "volume", optional
        What `size` and `region_sizes` are of: "radius" in 3D (the default there) and "area" in 2D, as said above; "volume" in 3D; or
        "edge": the length that edges have on average (docs/remeshing.md).
    edge_length : float, Field, or function, optional
        Short for size=edge_length, size_unit="edge".
    min_dihedral : float, optional
        3D: bound on the dihedral angles, in degrees, from 0 to 35, that the optimiser works for. Default: 15.
    optimize : bool
        3D. False: no optimiser, and a Delaunay mesh.
    threads : int
        How many; 0: as many as there are cores.
    regions : "seeds", "auto" or "all", optional
        Which volumes are meshed and how they are labelled: as the input's seeds say (the default); by nesting, where of volumes
        inside one another every second is a void; or all that is enclosed and no hole's. The latter two number those without a seed.
    region_sizes : dict, optional
        Further sizes of the cells with a label: {label: size}, or with the name that the input has for it: {name: size}.
    selector : str or function, optional
        Where new points go: a name as the command has it ("circumcenter", "off-center", "optimized", "sliver-avoiding",
        "random"), or a function of `Elements` that returns an (n, D) array of points in their selection disks, or an (n, k, D)
        array, k up to 8, of the point in the disk and further points inside the circumsphere, which go in where they keep the
        distance of docs/selectors.md, "Several points" (rows of NaN: none). It is asked by one thread at a
        time, for the element that is next and those that wait behind it: each point must depend on its element alone. A point
        outside of the disk, or NaN, is replaced by the circumcentre and counted, if the element comes to its turn. It is asked for
        elements over the radius-edge bound; where none is met, a warning (`Mesh.warnings`, and of Python) says so.
    keep_boundary : bool or sequence of int
        True: no new point on any segment (2D) or facet (3D): each given triangle is one subfacet. Numbers: of facets (2D: segments)
        with these markers alone. In 3D `Mesh.statistics["insertions"]` has `boundary_points`, those without which the boundary
        could not be recovered (mostly none), and `inner_points`, those inside that it takes in their place.
    conforming_delaunay : bool
        2D: segments are split until every triangle is Delaunay across them, too, and its circumcentre in the domain: `Mesh.voronoi`
        has the cells of such a mesh. What lies beyond a void does not count. With radius_edge=inf and no size, this alone adds points.
    periodic : list of (from, to) or (from, to, motion)
        The sides with these markers of segments (3D: facets) correspond vertex by vertex (`Mesh.periodic`), by the translation between
        them, or by a rigid motion, (2, 3) numbers (3D: (3, 4)).
    tolerance : float, optional
        Instead of that of the input: what lies within this distance meets.
    surface_tolerance : float or str, optional
        3D: another surface is meshed, which `replace_surface` makes within this distance of the given one: a length, or "0.1%" of the
        diagonal of all points. Rows of the input are then those of the other surface; `Mesh.surface` says what it is. (`size` does not
        limit its edges here: call `replace_surface` in C++, or the command, for that.)
    feature_angle : float
        Degrees, with `surface_tolerance`: where normals differ by more is a crease, which stays.
    max_volume : float, optional
        3D: bound on the volume of each cell.
    min_edge : float
        Points that would make an edge shorter than this are not inserted.
    time_limit : float, optional
        Seconds; then the mesh so far is returned.
    max_vertices : int, optional
        So many at most; then the mesh so far is returned.
    refine : bool
        False: no new points but those that the boundary needs.
    schedule : "reproducible", "uniform" or "greedy", optional
        The order of the work (docs/usage.md). Only greedy meshes depend on timing.
    drop_unused_points : bool
        Points of the input that are in no cell, as they lie outside or in holes, are left out of the mesh: `point_of_input` has -1.
        Else they are vertices without cells. `warnings` says how many there are, either way.
    memory_guard : bool
        True: an input in whose gaps there are more cells than there is memory for is refused at once, by a ResourceError that names
        the gap, unless `max_vertices`, `time_limit`, `min_edge` or `keep_boundary` bound the run. False: it is meshed, as far as
        memory goes.
    progress : bool or function
        True: a line on standard error, which ends when the run ends. A function of `Progress`, called by this thread some thirty
        times a second at most, and once more in the end.
    stop : StopSource, or an object with is_set()
        Ends the run; the mesh so far is returned, with `stop` "cancelled".

    Returns
    -------
    Mesh
        Valid, however the run ended.

    Raises
    ------
    UsageError
        An argument of a wrong value, or what a callback returned.
    InputError
        An input that has no mesh; `diagnostics` says all that is wrong.
    KeyboardInterrupt
        Ctrl-C: its attribute `mesh` is the mesh so far. What a callback raises comes out as it is.

    Examples
    --------
    >>> import pgdr
    >>> square = pgdr.Plc([[0, 0], [1, 0], [1, 1], [0, 1]], segments=[[0, 1], [1, 2], [2, 3], [3, 0]])
    >>> graded = pgdr.mesh(square, min_angle=25, size=lambda at: 0.001 + 0.01 * at[:, 0])
    >>> graded.stop, graded.poor_left
    ('finished', 0)
    """
    if isinstance(plc, (list, tuple)):
        plc = Plc.joined(plc)
    if not isinstance(plc, Plc):
        raise TypeError(f"plc must be a pgdr.Plc, not {type(plc).__name__}: pgdr.Plc(points, ...) makes one of arrays, pgdr.Plc.read(path) "
                        "of a file, pgdr.Plc.from_mesh(mesh) of a pgdr.Mesh")
    require_walls(plc)
    if tolerance is not None:
        plc = plc.with_tolerance(tolerance)
    dimension = plc.dimension
    surface: Optional[Dict[str, Any]] = None
    sides = sides_of(periodic, dimension)
    if surface_tolerance is not None:
        wanted = max(30.0, _arguments.number("min_dihedral", min_dihedral or 0) + 10)
        given_tolerance = plc.tolerance
        plc, _, surface = replace_surface(plc, surface_tolerance, feature_angle=feature_angle, wanted_corner=wanted,
                                          fixed_markers=[marker for side in sides for marker in side[:2]])
    size, size_unit = size_unit_of(size, edge_length, size_unit)
    size = None if size is None else in_unit(size, size_unit, dimension)
    region_sizes = None if region_sizes is None else {label: in_unit(one, size_unit, dimension) for label, one in
                                                      sizes_by_label(region_sizes, plc.region_names).items()}
    if not _arguments.flag("optimize", optimize):
        if min_dihedral is not None:
            raise usage("optimize=False makes no use of min_dihedral")
        min_dihedral = 0 if dimension == 3 else None
    bounds = _given(min_angle=min_angle, radius_edge=radius_edge, size=size, region_sizes=region_sizes, min_dihedral=min_dihedral,
                    max_volume=max_volume, regions=regions)
    options = bounds_of(dimension, bounds)
    options.set_threads(_arguments.whole_number("threads", threads, 0, 4096))
    options.refine = _arguments.flag("refine", refine)
    options.keep_boundary, options.kept_markers = _arguments.kept("keep_boundary", keep_boundary)
    options.conforming_delaunay = _arguments.flag("conforming_delaunay", conforming_delaunay)
    kept = options.keep_boundary and (list(options.kept_markers) or True)
    options.drop_unused_points = _arguments.flag("drop_unused_points", drop_unused_points)
    options.memory_guard = _arguments.flag("memory_guard", memory_guard)
    options.min_edge = _arguments.number("min_edge", min_edge)
    if time_limit is not None:
        options.set_time_limit(_arguments.number("time_limit", time_limit))
    if max_vertices is not None:
        options.max_vertices = _arguments.whole_number("max_vertices", max_vertices, 0, 2**64 - 1)
    if schedule is not None:
        options.set_schedule(_arguments.word("schedule", schedule, ("reproducible", "uniform", "greedy")))
    asked = _select(options, selector)
    given, given_points = plc, len(plc.points)
    periodic_input: Union[None, _pgdr.PeriodicInput2, _pgdr.PeriodicInput3] = None
    if sides:
        with WORK:
            core, sides, keeps, kept_markers, periodic_input = _pgdr.make_periodic(plc._core, sides, options)
        plc, options.keep_boundary = Plc._of(core), options.keep_boundary or keeps
        if keeps:
            options.kept_markers = kept_markers
    try:
        made = _run(plc, options, bounds, progress, stop)
    except DiagnosedError as error:
        _add_what_helps(error, plc)
        raise
    if sides:
        made._facts["given_points"] = given_points
        if isinstance(periodic_input, _pgdr.PeriodicInput3):
            periodic_input.name_as_given(made._core)
        if made.stop == "finished":
            made._facts["periodic"] = paired(made._core, sides, 2 * made.statistics["tolerance"])
    if surface is not None and isinstance(made._core, _pgdr.Mesh3) and isinstance(given._core, _pgdr.Plc3):
        _pgdr.name_facets_by_places(made._core, given._core)  # the input does not have these facets
        made._facts["surface"] = surface
        made.statistics["tolerance"] = given_tolerance  # as `check` reads what was given
    if kept:
        made._facts["kept_boundary"] = kept
    made._facts["conforming_delaunay"] = conforming_delaunay and made.stop == "finished"
    if asked is not None and not asked.was_called:
        _say_unasked(made, options)
    return made


def _add_what_helps(error: DiagnosedError, plc: Plc) -> None:
    """Names the functions, the points or the tolerance that make a refused input valid."""
    cures = _pgdr.cures2 if plc.dimension == 2 else _pgdr.cures3
    with WORK:
        found = cures(plc._core)
    for cure in found:
        error._add(". " + in_python(cure))


def _say_unasked(made: Mesh, options: _pgdr._Options) -> None:
    """A selector that was never called may be one with a mistake in it that never came to light."""
    words = "the selector was never called: " + (
        f"only elements over the radius-edge bound, here {options.radius_edge_bound:.4g}, are split at points of its choice, and none "
        "was met; those that are too large alone are split at their circumcentres" if options.refine else "refine=False splits nothing")
    made._facts["warnings"].append(Diagnostic("unused_selector", words))
    warnings.warn(words, stacklevel=3)


def _given(**arguments: Any) -> Dict[str, Any]:
    return {name: value for name, value in arguments.items() if value is not None}


class _Asked:
    """A selector, and whether it was ever called."""

    def __init__(self, select: Callable[[Elements], npt.ArrayLike]) -> None:
        self._select = select
        self.was_called = False

    def __call__(self, elements: Elements) -> npt.ArrayLike:
        self.was_called = True
        return self._select(elements)


def _select(options: _pgdr._Options, selector: object) -> Optional[_Asked]:
    """Returns what was made of a function."""
    if callable(selector):
        asked = _Asked(selector)
        options.select_by(asked)
        return asked
    if isinstance(selector, str):
        options.select_by_name(selector)
    elif selector is not None:
        raise TypeError(f"selector must be a name or a function, not {type(selector).__name__}")
    return None


class _Line:
    """A line on standard error that tells how far a run is."""

    def __init__(self) -> None:
        self._written: Optional[Progress] = None

    def __call__(self, progress: Progress) -> None:
        if progress.finished:
            if self._written:
                print(f"\r{progress.vertices:,} vertices{'':20}", file=sys.stderr)
            return
        if progress == self._written:
            return
        self._written = progress
        share = "" if progress.done is None else f"{100 * progress.done:3.0f} %, "
        print(f"\r{share}{progress.vertices:,} vertices, {progress.waiting:,} waiting   ", end="", file=sys.stderr, flush=True)


def _run(plc: Plc, options: _pgdr._Options, bounds: Dict[str, Any], progress: object, stop: object) -> Mesh:
    tell: Optional[Callable[[Progress], object]] = None
    if callable(progress):
        tell = progress
    elif _arguments.flag("progress", progress):
        tell = _Line()
    if stop is not None and not callable(getattr(stop, "is_set", None)):
        raise TypeError(f"stop must be a StopSource, or have is_set(), not {type(stop).__name__}")
    source = stop._core if isinstance(stop, StopSource) else None
    asks = stop if source is None else None

    last = Progress(0, 0, False)

    def poll(vertices: int, waiting: int, stage: str, done: Optional[float]) -> bool:
        nonlocal last
        if tell is not None:
            last = Progress(vertices, waiting, False, stage, done)
            tell(last)
        return WORK.is_ending or (asks is not None and bool(asks.is_set()))  # type: ignore[attr-defined]

    refine = _pgdr.refine2 if plc.dimension == 2 else _pgdr.refine3
    finished, is_done = 0, False
    try:
        with WORK:
            core, facts, raised = refine(plc._core, options, source, poll, tell is not None)
        finished, is_done = len(core.points), facts["stop"] != "cancelled"
    finally:
        if tell is not None:
            tell(Progress(finished, 0, True, "done" if is_done else last.stage, 1.0 if is_done else last.done))
    # The bounds that held when no argument said otherwise are part of what the mesh is certified for.
    certified = {k: v for k, v in bounds.items() if k != "min_angle"}
    if options.refine:
        certified["radius_edge"] = options.radius_edge_bound
    else:
        certified = {k: v for k, v in certified.items() if k == "regions"}
    if plc.dimension == 3 and options.refine:
        target = facts["statistics"].get("optimization", {}).get("target", 0)
        certified.pop("min_dihedral", None)
        if target > 0:
            certified["min_dihedral"] = target
    made = Mesh._of(core, facts, certified)
    if raised is not None:
        if isinstance(raised, KeyboardInterrupt):
            raised.mesh = made  # type: ignore[attr-defined]
        raise raised
    return made
