#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Solve, estimate, remesh in 3D: the Poisson equation in a cube without one of its eighths (G. Fichera), whose solution, the fourth root
of the distance, has a singular gradient at the inner corner. Each round asks for four fifths of the error. With linear elements the
error falls as the cube root of the number of unknowns, as it does for smooth solutions on uniform meshes; on uniform meshes it would
fall by its fourth root here.

Usage: fichera.py [ROUNDS [MESH]]     (needs scipy; MESH: where the last mesh goes)
"""
import sys

import numpy as np

import adaptive
import pgdr

POWER = 0.25


def exact(points):
    """The solution, and its gradient."""
    r = np.linalg.norm(points, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        return r**POWER, (POWER * r**(POWER - 2))[:, None] * points


def source(points):
    """Minus the Laplacian."""
    return -POWER * (POWER + 1) * np.linalg.norm(points, axis=1)**(POWER - 2)


def domain():
    """(-1, 1)^3 without [0, 1)^3: six faces of the cube, marked 1 to 6, and three at the inner corner, marked 7."""
    numbers, facets, markers = {}, [], []

    def facet(axis, at, polygon, marker):
        corners = np.insert(np.array(polygon, dtype=float), axis, at, axis=1)
        facets.append([numbers.setdefault(tuple(p), len(numbers)) for p in corners.tolist()])
        markers.append(marker)

    for axis in range(3):
        facet(axis, -1, [(-1, -1), (1, -1), (1, 1), (-1, 1)], 2 * axis + 1)
        facet(axis, 1, [(-1, -1), (1, -1), (1, 0), (0, 0), (0, 1), (-1, 1)], 2 * axis + 2)
        facet(axis, 0, [(0, 0), (1, 0), (1, 1), (0, 1)], 7)
    return pgdr.Plc(list(numbers), facets=facets, markers=markers)


def rounds(count):
    return adaptive.rounds(domain(), sys.modules[__name__], count, 0.7, edge_length=0.5)


if __name__ == "__main__":
    last = adaptive.show(rounds(int(sys.argv[1]) if len(sys.argv) > 1 else 10), 3)
    if len(sys.argv) > 2:
        last.mesh.write(sys.argv[2])
