// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What cells are counted into, for the summary of a mesh: it can be joined with what others were counted into, and does not
// depend on which were together.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "numbers/fixed_point.hpp"
#include "pgdr/quality.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {

/// One measure, from -1 to 1, of some cells.
class MeasureCounts {
 public:
  /// @returns what was counted: 0 for what is no number, as of a flat cell
  float add(double value);
  void add(const MeasureCounts& other);
  /// But for the quantile. @pre cells > 0
  MeasureSummary summary(std::uint64_t cells) const;

 private:
  double least_ = 1;
  SignedWord2 sum_ = 0;  ///< in units of 2^-53: sums of doubles would depend on their order
};

/// Some cells. Without the quantiles, which need the values of all.
struct QualityCounts {
  QualityMeasures q;  ///< those that are extremes and numbers of cells
  std::uint64_t cells = 0;
  double most_ratio2 = 0;  ///< squared circumradius over squared shortest edge
  MeasureCounts radius_ratio, scaled_jacobian;

  void add(const QualityCounts& other);
  QualityMeasures measures() const;
};

/// The cells of one label.
struct CountsOfRegion {
  double label = 0;
  QualityCounts counts;
};

/// For the quantiles, one value a cell: 1 - cosine of its smallest angle, which tells small angles apart; radius ratio; scaled
/// Jacobian.
using ValuesOfCells = std::array<std::vector<float>, 3>;

/// What was found of the cells of a mesh.
struct MeasuredCells {
  std::vector<CountsOfRegion> regions;  ///< one entry a label that cells have, ascending
  ValuesOfCells values;                 ///< in the order of the cells
};

/// The label of a cell; 0 where cells have none.
template <int D>
double label_of(const OutputMesh<D>& mesh, std::size_t cell) {
  return mesh.regions.empty() ? 0.0 : mesh.regions[cell];
}

template <int D>
MeasuredCells measure_cells(const OutputMesh<D>& mesh, const Bulk& bulk);

/// With one entry a label, ascending.
std::vector<CountsOfRegion> joined(const std::vector<CountsOfRegion>& parts);

}  // namespace pgdr::detail
