# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The ten pictures of docs/gallery.md, made by what is written there."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


@unittest.skipUnless(os.environ.get("PGDR_COMMAND"), "the command is not there")
class Gallery(unittest.TestCase):
    def test_pictures(self):
        shown = re.findall(r'<img src="images/gallery/(\w+\.svg)"', (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8"))
        self.assertEqual(len(set(shown)), 10)
        try:
            import scipy  # noqa: F401
        except ImportError:
            shown.remove("fichera.svg")
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, "-B", ROOT / "docs" / "gallery.py", folder], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            made = {path.name: path for path in pathlib.Path(folder).iterdir()}
            self.assertEqual(set(made), set(shown))
            for name, path in made.items():
                self.assertLess(path.stat().st_size, 100_000, name)
                self.assertGreater(path.read_text(encoding="utf-8").count("<polygon"), 100, name)
                self.assertTrue((ROOT / "docs" / "images" / "gallery" / name).exists(), name)


if __name__ == "__main__":
    unittest.main()
