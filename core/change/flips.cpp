// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "change/flips.hpp"

#include <algorithm>
#include <cassert>

#include "change/facet_flip.hpp"
#include "mesh/locally_delaunay.hpp"

namespace pgdr {
namespace {

/// The vertices of the face opposite corner i, sorted.
template <std::size_t N>
std::array<VertexId, N - 1> sorted_face(const std::array<VertexId, N>& v, int i) {
  auto f = face_without(v, i);
  std::sort(f.begin(), f.end());
  return f;
}

}  // namespace

template <int D>
bool LocalFlips<D>::positive(const Vertices& v) const {
  return orient<D>(mesh_->points(v)) == Sign::positive;
}

template <int D>
auto LocalFlips<D>::repair(Pools& pools, CellId c, int face) -> Outcome {
  if (!pgdr::violates(*mesh_, c, face)) return Outcome::stuck;
  if (!owns(c) || !owns(mesh_->cell(c).links[face].cell())) return Outcome::not_owned;
  if (try_two_cells(pools, c, face)) return Outcome::flipped;
  if constexpr (D == 3) {
    for (int a = 0; a <= D; ++a)
      for (int b = a + 1; b <= D; ++b)
        if (a != face && b != face)
          if (const Outcome outcome = try_edge(pools, c, edge_of_ends[a][b], Condition::better); outcome != Outcome::stuck)
            return outcome;
  }
  return Outcome::stuck;
}

template <int D>
auto LocalFlips<D>::rewrap(Pools& pools, CellId c, int face, LocalRewrap::Effort effort) -> Outcome {
  if constexpr (D == 3) {
    if (!pgdr::violates(*mesh_, c, face)) return Outcome::stuck;
    const bool repaired = rewrap_.repair(pools, c, face, effort);
    if (repaired) new_cells_ = rewrap_.new_cells();
    return repaired ? Outcome::flipped : rewrap_.reached_border() ? Outcome::not_owned : Outcome::stuck;
  }
  return Outcome::stuck;
}

template <int D>
bool LocalFlips<D>::rewrap_pays(std::uint64_t allowance) const {
  if constexpr (D == 3) return rewrap_.ineffective_work() <= allowance + 2 * rewrap_.effective_work();
  return false;
}

/// The D cells round the edge between the apexes that the cells on both sides of the face become; none if one is turned over.
template <int D>
auto LocalFlips<D>::cells_across(CellId c, int face) const -> std::vector<NewCell> {
  const auto& k = mesh_->cell(c);
  const Link link = k.links[face];
  const VertexId apex = mesh_->cell(link.cell()).vertices[link.face()];
  std::vector<NewCell> cells;
  for (int i = 0; i <= D; ++i) {
    if (i == face) continue;
    Vertices v = k.vertices;
    v[i] = apex;
    if (!positive(v)) return {};
    cells.push_back({v, mesh_->region(c)});
  }
  return cells;
}

template <int D>
bool LocalFlips<D>::try_two_cells(Pools& pools, CellId c, int face) {
  const std::vector<NewCell> cells = cells_across(c, face);
  if (cells.empty()) return false;
  take_old({c, mesh_->cell(c).links[face].cell()});
  if (const int before = violations(); violations_of(cells, before) > before) return false;
  replace(pools, cells);
  return true;
}

/// A constrained face at the edge of the ring. False if there may be none: it is of another facet than one before.
template <int D>
bool LocalFlips<D>::note_wall(const RidgeWalk<D>& walk, Ring& ring) const {
  const EntityId entity = mesh_->constraints(walk.cell)->face_entity[walk.exit];
  if (!ring.tips.empty() && entity != ring.entity) return false;
  ring.entity = entity;
  ring.tips.push_back(mesh_->cell(walk.cell).vertices[walk.entry]);
  return true;
}

/// The cells round the edge of c, in order, and the constrained faces among them: none, or two of one facet, between which
/// the edge may be flipped within the facet. At the hull the ring is open, from the one to the other.
template <int D>
auto LocalFlips<D>::take_ring(CellId c, int edge, std::size_t longest, Ring& ring) const -> RingStatus {
  RingStatus status = RingStatus::whole;
  if constexpr (D == 3)
    for_cells_round(*mesh_, c, edge, [&](const RidgeWalk<D>& walk) {
      if (walk.cell != c || ring.cells.empty()) ring.cells.push_back(walk.cell);
      if (ring.cells.size() > longest) status = RingStatus::edge_stays;
      if (status != RingStatus::whole) return RoundEdge::stop;
      assert(may_read(walk.cell));
      if (!owns(walk.cell)) status = RingStatus::not_owned;
      // The face opposite `exit` has the ridge and the vertex `entry`.
      else if (mesh_->constrained(walk.cell, walk.exit) && !note_wall(walk, ring))
        status = RingStatus::edge_stays;
      return status == RingStatus::whole ? RoundEdge::go_on : RoundEdge::stop;
    });
  if (status != RingStatus::whole || ring.tips.empty()) return status;
  return ring.tips.size() == 2 && ring.tips[0] != ring.tips[1] ? RingStatus::whole : RingStatus::edge_stays;
}

/// The ring of cells round an edge becomes two fans about one vertex of the ring; the edge vanishes. Where the edge lies
/// inside a facet the fans are about a tip of its two subfacets there, which are flipped with it.
template <int D>
auto LocalFlips<D>::try_edge(Pools& pools, CellId c, int edge, Condition condition) -> Outcome {
  const VertexId u = mesh_->cell(c).vertices[edge_ends[edge][0]], w = mesh_->cell(c).vertices[edge_ends[edge][1]];
  if (mesh_->is_subsegment(c, edge)) return Outcome::stuck;
  Ring ring;
  const RingStatus status = take_ring(c, edge, longest_ring, ring);
  if (status != RingStatus::whole) return status == RingStatus::not_owned ? Outcome::not_owned : Outcome::stuck;
  if (!ring.tips.empty() && !crosses_in_facet<D>(*mesh_, *domain_, ring.entity, {u, w}, {ring.tips[0], ring.tips[1]}))
    return Outcome::stuck;
  int most = -1;  // of violations; most hubs have no fans and need none counted
  for (const VertexId hub : hubs(ring, u, w)) {
    const std::vector<NewCell> cells = fans(ring, u, w, hub);
    if (cells.empty()) continue;
    if (most < 0) {
      take_old(ring.cells);
      add_walls(ring, u, w);
      most = violations() - (condition == Condition::better && ring.cells.size() > 3);
    }
    if (most < 0 || !walls_are_free() || violations_of(cells, most) > most) continue;
    replace(pools, cells);
    return Outcome::flipped;
  }
  return Outcome::stuck;
}

/// The vertices of the ring, or of these the tips if there are any.
template <int D>
auto LocalFlips<D>::hubs(const Ring& ring, VertexId u, VertexId w) const -> std::vector<VertexId> {
  std::vector<VertexId> hubs = ring.tips;
  if (!hubs.empty()) return hubs;
  for (const CellId r : ring.cells)
    for (const VertexId v : mesh_->cell(r).vertices)
      if (v != u && v != w && std::find(hubs.begin(), hubs.end(), v) == hubs.end()) hubs.push_back(v);
  return hubs;
}

/// The cells about the hub that take the place of the ring about uw; none if one of them would be turned over.
template <int D>
auto LocalFlips<D>::fans(const Ring& ring, VertexId u, VertexId w, VertexId hub) const -> std::vector<NewCell> {
  std::vector<NewCell> cells;
  for (const CellId r : ring.cells) {
    const Vertices& v = mesh_->cell(r).vertices;
    if (has_corner(v, hub)) continue;
    for (const VertexId gone : {u, w}) {
      Vertices fan = v;
      *std::find(fan.begin(), fan.end(), gone) = hub;
      if (!positive(fan)) return {};
      cells.push_back({fan, mesh_->region(r)});
    }
  }
  return cells;
}

/// The two subfacets that the flip of an edge inside a facet makes.
template <int D>
void LocalFlips<D>::add_walls(const Ring& ring, VertexId u, VertexId w) {
  wall_entity_ = ring.entity;
  if (ring.tips.empty()) return;
  for (const VertexId end : {u, w}) {
    Face wall{};
    wall[0] = ring.tips[0];
    wall[1] = ring.tips[1];
    wall[D - 1] = end;
    std::sort(wall.begin(), wall.end());
    new_walls_.push_back(wall);
  }
}

/// Records the outer faces of the cells, and the constrained faces between them.
template <int D>
void LocalFlips<D>::take_old(std::vector<CellId> cells) {
  old_ = std::move(cells);
  outer_.clear();
  old_walls_.clear();
  new_walls_.clear();
  for (const CellId c : old_) {
    const auto& k = mesh_->cell(c);
    for (int f = 0; f <= D; ++f) {
      const bool constrained = mesh_->constrained(c, f);
      const Link link = k.links[f];
      const bool inner = link && std::find(old_.begin(), old_.end(), link.cell()) != old_.end();
      if (inner && constrained) old_walls_.push_back(sorted_face(k.vertices, f));
      if (!inner) outer_.push_back({sorted_face(k.vertices, f), link, constrained});
    }
  }
}

template <int D>
auto LocalFlips<D>::outer(const Face& f) const -> const OuterFace* {
  for (const OuterFace& o : outer_)
    if (o.vertices == f) return &o;
  return nullptr;
}

/// Violating faces of the old cells; inner faces count from both sides.
template <int D>
int LocalFlips<D>::violations() const {
  int count = 0;
  for (const CellId c : old_)
    for (int f = 0; f <= D; ++f) count += pgdr::violates(*mesh_, c, f) && !is_wall(sorted_face(mesh_->cell(c).vertices, f));
  return count;
}

/// No new wall is a constrained face already.
template <int D>
bool LocalFlips<D>::walls_are_free() const {
  return std::none_of(new_walls_.begin(), new_walls_.end(), [this](const Face& f) {
    const OuterFace* o = outer(f);
    return o && o->constrained;
  });
}

template <int D>
bool LocalFlips<D>::is_wall(const Face& f) const {
  return std::find(old_walls_.begin(), old_walls_.end(), f) != old_walls_.end() ||
         std::find(new_walls_.begin(), new_walls_.end(), f) != new_walls_.end();
}

/// The same that these cells would have, in place of the old ones; no more are counted than one above `most`.
template <int D>
int LocalFlips<D>::violations_of(const std::vector<NewCell>& cells, int most) {
  int count = 0;
  faces_.clear();
  for (const NewCell& cell : cells)
    for (int f = 0; f <= D; ++f) faces_.push_back(sorted_face(cell.vertices, f));
  for (std::size_t i = 0; i < faces_.size() && count <= most; ++i) {
    if (is_wall(faces_[i])) continue;
    VertexId apex = no_vertex;
    const OuterFace* o = outer(faces_[i]);
    if (o) {
      if (!o->link || o->constrained) continue;
      apex = mesh_->cell(o->link.cell()).vertices[o->link.face()];
    } else {
      for (std::size_t j = 0; j < faces_.size(); ++j)
        if (j != i && faces_[j] == faces_[i]) apex = cells[j / (D + 1)].vertices[j % (D + 1)];
    }
    if (apex == no_vertex) continue;
    count += in_sphere<D>(mesh_->points(cells[i / (D + 1)].vertices), mesh_->point(apex)) == Sign::positive;
  }
  return count;
}

template <int D>
void LocalFlips<D>::replace(Pools& pools, const std::vector<NewCell>& cells) {
  replacement_.clear();
  replacement_.old = old_;
  replacement_.cells = cells;
  for (const Face& wall : new_walls_) replacement_.walls.push_back({wall, wall_entity_});
  replacer_.commit(pools, replacement_);
  new_cells_ = replacer_.new_cells();
}

template class LocalFlips<2>;
template class LocalFlips<3>;

}  // namespace pgdr
