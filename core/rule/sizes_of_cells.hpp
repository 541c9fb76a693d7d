// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The bounds of size of successive cells of the mesh, some at a time: a size function by blocks is asked for all of them at once.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/mesh.hpp"
#include "rule/cell_bounds.hpp"

namespace pgdr {

/// See above. One thread at a time.
template <int D>
class SizesOfCells {
 public:
  static constexpr std::uint32_t most = 1024;  ///< slots that should be looked at at once

  /// Both must outlive it. @pre bounds.asks_blocks(), for the sizes
  SizesOfCells(const Mesh<D>& mesh, const CellBounds<D>& bounds) : mesh_(&mesh), bounds_(&bounds) {}

  /// Looks at the cells in the slots from `first`, before `last`, and asks for their sizes if blocks are asked. @returns behind
  /// the last slot that it has looked at. @throws as CellBounds::sizes_at
  std::uint32_t look(std::uint32_t first, std::uint32_t last) {
    last = std::min(last, first + most);
    alive_.clear();
    for (std::uint32_t i = first; i < last; ++i)
      if (mesh_->alive(CellId{i})) alive_.push_back(CellId{i});
    if (!bounds_->asks_blocks()) return last;
    centroids_.clear();
    regions_.clear();
    for (const CellId c : alive_) {
      centroids_.push_back(centroid<D>(mesh_->simplex(c)));
      regions_.push_back(mesh_->region(c));
    }
    sizes_.resize(alive_.size());
    bounds_->sizes_at(centroids_, regions_, sizes_);
    return last;
  }
  const std::vector<CellId>& alive() const { return alive_; }  ///< the cells among those looked at
  double size(std::size_t k) const { return sizes_[k]; }       ///< of the k-th of these
  bool asks_blocks() const { return bounds_->asks_blocks(); }  ///< are there sizes?
  /// CellBounds::test of the k-th.
  CellVerdict test(std::size_t k) const {
    const CellId c = alive_[k];
    if (!asks_blocks()) return bounds_->test(*mesh_, c);
    const typename CellBounds<D>::MadeCell cell{mesh_->cell(c).vertices, mesh_->region(c), shape_of<D>(*mesh_, c)};
    return {bounds_->over_radius_edge(*mesh_, cell), bounds_->over_size(*mesh_, cell, sizes_[k])};
  }

 private:
  const Mesh<D>* mesh_;
  const CellBounds<D>* bounds_;
  std::vector<CellId> alive_;
  std::vector<Point<D>> centroids_;
  std::vector<int> regions_;
  std::vector<double> sizes_;
};

}  // namespace pgdr
