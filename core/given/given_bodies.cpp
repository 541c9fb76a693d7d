// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "given/given_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "numbers/exact_sum.hpp"
#include "numbers/rounding.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/box.hpp"
#include "space/disjoint_sets.hpp"

namespace pgdr::checking {
namespace {

using detail::ExactSum;

int largest_axis(const std::array<Point<3>, 3>& s) {
  const auto n = detail::cross(detail::difference(s[1], s[0]), detail::difference(s[2], s[0]));
  int axis = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (std::abs(n[i]) > std::abs(n[static_cast<std::size_t>(axis)])) axis = static_cast<int>(i);
  return axis;
}

/// May the segment meet the box? In doubles, a little more than it does.
bool may_meet(const Point<3>& from, const Point<3>& to, const detail::Box<3>& box) {
  double low = 0, high = 1;
  for (int i = 0; i < 3; ++i) {
    const double way = to[i] - from[i];
    if (way == 0) {
      if (!(box.low[i] <= from[i] && from[i] <= box.high[i])) return false;
      continue;
    }
    const double a = (box.low[i] - from[i]) / way, b = (box.high[i] - from[i]) / way;
    low = std::max(low, std::min(a, b) - rounding::of_pruning);
    high = std::min(high, std::max(a, b) + rounding::of_pruning);
  }
  return low <= high;
}

}  // namespace

GivenBodies::GivenBodies(const GivenInput<3>& input) : input_(input) {
  for (const GivenTriangle& t : input.triangles()) {
    triangles_.push_back(input.corners(t));
    places_.push_back({input.place(t.points[0]), input.place(t.points[1]), input.place(t.points[2])});
    const auto i = static_cast<std::uint32_t>(triangles_.size() - 1);
    if (turns_over(i)) {
      std::swap(triangles_[i][1], triangles_[i][2]);
      std::swap(places_[i][1], places_[i][2]);
    }
  }
  std::vector<detail::Box<3>> boxes;
  for (const auto& s : triangles_) boxes.push_back(detail::Box<3>::of(s));
  tree_.emplace(boxes);
  span_ = 4 * detail::Box<3>::of(input.plc().points).longest_side();
  find_bodies();
  require_closed();
  if (!unfit_.empty()) return;
  measure();
  if (input.plc().facet_bodies.empty()) join_cavities();
}

/// Do the triangles of the facet, which all run one way in the projection, run against its first polygon?
bool GivenBodies::turns_over(std::uint32_t triangle) const {
  const auto& polygon = input_.plc().facets[input_.triangles()[triangle].facet].polygons[0];
  const int axis = largest_axis(triangles_[triangle]);
  const auto flat = [axis](const Point<3>& x) { return Point<2>{{x[(axis + 1) % 3], x[(axis + 2) % 3]}}; };
  ExactSum area;
  for (std::size_t k = 0; k < polygon.size(); ++k)
    area.add_determinant(flat(input_.point(polygon[k])), flat(input_.point(polygon[(k + 1) % polygon.size()])));
  const auto& s = triangles_[triangle];
  return sign_of(area.divided_by(2)) != orient_projected(s[0], s[1], s[2], axis);
}

void GivenBodies::find_bodies() {
  const auto& of_facet = input_.plc().facet_bodies;
  body_of_.resize(triangles_.size());
  if (!of_facet.empty()) {
    for (std::size_t i = 0; i < body_of_.size(); ++i) body_of_[i] = of_facet[input_.triangles()[i].facet];
    return;
  }
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> first_at;
  detail::DisjointSets sets(triangles_.size());
  for (std::uint32_t i = 0; i < triangles_.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(places_[i][k], places_[i][(k + 1) % 3]);
      sets.unite(i, first_at.try_emplace({a, b}, i).first->second);
    }
  std::map<std::uint32_t, std::uint32_t> number;
  for (std::uint32_t i = 0; i < body_of_.size(); ++i)
    body_of_[i] = number.try_emplace(sets.find(i), static_cast<std::uint32_t>(number.size())).first->second;
}

void GivenBodies::require_closed() {
  std::map<std::array<std::uint32_t, 3>, int> runs;
  for (std::size_t i = 0; i < triangles_.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = places_[i][k], b = places_[i][(k + 1) % 3];
      runs[{body_of_[i], std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  for (const auto& [edge, times] : runs)
    if (times != 0) {
      unfit_ = "body " + std::to_string(edge[0]) + " is not closed as it is given, at the edge from " +
               words(input_.point(edge[1])) + " to " + words(input_.point(edge[2]));
      return;
    }
}

void GivenBodies::measure() {
  const std::uint32_t count = body_of_.empty() ? 0 : 1 + *std::ranges::max_element(body_of_);
  std::vector<ExactSum> sums(count);
  ExactSum all;
  areas_.assign(count, 0);
  perimeters_.assign(count, 0);
  least_points_.assign(count, {});
  std::vector<char> seen(count, 0);
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const auto& s = triangles_[i];
    const std::uint32_t b = body_of_[i];
    sums[b].add_determinant(s[0], s[1], s[2]);
    all.add_determinant(s[0], s[1], s[2]);
    const auto n = detail::cross(detail::difference(s[1], s[0]), detail::difference(s[2], s[0]));
    areas_[b] += std::sqrt(detail::dot(n, n)) / 2;
    for (std::size_t k = 0; k < 3; ++k) {
      perimeters_[b] += std::sqrt(squared_distance(s[k], s[(k + 1) % 3]));
      if (std::exchange(seen[b], 1) == 0 || lex_less(s[k], least_points_[b])) least_points_[b] = s[k];
    }
  }
  signs_.assign(count, all.divided_by(6) < 0 ? -1 : 1);
  volumes_.resize(count);
  for (std::uint32_t b = 0; b < count; ++b) {
    volumes_[b] = sums[b].divided_by(6);
    if (!input_.plc().facet_bodies.empty()) signs_[b] = volumes_[b] < 0 ? -1 : 1;
    volumes_[b] *= signs_[b];
  }
}

/// What is inside out in another body is of the least such body.
void GivenBodies::join_cavities() {
  std::vector<std::uint32_t> host(count());
  for (std::uint32_t b = 0; b < count(); ++b) {
    host[b] = b;
    if (volumes_[b] >= 0) continue;
    std::optional<std::set<std::uint32_t>> all;
    for (std::size_t i = 0; i < triangles_.size(); ++i)
      for (std::size_t k = 0; k < 3 && body_of_[i] == b; ++k) {
        const auto here = windings(triangles_[i][k], b);
        if (!here) continue;  // on another one
        std::set<std::uint32_t> both;
        for (const auto& [other, times] : *here)
          if (times > 0 && (!all || all->contains(other))) both.insert(other);
        all = std::move(both);
      }
    for (const std::uint32_t h : all.value_or(std::set<std::uint32_t>{}))
      if (volumes_[h] > 0 && (host[b] == b || volumes_[h] < volumes_[host[b]])) host[b] = h;
  }
  for (std::uint32_t b = 0; b < count(); ++b)
    if (host[b] != b) {
      volumes_[host[b]] += volumes_[b];
      areas_[host[b]] += areas_[b];
      perimeters_[host[b]] += perimeters_[b];
      volumes_[b] = 0;
      least_points_[b] = least_points_[host[b]];
    }
  for (std::uint32_t& body : body_of_) body = host[body];
}

/// None if the way meets an edge, or ends on a facet.
std::optional<std::map<std::uint32_t, int>> GivenBodies::cross(const Point<3>& x, const Point<3>& to,
                                                               std::uint32_t without) const {
  std::map<std::uint32_t, int> times;
  bool degenerate = false;
  tree_->wherever([&](const detail::Box<3>& box) { return !degenerate && may_meet(x, to, box); },
                  [&](std::uint32_t i) {
                    if (body_of_[i] == without) return;
                    const auto& s = triangles_[i];
                    const Sign of_x = orient3d(s[0], s[1], s[2], x), of_to = orient3d(s[0], s[1], s[2], to);
                    if (of_x == of_to && of_x != Sign::zero) return;
                    bool positive = false, negative = false, zero = of_x == Sign::zero || of_to == Sign::zero;
                    for (std::size_t k = 0; k < 3; ++k) {
                      const Sign turn = orient3d(x, to, s[k], s[(k + 1) % 3]);
                      positive |= turn == Sign::positive;
                      negative |= turn == Sign::negative;
                      zero |= turn == Sign::zero;
                    }
                    if (positive && negative) return;
                    degenerate |= zero;
                    times[body_of_[i]] += (of_x == Sign::negative ? 1 : -1) * signs_[body_of_[i]];
                  });
  if (degenerate) return std::nullopt;
  std::erase_if(times, [](const auto& entry) { return entry.second == 0; });
  return times;
}

std::optional<std::map<std::uint32_t, int>> GivenBodies::windings(const Point<3>& x, std::uint32_t without) const {
  constexpr int most_rays = 32;
  std::uint64_t state = 0x9e3779b97f4a7c15u;
  for (int attempt = 0; attempt < most_rays; ++attempt) {
    Point<3> to = x;
    for (int i = 0; i < 3; ++i) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      const double part = static_cast<double>(state >> 11) * 0x1p-53;
      to[i] += span_ * ((state >> 63 & 1) != 0 ? -1 : 1) * (0.5 + part / 2);
    }
    if (auto found = cross(x, to, without)) return found;
  }
  return std::nullopt;
}

std::optional<std::map<std::uint32_t, int>> GivenBodies::windings(const Point<3>& x) const { return windings(x, none); }

}  // namespace pgdr::checking
