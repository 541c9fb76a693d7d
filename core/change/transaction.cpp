// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "change/transaction.hpp"

#include <algorithm>
#include <cassert>

#include "numbers/corners.hpp"

namespace pgdr {

void Transaction::commit(Pools& pools, const Replacement<3>& r) {
  if (!on_) return replacer_->commit(pools, r);
  for (const CellId c : r.old)
    for (const VertexId v : mesh_->cell(c).vertices) versions_.push_back({v, mesh_->note(v).version});
  replacer_->commit(pools, r, Replacer<3>::OldCells::kept);
  for (const CellId c : r.old) {
    const auto at = std::find(made_.begin(), made_.end(), c);
    if (at == made_.end()) {
      removed_.push_back(c);
    } else {
      made_.erase(at);
      mesh_->free_cell(pools, c);
    }
  }
  made_.insert(made_.end(), replacer_->new_cells().begin(), replacer_->new_cells().end());
}

void Transaction::keep(Pools& pools) {
  for (const CellId c : removed_) mesh_->free_cell(pools, c);
  end();
}

/// The links of removed cells are those of when they went, which may lead to cells made before. Where they lead now is told by
/// the faces: to the other removed cell that has it, or to a cell that never went.
void Transaction::restore_links() {
  struct Side {
    std::array<VertexId, 3> face;
    Link at;
  };
  std::vector<Side> sides;
  for (const CellId c : removed_)
    for (int f = 0; f < 4; ++f) {
      auto face = face_without(mesh_->cell(c).vertices, f);
      std::sort(face.begin(), face.end());
      sides.push_back({face, Link(c, f)});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.face < b.face; });
  const auto set = [this](Link from, Link to) { mesh_->cell(from.cell()).links[from.face()] = to; };
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (i + 1 < sides.size() && sides[i].face == sides[i + 1].face) {
      set(sides[i].at, sides[i + 1].at);
      set(sides[i + 1].at, sides[i].at);
      ++i;
    } else if (const Link beyond = mesh_->cell(sides[i].at.cell()).links[sides[i].at.face()]) {
      set(beyond, sides[i].at);
    }
  }
}

void Transaction::undo(Pools& pools) {
  restore_links();
  for (const CellId c : made_) mesh_->free_cell(pools, c);
  for (auto at = versions_.rbegin(); at != versions_.rend(); ++at) mesh_->note(at->first).version = at->second;
  // No list and no other visit has ever seen a cell with them.
  for (auto at = vertices_.rbegin(); at != vertices_.rend(); ++at) {
    mesh_->note(*at).version = 0;
    pools.vertices.give(index(*at));
  }
  end();
}

void Transaction::end() {
  on_ = false;
  removed_.clear();
  made_.clear();
  vertices_.clear();
  versions_.clear();
}

}  // namespace pgdr
