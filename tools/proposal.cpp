// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "proposal.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <exception>
#include <string_view>
#include <vector>

#include "pgdr/estimate.hpp"

namespace pgdr::tool {
namespace {

/// A double that was no short decimal number has 16 or 17 digits; one in a hundred has as few as that, and all of a file have to.
/// (Two units of a fifteenth digit are no more than what meets by default.)
constexpr int most_digits = 14;
constexpr double units = 2;           // a rounded point misses its facet by up to 1.3 of them, and others are as far off again
constexpr double least_of_next = 10;  // times the tolerance: what is left is clearly no rounding

/// The shortest decimal number that reads back to a double.
struct Decimal {
  int digits;     ///< significant ones
  int last;       ///< the power of ten of the last of them
  int magnitude;  ///< and of the first
};

Decimal decimal_of(double value) {
  char buffer[40];
  const char* const end = std::to_chars(buffer, buffer + sizeof buffer, std::fabs(value), std::chars_format::scientific).ptr;
  const std::string_view text(buffer, end);  // d.ddde+xx
  const std::size_t e = text.find('e');
  int exponent = 0;
  std::from_chars(text.data() + e + (text[e + 1] == '+' ? 2 : 1), end, exponent);
  const auto digits = static_cast<int>(std::ranges::count_if(text.substr(0, e), [](char c) { return c != '.'; }));
  return {digits, exponent - digits + 1, exponent};
}

template <int D>
std::vector<double> coordinates(const Plc<D>& plc) {
  std::vector<double> numbers;
  for (const Point<D>& p : plc.points) numbers.insert(numbers.end(), p.x.begin(), p.x.end());
  return numbers;
}

/// The tolerance to try; none where one was asked for already.
template <int D>
std::optional<Plc<D>> with_tolerance_of_digits(const Plc<D>& plc) {
  if (plc.tolerance) return std::nullopt;
  const auto unit = unit_of_last_digit(coordinates(plc));
  if (!unit || units * *unit <= tolerance_of(plc)) return std::nullopt;
  Plc<D> other = plc;
  other.tolerance = units * *unit;
  return other;
}

/// Points that were joined to points, segments and facets.
template <int D>
std::size_t joined_points(const Domain<D>& domain) {
  std::size_t joined = domain.point_of_input().size() - domain.points().size();
  for (const Diagnostic& repair : domain.repairs()) {
    if (repair.code == Errc::point_on_segment) joined += repair.ids.size() / 3;
    if (repair.code == Errc::point_on_facet) joined += repair.ids.size() / 2;
  }
  return joined;
}

}  // namespace

std::optional<double> unit_of_last_digit(std::span<const double> numbers) {
  int digits = 0, last = 0, magnitude = 0;
  bool any = false;
  std::vector<Decimal> decimals;
  for (const double x : numbers) {
    if (x == 0 || !std::isfinite(x)) continue;
    const Decimal d = decimal_of(x);
    if (d.digits > most_digits) return std::nullopt;
    digits = std::max(digits, d.digits);
    last = any ? std::min(last, d.last) : d.last;
    magnitude = any ? std::max(magnitude, d.magnitude) : d.magnitude;
    any = true;
    decimals.push_back(d);
  }
  if (!any || last >= 0) return std::nullopt;
  const auto of_as_many_decimals = std::ranges::count_if(decimals, [&](const Decimal& d) { return d.last == last; });
  const auto of_as_many_digits = std::ranges::count_if(decimals, [&](const Decimal& d) { return d.digits == digits; });
  const bool has_decimals = of_as_many_decimals >= of_as_many_digits;
  if (has_decimals && magnitude - last >= most_digits) return std::nullopt;
  return std::pow(10.0, has_decimals ? last : magnitude - digits + 1);
}

template <int D>
std::optional<Proposal> find_proposal(const Plc<D>& plc, const Domain<D>& domain) {
  try {
    const auto other = with_tolerance_of_digits(plc);
    if (!other) return std::nullopt;
    if (narrowest_gap<D>(domain, {.in = GapsIn::not_meshed, .within = *other->tolerance}))
      return std::nullopt;  // it takes no cells, and may be meant
    const Domain<D> then(*other);
    Proposal proposal{*other->tolerance, domain.facets().size(), then.facets().size(), 0};
    const std::size_t before = joined_points(domain), after = joined_points(then);
    if (after > before) proposal.joined = after - before;
    if (proposal.joined > 0 || proposal.facets_then < proposal.facets) return proposal;
  } catch (const std::exception&) {  // it breaks a guard; and the mesh is there without it
  }
  return std::nullopt;
}

template <int D>
std::optional<double> cure_of_gaps(const Plc<D>& plc, const Domain<D>& domain,
                                   const std::function<bool(const Domain<D>&)>& is_cured) {
  const auto proposal = find_proposal(plc, domain);
  if (!proposal) return std::nullopt;
  Plc<D> other = plc;
  other.tolerance = proposal->tolerance;
  std::optional<Domain<D>> then;
  if (diagnose(other, {.most_listed = 0, .errors_only = true, .stop = {}}, then).error_count() > 0 || !then) return std::nullopt;
  if (!is_cured(*then)) return std::nullopt;
  return proposal->tolerance;
}

template <int D>
std::optional<double> tolerance_for_refused(const Plc<D>& plc, const Treatment& done, const std::stop_token& stop) {
  try {
    const auto other = with_tolerance_of_digits(plc);
    if (!other || stop.stop_requested()) return std::nullopt;
    std::vector<Diagnostic> ignored;
    const Plc<D> prepared = treated<D>(*other, done, ignored, stop);
    std::optional<Domain<D>> then;
    if (diagnose(prepared, {.most_listed = 0, .errors_only = true, .stop = stop}, then).error_count() > 0 || !then)
      return std::nullopt;
    const auto gap = narrowest_gap<D>(*then, {.stop = stop});
    if (!gap || gap->distance >= least_of_next * *other->tolerance) return other->tolerance;
  } catch (const std::exception&) {  // the refusal says enough
  }
  return std::nullopt;
}

template std::optional<Proposal> find_proposal<2>(const Plc<2>&, const Domain<2>&);
template std::optional<Proposal> find_proposal<3>(const Plc<3>&, const Domain<3>&);
template std::optional<double> cure_of_gaps<2>(const Plc<2>&, const Domain<2>&, const std::function<bool(const Domain<2>&)>&);
template std::optional<double> cure_of_gaps<3>(const Plc<3>&, const Domain<3>&, const std::function<bool(const Domain<3>&)>&);
template std::optional<double> tolerance_for_refused<2>(const Plc<2>&, const Treatment&, const std::stop_token&);
template std::optional<double> tolerance_for_refused<3>(const Plc<3>&, const Treatment&, const std::stop_token&);

}  // namespace pgdr::tool
