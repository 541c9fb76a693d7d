// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The bound flags as the library takes them, one reading for `mesh` and `check`.
#pragma once

#include <optional>

#include "options.hpp"
#include "pgdr/sizing.hpp"

namespace pgdr::tool {

template <int D>
struct Bounds {
  double radius_edge;
  SizingField<D> size;
  RegionSizes<D> region_sizes;
  double max_volume;
  std::optional<double> min_dihedral;  ///< degrees; none: not asked for
};

/// @throws UsageError for a flag of the other dimension or a size that cannot be used.
template <int D>
Bounds<D> resolve(const BoundArguments& arguments, double default_radius_edge);

}  // namespace pgdr::tool
