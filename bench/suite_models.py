# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The models of the suite, and the same demand in the words of each program.

Sizes are chosen so that the programs make about the same number of cells: pgdr's are bounds on the circumradius (3D) or the
area (2D), TetGen's on the volume, gmsh's are lengths of edges. `size` is for a workstation, `quick` for a test.
"""
import dataclasses
import pathlib
import shutil
import sys
import typing

import bat
import models
from made_inputs import write_cube, write_million

ROOT = pathlib.Path(__file__).resolve().parent.parent
GRADING = "(1 + 20.5*sqrt((x^2 + y^2 + z^2)/3))"  # volumes over four orders of magnitude


@dataclasses.dataclass(frozen=True)
class Model:
    name: str
    title: str
    size: float              # of pgdr; 0: none
    quick: float             # 0: its surface alone is too large for a quick run
    file: tuple = ()         # names, in the folder of models or in the tree; none: `write` makes it
    expression: str = ""     # times the size
    dimension: int = 3
    volume: float = 0        # TetGen's bound over size^3; 0: not run
    edge: float = 0          # gmsh's edge over size; 0: not run
    geo: tuple = ()          # how gmsh is told: (name of the way, file)
    background: float = 0    # TetGen's edge over size, by a background mesh
    usual: bool = True       # run if no model is named
    write: typing.Callable | None = None  # writes the input to a path, which ends with `suffix`
    suffix: str = ".poly"

    def pgdr_flags(self, size):
        bound = f"{size:.9g}*{self.expression}" if self.expression else f"{size:.9g}"
        shape = ["--min-angle", "20.7"] if self.dimension == 2 else ["--radius-edge", "2"]
        return (["--size", bound] if size else []) + shape

    def tetgen_switches(self, size):
        return "-pq2" + (f"a{self.volume * size ** 3:.12f}" if size else "") + "BF"


CUBE = {"write": write_cube, "volume": 0.4097, "edge": 0.948, "geo": (("", "cube.geo"),)}
SURFACE = {"volume": 0.4097, "edge": 0.93, "geo": (("surface kept", "surface.geo"), ("surface meshed anew", "remesh.geo"))}
PLANAR = "tests/models/planar/"
PIPE = {"dimension": 2, "file": (PLANAR + "pipe_like.poly",), "expression": "(sqrt((x - 200)^2 + (y - 200)^2) + 1)"}


def surface_file(name):
    return f"surfaces/{name}", name


MODELS = [
    Model("cube", "unit cube, 1.9 million", 0.0135, 0.1, **CUBE),
    Model("graded", "unit cube, four orders of magnitude of volume", 0.0014, 0.02, expression=GRADING, background=1.0, edge=0.936,
          geo=(("", "graded.geo"),), write=write_cube),
    Model("elephant", "elephant (CGAL)", 0.0061, 0.05, surface_file("cgal_elephant.off") + ("elephant.off",), **SURFACE),
    Model("armadillo", "armadillo (CGAL)", 1.27, 0, surface_file("cgal_armadillo.off") + ("armadillo.off",), **SURFACE),
    Model("square", "2D: square with 1000 points", 5e-7, 1e-3, (PLANAR + "square1000.poly",), dimension=2),
    Model("pipe", "2D: section of a pipe, graded", 1e-3, 0.3, **PIPE),
    Model("cube02", "unit cube, 0.2 million", 0.029, 0.2, usual=False, **CUBE),
    Model("cube10", "unit cube, 10 million", 0.0078, 0.09, usual=False, **CUBE),
    Model("cube30", "unit cube, 30 million", 0.00538, 0.08, usual=False, **CUBE),
    Model("square30", "2D: square with 1000 points, 30 million", 5.1e-8, 1e-4, (PLANAR + "square1000.poly",), dimension=2,
          usual=False),
    Model("pipe16", "2D: section of a pipe, 16 million", 1e-4, 0.3, usual=False, **PIPE),
    Model("bat", "thin wings in a box of air, 5.8 million", 1, 6, usual=False, expression=f"({bat.size_expression()})", write=bat.write_poly),
    Model("million", "ball of a million triangles", 0, 0, usual=False, write=write_million, suffix=".off", **SURFACE),
    Model("fandisk", "fandisk (CGAL)", 0.01, 0.1, surface_file("cgal_fandisk.off"), usual=False, **SURFACE),
    Model("nefertiti", "Nefertiti (Oded Stein)", 0, 0, surface_file("oded_nefertiti-lowres.obj"), usual=False, **SURFACE),
    Model("bunny00", "Stanford bunny (CGAL)", 0, 0, surface_file("cgal_bunny00.off"), usual=False, **SURFACE),
]


def input_of(model, folder, made):
    """The input's file; None where it is not there. `folder`: of models that are not in the tree; `made`: of those that are written."""
    if not model.file:
        path = made / (model.name + model.suffix)
        model.write(path)
        return path
    places = [pathlib.Path(place) / name for name in model.file for place in (folder, ROOT) if place]
    return next((path for path in places if path.is_file()), None)


def inputs_of(models_wanted, folder, made):
    """{name: file} of the models that are there; the others are named on stderr and left out."""
    inputs = {}
    for model in models_wanted:
        path = input_of(model, folder, made)
        if path:
            inputs[model.name] = path.resolve()
        else:
            print(f"{model.name} is left out: no {model.file[-1]} in --model-folder or $PGDR_MODELS", file=sys.stderr)
    return inputs


def for_peers(source, folder):
    """A copy of an input in a format that the other programs read."""
    if source.suffix == ".obj":
        return models.as_off(*models.surface(source), folder / (source.stem + ".off"))
    return pathlib.Path(shutil.copy(source, folder))


def write_background(stem, edge, steps):
    """TetGen's background mesh of the graded cube: a grid of cubes, six tetrahedra each, edge lengths at its points."""
    n = steps + 1
    points = [(x / steps, y / steps, z / steps) for z in range(n) for y in range(n) for x in range(n)]
    at = lambda x, y, z: (z * n + y) * n + x
    cells = []
    for x in range(steps):
        for y in range(steps):
            for z in range(steps):
                for a, b in ((0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)):  # along axis a, then b, then the third
                    p = [x, y, z]
                    path = [at(*p)]
                    for axis in (a, b, 3 - a - b):
                        p[axis] += 1
                        path.append(at(*p))
                    cells.append(path)
    size = lambda p: edge * (1 + 20.5 * (sum(c * c for c in p) / 3) ** 0.5)
    pathlib.Path(f"{stem}.b.node").write_text(
        f"{len(points)} 3 0 0\n" + "".join(f"{i} {p[0]:.9g} {p[1]:.9g} {p[2]:.9g}\n" for i, p in enumerate(points)))
    pathlib.Path(f"{stem}.b.ele").write_text(
        f"{len(cells)} 4 0\n" + "".join(f"{i} {' '.join(map(str, c))}\n" for i, c in enumerate(cells)))
    pathlib.Path(f"{stem}.b.mtr").write_text(f"{len(points)} 1\n" + "".join(f"{size(p):.9g}\n" for p in points))


def off_to_msh(source, target):
    """A surface as gmsh merges it: msh 2.2, without physical groups."""
    words = " ".join(line.split("#")[0] for line in pathlib.Path(source).read_text().splitlines()).split()
    if words[0] != "OFF":
        raise ValueError(f"{source}: not an .off file")
    n, faces, at = int(words[1]), int(words[2]), 4
    points = [words[at + 3 * i:at + 3 * i + 3] for i in range(n)]
    at += 3 * n
    triangles = []
    for _ in range(faces):
        ids = [int(w) + 1 for w in words[at + 1:at + 1 + int(words[at])]]
        at += 1 + len(ids)
        triangles += [(ids[0], ids[k], ids[k + 1]) for k in range(1, len(ids) - 1)]
    rows = ["$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes", str(n)] + [f"{i} {' '.join(p)}" for i, p in enumerate(points, 1)]
    rows += ["$EndNodes\n$Elements", str(len(triangles))]
    rows += [f"{i} 2 2 0 1 {t[0]} {t[1]} {t[2]}" for i, t in enumerate(triangles, 1)] + ["$EndElements\n"]
    pathlib.Path(target).write_text("\n".join(rows))
