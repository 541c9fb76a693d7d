// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "space/spatial_order.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "space/box.hpp"

namespace pgdr {
namespace {

template <int D>
inline constexpr int bits_per_axis = D == 2 ? 31 : 21;

// Hilbert index of integer coordinates, by the transposed Gray code of Skilling (2004, "Programming the Hilbert curve"), level
// by level from the top: what the levels above have done to the lower bits (complemented those of one coordinate, exchanged
// those of two), and the parity of the Gray code so far, is a state.

/// In space: which coordinate stands in each of the three places, which of these are complemented, and the parity.
struct SpaceState {
  std::array<std::uint8_t, 3> place{0, 1, 2};
  std::array<bool, 3> flipped{};
  bool parity = false;

  constexpr bool operator==(const SpaceState&) const = default;
  /// Three digits of the key; x, y and z are bits 2, 1 and 0 of `bits`.
  constexpr unsigned step(unsigned bits) {
    std::array<bool, 3> b{}, gray{};
    for (std::size_t i = 0; i < 3; ++i) b[i] = ((bits >> (2 - place[i]) & 1) != 0) != flipped[i];
    for (std::size_t i = 0; i < 3; ++i) gray[i] = i == 0 ? b[0] : b[i] != gray[i - 1];
    for (std::size_t i = 0; i < 3; ++i) {
      if (b[i]) {
        flipped[0] = !flipped[0];
      } else {
        std::swap(place[0], place[i]);
        std::swap(flipped[0], flipped[i]);
      }
    }
    unsigned digits = 0;
    for (const bool g : gray) digits = digits << 1 | (g != parity ? 1u : 0u);
    parity = parity != gray[2];
    return digits;
  }
};

struct SpaceStep {
  std::uint8_t state, digits;
};
constexpr std::size_t most_space_states = 96;

/// By state, as they are reached from the first, and bits of one level.
constexpr auto space_steps = [] {
  std::array<std::array<SpaceStep, 8>, most_space_states> table{};
  std::array<SpaceState, most_space_states> states{};
  std::size_t known = 1;
  for (std::size_t s = 0; s < known; ++s)
    for (unsigned bits = 0; bits < 8; ++bits) {
      SpaceState next = states[s];
      const unsigned digits = next.step(bits);
      std::size_t n = 0;
      while (n < known && !(states[n] == next)) ++n;
      if (n == known) states[known++] = next;
      table[s][bits] = {static_cast<std::uint8_t>(n), static_cast<std::uint8_t>(digits)};
    }
  return table;
}();

/// Two levels at once: by state, two bits each of x, y and z.
constexpr auto double_space_steps = [] {
  std::array<std::array<SpaceStep, 64>, most_space_states> table{};
  for (std::size_t s = 0; s < most_space_states; ++s)
    for (unsigned xyz = 0; xyz < 64; ++xyz) {
      const auto bits = [xyz](int level) {
        return (xyz >> (4 + level) & 1) << 2 | (xyz >> (2 + level) & 1) << 1 | (xyz >> level & 1);
      };
      const SpaceStep upper = space_steps[s][bits(1)], lower = space_steps[upper.state][bits(0)];
      table[s][xyz] = {lower.state, static_cast<std::uint8_t>(upper.digits << 3 | lower.digits)};
    }
  return table;
}();

std::uint64_t hilbert_index(std::array<std::uint32_t, 3> x) {
  int b = bits_per_axis<3> - 1;
  static_assert(bits_per_axis<3> % 2 == 1, "the topmost level goes alone");
  const SpaceStep top = space_steps[0][(x[0] >> b & 1) << 2 | (x[1] >> b & 1) << 1 | (x[2] >> b & 1)];
  std::uint64_t key = top.digits;
  std::uint8_t state = top.state;
  for (b -= 2; b >= 0; b -= 2) {
    const SpaceStep step = double_space_steps[state][(x[0] >> b & 3) << 4 | (x[1] >> b & 3) << 2 | (x[2] >> b & 3)];
    key = key << 6 | step.digits;
    state = step.state;
  }
  return key;
}

/// In the plane a state is four bits: the one complemented, the other, exchanged, the parity.
struct HilbertStep {
  std::uint8_t state, digits;
};
constexpr HilbertStep hilbert_step(unsigned state, unsigned x, unsigned y) {
  unsigned flip0 = state & 1, flip1 = state >> 1 & 1, swapped = state >> 2 & 1, parity = state >> 3;
  const unsigned b0 = (swapped ? y : x) ^ flip0, b1 = (swapped ? x : y) ^ flip1, gray = b0 ^ b1;
  const unsigned digits = (b0 ^ parity) << 1 | (gray ^ parity);
  flip0 ^= b0;
  if (b1) {
    flip0 ^= 1;
  } else {
    swapped ^= 1;
    std::swap(flip0, flip1);
  }
  parity ^= gray;
  return {static_cast<std::uint8_t>(flip0 | flip1 << 1 | swapped << 2 | parity << 3), static_cast<std::uint8_t>(digits)};
}

/// Four levels at once: by state, four bits of x, four of y.
constexpr auto hilbert_steps = [] {
  std::array<std::array<HilbertStep, 256>, 16> table{};
  for (unsigned state = 0; state < 16; ++state)
    for (unsigned xy = 0; xy < 256; ++xy) {
      HilbertStep all{static_cast<std::uint8_t>(state), 0};
      for (int b = 3; b >= 0; --b) {
        const HilbertStep one = hilbert_step(all.state, xy >> (4 + b) & 1, xy >> b & 1);
        all = {one.state, static_cast<std::uint8_t>(all.digits << 2 | one.digits)};
      }
      table[state][xy] = all;
    }
  return table;
}();

std::uint64_t hilbert_index(std::array<std::uint32_t, 2> x) {
  std::uint64_t key = 0;
  unsigned state = 0;
  int b = bits_per_axis<2>;
  while (b % 4 != 0) {
    --b;
    const HilbertStep step = hilbert_step(state, x[0] >> b & 1, x[1] >> b & 1);
    key = key << 2 | step.digits;
    state = step.state;
  }
  while (b > 0) {
    b -= 4;
    const HilbertStep step = hilbert_steps[state][(x[0] >> b & 15) << 4 | (x[1] >> b & 15)];
    key = key << 8 | step.digits;
    state = step.state;
  }
  return key;
}

/// @param unit  a power of two
template <int D>
std::uint64_t coordinate_hash(const Point<D>& p, double unit) {
  std::uint64_t h = 0x9e3779b97f4a7c15u;
  for (int i = 0; i < D; ++i) {
    h ^= std::bit_cast<std::uint64_t>(p[i] * unit + 0.0);
    h *= 0xbf58476d1ce4e5b9u;
    h ^= h >> 29;
  }
  h *= 0x94d049bb133111ebu;
  return h ^ h >> 32;
}

}  // namespace

template <int D>
HilbertCurve<D>::HilbertCurve(std::span<const Point<D>> points) {
  if (points.empty()) return;
  const detail::Box<D> box = detail::Box<D>::of(points);
  const double side = box.longest_side();
  corner_ = box.low;
  if (!(side > 0) || !std::isfinite(side)) return;
  scale_ = std::ldexp(1.0, bits_per_axis<D> - 1 - std::ilogb(side));
  unit_ = std::ldexp(1.0, -std::ilogb(side));
}

template <int D>
std::uint64_t HilbertCurve<D>::key(const Point<D>& p) const {
  constexpr double most = static_cast<double>((1u << bits_per_axis<D>)-1);
  std::array<std::uint32_t, D> x;
  for (int i = 0; i < D; ++i) x[i] = static_cast<std::uint32_t>(std::clamp((p[i] - corner_[i]) * scale_, 0.0, most));
  return hilbert_index(x);
}

template <int D>
CurveOrder curve_order(std::span<const Point<D>> points, const detail::Bulk& bulk) {
  struct Entry {
    std::uint64_t key;
    std::uint32_t index;
    std::uint8_t round;
  };
  const HilbertCurve<D> curve(points);
  const double unit = curve.unit();  // the rounds of points that are scaled by a power of two are those of the points
  CurveOrder order;
  order.round_count = std::max(1, static_cast<int>(std::bit_width(points.size() / 64)));
  std::vector<Entry> entries(points.size());
  bulk.each(points.size(), [&](std::size_t i) {
    const int back = std::min(std::countr_zero(coordinate_hash(points[i], unit) | 1ull << 63), order.round_count - 1);
    entries[i] = {curve.key(points[i]), static_cast<std::uint32_t>(i), static_cast<std::uint8_t>(order.round_count - 1 - back)};
  });
  bulk.sort(entries, [&](const Entry& a, const Entry& b) {
    return a.key != b.key ? a.key < b.key : lex_less(points[a.index], points[b.index]);
  });
  order.points.resize(points.size());
  order.rounds.resize(points.size());
  bulk.each(points.size(), [&](std::size_t i) {
    order.points[i] = entries[i].index;
    order.rounds[i] = entries[i].round;
  });
  return order;
}

template <int D>
std::vector<std::uint32_t> insertion_order(std::span<const Point<D>> points) {
  const CurveOrder along = curve_order(points, detail::Bulk(false));
  std::vector<std::uint32_t> order;
  order.reserve(points.size());
  for (int round = 0; round < along.round_count; ++round)
    for (std::size_t i = 0; i < points.size(); ++i)
      if (along.rounds[i] == round) order.push_back(along.points[i]);
  return order;
}

template class HilbertCurve<2>;
template class HilbertCurve<3>;
template CurveOrder curve_order<2>(std::span<const Point<2>>, const detail::Bulk&);
template CurveOrder curve_order<3>(std::span<const Point<3>>, const detail::Bulk&);
template std::vector<std::uint32_t> insertion_order<2>(std::span<const Point<2>>);
template std::vector<std::uint32_t> insertion_order<3>(std::span<const Point<3>>);

}  // namespace pgdr
