// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The summary of a mesh of whose cells each of several processes has some: the same as summarize_quality() makes of all of them.
// Step by step, between which the processes tell each other small arrays. One thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "quality/quality_counts.hpp"

namespace pgdr::detail {

/// The cells of one process. It is made; take() gets what own() gave on all; then of each round, in their order, narrow() gets
/// the sums over all of what counts() gave.
class QualityOfPart {
 public:
  template <int D>
  static QualityOfPart of(const OutputMesh<D>& cells);

  const std::vector<CountsOfRegion>& own() const { return own_; }
  void take(const std::vector<CountsOfRegion>& all);

  /// Each tells eight bits of the quantiles.
  static constexpr int rounds = 4;
  std::vector<std::uint64_t> counts(int round) const;
  void narrow(int round, const std::vector<std::uint64_t>& sums);

  QualitySummary summary() const;

 private:
  /// The value with so many values of a set below it, as far as it is known.
  struct Quantile {
    std::size_t first, last;  ///< of this process's values, those of the set
    std::size_t measure;      ///< in ValuesOfCells
    std::uint64_t rank;       ///< among all values of the set that begin like it
    std::uint32_t known = 0;  ///< its first bits, as bits_of() orders values; the others are 0
  };
  void add_quantiles(std::size_t first, std::size_t last, std::uint64_t cells);
  void set_quantiles(QualityMeasures& q, std::size_t set) const;

  std::vector<CountsOfRegion> own_, all_;
  ValuesOfCells values_;
  std::vector<double> labels_;  ///< of the cells, until they are grouped
  std::vector<Quantile> quantiles_;
};

}  // namespace pgdr::detail
