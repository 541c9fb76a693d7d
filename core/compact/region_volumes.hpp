// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The volumes of regions (2D: areas), as meshed and as given, both by the divergence theorem and exactly: over the subfacets
// between two labels, and over those triangles of the input's facets in whose place these are. Sums that are exact do not depend
// on where their terms were added up, so who has a part of the mesh adds up that.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "numbers/exact_sum.hpp"
#include "pgdr/region_volume.hpp"
#include "space/pieces.hpp"

namespace pgdr {

/// The largest face of cells on one side of an entity; of several, the one of the cell with the least label.
struct LargestFace {
  double size = -1;  ///< no face yet
  std::uint32_t label = 0xffffffffu;

  void take(const LargestFace& o) {
    if (o.size > size || (o.size == size && o.label < label)) *this = o;
  }
};
/// On the side of the entity's normal (2D: on the left), and on the other.
using SidesOfEntity = std::array<LargestFace, 2>;

/// What those do together who have a part of the mesh each. This is who has all of it.
class VolumesInParts {
 public:
  virtual ~VolumesInParts() = default;
  /// Is the cell of this part? Each cell is of one. On several threads.
  virtual bool is_own(CellId) const { return true; }
  /// Runs the step. What it throws for one it throws for all.
  virtual void together(const std::function<void()>& step) { step(); }
  /// Makes of each face the one that is left when those of all parts have been taken.
  virtual void join(std::span<SidesOfEntity>) {}
  /// Makes of each sum that of all parts.
  virtual void add(std::span<detail::ExactSum>) {}
};

/// One entry a label that cells have, ascending. Needs a time in proportion to the subfacets, and a look at every cell's tag.
/// @param pieces  the threads
/// @param region_attributes  the attribute of each region number; empty: cells get no labels
/// @pre the exterior has been carved away
template <int D>
std::vector<RegionVolume> region_volumes(const Mesh<D>& mesh, const Domain<D>& domain, std::span<const double> region_attributes,
                                         const detail::Pieces& pieces);
/// The same of a mesh in parts, for all.
template <int D>
std::vector<RegionVolume> region_volumes(const Mesh<D>& mesh, const Domain<D>& domain, std::span<const double> region_attributes,
                                         const detail::Pieces& pieces, VolumesInParts& parts);

}  // namespace pgdr
