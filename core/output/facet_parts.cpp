// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "output/facet_parts.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "pgdr/predicates.hpp"
#include "space/disjoint_sets.hpp"
#include "space/make_set.hpp"

namespace pgdr::detail {
namespace {

/// An edge of a subfacet that is no wall between parts.
struct OpenEdge {
  EntityId facet;
  std::array<std::uint32_t, 2> edge;
  std::uint32_t subfacet;
  auto operator<=>(const OpenEdge&) const = default;
};

}  // namespace

FacetParts::FacetParts(const Domain<3>& domain) : domain_(domain), parts_(domain) { list_inputs(); }

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
      const std::uint32_t part = parts_.of(number++);
      pairs.emplace_back(part, origin.facet);
      if (origin.mixed) with_mixed.push_back(part);
    }
    make_set(with_mixed);
    for (const std::uint32_t part : with_mixed)
      for (const std::uint32_t input : mixed) pairs.emplace_back(part, input);
  }
  for (const auto& [triangle, input] : domain_.further_origins()) pairs.emplace_back(parts_.of(triangle), input);
  make_set(pairs);
  begin_.assign(parts_.triangles() + 1, 0);
  for (const auto& [part, input] : pairs) {
    ++begin_[part + 1];
    inputs_.push_back(input);
  }
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
}

std::vector<std::uint32_t> FacetParts::parts_of_subfacets(const OutputMesh<3>& mesh) const {
  EdgeNumbers subsegments;
  for (std::uint32_t i = 0; i < mesh.subsegments.size(); ++i)
    subsegments.add(mesh.subsegments[i].vertices[0], mesh.subsegments[i].vertices[1], i);
  subsegments.index();
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
        open.push_back({f, {std::min(a, b), std::max(a, b)}, i});
      } else if (side != Sign::zero) {
        const EntityId s = mesh.subsegments[subsegment].entity;
        const std::uint32_t part = parts_.at({f, s, runs_along(domain_, s, mesh.points[a], mesh.points[b])});
        if (part != no_entity) found.emplace_back(i, part);
      }
    }
  }
  DisjointSets sets(mesh.subfacets.size());
  std::sort(open.begin(), open.end());
  for (std::size_t i = 1; i < open.size(); ++i)
    if (open[i].facet == open[i - 1].facet && open[i].edge == open[i - 1].edge)
      sets.unite(open[i].subfacet, open[i - 1].subfacet);
  // Every part has segments about it.
  std::vector<std::uint32_t> part;
  for (const auto& subfacet : mesh.subfacets) part.push_back(parts_.of(domain_.facets()[subfacet.entity].first_triangle));
  for (const auto& [i, p] : found) part[sets.find(i)] = p;
  for (std::uint32_t i = 0; i < part.size(); ++i) part[i] = part[sets.find(i)];
  return part;
}

}  // namespace pgdr::detail
