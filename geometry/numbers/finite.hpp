// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "pgdr/types.hpp"

namespace pgdr::detail {

/// Are all coordinates finite?
template <int D>
bool is_finite(const Point<D>& p) {
  return std::ranges::all_of(p.x, [](double x) { return std::isfinite(x); });
}

}  // namespace pgdr::detail
