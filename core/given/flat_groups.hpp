// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which given triangles may be one facet with others, and lie in its plane only within the tolerance.
#pragma once

#include <vector>

#include "given/given_input.hpp"
#include "space/disjoint_sets.hpp"

namespace pgdr::checking {

/// Whether a triangle and a point may all be within `reach` of one plane. True of triangles that are not ten times as high.
bool may_be_even(const std::array<Point3, 3>& triangle, const Point3& point, double reach);
/// Whether both triangles may be: also where one is far from the other, as a plane that turns about the first one turns all of
/// the second by as much.
bool may_be_even(const std::array<Point3, 3>& triangle, const std::array<Point3, 3>& other, double reach);

/// Sets of given triangles, each of one facet: joined across edges of two triangles of one marker that may lie within the
/// tolerance of one plane. Behind them are `further` numbers, each a set of its own. @param seams set to triangles at such edges
/// that are not exactly in one plane with the other; may be null
detail::DisjointSets flat_groups(const GivenInput<3>& input, std::size_t further, std::vector<std::uint32_t>* seams);

/// Of each given triangle: it is joined, across edges of two triangles of one marker that may lie within the tolerance of one
/// plane, to some that do not lie in one plane exactly. The union of such ones may be triangulated anew; all is then within the
/// tolerance of a plane, so within twice that of what was given.
std::vector<bool> triangles_of_uneven_groups(const GivenInput<3>& input);

}  // namespace pgdr::checking
