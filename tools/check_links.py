#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The rules of the documents: README.md, docs/ and bench/notebook/. Prints what breaks them; exit code 1 if anything does.

  * every relative link and every picture leads to a file of the tree, and every #anchor to a heading of that file;
  * no cell of a table of docs/usage.md has more than 40 words: what needs more has a section below;
  * with --paths: what stands in backticks and begins with a folder of sources is a file there, or a pattern that some match,
    but for paths with a NAME to be filled in.
    The notebook is left out, as its figures are of the versions that they name.

Usage: check_links.py [--paths] [ROOT]     (default: the repository of this script)
"""
import pathlib
import re
import sys
import urllib.parse

FENCE = re.compile(r"^(```|~~~).*?^\1\s*$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"`+[^`\n]*`+")
LINK = re.compile(r"\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)")
PICTURE = re.compile(r"\b(?:src|href)=\"([^\"]+)\"")
HEADING = re.compile(r"^#{1,6}\s+(.*?)\s*#*\s*$", re.MULTILINE)
ABSOLUTE = re.compile(r"^[a-z][a-z0-9+.-]*:", re.IGNORECASE)
SOURCE_PATH = re.compile(r"`((?:geometry|core|scheduler|tools|tests|bench|docs|cmake|\.ci)/[\w./*-]*)`")
MOST_WORDS = 40
SHORT_CELLS = ["docs/usage.md"]


def documents(root):
    yield root / "README.md"
    yield from sorted((root / "docs").rglob("*.md"))
    yield from sorted((root / "bench" / "notebook").glob("*.md"))


def without_code(text):
    """The text as a reader sees it, without code: line numbers stay, since line ends do."""
    text = FENCE.sub(lambda found: re.sub(r"[^\n]", "", found.group()), text)
    return CODE.sub("", text)


def anchors(path):
    """What a git web page makes of the headings: small letters, no punctuation, hyphens for spaces, numbers for repetitions."""
    text = FENCE.sub("", path.read_text(encoding="utf-8"))
    seen, names = {}, set()
    for heading in HEADING.findall(text):
        heading = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        name = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        seen[name] = seen.get(name, -1) + 1
        names.add(f"{name}-{seen[name]}" if seen[name] else name)
    return names


def line_of(text, position):
    return text.count("\n", 0, position) + 1


def check_link(root, path, target):
    if ABSOLUTE.match(target):
        return None
    name, _, anchor = target.partition("#")
    to = (path.parent / urllib.parse.unquote(name)).resolve() if name else path
    if not to.is_relative_to(root) or not to.exists():
        return f"{target}: no such file"
    if anchor and (to.suffix != ".md" or anchor not in anchors(to)):
        return f"{target}: no such heading"
    return None


def check_links(root, path, text):
    """Number of links, and the complaints about them."""
    seen = without_code(text)
    found = [*LINK.finditer(seen), *PICTURE.finditer(seen)]
    complaints = []
    for link in found:
        if complaint := check_link(root, path, link.group(1)):
            complaints.append((line_of(seen, link.start()), complaint))
    return len(found), complaints


def check_cells(text):
    for number, line in enumerate(text.splitlines(), 1):
        if not line.startswith("|"):
            continue
        for cell in re.split(r"(?<!\\)\|", line):
            words = len(cell.split())
            if words > MOST_WORDS:
                yield number, f"a cell of {words} words, more than {MOST_WORDS}: {cell.strip()[:40]}..."


def check_paths(root, text):
    for found in SOURCE_PATH.finditer(text):
        if "NAME" not in found.group(1) and not any(root.glob(found.group(1).rstrip("/"))):
            yield line_of(text, found.start()), f"{found.group(1)}: no such file"


def main():
    arguments = sys.argv[1:]
    paths = "--paths" in arguments
    folders = [a for a in arguments if a != "--paths"]
    root = pathlib.Path(folders[0] if folders else pathlib.Path(__file__).parent.parent).resolve()
    files = links = bad = 0
    for path in documents(root):
        text = path.read_text(encoding="utf-8")
        name = path.relative_to(root).as_posix()
        count, complaints = check_links(root, path, text)
        if name in SHORT_CELLS:
            complaints += check_cells(text)
        if paths and not name.startswith("bench/notebook/"):
            complaints += check_paths(root, text)
        for line, complaint in complaints:
            print(f"{name}:{line}: {complaint}")
        files, links, bad = files + 1, links + count, bad + len(complaints)
    print(f"{files} documents, {links} links, {bad} complaints")
    return 1 if bad or links == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
