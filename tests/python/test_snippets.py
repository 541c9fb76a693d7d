# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Every Python snippet of the docs runs: the blocks of a page one after the other, in one namespace and an empty folder with a copy of
the models of the tests. Blocks that need another package open with ```python theirs and are not run."""
import contextlib
import io
import os
import pathlib
import re
import shutil
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = ("README.md", "docs/python.md", "docs/remeshing.md", "docs/coming-from.md")
BLOCK = re.compile(r"^```(python[^\n]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def blocks(page):
    """(line, words behind ```, text) of each block of Python."""
    text = (ROOT / page).read_text(encoding="utf-8")
    return [(text[:found.start()].count("\n") + 2, found.group(1), found.group(2)) for found in BLOCK.finditer(text)]


class Snippets(unittest.TestCase):
    def run_page(self, page):
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            models = pathlib.Path(folder) / "tests" / "models"
            models.mkdir(parents=True)
            for model in ("bracket.poly", "river.poly"):
                shutil.copy(ROOT / "tests" / "models" / model, models / model)
            os.chdir(folder)
            names = {"__name__": "__main__"}
            try:
                for line, words, text in blocks(page):
                    if words == "python theirs":
                        continue
                    self.assertEqual(words, "python", f"{page}:{line}: a block is `python` or `python theirs`")
                    code = compile("\n" * (line - 1) + text, str(ROOT / page), "exec")
                    with contextlib.redirect_stdout(io.StringIO()):
                        exec(code, names)  # pylint: disable=exec-used
            finally:
                os.chdir(before)

    def test_pages(self):
        run = 0
        for page in PAGES:
            with self.subTest(page):
                self.run_page(page)
            run += sum(words == "python" for _, words, _ in blocks(page))
        self.assertGreater(run, 10)


if __name__ == "__main__":
    unittest.main()
