// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The middle stage of the predicates: determinants that are exact without allocation. First in integers, where all
// coordinates lie on one lattice (grids, and most other cells), of few digits or of many; then in expansions: of doubles where
// all differences of coordinates are doubles, else of differences of two terms. Nothing is decided where under- or overflow could
// spoil it.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "numbers/determinants.hpp"
#include "numbers/expansion.hpp"
#include "numbers/fixed_point.hpp"
#include "numbers/predicate_stages.hpp"

namespace pgdr::detail {
namespace {

template <std::size_t D, std::size_t Rows>
using TwiceMatrix = std::array<std::array<Twice, D>, Rows>;

// The sign of a polynomial of sums and differences of coordinates, by the arithmetic asked for. `entries` holds their
// exact values, `coordinates` what they were made from; `polynomial` takes the matrix in any of the four types.
template <class Int, std::size_t D, std::size_t Rows, class Polynomial>
MaybeSign on_lattice(const TwiceMatrix<D, Rows>& entries, Lattice lattice, Polynomial polynomial) {
  double largest = 0;
  for (const auto& row : entries)
    for (const Twice& d : row) largest = std::max(largest, std::fabs(d.hi));
  if (largest == 0) return Sign::zero;
  if (!lattice.fit(largest)) return std::nullopt;
  std::array<std::array<Int, D>, Rows> m;
  bool exact = true;
  for (std::size_t i = 0; i < Rows; ++i)
    for (std::size_t k = 0; k < D; ++k)
      m[i][k] = Int{lattice.steps(entries[i][k].hi, exact) + lattice.steps(entries[i][k].lo, exact)};
  if (!exact) return std::nullopt;
  return sign(polynomial(m));
}

template <int N, std::size_t D, std::size_t Rows>
auto expansions(const TwiceMatrix<D, Rows>& m) {
  std::array<std::array<Expansion<N>, D>, Rows> e;
  for (std::size_t i = 0; i < Rows; ++i)
    for (std::size_t k = 0; k < D; ++k) {
      if constexpr (N == 2) e[i][k].push(m[i][k].lo);
      e[i][k].push(m[i][k].hi);
    }
  return e;
}

template <std::size_t D, std::size_t Rows, class Polynomial>
MaybeSign by_expansion(const TwiceMatrix<D, Rows>& entries, std::span<const double> coordinates, Polynomial polynomial) {
  for (const double x : coordinates)
    if (!in_expansion_range(x)) return std::nullopt;
  bool doubles = true;
  for (const auto& row : entries)
    for (const Twice& d : row) doubles &= d.lo == 0;
  return doubles ? sign(polynomial(expansions<1>(entries))) : sign(polynomial(expansions<2>(entries)));
}

template <std::size_t D, std::size_t Rows, class Polynomial>
MaybeSign by(Middle stage, const TwiceMatrix<D, Rows>& entries, std::span<const double> coordinates, Polynomial polynomial) {
  const auto is_asked_for = [stage](Middle m) { return stage == m || stage == Middle::all; };
  if (is_asked_for(Middle::short_int))
    if (const MaybeSign s = on_lattice<ShortInt>(entries, Lattice(ShortInt::bits), polynomial)) return s;
  if (is_asked_for(Middle::fixed_point))
    if (const MaybeSign s = on_lattice<FixedInt<1>>(entries, Lattice(), polynomial)) return s;
  return is_asked_for(Middle::expansion) ? by_expansion(entries, coordinates, polynomial) : std::nullopt;
}

template <int D>
std::array<Twice, D> difference(const Point<D>& a, const Point<D>& b) {
  std::array<Twice, D> d;
  for (std::size_t i = 0; i < D; ++i) d[i] = two_diff(a.x[i], b.x[i]);
  return d;
}

// All coordinates in one array.
template <int D, std::size_t N>
std::array<double, D * N> flat(const std::array<Point<D>, N>& points) {
  std::array<double, D * N> x;
  auto out = x.begin();
  for (const Point<D>& p : points) out = std::copy_n(p.x.begin(), D, out);
  return x;
}

}  // namespace

// Planes x, y or z = const are what most models are made of.
template <int D>
MaybeSign orient_middle(const Simplex<D>& s, Middle stage) {
  for (int k = 0; k < D; ++k)
    if (std::all_of(s.begin() + 1, s.end(), [&](const Point<D>& p) { return p[k] == s[0][k]; })) return Sign::zero;
  TwiceMatrix<D, D> m;
  for (std::size_t i = 0; i < D; ++i) m[i] = difference<D>(s[i + 1], s[0]);
  return by(stage, m, flat<D>(s), [](const auto& e) { return orient_det(e); });
}

template <int D>
MaybeSign in_sphere_middle(const Simplex<D>& s, const Point<D>& p, Middle stage) {
  TwiceMatrix<D, D + 1> m;
  std::array<Point<D>, D + 2> points;
  for (std::size_t i = 0; i <= D; ++i) {
    m[i] = difference<D>(s[i], p);
    points[i] = s[i];
  }
  points[D + 1] = p;
  return by(stage, m, flat<D>(points), [](const auto& e) { return in_sphere_det(e); });
}

MaybeSign in_circle_middle(const Triangle3& t, const Point3& p, int axis, Middle stage) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  TwiceMatrix<4, 3> m;
  for (std::size_t k = 0; k < 3; ++k)
    m[k] = {two_diff(t[k][i], p[i]), two_diff(t[k][j], p[j]), two_diff(t[k][axis], p[axis]), two_sum(t[k][axis], p[axis])};
  return by(stage, m, flat<3, 4>({t[0], t[1], t[2], p}), []<class T>(const std::array<std::array<T, 4>, 3>& e) {
    Matrix<T, 2, 3> d;
    std::array<T, 3> drop, drop_sum;
    for (std::size_t k = 0; k < 3; ++k) {
      d[k] = {e[k][0], e[k][1]};
      drop[k] = e[k][2];
      drop_sum[k] = e[k][3];
    }
    return in_circle_det(d, drop, drop_sum);
  });
}

template <int D>
MaybeSign dot_middle(const Point<D>& v, const Point<D>& a, const Point<D>& b, Middle stage) {
  return by(stage, TwiceMatrix<D, 2>{difference<D>(a, v), difference<D>(b, v)}, flat<D, 3>({v, a, b}),
            [](const auto& e) { return dot(e[0], e[1]); });
}

template <int D>
MaybeSign angle_60_middle(const Point<D>& v, const Point<D>& a, const Point<D>& b, Middle stage) {
  return by(stage, TwiceMatrix<D, 2>{difference<D>(a, v), difference<D>(b, v)}, flat<D, 3>({v, a, b}),
            [](const auto& e) { return angle_60_det(e[0], e[1]); });
}

template MaybeSign orient_middle<2>(const Simplex<2>&, Middle);
template MaybeSign orient_middle<3>(const Simplex<3>&, Middle);
template MaybeSign in_sphere_middle<2>(const Simplex<2>&, const Point2&, Middle);
template MaybeSign in_sphere_middle<3>(const Simplex<3>&, const Point3&, Middle);
template MaybeSign dot_middle<2>(const Point2&, const Point2&, const Point2&, Middle);
template MaybeSign dot_middle<3>(const Point3&, const Point3&, const Point3&, Middle);
template MaybeSign angle_60_middle<2>(const Point2&, const Point2&, const Point2&, Middle);
template MaybeSign angle_60_middle<3>(const Point3&, const Point3&, const Point3&, Middle);

}  // namespace pgdr::detail
