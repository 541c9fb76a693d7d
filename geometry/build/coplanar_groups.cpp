// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "build/coplanar_groups.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "space/make_set.hpp"

namespace pgdr::detail {

CoplanarGroups::CoplanarGroups(const BuildInput<3>& in, FacetTriangles& faces, const EdgeUses& uses, BuildReport<3>& report)
    : in_(in),
      shapes_(in.points, in.scale),
      faces_(faces),
      uses_(uses),
      report_(report),
      joints_(in, faces),
      width_(in.tolerance * in.scale),
      exactly_(faces.facets.size()),
      nearly_(faces.facets.size()),
      root_(faces.facets.size()) {
  std::iota(root_.begin(), root_.end(), 0u);
  if (faces.facets.empty()) return;
  fit_planes();
  unite_pairs();
  std::vector<std::uint32_t> by_group(root_);
  std::stable_sort(by_group.begin(), by_group.end(),
                   [this](std::uint32_t f, std::uint32_t g) { return nearly_.find(f) < nearly_.find(g); });
  const std::span<const std::uint32_t> all(by_group);
  for (std::size_t begin = 0, end; begin < all.size(); begin = end) {
    in_.stop();
    for (end = begin + 1; end < all.size() && nearly_.find(all[end]) == nearly_.find(all[begin]);) ++end;
    if (end - begin > 1) settle(all.subspan(begin, end - begin));
  }
}

std::vector<bool> CoplanarGroups::find_soft_edges() const {
  std::vector<bool> soft(uses_.size(), false);
  using Found = std::vector<std::size_t>;
  const auto look_at = [&](std::size_t begin, std::span<const EdgeUse> uses, Found& found) {
    if (!joints_.is_joint(uses)) return;
    const std::uint32_t f = uses[0].owner, g = uses[1].owner;
    if (f == g || (root_[f] == root_[g] && joints_.opens(uses, faces_.facets[root_[f]].axis))) found.push_back(begin);
  };
  for (const std::size_t begin : uses_.gather<std::size_t>(in_.bulk, look_at)) soft[begin] = true;
  in_.stop();
  return soft;
}

void CoplanarGroups::fit_planes() {
  const Point3 origin = shapes_.scaled(faces_.triangles[0][0]);
  planes_.assign(faces_.facets.size(), FittedPlane(origin));
  in_.bulk.each(faces_.facets.size(), [&](std::size_t f) {
    for (const PlanarTriangle& t : faces_.of(faces_.facets[f]))
      planes_[f].add(shapes_.scaled(t[0]), shapes_.scaled(t[1]), shapes_.scaled(t[2]));
  });
}

void CoplanarGroups::unite_pairs() {
  struct Found {
    Pair pair;
    bool is_flat;
  };
  const auto look_at = [&](std::size_t, std::span<const EdgeUse> uses, std::vector<Found>& found) {
    if (uses.size() < 2 || uses[0].owner == uses[1].owner || !joints_.is_joint(uses)) return;
    const auto [f, g] = std::minmax(uses[0].owner, uses[1].owner);
    const auto& larger = planes_[planes_[f].weight() < planes_[g].weight() ? g : f];
    if (!joints_.opens(uses, axes_by_size(larger.normal())[0])) return;
    if (const bool is_flat = joints_.is_flat(uses); is_flat || width_ > 0) found.push_back({{f, g}, is_flat});
  };
  std::vector<Pair> pairs;
  for (const auto& [pair, is_flat] : uses_.gather<Found>(in_.bulk, look_at)) {
    if (is_flat) {
      exactly_.unite(pair[0], pair[1]);
      nearly_.unite(pair[0], pair[1]);
    } else {
      pairs.push_back(pair);
    }
  }
  in_.stop.sort(in_.bulk, pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::vector<char> one_plane(pairs.size());
  in_.bulk.each(pairs.size(), [&](std::size_t k) { one_plane[k] = have_one_plane(pairs[k]); });
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (one_plane[k]) nearly_.unite(pairs[k][0], pairs[k][1]);
}

/// Looks at the smaller facet first: most often it is that which is not in the plane.
bool CoplanarGroups::have_one_plane(const Pair& pair) const {
  auto [f, g] = pair;
  if (planes_[f].weight() < planes_[g].weight()) std::swap(f, g);
  FittedPlane plane = planes_[f];
  plane.add(planes_[g]);
  return farthest_off(plane, g).distance <= width_ && farthest_off(plane, f).distance <= width_;
}

CoplanarGroups::Farthest CoplanarGroups::farthest_off(const FittedPlane& plane, std::uint32_t f) const {
  Farthest farthest;
  for (const PlanarTriangle& t : faces_.of(faces_.facets[f]))
    for (const std::uint32_t v : t)
      if (const double d = plane.distance(shapes_.scaled(v)); !(d <= farthest.distance)) farthest = {v, d};
  return farthest;
}

/// Facets that are reached by exactly coplanar ones alone are taken as they are, whatever the doubles of the fit say.
void CoplanarGroups::settle(std::span<const std::uint32_t> group) {
  const auto largest = std::ranges::max_element(group, {}, [this](std::uint32_t f) { return planes_[f].weight(); });
  FittedPlane plane = planes_[*largest];
  for (const std::uint32_t f : group)
    if (f != *largest) plane.add(planes_[f]);
  const std::uint32_t first = exactly_.find(group[0]);
  const bool exactly = std::ranges::all_of(group, [&](std::uint32_t f) { return exactly_.find(f) == first; });
  if (exactly) return take(group, plane, true);
  Farthest farthest;
  for (const std::uint32_t f : group)
    if (const Farthest here = farthest_off(plane, f); here.distance > farthest.distance) farthest = here;
  if (farthest.distance <= width_) return take(group, plane, false);
  leave_exact(group, farthest);
}

void CoplanarGroups::take(std::span<const std::uint32_t> group, const FittedPlane& plane, bool exactly) {
  const std::uint32_t root = group[0];
  for (const std::uint32_t f : group) root_[f] = root;
  faces_.facets[root].axis = axes_by_size(plane.normal())[0];
  faces_.facets[root].planar = faces_.facets[root].planar && exactly;
}

void CoplanarGroups::leave_exact(std::span<const std::uint32_t> group, const Farthest& farthest) {
  const auto number = [this](std::uint32_t f) { return report_.number(faces_.facets[f].input); };
  const std::string words = std::to_string(group.size()) + " from facet " + std::to_string(number(group[0])) + " on, point " +
                            report_.point_words(farthest.point) + " is off by " + to_text(farthest.distance / in_.scale);
  if (in_.plc.tolerance)
    report_.attempt([&] {
      report_.fail(Errc::ambiguous,
                   "facets of which each lies in one plane with the next, within the tolerance, but not all together: " + words,
                   SourceItem::facet, faces_.facets[group[0]].input, {number(group[0]), report_.point_number(farthest.point)},
                   {in_.points[farthest.point].x});
    });
  report_.repairs.ambiguous_planes.add([&] { return words; }, {number(group[0]), report_.point_number(farthest.point)});
  std::vector<std::uint32_t> by_plane(group.begin(), group.end());
  std::stable_sort(by_plane.begin(), by_plane.end(),
                   [this](std::uint32_t f, std::uint32_t g) { return exactly_.find(f) < exactly_.find(g); });
  const std::span<const std::uint32_t> all(by_plane);
  for (std::size_t begin = 0, end; begin < all.size(); begin = end) {
    FittedPlane plane = planes_[all[begin]];
    for (end = begin + 1; end < all.size() && exactly_.find(all[end]) == exactly_.find(all[begin]); ++end)
      plane.add(planes_[all[end]]);
    if (end - begin > 1) take(all.subspan(begin, end - begin), plane, true);
  }
}

}  // namespace pgdr::detail
