// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pgdr/domain.hpp"
#include "pgdr/surface.hpp"
#include "replace/patch_tests.hpp"

namespace pgdr::detail {

/// Says of a surface what is reported, and makes a Plc of it. Made before the surface changes.
class ResultMaker {
 public:
  ResultMaker(const Plc<3>& input, const Domain<3>& domain, const ChangingSurface& surface);

  /// The counts of a report: `when` 0 as given, 1 in the end.
  void measure(SurfaceReport& report, std::size_t when) const;
  /// Sets the Plc, what its facets are near, and the distances of the report.
  void make(ReplacedSurface& out) const;

 private:
  void add_point_data(const std::vector<std::uint32_t>& vertices, Plc<3>& plc) const;
  void add_attributes(std::uint32_t vertex, Plc<3>& plc) const;
  std::uint32_t class_at(std::uint32_t vertex) const;
  void measure_distances(SurfaceReport& report) const;

  const Plc<3>& input_;
  const Domain<3>& domain_;
  const ChangingSurface& s_;
  std::vector<std::array<std::uint32_t, 3>> corners_;  ///< of each given triangle
  std::vector<std::uint32_t> facets_;                  ///< of the input, of each given triangle
};

}  // namespace pgdr::detail
