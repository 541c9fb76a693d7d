// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What is wrong with an input, and where: everything at once, for a person who is to repair it. Decisions are exact and
// without tolerance; coordinates of intersections, lengths and angles are rounded. Of each kind all are counted and the
// first few listed, in an order that depends on the input alone. Near-linear time (a million triangles take about
// a second) but for inputs of long thin triangles whose boxes all overlap and that are in no fans. Pure functions; long
// loops run on the threads of the caller's tbb::task_arena, and any number of calls may run at once.
//
// Meant are the facets as their triangles (see domain.hpp), the segments that no facet has, and the points; two of these
// may have common corners, and the edge between these, and nothing else in common.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string_view>
#include <vector>

#include "pgdr/domain.hpp"
#include "pgdr/error.hpp"
#include "pgdr/export.hpp"
#include "pgdr/plc.hpp"

namespace pgdr PGDR_API {

/// Kinds of findings. Those up to `encloses_nothing` are errors: no mesh has these entities.
enum class Finding : std::uint8_t {
  invalid_entity,         ///< what Domain refuses, by its own codes; found by diagnose(Plc) alone
  facets_cross,           ///< pairs of facets; where: along which segment
  facets_overlap,         ///< pairs of facets with an area of one plane in common
  segment_crosses_facet,  ///< a segment of no facet
  segments_cross,         ///< of no facet (2D: all)
  point_on_facet,         ///< inside it, without being a point of it
  point_on_segment,       ///< inside a segment, or an edge of a facet
  encloses_nothing,       ///< facets (2D: segments) none of which could bound a volume (area); see open_boundary
  // Reported only.
  duplicate_point,           ///< merged; ids: it, and the first at its place
  unreferenced_point,        ///< of no facet and no segment
  repeated_facet,            ///< or segment (2D); left out
  open_boundary,             ///< loop (or path) of edges of one facet each: its points; measure: its length. 2D: a point
                             ///< where one segment ends
  near_points,               ///< two on open boundaries, within a millionth of the extent (or four ulps of a float): they may
                             ///< be meant to be one. measure: their distance; greatest first
  non_manifold_edge,         ///< of more than two facets
  non_manifold_point,        ///< whose facets hang together there at this point alone
  inconsistent_orientation,  ///< an edge that its two facets run through in the same direction
  segments_below_60,         ///< two segments at a point; measure, here and below: the angle in degrees, least first
  segment_facet_below_90,    ///< a segment and a facet at a point
  facets_below_90,           ///< two facets at a segment
};
inline constexpr std::size_t finding_kinds = 19;  ///< so many

/// The stable snake_case word of the JSON report.
std::string_view name(Finding kind);
/// Does an input with such a finding have no mesh?
constexpr bool is_error(Finding kind) { return kind <= Finding::encloses_nothing; }

/// The findings of one kind.
struct FindingList {
  /// One of them.
  struct Item {
    Diagnostic what;     ///< ids, points, line: as everywhere
    double measure = 0;  ///< degrees of an angle, length of an open boundary
  };
  std::uint64_t count = 0;   ///< all of them
  std::vector<Item> listed;  ///< the first of them
};

/// How much is to be found out.
struct DiagnosisOptions {
  std::size_t most_listed = 20;  ///< of each kind
  bool errors_only = false;      ///< look for nothing that is reported only, but for open boundaries
  /// Ends it, from any thread, by a CancelledError: in some milliseconds, but for the making of a search tree, which takes up to
  /// a fifth of a second for a million triangles.
  std::stop_token stop = {};
  bool parallel = true;  ///< on the threads of the caller's tbb::task_arena; else on the calling thread alone
};

/// What was found. A value.
template <int D>
struct Diagnosis {
  std::array<FindingList, finding_kinds> found;  ///< by kind

  const FindingList& operator[](Finding kind) const { return found[static_cast<std::size_t>(kind)]; }  ///< of one kind
  FindingList& operator[](Finding kind) { return found[static_cast<std::size_t>(kind)]; }              ///< of one kind
  std::uint64_t error_count() const;  ///< all errors, listed or not
  /// The listed errors, kind by kind.
  std::vector<Diagnostic> errors() const;
};

/// All that is wrong with a prepared input.
/// @throws CancelledError
template <int D>
Diagnosis<D> diagnose(const Domain<D>& domain, const DiagnosisOptions& options = {});
/// Of an input that Domain may refuse: its reasons first, then what is wrong with the rest.
/// @throws CancelledError
template <int D>
Diagnosis<D> diagnose(const Plc<D>& plc, const DiagnosisOptions& options = {});

/// The same; `prepared` gets what Domain(plc) would be, if that refuses nothing.
template <int D>
Diagnosis<D> diagnose(const Plc<D>& plc, const DiagnosisOptions& options, std::optional<Domain<D>>& prepared);

/// The question that `refine` asks first. It costs nothing where the Domain knows already that nothing meets. `parallel`: as
/// DiagnosisOptions::parallel.
/// @throws DiagnosedError the first error, if there is one, and how many more there are, with the first of each kind as its
///   diagnostics; CancelledError.
template <int D>
void require_no_errors(const Domain<D>& domain, const std::stop_token& stop = {}, bool parallel = true);

}  // namespace pgdr
