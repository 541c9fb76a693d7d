#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Several inputs with names, from STL files to the programs that meshes are for.

A gearbox of ten named solids that touch: its mesh is read with gmsh, meshio, CalculiX and OpenFOAM, where these are installed; a test
that lacks one says so and is skipped. Environment and usage: as test_command.py.
"""
import json
import os
import re
import shutil
import subprocess
import sys
import unittest

from test_command import Case
from test_formats import python_with

sys.dont_write_bytecode = True

# Boxes: the lesser and the greater corner.
GEARBOX = {
    "Base plate": ((0, 0, 0), (10, 6, 1)),
    "Housing left": ((0, 0, 1), (1, 6, 5)),
    "Housing right": ((9, 0, 1), (10, 6, 5)),
    "Cover": ((0, 0, 5), (10, 6, 6)),
    "Input shaft": ((1, 1, 2), (9, 2, 3)),
    "Output shaft": ((1, 4, 2), (9, 5, 3)),
    "Gear A": ((3, 2, 2), (4, 3, 3)),
    "gear a": ((3, 3, 2), (4, 4, 3)),
    "1st bolt": ((1, 1, 6), (2, 2, 7)),
    "Bolt \"2\"": ((8, 4, 6), (9, 5, 7)),
}
ABAQUS = {"Base plate": "Base_plate", "Housing left": "Housing_left", "Housing right": "Housing_right", "Cover": "Cover",
          "Input shaft": "Input_shaft", "Output shaft": "Output_shaft", "Gear A": "Gear_A", "gear a": "gear_a_2",
          "1st bolt": "SET_1st_bolt", "Bolt \"2\"": "Bolt__2_"}


def stl(name, low, high):
    """A box as an ASCII .stl."""
    corner = [[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    text = f"solid {name}\n"
    for a, b, c, d in faces:
        for t in ((a, b, c), (a, c, d)):
            text += "facet normal 0 0 0\nouter loop\n" + "".join("vertex {} {} {}\n".format(*corner[i]) for i in t)
            text += "endloop\nendfacet\n"
    return text + f"endsolid {name}\n"


def volume(name):
    low, high = GEARBOX[name]
    return (high[0] - low[0]) * (high[1] - low[1]) * (high[2] - low[2])


class NamedCase(Case):
    def pgdr(self, *arguments, expect=None, **keywords):
        """As Case.pgdr, also with several codes that it may end with."""
        if not isinstance(expect, tuple):
            return super().pgdr(*arguments, expect=expect, **keywords)
        done = super().pgdr(*arguments, **keywords)
        self.assertIn(done.returncode, expect, f"{arguments}\n{done.stdout}{done.stderr}")
        return done

    def gearbox(self):
        """The files of the parts, and the flags that name their volumes."""
        files, seeds = [], []
        for i, (name, (low, high)) in enumerate(GEARBOX.items()):
            files.append(self.file(f"part{i}.stl", stl(name, low, high)))
            middle = ",".join(str((a + b) / 2) for a, b in zip(low, high))
            seeds += ["--seed", f"{middle}={name}"]
        return files, seeds

    def meshed(self, output, *flags):
        files, seeds = self.gearbox()
        done = self.pgdr("mesh", *files, "-o", self.folder / output, "--report", self.folder / "report.json", *seeds, *flags, expect=(0, 1))
        return self.folder / output, json.loads((self.folder / "report.json").read_text()), done

    def run_ok(self, *command, **keywords):
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=500, stdin=subprocess.DEVNULL, **keywords)
        self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout}{done.stderr}")
        return done.stdout


class Names(NamedCase):
    """Flags and messages of several inputs."""

    def test_files_are_one_input_and_the_check_takes_them_all(self):
        files, seeds = self.gearbox()
        output, report, _ = self.meshed("all.vtu")
        self.assertEqual(report["input"], list(map(str, files)))
        inputs = [word for file in files for word in ("--input", file)]
        self.pgdr("check", output, *inputs, "--reasons", self.folder / "report.json", expect=(0, 1))
        self.pgdr("check", output, *inputs, *seeds, expect=(0, 1))
        self.pgdr("check", output, *inputs[:-2], *seeds[:-2], expect=6)
        self.pgdr("info", *files, "--report", self.folder / "info.json", expect=0)
        info = json.loads((self.folder / "info.json").read_text())
        self.assertEqual(sorted(info["marker_names"].values()), sorted(GEARBOX))

    def test_names_are_those_of_the_input(self):
        parts = [("Gear A", (0, 0, 0), (1, 1, 1)), ('a "very" ' + 90 * "l. " + "name", (2, 0, 0), (3, 1, 1))]
        model = self.file("model.stl", "".join(stl(*part) for part in parts))
        other = self.file("other.stl", "".join(stl(name.replace("Gear A", "Gear B"), *box) for name, *box in parts))
        for output in ("out.vtu", "out.msh", "out.mesh"):  # not all hold the long name as it is
            output = self.folder / output
            self.pgdr("mesh", model, "-o", output, "--report", self.report, expect=0)
            self.pgdr("check", output, "--input", model, "--reasons", self.report, expect=0)
            said = self.pgdr("check", output, "--input", other, "--reasons", self.report, expect=6).stdout
            self.assertIn('wrong_name: The marker 1 is called "Gear A", and in the input "Gear B".', said)
        self.pgdr("mesh", model, "-o", self.output, "--seed", "0.5,0.5,0.5=Steel", expect=0)
        self.pgdr("check", self.output, "--input", model, "--seed", "0.5,0.5,0.5=Steel", expect=0)
        said = self.pgdr("check", self.output, "--input", model, "--seed", "0.5,0.5,0.5=Brass", expect=6).stdout
        self.assertIn('wrong_name: The label 1 is called "Steel", and in the input "Brass".', said)

    def test_sizes_by_name(self):
        _, coarse, _ = self.meshed("a.vtu")
        _, fine, _ = self.meshed("b.vtu", "--region-size", "Gear A=0.1")
        cells = [{r["label"]: sum(r["histogram"]) for r in report["quality"]["regions"]} for report in (coarse, fine)]
        gear = float(next(label for label, name in fine["region_names"].items() if name == "Gear A"))
        self.assertGreater(cells[1][gear], 4 * cells[0][gear])
        files, seeds = self.gearbox()
        done = self.pgdr("mesh", *files, *seeds, "-o", self.folder / "c.vtu", "--region-size", "Gear B=0.1", expect=2)
        self.assertIn('no region is called "Gear B"; there are Base plate, ', done.stderr)

    def test_seeds_and_holes_in_each_dimension(self):
        square = self.file("square.poly", "4 2 0 0\n1 0 0\n2 2 0\n3 2 2\n4 0 2\n5 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n5 1 3\n0\n")
        self.output = self.folder / "a.msh"
        self.pgdr("mesh", square, "-o", self.output, "--seed", "1.5,0.5=oil", "--seed", "0.5,1.5=7", expect=(0, 1))
        self.pgdr("info", self.output, "--report", self.folder / "a.json", expect=0)
        info = json.loads((self.folder / "a.json").read_text())
        self.assertEqual(info["region_names"], {"1": "oil"})
        self.assertEqual([(r["label"], round(r["volume_meshed"], 9)) for r in info["regions"]], [(1, 2), (7, 2)])
        self.pgdr("mesh", square, "-o", self.output, "--hole", "1.5,0.5", expect=(0, 1))
        for flags, words in ((("--seed", "1,2,3=a"), "--seed takes 2 coordinates in 2D, not 3"), (("--seed", "1=a"), "must be X,Y,Z=LABEL"),
                             (("--hole", "1,1=2"), "must be X,Y,Z")):
            with self.subTest(flags=flags):
                self.assertIn(words, self.pgdr("mesh", square, "-o", self.output, *flags, expect=2).stderr)

    def test_messages_name_the_file(self):
        good = self.file("good.stl", stl("good", (0, 0, 0), (1, 1, 1)))
        bad = self.file("bad.off", "OFF\n4 1 0\n5 5 5\n6 5 5\n5 6 5\n5 5 6\n3 0 1 7\n")
        self.assertIn("bad.off:7", self.pgdr("info", good, bad, expect=3).stderr)
        self.assertIn("2D", self.pgdr("info", good, self.file("flat.poly", "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n0 0\n0\n"), expect=2).stderr)
        crossing = self.file("crossing.stl", stl("crossing", (0.5, 0.5, 0.5), (2, 2, 2)))
        apart = self.file("apart.stl", stl("apart", (7, 7, 7), (8, 8, 8)))
        done = self.pgdr("info", apart, good, crossing, expect=3)
        self.assertIn("good.stl", done.stdout + done.stderr)


class Gearbox(NamedCase):
    """The formats that others read, as far as no other program is needed."""

    def test_names_are_in_each_mesh(self):
        for extension in ("vtu", "pvtu", "msh", "mesh", "ele"):
            with self.subTest(extension=extension):
                output, report, _ = self.meshed("all." + extension)
                self.pgdr("info", output, "--report", self.folder / "info.json", expect=0)
                info = json.loads((self.folder / "info.json").read_text())
                named = {name.replace('"', "'") if extension == "msh" else name for name in GEARBOX}
                self.assertEqual(set(info["region_names"].values()), named)
                self.assertEqual(set(info["marker_names"].values()), named)
                for region in info["regions"]:
                    name = report["region_names"][f"{region['label']:g}"]
                    self.assertAlmostEqual(region["volume_meshed"], volume(name), places=9)

    def test_what_a_format_cannot_hold_is_said(self):
        output, report, done = self.meshed("all.inp")
        unfit = [w for w in report["warnings"] if w["code"] == "unfit_name"]
        self.assertEqual(len(unfit), 2 * len(GEARBOX) - 1)  # "Cover" may be an element set, but not a surface as well
        self.assertIn('it is "Base_plate" there', done.stdout + done.stderr)
        text = output.read_text()
        self.assertEqual(re.findall(r"TYPE=C3D4, ELSET=(.*)", text), list(ABAQUS.values()))
        surfaces = {name + "_SURFACE" for name in ABAQUS.values()} - {"gear_a_2_SURFACE"} | {"gear_a_SURFACE_2"}
        self.assertEqual(set(re.findall(r"\*SURFACE, NAME=(.*), TYPE", text)), surfaces)
        self.assertLessEqual(max(len(field) for line in text.splitlines() if line[0] != "*" for field in line.split(", ")), 20)

    def test_meshio_reads_names(self):
        python = python_with("meshio")
        if python is None:
            self.skipTest("meshio is not installed")
        script = self.file("names.py", "import json, sys, meshio\n"
                           "mesh = meshio.read(sys.argv[1])\n"
                           "print(json.dumps({name: list(map(int, pair)) for name, pair in mesh.field_data.items()}))\n")
        for extension in ("vtu", "msh"):
            with self.subTest(extension=extension):
                output, report, _ = self.meshed("all." + extension)
                data = json.loads(self.run_ok(python, script, output).splitlines()[-1])
                for label, name in report["marker_names"].items():
                    if extension == "msh":  # of which it keeps one of two groups of a name
                        self.assertIn(data[name.replace('"', "'")][1], (2, 3))
                    else:
                        self.assertIn([int(label), 2], [data[name][i:i + 2] for i in range(0, len(data[name]), 2)])

    def test_gmsh_keeps_names(self):
        if shutil.which("gmsh") is None:
            self.skipTest("gmsh is not installed")
        output, _, _ = self.meshed("all.msh")
        for version in ("msh22", "msh4"):
            with self.subTest(version=version):
                again = self.folder / f"{version}.msh"
                self.run_ok("gmsh", "-v", "3", output, "-0", "-format", version, "-o", again)
                files, seeds = self.gearbox()
                inputs = [word for file in files for word in ("--input", file)]
                self.pgdr("check", again, *inputs, *seeds, expect=(0, 1))
                self.pgdr("info", again, "--report", self.folder / "info.json", expect=0)
                info = json.loads((self.folder / "info.json").read_text())
                self.assertEqual(set(info["region_names"].values()), {name.replace('"', "'") for name in GEARBOX})


class CalculiX(NamedCase):
    def test_a_run_with_the_names(self):
        if shutil.which("ccx") is None:
            self.skipTest("CalculiX is not installed")
        self.meshed("all.inp")
        deck = "*INCLUDE, INPUT=all.inp\n*MATERIAL, NAME=STEEL\n*ELASTIC\n210000, 0.3\n"
        deck += "".join(f"*SOLID SECTION, ELSET={name}, MATERIAL=STEEL\n" for name in ABAQUS.values())
        deck += "*BOUNDARY\nBase_plate_SURFACE, 1, 3\n*STEP\n*STATIC\n*DSLOAD\nInput_shaft_SURFACE, P, 10.\n"
        deck += "*NODE PRINT, NSET=Cover_SURFACE\nU\n*SECTION PRINT, SURFACE=Cover_SURFACE, NAME=COVERED\nSOF\n"
        deck += "".join(f"*EL PRINT, ELSET={name}, TOTALS=ONLY\nEVOL\n" for name in ABAQUS.values()) + "*END STEP\n"
        self.file("deck.inp", deck)
        said = self.run_ok("ccx", "deck", cwd=self.folder)
        self.assertIn("Job finished", said)
        self.assertNotIn("*ERROR", said)
        printed = (self.folder / "deck.dat").read_text()
        # What the shaft is pressed with makes the housing, and so the cover, give way.
        moves = [list(map(float, line.split())) for line in printed.split("set COVER_SURFACE")[1].splitlines() if len(line.split()) == 4]
        self.assertGreater(len(moves), 8)
        self.assertGreater(max(abs(x) for _, *move in moves for x in move), 0)
        volumes = re.findall(r"total volume for set (\S+) .*\n\s*\n\s*(\S+)", printed)
        self.assertEqual({name: round(float(v), 3) for name, v in volumes},
                         {ABAQUS[name].upper(): volume(name) for name in GEARBOX})


class OpenFoam(NamedCase):
    def test_checkMesh_with_the_names(self):
        if shutil.which("checkMesh") is None:
            self.skipTest("OpenFOAM is not installed")
        self.meshed("case/constant/polyMesh")
        (self.folder / "case" / "system").mkdir()
        for name, content in (("controlDict", "startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1; writeInterval 1;"),
                              ("fvSchemes", "gradSchemes {} divSchemes {} laplacianSchemes {}"), ("fvSolution", "")):
            self.file(f"case/system/{name}", "FoamFile { version 2.0; format ascii; class dictionary; object " + name + "; }\n" + content)
        environment = {"WM_PROJECT_DIR": "/usr/share/openfoam", **os.environ}
        said = self.run_ok("checkMesh", "-allTopology", "-constant", cwd=self.folder / "case", env=environment)
        self.assertIn("Mesh OK.", said)
        self.assertRegex(said, r"cell zones: +10\n")
        for name in ("Base_plate", "Gear_A", "gear_a", "part_1st_bolt", "Bolt__2_"):
            self.assertIn(name, said)


if __name__ == "__main__":
    unittest.main()
