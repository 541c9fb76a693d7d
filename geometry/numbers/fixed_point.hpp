// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Integers of a few machine words, for determinants of points on a common lattice: where all differences of coordinates
// are multiples of one 2^g and below 2^(g+61), the determinant is one of 62-bit integers. That holds on grids, and for
// most other cells too; it costs a tenth of expansions, and knows neither underflow nor overflow. Private to the layer;
// pure functions, any thread.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "pgdr/types.hpp"

namespace pgdr::detail {

__extension__ typedef __int128 SignedWord2;
__extension__ typedef unsigned __int128 Word2;  // of GCC and Clang on 64-bit machines

/// Two's complement in W words, least significant first. Operations wrap at the width of their result: sums keep the
/// width of the wider operand, so a polynomial needs spare bits, and differences are held to 61 of 63 bits for that.
/// (In-sphere in space: minors 2^123 in two words, 3x3 minors 2^186 in three, heights 2^124 in two, the sum 2^312 in five.)
template <std::size_t W>
struct FixedInt {
  std::array<std::uint64_t, W> word{};

  FixedInt() = default;
  explicit FixedInt(std::int64_t v) {
    word.fill(v < 0 ? ~std::uint64_t{0} : 0);
    word[0] = static_cast<std::uint64_t>(v);
  }
  bool negative() const { return (word[W - 1] >> 63) != 0; }
  std::uint64_t extended(std::size_t i) const { return i < W ? word[i] : negative() ? ~std::uint64_t{0} : 0; }
};

template <std::size_t A, std::size_t B>
FixedInt<std::max(A, B)> add(const FixedInt<A>& a, const FixedInt<B>& b) {
  FixedInt<std::max(A, B)> r;
  Word2 carry = 0;
  for (std::size_t i = 0; i < r.word.size(); ++i) {
    carry += static_cast<Word2>(a.extended(i)) + b.extended(i);
    r.word[i] = static_cast<std::uint64_t>(carry);
    carry >>= 64;
  }
  return r;
}

template <std::size_t A, std::size_t B>
FixedInt<std::max(A, B)> sub(const FixedInt<A>& a, const FixedInt<B>& b) {
  FixedInt<std::max(A, B)> r;
  Word2 carry = 1;  // a + ~b + 1
  for (std::size_t i = 0; i < r.word.size(); ++i) {
    carry += static_cast<Word2>(a.extended(i)) + ~b.extended(i);
    r.word[i] = static_cast<std::uint64_t>(carry);
    carry >>= 64;
  }
  return r;
}

/// The product of the words as unsigned numbers; a negative factor was taken 2^(64 A) too large, so the other one is
/// subtracted from the upper words.
template <std::size_t A, std::size_t B>
FixedInt<A + B> mul(const FixedInt<A>& a, const FixedInt<B>& b) {
  FixedInt<A + B> r;
  for (std::size_t i = 0; i < A; ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < B; ++j) {
      const Word2 t = static_cast<Word2>(a.word[i]) * b.word[j] + r.word[i + j] + carry;
      r.word[i + j] = static_cast<std::uint64_t>(t);
      carry = static_cast<std::uint64_t>(t >> 64);
    }
    r.word[i + B] = carry;
  }
  const auto subtract_at = [&]<std::size_t N>(std::size_t at, const FixedInt<N>& v, bool factor_is_negative) {
    const std::uint64_t mask = factor_is_negative ? ~std::uint64_t{0} : 0;
    Word2 carry = 1;
    for (std::size_t i = 0; i < N; ++i) {
      carry += static_cast<Word2>(r.word[at + i]) + ~(v.word[i] & mask);
      r.word[at + i] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
  };
  subtract_at(A, b, a.negative());
  subtract_at(B, a, b.negative());
  return r;
}

inline FixedInt<2> mul(const FixedInt<1>& a, const FixedInt<1>& b) {
  const auto value = [](const FixedInt<1>& v) { return static_cast<SignedWord2>(static_cast<std::int64_t>(v.word[0])); };
  const SignedWord2 product = value(a) * value(b);
  FixedInt<2> r;
  r.word = {static_cast<std::uint64_t>(product), static_cast<std::uint64_t>(product >> 64)};
  return r;
}

template <std::size_t W>
Sign sign(const FixedInt<W>& a) {
  if (a.negative()) return Sign::negative;
  std::uint64_t any = 0;
  for (const std::uint64_t w : a.word) any |= w;
  return any == 0 ? Sign::zero : Sign::positive;
}

/// Integers of two words throughout, for coordinates of few digits: differences below 2^23. (In-sphere in space: minors 2^47, 3x3
/// minors 2^71.6, heights 2^47.6, the sum 2^121.2. Heights of in-circle in a plane of space 2^48, of angles of 60 degrees 2^98.)
struct ShortInt {
  static constexpr int bits = 22;  ///< steps of the lattice to the binary order of the largest
  SignedWord2 value = 0;
};
inline ShortInt add(ShortInt a, ShortInt b) { return {a.value + b.value}; }
inline ShortInt sub(ShortInt a, ShortInt b) { return {a.value - b.value}; }
inline ShortInt mul(ShortInt a, ShortInt b) { return {a.value * b.value}; }
inline Sign sign(ShortInt a) { return a.value < 0 ? Sign::negative : a.value == 0 ? Sign::zero : Sign::positive; }

/// The lattice of a determinant: 2^60 steps, or 2^`bits`, to the binary order of its largest entry.
class Lattice {
 public:
  explicit Lattice(int bits = 60) : bits_(bits) {}
  /// False where the steps (or an entry) would leave the range of normal doubles.
  bool fit(double largest) {
    const int order = static_cast<int>(std::bit_cast<std::uint64_t>(largest) >> 52) - 1023;
    if (!(largest > 0x1p-900 && largest < 0x1p1000)) return false;
    step_ = power_of_two(order - bits_);
    inverse_ = power_of_two(bits_ - order);
    return true;
  }
  /// Steps in x; `exact` is cleared where x lies between steps.
  std::int64_t steps(double x, bool& exact) const {
    const auto n = static_cast<std::int64_t>(x * inverse_);
    exact &= static_cast<double>(n) * step_ == x;
    return n;
  }

 private:
  static double power_of_two(int e) { return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + e) << 52); }
  int bits_;
  double step_ = 1, inverse_ = 1;
};

}  // namespace pgdr::detail
