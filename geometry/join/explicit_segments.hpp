// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The segments that the input names: Plc::segments, then (3D) the facets of one polygon of two corners, as TetGen's files
// have loose ones.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "join/build_input.hpp"
#include "join/build_report.hpp"

namespace pgdr::detail {

template <int D>
class ExplicitSegments {
 public:
  /// Segments whose ends are one point are among the repairs.
  ExplicitSegments(const BuildInput<D>& in, BuildReport<D>& report);

  /// The distinct points of each; twice the same of one of no length, which is dropped.
  std::span<const std::array<std::uint32_t, 2>> ends() const { return ends_; }
  /// 3D: the numbers of those whose first point is v.
  std::span<const std::uint32_t> from(std::uint32_t v) const {
    return std::span(from_).subspan(from_begin_[v], from_begin_[v + 1] - from_begin_[v]);
  }
  bool is_line_facet(std::uint32_t f) const { return std::binary_search(line_facets_.begin(), line_facets_.end(), f); }

  bool is_in_plc(std::uint32_t s) const { return s < in_.plc.segments.size(); }
  /// Its index in Plc::segments, or in Plc::facets.
  std::uint32_t item_of(std::uint32_t s) const { return is_in_plc(s) ? s : line_facets_[s - in_.plc.segments.size()]; }
  int marker_of(std::uint32_t s) const { return is_in_plc(s) ? in_.plc.segments[s].marker : in_.plc.facets[item_of(s)].marker; }

 private:
  static void drop(const char* kind, std::uint32_t item, std::array<std::uint32_t, 2> ends, BuildReport<D>& report);
  void take_line_facets(BuildReport<D>& report);
  void index_by_first();

  BuildInput<D> in_;
  std::vector<std::array<std::uint32_t, 2>> ends_;
  std::vector<std::uint32_t> line_facets_;        // of each further segment its facet
  std::vector<std::uint32_t> from_begin_, from_;  // by their first point
};

}  // namespace pgdr::detail
