// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The workspace of a worker, which its parts share: the mesh with the worker's pools, its one cavity, the visit that runs, and
// the trace of the entry that is treated.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "cavity/cavity.hpp"
#include "input/sharp_angles.hpp"
#include "mesh/entity_pair.hpp"
#include "refine/context.hpp"
#include "refine/node_visit.hpp"

namespace pgdr {

/// What became of an entry.
enum class Outcome {
  committed,  ///< the mesh was changed for it
  refused,    ///< the insertion rule, or the geometry, does not allow it
  not_owned,  ///< that would need cells that the visit does not own
};

/// A cache of the angles at which entities meet, each of which takes microseconds.
template <int D>
class EntityAngles {
 public:
  /// Both must outlive it. @param meshed of triangles of facets: whose corners count
  EntityAngles(const Domain<D>& domain, CountedTriangles meshed) : domain_(&domain), meshed_(meshed) {}

  /// `entity_angle` of the two, in degrees, where they are in the mesh.
  double between(EntityRef a, EntityRef b) {
    const auto key = [](EntityRef e) { return std::uint64_t{e.id} << 1 | (e.kind == EntityKind::facet ? 1 : 0); };
    const auto [at, is_new] = angles_.try_emplace({key(a), key(b)});
    if (is_new) at->second = counted_angle<D>(*domain_, a, b, meshed_);
    return at->second;
  }

 private:
  const Domain<D>* domain_;
  CountedTriangles meshed_;
  std::map<std::pair<std::uint64_t, std::uint64_t>, double> angles_;
};

/// What the parts of one worker share. One thread at a time.
template <int D>
struct Workspace {
  using Pools = typename Mesh<D>::Pools;

  /// The context must outlive it.
  Workspace(RefineContext<D>& c, Pools p)
      : context(c),
        mesh(c.mesh),
        domain(c.domain),
        options(c.options),
        pools(std::move(p)),
        cavity(c.mesh, &c.domain),
        angles(c.domain, c.meshed) {
    cavity.set_seen(&trace);
  }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  /// An entry for the face, edge or cell as it is now.
  Entry<D> entry(CellId c, EntryKind kind, int which, int bucket = 0, std::uint32_t order = 0) const {
    return {c, mesh.birth(c), kind, which, bucket, order};
  }
  bool alive(const Entry<D>& e) const { return e.alive(mesh); }                                  ///< is its cell still there?
  bool in_volume(VertexId v) const { return mesh.vertex(v).home.kind() == EntityKind::volume; }  ///< on no entity?
  /// Releases the cavity. @returns the outcome
  Outcome give_up(Outcome outcome) {
    cavity.release();
    return outcome;
  }

  RefineContext<D>& context;
  Mesh<D>& mesh;
  const Domain<D>& domain;
  const RefineOptions<D>& options;
  Pools pools;                    ///< of this worker
  Cavity<D> cavity;               ///< of the insertion that is being tried
  NodeVisit<D>* visit = nullptr;  ///< that runs
  EntityAngles<D> angles;
  std::vector<CellId> trace;             ///< cells that were looked at to decide about the entry treated, with repetitions
  bool trace_alone = false;              ///< do these decide, whatever their neighbours are?
  std::optional<EntityPair> refused_by;  ///< entities that the entry treated was refused for
};

}  // namespace pgdr
