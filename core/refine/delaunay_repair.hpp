// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Repair of violations, faces that are not locally Delaunay, while points come: by flips, and where these are stuck by gift
// wrapping.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "change/flips.hpp"
#include "refine/numbers.hpp"
#include "refine/work_lister.hpp"
#include "refine/workspace.hpp"

namespace pgdr {

/// Flips and gift wrapping for the violations that a visit meets. Part of a worker: one thread at a time.
template <int D>
class DelaunayRepair {
 public:
  /// Both must outlive it.
  DelaunayRepair(Workspace<D>& workspace, WorkLister<D>& lister);

  /// Must be called before the visit does anything.
  void begin_visit();
  /// Allows flips for faces that wait, beside those that the visit will find.
  void allow_for(std::uint64_t faces) { flips_left_ += numbers::flips_a_violation * faces; }
  /// Lists the violations at cells that an insertion has made.
  void look_at(std::span<const CellId> made);
  /// Repairs the face of an entry of kind flip, or sets it aside, or lists its cell as poor.
  void treat(const Entry<D>& e);
  /// Removes a cell with all its vertices on one facet, which is flat but for rounding. Refused: the cell is no such, or has to
  /// stay.
  Outcome remove_flat_cell(CellId c);

 private:
  std::optional<LocalRewrap::Effort> rewrap_effort(const Entry<D>& e) const;
  void list_made();

  Workspace<D>* w_;
  WorkLister<D>* lister_;
  LocalFlips<D> flips_;
  std::uint64_t flips_left_ = 0;
};

extern template class DelaunayRepair<2>;
extern template class DelaunayRepair<3>;

}  // namespace pgdr
