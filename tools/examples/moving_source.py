#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""A source that moves round a hole in a plate, and a mesh that follows it: in each step the mesh is made anew for sizes that grow with the
distance from the source, what the source has left comes along, and the source leaves as much again. Prints the cells, and how far what is
there is from what was left.

Usage: moving_source.py [STEPS [MESH.vtu | PICTURE.svg]]     (where the last mesh goes, with the field `left`, or is drawn)
"""
import pathlib
import sys
from typing import NamedTuple

import numpy as np

import pgdr

FINEST, GROWTH, WIDTH = 0.02, 0.25, 0.05


class Step(NamedTuple):
    mesh: pgdr.Mesh
    left: np.ndarray  # on each cell, by area
    amount: float     # of all that was left so far


def plate():
    """A square with a round hole, marked 2."""
    ring = [(0.25 * np.cos(a), 0.25 * np.sin(a)) for a in 2 * np.pi * np.arange(24) / 24]
    loop = lambda first, count: [[first + i, first + (i + 1) % count] for i in range(count)]
    return pgdr.Plc([(-1, -1), (1, -1), (1, 1), (-1, 1), *ring], loop(0, 4) + loop(4, 24), markers=[1] * 4 + [2] * 24, holes=[(0, 0)])


def steps(count):
    mesh, left, amount = pgdr.mesh(plate(), min_angle=28, edge_length=0.2), None, 0.0
    for k in range(count):
        source = 0.6 * np.array([np.cos(2 * np.pi * k / count), np.sin(2 * np.pi * k / count)])
        new = pgdr.remesh(mesh, edge_length=pgdr.sizes_at_points([source], [FINEST], GROWTH), min_angle=28)
        left = np.zeros(len(new.cells)) if left is None else pgdr.Transfer(mesh, new).cells(left)
        corners = new.points[new.cells]
        areas = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 2
        spread = np.exp(-((corners.mean(axis=1) - source)**2).sum(axis=1) / WIDTH**2)
        left = left + spread / (spread * areas).sum()
        amount += 1.0
        mesh = new
        yield Step(mesh, left, amount)


def integral(step):
    corners = step.mesh.points[step.mesh.cells]
    return (np.linalg.det(corners[:, 1:] - corners[:, :1]) / 2 * step.left).sum()


def picture(step, width=450):
    """An SVG of the cells, the darker the more is left there."""
    at = np.round((step.mesh.points * [1, -1] + 1) / 2 * width, 1)
    shades = np.round(255 - 200 * np.clip(step.left / np.quantile(step.left, 0.98), 0, 1)).astype(int)
    paths = ["M" + "L".join(f"{x:g} {y:g}" for x, y in at[cell]) + "z" for cell in step.mesh.cells]
    cells = "\n".join(f'<path fill="#{s:02x}{s:02x}ff" d="{path}"/>' for s, path in zip(shades, paths))
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {width}" stroke="#556" stroke-width="0.3">\n{cells}\n</svg>\n')


if __name__ == "__main__":
    print("cells    left      off")
    for step in steps(int(sys.argv[1]) if len(sys.argv) > 1 else 20):
        print(f"{len(step.mesh.cells):5} {integral(step):7.3f} {integral(step) - step.amount:8.1e}")
    if len(sys.argv) > 2 and sys.argv[2].endswith(".svg"):
        pathlib.Path(sys.argv[2]).write_text(picture(step), encoding="utf-8")
    elif len(sys.argv) > 2:
        pgdr.write_fields(step.mesh, sys.argv[2], cell_data={"left": step.left})
