// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "pgdr/error.hpp"
#include "pgdr/output_mesh.hpp"

namespace pgdr::detail {

/// Do the indices and the arrays of a mesh, which may be anyone's, fit each other?
/// @param file  what the mesh is called, for the message; may be empty
/// @throws InputError index_out_of_range; UsageError bad_option: no cells
template <int D>
void require_whole(const OutputMesh<D>& mesh, const std::string& file) {
  const std::size_t points = mesh.points.size();
  const auto refuse = [&](const std::string& what) {
    throw InputError({.code = Errc::index_out_of_range, .message = what, .file = file});
  };
  const auto require_vertices = [&](const auto& vertices, const char* what) {
    if (std::ranges::any_of(vertices, [&](std::uint32_t v) { return v >= points; }))
      refuse(std::string(what) + " has a vertex that is none of the " + std::to_string(points) + " points");
  };
  for (const auto& cell : mesh.cells) require_vertices(cell, "a cell");
  for (const auto& s : mesh.subsegments) require_vertices(s.vertices, "a subsegment");
  for (const auto& f : mesh.subfacets) require_vertices(f.vertices, "a subfacet");
  if (!mesh.regions.empty() && mesh.regions.size() != mesh.cells.size()) refuse("the labels are not one a cell");
  if (!mesh.point_markers.empty() && mesh.point_markers.size() != points) refuse("the markers of points are not one a point");
  if (points > 0 && mesh.point_attributes.size() % points != 0) refuse("the attributes are not equally many a point");
  if (mesh.cells.empty()) throw UsageError({.code = Errc::bad_option, .message = "the mesh has no cells", .file = file});
}

}  // namespace pgdr::detail
