// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "compact/region_volumes.hpp"
#include "ranks/own_cell.hpp"
#include "transport/collectives.hpp"

namespace pgdr::detail {

/// For region_volumes() of a mesh of which each rank has its own cells: ranks tell each other what they found of each entity and
/// their sums, never cells.
class VolumesOnRanks final : public VolumesInParts {
 public:
  VolumesOnRanks(Collectives& ranks, IsOwnCell is_own) : ranks_(ranks), is_own_(std::move(is_own)) {}

  bool is_own(CellId c) const override { return is_own_(c); }
  void together(const std::function<void()>& step) override { ranks_.together(step); }
  void join(std::span<SidesOfEntity> sides) override;
  void add(std::span<ExactSum> sums) override;

 private:
  Collectives& ranks_;
  IsOwnCell is_own_;
};

}  // namespace pgdr::detail
