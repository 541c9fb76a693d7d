// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The lists of a region's refinement and the order in which they are worked off.
#include "pgdr/refiner.hpp"

#include <algorithm>
#include <cmath>

namespace pgdr {
namespace {

constexpr std::uint64_t most_lost_work = 20'000'000;  // of rewrapping large regions: some seconds
constexpr int most_rounds = 32;  // of mending far from walls, each of which ends with fewer violations but for insertions

}  // namespace

template <int D>
Refiner<D>::Refiner(Mesh<D>& mesh, typename Mesh<D>::Pools& pools, const Domain<D>& domain,
                    const RefineOptions<D>& options, CellBounds<D> bounds, std::uint64_t vertices_so_far,
                    std::chrono::steady_clock::time_point start)
    : mesh_(&mesh),
      pools_(&pools),
      domain_(&domain),
      options_(&options),
      bounds_(std::move(bounds)),
      cavity_(mesh, &domain),
      flips_(mesh, domain),
      vertices_(vertices_so_far),
      start_(start),
      last_progress_(start_) {
  double side = 0;
  for (int i = 0; i < D; ++i) {
    double low = domain.points()[0][i], high = low;
    for (const Point<D>& p : domain.points()) {
      low = std::min(low, p[i]);
      high = std::max(high, p[i]);
    }
    side = std::max(side, high - low);
  }
  base_exponent_ = std::ilogb(side);
}

template <int D>
int Refiner<D>::bucket_of(CellId c) const {
  const double r2 = mesh_->cell(c).radius2;
  if (!(r2 < std::numeric_limits<double>::infinity())) return 0;
  // floor(log2(side / r)) up to one: ilogb of r^2 halved, rounding down.
  const int e = std::ilogb(r2);
  return std::clamp(base_exponent_ - (e >= 0 ? e / 2 : -((1 - e) / 2)), 0, buckets - 1);
}

template <int D>
void Refiner<D>::list_poor(CellId c, int why) {
  const int b = bucket_of(c);
  poor_[b].push_back(make_entry(c, why));
  first_bucket_ = std::min(first_bucket_, b);
}

template <int D>
void Refiner<D>::list_entities(CellId c, const ConstraintRecord<D>& k) {
  const auto& vertices = mesh_->cell(c).vertices;
  for (int f = 0; f <= D; ++f)
    if ((k.faces >> f & 1) && face_encroached_by(c, f, vertices[f])) faces_.push_back(make_entry(c, f));
  if constexpr (D == 3) {
    for (int e = 0; e < 6; ++e) {
      if (!(k.edges >> e & 1)) continue;
      const auto [a, b] = edge_ends[e];
      const EntityRef segment{EntityKind::segment, k.edge_entity[e]};
      for (int i = 0; i <= D; ++i) {
        if (i == a || i == b || lies_on<D>(*domain_, mesh_->vertex(vertices[i]).home, segment)) continue;
        if (!in_diametral_ball<D>(mesh_->point(vertices[a]), mesh_->point(vertices[b]), mesh_->point(vertices[i])))
          continue;
        edges_.push_back(make_entry(c, e));
        break;
      }
    }
  }
}

template <int D>
void Refiner<D>::list_cell(CellId c) {
  if (const auto* k = mesh_->constraints(c)) list_entities(c, *k);
  if (bounds_.test(*mesh_, c)) list_poor(c);
}

template <int D>
void Refiner<D>::list_all() {
  for (std::uint32_t i = 0; i < mesh_->cell_bound(); ++i)
    if (mesh_->alive(CellId{i})) list_cell(CellId{i});
}

template <int D>
void Refiner<D>::committed() {
  ++counts_.committed;
  ++vertices_;
  for (const CellId c : cavity_.new_cells()) list_cell(c);
  // A cavity that was not cut back keeps every face locally Delaunay, if all were.
  if (cavity_.shrunk() || violations_seen_) list_violations(cavity_.new_cells());
}

template <int D>
void Refiner<D>::list_violations(std::span<const CellId> cells) {
  for (const CellId c : cells)
    for (int f = 0; f <= D; ++f)
      if (flips_.violates(c, f)) {
        violations_seen_ = true;
        not_delaunay_.push_back(make_entry(c, f));
        flips_left_ += 16;  // an allowance, so that flips that trade violations end
      }
}

template <int D>
void Refiner<D>::list_all_violations() {
  for (std::uint32_t i = 0; violations_seen_ && i < mesh_->cell_bound(); ++i)
    if (const CellId c{i}; mesh_->alive(c)) list_violations(std::span(&c, 1));
}

template <int D>
void Refiner<D>::flip(const Entry& e) {
  using Effort = LocalRewrap::Effort;
  bool mended = flips_left_ > 0 && flips_.repair(*pools_, e.cell, e.which);
  // While no entity has been refused a constrained Delaunay triangulation should exist, if in a large region.
  const bool should_exist = refused_edges_.empty() && refused_faces_.empty() && flips_.rewrap_pays(most_lost_work);
  if (!mended && flips_left_ > 0 && should_exist)
    mended = flips_.rewrap(*pools_, e.cell, e.which, Effort::wide);
  if (!mended && flips_left_ > 0 && rewraps_) mended = flips_.rewrap(*pools_, e.cell, e.which, Effort::quick);
  if (!mended) {
    if (flips_.violates(e.cell, e.which)) list_poor(e.cell, not_delaunay);
    return;
  }
  --flips_left_;
  flipped();
}

/// Lists what the last flip, or rewrapping, has made.
template <int D>
void Refiner<D>::flipped() {
  const std::vector<CellId> made = flips_.new_cells();
  for (const CellId c : made) list_cell(c);
  for (const CellId c : made)
    for (int f = 0; f <= D; ++f)
      if (flips_.violates(c, f)) not_delaunay_.push_back(make_entry(c, f));
}

/// At the end, when the mesh changes no more: violations that no entity is beside, which nothing excuses, are mended, or
/// moved to the walls, in as large a region as that takes.
template <int D>
bool Refiner<D>::mend_far_from_walls() {
  auto at_wall = [this](CellId c) {
    const auto& v = mesh_->cell(c).vertices;
    return std::any_of(v.begin(), v.end(),
                       [this](VertexId x) { return mesh_->vertex(x).home.kind() != EntityKind::volume; });
  };
  bool any = false;
  for (std::uint32_t i = 0; violations_seen_ && i < mesh_->cell_bound(); ++i)
    for (int f = 0; f <= D; ++f) {
      const CellId c{i};
      if (!mesh_->alive(c) || !flips_.violates(c, f) || at_wall(c) || at_wall(mesh_->cell(c).links[f].cell())) continue;
      if (std::find(hopeless_.begin(), hopeless_.end(), mesh_->cell(c).vertices) != hopeless_.end()) continue;
      if (!flips_.rewrap(*pools_, c, f, LocalRewrap::Effort::thorough)) {
        hopeless_.push_back(mesh_->cell(c).vertices);
        continue;
      }
      any = true;
      flipped();
    }
  return any;
}

template <int D>
std::optional<StopCause> Refiner<D>::budget() {
  if (vertices_ >= options_->max_vertices) return StopCause::max_vertices;
  if (counts_.committed + counts_.refused < commits_at_check_) return std::nullopt;
  commits_at_check_ = counts_.committed + counts_.refused + 256;
  if (options_->stop.stop_requested()) return StopCause::cancelled;
  const auto now = std::chrono::steady_clock::now();
  if (options_->time_limit && now - start_ >= *options_->time_limit) return StopCause::time_limit;
  if (options_->progress && now - last_progress_ > std::chrono::milliseconds(200)) {
    last_progress_ = now;
    std::uint64_t waiting = edges_.size() + faces_.size();
    for (const auto& bucket : poor_) waiting += bucket.size();
    options_->progress({vertices_, waiting});
  }
  return std::nullopt;
}

template <int D>
StopCause Refiner<D>::drain() {
  while (true) {
    if (const auto stop = budget()) return *stop;
    auto next = [](std::deque<Entry>& list) {
      const Entry e = list.front();
      list.pop_front();
      return e;
    };
    if (!edges_.empty()) {
      const Entry e = next(edges_);
      if constexpr (D == 3)
        if (alive(e) && split_edge(e, nullptr) == Outcome::refused) refused_edges_.push_back(e);
    } else if (!faces_.empty()) {
      const Entry e = next(faces_);
      if (alive(e) && split_face(e, nullptr) == Outcome::refused && alive(e)) refused_faces_.push_back(e);
    } else if (!not_delaunay_.empty()) {
      const Entry e = next(not_delaunay_);
      if (alive(e)) flip(e);
    } else {
      while (first_bucket_ < buckets && poor_[first_bucket_].empty()) ++first_bucket_;
      if (first_bucket_ == buckets) return StopCause::finished;
      const Entry e = next(poor_[first_bucket_]);
      if (alive(e)) treat_cell(e);
    }
  }
}

/// All that was refused, once more.
template <int D>
bool Refiner<D>::relist_refused() {
  auto relist = [this](std::vector<Entry>& from, std::deque<Entry>& to) {
    for (const Entry& e : from)
      if (alive(e)) to.push_back(e);
    from.clear();
  };
  relist(refused_edges_, edges_);
  relist(refused_faces_, faces_);
  for (const Entry& e : refused_cells_)
    if (alive(e)) list_poor(e.cell, e.which);
  refused_cells_.clear();
  return !edges_.empty() || !faces_.empty() || !not_delaunay_.empty() || first_bucket_ < buckets;
}

template <int D>
StopCause Refiner<D>::run() {
  while (true) {
    const std::uint64_t before = counts_.committed;
    if (const StopCause stop = drain(); stop != StopCause::finished) return stop;
    if (counts_.committed == before) break;
    // A violation left standing may have moved off the walls, where insertions do not look for it.
    list_all_violations();
    if (!relist_refused()) break;
  }
  // What was refused is not looked at again for the few cells that change here.
  rewraps_ = true;
  list_all_violations();
  relist_refused();
  for (int round = 0; round < most_rounds; ++round) {
    if (const StopCause stop = drain(); stop != StopCause::finished) return stop;
    if (!mend_far_from_walls()) break;
    mending_ = true;
  }
  return min_edge_hit_ ? StopCause::min_edge : StopCause::finished;
}

template class Refiner<2>;
template class Refiner<3>;

}  // namespace pgdr
