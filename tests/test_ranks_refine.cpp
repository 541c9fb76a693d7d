// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs on ranks, and what travels between them: the same mesh in pieces as one process makes, errors on all ranks, damaged
// messages.
#include "pgdr/ranks.hpp"

#include <gtest/gtest.h>

#include <mutex>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "local_ranks.hpp"
#include "parallel_support.hpp"
#include "pgdr/kept_edges.hpp"
#include "ranks/numbering.hpp"
#include "ranks/values.hpp"

namespace pgdr::test_ranks_refine {

using detail::MessageReader;
using detail::MessageWriter;
using test::errors_of_local_ranks;
using test::run_on_local_ranks;

/// An executor that thread sanitizers see through, one thread a rank.
template <int D>
RefineOptions<D> options_for(double size) {
  RefineOptions<D> options;
  options.size = size;
  return test::with<D>(options, test::serial);
}

void expect_same(const MeasureSummary& a, const MeasureSummary& b) {
  EXPECT_EQ(a.least, b.least);
  EXPECT_EQ(a.one_percent, b.one_percent);
  EXPECT_EQ(a.mean, b.mean);
}

void expect_same(const QualityMeasures& a, const QualityMeasures& b) {
  EXPECT_EQ(a.max_radius_edge, b.max_radius_edge);
  EXPECT_EQ(a.min_angle_deg, b.min_angle_deg);
  EXPECT_EQ(a.max_angle_deg, b.max_angle_deg);
  EXPECT_EQ(a.histogram, b.histogram);
  EXPECT_EQ(a.cells_by_smallest_angle, b.cells_by_smallest_angle);
  EXPECT_EQ(a.smallest_angle_quantiles_deg, b.smallest_angle_quantiles_deg);
  expect_same(a.radius_ratio, b.radius_ratio);
  expect_same(a.scaled_jacobian, b.scaled_jacobian);
}

/// What ranks find of the mesh of all their pieces, without any of them having it, to the last bit.
template <int D>
void expect_same_quality(Transport& transport, const RefineResult<D>& alone, const DistributedResult<D>& result) {
  const QualitySummary of_one = summarize_quality(alone.mesh), of_all = summarize_quality(transport, result.piece);
  expect_same(of_one, of_all);
  ASSERT_EQ(of_one.regions.size(), of_all.regions.size());
  for (std::size_t r = 0; r < of_one.regions.size(); ++r) {
    EXPECT_EQ(of_one.regions[r].label, of_all.regions[r].label);
    expect_same(of_one.regions[r], of_all.regions[r]);
  }
  const NotDelaunay by_one = count_not_delaunay(alone.mesh, alone.violations_seen),
                    by_all = count_not_delaunay(transport, result);
  EXPECT_EQ(by_one.rounding, by_all.rounding);
  EXPECT_EQ(by_one.other, by_all.other);
}

template <int D>
void expect_pieces_of_the_same_mesh(const Plc<D>& plc, const RefineOptions<D>& options) {
  const test::Outcome<D> alone = test::refine_and_check<D>(plc, options);
  EXPECT_LE(alone.report.exit_code(), 1) << test::findings(alone.report);
  for (const int ranks : {1, 2, 3, 5}) {
    std::mutex one_at_a_time;
    std::vector<MeshPiece<D>> pieces(static_cast<std::size_t>(ranks));
    run_on_local_ranks(ranks, 7, [&](Transport& transport) {
      DistributedResult<D> result = refine(transport, plc, options);
      const OutputMesh<D> whole = gather(transport, result.piece);
      expect_same_quality(transport, alone.result, result);
      const std::scoped_lock lock(one_at_a_time);
      if (transport.rank() == 0) test::expect_same_mesh(alone.result.mesh, whole);
      EXPECT_TRUE(transport.rank() == 0 || whole.cells.empty());
      result.run.mesh = alone.result.mesh;
      test::expect_same<D>(alone.result, result.run, std::to_string(ranks) + " ranks");
      EXPECT_EQ(result.distributed.ranks, ranks);
      EXPECT_EQ(result.distributed.messages > 0, ranks > 1);
      pieces[static_cast<std::size_t>(transport.rank())] = std::move(result.piece);
    });
    test::expect_same_mesh(alone.result.mesh, join_pieces<D>(pieces));
  }
}

TEST(RefineOnRanks, PiecesAreTheMeshOfOneProcess) {
  Plc<3> named = test::cube();
  named.names = {{{0, "inside"}}, {{0, "walls"}}};
  expect_pieces_of_the_same_mesh<3>(named, options_for<3>(0.3));
  expect_pieces_of_the_same_mesh<2>(test::square_with_hole(), options_for<2>(0.05));
  RefineOptions<3> unimproved = options_for<3>(0.1);
  unimproved.min_dihedral = 0;
  expect_pieces_of_the_same_mesh<3>(test::turned(test::two_region_cube()), unimproved);
}

/// All ranks make the whole of it, by the schedule that they would else share, too.
TEST(RefineOnRanks, AKeptSurfaceIsThatOfOneProcess) {
  const Plc<3> plc = with_kept_edges(test::turned(test::triangles_of(test::l_block())), {});
  for (const Schedule schedule : {Schedule::reproducible, Schedule::uniform}) {
    RefineOptions<3> options = options_for<3>(0.2);
    options.schedule.schedule = schedule;
    options.keep_boundary = true;
    expect_pieces_of_the_same_mesh<3>(plc, options);
  }
}

/// Of meshes whose points, or those on the boundary alone, have been moved a little, so that many faces are not locally Delaunay,
/// within pieces and between them.
template <int D>
void expect_same_counts(const Plc<D>& plc, double size, double by, bool everywhere) {
  RefineOptions<D> options = options_for<D>(size);
  options.min_dihedral = 0;
  OutputMesh<D> mesh = refine(plc, options).mesh;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> move(-by, by);
  std::vector<bool> moves(mesh.points.size(), everywhere);
  for (const auto& wall : mesh.subsegments)
    for (const std::uint32_t v : wall.vertices) moves[v] = true;
  for (const auto& wall : mesh.subfacets)
    for (const std::uint32_t v : wall.vertices) moves[v] = true;
  for (std::size_t v = 0; v < moves.size(); ++v)
    for (double& x : mesh.points[v].x) x += moves[v] ? move(random) : 0;
  const NotDelaunay by_one = count_not_delaunay(mesh, everywhere);
  EXPECT_GT(by_one.other, 50u);
  for (const int ranks : {1, 2, 3, 8})
    run_on_local_ranks(ranks, 3, [&](Transport& transport) {
      DistributedResult<D> result;
      result.piece = piece_of(mesh, static_cast<std::uint64_t>(transport.rank()), static_cast<std::uint64_t>(ranks));
      result.run.violations_seen = everywhere;
      detail::Collectives all(transport);
      result.sharing = detail::sharing_of(all, result.piece);
      const NotDelaunay by_all = count_not_delaunay(transport, result);
      EXPECT_EQ(by_all.rounding, by_one.rounding) << ranks << " ranks";
      EXPECT_EQ(by_all.other, by_one.other) << ranks << " ranks";
    });
}

TEST(RefineOnRanks, FacesThatAreNotDelaunayAreCountedOnce) {
  for (const bool everywhere : {false, true}) {
    expect_same_counts<3>(test::turned(test::two_region_cube()), 0.06, 0.01, everywhere);
    expect_same_counts<2>(test::turned(test::square_with_hole()), 0.0005, 0.003, everywhere);
  }
}

/// Twice on one transport, and an input that only rank 0 has.
TEST(RefineOnRanks, AnInputIsBroadcast) {
  const Plc<3> plc = test::two_region_cube();
  const RefineOptions<3> options = options_for<3>(0.5);
  const test::Outcome<3> alone = test::refine_and_check<3>(plc, options);
  EXPECT_EQ(alone.report.exit_code(), 0) << test::findings(alone.report);
  run_on_local_ranks(3, 1, [&](Transport& transport) {
    for (int time = 0; time < 2; ++time) {
      const Plc<3> own = broadcast(transport, transport.rank() == 0 ? plc : Plc<3>());
      const OutputMesh<3> whole = gather(transport, refine(transport, own, options).piece);
      if (transport.rank() == 0) test::expect_same_mesh(alone.result.mesh, whole);
    }
    EXPECT_EQ(largest_of_ranks(transport, -transport.rank()), 0);
  });
}

template <class E, class Make>
void expect_on_all_ranks(Errc code, Make make_options, const Plc<3>& plc = test::cube()) {
  const std::vector<std::exception_ptr> errors = errors_of_local_ranks(
      3, 1, [&](Transport& transport) { refine(transport, plc, make_options(transport.rank())); });
  for (const std::exception_ptr& error : errors) {
    ASSERT_TRUE(error);
    try {
      std::rethrow_exception(error);
    } catch (const E& e) {
      EXPECT_EQ(e.code(), code) << e.what();
    }
  }
}

TEST(RefineOnRanks, AnErrorOfACallbackOnOneRankComesOutOfAll) {
  expect_on_all_ranks<FileError>(Errc::cannot_open, [](int rank) {
    RefineOptions<3> options = options_for<3>(0.5);
    if (rank == 1)
      options.prepared = [](const Domain<3>&) { throw FileError({.code = Errc::cannot_open, .message = "no sizes"}); };
    return options;
  });
}

TEST(RefineOnRanks, WrongInputsAndOptionsAreErrorsOnAll) {
  Plc<3> open = test::cube();
  open.facets.pop_back();
  expect_on_all_ranks<InputError>(
      Errc::encloses_nothing, [](int) { return options_for<3>(0.5); }, open);
  expect_on_all_ranks<UsageError>(Errc::bad_option, [](int) {
    RefineOptions<3> options = options_for<3>(0.5);
    options.schedule.schedule = Schedule::greedy;
    return options;
  });
}

TEST(RefineOnRanks, RanksThatMakeOtherMeshesAreToldSo) {
  expect_on_all_ranks<ResourceError>(Errc::unlike_ranks, [](int rank) { return options_for<3>(rank == 1 ? 0.3 : 0.5); });
}

/// Where a run is stopped the ranks are at unlike points, or at the end: what the first has is what all get.
TEST(RefineOnRanks, AfterAStopAllHavePiecesOfTheMeshOfTheFirst) {
  std::vector<MeshPiece<3>> pieces(3);
  std::vector<StopCause> causes(3);
  run_on_local_ranks(3, 1, [&](Transport& transport) {
    constexpr int calls_before_stop = 500;
    std::stop_source stop;
    int calls = 0;
    RefineOptions<3> options = options_for<3>(1);
    options.size = [&](const Point3&) {
      if (++calls == calls_before_stop && transport.rank() == 0) stop.request_stop();
      return 0.1;
    };
    options.stop = stop.get_token();
    DistributedResult<3> result = refine(transport, test::cube(), options);
    const auto r = static_cast<std::size_t>(transport.rank());
    causes[r] = result.run.stop;
    pieces[r] = std::move(result.piece);
  });
  EXPECT_EQ(causes, std::vector<StopCause>(3, StopCause::cancelled));
  const OutputMesh<3> whole = join_pieces<3>(pieces);
  const Plc<3> plc = test::cube();
  CheckOptions<3> options;
  options.input = &plc;
  const CheckReport report = check<3>(whole, options);
  EXPECT_EQ(report.exit_code(), 0) << test::findings(report);
}

// Values.

Plc<3> full_plc() {
  Plc<3> plc = test::plate_with_hole();
  plc.point_markers.assign(plc.points.size(), 4);
  plc.point_attributes.assign(2 * plc.points.size(), 0.25);
  plc.segments.push_back({{0, 1}, 9});
  plc.facets[0].holes.push_back({{0.5, 0.5, 0}});
  plc.holes.push_back({{1, 2, 3}});
  plc.regions.push_back({{{0.1, 0.2, 0.3}}, 5, 0.5});
  plc.tolerance = 1e-7;
  plc.is_coarse = plc.are_floats = true;
  plc.first_index = 1;
  plc.source = {"a.poly", {1, 2}, {3}, {4}, {5}, {6}};
  plc.source.parts = {{"b.poly", 3}};
  plc.names = {{{5, "steel"}, {0.5, "air"}}, {{9, "edge"}}};
  plc.facet_bodies.assign(plc.facets.size(), 0);
  plc.body_names = {"plate"};
  return plc;
}

Bytes bytes_of(const Plc<3>& plc) {
  MessageWriter message;
  detail::put_plc(message, plc);
  return message.take();
}

TEST(ValuesOfRanks, AnInputTravelsWhole) {
  const Bytes bytes = bytes_of(full_plc());
  MessageReader message(bytes);
  const Plc<3> copy = detail::get_plc<3>(message);
  EXPECT_TRUE(message.at_end());
  EXPECT_EQ(bytes_of(copy), bytes);
  EXPECT_EQ(copy.tolerance, 1e-7);
  EXPECT_TRUE(copy.is_coarse && copy.are_floats);
  EXPECT_EQ(copy.source.file, "a.poly");
  EXPECT_EQ(copy.source.place(SourceItem::facet, 0).file, "b.poly");
  EXPECT_EQ(copy.names, full_plc().names);
  EXPECT_EQ(copy.body_names, full_plc().body_names);
  EXPECT_EQ(copy.facets.size(), full_plc().facets.size());
}

TEST(ValuesOfRanks, DamagedInputsAreErrors) {
  const Bytes bytes = bytes_of(full_plc());
  const auto read = [](const Bytes& damaged) {
    MessageReader message(damaged);
    detail::get_plc<3>(message);
    message.require_end();
  };
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_THROW(read(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length))), ResourceError);
  std::size_t refused = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    Bytes flipped = bytes;
    flipped[i] ^= std::byte{0x80};
    try {
      read(flipped);  // other values
    } catch (const ResourceError& e) {
      EXPECT_EQ(e.code(), Errc::internal);
      ++refused;
    }
  }
  EXPECT_GT(refused, 8u);  // at least one of the lengths
}

}  // namespace pgdr::test_ranks_refine
