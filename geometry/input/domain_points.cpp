// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// First step of a Domain: finite points, valid indices, segments of non-zero length, and points that are not all in one plane.
#include <algorithm>
#include <cmath>
#include <limits>

#include "input/domain_builder.hpp"
#include "numbers/finite.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr {
namespace {

}  // namespace

template <int D>
void DomainBuilder<D>::check_finite() const {
  const auto check = [&](const Point<D>& p, const std::string& what, const std::vector<std::uint32_t>& lines,
                         std::size_t i) {
    if (detail::is_finite(p)) return;
    attempt([&] {
      fail(Errc::not_finite, what + " " + std::to_string(number(i)) + " " + detail::to_text(p) + " is not finite",
           lines, i, {number(i)}, {detail::in_space(p)});
    });
  };
  for (std::size_t i = 0; i < plc_.points.size(); ++i) check(plc_.points[i], "point", plc_.source.point_lines, i);
  for (std::size_t i = 0; i < plc_.holes.size(); ++i) check(plc_.holes[i], "hole", plc_.source.hole_lines, i);
  for (std::size_t i = 0; i < plc_.regions.size(); ++i) {
    const auto& r = plc_.regions[i];
    check(r.point, "region", plc_.source.region_lines, i);
    if (!std::isnan(r.attribute) && !std::isnan(r.size)) continue;
    attempt([&] {
      fail(Errc::not_finite, "region " + std::to_string(number(i)) + " has an attribute or a size that is no number",
           plc_.source.region_lines, i, {number(i)}, {detail::in_space(r.point)});
    });
  }
  for (std::size_t f = 0; f < plc_.facets.size(); ++f)
    for (const Point<D>& p : plc_.facets[f].holes) check(p, "hole of facet", plc_.source.facet_lines, f);
}

template <int D>
void DomainBuilder<D>::check_indices() const {
  const std::size_t n = plc_.points.size();
  if (n >= std::numeric_limits<std::uint32_t>::max() - 2)
    throw ResourceError(Diagnostic{Errc::ids_exhausted, "more than 2^32 - 3 points", plc_.source.file, 0, {}, {}});
  const auto check = [&](std::uint32_t v, const std::string& what, const std::vector<std::uint32_t>& lines,
                         std::size_t i) {
    if (v < n) return;
    const std::string range = n == 0 ? "there are no points"
                                     : "the points are " + std::to_string(number(0)) + " to " +
                                           std::to_string(number(n - 1));
    attempt([&] {
      fail(Errc::index_out_of_range,
           what + " " + std::to_string(number(i)) + " refers to point " + std::to_string(number(v)) + "; " + range,
           lines, i, {number(i), number(v)}, {});
    });
  };
  for (std::size_t s = 0; s < plc_.segments.size(); ++s)
    for (const std::uint32_t v : plc_.segments[s].points) check(v, "segment", plc_.source.segment_lines, s);
  for (std::size_t f = 0; f < plc_.facets.size(); ++f)
    for (const auto& polygon : plc_.facets[f].polygons)
      for (const std::uint32_t v : polygon) check(v, "facet", plc_.source.facet_lines, f);
  if (D == 2 && !plc_.facets.empty())
    attempt([this] {
      fail(Errc::degenerate_facet, "a planar straight line graph has no facets", plc_.source.facet_lines, 0,
           {number(0)}, {});
    });
}

template <int D>
void DomainBuilder<D>::check_segments() {
  explicit_begin_.assign(out_.points_.size() + 1, 0);
  for (std::size_t s = 0; s < plc_.segments.size(); ++s) {
    const auto [i, j] = plc_.segments[s].points;
    const std::uint32_t a = out_.point_of_input_[i], b = out_.point_of_input_[j];
    explicit_.push_back({a, b});
    ++explicit_begin_[a + 1];
    if (a != b) continue;
    if (!(plc_.points[i] == plc_.points[j])) {  // merged, as the caller wishes
      dropped_edges_.add([&] { return "segment " + std::to_string(number(s)); }, {number(s), number(i), number(j)});
      continue;
    }
    attempt([&, i = i, j = j] {
      fail(Errc::degenerate_segment,
           "segment " + std::to_string(number(s)) + ": its ends, points " + std::to_string(number(i)) + " and " +
               std::to_string(number(j)) + ", are both at " + detail::to_text(out_.points_[a]),
           plc_.source.segment_lines, s, {number(s), number(i), number(j)}, {detail::in_space(out_.points_[a])});
    });
  }
  if constexpr (D == 3) {
    take_line_facets();
    for (std::size_t v = 1; v < explicit_begin_.size(); ++v) explicit_begin_[v] += explicit_begin_[v - 1];
    std::vector<std::uint32_t> next(explicit_begin_);
    explicit_at_.resize(explicit_.size());
    for (std::uint32_t s = 0; s < explicit_.size(); ++s) explicit_at_[next[explicit_[s][0]]++] = s;
  }
}

// A facet of one polygon of two corners is a segment, as TetGen's files have loose ones.
template <int D>
void DomainBuilder<D>::take_line_facets() requires(D == 3) {
  for (std::uint32_t f = 0; f < plc_.facets.size(); ++f) {
    const auto& facet = plc_.facets[f];
    if (facet.polygons.size() != 1 || facet.polygons[0].size() != 2 || !facet.holes.empty()) continue;
    const std::uint32_t a = out_.point_of_input_[facet.polygons[0][0]], b = out_.point_of_input_[facet.polygons[0][1]];
    if (a == b) continue;
    explicit_.push_back({a, b});
    ++explicit_begin_[a + 1];
    line_facets_.push_back(f);
  }
}

// Exact: some D + 1 points span the space.
template <int D>
void DomainBuilder<D>::check_spans_space() const {
  const auto& p = out_.points_;
  const std::size_t n = p.size();
  std::size_t c = 2;
  while (c < n && collinear<D>(p[0], p[1], p[c])) ++c;
  bool spans = c < n;
  if constexpr (D == 3) {
    std::size_t d = c + 1;
    while (spans && d < n && orient3d(p[0], p[1], p[c], p[d]) == Sign::zero) ++d;
    spans = spans && d < n;
  }
  if (spans) return;
  const std::string count = std::to_string(n) + " distinct points";
  const std::string where = D == 3 ? " lie in one plane" : " lie on one line";
  fail(Errc::no_volume, n <= D ? count + " are too few" : "all " + count + where, {}, 0, {}, {});
}

// Areas and normals are formed of coordinates below 2: they neither overflow nor depend on the unit of length.
template <int D>
void DomainBuilder<D>::choose_scale() {
  double largest = 0;
  for (const Point<D>& p : out_.points_)
    for (const double x : p.x) largest = std::max(largest, std::fabs(x));
  if (largest > 0) scale_ = std::ldexp(1.0, std::min(-std::ilogb(largest), 1022));
}

#define PGDR_INSTANTIATE(D)                              \
  template void DomainBuilder<D>::check_finite() const;  \
  template void DomainBuilder<D>::check_indices() const; \
  template void DomainBuilder<D>::check_segments();      \
  template void DomainBuilder<D>::choose_scale();        \
  template void DomainBuilder<D>::check_spans_space() const;
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr
