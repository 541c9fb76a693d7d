// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Radii of the selection disks of types I and II (Def. 2.4 to 2.9). Pure functions, any thread.
#include <algorithm>

#include "pgdr/point_selector.hpp"

namespace pgdr {

// An element that is only too big has no disk: the centre alone. The disk of type I does not depend on the bound: a point in
// it is more than k l away from all vertices, so that the insertion rule most often allows it below the smallest proved
// bound too. The disk of type II is empty there.
template <int D>
SelectionDisk<D> selection_disk(const PoorElement<D>& element, const DiskOptions& options) {
  constexpr double k = smallest_proved_bound<D>();
  const double r = element.circumradius;
  if (!element.over_radius_edge) return {element.circumcenter, 0};
  double radius = 0;
  if (options.type == DiskType::type1)
    radius = r - k * element.shortest_edge;
  else if (!(element.radius_edge_bound >= k))
    radius = 0;
  else if (options.delta > 0)
    radius = r * (1 - options.delta);
  else
    radius = r * (1 - k / element.radius_edge_bound);
  return {element.circumcenter, std::max(radius, 0.0)};
}

template PGDR_API SelectionDisk<2> selection_disk<2>(const PoorElement<2>&, const DiskOptions&);
template PGDR_API SelectionDisk<3> selection_disk<3>(const PoorElement<3>&, const DiskOptions&);

}  // namespace pgdr
