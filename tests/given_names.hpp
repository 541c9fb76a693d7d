// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Names of segments and facets of an input, as reasons have them.
#pragma once

#include "pgdr/domain.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/poor_reason.hpp"

namespace pgdr::test {

template <int D>
GivenEntity named_segment(const Point<D>& a, const Point<D>& b) {
  GivenEntity e;
  e.kind = EntityKind::segment;
  for (int i = 0; i < D; ++i) {
    e.ends[0][static_cast<std::size_t>(i)] = a[i];
    e.ends[1][static_cast<std::size_t>(i)] = b[i];
  }
  return e;
}

inline GivenEntity named_facet(std::uint32_t facet) {
  GivenEntity e;
  e.kind = EntityKind::facet;
  e.facet = facet;
  return e;
}

/// Of a Domain each of whose facets is one of the input.
template <int D>
GivenEntity named(const Domain<D>& domain, EntityRef e) {
  if (e.kind == EntityKind::segment) {
    const auto [a, b] = domain.segments()[e.id].points;
    return named_segment<D>(domain.points()[a], domain.points()[b]);
  }
  return named_facet(domain.triangle_origins(e.id)[0].facet);
}

}  // namespace pgdr::test
