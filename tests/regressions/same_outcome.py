# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Whether copies of an input come to the same as the input: the class of the exit (0 and 1 are one), points, segments and facets, the
labels, their volumes within what the tolerance allows, and what `pgdr check` says. run.py --copies uses this.
"""
import json
import pathlib
import random
import subprocess
import tempfile
from fractions import Fraction

import expect_file
import given_volumes
import input_files
import motions
import shapes

ENTITIES = ("distinct_points", "maximal_segments", "maximal_facets")
DONE = (0, 1)  # every bound is met, or elements stay poor


class Outcome:
    """What became of one input."""

    def __init__(self, command, given, flags, seconds):
        self.complaints, self.volumes, self.report, self.entities, self.ulp, self.given = [], {}, {}, {}, 0, None
        with tempfile.TemporaryDirectory(prefix="pgdr_") as name:
            folder = pathlib.Path(name)
            path, mesh, report = folder / "copy.poly", folder / "out.mesh", folder / "report.json"
            input_files.write_poly(given, path)
            try:
                self.run(command, path, mesh, report, flags, seconds)
            except subprocess.TimeoutExpired as e:
                self.exit = "no end"
                self.complaints.append(f"no end of {e.cmd[1]} in {seconds:g} s")

    def run(self, command, path, mesh, report, flags, seconds):
        def pgdr(*arguments):
            return subprocess.run([command, *map(str, arguments)], capture_output=True, text=True, stdin=subprocess.DEVNULL,
                                  timeout=seconds, check=False)

        done = pgdr("mesh", path, "-o", mesh, "--report", report, "--quiet", *flags)
        self.exit = "meshed" if done.returncode in DONE else done.returncode
        if self.exit != "meshed":
            self.complaints.append(f"mesh ended with {done.returncode}: {done.stderr.strip()[:300]}")
            return
        self.report = json.loads(report.read_text(encoding="utf-8"))
        made = given_volumes.Mesh(mesh)
        self.volumes, self.ulp = made.volumes(), made.ulp()
        try:
            self.given = given_volumes.volumes_given(path, flags)
            self.complaints += given_volumes.complaints_about(self.given, made, self.report)
        except input_files.UnknownInput:
            self.given = None
        pgdr("info", path, "--report", report.with_suffix(".info"), "--quiet", *flags)
        found = json.loads(report.with_suffix(".info").read_text(encoding="utf-8"))["diagnosis"]
        self.entities = {kind: found[kind] for kind in ENTITIES if kind in found}
        checked = pgdr("check", mesh, "--input", path, "--reasons", report)
        if checked.returncode != done.returncode:
            self.complaints.append(f"check ended with {checked.returncode}, mesh with {done.returncode}: {checked.stdout.strip()[-300:]}")


def entities_at(command, given, flags, seconds):
    """The numbers of points, segments and facets alone."""
    with tempfile.TemporaryDirectory(prefix="pgdr_") as name:
        path, report = pathlib.Path(name) / "copy.poly", pathlib.Path(name) / "report.json"
        input_files.write_poly(given, path)
        subprocess.run([command, "info", str(path), "--report", str(report), "--quiet", *flags], capture_output=True, text=True,
                       stdin=subprocess.DEVNULL, timeout=seconds, check=False)
        found = json.loads(report.read_text(encoding="utf-8"))["diagnosis"]
    return {kind: found[kind] for kind in ENTITIES if kind in found}


def undecided(entities, least, most):
    """Whether each number is one of those between: what lies within the tolerance but for rounding may be joined or not."""
    return entities.keys() == least.keys() == most.keys() and all(least[k] <= entities[k] <= most[k] for k in entities)


def differences(first, copy, factor, rounding, meets=True):
    """What is not as with the first outcome. `rounding`: by how much points may have moved from their places. `meets`: what met does."""
    if copy.exit != first.exit:
        yield f"exit {copy.exit}, not {first.exit}"
        return
    if sorted(copy.volumes) != sorted(first.volumes):
        yield f"regions {sorted(copy.volumes)}, not {sorted(first.volumes)}"
        return
    if copy.entities != first.entities and meets:
        yield f"{copy.entities}, not {first.entities}"
    if first.given is None or copy.given is None:
        return
    for label, volume in copy.volumes.items():
        if label not in first.given.volumes:
            continue  # it leaks
        given = first.given.volumes[label]
        dimension = first.report["dimension"]
        scale = Fraction(factor) ** dimension
        size = given.area * factor ** (dimension - 1)
        allowed = size * (copy.report.get("tolerance", 0) + 2 * copy.ulp + rounding) + given.bent * factor ** dimension
        if abs(volume - given.given * scale) > allowed:
            yield f"region {label:g}: {float(volume)!r}, not {float(given.given * scale)!r} +- {allowed:.3g}"


def of_input(command, name, given, flags, seconds, seed, kinds):
    """Complaints about an input and its copies, as (kind, complaint)."""
    first = Outcome(command, given, flags, seconds)
    found = [("as it is", c) for c in first.complaints]
    for kind in kinds:
        copy, factor, rounding, *more = motions.KINDS[kind](given, random.Random(f"{name} {kind} {seed}"))
        outcome = Outcome(command, copy, [*flags, *(more[0] if more else [])], seconds)
        # A piece of two facets is the first one's: in another order there may be more or fewer.
        overlap = any(repair["code"] == "facets_overlap" for repair in first.report.get("repairs", []))
        meets = kind not in motions.MISSING and not (kind == "permuted" and overlap)
        # With a tolerance of its own the copy joins what is that near; the rounding may take from each distance, or add, as much again.
        if more and outcome.entities != first.entities:
            twice = [*flags, "--tolerance", repr(2 * float(more[0][1]))]
            meets = not undecided(outcome.entities, entities_at(command, given, twice, seconds), first.entities)
        wrong = list(differences(first, outcome, factor, rounding, meets))
        wrong += outcome.complaints if first.exit == "meshed" else []
        found += [(f"{kind} {seed}", c) for c in wrong]
    return found


def inputs(names):
    """(name, Input, flags) of files, by the first run of their .expect if they have one, and of made shapes by their names."""
    for name in names:
        if name in shapes.ALL:
            shape = shapes.ALL[name]()
            yield name, shape.input(), shape.flags
        else:
            path = pathlib.Path(name)
            beside = path.with_suffix(".expect")
            yield path.name, input_files.read(path), expect_file.read(beside)[0].flags if beside.exists() else []
