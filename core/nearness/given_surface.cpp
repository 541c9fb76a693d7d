// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "nearness/given_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "given/cover.hpp"
#include "given/flat_leftovers.hpp"
#include "given/match.hpp"
#include "nearness/near_set.hpp"
#include "pgdr/error.hpp"
#include "space/disjoint_sets.hpp"
#include "space/distances.hpp"
#include "space/equal_rows.hpp"
#include "space/make_set.hpp"

namespace pgdr::checking {
namespace {

/// Of each point the one that stands for all that hang together with it within r: the least by its coordinates.
std::vector<std::uint32_t> joined_points(std::span<const Point3> points, double r) {
  std::vector<detail::Box<3>> boxes;
  boxes.reserve(points.size());
  for (const Point3& p : points) boxes.push_back(detail::Box<3>::around(p));
  const detail::BoxTree<3> tree(boxes);
  detail::DisjointSets sets(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i)
    tree.meeting(boxes[i].widened(r), [&](std::uint32_t j) {
      if (j < i && squared_distance(points[i], points[j]) <= r * r) sets.unite(i, j);
    });
  std::vector<std::uint32_t> least(points.size(), none), out(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    std::uint32_t& of = least[sets.find(i)];
    if (of == none || lex_less(points[i], points[of])) of = i;
  }
  for (std::uint32_t i = 0; i < points.size(); ++i) out[i] = least[sets.find(i)];
  return out;
}

/// The triangle that is nearest to x, the least of several. @pre the tree is not empty
template <class CornersOf>
std::uint32_t nearest_of(const detail::BoxTree<3>& tree, const Point3& x, const CornersOf& corners_of) {
  double least = std::numeric_limits<double>::infinity();
  std::uint32_t nearest = none;
  tree.nearest([&](const detail::Box<3>& box, std::uint32_t) { return box.squared_distance_to(x); },
               [&](std::uint32_t i) {
                 const double square = squared_distance_above(x, corners_of(i));
                 if (square < least || (square == least && i < nearest)) {
                   least = square;
                   nearest = i;
                 }
                 return least;
               });
  return nearest;
}

using Edge = std::array<std::uint32_t, 2>;

/// Each once.
std::vector<Edge> edges_of(const Plc<3>& triangles) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.facets.size());
  for (const auto& facet : triangles.facets)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [a, b] = std::minmax(facet.polygons[0][i], facet.polygons[0][(i + 1) % 3]);
      edges.push_back({a, b});
    }
  detail::make_set(edges);
  return edges;
}

/// The lines that triangles of two planes have in common, as edges of both. (Facets may cross where both ends of such a line are
/// points of both, which may be points where edges cross, that nobody has given.)
class CommonLines {
 public:
  /// @param plc of triangles, which gets a point for each end that is none. What is within 2 r of a point is that point.
  CommonLines(Plc<3>& plc, double r) : plc_(plc), reach_(r) {
    std::vector<detail::Box<3>> boxes;
    for (const auto& facet : plc.facets) {
      boxes.push_back(detail::Box<3>::of(corners(facet)).widened(r));
      for (const std::uint32_t p : facet.polygons[0]) by_x_.insert({plc.points[p][0], p});
    }
    detail::BoxTree<3>(boxes, detail::TreeCut::at_medians).self_pairs([&](std::uint32_t t, std::uint32_t u) {
      if (!add(corners(plc.facets[t]), corners(plc.facets[u]))) add(corners(plc.facets[u]), corners(plc.facets[t]));
    });
    detail::make_set(edges_);
  }
  const std::vector<Edge>& edges() const { return edges_; }

 private:
  using Triangle = std::array<Point3, 3>;
  Triangle corners(const Plc<3>::Facet& facet) const {
    const auto& p = facet.polygons[0];
    return {plc_.points[p[0]], plc_.points[p[1]], plc_.points[p[2]]};
  }

  /// What t has of the plane of u, as far as it is in u. @return false: u is too thin to have a plane
  bool add(const Triangle& t, const Triangle& u) {
    const PlaneFrame frame(u);
    if (frame.width() <= 10 * reach_) return false;
    std::array<double, 3> heights;
    for (std::size_t i = 0; i < 3; ++i) heights[i] = frame.place(t[i])[2];
    const auto is_on = [&](double h) { return std::abs(h) <= reach_; };
    if (std::ranges::all_of(heights, is_on)) return true;
    std::vector<Point3> on;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t k = (i + 1) % 3;
      if (is_on(heights[i])) on.push_back(t[i]);
      if (!is_on(heights[i]) && !is_on(heights[k]) && (heights[i] < 0) != (heights[k] < 0))
        on.push_back(detail::on_edge(t[i], t[k], heights[i] / (heights[i] - heights[k])));
    }
    if (on.size() != 2) return true;
    const double length = detail::distance(on[0], on[1]);
    // A line along an edge of u, or at a sharp corner, is within reach of edges of u, which are cut out of t anyway.
    const auto p = frame.place(on[0]), q = frame.place(on[1]);
    const auto part_of = [&](double reach) {
      return CoveringTriangle(frame, u, reach, reach_).part_of({{p[0], p[1]}}, {{q[0], q[1]}});
    };
    const auto inner = part_of(-reach_), part = part_of(0);
    if (inner[0] > inner[1] || !((part[1] - part[0]) * length > 10 * reach_)) return true;
    const std::uint32_t a = point_at(detail::on_edge(on[0], on[1], part[0])),
                        b = point_at(detail::on_edge(on[0], on[1], part[1]));
    if (a != b) edges_.push_back({std::min(a, b), std::max(a, b)});
    return true;
  }

  std::uint32_t point_at(const Point3& x) {
    const double r = 2 * reach_;
    for (auto at = by_x_.lower_bound(x[0] - r); at != by_x_.end() && at->first <= x[0] + r; ++at)
      if (squared_distance(plc_.points[at->second], x) <= r * r) return at->second;
    const auto v = static_cast<std::uint32_t>(plc_.points.size());
    plc_.points.push_back(x);
    by_x_.insert({x[0], v});
    return v;
  }

  Plc<3>& plc_;
  double reach_;
  std::multimap<double, std::uint32_t> by_x_;
  std::vector<Edge> edges_;
};

/// Do no two edges come within r of each other, nor a corner and a triangle, but where they share a corner, and is no triangle
/// there twice? Then triangles overlap nowhere and end on nothing. (Those that go through each other do not count: inputs in
/// which some do are refused.)
bool meets_at_common_corners(const Plc<3>& plc, const std::vector<Edge>& edges, double r) {
  const auto& x = plc.points;
  std::vector<detail::Box<3>> boxes;
  boxes.reserve(edges.size());
  for (const auto& [a, b] : edges) boxes.push_back(detail::Box<3>::of(std::array{x[a], x[b]}).widened(r));
  const detail::BoxTree<3> tree(boxes, detail::TreeCut::at_medians);
  bool clean = true;
  tree.self_pairs([&](std::uint32_t i, std::uint32_t j) {
    const Edge &e = edges[i], &f = edges[j];
    if (!clean || e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1]) return;
    clean = detail::closest_of_edges(x[e[0]], x[e[1]], x[f[0]], x[f[1]]).square > r * r;
  });
  std::vector<std::uint32_t> used;
  for (const Edge& e : edges) used.insert(used.end(), e.begin(), e.end());
  detail::make_set(used);
  boxes.clear();
  for (const std::uint32_t v : used) boxes.push_back(detail::Box<3>::around(x[v]).widened(r));
  const detail::BoxTree<3> corners(boxes, detail::TreeCut::at_medians);
  std::vector<std::array<std::uint32_t, 3>> sorted;
  for (std::size_t t = 0; t < plc.facets.size() && clean; ++t) {
    const auto& p = plc.facets[t].polygons[0];
    sorted.push_back({p[0], p[1], p[2]});
    std::ranges::sort(sorted.back());
    const std::array<Point3, 3> c{x[p[0]], x[p[1]], x[p[2]]};
    corners.meeting(detail::Box<3>::of(c), [&](std::uint32_t i) {
      if (clean && std::ranges::find(p, used[i]) == p.end()) clean = !is_within(x[used[i]], c, r);
    });
  }
  std::ranges::sort(sorted);
  return clean && std::ranges::adjacent_find(sorted) == sorted.end();
}

}  // namespace

GivenSurface::GivenSurface(const GivenInput<3>& input, RegionMode mode, Findings& findings) : input_(input) {
  make_complex(mode, findings);
  std::vector<detail::Box<3>> boxes;
  boxes.reserve(triangles_.size());
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) boxes.push_back(detail::Box<3>::of(corners(t)));
  tree_ = std::make_unique<detail::BoxTree<3>>(boxes, detail::TreeCut::at_medians);
  find_markers();
}

/// Each given triangle as a facet of its own, but for those that joining makes flat.
Plc<3> GivenSurface::joined() const {
  Plc<3> plc;
  plc.points = input_.plc().points;
  const std::vector<std::uint32_t> place = joined_points(plc.points, input_.tolerance());
  for (const GivenTriangle& t : input_.triangles()) {
    const Corners c{place[t.points[0]], place[t.points[1]], place[t.points[2]]};
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
    plc.facets.push_back({{{c[0], c[1], c[2]}}, {}, input_.marker(t)});
  }
  return plc;
}

VolumeWalls<3> GivenSurface::walls_of(Plc<3> joined, Findings& findings) const {
  VolumeWalls<3> walls;
  std::vector<Edge> edges = edges_of(joined);
  if (meets_at_common_corners(joined, edges, input_.reach())) {
    walls.points = joined.points;
    for (const auto& facet : joined.facets)
      walls.simplices.push_back({facet.polygons[0][0], facet.polygons[0][1], facet.polygons[0][2]});
    return walls;
  }
  const CommonLines lines(joined, input_.reach());
  edges.insert(edges.end(), lines.edges().begin(), lines.edges().end());
  detail::make_set(edges);
  const GivenInput<3> input(joined, input_.tolerance(), findings);
  const OutputMesh<3> nothing;
  GivenMatch<3> match;
  match.vertex_of_point.assign(joined.points.size(), none);
  match.moved.assign(joined.points.size(), 0);
  match.reach.assign(input.triangles().size(), input.reach());
  for (std::uint32_t t = 0; t < input.triangles().size(); ++t) {
    const auto c = input.corners(input.triangles()[t]);
    match.leftovers.push_back({EntityKind::facet, t, {c[0], c[1], c[2]}});
  }
  append_flat_leftovers({nothing, input, findings}, match, walls, edges);
  return walls;
}

void GivenSurface::make_complex(RegionMode mode, Findings& findings) {
  try {
    VolumeWalls<3> walls = walls_of(joined(), findings);
    walls.holes = holes_within(input_.plc(), input_.tolerance());
    walls.regions = input_.plc().regions;
    points_ = walls.points;
    triangles_ = walls.simplices;
    volumes_.emplace(std::move(walls), mode);
  } catch (const InputError& e) {
    findings.add(Kind::wrong_volume, {},
                 [&] { return std::string("What the facets of the input bound cannot be told: ") + e.what(); });
  }
}

/// A triangle of the complex, in which no edge of a given one passes, lies on the given ones that its centre is on.
void GivenSurface::find_markers() {
  markers_.resize(triangles_.size());
  std::vector<detail::Box<3>> boxes;
  const double reach = 2 * input_.reach();
  for (const GivenTriangle& t : input_.triangles()) boxes.push_back(detail::Box<3>::of(input_.corners(t)).widened(reach));
  const detail::BoxTree<3> given(boxes);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    const Triangle c = corners(t);
    Point3 centre{};
    for (const Point3& p : c)
      for (int i = 0; i < 3; ++i) centre[i] += p[i] / 3;
    given.at(centre, [&](std::uint32_t g) {
      if (!is_within(centre, input_.corners(input_.triangles()[g]), reach)) return;
      markers_[t].push_back(input_.marker(input_.triangles()[g]));
      parts_.push_back({g, t});
    });
    if (markers_[t].empty() && !boxes.empty()) {  // a crossing was joined farther away
      const std::uint32_t g = nearest_of(given, centre, [&](std::uint32_t i) { return input_.corners(input_.triangles()[i]); });
      markers_[t].push_back(input_.marker(input_.triangles()[g]));
      parts_.push_back({g, t});
    }
    detail::make_set(markers_[t]);
  }
  detail::make_set(parts_);
}

std::span<const GivenSurface::Part> GivenSurface::parts(std::uint32_t given) const {
  return detail::equal_rows(std::span<const Part>(parts_), given, &Part::given);
}

double GivenSurface::distance(const Point3& x) const {
  double least = std::numeric_limits<double>::infinity();
  tree_->nearest([&](const detail::Box<3>& box, std::uint32_t) { return box.squared_distance_to(x); },
                 [&](std::uint32_t t) { return least = std::min(least, squared_distance_above(x, corners(t))); });
  return std::sqrt(least);
}

bool GivenSurface::wants_place(const Point3& x) const {
  if (!volumes_) return true;
  const double reach = 2 * input_.reach();
  bool found = false, wanted = false;
  tree_->meeting(detail::Box<3>::around(x).widened(reach), [&](std::uint32_t t) {
    if (!is_within(x, corners(t), reach)) return;
    found = true;
    wanted = wanted || is_wanted(t);
  });
  if (found) return wanted;
  const auto volume = volumes_->locate(x);
  return !volume || volumes_->volumes()[*volume].kept;
}

}  // namespace pgdr::checking
