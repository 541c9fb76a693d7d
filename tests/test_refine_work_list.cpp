// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The order in which a region's poor elements are treated.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "refine/work_list.hpp"

namespace pgdr::test_refine_work_list {

using Item = Entry<3>;

Item poor(int bucket, int why, std::uint32_t order = 0, std::uint32_t id = 0) {
  return {CellId{id}, 0, EntryKind::cell, why, bucket, order};
}

/// With slots, which what is fetched ahead has.
class Slots : public Mesh<3> {
 public:
  Slots() {
    auto pools = make_pools();
    for (int i = 0; i < 20000; ++i) new_cell(pools);
  }
};
const Slots mesh;

Item big(int bucket, std::uint32_t id = 0) { return poor(bucket, Item::over_size, 0, id); }
Item skinny(int bucket, std::uint32_t order) { return poor(bucket, Item::over_radius_edge, order); }

TEST(WorkList, TooBigOnesGoFirstLargestFirst) {
  WorkList<3> list;
  for (const Item& e : {skinny(2, 5), big(7, 1), big(4, 2), skinny(1, 9), big(7, 3), poor(5, Item::not_delaunay, 0, 4)})
    list.push(e);
  EXPECT_EQ(list.poor(), 6u);
  EXPECT_EQ(list.first_bucket(), 1);
  std::vector<std::uint32_t> ids;
  for (int i = 0; i < 4; ++i) ids.push_back(index(list.pop_poor(mesh).cell));
  EXPECT_EQ(ids, (std::vector<std::uint32_t>{2, 4, 1, 3}));
  EXPECT_EQ(list.pop_poor(mesh).order, 5u);  // then by shape, whatever the bucket
  EXPECT_EQ(list.first_bucket(), 1);
  EXPECT_EQ(list.pop_poor(mesh).order, 9u);
  EXPECT_TRUE(list.empty());
}

// Large before small, in a bucket subsegments before subfacets, each first in first out.
TEST(WorkList, EntitiesGoBySize) {
  WorkList<3> list;
  const auto push = [&](std::uint32_t id, EntryKind kind, int bucket) { list.push({CellId{id}, 0, kind, 0, bucket}); };
  push(1, EntryKind::face, 3);
  push(2, EntryKind::edge, 5);
  push(3, EntryKind::edge, 3);
  push(4, EntryKind::face, 0);
  push(5, EntryKind::face, 3);
  push(6, EntryKind::edge, 3);
  push(7, EntryKind::edge, 63);
  for (const std::uint32_t id : {4u, 3u, 6u, 1u, 5u, 2u, 7u}) EXPECT_EQ(index(list.entities.pop().cell), id);
  EXPECT_TRUE(list.empty());
}

// Every entry is passed once, may be changed, and stays in its place.
TEST(WorkList, EntriesMayBeChangedWhereTheyWait) {
  WorkList<3> list;
  constexpr std::uint32_t many = 700;  // several blocks
  for (std::uint32_t i = 0; i < many; ++i) list.push({CellId{i}, 0, EntryKind::flip, 0});
  for (std::uint32_t i = 0; i < 300; ++i) list.flips.pop();
  for (const Item& e : {skinny(2, 9), big(3, 1), skinny(4, 1), Item{CellId{5}, 0, EntryKind::edge, 1}}) list.push(e);
  std::size_t passed = 0;
  list.for_each([&](Item& e) {
    e.cell = CellId{index(e.cell) + 1000};
    ++passed;
  });
  EXPECT_EQ(passed, list.size());
  EXPECT_EQ(index(list.entities.pop().cell), 1005u);
  for (std::uint32_t i = 300; i < many; ++i) ASSERT_EQ(index(list.flips.pop().cell), 1000 + i);
  EXPECT_EQ(index(list.pop_poor(mesh).cell), 1001u);
  EXPECT_EQ(list.pop_poor(mesh).order, 1u);
  EXPECT_EQ(list.pop_poor(mesh).order, 9u);
  WorkList<3>().for_each([](Item&) { FAIL() << "there is none"; });
}

TEST(WorkList, LargestFirstWhereARegionIsToBeSplit) {
  WorkList<3> list;
  for (const Item& e : {skinny(4, 1), big(3), skinny(2, 9), skinny(2, 6), big(4)}) list.push(e);
  std::vector<int> buckets;
  std::vector<std::uint32_t> orders;
  while (list.poor() > 0) {
    const Item e = list.pop_largest(mesh);
    buckets.push_back(e.bucket);
    orders.push_back(e.order);
  }
  EXPECT_EQ(buckets, (std::vector<int>{2, 2, 3, 4, 4}));
  EXPECT_EQ(orders, (std::vector<std::uint32_t>{6, 9, 0, 0, 1}));
}

// Against a plain sorted list, with pushes and both pops mixed.
TEST(WorkList, AgreesWithASortedList) {
  std::mt19937 random(3);
  WorkList<3> list;
  std::vector<Item> all;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    if (all.empty() || random() % 5 < 3) {
      const int bucket = static_cast<int>(random() % 12);
      const Item e = random() % 2 ? big(bucket, i) : skinny(bucket, random() % 100000);
      list.push(e);
      all.push_back(e);
      continue;
    }
    const bool largest = random() % 2;
    auto before = [largest](const Item& a, const Item& b) {
      const bool a_big = a.which() == Item::over_size, b_big = b.which() == Item::over_size;
      if (largest && a.bucket != b.bucket) return a.bucket < b.bucket;
      if (a_big != b_big) return a_big;
      if (a_big) return a.bucket != b.bucket ? a.bucket < b.bucket : index(a.cell) < index(b.cell);
      return a.order < b.order;
    };
    ASSERT_EQ(list.poor(), all.size());
    const auto expected = std::min_element(all.begin(), all.end(), before);
    const Item e = largest ? list.pop_largest(mesh) : list.pop_poor(mesh);
    ASSERT_EQ(e.which(), expected->which());
    ASSERT_EQ(e.order, expected->order);
    ASSERT_TRUE(e.which() != Item::over_size || e.cell == expected->cell);
    ASSERT_FALSE(before(*expected, e) || before(e, *expected));
    const auto same = std::find_if(all.begin(), all.end(), [&](const Item& x) {
      return x.which() == e.which() && x.order == e.order && x.bucket == e.bucket && x.cell == e.cell;
    });
    ASSERT_NE(same, all.end());
    all.erase(same);
  }
  std::size_t drained = 0;
  list.drain([&](const Item&) { ++drained; });
  EXPECT_EQ(drained, all.size());
  EXPECT_TRUE(list.empty());
}

/// By those that are too big, not by those of poor shape, whose order says something else.
TEST(WorkList, IsCrowdedByCellsToComeOrByThoseThatWait) {
  WorkList<3> list;
  for (std::uint32_t i = 0; i < 4; ++i) list.push(poor(3, Item::over_size, 7, i));
  list.push(skinny(3, 1000));
  EXPECT_EQ(list.to_come(), 28u);
  EXPECT_TRUE(list.is_crowded(5));
  EXPECT_TRUE(list.is_crowded(9));
  EXPECT_FALSE(list.is_crowded(10));
  list.pop_poor(mesh);
  list.pop_largest(mesh);
  EXPECT_EQ(list.to_come(), 14u);
  EXPECT_FALSE(list.is_crowded(5));
  list.drain([](const Item&) {});
  EXPECT_EQ(list.to_come(), 0u);
}

// Millions may wait: who drains a list, and has to stop, leaves the rest as it is.
TEST(WorkList, DrainingThatIsEndedEarlyLeavesTheRest) {
  constexpr std::uint32_t each = 5000;
  for (int looks = 0; looks < 30; ++looks) {
    WorkList<3> list;
    for (std::uint32_t i = 0; i < each; ++i) {
      list.push({CellId{i}, 0, EntryKind::face, 1});
      list.push(poor(i % 3, Item::over_size, 2, i));
      list.push(skinny(4, each - i));
    }
    std::size_t drained = 0, to_come = 2 * each;
    int asked = 0;
    const bool done = list.drain(
        [&](const Item& e) {
          ++drained;
          if (e.kind() == EntryKind::cell && e.which() == Item::over_size) to_come -= 2;
        },
        [](const Item&) {}, [&] { return asked++ == looks; });
    EXPECT_EQ(done, drained == 3 * each);
    EXPECT_LE(drained, static_cast<std::size_t>(looks) * 1024);
    EXPECT_EQ(list.size(), 3 * each - drained);
    EXPECT_EQ(list.to_come(), to_come);
    std::uint32_t last = 0;
    while (list.poor() > 0) {  // still in order
      const Item e = list.pop_poor(mesh);
      if (e.which() == Item::over_size) continue;
      EXPECT_LT(last, e.order);
      last = e.order;
    }
    EXPECT_EQ(list.size(), list.entities.size());
  }
}

// A slot is given up before its births repeat: no entry of a dead cell is taken for one of the cells after it.
TEST(Entry, ASlotAndItsBirthNameACellForGood) {
  class Cells : public Mesh<3> {
   public:
    Pools pools = make_pools();
  } cells;
  std::set<std::pair<CellId, std::uint16_t>> names;
  std::optional<Item> last;
  const std::array<VertexId, 4> vertices{VertexId{3}, VertexId{1}, VertexId{2}, VertexId{0}};
  for (int i = 0; i < 150000; ++i) {
    const CellId c = cells.new_cell(cells.pools);
    cells.set_vertices(c, vertices);
    const Item entry(c, cells.birth(c), EntryKind::cell, Item::over_size);
    ASSERT_TRUE(names.insert({entry.cell, entry.birth}).second) << i;
    ASSERT_TRUE(entry.alive(cells));
    ASSERT_FALSE(last && last->alive(cells));
    std::array<VertexId, 4> read{};
    ASSERT_TRUE(cells.read_vertices(c, entry.birth, read));
    ASSERT_EQ(read, vertices);
    cells.free_cell(cells.pools, c);
    ASSERT_FALSE(entry.alive(cells));
    ASSERT_FALSE(cells.read_vertices(c, entry.birth, read));
    last = entry;
  }
  EXPECT_EQ(std::prev(names.end())->first, CellId{2});  // two slots were given up, after 65 535 cells each
}

}  // namespace pgdr::test_refine_work_list
