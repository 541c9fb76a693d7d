// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "estimate.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "console.hpp"
#include "size_measure.hpp"

namespace pgdr::tool {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Of a run at its peak; the least of those in docs/performance.md.
template <int D>
constexpr double bytes_a_cell = D == 3 ? 80 : 50;

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
std::uint64_t point_number(const Domain<D>& domain, std::uint32_t v) {
  return std::uint64_t{domain.input_of_point()[v]} + domain.first_index();
}

/// The number in the input of a facet or of a segment; none for an edge of facets that is none of its segments.
template <int D>
std::optional<std::uint64_t> number(const Domain<D>& domain, EntityRef e) {
  if (e.kind == EntityKind::facet) return std::uint64_t{domain.triangle_origins(e.id)[0].facet} + domain.first_index();
  const std::uint32_t input = domain.segments()[e.id].input;
  if (input == no_entity) return std::nullopt;
  return std::uint64_t{input} + domain.first_index();
}

template <int D>
std::string words(const Domain<D>& domain, EntityRef e) {
  if (e.kind == EntityKind::vertex) return "point " + std::to_string(point_number(domain, e.id));
  const auto n = number(domain, e);
  if (e.kind == EntityKind::facet) return "facet " + std::to_string(*n);
  const auto& [a, b] = domain.segments()[e.id].points;
  return (n ? "segment " + std::to_string(*n) + ", " : std::string("the edge ")) + "from point " +
         std::to_string(point_number(domain, a)) + " to point " + std::to_string(point_number(domain, b));
}

template <int D>
std::string words(const Domain<D>& domain, const std::array<EntityRef, 2>& pair) {
  if (pair[0].kind == EntityKind::facet && pair[1].kind == EntityKind::facet)
    return "facets " + std::to_string(*number(domain, pair[0])) + " and " + std::to_string(*number(domain, pair[1]));
  return words(domain, pair[0]) + " and " + words(domain, pair[1]);
}

template <int D>
JsonObject to_json(const Domain<D>& domain, EntityRef e) {
  JsonObject entity{{"kind", e.kind == EntityKind::vertex ? "point" : name(e.kind)}};
  if (e.kind == EntityKind::vertex) {
    entity.set("id", point_number(domain, e.id));
  } else {
    const auto n = number(domain, e);
    entity.set("id", n ? Json(*n) : Json(nullptr));
  }
  if (e.kind == EntityKind::segment) {
    const auto& [a, b] = domain.segments()[e.id].points;
    entity.set("points", std::array{point_number(domain, a), point_number(domain, b)});
  }
  return entity;
}

/// The first number in a file of the kernel; none if it cannot be read, or has the word that means no limit.
std::optional<double> number_in(const char* file, const std::string& after) {
  std::ifstream in(file);
  std::string word;
  if (!after.empty())
    while (in >> word && word != after) continue;
  double value = 0;
  if (in >> value) return value;
  return std::nullopt;
}

/// Bytes that this process can still have: what the machine has left, what a limit on its group or its own leaves.
double available_memory() {
  const auto pages = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  double bytes = pages > 0 ? pages : infinity;
  if (const auto kilobytes = number_in("/proc/meminfo", "MemAvailable:")) bytes = std::min(bytes, *kilobytes * 1024);
  for (const char* file : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
    if (const auto limit = number_in(file, "")) bytes = std::min(bytes, *limit);
  rlimit own{};
  if (getrlimit(RLIMIT_AS, &own) == 0 && own.rlim_cur != RLIM_INFINITY)
    bytes = std::min(bytes, static_cast<double>(own.rlim_cur));
  return bytes;
}

/// Two digits, as more of them would be made up.
template <int D>
std::string about_cells(double cells) {
  const double power = std::pow(10, std::floor(std::log10(std::max(cells, 1.0))) - 1);
  const double rounded = power > 1 ? std::round(cells / power) * power : std::round(cells);
  if (rounded < 1e15) return "about " + count_cells<D>(static_cast<std::uint64_t>(rounded));
  return format("about %.1e ", rounded) + (D == 3 ? "tetrahedra" : "triangles");
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
  options.narrowest = outlook.gap;
  options.voids_by_nesting = voids_by_nesting;
  options.stop = stop;
  outlook.estimate = estimate_cells<D>(domain, options);
  return outlook;
}

template <int D>
void set_outlook(Report& report, const Domain<D>& domain, const Outlook<D>& outlook) {
  if (outlook.estimate) report.set("estimated_cells", std::round(outlook.estimate->cells));
  if (!outlook.gap) return report.set("narrowest_gap", nullptr);
  const Gap<D>& gap = *outlook.gap;
  report.set("narrowest_gap",
             JsonObject{{"distance", gap.distance},
                        {"entities", std::array{to_json(domain, gap.entities[0]), to_json(domain, gap.entities[1])}},
                        {"points", std::array{Json(gap.points[0].x), Json(gap.points[1].x)}}});
}

template <int D>
void print_outlook(const Domain<D>& domain, const Outlook<D>& outlook) {
  if (outlook.estimate) print_row("estimate", about_cells<D>(outlook.estimate->cells));
  if (outlook.gap) {
    const Gap<D>& gap = *outlook.gap;
    print_row("narrowest", words(domain, gap.entities) + ", " + digits(gap.distance) + " apart, at " + words(gap.points[0]) +
                               " and " + words(gap.points[1]));
  }
  if (outlook.angle)
    print_row("sharpest", words(domain, outlook.angle->entities) + ", at " + format("%.3g", outlook.angle->degrees) +
                              " degrees, at " + words(outlook.angle->point));
  std::fflush(stdout);
}

template <int D>
bool has_memory_for(const Outlook<D>& outlook) {
  if (!outlook.estimate || !outlook.estimate->most_due_to) return true;
  return !(outlook.estimate->at_least * bytes_a_cell<D> > available_memory());
}

template <int D>
void require_memory(const Domain<D>& domain, const Outlook<D>& outlook, const std::function<std::string()>& cure) {
  if (has_memory_for(outlook)) return;
  const double cells = outlook.estimate->at_least, bytes = cells * bytes_a_cell<D>, there_are = available_memory();
  const Gap<D>& gap = *outlook.estimate->most_due_to;
  Diagnostic d{.code = Errc::out_of_memory, .file = domain.source().file};
  d.message = words(domain, gap.entities) + " are " + digits(gap.distance) + " apart, at " + words(gap.points[0]) + " and " +
              words(gap.points[1]) +
              format(": that takes at least %.1e cells, so %.1e bytes of memory, and there are %.1e. ", cells, bytes, there_are) +
              "With --max-vertices or --time-limit a part of the mesh is made";
  if (const std::string words = cure(); !words.empty()) d.message += ". " + words;
  for (const Point<D>& p : gap.points) d.points.push_back({p[0], p[1], D == 3 ? p[D - 1] : 0});
  throw ResourceError(std::move(d));
}

#define PGDR_INSTANTIATE(D)                                                                                        \
  template Outlook<D> look_ahead<D>(const Domain<D>&, const Bounds<D>&, bool, RegionMode, const std::stop_token&); \
  template void set_outlook<D>(Report&, const Domain<D>&, const Outlook<D>&);                                      \
  template void print_outlook<D>(const Domain<D>&, const Outlook<D>&);                                             \
  template bool has_memory_for<D>(const Outlook<D>&);                                                              \
  template void require_memory<D>(const Domain<D>&, const Outlook<D>&, const std::function<std::string()>&);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr::tool
