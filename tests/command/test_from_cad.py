#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""docs/from-cad.md as a reader does it: its scripts and commands, one after the other. PGDR_COMMAND names the command. Exits with 77 where
gmsh is missing or has no OpenCASCADE. Usage: test_from_cad.py [Class[.test]...]"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

from test_command import COMMAND, Case

PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs" / "from-cad.md"


class FromCad(Case):
    def test_the_page(self):
        shutil.copy(COMMAND, self.folder / "pgdr")
        environment = {**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"}
        commands = 0
        for kind, name, text in re.findall(r"^```(geo|sh)(?: (\S+))?\n(.*?)^```$", PAGE.read_text(), re.MULTILINE | re.DOTALL):
            if kind == "geo":
                self.file(name, text)
                continue
            done = subprocess.run(["sh", "-e", "-c", text], cwd=self.folder, env=environment, capture_output=True, text=True, timeout=500)
            self.assertEqual(done.returncode, 0, f"{text}\n{done.stdout}{done.stderr}")
            commands += 1
        self.assertEqual(commands, 3)
        for mesh, words in (("part.vtu", ("clamped", "free", "steel")), ("pair.vtu", ("wall", "steel", "air"))):
            said = self.pgdr("info", self.folder / mesh, expect=0).stdout
            for word in words:
                self.assertIn(word, said)


def lacks_gmsh():
    if not shutil.which("gmsh"):
        return True
    said = subprocess.run(["gmsh", "-info"], capture_output=True, text=True, check=False)
    return "OpenCASCADE" not in said.stdout + said.stderr


if __name__ == "__main__":
    if lacks_gmsh():
        print("skipped: gmsh with OpenCASCADE is not installed")
        sys.exit(77)
    unittest.main()
