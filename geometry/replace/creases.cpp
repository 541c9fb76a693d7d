// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "replace/creases.hpp"

#include <cmath>
#include <map>
#include <optional>

#include "input/diagonal.hpp"
#include "numbers/angle_bounds.hpp"
#include "pgdr/predicates.hpp"
#include "replace/numbers.hpp"
#include "space/box.hpp"
#include "space/disjoint_sets.hpp"
#include "space/distances.hpp"
#include "space/triangle.hpp"

namespace pgdr::detail {
namespace {

using Edge = std::array<std::uint32_t, 2>;

/// A face by its corners, with one way round.
using Turned = std::array<std::uint32_t, 3>;

Vector<3> normal_of(const SurfaceComplex& s, const Turned& t) {
  return cross(difference(s.at(t[1]), s.at(t[0])), difference(s.at(t[2]), s.at(t[0])));
}

/// Twice the area, over an edge.
double height_of(const SurfaceComplex& s, const Turned& t, std::size_t edge) {
  const Vector<3> n = normal_of(s, t);
  return std::sqrt(dot(n, n)) / distance(s.at(t[(edge + 1) % 3]), s.at(t[(edge + 2) % 3]));
}

/// The corner opposite the longest edge; of equal ones the first in the order of coordinates.
std::size_t longest_edge(const SurfaceComplex& s, const Turned& t) {
  std::size_t best = 0;
  double longest = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double length = squared_distance(s.at(t[(i + 1) % 3]), s.at(t[(i + 2) % 3]));
    if (length < longest || (length == longest && lex_less(s.at(t[best]), s.at(t[i])))) continue;
    longest = length;
    best = i;
  }
  return best;
}

class CreaseFinder {
 public:
  CreaseFinder(const SurfaceComplex& surface, double tolerance, double feature_angle)
      : s_(surface),
        height_(numbers::real_height * tolerance),
        cosine_(feature_angle < 180 ? claimed_cosine(feature_angle) : -2) {}

  bool is_crease(const Edge& e) const {
    if (cosine_ < -1) return false;
    const auto faces = s_.faces_of_edge(e[0], e[1]);
    const Turned f = turned(faces[0], e[0], e[1]), g = turned(faces[1], e[1], e[0]);
    if (!dihedral_below(s_.at(e[0]), s_.at(e[1]), s_.at(f[2]), s_.at(g[2]), -cosine_)) return false;
    if (!(height_of(s_, f, 2) > height_) || !(height_of(s_, g, 2) > height_)) return false;
    const auto a = beyond_needles(faces[0], f), b = beyond_needles(faces[1], g);
    if (!a || !b) return false;
    return dot(*a, *b) < cosine_ * std::sqrt(dot(*a, *a) * dot(*b, *b));
  }

 private:
  Turned turned(std::uint32_t f, std::uint32_t a, std::uint32_t b) const {
    return {a, b, corner_beside(s_.faces[f].corners, a, b)};
  }
  /// The normal of the first face, across longest edges, that is no needle.
  std::optional<Vector<3>> beyond_needles(std::uint32_t f, Turned t) const {
    for (int step = 0; step <= numbers::needles_crossed; ++step) {
      const std::size_t longest = longest_edge(s_, t);
      if (height_of(s_, t, longest) > height_) return normal_of(s_, t);
      const std::uint32_t a = t[(longest + 1) % 3], b = t[(longest + 2) % 3];
      if (s_.is_kept(a, b)) return std::nullopt;
      const std::uint32_t g = s_.beyond(f, a, b);
      if (g == no_index) return std::nullopt;
      t = turned(g, b, a);
      f = g;
    }
    return std::nullopt;
  }

  const SurfaceComplex& s_;
  double height_, cosine_;
};

/// Leaves out what hangs together in a box smaller than `least`, and on nothing that is kept.
void drop_small(const SurfaceComplex& s, std::vector<Edge>& creases, double least) {
  DisjointSets sets(s.points.size());
  for (const Edge& e : creases) sets.unite(e[0], e[1]);
  std::map<std::uint32_t, Box<3>> boxes;
  std::map<std::uint32_t, bool> hangs;
  for (const Edge& e : creases) {
    const std::uint32_t set = sets.find(e[0]);
    const auto box = boxes.emplace(set, Box<3>::empty()).first;
    for (const std::uint32_t v : e) {
      box->second.add(s.at(v));
      if (!s.kept_at[v].empty()) hangs[set] = true;
    }
  }
  const auto is_small = [&](const Edge& e) {
    const std::uint32_t set = sets.find(e[0]);
    return hangs.count(set) == 0 && diagonal_of(boxes.at(set)) < least;
  };
  creases.erase(std::remove_if(creases.begin(), creases.end(), is_small), creases.end());
}

}  // namespace

std::vector<Edge> find_creases(const SurfaceComplex& surface, const std::vector<Edge>& candidates, double tolerance,
                               double feature_angle) {
  const CreaseFinder finder(surface, tolerance, feature_angle);
  std::vector<Edge> creases;
  for (const Edge& e : candidates)
    if (finder.is_crease(e)) creases.push_back(e);
  drop_small(surface, creases, numbers::least_creases * tolerance);
  return creases;
}

}  // namespace pgdr::detail
