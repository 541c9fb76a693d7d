// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "build/plane_clusters.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "input/triangle_shapes.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/disjoint_sets.hpp"
#include "space/make_set.hpp"

namespace pgdr::detail {
namespace {

constexpr std::uint64_t directed(std::uint32_t a, std::uint32_t b) { return static_cast<std::uint64_t>(a) << 32 | b; }

}  // namespace

PlaneClusters::PlaneClusters(const BuildInput<3>& in, const PlaneWidth& width, FacetTriangles& faces, const PlaneEdges& edges,
                             std::span<const std::uint32_t> plane_of, FacetAreas* areas, BuildReport<3>& report)
    : in_(in),
      width_(width),
      faces_(faces),
      edges_(edges),
      plane_of_(plane_of),
      areas_(areas),
      report_(report),
      replaced_(faces.facets.size(), false),
      kept_by_(faces.facets.size(), no_entity) {
  std::sort(faces_.repeated.begin(), faces_.repeated.end());
}

bool PlaneClusters::triangulate(std::span<const std::uint32_t> facets, std::span<const std::uint64_t> edges) {
  facets_ = facets;
  if (!look_along_axis()) return false;
  find_layers();
  find_rims();
  if (!build(edges) || !cover()) return false;
  measure_layers();
  take_cells();
  find_outlines();
  turn_facets();
  std::ranges::set_difference(inside_layers_, hard_, std::back_inserter(given_up_));
  return true;
}

/// Along the largest component of the normal of the largest triangle; false if some triangle has no area there.
bool PlaneClusters::look_along_axis() {
  const TriangleShapes shapes(in_.points, in_.scale);
  double square = -1;
  PlanarTriangle largest{};
  for (const std::uint32_t f : facets_)
    for (const PlanarTriangle& t : faces_.of(faces_.facets[f])) {
      const Vector<3> n = shapes.normal(t);
      if (const double s = dot(n, n); s > square || (s == square && shapes.is_before(t, largest))) {
        square = s;
        largest = t;
        axis_ = axes_by_size(n)[0];
      }
    }
  const auto& p = in_.points;
  for (const std::uint32_t f : facets_)
    for (const PlanarTriangle& t : faces_.of(faces_.facets[f]))
      if (orient_projected(p[t[0]], p[t[1]], p[t[2]], axis_) == Sign::zero) return false;
  return true;
}

std::uint32_t PlaneClusters::place(std::uint32_t f) const {
  return static_cast<std::uint32_t>(std::ranges::lower_bound(facets_, f) - facets_.begin());
}

/// The facet of the cluster beyond an edge of triangle t that is no segment, which may be the triangle's own; no_entity: the edge
/// stays.
std::uint32_t PlaneClusters::other_in_cluster(std::uint32_t t, std::size_t edge) const {
  const std::uint32_t f = edges_.beyond(t, edge, plane_of_);
  return f != no_entity && std::ranges::binary_search(facets_, f) ? f : no_entity;
}

void PlaneClusters::find_layers() {
  DisjointSets sets(facets_.size());
  inside_layers_.clear();
  for (const std::uint32_t f : facets_)
    for (std::uint32_t t = faces_.facets[f].first; t < faces_.facets[f].first + faces_.facets[f].count; ++t)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t g = other_in_cluster(t, i);
        if (g == no_entity) continue;
        inside_layers_.push_back(faces_.key_of_edge(t, i));
        sets.unite(place(f), place(g));
      }
  make_set(inside_layers_);
  layer_of_.resize(facets_.size());
  first_of_.clear();
  for (std::uint32_t k = 0; k < facets_.size(); ++k) {
    if (sets.find(k) == k) {
      layer_of_[k] = static_cast<std::uint32_t>(first_of_.size());
      first_of_.push_back(facets_[k]);
    } else {
      layer_of_[k] = layer_of_[sets.find(k)];
    }
  }
}

void PlaneClusters::find_rims() {
  rims_.clear();
  hard_.clear();
  const auto& p = in_.points;
  for (const std::uint32_t f : facets_)
    for (std::uint32_t t = faces_.facets[f].first; t < faces_.facets[f].first + faces_.facets[f].count; ++t) {
      const PlanarTriangle& s = faces_.triangles[t];
      const bool turned = orient_projected(p[s[0]], p[s[1]], p[s[2]], axis_) == Sign::negative;
      for (std::size_t i = 0; i < 3; ++i) {
        if (other_in_cluster(t, i) != no_entity) continue;
        const std::uint32_t a = s[(i + 1) % 3], b = s[(i + 2) % 3];
        rims_.push_back({turned ? b : a, turned ? a : b, layer_of_[place(f)]});
        hard_.push_back(edge_key(a, b));
      }
    }
  std::stable_sort(rims_.begin(), rims_.end(), [](const Rim& a, const Rim& b) { return a.layer < b.layer; });
  make_set(hard_);
}

// An edge inside of them that crosses what stays is left out: it is for the diagnosis to tell.
bool PlaneClusters::build(std::span<const std::uint64_t> edges) {
  std::vector<std::uint32_t> vertices;
  for (const std::uint32_t f : facets_)
    for (const PlanarTriangle& t : faces_.of(faces_.facets[f])) vertices.insert(vertices.end(), t.begin(), t.end());
  make_set(vertices);
  const auto is_vertex = [&](std::uint32_t v) { return width_.is_added(v) || std::ranges::binary_search(vertices, v); };
  std::vector<std::uint64_t> inner;
  for (const std::uint64_t key : edges)
    if (is_vertex(edge_of(key)[0]) && is_vertex(edge_of(key)[1])) inner.push_back(key);
  for (const std::uint64_t key : inner) vertices.insert(vertices.end(), {edge_of(key)[0], edge_of(key)[1]});
  make_set(vertices);
  std::vector<PlanarEdge> constraints;
  for (const std::uint64_t key : hard_) constraints.push_back(edge_of(key));
  const std::size_t own = constraints.size();
  for (const std::uint64_t key : inner) constraints.push_back(edge_of(key));
  if (planar_.build(in_.points, vertices, constraints, axis_)) {
    hard_.insert(hard_.end(), inner.begin(), inner.end());
  } else {
    constraints.resize(own);
    if (!planar_.build(in_.points, vertices, constraints, axis_)) return false;
    for (const std::uint64_t key : inner)
      if (planar_.constrain(edge_of(key)[0], edge_of(key)[1])) hard_.push_back(key);
  }
  make_set(hard_);
  return true;
}

/// The cell on the left of the edge; no_entity: none.
std::uint32_t PlaneClusters::left_of(std::uint32_t a, std::uint32_t b) const {
  const auto at = std::ranges::lower_bound(sides_, std::pair{directed(a, b), 0u});
  return at != sides_.end() && at->first == directed(a, b) ? at->second : no_entity;
}

/// The cell beyond an edge of this one.
std::uint32_t PlaneClusters::beyond(const PlanarTriangle& t, std::size_t edge) const {
  return left_of(t[(edge + 2) % 3], t[(edge + 1) % 3]);
}

/// Which layers cover which cells.
bool PlaneClusters::cover() {
  cells_ = planar_.triangles();
  sides_.clear();
  for (std::uint32_t c = 0; c < cells_.size(); ++c)
    for (std::size_t i = 0; i < 3; ++i) sides_.emplace_back(directed(cells_[c][i], cells_[c][(i + 1) % 3]), c);
  std::sort(sides_.begin(), sides_.end());
  covers_.clear();
  seen_by_.assign(cells_.size(), no_entity);
  for (auto begin = rims_.begin(), end = begin; begin != rims_.end(); begin = end) {
    while (end != rims_.end() && end->layer == begin->layer) ++end;
    if (!flood(begin->layer, {begin, end})) return false;
  }
  std::sort(covers_.begin(), covers_.end());
  return true;
}

/// From the left sides of the rims of a layer up to these. False if that has no end, or no beginning.
bool PlaneClusters::flood(std::uint32_t layer, std::span<const Rim> rims) {
  std::vector<std::uint64_t> walls;
  for (const Rim& rim : rims) walls.push_back(edge_key(rim.a, rim.b));
  make_set(walls);
  std::vector<std::uint32_t> queue;
  const auto reach = [&](std::uint32_t cell) {
    if (cell == no_entity) return false;
    if (seen_by_[cell] == layer) return true;
    seen_by_[cell] = layer;
    queue.push_back(cell);
    covers_.emplace_back(cell, layer);
    return true;
  };
  for (const Rim& rim : rims)
    if (!reach(left_of(rim.a, rim.b))) return false;
  while (!queue.empty()) {
    const PlanarTriangle t = cells_[queue.back()];
    queue.pop_back();
    for (std::size_t i = 0; i < 3; ++i)
      if (!std::ranges::binary_search(walls, edge_key(t[(i + 1) % 3], t[(i + 2) % 3])) && !reach(beyond(t, i))) return false;
  }
  return true;
}

std::span<const std::pair<std::uint32_t, std::uint32_t>> PlaneClusters::layers_at(std::uint32_t cell) const {
  if (cell == no_entity) return {};
  const auto begin = std::ranges::lower_bound(covers_, std::pair{cell, 0u}),
             end = std::ranges::lower_bound(covers_, std::pair{cell + 1, 0u});
  return {begin, end};
}

/// Of each layer the facets of the input that it is made of, and those that repeat them.
std::vector<std::vector<std::uint32_t>> PlaneClusters::inputs_of_layers() const {
  std::vector<std::vector<std::uint32_t>> inputs(first_of_.size());
  for (std::uint32_t k = 0; k < facets_.size(); ++k) {
    auto& here = inputs[layer_of_[k]];
    here.push_back(faces_.facets[facets_[k]].input);
    const auto first = std::ranges::lower_bound(faces_.repeated, std::pair{facets_[k], 0u});
    for (auto at = first; at != faces_.repeated.end() && at->first == facets_[k]; ++at) here.push_back(at->second);
  }
  return inputs;
}

int PlaneClusters::marker(std::uint32_t layer) const { return in_.plc.facets[faces_.facets[first_of_[layer]].input].marker; }

void PlaneClusters::measure_layers() {
  std::vector<std::vector<std::uint32_t>> facets(first_of_.size());
  for (std::uint32_t k = 0; k < facets_.size(); ++k) facets[layer_of_[k]].push_back(facets_[k]);
  area_of_.assign(first_of_.size(), {});
  for (std::size_t layer = 0; areas_ != nullptr && layer < facets.size(); ++layer) area_of_[layer] = areas_->of(facets[layer]);
}

/// Which of the layers that cover a cell says whose it is: the first, if their markers are equal; else the smallest, the first of
/// those of one size.
std::uint32_t PlaneClusters::owner(std::uint32_t cell) const {
  const auto layers = layers_at(cell);
  std::uint32_t owner = layers[0].second;
  if (std::ranges::all_of(layers, [&](const auto& l) { return marker(l.second) == marker(owner); })) return owner;
  for (const auto& [same, layer] : layers)
    if (area_of_[layer].is_smaller_than(area_of_[owner], width_.of_added())) owner = layer;
  return owner;
}

void PlaneClusters::take_cells() {
  const auto inputs = inputs_of_layers();
  std::vector<std::uint32_t> taken_by(first_of_.size(), no_entity);  // of each layer the first that has a cell of it
  std::vector<bool> has_any(first_of_.size(), false);
  for (std::size_t k = 0; k < covers_.size(); ++k) {
    const auto& [cell, layer] = covers_[k];
    const std::uint32_t owner = this->owner(cell);
    taken_by[layer] = std::min(taken_by[layer], owner);
    if (marker(layer) != marker(owner))
      hidden_.emplace_back(faces_.facets[first_of_[owner]].input, faces_.facets[first_of_[layer]].input);
    if (layer != owner) continue;
    has_any[layer] = true;
    Made& made = made_.emplace_back(Made{first_of_[layer], cells_[cell], mask_of(cells_[cell], hard_), {}});
    for (const auto& [same, covering] : layers_at(cell))
      made.inputs.insert(made.inputs.end(), inputs[covering].begin(), inputs[covering].end());
    make_set(made.inputs);
  }
  for (std::uint32_t k = 0; k < facets_.size(); ++k) {
    const std::uint32_t f = facets_[k], layer = layer_of_[k], first = first_of_[layer];
    replaced_[f] = true;
    faces_.facets[first].mixed |= first != f;
    if (!has_any[layer]) lost_.push_back(f);
    if (!has_any[layer] || first != f) kept_by_[f] = first_of_[has_any[layer] ? layer : taken_by[layer]];
  }
}

/// Edges that are drawn inside of a layer by another one, or by what is no facet of the cluster.
void PlaneClusters::find_outlines() {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> walls;  // edge, layer that has it
  for (const Rim& rim : rims_) walls.emplace_back(edge_key(rim.a, rim.b), rim.layer);
  make_set(walls);
  for (const std::uint64_t key : hard_) {
    const auto [a, b] = edge_of(key);
    const auto left = layers_at(left_of(a, b)), right = layers_at(left_of(b, a));
    const bool inside = std::ranges::any_of(left, [&](const auto& l) {
      return !std::ranges::binary_search(walls, std::pair{key, l.second}) &&
             std::ranges::any_of(right, [&](const auto& r) { return r.second == l.second; });
    });
    if (inside) faces_.outlines.push_back(key);
  }
}

/// Each facet is seen along the axis of all from here on.
void PlaneClusters::turn_facets() {
  const auto& p = in_.points;
  for (const std::uint32_t f : facets_) {
    TriangulatedFacet& facet = faces_.facets[f];
    const PlanarTriangle& t = faces_.triangles[facet.first];
    if (orient_projected(p[t[0]], p[t[1]], p[t[2]], axis_) == Sign::negative) facet.reversed = !facet.reversed;
    facet.axis = axis_;
  }
}

void PlaneClusters::write() {
  std::stable_sort(made_.begin(), made_.end());
  const auto triangles = std::exchange(faces_.triangles, {});
  const auto masks = std::exchange(faces_.masks, {});
  auto made = made_.begin();
  for (std::uint32_t f = 0; f < faces_.facets.size(); ++f) {
    TriangulatedFacet& facet = faces_.facets[f];
    const std::uint32_t begin = facet.first, end = begin + facet.count;
    facet.first = static_cast<std::uint32_t>(faces_.triangles.size());
    for (std::uint32_t t = begin; t < end && !replaced_[f]; ++t) faces_.add(triangles[t], masks[t]);
    for (; made != made_.end() && made->facet == f; ++made) {
      const auto number = static_cast<std::uint32_t>(faces_.triangles.size());
      for (const std::uint32_t input : made->inputs)
        if (input != facet.input) faces_.overlapped.emplace_back(number, input);
      faces_.add(made->triangle, made->mask);
    }
    facet.count = static_cast<std::uint32_t>(faces_.triangles.size()) - facet.first;
  }
  make_set(faces_.outlines);
  make_set(given_up_);
  std::erase_if(faces_.polygon_edges,
                [&](const OwnedEdge& e) { return std::ranges::binary_search(given_up_, edge_key(e.edge[0], e.edge[1])); });
  note_markers();
  drop_empty_facets();
}

/// Of each pair of facets of the input: the one whose marker stays where they overlap, and the other.
void PlaneClusters::note_markers() {
  make_set(hidden_);
  for (const auto& [first, second] : hidden_) {
    const auto words = [&](std::uint32_t f) {
      return std::to_string(report_.number(f)) + " (marker " + std::to_string(in_.plc.facets[f].marker) + ")";
    };
    const std::string text = words(first) + " over " + words(second);
    report_.repairs.hidden_markers.add([&] { return text; }, {report_.number(first), report_.number(second)});
  }
}

void PlaneClusters::drop_empty_facets() {
  for (const std::uint32_t f : lost_) {
    std::uint32_t kept = f;
    while (kept_by_[kept] != no_entity) kept = kept_by_[kept];
    const std::int64_t number = report_.number(faces_.facets[f].input), first = report_.number(faces_.facets[kept].input);
    report_.repairs.repeated_facets.add([&] { return std::to_string(number) + " = " + std::to_string(first); }, {number, first});
  }
  std::vector<std::uint32_t> new_index(faces_.facets.size());
  std::uint32_t kept = 0;
  for (std::uint32_t f = 0; f < faces_.facets.size(); ++f) {
    new_index[f] = kept;
    if (faces_.facets[f].count > 0) faces_.facets[kept++] = faces_.facets[f];
  }
  for (OwnedEdge& e : faces_.polygon_edges) {
    while (kept_by_[e.owner] != no_entity) e.owner = kept_by_[e.owner];
    e.owner = new_index[e.owner];
  }
  std::erase_if(faces_.repeated, [&](const auto& e) { return replaced_[e.first]; });  // each triangle has it now
  for (auto& e : faces_.repeated) e.first = new_index[e.first];
  faces_.facets.resize(kept);
  faces_.index_facets();
}

}  // namespace pgdr::detail
