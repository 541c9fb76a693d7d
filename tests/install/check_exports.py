#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What a shared library exports is the public face: every exported symbol belongs to a class or function that a public header
declares in a namespace with PGDR_API, and what the command needs of the library is exported, so that it could be linked to it.

Usage: check_exports.py NM LIBRARY INCLUDE_FOLDER [ARCHIVE...]     (archives: users of the library)
"""
import pathlib
import re
import subprocess
import sys

DECLARED = re.compile(r"\b(?:class|struct|enum class)\s+(?:\[\[\w+\]\]\s*)?(?:PGDR_API\s+)?(\w+)|\b(\w+)\s*\("
                      r"|\binline constexpr \w+ (\w+)")
NESTED = re.compile(r"^_Z(?:T[ISV]|GV|Z)?NK?4pgdr(?:(\d+)|([a-z]{2}))")  # pgdr::NAME... or an operator
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
LEAST = 30  # symbols: fewer, and something is wrong


def declared(folder):
    """Names of classes, functions and constants in public headers whose namespace is exported."""
    names = set()
    for path in pathlib.Path(folder, "pgdr").glob("*.hpp"):
        text = COMMENT.sub("", path.read_text(encoding="utf-8"))
        if "namespace pgdr PGDR_API {" in text:
            names.update(name for pair in DECLARED.findall(text) for name in pair if name)
    return names


def name_of(symbol):
    """NAME of pgdr::NAME...; "operator" for one of the namespace; None for what is of no namespace pgdr."""
    found = NESTED.match(symbol)
    if not found:
        return None
    if found.group(2):
        return "operator"
    start = found.end(1)
    return symbol[start:start + int(found.group(1))]


def symbols(nm, *arguments):
    lines = subprocess.run([nm, *arguments], check=True, capture_output=True, text=True).stdout.splitlines()
    return {line.split()[-1] for line in lines if line.strip() and not line.endswith(":")}


def main():
    nm, library, include, *archives = sys.argv[1:]
    exported, names = symbols(nm, "-D", "--defined-only", library), declared(include)
    complaints = [f"exported, and in no public header: {s}" for s in sorted(exported) if name_of(s) not in names]
    for archive in archives:
        here = symbols(nm, "--defined-only", archive)
        complaints += [f"{pathlib.Path(archive).name} needs what is not exported: {s}"
                       for s in sorted(symbols(nm, "-u", archive) - exported - here) if name_of(s) not in {None, "tool"}]
    if len(exported) < LEAST:
        complaints.append(f"only {len(exported)} symbols are exported")
    print(*complaints, f"{len(exported)} exported symbols, {len(complaints)} complaints", sep="\n")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
