// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What the last visits of a run heed, which take out vertices and insert points for elements that stay poor
// (refiner_improvement.cpp). Read by all of them at once.
#pragma once

#include <vector>

#include "pgdr/poor_reasons.hpp"

namespace pgdr {

/// See above.
template <int D>
struct Improvement {
  const PoorReasons<D>& reasons;  ///< which no visit changes
  bool inserts = false;          ///< points, and not only takes out vertices
  std::vector<bool> kept;  ///< by slot: of cells that must stay, as what stays elsewhere is explained by them
};

}  // namespace pgdr
