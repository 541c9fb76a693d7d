// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Is there memory for what gaps alone ask for? And the words for the two entities at fault.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "diagnose/cells_between.hpp"
#include "input/words.hpp"
#include "pgdr/error.hpp"
#include "pgdr/estimate.hpp"
#include "space/stop_check.hpp"
#include "space/system.hpp"

namespace pgdr {
namespace {

/// Of a run at its peak; the least of those in bench/notebook/performance.md.
template <int D>
constexpr double bytes_a_cell = D == 3 ? 80 : 50;

/// The first number in a file of the kernel, or the first behind the word `after`; none if it cannot be read, or has the word
/// that means no limit.
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
  double bytes = std::min(detail::system::physical_memory(), detail::system::limit_on_addresses());
  if (const auto kilobytes = number_in("/proc/meminfo", "MemAvailable:")) bytes = std::min(bytes, *kilobytes * 1024);
  for (const char* file : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
    if (const auto limit = number_in(file, "")) bytes = std::min(bytes, *limit);
  return bytes;
}

template <int D>
std::string words_of(const Domain<D>& domain, EntityRef e) {
  const auto number = input_number(domain, e);
  if (e.kind == EntityKind::vertex) return "point " + std::to_string(*number);
  if (e.kind == EntityKind::facet) return "facet " + std::to_string(*number);
  const auto& [a, b] = domain.segments()[e.id].points;
  const auto point = [&](std::uint32_t v) { return std::to_string(*input_number(domain, EntityRef{EntityKind::vertex, v})); };
  return (number ? "segment " + std::to_string(*number) + ", " : std::string("the edge ")) + "from point " + point(a) +
         " to point " + point(b);
}

}  // namespace

template <int D>
std::optional<std::uint64_t> input_number(const Domain<D>& domain, EntityRef e) {
  const std::uint64_t first = domain.first_index();
  if (e.kind == EntityKind::vertex) return domain.input_of_point()[e.id] + first;
  if (e.kind == EntityKind::facet) return domain.triangle_origins(e.id)[0].facet + first;
  const std::uint32_t input = domain.segments()[e.id].input;
  if (input == no_entity) return std::nullopt;
  return input + first;
}

template <int D>
std::string words_of(const Domain<D>& domain, const std::array<EntityRef, 2>& pair) {
  if (pair[0].kind != EntityKind::facet || pair[1].kind != EntityKind::facet)
    return words_of(domain, pair[0]) + " and " + words_of(domain, pair[1]);
  return "facets " + std::to_string(*input_number(domain, pair[0])) + " and " + std::to_string(*input_number(domain, pair[1]));
}

template <int D>
bool has_memory_for(const CellEstimate<D>& estimate) {
  return !estimate.most_due_to || !(estimate.at_least * bytes_a_cell<D> > available_memory());
}

template <int D>
void require_memory(const Domain<D>& domain, const CellEstimate<D>& estimate) {
  if (has_memory_for(estimate)) return;
  const double cells = estimate.at_least, bytes = cells * bytes_a_cell<D>, there_are = available_memory();
  const Gap<D>& gap = *estimate.most_due_to;
  char counts[120];
  std::snprintf(counts, sizeof counts, "%.1e cells, so %.1e bytes of memory, and there are %.1e", cells, bytes, there_are);
  Diagnostic d{.code = Errc::out_of_memory, .file = domain.source().file};
  d.message = words_of(domain, gap.entities) + " are " + detail::to_text(gap.distance) + " apart, at " +
              detail::to_text(gap.points[0]) + " and " + detail::to_text(gap.points[1]) + ": that takes at least " + counts +
              ". With a limit on the vertices or the time a part of the mesh is made";
  for (const Point<D>& p : gap.points) d.points.push_back(detail::in_space(p));
  throw ResourceError(std::move(d));
}

template <int D>
void require_memory(const Domain<D>& domain, const EstimateOptions<D>& options) {
  const detail::Bulk bulk(true, options.stop);
  const detail::StopCheck stop_check(options.stop);
  const detail::NearPieces<D> pieces(domain, bulk);
  const auto may_take_more = [&](double cells) {
    const bool may = detail::may_take_more_cells_between(pieces, options.radius_edge_bound, cells, bulk);
    stop_check();
    return may;
  };
  constexpr double always_room_for = 1e5;  // cells: asking for the memory takes longer than the mesh of a cube
  if (!may_take_more(always_room_for) || !may_take_more(available_memory() / bytes_a_cell<D>)) return;
  CellEstimate<D> estimate;
  const detail::MeshedSpace<D> space(pieces, options.voids_by_nesting, bulk, stop_check);
  stop_check();
  detail::add_cells_between(pieces, space, options.radius_edge_bound, bulk, estimate);
  stop_check();
  require_memory(domain, estimate);
}

#define PGDR_INSTANTIATE(D)                                                                     \
  template PGDR_API std::optional<std::uint64_t> input_number<D>(const Domain<D>&, EntityRef);  \
  template PGDR_API std::string words_of<D>(const Domain<D>&, const std::array<EntityRef, 2>&); \
  template PGDR_API bool has_memory_for<D>(const CellEstimate<D>&);                             \
  template PGDR_API void require_memory<D>(const Domain<D>&, const CellEstimate<D>&);           \
  template PGDR_API void require_memory<D>(const Domain<D>&, const EstimateOptions<D>&);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr
