// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a mesh is worth: worst radius-edge ratio, angles (in 3D dihedral ones), radius ratio, scaled Jacobian; of all cells and of
// each region. Doubles, for reports; whether a bound holds is decided by the exact functions of predicates.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/output_mesh.hpp"

namespace pgdr PGDR_API {

/// Values of one measure over cells. The 1 % quantile is the least value such that at least one in a hundred cells has no more.
struct MeasureSummary {
  double least = 0;        ///< of the worst cell
  double one_percent = 0;  ///< the 1 % quantile, good to seven digits
  double mean = 0;         ///< of all cells, each as often as any other
};

/// The quality of some cells. The smallest angle of a cell is the least of its 3 angles in 2D, of its 6 dihedral angles in 3D.
struct QualityMeasures {
  double max_radius_edge = 0;                 ///< circumradius over shortest edge
  double min_angle_deg = 180;                 ///< the smallest of the angles of triangles in 2D, dihedral angles in 3D
  double max_angle_deg = 0;                   ///< the largest of these angles
  std::array<std::uint64_t, 18> histogram{};  ///< number of those angles in [10 i, 10 i + 10) degrees
  /// Number of cells whose smallest angle is in [5 i, 5 i + 5) degrees. The sum is the number of cells.
  std::array<std::uint64_t, 15> cells_by_smallest_angle{};
  /// Of the smallest angles of the cells, the 0.1 %, 1 % and 5 % quantile: the least value such that at least this share of the
  /// cells has no more. Good to a hundredth of a degree.
  std::array<double, 3> smallest_angle_quantiles_deg{180, 180, 180};
  /// D times inradius over circumradius ("gamma"): 1 of the regular simplex, 0 of a flat one.
  MeasureSummary radius_ratio;
  /// As the Verdict library defines it (Stimpson et al. 2007, "The Verdict geometric quality library", SAND2007-1751): D! times
  /// the measure over the largest product of the D edges at a corner, times sqrt(2) (2D: 2 / sqrt(3)). 1 of the regular simplex.
  MeasureSummary scaled_jacobian;
};

/// The quality of the cells of one label.
struct RegionQuality : QualityMeasures {
  double label = 0;  ///< as in OutputMesh::regions; 0 where cells have none
};

/// The quality of all cells of a mesh.
struct QualitySummary : QualityMeasures {
  std::vector<RegionQuality> regions;  ///< one entry a label that cells have, ascending
};

/// Angles of one simplex in degrees: 3 corners (2D), 6 dihedral angles (3D, edges 01 02 03 12 13 23).
template <int D>
std::array<double, D == 2 ? 3 : 6> angles_deg(const Simplex<D>& s);

/// Linear time, on the threads of the caller's tbb::task_arena; the same for any number of them. 12 bytes a cell while it runs.
template <int D>
QualitySummary summarize_quality(const OutputMesh<D>& mesh);

}  // namespace pgdr
