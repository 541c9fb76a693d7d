// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A finished Delaunay mesh of a convex domain, and insertions into it by definition alone: the cavity of a point is every
// cell whose circumball holds it, found by looking at all cells. Slow, tests only.
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "pgdr/circumsphere.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::test {

template <int D>
class BruteForce {
 public:
  using Index = std::uint32_t;
  using Face = std::array<Index, D>;  ///< sorted
  struct Cavity {
    std::vector<Index> cells;    ///< sorted
    std::vector<Face> boundary;  ///< sorted
  };

  explicit BruteForce(OutputMesh<D> m) : mesh(std::move(m)) {
    for (Index c = 0; c < mesh.cells.size(); ++c) {
      spheres.push_back(circumsphere<D>(cell(c)));
      for (int i = 0; i <= D; ++i) cells_at_[face(c, i)].push_back(c);
    }
  }

  Simplex<D> cell(Index c) const {
    Simplex<D> s;
    for (std::size_t i = 0; i <= D; ++i) s[i] = mesh.points[mesh.cells[c][i]];
    return s;
  }
  Face face(Index c, int opposite) const {
    Face f;
    for (int i = 0, k = 0; i <= D; ++i)
      if (i != opposite) f[static_cast<std::size_t>(k++)] = mesh.cells[c][static_cast<std::size_t>(i)];
    std::sort(f.begin(), f.end());
    return f;
  }
  /// One or two.
  const std::vector<Index>& cells_at(const Face& f) const { return cells_at_.at(f); }
  /// The cell that p and the face would make, positively oriented; none if it is flat.
  std::optional<Simplex<D>> join(const Point<D>& p, const Face& f) const {
    Simplex<D> s;
    for (std::size_t i = 0; i < D; ++i) s[i] = mesh.points[f[i]];
    s[D] = p;
    const Sign sign = orient<D>(s);
    if (sign == Sign::zero) return {};
    if (sign == Sign::negative) std::swap(s[0], s[1]);
    return s;
  }
  double radius(Index c) const { return std::sqrt(spheres[c].squared_radius); }

  /// Does the circumball of the cell hold p (which is no vertex), under the perturbation?
  bool conflicts(Index c, const Point<D>& p) const {
    const auto& ball = spheres[c];
    const double d2 = squared_distance(ball.center, p);
    if (d2 > ball.squared_radius * (1 + 1e-6)) return false;  // spares time; the centres are good to 2^-20
    return in_sphere_perturbed<D>(cell(c), p) == Sign::positive;
  }
  Cavity cavity(const Point<D>& p) const {
    Cavity result;
    std::map<Face, int> faces;
    for (Index c = 0; c < mesh.cells.size(); ++c) {
      if (!conflicts(c, p)) continue;
      result.cells.push_back(c);
      for (int i = 0; i <= D; ++i) ++faces[face(c, i)];
    }
    for (const auto& [f, times] : faces)
      if (times == 1) result.boundary.push_back(f);
    return result;
  }
  bool is_vertex(const Point<D>& p) const { return std::find(mesh.points.begin(), mesh.points.end(), p) != mesh.points.end(); }

  const OutputMesh<D> mesh;
  std::vector<Circumsphere<D>> spheres;

 private:
  std::map<Face, std::vector<Index>> cells_at_;
};

template <class T>
std::vector<T> common(const std::vector<T>& a, const std::vector<T>& b) {
  std::vector<T> both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

/// The criterion of theorem 3.1: the cavities have no cell in common, and across a common face neither new cell's
/// circumball holds the other point.
template <int D>
bool are_independent(const BruteForce<D>& brute, const Point<D>& p, const typename BruteForce<D>::Cavity& of_p, const Point<D>& q,
                     const typename BruteForce<D>::Cavity& of_q) {
  if (p == q || !common(of_p.cells, of_q.cells).empty()) return false;
  for (const auto& f : common(of_p.boundary, of_q.boundary)) {
    const auto s = brute.join(q, f);
    if (s && in_sphere_perturbed<D>(*s, p) == Sign::positive) return false;
  }
  return true;
}

}  // namespace pgdr::test
