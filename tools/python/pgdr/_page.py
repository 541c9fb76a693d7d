# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""A mesh in a browser, a notebook, or a window of PyVista."""
from __future__ import annotations

import html
import importlib.util
import pathlib
import sys
import tempfile
import webbrowser
from typing import Any, List, Mapping, Optional, Tuple

import numpy as np
import numpy.typing as npt

from . import _arguments, _pgdr
from ._doors import door, through
from ._ending import WORK
from ._errors import usage
from ._mesh import Mesh

Data = Optional[Mapping[str, npt.ArrayLike]]


class Page:
    """A page that shows a mesh: a file, which a notebook shows where this is the value of a cell."""

    def __init__(self, path: pathlib.Path) -> None:
        self.path = path  #: of the .html

    def _repr_html_(self) -> str:
        text = html.escape(self.path.read_text(encoding="utf-8"))
        return f'<iframe srcdoc="{text}" style="width:100%;height:560px;border:1px solid #ccd2da"></iframe>'

    def __repr__(self) -> str:
        return f"<pgdr.Page: {self.path}>"


def _fields(mesh: Mesh, point_data: Data, cell_data: Data) -> List[Tuple[str, bool, npt.NDArray[np.float64]]]:
    fields = []
    for data, of_points, count in ((point_data, True, len(mesh.points)), (cell_data, False, len(mesh.cells))):
        for name, given in (data or {}).items():
            numbers = np.asarray(given, dtype=np.float64)
            if numbers.ndim not in (1, 2) or len(numbers) != count:
                raise usage(f"{'point' if of_points else 'cell'}_data {name!r} must have the shape ({count},) or ({count}, k), not "
                            f"{numbers.shape}")
            fields.append((str(name), of_points, np.ascontiguousarray(numbers.reshape(count, -1))))
    return fields


@door
def to_html(mesh: Mesh, path: _arguments.Path, color: Optional[str], point_data: Data, cell_data: Data, title: Optional[str]) -> Page:
    """See Mesh.to_html."""
    file = _arguments.path(path)
    if not str(file).lower().endswith(".html"):
        raise usage(f"a page is a file .html, not {file}")
    write = _pgdr.write_page2 if mesh.dimension == 2 else _pgdr.write_page3
    fields = _fields(mesh, point_data, cell_data)
    with WORK:
        write(mesh._core, file, pathlib.Path(file).name if title is None else str(title), color or "quality", fields)
    return Page(pathlib.Path(file))


def _is_notebook() -> bool:
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return hasattr(shell, "kernel")


@door
def show(mesh: Mesh, color: Optional[str], point_data: Data, cell_data: Data) -> Any:
    """See Mesh.show."""
    if importlib.util.find_spec("pyvista") is not None:
        grid = through("to_pyvista")(mesh)
        for name, of_points, numbers in _fields(mesh, point_data, cell_data):
            rows = grid.n_points if of_points else grid.n_cells
            padded = np.full((rows, numbers.shape[1]), np.nan)  # of a grid that has constraints, too, behind the cells
            padded[:len(numbers)] = numbers
            (grid.point_data if of_points else grid.cell_data)[name] = padded[:, 0] if numbers.shape[1] == 1 else padded
        return grid.plot(scalars=color, show_edges=True)
    with tempfile.NamedTemporaryFile(prefix="pgdr_", suffix=".html", delete=False) as file:
        pass  # it stays: the browser reads it when it likes
    page: Page = to_html(mesh, file.name, color, point_data, cell_data, "pgdr")
    if not _is_notebook():
        webbrowser.open(page.path.as_uri())
    return page
