// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "build/contact_resolver.hpp"

#include <algorithm>
#include <cmath>

#include "build/triangle_splitter.hpp"
#include "join/build_pieces.hpp"
#include "space/make_set.hpp"
#include "space/piece_pairs.hpp"

namespace pgdr::detail {

template <int D>
std::vector<std::uint32_t> PointsOnEdges<D>::chain(std::uint32_t a, std::uint32_t b) const {
  std::vector<std::uint32_t> out{a};
  const std::uint64_t edge = edge_key(a, b);
  for (auto at = std::lower_bound(found_.begin(), found_.end(), PointOn{edge, 0}); at != found_.end() && at->first == edge; ++at)
    out.push_back(at->second);
  out.push_back(b);
  // In the order along the coordinate in which the ends are farthest apart: the others tell nothing where points are rounded.
  const Point<D>&p = points_[a], &q = points_[b];
  int axis = 0;
  for (int i = 1; i < D; ++i)
    if (std::fabs(q[i] - p[i]) > std::fabs(q[axis] - p[axis])) axis = i;
  std::sort(out.begin(), out.end(), [&](std::uint32_t v, std::uint32_t w) { return points_[v][axis] < points_[w][axis]; });
  if (out.front() != a) std::reverse(out.begin(), out.end());
  return out;
}

template <int D>
void PointsOnEdges<D>::split(std::vector<OwnedEdge>& edges, BuildReport<D>& report) const {
  std::vector<OwnedEdge> pieces;
  for (const auto& [e, owner] : edges) {
    const auto points = chain(e[0], e[1]);
    for (std::size_t k = 1; k < points.size(); ++k) pieces.push_back({{points[k - 1], points[k]}, owner});
    for (std::size_t k = 1; k + 1 < points.size(); ++k) report.note_on_edge(points[k], e[0], e[1]);
  }
  edges = std::move(pieces);
}

template <int D>
bool ContactResolver<D>::find() {
  pieces_ = pieces_of(in_, faces_, segment_edges_);
  const auto& facet_of = faces_.facet_of;
  using Found = std::vector<FoundContact>;
  contacts_ = joined(
      look_at_pairs<Found, D>(pieces_, in_.points, 0, in_.bulk, in_.stop, [&](std::uint32_t i, std::uint32_t j, Found& found) {
        if (j < facet_of.size() && facet_of[i] == facet_of[j]) return;  // of one planar triangulation
        Contact c = contact<D>(in_.points, pieces_[i], pieces_[j]);
        if (c.kind != Contact::Kind::none) found.push_back({i, j, std::move(c)});
      }));
  return !contacts_.empty();
}

template <int D>
void ContactResolver<D>::split_at_points() {
  std::vector<PointOn> on_edges, in_triangles;
  for (const auto& [first, second, what] : contacts_)
    for (const Contact::Corner& corner : what.corners) {
      if (corner.edge[0] != no_entity)
        on_edges.emplace_back(edge_key(corner.edge[0], corner.edge[1]), corner.point);
      else
        in_triangles.emplace_back(corner.of_second ? first : second, corner.point);
    }
  make_set(on_edges);
  make_set(in_triangles);
  if (on_edges.empty() && in_triangles.empty()) return;
  const PointsOnEdges<D> points(in_.points, std::move(on_edges));
  points.split(segment_edges_, report_);
  points.split(faces_.polygon_edges, report_);
  if constexpr (D == 3) split_triangles(in_, points, in_triangles, faces_, report_);
}

template class PointsOnEdges<2>;
template class PointsOnEdges<3>;
template class ContactResolver<2>;
template class ContactResolver<3>;

}  // namespace pgdr::detail
