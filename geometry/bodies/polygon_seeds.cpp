// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <numeric>

#include "input/edges.hpp"
#include "join/crossing_resolver.hpp"
#include "pgdr/planar_map.hpp"
#include "pgdr/predicates.hpp"
#include "space/box_tree.hpp"

namespace pgdr {
namespace {

using detail::Box;
using detail::BoxTree;
using detail::CrossingResolver;
using detail::edge_key;
using detail::edge_of;
using detail::OwnedEdge;
using detail::PlanarEdge;

/// Half-edge 2 s runs along edge s, 2 s + 1 against it.
class PlanarGraph {
 public:
  /// @pre points that edges have are distinct, and all edges; ends differ
  PlanarGraph(std::span<const Point2> points, std::span<const PlanarEdge> edges) : points_(points), edges_(edges) {
    sort_edges();
    walk();
  }

  std::uint32_t begin(std::uint32_t h) const { return edges_[h / 2][h % 2]; }
  std::uint32_t end(std::uint32_t h) const { return edges_[h / 2][1 - h % 2]; }
  std::uint32_t face(std::uint32_t h) const { return face_[h]; }  ///< to the left of a half-edge
  std::size_t faces() const { return first_.size(); }
  bool is_bounded(std::uint32_t face) const { return bounded_[face]; }
  std::uint32_t next(std::uint32_t h) const { return next_[h]; }
  std::uint32_t first(std::uint32_t face) const { return first_[face]; }

 private:
  bool is_right_of(const Point2& origin, const Point2& to) const {
    return to[0] > origin[0] || (to[0] == origin[0] && to[1] > origin[1]);
  }
  /// Counterclockwise, from straight down, which does not count, over the right to straight up, and on.
  bool is_before(std::uint32_t g, std::uint32_t h) const {
    const Point2 &o = points_[begin(g)], &a = points_[end(g)], &b = points_[end(h)];
    const bool right_a = is_right_of(o, a), right_b = is_right_of(o, b);
    if (right_a != right_b) return right_a;
    return orient2d(o, a, b) == Sign::positive;
  }
  void sort_edges();
  void walk();
  void mark_outer();

  std::span<const Point2> points_;
  std::span<const PlanarEdge> edges_;
  std::vector<std::uint32_t> from_, at_;  ///< half-edges by where they begin: at_[from_[v]] to at_[from_[v + 1]]
  std::vector<std::uint32_t> next_, face_, first_;
  std::vector<bool> bounded_;
};

void PlanarGraph::sort_edges() {
  from_.assign(points_.size() + 1, 0);
  for (std::uint32_t h = 0; h < 2 * edges_.size(); ++h) ++from_[begin(h) + 1];
  std::partial_sum(from_.begin(), from_.end(), from_.begin());
  at_.resize(2 * edges_.size());
  std::vector<std::uint32_t> to(from_.begin(), from_.end() - 1);
  for (std::uint32_t h = 0; h < 2 * edges_.size(); ++h) at_[to[begin(h)]++] = h;
  next_.resize(at_.size());
  for (std::size_t v = 0; v < points_.size(); ++v) {
    const auto first = at_.begin() + from_[v], last = at_.begin() + from_[v + 1];
    std::sort(first, last, [this](std::uint32_t g, std::uint32_t h) { return is_before(g, h) || (!is_before(h, g) && g < h); });
    // To the left of what comes in lies what is to the left of the next one clockwise, going out.
    for (auto h = first; h != last; ++h) next_[*h ^ 1u] = h == first ? *(last - 1) : *(h - 1);
  }
}

void PlanarGraph::walk() {
  constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  face_.assign(next_.size(), none);
  for (std::uint32_t h = 0; h < next_.size(); ++h) {
    if (face_[h] != none) continue;
    for (std::uint32_t g = h; face_[g] == none; g = next_[g]) face_[g] = static_cast<std::uint32_t>(first_.size());
    first_.push_back(h);
  }
  bounded_.assign(first_.size(), true);
  mark_outer();
}

/// Of each connected part, the face to the left of its least point, by x, then y, lies outside of it: it is to the left of the
/// last edge there.
void PlanarGraph::mark_outer() {
  std::vector<std::uint32_t> part(points_.size());
  std::iota(part.begin(), part.end(), 0u);
  const auto root = [&part](std::uint32_t v) {
    while (part[v] != v) v = part[v] = part[part[v]];
    return v;
  };
  const auto less = [this](std::uint32_t a, std::uint32_t b) { return is_right_of(points_[a], points_[b]); };
  for (const PlanarEdge& e : edges_) {
    std::uint32_t a = root(e[0]), b = root(e[1]);
    if (less(b, a)) std::swap(a, b);
    part[b] = a;  // the least is the root
  }
  for (std::uint32_t v = 0; v < points_.size(); ++v)
    if (part[v] == v && from_[v] < from_[v + 1]) bounded_[face_[at_[from_[v + 1] - 1]]] = false;
}

/// Where a segment crosses a horizontal line; of one whose ends are on both sides of it. By halves, which do not overflow.
double crossing(const Point2& a, const Point2& b, double y) {
  const double t = (y / 2 - a[1] / 2) / (b[1] / 2 - a[1] / 2);
  return t >= 0 && t <= 1 ? (1 - t) * a[0] + t * b[0] : a[0] / 2 + b[0] / 2;
}

/// A level that no corner is on: midway between two neighbouring levels of corners of the face that are farthest apart, or if
/// other points lie between these, in the box about the face, midway between such.
double level_of_face(const PlanarGraph& graph, std::span<const Point2> points, std::span<const Point2> by_height,
                     std::uint32_t face) {
  std::vector<double> levels;
  Box<2> box = Box<2>::empty();
  std::uint32_t h = graph.first(face);
  do {
    levels.push_back(points[graph.begin(h)][1]);
    box.add(points[graph.begin(h)]);
    h = graph.next(h);
  } while (h != graph.first(face));
  const auto widest = [&levels] {
    std::sort(levels.begin(), levels.end());
    std::size_t at = 0;
    for (std::size_t i = 0; i + 1 < levels.size(); ++i)
      if (levels[i + 1] - levels[i] > levels[at + 1] - levels[at]) at = i;
    return std::pair(levels[at], levels[at + 1]);
  };
  const auto [low, high] = widest();
  levels = {low, high};
  auto p = std::upper_bound(by_height.begin(), by_height.end(), low, [](double y, const Point2& q) { return y < q[1]; });
  for (; p != by_height.end() && (*p)[1] < high; ++p)
    if (box.low[0] < (*p)[0] && (*p)[0] < box.high[0]) levels.push_back((*p)[1]);
  const auto [below, above] = widest();
  return below / 2 + above / 2;
}

/// The boxes about polygons.
std::vector<Box<2>> boxes_of(std::span<const RingPolygon> polygons) {
  std::vector<Box<2>> boxes;
  for (const RingPolygon& polygon : polygons) {
    Box<2>& box = boxes.emplace_back(Box<2>::empty());
    for (const auto& ring : polygon.rings)
      for (const Point2& p : ring) box.add(p);
  }
  return boxes;
}

bool is_inside(const RingPolygon& polygon, const Point2& x) {
  bool inside = false;
  for (const auto& ring : polygon.rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
      if ((a[1] > x[1]) != (b[1] > x[1]) && (orient2d(a, b, x) == Sign::positive) == (b[1] > a[1])) inside = !inside;
    }
  return inside;
}

struct Crossing {
  double x;
  std::uint32_t edge;
};

/// A horizontal line through a face, and what crosses it.
struct FaceLine {
  double y;
  std::uint32_t face;
  std::vector<Crossing> crossings;
};

/// One through each bounded face.
std::vector<FaceLine> lines_through(const PlanarGraph& graph, std::span<const Point2> points, std::span<const PlanarEdge> edges) {
  std::vector<Point2> by_height;
  for (const PlanarEdge& e : edges) by_height.insert(by_height.end(), {points[e[0]], points[e[1]]});
  std::sort(by_height.begin(), by_height.end(), [](const Point2& a, const Point2& b) { return a[1] < b[1]; });
  std::vector<FaceLine> lines;
  for (std::uint32_t f = 0; f < graph.faces(); ++f)
    if (graph.is_bounded(f)) lines.push_back({level_of_face(graph, points, by_height, f), f, {}});
  std::sort(lines.begin(), lines.end(),
            [](const FaceLine& a, const FaceLine& b) { return a.y < b.y || (a.y == b.y && a.face < b.face); });
  for (std::uint32_t s = 0; s < edges.size(); ++s) {
    const Point2 &a = points[edges[s][0]], &b = points[edges[s][1]];
    const auto [low, high] = std::minmax({a[1], b[1]});
    auto line = std::upper_bound(lines.begin(), lines.end(), low, [](double y, const FaceLine& l) { return y < l.y; });
    for (; line != lines.end() && line->y < high; ++line) line->crossings.push_back({crossing(a, b, line->y), s});
  }
  std::sort(lines.begin(), lines.end(), [](const FaceLine& a, const FaceLine& b) { return a.face < b.face; });
  return lines;
}

/// The middle of the widest piece of the line in its face; none where rounding leaves none.
bool choose_seed(const PlanarGraph& graph, std::span<const Point2> points, FaceLine& through, Point2& seed) {
  std::vector<Crossing>& line = through.crossings;
  std::sort(line.begin(), line.end(),
            [](const Crossing& a, const Crossing& b) { return a.x < b.x || (a.x == b.x && a.edge < b.edge); });
  double widest = 0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const std::uint32_t h = 2 * line[i].edge;
    const bool up = points[graph.end(h)][1] > points[graph.begin(h)][1];
    const double width = line[i + 1].x - line[i].x;
    const std::uint32_t g = 2 * line[i + 1].edge;
    const bool also_up = points[graph.end(g)][1] > points[graph.begin(g)][1];
    const bool inside = graph.face(up ? h + 1 : h) == through.face || graph.face(also_up ? g : g + 1) == through.face;
    if (!inside || !(width > widest)) continue;
    widest = width;
    seed = {line[i].x / 2 + line[i + 1].x / 2, through.y};
  }
  return widest > 0;
}

}  // namespace

std::vector<FaceSeed> seeds_of_faces(const Plc<2>& plc, std::span<const RingPolygon> polygons) {
  CrossingResolver resolver(plc);
  while (resolver.split_once()) {
  }
  const std::vector<Point2>& points = resolver.points();
  std::vector<PlanarEdge> edges;
  for (const OwnedEdge& e : resolver.edges())
    if (e.edge[0] != e.edge[1]) edges.push_back(edge_of(edge_key(e.edge[0], e.edge[1])));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  const PlanarGraph graph(points, edges);
  std::vector<FaceLine> lines = lines_through(graph, points, edges);
  const std::vector<Box<2>> boxes = boxes_of(polygons);
  const BoxTree<2> tree(boxes);
  std::vector<FaceSeed> seeds;
  for (FaceLine& line : lines) {
    FaceSeed seed;
    if (!choose_seed(graph, points, line, seed.point)) continue;
    std::size_t owner = polygons.size();
    tree.at(seed.point, [&](std::uint32_t k) {
      if (k < owner && is_inside(polygons[k], seed.point)) owner = k;
    });
    if (owner != polygons.size()) seed.feature = polygons[owner].feature;
    seeds.push_back(seed);
  }
  return seeds;
}

}  // namespace pgdr
