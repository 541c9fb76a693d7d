// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The least angle of a Domain, in doubles: which two entities squeeze the cells between them.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "numbers/vectors.hpp"
#include "pgdr/estimate.hpp"
#include "space/bulk.hpp"
#include "space/sort_by_points.hpp"
#include "space/stop_check.hpp"

namespace pgdr {
namespace {

constexpr std::size_t most_at_a_point = 2000;

/// In radians, of vectors; exact where it is small, too.
double angle_between(const detail::Vector<3>& u, const detail::Vector<3>& v) {
  const auto n = detail::cross(u, v);
  return std::atan2(std::sqrt(detail::dot(n, n)), detail::dot(u, v));
}

template <int D>
detail::Vector<3> direction(const Point<D>& from, const Point<D>& to) {
  detail::Vector<3> v{};
  double largest = 0;
  for (int i = 0; i < D; ++i) largest = std::max(largest, std::fabs(v[static_cast<std::size_t>(i)] = to[i] - from[i]));
  if (largest > 0)  // lest products over- or underflow
    for (double& x : v) x /= largest;
  return v;
}

struct Found {
  double angle = std::numbers::pi;
  EntityKind kind = EntityKind::segment;
  std::array<EntityId, 2> entities{no_entity, no_entity};
  std::uint32_t point = 0;
  friend auto operator<=>(const Found&, const Found&) = default;
};

template <int D>
class AngleSearch {
 public:
  AngleSearch(const Domain<D>& domain, const std::stop_token& stop)
      : domain_(domain), p_(domain.points()), bulk_(true, stop), stop_check_(stop) {}

  std::optional<SharpAngle<D>> run() {
    const auto segments = domain_.segments();
    const auto ends = [&](std::uint32_t s) { return segments[s].points; };
    detail::sort_by_points(p_.size(), segments.size(), ends, bulk_, begin_, at_);
    stop_check_();
    Found least = least_of(p_.size(), [this](std::size_t v, Found& found) { at_point(static_cast<std::uint32_t>(v), found); });
    [[maybe_unused]] constexpr double about = 1 + 1e-9;  // where segments meet as facets do, the facets say more
    if constexpr (D == 3) {
      const Found of_facets = least_of(segments.size(),
                                       [this](std::size_t s, Found& found) { at_segment(static_cast<EntityId>(s), found); });
      if (of_facets.entities[0] != no_entity && of_facets.angle <= about * least.angle) least = of_facets;
    }
    stop_check_();
    if (least.entities[0] == no_entity) return std::nullopt;
    SharpAngle<D> sharp;
    sharp.degrees = least.angle * (180 / std::numbers::pi);
    for (std::size_t i = 0; i < 2; ++i) sharp.entities[i] = {least.kind, least.entities[i]};
    sharp.point = p_[least.point];
    return sharp;
  }

 private:
  template <class Look>
  Found least_of(std::size_t count, const Look& look) const {
    constexpr std::size_t block = 1024;  // of some microseconds each
    std::vector<Found> found((count + block - 1) / block);
    bulk_.parts(found.size(), [&](std::size_t k) {
      for (std::size_t i = k * block; i < std::min(count, (k + 1) * block); ++i) look(i, found[k]);
    });
    return found.empty() ? Found{} : *std::min_element(found.begin(), found.end());
  }

  void at_point(std::uint32_t v, Found& found) const {
    const auto here = std::span(at_).subspan(begin_[v], std::min<std::size_t>(begin_[v + 1] - begin_[v], most_at_a_point));
    std::vector<detail::Vector<3>> directions;
    for (const EntityId s : here) {
      const auto& ends = domain_.segments()[s].points;
      directions.push_back(direction<D>(p_[v], p_[ends[0] == v ? ends[1] : ends[0]]));
    }
    for (std::size_t i = 0; i < here.size(); ++i)
      for (std::size_t j = i + 1; j < here.size(); ++j)
        found = std::min(found, {angle_between(directions[i], directions[j]), EntityKind::segment, {here[i], here[j]}, v});
  }

  /// Between the half-planes of its facets.
  void at_segment(EntityId s, Found& found) const requires(D == 3) {
    const auto facets = domain_.facets_of_segment(s);
    if (facets.size() < 2) return;
    struct HalfPlane {
      EntityId facet;
      detail::Vector<3> normal;
    };
    const auto [a, b] = domain_.segments()[s].points;
    const auto along = direction<3>(p_[a], p_[b]);
    std::vector<HalfPlane> planes;
    for (const EntityId f : facets)
      for (const std::uint32_t k : domain_.triangles_at(f, a)) {
        const auto& t = domain_.triangles(f)[k - domain_.facets()[f].first_triangle];
        if (std::find(t.begin(), t.end(), b) == t.end()) continue;
        const std::uint32_t apex = t[0] ^ t[1] ^ t[2] ^ a ^ b;
        planes.push_back({f, detail::cross(along, direction<3>(p_[a], p_[apex]))});
      }
    for (std::size_t i = 0; i < planes.size(); ++i)
      for (std::size_t j = i + 1; j < planes.size(); ++j)
        if (planes[i].facet != planes[j].facet)
          found = std::min(
              found,
              {angle_between(planes[i].normal, planes[j].normal), EntityKind::facet, {planes[i].facet, planes[j].facet}, a});
  }

  const Domain<D>& domain_;
  const std::span<const Point<D>> p_;
  const detail::Bulk bulk_;
  const detail::StopCheck stop_check_;
  std::vector<std::uint32_t> begin_;  // by point
  std::vector<EntityId> at_;
};

}  // namespace

template <int D>
std::optional<SharpAngle<D>> least_angle(const Domain<D>& domain, const std::stop_token& stop) {
  return AngleSearch<D>(domain, stop).run();
}

template PGDR_API std::optional<SharpAngle<2>> least_angle<2>(const Domain<2>&, const std::stop_token&);
template PGDR_API std::optional<SharpAngle<3>> least_angle<3>(const Domain<3>&, const std::stop_token&);

}  // namespace pgdr
