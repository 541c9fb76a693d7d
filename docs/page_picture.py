#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""A picture of a page that `pgdr view` makes, as the README shows it: cut open, with the figures of a cell. Needs Chromium.

    pgdr mesh tests/models/bracket.poly -o bracket.vtu --size 0.4 && pgdr view bracket.vtu -o bracket.html
    docs/page_picture.py bracket.html docs/images/page.png
"""
import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests/command"))
import browser  # noqa: E402: it lies with the tests, which need it more often

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("page", type=pathlib.Path)
parser.add_argument("picture", type=pathlib.Path)
options = parser.parse_args()
with browser.Page(options.page, 760, 420) as page:
    page.wait_for("window.pgdrView && pgdrView.ready")
    page.value("pgdrView.setCut({axis: 'y', value: 2, flat: true, flip: true}); pgdrView.turn(-12, 0)")
    page.screenshot()  # drawn, before the pointer comes
    page.mouse("mouseMoved", 461, 300)
    page.mouse("mouseMoved", 460, 300)
    page.wait_for("!document.getElementById('tip').hidden")
    options.picture.write_bytes(page.screenshot())
