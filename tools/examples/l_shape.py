#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Solve, estimate, remesh: the Laplace equation in an L, whose solution r^(2/3) sin(2/3 phi) has a singular gradient at the inner
corner. Each round asks for two thirds of the error. Prints what came of the rounds: with linear elements the error falls as the root
of the number of unknowns, as it does for smooth solutions on uniform meshes; on uniform meshes it would fall by its cube root here.

Usage: l_shape.py [ROUNDS [MESH]]     (needs scipy; MESH: where the last mesh goes)
"""
import sys

import numpy as np

import adaptive
import pgdr

CORNERS = np.array([[0, 0], [1, 0], [1, 1], [-1, 1], [-1, -1], [0, -1]], dtype=float)

source = None


def exact(points):
    """The solution, and its gradient."""
    x, y = points[:, 0], points[:, 1]
    r, phi = np.hypot(x, y), np.mod(np.arctan2(y, x), 2 * np.pi)
    with np.errstate(divide="ignore", invalid="ignore"):
        radial = 2 / 3 * r**(-1 / 3)
        gradient = np.stack([-radial * np.sin(phi / 3), radial * np.cos(phi / 3)], axis=1)
    return r**(2 / 3) * np.sin(2 / 3 * phi), gradient


def rounds(count):
    plc = pgdr.Plc(CORNERS, [[i, (i + 1) % 6] for i in range(6)], markers=[1, 2, 3, 4, 5, 6])
    return adaptive.rounds(plc, sys.modules[__name__], count, 2 / 3, min_angle=28, edge_length=0.3)


if __name__ == "__main__":
    last = adaptive.show(rounds(int(sys.argv[1]) if len(sys.argv) > 1 else 10), 2)
    if len(sys.argv) > 2:
        last.mesh.write(sys.argv[2])
