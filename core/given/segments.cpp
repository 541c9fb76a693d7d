// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "given/cover.hpp"
#include "given/crossings.hpp"
#include "given/match.hpp"
#include "space/box_tree.hpp"

namespace pgdr::checking {
namespace {

template <int D>
using Ends = std::array<Point<D>, 2>;

/// The segments of a list that come near others.
template <int D>
class SegmentTree {
 public:
  explicit SegmentTree(std::vector<CoveringSegment<D>> list) : list_(std::move(list)) {
    std::vector<detail::Box<D>> boxes;
    for (const auto& s : list_) boxes.push_back(detail::Box<D>::of(s.ends).widened(s.reach));
    tree_ = std::make_unique<detail::BoxTree<D>>(boxes);
  }
  const CoveringSegment<D>& operator[](std::uint32_t i) const { return list_[i]; }
  /// Those near the segment for which take(i).
  template <class Take>
  std::vector<CoveringSegment<D>> near(const Ends<D>& segment, const Take& take) const {
    std::vector<CoveringSegment<D>> out;
    tree_->meeting(detail::Box<D>::of(segment), [&](std::uint32_t i) {
      if (take(i)) out.push_back(list_[i]);
    });
    return out;
  }

 private:
  std::vector<CoveringSegment<D>> list_;
  std::unique_ptr<detail::BoxTree<D>> tree_;
};

template <int D>
class GivenSegmentMatcher {
 public:
  GivenSegmentMatcher(const GivenTask<D>& task, GivenMatch<D>& out)
      : task_(task), mesh_(task.mesh), input_(task.input), out_(out), given_(given_segments()), edges_(facet_edges()) {}

  void run() {
    // A given segment is covered by subsegments that lie on given segments, its own or others of their marker.
    std::vector<std::uint8_t> on_segment(mesh_.subsegments.size(), 0);
    for (std::uint32_t i = 0; i < mesh_.subsegments.size(); ++i) {
      task_.findings.heed_stop();
      on_segment[i] = match_subsegment(i);
    }
    const SegmentTree<D> subsegments(all_subsegments());
    for (std::uint32_t s = 0; s < input_.segments().size(); ++s) {
      task_.findings.heed_stop();
      const Ends<D> ends = given_[s].ends;
      if constexpr (D == 2) out_.reach.push_back(given_[s].reach);
      if (is_short(ends, given_[s].reach)) continue;
      auto others = subsegments.near(ends, [&](std::uint32_t i) {
        if constexpr (D == 2) note_place(s, i, subsegments[i].ends);
        return on_segment[i] != 0;
      });
      for (auto& other : others) other.reach = given_[s].reach;
      for (const auto& [from, to] : uncovered_parts(ends, others))
        out_.leftovers.push_back({EntityKind::segment, s, {along(ends, from), along(ends, to)}});
    }
  }

 private:
  /// Too short for its direction to mean anything: its ends are told apart by the tolerance alone.
  bool is_short(const Ends<D>& ends, double reach) const { return std::sqrt(squared_distance(ends[0], ends[1])) <= 10 * reach; }

  static Point<D> along(const Ends<D>& ends, double t) {
    if (t == 0 || t == 1) return ends[t == 1];
    Point<D> p;
    for (int i = 0; i < D; ++i) p[i] = ends[0][i] + t * (ends[1][i] - ends[0][i]);
    return p;
  }

  void note_place(std::uint32_t s, std::uint32_t i, const Ends<D>& sub) {
    const Ends<D>& given = given_[s].ends;
    const auto has_centre_of = [&](const Ends<D>& ends, const Ends<D>& other) {
      const Point<D> x = along(other, 0.5);
      const double whole = squared_distance(ends[0], ends[1]);
      double t = 0;
      for (int k = 0; k < D; ++k) t += (x[k] - ends[0][k]) * (ends[1][k] - ends[0][k]) / whole;
      return t >= 0 && t <= 1 && squared_distance(along(ends, t), x) <= given_[s].reach * given_[s].reach;
    };
    if (!has_centre_of(given, sub) && !has_centre_of(sub, given)) return;
    double product = 0;
    for (int k = 0; k < D; ++k) product += (given[1][k] - given[0][k]) * (sub[1][k] - sub[0][k]);
    out_.on_given.push_back({s, i, product < 0});
  }

  double reach(std::span<const std::uint32_t> points) const {
    double most = input_.tolerance();
    for (const std::uint32_t p : points) most = std::max(most, out_.moved[p]);
    return most + input_.rounding();
  }

  std::vector<CoveringSegment<D>> given_segments() const {
    std::vector<CoveringSegment<D>> list;
    for (const GivenSegment& s : input_.segments())
      list.push_back({{input_.point(s.points[0]), input_.point(s.points[1])}, reach(s.points)});
    return list;
  }

  /// 3D: the edges of given triangles, but for diagonals of facets that are not bent, of which no segment is made.
  std::vector<CoveringSegment<D>> facet_edges() const {
    std::vector<CoveringSegment<D>> list;
    const auto triangles = input_.triangles();
    for (std::size_t first = 0, last; first < triangles.size(); first = last) {
      const std::uint32_t facet = triangles[first].facet;
      const bool is_bent = input_.bend(facet) > input_.reach();
      std::map<std::array<std::uint32_t, 2>, int> times;
      for (last = first; last < triangles.size() && triangles[last].facet == facet; ++last)
        for (std::size_t i = 0; i < 3; ++i) {
          const auto [p, q] = std::minmax(triangles[last].points[i], triangles[last].points[(i + 1) % 3]);
          ++times[{p, q}];
        }
      for (const auto& [ends, count] : times)
        if (count == 1 || is_bent) list.push_back({{input_.point(ends[0]), input_.point(ends[1])}, reach(ends)});
    }
    return list;
  }

  std::vector<CoveringSegment<D>> all_subsegments() const {
    std::vector<CoveringSegment<D>> list;
    for (const auto& s : mesh_.subsegments)
      list.push_back({{mesh_.points[s.vertices[0]], mesh_.points[s.vertices[1]]}, 2 * input_.reach()});
    return list;
  }

  bool covered(const Ends<D>& ends, const std::vector<CoveringSegment<D>>& others) const {
    if (!is_short(ends, input_.reach())) return uncovered_parts(ends, others).empty();
    return !others.empty();
  }

  /// Whether edges of facets, lines in which facets cross, and these have all of it.
  bool is_on_facets(const Ends<D>& ends, std::vector<CoveringSegment<D>> others) {
    const auto edges = edges_.near(ends, [](std::uint32_t) { return true; });
    others.insert(others.end(), edges.begin(), edges.end());
    if (covered(ends, others)) return true;
    if constexpr (D == 3) {
      if (!crossings_) crossings_ = std::make_unique<FacetCrossings>(input_, triangle_reaches());
      crossings_->append_parts(ends, others);
    }
    return D == 3 && covered(ends, others);
  }

  std::vector<double> triangle_reaches() const {
    std::vector<double> list;
    for (const GivenTriangle& t : input_.triangles()) list.push_back(reach(t.points) + input_.bend(t.facet));
    return list;
  }

  /// Whether it lies on given segments. What lies on nothing given is a finding.
  bool match_subsegment(std::uint32_t i) {
    const auto& sub = mesh_.subsegments[i];
    const Ends<D> ends{mesh_.points[sub.vertices[0]], mesh_.points[sub.vertices[1]]};
    const auto own = given_.near(ends, [&](std::uint32_t s) { return input_.segments()[s].marker == sub.marker; });
    if (covered(ends, own)) return true;
    if (D == 3 && sub.marker == 0 && is_on_facets(ends, own)) return false;
    const auto of_any_marker = given_.near(ends, [](std::uint32_t) { return true; });
    const bool marked = is_on_facets(ends, of_any_marker);
    task_.findings.add(marked ? Kind::wrong_marker : Kind::stray_constraint, {i}, [&] {
      return "Subsegment " + std::to_string(i) + " (" + list_words(sub.vertices) + "), from " + words(ends[0]) + " to " +
             words(ends[1]) + ", has marker " + std::to_string(sub.marker) +
             (marked ? ", but no input segment with that marker has all of it." : " and lies on no input segment.");
    });
    return marked;
  }

  const GivenTask<D>& task_;
  const OutputMesh<D>& mesh_;
  const GivenInput<D>& input_;
  GivenMatch<D>& out_;
  SegmentTree<D> given_, edges_;
  std::unique_ptr<FacetCrossings> crossings_;  // 3D: where a subsegment is on no edge
};

}  // namespace

template <int D>
void match_given_segments(const GivenTask<D>& task, GivenMatch<D>& out) {
  GivenSegmentMatcher<D>(task, out).run();
}

template void match_given_segments(const GivenTask<2>&, GivenMatch<2>&);
template void match_given_segments(const GivenTask<3>&, GivenMatch<3>&);

}  // namespace pgdr::checking
