// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The reading phases of an insertion.
#include <algorithm>

#include "cavity/cavity.hpp"

namespace pgdr {

template <int D>
void Cavity<D>::begin(const Point<D>& p) {
  point_ = p;
  squared_depth_ = area_ ? area_->squared_depth(p) : std::numeric_limits<double>::infinity();
  watch_ = nullptr;
  place_ = nullptr;
  least_ = 0;
  cut_back_ = touches_constraints_ = shapes_known_ = star_shaped_ = false;
  split_edge_ = {no_vertex, no_vertex};
  split_segment_ = no_entity;
}

template <int D>
void Cavity<D>::release() {
  note_seen();
  clear_part_bits();
  for (const CellId c : cells_) mesh_->unmark(c);
  cells_.clear();
  boundary_.clear();
  part_.clear();
  protected_.clear();
}

template <int D>
void Cavity<D>::clear_part_bits() {
  for (const PartFace& f : part_) {
    if (auto* k = mesh_->constraints(f.cell)) k->part = 0;
    if (const Link across = mesh_->cell(f.cell).links[f.face])
      if (auto* k = mesh_->constraints(across.cell())) k->part = 0;
  }
}

template <int D>
auto Cavity<D>::collect(const Point<D>& p, CellId seed, FaceWatch* watch) -> Status {
  begin(p);
  watch_ = watch;
  if (!mesh_->conflicts(seed, p)) return Status::not_in_conflict;
  if (!owns(seed) || !owns_point()) return Status::not_owned;
  take(seed);
  protected_.push_back(seed);
  return grow();
}

template <int D>
auto Cavity<D>::add_part_face(CellId cell, int face, EntityId entity) -> Status {
  if (in_part(cell, face)) return Status::ok;
  const Link across = mesh_->cell(cell).links[face];
  if (!owns(cell) || (across && !owns(across.cell()))) return Status::not_owned;
  part_.push_back({cell, face, entity});
  mesh_->constraints(cell)->part |= static_cast<std::uint8_t>(1 << face);
  take(cell);
  if (across) {
    mesh_->constraints(across.cell())->part |= static_cast<std::uint8_t>(1 << across.face());
    take(across.cell());
  }
  return has_corner_too_near(cell) || (across && has_corner_too_near(across.cell())) ? Status::too_near : Status::ok;
}

template <int D>
bool Cavity<D>::has_corner_too_near(CellId c) {
  if (!(least_ > 0)) return false;
  const auto& v = mesh_->cell(c).vertices;
  if (std::none_of(v.begin(), v.end(), [this](VertexId corner) { return is_too_near(mesh_->vertex(corner)); })) return false;
  near_cell_ = c;
  return true;
}

template <int D>
bool Cavity<D>::is_too_near(const VertexRecord<D>& v) const {
  if (!(std::sqrt(squared_distance(point_, v.point)) < least_)) return false;
  if constexpr (D == 3) return !place_ || !is_twin(*domain_, split_segment_, *place_, v);
  return true;
}

template <int D>
Link Cavity<D>::entity_face_round_ridge(CellId cell, int face, int corner, EntityId entity, bool& owned) const {
  const Mesh<D>& mesh = *mesh_;
  auto belongs = [&](CellId c, int f) {
    const auto* k = mesh.constraints(c);
    return k && k->has_face(f) && k->face_entity[f] == entity;
  };
  for (const bool across : {false, true}) {
    // Within the cell the walk leaves through the face opposite `corner`; beyond the face it starts in the neighbour.
    RidgeWalk<D> walk{cell, face, corner};
    if (across) {
      walk = {cell, corner, face};
      if (!walk.link(mesh)) return {};
      walk.step(mesh);
    }
    const RidgeWalk<D> start = walk;
    do {
      assert(may_read(walk.cell));
      if (belongs(walk.cell, walk.exit)) return Link(walk.cell, walk.exit);
      owned = owned && owns(walk.cell);
      if (!owned) return {};
      if (!walk.link(mesh)) break;
      walk.step(mesh);
    } while (walk.cell != start.cell);
  }
  return {};
}

/// Grows the part, breadth first over the faces of the entity, across ridges that are no subsegments.
template <int D>
auto Cavity<D>::grow_part() -> Status {
  if constexpr (D == 3) {
    for (std::size_t i = 0; i < part_.size(); ++i) {
      const PartFace f = part_[i];
      for (int corner = 0; corner <= D; ++corner) {
        if (corner == f.face) continue;
        if (mesh_->constraints(f.cell)->has_edge(edge_without(f.face, corner))) continue;
        bool owned = true;
        const Link other = entity_face_round_ridge(f.cell, f.face, corner, f.entity, owned);
        if (!owned) return Status::not_owned;
        if (!other || in_part(other.cell(), other.face())) continue;
        if (!owns(other.cell())) return Status::not_owned;
        const Link back = mesh_->cell(other.cell()).links[other.face()];
        if (mesh_->conflicts(other.cell(), point_) || (back && mesh_->conflicts(back.cell(), point_)))
          if (const Status status = add_part_face(other.cell(), other.face(), f.entity); status != Status::ok) return status;
      }
    }
  }
  return Status::ok;
}

/// Collects the rest of a cavity whose first part faces and cells are there.
template <int D>
auto Cavity<D>::collect_all() -> Status {
  if (!owns_point()) return Status::not_owned;
  const Status status = grow_part();
  return status == Status::ok ? grow() : status;
}

template <int D>
auto Cavity<D>::collect_on_face(const Point<D>& p, CellId cell, int face) -> Status {
  begin(p);
  const Link across = mesh_->cell(cell).links[face];
  assert(owns(cell) && (!across || may_read(across.cell())));
  const Status status = add_part_face(cell, face, mesh_->constraints(cell)->face_entity[face]);
  if (status != Status::ok) return status;
  protected_.push_back(cell);
  if (across) protected_.push_back(across.cell());
  return collect_all();
}

/// Takes all cells round the edge, the one way and, where that ends at the hull, the other.
template <int D>
auto Cavity<D>::take_fan(CellId cell, int edge) -> Status {
  Status status = Status::ok;
  if constexpr (D == 3)
    for_cells_round(*mesh_, cell, edge, [&](const RidgeWalk<D>& walk) {
      assert(may_read(walk.cell));
      if (!owns(walk.cell)) status = Status::not_owned;
      if (status != Status::ok) return RoundEdge::stop;
      take(walk.cell);
      const auto* k = mesh_->constraints(walk.cell);
      if (k && k->has_face(walk.exit)) status = add_part_face(walk.cell, walk.exit, k->face_entity[walk.exit]);
      return status == Status::ok ? RoundEdge::go_on : RoundEdge::stop;
    });
  return status;
}

template <int D>
auto Cavity<D>::collect_on_edge(const Point<D>& p, CellId cell, int edge, double least, const SplitPlace* place) -> Status
    requires(D == 3) {
  begin(p);
  least_ = least;
  place_ = place;
  split_edge_ = ends_of_edge(mesh_->cell(cell).vertices, edge);
  split_segment_ = mesh_->constraints(cell)->edge_entity[edge];
  if (const Status status = take_fan(cell, edge); status != Status::ok) return status;
  if (const PinchedEdges* pinched = mesh_->pinched_edges(); pinched && pinched->has(split_segment_)) {
    // The list is in the order in which the cells came, which is not the same everywhere.
    std::vector<CellId> cells = pinched->cells(split_edge_[0], split_edge_[1]);
    std::sort(cells.begin(), cells.end(), [this](CellId a, CellId b) { return compare_vertices<D>(*mesh_, a, b) < 0; });
    for (const CellId c : cells) {
      if (mesh_->marked(c)) continue;
      const auto& v = mesh_->cell(c).vertices;  // its ends are claimed, so that no other visit changes it
      const int there = edge_of_ends[corner_of(v, split_edge_[0])][corner_of(v, split_edge_[1])];
      if (const Status status = take_fan(c, there); status != Status::ok) return status;
    }
  }
  protected_ = cells_;
  return collect_all();
}

template <int D>
auto Cavity<D>::grow() -> Status {
  boundary_.clear();
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const CellId c = cells_[i];
    const CellRecord<D>& k = mesh_->cell(c);
    const ConstraintRecord<D>* constraints = mesh_->constraints(c);
    unsigned closed = 0;
    if (constraints) {
      closed = constraints->faces & ~unsigned{constraints->part};
      touches_constraints_ = true;
    }
    for (int f = 0; f <= D; ++f) {
      const Link next = k.links[f];
      assert(!next || may_read(next.cell()));
      if (closed >> f & 1) {
        boundary_.push_back({c, f});
        if (watch_ && watch_->stops_at(c, f)) return Status::stopped;
      } else if (!next) {
        continue;  // a subfacet of the part, at the hull
      } else if (!mesh_->marked(next.cell())) {
        if (mesh_->conflicts(next.cell(), point_)) {
          if (!owns_next(next)) return Status::not_owned;
          take_unmarked(next.cell());
          const VertexId apex = mesh_->cell(next.cell()).vertices[next.face()];
          if (least_ > 0 && is_too_near(mesh_->vertex(apex))) {
            near_cell_ = next.cell();
            return Status::too_near;
          }
        } else {
          boundary_.push_back({c, f});
        }
      }
    }
  }
  return Status::ok;
}

template <int D>
void Cavity<D>::rebuild_boundary() {
  shapes_known_ = star_shaped_ = false;
  boundary_.clear();
  for (const CellId c : cells_)
    for (int f = 0; f <= D; ++f) {
      if (in_part(c, f)) continue;
      const Link next = mesh_->cell(c).links[f];
      if (mesh_->constrained(c, f) || (next && !mesh_->marked(next.cell()))) boundary_.push_back({c, f});
    }
}

/// Is edge ij of the cell another piece of the subsegment being split? p is on its line, whatever rounding made of it.
template <int D>
bool Cavity<D>::in_line(CellId c, int i, int j) const {
  if constexpr (D == 3) {
    if (split_segment_ == no_entity) return false;
    const auto* k = mesh_->constraints(c);
    const int e = edge_of_ends[i][j];
    return k && k->has_edge(e) && k->edge_entity[e] == split_segment_;
  }
  return false;
}

/// Is the ridge of the cell that lacks the two corners a subsegment?
template <int D>
bool Cavity<D>::is_subsegment(CellId cell, int i, int j) const {
  return mesh_->constraints(cell)->has_edge(edge_without(i, j));
}

/// A ridge between two faces of the part (no subsegment: about the free rim of a facet its two sides see each other, with
/// nothing of the cavity between) vanishes, so that all cells between these faces must be in the cavity. In one
/// plane this follows from the empty spheres; some ulps off it, or after cells were given back, it need not hold. Then
/// the face that was reached later leaves the part, with the cells at it.
template <int D>
auto Cavity<D>::find_broken_fans(std::vector<CellId>& doomed) const -> Status {
  if constexpr (D == 3) {
    for (std::size_t i = 1; i < part_.size(); ++i) {
      const PartFace& f = part_[i];
      const Link across = mesh_->cell(f.cell).links[f.face];
      bool broken = false;
      for (const Link side : {Link(f.cell, f.face), across}) {
        if (!side) continue;
        for (int corner = 0; corner <= D && !broken; ++corner)
          if (corner != side.face() && !is_subsegment(side.cell(), side.face(), corner))
            if (const Status s = look_at_fan({side.cell(), side.face(), corner}, f.entity, broken); s != Status::ok) return s;
      }
      if (!broken) continue;
      doomed.push_back(f.cell);
      if (across) doomed.push_back(across.cell());
      return Status::ok;  // what is left is looked at anew
    }
  }
  return Status::ok;
}

/// Walks from a face of the part to the next constrained face at the ridge or out of the cavity. Broken: it leaves the
/// cavity although the next constrained face would be one of the part and of the same entity.
template <int D>
auto Cavity<D>::look_at_fan(RidgeWalk<D> walk, EntityId entity, bool& broken) const -> Status {
  bool left = false;
  while (!mesh_->constrained(walk.cell, walk.exit)) {
    if (left && !owns(walk.cell)) return Status::not_owned;
    if (!walk.link(*mesh_)) return Status::ok;
    walk.step(*mesh_);
    assert(may_read(walk.cell));
    left = left || !mesh_->marked(walk.cell);
  }
  broken = left && in_part(walk.cell, walk.exit) && mesh_->constraints(walk.cell)->face_entity[walk.exit] == entity;
  return Status::ok;
}

/// Each facet's part must be star-shaped about p too, in the facet's projection: where p, by its rounding, lies on or
/// beyond a ridge of the part's rim, the face at that ridge leaves the part. The split subsegment itself is no rim; any other
/// one is, on both sides. And an edge from p is inside of one facet alone: of faces of two facets that have a corner in common,
/// but the ends of the split subsegment, the later one leaves. (In planes none have. Facets that are planar within a tolerance
/// may have two segments in common.)
template <int D>
void Cavity<D>::find_turned_over(std::vector<CellId>& doomed) const {
  if constexpr (D == 3) {
    for (std::size_t i = 0; i < part_.size(); ++i) {
      const PartFace& f = part_[i];
      bool leaves = false;
      for (int corner = 0; corner <= D && !leaves; ++corner)
        leaves = corner != f.face && (is_turned_over(f, corner) || is_corner_of_other(i, corner));
      if (!leaves) continue;
      doomed.push_back(f.cell);
      if (const Link across = mesh_->cell(f.cell).links[f.face]) doomed.push_back(across.cell());
      return;  // what is left is looked at anew
    }
  }
}

/// Is the ridge opposite the corner a rim of the part, and p not before it?
template <int D>
bool Cavity<D>::is_turned_over(const PartFace& f, int corner) const {
  if constexpr (D == 3) {
    const auto& v = mesh_->cell(f.cell).vertices;
    const int axis = domain_->facets()[f.entity].axis;
    const auto ends = corners_without(f.face, corner);
    const VertexId a = v[ends[0]], b = v[ends[1]];
    const bool split = (a == split_edge_[0] && b == split_edge_[1]) || (a == split_edge_[1] && b == split_edge_[0]);
    if (split || !(is_subsegment(f.cell, f.face, corner) || is_rim(f, a, b))) return false;
    const Point<D>&p = mesh_->point(a), &q = mesh_->point(b);
    const Sign inside = orient_projected(p, q, mesh_->point(v[corner]), axis);
    return in_line(f.cell, ends[0], ends[1]) || orient_projected(p, q, point_, axis) != inside;
  }
  return false;
}

/// Has a face of the part before the i-th, of another entity, this corner of it? Not asked of the ends of the split subsegment.
template <int D>
bool Cavity<D>::is_corner_of_other(std::size_t i, int corner) const {
  const PartFace& f = part_[i];
  const VertexId a = mesh_->cell(f.cell).vertices[corner];
  if (a == split_edge_[0] || a == split_edge_[1]) return false;
  return std::any_of(part_.begin(), part_.begin() + static_cast<std::ptrdiff_t>(i), [&](const PartFace& g) {
    return g.entity != f.entity && mesh_->cell(g.cell).vertices[g.face] != a && has_corner(mesh_->cell(g.cell).vertices, a);
  });
}

/// Is no other face of the part and of f's entity at the ridge ab?
template <int D>
bool Cavity<D>::is_rim(const PartFace& f, VertexId a, VertexId b) const {
  for (const PartFace& g : part_) {
    if (g.entity != f.entity || (g.cell == f.cell && g.face == f.face)) continue;
    const auto& v = mesh_->cell(g.cell).vertices;
    bool has_a = false, has_b = false;
    for (int j = 0; j <= D; ++j) {
      if (j == g.face) continue;
      has_a = has_a || v[j] == a;
      has_b = has_b || v[j] == b;
    }
    if (has_a && has_b) return false;
  }
  return true;
}

/// Gives back the doomed cells, then those that have a face on the cavity's boundary thereby that p does not see, and so on.
/// What is left is the same in any order: a face on the boundary stays there. False if a protected cell is among them.
template <int D>
bool Cavity<D>::peel(std::vector<CellId>& doomed) {
  for (std::size_t i = 0; i < doomed.size(); ++i) {
    const CellId c = doomed[i];
    if (!mesh_->marked(c)) continue;
    if (std::find(protected_.begin(), protected_.end(), c) != protected_.end()) return false;
    mesh_->unmark(c);
    for (int f = 0; f <= D; ++f) {
      const Link next = mesh_->cell(c).links[f];
      if (!next || !mesh_->marked(next.cell())) continue;
      // A face of the part leaves it; another constrained face has been on the boundary before.
      const bool known = mesh_->constrained(c, f) && !in_part(c, f);
      if (!known && !visible_exactly({next.cell(), next.face()})) doomed.push_back(next.cell());
    }
  }
  return true;
}

/// Gives the doomed cells back, and what they hide, or what is no longer connected to the protected cells through faces.
template <int D>
auto Cavity<D>::drop_cells(std::vector<CellId>& doomed) -> Status {
  note_seen();
  cut_back_ = true;
  if (!peel(doomed)) {
    for (const CellId c : protected_)
      for (const VertexId v : mesh_->cell(c).vertices)
        if (v != infinite_vertex && mesh_->point(v) == point_) return Status::duplicate;
    return Status::not_star_shaped;
  }
  // A part face with a cell given back leaves the part, which may cut off further cells, and so on.
  do {
    keep_whole_part_faces();
    keep_connected_cells();
  } while (!part_is_whole());
  rebuild_boundary();
  return Status::ok;
}

template <int D>
bool Cavity<D>::is_whole(const PartFace& f) const {
  const Link across = mesh_->cell(f.cell).links[f.face];
  return mesh_->marked(f.cell) && (!across || mesh_->marked(across.cell()));
}

template <int D>
bool Cavity<D>::part_is_whole() const {
  return std::all_of(part_.begin(), part_.end(), [this](const PartFace& f) { return is_whole(f); });
}

template <int D>
void Cavity<D>::keep_whole_part_faces() {
  clear_part_bits();
  std::erase_if(part_, [this](const PartFace& f) { return !is_whole(f); });
  for (const PartFace& f : part_) {
    mesh_->constraints(f.cell)->part |= static_cast<std::uint8_t>(1 << f.face);
    if (const Link across = mesh_->cell(f.cell).links[f.face])
      mesh_->constraints(across.cell())->part |= static_cast<std::uint8_t>(1 << across.face());
  }
}

/// Keeps the marked cells that the protected ones reach through faces; the others lose their mark.
template <int D>
void Cavity<D>::keep_connected_cells() {
  std::vector<CellId> kept = protected_;
  for (const CellId c : kept) mesh_->unmark(c);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const CellId c = kept[i];
    for (int f = 0; f <= D; ++f) {
      const Link next = mesh_->cell(c).links[f];
      if (!next || (mesh_->constrained(c, f) && !in_part(c, f)) || !mesh_->marked(next.cell())) continue;
      mesh_->unmark(next.cell());
      kept.push_back(next.cell());
    }
  }
  for (const CellId c : cells_) mesh_->unmark(c);
  for (const CellId c : kept) mesh_->mark(c);
  cells_ = std::move(kept);
}

template <int D>
VertexId nearest_vertex(const Mesh<D>& mesh, const Cavity<D>& cavity, std::span<const VertexId> excluded) {
  VertexId nearest = no_vertex;
  double least = std::numeric_limits<double>::infinity();
  for (const CellId c : cavity.cells())
    for (const VertexId v : mesh.cell(c).vertices) {
      if (v == infinite_vertex || v == nearest) continue;
      const double d2 = squared_distance(cavity.point(), mesh.point(v));
      if (d2 > least || std::find(excluded.begin(), excluded.end(), v) != excluded.end()) continue;
      if (d2 == least && nearest != no_vertex && !lex_less(mesh.point(v), mesh.point(nearest))) continue;
      least = d2;
      nearest = v;
    }
  return nearest;
}

template <int D>
double insertion_radius(const Mesh<D>& mesh, const Cavity<D>& cavity, std::span<const VertexId> excluded) {
  double least = std::numeric_limits<double>::infinity();
  for (const CellId c : cavity.cells())
    for (const VertexId v : mesh.cell(c).vertices)
      if (v != infinite_vertex && (excluded.empty() || std::find(excluded.begin(), excluded.end(), v) == excluded.end()))
        least = std::min(least, squared_distance(cavity.point(), mesh.point(v)));
  return std::sqrt(least);
}

template VertexId nearest_vertex<2>(const Mesh<2>&, const Cavity<2>&, std::span<const VertexId>);
template VertexId nearest_vertex<3>(const Mesh<3>&, const Cavity<3>&, std::span<const VertexId>);
template double insertion_radius<2>(const Mesh<2>&, const Cavity<2>&, std::span<const VertexId>);
template double insertion_radius<3>(const Mesh<3>&, const Cavity<3>&, std::span<const VertexId>);
template class Cavity<2>;
template class Cavity<3>;

}  // namespace pgdr
