// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "ranks/visit_changes.hpp"

#include <algorithm>
#include <cstdint>

namespace pgdr::detail {
template <int D>
void VisitChanges<D>::pack(const Mesh<D>& mesh, const Territory<D>& territory) {
  const bool has_cells = log.logs_cells();
  log.find_net(mesh, net);
  log = {};
  if (!has_cells) {
    // The cells that such a visit makes have no vertex there, but one that stays may reach as far.
    std::erase_if(net.survivors, [&](const auto& born) {
      return std::ranges::none_of(mesh.cell(born.cell).vertices, [&](VertexId v) { return territory.is_shared(mesh.point(v)); });
    });
    return;
  }
  CellWriter<D> writer(mesh, net.gone.size() + net.made.size() + net.survivors.size());
  for (const auto& gone : net.gone) writer.add_gone(gone.vertices);
  for (const auto& born : net.made) writer.add_made(born.cell);
  for (const auto& born : net.survivors) writer.add_changed(born.cell);
  const SentCells<D> all = writer.take();
  const std::vector<VertexId>& vertices = writer.vertices();
  std::vector<std::span<const int>> holders;
  std::vector<char> is_shared;
  for (const VertexId v : vertices) {
    holders.push_back(territory.holders(mesh.point(v)));
    is_shared.push_back(territory.is_shared(mesh.point(v)));
  }
  for (std::size_t i = 0; i < all.made.size(); ++i)
    if (std::ranges::any_of(all.made[i].vertices, [&](std::uint32_t v) { return is_shared[v] != 0; }))
      shared.push_back(net.made[i].cell);
  std::vector<bool> is_concerned(static_cast<std::size_t>(territory.ranks()));
  for (const auto& ranks : holders)
    for (const int rank : ranks) is_concerned[static_cast<std::size_t>(rank)] = true;
  for (const int neighbour : territory.neighbours()) {
    parts.emplace_back();
    if (!is_concerned[static_cast<std::size_t>(neighbour)]) continue;
    std::vector<char> is_held;
    for (const auto& ranks : holders) is_held.push_back(std::ranges::find(ranks, neighbour) != ranks.end());
    parts.back() = CellWriter<D>::part(all, [&](std::uint32_t v) { return is_held[v] != 0; });
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
