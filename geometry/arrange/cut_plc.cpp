// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "arrange/cut_plc.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "arrange/covering_facets.hpp"
#include "build/contact_resolver.hpp"
#include "diagnose/near_pieces.hpp"
#include "input/edges.hpp"
#include "numbers/vectors.hpp"
#include "space/disjoint_sets.hpp"
#include "space/make_set.hpp"

namespace pgdr::detail {

namespace {

/// Which of the two sides of its plane a facet shows to a direction that hardly any plane contains. Of facets of one plane it is
/// the same, whatever rounding does, iff they are oriented alike.
bool shows_front(const Plc<3>& plc, const Plc<3>::Facet& facet) {
  constexpr Vector<3> direction{1, 0.7548776662466927, 0.5698402909980532};
  double side = 0;
  const auto has = [&](std::uint32_t v) { return v < plc.points.size(); };
  if (facet.polygons.empty() || !std::ranges::all_of(facet.polygons[0], has)) return false;
  const auto& polygon = facet.polygons[0];
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    const Point3& a = plc.points[polygon[0]];
    side += dot(direction, cross(difference(plc.points[polygon[k - 1]], a), difference(plc.points[polygon[k]], a)));
  }
  return side > 0;
}

}  // namespace

CutPlc::CutPlc(const Plc<3>& input) : plc(input) {
  std::vector<int> markers;
  for (const auto& f : plc.facets) markers.push_back(f.marker);
  make_set(markers);
  for (auto& f : plc.facets) {
    const auto rank = static_cast<int>(std::ranges::lower_bound(markers, f.marker) - markers.begin());
    f.marker = 2 * rank + (shows_front(input, f) ? 1 : 0);
    markers_of_input.push_back(f.marker);
  }
  for (std::uint32_t f = 0; f <= plc.facets.size(); ++f) origins_begin.push_back(f);
  for (std::uint32_t f = 0; f < plc.facets.size(); ++f) origins.push_back({f, false});
  for (std::uint32_t s = 0; s < plc.segments.size(); ++s) segments.push_back(s);
}

Plc<3> CutPlc::with_markers_of(const Plc<3>& input) const {
  Plc<3> out = plc;
  for (std::uint32_t f = 0; f < out.facets.size(); ++f) out.facets[f].marker = input.facets[origins_of(f)[0].facet].marker;
  return out;
}

std::vector<PieceOrigin> PieceOrigins::of(EntityId f, std::uint32_t k) const {
  std::vector<PieceOrigin> all;
  for (const CoveringFacet& c : CoveringFacets(given_.plc, domain_).of(f, k))
    for (const PieceOrigin& o : given_.origins_of(c.facet)) all.push_back({o.facet, o.reversed != c.reversed});
  auto chosen = all.begin();
  if (rule_ == SharedMarker::first) chosen = std::ranges::min_element(all, {}, &PieceOrigin::facet);
  if (rule_ == SharedMarker::last) chosen = std::ranges::max_element(all, {}, &PieceOrigin::facet);
  std::rotate(all.begin(), chosen, chosen + 1);
  std::sort(all.begin() + 1, all.end());
  return all;
}

namespace {

class Replacement {
 public:
  Replacement(CutPlc& given, const Domain<3>& domain, const CutTriangles& cut, SharedMarker rule)
      : given_(given), domain_(domain), cut_(cut), rule_(rule), origins_(given, domain, rule), sets_(given.plc.facets.size()) {
    for (EntityId f = 0; f < domain.facets().size(); ++f)
      for (std::uint32_t k = 0; k < domain.facets()[f].triangle_count; ++k) triangles_.push_back({f, k});
  }

  bool run() {
    find_touched();
    const bool any = !cut_.empty() || std::ranges::find(touched_, true) != touched_.end();
    if (!any) return false;
    place_points();
    replace_segments();
    replace_facets();
    return true;
  }

 private:
  struct Place {
    EntityId facet;
    std::uint32_t k;
  };

  using Chain = std::vector<std::uint32_t>;
  /// A segment of the Domain that a segment of the Plc, or a facet that is one, runs along.
  struct Line {
    bool is_facet;
    std::uint32_t index;
    EntityId segment;
    friend auto operator<=>(const Line&, const Line&) = default;
  };

  /// The number of a point in the Plc: those that the Domain has added count on, and new ones behind these.
  std::uint32_t number(std::uint32_t v) const {
    if (v < domain_.points().size()) return domain_.input_of_point()[v];
    return v - static_cast<std::uint32_t>(domain_.points().size()) + added_begin_;
  }

  int marker_of(const PieceOrigin& o) const { return given_.markers_of_input[o.facet]; }

  /// Facets that cover a triangle together are replaced together.
  void find_touched() {
    const CoveringFacets covering(given_.plc, domain_);
    std::vector<bool> is_touched(given_.plc.facets.size(), false);
    auto next = cut_.cut.begin();
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      const auto& [f, k] = triangles_[t];
      const auto candidates = covering.candidates(f, k);
      for (const std::uint32_t g : candidates) sets_.unite(candidates[0], g);
      if (next != cut_.cut.end() && *next == t) {
        is_touched[candidates[0]] = true;
        ++next;
      } else if (rule_ != SharedMarker::smallest && candidates.size() > 1 &&
                 marker_of(origins_.of(f, k)[0]) / 2 != domain_.facets()[f].marker / 2) {
        is_touched[candidates[0]] = true;
      }
    }
    touched_.assign(given_.plc.facets.size(), false);
    for (std::uint32_t g = 0; g < is_touched.size(); ++g)
      if (is_touched[g]) touched_[sets_.find(g)] = true;
    for (std::uint32_t g = 0; g < is_touched.size(); ++g) touched_[g] = touched_[sets_.find(g)];
  }

  /// Where the Domain has them; then those that it added, then the new ones.
  void place_points() {
    Plc<3>& plc = given_.plc;
    const std::size_t count = plc.points.size(), columns = domain_.attributes_per_point();
    for (std::size_t i = 0; i < count; ++i) plc.points[i] = domain_.points()[domain_.point_of_input()[i]];
    for (std::uint32_t v = 0; v < domain_.points().size(); ++v) {
      if (domain_.input_of_point()[v] < count) continue;
      plc.points.push_back(domain_.points()[v]);
      const auto row = domain_.point_attributes().subspan(v * columns, columns);
      plc.point_attributes.insert(plc.point_attributes.end(), row.begin(), row.end());
    }
    added_begin_ = static_cast<std::uint32_t>(plc.points.size());
    for (std::size_t k = 0; k < cut_.added.size(); ++k) {
      plc.points.push_back(cut_.added[k]);
      if (columns > 0) add_attributes(cut_.added[k], cut_.sources[k], columns);
    }
    if (!plc.point_markers.empty()) plc.point_markers.resize(plc.points.size(), 0);
  }

  /// By the parts of the corners: distances along an edge, areas in a triangle.
  void add_attributes(const Point3& p, const PointSource& source, std::size_t columns) {
    const auto part = [&](std::size_t i) {
      const auto corner = [&](std::size_t j) -> const Point3& { return domain_.points()[source[j]]; };
      if (source[2] == no_entity) return std::sqrt(squared_distance(p, corner(1 - i)));
      const Point3 &a = corner((i + 1) % 3), &b = corner((i + 2) % 3);
      double square = 0;
      for (int d = 0; d < 3; ++d) {
        const int u = (d + 1) % 3, w = (d + 2) % 3;
        const double minor = (a[u] - p[u]) * (b[w] - p[w]) - (a[w] - p[w]) * (b[u] - p[u]);
        square += minor * minor;
      }
      return std::sqrt(square);
    };
    const std::size_t corners = source[2] == no_entity ? 2 : 3;
    double sum = 0;
    for (std::size_t i = 0; i < corners; ++i) sum += part(i);
    for (std::size_t column = 0; column < columns; ++column) {
      double value = 0;
      for (std::size_t i = 0; i < corners; ++i)
        value += (sum > 0 ? part(i) / sum : i == 0 ? 1 : 0) * domain_.point_attributes()[source[i] * columns + column];
      given_.plc.point_attributes.push_back(value);
    }
  }

  /// What of the input runs along which segments of the Domain: segments, then facets that are segments.
  void collect_lines() {
    for (EntityId s = 0; s < domain_.segments().size(); ++s)
      for (const SegmentOrigin& o : domain_.segment_origins(s)) lines_.push_back({o.is_facet, o.index, s});
    std::ranges::sort(lines_);
    places_.assign(domain_.points().begin(), domain_.points().end());
    places_.insert(places_.end(), cut_.added.begin(), cut_.added.end());
    on_edges_ = PointsOnEdges<3>(places_, cut_.on_edges);
  }

  Chain chain_of(EntityId s) const {
    const auto& ends = domain_.segments()[s].points;
    return on_edges_.chain(ends[0], ends[1]);
  }

  /// Of a segment of the Plc, or a facet that is one: the points along each part of it; none if there are no new ones.
  std::vector<Chain> chains_of(std::uint32_t index, bool is_facet) const {
    std::vector<Chain> chains;
    bool is_cut = false;
    for (auto at = std::ranges::lower_bound(lines_, Line{is_facet, index, 0});
         at != lines_.end() && at->index == index && at->is_facet == is_facet; ++at) {
      chains.push_back(chain_of(at->segment));
      is_cut = is_cut || chains.back().size() > 2;
    }
    if (!is_cut) chains.clear();
    return chains;
  }

  /// Segments along an edge that has new points; and edges drawn inside of facets that are replaced.
  void replace_segments() {
    collect_lines();
    Plc<3>& plc = given_.plc;
    const auto segments = std::exchange(plc.segments, {});
    const auto inputs = std::exchange(given_.segments, {});
    const auto source_lines = std::exchange(plc.source.segment_lines, {});
    const auto add = [&](std::uint32_t a, std::uint32_t b, int marker, std::uint32_t input, std::uint32_t line) {
      plc.segments.push_back({{a, b}, marker});
      given_.segments.push_back(input);
      if (!source_lines.empty()) plc.source.segment_lines.push_back(line);
    };
    const auto add_chain = [&](const Chain& chain, int marker, std::uint32_t input, std::uint32_t line) {
      for (std::size_t k = 1; k < chain.size(); ++k) add(number(chain[k - 1]), number(chain[k]), marker, input, line);
    };
    for (std::uint32_t s = 0; s < segments.size(); ++s) {
      const auto chains = chains_of(s, false);
      const std::uint32_t line = source_lines.empty() ? 0 : source_lines[s];
      if (chains.empty()) add(segments[s].points[0], segments[s].points[1], segments[s].marker, inputs[s], line);
      for (const Chain& chain : chains) add_chain(chain, segments[s].marker, inputs[s], line);
    }
    for (EntityId s = 0; s < domain_.segments().size(); ++s)
      if (is_drawn_inside(s)) add_chain(chain_of(s), 0, no_entity, 0);
  }

  /// Is the edge inside of one facet of the Domain that is replaced, and no segment of the input?
  bool is_drawn_inside(EntityId s) const {
    const auto facets = domain_.facets_of_segment(s);
    if (facets.size() != 1 || !domain_.segment_origins(s).empty()) return false;
    const auto [a, b] = domain_.segments()[s].points;
    const DomainFacet& facet = domain_.facets()[facets[0]];
    int sides = 0;
    bool is_touched = false;
    for (const std::uint32_t t : domain_.triangles_at(facets[0], a)) {
      const auto& corners = domain_.triangles(facets[0])[t - facet.first_triangle];
      if (std::ranges::find(corners, b) == corners.end()) continue;
      ++sides;
      is_touched = is_touched || touched_[domain_.triangle_origins(facets[0])[t - facet.first_triangle].facet];
    }
    return sides == 2 && is_touched;
  }

  void replace_facets() {
    Plc<3>& plc = given_.plc;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> by_facet;  // facet of the Plc, triangle of the Domain
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      const std::uint32_t f = domain_.triangle_origins(triangles_[t].facet)[triangles_[t].k].facet;
      if (touched_[f]) by_facet.emplace_back(f, t);
    }
    std::ranges::sort(by_facet);
    const auto lines = std::exchange(plc.source.facet_lines, {});
    const auto bodies = std::exchange(plc.facet_bodies, {});
    auto at = by_facet.begin();
    for (std::uint32_t f = 0; f < plc.facets.size(); ++f) {
      const auto chains = chains_of(f, true);
      const bool is_line = !chains.empty();
      if (is_line) add_line_facet(f, chains);
      for (; at != by_facet.end() && at->first == f; ++at) add_pieces(at->second);
      if (!is_line && !touched_[f]) add_facet(std::move(plc.facets[f]), given_.origins_of(f));
      if (!lines.empty()) plc.source.facet_lines.resize(next_.plc.facets.size(), lines[f]);
      if (!bodies.empty()) plc.facet_bodies.resize(next_.plc.facets.size(), bodies[f]);
    }
    plc.facets = std::move(next_.plc.facets);
    given_.origins = std::move(next_.origins);
    given_.origins_begin = std::move(next_.origins_begin);
  }

  void add_facet(Plc<3>::Facet facet, std::span<const PieceOrigin> origins) {
    next_.plc.facets.push_back(std::move(facet));
    next_.origins.insert(next_.origins.end(), origins.begin(), origins.end());
    next_.origins_begin.push_back(static_cast<std::uint32_t>(next_.origins.size()));
  }

  void add_line_facet(std::uint32_t f, std::span<const Chain> chains) {
    for (const Chain& chain : chains)
      for (std::size_t k = 1; k < chain.size(); ++k) {
        Plc<3>::Facet piece;
        piece.polygons = {{number(chain[k - 1]), number(chain[k])}};
        piece.marker = given_.plc.facets[f].marker;
        add_facet(std::move(piece), given_.origins_of(f));
      }
  }

  /// The triangle, or what it was cut into, as the first of its origins is oriented.
  void add_pieces(std::uint32_t t) {
    const auto& [f, k] = triangles_[t];
    auto origins = origins_.of(f, k);
    const bool turn = origins[0].reversed;
    for (PieceOrigin& o : origins) o.reversed = o.reversed != turn;
    const auto add = [&](std::array<std::uint32_t, 3> corners) {
      if (turn) std::swap(corners[1], corners[2]);
      Plc<3>::Facet piece;
      piece.polygons = {{number(corners[0]), number(corners[1]), number(corners[2])}};
      piece.marker = marker_of(origins[0]);
      add_facet(std::move(piece), origins);
    };
    const auto at = std::ranges::lower_bound(cut_.cut, t);
    if (at == cut_.cut.end() || *at != t) return add(domain_.triangles(f)[k]);
    const auto c = static_cast<std::size_t>(at - cut_.cut.begin());
    for (std::uint32_t i = cut_.begin[c]; i < cut_.begin[c + 1]; ++i) add(cut_.pieces[i]);
  }

  CutPlc& given_;
  const Domain<3>& domain_;
  const CutTriangles& cut_;
  SharedMarker rule_;
  PieceOrigins origins_;
  DisjointSets sets_;
  std::vector<Place> triangles_;  // of all facets
  std::vector<bool> touched_;     // of each facet of the Plc
  std::uint32_t added_begin_ = 0;
  std::vector<Line> lines_;     // sorted
  std::vector<Point3> places_;  // of the Domain's points and the new ones
  PointsOnEdges<3> on_edges_;
  CutPlc next_{Plc<3>{}};  // facets alone
};

}  // namespace

bool replace_cut(CutPlc& given, const Domain<3>& domain, const CutTriangles& cut, SharedMarker rule) {
  return Replacement(given, domain, cut, rule).run();
}

}  // namespace pgdr::detail
