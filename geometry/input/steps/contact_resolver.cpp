// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "input/steps/contact_resolver.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "input/steps/triangle_splitter.hpp"
#include "space/box_tree.hpp"
#include "space/make_set.hpp"

namespace pgdr::detail {

template <int D>
std::vector<Piece> pieces_of(const BuildInput<D>& in, FacetTriangles& faces, std::span<const OwnedEdge> segment_edges) {
  std::vector<Piece> pieces;
  faces.index_facets();
  std::vector<bool> used(in.points.size(), false);
  std::vector<std::uint64_t> of_triangles, loose;
  for (std::uint32_t t = 0; t < faces.triangles.size(); ++t) {
    pieces.push_back({faces.triangles[t], 3, static_cast<std::uint8_t>(faces.facets[faces.facet_of[t]].axis)});
    for (const std::uint32_t v : faces.triangles[t]) used[v] = true;
  }
  for (const auto edges : {segment_edges, std::span<const OwnedEdge>(faces.polygon_edges)})
    for (const auto& [e, owner] : edges) {
      loose.push_back(edge_key(e[0], e[1]));
      used[e[0]] = used[e[1]] = true;
    }
  make_set(loose);
  if (!loose.empty()) {
    for (std::uint32_t t = 0; t < faces.triangles.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i) of_triangles.push_back(faces.key_of_edge(t, i));
    make_set(of_triangles);
  }
  for (const std::uint64_t key : loose)
    if (!std::binary_search(of_triangles.begin(), of_triangles.end(), key))
      pieces.push_back({{edge_of(key)[0], edge_of(key)[1], no_entity}, 2, 0});
  for (std::uint32_t v = 0; v < used.size(); ++v)
    if (!used[v]) pieces.push_back({{v, no_entity, no_entity}, 1, 0});
  return pieces;
}

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
  contacts_.clear();
  std::vector<std::array<std::uint32_t, 3>> corners;
  corners.reserve(pieces_.size());
  for (const Piece& piece : pieces_) corners.push_back(piece.corners);
  const BoxTree<D> tree(corners, in_.points);
  using Found = std::vector<FoundContact>;
  const auto& facet_of = faces_.facet_of;
  auto parts = tree.template self_pairs_in_parts<Found>(in_.bulk, [&](std::uint32_t i, std::uint32_t j, Found& found) {
    in_.stop();
    if (j < facet_of.size() && facet_of[i] == facet_of[j]) return;  // of one planar triangulation
    Contact c = contact<D>(in_.points, pieces_[i], pieces_[j]);
    if (c.kind != Contact::Kind::none) found.push_back({i, j, std::move(c)});
  });
  in_.stop();
  for (Found& part : parts) std::ranges::move(part, std::back_inserter(contacts_));
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

template std::vector<Piece> pieces_of(const BuildInput<2>&, FacetTriangles&, std::span<const OwnedEdge>);
template std::vector<Piece> pieces_of(const BuildInput<3>&, FacetTriangles&, std::span<const OwnedEdge>);
template class PointsOnEdges<2>;
template class PointsOnEdges<3>;
template class ContactResolver<2>;
template class ContactResolver<3>;

}  // namespace pgdr::detail
