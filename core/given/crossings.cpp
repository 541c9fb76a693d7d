// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "given/crossings.hpp"

#include <algorithm>

#include "given/flat_groups.hpp"
#include "space/distances.hpp"

namespace pgdr::checking {

template <int D>
GivenCrossings<D>::GivenCrossings(const GivenInput<D>& input, double r) : reach_(r) {
  for (const GivenSegment& s : input.segments()) edges_.push_back({input.point(s.points[0]), input.point(s.points[1])});
  for (const GivenTriangle& t : input.triangles())
    for (int i = 0; i < 3; ++i) edges_.push_back({input.point(t.points[i]), input.point(t.points[(i + 1) % 3])});
  std::vector<detail::Box<D>> boxes;
  for (const Ends& ends : edges_) boxes.push_back(detail::Box<D>::of(ends).widened(r));
  tree_ = std::make_unique<detail::BoxTree<D>>(boxes);
}

template <int D>
bool GivenCrossings<D>::has(const Point<D>& x) const {
  std::vector<Ends> through;
  tree_->at(x, [&](std::uint32_t i) {
    const Ends& e = edges_[i];
    if (detail::closest_to_edge(x, e[0], e[1]).square <= reach_ * reach_) through.push_back(e);
  });
  const auto leaves_first = [&](const Point<D>& end) {
    const auto along = detail::difference(through[0][1], through[0][0]), u = detail::difference(end, through[0][0]);
    const double t = detail::dot(u, along) / detail::dot(along, along);
    return squared_distance(end, detail::on_edge(through[0][0], through[0][1], t)) > 4 * reach_ * reach_;
  };
  return std::ranges::any_of(through, [&](const Ends& e) { return leaves_first(e[0]) || leaves_first(e[1]); });
}

FacetCrossings::FacetCrossings(const GivenInput<3>& input, std::vector<double> reach) : input_(input), reach_(std::move(reach)) {
  std::vector<detail::Box<3>> boxes;
  boxes.reserve(reach_.size());
  for (std::uint32_t t = 0; t < reach_.size(); ++t)
    boxes.push_back(detail::Box<3>::of(input.corners(input.triangles()[t])).widened(reach_[t]));
  tree_ = std::make_unique<detail::BoxTree<3>>(boxes);
}

void FacetCrossings::append_parts(const std::array<Point3, 2>& segment, std::vector<CoveringSegment<3>>& out) const {
  struct Part {
    std::uint32_t triangle;
    std::array<double, 2> ends;
  };
  std::vector<Part> parts;
  tree_->meeting(detail::Box<3>::of(segment), [&](std::uint32_t t) {
    const auto ends = part_near(segment, input_.corners(input_.triangles()[t]), reach_[t]);
    if (ends[0] <= ends[1]) parts.push_back({t, ends});
  });
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t k = i + 1; k < parts.size(); ++k) {
      const double from = std::max(parts[i].ends[0], parts[k].ends[0]), to = std::min(parts[i].ends[1], parts[k].ends[1]);
      if (from > to || are_even(parts[i].triangle, parts[k].triangle)) continue;
      const double reach = std::max(reach_[parts[i].triangle], reach_[parts[k].triangle]);
      out.push_back({{detail::on_edge(segment[0], segment[1], from), detail::on_edge(segment[0], segment[1], to)}, reach});
    }
}

/// Two triangles that may lie in one plane cross nowhere, or anywhere.
bool FacetCrossings::are_even(std::uint32_t s, std::uint32_t t) const {
  const double reach = std::max(reach_[s], reach_[t]);
  const auto of_s = input_.corners(input_.triangles()[s]), of_t = input_.corners(input_.triangles()[t]);
  return std::ranges::all_of(of_t, [&](const Point3& x) { return may_be_even(of_s, x, reach); }) ||
         std::ranges::all_of(of_s, [&](const Point3& x) { return may_be_even(of_t, x, reach); });
}

template class GivenCrossings<2>;
template class GivenCrossings<3>;

}  // namespace pgdr::checking
