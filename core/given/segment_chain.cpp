// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "given/segment_chain.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "numbers/vectors.hpp"
#include "space/distances.hpp"

namespace pgdr::checking {
namespace {

struct Step {
  double begin, end, area;  ///< begin, end: along the segment
  std::uint32_t from, to, edge;
};

template <int D>
Step step_of(const NearEdge<D>& edge, std::uint32_t number, const std::array<Point<D>, 2>& at) {
  const auto along = detail::difference(at[1], at[0]);
  std::array<double, 2> place, off;
  for (std::size_t k = 0; k < 2; ++k) {
    place[k] = detail::dot(detail::difference(edge.at[k], at[0]), along);
    off[k] = std::sqrt(detail::closest_to_edge(edge.at[k], at[0], at[1]).square);
  }
  const std::size_t first = place[0] <= place[1] ? 0 : 1;
  return {place[first],     place[1 - first],     (off[0] + off[1]) * (place[1 - first] - place[first]),
          edge.ends[first], edge.ends[1 - first], number};
}

}  // namespace

// All steps lead forward, so that what leads to a point is known when the first step from it is looked at.
template <int D>
std::vector<std::uint32_t> segment_chain(std::span<const NearEdge<D>> edges, const std::array<std::uint32_t, 2>& ends,
                                         const std::array<Point<D>, 2>& at) {
  std::vector<Step> steps;
  for (std::uint32_t i = 0; i < edges.size(); ++i) steps.push_back(step_of(edges[i], i, at));
  std::ranges::sort(steps, [](const Step& x, const Step& y) {
    return std::tie(x.begin, x.end, x.from, x.to, x.edge) < std::tie(y.begin, y.end, y.from, y.to, y.edge);
  });
  struct Reached {
    double area;
    const Step* by;
  };
  std::map<std::uint32_t, Reached> reached{{ends[0], {0, nullptr}}};
  for (const Step& step : steps) {
    const auto before = reached.find(step.from);
    if (before == reached.end()) continue;
    const double area = before->second.area + step.area;
    const auto [there, fresh] = reached.try_emplace(step.to, Reached{area, &step});
    if (!fresh && area < there->second.area) there->second = {area, &step};
  }
  std::vector<std::uint32_t> chain;
  const auto last = reached.find(ends[1]);
  if (last == reached.end()) return chain;
  for (const Step* by = last->second.by; by; by = reached.at(by->from).by) chain.push_back(by->edge);
  return chain;
}

template std::vector<std::uint32_t> segment_chain(std::span<const NearEdge<2>>, const std::array<std::uint32_t, 2>&,
                                                  const std::array<Point2, 2>&);
template std::vector<std::uint32_t> segment_chain(std::span<const NearEdge<3>>, const std::array<std::uint32_t, 2>&,
                                                  const std::array<Point3, 2>&);

}  // namespace pgdr::checking
