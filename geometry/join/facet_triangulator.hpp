// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The second step of a Domain (3D): each input facet becomes triangles, in the projection along the largest component of
// its normal. A facet of three points is its triangle; any other goes through the planar triangulation, from which is
// taken away what is reached from outside and from its hole seeds.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "join/build_input.hpp"
#include "join/build_report.hpp"
#include "join/clean_facet.hpp"
#include "join/explicit_segments.hpp"
#include "join/facet_triangles.hpp"
#include "join/near_contacts.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr::detail {

/// A facet of one polygon all of whose points lie on one line, by these points along it. Whether it may be dropped is seen when
/// the rest is done (flat_facets.hpp).
struct FlatFacet {
  std::uint32_t input;
  std::vector<std::uint32_t> vertices;
};

/// The facets of an input as triangles.
struct TriangulatedFacets {
  FacetTriangles faces;
  std::vector<FlatFacet> flat;
};

class FacetTriangulator {
 public:
  /// `near`: what facets go through. Where the polygons of a facet cross or touch each other as they are, their points near their
  /// own edges are added.
  FacetTriangulator(const BuildInput<3>& in, const ExplicitSegments<3>& segments, NearContacts& near, BuildReport<3>& report)
      : in_(in), shapes_(in.points, in.scale), segments_(segments), near_(near), report_(report) {}

  /// @throws InputError for a facet that has no triangles
  TriangulatedFacets run();

 private:
  void read_polygon(std::uint32_t f);
  bool drop_closed(std::uint32_t f);
  bool set_flat_aside(std::uint32_t f);
  bool add_triangle(std::uint32_t f);
  void add_polygons(std::uint32_t f);
  void triangulate(std::uint32_t f, CleanFacet& facet);
  PlanarResult build(std::uint32_t f, CleanFacet& facet, int axis);
  void carve(std::uint32_t f);
  void constrain_explicit(const CleanFacet& facet);
  bool is_reversed(const CleanFacet& facet) const;
  [[noreturn]] void fail_facet(std::uint32_t f, const PlanarResult& result) const;
  [[noreturn]] void fail_degenerate(std::uint32_t f, const std::string& why, const std::vector<std::uint32_t>& vertices) const;

  const BuildInput<3>& in_;
  TriangleShapes shapes_;
  const ExplicitSegments<3>& segments_;
  NearContacts& near_;
  BuildReport<3>& report_;
  TriangulatedFacets out_;
  std::vector<std::uint32_t> polygon_;  // of the facet at hand, if it is one without holes
  PlanarTriangulation planar_;
};

}  // namespace pgdr::detail
