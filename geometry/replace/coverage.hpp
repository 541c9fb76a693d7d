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

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <vector>

#include "numbers/vectors.hpp"
#include "pgdr/types.hpp"
#include "space/box.hpp"
#include "space/distances.hpp"

namespace pgdr::detail {

/// A convex polygon in space. Plain storage, since hundreds are made for one question; corners beyond its own are never written.
class CutPolygon {
 public:
  static constexpr std::size_t most_corners = 28;

  CutPolygon() = default;
  explicit CutPolygon(const std::array<Point3, 3>& t) : count_(3) { std::copy(t.begin(), t.end(), first()); }
  CutPolygon(const CutPolygon& o) : count_(o.count_) { std::copy_n(o.first(), count_, first()); }
  CutPolygon& operator=(const CutPolygon& o) {
    if (this != &o) std::copy_n(o.first(), o.count_, first());
    count_ = o.count_;
    return *this;
  }

  std::size_t count() const { return count_; }
  const Point3& operator[](std::size_t k) const { return first()[k]; }
  std::span<const Point3> all() const { return {first(), count_}; }
  void clear() { count_ = 0; }
  /// @returns false if it has too many already
  bool add(const Point3& p) {
    if (count_ == most_corners) return false;
    first()[count_++] = p;
    return true;
  }

 private:
  // Points are objects of the bytes' lifetime, as for any type that is an aggregate and needs no destructor.
  Point3* first() { return std::launder(reinterpret_cast<Point3*>(bytes_.data())); }
  const Point3* first() const { return std::launder(reinterpret_cast<const Point3*>(bytes_.data())); }

  alignas(Point3) std::array<std::byte, most_corners * sizeof(Point3)> bytes_;
  std::size_t count_ = 0;
};

/// The part of a polygon on the side of a plane where dot(normal, x) <= offset, and the one beyond. @returns false if one of them
/// has too many corners
bool cut(const CutPolygon& polygon, const Vector<3>& normal, double offset, CutPolygon& inside, CutPolygon& beyond);
/// The part of it in a box; of no corners if none is. @returns false if it has too many corners
bool cut_to_box(CutPolygon& polygon, const Box<3>& box);

/// Triangles that are to cover something, or some of them. May be asked by one thread at a time.
///
/// A part is looked at beside the triangles whose boxes come near its own, which are found among those of the part that it was
/// cut off: so a question takes about n log n steps of n parts and triangles, not n^2. What is left out is farther from the part
/// than e, and would have had no part in any answer.
class Cover {
 public:
  explicit Cover(double e) : e_(e), square_(e * e) {
    constexpr std::size_t usual = 32;
    boxes_.reserve(usual);
    triangles_.reserve(usual);
    numbers_.reserve(usual);
  }
  /// Its corners in the order of their coordinates, so that no decision hangs on their numbers.
  void add(const std::array<Point3, 3>& sorted_corners);
  std::size_t size() const { return triangles_.size(); }
  const Box<3>& box(std::size_t t) const { return boxes_[t]; }
  /// The numbers of those from one on and before another, until one is added.
  std::span<const std::uint32_t> between(std::size_t first, std::size_t last) const {
    return std::span(numbers_).subspan(first, last - first);
  }

  /// Takes those of these numbers in use with is_used(number), which covers() asks.
  template <class IsUsed>
  void use(std::span<const std::uint32_t> numbers, const IsUsed& is_used) {
    lists_.clear();
    for (const std::uint32_t t : numbers)
      if (is_used(t)) lists_.push_back(t);
  }
  /// Is each point of the polygon within e of those in use? @param first, each  so many parts are looked at, and so many more a
  /// triangle
  bool covers(const CutPolygon& polygon, std::size_t first, std::size_t each);
  /// Is each point of a polygon within e of one of these triangles? Then they cover it.
  bool has_one_near(std::span<const Point3> corners, std::span<const std::uint32_t> numbers) const;
  /// Is a point within e of one of these triangles? Where it is not they cover nothing that has it.
  bool reaches(const Point3& p, std::span<const std::uint32_t> numbers) const;
  /// Around what is within e of this box, and a little more for rounding: e may be no more than some hundred ulps.
  Box<3> with_margin(const Box<3>& box) const { return box.widened(1.0625 * e_); }

 private:
  struct Triangle {
    std::array<Point3, 3> corners;
    std::uint32_t distance = none, plane = none;  ///< where they are, once they have been asked for
  };
  struct Plane {
    Vector<3> normal{};                  ///< of length 1
    std::array<Vector<3>, 3> outward{};  ///< of length 1, in the plane, normal to edge i from corner i to the next
    bool is_one = false;                 ///< is there such a plane?
  };
  /// Those of lists_ that have to do with a part.
  struct List {
    std::size_t first, last;
  };
  static constexpr std::uint32_t none = 0xffffffffu;

  std::span<const std::uint32_t> numbers(const List& list) const {
    return std::span(lists_).subspan(list.first, list.last - list.first);
  }
  List narrowed(const List& list, const Box<3>& box);
  bool look(const CutPolygon& polygon, const List& wide, int depth, std::size_t& left);
  std::size_t nearest(const Point3& p, const List& list) const;
  bool might_hold(std::size_t t, const Box<3>& box) const;
  bool holds(std::size_t t, std::span<const Point3> corners) const;
  const TriangleDistance& distance_of(std::size_t t) const;
  const Plane& plane_of(std::size_t t);
  bool look_beyond(std::size_t t, const CutPolygon& polygon, const Point3& centre, const List& list, int depth, std::size_t& left,
                   bool& was_cut);
  bool look_at_halves(const CutPolygon& polygon, const List& list, int depth, std::size_t& left);

  double e_, square_;
  std::vector<Box<3>> boxes_;  // beside the triangles, as most are looked at no closer
  mutable std::vector<Triangle> triangles_;
  mutable std::vector<TriangleDistance> distances_;  // of those that are not told apart by their boxes
  std::vector<std::uint32_t> numbers_;               // of all
  std::vector<Plane> planes_;                        // of those that were asked for it
  std::vector<std::uint32_t> lists_;                 // those in use, then those of parts that are being looked at
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
