#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The rules of the source tree that a compiler does not hold. Prints what breaks them; exit code 1 if anything does.

  * every source opens with the SPDX lines and has at most 500 lines;
  * a layer includes its own headers and those of lower layers only: geometry <- core <- scheduler <- tools, bench;
  * a public header (<layer>/pgdr/) includes public headers alone, and no two layers have one of the same name;
  * tools and bench see public headers alone;
  * CGAL and Eigen are included by .cpp files and private headers of the layers only;
  * function templates of headers whose namespace bears PGDR_API have it where they are instantiated (export.hpp);
  * what never returns takes no std::string or std::vector by value: g++ 12 (-O3, several files as one) takes its stores for
    dead, and so has what was moved from destroyed twice on the way out;
  * a public header is listed in the CMakeLists.txt of its layer, so that it is installed and compiled alone.

Usage: check_sources.py [ROOT]     (default: the repository of this script)
"""
import pathlib
import re
import sys

LAYERS = ["geometry", "core", "scheduler"]
# A declaration of a function template, to its semicolon; an explicit instantiation.
TEMPLATE = re.compile(r"^template <int D>\n(?!struct|class|using)[^;{(]*?\b(\w+)\([^;{]*;", re.MULTILINE)
INSTANTIATION = re.compile(r"^\s*template (?!<|class|struct)[^;(]*?\b(\w+)(?:<[23D]>)?\(")
# A parameter by value of a function that never returns.
MOVED_AWAY = re.compile(r"\[\[noreturn\]\][^;{]*?[(,]\s*(std::(?:string|vector<[^;{}()&]*>) \w+)\s*[,)=]")
SOURCES = {".cpp", ".hpp", ".py", ".cmake", ".sh"}
SCRIPTS = ["demo", "run-tests", ".ci/run", ".ci/long", ".ci/stages.sh", ".ci/install-packages"]
MOST_LINES = 500
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)


def sources(root):
    for folder in LAYERS + ["tools", "bench", "tests", "cmake", "docs"]:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in SOURCES or path.name == "CMakeLists.txt":
                yield path
    yield root / "CMakeLists.txt"
    for script in SCRIPTS:
        yield root / script


def public_headers(root):
    """Layer of each public header, by the name it is included with."""
    return [(f"pgdr/{path.name}", layer) for layer in LAYERS for path in sorted((root / layer / "pgdr").glob("*.hpp"))]


def check_text(path, text):
    if path.name == "readme_example.cpp":  # the README's text, to the letter
        return
    if len(text.splitlines()) > MOST_LINES:
        yield f"{len(text.splitlines())} lines, more than {MOST_LINES}"
    head = text[:400]
    if "SPDX-License-Identifier: Apache-2.0" not in head:
        yield "no SPDX-License-Identifier at its head"
    if path.suffix in {".cpp", ".hpp"} and "SPDX-FileCopyrightText:" not in head:
        yield "no SPDX-FileCopyrightText at its head"


def check_includes(root, path, text, layer_of):
    parts = path.relative_to(root).parts
    folder, public = parts[0], len(parts) > 2 and parts[1] == "pgdr"
    if folder not in LAYERS + ["tools", "bench"]:
        return
    for name in INCLUDE.findall(text):
        if name.startswith("pgdr/"):
            if name not in layer_of:
                yield f"includes {name}, which no layer has"
            elif folder in LAYERS and LAYERS.index(layer_of[name]) > LAYERS.index(folder):
                yield f"includes {name} of the higher layer {layer_of[name]}"
        if "detail/" in name and (public or folder not in LAYERS):
            yield f"includes the private header {name}"
        if name.startswith(("CGAL/", "Eigen/")) and (public or folder not in LAYERS):
            yield f"includes {name}: only the inside of a layer may"


def exported_templates(root):
    """Names of function templates that are declared, and not defined, where the namespace bears PGDR_API."""
    names = set()
    for name, layer in public_headers(root):
        text = (root / layer / name).read_text(encoding="utf-8")
        if "namespace pgdr PGDR_API {" in text:
            names.update(TEMPLATE.findall(text))
    return names


def check_noreturn(path, text):
    for found in MOVED_AWAY.findall(text) if path.suffix in {".cpp", ".hpp"} else ():
        yield f"a function that never returns takes {found} by value"


def check_exports(path, text, exported):
    for line in text.splitlines() if path.suffix == ".cpp" else ():
        instance = INSTANTIATION.match(line)
        if instance and instance.group(1) in exported and not line.strip().startswith("template PGDR_API "):
            yield f"lacks PGDR_API: {line.strip()}"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent).resolve()
    complaints = []
    layer_of = {}
    for name, layer in public_headers(root):
        if name in layer_of:
            complaints.append(f"{layer}/{name}: {layer_of[name]} has a header of the same name")
        layer_of[name] = layer
        if name not in (root / layer / "CMakeLists.txt").read_text(encoding="utf-8").split():
            complaints.append(f"{layer}/{name}: not listed in {layer}/CMakeLists.txt")
    exported = exported_templates(root)
    number = 0
    for path in sources(root):
        text = path.read_text(encoding="utf-8")
        number += 1
        for complaint in [*check_text(path, text), *check_includes(root, path, text, layer_of),
                          *check_noreturn(path, text), *check_exports(path, text, exported)]:
            complaints.append(f"{path.relative_to(root)}: {complaint}")
    for complaint in complaints:
        print(complaint)
    print(f"{number} files, {len(complaints)} complaints")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
