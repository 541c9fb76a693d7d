// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Domain: construction in its order, accessors, and the words of its diagnostics.
#include "pgdr/domain.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "input/domain_builder.hpp"

namespace pgdr {
namespace detail {

template <int D>
std::string to_text(const Point<D>& p) {
  std::string s = "(";
  for (int i = 0; i < D; ++i) {
    char digits[40];
    const auto end = std::to_chars(digits, digits + sizeof digits, p[i]).ptr;
    s.append(i == 0 ? "" : ", ").append(digits, end);
  }
  return s + ")";
}
template std::string to_text<2>(const Point2&);
template std::string to_text<3>(const Point3&);

void RepairList::report(Errc code, const std::string& what, const std::string& file, std::vector<Diagnostic>& out) {
  if (count == 0) return;
  diagnostic.code = code;
  diagnostic.file = file;
  diagnostic.message = what + ": " + std::to_string(count) + " (" + words + ")";
  out.push_back(std::move(diagnostic));
}

}  // namespace detail

template <int D>
void DomainBuilder<D>::run() {
  out_.first_index_ = plc_.first_index;
  out_.source_ = plc_.source;
  stop_check_();
  check_finite();
  check_indices();
  if (refused_ != nullptr && !refused_->empty()) return;
  merge_points();
  stop_check_();
  check_segments();
  attempt([this] { check_spans_space(); });
  if (out_.points_.empty()) return;
  choose_scale();
  if constexpr (D == 3) {
    triangulate_joined_facets();
    drop_repeated_facets();
  }
  stop_check_();
  resolve_contacts();
  stop_check_();
  collect_edges();
  if constexpr (D == 3) {
    stop_check_();
    drop_flat_facets();
    group_coplanar();
    stop_check_();
    write_facets();
  }
  stop_check_();
  write_segments();
  write_incidences();
  out_.precision_ = plc_.precision;
  report_repairs();
}

template <int D>
std::string DomainBuilder<D>::point_words(std::uint32_t v) const {
  return std::to_string(point_number(v)) + " " + detail::to_text(out_.points_[v]);
}

template <int D>
void DomainBuilder<D>::fail(Errc code, const std::string& message, const std::vector<std::uint32_t>& lines,
                            std::size_t item, const std::vector<std::int64_t>& ids,
                            const std::vector<std::array<double, 3>>& where) const {
  Diagnostic d;
  d.code = code;
  d.message = message;
  d.file = plc_.source.file;
  d.line = item < lines.size() ? lines[item] : 0;
  d.ids = ids;
  d.points = where;
  throw InputError(std::move(d));
}

template <int D>
void DomainBuilder<D>::warn(Errc code, const std::string& message, const std::vector<std::uint32_t>& lines,
                            std::size_t item, std::vector<std::int64_t> ids) {
  Diagnostic d;
  d.code = code;
  d.message = message;
  d.file = plc_.source.file;
  d.line = item < lines.size() ? lines[item] : 0;
  d.ids = std::move(ids);
  out_.warnings_.push_back(std::move(d));
}

template <int D>
void DomainBuilder<D>::report_repairs() {
  const std::string& file = plc_.source.file;
  merged_.report(Errc::degenerate_segment, "points that repeat an earlier one exactly, merged into it", file,
                 out_.repairs_);
  merged_near_.report(Errc::near_points, "points near an earlier one, merged into it", file, out_.repairs_);
  negative_zeros_.report(Errc::not_finite, "points with a coordinate -0, now 0", file, out_.repairs_);
  dropped_edges_.report(Errc::degenerate_segment, "edges of polygons, and segments, of length zero, dropped", file,
                        out_.repairs_);
  repeated_segments_.report(Errc::degenerate_segment, "segments that repeat an earlier one, dropped", file,
                            out_.repairs_);
  repeated_facets_.report(Errc::repeated_facet, "facets that repeat an earlier one, dropped", file,
                          out_.repairs_);
  points_on_edges_.report(Errc::point_on_segment, "points inside an edge, which is split there", file, out_.repairs_);
  points_in_facets_.report(Errc::point_on_facet, "points inside a facet, now points of it", file, out_.repairs_);
  edges_in_facets_.report(Errc::entities_intersect, "edges that run inside a facet, now segments of it", file,
                          out_.repairs_);
  bent_facets_.report(Errc::bent_facet, "facets that are far from planar, taken as triangles with segments between them",
                      file, out_.warnings_);
  dropped_flat_.report(Errc::degenerate_facet, "facets with all their points on edges of others, dropped", file,
                       out_.repairs_);
  dropped_bare_.report(Errc::degenerate_facet, "facets without an area, with all their points on one line, dropped", file,
                       out_.repairs_);
}

template <int D>
Domain<D>::Domain(const Plc<D>& plc, std::stop_token stop) {
  DomainBuilder<D>(plc, *this, std::move(stop)).run();
}

template <int D>
Domain<D> Domain<D>::without_invalid(const Plc<D>& plc, std::vector<Diagnostic>& refused, std::stop_token stop) {
  Domain<D> domain;
  DomainBuilder<D>(plc, domain, std::move(stop), &refused).run();
  return domain;
}

template <int D>
std::span<const TriangleOrigin> Domain<D>::triangle_origins(EntityId f) const {
  return std::span(triangle_origins_).subspan(facets_[f].first_triangle, facets_[f].triangle_count);
}

template <int D>
std::span<const std::array<std::uint32_t, 3>> Domain<D>::triangles(EntityId f) const {
  return std::span(triangles_).subspan(facets_[f].first_triangle, facets_[f].triangle_count);
}

template <int D>
std::span<const std::uint32_t> Domain<D>::triangles_at(EntityId f, std::uint32_t point) const {
  const auto begin = triangles_at_.begin() + triangles_at_begin_[point], end = triangles_at_.begin() + triangles_at_begin_[point + 1];
  const std::uint32_t first = facets_[f].first_triangle, last = first + facets_[f].triangle_count;
  return {std::lower_bound(begin, end, first), std::lower_bound(begin, end, last)};
}

template <int D>
std::span<const EntityId> Domain<D>::facet_segments(EntityId f) const {
  return std::span(facet_segments_).subspan(facets_[f].first_segment, facets_[f].segment_count);
}

template <int D>
std::span<const std::uint32_t> Domain<D>::facet_points(EntityId f) const {
  return std::span(facet_points_).subspan(facets_[f].first_point, facets_[f].point_count);
}

template <int D>
bool Domain<D>::facets_touch(EntityId f, EntityId g) const {
  if (f == g) return true;
  auto few = facet_points(f), many = facet_points(g);
  if (few.size() > many.size()) std::swap(few, many);
  if (few.size() > few_points) return std::binary_search(touching_.begin(), touching_.end(), std::array{std::min(f, g), std::max(f, g)});
  return std::ranges::any_of(few, [&](std::uint32_t v) { return std::binary_search(many.begin(), many.end(), v); });
}

template <int D>
std::span<const EntityId> Domain<D>::facets_of_segment(EntityId s) const {
  const std::uint32_t begin = facets_of_segment_begin_[s];
  return std::span(facets_of_segment_).subspan(begin, facets_of_segment_begin_[s + 1] - begin);
}

template <int D>
double Domain<D>::segment_magnitude(EntityId s) const {
  double m = 0;
  for (const std::uint32_t v : segments_[s].points)
    for (const double x : points_[v].x) m = std::max(m, std::fabs(x));
  return m;
}

template class Domain<2>;
template class Domain<3>;
// The steps are defined, and instantiated one by one, in files of their own.
template void DomainBuilder<2>::run();
template void DomainBuilder<3>::run();
template std::string DomainBuilder<2>::point_words(std::uint32_t) const;
template std::string DomainBuilder<3>::point_words(std::uint32_t) const;
using Lines = std::vector<std::uint32_t>;
using Ids = std::vector<std::int64_t>;
template void DomainBuilder<2>::fail(Errc, const std::string&, const Lines&, std::size_t, const Ids&,
                                     const std::vector<std::array<double, 3>>&) const;
template void DomainBuilder<3>::fail(Errc, const std::string&, const Lines&, std::size_t, const Ids&,
                                     const std::vector<std::array<double, 3>>&) const;
template void DomainBuilder<2>::warn(Errc, const std::string&, const Lines&, std::size_t, Ids);
template void DomainBuilder<3>::warn(Errc, const std::string&, const Lines&, std::size_t, Ids);

}  // namespace pgdr
