// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The mesh while it is refined: flat arrays of vertices and cells, which grow without moving (small ones move once: leave_heap).
// In 3D a cell is one cache line: its vertices, links to its neighbours, and its circumsphere, which answers nearly every
// in-sphere question without touching a vertex. In 2D a cell is half a cache line, without a circumcircle. Constrained faces and
// edges are marked on the cells that contain them, in side records of the few cells that have any.
//
// Ghosts: until the exterior is carved away, cells at `infinite_vertex` fill the complement of the convex hull.
// Threads: elements carry no lock. A cell is written by the visit that owns it, and by no other (visit_area.hpp).
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include "mesh/change_log.hpp"
#include "mesh/ids.hpp"
#include "mesh/pinched_edges.hpp"
#include "mesh/pool.hpp"
#include "numbers/corners.hpp"
#include "pgdr/circumsphere.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/predicates.hpp"
#include "pgdr/types.hpp"

namespace pgdr {
namespace detail {
class Bulk;
template <int D>
class Renumbering;
}

inline constexpr VertexId infinite_vertex{0xfffffffeu};  ///< the vertex at infinity, which all ghosts have

/// A face seen from a cell: the cell beyond it and the number of the same face there; or nothing; or a cell that this part of a
/// mesh does not hold.
struct Link {
  std::uint32_t code = 0xffffffffu;  ///< cell and face, packed; all ones: nothing

  Link() = default;
  Link(CellId cell, int face) : code(index(cell) << 2 | static_cast<std::uint32_t>(face)) {}  ///< leads to that face of that cell
  /// The link with this code.
  static Link from_code(std::uint32_t code) {
    Link l;
    l.code = code;
    return l;
  }
  /// The link to a cell that is not held.
  static Link not_held() { return from_code(0xfffffffeu); }
  explicit operator bool() const { return code < 0xfffffffeu; }  ///< does it lead to a cell?
  CellId cell() const { return CellId{code >> 2}; }              ///< the cell beyond
  int face() const { return static_cast<int>(code & 3u); }       ///< the number of the face there
  friend bool operator==(Link, Link) = default;                  ///< the same cell and face
};

/// The entity of lowest dimension that a vertex lies on, packed: two bits of EntityKind, thirty of id.
struct Home {
  std::uint32_t code = 0;  ///< kind and id

  Home() = default;
  /// `id`: of the segment or facet; of an input vertex, its domain point.
  Home(EntityKind kind, EntityId id) : code(static_cast<std::uint32_t>(kind) << 30 | (id & 0x3fffffffu)) {}
  EntityKind kind() const { return static_cast<EntityKind>(code >> 30); }  ///< vertex, segment, facet or volume
  EntityId id() const { return code & 0x3fffffffu; }  ///< of the segment or facet; of an input vertex, its domain point
  EntityRef entity() const { return {kind(), kind() == EntityKind::volume ? no_entity : id()}; }  ///< both; the volume has no id
  bool operator==(const Home&) const = default;                                                   ///< the same entity
};

/// A vertex.
template <int D>
struct VertexRecord {
  Point<D> point;  ///< where it is
  Home home;       ///< what it lies on
  /// The relaxed insertion radius R(p) of rule/insertion_rule.hpp, rounded down; infinity for input vertices.
  float relaxed_radius = std::numeric_limits<float>::infinity();
};

/// What the optimiser knows of a vertex (optimize/optimizer.hpp). All zero at first, as fresh memory is.
struct VertexNote {
  std::uint32_t version;  ///< how often the cells at it have changed
};

/// What a slot knows of its cell: the number of its side record, the mark of a cavity, and how many cells the slot has held.
template <int D>
struct alignas(D == 3 ? 8 : 2) CellTag {
  static constexpr std::uint32_t mark_bit = 1u << 31;  ///< of `get()`: the cell is marked

  std::array<std::uint16_t, 2> constraints;  ///< one number, in halves
  std::uint16_t birth;                       ///< how many cells the slot has held (Mesh::birth)

  /// The number of the side record, from 1, or 0 without one; and the mark.
  std::uint32_t get() const { return std::bit_cast<std::uint32_t>(constraints); }
  void set(std::uint32_t v) { constraints = std::bit_cast<std::array<std::uint16_t, 2>>(v); }  ///< number and mark
};

template <int D>
struct CellRecord;
/// A tetrahedron, one cache line.
template <>
struct alignas(64) CellRecord<3> {
  std::array<VertexId, 4> vertices;  ///< positively oriented; the first is no_vertex in a slot that is free
  std::array<Link, 4> links;         ///< links[i]: across the face opposite vertices[i]
  Point<3> center;                   ///< of the circumsphere, rounded
  double radius2;                    ///< squared; its lowest four bits are the level of the filter's error band
};
static_assert(sizeof(CellRecord<3>) == 64);
/// A triangle, half a cache line. Its circumcircle is not kept: its corners, which are few to read, answer as soon.
template <>
struct alignas(32) CellRecord<2> {
  std::array<VertexId, 3> vertices;  ///< positively oriented; the first is no_vertex in a slot that is free
  std::array<Link, 3> links;         ///< links[i]: across the edge opposite vertices[i]
  CellTag<2> tag;                    ///< of the slot
  std::uint16_t region;              ///< number of its region
};
static_assert(sizeof(CellRecord<2>) == 32);

/// A circumsphere as the filter of in-sphere questions has it.
template <int D>
struct FilterSphere {
  Point<D> center;  ///< rounded
  double radius2;   ///< squared; its lowest four bits are the level of the filter's error band

  /// `power_error`: as ShapeBlock has it.
  static FilterSphere of(const Point<D>& center, double squared_radius, double power_error) {
    const double band = power_error + 0x1p-46;  // a normal number: its exponent is in its bits
    const int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(band) >> 52) - 1023;
    const int level = band <= 0x1p-3 ? (47 + exponent) / 3 : 15;
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(squared_radius);
    return {center, std::bit_cast<double>((bits & ~std::uint64_t{15}) | static_cast<std::uint64_t>(level))};
  }
  /// Of one sphere with the error of its centre.
  static FilterSphere of(const Circumsphere<D>& sphere) {
    return of(sphere.center, sphere.squared_radius, 6 * sphere.center_error / std::sqrt(sphere.squared_radius));
  }
};

/// Which faces and edges of a cell are constrained, and by what. In 2D the faces are the subsegments.
template <int D>
struct ConstraintRecord {
  std::uint8_t faces = 0;                              ///< bit i: the face opposite vertex i is constrained
  std::uint8_t edges = 0;                              ///< 3D, bit e: edge e is a subsegment
  std::uint8_t part = 0;                               ///< scratch of a cavity: bit i: face i is being split
  std::array<EntityId, D + 1> face_entity{};           ///< facet (3D) or segment (2D)
  std::array<EntityId, D == 3 ? 6 : 1> edge_entity{};  ///< segment of each constrained edge, 3D

  bool has_face(int face) const { return faces >> face & 1; }  ///< is the face a subfacet (2D: subsegment)?
  bool has_edge(int edge) const { return edges >> edge & 1; }  ///< 3D: is the edge a subsegment?
  /// The face is part of this facet (2D: segment).
  void set_face(int face, EntityId entity) {
    faces |= static_cast<std::uint8_t>(1 << face);
    face_entity[face] = entity;
  }
  /// 3D: the edge is part of this segment.
  void set_edge(int edge, EntityId segment) {
    edges |= static_cast<std::uint8_t>(1 << edge);
    edge_entity[edge] = segment;
  }
};

/// The mesh: its vertices and cells by their ids, and the pools that new ones come from.
template <int D>
class Mesh {
 public:
  Mesh();  ///< with addresses for as many cells as there can be. @throws std::bad_alloc
  /// For an input of so many points. Where they are few (2D), it is small: in memory of the heap alone, since to reserve
  /// addresses takes ten times as long as to triangulate four points.
  explicit Mesh(std::size_t points);

  /// Is it small? One pool may take ids then, and make_room has to be called for it between changes.
  bool is_small() const { return is_small_; }
  /// Reserves addresses, and moves there, if it is small. @pre nobody else uses it, or has a reference to a part of it
  void leave_heap() {
    if (is_small_) reserve();
  }

  VertexRecord<D>& vertex(VertexId v) { return vertices_[index(v)]; }              ///< to be changed
  const VertexRecord<D>& vertex(VertexId v) const { return vertices_[index(v)]; }  ///< to be read
  const Point<D>& point(VertexId v) const { return vertices_[index(v)].point; }    ///< where the vertex is
  /// 3D: what the optimiser knows of the vertex. Threads: for the visit that owns the cells at it.
  VertexNote& note(VertexId v) { return notes_[index(v)]; }
  const VertexNote& note(VertexId v) const { return notes_[index(v)]; }   ///< to be read
  CellRecord<D>& cell(CellId c) { return cells_[index(c)]; }              ///< to be changed
  const CellRecord<D>& cell(CellId c) const { return cells_[index(c)]; }  ///< to be read

  /// Hints that the cell is about to be read; any id will do.
  void prefetch(CellId c) const {
    __builtin_prefetch(&cells_[index(c)]);
    if constexpr (D == 3) __builtin_prefetch(&tags_[index(c)]);
  }
  /// Hints that the vertices of whatever cell is in that slot are about to be read.
  void prefetch_vertices(CellId c) const {
    for (const VertexId& v : cell(c).vertices) prefetch(atomic(v).load(std::memory_order_relaxed));
  }
  void prefetch(VertexId v) const { __builtin_prefetch(&vertices_[index(v)]); }  ///< hints that the vertex is about to be read

  bool alive(CellId c) const { return cell(c).vertices[0] != no_vertex; }  ///< does the slot hold a cell?
  static constexpr std::uint16_t last_birth = 0xffff;                      ///< the count of a slot that holds no cell any more
  /// The number of cells that the slot has held before. Slot and birth name a cell for good, since a slot whose count is full is
  /// not used again. (A flip may bring back a cell of the same vertices: it has another slot, or another birth.) Any thread.
  std::uint16_t birth(CellId c) const { return atomic(tag(c).birth).load(std::memory_order_relaxed); }
  /// Reads the vertices of the cell that was born there; false if it is dead. Any thread: a cell that the caller does not own may
  /// die at any moment, and its slot be used by another. (Whoever reads a vertex of a later cell, or no_vertex, has seen the
  /// birth counted before it, by release and acquire: plain moves on x86.)
  bool read_vertices(CellId c, std::uint16_t born, std::array<VertexId, D + 1>& vertices) const {
    if (birth(c) != born) return false;
    for (int i = 0; i <= D; ++i) vertices[i] = atomic(cell(c).vertices[i]).load(std::memory_order_acquire);
    return birth(c) == born;
  }
  /// Puts a cell into its slot.
  void set_vertices(CellId c, const std::array<VertexId, D + 1>& vertices) {
    auto& slot = cell(c).vertices;
#pragma GCC unroll 4
    for (int i = 0; i <= D; ++i) atomic(slot[i]).store(vertices[i], std::memory_order_release);
  }
  /// Is the cell a ghost, beyond the hull?
  bool is_ghost(CellId c) const {
    for (const VertexId v : cell(c).vertices)
      if (v == infinite_vertex) return true;
    return false;
  }
  /// Where these vertices are, in their order.
  template <std::size_t N>
  std::array<Point<D>, N> points(const std::array<VertexId, N>& vertices) const {
    std::array<Point<D>, N> p;
    for (std::size_t i = 0; i < N; ++i) p[i] = point(vertices[i]);
    return p;
  }
  /// The points of the cell's vertices, in its order.
  Simplex<D> simplex(CellId c) const { return points(cell(c).vertices); }

  // Marks: of the cells of a cavity that is being collected, for example. Threads: for the visit that owns the cell.
  bool marked(CellId c) const { return tag(c).get() & mark_bit; }  ///< is the cell marked?
  void mark(CellId c) { tag(c).set(tag(c).get() | mark_bit); }     ///< marks the cell
  void unmark(CellId c) { tag(c).set(tag(c).get() & ~mark_bit); }  ///< takes the mark off

  /// The constraints of c, to be changed; null if none of its faces or edges is constrained.
  ConstraintRecord<D>* constraints(CellId c) {
    const std::uint32_t id = tag(c).get() & ~mark_bit;
    return id == 0 ? nullptr : &constraints_[id - 1];
  }
  const ConstraintRecord<D>* constraints(CellId c) const { return const_cast<Mesh*>(this)->constraints(c); }  ///< to be read
  /// Is the face a subfacet (2D: subsegment)?
  bool constrained(CellId c, int face) const {
    const auto* k = constraints(c);
    return k && k->has_face(face);
  }
  /// The facet (2D: segment) that the face is part of. @pre constrained(c, face)
  EntityRef entity_of_face(CellId c, int face) const {
    return {D == 3 ? EntityKind::facet : EntityKind::segment, constraints(c)->face_entity[face]};
  }
  /// 3D: is the edge a subsegment?
  bool is_subsegment(CellId c, int edge) const {
    const auto* k = constraints(c);
    return k && k->has_edge(edge);
  }
  /// The number of the cell's region.
  std::uint16_t region(CellId c) const {
    if constexpr (D == 2)
      return cell(c).region;
    else
      return several_regions_ ? regions_[index(c)] : std::uint16_t{0};
  }
  /// Threads: for the visit that owns the cell; but one thread alone sets the first region other than 0.
  void set_region(CellId c, std::uint16_t r) {
    if constexpr (D == 2) {
      cell(c).region = r;
    } else {
      if (r != 0 && !several_regions_) several_regions_ = true;
      if (several_regions_) regions_[index(c)] = r;
    }
  }

  /// 3D: stores the circumsphere, the filter of `conflicts`. Ghosts have set_ghost_sphere().
  void set_sphere(CellId c, const FilterSphere<D>& sphere) {
    if constexpr (D == 3) {
      cell(c).center = sphere.center;
      cell(c).radius2 = sphere.radius2;
    }
  }
  /// 3D: computes and stores the circumsphere.
  void set_sphere(CellId c) {
    if constexpr (D == 3) set_sphere(c, FilterSphere<D>::of(circumsphere<D>(simplex(c))));
  }
  /// 3D: stores a sphere that decides nothing, so that the exact test is asked.
  void set_ghost_sphere(CellId c) {
    if constexpr (D == 3) cell(c).radius2 = std::numeric_limits<double>::quiet_NaN();
  }
  /// The circumsphere: in 3D the stored one, in 2D it is computed. @pre the cell is no ghost
  FilterSphere<D> sphere(CellId c) const {
    if constexpr (D == 3)
      return {cell(c).center, cell(c).radius2};
    else
      return FilterSphere<D>::of(circumsphere<D>(simplex(c)));
  }
  Point<D> center(CellId c) const { return sphere(c).center; }  ///< the circumcentre, rounded

  /// Exactly: is p inside the (perturbed) circumsphere of c? For a ghost: beyond its hull face, or in that face's plane
  /// and inside the sphere of the cell behind it. p must not be a vertex of c.
  bool conflicts(CellId c, const Point<D>& p) const {
    const CellRecord<D>& k = cell(c);
    if constexpr (D == 3) {
      const double d2 = squared_distance(k.center, p);
      const Band& band = bands[band_level(k.radius2)];
      if (d2 < k.radius2 * band.inner) return true;
      if (d2 > k.radius2 * band.outer) return false;
    } else {
      const auto& v = k.vertices;
      if (v[0] != infinite_vertex && v[1] != infinite_vertex && v[2] != infinite_vertex)
        if (const Sign side = in_circle_quickly(point(v[0]), point(v[1]), point(v[2]), p); side != Sign::zero)
          return side == Sign::positive;
    }
    return conflicts_exactly(c, p);
  }

  /// Bounds of the exact squared circumradius, from the rounded one.
  static std::pair<double, double> squared_radius_bounds(const FilterSphere<D>& sphere) {
    const Band& band = bands[band_level(sphere.radius2)];
    return {sphere.radius2 * band.inner, sphere.radius2 * band.outer};
  }
  std::pair<double, double> squared_radius_bounds(CellId c) const { return squared_radius_bounds(sphere(c)); }  ///< of the cell
  /// Is the centre good enough to be a Steiner point: off by less than 2^-22 of the radius?
  static bool is_accurate(const FilterSphere<D>& sphere) { return band_level(sphere.radius2) < first_inaccurate_level; }

  /// Above the ids of all cells; `alive` tells which of the ids below have one.
  std::uint32_t cell_bound() const { return cell_source_.bound(); }
  /// There are no more cells with constraints than that. Any thread.
  std::uint32_t constraint_bound() const { return constraint_source_.bound(); }
  /// Above the ids of all vertices; some below may be in no cell, or unused.
  std::uint32_t vertex_bound() const { return vertex_source_.bound(); }

  // For compaction, which takes apart a mesh that nobody needs any more.
  /// Where the record of the slot is.
  std::byte* memory_of(CellId c) { return reinterpret_cast<std::byte*>(&cells_[index(c)]); }
  /// Gives back most of the memory of the cells numbered [first, last), but for the first `kept` bytes.
  void discard_cells(std::uint32_t first, std::uint32_t last, std::size_t kept) { cells_.discard(first, last, kept); }
  /// Gives back the memory of the tags of all cells.
  void discard_tags() {
    if constexpr (D == 3) tags_.discard(0, cell_bound());
  }
  /// Gives back the memory of all vertices.
  void discard_vertices() {
    vertices_.discard(0, vertex_bound());
    if constexpr (D == 3) notes_.discard(0, vertex_bound());
  }

  /// The pages of so many more cells and vertices, in pieces of a huge page, for touch_pages(): whoever used them first would
  /// wait for the kernel. @pre nobody makes cells or vertices meanwhile. @throws std::bad_alloc
  std::vector<std::span<std::byte>> fresh_pages(std::uint64_t cells, std::uint64_t vertices);

  /// The pools of one thread.
  struct Pools {
    IdPool cells;                 ///< ids of cells
    IdPool vertices;              ///< ids of vertices
    IdPool constraints;           ///< numbers of side records
    ChangeLog<D>* log = nullptr;  ///< where to log the cells that are freed and made; null: nowhere

    /// Takes over what other pools of the same mesh have.
    void absorb(Pools&& other) {
      cells.absorb(std::move(other.cells));
      vertices.absorb(std::move(other.vertices));
      constraints.absorb(std::move(other.constraints));
    }
  };
  /// Leaves the heap if the next change could need more than there is. @pre as of leave_heap; all ids were taken from these pools
  void make_room(const Pools& pools) {
    if (is_small_ && pools.cells.next() > most_used_slots) reserve();
  }
  /// The pools of one more thread.
  Pools make_pools() { return {IdPool(cell_source_), IdPool(vertex_source_), IdPool(constraint_source_), nullptr}; }

  /// A fresh slot without constraints, for set_vertices().
  CellId new_cell(Pools& pools, std::uint16_t region = 0) {
    const std::uint32_t id = pools.cells.take();
    assert(tag(CellId{id}).get() == 0);
    set_region(CellId{id}, region);
    if (pools.log) pools.log->add_made(CellId{id}, birth(CellId{id}));
    return CellId{id};
  }
  /// Frees the cell and its constraints, and takes off its mark.
  void free_cell(Pools& pools, CellId c) {
    CellTag<D>& slot = tag(c);
    if (pools.log) pools.log->add_freed(c, birth(c), cell(c).vertices);
    if (const std::uint32_t id = slot.get() & ~mark_bit) {
      if (pinched_) change_pinched(c, false);
      pools.constraints.give(id - 1);
    }
    slot.set(0);
    const auto next = static_cast<std::uint16_t>(birth(c) + 1);
    atomic(slot.birth).store(next, std::memory_order_relaxed);
    // After the birth: whoever reads no_vertex then sees that the cell is another one (read_vertices).
    atomic(cell(c).vertices[0]).store(no_vertex, std::memory_order_release);
    if (next != last_birth) pools.cells.give(index(c));
  }
  VertexId new_vertex(Pools& pools, const Point<D>& p, Home home, float relaxed_radius);  ///< a vertex that no cell has yet
  /// The constraints of c, made if it has none yet.
  ConstraintRecord<D>& ensure_constraints(Pools& pools, CellId c);
  /// Makes the face, on the side of c, a part of this facet (2D: segment).
  void constrain_face(Pools& pools, CellId c, int face, EntityId entity) { ensure_constraints(pools, c).set_face(face, entity); }
  /// 3D: makes the edge, in c, a part of this segment.
  void constrain_edge(Pools& pools, CellId c, int edge, EntityId segment) {
    ensure_constraints(pools, c).set_edge(edge, segment);
  }

  /// 3D, once the exterior is gone: finds the pinched edges, and lists the cells at them from now on (pinched_edges.hpp). Whoever
  /// makes a cell then calls `enlist` when its constraints are there.
  void find_pinched_edges(std::size_t segments, const detail::Bulk& bulk);
  /// Lists a new cell at the pinched edges that it has. Its constraints must be there.
  void enlist(CellId c) {
    if (pinched_) change_pinched(c, true);
  }
  /// Null: there are no pinched edges.
  const PinchedEdges* pinched_edges() const { return pinched_.get(); }

 private:
  friend class detail::Renumbering<D>;
  static constexpr std::uint32_t mark_bit = CellTag<D>::mark_bit;

  template <class T>
  static std::atomic_ref<T> atomic(const T& v) {
    return std::atomic_ref<T>(const_cast<T&>(v));
  }
  struct Band {
    double inner, outer;
  };
  static const std::array<Band, 16> bands;  ///< by level
  static int band_level(double radius2) { return static_cast<int>(std::bit_cast<std::uint64_t>(radius2) & 15); }
  static constexpr int first_inaccurate_level = 9;

  bool conflicts_exactly(CellId c, const Point<D>& p) const;
  void change_pinched(CellId c, bool add);

  std::unique_ptr<PinchedEdges> pinched_;
  CellTag<D>& tag(CellId c) {
    if constexpr (D == 3)
      return tags_[index(c)];
    else
      return cell(c).tag;
  }
  const CellTag<D>& tag(CellId c) const { return const_cast<Mesh*>(this)->tag(c); }
  void reserve();
  void grow_cells_to(std::uint32_t n);
  void grow_vertices_to(std::uint32_t n);

  static constexpr std::uint32_t small_slots = IdSource::block;  ///< of each array of a small mesh
  /// From so many slots on that were ever used a small mesh makes room. One change of a triangulation of n triangles makes n + 2
  /// at most, as the rim of a cavity of n has n + 2 edges, before it frees any; entries of the work lists take two changes, the
  /// second of which has what the first has freed.
  static constexpr std::uint32_t most_used_slots = small_slots / 2 - 16;

  std::uint32_t capacity_ = 0;
  bool is_small_ = false;
  ReservedArray<CellRecord<D>> cells_;
  ReservedArray<CellTag<D>> tags_;        ///< 3D
  ReservedArray<std::uint16_t> regions_;  ///< 3D; takes memory only once there are several
  bool several_regions_ = false;
  ReservedArray<VertexRecord<D>> vertices_;
  ReservedArray<VertexNote> notes_;  ///< 3D; takes memory only once there are any
  ReservedArray<ConstraintRecord<D>> constraints_;
  IdSource cell_source_, vertex_source_, constraint_source_;
};

/// The order of two cells by the points of their vertices, which slots have no part in: below 0 if a comes before b, 0 if it is
/// b.
template <int D>
int compare_vertices(const Mesh<D>& mesh, CellId a, CellId b) {
  const auto &u = mesh.cell(a).vertices, &v = mesh.cell(b).vertices;
  for (int i = 0; i <= D; ++i)
    if (u[i] != v[i]) return lex_less<D>(mesh.point(u[i]), mesh.point(v[i])) ? -1 : 1;
  return 0;
}

extern template class Mesh<2>;
extern template class Mesh<3>;

}  // namespace pgdr
