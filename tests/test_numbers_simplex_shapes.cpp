// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Several simplices side by side against one by one: the same bits, and bounds that hold in rationals.
#include "numbers/simplex_shapes.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <vector>

#include "numbers/simplex_shapes_anywhere.hpp"
#include "oracles.hpp"
#include "pgdr/circumsphere.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::test_numbers_simplex_shapes {

using oracle::Random;
using oracle::Rational;

template <class Dimension>
class SimplexShapes : public testing::Test {};

template <int D>
using Dim = std::integral_constant<int, D>;
using Dimensions = testing::Types<Dim<2>, Dim<3>>;
TYPED_TEST_SUITE(SimplexShapes, Dimensions);

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

// Grids have many ties in the order of corners and flat simplices; needles and extreme sizes leave the safe range.
template <int D>
Simplex<D> random_simplex(Random& random) {
  Simplex<D> s;
  const int kind = oracle::below(random, 5);
  const double scale = kind == 3 ? std::ldexp(1.0, oracle::below(random, 300) - 150) : 1.0;
  do {
    for (Point<D>& p : s)
      for (double& x : p.x) {
        x = 2 * oracle::uniform(random) - 1;
        if (kind == 1) x = std::floor(4 * x);
        if (kind == 2) x = 1 + std::ldexp(x, -30);
        x *= scale;
      }
    if (kind == 4) s[D][D - 1] = s[0][D - 1] + std::ldexp(1.0, -oracle::below(random, 60));
  } while ([&] {
    for (int i = 0; i <= D; ++i)
      for (int j = 0; j < i; ++j)
        if (s[i] == s[j]) return true;
    return false;
  }());
  return s;
}

template <int D>
void expect_shapes_of_each(void (*shapes)(std::span<const SimplexBlock<D>>, std::span<ShapeBlock<D>>)) {
  Random random(20261121);
  constexpr std::size_t count = 4000;
  std::vector<SimplexBlock<D>> in(count / shape_lanes);
  std::vector<ShapeBlock<D>> out(in.size());
  std::vector<Simplex<D>> simplices;
  for (std::size_t i = 0; i < count; ++i) {
    simplices.push_back(random_simplex<D>(random));
    for (int k = 0; k <= D; ++k) in[i / shape_lanes].set(i % shape_lanes, k, simplices[i][k]);
  }
  shapes(in, out);
  std::size_t spheres = 0, oriented = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Simplex<D>& s = simplices[i];
    const ShapeBlock<D>& block = out[i / shape_lanes];
    const std::size_t lane = i % shape_lanes;
    EXPECT_EQ(bits(block.shortest_edge_squared[lane]), bits(shortest_edge_squared<D>(s)));
    if (std::isfinite(block.det_error[lane])) {
      const Rational off = abs(Rational(Rational(block.det[lane]) - oracle::orient_det<D>(s)));
      EXPECT_LE(off, Rational(block.det_error[lane]));
      const bool certain = std::fabs(block.det[lane]) > block.det_error[lane];
      oriented += certain;
      if (certain) {
        EXPECT_EQ(orient<D>(s), sign_of(block.det[lane]));
      }
    }
    if (!std::isfinite(block.center_error[lane])) continue;
    ++spheres;
    const Circumsphere<D> one = circumsphere<D>(s);
    for (int k = 0; k < D; ++k) EXPECT_EQ(bits(block.center[k][lane]), bits(one.center[k]));
    EXPECT_EQ(bits(block.squared_radius[lane]), bits(one.squared_radius));
    EXPECT_EQ(bits(block.center_error[lane]), bits(one.center_error));
    EXPECT_EQ(bits(block.power_error[lane]), bits(6 * one.center_error / std::sqrt(one.squared_radius)));
  }
  EXPECT_GT(spheres, count / 3);
  EXPECT_GT(oriented, count / 3);
}

TYPED_TEST(SimplexShapes, AreThoseOfEachOne) {
  constexpr int D = TypeParam::value;
  expect_shapes_of_each<D>(simplex_shapes<D>);
}

TYPED_TEST(SimplexShapes, AreThoseOfEachOneOnAnyProcessor) {
  constexpr int D = TypeParam::value;
  expect_shapes_of_each<D>(detail::simplex_shapes_anywhere<D>);
}

}  // namespace pgdr::test_numbers_simplex_shapes
