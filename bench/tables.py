# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Tables of documents that scripts write: each stands between two marks that name it, and can be made again and compared."""
import pathlib

VOLATILE = {"seconds", "time"}  # columns that hang on the machine


def markdown(head, rows):
    """The lines of a table."""
    return ["| " + " | ".join(map(str, row)) + " |" for row in [head, ["---"] * len(head), *rows]]


def marks(name):
    return f"<!-- begin of the {name} -->", f"<!-- end of the {name} -->"


def write_table(file, lines, name="table"):
    """In place of what is between the marks of the file that have this name; all else is kept."""
    begin, end = marks(name)
    old = file.read_text() if file.exists() else ""
    before, after = (old.split(begin)[0], old.split(end)[1]) if begin in old and end in old else ("", "\n")
    file.write_text(before + "\n".join([begin, ""] + lines + ["", end]) + after)


def cells(lines):
    return [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in lines if line.startswith("|")]


def differences(file, lines, name="table"):
    """What is otherwise in the file's table of this name than in these lines, but for columns that hang on the machine and for rows
    that only the file has (of programs or models that are not here)."""
    begin, end = marks(name)
    old = file.read_text()
    if begin not in old or end not in old:
        return [f"{file}: no marks of the {name}"]
    there, here = cells(old.split(begin)[1].split(end)[0].splitlines()), cells(lines)
    if not there or there[0] != here[0]:
        return [f"{file}, {name}: the head is otherwise"]
    counts = [i for i, word in enumerate(here[0]) if word not in VOLATILE]
    known = {tuple(row[i] for i in counts) for row in there}
    return [f"{file}, {name}: now | {' | '.join(row)} |" for row in here if tuple(row[i] for i in counts) not in known]


def add_flags(parser):
    parser.add_argument("--table", type=pathlib.Path, help="a file whose table, between its marks, is replaced")
    parser.add_argument("--compare", type=pathlib.Path, help="a file whose table has to be the same, but for seconds")


def keep(args, lines, name="table"):
    """Does what the flags say with a table. The number of differences."""
    if args.table:
        write_table(args.table, lines, name)
    found = differences(args.compare, lines, name) if args.compare else []
    for line in found:
        print(line)
    return len(found)
