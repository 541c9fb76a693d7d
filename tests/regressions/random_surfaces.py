# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Random surfaces full of needles, and other surfaces within a tolerance in their place: lathes, prisms, scans, steps, bodies in bodies.

    PGDR_COMMAND=build/release/pgdr python3 tests/regressions/random_surfaces.py [--models N] [--first SEED] [--optimize] [KIND ...]

meshes N models of each kind with `--surface-tolerance`, and holds that `pgdr check` certifies each mesh; that surface and mesh are the same for
1, 2 and 8 threads, and the surface for any order of points, facets and corners; and that a turned copy is certified. Whoever changes how
the surface is made, or certified, runs some hundred; a few are a test.
"""
import argparse
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "oracles"))

import input_files
import motions
from shapes import Shape

COMMAND = os.environ.get("PGDR_COMMAND", "pgdr")


def quadrilateral(rng, a, b, c, d):
    """Its two triangles, by either diagonal."""
    return [(a, b, c), (a, c, d)] if rng.random() < 0.5 else [(a, b, d), (b, c, d)]


def levels(rng, count, length):
    """Ascending numbers, many of which are next to the one before."""
    gaps = [rng.choice((1, 1, 0.05, 0.004)) * rng.uniform(0.5, 1) for _ in range(count)]
    ends = [sum(gaps[:k]) for k in range(count + 1)]
    return [length * x / ends[-1] for x in ends]


def ring(n, radius, height, centre=(0, 0)):
    return [(centre[0] + radius * math.cos(2 * math.pi * k / n), centre[1] + radius * math.sin(2 * math.pi * k / n), height)
            for k in range(n)]


def tube(rng, rings):
    """The triangles between rings of as many points, and caps, fans of one of their points."""
    triangles = []
    for low, high in zip(rings, rings[1:]):
        for k, p in enumerate(low):
            m = (k + 1) % len(low)
            triangles += quadrilateral(rng, p, low[m], high[m], high[k])
    for end in (rings[0][::-1], rings[-1]):
        k = rng.randrange(len(end))
        end = end[k:] + end[:k]
        triangles += [(end[0], *pair) for pair in zip(end[1:], end[2:])]
    return triangles


def lathe(rng):
    """A turned piece, with rings that are next to each other as of fillets."""
    n = rng.randint(5, 40)
    return tube(rng, [ring(n, rng.uniform(0.6, 1), z) for z in levels(rng, rng.randint(3, 9), 2)])


def prism(rng):
    """Walls over an outline with near corners, and caps that are fans."""
    angles = levels(rng, rng.randint(5, 24), 2 * math.pi)[:-1]
    if max(b - a for a, b in zip(angles, [*angles[1:], angles[0] + 2 * math.pi])) > 3:
        angles = [2 * math.pi * k / 8 for k in range(8)]
    outline = [(math.cos(t), math.sin(t)) for t in angles]
    return tube(rng, [[(*p, z) for p in outline] for z in (0, rng.choice((0.02, 0.3, 1)))])


def scan(rng):
    """A ball with bumps and noise, finer than it has to be one way round."""
    n, high, bumps, noise = rng.randint(8, 40), rng.randint(4, 12), rng.uniform(0, 0.1), rng.choice((0, 1e-4, 1e-3))

    def point(t, k):
        u = 2 * math.pi * k / n
        r = 1 + bumps * math.sin(5 * t) * math.cos(3 * u) + rng.uniform(-noise, noise)
        return (r * math.sin(t) * math.cos(u), r * math.sin(t) * math.sin(u), r * math.cos(t))

    return tube(rng, [[point(math.pi * (k + 0.5) / (high + 1), i) for i in range(n)] for k in range(high + 1)][::-1])


def steps(rng):
    """A turned piece with steps and grooves, some of them lower or narrower than the tolerance."""
    n, radius = rng.choice((4, 6, 24)), 0.8
    return tube(rng, [ring(n, radius + rng.choice((0, 0, 0.0005, 0.004, 0.05)), z) for z in levels(rng, rng.randint(5, 16), 1)])


KINDS = {make.__name__: make for make in (lathe, prism, scan, steps)}


def split(rng, triangles, height):
    """Some edges get a point in their middle, off it by up to that height: needles and caps on both sides."""
    for _ in range(rng.randint(0, 6)):
        a, b, _c = rng.choice(triangles)
        m = tuple((x + y) / 2 + rng.uniform(-height, height) for x, y in zip(a, b))
        new = []
        for t in triangles:
            if a in t and b in t:
                new += [tuple(m if p == q else p for p in t) for q in (a, b)]
            else:
                new.append(t)
        triangles = new
    return triangles


def model(kind, seed):
    """-> (input, tolerance, flags)"""
    rng = random.Random(f"{kind} {seed}")
    triangles = split(rng, KINDS[kind](rng), rng.choice((0, 1e-5)))
    shape, markers = Shape(3), rng.choice((1, 1, 3))
    for a, b, c in triangles:
        shape.facet([a, b, c], marker=int(markers * (a[2] + b[2] + c[2] + 3) / 9) if markers > 1 else 0)
    flags = ["--regions", "auto"]
    if seed % 3 == 2 and kind != "prism":  # a void in it
        shape.box((-0.05, -0.05, 0.1), (0.05, 0.05, 0.2))
    return shape.input(), rng.choice(("0.02%", "0.1%", "0.5%")), flags


class Failed(Exception):
    pass


def pgdr(*arguments):
    return subprocess.run([COMMAND, *map(str, arguments)], capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=300,
                          check=False)


def made(folder, given, tolerance, flags, threads):
    """(surface, mesh) as bytes. @throws Failed"""
    path, mesh, surface = (folder / name for name in ("model.poly", "out.mesh", "surface.poly"))
    input_files.write_poly(given, path)
    done = pgdr("mesh", path, "-o", mesh, "--surface-tolerance", tolerance, "--surface-output", surface, "--threads", threads,
                "--report", folder / "report.json", "--quiet", *flags)
    if done.returncode not in (0, 1):
        raise Failed(f"mesh ended with {done.returncode}: {done.stderr.strip()[:300]}")
    return surface.read_bytes(), mesh.read_bytes()


def certify(folder, tolerance):
    done = pgdr("check", folder / "out.mesh", "--input", folder / "model.poly", "--surface-tolerance", tolerance, "--reasons",
                folder / "report.json")
    if done.returncode not in (0, 1):
        raise Failed(f"check ended with {done.returncode}: {done.stdout.strip()[-400:]}{done.stderr}")


def look_at(kind, seed, folder, optimize):
    given, tolerance, flags = model(kind, seed)
    flags += [] if optimize else ["--no-optimize"]
    rng = random.Random(seed)
    one = made(folder, given, tolerance, flags, 1)
    certify(folder, tolerance)
    for threads in (2, 8):
        if made(folder, given, tolerance, flags, threads) != one:
            raise Failed(f"not the same with {threads} threads")
    if made(folder, motions.permuted(given, rng)[0], tolerance, flags, 2)[0] != one[0]:
        raise Failed("another surface for another order of points and facets")
    made(folder, motions.turned(given, rng)[0], tolerance, flags, 2)
    certify(folder, tolerance)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kinds", nargs="*", default=[], help=", ".join(KINDS))
    parser.add_argument("--models", type=int, default=3)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--optimize", action="store_true")
    parser.add_argument("--keep", type=pathlib.Path, help="a folder for the inputs that failed")
    options = parser.parse_args()
    failed = 0
    for kind in options.kinds or KINDS:
        bad = 0
        for seed in range(options.first, options.first + options.models):
            with tempfile.TemporaryDirectory(prefix="pgdr_") as name:
                try:
                    look_at(kind, seed, pathlib.Path(name), options.optimize)
                except Failed as e:
                    bad += 1
                    print(f"{kind} {seed}: {e}", flush=True)
                    if options.keep:
                        options.keep.mkdir(parents=True, exist_ok=True)
                        input_files.write_poly(model(kind, seed)[0], options.keep / f"{kind}_{seed}.poly")
        print(f"{kind}: {bad} of {options.models}", flush=True)
        failed += bad
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
