// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "ranks/visit_changes.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace pgdr::detail {
/// Where vertices are. It remembers those that were asked for last, since new ones are in many cells, and not known to HeldMesh.
template <int D>
class ZoneCache {
 public:
  explicit ZoneCache(const HeldMesh<D>& held) : held_(&held) { recent_.fill({no_vertex, {}}); }
  typename Territory<D>::Zone operator()(VertexId v) {
    auto& [vertex, zone] = recent_[index(v) % recent_.size()];
    if (vertex != v) {
      vertex = v;
      zone = held_->zone(v);
    }
    return zone;
  }
  bool is_any_shared(const std::array<VertexId, D + 1>& vertices) {
    return std::ranges::any_of(vertices, [this](VertexId v) { return held_->territory().is_shared((*this)(v)); });
  }

 private:
  const HeldMesh<D>* held_;
  std::array<std::pair<VertexId, typename Territory<D>::Zone>, 512> recent_;
};

template <int D>
void VisitChanges<D>::pack(const Mesh<D>& mesh, const HeldMesh<D>& held) {
  const bool has_cells = log.logs_cells();
  log.find_net(mesh, net);
  log = {};
  // Of a visit of which no cells were logged none that it made has a vertex there, but one that stays may reach as far.
  ZoneCache<D> zones(held);
  const auto is_shared = [&](const CellName& c) { return zones.is_any_shared(mesh.cell(c.cell).vertices); };
  std::erase_if(net.gone, [&](const auto& gone) { return !zones.is_any_shared(gone.vertices); });
  std::erase_if(net.made, [&](const CellName& c) { return !is_shared(c); });
  if (!has_cells) {
    std::erase_if(net.survivors, [&](const CellName& c) { return !is_shared(c); });
    return;
  }
  CellWriter<D> writer(mesh, net.gone.size() + net.made.size() + net.survivors.size());
  for (const auto& gone : net.gone) writer.add_gone(gone.vertices);
  for (const CellName& c : net.made) writer.add_made(c.cell);
  for (const CellName& c : net.survivors) writer.add_changed(c.cell);
  const SentCells<D> all = writer.take();
  const Territory<D>& territory = held.territory();
  std::vector<typename Territory<D>::Zone> zone_of;
  std::vector<bool> is_concerned(static_cast<std::size_t>(territory.ranks()));
  for (const VertexId v : writer.vertices()) {
    zone_of.push_back(zones(v));
    for (const int rank : territory.holders(zone_of.back())) is_concerned[static_cast<std::size_t>(rank)] = true;
  }
  for (const int neighbour : territory.neighbours()) {
    parts.emplace_back();
    if (is_concerned[static_cast<std::size_t>(neighbour)])
      parts.back() = CellWriter<D>::part(all, [&](std::uint32_t v) { return territory.holds(zone_of[v], neighbour); });
  }
}

template <int D>
void LateConstraints<D>::add(const Mesh<D>& mesh, std::span<const VisitChanges<D>> changes) {
  for (const VisitChanges<D>& c : changes) {
    if (c.net.survivors.empty()) continue;
    CellWriter<D> writer(mesh, c.net.survivors.size());
    for (const auto& born : c.net.survivors) writer.add_changed(born.cell);
    cells_.push_back(writer.take());
  }
}

template <int D>
void LateConstraints<D>::put(MessageWriter& message) const {
  message.put(static_cast<std::uint64_t>(cells_.size()));
  for (const SentCells<D>& cells : cells_) cells.put(message);
}

template <int D>
void LateConstraints<D>::apply(MessageReader& message, HeldMesh<D>& held) {
  for (auto left = message.get<std::uint64_t>(); left > 0; --left) {
    const auto cells = SentCells<D>::get(message);
    for (const SentConstraints<D>& changed : cells.changed) held.apply(changed, cells.vertices);
  }
}

template struct VisitChanges<2>;
template struct VisitChanges<3>;
template class LateConstraints<2>;
template class LateConstraints<3>;

}  // namespace pgdr::detail
