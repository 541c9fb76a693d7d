// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The input as given, cut into what can be compared with a mesh: segments, and triangles of facets. Nothing is joined here, and
// nothing of Domain is used: a facet of three corners is its triangle, any other one is the constrained triangulation of its own
// polygons in the projection in which most of it is seen. Immutable once made.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "given/findings.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::checking {

/// What the input says is a segment: one of Plc::segments; in 3D also a facet of one polygon of two corners, and an edge of a
/// polygon that lies inside of its facet, or outside. Edges that bound a facet are in the mesh where it is covered.
struct GivenSegment {
  std::array<std::uint32_t, 2> points;  ///< distinct places; indices into Plc::points
  int marker = 0;                       ///< that of its subsegments
  std::uint32_t item = 0;               ///< index in Plc::segments, or in Plc::facets, for messages
  bool of_facet = false;                ///< the latter
};

/// A part of a facet that is not flat.
struct GivenTriangle {
  std::array<std::uint32_t, 3> points;  ///< indices into Plc::points
  std::uint32_t facet = 0;              ///< index in Plc::facets
};

template <int D>
class GivenInput {
 public:
  /// @param tolerance absolute; none: the default of the contract.
  /// @throws InputError index_out_of_range, not_finite. Facets that have no triangulation are findings.
  GivenInput(const Plc<D>& plc, std::optional<double> tolerance, Findings& findings);

  const Plc<D>& plc() const { return *plc_; }
  const Point<D>& point(std::uint32_t p) const { return plc_->points[p]; }
  /// The same number for all points with the same coordinates: the least of them.
  std::uint32_t place(std::uint32_t p) const { return places_[p]; }
  double tolerance() const { return tolerance_; }
  /// 2 ulps of the largest coordinate: how far rounding moves a point of the mesh that is computed to lie on something.
  double rounding() const { return rounding_; }
  /// The tolerance and that.
  double reach() const { return tolerance_ + rounding_; }
  std::span<const GivenSegment> segments() const { return segments_; }
  /// 3D: facet by facet.
  std::span<const GivenTriangle> triangles() const { return triangles_; }
  int marker(const GivenTriangle& t) const { return plc_->facets[t.facet].marker; }
  /// 3D: how far apart two triangulations of the facet may be: all its points lie between two parallel planes as far apart.
  double bend(std::uint32_t facet) const { return bends_[facet]; }
  std::array<Point<D>, 3> corners(const GivenTriangle& t) const {
    return {{point(t.points[0]), point(t.points[1]), point(t.points[2])}};
  }

 private:
  void require_usable() const;
  void add_segment(const GivenSegment& segment);
  void add_facets(Findings& findings);

  const Plc<D>* plc_;
  double tolerance_ = 0, rounding_ = 0;
  std::vector<std::uint32_t> places_;
  std::vector<GivenSegment> segments_;
  std::vector<GivenTriangle> triangles_;
  std::vector<double> bends_;
};

/// What the contract of the input says without a tolerance: 8 ulps of a double at the largest coordinate; 2 ulps of a float
/// there, where the numbers are floats and that is at most a millionth of the diagonal of the input.
template <int D>
double default_tolerance(const Plc<D>& plc);

}  // namespace pgdr::checking
