// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "estimate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "console.hpp"
#include "size_measure.hpp"

namespace pgdr::tool {
namespace {

template <int D>
EstimateOptions<D> estimate_options(const Bounds<D>& bounds) {
  EstimateOptions<D> options;
  options.radius_edge_bound = bounds.radius_edge;
  options.measure = measure_of_sizes<D>(bounds.size, bounds.region_sizes, bounds.max_volume);
  return options;
}

template <int D>
std::string words(const Point<D>& p) {
  std::string text = "(";
  for (int i = 0; i < D; ++i) text += (i > 0 ? ", " : "") + digits(p[i]);
  return text + ")";
}

template <int D>
JsonObject json_of_entity(const Domain<D>& domain, EntityRef e) {
  JsonObject entity{{"kind", e.kind == EntityKind::vertex ? "point" : name(e.kind)}};
  const auto n = input_number(domain, e);
  entity.set("id", n ? Json(*n) : Json(nullptr));
  if (e.kind == EntityKind::segment) {
    const auto& [a, b] = domain.segments()[e.id].points;
    const auto number_of = [&](std::uint32_t v) { return *input_number(domain, EntityRef{EntityKind::vertex, v}); };
    entity.set("points", std::array{number_of(a), number_of(b)});
  }
  return entity;
}

/// Two digits, as more of them would be made up; rounded down.
template <int D>
std::string at_least_cells(double cells) {
  const double power = std::pow(10, std::floor(std::log10(std::max(cells, 1.0))) - 1);
  const double rounded = power > 1 ? std::floor(cells / power) * power : std::floor(cells);
  if (rounded < 1e15) return "at least " + count_cells<D>(static_cast<std::uint64_t>(rounded));
  return format("at least %.1e ", rounded) + (D == 3 ? "tetrahedra" : "triangles");
}

}  // namespace

template <int D>
Outlook<D> look_ahead(const Domain<D>& domain, const Bounds<D>& bounds, bool refines, RegionMode regions,
                      const std::stop_token& stop) {
  const bool voids_by_nesting = regions == RegionMode::automatic;
  Outlook<D> outlook;
  outlook.gap = narrowest_gap<D>(domain, {.voids_by_nesting = voids_by_nesting, .stop = stop});
  outlook.angle = least_angle<D>(domain, stop);
  if (!refines) return outlook;
  EstimateOptions<D> options = estimate_options<D>(bounds);
  options.voids_by_nesting = voids_by_nesting;
  options.stop = stop;
  outlook.estimate = estimate_cells<D>(domain, options);
  return outlook;
}

template <int D>
void set_outlook(Report& report, const Domain<D>& domain, const Outlook<D>& outlook) {
  if (outlook.estimate) report.set("estimated_cells", std::floor(outlook.estimate->cells));
  if (!outlook.gap) return report.set("narrowest_gap", nullptr);
  const Gap<D>& gap = *outlook.gap;
  report.set(
      "narrowest_gap",
      JsonObject{{"distance", gap.distance},
                 {"entities", std::array{json_of_entity(domain, gap.entities[0]), json_of_entity(domain, gap.entities[1])}},
                 {"points", std::array{Json(gap.points[0].x), Json(gap.points[1].x)}}});
}

template <int D>
void print_outlook(const Domain<D>& domain, const Outlook<D>& outlook) {
  if (outlook.estimate) print_row("estimate", at_least_cells<D>(outlook.estimate->cells));
  if (outlook.gap) {
    const Gap<D>& gap = *outlook.gap;
    print_row("narrowest", words_of(domain, gap.entities) + ", " + digits(gap.distance) + " apart, at " + words(gap.points[0]) +
                               " and " + words(gap.points[1]));
  }
  if (outlook.angle)
    print_row("sharpest", words_of(domain, outlook.angle->entities) + ", at " + format("%.3g", outlook.angle->degrees) +
                              " degrees, at " + words(outlook.angle->point));
  std::fflush(stdout);
}

#define PGDR_INSTANTIATE(D)                                                                                        \
  template Outlook<D> look_ahead<D>(const Domain<D>&, const Bounds<D>&, bool, RegionMode, const std::stop_token&); \
  template void set_outlook<D>(Report&, const Domain<D>&, const Outlook<D>&);                                      \
  template void print_outlook<D>(const Domain<D>&, const Outlook<D>&);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr::tool
