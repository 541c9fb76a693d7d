// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Where segments of the input cross, or edges of facets that overlap: the mesh has a vertex there, also outside of its cells,
// that is no point of the input.
#pragma once

#include <memory>
#include <vector>

#include "check/given/given_input.hpp"
#include "space/box_tree.hpp"

namespace pgdr::checking {

template <int D>
class GivenCrossings {
 public:
  /// Of edges that pass within r of a place.
  GivenCrossings(const GivenInput<D>& input, double r);
  /// Two that are not of one line pass there.
  bool has(const Point<D>& x) const;

 private:
  using Ends = std::array<Point<D>, 2>;
  double reach_;
  std::vector<Ends> edges_;
  std::unique_ptr<detail::BoxTree<D>> tree_;
};

}  // namespace pgdr::checking
