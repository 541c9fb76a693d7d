#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Hands doxygen a header with the paragraph at its head (below the SPDX lines) as the description of the file.

Usage: doxygen_filter.py FILE     (writes to standard output; files that are no headers as they are)
"""
import pathlib
import sys

SPDX = "// SPDX-"


def with_file_comment(lines):
    """The lines, as many as before, the head's turned into `///`, so that line numbers of warnings stay."""
    out = list(lines)
    first = next((i for i, line in enumerate(lines) if not line.startswith(SPDX)), 0)
    if lines[first:first + 1] != ["//"]:
        return out
    out[first] = r"/// \file"
    for i in range(first + 1, len(lines)):
        if not lines[i].startswith("//"):
            break
        out[i] = "/" + lines[i].replace("<", r"\<").replace("@", r"\@")
    return out


def main():
    path = pathlib.Path(sys.argv[1])
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".hpp":
        text = "\n".join(with_file_comment(text.splitlines())) + "\n"
    sys.stdout.write(text)


if __name__ == "__main__":
    main()
