// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "rule/shells.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pgdr/predicates.hpp"

namespace pgdr {

template <int D>
Shells<D>::Shells(const Domain<D>& domain, bool any, const detail::Bulk& bulk) : domain_(&domain) {
  const auto segments = domain_->segments();
  at_end_.assign(segments.size(), {false, false});
  if (!any) return;
  struct Use {
    std::uint32_t point;
    EntityId segment;
    int end;
  };
  std::vector<Use> uses = bulk.gather<Use>(segments.size(), [&](std::size_t s, std::vector<Use>& out) {
    for (const int end : {0, 1}) out.push_back({segments[s].points[end], static_cast<EntityId>(s), end});
  });
  bulk.sort(uses, [](const Use& a, const Use& b) { return std::pair(a.point, a.segment) < std::pair(b.point, b.segment); });
  const auto far_end = [&](const Use& u) { return domain_->points()[segments[u.segment].points[1 - u.end]]; };
  bulk.each(uses.size(), [&](std::size_t i) {  // for the first use of each point
    if (i > 0 && uses[i - 1].point == uses[i].point) return;
    std::size_t j = i;
    while (j < uses.size() && uses[j].point == uses[i].point) ++j;
    const Point<D>& v = domain_->points()[uses[i].point];
    for (std::size_t a = i; a < j; ++a)
      for (std::size_t b = a + 1; b < j; ++b) {
        bool& shell_a = at_end_[uses[a].segment][uses[a].end];
        bool& shell_b = at_end_[uses[b].segment][uses[b].end];
        if ((shell_a && shell_b) || !angle_below_60<D>(v, far_end(uses[a]), far_end(uses[b]))) continue;
        shell_a = shell_b = true;
      }
  });
}

template <int D>
double Shells<D>::split_parameter(EntityId segment, double t0, double t1) const {
  const double middle = t0 + (t1 - t0) / 2;
  const int end = end_of(segment, t0, t1);  // of two the lexicographically smaller
  if (end < 0) return middle;
  const auto& ends = domain_->segments()[segment].points;
  const double whole = std::sqrt(squared_distance(domain_->points()[ends[0]], domain_->points()[ends[1]]));
  const double length = whole * (t1 - t0);
  double radius = std::ldexp(1.0, std::ilogb(length * (2.0 / 3)));
  if (!(radius > length / 3)) radius *= 2;
  const double t = radius / whole;
  if (!(t > 0 && t < t1 - t0)) return middle;
  return end == 0 ? t : 1 - t;
}

template <int D>
bool Shells<D>::is_radius(EntityId segment, double distance) const {
  const double least = std::ldexp(1.0, std::ilogb(distance));
  return std::min(distance - least, 2 * least - distance) <= rounding(segment);
}

template class Shells<2>;
template class Shells<3>;

}  // namespace pgdr
