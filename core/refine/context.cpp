// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "refine/context.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "numbers/rounding.hpp"
#include "space/box.hpp"

namespace pgdr {
namespace {

/// When the refinement has to end so that the run ends about at its limit. Numbering and measuring what an interrupted run has made
/// take up to a fiftieth of the time of the refinement, in 2D up to a sixteenth, as an insertion takes little more than a microsecond
/// there: on one thread, of a cube and a square with a constant size. Half of that is kept for it, so that the run ends as much
/// before its limit at most, where insertions are slow, as after it where they are fast.
template <int D>
std::chrono::duration<double> most_time(std::chrono::duration<double> limit) {
  constexpr double rest = D == 2 ? 0.06 : 0.02;
  return limit / (1 + rest / 2);
}

}  // namespace

template <int D>
RefineContext<D>::RefineContext(Mesh<D>& m, const Domain<D>& d, const RefineOptions<D>& o, CellBounds<D> b,
                                std::uint64_t vertices_so_far, std::chrono::steady_clock::time_point start_time)
    : mesh(m),
      domain(d),
      options(o),
      bounds(std::move(b)),
      start(start_time),
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
int RefineContext<D>::bucket_of(const FilterSphere<D>& sphere) const {
  const double r2 = sphere.radius2;
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
  } else if (stop == 0 && options.time_limit &&
             std::chrono::steady_clock::now() - start >= most_time<D>(*options.time_limit)) {
    stop = static_cast<int>(StopCause::time_limit);
  }
  return stop != 0;
}

template struct RefineContext<2>;
template struct RefineContext<3>;

}  // namespace pgdr
