// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Delaunay refinement of one region: encroached subsegments first, then subfacets, then poor elements, those that are too
// big by buckets of a factor of two of the circumradius, largest first, then those of poor shape, shortest edge first
// (work_list.hpp; dissertation, sections 2.1, 3.4).
// The whole mesh refined as one region is the sequential algorithm.
//
// Every run ends, whatever the input angles: see insertion_rule.hpp. What is refused stays, and elements that stay poor
// name the two input entities that meet at the small angle (poor_reasons.hpp).
#pragma once

#include <atomic>
#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "cavity/cavity.hpp"
#include "change/flips.hpp"
#include "change/vertex_move.hpp"
#include "mesh/key_set.hpp"
#include "mesh/slot_set.hpp"
#include "mesh/visit_area.hpp"
#include "pgdr/refine_options.hpp"
#include "refine/refusal_memo.hpp"
#include "refine/work_list.hpp"
#include "rule/cell_bounds.hpp"
#include "rule/insertion_rule.hpp"
#include "rule/shells.hpp"
#include "rule/twins.hpp"

namespace pgdr {

template <int D>
struct Improvement;

/// What was done, in one visit or in all.
struct RefineCounts {
  std::uint64_t committed = 0;         ///< insertions
  std::uint64_t improved = 0;          ///< changes for elements that stay poor, insertions among them
  std::uint64_t refused = 0;           ///< entries that the insertion rule refused
  std::uint64_t selector_outside = 0;  ///< points of the selector outside their disk

  /// Adds each.
  RefineCounts& operator+=(const RefineCounts& o) {
    committed += o.committed;
    improved += o.improved;
    refused += o.refused;
    selector_outside += o.selector_outside;
    return *this;
  }
};

/// What all visits of a run share. The atomics alone change during a generation; they tell a visit to end and count for
/// the progress report, and decide nothing else.
template <int D>
struct RefineContext {
  /// `start`: when the caller's time limit began to run.
  RefineContext(Mesh<D>& m, const Domain<D>& d, const RefineOptions<D>& o, CellBounds<D> b, std::uint64_t vertices_so_far,
                std::chrono::steady_clock::time_point start_time);

  int bucket_of(const FilterSphere<D>& sphere) const;  ///< by its radius, 0 being the largest
  /// No circumradius of this bucket or a later one is larger.
  double largest_radius(int bucket) const;
  /// Has the run been cancelled, or is its time up? It is stopped with that. Any thread.
  bool ended();

  Mesh<D>& mesh;  ///< which visits change
  const Domain<D>& domain;  ///< the input
  const RefineOptions<D>& options;  ///< as the caller gave them
  const CellBounds<D> bounds;  ///< of cells
  const std::chrono::steady_clock::time_point start;  ///< of the time limit
  /// 3D: what is poor now would stay so, and asks for c times the room. Set while no visit runs.
  bool last_resort = false;
  /// 3D: visits change the mesh for elements that stay poor, and treat nothing else (improve/improve.cpp). Set while no visit
  /// runs.
  const Improvement<D>* improvement = nullptr;
  const Shells<D> shells;  ///< none in 3D, where the front end alone splits on them
  int base_exponent = 0;  ///< of bucket 0: circumradii of the size of the domain and above
  static constexpr int buckets = 64;  ///< of circumradii

  std::atomic<int> stop{0};  ///< a StopCause other than `finished`, once there is one
  std::atomic<std::uint64_t> vertices;  ///< in all, for the progress report
  std::mutex progress_mutex;  ///< held while the caller's function runs
  std::chrono::steady_clock::time_point last_progress;  ///< under the mutex
};

/// By one change for an element that stays poor: more, of tangles, are slow and gain little.
constexpr std::size_t most_cells_changed = 100;

/// What one visit is asked to do, and what it did.
template <int D>
struct RegionVisit {
  // asked
  const VisitArea<D>* area = nullptr;   ///< null: everything
  WorkList<D>* list = nullptr;          ///< of the region
  std::vector<Entry<D>> given;          ///< set aside by earlier visits: these alone are treated, and what they bring
  bool treat_list = true;               ///< false: `given` only
  std::uint32_t level = 0;              ///< of the region in its tree, for the record
  std::uint32_t order = 1;              ///< of the claim, likewise
  std::uint64_t generation = 0;         ///< likewise
  double small_radius = 0;              ///< end once no poor element is larger ...
  std::size_t floor = 0;                ///< ... and the list is crowded by this
  int granularity = std::numeric_limits<int>::max();  ///< end this many buckets after the first
  std::uint64_t most_insertions = std::numeric_limits<std::uint64_t>::max();  ///< share of the budget
  bool violations_seen = false;         ///< look for faces that are not locally Delaunay at every insertion
  bool entities_refused = false;        ///< by any visit before; after the visit, by this one too
  // done
  /// Entries for another region.
  struct Outbox {
    std::uint32_t leaf;  ///< which
    std::vector<Entry<D>> entries;  ///< in the order in which they were found
  };
  std::vector<Outbox> outboxes;         ///< elements with their circumcentre in other regions, alive at the end
  std::vector<Entry<D>> set_aside;      ///< would have changed cells that the visit does not own
  RefineCounts counts;  ///< of this visit
  bool changed_mesh = false;  ///< by an insertion or a flip
  bool min_edge_hit = false;  ///< something was refused for `min_edge`
};

/// The workspace of a worker: one thread at a time.
template <int D>
class Refiner {
 public:
  using Pools = typename Mesh<D>::Pools;  ///< of this worker

  Refiner(RefineContext<D>& context, Pools pools);  ///< the context must outlive it

  /// Treats what waits, and what that brings forth, until nothing is left that the visit may treat or the run is stopped.
  /// @throws what a callback throws; the mesh is whole then.
  void run(RegionVisit<D>& visit);

  /// Lists what is encroached or poor at a cell that the visit owns.
  void list_cell(CellId c);
  /// Adds the faces of the cell that are not locally Delaunay. Several threads at once.
  void add_violations(CellId c, std::vector<Entry<D>>& to) const;
  /// The same where many cells are looked at: a face between two of them is decided from one, and added for both.
  void add_violations(CellId c, const SlotSet& looked_at, std::vector<Entry<D>>& to) const;
  /// Makes `visit` the one that list_cell lists for.
  void begin(RegionVisit<D>& visit);

 private:
  enum class Outcome { committed, refused, not_owned };
  using Item = Entry<D>;

  // refiner.cpp: the lists
  Item make_entry(CellId c, EntryKind kind, int which, int bucket = 0, std::uint32_t order = 0) const {
    return {c, mesh_->birth(c), kind, which, bucket, order};
  }
  bool alive(const Item& e) const { return e.alive(*mesh_); }
  std::uint64_t list_violations(std::span<const CellId> cells);
  void list_poor(CellId c, int why, const FilterSphere<D>& sphere, std::uint32_t order);
  void list_again(const Item& e) { list_poor(e.cell, e.which(), mesh_->sphere(e.cell), e.order); }
  void list_if_poor(CellId c);
  void list_new_if_poor(std::size_t i);
  std::uint32_t order_of(CellId c, const FilterSphere<D>& sphere) const;
  void list_entities(CellId c, const ConstraintRecord<D>& k);
  bool treat_entities();
  void treat(const Item& e);
  Outcome treat_poor(const Item& e);
  bool may_go_on();
  void look_at_budget();
  void record_refusal(const Item& e);
  std::vector<CellId> cells_seen(const Item& e);
  void send_abroad();

  // refine/entities.cpp: encroached entities
  bool face_encroached_by(CellId c, int face, VertexId v) const;
  Outcome split_face(const Item& e, const Demand* cause);
  Outcome split_edge(const Item& e, const Demand* cause);
  std::optional<CellId> cell_near_edge(const Item& e, const Point<D>& x, double distance, const SplitPlace* place) const;
  double distance_to_corners(CellId c, const Point<D>& x, EntityId segment, const SplitPlace* place) const;
  Outcome refuse_near(const Item& e, std::span<const VertexId> own, CellId near);
  std::optional<std::pair<Item, CellId>> refused_before(const Item& face, const Demand& cause) const;
  bool is_refused_as_before(const Item& face, const Demand& cause);
  Point<D> face_point(CellId c, int face) const;
  Point<D> split_point(EntityId s, VertexId a, VertexId b) const;
  std::array<double, 2> piece(EntityId s, VertexId a, VertexId b) const;
  bool may_be_near(EntityId s, std::span<const VertexId> own, VertexId q) const;
  std::optional<Item> encroached_edge(const Point<D>& x) const;
  std::optional<Item> edge_beyond(const Point<D>& x) const;
  struct FacetWalk {
    std::optional<Item> edge, face;
    bool owned = true;
  };
  FacetWalk walk_in_facet(const Item& e, const Point<D>& x) const;
  double angle_between(EntityRef a, EntityRef b) const;
  bool meet_below(double degrees, EntityRef a, EntityRef b) const { return angle_between(a, b) < degrees; }
  bool may_ask_for_less(CellId c) const;
  Demand demand_of(EntityRef entity, std::span<const VertexId> own, bool pass_on) const;
  Outcome decide(EntityRef entity, std::span<const VertexId> own, const Demand* cause, std::span<const VertexId> twins = {});
  Outcome refuse(EntityRef entity, std::span<const VertexId> own);

  // refine/twins.cpp: subsegments that vertices are close beside
  std::optional<SplitPlace> place_beside(const Item& e, std::span<const VertexId> own, bool& owned) const;
  std::vector<VertexId> twins_of(EntityId s, const SplitPlace& place) const;

  // refine/cells.cpp: poor elements
  FilterSphere<D> sphere_of(const Item& e) const;
  CellVerdict verdict_of(const Item& e) const;
  Outcome treat_cell(const Item& e);
  Outcome insert_point(const Item& e, const CellVerdict& verdict, bool at_center = true);
  Outcome insert_inside(const Item& e, const CellVerdict& verdict);
  Outcome treat_cell_at(const Item& e, const Point<D>& x, const CellVerdict& verdict);
  Demand demand_of_cell(CellId c, const CellVerdict& verdict) const;
  Demand demand_on_entity(CellId c, const CellVerdict& verdict) const;
  enum class Encroachment { none, beside, before };
  Encroachment encroachment(CellId c, int face, const Point<D>& x) const;
  class RefusedFace;
  std::optional<Item> encroached_face(const Point<D>& x) const;
  template <class MayEnter>
  std::optional<Item> wall_before(CellId c, const Point<D>& x, MayEnter may_enter) const;
  std::optional<Item> wall_in_claim(CellId c, const Point<D>& x) const;
  std::optional<Item> flattened_face(const Point<D>& x) const;
  std::optional<Item> encroached_entity(const Point<D>& x) const;
  std::optional<Item> wall_before_far_point(CellId c, const Point<D>& x);
  std::optional<Item> hiding_wall(CellId c, const Point<D>& x);
  Outcome split_instead(const Item& entity, const Item& e, const CellVerdict& verdict);

  // improve/improve.cpp: what stays poor
  /// Where a point may go, and on what.
  struct Place {
    Item at;  ///< a cell in conflict with it, or its face or edge
    Point<D> x;
    Home home;
  };
  Outcome improve(const Item& e);
  std::vector<Place> places_for(CellId c);
  void add_places_on_face(CellId c, int face, std::vector<Place>& places) const;
  void add_places_on_edge(CellId c, int edge, std::vector<Place>& places) const;
  typename Cavity<D>::Status collect_at(const Place& p);
  Simplex<D> prospect(std::size_t n) const;
  double gain_of_collected() const;
  bool is_explained(const Place& p, std::size_t n, VertexId further) const;
  bool poor_ones_are_explained(const Place& p) const;
  std::vector<Home> homes_of_cavity() const;
  template <class F>
  bool all_new_violations(F f) const;
  bool violations_are_explained(const Place& p, bool& any) const;

  Outcome insert_for_less(const Item& e);
  double excess_of(CellId c) const;
  double excess_of(const std::vector<CellId>& cells) const;
  bool is_explained(const std::vector<Home>& homes, const Simplex<D>& s) const;
  Outcome note_change(const Item& e, std::vector<CellId> new_cells, bool violates);

  // improve/flips.cpp
  using Flip = typename LocalFlips<D>::Flip;
  Outcome flip_for_less(const Item& e);
  Simplex<D> simplex_of(const std::array<VertexId, D + 1>& vertices) const;
  std::optional<double> gain_of_flip(const Flip& flip, double least) const;
  using Violations = std::vector<typename LocalFlips<D>::Violation>;
  bool flip_is_explained(const Flip& flip, const Violations& violations) const;
  bool flip_to_delaunay(CellId c, int face);
  void flip_to_delaunay(std::vector<CellId>& cells);

  // improve/vertex_moves.cpp
  enum class VertexChange { take_out, move };
  Outcome change_vertex(const Item& e, VertexChange change);
  bool add_vertices_beyond(CellId c, std::vector<std::pair<VertexId, CellId>>& vertices) const;
  std::optional<double> gain_of_move(double excess, double least);
  bool move_keeps_sizes() const;
  std::vector<Home> homes_of_turned(std::size_t i) const;
  bool move_is_explained(bool& any) const;
  std::vector<Point<D>> places_to_move_to() const;
  void add_places_on_segment(const std::vector<VertexId>& ends, std::vector<Point<D>>& places) const;

  // refine/selectors.cpp
  class View;
  /// Where the selector puts the point of a cell over the radius-edge bound; nothing if the claim is too small to tell.
  std::optional<Point<D>> selected_point(CellId c, const Point<D>& center);

  void committed();
  void flipped();
  void flip(const Item& e);
  std::optional<LocalRewrap::Effort> rewrap_effort(const Item& e) const;
  bool in_volume(VertexId v) const { return mesh_->vertex(v).home.kind() == EntityKind::volume; }
  Outcome give_up(Outcome outcome) {
    cavity_.release();
    return outcome;
  }

  RefineContext<D>* context_;
  Mesh<D>* mesh_;
  const Domain<D>* domain_;
  const RefineOptions<D>* options_;
  const QuickBounds<D> quick_bounds_;
  Pools pools_;
  Cavity<D> cavity_;
  LocalFlips<D> flips_;
  struct NoVertexMove {
    NoVertexMove(Mesh<D>&, const Domain<D>&) {}
    void set_area(const VisitArea<D>*) {}
  };
  std::conditional_t<D == 3, VertexMove, NoVertexMove> move_;
  RegionVisit<D>* visit_ = nullptr;
  struct LastSphere {
    CellId cell{0xffffffffu};
    std::uint16_t birth = 0;
    FilterSphere<D> sphere;
  };
  struct KnownExcess {
    CellId cell{0xffffffffu};
    std::uint16_t birth = 0;
    double value = 0;
  };
  mutable std::vector<KnownExcess> known_excess_ = std::vector<KnownExcess>(D == 3 ? 1024 : 1);  ///< of the cells asked for last
  mutable LastSphere last_sphere_;  ///< 2D: that was asked for
  std::vector<Item> abroad_;  ///< elements with their circumcentre in other regions
  std::vector<std::uint32_t> letters_, box_sizes_;  ///< scratch of send_abroad
  std::vector<Item> found_;  ///< violations at new cells, before they are listed
  std::uint64_t flips_left_ = 0, checked_at_ = 0, reported_ = 0;
  std::uint64_t stride_ = 1;  ///< insertions between two looks at the clock
  std::chrono::steady_clock::time_point checked_time_;
  std::optional<EntityPair> last_refusal_;
  KeySet distinct_;
  RefusalMemo<D> memo_;  ///< of the visit
  std::vector<std::size_t> poor_turned_;  ///< of the cells that the last move would make
  mutable std::map<std::pair<std::uint64_t, std::uint64_t>, double> angles_;  ///< of pairs of entities, in degrees
  mutable std::vector<CellId> seen_;  ///< that it took to decide about the entry treated, with repetitions
};

extern template struct RefineContext<2>;
extern template struct RefineContext<3>;
extern template class Refiner<2>;
extern template class Refiner<3>;

}  // namespace pgdr
