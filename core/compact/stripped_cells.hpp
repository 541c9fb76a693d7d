// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Stripped cells: the vertices of the cells of a mesh, side by side in the memory of these cells, most of which is given back.
// The finished mesh is made of them, so that both take little more memory than the mesh that was refined.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <new>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {

template <int D>
class StrippedCells {
 public:
  using Cell = std::array<std::uint32_t, D + 1>;  ///< indices of vertices, in the order of the cell

  /// Takes the cells of the mesh apart: its vertices alone can be used after that. `regions`: keep the region of each cell.
  /// `is_wanted(c)`, of each cell: is it kept? It may read that cell alone, and is asked on several threads.
  template <class IsWanted>
  StrippedCells(Mesh<D>& mesh, const Bulk& bulk, bool regions, const IsWanted& is_wanted) : bulk_(&bulk) {
    const std::uint32_t bound = mesh.cell_bound();
    block_ = std::clamp(std::bit_ceil(bound / 64), 1u << 12, 1u << 18);  // most of it several huge pages, where that counts
    blocks_.resize((bound + block_ - 1) / block_);
    bulk.parts(blocks_.size(), [&](std::size_t i) {
      const auto first = static_cast<std::uint32_t>(i) * block_;
      strip(mesh, first, std::min(bound, first + block_), regions, is_wanted, blocks_[i]);
    });
    mesh.discard_tags();
  }
  StrippedCells(Mesh<D>& mesh, const Bulk& bulk, bool regions)
      : StrippedCells(mesh, bulk, regions, [](CellId) { return true; }) {}

  /// Calls f(cell, region) for each, several at once where the bulk loops are parallel; region is 0 if it was not kept.
  template <class F>
  void each(const F& f) const {
    bulk_->parts(blocks_.size(), [&](std::size_t i) {
      const Block& block = blocks_[i];
      for (std::uint32_t k = 0; k < block.count; ++k)
        f(block.cells[k], block.regions.empty() ? std::uint16_t{0} : block.regions[k]);
    });
  }
  /// Gives the memory of the cells of a block back: it has none from now on.
  void discard(Mesh<D>& mesh, std::size_t i) {
    const auto first = static_cast<std::uint32_t>(i) * block_;
    mesh.discard_cells(first, std::min(mesh.cell_bound(), first + block_), 0);
    blocks_[i] = {};
  }
  std::size_t block_count() const { return blocks_.size(); }
  /// The cells of one block. The blocks hold all cells, each once.
  std::span<Cell> block(std::size_t i) const { return {blocks_[i].cells, blocks_[i].count}; }
  /// Their regions; none if these were not kept.
  std::span<const std::uint16_t> regions(std::size_t i) const { return blocks_[i].regions; }

 private:
  struct Block {
    Cell* cells = nullptr;
    std::uint32_t count = 0;
    std::vector<std::uint16_t> regions;
  };

  template <class IsWanted>
  static void strip(Mesh<D>& mesh, std::uint32_t first, std::uint32_t last, bool regions, const IsWanted& is_wanted,
                    Block& block) {
    std::byte* const memory = mesh.memory_of(CellId{first});
    for (std::uint32_t i = first; i < last; ++i) {
      if (!mesh.alive(CellId{i}) || !is_wanted(CellId{i})) continue;
      Cell cell;
      for (int j = 0; j <= D; ++j) cell[j] = index(mesh.cell(CellId{i}).vertices[j]);
      if (regions) block.regions.push_back(mesh.region(CellId{i}));
      std::memcpy(memory + block.count++ * sizeof(Cell), &cell, sizeof(Cell));
    }
    block.cells = std::launder(reinterpret_cast<Cell*>(memory));
    mesh.discard_cells(first, last, block.count * sizeof(Cell));
  }

  const Bulk* bulk_;
  std::uint32_t block_;
  std::vector<Block> blocks_;
};

}  // namespace pgdr::detail
