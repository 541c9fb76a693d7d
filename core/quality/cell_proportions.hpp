// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Cosines of angles and sizes of edges and faces, of several simplices side by side: what the quality of a mesh is made of.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "numbers/lanes.hpp"
#include "numbers/simplex_shapes.hpp"

namespace pgdr {

template <int D>
inline constexpr std::size_t angle_count = D == 2 ? 3 : 6;  ///< of a simplex

inline constexpr double cosine_error = 1e-9;  ///< what the cosines below are good to, generously

/// What the edges and faces of simplices side by side say of them.
template <int D>
struct alignas(32) ProportionsBlock {
  double cosine[angle_count<D>][shape_lanes];  ///< of all angles, in any order
  double surface[shape_lanes];                 ///< (D-1)! times the measure of all faces
  double largest_corner2[shape_lanes];         ///< the largest product of the D edges at a corner, squared
  double least_face[shape_lanes];              ///< of the squared measures of faces, over those that tell their normals well
};

namespace detail {

using Pair = Two;  // which any x86-64 has

template <std::size_t N>
using PairVector = std::array<Pair, N>;

template <std::size_t N>
inline Pair dot(const PairVector<N>& u, const PairVector<N>& v) {
  Pair sum = u[0] * v[0];
  for (std::size_t k = 1; k < N; ++k) sum += u[k] * v[k];
  return sum;
}

inline PairVector<3> cross(const PairVector<3>& u, const PairVector<3>& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

/// From corner j to corner i, of the lanes from `at` on.
template <int D>
PairVector<D> edge(const SimplexBlock<D>& in, std::size_t at, int i, int j) {
  PairVector<D> e;
  for (int k = 0; k < D; ++k) e[k] = load<Pair>(in.corner[i][k] + at) - load<Pair>(in.corner[j][k] + at);
  return e;
}

inline void set_proportions(const SimplexBlock<2>& in, std::size_t at, ProportionsBlock<2>& out) {
  const std::array<PairVector<2>, 3> edges{edge(in, at, 1, 0), edge(in, at, 2, 1), edge(in, at, 0, 2)};
  std::array<Pair, 3> length2;
  Pair surface{}, largest{};
  for (std::size_t i = 0; i < 3; ++i) {
    length2[i] = dot(edges[i], edges[i]);
    surface += root(length2[i]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const Pair corner2 = length2[i] * length2[j];
    store(out.cosine[i] + at, -dot(edges[i], edges[j]) / root(corner2));
    largest = larger(largest, corner2);
  }
  store(out.surface + at, surface);
  store(out.largest_corner2 + at, largest);
  store(out.least_face + at, Pair{} + 1);  // the cosines of needles are accurate
}

/// The cosines are those between the normals of the faces.
inline void set_proportions(const SimplexBlock<3>& in, std::size_t at, ProportionsBlock<3>& out) {
  const auto a = edge(in, at, 1, 0), b = edge(in, at, 2, 0), c = edge(in, at, 3, 0);
  const auto d = edge(in, at, 2, 1), e = edge(in, at, 3, 1), f = edge(in, at, 3, 2);
  const std::array<PairVector<3>, 4> normal{cross(d, e), cross(c, b), cross(a, c), cross(b, a)};
  const Pair a2 = dot(a, a), b2 = dot(b, b), c2 = dot(c, c), d2 = dot(d, d), e2 = dot(e, e), f2 = dot(f, f);
  store(out.largest_corner2 + at, larger(larger(a2 * b2 * c2, a2 * d2 * e2), larger(b2 * d2 * f2, c2 * e2 * f2)));
  Pair surface{}, least = Pair{} + std::numeric_limits<double>::infinity();
  std::array<Pair, 4> inverse;
  for (std::size_t i = 0; i < 4; ++i) {
    const Pair length2 = dot(normal[i], normal[i]), length = root(length2);
    surface += length;
    inverse[i] = 1 / length;
    least = smaller(least, length2);
  }
  store(out.surface + at, surface);
  // At most about 4 rounding errors of the product of two edges, which is less than this root.
  const Pair edges2 = a2 + b2 + c2 + d2 + e2;
  store(out.least_face + at, least / (1e-10 * edges2 * edges2));
  std::size_t n = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j, ++n) store(out.cosine[n] + at, -dot(normal[i], normal[j]) * inverse[i] * inverse[j]);
}

}  // namespace detail

/// Of one of the simplices.
template <int D>
struct Proportions {
  std::array<double, angle_count<D>> cosine;
  double surface, largest_corner2;
  bool moderate;  ///< whether products of edges are neither too large nor too small for a double
  bool good;      ///< false if the cosines may be less accurate than cosine_error

  Proportions(const ProportionsBlock<D>& block, std::size_t lane)
      : surface(block.surface[lane]), largest_corner2(block.largest_corner2[lane]) {
    moderate = largest_corner2 > 1e-280 && largest_corner2 < 1e280;
    good = moderate && block.least_face[lane] > 1;
    for (std::size_t i = 0; i < cosine.size(); ++i) {
      cosine[i] = block.cosine[i][lane];
      good = good && std::abs(cosine[i]) <= 1 + cosine_error;
    }
  }
};

template <int D>
void set_proportions(std::span<const SimplexBlock<D>> in, std::span<ProportionsBlock<D>> out) {
  for (std::size_t b = 0; b < in.size(); ++b)
    for (std::size_t at = 0; at < shape_lanes; at += sizeof(detail::Pair) / sizeof(double))
      detail::set_proportions(in[b], at, out[b]);
}

}  // namespace pgdr
