// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "optimize/flips.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace pgdr {

bool BestFlip::make(CellId c, Judge::Rule rule) {
  found_ = false;
  best_quality_ = 0;
  for (int e = 0; e < 6; ++e) try_edge(c, e, rule);
  for (int f = 0; f < 4; ++f) try_face(c, f, rule);
  return found_ && s_->commit(best_);
}

/// Keeps what was tried if its worst cell is better than that of the best one so far.
void BestFlip::take_if_best(const Judge::Standing& before, Judge::Rule rule) {
  if ((found_ && tried_quality_ <= best_quality_) || !s_->judge.accepts(tried_, before, rule)) return;
  found_ = true;
  best_quality_ = tried_quality_;
  std::swap(best_, tried_);
}

/// The cells of one side of the ring without the edge, and the two faces that close it. False if none is better than `enough`.
bool BestFlip::fill_side(const RingSide& side, double enough) {
  const Mesh<3>& mesh = *s_->mesh;
  const bool whole = ring_.closed && side.count == ring_.cells.size();
  const std::size_t n = whole ? side.count : side.count + 1;
  if (n < 3) return true;  // one flat cell between two subfacets: it is taken off
  std::array<Point3, EdgeRemoval::longest_ring> points;
  for (std::size_t i = 0; i < n; ++i) points[i] = mesh.point(ring_.vertex(side.first + i));
  const std::uint16_t region = mesh.region(ring_.cell(side.first));
  const double q = removal_.find({points.data(), n}, mesh.point(ring_.ends[0]), mesh.point(ring_.ends[1]), region,
                                 s_->judge.quality(), enough);
  if (!(q > enough)) return false;
  tried_quality_ = std::min(tried_quality_, q);
  for (const auto& t : removal_.triangles()) {
    std::array<VertexId, 3> v;
    for (int i = 0; i < 3; ++i) v[i] = ring_.vertex(side.first + t[i]);
    tried_.cells.push_back({{v[0], v[1], v[2], ring_.ends[1]}, region});
    tried_.cells.push_back({{v[2], v[1], v[0], ring_.ends[0]}, region});
  }
  return true;
}

void BestFlip::try_edge(CellId c, int edge, Judge::Rule rule) {
  if (s_->mesh->is_subsegment(c, edge)) return;
  constexpr std::size_t longest = 2 * EdgeRemoval::longest_ring - 2;  // of two halves
  if (s_->note(collect_ring(*s_->mesh, s_->area(), c, edge, longest, ring_)) != Reach::ok) return;
  const auto sides = sides_without_edge(*s_->mesh, *s_->domain, ring_);
  if (sides.empty()) return;
  for (const RingSide& side : sides) {
    if (side.count + (ring_.closed && sides.size() == 1 ? 0 : 1) > EdgeRemoval::longest_ring) return;
    // Where a flat cell is taken off at a rim, the cells beside it change, too.
    if (side.count == 1 && s_->transaction.is_on()) return;
  }
  tried_.clear();
  tried_.old = ring_.cells;
  tried_quality_ = 1;
  const Judge::Standing before = s_->judge.standing_of(tried_.old);
  const double enough = std::max(Judge::too_bad(before), found_ ? best_quality_ : 0);
  for (const RingSide& side : sides)
    if (!fill_side(side, enough)) return;
  if (const std::vector<std::size_t> at = ring_.constrained(); !at.empty()) {
    for (const VertexId end : ring_.ends)
      tried_.walls.push_back({{ring_.vertices[at[0]], ring_.vertices[at[1]], end}, ring_.walls[at[0]]});
    if (!s_->replacer.fits(tried_)) return;  // a flat cell beside them may have such a face already
  }
  take_if_best(before, rule);
}

void BestFlip::try_face(CellId c, int face, Judge::Rule rule) {
  const Mesh<3>& mesh = *s_->mesh;
  const Link link = mesh.cell(c).links[face];
  if (!link || mesh.constrained(c, face)) return;
  if (!s_->owns(link.cell())) {
    s_->note(Reach::not_owned);
    return;
  }
  const VertexId apex = mesh.cell(link.cell()).vertices[link.face()];
  tried_.clear();
  tried_.old = {c, link.cell()};
  const Judge::Standing before = s_->judge.standing_of(tried_.old);
  const double enough = std::max(Judge::too_bad(before), found_ ? best_quality_ : 0);
  tried_quality_ = 1;
  for (int i = 0; i < 4; ++i) {
    if (i == face) continue;
    auto v = mesh.cell(c).vertices;
    v[i] = apex;
    const double q = s_->judge.quality().of(mesh.points(v), mesh.region(c), enough);
    if (!(q > enough)) return;
    tried_quality_ = std::min(tried_quality_, q);
    tried_.cells.push_back({v, mesh.region(c)});
  }
  take_if_best(before, rule);
}

}  // namespace pgdr
