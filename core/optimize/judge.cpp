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

double Judge::of(CellId c) {
  Known& known = known_[index(c) % known_size];
  if (known.cell == c && known.birth == w_->mesh.birth(c)) {
    ++remembered_;
  } else {
    const std::size_t guessed = guesses_.guessed();
    const double q = quality_.of(w_->mesh.simplex(c), w_->mesh.region(c));
    if (guesses_.guessed() > guessed) return q;  // it may be another
    known = {c, w_->mesh.birth(c), q};
  }
  return known.quality;
}

void Judge::begin(CellId c) {
  guessed_wrong_ = false;
  if (asks_blocks_) guesses_.begin(w_->mesh.simplex(c), w_->mesh.region(c));
}

bool Judge::may_change() {
  guessed_wrong_ = guessed_wrong_ || !guesses_.settle();
  return !guessed_wrong_;
}

bool Judge::settle(std::uint64_t asked_before) {
  const bool right = guesses_.settle() && !guessed_wrong_;
  guessed_wrong_ = false;
  if (!right) repeated_ += asked() - asked_before;
  return right;
}

auto Judge::standing_of(std::span<const CellId> cells) -> Standing {
  Standing standing;
  standing.shortest2 = std::numeric_limits<double>::infinity();
  for (const CellId c : cells) {
    const double q = of(c);
    standing.worst = std::min(standing.worst, q);
    if (q < 1) standing.add_poor(CellQuality::level(q));
    if (q < 1 && !quality_.is_within_size(w_->mesh.simplex(c), w_->mesh.region(c))) ++standing.too_big;
    if (w_->options.min_edge > 0)
      standing.shortest2 = std::min(standing.shortest2, shortest_edge_squared<3>(w_->mesh.simplex(c)));
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

/// Adds a cell; false if it is no better than `enough`.
bool Judge::add(const Simplex<3>& s, int region, double enough, Standing& standing) {
  const double q = quality_.of(s, region, enough);
  if (!(q > enough)) return false;
  standing.worst = std::min(standing.worst, q);
  if (q < 1) standing.add_poor(CellQuality::level(q));
  if (q < 1 && !quality_.is_within_size(s, region)) ++standing.too_big;
  if (w_->options.min_edge > 0) standing.shortest2 = std::min(standing.shortest2, shortest_edge_squared<3>(s));
  return true;
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
  now.shortest2 = std::numeric_limits<double>::infinity();
  const double enough = too_bad(before);
  const SizeGuesses::Along others(sizes(), [&](SizeGuesses& sizes) {
    for (const auto& cell : r.cells) sizes.add(w_->mesh.points(cell.vertices), cell.region);
  });
  for (const auto& cell : r.cells) {
    if (!add(w_->mesh.points(cell.vertices), cell.region, enough, now)) return {};
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

}  // namespace pgdr
