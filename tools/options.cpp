// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "options.hpp"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <utility>

#include "bound_options.hpp"
#include "command.hpp"
#include "console.hpp"
#include "files.hpp"
#include "periodic.hpp"
#include "pgdr/io.hpp"
#include "remesh_options.hpp"
#include "selector.hpp"
#include "surface_options.hpp"
#include "text.hpp"
#include "validators.hpp"
#include "version.hpp"
#include "view_options.hpp"

namespace pgdr::tool {
namespace {

constexpr const char* exit_codes =
    "Exit codes: 0 done and every bound met; 1 done, elements stayed poor for listed reasons; 2 wrong usage; "
    "3 invalid input; 4 a file or standard output cannot be opened or written; 5 stopped by a budget or a signal, valid partial "
    "mesh "
    "written; 6 a check failed; 7 out of memory or an internal error, no output file.";

constexpr int most_threads = 1024;  // what TBB starts, it starts all at once: too many would take a machine down

const std::map<std::string, Schedule> schedules{
    {"reproducible", Schedule::reproducible}, {"uniform", Schedule::uniform}, {"greedy", Schedule::greedy}};

const std::map<std::string, ClaimRule> claim_rules{{"boxes", ClaimRule::boxes}, {"leaves", ClaimRule::leaves}};

const std::map<std::string, SharedMarker> shared_markers{
    {"smallest", SharedMarker::smallest}, {"first", SharedMarker::first}, {"last", SharedMarker::last}};
const std::map<std::string, RegionMode> region_modes{
    {"seeds", RegionMode::seeds}, {"auto", RegionMode::automatic}, {"all", RegionMode::all}};

const std::map<std::string, BodyMode> body_modes{{"union", BodyMode::united},
                                                 {"fragments", BodyMode::fragments},
                                                 {"priority", BodyMode::priority},
                                                 {"disjoint", BodyMode::disjoint}};

/// All of these, for the words of --regions.
const std::map<std::string, std::optional<BodyMode>> region_words = [] {
  std::map<std::string, std::optional<BodyMode>> all;
  for (const auto& [word, unused] : region_modes) all[word] = std::nullopt;
  for (const auto& [word, mode] : body_modes) all[word] = mode;
  return all;
}();

const std::map<std::string, DiskType> disk_types{{"type1", DiskType::type1}, {"type2", DiskType::type2}};

bool is_seed(const std::string& text) { return split_seed(text).has_value(); }
bool is_hole(const std::string& text) { return is_seed(text) && text.find('=') == std::string::npos; }

void add_input(CLI::App& app, InputArguments& p) {
  app.add_option(
         "--format", p.format,
         "the format of a file that is -, standard input or output, as an extension: --format off; of both: --format off,vtu")
      ->type_name("EXT[,EXT]");
  app.add_option(
         "--tolerance", p.tolerance,
         "what lies within T meets, in the units of the coordinates: points are one, or lie on edges and facets, and facets of "
         "one plane are one (default: the rounding of doubles, or of floats in .stl and .ply; 0: exactly as given)")
      ->type_name("T")
      ->check(number(">= 0", [](double v) { return v >= 0; }));
  app.add_option(
         "--seed", p.seeds,
         "a point in a region, and its label: a number, or a name, whose number is that of the input's region of this name, or "
         "the least that is free; without one 0. Besides those of the input; repeatable. 2D: X,Y=LABEL")
      ->type_name("X,Y,Z=LABEL")
      ->allow_extra_args(false)
      ->check(shaped(is_seed, "X,Y,Z=LABEL, in 2D X,Y=LABEL: a point in a region, and its label or name"));
  app.add_option("--hole", p.holes, "a point in what stays empty, besides those of the input; repeatable. 2D: X,Y")
      ->type_name("X,Y,Z")
      ->allow_extra_args(false)
      ->check(shaped(is_hole, "X,Y,Z, in 2D X,Y: a point in what stays empty"));
  app.add_flag("--yes-coarse", p.yes_coarse, "a --tolerance above a thousandth of the model's diagonal is meant");
  auto* resolve = app.add_flag("--resolve-crossings", p.resolve_crossings,
                               "split segments that cross, in 3D also facets that do and what goes through them, at new points");
  app.add_option_function<std::string>(
         "--markers", [&p](const std::string& t) { p.markers = shared_markers.at(t); },
         "3D: whose marker a piece has that several facets cover: smallest (default), the facet of smallest area; first, or "
         "last, "
         "in the input")
      ->type_name("NAME")
      ->check(one_of(shared_markers, "ways to choose markers"))
      ->needs(resolve);
  app.add_flag(
      "--close-planar-openings", p.close_openings,
      "3D: openings of the surface whose loops lie in a plane, within the tolerance, are closed by facets with markers of "
      "their own, named closed_opening_1, ...");
  app.add_flag("--region-areas", p.region_areas,
               "2D: a region of a .poly that has one number behind its point has it as label and as largest area");
  app.add_flag("--convex-hull", p.convex_hull,
               "the edges (3D: facets) of the convex hull of all points are segments (facets), too");
}

template <class Mode>  // a RegionMode, maybe an optional one
void add_regions(CLI::App& app, Mode& mode, std::optional<BodyMode>& bodies) {
  app.add_option_function<std::string>(
         "--regions",
         [&mode, &bodies](const std::string& t) {
           bodies = region_words.at(t);
           mode = bodies ? RegionMode::seeds : region_modes.at(t);
         },
         "seeds (default): the hole and region seeds of the input say what is meshed and "
         "labelled; auto: voids by nesting, and a label for each volume; all: no voids but of hole seeds, and a label for each "
         "enclosed volume. 3D, by winding numbers of bodies: union: a label each connected solid; fragments: a label each set of "
         "bodies; priority: a label each body, the first one has what several share; disjoint: as fragments, but bodies that "
         "overlap are refused")
      ->type_name("NAME")
      ->check(one_of(region_words, "ways to tell regions"));
}

void add_periodic(CLI::App& app, std::vector<std::string>& periodic, const char* what) {
  app.add_option("--periodic", periodic, what)
      ->type_name("FROM=TO[:MOTION]")
      ->allow_extra_args(false)
      ->check(shaped(is_periodic, "FROM=TO or FROM=TO:MOTION: two markers, and 6 numbers (3D: 12), row by row"));
}

void add_report(CLI::App& app, std::string& report, bool& quiet) {
  app.add_option("--report", report, "write what was done and found as one JSON object")->type_name("FILE.json");
  app.add_flag("--quiet", quiet, "print errors only");
}

void add_output(CLI::App& app, MeshArguments& a) {
  app.add_option("-o,--output", a.output,
                 "the mesh: .vtu .pvtu .vtk .msh .mesh .node .ele; for other programs also .inp .mfem, or a folder polyMesh")
      ->required()
      ->type_name("OUTPUT");
  app.add_option("--pieces", a.pieces, ".pvtu: in so many files, X_0.vtu, X_1.vtu, ... (default: 1)")
      ->type_name("K")
      ->check(whole_number(1, most_pieces));
  app.add_flag("--neighbors", a.neighbors, ".node, .ele: write X.neigh, too, the neighbours of each cell");
  app.add_flag("--edges", a.edges, ".node, .ele: all edges in X.edge, not the subsegments alone");
  app.add_option("--first-index", a.first_index, ".node, .ele: count from 0 or 1 (default: as a .poly, .smesh or .node input; 1)")
      ->type_name("N")
      ->check(whole_number(0, 1));
  app.add_option(
         "--order", a.order,
         "2: .msh, .vtu and .inp of second order, with a node in the middle of each edge, which stays straight (default: 1)")
      ->type_name("1|2")
      ->check(whole_number(1, 2));
  app.add_flag("--leaves", a.leaves, ".vtu: say of each cell which leaf of the tree it was refined in");
}

/// What `mesh` and `remesh` share.
void add_run(CLI::App& app, MeshArguments& a) {
  add_output(app, a);
  auto* min_dihedral = add_bounds(app, a.bounds, "2 in 3D, sqrt 2 in 2D, the smallest with a proof",
                                  "15; 0 with a --selector other than circumcenter");
  app.add_flag("--no-optimize", a.no_optimize,
               "3D: leave the refined mesh as it is, Delaunay, with any dihedral angles; as --min-dihedral 0")
      ->excludes(min_dihedral);
  add_input(app, a.reading);
  add_surface(app, a.surface, "mesh another surface, within this distance of the given one both ways, without its needles");
  app.add_option("--surface-output", a.surface.output,
                 "3D: write the other surface, too: .poly, or triangles as .off .obj .ply .stl")
      ->type_name("FILE")
      ->needs("--surface-tolerance");
  add_regions(app, a.regions, a.reading.bodies);
  auto* keep = add_kept(app, a.kept, "no new points on the boundary, of which every given triangle stays as it is");
  add_periodic(app, a.periodic,
               "the sides with these markers, or names, of segments (3D: facets) correspond vertex by vertex; repeatable. By the "
               "translation between them, or a rigid motion of 6 (3D: 12) numbers, row by row: x' = a x + b y + c, ...");
  app.add_flag("--conforming-delaunay", a.conforming_delaunay,
               "2D: split segments until every triangle is Delaunay across them, too, and its circumcentre in the domain")
      ->excludes(keep);
  app.add_option("--voronoi", a.voronoi,
                 "2D: write the Voronoi cells of the vertices, too, clipped to the domain, as a text: .voronoi")
      ->type_name("FILE")
      ->needs("--conforming-delaunay");
  app.add_flag("--drop-unused-points", a.drop_unused_points,
               "leave points that are in no cell, outside or in voids, out of the mesh");
  app.add_flag("--no-refine", a.no_refine,
               "2D: the constrained Delaunay triangulation, without new points; 3D: the "
               "triangulation with its boundary recovered");
  app.add_option("--selector", a.selector,
                 "where new points go: circumcenter (default in 3D), off-center[:FACTOR] (default in 2D), "
                 "optimized[:SAMPLES], sliver-avoiding[:CANDIDATES], random[:SEED]")
      ->type_name("NAME")
      ->check(CLI::Validator([](std::string& text) { return selector_error(text); }, "", "selector"));
  app.add_option_function<std::string>(
         "--disk", [&a](const std::string& t) { a.disk = disk_types.at(t); },
         "selection disk: type1 or type2 (default: type2, or type1 for a selector other "
         "than circumcenter without --delta)")
      ->type_name("TYPE")
      ->check(one_of(disk_types, "disks"));
  app.add_option("--delta", a.delta, "radius of a type 2 disk, 1 - D circumradii; 0 (default): as far as the bound allows")
      ->type_name("D")
      ->check(number("between 0 and 1", [](double v) { return v >= 0 && v <= 1; }));
  app.add_option("--threads", a.threads, "threads to use (default: one a core); the mesh does not depend on it")
      ->type_name("N")
      ->check(whole_number(1, most_threads));
  app.add_option_function<std::string>(
         "--schedule", [&a](const std::string& t) { a.schedule = schedules.at(t); },
         "reproducible (default): the same mesh for any number of threads; uniform: that, by leaves of one size, for sizes that "
         "vary little and for runs of many ranks; greedy: whatever is free runs next, and the mesh depends on timing")
      ->type_name("NAME")
      ->check(one_of(schedules, "schedules"));
  app.add_option_function<std::string>(
         "--claims", [&a](const std::string& t) { a.claims = claim_rules.at(t); },
         "what a visit of a leaf keeps others out of. boxes (default): its box, grown by its side; leaves: whole leaves around "
         "it, "
         "so that fine leaves beside a coarse one wait for each other; the mesh depends on it")
      ->type_name("RULE")
      ->check(one_of(claim_rules, "rules of claims"));
  app.add_option(
         "--lattice", a.lattice,
         "with --schedule uniform: at most 2^K cells of the lattice along each axis, K up to 7, in 2D 10 (default: by the "
         "number of elements); the mesh "
         "depends on it")
      ->type_name("K")
      ->check(whole_number(1, most_lattice<2>()));
  app.add_option("--granularity", a.granularity,
                 "a visit of a leaf ends this many halvings of the circumradius below its largest (default: when the "
                 "leaf has no work left); the mesh depends on it")
      ->type_name("G")
      ->check(whole_number(1, std::numeric_limits<int>::max()));
  app.add_option("--min-edge", a.min_edge, "refuse points that would make an edge shorter than this, and say so")
      ->type_name("E")
      ->excludes("--voronoi")
      ->check(number(">= 0", not_negative));
  app.add_option("--max-vertices", a.max_vertices, "stop with a valid partial mesh at this number of vertices")
      ->type_name("N")
      ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()));
  app.add_option("--time-limit", a.time_limit, "stop with a valid partial mesh after this time")
      ->type_name("SECONDS")
      ->check(number(">= 0", not_negative));
  app.add_option("--rank-timeout", a.rank_timeout,
                 "pgdr-mpi: give up when a rank has waited for another for this time (default: never)")
      ->type_name("SECONDS")
      ->check(number("> 0", [](double v) { return v > 0; }));
  add_report(app, a.report, a.quiet);
  app.add_option("--trace", a.trace, "write when each leaf was visited, and by which thread, as Chrome trace events")
      ->type_name("FILE.json");
}

void add_mesh(CLI::App& app, MeshArguments& a) {
  app.add_option("INPUT", a.inputs,
                 "what to mesh: .poly .smesh .node .off .obj .ply .stl .mesh .msh .vtk .geojson; several files are one input")
      ->required()
      ->type_name("");
  add_run(app, a);
}

void add_remesh(CLI::App& app, MeshArguments& a) {
  app.add_option("MESH", a.inputs, "the mesh: .vtu .pvtu .vtk .msh .mesh .node .ele")->required()->expected(1)->type_name("");
  add_remesh_options(app, a);
  add_run(app, a);
}

void add_refine(CLI::App& app, MeshArguments& a) {
  app.add_option("MESH", a.inputs, "the mesh: .vtu .pvtu .vtk .msh .mesh .node .ele")->required()->expected(1)->type_name("");
  add_refine_options(app, a);
  add_run(app, a);
}

void add_check(CLI::App& app, CheckArguments& a) {
  app.add_option("MESH", a.mesh, "the mesh to check: .vtu .pvtu .vtk .msh .mesh .node .ele")->required()->type_name("");
  app.add_option("--input", a.inputs,
                 "what it is a mesh of, as often as there are files, in their order; without it, conformity is not checked")
      ->type_name("INPUT")
      ->allow_extra_args(false);
  add_bounds(app, a.bounds, "that of the report of --reasons; none without one", "likewise");
  app.add_flag("--delaunay", a.delaunay,
               "ask for a Delaunay mesh, also where the report of --reasons does not say that it is one");
  app.add_flag("--conforming-delaunay", a.conforming_delaunay,
               "2D: likewise across segments, and with circumcentres in the domain, as of mesh --conforming-delaunay");
  app.add_flag("--list-not-delaunay", a.list_not_delaunay,
               "list the cells with a vertex inside their circumsphere across a face that is no subfacet; changes no verdict");
  add_input(app, a.reading);
  add_regions(app, a.regions, a.reading.bodies);
  add_kept(app, a.kept, "the boundary was to be kept: no points on it that were not given, and each given triangle is there");
  add_surface(app, a.surface,
              "the mesh is of another surface, and is to be within E of the given one, both ways, with its topology, markers and "
              "volumes");
  app.get_option("--surface-tolerance")->needs("--input");
  add_remeshed(app, a);
  app.add_option("--reasons", a.reasons, "report of `pgdr mesh`, whose bounds.reasons explain poor cells")
      ->type_name("REPORT.json")
      ->needs("--input");
  add_periodic(app, a.periodic, "as of `mesh`: do these sides correspond? (default: those of the report of --reasons)");
  add_report(app, a.report, a.quiet);
}

void add_info(CLI::App& app, InfoArguments& a) {
  app.add_option("FILE", a.files, "an input, which may be several files, or a mesh")->required()->type_name("");
  add_input(app, a.reading);
  add_surface(app, a.surface, "say what `mesh` would make of the surface within this distance");
  add_regions(app, a.regions, a.reading.bodies);
  app.add_option("--write-problems", a.problems,
                 "what is wrong or odd with an input, as geometry with kinds and numbers: .vtp .vtk .vtu .obj")
      ->type_name("FILE");
  add_report(app, a.report, a.quiet);
}

void add_join(CLI::App& app, JoinArguments& a) {
  app.add_option("MESH", a.meshes, "the meshes, two or more: .vtu .pvtu .vtk .msh .mesh .node .ele")
      ->required()
      ->expected(2, std::numeric_limits<int>::max())
      ->type_name("");
  app.add_option("-o,--output", a.output,
                 "the one mesh: .vtu .pvtu .vtk .msh .mesh .node .ele; for other programs also .inp .mfem, or a folder polyMesh")
      ->required()
      ->type_name("OUTPUT");
  app.add_flag("--relabel", a.relabel,
               "labels of different files become different ones, 1, 2, ...; without it equal labels stay one label");
  add_report(app, a.report, a.quiet);
}

/// What --help and --version ask for. @returns the exit code
int print_help(const CLI::App& app, const CLI::Success& asked) {
  app.exit(asked);
  try {
    require_printed();
    return exit_done;
  } catch (const FileError& e) {
    std::cerr << "pgdr: error: " << e.what() << '\n';
    return exit_file;
  }
}

/// The flag of a subcommand that may have been meant; empty if none is near.
std::string nearest_flag(const CLI::App& app, const std::string& word) {
  std::size_t least = 3;
  std::string nearest;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames())
      if (const std::size_t letters = letters_between("--" + name, word); letters < least) {
        least = letters;
        nearest = "--" + name;
      }
  return nearest;
}

/// What is wrong, with the word that is, and those that would not be. CLI11 says all but which words it has not understood.
std::string explain(const CLI::App& app, const CLI::ParseError& e, int argc, const char* const* argv) {
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  if (parsed.empty()) {
    std::string names;
    for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
      names += (names.empty() ? "" : ", ") + sub->get_name();
    return "the subcommands are " + names + (argc > 1 ? std::string(", not \"") + argv[1] + '"' : std::string());
  }
  if (e.get_exit_code() != static_cast<int>(CLI::ExitCodes::ExtrasError)) return e.what();
  for (const std::string& word : app.remaining(true)) {
    if (!word.starts_with('-')) continue;
    const std::string flag = word.substr(0, word.find('=')), nearest = nearest_flag(*parsed.front(), flag);
    return parsed.front()->get_name() + " has no flag " + flag + (nearest.empty() ? "" : "; there is " + nearest);
  }
  return e.what();
}

}  // namespace

std::optional<std::pair<std::string, std::string>> split_region_size(const std::string& text) {
  const std::size_t at = text.find('=');
  if (at == 0 || at == std::string::npos || at + 1 == text.size()) return std::nullopt;
  return std::pair{text.substr(0, at), text.substr(at + 1)};
}

std::optional<SeedText> split_seed(const std::string& text) {
  const std::size_t at = text.find('=');
  SeedText seed{numbers(text.substr(0, at)), at == std::string::npos ? "" : text.substr(at + 1)};
  const bool is_point = seed.point.size() == 2 || seed.point.size() == 3;
  if (!is_point || (at != std::string::npos && seed.label.empty())) return std::nullopt;
  return seed;
}

std::optional<double> label_number(const std::string& text) {
  double label = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), label);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(label)) return std::nullopt;
  return label;
}

const char* name(Schedule schedule) {
  for (const auto& [word, value] : schedules)
    if (value == schedule) return word.c_str();
  return "";
}

const char* name(ClaimRule rule) {
  for (const auto& [word, value] : claim_rules)
    if (value == rule) return word.c_str();
  return "";
}

std::variant<Arguments, int> parse(int argc, const char* const* argv, bool speaks) {
  MeshArguments mesh, remesh, refine;
  CheckArguments check;
  InfoArguments info;
  ViewArguments view;
  JoinArguments join;

  CLI::App app("pgdr: Delaunay meshes with guaranteed quality, in 3D and 2D", "pgdr");
  app.set_version_flag("--version", version_words());
  app.require_subcommand(1);
  app.footer(exit_codes);
  auto* mesh_app = app.add_subcommand("mesh", "Mesh an input");
  add_mesh(*mesh_app, mesh);
  auto* remesh_app = app.add_subcommand("remesh", "Mesh anew what a mesh fills, and take its fields along");
  add_remesh(*remesh_app, remesh);
  auto* refine_app = app.add_subcommand("refine", "Add points to a mesh, whose vertices all stay");
  add_refine(*refine_app, refine);
  auto* check_app = app.add_subcommand("check", "Check a mesh with exact arithmetic, from the files alone");
  add_check(*check_app, check);
  add_info(*app.add_subcommand("info", "What is in an input or a mesh"), info);
  auto* view_app = app.add_subcommand("view", "Draw a mesh");
  add_view(*view_app, view);
  add_report(*view_app, view.report, view.quiet);
  auto* join_app = app.add_subcommand("join", "Make one mesh of several whose boundaries match");
  add_join(*join_app, join);

  try {
    app.parse(argc, argv);
    name_streams(mesh);
    name_streams(remesh);
    name_streams(refine);
    name_streams(check);
    name_streams(info);
  } catch (const UsageError& e) {
    if (speaks) std::cerr << "pgdr: error: " << e.what() << '\n';
    return exit_usage;
  } catch (const CLI::Success& e) {  // --help, --version
    return speaks ? print_help(app, e) : exit_done;
  } catch (const CLI::ParseError& e) {
    if (speaks) std::cerr << "pgdr: error: " << explain(app, e, argc, argv) << "\nRun pgdr --help for the usage.\n";
    return exit_usage;
  }
  if (mesh_app->parsed()) return Arguments(std::move(mesh));
  if (remesh_app->parsed()) return Arguments(std::move(remesh));
  if (refine_app->parsed()) return Arguments(std::move(refine));
  if (check_app->parsed()) return Arguments(std::move(check));
  if (view_app->parsed()) return Arguments(std::move(view));
  if (join_app->parsed()) return Arguments(std::move(join));
  return Arguments(std::move(info));
}

}  // namespace pgdr::tool
