// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "mesh/reserved_memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "mesh/mesh.hpp"

namespace pgdr::test_mesh_reserved_memory {

constexpr std::size_t mib = std::size_t{1} << 20;

TEST(ReservedMemory, IsZeroAndKeepsWhatWasWrittenAsItGrows) {
  ReservedMemory memory(64 * mib);
  auto* const bytes = static_cast<unsigned char*>(memory.base());
  memory.grow_to(100);
  EXPECT_EQ(std::count(bytes, bytes + 100, 0), 100);
  std::memset(bytes, 7, 100);
  memory.grow_to(40 * mib);
  EXPECT_EQ(memory.base(), bytes);
  EXPECT_EQ(std::count(bytes, bytes + 100, 7), 100);
  EXPECT_EQ(std::count(bytes + 100, bytes + 40 * mib, 0), static_cast<std::ptrdiff_t>(40 * mib - 100));
}

/// Whole huge pages (2 MiB) go, and nothing beyond the range.
TEST(ReservedMemory, DiscardsWithinTheRangeAlone) {
  ReservedMemory memory(64 * mib);
  auto* const bytes = static_cast<unsigned char*>(memory.base());
  memory.grow_to(20 * mib);
  std::memset(bytes, 1, 20 * mib);
  memory.discard(3 * mib, 15 * mib);
  auto all_are = [&](std::size_t first, std::size_t last, unsigned char value) {
    return std::all_of(bytes + first * mib, bytes + last * mib, [=](unsigned char b) { return b == value; });
  };
  EXPECT_TRUE(all_are(0, 4, 1));
  EXPECT_TRUE(all_are(4, 14, 0));
  EXPECT_TRUE(all_are(14, 20, 1));
  memory.discard(15 * mib, 15 * mib + 100);
  memory.discard(18 * mib, 17 * mib);
  EXPECT_TRUE(all_are(14, 20, 1));
}

/// Each piece once, from the first huge page on of which nothing may have been used; zero and usable.
TEST(ReservedMemory, FreshPagesComeOnce) {
  ReservedMemory memory(64 * mib);
  auto* const bytes = static_cast<std::byte*>(memory.base());
  memory.grow_to(5 * mib);
  std::memset(bytes, 7, 5 * mib);
  std::vector<std::size_t> begins;
  const auto touch = [&](std::size_t first, std::size_t last) {
    for (const auto page : memory.fresh_pages(first, last)) {
      EXPECT_EQ(page.size(), 2 * mib);
      EXPECT_TRUE(std::all_of(page.begin(), page.end(), [](std::byte b) { return b == std::byte{0}; }));
      begins.push_back(static_cast<std::size_t>(page.data() - bytes) / mib);
      touch_pages(page);
    }
  };
  touch(5 * mib, 11 * mib);
  EXPECT_EQ(begins, (std::vector<std::size_t>{6, 8}));
  touch(5 * mib, 11 * mib);
  touch(6 * mib, 13 * mib);
  EXPECT_EQ(begins, (std::vector<std::size_t>{6, 8, 10}));
  touch(20 * mib, 1000 * mib);
  EXPECT_EQ(begins.back(), 62u);
  EXPECT_EQ(begins.size(), 3u + 22u);
  EXPECT_TRUE(std::all_of(bytes, bytes + 5 * mib, [](std::byte b) { return b == std::byte{7}; }));
}

struct alignas(64) Line {
  std::uint32_t number;
};

TEST(ReservedArray, LeavesTheHeapWithWhatItHas) {
  ReservedArray<Line> array;
  array.begin_small(100);
  for (std::uint32_t i = 0; i < 100; ++i) {
    EXPECT_EQ(array[i].number, 0u);
    array[i].number = i;
  }
  array.grow_to(100);
  array.discard(0, 100);
  array.reserve(1 << 20);
  const Line* const base = &array[0];
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(base) % alignof(Line), 0u);
  array.grow_to(100000);
  EXPECT_EQ(&array[0], base);
  for (std::uint32_t i = 0; i < 100000; ++i) EXPECT_EQ(array[i].number, i < 100 ? i : 0);
}

/// What is small asks the system for nothing; it grows where it must.
TEST(SmallMesh, LeavesTheHeapBeforeItsSlotsAreUsedUp) {
  EXPECT_FALSE(Mesh<2>().is_small());
  EXPECT_FALSE(Mesh<3>(4).is_small());
  EXPECT_FALSE(Mesh<2>(1000).is_small());
  Mesh<2> mesh(4);
  ASSERT_TRUE(mesh.is_small());
  auto pools = mesh.make_pools();
  std::vector<CellId> cells;
  for (std::uint32_t i = 0; i < 10000; ++i) {
    mesh.make_room(pools);
    cells.push_back(mesh.new_cell(pools));
    mesh.set_vertices(cells.back(), {VertexId{i}, VertexId{i + 1}, VertexId{i + 2}});
    mesh.constrain_face(pools, cells.back(), 0, i);
    EXPECT_EQ(mesh.is_small(), i < 241);
  }
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    EXPECT_EQ(mesh.cell(cells[i]).vertices[2], VertexId{i + 2});
    EXPECT_EQ(mesh.entity_of_face(cells[i], 0).id, i);
  }
}

}  // namespace pgdr::test_mesh_reserved_memory
