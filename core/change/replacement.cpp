// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// All faces of old cells, of new ones and of new walls are matched by their vertices, in a table. How many old and new cells a
// face has says what becomes of it.
#include "change/replacement.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>

namespace pgdr {
namespace {

// The code of a side of a face: the number of the cell, that of the face in it, and one bit: whether sorting turned it over.
constexpr std::uint32_t code_of(std::size_t number, int face) {
  return static_cast<std::uint32_t>(number << 3 | static_cast<std::size_t>(face) << 1);
}
constexpr std::uint32_t number_of(std::uint32_t code) { return code >> 3; }
constexpr int face_of(std::uint32_t code) { return static_cast<int>(code >> 1 & 3); }
constexpr bool is_turned(std::uint32_t code) { return code & 1; }

/// The face of a cell opposite corner i, in the order that face_corners has.
template <int D>
std::array<VertexId, D> face_opposite(const std::array<VertexId, D + 1>& v, int i) {
  std::array<VertexId, D> face;
  for (int k = 0; k < D; ++k) face[k] = v[face_corners<D>[i][k]];
  return face;
}

std::array<VertexId, 2> ascending(VertexId a, VertexId b) { return a < b ? std::array{a, b} : std::array{b, a}; }

/// Leaves one of each that occurs an odd number of times, ascending: the sum of chains of simplices, without orientations.
template <class T>
void sum_up(std::vector<T>& chain) {
  std::sort(chain.begin(), chain.end());
  auto last = chain.begin();
  for (auto at = chain.begin(); at != chain.end();) {
    auto next = at;
    while (next != chain.end() && *next == *at) ++next;
    if ((next - at) % 2 != 0) *last++ = *at;
    at = next;
  }
  chain.erase(last, chain.end());
}

}  // namespace

/// The face with these vertices, made if there is none yet. Turns the code over as it sorts them.
template <int D>
auto Replacer<D>::face_with(const std::array<VertexId, D>& vertices, std::uint32_t& code) -> Face& {
  auto v = vertices;
  const auto order = [&](int i, int j) {
    const bool swaps = v[j] < v[i];
    const auto [low, high] = swaps ? std::pair(v[j], v[i]) : std::pair(v[i], v[j]);
    v[i] = low;
    v[j] = high;
    code ^= static_cast<std::uint32_t>(swaps);
  };
  order(0, 1);
  if constexpr (D == 3) {
    order(1, 2);
    order(0, 1);
  }
  std::uint64_t hash = 0;
  for (const VertexId x : v) hash = (hash ^ index(x)) * 0x9e3779b97f4a7c15u;
  for (std::size_t at = hash >> 32;; ++at) {
    std::uint32_t& entry = table_[at & (table_.size() - 1)];
    if (entry == 0) {
      faces_.push_back({v, {}, {}, 0, 0, false, no_entity, no_entity, 0});
      entry = static_cast<std::uint32_t>(faces_.size());
    }
    if (Face& f = faces_[entry - 1]; f.vertices == v) return f;
  }
}

/// A face of an old or a new cell.
template <int D>
void Replacer<D>::add_side(const std::array<VertexId, D>& vertices, std::uint32_t code, bool of_old, EntityId entity) {
  Face& f = face_with(vertices, code);
  std::uint8_t& count = of_old ? f.olds : f.mades;
  if (count == 2) {
    f.too_often = true;
    return;
  }
  (of_old ? f.old : f.made)[count++] = code;
  if (of_old) f.before = entity;
}

template <int D>
void Replacer<D>::match_faces(const Replacement<D>& r) {
  faces_.clear();
  const std::size_t sides = (D + 1) * (r.old.size() + r.cells.size()) + r.walls.size();
  table_.assign(std::bit_ceil(2 * sides + 1), 0);
  for (std::size_t i = 0; i < r.old.size(); ++i) {
    const auto& v = mesh_->cell(r.old[i]).vertices;
    const auto* k = mesh_->constraints(r.old[i]);
    for (int f = 0; f <= D; ++f)
      add_side(face_opposite<D>(v, f), code_of(i, f), true, k && k->has_face(f) ? k->face_entity[f] : no_entity);
  }
  for (std::size_t i = 0; i < r.cells.size(); ++i)
    for (int f = 0; f <= D; ++f) add_side(face_opposite<D>(r.cells[i].vertices, f), code_of(i, f), false, no_entity);
  for (std::size_t i = 0; i < r.walls.size(); ++i) {
    std::uint32_t code = 0;
    Face& f = face_with(r.walls[i].vertices, code);
    f.too_often = f.too_often || (f.is_wall() && f.wall != r.walls[i].entity);
    if (f.is_wall()) continue;
    f.wall = r.walls[i].entity;
    f.wall_number = static_cast<std::uint32_t>(i);
  }
}

/// Of a face at the rim of the old cells, where it leads; nowhere from the hull, and from faces between old cells.
template <int D>
Link Replacer<D>::beyond(const Replacement<D>& r, const Face& f) const {
  return f.olds == 1 ? mesh_->cell(r.old[number_of(f.old[0])]).links[face_of(f.old[0])] : Link{};
}

/// Notes the border of a wall that comes or goes.
template <int D>
void Replacer<D>::note_changed_wall(const Face& f, EntityId entity) {
  const auto& v = f.vertices;
  if constexpr (D == 2) {
    for (const VertexId end : v) borders_.push_back({entity, {end, end}});
  } else {
    for (const auto& ends : {std::array{v[0], v[1]}, std::array{v[0], v[2]}, std::array{v[1], v[2]}})
      borders_.push_back({entity, ends});
  }
}

/// Are the cells on both sides of a face of one region?
template <int D>
bool Replacer<D>::regions_agree(const Replacement<D>& r, const Face& f, Link beyond) const {
  const std::uint16_t region = r.cells[number_of(f.made[0])].region;
  return region == (beyond ? mesh_->region(beyond.cell()) : r.cells[number_of(f.made[1])].region);
}

template <int D>
bool Replacer<D>::face_fits(const Replacement<D>& r, const Face& f) {
  if (f.too_often || (f.olds == 2 && is_turned(f.old[0]) == is_turned(f.old[1]))) return false;
  if (f.mades == 2 && is_turned(f.made[0]) == is_turned(f.made[1])) return false;
  const Link beyond = this->beyond(r, f);
  if (beyond) rim_.push_back(f.vertices);
  if (f.mades == 0 && !beyond) {  // it goes
    if (f.was_wall()) note_changed_wall(f, f.before);
    return !f.is_wall();
  }
  if (f.was_wall() && f.is_wall() && f.wall != f.before) return false;
  const bool becomes_wall = f.is_wall() && !f.was_wall();
  if (becomes_wall) note_changed_wall(f, f.wall);
  if (f.mades == 0) return becomes_wall;                                          // closed
  if (f.mades == 1 && f.olds != 1) return becomes_wall;                           // new at the hull
  if (f.mades == 1 && is_turned(f.made[0]) != is_turned(f.old[0])) return false;  // the new cell is on the wrong side
  if (f.mades == 2 && beyond) return false;                                       // three cells
  const bool was_hull = f.mades == 2 && f.olds == 1;                              // and is no more
  if (was_hull && !f.is_wall()) note_changed_wall(f, f.before);
  return f.is_wall() || (f.was_wall() && !was_hull) || regions_agree(r, f, beyond);
}

/// The subsegments of the old cells, each once.
template <int D>
void Replacer<D>::take_subsegments(const Replacement<D>& r) {
  subsegments_.clear();
  if constexpr (D == 3) {
    for (const CellId c : r.old) {
      const auto* k = mesh_->constraints(c);
      if (!k || k->edges == 0) continue;
      for (int e = 0; e < 6; ++e) {
        if (!k->has_edge(e)) continue;
        const auto [a, b] = ends_of_edge(mesh_->cell(c).vertices, e);
        subsegments_.push_back({k->edge_entity[e], ascending(a, b)});
      }
    }
    std::sort(subsegments_.begin(), subsegments_.end());
    subsegments_.erase(std::unique(subsegments_.begin(), subsegments_.end()), subsegments_.end());
  }
}

/// False if a new subsegment is none of the new cells' edges, or would have to be one of cells that stay.
template <int D>
bool Replacer<D>::note_changed_subsegments(const Replacement<D>& r) {
  if constexpr (D == 3) {
    const auto in_new = [&](const std::array<VertexId, 2>& e) {
      return std::any_of(r.cells.begin(), r.cells.end(),
                         [&](const auto& cell) { return has_corner(cell.vertices, e[0]) && has_corner(cell.vertices, e[1]); });
    };
    const auto in_rim = [&](const std::array<VertexId, 2>& e) {
      return std::any_of(rim_.begin(), rim_.end(), [&](const auto& v) { return has_corner(v, e[0]) && has_corner(v, e[1]); });
    };
    for (const Piece& s : subsegments_)
      if (!in_new(s.ends) && !in_rim(s.ends)) changed_subsegments_.push_back(s);
    for (const auto& given : r.subsegments) {
      const Piece s{given.segment, ascending(given.ends[0], given.ends[1])};
      const auto old = std::find_if(subsegments_.begin(), subsegments_.end(), [&](const Piece& o) { return o.ends == s.ends; });
      if (!in_new(s.ends) || (old != subsegments_.end() && old->entity != s.entity)) return false;
      if (old != subsegments_.end()) continue;
      if (in_rim(s.ends)) return false;
      changed_subsegments_.push_back(s);
    }
    std::sort(changed_subsegments_.begin(), changed_subsegments_.end());
    changed_subsegments_.erase(std::unique(changed_subsegments_.begin(), changed_subsegments_.end()), changed_subsegments_.end());
  }
  return true;
}

/// Do the walls that come have the border of those that go, but for subsegments that come or go? Do these have the same ends?
template <int D>
bool Replacer<D>::keeps_borders() {
  sum_up(borders_);
  if constexpr (D == 2) return borders_.empty();
  for (const Piece& edge : borders_)
    if (std::none_of(changed_subsegments_.begin(), changed_subsegments_.end(),
                     [&](const Piece& s) { return s.ends == edge.ends; }))
      return false;
  borders_.clear();
  for (const Piece& s : changed_subsegments_)
    for (const VertexId v : s.ends) borders_.push_back({s.entity, {v, v}});
  sum_up(borders_);
  return borders_.empty();
}

template <int D>
bool Replacer<D>::fits(const Replacement<D>& r) {
  borders_.clear();
  changed_subsegments_.clear();
  rim_.clear();
  match_faces(r);
  if (!std::all_of(faces_.begin(), faces_.end(), [&](const Face& f) { return face_fits(r, f); })) return false;
  take_subsegments(r);
  return note_changed_subsegments(r) && keeps_borders();
}

template <int D>
int Replacer<D>::violations(const Replacement<D>& r, int most) const {
  int count = 0;
  for (const Face& f : faces_) {
    if (count > most) break;
    const bool was_hull = f.mades == 2 && f.olds == 1;  // and is no more
    if (f.mades == 0 || f.is_wall() || (f.was_wall() && !was_hull)) continue;
    const Link beyond = this->beyond(r, f);
    if (f.mades == 1 && !beyond) continue;
    const VertexId apex = f.mades == 2 ? r.cells[number_of(f.made[1])].vertices[face_of(f.made[1])]
                                       : mesh_->cell(beyond.cell()).vertices[beyond.face()];
    const auto& cell = r.cells[number_of(f.made[0])];
    if (in_sphere<D>(mesh_->points(cell.vertices), mesh_->point(apex)) == Sign::positive) count += f.mades;
  }
  return count;
}

template <int D>
CellId Replacer<D>::make_cell(Pools& pools, const typename Replacement<D>::Cell& cell) {
  assert(!area_ || area_->owns(*mesh_, cell.vertices));
  const CellId c = mesh_->new_cell(pools, cell.region);
  mesh_->set_vertices(c, cell.vertices);
  mesh_->cell(c).links.fill(Link{});
  mesh_->set_sphere(c);
  return c;
}

/// The face of the cell beyond becomes one of the hull.
template <int D>
void Replacer<D>::close(Pools& pools, Link beyond, const Face& f) {
  mesh_->constrain_face(pools, beyond.cell(), beyond.face(), f.wall);
  mesh_->cell(beyond.cell()).links[beyond.face()] = Link{};
  laid_bare_.emplace_back(f.wall_number, beyond.cell());
}

template <int D>
void Replacer<D>::link(Pools& pools, const Replacement<D>& r, const Face& f) {
  const Link beyond = this->beyond(r, f);
  assert(!beyond || !area_ || area_->may_read(*mesh_, beyond.cell()));
  if (f.mades == 0) {
    if (beyond) close(pools, beyond, f);
    return;
  }
  std::array<Link, 2> at;
  for (int i = 0; i < f.mades; ++i) at[i] = Link(new_cells_[number_of(f.made[i])], face_of(f.made[i]));
  const Link other = f.mades == 2 ? at[1] : beyond;
  mesh_->cell(at[0].cell()).links[at[0].face()] = other;
  if (other) mesh_->cell(other.cell()).links[other.face()] = at[0];
  const bool was_hull = f.mades == 2 && f.olds == 1;  // and is no more
  const EntityId entity = f.is_wall() ? f.wall : was_hull ? no_entity : f.before;
  if (entity == no_entity) return;
  mesh_->constrain_face(pools, at[0].cell(), at[0].face(), entity);
  // Across a new wall may lie a cell that stays, where the one between the subfacets was a flat one.
  if (f.mades == 2 || (other && f.is_wall())) mesh_->constrain_face(pools, other.cell(), other.face(), entity);
}

/// The subsegments of old cells and the new ones, in the new cells.
template <int D>
void Replacer<D>::constrain_edges(Pools& pools, const Replacement<D>& r) {
  if constexpr (D == 3) {
    take_subsegments(r);
    for (const auto& s : r.subsegments) subsegments_.push_back({s.segment, s.ends});
    for (const Piece& s : subsegments_)
      for (std::size_t i = 0; i < r.cells.size(); ++i) {
        const int a = corner_of(r.cells[i].vertices, s.ends[0]);
        if (a > D) continue;
        if (const int b = corner_of(r.cells[i].vertices, s.ends[1]); b <= D)
          mesh_->constrain_edge(pools, new_cells_[i], edge_of_ends[a][b], s.entity);
      }
  }
}

template <int D>
void Replacer<D>::count_versions(const Replacement<D>& r) {
  if constexpr (D == 3) {
    vertices_.clear();
    const auto add = [this](const std::array<VertexId, D + 1>& vertices) {
      for (const VertexId v : vertices)
        if (std::find(vertices_.begin(), vertices_.end(), v) == vertices_.end()) vertices_.push_back(v);
    };
    for (const CellId c : r.old) add(mesh_->cell(c).vertices);
    for (const auto& cell : r.cells) add(cell.vertices);
    for (const VertexId v : vertices_) ++mesh_->note(v).version;
  }
}

template <int D>
void Replacer<D>::commit(Pools& pools, const Replacement<D>& r, OldCells fate) {
  assert(std::all_of(r.old.begin(), r.old.end(),
                     [this](CellId c) { return mesh_->alive(c) && (!area_ || area_->owns(*mesh_, c)); }));
  assert(fits(r));
  match_faces(r);
  new_cells_.clear();
  laid_bare_.clear();
  for (const auto& cell : r.cells) new_cells_.push_back(make_cell(pools, cell));
  for (const Face& f : faces_) link(pools, r, f);
  constrain_edges(pools, r);
  for (const CellId c : new_cells_) mesh_->enlist(c);
  count_versions(r);
  if (fate == OldCells::freed)
    for (const CellId c : r.old) mesh_->free_cell(pools, c);
  if (!new_cells_.empty()) return;
  std::sort(laid_bare_.begin(), laid_bare_.end());
  for (const auto& [wall, c] : laid_bare_) new_cells_.push_back(c);
}

template class Replacer<2>;
template class Replacer<3>;

}  // namespace pgdr
