// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "build/domain_builder.hpp"

#include <utility>

#include "build/coplanar_groups.hpp"
#include "build/flat_facets.hpp"
#include "build/plane_subdivider.hpp"
#include "build/repeated_facets.hpp"
#include "join/near_crossings.hpp"
#include "space/point_places.hpp"

namespace pgdr {

using detail::EdgeUses;

template <int D>
void DomainBuilder<D>::run() {
  out_.first_index_ = plc_.first_index;
  out_.source_ = plc_.source;
  out_.names_ = plc_.names;
  out_.input_segments_ = plc_.segments.size();
  out_.input_facets_ = plc_.facets.size();
  stop_();
  detail::check_finite(plc_, report_);
  detail::check_indices(plc_, report_);
  if (report_.has_refused()) return;
  out_.tolerance_ = tolerance_of(plc_);
  take_points();
  stop_();
  Input in{plc_, out_.points_, out_.point_of_input_, detail::scale_of<D>(out_.points_).first, out_.tolerance_, bulk_, stop_};
  const Segments segments(in, report_);
  report_.attempt([this] { detail::check_spans_space<D>(out_.points_, report_); });
  if (out_.points_.empty()) return;
  join_near(in, segments);
  stop_();
  resolve_contacts(in);
  stop_();
  const EdgeUses uses(facets_.faces, segment_edges_, bulk_, stop_);
  soft_.assign(uses.size(), false);
  if constexpr (D == 3) group_facets(in, uses);
  stop_();
  write_segments(in, uses, segments);
  report_.write(out_.repairs_, out_.warnings_);
}

template <int D>
void DomainBuilder<D>::take_points() {
  detail::DistinctPoints<D> distinct = detail::merge_points(plc_, out_.tolerance_, stop_, report_);
  out_.largest_move_ = distinct.largest_move;
  out_.points_ = std::move(distinct.points);
  out_.point_of_input_ = std::move(distinct.point_of_input);
  out_.input_of_point_ = std::move(distinct.input_of_point);
  out_.point_markers_ = std::move(distinct.markers);
  out_.point_attributes_ = std::move(distinct.attributes);
  out_.holes_ = std::move(distinct.holes);
  std::erase_if(out_.source_.void_widths, [this](double width) { return width <= out_.tolerance_; });
  out_.regions_ = std::move(distinct.regions);
  report_.set_points(out_.points_, out_.input_of_point_);
}

/// Facets to triangles: once more where there is anything near to join. What a facet cannot be triangulated without, since its
/// polygons touch each other, is joined from the beginning.
template <int D>
void DomainBuilder<D>::join_near(const Input& in, const Segments& segments) {
  const auto mark = report_.mark();
  const auto triangulate = [&] {
    if constexpr (D == 3) facets_ = detail::FacetTriangulator(in, segments, near_, report_).run();
  };
  triangulate();
  for (std::uint32_t s = 0; s < segments.ends().size(); ++s)
    if (const auto& [a, b] = segments.ends()[s]; a != b) segment_edges_.push_back({{a, b}, s});
  near_search_.emplace(in, near_);
  meets_ = near_search_->find_pairs(facets_.faces, segment_edges_, facets_.flat);
  if (meets_ && near_search_->width() > 0) near_ = near_search_->contacts();
  if (!near_.empty()) {
    report_.go_back_to(mark);
    triangulate();
    near_.split(segment_edges_);
    near_.note(report_);
  }
  if constexpr (D == 3) detail::drop_repeated_facets(in, facets_.faces, report_);
}

/// Fits pieces to each other that meet; where nothing does, that is known from here on.
template <int D>
void DomainBuilder<D>::resolve_contacts(Input& in) {
  out_.nothing_meets_ = !meets_;
  if (meets_) {
    detail::ContactResolver<D> resolver(in, facets_.faces, segment_edges_, report_);
    if (resolver.find()) resolver.split_at_points();
    if constexpr (D == 3) subdivide_planes(in);
  }
  report_.list_points();
}

template <int D>
void DomainBuilder<D>::subdivide_planes(Input& in) requires(D == 3) {
  detail::drop_repeated_facets(in, facets_.faces, report_);
  const detail::PointLists lists{out_.points_, out_.input_of_point_, out_.point_markers_, out_.point_attributes_};
  detail::PlaneSubdivider planes(in, lists, facets_.faces, segment_edges_, report_);
  const bool met = planes.run();
  near_search_.emplace(in);  // there may be more points
  if (near_search_->width() == 0) return;
  if (met) planes.refuse_rest();
  if (near_search_->find_pairs(facets_.faces, segment_edges_, {}))  // flat facets are dropped in the end
    detail::refuse_near_crossings(in, *near_search_, report_);
}

template <int D>
void DomainBuilder<D>::group_facets(const Input& in, const EdgeUses& uses) requires(D == 3) {
  stop_();
  const bool joins = near_search_->width() > 0;
  detail::report_flat_facets(in, facets_.flat, uses, joins ? &near_ : nullptr, report_);
  const detail::CoplanarGroups groups(in, facets_.faces, uses, report_);
  soft_ = groups.find_soft_edges();
  stop_();
  detail::MaximalFacets facets = detail::make_maximal_facets(in, facets_.faces, groups.roots(), Domain<D>::few_points);
  group_of_ = std::move(facets.group_of);
  out_.facets_ = std::move(facets.facets);
  out_.triangles_ = std::move(facets.triangles);
  out_.triangle_origins_ = std::move(facets.origins);
  out_.further_origins_ = std::move(facets.further_origins);
  out_.facet_points_ = std::move(facets.points);
  out_.facet_magnitudes_ = std::move(facets.magnitudes);
  out_.facet_levels_ = std::move(facets.levels);
  out_.triangles_at_begin_ = std::move(facets.triangles_at_begin);
  out_.triangles_at_ = std::move(facets.triangles_at);
  out_.touching_ = std::move(facets.touching);
  out_.bent_facets_ = std::move(facets.bent);
}

template <int D>
void DomainBuilder<D>::write_segments(const Input& in, const EdgeUses& uses, const Segments& segments) {
  detail::MaximalSegments made = detail::make_maximal_segments<D>(in, uses, soft_, segments, group_of_, out_.facets_, report_);
  out_.segments_ = std::move(made.segments);
  out_.segment_origins_begin_ = std::move(made.origins_begin);
  out_.segment_origins_ = std::move(made.origins);
  out_.facet_segments_ = std::move(made.of_facets);
  out_.facets_of_segment_begin_ = std::move(made.facets_begin);
  out_.facets_of_segment_ = std::move(made.facets);
}

// Not the class: Clang before 16 would instantiate the members that 2D has not.
template void DomainBuilder<2>::run();
template void DomainBuilder<3>::run();

}  // namespace pgdr
