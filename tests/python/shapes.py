# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs that several tests mesh, and the check that each of their meshes passes."""
import numpy as np

import pgdr

SQUARE_POINTS = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
SQUARE_SEGMENTS = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
CUBE_POINTS = np.array([[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)])
CUBE_FACETS = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]


def square(**more):
    return pgdr.Plc(SQUARE_POINTS, SQUARE_SEGMENTS, **more)


def cube(**more):
    return pgdr.Plc(CUBE_POINTS, facets=CUBE_FACETS, **more)


def checked(test, plc, **options):
    """A mesh that passes the independent checker, with the bounds that it was made with."""
    made = pgdr.mesh(plc, **options)
    report = made.check(plc)
    test.assertTrue(report, report)
    return made


def same(a, b):
    """The same bytes: points, cells, labels and constraints."""
    return all(np.array_equal(getattr(a, name), getattr(b, name)) and getattr(a, name).dtype == getattr(b, name).dtype
               for name in ("points", "cells", "regions", "point_markers", "subsegments", "subsegment_markers", "subfacets",
                            "subfacet_markers", "point_of_input"))
