// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "check/given/cover.hpp"
#include "check/given/volumes.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/box_tree.hpp"
#include "space/make_set.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr::checking {
namespace {

/// Appends what is left over to the walls of the mesh.
template <int D>
class FurtherWalls {
 public:
  FurtherWalls(const GivenTask<D>& task, const GivenMatch<D>& match, VolumeWalls<D>& walls)
      : task_(task), mesh_(task.mesh), input_(task.input), match_(match), walls_(walls) {
    std::vector<detail::Box<D>> boxes;
    for (const auto& s : mesh_.subsegments) {
      auto box = detail::Box<D>::around(mesh_.points[s.vertices[0]]);
      box.add(mesh_.points[s.vertices[1]]);
      boxes.push_back(box);
    }
    subsegments_ = std::make_unique<detail::BoxTree<D>>(boxes);
  }

  void run() {
    if constexpr (D == 2) {
      for (const auto& leftover : match_.leftovers)
        if (leftover.kind == EntityKind::segment) add_segment(leftover);
    } else {
      std::map<std::uint32_t, std::vector<const Leftover<D>*>> of_triangle;
      for (const auto& leftover : match_.leftovers)
        if (leftover.kind == EntityKind::facet) of_triangle[leftover.id].push_back(&leftover);
      for (const auto& [t, parts] : of_triangle) add_triangle(t, parts);
    }
  }

 private:
  /// The vertex of the mesh in its place, or else a new one.
  std::uint32_t corner(std::uint32_t p) {
    if (match_.vertex_of_point[p] != none) return match_.vertex_of_point[p];
    const auto [at, fresh] = new_corners_.try_emplace(input_.place(p), static_cast<std::uint32_t>(walls_.points.size()));
    if (fresh) walls_.points.push_back(input_.point(p));
    return at->second;
  }

  /// Of the corners those two at which a piece ends, which is as much shorter as what is covered reaches.
  std::array<std::uint32_t, 2> ends_of(const std::array<Point<D>, 2>& piece, std::span<const std::uint32_t> corners) const {
    std::array<std::uint32_t, 2> ends{};
    for (int k = 0; k < 2; ++k)
      ends[k] = *std::min_element(corners.begin(), corners.end(), [&](std::uint32_t v, std::uint32_t w) {
        return squared_distance(walls_.points[v], piece[k]) < squared_distance(walls_.points[w], piece[k]);
      });
    return ends;
  }

  /// Once each, also where several given ones overlap.
  void append(const std::array<std::uint32_t, D>& simplex) {
    auto key = simplex;
    std::sort(key.begin(), key.end());
    if (!appended_.insert(key).second) return;
    walls_.entities.push_back(static_cast<EntityId>(walls_.simplices.size()));
    walls_.simplices.push_back(simplex);
  }

  /// From one to the next of the vertices and given points on it.
  void add_segment(const Leftover<D>& leftover) requires(D == 2) {
    const GivenSegment& s = input_.segments()[leftover.id];
    const double reach = match_.reach[leftover.id];
    const auto &a = input_.point(s.points[0]), &b = input_.point(s.points[1]);
    std::vector<std::uint32_t> corners{corner(s.points[0]), corner(s.points[1])};
    const auto box = detail::Box<D>::of(leftover.corners).widened(3 * reach);
    subsegments_->meeting(box, [&](std::uint32_t i) {
      for (const std::uint32_t v : mesh_.subsegments[i].vertices)
        if (box.meets(detail::Box<D>::around(mesh_.points[v])) && is_along(mesh_.points[v], a, b, reach)) corners.push_back(v);
    });
    given_points().meeting(box, [&](std::uint32_t p) {
      if (is_along(input_.point(p), a, b, reach)) corners.push_back(corner(p));
    });
    const auto at = [&](const Point<D>& x) {
      double t = 0;
      for (int k = 0; k < D; ++k) t += (x[k] - a[k]) * (b[k] - a[k]);
      return t;
    };
    const auto before = [&](std::uint32_t v, std::uint32_t w) { return at(walls_.points[v]) < at(walls_.points[w]); };
    std::sort(corners.begin(), corners.end(), before);
    const auto ends = ends_of({leftover.corners[0], leftover.corners[1]}, corners);
    std::uint32_t last = ends[0];
    for (const std::uint32_t v : corners) {
      if (!before(last, v) || before(ends[1], v)) continue;
      append({last, v});
      last = v;
    }
  }

  /// Within reach of the segment ab.
  static bool is_along(const Point<D>& x, const Point<D>& a, const Point<D>& b, double reach) {
    const auto d = detail::difference(b, a), u = detail::difference(x, a);
    const double t = std::clamp(detail::dot(u, d) / detail::dot(d, d), 0.0, 1.0);
    double squared = 0;
    for (int k = 0; k < D; ++k) squared += (u[k] - t * d[k]) * (u[k] - t * d[k]);
    return squared <= reach * reach;
  }

  const detail::BoxTree<D>& given_points() {
    if (!given_points_) {
      std::vector<detail::Box<D>> boxes;
      for (const Point<D>& p : input_.plc().points) boxes.push_back(detail::Box<D>::around(p));
      given_points_ = std::make_unique<detail::BoxTree<D>>(boxes);
    }
    return *given_points_;
  }

  void add_triangle(std::uint32_t t, const std::vector<const Leftover<D>*>& parts) requires(D == 3) {
    const GivenTriangle& given = input_.triangles()[t];
    const std::array corners{corner(given.points[0]), corner(given.points[1]), corner(given.points[2])};
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return;
    const PlaneFrame frame(input_.corners(given));
    std::vector<FlatPolygon> polygons;
    for (const auto* part : parts) {
      auto& polygon = polygons.emplace_back();
      for (const Point3& x : part->corners) polygon.push_back(flat(frame, x));
    }
    if (!triangulate(t, frame, corners)) {
      append(corners);
      return;
    }
    const std::vector<detail::PlanarTriangle> triangles = planar_.triangles();
    for (const auto& piece : triangles) {
      Point2 c{};
      for (const std::uint32_t v : piece)
        for (int i = 0; i < 2; ++i) c[i] += flat(frame, walls_.points[v])[i] / 3;
      if (std::ranges::any_of(polygons, [&](const FlatPolygon& p) { return is_in(p, c); })) append(piece);
    }
  }

  static Point2 flat(const PlaneFrame& frame, const Point3& x) {
    const auto p = frame.place(x);
    return {{p[0], p[1]}};
  }

  static bool is_in(const FlatPolygon& polygon, const Point2& x) {
    for (std::size_t k = 0; k < polygon.size(); ++k)
      if (orient2d(polygon[k], polygon[(k + 1) % polygon.size()], x) == Sign::negative) return false;
    return true;
  }

  /// With the subsegments on it, so that it meets the walls of the mesh at common edges.
  bool triangulate(std::uint32_t t, const PlaneFrame& frame, const std::array<std::uint32_t, 3>& corners) requires(D == 3) {
    const double reach = match_.reach[t];
    const auto given = input_.corners(input_.triangles()[t]);
    const CoveringTriangle whole(frame, given, reach, reach);
    std::vector<std::uint32_t> vertices(corners.begin(), corners.end());
    std::vector<detail::PlanarEdge> edges;
    std::vector<CoveringSegment<3>> covers;
    const auto is_on = [&](std::uint32_t v) {
      const auto p = frame.place(mesh_.points[v]);
      return std::abs(p[2]) <= reach && whole.contains({{p[0], p[1]}});
    };
    subsegments_->meeting(detail::Box<3>::of(given).widened(reach), [&](std::uint32_t i) {
      const auto& v = mesh_.subsegments[i].vertices;
      if (!is_on(v[0]) || !is_on(v[1])) return;
      vertices.insert(vertices.end(), v.begin(), v.end());
      edges.push_back({std::min(v[0], v[1]), std::max(v[0], v[1])});
      covers.push_back({{mesh_.points[v[0]], mesh_.points[v[1]]}, reach});
    });
    detail::make_set(vertices);
    for (int i = 0; i < 3; ++i) {
      const std::array<Point3, 2> side{given[i], given[(i + 1) % 3]};
      for (const auto& [from, to] : uncovered_parts(side, covers)) {
        std::array<Point3, 2> piece;
        for (int k = 0; k < 3; ++k) {
          piece[0][k] = side[0][k] + from * (side[1][k] - side[0][k]);
          piece[1][k] = side[0][k] + to * (side[1][k] - side[0][k]);
        }
        const auto ends = ends_of(piece, vertices);
        if (ends[0] != ends[1]) edges.push_back({std::min(ends[0], ends[1]), std::max(ends[0], ends[1])});
      }
    }
    detail::make_set(edges);
    int axis = 0;
    double most = -1;
    for (int k = 0; k < 3; ++k) {
      const int j = (k + 1) % 3, l = (k + 2) % 3;
      const double seen = std::abs((given[1][j] - given[0][j]) * (given[2][l] - given[0][l]) -
                                   (given[1][l] - given[0][l]) * (given[2][j] - given[0][j]));
      if (seen <= most) continue;
      most = seen;
      axis = k;
    }
    if (!planar_.build(walls_.points, vertices, edges, axis)) return false;
    planar_.carve_outside();
    return true;
  }

  const GivenTask<D>& task_;
  const OutputMesh<D>& mesh_;
  const GivenInput<D>& input_;
  const GivenMatch<D>& match_;
  VolumeWalls<D>& walls_;
  std::unique_ptr<detail::BoxTree<D>> subsegments_, given_points_;
  std::set<std::array<std::uint32_t, D>> appended_;
  std::map<std::uint32_t, std::uint32_t> new_corners_;  // of places
  detail::PlanarTriangulation planar_;
};

}  // namespace

template <int D>
VolumeWalls<D> walls_of_mesh(const GivenTask<D>& task, const GivenMatch<D>& match) {
  const OutputMesh<D>& mesh = task.mesh;
  VolumeWalls<D> out;
  out.points = mesh.points;
  out.segments_are_pieces = true;
  for (const auto& w : walls(mesh)) {
    out.entities.push_back(static_cast<EntityId>(out.simplices.size()));
    out.simplices.push_back(w.vertices);
  }
  if (!match.leftovers.empty()) FurtherWalls<D>(task, match, out).run();
  const auto add_segment = [&](std::uint32_t a, std::uint32_t b) {
    out.segments.push_back(lex_less(out.points[a], out.points[b]) ? std::array{a, b} : std::array{b, a});
  };
  if constexpr (D == 2)
    for (const auto& w : out.simplices) add_segment(w[0], w[1]);
  else
    for (const auto& s : mesh.subsegments) add_segment(s.vertices[0], s.vertices[1]);
  out.holes = task.input.plc().holes;
  out.regions = task.input.plc().regions;
  return out;
}

template <int D>
void check_further_walls(const GivenTask<D>& task, const InputVolumes<D>& volumes) {
  for (std::size_t w = walls(task.mesh).size(); w < volumes.patches().size(); ++w)
    if (volumes.wants_patch(static_cast<std::uint32_t>(w)))
      task.findings.add(Kind::wrong_volume, {}, [&] {
        std::string text = std::string("A ") + (D == 2 ? "segment" : "facet") + " of the input that bounds the domain, at ";
        for (const Point<D>& x : volumes.simplex(static_cast<std::uint32_t>(w))) text += words(x) + " ";
        return text + "is not in the mesh.";
      });
}

#define PGDR_INSTANTIATE(D)                                                         \
  template VolumeWalls<D> walls_of_mesh(const GivenTask<D>&, const GivenMatch<D>&); \
  template void check_further_walls(const GivenTask<D>&, const InputVolumes<D>&);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr::checking
