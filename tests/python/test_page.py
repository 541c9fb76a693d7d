# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Pages that show meshes: Mesh.to_html, Mesh.show. How they look is tested by tests/command/test_view_page.py."""
import base64
import json
import pathlib
import re
import sys
import tempfile
import types
import unittest
from unittest import mock

import numpy as np

import pgdr
from pgdr import _pgdr
from shapes import cube, square

TYPES = {"f32": "<f4", "u8": "u1", "u16": "<u2", "u32": "<u4"}


def contents(path):
    """The JSON of a page, and its arrays by name, with a row each."""
    text = pathlib.Path(path).read_text()
    about = json.loads(re.search(r'id="pgdr-data">(.*?)</script>', text, re.DOTALL).group(1))
    arrays = {}
    for name, row in about["arrays"].items():
        raw = base64.b64decode(re.search(rf'id="pgdr-{name}">([^<]*)<', text).group(1), validate=True)
        arrays[name] = np.frombuffer(raw, TYPES[row["type"]]).reshape(row["rows"], row["components"])
    return about, arrays


@unittest.skipUnless(_pgdr.has_page(), "built without three.js (Debian's package libjs-three)")
class Pages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="pgdr_")
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name) / "mesh.html"

    def test_arrays_are_those_of_the_mesh(self):
        for shape, at in ((square, [0.5, 0.5, 3]), (cube, [0.5, 0.5, 0.5, 3])):
            mesh = pgdr.mesh(shape(regions=[at]), size=0.2)
            page = mesh.to_html(self.path, color="region", title="a <title>")
            self.assertEqual(page.path, self.path)
            about, arrays = contents(self.path)
            self.assertEqual((about["dimension"], about["color"], about["title"]), (mesh.dimension, "region", "a <title>"))
            np.testing.assert_array_equal(arrays["cells"], mesh.cells)
            places = np.array(about["origin"]) + about["scale"] * arrays["points"].astype(float)
            np.testing.assert_allclose(places, mesh.points, atol=about["scale"] * 2**-24)
            labels = np.array([row["label"] for row in about["regions"]])
            np.testing.assert_array_equal(labels[arrays["region"][:, 0]], mesh.regions)
            np.testing.assert_array_equal(arrays["subsegments"], mesh.subsegments)
            self.assertAlmostEqual(arrays["min_angle"].min(), mesh.quality()["min_angle_deg"], places=4)

    def test_fields(self):
        mesh = pgdr.mesh(cube(), size=0.3)
        height, vectors = mesh.points[:, 2], np.arange(3.0 * len(mesh.cells)).reshape(-1, 3)
        mesh.to_html(self.path, color="T", point_data={"T": height, "volume": height}, cell_data={"T": np.arange(len(mesh.cells)), "v": vectors})
        about, arrays = contents(self.path)
        fields = {row["name"]: (row["of"], arrays[row["array"]]) for row in about["fields"]}
        self.assertEqual(sorted(fields), ["T", "T (cells)", "point marker", "v", "volume (points)"])  # no two are called alike
        np.testing.assert_array_equal(fields["T"][1][:, 0], height.astype(np.float32))
        np.testing.assert_array_equal(fields["T (cells)"][1][:, 0], np.arange(len(mesh.cells)))
        np.testing.assert_array_equal(fields["v"][1], vectors)

    def test_refused(self):
        mesh = pgdr.mesh(square())
        for keywords in ({"color": "temperature"}, {"point_data": {"T": [1.0]}}, {"cell_data": {"T": np.zeros((len(mesh.cells), 2, 2))}},
                         {"cell_data": {"T": np.zeros((len(mesh.cells), 0))}}):
            with self.assertRaises(pgdr.UsageError):
                mesh.to_html(self.path, **keywords)
        with self.assertRaises(pgdr.UsageError):
            mesh.to_html(self.path.with_suffix(".svg"))
        with self.assertRaises(pgdr.FileError):
            mesh.to_html(self.path / "no folder" / "mesh.html")
        self.assertFalse(self.path.exists())

    def test_show_opens_the_browser(self):
        mesh = pgdr.mesh(square())
        with mock.patch("importlib.util.find_spec", return_value=None), mock.patch("webbrowser.open") as opened:
            page = mesh.show("T", point_data={"T": mesh.points[:, 0]})
        self.addCleanup(page.path.unlink)
        opened.assert_called_once_with(page.path.as_uri())
        self.assertEqual(contents(page.path)[0]["color"], "T")

    def test_show_in_a_notebook(self):
        mesh = pgdr.mesh(square())
        ipython = types.SimpleNamespace(get_ipython=lambda: types.SimpleNamespace(kernel=object()))
        with mock.patch("importlib.util.find_spec", return_value=None), mock.patch("webbrowser.open") as opened, \
                mock.patch.dict(sys.modules, {"IPython": ipython}):
            page = mesh.show()
        self.addCleanup(page.path.unlink)
        opened.assert_not_called()
        frame = page._repr_html_()
        self.assertTrue(frame.startswith('<iframe srcdoc="'))
        self.assertEqual(frame.count("<"), 2)  # all else is escaped

    def test_show_by_pyvista(self):
        mesh = pgdr.mesh(cube())
        grid = mock.Mock(point_data={}, cell_data={}, n_points=len(mesh.points), n_cells=len(mesh.cells) + 2)
        grid.plot.return_value = "plotted"
        vista = types.SimpleNamespace(UnstructuredGrid=mock.Mock(return_value=grid))
        with mock.patch("importlib.util.find_spec", return_value=object()), mock.patch.dict(sys.modules, {"pyvista": vista}):
            self.assertEqual(mesh.show("T", point_data={"T": mesh.points[:, 0]}, cell_data={"c": np.ones(len(mesh.cells))}), "plotted")
        self.assertEqual(np.isnan(grid.cell_data["c"]).tolist(), [False] * len(mesh.cells) + [True] * 2)
        np.testing.assert_array_equal(grid.point_data["T"], mesh.points[:, 0])
        self.assertEqual(grid.plot.call_args.kwargs["scalars"], "T")


if __name__ == "__main__":
    unittest.main()
