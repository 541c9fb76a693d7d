// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Sizing fields of points, of background meshes and of others: against plain loops over all points and cells, and through
// meshes that the checker verifies with the same field.
#include "pgdr/size_fields.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <utility>

#include "parallel_support.hpp"
#include "pgdr/flat_arrays.hpp"
#include "pgdr/io.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::test_size_fields {

template <int D>
Point<D> random_point(std::mt19937_64& random, double low, double high) {
  std::uniform_real_distribution<double> coordinate(low, high);
  Point<D> p;
  for (int i = 0; i < D; ++i) p[i] = coordinate(random);
  return p;
}

template <int D>
Plc<D> unit_box() {
  if constexpr (D == 3) {
    return test::cube();
  } else {
    const double xy[] = {0, 0, 1, 0, 1, 1, 0, 1};
    const std::uint32_t segments[] = {0, 1, 1, 2, 2, 3, 3, 0};
    return plc_from_arrays<2>(xy, segments);
  }
}

template <int D>
OutputMesh<D> background(double size) {
  RefineOptions<D> options;
  options.size = size;
  return refine<D>(unit_box<D>(), options).mesh;
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

template <class T>
class SizeFields : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(SizeFields, Dimensions);

// The tree leaves out what cannot be the minimum: bit for bit what a loop over all points finds.
TYPED_TEST(SizeFields, PointsAreTheMinimumOverAll) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(20261);
  for (const std::size_t n : {1u, 2u, 7u, 400u}) {
    std::vector<Point<D>> points;
    std::vector<double> sizes;
    for (std::size_t i = 0; i < n; ++i) {
      points.push_back(i % 3 == 2 ? points[i / 2] : random_point<D>(random, -1, 1));  // some twice
      sizes.push_back(std::exp(random_point<D>(random, -6, 0)[0]));
    }
    for (const double growth : {0.0, 0.1, 2.0}) {
      const SizingField<D> field = sizes_at_points<D>(points, sizes, growth);
      for (int k = 0; k < 500; ++k) {
        const Point<D> x = k < 50 ? points[k % n] : random_point<D>(random, -3, 3);
        double least = INFINITY;
        for (std::size_t i = 0; i < n; ++i) {
          const double length = D == 2 ? std::sqrt(sizes[i]) : sizes[i];
          least = std::min(least, length + growth * std::sqrt(squared_distance(x, points[i])));
        }
        EXPECT_EQ(field.at(x), D == 2 ? least * least : least);
      }
    }
  }
}

// A linear function is interpolated as it is; outside counts the nearest point, here of a box.
TYPED_TEST(SizeFields, MeshesInterpolateLinearly) {
  constexpr int D = TypeParam::value;
  const OutputMesh<D> mesh = background<D>(D == 2 ? 0.01 : 0.2);
  ASSERT_GT(mesh.cells.size(), 50u);
  const auto linear = [](const Point<D>& p) { return 1 + 0.5 * p[0] + 0.25 * p[1] - 0.125 * p[D - 1]; };
  std::vector<double> values;
  for (const Point<D>& p : mesh.points) values.push_back(linear(p));
  const SizingField<D> field = sizes_on_mesh<D>(mesh, values);
  std::mt19937_64 random(77);
  for (int k = 0; k < 3000; ++k) {
    const Point<D> x = random_point<D>(random, -0.5, 1.5);
    Point<D> nearest = x;
    for (double& c : nearest.x) c = std::clamp(c, 0.0, 1.0);
    EXPECT_NEAR(field.at(x), linear(nearest), 1e-12);
  }
  // At a vertex, the value of the vertex.
  for (std::size_t v = 0; v < mesh.points.size(); ++v) EXPECT_NEAR(field.at(mesh.points[v]), values[v], 1e-14);
}

// One value a cell: nowhere in a cell more than its own, and at each vertex the smallest of its cells'.
TYPED_TEST(SizeFields, ValuesOfCells) {
  constexpr int D = TypeParam::value;
  const OutputMesh<D> mesh = background<D>(D == 2 ? 0.01 : 0.2);
  ASSERT_NE(mesh.cells.size(), mesh.points.size());
  std::mt19937_64 random(6);
  std::vector<double> values;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) values.push_back(std::exp(random_point<D>(random, -9, 0)[0]));
  const SizingField<D> field = sizes_on_mesh<D>(mesh, values);
  std::vector<double> least(mesh.points.size(), INFINITY);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (const std::uint32_t v : mesh.cells[c]) least[v] = std::min(least[v], values[c]);
  EXPECT_EQ(smallest_at_vertices<D>(mesh, values), least);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) EXPECT_NEAR(field.at(mesh.points[v]), least[v], 1e-14);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    Point<D> centroid{};
    for (const std::uint32_t v : mesh.cells[c])
      for (int k = 0; k < D; ++k) centroid[k] += mesh.points[v][k] / (D + 1);
    EXPECT_LE(field.at(centroid), values[c]);
  }
  values[7] = -1;
  try {
    sizes_on_mesh<D>(mesh, values);
    ADD_FAILURE();
  } catch (const UsageError& e) {
    EXPECT_EQ(e.code(), Errc::bad_size);
    EXPECT_EQ(e.diagnostic().ids, std::vector<std::int64_t>{7});
  }
  values.pop_back();
  EXPECT_EQ(code_of([&] { sizes_on_mesh<D>(mesh, values); }), Errc::bad_option);
  EXPECT_EQ(code_of([&] { smallest_at_vertices<D>(mesh, values); }), Errc::bad_option);
}

// Whatever the values: the cell that holds the point, found by a loop over all, bounds the interpolation.
TYPED_TEST(SizeFields, MeshValuesStayWithinTheirCell) {
  constexpr int D = TypeParam::value;
  OutputMesh<D> mesh = background<D>(D == 2 ? 0.01 : 0.2);
  for (std::size_t c = 0; c < mesh.cells.size(); c += 2) std::swap(mesh.cells[c][0], mesh.cells[c][1]);  // any orientation
  std::mt19937_64 random(5);
  std::vector<double> values;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) values.push_back(std::exp(random_point<D>(random, -9, 0)[0]));
  const SizingField<D> field = sizes_on_mesh<D>(mesh, values);
  for (int k = 0; k < 1000; ++k) {
    const Point<D> x = random_point<D>(random, 0, 1);
    double least = INFINITY, most = 0;
    for (const auto& cell : mesh.cells) {
      Simplex<D> s;
      for (int i = 0; i <= D; ++i) s[i] = mesh.points[cell[i]];
      const Sign positive = orient<D>(s);
      bool inside = true;
      for (int i = 0; i <= D; ++i) {
        Simplex<D> t = s;
        t[i] = x;
        inside = inside && (orient<D>(t) == positive || orient<D>(t) == Sign::zero);
      }
      for (int i = 0; inside && i <= D; ++i) {
        least = std::min(least, values[cell[i]]);
        most = std::max(most, values[cell[i]]);
      }
    }
    EXPECT_GE(field.at(x), least);
    EXPECT_LE(field.at(x), most);
  }
}

TYPED_TEST(SizeFields, GrowthIsLimitedAlongEdges) {
  constexpr int D = TypeParam::value;
  const OutputMesh<D> mesh = background<D>(D == 2 ? 0.01 : 0.15);
  std::mt19937_64 random(6);
  std::vector<double> values;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) values.push_back(std::exp(random_point<D>(random, -5, 0)[0]));
  const double growth = 0.3;
  const std::vector<double> limited = limit_growth<D>(mesh, values, growth);
  // By relaxing edges until nothing changes any more.
  std::vector<double> length;
  const auto length_of = [](double size) { return D == 2 ? std::sqrt(size) : size; };
  for (const double v : values) length.push_back(length_of(v));
  for (bool again = true; again;) {
    again = false;
    for (const auto& cell : mesh.cells)
      for (const auto v : cell)
        for (const auto w : cell) {
          const double most = length[v] + growth * std::sqrt(squared_distance(mesh.points[v], mesh.points[w]));
          if (most < length[w]) {
            length[w] = most;
            again = true;
          }
        }
  }
  std::size_t lowered = 0;
  for (std::size_t v = 0; v < values.size(); ++v) {
    EXPECT_NEAR(length_of(limited[v]), length[v], 1e-15);
    EXPECT_LE(limited[v], values[v]);
    lowered += limited[v] < values[v];
  }
  EXPECT_GT(lowered, values.size() / 4);
  EXPECT_EQ(limit_growth<D>(mesh, limited, growth * 1.0001), limited);
}

TYPED_TEST(SizeFields, SmallestOfSeveral) {
  constexpr int D = TypeParam::value;
  const auto linear = [](const Point<D>& p) { return 1 + p[0]; };
  EXPECT_FALSE(smallest<D>({}).bounded());
  EXPECT_FALSE(smallest<D>({{}, {}}).bounded());
  EXPECT_TRUE(smallest<D>({0.5, 0.25, {}}).is_constant());
  EXPECT_EQ(smallest<D>({0.5, 0.25, {}}).at({}), 0.25);
  const SizingField<D> field = smallest<D>({1.5, linear, SizingField<D>{}});
  Point<D> p{};
  EXPECT_EQ(field.at(p), 1);
  p[0] = 3;
  EXPECT_EQ(field.at(p), 1.5);
  // What cannot be a size is not hidden by another.
  EXPECT_TRUE(std::isnan(smallest<D>({1.0, [](const Point<D>&) { return NAN; }}).at(p)));
  EXPECT_TRUE(std::isnan(smallest<D>({NAN, 1.0}).at(p)));
  EXPECT_EQ(smallest<D>({linear, [](const Point<D>&) { return -1.0; }}).at(p), -1);
}

// Met by the mesh, as the checker says; the same bytes for any number of threads.
TYPED_TEST(SizeFields, MeshesMeetThemReproducibly) {
  constexpr int D = TypeParam::value;
  const OutputMesh<D> mesh = background<D>(0.1);
  std::vector<double> values(mesh.points.size(), D == 2 ? 0.02 : 0.3);
  values[0] = D == 2 ? 1e-5 : 0.02;
  Point<D> centre;
  centre.x.fill(0.4);
  const std::vector<Point<D>> points{centre};
  RefineOptions<D> options;
  options.schedule.floor = 50;
  const double growth = D == 2 ? 0.1 : 0.4;
  options.size = smallest<D>({sizes_on_mesh<D>(mesh, limit_growth<D>(mesh, values, growth)),
                              sizes_at_points<D>(points, std::vector<double>{D == 2 ? 1e-5 : 0.03}, growth)});
  const auto result = test::expect_reproducible<D>(unit_box<D>(), options, "fields");
  EXPECT_TRUE(result.size_met);
  EXPECT_GT(result.mesh.cells.size(), 500u);
}

TYPED_TEST(SizeFields, WhatCannotBeAFieldIsATypedError) {
  constexpr int D = TypeParam::value;
  const std::vector<Point<D>> two{Point<D>{}, random_point<D>(*std::make_unique<std::mt19937_64>(1), 0, 1)};
  const std::vector<double> one{1}, good{1, 2}, zero{1, 0}, nan{NAN, 1}, infinite{1, INFINITY};
  EXPECT_EQ(code_of([&] { sizes_at_points<D>({}, {}, 1); }), Errc::bad_option);
  EXPECT_EQ(code_of([&] { sizes_at_points<D>(two, one, 1); }), Errc::bad_option);
  EXPECT_EQ(code_of([&] { sizes_at_points<D>(two, good, -1); }), Errc::bad_option);
  EXPECT_EQ(code_of([&] { sizes_at_points<D>(two, good, NAN); }), Errc::bad_option);
  for (const auto& bad : {zero, nan, infinite}) EXPECT_EQ(code_of([&] { sizes_at_points<D>(two, bad, 1); }), Errc::bad_size);
  try {
    sizes_at_points<D>(two, zero, 1);
  } catch (const UsageError& e) {
    EXPECT_EQ(e.diagnostic().ids, std::vector<std::int64_t>{1});
  }
  std::vector<Point<D>> far = two;
  far[1][0] = INFINITY;
  EXPECT_EQ(code_of([&] { sizes_at_points<D>(far, good, 1); }), Errc::not_finite);

  OutputMesh<D> mesh = background<D>(0.3);
  const std::vector<double> values(mesh.points.size(), 1.0);
  EXPECT_EQ(code_of([&] { sizes_on_mesh<D>(mesh, one); }), Errc::bad_option);
  EXPECT_EQ(code_of([&] { limit_growth<D>(mesh, values, -1); }), Errc::bad_option);
  OutputMesh<D> flat = mesh;
  flat.cells.resize(1);
  flat.cells[0][1] = flat.cells[0][0];
  EXPECT_EQ(code_of([&] { sizes_on_mesh<D>(flat, values); }), Errc::bad_option);
  mesh.cells[3][0] = static_cast<std::uint32_t>(mesh.points.size());
  EXPECT_EQ(code_of([&] { sizes_on_mesh<D>(mesh, values); }), Errc::index_out_of_range);
  EXPECT_EQ(code_of([&] { limit_growth<D>(mesh, values, 1); }), Errc::index_out_of_range);
}

/// There is a view of what is gone at once.
template <class Mesh>
concept CanDangle = requires(Mesh&& mesh) {
  flat_points(std::forward<Mesh>(mesh));
}
|| requires(Mesh&& mesh) { flat_cells(std::forward<Mesh>(mesh)); };
static_assert(CanDangle<OutputMesh<3>&> && !CanDangle<OutputMesh<3>> && !CanDangle<const OutputMesh<2>>);

TYPED_TEST(SizeFields, FlatArrays) {
  constexpr int D = TypeParam::value;
  const OutputMesh<D> mesh = background<D>(0.2);
  EXPECT_EQ(flat_points(mesh).size(), mesh.points.size() * D);
  EXPECT_EQ(flat_points(mesh)[D + 1], mesh.points[1][1]);
  EXPECT_EQ(flat_cells(mesh)[D + 1], mesh.cells[1][0]);
  const OutputMesh<D> copy = mesh_from_arrays<D>(flat_points(mesh), flat_cells(mesh));
  EXPECT_EQ(copy.points, mesh.points);
  EXPECT_EQ(copy.cells, mesh.cells);
  const OutputMesh<D> none;
  EXPECT_TRUE(flat_cells(none).empty());
  const std::vector<double> coordinates(D * 4, 0.5);
  std::vector<std::uint32_t> indices(D * 2, 3);
  EXPECT_EQ(code_of([&] { plc_from_arrays<D>(std::span(coordinates).first(D * 4 - 1), indices); }), Errc::bad_option);
  EXPECT_EQ(code_of([&] { plc_from_arrays<D>(coordinates, std::span(indices).first(D + 1)); }), Errc::bad_option);
  EXPECT_EQ(code_of([&] { plc_from_arrays<D>(coordinates, indices, std::vector<int>(3)); }), Errc::bad_option);
  indices[D] = 4;
  EXPECT_EQ(code_of([&] { plc_from_arrays<D>(coordinates, indices); }), Errc::index_out_of_range);
  EXPECT_EQ(code_of([&] { mesh_from_arrays<D>(coordinates, std::vector<std::uint32_t>(D + 1, 4)); }), Errc::index_out_of_range);
}

class SolFile : public testing::Test {
 protected:
  Errc read(const std::string& text) {
    const auto path = std::filesystem::path(testing::TempDir()) / "test_size_fields.sol";
    std::ofstream(path, std::ios::binary) << text;
    values.clear();
    return code_of([&] { values = read_vertex_values(path, 3); });
  }
  std::vector<double> values;
};

TEST_F(SolFile, Read) {
  EXPECT_EQ(read("MeshVersionFormatted 2\n\nDimension 3\n\nSolAtVertices\n3\n1 1\n0.5\n1e-3\n2\n\nEnd\n"), Errc::internal);
  EXPECT_EQ(values, (std::vector<double>{0.5, 1e-3, 2}));
  EXPECT_EQ(read("MeshVersionFormatted 2\nDimension\n3\nSolAtVertices 1 1 1 7"), Errc::internal);
  EXPECT_EQ(values, std::vector<double>{7});
}

TEST_F(SolFile, Damaged) {
  EXPECT_EQ(read(""), Errc::truncated);
  EXPECT_EQ(read("MeshVersionFormatted 2 Dimension 3 End"), Errc::truncated);
  EXPECT_EQ(read("MeshVersionFormatted 2 Dimension 2 SolAtVertices 1 1 1 7"), Errc::syntax);
  EXPECT_EQ(read("MeshVersionFormatted 2 Dimension 3 SolAtVertices 1 1 3 7 7 7 7 7 7"), Errc::syntax);
  EXPECT_EQ(read("MeshVersionFormatted 2 Dimension 3 SolAtVertices 2 1 1 7"), Errc::truncated);
  EXPECT_EQ(read("MeshVersionFormatted 2 Dimension 3 SolAtVertices 100000000000 1 1 7"), Errc::count_too_large);
  EXPECT_EQ(read("MeshVersionFormatted 2 Dimension 3 SolAtVertices 1 1 1 nan"), Errc::not_finite);
  EXPECT_EQ(read("SolAtVertices 1 1 1 x"), Errc::syntax);
  EXPECT_EQ(read("Vertices 1 0 0 0 0"), Errc::syntax);
  EXPECT_EQ(code_of([] { read_vertex_values("/no/such/file.sol", 3); }), Errc::cannot_open);
}

}  // namespace pgdr::test_size_fields
