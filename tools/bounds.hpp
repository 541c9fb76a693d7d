// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The bound flags as the library takes them, one reading for `mesh` and `check`.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "options.hpp"
#include "pgdr/names.hpp"
#include "pgdr/size_fields.hpp"
#include "pgdr/sizing.hpp"

namespace pgdr::tool {

/// Sizes of regions by their names.
template <int D>
using RegionSizesByName = std::vector<std::pair<std::string, SizingField<D>>>;

template <int D>
struct Bounds {
  double radius_edge;
  SizingField<D> size;
  RegionSizes<D> region_sizes;
  double max_volume;
  std::optional<double> min_dihedral;  ///< degrees; none: not asked for
  RegionSizesByName<D> named_sizes;    ///< of regions whose labels are not known yet
};

/// That of the flag, or the usual one.
template <int D>
SizeUnit unit_of(const BoundArguments& arguments) {
  return arguments.size_unit.value_or(usual_size_unit<D>());
}

/// Sizes given at the vertices or on the cells of a mesh, in the unit of the flags, with their growth.
/// @throws as sizes_on_mesh
template <int D>
SizingField<D> sizes_as_asked(const OutputMesh<D>& mesh, std::vector<double> values, const BoundArguments& arguments);

/// @throws UsageError for a flag of the other dimension or a size that cannot be used.
template <int D>
Bounds<D> resolve(const BoundArguments& arguments, double default_radius_edge);

/// Gives the sizes of named regions to the labels of these names. @throws UsageError for a name that no region has
template <int D>
void resolve_names(const Names& names, Bounds<D>& bounds);

}  // namespace pgdr::tool
