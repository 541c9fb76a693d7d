// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "ailments.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "pgdr/domain.hpp"
#include "text.hpp"

namespace pgdr::tool {
namespace {

constexpr std::size_t all_of_them = std::numeric_limits<std::size_t>::max();

/// The surfaces of a Domain: of each triangle, counted through all facets, the least one that it hangs together with by edges;
/// and whether each edge of that surface has two triangles.
struct Surfaces {
  std::vector<std::uint32_t> of;
  std::vector<char> closed;  ///< by the least triangle
};

Surfaces surfaces_of(const Domain<3>& domain) {
  std::vector<std::array<std::uint32_t, 3>> edges;  // ends, triangle
  std::uint32_t count = 0;
  for (EntityId f = 0; f < domain.facets().size(); ++f)
    for (const auto& t : domain.triangles(f)) {
      for (std::size_t k = 0; k < 3; ++k)
        edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3]), count});
      ++count;
    }
  std::sort(edges.begin(), edges.end());
  Surfaces s{std::vector<std::uint32_t>(count), std::vector<char>(count, 1)};
  std::iota(s.of.begin(), s.of.end(), 0u);
  const auto root = [&](std::uint32_t t) {
    while (s.of[t] != t) t = s.of[t] = s.of[s.of[t]];
    return t;
  };
  const auto is_same = [&](std::size_t i, std::size_t j) { return edges[i][0] == edges[j][0] && edges[i][1] == edges[j][1]; };
  for (std::size_t i = 1; i < edges.size(); ++i)
    if (is_same(i, i - 1)) {
      const std::uint32_t a = root(edges[i][2]), b = root(edges[i - 1][2]);
      s.of[std::max(a, b)] = std::min(a, b);
    }
  for (std::uint32_t& t : s.of) t = root(t);
  for (std::size_t i = 0, j = 0; i < edges.size(); i = j) {
    for (j = i + 1; j < edges.size() && is_same(i, j);) ++j;
    if (j - i != 2) s.closed[s.of[edges[i][2]]] = 0;
  }
  return s;
}

/// In the middle between two edges that pass each other, by their four ends; none if they are parallel.
std::optional<std::array<double, 3>> place_between(const std::vector<std::array<double, 3>>& ends) {
  const auto dot = [](const auto& a, const auto& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  std::array<double, 3> u{}, v{}, r{}, place{};
  for (std::size_t k = 0; k < 3; ++k) {
    u[k] = ends[1][k] - ends[0][k];
    v[k] = ends[3][k] - ends[2][k];
    r[k] = ends[0][k] - ends[2][k];
  }
  const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), ur = dot(u, r), vr = dot(v, r), whole = uu * vv - uv * uv;
  if (!(whole > 0)) return std::nullopt;
  const double s = (uv * vr - vv * ur) / whole, t = (uu * vr - uv * ur) / whole;
  for (std::size_t k = 0; k < 3; ++k) place[k] = (ends[0][k] + s * u[k]) / 2 + (ends[2][k] + t * v[k]) / 2;
  return place;
}

}  // namespace

std::optional<OverlappingBodies> overlapping_bodies(const Plc<3>& plc, const Diagnosis<3>& diagnosis,
                                                    const std::stop_token& stop) {
  OverlappingBodies found;
  found.crossings = diagnosis[Finding::facets_cross].count;
  if (found.crossings == 0 || found.crossings != diagnosis.error_count()) return std::nullopt;
  std::optional<Domain<3>> domain;
  const Diagnosis<3> all = diagnose(plc, {.most_listed = all_of_them, .errors_only = true, .stop = stop}, domain);
  if (!domain) return std::nullopt;
  const Surfaces surfaces = surfaces_of(*domain);
  std::vector<std::uint32_t> of_facet(domain->input_facets(), no_entity);
  std::uint32_t triangle = 0;
  for (EntityId f = 0; f < domain->facets().size(); ++f)
    for (const TriangleOrigin& origin : domain->triangle_origins(f)) of_facet[origin.facet] = surfaces.of[triangle++];
  std::set<std::uint32_t> bodies;
  bool runs_through = false;
  for (const FindingList::Item& item : all[Finding::facets_cross].listed) {
    std::array<std::uint32_t, 2> body{};
    for (std::size_t k = 0; k < 2; ++k) body[k] = of_facet[static_cast<std::size_t>(item.what.ids[k] - plc.first_index)];
    if (body[0] == body[1] || !surfaces.closed[body[0]] || !surfaces.closed[body[1]]) return std::nullopt;
    bodies.insert(body.begin(), body.end());
    runs_through = runs_through || item.what.points.size() > 1;
  }
  if (!runs_through) return std::nullopt;  // they touch
  found.count = bodies.size();
  found.first = Error(all[Finding::facets_cross].listed[0].what).what();
  return found;
}

std::vector<std::array<double, 3>> places_where_edges_cross(const Diagnosis<3>& all, double tolerance) {
  std::vector<std::array<double, 3>> places;
  const auto is_one = [&](const std::array<double, 3>& p, const std::array<double, 3>& q) {
    return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) <= tolerance;
  };
  constexpr std::size_t most = 1000;  // more are no slips
  const auto add = [&](const std::array<double, 3>& p) {
    if (places.size() < most && std::ranges::none_of(places, [&](const auto& q) { return is_one(p, q); })) places.push_back(p);
  };
  for (const FindingList::Item& item : all[Finding::facets_cross].listed)
    if (const auto& where = item.what.points; !where.empty() && is_one(where.front(), where.back())) add(where[0]);
  for (const FindingList::Item& item : all[Finding::invalid_entity].listed)
    if (item.what.code == Errc::entities_intersect && item.what.points.size() == 4)
      if (const auto place = place_between(item.what.points)) add(*place);
  return places;
}

std::string words_of_meetings(const Diagnosis<3>& diagnosis) {
  const FindingList& facets = diagnosis[Finding::facets_cross];
  const auto is_touch = [](const FindingList::Item& item) { return item.what.points.size() == 1; };
  if (facets.count == diagnosis.error_count() && facets.count == facets.listed.size() &&
      std::ranges::all_of(facets.listed, is_touch)) {
    std::set<std::array<double, 3>> places;
    for (const FindingList::Item& item : facets.listed) places.insert(item.what.points[0]);
    return places.size() == 1 ? "edges touch at a point" : "edges touch at " + count(places.size(), "point", "points");
  }
  if (facets.count > 0) return count(facets.count, "pair of facets crosses", "pairs of facets cross");
  if (const auto& segments = diagnosis[Finding::segment_crosses_facet]; segments.count > 0)
    return count(segments.count, "segment goes through a facet", "segments go through facets");
  return diagnosis[Finding::segments_cross].count > 0 ? "segments cross"
                                                      : "facets or segments meet where they have no point in common";
}

template <int D>
std::vector<double> gaps_of_open_boundaries(const Plc<D>& plc, const std::stop_token& stop) {
  constexpr std::size_t most = 50000;  // of more it would take too long
  const Diagnosis<D> all = diagnose(plc, {.most_listed = all_of_them, .errors_only = true, .stop = stop});
  std::vector<std::array<double, 3>> open;
  for (const FindingList::Item& item : all[Finding::open_boundary].listed)
    open.insert(open.end(), item.what.points.begin(), item.what.points.end());
  std::sort(open.begin(), open.end());
  open.erase(std::unique(open.begin(), open.end()), open.end());
  std::vector<double> gaps(open.size(), std::numeric_limits<double>::infinity());
  if (open.size() > most) return {};
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (stop.stop_requested()) return {};
    for (std::size_t j = i + 1; j < open.size() && open[j][0] - open[i][0] <= gaps[i]; ++j) {
      const double d = std::hypot(open[i][0] - open[j][0], open[i][1] - open[j][1], open[i][2] - open[j][2]);
      gaps[i] = std::min(gaps[i], d);
      gaps[j] = std::min(gaps[j], d);
    }
  }
  std::sort(gaps.begin(), gaps.end());
  return gaps;
}

template std::vector<double> gaps_of_open_boundaries<2>(const Plc<2>&, const std::stop_token&);
template std::vector<double> gaps_of_open_boundaries<3>(const Plc<3>&, const std::stop_token&);

}  // namespace pgdr::tool
