// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers of the corners, faces and edges of a simplex of D + 1 corners: face i is opposite corner i. Constants and pure
// functions.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace pgdr {

inline constexpr int edge_count(int dimension) { return dimension == 3 ? 6 : 3; }  ///< of a simplex
/// The two ends of edge e of a tetrahedron. The first three are not those of a triangle.
inline constexpr std::array<std::array<int, 2>, 6> edge_ends = {{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
/// The number of the edge between two corners of a tetrahedron.
inline constexpr int edge_of_ends[4][4] = {{-1, 0, 1, 2}, {0, -1, 3, 4}, {1, 3, -1, 5}, {2, 4, 5, -1}};

/// The corners of each face of a simplex, in an order that, with the opposite corner behind them, is an even permutation.
/// (-fvisibility=hidden overlooks templates of variables.)
template <int D>
[[gnu::visibility("hidden")]] inline constexpr auto face_corners = [] {
  std::array<std::array<std::uint8_t, D>, D + 1> table{};
  for (std::size_t face = 0; face <= D; ++face) {
    for (std::size_t corner = 0, n = 0; corner <= D; ++corner)
      if (corner != face) table[face][n++] = static_cast<std::uint8_t>(corner);
    if ((D - face) % 2 == 1) std::swap(table[face][0], table[face][1]);
  }
  return table;
}();

/// The two corners of a tetrahedron that are neither of these, the lower one first: the ends of the edge opposite that between
/// them.
constexpr std::array<int, 2> corners_without(int i, int j) {
  std::array<int, 2> others{};
  for (int k = 0, n = 0; k < 4; ++k)
    if (k != i && k != j) others[n++] = k;
  return others;
}
/// The number of the edge of a tetrahedron that has neither of these corners.
constexpr int edge_without(int i, int j) {
  const auto [a, b] = corners_without(i, j);
  return edge_of_ends[a][b];
}
/// Of what the corners have, that of the face opposite corner i, in the order of the corners' numbers.
template <class T, std::size_t N>
constexpr std::array<T, N - 1> face_without(const std::array<T, N>& corners, int i) {
  std::array<T, N - 1> face{};
  for (int k = 0; k + 1 < static_cast<int>(N); ++k) face[k] = corners[k < i ? k : k + 1];  // std::copy would call memmove
  return face;
}
/// The same of a tetrahedron, in an order that, with what corner i has behind it, is an even permutation.
template <class T>
constexpr std::array<T, 3> face_inwards(const std::array<T, 4>& corners, int i) {
  const auto& order = face_corners<3>[i];
  return {corners[order[0]], corners[order[1]], corners[order[2]]};
}
/// Of what the corners of a tetrahedron have, that of the two ends of edge e. (A triangle has it if both ends are its corners.)
template <class T, std::size_t N>
constexpr std::array<T, 2> ends_of_edge(const std::array<T, N>& corners, int e) {
  return {corners[edge_ends[e][0]], corners[edge_ends[e][1]]};
}
/// The number of the corner that has x; N if none does.
template <class T, std::size_t N>
constexpr int corner_of(const std::array<T, N>& corners, const T& x) {
  return static_cast<int>(std::find(corners.begin(), corners.end(), x) - corners.begin());
}
/// Does a corner have x?
template <class T, std::size_t N>
constexpr bool has_corner(const std::array<T, N>& corners, const T& x) {
  return corner_of(corners, x) < static_cast<int>(N);
}

}  // namespace pgdr
