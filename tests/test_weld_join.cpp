// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Meshes that are joined: parts of one mesh become it again, and what is refused is what all pairs of cells say.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "dimensions.hpp"
#include "joined_meshes.hpp"
#include "numbers/corners.hpp"
#include "output/simplices.hpp"
#include "pgdr/predicates.hpp"
#include "space/contact.hpp"
#include "test_check_models.hpp"

namespace pgdr::test_weld_join {

using namespace pgdr::test;
using Random = std::mt19937_64;

/// The cells of a mesh with these numbers, with what walls and subsegments they have. The points are in another order.
template <int D>
OutputMesh<D> part_of(const OutputMesh<D>& mesh, const std::vector<std::uint32_t>& cells, Random& random) {
  std::set<std::uint32_t> used;
  std::set<std::set<std::uint32_t>> faces, edges;
  for (const std::uint32_t c : cells) {
    used.insert(mesh.cells[c].begin(), mesh.cells[c].end());
    for (int i = 0; i <= D; ++i) {
      const auto face = face_without(mesh.cells[c], i);
      faces.emplace(face.begin(), face.end());
      for (int k = 0; k < i; ++k) edges.insert({mesh.cells[c][k], mesh.cells[c][i]});
    }
  }
  std::vector<std::uint32_t> order(used.begin(), used.end());
  std::shuffle(order.begin(), order.end(), random);
  OutputMesh<D> part;
  std::map<std::uint32_t, std::uint32_t> number;
  for (const std::uint32_t v : order) {
    number[v] = static_cast<std::uint32_t>(part.points.size());
    part.points.push_back(mesh.points[v]);
  }
  for (const std::uint32_t c : cells) {
    part.cells.push_back(mesh.cells[c]);
    if (!mesh.regions.empty()) part.regions.push_back(mesh.regions[c]);
  }
  const auto take = [](const auto& from, const auto& there, auto& to) {
    for (const auto& constraint : from)
      if (there.contains({constraint.vertices.begin(), constraint.vertices.end()})) to.push_back(constraint);
  };
  take(mesh.subfacets, faces, part.subfacets);
  take(mesh.subsegments, edges, part.subsegments);
  each_simplex(part, [&](auto& vertices) {
    for (auto& v : vertices) v = number[v];
  });
  return part;
}

template <int D>
std::vector<OutputMesh<D>> parts_of(const OutputMesh<D>& mesh, std::size_t count, Random& random) {
  std::vector<std::vector<std::uint32_t>> cells(count);
  for (std::uint32_t c = 0; c < mesh.cells.size(); ++c) cells[c < count ? c : random() % count].push_back(c);
  std::vector<OutputMesh<D>> parts;
  for (const auto& some : cells) parts.push_back(part_of(mesh, some, random));
  return parts;
}

/// Simplices by the places of their corners, each with a number.
template <int D, class List, class Number>
std::multiset<std::pair<std::set<std::array<double, D>>, double>> by_places(const OutputMesh<D>& mesh, const List& list,
                                                                            const Number& number) {
  std::multiset<std::pair<std::set<std::array<double, D>>, double>> all;
  for (std::size_t i = 0; i < list.size(); ++i) {
    std::set<std::array<double, D>> places;
    if constexpr (requires { list[i].vertices; })
      for (const std::uint32_t v : list[i].vertices) places.insert(mesh.points[v].x);
    else
      for (const std::uint32_t v : list[i]) places.insert(mesh.points[v].x);
    all.emplace(places, number(i));
  }
  return all;
}
template <int D>
auto cells_by_places(const OutputMesh<D>& mesh) {
  return by_places(mesh, mesh.cells, [&](std::size_t i) { return mesh.regions.empty() ? 0 : mesh.regions[i]; });
}
template <int D, class List>
auto constraints_by_places(const OutputMesh<D>& mesh, const List& list) {
  return by_places(mesh, list, [&](std::size_t i) { return list[i].marker; });
}

template <class Tag>
class Join : public testing::Test {};
TYPED_TEST_SUITE(Join, Dimensions);

TYPED_TEST(Join, PartsOfAMeshBecomeItAgain) {
  constexpr int D = TypeParam::value;
  Random random(1);
  std::uint64_t walls_within = 0;
  for (const auto& model : all_models<D>())
    for (const std::size_t count : {1u, 2u, 3u, 7u}) {
      if (model.mesh.cells.size() < count) continue;
      const auto parts = parts_of(model.mesh, count, random);
      const JoinedMesh<D> out = joined(parts);
      EXPECT_EQ(cells_by_places(out.mesh), cells_by_places(model.mesh)) << model.name;
      EXPECT_EQ(out.first_cell.size(), count + 1);
      EXPECT_EQ(findings_alone(out.mesh), "") << model.name;
      std::uint64_t faces = 0;
      for (const SharedConstraints& s : out.interfaces) faces += s.count;
      EXPECT_EQ(faces > 0, count > 1) << model.name;
      // What the whole mesh lists is there, and what bounds a part.
      auto wanted = constraints_by_places(model.mesh, walls(model.mesh)),
           found = constraints_by_places(out.mesh, walls(out.mesh));
      EXPECT_TRUE(std::includes(found.begin(), found.end(), wanted.begin(), wanted.end())) << model.name;
      EXPECT_EQ(found.size() - wanted.size(), out.added_walls) << model.name;
      walls_within += out.added_walls;
      EXPECT_EQ(constraints_by_places(out.mesh, out.mesh.subsegments).size() >= model.mesh.subsegments.size(), true);
      for (std::size_t m = 0; m < count; ++m)
        for (std::size_t v = 0; v < parts[m].points.size(); ++v)
          EXPECT_EQ(out.mesh.points[out.vertices[m][v]], parts[m].points[v]);
    }
  EXPECT_GT(walls_within, 100u);
}

/// Numbers, and whose word stands, and nothing else.
TYPED_TEST(Join, OrderOfTheMeshes) {
  constexpr int D = TypeParam::value;
  Random random(2);
  for (const auto& model : all_models<D>()) {
    auto parts = parts_of(model.mesh, 4, random);
    const JoinedMesh<D> one = joined(parts);
    std::shuffle(parts.begin(), parts.end(), random);
    const JoinedMesh<D> other = joined(parts);
    EXPECT_EQ(cells_by_places(one.mesh), cells_by_places(other.mesh));
    EXPECT_EQ(constraints_by_places(one.mesh, one.mesh.subsegments), constraints_by_places(other.mesh, other.mesh.subsegments));
    EXPECT_EQ(constraints_by_places(one.mesh, one.mesh.subfacets), constraints_by_places(other.mesh, other.mesh.subfacets));
    EXPECT_EQ(one.shared_points, other.shared_points);
    EXPECT_EQ(one.added_walls, other.added_walls);
  }
}

/// A face of a cell; in 3D seen along an axis along which it is no line, and positively oriented there.
template <int D>
detail::Piece face_piece(const std::vector<Point<D>>& p, const std::array<std::uint32_t, D + 1>& cell, int i) {
  const auto face = face_without(cell, i);
  detail::Piece piece;
  piece.count = D;
  std::copy(face.begin(), face.end(), piece.corners.begin());
  if constexpr (D == 3) {
    int axis = 0;
    while (orient_projected(p[face[0]], p[face[1]], p[face[2]], axis) == Sign::zero) ++axis;
    piece.axis = static_cast<std::uint8_t>(axis);
    if (orient_projected(p[face[0]], p[face[1]], p[face[2]], axis) == Sign::negative)
      std::swap(piece.corners[1], piece.corners[2]);
  }
  return piece;
}

template <int D>
bool is_strictly_inside(const std::vector<Point<D>>& p, std::uint32_t v, const std::array<std::uint32_t, D + 1>& cell) {
  for (std::size_t i = 0; i <= D; ++i) {
    Simplex<D> s;
    for (std::size_t k = 0; k <= D; ++k) s[k] = p[cell[k]];
    s[i] = p[v];
    if (orient<D>(s) != Sign::positive) return false;
  }
  return true;
}

/// Do two cells meet in a common vertex, edge or face, from its two sides, and nowhere else? Points at one place have one number.
template <int D>
bool match(const std::vector<Point<D>>& p, const std::array<std::uint32_t, D + 1>& a, const std::array<std::uint32_t, D + 1>& b) {
  for (const std::uint32_t v : a)
    if (is_strictly_inside<D>(p, v, b)) return false;
  for (const std::uint32_t v : b)
    if (is_strictly_inside<D>(p, v, a)) return false;
  for (int i = 0; i <= D; ++i)
    for (int k = 0; k <= D; ++k) {
      const auto f = face_without(a, i), g = face_without(b, k);
      if (std::is_permutation(f.begin(), f.end(), g.begin())) {
        Simplex<D> s;
        for (int j = 0; j <= D; ++j) s[static_cast<std::size_t>(j)] = p[a[static_cast<std::size_t>(j)]];
        s[static_cast<std::size_t>(i)] = p[b[static_cast<std::size_t>(k)]];
        if (orient<D>(s) != Sign::negative) return false;
      } else if (detail::contact<D>(p, face_piece<D>(p, a, i), face_piece<D>(p, b, k)).kind != detail::Contact::Kind::none) {
        return false;
      }
    }
  return true;
}

/// By all pairs of cells, of these meshes. `within`: of each mesh by itself, or else of different ones.
template <int D>
bool all_match(const std::vector<OutputMesh<D>>& meshes, bool within) {
  std::map<std::array<double, D>, std::uint32_t> number;
  std::vector<Point<D>> points;
  std::vector<std::vector<std::array<std::uint32_t, D + 1>>> cells(meshes.size());
  for (std::size_t m = 0; m < meshes.size(); ++m)
    for (auto cell : meshes[m].cells) {
      for (auto& v : cell) {
        const auto [at, is_new] = number.emplace(meshes[m].points[v].x, static_cast<std::uint32_t>(points.size()));
        if (is_new) points.push_back(meshes[m].points[v]);
        v = at->second;
      }
      cells[m].push_back(cell);
    }
  for (std::size_t m = 0; m < cells.size(); ++m)
    for (std::size_t n = m; n < cells.size(); ++n)
      for (std::size_t a = 0; (m == n) == within && a < cells[m].size(); ++a)
        for (std::size_t b = m == n ? a + 1 : 0; b < cells[n].size(); ++b)
          if (!match<D>(points, cells[m][a], cells[n][b])) return false;
  return true;
}

template <int D>
bool are_distinct(const OutputMesh<D>& mesh) {
  std::set<std::array<double, D>> places;
  return std::ranges::all_of(mesh.points, [&](const Point<D>& p) { return places.insert(p.x).second; });
}

template <int D>
bool is_positive(const OutputMesh<D>& mesh) {
  return std::ranges::all_of(mesh.cells, [&](const auto& cell) {
    Simplex<D> s;
    for (std::size_t i = 0; i <= D; ++i) s[i] = mesh.points[cell[i]];
    return orient<D>(s) == Sign::positive;
  });
}

/// Of one to three more meshes: a part of the same lattice, as it is or with a vertex moved, or shifted by halves of a step, or
/// smaller.
template <int D>
OutputMesh<D> damaged(OutputMesh<D> mesh, Random& random) {
  const auto step = [&] { return static_cast<double>(random() % 5) / 2 - 1; };
  switch (random() % 5) {
    case 0: {
      Point<D>& p = mesh.points[random() % mesh.points.size()];
      for (double& x : p.x) x += step();
      break;
    }
    case 1: {
      Point<D> shift;
      for (double& x : shift.x) x = step();
      for (Point<D>& p : mesh.points)
        for (int k = 0; k < D; ++k) p[k] += shift[k];
      break;
    }
    case 2: {
      Point<D> middle;
      for (double& x : middle.x) x = static_cast<double>(random() % 5) / 2;
      for (Point<D>& p : mesh.points)
        for (int k = 0; k < D; ++k) p[k] = (p[k] + middle[k]) / 2;
      break;
    }
    default: break;
  }
  return mesh;
}

TYPED_TEST(Join, AgainstAllPairsOfCells) {
  constexpr int D = TypeParam::value;
  const OutputMesh<D> whole = solid_block<D>("block", 2, straight<D>()).mesh;
  Random random(3);
  std::map<bool, int> verdicts;
  std::map<Errc, int> codes;
  for (int round = 0; round < (D == 2 ? 3000 : 600); ++round) {
    const std::size_t count = 2 + random() % 3;
    std::vector<std::vector<std::uint32_t>> cells(count + 1);
    for (std::uint32_t c = 0; c < whole.cells.size(); ++c) cells[random() % cells.size()].push_back(c);
    std::vector<OutputMesh<D>> meshes;
    for (std::size_t m = 0; m < count; ++m) {
      if (cells[m].empty()) continue;
      const OutputMesh<D> part = part_of(whole, cells[m], random);
      OutputMesh<D> mesh = m == 0 ? part : damaged(part, random);
      if (!are_distinct(mesh) || !is_positive(mesh) || !all_match<D>({mesh}, true)) continue;
      meshes.push_back(std::move(mesh));
    }
    if (meshes.size() < 2) continue;
    const bool wanted = all_match(meshes, false);
    bool found = true;
    try {
      const JoinedMesh<D> out = joined(meshes);
      EXPECT_EQ(findings_alone(out.mesh), "") << round;
    } catch (const InputError& e) {
      found = false;
      ++codes[e.code()];
    }
    ASSERT_EQ(found, wanted) << round;
    ++verdicts[wanted];
  }
  EXPECT_GT(verdicts[true], 100);
  EXPECT_GT(verdicts[false], 100);
  for (const Errc code : {Errc::bodies_overlap, Errc::entities_intersect, Errc::point_on_segment}) EXPECT_GT(codes[code], 0);
}

}  // namespace pgdr::test_weld_join
