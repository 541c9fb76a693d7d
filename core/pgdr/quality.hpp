// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a mesh is worth: worst radius-edge ratio, smallest and largest (dihedral) angle, histogram. Doubles, for reports;
// whether a bound holds is decided by the exact functions of predicates.hpp.
#pragma once

#include <array>
#include <cstdint>

#include "pgdr/export.hpp"
#include "pgdr/output_mesh.hpp"

namespace pgdr PGDR_API {

/// The quality of all cells of a mesh.
struct QualitySummary {
  double max_radius_edge = 0;                 ///< circumradius over shortest edge
  double min_angle_deg = 180;                 ///< the smallest of the angles of triangles in 2D, dihedral angles in 3D
  double max_angle_deg = 0;                   ///< the largest of these angles
  std::array<std::uint64_t, 18> histogram{};  ///< number of those angles in [10 i, 10 i + 10) degrees
};

/// Angles of one simplex in degrees: 3 corners (2D), 6 dihedral angles (3D, edges 01 02 03 12 13 23).
template <int D>
std::array<double, D == 2 ? 3 : 6> angles_deg(const Simplex<D>& s);

/// Linear time, on the calling thread.
template <int D>
QualitySummary summarize_quality(const OutputMesh<D>& mesh);

}  // namespace pgdr
