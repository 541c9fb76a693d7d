// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Where the angles of the input are too small for the bounds: there some cells stay poor in every mesh. A table of the entities.
#pragma once

#include <vector>

#include "input/sharp_angles.hpp"
#include "mesh/mesh.hpp"

namespace pgdr {

/// See above. Immutable once made; any thread.
class SharpPlaces {
 public:
  /// The domain must outlive it. Takes time proportional to the facets and their corners.
  SharpPlaces(const Domain<3>& domain, const AngleBounds& bounds);

  /// Does a vertex with this home lie on a facet with a corner that is too sharp, or on a segment at which two facets meet too
  /// sharply?
  bool touches(Home home) const;

 private:
  const Domain<3>* domain_;
  std::vector<bool> points_, segments_, facets_;  ///< by number: of those
};

}  // namespace pgdr
