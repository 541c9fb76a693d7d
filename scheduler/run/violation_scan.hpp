// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Looks over the whole mesh for faces that are not locally Delaunay: one that was left standing may have moved off the walls,
// where insertions do not look for it. Between visits; one thread, which has others look at parts of the mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/slot_set.hpp"
#include "visits/cell_parts.hpp"
#include "visits/run_state.hpp"

namespace pgdr::detail {

/// Subfacets that are Delaunay in the projection of an uneven facet may have violations beside them though no cavity was cut
/// back.
template <int D>
bool has_uneven_facets(const Domain<D>& domain);

/// Part of a run: see above.
template <int D>
class ViolationScan {
 public:
  explicit ViolationScan(RunState<D>& state);  ///< it must outlive this

  /// Returns the violations whose surroundings have changed since the last look, if there may be any, in an order that does not
  /// depend on the slots of cells.
  std::vector<Entry<D>> scan_if_any();
  /// Looks whether or not there may be any.
  std::vector<Entry<D>> scan();
  /// All violations there were at the last look.
  const std::vector<Entry<D>>& standing() const { return standing_; }

 private:
  SlotSet changed_surroundings();
  void rename(const Renumbering<D>& to);

  RunState<D>* state_;
  const bool uneven_;                            ///< there may be some that no insertion brings
  std::vector<std::uint16_t> births_looked_at_;  ///< by slot: of the cell at the last look
  std::vector<Entry<D>> standing_;
};

extern template class ViolationScan<2>;
extern template class ViolationScan<3>;

}  // namespace pgdr::detail
