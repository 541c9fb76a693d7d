// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "join/facet_triangulator.hpp"

#include <algorithm>
#include <utility>

#include "join/numbers.hpp"
#include "join/planar_parts.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::detail {

TriangulatedFacets FacetTriangulator::run() {
  out_.faces.facets.reserve(in_.plc.facets.size());
  for (std::uint32_t f = 0; f < in_.plc.facets.size(); ++f)
    report_.attempt([&] {
      in_.stop();
      if (segments_.is_line_facet(f)) return;
      read_polygon(f);
      if (!drop_closed(f) && !set_flat_aside(f) && !add_triangle(f)) add_polygons(f);
    });
  return std::move(out_);
}

/// The distinct points of a facet that is one polygon without holes; else none.
void FacetTriangulator::read_polygon(std::uint32_t f) {
  const auto& facet = in_.plc.facets[f];
  polygon_.clear();
  if (facet.polygons.size() != 1 || !facet.holes.empty()) return;
  for (const std::uint32_t v : facet.polygons[0]) polygon_.push_back(in_.point_of_input[v]);
}

/// Drops a triangle of which nothing is left; false if it is something else.
bool FacetTriangulator::drop_closed(std::uint32_t f) {
  if (polygon_.size() != 3 || !near_.closes(polygon_)) return false;
  report_.repairs.dropped_flat.add([&] { return std::to_string(report_.number(f)); }, {report_.number(f)});
  return true;
}

bool FacetTriangulator::set_flat_aside(std::uint32_t f) {
  const auto& at = polygon_;
  if (at.size() < 3) return false;
  const auto& p = in_.points;
  std::size_t second = 1;
  while (second < at.size() && at[second] == at[0]) ++second;
  for (std::size_t k = second + 1; k < at.size(); ++k)
    if (at[k] != at[0] && at[k] != at[second] && !collinear<3>(p[at[0]], p[at[second]], p[at[k]])) return false;
  out_.flat.push_back({f, at});
  return true;
}

/// The facet if it is one triangle; false if it is something else.
bool FacetTriangulator::add_triangle(std::uint32_t f) {
  if (polygon_.size() != 3 || near_.touches(f, polygon_)) return false;
  PlanarTriangle t{polygon_[0], polygon_[1], polygon_[2]};
  const auto [axis, side] = shapes_.visible_side(t);
  if (side < 0) std::swap(t[1], t[2]);
  FacetTriangles& faces = out_.faces;
  faces.facets.push_back({f, static_cast<std::uint32_t>(faces.triangles.size()), 1, axis, true, 0, side < 0});
  faces.add(t, 7);
  return true;
}

void FacetTriangulator::add_polygons(std::uint32_t f) {
  CleanFacet facet = clean_facet(in_, f, near_, report_);
  if (facet.vertices.size() < 3) fail_degenerate(f, "has fewer than three distinct points", facet.vertices);
  const Point3 &p = in_.points[facet.vertices[0]], &q = in_.points[facet.vertices[1]];
  if (std::all_of(facet.vertices.begin() + 2, facet.vertices.end(),
                  [&](std::uint32_t v) { return collinear<3>(p, q, in_.points[v]); }))
    fail_degenerate(f, "has all its points on one line", facet.vertices);
  triangulate(f, facet);
  carve(f);
  constrain_explicit(facet);
  FacetTriangles& faces = out_.faces;
  TriangulatedFacet out{f, static_cast<std::uint32_t>(faces.triangles.size()), 0, planar_.axis(), true, 0};
  const auto triangles = planar_.triangles();
  if (triangles.empty()) fail_degenerate(f, "encloses nothing: its polygons are not closed", facet.vertices);
  const auto masks = planar_.constraint_masks();
  faces.triangles.insert(faces.triangles.end(), triangles.begin(), triangles.end());
  faces.masks.insert(faces.masks.end(), masks.begin(), masks.end());
  out.count = static_cast<std::uint32_t>(triangles.size());
  measure_planarity(out, facet, in_.points, shapes_, faces);
  out.reversed = is_reversed(facet);
  if (out.defect > numbers::most_bend * facet.extent(in_.points)) {
    add_planar_parts(out, facet, in_.points, shapes_, faces);
    report_.repairs.bent_facets.add([&] { return std::to_string(report_.number(f)); }, {report_.number(f)});
    return;
  }
  for (const PlanarEdge& e : facet.edges) faces.polygon_edges.push_back({e, static_cast<std::uint32_t>(faces.facets.size())});
  faces.facets.push_back(out);
}

/// In the best projection that there is. A wrong one (the normal of a crossing polygon may be anything) makes points coincide or
/// collinear.
void FacetTriangulator::triangulate(std::uint32_t f, CleanFacet& facet) {
  PlanarResult first;
  for (const int axis : axes_by_size(facet.normal(shapes_))) {
    const PlanarResult result = build(f, facet, axis);
    if (result) break;
    if (first.status == PlanarStatus::ok || first.status == PlanarStatus::collinear) first = result;
    if (result.status != PlanarStatus::collinear && result.status != PlanarStatus::coincident) {
      first = result;
      break;
    }
  }
  if (planar_.vertex_count() == 0) fail_facet(f, first);
}

/// Where edges of the facet's own polygons pass its points within the tolerance, or exactly, they go through them.
PlanarResult FacetTriangulator::build(std::uint32_t f, CleanFacet& facet, int axis) {
  const auto build = [&] { return planar_.build(in_.points, facet.vertices, facet.edges, axis); };
  PlanarResult result = build();
  const bool meets = result.status == PlanarStatus::edges_cross || result.status == PlanarStatus::point_on_edge;
  if (meets && in_.tolerance > 0 && near_.add(facet.points_near_own_edges(in_))) {
    facet.join(f, near_);
    result = build();
  }
  if (result.status == PlanarStatus::point_on_edge && facet.split_at_own_points(in_.points, report_)) result = build();
  return result;
}

void FacetTriangulator::carve(std::uint32_t f) {
  planar_.carve_outside();
  for (const Point3& seed : in_.plc.facets[f].holes) {
    const PlanarResult result = planar_.carve_hole(seed);
    const std::string words = "facet " + std::to_string(report_.number(f)) + ": its hole " + to_text(seed);
    if (result.status == PlanarStatus::on_constraint)
      report_.fail(Errc::seed_on_boundary, words + " lies on a point or an edge of its polygons", SourceItem::facet, f,
                   {report_.number(f)}, {seed.x});
    if (result.status == PlanarStatus::outside)
      report_.warn(Errc::encloses_nothing, words + " lies outside of it or in another hole", SourceItem::facet, f,
                   {report_.number(f)});
  }
}

// Segments of the input from one point of the facet to another that run through it belong to it. What does not fit
// (crosses its edges, runs outside) is a matter of the intersection of entities, not of the facet.
void FacetTriangulator::constrain_explicit(const CleanFacet& facet) {
  if (segments_.ends().empty()) return;
  for (const std::uint32_t a : facet.vertices)
    for (const std::uint32_t s : segments_.from(a)) {
      const std::uint32_t b = segments_.ends()[s][1];
      if (!near_.on_edge(edge_key(a, b)).empty()) continue;  // its pieces are edges of the facet
      if (a != b && planar_.has_vertex(b) && !planar_.is_constraint(a, b)) planar_.constrain(a, b);
    }
}

// Of the triangulation at hand: the first edge of the first polygon has its triangle on its left, or on its right.
bool FacetTriangulator::is_reversed(const CleanFacet& facet) const {
  if (facet.loops.empty() || facet.loops[0].size() < 3) return false;
  const std::uint32_t a = facet.loops[0][0], b = facet.loops[0][1];
  for (const PlanarTriangle& t : planar_.triangles())
    for (std::size_t i = 0; i < 3; ++i)
      if (t[i] == b && t[(i + 1) % 3] == a) return true;
  return false;
}

void FacetTriangulator::fail_degenerate(std::uint32_t f, const std::string& why,
                                        const std::vector<std::uint32_t>& vertices) const {
  std::string words;
  std::vector<std::int64_t> ids{report_.number(f)};
  std::vector<std::array<double, 3>> where;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    if (k < max_listed) words += (k == 0 ? ": point " : ", ") + report_.point_words(vertices[k]);
    if (k == max_listed) words += ", ...";
    ids.push_back(report_.point_number(vertices[k]));
    where.push_back(in_.points[vertices[k]].x);
  }
  report_.fail(Errc::degenerate_facet, "facet " + std::to_string(report_.number(f)) + " " + why + words, SourceItem::facet, f,
               ids, where);
}

void FacetTriangulator::fail_facet(std::uint32_t f, const PlanarResult& result) const {
  const std::string facet = "facet " + std::to_string(report_.number(f)) + ": ";
  const auto& p = in_.points;
  const auto edge = [&](const PlanarEdge& e) { return report_.point_words(e[0]) + " - " + report_.point_words(e[1]); };
  std::vector<std::int64_t> ids{report_.number(f), report_.point_number(result.edge[0]), report_.point_number(result.edge[1])};
  std::vector<std::array<double, 3>> where{p[result.edge[0]].x, p[result.edge[1]].x};
  Errc code = Errc::self_crossing_facet;
  std::string message;
  if (result.status == PlanarStatus::edges_cross || result.status == PlanarStatus::point_on_edge) {
    const bool cross = result.status == PlanarStatus::edges_cross;
    for (std::size_t k = 0; k < (cross ? 2u : 1u); ++k) {
      ids.push_back(report_.point_number(result.other[k]));
      where.push_back(p[result.other[k]].x);
    }
    message = cross ? facet + "its edges " + edge(result.edge) + " and " + edge(result.other) + " cross"
                    : facet + "its point " + report_.point_words(result.other[0]) + " lies inside its edge " + edge(result.edge);
  } else {  // coincident; no_such_edge and inverted do not happen
    code = Errc::degenerate_facet;
    message = facet + "its points " + edge(result.edge) + " are one behind the other: it is far from planar";
  }
  report_.fail(code, message, SourceItem::facet, f, ids, where);
}

}  // namespace pgdr::detail
