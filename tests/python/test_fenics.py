# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes with regions and markers in FEniCS (python3-dolfin of Debian 12), by meshio and XDMF. Skipped where one of the two is missing."""
import os
import tempfile
import unittest

import numpy as np

import pgdr

try:
    import dolfin
    import meshio
except ImportError:
    dolfin = None

LEFT, RIGHT, SIDES, BETWEEN = 1, 2, 3, 4  # markers
CONDUCTIVITY = {1: 1.0, 2: 4.0}  # by label
BREAK = 0.375  # where the one region ends


def halves(dimension):
    """The unit square or cube: label 1 where x is below BREAK, 2 above."""
    if dimension == 2:
        points = [[0, 0], [BREAK, 0], [1, 0], [1, 1], [BREAK, 1], [0, 1]]
        segments = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 0], [1, 4]]
        return pgdr.Plc(points, segments=segments, markers=[SIDES, SIDES, RIGHT, SIDES, SIDES, LEFT, BETWEEN],
                        regions=[[0.1, 0.5, 1, 0], [0.9, 0.5, 2, 0]])
    points = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, BREAK, 1)]
    facets = [[0, 3, 9, 6], [2, 5, 11, 8], [1, 4, 10, 7], *([k, k + 1, k + 1 + step, k + step] for k in (0, 1) for step in (3, 6)),
              *([k + 3, k + 4, k + 10, k + 9] for k in (0, 1)), *([k + 6, k + 7, k + 10, k + 9] for k in (0, 1))]
    return pgdr.Plc(points, facets=facets, markers=[LEFT, RIGHT, BETWEEN] + [SIDES] * 8,
                    regions=[[0.1, 0.5, 0.5, 1, 0], [0.9, 0.5, 0.5, 2, 0]])


def solution(x):
    """Linear in each region, with the same flux."""
    return np.where(x < BREAK, x / CONDUCTIVITY[1], BREAK / CONDUCTIVITY[1] + (x - BREAK) / CONDUCTIVITY[2])


@unittest.skipUnless(dolfin, "FEniCS (dolfin) or meshio is not installed")
class Fenics(unittest.TestCase):
    def read(self, made, dimension, folder):
        """(mesh, labels of cells, markers of facets), by two files of XDMF, one a kind of cells."""
        m = made.to_meshio()
        kinds = ("triangle", "line") if dimension == 2 else ("tetra", "triangle")
        for kind, data in zip(kinds, ("region", "marker")):
            numbers = m.get_cell_data(data, kind).astype(np.int32)
            meshio.write(os.path.join(folder, f"{data}.xdmf"),
                         meshio.Mesh(m.points, [(kind, m.get_cells_type(kind))], cell_data={data: [numbers]}), data_format="XML")
        mesh, read = dolfin.Mesh(), []
        for data, of in (("region", dimension), ("marker", dimension - 1)):
            with dolfin.XDMFFile(os.path.join(folder, f"{data}.xdmf")) as file:
                if data == "region":
                    file.read(mesh)
                values = dolfin.MeshValueCollection("size_t", mesh, of)
                file.read(values, data)
            read.append(dolfin.cpp.mesh.MeshFunctionSizet(mesh, values))
        return mesh, *read

    def test_poisson(self):
        """Two materials, values on two walls by their markers: the solution is linear in each region, and comes out so."""
        for dimension in (2, 3):
            made = pgdr.mesh(halves(dimension), edge_length=0.12)
            with self.subTest(dimension=dimension), tempfile.TemporaryDirectory() as folder:
                mesh, labels, markers = self.read(made, dimension, folder)
                self.assertEqual((mesh.num_cells(), mesh.num_vertices()), (len(made.cells), len(made.points)))
                walls = made.markers if dimension == 2 else made.subfacet_markers
                for number in (LEFT, RIGHT, SIDES, BETWEEN):
                    self.assertEqual((markers.array() == number).sum(), (walls == number).sum())
                for label in CONDUCTIVITY:
                    self.assertEqual((labels.array() == label).sum(), (made.regions == label).sum())
                space = dolfin.FunctionSpace(mesh, "CG", 1)
                dx = dolfin.Measure("dx", domain=mesh, subdomain_data=labels)
                u, v = dolfin.TrialFunction(space), dolfin.TestFunction(space)
                form = sum(value * dolfin.dot(dolfin.grad(u), dolfin.grad(v)) * dx(label) for label, value in CONDUCTIVITY.items())
                fixed = [dolfin.DirichletBC(space, dolfin.Constant(float(solution(x))), markers, number)
                         for x, number in ((0.0, LEFT), (1.0, RIGHT))]
                found = dolfin.Function(space)
                dolfin.solve(form == dolfin.Constant(0) * v * dx, found, fixed, solver_parameters={"linear_solver": "lu"})
                error = found.compute_vertex_values(mesh) - solution(mesh.coordinates()[:, 0])
                self.assertLess(np.abs(error).max(), 1e-10)
                volume = dolfin.assemble(dolfin.Constant(1) * dx(1))
                self.assertAlmostEqual(volume, BREAK, places=12)


if __name__ == "__main__":
    unittest.main()
