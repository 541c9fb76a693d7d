// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Two or four numbers side by side, as the compiler's vectors, with the few functions that formulas need besides the
// operators. Those for plain numbers have the same names, so that one formula serves all. Everything is inlined always:
// a function compiled for one processor must not be shared with code for another.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace pgdr::detail {

using Two = double __attribute__((vector_size(16)));
using Four = double __attribute__((vector_size(32)));

template <class Lanes>
struct LanesMask;
template <>
struct LanesMask<Two> {
  using type = std::int64_t __attribute__((vector_size(16)));
};
template <>
struct LanesMask<Four> {
  using type = std::int64_t __attribute__((vector_size(32)));
};
/// All bits of a lane are set, or none.
template <class Lanes>
using Mask = typename LanesMask<Lanes>::type;

template <class Lanes>
[[gnu::always_inline]] inline Lanes select(const Mask<Lanes>& mask, const Lanes& yes, const Lanes& no) {
  return reinterpret_cast<Lanes>((reinterpret_cast<Mask<Lanes>>(yes) & mask) | (reinterpret_cast<Mask<Lanes>>(no) & ~mask));
}

[[gnu::always_inline]] inline double larger(double a, double b) { return a > b ? a : b; }
[[gnu::always_inline]] inline double magnitude(double x) { return std::fabs(x); }
[[gnu::always_inline]] inline double root(double x) { return std::sqrt(x); }

template <class Lanes>
[[gnu::always_inline]] inline Lanes larger(const Lanes& a, const Lanes& b) {
  return select<Lanes>(a > b, a, b);
}
template <class Lanes>
[[gnu::always_inline]] inline Lanes smaller(const Lanes& a, const Lanes& b) {
  return select<Lanes>(b < a, b, a);
}
template <class Lanes>
[[gnu::always_inline]] inline Lanes magnitude(const Lanes& x) {
  return reinterpret_cast<Lanes>(reinterpret_cast<Mask<Lanes>>(x) & std::int64_t{0x7fffffffffffffff});
}
template <class Lanes>
[[gnu::always_inline]] inline Lanes root(const Lanes& x) {
  Lanes r;
  for (std::size_t l = 0; l < sizeof(Lanes) / sizeof(double); ++l) r[l] = __builtin_sqrt(x[l]);
  return r;
}

template <class Lanes>
[[gnu::always_inline]] inline Lanes load(const double* p) {
  Lanes v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}
template <class Lanes>
[[gnu::always_inline]] inline void store(double* p, const Lanes& v) {
  __builtin_memcpy(p, &v, sizeof v);
}

}  // namespace pgdr::detail
