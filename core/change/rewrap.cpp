// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "change/rewrap.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

#include "change/numbers.hpp"
#include "mesh/surroundings.hpp"

namespace pgdr {
namespace {

/// Of a violation between vertices in the volume: more than all others together, as the cells of a region and what it is filled
/// with have no more faces.
constexpr int far_weight = static_cast<int>(4 * 2 * numbers::wide_wrap_cells) + 1;

}  // namespace

bool LocalRewrap::repair(Pools& pools, CellId c, int face, Effort effort) {
  const CellId d = mesh_->cell(c).links[face].cell();
  reached_border_ = !owns(c) || !owns(d);
  if (reached_border_) return false;
  most_cells_ = effort == Effort::quick ? numbers::quick_wrap_cells : numbers::wide_wrap_cells;
  work_ = 0;
  begin(c, d);
  bool repaired = false;
  std::size_t wrapped = old_.size();
  for (bool grows = true; grows && !repaired && !reached_border_ && !is_ended();) {
    grows = grow();
    if (reached_border_ || old_.size() >= most_cells_) break;
    if (grows ? old_.size() < wrapped + wrapped / numbers::least_wrap_growth : old_.size() == wrapped) continue;
    wrapped = old_.size();
    repaired = wrap_again(pools);
  }
  release();
  (repaired ? effective_work_ : ineffective_work_) += work_;
  return repaired;
}

bool LocalRewrap::in_volume(VertexId v) const { return mesh_->vertex(v).home.kind() == EntityKind::volume; }

/// Where the constrained Delaunay triangulation exists, every order of the front leads to it.
bool LocalRewrap::wrap_again(Pools& pools) {
  const int before = violations_before();
  if (before == 0) return false;
  const std::uint64_t attempt = attempt_hash();
  if (without_effect_.contains(attempt)) return false;
  find_rim();
  front_.clear();
  rim_by_face_.clear();
  for (const RimFace& f : rim_) {
    rim_by_face_.emplace_back(f.vertices, static_cast<std::uint32_t>(front_.size()));
    front_.push_back(f.vertices);
  }
  std::sort(rim_by_face_.begin(), rim_by_face_.end());
  work_ += old_.size() * vertices_.size();
  if (is_ended()) return false;
  if (wrap_.fill(points_, front_, 2 * most_cells_, ended_) && keeps_subsegments() && violations_after(before) < before) {
    replace(pools);
    return true;
  }
  if (!is_ended()) without_effect_.insert(attempt);
  return false;
}

/// A hash of the cells of the region, in any order, the cells about them, and how many cells it may have.
std::uint64_t LocalRewrap::attempt_hash() const {
  std::uint64_t sum = 0;
  for (const CellId c : old_) {
    const CellName name{c, mesh_->birth(c)};
    sum += place_hash<3>(*mesh_, c) ^ std::rotl(*surroundings_of<3>(*mesh_, {&name, 1}, 1), 32);
  }
  return std::rotl(sum, 25) ^ most_cells_;
}

void LocalRewrap::release() {
  for (const CellId c : old_) mesh_->unmark(c);
  old_.clear();
}

auto LocalRewrap::number(VertexId v) -> Index {
  const auto at = std::find(vertices_.begin(), vertices_.end(), v);
  if (at == vertices_.end()) {
    vertices_.push_back(v);
    points_.push_back(mesh_->point(v));
    return static_cast<Index>(vertices_.size() - 1);
  }
  return static_cast<Index>(at - vertices_.begin());
}

void LocalRewrap::take(CellId c) {
  mesh_->mark(c);
  old_.push_back(c);
  for (const VertexId v : mesh_->cell(c).vertices) number(v);
}

bool LocalRewrap::in_conflict(CellId c) const {
  const auto& own = mesh_->cell(c).vertices;
  for (std::size_t i = 0; i < vertices_.size(); ++i)
    if (std::find(own.begin(), own.end(), vertices_[i]) == own.end() && mesh_->conflicts(c, points_[i])) return true;
  return false;
}

void LocalRewrap::begin(CellId c, CellId d) {
  vertices_.clear();
  points_.clear();
  region_ = mesh_->region(c);
  take(c);
  take(d);
}

/// Adds the neighbours that are in conflict with a vertex of the region. False if there are none, or too many.
bool LocalRewrap::grow() {
  const std::size_t before = old_.size();
  for (std::size_t i = 0; i < before; ++i)
    for (int f = 0; f < 4; ++f) {
      const Link next = mesh_->cell(old_[i]).links[f];
      if (!next || mesh_->constrained(old_[i], f) || mesh_->marked(next.cell()) || !in_conflict(next.cell())) continue;
      if (old_.size() >= most_cells_) return false;
      reached_border_ = !owns(next.cell());
      if (reached_border_) return false;
      take(next.cell());
    }
  return old_.size() != before;
}

void LocalRewrap::find_rim() {
  rim_.clear();
  subsegments_.clear();
  for (const CellId c : old_) {
    const auto& k = mesh_->cell(c);
    const auto* constraints = mesh_->constraints(c);
    GiftWrap::Cell cell{};
    for (int i = 0; i < 4; ++i) cell[i] = number(k.vertices[i]);
    for (int f = 0; f < 4; ++f) {
      const bool constrained = mesh_->constrained(c, f);
      if (!constrained && mesh_->marked(k.links[f].cell())) continue;
      rim_.push_back({GiftWrap::face_of(cell, f), k.links[f], constrained});
    }
    if (!constraints) continue;
    for (int e = 0; e < 6; ++e)
      if (constraints->has_edge(e)) subsegments_.push_back(ends_of_edge(cell, e));
  }
}

/// A subsegment inside the region that bounds no facet must be an edge of the new cells, too.
bool LocalRewrap::keeps_subsegments() const {
  return std::all_of(subsegments_.begin(), subsegments_.end(), [&](const std::array<Index, 2>& ends) {
    return std::any_of(wrap_.cells().begin(), wrap_.cells().end(),
                       [&](const GiftWrap::Cell& cell) { return has_corner(cell, ends[0]) && has_corner(cell, ends[1]); });
  });
}

/// The weight of a violation. One between vertices in the volume outweighs all others: so what cannot be repaired moves to the
/// walls, which explain it.
int LocalRewrap::weight(const std::array<VertexId, 4>& cell, VertexId apex) const {
  const bool far = in_volume(apex) && std::all_of(cell.begin(), cell.end(), [this](VertexId v) { return in_volume(v); });
  return far ? far_weight : 1;
}

int LocalRewrap::violation(const GiftWrap::Cell& cell, VertexId apex) const {
  const Simplex<3> s{points_[cell[0]], points_[cell[1]], points_[cell[2]], points_[cell[3]]};
  if (in_sphere<3>(s, mesh_->point(apex)) != Sign::positive) return 0;
  return weight({vertices_[cell[0]], vertices_[cell[1]], vertices_[cell[2]], vertices_[cell[3]]}, apex);
}

/// Violating faces of the old cells by their weights, each counted twice.
int LocalRewrap::violations_before() const {
  int count = 0;
  for (const CellId c : old_)
    for (int f = 0; f < 4; ++f) {
      const Link link = mesh_->cell(c).links[f];
      if (!link || mesh_->constrained(c, f)) continue;
      const VertexId apex = mesh_->cell(link.cell()).vertices[link.face()];
      const Point3& p = mesh_->point(apex);
      if (mesh_->conflicts(c, p) && in_sphere<3>(mesh_->simplex(c), p) == Sign::positive)
        count += weight(mesh_->cell(c).vertices, apex) * (mesh_->marked(link.cell()) ? 1 : 2);
    }
  return count;
}

/// Violating faces of the new cells by their weights, each counted twice; counts no further than to `enough`.
int LocalRewrap::violations_after(int enough) {
  sides_.clear();
  for (const GiftWrap::Cell& cell : wrap_.cells())
    for (int f = 0; f < 4; ++f) sides_.push_back({GiftWrap::face_of(cell, f), vertices_[cell[f]]});
  for (const RimFace& r : rim_)
    if (!r.constrained) sides_.push_back({GiftWrap::turned_over(r.vertices), mesh_->cell(r.link.cell()).vertices[r.link.face()]});
  const auto by_face = [](const Side& s, const Side& t) { return s.face < t.face; };
  std::sort(sides_.begin(), sides_.end(), by_face);
  int count = 0;
  for (const GiftWrap::Cell& cell : wrap_.cells())
    for (int f = 0; f < 4 && count < enough; ++f) {
      const GiftWrap::Face face = GiftWrap::face_of(cell, f);
      const RimFace* r = rim_face(face);
      if (r && r->constrained) continue;
      const auto [first, last] = std::equal_range(sides_.begin(), sides_.end(), Side{GiftWrap::turned_over(face), {}}, by_face);
      for (auto side = first; side != last; ++side) count += (r ? 2 : 1) * violation(cell, side->apex);
    }
  return count;
}

auto LocalRewrap::rim_face(const GiftWrap::Face& f) const -> const RimFace* {
  const auto at = std::lower_bound(rim_by_face_.begin(), rim_by_face_.end(), std::pair(f, std::uint32_t{0}));
  return at != rim_by_face_.end() && at->first == f ? &rim_[at->second] : nullptr;
}

void LocalRewrap::replace(Pools& pools) {
  replacement_.clear();
  replacement_.old = old_;
  for (const GiftWrap::Cell& cell : wrap_.cells())
    replacement_.cells.push_back({{vertices_[cell[0]], vertices_[cell[1]], vertices_[cell[2]], vertices_[cell[3]]}, region_});
  release();
  replacer_.commit(pools, replacement_);
}

}  // namespace pgdr
