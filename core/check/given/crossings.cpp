// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "check/given/crossings.hpp"

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

template class GivenCrossings<2>;
template class GivenCrossings<3>;

}  // namespace pgdr::checking
