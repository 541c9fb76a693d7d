// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// With e = b - a, u = c - a, w = d - a, the parts of u and w normal to e have the inner product
// (u.w) - (e.u)(e.w)/(e.e): its sign, in three arithmetics.
#include "numbers/dihedral_sign.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "numbers/bounded.hpp"
#include "numbers/expansion.hpp"
#include "numbers/fixed_point.hpp"
#include "numbers/rational.hpp"

namespace pgdr::detail {
namespace {

template <class T>
using Vector = std::array<T, 3>;

template <class T>
auto dot(const Vector<T>& a, const Vector<T>& b) {
  return add(add(mul(a[0], b[0]), mul(a[1], b[1])), mul(a[2], b[2]));
}

template <class T>
auto polynomial(const Vector<T>& e, const Vector<T>& u, const Vector<T>& w) {
  return sub(mul(dot(e, e), dot(u, w)), mul(dot(e, u), dot(e, w)));
}

template <class T, class Difference>
std::array<Vector<T>, 3> vectors(const std::array<const Point3*, 4>& p, Difference difference) {
  std::array<Vector<T>, 3> v;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 3; ++i) v[k][i] = difference(p[k + 1]->x[i], p[0]->x[i]);
  return v;
}

// Where the differences are doubles, and integers of 62 bits up to a power of two: dots have 124, the sum 250.
std::optional<Sign> by_integers(const std::array<const Point3*, 4>& p) {
  bool exact = true;
  double largest = 0;
  const auto d = vectors<double>(p, [&](double x, double y) {
    const Twice t = two_diff(x, y);
    exact = exact && t.lo == 0;
    largest = std::max(largest, std::fabs(t.hi));
    return t.hi;
  });
  Lattice lattice;
  if (!exact || !lattice.fit(largest)) return {};
  std::array<Vector<FixedInt<1>>, 3> v;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 3; ++i) v[k][i] = FixedInt<1>(lattice.steps(d[k][i], exact));
  if (!exact) return {};
  return sign(polynomial(v[0], v[1], v[2]));
}

}  // namespace

Sign dihedral_sign(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  const std::array<const Point3*, 4> p{&a, &b, &c, &d};
  const auto v = vectors<Bounded>(p, [](double x, double y) { return sub(Bounded(x), Bounded(y)); });
  if (const auto s = sign(polynomial(v[0], v[1], v[2]))) return *s;
  if (const auto s = by_integers(p)) return *s;
  const auto q = vectors<Rational>(p, rational_difference);
  return sign(polynomial(q[0], q[1], q[2]));
}

}  // namespace pgdr::detail
