// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "optimize/order_by_level.hpp"

#include <algorithm>
#include <bit>

#include "optimize/cell_quality.hpp"

namespace pgdr {
namespace {

/// A hash of the signs and mantissas of the coordinates, the same in whatever order the vertices come.
std::uint64_t hash_of_shape(const Simplex<3>& s) {
  constexpr std::uint64_t exponent = std::uint64_t{0x7ff} << 52;
  std::uint64_t sum = 0;
  for (const Point3& p : s) {
    std::uint64_t hash = 0;
    for (int k = 0; k < 3; ++k)
      hash = (std::rotl(hash, 21) ^ (std::bit_cast<std::uint64_t>(p[k]) & ~exponent)) * 0x9e3779b97f4a7c15u;
    sum += hash ^ hash >> 32;
  }
  return sum * 0xbf58476d1ce4e5b9u;
}

}  // namespace

std::uint32_t order_by_level(const Mesh<3>& mesh, CellId c, int level) {
  static_assert(CellQuality::lowest_level > -0x8000);
  const auto place = static_cast<std::uint32_t>(std::clamp(level, CellQuality::lowest_level, 0) - CellQuality::lowest_level);
  return place << 16 | static_cast<std::uint32_t>(hash_of_shape(mesh.simplex(c)) >> 48);
}

}  // namespace pgdr
