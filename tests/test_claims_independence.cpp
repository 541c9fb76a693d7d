// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The theory that lets leaves be refined at once (Chernikov, chapter 3), by brute force on finished meshes: the criterion of
// Delaunay-independence (theorem 3.1), that points of leaves outside of each other's buffer zone meet it while the bound on
// circumradii holds, with those that replace them on the boundary (lemmas 3.6 and 3.11), and that insertions keep that
// bound: circumradii do not grow (lemmas 3.2 and 3.9), circumballs stay in the union of the old ones (lemma 3.7).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "brute_force.hpp"
#include "dimensions.hpp"
#include "graded_trees.hpp"
#include "oracles.hpp"
#include "refined_models.hpp"
#include "space/box.hpp"

namespace pgdr::test_claims_independence {

using test::BruteForce;
using test::common;

template <int D>
using Cavity = typename BruteForce<D>::Cavity;

/// The square and the plate reach from 0 to this.
double extent(int axis) { return axis == 2 ? 0.2 : 2; }

/// A square, resp. a plate, finer towards one corner.
template <int D>
OutputMesh<D> graded_mesh(double finest, double growth) {
  Plc<D> plc;
  RefineOptions<D> options;
  if constexpr (D == 2) {
    plc.points = {{{0, 0}}, {{2, 0}}, {{2, 2}}, {{0, 2}}};
    for (std::uint32_t i = 0; i < 4; ++i) plc.segments.push_back({{i, (i + 1) % 4}, 0});
    // The largest circumradius of a triangle of that area at the quality bound is about 1.7 times its root.
    options.size = [=](const Point2& p) {
      const double radius = finest + growth * std::hypot(p[0], p[1]);
      return radius * radius / 2.9;
    };
  } else {
    test::add_box(plc, {{0, 0, 0}}, {{extent(0), extent(1), extent(2)}});
    options.size = [=](const Point3& p) { return finest + growth * std::hypot(p[0], p[1]); };
  }
  options.schedule.executor = Executor::serial;
  options.min_dihedral = 0;  // the definition is one of Delaunay meshes
  const auto outcome = test::refine_and_check<D>(plc, options);
  EXPECT_EQ(outcome.report.exit_code(), 0) << test::findings(outcome.report);
  return outcome.result.mesh;
}

template <int D>
const BruteForce<D>& small_mesh() {
  static const BruteForce<D> brute(graded_mesh<D>(0.08, 0.04));
  return brute;
}

template <int D>
Point<D> random_point(std::mt19937_64& random) {
  Point<D> p;
  for (int i = 0; i < D; ++i) p[i] = oracle::uniform(random) * extent(i);
  return p;
}

template <int D>
Point<D> beside(const Point<D>& p, double distance, std::mt19937_64& random) {
  Point<D> q = p;
  for (int i = 0; i < D; ++i) q[i] = std::clamp(p[i] + distance * (2 * oracle::uniform(random) - 1), 1e-3, extent(i) - 1e-3);
  return q;
}

/// The subfacets and subsegments whose smallest ball holds p, and the points that would replace it: their centres.
template <int D>
std::vector<Point<D>> replacements(const OutputMesh<D>& mesh, const Point<D>& p) {
  std::vector<Point<D>> centres;
  const auto segments = [&](const Point<D>& x) {
    for (const auto& s : mesh.subsegments) {
      const Point<D>&a = mesh.points[s.vertices[0]], &b = mesh.points[s.vertices[1]];
      if (in_diametral_ball<D>(a, b, x)) centres.push_back(diametral_ball<D>(a, b).center);
    }
  };
  segments(p);
  if constexpr (D == 3) {
    for (const auto& f : mesh.subfacets) {
      const auto ball = equatorial_ball(mesh.points[f.vertices[0]], mesh.points[f.vertices[1]], mesh.points[f.vertices[2]]);
      if (!in_equatorial_ball(ball, p)) continue;
      centres.push_back(ball.center);
      segments(ball.center);
    }
  }
  return centres;
}

template <class>
class Independence : public testing::Test {};
TYPED_TEST_SUITE(Independence, test::Dimensions);

/// Does inserting both at once, each into its own cavity, make a conforming Delaunay mesh? The cells must fill the cavities'
/// union once, and no new circumball may hold a point.
template <int D>
bool can_be_inserted_at_once(const BruteForce<D>& brute, const Point<D>& p, const Cavity<D>& of_p, const Point<D>& q,
                             const Cavity<D>& of_q) {
  oracle::Rational surplus = 0;  // of the new cells' volume
  const auto count = [&](const Simplex<D>& s, int sign) { surplus += sign * abs(oracle::orient_det<D>(s)); };
  std::vector<std::uint32_t> gone;
  std::set_union(of_p.cells.begin(), of_p.cells.end(), of_q.cells.begin(), of_q.cells.end(), std::back_inserter(gone));
  for (const auto c : gone) count(brute.cell(c), -1);
  bool empty = true;
  for (const auto& [x, cavity, other] : {std::tuple(&p, &of_p, &q), std::tuple(&q, &of_q, &p)})
    for (const auto& f : cavity->boundary) {
      const auto s = brute.join(*x, f);
      if (!s) continue;
      count(*s, 1);
      empty = empty && in_sphere_perturbed<D>(*s, *other) == Sign::negative;
      const auto ball = circumsphere<D>(*s);
      for (std::uint32_t v = 0; v < brute.mesh.points.size() && empty; ++v) {
        const Point<D>& m = brute.mesh.points[v];
        if (squared_distance(ball.center, m) > ball.squared_radius * (1 + 1e-6)) continue;
        if (std::find(f.begin(), f.end(), v) != f.end()) continue;
        empty = in_sphere_perturbed<D>(*s, m) == Sign::negative;
      }
    }
  return empty && surplus.sign() == 0;
}

TYPED_TEST(Independence, CriterionIsThatOfTheDefinition) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(oracle::seed());
  const BruteForce<D>& brute = small_mesh<D>();
  int independent = 0, cavities_apart = 0;
  const int pairs = 300;
  for (int k = 0; k < pairs; ++k) {
    const Point<D> p = beside(random_point<D>(random), 0.0, random), q = beside(p, 0.03 + 0.015 * (k % 25), random);
    const Cavity<D> of_p = brute.cavity(p), of_q = brute.cavity(q);
    const bool want = can_be_inserted_at_once(brute, p, of_p, q, of_q);
    EXPECT_EQ(are_independent(brute, p, of_p, q, of_q), want);
    EXPECT_EQ(are_independent(brute, q, of_q, p, of_p), want);
    independent += want;
    cavities_apart += common(of_p.cells, of_q.cells).empty();
  }
  EXPECT_GT(independent, pairs / 10);
  EXPECT_LT(cavities_apart, pairs * 9 / 10);
}

/// A tree that the mesh allows by the theory's rule: a node is split while every circumball that meets it is smaller than
/// 1/8 (1/12 in space) of its side, so that each leaf that has a parent meets the bound of 1/4 (1/6).
template <int D>
class ProvedTree {
 public:
  static constexpr double bound = D == 2 ? 0.25 : 1.0 / 6;

  explicit ProvedTree(const BruteForce<D>& b) : brute(b), tree(over(b.mesh.points)) {
    for (std::vector<Node> todo{Orthtree<D>::root}; !todo.empty();) {
      const Node node = todo.back();
      todo.pop_back();
      const double most = largest_radius_at(node);
      if (most == 0 || most >= bound * tree.side(node) / 2) continue;
      const Node first = tree.split(node);
      for (Node child = first; child < first + Orthtree<D>::children; ++child) todo.push_back(child);
    }
  }
  using Node = typename Orthtree<D>::Node;

  /// Of the circumballs that meet the node; 0 if none does.
  double largest_radius_at(Node node) const {
    const auto box = tree.box(node);
    double most = 0;
    for (std::uint32_t c = 0; c < brute.mesh.cells.size(); ++c) {
      double d2 = 0;
      for (int i = 0; i < D; ++i) {
        const double x = brute.spheres[c].center[i], beyond = std::max({box.low[i] - x, 0.0, x - box.high[i]});
        d2 += beyond * beyond;
      }
      if (d2 <= brute.spheres[c].squared_radius * (1 + 1e-6)) most = std::max(most, brute.radius(c) * (1 + 1e-6));
    }
    return most;
  }

  const BruteForce<D>& brute;
  Orthtree<D> tree;

 private:
  static Orthtree<D> over(const std::vector<Point<D>>& points) {
    const auto box = detail::Box<D>::of(points);
    return Orthtree<D>(box.low, box.high);
  }
};

/// A point that may be inserted, or one of those that replace it, with its cavity.
template <int D>
struct Candidate {
  Point<D> point;
  Cavity<D> cavity;
};

/// The circumcentres in the leaf that are the first and the last along each axis and diagonal, and all that may take their
/// places.
template <int D>
std::vector<Candidate<D>> candidates(const ProvedTree<D>& proved, typename Orthtree<D>::Node leaf) {
  const auto& [mesh, spheres] = std::tie(proved.brute.mesh, proved.brute.spheres);
  const auto whole = detail::Box<D>::of(mesh.points);
  std::vector<Point<D>> centres;
  for (const auto& s : spheres) {
    bool inside = proved.tree.leaf_at(s.center) == leaf;
    for (int i = 0; i < D; ++i) inside = inside && s.center[i] > whole.low[i] && s.center[i] < whole.high[i];
    if (inside) centres.push_back(s.center);
  }
  std::vector<Point<D>> chosen;
  constexpr int diagonals = 1 << (D - 1);
  for (int direction = 0; direction < diagonals + D && !centres.empty(); ++direction) {
    const auto along = [direction](const Point<D>& p) {
      if (direction >= diagonals) return p[direction - diagonals];
      double sum = 0;
      for (int i = 0; i < D; ++i) sum += direction >> i & 1 ? -p[i] : p[i];
      return sum;
    };
    const auto before = [&along](const Point<D>& a, const Point<D>& b) { return along(a) < along(b); };
    const auto [first, last] = std::minmax_element(centres.begin(), centres.end(), before);
    chosen.insert(chosen.end(), {*first, *last});
  }
  for (std::size_t k = 0, n = chosen.size(); k < n; ++k)
    for (const Point<D>& p : replacements<D>(mesh, chosen[k])) chosen.push_back(p);
  std::sort(chosen.begin(), chosen.end(), lex_less<D>);
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  std::vector<Candidate<D>> result;
  for (const Point<D>& p : chosen)
    if (!proved.brute.is_vertex(p)) result.push_back({p, proved.brute.cavity(p)});
  return result;
}

TYPED_TEST(Independence, LeavesBeyondTheBufferZoneAreSeparated) {
  constexpr int D = TypeParam::value;
  const BruteForce<D> brute(graded_mesh<D>(D == 2 ? 0.02 : 0.03, 0.035));
  const ProvedTree<D> proved(brute);
  const auto leaves = proved.tree.leaves();
  std::vector<std::vector<Candidate<D>>> of(proved.tree.node_count());
  std::set<int> levels;
  for (const auto leaf : leaves) {
    EXPECT_LT(proved.largest_radius_at(leaf), ProvedTree<D>::bound * proved.tree.side(leaf));
    of[leaf] = candidates<D>(proved, leaf);
    if (!of[leaf].empty()) levels.insert(proved.tree.level(leaf));
  }
  EXPECT_GE(levels.size(), 2u) << "leaves of different sizes";
  const trees::Boxes<D> boxes(proved.tree);
  std::size_t apart = 0, replaced = 0, dependent_within = 0;
  for (const auto a : leaves) {
    const auto zone = boxes.buffer(a);
    for (const auto b : leaves) {
      if (b == a || of[a].empty() || of[b].empty()) continue;
      for (const auto& p : of[a])
        for (const auto& q : of[b]) {
          const bool independent = are_independent(brute, p.point, p.cavity, q.point, q.cavity);
          if (zone.contains(b)) {
            dependent_within += !independent;
            continue;
          }
          ++apart;
          replaced += proved.tree.leaf_at(p.point) != a || proved.tree.leaf_at(q.point) != b;
          EXPECT_TRUE(independent) << "leaves " << a << " and " << b;
        }
    }
  }
  EXPECT_GT(apart, 10000u);
  EXPECT_GT(replaced, 0u) << "points on the boundary, beyond the leaf of those that they replace";
  EXPECT_GT(dependent_within, 0u) << "neighbours conflict";
}

/// Points that encroach upon nothing.
template <int D>
std::vector<Point<D>> free_points(const BruteForce<D>& brute, int count) {
  std::mt19937_64 random(oracle::seed());
  std::vector<Point<D>> points;
  while (points.size() < static_cast<std::size_t>(count)) {
    // Circumcentres, as they are inserted, and any others.
    Point<D> p = brute.spheres[random() % brute.spheres.size()].center;
    if (points.size() % 2 == 0) p = random_point<D>(random);
    bool inside = true;
    for (int i = 0; i < D; ++i) inside = inside && p[i] > 0 && p[i] < extent(i);
    if (inside && replacements<D>(brute.mesh, p).empty() && !brute.is_vertex(p)) points.push_back(p);
  }
  return points;
}

TYPED_TEST(Independence, CircumradiiDoNotGrow) {
  constexpr int D = TypeParam::value;
  const BruteForce<D>& brute = small_mesh<D>();
  std::map<std::uint32_t, oracle::Rational> radii;
  const auto radius2 = [&](std::uint32_t c) {
    auto [r, fresh] = radii.try_emplace(c);
    if (fresh) r->second = oracle::circumsphere<D>(brute.cell(c)).squared_radius;
    return r->second;
  };
  int at_the_hull = 0;
  for (const Point<D>& p : free_points<D>(brute, 60))
    for (const auto& f : brute.cavity(p).boundary) {
      const auto s = brute.join(p, f);
      ASSERT_TRUE(s);
      // Across a face of the hull there is no second cell, and the first alone bounds it.
      oracle::Rational old = 0;
      for (const auto c : brute.cells_at(f)) old = std::max(old, radius2(c));
      at_the_hull += brute.cells_at(f).size() == 1;
      EXPECT_LE(oracle::circumsphere<D>(*s).squared_radius, old);
    }
  EXPECT_GT(at_the_hull, 0);
}

TYPED_TEST(Independence, CircumballsStayInTheUnionOfTheOld) {
  constexpr int D = TypeParam::value;
  const BruteForce<D>& brute = small_mesh<D>();
  std::mt19937_64 random(oracle::seed());
  int samples = 0, in_one_alone = 0;
  for (const Point<D>& p : free_points<D>(brute, 60))
    for (const auto& f : brute.cavity(p).boundary) {
      const auto& old = brute.cells_at(f);
      if (old.size() == 1) continue;
      const auto s = brute.join(p, f);
      ASSERT_TRUE(s);
      const auto ball = circumsphere<D>(*s);
      for (int k = 0; k < 40; ++k) {
        // Near the sphere, where it could stick out.
        Point<D> x = ball.center;
        Point<D> direction;
        double length2 = 0;
        for (int i = 0; i < D; ++i) {
          direction[i] = 2 * oracle::uniform(random) - 1;
          length2 += direction[i] * direction[i];
        }
        for (int i = 0; i < D; ++i) x[i] += direction[i] * std::sqrt(ball.squared_radius / length2) * (k % 4 ? 1 - 1e-9 : 0.9);
        if (in_sphere<D>(*s, x) != Sign::positive) continue;
        ++samples;
        int holders = 0;
        for (const auto c : old) holders += in_sphere<D>(brute.cell(c), x) != Sign::negative;
        in_one_alone += holders == 1;
        EXPECT_GT(holders, 0);
      }
    }
  EXPECT_GT(samples, 1000);
  EXPECT_GT(in_one_alone, samples / 10) << "the union is needed";
}

}  // namespace pgdr::test_claims_independence
