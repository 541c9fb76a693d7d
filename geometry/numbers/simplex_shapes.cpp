// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The formulas of circumsphere.cpp on several simplices side by side: two, as any x86-64 can, or four where AVX2 or AVX-512
// is there. No operation is contracted, so that results are the same.
#include "numbers/simplex_shapes.hpp"

#include <array>
#include <limits>

#include "numbers/circum_terms.hpp"
#include "numbers/lanes.hpp"
#include "numbers/simplex_shapes_anywhere.hpp"

namespace pgdr {
namespace {

using detail::load;
using detail::Mask;
using detail::select;
using detail::store;

constexpr double infinity = std::numeric_limits<double>::infinity();

template <class Lanes, std::size_t D>
[[gnu::always_inline]] inline Mask<Lanes> lex_less(const std::array<Lanes, D>& a, const std::array<Lanes, D>& b) {
  Mask<Lanes> less = a[D - 1] < b[D - 1];
  for (std::size_t k = D - 1; k-- > 0;) less = (a[k] < b[k]) | ((a[k] == b[k]) & less);
  return less;
}

/// Puts two corners in order; `odd` changes where they were not.
template <class Lanes, std::size_t D>
[[gnu::always_inline]] inline void order(std::array<Lanes, D>& a, std::array<Lanes, D>& b, Mask<Lanes>& odd) {
  const Mask<Lanes> swap = lex_less<Lanes, D>(b, a);
  for (std::size_t k = 0; k < D; ++k) {
    const Lanes low = select<Lanes>(swap, b[k], a[k]), high = select<Lanes>(swap, a[k], b[k]);
    a[k] = low;
    b[k] = high;
  }
  odd ^= swap;
}

template <class Lanes, std::size_t D>
[[gnu::always_inline]] inline Lanes squared_length(const std::array<Lanes, D>& a, const std::array<Lanes, D>& b) {
  Lanes sum = (a[0] - b[0]) * (a[0] - b[0]);
  for (std::size_t k = 1; k < D; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

/// @returns where the order is an odd permutation.
template <class Lanes, std::size_t D>
[[gnu::always_inline]] inline Mask<Lanes> sort_corners(std::array<std::array<Lanes, D>, D + 1>& s) {
  Mask<Lanes> odd{};
  if constexpr (D == 3) {
    order<Lanes>(s[0], s[1], odd);
    order<Lanes>(s[2], s[3], odd);
    order<Lanes>(s[0], s[2], odd);
    order<Lanes>(s[1], s[3], odd);
    order<Lanes>(s[1], s[2], odd);
  } else {
    order<Lanes>(s[0], s[1], odd);
    order<Lanes>(s[1], s[2], odd);
    order<Lanes>(s[0], s[1], odd);
  }
  return odd;
}

/// The lanes from `at` on.
template <class Lanes, int D>
[[gnu::always_inline]] inline void shape_of(const SimplexBlock<D>& in, ShapeBlock<D>& out, std::size_t at) {
  using Corner = std::array<Lanes, D>;
  std::array<Corner, D + 1> s;
  for (std::size_t i = 0; i <= D; ++i)
    for (std::size_t k = 0; k < D; ++k) s[i][k] = load<Lanes>(in.corner[i][k] + at);
  const Mask<Lanes> odd = sort_corners<Lanes, D>(s);
  std::array<Corner, D> edge;
  for (std::size_t i = 0; i < D; ++i)
    for (std::size_t k = 0; k < D; ++k) edge[i][k] = s[i + 1][k] - s[0][k];

  const detail::CircumTerms<D, Lanes> t = detail::circum_terms<Lanes>(edge);
  const detail::CircumOffset<D, Lanes> o = detail::circum_offset<D, Lanes>(t);
  const Mask<Lanes> safe = (t.longest2 >= detail::least_safe) & (t.longest2 <= detail::most_safe);
  Lanes largest = detail::magnitude(o.w[0]);
  for (std::size_t k = 1; k < D; ++k) largest = detail::larger(largest, detail::magnitude(o.w[k]));
  const Mask<Lanes> accurate = safe & (o.error <= detail::accepted_error * largest) & (largest < infinity);
  const Lanes none = Lanes{} + infinity;

  Corner center;
  for (std::size_t k = 0; k < D; ++k) {
    center[k] = s[0][k] + o.w[k];
    store<Lanes>(out.center[k] + at, center[k]);
  }
  const Lanes center_error = select<Lanes>(accurate, detail::error_with_last_rounding(center, o.error), none);
  store<Lanes>(out.center_error + at, center_error);
  const Lanes radius2 = squared_length<Lanes>(center, s[0]);
  store<Lanes>(out.squared_radius + at, radius2);
  store<Lanes>(out.power_error + at, 6.0 * center_error / detail::root(radius2));

  Lanes shortest = squared_length<Lanes>(s[0], s[1]);
  for (std::size_t i = 0; i <= D; ++i)
    for (std::size_t j = i + 1; j <= D; ++j)
      if (j > 1) shortest = detail::smaller(shortest, squared_length<Lanes>(s[i], s[j]));
  store<Lanes>(out.shortest_edge_squared + at, shortest);

  Lanes power = t.longest2;  // M^D
  if constexpr (D == 3) power *= detail::root(t.longest2);
  store<Lanes>(out.det + at, select<Lanes>(odd, -t.det, t.det));
  store<Lanes>(out.det_error + at, select<Lanes>(safe, detail::det_error<D> * power, none));
}

template <class Lanes, int D>
[[gnu::always_inline]] inline void shapes_of(std::span<const SimplexBlock<D>> in, std::span<ShapeBlock<D>> out) {
  for (std::size_t b = 0; b < in.size(); ++b)
    for (std::size_t at = 0; at < shape_lanes; at += sizeof(Lanes) / sizeof(double)) shape_of<Lanes, D>(in[b], out[b], at);
}

#if defined(__x86_64__)
template <int D>
[[gnu::target("avx2")]] void shapes_avx2(std::span<const SimplexBlock<D>> in, std::span<ShapeBlock<D>> out) {
  shapes_of<detail::Four, D>(in, out);
}
/// Four numbers as well, with twice the registers and masks of their own.
template <int D>
[[gnu::target("avx2,avx512f,avx512vl,avx512dq")]] void shapes_avx512(std::span<const SimplexBlock<D>> in,
                                                                     std::span<ShapeBlock<D>> out) {
  shapes_of<detail::Four, D>(in, out);
}

const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
const bool has_avx512 = has_avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                        __builtin_cpu_supports("avx512dq");
#endif

}  // namespace

template <int D>
void detail::simplex_shapes_anywhere(std::span<const SimplexBlock<D>> in, std::span<ShapeBlock<D>> out) {
  shapes_of<detail::Two, D>(in, out);
}

template <int D>
void simplex_shapes(std::span<const SimplexBlock<D>> in, std::span<ShapeBlock<D>> out) {
#if defined(__x86_64__)
  if (has_avx512) return shapes_avx512<D>(in, out);
  if (has_avx2) return shapes_avx2<D>(in, out);
#endif
  detail::simplex_shapes_anywhere<D>(in, out);
}

template void detail::simplex_shapes_anywhere<2>(std::span<const SimplexBlock<2>>, std::span<ShapeBlock<2>>);
template void detail::simplex_shapes_anywhere<3>(std::span<const SimplexBlock<3>>, std::span<ShapeBlock<3>>);
template void simplex_shapes<2>(std::span<const SimplexBlock<2>>, std::span<ShapeBlock<2>>);
template void simplex_shapes<3>(std::span<const SimplexBlock<3>>, std::span<ShapeBlock<3>>);

}  // namespace pgdr
