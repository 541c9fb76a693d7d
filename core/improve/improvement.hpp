// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What the last visits of a run heed, which change the mesh for elements that stay poor
// (improve/improve.cpp). Read by all of them at once.
#pragma once

#include <vector>

#include "reasons/poor_reasons.hpp"

namespace pgdr {

constexpr double least_gain = 1.0 / 128;  ///< by which anything lessens the excess
constexpr double least_gain_without = -1e-9;  ///< the same of a vertex that is taken out: none, but for rounding

/// See above.
template <int D>
struct Improvement {
  const PoorReasons<D>& reasons;  ///< which no visit changes
  bool takes_out_alone = true;   ///< vertices; does nothing else
};

}  // namespace pgdr
