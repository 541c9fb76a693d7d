// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Third step of a Domain (3D): facets given twice are dropped; the uses of all edges are collected; the groups of facets
// that lie in one plane (domain_coplanar.cpp) become one facet each.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "input/bent_facets.hpp"
#include "input/domain_builder.hpp"
#include "pgdr/predicates.hpp"
#include "space/sort_by_points.hpp"

namespace pgdr {
using detail::edge_key;
using detail::EdgeUse;
using detail::TriangulatedFacet;

namespace {

using Triangle = std::array<std::uint32_t, 3>;

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

std::vector<Triangle> sorted_triangles(const TriangulatedFacet& f, const std::vector<Triangle>& triangles) {
  std::vector<Triangle> out;
  for (std::uint32_t k = 0; k < f.count; ++k) out.push_back(sorted(triangles[f.first + k]));
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

// Two facets are the same if they have the same triangles; those with equal smallest triangle are compared in full.
template <int D>
void DomainBuilder<D>::drop_repeated_facets() requires(D == 3) {
  std::vector<std::pair<Triangle, std::uint32_t>> keys;
  for (std::uint32_t f = 0; f < facets_.size(); ++f) {
    Triangle least = sorted(triangles_[facets_[f].first]);
    for (std::uint32_t k = 1; k < facets_[f].count; ++k)
      least = std::min(least, sorted(triangles_[facets_[f].first + k]));
    keys.emplace_back(least, f);
  }
  stop_check_.sort(bulk_, keys);
  std::vector<std::uint32_t> same(facets_.size(), no_entity);
  for (std::size_t k = 1; k < keys.size(); ++k)
    for (std::size_t j = k; j-- > 0 && keys[j].first == keys[k].first;) {
      const std::uint32_t f = keys[k].second, g = keys[j].second;
      if (same[g] != no_entity || facets_[f].count != facets_[g].count) continue;
      if (sorted_triangles(facets_[f], triangles_) == sorted_triangles(facets_[g], triangles_)) same[f] = g;
    }
  std::vector<std::uint32_t> new_index(facets_.size());
  std::size_t kept = 0;
  std::uint32_t last = no_entity;
  for (std::uint32_t f = 0; f < facets_.size(); ++f) {
    new_index[f] = static_cast<std::uint32_t>(kept);
    if (same[f] == no_entity) {
      facets_[kept++] = facets_[f];
      continue;
    }
    const std::uint32_t mine = facets_[f].input, other = facets_[new_index[same[f]]].input;
    if (std::exchange(last, mine) == mine) continue;  // another part of it
    const std::string words = std::to_string(number(mine)) + " = " + std::to_string(number(other));
    repeated_facets_.add([&] { return words; }, {number(mine), number(other)});
    if (plc_.facets[mine].marker != plc_.facets[other].marker)
      warn(Errc::degenerate_facet, "facets " + words + ", but their markers differ; that of the latter is kept",
           plc_.source.facet_lines, mine, {number(mine), number(other)});
  }
  std::erase_if(polygon_edges_, [&](const auto& e) { return same[e.owner] != no_entity; });
  for (auto& e : polygon_edges_) e.owner = new_index[e.owner];
  facets_.resize(kept);
  std::uint32_t end = 0;
  for (TriangulatedFacet& f : facets_) {
    std::copy_n(triangles_.begin() + f.first, f.count, triangles_.begin() + end);
    std::copy_n(masks_.begin() + f.first, f.count, masks_.begin() + end);
    f.first = std::exchange(end, end + f.count);
  }
  triangles_.resize(end);
  masks_.resize(end);
}

// Every use of an edge: by triangles, by polygons, by segments of the input.
template <int D>
void DomainBuilder<D>::collect_edges() {
  using Kind = EdgeUse::Kind;
  std::size_t count = segment_edges_.size() + polygon_edges_.size();
  for (const auto& f : facets_) count += 3 * f.count;
  uses_.clear();
  uses_.reserve(count);
  for (std::uint32_t f = 0; f < facets_.size(); ++f)
    for (std::uint32_t t = facets_[f].first; t < facets_[f].first + facets_[f].count; ++t)
      for (std::size_t i = 0; i < 3; ++i)
        uses_.push_back({edge_key(triangles_[t][(i + 1) % 3], triangles_[t][(i + 2) % 3]), f, t,
                         (masks_[t] & (1u << i)) != 0 ? Kind::rim : Kind::diagonal});
  for (const auto& [e, f] : polygon_edges_) uses_.push_back({edge_key(e[0], e[1]), f, 0, Kind::polygon});
  for (const auto& [e, s] : segment_edges_) uses_.push_back({edge_key(e[0], e[1]), s, 0, Kind::explicit_segment});
  stop_check_.sort(bulk_, uses_, [](const EdgeUse& a, const EdgeUse& b) {
    return std::tuple{a.key, a.kind, a.owner, a.triangle} < std::tuple{b.key, b.kind, b.owner, b.triangle};
  });
  soft_.assign(uses_.size(), false);
}

template <int D>
std::uint32_t DomainBuilder<D>::root(std::uint32_t f) {
  while (parent_[f] != f) f = parent_[f] = parent_[parent_[f]];
  return f;
}

// The largest triangle first; one projection for all, each triangle positive in it.
template <int D>
void DomainBuilder<D>::orient_group(DomainFacet& facet) requires(D == 3) {
  const auto& p = out_.points_;
  Triangle* const t = out_.triangles_.data() + facet.first_triangle;
  const auto size = [&](const Triangle& s) { return std::fabs(normal(s)[static_cast<std::size_t>(facet.axis)]); };
  std::uint32_t largest = 0;
  double largest_size = -1;
  for (std::uint32_t k = 0; k < facet.triangle_count; ++k)
    if (const double s = size(t[k]); s > largest_size) {
      largest = k;
      largest_size = s;
    }
  TriangleOrigin* const origin = out_.triangle_origins_.data() + facet.first_triangle;
  std::swap(t[0], t[largest]);
  std::swap(origin[0], origin[largest]);
  if (facet.planar)
    for (const int axis : detail::axes_by_size(normal(t[0]))) {
      facet.axis = axis;
      if (orient_projected(p[t[0][0]], p[t[0][1]], p[t[0][2]], axis) != Sign::zero) break;
    }
  for (std::uint32_t k = 0; k < facet.triangle_count; ++k)
    if (orient_projected(p[t[k][0]], p[t[k][1]], p[t[k][2]], facet.axis) == Sign::negative) {
      std::swap(t[k][1], t[k][2]);
      origin[k].reversed = !origin[k].reversed;
    }
}

// Facets in the order of their first input facet, with their triangles and points.
template <int D>
void DomainBuilder<D>::write_facets() requires(D == 3) {
  group_of_.resize(facets_.size());
  for (std::uint32_t f = 0; f < facets_.size(); ++f) {
    if (const std::uint32_t r = root(f); r != f) {
      group_of_[f] = group_of_[r];
    } else {
      group_of_[f] = static_cast<EntityId>(out_.facets_.size());
      out_.facets_.push_back({plc_.facets[facets_[f].input].marker, facets_[f].axis, facets_[f].planar,
                              facets_[f].defect, 0, 0, 0, 0, 0, 0});
    }
    out_.facets_[group_of_[f]].triangle_count += facets_[f].count;
  }
  std::uint32_t total = 0;
  for (DomainFacet& f : out_.facets_) {
    f.first_triangle = total;
    total += std::exchange(f.triangle_count, 0);
  }
  out_.triangles_.resize(total);
  out_.triangle_origins_.resize(total);
  for (std::uint32_t f = 0; f < facets_.size(); ++f) {
    DomainFacet& group = out_.facets_[group_of_[f]];
    std::copy_n(triangles_.begin() + facets_[f].first, facets_[f].count,
                out_.triangles_.begin() + group.first_triangle + group.triangle_count);
    std::fill_n(out_.triangle_origins_.begin() + group.first_triangle + group.triangle_count, facets_[f].count,
                TriangleOrigin{facets_[f].input, facets_[f].reversed, facets_[f].mixed});
    group.triangle_count += facets_[f].count;
  }
  std::vector<std::uint32_t> points;
  for (DomainFacet& f : out_.facets_) {
    stop_check_();
    orient_group(f);
    points.clear();
    for (std::uint32_t k = f.first_triangle; k < f.first_triangle + f.triangle_count; ++k)
      points.insert(points.end(), out_.triangles_[k].begin(), out_.triangles_[k].end());
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    f.first_point = static_cast<std::uint32_t>(out_.facet_points_.size());
    f.point_count = static_cast<std::uint32_t>(points.size());
    out_.facet_points_.insert(out_.facet_points_.end(), points.begin(), points.end());
    double largest = 0;
    for (const std::uint32_t v : points)
      for (const double x : out_.points_[v].x) largest = std::max(largest, std::fabs(x));
    out_.facet_magnitudes_.push_back(largest);
    out_.facet_levels_.push_back(level(f, points));
    if (!f.planar) measure_defect(f, points);
  }
  detail::sort_by_points(out_.points_.size(), out_.triangles_.size(), [this](std::uint32_t t) { return out_.triangles_[t]; },
                         out_.triangles_at_begin_, out_.triangles_at_);
  auto bent = std::make_shared<detail::BentFacets>();
  for (EntityId f = 0; f < out_.facets_.size(); ++f)
    if (!out_.facets_[f].planar) bent->add(f, {out_.triangles(f), out_.points_, out_.facets_[f].axis});
  out_.bent_facets_ = std::move(bent);
  write_touching();
}

/// Pairs of facets with many points that have one in common. The refinement asks for every point that it puts on one, and to look
/// through the points took nine tenths of the time for a plate with 8,000 of them on its rim and holes.
template <int D>
void DomainBuilder<D>::write_touching() requires(D == 3) {
  std::vector<std::array<std::uint32_t, 2>> uses;  // point, facet
  for (EntityId f = 0; f < out_.facets_.size(); ++f)
    if (const auto points = out_.facet_points(f); points.size() > Domain<D>::few_points)
      for (const std::uint32_t v : points) uses.push_back({v, f});
  stop_check_.sort(bulk_, uses);
  for (std::size_t i = 0; i < uses.size(); ++i) {
    stop_check_();
    for (std::size_t j = i + 1; j < uses.size() && uses[j][0] == uses[i][0]; ++j) out_.touching_.push_back({uses[i][1], uses[j][1]});
  }
  stop_check_.sort(bulk_, out_.touching_);
  out_.touching_.erase(std::unique(out_.touching_.begin(), out_.touching_.end()), out_.touching_.end());
}

/// Of two doubles within a factor of 2 the difference is exact (Sterbenz); 1.9 leaves room for points between, which are rounded.
template <int D>
double DomainBuilder<D>::level(const DomainFacet& f, std::span<const std::uint32_t> points) const requires(D == 3) {
  const auto at = [&](std::uint32_t v) { return out_.points_[v][f.axis]; };
  const double first = at(out_.triangles_[f.first_triangle][0]);
  double least = std::fabs(first), most = least;
  for (const std::uint32_t v : points) {
    if (std::signbit(at(v)) != std::signbit(first)) return 0;
    least = std::min(least, std::fabs(at(v)));
    most = std::max(most, std::fabs(at(v)));
  }
  return most <= 1.9 * least ? first : 0;
}

/// Of a facet of which some corners are not exactly in one plane.
template <int D>
void DomainBuilder<D>::measure_defect(DomainFacet& f, std::span<const std::uint32_t> points) const requires(D == 3) {
  const auto& p = out_.points_;
  const auto& [a, b, c] = out_.triangles_[f.first_triangle];
  f.planarity_defect = 0;
  for (const std::uint32_t v : points)
    if (v != a && v != b && v != c)
      f.planarity_defect = std::max(f.planarity_defect, detail::plane_distance(p[a], p[b], p[c], p[v]));
}

template void DomainBuilder<2>::collect_edges();
template void DomainBuilder<3>::collect_edges();
template void DomainBuilder<3>::drop_repeated_facets();
template std::uint32_t DomainBuilder<3>::root(std::uint32_t);
template void DomainBuilder<3>::write_facets();
template void DomainBuilder<3>::write_touching();

}  // namespace pgdr
