// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "input/steps/distinct_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "numbers/finite.hpp"
#include "pgdr/predicates.hpp"
#include "space/point_places.hpp"

namespace pgdr::detail {
namespace {

constexpr double most_merge_within = 0.01;

template <int D>
Point<D> with_positive_zeros(Point<D> p) {
  for (double& x : p.x) x += 0.0;
  return p;
}

template <int D>
[[noreturn]] void bad_length(const Plc<D>& plc, std::size_t length, const char* of) {
  throw UsageError({Errc::bad_option,
                    std::to_string(length) + of + " for " + std::to_string(plc.points.size()) + " points",
                    plc.source.file,
                    0,
                    {},
                    {}});
}

template <int D>
std::size_t attributes_per_point(const Plc<D>& plc) {
  const std::size_t n = plc.points.size(), attributes = n == 0 ? 0 : plc.point_attributes.size() / n;
  if (attributes * n != plc.point_attributes.size()) bad_length(plc, plc.point_attributes.size(), " attributes");
  return attributes;
}

template <int D>
void keep_point(const Plc<D>& plc, std::uint32_t i, const Point<D>& p, std::size_t attributes, DistinctPoints<D>& out) {
  out.points.push_back(p);
  out.input_of_point.push_back(i);
  out.markers.push_back(plc.point_markers.empty() ? 0 : plc.point_markers[i]);
  const auto first = plc.point_attributes.begin() + static_cast<std::ptrdiff_t>(i * attributes);
  out.attributes.insert(out.attributes.end(), first, first + static_cast<std::ptrdiff_t>(attributes));
}

}  // namespace

template <int D>
void check_finite(const Plc<D>& plc, const BuildReport<D>& report) {
  const auto number = [&](std::size_t i) { return std::to_string(report.number(i)); };
  const auto check = [&](const Point<D>& p, const std::string& what, const std::vector<std::uint32_t>& lines, std::size_t i) {
    if (is_finite(p)) return;
    report.attempt([&] {
      report.fail(Errc::not_finite, what + " " + number(i) + " " + to_text(p) + " is not finite", lines, i, {report.number(i)},
                  {in_space(p)});
    });
  };
  for (std::size_t i = 0; i < plc.points.size(); ++i) check(plc.points[i], "point", plc.source.point_lines, i);
  for (std::size_t i = 0; i < plc.holes.size(); ++i) check(plc.holes[i], "hole", plc.source.hole_lines, i);
  for (std::size_t i = 0; i < plc.regions.size(); ++i) {
    const auto& r = plc.regions[i];
    check(r.point, "region", plc.source.region_lines, i);
    if (!std::isnan(r.attribute) && !std::isnan(r.size)) continue;
    report.attempt([&] {
      report.fail(Errc::not_finite, "region " + number(i) + " has an attribute or a size that is no number",
                  plc.source.region_lines, i, {report.number(i)}, {in_space(r.point)});
    });
  }
  for (std::size_t f = 0; f < plc.facets.size(); ++f)
    for (const Point<D>& p : plc.facets[f].holes) check(p, "hole of facet", plc.source.facet_lines, f);
}

template <int D>
void check_indices(const Plc<D>& plc, const BuildReport<D>& report) {
  const auto number = [&](std::size_t i) { return std::to_string(report.number(i)); };
  const std::size_t n = plc.points.size();
  if (n >= std::numeric_limits<std::uint32_t>::max() - 2)
    throw ResourceError(Diagnostic{Errc::ids_exhausted, "more than 2^32 - 3 points", plc.source.file, 0, {}, {}});
  const auto check = [&](std::uint32_t v, const std::string& what, const std::vector<std::uint32_t>& lines, std::size_t i) {
    if (v < n) return;
    const std::string range = n == 0 ? "there are no points" : "the points are " + number(0) + " to " + number(n - 1);
    report.attempt([&] {
      report.fail(Errc::index_out_of_range, what + " " + number(i) + " refers to point " + number(v) + "; " + range, lines, i,
                  {report.number(i), report.number(v)}, {});
    });
  };
  for (std::size_t s = 0; s < plc.segments.size(); ++s)
    for (const std::uint32_t v : plc.segments[s].points) check(v, "segment", plc.source.segment_lines, s);
  for (std::size_t f = 0; f < plc.facets.size(); ++f)
    for (const auto& polygon : plc.facets[f].polygons)
      for (const std::uint32_t v : polygon) check(v, "facet", plc.source.facet_lines, f);
  if (D == 2 && !plc.facets.empty())
    report.attempt([&] {
      report.fail(Errc::degenerate_facet, "a planar straight line graph has no facets", plc.source.facet_lines, 0,
                  {report.number(0)}, {});
    });
}

template <int D>
DistinctPoints<D> merge_points(const Plc<D>& plc, BuildReport<D>& report) {
  if (!(plc.merge_within >= 0 && plc.merge_within <= most_merge_within))
    throw UsageError({Errc::bad_option,
                      "points are merged within a distance from 0 to 0.01 times the largest coordinate",
                      plc.source.file,
                      0,
                      {},
                      {}});
  const std::size_t n = plc.points.size(), attributes = attributes_per_point(plc);
  if (!plc.point_markers.empty() && plc.point_markers.size() != n) bad_length(plc, plc.point_markers.size(), " markers");
  const bool near = plc.merge_within > 0;
  const auto [scale, largest] = scale_of<D>(plc.points);
  DistinctPoints<D> out;
  PointPlaces places(n);
  PointGrid<D> grid(near ? n : 0, scale, std::max(plc.merge_within * largest, 0x1p-200));
  out.points.reserve(n);
  out.point_of_input.resize(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    const Point<D> p = with_positive_zeros(plc.points[i]);
    if (std::any_of(p.x.begin(), p.x.end(), [](double x) { return x == 0; }))
      if (std::any_of(plc.points[i].x.begin(), plc.points[i].x.end(), [](double x) { return x == 0 && std::signbit(x); }))
        report.repairs.negative_zeros.add([&] { return std::to_string(report.number(i)); }, {report.number(i)});
    const std::size_t hash = hash_of(p);
    std::uint32_t at = places.find(hash, [&](std::uint32_t v) { return out.points[v] == p; });
    const bool repeated = at != no_entity;
    if (!repeated && near) at = grid.nearest(p, out.points);
    if (at == no_entity) {
      at = static_cast<std::uint32_t>(out.points.size());
      keep_point(plc, i, p, attributes, out);
      places.insert(hash, at);
      if (near) grid.insert(p, at);
    } else {
      const std::int64_t first = report.number(out.input_of_point[at]);
      const auto words = [&] { return std::to_string(report.number(i)) + " = " + std::to_string(first); };
      (repeated ? report.repairs.merged : report.repairs.merged_near).add(words, {report.number(i), first});
    }
    out.point_of_input[i] = at;
  }
  for (const Point<D>& p : plc.holes) out.holes.push_back(with_positive_zeros(p));
  for (RegionSeed<D> r : plc.regions) {
    r.point = with_positive_zeros(r.point);
    out.regions.push_back(r);
  }
  return out;
}

template <int D>
void check_spans_space(std::span<const Point<D>> p, const BuildReport<D>& report) {
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
  report.fail(Errc::no_volume, n <= D ? count + " are too few" : "all " + count + where, {}, 0, {}, {});
}

#define PGDR_INSTANTIATE(D)                                                   \
  template void check_finite<D>(const Plc<D>&, const BuildReport<D>&);        \
  template void check_indices<D>(const Plc<D>&, const BuildReport<D>&);       \
  template DistinctPoints<D> merge_points<D>(const Plc<D>&, BuildReport<D>&); \
  template void check_spans_space<D>(std::span<const Point<D>>, const BuildReport<D>&);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr::detail
