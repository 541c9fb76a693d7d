// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>

#include "given/crossings.hpp"
#include "given/match.hpp"
#include "space/box_tree.hpp"
#include "space/make_set.hpp"

namespace pgdr::checking {
namespace {

template <int D>
std::unique_ptr<detail::BoxTree<D>> plant(std::span<const Point<D>> points) {
  std::vector<detail::Box<D>> boxes;
  boxes.reserve(points.size());
  for (const Point<D>& p : points) boxes.push_back(detail::Box<D>::around(p));
  return std::make_unique<detail::BoxTree<D>>(boxes);
}

template <int D>
class PointMatcher {
 public:
  PointMatcher(const GivenTask<D>& task, std::span<const std::uint32_t> sorted, GivenMatch<D>& out)
      : task_(task), mesh_(task.mesh), sorted_(sorted), out_(out), in_cell_(mesh_.points.size(), 0) {}

  void run() {
    for (const auto& cell : mesh_.cells)
      for (const std::uint32_t v : cell) in_cell_[v] = 1;
    const std::size_t n = task_.input.plc().points.size();
    out_.vertex_of_point.assign(n, none);
    out_.moved.assign(n, 0);
    for (std::uint32_t p = 0; p < n; ++p) {
      task_.findings.heed_stop();
      match(p);
    }
    check_markers();
    check_loose_vertices();
  }

 private:
  void match(std::uint32_t p) {
    const Point<D>& x = task_.input.point(p);
    const auto at = std::lower_bound(sorted_.begin(), sorted_.end(), x,
                                     [&](std::uint32_t v, const Point<D>& y) { return lex_less(mesh_.points[v], y); });
    if (at != sorted_.end() && mesh_.points[*at] == x)
      out_.vertex_of_point[p] = *at;
    else if (task_.input.tolerance() > 0 && has_near_point(p))
      look_near(p);
    const std::uint32_t v = out_.vertex_of_point[p];
    if ((v == none || !in_cell_[v]) && task_.requires_point(p)) out_.leftovers.push_back({EntityKind::vertex, p, {x}});
  }

  double reach() const { return 2 * task_.input.tolerance(); }

  /// Another given point that is not in its place.
  bool has_near_point(std::uint32_t p) {
    if (!given_tree_) given_tree_ = plant<D>(task_.input.plc().points);
    const Point<D>& x = task_.input.point(p);
    bool found = false;
    given_tree_->meeting(detail::Box<D>::around(x).widened(reach()), [&](std::uint32_t q) {
      const double squared = squared_distance(task_.input.point(q), x);
      found |= squared > 0 && squared <= reach() * reach();
    });
    return found;
  }

  void look_near(std::uint32_t p) {
    if (!vertex_tree_) vertex_tree_ = plant<D>(mesh_.points);
    const Point<D>& x = task_.input.point(p);
    double least = reach() * reach();
    vertex_tree_->meeting(detail::Box<D>::around(x).widened(reach()), [&](std::uint32_t v) {
      const double squared = squared_distance(mesh_.points[v], x);
      if (squared > least || (squared == least && out_.vertex_of_point[p] != none)) return;
      least = squared;
      out_.vertex_of_point[p] = v;
      out_.moved[p] = std::sqrt(squared);
    });
  }

  /// 2D: to each vertex that of the first given segment with one that ends there, which need not be in the mesh.
  void allow_first_segments(const std::vector<std::uint8_t>& unmarked,
                            std::vector<std::pair<std::uint32_t, int>>& allowed) const {
    std::vector<std::uint8_t> done(mesh_.points.size(), 0);
    for (const GivenSegment& s : task_.input.segments())
      for (const std::uint32_t p : s.points) {
        const std::uint32_t v = out_.vertex_of_point[p];
        if (s.marker == 0 || v == none || !unmarked[v] || done[v]) continue;
        done[v] = 1;
        allowed.push_back({v, s.marker});
      }
  }

  /// That of a given point there; where such a point has none, that of a segment may be handed on to it, as Triangle has it.
  void check_markers() {
    std::vector<std::pair<std::uint32_t, int>> allowed;
    const auto& markers = task_.input.plc().point_markers;
    std::vector<std::uint8_t> unmarked(mesh_.points.size(), 0);
    for (std::uint32_t p = 0; p < out_.vertex_of_point.size(); ++p) {
      const std::uint32_t v = out_.vertex_of_point[p];
      if (v == none) continue;
      const int marker = p < markers.size() ? markers[p] : 0;
      allowed.push_back({v, marker});
      if (marker == 0) unmarked[v] = 1;
    }
    for (const auto& s : mesh_.subsegments)
      for (const std::uint32_t v : s.vertices)
        if (unmarked[v]) allowed.push_back({v, s.marker});
    if constexpr (D == 2) allow_first_segments(unmarked, allowed);
    detail::make_set(allowed);
    for (std::uint32_t p = 0; p < out_.vertex_of_point.size(); ++p) {
      const std::uint32_t v = out_.vertex_of_point[p];
      if (v == none || !in_cell_[v] || !task_.requires_point(p)) continue;
      const int marker = mesh_.point_markers.empty() ? 0 : mesh_.point_markers[v];
      if (std::binary_search(allowed.begin(), allowed.end(), std::pair{v, marker})) continue;
      task_.findings.add(Kind::wrong_marker, {v}, [&] {
        return "Input point " + std::to_string(p) + ", " + vertex_words(mesh_, v) + ", has marker " + std::to_string(marker) +
               " instead of " + std::to_string(p < markers.size() ? markers[p] : 0) + ".";
      });
    }
  }

  void check_loose_vertices() {
    std::vector<std::uint8_t> is_given(mesh_.points.size(), 0);
    for (const std::uint32_t v : out_.vertex_of_point)
      if (v != none) is_given[v] = 1;
    for (std::uint32_t v = 0; v < mesh_.points.size(); ++v)
      if (!in_cell_[v] && !is_given[v] && !is_crossing(mesh_.points[v]))
        task_.findings.add(Kind::unreferenced_point, {v},
                           [&] { return "The " + vertex_words(mesh_, v) + " is neither an input point nor in a cell."; });
  }

  bool is_crossing(const Point<D>& x) {
    if (!crossings_) crossings_ = std::make_unique<GivenCrossings<D>>(task_.input, reach() + task_.input.rounding());
    return crossings_->has(x);
  }

  const GivenTask<D>& task_;
  const OutputMesh<D>& mesh_;
  std::span<const std::uint32_t> sorted_;
  GivenMatch<D>& out_;
  std::vector<std::uint8_t> in_cell_;
  std::unique_ptr<detail::BoxTree<D>> given_tree_, vertex_tree_;  // where a point is not in its place
  std::unique_ptr<GivenCrossings<D>> crossings_;                  // where a vertex is in no cell
};

}  // namespace

template <int D>
void match_given_points(const GivenTask<D>& task, std::span<const std::uint32_t> sorted, GivenMatch<D>& out) {
  PointMatcher<D>(task, sorted, out).run();
}

template void match_given_points(const GivenTask<2>&, std::span<const std::uint32_t>, GivenMatch<2>&);
template void match_given_points(const GivenTask<3>&, std::span<const std::uint32_t>, GivenMatch<3>&);

}  // namespace pgdr::checking
