# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What tests of the scripts of bench/ share."""
import os
import pathlib
import stat
import subprocess
import sys
import tempfile
import unittest

COMMAND = os.environ["PGDR_COMMAND"]
BENCH = pathlib.Path(__file__).resolve().parents[2] / "bench"


class ScriptCase(unittest.TestCase):
    """A test that has a folder of its own, and runs Python scripts."""

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name)

    def run_script(self, *command, expect=0, path=None):
        """Runs a Python script, with this PATH if one is given, and holds that it ends with `expect`."""
        environment = {**os.environ, "PATH": str(path or os.environ["PATH"])}
        done = subprocess.run([sys.executable, "-B", *map(str, command)], capture_output=True, text=True, timeout=500, env=environment)
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        return done

    def script(self, name, text):
        """A script of the shell, in the folder."""
        file = self.folder / name
        file.write_text("#!/bin/sh\n" + text)
        file.chmod(file.stat().st_mode | stat.S_IXUSR)
        return file
