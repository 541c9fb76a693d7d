# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Types: mypy's strict rules hold for the package, its stub of the extension module is what that module has, and a program that uses
the package is understood."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import pgdr

FOLDER = pathlib.Path(pgdr.__file__).parents[1]
RIGHT = """
import threading
from typing import List
import numpy as np
import numpy.typing as npt
import pgdr

def size(at: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    return np.full(len(at), 0.1)

plc = pgdr.Plc([[0, 0], [1, 0], [1, 1]], segments=[[0, 1], [1, 2], [2, 0]], holes=np.zeros((0, 2)), tolerance=None)
r: pgdr.Mesh = pgdr.mesh(plc, min_angle=25, size=size, stop=threading.Event(), progress=lambda p: print(p.vertices))
report: pgdr.CheckReport = r.check(plc, size=pgdr.smallest(pgdr.sizes_at_points([[0, 0]], [1], 0.5), 0.1))
reasons: List[pgdr.Reason] = r.reasons
corners: npt.NDArray[np.float64] = r.points[r.cells]
pgdr.mesh(plc, selector=lambda e: e.disk_center).write("a.vtu")
"""
WRONG = (("pgdr.mesh(plc, sise=1)", "call-arg"), ("pgdr.mesh('a.poly')", "arg-type"), ("r.cell", "attr-defined"),
         ("pgdr.mesh(plc, size='large')", "arg-type"), ("name: int = r.stop", "assignment"))


def lacks_mypy():
    return subprocess.run([sys.executable, "-m", "mypy", "--version"], capture_output=True, check=False).returncode != 0


@unittest.skipIf(lacks_mypy(), "mypy is not installed")
class Types(unittest.TestCase):
    def run_module(self, *words):
        """What `python3 -m ...` says, and whether it is content. Beside the package, so that its errors count as those of one's own."""
        with tempfile.TemporaryDirectory() as cache:
            cached = ["--cache-dir", cache] if words[0] == "mypy" else []
            done = subprocess.run([sys.executable, "-m", *words, *cached], cwd=FOLDER, capture_output=True, text=True, check=False)
        return done.returncode == 0, done.stdout + done.stderr

    def test_the_package(self):
        content, words = self.run_module("mypy", "--strict", "-p", "pgdr")
        self.assertTrue(content, words)
        self.assertRegex(words, "no issues found in [1-9][0-9] source files")

    def test_the_stub_is_what_the_extension_has(self):
        content, words = self.run_module("mypy.stubtest", "pgdr._pgdr")
        self.assertTrue(content, words)
        self.assertIn("no issues found in 1 module", words)

    def test_a_program(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "program.py")
            file.write_text(RIGHT, encoding="utf-8")
            content, words = self.run_module("mypy", "--strict", str(file))
            self.assertTrue(content, words)
            file.write_text(RIGHT + "".join(line + "\n" for line, _ in WRONG), encoding="utf-8")
            content, words = self.run_module("mypy", "--strict", str(file))
            self.assertFalse(content, words)
            for number, (line, code) in enumerate(WRONG, RIGHT.count("\n") + 1):
                self.assertRegex(words, rf"program\.py:{number}: error: .*\[{code}\]", line)


if __name__ == "__main__":
    unittest.main()
