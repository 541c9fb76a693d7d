// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Expansion arithmetic: a real number as an exact sum of doubles of increasing magnitude (Dekker 1971; Priest 1991;
// Shewchuk 1997). No allocation: capacities are part of the types. Exact as long as nothing under- or overflows, which
// the caller sees to with `in_expansion_range`. Products are split by Veltkamp's method, since the baseline instruction
// set has no fused multiply-add. Private to the layer; pure functions, any thread.
#pragma once

#include <algorithm>
#include <cmath>

#include "pgdr/types.hpp"

namespace pgdr::detail {

/// hi + lo is the exact result, hi the rounded one.
struct Twice {
  double hi, lo;
};

inline Twice two_sum(double a, double b) {
  const double s = a + b;
  const double b_part = s - a;
  return {s, (a - (s - b_part)) + (b - b_part)};
}

inline Twice two_diff(double a, double b) { return two_sum(a, -b); }

/// @pre |a| >= |b| or a == 0.
inline Twice fast_two_sum(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}

/// Two halves of at most 26 bits each (the sign of lo is the 53rd bit).
inline Twice split(double a) {
  const double c = 134217729.0 * a;  // 2^27 + 1
  const double hi = c - (c - a);
  return {hi, a - hi};
}

inline Twice two_product(double a, double b, Twice b_split) {
  const double p = a * b;
  const Twice s = split(a);
  const double rest = ((p - s.hi * b_split.hi) - s.lo * b_split.hi) - s.hi * b_split.lo;
  return {p, s.lo * b_split.lo - rest};
}

inline Twice two_product(double a, double b) { return two_product(a, b, split(b)); }

// Coordinates that are zero or of magnitude 2^-160 to 2^190 are multiples of 2^-212 and, after a difference or a sum,
// below 2^191. Polynomials up to degree 5 with at most 2^7 terms then are multiples of 2^-1060, so that no part of a
// product is lost, and stay below 2^962, so that splitting (a factor 2^27) does not overflow.
inline constexpr double expansion_min = 0x1p-160, expansion_max = 0x1p190;
// An expansion is strongly nonoverlapping: at most two components in three bits. 2022 bits * 2/3 = 1348.
inline constexpr int max_terms = 1400;

inline bool in_expansion_range(double x) {
  const double m = std::fabs(x);
  return m == 0 || (m >= expansion_min && m <= expansion_max);
}

/// Sum of `size` doubles, none zero, strongly nonoverlapping, in increasing order of magnitude; zero has none.
template <int N>
struct Expansion {
  static constexpr int capacity = N;
  int size = 0;
  double term[N + 1];  // one more: push writes before it knows whether the term counts

  Expansion() = default;
  explicit Expansion(double a) { push(a); }
  explicit Expansion(Twice a) {
    push(a.lo);
    push(a.hi);
  }
  Expansion(const Expansion& o) : size(o.size) { std::copy_n(o.term, o.size, term); }
  Expansion& operator=(const Expansion& o) {
    size = o.size;
    std::copy_n(o.term, o.size, term);
    return *this;
  }

  void push(double t) {
    term[size] = t;
    size += t != 0;
  }
};

template <int N>
Sign sign(const Expansion<N>& e) {
  return e.size == 0 ? Sign::zero : sign_of(e.term[e.size - 1]);
}

/// e + factor * f for factor = +-1: one merge by magnitude, the rounding errors kept.
/// @pre the result has at most C terms.
template <int C, int N, int M>
Expansion<C> merge(const Expansion<N>& e, const Expansion<M>& f, double factor) {
  Expansion<C> h;
  int i = 0, j = 0;
  const auto smallest = [&] {
    if (j == f.size || (i < e.size && std::fabs(e.term[i]) < std::fabs(f.term[j]))) return e.term[i++];
    return factor * f.term[j++];
  };
  if (e.size + f.size == 0) return h;
  double q = smallest();
  while (i < e.size || j < f.size) {
    const Twice s = two_sum(q, smallest());
    h.push(s.lo);
    q = s.hi;
  }
  h.push(q);
  return h;
}

template <int N, int M>
auto add(const Expansion<N>& e, const Expansion<M>& f) {
  return merge<std::min(N + M, max_terms)>(e, f, 1.0);
}

template <int N, int M>
auto sub(const Expansion<N>& e, const Expansion<M>& f) {
  return merge<std::min(N + M, max_terms)>(e, f, -1.0);
}

template <int N>
auto scale(const Expansion<N>& e, double b) {
  Expansion<std::min(2 * N, max_terms)> h;
  if (e.size == 0 || b == 0) return h;
  const Twice b_split = split(b);
  Twice q = two_product(e.term[0], b, b_split);
  h.push(q.lo);
  for (int i = 1; i < e.size; ++i) {
    const Twice p = two_product(e.term[i], b, b_split);
    const Twice s = two_sum(q.hi, p.lo);
    h.push(s.lo);
    q = fast_two_sum(p.hi, s.hi);
    h.push(q.lo);
  }
  h.push(q.hi);
  return h;
}

/// The product: the longer factor scaled by every term of the shorter one.
template <int N, int M>
auto mul(const Expansion<N>& e, const Expansion<M>& f) {
  constexpr int terms = std::min(2 * N * M, max_terms);
  if constexpr (M == 1) {
    return scale(e, f.size == 0 ? 0 : f.term[0]);
  } else if constexpr (N == 1) {
    return scale(f, e.size == 0 ? 0 : e.term[0]);
  } else {
    Expansion<terms> h;
    if (f.size <= e.size) {
      for (int j = 0; j < f.size; ++j) h = merge<terms>(h, scale(e, f.term[j]), 1.0);
    } else {
      for (int j = 0; j < e.size; ++j) h = merge<terms>(h, scale(f, e.term[j]), 1.0);
    }
    return h;
  }
}

}  // namespace pgdr::detail
