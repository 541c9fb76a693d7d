// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Boxes with scattered points and close pairs in them: inputs without small angles that need many Steiner points for their
// shape alone.
#pragma once

#include <cstdint>
#include <random>

#include "model_plcs.hpp"

namespace pgdr::test {

inline Plc<2> square() {
  Plc<2> plc;
  plc.points = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
  for (Index i = 0; i < 4; ++i) plc.segments.push_back({{i, (i + 1) % 4}, 1});
  return plc;
}

/// The unit square or cube with `pairs` pairs of points, `apart` from each other, drawn from `seed`.
template <int D>
Plc<D> box_with_pairs(int pairs, double apart, std::uint64_t seed) {
  Plc<D> plc;
  if constexpr (D == 2)
    plc = square();
  else
    plc = cube();
  std::mt19937_64 random(seed);
  auto draw = [&random] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (int i = 0; i < pairs; ++i) {
    Point<D> p;
    for (int k = 0; k < D; ++k) p[k] = 0.15 + 0.7 * draw();
    plc.points.push_back(p);
    p[static_cast<int>(random() % D)] += apart;
    plc.points.push_back(p);
  }
  return plc;
}

}  // namespace pgdr::test
