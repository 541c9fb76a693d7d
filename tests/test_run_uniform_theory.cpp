// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Why phases of the uniform schedule may run at once, by brute force: the claims of a phase are disjoint and fill space, and so
// do the windows of all phases; theorem U (plans/uniform.hpp), that no insertion reaches beyond its claim while the bound on
// circumradii holds; and how far apart points have to be to be independent, with those that replace them at the boundary.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "brute_force.hpp"
#include "dimensions.hpp"
#include "graded_trees.hpp"
#include "oracles.hpp"
#include "plans/uniform.hpp"
#include "refined_models.hpp"
#include "run/run_hooks.hpp"

namespace pgdr::test_run_uniform_theory {

using test::BruteForce;

template <class>
class UniformTheory : public testing::Test {};
TYPED_TEST_SUITE(UniformTheory, test::Dimensions);

template <int D>
unsigned parity_of(const Orthtree<D>& tree, std::uint32_t node) {
  unsigned parity = 0;
  for (std::size_t i = 0; i < D; ++i) parity |= (tree.place(node)[i] & 1u) << i;
  return parity;
}

/// The lattice of a level: nodes of half the side of those.
template <int D>
class Lattice {
 public:
  Lattice(const Orthtree<D>& tree, int level)
      : across_(std::size_t{2} << level), unit_(tree.extent(Orthtree<D>::root) / across_), times_(cells()) {}

  /// Counts the cells of the lattice in the box once more. Does the box begin and end with cells?
  void count(const GridBox<D>& box) {
    for (std::size_t cell = 0; cell < times_.size(); ++cell) {
      GridBox<D> part;
      for (std::size_t i = 0; i < D; ++i) {
        part.low[i] = place(cell, i) * unit_;
        part.high[i] = part.low[i] + unit_;
      }
      EXPECT_EQ(box.meets(part), box.holds(part));
      times_[cell] += box.meets(part) ? 1 : 0;
    }
  }
  /// Is it in the outermost layer of the root?
  bool is_outer(std::size_t cell) const {
    for (std::size_t i = 0; i < D; ++i)
      if (place(cell, i) == 0 || place(cell, i) == across_ - 1) return true;
    return false;
  }
  const std::vector<int>& times() const { return times_; }

 private:
  std::size_t cells() const {
    std::size_t n = 1;
    for (int i = 0; i < D; ++i) n *= across_;
    return n;
  }
  std::uint64_t place(std::size_t cell, std::size_t axis) const {
    for (; axis > 0; --axis) cell /= across_;
    return cell % across_;
  }

  std::size_t across_;
  std::uint64_t unit_;
  std::vector<int> times_;
};

TYPED_TEST(UniformTheory, ClaimsOfAPhaseAndWindowsOfAllFillSpace) {
  constexpr int D = TypeParam::value;
  const int finest = D == 2 ? 4 : 3;
  const Orthtree<D> tree = trees::uniform<D>(finest);
  for (int level = 0; level <= finest; ++level) {
    Lattice<D> windows(tree, level);
    for (unsigned parity = 0; parity < 1u << D; ++parity) {
      Lattice<D> claims(tree, level);
      for (std::uint32_t node = 0; node < tree.node_count(); ++node) {
        if (tree.level(node) != level || parity_of(tree, node) != parity) continue;
        claims.count(GridBox<D>::grown(tree, node, tree.extent(node) / 2));
        windows.count(GridBox<D>::grown(tree, node, 0));
      }
      // The outermost layer may be of nodes beyond the root.
      for (std::size_t cell = 0; cell < claims.times().size(); ++cell) {
        EXPECT_LE(claims.times()[cell], 1);
        if (level > 0 && !claims.is_outer(cell)) {
          EXPECT_EQ(claims.times()[cell], 1) << "level " << level;
        }
      }
    }
    EXPECT_TRUE(std::all_of(windows.times().begin(), windows.times().end(), [](int n) { return n == 1; })) << "level " << level;
  }
}

/// Before how many phases it was asked, and before how many a circumradius was over the bound of their nodes.
struct Phases {
  int all = 0, over = 0;
};

/// The uniform schedule, which looks at what theorem U supposes before each phase.
template <int D>
class Watched final : public detail::Planner<D> {
 public:
  Watched(detail::RunState<D>& state, double ratio, Phases& phases)
      : state_(&state), uniform_(state), ratio_(ratio), phases_(&phases) {}

  StopCause stop() override { return uniform_.stop(); }
  std::optional<detail::PlannedVisits<D>> next() override {
    std::optional<detail::PlannedVisits<D>> plan = uniform_.next();
    if (!plan) return plan;
    const std::vector<Visit<D>>& visits = plan->generation.visits;
    for (const Visit<D>& a : visits)
      for (const Visit<D>& b : visits) EXPECT_TRUE(&a == &b || !a.box.meets(b.box));
    const auto node = visits.front().request.node;
    if (uniform_.tree().level(node) > 0) {
      ++phases_->all;
      phases_->over += largest_radius() > ratio_ * uniform_.tree().side(node) / 2 ? 1 : 0;
    }
    return plan;
  }

 private:
  double largest_radius() const {
    const Mesh<D>& mesh = state_->context.mesh;
    double largest = 0;
    for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i)
      if (mesh.alive(CellId{i})) largest = std::max(largest, mesh.squared_radius_bounds(CellId{i}).first);
    return std::sqrt(largest);
  }

  detail::RunState<D>* state_;
  detail::Uniform<D> uniform_;
  double ratio_;
  Phases* phases_;
};

/// @returns what was set aside
template <int D>
std::uint64_t set_aside(const Plc<D>& plc, double size, double split_ratio, bool is_bound_kept, const std::string& what) {
  RefineOptions<D> options;
  options.size = size;
  options.min_dihedral = 0;
  options.schedule.schedule = Schedule::uniform;
  options.schedule.split_ratio = split_ratio;
  options.schedule.floor = 60;
  const auto [result, report] = test::refine_and_check<D>(plc, options);
  EXPECT_EQ(report.exit_code(), 0) << what << "\n" << test::findings(report);
  Phases phases;
  detail::RunHooks<D> hooks;
  hooks.make_schedule = [&](detail::RunState<D>& state, bool) {
    return std::make_unique<detail::PlannedSchedule<D>>(state, std::make_unique<Watched<D>>(state, split_ratio, phases));
  };
  EXPECT_EQ(detail::refine_with<D>(plc, options, hooks).mesh.cells, result.mesh.cells) << what;
  EXPECT_GE(phases.all, D == 2 ? 20 : 8) << what;
  if (is_bound_kept) {
    EXPECT_EQ(phases.over, 0) << what;
  }
  return result.scheduler.set_aside;
}

// It supposes a Delaunay mesh, no encroached boundary when an insertion begins, no circumradius above r, and half of a node's
// side of at least (2 + d) r. Where all angles of the input are 90 degrees or more, and entities without a common point are
// farther apart than cells are large, points on the boundary encroach upon nothing else there. A size that is the same everywhere
// makes what is above r poor, and coarser nodes, which hold that, go first; here it is looked at. So a split ratio of 1/4, in the
// plane of 1/3, keeps all insertions within their claims.
TEST(UniformTheorems, NothingIsSetAsideIfTheMarginIsWideEnough) {
  Plc<2> square;
  square.points = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
  for (std::uint32_t i = 0; i < 4; ++i) square.segments.push_back({{i, (i + 1) % 4}, 0});
  for (const bool is_turned : {false, true}) {
    const Plc<2> plane = is_turned ? test::turned<2>(square) : square;
    EXPECT_EQ(set_aside<2>(plane, 5e-5, 1.0 / 3, true, "square"), 0u);
    EXPECT_GT(set_aside<2>(plane, 5e-5, 4, false, "square, narrow margins"), 0u);
    const auto model = [is_turned](const Plc<3>& plc) { return is_turned ? test::turned<3>(plc) : plc; };
    EXPECT_EQ(set_aside<3>(model(test::cube()), 0.034, 0.25, true, "cube"), 0u);
    EXPECT_EQ(set_aside<3>(model(test::block_with_cavity()), 0.095, 0.25, true, "block with a cavity"), 0u);
    EXPECT_EQ(set_aside<3>(model(test::u_block()), 0.095, 0.25, true, "block in the form of a U"), 0u);
    EXPECT_GT(set_aside<3>(model(test::cube()), 0.06, 4, false, "cube, narrow margins"), 0u);
  }
}

/// A mesh of equal sizes of a square, resp. a plate.
template <int D>
const BruteForce<D>& even_mesh() {
  static const BruteForce<D> brute = [] {
    Plc<D> plc;
    RefineOptions<D> options;
    if constexpr (D == 2) {
      plc.points = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
      for (std::uint32_t i = 0; i < 4; ++i) plc.segments.push_back({{i, (i + 1) % 4}, 0});
      options.size = 0.006;
    } else {
      test::add_box(plc, {{0, 0, 0}}, {{1, 1, 0.6}});
      options.size = 0.2;
    }
    options.min_dihedral = 0;
    const auto outcome = test::refine_and_check<D>(plc, options);
    EXPECT_EQ(outcome.report.exit_code(), 0) << test::findings(outcome.report);
    return BruteForce<D>(outcome.result.mesh);
  }();
  return brute;
}

template <int D>
double largest_radius(const BruteForce<D>& brute) {
  double largest = 0;
  for (std::uint32_t c = 0; c < brute.mesh.cells.size(); ++c) largest = std::max(largest, brute.radius(c));
  return largest;
}

// Theorem 3.2 asks for 4 r. Two are enough, in any dimension: let the cavities of p and q have no cell, but a face in common,
// with the cell A on p's side and B on that of q, and let q be in the ball S of p and the face. The balls through the face are
// ordered by where their centres are on a line towards q's side. S comes after A, in which p is, and after T, that of q and the
// face, as q is in S; T comes before B; and A before B. So a ball from A to B is also one from T to S. It holds p and q, one of
// them in its inside, and the squared radius is a convex function on that line: it is at most r. So p and q are nearer than 2 r;
// as they are where both are in the ball of a common cell.
TYPED_TEST(UniformTheory, PointsTwoRadiiApartAreIndependent) {
  constexpr int D = TypeParam::value;
  const BruteForce<D>& brute = even_mesh<D>();
  const double r = largest_radius(brute);
  std::mt19937_64 random(oracle::seed());
  double farthest = 0;  // of points that are not independent
  int dependent = 0;
  for (int k = 0; k < 1500; ++k) {
    // Mostly at opposite ends of the ball of a cell, or a little beyond.
    const auto& ball = brute.spheres[random() % brute.spheres.size()];
    Point<D> p, q;
    double length2 = 0;
    for (int i = 0; i < D; ++i) {
      p[i] = 2 * oracle::uniform(random) - 1;
      length2 += p[i] * p[i];
    }
    bool is_inside = true;
    const double reach = std::sqrt(ball.squared_radius / length2) * (0.6 + 0.5 * oracle::uniform(random));
    for (int i = 0; i < D; ++i) {
      const double step = reach * p[i], high = D == 3 && i == 2 ? 0.6 : 1;
      p[i] = ball.center[i] - step;
      q[i] = ball.center[i] + step * (0.8 + 0.4 * oracle::uniform(random));
      for (const double x : {p[i], q[i]}) is_inside = is_inside && 0 < x && x < high;
    }
    if (!is_inside || test::are_independent(brute, p, brute.cavity(p), q, brute.cavity(q))) continue;
    ++dependent;
    farthest = std::max(farthest, std::sqrt(squared_distance(p, q)));
  }
  EXPECT_GT(dependent, 100);
  EXPECT_LT(farthest, 2 * r);
  EXPECT_GT(farthest, 1.8 * r) << "2 r are needed";
}

/// The triangulation of a convex polygon, some points and some segments inside, and the midpoints p' and q' of two of them; p and
/// q encroach upon these.
struct Encroached {
  std::vector<Point2> corners, inside;
  std::array<std::array<std::uint32_t, 2>, 2> segments;
  Point2 p, q;
};

struct Distances {
  double given, midpoints;  ///< between p and q, p' and q', in units of r
  bool independent;         ///< p' and q'
};

Distances measure(const Encroached& model) {
  Plc<2> plc;
  plc.points = model.corners;
  plc.points.insert(plc.points.end(), model.inside.begin(), model.inside.end());
  const auto n = static_cast<std::uint32_t>(model.corners.size());
  for (std::uint32_t i = 0; i < n; ++i) plc.segments.push_back({{i, (i + 1) % n}, 0});
  for (const auto& s : model.segments)
    if (std::max(s[0], s[1]) >= n || s[1] != (s[0] + 1) % n) plc.segments.push_back({s, 0});
  RefineOptions<2> options;
  options.refine = false;
  options.radius_edge_bound = 10;
  const auto outcome = test::refine_and_check<2>(plc, options);
  EXPECT_EQ(outcome.report.exit_code(), 0) << test::findings(outcome.report);
  const BruteForce<2> brute(outcome.result.mesh);
  const auto middle = [&](const std::array<std::uint32_t, 2>& s, const Point2& by) {
    EXPECT_TRUE(in_diametral_ball<2>(plc.points[s[0]], plc.points[s[1]], by));
    return diametral_ball<2>(plc.points[s[0]], plc.points[s[1]]).center;
  };
  const Point2 p = middle(model.segments[0], model.p), q = middle(model.segments[1], model.q);
  const double r = largest_radius(brute);
  return {std::sqrt(squared_distance(model.p, model.q)) / r, std::sqrt(squared_distance(p, q)) / r,
          test::are_independent(brute, p, brute.cavity(p), q, brute.cavity(q))};
}

// In the plane a point and the midpoint that replaces it are less than r apart. Points 4 r apart, as of the windows of the
// dissertation, may have midpoints that are nearer than the 4 r of theorem 3.2, but are not nearer than 2 r, and so independent.
// Points 3.5 r apart may not.
TEST(UniformTheorems, MidpointsInPlaceOfPoints) {
  const Encroached strip{{{{-2.05, 0}}, {{-0.25, 0}}, {{0.25, 0}}, {{2.05, 0}}, {{2.05, 1.2}}, {{-2.05, 1.2}}},
                         {{{-1.15, 1.2}}, {{0, 1.2}}, {{1.15, 1.2}}},
                         {{{0, 1}, {2, 3}}},
                         {{-2.04, 0.02}},
                         {{2.04, 0.02}}};
  const Distances apart = measure(strip);
  EXPECT_GE(apart.given, 4);
  EXPECT_LT(apart.midpoints, 4);
  EXPECT_GE(apart.midpoints, 2);
  EXPECT_TRUE(apart.independent);
  const Encroached facing{
      {{{-2.2, 0}}, {{-0.98, -1}}, {{0, -1.02}}, {{0.98, -1}}, {{2.2, 0}}, {{0.98, 1}}, {{0, 1.02}}, {{-0.98, 1}}},
      {},
      {{{1, 7}, {3, 5}}},
      {{-1.97, 0.02}},
      {{1.97, 0.02}}};
  const Distances near = measure(facing);
  EXPECT_GE(near.given, 3.5);
  EXPECT_LT(near.midpoints, 2);
  EXPECT_FALSE(near.independent);
}

}  // namespace pgdr::test_run_uniform_theory
