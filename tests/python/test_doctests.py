# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The examples in the docstrings of the package, as they stand there."""
import doctest
import importlib
import pkgutil
import unittest

import pgdr


class Doctests(unittest.TestCase):
    def test_all_modules(self):
        attempted = 0
        for module in [pgdr] + [importlib.import_module(f"pgdr.{m.name}") for m in pkgutil.iter_modules(pgdr.__path__)]:
            with self.subTest(module=module.__name__):
                failed, tried = doctest.testmod(module)
                self.assertEqual(failed, 0)
                attempted += tried
        self.assertGreater(attempted, 20)

    def test_what_is_exported_has_words(self):
        for name in pgdr.__all__:
            if name != "__version__":
                self.assertTrue((getattr(pgdr, name).__doc__ or "").strip(), name)


if __name__ == "__main__":
    unittest.main()
