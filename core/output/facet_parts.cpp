// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "output/facet_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "pgdr/predicates.hpp"
#include "space/disjoint_sets.hpp"
#include "space/make_set.hpp"

namespace pgdr::detail {
namespace {

using Edge = std::array<std::uint32_t, 2>;

Edge edge_of(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

/// Which of some edges is which, by their ends.
class EdgeNumbers {
 public:
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t number) { edges_.emplace_back(edge_of(a, b), number); }
  void index() { std::sort(edges_.begin(), edges_.end()); }
  /// no_entity: it is none of them.
  std::uint32_t find(std::uint32_t a, std::uint32_t b) const {
    const Edge edge = edge_of(a, b);
    const auto at = std::ranges::lower_bound(edges_, edge, {}, [](const auto& e) { return e.first; });
    return at != edges_.end() && at->first == edge ? at->second : no_entity;
  }

 private:
  std::vector<std::pair<Edge, std::uint32_t>> edges_;
};

/// An edge of a triangle of a facet that is no wall between parts.
struct OpenEdge {
  EntityId facet;
  Edge edge;
  std::uint32_t triangle;
  auto operator<=>(const OpenEdge&) const = default;
};

/// Triangles of one facet that have an edge in common are in one part.
void unite(std::vector<OpenEdge>& open, DisjointSets& parts) {
  std::sort(open.begin(), open.end());
  for (std::size_t i = 1; i < open.size(); ++i)
    if (open[i].facet == open[i - 1].facet && open[i].edge == open[i - 1].edge)
      parts.unite(open[i].triangle, open[i - 1].triangle);
}

std::size_t triangles_of_all(const Domain<3>& domain) {
  return domain.facets().empty() ? 0 : domain.facets().back().first_triangle + domain.facets().back().triangle_count;
}

}  // namespace

FacetParts::FacetParts(const Domain<3>& domain) : domain_(domain), part_of_(triangles_of_all(domain)) {
  find_parts();
  list_inputs();
}

/// The triangles of a Domain are positive in the projections of their facets.
void FacetParts::find_parts() {
  EdgeNumbers segments;
  for (EntityId s = 0; s < domain_.segments().size(); ++s)
    segments.add(domain_.segments()[s].points[0], domain_.segments()[s].points[1], s);
  segments.index();
  std::vector<OpenEdge> open;
  for (EntityId f = 0; f < domain_.facets().size(); ++f) {
    std::uint32_t number = domain_.facets()[f].first_triangle;
    for (const auto& t : domain_.triangles(f)) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = t[i], b = t[(i + 1) % 3];
        const EntityId s = segments.find(a, b);
        if (s == no_entity)
          open.push_back({f, edge_of(a, b), number});
        else
          at_sides_.push_back({{f, s, domain_.segments()[s].points[0] == a}, number});
      }
      ++number;
    }
  }
  DisjointSets sets(part_of_.size());
  unite(open, sets);
  for (std::uint32_t t = 0; t < part_of_.size(); ++t) part_of_[t] = sets.find(t);
  for (PartAtSide& p : at_sides_) p.part = part_of_[p.part];
  std::sort(at_sides_.begin(), at_sides_.end());
}

/// Facets of the input whose triangles were made anew together: nobody knows any more which of them is whose.
std::vector<std::uint32_t> FacetParts::mixed_inputs(EntityId f) const {
  std::vector<std::uint32_t> inputs;
  for (const TriangleOrigin& origin : domain_.triangle_origins(f))
    if (origin.mixed) inputs.push_back(origin.facet);
  make_set(inputs);
  return inputs;
}

void FacetParts::list_inputs() {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;  // part, facet of the input
  for (EntityId f = 0; f < domain_.facets().size(); ++f) {
    const std::vector<std::uint32_t> mixed = mixed_inputs(f);
    std::vector<std::uint32_t> with_mixed;
    std::uint32_t number = domain_.facets()[f].first_triangle;
    for (const TriangleOrigin& origin : domain_.triangle_origins(f)) {
      const std::uint32_t part = part_of_[number++];
      pairs.emplace_back(part, origin.facet);
      if (origin.mixed) with_mixed.push_back(part);
    }
    make_set(with_mixed);
    for (const std::uint32_t part : with_mixed)
      for (const std::uint32_t input : mixed) pairs.emplace_back(part, input);
  }
  for (const auto& [triangle, input] : domain_.further_origins()) pairs.emplace_back(part_of_[triangle], input);
  make_set(pairs);
  begin_.assign(part_of_.size() + 1, 0);
  for (const auto& [part, input] : pairs) {
    ++begin_[part + 1];
    inputs_.push_back(input);
  }
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
}

/// A subsegment has the direction of its segment where its vertices have that order along the axis in which the segment is
/// longest.
std::vector<std::uint32_t> FacetParts::parts_of_subfacets(const OutputMesh<3>& mesh) const {
  EdgeNumbers subsegments;
  for (std::uint32_t i = 0; i < mesh.subsegments.size(); ++i)
    subsegments.add(mesh.subsegments[i].vertices[0], mesh.subsegments[i].vertices[1], i);
  subsegments.index();
  const auto runs_along = [&](EntityId s, std::uint32_t a, std::uint32_t b) {
    const auto& ends = domain_.segments()[s].points;
    const Point3 &p = domain_.points()[ends[0]], &q = domain_.points()[ends[1]];
    int axis = 0;
    for (int k = 1; k < 3; ++k)
      if (std::fabs(q[k] - p[k]) > std::fabs(q[axis] - p[axis])) axis = k;
    return (q[axis] > p[axis]) == (mesh.points[b][axis] > mesh.points[a][axis]);
  };

  DisjointSets sets(mesh.subfacets.size());
  std::vector<OpenEdge> open;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> found;  // subfacet, part
  for (std::uint32_t i = 0; i < mesh.subfacets.size(); ++i) {
    auto v = mesh.subfacets[i].vertices;
    const EntityId f = mesh.subfacets[i].entity;
    const Sign side = orient_projected(mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]], domain_.facets()[f].axis);
    if (side == Sign::negative) std::swap(v[0], v[1]);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = v[k], b = v[(k + 1) % 3], subsegment = subsegments.find(a, b);
      if (subsegment == no_entity) {
        open.push_back({f, edge_of(a, b), i});
      } else if (side != Sign::zero) {
        const EntityId s = mesh.subsegments[subsegment].entity;
        const Side here{f, s, runs_along(s, a, b)};
        const auto at = std::ranges::lower_bound(at_sides_, here, {}, &PartAtSide::side);
        if (at != at_sides_.end() && at->side == here) found.emplace_back(i, at->part);
      }
    }
  }
  unite(open, sets);
  // Every part has segments about it.
  std::vector<std::uint32_t> part;
  for (const auto& subfacet : mesh.subfacets) part.push_back(part_of_[domain_.facets()[subfacet.entity].first_triangle]);
  for (const auto& [i, p] : found) part[sets.find(i)] = p;
  for (std::uint32_t i = 0; i < part.size(); ++i) part[i] = part[sets.find(i)];
  return part;
}

}  // namespace pgdr::detail
