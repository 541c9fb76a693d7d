// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "ranks/held_mesh.hpp"

#include <algorithm>
#include <bit>

#include "pgdr/error.hpp"

namespace pgdr::detail {
namespace {

constexpr std::size_t ahead = 12;  ///< cells or vertices

[[noreturn]] void fail(const char* what) { throw ResourceError({Errc::internal, what, {}, 0, {}, {}}); }

}  // namespace

template <int D>
HeldMesh<D>::HeldMesh(Mesh<D>& mesh, const Territory<D>& territory)
    : mesh_(&mesh), territory_(&territory), pools_(mesh.make_pools()) {
  mesh.leave_heap();  // for one more pool
  // Any vertex of the mesh as it is may come back in a message.
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i)
    if (mesh.alive(CellId{i}))
      for (const VertexId v : mesh.cell(CellId{i}).vertices) enter(v);
  keep_held();
}

/// Vertices that were known stay so: those of the cells that go may come back, too.
template <int D>
void HeldMesh<D>::shrink(const Territory<D>& territory) {
  territory_ = &territory;
  zones_.clear();
  cells_.clear();
  keep_held();
}

/// Enters the cells that this rank holds, as far as others may name them, and drops the others.
template <int D>
void HeldMesh<D>::keep_held() {
  note_zones();
  for (std::uint32_t i = 0; i < mesh_->cell_bound(); ++i) {
    const CellId c{i};
    if (!mesh_->alive(c)) continue;
    if (is_held(c))
      share(c);
    else
      drop(c);
  }
  enter_cells();
}

/// Notes where the vertices of all cells are.
template <int D>
void HeldMesh<D>::note_zones() {
  zones_.resize(mesh_->vertex_bound(), unknown);
  for (std::uint32_t i = 0; i < mesh_->cell_bound(); ++i) {
    if (!mesh_->alive(CellId{i})) continue;
    for (const VertexId v : mesh_->cell(CellId{i}).vertices)
      if (zones_[index(v)] == unknown) zones_[index(v)] = territory_->zone(mesh_->point(v));
  }
}

template <int D>
bool HeldMesh<D>::is_held(CellId c) const {
  const auto& vertices = mesh_->cell(c).vertices;
  return std::any_of(vertices.begin(), vertices.end(), [this](VertexId v) { return territory_->holds(zone(v)); });
}

template <int D>
std::uint32_t HeldMesh<D>::hash_of(const Point<D>& p) {
  WordHash hash;
  for (int i = 0; i < D; ++i) hash.add(std::bit_cast<std::uint64_t>(p[i] + 0.0));  // -0 is 0
  return static_cast<std::uint32_t>(hash.value() >> 32);
}

/// The same in any order.
template <int D>
std::uint32_t HeldMesh<D>::hash_of(const Vertices& vertices) {
  std::uint64_t sum = 0;
  for (const VertexId v : vertices) {
    const std::uint64_t mixed = (index(v) + 1) * 0x9e3779b97f4a7c15u;
    sum += (mixed ^ mixed >> 32) * 0xbf58476d1ce4e5b9u;
  }
  return static_cast<std::uint32_t>(sum >> 32);
}

/// In any order. @pre neither has one twice
template <int D>
bool HeldMesh<D>::are_same(const Vertices& a, const Vertices& b) {
  return std::all_of(a.begin(), a.end(), [&b](VertexId v) { return std::find(b.begin(), b.end(), v) != b.end(); });
}

template <int D>
std::array<VertexId, D> HeldMesh<D>::face_of(const Vertices& vertices, int face) {
  std::array<VertexId, D> v;
  for (int i = 0, k = 0; i <= D; ++i)
    if (i != face) v[static_cast<std::size_t>(k++)] = vertices[static_cast<std::size_t>(i)];
  std::sort(v.begin(), v.end());
  return v;
}

template <int D>
Point<D> HeldMesh<D>::point_of(const std::array<double, D>& coordinates) {
  Point<D> p;
  for (int i = 0; i < D; ++i) p[i] = coordinates[static_cast<std::size_t>(i)];
  return p;
}

template <int D>
VertexId HeldMesh<D>::find_vertex(const Point<D>& p) const {
  return VertexId{vertices_.find(hash_of(p), [&](std::uint32_t v) { return mesh_->point(VertexId{v}) == p; })};
}

template <int D>
CellId HeldMesh<D>::find_cell(const Vertices& vertices, std::uint32_t hash) const {
  return CellId{cells_.find(hash, [&](std::uint32_t c) { return are_same(mesh_->cell(CellId{c}).vertices, vertices); })};
}

template <int D>
void HeldMesh<D>::enter(VertexId v) {
  if (index(v) >= is_entered_.size()) is_entered_.resize(std::max<std::size_t>(mesh_->vertex_bound(), 2 * is_entered_.size()));
  if (is_entered_[index(v)]) return;
  is_entered_[index(v)] = true;
  const std::uint32_t hash = hash_of(mesh_->point(v));
  // Of two at one place the other is not in use any more.
  if (const VertexId known = find_vertex(mesh_->point(v)); known != no_vertex) vertices_.erase(hash, index(known));
  vertices_.insert(hash, index(v));
}

/// Enters what others may name of the cell; the cell itself by enter_cells().
template <int D>
void HeldMesh<D>::share(CellId c) {
  const auto& vertices = mesh_->cell(c).vertices;
  int shared = 0;
  for (const VertexId v : vertices) {
    if (index(v) >= zones_.size()) zones_.resize(std::max<std::size_t>(mesh_->vertex_bound(), 2 * zones_.size()), unknown);
    zones_[index(v)] = zone(v);
    shared += territory_->is_shared(zones_[index(v)]) ? 1 : 0;
  }
  if (shared == 0) return;
  for (const VertexId v : vertices) enter(v);
  if (shared == D + 1) entering_.push_back({c, hash_of(vertices)});
}

/// Tables are larger than the cache: what comes a little later is loaded meanwhile, here and below.
template <int D>
void HeldMesh<D>::enter_cells() {
  for (std::size_t i = 0; i < entering_.size(); ++i) {
    if (i + ahead < entering_.size()) cells_.prefetch(entering_[i + ahead].hash);
    cells_.insert(entering_[i].hash, index(entering_[i].cell));
  }
  entering_.clear();
}

template <int D>
void HeldMesh<D>::note_gone(const Net& net) {
  for (std::size_t i = 0; i < net.gone.size(); ++i) {
    if (i + ahead < net.gone.size()) cells_.prefetch(hash_of(net.gone[i + ahead].vertices));
    cells_.erase(hash_of(net.gone[i].vertices), index(net.gone[i].was.cell));
  }
}

template <int D>
void HeldMesh<D>::note_made(const Net& net) {
  for (const CellName& c : net.made) share(c.cell);
  enter_cells();
}

template <int D>
VertexId HeldMesh<D>::vertex_of(const SentVertex<D>& sent) {
  const Point<D> p = point_of(sent.point);
  if (const VertexId known = find_vertex(p); known != no_vertex) return known;
  Home home;
  home.code = sent.home;
  const VertexId v = mesh_->new_vertex(pools_, p, home, sent.relaxed_radius);
  enter(v);
  return v;
}

template <int D>
std::vector<VertexId> HeldMesh<D>::vertices_of(const SentCells<D>& cells) {
  std::vector<VertexId> vertices;
  vertices.reserve(cells.vertices.size());
  for (std::size_t i = 0; i < cells.vertices.size(); ++i) {
    if (i + ahead < cells.vertices.size()) vertices_.prefetch(hash_of(point_of(cells.vertices[i + ahead].point)));
    vertices.push_back(vertex_of(cells.vertices[i]));
  }
  return vertices;
}

template <int D>
auto HeldMesh<D>::local(const SentCorners<D>& corners, std::span<const VertexId> vertices) const -> Vertices {
  Vertices v;
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = vertices[corners[i]];
  return v;
}

template <int D>
void HeldMesh<D>::apply(const SentCells<D>& cells) {
  const std::vector<VertexId> vertices = vertices_of(cells);
  take_out(cells, vertices);
  const std::vector<CellId> made = make(cells, vertices);
  for (std::size_t i = 0; i < made.size(); ++i)
    for (int f = 0; f <= D; ++f)
      if (Link::from_code(cells.made[i].links[static_cast<std::size_t>(f)]) == Link::not_held()) link_at_rim(made[i], f);
  for (const SentConstraints<D>& changed : cells.changed)
    if (!apply(changed, cells.vertices)) fail("another rank names a cell that is not held");
  cells_applied_ += made.size();
}

/// Takes out the cells that are gone, and remembers across which faces others stay.
template <int D>
void HeldMesh<D>::take_out(const SentCells<D>& cells, std::span<const VertexId> vertices) {
  leaving_.clear();
  rim_.clear();
  for (const SentCorners<D>& corners : cells.gone) leaving_.push_back({no_cell, hash_of(local(corners, vertices))});
  for (std::size_t i = 0; i < leaving_.size(); ++i) {
    if (i + ahead < leaving_.size()) cells_.prefetch(leaving_[i + ahead].hash);
    const CellId c = find_cell(local(cells.gone[i], vertices), leaving_[i].hash);
    if (c == no_cell || mesh_->marked(c)) fail("another rank has deleted a cell that is not held, or one twice");
    mesh_->mark(c);
    leaving_[i].cell = c;
  }
  for (const auto& [c, hash] : leaving_) {
    const CellRecord<D>& k = mesh_->cell(c);
    for (int f = 0; f <= D; ++f) {
      const Link beyond = k.links[static_cast<std::size_t>(f)];
      if (!beyond || mesh_->marked(beyond.cell())) continue;
      rim_.push_back({face_of(k.vertices, f), beyond});
      mesh_->cell(beyond.cell()).links[static_cast<std::size_t>(beyond.face())] = Link::not_held();
    }
  }
  std::sort(rim_.begin(), rim_.end(), [](const RimFace& a, const RimFace& b) { return a.vertices < b.vertices; });
  for (const auto& [c, hash] : leaving_) {
    cells_.erase(hash, index(c));
    mesh_->free_cell(pools_, c);
  }
}

/// Makes the cells, with the links between them.
template <int D>
std::vector<CellId> HeldMesh<D>::make(const SentCells<D>& cells, std::span<const VertexId> vertices) {
  std::vector<CellId> made;
  made.reserve(cells.made.size());
  auto constraints = cells.constraints.begin();
  for (const SentCell<D>& sent : cells.made) {
    const CellId c = mesh_->new_cell(pools_, sent.region);
    made.push_back(c);
    mesh_->set_vertices(c, local(sent.vertices, vertices));
    mesh_->set_sphere(c);
    if (sent.has_constraints != 0) {
      mesh_->ensure_constraints(pools_, c) = *constraints++;
      mesh_->enlist(c);
    }
    share(c);
  }
  enter_cells();
  for (std::size_t i = 0; i < made.size(); ++i)
    for (std::size_t f = 0; f <= D; ++f) {
      const Link link = Link::from_code(cells.made[i].links[f]);
      mesh_->cell(made[i]).links[f] = link ? Link(made[index(link.cell())], link.face()) : link;
    }
  return made;
}

/// Links the cell to one that stayed, if there is one.
template <int D>
void HeldMesh<D>::link_at_rim(CellId c, int face) {
  const auto key = face_of(mesh_->cell(c).vertices, face);
  const auto at = std::lower_bound(rim_.begin(), rim_.end(), key, [](const RimFace& a, const auto& b) { return a.vertices < b; });
  if (at == rim_.end() || at->vertices != key) return;
  mesh_->cell(c).links[static_cast<std::size_t>(face)] = at->beyond;
  mesh_->cell(at->beyond.cell()).links[static_cast<std::size_t>(at->beyond.face())] = Link(c, face);
}

template <int D>
bool HeldMesh<D>::apply(const SentConstraints<D>& changed, std::span<const SentVertex<D>> vertices) {
  Vertices v;
  for (std::size_t i = 0; i < v.size(); ++i) {
    v[i] = find_vertex(point_of(vertices[changed.vertices[i]].point));
    if (v[i] == no_vertex) return false;
  }
  const CellId c = find_anywhere(v);
  if (c == no_cell) return false;
  ConstraintRecord<D>& own = mesh_->ensure_constraints(pools_, c);
  const ConstraintRecord<D>& k = changed.constraints;  // of which none goes while the cell stays
  for (int f = 0; f <= D; ++f)
    if (k.has_face(f)) own.set_face(f, k.face_entity[static_cast<std::size_t>(f)]);
  for (std::uint32_t f = 0; f <= D; ++f)
    if (changed.hull_faces >> f & 1) mesh_->cell(c).links[f] = Link();
  for (std::size_t e = 0; e < k.edge_entity.size(); ++e)
    if (k.has_edge(static_cast<int>(e))) own.set_edge(static_cast<int>(e), k.edge_entity[e]);
  return true;
}

/// Such cells are few, and need not be in the table.
template <int D>
CellId HeldMesh<D>::find_anywhere(const Vertices& vertices) const {
  if (const CellId c = find_cell(vertices, hash_of(vertices)); c != no_cell) return c;
  for (std::uint32_t i = 0; i < mesh_->cell_bound(); ++i)
    if (mesh_->alive(CellId{i}) && are_same(mesh_->cell(CellId{i}).vertices, vertices)) return CellId{i};
  return no_cell;
}

template <int D>
void HeldMesh<D>::drop(CellId c) {
  for (const Link link : mesh_->cell(c).links)
    if (link && mesh_->alive(link.cell()))
      mesh_->cell(link.cell()).links[static_cast<std::size_t>(link.face())] = Link::not_held();
  mesh_->free_cell(pools_, c);
}

template <int D>
SentCells<D> HeldMesh<D>::own_beyond(int rank) const {
  std::vector<CellId> chosen;
  for (std::uint32_t i = 0; i < mesh_->cell_bound(); ++i) {
    const CellId c{i};
    if (!mesh_->alive(c) || !is_own(c)) continue;
    bool is_held = false;
    for (const VertexId v : mesh_->cell(c).vertices) is_held = is_held || territory_->holds(zone(v), rank);
    if (!is_held) chosen.push_back(c);
  }
  CellWriter<D> writer(*mesh_, chosen.size());
  for (const CellId c : chosen) writer.add_made(c);
  return writer.take();
}

template <int D>
void HeldMesh<D>::add(const SentCells<D>& cells) {
  make(cells, vertices_of(cells));
}

template <int D>
void HeldMesh<D>::complete() {
  rim_.clear();
  for (std::uint32_t i = 0; i < mesh_->cell_bound(); ++i) {
    if (!mesh_->alive(CellId{i})) continue;
    const CellRecord<D>& k = mesh_->cell(CellId{i});
    for (int f = 0; f <= D; ++f)
      if (k.links[static_cast<std::size_t>(f)] == Link::not_held()) rim_.push_back({face_of(k.vertices, f), Link(CellId{i}, f)});
  }
  std::sort(rim_.begin(), rim_.end(), [](const RimFace& a, const RimFace& b) { return a.vertices < b.vertices; });
  for (std::size_t i = 0; i < rim_.size(); i += 2) {
    if (i + 1 == rim_.size() || rim_[i].vertices != rim_[i + 1].vertices) fail("no rank has a cell beyond a face");
    const Link a = rim_[i].beyond, b = rim_[i + 1].beyond;
    mesh_->cell(a.cell()).links[static_cast<std::size_t>(a.face())] = b;
    mesh_->cell(b.cell()).links[static_cast<std::size_t>(b.face())] = a;
  }
  std::vector<RimFace>().swap(rim_);
}

/// With their vertices: those of cells that nobody else holds are not in the table yet.
template <int D>
void HeldMesh<D>::find_all() {
  cells_.clear();
  for (std::uint32_t i = 0; i < mesh_->cell_bound(); ++i) {
    if (!mesh_->alive(CellId{i})) continue;
    const auto& vertices = mesh_->cell(CellId{i}).vertices;
    for (const VertexId v : vertices) enter(v);
    cells_.insert(hash_of(vertices), i);
  }
}

template <int D>
CellId HeldMesh<D>::find(const SentPoints<D>& points) const {
  Vertices v;
  for (std::size_t i = 0; i < v.size(); ++i) {
    v[i] = find_vertex(point_of(points[i]));
    if (v[i] == no_vertex) return no_cell;
  }
  return find_anywhere(v);
}

template class HeldMesh<2>;
template class HeldMesh<3>;

}  // namespace pgdr::detail
