// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "check/kept.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "given/crossings.hpp"
#include "numbers/vectors.hpp"
#include "space/box_tree.hpp"
#include "space/distances.hpp"

namespace pgdr::checking {
namespace {

template <int D>
class Kept {
 public:
  Kept(const GivenTask<D>& task, const GivenMatch<D>& match, const CheckOptions<D>& options)
      : task_(task), mesh_(task.mesh), match_(match), options_(options), may_be_(mesh_.points.size(), 0) {
    for (const std::uint32_t v : match.vertex_of_point)
      if (v != none) may_be_[v] = 1;
    for (const Leftover<D>& l : match.leftovers)
      if (l.kind == (D == 3 ? EntityKind::facet : EntityKind::segment)) not_meshed_.insert(l.id);
  }

  void run() {
    if constexpr (D == 3) {
      look_at_walls(mesh_.subfacets, "subfacet");
      for (std::uint32_t t = 0; t < task_.input.triangles().size(); ++t) look_at(t);
    } else {
      look_at_walls(mesh_.subsegments, "subsegment");
      for (std::uint32_t s = 0; s < task_.input.segments().size(); ++s) look_at(s);
    }
  }

 private:
  using Corners = std::array<std::uint32_t, D>;

  bool is_kept(int marker) const {
    return options_.kept_markers.empty() || std::ranges::find(options_.kept_markers, marker) != options_.kept_markers.end();
  }

  template <class Walls>
  void look_at_walls(const Walls& walls, const char* what) {
    for (const auto& wall : walls) {
      task_.findings.heed_stop();
      if (!is_kept(wall.marker)) continue;
      Corners corners;
      std::copy(wall.vertices.begin(), wall.vertices.end(), corners.begin());
      std::sort(corners.begin(), corners.end());
      walls_.push_back(corners);
      for (const std::uint32_t v : corners)
        if (!may_be(v))
          task_.findings.add(Kind::boundary_not_kept, {v}, [&] {
            return "The " + vertex_words(mesh_, v) + " of a " + what + " that was to be kept is no point of the input.";
          });
    }
    std::sort(walls_.begin(), walls_.end());
  }

  bool may_be(std::uint32_t v) {
    if (may_be_[v]) return true;
    if (!crossings_)
      crossings_ = std::make_unique<GivenCrossings<D>>(task_.input, 2 * task_.input.tolerance() + task_.input.rounding());
    return crossings_->has(mesh_.points[v]);
  }

  /// A given triangle (2D: segment).
  void look_at(std::uint32_t i) {
    task_.findings.heed_stop();
    const auto& given = [&]() -> const auto& {
      if constexpr (D == 3)
        return task_.input.triangles()[i];
      else
        return task_.input.segments()[i];
    }
    ();
    if (!is_kept(marker(given)) || is_polygon(given) || not_meshed_.contains(i)) return;
    Corners corners;
    std::array<Point<D>, D> places;
    for (std::size_t k = 0; k < D; ++k) {
      corners[k] = match_.vertex_of_point[given.points[k]];
      places[k] = task_.input.point(given.points[k]);
      if (corners[k] == none) return;  // which is a finding of its own where it is in the mesh
    }
    std::sort(corners.begin(), corners.end());
    if (std::ranges::binary_search(walls_, corners) || is_thin(places) || has_another_on_it(corners, places)) return;
    task_.findings.add(Kind::boundary_not_kept, {i}, [&] {
      return "The " + words_of(given) + " was to be kept, and is not one " + (D == 3 ? "subfacet." : "subsegment.");
    });
  }

  int marker(const GivenTriangle& t) const { return task_.input.marker(t); }
  int marker(const GivenSegment& s) const { return s.marker; }
  bool is_polygon(const GivenSegment&) const { return false; }
  /// Of more corners, or of several polygons.
  bool is_polygon(const GivenTriangle& t) const {
    const auto& facet = task_.input.plc().facets[t.facet];
    return facet.polygons.size() != 1 || facet.polygons[0].size() != 3;
  }
  static std::string words_of(const GivenTriangle& t) { return "facet " + std::to_string(t.facet) + " of the input"; }
  static std::string words_of(const GivenSegment& s) { return "segment " + std::to_string(s.item) + " of the input"; }

  /// So that joining may drop it.
  bool is_thin(const std::array<Point<D>, D>& p) const {
    const double least = 10 * task_.input.reach();
    double longest = 0;
    for (std::size_t i = 0; i < D; ++i)
      for (std::size_t k = 0; k < i; ++k) longest = std::max(longest, squared_distance(p[i], p[k]));
    if constexpr (D == 2)
      return longest <= least * least;
    else {
      const auto n = detail::cross(detail::difference(p[1], p[0]), detail::difference(p[2], p[0]));
      return detail::dot(n, n) <= least * least * longest;
    }
  }

  bool has_another_on_it(const Corners& corners, const std::array<Point<D>, D>& places) {
    if (!tree_) {
      std::vector<detail::Box<D>> boxes;
      for (std::uint32_t v = 0; v < mesh_.points.size(); ++v)
        if (may_be(v)) {
          boxes.push_back(detail::Box<D>::around(mesh_.points[v]));
          vertices_.push_back(v);
        }
      tree_ = std::make_unique<detail::BoxTree<D>>(boxes);
    }
    const double reach = 2 * task_.input.tolerance() + task_.input.rounding();
    bool found = false;
    tree_->meeting(detail::Box<D>::of(places).widened(reach), [&](std::uint32_t k) {
      const std::uint32_t v = vertices_[k];
      if (std::ranges::find(corners, v) != corners.end()) return;
      found = found || detail::closest_to_simplex<D>(mesh_.points[v], places).square <= reach * reach;
    });
    return found;
  }

  const GivenTask<D>& task_;
  const OutputMesh<D>& mesh_;
  const GivenMatch<D>& match_;
  const CheckOptions<D>& options_;
  std::vector<std::uint8_t> may_be_;  // of each vertex: it is a given point
  std::set<std::uint32_t> not_meshed_;
  std::vector<Corners> walls_;  // sorted
  std::unique_ptr<GivenCrossings<D>> crossings_;
  std::unique_ptr<detail::BoxTree<D>> tree_;
  std::vector<std::uint32_t> vertices_;  // of the tree
};

}  // namespace

template <int D>
void check_kept(const GivenTask<D>& task, const GivenMatch<D>& match, const CheckOptions<D>& options) {
  if (options.keep_boundary) Kept<D>(task, match, options).run();
}

template void check_kept(const GivenTask<2>&, const GivenMatch<2>&, const CheckOptions<2>&);
template void check_kept(const GivenTask<3>&, const GivenMatch<3>&, const CheckOptions<3>&);

}  // namespace pgdr::checking
