// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A Domain says which facets are one plane and which edges are segments. Segments without a marker are of it, so that facets that
// they part are not one by tiny triangles beside them that are within the tolerance of one plane. What is added here: which of
// the segments are given anyway, which points lines do not need, and facets as polygons again. Where a facet makes no polygon,
// all its points stay, which may change the outlines of its neighbours; so it is tried again, and ends, since ever more points
// stay.
#include "pgdr/whole_facets.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "input/edges.hpp"
#include "input/triangle_shapes.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/error.hpp"
#include "replace/flat_polygon.hpp"
#include "replace/plane_parts.hpp"
#include "replace/straight_chains.hpp"
#include "space/equal_rows.hpp"

namespace pgdr {
namespace {

using detail::ChainEdge;
using detail::PlanarEdge;
constexpr std::uint32_t none = no_entity;

/// What a segment is: those of one kind go on in each other.
struct SegmentKind {
  int marker = 0;
  bool is_explicit = false;      ///< a segment by itself, not for its facets
  std::vector<EntityId> facets;  ///< that have it
  auto operator<=>(const SegmentKind&) const = default;
};

template <int D>
class FacetJoiner {
 public:
  FacetJoiner(const Plc<D>& plc, std::span<const std::uint8_t> required, const std::stop_token& stop)
      : plc_(plc), domain_(plc, stop), kept_(domain_.points().size(), 0) {
    for (std::size_t p = 0; p < required.size(); ++p)
      if (required[p]) kept_[domain_.point_of_input()[p]] = 1;
    required_ = kept_;
    if constexpr (D == 3) parts_ = detail::plane_parts(domain_);
    list_facets();
    list_edges();
    keep_corners();
  }

  WholeFacets<D> join() {
    WholeFacets<D> out;
    if constexpr (D == 2) {
      drop_points_of_lines();
    } else {
      is_whole_.assign(parts_.size(), 1);
      do drop_points_of_lines();
      while (!make_polygons());
      add_facets(out);
    }
    add_segments(out.plc);
    number_points(out);
    hand_on(out.plc);
    return out;
  }

 private:
  // ---- what there is -------------------------------------------------------------------------------------------------

  void list_facets() {
    for (EntityId f = 0; f < parts_.size(); ++f) {
      for (const std::uint32_t v : parts_[f].points) facets_at_.push_back({v, f});
      for (const auto& t : parts_[f].triangles)
        for (std::size_t i = 0; i < 3; ++i) sides_.push_back({detail::edge_key(t[i], t[(i + 1) % 3]), f});
    }
    std::sort(facets_at_.begin(), facets_at_.end());
    std::sort(sides_.begin(), sides_.end());
  }

  void list_edges() {
    std::map<std::uint64_t, SegmentKind> edges;
    for (EntityId s = 0; s < domain_.segments().size(); ++s) {
      const DomainSegment& segment = domain_.segments()[s];
      const std::uint64_t key = detail::edge_key(segment.points[0], segment.points[1]);
      std::vector<EntityId> facets;
      for (const Side& side : detail::equal_rows(std::span<const Side>(sides_), key, &Side::edge))
        if (facets.empty() || facets.back() != side.facet) facets.push_back(side.facet);
      if constexpr (D == 3)  // between facets that are one now
        if (!segment.explicit_in_input && facets.size() == 1 && domain_.facets_of_segment(s).size() == 2) continue;
      SegmentKind& kind = edges[key];
      kind.marker = segment.marker;
      kind.is_explicit = segment.explicit_in_input;
      kind.facets = std::move(facets);
      if constexpr (D == 3) {
        if (kind.marker == 0 && !kind.facets.empty()) kind.is_explicit = kind.is_explicit && is_in_plane(key, kind.facets);
      }
    }
    for (const auto& [key, kind] : edges) {
      const auto number = kinds_.emplace(kind, static_cast<std::uint32_t>(kinds_.size())).first->second;
      edges_.push_back({detail::edge_of(key), number});
    }
    kind_of_.resize(kinds_.size());
    for (const auto& [kind, number] : kinds_) kind_of_[number] = &kind;
  }

  /// Does an edge of facets lie inside of one, or between two that are one plane? Others are segments anyway.
  bool is_in_plane(std::uint64_t key, const std::vector<EntityId>& facets) {
    if (facets.size() == 1) return count_sides(key, facets[0]) == 2;
    const auto& all = parts_;
    if (facets.size() > 2 || all[facets[0]].marker != all[facets[1]].marker) return false;
    const auto [at, is_new] = is_one_plane_.try_emplace({facets[0], facets[1]}, false);
    if (is_new)
      at->second = all[facets[0]].triangles.size() < all[facets[1]].triangles.size() ? is_on(facets[0], facets[1])
                                                                                     : is_on(facets[1], facets[0]);
    return at->second;
  }
  /// Are the points of one facet within the tolerance of the plane of the other?
  bool is_on(EntityId f, EntityId other) const {
    const auto& t = parts_[other].triangles[0];
    const auto p = domain_.points();
    return std::ranges::all_of(parts_[f].points, [&](std::uint32_t v) {
      return v == t[0] || v == t[1] || v == t[2] ||
             detail::plane_distance(p[t[0]], p[t[1]], p[t[2]], p[v]) <= domain_.tolerance();
    });
  }
  std::ptrdiff_t count_sides(std::uint64_t key, EntityId f) const {
    return std::ranges::count(detail::equal_rows(std::span<const Side>(sides_), key, &Side::edge), f, &Side::facet);
  }

  /// Points where more comes together than a line, or a plane.
  void keep_corners() {
    kind_at_.assign(kept_.size(), none);
    for (const ChainEdge& e : edges_)
      for (const std::uint32_t v : e.ends) kind_at_[v] = e.kind;
    for (std::uint32_t v = 0; v < kept_.size(); ++v) {
      const std::size_t facets = detail::equal_rows(std::span<const AtPoint>(facets_at_), v, &AtPoint::point).size();
      if (kind_at_[v] == none ? facets > 1 : facets != kind_of_[kind_at_[v]]->facets.size()) kept_[v] = 1;
    }
  }

  // ---- lines and facets ----------------------------------------------------------------------------------------------

  void drop_points_of_lines() { inside_ = detail::points_inside_lines<D>(domain_.points(), edges_, kept_, domain_.tolerance()); }

  /// @returns whether all facets that were to be whole are; else points of those that are not stay from now on
  bool make_polygons() requires(D == 3) {
    bool all = true;
    polygons_.assign(is_whole_.size(), {});
    for (EntityId f = 0; f < is_whole_.size(); ++f) {
      if (!is_whole_[f]) continue;
      if (auto polygon = detail::polygon_of(domain_.points(), rim_of(f))) {
        polygons_[f] = std::move(*polygon);
        for (const std::uint32_t v : parts_[f].points)
          if (kept_[v] && kind_at_[v] == none) polygons_[f].polygons.push_back({v});
        continue;
      }
      is_whole_[f] = 0;
      all = false;
      for (const std::uint32_t v : parts_[f].points) kept_[v] = 1;
    }
    return all;
  }

  detail::FlatRim rim_of(EntityId f) const requires(D == 3) {
    const auto points = domain_.points();
    const auto& triangles = parts_[f].triangles;
    detail::FlatRim rim{.axis = parts_[f].axis, .anchor = points[triangles[0][0]], .may_touch_itself = true};
    rim.normal = parts_[f].normal;
    std::vector<PlanarEdge> of_rim, inner;  // before points are left out; the latter both ways
    for (const auto& t : triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        const PlanarEdge e{t[i], t[(i + 1) % 3]};
        const std::uint64_t key = detail::edge_key(e[0], e[1]);
        if (count_sides(key, f) == 1)
          of_rim.push_back(e);
        else if (std::ranges::binary_search(edges_, key, {}, key_of))
          inner.push_back(e);
      }
    for (const PlanarEdge& e : without_inside(of_rim)) rim.rim.push_back(e);
    for (const PlanarEdge& e : without_inside(inner))
      if (e[0] < e[1]) rim.inner.push_back(e);
    return rim;
  }

  static std::uint64_t key_of(const ChainEdge& e) { return detail::edge_key(e.ends[0], e.ends[1]); }

  /// Directed edges without the points inside of lines, at each of which one comes and one goes on; or two and two, there and
  /// back.
  std::vector<PlanarEdge> without_inside(std::vector<PlanarEdge> edges) const {
    std::sort(edges.begin(), edges.end());
    std::vector<PlanarEdge> out;
    for (const PlanarEdge& e : edges) {
      if (inside_[e[0]]) continue;
      auto [from, v] = e;
      while (inside_[v]) {
        auto next = std::lower_bound(edges.begin(), edges.end(), PlanarEdge{v, 0});
        if ((*next)[1] == from) ++next;
        from = std::exchange(v, (*next)[1]);
      }
      out.push_back({e[0], v});
    }
    return out;
  }

  // ---- what comes of it ----------------------------------------------------------------------------------------------

  void add_facets(WholeFacets<3>& out) const requires(D == 3) {
    for (EntityId f = 0; f < is_whole_.size(); ++f) {
      const auto add = [&](Plc<3>::Facet facet, std::size_t triangle) {
        facet.marker = parts_[f].marker;
        out.plc.facets.push_back(std::move(facet));
        out.facet_of_input.push_back(parts_[f].inputs[triangle]);
      };
      if (is_whole_[f]) {
        add(polygons_[f], 0);
        continue;
      }
      const auto& triangles = parts_[f].triangles;
      for (std::size_t t = 0; t < triangles.size(); ++t)
        add({.polygons = {{triangles[t][0], triangles[t][1], triangles[t][2]}}, .holes = {}, .marker = 0}, t);
    }
  }

  void add_segments(Plc<D>& plc) const {
    for (const ChainEdge& e : detail::without_points(edges_, inside_))
      if (const SegmentKind& kind = *kind_of_[e.kind]; kind.is_explicit || kind.facets.empty())
        plc.segments.push_back({e.ends, kind.marker});
  }

  /// Points that anything has, and required ones, in their order.
  void number_points(WholeFacets<D>& out) const {
    std::vector<std::uint32_t> number(required_.size(), none);
    const auto each_corner = [&out](const auto& f) {
      for (auto& s : out.plc.segments)
        for (std::uint32_t& v : s.points) f(v);
      for (auto& facet : out.plc.facets)
        for (auto& polygon : facet.polygons)
          for (std::uint32_t& v : polygon) f(v);
    };
    each_corner([&](std::uint32_t v) { number[v] = 0; });
    const std::size_t attributes = domain_.attributes_per_point();
    for (std::uint32_t v = 0; v < number.size(); ++v) {
      if (number[v] == none && !required_[v]) continue;
      number[v] = static_cast<std::uint32_t>(out.plc.points.size());
      out.plc.points.push_back(domain_.points()[v]);
      if (!domain_.point_markers().empty()) out.plc.point_markers.push_back(domain_.point_markers()[v]);
      const auto values = domain_.point_attributes().subspan(v * attributes, attributes);
      out.plc.point_attributes.insert(out.plc.point_attributes.end(), values.begin(), values.end());
    }
    each_corner([&](std::uint32_t& v) { v = number[v]; });
    for (const std::uint32_t v : domain_.point_of_input()) out.point_of_input.push_back(number[v]);
  }

  void hand_on(Plc<D>& plc) const {
    plc.holes = plc_.holes;
    plc.regions = plc_.regions;
    plc.names = plc_.names;
    plc.tolerance = plc_.tolerance;
    plc.is_coarse = plc_.is_coarse;
    plc.are_floats = plc_.are_floats;
    plc.first_index = plc_.first_index;
    plc.source.file = plc_.source.file;
    plc.source.void_widths = plc_.source.void_widths;
    plc.source.cell_regions = plc_.source.cell_regions;
  }

  struct AtPoint {
    std::uint32_t point;
    EntityId facet;
    auto operator<=>(const AtPoint&) const = default;
  };
  struct Side {
    std::uint64_t edge;
    EntityId facet;
    auto operator<=>(const Side&) const = default;
  };

  const Plc<D>& plc_;
  Domain<D> domain_;
  std::vector<std::uint8_t> kept_, required_;  // of each point of the Domain
  std::vector<detail::PlanePart> parts_;       // what is a facet below
  std::vector<AtPoint> facets_at_;             // sorted
  std::vector<Side> sides_;                    // the edges of all triangles, sorted
  std::map<SegmentKind, std::uint32_t> kinds_;
  std::map<std::pair<EntityId, EntityId>, bool> is_one_plane_;
  std::vector<const SegmentKind*> kind_of_;
  std::vector<std::uint32_t> kind_at_;  // of an edge at each point
  std::vector<ChainEdge> edges_;        // by their keys
  std::vector<std::uint8_t> inside_;    // of each point: a line goes through it
  std::vector<std::uint8_t> is_whole_;  // of each facet
  std::vector<Plc<3>::Facet> polygons_;
};

template <int D>
void require_one_a_point(const Plc<D>& plc, std::span<const std::uint8_t> required) {
  if (!required.empty() && required.size() != plc.points.size())
    throw UsageError({.code = Errc::bad_option,
                      .message = std::to_string(required.size()) + " flags of required points for " +
                                 std::to_string(plc.points.size()) + " points"});
}

}  // namespace

template <int D>
WholeFacets<D> with_whole_facets(const Plc<D>& plc, std::span<const std::uint8_t> required, std::stop_token stop) {
  require_one_a_point(plc, required);
  return FacetJoiner<D>(plc, required, stop).join();
}

template PGDR_API WholeFacets<2> with_whole_facets<2>(const Plc<2>&, std::span<const std::uint8_t>, std::stop_token);
template PGDR_API WholeFacets<3> with_whole_facets<3>(const Plc<3>&, std::span<const std::uint8_t>, std::stop_token);

}  // namespace pgdr
