// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What is left of given triangles, plane by plane, in triangles that meet each other and the walls of the mesh at common edges,
// so that the volumes between all of them are those of the input.
//
// How many given triangles cover a place of their plane changes across edges of these alone, by as many as have the place on
// their one side more than on the other; so it is known everywhere from its changes: it is 0 far away. The same holds of the
// subfacets of the mesh. So the borders of what is left are found without a look at any place, and a diagonal, or the common
// border of two facets, is none. The sum of the changes round a point is 0 however it is rounded.
#pragma once

#include <map>
#include <span>

#include "enclosed/input_volumes.hpp"
#include "given/match.hpp"

namespace pgdr::checking {

/// The corners of what is left over, by the points of the input.
template <int D>
class CornersOfPoints {
 public:
  /// All must outlive it.
  CornersOfPoints(const GivenInput<D>& input, const GivenMatch<D>& match, std::vector<Point<D>>& corners)
      : input_(&input), match_(&match), corners_(&corners) {}

  /// The vertex of the mesh in the place of p, or else a new corner.
  std::uint32_t operator()(std::uint32_t p) {
    if (match_->vertex_of_point[p] != none) return match_->vertex_of_point[p];
    const auto [at, is_new] = of_places_.try_emplace(input_->place(p), static_cast<std::uint32_t>(corners_->size()));
    if (is_new) corners_->push_back(input_->point(p));
    return at->second;
  }

 private:
  const GivenInput<D>* input_;
  const GivenMatch<D>* match_;
  std::vector<Point<D>>* corners_;
  std::map<std::uint32_t, std::uint32_t> of_places_;
};

/// Appends them to the walls of the mesh, each an entity of its own. Corners are vertices of the mesh where it has any.
/// @param kept  further edges between points of the input, that are edges of what is appended wherever they lie in its planes
/// @throws InputError entities_intersect, if the leftovers make no complex.
void append_flat_leftovers(const GivenTask<3>& task, const GivenMatch<3>& match, VolumeWalls<3>& walls,
                           std::span<const std::array<std::uint32_t, 2>> kept = {});

}  // namespace pgdr::checking
