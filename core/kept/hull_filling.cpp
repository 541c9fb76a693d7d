// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "kept/hull_filling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kept/numbers.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "pgdr/refine_options.hpp"
#include "rule/insertion_rule.hpp"
#include "space/make_set.hpp"

namespace pgdr {
namespace {

bool is_edge_of_face(const Hull& hull, const std::array<VertexId, 2>& edge) {
  return std::any_of(hull.faces.begin(), hull.faces.end(), [&](const Hull::Face& f) {
    return std::all_of(edge.begin(), edge.end(), [&](VertexId v) { return std::find(f.begin(), f.end(), v) != f.end(); });
  });
}

}  // namespace

HullFilling::HullFilling(const Mesh<3>& mesh, const Domain<3>& domain)
    : mesh_(&mesh), domain_(&domain), quality_(bounds_, default_min_dihedral) {}

void HullFilling::take(const Hull& hull, std::span<const EntityId> facets) {
  vertices_.clear();
  for (const auto& face : hull.faces) vertices_.insert(vertices_.end(), face.begin(), face.end());
  for (const auto& edge : hull.edges) vertices_.insert(vertices_.end(), edge.begin(), edge.end());
  vertices_.insert(vertices_.end(), hull.inside.begin(), hull.inside.end());
  detail::make_set(vertices_);
  on_facet_.clear();
  on_segment_.clear();
  for (const EntityId facet : facets) {
    std::vector<std::uint8_t> on;
    for (const VertexId v : vertices_) on.push_back(lies_on<3>(*domain_, mesh_->vertex(v).home, {EntityKind::facet, facet}));
    if (std::count(on.begin(), on.end(), 1) >= 4) on_facet_.push_back(std::move(on));
  }
  std::vector<EntityId> segments;
  for (const VertexId v : vertices_)
    if (const Home home = mesh_->vertex(v).home; home.kind() == EntityKind::segment) segments.push_back(home.id());
  detail::make_set(segments);
  for (const EntityId s : segments) {
    std::vector<std::uint8_t> on;
    for (const VertexId v : vertices_) on.push_back(lies_on<3>(*domain_, mesh_->vertex(v).home, {EntityKind::segment, s}));
    if (std::count(on.begin(), on.end(), 1) >= 3) on_segment_.push_back(std::move(on));
  }
}

/// With all corners on a facet, or three on a segment.
bool HullFilling::is_flat(const Hull::Face& face, VertexId apex) const {
  const auto at = [&](VertexId v) {
    return static_cast<std::size_t>(std::lower_bound(vertices_.begin(), vertices_.end(), v) - vertices_.begin());
  };
  const auto count = [&](const std::vector<std::uint8_t>& on) {
    return on[at(apex)] + on[at(face[0])] + on[at(face[1])] + on[at(face[2])];
  };
  return std::any_of(on_facet_.begin(), on_facet_.end(), [&](const auto& on) { return count(on) == 4; }) ||
         std::any_of(on_segment_.begin(), on_segment_.end(), [&](const auto& on) { return count(on) >= 3; });
}

/// The least quality of the cells about one of its vertices; 0: they do not fill it.
double HullFilling::quality_about(const Hull& hull, VertexId apex) const {
  double least = 1;
  if (hull.inside.size() > 1 || (hull.inside.size() == 1 && hull.inside[0] != apex)) return 0;
  for (const auto& edge : hull.edges)
    if (apex != edge[0] && apex != edge[1] && !is_edge_of_face(hull, edge)) return 0;
  for (const auto& face : hull.faces) {
    if (std::find(face.begin(), face.end(), apex) != face.end()) continue;
    const auto p = mesh_->points(face);
    const Simplex<3> s{p[0], p[1], p[2], mesh_->point(apex)};
    if (orient<3>(s) != Sign::positive || is_flat(face, apex)) return 0;
    least = std::min(least, quality_.of(s, hull.region));
    if (least == 0) return 0;
  }
  return least;
}

/// The same about a new point.
double HullFilling::quality_about(const Hull& hull, const Point3& apex) const {
  double least = 1;
  for (const auto& face : hull.faces) {
    const auto p = mesh_->points(face);
    const Simplex<3> s{p[0], p[1], p[2], apex};
    if (orient<3>(s) != Sign::positive) return 0;
    least = std::min(least, quality_.of(s, hull.region));
    if (least == 0) return 0;
  }
  return least;
}

bool HullFilling::fill(const Hull& hull, std::span<const EntityId> facets, Cells& out) {
  if (hull.faces.empty()) return true;  // nothing is left of it
  take(hull, facets);
  double best = 0;
  VertexId apex = no_vertex;
  for (const VertexId v : vertices_) {
    const double q = quality_about(hull, v);
    if (q > best || (q == best && q > 0 && lex_less<3>(mesh_->point(v), mesh_->point(apex)))) {
      best = q;
      apex = v;
    }
  }
  if (best == 0) return search(hull, out);
  for (const auto& face : hull.faces)
    if (std::find(face.begin(), face.end(), apex) == face.end()) out.push_back({{face[0], face[1], face[2], apex}, hull.region});
  return true;
}

void HullFilling::build(const Hull& hull) {
  Polyhedron& p = polyhedron_;
  p.clear();
  p.region = hull.region;
  for (const VertexId v : vertices_) p.points.push_back(mesh_->point(v));
  const auto number = [&](VertexId v) {
    return static_cast<Polyhedron::Index>(std::lower_bound(vertices_.begin(), vertices_.end(), v) - vertices_.begin());
  };
  const Point3& origin = p.points[0];
  for (const auto& face : hull.faces) {
    p.faces.push_back({number(face[0]), number(face[1]), number(face[2])});
    const auto q = mesh_->points(face);
    const auto u = detail::difference<3>(q[1], q[0]), w = detail::difference<3>(q[2], q[0]);
    p.volume6 += detail::dot(u, detail::cross(w, detail::difference<3>(origin, q[0])));
  }
  for (const auto& edge : hull.edges) {
    const Polyhedron::Index a = number(edge[0]), b = number(edge[1]);
    p.edges.push_back({std::min(a, b), std::max(a, b)});
  }
  for (const VertexId v : hull.inside) p.kept.push_back(number(v));
  const auto set_of = [](const std::vector<std::uint8_t>& on) {
    std::uint32_t set = 0;
    for (std::size_t i = 0; i < on.size(); ++i) set |= on[i] ? 1u << i : 0u;
    return set;
  };
  for (const auto& on : on_facet_) p.flat_sets.push_back(set_of(on));
  for (const auto& on : on_segment_)  // three of these with any other
    for (std::size_t i = 0; i < on.size(); ++i)
      if (!on[i]) p.flat_sets.push_back(set_of(on) | 1u << i);
}

bool HullFilling::search(const Hull& hull, Cells& out) {
  if (vertices_.size() > PolyhedronFilling::most_points || hull.faces.size() < 4) return false;
  build(hull);
  if (!search_.find(polyhedron_, quality_, 0, std::numeric_limits<std::size_t>::max())) return false;
  for (const auto& cell : search_.cells())
    out.push_back({{vertices_[cell[0]], vertices_[cell[1]], vertices_[cell[2]], vertices_[cell[3]]}, hull.region});
  return true;
}

/// What has to be in the hull is, and x sees all faces from inside.
bool HullFilling::is_seen_from(const Hull& hull, const Point3& x, bool flat) const {
  const auto is_seen = [&](const Hull::Face& face) {
    const auto p = mesh_->points(face);
    return orient<3>({p[0], p[1], p[2], x}) == Sign::positive;
  };
  return hull.inside.empty() &&
         (flat ? std::all_of(hull.faces.begin(), hull.faces.end(), is_seen) : quality_about(hull, x) > 0) &&
         std::all_of(hull.edges.begin(), hull.edges.end(), [&](const auto& edge) { return is_edge_of_face(hull, edge); });
}

Point3 HullFilling::better_place(const Hull& hull, const Point3& x) {
  star_ = {};
  for (const auto& face : hull.faces) star_.cells.push_back({mesh_->points(face), hull.region});
  star_.vertex = x;
  const auto better = placement_.find(star_, quality_);
  return better && quality_about(hull, *better) > quality_about(hull, x) ? *better : x;
}

}  // namespace pgdr
