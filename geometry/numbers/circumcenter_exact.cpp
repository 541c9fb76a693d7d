// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Circumcentres of flat simplices, each coordinate the double nearest to the exact one. The centre is p0 + n / (2 d) with
// polynomials n and d of the edges: these are evaluated in integers where the edges are multiples of one 2^g and below
// 2^(g+123), the quotient and the sum in 106 bits, and that is the result unless the next double is as near within the
// error. Beside small angles of the input most cells are flat, and rationals would take nearly all of the time.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "numbers/determinants.hpp"
#include "numbers/double_double.hpp"
#include "numbers/fixed_point.hpp"
#include "numbers/predicate_stages.hpp"
#include "numbers/rational.hpp"

namespace pgdr::detail {
namespace {

using Number = Rational::Number;
template <int D, int Rows>
using Edges = std::array<std::array<Twice, D>, Rows>;  // from the first corner, exactly

/// The integers of edges, and g.
template <int D, int Rows>
struct LatticeEdges {
  Matrix<FixedInt<2>, D, Rows> steps;
  int order;
};

// With |edge| < 2^123: |det| < 2^372, numerators below 2^497, of a triangle 2^619 over 2^497, all within their words.
template <int D, int Rows>
std::optional<LatticeEdges<D, Rows>> on_lattice(const Edges<D, Rows>& edges) {
  double largest = 0;
  for (const auto& edge : edges)
    for (const Twice& x : edge) largest = std::max(largest, std::fabs(x.hi));
  if (!(largest > 0x1p-300 && largest < 0x1p300)) return std::nullopt;
  LatticeEdges<D, Rows> result{{}, std::ilogb(largest) - 122};
  const double inverse = std::ldexp(1, -result.order);
  bool exact = true;
  const auto steps = [&](double x) {
    const double scaled = x * inverse;
    exact &= scaled == std::trunc(scaled);
    return static_cast<SignedWord2>(scaled);
  };
  for (std::size_t i = 0; i < Rows; ++i)
    for (std::size_t k = 0; k < D; ++k) {
      const SignedWord2 n = steps(edges[i][k].hi) + steps(edges[i][k].lo);
      result.steps[i][k].word = {static_cast<std::uint64_t>(n), static_cast<std::uint64_t>(n >> 64)};
    }
  return exact ? std::optional(result) : std::nullopt;
}

/// leading * 2^exponent, with `leading` in [1, 2] or 0; relative error below 2^-105.
struct Scaled {
  DoubleDouble leading;
  int exponent = 0;
};

template <std::size_t W>
Scaled scaled(const FixedInt<W>& v) {
  const FixedInt<W> a = v.negative() ? sub(FixedInt<W>(0), v) : v;
  int top = static_cast<int>(W) - 1;
  while (top >= 0 && a.word[static_cast<std::size_t>(top)] == 0) --top;
  if (top < 0) return {};
  const auto word = [&a](int i) { return i < 0 ? std::uint64_t{0} : a.word[static_cast<std::size_t>(i)]; };
  const int zeros = std::countl_zero(word(top));
  Word2 bits = (static_cast<Word2>(word(top)) << 64 | word(top - 1)) << zeros;  // the upper 128: 53, 53, and 22 left out
  if (zeros > 0) bits |= word(top - 2) >> (64 - zeros);
  const double hi = static_cast<double>(static_cast<std::uint64_t>(bits >> 75)) * 0x1p-52;
  const double lo = static_cast<double>(static_cast<std::uint64_t>(bits >> 22) & ((std::uint64_t{1} << 53) - 1)) * 0x1p-105;
  const DoubleDouble leading = fast_two_sum(hi, lo);
  return {v.negative() ? -leading : leading, 64 * (top + 1) - 1 - zeros};
}

/// The double nearest to p + 2^order n / d; nothing if the error leaves two.
std::optional<double> nearest(double p, const Scaled& n, const Scaled& d, int order) {
  if (n.leading.hi == 0) return p;
  const int exponent = n.exponent - d.exponent + order;
  if (exponent < -500 || exponent > 500) return std::nullopt;
  const DoubleDouble quotient = n.leading / d.leading;
  const double hi = std::ldexp(quotient.hi, exponent), lo = std::ldexp(quotient.lo, exponent);
  const Twice sum = two_sum(p, hi);
  const Twice result = two_sum(sum.hi, sum.lo + lo);
  const double error = 0x1p-98 * std::fabs(hi) + 0x1p-52 * (std::fabs(sum.lo) + std::fabs(lo));
  const bool sure = result.hi + (result.lo + error) == result.hi && result.hi + (result.lo - error) == result.hi;
  return sure ? std::optional(result.hi) : std::nullopt;
}

/// numerator(edges) / denominator(edges) + p, if it can be had so.
template <int D, int Rows, class Numerator, class Denominator>
std::optional<Point<D>> by_fixed_point(const Point<D>& p, const Edges<D, Rows>& edges, Numerator numerator,
                                       Denominator denominator) {
  const auto lattice = on_lattice<D, Rows>(edges);
  if (!lattice) return std::nullopt;
  const auto n = numerator(lattice->steps);
  const Scaled d = scaled(denominator(lattice->steps));
  if (d.leading.hi == 0) return std::nullopt;
  Point<D> c;
  for (int i = 0; i < D; ++i) {
    const std::optional<double> x = nearest(p[i], scaled(n[static_cast<std::size_t>(i)]), d, lattice->order);
    if (!x) return std::nullopt;
    c[i] = *x;
  }
  return c;
}

// The double nearest to q: one conversion is within an ulp or so, exact comparisons settle the rest.
double round_to_nearest(const Number& q) {
  constexpr double inf = std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::max();
  const Number limit = Number(max) + Number(0x1p970) / 2;  // from here on, nearest is infinity
  if (q >= limit) return inf;
  if (q <= -limit) return -inf;
  double d = CGAL::to_double(q);
  if (!std::isfinite(d)) d = std::copysign(max, d);
  const auto distance = [&](double x) { return Number(abs(Number(Number(x) - q))); };
  for (bool moved = true; moved;) {
    moved = false;
    for (const double target : {-inf, inf}) {
      const double next = std::nextafter(d, target);
      if (std::isfinite(next) && distance(next) < distance(d)) {
        d = next;
        moved = true;
      }
    }
  }
  return d;
}

template <int D, int Rows, std::size_t Corners, class Numerator, class Denominator>
Point<D> by_rationals(const std::array<Point<D>, Corners>& corners, Numerator numerator, Denominator denominator) {
  Matrix<Rational, D, Rows> m;
  for (std::size_t i = 0; i < Rows; ++i)
    for (std::size_t k = 0; k < D; ++k) m[i][k] = rational_difference(corners[i + 1].x[k], corners[0].x[k]);
  const auto n = numerator(m);
  const Number d = denominator(m).q;
  Point<D> c;
  for (int i = 0; i < D; ++i)
    c[i] = d.sign() == 0 ? std::numeric_limits<double>::quiet_NaN()
                         : round_to_nearest(Number(Number(corners[0][i]) + n[static_cast<std::size_t>(i)].q / d));
  return c;
}

/// From corners[0].
template <int D, int Rows, std::size_t Corners, class Numerator, class Denominator>
Point<D> rounded_center(const std::array<Point<D>, Corners>& corners, Numerator numerator, Denominator denominator) {
  Edges<D, Rows> edges;
  for (std::size_t i = 0; i < Rows; ++i)
    for (std::size_t k = 0; k < D; ++k) edges[i][k] = two_diff(corners[i + 1].x[k], corners[0].x[k]);
  if (const auto c = by_fixed_point<D, Rows>(corners[0], edges, numerator, denominator)) return *c;
  return by_rationals<D, Rows>(corners, numerator, denominator);
}

template <int D>
Point<D> of_simplex(const Simplex<D>& s) {
  return rounded_center<D, D>(
      s, [](const auto& m) { return circum_numerator(m); },
      [](const auto& m) {
        const auto det = orient_det(m);
        return add(det, det);
      });
}

}  // namespace

Point2 circumcenter_exact(const Simplex<2>& s) { return of_simplex<2>(s); }
Point3 circumcenter_exact(const Simplex<3>& s) { return of_simplex<3>(s); }

// With B = b-a, C = c-a, N = B x C: centre - a = (|C|^2 N x B + |B|^2 C x N) / (2 |N|^2).
Point3 circumcenter_exact(const Triangle3& t) {
  return rounded_center<3, 2>(
      t,
      [](const auto& m) {
        const auto normal = cross(m[0], m[1]);
        const auto nb = cross(normal, m[0]), cn = cross(m[1], normal);
        const auto b2 = squared_norm(m[0]), c2 = squared_norm(m[1]);
        const auto of = [&](std::size_t i) { return add(mul(c2, nb[i]), mul(b2, cn[i])); };
        return std::array{of(0), of(1), of(2)};
      },
      [](const auto& m) {
        const auto n2 = squared_norm(cross(m[0], m[1]));
        return add(n2, n2);
      });
}

}  // namespace pgdr::detail
