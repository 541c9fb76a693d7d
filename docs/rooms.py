#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Draws docs/images/rooms.svg from the table ROOMS of tools/check_sources.py: a band a layer, a box a room, an arrow to each room that
it may include.

    docs/rooms.py [--check]      --check: exit code 1 if the picture is otherwise
"""
import pathlib
import sys
import textwrap

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))
import check_sources  # noqa: E402

FILE = ROOT / "docs" / "images" / "rooms.svg"
WIDTH, LEFT, BOX_HEIGHT, ROW, GAP = 1040, 120, 52, 92, 26
HEAD = ('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {w} {h}" width="{w}" height="{h}" font-family="Helvetica, Arial, sans-serif">\n'
        '<title>The rooms of pgdr: an arrow leads from a room to one that it may include</title>\n'
        '<defs><marker id="a" markerWidth="7" markerHeight="7" refX="6" refY="3.5" orient="auto"><path d="M0,0 L7,3.5 L0,7 z" fill="#567"/>'
        '</marker></defs>\n<rect width="{w}" height="{h}" fill="#ffffff"/>\n')


def rows_of(rooms):
    """The rooms of a layer in rows, the highest first: a row includes only what is in rows below."""
    depth = {}
    for name, room in rooms.items():  # lowest first
        depth[name] = 1 + max([depth[other] for other in room.may.split() if other in depth], default=-1)
    return [[name for name in rooms if depth[name] == d] for d in range(max(depth.values()), -1, -1)]


def text(x, y, words, size, style=""):
    return f'<text x="{x:.0f}" y="{y:.0f}" font-size="{size}" {style}fill="#223">{words}</text>\n'


def picture():
    places, bands, boxes, y = {}, "", "", 12
    for layer in reversed(check_sources.LAYERS):
        rows = rows_of(check_sources.ROOMS[layer])
        height = len(rows) * ROW - (ROW - BOX_HEIGHT) + 24
        bands += f'<rect x="8" y="{y}" width="{WIDTH - 16}" height="{height}" rx="8" fill="#eef3fb" stroke="#889"/>\n'
        bands += text(18, y + 22, layer + "/", 16, 'font-style="italic" ')
        for row, names in enumerate(rows):
            width = min(210, (WIDTH - LEFT - 20) / len(names) - 14)
            for i, name in enumerate(names):
                middle = LEFT + (WIDTH - LEFT - 12) * (i + 0.5) / len(names)
                places[name] = middle, y + 12 + row * ROW
                top = places[name][1]
                boxes += f'<rect x="{middle - width / 2:.0f}" y="{top}" width="{width:.0f}" height="{BOX_HEIGHT}" rx="5" fill="#ffffff" stroke="#445"/>\n'
                boxes += text(middle, top + 15, name, 14, 'font-weight="bold" text-anchor="middle" ')
                question = check_sources.ROOMS[layer][name].question
                for k, line in enumerate(textwrap.wrap(question, int(width / 5.4))[:3]):
                    boxes += text(middle, top + 28 + 11 * k, line, 10, 'text-anchor="middle" ')
        y += height + GAP
    arrows = ""
    for rooms in check_sources.ROOMS.values():
        for name, room in rooms.items():
            for other in room.may.split():
                (x0, y0), (x1, y1) = places[name], places[other]
                arrows += f'<line x1="{x0:.0f}" y1="{y0 + BOX_HEIGHT}" x2="{x1 + (x0 - x1) * 0.08:.0f}" y2="{y1}" stroke="#567" stroke-opacity="0.7" marker-end="url(#a)"/>\n'
    return HEAD.format(w=WIDTH, h=y) + bands + arrows + boxes + "</svg>\n"


def main():
    drawn = picture()
    if sys.argv[1:] == ["--check"]:
        same = FILE.read_text(encoding="utf-8") == drawn
        print("docs/images/rooms.svg is " + ("as drawn" if same else "otherwise: run docs/rooms.py"))
        return 0 if same else 1
    FILE.write_text(drawn, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
