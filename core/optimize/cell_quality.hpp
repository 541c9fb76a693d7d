// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The measure of the optimiser: one number a tetrahedron, for its dihedral angles, its ratio of circumradius over shortest edge,
// and its size, each relative to what is asked. Of operations that IEEE 754 defines alone, since meshes rest on it.
//
// With c the cosine of each of the six dihedral angles, and d = 1 - c where c > 0, else 0.7 (1 + c): let m be the least d. For a
// target angle A, a bound B of the ratio b, a bound S of the circumradius R, and a bound V of the volume v
//
//   q = min(m / (1 - cos A), sqrt(B / b), S / R, V / v), at most 1; 0 for a cell that is flat or turned over.
//
// A cell with q = 1 meets all bounds, by a margin that covers the rounding of q. What is below is poor. Large angles are measured
// by 0.7 of the rise, so that a target of 15 degrees bounds them by 162 degrees, 20 by 156, 25 by 150, and 30 by 144. The square
// root lets a cell pass through ratios above the bound on the way to better angles; without it optimising gets stuck.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "optimize/local_sizes.hpp"
#include "optimize/numbers.hpp"
#include "pgdr/types.hpp"
#include "rule/cell_bounds.hpp"

namespace pgdr {

/// 1 - cos of so many degrees, for meshes to rest on: of operations that IEEE 754 defines alone, by the series of the sine of
/// half the angle. @pre 0 <= degrees <= 60
double cosine_complement(double degrees);

/// The measure for given bounds. Each thread has its own, as it counts.
class CellQuality {
 public:
  static constexpr int lowest_level = -10000;  ///< of cells that are flat or turned over

  /// `bounds` must outlive it. `min_dihedral`: the target in degrees, in [0, 60); 0: dihedral angles do not count.
  CellQuality(const CellBounds<3>& bounds, double min_dihedral);

  /// q of a cell of these corners in the region; 0 if it is not positively oriented, as far as doubles tell. Once it is known to
  /// be at most `enough`, some number that is at most `enough`. @throws UsageError bad_size as CellBounds::test
  double of(const Simplex<3>& s, int region, double enough = 0) const;
  /// q where the bound of size at the cell is this. It does not count as an evaluation.
  double of_sized(const Simplex<3>& s, int region, double size) const;

  /// In regions where it knows any, the sizes at cells are taken from these, if sizes vary; elsewhere each is asked for.
  LocalSizes sizes_near;
  /// Is the cell within the bounds of size and volume of its region?
  bool is_within_size(const Simplex<3>& s, int region) const { return is_within_size(s, region, size_for(s, region)); }
  /// The same where the bound of size at the cell is this.
  bool is_within_size(const Simplex<3>& s, int region, double size) const;

  /// One of the numbers whose least is q, for each dihedral angle, the ratio, the radius, and the volume; not cut off at 1.
  struct Term {
    double value;                    ///< of it
    std::array<double, 3> gradient;  ///< of it, with respect to where corner 3 is
  };
  /// Appends the terms that are at most `share` times the least of the cell. The bound of size counts as constant about the cell.
  /// None of a cell whose q is 0. It counts as an evaluation.
  void append_terms(const Simplex<3>& s, int region, double share, std::vector<Term>& terms) const;

  /// floor(log q / log 1.01): 0 of cells within all bounds, negative of poor ones, in steps of a hundredth. Monotone.
  static int level(double q);
  /// What a poor cell of the level counts: one, and one more for each factor of five that its quality is below the bounds.
  static constexpr int weight(int level) { return 1 - level / numbers::levels_a_weight; }
  /// The least q of the level.
  static double least_of_level(int level);

  std::uint64_t evaluated() const { return evaluated_; }  ///< how often `of` was called

 private:
  template <class SizeOf>
  double of_with(const Simplex<3>& s, int region, double enough, SizeOf size_of) const;

  double size_for(const Simplex<3>& s, int region) const;

  const CellBounds<3>* bounds_;
  double one_minus_cos_;  ///< of the target; 0: none
  mutable std::uint64_t evaluated_ = 0;
};

}  // namespace pgdr
