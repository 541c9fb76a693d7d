// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/reserved_memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

namespace pgdr::test_reserved_memory {

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

}  // namespace pgdr::test_reserved_memory
