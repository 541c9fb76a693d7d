// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Continues the fourth step of a Domain (3D): an edge that runs exactly inside of a facet, between two of its points,
// becomes an edge of its triangulation. Where it crosses edges between triangles of one plane that are no segments, the
// triangles on its way (also of several input facets that will be one) are triangulated anew together. What it crosses
// otherwise is for the diagnosis to tell.
#include <algorithm>
#include <numeric>

#include "input/domain_builder.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr {
using detail::Contact;
using detail::edge_key;
using detail::edge_of;
using detail::EdgeUse;
using detail::make_set;
using detail::PlanarEdge;

namespace {

constexpr bool opposite(Sign a, Sign b) { return a != Sign::zero && a == -b; }

}  // namespace

template <int D>
void DomainBuilder<D>::constrain_inner_edges() requires(D == 3) {
  find_inner_edges();
  if (inner_edges_.empty()) return;
  collect_edges();
  parent_.resize(triangles_.size());
  std::iota(parent_.begin(), parent_.end(), 0u);
  for (const auto& [t, key] : inner_edges_) join_crossed(key, t);
  std::sort(blocked_.begin(), blocked_.end());
  std::erase_if(inner_edges_, [&](const auto& e) { return std::ranges::binary_search(blocked_, e.second); });

  std::vector<std::pair<std::uint32_t, std::uint32_t>> patches;  // (root, triangle)
  std::vector<std::pair<std::uint32_t, std::uint64_t>> edges;    // (root, edge)
  for (const auto& [t, key] : inner_edges_) {
    patches.emplace_back(root(t), t);
    edges.emplace_back(root(t), key);
  }
  make_set(patches);
  make_set(edges);
  made_ = triangles_;  // the uses of edges go on to speak of the old ones
  made_masks_ = masks_;
  auto edge = edges.begin();
  for (auto begin = patches.begin(), end = begin; begin != patches.end(); begin = end) {
    std::vector<std::uint32_t> patch;
    std::vector<std::uint64_t> inner;
    for (; end != patches.end() && end->first == begin->first; ++end) patch.push_back(end->second);
    for (; edge != edges.end() && edge->first == begin->first; ++edge) inner.push_back(edge->second);
    retriangulate(patch, inner);
  }
  make_set(given_up_);
  std::erase_if(polygon_edges_, [&](const auto& e) {
    return std::ranges::binary_search(given_up_, edge_key(e.edge[0], e.edge[1]));
  });
  triangles_ = std::move(made_);
  masks_ = std::move(made_masks_);
}

template <int D>
void DomainBuilder<D>::find_inner_edges() requires(D == 3) {
  const auto look = [&](std::uint32_t i, std::uint32_t t) {
    const detail::Piece& piece = pieces_[i];
    if (t >= facet_of_.size()) return;
    for (std::size_t k = 0; k < (piece.count == 3 ? 3u : piece.count - 1u); ++k) {
      const std::uint32_t a = piece.corners[k], b = piece.corners[(k + 1) % piece.count];
      if (runs_inside(a, b, t)) inner_edges_.emplace_back(t, edge_key(a, b));
    }
  };
  for (const auto& [first, second, what] : contacts_) {
    if (what.kind == Contact::Kind::overlap) continue;  // nothing repairs that
    look(first, second);
    look(second, first);
  }
  if (near_width_ > 0) find_near_inner_edges();
  make_set(inner_edges_);
}

// In the plane of the triangle (or near it), and no line through an edge of either has them on different sides.
template <int D>
bool DomainBuilder<D>::runs_inside(std::uint32_t a, std::uint32_t b, std::uint32_t t) const requires(D == 3) {
  const auto& p = out_.points_;
  const Triangle& s = triangles_[t];
  const int axis = facets_[facet_of_[t]].axis;
  const auto turn = [&](std::uint32_t u, std::uint32_t v, std::uint32_t w) {
    return u == v || v == w || w == u ? Sign::zero : orient_projected(p[u], p[v], p[w], axis);
  };
  for (const std::uint32_t v : {a, b})
    if (near_width_ == 0 && v != s[0] && v != s[1] && v != s[2] && orient3d(p[s[0]], p[s[1]], p[s[2]], p[v]) != Sign::zero) return false;
  bool left = false, right = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t u = s[i], v = s[(i + 1) % 3];
    if (turn(u, v, a) != Sign::positive && turn(u, v, b) != Sign::positive) return false;
    left |= turn(a, b, u) == Sign::positive;
    right |= turn(a, b, u) == Sign::negative;
  }
  return left && right && (near_width_ == 0 || runs_near(a, b, t));
}

/// The triangle on the other side of an edge that may be given up; none if it must stay.
template <int D>
std::uint32_t DomainBuilder<D>::other_side(std::uint64_t key, std::uint32_t t) const requires(D == 3) {
  const auto begin = std::ranges::lower_bound(uses_, key, {}, &EdgeUse::key);
  const std::span<const EdgeUse> uses(begin, uses_of(static_cast<std::size_t>(begin - uses_.begin())));
  const bool nearly = near_width_ > 0 && is_joint(uses) && opens(uses, facets_[uses[0].owner].axis) && is_nearly_flat(uses);
  if (!nearly && !is_soft(uses)) return no_entity;
  return uses[0].triangle ^ uses[1].triangle ^ t;
}

// The edge and the edges of triangle t that it crosses.
template <int D>
void DomainBuilder<D>::join_crossed(std::uint64_t key, std::uint32_t t) requires(D == 3) {
  const auto& p = out_.points_;
  const auto [a, b] = edge_of(key);
  const int axis = facets_[facet_of_[t]].axis;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t u = triangles_[t][i], v = triangles_[t][(i + 1) % 3];
    if (u == a || u == b || v == a || v == b) continue;
    if (!opposite(orient_projected(p[u], p[v], p[a], axis), orient_projected(p[u], p[v], p[b], axis)) ||
        !opposite(orient_projected(p[a], p[b], p[u], axis), orient_projected(p[a], p[b], p[v], axis)))
      continue;
    const std::uint32_t next = other_side(edge_key(u, v), t);
    const auto is_inner = [&](std::uint32_t s) {
      return s != no_entity && std::ranges::binary_search(inner_edges_, std::pair{s, key});
    };
    if (!is_inner(next)) {
      blocked_.push_back(key);
      continue;
    }
    const std::uint32_t r = root(t), s = root(next);
    parent_[std::max(r, s)] = std::min(r, s);
  }
}

/// The edges between the patch and the rest, and those inside of it that must stay; the patch is on their left.
template <int D>
std::vector<PlanarEdge> DomainBuilder<D>::rim_of(std::span<const std::uint32_t> patch, int axis) const
    requires(D == 3) {
  std::vector<PlanarEdge> rim;
  const auto& p = out_.points_;
  for (const std::uint32_t t : patch) {
    Triangle s = triangles_[t];
    if (orient_projected(p[s[0]], p[s[1]], p[s[2]], axis) == Sign::negative) std::swap(s[1], s[2]);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t u = s[i], v = s[(i + 1) % 3], next = other_side(edge_key(u, v), t);
      if (next == no_entity || !std::ranges::binary_search(patch, next)) rim.push_back({u, v});
    }
  }
  return rim;
}

// The new triangles take the places of the old ones: there are as many, of the same points.
template <int D>
void DomainBuilder<D>::retriangulate(std::span<const std::uint32_t> patch, std::span<const std::uint64_t> edges)
    requires(D == 3) {
  const int axis = facets_[facet_of_[patch[0]]].axis;
  std::vector<std::uint32_t> vertices;
  for (const std::uint32_t t : patch) vertices.insert(vertices.end(), triangles_[t].begin(), triangles_[t].end());
  make_set(vertices);
  std::vector<std::uint64_t> fixed;
  for (const std::uint32_t t : patch)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t u = triangles_[t][(i + 1) % 3], v = triangles_[t][(i + 2) % 3];
      if ((masks_[t] & (1u << i)) != 0) fixed.push_back(edge_key(u, v));
    }
  const auto rim = rim_of(patch, axis);
  std::vector<std::uint64_t> rim_keys;
  for (const auto& [u, v] : rim) rim_keys.push_back(edge_key(u, v));
  std::sort(rim_keys.begin(), rim_keys.end());
  std::erase_if(fixed, [&](std::uint64_t key) { return !std::ranges::binary_search(rim_keys, key); });
  if (!planar_.build(out_.points_, vertices, rim, axis)) return;
  planar_.keep_left_of(rim);
  std::vector<std::uint64_t> done;
  for (const std::uint64_t key : edges) {
    if (!planar_.constrain(edge_of(key)[0], edge_of(key)[1])) continue;
    fixed.push_back(key);
    done.push_back(key);
  }
  std::sort(fixed.begin(), fixed.end());
  if (planar_.triangles().size() != patch.size()) return;
  for (const std::uint32_t t : patch)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint64_t key = edge_key(triangles_[t][i], triangles_[t][(i + 1) % 3]);
      if (!std::ranges::binary_search(rim_keys, key)) given_up_.push_back(key);
    }
  replace(patch, fixed, done);
}

template <int D>
void DomainBuilder<D>::replace(std::span<const std::uint32_t> patch, const std::vector<std::uint64_t>& fixed,
                               const std::vector<std::uint64_t>& edges) requires(D == 3) {
  const std::uint32_t first = facet_of_[patch[0]];
  const bool mixed = std::ranges::any_of(patch, [&](std::uint32_t t) { return facet_of_[t] != first; });
  const auto triangles = planar_.triangles();
  for (std::size_t k = 0; k < patch.size(); ++k) {
    detail::TriangulatedFacet& facet = facets_[facet_of_[patch[k]]];
    facet.mixed |= mixed;
    facet.planar &= near_width_ == 0;
    Triangle& t = made_[patch[k]];
    t = triangles[k];
    const auto& p = out_.points_;
    if (orient_projected(p[t[0]], p[t[1]], p[t[2]], facet.axis) == Sign::negative) std::swap(t[1], t[2]);
    made_masks_[patch[k]] = mask_of(t, fixed);
  }
  for (const std::uint64_t key : edges) {
    const std::int64_t a = point_number(edge_of(key)[0]), b = point_number(edge_of(key)[1]);
    const std::int64_t f = number(facets_[first].input);
    edges_in_facets_.add(
        [&] { return std::to_string(a) + " - " + std::to_string(b) + " in " + std::to_string(f); }, {a, b, f});
  }
}

template void DomainBuilder<3>::constrain_inner_edges();

}  // namespace pgdr
