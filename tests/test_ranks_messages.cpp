// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Damage to what ranks send each other: what was cut short, flipped, or lies about lengths is read as other values or refused by
// a typed error. The sanitizers see what is read beyond its end.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "rank_messages.hpp"
#include "sanitized.hpp"

namespace pgdr::test::test_ranks_messages {

constexpr std::string_view all_names[message_kinds] = {"cells", "late_constraints", "letters", "late_work", "plc",
                                                       "piece", "result",           "error"};

template <int D>
class Damage {
 public:
  explicit Damage(unsigned kind) : kind_(static_cast<MessageKind>(kind)), whole_(messages_.sample(kind_)) {}

  const Bytes& whole() const { return whole_; }
  /// Does the reader refuse it? For kind error: what else than the error that was sent. Other errors are failures.
  bool is_refused(const Bytes& bytes) {
    try {
      messages_.read(kind_, bytes);
    } catch (const ResourceError& e) {
      EXPECT_EQ(e.code(), Errc::internal) << e.what();
      return true;
    } catch (const Error& e) {
      EXPECT_EQ(kind_, MessageKind::error) << e.what();
    }
    return false;
  }

 private:
  RankMessages<D> messages_;
  MessageKind kind_;
  Bytes whole_;
};

class Messages : public testing::TestWithParam<unsigned> {};

template <int D>
void expect_whole_only(unsigned kind) {
  Damage<D> damage(kind);
  EXPECT_FALSE(damage.is_refused(damage.whole()));
  Bytes bytes = damage.whole();
  bytes.push_back(std::byte{0});
  EXPECT_TRUE(damage.is_refused(bytes)) << "with a byte more";
  const std::size_t step = sanitized ? 17 : 1;
  for (std::size_t length = 0; length < damage.whole().size(); length += step) {
    bytes.assign(damage.whole().begin(), damage.whole().begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_TRUE(damage.is_refused(bytes)) << "of length " << length;
  }
}

TEST_P(Messages, AreRefusedWhereTheyAreCutShortOrTooLong) {
  expect_whole_only<2>(GetParam());
  expect_whole_only<3>(GetParam());
}

/// Each bit, one at a time; and bytes of ones, as every length that lies by much.
template <int D>
void expect_other_values_or_errors(unsigned kind) {
  Damage<D> damage(kind);
  std::size_t refused = 0;
  const std::size_t step = sanitized ? 7 : 1;
  for (std::size_t bit = 0; bit < 8 * damage.whole().size(); bit += step) {
    Bytes bytes = damage.whole();
    bytes[bit / 8] ^= std::byte{1} << bit % 8;
    refused += damage.is_refused(bytes) ? 1 : 0;
  }
  EXPECT_GT(refused, 8u);  // one of the lengths at least
  for (std::size_t at = 0; at + 8 <= damage.whole().size(); at += 4)
    for (const std::uint64_t length :
         {~std::uint64_t{0}, std::uint64_t{1} << 61, std::uint64_t{1} << 40, std::uint64_t{1} << 31}) {
      Bytes bytes = damage.whole();
      std::memcpy(bytes.data() + at, &length, sizeof length);
      damage.is_refused(bytes);
    }
}

TEST_P(Messages, AreOtherValuesOrErrorsWhereBitsAreFlippedAndLengthsLie) {
  expect_other_values_or_errors<2>(GetParam());
  expect_other_values_or_errors<3>(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Kinds, Messages, testing::Range(0u, message_kinds),
                         [](const auto& info) { return std::string(all_names[info.param]); });

/// What would be taken for cells, but is none: no rank may begin to apply it.
TEST(CellMessages, HaveFinitePointsAndCellsOfDifferentVertices) {
  using Cells = detail::SentCells<2>;
  const auto read = [](const Cells& cells) {
    detail::MessageWriter message;
    cells.put(message);
    const Bytes bytes = message.take();
    detail::MessageReader reader(bytes);
    return Cells::get(reader);
  };
  const std::uint32_t nothing = Link().code;
  Cells good;
  good.vertices = {{{0, 0}, 0, 1}, {{1, 0}, 0, 1}, {{0, 1}, 0, 1}};
  good.gone = {{0, 1, 2}};
  good.made = {{{0, 1, 2}, {nothing, nothing, Link::not_held().code}, 0, 0}};
  EXPECT_EQ(read(good).made.size(), 1u);
  for (const double x : {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
    Cells bad = good;
    bad.vertices[1].point[1] = x;
    EXPECT_THROW(read(bad), ResourceError) << x;
  }
  const auto expect_refused = [&](auto damage) {
    Cells bad = good;
    damage(bad);
    EXPECT_THROW(read(bad), ResourceError);
  };
  expect_refused([](Cells& c) { c.gone[0][2] = 0; });
  expect_refused([](Cells& c) { c.gone[0][2] = 3; });
  expect_refused([](Cells& c) { c.made[0].vertices[0] = 1; });
  expect_refused([](Cells& c) { c.made[0].links[0] = Link(CellId{1}, 0).code; });
  expect_refused([](Cells& c) { c.made[0].links[0] = Link(CellId{0}, 3).code; });
  expect_refused([](Cells& c) { c.made[0].has_constraints = 1; });
  expect_refused([](Cells& c) { c.constraints.emplace_back(); });
}

TEST(EntriesInMessages, AreOfKindsAndFacesThatThereAre) {
  const OwnedTree<3> owned(1, 2, 1);
  CutMesh<3> cut(owned, 0, 2, 1);
  cut.held.find_all();
  const Mesh<3>& mesh = cut.part.mesh;
  const CellId c = cells_of(mesh).front();
  const auto good = detail::SentEntry<3>::of(mesh, Entry<3>(c, mesh.birth(c), EntryKind::edge, 5, 255, 9));
  const Entry<3> copy = good.entry(mesh, cut.held);
  EXPECT_TRUE(copy.cell == c && copy.kind() == EntryKind::edge && copy.which() == 5 && copy.bucket == 255 && copy.order == 9);
  // What is gone has its place in heaps and counts still.
  const Entry<3> gone(c, static_cast<std::uint16_t>(mesh.birth(c) + 1), EntryKind::cell, Entry<3>::over_radius_edge, 7, 11);
  const Entry<3> place = detail::SentEntry<3>::of(mesh, gone).entry(mesh, cut.held);
  EXPECT_FALSE(place.alive(mesh));
  EXPECT_TRUE(place.kind() == gone.kind() && place.which() == gone.which() && place.bucket == 7 && place.order == 11);
  const auto expect_refused = [&](auto damage) {
    auto bad = good;
    damage(bad);
    EXPECT_THROW(bad.entry(mesh, cut.held), ResourceError);
  };
  expect_refused([](auto& e) { e.kind = 4; });
  expect_refused([](auto& e) { e.which = 6; });
  expect_refused([](auto& e) { e.bucket = 256; });
  expect_refused([](auto& e) { e.cell[1][0] = 0.123; });
  for (const EntryKind kind : {EntryKind::face, EntryKind::flip, EntryKind::cell})
    expect_refused([kind](auto& e) { e.kind = static_cast<std::uint32_t>(kind); });  // with the number of an edge
}

/// Of a node that the tree lacks, and of no kind.
TEST(LateWorkInMessages, IsOfNodesAndKindsThatThereAre) {
  using Late = detail::LateWork<2>;
  const OwnedTree<2> owned(1, 2, 1);
  CutMesh<2> cut(owned, 0, 2, 1);
  cut.held.find_all();
  const Mesh<2>& mesh = cut.part.mesh;
  const CellId c = cells_of(mesh).front();
  const auto is_read = [&](std::uint32_t node, Late::Kind kind, EntityKind entity) {
    Refusal<2> refusal{
        {c, mesh.birth(c), EntryKind::face, 0}, EntityPair{{EntityRef{entity, 0}, EntityRef{}}}, 1, {}, 0, false, 0, 0};
    Late late;
    late.add({{}, kind, node, 1, refusal});
    detail::MessageWriter message;
    late.put(message, mesh);
    const Bytes bytes = message.take();
    detail::MessageReader reader(bytes);
    try {
      late.get(reader, owned.tree, mesh, cut.held);
    } catch (const ResourceError&) {
      return false;
    }
    return !late.empty();
  };
  EXPECT_TRUE(is_read(4, Late::Kind::refused, EntityKind::volume));
  EXPECT_FALSE(is_read(5, Late::Kind::refused, EntityKind::volume));
  EXPECT_FALSE(is_read(4, static_cast<Late::Kind>(3), EntityKind::volume));
  EXPECT_FALSE(is_read(4, Late::Kind::refused, static_cast<EntityKind>(4)));
}

}  // namespace pgdr::test::test_ranks_messages
