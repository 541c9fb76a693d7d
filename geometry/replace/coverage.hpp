// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Is every point of a polygon within a distance e of the union of some triangles? Yes is a proof, no is none.
//
// A polygon is cut by what one triangle has beside and above it, so that a whole strip beside a coplanar triangle is one cut.
// Parts are accepted if all their corners are within e of one triangle: the distance from one convex set is a convex function.
// The parts cover the polygon but for the rounding of cut points, which lie within 3 ulps of the edges that they cut, at most
// `deepest` cuts one after the other. So after a yes every point is within e and some ulps; after a no at a part whose diameter
// is below e / 16 its centre is farther than 15/16 e from all of them, or the part is at a border, or too many parts were made.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "numbers/vectors.hpp"
#include "pgdr/types.hpp"
#include "space/box.hpp"

namespace pgdr::detail {

/// A convex polygon in space. Plain storage, since hundreds are made for one question.
struct CutPolygon {
  static constexpr std::size_t most_corners = 28;
  std::array<Point3, most_corners> corners;
  std::size_t count = 0;

  CutPolygon() = default;
  explicit CutPolygon(const std::array<Point3, 3>& t) : count(3) { std::copy(t.begin(), t.end(), corners.begin()); }
  std::span<const Point3> all() const { return std::span(corners).first(count); }
  /// @returns false if it has too many already
  bool add(const Point3& p) {
    if (count == most_corners) return false;
    corners[count++] = p;
    return true;
  }
};

/// The part of a polygon on the side of a plane where dot(normal, x) <= offset, and the one beyond. @returns false if one of them
/// has too many corners
bool cut(const CutPolygon& polygon, const Vector<3>& normal, double offset, CutPolygon& inside, CutPolygon& beyond);
/// The part of it in a box; of no corners if none is. @returns false if it has too many corners
bool cut_to_box(CutPolygon& polygon, const Box<3>& box);

/// Triangles that are to cover something.
class Cover {
 public:
  explicit Cover(double e) : e_(e) {}
  void clear() { triangles_.clear(); }
  /// Its corners in the order of their coordinates, so that no decision hangs on their numbers.
  void add(const std::array<Point3, 3>& sorted_corners);
  std::size_t size() const { return triangles_.size(); }
  /// Is each point of the polygon within e of these? @param first, each  so many parts are looked at, and so many more a triangle
  bool covers(const CutPolygon& polygon, std::size_t first, std::size_t each) const;

 private:
  struct Triangle {
    std::array<Point3, 3> corners;
    Box<3> box;
    Vector<3> normal{};                  ///< of length 1
    std::array<Vector<3>, 3> outward{};  ///< of length 1, in the plane, normal to edge i from corner i to the next
    bool has_plane = false;
  };
  bool look(const CutPolygon& polygon, int depth, std::size_t& left) const;
  const Triangle* nearest(const Point3& p, double& square) const;
  bool holds(const Triangle& t, const CutPolygon& polygon) const;
  bool look_beyond(const Triangle& t, const CutPolygon& polygon, int depth, std::size_t& left, bool& was_cut) const;
  bool look_at_halves(const CutPolygon& polygon, int depth, std::size_t& left) const;

  double e_;
  std::vector<Triangle> triangles_;
};

/// Segments that are to cover one.
class SegmentCover {
 public:
  explicit SegmentCover(double e) : e_(e) {}
  void clear() { segments_.clear(); }
  void add(const Point3& a, const Point3& b) { segments_.push_back({a, b}); }
  bool covers(const Point3& a, const Point3& b) const;

 private:
  bool look(const Point3& a, const Point3& b, std::size_t& left) const;

  double e_;
  std::vector<std::array<Point3, 2>> segments_;
};

}  // namespace pgdr::detail
