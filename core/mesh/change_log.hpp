// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A log of the cells that whoever changes a mesh frees, makes, and gives other constraints (Mesh::Pools::log). Beside the mesh as
// it was before it tells what has changed in all, whatever was made and freed on the way. One thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "mesh/ids.hpp"
#include "mesh/key_set.hpp"

namespace pgdr {

/// See above.
template <int D>
class ChangeLog {
 public:
  using Vertices = std::array<VertexId, D + 1>;

  /// Are cells that are freed and made logged, or constraints alone?
  bool logs_cells() const { return logs_cells_; }
  void logs_cells(bool does) { logs_cells_ = does; }

  void add_freed(CellId c, std::uint16_t birth, const Vertices& vertices) {
    if (logs_cells_) freed_.push_back({{c, birth}, vertices});
  }
  void add_made(CellId c, std::uint16_t birth) {
    if (logs_cells_) made_.push_back({c, birth});
  }
  /// The constraints of the cell are about to change. That of a cell made since it was begun does not count, if cells are
  /// logged.
  void add_changed(CellId c, std::uint16_t birth) { changed_.push_back({c, birth}); }

  /// A cell that is not there any more.
  struct Freed {
    CellName was;
    Vertices vertices;
  };
  /// What has changed in all.
  struct Net {
    std::vector<Freed> gone;          ///< that were there before and are not any more
    std::vector<CellName> made;       ///< that were not there before, and are
    std::vector<CellName> survivors;  ///< that were there before, and may have other constraints
  };
  /// While nobody else may change the cells that are still there.
  template <class Mesh>
  void find_net(const Mesh& mesh, Net& net) {
    net.gone.clear();
    net.made.clear();
    net.survivors.clear();
    keys_.reset(made_.size() + changed_.size());
    for (const CellName& b : made_) {
      keys_.insert(key(b));
      if (is_alive(mesh, b)) net.made.push_back(b);
    }
    for (const Freed& f : freed_)
      if (!keys_.contains(key(f.was))) net.gone.push_back(f);
    for (const CellName& b : changed_)
      if (is_alive(mesh, b) && keys_.insert(key(b))) net.survivors.push_back(b);
  }

 private:
  static std::uint64_t key(const CellName& b) { return std::uint64_t{index(b.cell)} << 16 | b.birth; }
  /// Of a cell that was there once. Its slot may be in use again, by a visit that runs now: so the birth alone is read.
  template <class Mesh>
  static bool is_alive(const Mesh& mesh, const CellName& b) {
    return mesh.birth(b.cell) == b.birth;
  }

  std::vector<Freed> freed_;
  std::vector<CellName> made_, changed_;
  KeySet keys_;
  bool logs_cells_ = true;
};

}  // namespace pgdr
