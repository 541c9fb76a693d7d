// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The JSON report of --report. docs/usage.md describes its keys. A key is there only with a value that was measured.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "json.hpp"
#include "pgdr/arrangement.hpp"
#include "pgdr/bodies.hpp"
#include "pgdr/check.hpp"
#include "pgdr/error.hpp"
#include "pgdr/quality.hpp"
#include "pgdr/ranks.hpp"
#include "pgdr/refine.hpp"
#include "pgdr/surface_counts.hpp"
#include "words.hpp"

namespace pgdr::tool {

/// The report: an object with `errors`, which can be written to a file.
class Report : public JsonObject {
 public:
  void add_error(const Diagnostic& error);
  /// @throws FileError cannot_write
  void write(const std::string& file);

  /// Files that this run has written, if any. They go again should it still end with exit_resource.
  std::vector<std::string> mesh_files;
  std::string trace_file;

 private:
  std::vector<Diagnostic> errors_;
};

JsonObject to_json(const Diagnostic& d);
JsonObject to_json(const QualitySummary& q);
JsonObject to_json(const PoorReason& r);
JsonObject to_json(const RegionVolume& r);
JsonObject to_json(const SurfaceCounts& counts);
JsonObject to_json(const PredicateCounts& counts);  ///< shares by stage, and `calls`
JsonObject to_json(const SchedulerStatistics& s);
JsonObject to_json(const OptimizationStatistics& s, bool finished);  ///< `finished`: the run did, so that its claims hold
JsonObject to_json(const StageTime& s);
JsonObject to_json(const DistributedStatistics& s);
JsonObject to_json(const CheckFinding& finding);
/// An array of these.
template <class Value>
Json to_json(const std::vector<Value>& list) {
  std::vector<Json> values;
  for (const Value& value : list) values.push_back(to_json(value));
  return values;
}

const char* name(RegionMode mode);
const char* name(SharedMarker rule);
const char* name(BodyMode mode);
/// What ended a run: "at --time-limit"; "" if nothing did.
const char* stop_words(StopCause cause);

/// How the bounds were met. Reasons are given for poor cells, and for cells that are not Delaunay.
template <int D>
std::string verdict(const RefineResult<D>& r);

/// Does a cell stay poor beside a small angle of the input that another surface might not have?
template <int D>
bool has_needles(const RefineResult<D>& r);

/// What a report of `pgdr mesh` says that its check needs.
struct ReportedBounds {
  std::vector<PoorReason> reasons;
  bool refined = true;                   ///< to the end, so that the bounds of the run hold
  std::optional<double> radius_edge;     ///< the bound of such a run
  std::optional<double> tolerance;       ///< Domain::tolerance
  std::optional<double> largest_cosine;  ///< of dihedral angles, as the optimiser claims it
  bool delaunay = false;                 ///< does the report say that the mesh is?
  bool conforming_delaunay = false;      ///< 2D: and conforming
  std::uint64_t not_delaunay_left = 0;   ///< faces that it says are not locally Delaunay, other than by rounding
  bool resolve_crossings = false;        ///< what was done to the input
  std::optional<SharedMarker> markers;   ///< 3D, where that was done
  bool close_openings = false;           ///< 3D
  bool convex_hull = false;
  bool region_areas = false;                        ///< how it was read, 2D
  std::vector<std::string> seeds, holes, periodic;  ///< of flags
  bool remeshed = false;                            ///< by `remesh`
  std::vector<std::string> required;                ///< of that
  RegionMode regions = RegionMode::seeds;
  std::optional<BodyMode> bodies;
  std::optional<double> feature_angle;  ///< of another surface
  bool keep_boundary = false;           ///< was it kept?
  std::vector<int> kept_markers;        ///< of these facets alone; empty: of all
};

/// @throws FileError if it cannot be opened, InputError if it is not such a report.
ReportedBounds read_bounds(const std::string& file);

}  // namespace pgdr::tool
