// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Beside which vertices a face that is not locally Delaunay does no harm: those on entities that are named as reasons why elements
// stay poor. By what a vertex lies on, not by its number: vertices come while this is in use, and which number one gets depends on
// the thread that makes it. Read by all visits at once.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "pgdr/mesh.hpp"

namespace pgdr {

/// See above.
class ExcusingHomes {
 public:
  /// Of none: nothing is known yet.
  ExcusingHomes() = default;
  /// By entity: of each domain point, segment and facet whether it excuses what is beside its vertices.
  ExcusingHomes(std::vector<bool> points, std::vector<bool> segments, std::vector<bool> facets)
      : excusing_{std::move(points), std::move(segments), std::move(facets)}, known_(true) {}

  bool known() const { return known_; }  ///< is anything?
  /// Does a vertex of this home excuse? @pre known()
  bool has(Home home) const {
    return home.kind() != EntityKind::volume && excusing_[static_cast<std::size_t>(home.kind())][home.id()];
  }
  /// The same; before anything is known all vertices on the boundary do.
  bool excuses(Home home) const { return known_ ? has(home) : home.kind() != EntityKind::volume; }

 private:
  std::array<std::vector<bool>, 3> excusing_;
  bool known_ = false;
};

}  // namespace pgdr
