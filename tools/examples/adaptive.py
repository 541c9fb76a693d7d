# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What l_shape.py and fichera.py have in common: linear elements for the Poisson equation, an estimate of the error, and rounds of
solving, estimating and remeshing. Needs scipy.

A problem has `exact`, which gives the solution and its gradient at (n, D) points, and `source`, minus the Laplacian, or None if that is 0.
"""
from typing import NamedTuple

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

import pgdr

# Points of a cell by their weights of the corners, which integrate polynomials of the second degree; all count the same.
QUADRATURE = {2: np.full((3, 3), 1 / 6) + np.eye(3) / 2,
              3: np.full((4, 4), (5 - 5**0.5) / 20) + np.eye(4) * 5**0.5 / 5}


class Round(NamedTuple):
    unknowns: int
    error: float     # of the gradient, in the mean square
    estimate: float
    mesh: pgdr.Mesh


def elements(mesh):
    """Gradients (m, D + 1, D) of the basis functions of each cell, and its measure."""
    corners = mesh.points[mesh.cells]
    edges = corners[:, 1:] - corners[:, :1]
    others = np.linalg.inv(edges).transpose(0, 2, 1)
    basis = np.concatenate([-others.sum(axis=1, keepdims=True), others], axis=1)
    return basis, np.linalg.det(edges) / (2 if mesh.dimension == 2 else 6)


def conjugate_gradients(matrix, right):
    """By the diagonal; scipy's has other arguments from version to version."""
    x, rest, scale = np.zeros(len(right)), right.copy(), 1 / matrix.diagonal()
    along = scale * rest
    size = first = rest @ along
    while size > 1e-20 * first:
        image = matrix @ along
        step = size / (along @ image)
        x += step * along
        rest -= step * image
        before, size = size, rest @ (scale * rest)
        along = scale * rest + size / before * along
    return x


def solve(mesh, problem):
    """Values at the points; the boundary has those of the exact solution. Also gradients of the cells, and their measures."""
    basis, measures = elements(mesh)
    local = np.einsum("nik,njk,n->nij", basis, basis, measures)
    count = mesh.dimension + 1
    rows, columns = np.repeat(mesh.cells, count, axis=1).ravel(), np.tile(mesh.cells, count).ravel()
    matrix = scipy.sparse.csr_matrix((local.ravel(), (rows, columns)), shape=(len(mesh.points),) * 2)
    load = np.zeros(len(mesh.points))
    if problem.source is not None:
        for weights in QUADRATURE[mesh.dimension]:
            density = problem.source(np.einsum("i,nik->nk", weights, mesh.points[mesh.cells])) * measures / count
            np.add.at(load, mesh.cells, density[:, None] * weights)
    outer = np.unique(mesh.subsegments if mesh.dimension == 2 else mesh.subfacets)
    inner = np.setdiff1d(np.arange(len(mesh.points)), outer)
    u = problem.exact(mesh.points)[0]
    inside, right = matrix[inner][:, inner].tocsr(), load[inner] - matrix[inner][:, outer] @ u[outer]
    if mesh.dimension == 2:
        u[inner] = scipy.sparse.linalg.spsolve(inside.tocsc(), right)
    else:  # a factor of a matrix in 3D has many times its entries
        u[inner] = conjugate_gradients(inside, right)
    return u, np.einsum("nik,ni->nk", basis, u[mesh.cells]), measures


def error_of(mesh, problem, gradients, measures):
    total = 0.0
    for weights in QUADRATURE[mesh.dimension]:
        off = problem.exact(np.einsum("i,nik->nk", weights, mesh.points[mesh.cells]))[1] - gradients
        total += (measures * (off**2).sum(axis=1)).sum() / (mesh.dimension + 1)
    return np.sqrt(total)


def estimate(mesh, problem, gradients, measures):
    """Of each cell: by the jumps of the gradient's normal component at its faces, and the source in it. The factors bring it near the
    error in these problems."""
    beyond, points = mesh.neighbors(), mesh.points[mesh.cells]
    eta = np.zeros(len(mesh.cells))
    for i in range(mesh.dimension + 1):
        face = np.delete(points, i, axis=1)
        normal = face[:, 1] - face[:, 0] if mesh.dimension == 2 else np.cross(face[:, 1] - face[:, 0], face[:, 2] - face[:, 0]) / 2
        if mesh.dimension == 2:
            normal = normal[:, ::-1] * [1, -1]
        area = np.linalg.norm(normal, axis=1)  # and the normal is as long
        jump = np.where(beyond[:, i] >= 0, ((gradients - gradients[beyond[:, i]]) * normal).sum(axis=1) / area, 0)
        eta += jump**2 * area**(mesh.dimension / (mesh.dimension - 1)) / 24
    if problem.source is not None:
        eta += (problem.source(points.mean(axis=1)) * measures**(1 / mesh.dimension))**2 * measures / 24
    return np.sqrt(eta)


def at_points(mesh, sizes):
    """At each point as many cells a volume as its cells ask for on average. The smallest size of these, as remesh(cell_sizes=...) takes it,
    makes three times as many cells in 3D as the error asks for."""
    density, cells = np.zeros(len(mesh.points)), np.zeros(len(mesh.points))
    power = 1 if mesh.dimension == 2 else 3  # sizes are areas in 2D, lengths in 3D
    np.add.at(density, mesh.cells, (1 / sizes**power)[:, None])
    np.add.at(cells, mesh.cells, 1)
    return (np.maximum(cells, 1) / density)**(1 / power)


def rounds(plc, problem, count, reduction, **options):
    """A Round each: the next mesh is to have so much of the error. `options`: of the first mesh, and but for edge_length of all."""
    mesh = pgdr.mesh(plc, **options)
    options.pop("edge_length", None)
    for _ in range(count):
        u, gradients, measures = solve(mesh, problem)
        eta = estimate(mesh, problem, gradients, measures)
        total = np.sqrt((eta**2).sum())
        yield Round(len(u), error_of(mesh, problem, gradients, measures), total, mesh)
        sizes = at_points(mesh, pgdr.sizes_from_error(mesh, eta, reduction * total))
        mesh = pgdr.remesh(mesh, point_sizes=sizes, **options)


def show(made, dimension):
    """Prints the rounds as they come, with the constant of the optimal rate. Returns the last."""
    print(f"unknowns     error  estimate  error * unknowns^(1/{dimension})")
    for r in made:
        print(f"{r.unknowns:8} {r.error:9.5f} {r.estimate:9.5f} {r.error * r.unknowns ** (1 / dimension):9.4f}", flush=True)
    return r
