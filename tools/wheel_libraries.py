#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""Puts the shared libraries that a wheel for Linux needs into it, with their licences, and names the wheel by the glibc it needs.

tools/wheel_libraries.py WHEEL FOLDER: the new wheel lies in FOLDER. What the policy of manylinux (PEP 600) takes for given stays outside.
Each library gets a name of its own, with a hash of what is in it, so that no other package's of the same name is taken for it. It stays a
file by itself, which whoever wants another version of it can replace, as the LGPL asks for.
"""
import argparse
import hashlib
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tempfile

# PEP 600 and the policies of auditwheel: what each Linux of that glibc has.
GIVEN = re.compile(r"lib(c|m|dl|rt|pthread|util|resolv|nsl|gcc_s|stdc\+\+)\.so\.\d+|ld-linux[-\w]*\.so\.\d+")


def run(*command):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout


def is_elf(file):
    with open(file, "rb") as stream:
        return stream.read(4) == b"\x7fELF"


def needed(file):
    """The names of the libraries that a file asks for, but for those that are given."""
    return [name for name in run("patchelf", "--print-needed", file).split() if not GIVEN.fullmatch(name)]


def where_libraries_are(file):
    """Name -> path, of all that the loader finds for a file."""
    found = dict(re.findall(r"^\s*(\S+) => (/\S+)", run("ldd", file), re.MULTILINE))
    missing = [name for name in needed(file) if name not in found]
    if missing:
        sys.exit(f"{file} needs {', '.join(missing)}, which the loader does not find")
    return found


def own_name(library):
    """libgmp.so.10 -> libgmp-1a2b3c4d.so.10"""
    stem, _, rest = library.name.partition(".so")
    return f"{stem}-{hashlib.sha256(library.read_bytes()).hexdigest()[:8]}.so{rest}"


def licence(library):
    """The file in which Debian keeps the licence of a library, and the name of its package."""
    for path in (library, library.resolve(), pathlib.Path("/usr", *library.resolve().parts[1:])):
        owner = subprocess.run(["dpkg-query", "--search", str(path)], capture_output=True, text=True, check=False).stdout.split(":")[0]
        file = pathlib.Path("/usr/share/doc", owner, "copyright")
        if owner and file.exists():
            return file, owner
    sys.exit(f"{library}: its licence is not found; the wheel must not be given away without it")


def glibc_needed(files):
    versions = [tuple(map(int, v.split("."))) for file in files for v in re.findall(r"GLIBC_(\d+\.\d+)", run("objdump", "-T", file))]
    return max(versions)


def graft(root):
    """@returns all the ELF files in the unpacked wheel, its own and those that were added"""
    binaries = [file for file in sorted(root.rglob("*")) if file.is_file() and is_elf(file)]
    folder = root / "pgdr.libs"
    folder.mkdir()
    added = {}  # name -> where it lies now
    licences = next(root.glob("*.dist-info")) / "licenses"
    todo = [(file, where_libraries_are(file)) for file in binaries]
    while todo:
        file, found = todo.pop()
        for name in needed(file):
            if name in added:
                continue
            library = pathlib.Path(found[name])
            added[name] = folder / own_name(library)
            shutil.copy(library.resolve(), added[name])
            added[name].chmod(0o755)
            text, package = licence(library)
            licences.mkdir(exist_ok=True)
            shutil.copy(text, licences / f"{package}.txt")
            for common in re.findall(r"/usr/share/common-licenses/([-.\w]*\w)", text.read_text()):
                shutil.copy(pathlib.Path("/usr/share/common-licenses", common), licences / common)
            todo.append((added[name], where_libraries_are(library)))
    for file in [*binaries, *added.values()]:
        run("strip", "--strip-unneeded", file)
        way = pathlib.Path(*[".."] * len(file.relative_to(root).parts[:-1]), "pgdr.libs")
        run("patchelf", "--set-rpath", "$ORIGIN" if file.parent == folder else f"$ORIGIN/{way}", file)
        for name in needed(file):
            run("patchelf", "--replace-needed", name, added[name].name, file)
        if file.parent == folder:
            run("patchelf", "--set-soname", file.name, file)
        else:
            file.chmod(0o755)
    for name, file in sorted(added.items()):
        print(f"  {name}: {file.relative_to(root)}, {file.stat().st_size:,} bytes")
    return [*binaries, *added.values()]


def retag(root, tag):
    info = next(root.glob("*.dist-info")) / "WHEEL"
    info.write_text(re.sub(r"(?m)^(Tag: \S+-\S+)-\S+$", rf"\1-{tag}", info.read_text()))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("wheel", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        run(sys.executable, "-m", "wheel", "unpack", "--dest", scratch, arguments.wheel)
        root = next(pathlib.Path(scratch).iterdir())
        files = graft(root)
        major, minor = glibc_needed(files)
        retag(root, f"manylinux_{major}_{minor}_{platform.machine()}")
        packed = pathlib.Path(scratch, "packed")
        packed.mkdir()
        run(sys.executable, "-m", "wheel", "pack", "--dest-dir", packed, root)
        made = pathlib.Path(shutil.move(next(packed.iterdir()), arguments.folder / next(packed.iterdir()).name))
    print(f"{made}: {made.stat().st_size / 1e6:.1f} MB; {len(files)} programs and libraries; glibc {major}.{minor} or later")


if __name__ == "__main__":
    main()
