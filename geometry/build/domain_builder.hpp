// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The maker of a Domain of a Plc, in this order: points (finite, grouped), indices, facets to triangles (where their polygons
// touch each other: through the points that do), what is near to what (decided once, on the edges as given), repeated facets,
// points and edges that lie on what they do not belong to, facets that overlap, coplanar groups, segments, incidences. Each step
// has a header of its own, included here. Everything is sorting and hashing: n log n in the size of the input, but for constraint
// edges of a facet that cross many triangles. Used by one thread, once; long loops run in its task arena, too.
#pragma once

#include <optional>
#include <stop_token>
#include <vector>

#include "build/contact_resolver.hpp"
#include "build/maximal_facets.hpp"
#include "build/maximal_segments.hpp"
#include "join/build_input.hpp"
#include "join/build_report.hpp"
#include "join/distinct_points.hpp"
#include "join/edge_uses.hpp"
#include "join/explicit_segments.hpp"
#include "join/facet_triangulator.hpp"
#include "join/near_contacts.hpp"
#include "join/near_search.hpp"
#include "pgdr/domain.hpp"

namespace pgdr {

template <int D>
class DomainBuilder {
 public:
  /// `refused`: where to name what is invalid and go on without it; null: it is thrown.
  DomainBuilder(const Plc<D>& plc, Domain<D>& domain, std::stop_token stop, std::vector<Diagnostic>* refused = nullptr)
      : plc_(plc), out_(domain), bulk_(true, stop), stop_(std::move(stop)), report_(plc, refused) {}
  void run();

 private:
  using Input = detail::BuildInput<D>;
  using Segments = detail::ExplicitSegments<D>;

  void take_points();
  void join_near(const Input& in, const Segments& segments);
  void resolve_contacts(Input& in);
  void subdivide_planes(Input& in) requires(D == 3);
  void group_facets(const Input& in, const detail::EdgeUses& uses) requires(D == 3);
  void write_segments(const Input& in, const detail::EdgeUses& uses, const Segments& segments);

  const Plc<D>& plc_;
  Domain<D>& out_;
  const detail::Bulk bulk_;
  const detail::StopCheck stop_;
  detail::BuildReport<D> report_;
  std::vector<detail::OwnedEdge> segment_edges_;  // explicit segments, or what they were split into
  std::optional<detail::NearSearch<D>> near_search_;
  detail::NearContacts near_;
  bool meets_ = false;                 // does anything meet, or come near?
  std::vector<bool> soft_;             // by position in the uses of edges: no segment for this edge
  detail::TriangulatedFacets facets_;  // 2D: none
  std::vector<EntityId> group_of_;     // 3D: domain facet of each triangulated one
};

}  // namespace pgdr
