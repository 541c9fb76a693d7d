// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "cures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <vector>

#include "planar_hint.hpp"
#include "proposal.hpp"
#include "text.hpp"

namespace pgdr::tool {
namespace {

constexpr std::size_t all_of_them = std::numeric_limits<std::size_t>::max();

template <int D>
bool is_valid(const Plc<D>& plc) {
  try {
    return diagnose(plc, {.most_listed = 0, .errors_only = true, .stop = {}}).error_count() == 0;
  } catch (const std::exception&) {
    return false;
  }
}

std::string words(const std::array<double, 3>& p) { return "(" + digits(p[0]) + ", " + digits(p[1]) + ", " + digits(p[2]) + ")"; }

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

/// Where edges cross, and no more: facets that meet in a single point, and edges that Domain refuses as they pass each other
/// within the tolerance, within which places are one.
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

/// A point of the file that lies on edges becomes one of all of them.
std::optional<std::string> points_to_add(const Plc<3>& plc) {
  constexpr std::size_t most_said = 5;
  const Diagnosis<3> all = diagnose(plc, {.most_listed = all_of_them, .errors_only = true, .stop = {}});
  Plc<3> other = plc;
  const auto places = places_where_edges_cross(all, tolerance_of(plc));
  if (places.empty()) return std::nullopt;
  for (const auto& [x, y, z] : places) other.points.push_back({x, y, z});
  if (!other.point_markers.empty()) other.point_markers.resize(other.points.size());
  other.point_attributes.clear();
  if (!is_valid(other)) return std::nullopt;
  std::string where;
  std::size_t said = 0;
  for (const auto& p : places)
    if (said++ < most_said) where += (said > 1 ? ", " : "") + words(p);
  if (said > most_said) where += " and " + std::to_string(said - most_said) + " more places";
  return "edges cross where neither has a point: to add " + std::string(said == 1 ? "a point" : "points") + " at " + where +
         " to the input makes it valid";
}

/// Of the points of open boundaries, how far each is from the nearest other one; ascending.
template <int D>
std::vector<double> gaps_of_open_boundaries(const Plc<D>& plc) {
  constexpr std::size_t most = 50000;  // of more it would take too long
  const Diagnosis<D> all = diagnose(plc, {.most_listed = all_of_them, .errors_only = true, .stop = {}});
  std::vector<std::array<double, 3>> open;
  for (const FindingList::Item& item : all[Finding::open_boundary].listed)
    open.insert(open.end(), item.what.points.begin(), item.what.points.end());
  std::sort(open.begin(), open.end());
  open.erase(std::unique(open.begin(), open.end()), open.end());
  std::vector<double> gaps(open.size(), std::numeric_limits<double>::infinity());
  if (open.size() > most) return {};
  for (std::size_t i = 0; i < open.size(); ++i)
    for (std::size_t j = i + 1; j < open.size() && open[j][0] - open[i][0] <= gaps[i]; ++j) {
      const double d = std::hypot(open[i][0] - open[j][0], open[i][1] - open[j][1], open[i][2] - open[j][2]);
      gaps[i] = std::min(gaps[i], d);
      gaps[j] = std::min(gaps[j], d);
    }
  std::sort(gaps.begin(), gaps.end());
  return gaps;
}

/// Corners that were meant to be one are much nearer to each other than others are: a tolerance between the two joins them.
template <int D>
std::optional<std::string> tolerance_that_welds(const Plc<D>& plc) {
  constexpr double jump = 4;
  constexpr std::array<double, 3> factors{1.5, 3, 6};  // corners of one place are farther from each other than from the nearest
  if (plc.tolerance) return std::nullopt;
  const std::vector<double> gaps = gaps_of_open_boundaries(plc);
  for (std::size_t i = gaps.size(), tried = 0; i-- > 1 && tried < 3;) {
    if (!(gaps[i] > jump * gaps[i - 1])) continue;
    ++tried;
    for (const double factor : factors) {
      const double rough = factor * gaps[i - 1], power = std::pow(10.0, std::floor(std::log10(rough)));
      Plc<D> other = plc;
      other.tolerance = std::ceil(rough / power) * power;
      for (const bool coarse : {false, true}) {
        other.is_coarse = coarse;
        if (!is_valid(other)) continue;
        return "the surface is not welded: corners that were meant to be one are up to " + format("%.2g", gaps[i - 1]) +
               " apart; --tolerance " + format("%.2g", *other.tolerance) + (coarse ? " --yes-coarse" : "") +
               " joins them, and makes it valid";
      }
    }
  }
  return std::nullopt;
}

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

}  // namespace

template <int D>
std::string words_of_bodies(const Plc<D>& plc, const Diagnosis<D>& diagnosis) {
  if constexpr (D == 3) {
    const std::uint64_t crossings = diagnosis[Finding::facets_cross].count;
    if (crossings == 0 || crossings != diagnosis.error_count()) return {};
    std::optional<Domain<3>> domain;
    const Diagnosis<3> all = diagnose(plc, {.most_listed = all_of_them, .errors_only = true, .stop = {}}, domain);
    if (!domain) return {};
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
      if (body[0] == body[1] || !surfaces.closed[body[0]] || !surfaces.closed[body[1]]) return {};
      bodies.insert(body.begin(), body.end());
      runs_through = runs_through || item.what.points.size() > 1;
    }
    if (!runs_through) return {};  // they touch
    return std::to_string(bodies.size()) + " closed bodies that overlap: " +
           count(crossings, "pair of their facets intersects", "pairs of their facets intersect") +
           ", the first: " + Error(all[Finding::facets_cross].listed[0].what).what();
  }
  return {};
}

template <int D>
std::vector<std::string> cures_of(const Plc<D>& plc, const Diagnosis<D>& diagnosis) {
  std::vector<std::string> cures;
  const auto add = [&](const std::optional<std::string>& cure) {
    if (cure) cures.push_back(*cure);
    return cure.has_value();
  };
  add(flags_for_refused(plc, diagnosis));
  try {
    if constexpr (D == 3)
      if (diagnosis[Finding::facets_cross].count + diagnosis[Finding::invalid_entity].count > 0 && add(points_to_add(plc)))
        return cures;
    if (diagnosis[Finding::open_boundary].count > 0 && add(tolerance_that_welds(plc))) return cures;
  } catch (const std::exception&) {  // the refusal says enough
  }
  if (const auto tolerance = tolerance_for_refused(plc))
    cures.push_back("--tolerance " + digits(*tolerance) + std::string(what_tolerance_does));
  return cures;
}

#define PGDR_INSTANTIATE(D)                                                    \
  template std::string words_of_bodies<D>(const Plc<D>&, const Diagnosis<D>&); \
  template std::vector<std::string> cures_of<D>(const Plc<D>&, const Diagnosis<D>&);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr::tool
