// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "kept/vertex_parts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "input/bent_facets.hpp"
#include "mesh/pinched_edges.hpp"
#include "numbers/corners.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr {
namespace {

/// The normal of the facet, of length one, on the side on which the direction into the cell of this subfacet is.
detail::Vector<3> unit_normal(const std::array<Point3, 3>& inwards) {
  auto n = detail::cross(detail::difference<3>(inwards[1], inwards[0]), detail::difference<3>(inwards[2], inwards[0]));
  const double length = std::sqrt(detail::dot(n, n));
  for (double& x : n) x /= length;
  return n;
}

}  // namespace

bool VertexParts::take(VertexId v, CellId c) {
  vertex_ = v;
  ends_ = {no_vertex, no_vertex};
  triangles_.clear();
  fan_of_triangle_.clear();
  hulls_.clear();
  joined_.reset();
  collect_cells(c);
  divide();
  if (!collect_leaves() || !find_fans()) return false;
  build_hulls();
  return true;
}

/// All, across walls; and those of all fans of cells at a pinched edge, to which no walk leads.
void VertexParts::collect_cells(CellId c) {
  cells_.clear();
  take_cell(c);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    add_pinched(cells_[i]);
    const auto& k = mesh_->cell(cells_[i]);
    for (int f = 0; f < 4; ++f)
      if (k.vertices[f] != vertex_ && k.links[f]) take_cell(k.links[f].cell());
  }
  for (const CellId x : cells_) mesh_->unmark(x);
  std::sort(cells_.begin(), cells_.end());
}

void VertexParts::take_cell(CellId c) {
  if (mesh_->marked(c)) return;
  mesh_->mark(c);
  cells_.push_back(c);
}

void VertexParts::add_pinched(CellId c) {
  const PinchedEdges* pinched = mesh_->pinched_edges();
  const Home home = mesh_->vertex(vertex_).home;
  if (!pinched || home.kind() != EntityKind::segment || !pinched->has(home.id())) return;
  const auto* k = mesh_->constraints(c);
  const auto& v = mesh_->cell(c).vertices;
  const int at = corner_of(v, vertex_);
  for (int i = 0; k && i < 4; ++i)
    if (i != at && k->has_edge(edge_of_ends[at][i]))
      for (const CellId x : pinched->cells(vertex_, v[i])) take_cell(x);
}

/// Numbers the sectors in the order of their first cells.
void VertexParts::divide() {
  constexpr std::uint32_t none = 0xffffffff;
  sector_.assign(cells_.size(), none);
  sectors_ = 0;
  std::vector<std::size_t> queue;
  for (std::size_t first = 0; first < cells_.size(); ++first) {
    if (sector_[first] != none) continue;
    queue.assign(1, first);
    sector_[first] = sectors_;
    for (std::size_t q = 0; q < queue.size(); ++q) {
      const CellId c = cells_[queue[q]];
      const auto& k = mesh_->cell(c);
      for (int f = 0; f < 4; ++f) {
        if (k.vertices[f] == vertex_ || !k.links[f] || mesh_->constrained(c, f)) continue;
        const auto at = std::lower_bound(cells_.begin(), cells_.end(), k.links[f].cell()) - cells_.begin();
        if (sector_[static_cast<std::size_t>(at)] != none) continue;
        sector_[static_cast<std::size_t>(at)] = sectors_;
        queue.push_back(static_cast<std::size_t>(at));
      }
    }
    ++sectors_;
  }
}

/// The subfacets and subsegments at the vertex. False if they are not those of one segment, or of one facet.
bool VertexParts::collect_leaves() {
  leaves_.clear();
  std::vector<std::pair<VertexId, EntityId>> subsegments;
  for (const CellId c : cells_) {
    const auto* k = mesh_->constraints(c);
    if (!k) continue;
    const auto& v = mesh_->cell(c).vertices;
    const int at = corner_of(v, vertex_);
    for (int f = 0; f < 4; ++f) {
      if (f == at || !k->has_face(f)) continue;
      const auto [i, j] = corners_without(f, at);
      const EntityId facet = k->face_entity[f];
      const Sign side = orient_projected(mesh_->point(vertex_), mesh_->point(v[i]), mesh_->point(v[j]),
                                         domain_->facets()[facet].axis);
      if (side == Sign::zero) return false;
      leaves_.push_back(side == Sign::positive ? Leaf{v[i], v[j], facet, 0} : Leaf{v[j], v[i], facet, 0});
    }
    for (int i = 0; i < 4; ++i)
      if (i != at && k->has_edge(edge_of_ends[at][i])) subsegments.emplace_back(v[i], k->edge_entity[edge_of_ends[at][i]]);
  }
  const auto order = [](const Leaf& a, const Leaf& b) {
    return std::tuple(a.from, a.to, a.facet) < std::tuple(b.from, b.to, b.facet);
  };
  const auto same = [](const Leaf& a, const Leaf& b) { return a.from == b.from && a.to == b.to && a.facet == b.facet; };
  std::sort(leaves_.begin(), leaves_.end(), order);
  leaves_.erase(std::unique(leaves_.begin(), leaves_.end(), same), leaves_.end());
  std::sort(subsegments.begin(), subsegments.end());
  subsegments.erase(std::unique(subsegments.begin(), subsegments.end()), subsegments.end());
  if (mesh_->vertex(vertex_).home.kind() != EntityKind::segment) return subsegments.empty();
  if (subsegments.size() != 2 || subsegments[0].second != subsegments[1].second) return false;
  ends_ = {subsegments[0].first, subsegments[1].first};
  joined_ = ends_;
  return true;
}

/// Follows the leaves from one end, or from any, until there is none further on.
bool VertexParts::find_fans() {
  constexpr std::uint32_t none = 0xffffffff;
  for (Leaf& l : leaves_) l.fan = none;
  fans_ = 0;
  std::vector<Leaf> fan;
  const auto follow = [&](Leaf& first) {
    fan.clear();
    for (Leaf* at = &first; at;) {
      at->fan = fans_;
      fan.push_back(*at);
      Leaf* next = nullptr;
      if (!is_end(at->to))
        for (Leaf& l : leaves_)
          if (l.from == at->to && l.facet == at->facet && l.fan == none) next = &l;
      at = next;
    }
    return triangulate(fans_++, fan);
  };
  for (const bool at_ends : {true, false})
    for (Leaf& l : leaves_)
      if (l.fan == none && (!at_ends || is_end(l.from)) && !follow(l)) return false;
  return true;
}

/// A face opposite the vertex with all corners on the polygon belongs to a cell that is flat but for rounding: with the edges of
/// such, so that these cells go, too.
std::vector<detail::PlanarEdge> VertexParts::with_flat_faces(std::span<const VertexId> polygon,
                                                             std::vector<detail::PlanarEdge> edges) const {
  for (const CellId c : cells_) {
    const auto& v = mesh_->cell(c).vertices;
    const Hull::Face face = face_without(v, corner_of(v, vertex_));
    std::array<std::uint32_t, 3> at{};
    bool is_flat = true;
    for (std::size_t i = 0; i < 3 && is_flat; ++i) {
      at[i] = static_cast<std::uint32_t>(std::find(polygon.begin(), polygon.end(), face[i]) - polygon.begin());
      is_flat = at[i] < polygon.size();
    }
    for (std::size_t i = 0; i < 3 && is_flat; ++i) edges.push_back({at[i], at[(i + 1) % 3]});
  }
  return edges;
}

/// The polygon of the fan, without the vertex. False if it is not one, seen along the axis.
bool VertexParts::triangulate(std::uint32_t fan, std::span<const Leaf> leaves) {
  const EntityId facet = leaves[0].facet;
  std::vector<VertexId> polygon;
  for (const Leaf& l : leaves) polygon.push_back(l.from);
  const VertexId last = leaves.back().to;
  if (last != polygon[0]) {  // from end to end
    if (!is_end(last) || !is_end(polygon[0])) return false;
    polygon.push_back(last);
  } else if (is_end(last)) {
    return false;
  }
  const auto n = static_cast<std::uint32_t>(polygon.size());
  if (n < 3) return false;
  const detail::LevelledFacet levelled(*domain_, facet);
  std::vector<Point3> points;
  std::vector<std::uint32_t> all(n);
  std::vector<detail::PlanarEdge> rim;
  std::iota(all.begin(), all.end(), 0u);
  for (std::uint32_t i = 0; i < n; ++i) {
    points.push_back(levelled(mesh_->point(polygon[i])));
    rim.push_back({i, (i + 1) % n});
  }
  const int axis = domain_->facets()[facet].axis;
  detail::PlanarTriangulation plane;
  if (!plane.build(points, all, with_flat_faces(polygon, rim), axis) && !plane.build(points, all, rim, axis)) return false;
  plane.keep_left_of(rim);
  const auto made = plane.triangles();
  if (made.size() != n - 2) return false;
  for (const detail::PlanarTriangle& t : made) {
    triangles_.push_back({{polygon[t[0]], polygon[t[1]], polygon[t[2]]}, facet});
    fan_of_triangle_.push_back(fan);
  }
  return true;
}

/// A face that is there already, turned over, goes with that: between the two there was a cell that was flat but for rounding.
void VertexParts::add_face(Hull& hull, const Hull::Face& face) const {
  const auto sorted = [](Hull::Face f) {
    std::sort(f.begin(), f.end());
    return f;
  };
  for (std::size_t i = 0; i < hull.faces.size(); ++i)
    if (hull.beyond[i] && sorted(hull.faces[i]) == sorted(face)) {
      hull.faces.erase(hull.faces.begin() + static_cast<std::ptrdiff_t>(i));
      hull.beyond.erase(hull.beyond.begin() + static_cast<std::ptrdiff_t>(i));
      return;
    }
  hull.faces.push_back(face);
  hull.beyond.push_back(Link{});
}

/// The faces opposite the vertex; and of each fan on each of its sides that a sector is on, its triangles.
void VertexParts::build_hulls() {
  hulls_.resize(sectors_);
  std::vector<std::array<std::uint32_t, 3>> sides;  // sector, fan, turned
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const CellId c = cells_[i];
    Hull& hull = hulls_[sector_[i]];
    const auto& v = mesh_->cell(c).vertices;
    const int at = corner_of(v, vertex_);
    hull.faces.push_back(face_inwards(v, at));
    hull.beyond.push_back(mesh_->constrained(c, at) ? Link{} : mesh_->cell(c).links[at]);
    hull.region = mesh_->region(c);
    const auto* k = mesh_->constraints(c);
    for (int f = 0; k && f < 4; ++f) {
      if (f == at || !k->has_face(f)) continue;
      const auto face = face_inwards(v, f);
      const auto p = mesh_->points(face);
      const bool turned = orient_projected(p[0], p[1], p[2], domain_->facets()[k->face_entity[f]].axis) == Sign::negative;
      const auto others = corners_without(f, at);
      const VertexId from = v[others[0]], to = v[others[1]];
      const auto leaf = std::find_if(leaves_.begin(), leaves_.end(), [&](const Leaf& l) {
        return l.facet == k->face_entity[f] && ((l.from == from && l.to == to) || (l.from == to && l.to == from));
      });
      const std::array<std::uint32_t, 3> side{sector_[i], leaf->fan, turned};
      if (std::find(sides.begin(), sides.end(), side) != sides.end()) continue;
      sides.push_back(side);
      const auto n = unit_normal(p);
      for (int d = 0; d < 3; ++d) hull.inwards[static_cast<std::size_t>(d)] += n[static_cast<std::size_t>(d)];
    }
  }
  for (const auto& [sector, fan, turned] : sides)  // on both sides of one fan no direction is inwards
    if (std::find(sides.begin(), sides.end(), std::array<std::uint32_t, 3>{sector, fan, 1 - turned}) != sides.end())
      hulls_[sector].inwards = {};
  for (const auto& [sector, fan, turned] : sides)
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (fan_of_triangle_[t] != fan) continue;
      auto face = triangles_[t].corners;
      if (turned) std::swap(face[1], face[2]);
      add_face(hulls_[sector], face);
    }
  if (joined_ && leaves_.empty()) hulls_[0].edges.push_back(*joined_);
}

}  // namespace pgdr
