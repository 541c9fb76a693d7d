// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// All points of an input, for motions of it.
#pragma once

#include "pgdr/plc.hpp"

namespace pgdr::test {

/// Calls f(point) for all of them: vertices, and seeds of holes, of regions and of holes in facets.
template <int D, class F>
void for_each_point(Plc<D>& plc, F f) {
  for (auto& p : plc.points) f(p);
  for (auto& p : plc.holes) f(p);
  for (auto& r : plc.regions) f(r.point);
  for (auto& facet : plc.facets)
    for (auto& p : facet.holes) f(p);
}

}  // namespace pgdr::test
