// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Second step of a Domain (3D): each input facet becomes triangles, in the projection along the largest component of
// its normal. A facet of three points is its triangle; any other goes through the planar triangulation, from which is
// taken away what is reached from outside and from its hole seeds.
#include <algorithm>
#include <cmath>

#include "input/domain_builder.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr {
namespace {

// A polygon may be off its plane by this part of its extent, as files with few digits leave it; what is bent by more is
// several facets. TetGen takes triangles for coplanar that meet at up to 0.1 degrees, about 1.7e-3 of their extent.
constexpr double most_bend = 1e-4;

}  // namespace
using detail::CleanFacet;
using detail::PlanarEdge;
using detail::PlanarResult;
using detail::PlanarStatus;
using detail::TriangulatedFacet;

namespace detail {

std::array<int, 3> axes_by_size(const std::array<double, 3>& normal) {
  std::array<int, 3> axes{0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(), [&](int i, int j) {
    return std::fabs(normal[static_cast<std::size_t>(i)]) > std::fabs(normal[static_cast<std::size_t>(j)]);
  });
  return axes;
}

std::array<double, 3> triangle_normal(const Point3& a, const Point3& b, const Point3& c, double scale) {
  double u[3], w[3];
  for (int i = 0; i < 3; ++i) {
    u[i] = scale * b[i] - scale * a[i];
    w[i] = scale * c[i] - scale * a[i];
  }
  return {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]};
}

}  // namespace detail

template <int D>
std::array<double, 3> DomainBuilder<D>::normal(const Triangle& t) const requires(D == 3) {
  return detail::triangle_normal(out_.points_[t[0]], out_.points_[t[1]], out_.points_[t[2]], scale_);
}

template <int D>
void DomainBuilder<D>::triangulate_facets() requires(D == 3) {
  facets_.reserve(plc_.facets.size());
  for (std::uint32_t f = 0; f < plc_.facets.size(); ++f)
    attempt([&] {
      stop_check_();
      if (std::binary_search(line_facets_.begin(), line_facets_.end(), f)) return;
      if (!set_flat_aside(f) && !add_triangle(f)) add_polygons(f);
    });
}

/// Once more where there is anything to join.
template <int D>
void DomainBuilder<D>::triangulate_joined_facets() requires(D == 3) {
  if (plc_.merge_within == 0) return triangulate_facets();
  const detail::RepairList dropped = dropped_edges_;
  const std::size_t refused = refused_ != nullptr ? refused_->size() : 0, warnings = out_.warnings_.size();
  triangulate_facets();
  if (!find_near()) return;
  dropped_edges_ = dropped;
  bent_facets_ = {};
  if (refused_ != nullptr) refused_->resize(refused);
  out_.warnings_.resize(warnings);
  facets_.clear();
  triangles_.clear();
  masks_.clear();
  polygon_edges_.clear();
  flat_facets_.clear();
  split_edges_.clear();
  triangulate_facets();
  note_near();
}

// A facet of one polygon with all its points on one line: whether it may be dropped is seen when the rest is done.
template <int D>
bool DomainBuilder<D>::set_flat_aside(std::uint32_t f) requires(D == 3) {
  const auto& facet = plc_.facets[f];
  if (is_joined_to_nothing(f)) {
    dropped_flat_.add([&] { return std::to_string(number(f)); }, {number(f)});
    return true;
  }
  if (facet.polygons.size() != 1 || facet.polygons[0].size() < 3 || !facet.holes.empty()) return false;
  const auto& p = out_.points_;
  const auto at = [&](std::size_t k) { return out_.point_of_input_[facet.polygons[0][k]]; };
  const std::size_t n = facet.polygons[0].size();
  std::size_t second = 1;
  while (second < n && at(second) == at(0)) ++second;
  for (std::size_t k = second + 1; k < n; ++k)
    if (at(k) != at(0) && at(k) != at(second) && !collinear<3>(p[at(0)], p[at(second)], p[at(k)])) return false;
  detail::FlatFacet flat{f, {}};
  for (std::size_t k = 0; k < n; ++k) flat.vertices.push_back(at(k));
  flat_facets_.push_back(std::move(flat));
  return true;
}

template <int D>
void DomainBuilder<D>::fail_degenerate(std::uint32_t f, const std::string& why,
                                       const std::vector<std::uint32_t>& vertices) const requires(D == 3) {
  std::string words;
  std::vector<std::int64_t> ids{number(f)};
  std::vector<std::array<double, 3>> where;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    if (k < detail::max_listed) words += (k == 0 ? ": point " : ", ") + point_words(vertices[k]);
    if (k == detail::max_listed) words += ", ...";
    ids.push_back(point_number(vertices[k]));
    where.push_back(out_.points_[vertices[k]].x);
  }
  fail(Errc::degenerate_facet, "facet " + std::to_string(number(f)) + " " + why + words, plc_.source.facet_lines, f,
       ids, where);
}

template <int D>
void DomainBuilder<D>::fail_facet(std::uint32_t f, const PlanarResult& result) const requires(D == 3) {
  const std::string facet = "facet " + std::to_string(number(f)) + ": ";
  const auto& p = out_.points_;
  const auto edge = [&](const PlanarEdge& e) { return point_words(e[0]) + " - " + point_words(e[1]); };
  std::vector<std::int64_t> ids{number(f), point_number(result.edge[0]), point_number(result.edge[1])};
  std::vector<std::array<double, 3>> where{p[result.edge[0]].x, p[result.edge[1]].x};
  Errc code = Errc::self_crossing_facet;
  std::string message;
  if (result.status == PlanarStatus::edges_cross || result.status == PlanarStatus::point_on_edge) {
    const bool cross = result.status == PlanarStatus::edges_cross;
    for (std::size_t k = 0; k < (cross ? 2u : 1u); ++k) {
      ids.push_back(point_number(result.other[k]));
      where.push_back(p[result.other[k]].x);
    }
    message = cross ? facet + "its edges " + edge(result.edge) + " and " + edge(result.other) + " cross"
                    : facet + "its point " + point_words(result.other[0]) + " lies inside its edge " +
                          edge(result.edge);
  } else {  // coincident; no_such_edge and inverted do not happen
    code = Errc::degenerate_facet;
    message = facet + "its points " + edge(result.edge) + " are one behind the other: it is far from planar";
  }
  fail(code, message, plc_.source.facet_lines, f, ids, where);
}

// The facet if it is one triangle; false if it is something else.
template <int D>
bool DomainBuilder<D>::add_triangle(std::uint32_t f) requires(D == 3) {
  const auto& facet = plc_.facets[f];
  if (facet.polygons.size() != 1 || facet.polygons[0].size() != 3 || !facet.holes.empty() || is_joined(f)) return false;
  Triangle t;
  for (std::size_t k = 0; k < 3; ++k) t[k] = out_.point_of_input_[facet.polygons[0][k]];
  const auto [axis, side] = visible_side(t);
  if (side < 0) std::swap(t[1], t[2]);
  facets_.push_back({f, static_cast<std::uint32_t>(triangles_.size()), 1, axis, true, 0, side < 0});
  triangles_.push_back(t);
  masks_.push_back(7);
  return true;
}

/// The axis along which most is seen of a triangle that is not flat, and its orientation then: 1 or -1.
template <int D>
std::pair<int, int> DomainBuilder<D>::visible_side(const Triangle& t) const requires(D == 3) {
  const auto& p = out_.points_;
  for (const int axis : detail::axes_by_size(normal(t)))
    if (const Sign side = orient_projected(p[t[0]], p[t[1]], p[t[2]], axis); side != Sign::zero)
      return {axis, side == Sign::positive ? 1 : -1};
  throw ResourceError({.code = Errc::internal, .message = "a triangle of a facet is flat"});
}

template <int D>
CleanFacet DomainBuilder<D>::clean(std::uint32_t f) requires(D == 3) {
  CleanFacet facet;
  for (const auto& polygon : plc_.facets[f].polygons) {
    auto& loop = facet.loops.emplace_back();
    const auto drop = [&](std::uint32_t i, std::uint32_t j) {
      dropped_edges_.add(
          [&] {
            return std::to_string(number(i)) + " - " + std::to_string(number(j)) + " of facet " +
                   std::to_string(number(f));
          },
          {number(f), number(i), number(j)});
    };
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const std::uint32_t v = out_.point_of_input_[polygon[k]];
      if (!loop.empty() && loop.back() == v) drop(polygon[k - 1], polygon[k]);
      else loop.push_back(v);
    }
    while (loop.size() > 1 && polygon.size() > 2 && loop.front() == loop.back()) {
      drop(polygon.back(), polygon.front());
      loop.pop_back();
    }
  }
  join(f, facet);
  for (const auto& loop : facet.loops) {
    facet.vertices.insert(facet.vertices.end(), loop.begin(), loop.end());
    const std::size_t n = loop.size();
    for (std::size_t k = 0; k < (n > 2 ? n : n == 2 ? 1 : 0); ++k) {
      const auto [a, b] = std::minmax(loop[k], loop[(k + 1) % n]);
      facet.edges.push_back({a, b});
    }
  }
  detail::make_set(facet.vertices);
  detail::make_set(facet.edges);
  return facet;
}

// Of the triangulation at hand: the first edge of the first polygon has its triangle on its left, or on its right.
template <int D>
bool DomainBuilder<D>::is_reversed(const CleanFacet& facet) const requires(D == 3) {
  if (facet.loops.empty() || facet.loops[0].size() < 3) return false;
  const std::uint32_t a = facet.loops[0][0], b = facet.loops[0][1];
  for (const Triangle& t : planar_.triangles())
    for (std::size_t i = 0; i < 3; ++i)
      if (t[i] == b && t[(i + 1) % 3] == a) return true;
  return false;
}

// Newell's normal of the polygon that has the largest.
template <int D>
std::array<double, 3> DomainBuilder<D>::facet_normal(const CleanFacet& facet) const requires(D == 3) {
  std::array<double, 3> best{};
  double best_size = -1;
  for (const auto& loop : facet.loops) {
    std::array<double, 3> sum{};
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) {  // from its first point: no cancellation far from the origin
      const auto n = normal({loop[0], loop[k], loop[k + 1]});
      for (std::size_t i = 0; i < 3; ++i) sum[i] += n[i];
    }
    const double size = std::fabs(sum[0]) + std::fabs(sum[1]) + std::fabs(sum[2]);
    if (size > best_size) {
      best = sum;
      best_size = size;
    }
  }
  return best;
}

// Points of the facet that lie exactly inside one of its edges split it, in space: where they do so in the projection
// alone, the facet stays as it was. True if any did.
template <int D>
bool DomainBuilder<D>::split_at_own_points(CleanFacet& facet) requires(D == 3) {
  const auto& p = out_.points_;
  std::vector<std::uint32_t> by_place = facet.vertices;
  const auto before = [&](std::uint32_t v, std::uint32_t w) { return lex_less(p[v], p[w]); };
  std::sort(by_place.begin(), by_place.end(), before);
  const auto inside_of = [&](std::uint32_t a, std::uint32_t b) {  // from a to b
    const auto [low, high] = before(a, b) ? std::pair{a, b} : std::pair{b, a};
    std::vector<std::uint32_t> out;
    for (auto v = std::upper_bound(by_place.begin(), by_place.end(), low, before); *v != high; ++v)
      if (collinear<3>(p[low], p[high], p[*v])) out.push_back(*v);
    if (low != a) std::reverse(out.begin(), out.end());
    return out;
  };
  std::vector<PlanarEdge> edges;
  for (const auto& [a, b] : facet.edges) {
    std::uint32_t last = a;
    for (const std::uint32_t v : inside_of(a, b)) {
      split_edges_.push_back({v, std::min(a, b), std::max(a, b)});
      edges.push_back({std::min(last, v), std::max(last, v)});
      last = v;
    }
    edges.push_back({std::min(last, b), std::max(last, b)});
  }
  detail::make_set(edges);
  if (edges == facet.edges) return false;
  facet.edges = std::move(edges);
  for (auto& loop : facet.loops) {
    if (loop.size() < 3) continue;
    std::vector<std::uint32_t> finer;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      finer.push_back(loop[k]);
      const auto inside = inside_of(loop[k], loop[(k + 1) % loop.size()]);
      finer.insert(finer.end(), inside.begin(), inside.end());
    }
    loop = std::move(finer);
  }
  return true;
}

template <int D>
void DomainBuilder<D>::add_polygons(std::uint32_t f) requires(D == 3) {
  CleanFacet facet = clean(f);
  if (facet.vertices.size() < 3) fail_degenerate(f, "has fewer than three distinct points", facet.vertices);
  const Point3 &p = out_.points_[facet.vertices[0]], &q = out_.points_[facet.vertices[1]];
  if (std::all_of(facet.vertices.begin() + 2, facet.vertices.end(),
                  [&](std::uint32_t v) { return collinear<3>(p, q, out_.points_[v]); }))
    fail_degenerate(f, "has all its points on one line", facet.vertices);
  PlanarResult first;
  for (const int axis : detail::axes_by_size(facet_normal(facet))) {
    PlanarResult result = planar_.build(out_.points_, facet.vertices, facet.edges, axis);
    if (result.status == PlanarStatus::point_on_edge && split_at_own_points(facet))
      result = planar_.build(out_.points_, facet.vertices, facet.edges, axis);
    if (result) break;
    // A wrong projection (the normal of a crossing polygon may be anything) makes points coincide or collinear.
    if (first.status == PlanarStatus::ok || first.status == PlanarStatus::collinear) first = result;
    if (result.status != PlanarStatus::collinear && result.status != PlanarStatus::coincident) {
      first = result;
      break;
    }
  }
  if (planar_.vertex_count() == 0) fail_facet(f, first);
  carve(f);
  constrain_explicit(facet);
  TriangulatedFacet out{f, static_cast<std::uint32_t>(triangles_.size()), 0, planar_.axis(), true, 0};
  const auto triangles = planar_.triangles();
  if (triangles.empty()) fail_degenerate(f, "encloses nothing: its polygons are not closed", facet.vertices);
  const auto masks = planar_.constraint_masks();
  triangles_.insert(triangles_.end(), triangles.begin(), triangles.end());
  masks_.insert(masks_.end(), masks.begin(), masks.end());
  out.count = static_cast<std::uint32_t>(triangles.size());
  measure_planarity(out, facet);
  out.reversed = is_reversed(facet);
  if (out.defect > most_bend * extent(facet)) return add_pieces(out, facet);
  for (const PlanarEdge& e : facet.edges) polygon_edges_.push_back({e, static_cast<std::uint32_t>(facets_.size())});
  facets_.push_back(out);
}

template <int D>
void DomainBuilder<D>::carve(std::uint32_t f) requires(D == 3) {
  planar_.carve_outside();
  for (const Point3& seed : plc_.facets[f].holes) {
    const PlanarResult result = planar_.carve_hole(seed);
    const std::string words = "facet " + std::to_string(number(f)) + ": its hole " + detail::to_text(seed);
    if (result.status == PlanarStatus::on_constraint)
      fail(Errc::seed_on_boundary, words + " lies on a point or an edge of its polygons", plc_.source.facet_lines, f,
           {number(f)}, {seed.x});
    if (result.status == PlanarStatus::outside)
      warn(Errc::encloses_nothing, words + " lies outside of it or in another hole", plc_.source.facet_lines, f,
           {number(f)});
  }
}

// Segments of the input from one point of the facet to another that run through it belong to it. What does not fit
// (crosses its edges, runs outside) is a matter of the intersection of entities, not of the facet.
template <int D>
void DomainBuilder<D>::constrain_explicit(const CleanFacet& facet) requires(D == 3) {
  if (explicit_.empty()) return;
  for (const std::uint32_t a : facet.vertices)
    for (std::uint32_t k = explicit_begin_[a]; k < explicit_begin_[a + 1]; ++k) {
      const std::uint32_t b = explicit_[explicit_at_[k]][1];
      if (!near_on_edge(detail::edge_key(a, b)).empty()) continue;  // its pieces are edges of the facet
      if (a != b && planar_.has_vertex(b) && !planar_.is_constraint(a, b)) planar_.constrain(a, b);
    }
}

template void DomainBuilder<3>::triangulate_joined_facets();
template void DomainBuilder<3>::fail_degenerate(std::uint32_t, const std::string&,
                                                const std::vector<std::uint32_t>&) const;
template std::array<double, 3> DomainBuilder<3>::normal(const Triangle&) const;
template std::pair<int, int> DomainBuilder<3>::visible_side(const Triangle&) const;

}  // namespace pgdr
