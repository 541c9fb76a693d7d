// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How large the facets are, at least and at most, that given triangles are of. Where facets of different markers overlap in a
// plane, the smaller one says which marker is that of both. Which given facets become one, across edges that are no segments, is
// not told again here: bounds of it are enough.
#pragma once

#include <span>
#include <vector>

#include "given/given_input.hpp"
#include "space/box_tree.hpp"

namespace pgdr::checking {

class FacetSizes {
 public:
  /// @param near   a tree of boxes of the given triangles, which meet where these touch
  /// @param reach  of each given triangle, how far the mesh may be from it
  FacetSizes(const GivenInput<3>& input, const detail::BoxTree<3>& near, std::span<const double> reach);

  /// Every facet that triangle t is of is as large at least: as the given one.
  double least(std::uint32_t t) const { return least_[input_.triangles()[t].facet]; }
  /// And as large at most: as all triangles of its marker that hang together about it and may lie in its plane.
  double most(std::uint32_t t) const { return most_[t]; }

 private:
  const GivenInput<3>& input_;
  std::vector<double> least_, most_;
};

}  // namespace pgdr::checking
