#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Solve, estimate, remesh: the Laplace equation in an L, whose solution r^(2/3) sin(2/3 phi) has a singular gradient at the inner
corner. Each round asks for two thirds of the error. Prints what came of the rounds: with linear elements the error falls as the root
of the number of unknowns, as it does for smooth solutions on uniform meshes; on uniform meshes it would fall by its cube root here.

Usage: l_shape.py [ROUNDS]     (needs scipy)
"""
import sys

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

import pgdr

CORNERS = np.array([[0, 0], [1, 0], [1, 1], [-1, 1], [-1, -1], [0, -1]], dtype=float)


def exact(points):
    """The solution, and its gradient."""
    x, y = points[:, 0], points[:, 1]
    r, phi = np.hypot(x, y), np.mod(np.arctan2(y, x), 2 * np.pi)
    with np.errstate(divide="ignore", invalid="ignore"):
        radial = 2 / 3 * r**(-1 / 3)
        gradient = np.stack([-radial * np.sin(phi / 3), radial * np.cos(phi / 3)], axis=1)
    return r**(2 / 3) * np.sin(2 / 3 * phi), gradient


def solve(mesh):
    """Linear elements: values at the points, gradients and areas of the cells."""
    p = mesh.points[mesh.cells]
    edges = np.stack([p[:, 2] - p[:, 1], p[:, 0] - p[:, 2], p[:, 1] - p[:, 0]], axis=1)
    areas = 0.5 * np.linalg.det(np.stack([edges[:, 2], -edges[:, 1]], axis=1))
    basis = np.stack([-edges[:, :, 1], edges[:, :, 0]], axis=2) / (2 * areas)[:, None, None]
    local = np.einsum("nik,njk,n->nij", basis, basis, areas)
    rows, columns = np.repeat(mesh.cells, 3, axis=1).ravel(), np.tile(mesh.cells, 3).ravel()
    matrix = scipy.sparse.csr_matrix((local.ravel(), (rows, columns)), shape=(len(mesh.points),) * 2)
    outer = np.unique(mesh.subsegments)
    inner = np.setdiff1d(np.arange(len(mesh.points)), outer)
    u = exact(mesh.points)[0]
    u[inner] = scipy.sparse.linalg.spsolve(matrix[inner][:, inner].tocsc(), -(matrix[inner][:, outer] @ u[outer]))
    return u, np.einsum("nik,ni->nk", basis, u[mesh.cells]), areas


def estimate(mesh, gradients):
    """Of each cell: by the jumps of the gradient's normal component at its edges. The factor brings it near the error here."""
    beyond = mesh.neighbors()
    eta = np.zeros(len(mesh.cells))
    for i in range(3):
        a, b = mesh.points[mesh.cells[:, (i + 1) % 3]], mesh.points[mesh.cells[:, (i + 2) % 3]]
        along = b - a
        jump = np.where((beyond[:, i] >= 0)[:, None], gradients - gradients[beyond[:, i]], 0)
        eta += 0.5 * (jump[:, 0] * along[:, 1] - jump[:, 1] * along[:, 0])**2  # (jump . n)^2 times the length twice
    return np.sqrt(eta / 12)


def rounds(count):
    """(unknowns, error in energy, estimate, mesh) of each."""
    plc = pgdr.Plc(CORNERS, [[i, (i + 1) % 6] for i in range(6)], markers=[1, 2, 3, 4, 5, 6])
    mesh = pgdr.mesh(plc, min_angle=28, edge_length=0.3)
    for _ in range(count):
        u, gradients, areas = solve(mesh)
        eta = estimate(mesh, gradients)
        off = exact(mesh.points[mesh.cells].mean(axis=1))[1] - gradients
        yield len(u), np.sqrt((areas * (off**2).sum(axis=1)).sum()), np.sqrt((eta**2).sum()), mesh
        sizes = pgdr.sizes_from_error(mesh, eta, 2 / 3 * np.sqrt((eta**2).sum()))
        mesh = pgdr.remesh(mesh, cell_sizes=sizes, min_angle=28)


if __name__ == "__main__":
    print("unknowns     error  estimate  error * sqrt(unknowns)")
    for unknowns, error, estimated, _ in rounds(int(sys.argv[1]) if len(sys.argv) > 1 else 10):
        print(f"{unknowns:8} {error:9.5f} {estimated:9.5f} {error * np.sqrt(unknowns):9.4f}")
