# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What a run on ranks should cost: a count of what is done twice, times what it costs once.

Every rank does alone what comes before the cut, and then puts the cells that others have made, where it holds the mesh as well, into
its own. How much it holds is counted on the lattice right above the windows that the schedule ends with, whose claims a rank holds, with
the parts as the schedule makes them (successive nodes of the Morton curve, a layer of half a node around each). Constants are measured on
one machine, with the cube and the square; a fit, no theory.
"""
import itertools

MOST_IN_A_WINDOW = {2: 8000, 3: 4000}  # cells; where there are more the lattice is halved
MADE_A_FINAL_CELL = {2: 1.5, 3: 2.2}  # after the cut, by the visits of others that reach what a rank holds
SHARED_COST = {2: 1.5, 3: 0.7}  # packing, sending and applying a cell, beside making one of the final mesh
NUMBERING_COST = {2: 0.25, 3: 0.15}  # what numbering across ranks costs more than numbering in one process, likewise


def lattice(dimension, cells):
    """Nodes right above the windows, along an axis, of a mesh of so many cells: a power of two, at least two."""
    across = 2
    while (2 * across) ** dimension * MOST_IN_A_WINDOW[dimension] < cells:
        across *= 2
    return across


def morton(place):
    return sum((x >> bit & 1) << (bit * len(place) + axis) for axis, x in enumerate(place) for bit in range(12))


def held_beside_own(dimension, across, ranks):
    """What all ranks together hold of others' parts, as a share of the whole."""
    order = sorted(itertools.product(range(across), repeat=dimension), key=morton)
    owners = {node: i * ranks // len(order) for i, node in enumerate(order)}
    more = 0
    for half in itertools.product(range(2 * across), repeat=dimension):
        near = itertools.product(*({(h - 1) // 2, (h + 1) // 2} for h in half))
        more += len({owners[node] for node in near if node in owners}) - 1
    return more / (2 * across) ** dimension


def efficiency(dimension, cells, ranks, cut_cells):
    """The CPU seconds of one rank over those of all, for the same mesh."""
    if ranks == 1 or not cut_cells:
        return 1 / ranks  # without a cut each rank makes the whole mesh
    applied = MADE_A_FINAL_CELL[dimension] * held_beside_own(dimension, lattice(dimension, cells), ranks)
    again = (ranks - 1) * min(1, cut_cells / cells)
    return 1 / (1 + again + applied * SHARED_COST[dimension] + NUMBERING_COST[dimension])
