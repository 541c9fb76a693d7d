# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Names of labels and markers, and several inputs as one."""
import pathlib
import pickle
import tempfile
import unittest
import warnings

import numpy as np

import pgdr

try:
    import meshio
except ImportError:
    meshio = None

CORNERS = np.array([[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)])
QUADS = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]


def box(x, **arguments):
    return pgdr.Plc(CORNERS + [x, 0, 0], facets=QUADS, **arguments)


class Names(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def named(self):
        return box(0, markers=[1, 1, 2, 2, 2, 2], regions=[[0.5, 0.5, 0.5, 7]], marker_names={1: "lids", 2: "K\u00f6rper, around"},
                   region_names={7: "steel"})

    def test_go_through_a_mesh_pickles_and_files(self):
        plc = self.named()
        self.assertEqual(pickle.loads(pickle.dumps(plc)).marker_names, plc.marker_names)
        made = pgdr.mesh(plc, region_sizes={"steel": 0.4})
        self.assertEqual(made.region_names, {7.0: "steel"})
        self.assertEqual(made.marker_names, {1: "lids", 2: "K\u00f6rper, around"})
        self.assertTrue(made.check(plc))
        for again in (pickle.loads(pickle.dumps(made)), pgdr.Plc.from_mesh(made)):
            self.assertEqual((again.region_names, again.marker_names), (made.region_names, made.marker_names))
        for name in ("a.vtu", "a.msh", "a.mesh", "a.ele"):
            with self.subTest(name=name):
                made.write(self.folder / name)
                self.assertEqual(pgdr.Mesh.read(self.folder / name).marker_names, made.marker_names)
        with self.assertWarnsRegex(UserWarning, 'it is "K_rper__around" there'):
            made.write(self.folder / "a.inp")
        with warnings.catch_warnings(record=True):
            made.write(self.folder / "polyMesh")
        self.assertIn("K_rper__around", (self.folder / "polyMesh" / "boundary").read_text())

    def test_what_is_no_name_is_refused(self):
        for arguments in ({"marker_names": {1: ""}}, {"marker_names": {1.5: "a"}}, {"region_names": {"a": 1}}, {"region_names": {1: 2}}):
            with self.subTest(arguments=arguments), self.assertRaises(pgdr.UsageError):
                box(0, **arguments)
        with self.assertRaisesRegex(pgdr.UsageError, "no region is called 'copper'; there are steel"):
            pgdr.mesh(self.named(), region_sizes={"copper": 1})

    def test_several_are_one(self):
        plcs = [box(0), box(1, markers=[3] * 6, marker_names={3: "right one"}), box(2)]
        both = pgdr.Plc.joined(plcs, names=["left", "", "last"])
        self.assertEqual(both.marker_names, {1: "left", 2: "last", 3: "right one"})
        self.assertEqual(both.body_names, ["left", "right one", "last"])
        self.assertEqual(both.facet_bodies.tolist(), [0] * 6 + [1] * 6 + [2] * 6)
        self.assertEqual(pickle.loads(pickle.dumps(both)).body_names, both.body_names)
        made = pgdr.mesh(plcs, regions="all")
        self.assertEqual(len(set(made.regions.tolist())), 3)
        for refused in ([], [box(0), pgdr.Plc([[0, 0], [1, 0], [0, 1]], [[0, 1], [1, 2], [2, 0]])]):
            with self.assertRaises(pgdr.UsageError):
                pgdr.Plc.joined(refused)
        with self.assertRaises(pgdr.UsageError):
            pgdr.Plc.joined(plcs, names=["one"])

    def test_files_are_one(self):
        for name in ("a.off", "b.off"):
            rows = "".join("{} {} {}\n".format(*row) for row in CORNERS + [name == "b.off", 0, 0])
            (self.folder / name).write_text("OFF\n8 6 0\n" + rows + "".join("4 {} {} {} {}\n".format(*quad) for quad in QUADS))
        both = pgdr.Plc.read([self.folder / "a.off", self.folder / "b.off"], tolerance=1e-9)
        self.assertEqual((both.marker_names, both.tolerance), ({1: "a", 2: "b"}, 1e-9))

    @unittest.skipIf(meshio is None, "meshio is not installed")
    def test_meshio_has_sets_and_field_data(self):
        made = pgdr.mesh(self.named(), size=1)
        other = made.to_meshio()
        self.assertEqual({name: pair.tolist() for name, pair in other.field_data.items()},
                         {"lids": [1, 2], "K\u00f6rper, around": [2, 2], "steel": [7, 3]})
        self.assertEqual(len(other.cell_sets["steel"][0]), len(made.cells))
        self.assertEqual(other.cell_sets["lids"][1].tolist(), np.flatnonzero(made.subfacet_markers == 1).tolist())
        self.assertEqual(set(other.cell_data["gmsh:physical"][1].tolist()), {1, 2})
        again = pgdr.Plc.from_meshio(other)
        self.assertEqual((again.region_names, again.marker_names), (made.region_names, made.marker_names))
        other.write(self.folder / "a.msh", file_format="gmsh22")
        self.assertEqual(pgdr.Mesh.read(self.folder / "a.msh").region_names, made.region_names)
        made.write(self.folder / "a.vtu")
        self.assertEqual(sorted(name for name in meshio.read(self.folder / "a.vtu").field_data if name not in ("dimension", "input_points")),
                         sorted(other.field_data))


if __name__ == "__main__":
    unittest.main()
