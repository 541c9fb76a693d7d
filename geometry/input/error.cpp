// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/error.hpp"

#include <utility>

namespace pgdr {
namespace {

std::string located_message(const Diagnostic& d) {
  std::string s = d.file;
  if (d.line != 0) s.append(s.empty() ? "line " : ":").append(std::to_string(d.line));
  if (!s.empty()) s += ": ";
  return s + d.message;
}

}  // namespace

Error::Error(Diagnostic d) : diagnostic_(std::move(d)), what_(located_message(diagnostic_)) {}

std::string_view name(Errc code) {
  switch (code) {
    case Errc::bad_option: return "bad_option";
    case Errc::bad_size: return "bad_size";
    case Errc::unknown_format: return "unknown_format";
    case Errc::syntax: return "syntax";
    case Errc::truncated: return "truncated";
    case Errc::count_too_large: return "count_too_large";
    case Errc::not_finite: return "not_finite";
    case Errc::index_out_of_range: return "index_out_of_range";
    case Errc::degenerate_segment: return "degenerate_segment";
    case Errc::degenerate_facet: return "degenerate_facet";
    case Errc::self_crossing_facet: return "self_crossing_facet";
    case Errc::entities_intersect: return "entities_intersect";
    case Errc::facets_overlap: return "facets_overlap";
    case Errc::point_on_facet: return "point_on_facet";
    case Errc::point_on_segment: return "point_on_segment";
    case Errc::encloses_nothing: return "encloses_nothing";
    case Errc::seed_on_boundary: return "seed_on_boundary";
    case Errc::conflicting_seeds: return "conflicting_seeds";
    case Errc::tolerance_too_large: return "tolerance_too_large";
    case Errc::no_volume: return "no_volume";
    case Errc::boundary_not_recovered: return "boundary_not_recovered";
    case Errc::not_orientable: return "not_orientable";
    case Errc::bodies_overlap: return "bodies_overlap";
    case Errc::duplicate_point: return "duplicate_point";
    case Errc::near_points: return "near_points";
    case Errc::ambiguous: return "ambiguous";
    case Errc::unreferenced_point: return "unreferenced_point";
    case Errc::repeated_facet: return "repeated_facet";
    case Errc::open_boundary: return "open_boundary";
    case Errc::non_manifold: return "non_manifold";
    case Errc::inconsistent_orientation: return "inconsistent_orientation";
    case Errc::bent_facet: return "bent_facet";
    case Errc::unsure_volume: return "unsure_volume";
    case Errc::small_angle: return "small_angle";
    case Errc::beyond_theory: return "beyond_theory";
    case Errc::unfit_name: return "unfit_name";
    case Errc::cancelled: return "cancelled";
    case Errc::cannot_open: return "cannot_open";
    case Errc::cannot_write: return "cannot_write";
    case Errc::out_of_memory: return "out_of_memory";
    case Errc::ids_exhausted: return "ids_exhausted";
    case Errc::rank_failed: return "rank_failed";
    case Errc::unlike_ranks: return "unlike_ranks";
    case Errc::internal: return "internal";
  }
  return "internal";
}

}  // namespace pgdr
