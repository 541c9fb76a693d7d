// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "join/point_groups.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "join/numbers.hpp"
#include "space/disjoint_sets.hpp"
#include "space/distances.hpp"
#include "space/point_places.hpp"

namespace pgdr::detail {
namespace {

/// Cubes of a grid so much wider than the tolerance that few points are near a wall of theirs, and moved off the origin, where
/// many points have their coordinates.
constexpr double width_of_cube = 64, moved_by = 0.37;

template <int D>
class Cubes {
 public:
  Cubes(std::size_t points, double tolerance) : places_(2 * points), tolerance_(tolerance) {}

  /// Calls visit(w) for the points inserted so far that may be within the tolerance of p, and inserts it as v.
  template <class Visit>
  void insert(const Point<D>& p, std::uint32_t v, std::span<const Point<D>> points, const Visit& visit) {
    Point<D> low, high;
    for (int i = 0; i < D; ++i) {
      low[i] = cube(p[i] - tolerance_);
      high[i] = cube(p[i] + tolerance_);
    }
    Point<D> at = low;
    while (true) {
      places_.find(hash_of(at), [&](std::uint32_t w) {
        if (home(points[w]) == at) visit(w);
        return false;
      });
      int i = 0;
      for (; i < D && !(at[i] < high[i]); ++i) at[i] = low[i];
      if (i == D) break;
      at[i] += 1;
    }
    places_.insert(hash_of(home(p)), v);
  }

 private:
  double cube(double x) const { return std::floor(x / (width_of_cube * tolerance_) + moved_by) + 0.0; }
  Point<D> home(const Point<D>& p) const {
    Point<D> c;
    for (int i = 0; i < D; ++i) c[i] = cube(p[i]);
    return c;
  }

  PointPlaces places_;
  double tolerance_;
};

/// The two points that are farthest apart.
template <int D>
AmbiguousGroup widest_pair(std::span<const std::uint32_t> group, std::span<const Point<D>> points) {
  AmbiguousGroup widest{group[0], group[0], 0, group.size()};
  const auto take = [&](std::uint32_t v, std::uint32_t w) {
    if (const double d = distance(points[v], points[w]); d > widest.distance) widest = {v, w, d, group.size()};
  };
  if (group.size() > numbers::most_compared) {
    for (int i = 0; i < D; ++i) {
      const auto [low, high] = std::ranges::minmax(group, {}, [&](std::uint32_t v) { return points[v][i]; });
      take(low, high);
    }
    return widest;
  }
  for (std::size_t i = 0; i < group.size(); ++i)
    for (std::size_t k = i + 1; k < group.size(); ++k) take(group[i], group[k]);
  return widest;
}

}  // namespace

template <int D>
PointGroups group_points(std::span<const Point<D>> points, double tolerance, const StopCheck& stop) {
  const auto n = static_cast<std::uint32_t>(points.size());
  DisjointSets sets(n);
  Cubes<D> cubes(n, tolerance);
  std::vector<std::uint32_t> joined;
  for (std::uint32_t v = 0; v < n; ++v) {
    stop();
    cubes.insert(points[v], v, points, [&](std::uint32_t w) {
      if (!(distance(points[v], points[w]) <= tolerance)) return;
      sets.unite(v, w);
      joined.insert(joined.end(), {v, w});
    });
  }
  PointGroups out;
  out.group_of.resize(n);
  std::iota(out.group_of.begin(), out.group_of.end(), 0u);
  out.place_of = out.group_of;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> members;  // of groups of several: name, point
  for (const std::uint32_t v : joined) members.emplace_back(sets.find(v), v);
  std::sort(members.begin(), members.end());
  members.erase(std::unique(members.begin(), members.end()), members.end());
  std::vector<std::uint32_t> group;
  for (std::size_t i = 0, end = 0; i < members.size(); i = end) {
    group.clear();
    for (end = i; end < members.size() && members[end].first == members[i].first; ++end) group.push_back(members[end].second);
    if (const AmbiguousGroup widest = widest_pair<D>(group, points); widest.distance > 2 * tolerance) {
      out.ambiguous.push_back(widest);
      continue;
    }
    for (const std::uint32_t v : group) out.group_of[v] = group[0];
    out.place_of[group[0]] = *std::ranges::min_element(
        group, [&](std::uint32_t v, std::uint32_t w) { return lex_less(points[v], points[w]); });
  }
  return out;
}

template PointGroups group_points<2>(std::span<const Point<2>>, double, const StopCheck&);
template PointGroups group_points<3>(std::span<const Point<3>>, double, const StopCheck&);

}  // namespace pgdr::detail
