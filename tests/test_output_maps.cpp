// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What of a mesh is what of its input, against geometry; and the neighbours of cells, against each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <set>
#include <stop_token>

#include "model_plcs.hpp"
#include "pgdr/mesh_maps.hpp"
#include "pgdr/refine.hpp"
#include "planar_plcs.hpp"
#include "structure_plcs.hpp"

namespace pgdr::test_output_maps {

using Numbers = std::vector<std::uint32_t>;

Numbers list(const NumberLists& lists, std::size_t i) {
  const auto view = lists[i];
  return {view.begin(), view.end()};
}

/// Do the lists say the same both ways, each ascending?
void expect_both_ways(const NumberLists& forward, const NumberLists& back) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs, turned;
  for (std::uint32_t i = 0; i < forward.size(); ++i) {
    EXPECT_TRUE(std::ranges::is_sorted(forward[i]));
    for (const std::uint32_t j : forward[i]) pairs.emplace(i, j);
  }
  for (std::uint32_t j = 0; j < back.size(); ++j) {
    EXPECT_TRUE(std::ranges::is_sorted(back[j]));
    for (const std::uint32_t i : back[j]) turned.emplace(i, j);
  }
  EXPECT_EQ(pairs.size(), forward.numbers.size());
  EXPECT_EQ(pairs, turned);
}

double length(const OutputMesh<2>& mesh, const NumberLists& lists, std::size_t segment) {
  double sum = 0;
  for (const std::uint32_t i : lists[segment]) {
    const auto [a, b] = mesh.subsegments[i].vertices;
    sum += std::sqrt(squared_distance(mesh.points[a], mesh.points[b]));
  }
  return sum;
}

double area(const OutputMesh<3>& mesh, std::span<const std::uint32_t> subfacets) {
  double sum = 0;
  for (const std::uint32_t i : subfacets) {
    const auto [a, b, c] = mesh.subfacets[i].vertices;
    const Point3 &p = mesh.points[a], &q = mesh.points[b], &r = mesh.points[c];
    double square = 0;
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3, m = (k + 2) % 3;
      const double x = (q[l] - p[l]) * (r[m] - p[m]) - (q[m] - p[m]) * (r[l] - p[l]);
      square += x * x;
    }
    sum += std::sqrt(square) / 2;
  }
  return sum;
}

/// A square with a diagonal, whose sides come in every way in which segments may repeat and overlap each other.
Plc<2> overlapping_segments() {
  Plc<2> plc;
  plc.points = {{{0, 0}}, {{4, 0}}, {{4, 4}}, {{0, 4}}, {{1, 0}}, {{3, 0}}, {{4, 0}}, {{2, 2}}, {{9, 9}}};
  plc.segments = {{{0, 5}, 1}, {{4, 1}, 2},            // 0 - 3 and 1 - 4 of the lower side
                  {{1, 2}},    {{2, 6}},               // the same twice, one by another point there
                  {{2, 3}},    {{3, 0}},    {{0, 2}},  // through point 7
                  {{1, 6}}};                           // of no length
  return plc;
}

TEST(InputMap, SegmentsThatOverlap) {
  const Plc<2> plc = overlapping_segments();
  const Domain<2> domain(plc);
  RefineOptions<2> options;
  options.size = 0.05;
  const OutputMesh<2> mesh = refine(domain, options).mesh;
  const InputMap<2> map = input_map(domain, mesh);
  ASSERT_EQ(map.vertex_of_point.size(), 9u);
  for (std::size_t i = 0; i < plc.points.size(); ++i) EXPECT_EQ(mesh.points[map.vertex_of_point[i]], plc.points[i]) << i;
  EXPECT_EQ(map.vertex_of_point[1], map.vertex_of_point[6]);
  EXPECT_EQ(map.points_of_vertex.size(), 8u);
  EXPECT_EQ(list(map.points_of_vertex, map.vertex_of_point[1]), (Numbers{1, 6}));

  ASSERT_EQ(map.subsegments_of_segment.size(), 8u);
  ASSERT_EQ(map.segments_of_subsegment.size(), mesh.subsegments.size());
  expect_both_ways(map.subsegments_of_segment, map.segments_of_subsegment);
  const double lengths[] = {3, 3, 4, 4, 4, 4, std::sqrt(32), 0};
  for (std::size_t s = 0; s < 8; ++s) EXPECT_NEAR(length(mesh, map.subsegments_of_segment, s), lengths[s], 1e-12) << s;
  double middle = 0;
  for (std::uint32_t i = 0; i < mesh.subsegments.size(); ++i) {
    const Numbers of = list(map.segments_of_subsegment, i);
    EXPECT_FALSE(of.empty());
    const auto [a, b] = mesh.subsegments[i].vertices;
    if (of == Numbers{0, 1}) middle += std::fabs(mesh.points[a][0] - mesh.points[b][0]);
  }
  EXPECT_NEAR(middle, 2, 1e-12);
  EXPECT_TRUE(map.subfacets_of_facet.size() == 0 && map.facets_of_subfacet.size() == 0);
}

/// A mesh without its points of no cell is the same, by other numbers, and so is its map. (Point 8 lies outside; the others are
/// corners or crossings.)
TEST(InputMap, PointsOfNoCellThatAreDropped) {
  Plc<2> plc = overlapping_segments();
  plc.points.insert(plc.points.begin(), Point2{{-3, -3}});
  plc.points.push_back({{2.5, 1}});
  for (auto& s : plc.segments)
    for (auto& p : s.points) ++p;
  for (std::size_t i = 0; i < plc.points.size(); ++i) {
    plc.point_markers.push_back(static_cast<int>(i) + 20);
    plc.point_attributes.insert(plc.point_attributes.end(), {plc.points[i][0], plc.points[i][1]});
  }
  const Domain<2> domain(plc);
  RefineOptions<2> options;
  options.size = 0.05;
  const RefineResult<2> whole = refine(domain, options);
  options.drop_unused_points = true;
  const RefineResult<2> part = refine(domain, options);
  ASSERT_EQ(whole.unused_points, (Numbers{0, 8}));  // of the Domain, where point 7 is point 2 again
  EXPECT_EQ(part.unused_points, whole.unused_points);
  EXPECT_EQ(unused_points(whole.mesh), whole.unused_points);
  EXPECT_TRUE(unused_points(part.mesh).empty());
  const auto is_of_points = [](const Diagnostic& d) { return d.code == Errc::unreferenced_point; };
  ASSERT_EQ(std::ranges::count_if(part.warnings, is_of_points), 1);
  EXPECT_EQ(std::ranges::find_if(part.warnings, is_of_points)->ids, (std::vector<std::int64_t>{0, 9}));
  ASSERT_EQ(part.mesh.points.size() + 2, whole.mesh.points.size());
  EXPECT_EQ(part.mesh.input_points + 2, whole.mesh.input_points);

  const InputMap<2> of_whole = input_map(domain, whole.mesh), map = input_map(domain, part.mesh);
  for (std::size_t i = 0; i < plc.points.size(); ++i) {
    const std::uint32_t v = map.vertex_of_point[i];
    ASSERT_EQ(v == dropped_point, i == 0 || i == 9) << i;
    if (v == dropped_point) continue;
    EXPECT_EQ(part.mesh.points[v], plc.points[i]);
    EXPECT_EQ(part.mesh.point_markers[v], i == 7 ? 22 : static_cast<int>(i) + 20);
    EXPECT_EQ(part.mesh.point_attributes[2 * v + 1], plc.points[i][1]);
    EXPECT_EQ(list(map.points_of_vertex, v), list(of_whole.points_of_vertex, of_whole.vertex_of_point[i]));
  }
  EXPECT_EQ(map.points_of_vertex.size(), part.mesh.input_points);
  EXPECT_EQ(map.subsegments_of_segment.numbers, of_whole.subsegments_of_segment.numbers);
  for (std::size_t c = 0; c < part.mesh.cells.size(); ++c)
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_EQ(part.mesh.points[part.mesh.cells[c][k]], whole.mesh.points[whole.mesh.cells[c][k]]);
  OutputMesh<2> other = part.mesh;
  other.points[0][0] += 1e-9;
  EXPECT_THROW(input_map(domain, other), UsageError);
}

/// Of triangles of one plane, which are one facet of the mesh, each has the subfacets of the whole. A facet given twice has them
/// twice. A marker keeps its facet apart. A facet of two corners is a segment.
TEST(InputMap, FacetsInOnePlaneAndRepeatedOnes) {
  Plc<3> plc;
  test::add_box(plc, {{0, 0, 0}}, {{1, 1, 1}}, 0);
  const auto sides = static_cast<std::uint32_t>(plc.facets.size());
  ASSERT_EQ(sides, 6u);
  const std::vector<std::uint32_t> square = plc.facets[0].polygons[0];
  const int marker = plc.facets[0].marker;
  plc.facets[0].polygons[0] = {square[0], square[1], square[2]};
  plc.facets.push_back({{{square[0], square[2], square[3]}}, {}, marker});   // 6: the other half
  plc.facets.push_back({plc.facets[1].polygons, {}, plc.facets[1].marker});  // 7: 1 again
  plc.points.push_back({{0.25, 0.25, 0.25}});
  plc.points.push_back({{0.75, 0.75, 0.75}});
  plc.facets.push_back({{{8, 9}}, {}, 0});  // 8: a segment
  plc.segments.push_back({{square[0], square[1]}, 3});
  const Domain<3> domain(plc);
  const OutputMesh<3> mesh = refine(domain, RefineOptions<3>{}).mesh;
  const InputMap<3> map = input_map(domain, mesh);
  ASSERT_EQ(map.subfacets_of_facet.size(), 9u);
  ASSERT_EQ(map.facets_of_subfacet.size(), mesh.subfacets.size());
  expect_both_ways(map.subfacets_of_facet, map.facets_of_subfacet);
  for (std::uint32_t f = 0; f < 8; ++f) EXPECT_NEAR(area(mesh, map.subfacets_of_facet[f]), 1, 1e-12) << f;
  EXPECT_EQ(list(map.subfacets_of_facet, 0), list(map.subfacets_of_facet, 6));
  EXPECT_EQ(list(map.subfacets_of_facet, 1), list(map.subfacets_of_facet, 7));
  EXPECT_TRUE(map.subfacets_of_facet[8].empty());
  EXPECT_EQ(map.subsegments_of_facet.size(), 9u);
  EXPECT_FALSE(map.subsegments_of_facet[8].empty());
  EXPECT_EQ(map.subsegments_of_facet.numbers.size(), map.subsegments_of_facet[8].size());
  EXPECT_FALSE(map.subsegments_of_segment[0].empty());
  expect_both_ways(map.subsegments_of_segment, map.segments_of_subsegment);
  for (const std::uint32_t i : map.subsegments_of_segment[0]) EXPECT_EQ(mesh.subsegments[i].marker, 3);
}

/// A box on a slab: what they have in common is of both, the rest of the slab's top is not the box's.
TEST(InputMap, FacetsThatOverlap) {
  Plc<3> plc;
  test::add_box(plc, {{0, 0, -1}}, {{4, 4, 0}}, 1);
  test::add_box(plc, {{1, 1, 0}}, {{2, 2, 1}}, 11);
  const auto facet_at = [&](std::size_t first, double z) {
    for (std::uint32_t f = static_cast<std::uint32_t>(first); f < first + 6; ++f)
      if (std::ranges::all_of(plc.facets[f].polygons[0], [&](std::uint32_t v) { return plc.points[v][2] == z; })) return f;
    return no_entity;
  };
  const std::uint32_t top = facet_at(0, 0), bottom = facet_at(6, 0);
  ASSERT_TRUE(top < 6 && bottom < 12);
  const Domain<3> domain(plc);
  const OutputMesh<3> mesh = refine(domain, RefineOptions<3>{}).mesh;
  const InputMap<3> map = input_map(domain, mesh);
  expect_both_ways(map.subfacets_of_facet, map.facets_of_subfacet);
  EXPECT_NEAR(area(mesh, map.subfacets_of_facet[top]), 16, 1e-12);
  EXPECT_NEAR(area(mesh, map.subfacets_of_facet[bottom]), 1, 1e-12);
  for (const std::uint32_t i : map.subfacets_of_facet[bottom]) EXPECT_EQ(list(map.facets_of_subfacet, i), (Numbers{top, bottom}));
}

TEST(InputMap, OfAMeshThatWasNumberedInHaste) {
  const Plc<3> plc = test::block_with_cavity();
  const Domain<3> domain(plc);
  std::stop_source source;
  std::atomic<int> calls = 0;
  RefineOptions<3> options;
  options.stop = source.get_token();
  options.size = [&](const Point3&) {
    if (++calls == 3000) source.request_stop();
    return 0.1;
  };
  const RefineResult<3> result = refine(domain, options);
  ASSERT_EQ(result.stop, StopCause::cancelled);
  ASSERT_FALSE(result.mesh.cells.empty());
  const InputMap<3> map = input_map(domain, result.mesh);
  expect_both_ways(map.subfacets_of_facet, map.facets_of_subfacet);
  for (std::size_t i = 0; i < plc.points.size(); ++i) EXPECT_EQ(result.mesh.points[map.vertex_of_point[i]], plc.points[i]);
  for (std::size_t i = 0; i < result.mesh.subfacets.size(); ++i) EXPECT_FALSE(map.facets_of_subfacet[i].empty());
}

// A point of the input may be the last of all.
TEST(InputMap, OfAMeshWithoutSteinerPoints) {
  const Plc<3> plc = test::cube();
  const Domain<3> domain(plc);
  RefineOptions<3> options;
  options.refine = false;
  const OutputMesh<3> mesh = refine(domain, options).mesh;
  ASSERT_EQ(mesh.points.size(), plc.points.size());
  const InputMap<3> map = input_map(domain, mesh);
  for (std::size_t i = 0; i < plc.points.size(); ++i) EXPECT_EQ(mesh.points[map.vertex_of_point[i]], plc.points[i]);
}

template <class F>
Errc code_of(const F& f) {
  try {
    f();
  } catch (const Error& e) {
    return e.code();
  }
  return Errc::internal;
}

TEST(InputMap, OfWhatIsNoMeshOfTheDomainIsRefused) {
  const Domain<2> domain(overlapping_segments());
  OutputMesh<2> mesh = refine(domain, RefineOptions<2>{}).mesh;
  mesh.subsegments[0].entity = no_entity;
  EXPECT_EQ(code_of([&] { input_map(domain, mesh); }), Errc::bad_option);
  mesh.subsegments.clear();
  EXPECT_NO_THROW(input_map(domain, mesh));
  mesh.input_points = 3;
  EXPECT_EQ(code_of([&] { input_map(domain, mesh); }), Errc::bad_option);
}

/// Each is its neighbour's neighbour, across the same vertices; and nothing is beyond as many faces as the hull has.
template <int D>
void expect_neighbors(const OutputMesh<D>& mesh) {
  const auto neighbors = neighbors_of_cells(mesh);
  ASSERT_EQ(neighbors.size(), mesh.cells.size());
  std::map<std::array<std::uint32_t, D>, int> uses;
  std::size_t alone = 0;
  for (std::uint32_t c = 0; c < mesh.cells.size(); ++c)
    for (int i = 0; i <= D; ++i) {
      std::set<std::uint32_t> face(mesh.cells[c].begin(), mesh.cells[c].end());
      face.erase(mesh.cells[c][i]);
      std::array<std::uint32_t, D> key;
      std::ranges::copy(face, key.begin());
      ++uses[key];
      const std::uint32_t beyond = neighbors[c][i];
      if (beyond == no_cell_beyond) {
        ++alone;
        continue;
      }
      ASSERT_LT(beyond, mesh.cells.size());
      const auto& there = mesh.cells[beyond];
      const auto back = std::ranges::find(neighbors[beyond], c) - neighbors[beyond].begin();
      ASSERT_LE(back, D);
      face.insert(there[static_cast<std::size_t>(back)]);
      EXPECT_EQ(face, std::set<std::uint32_t>(there.begin(), there.end()));
    }
  EXPECT_EQ(alone, static_cast<std::size_t>(std::ranges::count(uses, 1, [](const auto& use) { return use.second; })));
  EXPECT_GT(alone, 0u);
}

TEST(Neighbors, OfCells) {
  RefineOptions<2> fine;
  fine.size = 0.01;
  expect_neighbors<2>(refine(test::square_with_hole(), fine).mesh);
  RefineOptions<3> options;
  options.size = 0.3;
  expect_neighbors<3>(refine(test::block_with_cavity(), options).mesh);
  EXPECT_TRUE(neighbors_of_cells(OutputMesh<2>{}).empty());
}

TEST(Neighbors, OfWhatIsNoMeshAreRefused) {
  OutputMesh<2> mesh;
  mesh.points.resize(5);
  mesh.cells = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  EXPECT_EQ(code_of([&] { neighbors_of_cells(mesh); }), Errc::bad_option);
  mesh.cells = {{0, 1, 5}};
  EXPECT_EQ(code_of([&] { neighbors_of_cells(mesh); }), Errc::index_out_of_range);
}

/// Markers, label and input point of a mesh come through its boundary, and what that encloses is what the mesh fills.
template <int D>
void expect_same_from_boundary(const Plc<D>& plc, double size) {
  RefineOptions<D> options;
  options.size = size;
  const RefineResult<D> made = refine(plc, options);
  const Plc<D> boundary = boundary_of_mesh(made.mesh);
  EXPECT_LE(boundary.points.size(), made.mesh.points.size());
  const RefineResult<D> again = refine(boundary, options);
  ASSERT_EQ(made.regions.size(), again.regions.size());
  for (std::size_t i = 0; i < made.regions.size(); ++i) {
    EXPECT_EQ(made.regions[i].label, again.regions[i].label);
    EXPECT_NEAR(made.regions[i].volume_meshed, again.regions[i].volume_meshed, 1e-12);
  }
  const auto markers_of = [](const OutputMesh<D>& mesh) {
    std::set<int> markers;
    for (const auto& s : mesh.subsegments) markers.insert(s.marker);
    for (const auto& f : mesh.subfacets) markers.insert(f.marker);
    return markers;
  };
  EXPECT_EQ(markers_of(made.mesh), markers_of(again.mesh));
  for (const Point<D>& p : plc.points) EXPECT_NE(std::ranges::find(again.mesh.points, p), again.mesh.points.end());
}

TEST(Boundary, OfAMeshIsAnInputAgain) {
  Plc<2> square = test::square_with_hole();
  for (std::size_t i = 0; i < square.segments.size(); ++i) square.segments[i].marker = static_cast<int>(i) + 1;
  expect_same_from_boundary<2>(square, 0.01);
  Plc<3> block = test::block_with_cavity();
  for (std::size_t i = 0; i < block.facets.size(); ++i) block.facets[i].marker = static_cast<int>(i) + 1;
  expect_same_from_boundary<3>(block, 0.3);
  Plc<3> boxes = test::boxes({{{{0, 0, 0}}, {{6, 6, 6}}}, {{{1, 1, 1}}, {{5, 5, 5}}}});
  boxes.regions = {{{{0.5, 3, 3}}, 2.5, 0}, {{{3, 3, 3}}, -7, 0}};
  boxes.points.push_back({{3, 3.25, 2.5}});
  expect_same_from_boundary<3>(boxes, 2);
}

TEST(Boundary, OfCellsAlone) {
  OutputMesh<2> mesh;
  mesh.points = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}, {{5, 5}}};
  mesh.cells = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(boundary_of_mesh(mesh).segments.size(), 4u);
  EXPECT_EQ(boundary_of_mesh(mesh).points.size(), 4u);
  mesh.regions = {1, 2};
  EXPECT_EQ(boundary_of_mesh(mesh).segments.size(), 5u);
  EXPECT_EQ(boundary_of_mesh(mesh).regions.size(), 2u);
  mesh.regions = {1};
  EXPECT_EQ(code_of([&] { boundary_of_mesh(mesh); }), Errc::index_out_of_range);
  mesh.cells = {{0, 1, 5}};
  EXPECT_EQ(code_of([&] { boundary_of_mesh(mesh); }), Errc::index_out_of_range);
  EXPECT_EQ(code_of([&] { boundary_of_mesh(OutputMesh<3>{}); }), Errc::bad_option);
}

}  // namespace pgdr::test_output_maps
