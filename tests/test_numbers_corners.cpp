// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The numbers of corners, faces and edges agree with each other.
#include "numbers/corners.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

namespace pgdr::test_numbers_corners {

constexpr std::array<char, 4> letters = {'a', 'b', 'c', 'd'};

TEST(Corners, EdgesAndTheirEndsAgree) {
  std::set<std::set<int>> edges;
  for (int e = 0; e < edge_count(3); ++e) {
    const auto [i, j] = edge_ends[e];
    EXPECT_LT(i, j);
    EXPECT_EQ(edge_of_ends[i][j], e);
    EXPECT_EQ(edge_of_ends[j][i], e);
    EXPECT_EQ(ends_of_edge(letters, e), (std::array{letters[i], letters[j]}));
    edges.insert({i, j});
  }
  EXPECT_EQ(edges.size(), 6u);
}

TEST(Corners, TheOtherTwoAreTheRest) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      if (i == j) continue;
      const auto [k, l] = corners_without(i, j);
      EXPECT_LT(k, l);
      EXPECT_EQ((std::set{i, j, k, l}).size(), 4u);
      EXPECT_EQ(edge_without(i, j), edge_of_ends[k][l]);
    }
}

TEST(Corners, AFaceHasAllCornersButOne) {
  EXPECT_EQ(face_without(letters, 0), (std::array{'b', 'c', 'd'}));
  EXPECT_EQ(face_without(letters, 2), (std::array{'a', 'b', 'd'}));
  EXPECT_EQ(face_without(letters, 3), (std::array{'a', 'b', 'c'}));
  EXPECT_EQ(face_without(std::array{1, 2, 3}, 1), (std::array{1, 3}));
}

template <int D>
void expect_even_faces() {
  for (int face = 0; face <= D; ++face) {
    std::array<int, D + 1> order{};
    for (int n = 0; n < D; ++n) order[n] = face_corners<D>[face][n];
    order[D] = face;
    int inversions = 0;
    for (int i = 0; i <= D; ++i)
      for (int j = i + 1; j <= D; ++j) inversions += order[i] > order[j];
    EXPECT_EQ(inversions % 2, 0) << "face " << face;
    std::sort(order.begin(), order.end());
    for (int i = 0; i <= D; ++i) EXPECT_EQ(order[i], i);
  }
}

TEST(Corners, AFaceAndItsOppositeCornerAreAnEvenPermutation) {
  expect_even_faces<2>();
  expect_even_faces<3>();
}

TEST(Corners, ACornerIsFoundByWhatItHas) {
  for (int i = 0; i < 4; ++i) EXPECT_EQ(corner_of(letters, letters[i]), i);
  EXPECT_EQ(corner_of(letters, 'e'), 4);
  EXPECT_TRUE(has_corner(letters, 'd'));
  EXPECT_FALSE(has_corner(letters, 'e'));
}

}  // namespace pgdr::test_numbers_corners
