// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "optimize/polyhedron_growth.hpp"

#include <algorithm>

#include "change/facet_flip.hpp"
#include "numbers/corners.hpp"
#include "numbers/vectors.hpp"
#include "optimize/numbers.hpp"
#include "rule/insertion_rule.hpp"

namespace pgdr {
namespace {

/// Sizes, in cells, at which a filling is looked for: each some one and a half times the one before.
constexpr std::array<std::size_t, 5> sizes{4, 7, 11, 16, numbers::most_filling_cells};

}  // namespace

void PolyhedronGrowth::take(CellId c) {
  s_->mesh->mark(c);
  cells_.push_back(c);
  for (const VertexId v : s_->mesh->cell(c).vertices)
    if (std::find(vertices_.begin(), vertices_.end(), v) == vertices_.end()) vertices_.push_back(v);
}

/// Takes the cells across faces of the polyhedron that have one vertex: that which most faces see; of these the one with the
/// worst cell. False if there is none, or if that would be too many.
bool PolyhedronGrowth::grow() {
  struct Beyond {
    VertexId vertex;
    CellId cell;
    double quality;
  };
  Mesh<3>& mesh = *s_->mesh;
  std::vector<Beyond> beyond;
  for (const CellId c : cells_)
    for (int f = 0; f < 4; ++f) {
      const Link link = mesh.cell(c).links[f];
      if (!link || mesh.constrained(c, f) || mesh.marked(link.cell())) continue;
      if (!s_->owns(link.cell())) {
        s_->note(Reach::not_owned);
        continue;
      }
      beyond.push_back({mesh.cell(link.cell()).vertices[link.face()], link.cell(), s_->judge.of(link.cell())});
    }
  const Beyond* best = nullptr;
  std::size_t most_faces = 0;
  double worst = 1;
  for (const Beyond& b : beyond) {
    const bool known = std::find(vertices_.begin(), vertices_.end(), b.vertex) != vertices_.end();
    if (!known && vertices_.size() >= PolyhedronFilling::most_points) continue;
    std::size_t faces = 0;
    double least = 1;
    for (const Beyond& other : beyond)
      if (other.vertex == b.vertex) {
        ++faces;
        least = std::min(least, other.quality);
      }
    const auto is_before = [&] { return lex_less<3>(mesh.point(b.vertex), mesh.point(best->vertex)); };
    if (best && (faces != most_faces ? faces < most_faces : least != worst ? least > worst : !is_before())) continue;
    best = &b;
    most_faces = faces;
    worst = least;
  }
  if (!best || cells_.size() + most_faces > PolyhedronFilling::most_cells) return false;
  for (const Beyond& b : beyond)
    if (b.vertex == best->vertex && !mesh.marked(b.cell)) take(b.cell);
  return true;
}

/// The sets of vertices that lie on one facet.
void PolyhedronGrowth::add_flat_sets() {
  const Mesh<3>& mesh = *s_->mesh;
  std::vector<EntityId> facets = facets_at(mesh, cells_);
  for (const VertexId v : vertices_) {
    const Home home = mesh.vertex(v).home;
    if (home.kind() == EntityKind::facet && std::find(facets.begin(), facets.end(), home.id()) == facets.end())
      facets.push_back(home.id());
  }
  for (const EntityId facet : facets) {
    std::uint32_t set = 0;
    int count = 0;
    for (std::size_t i = 0; i < vertices_.size(); ++i)
      if (lies_on<3>(*s_->domain, mesh.vertex(vertices_[i]).home, {EntityKind::facet, facet})) {
        set |= 1u << i;
        ++count;
      }
    if (count >= 4) polyhedron_.flat_sets.push_back(set);
  }
}

void PolyhedronGrowth::build() {
  using Index = Polyhedron::Index;
  const Mesh<3>& mesh = *s_->mesh;
  Polyhedron& p = polyhedron_;
  const auto number = [this](VertexId v) {
    return static_cast<Index>(std::find(vertices_.begin(), vertices_.end(), v) - vertices_.begin());
  };
  p.points.clear();
  p.faces.clear();
  p.edges.clear();
  p.kept.clear();
  p.flat_sets.clear();
  p.region = mesh.region(cells_.front());
  p.volume6 = 0;
  for (const VertexId v : vertices_) {
    if (!s_->w->in_volume(v)) p.kept.push_back(static_cast<Index>(p.points.size()));
    p.points.push_back(mesh.point(v));
  }
  for (const CellId c : cells_) {
    const auto& v = mesh.cell(c).vertices;
    const Simplex<3> s = mesh.simplex(c);
    p.volume6 += detail::dot(detail::difference<3>(s[1], s[0]),
                             detail::cross(detail::difference<3>(s[2], s[0]), detail::difference<3>(s[3], s[0])));
    const auto* k = mesh.constraints(c);
    for (int f = 0; f < 4; ++f) {
      const Link link = mesh.cell(c).links[f];
      if (link && !mesh.constrained(c, f) && mesh.marked(link.cell())) continue;
      Polyhedron::Face face;
      for (int i = 0; i < 3; ++i) face[i] = number(v[face_corners<3>[f][i]]);
      p.faces.push_back(face);
    }
    for (int e = 0; k && e < 6; ++e) {
      if (!k->has_edge(e)) continue;
      std::array<Index, 2> ends{number(v[edge_ends[e][0]]), number(v[edge_ends[e][1]])};
      if (ends[0] > ends[1]) std::swap(ends[0], ends[1]);
      if (std::find(p.edges.begin(), p.edges.end(), ends) == p.edges.end()) p.edges.push_back(ends);
    }
  }
  if (p.kept.size() >= 4) add_flat_sets();
}

bool PolyhedronGrowth::fill(Judge::Rule rule) {
  build();
  const Judge::Standing before = s_->judge.standing_of(cells_);
  const std::size_t most_poor = rule == Judge::Rule::no_more_poor ? static_cast<std::size_t>(before.weight)
                                                                  : PolyhedronFilling::most_cells * 2;
  if (!search_.find(polyhedron_, s_->judge.quality(), Judge::too_bad(before), most_poor)) return false;
  tried_.clear();
  tried_.old = cells_;
  for (const auto& cell : search_.cells()) {
    Replacement<3>::Cell made{{}, static_cast<std::uint16_t>(polyhedron_.region)};
    for (int i = 0; i < 4; ++i) made.vertices[i] = vertices_[cell[i]];
    tried_.cells.push_back(made);
  }
  return s_->judge.accepts(tried_, before, rule) && s_->replacer.fits(tried_);
}

bool PolyhedronGrowth::make(CellId c, Judge::Rule rule) {
  cells_.clear();
  vertices_.clear();
  take(c);
  bool found = false, grows = true;
  for (const std::size_t size : sizes) {
    const std::size_t before = cells_.size();
    while (grows && cells_.size() < size) grows = grow();
    if (cells_.size() == before) break;
    found = fill(rule);
    if (found || !grows) break;
  }
  for (const CellId x : cells_) s_->mesh->unmark(x);
  if (!found || !s_->commit(tried_)) return false;
  ++s_->w->visit->counts.reconnections;
  return true;
}

}  // namespace pgdr
