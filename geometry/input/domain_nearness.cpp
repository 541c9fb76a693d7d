// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A quick look at whether it is worth while to join what is near (steps/near_search.hpp): one tree over the pieces of an input,
// and its points looked up in that.
#include <array>
#include <vector>

#include "input/entity_distance.hpp"
#include "numbers/unit_scale.hpp"
#include "pgdr/domain.hpp"
#include "space/box_tree.hpp"

namespace pgdr {
namespace {

using Corners = std::array<std::uint32_t, 3>;  // no_entity: as many as there are

/// Triangles, then segments of no triangle, then points of neither.
std::vector<Corners> pieces_of(const Domain<3>& domain) {
  std::vector<Corners> pieces;
  std::vector<bool> used(domain.points().size());
  for (EntityId f = 0; f < domain.facets().size(); ++f)
    for (const auto& t : domain.triangles(f)) pieces.push_back(t);
  for (EntityId s = 0; s < domain.segments().size(); ++s)
    if (domain.facets_of_segment(s).empty())
      pieces.push_back({domain.segments()[s].points[0], domain.segments()[s].points[1], no_entity});
  for (const Corners& piece : pieces)
    for (const std::uint32_t v : piece)
      if (v != no_entity) used[v] = true;
  for (std::uint32_t v = 0; v < used.size(); ++v)
    if (!used[v]) pieces.push_back({v, no_entity, no_entity});
  return pieces;
}

}  // namespace

bool may_join(const Domain<3>& domain, double within) {
  const std::vector<Point3> points = detail::in_unit_scale(domain.points());
  const double width = 2 * within * detail::largest_coordinate(points);  // twice, for the rounding here
  for (const DomainSegment& s : domain.segments())
    if (squared_distance(points[s.points[0]], points[s.points[1]]) <= width * width) return true;

  const std::vector<Corners> pieces = pieces_of(domain);
  std::vector<detail::Box<3>> boxes;
  boxes.reserve(pieces.size());
  for (const Corners& piece : pieces) {
    auto box = detail::Box<3>::around(points[piece[0]]);
    for (const std::uint32_t v : piece)
      if (v != no_entity) box.add(points[v]);
    boxes.push_back(box.widened(width));
  }
  const detail::BoxTree<3> tree(boxes);
  bool found = false;
  for (std::uint32_t v = 0; v < points.size() && !found; ++v)
    tree.at(points[v], [&](std::uint32_t i) {
      const auto& [a, b, c] = pieces[i];
      if (found || v == a || v == b || v == c) return;
      const Point3& p = points[v];
      const double square = c != no_entity   ? detail::squared_distance_to_triangle(points[a], points[b], points[c], p)
                            : b != no_entity ? detail::squared_distance_to_edge<3>(points[a], points[b], p)
                                             : squared_distance(points[a], p);
      found = square <= width * width;
    });
  return found;
}

}  // namespace pgdr
