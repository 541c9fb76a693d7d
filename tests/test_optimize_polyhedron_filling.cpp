// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Fillings of small polyhedra, against all that there are, and of parts of Delaunay meshes, whose old fillings are known.
#include "optimize/polyhedron_filling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <set>

#include "cavity/delaunay.hpp"
#include "numbers/corners.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::test_optimize_polyhedron_filling {

using Index = Polyhedron::Index;
using Face = Polyhedron::Face;
using Cell = Polyhedron::Cell;
using Cells = std::vector<Cell>;

template <class F>
F smallest_first(F f) {
  std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
  return f;
}
/// Seen from within the cell.
template <class C>
auto face_of(const C& cell, int i) {
  const auto& k = face_corners<3>[static_cast<std::size_t>(i)];
  return smallest_first(std::array{cell[k[0]], cell[k[1]], cell[k[2]]});
}
template <class F>
F turned_over(const F& f) {
  return {f[0], f[2], f[1]};
}
template <class C>
auto rim_of(const std::vector<C>& cells) {
  std::set<decltype(face_of(cells[0], 0))> faces, rim;
  for (const C& c : cells)
    for (int i = 0; i < 4; ++i) faces.insert(face_of(c, i));
  for (const auto& f : faces)
    if (!faces.contains(turned_over(f))) rim.insert(f);
  return rim;
}

Simplex<3> simplex_of(const Polyhedron& p, const Cell& c) {
  return {p.points[c[0]], p.points[c[1]], p.points[c[2]], p.points[c[3]]};
}

double volume6(const Simplex<3>& s) {
  double m[3][3];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) m[i][k] = s[i + 1][k] - s[0][k];
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/// The part of a mesh that these cells are.
Polyhedron polyhedron_of(const std::vector<Point3>& points, std::vector<std::array<int, 4>>& cells) {
  Polyhedron p;
  std::map<int, Index> number;
  for (auto& cell : cells)
    for (int& v : cell) {
      if (number.try_emplace(v, static_cast<Index>(number.size())).second)
        p.points.push_back(points[static_cast<std::size_t>(v)]);
      v = number[v];
    }
  for (const auto& f : rim_of(cells))
    p.faces.push_back({static_cast<Index>(f[0]), static_cast<Index>(f[1]), static_cast<Index>(f[2])});
  for (const auto& c : cells)
    p.volume6 += volume6({p.points[static_cast<std::size_t>(c[0])], p.points[static_cast<std::size_t>(c[1])],
                          p.points[static_cast<std::size_t>(c[2])], p.points[static_cast<std::size_t>(c[3])]});
  return p;
}

struct Part {
  Polyhedron polyhedron;
  Cells cells;  ///< its Delaunay filling
};

/// Delaunay meshes of random points, or of points of a small grid, and parts of them.
class Meshes {
 public:
  Meshes(int n, bool on_grid, unsigned seed) : random_(seed) {
    while (static_cast<int>(points_.size()) < n) {
      Point3 p;
      for (int i = 0; i < 3; ++i) p[i] = on_grid ? static_cast<double>(random_() % 4) : random_() * 0x1p-32;
      if (std::find(points_.begin(), points_.end(), p) == points_.end()) points_.push_back(p);
    }
    Mesh<3> mesh;
    auto pools = mesh.make_pools();
    Delaunay<3> delaunay(mesh, pools);
    EXPECT_TRUE(delaunay.build(points_));
    std::map<VertexId, int> number;
    for (std::size_t i = 0; i < points_.size(); ++i) number[delaunay.vertices()[i]] = static_cast<int>(i);
    for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
      const CellId c{i};
      if (!mesh.alive(c) || mesh.is_ghost(c)) continue;
      const auto& v = mesh.cell(c).vertices;
      cells_.push_back({number[v[0]], number[v[1]], number[v[2]], number[v[3]]});
    }
  }
  /// Some connected cells.
  Part part(std::size_t size, std::size_t most_points) {
    std::vector<std::array<int, 4>> cells = {cells_[random_() % cells_.size()]};
    std::set<int> used(cells[0].begin(), cells[0].end());
    while (cells.size() < size) {
      std::vector<std::array<int, 4>> beside;
      for (const auto& c : cells_) {
        const auto shared = static_cast<std::size_t>(std::count_if(c.begin(), c.end(), [&](int v) { return used.contains(v); }));
        const bool taken = std::find(cells.begin(), cells.end(), c) != cells.end();
        if (shared >= 3 && !taken && used.size() + 4 - shared <= most_points) beside.push_back(c);
      }
      if (beside.empty()) break;
      cells.push_back(beside[random_() % beside.size()]);
      used.insert(cells.back().begin(), cells.back().end());
    }
    Part part{polyhedron_of(points_, cells), {}};
    for (const auto& c : cells)
      part.cells.push_back(
          {static_cast<Index>(c[0]), static_cast<Index>(c[1]), static_cast<Index>(c[2]), static_cast<Index>(c[3])});
    return part;
  }

 private:
  std::mt19937 random_;
  std::vector<Point3> points_;
  std::vector<std::array<int, 4>> cells_;
};

/// What the search does, as plainly as can be: all fillings, without bounds.
class AllFillings {
 public:
  explicit AllFillings(const Polyhedron& p, const CellQuality& quality) : p_(&p), quality_(&quality) {
    for (const Face& f : p.faces) open_.insert(smallest_first(f));
    for (const Face& f : open_)
      if (!open_.contains(turned_over(f))) taken_.insert(turned_over(f));
    go();
  }
  double best = 0;  ///< least quality of the best
  int count = 0;    ///< of fillings

 private:
  void go() {
    if (open_.empty()) return look();
    const Face f = *open_.begin();
    for (Index v = 0; v < p_->points.size(); ++v) {
      const Cell cell = {f[0], f[1], f[2], v};
      if (has_corner(f, v) || !allowed(cell)) continue;
      const auto open = open_, taken = taken_;
      bool fits = volume_ + volume6(simplex_of(*p_, cell)) <= p_->volume6 * (1 + 1e-9);
      for (int i = 0; i < 4 && fits; ++i) {
        const Face g = face_of(cell, i);
        fits = taken_.insert(g).second;
        if (open_.erase(g) == 0 && !taken_.contains(turned_over(g))) open_.insert(turned_over(g));
      }
      if (fits) {
        cells_.push_back(cell);
        volume_ += volume6(simplex_of(*p_, cell));
        go();
        volume_ -= volume6(simplex_of(*p_, cell));
        cells_.pop_back();
      }
      open_ = open;
      taken_ = taken;
    }
  }
  bool allowed(const Cell& cell) const {
    std::uint32_t bits = 0;
    for (const Index i : cell) bits |= 1u << i;
    for (const std::uint32_t flat : p_->flat_sets)
      if ((bits & ~flat) == 0) return false;
    return orient<3>(simplex_of(*p_, cell)) == Sign::positive;
  }
  void look() {
    for (const Index k : p_->kept)
      if (std::none_of(cells_.begin(), cells_.end(), [k](const Cell& c) { return has_corner(c, k); })) return;
    for (const auto& [a, b] : p_->edges)
      if (std::none_of(cells_.begin(), cells_.end(),
                       [a = a, b = b](const Cell& c) { return has_corner(c, a) && has_corner(c, b); }))
        return;
    ++count;
    double least = 1;
    for (Cell c : cells_) {
      // In the order in which the search measures it.
      std::sort(c.begin(), c.end(), [this](Index i, Index j) { return lex_less<3>(p_->points[i], p_->points[j]); });
      if (orient<3>(simplex_of(*p_, c)) == Sign::negative) std::swap(c[2], c[3]);
      least = std::min(least, quality_->of(simplex_of(*p_, c), 0));
    }
    best = std::max(best, least);
  }

  const Polyhedron* p_;
  const CellQuality* quality_;
  std::set<Face> open_, taken_;
  Cells cells_;
  double volume_ = 0;
};

/// All cells are positive, and their oriented boundary is that of the polyhedron; what it must have is there.
void expect_filling(const Polyhedron& p, const Cells& cells, const CellQuality& quality, double least) {
  std::multiset<Face> faces;
  double volume = 0, worst = 1;
  for (const Cell& c : cells) {
    EXPECT_EQ(orient<3>(simplex_of(p, c)), Sign::positive);
    volume += volume6(simplex_of(p, c));
    worst = std::min(worst, quality.of(simplex_of(p, c), p.region));
    for (int i = 0; i < 4; ++i) faces.insert(face_of(c, i));
  }
  EXPECT_EQ(worst, least);  // to the last bit
  EXPECT_NEAR(volume, p.volume6, 1e-9 * p.volume6);
  for (const Face& f : p.faces) EXPECT_EQ(faces.count(smallest_first(f)), 1u);
  const std::set<Face> given = [&p] {
    std::set<Face> s;
    for (const Face& f : p.faces) s.insert(smallest_first(f));
    return s;
  }();
  for (const Face& f : faces) {
    EXPECT_EQ(faces.count(f), 1u);
    EXPECT_EQ(faces.count(turned_over(f)) == 0, given.contains(f) && !given.contains(turned_over(f)));
  }
  const auto a_cell_has = [&cells](const auto& corners) {
    return std::any_of(cells.begin(), cells.end(), [&corners](const Cell& c) {
      return std::all_of(corners.begin(), corners.end(), [&c](Index i) { return has_corner(c, i); });
    });
  };
  for (const Index k : p.kept) EXPECT_TRUE(a_cell_has(std::array{k}));
  for (const auto& e : p.edges) EXPECT_TRUE(a_cell_has(e));
}

double least_of(const Part& part, const CellQuality& quality) {
  double least = 1;
  for (const Cell& c : part.cells) least = std::min(least, quality.of(simplex_of(part.polyhedron, c), 0));
  return least;
}

/// Asks for some of what the Delaunay filling has: walls, edges, and points within.
void ask_for_more(Part& part, std::mt19937& random) {
  Polyhedron& p = part.polyhedron;
  std::set<Face> rim;
  for (const Face& f : p.faces) rim.insert(smallest_first(f));
  for (int wanted = 0; wanted < 2; ++wanted) {
    const Cell& c = part.cells[random() % part.cells.size()];
    const Face f = face_of(c, static_cast<int>(random() % 4));
    if (random() % 2 == 0 && rim.insert(f).second) {
      rim.insert(turned_over(f));
      p.faces.push_back(f);
      p.faces.push_back(turned_over(f));
    }
    p.edges.push_back({c[random() % 2], c[2 + random() % 2]});
  }
  for (Index i = 0; i < p.points.size(); ++i)
    if (random() % 2) p.kept.push_back(i);
}

TEST(PolyhedronFilling, FindsTheBestOfAllFillings) {
  CellBounds<3> bounds;
  bounds.radius_edge_bound = 2;
  const CellQuality quality(bounds, 25);
  std::mt19937 random(3);
  PolyhedronFilling reconnection;
  int none_better = 0, better = 0, several = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    Meshes meshes(seed % 4 == 0 ? 7 : 16, seed % 3 == 0, seed);
    for (int k = 0; k < 6; ++k) {
      Part part = meshes.part(k % 2 ? 100 : 6, 8);
      if (k % 3 == 2) ask_for_more(part, random);
      const AllFillings all(part.polyhedron, quality);
      ASSERT_GE(all.count, 1) << seed;
      several += all.count > 3;
      const std::uint64_t before = reconnection.nodes();
      const double old = least_of(part, quality), enough = k % 2 ? 0 : old * (1 - 1e-9);
      if (reconnection.find(part.polyhedron, quality, enough, part.cells.size() * 3)) {
        ASSERT_LT(reconnection.nodes() - before, PolyhedronFilling::most_nodes);
        EXPECT_EQ(reconnection.least_quality(), all.best) << seed;
        expect_filling(part.polyhedron, reconnection.cells(), quality, reconnection.least_quality());
        better += all.best > old * (1 + 1e-9);
      } else {
        EXPECT_LE(all.best, enough) << seed;
      }
      EXPECT_FALSE(reconnection.find(part.polyhedron, quality, all.best, part.cells.size() * 3));
      none_better += all.best <= old * (1 + 1e-9);
    }
  }
  EXPECT_GT(several, 40);
  EXPECT_GT(better, 30);
  EXPECT_GT(none_better, 30);
}

TEST(PolyhedronFilling, IsSeldomWorseThanWhatWasThere) {
  CellBounds<3> bounds;
  bounds.radius_edge_bound = 2;
  const CellQuality quality(bounds, 20);
  PolyhedronFilling reconnection;
  int found = 0, better = 0, all = 0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    Meshes meshes(60, false, seed);
    for (std::size_t size = 4; size <= PolyhedronFilling::most_cells; size += 2) {
      const Part part = meshes.part(size, PolyhedronFilling::most_points);
      const double old = least_of(part, quality);
      if (!(old > 1e-6)) continue;
      ++all;
      if (reconnection.find(part.polyhedron, quality, old * (1 - 1e-9), 100)) {
        ++found;
        EXPECT_GT(reconnection.least_quality(), old * (1 - 1e-9));
        expect_filling(part.polyhedron, reconnection.cells(), quality, reconnection.least_quality());
      }
      if (!reconnection.find(part.polyhedron, quality, old * (1 + 1e-9), 100)) continue;
      ++better;
      EXPECT_GT(reconnection.least_quality(), old);
    }
  }
  EXPECT_GT(all, 200);
  EXPECT_GT(found, all * 95 / 100);
  EXPECT_GT(better, all / 20);
}

TEST(PolyhedronFilling, DoesNotDependOnNumbersOrScale) {
  CellBounds<3> bounds;
  bounds.radius_edge_bound = 2;
  const CellQuality quality(bounds, 25);
  PolyhedronFilling reconnection;
  std::mt19937 random(5);
  int found = 0;
  const auto sets = [](const Polyhedron& p, const Cells& cells) {
    std::vector<std::vector<std::array<double, 3>>> all;  // in the order of cells and corners, but for the numbers
    for (const Cell& c : cells) {
      all.emplace_back();
      for (const Index i : c) all.back().push_back(p.points[i].x);
    }
    return all;
  };
  for (unsigned seed = 0; seed < 20; ++seed) {
    Meshes meshes(40, seed % 2 == 0, seed);
    for (int k = 0; k < 5; ++k) {
      Part part = meshes.part(12, PolyhedronFilling::most_points);
      if (k % 2) ask_for_more(part, random);
      const Polyhedron& p = part.polyhedron;
      if (!reconnection.find(p, quality, 0, 100)) continue;
      ++found;
      const auto cells = sets(p, reconnection.cells());
      const double least = reconnection.least_quality();
      std::vector<Index> order(p.points.size());
      std::iota(order.begin(), order.end(), Index{0});
      std::shuffle(order.begin(), order.end(), random);
      Polyhedron other = p;
      for (std::size_t i = 0; i < order.size(); ++i) other.points[order[i]] = p.points[i];
      for (Face& f : other.faces) {
        for (Index& i : f) i = order[i];
        std::rotate(f.begin(), f.begin() + random() % 3, f.end());
      }
      for (auto& e : other.edges) e = {order[e[1]], order[e[0]]};
      for (Index& i : other.kept) i = order[i];
      std::shuffle(other.faces.begin(), other.faces.end(), random);
      ASSERT_TRUE(reconnection.find(other, quality, 0, 100));
      EXPECT_EQ(sets(other, reconnection.cells()), cells);
      EXPECT_EQ(reconnection.least_quality(), least);
      const Cells numbered = reconnection.cells();
      for (Point3& q : other.points)
        for (double& x : q.x) x = std::ldexp(x, -30);
      other.volume6 = std::ldexp(other.volume6, -90);
      ASSERT_TRUE(reconnection.find(other, quality, 0, 100));
      EXPECT_EQ(reconnection.cells(), numbered);
    }
  }
  EXPECT_GT(found, 60);
}

TEST(PolyhedronFilling, ObeysFlatSetsAndTheNumberOfPoorCells) {
  CellBounds<3> bounds;
  const CellQuality quality(bounds, 40);
  PolyhedronFilling reconnection;
  int stopped = 0, flat = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    Meshes meshes(20, false, seed);
    Part part = meshes.part(7, 9);
    Polyhedron& p = part.polyhedron;
    if (!reconnection.find(p, quality, 0, 100)) continue;
    std::size_t poor = 0;
    for (const Cell& c : reconnection.cells()) poor += quality.of(simplex_of(p, c), 0) < 1;
    for (std::size_t most = 0; most <= poor; ++most) {
      if (!reconnection.find(p, quality, 0, most)) {
        ++stopped;
        continue;
      }
      std::size_t left = 0;
      for (const Cell& c : reconnection.cells()) left += quality.of(simplex_of(p, c), 0) < 1;
      EXPECT_LE(left, most);
    }
    const Cell& first = reconnection.cells().front();
    p.flat_sets = {1u << first[0] | 1u << first[1] | 1u << first[2] | 1u << first[3]};
    flat += !reconnection.find(p, quality, 0, 100);
    const AllFillings all(p, quality);
    EXPECT_EQ(reconnection.cells().empty(), all.count == 0) << seed;
    for (const Cell& c : reconnection.cells()) EXPECT_NE(1u << c[0] | 1u << c[1] | 1u << c[2] | 1u << c[3], p.flat_sets[0]);
  }
  EXPECT_GT(stopped, 10);
  EXPECT_GT(flat, 0);
}

/// A prism whose top is turned by 30 degrees, the diagonals of its sides pushed in or out.
Polyhedron twisted_prism(bool reflex) {
  Polyhedron p;
  for (int i = 0; i < 6; ++i) {
    const double angle = std::numbers::pi * (i % 3 * 2.0 / 3 + (i < 3 ? 0 : 1.0 / 6));
    p.points.push_back({{std::cos(angle), std::sin(angle), i < 3 ? -0.5 : 0.5}});
  }
  p.faces = {{0, 1, 2}, {3, 4, 5}};
  for (Index i = 0; i < 3; ++i) {
    const auto j = static_cast<Index>((i + 1) % 3), c = static_cast<Index>(j + 3), d = static_cast<Index>(i + 3);
    if (reflex) {
      p.faces.insert(p.faces.end(), {{i, j, c}, {i, c, d}});
    } else {
      p.faces.insert(p.faces.end(), {{i, j, d}, {j, c, d}});
    }
  }
  const Point3 middle{};
  for (Face& f : p.faces) {
    if (orient3d(p.points[f[0]], p.points[f[1]], p.points[f[2]], middle) == Sign::negative) std::swap(f[1], f[2]);
    p.volume6 += volume6({p.points[f[0]], p.points[f[1]], p.points[f[2]], middle});
  }
  return p;
}

TEST(PolyhedronFilling, FindsNoneWhereThereIsNone) {
  CellBounds<3> bounds;
  const CellQuality quality(bounds, 15);
  PolyhedronFilling reconnection;
  EXPECT_TRUE(reconnection.find(twisted_prism(false), quality, 0, 100));
  EXPECT_FALSE(reconnection.find(twisted_prism(true), quality, 0, 100));  // Schoenhardt's
}

}  // namespace pgdr::test_optimize_polyhedron_filling
