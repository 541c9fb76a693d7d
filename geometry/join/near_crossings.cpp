// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "join/near_crossings.hpp"

#include <array>
#include <string>

namespace pgdr::detail {

void refuse_near_crossings(const BuildInput<3>& in, const NearSearch<3>& near, BuildReport<3>& report) {
  const auto& p = in.points;
  const auto words = [&](const PlanarEdge& e) { return report.point_words(e[0]) + " - " + report.point_words(e[1]); };
  for (const std::array<PlanarEdge, 2>& edges : near.passing_edges()) {
    const PlanarEdge &e = edges[0], &f = edges[1];
    report.attempt([&] {
      report.fail(Errc::entities_intersect,
                  "the edges " + words(e) + " and " + words(f) +
                      " come as near to each other as the tolerance, where neither has a point",
                  {}, 0,
                  {report.point_number(e[0]), report.point_number(e[1]), report.point_number(f[0]), report.point_number(f[1])},
                  {p[e[0]].x, p[e[1]].x, p[f[0]].x, p[f[1]].x});
    });
  }
}

}  // namespace pgdr::detail
