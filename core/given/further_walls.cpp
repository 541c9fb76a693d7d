// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "given/cover.hpp"
#include "given/edge_net.hpp"
#include "given/flat_leftovers.hpp"
#include "given/volumes.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/box_tree.hpp"
#include "space/make_set.hpp"

namespace pgdr::checking {
namespace {

/// Appends what is left over of segments to the walls of the mesh, in pieces that meet at their ends alone.
class FurtherWalls {
 public:
  FurtherWalls(const GivenTask<2>& task, const GivenMatch<2>& match, VolumeWalls<2>& walls)
      : task_(task),
        mesh_(task.mesh),
        input_(task.input),
        match_(match),
        walls_(walls),
        corner_(task.input, match, walls.points) {
    std::vector<detail::Box<2>> boxes;
    for (const auto& s : mesh_.subsegments) {
      auto box = detail::Box<2>::around(mesh_.points[s.vertices[0]]);
      box.add(mesh_.points[s.vertices[1]]);
      boxes.push_back(box);
    }
    subsegments_ = std::make_unique<detail::BoxTree<2>>(boxes);
  }

  void run() {
    std::map<std::uint32_t, std::vector<const Leftover<2>*>> of_segment;
    for (const auto& leftover : match_.leftovers)
      if (leftover.kind == EntityKind::segment) of_segment[leftover.id].push_back(&leftover);
    for (const auto& [id, pieces] : of_segment) add_segment(id, pieces);
    append_without_crossings();
  }

 private:
  /// Outside of the mesh segments may cross where there is no point. What several have is appended once.
  void append_without_crossings() {
    std::vector<Point3> points;
    for (const Point2& p : walls_.points) points.push_back({{p[0], p[1], 0}});
    const std::size_t known = points.size();
    EdgeNet net(points);
    for (const auto& [edge, reach] : edges_) net.add(edge, reach, false);
    net.cut();
    for (std::size_t v = known; v < points.size(); ++v) walls_.points.push_back({{points[v][0], points[v][1]}});
    std::set<detail::PlanarEdge> appended;
    for (const auto& [edge, reach] : edges_) {
      const auto chain = net.chain(edge);
      for (std::size_t k = 1; k < chain.size(); ++k) {
        if (!appended.insert(sorted_edge(chain[k - 1], chain[k])).second) continue;
        walls_.simplices.push_back({chain[k - 1], chain[k]});
      }
    }
  }

  /// The vertices and given points on a segment, by their places along it.
  std::vector<std::pair<double, std::uint32_t>> corners_along(const GivenSegment& s, double reach) {
    const std::array<Point2, 2> ends{input_.point(s.points[0]), input_.point(s.points[1])};
    std::vector<std::pair<double, std::uint32_t>> corners;
    const auto take = [&](std::uint32_t v) { corners.push_back({along(ends, walls_.points[v]), v}); };
    for (const std::uint32_t p : s.points) take(corner_(p));
    const auto box = detail::Box<2>::of(ends).widened(reach);
    subsegments_->meeting(box, [&](std::uint32_t i) {
      for (const std::uint32_t v : mesh_.subsegments[i].vertices)
        if (is_near<2>(mesh_.points[v], ends, reach)) take(v);
    });
    given_points().meeting(box, [&](std::uint32_t p) {
      if (is_near<2>(input_.point(p), ends, reach)) take(corner_(p));
    });
    detail::make_set(corners);
    return corners;
  }

  static double along(const std::array<Point2, 2>& ends, const Point2& x) {
    return detail::dot(detail::difference(x, ends[0]), detail::difference(ends[1], ends[0]));
  }

  /// Each piece from one to the next of the corners, and from the one nearest to an end of it to the one nearest to the other: it
  /// is as much shorter as what is covered reaches, which may be far beside what leaves it at a small angle.
  void add_segment(std::uint32_t id, const std::vector<const Leftover<2>*>& pieces) {
    const GivenSegment& s = input_.segments()[id];
    const auto corners = corners_along(s, match_.reach[id]);
    const auto nearest = [&](double t) {
      const auto next = std::lower_bound(corners.begin(), corners.end(), std::pair{t, 0u});
      if (next == corners.begin()) return next;
      return next == corners.end() || t - next[-1].first < next->first - t ? next - 1 : next;
    };
    for (const auto* piece : pieces) {
      const std::array<Point2, 2> ends{input_.point(s.points[0]), input_.point(s.points[1])};
      const auto last = nearest(along(ends, piece->corners[1]));
      for (auto at = nearest(along(ends, piece->corners[0])); at < last; ++at) {
        if (at->second == at[1].second) continue;
        double& known = edges_[sorted_edge(at->second, at[1].second)];
        known = std::max(known, match_.reach[id]);
      }
    }
  }

  const detail::BoxTree<2>& given_points() {
    if (!given_points_) {
      std::vector<detail::Box<2>> boxes;
      for (const Point<2>& p : input_.plc().points) boxes.push_back(detail::Box<2>::around(p));
      given_points_ = std::make_unique<detail::BoxTree<2>>(boxes);
    }
    return *given_points_;
  }

  const GivenTask<2>& task_;
  const OutputMesh<2>& mesh_;
  const GivenInput<2>& input_;
  const GivenMatch<2>& match_;
  VolumeWalls<2>& walls_;
  std::unique_ptr<detail::BoxTree<2>> subsegments_, given_points_;
  std::map<detail::PlanarEdge, double> edges_;  // and their reaches
  CornersOfPoints<2> corner_;
};

}  // namespace

template <int D>
VolumeWalls<D> walls_of_mesh(const GivenTask<D>& task, const GivenMatch<D>& match) {
  const OutputMesh<D>& mesh = task.mesh;
  VolumeWalls<D> out;
  out.points = mesh.points;
  for (const auto& w : walls(mesh)) out.simplices.push_back(w.vertices);
  if (!match.leftovers.empty()) {
    if constexpr (D == 2)
      FurtherWalls(task, match, out).run();
    else
      append_flat_leftovers(task, match, out);
  }
  if constexpr (D == 3)
    for (const auto& s : mesh.subsegments) {
      const auto [a, b] = s.vertices;
      out.segments.push_back(lex_less(out.points[a], out.points[b]) ? std::array{a, b} : std::array{b, a});
    }
  out.holes = holes_within(task.input.plc(), task.input.tolerance());
  out.regions = task.input.plc().regions;
  return out;
}

template <int D>
void check_further_walls(const GivenTask<D>& task, const InputVolumes<D>& volumes) {
  for (std::size_t w = walls(task.mesh).size(); w < volumes.wall_count(); ++w)
    if (volumes.wants(static_cast<std::uint32_t>(w)))
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
