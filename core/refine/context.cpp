// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "refine/context.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "numbers/rounding.hpp"
#include "refine/meshed_parts.hpp"
#include "space/box.hpp"

namespace pgdr {
namespace {

/// What finishing the mesh of an interrupted run takes, for each vertex: of a cube and a square with a constant size; and as much
/// more as cells have faces on facets (2D: segments), as between two that nearly touch. Measured on one thread. On a slower
/// machine it is more, but hardly a larger part of the time so far than where insertions are fast.
template <int D>
std::chrono::duration<double> time_to_finish(const Mesh<D>& mesh, double vertices, std::chrono::duration<double> so_far) {
  using Microseconds = std::chrono::duration<double, std::micro>;
  constexpr Microseconds least(D == 2 ? 0.15 : 0.4), more(D == 2 ? 0.5 : 1.5);
  constexpr double most_part_least = D == 2 ? 0.06 : 0.1, most_part_more = D == 2 ? 0.34 : 0.18;
  const double at_facets = std::min(mesh.constraint_bound() / std::max<double>(mesh.cell_bound(), 1), 1.0);
  return std::min<std::chrono::duration<double>>(vertices * (least + at_facets * more),
                                                 so_far * (most_part_least + at_facets * most_part_more));
}

/// As many that elements of the one are by this ratio larger than those of the other, or more.
int buckets_of_ratio(double ratio) {
  constexpr int most = RefineContext<3>::buckets;
  if (!(ratio < std::ldexp(1.0, most))) return most;
  const int floor = std::ilogb(ratio);
  return std::max(0, std::ldexp(1.0, floor) < ratio ? floor + 1 : floor);
}

}  // namespace

template <int D>
RefineContext<D>::RefineContext(Mesh<D>& m, const Domain<D>& d, const RefineOptions<D>& o, CellBounds<D> b,
                                std::uint64_t vertices_so_far, std::chrono::steady_clock::time_point start_time)
    : mesh(m),
      domain(d),
      options(o),
      bounds(std::move(b)),
      kept(o, d),
      meshed(meshed_triangles<D>(m, d)),
      start(start_time),
      buckets_before_entities(D == 2 ? buckets : buckets_of_ratio(2 * bounds.radius_edge_bound)),
      shells(d, D == 2),
      vertices(vertices_so_far),
      last_progress(start_time) {
  const auto box = detail::Box<D>::of(domain.points());
  base_exponent = std::ilogb(box.longest_side());
  if constexpr (D == 2) {
    double largest = 0;
    for (int i = 0; i < D; ++i) largest = std::max({largest, std::fabs(box.low[i]), std::fabs(box.high[i])});
    least_apart = std::ldexp(8 * rounding::ulp, std::ilogb(largest));
  }
}

template <int D>
int RefineContext<D>::bucket_of(double r2) const {
  if (!(r2 < std::numeric_limits<double>::infinity())) return 0;
  // floor(log2(side / r)) up to one: ilogb of r^2 halved, rounding down. Of a normal number ilogb is in its bits.
  const int biased = static_cast<int>(std::bit_cast<std::uint64_t>(r2) >> 52);
  const int e = biased > 0 ? biased - 1023 : std::ilogb(r2);
  return std::clamp(base_exponent - (e >> 1), 0, buckets - 1);
}

template <int D>
double RefineContext<D>::largest_radius(int bucket) const {
  return bucket == 0 ? std::numeric_limits<double>::infinity() : std::ldexp(1.0, base_exponent - bucket + 1);
}

template <int D>
bool RefineContext<D>::ended() {
  if (options.stop.stop_requested()) {
    stop = static_cast<int>(StopCause::cancelled);
  } else if (stop == 0 && options.time_limit) {
    const std::chrono::duration<double> so_far = elapsed();
    const auto end = so_far + time_to_finish(mesh, static_cast<double>(vertices.load()), so_far);
    if (end >= *options.time_limit) stop = static_cast<int>(StopCause::time_limit);
  }
  return stop != 0;
}

template <int D>
void RefineContext<D>::tell(std::uint64_t vertices_so_far, std::uint64_t waiting) {
  constexpr std::chrono::milliseconds between(200);
  if (!options.progress) return;
  const auto now = std::chrono::steady_clock::now();
  const std::unique_lock lock(progress_mutex, std::try_to_lock);
  if (!lock || now - last_progress < between) return;
  last_progress = now;
  constexpr double most = 0.99;  // until all is done
  const double to_come = remaining ? remaining() : -1, so_far = elapsed().count();
  if (to_come >= 0) done = std::max(done, std::min(so_far / (so_far + to_come), most));
  options.progress({vertices_so_far, waiting, at, done < 0 ? std::nullopt : std::optional(done)});
}

template struct RefineContext<2>;
template struct RefineContext<3>;

}  // namespace pgdr
