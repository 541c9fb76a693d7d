// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/periodic.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "input/words.hpp"
#include "numbers/exact_sum.hpp"
#include "output/simplices.hpp"
#include "pgdr/error.hpp"
#include "space/box.hpp"
#include "space/disjoint_sets.hpp"
#include "space/point_places.hpp"

namespace pgdr {
namespace {

[[noreturn]] void refuse(const std::string& what, const std::vector<std::int64_t>& ids = {},
                         const std::vector<std::array<double, 3>>& points = {}) {
  throw UsageError({Errc::bad_option, what, {}, 0, ids, points});
}

template <int D>
struct SideOfMesh {
  std::vector<std::uint32_t> vertices;           ///< ascending
  std::set<std::array<std::uint32_t, D>> walls;  ///< by their vertices, sorted
};

template <int D>
SideOfMesh<D> side_of(const OutputMesh<D>& mesh, int marker) {
  SideOfMesh<D> side;
  std::set<std::uint32_t> vertices;
  for (const auto& wall : walls(mesh)) {
    if (wall.marker != marker) continue;
    auto sorted = wall.vertices;
    std::ranges::sort(sorted);
    side.walls.insert(sorted);
    vertices.insert(sorted.begin(), sorted.end());
  }
  if (vertices.empty())
    refuse(std::string("no ") + (D == 2 ? "segment" : "facet") + " has the marker " + std::to_string(marker) +
           " that a periodic side is to have");
  side.vertices.assign(vertices.begin(), vertices.end());
  return side;
}

template <int D>
class Pairing {
 public:
  Pairing(const OutputMesh<D>& mesh, const PeriodicSides<D>& sides, double tolerance)
      : mesh_(mesh), tolerance_(tolerance), from_(side_of(mesh, sides.from)), to_(side_of(mesh, sides.to)) {
    out_.from = sides.from;
    out_.to = sides.to;
    motion_ = sides.motion ? *sides.motion : translation_between<D>(points_of(from_), points_of(to_));
    require_rigid<D>(motion_);
    out_.motion.assign(motion_.begin(), motion_.end());
  }

  PeriodicPairs run() {
    pair_vertices();
    pair_walls();
    return std::move(out_);
  }

 private:
  std::vector<Point<D>> points_of(const SideOfMesh<D>& side) const {
    std::vector<Point<D>> points;
    for (const std::uint32_t v : side.vertices) points.push_back(mesh_.points[v]);
    return points;
  }

  [[noreturn]] void refuse_vertex(std::uint32_t v, int marker, int other, const char* what) const {
    refuse("vertex " + std::to_string(v) + " of the side with marker " + std::to_string(marker) + ' ' + what +
               std::to_string(other) + ", at " + detail::to_text(mesh_.points[v]),
           {v}, {detail::in_space(mesh_.points[v])});
  }

  void pair_vertices() {
    const auto [scale, largest] = detail::scale_of<D>(mesh_.points);
    const double width = std::max(tolerance_ * scale, largest * 0x1p-50);  // a grid has a width
    detail::PointGrid<D> grid(to_.vertices.size(), scale, width);
    for (const std::uint32_t v : to_.vertices) grid.insert(mesh_.points[v], v);
    std::map<std::uint32_t, std::uint32_t> back;
    for (const std::uint32_t v : from_.vertices) {
      const Point<D> image = moved<D>(motion_, mesh_.points[v]);
      const std::uint32_t w = grid.nearest(image, mesh_.points);
      const double gap = w == no_entity ? 0 : std::sqrt(squared_distance(image, mesh_.points[w]));
      if (w == no_entity || gap > tolerance_)
        refuse_vertex(v, out_.from, out_.to, "has no image within the tolerance on that with marker ");
      if (!back.emplace(w, v).second) refuse_vertex(w, out_.to, out_.from, "is the image of two of that with marker ");
      out_.points.push_back({v, w});
      out_.largest_gap = std::max(out_.largest_gap, gap);
      out_.exact += image == mesh_.points[w];
    }
    for (const std::uint32_t w : to_.vertices)
      if (!back.contains(w)) refuse_vertex(w, out_.to, out_.from, "is the image of none of that with marker ");
  }

  void pair_walls() {
    std::map<std::uint32_t, std::uint32_t> image;
    for (const auto& [v, w] : out_.points) image[v] = w;
    for (auto wall : from_.walls) {
      const std::uint32_t v = wall[0];
      for (auto& x : wall) x = image[x];
      std::ranges::sort(wall);
      if (!to_.walls.contains(wall))
        refuse_vertex(v, out_.from, out_.to, "has a neighbour there whose image is no neighbour of its own on that with marker ");
    }
    if (from_.walls.size() != to_.walls.size())
      refuse("the sides with markers " + std::to_string(out_.from) + " and " + std::to_string(out_.to) + " have " +
             std::to_string(from_.walls.size()) + " and " + std::to_string(to_.walls.size()) + " pieces");
    out_.walls = from_.walls.size();
  }

  const OutputMesh<D>& mesh_;
  const double tolerance_;
  const SideOfMesh<D> from_, to_;
  Motion<D> motion_;
  PeriodicPairs out_;
};

}  // namespace

template <int D>
void require_rigid(const Motion<D>& motion) {
  constexpr double most = 1e-9;
  const auto factor = [&](std::size_t row, std::size_t column) { return motion[row * (D + 1) + column]; };
  for (std::size_t i = 0; i < D; ++i)
    for (std::size_t k = 0; k < D; ++k) {
      double product = 0;
      for (std::size_t row = 0; row < D; ++row) product += factor(row, i) * factor(row, k);
      if (!(std::fabs(product - (i == k ? 1 : 0)) <= most)) refuse("a motion of periodic sides must keep lengths and angles");
    }
}

template <int D>
Point<D> moved(const Motion<D>& motion, const Point<D>& p) {
  Point<D> image;
  for (int i = 0; i < D; ++i) {
    const double* const row = &motion[static_cast<std::size_t>(i) * (D + 1)];
    detail::ExactSum sum;
    for (int k = 0; k < D; ++k) sum.add_product(row[k], p[k]);
    sum.add_product(row[D], 1);
    image[i] = sum.divided_by(1);
  }
  return image;
}

template <int D>
Motion<D> translation_between(const std::vector<Point<D>>& from, const std::vector<Point<D>>& to) {
  const auto a = detail::Box<D>::of(from), b = detail::Box<D>::of(to);
  Motion<D> motion{};
  for (int i = 0; i < D; ++i) {
    double* const row = &motion[static_cast<std::size_t>(i) * (D + 1)];
    row[i] = 1;
    row[D] = b.low[i] - a.low[i];
  }
  return motion;
}

template <int D>
PeriodicPairs periodic_pairs(const OutputMesh<D>& mesh, const PeriodicSides<D>& sides, double tolerance) {
  return Pairing<D>(mesh, sides, tolerance).run();
}

std::vector<std::uint32_t> periodic_of(const std::vector<PeriodicPairs>& pairs, std::size_t vertices) {
  detail::DisjointSets sets(vertices);
  for (const PeriodicPairs& p : pairs)
    for (const auto& [v, w] : p.points) sets.unite(v, w);
  std::vector<std::uint32_t> smallest(vertices);
  for (std::uint32_t v = 0; v < vertices; ++v) smallest[v] = sets.find(v);
  return smallest;
}

template <int D>
std::vector<PeriodicSides<D>> stated_sides(const StatedPeriods& stated) {
  std::vector<PeriodicSides<D>> all;
  for (const PeriodicPairs& p : stated.pairs) {
    PeriodicSides<D> sides{p.from, p.to, {}};
    if (!p.motion.empty()) {
      auto& motion = sides.motion.emplace();
      if (p.motion.size() != motion.size())
        refuse("a motion of periodic sides has " + std::to_string(p.motion.size()) + " numbers");
      std::ranges::copy(p.motion, motion.begin());
    }
    all.push_back(std::move(sides));
  }
  return all;
}

void require_as_stated(const std::vector<PeriodicPairs>& found, const StatedPeriods& stated) {
  for (std::size_t i = 0; i < stated.pairs.size() && i < found.size(); ++i) {
    const auto &said = stated.pairs[i].points, &is = found[i].points;
    if (said.empty() || said == is) continue;
    const auto at = static_cast<std::size_t>(std::ranges::mismatch(said, is).in1 - said.begin());
    const auto& [v, w] = at < said.size() ? said[at] : is[at];
    refuse("the file pairs other vertices of the sides with markers " + std::to_string(found[i].from) + " and " +
               std::to_string(found[i].to) + " than correspond: first vertex " + std::to_string(v) + " with " + std::to_string(w),
           {v, w});
  }
  if (stated.periodic_of.empty()) return;
  const std::vector<std::uint32_t> least = periodic_of(found, stated.periodic_of.size());
  const auto [said, is] = std::ranges::mismatch(stated.periodic_of, least);
  if (said == stated.periodic_of.end()) return;
  const auto v = said - stated.periodic_of.begin();
  refuse("the file says that vertex " + std::to_string(v) + " is one with " + std::to_string(*said) + ", and it is with " +
             std::to_string(*is),
         {v, *said, *is});
}

template PGDR_API std::vector<PeriodicSides<2>> stated_sides(const StatedPeriods&);
template PGDR_API std::vector<PeriodicSides<3>> stated_sides(const StatedPeriods&);
template PGDR_API void require_rigid<2>(const Motion<2>&);
template PGDR_API void require_rigid<3>(const Motion<3>&);
template PGDR_API Point2 moved<2>(const Motion<2>&, const Point2&);
template PGDR_API Point3 moved<3>(const Motion<3>&, const Point3&);
template PGDR_API Motion<2> translation_between<2>(const std::vector<Point2>&, const std::vector<Point2>&);
template PGDR_API Motion<3> translation_between<3>(const std::vector<Point3>&, const std::vector<Point3>&);
template PGDR_API PeriodicPairs periodic_pairs<2>(const OutputMesh<2>&, const PeriodicSides<2>&, double);
template PGDR_API PeriodicPairs periodic_pairs<3>(const OutputMesh<3>&, const PeriodicSides<3>&, double);

}  // namespace pgdr
