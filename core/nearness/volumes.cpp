// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A point farther from the walls of the mesh than the distance is on no given facet that is near these, and so is all of a
// segment from one such point to another, if what both are away adds up to more than the segment is long and twice the distance.
// So points hang together that are in one given volume; which one that is an exact line tells, once for all of them.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "nearness/near_set.hpp"
#include "nearness/nearness.hpp"
#include "numbers/vectors.hpp"
#include "space/bulk.hpp"
#include "space/disjoint_sets.hpp"

namespace pgdr::checking {
namespace {

class NearVolumes {
 public:
  NearVolumes(const NearTask& task, const InputVolumes<3>& volumes, const Components& components)
      : task_(task),
        mesh_(task.mesh),
        own_(volumes),
        given_(*task.given.volumes()),
        components_(components),
        walls_(walls_of(task.mesh)),
        given_of_(volumes.volumes().size(), none),
        own_of_(given_.volumes().size(), none) {}

  void run() {
    measure_depths();
    place_deep_points();
    place_seeds();
    find_missing();
    for (std::uint32_t v = 0; v < given_of_.size(); ++v)
      if (own_.volumes()[v].kept && given_of_[v] == none) ++task_.findings.report().undecided_volumes;
    for (std::uint32_t v = 0; v < given_of_.size(); ++v)
      if (own_.volumes()[v].kept && given_of_[v] != none) compare_measures(v);
  }

 private:
  static NearSet walls_of(const OutputMesh<3>& mesh) {
    std::vector<Triangle3> list;
    for (const auto& s : mesh.subfacets)
      list.push_back({mesh.points[s.vertices[0]], mesh.points[s.vertices[1]], mesh.points[s.vertices[2]]});
    return NearSet(std::move(list));
  }

  Point3 centroid(std::uint32_t cell) const {
    Point3 c{};
    for (const std::uint32_t v : mesh_.cells[cell])
      for (int i = 0; i < 3; ++i) c[i] += mesh_.points[v][i] / 4;
    return c;
  }
  /// Of a vertex; behind these, of a cell.
  Point3 place(std::uint32_t i) const {
    const auto vertices = static_cast<std::uint32_t>(mesh_.points.size());
    return i < vertices ? mesh_.points[i] : centroid(i - vertices);
  }
  double rounding() const { return 4 * task_.input.rounding(); }
  double limit() const { return task_.limit() + rounding(); }

  /// How far vertices and centroids are from the walls, at least: of a centroid what that of a vertex says, if it is enough.
  void measure_depths() {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    const auto vertices = mesh_.points.size();
    std::vector<std::uint8_t> skip(vertices, 1);
    for (const auto& cell : mesh_.cells)
      for (const std::uint32_t v : cell) skip[v] = 0;
    for (const auto& s : mesh_.subfacets)
      for (const std::uint32_t v : s.vertices) skip[v] = 1;
    depths_.assign(vertices + mesh_.cells.size(), 0);
    const detail::Bulk bulk(true, task_.findings.stop());
    bulk.each(vertices, [&](std::size_t v) {
      if (!skip[v]) depths_[v] = walls_.distance(mesh_.points[v], infinite);
    });
    bulk.each(mesh_.cells.size(), [&](std::size_t c) {
      const Point3 x = centroid(static_cast<std::uint32_t>(c));
      double& depth = depths_[vertices + c];
      for (const std::uint32_t v : mesh_.cells[c])
        depth = std::max(depth, depths_[v] - std::sqrt(squared_distance(x, mesh_.points[v])) - rounding());
      if (!(depth > limit())) depth = walls_.distance(x, infinite);
    });
    task_.findings.heed_stop();
  }

  void place_deep_points() {
    const auto vertices = static_cast<std::uint32_t>(mesh_.points.size());
    detail::DisjointSets sets(depths_.size());
    for (std::uint32_t c = 0; c < mesh_.cells.size(); ++c) {
      if (!(depths_[vertices + c] > limit())) continue;
      const Point3 x = centroid(c);
      for (const std::uint32_t v : mesh_.cells[c]) {
        const double both = depths_[v] + depths_[vertices + c] - std::sqrt(squared_distance(x, mesh_.points[v]));
        if (depths_[v] > limit() && both > 2 * limit()) sets.unite(v, vertices + c);
      }
    }
    std::vector<std::uint32_t> component(depths_.size(), none), deepest(depths_.size(), none);
    for (std::uint32_t c = 0; c < mesh_.cells.size(); ++c) {
      component[vertices + c] = components_.of_cell[c];
      for (const std::uint32_t v : mesh_.cells[c]) component[v] = components_.of_cell[c];  // a deep one is in one component
    }
    for (std::uint32_t i = 0; i < depths_.size(); ++i) {
      if (!(depths_[i] > limit()) || component[i] == none) continue;
      std::uint32_t& best = deepest[sets.find(i)];
      if (best == none || depths_[i] > depths_[best]) best = i;
    }
    std::vector<std::uint32_t> asked;
    for (const std::uint32_t i : deepest)
      if (i != none) asked.push_back(i);
    std::vector<std::optional<std::uint32_t>> found(asked.size());
    detail::Bulk(true, task_.findings.stop()).parts(asked.size(), [&](std::size_t k) {
      found[k] = given_.locate(place(asked[k]));
    });
    task_.findings.heed_stop();
    for (std::size_t k = 0; k < asked.size(); ++k)
      if (const std::uint32_t own = components_.volume[component[asked[k]]]; own != none) note(own, found[k], place(asked[k]));
  }

  /// A point in a volume of the mesh is in this given one, none if it is on a facet that no volume to be meshed touches.
  void note(std::uint32_t own, std::optional<std::uint32_t> given, const Point3& x) {
    if (!given) return;
    std::uint32_t& known = given_of_[own];
    if (known == *given) return;
    const bool are_empty = !own_.volumes()[own].kept && !given_.volumes()[*given].kept;
    if (are_empty) return;  // of which the mesh has as one what walls between them are not in it for
    if (known != none) {
      task_.findings.add(Kind::wrong_volume, {own}, [&] {
        return "Volume " + std::to_string(own) + " of the mesh has parts of two volumes of the input, one of them at " +
               words(x) + ".";
      });
      return;
    }
    known = *given;
    if (own_.volumes()[own].kept != given_.volumes()[*given].kept) {
      task_.findings.add(own_.volumes()[own].kept ? Kind::hole_filled : Kind::wrong_volume, {own}, [&] {
        return "The point " + words(x) + (own_.volumes()[own].kept ? " is in cells" : " is in no cell") +
               ", but lies in a volume of the input that is " +
               (own_.volumes()[own].kept ? "not to be meshed." : "to be meshed.");
      });
      return;
    }
    std::uint32_t& other = own_of_[*given];
    if (other != none && own_.volumes()[own].kept)
      task_.findings.add(Kind::wrong_volume, {own, other}, [&] {
        return "Volumes " + std::to_string(own) + " and " + std::to_string(other) +
               " of the mesh lie in one volume of the input, at " + words(x) + ".";
      });
    other = own;
  }

  /// Those that are deep in a volume of the mesh.
  void place_seeds() {
    const auto look = [&](const Point3& x) {
      if (!(walls_.distance(x, std::numeric_limits<double>::infinity()) > limit())) return;
      if (const auto own = own_.locate(x)) note(*own, given_.locate(x), x);
    };
    for (const Point3& x : own_.holes()) look(x);
    for (const auto& seed : own_.regions()) look(seed.point);
  }

  /// Given volumes to be meshed without one of the mesh.
  void find_missing() {
    std::vector<detail::Box<3>> boxes(given_.volumes().size(), detail::Box<3>::empty());
    for (std::uint32_t w = 0; w < given_.wall_count(); ++w)
      for (const std::uint32_t v : given_.volumes_of(w)) boxes[v].add(detail::Box<3>::of(given_.simplex(w)));
    for (std::uint32_t v = 0; v < given_.volumes().size(); ++v) {
      if (!given_.volumes()[v].kept || own_of_[v] != none) continue;
      const auto deep = deep_point(v, boxes[v]);
      if (!deep) {
        ++task_.findings.report().undecided_volumes;
        continue;
      }
      task_.findings.add(Kind::wrong_volume, {v}, [&] {
        return "A volume of the input that is to be meshed, about " + words(*deep) + ", has no volume of the mesh.";
      });
    }
  }

  /// A point of the given volume deeper than twice the distance, by halving boxes that may have one.
  std::optional<Point3> deep_point(std::uint32_t volume, const detail::Box<3>& whole) const {
    constexpr std::size_t most_boxes = 100000;
    std::vector<detail::Box<3>> boxes{whole};
    for (std::size_t k = 0; k < boxes.size() && k < most_boxes; ++k) {
      const detail::Box<3> box = boxes[k];
      Point3 x;
      for (int i = 0; i < 3; ++i) x[i] = box.low[i] / 2 + box.high[i] / 2;
      const double radius = std::sqrt(squared_distance(box.low, box.high)) / 2, depth = task_.given.distance(x);
      if (depth + radius <= 2 * limit()) continue;
      const bool is_in = depth > 0 && given_.locate(x) == volume;
      if (is_in && depth > 2 * limit()) return x;
      if ((!is_in && depth > radius) || radius < task_.distance / 64) continue;
      for (unsigned part = 0; part < 8; ++part) {
        detail::Box<3> child = box;
        for (int i = 0; i < 3; ++i) (part >> i & 1 ? child.low : child.high)[i] = x[i];
        boxes.push_back(child);
      }
    }
    return std::nullopt;
  }

  /// All points within r of a triangle lie in a plate, three half-cylinders and a ball.
  static double around(const Triangle3& t, double r) {
    const auto n = detail::cross(detail::difference(t[1], t[0]), detail::difference(t[2], t[0]));
    double perimeter = 0;
    for (std::size_t i = 0; i < 3; ++i) perimeter += std::sqrt(squared_distance(t[i], t[(i + 1) % 3]));
    return r * std::sqrt(detail::dot(n, n)) + r * r * std::numbers::pi / 2 * perimeter + r * r * r * std::numbers::pi * 4 / 3;
  }

  void compare_measures(std::uint32_t own) {
    const std::uint32_t given = given_of_[own];
    const Volume &of_own = own_.volumes()[own], &of_given = given_.volumes()[given];
    double slack = of_own.measure_error + of_given.measure_error;
    for (std::uint32_t w = 0; w < given_.wall_count(); ++w) {
      const auto [a, b] = given_.volumes_of(w);
      if (a != b && (a == given || b == given)) slack += around(given_.simplex(w), limit());
    }
    if (std::abs(of_own.measure - of_given.measure) <= slack) return;
    task_.findings.add(Kind::wrong_volume, {own}, [&] {
      return "A volume measures " + words(of_own.measure) + " in the mesh, and " + words(of_given.measure) +
             " in the input; they may differ by " + words(slack) + ".";
    });
  }

  const NearTask& task_;
  const OutputMesh<3>& mesh_;
  const InputVolumes<3>&own_, &given_;
  const Components& components_;
  const NearSet walls_;
  std::vector<double> depths_;                    ///< of vertices, then of cells
  std::vector<std::uint32_t> given_of_, own_of_;  ///< of volumes of the mesh the given one, and the other way round
};

}  // namespace

void check_near_volumes(const NearTask& task, const InputVolumes<3>& volumes, const Components& components) {
  if (task.given.volumes()) NearVolumes(task, volumes, components).run();
}

}  // namespace pgdr::checking
