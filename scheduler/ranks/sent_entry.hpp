// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// An entry of a work list in a message: its cell by the coordinates of the vertices, in their order.
#pragma once

#include <array>
#include <cstdint>

#include "ranks/held_mesh.hpp"
#include "refine/work_list.hpp"
#include "transport/message.hpp"

namespace pgdr::detail {

/// See above.
template <int D>
struct SentEntry {
  SentPoints<D> cell;
  std::uint32_t order, kind, which, bucket;
  /// 0: its cell is gone. It keeps its place in line: work lists count such entries, and which of two equal ones a heap has first
  /// depends on all that were pushed.
  std::uint32_t is_alive;

  static SentEntry of(const Mesh<D>& mesh, const Entry<D>& e) {
    SentEntry sent{};
    sent.is_alive = e.alive(mesh) && mesh.alive(e.cell) ? 1 : 0;
    if (sent.is_alive != 0) sent.cell = points_of(mesh, e.cell);
    sent.order = e.order;
    sent.kind = static_cast<std::uint32_t>(e.kind());
    sent.which = static_cast<std::uint32_t>(e.which());
    sent.bucket = e.bucket;
    return sent;
  }
  /// @throws ResourceError internal: the cell is not held, or there is no such entry
  Entry<D> entry(const Mesh<D>& mesh, const HeldMesh<D>& held) const {
    if (kind > static_cast<std::uint32_t>(EntryKind::cell) || which >= whiches(static_cast<EntryKind>(kind)) || bucket > 0xff)
      fail_message("another rank has an entry that is none");
    const CellId c = is_alive != 0 ? held.find(cell) : CellId{0};
    if (c == no_cell) fail_message("another rank has an entry for a cell that is not held");
    const std::uint16_t birth = is_alive != 0 ? mesh.birth(c) : Mesh<D>::last_birth;
    return Entry<D>(c, birth, static_cast<EntryKind>(kind), static_cast<int>(which), static_cast<int>(bucket), order);
  }

 private:
  /// How many values `which` has.
  static std::uint32_t whiches(EntryKind kind) {
    switch (kind) {
      case EntryKind::edge: return D == 3 ? 6 : D + 1;
      case EntryKind::face:
      case EntryKind::flip: return D + 1;
      case EntryKind::cell: return Entry<D>::over_radius_edge + 1;
    }
    return 0;
  }
};

}  // namespace pgdr::detail
