// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "refine/element_stage.hpp"

#include <algorithm>
#include <bit>

#include "rule/cell_quality.hpp"

namespace pgdr {
namespace {

/// A hash of the signs and mantissas of the coordinates, the same in whatever order the vertices come.
template <int D>
std::uint64_t hash_of_shape(const Simplex<D>& s) {
  constexpr std::uint64_t exponent = std::uint64_t{0x7ff} << 52;
  std::uint64_t sum = 0;
  for (const Point<D>& p : s) {
    std::uint64_t hash = 0;
    for (int k = 0; k < D; ++k)
      hash = (std::rotl(hash, 21) ^ (std::bit_cast<std::uint64_t>(p[k]) & ~exponent)) * 0x9e3779b97f4a7c15u;
    sum += hash ^ hash >> 32;
  }
  return sum * 0xbf58476d1ce4e5b9u;
}

}  // namespace

template <int D>
std::uint32_t order_by_level(const Mesh<D>& mesh, CellId c, int level) {
  static_assert(CellQuality::lowest_level > -0x8000);
  const auto place = static_cast<std::uint32_t>(std::clamp(level, CellQuality::lowest_level, 0) - CellQuality::lowest_level);
  return place << 16 | static_cast<std::uint32_t>(hash_of_shape<D>(mesh.simplex(c)) >> 48);
}

template std::uint32_t order_by_level<2>(const Mesh<2>&, CellId, int);
template std::uint32_t order_by_level<3>(const Mesh<3>&, CellId, int);

}  // namespace pgdr
