# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The errors of pgdr: what went wrong in one sentence, and the data that a program needs beside it."""
from __future__ import annotations

import re
from typing import Any, Callable, List, Match, NamedTuple, Optional, Sequence, Tuple, Type, TypeVar


class Diagnostic(NamedTuple):
    """One error or warning, as data. Numbers of points, segments and facets count from 0, but where they come from a file that
    counts from 1."""

    code: str  #: the kind, a stable word such as "facets_cross"
    message: str  #: one sentence that names the culprit
    ids: Sequence[int] = ()  #: of the culprits, as the message says
    points: Sequence[Sequence[float]] = ()  #: where, (x, y, z) each; z = 0 in 2D
    file: str = ""  #: empty if the input came from memory
    line: int = 0  #: of the file, counted from 1; 0: unknown


# What the command's flags are called here, where it is not their name with another sign between its words.
_CALLS = {"close-planar-openings": "pgdr.close_planar_openings(plc)", "resolve-crossings": "pgdr.resolve_crossings(plc)",
          "convex-hull": "pgdr.with_convex_hull(plc)", "yes-coarse": "coarse=True",
          "no-optimize": "optimize=False", "no-refine": "refine=False", "keep-boundary": "keep_boundary=True"}
_FLAG = re.compile(r"(?<![\w-])--([a-z]+(?:-[a-z]+)*)(?:[ =]([-+]?[0-9][0-9.]*(?:e[-+]?[0-9]+)?"
                   r"|(?:seeds|auto|all|union|fragments|priority|disjoint|uniform|greedy)\b))?")

_BODIES = re.compile(r"--resolve-crossings --regions (union|fragments)")


def in_python(message: str) -> str:
    """A message of the library, which names flags of the command and members of C++, in the words of this package."""
    def call(flag: Match[str]) -> str:
        name, value = flag.groups()
        if name in _CALLS:
            return _CALLS[name] + ("" if value is None else f" {value}")
        keyword = name.replace("-", "_")
        return keyword if value is None else f"{keyword}={value}" if value[0] in "+-0123456789" else f'{keyword}="{value}"'
    message = _BODIES.sub(r'pgdr.with_bodies(plc, "\1", resolve_crossings=True)', message)
    return _FLAG.sub(call, message.replace("--yes-coarse, Plc::is_coarse", "--yes-coarse"))


def diagnostic(code: str, message: str, ids: Sequence[int], points: Sequence[Sequence[float]], file: str, line: int) -> Diagnostic:
    """What the extension module makes of one of the library."""
    return Diagnostic(code, in_python(message), ids, points, file, line)


_E = TypeVar("_E", bound="Error")


class Error(Exception):
    """The base of all errors of pgdr; each is also the error of Python that it resembles.

    >>> import pgdr
    >>> try:
    ...     pgdr.Plc([[0, 0], [1, 0], [0, float("nan")]])
    ... except pgdr.InputError as e:
    ...     print(e.code, e.ids)
    not_finite [2]
    """

    def __init__(self, message: str, *, code: str = "internal", ids: Sequence[int] = (), points: Sequence[Sequence[float]] = (),
                 file: str = "", line: int = 0, diagnostics: Sequence[Diagnostic] = ()) -> None:
        #: The sentence, without file and line.
        self.message: str = message
        #: The kind, a stable word such as "facets_cross".
        self.code: str = code
        #: Numbers of the culprits, as the message says.
        self.ids: List[int] = list(ids)
        #: Where, (x, y, z) each; z = 0 in 2D.
        self.points: List[Tuple[float, ...]] = [tuple(p) for p in points]
        #: As it was opened; empty: the input came from memory.
        self.file: str = file
        #: Of the file, counted from 1; 0: unknown.
        self.line: int = line
        #: All that is wrong with the input, this error among it, where that was looked for: the first twenty of each kind.
        self.diagnostics: List[Diagnostic] = list(diagnostics)
        where = file + (f":{line}" if line else "")
        super().__init__(f"{where}: {message}" if where else message)

    def _add(self, words: str) -> None:
        """One more sentence of what it says."""
        self.message += words
        self.args = (f"{self}{words}",)

    @classmethod
    def _of(cls: Type[_E], d: Diagnostic, all_of_them: Sequence[Diagnostic] = ()) -> _E:
        return cls(d.message, code=d.code, ids=d.ids, points=d.points, file=d.file, line=d.line, diagnostics=all_of_them or [d])

    def __reduce__(self) -> Tuple[Callable[..., Error], Tuple[Any, ...]]:
        return _restored, (type(self), self.message, self.code, self.ids, self.points, self.file, self.line, self.diagnostics)


def _restored(cls: Type[Error], message: str, code: str, ids: Sequence[int], points: Sequence[Sequence[float]], file: str,
              line: int, diagnostics: Sequence[Diagnostic]) -> Error:
    return cls(message, code=code, ids=ids, points=points, file=file, line=line, diagnostics=diagnostics)


class UsageError(Error, ValueError):
    """An argument that cannot be used: a wrong shape, length, type or value, or what a callback returned."""


class InputError(Error, ValueError):
    """An input that cannot be read or meshed. `diagnostics` has all that is wrong with it."""


class DiagnosedError(InputError):
    """Of these, what a diagnosis finds wrong before anything is meshed: what crosses or overlaps, for instance."""


class FileError(Error, OSError):
    """A file that cannot be opened or written."""


class CancelledError(Error):
    """Stopped by a StopSource where there is nothing to return."""


class ResourceError(Error, MemoryError):
    """Memory ran out, or an invariant of pgdr is broken."""


def usage(message: str, ids: Optional[Sequence[int]] = None) -> UsageError:
    """A UsageError with this message."""
    return UsageError(message, code="bad_option", ids=ids or ())
