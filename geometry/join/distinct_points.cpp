// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "join/distinct_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "input/diagonal.hpp"
#include "join/point_groups.hpp"
#include "numbers/finite.hpp"
#include "pgdr/predicates.hpp"
#include "space/point_places.hpp"

namespace pgdr::detail {
namespace {

constexpr double most_of_diagonal = 1e-3;  // of a tolerance that nobody has confirmed

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
  const auto check = [&](const Point<D>& p, const std::string& what, SourceItem kind, std::size_t i) {
    if (is_finite(p)) return;
    report.attempt([&] {
      report.fail(Errc::not_finite, what + " " + number(i) + " " + to_text(p) + " is not finite", kind, i, {report.number(i)},
                  {in_space(p)});
    });
  };
  for (std::size_t i = 0; i < plc.points.size(); ++i) check(plc.points[i], "point", SourceItem::point, i);
  for (std::size_t i = 0; i < plc.holes.size(); ++i) check(plc.holes[i], "hole", SourceItem::hole, i);
  for (std::size_t i = 0; i < plc.regions.size(); ++i) {
    const auto& r = plc.regions[i];
    check(r.point, "region", SourceItem::region, i);
    if (!std::isnan(r.attribute) && !std::isnan(r.size)) continue;
    report.attempt([&] {
      report.fail(Errc::not_finite, "region " + number(i) + " has an attribute or a size that is no number", SourceItem::region,
                  i, {report.number(i)}, {in_space(r.point)});
    });
  }
  for (std::size_t f = 0; f < plc.facets.size(); ++f)
    for (const Point<D>& p : plc.facets[f].holes) check(p, "hole of facet", SourceItem::facet, f);
}

template <int D>
void check_indices(const Plc<D>& plc, const BuildReport<D>& report) {
  const auto number = [&](std::size_t i) { return std::to_string(report.number(i)); };
  const std::size_t n = plc.points.size();
  if (n >= std::numeric_limits<std::uint32_t>::max() - 2)
    throw ResourceError(Diagnostic{Errc::ids_exhausted, "more than 2^32 - 3 points", plc.source.file, 0, {}, {}});
  const auto check = [&](std::uint32_t v, const std::string& what, SourceItem kind, std::size_t i) {
    if (v < n) return;
    const std::string range = n == 0 ? "there are no points" : "the points are " + number(0) + " to " + number(n - 1);
    report.attempt([&] {
      report.fail(Errc::index_out_of_range, what + " " + number(i) + " refers to point " + number(v) + "; " + range, kind, i,
                  {report.number(i), report.number(v)}, {});
    });
  };
  for (std::size_t s = 0; s < plc.segments.size(); ++s)
    for (const std::uint32_t v : plc.segments[s].points) check(v, "segment", SourceItem::segment, s);
  for (std::size_t f = 0; f < plc.facets.size(); ++f)
    for (const auto& polygon : plc.facets[f].polygons)
      for (const std::uint32_t v : polygon) check(v, "facet", SourceItem::facet, f);
  if (D == 2 && !plc.facets.empty())
    report.attempt([&] {
      report.fail(Errc::degenerate_facet, "a planar straight line graph has no facets", SourceItem::facet, 0, {report.number(0)},
                  {});
    });
}

namespace {

/// The points of a Plc at distinct places, in their order.
template <int D>
class ExactPoints {
 public:
  ExactPoints(const Plc<D>& plc, BuildReport<D>& report) : at_(plc.points.size()) {
    PointPlaces places(plc.points.size());
    for (std::uint32_t i = 0; i < plc.points.size(); ++i) {
      const Point<D> p = with_positive_zeros(plc.points[i]);
      note_negative_zeros(plc.points[i], i, report);
      const std::size_t hash = hash_of(p);
      at_[i] = places.find(hash, [&](std::uint32_t v) { return points_[v] == p; });
      if (at_[i] == no_entity) {
        at_[i] = static_cast<std::uint32_t>(points_.size());
        places.insert(hash, at_[i]);
        points_.push_back(p);
        first_.push_back(i);
      } else {
        const std::int64_t number = report.number(i), first = report.number(first_[at_[i]]);
        report.repairs.merged.add([&] { return std::to_string(number) + " = " + std::to_string(first); }, {number, first});
      }
    }
  }

  std::span<const Point<D>> points() const { return points_; }
  std::uint32_t at(std::uint32_t i) const { return at_[i]; }        ///< of the Plc's point i
  std::uint32_t first(std::uint32_t v) const { return first_[v]; }  ///< the first of the Plc's points there

 private:
  static void note_negative_zeros(const Point<D>& p, std::uint32_t i, BuildReport<D>& report) {
    if (std::any_of(p.x.begin(), p.x.end(), [](double x) { return x == 0 && std::signbit(x); }))
      report.repairs.negative_zeros.add([&] { return std::to_string(report.number(i)); }, {report.number(i)});
  }

  std::vector<Point<D>> points_;
  std::vector<std::uint32_t> at_, first_;
};

template <int D>
void refuse_or_warn(const ExactPoints<D>& exact, const AmbiguousGroup& group, double scale, const Plc<D>& plc,
                    BuildReport<D>& report) {
  const std::uint32_t i = exact.first(group.first), k = exact.first(group.second);
  const auto words = [&](std::uint32_t v) { return std::to_string(report.number(v)) + " " + to_text(plc.points[v]); };
  const std::string message = std::to_string(group.size) + " points, each within the tolerance of the next, are " +
                              to_text(group.distance / scale) + " apart, more than twice the tolerance: points " + words(i) +
                              " and " + words(k);
  const std::vector<std::int64_t> ids{report.number(i), report.number(k)};
  if (plc.tolerance)
    report.attempt([&] {
      report.fail(Errc::ambiguous, message, SourceItem::point, i, ids, {in_space(plc.points[i]), in_space(plc.points[k])});
    });
  else
    report.warn(Errc::ambiguous, message + "; they are left apart", SourceItem::point, i, ids);
}

template <int D>
PointGroups groups_of(const ExactPoints<D>& exact, double tolerance, const StopCheck& stop, const Plc<D>& plc,
                      BuildReport<D>& report) {
  const double scale = scale_of<D>(exact.points()).first;
  std::vector<Point<D>> scaled(exact.points().begin(), exact.points().end());
  for (Point<D>& p : scaled)
    for (double& x : p.x) x *= scale;
  PointGroups groups = group_points<D>(scaled, tolerance * scale, stop);
  for (const AmbiguousGroup& group : groups.ambiguous) refuse_or_warn(exact, group, scale, plc, report);
  return groups;
}

/// Where tolerances end.
template <int D>
void check_tolerance(const Plc<D>& plc) {
  if (!plc.tolerance) return;
  const double tolerance = *plc.tolerance, diagonal = diagonal_of<D>(Box<D>::of(plc.points));
  if (!(tolerance >= 0) || !std::isfinite(tolerance))
    throw UsageError({Errc::bad_option, "the tolerance must be a length, or 0", plc.source.file, 0, {}, {}});
  if (!(tolerance <= most_of_diagonal * diagonal) && tolerance > 0 && !plc.is_coarse)
    throw UsageError({Errc::bad_option,
                      "a tolerance of " + to_text(tolerance) + " is more than a thousandth of the diagonal, " +
                          to_text(diagonal) +
                          "; it is an absolute length, and has to be confirmed (--yes-coarse, Plc::is_coarse) if it is meant",
                      plc.source.file,
                      0,
                      {},
                      {}});
}

}  // namespace

template <int D>
DistinctPoints<D> merge_points(const Plc<D>& plc, double tolerance, const StopCheck& stop, BuildReport<D>& report) {
  check_tolerance(plc);
  const std::size_t n = plc.points.size(), attributes = attributes_per_point(plc);
  if (!plc.point_markers.empty() && plc.point_markers.size() != n) bad_length(plc, plc.point_markers.size(), " markers");
  const ExactPoints<D> exact(plc, report);
  PointGroups groups;
  if (tolerance > 0) groups = groups_of(exact, tolerance, stop, plc, report);
  DistinctPoints<D> out;
  std::vector<std::uint32_t> number(exact.points().size(), no_entity);  // of each exact point among those of `out`
  for (std::uint32_t v = 0; v < exact.points().size(); ++v) {
    const std::uint32_t group = tolerance > 0 ? groups.group_of[v] : v;
    const Point<D>& p = exact.points()[tolerance > 0 ? groups.place_of[group] : v];
    if (group == v) {
      number[v] = static_cast<std::uint32_t>(out.points.size());
      keep_point(plc, exact.first(v), p, attributes, out);
    } else {
      number[v] = number[group];
      const std::int64_t mine = report.number(exact.first(v)), first = report.number(exact.first(group));
      report.repairs.merged_near.add([&] { return std::to_string(mine) + " = " + std::to_string(first); }, {mine, first});
    }
    out.largest_move = std::max(out.largest_move, std::sqrt(squared_distance(p, exact.points()[v])));
  }
  for (std::uint32_t i = 0; i < n; ++i) out.point_of_input.push_back(number[exact.at(i)]);
  for (const Point<D>& p : holes_within(plc, tolerance)) out.holes.push_back(with_positive_zeros(p));
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

#define PGDR_INSTANTIATE(D)                                                                             \
  template void check_finite<D>(const Plc<D>&, const BuildReport<D>&);                                  \
  template void check_indices<D>(const Plc<D>&, const BuildReport<D>&);                                 \
  template DistinctPoints<D> merge_points<D>(const Plc<D>&, double, const StopCheck&, BuildReport<D>&); \
  template void check_spans_space<D>(std::span<const Point<D>>, const BuildReport<D>&);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr::detail
