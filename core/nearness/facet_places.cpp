// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/facet_places.hpp"

#include <map>

#include "given/given_facet.hpp"
#include "numbers/vectors.hpp"

namespace pgdr {
namespace {

/// The centre of the largest triangle of the facet.
std::array<double, 3> place_on(const Plc<3>& plc, const checking::ExplicitEdges& edges, std::uint32_t facet) {
  std::array<double, 3> place{};
  double most = -1;
  for (const auto& t : checking::triangulate_given(plc, edges, facet, 0).triangles) {
    const Point3 &a = plc.points[t[0]], &b = plc.points[t[1]], &c = plc.points[t[2]];
    const auto n = detail::cross(detail::difference(b, a), detail::difference(c, a));
    if (const double area = detail::dot(n, n); area > most) {
      most = area;
      for (int i = 0; i < 3; ++i) place[static_cast<std::size_t>(i)] = (a[i] + b[i] + c[i]) / 3;
    }
  }
  return place;
}

}  // namespace

void name_facets_by_places(const Plc<3>& plc, std::vector<PoorReason>& reasons) {
  const std::vector<std::uint32_t> place = checking::number_places(plc);
  const checking::ExplicitEdges edges(plc, place);
  std::map<std::uint32_t, std::array<double, 3>> places;
  for (PoorReason& reason : reasons)
    for (GivenEntity& e : reason.entities) {
      if (e.kind != EntityKind::facet || e.facet >= plc.facets.size()) continue;
      const auto [at, is_new] = places.try_emplace(e.facet);
      if (is_new) at->second = place_on(plc, edges, e.facet);
      e.facet = no_entity;
      e.ends = {at->second, at->second};
    }
}

}  // namespace pgdr
