#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Structure of inputs and defective inputs, through the pgdr command. Usage: test_structure.py [Class[.test]...]

Defective takes tests/models/real/defective, or the folder of that name in PGDR_MODELS."""
import os
import pathlib
import unittest

from test_command import MODELS, Case

REAL_MODELS = pathlib.Path(os.environ.get("PGDR_MODELS", MODELS / "real"))


def boxes_poly(*boxes, holes=(), regions=()):
    """Axis-aligned boxes [low, high]^3 as a .poly; seeds as (x, y, z[, attribute, size])."""
    points, facets = [], []
    for low, high in boxes:
        base = len(points)
        points += [(high if i & 1 else low, high if i & 2 else low, high if i & 4 else low) for i in range(8)]
        facets += [[base + v for v in f] for f in
                   ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6))]
    text = "%d 3 0 0\n" % len(points) + "".join("%d %r %r %r\n" % (i, *p) for i, p in enumerate(points))
    text += "%d 0\n" % len(facets) + "".join("1\n4 %d %d %d %d\n" % tuple(f) for f in facets)
    for seeds in (holes, regions):
        text += "%d\n" % len(seeds) + "".join("%d %s\n" % (i, " ".join(map(repr, s))) for i, s in enumerate(seeds))
    return text


class Regions(Case):
    NESTED = ((0, 8), (1, 7), (2, 6), (3, 5))

    def regions(self):
        """How many labels the mesh has; and that it passes the check made with, or without, the same flag."""
        self.pgdr("info", self.output, "--report", self.report, expect=0)
        return len(self.json()["regions"])

    def test_voids_by_nesting(self):
        nested = self.file("nested.poly", boxes_poly(*self.NESTED))
        self.mesh(nested, "--regions", "auto", "--report", self.folder / "made.json")
        self.assertEqual(self.regions(), 2)
        told = ("check", self.output, "--input", nested, "--radius-edge", 2, "--reasons", self.folder / "made.json")
        self.pgdr(*told, expect=0)
        self.pgdr(*told, "--regions", "seeds", expect=6)
        self.pgdr("check", self.output, "--input", nested, "--radius-edge", 2, "--regions", "auto", expect=0)
        self.pgdr("check", self.output, "--input", nested, "--radius-edge", 2, expect=6)  # voids should be meshed
        self.mesh(nested)
        self.assertEqual(self.regions(), 1)
        self.pgdr("check", self.output, "--input", nested, "--radius-edge", 2, expect=0)
        self.pgdr("check", self.output, "--input", nested, "--radius-edge", 2, "--regions", "auto", expect=6)
        self.mesh(nested, "--regions", "seeds")

    def test_every_enclosed_volume(self):
        """`all` has no voids, and the report tells `check` so; neither of the others passes."""
        nested = self.file("nested.poly", boxes_poly(*self.NESTED))
        self.mesh(nested, "--regions", "all", "--report", self.folder / "made.json")
        self.assertEqual(self.regions(), 4)
        told = ("check", self.output, "--input", nested, "--radius-edge", 2)
        self.pgdr(*told, "--reasons", self.folder / "made.json", expect=0)
        self.pgdr(*told, "--regions", "all", expect=0)
        self.pgdr(*told, "--regions", "auto", expect=6)
        self.mesh(nested)
        self.pgdr(*told, "--regions", "all", expect=6)  # no labels

    def test_volumes(self):
        """`mesh` and `info` of the input have both volumes of each label, `info` of the mesh has one."""
        nested = self.file("nested.poly", boxes_poly(*self.NESTED))
        expected = [{"label": label, "volume_meshed": volume, "volume_given": volume} for label, volume in
                    ((1, 512 - 216), (2, 64 - 8))]
        self.mesh(nested, "--regions", "all", "--report", self.report)
        self.assertEqual([(r["label"], r["volume_meshed"]) for r in self.json()["regions"]],
                         [(1, 512 - 216), (2, 216 - 64), (3, 64 - 8), (4, 8)])
        self.mesh(nested, "--regions", "auto", "--report", self.report)
        self.assertEqual(self.json()["regions"], expected)
        self.pgdr("info", self.output, "--report", self.report, expect=0)
        self.assertEqual(self.json()["regions"], [{**entry, "volume_given": None} for entry in expected])
        self.pgdr("info", nested, "--report", self.report, expect=0)
        self.assertEqual(self.json()["regions"], [{"label": 0, "volume_meshed": 512, "volume_given": 512}])

    def test_seeds_win(self):
        seeded = self.file("seeded.poly", boxes_poly(*self.NESTED, holes=[(0.5, 4.0, 4.0)], regions=[(1.5, 4.0, 4.0, 1, 0)]))
        self.mesh(seeded, "--regions", "auto")
        self.assertEqual(self.regions(), 2)  # the seed's 1, and 2
        self.pgdr("check", self.output, "--input", seeded, "--radius-edge", 2, "--regions", "auto", expect=0)

    def test_a_seed_that_lies_nowhere_is_a_warning(self):
        for at, word in (((9.0, 9.0, 9.0), "outside"), ((0.5, 4.5, 4.0), "hole")):
            odd = self.file("odd.poly", boxes_poly(*self.NESTED, holes=[(0.5, 4.0, 4.0)], regions=[at + (3, 0)]))
            self.mesh(odd, "--report", self.report)
            self.assertIn(word, self.json()["warnings"][0]["message"])
            self.pgdr("check", self.output, "--input", odd, "--radius-edge", 2, expect=0)

    def test_an_open_box_names_its_loop(self):
        whole = boxes_poly((0, 2))
        opened = self.file("open.poly", whole.replace("\n6 0\n", "\n5 0\n").replace("1\n4 4 5 7 6\n", ""))
        for command in (["info"], ["mesh", "-o", self.output]):
            self.pgdr(*command, opened, "--report", self.report, expect=3)
            error = self.json()["errors"][0]
            self.assertEqual(error["code"], "encloses_nothing")
            self.assertEqual(sorted(error["ids"]), [4, 5, 6, 7])
            self.assertEqual(sorted(error["points"]), [[0, 0, 2], [0, 2, 2], [2, 0, 2], [2, 2, 2]])
            self.assertEqual(self.json()["diagnosis"]["open_boundaries"]["count"], 1)

    def test_usage(self):
        done = self.pgdr("mesh", "x.poly", "-o", self.output, "--regions", "every", expect=2)
        self.assertIn("all, auto, disjoint, fragments, priority, seeds, union", done.stderr)


# What is wrong with each, as the first error has it; or None where it is a valid complex; or what is repaired in it.
# `culprits`: ids or a line go with the error (a file that is no mesh at all, or lies in one plane, has none).
INTERSECTS = {"error": "entities_intersect", "culprits": True}
OPEN = {"error": "encloses_nothing", "culprits": True}
DEFECTIVE = {
    "3dbenchy.3mf": {"error": "unknown_format"},
    "admesh_block_nearby-bad.stl": OPEN,
    "assimp_3dsmaxexport.stl": INTERSECTS,
    "assimp_empty.off": {"error": "truncated", "culprits": True},
    "assimp_invalid.off": {"error": "degenerate_facet", "culprits": True},
    "assimp_malformed.obj": {"error": "index_out_of_range", "culprits": True},
    "assimp_outofmemory.off": {"error": "count_too_large", "culprits": True},
    "cgal_alstom_test4.off": INTERSECTS,
    "cgal_bones.off": INTERSECTS,
    "cgal_camel.off": INTERSECTS,
    "cgal_degtri_sliding.off": {"error": "no_volume"},
    "cgal_elephant-with-holes.off": OPEN,
    "cgal_elk.off": INTERSECTS,
    "cgal_man.off": INTERSECTS,
    "cgal_open_cube.off": OPEN,
    "cgal_tetra_intersected_by_triangle.off": INTERSECTS,
    "g3_bunny_overlap_solids.obj": INTERSECTS,
    "g3_duplicate_4tris.obj": {"error": "no_volume"},
    "gc_hourglass_ico.obj": {},
    "gc_triple_vierbein.obj": OPEN,
    "igltest_degenerated.obj": OPEN,
    "manifold_self_intersecta.obj": INTERSECTS,
    "mut_example_badindex.poly": {"error": "index_out_of_range", "culprits": True},
    "mut_joint_count_high.off": {"error": "truncated", "culprits": True},
    "mut_joint_nan.off": {"error": "not_finite", "culprits": True},
    "mut_joint_truncated.off": {"error": "truncated", "culprits": True},
    "mut_spine_truncated.smesh": {"error": "truncated", "culprits": True},
    "openscad_cubes-touching.stl": {},
    "openscad_invalidvertex.stl": {"error": "syntax", "culprits": True},
    "openscad_issue1580-zero-area-triangle.stl": {"repairs": {"point_on_segment", "degenerate_facet"}},
    "trimesh_joined_tetrahedra.obj": {"repairs": {"repeated_facet"}},
    "trimesh_soup.stl": INTERSECTS,
    "trimesh_whitespace.off": {},
    "tritri-00-pp-.smesh": OPEN,
    "tritri-12-pxx.smesh": OPEN,
}


class Defective(Case):
    def test_each_is_refused_with_its_culprits_or_meshed(self):
        folder = REAL_MODELS / "defective"
        names = sorted(f.name for f in folder.iterdir())
        self.assertLessEqual(set(names), set(DEFECTIVE))
        self.assertGreater(len(names), 7)
        for name in names:
            expected = DEFECTIVE[name]
            with self.subTest(name):
                self.refused(folder / name, expected) if "error" in expected else self.meshed(folder / name, expected)

    def refused(self, file, expected):
        self.report.unlink(missing_ok=True)
        self.mesh(file, "--report", self.report, expect=3)
        self.assertFalse(self.output.exists())
        first = self.json()["errors"][0]
        self.assertEqual(first["code"], expected["error"])
        if expected.get("culprits"):
            self.assertTrue(first["ids"] or first["line"])
        if expected in (INTERSECTS, OPEN):
            self.assertTrue(first["points"])
        if expected is OPEN:
            loops = self.json()["diagnosis"]["open_boundaries"]
            self.assertEqual(loops["listed"][0]["ids"], first["ids"])

    def meshed(self, file, expected):
        for mode in ("seeds", "auto"):
            done = self.mesh(file, "--regions", mode, "--report", self.report, expect=None)
            self.assertIn(done.returncode, (0, 1), done.stderr)
            self.assertEqual({r["code"] for r in self.json()["repairs"]}, expected.get("repairs", set()))
            self.pgdr("check", self.output, "--input", file, "--radius-edge", 2, "--regions", mode, "--reasons",
                      self.report, expect=done.returncode)
            self.output.unlink()


if __name__ == "__main__":
    unittest.main()
