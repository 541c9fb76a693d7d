#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""The rules of the source tree that a compiler does not hold. Prints what breaks them; exit code 1 if anything does.

  * every source opens with the SPDX lines and has at most 500 lines;
  * a layer includes its own headers and those of lower layers only: geometry <- core <- scheduler <- mpi <- tools, bench;
  * a room, a folder of a layer, includes its own headers and those of the rooms that ROOMS lets it reach;
  * a public header (<layer>/pgdr/) includes public headers alone, belongs to one room, and no two layers have one of the same
    name; every other header is private;
  * tools, examples and bench see public headers alone, but for the programs of THE_INSIDE;
  * README.md shows the table of rooms as it is here;
  * CGAL is included by .cpp files and private headers of the layers only;
  * function templates of headers whose namespace bears PGDR_API have it where they are instantiated (export.hpp);
  * what never returns takes no std::string or std::vector by value: g++ 12 (-O3, several files as one) takes its stores for
    dead, and so has what was moved from destroyed twice on the way out;
  * a public header is listed in the CMakeLists.txt of its layer, so that it is installed and compiled alone;
  * modules of the Python package import each other in no circle, wherever in a module the import stands.

Usage: check_sources.py [ROOT]     (default: the repository of this script)
       check_sources.py --rooms    (prints the table of rooms as Markdown)
"""
import collections
import pathlib
import re
import sys

LAYERS = ["geometry", "core", "scheduler", "mpi"]

# The rooms of the layers, lowest first. `may`: the rooms that it may include, all of them further up in this table, beside its
# own; it may then include what these may. Every room of core/ and scheduler/ may include those of geometry/. `start`: the files to
# read first. `public`: the headers of <layer>/pgdr/ that belong to the room; who includes one includes the room.
Room = collections.namedtuple("Room", "question may start public")
ROOMS = {
    "geometry": {
        "numbers": Room("what is the sign, and is the bound met, exactly?", "",
                        "predicates.cpp predicates_bounds.cpp", "predicates circumsphere"),
        "space": Room("which of many boxes, points, triangles meet?", "numbers", "box_tree.hpp", ""),
        "input": Room("which points, segments and facets does an input have, and where is a point of one?", "space",
                      "entities.hpp point_on_entity.cpp", "plc domain"),
        "join": Room("what of an input meets within the tolerance, and how is a facet triangulated?", "input",
                     "distinct_points.cpp facet_triangulator.hpp", "planar_plc joined_plc kept_edges"),
        "hull": Room("what is the convex hull of the points of an input?", "join", "space_hull.cpp", "convex_hull"),
        "build": Room("which facets are one plane, and how does an input become a Domain?", "join", "domain_builder.cpp", ""),
        "volumes": Room("which volumes do walls separate, and what does a ray meet first?", "space", "wall_volumes.hpp", ""),
        "diagnose": Room("what is wrong with an input, and where?", "input volumes", "diagnosis.cpp cell_estimate.cpp",
                         "diagnosis estimate surface_counts"),
        "arrange": Room("which pieces are facets that cross, and whose are they?", "build diagnose",
                        "arrangement.cpp crossings.hpp exact_cdt.hpp", "arrangement"),
        "bodies": Room("which solids do facets mean, which polygons segments, and what of space is whose?", "arrange",
                       "body_volumes.hpp region_groups.hpp polygon_seeds.cpp", "bodies planar_map"),
        "openings": Room("which openings of a surface lie in a plane, and what closes them?", "build",
                         "planar_caps.hpp open_loops.hpp", "openings"),
        "replace": Room("which other surface is within a distance of it?", "build diagnose", "complex.hpp replace_surface.cpp whole_facets.cpp", "surface whole_facets"),
        "select": Room("where may a point go?", "numbers", "selectors.cpp", "point_selector selectors"),
    },
    "core": {
        "output": Room("what is a finished mesh?", "", "mesh_maps.cpp",
                       "output_mesh mesh_fields mesh_maps mesh_piece region_mode region_volume remesh_input poor_reason flat_arrays voronoi"),
        "weld": Room("do meshes, or sides of one, match, and what is one mesh of them?", "output", "boundaries.cpp", "mesh_join periodic"),
        "quality": Room("how good is a finished mesh?", "output", "quality.cpp", "quality"),
        "size": Room("how large may a cell be here?", "output", "size_fields.cpp", "sizing size_fields"),
        "transfer": Room("what lives on a mesh, on another one?", "output", "transfer.cpp common_part.hpp", "transfer"),
        "mesh": Room("what are cells, vertices and constraints, and who owns them?", "", "mesh.hpp visit_area.hpp", ""),
        "rule": Room("may a point go in, and why does that end?", "mesh size", "insertion_rule.hpp", "refine_options"),
        "cavity": Room("what does a new point delete and make?", "rule", "cavity.hpp", ""),
        "boundary": Room("how do the input's segments, facets and regions get into the mesh?", "cavity",
                         "recovery.hpp labeling.hpp", ""),
        "change": Room("how do cells change without a new point?", "rule", "replacement.hpp flips.hpp", ""),
        "refine": Room("what waits, what is encroached or hidden, what is split?", "cavity change",
                       "refiner.hpp element_splitter.hpp encroachment.hpp", ""),
        "optimize": Room("which change makes the worst cells better?", "refine", "optimizer.hpp", ""),
        "kept": Room("how does a kept boundary do without points of its own?", "optimize", "withdrawal.hpp", ""),
        "reasons": Room("which small angle is to blame for a poor element?", "refine", "poor_reasons.hpp", ""),
        "compact": Room("how is the finished mesh numbered?", "mesh output", "compact.hpp", ""),
        "enclosed": Room("which volumes does an input as given enclose?", "output", "input_volumes.hpp", ""),
        "given": Room("does a finished mesh consist of what was given, and of nothing else?", "size enclosed", "match.hpp leftovers.cpp",
                      "check"),
        "nearness": Room("is the mesh's surface within a distance of the given one?", "given", "nearness.hpp near_set.hpp", "facet_places"),
        "check": Room("is a finished mesh what it should be?", "nearness", "check.cpp", "check_bodies"),
        "paths": Room("how do whole files come from a path and go to one?", "", "write_target.hpp file_output.hpp", "output_files"),
        "scan": Room("what do the characters of a file say?", "", "line_scanner.hpp", ""),
        "io": Room("which format says what, read and written?", "output weld paths scan", "io.cpp read/ply.cpp", "io field_io"),
    },
    "scheduler": {
        "tree": Room("which leaf is a point in, what is around it, how does it split?", "", "orthtree.hpp", ""),
        "graph": Room("what runs visits that wait for each other?", "", "visit_graph.hpp", ""),
        "claims": Room("what may a visit change, and which visits wait?", "tree graph mesh rule", "claim.hpp", ""),
        "visits": Room("what waits, who works it off, and what is told of it?", "claims reasons output", "visit_runner.hpp waiting_work.hpp",
                       "refine"),
        "plans": Room("which leaf is refined when?", "visits", "planner.hpp generations.hpp", ""),
        "run": Room("how does an input become a mesh?",
                    "plans boundary kept compact given transfer weld", "refine.cpp refinement.hpp", "pgdr make_periodic remesh"),
        "transport": Room("how do ranks talk to each other?", "", "collectives.hpp", "transport"),
        "ranks": Room("how do several ranks make one mesh?", "run transport io quality check", "refine.cpp", "ranks"),
    },
    "mpi": {
        "processes": Room("how do processes talk by MPI?", "ranks", "mpi.cpp", "mpi"),
    },
}
EVERYWHERE = {"export", "types", "error", "names", "version"}  # public headers of geometry/ that belong to no room
UMBRELLA = "scheduler/pgdr/pgdr.hpp"  # includes all public headers
# What measures the phases of an insertion one by one, and what shows the method on them.
THE_INSIDE = {"bench/bench_phases.cpp", "tools/examples/refine_by_hand.cpp"}
FIRST_LINE, LAST_LINE = "<!-- rooms: python3 tools/check_sources.py --rooms -->\n", "<!-- end of rooms -->\n"
# A declaration of a function template, to its semicolon; an explicit instantiation.
TEMPLATE = re.compile(r"^template <int D>\n(?!struct|class|using)[^;{(]*?\b(\w+)\([^;{]*;", re.MULTILINE)
INSTANTIATION = re.compile(r"^\s*template (?!<|class|struct)[^;(]*?\b(\w+)(?:<[23D]>)?\(")
# A parameter by value of a function that never returns.
MOVED_AWAY = re.compile(r"\[\[noreturn\]\][^;{]*?[(,]\s*(std::(?:string|vector<[^;{}()&]*>) \w+)\s*[,)=]")
SOURCES = {".cpp", ".hpp", ".py", ".cmake", ".sh", ".js"}
SCRIPTS = ["demo", "run-tests", ".ci/run", ".ci/long", ".ci/stages.sh", ".ci/style", ".ci/install-packages"]
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


def reach():
    """Of each room, the set of rooms whose headers it may include; and complaints about ROOMS itself."""
    reached, complaints = {}, []
    for layer, rooms in ROOMS.items():
        for room, entry in rooms.items():
            reached[room] = {room}
            for other in entry.may.split():
                if other in reached:
                    reached[room] |= reached[other]
                else:
                    complaints.append(f"ROOMS: {room} may include {other}, which is not further up")
            if layer != "geometry":
                reached[room] |= set(ROOMS["geometry"])
    return reached, complaints


def room_of_headers(root):
    """Room of each header of the layers, by the name it is included with; None: it belongs to no room."""
    rooms = {}
    for layer in LAYERS:
        for path in (root / layer).rglob("*.hpp"):
            name = path.relative_to(root / layer)
            rooms[name.as_posix()] = name.parts[0]
        for room, entry in ROOMS[layer].items():
            rooms.update({f"pgdr/{stem}.hpp": room for stem in entry.public.split()})
    rooms.update({f"pgdr/{stem}.hpp": None for stem in EVERYWHERE})
    return rooms


def check_includes(root, path, text, layer_of, room_of, reached, used):
    """`used` gets the pairs of rooms of which the one includes the other."""
    parts = path.relative_to(root).parts
    folder, public = parts[0], len(parts) > 2 and parts[1] == "pgdr"
    if folder not in LAYERS + ["tools", "bench"] or path.suffix not in {".cpp", ".hpp"}:
        return
    name = "/".join(parts[1:])
    here = room_of.get(name) if public else parts[1]
    for name in INCLUDE.findall(text):
        private = name in room_of and not name.startswith("pgdr/")
        if name.startswith("pgdr/"):
            if name not in layer_of:
                yield f"includes {name}, which no layer has"
            elif folder in LAYERS and LAYERS.index(layer_of[name]) > LAYERS.index(folder):
                yield f"includes {name} of the higher layer {layer_of[name]}"
        if private and (public or folder not in LAYERS) and "/".join(parts) not in THE_INSIDE:
            yield f"includes the private header {name}"
        if folder in LAYERS and "/".join(parts) != UMBRELLA and here and room_of.get(name):
            used.add((here, room_of[name]))
            if room_of[name] not in reached.get(here, set()):
                yield f"includes {name} of {room_of[name]}, which {here} may not"
        if name.startswith("CGAL/") and (public or folder not in LAYERS):
            yield f"includes {name}: only the inside of a layer may"


def check_rooms(root, layer_of, room_of):
    """Every folder of a layer is a room, and every public header belongs to one."""
    for layer in LAYERS:
        folders = {path.relative_to(root / layer).parts[0] for path in (root / layer).rglob("*.[ch]pp")}
        for folder in sorted(folders ^ (set(ROOMS[layer]) | {"pgdr"})):
            yield f"{layer}/{folder}: in ROOMS or in the tree, not in both"
        for room, entry in ROOMS[layer].items():
            for start in entry.start.split():
                if not (root / layer / room / start).is_file():
                    yield f"{layer}/{room}/{start}: not there, and ROOMS has it as a start"
    for name in sorted(layer_of.keys() ^ {name for name in room_of if name.startswith("pgdr/")}):
        yield f"{name}: a public header in ROOMS or in the tree, not in both"
    for name in sorted(name for name in layer_of if room_of.get(name) == "pgdr"):
        yield f"{layer_of[name]}/{name}: belongs to no room"
    readme = (root / "README.md").read_text(encoding="utf-8")
    if FIRST_LINE + table_of_rooms() + LAST_LINE not in readme:
        yield f"README.md: lacks what `check_sources.py --rooms` prints, between {FIRST_LINE.strip()} and {LAST_LINE.strip()}"


def table_of_rooms():
    """As Markdown, the highest room first."""
    lines = ["| room | what it answers | may include | start at |", "| --- | --- | --- | --- |"]
    for layer, rooms in reversed(ROOMS.items()):
        for room, entry in reversed(rooms.items()):
            may, start = (", ".join(f"`{word}`" for word in words.split()) for words in (entry.may, entry.start))
            lines.append(f"| `{layer}/{room}` | {entry.question} | {may} | {start} |")
    return "\n".join(lines) + "\n"


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


def check_python(folder):
    """Complaints about circles of imports among the modules of a package."""
    imports = {}
    for path in sorted(folder.glob("*.py")):
        text = path.read_text(encoding="utf-8")
        names = set(re.findall(r"^\s*from \.(\w+) import", text, re.MULTILINE))
        for listed in re.findall(r"^\s*from \. import ([\w, ]+)", text, re.MULTILINE):
            names.update(listed.replace(" ", "").split(","))
        imports[path.stem] = names
    while free := [name for name, needed in imports.items() if not needed & imports.keys()]:
        for name in free:
            del imports[name]
    if imports:
        yield f"{folder.name}: in circles of imports, or above them: {', '.join(imports)}"


def main():
    if sys.argv[1:] == ["--rooms"]:
        print(table_of_rooms(), end="")
        return 0
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent).resolve()
    reached, complaints = reach()
    layer_of = {}
    for name, layer in public_headers(root):
        if name in layer_of:
            complaints.append(f"{layer}/{name}: {layer_of[name]} has a header of the same name")
        layer_of[name] = layer
        if name not in (root / layer / "CMakeLists.txt").read_text(encoding="utf-8").split():
            complaints.append(f"{layer}/{name}: not listed in {layer}/CMakeLists.txt")
    complaints += check_python(root / "tools" / "python" / "pgdr")
    exported = exported_templates(root)
    room_of = room_of_headers(root)
    complaints += check_rooms(root, layer_of, room_of)
    number, used = 0, set()
    for path in sources(root):
        text = path.read_text(encoding="utf-8")
        number += 1
        for complaint in [*check_text(path, text), *check_includes(root, path, text, layer_of, room_of, reached, used),
                          *check_noreturn(path, text), *check_exports(path, text, exported)]:
            complaints.append(f"{path.relative_to(root)}: {complaint}")
    for rooms in ROOMS.values():
        complaints += [f"ROOMS: {room} includes nothing of {other}" for room, entry in rooms.items()
                       for other in entry.may.split() if (room, other) not in used]
    for complaint in complaints:
        print(complaint)
    print(f"{number} files, {len(complaints)} complaints")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
