#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of gallery.md by what is written there: blocks of Python, and lines of commands, in their order.

Usage: PGDR_COMMAND=build/release/pgdr PYTHONPATH=build/release/python docs/gallery.py FOLDER     (docs/images/gallery)

Commands of Python are left out where scipy is not there. Prints the pictures and their sizes.
"""
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "gallery.md"
BLOCK = re.compile(r"^```(python|sh)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
COMMAND = os.environ.get("PGDR_COMMAND", "pgdr")


def has_scipy():
    try:
        import scipy  # noqa: F401
    except ImportError:
        return False
    return True


def run_line(line, there):
    """`there`: whether what needs scipy can be made."""
    words = shlex.split(line)
    if words[0] == "python3":
        if there:
            subprocess.run([sys.executable, "-B", *words[1:]], check=True, stdout=subprocess.DEVNULL)
        return
    if words[0] != "pgdr":
        raise SystemExit(f"{PAGE}: {line}: neither pgdr nor python3")
    if words[1] == "view" and not pathlib.Path(words[2]).exists() and not there:
        return
    done = subprocess.run([shutil.which(COMMAND) or COMMAND, *words[1:], "--quiet"], check=False)
    if done.returncode not in (0, 1):
        raise SystemExit(f"{line}: ended with {done.returncode}")


def make(folder):
    """Runs the page in a folder that has the repository's tests and tools. Returns the pictures."""
    for name in ("tests", "tools"):
        (folder / name).symlink_to(ROOT / name)
    text, names, there = PAGE.read_text(encoding="utf-8"), {"__name__": "gallery"}, has_scipy()
    for found in BLOCK.finditer(text):
        if found.group(1) == "python":
            lines_before = text[:found.start()].count("\n") + 1
            exec(compile("\n" * lines_before + found.group(2), str(PAGE), "exec"), names)  # pylint: disable=exec-used
        else:
            for line in found.group(2).splitlines():
                run_line(line, there)
    return sorted(folder.glob("*.svg"))


def main():
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    target, here = pathlib.Path(sys.argv[1]).resolve(), os.getcwd()
    global COMMAND
    COMMAND = str(pathlib.Path(COMMAND).resolve()) if os.sep in COMMAND else COMMAND
    target.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="pgdr_") as name:
        os.chdir(name)
        try:
            for picture in make(pathlib.Path(name)):
                shutil.copy(picture, target / picture.name)
                print(f"{picture.name} {picture.stat().st_size}")
        finally:
            os.chdir(here)


if __name__ == "__main__":
    main()
