// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "given/flat_leftovers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "given/cover.hpp"
#include "given/edge_net.hpp"
#include "given/flat_groups.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/box_tree.hpp"
#include "space/distances.hpp"
#include "space/make_set.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr::checking {
namespace {

using detail::Box;
using detail::BoxTree;
using detail::PlanarEdge;
using detail::PlanarTriangle;

/// How many triangles more are on the left of an edge than on its right: given ones, and of the mesh. And what adds up to it: how
/// many of them cover a place.
struct Cover {
  int given = 0, meshed = 0;
  bool is_left_over() const { return given > 0 && meshed <= 0; }
  Cover& add(const Cover& other, int times) {
    given += times * other.given;
    meshed += times * other.meshed;
    return *this;
  }
};
using Changes = std::map<PlanarEdge, Cover>;  // of edges from their lesser end to the other

/// Given triangles of which something is left over, that lie in one plane.
struct Plane {
  std::array<Point3, 3> largest;  // of the triangles: it says which plane
  double reach = 0;
  int axis = 0;  // along which it is seen
  Box<3> box = Box<3>::empty();
  Changes changes;
  std::vector<std::uint32_t> points;  // of pieces of its triangles, sorted
  std::vector<PlanarEdge> border;     // of what is left over
};

/// Does one come within r of the other?
bool touch(const std::array<Point3, 3>& a, const std::array<Point3, 3>& b, double r) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (detail::closest_to_triangle(a[i], b[0], b[1], b[2]).square <= r * r) return true;
    if (detail::closest_to_triangle(b[i], a[0], a[1], a[2]).square <= r * r) return true;
    for (std::size_t j = 0; j < 3; ++j)
      if (detail::closest_of_edges(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]).square <= r * r) return true;
  }
  return false;
}

class FlatLeftovers {
 public:
  FlatLeftovers(const GivenTask<3>& task, const GivenMatch<3>& match, VolumeWalls<3>& walls)
      : task_(task),
        mesh_(task.mesh),
        input_(task.input),
        match_(match),
        walls_(walls),
        corner_(task.input, match, walls.points),
        net_(walls.points) {}

  void run(std::span<const std::array<std::uint32_t, 2>> kept) {
    find_planes();
    add_subfacets();
    add_subsegments();
    for (const auto& [p, q] : kept) {
      further_.push_back(sorted_edge(corner_(p), corner_(q)));
      net_.add(further_.back(), input_.reach(), false);
    }
    do {
      task_.findings.heed_stop();
      net_.cut();
    } while (!find_borders());
    for (const PlanarEdge& e : further_) {
      const auto chain = net_.chain(e);
      for (std::size_t k = 1; k < chain.size(); ++k) kept_.push_back(sorted_edge(chain[k - 1], chain[k]));
    }
    keep_edges_of_mesh();
    append();
  }

 private:
  std::array<Point3, 3> given(std::uint32_t t) const { return input_.corners(input_.triangles()[t]); }

  /// The largest triangles first: their planes are known best. Last those that may be seen from anywhere.
  std::vector<std::uint32_t> triangles_by_size() const {
    struct Sized {
      bool is_needle;
      double size;
      std::uint32_t t;
      auto operator<=>(const Sized&) const = default;
    };
    std::vector<Sized> all;
    for (const auto& leftover : match_.leftovers) {
      if (leftover.kind != EntityKind::facet) continue;
      const auto c = given(leftover.id);
      const double longest = std::max({squared_distance(c[0], c[1]), squared_distance(c[1], c[2]), squared_distance(c[2], c[0])});
      const double width = PlaneFrame(c).width();
      all.push_back({width <= 2 * match_.reach[leftover.id], -std::sqrt(longest) * width, leftover.id});
    }
    detail::make_set(all);
    std::vector<std::uint32_t> out;
    for (const Sized& s : all) out.push_back(s.t);
    return out;
  }

  bool is_in(const Plane& plane, const Point3& x) const { return may_be_even(plane.largest, x, plane.reach); }

  /// Triangles that touch each other, as far as they are in the plane of the largest.
  void find_planes() {
    order_ = triangles_by_size();
    const std::vector<std::uint32_t>& order = order_;
    std::vector<Box<3>> boxes;
    for (const std::uint32_t t : order) boxes.push_back(Box<3>::of(given(t)).widened(match_.reach[t]));
    const BoxTree<3>& tree = tree_.emplace(boxes);
    std::vector<std::uint8_t> done(order.size(), 0);
    plane_of_.resize(order.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) {
      if (done[i]) continue;
      Plane& plane = planes_.emplace_back();
      plane.largest = given(order[i]);
      plane.reach = match_.reach[order[i]];
      plane.axis = axis_of(plane.largest);
      std::vector<std::uint32_t> found{i};
      done[i] = 1;
      for (std::size_t k = 0; k < found.size(); ++k) {
        plane.box.add(boxes[found[k]]);
        tree.meeting(boxes[found[k]], [&](std::uint32_t j) {
          if (done[j]) return;
          const double reach = std::max(plane.reach, match_.reach[order[j]]);
          const auto t = given(order[j]);
          if (!may_be_even(plane.largest, t, reach) || (PlaneFrame(t).width() > reach && !is_seen(plane, t, reach))) return;
          if (!touch(given(order[found[k]]), t, reach)) return;
          plane.reach = reach;
          done[j] = 1;
          found.push_back(j);
        });
      }
      for (const std::uint32_t j : found) {
        plane_of_[j] = static_cast<std::uint32_t>(planes_.size() - 1);
        add_given(plane, order[j]);
      }
    }
  }

  /// That along which most is seen of a triangle.
  static int axis_of(const std::array<Point3, 3>& t) {
    const auto n = detail::cross(detail::difference(t[1], t[0]), detail::difference(t[2], t[0]));
    int axis = 0;
    for (int k = 1; k < 3; ++k)
      if (std::abs(n[k]) > std::abs(n[axis])) axis = k;
    return axis;
  }

  void add_given(Plane& plane, std::uint32_t t) {
    const auto& p = input_.triangles()[t].points;
    add_changes(plane, {corner_(p[0]), corner_(p[1]), corner_(p[2])}, {1, 0});
  }

  void add_changes(Plane& plane, const PlanarTriangle& t, const Cover& cover) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return;
    const auto& x = walls_.points;
    const int sense = orient_projected(x[t[0]], x[t[1]], x[t[2]], plane.axis) == Sign::negative ? -1 : 1;
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      plane.changes[sorted_edge(a, b)].add(cover, a < b ? sense : -sense);
    }
  }

  /// Of the mesh, all of each plane near its triangles.
  void add_subfacets() {
    std::vector<Box<3>> boxes;
    for (const auto& s : mesh_.subfacets) boxes.push_back(Box<3>::of(corners(s.vertices)));
    const BoxTree<3> tree(boxes);
    for (Plane& plane : planes_) {
      tree.meeting(plane.box, [&](std::uint32_t s) {
        const auto c = corners(mesh_.subfacets[s].vertices);
        const bool even = std::ranges::all_of(c, [&](const Point3& x) { return is_in(plane, x); });
        if (even && is_seen(plane, c, plane.reach)) add_changes(plane, mesh_.subfacets[s].vertices, {0, 1});
      });
      for (const auto& [edge, change] : plane.changes) {
        if (change.given != 0) net_.add(edge, plane.reach, false);
        if (change.meshed != 0) net_.add(edge, input_.reach(), true);
      }
    }
  }

  std::array<Point3, 3> corners(const std::array<std::uint32_t, 3>& v) const {
    return {mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]]};
  }

  /// So small a triangle that stands on a plane may be within reach of it.
  static bool is_seen(const Plane& plane, const std::array<Point3, 3>& t, double reach) {
    const PlaneFrame frame(plane.largest);
    std::array<Point3, 3> flat;
    for (int i = 0; i < 3; ++i) {
      const auto p = frame.place(t[i]);
      flat[i] = {{p[0], p[1], 0}};
    }
    return PlaneFrame(flat).width() > reach;
  }

  void add_subsegments() {
    std::vector<Box<3>> boxes;
    for (const auto& s : mesh_.subsegments) {
      auto box = Box<3>::around(mesh_.points[s.vertices[0]]);
      box.add(mesh_.points[s.vertices[1]]);
      boxes.push_back(box);
    }
    const BoxTree<3> tree(boxes);
    for (const Plane& plane : planes_)
      tree.meeting(plane.box, [&](std::uint32_t i) {
        const auto& v = mesh_.subsegments[i].vertices;
        if (!is_in(plane, mesh_.points[v[0]]) || !is_in(plane, mesh_.points[v[1]])) return;
        kept_.push_back(sorted_edge(v[0], v[1]));
        net_.add(kept_.back(), input_.reach(), true);
      });
  }

  bool build(const Plane& plane, const std::vector<PlanarEdge>& edges) {
    std::vector<std::uint32_t> vertices;
    for (const PlanarEdge& e : edges) vertices.insert(vertices.end(), e.begin(), e.end());
    detail::make_set(vertices);
    problem_ = planar_.build(walls_.points, vertices, edges, plane.axis);
    return static_cast<bool>(problem_);
  }

  [[noreturn]] static void give_up() {
    throw InputError({Errc::entities_intersect, "What is left over of facets makes no complex.", {}, 0, {}, {}});
  }

  /// Of each triangle of the projection how much covers it, from the changes: nothing beyond the hull.
  std::vector<Cover> covers(const std::vector<PlanarTriangle>& triangles, const Changes& changes) const {
    struct Side {
      PlanarEdge edge;
      std::uint32_t triangle;
      int sense;  // +1: it is on the left of the edge
    };
    std::vector<Side> sides;
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t a = triangles[t][i], b = triangles[t][(i + 1) % 3];
        sides.push_back({sorted_edge(a, b), t, a < b ? 1 : -1});
      }
    std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) { return x.edge < y.edge; });
    const auto change_at = [&](const PlanarEdge& e) {
      const auto at = changes.find(e);
      return at == changes.end() ? Cover{} : at->second;
    };
    std::vector<Cover> out(triangles.size());
    std::vector<std::uint8_t> known(triangles.size(), 0);
    std::vector<std::uint32_t> stack;
    const auto enter = [&](std::uint32_t t, Cover from, const Cover& change, int sense) {
      if (known[t]) return;
      known[t] = 1;
      out[t] = from.add(change, sense);
      stack.push_back(t);
    };
    for (std::size_t i = 0; i < sides.size() && stack.empty(); ++i)
      if ((i == 0 || sides[i - 1].edge != sides[i].edge) && (i + 1 == sides.size() || sides[i + 1].edge != sides[i].edge))
        enter(sides[i].triangle, {}, change_at(sides[i].edge), sides[i].sense);
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      for (int i = 0; i < 3; ++i) {
        const PlanarEdge e = sorted_edge(triangles[t][i], triangles[t][(i + 1) % 3]);
        const auto [first, last] = std::equal_range(sides.begin(), sides.end(), Side{e, 0, 0},
                                                    [](const Side& x, const Side& y) { return x.edge < y.edge; });
        for (auto s = first; s != last; ++s) enter(s->triangle, out[t], change_at(e), s->sense);
      }
    }
    return out;
  }

  Changes pieces(const Plane& plane) const {
    Changes out;
    for (const auto& [edge, change] : plane.changes) {
      if (change.given == 0 && change.meshed == 0) continue;
      const auto chain = net_.chain(edge);
      for (std::size_t k = 1; k < chain.size(); ++k)
        out[sorted_edge(chain[k - 1], chain[k])].add(change, chain[k - 1] < chain[k] ? 1 : -1);
    }
    std::erase_if(out, [](const auto& entry) { return entry.second.given == 0 && entry.second.meshed == 0; });
    return out;
  }

  /// @return false: the net has to be cut again.
  bool find_borders() {
    for (Plane& plane : planes_) {
      task_.findings.heed_stop();
      plane.border.clear();
      plane.points.clear();
      const Changes changes = pieces(plane);
      if (changes.empty()) continue;
      std::vector<PlanarEdge> edges;
      for (const auto& [edge, change] : changes) {
        edges.push_back(edge);
        plane.points.insert(plane.points.end(), edge.begin(), edge.end());
      }
      detail::make_set(plane.points);
      if (!build(plane, edges)) {
        if (problem_.status == detail::PlanarStatus::collinear) continue;
        if (!net_.take_apart(problem_)) give_up();
        return false;
      }
      const std::vector<PlanarTriangle> triangles = planar_.triangles();
      const std::vector<Cover> cover = covers(triangles, changes);
      std::map<PlanarEdge, int> times;
      for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int i = 0; i < 3 && cover[t].is_left_over(); ++i) ++times[sorted_edge(triangles[t][i], triangles[t][(i + 1) % 3])];
      for (const auto& [edge, count] : times)
        if (count == 1) plane.border.push_back(edge);
    }
    return true;
  }

  /// An edge of the mesh was cut where a border of given triangles crossed it that is none of what is left: it is whole again.
  void keep_edges_of_mesh() {
    for (Plane& plane : planes_) {
      std::map<PlanarEdge, std::size_t> parts;
      std::vector<PlanarEdge> border;
      for (const PlanarEdge& e : plane.border)
        if (const PlanarEdge* whole = net_.whole_edge(e))
          ++parts[*whole];
        else
          border.push_back(e);
      for (const auto& [whole, count] : parts) {
        if (count + 1 != net_.chain(whole).size()) give_up();
        border.push_back(whole);
      }
      detail::make_set(border);
      plane.border = std::move(border);
      kept_.insert(kept_.end(), plane.border.begin(), plane.border.end());
    }
    detail::make_set(kept_);
  }

  /// Is it a point of the pieces of the plane, or within reach of one of its triangles? Far from these a point that might be in
  /// one plane with the largest is off it by many times the reach, and an edge that stands there is seen as a point.
  bool touches(std::uint32_t plane, std::uint32_t v) const {
    if (std::ranges::binary_search(planes_[plane].points, v)) return true;
    const Point3& x = walls_.points[v];
    bool found = false;
    tree_->at(x, [&](std::uint32_t i) {
      if (found || plane_of_[i] != plane) return;
      const auto c = given(order_[i]);
      const double reach = match_.reach[order_[i]];
      found = detail::closest_to_triangle(x, c[0], c[1], c[2]).square <= reach * reach;
    });
    return found;
  }

  /// With all that is kept and touches it, so that walls that stand there have their edges in it.
  void append() {
    std::vector<Box<3>> boxes;
    for (const PlanarEdge& e : kept_) {
      auto box = Box<3>::around(walls_.points[e[0]]);
      box.add(walls_.points[e[1]]);
      boxes.push_back(box);
    }
    const BoxTree<3> tree(boxes);
    for (std::uint32_t p = 0; p < planes_.size(); ++p) {
      const Plane& plane = planes_[p];
      if (plane.border.empty()) continue;
      std::vector<PlanarEdge> edges = plane.border;
      tree.meeting(plane.box, [&](std::uint32_t i) {
        const PlanarEdge& e = kept_[i];
        if (touches(p, e[0]) && touches(p, e[1])) edges.push_back(e);
      });
      detail::make_set(edges);
      if (!build(plane, edges)) give_up();
      append_inside(plane);
    }
  }

  /// What the border goes round; each edge of it changes between inside and outside, in either direction.
  void append_inside(const Plane& plane) {
    Changes changes;
    for (const PlanarEdge& e : plane.border) changes[e] = {1, 0};
    const std::vector<PlanarTriangle> triangles = planar_.triangles();
    const std::vector<Cover> cover = covers(triangles, changes);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (cover[t].given % 2 == 0) continue;
      walls_.simplices.push_back(triangles[t]);
    }
  }

  const GivenTask<3>& task_;
  const OutputMesh<3>& mesh_;
  const GivenInput<3>& input_;
  const GivenMatch<3>& match_;
  VolumeWalls<3>& walls_;
  CornersOfPoints<3> corner_;
  std::vector<std::uint32_t> order_;     // triangles of which something is left over
  std::optional<BoxTree<3>> tree_;       // of these, widened by their reach
  std::vector<std::uint32_t> plane_of_;  // of each of these
  std::vector<Plane> planes_;
  EdgeNet net_;
  std::vector<PlanarEdge> kept_;  // edges of the mesh, and borders of what is left over
  std::vector<PlanarEdge> further_;
  detail::PlanarTriangulation planar_;
  detail::PlanarResult problem_;
};

}  // namespace

void append_flat_leftovers(const GivenTask<3>& task, const GivenMatch<3>& match, VolumeWalls<3>& walls,
                           std::span<const std::array<std::uint32_t, 2>> kept) {
  FlatLeftovers(task, match, walls).run(kept);
}

}  // namespace pgdr::checking
