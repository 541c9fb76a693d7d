// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The uniform algorithm as the dissertation has it (section 3.2, figures 3.5 and 3.6), in the plane: P blocks of 16 r beside each
// other, with r = l / (16 sqrt P) of the longest side l, windows of the inner 12 r, which are refined one after the other as if
// by as many processes, and phases between which blocks and windows are shifted by 8 r along an axis. A visit of a window changes
// its block alone. Its margin is 2 r, where theorem U (plans/uniform.hpp) asks for 3 r at the boundary; so what would change
// other cells may come up there, and nowhere else. It is set aside for the end of a cycle.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "planar_plcs.hpp"
#include "refined_models.hpp"
#include "run/run_hooks.hpp"

namespace pgdr::test_run_uniform_text {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A half-open square.
struct Square {
  Point2 low;
  double side;
  Square grown(double by) const { return {{{low[0] - by, low[1] - by}}, side + 2 * by}; }
  Point2 high() const { return {{low[0] + side, low[1] + side}}; }
  bool contains(const Point2& p) const {
    return low[0] <= p[0] && p[0] < low[0] + side && low[1] <= p[1] && p[1] < low[1] + side;
  }
};
constexpr Square plane{{{-1e6, -1e6}}, 2e6};  ///< all that there is

/// Treats what has its circumcentre in the window, and owns what has all vertices in the block.
class WindowArea final : public VisitArea<2> {
 public:
  WindowArea(const Square& window, const Square& block) {
    home_low = window.low;
    home_high = window.high();
    inner_low = block.low;
    inner_high = block.high();
  }
  bool claimed(const Point2&) const override { return false; }
  std::uint32_t node_of(const Point2&, double) const override { return 0; }
};

/// What came of it.
struct Counts {
  std::uint64_t coarse = 0, in_windows = 0, at_the_end = 0;  ///< insertions: before the windows; there; of what was set aside
  std::uint64_t set_aside = 0, far_from_boundary = 0;        ///< the latter: of these, farther from it than r
  int cycles = 0;
};

/// See above.
class TextSchedule final : public detail::VisitSchedule<2> {
 public:
  /// The domain is shared out among blocks x blocks processes. `margin`: of a window, in units of r.
  TextSchedule(detail::RunState<2>& state, int blocks, double margin, Counts& counts)
      : state_(&state), blocks_(blocks), margin_(margin), counts_(&counts) {
    for (const Point2& p : state.context.domain.points())
      for (int i = 0; i < 2; ++i) {
        low_[i] = std::min(low_[i], p[i]);
        high_[i] = std::max(high_[i], p[i]);
      }
    r_ = std::max(high_[0] - low_[0], high_[1] - low_[1]) / (16 * blocks);
  }

  StopCause drain() override {
    state_->waiting[Orthtree<2>::root].list.drain([this](const Entry<2>& e) { waiting_.push_back(e); });
    counts_->coarse += visit(plane, plane, r_);
    expect_small_cells();
    while (!waiting_.empty()) {
      ++counts_->cycles;
      for (const double shift_y : {0.0, 8 * r_})
        for (const double shift_x : {0.0, 8 * r_}) phase(shift_x, shift_y);
      counts_->set_aside += set_aside_.size();
      waiting_.insert(waiting_.end(), set_aside_.begin(), set_aside_.end());
      if (!set_aside_.empty() || counts_->cycles > 20) counts_->at_the_end += visit(plane, plane, 0);
      set_aside_.clear();
    }
    return StopCause::finished;
  }

 private:
  /// The windows that are refined at once.
  void phase(double shift_x, double shift_y) {
    for (int y = -1; y < blocks_; ++y)
      for (int x = -1; x < blocks_; ++x) {
        const Square block{{{low_[0] + 16 * r_ * x + shift_x, low_[1] + 16 * r_ * y + shift_y}}, 16 * r_};
        counts_->in_windows += visit(block.grown(-margin_ * r_), block, 0);
      }
  }

  /// Treats what waits in the window, until no poor element is larger than `small_radius`. @returns the insertions
  std::uint64_t visit(const Square& window, const Square& block, double small_radius) {
    const auto& context = state_->context;
    WorkList<2> list;
    const auto is_elsewhere = [&](const Entry<2>& e) { return !window.contains(context.place_of(e.cell)); };
    std::erase_if(waiting_, [&](const Entry<2>& e) { return !e.alive(context.mesh); });
    const auto first = std::stable_partition(waiting_.begin(), waiting_.end(), is_elsewhere);
    for (auto e = first; e != waiting_.end(); ++e) list.push(*e);
    waiting_.erase(first, waiting_.end());
    NodeVisit<2> visit;
    visit.list = &list;
    visit.small_radius = small_radius;
    visit.floor = small_radius > 0 ? 0 : std::numeric_limits<std::size_t>::max();
    EXPECT_TRUE(state_->workers.run(WindowArea(window, block), visit));
    state_->totals.add(visit);
    EXPECT_TRUE(list.refused.empty());
    list.drain([this](const Entry<2>& e) { waiting_.push_back(e); });
    for (const auto& box : visit.outboxes) waiting_.insert(waiting_.end(), box.entries.begin(), box.entries.end());
    for (const Entry<2>& e : visit.set_aside) {
      if (!e.alive(context.mesh)) continue;
      set_aside_.push_back(e);
      counts_->far_from_boundary += distance_to_boundary(context.place_of(e.cell)) > r_ ? 1 : 0;
    }
    return visit.counts.committed;
  }

  /// After the coarse stage: the invariant of theorem 3.3.
  void expect_small_cells() const {
    const Mesh<2>& mesh = state_->context.mesh;
    for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i)
      if (mesh.alive(CellId{i})) {
        EXPECT_LE(std::sqrt(mesh.squared_radius_bounds(CellId{i}).first), r_);
      }
  }

  /// To the nearest segment of the input.
  double distance_to_boundary(const Point2& p) const {
    const Domain<2>& domain = state_->context.domain;
    double nearest = infinity;
    for (const auto& s : domain.segments()) {
      const Point2 &a = domain.points()[s.points[0]], &b = domain.points()[s.points[1]];
      const double dx = b[0] - a[0], dy = b[1] - a[1];
      const double t = std::clamp(((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
      nearest = std::min(nearest, std::hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy));
    }
    return nearest;
  }

  detail::RunState<2>* state_;
  int blocks_;
  double margin_;
  Counts* counts_;
  Point2 low_{{infinity, infinity}}, high_{{-infinity, -infinity}};
  double r_;
  std::vector<Entry<2>> waiting_, set_aside_;
};

/// Makes the mesh, and checks it. `size`: an area, small in units of r.
Counts expect_sound(const Plc<2>& plc, int blocks, double margin, double size, const std::string& what) {
  RefineOptions<2> options;
  options.size = size;
  options.schedule.executor = Executor::serial;
  Counts counts;
  detail::RunHooks<2> hooks;
  hooks.make_schedule = [&](detail::RunState<2>& state, bool) {
    return std::make_unique<TextSchedule>(state, blocks, margin, counts);
  };
  const RefineResult<2> result = detail::refine_with<2>(plc, options, hooks);
  EXPECT_EQ(result.stop, StopCause::finished) << what;
  EXPECT_EQ(result.poor_left, 0u) << what;
  CheckOptions<2> check_options;
  check_options.input = &plc;
  check_options.tolerance = result.tolerance;
  check_options.radius_edge_bound = options.radius_edge_bound;
  check_options.size = options.size;
  check_options.delaunay = true;
  const CheckReport report = check<2>(result.mesh, check_options);
  EXPECT_EQ(report.exit_code(), 0) << what << "\n" << test::findings(report);
  EXPECT_GT(counts.in_windows, 5 * counts.coarse) << what;
  EXPECT_EQ(result.statistics.insertions_committed, counts.coarse + counts.in_windows + counts.at_the_end);
  return counts;
}

class UniformOfTheText : public testing::TestWithParam<int> {};

TEST_P(UniformOfTheText, EndsWithADelaunayMesh) {
  const int blocks = GetParam();
  Plc<2> square;
  test::add_square(square, 0, 1);
  Plc<2> with_walls = square;  // inside, at right angles to the boundary
  for (std::uint32_t i = 1; i <= 4; ++i) {
    with_walls.points.push_back({{0.2 * i, 0}});
    with_walls.points.push_back({{0.2 * i, 0.9}});
    test::add_segment(with_walls, 2 * i + 2, 2 * i + 3);
  }
  const std::pair<const char*, Plc<2>> inputs[] = {{"square", square},
                                                   {"square, turned", test::turned<2>(square)},
                                                   {"walls", with_walls},
                                                   {"walls, turned", test::turned<2>(with_walls)}};
  const double r = 1.0 / (16 * blocks);
  for (const auto& [name, plc] : inputs) {
    const Counts text = expect_sound(plc, blocks, 2, r * r / 20, name);
    EXPECT_LE(text.cycles, 3) << name;
    EXPECT_EQ(text.far_from_boundary, 0u) << name;
    EXPECT_LT(text.set_aside, 1 + text.in_windows / 100) << name;
    const Counts narrow = expect_sound(plc, blocks, 0.1, r * r / 20, std::string(name) + ", narrow margins");
    EXPECT_GT(narrow.far_from_boundary, 0u) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Blocks, UniformOfTheText, testing::Values(2, 3));

}  // namespace pgdr::test_run_uniform_text
