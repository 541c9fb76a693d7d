// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "space/nesting.hpp"

#include <utility>

#include "space/blocks.hpp"

namespace pgdr::detail {
namespace {

/// What the volumes of a block are, once that through which it is entered is known.
void judge(const Blocks& blocks, const Blocks::Block& block, std::vector<bool>& solid) {
  bool consistent = true;
  for (const auto& edge : block) {
    const auto [at, to] = edge;
    if (blocks.is_forward(edge))
      solid[to] = !solid[at];
    else
      consistent &= solid[to] != solid[at];
  }
  if (consistent) return;
  const std::uint32_t entry = block.front()[0];
  for (const auto& edge : block)
    if (blocks.is_forward(edge)) solid[edge[1]] = !solid[entry];
}

}  // namespace

std::vector<bool> solid_by_nesting(std::uint32_t volumes, std::vector<std::array<std::uint32_t, 2>> neighbours) {
  Blocks blocks(volumes, std::move(neighbours));
  blocks.search(0);
  std::vector<bool> solid(volumes, false);
  for (auto block = blocks.found().rbegin(); block != blocks.found().rend(); ++block) judge(blocks, *block, solid);
  return solid;
}

}  // namespace pgdr::detail
