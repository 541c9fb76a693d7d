// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "problems.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>

namespace pgdr::tool {
namespace {

using Place = std::array<double, 3>;
using Ids = std::array<std::int64_t, 2>;

class Collector {
 public:
  explicit Collector(Problems& out) : out_(out) {
    for (std::uint32_t i = 0; i < out.points.size(); ++i) numbers_.emplace(out.points[i], i);
  }

  /// What so many points are: a point, a line, or, if they go round something, a polygon or a ring.
  void add(Finding finding, Problems::Role role, const Ids& ids, double measure, std::span<const Place> points,
           bool is_ring = false, bool is_polygon = false) {
    Problems::Cell cell{finding, role, ids, measure, {}};
    for (const Place& p : points) {
      const std::uint32_t n = number(p);
      if (cell.points.empty() || cell.points.back() != n) cell.points.push_back(n);
    }
    if (cell.points.size() > 1 && cell.points.front() == cell.points.back()) cell.points.pop_back();
    if (cell.points.empty()) return;
    if (is_ring && !is_polygon && cell.points.size() > 2) cell.points.push_back(cell.points.front());
    auto& cells = cell.points.size() == 1 ? out_.vertices : is_polygon && cell.points.size() > 2 ? out_.polygons : out_.lines;
    cells.push_back(std::move(cell));
  }
  /// Is this the first time that the entity is a culprit of such findings?
  bool is_new(Finding finding, char what, const Ids& ids) { return seen_.emplace(finding, what, ids).second; }

 private:
  std::uint32_t number(const Place& p) {
    const auto [at, is_new] = numbers_.emplace(p, static_cast<std::uint32_t>(out_.points.size()));
    if (is_new) out_.points.push_back(p);
    return at->second;
  }

  Problems& out_;
  std::map<Place, std::uint32_t> numbers_;
  std::set<std::tuple<Finding, char, Ids>> seen_;
};

template <int D>
class ProblemFinder {
 public:
  ProblemFinder(const Plc<D>& plc, Problems& out) : plc_(plc), out_(out) {}

  void add(Finding kind, const FindingList::Item& item) {
    kind_ = kind;
    measure_ = item.measure;
    const std::vector<std::int64_t>& ids = item.what.ids;
    const std::span<const Place> points(item.what.points);
    add_culprits(ids);
    switch (kind) {
      case Finding::encloses_nothing: return;  // the open boundaries are in their own list
      case Finding::open_boundary: return out_.add(kind, Problems::Role::where, first_two(ids), measure_, points, is_loop(item));
      case Finding::invalid_entity:
        if (item.what.code == Errc::entities_intersect && points.size() == 4) {  // two edges
          place(ids, points.first(2));
          return place(ids, points.subspan(2));
        }
        [[fallthrough]];
      case Finding::duplicate_point:
      case Finding::unreferenced_point:
      case Finding::non_manifold_point:
      case Finding::facets_overlap:
        for (const Place& p : points) place(ids, {&p, 1});
        return;
      default: return place(ids, points);
    }
  }

 private:
  static Ids first_two(const std::vector<std::int64_t>& ids) { return {ids.empty() ? -1 : ids[0], ids.size() < 2 ? -1 : ids[1]}; }
  void place(const std::vector<std::int64_t>& ids, std::span<const Place> points) {
    out_.add(kind_, Problems::Role::where, first_two(ids), measure_, points);
  }

  /// By what ids of each kind are (diagnosis.hpp).
  void add_culprits(const std::vector<std::int64_t>& ids) {
    if (ids.size() < 2) return;
    switch (kind_) {
      case Finding::facets_cross:
      case Finding::facets_overlap:
      case Finding::repeated_facet:
        for (const std::int64_t id : {ids[0], ids[1]}) D == 3 ? facet(id) : segment_of_input(id);
        return;
      case Finding::inconsistent_orientation: facet(ids[0]); return facet(ids[1]);
      case Finding::segment_crosses_facet:
        line(ids[0], ids[1]);
        if (ids.size() > 2) facet(ids[2]);
        return;
      case Finding::segments_cross:
        line(ids[0], ids[1]);
        if (ids.size() > 3) line(ids[2], ids[3]);
        return;
      case Finding::point_on_facet: return facet(ids[1]);
      case Finding::point_on_segment:
        if (ids.size() > 2) line(ids[1], ids[2]);
        return;
      default: return;
    }
  }

  std::optional<Place> point(std::int64_t id) const {
    const std::int64_t i = id - plc_.first_index;
    if (i < 0 || static_cast<std::size_t>(i) >= plc_.points.size()) return std::nullopt;  // a Domain has added it
    Place p{};
    std::copy_n(plc_.points[static_cast<std::size_t>(i)].x.begin(), D, p.begin());
    return p;
  }
  void line(std::int64_t a, std::int64_t b) {
    const auto p = point(a), q = point(b);
    if (p && q && out_.is_new(kind_, 's', {a, b})) out_.add(kind_, Problems::Role::culprit, {a, b}, measure_, std::array{*p, *q});
  }
  void segment_of_input(std::int64_t id) {
    const std::int64_t i = id - plc_.first_index;
    if (i < 0 || static_cast<std::size_t>(i) >= plc_.segments.size()) return;
    const auto& [a, b] = plc_.segments[static_cast<std::size_t>(i)].points;
    line(a + std::int64_t{plc_.first_index}, b + std::int64_t{plc_.first_index});
  }
  void facet(std::int64_t id) {
    const std::int64_t i = id - plc_.first_index;
    if (i < 0 || static_cast<std::size_t>(i) >= plc_.facets.size() || !out_.is_new(kind_, 'f', {id, -1})) return;
    const auto& polygons = plc_.facets[static_cast<std::size_t>(i)].polygons;
    for (const auto& polygon : polygons) {
      std::vector<Place> corners;
      for (const std::uint32_t v : polygon)
        if (const auto p = point(v + std::int64_t{plc_.first_index})) corners.push_back(*p);
      out_.add(kind_, Problems::Role::culprit, {id, -1}, measure_, corners, true, polygons.size() == 1);
    }
  }

  /// The length of a loop is that of all its edges, of a path that of one less: the same sum as the diagnosis'.
  static bool is_loop(const FindingList::Item& item) {
    const auto& p = item.what.points;
    const auto length = [](const Place& a, const Place& b) {
      return std::sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
    };
    if (D == 2 || p.size() < 3) return false;
    double path = 0;
    for (std::size_t k = 1; k < p.size(); ++k) path += length(p[k - 1], p[k]);
    return item.measure - path > length(p.back(), p.front()) / 2;
  }

  const Plc<D>& plc_;
  Collector out_;
  Finding kind_{};
  double measure_ = 0;
};

}  // namespace

template <int D>
Problems problems_in_full(const Plc<D>& plc, const Diagnosis<D>& diagnosis) {
  constexpr std::size_t most_of_reported = 10000, all_of_them = std::numeric_limits<std::size_t>::max();
  const Diagnosis<D> errors = diagnose(plc, {.most_listed = all_of_them, .errors_only = true, .stop = {}});
  const Diagnosis<D> reported = diagnose(plc, {.most_listed = most_of_reported, .stop = {}});
  Problems problems;
  ProblemFinder<D> finder(plc, problems);
  for (std::size_t k = 0; k < finding_kinds; ++k) {
    const auto kind = static_cast<Finding>(k);
    const Diagnosis<D>& from = is_error(kind) || kind == Finding::open_boundary ? errors
                               : kind < Finding::segments_below_60              ? reported
                                                                                : diagnosis;
    for (const FindingList::Item& item : from[kind].listed) finder.add(kind, item);
  }
  return problems;
}

void add_problem(Problems& problems, const Diagnostic& error) {
  Collector out(problems);
  for (const Place& p : error.points)
    out.add(Finding::invalid_entity, Problems::Role::where, {error.ids.empty() ? -1 : error.ids[0], -1}, 0, {&p, 1});
}

template Problems problems_in_full<2>(const Plc<2>&, const Diagnosis<2>&);
template Problems problems_in_full<3>(const Plc<3>&, const Diagnosis<3>&);

}  // namespace pgdr::tool
