// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A Plc in the making whose facets and segments know which of the input they are pieces of; and the same with pieces in the place
// of the facets and segments that were cut.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "arrange/cut_triangles.hpp"
#include "pgdr/arrangement.hpp"

namespace pgdr::detail {

struct CutPlc {
  explicit CutPlc(const Plc<3>& input);

  /// As it is now, with the markers of the input.
  Plc<3> with_markers_of(const Plc<3>& input) const;

  /// Its markers tell apart, beside those of the input, which way round facets are: what is of one plane and oriented against
  /// each other is never one facet here, so that each piece has one orientation for each facet that covers it.
  Plc<3> plc;
  std::vector<std::uint32_t> origins_begin;  ///< of each facet, one more than facets
  std::vector<PieceOrigin> origins;          ///< those of the input that cover it, the one whose marker it has first
  std::vector<int> markers_of_input;    ///< of each facet of the input its marker here: twice its rank, and 1 more on the front
  std::vector<std::uint32_t> segments;  ///< of each segment that of the input; no_entity: an edge drawn inside a facet

  std::span<const PieceOrigin> origins_of(std::uint32_t f) const {
    return std::span(origins).subspan(origins_begin[f], origins_begin[f + 1] - origins_begin[f]);
  }
};

/// Of the triangles of a Domain the facets of the input that cover each, the one whose marker it has first.
class PieceOrigins {
 public:
  PieceOrigins(const CutPlc& given, const Domain<3>& domain, SharedMarker rule) : given_(given), domain_(domain), rule_(rule) {}

  /// Of triangle k of facet f.
  std::vector<PieceOrigin> of(EntityId f, std::uint32_t k) const;

 private:
  const CutPlc& given_;
  const Domain<3>& domain_;
  SharedMarker rule_;
};

/// The next of `given`, whose Domain this is. Facets that have a triangle that was cut, or bear another marker than the rule
/// says, are their triangles and pieces from now on, in the place of the first; all others stay as they are.
/// @returns false if nothing changes
bool replace_cut(CutPlc& given, const Domain<3>& domain, const CutTriangles& cut, SharedMarker rule);

}  // namespace pgdr::detail
