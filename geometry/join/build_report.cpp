// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "join/build_report.hpp"

#include <set>
#include <utility>

#include "space/make_set.hpp"

namespace pgdr::detail {

template <int D>
Diagnostic BuildReport<D>::diagnostic(Errc code, const std::string& message, SourceItem kind, std::size_t i) const {
  Diagnostic d;
  d.code = code;
  d.message = message;
  PlcSource::Place place = plc_.source.place(kind, i);
  d.file = std::move(place.file);
  d.line = place.line;
  return d;
}

template <int D>
void BuildReport<D>::fail(Errc code, const std::string& message, SourceItem kind, std::size_t i,
                          const std::vector<std::int64_t>& ids, const std::vector<std::array<double, 3>>& where) const {
  Diagnostic d = diagnostic(code, message, kind, i);
  d.ids = ids;
  d.points = where;
  throw InputError(std::move(d));
}

template <int D>
void BuildReport<D>::warn(Errc code, const std::string& message, SourceItem kind, std::size_t i, std::vector<std::int64_t> ids) {
  Diagnostic d = diagnostic(code, message, kind, i);
  d.ids = std::move(ids);
  warnings_.push_back(std::move(d));
}

template <int D>
void BuildReport<D>::list_points() {
  make_set(on_edges_);
  make_set(in_facets_);
  for (const auto& [v, a, b] : on_edges_)
    repairs.points_on_edges.add(
        [&, v = v, a = a, b = b] {  // copies: Clang before 16 captures no structured binding
          return std::to_string(point_number(v)) + " on " + std::to_string(point_number(a)) + " - " +
                 std::to_string(point_number(b));
        },
        {point_number(v), point_number(a), point_number(b)});
  for (const auto& [v, f] : in_facets_)
    repairs.points_in_facets.add(
        [&, v = v, f = f] { return std::to_string(point_number(v)) + " in " + std::to_string(number(f)); },
        {point_number(v), number(f)});
}

template <int D>
void BuildReport<D>::go_back_to(const Mark& mark) {
  repairs.dropped_edges = mark.dropped_edges;
  repairs.bent_facets = {};
  if (refused_ != nullptr) refused_->resize(mark.refused);
  warnings_.resize(mark.warnings);
  on_edges_.clear();
}

template <int D>
void BuildReport<D>::write(std::vector<Diagnostic>& mended, std::vector<Diagnostic>& warnings) {
  const auto list = [&](RepairList& repair, Errc code, const char* what) { repair.report(code, what, plc_.source.file, mended); };
  list(repairs.merged, Errc::degenerate_segment, "points that repeat an earlier one exactly, merged into it");
  list(repairs.merged_near, Errc::near_points, "points near an earlier one, merged into it");
  list(repairs.negative_zeros, Errc::not_finite, "points with a coordinate -0, now 0");
  list(repairs.dropped_edges, Errc::degenerate_segment, "edges of polygons, and segments, of length zero, dropped");
  list(repairs.repeated_segments, Errc::degenerate_segment, "segments that repeat an earlier one, dropped");
  list(repairs.repeated_facets, Errc::repeated_facet, "facets that repeat an earlier one, dropped");
  list(repairs.points_on_edges, Errc::point_on_segment, "points inside an edge, which is split there");
  list(repairs.points_in_facets, Errc::point_on_facet, "points inside a facet, now points of it");
  list(repairs.edges_in_facets, Errc::entities_intersect, "edges that run inside a facet, now segments of it");
  list(repairs.overlaps, Errc::facets_overlap,
       "facets that overlap one before them in its plane, subdivided along each other's outlines; what is of both is the "
       "latter's, or, where markers differ, the smaller one's");
  list(repairs.added_points, Errc::entities_intersect, "points added where edges cross inside of a plane that they lie in");
  list(repairs.dropped_flat, Errc::degenerate_facet, "facets with all their points on edges of others, dropped");
  list(repairs.dropped_bare, Errc::degenerate_facet, "facets without an area, with all their points on one line, dropped");
  std::set<std::pair<std::uint64_t, std::string>> said;  // each once: a segment that others split repeats others piece by piece
  for (Diagnostic& warning : warnings_)
    if (said.emplace(warning.line, warning.message).second) warnings.push_back(std::move(warning));
  repairs.ambiguous_planes.report(Errc::ambiguous,
                                  "groups of facets of which each lies in one plane with the next, within the tolerance, but not "
                                  "all together: taken as they are",
                                  plc_.source.file, warnings);
  repairs.hidden_markers.report(Errc::facets_overlap,
                                "facets that overlap in their plane and have different markers; what is of both has the marker "
                                "of the smaller one, the first of each pair",
                                plc_.source.file, warnings);
  repairs.bent_facets.report(Errc::bent_facet, "facets that are far from planar, taken as triangles with segments between them",
                             plc_.source.file, warnings);
}

template class BuildReport<2>;
template class BuildReport<3>;

}  // namespace pgdr::detail
