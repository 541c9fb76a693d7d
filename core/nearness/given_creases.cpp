// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "nearness/given_creases.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "numbers/double_double.hpp"
#include "numbers/vectors.hpp"
#include "space/box.hpp"
#include "space/disjoint_sets.hpp"

namespace pgdr::checking {
namespace {

using detail::DoubleDouble;
using detail::DoubleDoubles;
using Corners = GivenSurface::Corners;

class Creases {
 public:
  Creases(const GivenSurface& surface, const SurfaceEdges& edges, double distance, double degrees)
      : surface_(surface), edges_(edges), distance_(distance), cosine_(std::cos(degrees / 180 * std::numbers::pi)) {}

  std::vector<CreaseEdge> run(const std::vector<std::uint32_t>& kept_points) {
    std::vector<CreaseEdge> found;
    edges_.each([&](std::span<const SurfaceEdges::AtEdge> uses) {
      if (is_crease(uses)) found.push_back(uses[0].ends);
    });
    return without_short_ones(found, kept_points);
  }

 private:
  const Point3& point(std::uint32_t v) const { return surface_.points()[v]; }

  bool is_crease(std::span<const SurfaceEdges::AtEdge> uses) const {
    if (uses.size() != 2 || !have_one_marker(uses[0].triangle, uses[1].triangle)) return false;
    const auto [a, b] = uses[0].ends;
    const Corners first{a, b, uses[0].apex}, second{b, a, uses[1].apex};  // as one surface runs through both
    if (!differ(first, second)) return false;
    for (const Corners& t : {first, second})
      if (!(height(t, 2) > distance_ / 4)) return false;
    const auto on_first = beside(first), on_second = beside(second);
    return on_first && on_second && differ(*on_first, *on_second);
  }

  bool have_one_marker(std::uint32_t t, std::uint32_t u) const {
    const auto of_t = surface_.markers(t), of_u = surface_.markers(u);
    return of_t.size() == 1 && of_u.size() == 1 && of_t[0] == of_u[0];
  }

  /// Of its corner k above the edge opposite.
  double height(const Corners& t, std::size_t k) const {
    const auto along = detail::difference(point(t[(k + 2) % 3]), point(t[(k + 1) % 3]));
    const auto n = detail::cross(along, detail::difference(point(t[k]), point(t[(k + 1) % 3])));
    const double length = detail::dot(along, along);
    return length > 0 ? std::sqrt(detail::dot(n, n) / length) : 0;
  }

  /// The corner opposite the longest edge.
  std::size_t least_corner(const Corners& t) const {
    std::size_t least = 0;
    double longest = -1;
    for (std::size_t k = 0; k < 3; ++k)
      if (const double length = squared_distance(point(t[(k + 1) % 3]), point(t[(k + 2) % 3])); length > longest) {
        longest = length;
        least = k;
      }
    return least;
  }

  /// The first that is no needle, from one that begins with the edge on, across longest edges.
  std::optional<Corners> beside(Corners t) const {
    constexpr int most_steps = 8;
    for (int step = 0; step <= most_steps; ++step) {
      const std::size_t k = least_corner(t);
      if (height(t, k) > distance_ / 4) return t;
      const std::uint32_t a = t[(k + 1) % 3], b = t[(k + 2) % 3];
      const auto uses = edges_.at(a, b);
      if (uses.size() != 2 || !have_one_marker(uses[0].triangle, uses[1].triangle)) return std::nullopt;
      const std::uint32_t beyond = uses[0].apex == t[k] ? uses[1].apex : uses[0].apex;
      t = {b, a, beyond};
    }
    return std::nullopt;
  }

  DoubleDoubles<3> normal(const Corners& t) const {
    const auto side = [&](std::uint32_t v) {
      const Point3 &p = point(v), &q = point(t[0]);
      return DoubleDoubles<3>{detail::difference(p[0], q[0]), detail::difference(p[1], q[1]), detail::difference(p[2], q[2])};
    };
    return detail::cross(side(t[1]), side(t[2]));
  }

  /// By more than the angle: n . m < c |n| |m|, squared.
  bool differ(const Corners& t, const Corners& u) const {
    const DoubleDoubles<3> n = normal(t), m = normal(u);
    const DoubleDouble along = detail::dot(n, m),
                       bound = DoubleDouble(cosine_) * DoubleDouble(cosine_) * detail::dot(n, n) * detail::dot(m, m);
    const DoubleDouble square = along * along, margin = bound * DoubleDouble(0x1p-90);
    if (cosine_ >= 0) return along.hi < 0 || (square - (bound - margin)).hi < 0;
    return along.hi < 0 && (square - (bound + margin)).hi > 0;
  }

  std::vector<CreaseEdge> without_short_ones(const std::vector<CreaseEdge>& all,
                                             const std::vector<std::uint32_t>& kept_points) const {
    std::map<std::uint32_t, std::uint32_t> number;  // of points
    for (const CreaseEdge& e : all)
      for (const std::uint32_t v : e) number.try_emplace(v, static_cast<std::uint32_t>(number.size()));
    detail::DisjointSets sets(number.size());
    for (const CreaseEdge& e : all) sets.unite(number.at(e[0]), number.at(e[1]));
    std::vector<detail::Box<3>> boxes(number.size(), detail::Box<3>::empty());
    std::vector<std::uint8_t> is_kept(number.size(), 0);
    for (const auto& [v, i] : number) {
      boxes[sets.find(i)].add(point(v));
      if (std::ranges::binary_search(kept_points, v)) is_kept[sets.find(i)] = 1;
    }
    std::vector<CreaseEdge> out;
    constexpr double least_length = 30;  // of the distance: shape below that is not meant
    for (const CreaseEdge& e : all) {
      const std::uint32_t set = sets.find(number.at(e[0]));
      if (is_kept[set] || boxes[set].longest_side() > least_length * distance_) out.push_back(e);
    }
    return out;
  }

  const GivenSurface& surface_;
  const SurfaceEdges& edges_;
  double distance_, cosine_;
};

}  // namespace

std::vector<CreaseEdge> given_creases(const GivenSurface& surface, const SurfaceEdges& edges,
                                      const std::vector<std::uint32_t>& kept_points, double distance, double degrees) {
  if (degrees >= 180) return {};
  return Creases(surface, edges, distance, degrees).run(kept_points);
}

}  // namespace pgdr::checking
