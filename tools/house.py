#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""How large the house is: files, lines and functions of each room of the layers, as a table in Markdown.

    tools/house.py [--table docs/contributing.md | --compare docs/contributing.md]

Lines are all lines of .cpp and .hpp files; a room has its public headers, too. A function is what a formatted source shows as one: a
definition outside of other functions, from the line with its name to its closing brace.
"""
import argparse
import pathlib
import re
import statistics
import sys

import check_sources

ROOT = pathlib.Path(__file__).resolve().parent.parent
BEGIN, END = "<!-- house: python3 tools/house.py --table docs/contributing.md -->\n", "<!-- end of the house -->\n"
LONG = 40  # lines, about a screen
NO_FUNCTION = re.compile(r"\s*(namespace|class|struct|enum|union|if|for|while|switch|else|do|try|catch|extern)\b|.*\]\s*\([^)]*\)[^{]*\{")


def functions(lines):
    """The lengths of the functions of a source."""
    lengths, begin = [], None
    for number, line in enumerate(lines):
        if begin is None:
            if ")" not in line or "{" not in line or NO_FUNCTION.match(line):
                continue
            if line.rstrip().endswith("}") or line.rstrip().endswith("};"):
                lengths.append(1)
            elif line.rstrip().endswith("{"):
                begin = number, len(line) - len(line.lstrip())
        elif line.rstrip() in (" " * begin[1] + "}", " " * begin[1] + "};"):
            lengths.append(number - begin[0] + 1)
            begin = None
    return lengths


def rooms():
    """(layer/room, its sources) of each room, the highest first; what belongs to none is `layer/pgdr`."""
    room_of = check_sources.room_of_headers(ROOT)
    for layer in reversed(check_sources.LAYERS):
        found = {}
        for path in sorted((ROOT / layer).rglob("*.[ch]pp")):
            name = path.relative_to(ROOT / layer)
            room = room_of.get(name.as_posix()) if name.parts[0] == "pgdr" else name.parts[0]
            found.setdefault(room or "pgdr", []).append(path)
        yield from ((f"{layer}/{room}", found[room]) for room in [*reversed(check_sources.ROOMS[layer]), "pgdr"] if room in found)


def table():
    def row(name, sources):
        texts = [path.read_text(encoding="utf-8").splitlines() for path in sources]
        lengths = sorted(length for lines in texts for length in functions(lines))
        high = lengths[len(lengths) * 9 // 10] if lengths else 0
        return [name, len(sources), sum(map(len, texts)), len(lengths), int(statistics.median(lengths or [0])), high,
                sum(length > LONG for length in lengths)]

    found = list(rooms())
    rows = [row(f"`{name}`", sources) for name, sources in found]
    rows.append(row("all", [path for _, sources in found for path in sources]))
    head = ["room", "files", "lines", "functions", "median of their lines", "nine of ten", f"over {LONG}"]
    return "".join("| " + " | ".join(map(str, cells)) + " |\n" for cells in [head, ["---"] * len(head), *rows])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--table", type=pathlib.Path, help="a file that gets the table, between its marks")
    parser.add_argument("--compare", type=pathlib.Path, help="a file whose table has to be the same")
    args = parser.parse_args()
    lines = table()
    for file in filter(None, (args.table, args.compare)):
        text = file.read_text(encoding="utf-8")
        if BEGIN not in text or END not in text:
            sys.exit(f"{file}: no marks of the house")
        before, rest = text.split(BEGIN)
        new = before + BEGIN + lines + END + rest.split(END)[1]
        if file == args.table:
            file.write_text(new, encoding="utf-8")
        elif new != text:
            print(lines, end="")
            sys.exit(f"{file}: the house is otherwise")
    if not args.table and not args.compare:
        print(lines, end="")


if __name__ == "__main__":
    main()
