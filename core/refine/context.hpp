// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The run as its visits see it: the mesh, the input, the options, and when to stop.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <vector>

#include "mesh/mesh.hpp"
#include "pgdr/circumsphere.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/refine_options.hpp"
#include "refine/work_list.hpp"
#include "rule/cell_bounds.hpp"
#include "rule/kept_entities.hpp"
#include "rule/shells.hpp"

namespace pgdr {

template <int D>
class ElementStage;

/// What all visits of a run share. The atomics alone change during a generation; they tell a visit to end and count for
/// the progress report, and decide nothing else.
template <int D>
struct RefineContext {
  /// `start_time`: when the caller's time limit began to run.
  RefineContext(Mesh<D>& m, const Domain<D>& d, const RefineOptions<D>& o, CellBounds<D> b, std::uint64_t vertices_so_far,
                std::chrono::steady_clock::time_point start_time);

  int bucket_of(double squared_radius) const;  ///< 0 being the largest
  int bucket_of(const FilterSphere<D>& sphere) const { return bucket_of(sphere.radius2); }
  /// No circumradius of this bucket or a later one is larger.
  double largest_radius(int bucket) const;
  /// The element belongs to the node that holds this point: its circumcentre; in a stage with a treatment its centroid, as the
  /// circumcentres of flat cells are anywhere. A function of the points of its vertices.
  Point<D> place_of(CellId c) const { return stage ? centroid<D>(mesh.simplex(c)) : mesh.center(c); }
  /// An upper bound of the entry's circumradius, by which it belongs to a larger or a smaller node; 0 where that does not
  /// count: of other entries than elements, and in a stage.
  double radius_of(const Entry<D>& e) const { return stage || e.kind() != EntryKind::cell ? 0 : largest_radius(e.bucket); }
  /// Since the caller's time limit began to run. Any thread.
  std::chrono::duration<double> elapsed() const { return std::chrono::steady_clock::now() - start; }
  /// Has the run been cancelled, or is its time up but for what finishing the mesh takes? It is stopped with that. Any thread.
  bool ended();
  /// Calls the caller's progress function if it is time for that. Any thread.
  void tell(std::uint64_t vertices_so_far, std::uint64_t waiting);

  Mesh<D>& mesh;                                      ///< which visits change
  const Domain<D>& domain;                            ///< the input
  const RefineOptions<D>& options;                    ///< as the caller gave them
  const CellBounds<D> bounds;                         ///< of cells
  const KeptEntities<D> kept;                         ///< which no point goes onto
  const std::vector<std::uint8_t> meshed;             ///< meshed_triangles(): whose angles count
  const std::chrono::steady_clock::time_point start;  ///< of the time limit
  /// Is the mesh constrained Delaunay before the refinement begins? Set before it does.
  bool begins_delaunay = true;
  /// 3D: the last resort has begun, when what is poor would stay so (rule/insertion_rule.hpp). Set while no visit runs.
  bool last_resort = false;
  /// The stage that treats poor elements; null: points are inserted for them (element_splitter.hpp). Set while no visit runs.
  const ElementStage<D>* stage = nullptr;
  /// A poor element goes before entities with spheres of buckets beyond its own by so many: in 3D by more than twice the bound,
  /// as with any edge of theirs as its shortest it would be poor. In 2D no mesh has more than linearly many triangles: none does.
  const int buckets_before_entities;
  const Shells<D> shells;             ///< none in 3D, where boundary recovery alone splits on them
  int base_exponent = 0;              ///< of bucket 0: circumradii of the size of the domain and above
  static constexpr int buckets = 64;  ///< of circumradii
  /// 2D: no new vertex comes nearer than this to another: 8 ulps of the largest coordinate. Two points that are up to an ulp a
  /// coordinate off their places are up to 2 sqrt 2 ulps farther apart than these, which has to be less than the half that the
  /// insertion rule may lose; and what is nearer would be taken for one point by default, were it given (Plc::tolerance).
  double least_apart = 0;

  std::atomic<int> stop{0};                 ///< a StopCause other than `finished`, once there is one
  std::atomic<std::uint64_t> vertices;      ///< in all, for the progress report
  std::atomic<std::uint64_t> evaluated{0};  ///< by the optimiser, for the progress report
  // For that, set while no visit runs:
  const char* at = "";                ///< the stage
  std::function<double()> remaining;  ///< about the seconds that remain, by the above; below 0: not known. Any thread
  double done = -1;                   ///< under the mutex: Progress::done; below 0: not known
  std::mutex progress_mutex;          ///< held while the caller's function runs
  std::chrono::steady_clock::time_point last_progress;  ///< under the mutex
};

extern template struct RefineContext<2>;
extern template struct RefineContext<3>;

}  // namespace pgdr
