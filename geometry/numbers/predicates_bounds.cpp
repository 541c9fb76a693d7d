// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The bounds on quality and size that refiner and checker share: doubles with an error bound first, rationals where
// those cannot decide. So the answer depends on the vertex set alone, whatever the order of the corners.
#include <cmath>
#include <limits>

#include "numbers/bounded.hpp"
#include "numbers/circum_terms.hpp"
#include "numbers/predicate_stages.hpp"
#include "pgdr/circumsphere.hpp"

namespace pgdr {
namespace detail {
namespace {

constexpr double u = unit_roundoff;

// r <= limit as |numerator| <= 2 |det| limit. The errors of numerator and determinant come from circum_terms.hpp. What is
// rounded besides has relative errors: |numerator| 3.5u, M^3 and M^4 6u (of bounds only), limit 4.5u at most (a shortest
// edge: squared length 5u, root 3.5u, times the bound 4.5u), the product 2u, comparisons' sums 2u: below 16u.
template <int D>
std::optional<bool> radius_within(const Simplex<D>& s, double limit) {
  const CircumTerms<D> t = circum_terms(edges_from_first<D>(s));
  if (!in_safe_range(t.longest2)) return std::nullopt;
  double norm2 = 0;
  for (const double n : t.numerator) norm2 += n * n;
  const double longest = std::sqrt(t.longest2), norm = std::sqrt(norm2), det = 2 * std::fabs(t.det);
  const double power = D == 3 ? t.longest2 * longest : t.longest2;  // M^D
  const double norm_error = numerator_error<D> * power * longest, det_error_2 = 2 * det_error<D> * power;
  if (norm + norm_error <= (det - det_error_2) * limit * (1 - 16 * u)) return true;
  if (norm - norm_error > (det + det_error_2) * limit * (1 + 16 * u)) return false;
  return std::nullopt;
}

std::optional<bool> counted(std::optional<bool> filtered) {
  if (filtered)
    ++counts.filter;
  else
    ++counts.exact;
  return filtered;
}

}  // namespace

// Where the square of the shortest edge underflows (l < 2^-450, while M >= 2^-100), determinant and numerator are far
// below their error bounds: undecided, whatever the computed length.
template <int D>
std::optional<bool> radius_edge_filter(const Simplex<D>& s, double bound) {
  return radius_within<D>(s, bound * std::sqrt(shortest_edge_squared<D>(s)));
}

template <int D>
std::optional<bool> circumradius_filter(const Simplex<D>& s, double size) {
  return radius_within<D>(s, size);
}

// |det| <= D! bound: the determinant within det_error M^D, the right side rounded once.
template <int D>
std::optional<bool> measure_filter(const Simplex<D>& s, double bound) {
  const CircumTerms<D> t = circum_terms(edges_from_first<D>(s));
  if (!in_safe_range(t.longest2)) return std::nullopt;
  const double power = D == 3 ? t.longest2 * std::sqrt(t.longest2) : t.longest2;
  const double error = det_error<D> * power, det = std::fabs(t.det), limit = bound * (D == 3 ? 6 : 2);
  if (det + error <= limit * (1 - 4 * u)) return true;
  if (det - error > limit * (1 + 4 * u)) return false;
  return std::nullopt;
}

template std::optional<bool> radius_edge_filter<2>(const Simplex<2>&, double);
template std::optional<bool> radius_edge_filter<3>(const Simplex<3>&, double);
template std::optional<bool> circumradius_filter<2>(const Simplex<2>&, double);
template std::optional<bool> circumradius_filter<3>(const Simplex<3>&, double);
template std::optional<bool> measure_filter<2>(const Simplex<2>&, double);
template std::optional<bool> measure_filter<3>(const Simplex<3>&, double);

}  // namespace detail

// A bound that is not positive is met by nothing (a measure of zero apart), an infinite one by everything; NaN by nothing.
template <int D>
bool radius_edge_within(const Simplex<D>& s, double bound) {
  if (!(bound > 0)) return false;
  if (bound == std::numeric_limits<double>::infinity()) return true;
  const std::optional<bool> b = detail::counted(detail::radius_edge_filter<D>(s, bound));
  return b ? *b : detail::radius_edge_exact<D>(s, bound);
}

template <int D>
bool circumradius_within(const Simplex<D>& s, double size) {
  if (!(size > 0)) return false;
  if (size == std::numeric_limits<double>::infinity()) return true;
  const std::optional<bool> b = detail::counted(detail::circumradius_filter<D>(s, size));
  return b ? *b : detail::circumradius_exact<D>(s, size);
}

template <int D>
bool measure_within(const Simplex<D>& s, double bound) {
  if (!(bound >= 0)) return false;
  if (bound == std::numeric_limits<double>::infinity()) return true;
  const std::optional<bool> b = detail::counted(detail::measure_filter<D>(s, bound));
  return b ? *b : detail::measure_exact<D>(s, bound);
}

template PGDR_API bool radius_edge_within<2>(const Simplex<2>&, double);
template PGDR_API bool radius_edge_within<3>(const Simplex<3>&, double);
template PGDR_API bool circumradius_within<2>(const Simplex<2>&, double);
template PGDR_API bool circumradius_within<3>(const Simplex<3>&, double);
template PGDR_API bool measure_within<2>(const Simplex<2>&, double);
template PGDR_API bool measure_within<3>(const Simplex<3>&, double);

}  // namespace pgdr
