// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Bulk loops as pieces, last piece first, beside the same on the calling thread.
#include "space/bulk.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <utility>
#include <vector>

#include "space/box_tree.hpp"
#include "space/sort_by_points.hpp"

namespace pgdr::test_space_bulk {

using namespace detail;

/// The last piece first. Counts how often pieces were run, and the largest number of them.
class Backwards final : public Pieces {
 public:
  void run(std::size_t count, const std::function<void(std::size_t)>& piece) const override {
    ++calls;
    most = std::max(most, count);
    for (std::size_t i = count; i-- > 0;) piece(i);
  }
  bool is_parallel() const override { return false; }
  mutable std::size_t calls = 0, most = 0;
};

TEST(Bulk, SortsInPieces) {
  std::mt19937_64 random(1);
  for (const std::size_t count : {0, 1, 8192, 8193, 16384, 20000, 100001}) {
    for (const std::uint32_t different : {1u, 50u, 1u << 30}) {
      std::vector<std::pair<std::uint32_t, std::uint32_t>> items(count);
      for (std::uint32_t i = 0; i < count; ++i) items[i] = {static_cast<std::uint32_t>(random()) % different, i};
      std::shuffle(items.begin(), items.end(), random);
      auto expected = items;
      std::sort(expected.begin(), expected.end());
      const Backwards pieces;
      Bulk(pieces).sort(items, std::less<>());
      EXPECT_EQ(items, expected) << count << ' ' << different;
      EXPECT_EQ(pieces.calls > 0, count > 8192) << count;
    }
  }
}

// Also where all items of one half are before those of the other, so that a merge is cut off its middle.
TEST(Bulk, ShareTheLastMerges) {
  std::vector<std::uint32_t> items(1 << 17);
  for (std::uint32_t i = 0; i < items.size(); ++i) items[i] = i ^ 0x1ffffu;
  const Backwards pieces;
  Bulk(pieces).sort(items, std::less<>());
  EXPECT_TRUE(std::is_sorted(items.begin(), items.end()));
  EXPECT_EQ(pieces.calls, 5u);  // blocks, and four times as many merges
  EXPECT_EQ(pieces.most, 16u);
}

TEST(Bulk, GathersInOrder) {
  const Backwards pieces;
  const auto odd = [](std::size_t i, std::vector<std::size_t>& out) {
    if (i % 3 == 1) out.push_back(i);
  };
  EXPECT_EQ(Bulk(pieces).gather<std::size_t>(50000, odd), Bulk(false).gather<std::size_t>(50000, odd));
  const auto is_wanted = [](std::size_t i) { return i % 3 == 1; };
  const auto make = [](std::size_t i) { return i; };
  EXPECT_EQ(Bulk(pieces).collect<std::size_t>(50000, is_wanted, make), Bulk(false).gather<std::size_t>(50000, odd));
}

// Loops that know nothing of them run as the pieces of the scope that is around; but those of a piece do not.
TEST(Bulk, RunsAsPiecesHere) {
  const Backwards outer, inner;
  std::vector<char> done(30000);
  const auto run = [&done] { Bulk(true).each(done.size(), [&done](std::size_t i) { ++done[i]; }); };
  {
    const PiecesHere here(outer);
    EXPECT_TRUE(Bulk(true).is_parallel());
    EXPECT_FALSE(Bulk(false).is_parallel());
    run();
    EXPECT_EQ(outer.calls, 1u);
    {
      const PiecesHere nested(inner);
      run();
    }
    EXPECT_EQ(inner.calls, 1u);
    Bulk(true).parts(2, [&](std::size_t) { run(); });
    EXPECT_EQ(outer.calls, 2u);
  }
  run();
  EXPECT_EQ(outer.calls, 2u);
  EXPECT_EQ(inner.calls, 1u);
  EXPECT_EQ(done, std::vector<char>(30000, 5));
}

TEST(Bulk, SortsByPoints) {
  std::mt19937 random(2);
  constexpr std::uint32_t points = 5000, items = 40000;
  std::vector<std::array<std::uint32_t, 2>> ends(items);
  for (auto& e : ends) e = {static_cast<std::uint32_t>(random()) % points, static_cast<std::uint32_t>(random()) % points};
  const auto points_of = [&](std::uint32_t k) { return ends[k]; };
  std::vector<std::uint32_t> begin, at, expected_begin, expected_at;
  sort_by_points(points, items, points_of, expected_begin, expected_at);
  const Backwards pieces;
  sort_by_points(points, items, points_of, Bulk(pieces), begin, at);
  EXPECT_EQ(begin, expected_begin);
  EXPECT_EQ(at, expected_at);
}

// The same pairs in the same order.
TEST(Bulk, MakesTheSameTree) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> at(0, 1);
  std::vector<Point3> points(30000);
  for (Point3& p : points)
    for (double& x : p.x) x = at(random);
  std::vector<std::array<std::uint32_t, 3>> corners;
  for (std::uint32_t i = 0; i + 2 < points.size(); ++i) {
    for (int k = 0; k < 3; ++k) points[i + 1][k] = points[i][k] + 0.02 * (at(random) - 0.5);
    corners.push_back({i, i + 1, i + 2});
  }
  using Found = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
  const auto pairs_of = [](const BoxTree<3>& tree) {
    Found found;
    tree.self_pairs([&](std::uint32_t i, std::uint32_t j) { found.emplace_back(i, j); });
    return found;
  };
  const Backwards pieces;
  const Found expected = pairs_of(BoxTree<3>(corners, points, 0.001));
  EXPECT_GT(expected.size(), corners.size());
  EXPECT_EQ(pairs_of(BoxTree<3>(corners, points, 0.001, Bulk(pieces))), expected);
  EXPECT_GT(pieces.most, 1u);
}

}  // namespace pgdr::test_space_bulk
