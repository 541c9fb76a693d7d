// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "boundary/recovery.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <string>

#include "boundary/named_points.hpp"
#include "boundary/segment_insertion.hpp"
#include "boundary/state.hpp"

namespace pgdr {
namespace {

/// Recovery by Steiner points on facets need not end where facets meet at small angles or nearly touch: past this many points it is
/// given up with a typed error, unless less is missing than was before. (Between two faces 1e-9 apart 1.85 times as many triangles
/// are missing round by round; in a terrain with facets at a tenth of a degree it is twice as many segments, until there are 300
/// points for one of the input, and soon a third from there on.)
std::uint64_t most_points(std::size_t input_points) {
  return 200000 + 100 * std::uint64_t{input_points} + std::min<std::uint64_t>(300 * std::uint64_t{input_points}, 1500000);
}
constexpr std::uint64_t most_points_more = 5000000;  // while it becomes less
constexpr std::uint64_t most_rounds = 2000;          // of these

/// Nothing is missing before triangles are split for their shape: where that takes more points than this is to be done without.
std::uint64_t most_points_after(std::size_t input_points, std::uint64_t improving) {
  return 20000 + 10 * std::uint64_t{input_points} + 4 * improving;
}

/// The least angle at which two facets of the segment meet, in degrees.
double least_angle_at(const Domain<3>& domain, EntityId segment) {
  const auto facets = domain.facets_of_segment(segment);
  double least = 180;
  for (std::size_t i = 0; i < facets.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      least = std::min(least, entity_angle<3>(domain, {EntityKind::facet, facets[i]}, {EntityKind::facet, facets[j]}));
  return least;
}

/// Names the segment, or the facet, that has got the most points, by its points in the input.
InputError not_recovered(const Domain<3>& domain, const detail::SegmentChains& chains, const detail::FacetPatches& patches,
                         std::uint64_t points) {
  EntityRef most;
  std::size_t on_it = 0;
  const auto look_at = [&](EntityRef e, std::size_t n) {
    if (n <= on_it) return;
    most = e;
    on_it = n;
  };
  for (EntityId s = 0; s < domain.segments().size(); ++s) look_at({EntityKind::segment, s}, chains.chain(s).size() - 2);
  for (EntityId f = 0; f < domain.facets().size(); ++f) look_at({EntityKind::facet, f}, patches.inner_points(f));
  const bool is_facet = most.kind == EntityKind::facet;
  const std::span<const std::uint32_t> ends = is_facet ? domain.facet_points(most.id) : domain.segments()[most.id].points;
  Diagnostic d = detail::about_points<3>(Errc::boundary_not_recovered, domain, ends);
  d.message = "the boundary is not recovered after " + std::to_string(points) +
              " Steiner points: facets meet at very small angles, or nearly touch. The most, " + std::to_string(on_it) +
              ", are on " + (is_facet ? detail::facet_words(d) : detail::segment_words(d));
  if (const double angle = is_facet ? 180 : least_angle_at(domain, most.id); angle < 180)
    d.message += ", where facets meet at " + std::to_string(angle) + " degrees";
  return InputError(std::move(d));
}

}  // namespace

template <int D>
StopCause recover_boundary(Mesh<D>& mesh, typename Mesh<D>::Pools& pools, Delaunay<D>& delaunay,
                           const Domain<D>& domain, const RefineOptions<D>& options,
                           std::chrono::steady_clock::time_point start, RecoveryCounts& counts) {
  StopCause cause = StopCause::finished;
  auto stopped = [&] {
    if (options.stop.stop_requested()) cause = StopCause::cancelled;
    if (options.time_limit && std::chrono::steady_clock::now() - start >= *options.time_limit)
      cause = StopCause::time_limit;
    return cause != StopCause::finished;
  };
  if constexpr (D == 3) {
    detail::SegmentChains chains(mesh, delaunay, domain);
    detail::FacetPatches patches(mesh, delaunay, domain, chains);
    // Triangles up to twice the bound are left to the refinement, which splits them in the order that makes few points.
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double bound = options.refine ? 2 * std::max(options.radius_edge_bound, 2.0) : infinity;
    const std::uint64_t most = most_points(domain.points().size());
    auto steiner = [&] { return chains.points() + patches.points(); };
    auto told = start;
    auto tell = [&] {
      if (!options.progress) return;
      const auto now = std::chrono::steady_clock::now();
      if (now - told < std::chrono::milliseconds(200)) return;
      told = now;
      options.progress({domain.points().size() + steiner(), 0});
    };
    auto ended = [&] {
      tell();
      if (domain.points().size() + steiner() >= options.max_vertices) cause = StopCause::max_vertices;
      return stopped();
    };
    std::uint64_t needed = 0;  // points, before any was for the shape of a triangle
    auto stop = [&] {
      const std::uint64_t missing = steiner() - counts.improving;
      const bool is_falling = patches.trend().rounds() > 1 ? patches.trend().is_falling() : chains.trend().is_falling();
      const bool too_many = missing > most + (is_falling && counts.rounds < most_rounds ? most_points_more : 0);
      const bool too_many_after =
          counts.improving > 0 && missing - needed > most_points_after(domain.points().size(), counts.improving);
      if (too_many || too_many_after) throw not_recovered(domain, chains, patches, missing);
      return ended();
    };
    auto improve = [&] {
      const std::uint64_t before = steiner();
      if (counts.improving == 0) needed = before;
      const bool any = patches.split_poor_triangles(bound, options.min_edge, ended);
      counts.improving += steiner() - before;
      return any;
    };
    do {
      ++counts.rounds;
      if (stop() || !chains.recover(stop)) break;
      if (!patches.recover_once(stop)) {
        if (bound < infinity && improve()) continue;
        patches.mark(pools);
        chains.mark(pools);
        break;
      }
    } while (true);
    counts.segment_points = chains.points();
    counts.facet_points = patches.points();
  } else {
    if (!stopped()) detail::SegmentInsertion(mesh, pools, delaunay, domain).run(stopped);
    counts.rounds = 1;
  }
  return cause;
}

template StopCause recover_boundary<2>(Mesh<2>&, Mesh<2>::Pools&, Delaunay<2>&, const Domain<2>&,
                                       const RefineOptions<2>&, std::chrono::steady_clock::time_point, RecoveryCounts&);
template StopCause recover_boundary<3>(Mesh<3>&, Mesh<3>::Pools&, Delaunay<3>&, const Domain<3>&,
                                       const RefineOptions<3>&, std::chrono::steady_clock::time_point, RecoveryCounts&);

}  // namespace pgdr
