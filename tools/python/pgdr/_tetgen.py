# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""`tetrahedralize`: what users of TetGen's Python packages call, in terms of `pgdr.mesh`."""
from __future__ import annotations

import re
from typing import Any, Dict, Iterator, Mapping, Optional, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _arguments
from ._check import check
from ._errors import InputError, usage
from ._fields import Field, sizes_on_mesh
from ._mesh import Mesh
from ._plc import Plc
from ._remesh import refine as _refine
from ._remesh import remesh
from ._run import mesh

# Switches that change nothing here: p is always meant, z counts from 0 as always, Q and V are about printing, which is never done,
# f, e, n list what the result has anyway, J keeps unused points as always, d finds intersections as always, X asks for inexact signs,
# which are never needed, B and the others are about files.
_WITHOUT_EFFECT = "pzQVfenJdBNEFIgkX"
_REFUSED = {
    "i": "put further points among `points`: those inside are kept",
    "o": "cells have four corners: leave o2 out",
    "v": "there is no Voronoi diagram",
    "c": "the convex hull is not kept: add a box, or the hull's facets, to the surface",
    "M": "facets of different markers are never merged: leave M out and give them markers",
    "s": "the mesh is constrained Delaunay: leave s out",
    "D": "the mesh is constrained Delaunay: leave D out",
    "w": "there are no weighted triangulations",
    "L": "there are no such limits", "P": "there are no such limits", "K": "no .vtk is written: call Mesh.write",
    "W": "there are no weighted triangulations",
    "h": "see help(pgdr.tetrahedralize)",
}
# Keywords of the class TetGen that change nothing here, whatever their value: about printing, files, what is kept in memory, orders of
# insertion, and how TetGen gets to the same.
_SILENT = frozenset((
    "plc quiet verbose nowarning zeroindex diagnose noexact nostaticfilter facesout edgesout neighout meditview vtkview vtksurfview "
    "nobound nonodewritten noelewritten nofacewritten noiterationnum nojettison vertexperblock tetrahedraperblock shellfaceperblock "
    "brio_hilbert flipinsert no_sort hilbert_order hilbert_limit brio_threshold brio_ratio supsteiner_level addsteiner_algo cdtrefine "
    "unflip_queue_limit fliplinklevel flipstarsize fliplinklevelinc delmaxfliplevel reversetetori").split())
# Keywords that would change the mesh and have no equivalent: their values that ask for nothing, and what to do instead.
_NO_LIMITS = "there are no such limits"
_OWN_OPTIMIZER = "the optimiser has no such setting: optimize=False and mindihedral are what there is"
_NEUTRAL: Mapping[str, Tuple[Tuple[Any, ...], str]] = {
    "order": ((1,), "cells have four corners"),
    "psc": ((False,), "surfaces are flat piece by piece"),
    "cdt": ((False,), _REFUSED["D"].replace("leave D out", "leave it out")),
    "coarsen_param": ((0,), "coarsen makes a mesh as coarse as its bounds allow"),
    "coarsen_percent": ((1, 1.0), "coarsen makes a mesh as coarse as its bounds allow"),
    "weighted": ((False,), _REFUSED["w"]),
    "weighted_param": ((0,), _REFUSED["w"]),
    "insertaddpoints": ((False,), _REFUSED["i"]),
    "convex": ((False,), _REFUSED["c"]),
    "nomergefacet": ((False,), "facets of different markers are never merged: give them markers"),
    "nomergevertex": ((False,), "points within the tolerance meet: epsilon says how near that is"),
    "voroout": ((False,), "there is no Voronoi diagram in 3D"),
    "bgmeshfilename": (("", None), "read that mesh and give it as bgmesh"),
    "facet_separate_ang_tol": ((179.9,), _NO_LIMITS),
    "collinear_ang_tol": ((179.9,), _NO_LIMITS),
    "facet_small_ang_tol": ((15, 15.0), _NO_LIMITS),
    "elem_growth_ratio": ((0, 0.0), "give bgmesh sizes that grow so"),
    "refine_progress_ratio": ((0.333,), _NO_LIMITS),
    "maxvolume_length": ((-1, -1.0), "maxvolume is what there is"),
    **{name: (default, _OWN_OPTIMIZER) for name, default in (
        ("opt_max_flip_level", (3,)), ("opt_scheme", (7,)), ("opt_iterations", (3,)), ("smooth_cirterion", (1,)), ("smooth_maxiter", (7,)),
        ("smooth_alpha", (0.3,)), ("optmaxdihedral", (165, 165.0)), ("optminsmtdihed", (179, 179.0)), ("optminslidihed", (179, 179.0)))},
}
# A regular tetrahedron with edges h has the circumradius sqrt(6)/4 h.
_RADIUS_OF_EDGE = 6 ** 0.5 / 4


class Tetrahedralization:
    """What `tetrahedralize` returns; `nodes, elems = ...` unpacks it. Immutable; any thread.

    nodes (n, 3) float64, elems (m, 4) int32, positively oriented. `points` and `elements` are the same, by the names of meshpy;
    `faces` (k, 3) and `face_markers` (k,) are those of the surface and the facets inside; `attributes` (m,) the labels of the cells;
    `mesh` is the pgdr.Mesh.
    """

    def __init__(self, mesh: Mesh) -> None:
        self.mesh = mesh
        self.nodes: npt.NDArray[np.float64] = mesh.points
        self.elems: npt.NDArray[np.int32] = np.array(mesh.cells)

    def __iter__(self) -> Iterator[npt.NDArray[Any]]:
        yield self.nodes
        yield self.elems

    def __len__(self) -> int:
        return 2

    def __getitem__(self, index: int) -> npt.NDArray[Any]:
        return (self.nodes, self.elems)[index]

    @property
    def points(self) -> npt.NDArray[np.float64]:
        return self.nodes

    @property
    def elements(self) -> npt.NDArray[np.int32]:
        return self.elems

    @property
    def faces(self) -> npt.NDArray[np.int32]:
        return np.array(self.mesh.subfacets)

    @property
    def face_markers(self) -> npt.NDArray[np.int32]:
        return self.mesh.subfacet_markers

    @property
    def attributes(self) -> npt.NDArray[np.float64]:
        return self.mesh.regions

    def __repr__(self) -> str:
        return f"<pgdr.Tetrahedralization: {len(self.nodes)} nodes, {len(self.elems)} elems>"


def _switches(text: str) -> Dict[str, Any]:
    """Keywords of `tetrahedralize` that TetGen's switches stand for."""
    if not isinstance(text, str):
        raise TypeError(f"switches must be a str, not {type(text).__name__}")
    found: Dict[str, Any] = {"quality": False, "varvolume": False, "regionattrib": False, "optimize": True}
    pattern = r"(.)([0-9.]*(?:e[-+]?[0-9]+)?(?:/[0-9.]*)?)"
    for letter, number in re.findall(pattern, text.replace(" ", "").lstrip("-"), re.DOTALL):
        if letter in _REFUSED:
            raise usage(f"switch {letter} of {text!r}: {_REFUSED[letter]}")
        try:
            if letter == "q":
                found["quality"] = True
                ratio, _, angle = number.partition("/")
                found.update({"minratio": float(ratio)} if ratio else {}, **({"mindihedral": float(angle)} if angle else {}))
            elif letter == "a":
                found.update({"max_volume": float(number)} if number else {"varvolume": True})
            elif letter == "A":
                found["regionattrib"] = True
            elif letter == "S":
                found["steinerleft"] = int(number)
            elif letter == "T":
                found["epsilon"] = float(number)
            elif letter == "O":
                found["optimize"] = number.split("/")[0] not in ("0", "0.")
            elif letter == "C":
                found["docheck"] = True
            elif letter == "Y":
                found["nobisect"] = True
            elif letter in "mrR":
                found[{"m": "metric", "r": "refine", "R": "coarsen"}[letter]] = True
            elif letter not in _WITHOUT_EFFECT:
                raise usage(f"{text!r} has the unknown switch {letter!r}")
        except ValueError as error:
            if hasattr(error, "code"):
                raise
            raise usage(f"switch {letter} of {text!r}: {number!r} is no number") from None
    return found


def _options(points: int, bounded: bool, minratio: Optional[float], mindihedral: Optional[float], max_volume: Optional[float],
             steinerleft: Optional[int], quality: bool, optimize: bool, labels: bool, size: Optional[Field],
             keep: bool) -> Dict[str, Any]:
    """The arguments of pgdr.mesh. `bounded`: regions have largest volumes."""
    sized = max_volume is not None or size is not None
    options: Dict[str, Any] = {"refine": quality or sized or bounded}
    options["optimize"] = optimize and options["refine"]
    options["keep_boundary"] = keep
    if labels:  # volumes without a seed are numbered, and none of them is a void
        options["regions"] = "all"
    if quality:
        options["radius_edge"] = 2.0 if minratio is None else minratio
    elif options["refine"]:  # a volume alone
        options["radius_edge"] = float("inf")
    if mindihedral is not None and _arguments.number("mindihedral", mindihedral) != 0:
        if not options["optimize"]:
            raise usage("a bound on dihedral angles is the optimiser's, which is switched off: leave out one of them (TetGen's q/ and O0)")
        options["min_dihedral"] = mindihedral
    if max_volume is not None:
        options["max_volume"] = max_volume
    if size is not None:
        options["size"] = size
    if steinerleft is not None and _arguments.whole_number("steinerleft", steinerleft, -2**63, 2**63 - 1) >= 0:
        options["max_vertices"] = points + steinerleft
    return options


def _require_neutral(others: Mapping[str, Any]) -> None:
    """Refuses, by name, keywords that would change the mesh."""
    for name, value in others.items():
        if name in _SILENT:
            continue
        if name not in _NEUTRAL:
            raise usage(f"{name} has no equivalent here: see help(pgdr.tetrahedralize) for what there is, and pgdr.mesh")
        taken, instead = _NEUTRAL[name]
        if not any(type(value) in (type(one), int, float) and value == one for one in taken):
            raise usage(f"{name} can only be {taken[0]!r} here, not {value!r}: {instead}")


def _size_on(bgmesh: Any) -> Field:
    """The field of circumradii that a background mesh says, whose points have the edge lengths `target_size`."""
    if not hasattr(bgmesh, "points") or not hasattr(bgmesh, "celltypes"):
        raise TypeError(f"bgmesh must be a pyvista.UnstructuredGrid of tetrahedra, not {type(bgmesh).__name__}")
    cells, kinds = np.asarray(bgmesh.cells, dtype=np.int64), np.asarray(bgmesh.celltypes)
    if (kinds != 10).any() or cells.size != 5 * kinds.size or not kinds.size:
        raise usage("bgmesh must consist of tetrahedra with four corners")
    if "target_size" not in bgmesh.point_data:
        raise usage("bgmesh needs point data target_size: the wanted length of edges at each point")
    lengths = _arguments.values("target_size", np.asarray(bgmesh.point_data["target_size"]), len(bgmesh.points), "points")
    background = Mesh.from_arrays(np.asarray(bgmesh.points, dtype=np.float64), cells.reshape(-1, 5)[:, 1:])
    return sizes_on_mesh(background, lengths * _RADIUS_OF_EDGE, of="points")


def _made(given: Union[Plc, Mesh], asked: Mapping[str, Any], size: Optional[Field], threads: int) -> Tetrahedralization:
    bounded = isinstance(given, Plc) and bool((given.regions[:, 4] > 0).any())
    options = _options(len(given.points), bounded, asked.get("minratio"), asked.get("mindihedral"), asked.get("max_volume"),
                       asked.get("steinerleft"), asked.get("quality", True), asked.get("optimize", True),
                       asked.get("regionattrib", False), size, bool(asked.get("nobisect")))
    required = None
    if isinstance(given, Plc):
        result = mesh(given, threads=threads, **options)
    else:
        options.pop("regions", None)  # a mesh has its labels
        result = (remesh if asked.get("coarsen") else _refine)(given, threads=threads, **options)
        required = None if asked.get("coarsen") else np.ones(len(given.points), dtype=bool)
    if asked.get("docheck"):
        report = check(result, given, required=required)
        if not report:
            raise InputError(f"the mesh does not pass the check: {report}", code="internal")
    return Tetrahedralization(result)


def _old(points: Any, faces: Any) -> Optional[Mesh]:
    """A mesh that is given in the place of a surface; None: none is."""
    if isinstance(points, Mesh):
        return points
    if not hasattr(points, "celltypes") or faces is not None:
        return None
    cells, kinds = np.asarray(points.cells, dtype=np.int64), np.asarray(points.celltypes)
    if (kinds != 10).any() or cells.size != 5 * kinds.size or not kinds.size:
        return None
    labels = {"regions": np.asarray(points.cell_data["region"], dtype=np.float64)} if "region" in points.cell_data else {}
    return Mesh.from_arrays(np.asarray(points.points, dtype=np.float64), cells.reshape(-1, 5)[:, 1:], **labels)


def _asked(switches: Optional[str], asked: Dict[str, Any]) -> Dict[str, Any]:
    """What keywords say that are not None, or what switches say."""
    given = {name: value for name, value in asked.items() if value is not None}
    if switches is None:
        return given
    if given:
        raise usage(f"{', '.join(given)} and switches are two ways to say the same: give one of them")
    return _switches(switches)


def tetrahedralize(points: Any, faces: Any = None, *, markers: Any = None, holes: Any = None, regions: Any = None,
                   minratio: Optional[float] = None, mindihedral: Optional[float] = None, max_volume: Optional[float] = None,
                   maxvolume: Optional[float] = None, steinerleft: Optional[int] = None, quality: Optional[bool] = None,
                   regionattrib: Optional[bool] = None, varvolume: Optional[bool] = None, epsilon: Optional[float] = None,
                   docheck: Optional[bool] = None, nobisect: Optional[bool] = None, optimize: Optional[bool] = None,
                   refine: Optional[bool] = None, coarsen: Optional[bool] = None, bgmesh: Any = None,
                   switches: Optional[str] = None, threads: int = 0, **others: Any) -> Tetrahedralization:
    """3D: fills a closed surface with tetrahedra, called as PyVista's `tetgen` and `meshpy.tet` are. Any thread; other Python threads
    run meanwhile. `pgdr.tetgen.TetGen` is the object of the former.

    Parameters
    ----------
    points : (n, 3) array, or a pgdr.Plc, or a pyvista.PolyData
        The points of the surface; the two latter have faces of their own.
    faces : (m, 3) array, or a list of polygons
        As `facets` of pgdr.Plc.
    markers, holes, regions
        As of pgdr.Plc: regions are rows of x, y, z, attribute, largest volume.
    minratio : float
        Bound on circumradius over shortest edge, 2 by default.
    mindihedral : float
        Least dihedral angle in degrees, at most 35; None or 0: that of pgdr.mesh, 15.
    max_volume, maxvolume : float
        No cell is larger.
    steinerleft : int
        Most points to add; negative: any number.
    quality : bool
        False: no bound on shapes.
    regionattrib : bool
        A label for each enclosed volume, those without a seed numbered.
    varvolume : bool
        False: the largest volumes of regions do not count. They do by default.
    epsilon : float
        The tolerance, times the diagonal of all points.
    docheck : bool
        The result is checked (`pgdr.check`).
    nobisect : bool
        No new points on the surface: `keep_boundary` of pgdr.mesh.
    optimize : bool
        False: no optimiser.
    refine, coarsen : bool
        The first argument is a pgdr.Mesh, or a pyvista.UnstructuredGrid of tetrahedra (with cell data "region"). Its points and walls all
        stay, and points are added where bounds ask (pgdr.refine); or it is meshed anew, as coarse as its shape and the bounds allow
        (pgdr.remesh).
    bgmesh : pyvista.UnstructuredGrid
        Tetrahedra whose points have the data `target_size`, the wanted length h of edges. No circumradius is above that of a regular
        tetrahedron of such edges, 0.61 h, at the cell's centroid.
    switches : str
        TetGen's, which alone count then, beside markers, holes, regions, bgmesh and threads: p, q, q1.5, q1.5/18, a0.1, a (largest
        volumes of regions), A (as regionattrib), S100, T1e-8 (as epsilon), O0 (no optimiser), C (as docheck), Y (as nobisect),
        m (with bgmesh), r (as refine), R (as coarsen).
        z, Q, V, f, e, n, J, d, B, N, E, F, I, g, k, X change nothing. Others are refused.
    threads : int
        As of pgdr.mesh.
    others
        Keywords of TetGen's class that change nothing in the mesh (quiet, verbose, zeroindex, plc, facesout, ...) are taken with any
        value. Those that would change it (order=2, psc, ...) are refused by name, but for the value that asks
        for nothing.

    Raises
    ------
    UsageError
        A keyword or switch that is unknown or has no equivalent, or an array of a wrong shape or type.
    InputError
        What `pgdr.mesh` refuses.

    Examples
    --------
    >>> import pgdr
    >>> points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> nodes, elems = pgdr.tetrahedralize(points, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], switches="p")
    >>> nodes.shape, elems.shape
    ((4, 3), (1, 4))
    """
    _require_neutral(others)
    if max_volume is not None and maxvolume is not None:
        raise usage("max_volume and maxvolume are the same: give one of them")
    asked = _asked(switches, {"minratio": minratio, "mindihedral": mindihedral, "steinerleft": steinerleft, "quality": quality,
                              "max_volume": maxvolume if max_volume is None else max_volume, "regionattrib": regionattrib,
                              "varvolume": varvolume, "epsilon": epsilon, "docheck": docheck, "optimize": optimize,
                              "nobisect": None if nobisect is None else _arguments.flag("nobisect", nobisect),
                              "refine": _arguments.flag("refine", refine) or None if refine is not None else None,
                              "coarsen": _arguments.flag("coarsen", coarsen) or None if coarsen is not None else None})
    size = None if bgmesh is None else _size_on(bgmesh)
    if "metric" in asked and size is None:
        raise usage("switch m needs bgmesh, which says the sizes")
    if not asked.get("refine") and not asked.get("coarsen"):
        return _made(_plc(points, faces, markers, holes, regions, asked), asked, size, threads)
    old = _old(points, faces)
    if old is None or old.dimension != 3 or any(value is not None for value in (markers, holes, regions)):
        raise usage("refine and coarsen (r, R) take a mesh in the place of the surface, a pgdr.Mesh or a pyvista.UnstructuredGrid of "
                    "tetrahedra, and nothing beside it but sizes and bounds")
    if asked.get("varvolume") or asked.get("epsilon") is not None:
        raise usage("a and T without a number are not of meshes: pgdr.refine takes cell_bounds, and tolerance")
    return _made(old, asked, size, threads)


def _plc(points: Any, faces: Any, markers: Any, holes: Any, regions: Any, asked: Mapping[str, Any]) -> Plc:
    if (hasattr(points, "faces") or hasattr(points, "celltypes")) and faces is None:
        points = Plc.from_pyvista(points)
    if isinstance(points, Plc):
        if any(value is not None for value in (faces, markers, holes, regions)):
            raise usage("faces, markers, holes and regions come with points that are an array")
        plc = points
    elif faces is None:
        raise usage("faces are missing: the triangles or polygons of a closed surface. Bare points are not tetrahedralized: add the "
                    "facets of their hull, or of a box around them")
    else:
        rows = None if regions is None else np.array(_arguments.reals("regions", regions))
        if rows is not None and rows.ndim == 2 and rows.shape[1] == 5:
            if not asked.get("varvolume", True):
                rows[:, 4] = 0
            rows[:, 4] = np.maximum(rows[:, 4], 0)
        plc = Plc(points, facets=faces, markers=markers, holes=holes, regions=rows)
    if plc.dimension != 3:
        raise usage("points must have the shape (n, 3)")
    if "epsilon" in asked:
        diagonal = float(np.linalg.norm(np.ptp(plc.points, axis=0)))
        plc = plc.with_tolerance(asked["epsilon"] * diagonal)
    return plc
