# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The models of the suite, and the same demand in the words of each program.

Sizes are chosen so that the programs make about the same number of cells: pgdr's are bounds on the circumradius (3D) or the
area (2D), TetGen's on the volume, gmsh's are lengths of edges. `full` is for a workstation, `quick` for a test.
"""
import dataclasses
import pathlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
GRADING = "(1 + 20.5*sqrt((x^2 + y^2 + z^2)/3))"  # volumes over four orders of magnitude


@dataclasses.dataclass(frozen=True)
class Model:
    name: str
    title: str
    size: float              # of pgdr
    quick: float             # 0: its surface alone is too large for a quick run
    file: tuple = ()         # names, in the folder of models or in the tree; none: the cube
    expression: str = ""     # times the size
    dimension: int = 3
    volume: float = 0        # TetGen's bound over size^3; 0: not run
    edge: float = 0          # gmsh's edge over size; 0: not run
    geo: tuple = ()          # how gmsh is told: (name of the way, file)
    background: float = 0    # TetGen's edge over size, by a background mesh
    usual: bool = True       # run if no model is named

    def pgdr_flags(self, size):
        bound = f"{size:.9g}*{self.expression}" if self.expression else f"{size:.9g}"
        return ["--size", bound] + (["--min-angle", "20.7"] if self.dimension == 2 else ["--radius-edge", "2"])


CUBE = {"volume": 0.4097, "edge": 0.948, "geo": (("", "cube.geo"),)}
SURFACE = {"volume": 0.4097, "edge": 0.93, "geo": (("surface kept", "surface.geo"), ("surface meshed anew", "remesh.geo"))}
PLANAR = "tests/models/planar/"
MODELS = [
    Model("cube", "unit cube, 1.9 million", 0.0135, 0.1, **CUBE),
    Model("graded", "unit cube, four orders of magnitude of volume", 0.0014, 0.02, expression=GRADING, background=1.0, edge=0.936,
          geo=(("", "graded.geo"),)),
    Model("elephant", "elephant (CGAL)", 0.0061, 0.05, ("surfaces/cgal_elephant.off", "cgal_elephant.off", "elephant.off"),
          **SURFACE),
    Model("armadillo", "armadillo (CGAL)", 1.27, 0, ("surfaces/cgal_armadillo.off", "cgal_armadillo.off", "armadillo.off"),
          **SURFACE),
    Model("square", "2D: square with 1000 points", 5e-7, 1e-3, (PLANAR + "square1000.poly",), dimension=2),
    Model("pipe", "2D: section of a pipe, graded", 1e-3, 0.3, (PLANAR + "pipe_like.poly",), dimension=2,
          expression="(sqrt((x - 200)^2 + (y - 200)^2) + 1)"),
    Model("cube02", "unit cube, 0.2 million", 0.029, 0.2, usual=False, **CUBE),
    Model("cube10", "unit cube, 10 million", 0.0078, 0.09, usual=False, **CUBE),
    Model("cube30", "unit cube, 30 million", 0.00538, 0.08, usual=False, **CUBE),
    Model("square30", "2D: square with 1000 points, 30 million", 5.1e-8, 1e-4, (PLANAR + "square1000.poly",), dimension=2,
          usual=False),
]


def find(model, folder):
    """The input's file; None where it is not there. `folder`: of models that are not in the tree."""
    for name in model.file:
        for place in filter(None, [folder, ROOT]):
            if (pathlib.Path(place) / name).is_file():
                return pathlib.Path(place) / name
    return None


def write_cube(path):
    corners = [(i & 1, i >> 1 & 1, i >> 2) for i in range(8)]
    sides = ["0 1 3 2", "4 5 7 6", "0 1 5 4", "2 3 7 6", "0 2 6 4", "1 3 7 5"]
    rows = ["8 3 0 0"] + [f"{i} {x} {y} {z}" for i, (x, y, z) in enumerate(corners)]
    rows += ["6 0"] + [f"1\n4 {s}" for s in sides] + ["0", "0"]
    path.write_text("\n".join(rows) + "\n")


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
