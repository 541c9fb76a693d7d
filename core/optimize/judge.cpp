// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "optimize/judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "change/facet_flip.hpp"
#include "numbers/simplex_shapes.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr {

bool Judge::is_known(CellId c) const {
  const Known& known = known_[index(c) % most_known];
  return known.cell == c && known.birth == w_->mesh.birth(c);
}

auto Judge::learn(CellId c, double size) -> const Known& {
  const double q = quality_.of_sized(w_->mesh.simplex(c), w_->mesh.region(c), size);
  return known_[index(c) % most_known] = {c, w_->mesh.birth(c), q, size};
}

auto Judge::known_about(CellId c) -> const Known& {
  if (is_known(c)) return known_[index(c) % most_known];
  return learn(c, w_->context.bounds.size_at(w_->mesh.simplex(c), w_->mesh.region(c)));
}

double Judge::of(CellId c) {
  ++looked_at_;
  return known_about(c).quality;
}

void Judge::ask(std::span<const CellId> cells) {
  if (!sizes_vary_) return;
  unknown_.clear();
  block_.clear();
  for (const CellId c : cells) {
    if (is_known(c)) continue;
    unknown_.push_back(c);
    block_.add(w_->mesh.simplex(c), w_->mesh.region(c));
  }
  block_.ask(w_->context.bounds);
  for (std::size_t i = 0; i < unknown_.size(); ++i) learn(unknown_[i], block_.sizes[i]);
}

void Judge::take_sizes(std::span<const CellId> cells) {
  if (!sizes_vary_) return;
  ask(cells);
  quality_.sizes_near.clear();
  for (const CellId c : cells) {
    const Simplex<3> s = w_->mesh.simplex(c);
    quality_.sizes_near.add(centroid<3>(s), w_->mesh.region(c), known_about(c).size);
  }
  quality_.sizes_near.fit();
}

/// Counts a cell of this quality; `within_size()` says whether it is within its bounds of size.
template <class WithinSize>
void Judge::count(const Simplex<3>& s, double q, WithinSize within_size, Standing& standing) const {
  standing.worst = std::min(standing.worst, q);
  if (q < 1) standing.add_poor(CellQuality::level(q));
  if (q < 1 && !within_size()) ++standing.too_big;
  if (w_->options.min_edge > 0) standing.shortest2 = std::min(standing.shortest2, shortest_edge_squared<3>(s));
}

auto Judge::standing_of(std::span<const CellId> cells) -> Standing {
  take_sizes(cells);
  Standing standing;
  for (const CellId c : cells) {
    const Simplex<3> s = w_->mesh.simplex(c);
    const auto within_size = [&] { return quality_.is_within_size(s, w_->mesh.region(c), known_about(c).size); };
    count(s, of(c), within_size, standing);
  }
  std::sort(standing.levels.begin(), standing.levels.end());
  return standing;
}

double Judge::too_bad(const Standing& before) {
  const int level = CellQuality::level(before.worst);
  return level == CellQuality::lowest_level ? 0 : std::nextafter(CellQuality::least_of_level(level), 0.0);
}

bool Judge::is_better(const Standing& now, const Standing& before) {
  const auto [at, than] = std::mismatch(now.levels.begin(), now.levels.end(), before.levels.begin(), before.levels.end());
  if (than == before.levels.end()) return false;
  return at == now.levels.end() || *at > *than;
}

bool Judge::is_allowed(const Standing& now, const Standing& before, Rule rule) const {
  if (CellQuality::level(now.worst) < CellQuality::level(before.worst)) return false;
  const bool weighs = rule == Rule::no_more_poor;
  if (weighs && now.weight > before.weight) return false;
  if (!(weighs && now.weight < before.weight) && !is_better(now, before)) return false;
  if (now.too_big > before.too_big) return false;
  const double least = w_->options.min_edge;
  return !(least > 0) || now.shortest2 >= std::min(before.shortest2, least * least);
}

/// Would all four corners lie on one of the facets, so that the cell has a volume by rounding alone?
bool Judge::is_flat(const std::array<VertexId, 4>& vertices, std::span<const EntityId> facets) const {
  std::array<Home, 4> homes;
  for (int i = 0; i < 4; ++i) homes[i] = w_->mesh.vertex(vertices[i]).home;
  return lie_on_one(w_->domain, homes, facets);
}

auto Judge::accepts(const Replacement<3>& r, const Standing& before, Rule rule) -> std::optional<Standing> {
  Standing now;
  const double enough = too_bad(before);
  for (const auto& cell : r.cells) {
    const Simplex<3> s = w_->mesh.points(cell.vertices);
    const double q = quality_.of(s, cell.region, enough);
    if (!(q > enough)) return {};
    const auto within_size = [&] { return quality_.is_within_size(s, cell.region); };
    count(s, q, within_size, now);
    if (rule == Rule::no_more_poor && now.weight > before.weight) return {};
  }
  std::sort(now.levels.begin(), now.levels.end());
  if (!is_allowed(now, before, rule)) return {};
  return is_valid(r) ? std::optional(std::move(now)) : std::nullopt;
}

bool Judge::is_valid(const Replacement<3>& r) const {
  for (const auto& cell : r.cells)
    if (orient<3>(w_->mesh.points(cell.vertices)) != Sign::positive) return false;
  std::vector<EntityId> facets;
  for (const auto& cell : r.cells) {
    const auto in_volume = [this](VertexId v) { return w_->in_volume(v); };
    if (std::any_of(cell.vertices.begin(), cell.vertices.end(), in_volume)) continue;
    if (facets.empty()) facets = facets_at(w_->mesh, r.old);
    if (is_flat(cell.vertices, facets)) return false;
  }
  return true;
}

bool Judge::accepts(std::span<const CellId> made, const Standing& before, Rule rule) {
  return is_allowed(standing_of(made), before, rule);
}

bool Judge::is_better_by_own_sizes(const Replacement<3>& r) {
  if (!sizes_vary_) return true;
  block_.clear();
  for (const auto& cell : r.cells) block_.add(w_->mesh.points(cell.vertices), cell.region);
  block_.ask(w_->context.bounds);
  sizes_of_made_ = block_.sizes;
  Standing now;
  for (std::size_t i = 0; i < r.cells.size(); ++i) {
    const Simplex<3> s = w_->mesh.points(r.cells[i].vertices);
    const int region = r.cells[i].region;
    const auto within_size = [&] { return quality_.is_within_size(s, region, sizes_of_made_[i]); };
    count(s, quality_.of_sized(s, region, sizes_of_made_[i]), within_size, now);
  }
  std::sort(now.levels.begin(), now.levels.end());
  const std::uint64_t looked_at = looked_at_;  // what sizes ask for is no evaluation
  const bool better = is_allowed(now, standing_of(r.old), Rule::no_more_poor);
  looked_at_ = looked_at;
  return better;
}

void Judge::learn_made(const Replacement<3>& r, std::span<const CellId> made) {
  if (!sizes_vary_ || r.cells.empty()) return;
  for (std::size_t i = 0; i < made.size(); ++i) learn(made[i], sizes_of_made_[i]);
}

void Judge::SizeBlock::clear() {
  centroids.clear();
  regions.clear();
}

void Judge::SizeBlock::add(const Simplex<3>& s, int region) {
  centroids.push_back(centroid<3>(s));
  regions.push_back(region);
}

void Judge::SizeBlock::ask(const CellBounds<3>& bounds) {
  sizes.resize(centroids.size());
  if (!sizes.empty()) bounds.sizes_at(centroids, regions, sizes);
}

}  // namespace pgdr
