// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a visit has changed where other ranks hold the mesh, too.
#pragma once

#include <span>
#include <vector>

#include "mesh/change_log.hpp"
#include "ranks/cell_message.hpp"
#include "ranks/held_mesh.hpp"
#include "ranks/territory.hpp"

namespace pgdr::detail {

/// The changes of one visit: logged while it runs, and packed on its thread when it ends.
template <int D>
struct VisitChanges {
  ChangeLog<D> log;
  typename ChangeLog<D>::Net net;   ///< after pack(), of the cells gone and made those with a vertex in what a neighbour holds
  std::vector<SentCells<D>> parts;  ///< what each neighbour has to know; empty: nothing

  /// Packs what was logged, and forgets the log, which has no cells if the visit claims nothing that others hold. Threads: that
  /// of the visit, within its claim.
  void pack(const Mesh<D>& mesh, const HeldMesh<D>& held);
  bool is_empty_for(std::size_t neighbour) const { return parts.empty() || parts[neighbour].empty(); }
};

/// Cells that stay, and got other constraints. They may reach far beyond the claim of the visit that gave them these, to what
/// ranks hold that need not know of it before the end. One thread.
template <int D>
class LateConstraints {
 public:
  /// Adds those of the visits.
  void add(const Mesh<D>& mesh, std::span<const VisitChanges<D>> changes);
  void put(MessageWriter& message) const;
  /// Gives such cells their constraints, as another rank wrote them, where they are held.
  static void apply(MessageReader& message, HeldMesh<D>& held);

 private:
  std::vector<SentCells<D>> cells_;
};

extern template struct VisitChanges<2>;
extern template struct VisitChanges<3>;
extern template class LateConstraints<2>;
extern template class LateConstraints<3>;

}  // namespace pgdr::detail
