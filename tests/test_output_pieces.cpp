// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Pieces of a mesh: together they have each row once, and joined they are the mesh. Pieces that are not those of one mesh are
// refused with the number of the culprit.
#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "dimensions.hpp"
#include "pgdr/mesh_piece.hpp"
#include "test_io_support.hpp"

namespace pgdr::test::test_output_pieces {

/// With data of all kinds. Cells are few beside the points, so that points have no cell.
template <int D>
OutputMesh<D> full_mesh(std::uint64_t seed, std::size_t points = 40) {
  OutputMesh<D> mesh = some_mesh<D>(seed, points);
  mesh.cells.resize(points / 3);
  mesh.regions.resize(points / 3);
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) mesh.leaves.push_back(static_cast<std::uint32_t>(7 * i));
  for (std::size_t i = 0; i < 2 * points; ++i) mesh.point_attributes.push_back(static_cast<double>(i) / 3);
  for (std::size_t i = 0; i < mesh.subsegments.size(); ++i) mesh.subsegments[i].entity = static_cast<EntityId>(i / 2);
  return mesh;
}

template <int D>
std::vector<MeshPiece<D>> pieces_of(const OutputMesh<D>& mesh, std::uint64_t count) {
  std::vector<MeshPiece<D>> pieces;
  for (std::uint64_t k = 0; k < count; ++k) pieces.push_back(piece_of<D>(mesh, k, count));
  return pieces;
}

/// The points of a piece are those of what it has, and no others.
template <int D>
void expect_no_idle_points(const MeshPiece<D>& piece) {
  std::set<std::uint64_t> used;
  const auto use = [&](const auto& vertices) {
    for (const std::uint32_t v : vertices) used.insert(piece.point_numbers.at(v));
  };
  for (const auto& c : piece.mesh.cells) use(c);
  for (const auto& c : piece.mesh.subfacets) use(c.vertices);
  for (const auto& c : piece.mesh.subsegments) use(c.vertices);
  for (std::uint64_t i = 0; i < piece.own_points; ++i) used.insert(piece.first_point + i);
  EXPECT_EQ(std::vector<std::uint64_t>(used.begin(), used.end()), piece.point_numbers);
  EXPECT_EQ(piece.point_numbers.size(), piece.mesh.points.size());
}

template <class T>
class Pieces : public testing::Test {};
TYPED_TEST_SUITE(Pieces, Dimensions);

TYPED_TEST(Pieces, JoinToTheMesh) {
  constexpr int D = TypeParam::value;
  OutputMesh<D> bare = some_mesh<D>(3, 200);
  bare.regions.clear();
  bare.point_markers.clear();
  for (const OutputMesh<D>& mesh : {full_mesh<D>(1), full_mesh<D>(2, 700), bare, OutputMesh<D>{}}) {
    for (const std::uint64_t count : {1u, 2u, 3u, 7u, 40u, 1000u}) {  // a thousand: more than there are cells
      SCOPED_TRACE(count);
      std::vector<MeshPiece<D>> pieces = pieces_of<D>(mesh, count);
      std::uint64_t points = 0, most = 0;
      for (const MeshPiece<D>& piece : pieces) {
        expect_no_idle_points<D>(piece);
        EXPECT_EQ(piece.first_point, points);
        points += piece.own_points;
        most = std::max<std::uint64_t>(most, piece.mesh.cells.size());
      }
      EXPECT_LE(most, mesh.cells.size() / count + 1);
      std::reverse(pieces.begin(), pieces.end());
      expect_same(join_pieces<D>(pieces), mesh);
    }
  }
}

TYPED_TEST(Pieces, OneIsTheMesh) {
  constexpr int D = TypeParam::value;
  const OutputMesh<D> mesh = full_mesh<D>(4);
  const MeshPiece<D> piece = piece_of<D>(mesh, 0, 1);
  expect_same(piece.mesh, mesh);
  for (std::uint64_t i = 0; i < mesh.points.size(); ++i) EXPECT_EQ(piece.point_numbers[i], i);
}

TYPED_TEST(Pieces, OfNoMesh) {
  constexpr int D = TypeParam::value;
  EXPECT_EQ(error_of<UsageError>([] { piece_of<D>({}, 0, 0); }).code, Errc::bad_option);
  EXPECT_EQ(error_of<UsageError>([] { piece_of<D>({}, 3, 3); }).code, Errc::bad_option);
  EXPECT_TRUE(join_pieces<D>({}).points.empty());
}

TYPED_TEST(Pieces, ThatDoNotFitAreRefused) {
  constexpr int D = TypeParam::value;
  using Pieces = std::vector<MeshPiece<D>>;
  const OutputMesh<D> mesh = full_mesh<D>(5);
  const auto refused = [&](const std::function<void(Pieces&)>& damage, std::int64_t id) {
    Pieces pieces = pieces_of<D>(mesh, 3);
    damage(pieces);
    const Diagnostic d = error_of<InputError>([&] { join_pieces<D>(pieces); });
    EXPECT_EQ(d.code, Errc::syntax);
    EXPECT_EQ(d.ids, (id < 0 ? std::vector<std::int64_t>() : std::vector{id})) << d.message;
  };
  const auto second_begins = static_cast<std::int64_t>(mesh.points.size() / 3);
  refused([](Pieces& p) { p.erase(p.begin() + 1); }, second_begins);
  refused([](Pieces& p) { p.push_back(p[1]); }, second_begins);
  refused([](Pieces& p) { p[2].total.cells += 1; }, -1);
  refused([](Pieces& p) { p[1].first_cell += 1; }, static_cast<std::int64_t>(mesh.cells.size() / 3));
  refused([](Pieces& p) { p[0].mesh.subsegments.pop_back(); }, static_cast<std::int64_t>(mesh.subsegments.size() / 3 - 1));
  refused(
      [](Pieces& p) {
        // A point of another piece's rows, which both have.
        MeshPiece<D>& last = p[2];
        last.mesh.points[0][1] = std::nextafter(last.mesh.points[0][1], 0);
        EXPECT_LT(last.point_numbers[0], last.first_point);
      },
      static_cast<std::int64_t>(pieces_of<D>(mesh, 3)[2].point_numbers[0]));
  refused([](Pieces& p) { std::swap(p[0].point_numbers[0], p[0].point_numbers[1]); }, 0);
  refused([](Pieces& p) { p[0].point_numbers.back() = 40; }, 40);
  refused([](Pieces& p) { ++p[0].mesh.input_points; }, 20);
}

}  // namespace pgdr::test::test_output_pieces
