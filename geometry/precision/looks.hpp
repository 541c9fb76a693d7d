// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How exact coordinates are, by how far facets that look planar are off. Pure functions, any thread.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "pgdr/types.hpp"

namespace pgdr {

/// What tells facets that are one plane but for rounding from bent ones.
struct LooksOfPlanes {
  std::size_t within_gap = 20;  ///< one distance between d and 10 d for so many below it at most, which is an accident
  double known = 0;  ///< a precision that faces are planar with at the least: the least d then, not the largest; 0: none
};

/// apparent_precision, of distances of facets from each other's planes, of so many edges; `known` if none is larger and it is
/// given.
double precision_of_distances(std::vector<double> off, std::size_t edges, const LooksOfPlanes& looks);

/// Has no coordinate more than nine significant digits?
bool has_few_digits(std::span<const Point3> points);

}  // namespace pgdr
