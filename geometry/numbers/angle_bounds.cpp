// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Angles against bounds by their cosines. With c the inner product of two vectors (of two normals, for dihedral angles) and N the
// product of their squared lengths, an angle is at least that of the cosine k iff c <= k sqrt(N). The sign of k^2 N - c^2, of
// degree 8 for dihedral angles, and that of c decide: in doubles with error bounds, then in rationals.
#include "numbers/angle_bounds.hpp"

#include <mpfr.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

#include "numbers/bounded.hpp"
#include "numbers/corners.hpp"
#include "numbers/predicate_stages.hpp"
#include "numbers/rational.hpp"

namespace pgdr {
namespace detail {
namespace {

template <class T, std::size_t N = 3>
using Vector = std::array<T, N>;

Bounded difference_of(double a, double b, Bounded) { return sub(Bounded(a), Bounded(b)); }
Rational difference_of(double a, double b, Rational) { return rational_difference(a, b); }
Bounded number(double x, Bounded) { return Bounded(x); }
Rational number(double x, Rational) { return {Rational::Number(x)}; }

template <class T, int D>
Vector<T, D> vector_between(const Point<D>& from, const Point<D>& to) {
  Vector<T, D> v;
  for (std::size_t i = 0; i < D; ++i) v[i] = difference_of(to.x[i], from.x[i], T{});
  return v;
}

template <class T>
Vector<T> cross(const Vector<T>& u, const Vector<T>& v) {
  return {sub(mul(u[1], v[2]), mul(u[2], v[1])), sub(mul(u[2], v[0]), mul(u[0], v[2])), sub(mul(u[0], v[1]), mul(u[1], v[0]))};
}

template <class T, std::size_t N>
T dot(const Vector<T, N>& u, const Vector<T, N>& v) {
  T sum = mul(u[0], v[0]);
  for (std::size_t i = 1; i < N; ++i) sum = add(sum, mul(u[i], v[i]));
  return sum;
}

Sign definite(Sign s) { return s; }
Sign definite(std::optional<Sign> s) { return s.value_or(Sign::zero); }
template <class T>
constexpr bool is_exact = std::is_same_v<T, Rational>;

/// c <= k sqrt(N), where N > 0; nothing where doubles do not tell. A vector of no length has N = 0 and meets no bound.
template <class T>
std::optional<bool> is_within(const T& c, const T& squared_lengths, double k) {
  const T cosine = number(k, T{});
  const Sign larger = definite(sign(sub(mul(mul(cosine, cosine), squared_lengths), mul(c, c)))), of_c = definite(sign(c));
  if (larger == Sign::positive) return k >= 0;
  if (larger == Sign::negative && of_c != Sign::zero) return of_c == Sign::negative;
  if (!is_exact<T>) return {};
  if (larger == Sign::negative || definite(sign(squared_lengths)) == Sign::zero) return false;
  return k >= 0 || of_c == Sign::negative;
}

/// Of all six dihedral angles. The normals point inwards, or all outwards: their angle and the dihedral angle add up to 180
/// degrees.
template <class T>
std::optional<bool> all_within(const Simplex<3>& s, double k) {
  const auto a = vector_between<T, 3>(s[0], s[1]), b = vector_between<T, 3>(s[0], s[2]), c = vector_between<T, 3>(s[0], s[3]);
  const std::array<Vector<T>, 4> normal{cross(vector_between<T, 3>(s[1], s[3]), vector_between<T, 3>(s[1], s[2])), cross(b, c),
                                        cross(c, a), cross(a, b)};
  std::array<T, 4> squared;
  for (std::size_t i = 0; i < 4; ++i) squared[i] = dot(normal[i], normal[i]);
  bool sure = true;
  for (const auto& [i, j] : edge_ends) {
    const auto within = is_within(sub(number(0, T{}), dot(normal[i], normal[j])), mul(squared[i], squared[j]), k);
    if (within && !*within) return false;
    sure = sure && within;
  }
  return sure ? std::optional(true) : std::nullopt;
}

template <class T>
std::optional<bool> dihedral_at_least(const std::array<const Point3*, 4>& p, double k) {
  const auto e = vector_between<T, 3>(*p[0], *p[1]);
  const auto m = cross(e, vector_between<T, 3>(*p[0], *p[2])), n = cross(e, vector_between<T, 3>(*p[0], *p[3]));
  return is_within(dot(m, n), mul(dot(m, m), dot(n, n)), k);
}

// sin^2 < 1 / (2 bound)^2 as (|u|^2 |v|^2 - (u.v)^2) (2 bound)^2 < |u|^2 |v|^2, and u.v > 0.
template <class T, int D>
std::optional<bool> is_sharp(const Point<D>& v, const Point<D>& a, const Point<D>& b, double bound) {
  const auto x = vector_between<T, D>(v, a), y = vector_between<T, D>(v, b);
  const T product = dot(x, y), lengths = mul(dot(x, x), dot(y, y)), twice = number(2 * bound, T{});
  const Sign acute = definite(sign(product));
  const Sign below = definite(sign(sub(lengths, mul(mul(twice, twice), sub(lengths, mul(product, product))))));
  if (is_exact<T>) return acute == Sign::positive && below == Sign::positive;
  if (acute == Sign::negative || below == Sign::negative) return false;
  return acute == Sign::zero || below == Sign::zero ? std::nullopt : std::optional(true);
}

// The foot of the direction in the plane is between b and c, and sin^2 = (n.x)^2 / (|n|^2 |x|^2) < 1 / (2 bound)^2, n the normal.
template <class T>
std::optional<bool> is_sharp_above(const Point3& v, const Point3& r, const Point3& b, const Point3& c, double bound) {
  const auto x = vector_between<T, 3>(v, r), y = vector_between<T, 3>(v, b), z = vector_between<T, 3>(v, c);
  const auto n = cross(y, z);
  const T height = mul(number(2 * bound, T{}), dot(n, x));
  const std::array<Sign, 3> signs{definite(sign(dot(cross(n, y), x))), definite(sign(dot(cross(z, n), x))),
                                  definite(sign(sub(mul(dot(n, n), dot(x, x)), mul(height, height))))};
  const auto has = [&signs](Sign s) { return std::find(signs.begin(), signs.end(), s) != signs.end(); };
  if (has(Sign::negative)) return false;
  if (!has(Sign::zero)) return true;
  return is_exact<T> ? std::optional(false) : std::nullopt;
}

}  // namespace

bool dihedral_below(const Point3& a, const Point3& b, const Point3& c, const Point3& d, double cosine) {
  const std::array<const Point3*, 4> p{&a, &b, &c, &d};
  if (const auto at_least = dihedral_at_least<Bounded>(p, cosine)) return !*at_least;
  return !*dihedral_at_least<Rational>(p, cosine) && !collinear<3>(a, b, c) && !collinear<3>(a, b, d);
}

template <int D>
bool is_too_sharp(const Point<D>& v, const Point<D>& a, const Point<D>& b, double bound) {
  if (!(bound > 0) || std::isinf(2 * bound)) return false;
  if (const auto filtered = is_sharp<Bounded, D>(v, a, b, bound)) return *filtered;
  return *is_sharp<Rational, D>(v, a, b, bound);
}

bool is_too_near_corner(const Point3& v, const Point3& r, const Point3& b, const Point3& c, double bound) {
  if (!(bound > 0) || std::isinf(2 * bound)) return false;
  if (is_too_sharp<3>(v, r, b, bound) || is_too_sharp<3>(v, r, c, bound)) return true;
  if (const auto filtered = is_sharp_above<Bounded>(v, r, b, c, bound)) return *filtered;
  return *is_sharp_above<Rational>(v, r, b, c, bound);
}

template bool is_too_sharp<2>(const Point2&, const Point2&, const Point2&, double);
template bool is_too_sharp<3>(const Point3&, const Point3&, const Point3&, double);

}  // namespace detail

bool dihedral_within(const Simplex<3>& s, double largest_cosine) {
  if (largest_cosine >= 1) return true;
  if (!(largest_cosine > -1)) return false;
  if (const auto filtered = detail::all_within<detail::Bounded>(s, largest_cosine)) {
    ++detail::counts.filter;
    return *filtered;
  }
  ++detail::counts.exact;
  return *detail::all_within<detail::Rational>(s, largest_cosine);
}

// The decimal number is taken to ever more binary digits, until it is known to which double the cosine rounds. Where the cosine
// is a double itself (60, 90 degrees) it never is: then the last one is right, too.
double claimed_cosine(double degrees) {
  std::array<char, 32> decimal{};
  std::to_chars(decimal.data(), decimal.data() + decimal.size() - 1, degrees);
  double cosine = std::numeric_limits<double>::quiet_NaN();
  if (!std::isfinite(degrees)) return cosine;
  constexpr mpfr_prec_t first = 128, last = 2048;
  for (mpfr_prec_t digits = first; digits <= last; digits *= 2) {
    mpfr_t x, pi;
    mpfr_inits2(digits, x, pi, static_cast<mpfr_ptr>(nullptr));
    mpfr_set_str(x, decimal.data(), 10, MPFR_RNDN);
    mpfr_const_pi(pi, MPFR_RNDN);
    mpfr_mul(x, x, pi, MPFR_RNDN);
    mpfr_div_ui(x, x, 180, MPFR_RNDN);
    const mpfr_exp_t magnitude = mpfr_zero_p(x) ? 0 : std::max<mpfr_exp_t>(mpfr_get_exp(x), 0);
    mpfr_cos(x, x, MPFR_RNDN);
    cosine = mpfr_get_d(x, MPFR_RNDN);
    // The argument is off by three roundings and that of pi, the cosine by no more and one of its own: less than 2^(8 +
    // magnitude) times 2^-digits, absolutely; mpfr_can_round asks for the digits that are right, from the first of the cosine on.
    const mpfr_exp_t own = mpfr_zero_p(x) ? 0 : mpfr_get_exp(x);
    const bool known = mpfr_can_round(x, digits - 8 - magnitude + own, MPFR_RNDN, MPFR_RNDZ, 54) != 0;
    mpfr_clears(x, pi, static_cast<mpfr_ptr>(nullptr));
    if (known) break;
  }
  mpfr_free_cache();
  return cosine;
}

}  // namespace pgdr
