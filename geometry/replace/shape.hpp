// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Angles of facets as the mesher gets them: a counted corner is the sum of the angles of consecutive faces of one flat group
// about a vertex, from one edge that is not inside of the group to the next. Angles are compared by the tangents of their halves,
// which are sums, products, quotients and roots of coordinates.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "replace/change.hpp"
#include "replace/complex.hpp"

namespace pgdr::detail {

/// An angle from 0 to 180 degrees by the tangent of its half; infinite: 180 or more, or none.
using HalfTangent = double;
inline constexpr HalfTangent wide_corner = std::numeric_limits<double>::infinity();

/// Of so many degrees, correctly rounded up to some ulps.
HalfTangent half_tangent(double degrees);
/// For reports.
double degrees_of(HalfTangent t);

/// Which faces go with a change and which come, vertex by vertex. Of a vertex where hundreds of faces meet both are many, and
/// each is asked for at each of its corners.
class PatchIndex {
 public:
  PatchIndex() = default;
  explicit PatchIndex(const SurfaceChange& change);

  bool is_gone(std::uint32_t f) const { return std::binary_search(gone_.begin(), gone_.end(), f); }
  /// The numbers in `come` of the faces at a vertex, ascending.
  std::span<const std::uint32_t> come_at(std::uint32_t v) const;

 private:
  std::vector<std::uint32_t> gone_;      // ascending
  std::vector<std::uint32_t> vertices_;  // of the faces that come, ascending, each as often as it is a corner
  std::vector<std::uint32_t> come_;      // beside these, the faces
};

/// A surface as it is, or as it would be after a change. Faces that would come are numbered after all others.
class SurfaceView {
 public:
  explicit SurfaceView(const SurfaceComplex& s, const SurfaceChange* after = nullptr) : s_(s), after_(after) {
    if (after && std::max(after->come.size(), after->gone.size()) > few) index_.emplace(*after);
  }

  const SurfaceFace& face(std::uint32_t f) const { return f < s_.faces.size() ? s_.faces[f] : after_->come[f - s_.faces.size()]; }
  const Point3& at(std::uint32_t v) const { return after_ ? place_after(s_, *after_, v) : s_.at(v); }
  bool is_kept(std::uint32_t a, std::uint32_t b) const;
  /// What is within this of each other is joined.
  double joined() const { return s_.joined; }
  /// Calls visit(f) for each face at an edge.
  template <class Visit>
  void each_face_at(std::uint32_t a, std::uint32_t b, const Visit& visit) const {
    const auto count = [this](std::uint32_t v) { return v < s_.points.size() ? s_.faces_at[v].size() : 0; };
    if (count(b) < count(a)) std::swap(a, b);
    if (count(a) > 0)
      for (const std::uint32_t f : s_.faces_at[a])
        if (s_.has_corner(f, b) && !is_gone(f)) visit(f);
    each_that_comes(a, b, visit);
  }
  /// Calls visit(f) for each face at a vertex.
  template <class Visit>
  void each_face_of(std::uint32_t v, const Visit& visit) const {
    if (v < s_.points.size())
      for (const std::uint32_t f : s_.faces_at[v])
        if (!is_gone(f)) visit(f);
    each_that_comes(v, v, visit);
  }
  /// The other face at a plain edge.
  std::uint32_t beyond(std::uint32_t f, std::uint32_t a, std::uint32_t b) const {
    std::uint32_t other = no_index;
    each_face_at(a, b, [&](std::uint32_t g) {
      if (g != f) other = g;
    });
    return other;
  }
  /// The one other face of its class at an edge; no_index: there is none, or there are more.
  std::uint32_t only_other(std::uint32_t f, std::uint32_t a, std::uint32_t b) const {
    std::uint32_t other = no_index, count = 0;
    each_face_at(a, b, [&](std::uint32_t g) {
      if (g == f || face(g).klass != face(f).klass) return;
      other = g;
      ++count;
    });
    return count == 1 ? other : no_index;
  }
  bool is_new(std::uint32_t f) const { return f >= s_.faces.size(); }
  bool is_gone(std::uint32_t f) const { return after_ && (index_ ? index_->is_gone(f) : after_->is_gone(f)); }

 private:
  static constexpr std::size_t few = 16;  // all are looked at as soon as an index is asked

  /// Those that have both corners.
  template <class Visit>
  void each_that_comes(std::uint32_t a, std::uint32_t b, const Visit& visit) const {
    if (!after_) return;
    const auto visit_if = [&](std::uint32_t k) {
      const auto& c = after_->come[k].corners;
      const auto has = [&c](std::uint32_t v) { return c[0] == v || c[1] == v || c[2] == v; };
      if (has(a) && has(b)) visit(static_cast<std::uint32_t>(s_.faces.size() + k));
    };
    if (index_) {
      const auto of_a = index_->come_at(a), of_b = index_->come_at(b);
      for (const std::uint32_t k : of_a.size() < of_b.size() ? of_a : of_b) visit_if(k);
    } else {
      for (std::uint32_t k = 0; k < after_->come.size(); ++k) visit_if(k);
    }
  }

  const SurfaceComplex& s_;
  const SurfaceChange* after_;
  std::optional<PatchIndex> index_;
};

/// The faces of one group about a vertex that a face is one of.
struct Sector {
  HalfTangent angle = wide_corner;
  bool is_all_round = false;         ///< the vertex is inside of the group
  bool between_kept = false;         ///< both of its ends are kept edges: it is not counted
  std::vector<std::uint32_t> faces;  ///< all of it; empty: the face alone
};
Sector sector_at(const SurfaceView& view, std::uint32_t face, std::uint32_t vertex);

/// The least counted corner of a face.
HalfTangent least_corner(const SurfaceComplex& s, std::uint32_t face);

/// The corners that a change takes away, and that it makes.
struct CornerChange {
  HalfTangent gone = wide_corner, come = wide_corner;            ///< least counted ones
  HalfTangent kept_gone = wide_corner, kept_come = wide_corner;  ///< least ones between two kept edges
  /// Least of the corners beyond the rim that get smaller since faces have left their group; and is each at least the lesser
  /// of what it was and `rim_floor`?
  HalfTangent rim = wide_corner;
  bool is_rim_fine = true;
};
CornerChange corners_of(const SurfaceComplex& s, const SurfaceChange& change, HalfTangent rim_floor);

/// What a mesh is expected to have for corners and edges of facets, in parts of a cell: whole numbers, whose sums do not depend
/// on their order. The number of cells is, up to a factor, the integral of the -2nd power of the local feature size over the
/// surface: of a corner the length of its sides over their distance. An edge of facets is a segment of the mesh, which is split
/// if a vertex is in its diametral ball; the point makes two faces more.
struct Expected {
  std::int64_t cells = 0;
  std::int64_t poor = 0;  ///< those of them that counted corners leave over a bound

  Expected& operator+=(const Expected& o) {
    cells += o.cells;
    poor += o.poor;
    return *this;
  }
  Expected& operator-=(const Expected& o) {
    cells -= o.cells;
    poor -= o.poor;
    return *this;
  }
  /// Poor ones count as so many.
  std::int64_t weighed(std::int64_t weight) const { return cells + (weight - 1) * poor; }
};
Expected expected_of(const Sector& corner);
/// Does an edge of a face make more expect?
bool has_encroached_edge(const SurfaceView& view, std::uint32_t face);
/// Of the edges of some faces, each once.
Expected expected_of_edges(const SurfaceView& view, std::span<const SurfaceFace> faces);
/// Of the corners and edges that come with a change, less that of those that go, beyond its rim, too.
Expected expected_growth(const SurfaceComplex& s, const SurfaceChange& change);

/// Does it make no ridge that was not there: is the least cosine between normals across plain edges at least that of before, or
/// `floor`?
bool keeps_folds(const SurfaceComplex& s, const SurfaceChange& change, double floor);

}  // namespace pgdr::detail
