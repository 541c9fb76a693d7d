// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Exact sums of products of up to three doubles, for volumes and areas: an integer of as many words as it takes, in steps of the
// product of three least doubles. A product takes some 10 ns, whatever its exponent; nothing under- or overflows, and the
// order of terms does not matter. Private to the layers; a value, one thread at a time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pgdr/types.hpp"

namespace pgdr::detail {

class ExactSum {
 public:
  /// Adds a b c. @pre they are finite
  void add_product(double a, double b, double c = 1);
  /// Adds the determinant of the two points: twice the area of the triangle of the origin, a and b.
  void add_determinant(const Point2& a, const Point2& b);
  /// Adds the determinant of the three points: six times the volume of the tetrahedron of the origin, a, b and c.
  void add_determinant(const Point3& a, const Point3& b, const Point3& c);
  /// Adds another sum.
  void add(const ExactSum& other);
  /// The double nearest to the sum over a small number, ties to even (below 2^-1022, where doubles have fewer digits, rounded
  /// twice).
  double divided_by(unsigned divisor) const;
  /// Was nothing added but zeros?
  bool is_empty() const { return digits_.empty(); }
  // For messages: the sum in numbers, from which it can be made again.
  std::vector<std::int64_t> to_words() const;
  static ExactSum of_words(std::span<const std::int64_t> words);  ///< @pre what to_words() gave

 private:
  void carry();

  // Two's complement in digits of 32 bits, of which adding does not carry: each has room for 2^31 digits.
  std::vector<std::int64_t> digits_;
  int first_ = 0;  // the place of the lowest of them
  std::uint32_t added_ = 0;
};

}  // namespace pgdr::detail
