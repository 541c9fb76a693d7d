// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "input/steps/inner_edges.hpp"

#include <algorithm>
#include <string>

#include "pgdr/predicates.hpp"
#include "space/make_set.hpp"

namespace pgdr::detail {
namespace {

constexpr bool opposite(Sign a, Sign b) { return a != Sign::zero && a == -b; }

}  // namespace

void InnerEdges::constrain(const ContactResolver<3>& met) {
  find(met);
  if (inner_.empty()) return;
  const EdgeUses uses(faces_, segment_edges_, in_.bulk, in_.stop);
  DisjointSets sets(faces_.triangles.size());
  for (const auto& [t, key] : inner_) join_crossed(key, t, uses, sets);
  std::sort(blocked_.begin(), blocked_.end());
  std::erase_if(inner_, [&](const auto& e) { return std::ranges::binary_search(blocked_, e.second); });

  std::vector<std::pair<std::uint32_t, std::uint32_t>> patches;  // (its name, triangle)
  std::vector<std::pair<std::uint32_t, std::uint64_t>> edges;    // (its name, edge)
  for (const auto& [t, key] : inner_) {
    patches.emplace_back(sets.find(t), t);
    edges.emplace_back(sets.find(t), key);
  }
  make_set(patches);
  make_set(edges);
  made_ = faces_.triangles;  // the uses of edges go on to speak of the old ones
  made_masks_ = faces_.masks;
  auto edge = edges.begin();
  for (auto begin = patches.begin(), end = begin; begin != patches.end(); begin = end) {
    std::vector<std::uint32_t> patch;
    std::vector<std::uint64_t> inner;
    for (; end != patches.end() && end->first == begin->first; ++end) patch.push_back(end->second);
    for (; edge != edges.end() && edge->first == begin->first; ++edge) inner.push_back(edge->second);
    retriangulate(patch, inner, uses);
  }
  make_set(given_up_);
  std::erase_if(faces_.polygon_edges,
                [&](const auto& e) { return std::ranges::binary_search(given_up_, edge_key(e.edge[0], e.edge[1])); });
  faces_.triangles = std::move(made_);
  faces_.masks = std::move(made_masks_);
}

void InnerEdges::find(const ContactResolver<3>& met) {
  const auto look = [&](std::uint32_t i, std::uint32_t t) {
    const Piece& piece = met.pieces()[i];
    if (t >= faces_.facet_of.size()) return;
    for (std::size_t k = 0; k < (piece.count == 3 ? 3u : piece.count - 1u); ++k) {
      const std::uint32_t a = piece.corners[k], b = piece.corners[(k + 1) % piece.count];
      if (runs_inside(a, b, t)) inner_.emplace_back(t, edge_key(a, b));
    }
  };
  for (const auto& [first, second, what] : met.contacts()) {
    if (what.kind == Contact::Kind::overlap) continue;  // nothing repairs that
    look(first, second);
    look(second, first);
  }
  if (near_.width() > 0)  // edges that run along triangles although they meet nowhere
    near_.edges_and_triangles([this](std::uint32_t a, std::uint32_t b, std::uint32_t t) {
      if (runs_inside(a, b, t)) inner_.emplace_back(t, edge_key(a, b));
    });
  make_set(inner_);
}

// In the plane of the triangle (or near it), and no line through an edge of either has them on different sides.
bool InnerEdges::runs_inside(std::uint32_t a, std::uint32_t b, std::uint32_t t) const {
  const auto& p = in_.points;
  const PlanarTriangle& s = faces_.triangles[t];
  const int axis = faces_.facets[faces_.facet_of[t]].axis;
  const auto turn = [&](std::uint32_t u, std::uint32_t v, std::uint32_t w) {
    return u == v || v == w || w == u ? Sign::zero : orient_projected(p[u], p[v], p[w], axis);
  };
  const bool exactly = near_.width() == 0;
  for (const std::uint32_t v : {a, b})
    if (exactly && v != s[0] && v != s[1] && v != s[2] && orient3d(p[s[0]], p[s[1]], p[s[2]], p[v]) != Sign::zero) return false;
  bool left = false, right = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t u = s[i], v = s[(i + 1) % 3];
    if (turn(u, v, a) != Sign::positive && turn(u, v, b) != Sign::positive) return false;
    left |= turn(a, b, u) == Sign::positive;
    right |= turn(a, b, u) == Sign::negative;
  }
  return left && right && (exactly || near_.runs_near(a, b, s));
}

/// The triangle on the other side of an edge that may be given up; none if it must stay.
std::uint32_t InnerEdges::other_side(std::uint64_t key, std::uint32_t t, const EdgeUses& all) const {
  const auto uses = all.of(key);
  const bool nearly = near_.width() > 0 && joints_.is_joint(uses) && joints_.opens(uses, faces_.facets[uses[0].owner].axis) &&
                      near_.is_nearly_flat(joints_.corners(uses));
  if (!nearly && !joints_.is_soft(uses)) return no_entity;
  return uses[0].triangle ^ uses[1].triangle ^ t;
}

// The edge and the edges of triangle t that it crosses.
void InnerEdges::join_crossed(std::uint64_t key, std::uint32_t t, const EdgeUses& uses, DisjointSets& patches) {
  const auto& p = in_.points;
  const auto [a, b] = edge_of(key);
  const int axis = faces_.facets[faces_.facet_of[t]].axis;
  const PlanarTriangle& corners = faces_.triangles[t];
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t u = corners[i], v = corners[(i + 1) % 3];
    if (u == a || u == b || v == a || v == b) continue;
    if (!opposite(orient_projected(p[u], p[v], p[a], axis), orient_projected(p[u], p[v], p[b], axis)) ||
        !opposite(orient_projected(p[a], p[b], p[u], axis), orient_projected(p[a], p[b], p[v], axis)))
      continue;
    const std::uint32_t next = other_side(edge_key(u, v), t, uses);
    if (next != no_entity && std::ranges::binary_search(inner_, std::pair{next, key}))
      patches.unite(t, next);
    else
      blocked_.push_back(key);
  }
}

/// The edges between the patch and the rest, and those inside of it that must stay; the patch is on their left.
std::vector<PlanarEdge> InnerEdges::rim_of(std::span<const std::uint32_t> patch, int axis, const EdgeUses& uses) const {
  std::vector<PlanarEdge> rim;
  const auto& p = in_.points;
  for (const std::uint32_t t : patch) {
    PlanarTriangle s = faces_.triangles[t];
    if (orient_projected(p[s[0]], p[s[1]], p[s[2]], axis) == Sign::negative) std::swap(s[1], s[2]);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t u = s[i], v = s[(i + 1) % 3], next = other_side(edge_key(u, v), t, uses);
      if (next == no_entity || !std::ranges::binary_search(patch, next)) rim.push_back({u, v});
    }
  }
  return rim;
}

/// The constraints of the patch that are on its rim, by their keys; those of the rim are sorted.
std::vector<std::uint64_t> InnerEdges::constraints_on(std::span<const std::uint32_t> patch,
                                                      std::span<const std::uint64_t> rim) const {
  std::vector<std::uint64_t> fixed;
  for (const std::uint32_t t : patch)
    for (std::size_t i = 0; i < 3; ++i)
      if (const std::uint64_t key = faces_.key_of_edge(t, i); faces_.is_constraint(t, i) && std::ranges::binary_search(rim, key))
        fixed.push_back(key);
  return fixed;
}

// The new triangles take the places of the old ones: there are as many, of the same points.
void InnerEdges::retriangulate(std::span<const std::uint32_t> patch, std::span<const std::uint64_t> edges, const EdgeUses& uses) {
  const int axis = faces_.facets[faces_.facet_of[patch[0]]].axis;
  std::vector<std::uint32_t> vertices;
  for (const std::uint32_t t : patch) vertices.insert(vertices.end(), faces_.triangles[t].begin(), faces_.triangles[t].end());
  make_set(vertices);
  const auto rim = rim_of(patch, axis, uses);
  std::vector<std::uint64_t> rim_keys;
  for (const auto& [u, v] : rim) rim_keys.push_back(edge_key(u, v));
  std::sort(rim_keys.begin(), rim_keys.end());
  std::vector<std::uint64_t> fixed = constraints_on(patch, rim_keys);
  if (!planar_.build(in_.points, vertices, rim, axis)) return;
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
    for (std::size_t i = 0; i < 3; ++i)
      if (const std::uint64_t key = faces_.key_of_edge(t, i); !std::ranges::binary_search(rim_keys, key))
        given_up_.push_back(key);
  replace(patch, fixed, done);
}

/// Are all triangles of the patch, as they were, in the plane of this one?
bool InnerEdges::is_exactly_flat(std::span<const std::uint32_t> patch, const PlanarTriangle& plane) const {
  const auto& p = in_.points;
  return std::ranges::all_of(patch, [&](std::uint32_t t) {
    return std::ranges::all_of(faces_.triangles[t], [&](std::uint32_t v) {
      const auto& [a, b, c] = plane;
      return v == a || v == b || v == c || orient3d(p[a], p[b], p[c], p[v]) == Sign::zero;
    });
  });
}

void InnerEdges::replace(std::span<const std::uint32_t> patch, const std::vector<std::uint64_t>& fixed,
                         const std::vector<std::uint64_t>& edges) {
  const std::uint32_t first = faces_.facet_of[patch[0]];
  const bool mixed = std::ranges::any_of(patch, [&](std::uint32_t t) { return faces_.facet_of[t] != first; });
  const auto triangles = planar_.triangles();
  for (std::size_t k = 0; k < patch.size(); ++k) {
    TriangulatedFacet& facet = faces_.facets[faces_.facet_of[patch[k]]];
    facet.mixed |= mixed;
    facet.planar = facet.planar && is_exactly_flat(patch, faces_.of(facet)[0]);
    PlanarTriangle& t = made_[patch[k]];
    t = triangles[k];
    const auto& p = in_.points;
    if (orient_projected(p[t[0]], p[t[1]], p[t[2]], facet.axis) == Sign::negative) std::swap(t[1], t[2]);
    made_masks_[patch[k]] = mask_of(t, fixed);
  }
  for (const std::uint64_t key : edges) {
    const std::int64_t a = report_.point_number(edge_of(key)[0]), b = report_.point_number(edge_of(key)[1]);
    const std::int64_t f = report_.number(faces_.facets[first].input);
    report_.repairs.edges_in_facets.add(
        [&] { return std::to_string(a) + " - " + std::to_string(b) + " in " + std::to_string(f); }, {a, b, f});
  }
}

void InnerEdges::refuse_near_crossings() const {
  const auto& p = in_.points;
  const auto words = [this](std::uint32_t a, std::uint32_t b) { return report_.point_words(a) + " - " + report_.point_words(b); };
  near_.edges_and_triangles([&](std::uint32_t a, std::uint32_t b, std::uint32_t t) {
    if (!runs_inside(a, b, t)) return;
    const std::uint32_t f = faces_.facets[faces_.facet_of[t]].input;
    report_.attempt([&] {
      report_.fail(Errc::entities_intersect,
                   "the edge " + words(a, b) + " runs along facet " + std::to_string(report_.number(f)) +
                       ", as near to it as points are merged, and crosses what is in it",
                   in_.plc.source.facet_lines, f, {report_.point_number(a), report_.point_number(b), report_.number(f)},
                   {p[a].x, p[b].x});
    });
  });
  near_.passing_edges([&](const PlanarEdge& e, const PlanarEdge& f) {
    report_.attempt([&] {
      report_.fail(
          Errc::entities_intersect,
          "the edges " + words(e[0], e[1]) + " and " + words(f[0], f[1]) +
              " come as near to each other as points are merged, where neither has a point",
          {}, 0, {report_.point_number(e[0]), report_.point_number(e[1]), report_.point_number(f[0]), report_.point_number(f[1])},
          {p[e[0]].x, p[e[1]].x, p[f[0]].x, p[f[1]].x});
    });
  });
}

}  // namespace pgdr::detail
