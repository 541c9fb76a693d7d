// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Several replacements that are kept or undone together. Cells that were there before stay in their slots, out of the mesh, until
// that is decided. So what is undone has never been: the same cells are in the same slots, with the same births, versions and
// entries on lists.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "change/replacement.hpp"

namespace pgdr {

/// See above. Part of a worker: one thread at a time.
class Transaction {
 public:
  using Pools = Mesh<3>::Pools;  ///< of the worker

  Transaction(Mesh<3>& mesh, Replacer<3>& replacer) : mesh_(&mesh), replacer_(&replacer) {}  ///< both must outlive it

  void begin() { on_ = true; }
  bool is_on() const { return on_; }  ///< has it begun?
  /// Makes the replacement, as a part of the transaction if one has begun. No wall of it may lie on the rim of its old cells
  /// then.
  void commit(Pools& pools, const Replacement<3>& r);
  /// Says that this vertex is new: it is given back if the transaction is undone.
  void add_vertex(VertexId v) {
    if (on_) vertices_.push_back(v);
  }

  const std::vector<CellId>& removed() const { return removed_; }  ///< the cells of before that are gone
  const std::vector<CellId>& made() const { return made_; }        ///< the cells that are there, and were not before
  void keep(Pools& pools);                                         ///< ends it
  void undo(Pools& pools);                                         ///< ends it; all is as before

 private:
  void restore_links();
  void end();

  Mesh<3>* mesh_;
  Replacer<3>* replacer_;
  bool on_ = false;
  std::vector<CellId> removed_, made_;
  std::vector<VertexId> vertices_;
  std::vector<std::pair<VertexId, std::uint32_t>> versions_;  ///< of vertices before a replacement, in their order
};

}  // namespace pgdr
