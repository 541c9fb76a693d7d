// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// In which order a finished mesh has the vertices of its cells, subfacets and subsegments. Pure functions, any thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "mesh/mesh.hpp"

namespace pgdr::detail {

/// Sorts the numbers, but for the last two if that is what the orientation asks for. Any order is as likely: it is done so that
/// compilers make no branches of it. @pre numbers are below 2^63
template <class Number, std::size_t N>
std::array<Number, N> canonical(std::array<Number, N> v) {
  Number odd = 0;  // all bits, after an odd number of exchanges
  for (std::size_t end = N; end > 1; --end)
    for (std::size_t i = 1; i < end; ++i) {
      const std::int64_t difference = static_cast<std::int64_t>(v[i]) - static_cast<std::int64_t>(v[i - 1]);
      const auto exchanged = static_cast<Number>(difference >> 63);
      const Number below = static_cast<Number>(difference) & exchanged;
      v[i - 1] += below;
      v[i] -= below;
      odd ^= exchanged;
    }
  const Number last_two = (v[N - 2] ^ v[N - 1]) & odd;
  v[N - 2] ^= last_two;
  v[N - 1] ^= last_two;
  return v;
}

/// The face opposite vertex f, counter-clockwise seen from outside the cell.
template <int D>
std::array<VertexId, D> face_vertices(const CellRecord<D>& cell, int f) {
  auto face = face_without(cell.vertices, f);
  if (f % 2 == 1) std::swap(face[D - 2], face[D - 1]);
  return face;
}

/// Of a subfacet (2D: subsegment) on the hull the vertices as they are, facing outwards, of any other sorted; in 3D the smallest
/// first.
template <class Number, std::size_t N>
std::array<Number, N> canonical_face(std::array<Number, N> v, bool on_hull) {
  if (!on_hull) std::sort(v.begin(), v.end());
  if (N == 3) std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());
  return v;
}

}  // namespace pgdr::detail
