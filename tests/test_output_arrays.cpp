// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What embedding programs hand over: arrays of other types, lengths that do not fit, options that cannot be, a Domain that was
// moved from, calls for almost nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model_plcs.hpp"
#include "pgdr/check.hpp"
#include "pgdr/diagnosis.hpp"
#include "pgdr/flat_arrays.hpp"
#include "pgdr/refine.hpp"

namespace pgdr::test_output_arrays {

template <class F>
std::string words_of(Errc code, const F& f) {
  try {
    f();
  } catch (const Error& e) {
    EXPECT_EQ(name(e.code()), name(code)) << e.what();
    return e.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

constexpr double corners[] = {0, 0, 1, 0, 1, 1, 0, 1};
constexpr std::uint32_t sides[] = {0, 1, 1, 2, 2, 3, 3, 0};
Plc<2> square() { return plc_from_arrays<2>(corners, sides); }

template <class Coordinate, class Index>
void expect_square() {
  const std::vector<Coordinate> xy(std::begin(corners), std::end(corners));
  const std::vector<Index> indices(std::begin(sides), std::end(sides));
  const Plc<2> plc = plc_from_arrays<2>(xy, indices, std::vector<int>{1, 2, 3, 4}), expected = square();
  EXPECT_EQ(plc.points, expected.points);
  EXPECT_EQ(plc.are_floats, (std::is_same_v<Coordinate, float>));
  ASSERT_EQ(plc.segments.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(plc.segments[i].points, expected.segments[i].points);
    EXPECT_EQ(plc.segments[i].marker, static_cast<int>(i) + 1);
  }
  const std::vector<Index> triangle = {0, 1, 2};
  EXPECT_EQ(mesh_from_arrays<2>(xy, triangle).cells, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}}));
}

TEST(Arrays, OfFloatsAndOfOtherIntegers) {
  expect_square<double, std::uint32_t>();
  expect_square<double, std::int32_t>();
  expect_square<double, std::int64_t>();
  expect_square<float, std::uint64_t>();
  expect_square<float, std::int32_t>();
  EXPECT_TRUE(plc_from_arrays<3>({}, {}).points.empty());
}

TEST(Arrays, IndicesOutOfRange) {
  const std::vector<std::int32_t> negative = {0, -1};
  EXPECT_NE(words_of(Errc::index_out_of_range, [&] { plc_from_arrays<2>(corners, negative); }).find("has index -1"),
            std::string::npos);
  const std::vector<std::int64_t> far = {0, (std::int64_t{1} << 32) + 1};
  words_of(Errc::index_out_of_range, [&] { plc_from_arrays<2>(corners, far); });
  const std::vector<std::uint64_t> beyond = {0, 4};
  words_of(Errc::index_out_of_range, [&] { plc_from_arrays<2>(corners, beyond); });
}

template <class Mesh>
concept CanBeSeen = requires(Mesh mesh) {
  flat_points(std::forward<Mesh>(mesh));
};

TEST(Arrays, ViewsOfWhatEndsDoNotCompile) {
  static_assert(CanBeSeen<OutputMesh<2>&> && CanBeSeen<const OutputMesh<3>&>);
  static_assert(!CanBeSeen<OutputMesh<2>> && !CanBeSeen<const OutputMesh<3>>);
}

TEST(Embedding, LengthsAndOptionsThatCannotBe) {
  const auto refused = [](const auto& change) {
    return words_of(Errc::bad_option, [&] {
      Plc<2> plc = square();
      RefineOptions<2> options;
      change(plc, options);
      refine(plc, options);
    });
  };
  refused([](Plc<2>& plc, RefineOptions<2>&) { plc.point_markers = {1, 2}; });
  refused([](Plc<2>& plc, RefineOptions<2>&) { plc.point_attributes = {1, 2, 3}; });
  refused([](Plc<2>&, RefineOptions<2>& o) { o.max_volume = 1e-3; });
  refused([](Plc<2>&, RefineOptions<2>& o) { o.schedule.threads = -1; });
  refused([](Plc<2>&, RefineOptions<2>& o) { o.schedule.granularity = 0; });
  refused([](Plc<2>&, RefineOptions<2>& o) { o.min_edge = std::nan(""); });
  refused([](Plc<2>&, RefineOptions<2>& o) { o.radius_edge_bound = std::nan(""); });
  refused([](Plc<2>&, RefineOptions<2>& o) { o.disk.delta = std::nan(""); });
}

TEST(Embedding, BadSizesAreNamedWithAllDigits) {
  Plc<2> plc = square();
  for (Point2& p : plc.points)
    for (double& x : p.x) x *= 1e-9;
  RefineOptions<2> options;
  options.size = [](const Point2& x) { return x[0] - 5e-10; };
  const std::string words = words_of(Errc::bad_size, [&] { refine(plc, options); });
  EXPECT_NE(words.find("e-1"), std::string::npos) << words;
  EXPECT_EQ(words.find("0.000000"), std::string::npos) << words;
}

TEST(Embedding, ADomainThatWasMovedFromIsEmpty) {
  Domain<2> domain(square());
  const Domain<2> moved = std::move(domain);
  EXPECT_FALSE(refine(moved, RefineOptions<2>{}).mesh.cells.empty());
  EXPECT_TRUE(domain.points().empty() && domain.segments().empty() && domain.point_of_input().empty());
  words_of(Errc::bad_option, [&] { refine(domain, RefineOptions<2>{}); });
  EXPECT_EQ(diagnose(domain, {}).error_count(), 0u);
}

TEST(Embedding, MinAngle) {
  EXPECT_NEAR(min_angle_degrees(30), 1, 1e-15);
  EXPECT_NEAR(min_angle_degrees(60), 1 / std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(min_angle_degrees(20.704811054635428), std::sqrt(2.0), 1e-14);
  for (double degrees = 0.25; degrees <= 60; degrees += 0.25)
    EXPECT_NEAR(min_angle_degrees(degrees) * 2 * std::sin(degrees * std::numbers::pi / 180), 1, 4e-16) << degrees;
  for (const double degrees : {0.0, -1.0, 60.1, std::nan("")}) words_of(Errc::bad_option, [&] { min_angle_degrees(degrees); });
}

/// A mesh that begins on the heap, and one that leaves it on the way, are those that any other start makes.
TEST(Embedding, SmallMeshesGrow) {
  for (const double size : {1.0, 0.1, 0.01, 0.004, 0.001, 0.0002}) {
    RefineOptions<2> options;
    options.size = size;
    options.schedule.executor = Executor::serial;
    const RefineResult<2> expected = refine(test::square_with_hole(), options);
    EXPECT_EQ(expected.poor_left, 0u);
    const Plc<2> plc = test::square_with_hole();
    const Domain<2> domain(plc);
    CheckOptions<2> check_options;
    check_options.input = &plc;
    check_options.size = options.size;
    check_options.delaunay = true;
    EXPECT_EQ(check(expected.mesh, check_options).exit_code(), 0);
    options.schedule.floor = 10;
    for (const Executor executor : {Executor::flow_graph, Executor::threads, Executor::shuffled}) {
      RefineOptions<2> others = options;
      others.schedule.threads = 2;
      others.schedule.executor = Executor::serial;
      const RefineResult<2> serial = refine(domain, others);
      others.schedule.executor = executor;
      const RefineResult<2> result = refine(domain, others);
      EXPECT_EQ(result.mesh.cells, serial.mesh.cells) << size;
      EXPECT_EQ(result.mesh.points, serial.mesh.points) << size;
    }
    options.schedule.schedule = Schedule::greedy;
    EXPECT_EQ(check(refine(domain, options).mesh, check_options).exit_code(), 0);
  }
}

}  // namespace pgdr::test_output_arrays
