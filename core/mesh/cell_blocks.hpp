// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A pass over all cells of a mesh that takes or gives ids: in blocks, each of which has pools of its own, several at once.
#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {

/// Calls f(c, own) for each cell that is alive. It may change that cell alone, and take ids from `own`, or give them back there.
/// In the end `pools` has what is left, in the order of the cells.
template <int D, class F>
void each_cell(Mesh<D>& mesh, typename Mesh<D>::Pools& pools, const Bulk& bulk, const F& f) {
  const std::size_t bound = mesh.cell_bound();
  const auto pass = [&](std::size_t first, std::size_t last, typename Mesh<D>::Pools& own) {
    for (std::size_t i = first; i < last; ++i)
      if (const CellId c{static_cast<std::uint32_t>(i)}; mesh.alive(c)) f(c, own);
  };
  if (mesh.is_small()) return pass(0, bound, pools);  // which no other pools may take ids of
  const std::size_t block = bulk.grain_of(bound);
  std::vector<std::optional<typename Mesh<D>::Pools>> of_blocks((bound + block - 1) / block);
  bulk.parts(of_blocks.size(), [&](std::size_t i) {
    auto own = mesh.make_pools();
    pass(i * block, std::min(bound, (i + 1) * block), own);
    of_blocks[i].emplace(std::move(own));
  });
  for (auto& own : of_blocks)
    if (own) pools.absorb(std::move(*own));
}

}  // namespace pgdr::detail
