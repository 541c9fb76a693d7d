// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Flat groups. All faces of one are near one plane, that of its largest face: neighbours that are flat two and two chain round a
// cylinder.
#include <cmath>
#include <numeric>

#include "input/diagonal.hpp"
#include "join/numbers.hpp"
#include "pgdr/predicates.hpp"
#include "replace/complex.hpp"
#include "replace/numbers.hpp"
#include "space/box.hpp"
#include "space/triangle.hpp"

namespace pgdr::detail {
namespace {

class GroupFinder {
 public:
  GroupFinder(SurfaceComplex& surface, double tolerance) : s_(surface), tolerance_(tolerance), looked_(surface.faces.size()) {}

  void find() {
    std::vector<double> areas(s_.faces.size());
    std::vector<std::uint32_t> order;
    for (std::uint32_t f = 0; f < s_.faces.size(); ++f) {
      areas[f] = dot(normal_of(f), normal_of(f));
      if (areas[f] > 0) order.push_back(f);
    }
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      if (areas[a] != areas[b]) return areas[a] > areas[b];
      return triangle_less(s_.triangle(a), s_.triangle(b));
    });
    for (const std::uint32_t f : order)
      if (!looked_[f]) grow(f);
  }

 private:
  /// Whichever way round its corners are.
  Vector<3> normal_of(std::uint32_t f) const {
    auto t = s_.triangle(f);
    sort_corners(t);
    return cross(difference(t[1], t[0]), difference(t[2], t[0]));
  }

  static int largest_axis(const Vector<3>& n) {
    int axis = 0;
    for (int i = 1; i < 3; ++i)
      if (std::fabs(n[static_cast<std::size_t>(i)]) > std::fabs(n[static_cast<std::size_t>(axis)])) axis = i;
    return axis;
  }

  /// The mesher takes a polygon for one facet if it is bent by no more than a part of its extent, which is known once it has
  /// grown: it grows anew within that, until it is as large as what it may be off its plane says.
  void grow(std::uint32_t seed) {
    FlatGroup group;
    group.normal = normal_of(seed);
    const double length = std::sqrt(dot(group.normal, group.normal));
    for (double& x : group.normal) x /= length;
    auto t = s_.triangle(seed);
    sort_corners(t);
    group.anchor = t[0];
    group.axis = largest_axis(group.normal);
    looked_[seed] = true;
    for (double flatness = s_.flatness; true; flatness = group.bend) {
      const std::vector<std::uint32_t> members = members_of(group, seed, flatness);
      if (members.size() < 2) return;
      Box<3> box = Box<3>::empty();
      for (const std::uint32_t f : members)
        for (const Point3& p : s_.triangle(f)) box.add(p);
      group.bend = most_bend_of(s_, box);
      if (flatness <= group.bend) return add(group, members);
      for (const std::uint32_t f : members) looked_[f] = f == seed;
    }
  }

  /// All that hangs together with a face, within what the group may be off its plane.
  std::vector<std::uint32_t> members_of(const FlatGroup& group, std::uint32_t seed, double flatness) {
    std::vector<std::uint32_t> members{seed};
    const auto& corners = s_.faces[seed].corners;
    const Sign way = orient_projected(s_.at(corners[0]), s_.at(corners[1]), s_.at(corners[2]), group.axis);
    if (way == Sign::zero) return members;
    for (std::size_t next = 0; next < members.size(); ++next) {
      const auto c = s_.faces[members[next]].corners;
      const bool turned = orient_projected(s_.at(c[0]), s_.at(c[1]), s_.at(c[2]), group.axis) != way;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = c[turned ? (i + 1) % 3 : i], b = c[turned ? i : (i + 1) % 3];
        if (s_.is_kept(a, b)) continue;
        const std::uint32_t g = s_.beyond(members[next], a, b);
        if (g == no_index || looked_[g]) continue;
        const std::uint32_t d = corner_beside(s_.faces[g].corners, a, b);
        if (height_over(group, s_.at(d)) > flatness) continue;
        if (orient_projected(s_.at(b), s_.at(a), s_.at(d), group.axis) != way) continue;
        looked_[g] = true;
        members.push_back(g);
      }
    }
    return members;
  }

  void add(FlatGroup group, const std::vector<std::uint32_t>& members) {
    Box<3> box = Box<3>::empty();
    std::vector<double> areas;
    for (const std::uint32_t f : members) {
      const auto n = normal_of(f);
      areas.push_back(std::sqrt(dot(n, n)) / 2);
      for (const Point3& p : s_.triangle(f)) box.add(p);
      s_.faces[f].group = static_cast<std::uint32_t>(s_.groups.size());
    }
    std::sort(areas.begin(), areas.end());  // a sum that does not hang on the order of the members
    group.is_wide = std::accumulate(areas.begin(), areas.end(), 0.0) > numbers::wide_group * tolerance_ * diagonal_of(box);
    s_.groups.push_back(group);
  }

  SurfaceComplex& s_;
  double tolerance_;
  std::vector<bool> looked_;
};

}  // namespace

double most_bend_of(const SurfaceComplex& s, const Box<3>& box) {
  return std::max(s.joined, numbers::group_bend * numbers::most_bend * box.longest_side());
}

void find_groups(SurfaceComplex& surface, double flatness, double joined, double tolerance) {
  surface.flatness = std::max(flatness, joined);
  surface.joined = joined;
  GroupFinder(surface, tolerance).find();
}

}  // namespace pgdr::detail
