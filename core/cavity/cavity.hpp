// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// One insertion (Bowyer-Watson) in its phases: collect and judge read, commit writes. Giving up before commit is free.
//
// The cavity is the set of cells in conflict with the new point p that are reached from a seed without crossing a constrained
// face. The part of the facet (2D: segment) that p lies on may be crossed: of a subfacet in that part the cells on both sides are
// taken as soon as one of them is in conflict. Then the cavity is cut back, by exact orientation, to its largest star-shaped
// part. The cells next to the split entity, or the seed, are never given up.
//
// Ownership is part of collect: a cell in conflict that the visit does not own ends the attempt before any neighbour of it is
// read, and walks round a ridge step from owned cells only (visit_area.hpp).
//
// Threads: a Cavity is part of a worker, one thread at a time. It is reused from insertion to insertion.
#pragma once

#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "mesh/key_set.hpp"
#include "mesh/mesh.hpp"
#include "mesh/ridge.hpp"
#include "mesh/vertex_claim.hpp"
#include "mesh/visit_area.hpp"
#include "numbers/simplex_shapes.hpp"
#include "rule/cell_bounds.hpp"
#include "rule/twins.hpp"

namespace pgdr {

/// The cavity of one insertion: the cells that it deletes and makes. One thread at a time.
template <int D>
class Cavity {
 public:
  using Pools = typename Mesh<D>::Pools;  ///< of the worker
  /// A face of the cavity's boundary, seen from inside.
  struct BoundaryFace {
    CellId cell;  ///< inside
    int face;     ///< opposite this vertex of the cell
  };
  /// A subfacet (2D: subsegment) that the insertion splits, seen from one side.
  struct PartFace {
    CellId cell;      ///< on that side
    int face;         ///< opposite this vertex of the cell
    EntityId entity;  ///< the facet (2D: segment)
  };
  /// May the point go in, as far as the last step could tell? Else why not.
  enum class Status {
    ok,               ///< it may
    not_in_conflict,  ///< the rounded point does not lie in the seed's circumsphere
    not_star_shaped,  ///< a cell that must go cannot be seen from the point
    duplicate,        ///< the point is a vertex already
    loses_entity,     ///< a vertex or a subsegment would vanish
    not_owned,        ///< the visit's claim is too small
    too_near,         ///< a vertex is nearer than the demand allows
    stopped,          ///< the FaceWatch ended it
  };
  /// An observer, who is shown the constrained faces that bound the cavity as they are found.
  class FaceWatch {
   public:
    virtual bool stops_at(CellId c, int face) = 0;  ///< true: ends collect()

   protected:
    ~FaceWatch() = default;
  };

  /// Both outlive it. `domain` may be null where no insertion splits a facet.
  explicit Cavity(Mesh<D>& mesh, const Domain<D>* domain = nullptr) : mesh_(&mesh), domain_(domain) {}
  ~Cavity() {
    seen_ = nullptr;
    release();
  }
  /// What the visit may change; null: everything.
  void set_area(const VisitArea<D>* area) { area_ = area; }
  /// The same, for a visit that claims ranges of vertices. @pre no area is set
  void set_claim(const VertexClaim<D>* claim) { claim_ = claim; }
  /// A list that gets the cells that were collected and given up, with repetitions; null: none.
  void set_seen(std::vector<CellId>* seen) { seen_ = seen; }
  Cavity(const Cavity&) = delete;
  Cavity& operator=(const Cavity&) = delete;

  // ---- collect -----------------------------------------------------------------------------------------------------
  /// Collects for a point in the volume. The seed must be in conflict with it.
  Status collect(const Point<D>& p, CellId seed, FaceWatch* watch = nullptr);
  /// Collects for a point on the facet (2D: segment) that the constrained face belongs to, inside the face's circumcircle.
  Status collect_on_face(const Point<D>& p, CellId cell, int face);
  /// 3D: collects for a point on the subsegment that is edge `edge` of `cell`. Ends as soon as a vertex is nearer than `least`.
  /// If the point is that of `place`, its twins may be nearer.
  Status collect_on_edge(const Point<D>& p, CellId cell, int edge, double least = 0,
                         const SplitPlace* place = nullptr) requires(D == 3);

  /// Do the filters show that all of it is star-shaped about the point, which then lies in it? @pre collect() said ok
  bool surely_star_shaped();
  /// Cuts back to the star-shaped part. @pre one of the collect functions said ok
  Status make_star_shaped();
  /// Cuts back further where a subsegment would vanish, if that keeps it; else, and if a vertex would vanish, loses_entity.
  /// Needed for cavities that are cut back or next to constraints; costs a pass over all cells.
  Status keep_entities();

  // ---- what was collected ------------------------------------------------------------------------------------------
  const Point<D>& point() const { return point_; }                         ///< the point to be inserted
  const std::vector<CellId>& cells() const { return cells_; }              ///< the cells to be deleted
  const std::vector<BoundaryFace>& boundary() const { return boundary_; }  ///< their outer faces, but those of the part
  const std::vector<PartFace>& part() const { return part_; }  ///< what it splits of the facet (2D: segment) that the point is on
  CellId near_cell() const { return near_cell_; }  ///< a cell of it with a vertex too near. @pre a collect function said too_near
  bool cut_back() const { return cut_back_; }      ///< has it given cells back?
  bool touches_constraints() const { return touches_constraints_; }  ///< has a cell of it constraints?

  // ---- looking round -----------------------------------------------------------------------------------------------
  /// May the visit change the cell?
  bool owns(CellId c) const { return claim_ ? claim_->owns(mesh_->cell(c).vertices) : !area_ || area_->owns(*mesh_, c); }
  /// The other constrained face of `entity` at the ridge of face `face` of `cell` that leaves out vertex `corner`. Walks round
  /// the ridge, first the one way, then (where that ends at the hull) the other. `owned` becomes false where the walk would have
  /// to step on from a cell that the visit does not own.
  Link entity_face_round_ridge(CellId cell, int face, int corner, EntityId entity, bool& owned) const;

  // ---- commit ------------------------------------------------------------------------------------------------------
  /// Writes the star of the new vertex, and marks the new subfacets and subsegments of its entity. @returns the vertex
  VertexId commit(Pools& pools, Home home, float relaxed_radius) {
    const VertexId v = mesh_->new_vertex(pools, point_, home, relaxed_radius);
    commit(pools, v);
    return v;
  }
  /// The same for a vertex that is there, at the point, in no cell.
  void commit(Pools& pools, VertexId v);
  /// The cells made by the last commit.
  const std::vector<CellId>& new_cells() const { return new_cells_; }
  /// The shape of the i-th new cell.
  CellShape shape_of_new(std::size_t i) const { return shape_of_new(i, sphere_of_new(i)); }
  /// The shape of the i-th new cell, given its circumsphere.
  CellShape shape_of_new(std::size_t i, const FilterSphere<D>& sphere) const {
    const ShapeBlock<D>& block = shapes_[i / shape_lanes];
    const std::size_t lane = i % shape_lanes;
    const auto [low, high] = mesh_->squared_radius_bounds(sphere);
    return {block.shortest_edge_squared[lane], low, high, block.det[lane], block.det_error[lane]};
  }
  /// The circumsphere of the i-th new cell. @pre it is no ghost
  FilterSphere<D> sphere_of_new(std::size_t i) const {
    if constexpr (D == 3)
      return mesh_->sphere(new_cells_[i]);
    else
      return computed_sphere(i);
  }

  /// Gives up what was collected. Free.
  void release();

 private:
  void begin(const Point<D>& p);
  void note_seen() const {
    if (seen_) seen_->insert(seen_->end(), cells_.begin(), cells_.end());
  }
  void take(CellId c) {
    if (!mesh_->marked(c)) take_unmarked(c);
  }
  void take_unmarked(CellId c) {
    assert(owns(c) && !mesh_->marked(c));
    mesh_->mark(c);
    cells_.push_back(c);
    for (const Link next : mesh_->cell(c).links) mesh_->prefetch(next.cell());
  }
  /// Does the visit own a cell in conflict with the point, across a face of an owned cell? All its vertices but one are in the
  /// claim. In 3D this one is mostly known to be, as it is within a diameter of the cell's circumball from the point.
  bool owns_next(Link next) const {
    const CellId c = next.cell();
    if (claim_) return claim_->owns(mesh_->cell(c).vertices);
    if (D == 3 && 4 * mesh_->squared_radius_bounds(c).second < squared_depth_) return true;
    return !area_ || area_->owns(mesh_->point(mesh_->cell(c).vertices[next.face()]));
  }
  bool may_read(CellId c) const {  ///< for assertions
    return claim_ ? claim_->may_read(mesh_->cell(c).vertices) : !area_ || area_->may_read(*mesh_, c);
  }
  bool owns_point() const { return !area_ || area_->owns(point_); }
  Status collect_all();
  Status take_fan(CellId cell, int edge);  // in 3D; no constraint, which Clang before 16 does not see satisfied
  Status grow_part();
  Status add_part_face(CellId cell, int face, EntityId entity);
  bool in_part(CellId cell, int face) const {
    const auto* k = mesh_->constraints(cell);
    return k && (k->part >> face & 1);
  }
  Status grow();
  bool has_corner_too_near(CellId c);
  bool is_too_near(const VertexRecord<D>& v) const;
  void rebuild_boundary();
  void look_at_shapes();
  bool visible(std::size_t i) const;
  bool visible_exactly(const BoundaryFace& f) const;
  FilterSphere<D> computed_sphere(std::size_t i) const;
  void set_spheres();
  bool in_line(CellId c, int i, int j) const;
  bool is_subsegment(CellId cell, int i, int j) const;
  Status find_broken_fans(std::vector<CellId>& doomed) const;
  void find_turned_over(std::vector<CellId>& doomed) const;
  bool is_turned_over(const PartFace& f, int corner) const;
  bool is_corner_of_other(std::size_t i, int corner) const;
  bool is_rim(const PartFace& f, VertexId a, VertexId b) const;
  Status look_at_fan(RidgeWalk<D> walk, EntityId entity, bool& broken) const;
  Status find_lost_entities(std::vector<CellId>& behind);
  template <class Rim>
  Status find_lost_entities(Rim rim, std::vector<CellId>& behind) const;
  bool has_subsegments() const;
  void find_behind(VertexId a, VertexId b, std::vector<CellId>& behind) const;
  bool peel(std::vector<CellId>& doomed);
  Status drop_cells(std::vector<CellId>& doomed);
  bool is_whole(const PartFace& f) const;
  bool part_is_whole() const;
  void keep_whole_part_faces();
  void keep_connected_cells();
  void clear_part_bits();
  void make_cells(Pools& pools, VertexId v);
  void inherit_constraints(Pools& pools, const BoundaryFace& f, CellId c);
  void link_by_ridges();
  void link_by_numbers();
  void link_shared_slots();
  void link_by_walks(Pools& pools);
  void mark_split_entities(Pools& pools, VertexId v);

  Mesh<D>* mesh_;
  const Domain<D>* domain_;
  const VisitArea<D>* area_ = nullptr;
  const VertexClaim<D>* claim_ = nullptr;
  std::vector<CellId>* seen_ = nullptr;
  Point<D> point_;
  double squared_depth_ = 0;  ///< VisitArea::squared_depth of the point
  FaceWatch* watch_ = nullptr;
  double least_ = 0;                   ///< distance that vertices must have from the point
  const SplitPlace* place_ = nullptr;  ///< a place whose twins may be nearer; null: none
  CellId near_cell_{0xffffffffu};
  std::vector<CellId> cells_, new_cells_;
  std::vector<CellId> protected_;
  std::vector<BoundaryFace> boundary_;
  std::vector<SimplexBlock<D>> prospects_;  ///< the cells that the boundary faces make with the point, in their order
  std::vector<ShapeBlock<D>> shapes_;       ///< of the prospects; none of faces at infinity
  bool shapes_known_ = false;               ///< are the shapes those of the boundary as it is?
  bool star_shaped_ = false;                ///< did make_star_shaped() find the boundary as it is star-shaped?
  std::vector<PartFace> part_;
  /// A ridge of the part's rim, which gets a new constrained face of this entity with the new vertex.
  struct RimRidge {
    std::array<VertexId, D - 1> ridge;  // sorted
    EntityId entity;
  };
  std::vector<RimRidge> rim_;
  KeySet rim_keys_;
  struct NewFace {
    std::uint32_t code;  ///< Link
    std::uint32_t slot;
  };
  std::vector<NewFace> new_faces_;  ///< of new cells, at the ridges of the boundary
  /// New faces whose slot in the table is not one pair's alone: their vertices but the new one, sorted, and links to them.
  std::vector<std::pair<std::array<VertexId, D + 1>, std::uint32_t>> shared_slots_;
  PairTable ridges_;
  SmallNumbers numbers_;  ///< of the vertices of a small boundary
  /// Links to its new faces, by the numbers of the ends of their ridges in order (2D: of the one end, and which it is).
  std::array<Link, SmallNumbers::bound*(D == 3 ? SmallNumbers::bound : 2)> links_at_;
  /// A link of a new cell, and where that across it is found.
  struct OpenLink {
    Link* link;
    std::uint32_t other;
  };
  /// Faces of a small boundary. (A sphere of F triangles has F / 2 + 2 vertices.)
  static constexpr std::size_t most_numbered = (D == 3 ? 2 : 1) * 39;
  std::array<OpenLink, most_numbered * D> open_links_;
  std::array<VertexId, 2> split_edge_{no_vertex, no_vertex};  // 3D: the subsegment being split
  EntityId split_segment_ = no_entity;
  bool cut_back_ = false, touches_constraints_ = false;
};

/// The cavity's vertex nearest to its point, but for the excluded ones (ties: lexicographically first); no_vertex if none.
template <int D>
VertexId nearest_vertex(const Mesh<D>& mesh, const Cavity<D>& cavity, std::span<const VertexId> excluded);
/// Distance from the cavity's point to its nearest vertex.
template <int D>
double insertion_radius(const Mesh<D>& mesh, const Cavity<D>& cavity, std::span<const VertexId> excluded = {});

/// The largest float that is not above v.
inline float rounded_down(double v) {
  const float f = static_cast<float>(v);
  return static_cast<double>(f) > v ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}

extern template class Cavity<2>;
extern template class Cavity<3>;

}  // namespace pgdr
