# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What a NAME.expect says. README.md has the keys."""
import dataclasses
import pathlib
import re

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
MEASURE = re.compile(rf"({NUMBER})(?:\s*\+-\s*({NUMBER}))?")
REGION = re.compile(rf"({NUMBER})\s*=\s*({MEASURE.pattern})")
COPIES = ("turned", "rounded", "shifted")
# Flags that are lengths, areas or volumes: a copy of another size would need others.
LENGTHS = {"--size", "--region-size", "--size-mesh", "--size-growth", "--max-volume", "--min-edge", "--tolerance"}
SAME_SIZE = {"rounded"}
# Flags that the driver gives itself.
OURS = {"-o", "--output", "--report", "--threads", "--trace", "--quiet"}


class ExpectError(Exception):
    """A NAME.expect that does not say what is expected."""


@dataclasses.dataclass
class Measure:
    """A volume, or an area in 2D, and by how much a mesh may be off it."""
    value: float
    tolerance: float

    def scaled(self, factor):
        return Measure(self.value * factor, self.tolerance * factor)

    def has(self, value):
        return abs(value - self.value) <= self.tolerance

    def __str__(self):
        return f"{self.value:.12g} +- {self.tolerance:.3g}"


@dataclasses.dataclass
class Run:
    """One command line and what has to come of it."""
    flags: list = dataclasses.field(default_factory=list)
    exit: tuple = (0,)
    check: tuple = None         # None: what `mesh` ended with
    volume: Measure = None
    regions: dict = None        # label -> Measure; these and no others
    most_cells: int = None
    most_poor: int = None
    most_flat: int = None
    most_not_delaunay: int = None
    reasons: set = None         # these codes and no others
    stop: str = "finished"
    says: list = dataclasses.field(default_factory=list)
    says_not: list = dataclasses.field(default_factory=list)
    report_says: list = dataclasses.field(default_factory=list)
    seconds: float = 120
    threads: tuple = (1, 2, 8)
    copies: tuple = ()

    @property
    def makes_a_mesh(self):
        return not set(self.exit) & {2, 3, 4, 7}


def words(text, allowed=None):
    found = text.replace(",", " ").split()
    for word in found:
        if allowed is not None and word not in allowed:
            raise ExpectError(f"{word!r} is none of {', '.join(allowed)}")
    if not found:
        raise ExpectError("says nothing")
    return found


def numbers(text):
    try:
        return tuple(int(word) for word in words(text))
    except ValueError as e:
        raise ExpectError(f"{text!r} are no whole numbers") from e


def count(text):
    if not text.isdigit():
        raise ExpectError(f"{text!r} is no count")
    return int(text)


def measure(text):
    found = MEASURE.fullmatch(text.strip())
    if not found:
        raise ExpectError(f"{text!r} is no VALUE or VALUE +- TOLERANCE")
    value = float(found[1])
    return Measure(value, float(found[2]) if found[2] else 1e-6 * abs(value))


def region_list(text):
    regions = {}
    for part in text.split(";"):
        found = REGION.fullmatch(part.strip())
        if not found:
            raise ExpectError(f"{part.strip()!r} is no LABEL = VALUE or LABEL = VALUE +- TOLERANCE")
        if float(found[1]) in regions:
            raise ExpectError(f"label {found[1]} twice")
        regions[float(found[1])] = measure(found[2])
    return regions


def pattern(text):
    try:
        return re.compile(text)
    except re.error as e:
        raise ExpectError(f"{text!r} is no regular expression: {e}") from e


def seconds(text):
    if not re.fullmatch(NUMBER, text) or float(text) <= 0:
        raise ExpectError(f"{text!r} are no seconds")
    return float(text)


def flags(text):
    found = text.split()
    for flag in found:
        if flag.split("=")[0] in OURS:
            raise ExpectError(f"{flag} is the driver's")
    return found


READERS = {
    "flags": flags, "exit": numbers, "check": numbers, "volume": measure, "regions": region_list, "most_cells": count,
    "most_poor": count, "most_flat": count, "most_not_delaunay": count,
    "reasons": lambda text: set() if text == "none" else set(words(text)), "stop": str, "seconds": seconds, "threads": numbers,
    "copies": lambda text: tuple(words(text, COPIES)),
    "says": pattern, "says_not": pattern, "report_says": pattern,
}
REPEATED = {"says", "says_not", "report_says"}


def entries(text):
    """(line, key, value) of each entry: `key: value`, continued by lines that begin with a blank. A key `---` begins a run."""
    found = []
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        if line.strip() == "---":
            found.append([number, "---", ""])
        elif line[0].isspace():
            if not found or found[-1][1] == "---":
                raise ExpectError(f"line {number}: continues nothing")
            found[-1][2] = f"{found[-1][2]} {line.strip()}".strip()
        else:
            key, colon, value = line.partition(":")
            if not colon:
                raise ExpectError(f"line {number}: no `key: value`")
            found.append([number, key.strip(), value.strip()])
    return found


def parse(text):
    """The runs of a NAME.expect."""
    story, runs, given = None, [Run()], set()
    for number, key, value in entries(text):
        if key == "---":
            runs.append(Run())
            given = set()
            continue
        if key in given and key not in REPEATED:
            raise ExpectError(f"line {number}: {key} twice")
        given.add(key)
        if key == "story":
            if len(runs) > 1 or not value:
                raise ExpectError(f"line {number}: the story is told once, at the head")
            story = value
            continue
        if key not in READERS:
            raise ExpectError(f"line {number}: no key is called {key!r}")
        try:
            read = READERS[key](value)
        except ExpectError as e:
            raise ExpectError(f"line {number}: {key}: {e}") from e
        if key in REPEATED:
            getattr(runs[-1], key).append(read)
        else:
            setattr(runs[-1], key, read)
    if story is None:
        raise ExpectError("no story: what did the user do, and what went wrong?")
    for run in runs:
        check_run(run)
    return runs


def check_run(run):
    used = {flag.split("=")[0] for flag in run.flags}
    if set(run.copies) - SAME_SIZE and used & LENGTHS:
        raise ExpectError(f"copies have another size: {', '.join(sorted(used & LENGTHS))} cannot be given")
    if "--time-limit" in used:
        run.threads = run.threads[:1]  # the clock has a say in the mesh
    measured = (run.volume, run.regions, run.most_cells, run.most_poor, run.most_flat, run.most_not_delaunay, run.reasons)
    if run.makes_a_mesh:
        if run.volume is None and run.regions is None:
            raise ExpectError("a volume (2D: an area) or regions are needed: a mesh of anything would pass")
        if run.most_cells is None:
            raise ExpectError("most_cells is needed: a mesh without end would pass")
    elif any(m is not None for m in measured) or run.check is not None:
        raise ExpectError(f"exit {run.exit} leaves no mesh to measure or check")
    elif not run.says and not run.report_says:
        raise ExpectError("what is refused has to say why: says")


def read(path):
    path = pathlib.Path(path)
    if not path.is_file():
        raise ExpectError(f"{path} is missing: it says what is expected of the input beside it")
    try:
        return parse(path.read_text(encoding="utf-8"))
    except ExpectError as e:
        raise ExpectError(f"{path}: {e}") from e
