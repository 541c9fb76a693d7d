// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The uniform schedule on ranks where it is hard: what is refused, late, or ends a run; callbacks that throw or say other things
// on one rank; ranks that vanish. All ranks end, with the mesh of one process or the same error.
#include <gtest/gtest.h>

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "domain_plcs.hpp"
#include "model_plcs.hpp"
#include "pgdr/selectors.hpp"
#include "planar_plcs.hpp"
#include "scattered_models.hpp"
#include "uniform_on_ranks.hpp"

namespace pgdr::test_ranks_hard {

using test::errors_of_local_ranks;
using test::expect_on_ranks;
using test::uniform_options;

constexpr double fine = 0.0003;  // area; the square is cut for three ranks

template <int D>
struct Hard {
  std::string name;
  Plc<D> plc;
  RefineOptions<D> options;
};

template <int D>
class HardModels {
 public:
  RefineOptions<D>& add(std::string name, Plc<D> plc, double size) {
    all_.push_back({std::move(name), std::move(plc), uniform_options<D>(size)});
    return all_.back().options;
  }
  std::vector<Hard<D>> take() { return std::move(all_); }

 private:
  std::vector<Hard<D>> all_;
};

/// What runs end with on rank 0, each for its own reason, and what they do not.
std::vector<Hard<2>> planars() {
  HardModels<2> all;
  // Elements as large as a side, which wait for nodes above the cut.
  all.add("boundary_kept", test::square_with_hole(), 0.001).keep_boundary = true;
  all.add("with_leaves", test::square(), fine).leaves = true;
  all.add("shortest_edge", test::square(), fine).min_edge = 0.02;
  for (const std::uint64_t most : {200, 1000, 1400, 2200})
    all.add("budget_" + std::to_string(most), test::square(), fine).max_vertices = most;
  all.add("given_lattice", test::square(), fine).schedule.lattice = 5;
  all.add("varying", test::square_with_hole(), 1).size = [](const Point2& p) { return 0.0008 + 0.002 * p[0]; };
  all.add("off_center", test::square_with_hole(), 0.002).selector = off_center<2>();
  all.add("far", test::turned(test::square_with_hole(), 1e7), 0.002);
  all.add("pairs", test::box_with_pairs<2>(6, 1e-3, 5), 0.0005);
  for (const std::uint64_t seed : {0, 10, 11})
    all.add("graph_" + std::to_string(seed), test::random_graph(40, 30, seed % 2 ? 64 : 0, seed), 0.002);
  for (const std::uint64_t seed : {0, 4})
    all.add("fan_" + std::to_string(seed), test::fan(9, 1.0 + static_cast<double>(seed), seed), 0.004);
  return all.take();
}

std::vector<Hard<3>> solids() {
  HardModels<3> all;
  constexpr double side = 0.06;
  all.add("with_leaves", test::cube(), side).leaves = true;
  all.add("shortest_edge", test::cube(), side).min_edge = 0.04;
  for (const std::uint64_t most : {200, 4200, 4300})
    all.add("budget_" + std::to_string(most), test::cube(), side).max_vertices = most;
  all.add("given_lattice", test::cube(), side).schedule.lattice = 4;
  all.add("varying", test::l_block(), 1).size = [](const Point3& p) { return 0.08 + 0.04 * p[0]; };
  all.add("off_center", test::turned(test::two_region_cube()), 0.07).selector = off_center<3>();
  all.add("pairs", test::box_with_pairs<3>(4, 1e-3, 5), 0.06);
  // Much that waits for the end dies before. What is gone lost its order once, so that of equal elements another went first.
  all.add("many_pairs", test::box_with_pairs<3>(40, 1e-3, 5), 1).schedule.lattice = 4;
  all.add("small_angle", test::prism({{{0, 0}}, {{2, 0}}, {{2, 0.3}}}, 1), 0.05);
  all.add("optimised", test::l_block(), 0.1).min_dihedral = 12;
  return all.take();
}

/// On one rank, some, and more; the run of one process first. `is_tiny`: it ends before a cut would pay.
template <int D>
void expect_same_mesh_on_ranks(const Hard<D>& hard, bool is_tiny) {
  RefineOptions<D> options = hard.options;
  const RefineResult<D> alone = test::checked_alone<D>(hard.plc, options);
  std::uint64_t cut = 0;
  for (const int ranks : {1, 3, 5}) {
    options.schedule.threads = ranks == 3 ? 2 : 1;
    cut += expect_on_ranks<D>(hard.plc, options, alone, ranks, static_cast<std::uint64_t>(ranks)).cut_cells;
  }
  EXPECT_EQ(cut > 0, !is_tiny);
}

class HardOnRanks : public testing::TestWithParam<Hard<2>> {};
TEST_P(HardOnRanks, SameMesh) { expect_same_mesh_on_ranks<2>(GetParam(), GetParam().name == "budget_200"); }
INSTANTIATE_TEST_SUITE_P(Models, HardOnRanks, testing::ValuesIn(planars()), [](const auto& info) { return info.param.name; });

class HardSolidsOnRanks : public testing::TestWithParam<Hard<3>> {};
TEST_P(HardSolidsOnRanks, SameMesh) { expect_same_mesh_on_ranks<3>(GetParam(), GetParam().name == "budget_200"); }
INSTANTIATE_TEST_SUITE_P(Models, HardSolidsOnRanks, testing::ValuesIn(solids()),
                         [](const auto& info) { return info.param.name; });

TEST(OrdersOnRanks, MessagesMayComeInAny) {
  RefineOptions<2> options = uniform_options<2>(fine);
  const RefineResult<2> alone = test::checked_alone<2>(test::square(), options);
  for (std::uint64_t seed = 0; seed < 40; ++seed)
    EXPECT_GT(expect_on_ranks<2>(test::square(), options, alone, 3, seed).cut_cells, 0u);
  for (const int ranks : {16, 50}) expect_on_ranks<2>(test::square(), options, alone, ranks, 1);
}

// Failures. Runs with leaves end with a gather.

/// What each rank ends with, if size(rank, calls so far) is the size.
template <class Size>
std::vector<std::exception_ptr> errors_with(Size size) {
  return errors_of_local_ranks(3, 1, [&](Transport& transport) {
    RefineOptions<2> options = test::with<2>(uniform_options<2>(fine), test::serial);
    options.leaves = true;
    std::uint64_t calls = 0;
    options.size = [&, rank = transport.rank()](const Point2&) { return size(rank, ++calls); };
    refine(transport, test::square(), options);
  });
}

/// How often each rank asks for a size in a run that ends well.
std::vector<std::uint64_t> calls_of_ranks() {
  std::vector<std::uint64_t> calls(3);
  for (const auto& error :
       errors_with([&](int rank, std::uint64_t n) { return calls[static_cast<std::size_t>(rank)] = n, fine; }))
    EXPECT_FALSE(error);
  return calls;
}

TEST(FailuresOnRanks, WhatASizeFunctionThrowsOnOneRankAllThrow) {
  const std::vector<std::uint64_t> calls = calls_of_ranks();
  for (const int thrower : {0, 1, 2})
    for (const std::uint64_t percent : {1, 20, 35, 50, 65, 80, 95, 100}) {
      const std::uint64_t moment = std::max<std::uint64_t>(1, calls[static_cast<std::size_t>(thrower)] * percent / 100);
      const auto errors = errors_with([&](int rank, std::uint64_t n) {
        if (rank == thrower && n == moment) throw FileError({.code = Errc::cannot_open, .message = "no sizes"});
        return fine;
      });
      for (const std::exception_ptr& error : errors) {
        ASSERT_TRUE(error) << thrower << " at " << percent << " %";
        EXPECT_THROW(std::rethrow_exception(error), FileError) << thrower << " at " << percent << " %";
      }
    }
}

TEST(FailuresOnRanks, ARankWithoutMemoryEndsAll) {
  const std::vector<std::uint64_t> calls = calls_of_ranks();
  for (const std::uint64_t percent : {5, 60, 95}) {
    const auto errors = errors_with([&](int rank, std::uint64_t n) {
      if (rank == 1 && n >= calls[1] * percent / 100) throw std::bad_alloc();
      return fine;
    });
    for (const std::exception_ptr& error : errors) {
      ASSERT_TRUE(error) << percent;
      try {
        std::rethrow_exception(error);
      } catch (const std::bad_alloc&) {
      } catch (const ResourceError& e) {
        EXPECT_EQ(e.code(), Errc::out_of_memory);
      }
    }
  }
}

/// The meshes may be the same until the cut, so that nobody sees it.
TEST(FailuresOnRanks, WithOtherSizesOnOneRankAllEnd) {
  for (const double factor : {0.9, 0.01}) {
    const auto errors = errors_with([&](int rank, std::uint64_t) { return rank == 2 ? factor * fine : fine; });
    for (const std::exception_ptr& error : errors) {
      ASSERT_TRUE(error) << factor;
      EXPECT_THROW(std::rethrow_exception(error), ResourceError) << factor;
    }
  }
}

TEST(FailuresOnRanks, AStopOfTheFirstRankLeavesAValidMesh) {
  const std::uint64_t all = calls_of_ranks()[0];
  for (const std::uint64_t percent : {2, 40, 60, 80, 99}) {
    std::vector<MeshPiece<2>> pieces(3);
    std::vector<StopCause> causes(3);
    test::run_on_local_ranks(3, percent, [&](Transport& transport) {
      RefineOptions<2> options = test::with<2>(uniform_options<2>(fine), test::serial);
      options.leaves = true;
      std::stop_source stop;
      std::uint64_t calls = 0;
      options.size = [&](const Point2&) {
        if (++calls == all * percent / 100 && transport.rank() == 0) stop.request_stop();
        return fine;
      };
      options.stop = stop.get_token();
      DistributedResult<2> result = refine(transport, test::square(), options);
      pieces[static_cast<std::size_t>(transport.rank())] = std::move(result.piece);
      causes[static_cast<std::size_t>(transport.rank())] = result.run.stop;
    });
    EXPECT_EQ(causes, std::vector<StopCause>(3, StopCause::cancelled)) << percent;
    const Plc<2> plc = test::square();
    CheckOptions<2> options;
    options.input = &plc;
    const CheckReport report = check<2>(join_pieces<2>(pieces), options);
    EXPECT_TRUE(test::unfinished_but_valid(report)) << percent << "\n" << test::findings(report);
  }
}

/// Fails for good at its n-th message.
class Vanishing final : public Transport {
 public:
  Vanishing(Transport& network, int messages) : network_(&network), left_(messages) {}
  int rank() const override { return network_->rank(); }
  int size() const override { return network_->size(); }
  bool has_failed() const override { return left_ <= 0; }
  int left() const { return left_; }
  void send(int to, std::uint64_t tag, Bytes message) override {
    count();
    network_->send(to, tag, std::move(message));
  }
  Bytes receive(int from, std::uint64_t tag) override {
    count();
    return network_->receive(from, tag);
  }

 private:
  void count() {
    if (--left_ <= 0) throw RankFailure({.code = Errc::rank_failed, .message = "the line is cut"});
  }
  Transport* network_;
  int left_;
};

/// A run whose rank 1 fails at that message. @returns what each rank threw, and how many messages rank 1 has dealt with
std::pair<std::vector<std::exception_ptr>, int> run_until_message(int messages) {
  int used = 0;
  auto errors = errors_of_local_ranks(3, 1, [&](Transport& transport) {
    const RefineOptions<2> options = test::with<2>(uniform_options<2>(fine), test::serial);
    if (transport.rank() != 1) {
      refine(transport, test::square(), options);
      return;
    }
    Vanishing vanishing(transport, messages);
    refine(static_cast<Transport&>(vanishing), test::square(), options);
    used = messages - vanishing.left();
  });
  return {std::move(errors), used};
}

TEST(FailuresOnRanks, ARankThatVanishesEndsAll) {
  const auto [none, all] = run_until_message(1 << 30);
  EXPECT_EQ(none, std::vector<std::exception_ptr>(3));
  ASSERT_GT(all, 50);
  for (const int messages : {1, 3, all / 20, all / 5, all / 2, all - all / 10, all}) {
    const auto errors = run_until_message(messages).first;
    EXPECT_TRUE(errors[1]) << messages;
    for (const std::exception_ptr& error : errors) EXPECT_TRUE(!error || test::is_rank_failure(error)) << messages;
  }
}

}  // namespace pgdr::test_ranks_hard
