// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "check/given/cover.hpp"
#include "check/given/flat_leftovers.hpp"
#include "check/given/volumes.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/box_tree.hpp"
#include "space/make_set.hpp"

namespace pgdr::checking {
namespace {

/// Appends what is left over of segments to the walls of the mesh.
class FurtherWalls {
 public:
  FurtherWalls(const GivenTask<2>& task, const GivenMatch<2>& match, VolumeWalls<2>& walls)
      : task_(task), mesh_(task.mesh), input_(task.input), match_(match), walls_(walls) {
    std::vector<detail::Box<2>> boxes;
    for (const auto& s : mesh_.subsegments) {
      auto box = detail::Box<2>::around(mesh_.points[s.vertices[0]]);
      box.add(mesh_.points[s.vertices[1]]);
      boxes.push_back(box);
    }
    subsegments_ = std::make_unique<detail::BoxTree<2>>(boxes);
  }

  void run() {
    for (const auto& leftover : match_.leftovers)
      if (leftover.kind == EntityKind::segment) add_segment(leftover);
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
  std::array<std::uint32_t, 2> ends_of(const std::array<Point<2>, 2>& piece, std::span<const std::uint32_t> corners) const {
    std::array<std::uint32_t, 2> ends{};
    for (int k = 0; k < 2; ++k)
      ends[k] = *std::min_element(corners.begin(), corners.end(), [&](std::uint32_t v, std::uint32_t w) {
        return squared_distance(walls_.points[v], piece[k]) < squared_distance(walls_.points[w], piece[k]);
      });
    return ends;
  }

  /// Once each, also where several given ones overlap.
  void append(const std::array<std::uint32_t, 2>& simplex) {
    auto key = simplex;
    std::sort(key.begin(), key.end());
    if (!appended_.insert(key).second) return;
    walls_.entities.push_back(static_cast<EntityId>(walls_.simplices.size()));
    walls_.simplices.push_back(simplex);
  }

  /// From one to the next of the vertices and given points on it.
  void add_segment(const Leftover<2>& leftover) {
    const GivenSegment& s = input_.segments()[leftover.id];
    const double reach = match_.reach[leftover.id];
    const auto &a = input_.point(s.points[0]), &b = input_.point(s.points[1]);
    std::vector<std::uint32_t> corners{corner(s.points[0]), corner(s.points[1])};
    const auto box = detail::Box<2>::of(leftover.corners).widened(3 * reach);
    subsegments_->meeting(box, [&](std::uint32_t i) {
      for (const std::uint32_t v : mesh_.subsegments[i].vertices)
        if (box.meets(detail::Box<2>::around(mesh_.points[v])) && is_near<2>(mesh_.points[v], {a, b}, reach))
          corners.push_back(v);
    });
    given_points().meeting(box, [&](std::uint32_t p) {
      if (is_near<2>(input_.point(p), {a, b}, reach)) corners.push_back(corner(p));
    });
    const auto at = [&](const Point<2>& x) {
      double t = 0;
      for (int k = 0; k < 2; ++k) t += (x[k] - a[k]) * (b[k] - a[k]);
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
  std::set<std::array<std::uint32_t, 2>> appended_;
  std::map<std::uint32_t, std::uint32_t> new_corners_;  // of places
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
  if (!match.leftovers.empty()) {
    if constexpr (D == 2)
      FurtherWalls(task, match, out).run();
    else
      append_flat_leftovers(task, match, out);
  }
  const auto add_segment = [&](std::uint32_t a, std::uint32_t b) {
    out.segments.push_back(lex_less(out.points[a], out.points[b]) ? std::array{a, b} : std::array{b, a});
  };
  if constexpr (D == 2)
    for (const auto& w : out.simplices) add_segment(w[0], w[1]);
  else
    for (const auto& s : mesh.subsegments) add_segment(s.vertices[0], s.vertices[1]);
  out.holes = holes_within(task.input.plc(), task.input.tolerance());
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
