# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Random remeshings: meshes of shapes (shapes.py) and random models (random_models.py) with random markers and names, as they are and
turned, become others by random sizes up to four times finer and coarser.

    PYTHONPATH=build/release/python python3 tests/regressions/random_remeshings.py [--count N] [--first SEED]

needs the Python package, and holds of each that 1, 2 and 8 threads make the same mesh; that `check` takes it with its sizes as bounds and
the old mesh as input; that labels, markers and names stay, and volumes but for what the tolerance allows; and that fields come along:
linear ones to 1e-12 of their largest value, amounts of cells to 1e-12 of the sum of their absolute values, label by label. A few are a
test; whoever changes remeshing or transfers runs a hundred.
"""
import argparse
import pathlib
import random
import sys
import tempfile
import time

import numpy as np

import pgdr

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "oracles"))

import input_files
import motions
import random_models
import shapes

ARRAYS = ("points", "cells", "regions", "point_markers", "subsegments", "subsegment_markers", "subfacets", "subfacet_markers",
          "point_of_input")
WORDS = ("wall", "roof", "inlet", "outlet", "floor", "sheet")


def measures(mesh):
    corners = mesh.points[mesh.cells]
    return np.linalg.det(corners[:, 1:] - corners[:, :1]) / (2 if mesh.dimension == 2 else 6)


def sums(mesh, values):
    """By label."""
    amounts = measures(mesh) * values
    return {label: amounts[mesh.regions == label].sum() for label in set(mesh.regions)}


def boundary_measure(mesh):
    """Of the constrained faces, each once: what volumes change by where these move by a length is less than it times this."""
    if mesh.dimension == 2:
        a, b = (mesh.points[mesh.subsegments[:, k]] for k in range(2))
        return np.linalg.norm(b - a, axis=1).sum()
    a, b, c = (mesh.points[mesh.subfacets[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def random_input(rng, folder):
    """-> (what it is called, Plc, options of pgdr.mesh)"""
    kinds = [*shapes.ALL] + [*random_models.KINDS]
    kind = rng.choice(kinds)
    shape = shapes.ALL[kind]() if kind in shapes.ALL else random_models.KINDS[kind](rng)[0]
    shape.pieces = [(*piece[:-1], rng.choice((0, 1, 2, 3, 7))) for piece in shape.pieces]
    given, where = shape.input(), rng.choice(("as it is", "turned"))
    if where == "turned":
        given, _, _ = motions.turned(given, rng)
    path = folder / "model.poly"
    input_files.write_poly(given, path)
    plc = pgdr.Plc.read(path)
    plc = plc.with_names(markers={marker: rng.choice(WORDS) + str(marker) for marker in (1, 2, 3, 7) if rng.random() < 0.7})
    options = {"regions": "auto" if "auto" in shape.flags else rng.choice(("seeds", "all"))}
    return f"{kind}, {where}, {options['regions']}", plc, options


def random_sizes(rng, old, length):
    """-> (what they are called, arguments of remesh for edges): a quarter of a length to four times that."""
    kind = rng.choice(("number", "points", "cells", "nothing"))
    if kind == "number":
        factor = rng.choice((0.25, 0.35, 0.5, 1, 2, 4))
        return f"{factor} of the size", {"edge_length": factor * length}
    if kind == "nothing":
        return "no size", {}
    at = old.points if kind == "points" else old.points[old.cells].mean(axis=1)
    direction = np.array([rng.gauss(0, 1) for _ in range(old.dimension)])
    waves = np.sin((at - at.mean(axis=0)) @ direction / np.ptp(old.points, axis=0).max() * rng.uniform(3, 9))
    sizes = length * 4.0 ** (rng.choice((-1, 1)) * waves)
    more = {"growth": rng.uniform(0.1, 0.5)} if rng.random() < 0.5 else {}
    return f"sizes of {kind}" + (" with growth" if more else ""), {f"{kind[:-1]}_sizes": sizes, "size_unit": "edge", **more}


def bound_of(old, sizes):
    """The size that these arguments mean, as `check` takes it."""
    factor, power = (0.625, 2) if old.dimension == 2 else (0.75, 1)
    if "edge_length" in sizes:
        return factor * sizes["edge_length"] ** power
    for of in ("point", "cell"):
        if f"{of}_sizes" in sizes:
            return pgdr.sizes_on_mesh(old, factor * sizes[f"{of}_sizes"] ** power, of=of + "s")
    return None


def complaints_about_fields(old, new, rng):
    transfer = pgdr.Transfer(old, new)
    gradient = np.array([rng.gauss(0, 1) for _ in range(old.dimension)])
    values = old.points @ gradient + 1
    off = np.abs(transfer.points(values) - new.points @ gradient - 1).max()
    if off > 1e-12 * np.abs(values).max():
        yield f"a linear field is off by {off:.3g} of {np.abs(values).max():.3g}"
    values = np.random.default_rng(rng.randrange(2 ** 32)).normal(size=len(old.cells))
    before, scale, after = sums(old, values), sums(old, np.abs(values)), sums(new, transfer.cells(values))
    for label, amount in before.items():
        if not abs(after[label] - amount) <= 1e-12 * scale[label]:
            yield f"an amount of label {label:g} is {after[label]!r}, not {amount!r}"


def complaints_about(old, sizes, threads, rng):
    news = [pgdr.remesh(old, threads=n, **sizes) for n in threads]
    new = news[0]
    for n, other in zip(threads[1:], news[1:]):
        if not all(np.array_equal(getattr(new, name), getattr(other, name)) for name in ARRAYS):
            yield f"{n} threads make another mesh"
    report = pgdr.check(new, old, size=bound_of(old, sizes))
    if report.exit_code > 1:
        yield f"check: {report}"
    tolerance, area = new.statistics["tolerance"], boundary_measure(old)
    before, after = sums(old, np.ones(len(old.cells))), sums(new, np.ones(len(new.cells)))
    if before.keys() != after.keys():
        yield f"labels {sorted(after)}, not {sorted(before)}"
    for label in before.keys() & after.keys():
        if abs(before[label] - after[label]) > 1e-13 * before[label] + tolerance * area:
            yield f"volume of label {label:g} is {after[label]!r}, not {before[label]!r}"
    if (new.region_names, new.marker_names) != (old.region_names, old.marker_names):
        yield f"names {new.marker_names}, not {old.marker_names}"
    for name in ("subsegment_markers", "subfacet_markers"):
        if not (set(getattr(old, name)) - {0} <= set(getattr(new, name))):
            yield f"{name} {set(getattr(new, name))}, not {set(getattr(old, name))}"
    yield from complaints_about_fields(old, new, rng)


def remeshing(seed, threads):
    """-> (what it was, what is wrong)"""
    rng = random.Random(f"remeshing {seed}")
    with tempfile.TemporaryDirectory(prefix="pgdr_") as name:
        what, plc, options = random_input(rng, pathlib.Path(name))
    length = np.ptp(plc.points, axis=0).max() / (rng.uniform(6, 20) if plc.dimension == 3 else rng.uniform(12, 80))
    try:
        old = pgdr.mesh(plc, edge_length=length, **options)
    except pgdr.InputError as error:  # crossing_boxes: facets that cross are refused
        return f"{what}: refused, {error}", []
    how, sizes = random_sizes(rng, old, length)
    start = time.process_time()
    wrong = list(complaints_about(old, sizes, threads, rng))
    return f"{what}; {how}; {len(old.cells)} cells, {time.process_time() - start:.1f} s", wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=5)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--threads", type=int, nargs="*", default=[1, 2, 8])
    options = parser.parse_args()
    bad = 0
    for seed in range(options.first, options.first + options.count):
        what, wrong = remeshing(seed, options.threads)
        print(f"{seed}: {what}{'' if wrong else ': right'}", flush=True)
        for complaint in wrong:
            print(f"    {complaint}", flush=True)
        bad += bool(wrong)
    print(f"{bad} of {options.count}")
    return 1 if bad or not options.count else 0


if __name__ == "__main__":
    sys.exit(main())
