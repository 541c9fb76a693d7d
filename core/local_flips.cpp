// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/local_flips.hpp"

#include <algorithm>
#include <cassert>

#include "pgdr/cavity.hpp"

namespace pgdr {
namespace {

constexpr std::size_t longest_ring = 7;

template <int D>
std::array<VertexId, D> face_without(const std::array<VertexId, D + 1>& v, int i) {
  std::array<VertexId, D> f{};
  int n = 0;
  for (int j = 0; j <= D; ++j)
    if (j != i) f[n++] = v[j];
  std::sort(f.begin(), f.end());
  return f;
}

template <std::size_t N>
bool has(const std::array<VertexId, N>& v, VertexId x) {
  return std::find(v.begin(), v.end(), x) != v.end();
}

}  // namespace

template <int D>
bool LocalFlips<D>::violates(CellId c, int face) const {
  const Link link = mesh_->cell(c).links[face];
  if (!link || mesh_->constrained(c, face)) return false;
  const VertexId apex = mesh_->cell(link.cell()).vertices[link.face()];
  return in_sphere<D>(mesh_->simplex(c), mesh_->point(apex)) == Sign::positive;
}

template <int D>
Simplex<D> LocalFlips<D>::simplex(const Vertices& v) const {
  Simplex<D> s;
  for (int i = 0; i <= D; ++i) s[i] = mesh_->point(v[i]);
  return s;
}

template <int D>
bool LocalFlips<D>::positive(const Vertices& v) const {
  return orient<D>(simplex(v)) == Sign::positive;
}

template <int D>
bool LocalFlips<D>::repair(Pools& pools, CellId c, int face) {
  if (!violates(c, face)) return false;
  if (try_two_cells(pools, c, face)) return true;
  if constexpr (D == 3) {
    for (int a = 0; a <= D; ++a)
      for (int b = a + 1; b <= D; ++b)
        if (a != face && b != face && try_edge(pools, c, a, b)) return true;
  }
  return false;
}

/// The cells on both sides of the face become D cells round the edge between their apexes.
template <int D>
bool LocalFlips<D>::try_two_cells(Pools& pools, CellId c, int face) {
  const auto& k = mesh_->cell(c);
  const Link link = k.links[face];
  const VertexId apex = mesh_->cell(link.cell()).vertices[link.face()];
  std::vector<Vertices> cells;
  for (int i = 0; i <= D; ++i) {
    if (i == face) continue;
    Vertices v = k.vertices;
    v[i] = apex;
    if (!positive(v)) return false;
    cells.push_back(v);
  }
  if (!take_old({c, link.cell()}) || violations_of(cells) > violations()) return false;
  replace(pools, cells);
  return true;
}

/// The ring of cells round an edge becomes two fans about one vertex of the ring; the edge vanishes.
template <int D>
bool LocalFlips<D>::try_edge(Pools& pools, CellId c, int a, int b) {
  if constexpr (D == 3) {
    const VertexId u = mesh_->cell(c).vertices[a], w = mesh_->cell(c).vertices[b];
    if (const auto* k = mesh_->constraints(c); k && (k->edges >> edge_of_ends[a][b] & 1)) return false;
    int others[2], n = 0;
    for (int i = 0; i <= D; ++i)
      if (i != a && i != b) others[n++] = i;
    std::vector<CellId> ring;
    RidgeWalk<D> walk{c, others[0], others[1]};
    do {
      ring.push_back(walk.cell);
      if (ring.size() > longest_ring || mesh_->constrained(walk.cell, walk.exit) || !walk.link(*mesh_)) return false;
      walk.step(*mesh_);
    } while (walk.cell != c);
    if (!take_old(ring)) return false;
    const int before = violations();
    for (const CellId first : ring)
      for (const VertexId hub : mesh_->cell(first).vertices) {
        if (hub == u || hub == w) continue;
        std::vector<Vertices> cells;
        bool good = true;
        for (const CellId r : ring) {
          const Vertices& v = mesh_->cell(r).vertices;
          if (has(v, hub)) continue;
          for (const VertexId gone : {u, w}) {
            Vertices fan = v;
            *std::find(fan.begin(), fan.end(), gone) = hub;
            good = good && positive(fan);
            cells.push_back(fan);
          }
        }
        if (!good) continue;
        const int after = violations_of(cells);
        if (after > before || (after == before && ring.size() > 3)) continue;
        replace(pools, cells);
        return true;
      }
  } else {
    static_cast<void>(pools);
    static_cast<void>(c);
    static_cast<void>(a);
    static_cast<void>(b);
  }
  return false;
}

/// Records the outer faces and subsegments of the cells. False if a constrained face lies between two of them.
template <int D>
bool LocalFlips<D>::take_old(std::vector<CellId> cells) {
  old_ = std::move(cells);
  outer_.clear();
  subsegments_.clear();
  for (const CellId c : old_) {
    const auto& k = mesh_->cell(c);
    const auto* constraints = mesh_->constraints(c);
    for (int f = 0; f <= D; ++f) {
      const bool constrained = mesh_->constrained(c, f);
      const Link link = k.links[f];
      const bool inner = link && std::find(old_.begin(), old_.end(), link.cell()) != old_.end();
      if (inner && constrained) return false;
      if (!inner)
        outer_.push_back({face_without<D>(k.vertices, f), link, constrained,
                          constrained ? constraints->face_entity[f] : no_entity});
    }
    if constexpr (D == 3) {
      if (!constraints) continue;
      for (int e = 0; e < 6; ++e)
        if (constraints->edges >> e & 1)
          subsegments_.push_back({k.vertices[edge_ends[e][0]], k.vertices[edge_ends[e][1]], constraints->edge_entity[e]});
    }
  }
  return true;
}

template <int D>
auto LocalFlips<D>::outer(const Face& f) const -> const OuterFace* {
  for (const OuterFace& o : outer_)
    if (o.vertices == f) return &o;
  return nullptr;
}

template <int D>
int LocalFlips<D>::violations() const {
  std::vector<Vertices> cells;
  for (const CellId c : old_) cells.push_back(mesh_->cell(c).vertices);
  return violations_of(cells);
}

/// Violating faces that these cells would have, in place of the old ones; inner faces count from both sides.
template <int D>
int LocalFlips<D>::violations_of(const std::vector<Vertices>& cells) const {
  int count = 0;
  for (const Vertices& v : cells)
    for (int f = 0; f <= D; ++f) {
      const Face face = face_without<D>(v, f);
      VertexId apex = no_vertex;
      if (const OuterFace* o = outer(face)) {
        if (!o->link || o->constrained) continue;
        apex = mesh_->cell(o->link.cell()).vertices[o->link.face()];
      } else {
        for (const Vertices& w : cells)
          for (int g = 0; g <= D; ++g)
            if (w != v && face_without<D>(w, g) == face) apex = w[g];
      }
      if (apex != no_vertex && in_sphere<D>(simplex(v), mesh_->point(apex)) == Sign::positive) ++count;
    }
  return count;
}

template <int D>
CellId LocalFlips<D>::make_cell(Pools& pools, const Vertices& v) {
  const CellId c = mesh_->new_cell(pools);
  auto& k = mesh_->cell(c);
  k.vertices = v;
  k.links.fill(Link{});
  mesh_->set_region(c, mesh_->region(old_[0]));
  mesh_->set_sphere(c, circumsphere<D>(mesh_->simplex(c)));
  for (int f = 0; f <= D; ++f) {
    const OuterFace* o = outer(face_without<D>(v, f));
    if (!o) continue;
    k.links[f] = o->link;
    if (o->link) mesh_->cell(o->link.cell()).links[o->link.face()] = Link(c, f);
    if (!o->constrained) continue;
    auto& constraints = mesh_->ensure_constraints(pools, c);
    constraints.faces |= static_cast<std::uint8_t>(1 << f);
    constraints.face_entity[f] = o->entity;
  }
  if constexpr (D == 3) {
    for (const Subsegment& s : subsegments_) {
      const auto a = std::find(v.begin(), v.end(), s.a), b = std::find(v.begin(), v.end(), s.b);
      if (a == v.end() || b == v.end()) continue;
      const int e = edge_of_ends[a - v.begin()][b - v.begin()];
      auto& constraints = mesh_->ensure_constraints(pools, c);
      constraints.edges |= static_cast<std::uint8_t>(1 << e);
      constraints.edge_entity[e] = s.entity;
    }
  }
  return c;
}

template <int D>
void LocalFlips<D>::replace(Pools& pools, const std::vector<Vertices>& cells) {
  new_cells_.clear();
  for (const Vertices& v : cells) new_cells_.push_back(make_cell(pools, v));
  for (const CellId c : new_cells_)
    for (int f = 0; f <= D; ++f) {
      if (mesh_->cell(c).links[f] || outer(face_without<D>(mesh_->cell(c).vertices, f))) continue;
      const Face face = face_without<D>(mesh_->cell(c).vertices, f);
      for (const CellId other : new_cells_)
        for (int g = 0; g <= D; ++g)
          if (other != c && face_without<D>(mesh_->cell(other).vertices, g) == face)
            mesh_->cell(c).links[f] = Link(other, g);
      assert(mesh_->cell(c).links[f]);
    }
  for (const CellId c : old_) mesh_->free_cell(pools, c);
}

template class LocalFlips<2>;
template class LocalFlips<3>;

}  // namespace pgdr
