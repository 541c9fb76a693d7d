// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What was given and is not in the mesh must lie outside of all cells: whether it may, the volumes tell. What leaves the
// mesh at an angle a stays within r of it for r / a. So a leftover of diameter d is a finding where it lies within r of a cell
// for more than sqrt(r d): any angle above sqrt(r / d) makes less. Two r are tried. Rounding finds what lies between cells or in
// them, and is so small that little is missed. The tolerance less rounding finds what lies beside the hull, where it should have
// been joined: what is farther away may have been found to be outside. A point is compared exactly, or by the latter, and then
// with what was given, too, from which the hull may be a tolerance away where other points were joined.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "given/cover.hpp"
#include "given/match.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/box_tree.hpp"
#include "space/distances.hpp"

namespace pgdr::checking {
namespace {

using detail::cross;
using detail::difference;
using detail::dot;
using detail::Vector;

/// Points with low <= n . (x - origin) <= high.
template <int D>
struct Slab {
  Vector<D> n;  // of length 1
  Point<D> origin;
  double low, high;
};

/// What of u is square to a direction of length 1. Twice: the first time leaves the rounding of what was taken off.
template <int D>
Vector<D> square_part(Vector<D> u, const Vector<D>& direction) {
  for (int twice = 0; twice < 2; ++twice) {
    const double along = dot(u, direction);
    for (int k = 0; k < D; ++k) u[k] -= along * direction[k];
  }
  return u;
}

/// @return whether it has a direction
template <int D>
bool normalize(Vector<D>& u) {
  const double length = std::sqrt(dot(u, u));
  for (double& x : u) x /= length;
  return length > 0;
}

/// The cell and what is within r of it, between pairs of parallel planes that touch this: along each edge, and square to it along
/// and across each face. Both planes of a pair are where the corners are, so rounding turns them a little and no more: which side
/// of a face a flat cell is on nobody has to tell. They end at a sharp edge or corner, where planes of the faces alone go on.
template <int D>
std::vector<Slab<D>> widened_cell(const Simplex<D>& s, double r) {
  std::vector<Slab<D>> out;
  const auto add = [&](const Vector<D>& n) {
    double low = 0, high = 0;
    for (int i = 1; i <= D; ++i) {
      const double height = dot(difference(s[i], s[0]), n);
      low = std::min(low, height);
      high = std::max(high, height);
    }
    out.push_back({n, s[0], low - r, high + r});
  };
  for (int i = 0; i <= D; ++i)
    for (int j = i + 1; j <= D; ++j) {
      auto edge = difference(s[j], s[i]);
      if (!normalize<D>(edge)) continue;
      add(edge);
      for (int k = 0; k <= D; ++k) {
        if (k == i || k == j) continue;
        auto off = square_part<D>(difference(s[k], s[i]), edge);
        if (!normalize<D>(off)) continue;
        add(off);
        if constexpr (D == 3) add(cross(edge, off));
      }
    }
  return out;
}

/// The part of a convex point set (a point, a segment, a polygon) where a height above a plane is at most 0.
template <int D, class Height>
std::vector<Point<D>> clip(const std::vector<Point<D>>& corners, const Height& height) {
  std::vector<Point<D>> out;
  const std::size_t n = corners.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Point<D>&p = corners[k], &q = corners[(k + 1) % n];
    const double of_p = height(p), of_q = height(q);
    if (of_p <= 0) out.push_back(p);
    if (n == 1 || (n == 2 && k == 1) || !((of_p < 0 && of_q > 0) || (of_p > 0 && of_q < 0))) continue;
    const double t = of_p / (of_p - of_q);
    Point<D> x;
    for (int i = 0; i < D; ++i) x[i] = p[i] + t * (q[i] - p[i]);
    out.push_back(x);
  }
  return out;
}

template <int D>
std::vector<Point<D>> clip_between(const std::vector<Point<D>>& corners, const Slab<D>& slab) {
  const auto along = [&](const Point<D>& x) { return dot(difference(x, slab.origin), slab.n); };
  const auto below = clip<D>(corners, [&](const Point<D>& x) { return along(x) - slab.high; });
  return clip<D>(below, [&](const Point<D>& x) { return slab.low - along(x); });
}

/// The largest distance of two corners, and for a polygon the largest one of a corner from the line of these two.
template <int D>
std::array<double, 2> extents(const std::vector<Point<D>>& corners) {
  double longest = 0, widest = 0;
  Point<D> a{}, b{};
  for (const auto& p : corners)
    for (const auto& q : corners)
      if (const double d = std::sqrt(squared_distance(p, q)); d > longest) {
        longest = d;
        a = p;
        b = q;
      }
  if (longest == 0) return {0, 0};
  const auto along = difference(b, a);
  for (const auto& p : corners) {
    auto off = difference(p, a);
    const double t = dot(off, along) / dot(along, along);
    for (int i = 0; i < D; ++i) off[i] -= t * along[i];
    widest = std::max(widest, std::sqrt(dot(off, off)));
  }
  return {longest, widest};
}

template <int D>
class LeftoverChecker {
 public:
  LeftoverChecker(const GivenTask<D>& task, const GivenMatch<D>& match)
      : task_(task), mesh_(task.mesh), match_(match), reported_(match.leftovers.size(), 0) {}

  void run() {
    if (match_.leftovers.empty()) return;
    look(task_.input.rounding(), true);
    const double joined = task_.input.tolerance() - task_.input.rounding();
    if (joined > task_.input.rounding()) look(joined, false);
  }

 private:
  void look(double r, bool exactly) {
    std::vector<detail::Box<D>> boxes;
    limits_.clear();
    for (const auto& leftover : match_.leftovers) {
      boxes.push_back(detail::Box<D>::of(leftover.corners).widened(r));
      limits_.push_back(std::sqrt(r * extents(leftover.corners)[0]));
    }
    const detail::BoxTree<D> tree(boxes);
    for (std::uint32_t c = 0; c < mesh_.cells.size(); ++c) {
      task_.findings.heed_stop();
      const Simplex<D> s = corners_of(mesh_, c);
      std::vector<Slab<D>> cell;
      tree.meeting(detail::Box<D>::of(s), [&](std::uint32_t i) {
        if (reported_[i]) return;
        if (cell.empty()) cell = widened_cell<D>(s, r);
        compare(c, i, cell, exactly);
      });
    }
  }

  /// `exactly`: a point that is beside the cell is not in it, however near it is.
  void compare(std::uint32_t c, std::uint32_t i, const std::vector<Slab<D>>& cell, bool exactly) {
    const Leftover<D>& leftover = match_.leftovers[i];
    if (exactly && leftover.kind == EntityKind::vertex && !has(corners_of(mesh_, c), leftover.corners[0])) return;
    if (!exactly && leftover.kind == EntityKind::vertex && !is_near_given(leftover)) return;
    std::vector<Point<D>> part = leftover.corners;
    for (auto slab = cell.begin(); slab != cell.end() && !part.empty(); ++slab) part = clip_between<D>(part, *slab);
    if (part.empty()) return;
    const auto [length, width] = extents(part);
    // The mesh may be off a facet by its reach, and so may the border of what is left of it.
    const bool large = leftover.kind == EntityKind::vertex    ? true
                       : leftover.kind == EntityKind::segment ? length > limits_[i]
                                                              : width > std::max(limits_[i], 2 * match_.reach[leftover.id]);
    if (!large) return;
    reported_[i] = 1;
    report(c, leftover, part[0]);
  }

  /// Whether it lies within what is joined of a given segment or triangle. One that it is a corner of counts if it is in the
  /// mesh.
  bool is_near_given(const Leftover<D>& point) {
    const double r = task_.input.tolerance() - task_.input.rounding();
    const Point<D>& x = point.corners[0];
    if (!given_tree_) plant_given(r);
    bool near = false;
    given_tree_->at(x, [&](std::uint32_t i) {
      const auto segments = task_.input.segments();
      const auto is_left = [&](EntityKind kind, std::uint32_t id, const auto& corners) {
        return std::ranges::find(corners, point.id) != corners.end() && is_left_at(kind, id, x);
      };
      if (near) return;
      if (i < segments.size()) {
        const auto& ends = segments[i].points;
        near = is_near<D>(x, {task_.input.point(ends[0]), task_.input.point(ends[1])}, r) &&
               !is_left(EntityKind::segment, i, ends);
      } else if constexpr (D == 3) {
        const auto t = static_cast<std::uint32_t>(i - segments.size());
        const GivenTriangle& given = task_.input.triangles()[t];
        const auto corners = task_.input.corners(given);
        near = detail::closest_to_triangle(x, corners[0], corners[1], corners[2]).square <= r * r &&
               !is_left(EntityKind::facet, t, given.points);
      }
    });
    return near;
  }

  bool is_left_at(EntityKind kind, std::uint32_t id, const Point<D>& x) const {
    const double r = 10 * task_.input.reach();
    return std::ranges::any_of(match_.leftovers, [&](const Leftover<D>& l) {
      return l.kind == kind && l.id == id &&
             std::ranges::any_of(l.corners, [&](const Point<D>& c) { return squared_distance(c, x) <= r * r; });
    });
  }

  void plant_given(double r) {
    std::vector<detail::Box<D>> boxes;
    for (const GivenSegment& s : task_.input.segments()) {
      boxes.push_back(detail::Box<D>::around(task_.input.point(s.points[0])));
      boxes.back().add(task_.input.point(s.points[1]));
      boxes.back() = boxes.back().widened(r);
    }
    for (const GivenTriangle& t : task_.input.triangles())
      if constexpr (D == 3) boxes.push_back(detail::Box<D>::of(task_.input.corners(t)).widened(r));
    given_tree_ = std::make_unique<detail::BoxTree<D>>(boxes);
  }

  static bool has(const Simplex<D>& s, const Point<D>& x) {
    for (int i = 0; i <= D; ++i) {
      Simplex<D> t = s;
      t[i] = x;
      if (orient<D>(t) == Sign::negative) return false;
    }
    return true;
  }

  void report(std::uint32_t c, const Leftover<D>& leftover, const Point<D>& where) {
    const GivenInput<D>& input = task_.input;
    if (leftover.kind == EntityKind::vertex) {
      task_.findings.add(Kind::missing_input_point, {leftover.id}, [&] {
        return "Input point " + std::to_string(leftover.id) + " " + words(where) + " is no vertex of the mesh, but lies in " +
               cell_words(mesh_, c) + ".";
      });
    } else if (leftover.kind == EntityKind::segment) {
      const GivenSegment& s = input.segments()[leftover.id];
      task_.findings.add(Kind::segment_not_conforming, {s.item}, [&] {
        return "No subsegment of marker " + std::to_string(s.marker) + " covers " + (s.of_facet ? "facet " : "segment ") +
               std::to_string(s.item) + " of the input, from point " + std::to_string(s.points[0]) + " to " +
               std::to_string(s.points[1]) + ", at " + words(where) + ", in " + cell_words(mesh_, c) + ".";
      });
    } else {
      const std::uint32_t f = input.triangles()[leftover.id].facet;
      task_.findings.add(Kind::facet_not_conforming, {f}, [&] {
        return "No subfacet covers facet " + std::to_string(f) + " of the input at " + words(where) + ", in " +
               cell_words(mesh_, c) + ".";
      });
    }
  }

  const GivenTask<D>& task_;
  const OutputMesh<D>& mesh_;
  const GivenMatch<D>& match_;
  std::vector<std::uint8_t> reported_;
  std::vector<double> limits_;
  std::unique_ptr<detail::BoxTree<D>> given_tree_;  // segments, then triangles
};

}  // namespace

template <int D>
void check_leftovers(const GivenTask<D>& task, const GivenMatch<D>& match) {
  LeftoverChecker<D>(task, match).run();
}

template void check_leftovers(const GivenTask<2>&, const GivenMatch<2>&);
template void check_leftovers(const GivenTask<3>&, const GivenMatch<3>&);

}  // namespace pgdr::checking
