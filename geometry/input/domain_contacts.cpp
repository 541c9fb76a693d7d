// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Fourth step of a Domain: points that lie exactly inside an edge split it, and with it the triangles that have it;
// points inside a triangle become its corners. Each triangle is triangulated anew by itself, in its own plane, so that
// no point of any facet moves, also where a facet is not planar. What meets is found as the diagnosis finds it; where
// nothing does, that is known from here on.
#include <algorithm>
#include <iterator>

#include "input/domain_builder.hpp"
#include "pgdr/predicates.hpp"
#include "space/box_tree.hpp"

namespace pgdr {
using detail::Contact;
using detail::edge_key;
using detail::edge_of;
using detail::make_set;
using detail::OwnedEdge;
using detail::PlanarEdge;
using detail::PointOn;
using detail::TriangulatedFacet;

template <int D>
void DomainBuilder<D>::resolve_contacts() {
  for (std::uint32_t s = 0; s < explicit_.size(); ++s) {
    if (explicit_[s][0] == explicit_[s][1]) continue;  // it was refused
    const auto points = near_chain(explicit_[s][0], explicit_[s][1]);
    for (std::size_t k = 1; k < points.size(); ++k) segment_edges_.push_back({{points[k - 1], points[k]}, s});
  }
  out_.nothing_meets_ = !find_contacts() && near_width_ == 0;
  if (out_.nothing_meets_) return report_points();
  split_at_points();
  if constexpr (D == 3) {
    if (find_contacts() || near_width_ > 0) constrain_inner_edges();
    if (near_width_ > 0) refuse_near_crossings();
    drop_repeated_facets();
  }
  report_points();
}

// Triangles, then edges that no triangle has, then points of neither.
template <int D>
void DomainBuilder<D>::collect_pieces() {
  pieces_.clear();
  facet_of_.clear();
  std::vector<bool> used(out_.points_.size(), false);
  std::vector<std::uint64_t> of_triangles, loose;
  for (std::uint32_t f = 0; f < facets_.size(); ++f) facet_of_.resize(facets_[f].first + facets_[f].count, f);
  for (std::uint32_t t = 0; t < facet_of_.size(); ++t) {
    pieces_.push_back({triangles_[t], 3, static_cast<std::uint8_t>(facets_[facet_of_[t]].axis)});
    for (const std::uint32_t v : triangles_[t]) used[v] = true;
  }
  for (const auto* edges : {&segment_edges_, &polygon_edges_})
    for (const auto& [e, owner] : *edges) {
      loose.push_back(edge_key(e[0], e[1]));
      used[e[0]] = used[e[1]] = true;
    }
  make_set(loose);
  if (!loose.empty()) {
    for (const detail::Piece& piece : pieces_) {
      const auto& [a, b, c] = piece.corners;
      of_triangles.insert(of_triangles.end(), {edge_key(a, b), edge_key(b, c), edge_key(c, a)});
    }
    make_set(of_triangles);
  }
  for (const std::uint64_t key : loose)
    if (!std::binary_search(of_triangles.begin(), of_triangles.end(), key))
      pieces_.push_back({{edge_of(key)[0], edge_of(key)[1], no_entity}, 2, 0});
  for (std::uint32_t v = 0; v < used.size(); ++v)
    if (!used[v]) pieces_.push_back({{v, no_entity, no_entity}, 1, 0});
}

template <int D>
bool DomainBuilder<D>::find_contacts() {
  collect_pieces();
  contacts_.clear();
  std::vector<std::array<std::uint32_t, 3>> corners;
  corners.reserve(pieces_.size());
  for (const detail::Piece& piece : pieces_) corners.push_back(piece.corners);
  const detail::BoxTree<D> tree(corners, out_.points_);
  using Found = std::vector<detail::FoundContact>;
  auto parts = tree.template self_pairs_in_parts<Found>(bulk_, [this](std::uint32_t i, std::uint32_t j, Found& found) {
    stop_check_();
    if (j < facet_of_.size() && facet_of_[i] == facet_of_[j]) return;  // of one planar triangulation
    Contact c = detail::contact<D>(out_.points_, pieces_[i], pieces_[j]);
    if (c.kind != Contact::Kind::none) found.push_back({i, j, std::move(c)});
  });
  stop_check_();
  for (Found& part : parts) std::ranges::move(part, std::back_inserter(contacts_));
  return !contacts_.empty();
}

template <int D>
void DomainBuilder<D>::split_at_points() {
  for (const auto& [first, second, what] : contacts_)
    for (const Contact::Corner& corner : what.corners) {
      if (corner.edge[0] != no_entity) on_edges_.emplace_back(edge_key(corner.edge[0], corner.edge[1]), corner.point);
      else in_triangles_.emplace_back(corner.of_second ? first : second, corner.point);
    }
  make_set(on_edges_);
  make_set(in_triangles_);
  if (on_edges_.empty() && in_triangles_.empty()) return;
  split_edges(segment_edges_);
  split_edges(polygon_edges_);
  if constexpr (D == 3) split_triangles();
}

template <int D>
std::span<const PointOn> DomainBuilder<D>::on_edge(std::uint64_t key) const {
  const auto begin = std::lower_bound(on_edges_.begin(), on_edges_.end(), PointOn{key, 0});
  auto end = begin;
  while (end != on_edges_.end() && end->first == key) ++end;
  return {begin, end};
}

/// a, the points inside the edge in their order, b.
template <int D>
std::vector<std::uint32_t> DomainBuilder<D>::chain(std::uint32_t a, std::uint32_t b) const {
  std::vector<std::uint32_t> out{a};
  for (const auto& [key, v] : on_edge(edge_key(a, b))) out.push_back(v);
  out.push_back(b);
  const auto& p = out_.points_;  // lexicographic order is that along a line
  std::sort(out.begin(), out.end(), [&](std::uint32_t v, std::uint32_t w) { return lex_less(p[v], p[w]); });
  if (out.front() != a) std::reverse(out.begin(), out.end());
  return out;
}

template <int D>
void DomainBuilder<D>::split_edges(std::vector<OwnedEdge>& edges) {
  std::vector<OwnedEdge> pieces;
  for (const auto& [e, owner] : edges) {
    const auto points = chain(e[0], e[1]);
    for (std::size_t k = 1; k < points.size(); ++k) pieces.push_back({{points[k - 1], points[k]}, owner});
    for (std::size_t k = 1; k + 1 < points.size(); ++k)
      split_edges_.push_back({points[k], std::min(e[0], e[1]), std::max(e[0], e[1])});
  }
  edges = std::move(pieces);
}

template <int D>
void DomainBuilder<D>::split_triangles() requires(D == 3) {
  const std::vector<Triangle> triangles = std::exchange(triangles_, {});
  const std::vector<std::uint8_t> masks = std::exchange(masks_, {});
  auto inside = in_triangles_.begin();
  for (TriangulatedFacet& facet : facets_) {
    const std::uint32_t begin = facet.first, end = begin + facet.count;
    facet.first = static_cast<std::uint32_t>(triangles_.size());
    for (std::uint32_t t = begin; t < end; ++t) {
      while (inside != in_triangles_.end() && inside->first < t) ++inside;
      auto last = inside;
      while (last != in_triangles_.end() && last->first == t) ++last;
      triangles_.push_back(triangles[t]);
      masks_.push_back(masks[t]);
      split_triangle(facet, {inside, last});
    }
    facet.count = static_cast<std::uint32_t>(triangles_.size()) - facet.first;
  }
}

// Replaces the last of the triangles, if there are points on it.
template <int D>
void DomainBuilder<D>::split_triangle(const TriangulatedFacet& facet, std::span<const PointOn> inside) requires(D == 3) {
  const Triangle t = triangles_.back();
  std::vector<std::uint32_t> vertices;
  std::vector<PlanarEdge> rim;
  std::vector<std::uint64_t> fixed;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t a = t[(i + 1) % 3], b = t[(i + 2) % 3];
    const bool is_edge = (masks_.back() & (1u << i)) != 0;  // else a diagonal, inside of the facet
    const auto points = chain(a, b);
    vertices.insert(vertices.end(), points.begin() + 1, points.end());
    for (std::size_t k = 1; k < points.size(); ++k) {
      rim.push_back({points[k - 1], points[k]});
      if (is_edge) fixed.push_back(edge_key(points[k - 1], points[k]));
      if (k + 1 == points.size()) break;
      if (is_edge) split_edges_.push_back({points[k], std::min(a, b), std::max(a, b)});
      else attached_.push_back({points[k], facet.input, 0});
    }
  }
  for (const auto& [triangle, v] : inside) {
    vertices.push_back(v);
    attached_.push_back({v, facet.input, 0});
  }
  if (vertices.size() == 3 || !planar_.build(out_.points_, vertices, rim, facet.axis)) return;
  triangles_.pop_back();
  masks_.pop_back();
  std::sort(fixed.begin(), fixed.end());
  for (const Triangle& s : planar_.triangles()) {
    triangles_.push_back(s);
    masks_.push_back(mask_of(s, fixed));
  }
}

template <int D>
std::uint8_t DomainBuilder<D>::mask_of(const Triangle& t, const std::vector<std::uint64_t>& fixed) {
  unsigned mask = 0;
  for (std::size_t i = 0; i < 3; ++i)
    if (std::binary_search(fixed.begin(), fixed.end(), edge_key(t[(i + 1) % 3], t[(i + 2) % 3]))) mask |= 1u << i;
  return static_cast<std::uint8_t>(mask);
}

template <int D>
void DomainBuilder<D>::report_points() {
  make_set(split_edges_);
  make_set(attached_);
  for (const auto& [v, a, b] : split_edges_)
    points_on_edges_.add(
        [&, v = v, a = a, b = b] {  // copies: Clang before 16 captures no structured binding
          return std::to_string(point_number(v)) + " on " + std::to_string(point_number(a)) + " - " +
                 std::to_string(point_number(b));
        },
        {point_number(v), point_number(a), point_number(b)});
  for (const auto& [v, f, unused] : attached_)
    points_in_facets_.add(
        [&, v = v, f = f] { return std::to_string(point_number(v)) + " in " + std::to_string(number(f)); },
        {point_number(v), number(f)});
}

template void DomainBuilder<2>::resolve_contacts();
template void DomainBuilder<3>::resolve_contacts();
template bool DomainBuilder<3>::find_contacts();
template std::uint8_t DomainBuilder<3>::mask_of(const Triangle&, const std::vector<std::uint64_t>&);

}  // namespace pgdr
