// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The arguments of the command as data. docs/usage.md describes every flag.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "kept.hpp"
#include "pgdr/refine_options.hpp"
#include "pgdr/size_fields.hpp"
#include "pgdr/types.hpp"
#include "treatment.hpp"
#include "view/page.hpp"

namespace pgdr::tool {

/// The bounds that `mesh` makes and `check` verifies.
struct BoundArguments {
  std::optional<double> radius_edge;
  std::optional<std::string> size;        ///< a number or an expression in x, y, z
  std::vector<std::string> region_sizes;  ///< LABEL=S each, S as above
  std::string size_mesh;                  ///< a background mesh, with its sizes in a .sol file beside it; empty: none
  std::string size_field;                 ///< a field with sizes of the mesh that is the input; empty: none
  std::string size_at;                    ///< a file of points and lines with sizes; empty: none
  std::optional<double> size_growth;      ///< of these sizes; none: as they are; of those of size_at: 0.2
  std::optional<SizeUnit> size_unit;      ///< of all sizes; none: as usual for the dimension
  std::optional<double> max_volume;
  std::optional<double> min_angle;
  std::optional<double> min_dihedral;
};

/// How an input is read, and what is done to it before anything else.
struct InputArguments : Treatment {
  std::string format;         ///< extension of what comes from standard input, and perhaps, behind a comma, of what goes out
  bool region_areas = false;  ///< ReadOptions::region_areas
  std::optional<double> tolerance;  ///< none: the default of Plc
  bool yes_coarse = false;          ///< Plc::is_coarse
  std::vector<std::string> seeds;   ///< further region seeds, X,Y,Z or X,Y,Z=LABEL each (2D: X,Y)
  std::vector<std::string> holes;   ///< further hole seeds
};

/// 3D: another surface, near the given one.
struct SurfaceArguments {
  std::optional<std::string> tolerance;  ///< E or E% (surface_tolerance.hpp); none: the given surface
  std::optional<double> feature_angle;   ///< degrees; none: as a report says, or the default
  std::string output;                    ///< of `mesh`: where the other surface is written; empty: nowhere
};

inline constexpr const char* all_vertices = "all";  ///< in the place of markers of required vertices

/// What `remesh` is told of the old mesh beside what `mesh` is told of an input.
struct RemeshArguments {
  std::vector<std::string> required;  ///< markers, or their names, of vertices that stay
  bool no_fields = false;             ///< fields stay behind
  bool keep_vertices = false;         ///< `refine`
  std::string cell_bounds;            ///< of `refine`: a .vol or .area file; empty: none
};

struct MeshArguments {
  std::optional<RemeshArguments> remesh;  ///< the input is a mesh
  std::vector<std::string> inputs;        ///< one or more
  std::string output;
  std::optional<int> first_index;                         ///< of .node and .ele; none: as in the input, or 1
  std::optional<std::uint64_t> pieces;                    ///< of a .pvtu; none: one
  int order = 1;                                          ///< of the mesh that is written, 1 or 2
  bool edges = false, neighbors = false, leaves = false;  ///< what is written beside the mesh
  BoundArguments bounds;
  InputArguments reading;
  SurfaceArguments surface;
  bool conforming_delaunay = false;  ///< 2D
  std::string voronoi;               ///< 2D: the file of Voronoi cells; empty: none
  KeptArguments kept;
  bool no_refine = false, no_optimize = false, drop_unused_points = false;
  std::optional<std::string> selector;  ///< NAME or NAME:PARAMETER (selector.hpp); none: as usual for the dimension
  std::optional<DiskType> disk;         ///< none: as usual for the selector
  std::vector<std::string> periodic;    ///< FROM=TO or FROM=TO:MOTION each (periodic.hpp)
  RegionMode regions = RegionMode::seeds;
  double delta = 0;
  std::optional<int> threads;  ///< none: one a core
  Schedule schedule = Schedule::reproducible;
  ClaimRule claims = ClaimRule::boxes;
  std::optional<int> lattice;      ///< none: by the number of elements
  std::optional<int> granularity;  ///< none: a visit ends when its leaf has no work left
  double min_edge = 0;
  std::optional<std::uint64_t> max_vertices;
  std::optional<double> time_limit;
  std::optional<double> rank_timeout;  ///< seconds; none: a rank waits for the others as long as it takes
  std::string report;                  ///< empty: none
  std::string trace;                   ///< empty: none
  bool quiet = false;
};

struct CheckArguments {
  std::string mesh;
  std::vector<std::string> inputs;  ///< empty: conformity is not checked
  BoundArguments bounds;
  InputArguments reading;
  KeptArguments kept;
  std::optional<RegionMode> regions;  ///< none: as `reasons` says, or seeds
  bool remeshed = false;              ///< the input is a mesh, of which `remesh` has made this one
  std::vector<std::string> required;  ///< RemeshArguments::required
  SurfaceArguments surface;
  std::vector<std::string> periodic;  ///< as of `mesh`; empty: as `reasons` says
  std::string reasons;                ///< a report of `mesh`
  bool delaunay = false;              ///< is it to be Delaunay?
  bool conforming_delaunay = false;   ///< 2D: across subsegments, too
  bool list_not_delaunay = false;     ///< the cells that are not
  std::string report;
  bool quiet = false;
};

struct InfoArguments {
  std::vector<std::string> files;  ///< one mesh, or one or more inputs
  InputArguments reading;
  SurfaceArguments surface;
  RegionMode regions = RegionMode::seeds;
  std::string problems;  ///< what is wrong, as geometry; empty: not written
  std::string report;
  bool quiet = false;
};

enum class ViewColor { quality, dihedral, region, leaf, of_pages };

struct ViewArguments {
  std::string mesh, output;
  ViewColor color = ViewColor::quality;
  std::string coloring = "quality";  ///< the word of `color`; a page has more of them
  std::optional<CutPlane> cut;       ///< 3D
  std::optional<Point3> from;        ///< 3D: towards the eye, not the origin; none: as usual
  int width = 1000;                  ///< in pixels
  std::string report;
  bool quiet = false;
};

struct JoinArguments {
  std::vector<std::string> meshes;  ///< two or more
  std::string output;
  bool relabel = false;
  std::string report;
  bool quiet = false;
};

using Arguments = std::variant<MeshArguments, CheckArguments, InfoArguments, ViewArguments, JoinArguments>;

/// Label, which may be a name, and size of a --region-size; none if there is nothing before or behind its first "=".
std::optional<std::pair<std::string, std::string>> split_region_size(const std::string& text);

/// A --seed or --hole.
struct SeedText {
  std::vector<double> point;  ///< two or three coordinates
  std::string label;          ///< a number or a name; empty: none was given
};
/// None if that is not what the text is.
std::optional<SeedText> split_seed(const std::string& text);
/// The finite number that a label is; none: it is a name.
std::optional<double> label_number(const std::string& text);

/// The word of --schedule.
const char* name(Schedule schedule);
/// The word of --claims.
const char* name(ClaimRule rule);

/// Parses the command line. The exit code if there is nothing left to do: --help, --version, and wrong usage, which are printed
/// here, if `speaks`.
std::variant<Arguments, int> parse(int argc, const char* const* argv, bool speaks = true);

}  // namespace pgdr::tool
