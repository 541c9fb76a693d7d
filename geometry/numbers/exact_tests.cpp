// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Exact decisions on CGAL's rationals (LGPL). The filters run in long double, with error bounds in terms of its own
// epsilon: where it is no wider than double they decide less, never wrongly.
#include "numbers/exact_tests.hpp"

#include <CGAL/Exact_rational.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "numbers/rounding.hpp"
#include "pgdr/circumsphere.hpp"

namespace pgdr::checking {
namespace {

using Rational = CGAL::Exact_rational;
template <class Number, std::size_t N>
using Vector = std::array<Number, N>;

template <class Number, int D>
Vector<Number, D> difference(const Point<D>& a, const Point<D>& b) {
  Vector<Number, D> v;
  for (int i = 0; i < D; ++i) v[i] = Number(a[i]) - Number(b[i]);
  return v;
}

template <class Number, std::size_t N>
Number dot(const Vector<Number, N>& u, const Vector<Number, N>& v) {
  Number s = u[0] * v[0];
  for (std::size_t i = 1; i < N; ++i) s += u[i] * v[i];
  return s;
}

enum class Filtered { no, yes, unsure };

constexpr long double epsilon = std::numeric_limits<long double>::epsilon();
// Below this, products of two may have lost digits to underflow; the rationals decide.
constexpr long double smallest_trusted = std::numeric_limits<double>::min() * 0x1p100L;

template <class Number, std::size_t N>
using Matrix = std::array<std::array<Number, N>, N>;

template <class Number, std::size_t N>
Matrix<Number, N - 1> without(const Matrix<Number, N>& m, std::size_t row, std::size_t column) {
  Matrix<Number, N - 1> r;
  for (std::size_t i = 0; i + 1 < N; ++i)
    for (std::size_t j = 0; j + 1 < N; ++j) r[i][j] = m[i + (i >= row)][j + (j >= column)];
  return r;
}

template <class Number, std::size_t N>
Number determinant(const Matrix<Number, N>& m) {
  if constexpr (N == 1) {
    return m[0][0];
  } else {
    Number sum = 0;
    for (std::size_t column = 0; column < N; ++column) {
      const Number term = m[0][column] * determinant(without(m, 0, column));
      sum += column % 2 ? Number(-term) : term;
    }
    return sum;
  }
}

/// Of a determinant whose points may move.
template <class Number>
struct Movable {
  Number value, change;  ///< itself, and by how much at most it changes
  Number largest, move;  ///< of the differences it is made of: the largest, and by how much at most one changes
};

// The determinant is W = det(a_i, |a_i|^2), i = 0..D, with a_i = corner i - p. Let C be its cofactors. Then
//   dW/d corner_ij = C_ij + 2 a_ij C_iL,   dW/d p_j = - sum over i of the same (W depends on differences alone),
// and to first order the largest change is sum over points of delta * |gradient|_1, which is attained. The rest: W is a
// sum of 72 monomials of degree 5 in 3D (24 products with 3 squares in each height), 12 of degree 4 in 2D, in the a_ij,
// which are at most m and change by at most h = max(delta_i) + delta_p. A monomial changes beyond first order by at
// most (m + h)^n - m^n - n m^(n-1) h <= n (n - 1) / 2 * (m + h)^(n-2) h^2: hence 720 and 72.
template <class Number, int D>
Movable<Number> moved_determinant(const Simplex<D>& s, const Point<D>& p, const std::array<double, D + 2>& delta) {
  using std::abs;
  Matrix<Number, D + 1> rows;
  Number m = 0, h = 0;
  for (int i = 0; i <= D; ++i) {
    const auto a = difference<Number, D>(s[i], p);
    std::copy(a.begin(), a.end(), rows[i].begin());
    rows[i][D] = dot(a, a);
    for (const Number& x : a) m = std::max(m, Number(abs(x)));
    h = std::max(h, Number(delta[i]));
  }
  h += Number(delta[D + 1]);

  Number value = 0, change = 0;
  Vector<Number, D> of_p;
  of_p.fill(0);
  for (int i = 0; i <= D; ++i) {
    Vector<Number, D + 1> cofactor;
    for (int j = 0; j <= D; ++j) {
      cofactor[j] = determinant(without(rows, i, j));
      if ((i + j) % 2) cofactor[j] = -cofactor[j];
    }
    if (i == 0) value = dot(rows[0], cofactor);
    for (int j = 0; j < D; ++j) {
      const Number gradient = cofactor[j] + 2 * rows[i][j] * cofactor[D];
      of_p[j] += gradient;
      change += Number(delta[i]) * abs(gradient);
    }
  }
  for (const Number& g : of_p) change += Number(delta[D + 1]) * abs(g);
  const Number reach = m + h;
  change += D == 3 ? Number(720 * h * h * reach * reach * reach) : Number(72 * h * h * reach * reach);
  return {abs(value), change, m, h};
}

// With u = epsilon / 2: no monomial takes more than 20 roundings, so that W, 72 of at most m^5, is off by 1440 u m^5; a component
// of the gradient, 30 of at most m^4, by 600 u m^4, and that of p by 2400 u m^4, so that their sums are off by less than 4 * 3 *
// 600 + 3 * 2400 < 18000 times u h m^4, and by 20 u of themselves. In 2D all of these are less. The bounds are about twice as
// much.
template <int D>
Filtered cancels_by_filter(const Simplex<D>& s, const Point<D>& p, const std::array<double, D + 2>& delta) {
  const auto w = moved_determinant<long double, D>(s, p, delta);
  long double power = w.largest;  // m^(D + 1)
  for (int i = 0; i < D; ++i) power *= w.largest;
  if (!(power * w.largest > smallest_trusted)) return Filtered::unsure;
  const long double error = epsilon * (1500 * power * w.largest + 18000 * power * w.move + 20 * w.change);
  if (w.value + error <= w.change) return Filtered::yes;
  if (w.value > w.change + error) return Filtered::no;
  return Filtered::unsure;
}

}  // namespace

template <int D>
bool rounding_cancels(const Simplex<D>& s, const Point<D>& p, const std::array<double, D + 2>& delta) {
  if (std::all_of(delta.begin(), delta.end(), [](double d) { return d == 0; })) return false;
  const Filtered answer = cancels_by_filter<D>(s, p, delta);
  if (answer != Filtered::unsure) return answer == Filtered::yes;
  const auto w = moved_determinant<Rational, D>(s, p, delta);
  return w.value <= w.change;
}

template <int D>
bool is_as_short_as_rounding(const Simplex<D>& s, double largest) {
  const double width = 8 * rounding::ulp * largest;
  if (std::sqrt(shortest_edge_squared<D>(s)) <= width) return true;
  if constexpr (D == 2) {
    double longest = 0;
    for (int i = 0; i < 3; ++i) longest = std::max(longest, squared_distance(s[i], s[(i + 1) % 3]));
    const Matrix<long double, 2> edges{difference<long double, 2>(s[1], s[0]), difference<long double, 2>(s[2], s[0])};
    return std::abs(determinant(edges)) <= width * std::sqrt(longest);
  }
  return false;
}

// A simplex is crossed at q + t (p - q), t = o(q) / (o(q) - o(p)), where o(x) = det(simplex, x).
template <int D>
std::vector<std::uint32_t> order_along(const Point<D>& q, const Point<D>& p,
                                       const std::vector<std::array<Point<D>, D>>& simplices) {
  std::vector<Rational> t;
  for (const auto& s : simplices) {
    const auto height = [&](const Point<D>& x) {
      Matrix<Rational, D> rows;
      for (int i = 0; i < D; ++i) rows[i] = difference<Rational, D>(s[i], x);
      return determinant(rows);
    };
    const Rational from = height(q);
    t.push_back(from / (from - height(p)));
  }
  std::vector<std::uint32_t> order(simplices.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return t[a] < t[b]; });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (t[order[i - 1]] == t[order[i]]) return {};
  return order;
}

#define PGDR_INSTANTIATE(D)                                                                                \
  template bool rounding_cancels<D>(const Simplex<D>&, const Point<D>&, const std::array<double, D + 2>&); \
  template bool is_as_short_as_rounding<D>(const Simplex<D>&, double);                                     \
  template std::vector<std::uint32_t> order_along<D>(const Point<D>&, const Point<D>&,                     \
                                                     const std::vector<std::array<Point<D>, D>>&);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr::checking
