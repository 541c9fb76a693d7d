// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which pieces a BodyMode drops, which volumes are one then, and which label they have.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bodies/body_volumes.hpp"

namespace pgdr::detail {

class RegionGroups {
 public:
  /// Volumes that nothing separates any more.
  struct Group {
    std::vector<std::uint32_t> volumes;  ///< ascending
    bool is_outside = false, is_solid = false;
    std::vector<std::uint32_t> bodies;        ///< of a solid
    bool has_seed = false, has_hole = false;  ///< of the input
    double label = 0;                         ///< of a solid, or what has a seed
  };

  /// The input, its pieces and their volumes must outlive this. @throws InputError bodies_overlap
  RegionGroups(const Plc<3>& plc, const Arrangement& pieces, const BodyVolumes& volumes, BodyMode mode, const Bulk& bulk);

  bool is_dropped(std::uint32_t piece) const { return dropped_[piece] != 0; }
  std::span<const Group> groups() const { return groups_; }
  /// Of all labels, ascending.
  std::vector<BodyRegion> regions() const;

 private:
  void require_disjoint() const;
  void judge_volumes();
  bool drops(std::uint32_t piece) const;
  void group_volumes();
  void place_seeds();
  std::optional<std::uint32_t> group_at(const Point<3>& x) const;
  void number_labels(const Bulk& bulk);
  std::vector<std::vector<std::uint32_t>> names_by_points(std::span<const std::uint32_t> class_of_group, std::size_t classes,
                                                          const Bulk& bulk) const;

  const Plc<3>& plc_;
  const Arrangement& pieces_;
  const BodyVolumes& volumes_;
  const BodyMode mode_;
  std::vector<std::vector<std::uint32_t>> bodies_;  ///< that each volume is of; empty: void
  std::vector<char> dropped_;                       ///< of pieces
  std::vector<std::uint32_t> group_of_;             ///< of volumes
  std::vector<Group> groups_;
};

}  // namespace pgdr::detail
