#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Pages that `pgdr view -o X.html` makes: what is in the file, and how it looks in a browser without a window (browser.py; without
Chromium these tests are skipped). Usage: test_view_page.py [Class[.test]...]"""
import array
import base64
import json
import math
import re
import struct
import sys
import time
import unittest

import browser
from test_command import BRACKET, PLATE, SANITIZE, Case
from test_view import STACK, TWO, pixels

TYPES = {"f32": "f", "u8": "B", "u16": "H", "u32": "I"}
SKIPPED = 77


class PageCase(Case):
    def page(self, mesh, *flags, name="out.html", expect=0):
        page = self.folder / name
        done = self.pgdr("view", mesh, "-o", page, "--report", self.report, *flags, expect=None)
        if "without three.js" in done.stderr:
            self.skipTest("built without three.js (Debian's package libjs-three)")
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        if expect:
            self.assertFalse(page.exists())
            return done
        return page

    def solved(self, path, point_data=(), cell_data=()):
        """The .vtu at `path` with further arrays, of float64, as a solver writes them: [(name, components, values)]. Of cells: of all
        rows of the file, constraints among them."""
        data = path.read_bytes()
        head, body = data.split(b'<AppendedData encoding="raw">', 1)
        start = body.index(b"_") + 1
        end = body.rindex(b"\n</AppendedData>") if b"\n</AppendedData>" in body else body.rindex(b"</AppendedData>")
        raw = body[start:end]
        for section, arrays in (("PointData", point_data), ("CellData", cell_data)):
            for title, components, values in arrays:
                about = (f'<DataArray type="Float64" Name="{title}" NumberOfComponents="{components}" format="appended" '
                         f'offset="{len(raw)}"/>\n').encode()
                close = f"</{section}>".encode()
                self.assertIn(close, head)
                head = head.replace(close, about + close, 1)
                raw += struct.pack("<Q", 8 * len(values)) + array.array("d", values).tobytes()
        solved = path.with_name("solved_" + path.name)
        solved.write_bytes(head + b'<AppendedData encoding="raw">' + body[:start] + raw + body[end:])
        return solved


def contents(page):
    """The JSON of a page, and its arrays by name."""
    text = page.read_text()
    about = json.loads(re.search(r'<script type="application/json" id="pgdr-data">(.*?)</script>', text, re.DOTALL).group(1))
    found = dict(re.findall(r'<script type="text/plain" id="pgdr-(\w+)">([A-Za-z0-9+/=]*)</script>', text))
    arrays = {}
    for name, row in about["arrays"].items():
        arrays[name] = array.array(TYPES[row["type"]], base64.b64decode(found.pop(name), validate=True))
        assert len(arrays[name]) == row["rows"] * row["components"], name
    assert not found, found.keys()
    return about, arrays


def rows(flat, width):
    return [tuple(flat[i:i + width]) for i in range(0, len(flat), width)]


class PageData(PageCase):
    """What is in a page: a browser is not needed."""

    def test_two_triangles(self):
        about, arrays = contents(self.page(self.file("two.mesh", TWO), "--color", "region"))
        self.assertEqual((about["dimension"], about["title"], about["color"]), (2, "two.mesh", "region"))
        self.assertEqual((about["low"], about["high"]), ([0, 0], [4, 4]))
        points = [tuple(o + about["scale"] * p for o, p in zip(about["origin"], row)) for row in rows(arrays["points"], 2)]
        self.assertEqual(points, [(0, 0), (2, 0), (0, 2), (4, 4)])
        self.assertEqual([sorted(cell) for cell in rows(arrays["cells"], 3)], [[0, 1, 2], [1, 2, 3]])
        self.assertEqual([about["regions"][r]["label"] for r in arrays["region"]], [1, 2])
        self.assertEqual(list(arrays["volume"]), [2, 6])
        self.assertEqual([about["markers"][m]["label"] for m in arrays["subsegments_marker"]], [7])
        first, second = arrays["min_angle"]
        self.assertAlmostEqual(first, 45, places=4)
        self.assertAlmostEqual(second, math.degrees(2 * math.asin(math.sqrt(0.1))), places=4)
        self.assertAlmostEqual(arrays["max_angle"][0], 90, places=4)
        self.assertAlmostEqual(arrays["radius_edge"][0], math.sqrt(0.5), places=6)

    def test_arrays_are_those_of_the_mesh(self):
        for model, size, dimension in ((BRACKET, 0.6, 3), (PLATE, 0.01, 2)):
            self.mesh(model, "--size", size)
            about, arrays = contents(self.page(self.output))
            self.pgdr("info", self.output, "--report", self.report, expect=0)
            report = self.json()
            self.assertEqual(about["arrays"]["cells"]["rows"], report["cells"])
            self.assertEqual(about["arrays"]["points"]["rows"], report["vertices"])
            self.assertLessEqual(max(map(abs, arrays["points"])), 1)
            self.assertEqual(math.log2(about["scale"]) % 1, 0)
            given = rows(vtu_array(self.output, "Points", "d"), 3)
            for point, row in zip(given, rows(arrays["points"], dimension)):
                for x, o, p in zip(point, about["origin"], row):
                    self.assertLessEqual(abs(o + about["scale"] * p - x), about["scale"] * 2**-24)
            corners = vtu_array(self.output, "connectivity", "q")
            self.assertEqual(list(arrays["cells"]), list(corners[:len(arrays["cells"])]))
            quality = report["quality"]
            self.assertAlmostEqual(min(arrays["min_angle"]), quality["min_angle_deg"], places=4)
            self.assertAlmostEqual(max(arrays["max_angle"]), quality["max_angle_deg"], places=4)
            self.assertAlmostEqual(max(arrays["radius_edge"]) / quality["max_radius_edge"], 1, places=5)
            volume = sum(row["volume_meshed"] for row in report["regions"])
            self.assertAlmostEqual(sum(arrays["volume"]) / volume, 1, places=5)

    def test_fields_of_the_file(self):
        self.mesh(BRACKET, "--size", 0.6)
        points, cells = len(vtu_array(self.output, "Points", "d")) // 3, len(vtu_array(self.output, "types", "B"))
        solved = self.solved(self.output, [("T <hot>", 1, [float(i) for i in range(points)])],
                             [("flux", 3, [float(i % 7) for i in range(3 * cells)])])
        about, arrays = contents(self.page(solved, "--color", "T <hot>"))
        self.assertEqual(self.json()["fields"], ["T <hot>", "flux"])
        fields = {row["name"]: row for row in about["fields"]}
        temperature = arrays[fields["T <hot>"]["array"]]
        self.assertEqual(list(temperature), list(range(points)))
        flux = arrays[fields["flux"]["array"]]
        self.assertEqual(about["arrays"][fields["flux"]["array"]]["components"], 3)
        self.assertEqual(list(flux), [float(i % 7) for i in range(3 * about["arrays"]["cells"]["rows"])])
        self.assertEqual(self.pgdr("check", solved).returncode, self.pgdr("check", self.output).returncode)

    def test_damaged_fields(self):
        self.mesh(BRACKET, "--size", 1)
        points = len(vtu_array(self.output, "Points", "d")) // 3
        for n, components in ((points - 1, 1), (points + 1, 1), (points, 2), (points, 0), (points, 5000)):
            solved = self.solved(self.output, [("T", components, [0.0] * n)])
            self.page(solved, expect=3)
        whole = self.solved(self.output, [("T", 1, [0.0] * points)]).read_bytes()
        self.page(self.file("no_numbers.vtu", whole.replace(b'type="Float64" Name="T"', b'type="String." Name="T"')), expect=3)
        self.page(self.file("cut.vtu", whole[:-40]), expect=3)

    def test_wrong_flags(self):
        plane, space = self.file("two.mesh", TWO), self.file("stack.mesh", STACK)
        self.assertIn("there are quality", self.page(space, "--color", "temperature", expect=2).stderr)
        self.page(space, "--color", "leaf", expect=2)
        self.page(plane, "--cut", "x=1", expect=2)
        self.page(PLATE, expect=3)
        self.page(self.folder / "missing.mesh", expect=4)
        self.page(space, name="no folder/out.html", expect=4)
        self.assertIn("--color", self.page(space, "--color", "volume", name="out.svg", expect=2).stderr)

    def test_no_text_of_the_file_is_html(self):
        """Names of files and labels cannot end the script that they are in."""
        named = self.file("<!-- <b>&.mesh", TWO.replace("Dimension 2", "# name region 1 = </script><script>alert(1)</script>\nDimension 2"))
        about, _ = contents(self.page(named))
        self.assertEqual(about["title"], "<!-- <b>&.mesh")
        self.assertEqual(about["regions"][0]["name"], "</script><script>alert(1)</script>")

    def test_same_bytes_for_any_number_of_runs(self):
        self.mesh(BRACKET, "--size", 0.6)
        self.assertEqual(self.page(self.output).read_bytes(), self.page(self.output, name="again.html").read_bytes())


class PageBrowser(PageCase):
    """How a page looks, and what it says, in a browser. A picture of 480 x 360 pixels, whose middle is (240, 180)."""

    def setUp(self):
        super().setUp()
        if not browser.find():
            self.skipTest("no Chromium (Debian's package chromium)")

    def opened(self, page, **sizes):
        shown = self.enterContext(browser.Page(page, **sizes))
        shown.wait_for("window.pgdrView !== undefined")
        self.assertIsNone(shown.value("pgdrView.error"))
        self.assertEqual(shown.messages, [])
        return shown

    def picture(self, shown):
        """Rows of pixels, without those that panel and legend cover."""
        width, height, lines = pixels(shown.screenshot())
        self.assertEqual((width, height), (480, 360))
        return lines

    def differing(self, one, other):
        return sum(a != b for first, second in zip(one, other) for a, b in zip(first[250:], second[250:]))

    def place_on(self, shown):
        """A pixel where a cell is, and those about it are, too; right of the panel."""
        return shown.value("""(() => {
          for (let x = 300; x < 460; x += 4) for (let y = 40; y < 320; y += 4)
            if ([[0, 0], [3, 0], [0, 3], [-3, 0], [0, -3]].every(([dx, dy]) => pgdrView.pick(x + dx, y + dy))) return [x, y];
        })()""")

    def test_plane(self):
        page = self.page(self.file("two.mesh", TWO), "--color", "region")
        about, _ = contents(page)
        shown = self.opened(page)
        self.assertEqual(shown.value("pgdrView.counts"), {"points": 4, "cells": 2, "hull": 0})
        self.assertEqual(shown.value("pgdrView.bounds"), [[0, 0], [4, 4]])
        lines = self.picture(shown)
        places = {0: (127, 293), 1: (240, 180)}  # the middle of each triangle: the square is 340 pixels wide
        for cell, (x, y) in places.items():
            color = bytes.fromhex(about["colors"]["palette"][cell][1:])
            self.assertLessEqual(max(abs(a - b) for a, b in zip(lines[y][x], color)), 2, (lines[y][x], color))
            picked = shown.value(f"pgdrView.pick({x}, {y})")
            self.assertEqual((picked["cell"], picked["label"]), (cell, cell + 1))
            self.assertAlmostEqual(picked["volume"], [2, 6][cell], places=5)
        self.assertEqual(lines[300][400], (255, 255, 255))
        self.assertIsNone(shown.value("pgdrView.pick(400, 300)"))
        shown.value("pgdrView.hide(1, true)")
        self.assertEqual(self.picture(shown)[180][240], (255, 255, 255))
        self.assertIsNone(shown.value("pgdrView.pick(240, 180)"))
        self.assertEqual(shown.value("pgdrView.state().triangles"), 1)

    def test_pointer(self):
        """As a user's hand does it: moves over a cell, drags, turns the wheel, chooses a colouring."""
        self.mesh(BRACKET, "--size", 0.5)
        shown = self.opened(self.page(self.output))
        x, y = self.place_on(shown)
        shown.mouse("mouseMoved", x + 1, y)
        shown.mouse("mouseMoved", x, y)
        shown.wait_for("!document.getElementById('tip').hidden")
        cell = shown.value(f"pgdrView.pick({x}, {y}).cell")
        self.assertRegex(shown.value("document.getElementById('tip').innerText"), rf"cell\s*{cell}\b[\s\S]*volume[\s\S]*dihedral angles")
        before = self.picture(shown)
        shown.mouse("mousePressed", 300, 200, button="left", buttons=1, clickCount=1)
        shown.mouse("mouseMoved", 360, 220, button="left", buttons=1)
        shown.mouse("mouseReleased", 360, 220, button="left")
        turned = self.picture(shown)
        self.assertGreater(self.differing(before, turned), 2000)
        shown.mouse("mouseWheel", 300, 200, deltaX=0, deltaY=-400)
        zoomed = self.picture(shown)
        self.assertGreater(self.differing(turned, zoomed), 2000)
        shown.value("(box => { box.value = 'dihedral'; box.dispatchEvent(new Event('change')); })(document.querySelector('#panel select'))")
        self.assertEqual(shown.value("pgdrView.state().color"), "dihedral")
        self.assertGreater(self.differing(zoomed, self.picture(shown)), 2000)

    def test_space(self):
        """What is drawn with and without a cut is what the arrays of the page say; each cell that is picked says its own figures."""
        self.mesh(BRACKET, "--size", 0.4)
        page = self.page(self.output)
        about, arrays = contents(page)
        shown = self.opened(page)
        cells, points = rows(arrays["cells"], 4), rows(arrays["points"], 3)
        self.assertEqual(shown.value("pgdrView.counts.hull"), surface_size(cells))
        whole = self.picture(shown)
        self.assertGreater(sum(pixel != (255, 255, 255) for line in whole for pixel in line[250:]), 5000)
        self.check_markers(shown, about, arrays)
        shown.value("pgdrView.setCut({axis: 'x', value: 2.5})")
        place = (2.5 - about["origin"][0]) / about["scale"]
        kept = [cell for cell in cells if sum(points[v][0] for v in cell) <= 4 * place]
        self.assertTrue(0 < len(kept) < len(cells))
        self.assertAlmostEqual(shown.value("pgdrView.state().triangles"), surface_size(kept), delta=12)  # 32 bits: some centroids
        cut = self.picture(shown)
        self.assertGreater(self.differing(whole, cut), 2000)
        self.check_picks(shown, arrays, lambda cell: True)
        shown.value("pgdrView.setCut({flat: true}); pgdrView.turn(60, -30)")
        seen = self.check_picks(shown, arrays, lambda cell: min(points[v][0] for v in cells[cell]) <= place + 1e-6)
        straddling = [c for c in seen if min(points[v][0] for v in cells[c]) < place < max(points[v][0] for v in cells[c])]
        self.assertGreater(len(straddling), 5)
        self.assertGreater(self.differing(cut, self.picture(shown)), 2000)
        shown.value("pgdrView.setCut(null); pgdrView.turn(-60, 30)")
        self.assertEqual(self.differing(whole, self.picture(shown)), 0)

    def check_markers(self, shown, about, arrays):
        """Without a cut, each picked face is a facet of its cell, and says its marker."""
        marker_of = {tuple(sorted(face)): about["markers"][m]["label"]
                     for face, m in zip(rows(arrays["subfacets"], 3), arrays["subfacets_marker"])}
        picks = shown.value("[...Array(400).keys()].map(i => pgdrView.pick(20 + 22 * (i % 20), 20 + 16 * Math.floor(i / 20))).filter(p => p)")
        self.assertGreater(len(picks), 40)
        for pick in picks:
            corners = pick["corners"]
            markers = {marker_of.get(tuple(sorted(corners[:i] + corners[i + 1:]))) for i in range(4)}
            self.assertIn(pick["marker"]["label"], markers - {None})
        self.assertGreater(len({pick["marker"]["label"] for pick in picks}), 1)

    def check_picks(self, shown, arrays, fits):
        """Picks on a grid. @returns the cells"""
        places = [(x, y) for x in range(20, 480, 20) for y in range(170, 350, 20)]
        picks = shown.value(f"{json.dumps(places)}.map(([x, y]) => pgdrView.pick(x, y))")
        found = [pick for pick in picks if pick]
        self.assertGreater(len(found), 10)
        for pick in found:
            cell = pick["cell"]
            self.assertTrue(fits(cell), cell)
            self.assertEqual(pick["corners"], list(arrays["cells"][4 * cell:4 * cell + 4]))
            for name in ("volume", "radius_edge", "min_angle", "max_angle"):
                self.assertEqual(pick[name], arrays[name][cell])
        return {pick["cell"] for pick in found}

    def test_the_nearer_is_picked(self):
        """Of two tetrahedra above each other, with its label and name."""
        stack = self.file("stack.mesh", "# name region 2 = upper\n" + STACK)
        for height, cell, name in ((1, 1, "upper"), (-1, 0, "")):
            shown = self.opened(self.page(stack, "--from", f"0,0,{height}"))
            picked = shown.value("pgdrView.pick(200, 200)")
            self.assertEqual((picked["cell"], picked["label"], picked["name"]), (cell, cell + 1, name))

    def test_fields(self):
        """A field of points is a ramp of colours between them, and one of cells a colour each."""
        self.mesh(BRACKET, "--size", 0.5)
        points = rows(vtu_array(self.output, "Points", "d"), 3)
        cells = len(vtu_array(self.output, "types", "B"))
        solved = self.solved(self.output, [("height", 1, [p[2] for p in points])], [("half", 1, [float(c % 2) for c in range(cells)])])
        shown = self.opened(self.page(solved, "--color", "height"))
        low, high = min(p[2] for p in points), max(p[2] for p in points)
        self.assertEqual(shown.value("pgdrView.state().range"), [low, high])
        ramp = self.picture(shown)
        picked = shown.value("pgdrView.pick({}, {})".format(*self.place_on(shown)))
        self.assertEqual(picked["fields"]["half"], picked["cell"] % 2)
        self.assertEqual(len(picked["fields"]["height"]), 4)
        for corner, value in zip(picked["corners"], picked["fields"]["height"]):
            self.assertAlmostEqual(value, points[corner][2], places=5)
        shown.value("pgdrView.setColor('half')")
        self.assertGreater(self.differing(ramp, self.picture(shown)), 2000)

    def test_a_million_cells(self):
        if SANITIZE:
            self.skipTest("nothing of pgdr is slow here but under sanitizers")
        mesh = self.file("cubes.mesh", cubes(55))
        page = self.page(mesh)
        size = page.stat().st_size / 2**20
        begin = time.monotonic()
        shown = self.opened(page, patience=300)
        shown.screenshot()
        timing = shown.value("pgdrView.timing")
        print(f"998,250 cells: a page of {size:.0f} MiB; seconds: {time.monotonic() - begin:.1f} to the first picture, of it in the page "
              f"{timing['first'] / 1000:.1f}: arrays {timing['decode'] / 1000:.1f}, faces {timing['faces'] / 1000:.1f}")
        self.assertEqual(shown.value("pgdrView.counts"), {"points": 56**3, "cells": 6 * 55**3, "hull": 12 * 55**2})
        self.assertLess(size, 60)
        shown.value("pgdrView.setCut({axis: 'x', value: 20})")
        self.assertEqual(shown.value("pgdrView.state().triangles"), 4 * 55**2 + 8 * 20 * 55)
        self.assertIsNotNone(shown.value("pgdrView.pick(240, 180)"))


def surface_size(cells):
    """How many faces are of exactly one of these tetrahedra."""
    faces = set()
    for cell in cells:
        for i in range(4):
            faces ^= {tuple(sorted(cell[:i] + cell[i + 1:]))}
    return len(faces)


def cubes(n):
    """A .mesh of n x n x n unit cubes, six tetrahedra each, which all have the diagonal (Kuhn's)."""
    at = lambda x, y, z: 1 + x + (n + 1) * (y + (n + 1) * z)
    steps = [1, n + 1, (n + 1)**2]
    paths = [(steps[a], steps[a] + steps[b], sum(steps), a, b) for a in range(3) for b in range(3) if a != b]
    even = {(0, 1), (1, 2), (2, 0)}
    corners = [(0, p, q, s) if (a, b) in even else (0, q, p, s) for p, q, s, a, b in paths]
    coordinates = [f"{x} {y} {z} 0" for z in range(n + 1) for y in range(n + 1) for x in range(n + 1)]
    cells = [f"{v + a} {v + b} {v + c} {v + d} 0" for z in range(n) for y in range(n) for x in range(n) for v in (at(x, y, z),)
             for a, b, c, d in corners]
    return "\n".join(["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(coordinates)), *coordinates, "Tetrahedra",
                      str(len(cells)), *cells, "End", ""])


def vtu_array(path, name, kind):
    """The numbers of an array of a .vtu of ours."""
    data = path.read_bytes()
    offset = int(re.search(rf'Name="{name}"[^>]*offset="(\d+)"'.encode(), data).group(1))
    at = data.index(b"_", data.index(b"<AppendedData")) + 1 + offset
    size, = struct.unpack_from("<Q", data, at)
    return array.array(kind, data[at + 8:at + 8 + size])


if __name__ == "__main__":
    run = unittest.main(verbosity=2, exit=False).result
    if run.testsRun == len(run.skipped) and run.wasSuccessful():
        print("skipped:", run.skipped[0][1])
        sys.exit(SKIPPED)
    sys.exit(not run.wasSuccessful())
