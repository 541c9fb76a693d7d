# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What a check has found."""
from __future__ import annotations

from typing import Any, Dict, List, NamedTuple, Sequence


class CheckFinding(NamedTuple):
    """Something that is wrong with a mesh."""

    kind: str  #: a stable word such as "inverted_cell"
    message: str  #: one sentence
    ids: Sequence[int]  #: the rows of cells, points or entities that it names


class CheckReport:
    """What a check has found. True where a mesh is sound, conforms to its input, and is over a bound only with a reason.

    `exit_code`: 0: everything holds; 1: cells are over a bound, and the reasons say why, or say that nothing better was found;
    6: anything else. `findings`: the first of what is wrong. The counts: `finding_count`, `over_radius_edge`, `over_size`,
    `below_dihedral`, `explained`, `unexplained`, `not_delaunay_rounding`, `not_delaunay_refused`, `not_delaunay_unexplained`;
    `undecided_volumes`: with a surface tolerance, volumes that are too thin to be told apart by it.
    """

    exit_code: int
    findings: List[CheckFinding]
    finding_count: int
    over_radius_edge: int
    over_size: int
    below_dihedral: int
    explained: int
    unexplained: int
    not_delaunay_rounding: int
    not_delaunay_refused: int
    not_delaunay_unexplained: int
    undecided_volumes: int

    def __init__(self, found: Dict[str, Any]) -> None:
        self.__dict__.update(found)
        self.findings = [CheckFinding(*f) for f in found["findings"]]

    def __bool__(self) -> bool:
        return self.exit_code <= 1

    def __repr__(self) -> str:
        words = ("everything holds", "sound; cells are over a bound")
        over = f"{self.finding_count} findings: " + "; ".join(f.message for f in self.findings[:3])
        return f"<pgdr.CheckReport {self.exit_code}: {words[self.exit_code] if self else over}>"
