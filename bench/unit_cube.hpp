// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pgdr/plc.hpp"

namespace pgdr {

inline Plc<3> unit_cube() {
  Plc<3> plc;
  for (int i = 0; i < 8; ++i) plc.points.push_back({{double(i & 1), double(i >> 1 & 1), double(i >> 2 & 1)}});
  const std::uint32_t faces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    Plc<3>::Facet facet;
    facet.polygons.push_back({f[0], f[1], f[2], f[3]});
    plc.facets.push_back(facet);
  }
  return plc;
}

}  // namespace pgdr
