# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""`dataset.pgdr.mesh(...)` of PyVista 0.48 or later, which finds this module by the entry point `pyvista.accessors` and imports it when
`pgdr` of a data set is asked for."""
from __future__ import annotations

import sys
from typing import Any, List

from ._check import Finding, diagnose
from ._plc import Plc
from ._run import mesh


class Accessor:
    """What pgdr does with a data set of PyVista: a PolyData, or an UnstructuredGrid that is to be meshed again."""

    def __init__(self, dataset: Any) -> None:
        self._dataset = dataset

    def plc(self) -> Plc:
        """The data set as an input, see `pgdr.Plc.from_pyvista`."""
        return Plc.from_pyvista(self._dataset)

    def mesh(self, *, constraints: bool = False, **options: Any) -> Any:
        """Meshes it: options and errors are those of `pgdr.mesh`. Returns a pyvista.UnstructuredGrid, see `pgdr.Mesh.to_pyvista`."""
        return mesh(self.plc(), **options).to_pyvista(constraints)

    def diagnose(self) -> List[Finding]:
        """What is wrong with it, see `pgdr.diagnose`."""
        return diagnose(self.plc())


def register() -> None:
    """Makes it the accessor `pgdr` of all data sets, where PyVista is there and has accessors."""
    pyvista: Any = sys.modules.get("pyvista")
    if hasattr(pyvista, "register_dataset_accessor"):
        pyvista.register_dataset_accessor("pgdr", pyvista.DataSet)(Accessor)


register()
