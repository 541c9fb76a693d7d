// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "replace/straight_chains.hpp"

#include <algorithm>

#include "pgdr/predicates.hpp"
#include "space/distances.hpp"

namespace pgdr::detail {
namespace {

constexpr std::uint32_t no_edge = 0xffffffffu;

/// The edges at each point, as far as there are two or fewer.
class EdgesAt {
 public:
  EdgesAt(std::size_t points, std::span<const ChainEdge> edges)
      : edges_(edges), count_(points, 0), at_(points, {no_edge, no_edge}) {
    for (std::uint32_t e = 0; e < edges.size(); ++e)
      for (const std::uint32_t v : edges[e].ends)
        if (count_[v]++ < 2) at_[v][count_[v] - 1] = e;
  }
  /// Two edges of one kind, and no others?
  bool go_on(std::uint32_t v) const { return count_[v] == 2 && edges_[at_[v][0]].kind == edges_[at_[v][1]].kind; }
  std::uint32_t other_edge(std::uint32_t v, std::uint32_t e) const { return at_[v][at_[v][0] == e ? 1 : 0]; }
  std::uint32_t other_end(std::uint32_t e, std::uint32_t v) const { return edges_[e].ends[edges_[e].ends[0] == v ? 1 : 0]; }
  /// The points at the other ends of the two edges.
  std::array<std::uint32_t, 2> beside(std::uint32_t v) const { return {other_end(at_[v][0], v), other_end(at_[v][1], v)}; }

 private:
  std::span<const ChainEdge> edges_;
  std::vector<std::uint32_t> count_;
  std::vector<std::array<std::uint32_t, 2>> at_;
};

/// Edges that go on in each other, and the points along them. Of a closed run the last point is the first one.
struct Run {
  std::vector<std::uint32_t> points, edges;
};

/// Goes on from the end of the run, whose last edge is e. @returns whether it has come back to `first`
bool go_on(const EdgesAt& at, std::uint32_t e, std::uint32_t first, const std::vector<std::uint8_t>& is_passed, Run& run) {
  while (is_passed[run.points.back()]) {
    e = at.other_edge(run.points.back(), e);
    if (e == first) return true;
    run.edges.push_back(e);
    run.points.push_back(at.other_end(e, run.points.back()));
  }
  return false;
}

/// The run that an edge is in, through points that are passed.
Run run_of(const EdgesAt& at, const ChainEdge& edge, std::uint32_t e, const std::vector<std::uint8_t>& is_passed) {
  Run run{{edge.ends[0], edge.ends[1]}, {e}};
  if (go_on(at, e, e, is_passed, run)) return run;
  std::ranges::reverse(run.points);
  go_on(at, e, e, is_passed, run);
  return run;
}

template <int D>
bool is_exactly_inside(const Point<D>& a, const Point<D>& v, const Point<D>& b) {
  return collinear<D>(a, v, b) && lex_less(a, v) == lex_less(v, b);
}

/// Are all points within the tolerance of the line between the ends, in their order?
template <int D>
bool is_straight(std::span<const Point<D>> points, const std::vector<std::uint32_t>& run, double tolerance) {
  std::uint32_t from = run.front(), to = run.back();
  if (from == to) return false;
  if (lex_less(points[to], points[from])) std::swap(from, to);
  const bool is_turned = from != run.front();
  double last = is_turned ? 1 : 0;
  for (std::size_t k = 1; k + 1 < run.size(); ++k) {
    const Point<D>& x = points[run[k]];
    const double part = part_of_edge(x, points[from], points[to]);
    if (!(is_turned ? part < last : part > last) || !(part > 0 && part < 1)) return false;
    if (closest_to_edge(x, points[from], points[to]).square > tolerance * tolerance) return false;
    last = part;
  }
  return true;
}

}  // namespace

template <int D>
std::vector<std::uint8_t> points_inside_lines(std::span<const Point<D>> points, std::span<const ChainEdge> edges,
                                              const std::vector<std::uint8_t>& kept, double tolerance) {
  const EdgesAt at(points.size(), edges);
  std::vector<std::uint8_t> is_passed(points.size(), 0), is_exact(points.size(), 0), inside(points.size(), 0);
  for (std::uint32_t v = 0; v < points.size(); ++v) {
    if (kept[v] || !at.go_on(v)) continue;
    auto [a, b] = at.beside(v);
    if (a == b) continue;
    if (lex_less(points[b], points[a])) std::swap(a, b);
    is_exact[v] = is_exactly_inside<D>(points[a], points[v], points[b]);
    is_passed[v] = is_exact[v] || closest_to_edge(points[v], points[a], points[b]).square <= tolerance * tolerance;
  }
  std::vector<std::uint8_t> done(edges.size(), 0);
  for (std::uint32_t e = 0; e < edges.size(); ++e) {
    if (done[e]) continue;
    const Run run = run_of(at, edges[e], e, is_passed);
    for (const std::uint32_t other : run.edges) done[other] = 1;
    const bool whole = is_straight<D>(points, run.points, tolerance);
    for (std::size_t k = 1; k + 1 < run.points.size(); ++k) inside[run.points[k]] = whole || is_exact[run.points[k]];
    if (run.points.front() == run.points.back()) inside[run.points.front()] = is_exact[run.points.front()];
  }
  return inside;
}

std::vector<ChainEdge> without_points(std::span<const ChainEdge> edges, const std::vector<std::uint8_t>& inside) {
  const EdgesAt at(inside.size(), edges);
  std::vector<std::uint8_t> done(edges.size(), 0);
  std::vector<ChainEdge> out;
  for (std::uint32_t e = 0; e < edges.size(); ++e) {
    if (done[e]) continue;
    const Run run = run_of(at, edges[e], e, inside);
    for (const std::uint32_t other : run.edges) done[other] = 1;
    out.push_back({{run.points.front(), run.points.back()}, edges[e].kind});
  }
  return out;
}

template std::vector<std::uint8_t> points_inside_lines<2>(std::span<const Point2>, std::span<const ChainEdge>,
                                                          const std::vector<std::uint8_t>&, double);
template std::vector<std::uint8_t> points_inside_lines<3>(std::span<const Point3>, std::span<const ChainEdge>,
                                                          const std::vector<std::uint8_t>&, double);

}  // namespace pgdr::detail
